/* Contact manifolds of two convex shapes; knows no world. */
#ifndef TL_COLLIDE_H
#define TL_COLLIDE_H

#include "geom/hull.h"
#include "talus/query.h"

#define TL_MANIFOLD_POINTS 4
#define TL_MANIFOLD_OTHERS 60

/* A shape's geometry with its hull found (null unless the type is TALUS_HULL). */
typedef talus_convex tl_convex;

typedef struct tl_manifold_point {
    talus_vec3 position; /* m, in A's frame: midway between the two surfaces */
    float separation;    /* m along the normal, negative in overlap */
    uint32_t id;         /* of the pair of features: the same while they stay the same; unique within the manifold */
} tl_manifold_point;

/* The surfaces at point i are position -/+ normal * separation / 2 on A and on B. */
typedef struct tl_manifold {
    talus_vec3 normal; /* unit, from A to B, in A's frame */
    uint32_t count;    /* 0..4 points with separation <= margin */
    float gap;         /* m: without points, a distance that the shapes are known to have at least; 0 if none is */
    tl_manifold_point point[TL_MANIFOLD_POINTS];
    uint32_t others; /* of more than four points those that were left out */
    tl_manifold_point other[TL_MANIFOLD_OTHERS];
} tl_manifold;

/* What a pair remembers from one query to the next: a hint only; any bits give a right answer. All zero is cold. */
typedef struct tl_pair_cache {
    uint32_t word[4];
} tl_pair_cache;

/* The manifold of a at the identity and b at `b_in_a`, with the points that are at most `margin` (m, >= 0) apart. Any
 * type against any type; the roles are as given (the normal goes from a to b). Finite input gives finite output. */
void tl_collide(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin, tl_pair_cache *cache,
                tl_manifold *out);

/* Of the points of a face four are taken, and of many that are nearly alike others every time: takes those again that
 * have the given ids, if they are all still there and say as much. Returns whether it did. */
int tl_manifold_stay(tl_manifold *m, const uint32_t *id, uint32_t count);

/* Whether both are capsules of one radius each, or one is and the other a ball. */
int tl_are_capsules(const talus_geometry *a, const talus_geometry *b);

/* Distance (m, 0 in overlap) with the closest points on both in a's frame. */
float tl_distance(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, tl_pair_cache *cache,
                  talus_vec3 *point_a, talus_vec3 *point_b);

/* The box around a shape at a pose. */
talus_aabb tl_convex_aabb(const tl_convex *shape, const talus_pose *pose);

#endif
