/* Pressed contacts, a press at a time: the rows that hold, of normals and of friction, are met at once by the block
 * L D L^T of their matrix. Which hold is found by active sets: a point that would have to pull is let go, one that
 * closes is taken in, and friction beyond its cone slides on it. Where that leads astray, for rows may say nearly the
 * same and quarrel, the way is gone only as far as nothing pulls, and the diagonal is raised, as Levenberg and
 * Marquardt do for least squares (Nocedal and Wright, "Numerical Optimization", 10.3, 16.5). What a few rounds leave,
 * and what the system does not know (friction about the normal, rolling), is left to the sweep over all contacts that
 * follows.
 *
 * The lanes are the rows of one contact: its points, then its tangents, of which there is one in a plane. */

#define MOST_ROUNDS 8u
#define LEAST_ROUNDS 2u
#define MOST_LOOKS 256u   /* contacts in all rounds of a solve: of large presses there are fewer */
#define SOFT 2e-4f        /* by what share of itself the diagonal is raised when a step begins, */
#define SOFTER 16.0f      /* how many times more where a way leads astray, */
#define SOFTEST 0.1f      /* and at most */
#define LEAST_SHARE 0.5f  /* of a way that is to be of use */
#define AT_REST 5e-5f     /* m/s: rows that all are slower are met */
#define CLOSING 1e-4f     /* m/s: from here on a point without an impulse is taken in */
#define NEAR_SLIDE 0.999f /* of the friction that a sliding contact has */
#define PRESS_DEPTH 5e-4f /* m: overlap that is left */

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

static void begin_presses(const tl_step *step, uint32_t first, uint32_t last) {
    const tl_header *h = step->h;
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(h)[i];
        for (uint32_t k = 0; k < s->count; k++) {
            fill_rows(h, &tl_pressed_pool(h)[s->first + k]);
        }
        s->stale = 1u;
        s->soft = SOFT;
    }
}

/* --- the factor --------------------------------------------------------------------------------- */

static inline v8 v8_set1(const float *p) { return v8_of(tl_f8_set1(p[0]), tl_f8_set1(p[1]), tl_f8_set1(p[2])); }

/* What impulses in the rows of q do to the speed of row r of p, through a body that is side t of q and s of p. */
static inline tl_f8 share_of(const tl_pressed *p, uint32_t r, uint32_t s, const tl_pressed *q, uint32_t t) {
    const float n[3] = {p->n[0][r], p->n[1][r], p->n[2][r]}, j[3] = {p->j[s][0][r], p->j[s][1][r], p->j[s][2][r]};
    tl_f8 way = v8_dot(v8_set1(n), v8_load(q->n[0])), turn = v8_dot(v8_set1(j), v8_load(q->j[t][0]));
    tl_f8 share = tl_f8_mad(tl_f8_mul(tl_f8_set1(p->mass[s]), way), tl_f8_set1(p->turns[s]), turn);
    return s == t ? share : tl_f8_neg(share);
}

/* A row that does not hold stands for itself alone. */
static void fill_diagonal(const tl_pressed *p, float soft, float *d) {
    float *row = d, lanes[TL_LANES];
    for (uint32_t i = 0; i < p->rows; row += ++i) {
        tl_f8_storeu(lanes, tl_f8_add(share_of(p, i, 0, p, 0), share_of(p, i, 1u, p, 1u)));
        for (uint32_t j = 0; j < i; j++) {
            row[j] = holds(p, i) && holds(p, j) ? lanes[j] : 0.0f;
        }
        row[i] = lanes[i] * (1.0f + soft);
    }
}

static void fill_block(const tl_pressed *p, const tl_pressed *q, uint32_t shares, float *v) {
    const float *end = v + p->rows * q->rows;
    for (uint32_t r = 0; r < p->rows; r++, v += q->rows) {
        float lanes[TL_LANES];
        tl_f8 sum = tl_f8_zero();
        for (uint32_t i = 0; i < 4u && holds(p, r); i++) {
            sum = shares >> i & 1u ? tl_f8_add(sum, share_of(p, r, i / 2u, q, i % 2u)) : sum;
        }
        sum = tl_f8_and_mask(tl_m8_from_bits(q->holds), sum);
        if (end - v >= (int)TL_LANES) { /* the next row goes over what is too much */
            tl_f8_storeu(v, sum);
        } else {
            tl_f8_storeu(lanes, sum);
            memcpy(v, lanes, q->rows * sizeof(float));
        }
    }
}

static void factor_press(const tl_header *h, tl_press *s) {
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    const tl_pressed *p = tl_pressed_pool(h) + s->first;
    float *v = tl_press_values(h) + s->values;
    for (uint32_t j = 0; j < s->count; j++) {
        fill_diagonal(&p[j], s->soft, v + node[j].diagonal);
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &tl_press_blocks(h)[node[j].first + k];
            fill_block(&p[b->node], &p[j], b->shares, v + b->values);
        }
    }
    tl_press_factor(h, s);
    s->stale = 0;
}

/* The right-hand side and then the solution of a contact. What follows, to eight floats, is left as it is. */
static inline float *x_of(const tl_header *h, const tl_press *s, uint32_t k) {
    return tl_press_values(h) + s->values + tl_press_nodes(h)[s->first + k].x;
}
static inline void put_x(float *x, const tl_pressed *p, tl_f8 lanes) {
    tl_m8 rows = tl_m8_from_bits((1u << p->rows) - 1u);
    tl_f8_storeu(x, tl_f8_select(rows, lanes, tl_f8_loadu(x)));
}
/* 0 in rows that do not hold. */
static inline tl_f8 get_x(const float *x, const tl_pressed *p) {
    return tl_f8_and_mask(tl_m8_from_bits(p->holds), tl_f8_loadu(x));
}

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

/* The speeds that the rows have to lose. */
static inline tl_f8 speeds_to_meet(const tl_header *h, const tl_pressed *p) {
    return tl_f8_add(speeds_of(tl_row_velocity(h), p), tl_f8_load(p->bias));
}

/* Of the four points of a face one is too many: impulses v, as large as the triangles that the other three make, push
 * nothing. Without them the rest is least; else they would grow by chance until some point has to let go. */
static void even_out(tl_pressed *p) {
    uint32_t side = p->turns[0] > 0.0f ? 0u : 1u;
    talus_vec3 at[4];
    for (uint32_t k = 0; k < 4u; k++) {
        at[k] = tl_v(p->j[side][0][k], p->j[side][1][k], p->j[side][2][k]);
    }
    talus_vec3 d1 = tl_sub(at[1], at[0]), d2 = tl_sub(at[2], at[0]), d3 = tl_sub(at[3], at[0]);
    talus_vec3 across = tl_add(tl_cross(d1, d2), tl_cross(d2, d3));
    float v[4] = {0.0f, tl_dot(tl_cross(d2, d3), across), tl_dot(tl_cross(d3, d1), across),
                  tl_dot(tl_cross(d1, d2), across)};
    v[0] = -(v[1] + v[2] + v[3]);
    float square = 0.0f, along = 0.0f;
    for (uint32_t k = 0; k < 4u; k++) {
        square += v[k] * v[k], along += v[k] * p->impulse[k];
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

/* What stays as it is until the speeds are met, and where it begins. */
static void begin_to_meet(const tl_step *step, tl_pressed *p) {
    for (uint32_t row = 0; row < p->rows; row++) {
        p->impulse[row] = *impulse_of(step->h, p, row);
    }
    if (p->points == 4u) {
        even_out(p);
    }
    tl_f8 gap = gaps_of(step->h, p), ahead = tl_f8_mul(tl_f8_max(gap, tl_f8_zero()), tl_f8_set1(step->inverse_sub));
    tl_f8 back = drawn_back(step, tl_f8_set1(p->held), gap);
    tl_f8_store(p->bias, tl_f8_select(tl_m8_from_bits(point_bits(p)), ahead, back));
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
static inline int look_at(const tl_header *h, tl_pressed *p, uint32_t *changed) {
    tl_f8 impulse = tl_f8_load(p->impulse), speed = speeds_to_meet(h, p);
    tl_f8_store(p->from, impulse);
    tl_f8_store(p->speed, speed);
    tl_m8 bears = tl_m8_or(tl_f8_gt(impulse, tl_f8_zero()), tl_f8_lt(speed, tl_f8_set1(p->fresh ? AT_REST : -CLOSING)));
    uint32_t met = tl_m8_bits(tl_f8_lt(tl_f8_abs(speed), tl_f8_set1(AT_REST)));
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
        moves |= look_at(h, &tl_pressed_pool(h)[s->first + k], &changed);
    }
    s->stale |= changed != 0;
    return moves && (changed || !wanted);
}

/* Impulses that would meet the speeds of the rows that hold. */
static void find_changes(const tl_header *h, tl_press *s) {
    if (s->stale) {
        factor_press(h, s);
    }
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        put_x(x_of(h, s, k), p, tl_f8_and_mask(tl_m8_from_bits(p->holds), tl_f8_neg(tl_f8_load(p->speed))));
    }
    tl_press_solve(h, s);
}

/* Goes a share of the way that was found. */
static void go(const tl_header *h, const tl_press *s, float share) {
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        add_impulses(h, p, tl_f8_mul(tl_f8_set1(share), get_x(x_of(h, s, k), p)));
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
        const float *change = x_of(h, s, k);
        for (uint32_t row = 0; row < p->points; row++) {
            if (holds(p, row) && change[row] < 0.0f) {
                p->barred |= p->from[row] > 0.0f ? 0u : 1u << row;
                share = tl_min(share, p->from[row] / -change[row]);
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
    s->soft = tl_min(s->soft * SOFTER, SOFTEST);
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

static void press_velocities(const tl_step *step, uint32_t first, uint32_t last) {
    const tl_header *h = step->h;
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(h)[i];
        tl_pressed *p = tl_pressed_pool(h) + s->first;
        uint32_t rounds = MOST_LOOKS / s->count, round = 0;
        rounds = rounds < LEAST_ROUNDS ? LEAST_ROUNDS : rounds > MOST_ROUNDS ? MOST_ROUNDS : rounds;
        for (uint32_t k = 0; k < s->count; k++) {
            begin_to_meet(step, &p[k]);
        }
        for (int done = 0; round < rounds && look(h, s, done); round++) {
            run_round(h, s, &done);
        }
        for (uint32_t k = 0; k < s->count && round; k++) {
            end_meeting(h, &p[k]);
        }
    }
}

/* --- errors ------------------------------------------------------------------------------------- */

/* Fills in how far the points that hold are to be parted; returns whether any is. */
static int read_depths(const tl_step *step, const tl_press *s) {
    const tl_header *h = step->h;
    float budget = h->settings.error_budget;
    tl_f8 zero = tl_f8_zero(), most = tl_f8_set1(h->settings.push_speed * step->sub);
    tl_f8 left = tl_f8_set1(budget > 0.0f ? tl_min(PRESS_DEPTH, 0.5f * budget) : PRESS_DEPTH);
    tl_m8 any = tl_m8_zero();
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        tl_f8 gap = tl_f8_add(gaps_of(h, p), speeds_of(tl_row_push(h), p));
        tl_f8 depth = tl_f8_min(tl_f8_max(tl_f8_sub(tl_f8_neg(gap), left), zero), most);
        depth = tl_f8_and_mask(tl_m8_from_bits(p->holds & point_bits(p)), depth);
        any = tl_m8_or(any, tl_f8_gt(depth, zero));
        put_x(x_of(h, s, k), p, depth);
    }
    return tl_m8_any(any);
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
        push_side(of[end].d, p, side, get_x(x_of(h, s, i / 2u), p));
    }
    return ends;
}

/* Rows that say nearly the same, but not quite, ask for long ways: those are made shorter as a whole. */
static void press_errors(const tl_step *step, uint32_t first, uint32_t last) {
    const tl_header *h = step->h;
    displacement of[TL_MOST_PRESSED + 1u];
    for (uint32_t i = first; i < last; i++) {
        tl_press *s = &tl_presses(h)[i];
        if (s->stale || !read_depths(step, s)) {
            continue;
        }
        tl_press_solve(h, s);
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
