/* Impacts by Newton's law of restitution: what the next pass over the contacts would stop leaves at its share of the
 * speed at which it would have met, if that is above the threshold. Manifold after manifold bounces off at the
 * velocities that the ones before it left behind, in sweeps until none meets (as in Guendelman, Bridson and Fedkiw,
 * "Nonconvex rigid bodies with stacking", SIGGRAPH 2003), so that a blow runs through what touches and no energy is
 * lost where none should be.
 *
 * An impact is over when it has happened: its impulses are kept out of what warm starts the next sub-step. */

/* Passes over the points of one manifold. */
#define IMPACT_PASSES 8

/* Sub-steps ahead that count: more than one, for what rounding leaves just short of the surface would be stopped there.
 */
#define IMPACT_REACH 1.0625f

typedef struct impact_point {
    v8 ja, jb;
    tl_m8 meets;
    tl_f8 leave;   /* m/s: the speed after it */
    tl_f8 impulse; /* N s */
} impact_point;

/* Whether a point closes fast enough to meet above the threshold at all. What meets has a gap below (v + c h) r with r
 * = IMPACT_REACH h, so (v - c h)^2 + 2 c s stays below (|v| + 3 |c| h)^2. */
static int may_meet(const tl_step *step, const tl_contact_group *g, const pair_velocity *p, v8 n, tl_f8 gain) {
    tl_f8 threshold = tl_f8_set1(step->h->settings.restitution_speed), zero = tl_f8_zero();
    tl_f8 most = tl_f8_mul(tl_f8_set1(3.0f), tl_f8_abs(gain));
    tl_m8 any = tl_m8_zero();
    for (uint32_t i = 0; i < g->points; i++) {
        const tl_contact_lane_point *point = &g->point[i];
        tl_f8 closing = tl_f8_neg(row_speed(p, n, v8_load(point->ja[0]), v8_load(point->jb[0])));
        any = tl_m8_or(any, tl_m8_and(tl_f8_gt(closing, zero), tl_f8_gt(tl_f8_add(closing, most), threshold)));
    }
    return tl_m8_any(any);
}

/* Which of a manifold's points meet within a sub-step. Surfaces that close at v over the gap s, drawn together by the
 * acceleration c, meet at v_m^2 = v^2 + 2 c s. They leave from where they are, at u^2 + 2 c s = (e v_m)^2. Before the
 * first move of a step the velocities have the forces of a sub-step ahead of the places: then v is less by c h, and
 * what counts is the gap after the move, s + u h. */
static int find_impacts(const tl_step *step, tl_contact_group *g, const pair_velocity *p, v8 n, impact_point *out) {
    tl_f8 c = v8_dot(n, closing_of(step, g)), gain = tl_f8_mul(c, tl_f8_set1(step->sub));
    if (!may_meet(step, g, p, n, gain)) {
        return 0;
    }
    tl_f8 zero = tl_f8_zero(), threshold = tl_f8_set1(step->h->settings.restitution_speed);
    tl_f8 restitution = tl_f8_load(g->restitution), ahead = step->before_move ? gain : zero;
    tl_f8 reach = tl_f8_set1(IMPACT_REACH * step->sub);
    pair_motion moved = load_motion(step, g, n);
    tl_m8 any = tl_m8_zero();
    for (uint32_t i = 0; i < g->points; i++) {
        tl_contact_lane_point *point = &g->point[i];
        impact_point *o = &out[i];
        o->ja = v8_load(point->ja[0]), o->jb = v8_load(point->jb[0]);
        tl_f8 mass = tl_f8_load(point->mass), gap = gap_now(&moved, point, o->ja, o->jb);
        tl_f8 closing = tl_f8_neg(row_speed(p, n, o->ja, o->jb));
        tl_f8 before = tl_f8_sub(closing, ahead), cs2 = tl_f8_mul(tl_f8_add(c, c), tl_f8_max(gap, zero));
        tl_f8 meet2 = tl_f8_max(tl_f8_mad(cs2, before, before), zero);
        o->meets = tl_m8_and(tl_f8_gt(tl_f8_mul(tl_f8_add(closing, gain), reach), gap),
                             tl_f8_gt(meet2, tl_f8_mul(threshold, threshold)));
        o->meets =
            tl_m8_and(o->meets, tl_m8_and(tl_f8_gt(closing, zero), tl_f8_gt(tl_f8_mul(mass, restitution), zero)));
        tl_f8 leave2 = tl_f8_sub(tl_f8_mul(tl_f8_mul(restitution, restitution), meet2), cs2);
        leave2 = tl_f8_max(tl_f8_mad(leave2, ahead, ahead), zero);
        o->leave = tl_f8_max(tl_f8_sub(tl_f8_sqrt(leave2), ahead), zero);
        o->impulse = zero;
        any = tl_m8_or(any, o->meets);
        if (g->heard) {
            tl_f8 meet = tl_f8_and_mask(o->meets, tl_f8_sqrt(meet2));
            tl_f8_store(point->approach, tl_f8_max(tl_f8_load(point->approach), meet));
        }
    }
    return tl_m8_any(any);
}

/* Coulomb friction of the impact's impulse. */
static void strike_tangent(const tl_contact_group *g, pair_velocity *p, pair_velocity *before, v8 n, tl_f8 pressure) {
    v8 t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
    v8 ja1 = v8_load(g->ja1[0]), jb1 = v8_load(g->jb1[0]), ja2 = v8_load(g->ja2[0]), jb2 = v8_load(g->jb2[0]);
    tl_f8 s1 = row_speed(p, t1, ja1, jb1), s2 = row_speed(p, t2, ja2, jb2), x1, x2;
    hold_or_slide(g, s1, s2, tl_f8_zero(), tl_f8_zero(), pressure, &x1, &x2);
    apply_row(p, t1, ja1, jb1, x1);
    apply_row(p, t2, ja2, jb2, x2);
    apply_row(before, t1, ja1, jb1, x1);
    apply_row(before, t2, ja2, jb2, x2);
}

static void strike_group(const tl_step *step, tl_contact_group *g) {
    tl_f8 zero = tl_f8_zero(), pressure = zero;
    float *velocities = tl_row_velocity(step->h)->f, *befores = tl_row_before(step->h)->f;
    impact_point point[4];
    pair_velocity p, before;
    load_pair(velocities, g->a, g->b, &p);
    v8 n = v8_load(g->normal[0]);
    g->struck = (uint32_t)find_impacts(step, g, &p, n, point);
    if (!g->struck) {
        return;
    }
    for (uint32_t i = 0; i < g->points; i++) { /* what it was pressed with is part of the impact */
        tl_f8 old = tl_f8_load(g->point[i].impulse), own = tl_f8_and_mask(point[i].meets, old);
        tl_f8_store(g->point[i].impulse, tl_f8_sub(old, own));
        apply_row(&p, n, point[i].ja, point[i].jb, tl_f8_neg(own));
    }
    load_pair(befores, g->a, g->b, &before);
    for (uint32_t pass = 0; pass < (g->points > 1u ? IMPACT_PASSES : 1u); pass++) {
        for (uint32_t i = 0; i < g->points; i++) {
            impact_point *o = &point[i];
            tl_f8 excess = tl_f8_sub(row_speed(&p, n, o->ja, o->jb), o->leave);
            tl_f8 now = tl_f8_max(tl_f8_sub(o->impulse, tl_f8_mul(tl_f8_load(g->point[i].mass), excess)), zero);
            now = tl_f8_and_mask(o->meets, now);
            tl_f8 gain = tl_f8_sub(now, o->impulse);
            apply_row(&p, n, o->ja, o->jb, gain);
            apply_row(&before, n, o->ja, o->jb, gain);
            o->impulse = now;
        }
    }
    for (uint32_t i = 0; i < g->points; i++) {
        pressure = tl_f8_add(pressure, point[i].impulse);
        tl_f8_store(g->point[i].peak, tl_f8_max(tl_f8_load(g->point[i].peak), point[i].impulse));
    }
    strike_tangent(g, &p, &before, n, pressure);
    store_pair(velocities, g->a, g->b, &p);
    store_pair(befores, g->a, g->b, &before);
}

/* One sweep; a group's `struck` says whether anything met. */
static void strike_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_contact_group *g = &tl_group_pool(step->h)[i];
        if (g->bounces) {
            strike_group(step, g);
        }
    }
}
