/* Two boxes for the width that the including file has chosen by width_one.h or width_eight.h: one pair, or eight. The
 * 15 separating axes (Gottschalk, Lin & Manocha, OBBTree, 1996, section 5); along the best of them two faces are
 * clipped, or two edges cross. Metres, in A's frame. */
#include "collide/box_clip.inl"

/* Closer to parallel than the squared sine of 2 degrees edges do not cross at one point. */
#define BX_PARALLEL_SIN2 0.0012f

/* Half sizes, where B stands, and r[i][j]: axis j of B along axis i of A. */
typedef struct bx_boxes {
    wf ha[3], hb[3], t[3], r[3][3];
    wf margin;
} bx_boxes;

/* The axis along which the boxes are furthest apart: i a face of A, or j one of B, or the edges i of A and j of B; 3
 * stands for none. */
typedef struct bx_axis {
    wf separation, i, j;
    wf n[3], nb[3]; /* unit, from A to B, in either frame */
    wf sine2;       /* of the edges */
    wm edges;
} bx_axis;

typedef struct bx_manifold {
    wm decided; /* else it takes a search */
    wm beside;  /* edges all but parallel: what there may be to decide them by */
    wf count, gap;
    wf p[TL_MANIFOLD_POINTS][3], separation[TL_MANIFOLD_POINTS];
    wi id[TL_MANIFOLD_POINTS];
    bx_axis axis;
} bx_manifold;

static inline wf bx_dot(const wf *a, const wf *b) { return wf_mad(wf_mad(wf_mul(a[0], b[0]), a[1], b[1]), a[2], b[2]); }
static inline wf bx_sign(wf a) { return wf_select(wf_lt(a, wf_set1(0.0f)), wf_set1(-1.0f), wf_set1(1.0f)); }
static inline wf bx_most(const wf *a) { return wf_max(wf_max(wf_abs(a[0]), wf_abs(a[1])), wf_abs(a[2])); }

/* What separations may differ by from rounding and from features that are all but alike. */
static inline wf bx_tolerance(const bx_boxes *x) {
    wf a = wf_sqrt(bx_dot(x->ha, x->ha)), b = wf_sqrt(bx_dot(x->hb, x->hb));
    return wf_mad(wf_mul(wf_set1(5e-6f), wf_min(a, b)), wf_set1(2.5e-7f), wf_max(a, b));
}

static inline void bx_take(bx_axis *axis, wm better, wf s, float i, float j) {
    axis->separation = wf_select(better, s, axis->separation);
    axis->i = wf_select(better, wf_set1(i), axis->i);
    axis->j = wf_select(better, wf_set1(j), axis->j);
}

/* The best face; one of B has to be better by `bias`. */
static void bx_best_face(const bx_boxes *x, wf abs_r[3][3], wf bias, bx_axis *axis) {
    axis->separation = wf_set1(-3e38f);
    axis->i = axis->j = wf_set1(3.0f);
    for (int i = 0; i < 3; i++) {
        wf s = wf_sub(wf_sub(wf_abs(x->t[i]), x->ha[i]), bx_dot(abs_r[i], x->hb));
        bx_take(axis, wf_lt(axis->separation, s), s, (float)i, 3.0f);
    }
    wf bar = wf_add(axis->separation, bias);
    for (int j = 0; j < 3; j++) {
        wf across[3] = {x->r[0][j], x->r[1][j], x->r[2][j]}, wide[3] = {abs_r[0][j], abs_r[1][j], abs_r[2][j]};
        wf s = wf_sub(wf_sub(wf_abs(bx_dot(x->t, across)), x->hb[j]), bx_dot(wide, x->ha));
        wm better = wf_lt(bar, s);
        bx_take(axis, better, s, 3.0f, (float)j);
        bar = wf_select(better, s, bar);
    }
}

/* The separation across edges i and j times the sine of their angle. */
static inline wf bx_edges(const bx_boxes *x, wf abs_r[3][3], int i, int j) {
    int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1, j1 = j == 2 ? 0 : j + 1, j2 = j == 0 ? 2 : j - 1;
    wf ra = wf_mad(wf_mul(x->ha[i1], abs_r[i2][j]), x->ha[i2], abs_r[i1][j]);
    /* by the axis itself, not by the entry of r that it would be in a matrix without rounding: the sine may be small */
    wf b1 = wf_sub(wf_mul(x->r[i1][j], x->r[i2][j1]), wf_mul(x->r[i2][j], x->r[i1][j1]));
    wf b2 = wf_sub(wf_mul(x->r[i1][j], x->r[i2][j2]), wf_mul(x->r[i2][j], x->r[i1][j2]));
    wf rb = wf_mad(wf_mul(x->hb[j1], wf_abs(b1)), x->hb[j2], wf_abs(b2));
    wf along = wf_sub(wf_mul(x->t[i2], x->r[i1][j]), wf_mul(x->t[i1], x->r[i2][j]));
    return wf_sub(wf_abs(along), wf_add(ra, rb));
}

/* The best edges where they are better than the face by `bias`. */
static void bx_best_edges(const bx_boxes *x, wf abs_r[3][3], wf bias, bx_axis *axis) {
    wf bar = wf_add(axis->separation, bias);
    for (int i = 0; i < 3; i++) {
        int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
        for (int j = 0; j < 3; j++) {
            wf s = bx_edges(x, abs_r, i, j);
            wf sine2 = wf_mad(wf_mul(x->r[i1][j], x->r[i1][j]), x->r[i2][j], x->r[i2][j]), sine = wf_sqrt(sine2);
            wm better = wm_and(wf_lt(wf_mul(bar, sine), s), wf_lt(wf_set1(1e-6f), sine));
            s = wf_div(s, sine);
            bx_take(axis, better, s, (float)i, (float)j);
            bar = wf_select(better, s, bar);
        }
    }
}

static void bx_set_normal(const bx_boxes *x, bx_axis *axis) {
    wf three = wf_set1(3.0f), one = wf_set1(1.0f), u[3], c[3];
    wm face_a = wf_eq(axis->j, three), face_b = wf_eq(axis->i, three);
    bx_axes j = bx_axes_of(axis->j);
    for (int k = 0; k < 3; k++) {
        u[k] = wf_where(wf_eq(axis->i, wf_set1((float)k)), one);
        c[k] = bx_pick(j, x->r[k][0], x->r[k][1], x->r[k][2]);
    }
    wf cross[3] = {wf_sub(wf_mul(u[1], c[2]), wf_mul(u[2], c[1])), wf_sub(wf_mul(u[2], c[0]), wf_mul(u[0], c[2])),
                   wf_sub(wf_mul(u[0], c[1]), wf_mul(u[1], c[0]))};
    axis->edges = wm_andnot(face_a, wf_lt(axis->i, three));
    axis->sine2 = bx_dot(cross, cross);
    for (int k = 0; k < 3; k++) {
        axis->n[k] = wf_select(axis->edges, cross[k], wf_select(face_a, u[k], c[k]));
    }
    wf sign = bx_sign(bx_dot(axis->n, x->t));
    wf scale = wf_div(sign, wf_select(axis->edges, wf_sqrt(axis->sine2), one));
    for (int k = 0; k < 3; k++) {
        axis->n[k] = wf_mul(axis->n[k], scale);
    }
    for (int k = 0; k < 3; k++) {
        wf along[3] = {x->r[0][k], x->r[1][k], x->r[2][k]};
        axis->nb[k] = wf_select(face_b, wf_where(wf_eq(axis->j, wf_set1((float)k)), sign), bx_dot(along, axis->n));
    }
}

/* The reference is the face squarer with the normal, or the axis' own; the incident one looks at it the most. */
static void bx_set_faces(const bx_boxes *x, const bx_axis *axis, bx_faces *f) {
    wf n[3], to[3], g[3], h[3], c[3], m[3][3];
    wf ahead = wf_sub(bx_most(axis->nb), wf_set1(1e-3f));
    wm a = wm_or(wm_and(axis->edges, wf_le(ahead, bx_most(axis->n))), wf_eq(axis->j, wf_set1(3.0f)));
    for (int k = 0; k < 3; k++) {
        wf own[3] = {x->r[0][k], x->r[1][k], x->r[2][k]};
        n[k] = wf_select(a, axis->n[k], wf_neg(axis->nb[k]));
        to[k] = wf_select(a, axis->nb[k], wf_neg(axis->n[k]));
        h[k] = wf_select(a, x->ha[k], x->hb[k]);
        g[k] = wf_select(a, x->hb[k], x->ha[k]);
        c[k] = wf_select(a, x->t[k], wf_neg(bx_dot(x->t, own)));
        for (int l = 0; l < 3; l++) {
            m[k][l] = wf_select(a, x->r[k][l], x->r[l][k]);
        }
    }
    f->a = a;
    bx_place_faces(f, n, to, h, g, c, m);
    bx_name_faces(f);
}

/* From the reference's frame, along x, y and z as it was turned, to A's. */
static void bx_to_a(const bx_boxes *x, const bx_faces *f, const bx_points *q, bx_manifold *out) {
    wf along[3][3], zero = wf_set1(0.0f), one = wf_set1(1.0f), half = wf_set1(0.5f);
    for (int k = 0; k < 3; k++) {
        wf l0 = wf_select(f->a, k == 0 ? one : zero, x->r[k][0]), l1 = wf_select(f->a, k == 1 ? one : zero, x->r[k][1]);
        wf l2 = wf_select(f->a, k == 2 ? one : zero, x->r[k][2]);
        along[0][k] = bx_pick(f->z_axis, l1, l2, l0);
        along[1][k] = bx_pick(f->z_axis, l2, l0, l1);
        along[2][k] = bx_pick(f->z_axis, l0, l1, l2);
    }
    for (int i = 0; i < TL_MANIFOLD_POINTS; i++) {
        wf s = wf_mul(half, q->z[i]), px = wf_mad(q->x[i], s, f->nx), py = wf_mad(q->y[i], s, f->ny);
        wf pz = wf_mul(f->sign, wf_mad(f->hz, s, f->nz));
        for (int k = 0; k < 3; k++) {
            wf from = wf_select(f->a, zero, x->t[k]);
            out->p[i][k] = wf_mad(wf_mad(wf_mad(from, px, along[0][k]), py, along[1][k]), pz, along[2][k]);
        }
        out->separation[i] = wf_max(q->z[i], out->axis.separation);
        out->id[i] = q->id[i];
    }
}

/* The corner in the middle of edge `own` (where the coordinate is 0) that looks along n the most, and its number. */
static inline wi bx_edge(const wf *h, const wf *n, wf own, wf *middle) {
    wi number = wi_set1(0);
    for (uint32_t k = 0; k < 3; k++) {
        wm along = wf_eq(own, wf_set1((float)k)), low = wf_lt(n[k], wf_set1(0.0f));
        middle[k] = wf_select(along, wf_set1(0.0f), wf_select(low, wf_neg(h[k]), h[k]));
        wi bit = wi_select(low, wi_set1(0), wi_set1(1u << k));
        number = wi_add(number, wi_select(along, wi_set1(8u * k), bit));
    }
    return number;
}

/* Where two edges cross, seen along the normal; for those of `crossing` that do. */
static void bx_cross(const bx_boxes *x, wm crossing, bx_manifold *out) {
    const bx_axis *axis = &out->axis;
    wf a[3], b[3], c[3], d[3], p[3], back[3] = {wf_neg(axis->nb[0]), wf_neg(axis->nb[1]), wf_neg(axis->nb[2])};
    wi ia = bx_edge(x->ha, axis->n, axis->i, a), ib = bx_edge(x->hb, back, axis->j, b);
    bx_axes i = bx_axes_of(axis->i), j = bx_axes_of(axis->j);
    for (int k = 0; k < 3; k++) {
        c[k] = bx_pick(j, x->r[k][0], x->r[k][1], x->r[k][2]);
        d[k] = wf_sub(wf_add(x->t[k], bx_dot(x->r[k], b)), a[k]);
    }
    wf ha = bx_pick(i, x->ha[0], x->ha[1], x->ha[2]), hb = bx_pick(j, x->hb[0], x->hb[1], x->hb[2]);
    wf cosine = bx_pick(i, c[0], c[1], c[2]), du = bx_pick(i, d[0], d[1], d[2]), dw = bx_dot(d, c);
    wf s = wf_div(wf_sub(du, wf_mul(cosine, dw)), axis->sine2), t = wf_sub(wf_mul(s, cosine), dw);
    wf most = wf_set1(1.0f + 2.0f * TL_SIDE_SLACK);
    wm on = wm_and(wf_le(wf_abs(s), wf_mul(ha, most)), wf_le(wf_abs(t), wf_mul(hb, most)));
    s = wf_min(wf_max(s, wf_neg(ha)), ha);
    t = wf_min(wf_max(t, wf_neg(hb)), hb);
    for (int k = 0; k < 3; k++) {
        wf q = wf_mad(d[k], t, c[k]); /* from the middle of A's edge */
        p[k] = wf_where(wf_eq(axis->i, wf_set1((float)k)), s);
        d[k] = wf_sub(q, p[k]);
        p[k] = wf_add(a[k], wf_mul(wf_set1(0.5f), wf_add(p[k], q)));
    }
    wf gap = bx_dot(axis->n, d);
    on = wm_and(wm_and(crossing, on), wf_le(gap, x->margin));
    out->count = wf_select(crossing, wf_where(on, wf_set1(1.0f)), out->count);
    for (int k = 0; k < 3; k++) {
        out->p[0][k] = wf_select(crossing, p[k], out->p[0][k]);
    }
    out->separation[0] = wf_select(crossing, wf_max(gap, axis->separation), out->separation[0]);
    wi id = wi_add(wi_add(wi_set1(TL_ID_EDGES << 30), wi_shl(ia, 15)), ib);
    out->id[0] = wi_select(crossing, id, out->id[0]);
}

/* The points along the axis. An axis is right where points are as near as it says. */
static void bx_meet(const bx_boxes *x, wf tolerance, wm near, bx_manifold *out) {
    const bx_axis *axis = &out->axis;
    wf square = wf_max(bx_most(axis->n), bx_most(axis->nb));
    wm crossing = wm_and(axis->edges, wf_lt(square, wf_set1(TL_FACE_COS)));
    out->count = wf_set1(0.0f);
    out->beside = wm_and(crossing, wf_le(axis->sine2, wf_set1(BX_PARALLEL_SIN2)));
    if (wm_any(wm_andnot(crossing, near))) {
        bx_faces f;
        bx_points q;
        bx_set_faces(x, axis, &f);
        out->count = bx_clip(&f, x->margin, tolerance, &q);
        bx_to_a(x, &f, &q, out);
    }
    if (wm_any(wm_and(crossing, near))) {
        bx_cross(x, crossing, out);
    }
    wf least = out->separation[0];
    for (int i = 1; i < TL_MANIFOLD_POINTS; i++) {
        wm there = wf_lt(wf_set1((float)i), out->count);
        least = wf_select(there, wf_min(out->separation[i], least), least);
    }
    wm is = wm_andnot(out->beside, wf_lt(wf_set1(0.0f), out->count));
    wm overlap = wf_le(axis->separation, wf_set1(0.0f));
    wm realised = wf_le(least, wf_mad(tolerance, wf_set1(1.015f), axis->separation));
    out->decided = wm_or(out->decided, wm_and(near, wm_and(is, wm_or(overlap, realised))));
}

/* Boxes too far apart for their form to count are not decided. */
static void bx_collide(const bx_boxes *x, bx_manifold *out) {
    wf abs_r[3][3], zero = wf_set1(0.0f), tolerance = bx_tolerance(x);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            abs_r[i][j] = wf_abs(x->r[i][j]);
        }
    }
    bx_axis *axis = &out->axis;
    bx_best_face(x, abs_r, tolerance, axis);
    wm seen = wf_le(bx_most(x->t), wf_set1(TL_FAR_AWAY)), near = wm_and(seen, wf_le(axis->separation, x->margin));
    out->gap = axis->separation;
    out->count = zero;
    out->decided = wm_andnot(near, seen);
    if (!wm_any(near)) {
        return;
    }
    wf bias = wf_max(wf_mul(axis->separation, wf_set1(0.015f)), wf_mul(axis->separation, wf_set1(-2e-5f)));
    bx_best_edges(x, abs_r, wf_add(tolerance, bias), axis);
    out->gap = wf_select(near, axis->separation, out->gap);
    wm apart = wm_andnot(wf_le(axis->separation, x->margin), near);
    out->decided = wm_or(out->decided, apart);
    near = wm_andnot(apart, near);
    if (wm_any(near)) {
        bx_set_normal(x, axis);
        bx_meet(x, tolerance, near, out);
        out->count = wf_where(near, out->count);
    }
}
