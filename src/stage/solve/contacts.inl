/* Contacts solved eight manifolds at a time by projected Gauss-Seidel on impulses: Coulomb's cone at the manifold's
 * centre, friction about the normal, rolling resistance, and the normal impulses point by point.
 *
 * Soft constraints in sub-steps (Catto, "Soft constraints", GDC 2011, and "Solver2D", 2024): the pass before the move
 * takes overlap back as a damped spring, the pass after it takes the speed of that out again. The spring is what keeps
 * a tall stack upright: Gauss-Seidel needs a number of passes that grows with the fourth power of the height to stop it
 * from bending, and until it is there only a force that grows with the overlap does. */

/* Of overlap beyond PUSH_DEPTH this share is taken back in a sub-step as a displacement that leaves no speed behind, so
 * that the bottom of a deep pile does not give way. */
#define PUSH_SHARE 0.6f

/* The velocities of eight pairs of bodies, or their displacements. */
typedef struct pair_velocity {
    v8 va, ua, vb, ub;
    tl_f8 ma, ta, mb, tb;
    uint32_t sides; /* of joints: TL_JOINT_A and TL_JOINT_B */
} pair_velocity;

TL_INLINE void load_pair(const float *velocities, const uint32_t *a, const uint32_t *b, pair_velocity *p) {
    tl_f8 r[8];
    tl_f8_load_rows(velocities, a, r);
    p->va = v8_of(r[0], r[1], r[2]), p->ua = v8_of(r[3], r[4], r[5]), p->ma = r[6], p->ta = r[7];
    tl_f8_load_rows(velocities, b, r);
    p->vb = v8_of(r[0], r[1], r[2]), p->ub = v8_of(r[3], r[4], r[5]), p->mb = r[6], p->tb = r[7];
}

TL_INLINE void store_pair(float *velocities, const uint32_t *a, const uint32_t *b, const pair_velocity *p) {
    const tl_f8 ra[8] = {p->va.x, p->va.y, p->va.z, p->ua.x, p->ua.y, p->ua.z, p->ma, p->ta};
    const tl_f8 rb[8] = {p->vb.x, p->vb.y, p->vb.z, p->ub.x, p->ub.y, p->ub.z, p->mb, p->tb};
    tl_f8_store_rows(velocities, a, ra);
    tl_f8_store_rows(velocities, b, rb);
}

/* How far eight pairs of bodies have gone since the step began: the way of the centres, b against a, its part along the
 * normal, and the whitened turns. */
typedef struct pair_motion {
    v8 d;
    tl_f8 way;
    v8 da, db;
} pair_motion;

static inline pair_motion load_motion(const tl_step *step, const tl_contact_group *g, v8 n) {
    const float *moves = tl_row_moved(step->h)->f;
    pair_motion m;
    tl_f8 r[8];
    tl_f8_load_rows(moves, g->a, r);
    v8 xa = v8_of(r[0], r[1], r[2]);
    m.da = v8_of(r[3], r[4], r[5]);
    tl_f8_load_rows(moves, g->b, r);
    m.db = v8_of(r[3], r[4], r[5]);
    m.d = v8_sub(v8_of(r[0], r[1], r[2]), xa);
    m.way = v8_dot(n, m.d);
    return m;
}

/* m: the separation of a point's surfaces where the bodies are now. */
static inline tl_f8 gap_now(const pair_motion *m, const tl_contact_lane_point *c, v8 ja, v8 jb) {
    return tl_f8_add(tl_f8_add(tl_f8_load(c->gap), m->way), tl_f8_sub(v8_dot(jb, m->db), v8_dot(ja, m->da)));
}

/* The relative velocity along a row, of b against a. */
static inline tl_f8 row_speed(const pair_velocity *p, v8 n, v8 ja, v8 jb) {
    return tl_f8_add(v8_dot(n, v8_sub(p->vb, p->va)), tl_f8_sub(v8_dot(jb, p->ub), v8_dot(ja, p->ua)));
}
static inline tl_f8 spin_speed(const pair_velocity *p, v8 ja, v8 jb) {
    return tl_f8_sub(v8_dot(jb, p->ub), v8_dot(ja, p->ua));
}

static inline void apply_spin(pair_velocity *p, v8 ja, v8 jb, tl_f8 impulse) {
    p->ua = v8_msub(p->ua, tl_f8_mul(impulse, p->ta), ja);
    p->ub = v8_mad(p->ub, tl_f8_mul(impulse, p->tb), jb);
}
static inline void apply_row(pair_velocity *p, v8 n, v8 ja, v8 jb, tl_f8 impulse) {
    p->va = v8_msub(p->va, tl_f8_mul(impulse, p->ma), n);
    p->vb = v8_mad(p->vb, tl_f8_mul(impulse, p->mb), n);
    apply_spin(p, ja, jb, impulse);
}

/* The impulses along the tangents that stop the speeds s1 and s2, if static friction under this pressure holds them;
 * else that of sliding. */
static inline void hold_or_slide(const tl_contact_group *g, tl_f8 s1, tl_f8 s2, tl_f8 old1, tl_f8 old2, tl_f8 pressure,
                                 tl_f8 *new1, tl_f8 *new2) {
    tl_f8 k11 = tl_f8_load(g->k11), k12 = tl_f8_load(g->k12), k22 = tl_f8_load(g->k22);
    tl_f8 x1 = tl_f8_sub(old1, tl_f8_mad(tl_f8_mul(k11, s1), k12, s2));
    tl_f8 x2 = tl_f8_sub(old2, tl_f8_mad(tl_f8_mul(k12, s1), k22, s2));
    tl_f8 square = tl_f8_mad(tl_f8_mul(x1, x1), x2, x2);
    tl_f8 hold = tl_f8_mul(tl_f8_load(g->static_friction), pressure);
    tl_f8 slide = tl_f8_mul(tl_f8_load(g->dynamic_friction), pressure);
    tl_m8 slides = tl_f8_gt(square, tl_f8_mul(hold, hold));
    tl_f8 scale = tl_f8_div(slide, tl_f8_select(slides, tl_f8_sqrt(square), tl_f8_set1(1.0f)));
    scale = tl_f8_select(slides, scale, tl_f8_set1(1.0f));
    *new1 = tl_f8_mul(x1, scale);
    *new2 = tl_f8_mul(x2, scale);
}

/* m/s: the speeds along the tangents at which what held is drawn back to where it was gripped. */
typedef struct grip {
    tl_f8 s1, s2;
} grip;

/* m/s: at which what is `way` from where it was gripped is drawn back, if it is held. */
static inline tl_f8 drawn_back(const tl_step *step, tl_f8 held, tl_f8 way) {
    tl_f8 reach = tl_f8_set1(TL_GRIP_REACH);
    tl_f8 rate = tl_f8_mul(held, tl_f8_set1(TL_GRIP_SHARE * step->inverse_sub));
    return tl_f8_mul(rate, tl_f8_max(tl_f8_min(way, reach), tl_f8_neg(reach)));
}

static inline grip grip_of(const tl_step *step, const tl_contact_group *g, const pair_motion *m, v8 n) {
    v8 t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
    v8 ja1 = v8_load(g->ja1[0]), jb1 = v8_load(g->jb1[0]), ja2 = v8_load(g->ja2[0]), jb2 = v8_load(g->jb2[0]);
    tl_f8 held = tl_f8_load(g->held);
    tl_f8 turn1 = tl_f8_sub(v8_dot(jb1, m->db), v8_dot(ja1, m->da));
    tl_f8 turn2 = tl_f8_sub(v8_dot(jb2, m->db), v8_dot(ja2, m->da));
    tl_f8 way1 = tl_f8_add(tl_f8_add(tl_f8_load(g->slid[0]), v8_dot(t1, m->d)), turn1);
    tl_f8 way2 = tl_f8_add(tl_f8_add(tl_f8_load(g->slid[1]), v8_dot(t2, m->d)), turn2);
    return (grip){drawn_back(step, held, way1), drawn_back(step, held, way2)};
}

static inline void solve_tangent(tl_contact_group *g, pair_velocity *p, grip back, v8 n, tl_f8 pressure) {
    v8 t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
    v8 ja1 = v8_load(g->ja1[0]), jb1 = v8_load(g->jb1[0]), ja2 = v8_load(g->ja2[0]), jb2 = v8_load(g->jb2[0]);
    tl_f8 s1 = tl_f8_add(row_speed(p, t1, ja1, jb1), back.s1), s2 = tl_f8_add(row_speed(p, t2, ja2, jb2), back.s2);
    tl_f8 old1 = tl_f8_load(g->tangent_impulse[0]), old2 = tl_f8_load(g->tangent_impulse[1]), new1, new2;
    hold_or_slide(g, s1, s2, old1, old2, pressure, &new1, &new2);
    tl_f8_store(g->tangent_impulse[0], new1);
    tl_f8_store(g->tangent_impulse[1], new2);
    apply_row(p, t1, ja1, jb1, tl_f8_sub(new1, old1));
    apply_row(p, t2, ja2, jb2, tl_f8_sub(new2, old2));
}

static inline void solve_twist(tl_contact_group *g, pair_velocity *p, tl_f8 pressure) {
    v8 ja = v8_load(g->jan[0]), jb = v8_load(g->jbn[0]);
    tl_f8 most = tl_f8_mul(tl_f8_mul(tl_f8_load(g->static_friction), tl_f8_load(g->lever)), pressure);
    tl_f8 old = tl_f8_load(g->twist_impulse);
    tl_f8 now = tl_f8_sub(old, tl_f8_mul(tl_f8_load(g->twist_mass), spin_speed(p, ja, jb)));
    now = tl_f8_max(tl_f8_min(now, most), tl_f8_neg(most));
    tl_f8_store(g->twist_impulse, now);
    apply_spin(p, ja, jb, tl_f8_sub(now, old));
}

/* Resists rolling about both tangents by at most the normal force times the rolling lever. */
static void solve_rolling(const tl_step *step, tl_contact_group *g, pair_velocity *p, v8 n, tl_f8 pressure) {
    tl_f8 r[8];
    const float *frames = tl_row_frame(step->h)->f;
    tl_f8_load_rows(frames, g->a, r);
    k8 ka = k8_of(q8_of(r[0], r[1], r[2], r[3]), v8_of(r[4], r[5], r[6]));
    tl_f8_load_rows(frames, g->b, r);
    k8 kb = k8_of(q8_of(r[0], r[1], r[2], r[3]), v8_of(r[4], r[5], r[6]));
    v8 t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
    v8 ja1 = k8_mul(&ka, t1), jb1 = k8_mul(&kb, t1), ja2 = k8_mul(&ka, t2), jb2 = k8_mul(&kb, t2);
    tl_f8 mass = tl_f8_load(g->roll_mass), most = tl_f8_mul(tl_f8_load(g->rolling), pressure);
    tl_f8 old1 = tl_f8_load(g->rolling_impulse[0]), old2 = tl_f8_load(g->rolling_impulse[1]);
    tl_f8 new1 = tl_f8_sub(old1, tl_f8_mul(mass, spin_speed(p, ja1, jb1)));
    tl_f8 new2 = tl_f8_sub(old2, tl_f8_mul(mass, spin_speed(p, ja2, jb2)));
    tl_f8 square = tl_f8_mad(tl_f8_mul(new1, new1), new2, new2);
    tl_m8 over = tl_f8_gt(square, tl_f8_mul(most, most));
    tl_f8 scale = tl_f8_div(most, tl_f8_select(over, tl_f8_sqrt(square), tl_f8_set1(1.0f)));
    scale = tl_f8_select(over, scale, tl_f8_set1(1.0f));
    new1 = tl_f8_mul(new1, scale);
    new2 = tl_f8_mul(new2, scale);
    tl_f8_store(g->rolling_impulse[0], new1);
    tl_f8_store(g->rolling_impulse[1], new2);
    apply_spin(p, ja1, jb1, tl_f8_sub(new1, old1));
    apply_spin(p, ja2, jb2, tl_f8_sub(new2, old2));
}

static inline void solve_normals(const tl_step *step, tl_contact_group *g, pair_velocity *p, const pair_motion *m, v8 n,
                                 int with_bias, int pressed, int lifted) {
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f), inverse_h = tl_f8_set1(step->inverse_sub);
    tl_f8 rate = tl_f8_set1(step->bias_rate), push = tl_f8_set1(-step->h->settings.push_speed);
    tl_f8 soft_mass = tl_f8_set1(step->mass_scale), soft_impulse = tl_f8_set1(step->impulse_scale);
    tl_f8 lift = lifted ? tl_f8_load(g->lift) : zero, over = with_bias ? one : tl_f8_load(g->over);
    tl_m8 hard = tl_m8_from_bits(pressed ? g->pressed : 0u); /* they have no need of a spring */
    for (uint32_t i = 0; i < g->points; i++) {
        tl_contact_lane_point *c = &g->point[i];
        v8 ja = v8_load(c->ja[0]), jb = v8_load(c->jb[0]);
        tl_f8 gap = gap_now(m, c, ja, jb);
        gap = pressed ? tl_f8_select(hard, tl_f8_max(gap, zero), gap) : gap;
        tl_m8 apart = pressed ? tl_m8_or(hard, tl_f8_gt(gap, zero)) : tl_f8_gt(gap, zero);
        tl_f8 bias = tl_f8_and_mask(apart, tl_f8_mul(gap, inverse_h)), mass = tl_f8_mul(tl_f8_load(c->mass), over);
        tl_f8 old = tl_f8_load(c->impulse), now = old;
        if (with_bias) {
            gap = lifted ? tl_f8_sub(gap, lift) : gap;
            bias = tl_f8_select(apart, bias, tl_f8_max(tl_f8_mul(gap, rate), push));
            mass = tl_f8_mul(mass, tl_f8_select(apart, one, soft_mass));
            now = tl_f8_sub(now, tl_f8_mul(tl_f8_select(apart, zero, soft_impulse), old));
        }
        now = tl_f8_sub(now, tl_f8_mul(mass, tl_f8_add(row_speed(p, n, ja, jb), bias)));
        now = tl_f8_max(now, zero);
        tl_f8_store(c->impulse, now);
        if (g->heard) {
            tl_f8_store(c->peak, tl_f8_max(tl_f8_load(c->peak), now));
        }
        apply_row(p, n, ja, jb, tl_f8_sub(now, old));
    }
}

/* Before the move friction is what the last sub-step found, as part of the warm start: worked out against the spring's
 * pressure it would hold what the spring moves, and what rests would creep. */
static inline void solve_contact_group(const tl_step *step, tl_contact_group *g, int pressed, int lifted) {
    pair_velocity p;
    load_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
    v8 n = v8_load(g->normal[0]);
    pair_motion moved = load_motion(step, g, n);
    solve_normals(step, g, &p, &moved, n, 1, pressed, lifted);
    if (g->rolls && step->first_substep) { /* there is no warm start of it */
        solve_rolling(step, g, &p, n, pressure_of(g));
    }
    store_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
}

/* Friction goes before the normals as well as after them: its lever turns bodies, and they take up the turn. */
static inline void relax_contact_group(const tl_step *step, tl_contact_group *g) {
    pair_velocity p;
    load_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
    v8 n = v8_load(g->normal[0]);
    pair_motion moved = load_motion(step, g, n);
    grip back = grip_of(step, g, &moved, n);
    tl_f8 pressure = pressure_of(g);
    solve_tangent(g, &p, back, n, pressure);
    solve_twist(g, &p, pressure);
    solve_normals(step, g, &p, &moved, n, 0, 0, 0);
    pressure = pressure_of(g);
    solve_tangent(g, &p, back, n, pressure);
    solve_twist(g, &p, pressure);
    if (g->rolls) {
        solve_rolling(step, g, &p, n, pressure);
    }
    store_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
}

/* What presses have met is done with but for its friction about the normal, which they do not know. */
static inline int is_done(const tl_contact_group *g) {
    return g->met == (1u << g->lanes) - 1u && !g->rolls && !g->heard;
}
static void relax_twist(const tl_step *step, tl_contact_group *g) {
    pair_velocity p;
    load_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
    solve_twist(g, &p, pressure_of(g));
    store_pair(tl_row_velocity(step->h)->f, g->a, g->b, &p);
}

#include "stage/solve/planar.inl"

static void solve_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_contact_group *g = &tl_group_pool(step->h)[i];
        if (g->plane) {
            solve_in_plane(step, g);
        } else if (g->pressed) {
            if (!is_done(g)) {
                solve_contact_group(step, g, 1, 1);
            }
        } else if (g->depth & TL_DEPTH_LIFTED) {
            solve_contact_group(step, g, 0, 1);
        } else {
            solve_contact_group(step, g, 0, 0);
        }
    }
}

static void relax_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_contact_group *g = &tl_group_pool(step->h)[i];
        if (g->plane) {
            relax_in_plane(step, g);
        } else if (is_done(g)) {
            relax_twist(step, g);
        } else {
            relax_contact_group(step, g);
        }
    }
}

/* One Gauss-Seidel pass over displacements. */
static void push_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    float *pushes = tl_row_push(step->h)->f;
    tl_f8 zero = tl_f8_zero(), share = tl_f8_set1(PUSH_SHARE), slop = tl_f8_set1(PUSH_DEPTH);
    tl_f8 most = tl_f8_set1(step->h->settings.push_speed * step->sub);
    for (uint32_t k = first; k < last; k++) {
        const tl_contact_group *g = &tl_group_pool(step->h)[k];
        if (!(g->depth & TL_DEPTH_PUSHED)) {
            continue;
        }
        pair_velocity p;
        load_pair(pushes, g->a, g->b, &p);
        v8 n = v8_load(g->normal[0]);
        pair_motion moved = load_motion(step, g, n);
        for (uint32_t i = 0; i < g->points; i++) {
            const tl_contact_lane_point *c = &g->point[i];
            v8 ja = v8_load(c->ja[0]), jb = v8_load(c->jb[0]);
            tl_f8 gap = gap_now(&moved, c, ja, jb);
            gap = tl_f8_add(gap, row_speed(&p, n, ja, jb));
            tl_f8 depth = tl_f8_max(tl_f8_sub(tl_f8_neg(gap), slop), zero);
            apply_row(&p, n, ja, jb, tl_f8_mul(tl_f8_load(c->mass), tl_f8_min(tl_f8_mul(depth, share), most)));
        }
        store_pair(pushes, g->a, g->b, &p);
    }
}

/* What the impulses that the last step ended with do to the velocities of this one's first sub-step. They are summed on
 * their own: added to a velocity one by one, equal impulses of many contacts would be rounded alike, and the error,
 * kept for all sub-steps, would push. */
static void warm_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    float *warm = tl_row_before(step->h)->f;
    for (uint32_t i = first; i < last; i++) {
        const tl_contact_group *g = &tl_group_pool(step->h)[i];
        pair_velocity p;
        load_pair(warm, g->a, g->b, &p);
        v8 n = v8_load(g->normal[0]), t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
        apply_row(&p, t1, v8_load(g->ja1[0]), v8_load(g->jb1[0]), tl_f8_load(g->tangent_impulse[0]));
        apply_row(&p, t2, v8_load(g->ja2[0]), v8_load(g->jb2[0]), tl_f8_load(g->tangent_impulse[1]));
        apply_spin(&p, v8_load(g->jan[0]), v8_load(g->jbn[0]), tl_f8_load(g->twist_impulse));
        for (uint32_t k = 0; k < g->points; k++) {
            const tl_contact_lane_point *c = &g->point[k];
            apply_row(&p, n, v8_load(c->ja[0]), v8_load(c->jb[0]), tl_f8_load(c->impulse));
        }
        store_pair(warm, g->a, g->b, &p);
    }
}
