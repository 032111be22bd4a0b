/* The same in plain C, for other languages: scenes, servos and one's own loop (libhaptel), the compiler
 * (libhaptel_compiler: haptel_compiler, haptel_compile and haptel_evaluate).
 *
 * What a function makes is freed by its haptel_..._free, in any order; null may be freed. Nothing is null but for want
 * of memory: what was refused is made, too, and says why. Where a null is given in its place nothing happens. Text is
 * UTF-8 and valid until its owner is freed. An object of a scene is known by its number, from 1, in the order of
 * adding. Units are SI.
 */
#ifndef HAPTEL_C_H
#define HAPTEL_C_H

#include <haptel/abi.h>
#include <haptel/export.h>

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct haptel_source haptel_source; /* of textures */
typedef struct haptel_builder haptel_builder;
typedef struct haptel_scene haptel_scene;
typedef struct haptel_servo haptel_servo;
typedef struct haptel_renderer haptel_renderer;
typedef struct haptel_compiled haptel_compiled;

typedef struct {
    const char *name, *value; /* {"depth", "60um"} */
} haptel_value;

typedef struct {
    double stiffness_n_per_m, damping_n_s_per_m, static_friction, dynamic_friction;
} haptel_material;

typedef struct {
    double rate_hz, force_limit_n;
    double v_max_m_per_s;                  /* hand speed that textures are band-limited for */
    double force_rise_s;                   /* after start and interruptions */
    int32_t force_model;                   /* 0 displaced, 1 paper, 2 paper_unit, 3 ho99, 4 lateral */
    int32_t probe;                         /* 0 point, 1 sphere, 2 stylus, 3 gripper */
    double probe_length_m, probe_radius_m; /* of a stylus from tip to tail; of a sphere */
} haptel_scene_settings;

typedef struct {
    double force_n[3], torque_n_m[3]; /* on the hand; the torque of a stylus about its grip */
    double grip_force_n;              /* of a gripper: how hard its fingers are pushed apart */
    double depth_m, height_m;         /* below the base surface, of the texture there */
    uint32_t contacts, faults;        /* objects touched; bits, 0: none */
} haptel_force;

typedef struct {
    int32_t faulted;
    double seconds;
    uint64_t ticks, contact_ticks, missed_deadlines, faults, textures_changed;
    double force_rms_n, force_max_n, energy_j;
    double tick_ns_median, tick_ns_p99;
} haptel_report;

HAPTEL_API const char* haptel_version(void);

/* Textures that are compiled, from files: "FILE.haptel:NAME". With follow_files what is saved is felt. */
HAPTEL_API haptel_source* haptel_compiler(int32_t follow_files);
/* Those of a library of `haptel build`: "precompiled:NAME". The tables must outlive the scene. */
HAPTEL_API haptel_source* haptel_precompiled(const haptel_texture* const* textures, size_t count);
HAPTEL_API void haptel_source_free(haptel_source* source);

/* The materials and settings that C++ has by default. */
HAPTEL_API haptel_material haptel_default_material(void);
HAPTEL_API haptel_scene_settings haptel_default_settings(void);

/* Without a source every object is smooth. The source may be freed at once. */
HAPTEL_API haptel_builder* haptel_builder_new(const haptel_source* textures);
HAPTEL_API void haptel_builder_free(haptel_builder* builder);
/* "plane", "box", "sphere", "icosphere" or "torus"; the number of the object, 0: no such shape. A null material is the
 * default one. */
HAPTEL_API uint32_t haptel_add_shape(haptel_builder* builder, const char* shape, double size_m,
                                     const haptel_material* material);
/* Three doubles a position, three indices a triangle. */
HAPTEL_API uint32_t haptel_add_mesh(haptel_builder* builder, const double* positions_m, size_t positions,
                                    const uint32_t* triangles, size_t triangle_count, const haptel_material* material);
HAPTEL_API uint32_t haptel_add_file(haptel_builder* builder, const char* file, double size_m,
                                    const haptel_material* material);
/* 0: there is no object of that number. */
HAPTEL_API int32_t haptel_object_texture(haptel_builder* builder, uint32_t object, const char* reference,
                                         const haptel_value* values, size_t count);
HAPTEL_API int32_t haptel_object_place(haptel_builder* builder, uint32_t object, const double position_m[3],
                                       const double rotation_deg[3]);

HAPTEL_API int32_t haptel_object_apart(haptel_builder* builder, uint32_t object); /* not joined to what it meets */

/* Null settings are the default ones. The builder is empty afterwards. */
HAPTEL_API haptel_scene* haptel_build(haptel_builder* builder, const haptel_scene_settings* settings);
HAPTEL_API haptel_scene* haptel_load_scene(const char* file, const haptel_source* textures);
HAPTEL_API int32_t haptel_scene_ok(const haptel_scene* scene); /* 0: the messages say why not */
HAPTEL_API const char* haptel_scene_messages(const haptel_scene* scene);
/* Of an object's texture, while it is felt: why not, or an empty text, until this thread asks again. Any thread. */
HAPTEL_API const char* haptel_scene_set(haptel_scene* scene, uint32_t object, const char* parameter, const char* value);
HAPTEL_API void haptel_scene_free(haptel_scene* scene);

/* Null: the default device, "simulated:premium". 0 seconds: until it is asked to stop. Virtual time is for simulated
 * devices. */
HAPTEL_API haptel_servo* haptel_servo_new(const haptel_scene* scene, const char* device, double seconds,
                                          int32_t virtual_time);
HAPTEL_API int32_t haptel_servo_ok(const haptel_servo* servo);
HAPTEL_API const char* haptel_servo_messages(const haptel_servo* servo);
HAPTEL_API void haptel_servo_start(haptel_servo* servo);
HAPTEL_API void haptel_servo_request_stop(haptel_servo* servo);
HAPTEL_API int32_t haptel_servo_running(const haptel_servo* servo);
HAPTEL_API haptel_report haptel_servo_wait(haptel_servo* servo);            /* for the end */
HAPTEL_API const char* haptel_servo_stop_reason(const haptel_servo* servo); /* once it was waited for */
HAPTEL_API void haptel_servo_free(haptel_servo* servo);                     /* ends the run */

/* For a loop of one's own: haptel_tick once per period. Neither it nor haptel_between_ticks allocates, locks or waits.
 */
HAPTEL_API haptel_renderer* haptel_renderer_new(const haptel_scene* scene);
HAPTEL_API const char* haptel_renderer_messages(const haptel_renderer* renderer); /* why all forces are 0 */
HAPTEL_API haptel_force haptel_tick(haptel_renderer* renderer, const double tip_m[3], const double tail_m[3],
                                    uint64_t periods); /* that went by: 1, or more where the loop was late */
HAPTEL_API void haptel_between_ticks(haptel_renderer* renderer);
HAPTEL_API void haptel_renderer_free(haptel_renderer* renderer);

/* One texture of a text, with values, to be looked at; null or empty: its only one. */
HAPTEL_API haptel_compiled* haptel_compile(const char* text, const char* name, const haptel_value* values,
                                           size_t count);
HAPTEL_API int32_t haptel_compiled_ok(const haptel_compiled* compiled);
HAPTEL_API const char* haptel_compiled_messages(const haptel_compiled* compiled);
HAPTEL_API const haptel_texture* haptel_compiled_table(const haptel_compiled* compiled); /* null: was refused */
HAPTEL_API haptel_facts haptel_compiled_facts(const haptel_compiled* compiled);
/* Three doubles a point and a gradient, which may be null. 0: was refused. */
HAPTEL_API int32_t haptel_evaluate(const haptel_compiled* compiled, const double* points_m, size_t count,
                                   double* heights_m, double* gradients);
HAPTEL_API void haptel_compiled_free(haptel_compiled* compiled);

#ifdef __cplusplus
}
#endif

#endif
