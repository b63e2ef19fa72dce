/* Contacts in a plane, eight manifolds at a time: the passes of contacts.inl with what they have there, two speeds and
 * a spin of each body, the normals of one or two points and friction along one tangent. Speeds across the plane are
 * none, and what is stored of them is none. */

typedef struct flat_pair {
    tl_f8 ax, ay, au, bx, by, bu; /* velocities or ways of a and b along the two axes of the plane, whitened spins */
    tl_f8 ma, ta, mb, tb;
} flat_pair;

/* A row: a direction in the plane and the whitened angular Jacobians. */
typedef struct flat_row {
    tl_f8 x, y, ja, jb;
} flat_row;

TL_INLINE flat_pair load_flat(const float *rows, const tl_contact_group *g, uint32_t axis) {
    const uint32_t x = (axis + 1u) % 3u, y = (axis + 2u) % 3u;
    flat_pair p;
    tl_f8 r[8];
    tl_f8_load_rows(rows, g->a, r);
    p.ax = r[x], p.ay = r[y], p.au = r[3u + axis], p.ma = r[6], p.ta = r[7];
    tl_f8_load_rows(rows, g->b, r);
    p.bx = r[x], p.by = r[y], p.bu = r[3u + axis], p.mb = r[6], p.tb = r[7];
    return p;
}

TL_INLINE void store_flat(float *rows, const tl_contact_group *g, uint32_t axis, const flat_pair *p) {
    const uint32_t x = (axis + 1u) % 3u, y = (axis + 2u) % 3u;
    tl_f8 zero = tl_f8_zero(), r[8] = {zero, zero, zero, zero, zero, zero, p->ma, p->ta};
    r[x] = p->ax, r[y] = p->ay, r[3u + axis] = p->au;
    tl_f8_store_rows(rows, g->a, r);
    r[x] = p->bx, r[y] = p->by, r[3u + axis] = p->bu, r[6] = p->mb, r[7] = p->tb;
    tl_f8_store_rows(rows, g->b, r);
}

TL_INLINE flat_row flat_normal(const tl_contact_group *g, const tl_contact_lane_point *c, uint32_t axis) {
    return (flat_row){tl_f8_load(g->normal[(axis + 1u) % 3u]), tl_f8_load(g->normal[(axis + 2u) % 3u]),
                      tl_f8_load(c->ja[axis]), tl_f8_load(c->jb[axis])};
}

TL_INLINE flat_row flat_tangent(const tl_contact_group *g, uint32_t axis) {
    return (flat_row){tl_f8_load(g->tangent[(axis + 1u) % 3u]), tl_f8_load(g->tangent[(axis + 2u) % 3u]),
                      tl_f8_load(g->ja1[axis]), tl_f8_load(g->jb1[axis])};
}

/* Of b against a along a row. */
static inline tl_f8 flat_speed(const flat_pair *p, const flat_row *r) {
    tl_f8 way = tl_f8_mad(tl_f8_mul(r->x, tl_f8_sub(p->bx, p->ax)), r->y, tl_f8_sub(p->by, p->ay));
    return tl_f8_add(way, tl_f8_sub(tl_f8_mul(r->jb, p->bu), tl_f8_mul(r->ja, p->au)));
}

static inline void flat_apply(flat_pair *p, const flat_row *r, tl_f8 impulse) {
    tl_f8 a = tl_f8_mul(impulse, p->ma), b = tl_f8_mul(impulse, p->mb);
    p->ax = tl_f8_sub(p->ax, tl_f8_mul(a, r->x)), p->ay = tl_f8_sub(p->ay, tl_f8_mul(a, r->y));
    p->bx = tl_f8_mad(p->bx, b, r->x), p->by = tl_f8_mad(p->by, b, r->y);
    p->au = tl_f8_sub(p->au, tl_f8_mul(tl_f8_mul(impulse, p->ta), r->ja));
    p->bu = tl_f8_mad(p->bu, tl_f8_mul(impulse, p->tb), r->jb);
}

TL_INLINE void flat_normals(const tl_step *step, tl_contact_group *g, flat_pair *p, const flat_pair *moved,
                            uint32_t axis, int with_bias, int pressed) {
    tl_f8 zero = tl_f8_zero(), one = tl_f8_set1(1.0f), inverse_h = tl_f8_set1(step->inverse_sub);
    tl_f8 rate = tl_f8_set1(step->bias_rate), push = tl_f8_set1(-step->h->settings.push_speed);
    /* a_2 of set_softness */
    tl_f8 stiff = tl_f8_mul(tl_f8_load(g->stiff), tl_f8_set1(step->mass_scale / step->impulse_scale));
    tl_f8 soft_impulse = tl_f8_div(one, tl_f8_add(one, stiff)), soft_mass = tl_f8_mul(stiff, soft_impulse);
    tl_f8 over = with_bias ? one : tl_f8_load(g->over);
    tl_m8 hard = tl_m8_from_bits(pressed ? g->pressed : 0u);
    for (uint32_t i = 0; i < g->points; i++) {
        tl_contact_lane_point *c = &g->point[i];
        flat_row r = flat_normal(g, c, axis);
        tl_f8 gap = tl_f8_add(tl_f8_load(c->gap), flat_speed(moved, &r));
        gap = pressed ? tl_f8_select(hard, tl_f8_max(gap, zero), gap) : gap;
        tl_m8 apart = pressed ? tl_m8_or(hard, tl_f8_gt(gap, zero)) : tl_f8_gt(gap, zero);
        tl_f8 bias = tl_f8_and_mask(apart, tl_f8_mul(gap, inverse_h)), mass = tl_f8_mul(tl_f8_load(c->mass), over);
        tl_f8 old = tl_f8_load(c->impulse), now = old;
        if (with_bias) {
            gap = tl_f8_sub(gap, tl_f8_load(g->lift));
            bias = tl_f8_select(apart, bias, tl_f8_max(tl_f8_mul(gap, rate), push));
            mass = tl_f8_mul(mass, tl_f8_select(apart, one, soft_mass));
            now = tl_f8_sub(now, tl_f8_mul(tl_f8_select(apart, zero, soft_impulse), old));
        }
        now = tl_f8_sub(now, tl_f8_mul(mass, tl_f8_add(flat_speed(p, &r), bias)));
        now = tl_f8_max(now, zero);
        tl_f8_store(c->impulse, now);
        if (g->heard) {
            tl_f8_store(c->peak, tl_f8_max(tl_f8_load(c->peak), now));
        }
        flat_apply(p, &r, tl_f8_sub(now, old));
    }
}

/* m/s: the speed along the tangent at which what held is drawn back to where it was gripped. */
TL_INLINE tl_f8 flat_grip(const tl_step *step, const tl_contact_group *g, const flat_pair *moved, const flat_row *t) {
    return drawn_back(step, tl_f8_load(g->held), tl_f8_add(tl_f8_load(g->slid[0]), flat_speed(moved, t)));
}

TL_INLINE void flat_friction(tl_contact_group *g, flat_pair *p, const flat_row *t, tl_f8 back) {
    tl_f8 pressure = pressure_of(g), old = tl_f8_load(g->tangent_impulse[0]);
    tl_f8 now = tl_f8_sub(old, tl_f8_mul(tl_f8_load(g->k11), tl_f8_add(flat_speed(p, t), back)));
    tl_f8 hold = tl_f8_mul(tl_f8_load(g->static_friction), pressure);
    tl_f8 slide = tl_f8_mul(tl_f8_load(g->dynamic_friction), pressure);
    tl_f8 bound = tl_f8_max(tl_f8_min(now, slide), tl_f8_neg(slide));
    now = tl_f8_select(tl_f8_gt(tl_f8_abs(now), hold), bound, now);
    tl_f8_store(g->tangent_impulse[0], now);
    flat_apply(p, t, tl_f8_sub(now, old));
}

/* Resists rolling about the axis by at most the normal force times the rolling lever. */
TL_INLINE void flat_rolling(const tl_step *step, tl_contact_group *g, flat_pair *p, uint32_t axis) {
    const float *frames = tl_row_frame(step->h)->f;
    tl_f8 r[8], zero = tl_f8_zero(), most = tl_f8_mul(tl_f8_load(g->rolling), pressure_of(g));
    flat_row spin = {zero, zero, zero, zero};
    tl_f8_load_rows(frames, g->a, r);
    spin.ja = r[4u + axis];
    tl_f8_load_rows(frames, g->b, r);
    spin.jb = r[4u + axis];
    tl_f8 old = tl_f8_load(g->rolling_impulse[1]);
    tl_f8 now = tl_f8_sub(old, tl_f8_mul(tl_f8_load(g->roll_mass), flat_speed(p, &spin)));
    now = tl_f8_max(tl_f8_min(now, most), tl_f8_neg(most));
    tl_f8_store(g->rolling_impulse[1], now);
    flat_apply(p, &spin, tl_f8_sub(now, old));
}

TL_INLINE void solve_flat_group(const tl_step *step, tl_contact_group *g, uint32_t axis, int pressed) {
    flat_pair p = load_flat(tl_row_velocity(step->h)->f, g, axis), moved = load_flat(tl_row_moved(step->h)->f, g, axis);
    flat_normals(step, g, &p, &moved, axis, 1, pressed);
    if (g->rolls && step->first_substep) { /* there is no warm start of it */
        flat_rolling(step, g, &p, axis);
    }
    store_flat(tl_row_velocity(step->h)->f, g, axis, &p);
}

TL_INLINE void relax_flat_group(const tl_step *step, tl_contact_group *g, uint32_t axis) {
    flat_pair p = load_flat(tl_row_velocity(step->h)->f, g, axis), moved = load_flat(tl_row_moved(step->h)->f, g, axis);
    flat_row t = flat_tangent(g, axis);
    tl_f8 back = flat_grip(step, g, &moved, &t);
    flat_friction(g, &p, &t, back);
    flat_normals(step, g, &p, &moved, axis, 0, 0);
    flat_friction(g, &p, &t, back);
    if (g->rolls) {
        flat_rolling(step, g, &p, axis);
    }
    store_flat(tl_row_velocity(step->h)->f, g, axis, &p);
}

/* The axes of the rows are known to the compiler. */
static void solve_in_plane(const tl_step *step, tl_contact_group *g) {
    switch (g->plane * 2u + (g->pressed != 0)) {
    case 2:
        solve_flat_group(step, g, 0, 0);
        break;
    case 3:
        solve_flat_group(step, g, 0, 1);
        break;
    case 4:
        solve_flat_group(step, g, 1u, 0);
        break;
    case 5:
        solve_flat_group(step, g, 1u, 1);
        break;
    case 6:
        solve_flat_group(step, g, 2u, 0);
        break;
    default:
        solve_flat_group(step, g, 2u, 1);
        break;
    }
}

static void relax_in_plane(const tl_step *step, tl_contact_group *g) {
    switch (g->plane) {
    case 1:
        relax_flat_group(step, g, 0);
        break;
    case 2:
        relax_flat_group(step, g, 1u);
        break;
    default:
        relax_flat_group(step, g, 2u);
        break;
    }
}
