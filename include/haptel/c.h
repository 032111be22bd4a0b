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

typedef struct haptel_source haptel_source;     /* of textures */
typedef struct haptel_builder haptel_builder;   /* objects that become a scene */
typedef struct haptel_scene haptel_scene;       /* what there is to touch; it does not change */
typedef struct haptel_servo haptel_servo;       /* a device that feels a scene, on a thread of its own */
typedef struct haptel_renderer haptel_renderer; /* one hand in a loop of the program's own */
typedef struct haptel_compiled haptel_compiled; /* a texture with its values, to be looked at */

/* A parameter of a texture and its value, as a scene file has them: {"depth", "60um"}. */
typedef struct {
    const char *name, *value; /* UTF-8, neither of them null */
} haptel_value;

/* What an object is made of, apart from its texture. */
typedef struct {
    double stiffness_n_per_m; /* > 0, per metre of the hand's way */
    double damping_n_s_per_m; /* >= 0, along the normal */
    double static_friction;   /* >= dynamic_friction: largest sideways over normal force that sticks */
    double dynamic_friction;  /* >= 0: the same while sliding */
} haptel_material;

/* What holds for all objects of a scene. */
typedef struct {
    double rate_hz;                        /* ticks per second, > 0 */
    double force_limit_n;                  /* > 0: a larger force is scaled down to it */
    double v_max_m_per_s;                  /* hand speed that textures are band-limited for */
    double force_rise_s;                   /* after start and interruptions */
    int32_t force_model;                   /* 0 displaced, 1 paper, 2 paper_unit, 3 ho99, 4 lateral */
    int32_t probe;                         /* 0 point, 1 sphere, 2 stylus, 3 gripper */
    double probe_length_m, probe_radius_m; /* of a stylus from tip to tail; of a sphere */
} haptel_scene_settings;

/* What a tick gives. */
typedef struct {
    double force_n[3], torque_n_m[3]; /* on the hand, in the world frame; the torque of a stylus about its grip */
    double grip_force_n;              /* of a gripper: how hard its fingers are pushed apart */
    double depth_m;                   /* below the base surface */
    double height_m;                  /* of the texture there */
    uint32_t contacts;                /* objects touched */
    uint32_t faults;                  /* bits; 0: none */
} haptel_force;

/* What a run was like. */
typedef struct {
    int32_t faulted;                    /* 1: the scene was refused, the device failed, or the processor was too slow */
    double seconds;                     /* periods that went by, missed ones included, times the period */
    uint64_t ticks;                     /* rounds of the loop */
    uint64_t contact_ticks;             /* of these with something touched */
    uint64_t missed_deadlines;          /* periods in which no force was sent because the tick before was late */
    uint64_t faults;                    /* ticks with a fault of texture, pose or force */
    uint64_t textures_changed;          /* while it was felt, by values and files */
    double force_rms_n, force_max_n;    /* as sent, over all ticks: root mean square, largest */
    double energy_j;                    /* that the forces gave to the hand */
    double tick_ns_median, tick_ns_p99; /* from pose to force; 0 where there was no tick */
} haptel_report;

HAPTEL_API const char* haptel_version(void); /* "0.1.0" */

/* Textures that are compiled, from files: "FILE.haptel:NAME". With follow_files what is saved is felt. */
HAPTEL_API haptel_source* haptel_compiler(int32_t follow_files);
/* Those of a library of `haptel build`: "precompiled:NAME". The tables must outlive the scene. */
HAPTEL_API haptel_source* haptel_precompiled(const haptel_texture* const* textures, size_t count);
HAPTEL_API void haptel_source_free(haptel_source* source); /* what was built with it stays */

/* The materials and settings that C++ has by default. */
HAPTEL_API haptel_material haptel_default_material(void);
HAPTEL_API haptel_scene_settings haptel_default_settings(void); /* likewise */

/* Without a source every object is smooth. The source may be freed at once. */
HAPTEL_API haptel_builder* haptel_builder_new(const haptel_source* textures);
HAPTEL_API void haptel_builder_free(haptel_builder* builder); /* a scene that was built stays */
/* "plane", "box", "sphere", "icosphere" or "torus"; the number of the object, 0: no such shape. A null material is the
 * default one. */
HAPTEL_API uint32_t haptel_add_shape(haptel_builder* builder, const char* shape, double size_m,
                                     const haptel_material* material);
/* Three doubles a position, three indices a triangle. */
HAPTEL_API uint32_t haptel_add_mesh(haptel_builder* builder, const double* positions_m, size_t positions,
                                    const uint32_t* triangles, size_t triangle_count, const haptel_material* material);
/* A mesh file, scaled until its largest side has that size, at most 1 km; 0: as it is. */
HAPTEL_API uint32_t haptel_add_file(haptel_builder* builder, const char* file, double size_m,
                                    const haptel_material* material);
/* "FILE.haptel:NAME", "wood.oak" or "wood.oak:board" of an installed library, or "precompiled:NAME".
   0: there is no object of that number. */
HAPTEL_API int32_t haptel_object_texture(haptel_builder* builder, uint32_t object, const char* reference,
                                         const haptel_value* values, size_t count);
/* Where its origin is; turned about x, then y, then z. 0: there is no object of that number. */
HAPTEL_API int32_t haptel_object_place(haptel_builder* builder, uint32_t object, const double position_m[3],
                                       const double rotation_deg[3]);

HAPTEL_API int32_t haptel_object_apart(haptel_builder* builder, uint32_t object); /* not joined to what it meets */

/* Null settings are the default ones. The builder is empty afterwards. */
HAPTEL_API haptel_scene* haptel_build(haptel_builder* builder, const haptel_scene_settings* settings);
/* From a scene file. Its devices are left to the program. */
HAPTEL_API haptel_scene* haptel_load_scene(const char* file, const haptel_source* textures);
HAPTEL_API int32_t haptel_scene_ok(const haptel_scene* scene); /* 0: the messages say why not */
/* Errors, warnings and notes, a line each. */
HAPTEL_API const char* haptel_scene_messages(const haptel_scene* scene);
/* Of an object's texture, while it is felt: why not, or an empty text, until this thread asks again. Any thread. */
HAPTEL_API const char* haptel_scene_set(haptel_scene* scene, uint32_t object, const char* parameter, const char* value);
HAPTEL_API void haptel_scene_free(haptel_scene* scene); /* servos and renderers of it go on */

/* Null: the default device, "simulated:premium". 0 seconds: until it is asked to stop. Virtual time is for simulated
 * devices. */
HAPTEL_API haptel_servo* haptel_servo_new(const haptel_scene* scene, const char* device, double seconds,
                                          int32_t virtual_time);
HAPTEL_API int32_t haptel_servo_ok(const haptel_servo* servo);           /* 0: the messages say why not */
HAPTEL_API const char* haptel_servo_messages(const haptel_servo* servo); /* warnings beside a device, too */
HAPTEL_API void haptel_servo_start(haptel_servo* servo);                 /* once */
HAPTEL_API void haptel_servo_request_stop(haptel_servo* servo);          /* does not wait; any thread */
HAPTEL_API int32_t haptel_servo_running(const haptel_servo* servo); /* 1 from start until its end, whatever ended it */
HAPTEL_API haptel_report haptel_servo_wait(haptel_servo* servo);    /* for the end */
HAPTEL_API const char* haptel_servo_stop_reason(const haptel_servo* servo); /* once it was waited for */
HAPTEL_API void haptel_servo_free(haptel_servo* servo);                     /* ends the run */

/* For a loop of one's own: haptel_tick once per period. Neither it nor haptel_between_ticks allocates, locks or waits.
 */
HAPTEL_API haptel_renderer* haptel_renderer_new(const haptel_scene* scene);
HAPTEL_API const char* haptel_renderer_messages(const haptel_renderer* renderer); /* why all forces are 0 */
HAPTEL_API haptel_force haptel_tick(haptel_renderer* renderer, const double tip_m[3], const double tail_m[3],
                                    uint64_t periods);           /* that went by: 1, or more where the loop was late */
HAPTEL_API void haptel_between_ticks(haptel_renderer* renderer); /* when the force is sent: reads ahead */
HAPTEL_API void haptel_renderer_free(haptel_renderer* renderer); /* not while its loop calls it */

/* One texture of a text, with values, to be looked at; null or empty: its only one. */
HAPTEL_API haptel_compiled* haptel_compile(const char* text, const char* name, const haptel_value* values,
                                           size_t count);
HAPTEL_API int32_t haptel_compiled_ok(const haptel_compiled* compiled);           /* 0: the messages say why not */
HAPTEL_API const char* haptel_compiled_messages(const haptel_compiled* compiled); /* with line and column */
HAPTEL_API const haptel_texture* haptel_compiled_table(const haptel_compiled* compiled); /* null: was refused */
HAPTEL_API haptel_facts haptel_compiled_facts(const haptel_compiled* compiled); /* proven over a box of 10 cm */
/* Three doubles a point and a gradient, which may be null. 0: was refused. */
HAPTEL_API int32_t haptel_evaluate(const haptel_compiled* compiled, const double* points_m, size_t count,
                                   double* heights_m, double* gradients);
HAPTEL_API void haptel_compiled_free(haptel_compiled* compiled); /* its table ends with it */

#ifdef __cplusplus
}
#endif

#endif
