/* Pressed contacts, a press at a time: the rows that hold, of normals and of friction, are met at once by the block
 * L D L^T of their matrix. Which hold is found by active sets: a point that would have to pull is let go, one that
 * closes is taken in, and friction beyond its cone slides on it. Where that leads astray, for rows may say nearly the
 * same and quarrel, the way is gone only as far as nothing pulls, and the diagonal is raised, as Levenberg and
 * Marquardt do for least squares (Nocedal and Wright, "Numerical Optimization", 10.3, 16.5). It is raised from the
 * start by as much as what is to be met is fast: the weakest ways of a tall tower to sway, met at once, would ask for
 * more than its weight can give. What a few rounds leave is left to the sweep over all contacts that follows, and so
 * is what the system does not know (friction about the normal, rolling).
 *
 * What rests is met by the impulses that it has, and then a look at the speeds is all that there is to do. That it
 * stays so takes care: an impulse that stops a speed is applied again in the next sub-step, as all of them are, and
 * leaves the speed that there was before the other way round. Were that left to grow until it is worth a round, rounds
 * would make each other for ever; so after a round all is met that a round can meet.
 *
 * The lanes are the rows of one contact: its points, then its tangents, of which there is one in a plane. */

#define MOST_ROUNDS 8u
#define LEAST_ROUNDS 2u
#define MOST_LOOKS 256u   /* contacts in all rounds of a solve: of large presses there are fewer */
#define SOFT_SHARE 0.5f   /* of the fastest row against the load: by so much of itself the diagonal is raised, */
#define SOFT 2e-4f        /* at most; where a way leads astray by this, */
#define SOFTER 16.0f      /* how many times more where one does again, */
#define SOFTEST 0.1f      /* and at most */
#define LEAST_LOAD 1e-2f  /* m/s */
#define LEAST_SHARE 0.5f  /* of a way that is to be of use */
#define AT_REST 1e-5f     /* m/s: rows that all are slower are met, */
#define ROUNDED 1e-6f     /* or than this share of the load, */
#define LEFT_TWICE 2.0f   /* or, after a round, than so many times what it left, */
#define LEAST_REST 2e-6f  /* or than this */
#define CLOSING 1e-4f     /* m/s: from here on a point without an impulse is taken in */
#define NEAR_SLIDE 0.999f /* of the friction that a sliding contact has */
#define PRESS_DEPTH 5e-4f /* m: from here on overlap is taken back, */
#define LEFT_DEPTH 0.98f  /* to this share of it */

/* --- rows --------------------------------------------------------------------------------------- */

static inline uint32_t point_bits(const tl_pressed *p) { return (1u << p->points) - 1u; }
static inline uint32_t tangent_bits(const tl_pressed *p) { return (1u << p->rows) - (1u << p->points); }
static inline int holds(const tl_pressed *p, uint32_t row) { return (int)(p->holds >> row & 1u); }

static inline tl_contact_group *group_of(const tl_header *h, const tl_pressed *p) {
    return &tl_group_pool(h)[p->place / TL_LANES];
}
static inline float *impulse_of(const tl_header *h, const tl_pressed *p, uint32_t row) {
    tl_contact_group *g = group_of(h, p);
    uint32_t lane = p->place % TL_LANES;
    return row < p->points ? &g->point[row].impulse[lane] : &g->tangent_impulse[row - p->points][lane];
}

/* Row `row` is along n, with the Jacobians ja and jb: lanes of the group that the contact is in. */
static void fill_row(tl_pressed *p, uint32_t row, const float *n, const float *ja, const float *jb) {
    for (uint32_t k = 0; k < 3u; k++) {
        p->n[k][row] = n[k];
        p->j[0][k][row] = ja[k * TL_LANES];
        p->j[1][k][row] = jb[k * TL_LANES];
    }
}

static void fill_rows(const tl_header *h, tl_pressed *p) {
    const tl_contact_group *g = group_of(h, p);
    uint32_t lane = p->place % TL_LANES, points = p->points;
    float n[3], t[3];
    for (uint32_t k = 0; k < 3u; k++) {
        n[k] = g->normal[k][lane], t[k] = g->tangent[k][lane];
    }
    const float t2[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    for (uint32_t k = 0; k < points; k++) {
        fill_row(p, k, n, &g->point[k].ja[0][lane], &g->point[k].jb[0][lane]);
        p->gap[k] = g->point[k].gap[lane];
    }
    fill_row(p, points, t, &g->ja1[0][lane], &g->jb1[0][lane]);
    p->gap[points] = g->slid[0][lane];
    if (p->rows > points + 1u) {
        fill_row(p, points + 1u, t2, &g->ja2[0][lane], &g->jb2[0][lane]);
        p->gap[points + 1u] = g->slid[1][lane];
    }
    p->held = g->held[lane];
    p->hold = g->static_friction[lane], p->slide = g->dynamic_friction[lane];
    for (uint32_t side = 0; side < 2u; side++) {
        p->mass[side] = tl_row_velocity(h)[p->row[side]].f[6];
        p->turns[side] = tl_row_velocity(h)[p->row[side]].f[7];
    }
}

/* m/s: what a contact bore in the last sub-step, as a speed of the lighter body. */
static float load_of(const tl_header *h, const tl_pressed *p) {
    float sum = 0.0f;
    for (uint32_t row = 0; row < p->points; row++) {
        sum += *impulse_of(h, p, row);
    }
    return sum * tl_max(p->mass[0], p->mass[1]);
}

static void begin_presses(const tl_step *step, uint32_t first, uint32_t last) {
    const tl_header *h = step->h;
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(h)[i];
        float load = 0.0f;
        for (uint32_t k = 0; k < s->count; k++) {
            tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
            fill_rows(h, p);
            load = tl_max(load, load_of(h, p));
        }
        s->stale = 1u;
        s->soft = s->rings ? SOFT : 0.0f;
        s->load = tl_max(load, LEAST_LOAD);
        s->at_rest = s->rest = tl_max(AT_REST, ROUNDED * s->load);
    }
}

#include "stage/solve/press_factor.inl"

/* --- speeds and impulses ------------------------------------------------------------------------ */

/* Of b against a along the rows; `bodies` are velocities, displacements or ways. */
static inline tl_f8 speeds_of(const tl_row8 *bodies, const tl_pressed *p) {
    const float *a = bodies[p->row[0]].f, *b = bodies[p->row[1]].f;
    const float d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    tl_f8 turn_a = v8_dot(v8_load(p->j[0][0]), v8_set1(a + 3)), turn_b = v8_dot(v8_load(p->j[1][0]), v8_set1(b + 3));
    return tl_f8_add(v8_dot(v8_load(p->n[0]), v8_set1(d)), tl_f8_sub(turn_b, turn_a));
}

static inline void add_sums(float *out, float scale, v8 a, tl_f8 x) {
    out[0] += scale * tl_f8_sum(tl_f8_mul(a.x, x));
    out[1] += scale * tl_f8_sum(tl_f8_mul(a.y, x));
    out[2] += scale * tl_f8_sum(tl_f8_mul(a.z, x));
}

/* What impulses x in the rows do to one of the bodies. */
static inline void push_side(float *f, const tl_pressed *p, uint32_t side, tl_f8 x) {
    float sign = side ? 1.0f : -1.0f;
    add_sums(f, sign * p->mass[side], v8_load(p->n[0]), x);
    add_sums(f + 3, sign * p->turns[side], v8_load(p->j[side][0]), x);
}

static void add_impulses(const tl_header *h, tl_pressed *p, tl_f8 x) {
    tl_f8_store(p->impulse, tl_f8_add(tl_f8_load(p->impulse), x));
    push_side(tl_row_velocity(h)[p->row[0]].f, p, 0, x);
    push_side(tl_row_velocity(h)[p->row[1]].f, p, 1u, x);
}

/* m: how far points are apart and tangents from where they were gripped, where the bodies are now. */
static inline tl_f8 gaps_of(const tl_header *h, const tl_pressed *p) {
    return tl_f8_add(tl_f8_load(p->gap), speeds_of(tl_row_moved(h), p));
}

static inline float press_of(const tl_pressed *p) {
    tl_f8 pushes = tl_f8_max(tl_f8_load(p->impulse), tl_f8_zero());
    return tl_f8_sum(tl_f8_and_mask(tl_m8_from_bits(point_bits(p)), pushes));
}

/* m/s: what stays as it is until the speeds are met. */
static inline tl_f8 bias_of(const tl_step *step, const tl_pressed *p) {
    tl_f8 gap = gaps_of(step->h, p), ahead = tl_f8_mul(tl_f8_max(gap, tl_f8_zero()), tl_f8_set1(step->inverse_sub));
    tl_f8 back = drawn_back(step, tl_f8_set1(p->held), gap);
    return tl_f8_select(tl_m8_from_bits(point_bits(p)), ahead, back);
}

/* The speeds that the rows have to lose. */
static inline tl_f8 speeds_to_meet(const tl_header *h, const tl_pressed *p) {
    return tl_f8_add(speeds_of(tl_row_velocity(h), p), tl_f8_load(p->bias));
}

/* Of `bits`, the points that bear. */
static uint32_t bearing_of(const tl_header *h, const tl_pressed *p, uint32_t bits) {
    for (uint32_t row = 0; row < p->points; row++) {
        bits &= bits >> row & 1u && !(*impulse_of(h, p, row) > 0.0f) ? ~(1u << row) : ~0u;
    }
    return bits & point_bits(p);
}

/* Whether no row of a contact asks for anything: all are at rest, but for points that bear nothing and open. */
static inline int is_met(const tl_step *step, const tl_pressed *p, tl_f8 rest) {
    tl_f8 speed = tl_f8_add(speeds_of(tl_row_velocity(step->h), p), bias_of(step, p));
    uint32_t moves = tl_m8_bits(tl_f8_gt(tl_f8_abs(speed), rest));
    if (moves) {
        uint32_t opens = tl_m8_bits(tl_f8_gt(speed, rest)) & point_bits(p);
        moves = (moves & ~opens) | bearing_of(step->h, p, opens);
    }
    return !moves;
}

static int is_all_met(const tl_step *step, const tl_press *s) {
    const tl_pressed *p = tl_pressed_pool(step->h) + s->first;
    tl_f8 rest = tl_f8_set1(s->rest);
    uint32_t k = 0;
    while (k < s->count && is_met(step, &p[k], rest)) {
        k++;
    }
    return k == s->count;
}

/* Four points bear least where none of what they bear is idle; else that would grow by chance until some point has to
 * let go. */
static void even_out(tl_pressed *p) {
    float v[4], square = idle_of(p, v), along = 0.0f;
    for (uint32_t k = 0; k < 4u; k++) {
        along += v[k] * p->impulse[k];
    }
    float share = square > 0.0f ? along / square : 0.0f;
    for (uint32_t k = 0; k < 4u; k++) { /* no further than that none pulls */
        float most = v[k] != 0.0f ? p->impulse[k] / v[k] : share;
        share = share > 0.0f && v[k] > 0.0f ? tl_min(share, most) : share;
        share = share < 0.0f && v[k] < 0.0f ? tl_max(share, most) : share;
    }
    for (uint32_t k = 0; k < 4u; k++) {
        p->impulse[k] = tl_max(p->impulse[k] - share * v[k], 0.0f);
    }
}

/* Where it begins; `even`: nothing has been factored yet, or there are rings. */
static void begin_to_meet(const tl_step *step, tl_pressed *p, int even) {
    for (uint32_t row = 0; row < p->rows; row++) {
        p->impulse[row] = *impulse_of(step->h, p, row);
    }
    if (even && p->points == 4u) {
        even_out(p);
    }
    tl_f8_store(p->bias, bias_of(step, p));
    float x = p->impulse[p->points], y = p->impulse[p->points + 1u], most = NEAR_SLIDE * p->slide * press_of(p);
    p->fresh = !(most > 0.0f);
    p->slides = !p->fresh && !(x * x + y * y < most * most);
    p->barred = 0;
}

static void end_meeting(const tl_header *h, const tl_pressed *p) {
    for (uint32_t row = 0; row < p->rows; row++) {
        *impulse_of(h, p, row) = p->impulse[row];
    }
}

/* Notes where a round starts from, and which rows hold there: those of points that bear or close, and both tangents'
 * unless they slide; of what bore nothing before all that do not open, for under what falls on one another nothing
 * closes but the lowest. Returns whether any of them is not met. */
static inline int look_at(const tl_header *h, tl_pressed *p, float rest, uint32_t *changed) {
    tl_f8 impulse = tl_f8_load(p->impulse), speed = speeds_to_meet(h, p);
    tl_f8_store(p->from, impulse);
    tl_f8_store(p->speed, speed);
    tl_m8 bears = tl_m8_or(tl_f8_gt(impulse, tl_f8_zero()), tl_f8_lt(speed, tl_f8_set1(p->fresh ? rest : -CLOSING)));
    uint32_t met = tl_m8_bits(tl_f8_le(tl_f8_abs(speed), tl_f8_set1(rest)));
    uint32_t now = tl_m8_bits(bears) & point_bits(p) & ~p->barred;
    now |= p->slides ? 0u : tangent_bits(p);
    *changed |= now ^ p->holds;
    p->holds = now;
    p->fresh = 0;
    return (now & ~met) != 0;
}

/* Whether a round has anything to do: rows that hold are not met, and, where the last round did what it wanted, others
 * than did hold now. */
static int look(const tl_header *h, tl_press *s, int wanted) {
    uint32_t changed = 0;
    int moves = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        moves |= look_at(h, &tl_pressed_pool(h)[s->first + k], s->rest, &changed);
    }
    s->stale |= changed != 0;
    return moves && (changed || !wanted);
}

/* m/s: the fastest of the rows that hold or slide, at the last look. */
static float left_of(const tl_header *h, const tl_press *s) {
    float lanes[TL_LANES], most = 0.0f;
    tl_f8 left = tl_f8_zero();
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_m8 closed = tl_m8_from_bits(p->holds | tangent_bits(p));
        left = tl_f8_max(left, tl_f8_and_mask(closed, tl_f8_abs(tl_f8_load(p->speed))));
    }
    tl_f8_storeu(lanes, left);
    for (uint32_t i = 0; i < TL_LANES; i++) {
        most = tl_max(most, lanes[i]);
    }
    return most;
}

/* Impulses that would meet the speeds of the rows that hold. */
static void find_changes(const tl_header *h, tl_press *s) {
    if (s->stale) {
        s->soft = tl_max(s->soft, tl_min(SOFT_SHARE * left_of(h, s) / s->load, SOFT));
        factor_press(h, s);
    }
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_f8_store(p->x, tl_f8_and_mask(tl_m8_from_bits(p->holds), tl_f8_neg(tl_f8_load(p->speed))));
    }
    solve_press(h, s);
}

/* Goes a share of the way that was found. */
static void go(const tl_header *h, const tl_press *s, float share) {
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        add_impulses(h, p, tl_f8_mul(tl_f8_set1(share), tl_f8_load(p->x)));
    }
}

/* What was gone since the round began. */
static inline tl_f8 gone(const tl_pressed *p) { return tl_f8_sub(tl_f8_load(p->impulse), tl_f8_load(p->from)); }

/* Changes that to a share of it. */
static void go_back(const tl_header *h, const tl_press *s, float share) {
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        add_impulses(h, p, tl_f8_mul(tl_f8_set1(share - 1.0f), gone(p)));
    }
}

/* Friction beyond its cone slides on it. */
static int slide(const tl_header *h, tl_pressed *p) {
    float x = p->impulse[p->points], y = p->impulse[p->points + 1u], pressure = press_of(p);
    float most = p->hold * pressure, length = sqrtf(x * x + y * y);
    if (!(length > most)) {
        return 0;
    }
    tl_f8 share = tl_f8_set1(p->slide * pressure / length - 1.0f);
    add_impulses(h, p, tl_f8_and_mask(tl_m8_from_bits(tangent_bits(p)), tl_f8_mul(tl_f8_load(p->impulse), share)));
    p->slides = 1u;
    return 1;
}

/* What may not pull lets go, and what cannot stick slides. Returns whether there was any such. */
static int let_go(const tl_header *h, const tl_press *s) {
    int any = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_f8 impulse = tl_f8_load(p->impulse);
        tl_m8 pulls = tl_m8_and(tl_f8_lt(impulse, tl_f8_zero()), tl_m8_from_bits(point_bits(p)));
        if (tl_m8_any(pulls)) {
            add_impulses(h, p, tl_f8_and_mask(pulls, tl_f8_neg(impulse)));
            any = 1;
        }
        any |= slide(h, p);
    }
    return any;
}

/* What is sought is the least of D = l A l / 2 + b l over impulses l that do not pull and stay in their cones, of which
 * the rows' speeds are the gradient. That set is convex: on the way from the old impulses to the new ones all are in
 * it, and D is least where this share of the way is gone. */
static float best_share(const tl_header *h, const tl_press *s) {
    tl_f8 slopes = tl_f8_zero(), bends = slopes;
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_f8 change = gone(p), speed = tl_f8_load(p->speed);
        slopes = tl_f8_mad(slopes, change, speed);
        bends = tl_f8_mad(bends, change, tl_f8_sub(speeds_to_meet(h, p), speed));
    }
    float slope = tl_f8_sum(slopes), bend = tl_f8_sum(bends);
    return bend > 0.0f ? tl_max(tl_min(-slope / bend, 1.0f), 0.0f) : 0.0f;
}

/* How far the way that was found can be gone until some point would pull; points that would at once are barred. */
static float free_share(const tl_header *h, const tl_press *s) {
    float share = 1.0f;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        for (uint32_t row = 0; row < p->points; row++) {
            if (holds(p, row) && p->x[row] < 0.0f) {
                p->barred |= p->from[row] > 0.0f ? 0u : 1u << row;
                share = tl_min(share, p->from[row] / -p->x[row]);
            }
        }
    }
    return share;
}

/* Back from a way that led astray, and along it again as far as is free. */
static void go_carefully(const tl_header *h, tl_press *s) {
    go_back(h, s, 0.0f);
    go(h, s, free_share(h, s));
    let_go(h, s);
    s->soft = tl_max(tl_min(s->soft * SOFTER, SOFTEST), SOFT);
    s->stale = 1u;
}

static void run_round(const tl_header *h, tl_press *s, int *done) {
    find_changes(h, s);
    go(h, s, 1.0f);
    *done = !let_go(h, s);
    float share = *done ? 1.0f : best_share(h, s);
    if (share < LEAST_SHARE) {
        go_carefully(h, s);
    } else if (share < 1.0f) {
        go_back(h, s, share);
    }
}

/* Returns whether nothing is left that a sweep could do. */
static int meet(const tl_step *step, tl_press *s) {
    const tl_header *h = step->h;
    tl_pressed *p = tl_pressed_pool(h) + s->first;
    uint32_t rounds = MOST_LOOKS / s->count, round = 0;
    rounds = rounds < LEAST_ROUNDS ? LEAST_ROUNDS : rounds > MOST_ROUNDS ? MOST_ROUNDS : rounds;
    for (uint32_t k = 0; k < s->count; k++) {
        begin_to_meet(step, &p[k], s->stale || s->rings);
    }
    int done = 0, more;
    while ((more = look(h, s, done)) && round < rounds) {
        run_round(h, s, &done);
        round++;
    }
    float left = left_of(h, s);
    if (round > 0) {
        s->rest = tl_max(tl_min(LEFT_TWICE * left, s->at_rest), LEAST_REST);
        for (uint32_t k = 0; k < s->count; k++) {
            end_meeting(h, &p[k]);
        }
    }
    return !more && left <= s->at_rest;
}

static void note_met(const tl_header *h, tl_press *s, uint32_t met) {
    for (uint32_t k = 0; k < s->count && met != s->met; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        uint32_t lane = 1u << p->place % TL_LANES, *of_group = &group_of(h, p)->met;
        *of_group = met ? *of_group | lane : *of_group & ~lane;
    }
    s->met = met;
}

static void press_velocities(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(step->h)[i];
        int met = is_all_met(step, s) || meet(step, s);
        note_met(step->h, s, met && s->alike); /* what is wedged between others is not to be jammed for good */
    }
}

/* --- errors ------------------------------------------------------------------------------------- */

/* m: how far points are apart after what has been displaced by now. */
static inline tl_f8 pushed_gaps_of(const tl_header *h, const tl_pressed *p) {
    return tl_f8_add(gaps_of(h, p), speeds_of(tl_row_push(h), p));
}

/* Whether points that bear overlap by more than `most` (m). */
static int is_deep(const tl_header *h, const tl_press *s, float most) {
    tl_f8 least = tl_f8_set1(-most);
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        uint32_t deep = tl_m8_bits(tl_f8_lt(pushed_gaps_of(h, p), least)) & point_bits(p);
        if (deep && bearing_of(h, p, deep)) {
            return 1;
        }
    }
    return 0;
}

/* What bears is what holds where nothing has been factored yet. */
static void hold_what_bears(const tl_header *h, tl_press *s) {
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        p->holds = bearing_of(h, p, point_bits(p)) | tangent_bits(p);
    }
    factor_press(h, s);
}

/* Fills in how far the points that hold are to be parted until they overlap by `left` (m). */
static void read_depths(const tl_step *step, const tl_press *s, float left) {
    const tl_header *h = step->h;
    tl_f8 zero = tl_f8_zero(), most = tl_f8_set1(h->settings.push_speed * step->sub);
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_f8 depth = tl_f8_sub(tl_f8_neg(pushed_gaps_of(h, p)), tl_f8_set1(left));
        depth = tl_f8_min(tl_f8_max(depth, zero), most);
        tl_f8_store(p->x, tl_f8_and_mask(tl_m8_from_bits(p->holds & point_bits(p)), depth));
    }
}

static inline float dot3(const float *a, const float *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* m: how far a displacement takes the points of a body, at most. */
static float way_of(const tl_header *h, uint32_t row, const float d[6]) {
    const float *s = tl_row_frame(h)[row].f + 4;
    float reach = row ? tl_body_inertias(h)[tl_awake_body(h)[row - 1u]].reach : 0.0f;
    return sqrtf(dot3(d, d)) + sqrtf(dot3(d + 3, d + 3)) * tl_max(s[0], tl_max(s[1], s[2])) * reach;
}

typedef struct displacement {
    float d[6];
    uint32_t row;
} displacement;

/* The displacements of a press's bodies, by their numbers as ends. */
static uint32_t sum_displacements(const tl_header *h, const tl_press *s, displacement *of) {
    uint32_t ends = 0;
    for (uint32_t i = 0; i < 2u * s->count; i++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + i / 2u];
        uint32_t side = i % 2u, end = tl_press_nodes(h)[s->first + i / 2u].end[side];
        if (end == TL_BLOCK_FREE) {
            continue;
        }
        for (; ends <= end; ends++) {
            memset(&of[ends], 0, sizeof of[ends]);
        }
        of[end].row = p->row[side];
        push_side(of[end].d, p, side, tl_f8_load(p->x));
    }
    return ends;
}

/* Rows that say nearly the same, but not quite, ask for long ways: those are made shorter as a whole. */
static void press_errors(const tl_step *step, uint32_t first, uint32_t last) {
    const tl_header *h = step->h;
    displacement of[TL_MOST_PRESSED + 1u];
    float budget = h->settings.error_budget, left = budget > 0.0f ? tl_min(PRESS_DEPTH, 0.5f * budget) : PRESS_DEPTH;
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(h)[i];
        int unsettled = s->stale && s->soft > 0.0f; /* what holds has changed since it was factored, or quarrels */
        if (unsettled || !is_deep(h, s, left)) {
            continue;
        }
        if (s->stale) {
            hold_what_bears(h, s);
        }
        read_depths(step, s, LEFT_DEPTH * left);
        solve_press(h, s);
        uint32_t ends = sum_displacements(h, s, of);
        float most = h->settings.push_speed * step->sub, way = most;
        for (uint32_t k = 0; k < ends; k++) {
            way = tl_max(way, way_of(h, of[k].row, of[k].d));
        }
        for (uint32_t k = 0; k < ends; k++) {
            for (uint32_t j = 0; j < 6u; j++) {
                tl_row_push(h)[of[k].row].f[j] += of[k].d[j] * (most / way);
            }
        }
    }
}
