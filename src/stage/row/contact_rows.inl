/* Contact rows: eight manifolds at a time become Jacobians and effective masses, from the bodies' poses when the step
 * begins; and the impulses go back to the manifolds when it ends.
 *
 * Friction acts at the manifold's centre, as a vector in the tangent plane and a torque about the normal: three rows a
 * manifold instead of two a point. */
#include <string.h>

/* m: overlap beyond is more than the solver's spring should be left with. */
#define PUSH_DEPTH 4e-3f

/* Weight of a point that is far apart, against one that touches, in the manifold's centre. */
#define FAR_WEIGHT 1e-3f

/* Of what friction can bear, what holds bears less. */
#define GRIP_LOAD 0.98f

/* The spring of a contact at rest is as deep as its load asks for: under twenty boxes, nineteen times as deep as under
 * one. Beyond LIFT_DEPTH nearly all of that is taken off again: the overlap counts as deeper than it is by a lift,
 * which goes towards what the load asks for. What follows a load behind its swing feeds the swing, the more the faster
 * it follows: at 1/s all the time, a tower of planks that was struck swings more and more. It is fast on its way, and
 * slow where it has arrived. */
#define LIFT_DEPTH 2.5e-4f /* m */
#define LIFT_SHARE 0.95f
#define LIFT_RATE 1.0f   /* 1/s, of a lift that is far from it */
#define LIFT_NEAR 0.3f   /* of that rate is left where it is near */
#define LEAST_LIFT 1e-7f /* m: less is none */
#define FACE_POINTS 3u   /* that a face rests on, in a plane one fewer; what has fewer may roll */

/* A slow sway of many bodies hardly shows in one contact, and one pass a sub-step answers it late: an impulse remembers
 * a_2 / (1 + a_2) of the last (a_1, a_2 of set_softness), which is a_2 h behind. What the passes take off the speed
 * leads by (1 + R (1 + 1 / a_2)) a_1 / w, R being how far the pass after the move goes: just as much with R = 1, and
 * the sway of a tower of planks would grow. Where balls touch there is no such sway, and piles of them would rattle. */
#define FACE_OVER 1.5f

/* A cube on its face has four points of a quarter of its mass in space, but two of two fifths in a plane: their springs
 * are made stiffer, so that it sinks in as far. As many springs as in space would be twice as stiff, and shake piles.
 */
#define PLANAR_STIFF 1.25f

typedef struct contact_bodies {
    v8 xa, xb; /* centres of mass */
    q8 qa, qb; /* principal axes */
    k8 ka, kb;
    v8 va, ua, vb, ub;
    tl_f8 ma, mb; /* inverse masses */
    tl_f8 ta, tb; /* 1 if impulses turn it */
} contact_bodies;

static inline void load_contact_bodies(const tl_step *step, const tl_contact_group *g, contact_bodies *c) {
    tl_f8 r[8];
    const float *poses = tl_row_pose(step->h)->f, *frames = tl_row_frame(step->h)->f;
    const float *velocities = tl_row_velocity(step->h)->f;
    tl_f8_load_rows(poses, g->a, r);
    c->xa = v8_of(r[0], r[1], r[2]), c->qa = q8_of(r[3], r[4], r[5], r[6]);
    tl_f8_load_rows(poses, g->b, r);
    c->xb = v8_of(r[0], r[1], r[2]), c->qb = q8_of(r[3], r[4], r[5], r[6]);
    tl_f8_load_rows(frames, g->a, r);
    c->ka = k8_of(q8_of(r[0], r[1], r[2], r[3]), v8_of(r[4], r[5], r[6]));
    tl_f8_load_rows(frames, g->b, r);
    c->kb = k8_of(q8_of(r[0], r[1], r[2], r[3]), v8_of(r[4], r[5], r[6]));
    tl_f8_load_rows(velocities, g->a, r);
    c->va = v8_of(r[0], r[1], r[2]), c->ua = v8_of(r[3], r[4], r[5]), c->ma = r[6], c->ta = r[7];
    tl_f8_load_rows(velocities, g->b, r);
    c->vb = v8_of(r[0], r[1], r[2]), c->ub = v8_of(r[3], r[4], r[5]), c->mb = r[6], c->tb = r[7];
}

/* 1 / k where k > 0, else 0. */
static inline tl_f8 inverse_or_zero(tl_f8 k) {
    tl_m8 ok = tl_f8_gt(k, tl_f8_zero());
    return tl_f8_and_mask(ok, tl_f8_div(tl_f8_set1(1.0f), tl_f8_select(ok, k, tl_f8_set1(1.0f))));
}

/* j_a . j_a + j_b . j_b, of each body that impulses turn. */
static inline tl_f8 angular_mass(const contact_bodies *c, v8 ja, v8 jb) {
    return tl_f8_add(tl_f8_mul(c->ta, v8_dot(ja, ja)), tl_f8_mul(c->tb, v8_dot(jb, jb)));
}

/* In a plane: across the normal within it; the second tangent then is the axis. */
static inline v8 tangent_in_plane(v8 n, uint32_t plane) {
    tl_f8 zero = tl_f8_zero();
    switch (plane) {
    case 1:
        return v8_of(zero, tl_f8_neg(n.z), n.y);
    case 2:
        return v8_of(n.z, zero, tl_f8_neg(n.x));
    default:
        return v8_of(tl_f8_neg(n.y), n.x, zero);
    }
}

/* A unit vector across n. */
static inline v8 tangent_of(v8 n) {
    tl_m8 flat = tl_f8_lt(tl_f8_abs(n.x), tl_f8_set1(0.57735f));
    tl_f8 zero = tl_f8_zero();
    v8 t = v8_select(flat, v8_of(zero, n.z, tl_f8_neg(n.y)), v8_of(n.y, tl_f8_neg(n.x), zero));
    tl_f8 l = tl_f8_sqrt(v8_dot(t, t));
    return v8_scale(t, inverse_or_zero(l));
}

/* The records that the points of a group are made of, and what they bear. */
typedef struct point_records {
    uint32_t record[4][TL_LANES]; /* the first one of each point: the contact times four, plus its place */
    float impulse[4][TL_LANES];   /* N s: of all of a point's */
    float count[TL_LANES];        /* points */
} point_records;

static void find_records(const tl_header *h, tl_contact_group *g, point_records *out) {
    memset(out->impulse, 0, sizeof out->impulse);
    for (uint32_t k = 0; k < TL_LANES; k++) {
        uint32_t c = g->contact[k], w = k < g->lanes ? tl_contact_plane(h)[c] : 0u;
        out->count[k] = (float)tl_plane_points(w);
        g->stiff[k] = k < g->lanes && tl_contacts(h)[c].count > tl_plane_points(w) ? PLANAR_STIFF : 1.0f;
        for (uint32_t p = 0; p < 4u; p++) {
            out->record[p][k] = 4u * c + tl_plane_first(w, p);
        }
        for (uint32_t r = 0; k < g->lanes && r < tl_contacts(h)[c].count; r++) {
            out->impulse[tl_plane_point_of(w, r)][k] += tl_points(h)[c].p[r].impulse;
        }
    }
}

/* The points' rows, and the weighted centre of the manifold on both bodies. */
static void prepare_points(const tl_step *step, tl_contact_group *g, const contact_bodies *c, v8 n, v8 *center_a,
                           v8 *center_b, tl_f8 *lever) {
    const float *records = tl_points(step->h)->p[0].a;
    const tl_contact_meta *metas = tl_contacts(step->h);
    point_records in_plane;
    float count[TL_LANES];
    for (uint32_t k = 0; k < TL_LANES; k++) {
        count[k] = k < g->lanes ? (float)metas[g->contact[k]].count : 0.0f;
    }
    if (g->plane) {
        find_records(step->h, g, &in_plane);
    }
    tl_f8 counts = tl_f8_loadu(g->plane ? in_plane.count : count), zero = tl_f8_zero(), one = tl_f8_set1(1.0f),
          sum = zero, ways = zero;
    tl_f8 fade = tl_f8_set1(1.0f / tl_max(step->h->settings.speculative_margin, 1e-6f));
    v8 sum_a = v8_zero(), sum_b = v8_zero(), arms[4];
    tl_f8 deepest = zero;
    tl_f8 weights[4];
    for (uint32_t p = 0; p < g->points; p++) {
        tl_contact_lane_point *out = &g->point[p];
        tl_f8 r[8];
        if (g->plane) {
            tl_f8_load_rows_stride(records, 8u, in_plane.record[p], r);
            r[6] = tl_f8_loadu(in_plane.impulse[p]);
        } else {
            tl_f8_load_rows_stride(records + 8u * p, 32u, g->contact, r);
        }
        tl_m8 used = tl_f8_gt(counts, tl_f8_set1((float)p));
        v8 ra = q8_rotate(c->qa, v8_of(r[0], r[1], r[2])), rb = q8_rotate(c->qb, v8_of(r[3], r[4], r[5]));
        tl_f8 gap = v8_dot(n, v8_sub(v8_add(v8_sub(c->xb, c->xa), rb), ra));
        v8 ja = k8_mul(&c->ka, v8_cross(ra, n)), jb = k8_mul(&c->kb, v8_cross(rb, n));
        tl_f8 mass = inverse_or_zero(tl_f8_add(tl_f8_add(c->ma, c->mb), angular_mass(c, ja, jb)));
        v8_store(out->ja[0], ja);
        v8_store(out->jb[0], jb);
        tl_f8_store(out->gap, gap);
        deepest = tl_f8_max(tl_f8_and_mask(used, tl_f8_neg(gap)), deepest);
        tl_f8_store(out->mass, tl_f8_and_mask(used, mass));
        tl_f8_store(out->impulse, tl_f8_and_mask(used, tl_f8_mul(r[6], tl_f8_set1(step->warm_scale))));
        tl_f8_store(out->peak, zero);
        tl_f8 speed = tl_f8_add(v8_dot(n, v8_sub(c->vb, c->va)), tl_f8_sub(v8_dot(jb, c->ub), v8_dot(ja, c->ua)));
        tl_f8_store(out->approach, tl_f8_and_mask(used, speed));
        tl_f8 near = tl_f8_max(tl_f8_sub(one, tl_f8_mul(tl_f8_max(gap, zero), fade)), tl_f8_set1(FAR_WEIGHT));
        weights[p] = tl_f8_and_mask(used, near);
        arms[p] = ra;
        sum = tl_f8_add(sum, weights[p]);
        sum_a = v8_mad(sum_a, weights[p], ra);
        sum_b = v8_mad(sum_b, weights[p], rb);
    }
    tl_f8_store(g->deepest, deepest);
    g->depth = tl_m8_any(tl_f8_gt(deepest, tl_f8_set1(0.75f * PUSH_DEPTH))) ? TL_DEPTH_PUSHED : 0u;
    tl_f8 scale = inverse_or_zero(sum);
    *center_a = v8_scale(sum_a, scale);
    *center_b = v8_scale(sum_b, scale);
    for (uint32_t p = 0; p < g->points; p++) {
        v8 d = v8_sub(arms[p], *center_a);
        ways = tl_f8_mad(ways, weights[p], tl_f8_sqrt(v8_dot(d, d)));
    }
    *lever = tl_f8_mul(ways, scale);
}

/* m/s^2: how the forces draw b towards a. */
static v8 closing_of(const tl_step *step, const tl_contact_group *g) {
    const float *forces = tl_row_force(step->h)->f;
    tl_f8 r[8];
    tl_f8_load_rows(forces, g->a, r);
    v8 a = v8_of(r[0], r[1], r[2]);
    tl_f8_load_rows(forces, g->b, r);
    return v8_sub(a, v8_of(r[0], r[1], r[2]));
}

/* From the speed of approach when the step began to the one at which the surfaces meet, gaining or losing what gravity
 * does over the gap: v^2 = v0^2 + 2 a s. */
static void prepare_approach(const tl_step *step, tl_contact_group *g, v8 n) {
    tl_f8 zero = tl_f8_zero(), closing = v8_dot(n, closing_of(step, g));
    for (uint32_t p = 0; p < g->points; p++) {
        tl_f8 speed = tl_f8_load(g->point[p].approach), gap = tl_f8_max(tl_f8_load(g->point[p].gap), zero);
        tl_f8 square = tl_f8_mad(tl_f8_mul(speed, speed), tl_f8_mul(tl_f8_set1(2.0f), closing), gap);
        tl_f8 meet = tl_f8_sqrt(tl_f8_max(square, zero));
        tl_f8_store(g->point[p].approach, tl_f8_and_mask(tl_f8_lt(speed, zero), meet));
    }
}

/* N s: what presses eight pairs together. */
static inline tl_f8 pressure_of(const tl_contact_group *g) {
    tl_f8 pressure = tl_f8_zero();
    for (uint32_t i = 0; i < g->points; i++) {
        pressure = tl_f8_add(pressure, tl_f8_load(g->point[i].impulse));
    }
    return pressure;
}

/* How far what did not slide in the last step has slid since the manifold was made. */
static void prepare_grip(tl_contact_group *g, v8 slid, v8 t1, v8 t2) {
    tl_f8 f1 = tl_f8_load(g->tangent_impulse[0]), f2 = tl_f8_load(g->tangent_impulse[1]);
    tl_f8 hold = tl_f8_mul(tl_f8_mul(tl_f8_set1(GRIP_LOAD), tl_f8_load(g->dynamic_friction)), pressure_of(g));
    tl_m8 held = tl_f8_lt(tl_f8_mad(tl_f8_mul(f1, f1), f2, f2), tl_f8_mul(hold, hold));
    tl_f8_store(g->held, tl_f8_and_mask(held, tl_f8_set1(1.0f)));
    tl_f8_store(g->slid[0], v8_dot(slid, t1));
    tl_f8_store(g->slid[1], v8_dot(slid, t2));
}

/* What rests on a face and does not slide is over-relaxed, and lifted, by what its least loaded point asks for: more
 * would open the manifold there. `lift` is that of the last step; it goes at once where it would be more, for the force
 * of a point that is lifted by more than it bears jumps to nothing as its gap opens, and it would chatter. */
static void prepare_rest(const tl_step *step, tl_contact_group *g, tl_f8 lift) {
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f), spring = tl_f8_set1(step->spring), least = one; /* m */
    spring = g->plane ? tl_f8_mul(spring, tl_f8_load(g->stiff)) : spring;
    uint32_t face = FACE_POINTS - (g->plane != 0);
    if (g->points < face) {
        tl_f8_store(g->lift, zero);
        tl_f8_store(g->over, one);
        return;
    }
    for (uint32_t i = 0; i < g->points; i++) {
        tl_f8 k = tl_f8_mul(tl_f8_load(g->point[i].mass), spring);
        tl_f8 depth = tl_f8_mul(tl_f8_load(g->point[i].impulse), inverse_or_zero(k));
        least = tl_f8_select(tl_f8_gt(k, zero), tl_f8_min(depth, least), least);
    }
    tl_m8 rests = tl_f8_gt(tl_f8_mul(tl_f8_load(g->point[face - 1u].mass), tl_f8_load(g->held)), zero);
    tl_f8_store(g->over, tl_f8_select(rests, tl_f8_set1(FACE_OVER), one));
    tl_f8 wanted = tl_f8_mul(tl_f8_sub(least, tl_f8_set1(LIFT_DEPTH)), tl_f8_set1(LIFT_SHARE));
    wanted = tl_f8_and_mask(rests, tl_f8_max(tl_f8_min(wanted, tl_f8_set1(PUSH_DEPTH)), zero));
    tl_f8 way = tl_f8_sub(wanted, lift), whole = tl_f8_max(tl_f8_max(wanted, lift), tl_f8_set1(LEAST_LIFT));
    tl_f8 far = tl_f8_max(tl_f8_div(tl_f8_abs(way), whole), tl_f8_set1(LIFT_NEAR));
    lift = tl_f8_mad(lift, tl_f8_mul(tl_f8_set1(LIFT_RATE * step->dt), far), way);
    lift = tl_f8_min(lift, least);
    tl_m8 any = tl_f8_gt(lift, tl_f8_set1(LEAST_LIFT));
    tl_f8_store(g->lift, tl_f8_and_mask(any, lift));
    g->depth |= tl_m8_any(any) ? TL_DEPTH_LIFTED : 0u;
}

static void prepare_friction(const tl_step *step, tl_contact_group *g, const contact_bodies *c, v8 n, v8 ra, v8 rb) {
    tl_f8 r[8], warm = tl_f8_set1(step->warm_scale), mass = tl_f8_add(c->ma, c->mb);
    v8 t1 = g->plane ? tangent_in_plane(n, g->plane) : tangent_of(n), t2 = v8_cross(n, t1);
    v8 ja1 = k8_mul(&c->ka, v8_cross(ra, t1)), jb1 = k8_mul(&c->kb, v8_cross(rb, t1));
    v8 ja2 = k8_mul(&c->ka, v8_cross(ra, t2)), jb2 = k8_mul(&c->kb, v8_cross(rb, t2));
    v8 jan = k8_mul(&c->ka, n), jbn = k8_mul(&c->kb, n);
    tl_f8 k11 = tl_f8_add(mass, angular_mass(c, ja1, jb1)), k22 = tl_f8_add(mass, angular_mass(c, ja2, jb2));
    tl_f8 k12 = tl_f8_add(tl_f8_mul(c->ta, v8_dot(ja1, ja2)), tl_f8_mul(c->tb, v8_dot(jb1, jb2)));
    tl_f8 d = inverse_or_zero(tl_f8_sub(tl_f8_mul(k11, k22), tl_f8_mul(k12, k12)));
    v8_store(g->tangent[0], t1);
    v8_store(g->ja1[0], ja1);
    v8_store(g->jb1[0], jb1);
    v8_store(g->ja2[0], ja2);
    v8_store(g->jb2[0], jb2);
    v8_store(g->jan[0], jan);
    v8_store(g->jbn[0], jbn);
    tl_f8_store(g->k11, tl_f8_mul(k22, d));
    tl_f8_store(g->k22, tl_f8_mul(k11, d));
    tl_f8_store(g->k12, tl_f8_neg(tl_f8_mul(k12, d)));
    tl_f8_store(g->twist_mass, inverse_or_zero(angular_mass(c, jan, jbn)));
    tl_f8_load_rows(tl_heads(step->h)->normal, g->contact, r);
    v8 impulse = v8_scale(v8_of(r[3], r[4], r[5]), warm);
    tl_f8_store(g->tangent_impulse[0], v8_dot(impulse, t1));
    tl_f8_store(g->tangent_impulse[1], v8_dot(impulse, t2));
    prepare_grip(g, v8_sub(v8_add(v8_sub(c->xb, c->xa), rb), ra), t1, t2);
    prepare_rest(step, g, r[7]);
    tl_f8_store(g->twist_impulse, tl_f8_mul(r[6], warm));
    tl_f8_store(g->rolling_impulse[0], tl_f8_zero());
    tl_f8_store(g->rolling_impulse[1], tl_f8_zero());
    if (g->plane) { /* nothing goes across it */
        tl_f8_store(g->k12, tl_f8_zero());
        tl_f8_store(g->k22, tl_f8_zero());
        tl_f8_store(g->slid[1], tl_f8_zero());
        tl_f8_store(g->tangent_impulse[1], tl_f8_zero());
        tl_f8_store(g->twist_impulse, tl_f8_zero());
    }
    if (g->rolls) {
        v8 ka1 = k8_mul(&c->ka, t1), kb1 = k8_mul(&c->kb, t1), ka2 = k8_mul(&c->ka, t2), kb2 = k8_mul(&c->kb, t2);
        tl_f8 k1 = angular_mass(c, ka1, kb1), k2 = angular_mass(c, ka2, kb2);
        tl_f8_store(g->roll_mass, inverse_or_zero(tl_f8_max(k1, k2)));
    }
}

static void prepare_materials(const tl_step *step, tl_contact_group *g) {
    const tl_contact_material *materials = tl_contact_materials(step->h);
    const tl_contact_meta *metas = tl_contacts(step->h);
    uint32_t bounces = 0, rolls = 0, heard = 0;
    for (uint32_t k = 0; k < TL_LANES; k++) {
        const tl_contact_material *m = &materials[g->contact[k]];
        g->static_friction[k] = m->static_friction;
        g->dynamic_friction[k] = m->dynamic_friction;
        g->restitution[k] = m->restitution;
        g->rolling[k] = m->rolling;
        if (k < g->lanes) {
            bounces |= m->restitution > 0.0f;
            heard |= (metas[g->contact[k]].flags & TL_CONTACT_EVENTS) != 0;
            rolls |= m->rolling > 0.0f;
        }
    }
    g->bounces = bounces;
    g->rolls = rolls;
    g->heard = heard;
    g->struck = 0;
}

static void prepare_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; i++) {
        tl_contact_group *g = &tl_group_pool(step->h)[i];
        contact_bodies c;
        tl_f8 r[8];
        load_contact_bodies(step, g, &c);
        prepare_materials(step, g);
        tl_f8_load_rows(tl_heads(step->h)->normal, g->contact, r);
        v8 n = q8_rotate(c.qa, v8_of(r[0], r[1], r[2])), ra, rb;
        if (g->plane) {
            *(g->plane == 1u ? &n.x : g->plane == 2u ? &n.y : &n.z) = tl_f8_zero();
        }
        v8_store(g->normal[0], n);
        tl_f8 lever;
        prepare_points(step, g, &c, n, &ra, &rb, &lever);
        tl_f8_store(g->lever, lever);
        prepare_friction(step, g, &c, n, ra, rb);
        if (g->heard) {
            prepare_approach(step, g, n);
        }
    }
}

/* What a point bears is shared out evenly to the records that it is made of. */
static void share_impulses(tl_header *h, const tl_contact_group *g, uint32_t lane) {
    uint32_t c = g->contact[lane], w = tl_contact_plane(h)[c], count = tl_contacts(h)[c].count;
    uint32_t sharers[4] = {0, 0, 0, 0};
    for (uint32_t r = 0; r < count; r++) {
        sharers[tl_plane_point_of(w, r)]++;
    }
    for (uint32_t r = 0; r < count; r++) {
        uint32_t p = tl_plane_point_of(w, r);
        float impulse = g->point[p].impulse[lane] / (float)sharers[p];
        tl_points(h)[c].p[r].impulse = tl_is_finite(impulse) ? impulse : 0.0f;
    }
}

static void store_contacts(const tl_step *step, uint32_t first, uint32_t last) {
    tl_contact_head *heads = tl_heads(step->h);
    tl_contact_points *points = tl_points(step->h);
    for (uint32_t i = first; i < last; i++) {
        const tl_contact_group *g = &tl_group_pool(step->h)[i];
        v8 n = v8_load(g->normal[0]), t1 = v8_load(g->tangent[0]), t2 = v8_cross(n, t1);
        v8 f = v8_mad(v8_scale(t1, tl_f8_load(g->tangent_impulse[0])), tl_f8_load(g->tangent_impulse[1]), t2);
        float friction[3][TL_LANES];
        tl_f8_storeu(friction[0], f.x);
        tl_f8_storeu(friction[1], f.y);
        tl_f8_storeu(friction[2], f.z);
        uint32_t records = g->plane ? 0u : g->points; /* that are points themselves */
        for (uint32_t k = 0; k < g->lanes; k++) {
            uint32_t c = g->contact[k];
            for (uint32_t d = 0; d < 3u; d++) {
                heads[c].friction[d] = tl_is_finite(friction[d][k]) ? friction[d][k] : 0.0f;
            }
            heads[c].lift = g->lift[k];
            heads[c].twist = tl_is_finite(g->twist_impulse[k]) ? g->twist_impulse[k] : 0.0f;
            for (uint32_t p = 0; p < records; p++) {
                float impulse = g->point[p].impulse[k];
                points[c].p[p].impulse = tl_is_finite(impulse) ? impulse : 0.0f;
            }
        }
        for (uint32_t k = 0; g->plane && k < g->lanes; k++) {
            share_impulses(step->h, g, k);
        }
    }
}
