/* Manifolds of any two convex shapes by their support points. */
#ifndef TL_GENERAL_H
#define TL_GENERAL_H

#include "collide/cache.h"
#include "collide/feature.h"

/* What tl_collide promises, for two cores of any kind. */
void tl_collide_general(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out);

/* The same for cores that do not overlap; 0, and nothing done, if they do. */
int tl_collide_apart(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out);

/* Poses further out than this (m) leave nothing of the shapes' sizes, and their squares come near to the largest float.
 */
#define TL_FAR_AWAY 1e12f

static inline int tl_is_far(talus_vec3 t) {
    return tl_max(tl_max(tl_abs(t.x), tl_abs(t.y)), tl_abs(t.z)) > TL_FAR_AWAY;
}

/* The length of such a vector, the largest float if it is longer than that, and its direction. */
static inline float tl_far_distance(talus_vec3 t, talus_vec3 *normal) {
    float m = tl_max(tl_max(tl_abs(t.x), tl_abs(t.y)), tl_abs(t.z));
    talus_vec3 u = tl_v(t.x / m, t.y / m, t.z / m);
    float length = tl_length(u);
    *normal = tl_v(u.x / length, u.y / length, u.z / length);
    return m > 3.4e38f / length ? 3.4e38f : m * length;
}

#endif
