/* Body rows of bodies that fall and turn freely, eight at a time; others are filled one by one (bodies.c). Rows that no
 * body has are those of body 0, which nothing moves. */

/* K stays as it is for a step, but the gyroscopic term follows the turning body. Where a joint ties the two together
 * they must not differ by more than this share. */
#define MOST_INERTIA_TURN 0.1f

/* The rate (1/s) at which the inverse inertia changes in the world, as a share of itself: a body that spins about an
 * axis of symmetry keeps it, a rod that is swung does not. */
static inline tl_f8 inertia_turn(v8 own, v8 s) {
    v8 k = v8_mul(s, s);
    tl_f8 x = tl_f8_div(tl_f8_mul(tl_f8_abs(own.x), tl_f8_abs(tl_f8_sub(k.y, k.z))), tl_f8_max(k.y, k.z));
    tl_f8 y = tl_f8_div(tl_f8_mul(tl_f8_abs(own.y), tl_f8_abs(tl_f8_sub(k.z, k.x))), tl_f8_max(k.z, k.x));
    tl_f8 z = tl_f8_div(tl_f8_mul(tl_f8_abs(own.z), tl_f8_abs(tl_f8_sub(k.x, k.y))), tl_f8_max(k.x, k.y));
    return tl_f8_max(x, tl_f8_max(y, z));
}

/* 1 where one principal inertia is far below the two others. */
static inline tl_f8 slender_of(v8 s) {
    tl_f8 most = tl_f8_max(s.x, tl_f8_max(s.y, s.z)), least = tl_f8_min(s.x, tl_f8_min(s.y, s.z));
    tl_f8 middle = tl_f8_sub(tl_f8_sub(tl_f8_add(tl_f8_add(s.x, s.y), s.z), most), least);
    tl_m8 slender = tl_f8_gt(tl_f8_mul(most, most), tl_f8_mul(tl_f8_mul(tl_f8_set1(TL_SLENDER), middle), middle));
    return tl_f8_and_mask(slender, tl_f8_set1(1.0f));
}

static inline tl_f8 quotient_or_zero(tl_f8 a, tl_f8 s) {
    tl_m8 ok = tl_f8_gt(s, tl_f8_zero());
    return tl_f8_and_mask(ok, tl_f8_div(a, tl_f8_select(ok, s, tl_f8_set1(1.0f))));
}

/* The lanes whose principal inertias differ, but for those that joints tie and that turn too fast for it. */
static inline tl_m8 gyro_of(const tl_step *step, const uint32_t body[TL_LANES], v8 own, v8 s) {
    uint32_t gyro = 0, tied = 0;
    for (uint32_t k = 0; k < TL_LANES; k++) {
        const tl_body_meta *m = &tl_bodies(step->h)[body[k]];
        gyro |= (uint32_t)((m->flags & TL_BODY_GYRO) != 0) << k;
        tied |= (uint32_t)(m->first_joint != TL_NONE) << k;
    }
    if (!(gyro & tied)) {
        return tl_m8_from_bits(gyro);
    }
    tl_f8 turn = tl_f8_mul(inertia_turn(own, s), tl_f8_set1(step->dt));
    tl_m8 fast = tl_f8_gt(turn, tl_f8_set1(MOST_INERTIA_TURN));
    return tl_m8_andnot(tl_m8_and(fast, tl_m8_from_bits(tied)), tl_m8_from_bits(gyro));
}

/* u = s R^T L; the momentum is kept from step to step, for w changes as the body turns. */
static inline v8 momentum_of(const tl_step *step, const uint32_t body[TL_LANES], tl_m8 gyro, q8 frame, v8 s, v8 *u) {
    tl_f8 kept[8];
    tl_f8_load_rows(tl_body_momentum(step->h)->f, body, kept);
    v8 l = v8_of(tl_f8_div(u->x, s.x), tl_f8_div(u->y, s.y), tl_f8_div(u->z, s.z));
    tl_m8 keeps = tl_m8_and(gyro, tl_f8_gt(kept[7], tl_f8_zero()));
    l = v8_select(keeps, v8_of(kept[0], kept[1], kept[2]), q8_rotate(frame, l));
    *u = v8_select(keeps, v8_mul(s, q8_rotate_back(frame, l)), *u);
    return v8_select(gyro, l, v8_zero());
}

static inline tl_f8 damping_of(const tl_step *step, tl_f8 rate) {
    tl_f8 one = tl_f8_set1(1.0f);
    return tl_f8_div(one, tl_f8_mad(one, tl_f8_set1(step->sub), rate));
}

static void fill_bodies(const tl_step *step, uint32_t first, uint32_t last) {
    tl_header *h = step->h;
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f);
    talus_vec3 g = h->settings.gravity;
    for (uint32_t i = first; i < last; i += TL_LANES) {
        uint32_t body[TL_LANES];
        tl_f8 p[8], v[8], in[8];
        bodies_of(h, i, body);
        tl_f8_load_rows(tl_body_pose(h)->f, body, p);
        tl_f8_load_rows(tl_body_velocity(h)->f, body, v);
        tl_f8_load_rows(&tl_body_inertias(h)->inverse_mass, body, in);
        q8 frame = q8_of(p[3], p[4], p[5], p[6]);
        v8 s = v8_of(in[1], in[2], in[3]), own = q8_rotate_back(frame, v8_of(v[3], v[4], v[5])), l = v8_zero();
        v8 u = v8_of(quotient_or_zero(own.x, s.x), quotient_or_zero(own.y, s.y), quotient_or_zero(own.z, s.z));
        tl_m8 gyro = gyro_of(step, body, own, s);
        if (tl_m8_any(gyro)) {
            l = momentum_of(step, body, gyro, frame, s, &u);
        }
        tl_f8 falls = tl_f8_and_mask(tl_f8_gt(in[0], zero), in[4]);
        tl_f8 momentum[8] = {l.x, l.y, l.z, u.x, u.y, u.z, slender_of(s), zero};
        tl_f8 velocities[8] = {v[0], v[1], v[2], u.x, u.y, u.z, in[0], one};
        tl_f8 pushes[8] = {zero, zero, zero, zero, zero, zero, in[0], one};
        tl_f8 frames[8] = {frame.x, frame.y, frame.z, frame.w, s.x, s.y, s.z, tl_f8_and_mask(gyro, one)};
        tl_f8 forces[8] = {tl_f8_mul(tl_f8_set1(g.x), falls),
                           tl_f8_mul(tl_f8_set1(g.y), falls),
                           tl_f8_mul(tl_f8_set1(g.z), falls),
                           zero,
                           zero,
                           zero,
                           damping_of(step, in[5]),
                           damping_of(step, in[6])};
        store_eight(tl_row_pose(h) + i, p);
        store_eight(tl_row_momentum(h) + i, momentum);
        store_eight(tl_row_velocity(h) + i, velocities);
        store_eight(tl_row_push(h) + i, pushes);
        memcpy(tl_row_before(h) + i, tl_row_push(h) + i, TL_LANES * sizeof(tl_row8));
        memset(tl_row_moved(h) + i, 0, TL_LANES * sizeof(tl_row8));
        store_eight(tl_row_frame(h) + i, frames);
        store_eight(tl_row_force(h) + i, forces);
    }
}
