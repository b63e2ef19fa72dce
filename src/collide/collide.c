/* The table of pairs: which algorithm answers which two types, and the mirror of those that know one order only. */
#include "collide/general.h"
#include "collide/polyhedra.h"

#include <string.h>

/* Poses further out than this (m) leave the shapes' sizes below the rounding of the distance. */
#define FAR_AWAY 3e7f

/* Two shapes too far apart for their form to count. */
static void collide_far(const tl_core *a, const tl_core *b, float margin, tl_manifold *out) {
    talus_vec3 t = b->t;
    float m = tl_max(tl_max(tl_abs(t.x), tl_abs(t.y)), tl_abs(t.z));
    talus_vec3 n = tl_normalize_or(t, tl_v(0.0f, 1.0f, 0.0f));
    float length = tl_dot(n, tl_scale(t, 1.0f / m));
    /* a distance past the largest float is the largest float */
    float distance = m > 3.4e38f / length ? 3.4e38f : m * length;
    out->normal = n;
    out->count = 0;
    if (distance <= margin) {
        out->count = 1;
        out->point[0].position = tl_scale(t, 0.5f);
        out->point[0].separation = distance - (a->size + b->size);
        out->point[0].id = 0;
    }
}

static int is_far(talus_vec3 t) { return tl_max(tl_max(tl_abs(t.x), tl_abs(t.y)), tl_abs(t.z)) > FAR_AWAY; }

void tl_collide(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin, tl_pair_cache *cache,
                tl_manifold *out) {
    tl_core ca, cb;
    tl_core_init(&ca, a, NULL);
    tl_core_init(&cb, b, b_in_a);
    memset(out, 0, sizeof *out);
    if (is_far(b_in_a->position)) {
        collide_far(&ca, &cb, margin, out);
        return;
    }
    int flat =
        (ca.kind == TL_CORE_BOX || ca.kind == TL_CORE_HULL) && (cb.kind == TL_CORE_BOX || cb.kind == TL_CORE_HULL);
    if (flat && tl_collide_polyhedra(&ca, &cb, margin, cache, out)) {
        return;
    }
    tl_collide_general(&ca, &cb, margin, cache, out);
}
