/* Shapes: what bodies are made of for collision and mass. */
#ifndef TALUS_SHAPE_H
#define TALUS_SHAPE_H

#include "talus/hull.h"
#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum talus_shape_type {
    TALUS_SPHERE,   /* radius */
    TALUS_CAPSULE,  /* two balls of radius_bottom at y = -half_height and radius_top at +half_height, and their hull */
    TALUS_CYLINDER, /* a cylinder or cut cone along y between -half_height and +half_height; one radius may be 0 */
    TALUS_BOX,      /* half extents */
    TALUS_HULL,     /* a blob in the world's geometry */
    TALUS_SHAPE_TYPE_COUNT
} talus_shape_type;

/* The geometry of a shape in its own frame (m). Sizes lie in [TALUS_MIN_SIZE, TALUS_MAX_SIZE], but a capsule's
 * half_height may be 0. */
typedef struct talus_geometry {
    talus_shape_type type;
    float radius;        /* sphere */
    float half_height;   /* capsule, cylinder */
    float radius_top;    /* capsule, cylinder */
    float radius_bottom; /* capsule, cylinder */
    talus_vec3 half;     /* box */
    uint32_t hull;       /* offset (bytes) of the blob in the world's geometry region */
} talus_geometry;

#define TALUS_MIN_SIZE 1e-6f
#define TALUS_MAX_SIZE 1e6f

/* How two materials' numbers become one. Where they ask for unlike rules the one named first here wins. */
typedef enum talus_combine {
    TALUS_COMBINE_AVERAGE,
    TALUS_COMBINE_MINIMUM,
    TALUS_COMBINE_MAXIMUM,
    TALUS_COMBINE_MULTIPLY,
    TALUS_COMBINE_COUNT
} talus_combine;

typedef struct talus_material {
    float static_friction;    /* >= 0 */
    float dynamic_friction;   /* >= 0 */
    float restitution;        /* 0..1 */
    float rolling_resistance; /* m, >= 0: the lever of the normal force that resists rolling; the larger one counts */
    talus_combine friction_combine;
    talus_combine restitution_combine;
} talus_material;

/* Two shapes collide if each one's mask holds a bit of the other's category; shapes of one group, if it is not zero,
 * collide always (positive) or never (negative). */
typedef struct talus_filter {
    uint64_t category, mask;
    int32_t group;
} talus_filter;

typedef struct talus_shape_def {
    talus_geometry geometry;
    talus_pose pose; /* in the body's frame */
    talus_material material;
    talus_filter filter;
    float density;  /* kg/m^3, >= 0; counts while the body's mass is not set by the caller */
    uint8_t sensor; /* reports overlaps (sensor events) and pushes nothing */
    uint8_t events; /* reports contact begin, end and hit events */
    uint64_t user_data;
} talus_shape_def;

/* A half-metre box of water with friction 0.5, all filters open. */
talus_shape_def talus_shape_def_default(void);

/* Adds a shape to a body and, unless the body's mass was set by the caller, works out the body's mass anew.
 * TALUS_BAD_SHAPE, TALUS_NOT_FINITE, TALUS_BAD_BLOB, TALUS_STALE_HANDLE, TALUS_FULL_SHAPES. */
talus_status talus_shape_create(talus_world *world, talus_body body, const talus_shape_def *def, talus_shape *out);
talus_status talus_shape_destroy(talus_world *world, talus_shape shape);
int talus_shape_is_valid(const talus_world *world, talus_shape shape);
talus_status talus_shape_get_body(const talus_world *world, talus_shape shape, talus_body *out);
talus_status talus_shape_get_user_data(const talus_world *world, talus_shape shape, uint64_t *out);
talus_status talus_shape_get_material(const talus_world *world, talus_shape shape, talus_material *out);
talus_status talus_shape_set_material(talus_world *world, talus_shape shape, const talus_material *material);
talus_status talus_shape_get_filter(const talus_world *world, talus_shape shape, talus_filter *out);
talus_status talus_shape_set_filter(talus_world *world, talus_shape shape, const talus_filter *filter);
/* The world box of the shape at its body's pose (m). */
talus_status talus_shape_get_aabb(const talus_world *world, talus_shape shape, talus_aabb *out);

/* Mass of a geometry at a density (kg/m^3), in the shape's frame. `geometry_region` is needed for hulls only. Exact for
 * every type. TALUS_BAD_SHAPE, TALUS_NOT_FINITE, TALUS_BAD_BLOB. */
talus_status talus_geometry_mass(const talus_geometry *geometry, const void *geometry_region, size_t region_bytes,
                                 float density, talus_mass *out);
/* The same mass seen from an outer frame in which the shape stands at `pose`; the sum of two masses of one frame. */
talus_mass talus_mass_move(const talus_mass *mass, const talus_pose *pose);
talus_mass talus_mass_add(const talus_mass *a, const talus_mass *b);

#ifdef __cplusplus
}
#endif

#endif
