/* What a pair's cache holds: the first word names it. Any bits are safe; they cost time at most. */
#ifndef TL_CACHE_H
#define TL_CACHE_H

#include "collide/gjk.h"

#include <string.h>

#define TL_CACHE_AXIS 0x41584953u    /* a direction from A to B, in A's frame */
#define TL_CACHE_LOOKED 0x4c4f4f4bu  /* nothing, but that the pair is not new */
#define TL_CACHE_SIMPLEX 0x53494d00u /* + 1..3: vertices of A and of B, 16 bits each, a word a pair */

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

static inline int tl_cache_has_simplex(const tl_pair_cache *cache) {
    return cache->word[0] - (TL_CACHE_SIMPLEX + 1u) < 3u;
}

/* The simplex where the shapes stand now; its count stays 0 where none is held. */
static inline void tl_cache_simplex(const tl_pair_cache *cache, const tl_core *a, const tl_core *b, tl_simplex *s) {
    uint32_t na = tl_core_vertex_count(a), nb = tl_core_vertex_count(b);
    s->count = 0;
    if (!tl_cache_has_simplex(cache) || na == 0u || nb == 0u) {
        return;
    }
    s->count = cache->word[0] - TL_CACHE_SIMPLEX;
    for (uint32_t i = 0; i < s->count; ++i) {
        tl_simplex_vertex *v = &s->vertex[i];
        v->ia = (cache->word[i + 1u] & 0xffffu) % na;
        v->ib = (cache->word[i + 1u] >> 16) % nb;
        v->a = tl_core_vertex(a, v->ia);
        v->b = tl_core_vertex(b, v->ib);
    }
}

/* Keeps the simplex of shapes that have vertices, else the axis. */
static inline void tl_cache_keep_simplex(tl_pair_cache *cache, const tl_core *a, const tl_core *b, const tl_simplex *s,
                                         talus_vec3 n) {
    if (s->count == 0u || s->count > 3u || tl_core_vertex_count(a) == 0u || tl_core_vertex_count(b) == 0u) {
        tl_cache_keep_axis(cache, n);
        return;
    }
    cache->word[0] = TL_CACHE_SIMPLEX + s->count;
    for (uint32_t i = 0; i < 3u; ++i) {
        cache->word[i + 1u] = i < s->count ? s->vertex[i].ia | s->vertex[i].ib << 16 : 0u;
    }
}

#endif
