/* Joints of KHR_physics_rigid_bodies: limits and drives into a talus_joint_def. */
#include "gltf/loader.h"

#include <string.h>

#define UNBOUNDED 1e9f /* m or rad: farther than anything goes */
#define PI 3.14159265358979323846

/* One entry of `limits`. */
typedef struct limit {
    int axes[3], count;
    int linear;
    double low, high;
    int soft;
    double stiffness, damping;
} limit;

static int read_axes(const gltf_at *at, const char *key, limit *out) {
    gltf_list list = gltf_list_open(at, key);
    int seen = 0;
    if (list.at.json != NULL && (list.count < 1 || list.count > 3)) {
        gltf_fail(&list.at, GLTF_BROKEN, "has %d axes, must have 1 to 3", list.count);
    }
    for (int i = 0; i < list.count && !gltf_failed(at); i++) {
        gltf_at item = gltf_list_item(&list, i);
        double axis = gltf_number_here(&item, 0, 2);
        if (axis != floor(axis) || (seen & 1 << (int)axis)) {
            gltf_fail(&item, GLTF_BROKEN, "is %g, must be 0, 1 or 2, each once", axis);
            break;
        }
        seen |= 1 << (int)axis;
        out->axes[i] = (int)axis;
    }
    out->count = list.count;
    int there = list.at.json != NULL;
    gltf_list_close(&list);
    return there;
}

static void read_limit(const gltf_at *at, limit *out) {
    memset(out, 0, sizeof *out);
    int angular = gltf_has(at, "angularAxes");
    out->linear = gltf_has(at, "linearAxes");
    if (out->linear + angular != 1) {
        gltf_fail(at, GLTF_BROKEN, "has %s of linearAxes and angularAxes, must have one", angular ? "both" : "none");
        return;
    }
    read_axes(at, out->linear ? "linearAxes" : "angularAxes", out);
    double bound = (double)UNBOUNDED;
    out->low = gltf_number(at, "min", -bound, -bound, bound);
    out->high = gltf_number(at, "max", bound, -bound, bound);
    out->soft = gltf_has(at, "stiffness");
    out->stiffness = gltf_number(at, "stiffness", 0, 0, 1e18);
    out->damping = gltf_number(at, "damping", 0, 0, 1e18);
    if (out->low > out->high) {
        gltf_fail(at, GLTF_BROKEN, "its min is %g and its max %g, min must not be greater", out->low, out->high);
    }
    if (out->count > 1 && out->high < 0) {
        gltf_fail(at, GLTF_BROKEN, "its max is %g, which no distance or angle can keep", out->high);
    }
    if (out->soft && out->stiffness < 1e-6) {
        out->stiffness = 1e-6; /* N/m: next to nothing, for 0 is a hard limit to the world */
    }
}

/* Whether the angle about an axis has no bound. */
static int is_open(const limit *l) {
    return l->linear ? l->low <= -(double)UNBOUNDED && l->high >= (double)UNBOUNDED : l->low <= -PI && l->high >= PI;
}

static void bound_axis(const gltf_at *at, talus_axis *axis, const limit *l) {
    float low = (float)l->low, high = (float)l->high;
    if (axis->mode != TALUS_AXIS_FREE) {
        if (l->soft || axis->stiffness > 0) {
            gltf_fail(at, GLTF_UNSUPPORTED, "a second limit of one axis where one of the two is soft");
            return;
        }
        low = low > axis->lower ? low : axis->lower;
        high = high < axis->upper ? high : axis->upper;
        if (low > high) {
            gltf_fail(at, GLTF_BROKEN, "leaves an axis no room beside an earlier limit of the same axis");
            return;
        }
    }
    axis->mode = low == high && !l->soft ? TALUS_AXIS_LOCKED : TALUS_AXIS_LIMITED;
    axis->lower = low;
    axis->upper = high;
    if (l->soft) {
        axis->stiffness = (float)l->stiffness;
        axis->damping = (float)l->damping;
    }
}

static void bound_distance(const gltf_at *at, talus_joint_def *def, const limit *l) {
    if (def->distance_enabled) {
        gltf_fail(at, GLTF_UNSUPPORTED, "a second limit of the distance of the two pivots");
        return;
    }
    def->distance_enabled = 1;
    def->distance_lower = l->low > 0 ? (float)l->low : 0.0f;
    def->distance_upper = (float)l->high;
    def->distance_stiffness = l->soft ? (float)l->stiffness : 0.0f;
    def->distance_damping = l->soft ? (float)l->damping : 0.0f;
}

static void bound_cone(const gltf_at *at, talus_joint_def *def, const limit *l) {
    if (l->low > 0) {
        gltf_fail(at, GLTF_UNSUPPORTED, "a cone with a min of %g: it must be 0 or less", l->low);
    } else if (def->cone_axis >= 0) {
        gltf_fail(at, GLTF_UNSUPPORTED, "a second cone");
    }
    if (l->high >= PI) {
        return;
    }
    def->cone_axis = 3 - l->axes[0] - l->axes[1];
    def->cone_angle = (float)l->high;
    def->cone_stiffness = l->soft ? (float)l->stiffness : 0.0f;
    def->cone_damping = l->soft ? (float)l->damping : 0.0f;
}

static void apply_limit(const gltf_at *at, talus_joint_def *def, const limit *l) {
    talus_axis *axes = l->linear ? def->linear : def->angular;
    if (is_open(l)) {
        return;
    }
    if (l->count == 1) {
        bound_axis(at, &axes[l->axes[0]], l);
    } else if (l->low <= 0 && l->high == 0) { /* no distance or angle at all: each axis on its own */
        limit none = *l;
        none.low = none.high = 0;
        for (int i = 0; i < l->count; i++) {
            bound_axis(at, &axes[l->axes[i]], &none);
        }
    } else if (l->linear && l->count == 3) {
        bound_distance(at, def, l);
    } else if (!l->linear && l->count == 2) {
        bound_cone(at, def, l);
    } else {
        gltf_fail(at, GLTF_UNSUPPORTED,
                  l->linear ? "a distance from a line other than 0 (two linear axes)"
                            : "a bound other than 0 of the whole rotation (three angular axes)");
    }
}

/* What the limits make together must be what one joint can do. */
static void check_together(const gltf_at *limits, const talus_joint_def *def) {
    for (int i = 0; i < 3; i++) {
        if (def->distance_enabled && def->linear[i].mode != TALUS_AXIS_FREE) {
            gltf_fail(limits, GLTF_UNSUPPORTED, "a distance of the pivots and a limit of linear axis %d together", i);
        }
        if (def->cone_axis >= 0 && i != def->cone_axis && def->angular[i].mode != TALUS_AXIS_FREE) {
            gltf_fail(limits, GLTF_UNSUPPORTED, "a cone about axis %d and a limit of angular axis %d together",
                      (int)def->cone_axis, i);
        }
    }
}

static void read_drive(const gltf_at *at, talus_joint_def *def) {
    static const char *const types[] = {"linear", "angular"}, *const modes[] = {"force", "acceleration"};
    static const char *const needed[] = {"type", "mode", "axis"};
    for (int i = 0; i < 3; i++) {
        gltf_at member = gltf_member(at, needed[i]);
        if (member.json == NULL) {
            gltf_fail(&member, GLTF_BROKEN, "is missing");
        }
    }
    talus_drive drive;
    memset(&drive, 0, sizeof drive);
    int angular = gltf_choice(at, "type", types, 2, 0), acceleration = gltf_choice(at, "mode", modes, 2, 0);
    int axis = gltf_index(at, "axis", 3, "axes");
    double max_force = gltf_number(at, "maxForce", -1, 0, 3e38);
    drive.enabled = max_force != 0;
    drive.acceleration = (uint8_t)acceleration;
    drive.max_force = max_force > 0 ? (float)max_force : 0.0f;
    drive.position_target = (float)gltf_number(at, "positionTarget", 0, -1e6, 1e6);
    drive.velocity_target = (float)gltf_number(at, "velocityTarget", 0, -1e6, 1e6);
    drive.stiffness = (float)gltf_number(at, "stiffness", 0, 0, 1e18);
    drive.damping = (float)gltf_number(at, "damping", 0, 0, 1e18);
    if (gltf_failed(at)) {
        return;
    }
    talus_drive *place = angular ? &def->angular_drive[axis] : &def->linear_drive[axis];
    if (place->enabled) {
        gltf_fail(at, GLTF_UNSUPPORTED, "a second drive of %s axis %d", types[angular], axis);
        return;
    }
    if (drive.stiffness > 0 || drive.damping > 0) {
        *place = drive;
    }
}

void gltf_read_joint(gltf_loader *loader, const gltf_at *kind, talus_joint_def *def) {
    static const talus_pose identity = {{0, 0, 0}, {0, 0, 0, 1}};
    memset(def, 0, sizeof *def);
    def->frame_a = def->frame_b = identity;
    def->cone_axis = -1;
    gltf_list limits = gltf_list_open(kind, "limits"), drives = gltf_list_open(kind, "drives");
    for (int i = 0; i < limits.count && loader->error->status == GLTF_OK; i++) {
        gltf_at at = gltf_list_item(&limits, i);
        limit one;
        read_limit(&at, &one);
        if (!gltf_failed(&at)) {
            apply_limit(&at, def, &one);
        }
    }
    check_together(&limits.at, def);
    for (int i = 0; i < drives.count && loader->error->status == GLTF_OK; i++) {
        gltf_at at = gltf_list_item(&drives, i);
        read_drive(&at, def);
    }
    gltf_list_close(&limits);
    gltf_list_close(&drives);
}

/* TALUS_LOCK_* of a body that a joint to the world leaves nothing but the motion in a plane across a world axis; else
 * 0.
 */
static uint32_t plane_of(const gltf_loader *loader, int node, int other, const gltf_joint *joint) {
    const double near = 1e-6; /* m, rad */
    const talus_joint_def *def = &joint->def;
    const gltf_place *place[] = {&loader->place[node], &loader->place[other]};
    uint32_t k = 0, linear = 0, angular = 0;
    for (uint32_t i = 0; i < 3; i++) {
        const talus_axis *axis[] = {&def->linear[i], &def->angular[i]};
        for (int j = 0; j < 2; j++) {
            int locked = axis[j]->mode == TALUS_AXIS_LOCKED && axis[j]->lower == 0;
            if (!locked && axis[j]->mode != TALUS_AXIS_FREE) {
                return 0;
            }
            *(j ? &angular : &linear) |= (uint32_t)locked << i;
        }
        if (def->linear_drive[i].enabled || def->angular_drive[i].enabled) {
            return 0;
        }
        k = linear == 1u << i ? i : k;
    }
    if (linear != 1u << k || angular != (linear ^ 7u) || def->distance_enabled || def->cone_axis >= 0 ||
        joint->static_a != GLTF_NONE || joint->static_b != GLTF_NONE) {
        return 0;
    }
    const gltf_double3 unit = gltf_d3(k == 0, k == 1, k == 2);
    const gltf_double3 n = gltf_rotate(place[0]->rotation, unit), m = gltf_rotate(place[1]->rotation, unit);
    double apart = gltf_dot3(n, gltf_sub3(place[1]->position, place[0]->position));
    const double along[] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    for (uint32_t i = 0; i < 3; i++) {
        if (along[i] > 1 - near * near && gltf_dot3(n, m) > 1 - near * near && fabs(apart) < near) {
            return talus_lock_plane(i);
        }
    }
    return 0;
}

/* The static collider that an end without a body hangs on. */
static uint32_t anchor(gltf_loader *loader, int node, uint32_t body) {
    uint32_t collider = body == GLTF_NONE ? loader->collider[node] : GLTF_NONE;
    if (collider != GLTF_NONE) {
        loader->scene->colliders[collider].anchored = 1;
    }
    return collider;
}

static void add_joint(gltf_loader *loader, int index, const gltf_at *link) {
    gltf_document *document = &loader->document;
    gltf_scene *scene = loader->scene;
    gltf_at at = gltf_member(link, "connectedNode"), kind_at = gltf_member(link, "joint");
    int other = gltf_index(link, "connectedNode", document->nodes.count, "nodes");
    int kind = gltf_index(link, "joint", document->joints.count, "physics joints");
    if (other < 0) {
        gltf_fail(&at, GLTF_BROKEN, "is missing, must be the node of the joint's second end");
    } else if (!loader->place[other].in_scene) {
        gltf_fail(&at, GLTF_BROKEN, "is node %d, which is not in the scene", other);
    }
    if (kind < 0) {
        gltf_fail(&kind_at, GLTF_BROKEN, "is missing, must be the index of a physics joint");
    }
    int collide = gltf_flag(link, "enableCollision", 0);
    if (gltf_failed(link)) {
        return;
    }
    gltf_joint joint;
    memset(&joint, 0, sizeof joint);
    gltf_at description = gltf_list_item(&document->joints, kind);
    gltf_read_joint(loader, &description, &joint.def);
    joint.node = (uint32_t)index;
    joint.body_a = loader->body[index];
    joint.body_b = loader->body[other];
    if (joint.body_a == joint.body_b) {
        gltf_scene_add_note(scene, "a joint whose two ends do not move against each other is left out");
        return;
    }
    if (loader->place[index].sheared || loader->place[other].sheared) {
        gltf_fail(link, GLTF_UNSUPPORTED, "one of its nodes is sheared by the scales of the nodes above it");
        return;
    }
    joint.static_a = anchor(loader, index, joint.body_a);
    joint.static_b = anchor(loader, other, joint.body_b);
    uint32_t locks = plane_of(loader, index, other, &joint);
    uint32_t held = joint.body_a == GLTF_NONE ? joint.body_b : joint.body_a;
    if (locks && (joint.body_a == GLTF_NONE || joint.body_b == GLTF_NONE) && !scene->bodies[held].kinematic) {
        scene->bodies[held].locks |= locks;
        return;
    }
    joint.def.frame_a = gltf_pose_in_body(loader, index, joint.body_a);
    joint.def.frame_b = gltf_pose_in_body(loader, other, joint.body_b);
    joint.def.collide_connected = (uint8_t)collide;
    if (gltf_grow(loader->error, &scene->joints, &scene->joint_room, scene->joint_count, sizeof *scene->joints)) {
        scene->joints[scene->joint_count++] = joint;
    }
}

int gltf_load_joints(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    for (int i = 0; i < nodes->count && loader->error->status == GLTF_OK; i++) {
        gltf_at node = gltf_list_item(nodes, i), extensions;
        gltf_at physics = gltf_physics(&node, &extensions), link = gltf_member(&physics, "joint");
        if (link.json != NULL && loader->place[i].in_scene) {
            add_joint(loader, i, &link);
        }
    }
    return loader->error->status == GLTF_OK;
}
