/* What a compiled texture looks like: the only contract between the compiler, precompiled libraries and the runtime.
 *
 * C99 and self-contained, so that JIT code, ahead-of-time libraries and hand-written C or lambdas are textures of equal
 * rank. Everything is SI and in object space. An entry point never returns NaN or infinity: what could not be computed
 * is 0 and raises a bit in `faults`. Entries are pure: same point, same block, same bits; they touch nothing but
 * *sample.
 */
#ifndef HAPTEL_LANG_ABI_H
#define HAPTEL_LANG_ABI_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { HAPTEL_ABI_VERSION = 1 };

/* Bits of haptel_texture::reads: inputs that the entries use. An input whose bit is clear need not be filled. */
enum {
    HAPTEL_READS_POINT = 1u << 0,     /* p */
    HAPTEL_READS_NORMAL = 1u << 1,    /* n, and n_dp for the gradient */
    HAPTEL_READS_UV = 1u << 2,        /* uv, and uv_dp for the gradient */
    HAPTEL_READS_TIME = 1u << 3,      /* time_s; excludes a conservative force field */
    HAPTEL_READS_CENTER = 1u << 4,    /* center in the block */
    HAPTEL_READS_EXTENT = 1u << 5,    /* extent in the block */
    HAPTEL_READS_FOOTPRINT = 1u << 6, /* footprint_m in the block */
    /* What tells of the contact itself: for outputs only, neither height nor stiffness reads it. */
    HAPTEL_READS_VELOCITY = 1u << 7,
    HAPTEL_READS_NORMAL_FORCE = 1u << 8,
    HAPTEL_READS_TOOL_RADIUS = 1u << 9,
    HAPTEL_READS_TANGENT = 1u << 10, /* tangent and bitangent */
    HAPTEL_READS_CURVATURE = 1u << 11
};

/* Bits of haptel_texture::writes: outputs beyond height and gradient. */
enum {
    HAPTEL_WRITES_STIFFNESS_SCALE = 1u << 0,
    HAPTEL_WRITES_FRICTION_SCALE = 1u << 1,
    HAPTEL_WRITES_STATIC_FRICTION_SCALE = 1u << 2,
    HAPTEL_WRITES_DYNAMIC_FRICTION_SCALE = 1u << 3,
    HAPTEL_WRITES_DAMPING_SCALE = 1u << 4,
    HAPTEL_WRITES_FRICTION_DIRECTION = 1u << 5,
    HAPTEL_WRITES_FRICTION_ALONG_SCALE = 1u << 6,
    HAPTEL_WRITES_VIBRATION = 1u << 7,
    HAPTEL_WRITES_VIBRATION_HZ = 1u << 8
};

/* Bits of haptel_sample::faults. */
enum {
    HAPTEL_FAULT_HEIGHT_NOT_FINITE = 1u << 0,   /* height and gradient were set to 0 */
    HAPTEL_FAULT_GRADIENT_NOT_FINITE = 1u << 1, /* gradient was set to 0 */
    HAPTEL_FAULT_OUTPUT_NOT_FINITE = 1u << 2    /* a material output was set to what it is where none is written */
};

/* haptel_parameter::type */
enum {
    HAPTEL_FLOAT = 0, /* double in the block */
    HAPTEL_INT = 1,   /* int32_t */
    HAPTEL_UINT = 2,  /* uint32_t */
    HAPTEL_BOOL = 3,  /* int32_t, 0 or 1 */
    HAPTEL_IMAGE =
        4 /* const haptel_image*, aligned to 8; null: flat, 0 everywhere. The binding keeps what it points to */
};

/* What an image is outside of its edges: the texel at the edge, or the image once more, or once more and turned round.
 */
enum { HAPTEL_EDGE_CLAMPED = 0, HAPTEL_EDGE_TILED = 1, HAPTEL_EDGE_MIRRORED = 2 };

/* A picture as textures read it: the cubic B-spline that goes through its texels. Texel (0, 0) is the lower left one,
 * rows follow each other upwards.
 */
typedef struct haptel_image {
    const double* coefficients[3]; /* by HAPTEL_EDGE_*; width * height each, finite. Clamped: (width + 2) * (height +
                                      2), the first row and column below and left of texel (0, 0) */
    int32_t width, height;         /* in texels, at least 1 */
    /* What else there is of the same picture; null: nothing, and this stands for all of it. By channel (0: brightness,
     * 1 to 4: red, green, blue, alpha), then by level: each of half as many texels a side as the one before it. */
    const struct haptel_image* parts;
    int32_t channels, levels; /* of parts */
    int32_t channel, level;   /* of this one among them */
} haptel_image;

/* haptel_facts::continuity */
enum { HAPTEL_CONTINUITY_UNKNOWN = 0, HAPTEL_CONTINUITY_JUMP = 1, HAPTEL_CONTINUITY_C0 = 2, HAPTEL_CONTINUITY_C1 = 3 };

/* Where the surface is touched. Jacobians are with respect to p on the facet: n_dp[i][j] = dn_i/dp_j, uv_dp likewise.
 */
typedef struct {
    double p[3];        /* metres */
    double n[3];        /* unit shading normal */
    double uv[2];       /* mesh coordinates, no unit */
    double time_s;      /* since the start of the exploration */
    double n_dp[3][3];  /* 1/m, filled only where `reads` says so */
    double uv_dp[2][3]; /* 1/m, likewise */
    /* Within contact_limits.h; filled only where `reads` says so. No derivative is taken of what follows. */
    double velocity[3];              /* m/s, of the hand along the surface */
    double normal_force_n;           /* the object's stiffness times the depth below its base surface, >= 0 */
    double tool_radius_m;            /* of the ball or the stylus's end that touches, >= 0 */
    double tangent[3], bitangent[3]; /* unit, along the surface, where uv.x and uv.y grow alone; 0 without uv */
    double curvature_per_m;          /* mean of the two principal ones of the smooth surface, > 0 where it is convex */
} haptel_point;

typedef struct {
    double height_m;        /* along the outward normal of the base surface */
    double gradient[3];     /* dh/dp, metres per metre; not yet projected to the surface */
    double stiffness_scale; /* 1 unless the texture says otherwise */
    double friction_scale;  /* 1 unless the texture says otherwise */
    uint32_t faults;
    /* From here on an entry writes only what `writes` names: a caller whose sample ends above may call it otherwise. */
    double static_friction_scale, dynamic_friction_scale, damping_scale;
    double friction_along_scale;      /* friction along the direction over that across it */
    double friction_direction[3];     /* of any length; only its part along the surface counts. Zero: none */
    double vibration_n, vibration_hz; /* amplitude, at most the force that presses, and frequency, along the normal */
} haptel_sample;

/* Proven bounds over a box and a set of parameter values. Infinity: unbounded or not found. */
typedef struct {
    double height_min_m, height_max_m;
    double slope_max;           /* sup of the Euclidean norm of the gradient */
    double curvature_max_per_m; /* Lipschitz constant of the gradient */
    uint32_t continuity;
    uint32_t operations_max; /* worst case per call; 0: not counted */
} haptel_facts;

/* A number or an image. The components of a vector `size` are parameters of their own, size.x, size.y, one behind the
 * other.
 */
typedef struct {
    const char *name, *unit, *doc;
    uint32_t type, offset;          /* offset in bytes from the start of the block */
    double value, minimum, maximum; /* SI; the default and the range a slider may use */
} haptel_parameter;

/* Every block starts with this; parameters follow at their offsets. */
typedef struct {
    double center[3];   /* of the object's bounding box, metres */
    double extent[3];   /* its sides, metres */
    double footprint_m; /* smallest wavelength worth rendering; 0: everything */
} haptel_block_head;

typedef void haptel_entry(const haptel_point*, const void* block, haptel_sample*);

/* Many points and their samples, an array per number: what one point holds, each a pointer to as many values as there
 * are points. Of the inputs only those that `reads` names need an array; an output without one (null) is not written.
 * No output may share memory with an input.
 */
typedef struct {
    const double *p[3], *n[3], *uv[2], *time_s, *n_dp[3][3], *uv_dp[2][3], *velocity[3], *normal_force_n,
        *tool_radius_m, *tangent[3], *bitangent[3], *curvature_per_m;
} haptel_points;

typedef struct {
    double *height_m, *gradient[3], *stiffness_scale, *friction_scale;
    uint32_t* faults;
    /* As in haptel_sample. */
    double *static_friction_scale, *dynamic_friction_scale, *damping_scale, *friction_along_scale,
        *friction_direction[3], *vibration_n, *vibration_hz;
} haptel_samples;

/* Each sample is that of the entry for one point, bit for bit. */
typedef void haptel_batch_entry(const haptel_points*, uint64_t count, const void* block, const haptel_samples*);

/* `size` is sizeof(haptel_texture) of the writer: entries appended later are absent where it is smaller. */
typedef struct {
    uint32_t abi, size;
    uint32_t reads, writes;
    uint32_t block_size, parameter_count;
    const char* name;
    const haptel_parameter* parameters;
    haptel_facts
        facts; /* over the parameters' ranges and any point, infinite where nobody looked; a binding's are sharper */
    haptel_entry* height;          /* height_m and faults only; 0: not compiled */
    haptel_entry* height_gradient; /* the same height, bit for bit, and the gradient; 0: not compiled */
    haptel_batch_entry *height_batch, *height_gradient_batch; /* of many points; 0: not compiled */
    const char* const* const* choices; /* by parameter: names of its values 0 .. maximum, 0 where they have none */
} haptel_texture;

#ifdef __cplusplus
}
#endif

#endif
