/* Commit, eight rows at a time: what the sub-steps made of the awake bodies goes back to the state, with the count of
 * how far each one moved. */
#include <string.h>

/* What goes back of eight rows. */
typedef struct commit_rows {
    tl_row8 pose[TL_LANES], velocity[TL_LANES], momentum[TL_LANES];
    float way[TL_LANES]; /* m, of the body's farthest point, at most */
} commit_rows;

/* Micrometres, rounded up, so that what creeps is seen in the end. */
static uint32_t micrometres(float way) { return way > 0.0f ? 1u + (uint32_t)tl_min(way * 1e6f, 1e9f) : 0u; }

/* The bodies of eight rows; of row 0 and of rows that are not in use it is 0. */
static inline uint32_t bodies_of(const tl_header *h, uint32_t first, uint32_t body[TL_LANES]) {
    uint32_t used = 0;
    for (uint32_t k = 0; k < TL_LANES; k++) {
        uint32_t row = first + k, in_use = row > 0 && row <= h->awake_bodies;
        body[k] = in_use ? tl_awake_body(h)[row - 1u] : 0u;
        used |= in_use << k;
    }
    return used;
}

/* In free flight the sub-steps' sum is ahead of the parabola by a h dt / 2; a body that nothing held gives that back.
 */
static inline void fall_exactly(const tl_step *step, uint32_t first, const tl_f8 moved[8], tl_f8 pose[8]) {
    tl_m8 freed = tl_f8_eq(moved[7], tl_f8_zero());
    tl_f8 force[8], share = tl_f8_set1(0.5f * step->sub * step->dt);
    if (!tl_m8_any(freed)) {
        return;
    }
    load_eight(tl_row_force(step->h) + first, force);
    for (uint32_t k = 0; k < 3u; k++) {
        uint32_t locked = 0;
        for (uint32_t lane = 0; lane < TL_LANES && step->any_locks; lane++) {
            locked |= ((uint32_t)tl_row_moved(step->h)[first + lane].f[6] >> k & 1u) << lane;
        }
        tl_m8 falls = tl_m8_andnot(tl_m8_from_bits(locked), freed);
        pose[k] = tl_f8_select(falls, tl_f8_sub(pose[k], tl_f8_mul(share, force[k])), pose[k]);
    }
}

/* The angular momentum to go on from, and the spin that it means at the new pose. */
static inline v8 keep_momentum(const tl_step *step, uint32_t first, const tl_f8 v[8], const tl_f8 f[8],
                               const tl_f8 inertia[8], q8 q, v8 *w) {
    tl_f8 m[8];
    load_eight(tl_row_momentum(step->h) + first, m);
    v8 gain = v8_sub(v8_of(v[3], v[4], v[5]), v8_of(m[3], m[4], m[5]));
    gain = v8_of(tl_f8_div(gain.x, f[4]), tl_f8_div(gain.y, f[5]), tl_f8_div(gain.z, f[6]));
    v8 l = v8_add(v8_of(m[0], m[1], m[2]), q8_rotate(q8_of(f[0], f[1], f[2], f[3]), gain));
    v8 own = q8_rotate_back(q, l), s = v8_of(inertia[1], inertia[2], inertia[3]);
    *w = q8_rotate(q, v8_mul(v8_mul(own, s), s));
    return l;
}

/* Whether all is finite: the difference of each number to itself is nothing. */
static inline tl_m8 are_sound(const tl_f8 pose[8], const tl_f8 v[3], v8 w) {
    tl_f8 sum = tl_f8_zero();
    const tl_f8 spin[3] = {w.x, w.y, w.z};
    for (int k = 0; k < 7; k++) {
        sum = tl_f8_add(sum, tl_f8_sub(pose[k], pose[k]));
    }
    for (int k = 0; k < 3; k++) {
        sum = tl_f8_add(sum, tl_f8_add(tl_f8_sub(v[k], v[k]), tl_f8_sub(spin[k], spin[k])));
    }
    return tl_f8_eq(sum, tl_f8_zero());
}

static inline tl_f8 way_between(const tl_f8 before[8], const tl_f8 now[8], tl_f8 reach) {
    v8 way = v8_sub(v8_of(now[0], now[1], now[2]), v8_of(before[0], before[1], before[2]));
    q8 turn =
        q8_mul(q8_of(now[3], now[4], now[5], now[6]), q8_conjugate(q8_of(before[3], before[4], before[5], before[6])));
    v8 axis = v8_of(turn.x, turn.y, turn.z);
    tl_f8 sine = tl_f8_sqrt(v8_dot(axis, axis)); /* of half the angle */
    return tl_f8_mad(tl_f8_sqrt(v8_dot(way, way)), tl_f8_mul(tl_f8_set1(2.0f), reach), sine);
}

/* Fills in what goes back of the rows from `first` on; returns bits of those that are sound. */
static inline uint32_t commit_eight(const tl_step *step, uint32_t first, const uint32_t body[TL_LANES],
                                    commit_rows *out) {
    const tl_header *h = step->h;
    tl_f8 p[8], v[8], f[8], moved[8], before[8], inertia[8], zero = tl_f8_zero();
    load_eight(tl_row_pose(h) + first, p);
    load_eight(tl_row_velocity(h) + first, v);
    load_eight(tl_row_frame(h) + first, f);
    load_eight(tl_row_moved(h) + first, moved);
    tl_f8_load_rows(tl_body_pose(h)->f, body, before);
    tl_f8_load_rows(&tl_body_inertias(h)->inverse_mass, body, inertia);
    tl_m8 gyro = tl_f8_gt(f[7], zero);
    v8 w = q8_rotate(q8_of(f[0], f[1], f[2], f[3]), v8_mul(v8_of(v[3], v[4], v[5]), v8_of(f[4], f[5], f[6])));
    v8 l = v8_zero();
    if (tl_m8_any(gyro)) {
        v8 spin, kept = keep_momentum(step, first, v, f, inertia, q8_of(p[3], p[4], p[5], p[6]), &spin);
        w = v8_select(gyro, spin, w);
        l = v8_select(gyro, kept, l);
    }
    fall_exactly(step, first, moved, p);
    tl_f8_storeu(out->way, way_between(before, p, inertia[7]));
    uint32_t sound = tl_m8_bits(are_sound(p, v, w));
    tl_f8 velocity[8] = {v[0], v[1], v[2], w.x, w.y, w.z, zero, zero};
    tl_f8 momentum[8] = {l.x, l.y, l.z, zero, zero, zero, zero, tl_f8_and_mask(gyro, tl_f8_set1(1.0f))};
    p[7] = zero;
    store_eight(out->pose, p);
    store_eight(out->velocity, velocity);
    store_eight(out->momentum, momentum);
    return sound;
}

static void commit(const tl_step *step, uint32_t first, uint32_t last) {
    tl_header *h = step->h;
    union {
        commit_rows rows;
        tl_f8 aligns; /* unused: it puts the rows where lanes can be stored to */
    } out;
    for (uint32_t i = first; i < last; i += TL_LANES) {
        uint32_t body[TL_LANES], used = bodies_of(h, i, body);
        uint32_t sound = commit_eight(step, i, body, &out.rows);
        for (uint32_t k = 0; k < TL_LANES; k++) {
            if (!(used >> k & 1u)) {
                continue;
            }
            uint32_t b = body[k];
            tl_body_previous(h)[b] = tl_body_pose(h)[b];
            if (sound >> k & 1u) {
                tl_body_motion(h)[b] += micrometres(out.rows.way[k]);
                tl_body_pose(h)[b] = out.rows.pose[k];
                tl_body_velocity(h)[b] = out.rows.velocity[k];
                tl_body_momentum(h)[b] = out.rows.momentum[k];
            } else { /* numbers beyond what floats hold: the body stops where it was */
                memset(&tl_body_velocity(h)[b], 0, sizeof(tl_row8));
                memset(&tl_body_momentum(h)[b], 0, sizeof(tl_row8));
            }
            if (tl_bodies(h)[b].flags & TL_BODY_FORCE) {
                memset(&tl_body_force(h)[b], 0, sizeof(tl_row8));
                tl_bodies(h)[b].flags &= ~(uint32_t)TL_BODY_FORCE;
            }
        }
    }
}
