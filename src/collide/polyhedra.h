/* Manifolds of boxes and hulls. */
#ifndef TL_POLYHEDRA_H
#define TL_POLYHEDRA_H

#include "collide/general.h"
#include "collide/sat.h"

/* What tl_collide promises for two boxes or hulls. 0, and nothing done, if one has too many faces. */
int tl_collide_polyhedra(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out);

/* The same for two boxes. */
void tl_collide_boxes(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out);

/* Apart along a normal that features realise: no pair of points is nearer than the axis says, and some are as near. */
static inline int tl_is_realised(const tl_manifold *m, float separation, float tolerance) {
    return m->count > 0 && (separation <= 0.0f || tl_manifold_least(m) <= 1.015f * separation + tolerance);
}

#endif
