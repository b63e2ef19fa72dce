/* A small world with some of everything, for fuzzers that break states. */
#ifndef BUSY_WORLD_H
#define BUSY_WORLD_H

#include "talus/talus.h"

#include <stdlib.h>
#include <string.h>

#define MUST(call)                                                                                                     \
    do {                                                                                                               \
        if ((call) != TALUS_OK) {                                                                                      \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

/* Memory at a multiple of 64; kept until the end. */
static inline void *aligned(size_t bytes) {
    static void *kept[64];
    static size_t count;
    unsigned char *p = malloc(bytes + 64u);
    if (!p || count == sizeof kept / sizeof *kept) {
        abort();
    }
    kept[count++] = p;
    return p + (64u - (uintptr_t)p % 64u) % 64u;
}

/* A tetrahedron in a region of its own. */
static inline void give_hull(talus_world *w) {
    const talus_vec3 points[4] = {{0.5f, 0.0f, 0.0f}, {-0.5f, 0.0f, 0.3f}, {0.0f, 0.6f, 0.0f}, {0.0f, 0.0f, -0.5f}};
    size_t need = talus_hull_scratch_size(4), room = talus_hull_max_size(4);
    void *out = aligned(room);
    MUST(talus_hull_build(points, 4, aligned(need), need, out, room, &w->geometry_bytes));
    w->geometry = out;
}

static inline talus_body add_body(talus_world *w, talus_body_type type, float x, float y, talus_shape_type shape) {
    talus_body_def def = talus_body_def_default();
    talus_shape_def s = talus_shape_def_default();
    talus_body body;
    talus_shape made;
    def.type = type;
    def.pose.position.x = x, def.pose.position.y = y;
    MUST(talus_body_create(w, &def, &body));
    s.geometry.type = shape;
    s.geometry.radius = s.geometry.radius_top = 0.4f, s.geometry.radius_bottom = 0.3f;
    s.geometry.half_height = 0.3f;
    s.events = 1;
    MUST(talus_shape_create(w, body, &s, &made));
    return body;
}

/* The same one every time: a floor, what falls on it, a chain, a paddle, a body that is gone, after `steps` steps. */
static inline void busy_world(talus_world *w, uint32_t steps) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = 14, def.shape_capacity = 16, def.joint_capacity = 4;
    def.contact_capacity = 48, def.event_capacity = 8;
    def.sleep_time = 0.1f;
    size_t bytes = talus_world_size(&def);
    MUST(talus_world_init(w, &def, aligned(bytes), bytes));
    give_hull(w);
    talus_shape_def floor = talus_shape_def_default();
    talus_shape made;
    floor.geometry.half.x = floor.geometry.half.z = 8.0f;
    floor.pose.position.y = -0.5f;
    MUST(talus_shape_create(w, talus_world_ground(w), &floor, &made));
    talus_body gone = add_body(w, TALUS_DYNAMIC, 0.0f, 9.0f, TALUS_SPHERE), before = {0, 0};
    for (int i = 0; i < 7; i++) {
        add_body(w, TALUS_DYNAMIC, 0.2f * (float)i, 0.6f + 0.8f * (float)i, (talus_shape_type)(i % 5));
    }
    for (int i = 0; i < 3; i++) {
        talus_joint_def joint = talus_joint_def_default();
        talus_joint hung;
        joint.a = before;
        joint.b = add_body(w, TALUS_DYNAMIC, -2.0f, 3.0f - 0.8f * (float)i, TALUS_CAPSULE);
        joint.frame_a.position.x = i ? 0.0f : -2.0f, joint.frame_a.position.y = i ? -0.4f : 3.4f;
        joint.frame_b.position.y = 0.4f;
        if (i == 1) {
            talus_joint_make_revolute(&joint);
        } else {
            talus_joint_make_ball(&joint);
        }
        joint.break_force = i == 2 ? 1e6f : 0.0f;
        MUST(talus_joint_create(w, &joint, &hung));
        before = joint.b;
    }
    talus_vec3 none = {0.0f, 0.0f, 0.0f}, spin = {0.0f, 2.0f, 0.0f};
    MUST(talus_body_set_velocity(w, add_body(w, TALUS_KINEMATIC, 1.0f, 0.5f, TALUS_BOX), none, spin));
    MUST(talus_body_destroy(w, gone));
    for (uint32_t i = 0; i < steps; i++) {
        MUST(talus_world_step(w, 1.0f / 60.0f, NULL, NULL));
    }
}

#endif
