/* One pair of boxes (box_box.inl), and what those cannot decide. */
#include "base/width_one.h"
#include "collide/polyhedra.h"

#include "collide/box_box.inl"

static void set_boxes(const tl_core *a, const tl_core *b, float margin, bx_boxes *x) {
    const talus_mat3 *r = &b->r;
    x->ha[0] = a->half.x, x->ha[1] = a->half.y, x->ha[2] = a->half.z;
    x->hb[0] = b->half.x, x->hb[1] = b->half.y, x->hb[2] = b->half.z;
    x->t[0] = b->t.x, x->t[1] = b->t.y, x->t[2] = b->t.z;
    x->r[0][0] = r->x.x, x->r[0][1] = r->y.x, x->r[0][2] = r->z.x;
    x->r[1][0] = r->x.y, x->r[1][1] = r->y.y, x->r[1][2] = r->z.y;
    x->r[2][0] = r->x.z, x->r[2][1] = r->y.z, x->r[2][2] = r->z.z;
    x->margin = margin;
}

static void write_manifold(const bx_manifold *m, tl_manifold *out) {
    out->count = (uint32_t)m->count;
    for (uint32_t i = 0; i < out->count; i++) {
        tl_manifold_point *p = &out->point[i];
        p->position = tl_v(m->p[i][0], m->p[i][1], m->p[i][2]);
        p->separation = m->separation[i];
        p->id = m->id[i];
    }
}

/* Edges that run beside one another; 0 if they do not meet. */
static int meet_beside(const tl_core *a, const tl_core *b, const bx_axis *axis, float margin, tl_manifold *out) {
    tl_touch touch;
    tl_feature fa, fb;
    uint32_t ia = 0, ib = 0, i = (uint32_t)axis->i, j = (uint32_t)axis->j;
    float tolerance = tl_touch_tolerance(a, b);
    touch.normal = out->normal;
    touch.separation = axis->separation;
    tl_core_support_local(a, touch.normal, &ia);
    tl_core_support_local(b, tl_core_rotate_back(b, tl_neg(touch.normal)), &ib);
    tl_feature_edge(a, ia & ~(1u << i), ia | 1u << i, 0, &fa);
    tl_feature_edge(b, ib & ~(1u << j), ib | 1u << j, 0, &fb);
    tl_manifold_build(&fa, &fb, &touch, margin, tolerance, out);
    return tl_is_realised(out, axis->separation, tolerance);
}

void tl_collide_boxes(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    bx_boxes x;
    bx_manifold m;
    set_boxes(a, b, margin, &x);
    bx_collide(&x, &m);
    out->count = 0;
    out->gap = m.gap;
    out->normal = tl_v(0.0f, 1.0f, 0.0f);
    cache->word[0] = cache->word[0] ? cache->word[0] : TL_CACHE_LOOKED;
    if (m.decided && m.count == 0.0f) {
        return;
    }
    out->normal = tl_v(m.axis.n[0], m.axis.n[1], m.axis.n[2]);
    if (m.decided) {
        write_manifold(&m, out);
        return;
    }
    if (m.beside && meet_beside(a, b, &m.axis, margin, out)) {
        return;
    }
    if (cache->word[0] == TL_CACHE_AXIS) {
        uint32_t ia = 0, ib = 0;
        talus_vec3 va, vb, n = tl_cache_axis(cache, out->normal);
        float gap = tl_core_separation(a, b, n, &ia, &ib, &va, &vb);
        if (gap > margin) {
            out->count = 0;
            out->gap = gap;
            return;
        }
    }
    if (!tl_cache_has_simplex(cache)) {
        tl_cache_keep_axis(cache, out->normal);
    }
    tl_collide_general(a, b, margin, cache, out);
}
