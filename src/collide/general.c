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

static void set_touch(const tl_core *a, const tl_core *b, talus_vec3 n, float separation, talus_vec3 pa, talus_vec3 pb,
                      tl_touch *touch) {
    touch->normal = n;
    touch->separation = separation - (a->radius + b->radius);
    touch->point_a = tl_mad(pa, a->radius, n);
    touch->point_b = tl_mad(pb, -b->radius, n);
}

/* Overlap from the last normal on. A face near to it on either shape is the likely answer: the points of the difference
 * around a face's own normal are the corners of a facet, which EPA then has only to confirm. */
static int overlap_again(const tl_core *a, const tl_core *b, talus_vec3 guess, float apart, tl_depth *depth) {
    tl_feature face;
    talus_vec3 n = guess, pa, pb;
    float tilt = 0.02f;
    for (int turn = 0; turn < 2; ++turn) {
        uint32_t ia = 0, ib = 0;
        tl_feature_find(turn ? b : a, turn ? tl_neg(guess) : guess, 1, &face);
        if (face.count < 3) {
            continue;
        }
        talus_vec3 m = turn ? tl_neg(face.normal) : face.normal;
        float s = tl_core_separation(a, b, m, &ia, &ib, &pa, &pb);
        if (s >= apart) {
            apart = s;
            n = m;
            tilt = 1e-5f;
        }
    }
    return apart < 0.0f && tl_epa_from(a, b, n, tilt, depth);
}

/* Where the shapes come nearest or overlap; 0 if they are further apart than `margin` along touch->normal. */
static int find_touch(const tl_core *a, const tl_core *b, float margin, const tl_pair_cache *cache, tl_touch *touch) {
    tl_simplex simplex;
    tl_gjk near;
    tl_depth depth;
    talus_vec3 guess = tl_cache_axis(cache, tl_normalize_or(b->t, tl_v(0.0f, 1.0f, 0.0f)));
    float limit = margin + (a->radius + b->radius);
    if (cache->word[0] == TL_CACHE_AXIS) {
        uint32_t ia = 0, ib = 0;
        float apart = tl_core_separation(a, b, guess, &ia, &ib, &near.point_a, &near.point_b);
        if (apart > limit) {
            touch->normal = guess;
            return 0;
        }
        if (apart < 0.0f && overlap_again(a, b, guess, apart, &depth)) {
            set_touch(a, b, depth.normal, -depth.depth, depth.point_a, depth.point_b, touch);
            return 1;
        }
    }
    simplex.count = 0;
    tl_gjk_state state = tl_gjk_run(a, b, guess, limit, &simplex, &near);
    if (state == TL_GJK_BEYOND || (state == TL_GJK_APART && near.distance > limit)) {
        touch->normal = near.normal;
        return 0;
    }
    if (state == TL_GJK_APART) {
        set_touch(a, b, near.normal, near.distance, near.point_a, near.point_b, touch);
    } else {
        tl_epa_run(a, b, &simplex, &depth);
        set_touch(a, b, depth.normal, -depth.depth, depth.point_a, depth.point_b, touch);
    }
    return 1;
}

void tl_collide_general(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    tl_touch touch;
    out->count = 0;
    int meet = find_touch(a, b, margin, cache, &touch);
    out->normal = touch.normal;
    tl_cache_keep_axis(cache, touch.normal);
    if (!meet) {
        return;
    }
    if (a->kind == TL_CORE_POINT || b->kind == TL_CORE_POINT) {
        out->count = 1;
        out->point[0].position = tl_scale(tl_add(touch.point_a, touch.point_b), 0.5f);
        out->point[0].separation = tl_min(touch.separation, margin);
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
    out->normal = touch.normal;
    if (touch.separation > margin) {
        return;
    }
    tl_manifold_meet(a, b, &fa, &fb, &touch, margin, out);
}
