/* Closed forms for balls and capsules. Metres, in A's frame. */
#ifndef TL_ROUND_H
#define TL_ROUND_H

#include "collide/general.h"

/* How far the point p is outside of a shape (negative inside), both in the shape's frame, with the unit outward normal
 * of the surface next to it. 0 if it takes a search: near an edge or a corner of a hull; then `distance` is a lower
 * bound. */
int tl_point_distance(const tl_convex *shape, talus_vec3 p, float *distance, talus_vec3 *normal);

/* Any shape and a ball. */
void tl_collide_ball(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                     tl_pair_cache *cache, tl_manifold *out);

/* Two capsules, each of one radius; one of them may be a ball. */
void tl_collide_capsules(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                         tl_manifold *out);

/* A box or hull and a capsule of one radius. 0, and nothing done, if the hull has too many faces. */
int tl_collide_capsule_polyhedron(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache,
                                  tl_manifold *out);

#endif
