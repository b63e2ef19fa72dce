/* Joints solved eight at a time: drives, then limits, each row by projected Gauss-Seidel, then all equalities of a
 * joint at once by their factored matrix. Velocities and errors are kept apart: the velocity passes know no error,
 * which is taken back as displacements that leave no speed behind (the split of Guendelman, Bridson and Fedkiw,
 * "Nonconvex rigid bodies with stacking", SIGGRAPH 2003), so that a chain gains no energy from what its passes leave
 * unsolved. */

/* Errors of what is exact grow by themselves alone. Up to these (m, rad) they are left to the step's last sub-step. */
#define NEAR_AWAY 5e-6f
#define NEAR_TURNED 5e-5f

/* Joints that hang together in more than there is room to solve at once, as a net's, or in rings that are torn or
 * whirl, are damped springs instead: what their passes leave, taken back without a speed, would be work done for
 * nothing, and a net would seethe. The turn in a sub-step, in radians, and the damping ratio. */
#define LOOSE_TURN 1.5708f
#define LOOSE_DAMPING 2.0f

/* As load_pair and store_pair, but for a side on which nothing moves. */
TL_INLINE void load_joint_pair(const float *velocities, const tl_joint_group *g, pair_velocity *p) {
    tl_f8 r[8];
    p->sides = g->needs;
    p->va = p->ua = p->vb = p->ub = v8_zero();
    p->ma = p->ta = p->mb = p->tb = tl_f8_zero();
    if (p->sides & TL_JOINT_A) {
        tl_f8_load_rows(velocities, g->a, r);
        p->va = v8_of(r[0], r[1], r[2]), p->ua = v8_of(r[3], r[4], r[5]), p->ma = r[6], p->ta = r[7];
    }
    if (p->sides & TL_JOINT_B) {
        tl_f8_load_rows(velocities, g->b, r);
        p->vb = v8_of(r[0], r[1], r[2]), p->ub = v8_of(r[3], r[4], r[5]), p->mb = r[6], p->tb = r[7];
    }
}

TL_INLINE void store_joint_pair(float *velocities, const tl_joint_group *g, const pair_velocity *p) {
    if (p->sides & TL_JOINT_A) {
        const tl_f8 ra[8] = {p->va.x, p->va.y, p->va.z, p->ua.x, p->ua.y, p->ua.z, p->ma, p->ta};
        tl_f8_store_rows(velocities, g->a, ra);
    }
    if (p->sides & TL_JOINT_B) {
        const tl_f8 rb[8] = {p->vb.x, p->vb.y, p->vb.z, p->ub.x, p->ub.y, p->ub.z, p->mb, p->tb};
        tl_f8_store_rows(velocities, g->b, rb);
    }
}

TL_INLINE tl_f8 joint_speed(const pair_velocity *p, const tl_joint_row *row, int kind) {
    tl_f8 a = tl_f8_zero(), b = tl_f8_zero();
    if (p->sides & TL_JOINT_A) {
        a = v8_dot(v8_load(row->ja[0]), p->ua);
    }
    if (p->sides & TL_JOINT_B) {
        b = v8_dot(v8_load(row->jb[0]), p->ub);
    }
    tl_f8 spin = tl_f8_sub(b, a);
    switch (kind) {
    case ROW_LINEAR:
        return tl_f8_add(v8_dot(v8_load(row->n[0]), v8_sub(p->vb, p->va)), spin);
    case ROW_AXIS:
        return tl_f8_add(spin, tl_f8_sub(p->vb.x, p->va.x));
    case ROW_AXIS + 1:
        return tl_f8_add(spin, tl_f8_sub(p->vb.y, p->va.y));
    case ROW_AXIS + 2:
        return tl_f8_add(spin, tl_f8_sub(p->vb.z, p->va.z));
    default:
        return spin;
    }
}

/* v + s n, n being what a row of this kind is along. */
TL_INLINE v8 along_row(v8 v, tl_f8 s, const tl_joint_row *row, int kind) {
    switch (kind) {
    case ROW_LINEAR:
        return v8_mad(v, s, v8_load(row->n[0]));
    case ROW_AXIS:
        return v8_of(tl_f8_add(v.x, s), v.y, v.z);
    case ROW_AXIS + 1:
        return v8_of(v.x, tl_f8_add(v.y, s), v.z);
    case ROW_AXIS + 2:
        return v8_of(v.x, v.y, tl_f8_add(v.z, s));
    default:
        return v;
    }
}

TL_INLINE void joint_apply(pair_velocity *p, const tl_joint_row *row, int kind, tl_f8 impulse) {
    if (p->sides & TL_JOINT_A) {
        tl_f8 back = tl_f8_neg(impulse);
        p->va = along_row(p->va, tl_f8_mul(back, p->ma), row, kind);
        p->ua = v8_mad(p->ua, tl_f8_mul(back, p->ta), v8_load(row->ja[0]));
    }
    if (p->sides & TL_JOINT_B) {
        p->vb = along_row(p->vb, tl_f8_mul(impulse, p->mb), row, kind);
        p->ub = v8_mad(p->ub, tl_f8_mul(impulse, p->tb), v8_load(row->jb[0]));
    }
}

/* An implicit spring and damper, bounded in force: softness g = 1 / (h (c + h k)), speed it seeks (k e + c v) / (c + h
 * k) (Catto, "Soft constraints", GDC 2011). */
static void solve_drive(const tl_step *step, pair_velocity *p, tl_joint_row *row, int linear) {
    tl_f8 h = tl_f8_set1(step->sub), one = tl_f8_set1(1.0f), mass = tl_f8_load(row->mass);
    tl_f8 scale = tl_f8_select(tl_f8_gt(tl_f8_load(row->per_mass), tl_f8_zero()), mass, one);
    tl_f8 k = tl_f8_mul(tl_f8_load(row->stiffness), scale), c = tl_f8_mul(tl_f8_load(row->damping), scale);
    tl_f8 s = tl_f8_mad(c, h, k);
    tl_f8 give = inverse_or_zero(tl_f8_mul(h, s));
    tl_f8 error = tl_f8_sub(tl_f8_load(row->lower), tl_f8_load(row->error));
    tl_f8 goal = tl_f8_mul(tl_f8_mad(tl_f8_mul(k, error), c, tl_f8_load(row->speed)), inverse_or_zero(s));
    tl_f8 old = tl_f8_load(row->impulse), speed = joint_speed(p, row, linear);
    tl_f8 excess = tl_f8_mad(tl_f8_sub(speed, goal), give, old);
    tl_f8 now = tl_f8_sub(old, tl_f8_div(tl_f8_mul(mass, excess), tl_f8_mad(one, give, mass)));
    tl_f8 most = tl_f8_mul(tl_f8_load(row->most), h);
    now = tl_f8_max(tl_f8_min(now, most), tl_f8_neg(most));
    now = tl_f8_and_mask(tl_f8_gt(s, tl_f8_zero()), now);
    tl_f8_store(row->impulse, now);
    joint_apply(p, row, linear, tl_f8_sub(now, old));
}

/* The nearer side of a range: 1 for the lower, -1 for the upper one. */
static inline tl_f8 range_sign(const tl_joint_row *row) {
    tl_m8 low = tl_f8_gt(tl_f8_load(row->at_lower), tl_f8_zero());
    return tl_f8_select(low, tl_f8_set1(1.0f), tl_f8_set1(-1.0f));
}

/* How far inside the nearer side of a range a joint is, and which side that is. */
static inline tl_f8 range_gap(const tl_joint_row *row, tl_f8 *sign) {
    tl_m8 low = tl_f8_gt(tl_f8_load(row->at_lower), tl_f8_zero());
    tl_f8 error = tl_f8_load(row->error);
    *sign = range_sign(row);
    return tl_f8_select(low, tl_f8_sub(error, tl_f8_load(row->lower)), tl_f8_sub(tl_f8_load(row->upper), error));
}

/* The nearer side of a range, hard or a spring, pushing one way only. */
static void solve_range(const tl_step *step, pair_velocity *p, tl_joint_row *row, int linear) {
    tl_f8 h = tl_f8_set1(step->sub), one = tl_f8_set1(1.0f), zero = tl_f8_zero(), mass = tl_f8_load(row->mass);
    tl_f8 sign, gap = range_gap(row, &sign);
    tl_f8 old = tl_f8_mul(sign, tl_f8_load(row->impulse)), speed = tl_f8_mul(sign, joint_speed(p, row, linear));
    tl_m8 apart = tl_f8_gt(gap, zero);
    tl_f8 bias = tl_f8_and_mask(apart, tl_f8_mul(gap, tl_f8_set1(step->inverse_sub)));
    tl_f8 hard = tl_f8_max(tl_f8_sub(old, tl_f8_mul(mass, tl_f8_add(speed, bias))), zero);
    tl_f8 k = tl_f8_load(row->stiffness), c = tl_f8_load(row->damping), s = tl_f8_mad(c, h, k);
    tl_f8 give = inverse_or_zero(tl_f8_mul(h, s));
    tl_f8 goal = tl_f8_neg(tl_f8_mul(tl_f8_mul(k, gap), inverse_or_zero(s)));
    tl_f8 excess = tl_f8_mad(tl_f8_sub(speed, goal), give, old);
    tl_f8 soft = tl_f8_sub(old, tl_f8_div(tl_f8_mul(mass, excess), tl_f8_mad(one, give, mass)));
    soft = tl_f8_select(apart, zero, tl_f8_max(soft, zero));
    tl_f8 now = tl_f8_select(tl_f8_gt(s, zero), soft, hard);
    tl_f8_store(row->impulse, tl_f8_mul(sign, now));
    joint_apply(p, row, linear, tl_f8_mul(sign, tl_f8_sub(now, old)));
}

/* x becomes the impulses that take n equalities' speeds -x to nothing. */
TL_INLINE void solve_factored(const tl_joint_group *g, tl_f8 x[6], uint32_t n) {
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        TL_UNROLL
        for (uint32_t j = 0; j < i; j++) {
            x[i] = tl_f8_sub(x[i], tl_f8_mul(tl_f8_load(g->matrix[i * (i + 1u) / 2u + j]), x[j]));
        }
    }
    TL_UNROLL
    for (uint32_t i = n < TL_LINK_ROWS ? n : TL_LINK_ROWS; i-- > 0;) {
        x[i] = tl_f8_mul(x[i], tl_f8_load(g->matrix[i * (i + 1u) / 2u + i]));
        TL_UNROLL
        for (uint32_t j = i + 1u; j < n && j < TL_LINK_ROWS; j++) {
            x[i] = tl_f8_sub(x[i], tl_f8_mul(tl_f8_load(g->matrix[j * (j + 1u) / 2u + i]), x[j]));
        }
    }
}

/* Whether a group is to be passed over, for one solve of its velocities in a sub-step is all it takes. */
static inline int is_exact(const tl_step *step, const tl_joint_group *g) { return step->skip_exact && g->exact; }
/* Whether what is found now stands in the impulses already, as that which the sub-step before left to this one. */
static inline int counts_for_last(const tl_step *step, const tl_joint_group *g) { return step->deferred && g->exact; }

/* From the impulses that meet the speeds with their errors to those of springs, without what gives way of the old. */
static inline tl_f8 loosened(const tl_joint_row *row, tl_f8 x) {
    float a = LOOSE_TURN * (2.0f * LOOSE_DAMPING + LOOSE_TURN), give = 1.0f / (1.0f + a);
    return tl_f8_mul(tl_f8_set1(give), tl_f8_sub(tl_f8_mul(tl_f8_set1(a), x), tl_f8_load(row->impulse)));
}
static inline tl_f8 loose_speed(const tl_step *step, const tl_joint_row *row) {
    float rate = LOOSE_TURN / (2.0f * LOOSE_DAMPING + LOOSE_TURN) * step->inverse_sub;
    return tl_f8_mul(tl_f8_set1(rate), tl_f8_sub(tl_f8_load(row->error), tl_f8_load(row->lower)));
}

TL_INLINE void solve_equalities_of(const tl_step *step, const tl_joint_group *g, tl_joint_row *rows, pair_velocity *p,
                                   int before_move, uint32_t form, uint32_t n) {
    tl_f8 x[6];
    int keep = !counts_for_last(step, g), loose = before_move && g->gives;
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        tl_f8 speed = joint_speed(p, &rows[i], kind_in(form, g, i));
        speed = before_move ? tl_f8_add(speed, tl_f8_load(rows[i].curve)) : speed;
        x[i] = tl_f8_neg(loose ? tl_f8_add(speed, loose_speed(step, &rows[i])) : speed);
    }
    solve_factored(g, x, n);
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        x[i] = loose ? loosened(&rows[i], x[i]) : x[i];
        if (keep) {
            tl_f8_store(rows[i].impulse, tl_f8_add(tl_f8_load(rows[i].impulse), x[i]));
        }
        joint_apply(p, &rows[i], kind_in(form, g, i), x[i]);
    }
}

static void solve_equalities(const tl_step *step, const tl_joint_group *g, tl_joint_row *rows, pair_velocity *p,
                             int before_move) {
    IN_FORM(g, solve_equalities_of, step, g, rows, p, before_move);
}

TL_INLINE void push_equalities_of(const tl_joint_group *g, const tl_joint_row *rows, pair_velocity *p, uint32_t form,
                                  uint32_t n) {
    tl_f8 x[6];
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        tl_f8 error = tl_f8_sub(tl_f8_load(rows[k].error), tl_f8_load(rows[k].lower));
        error = tl_f8_add(error, joint_speed(p, &rows[k], kind_in(form, g, k)));
        x[k] = tl_f8_neg(error);
    }
    solve_factored(g, x, n);
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        joint_apply(p, &rows[k], kind_in(form, g, k), x[k]);
    }
}

static void push_equalities(const tl_joint_group *g, const tl_joint_row *rows, pair_velocity *p) {
    IN_FORM(g, push_equalities_of, g, rows, p);
}

/* Whether the errors of an exact group, whose bodies nothing else displaces, may wait. */
TL_INLINE void near_of_form(const tl_joint_group *g, const tl_joint_row *rows, int *near, uint32_t form, uint32_t n) {
    tl_m8 away = tl_m8_zero();
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        tl_f8 error = tl_f8_abs(tl_f8_sub(tl_f8_load(rows[k].error), tl_f8_load(rows[k].lower)));
        float most = kind_in(form, g, k) == ROW_ANGULAR ? NEAR_TURNED : NEAR_AWAY;
        away = tl_m8_or(away, tl_f8_gt(error, tl_f8_set1(most)));
    }
    *near = !tl_m8_any(away);
}

static int is_near(const tl_joint_group *g, const tl_joint_row *rows) {
    int near = 0;
    IN_FORM(g, near_of_form, g, rows, &near);
    return near;
}

/* Displacements that take back the errors and what is beyond hard limits. */
static void push_joints(const tl_step *step, uint32_t first, uint32_t last) {
    float *pushes = tl_row_push(step->h)->f;
    tl_f8 zero = tl_f8_zero();
    for (uint32_t i = first; i < last; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        pair_velocity p;
        if (g->linked ? g->rows == g->fixed : step->waits && g->exact && is_near(g, rows)) {
            continue;
        }
        load_joint_pair(pushes, g, &p);
        for (uint32_t k = g->rows; k-- > g->fixed;) {
            if (g->code[k] / TL_ROW_TYPES != TL_ROW_RANGE) {
                continue;
            }
            int linear = is_linear_row(g->code[k]);
            tl_f8 sign, gap = range_gap(&rows[k], &sign);
            tl_m8 soft = tl_f8_gt(tl_f8_add(tl_f8_load(rows[k].stiffness), tl_f8_load(rows[k].damping)), zero);
            gap = tl_f8_add(gap, tl_f8_mul(sign, joint_speed(&p, &rows[k], linear)));
            tl_f8 push = tl_f8_mul(tl_f8_load(rows[k].mass), tl_f8_max(tl_f8_neg(gap), zero));
            joint_apply(&p, &rows[k], linear, tl_f8_mul(sign, tl_f8_select(soft, zero, push)));
        }
        if (!g->linked && !g->gives) {
            push_equalities(g, rows, &p);
        }
        store_joint_pair(pushes, g, &p);
    }
}

static void run_joints(const tl_step *step, uint32_t first, uint32_t last, int before_move) {
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        pair_velocity p;
        if ((g->linked && g->rows == g->fixed) || is_exact(step, g)) {
            continue;
        }
        load_joint_pair(tl_row_velocity(step->h)->f, g, &p);
        for (uint32_t k = g->rows; k-- > g->fixed;) {
            int linear = is_linear_row(g->code[k]);
            if (g->code[k] / TL_ROW_TYPES == TL_ROW_DRIVE) {
                solve_drive(step, &p, &rows[k], linear);
            } else {
                solve_range(step, &p, &rows[k], linear);
            }
        }
        if (!g->linked) {
            solve_equalities(step, g, rows, &p, before_move);
        }
        store_joint_pair(tl_row_velocity(step->h)->f, g, &p);
    }
}

static void solve_joints(const tl_step *step, uint32_t first, uint32_t last) { run_joints(step, first, last, 1); }
static void relax_joints(const tl_step *step, uint32_t first, uint32_t last) { run_joints(step, first, last, 0); }

/* The impulses of the first rows, of those along the world's axes what turns bodies alone where `turn`. */
TL_INLINE void apply_rows(const tl_joint_row *rows, const tl_joint_group *g, pair_velocity *p, float sign, int turn,
                          uint32_t form, uint32_t n) {
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        tl_f8 impulse = tl_f8_mul(tl_f8_set1(sign), tl_f8_load(rows[k].impulse));
        int kind = kind_in(form, g, k);
        joint_apply(p, &rows[k], turn && kind >= ROW_AXIS ? ROW_ANGULAR : kind, impulse);
    }
}

TL_INLINE void apply_all(const tl_joint_group *g, const tl_joint_row *rows, pair_velocity *p, float sign, int turn) {
    IN_LINKED_FORM(g, g->fixed, apply_rows, rows, g, p, sign, turn);
    for (uint32_t k = g->fixed; k < g->rows; k++) {
        joint_apply(p, &rows[k], row_kind(g, k), tl_f8_mul(tl_f8_set1(sign), tl_f8_load(rows[k].impulse)));
    }
}

/* Rows when the step begins, and the impulses that the last step ended with. */
static void begin_joints(const tl_step *step, uint32_t first, uint32_t last) {
    float *velocities = tl_row_velocity(step->h)->f;
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        pair_velocity p;
        make_joint_rows(step, g);
        load_joint_pair(velocities, g, &p);
        apply_all(g, rows, &p, 1.0f, 0);
        store_joint_pair(velocities, g, &p);
    }
}

/* Rows after the poses changed. The next sub-step starts from the present impulses along the new rows and not the old
 * ones: the velocity that they are reckoned from is moved by the difference, which rows along the world's axes have in
 * their angular parts alone. */
static void turn_joints(const tl_step *step, uint32_t first, uint32_t last) {
    float *befores = tl_row_before(step->h)->f;
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        pair_velocity p;
        if (step->again && !(g->far & TL_FAR_AGAIN)) {
            continue;
        }
        load_joint_pair(befores, g, &p);
        p.ta = tl_f8_load(g->turns[0]), p.tb = tl_f8_load(g->turns[1]);
        apply_all(g, rows, &p, 1.0f, 1);
        make_joint_rows(step, g);
        p.ta = tl_f8_load(g->turns[0]), p.tb = tl_f8_load(g->turns[1]);
        apply_all(g, rows, &p, -1.0f, 1);
        store_joint_pair(befores, g, &p);
    }
}
