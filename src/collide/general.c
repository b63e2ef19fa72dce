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

/* What the last normal says of an overlap now. */
typedef struct again {
    talus_vec3 normal;
    float separation; /* of the cores along it */
    float tilt;       /* for EPA to start with */
    int is_face;
    tl_feature a, b;
} again;

/* A face near to the last normal on either shape is the likely answer: then the points of the difference around the
 * face's own normal are the corners of a facet, which EPA has only to confirm. */
static void look_again(const tl_core *a, const tl_core *b, talus_vec3 guess, float apart, again *g) {
    g->normal = guess;
    g->separation = apart;
    g->tilt = 0.02f;
    g->is_face = 0;
    tl_feature_find(a, guess, 1, &g->a);
    tl_feature_find(b, tl_neg(guess), 1, &g->b);
    for (int turn = 0; turn < 2; ++turn) {
        const tl_feature *f = turn ? &g->b : &g->a;
        if (f->count >= 3) {
            uint32_t ia = 0, ib = 0;
            talus_vec3 m = turn ? tl_neg(f->normal) : f->normal, pa, pb;
            float s = tl_core_separation(a, b, m, &ia, &ib, &pa, &pb);
            if (s >= g->separation) {
                g->separation = s;
                g->normal = m;
                g->tilt = 1e-5f;
                g->is_face = 1;
            }
        }
    }
}

/* The manifold of faces that meet as they did, without a search: apart, where points of both are as near as the face's
 * normal says; in overlap, where the points prove the normal. 0 if it takes a search. */
static int meet_again(const tl_core *a, const tl_core *b, float margin, again *g, tl_manifold *out) {
    tl_touch touch;
    float radii = a->radius + b->radius, tolerance = tl_touch_tolerance(a, b);
    if (!g->is_face || (g->separation < 0.0f && radii > 0.0f)) {
        return 0;
    }
    tl_feature fa = g->a, fb = g->b;
    if (fa.count < 3) {
        tl_feature_find(a, g->normal, 0, &fa);
    } else if (fb.count < 3) {
        tl_feature_find(b, tl_neg(g->normal), 0, &fb);
    }
    touch.normal = g->normal;
    touch.separation = g->separation - radii;
    tl_manifold_build(&fa, &fb, &touch, margin, tolerance, out);
    if (g->separation >= 0.0f) {
        float most = (radii > 0.0f ? 1.0001f : 1.015f) * g->separation + tolerance;
        return out->count > 0 && tl_manifold_least(out) + radii <= most;
    }
    talus_vec3 center = a->kind == TL_CORE_HULL ? a->hull->centroid : tl_v(0.0f, 0.0f, 0.0f);
    talus_vec3 other = b->kind == TL_CORE_HULL ? tl_core_place(b, b->hull->centroid) : b->t;
    return tl_is_proven(out, g->separation, tl_sub(other, center));
}

/* GJK from where it ended last time. Beyond is also what is only found to be further apart than `limit` at the end. */
static tl_gjk_state nearest(const tl_core *a, const tl_core *b, float limit, talus_vec3 guess,
                            const tl_pair_cache *cache, tl_simplex *simplex, tl_gjk *near) {
    tl_cache_simplex(cache, a, b, simplex);
    tl_gjk_state state = tl_gjk_run(a, b, guess, limit, simplex, near);
    return state == TL_GJK_APART && near->distance > limit ? TL_GJK_BEYOND : state;
}

/* The manifold of a touch; where a face's own normal parts the shapes as well, along that. */
static void meet(const tl_core *a, const tl_core *b, float margin, tl_touch touch, tl_manifold *out) {
    out->normal = touch.normal;
    out->count = 0;
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
    out->gap = touch.separation;
    if (touch.separation <= margin) {
        tl_manifold_meet(a, b, &fa, &fb, &touch, margin, out);
    }
}

/* What comes of GJK but for an overlap. */
static void meet_apart(const tl_core *a, const tl_core *b, float margin, tl_gjk_state state, const tl_gjk *near,
                       const tl_simplex *simplex, tl_pair_cache *cache, tl_manifold *out) {
    tl_touch touch;
    if (state == TL_GJK_BEYOND) {
        tl_cache_keep_axis(cache, near->normal);
        out->normal = near->normal;
        out->count = 0;
        out->gap = near->distance - (a->radius + b->radius);
        return;
    }
    tl_cache_keep_simplex(cache, a, b, simplex, near->normal);
    set_touch(a, b, near->normal, near->distance, near->point_a, near->point_b, &touch);
    meet(a, b, margin, touch, out);
}

int tl_collide_apart(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    tl_simplex simplex;
    tl_gjk near;
    talus_vec3 guess = tl_cache_axis(cache, tl_normalize_or(b->t, tl_v(0.0f, 1.0f, 0.0f)));
    tl_gjk_state state = nearest(a, b, margin + (a->radius + b->radius), guess, cache, &simplex, &near);
    if (state == TL_GJK_OVERLAP) {
        return 0;
    }
    meet_apart(a, b, margin, state, &near, &simplex, cache, out);
    return 1;
}

/* What the cached normal shows again; 0 if that is nothing certain. */
static int collide_again(const tl_core *a, const tl_core *b, float margin, talus_vec3 guess, float apart,
                         tl_pair_cache *cache, tl_manifold *out) {
    again g;
    tl_depth depth;
    tl_touch touch;
    look_again(a, b, guess, apart, &g);
    if (g.separation - (a->radius + b->radius) <= margin && meet_again(a, b, margin, &g, out)) {
        tl_cache_keep_axis(cache, g.normal);
        return 1;
    }
    if (g.separation >= 0.0f || !tl_epa_from(a, b, g.normal, g.tilt, &depth)) {
        return 0;
    }
    tl_cache_keep_axis(cache, depth.normal);
    set_touch(a, b, depth.normal, -depth.depth, depth.point_a, depth.point_b, &touch);
    meet(a, b, margin, touch, out);
    return 1;
}

void tl_collide_general(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    tl_simplex simplex;
    tl_gjk near;
    float limit = margin + (a->radius + b->radius);
    talus_vec3 guess = tl_cache_axis(cache, tl_normalize_or(b->t, tl_v(0.0f, 1.0f, 0.0f)));
    if (cache->word[0] == TL_CACHE_AXIS) {
        uint32_t ia = 0, ib = 0;
        float apart = tl_core_separation(a, b, guess, &ia, &ib, &near.point_a, &near.point_b);
        if (apart > limit) {
            out->normal = guess;
            out->count = 0;
            out->gap = apart - (a->radius + b->radius);
            return;
        }
        if (collide_again(a, b, margin, guess, apart, cache, out)) {
            return;
        }
    }
    tl_gjk_state state = nearest(a, b, limit, guess, cache, &simplex, &near);
    if (state == TL_GJK_OVERLAP) {
        tl_depth depth;
        tl_touch touch;
        tl_epa_run(a, b, &simplex, &depth);
        tl_cache_keep_axis(cache, depth.normal);
        set_touch(a, b, depth.normal, -depth.depth, depth.point_a, depth.point_b, &touch);
        meet(a, b, margin, touch, out);
        return;
    }
    meet_apart(a, b, margin, state, &near, &simplex, cache, out);
}
