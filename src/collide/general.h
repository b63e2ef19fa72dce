/* Manifolds of any two convex shapes by their support points. */
#ifndef TL_GENERAL_H
#define TL_GENERAL_H

#include "collide/feature.h"
#include "collide/gjk.h"

#include <string.h>

/* What tl_collide promises, for two cores of any kind. */
void tl_collide_general(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out);

/* The cache's first word names what the other three hold. */
#define TL_CACHE_AXIS 0x41584953u /* a direction from A to B, in A's frame */

static inline talus_vec3 tl_cache_axis(const tl_pair_cache *cache, talus_vec3 otherwise) {
    talus_vec3 n;
    memcpy(&n, &cache->word[1], sizeof n);
    if (cache->word[0] != TL_CACHE_AXIS || !tl_is_finite3(n)) {
        return otherwise;
    }
    return tl_normalize_or(n, otherwise);
}

static inline void tl_cache_keep_axis(tl_pair_cache *cache, talus_vec3 n) {
    cache->word[0] = TL_CACHE_AXIS;
    memcpy(&cache->word[1], &n, sizeof n);
}

#endif
