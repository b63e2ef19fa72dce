/* Bodies: making, ending, moving, pushing. */
#include "talus/body.h"
#include "talus/loop.h"

#include <string.h>

#include "base/trig.h"
#include "stage/broad/refit.h"
#include "stage/island/islands.h"
#include "world/command.h"
#include "world/world_internal.h"

talus_body_def talus_body_def_default(void) {
    talus_body_def def;
    memset(&def, 0, sizeof def);
    def.pose = tl_pose_identity();
    def.gravity_scale = 1.0f;
    def.can_sleep = 1;
    return def;
}

static talus_status check_def(const talus_body_def *d) {
    if ((unsigned)d->type >= TALUS_BODY_TYPE_COUNT || d->locks > 63u) {
        return TALUS_BAD_ARGUMENT;
    }
    if (!tl_is_finite3(d->linear_velocity) || !tl_is_finite3(d->angular_velocity) || !tl_is_finite(d->linear_damping) ||
        !tl_is_finite(d->angular_damping) || !tl_is_finite(d->gravity_scale)) {
        return TALUS_NOT_FINITE;
    }
    return d->linear_damping >= 0.0f && d->angular_damping >= 0.0f ? tl_check_pose(&d->pose) : TALUS_BAD_ARGUMENT;
}

static int is_zero(talus_vec3 v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

/* Wakes a body with what it fell asleep with, and what lies on it if it is not dynamic. */
static void wake_around(tl_header *h, uint32_t i) {
    tl_island_wake(h, i);
    const tl_pair_link *links = tl_pair_links(h);
    for (uint32_t l = tl_body_links(h)[i].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        const tl_pair *p = &tl_pairs(h)[l >> 1];
        if (p->contact != TL_NONE) {
            tl_island_wake(h, p->body_a == i ? p->body_b : p->body_a);
        }
    }
}

/* A kinematic body is awake while its velocity is not zero. */
static void note_kinematic(tl_header *h, uint32_t i) {
    const tl_row8 *v = &tl_body_velocity(h)[i];
    int moves = !is_zero(tl_row_xyz(v)) || !is_zero(tl_row_345(v));
    tl_bodies(h)[i].moves = (uint32_t)moves;
    if (!moves) {
        return; /* the sleep stage takes it out */
    }
    tl_body_set_awake(h, i);
    tl_contacts_refresh(h, i); /* their points were in the world and are on the body from now on */
    wake_around(h, i);
    const tl_joint_record *joints = tl_joints(h);
    for (uint32_t l = tl_bodies(h)[i].first_joint; l != TL_NONE; l = joints[l >> 1].next[l & 1u]) {
        tl_island_wake(h, joints[l >> 1].body_a == i ? joints[l >> 1].body_b : joints[l >> 1].body_a);
    }
}

talus_status tl_run_body_create(talus_world *world, uint32_t i, talus_command *c) {
    const talus_body_def *def = &c->as.body;
    talus_status status = check_def(def);
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    i = tl_pool_top(&h->bodies, h->capacity[TL_COUNT_BODY]);
    if (i == TL_NONE) {
        return TALUS_FULL_BODIES;
    }
    tl_body_meta *meta = &tl_bodies(h)[i];
    tl_pool_take(&h->bodies, i, meta->free_next);
    uint32_t generation = tl_next_generation(meta->generation);
    memset(meta, 0, sizeof *meta);
    meta->generation = generation;
    meta->flags =
        (uint32_t)def->type | TL_BODY_ALIVE | (def->can_sleep ? TL_BODY_CAN_SLEEP : 0u) | def->locks << TL_BODY_LOCKS;
    meta->first_shape = meta->first_joint = meta->island = meta->free_next = TL_NONE;
    tl_body_links(h)[i].first_pair = tl_body_links(h)[i].sleep_next = TL_NONE;
    talus_pose pose = {def->pose.position, tl_quat_normalize(def->pose.rotation)};
    memset(&tl_body_pose(h)[i], 0, sizeof(tl_row8));
    memset(&tl_body_frame(h)[i], 0, sizeof(tl_row8));
    memset(&tl_body_velocity(h)[i], 0, sizeof(tl_row8));
    memset(&tl_body_force(h)[i], 0, sizeof(tl_row8));
    memset(&tl_body_momentum(h)[i], 0, sizeof(tl_row8));
    memset(&tl_body_quiets(h)[i], 0, sizeof(tl_body_quiet));
    memset(&tl_body_efforts(h)[i], 0, sizeof(tl_body_effort));
    tl_row_set_pose(&tl_body_pose(h)[i], &pose);
    tl_body_previous(h)[i] = tl_body_pose(h)[i];
    tl_body_frame(h)[i].f[6] = 1.0f;
    if (def->type != TALUS_STATIC) {
        tl_row_set6(&tl_body_velocity(h)[i], def->linear_velocity, def->angular_velocity);
    }
    tl_body_motion(h)[i] = 0;
    tl_body_colors(h)[i] = 0;
    tl_body_user(h)[i] = def->user_data;
    tl_body_row(h)[i] = tl_body_way(h)[i] = 0;
    tl_body_inertia *in = &tl_body_inertias(h)[i];
    memset(in, 0, sizeof *in);
    in->gravity_scale = def->gravity_scale;
    in->linear_damping = def->linear_damping, in->angular_damping = def->angular_damping;
    tl_body_update_mass(world, i);
    if (def->type == TALUS_DYNAMIC && !(def->starts_asleep && def->can_sleep)) {
        tl_body_set_awake(h, i);
    } else if (def->type == TALUS_DYNAMIC) {
        tl_body_fall_asleep(h, i, i);
        memset(&tl_body_velocity(h)[i], 0, sizeof(tl_row8));
    } else if (def->type == TALUS_KINEMATIC) {
        note_kinematic(h, i);
    }
    c->index = i, c->generation = generation;
    return TALUS_OK;
}

talus_status tl_run_body_destroy(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    if (i == 0) {
        return TALUS_BAD_ARGUMENT; /* the ground stays */
    }
    tl_header *h = tl_header_of(world);
    tl_body_meta *meta = &tl_bodies(h)[i];
    tl_island_wake(h, i);
    while (meta->first_joint != TL_NONE) {
        tl_joint_remove(h, meta->first_joint >> 1);
    }
    while (meta->first_shape != TL_NONE) {
        tl_shape_remove(h, meta->first_shape);
    }
    tl_body_clear_awake(h, i);
    uint32_t generation = meta->generation;
    memset(meta, 0, sizeof *meta);
    meta->generation = generation;
    meta->free_next = h->bodies.free;
    h->bodies.free = i;
    h->bodies.used--;
    return TALUS_OK;
}

int talus_body_is_valid(const talus_world *world, talus_body body) {
    uint32_t i;
    return tl_find_body(world, body, &i) == TALUS_OK;
}

talus_pose tl_body_origin(const tl_header *h, uint32_t body) {
    const tl_row8 *row = &tl_body_pose(h)[body], *frame = &tl_body_frame(h)[body];
    talus_pose p;
    p.rotation = tl_quat_mul(tl_row_quat(row), tl_quat_conjugate(tl_row_quat(frame)));
    p.position = tl_sub(tl_row_xyz(row), tl_rotate(p.rotation, tl_row_xyz(frame)));
    return p;
}

talus_status talus_body_get_pose(const talus_world *world, talus_body body, talus_pose *out) {
    uint32_t i;
    talus_status status = out ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_body_origin(tl_header_of(world), i);
    }
    return status;
}

talus_status talus_body_get_interpolated_pose(const talus_world *world, talus_body body, float alpha, talus_pose *out) {
    uint32_t i;
    talus_status status = out ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    if (!(alpha >= 0.0f && alpha <= 1.0f)) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    const tl_row8 *now = &tl_body_pose(h)[i], *before = tl_body_row(h)[i] ? &tl_body_previous(h)[i] : now;
    talus_quat a = tl_row_quat(before), b = tl_row_quat(now);
    float cosine = tl_quat_dot(a, b), sign = cosine < 0.0f ? -1.0f : 1.0f;
    cosine = tl_min(cosine * sign, 1.0f);
    float wa = 1.0f - alpha, wb = alpha;
    if (cosine < 0.9999f) { /* the arc: Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985 */
        float angle = tl_acos(cosine), sine = tl_sin(angle);
        wa = tl_sin(wa * angle) / sine, wb = tl_sin(wb * angle) / sine;
    }
    wb *= sign;
    talus_quat q = {wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
    q = tl_quat_normalize(q);
    talus_vec3 center = tl_mad(tl_row_xyz(before), alpha, tl_sub(tl_row_xyz(now), tl_row_xyz(before)));
    const tl_row8 *frame = &tl_body_frame(h)[i];
    out->rotation = tl_quat_mul(q, tl_quat_conjugate(tl_row_quat(frame)));
    out->position = tl_sub(center, tl_rotate(out->rotation, tl_row_xyz(frame)));
    return TALUS_OK;
}

talus_status tl_run_body_set_pose(talus_world *world, uint32_t i, talus_command *c) {
    const talus_pose *pose = &c->as.pose;
    talus_status status = tl_check_pose(pose);
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    wake_around(h, i);
    talus_pose origin = {pose->position, tl_quat_normalize(pose->rotation)};
    talus_pose frame = tl_row_pose_of(&tl_body_frame(h)[i]);
    talus_pose place = tl_pose_mul(&origin, &frame);
    place.rotation = tl_quat_normalize(place.rotation);
    tl_row_set_pose(&tl_body_pose(h)[i], &place);
    memset(&tl_body_momentum(h)[i], 0, sizeof(tl_row8));
    tl_body_previous(h)[i] = tl_body_pose(h)[i];
    tl_contacts_refresh(h, i);
    for (uint32_t s = tl_bodies(h)[i].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
        tl_shape_mark_moved(h, s);
    }
    return TALUS_OK;
}

static talus_status set_velocity(tl_header *h, uint32_t i, talus_vec3 linear, talus_vec3 angular) {
    if (!tl_is_finite3(linear) || !tl_is_finite3(angular)) {
        return TALUS_NOT_FINITE;
    }
    uint32_t type = tl_body_type(&tl_bodies(h)[i]);
    if (type == TALUS_STATIC) {
        return TALUS_BAD_ARGUMENT;
    }
    memset(&tl_body_momentum(h)[i], 0, sizeof(tl_row8));
    tl_row_set6(&tl_body_velocity(h)[i], linear, angular);
    if (type == TALUS_KINEMATIC) {
        note_kinematic(h, i);
    } else {
        tl_island_wake(h, i);
        tl_row_set6(&tl_body_velocity(h)[i], linear, angular);
    }
    return TALUS_OK;
}

talus_status tl_run_body_set_velocity(talus_world *world, uint32_t i, talus_command *c) {
    return set_velocity(tl_header_of(world), i, c->as.push.linear, c->as.push.angular);
}

talus_status tl_run_body_move_to(talus_world *world, uint32_t i, talus_command *c) {
    const talus_pose *pose = &c->as.move.pose;
    float dt = c->as.move.dt;
    tl_header *h = tl_header_of(world);
    if (tl_body_type(&tl_bodies(h)[i]) != TALUS_KINEMATIC || !(dt > 0.0f && dt <= 1.0f)) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = tl_check_pose(pose);
    if (status != TALUS_OK) {
        return status;
    }
    talus_pose origin = {pose->position, tl_quat_normalize(pose->rotation)};
    talus_pose frame = tl_row_pose_of(&tl_body_frame(h)[i]), goal = tl_pose_mul(&origin, &frame);
    talus_quat turn = tl_quat_mul(goal.rotation, tl_quat_conjugate(tl_row_quat(&tl_body_pose(h)[i])));
    if (turn.w < 0.0f) {
        turn.x = -turn.x, turn.y = -turn.y, turn.z = -turn.z, turn.w = -turn.w;
    }
    talus_vec3 axis = tl_v(turn.x, turn.y, turn.z);
    float sine = tl_length(axis);
    float rate = sine > 1e-9f ? 2.0f * tl_atan2(sine, turn.w) / (sine * dt) : 2.0f / dt;
    talus_vec3 way = tl_sub(goal.position, tl_row_xyz(&tl_body_pose(h)[i]));
    return set_velocity(h, i, tl_scale(way, 1.0f / dt), tl_scale(axis, rate));
}

talus_status talus_body_get_velocity(const talus_world *world, talus_body body, talus_vec3 *linear,
                                     talus_vec3 *angular) {
    uint32_t i;
    talus_status status = linear && angular ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        const tl_row8 *v = &tl_body_velocity(tl_header_of(world))[i];
        *linear = tl_row_xyz(v);
        *angular = tl_row_345(v);
    }
    return status;
}

static talus_status add_force(talus_world *world, uint32_t i, talus_vec3 force, const talus_vec3 *at,
                              talus_vec3 torque) {
    if (!tl_is_finite3(force) || !tl_is_finite3(torque) || (at && !tl_is_finite3(*at))) {
        return TALUS_NOT_FINITE;
    }
    tl_header *h = tl_header_of(world);
    if (!tl_body_is_dynamic(h, i)) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_row8 *f = &tl_body_force(h)[i];
    if (at) {
        torque = tl_add(torque, tl_cross(tl_sub(*at, tl_row_xyz(&tl_body_pose(h)[i])), force));
    }
    force = tl_add(tl_row_xyz(f), force), torque = tl_add(tl_row_345(f), torque);
    if (!tl_is_finite3(force) || !tl_is_finite3(torque)) {
        return TALUS_NOT_FINITE;
    }
    tl_island_wake(h, i);
    tl_row_set6(f, force, torque);
    tl_bodies(h)[i].flags |= TL_BODY_FORCE;
    return TALUS_OK;
}

talus_status tl_run_body_apply_force(talus_world *world, uint32_t i, talus_command *c) {
    return add_force(world, i, c->as.push.linear, &c->as.push.at, tl_v(0.0f, 0.0f, 0.0f));
}

talus_status tl_run_body_apply_torque(talus_world *world, uint32_t i, talus_command *c) {
    return add_force(world, i, tl_v(0.0f, 0.0f, 0.0f), NULL, c->as.push.angular);
}

/* I^-1 x in world axes. */
static talus_vec3 inverse_inertia_times(const tl_header *h, uint32_t i, talus_vec3 x) {
    const float *s = tl_body_inertias(h)[i].s;
    talus_quat q = tl_row_quat(&tl_body_pose(h)[i]);
    talus_vec3 own = tl_rotate_back(q, x);
    return tl_rotate(q, tl_v(own.x * s[0] * s[0], own.y * s[1] * s[1], own.z * s[2] * s[2]));
}

static talus_status add_impulse(talus_world *world, uint32_t i, talus_vec3 impulse, const talus_vec3 *at,
                                talus_vec3 angular) {
    if (!tl_is_finite3(impulse) || !tl_is_finite3(angular) || (at && !tl_is_finite3(*at))) {
        return TALUS_NOT_FINITE;
    }
    tl_header *h = tl_header_of(world);
    if (!tl_body_is_dynamic(h, i)) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_row8 *v = &tl_body_velocity(h)[i];
    if (at) {
        angular = tl_add(angular, tl_cross(tl_sub(*at, tl_row_xyz(&tl_body_pose(h)[i])), impulse));
    }
    talus_vec3 linear = tl_mad(tl_row_xyz(v), tl_body_inertias(h)[i].inverse_mass, impulse);
    talus_vec3 spin = tl_add(tl_row_345(v), inverse_inertia_times(h, i, angular));
    if (!tl_is_finite3(linear) || !tl_is_finite3(spin)) {
        return TALUS_NOT_FINITE;
    }
    tl_island_wake(h, i);
    memset(&tl_body_momentum(h)[i], 0, sizeof(tl_row8));
    tl_row_set6(v, linear, spin);
    return TALUS_OK;
}

talus_status tl_run_body_apply_impulse(talus_world *world, uint32_t i, talus_command *c) {
    return add_impulse(world, i, c->as.push.linear, &c->as.push.at, tl_v(0.0f, 0.0f, 0.0f));
}

talus_status tl_run_body_apply_angular_impulse(talus_world *world, uint32_t i, talus_command *c) {
    return add_impulse(world, i, tl_v(0.0f, 0.0f, 0.0f), NULL, c->as.push.angular);
}

talus_status tl_run_body_set_damping(talus_world *world, uint32_t i, talus_command *c) {
    float linear = c->as.damping.linear, angular = c->as.damping.angular;
    if (!tl_is_finite(linear) || !tl_is_finite(angular)) {
        return TALUS_NOT_FINITE;
    }
    if (linear < 0.0f || angular < 0.0f) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_body_inertia *in = &tl_body_inertias(tl_header_of(world))[i];
    in->linear_damping = linear, in->angular_damping = angular;
    return TALUS_OK;
}

talus_status tl_run_body_set_gravity_scale(talus_world *world, uint32_t i, talus_command *c) {
    if (!tl_is_finite(c->as.gravity_scale)) {
        return TALUS_NOT_FINITE;
    }
    tl_body_inertias(tl_header_of(world))[i].gravity_scale = c->as.gravity_scale;
    tl_island_wake(tl_header_of(world), i);
    return TALUS_OK;
}

talus_status tl_run_body_set_locks(talus_world *world, uint32_t i, talus_command *c) {
    if (c->as.locks > 63u) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_header *h = tl_header_of(world);
    tl_body_meta *meta = &tl_bodies(h)[i];
    meta->flags = (meta->flags & ((1u << TL_BODY_LOCKS) - 1u)) | c->as.locks << TL_BODY_LOCKS;
    tl_island_wake(h, i);
    return TALUS_OK;
}

talus_status talus_body_get_type(const talus_world *world, talus_body body, talus_body_type *out) {
    uint32_t i;
    talus_status status = out ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = (talus_body_type)tl_body_type(&tl_bodies(tl_header_of(world))[i]);
    }
    return status;
}

talus_status talus_body_get_user_data(const talus_world *world, talus_body body, uint64_t *out) {
    uint32_t i;
    talus_status status = out ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_body_user(tl_header_of(world))[i];
    }
    return status;
}

int talus_body_is_awake(const talus_world *world, talus_body body) {
    uint32_t i;
    return tl_find_body(world, body, &i) == TALUS_OK && tl_body_row(tl_header_of(world))[i] != 0;
}

talus_status tl_run_body_wake(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    tl_island_wake(tl_header_of(world), i);
    return TALUS_OK;
}

talus_status tl_run_body_sleep(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    tl_header *h = tl_header_of(world);
    if (!tl_body_is_dynamic(h, i)) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_island_sleep(h, i);
    return TALUS_OK;
}
