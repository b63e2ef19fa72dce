/* Queries of two shapes that need no world: how far apart, when in touch, how deep in one another. They are functions
 * of their arguments alone: the same bits on every processor, and as many at a time as there are threads. All lengths
 * in metres, poses and answers in one frame of the caller's.
 *
 * Boxes, hulls, capsules of one radius and balls are walked from feature to feature: with the features of the last
 * query at hand and little motion since, a query costs about the same whatever the number of vertices (0.1 to 0.2
 * microseconds for a distance). Cylinders, cones and capsules of two radii take a search each time. Distances, depths
 * and gaps are within 1e-5 of themselves and 1e-6 of the shapes' sizes, 4e-6 of the sizes where a round shape takes
 * part. */
#ifndef TALUS_QUERY_H
#define TALUS_QUERY_H

#include "talus/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a pair of shapes remembers from one query to the next: the features of both where the last one ended. A hint
 * only: any bits give a right answer, all zero is a cold start. */
typedef struct talus_feature_pair {
    uint32_t a, b;
} talus_feature_pair;

/* A geometry found sound, ready for queries. Points into the region, which must outlive it unchanged. */
typedef struct talus_convex {
    talus_geometry geometry;
    const talus_hull *hull; /* null unless the type is TALUS_HULL */
} talus_convex;

/* `region` is needed for hulls only, and its blob is validated: O(its size), so once a shape and not once a query.
 * TALUS_BAD_ARGUMENT for null pointers, TALUS_BAD_SHAPE, TALUS_NOT_FINITE, TALUS_BAD_BLOB, TALUS_UNALIGNED. */
talus_status talus_convex_init(const talus_geometry *geometry, const void *region, size_t region_bytes,
                               talus_convex *out);

typedef struct talus_separation {
    float distance;    /* m, 0 in overlap */
    int overlap;       /* the shapes touch or overlap */
    talus_vec3 normal; /* unit, from A to B; 0 if the shapes, without the radii of balls and capsules, overlap */
    talus_vec3 point_a, point_b; /* next to one another on the surfaces; in overlap one and the same, within both */
    uint32_t steps;              /* from feature to feature */
    uint32_t gave_up; /* 1: the walk did not end within 256 steps, or not where it should: a search answered */
} talus_separation;

/* The queries answer TALUS_BAD_ARGUMENT for null pointers (but `features` may be null), numbers out of range, a
 * rotation of all zeros (others are taken as normalised), coordinates beyond TALUS_MAX_COORDINATE; TALUS_NOT_FINITE.
 * The shapes are as talus_convex_init made them. */

/* Closest points. Cold about 0.5 to 0.9 microseconds from 20 to 10000 vertices. */
talus_status talus_distance(const talus_convex *a, const talus_pose *pose_a, const talus_convex *b,
                            const talus_pose *pose_b, talus_feature_pair *features, talus_separation *out);

typedef enum talus_depth_mode {
    /* Down from the last features to what no neighbour undercuts: the least in about 19 of 20 after a degree. Without
     * such features an expanding polytope finds where to start: the least but of round hulls of hundreds of vertices,
     * where it may be a percent more. */
    TALUS_DEPTH_LOCAL,
    TALUS_DEPTH_PROVEN, /* and on until nothing is less: about a hundred supports more as a rule */
    TALUS_DEPTH_MODE_COUNT
} talus_depth_mode;

typedef struct talus_depth {
    float depth;                 /* m: moving B by this much along the normal parts the shapes; 0 if they are apart */
    int overlap;                 /* 0: they are apart, and depth, normal and points are 0 */
    int proven;                  /* no other direction is less deep; never of cylinders, cones, capsules of two radii */
    talus_vec3 normal;           /* unit, from A to B */
    talus_vec3 point_a, point_b; /* on A inside B and on B inside A: depth apart along the normal */
    uint32_t directions;         /* looked along; 0 where it took no walk */
} talus_depth;

/* How deep the shapes overlap: the least translation that parts them, or in local mode a translation that parts them.
 */
talus_status talus_penetration(const talus_convex *a, const talus_pose *pose_a, const talus_convex *b,
                               const talus_pose *pose_b, talus_depth_mode mode, talus_feature_pair *features,
                               talus_depth *out);

/* A shape on its way through the time from 0 to 1: its centre moves along a line while it turns about it, both evenly.
 */
typedef struct talus_motion {
    talus_pose pose;        /* at time 0 */
    talus_vec3 center;      /* of the turning, in the shape's frame (m) */
    talus_vec3 translation; /* of the centre in the whole time (m) */
    talus_vec3 rotation;    /* in the whole time: along the axis, as long as the angle (rad), which is at most pi */
} talus_motion;

typedef enum talus_time_status {
    TALUS_TIME_MISS,      /* no contact; time is 1 */
    TALUS_TIME_HIT,       /* the gap shrinks to the tolerance at `time`, and there is none before */
    TALUS_TIME_TOUCHING,  /* at time 0 the shapes overlap, or are no further apart than the tolerance */
    TALUS_TIME_UNFINISHED /* no contact before `time`; what comes after was not looked at within 1000 queries */
} talus_time_status;

typedef enum talus_time_method {
    TALUS_ADVANCEMENT, /* conservative advancement */
    TALUS_BISECTION,   /* ever shorter intervals: what advancement is measured by */
    TALUS_TIME_METHOD_COUNT
} talus_time_method;

typedef struct talus_contact_time {
    talus_time_status status;
    double time;                 /* 0..1; what is fast moves a tolerance in less than a step of float */
    float gap;                   /* m, of the last query: at `time` for all but a miss; <= 0 only if touching */
    talus_vec3 normal;           /* unit, from A to B; 0 in overlap but for the radii of balls and capsules */
    talus_vec3 point_a, point_b; /* next to one another on the surfaces, m; one common point where the normal is 0 */
    uint32_t queries;            /* of distance */
} talus_contact_time;

/* The first time at which the shapes are no further apart than `tolerance` (m, > 0), or than 4e-6 of their sizes if
 * that is more. Conservative: a thin shape is not missed, however fast. About 3 distances for a slide, 5 to 10 with
 * turning; many more where surfaces pass one another at little more than the tolerance. */
talus_status talus_time_of_contact(const talus_convex *a, const talus_motion *motion_a, const talus_convex *b,
                                   const talus_motion *motion_b, float tolerance, talus_time_method method,
                                   talus_feature_pair *features, talus_contact_time *out);

#ifdef __cplusplus
}
#endif

#endif
