/* The plain types that every other header speaks in. SI units, radians, right-handed axes. */
#ifndef TALUS_TYPES_H
#define TALUS_TYPES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct talus_vec3 {
    float x, y, z;
} talus_vec3;

/* A rotation; x y z w, of unit length where the text does not say otherwise. */
typedef struct talus_quat {
    float x, y, z, w;
} talus_quat;

/* A matrix by columns. */
typedef struct talus_mat3 {
    talus_vec3 x, y, z;
} talus_mat3;

/* Where a frame stands in another: p_outer = rotation * p_inner + position. */
typedef struct talus_pose {
    talus_vec3 position;
    talus_quat rotation;
} talus_pose;

typedef struct talus_aabb {
    talus_vec3 lower, upper;
} talus_aabb;

/* Mass (kg), centre (m) and inertia about the centre (kg m^2), in one frame. */
typedef struct talus_mass {
    float mass;
    talus_vec3 center;
    talus_mat3 inertia;
} talus_mass;

/* Handles: an index and a generation. All zero is "none". A handle whose object was destroyed is detected. */
typedef struct talus_body {
    uint32_t index, generation;
} talus_body;

typedef struct talus_shape {
    uint32_t index, generation;
} talus_shape;

typedef struct talus_joint {
    uint32_t index, generation;
} talus_joint;

/* No position handed to a world, in whatever frame, has a coordinate beyond (m); TALUS_BAD_ARGUMENT. */
#define TALUS_MAX_COORDINATE 1e9f

/* What a call answers. Anything but TALUS_OK means that nothing was changed. */
typedef enum talus_status {
    TALUS_OK = 0,
    TALUS_BAD_ARGUMENT, /* a null pointer, or a number outside the stated range */
    TALUS_NOT_FINITE,   /* a NaN or an infinity */
    TALUS_BAD_MASS,     /* a dynamic body without a positive mass or inertia */
    TALUS_BAD_SHAPE,    /* a size that is not positive, or outside the stated range */
    TALUS_STALE_HANDLE, /* the object is gone, or never was */
    TALUS_SMALL_BLOCK,  /* fewer bytes than the size query asked for */
    TALUS_UNALIGNED,    /* memory is not aligned as asked */
    TALUS_BAD_BLOB,     /* a geometry blob is damaged or of another version */
    TALUS_FLAT_HULL,    /* the points span no volume */
    TALUS_TOO_MANY_POINTS,
    TALUS_NO_ISA,      /* the instruction set is not in this build or on this processor */
    TALUS_FULL_BODIES, /* the capacity named is used up */
    TALUS_FULL_SHAPES,
    TALUS_FULL_JOINTS,
    TALUS_FULL_CONTACTS,
    TALUS_FULL_EVENTS,
    TALUS_FULL_SCRATCH,
    TALUS_STATUS_COUNT
} talus_status;

/* A short English text for a status; never null. */
const char *talus_status_text(talus_status status);

#ifdef __cplusplus
}
#endif

#endif
