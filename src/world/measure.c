/* What error the state holds now: how deep touching surfaces overlap, how far joints are from where they should be, and
 * the speeds at which both grow. */
#include "talus/joint.h"
#include "talus/world.h"

#include <string.h>

#include "world/world_internal.h"

/* Where a point of a contact's record stands: on the body, or in the world if the body has no row. */
static talus_vec3 place_of(const tl_header *h, uint32_t body, const float *p) {
    talus_vec3 own = tl_v(p[0], p[1], p[2]);
    talus_pose pose = tl_row_pose_of(&tl_body_pose(h)[body]);
    return tl_body_is_fixed(h, body) ? own : tl_pose_point(&pose, own);
}

/* m/s: of a place that moves with a body. */
static talus_vec3 speed_of(const tl_header *h, uint32_t body, talus_vec3 at) {
    const tl_row8 *v = &tl_body_velocity(h)[body];
    return tl_add(tl_row_xyz(v), tl_cross(tl_row_345(v), tl_sub(at, tl_row_xyz(&tl_body_pose(h)[body]))));
}

/* What overlaps in a contact, and how fast it closes. */
static void measure_contact(const tl_header *h, uint32_t contact, talus_errors *out) {
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    const tl_contact_head *head = &tl_heads(h)[contact];
    talus_vec3 n = tl_v(head->normal[0], head->normal[1], head->normal[2]);
    if (!tl_body_is_fixed(h, m->body_a)) {
        n = tl_rotate(tl_row_quat(&tl_body_pose(h)[m->body_a]), n);
    }
    for (uint32_t i = 0; i < m->count; i++) {
        const tl_contact_point_record *r = &tl_points(h)[contact].p[i];
        talus_vec3 a = place_of(h, m->body_a, r->a), b = place_of(h, m->body_b, r->b);
        float depth = -tl_dot(tl_sub(b, a), n);
        if (depth > 0.0f) {
            talus_vec3 v = tl_sub(speed_of(h, m->body_b, b), speed_of(h, m->body_a, a));
            out->overlap = tl_max(depth, out->overlap);
            out->contact_speed = tl_max(-tl_dot(v, n), out->contact_speed);
        }
    }
}

/* m/s: how fast the ends of a joint part along its locked linear axes. */
static float parting_speed(const tl_header *h, const tl_joint_record *j) {
    talus_pose a = tl_row_pose_of(&tl_body_pose(h)[j->body_a]), b = tl_row_pose_of(&tl_body_pose(h)[j->body_b]);
    talus_quat axes = tl_pose_mul(&a, &j->place_a).rotation;
    talus_vec3 at = tl_pose_point(&b, j->place_b.position);
    talus_vec3 v = tl_sub(speed_of(h, j->body_b, at), speed_of(h, j->body_a, at));
    v = tl_rotate_back(axes, v); /* the axes turn with a, and with them what a carries to b's end */
    const float along[3] = {v.x, v.y, v.z};
    float square = 0.0f;
    for (uint32_t k = 0; k < 3u; k++) {
        square += tl_joint_is_locked(j, k) ? along[k] * along[k] : 0.0f;
    }
    return sqrtf(square);
}

talus_status talus_world_measure(const talus_world *world, talus_errors *out) {
    if (!tl_world_is_sound(world) || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < h->contacts.high; i++) {
        const tl_contact_meta *m = &tl_contacts(h)[i];
        if ((m->flags & TL_CONTACT_ALIVE) && (m->flags & TL_CONTACT_COLORED)) {
            measure_contact(h, i, out);
        }
    }
    for (uint32_t i = 0; i < h->joints.high; i++) {
        if (tl_joints(h)[i].flags & TL_JOINT_ALIVE) {
            talus_joint joint = {i, tl_joints(h)[i].generation};
            float linear = 0.0f, angular = 0.0f;
            talus_joint_get_error(world, joint, &linear, &angular);
            out->joint_linear = tl_max(out->joint_linear, linear);
            out->joint_angular = tl_max(out->joint_angular, angular);
            out->joint_speed = tl_max(out->joint_speed, parting_speed(h, &tl_joints(h)[i]));
        }
    }
    return TALUS_OK;
}
