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

/* The largest turn of a sub-step (rad), where the series of the exponential map below still hold. */
#define MOST_TURN 3.0f
/* Speeds beyond are cut (m/s): nothing sensible moves so fast, and squares of it are still finite. */
#define MOST_SPEED 1e8f

/* exp of half of the rotation vector r: (r sin(t/2) / t, cos(t/2)) with t = |r| <= MOST_TURN, by Taylor series in
 * x = (t/2)^2: below 1e-7 to x = 2.25. */
static inline q8 exp_half(v8 r) {
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
    c = tl_f8_mad(tl_f8_set1(-0.5f), x, c);
    c = tl_f8_mad(tl_f8_set1(1.0f), x, c);
    v8 v = v8_scale(r, tl_f8_mul(tl_f8_set1(0.5f), s));
    return q8_of(v.x, v.y, v.z, c);
}

static inline tl_f8 cut(tl_f8 x) { return tl_f8_max(tl_f8_min(x, tl_f8_set1(MOST_SPEED)), tl_f8_set1(-MOST_SPEED)); }

/* The rotation vector h w, no longer than MOST_TURN. */
static inline v8 turn_of(v8 w, tl_f8 h) {
    v8 r = v8_scale(v8_of(cut(w.x), cut(w.y), cut(w.z)), h);
    tl_f8 t = tl_f8_sqrt(v8_dot(r, r)), most = tl_f8_set1(MOST_TURN);
    tl_f8 scale = tl_f8_select(tl_f8_gt(t, most), tl_f8_div(most, t), tl_f8_set1(1.0f));
    return v8_scale(r, scale);
}

static void load_eight(const tl_row8 *rows, tl_f8 out[8]) {
    for (int k = 0; k < 8; k++) {
        out[k] = tl_f8_load(rows[k].f);
    }
    tl_f8_transpose(out);
}

static void store_eight(tl_row8 *rows, tl_f8 in[8]) {
    tl_f8_transpose(in);
    for (int k = 0; k < 8; k++) {
        tl_f8_store(rows[k].f, in[k]);
    }
}

static void velocity(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *velocities = tl_row_velocity(step->h), *befores = tl_row_before(step->h);
    const tl_row8 *forces = tl_row_force(step->h);
    tl_f8 h = tl_f8_set1(step->sub);
    for (uint32_t i = first; i < last; i += TL_LANES) {
        tl_f8 v[8], b[8], f[8];
        load_eight(velocities + i, v);
        load_eight(befores + i, b);
        load_eight(forces + i, f);
        for (int k = 0; k < 6; k++) {
            tl_f8 warm = step->first_substep ? b[k] : tl_f8_sub(v[k], b[k]);
            b[k] = tl_f8_mul(tl_f8_mad(v[k], h, f[k]), f[k < 3 ? 6 : 7]);
            b[k] = cut(b[k]);
            v[k] = tl_f8_add(b[k], warm);
        }
        store_eight(befores + i, b);
        store_eight(velocities + i, v);
    }
}

/* Turns the principal axes q by Euler's equations for a sub-step, with the angular momentum l in the world. */
static inline void euler_turn(q8 *q, v8 l, v8 s2, tl_f8 h) {
    v8 own = q8_rotate_back(*q, l), mean = v8_mul(s2, own);
    for (int i = 0; i < 3; i++) {
        q8 half = exp_half(turn_of(mean, tl_f8_mul(tl_f8_set1(0.5f), h)));
        mean = v8_mul(s2, q8_rotate_back(half, own));
    }
    *q = q8_normalize(q8_mul(*q, exp_half(turn_of(mean, h))));
}

/* The gyroscopic lanes of a group: takes what the impulses changed into the momentum, turns q and finds the new u. */
static void gyroscope(const tl_step *step, uint32_t row, tl_m8 gyro, q8 frame, v8 s, q8 *q, q8 turned, tl_f8 v[8]) {
    tl_row8 *momenta = tl_row_momentum(step->h) + row, *befores = tl_row_before(step->h) + row;
    tl_f8 m[8], b[8], one = tl_f8_set1(1.0f);
    load_eight(momenta, m);
    load_eight(befores, b);
    v8 safe = v8_select(gyro, s, v8_of(one, one, one)), s2 = v8_mul(safe, safe);
    v8 u = v8_of(v[3], v[4], v[5]), gain = v8_sub(u, v8_of(m[3], m[4], m[5]));
    gain = v8_of(tl_f8_div(gain.x, safe.x), tl_f8_div(gain.y, safe.y), tl_f8_div(gain.z, safe.z));
    v8 l = v8_add(v8_of(m[0], m[1], m[2]), q8_rotate(frame, gain));
    q8 free_turn = *q;
    euler_turn(&free_turn, l, s2, tl_f8_set1(step->sub));
    v8 w = q8_rotate(free_turn, v8_mul(s2, q8_rotate_back(free_turn, l))), back = q8_rotate_back(frame, w);
    v8 next = v8_of(tl_f8_div(back.x, safe.x), tl_f8_div(back.y, safe.y), tl_f8_div(back.z, safe.z));
    next = v8_select(gyro, next, u);
    v8 before = v8_add(v8_of(b[3], b[4], b[5]), v8_sub(next, u));
    b[3] = before.x, b[4] = before.y, b[5] = before.z;
    v[3] = next.x, v[4] = next.y, v[5] = next.z;
    m[0] = l.x, m[1] = l.y, m[2] = l.z, m[3] = next.x, m[4] = next.y, m[5] = next.z;
    store_eight(befores, b);
    store_eight(momenta, m);
    q->x = tl_f8_select(gyro, free_turn.x, turned.x), q->y = tl_f8_select(gyro, free_turn.y, turned.y);
    q->z = tl_f8_select(gyro, free_turn.z, turned.z), q->w = tl_f8_select(gyro, free_turn.w, turned.w);
}

static void position(const tl_step *step, uint32_t first, uint32_t last) {
    tl_row8 *velocities = tl_row_velocity(step->h), *moves = tl_row_moved(step->h), *poses = tl_row_pose(step->h);
    const tl_row8 *frames = tl_row_frame(step->h);
    tl_f8 h = tl_f8_set1(step->sub), zero = tl_f8_zero();
    for (uint32_t i = first; i < last; i += TL_LANES) {
        tl_f8 v[8], m[8], p[8], f[8];
        load_eight(velocities + i, v);
        load_eight(moves + i, m);
        load_eight(poses + i, p);
        load_eight(frames + i, f);
        for (int k = 0; k < 6; k++) {
            v[k] = cut(v[k]);
            m[k] = tl_f8_mad(m[k], h, v[k]);
        }
        for (int k = 0; k < 3; k++) {
            p[k] = tl_f8_mad(p[k], h, v[k]);
        }
        q8 q = q8_of(p[3], p[4], p[5], p[6]), frame = q8_of(f[0], f[1], f[2], f[3]);
        v8 s = v8_of(f[4], f[5], f[6]), u = v8_of(v[3], v[4], v[5]);
        v8 w = q8_rotate(frame, v8_mul(s, u));
        q8 turned = q8_normalize(q8_mul(exp_half(turn_of(w, h)), q));
        tl_m8 gyro = tl_f8_gt(f[7], zero);
        if (tl_m8_any(gyro)) {
            gyroscope(step, i, gyro, frame, s, &q, turned, v);
            turned = q;
        }
        p[3] = turned.x, p[4] = turned.y, p[5] = turned.z, p[6] = turned.w;
        store_eight(velocities + i, v);
        store_eight(moves + i, m);
        store_eight(poses + i, p);
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
        q8 turn = exp_half(turn_of(w, tl_f8_set1(1.0f))), turned = q8_normalize(q8_mul(turn, q));
        /* A slender body's spin about its own axis turns with it: a little of the momentum across would be a lot there.
         */
        v8 momentum = v8_of(l[0], l[1], l[2]);
        tl_m8 follows = tl_m8_and(pushed, tl_f8_gt(l[6], tl_f8_zero()));
        momentum = v8_select(follows, q8_rotate(turn, momentum), momentum);
        l[0] = momentum.x, l[1] = momentum.y, l[2] = momentum.z;
        store_eight(momenta + i, l);
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
