/* Eight pairs at a time: where their shapes stand, and the manifolds of one point, of balls, capsules and boxes. The
 * order of operations is that of the queries of a single pair (collide/ball.c, base/vec.h), so that the bits are the
 * same. */
#include "collide/general.h"
#include "stage/narrow/batch.h"

#include "collide/capsules.inl"

typedef struct pose8 {
    v8 p;
    q8 q;
} pose8;

static pose8 pose8_load(const tl_row8 *rows, const uint32_t *index) {
    tl_f8 r[8];
    tl_f8_load_rows(rows->f, index, r);
    pose8 p = {v8_of(r[0], r[1], r[2]), q8_of(r[3], r[4], r[5], r[6])};
    return p;
}

static void rows_store(tl_row8 *to, tl_f8 r[8]) {
    tl_f8_transpose(r);
    for (int k = 0; k < 8; k++) {
        tl_f8_storeu(to[k].f, r[k]);
    }
}

static void pose8_store(tl_row8 *to, const pose8 *p) {
    tl_f8 r[8] = {p->p.x, p->p.y, p->p.z, p->q.x, p->q.y, p->q.z, p->q.w, tl_f8_zero()};
    rows_store(to, r);
}

static v8 pose8_point(const pose8 *a, v8 p) { return v8_add(q8_rotate(a->q, p), a->p); }
static v8 pose8_point_back(const pose8 *a, v8 p) { return q8_rotate_back(a->q, v8_sub(p, a->p)); }

static pose8 pose8_mul(const pose8 *a, const pose8 *b) {
    pose8 r = {pose8_point(a, b->p), q8_mul(a->q, b->q)};
    return r;
}

static v8 v8_neg(v8 a) { return v8_of(tl_f8_neg(a.x), tl_f8_neg(a.y), tl_f8_neg(a.z)); }

static tl_m8 is_usual(tl_f8 s) { /* neither too short nor too long to be made a unit */
    return tl_m8_and(tl_f8_gt(s, tl_f8_set1(1e-30f)), tl_f8_lt(s, tl_f8_set1(3e38f)));
}

static v8 v8_normalize_or(v8 a, v8 otherwise) {
    tl_f8 s = tl_f8_max(tl_f8_max(tl_f8_abs(a.x), tl_f8_abs(a.y)), tl_f8_abs(a.z));
    v8 b = v8_of(tl_f8_div(a.x, s), tl_f8_div(a.y, s), tl_f8_div(a.z, s));
    tl_f8 l = tl_f8_sqrt(v8_dot(b, b));
    return v8_select(is_usual(s), v8_of(tl_f8_div(b.x, l), tl_f8_div(b.y, l), tl_f8_div(b.z, l)), otherwise);
}

static q8 q8_normalize_or_identity(q8 q) {
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f);
    tl_f8 s = tl_f8_max(tl_f8_max(tl_f8_abs(q.x), tl_f8_abs(q.y)), tl_f8_max(tl_f8_abs(q.z), tl_f8_abs(q.w)));
    tl_m8 usual = is_usual(s);
    q = q8_normalize(q8_of(tl_f8_div(q.x, s), tl_f8_div(q.y, s), tl_f8_div(q.z, s), tl_f8_div(q.w, s)));
    return q8_of(tl_f8_select(usual, q.x, zero), tl_f8_select(usual, q.y, zero), tl_f8_select(usual, q.z, zero),
                 tl_f8_select(usual, q.w, one));
}

/* Where the shapes of a batch stand in the world and b in a's frame, and the margins (m) at which they part. */
typedef struct placed8 {
    pose8 place_a, place_b; /* on the bodies */
    pose8 a, b, b_in_a;
    tl_f8 margin;
} placed8;

static placed8 place8(const tl_step *step, const tl_pair_batch *batch) {
    const tl_header *h = step->h;
    placed8 s;
    tl_f8 v[8], w[8];
    pose8 body_a = pose8_load(tl_body_pose(h), batch->body_a), body_b = pose8_load(tl_body_pose(h), batch->body_b);
    s.place_a = pose8_load(tl_shape_place(h), batch->shape_a),
    s.place_b = pose8_load(tl_shape_place(h), batch->shape_b);
    s.a = pose8_mul(&body_a, &s.place_a), s.b = pose8_mul(&body_b, &s.place_b);
    s.b_in_a.p = pose8_point_back(&s.a, s.b.p);
    s.b_in_a.q = q8_normalize_or_identity(q8_mul(q8_conjugate(s.a.q), s.b.q));
    tl_f8_load_rows(tl_body_velocity(h)->f, batch->body_a, v);
    tl_f8_load_rows(tl_body_velocity(h)->f, batch->body_b, w);
    v8 d = v8_sub(v8_of(v[0], v[1], v[2]), v8_of(w[0], w[1], w[2]));
    tl_f8 speed = tl_f8_min(tl_f8_sqrt(v8_dot(d, d)), tl_f8_set1(1e6f));
    s.margin = tl_f8_mad(tl_f8_set1(h->settings.speculative_margin), speed, tl_f8_set1(step->dt));
    s.margin = tl_f8_select(tl_m8_from_bits(batch->senses), tl_f8_zero(), s.margin);
    return s;
}

static void place_pairs(const tl_step *step, tl_pair_batch *batch) {
    placed8 s = place8(step, batch);
    pose8_store(batch->a, &s.a);
    pose8_store(batch->b, &s.b);
    pose8_store(batch->b_in_a, &s.b_in_a);
    tl_f8_storeu(batch->margin, s.margin);
}

static pose8 pose8_select(tl_m8 m, const pose8 *a, const pose8 *b) {
    pose8 r = {v8_select(m, a->p, b->p), q8_of(tl_f8_select(m, a->q.x, b->q.x), tl_f8_select(m, a->q.y, b->q.y),
                                               tl_f8_select(m, a->q.z, b->q.z), tl_f8_select(m, a->q.w, b->q.w))};
    return r;
}

/* From the shapes' frames to those in which contacts keep their points. */
typedef struct kept8 {
    pose8 a, b;
} kept8;

static kept8 kept8_of(const tl_pair_batch *batch, const placed8 *s) {
    kept8 k = {pose8_select(tl_m8_from_bits(batch->fixed_a), &s->a, &s->place_a),
               pose8_select(tl_m8_from_bits(batch->fixed_b), &s->b, &s->place_b)};
    return k;
}

/* A point of each manifold, from shape a's frame into those of the bodies: a record with its impulse and number. */
static void point_rows(const kept8 *k, const placed8 *s, v8 n, v8 at, tl_f8 separation, tl_f8 row[8]) {
    v8 half = v8_scale(n, tl_f8_mul(tl_f8_set1(0.5f), separation));
    v8 on_a = pose8_point(&k->a, v8_sub(at, half));
    v8 on_b = pose8_point(&k->b, pose8_point_back(&s->b_in_a, v8_add(at, half)));
    row[0] = on_a.x, row[1] = on_a.y, row[2] = on_a.z;
    row[3] = on_b.x, row[4] = on_b.y, row[5] = on_b.z;
}

static void normal_rows(const kept8 *k, v8 n, tl_row8 *to) {
    v8 m = q8_rotate(k->a.q, n);
    tl_f8 r[8] = {m.x, m.y, m.z, tl_f8_zero(), tl_f8_zero(), tl_f8_zero(), tl_f8_zero(), tl_f8_zero()};
    rows_store(to, r);
}

/* Manifolds of one point each. */
static void store_points(const tl_pair_batch *batch, const placed8 *s, v8 n, v8 at, tl_f8 separation,
                         tl_one_points *out) {
    kept8 k = kept8_of(batch, s);
    tl_f8 p[8];
    point_rows(&k, s, n, at, separation, p);
    p[6] = p[7] = tl_f8_zero();
    rows_store(out->point, p);
    normal_rows(&k, n, out->normal);
    tl_f8_storeu(out->gap, separation);
    tl_f8_storeu(out->margin, s->margin);
}

/* The signed distance of a point to a box (collide/ball.c). */
static tl_f8 box_distance8(v8 half, v8 p, v8 *n) {
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f), minus = tl_f8_set1(-1.0f);
    v8 q = v8_sub(v8_of(tl_f8_abs(p.x), tl_f8_abs(p.y), tl_f8_abs(p.z)), half);
    v8 sign = v8_of(tl_f8_select(tl_f8_ge(p.x, zero), one, minus), tl_f8_select(tl_f8_ge(p.y, zero), one, minus),
                    tl_f8_select(tl_f8_ge(p.z, zero), one, minus));
    tl_m8 inside = tl_m8_and(tl_m8_and(tl_f8_le(q.x, zero), tl_f8_le(q.y, zero)), tl_f8_le(q.z, zero));
    tl_m8 xy = tl_f8_ge(q.x, q.y), x = tl_m8_and(xy, tl_f8_ge(q.x, q.z));
    tl_m8 y = tl_m8_andnot(xy, tl_f8_ge(q.y, q.z));
    v8 face =
        v8_of(tl_f8_select(x, sign.x, zero), tl_f8_select(y, sign.y, zero), tl_f8_select(tl_m8_or(x, y), zero, sign.z));
    tl_f8 depth = tl_f8_select(x, q.x, tl_f8_select(y, q.y, q.z));
    v8 out = v8_mul(v8_of(tl_f8_max(q.x, zero), tl_f8_max(q.y, zero), tl_f8_max(q.z, zero)), sign);
    v8 m = v8_normalize_or(out, sign);
    *n = v8_select(inside, face, m);
    return tl_f8_select(inside, depth, v8_dot(m, out));
}

static void collide_balls(const tl_step *step, const tl_pair_batch *batch, tl_one_points *out) {
    const float *geometry = (const float *)(const void *)tl_shape_geometry(step->h);
    uint32_t stride = sizeof(talus_geometry) / sizeof(float);
    tl_f8 a[8], b[8], half = tl_f8_set1(-0.5f);
    placed8 s = place8(step, batch);
    tl_f8_load_rows_stride(geometry, stride, batch->shape_a, a);
    tl_f8_load_rows_stride(geometry, stride, batch->shape_b, b);
    v8 n, at;
    tl_f8 distance, radius;
    if (batch->kind == TL_BATCH_BALL_BOX) { /* the box is where the ball is looked at from */
        v8 center = v8_neg(q8_rotate_back(s.b_in_a.q, s.b_in_a.p));
        distance = box_distance8(v8_of(b[5], b[6], b[7]), center, &n);
        radius = a[1];
        at = v8_mad(center, tl_f8_mul(half, tl_f8_add(distance, radius)), n);
        n = v8_neg(q8_rotate(s.b_in_a.q, n));
        at = pose8_point(&s.b_in_a, at);
    } else {
        if (batch->kind == TL_BATCH_BOX_BALL) {
            distance = box_distance8(v8_of(a[5], a[6], a[7]), s.b_in_a.p, &n);
        } else {
            n = v8_normalize_or(s.b_in_a.p, v8_of(tl_f8_zero(), tl_f8_set1(1.0f), tl_f8_zero()));
            distance = tl_f8_sub(v8_dot(n, s.b_in_a.p), a[1]);
        }
        radius = b[1];
        at = v8_mad(s.b_in_a.p, tl_f8_mul(half, tl_f8_add(distance, radius)), n);
    }
    out->decided = 0xffu;
    store_points(batch, &s, n, at, tl_f8_sub(distance, radius), out);
}

/* Half of the axis, 0 of a ball, and the radius. */
static void capsules_load(const tl_step *step, const uint32_t *shape, tl_f8 *half, tl_f8 *radius) {
    const float *geometry = (const float *)(const void *)tl_shape_geometry(step->h);
    tl_f8 g[8];
    tl_f8_load_rows_stride(geometry, sizeof(talus_geometry) / sizeof(float), shape, g);
    tl_m8 ball = tl_i8_eq(tl_i8_bits_of_f8(g[0]), tl_i8_set1(TALUS_SPHERE));
    *half = tl_f8_select(ball, tl_f8_zero(), g[2]);
    *radius = tl_f8_select(ball, g[1], g[3]);
}

static void collide_capsules(const tl_step *step, const tl_pair_batch *batch, tl_one_points *out) {
    placed8 s = place8(step, batch);
    cp_capsules x;
    cp_touch m;
    capsules_load(step, batch->shape_a, &x.ha, &x.ra);
    capsules_load(step, batch->shape_b, &x.hb, &x.rb);
    v8 t = s.b_in_a.p, ub = q8_rotate(s.b_in_a.q, v8_of(tl_f8_zero(), x.hb, tl_f8_zero()));
    x.t[0] = t.x, x.t[1] = t.y, x.t[2] = t.z;
    x.ub[0] = ub.x, x.ub[1] = ub.y, x.ub[2] = ub.z;
    x.margin = s.margin;
    cp_collide(&x, &m);
    v8 at = v8_of(cp_midway(&x, &m, 0), cp_midway(&x, &m, 1), cp_midway(&x, &m, 2));
    out->decided = tl_m8_bits(m.decided);
    store_points(batch, &s, v8_of(m.n[0], m.n[1], m.n[2]), at, m.gap, out);
}
