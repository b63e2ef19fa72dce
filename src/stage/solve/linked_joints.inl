/* Linked joints, eight at a time: what their linkage has to meet, and what comes of it. */
#include "stage/solve/linkages.inl"

#include "stage/solve/cuts.inl"

/* Linked joints have both sides. */
TL_INLINE void load_linked_pair(const float *velocities, const tl_joint_group *g, pair_velocity *p) {
    load_pair(velocities, g->a, g->b, p);
    p->sides = TL_JOINT_A | TL_JOINT_B;
}

static inline tl_m8 is_hard(const tl_joint_row *row) {
    return tl_f8_eq(tl_f8_add(tl_f8_load(row->stiffness), tl_f8_load(row->damping)), tl_f8_zero());
}

/* What a row has to meet: its speed against the one it seeks, and the give of the raised diagonal. */
TL_INLINE tl_f8 speed_to_meet(const tl_joint_group *g, const tl_joint_row *rows, uint32_t k, int kind,
                              const pair_velocity *p) {
    tl_f8 give = tl_f8_mul(tl_f8_set1(TL_BLOCK_RAISE), tl_f8_load(g->matrix[k * (k + 1u) / 2u + k]));
    return tl_f8_mad(joint_speed(p, &rows[k], kind), give, tl_f8_load(rows[k].impulse));
}

/* m or rad: how far a row is off, beyond what its impulse stretches it by. */
static inline tl_f8 error_to_meet(const tl_step *step, const tl_joint_group *g, const tl_joint_row *rows, uint32_t k) {
    tl_f8 error = tl_f8_sub(tl_f8_load(rows[k].error), tl_f8_load(rows[k].lower));
    if (g->gives) {
        tl_f8 give = tl_f8_mul(tl_f8_load(g->soft), tl_f8_load(g->matrix[k * (k + 1u) / 2u + k]));
        error = tl_f8_mad(error, tl_f8_mul(give, tl_f8_set1(step->sub)), tl_f8_load(rows[k].impulse));
    }
    return error;
}

static inline void set_active(tl_joint_group *g, uint32_t k, tl_m8 holds) {
    tl_f8 now = tl_f8_and_mask(holds, tl_f8_set1(1.0f));
    g->stale |= tl_m8_bits(tl_m8_not(tl_f8_eq(now, tl_f8_load(g->active[k]))));
    tl_f8_store(g->active[k], now);
}

/* A hard range holds where it has an impulse: as an equality until that would have to pull. */
static inline void read_range(const tl_step *step, tl_joint_group *g, const tl_joint_row *rows, uint32_t k,
                              const pair_velocity *p) {
    tl_f8 zero = tl_f8_zero(), sign, gap = range_gap(&rows[k], &sign);
    tl_m8 holds = tl_m8_and(is_hard(&rows[k]), tl_f8_gt(tl_f8_abs(tl_f8_load(rows[k].impulse)), zero));
    tl_f8 bias = tl_f8_mul(tl_f8_max(gap, zero), tl_f8_set1(step->inverse_sub));
    set_active(g, k, holds);
    tl_f8 speed = tl_f8_mad(speed_to_meet(g, rows, k, row_kind(g, k), p), sign, bias);
    tl_f8_store(g->x[k], tl_f8_and_mask(holds, tl_f8_neg(speed)));
}

/* The speed of an equality before the bodies move. What stretches has taken back with it what it is off: as a spring
 * that is solved implicitly, with which its pull stays bounded. */
static inline tl_f8 speed_before_move(const tl_step *step, const tl_joint_group *g, const tl_joint_row *rows,
                                      uint32_t k, tl_f8 speed) {
    speed = tl_f8_add(speed, tl_f8_load(rows[k].curve));
    if (g->gives) {
        tl_m8 soft = tl_f8_gt(tl_f8_load(g->soft), tl_f8_zero());
        tl_f8 back = tl_f8_mul(error_to_meet(step, g, rows, k), tl_f8_set1(step->inverse_sub));
        speed = tl_f8_add(speed, tl_f8_and_mask(soft, back));
    }
    return speed;
}

TL_INLINE void read_speeds(const tl_step *step, tl_joint_group *g, const tl_joint_row *rows, const pair_velocity *p,
                           uint32_t form, uint32_t n) {
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        tl_f8 speed = speed_to_meet(g, rows, k, kind_in(form, g, k), p);
        speed = step->before_move ? speed_before_move(step, g, rows, k, speed) : speed;
        tl_f8_store(g->x[k], tl_f8_neg(speed));
    }
}

/* Speeds to be taken away. */
static void read_velocities(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        if (!g->linked || is_exact(step, g) || (step->again && !(g->far & TL_FAR_AGAIN))) {
            continue;
        }
        pair_velocity p;
        load_linked_pair(tl_row_velocity(step->h)->f, g, &p);
        IN_LINKED_FORM(g, g->fixed, read_speeds, step, g, rows, &p);
        for (uint32_t k = g->fixed; k < g->linked; k++) {
            read_range(step, g, rows, k, &p);
        }
    }
}

/* Errors beyond (m, rad) are taken back in several pushes, for the rows turn on the way. */
#define FAR_AWAY 2e-3f
#define FAR_TURNED 2e-2f

/* A range that holds may not go further in, and one that is far out is brought back. Returns where it is. */
static inline tl_m8 push_range(tl_joint_group *g, const tl_joint_row *rows, uint32_t k, const pair_velocity *p) {
    int linear = is_linear_row(g->code[k]);
    tl_f8 zero = tl_f8_zero(), sign, gap = range_gap(&rows[k], &sign);
    gap = tl_f8_add(gap, tl_f8_mul(sign, joint_speed(p, &rows[k], linear)));
    tl_m8 out = tl_m8_and(is_hard(&rows[k]), tl_f8_lt(gap, tl_f8_set1(linear ? -FAR_AWAY : -FAR_TURNED)));
    set_active(g, k, tl_m8_or(out, tl_f8_gt(tl_f8_load(g->active[k]), zero)));
    tl_f8 push = tl_f8_mul(sign, tl_f8_max(tl_f8_neg(gap), zero));
    tl_f8_store(g->x[k], tl_f8_mul(tl_f8_load(g->active[k]), push));
    return out;
}

TL_INLINE void read_equalities(const tl_step *step, tl_joint_group *g, const tl_joint_row *rows, const pair_velocity *p,
                               tl_m8 *far, uint32_t form, uint32_t n) {
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        int kind = kind_in(form, g, k);
        tl_f8 error = error_to_meet(step, g, rows, k);
        error = tl_f8_add(error, joint_speed(p, &rows[k], kind));
        tl_f8_store(g->x[k], tl_f8_neg(error));
        *far = tl_m8_or(*far, tl_f8_gt(tl_f8_abs(error), tl_f8_set1(kind == ROW_ANGULAR ? FAR_TURNED : FAR_AWAY)));
    }
}

/* Errors to be taken away. */
static void read_errors(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        if (!g->linked || (step->again && !(g->far & TL_FAR_AGAIN))) {
            continue;
        }
        pair_velocity p;
        load_linked_pair(tl_row_push(step->h)->f, g, &p);
        tl_m8 far = tl_m8_zero();
        IN_LINKED_FORM(g, g->fixed, read_equalities, step, g, rows, &p, &far);
        g->far = (g->far & TL_FAR_AGAIN) | (tl_m8_any(far) ? (uint32_t)TL_FAR_NOW : 0u);
        g->far |= step->waits && g->exact && is_near(g, rows) ? (uint32_t)TL_FAR_NOT : 0u;
        for (uint32_t k = g->fixed; k < g->linked; k++) {
            far = tl_m8_or(far, push_range(g, rows, k, &p));
        }
    }
}

/* Adds the pull of equalities, the impulse along the rows that are along something. */
TL_INLINE void apply_equalities(const tl_step *step, const tl_joint_group *g, tl_joint_row *rows, pair_velocity *p,
                                v8 *pull, uint32_t form, uint32_t n) {
    int keep = !counts_for_last(step, g);
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        tl_f8 old = tl_f8_load(rows[k].impulse), now = tl_f8_add(old, tl_f8_load(g->x[k]));
        int kind = kind_in(form, g, k);
        if (keep) {
            tl_f8_store(rows[k].impulse, now);
        }
        joint_apply(p, &rows[k], kind, tl_f8_sub(now, old));
        *pull = along_row(*pull, now, &rows[k], kind);
    }
}

/* Impulses to the bodies. A range that would have to pull is let go, and its linkage noted for another round. */
static void apply_impulses(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        if (!g->linked || is_exact(step, g) || (step->again && !(g->far & TL_FAR_AGAIN))) {
            continue;
        }
        pair_velocity p;
        load_linked_pair(tl_row_velocity(step->h)->f, g, &p);
        v8 pull = v8_zero();
        tl_m8 pulls = tl_m8_zero();
        IN_LINKED_FORM(g, g->fixed, apply_equalities, step, g, rows, &p, &pull);
        for (uint32_t k = g->fixed; k < g->linked; k++) {
            tl_f8 old = tl_f8_load(rows[k].impulse), now = tl_f8_add(old, tl_f8_load(g->x[k]));
            tl_f8 outward = tl_f8_mul(range_sign(&rows[k]), now);
            tl_m8 wrong = tl_m8_and(is_hard(&rows[k]), tl_f8_lt(outward, tl_f8_zero()));
            now = tl_f8_select(wrong, tl_f8_zero(), now);
            pulls = tl_m8_or(pulls, wrong);
            if (!counts_for_last(step, g)) {
                tl_f8_store(rows[k].impulse, now);
            }
            joint_apply(&p, &rows[k], row_kind(g, k), tl_f8_sub(now, old));
            pull = along_row(pull, now, &rows[k], row_kind(g, k));
        }
        g->far = (g->far & TL_FAR_AGAIN) | (tl_m8_any(pulls) ? (uint32_t)TL_FAR_NOW : 0u);
        note_pull(step, g, tl_f8_sqrt(v8_dot(pull, pull)));
        store_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
    }
}

TL_INLINE void push_rows(const tl_joint_group *g, const tl_joint_row *rows, pair_velocity *p, uint32_t form,
                         uint32_t n) {
    TL_UNROLL
    for (uint32_t k = 0; k < n && k < TL_LINK_ROWS; k++) {
        joint_apply(p, &rows[k], kind_in(form, g, k), tl_f8_load(g->x[k]));
    }
}

static void apply_pushes(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(step->h)[i];
        const tl_joint_row *rows = tl_joint_row_pool(step->h) + g->first_row;
        if (!g->linked || (step->again && !(g->far & TL_FAR_AGAIN)) || (step->waits && g->far & TL_FAR_NOT)) {
            continue;
        }
        pair_velocity p;
        load_linked_pair(tl_row_push(step->h)->f, g, &p);
        IN_LINKED_FORM(g, g->linked, push_rows, g, rows, &p);
        store_pair(tl_row_push(step->h)->f, g->a, g->b, &p);
    }
}

static void solve_linkages(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_linkage *l = &tl_linkages(step->h)[i];
        if ((step->again && !l->far) || (step->skip_exact && l->exact) || (step->waits && l->near)) {
            continue;
        }
        if (l->cuts) {
            cut_solve(step->h, l);
        } else if (l->wide) {
            link_solve(step->h, l);
        } else {
            tl_linkage_solve_one(step->h, l);
        }
    }
}
