/* Joints, free flight, sensors. */
#include "golden.h"

static talus_pose at(float x, float y, float z) {
    talus_pose p = {{x, y, z}, {0.0f, 0.0f, 0.0f, 1.0f}};
    return p;
}

static talus_body capsule(talus_world *world, talus_vec3 position, float half, float radius) {
    talus_body b = golden_body(world, TALUS_DYNAMIC, position);
    talus_shape_def def = talus_shape_def_default();
    def.geometry.type = TALUS_CAPSULE;
    def.geometry.half_height = half;
    def.geometry.radius_top = def.geometry.radius_bottom = radius;
    golden_shape(world, b, &def);
    return b;
}

static void build_chain(talus_world *world) {
    talus_body before = talus_world_ground(world);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.frame_a = at(0.0f, 10.0f, 0.0f);
    for (int i = 0; i < 16; i++) {
        talus_body b = golden_body(world, TALUS_DYNAMIC, golden_vec(0.25f + 0.5f * (float)i, 10.0f, 0.0f));
        golden_box(world, b, golden_vec(0.2f, 0.05f, 0.05f));
        def.a = before, def.b = b;
        def.frame_b = at(-0.25f, 0.0f, 0.0f);
        golden_joint(world, &def);
        def.frame_a = at(0.25f, 0.0f, 0.0f);
        before = b;
    }
    talus_body ball = golden_body(world, TALUS_DYNAMIC, golden_vec(8.5f, 10.0f, 0.0f));
    golden_ball(world, ball, 0.5f);
    def.a = before, def.b = ball;
    def.frame_b = at(-0.5f, 0.0f, 0.0f);
    golden_joint(world, &def);
}

/* Planks on hinges between two fixed places, and boxes that fall on them. */
static void build_bridge(talus_world *world) {
    talus_body before = talus_world_ground(world);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    for (int i = 0; i <= 20; i++) {
        float x = 0.6f * (float)i;
        def.a = before, def.b = talus_world_ground(world);
        def.frame_b = at(x, 3.0f, 0.0f);
        if (i < 20) {
            def.b = golden_body(world, TALUS_DYNAMIC, golden_vec(x + 0.3f, 3.0f, 0.0f));
            golden_box(world, def.b, golden_vec(0.28f, 0.05f, 1.0f));
            def.frame_b = at(-0.3f, 0.0f, 0.0f);
        }
        def.frame_a = i ? at(0.3f, 0.0f, 0.0f) : at(0.0f, 3.0f, 0.0f);
        def.frame_a.rotation.y = def.frame_b.rotation.y = -0.70710678f; /* x onto z */
        def.frame_a.rotation.w = def.frame_b.rotation.w = 0.70710678f;
        golden_joint(world, &def);
        before = def.b;
    }
    for (int i = 0; i < 4; i++) {
        float x = 4.0f + 1.3f * (float)i;
        golden_box(world, golden_body(world, TALUS_DYNAMIC, golden_vec(x, 4.0f, golden_range(-0.4f, 0.4f))),
                   golden_vec(0.4f, 0.4f, 0.4f));
    }
}

static void limb(talus_world *world, talus_body a, talus_vec3 on_a, talus_vec3 place, float half) {
    talus_body b = capsule(world, place, half, 0.07f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.a = a, def.b = b;
    def.frame_a = at(on_a.x, on_a.y, on_a.z);
    def.frame_b = at(0.0f, half + 0.05f, 0.0f);
    def.cone_axis = 1;
    def.cone_angle = 0.6f;
    def.angular[1].mode = TALUS_AXIS_LIMITED;
    def.angular[1].lower = -0.3f, def.angular[1].upper = 0.3f;
    golden_joint(world, &def);
    /* and a shin on a hinge about x */
    talus_body c = capsule(world, golden_vec(place.x, place.y - 2.0f * half - 0.1f, place.z), half, 0.06f);
    talus_joint_def hinge = talus_joint_def_default();
    talus_joint_make_revolute(&hinge);
    hinge.a = b, hinge.b = c;
    hinge.frame_a = at(0.0f, -half - 0.05f, 0.0f);
    hinge.frame_b = at(0.0f, half + 0.05f, 0.0f);
    hinge.angular[0].mode = TALUS_AXIS_LIMITED;
    hinge.angular[0].lower = 0.0f, hinge.angular[0].upper = 2.0f;
    golden_joint(world, &hinge);
}

static void build_ragdolls(talus_world *world) {
    golden_floor(world);
    for (int i = 0; i < 5; i++) {
        float x = golden_range(-0.5f, 0.5f), y = 2.0f + 1.5f * (float)i, z = golden_range(-0.5f, 0.5f);
        talus_body torso = capsule(world, golden_vec(x, y, z), 0.2f, 0.15f);
        limb(world, torso, golden_vec(-0.15f, -0.35f, 0.0f), golden_vec(x - 0.15f, y - 0.6f, z), 0.18f);
        limb(world, torso, golden_vec(0.15f, -0.35f, 0.0f), golden_vec(x + 0.15f, y - 0.6f, z), 0.18f);
        limb(world, torso, golden_vec(-0.25f, 0.2f, 0.0f), golden_vec(x - 0.25f, y, z), 0.13f);
        limb(world, torso, golden_vec(0.25f, 0.2f, 0.0f), golden_vec(x + 0.25f, y, z), 0.13f);
    }
}

static talus_body hung(talus_world *world, talus_joint_def *def, float x) {
    talus_body b = golden_body(world, TALUS_DYNAMIC, golden_vec(x, 3.0f, 0.0f));
    golden_box(world, b, golden_vec(0.3f, 0.1f, 0.2f));
    def->b = b;
    def->frame_a = at(x - 0.3f, 3.0f, 0.0f);
    def->frame_b = at(-0.3f, 0.0f, 0.0f);
    return b;
}

static talus_joint_def drive_hinge(int acceleration, float most) {
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].acceleration = (uint8_t)acceleration;
    def.angular_drive[0].position_target = 1.0f;
    def.angular_drive[0].stiffness = acceleration ? 100.0f : 4000.0f;
    def.angular_drive[0].damping = acceleration ? 10.0f : 200.0f;
    def.angular_drive[0].max_force = most;
    return def;
}

/* One of each kind. */
static void build_joints(talus_world *world) {
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_fixed(&def);
    hung(world, &def, 0.0f);
    golden_joint(world, &def);
    for (int i = 0; i < 2; i++) {
        def = drive_hinge(i, i ? 0.0f : 300.0f);
        hung(world, &def, 2.0f + 2.0f * (float)i);
        golden_joint(world, &def);
    }
    def = talus_joint_def_default();
    talus_joint_make_prismatic(&def);
    def.frame_a.rotation.z = 0.5f, def.frame_a.rotation.w = 0.8f;
    def.linear[0].mode = TALUS_AXIS_LIMITED;
    def.linear[0].lower = -0.5f, def.linear[0].upper = 0.5f;
    def.linear[0].stiffness = 3000.0f, def.linear[0].damping = 50.0f;
    hung(world, &def, 6.0f);
    golden_joint(world, &def);
    def = talus_joint_def_default();
    talus_joint_make_distance(&def, 0.2f, 0.8f);
    hung(world, &def, 8.0f);
    golden_joint(world, &def);
    def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.break_force = 200.0f;
    talus_body b = hung(world, &def, 10.0f);
    golden_joint(world, &def);
    golden_check(talus_body_set_velocity(world, b, golden_vec(0.0f, 0.0f, 6.0f), golden_vec(0.0f, 0.0f, 0.0f)),
                 "velocity");
    def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.frame_a.rotation.y = 0.7f, def.frame_a.rotation.w = 0.7f;
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].velocity_target = 12.0f;
    def.angular_drive[0].damping = 500.0f;
    hung(world, &def, 12.0f);
    golden_joint(world, &def);
}

/* Free turning about a middle axis, damping, locks, fields of no gravity. */
static void build_flight(talus_world *world) {
    for (uint32_t i = 0; i < 12; i++) {
        talus_body_def def = talus_body_def_default();
        talus_body b;
        def.type = TALUS_DYNAMIC;
        def.pose.position = golden_vec(3.0f * (float)i, 0.0f, 0.0f);
        def.pose.rotation = golden_turn();
        def.linear_velocity = golden_any(golden_vec(0.0f, 0.0f, -100.0f), golden_vec(0.0f, 10.0f, 100.0f));
        def.angular_velocity = golden_vec(0.01f, golden_range(5.0f, 30.0f), 0.0f);
        def.linear_damping = i % 3u ? 0.0f : 0.5f;
        def.angular_damping = i % 4u ? 0.0f : 0.25f;
        def.gravity_scale = i % 2u ? 0.0f : 1.0f;
        def.locks = i > 8u ? 1u << (i - 8u) : 0u;
        golden_check(talus_body_create(world, &def, &b), "body");
        golden_box(world, b, golden_vec(0.1f, 0.3f, 0.6f));
    }
}

static void build_sensors(talus_world *world) {
    talus_body_def def = talus_body_def_default();
    talus_body gate, ball;
    golden_floor(world);
    golden_check(talus_body_create(world, &def, &gate), "body");
    talus_shape_def sensor = talus_shape_def_default();
    sensor.sensor = 1;
    sensor.geometry.half = golden_vec(2.0f, 0.5f, 2.0f);
    sensor.pose.position.y = 3.0f;
    golden_shape(world, gate, &sensor);
    for (int i = 0; i < 16; i++) {
        ball = golden_body(world, TALUS_DYNAMIC, golden_above(1.5f, 5.0f + 0.5f * (float)i));
        talus_shape_def shape = talus_shape_def_default();
        shape.geometry.type = TALUS_SPHERE;
        shape.geometry.radius = 0.2f;
        shape.material.restitution = 0.8f;
        shape.events = 1;
        golden_shape(world, ball, &shape);
    }
}

/* Bodies locked to planes across x, y and z, on the ground, on a plank that is moved along it, some tied. */
static void build_planes(talus_world *world) {
    golden_floor(world);
    for (uint32_t i = 0; i < 60; i++) {
        uint32_t axis = i % 3u, place = i / 3u;
        float along = -1.4f + 0.7f * (float)(place % 5u), apart = 6.0f * (float)axis;
        talus_body_def def = talus_body_def_default();
        talus_body b;
        def.type = i < 3u ? TALUS_KINEMATIC : TALUS_DYNAMIC;
        def.pose.position =
            golden_vec(axis == 2u ? along : 0.1f * (float)axis, 0.4f + 0.9f * (float)(place / 5u), apart);
        def.pose.position.z += axis == 2u ? 0.0f : along;
        def.locks = i < 3u ? 0u : talus_lock_plane(axis);
        if (axis == 1u) { /* seen from above: what falls is held */
            def.linear_velocity = golden_vec(-0.5f * along, 0.0f, golden_range(-1.0f, 1.0f));
        }
        golden_check(talus_body_create(world, &def, &b), "body");
        talus_shape_def shape = talus_shape_def_default();
        shape.geometry.half = i % 4u ? golden_any(golden_vec(0.2f, 0.2f, 0.2f), golden_vec(0.4f, 0.4f, 0.4f))
                                     : golden_vec(0.3f, 0.3f, 0.3f);
        if (place % 4u == 3u) {
            shape.geometry.type = TALUS_SPHERE, shape.geometry.radius = golden_range(0.2f, 0.35f);
            shape.material.rolling_resistance = 0.01f;
        }
        shape.material.restitution = place % 5u == 4u ? 0.5f : 0.0f;
        shape.density = place % 7u == 6u ? 20000.0f : 1000.0f;
        shape.events = i % 2u;
        golden_shape(world, b, &shape);
        if (place % 5u == 1u && place > 5u) { /* to the body beside it */
            talus_joint_def joint = talus_joint_def_default();
            talus_joint_make_ball(&joint);
            joint.a.index = b.index - 3u, joint.a.generation = 1u, joint.b = b;
            joint.frame_a.position = axis == 2u ? golden_vec(0.35f, 0.0f, 0.0f) : golden_vec(0.0f, 0.0f, 0.35f);
            joint.frame_b.position = axis == 2u ? golden_vec(-0.35f, 0.0f, 0.0f) : golden_vec(0.0f, 0.0f, -0.35f);
            golden_joint(world, &joint);
        }
    }
}

/* Some are let go for a while. */
static void lock_and_let_go(talus_world *world, uint32_t step) {
    if (step % 40u == 39u) {
        talus_body body = {4u + 5u * (step / 40u), 1u};
        uint32_t locks = step % 80u == 39u ? 0u : talus_lock_plane((body.index - 1u) % 3u);
        golden_check(talus_body_set_locks(world, body, locks), "locks");
    }
    for (uint32_t k = 0; k < 3u; k++) {
        talus_body plank = {1u + k, 1u};
        float speed = step / 60u % 2u ? -0.4f : 0.4f;
        talus_vec3 v = k == 2u ? golden_vec(speed, 0.0f, 0.0f) : golden_vec(0.0f, 0.0f, speed);
        golden_check(talus_body_set_velocity(world, plank, v, golden_vec(0.0f, 0.0f, 0.0f)), "velocity");
    }
}

const golden_scene golden_more_scenes[] = {
    {"chain", 240, build_chain, 0},
    {"bridge", 240, build_bridge, 0},
    {"ragdolls", 240, build_ragdolls, 0},
    {"joints", 240, build_joints, 0},
    {"flight", 240, build_flight, 0},
    {"sensors", 200, build_sensors, 0},
    {"planes", 240, build_planes, lock_and_let_go},
};
const unsigned golden_more_scene_count = sizeof golden_more_scenes / sizeof *golden_more_scenes;
