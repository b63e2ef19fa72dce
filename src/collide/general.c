/* Manifolds by support points: the normal from GJK or, in overlap, from EPA; where a face's own normal separates as
 * well, that one, so that faces that rest on one another have a steady normal. Metres, in A's frame. */
#include "collide/general.h"

/* Takes the face's normal for the touch's own if the shapes are as far apart along it. */
static void snap(const tl_core *a, const tl_core *b, talus_vec3 n, tl_touch *touch) {
    uint32_t ia = 0, ib = 0;
    talus_vec3 pa, pb;
    float s = tl_core_separation(a, b, n, &ia, &ib, &pa, &pb) - (a->radius + b->radius);
    float slack = 1e-5f * tl_min(a->size, b->size) + 5e-7f * tl_max(a->size, b->size);
    slack += touch->separation > 0.0f ? 2e-3f * touch->separation : -5e-5f * touch->separation;
    if (s >= touch->separation - slack) {
        touch->normal = n;
        touch->separation = s;
    }
}

static void touch_overlap(const tl_core *a, const tl_core *b, const tl_simplex *simplex, tl_touch *touch) {
    tl_depth depth;
    tl_epa_run(a, b, simplex, &depth);
    touch->normal = depth.normal;
    touch->separation = -depth.depth - (a->radius + b->radius);
    touch->point_a = tl_mad(depth.point_a, a->radius, depth.normal);
    touch->point_b = tl_mad(depth.point_b, -b->radius, depth.normal);
}

void tl_collide_general(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    tl_simplex simplex;
    tl_gjk near;
    tl_touch touch;
    float radii = a->radius + b->radius;
    simplex.count = 0;
    talus_vec3 guess = tl_cache_axis(cache, tl_normalize_or(b->t, tl_v(0.0f, 1.0f, 0.0f)));
    tl_gjk_state state = tl_gjk_run(a, b, guess, margin + radii, &simplex, &near);
    out->count = 0;
    out->normal = guess;
    if (state == TL_GJK_BEYOND || (state == TL_GJK_APART && near.distance - radii > margin)) {
        tl_cache_keep_axis(cache, near.normal);
        out->normal = near.normal;
        out->gap = state == TL_GJK_APART ? near.distance - radii : margin;
        return;
    }
    if (state == TL_GJK_APART) {
        touch.normal = near.normal;
        touch.separation = near.distance - radii;
        touch.point_a = tl_mad(near.point_a, a->radius, near.normal);
        touch.point_b = tl_mad(near.point_b, -b->radius, near.normal);
    } else {
        touch_overlap(a, b, &simplex, &touch);
    }
    tl_cache_keep_axis(cache, touch.normal);

    if (a->kind == TL_CORE_POINT || b->kind == TL_CORE_POINT) {
        out->normal = touch.normal;
        out->count = 1;
        out->point[0].position = tl_scale(tl_add(touch.point_a, touch.point_b), 0.5f);
        out->point[0].separation = touch.separation;
        out->point[0].id = 0;
        return;
    }
    tl_feature fa, fb;
    tl_feature_find(a, touch.normal, 1, &fa);
    tl_feature_find(b, tl_neg(touch.normal), 1, &fb);
    tl_touch whole = touch;
    if (fa.count >= 3) {
        snap(a, b, fa.normal, &touch);
    }
    if (fb.count >= 3) {
        tl_touch other = whole;
        snap(a, b, tl_neg(fb.normal), &other);
        if (fa.count < 3 || other.separation > touch.separation + tl_touch_tolerance(a, b)) {
            touch = other;
        }
    }
    if (touch.separation > margin) {
        tl_cache_keep_axis(cache, touch.normal);
        return;
    }
    tl_manifold_meet(a, b, &touch, margin, out);
}
