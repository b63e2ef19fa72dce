/* The motion of bodies within a sub-step, eight rows at a time.
 *
 * velocity: forces and damping, then the impulses of the last sub-step once more. As the rows' Jacobians stay the same
 * over a step, what these impulses did to a body's velocity is known without them: it is the change since its forces
 * were applied. So warm starting takes no pass over the constraints.
 *
 * position: the centre by the velocity, the rotation by the exponential map. Where the principal inertias differ, the
 * rotation is the implicit midpoint step of Euler's equations: with the angular momentum L fixed in the world, the mean
 * angular velocity is I^-1 L at the midpoint of the turn that it itself makes (solved by fixed-point iteration). The
 * momentum is kept by construction and the energy does not drift, for the step is symmetric in time (Hairer, Lubich and
 * Wanner, Geometric Numerical Integration, VII.5). */

/* The largest turn of a sub-step (rad), where the series of the exponential map below still hold, and what is small. */
#define MOST_TURN 3.0f
#define SMALL_TURN 0.5f
/* Speeds beyond are cut (m/s): nothing sensible moves so fast, and squares of it are still finite. */
#define MOST_SPEED 1e8f

static inline tl_f8 cut(tl_f8 x) { return tl_f8_max(tl_f8_min(x, tl_f8_set1(MOST_SPEED)), tl_f8_set1(-MOST_SPEED)); }

/* exp of half of the rotation vector h w, cut to MOST_TURN, less one: (r sin(t/2) / t, cos(t/2) - 1) with t = |r|, by
 * Taylor series in x = (t/2)^2: below 1e-7 to x = 2.25. */
static q8 turn_far(v8 w, tl_f8 h) {
    v8 r = v8_scale(v8_of(cut(w.x), cut(w.y), cut(w.z)), h);
    tl_f8 t = tl_f8_sqrt(v8_dot(r, r)), most = tl_f8_set1(MOST_TURN);
    r = v8_scale(r, tl_f8_select(tl_f8_gt(t, most), tl_f8_div(most, t), tl_f8_set1(1.0f)));
    tl_f8 x = tl_f8_mul(tl_f8_set1(0.25f), v8_dot(r, r));
    tl_f8 s = tl_f8_set1(-1.0f / 39916800.0f), c = tl_f8_set1(1.0f / 479001600.0f);
    s = tl_f8_mad(tl_f8_set1(1.0f / 362880.0f), x, s);
    s = tl_f8_mad(tl_f8_set1(-1.0f / 5040.0f), x, s);
    s = tl_f8_mad(tl_f8_set1(1.0f / 120.0f), x, s);
    s = tl_f8_mad(tl_f8_set1(-1.0f / 6.0f), x, s);
    s = tl_f8_mad(tl_f8_set1(1.0f), x, s);
    c = tl_f8_mad(tl_f8_set1(-1.0f / 3628800.0f), x, c);
    c = tl_f8_mad(tl_f8_set1(1.0f / 40320.0f), x, c);
    c = tl_f8_mad(tl_f8_set1(-1.0f / 720.0f), x, c);
    c = tl_f8_mad(tl_f8_set1(1.0f / 24.0f), x, c);
    c = tl_f8_mul(x, tl_f8_mad(tl_f8_set1(-0.5f), x, c));
    v8 v = v8_scale(r, tl_f8_mul(tl_f8_set1(0.5f), s));
    return q8_of(v.x, v.y, v.z, c);
}

/* The turn by h w, less one, for what is near one has no digits left for it. Most are small, and the series' first
 * terms are then as good, to 1e-9. */
static inline q8 turn_by(v8 w, tl_f8 h) {
    v8 half = v8_scale(w, tl_f8_mul(tl_f8_set1(0.5f), h));
    tl_f8 x = v8_dot(half, half), xx = tl_f8_mul(x, x), one = tl_f8_set1(1.0f);
    tl_m8 small = tl_f8_le(x, tl_f8_set1(0.25f * SMALL_TURN * SMALL_TURN));
    tl_f8 s = tl_f8_mad(tl_f8_mad(one, x, tl_f8_set1(-1.0f / 6.0f)), xx,
                        tl_f8_mad(tl_f8_set1(1.0f / 120.0f), x, tl_f8_set1(-1.0f / 5040.0f)));
    tl_f8 c = tl_f8_mad(tl_f8_mul(tl_f8_set1(-0.5f), x), xx,
                        tl_f8_mad(tl_f8_set1(1.0f / 24.0f), x, tl_f8_set1(-1.0f / 720.0f)));
    q8 q = q8_of(tl_f8_mul(half.x, s), tl_f8_mul(half.y, s), tl_f8_mul(half.z, s), c);
    return tl_m8_all(small) ? q : q8_select(small, q, turn_far(w, h));
}

/* A turn that turn_by gave, to rotate with. */
static inline q8 whole(q8 turn) { return q8_of(turn.x, turn.y, turn.z, tl_f8_add(turn.w, tl_f8_set1(1.0f))); }

/* The unit quaternion q + d, d being small: rounded once, and kept a unit by one step of Newton's to 1 / |q|. */
static inline q8 turned_by(q8 q, q8 d) {
    q8 sum = q8_of(tl_f8_add(q.x, d.x), tl_f8_add(q.y, d.y), tl_f8_add(q.z, d.z), tl_f8_add(q.w, d.w));
    tl_f8 n =
        tl_f8_add(tl_f8_mad(tl_f8_mul(sum.x, sum.x), sum.y, sum.y), tl_f8_mad(tl_f8_mul(sum.z, sum.z), sum.w, sum.w));
    tl_f8 f = tl_f8_mul(tl_f8_set1(0.5f), tl_f8_sub(tl_f8_set1(1.0f), n));
    return q8_of(tl_f8_add(q.x, tl_f8_mad(d.x, f, sum.x)), tl_f8_add(q.y, tl_f8_mad(d.y, f, sum.y)),
                 tl_f8_add(q.z, tl_f8_mad(d.z, f, sum.z)), tl_f8_add(q.w, tl_f8_mad(d.w, f, sum.w)));
}

/* By halves of rows, which is how the constraints' passes store them: what was just stored is at hand sooner. */
TL_INLINE void load_eight(const tl_row8 *rows, tl_f8 out[8]) {
    const uint32_t each[TL_LANES] = {0, 1, 2, 3, 4, 5, 6, 7};
    tl_f8_load_rows(rows->f, each, out);
}

TL_INLINE void store_eight(tl_row8 *rows, tl_f8 in[8]) {
    tl_f8_transpose(in);
    for (int k = 0; k < 8; k++) {
        tl_f8_store(rows[k].f, in[k]);
    }
}

/* What moves eight rows. */
typedef struct rows8 {
    tl_f8 velocity[8], before[8], force[8], moved[8], pose[8], frame[8], momentum[8];
} rows8;

/* Forces, damping, and the impulses of the last sub-step. */
TL_INLINE void speed_up_of(tl_f8 h, int first_substep, tl_f8 force, tl_f8 damping, tl_f8 *velocity, tl_f8 *before) {
    tl_f8 warm = first_substep ? *before : tl_f8_sub(*velocity, *before);
    *before = cut(tl_f8_mul(tl_f8_mad(*velocity, h, force), damping));
    *velocity = tl_f8_add(*before, warm);
}

TL_INLINE void speed_up(const tl_step *step, rows8 *r, int first_substep) {
    for (int k = 0; k < 6; k++) {
        tl_f8 damping = r->force[k < 3 ? 6 : 7];
        speed_up_of(tl_f8_set1(step->sub), first_substep, r->force[k], damping, &r->velocity[k], &r->before[k]);
    }
}

/* As speed_up, but row by row: what is done to each number of a row is the same. */
static void velocity(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *velocities = tl_row_velocity(step->h), *befores = tl_row_before(step->h);
    const tl_row8 *forces = tl_row_force(step->h);
    const tl_f8 h = tl_f8_set1(step->sub);
    const tl_m8 linear = tl_m8_from_bits(0x07u), speeds = tl_m8_from_bits(0x3fu);
    const uint32_t used = step->h->awake_bodies + 1u;
    for (uint32_t i = first; i < last && i < used; i++) {
        const tl_f8 v = tl_f8_load(velocities[i].f), b = tl_f8_load(befores[i].f), f = tl_f8_load(forces[i].f);
        tl_f8 damping = tl_f8_select(linear, tl_f8_set1(forces[i].f[6]), tl_f8_set1(forces[i].f[7]));
        tl_f8 now = v, before = b;
        speed_up_of(h, step->first_substep, f, damping, &now, &before);
        tl_f8_store(befores[i].f, tl_f8_select(speeds, before, b));
        tl_f8_store(velocities[i].f, tl_f8_select(speeds, now, v));
    }
}

/* Turns the principal axes q by Euler's equations for a sub-step, with the angular momentum l in the world. The spin
 * at the midpoint is first guessed by its rate. */
static inline q8 euler_turn(q8 q, v8 l, v8 s2, tl_f8 h) {
    tl_f8 half = tl_f8_mul(tl_f8_set1(0.5f), h);
    v8 own = q8_rotate_back(q, l), mean = v8_mul(s2, own);
    mean = v8_mul(s2, v8_mad(own, half, v8_cross(own, mean)));
    for (int i = 0; i < 2; i++) {
        mean = v8_mul(s2, q8_rotate_back(whole(turn_by(mean, half)), own));
    }
    return turned_by(q, q8_mul(q, turn_by(mean, h)));
}

/* Takes what the impulses changed into the momentum of the gyroscopic lanes, turns their q and finds the new u. */
TL_INLINE void gyroscope(const tl_step *step, rows8 *r, tl_m8 gyro, q8 frame, q8 *q, q8 turned) {
    tl_f8 *v = r->velocity, *m = r->momentum, *b = r->before, one = tl_f8_set1(1.0f);
    v8 s = v8_select(gyro, v8_of(r->frame[4], r->frame[5], r->frame[6]), v8_of(one, one, one)), s2 = v8_mul(s, s);
    v8 inverse = v8_of(tl_f8_div(one, s.x), tl_f8_div(one, s.y), tl_f8_div(one, s.z));
    v8 u = v8_of(v[3], v[4], v[5]), gain = v8_mul(v8_sub(u, v8_of(m[3], m[4], m[5])), inverse);
    v8 l = v8_add(v8_of(m[0], m[1], m[2]), q8_rotate(frame, gain));
    q8 next_q = euler_turn(*q, l, s2, tl_f8_set1(step->sub)), since = q8_mul(q8_conjugate(frame), next_q);
    v8 next = v8_mul(q8_rotate(since, v8_mul(s2, q8_rotate_back(next_q, l))), inverse);
    v8 before = v8_of(b[3], b[4], b[5]);
    before = v8_select(gyro, v8_sub(next, v8_sub(u, before)), before); /* to the bit, where nothing pushed */
    next = v8_select(gyro, next, u);
    b[3] = before.x, b[4] = before.y, b[5] = before.z;
    v[3] = next.x, v[4] = next.y, v[5] = next.z;
    m[0] = l.x, m[1] = l.y, m[2] = l.z, m[3] = next.x, m[4] = next.y, m[5] = next.z;
    *q = q8_select(gyro, next_q, turned);
}

/* The poses of the next sub-step; `gyro` are the lanes with a gyroscopic term. */
TL_INLINE void move_on(const tl_step *step, rows8 *r, tl_m8 gyro) {
    tl_f8 h = tl_f8_set1(step->sub), *v = r->velocity, *p = r->pose;
    for (int k = 0; k < 6; k++) {
        v[k] = cut(v[k]);
        r->moved[k] = tl_f8_mad(r->moved[k], h, v[k]);
    }
    for (int k = 0; k < 3; k++) {
        p[k] = tl_f8_mad(p[k], h, v[k]);
    }
    q8 q = q8_of(p[3], p[4], p[5], p[6]), frame = q8_of(r->frame[0], r->frame[1], r->frame[2], r->frame[3]);
    q8 turned = q;
    if (!tl_m8_all(gyro)) {
        v8 w = q8_rotate(frame, v8_mul(v8_of(r->frame[4], r->frame[5], r->frame[6]), v8_of(v[3], v[4], v[5])));
        turned = turned_by(q, q8_mul(turn_by(w, h), q));
    }
    if (tl_m8_any(gyro)) {
        gyroscope(step, r, gyro, frame, &q, turned);
        turned = q;
    }
    p[3] = turned.x, p[4] = turned.y, p[5] = turned.z, p[6] = turned.w;
}

static void position(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *velocities = tl_row_velocity(step->h), *moves = tl_row_moved(step->h), *poses = tl_row_pose(step->h);
    tl_row8 *befores = tl_row_before(step->h), *momenta = tl_row_momentum(step->h);
    for (uint32_t i = first; i < last; i += TL_LANES) {
        rows8 r;
        load_eight(velocities + i, r.velocity);
        load_eight(moves + i, r.moved);
        load_eight(poses + i, r.pose);
        load_eight(tl_row_frame(step->h) + i, r.frame);
        tl_m8 gyro = tl_f8_gt(r.frame[7], tl_f8_zero());
        if (tl_m8_any(gyro)) {
            load_eight(befores + i, r.before);
            load_eight(momenta + i, r.momentum);
        }
        move_on(step, &r, gyro);
        if (tl_m8_any(gyro)) {
            store_eight(befores + i, r.before);
            store_eight(momenta + i, r.momentum);
        }
        store_eight(velocities + i, r.velocity);
        store_eight(moves + i, r.moved);
        store_eight(poses + i, r.pose);
    }
}

/* fly: all sub-steps of a step in which nothing touches and nothing is tied. */
static void fly(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *velocities = tl_row_velocity(step->h), *moves = tl_row_moved(step->h), *poses = tl_row_pose(step->h);
    tl_row8 *befores = tl_row_before(step->h), *momenta = tl_row_momentum(step->h);
    for (uint32_t i = first; i < last; i += TL_LANES) {
        rows8 r;
        load_eight(velocities + i, r.velocity);
        load_eight(befores + i, r.before);
        load_eight(tl_row_force(step->h) + i, r.force);
        load_eight(moves + i, r.moved);
        load_eight(poses + i, r.pose);
        load_eight(tl_row_frame(step->h) + i, r.frame);
        load_eight(momenta + i, r.momentum);
        tl_m8 gyro = tl_f8_gt(r.frame[7], tl_f8_zero());
        for (uint32_t k = 0; k < step->substeps; k++) {
            speed_up(step, &r, k == 0);
            move_on(step, &r, gyro);
        }
        store_eight(velocities + i, r.velocity);
        store_eight(moves + i, r.moved);
        store_eight(poses + i, r.pose);
        store_eight(momenta + i, r.momentum);
    }
}

/* Whether any of eight rows is to be displaced. */
static inline int any_pushed(const tl_row8 *rows) {
    tl_f8 zero = tl_f8_zero();
    tl_m8 any = tl_m8_zero();
    for (uint32_t k = 0; k < TL_LANES; k++) {
        any = tl_m8_or(any, tl_f8_gt(tl_f8_abs(tl_f8_load(rows[k].f)), zero));
    }
    return (tl_m8_bits(any) & 0x3fu) != 0; /* the last two are no displacement */
}

/* push: takes the displacements of the push into the poses. */
static void push(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *moves = tl_row_moved(step->h), *poses = tl_row_pose(step->h), *pushes = tl_row_push(step->h);
    tl_row8 *momenta = tl_row_momentum(step->h);
    const tl_row8 *frames = tl_row_frame(step->h);
    for (uint32_t i = first; i < last; i += TL_LANES) {
        tl_f8 d[8], m[8], p[8], f[8];
        if (!any_pushed(pushes + i)) {
            continue;
        }
        load_eight(pushes + i, d);
        load_eight(moves + i, m);
        load_eight(poses + i, p);
        load_eight(frames + i, f);
        tl_f8 l[8], way = tl_f8_zero();
        load_eight(momenta + i, l);
        for (int k = 0; k < 6; k++) {
            way = tl_f8_add(way, tl_f8_abs(d[k]));
        }
        /* What is not displaced keeps its bits, whatever stands beside it. */
        tl_m8 pushed = tl_f8_gt(way, tl_f8_zero());
        for (int k = 0; k < 6; k++) {
            m[k] = tl_f8_select(pushed, tl_f8_add(m[k], d[k]), m[k]);
        }
        for (int k = 0; k < 3; k++) {
            p[k] = tl_f8_select(pushed, tl_f8_add(p[k], d[k]), p[k]);
        }
        q8 q = q8_of(p[3], p[4], p[5], p[6]), frame = q8_of(f[0], f[1], f[2], f[3]);
        v8 w = q8_rotate(frame, v8_mul(v8_of(f[4], f[5], f[6]), v8_of(d[3], d[4], d[5])));
        q8 turn = turn_by(w, tl_f8_set1(1.0f)), turned = turned_by(q, q8_mul(turn, q));
        /* A slender body's spin about its own axis turns with it: a little of the momentum across would be a lot there.
         */
        tl_m8 follows = tl_m8_and(pushed, tl_f8_gt(l[6], tl_f8_zero()));
        if (tl_m8_any(follows)) {
            v8 momentum = v8_of(l[0], l[1], l[2]);
            momentum = v8_select(follows, q8_rotate(whole(turn), momentum), momentum);
            l[0] = momentum.x, l[1] = momentum.y, l[2] = momentum.z;
            store_eight(momenta + i, l);
        }
        p[3] = tl_f8_select(pushed, turned.x, q.x), p[4] = tl_f8_select(pushed, turned.y, q.y);
        p[5] = tl_f8_select(pushed, turned.z, q.z), p[6] = tl_f8_select(pushed, turned.w, q.w);
        for (int k = 0; k < 6; k++) {
            d[k] = tl_f8_zero();
        }
        store_eight(pushes + i, d);
        store_eight(moves + i, m);
        store_eight(poses + i, p);
    }
}
