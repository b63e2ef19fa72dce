/* Joints: making, ending, drives. A definition is compiled into a list of rows that the solver runs through. */
#include "talus/joint.h"

#include <string.h>

#include "base/trig.h"
#include "stage/stages.h"
#include "world/command.h"
#include "world/world_internal.h"

#define FAR 3.0e38f /* an open side of a range */

talus_joint_def talus_joint_def_default(void) {
    talus_joint_def def;
    memset(&def, 0, sizeof def);
    def.frame_a = def.frame_b = tl_pose_identity();
    def.cone_axis = -1;
    return def;
}

static void lock(talus_axis *axes, int first) {
    for (int k = first; k < 3; k++) {
        memset(&axes[k], 0, sizeof axes[k]);
        axes[k].mode = TALUS_AXIS_LOCKED;
    }
}

void talus_joint_make_fixed(talus_joint_def *def) {
    lock(def->linear, 0);
    lock(def->angular, 0);
}

void talus_joint_make_ball(talus_joint_def *def) { lock(def->linear, 0); }

void talus_joint_make_revolute(talus_joint_def *def) {
    lock(def->linear, 0);
    lock(def->angular, 1);
}

void talus_joint_make_prismatic(talus_joint_def *def) {
    lock(def->linear, 1);
    lock(def->angular, 0);
}

void talus_joint_make_distance(talus_joint_def *def, float lower, float upper) {
    def->distance_enabled = 1;
    def->distance_lower = lower;
    def->distance_upper = upper;
}

/* --- checks ----------------------------------------------------------------------------------- */

static talus_status check_range(float lower, float upper, float stiffness, float damping) {
    if (lower != lower || upper != upper || !tl_is_finite(stiffness) || !tl_is_finite(damping)) {
        return TALUS_NOT_FINITE;
    }
    return lower <= upper && stiffness >= 0.0f && damping >= 0.0f ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

static talus_status check_axis(const talus_axis *a) {
    if ((unsigned)a->mode >= TALUS_AXIS_MODE_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    if (a->mode == TALUS_AXIS_FREE) {
        return TALUS_OK;
    }
    if (a->mode == TALUS_AXIS_LOCKED && !tl_is_finite(a->lower)) {
        return TALUS_NOT_FINITE;
    }
    return check_range(a->lower, a->mode == TALUS_AXIS_LOCKED ? a->lower : a->upper, a->stiffness, a->damping);
}

static talus_status check_drive(const talus_drive *d) {
    if (!tl_is_finite(d->position_target) || !tl_is_finite(d->velocity_target) || !tl_is_finite(d->stiffness) ||
        !tl_is_finite(d->damping) || d->max_force != d->max_force) {
        return TALUS_NOT_FINITE;
    }
    return d->stiffness >= 0.0f && d->damping >= 0.0f ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

static talus_status check_def(const talus_joint_def *d) {
    if (!tl_is_finite(d->break_force) || !tl_is_finite(d->break_torque)) {
        return TALUS_NOT_FINITE;
    }
    talus_status status = tl_check_pose(&d->frame_a);
    if (status == TALUS_OK) {
        status = tl_check_pose(&d->frame_b);
    }
    for (int k = 0; k < 3 && status == TALUS_OK; k++) {
        const talus_status found[4] = {check_axis(&d->linear[k]), check_axis(&d->angular[k]),
                                       check_drive(&d->linear_drive[k]), check_drive(&d->angular_drive[k])};
        for (int i = 0; i < 4 && status == TALUS_OK; i++) {
            status = found[i];
        }
    }
    if (status == TALUS_OK && d->cone_axis >= 0 && d->cone_axis < 3) {
        status = check_range(0.0f, d->cone_angle, d->cone_stiffness, d->cone_damping);
    }
    if (status == TALUS_OK && d->distance_enabled) {
        status =
            check_range(tl_max(d->distance_lower, 0.0f), d->distance_upper, d->distance_stiffness, d->distance_damping);
    }
    return status;
}

/* --- compiling -------------------------------------------------------------------------------- */

static void add_row(tl_joint_record *j, uint32_t type, uint32_t mode, const tl_joint_param *param) {
    if (j->rows < TL_JOINT_ROWS) {
        j->code[j->rows] = type + TL_ROW_TYPES * mode;
        j->param[j->rows] = *param;
        j->rows++;
    }
}

static tl_joint_param range_param(float lower, float upper, float stiffness, float damping) {
    tl_joint_param p = {tl_max(lower, -FAR), tl_min(upper, FAR), stiffness, damping, 0.0f, FAR, 0.0f};
    return p;
}

static int is_locked(const tl_joint_axis_record *a) {
    return a->mode == TALUS_AXIS_LOCKED || (a->mode == TALUS_AXIS_LIMITED && a->lower == a->upper);
}
static int is_hard(const tl_joint_axis_record *a) { return a->stiffness == 0.0f && a->damping == 0.0f; }

/* The type of an angular axis' row: one of two locked axes is measured by the swing of the third. */
static uint32_t angular_type(const tl_joint_record *j, uint32_t k) {
    return j->free_axis != TL_NONE && j->free_axis != k ? TL_ROW_SWING + k : TL_ROW_ANGULAR + k;
}

static uint32_t axis_type(const tl_joint_record *j, uint32_t i) {
    return i < 3u ? TL_ROW_LINEAR + i : angular_type(j, i - 3u);
}

static int axis_counts(const tl_joint_record *j, uint32_t i) {
    if (i < 3u) {
        return !j->distance_enabled;
    }
    return j->cone_axis == TL_NONE || j->cone_axis == i - 3u;
}
int tl_joint_is_locked(const tl_joint_record *j, uint32_t i) { return axis_counts(j, i) && is_locked(&j->axis[i]); }

static void compile_equalities(tl_joint_record *j) {
    for (uint32_t i = 0; i < 6u; i++) {
        const tl_joint_axis_record *a = &j->axis[i];
        if (axis_counts(j, i) && is_locked(a) && is_hard(a)) {
            tl_joint_param p = range_param(a->lower, a->lower, 0.0f, 0.0f);
            add_row(j, axis_type(j, i), TL_ROW_EQUAL, &p);
        }
    }
    if (j->distance_enabled && j->distance_lower == j->distance_upper && j->distance_stiffness == 0.0f) {
        tl_joint_param p = range_param(j->distance_lower, j->distance_upper, 0.0f, 0.0f);
        add_row(j, TL_ROW_DISTANCE, TL_ROW_EQUAL, &p);
    }
    j->fixed = j->rows;
}

static void compile_ranges(tl_joint_record *j) {
    for (uint32_t i = 0; i < 6u; i++) {
        const tl_joint_axis_record *a = &j->axis[i];
        if (!axis_counts(j, i) || a->mode == TALUS_AXIS_FREE || (is_locked(a) && is_hard(a))) {
            continue;
        }
        tl_joint_param p =
            range_param(a->lower, a->mode == TALUS_AXIS_LOCKED ? a->lower : a->upper, a->stiffness, a->damping);
        add_row(j, axis_type(j, i), TL_ROW_RANGE, &p);
    }
    if (j->cone_axis != TL_NONE) {
        tl_joint_param p = range_param(-FAR, j->cone_angle, j->cone_stiffness, j->cone_damping);
        add_row(j, TL_ROW_CONE + j->cone_axis, TL_ROW_RANGE, &p);
    }
    if (j->distance_enabled && !(j->distance_lower == j->distance_upper && j->distance_stiffness == 0.0f)) {
        tl_joint_param p =
            range_param(j->distance_lower, j->distance_upper, j->distance_stiffness, j->distance_damping);
        add_row(j, TL_ROW_DISTANCE, TL_ROW_RANGE, &p);
    }
}

static void compile(tl_joint_record *j) {
    uint32_t locked = 0, open = 0;
    for (uint32_t k = 0; k < 3u; k++) {
        int fixed = is_locked(&j->axis[3u + k]) && axis_counts(j, 3u + k);
        locked += fixed ? 1u : 0u;
        open = fixed ? open : k;
    }
    j->free_axis = locked == 2u ? open : TL_NONE;
    j->rows = 0;
    memset(j->code, 0, sizeof j->code);
    memset(j->param, 0, sizeof j->param);
    compile_equalities(j);
    compile_ranges(j);
    for (uint32_t i = 0; i < 6u; i++) {
        const tl_joint_drive_record *d = &j->drive[i];
        if (d->enabled) {
            tl_joint_param p = {d->position,
                                d->position,
                                d->stiffness,
                                d->damping,
                                d->speed,
                                d->most > 0.0f ? d->most : FAR,
                                d->acceleration ? 1.0f : 0.0f};
            add_row(j, i < 3u ? TL_ROW_LINEAR + i : TL_ROW_ANGULAR + i - 3u, TL_ROW_DRIVE, &p);
        }
    }
}

/* --- records ---------------------------------------------------------------------------------- */

static tl_joint_axis_record store_axis(const talus_axis *a) {
    tl_joint_axis_record r = {(uint32_t)a->mode, a->lower, a->upper, a->stiffness, a->damping};
    return r;
}

static tl_joint_drive_record store_drive(const talus_drive *d) {
    tl_joint_drive_record r = {d->enabled ? 1u : 0u, d->acceleration ? 1u : 0u,
                               d->position_target,   d->velocity_target,
                               d->stiffness,         d->damping,
                               d->max_force};
    return r;
}

static void store_def(tl_joint_record *j, const talus_joint_def *d) {
    j->frame_a = d->frame_a, j->frame_b = d->frame_b;
    j->frame_a.rotation = tl_quat_normalize(d->frame_a.rotation);
    j->frame_b.rotation = tl_quat_normalize(d->frame_b.rotation);
    for (int k = 0; k < 3; k++) {
        j->axis[k] = store_axis(&d->linear[k]);
        j->axis[3 + k] = store_axis(&d->angular[k]);
        j->drive[k] = store_drive(&d->linear_drive[k]);
        j->drive[3 + k] = store_drive(&d->angular_drive[k]);
    }
    j->cone_axis = d->cone_axis >= 0 && d->cone_axis < 3 ? (uint32_t)d->cone_axis : TL_NONE;
    j->cone_angle = d->cone_angle;
    j->cone_stiffness = d->cone_stiffness, j->cone_damping = d->cone_damping;
    j->distance_enabled = d->distance_enabled ? 1u : 0u;
    j->distance_lower = tl_max(d->distance_lower, 0.0f), j->distance_upper = d->distance_upper;
    j->distance_stiffness = d->distance_stiffness, j->distance_damping = d->distance_damping;
    j->break_force = d->break_force, j->break_torque = d->break_torque;
}

void tl_joint_place(const tl_header *h, tl_joint_record *j) {
    talus_pose a = tl_row_pose_of(&tl_body_frame(h)[j->body_a]), b = tl_row_pose_of(&tl_body_frame(h)[j->body_b]);
    j->place_a = tl_pose_relative(&a, &j->frame_a);
    j->place_b = tl_pose_relative(&b, &j->frame_b);
}

/* A body's handle, where none means the ground. */
static talus_status find_end(const talus_world *world, talus_body body, uint32_t *index) {
    if (body.index == 0 && body.generation == 0) {
        *index = 0;
        return tl_world_is_sound(world) ? TALUS_OK : TALUS_BAD_ARGUMENT;
    }
    return tl_find_body(world, body, index);
}

/* Ends contacts that the new joint forbids. */
static void part(tl_header *h, uint32_t a, uint32_t b) {
    uint32_t count = tl_contacts_of(h, a, TL_NONE);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t c = tl_contact_order(h)[k];
        if (tl_contacts(h)[c].body_a == b || tl_contacts(h)[c].body_b == b) {
            tl_event_contact_end(h, c);
            tl_contact_end(h, c, 0);
        }
    }
    for (uint32_t l = tl_body_links(h)[a].first_pair; l != TL_NONE;) {
        uint32_t pair = l >> 1, next = tl_pair_links(h)[pair].next[l & 1u];
        if (tl_pairs(h)[pair].body_a == b || tl_pairs(h)[pair].body_b == b) {
            tl_pair_end(h, pair);
        }
        l = next;
    }
}

talus_status tl_run_joint_create(talus_world *world, uint32_t i, talus_command *c) {
    const talus_joint_def *def = &c->as.joint;
    uint32_t a, b;
    talus_status status = find_end(world, def->a, &a);
    if (status == TALUS_OK) {
        status = find_end(world, def->b, &b);
    }
    if (status == TALUS_OK) {
        status = check_def(def);
    }
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    if (a == b || (!tl_body_is_dynamic(h, a) && !tl_body_is_dynamic(h, b))) {
        return TALUS_BAD_ARGUMENT;
    }
    i = tl_pool_top(&h->joints, h->capacity[TL_COUNT_JOINT]);
    if (i == TL_NONE) {
        return TALUS_FULL_JOINTS;
    }
    tl_joint_record *j = &tl_joints(h)[i];
    tl_pool_take(&h->joints, i, j->free_next);
    uint32_t generation = tl_next_generation(j->generation);
    memset(j, 0, sizeof *j);
    memset(&tl_joint_states(h)[i], 0, sizeof(tl_joint_state));
    j->generation = generation;
    j->flags = TL_JOINT_ALIVE | (def->collide_connected ? TL_JOINT_COLLIDE : 0u);
    j->body_a = a, j->body_b = b;
    j->free_next = TL_NONE;
    tl_joint_user(h)[i] = def->user_data;
    store_def(j, def);
    compile(j);
    tl_joint_place(h, j);
    tl_island_wake(h, a);
    tl_island_wake(h, b);
    tl_joint_link(h, i);
    h->breaking_joints += j->break_force > 0.0f || j->break_torque > 0.0f;
    if (!def->collide_connected) {
        part(h, a == 0 ? b : a, a == 0 ? a : b);
    }
    c->index = i, c->generation = generation;
    return TALUS_OK;
}

talus_status tl_run_joint_destroy(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    tl_joint_remove(tl_header_of(world), i);
    return TALUS_OK;
}

int talus_joint_is_valid(const talus_world *world, talus_joint joint) {
    uint32_t i;
    return tl_find_joint(world, joint, &i) == TALUS_OK;
}

int tl_joint_is_compiled(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_joint_record *j = &tl_joints(h)[i];
    const talus_joint joint = {i, j->generation};
    talus_joint_def def;
    tl_joint_record again = *j;
    if (talus_joint_get_def(world, joint, &def) != TALUS_OK || check_def(&def) != TALUS_OK) {
        return 0;
    }
    compile(&again);
    tl_joint_place(h, &again);
    return memcmp(j, &again, sizeof again) == 0;
}

static talus_axis load_axis(const tl_joint_axis_record *r) {
    talus_axis a = {(talus_axis_mode)r->mode, r->lower, r->upper, r->stiffness, r->damping};
    return a;
}

static talus_drive load_drive(const tl_joint_drive_record *r) {
    talus_drive d = {
        (uint8_t)r->enabled, (uint8_t)r->acceleration, r->position, r->speed, r->stiffness, r->damping, r->most};
    return d;
}

talus_status talus_joint_get_def(const talus_world *world, talus_joint joint, talus_joint_def *out) {
    uint32_t i;
    talus_status status = out ? tl_find_joint(world, joint, &i) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    const tl_header *h = tl_header_of(world);
    const tl_joint_record *j = &tl_joints(h)[i];
    memset(out, 0, sizeof *out);
    out->a.index = j->body_a, out->a.generation = tl_bodies(h)[j->body_a].generation;
    out->b.index = j->body_b, out->b.generation = tl_bodies(h)[j->body_b].generation;
    out->frame_a = j->frame_a, out->frame_b = j->frame_b;
    for (int k = 0; k < 3; k++) {
        out->linear[k] = load_axis(&j->axis[k]);
        out->angular[k] = load_axis(&j->axis[3 + k]);
        out->linear_drive[k] = load_drive(&j->drive[k]);
        out->angular_drive[k] = load_drive(&j->drive[3 + k]);
    }
    out->cone_axis = j->cone_axis == TL_NONE ? -1 : (int32_t)j->cone_axis;
    out->cone_angle = j->cone_angle, out->cone_stiffness = j->cone_stiffness, out->cone_damping = j->cone_damping;
    out->distance_enabled = (uint8_t)j->distance_enabled;
    out->distance_lower = j->distance_lower, out->distance_upper = j->distance_upper;
    out->distance_stiffness = j->distance_stiffness, out->distance_damping = j->distance_damping;
    out->break_force = j->break_force, out->break_torque = j->break_torque;
    out->collide_connected = j->flags & TL_JOINT_COLLIDE ? 1 : 0;
    out->user_data = tl_joint_user(h)[i];
    return TALUS_OK;
}

talus_status tl_run_joint_set_drive(talus_world *world, uint32_t i, talus_command *c) {
    const talus_drive *drive = &c->as.drive.drive;
    uint32_t axis = c->as.drive.axis;
    talus_status status = axis < 6u ? check_drive(drive) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    tl_joint_record *j = &tl_joints(h)[i];
    int structure = j->drive[axis].enabled != (drive->enabled ? 1u : 0u);
    j->drive[axis] = store_drive(drive);
    compile(j);
    if (structure) { /* the rows are numbered anew: their impulses mean something else now */
        memset(&tl_joint_states(h)[i], 0, sizeof(tl_joint_state));
    }
    tl_island_wake(h, j->body_a);
    tl_island_wake(h, j->body_b);
    return TALUS_OK;
}

talus_status talus_joint_get_reaction(const talus_world *world, talus_joint joint, talus_vec3 *force,
                                      talus_vec3 *torque) {
    uint32_t i;
    talus_status status = force && torque ? tl_find_joint(world, joint, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        const tl_joint_state *s = &tl_joint_states(tl_header_of(world))[i];
        *force = tl_v(s->force[0], s->force[1], s->force[2]);
        *torque = tl_v(s->torque[0], s->torque[1], s->torque[2]);
    }
    return status;
}

talus_status talus_joint_get_error(const talus_world *world, talus_joint joint, float *linear, float *angular) {
    uint32_t i;
    talus_status status = linear && angular ? tl_find_joint(world, joint, &i) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    const tl_header *h = tl_header_of(world);
    const tl_joint_record *j = &tl_joints(h)[i];
    talus_pose a = tl_row_pose_of(&tl_body_pose(h)[j->body_a]), b = tl_row_pose_of(&tl_body_pose(h)[j->body_b]);
    a = tl_pose_mul(&a, &j->place_a);
    b = tl_pose_mul(&b, &j->place_b);
    talus_pose r = tl_pose_relative(&a, &b);
    const float shift[3] = {r.position.x, r.position.y, r.position.z};
    const float turn[3] = {r.rotation.x, r.rotation.y, r.rotation.z};
    float l2 = 0.0f, a2 = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        if (tl_joint_is_locked(j, k)) {
            float e = shift[k] - j->axis[k].lower;
            l2 += e * e;
        }
        if (tl_joint_is_locked(j, 3u + k)) {
            float e = 2.0f * tl_atan2(turn[k], tl_abs(r.rotation.w)) - j->axis[3u + k].lower;
            a2 += e * e;
        }
    }
    *linear = sqrtf(l2);
    *angular = sqrtf(a2);
    return TALUS_OK;
}
