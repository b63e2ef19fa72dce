/* Queries of a world: what a ray or a moving shape meets, what is near, what overlaps, what holds a point. They see
 * bodies where they stand now, awake or asleep, also those that calls have moved since the last step.
 *
 * A query changes nothing, allocates nothing, and any number may ask one world at a time while nobody changes it. What
 * it answers follows from the state alone: a world restored from a snapshot gives the same bits, in the same order. The
 * order is that of `at`, and of the shapes' indices where that is the same.
 *
 * The cost is the trees' (about the logarithm of the shapes), plus a closed form for each shape that a ray comes near,
 * a query of talus/query.h for each shape that another one comes near, plus 50 nanoseconds or so for each shape that
 * was made, moved by a call or restored from another state since the last step: those are not in the trees yet. What
 * has flown beyond TALUS_MAX_COORDINATE is not seen.
 *
 * All lengths in metres, all vectors in the world's axes. Answers: TALUS_BAD_ARGUMENT for null pointers (but a null
 * filter is the default one), coordinates beyond TALUS_MAX_COORDINATE, rotations of all zeros and numbers outside of
 * the ranges given; TALUS_NOT_FINITE; TALUS_STALE_HANDLE. */
#ifndef TALUS_WORLD_QUERY_H
#define TALUS_WORLD_QUERY_H

#include "talus/query.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of shapes for a query to see. */
enum {
    TALUS_SEE_STATIC = 1, /* shapes of static bodies, and so on */
    TALUS_SEE_KINEMATIC = 2,
    TALUS_SEE_DYNAMIC = 4,
    TALUS_SEE_SENSORS = 8 /* sensors too, of the bodies above */
};

typedef struct talus_query_filter {
    talus_filter filter;    /* sees the shapes that would collide with a shape of this filter */
    uint32_t kinds;         /* TALUS_SEE_* */
    const talus_body *skip; /* bodies not to see; looked through for each shape that comes near; may be null */
    uint32_t skip_count;
} talus_query_filter;

/* Sees all but sensors: category and mask have all bits, the group is 0. */
talus_query_filter talus_query_filter_default(void);

/* The points origin + t way, t from 0 to 1. A way of length 0 is a point. */
typedef struct talus_ray {
    talus_vec3 origin, way;
} talus_ray;

/* One shape that a query found. */
typedef struct talus_query_hit {
    talus_shape shape;
    talus_body body;
    double at;           /* rays and casts: the part of the way, 0..1; what is near: the distance; else 0 */
    talus_vec3 normal;   /* unit, out of the shape; 0 where there is none (`within`) */
    talus_vec3 point;    /* on the shape's surface */
    talus_vec3 own;      /* on the surface of what was asked about: for a ray the same point */
    uint16_t within;     /* the ray starts in the shape, the shapes overlap at the start: `at` is 0, the normal is 0 but
                              where balls and capsules overlap by their radii alone, the points are a common one */
    uint16_t unfinished; /* of casts: no contact before `at`, the rest was not looked at (TALUS_TIME_UNFINISHED) */
} talus_query_hit;

/* The caller's room for what a query finds. Where there is more than room for, the first in the order are kept. */
typedef struct talus_hits {
    talus_query_hit *hits; /* may be null if the capacity is 0 */
    uint32_t capacity;
    uint32_t count; /* out: how many there were; min(count, capacity) are in hits */
} talus_hits;

/* --- rays: exact for every type of shape. Shapes are solid: a ray that starts in one hits it there. -----------------
 */

/* The first hit; if there is none, *out is all zero, its shape is none. Looks at what may be nearer only: about 0.5 to
 * 2 microseconds in a pile of a thousand bodies. */
talus_status talus_world_ray(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                             talus_query_hit *out);
/* All hits: the nearest of each shape on the way. */
talus_status talus_world_ray_all(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                                 talus_hits *out);
/* Whether there is a hit: *out is 1 or 0. The cheapest of the three. */
talus_status talus_world_ray_any(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                                 int *out);

/* --- casts: a shape on its way, as in talus_time_of_contact, through a world that stands still -----------------------
 */

/* The first time at which the shape is no further than `tolerance` (m, > 0; at least 4e-6 of the sizes) from one of the
 * world's; if there is none, *out is all zero. The shape may turn by up to half a turn. */
talus_status talus_world_cast(const talus_world *world, const talus_convex *shape, const talus_motion *motion,
                              float tolerance, const talus_query_filter *filter, talus_query_hit *out);
/* All shapes on the way, each at its own first time, as if the others were not there. */
talus_status talus_world_cast_all(const talus_world *world, const talus_convex *shape, const talus_motion *motion,
                                  float tolerance, const talus_query_filter *filter, talus_hits *out);

/* --- what is near: within `reach` (m, >= 0), closest points, as by talus_distance ------------------------------------
 */

/* The closest shape; if none is within reach, *out is all zero. */
talus_status talus_world_closest(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                 float reach, const talus_query_filter *filter, talus_query_hit *out);
talus_status talus_world_closest_all(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                     float reach, const talus_query_filter *filter, talus_hits *out);
/* The same of a point. */
talus_status talus_world_closest_to_point(const talus_world *world, talus_vec3 point, float reach,
                                          const talus_query_filter *filter, talus_query_hit *out);
talus_status talus_world_closest_to_point_all(const talus_world *world, talus_vec3 point, float reach,
                                              const talus_query_filter *filter, talus_hits *out);

/* --- what overlaps: in the order of the shapes' indices; `at` is 0 --------------------------------------------------
 */

/* The shapes that overlap a shape; those whose boxes (talus_shape_get_aabb) overlap a box, which is a cheap first look
 * and leaves normal and points 0; those that hold a point. */
talus_status talus_world_overlap(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                 const talus_query_filter *filter, talus_hits *out);
talus_status talus_world_overlap_aabb(const talus_world *world, const talus_aabb *box, const talus_query_filter *filter,
                                      talus_hits *out);
talus_status talus_world_at_point(const talus_world *world, talus_vec3 point, const talus_query_filter *filter,
                                  talus_hits *out);

/* --- of one shape, whatever its filter: *out is all zero if there is nothing
 * -------------------------------------------- */

talus_status talus_shape_ray(const talus_world *world, talus_shape shape, const talus_ray *ray, talus_query_hit *out);
talus_status talus_shape_cast(const talus_world *world, talus_shape shape, const talus_convex *other,
                              const talus_motion *motion, float tolerance, talus_query_hit *out);
/* However far it is. */
talus_status talus_shape_closest(const talus_world *world, talus_shape shape, const talus_convex *other,
                                 const talus_pose *pose, talus_query_hit *out);
talus_status talus_shape_closest_to_point(const talus_world *world, talus_shape shape, talus_vec3 point,
                                          talus_query_hit *out);
talus_status talus_shape_overlap(const talus_world *world, talus_shape shape, const talus_convex *other,
                                 const talus_pose *pose, talus_query_hit *out);
talus_status talus_shape_at_point(const talus_world *world, talus_shape shape, talus_vec3 point, talus_query_hit *out);

#ifdef __cplusplus
}
#endif

#endif
