/* Eight pairs of boxes at a time (collide/box_box.inl), and the impulses of the points that they had before. */
#include "collide/box_box.inl"

static void set_boxes8(const tl_step *step, const tl_pair_batch *batch, const placed8 *s, bx_boxes *x) {
    const float *geometry = (const float *)(const void *)tl_shape_geometry(step->h);
    uint32_t stride = sizeof(talus_geometry) / sizeof(float);
    tl_f8 a[8], b[8], one = tl_f8_set1(1.0f);
    k8 axes = k8_of(s->b_in_a.q, v8_of(one, one, one));
    tl_f8_load_rows_stride(geometry, stride, batch->shape_a, a);
    tl_f8_load_rows_stride(geometry, stride, batch->shape_b, b);
    for (int i = 0; i < 3; i++) {
        x->ha[i] = a[5 + i], x->hb[i] = b[5 + i];
    }
    x->t[0] = s->b_in_a.p.x, x->t[1] = s->b_in_a.p.y, x->t[2] = s->b_in_a.p.z;
    x->r[0][0] = axes.x.x, x->r[1][0] = axes.x.y, x->r[2][0] = axes.x.z;
    x->r[0][1] = axes.y.x, x->r[1][1] = axes.y.y, x->r[2][1] = axes.y.z;
    x->r[0][2] = axes.z.x, x->r[1][2] = axes.z.y, x->r[2][2] = axes.z.z;
    x->margin = s->margin;
}

/* The impulses that the contacts have for points of these numbers, 0 for new ones. */
static void old_impulses(const tl_header *h, const tl_pair_batch *batch, const tl_i8 *id, tl_f8 *impulse) {
    tl_f8 old[TL_MANIFOLD_POINTS][8];
    for (uint32_t j = 0; j < TL_MANIFOLD_POINTS; j++) {
        uint32_t record[TL_LANES];
        for (uint32_t k = 0; k < TL_LANES; k++) {
            record[k] = batch->item[k] * TL_MANIFOLD_POINTS + j;
        }
        tl_f8_load_rows(tl_points(h)->p[0].a, record, old[j]);
    }
    for (uint32_t i = 0; i < TL_MANIFOLD_POINTS; i++) {
        impulse[i] = tl_f8_zero();
        for (uint32_t j = 0; j < TL_MANIFOLD_POINTS; j++) {
            impulse[i] = tl_f8_select(tl_i8_eq(tl_i8_bits_of_f8(old[j][7]), id[i]), old[j][6], impulse[i]);
        }
    }
}

static void collide_boxes(const tl_step *step, const tl_pair_batch *batch, tl_box_manifolds *out) {
    placed8 s = place8(step, batch);
    bx_boxes x;
    bx_manifold m;
    set_boxes8(step, batch, &s, &x);
    bx_collide(&x, &m);
    out->decided = tl_m8_bits(m.decided);
    tl_f8_storeu(out->gap, m.gap);
    tl_f8_storeu(out->count, m.count);
    if (!batch->touch || !tl_m8_any(tl_f8_gt(m.count, tl_f8_zero()))) {
        return;
    }
    kept8 k = kept8_of(batch, &s);
    v8 n = v8_of(m.axis.n[0], m.axis.n[1], m.axis.n[2]);
    tl_f8 impulse[TL_MANIFOLD_POINTS];
    normal_rows(&k, n, out->normal);
    old_impulses(step->h, batch, m.id, impulse);
    for (uint32_t i = 0; i < TL_MANIFOLD_POINTS; i++) {
        tl_m8 there = tl_f8_gt(m.count, tl_f8_set1((float)i));
        tl_f8 row[8];
        point_rows(&k, &s, n, v8_of(m.p[i][0], m.p[i][1], m.p[i][2]), m.separation[i], row);
        row[6] = impulse[i], row[7] = tl_f8_of_bits(m.id[i]);
        for (int c = 0; c < 8; c++) {
            row[c] = tl_f8_and_mask(there, row[c]);
        }
        rows_store(out->point[i], row);
    }
}
