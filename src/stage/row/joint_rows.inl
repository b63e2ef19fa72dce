/* Joint rows: eight joints of one kind at a time become Jacobians, errors and effective masses. They are made anew
 * after every change of the poses, so that a joint neither stretches nor gains energy while its bodies turn: half of
 * the impulse that bends a body's path acts before it moves, along the old rows, and half after, along the new ones, as
 * in RATTLE (Andersen, "RATTLE: a velocity version of SHAKE", J. Comput. Phys. 52, 1983). The first half is foreseen by
 * the curve of the anchors' paths, w x (w x r) h / 2.
 *
 * Angles are read off the relative quaternion: the twist about an axis is 2 atan2(q_axis, w), the swing of that axis
 * 2 atan2(|q_others|, |(q_axis, w)|) (Dobrowolski, "Swing-twist decomposition in Clifford algebra", 2015). */
#include "base/trig_lanes.h"

typedef struct joint_bodies {
    uint32_t sides; /* TL_JOINT_A and TL_JOINT_B */
    v8 xa, xb;
    q8 qa, qb;
    k8 ka, kb;
    tl_f8 ma, mb, ta, tb;
    v8 curve;      /* m/s: of anchor b against anchor a */
    v8 pa, pb;     /* the frames' origins in the world */
    v8 a[3], b[3]; /* the frames' axes in the world */
    q8 turn;       /* of frame b in frame a, w >= 0, if some row tells it */
} joint_bodies;

static inline void axes_of(q8 q, v8 out[3]) {
    v8 one = v8_of(tl_f8_set1(1.0f), tl_f8_set1(1.0f), tl_f8_set1(1.0f));
    k8 k = k8_of(q, one);
    out[0] = k.x, out[1] = k.y, out[2] = k.z;
}

/* w x (w x r), fading out where a body turns so far in a sub-step that the curve is no guide any more. */
static inline v8 bend(v8 w, v8 r, tl_f8 h) {
    tl_f8 turn = tl_f8_mul(tl_f8_mul(h, h), v8_dot(w, w));
    tl_f8 trust = tl_f8_max(tl_f8_sub(tl_f8_set1(1.0f), tl_f8_mul(tl_f8_set1(4.0f), turn)), tl_f8_zero());
    return v8_scale(v8_cross(w, v8_cross(w, r)), trust);
}

static inline k8 k8_load(const float k[9][TL_LANES]) {
    k8 r = {v8_load(k[0]), v8_load(k[3]), v8_load(k[6])};
    return r;
}

/* K stays as it is for a step. */
static void keep_frames(const tl_step *step, tl_joint_group *g) {
    const float *frames = tl_row_frame(step->h)->f, *velocities = tl_row_velocity(step->h)->f;
    tl_f8 r[8];
    for (uint32_t side = 0; side < 2u; side++) {
        tl_f8_load_rows(frames, side ? g->b : g->a, r);
        k8 k = k8_of(q8_of(r[0], r[1], r[2], r[3]), v8_of(r[4], r[5], r[6]));
        v8_store(g->k[side][0], k.x);
        v8_store(g->k[side][3], k.y);
        v8_store(g->k[side][6], k.z);
        tl_f8_load_rows(velocities, side ? g->b : g->a, r);
        tl_f8_store(g->mass[side], r[6]);
    }
}

/* Frame a in the world. */
static inline q8 frame_of(const tl_step *step, const tl_joint_group *g) {
    tl_f8 r[8];
    tl_f8_load_rows(tl_row_pose(step->h)->f, g->a, r);
    q8 own = q8_of(tl_f8_load(g->qa[0]), tl_f8_load(g->qa[1]), tl_f8_load(g->qa[2]), tl_f8_load(g->qa[3]));
    return q8_mul(q8_of(r[3], r[4], r[5], r[6]), own);
}

/* The impulses of rows that hold a point, from frame a's axes to the world's. */
static inline void impulses_to_world(const tl_step *step, const tl_joint_group *g, tl_joint_row *rows) {
    v8 along = v8_of(tl_f8_load(rows[0].impulse), tl_f8_load(rows[1].impulse), tl_f8_load(rows[2].impulse));
    v8 impulse = q8_rotate(frame_of(step, g), along);
    tl_f8_store(rows[0].impulse, impulse.x);
    tl_f8_store(rows[1].impulse, impulse.y);
    tl_f8_store(rows[2].impulse, impulse.z);
}

/* |arm| over the least moment of inertia about an axis across it; 0 for a body without a row. */
static tl_f8 give_of(const tl_header *h, const uint32_t row[TL_LANES], v8 arm) {
    uint32_t body[TL_LANES], moves = 0;
    tl_f8 in[8], zero = tl_f8_zero();
    for (uint32_t k = 0; k < TL_LANES; k++) {
        body[k] = row[k] ? tl_awake_body(h)[row[k] - 1u] : 0u;
        moves |= (uint32_t)(row[k] != 0) << k;
    }
    tl_f8_load_rows(&tl_body_inertias(h)->inverse_mass, body, in);
    tl_f8 square = v8_dot(arm, arm), x = tl_f8_sub(square, tl_f8_mul(arm.x, arm.x));
    tl_f8 y = tl_f8_sub(square, tl_f8_mul(arm.y, arm.y)), z = tl_f8_sub(square, tl_f8_mul(arm.z, arm.z));
    tl_f8 most = tl_f8_max(tl_f8_mul(tl_f8_mul(in[1], in[1]), x), tl_f8_mul(tl_f8_mul(in[2], in[2]), y));
    most = tl_f8_max(most, tl_f8_mul(tl_f8_mul(in[3], in[3]), z));
    tl_m8 ok = tl_m8_and(tl_f8_gt(square, zero), tl_m8_from_bits(moves));
    return tl_f8_and_mask(ok, tl_f8_div(most, tl_f8_select(ok, tl_f8_sqrt(square), tl_f8_set1(1.0f))));
}

/* Whether a joint of the group pulls hard enough to be looked at. */
static void note_pull(const tl_step *step, tl_joint_group *g, tl_f8 pull) {
    tl_f8 give = tl_f8_max(tl_f8_load(g->give[0]), tl_f8_load(g->give[1]));
    tl_f8_store(g->pull, pull);
    g->stiff = (uint32_t)tl_m8_any(tl_f8_gt(tl_f8_mul(pull, give), tl_f8_set1(TL_STIFF_PULL * step->inverse_sub)));
}

static uint32_t sides_of(const tl_joint_group *g) {
    uint32_t a = g->linked, b = g->linked;
    for (uint32_t k = 0; k < TL_LANES; k++) {
        a |= g->a[k], b |= g->b[k];
    }
    return (a ? (uint32_t)TL_JOINT_A : 0u) | (b ? (uint32_t)TL_JOINT_B : 0u);
}

/* What stays as it is for a step, and the impulses and pulls that the last step ended with. */
static void prepare_joints(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        g->needs |= sides_of(g);
        keep_frames(step, g);
        if (g->needs & TL_JOINT_POINT) {
            impulses_to_world(step, g, tl_joint_row_pool(step->h) + g->first_row);
        }
        if (g->linked) {
            v8 force = v8_load(g->x[0]);
            tl_f8_store(g->give[0], give_of(step->h, g->a, v8_load(g->pa[0])));
            tl_f8_store(g->give[1], give_of(step->h, g->b, v8_load(g->pb[0])));
            note_pull(step, g, tl_f8_mul(tl_f8_sqrt(v8_dot(force, force)), tl_f8_set1(step->sub)));
        }
    }
}

static void load_joint_frames(const tl_joint_group *g, joint_bodies *c) {
    q8 fa =
        q8_mul(c->qa, q8_of(tl_f8_load(g->qa[0]), tl_f8_load(g->qa[1]), tl_f8_load(g->qa[2]), tl_f8_load(g->qa[3])));
    axes_of(fa, c->a);
    q8 fb =
        q8_mul(c->qb, q8_of(tl_f8_load(g->qb[0]), tl_f8_load(g->qb[1]), tl_f8_load(g->qb[2]), tl_f8_load(g->qb[3])));
    axes_of(fb, c->b);
    c->turn = fb;
    if (!(g->needs & TL_JOINT_TURN)) {
        return;
    }
    q8 t = q8_mul(q8_conjugate(fa), fb);
    tl_m8 flip = tl_f8_lt(t.w, tl_f8_zero());
    c->turn = q8_of(tl_f8_select(flip, tl_f8_neg(t.x), t.x), tl_f8_select(flip, tl_f8_neg(t.y), t.y),
                    tl_f8_select(flip, tl_f8_neg(t.z), t.z), tl_f8_select(flip, tl_f8_neg(t.w), t.w));
}

static void load_joint_bodies(const tl_step *step, const tl_joint_group *g, joint_bodies *c) {
    tl_f8 r[8];
    const float *poses = tl_row_pose(step->h)->f, *velocities = tl_row_velocity(step->h)->f;
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f), h = tl_f8_set1(step->sub);
    v8 bend_a = v8_zero(), bend_b = v8_zero();
    c->sides = g->needs;
    c->xa = c->xb = v8_zero();
    c->qa = c->qb = q8_of(zero, zero, zero, one);
    c->pa = v8_load(g->pa[0]), c->pb = v8_load(g->pb[0]);
    c->ma = c->ta = c->mb = c->tb = zero;
    c->ka = k8_load(g->k[0]);
    c->kb = k8_load(g->k[1]);
    if (c->sides & TL_JOINT_A) {
        tl_f8_load_rows(poses, g->a, r);
        c->qa = q8_of(r[3], r[4], r[5], r[6]);
        c->xa = v8_of(r[0], r[1], r[2]);
        v8 arm = q8_rotate(c->qa, c->pa);
        c->pa = v8_add(c->xa, arm);
        tl_f8_load_rows(velocities, g->a, r);
        bend_a = bend(k8_mul_t(&c->ka, v8_of(r[3], r[4], r[5])), arm, h);
        c->ma = r[6], c->ta = r[7];
    }
    if (c->sides & TL_JOINT_B) {
        tl_f8_load_rows(poses, g->b, r);
        c->qb = q8_of(r[3], r[4], r[5], r[6]);
        c->xb = v8_of(r[0], r[1], r[2]);
        v8 arm = q8_rotate(c->qb, c->pb);
        c->pb = v8_add(c->xb, arm);
        tl_f8_load_rows(velocities, g->b, r);
        bend_b = bend(k8_mul_t(&c->kb, v8_of(r[3], r[4], r[5])), arm, h);
        c->mb = r[6], c->tb = r[7];
    }
    c->curve = v8_scale(v8_sub(bend_b, bend_a), tl_f8_mul(tl_f8_set1(0.5f), h));
}

static inline int is_linear_row(uint32_t code) {
    uint32_t type = code % TL_ROW_TYPES;
    return type < TL_ROW_ANGULAR || type == TL_ROW_DISTANCE;
}

static inline tl_f8 turn_part(q8 q, uint32_t axis) { return axis == 0 ? q.x : axis == 1 ? q.y : q.z; }

/* The direction and the error of an angular row. */
static void angular_row(const joint_bodies *c, uint32_t type, uint32_t free_axis, v8 *axis, tl_f8 *error) {
    tl_f8 two = tl_f8_set1(2.0f);
    if (type < TL_ROW_SWING) { /* twist: its rate is w . (a + b) / (1 + a . b) */
        uint32_t k = type - TL_ROW_ANGULAR;
        tl_f8 scale = tl_f8_max(tl_f8_add(tl_f8_set1(1.0f), v8_dot(c->a[k], c->b[k])), tl_f8_set1(0.05f));
        *axis = v8_scale(v8_add(c->a[k], c->b[k]), tl_f8_div(tl_f8_set1(1.0f), scale));
        *error = tl_f8_mul(two, tl_f8_atan2(turn_part(c->turn, k), c->turn.w));
    } else if (type < TL_ROW_CONE) {
        uint32_t k = type - TL_ROW_SWING;
        *axis = c->a[k];
        *error = v8_dot(v8_cross(c->a[free_axis], c->b[free_axis]), c->a[k]);
    } else {
        uint32_t k = type - TL_ROW_CONE;
        tl_f8 p = turn_part(c->turn, (k + 1u) % 3u), q = turn_part(c->turn, (k + 2u) % 3u), t = turn_part(c->turn, k);
        tl_f8 across = tl_f8_sqrt(tl_f8_mad(tl_f8_mul(p, p), q, q));
        tl_f8 along = tl_f8_sqrt(tl_f8_mad(tl_f8_mul(t, t), c->turn.w, c->turn.w));
        v8 e = v8_cross(c->a[k], c->b[k]);
        tl_f8 l = tl_f8_sqrt(v8_dot(e, e));
        tl_m8 ok = tl_f8_gt(l, tl_f8_set1(1e-6f));
        *axis = v8_select(ok, v8_scale(e, inverse_or_zero(l)), c->a[(k + 1u) % 3u]);
        *error = tl_f8_mul(two, tl_f8_atan2(across, along));
    }
}

/* K (r x e) of a world axis e. */
TL_INLINE v8 k8_arm(const k8 *k, v8 r, uint32_t axis) {
    const v8 *row[3] = {&k->x, &k->y, &k->z};
    tl_f8 j[3];
    for (uint32_t m = 0; m < 3u; m++) {
        tl_f8 x = row[m]->x, y = row[m]->y, z = row[m]->z;
        j[m] = axis == 0   ? tl_f8_sub(tl_f8_mul(y, r.z), tl_f8_mul(z, r.y))
               : axis == 1 ? tl_f8_sub(tl_f8_mul(z, r.x), tl_f8_mul(x, r.z))
                           : tl_f8_sub(tl_f8_mul(x, r.y), tl_f8_mul(y, r.x));
    }
    return v8_of(j[0], j[1], j[2]);
}

/* The three rows of a point that is held. */
TL_INLINE void make_point_rows(const joint_bodies *c, tl_joint_row *rows) {
    v8 d = v8_sub(c->pb, c->pa), ra = v8_sub(c->pb, c->xa), rb = v8_sub(c->pb, c->xb);
    const tl_f8 errors[3] = {d.x, d.y, d.z}, curves[3] = {c->curve.x, c->curve.y, c->curve.z};
    for (uint32_t k = 0; k < 3u; k++) {
        for (uint32_t m = 0; m < 3u; m++) {
            tl_f8_store(rows[k].n[m], tl_f8_set1(k == m ? 1.0f : 0.0f));
        }
        if (c->sides & TL_JOINT_A) {
            v8_store(rows[k].ja[0], k8_arm(&c->ka, ra, k));
        }
        if (c->sides & TL_JOINT_B) {
            v8_store(rows[k].jb[0], k8_arm(&c->kb, rb, k));
        }
        tl_f8_store(rows[k].error, errors[k]);
        tl_f8_store(rows[k].curve, curves[k]);
    }
}

static void make_joint_row(const joint_bodies *c, tl_joint_row *row, uint32_t code, uint32_t free_axis) {
    uint32_t type = code % TL_ROW_TYPES;
    v8 d = v8_sub(c->pb, c->pa), n, ja = v8_zero(), jb = v8_zero();
    tl_f8 error, mass = tl_f8_zero(), curve = tl_f8_zero();
    if (is_linear_row(code)) {
        if (type == TL_ROW_DISTANCE) {
            error = tl_f8_sqrt(v8_dot(d, d));
            tl_m8 ok = tl_f8_gt(error, tl_f8_set1(1e-9f));
            n = v8_select(ok, v8_scale(d, inverse_or_zero(error)), c->a[0]);
        } else {
            n = c->a[type - TL_ROW_LINEAR];
            error = v8_dot(n, d);
        }
        ja = c->sides & TL_JOINT_A ? k8_mul(&c->ka, v8_cross(v8_sub(c->pb, c->xa), n)) : ja;
        jb = c->sides & TL_JOINT_B ? k8_mul(&c->kb, v8_cross(v8_sub(c->pb, c->xb), n)) : jb;
        mass = tl_f8_add(c->ma, c->mb);
        curve = v8_dot(n, c->curve);
    } else {
        angular_row(c, type, free_axis, &n, &error);
        ja = c->sides & TL_JOINT_A ? k8_mul(&c->ka, n) : ja;
        jb = c->sides & TL_JOINT_B ? k8_mul(&c->kb, n) : jb;
    }
    v8_store(row->n[0], n);
    v8_store(row->ja[0], ja);
    v8_store(row->jb[0], jb);
    tl_f8_store(row->error, error);
    tl_f8_store(row->curve, curve);
    if (code / TL_ROW_TYPES != TL_ROW_EQUAL) {
        mass = tl_f8_add(mass, tl_f8_add(tl_f8_mul(c->ta, v8_dot(ja, ja)), tl_f8_mul(c->tb, v8_dot(jb, jb))));
        tl_f8_store(row->mass, inverse_or_zero(mass));
        tl_f8 below = tl_f8_sub(error, tl_f8_load(row->lower)), above = tl_f8_sub(tl_f8_load(row->upper), error);
        tl_f8_store(row->at_lower, tl_f8_and_mask(tl_f8_le(below, above), tl_f8_set1(1.0f)));
    }
}

/* A pivot below this share of its diagonal entry stands for rows that say the same thing twice. */
#define LEAST_PIVOT 1e-6f

/* What the equalities of a group are along. The usual forms, with the usual numbers of rows, are compiled on their own:
 * a point, held along the axes of the world or of frame a, and then angles. */
enum { FORM_ANY, FORM_WORLD, FORM_FRAME };
#define FORM_OF(rows, form) ((rows)*4u + (form))

static inline uint32_t form_of(const tl_joint_group *g, uint32_t rows) {
    uint32_t form = g->needs & TL_JOINT_POINT ? FORM_WORLD : FORM_FRAME;
    return g->needs & TL_JOINT_PLAIN && rows == g->fixed ? FORM_OF(rows, form) : FORM_ANY;
}

/* What a row is along: nothing but an angle, a direction, or an axis of the world, which is ROW_AXIS and its number. */
enum { ROW_ANGULAR = 0, ROW_LINEAR = 1, ROW_AXIS = 2 };

static inline int row_kind(const tl_joint_group *g, uint32_t k) {
    if (k < 3u && (g->needs & TL_JOINT_POINT)) {
        return ROW_AXIS + (int)k;
    }
    return is_linear_row(g->code[k]) ? ROW_LINEAR : ROW_ANGULAR;
}

/* Calls f(..., form, rows) for linked joints, whose points are held along the axes of the world. */
#define IN_LINKED_FORM(g, rows, f, ...)                                                                                \
    do {                                                                                                               \
        switch (form_of(g, rows)) {                                                                                    \
        case FORM_OF(3u, FORM_WORLD):                                                                                  \
            f(__VA_ARGS__, FORM_WORLD, 3u);                                                                            \
            break;                                                                                                     \
        case FORM_OF(5u, FORM_WORLD):                                                                                  \
            f(__VA_ARGS__, FORM_WORLD, 5u);                                                                            \
            break;                                                                                                     \
        default:                                                                                                       \
            f(__VA_ARGS__, FORM_ANY, rows);                                                                            \
        }                                                                                                              \
    } while (0)

/* The same for all joints. */
#define IN_FORM(g, f, ...)                                                                                             \
    do {                                                                                                               \
        switch (form_of(g, (g)->fixed)) {                                                                              \
        case FORM_OF(3u, FORM_FRAME):                                                                                  \
            f(__VA_ARGS__, FORM_FRAME, 3u);                                                                            \
            break;                                                                                                     \
        case FORM_OF(5u, FORM_FRAME):                                                                                  \
            f(__VA_ARGS__, FORM_FRAME, 5u);                                                                            \
            break;                                                                                                     \
        default:                                                                                                       \
            IN_LINKED_FORM(g, (g)->fixed, f, __VA_ARGS__);                                                             \
        }                                                                                                              \
    } while (0)

TL_INLINE int kind_in(uint32_t form, const tl_joint_group *g, uint32_t k) {
    if (form == FORM_ANY) {
        return row_kind(g, k);
    }
    return k >= 3u ? ROW_ANGULAR : form == FORM_WORLD ? ROW_AXIS + (int)k : ROW_LINEAR;
}

/* The first i + 1 entries of row i of a joint's matrix. */
TL_INLINE void matrix_row(const joint_bodies *c, const tl_joint_group *g, const tl_joint_row *rows, uint32_t form,
                          uint32_t i, tl_f8 *out) {
    tl_f8 linear = tl_f8_add(c->ma, c->mb);
    int kind = kind_in(form, g, i);
    TL_UNROLL
    for (uint32_t j = 0; j <= i; j++) {
        out[j] = tl_f8_zero();
    }
    if (c->sides & TL_JOINT_A) {
        v8 ja = v8_scale(v8_load(rows[i].ja[0]), c->ta);
        TL_UNROLL
        for (uint32_t j = 0; j <= i; j++) {
            out[j] = v8_dot(ja, v8_load(rows[j].ja[0]));
        }
    }
    if (c->sides & TL_JOINT_B) {
        v8 jb = v8_scale(v8_load(rows[i].jb[0]), c->tb);
        TL_UNROLL
        for (uint32_t j = 0; j <= i; j++) {
            out[j] = tl_f8_add(out[j], v8_dot(jb, v8_load(rows[j].jb[0])));
        }
    }
    TL_UNROLL
    for (uint32_t j = 0; j <= i; j++) {
        if (kind >= ROW_AXIS) {
            out[j] = i == j ? tl_f8_add(out[j], linear) : out[j];
        } else if (kind == ROW_LINEAR && kind_in(form, g, j) != ROW_ANGULAR) {
            out[j] = tl_f8_mad(out[j], linear, v8_dot(v8_load(rows[i].n[0]), v8_load(rows[j].n[0])));
        }
    }
}

TL_INLINE void fill_matrix_of(const joint_bodies *c, tl_joint_group *g, const tl_joint_row *rows, uint32_t form,
                              uint32_t n) {
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        tl_f8 row[6];
        matrix_row(c, g, rows, form, i, row);
        TL_UNROLL
        for (uint32_t j = 0; j <= i; j++) {
            tl_f8_store(g->matrix[i * (i + 1u) / 2u + j], row[j]);
        }
    }
}

static void fill_matrix(const joint_bodies *c, tl_joint_group *g, const tl_joint_row *rows) {
    IN_LINKED_FORM(g, g->linked, fill_matrix_of, c, g, rows);
}

/* L D L^T of the equalities' matrix, row by row; the diagonal holds 1 / D (Golub and Van Loan, 4.1.2). */
TL_INLINE void factor_equalities_of(const joint_bodies *c, tl_joint_group *g, const tl_joint_row *rows, uint32_t form,
                                    uint32_t n) {
    tl_f8 l[21], d[6];
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        tl_f8 row[6]; /* of the matrix, then of L D */
        matrix_row(c, g, rows, form, i, row);
        TL_UNROLL
        for (uint32_t j = 0; j < i; j++) {
            TL_UNROLL
            for (uint32_t m = 0; m < j; m++) {
                row[j] = tl_f8_sub(row[j], tl_f8_mul(row[m], l[j * (j + 1u) / 2u + m]));
            }
        }
        tl_f8 k = row[i];
        TL_UNROLL
        for (uint32_t j = 0; j < i; j++) {
            l[i * (i + 1u) / 2u + j] = tl_f8_mul(row[j], d[j]);
            k = tl_f8_sub(k, tl_f8_mul(row[j], l[i * (i + 1u) / 2u + j]));
        }
        tl_m8 ok = tl_f8_gt(k, tl_f8_mul(row[i], tl_f8_set1(LEAST_PIVOT)));
        l[i * (i + 1u) / 2u + i] = d[i] = tl_f8_and_mask(ok, inverse_or_zero(k));
    }
    TL_UNROLL
    for (uint32_t i = 0; i < n * (n + 1u) / 2u; i++) {
        tl_f8_store(g->matrix[i], l[i]);
    }
}

static void factor_equalities(const joint_bodies *c, tl_joint_group *g, const tl_joint_row *rows) {
    IN_FORM(g, factor_equalities_of, c, g, rows);
}

static void make_joint_rows(const tl_step *step, tl_joint_group *g) {
    tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
    joint_bodies c;
    load_joint_bodies(step, g, &c);
    if (g->needs & TL_JOINT_POINT) {
        make_point_rows(&c, rows);
    }
    if (g->needs & TL_JOINT_AXES) {
        load_joint_frames(g, &c);
        for (uint32_t k = g->needs & TL_JOINT_POINT ? 3u : 0u; k < g->rows; k++) {
            make_joint_row(&c, &rows[k], g->code[k], g->free_axis);
        }
    }
    tl_f8_store(g->turns[0], c.ta);
    tl_f8_store(g->turns[1], c.tb);
    if (g->linked) {
        fill_matrix(&c, g, rows);
        g->stale = 0xffu;
    } else {
        factor_equalities(&c, g, rows);
    }
}

static inline tl_f8 finite_or_zero(tl_f8 x) { return tl_f8_and_mask(tl_f8_eq(tl_f8_sub(x, x), tl_f8_zero()), x); }
static inline v8 v8_finite_or_zero(v8 a) {
    return v8_of(finite_or_zero(a.x), finite_or_zero(a.y), finite_or_zero(a.z));
}

/* The impulses of rows that hold a point, from the world's axes to frame a's. */
static inline void impulses_to_frame(const tl_step *step, const tl_joint_group *g, tl_f8 impulse[3]) {
    v8 along = v8_of(impulse[0], impulse[1], impulse[2]);
    v8 back = v8_finite_or_zero(q8_rotate_back(frame_of(step, g), along));
    impulse[0] = back.x, impulse[1] = back.y, impulse[2] = back.z;
}

/* Impulses back to the joints, with the mean force and torque on b. */
static void store_joints(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        tl_f8 impulse[TL_JOINT_ROWS];
        v8 force = v8_zero(), torque = v8_zero();
        for (uint32_t r = 0; r < g->rows; r++) {
            tl_f8 now = tl_f8_load(rows[r].impulse);
            v8 *sum = is_linear_row(g->code[r]) ? &force : &torque;
            *sum = v8_mad(*sum, tl_f8_mul(now, tl_f8_set1(step->inverse_sub)), v8_load(rows[r].n[0]));
            impulse[r] = finite_or_zero(now);
        }
        if (g->needs & TL_JOINT_POINT) {
            impulses_to_frame(step, g, impulse);
        }
        float out[TL_JOINT_ROWS][TL_LANES], pull[6][TL_LANES];
        const tl_f8 pulls[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
        for (uint32_t r = 0; r < g->rows; r++) {
            tl_f8_storeu(out[r], impulse[r]);
        }
        for (uint32_t k = 0; k < 6u; k++) {
            tl_f8_storeu(pull[k], finite_or_zero(pulls[k]));
        }
        for (uint32_t lane = 0; lane < g->lanes; lane++) {
            tl_joint_state *s = &tl_joint_states(step->h)[g->joint[lane]];
            for (uint32_t r = 0; r < g->rows; r++) {
                s->impulse[r] = out[r][lane];
            }
            for (uint32_t k = 0; k < 3u; k++) {
                s->force[k] = pull[k][lane], s->torque[k] = pull[3u + k][lane];
            }
        }
    }
}
