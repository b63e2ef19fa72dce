/* Two capsules of one radius each, or a capsule and a ball, for the width that the including file has chosen by
 * width_one.h or width_eight.h: the nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
 * Metres, in A's frame. */

/* The squared sine of 2 degrees: segments closer to parallel meet in two points. */
#define CP_PARALLEL_SIN2 0.0012f

/* A's axis is (0, ha, 0), B's is ub, both from the centre to an end; a ball's is 0. */
typedef struct cp_capsules {
    wf ha, hb, ra, rb;
    wf t[3], ub[3]; /* B's centre and axis */
    wf margin;
} cp_capsules;

typedef struct cp_touch {
    wm decided; /* else the axes meet, or the capsules do side by side */
    wm meet;    /* the axes */
    wf gap, n[3], pa[3], pb[3];
    wf cross2; /* the square of the cross product of the axes */
} cp_touch;

static inline wf cp_dot(const wf *a, const wf *b) { return wf_mad(wf_mad(wf_mul(a[0], b[0]), a[1], b[1]), a[2], b[2]); }
static inline wf cp_clamp(wf a) { return wf_min(wf_max(a, wf_set1(-1.0f)), wf_set1(1.0f)); }

/* Parameters run from -1 to 1. */
static void cp_nearest(const cp_capsules *x, cp_touch *out) {
    const wf *u = x->ub, *d = x->t;
    wf zero = wf_set1(0.0f), aa = wf_mul(x->ha, x->ha), bb = wf_mul(x->hb, x->hb), ab = wf_mul(x->ha, u[1]);
    wf da = wf_mul(d[1], x->ha), db = cp_dot(d, u), per_aa = wf_inverse(aa), per_bb = wf_inverse(bb);
    wf cx = wf_mul(x->ha, u[2]), cz = wf_neg(wf_mul(x->ha, u[0])); /* across both */
    wf dx = wf_sub(wf_mul(d[1], u[2]), wf_mul(d[2], u[1])), dz = wf_sub(wf_mul(d[0], u[1]), wf_mul(d[1], u[0]));
    out->cross2 = wf_mad(wf_mul(cx, cx), cz, cz);
    wm cross = wf_lt(wf_mul(wf_mul(wf_set1(1e-7f), aa), bb), out->cross2);
    wf at = wf_div(wf_mad(wf_mul(dx, cx), dz, cz), out->cross2);
    wf s = cp_clamp(wf_select(cross, at, wf_mul(da, per_aa)));
    wf free = wf_mul(wf_sub(wf_mul(s, ab), db), per_bb), t = cp_clamp(free);
    s = wf_select(wf_eq(free, t), s, cp_clamp(wf_mul(wf_mad(da, t, ab), per_aa)));
    out->pa[0] = out->pa[2] = zero;
    out->pa[1] = wf_mul(s, x->ha);
    for (int k = 0; k < 3; k++) {
        out->pb[k] = wf_mad(d[k], t, u[k]);
    }
}

/* Whether the capsules lie side by side, where the normal is ny along A's axis. */
static inline wm cp_is_beside(const cp_capsules *x, wf cross2, wf ny) {
    wf aa = wf_mul(x->ha, x->ha), bb = wf_mul(x->hb, x->hb), zero = wf_set1(0.0f), na = wf_mul(ny, x->ha);
    wm parallel = wf_le(cross2, wf_mul(wf_set1(CP_PARALLEL_SIN2), wf_mul(aa, bb)));
    wm across = wf_le(wf_mul(na, na), wf_mul(wf_set1(0.03f), aa));
    return wm_and(wm_and(parallel, across), wm_and(wf_lt(zero, aa), wf_lt(zero, bb)));
}

/* Capsules too far apart for their form to count are not decided. */
static void cp_collide(const cp_capsules *x, cp_touch *out) {
    wf d[3], sum = wf_add(x->ra, x->rb), size = wf_add(wf_add(x->ha, x->hb), sum);
    cp_nearest(x, out);
    for (int k = 0; k < 3; k++) {
        d[k] = wf_sub(out->pb[k], out->pa[k]);
    }
    wf distance = wf_sqrt(cp_dot(d, d));
    for (int k = 0; k < 3; k++) {
        out->n[k] = wf_div(d[k], distance);
    }
    wf far = wf_max(wf_max(wf_abs(x->t[0]), wf_abs(x->t[1])), wf_abs(x->t[2]));
    wm seen = wf_le(far, wf_set1(TL_FAR_AWAY));
    out->gap = wf_sub(distance, sum);
    out->meet = wf_le(distance, wf_mul(wf_set1(1e-6f), size));
    wm apart = wf_lt(x->margin, out->gap), beside = cp_is_beside(x, out->cross2, out->n[1]);
    out->decided = wm_and(wm_andnot(out->meet, seen), wm_or(apart, wm_not(beside)));
}

/* Midway between the surfaces. */
static inline wf cp_midway(const cp_capsules *x, const cp_touch *m, int k) {
    wf a = wf_mad(m->pa[k], x->ra, m->n[k]), b = wf_sub(m->pb[k], wf_mul(x->rb, m->n[k]));
    return wf_mul(wf_set1(0.5f), wf_add(a, b));
}
