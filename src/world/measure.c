/* What error the state holds now: how deep touching surfaces overlap, and how far joints are from where they should be.
 */
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

static float deepest_point(const tl_header *h, uint32_t contact) {
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    const tl_contact_head *head = &tl_heads(h)[contact];
    talus_vec3 n = tl_v(head->normal[0], head->normal[1], head->normal[2]);
    if (!tl_body_is_fixed(h, m->body_a)) {
        n = tl_rotate(tl_row_quat(&tl_body_pose(h)[m->body_a]), n);
    }
    float depth = 0.0f;
    for (uint32_t i = 0; i < m->count; i++) {
        const tl_contact_point_record *r = &tl_points(h)[contact].p[i];
        talus_vec3 d = tl_sub(place_of(h, m->body_b, r->b), place_of(h, m->body_a, r->a));
        depth = tl_max(depth, -tl_dot(d, n));
    }
    return depth;
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
            out->overlap = tl_max(out->overlap, deepest_point(h, i));
        }
    }
    for (uint32_t i = 0; i < h->joints.high; i++) {
        if (tl_joints(h)[i].flags & TL_JOINT_ALIVE) {
            talus_joint joint = {i, tl_joints(h)[i].generation};
            float linear = 0.0f, angular = 0.0f;
            talus_joint_get_error(world, joint, &linear, &angular);
            out->joint_linear = tl_max(out->joint_linear, linear);
            out->joint_angular = tl_max(out->joint_angular, angular);
        }
    }
    return TALUS_OK;
}
