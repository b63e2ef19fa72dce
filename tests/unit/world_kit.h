/* What the tests of worlds are put together from. A call that must not fail ends the test where it does. */
#ifndef WORLD_KIT_H
#define WORLD_KIT_H

#include "talus/talus.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the four above. */
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OK(call) assert_int_equal((call), TALUS_OK)

/* A call that must answer `status` and leave the world as it was. */
#define REFUSED(world, status, call)                                                                                   \
    do {                                                                                                               \
        uint64_t before_ = talus_world_hash(world);                                                                    \
        assert_int_equal((call), (status));                                                                            \
        assert_true(before_ == talus_world_hash(world));                                                               \
    } while (0)

#define NEAR(a, b, tolerance) kit_near((double)(a), (double)(b), (double)(tolerance), #a, __FILE__, __LINE__)

static inline void kit_near(double a, double b, double tolerance, const char *text, const char *file, int line) {
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%s:%d: %s is %.9g, not %.9g within %.3g\n", file, line, text, a, b, tolerance);
        _fail(file, line);
    }
}

/* `bytes` bytes aligned as blocks and blobs ask for; freed by kit_free. */
static inline void *kit_alloc(size_t bytes) {
    unsigned char *p = malloc(bytes + 2u * TALUS_BLOCK_ALIGNMENT);
    assert_non_null(p);
    unsigned char *q = p + sizeof(void *);
    q += (TALUS_BLOCK_ALIGNMENT - (uintptr_t)q % TALUS_BLOCK_ALIGNMENT) % TALUS_BLOCK_ALIGNMENT;
    memcpy(q - sizeof(void *), &p, sizeof p);
    return q;
}
static inline void kit_free(void *p) {
    void *start;
    memcpy(&start, (unsigned char *)p - sizeof(void *), sizeof start);
    free(start);
}

static inline talus_vec3 kit_vec(float x, float y, float z) {
    talus_vec3 v = {x, y, z};
    return v;
}
static inline talus_pose kit_pose(float x, float y, float z) {
    talus_pose p = {{x, y, z}, {0.0f, 0.0f, 0.0f, 1.0f}};
    return p;
}

static inline talus_world_def kit_small(void) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = 64, def.shape_capacity = 64, def.joint_capacity = 32;
    def.contact_capacity = 256, def.event_capacity = 32;
    return def;
}
static inline talus_world kit_world(const talus_world_def *def) {
    talus_world world;
    size_t size = talus_world_size(def);
    assert_true(size > 0);
    OK(talus_world_init(&world, def, kit_alloc(size), size));
    return world;
}
/* No gravity, no sleep: what closed forms speak of. */
static inline talus_world kit_void(void) {
    talus_world_def def = kit_small();
    def.gravity = kit_vec(0.0f, 0.0f, 0.0f);
    def.enable_sleep = 0;
    return kit_world(&def);
}
static inline void kit_end(talus_world *world) {
    kit_free(world->block);
    world->block = NULL;
}
static inline void kit_steps(talus_world *world, int count) {
    for (int i = 0; i < count; i++) {
        OK(talus_world_step(world, 1.0f / 60.0f, NULL, NULL));
    }
}

static inline talus_body kit_body(talus_world *world, talus_body_type type, talus_vec3 at) {
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = type;
    def.pose.position = at;
    OK(talus_body_create(world, &def, &body));
    return body;
}
static inline talus_shape kit_shape(talus_world *world, talus_body body, const talus_shape_def *def) {
    talus_shape shape;
    OK(talus_shape_create(world, body, def, &shape));
    return shape;
}
static inline talus_shape_def kit_box_def(float x, float y, float z) {
    talus_shape_def def = talus_shape_def_default();
    def.geometry.half = kit_vec(x, y, z);
    return def;
}
static inline talus_shape_def kit_ball_def(float radius) {
    talus_shape_def def = talus_shape_def_default();
    def.geometry.type = TALUS_SPHERE;
    def.geometry.radius = radius;
    return def;
}
static inline talus_body kit_box(talus_world *world, talus_vec3 at, float half) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, at);
    talus_shape_def def = kit_box_def(half, half, half);
    kit_shape(world, body, &def);
    return body;
}
static inline talus_body kit_ball(talus_world *world, talus_vec3 at, float radius) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, at);
    talus_shape_def def = kit_ball_def(radius);
    kit_shape(world, body, &def);
    return body;
}
/* A slab whose top is at y = 0. */
static inline talus_shape kit_floor(talus_world *world) {
    talus_shape_def def = kit_box_def(50.0f, 1.0f, 50.0f);
    def.pose.position.y = -1.0f;
    return kit_shape(world, talus_world_ground(world), &def);
}

static inline talus_pose kit_pose_of(const talus_world *world, talus_body body) {
    talus_pose pose;
    OK(talus_body_get_pose(world, body, &pose));
    return pose;
}
static inline talus_vec3 kit_place(const talus_world *world, talus_body body) {
    return kit_pose_of(world, body).position;
}
static inline talus_vec3 kit_velocity(const talus_world *world, talus_body body) {
    talus_vec3 linear, angular;
    OK(talus_body_get_velocity(world, body, &linear, &angular));
    return linear;
}
static inline talus_vec3 kit_spin(const talus_world *world, talus_body body) {
    talus_vec3 linear, angular;
    OK(talus_body_get_velocity(world, body, &linear, &angular));
    return angular;
}
static inline talus_events kit_events(const talus_world *world) {
    talus_events events;
    OK(talus_world_get_events(world, &events));
    return events;
}
static inline talus_counters kit_counters(const talus_world *world) {
    talus_counters counters;
    OK(talus_world_get_counters(world, &counters));
    return counters;
}
static inline float kit_length(talus_vec3 v) { return sqrtf(v.x * v.x + v.y * v.y + v.z * v.z); }

/* A hull in memory of its own: the world's geometry region. */
static inline void *kit_hull_of(const talus_vec3 *points, uint32_t count, size_t *bytes) {
    size_t scratch_size = talus_hull_scratch_size(count), room = talus_hull_max_size(count);
    void *scratch = kit_alloc(scratch_size), *out = kit_alloc(room);
    OK(talus_hull_build(points, count, scratch, scratch_size, out, room, bytes));
    kit_free(scratch);
    return out;
}
static inline void *kit_hull_region(size_t *bytes) {
    static const talus_vec3 points[8] = {{0.5f, 0.0f, 0.0f},  {-0.5f, 0.1f, 0.0f}, {0.0f, 0.4f, 0.1f},
                                         {0.0f, -0.4f, 0.0f}, {0.1f, 0.0f, 0.45f}, {0.0f, 0.1f, -0.5f},
                                         {0.3f, 0.3f, 0.3f},  {-0.2f, -0.3f, 0.3f}};
    return kit_hull_of(points, 8, bytes);
}

/* A world with some of everything in it: boxes, balls, a hull, capsules in a chain, a kinematic body, a sensor. */
static inline void kit_busy(talus_world *world, const void *hull, size_t hull_bytes) {
    world->geometry = hull;
    world->geometry_bytes = hull_bytes;
    kit_floor(world);
    for (int i = 0; i < 12; i++) {
        float x = 0.3f * (float)(i % 3), y = 0.6f + 0.9f * (float)i, z = 0.25f * (float)(i % 4);
        talus_body body = kit_body(world, TALUS_DYNAMIC, kit_vec(x, y, z));
        talus_shape_def def = i % 3 ? kit_box_def(0.3f, 0.2f, 0.4f) : kit_ball_def(0.3f);
        if (i % 4 == 1) {
            def.geometry.type = TALUS_HULL;
            def.geometry.hull = 0;
        }
        def.events = 1;
        def.material.restitution = i % 2 ? 0.5f : 0.0f;
        kit_shape(world, body, &def);
    }
    talus_body before = talus_world_ground(world);
    for (int i = 0; i < 6; i++) {
        talus_body body = kit_body(world, TALUS_DYNAMIC, kit_vec(0.25f + 0.5f * (float)i, 6.0f, 0.0f));
        talus_shape_def def = talus_shape_def_default();
        def.geometry.type = TALUS_CAPSULE;
        def.geometry.half_height = 0.15f, def.geometry.radius_top = 0.1f, def.geometry.radius_bottom = 0.08f;
        kit_shape(world, body, &def);
        talus_joint_def joint = talus_joint_def_default();
        talus_joint handle;
        talus_joint_make_ball(&joint);
        joint.a = before, joint.b = body;
        joint.frame_a = i ? kit_pose(0.25f, 0.0f, 0.0f) : kit_pose(0.0f, 6.0f, 0.0f);
        joint.frame_b = kit_pose(-0.25f, 0.0f, 0.0f);
        OK(talus_joint_create(world, &joint, &handle));
        before = body;
    }
    talus_body_def paddle = talus_body_def_default();
    talus_body body;
    paddle.type = TALUS_KINEMATIC;
    paddle.angular_velocity.y = 2.0f;
    OK(talus_body_create(world, &paddle, &body));
    talus_shape_def def = kit_box_def(1.5f, 0.3f, 0.1f);
    kit_shape(world, body, &def);
    def.sensor = 1;
    def.pose.position.y = 1.0f;
    kit_shape(world, body, &def);
}

#endif
