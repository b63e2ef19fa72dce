/* A face of one box clipped against the sides of a face of another, seen along a normal: each edge by the sides across
 * x, then by those across y (as Sutherland & Hodgman, Reentrant Polygon Clipping, 1974, do one after the other), and
 * the corners of the reference that are left. For the width that the including file has chosen. Metres. */
#include "collide/feature.h"
#include "collide/general.h"

/* Which of three axes: the first, the second, else the third. */
typedef struct bx_axes {
    wm first, second;
} bx_axes;

static inline bx_axes bx_axes_of(wf number) {
    bx_axes a = {wf_eq(number, wf_set1(0.0f)), wf_eq(number, wf_set1(1.0f))};
    return a;
}
/* The one along which a vector is longest. */
static inline bx_axes bx_longest(const wf *v) {
    wf x = wf_abs(v[0]), y = wf_abs(v[1]), z = wf_abs(v[2]);
    bx_axes a = {wm_and(wf_le(y, x), wf_le(z, x)), wf_le(z, y)};
    return a;
}
static inline wf bx_pick(bx_axes a, wf x, wf y, wf z) { return wf_select(a.first, x, wf_select(a.second, y, z)); }
static inline wi bx_pick_bit(bx_axes a, uint32_t x, uint32_t y, uint32_t z) {
    return wi_select(a.first, wi_set1(x), wi_select(a.second, wi_set1(y), wi_set1(z)));
}

/* Two faces that look at each other, in the frame of the reference: z its own axis, x and y the ones that follow. */
typedef struct bx_faces {
    wm a;                      /* the reference is a face of A */
    bx_axes z_axis, inc_axis;  /* of the boxes */
    wm positive, inc_positive; /* which of the two faces across the axis */
    wf hx, hy, hz;             /* half sizes of the reference */
    wf sign;                   /* -1 where its face looks along -z */
    wf nx, ny, nz;             /* the normal; nz > 0 is outward */
    wf band;                   /* m: beyond the sides by this much a corner stands for the crossing beside it */
    wf cx, cy, cz;             /* the middle of the incident face, as its corners are */
    wf slope_x, slope_y;       /* of z over the incident face */
    wf reach;                  /* m: about how far apart corners may be */
    wf x[4], y[4], z[4]; /* the incident corners +u+v -u+v -u-v +u-v; z along the normal from the reference's plane, x
                            and y where that line meets it */
    wi corner[4], edge[4], side[4], own[4]; /* parts of point numbers: of the corners, the edges from each to the next,
                                               the sides +x -x +y -y, the reference's corners +x+y +x-y -x+y -x-y */
} bx_faces;

#define BX_SLOTS 12

/* Points of the clipped face, of which those marked are there: the start and the end of each edge, then the
 * reference's corners. */
typedef struct bx_slots {
    wf x[BX_SLOTS], y[BX_SLOTS], z[BX_SLOTS];
    wi id[BX_SLOTS];
    wm is[BX_SLOTS];
} bx_slots;

typedef struct bx_points {
    wf x[TL_MANIFOLD_POINTS], y[TL_MANIFOLD_POINTS], z[TL_MANIFOLD_POINTS];
    wi id[TL_MANIFOLD_POINTS];
} bx_points;

/* n: the normal outward from the reference, `to` the same in the incident box's frame, h and g the half sizes of both,
 * c where the incident box stands, m its axes: m[i][j] axis j along i. */
static void bx_place_faces(bx_faces *f, const wf *n, const wf *to, const wf *h, const wf *g, const wf *c, wf m[3][3]) {
    wf zero = wf_set1(0.0f), one = wf_set1(1.0f), minus = wf_set1(-1.0f);
    bx_axes z = bx_longest(n), w = bx_longest(to);
    f->z_axis = z, f->inc_axis = w;
    f->hx = bx_pick(z, h[1], h[2], h[0]), f->hy = bx_pick(z, h[2], h[0], h[1]), f->hz = bx_pick(z, h[0], h[1], h[2]);
    f->nx = bx_pick(z, n[1], n[2], n[0]), f->ny = bx_pick(z, n[2], n[0], n[1]), f->nz = bx_pick(z, n[0], n[1], n[2]);
    wf gi = bx_pick(w, g[0], g[1], g[2]), gu = bx_pick(w, g[1], g[2], g[0]), gv = bx_pick(w, g[2], g[0], g[1]);
    f->positive = wf_lt(zero, f->nz);
    f->sign = wf_select(f->positive, one, minus);
    f->nz = wf_abs(f->nz);
    f->inc_positive = wf_lt(bx_pick(w, to[0], to[1], to[2]), zero);
    gi = wf_select(f->inc_positive, gi, wf_neg(gi));
    wf d[3][3]; /* directions: of the incident axis, u and v; along x, y and in front of the reference */
    for (int k = 0; k < 3; k++) {
        wf a0 = bx_pick(z, m[1][k], m[2][k], m[0][k]), a1 = bx_pick(z, m[2][k], m[0][k], m[1][k]);
        wf a2 = wf_mul(f->sign, bx_pick(z, m[0][k], m[1][k], m[2][k]));
        d[0][k] = a0, d[1][k] = a1, d[2][k] = a2;
    }
    wf at[3] = {bx_pick(z, c[1], c[2], c[0]), bx_pick(z, c[2], c[0], c[1]),
                wf_sub(wf_mul(f->sign, bx_pick(z, c[0], c[1], c[2])), f->hz)};
    wf u[3], v[3];
    for (int i = 0; i < 3; i++) {
        at[i] = wf_mad(at[i], gi, bx_pick(w, d[i][0], d[i][1], d[i][2]));
        u[i] = bx_pick(w, d[i][1], d[i][2], d[i][0]);
        v[i] = bx_pick(w, d[i][2], d[i][0], d[i][1]);
    }
    wf inverse = wf_div(one, f->nz);
    at[2] = wf_mul(at[2], inverse), u[2] = wf_mul(u[2], inverse), v[2] = wf_mul(v[2], inverse);
    f->cx = wf_sub(at[0], wf_mul(f->nx, at[2])), f->cy = wf_sub(at[1], wf_mul(f->ny, at[2])), f->cz = at[2];
    u[0] = wf_sub(u[0], wf_mul(f->nx, u[2])), u[1] = wf_sub(u[1], wf_mul(f->ny, u[2]));
    v[0] = wf_sub(v[0], wf_mul(f->nx, v[2])), v[1] = wf_sub(v[1], wf_mul(f->ny, v[2]));
    wf det = wf_div(one, wf_sub(wf_mul(u[0], v[1]), wf_mul(u[1], v[0])));
    f->slope_x = wf_mul(wf_sub(wf_mul(u[2], v[1]), wf_mul(v[2], u[1])), det);
    f->slope_y = wf_mul(wf_sub(wf_mul(u[0], v[2]), wf_mul(v[0], u[2])), det);
    f->band = wf_mul(wf_set1(2.0f * TL_SIDE_SLACK), wf_min(wf_min(f->hx, f->hy), wf_min(gu, gv)));
    f->reach = wf_min(wf_add(f->hx, f->hy), wf_add(gu, gv));
    for (int i = 0; i < 3; i++) {
        wf *to_corner = i == 0 ? f->x : i == 1 ? f->y : f->z;
        wf mid = i == 0 ? f->cx : i == 1 ? f->cy : f->cz, gu_i = wf_mul(gu, u[i]), gv_i = wf_mul(gv, v[i]);
        wf high = wf_add(mid, gv_i), low = wf_sub(mid, gv_i);
        to_corner[0] = wf_add(high, gu_i), to_corner[1] = wf_sub(high, gu_i);
        to_corner[2] = wf_sub(low, gu_i), to_corner[3] = wf_add(low, gu_i);
    }
}

/* The numbers of a face's corners and edges as feature.h has them: a corner's bits say where it is along each axis, an
 * edge has the number of its lower corner and 8 times its axis. */
static void bx_name_faces(bx_faces *f) {
    wi zero = wi_set1(0);
    wi x = bx_pick_bit(f->z_axis, 2, 4, 1), y = bx_pick_bit(f->z_axis, 4, 1, 2), z = bx_pick_bit(f->z_axis, 1, 2, 4);
    wi along_x = bx_pick_bit(f->z_axis, 8, 16, 0), along_y = bx_pick_bit(f->z_axis, 16, 0, 8);
    wi u = bx_pick_bit(f->inc_axis, 2, 4, 1), v = bx_pick_bit(f->inc_axis, 4, 1, 2);
    wi w = bx_pick_bit(f->inc_axis, 1, 2, 4);
    wi along_u = bx_pick_bit(f->inc_axis, 8, 16, 0), along_v = bx_pick_bit(f->inc_axis, 16, 0, 8);
    z = wi_select(f->positive, z, zero);
    w = wi_select(f->inc_positive, w, zero);
    wi xz = wi_add(x, z), uw = wi_add(u, w), vw = wi_add(v, w);
    wi of_a = wi_set1(TL_ID_VERTEX_A << 30), of_b = wi_set1(TL_ID_VERTEX_B << 30);
    wi inc_kind = wi_select(f->a, of_b, of_a), own_kind = wi_select(f->a, of_a, of_b);
    wi corner[4] = {wi_add(uw, v), vw, w, uw}, own[4] = {wi_add(xz, y), xz, wi_add(y, z), z};
    wi edge[4] = {wi_add(vw, along_u), wi_add(w, along_v), wi_add(w, along_u), wi_add(uw, along_v)};
    wi side[4] = {wi_add(xz, along_y), wi_add(z, along_y), wi_add(wi_add(y, z), along_x), wi_add(z, along_x)};
    for (int k = 0; k < 4; k++) {
        f->corner[k] = wi_add(inc_kind, wi_shl(corner[k], 15));
        f->own[k] = wi_add(own_kind, wi_shl(own[k], 15));
        f->edge[k] = wi_add(wi_set1(TL_ID_EDGES << 30), wi_select(f->a, edge[k], wi_shl(edge[k], 15)));
        f->side[k] = wi_select(f->a, wi_shl(side[k], 15), side[k]);
    }
}

/* What two opposite sides, at -h and h, leave of an edge from p to q along their axis. A point up to the band outside
 * stays, and stands for the crossing beside it. */
typedef struct bx_cut {
    wm p_high, p_low, q_high, q_low; /* beyond a side and the band */
    wm enters, leaves;               /* it crosses a side: at these parts of the way */
    wf at_entry, at_exit;            /* at_entry is 0 where it does not enter */
} bx_cut;

static inline bx_cut bx_cut_of(wf p, wf q, wf h, wf band) {
    bx_cut c;
    wf zero = wf_set1(0.0f), beyond = wf_neg(band);
    wf over_p = wf_sub(h, p), under_p = wf_add(h, p), over_q = wf_sub(h, q), under_q = wf_add(h, q);
    c.p_high = wf_lt(over_p, beyond), c.p_low = wf_lt(under_p, beyond);
    c.q_high = wf_lt(over_q, beyond), c.q_low = wf_lt(under_q, beyond);
    wf p_in = wf_select(c.p_high, over_p, under_p), q_in = wf_select(c.p_high, over_q, under_q);
    wf p_out = wf_select(c.q_high, over_p, under_p), q_out = wf_select(c.q_high, over_q, under_q);
    c.enters = wm_and(wm_or(c.p_high, c.p_low), wf_lt(zero, q_in));
    c.leaves = wm_and(wm_or(c.q_high, c.q_low), wf_lt(zero, p_out));
    c.at_entry = wf_where(c.enters, wf_div(p_in, wf_sub(p_in, q_in)));
    c.at_exit = wf_div(p_out, wf_sub(p_out, q_out));
    return c;
}

/* Where the clipped face comes to the sides across x, high and low, and leaves them. */
typedef struct bx_rails {
    wf from[2], to[2];
    wm cut[2];
} bx_rails;

static inline wf bx_along(wf from, wf t, wf to) { return wf_mad(from, t, wf_sub(to, from)); }

static inline void bx_clip_edge(const bx_faces *f, int k, bx_rails *rails, bx_slots *s) {
    int next = (k + 1) & 3, start = 2 * k, end = 2 * k + 1;
    wf px = f->x[k], py = f->y[k], pz = f->z[k], qx = f->x[next], qy = f->y[next], qz = f->z[next];
    bx_cut x = bx_cut_of(px, qx, f->hx, f->band);
    wf ax = bx_along(px, x.at_entry, qx), ay = bx_along(py, x.at_entry, qy), az = bx_along(pz, x.at_entry, qz);
    wm q_out = wm_or(x.q_high, x.q_low);
    wf bx = wf_select(x.leaves, bx_along(px, x.at_exit, qx), wf_select(q_out, ax, qx));
    wf by = wf_select(x.leaves, bx_along(py, x.at_exit, qy), wf_select(q_out, ay, qy));
    wf bz = wf_select(x.leaves, bx_along(pz, x.at_exit, qz), wf_select(q_out, az, qz));
    wf entry = wf_select(x.enters, ay, qy);
    wm exits[2] = {wm_andnot(x.p_high, x.q_high), wm_andnot(x.p_low, x.q_low)};
    wm entries[2] = {wm_andnot(x.q_high, x.p_high), wm_andnot(x.q_low, x.p_low)};
    for (int i = 0; i < 2; i++) {
        rails->from[i] = wf_select(exits[i], by, rails->from[i]);
        rails->to[i] = wf_select(entries[i], entry, rails->to[i]);
        rails->cut[i] = wm_or(rails->cut[i], exits[i]);
    }
    bx_cut y = bx_cut_of(ay, by, f->hy, f->band);
    wm x_out = wm_andnot(x.enters, wm_or(x.p_high, x.p_low)), y_out = wm_andnot(y.enters, wm_or(y.p_high, y.p_low));
    wm ends = wm_or(y.leaves, wm_andnot(wm_or(y.q_high, y.q_low), x.leaves));
    wi over = f->side[0], under = f->side[1], above = f->side[2], below = f->side[3];
    s->x[start] = bx_along(ax, y.at_entry, bx);
    s->y[start] = bx_along(ay, y.at_entry, by);
    s->z[start] = bx_along(az, y.at_entry, bz);
    wi in = wi_select(y.enters, wi_select(y.p_high, above, below), wi_select(x.p_high, over, under));
    s->id[start] = wi_select(wm_or(x.enters, y.enters), wi_add(f->edge[k], in), f->corner[k]);
    s->is[start] = wm_not(wm_or(x_out, y_out));
    s->x[end] = wf_select(y.leaves, bx_along(ax, y.at_exit, bx), bx);
    s->y[end] = wf_select(y.leaves, bx_along(ay, y.at_exit, by), by);
    s->z[end] = wf_select(y.leaves, bx_along(az, y.at_exit, bz), bz);
    wi out = wi_select(y.leaves, wi_select(y.q_high, above, below), wi_select(x.q_high, over, under));
    s->id[end] = wi_add(f->edge[k], out);
    s->is[end] = wm_andnot(x_out, ends);
}

/* The corner of the reference at the ends of two sides: within what runs along the one across x. */
static inline void bx_own_corner(const bx_faces *f, const bx_rails *rails, int k, bx_slots *s) {
    int low_x = k >> 1, low_y = k & 1, at = 8 + k;
    wf zero = wf_set1(0.0f), beyond = wf_neg(f->band);
    wf from = low_y ? wf_add(f->hy, rails->from[low_x]) : wf_sub(f->hy, rails->from[low_x]);
    wf to = low_y ? wf_add(f->hy, rails->to[low_x]) : wf_sub(f->hy, rails->to[low_x]);
    wm there = wm_or(wm_and(wf_lt(zero, from), wf_lt(to, beyond)), wm_and(wf_lt(zero, to), wf_lt(from, beyond)));
    s->x[at] = low_x ? wf_neg(f->hx) : f->hx;
    s->y[at] = low_y ? wf_neg(f->hy) : f->hy;
    s->z[at] = wf_mad(wf_mad(f->cz, f->slope_x, wf_sub(s->x[at], f->cx)), f->slope_y, wf_sub(s->y[at], f->cy));
    s->id[at] = f->own[k];
    s->is[at] = wm_and(rails->cut[low_x], there);
}

/* A point this much less deep must be that times further out to be kept instead. */
#define BX_GAP_WEIGHT 4.0f

static inline void bx_keep(bx_points *c, int j, wm m, const bx_slots *s, int i) {
    c->x[j] = wf_select(m, s->x[i], c->x[j]);
    c->y[j] = wf_select(m, s->y[i], c->y[j]);
    c->z[j] = wf_select(m, s->z[i], c->z[j]);
    c->id[j] = wi_select(m, s->id[i], c->id[j]);
}

/* Of more points than four one of the deepest, of about as deep ones the first, and the one furthest from it, each
 * weighed against how much less deep it is; *most is how much the second is worth, 0 if there is none. */
static void bx_choose_two(const bx_slots *s, wf reach, bx_points *deep, bx_points *c, wf *most) {
    wf zero = wf_set1(0.0f);
    deep->z[0] = wf_set1(3e38f);
    for (int i = 0; i < BX_SLOTS; i++) {
        bx_keep(deep, 0, wm_and(s->is[i], wf_lt(s->z[i], deep->z[0])), s, i);
    }
    wf least = deep->z[0], near = wf_mad(least, wf_set1(1e-3f), reach);
    for (int i = BX_SLOTS; i-- > 0;) {
        bx_keep(c, 0, wm_and(s->is[i], wf_le(s->z[i], near)), s, i);
    }
    *most = zero;
    for (int i = 0; i < BX_SLOTS; i++) {
        wf x = wf_sub(s->x[i], c->x[0]), y = wf_sub(s->y[i], c->y[0]);
        wf distance = wf_sqrt(wf_mad(wf_mul(x, x), y, y));
        wf score = wf_sub(distance, wf_mul(wf_set1(BX_GAP_WEIGHT), wf_sub(s->z[i], least)));
        wm better = wm_and(s->is[i], wf_lt(*most, score));
        *most = wf_select(better, score, *most);
        bx_keep(c, 1, better, s, i);
    }
}

/* Seen from the first point with x to the second, scaled by their distance: the one that makes the largest triangle
 * with them, then the one that adds the most to it, by the side that it is furthest beyond. */
static void bx_choose_more(const bx_slots *s, wf least, wf most, bx_points *c, wm has[2]) {
    wf x[BX_SLOTS], y[BX_SLOTS], penalty[BX_SLOTS], zero = wf_set1(0.0f);
    wf ux = wf_sub(c->x[1], c->x[0]), uy = wf_sub(c->y[1], c->y[0]), uu = wf_mad(wf_mul(ux, ux), uy, uy);
    wf weight = wf_mul(wf_set1(BX_GAP_WEIGHT), most), enough = wf_mul(wf_set1(1e-6f), wf_mul(most, most));
    wf best = enough, x2 = zero, y2 = zero;
    wm two = wf_lt(zero, most);
    has[0] = has[1] = wm_none();
    for (int i = 0; i < BX_SLOTS; i++) {
        wf dx = wf_sub(s->x[i], c->x[0]), dy = wf_sub(s->y[i], c->y[0]);
        x[i] = wf_mad(wf_mul(ux, dx), uy, dy);
        y[i] = wf_sub(wf_mul(ux, dy), wf_mul(uy, dx));
        penalty[i] = wf_mul(weight, wf_sub(s->z[i], least));
        wf area = wf_sub(wf_abs(y[i]), penalty[i]);
        wm better = wm_and(wm_and(s->is[i], two), wf_lt(best, area));
        best = wf_select(better, area, best);
        x2 = wf_select(better, x[i], x2), y2 = wf_select(better, y[i], y2);
        has[0] = wm_or(has[0], better);
        bx_keep(c, 2, better, s, i);
    }
    wf turn = wf_select(wf_lt(y2, zero), wf_set1(1.0f), wf_set1(-1.0f)), inverse = wf_div(wf_set1(1.0f), uu);
    best = enough;
    for (int i = 0; i < BX_SLOTS; i++) {
        wf s0 = wf_mul(turn, y[i]);
        wf s1 = wf_sub(wf_mul(wf_sub(x2, uu), y[i]), wf_mul(y2, wf_sub(x[i], uu)));
        wf s2 = wf_sub(wf_mul(y2, wf_sub(x[i], x2)), wf_mul(x2, wf_sub(y[i], y2)));
        wf beyond = wf_max(s0, wf_mul(wf_max(wf_mul(s1, turn), wf_mul(s2, turn)), inverse));
        wf area = wf_sub(beyond, penalty[i]);
        wm better = wm_and(wm_and(s->is[i], has[0]), wf_lt(best, area));
        best = wf_select(better, area, best);
        has[1] = wm_or(has[1], better);
        bx_keep(c, 3, better, s, i);
    }
}

/* Puts the deepest point in, where all that were chosen are less deep: as one more, or for the one beside it. */
static wf bx_choose_deepest(const bx_points *deep, wf tolerance, wf kept, bx_points *c) {
    wf zero = wf_set1(0.0f), one = wf_set1(1.0f), found = c->z[0], near2 = wf_set1(3e38f), place = kept;
    for (int j = 0; j < TL_MANIFOLD_POINTS; j++) {
        wm there = wf_lt(wf_set1((float)j), kept);
        found = wf_select(there, wf_min(c->z[j], found), found);
    }
    wm lacks = wf_lt(wf_add(deep->z[0], tolerance), found), full = wf_le(wf_set1(4.0f), kept);
    for (int j = 0; j < TL_MANIFOLD_POINTS; j++) {
        wf x = wf_sub(c->x[j], deep->x[0]), y = wf_sub(c->y[j], deep->y[0]), d2 = wf_mad(wf_mul(x, x), y, y);
        wm nearer = wm_and(full, wf_lt(d2, near2));
        place = wf_select(nearer, wf_set1((float)j), place);
        near2 = wf_select(nearer, d2, near2);
    }
    for (int j = 0; j < TL_MANIFOLD_POINTS; j++) {
        wm here = wm_and(lacks, wf_eq(place, wf_set1((float)j)));
        c->x[j] = wf_select(here, deep->x[0], c->x[j]);
        c->y[j] = wf_select(here, deep->y[0], c->y[j]);
        c->z[j] = wf_select(here, deep->z[0], c->z[j]);
        c->id[j] = wi_select(here, deep->id[0], c->id[j]);
    }
    return wf_add(kept, wf_select(wm_andnot(full, lacks), one, zero));
}

/* The points at most `margin` in front of the reference, at most four; returns how many. */
static wf bx_clip(const bx_faces *f, wf margin, wf tolerance, bx_points *out) {
    bx_slots s;
    wf zero = wf_set1(0.0f), one = wf_set1(1.0f), four = wf_set1(4.0f), count = zero;
    bx_rails rails = {{zero, zero}, {zero, zero}, {wm_none(), wm_none()}};
    for (int k = 0; k < 4; k++) {
        bx_clip_edge(f, k, &rails, &s);
        out->x[k] = out->y[k] = out->z[k] = zero;
        out->id[k] = wi_set1(0);
    }
    for (int k = 0; k < 4; k++) {
        bx_own_corner(f, &rails, k, &s);
    }
    for (int i = 0; i < BX_SLOTS; i++) {
        s.is[i] = wm_and(s.is[i], wf_le(s.z[i], margin));
        if (wm_any(s.is[i])) {
            for (int j = 0; j < TL_MANIFOLD_POINTS; j++) {
                bx_keep(out, j, wm_and(s.is[i], wf_eq(count, wf_set1((float)j))), &s, i);
            }
            count = wf_add(count, wf_where(s.is[i], one));
        }
    }
    wm many = wf_lt(four, count);
    if (wm_any(many)) {
        bx_points deep = *out, c = *out;
        wf most;
        wm has[2];
        bx_choose_two(&s, f->reach, &deep, &c, &most);
        bx_choose_more(&s, deep.z[0], most, &c, has);
        wf kept =
            wf_add(wf_add(one, wf_where(wf_lt(zero, most), one)), wf_add(wf_where(has[0], one), wf_where(has[1], one)));
        kept = bx_choose_deepest(&deep, tolerance, kept, &c);
        for (int j = 0; j < TL_MANIFOLD_POINTS; j++) {
            out->x[j] = wf_select(many, c.x[j], out->x[j]);
            out->y[j] = wf_select(many, c.y[j], out->y[j]);
            out->z[j] = wf_select(many, c.z[j], out->z[j]);
            out->id[j] = wi_select(many, c.id[j], out->id[j]);
        }
        count = wf_select(many, kept, count);
    }
    return count;
}
