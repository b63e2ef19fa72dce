/* Commit: what the sub-steps made of the awake bodies goes back to the state, with the count of how far each one moved.
 */
#include <string.h>

#include "stage/stages.h"

/* Micrometres, rounded up, so that what creeps is seen in the end. */
static uint32_t micrometres(float way) { return way > 0.0f ? 1u + (uint32_t)tl_min(way * 1e6f, 1e9f) : 0u; }

/* The way of the body's farthest point, at most. */
static uint32_t motion_between(const tl_row8 *before, const tl_row8 *now, float reach) {
    talus_vec3 way = tl_sub(tl_row_xyz(now), tl_row_xyz(before));
    talus_quat turn = tl_quat_mul(tl_row_quat(now), tl_quat_conjugate(tl_row_quat(before)));
    float sine = sqrtf(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z); /* of half the angle */
    return micrometres(tl_length(way) + 2.0f * reach * sine);
}

static int is_sound(const tl_row8 *pose, const tl_row8 *velocity) {
    float sum = 0.0f;
    for (int k = 0; k < 7; k++) {
        sum += pose->f[k] - pose->f[k];
    }
    for (int k = 0; k < 6; k++) {
        sum += velocity->f[k] - velocity->f[k];
    }
    return sum == 0.0f;
}

/* In free flight the sub-steps' sum is ahead of the parabola by a h dt / 2; a body that nothing held gives that back.
 */
static void fall_exactly(const tl_step *step, uint32_t row, tl_row8 *pose) {
    if (tl_row_moved(step->h)[row].f[7] != 0.0f) {
        return;
    }
    const tl_row8 *f = &tl_row_force(step->h)[row];
    uint32_t locks = (uint32_t)tl_row_moved(step->h)[row].f[6];
    for (uint32_t k = 0; k < 3u; k++) {
        if (!(locks >> k & 1u)) {
            pose->f[k] -= 0.5f * step->sub * step->dt * f->f[k];
        }
    }
}

/* The angular momentum to go on from, and the spin in v that it means at the new pose; empty without a gyroscopic term.
 */
static tl_row8 kept_momentum(const tl_header *h, uint32_t body, uint32_t row, const tl_row8 *pose, tl_row8 *v) {
    const tl_row8 *rf = &tl_row_frame(h)[row], *m = &tl_row_momentum(h)[row], *rv = &tl_row_velocity(h)[row];
    tl_row8 kept;
    memset(&kept, 0, sizeof kept);
    if (!(rf->f[7] > 0.0f)) {
        return kept;
    }
    talus_quat frame = {rf->f[0], rf->f[1], rf->f[2], rf->f[3]}, q = tl_row_quat(pose);
    talus_vec3 gain = tl_sub(tl_row_345(rv), tl_row_345(m));
    gain = tl_v(gain.x / rf->f[4], gain.y / rf->f[5], gain.z / rf->f[6]);
    talus_vec3 l = tl_add(tl_row_xyz(m), tl_rotate(frame, gain)), own = tl_rotate_back(q, l);
    const float *s = tl_body_inertias(h)[body].s;
    talus_vec3 w = tl_rotate(q, tl_v(own.x * s[0] * s[0], own.y * s[1] * s[1], own.z * s[2] * s[2]));
    tl_row_set6(v, tl_row_xyz(v), w);
    tl_row_set6(&kept, l, tl_v(0.0f, 0.0f, 0.0f));
    kept.f[7] = 1.0f;
    return kept;
}

void tl_stage_commit(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t body = tl_awake_body(h)[k], row = k + 1u;
        tl_row8 *pose = &tl_body_pose(h)[body], *velocity = &tl_body_velocity(h)[body];
        tl_row8 next = tl_row_pose(h)[row], v;
        const tl_row8 *rv = &tl_row_velocity(h)[row], *rf = &tl_row_frame(h)[row];
        talus_quat frame = {rf->f[0], rf->f[1], rf->f[2], rf->f[3]};
        talus_vec3 u = tl_mul(tl_row_345(rv), tl_v(rf->f[4], rf->f[5], rf->f[6]));
        memset(&v, 0, sizeof v);
        tl_row_set6(&v, tl_row_xyz(rv), tl_rotate(frame, u));
        tl_row8 momentum = kept_momentum(h, body, row, &next, &v);
        next.f[7] = 0.0f;
        fall_exactly(step, row, &next);
        tl_body_previous(h)[body] = *pose;
        if (is_sound(&next, &v)) {
            tl_body_motion(h)[body] += motion_between(pose, &next, tl_body_inertias(h)[body].reach);
            *pose = next;
            *velocity = v;
            tl_body_momentum(h)[body] = momentum;
        } else { /* numbers beyond what floats hold: the body stops where it was */
            memset(velocity, 0, sizeof *velocity);
            memset(&tl_body_momentum(h)[body], 0, sizeof(tl_row8));
        }
        if (tl_bodies(h)[body].flags & TL_BODY_FORCE) {
            memset(&tl_body_force(h)[body], 0, sizeof(tl_row8));
            tl_bodies(h)[body].flags &= ~(uint32_t)TL_BODY_FORCE;
        }
    }
}
