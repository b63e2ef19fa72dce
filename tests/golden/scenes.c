/* Contacts: what lies, piles, rolls and bounces. */
#include "golden.h"

static void build_stack(talus_world *world) {
    golden_floor(world);
    for (int i = 0; i < 12; i++) {
        talus_body b =
            golden_body(world, TALUS_DYNAMIC, golden_vec(golden_range(-0.02f, 0.02f), 0.5f + 1.01f * (float)i, 0.0f));
        golden_box(world, b, golden_vec(0.5f, 0.5f, 0.5f));
    }
}

static void build_pyramid(talus_world *world) {
    golden_floor(world);
    for (int row = 0; row < 9; row++) {
        for (int i = 0; i < 9 - row; i++) {
            float x = ((float)i - 0.5f * (float)(8 - row)) * 1.05f;
            golden_box(world, golden_body(world, TALUS_DYNAMIC, golden_vec(x, 0.5f + (float)row, 0.0f)),
                       golden_vec(0.5f, 0.5f, 0.5f));
        }
    }
}

static void walls(talus_world *world, float half) {
    for (int side = -1; side <= 1; side += 2) {
        talus_shape_def def = talus_shape_def_default();
        def.geometry.half = golden_vec(0.5f, 4.0f, half + 1.0f);
        def.pose.position = golden_vec((float)side * (half + 0.5f), 4.0f, 0.0f);
        golden_shape(world, talus_world_ground(world), &def);
        def.geometry.half = golden_vec(half + 1.0f, 4.0f, 0.5f);
        def.pose.position = golden_vec(0.0f, 4.0f, (float)side * (half + 0.5f));
        golden_shape(world, talus_world_ground(world), &def);
    }
}

static talus_shape_def any_shape(uint32_t kind) {
    talus_shape_def def = talus_shape_def_default();
    talus_geometry *g = &def.geometry;
    switch (kind % 6u) {
    case 0:
        g->type = TALUS_SPHERE, g->radius = golden_range(0.2f, 0.4f);
        break;
    case 1:
        g->type = TALUS_CAPSULE, g->half_height = golden_range(0.1f, 0.4f);
        g->radius_top = g->radius_bottom = golden_range(0.15f, 0.3f);
        break;
    case 2:
        g->type = TALUS_CYLINDER, g->half_height = golden_range(0.1f, 0.4f);
        g->radius_top = golden_range(0.1f, 0.4f), g->radius_bottom = golden_range(0.1f, 0.4f);
        break;
    case 3:
        g->type = TALUS_BOX, g->half = golden_any(golden_vec(0.1f, 0.1f, 0.1f), golden_vec(0.4f, 0.4f, 0.4f));
        break;
    case 4:
        g->type = TALUS_CAPSULE, g->half_height = golden_range(0.1f, 0.4f);
        g->radius_top = golden_range(0.15f, 0.3f), g->radius_bottom = golden_range(0.15f, 0.3f);
        break;
    default:
        g->type = TALUS_HULL, g->hull = golden_hull[golden_next() % GOLDEN_HULLS];
        break;
    }
    def.material.static_friction = golden_range(0.2f, 1.0f);
    def.material.dynamic_friction = 0.75f * def.material.static_friction;
    def.material.rolling_resistance = kind % 2u ? 0.01f : 0.0f;
    def.material.friction_combine = (talus_combine)(golden_next() % TALUS_COMBINE_COUNT);
    def.density = golden_range(100.0f, 8000.0f);
    def.events = kind % 3u == 0;
    return def;
}

static void build_pile(talus_world *world) {
    golden_floor(world);
    walls(world, 2.0f);
    for (uint32_t i = 0; i < 60; i++) {
        talus_body_def body = talus_body_def_default();
        talus_body b;
        body.type = TALUS_DYNAMIC;
        body.pose.position = golden_above(1.4f, 0.6f + 0.25f * (float)i);
        body.pose.rotation = golden_turn();
        body.angular_velocity = golden_any(golden_vec(-3.0f, -3.0f, -3.0f), golden_vec(3.0f, 3.0f, 3.0f));
        golden_check(talus_body_create(world, &body, &b), "body");
        talus_shape_def shape = any_shape(i);
        golden_shape(world, b, &shape);
        if (i % 7u == 0) { /* a compound */
            shape = any_shape(i + 2u);
            shape.pose.position = golden_vec(0.3f, 0.1f, -0.2f);
            shape.pose.rotation = golden_turn();
            golden_shape(world, b, &shape);
        }
    }
}

/* The first body after the ground is the paddle. */
static void build_mixer(talus_world *world) {
    golden_floor(world);
    walls(world, 2.0f);
    talus_body paddle = golden_body(world, TALUS_KINEMATIC, golden_vec(0.0f, 0.6f, 0.0f));
    golden_box(world, paddle, golden_vec(1.8f, 0.4f, 0.1f));
    for (uint32_t i = 0; i < 40; i++) {
        talus_body b = golden_body(world, TALUS_DYNAMIC, golden_above(1.5f, 1.5f + 0.2f * (float)i));
        talus_shape_def shape = any_shape(i % 4u);
        golden_shape(world, b, &shape);
    }
}

static void turn_paddle(talus_world *world, uint32_t step) {
    talus_body paddle = {1, 1};
    talus_pose pose;
    golden_check(talus_body_get_pose(world, paddle, &pose), "pose");
    /* a turn of 2 atan(1/64) by the half-angle's tangent: nothing but products */
    talus_quat q = pose.rotation,
               turned = {q.x + q.z * 0.015625f, q.y + q.w * 0.015625f, q.z - q.x * 0.015625f, q.w - q.y * 0.015625f};
    pose.rotation = turned;
    pose.position.y = 0.6f + (step / 60u % 2u ? -0.1f : 0.1f);
    golden_check(talus_body_move_to(world, paddle, &pose, 1.0f / 60.0f), "move");
}

static void build_bounce(talus_world *world) {
    golden_floor(world);
    for (uint32_t i = 0; i < 24; i++) {
        talus_body_def body = talus_body_def_default();
        talus_body b;
        body.type = TALUS_DYNAMIC;
        body.pose.position = golden_vec(1.5f * (float)(i % 6u), 2.0f + (float)(i / 6u), 1.5f * (float)(i / 6u));
        body.linear_velocity = golden_any(golden_vec(-2.0f, -20.0f, 0.0f), golden_vec(2.0f, 2.0f, 0.0f));
        golden_check(talus_body_create(world, &body, &b), "body");
        talus_shape_def shape = any_shape(i);
        shape.material.restitution = (float)i / 23.0f;
        shape.material.restitution_combine = (talus_combine)(i % TALUS_COMBINE_COUNT);
        shape.events = 1;
        golden_shape(world, b, &shape);
    }
}

/* Small heaps that fall asleep; a ball is thrown among them later. */
static void build_sleep(talus_world *world) {
    golden_floor(world);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 4; k++) {
            talus_body b =
                golden_body(world, TALUS_DYNAMIC, golden_vec(2.0f * (float)i, 0.26f + 0.52f * (float)k, 0.0f));
            golden_box(world, b, golden_vec(0.25f, 0.25f, 0.25f));
        }
    }
}

static void throw_ball(talus_world *world, uint32_t step) {
    if (step == 200) {
        talus_body b = golden_body(world, TALUS_DYNAMIC, golden_vec(-3.0f, 1.0f, 0.1f));
        golden_ball(world, b, 0.3f);
        golden_check(talus_body_set_velocity(world, b, golden_vec(12.0f, 1.0f, 0.0f), golden_vec(0.0f, 0.0f, -9.0f)),
                     "velocity");
    }
}

/* Bodies come and go, filters and materials change, more touch than the capacities hold. */
static void build_churn(talus_world *world) {
    golden_floor(world);
    walls(world, 1.0f);
}

static talus_body churned[120];
static uint32_t churned_count;

static void churn(talus_world *world, uint32_t step) {
    if (step == 0) {
        churned_count = 0;
    }
    if (step % 2u == 0 && churned_count < 120u) {
        talus_body b = golden_body(world, TALUS_DYNAMIC, golden_above(0.6f, 3.0f));
        talus_shape_def shape = any_shape(golden_next());
        shape.events = 1;
        shape.filter.group = golden_next() % 8u == 0 ? -1 : 0;
        golden_shape(world, b, &shape);
        churned[churned_count++] = b;
    }
    if (step % 5u == 4u && churned_count > 20u) {
        uint32_t k = golden_next() % churned_count;
        golden_check(talus_body_destroy(world, churned[k]), "destroy");
        churned[k] = churned[--churned_count];
    }
    if (step % 7u == 6u) {
        talus_body b = churned[golden_next() % churned_count];
        talus_vec3 force = golden_any(golden_vec(-500.0f, 0.0f, 0.0f), golden_vec(500.0f, 2000.0f, 0.0f));
        talus_pose pose;
        golden_check(talus_body_get_pose(world, b, &pose), "pose");
        golden_check(talus_body_apply_force(world, b, force, pose.position), "force");
        golden_check(talus_body_apply_angular_impulse(world, b, golden_vec(0.0f, golden_range(-1.0f, 1.0f), 0.0f)),
                     "impulse");
    }
    if (step == 150u) {
        golden_check(talus_world_set_gravity(world, golden_vec(3.0f, -9.0f, 1.0f)), "gravity");
    }
}

/* Columns under boxes of ten, a hundred and a thousand times their mass, and a slab on legs. */
static void build_presses(talus_world *world) {
    golden_floor(world);
    talus_shape_def def = talus_shape_def_default();
    float heavy = def.density;
    for (int k = 0; k < 3; k++) {
        heavy *= 10.0f;
        for (int i = 0; i < 4; i++) {
            float x = 2.5f * (float)k + golden_range(-0.02f, 0.02f);
            talus_body b = golden_body(world, TALUS_DYNAMIC, golden_vec(x, 0.5f + (float)i, 0.0f));
            def.geometry.half = golden_vec(0.5f, 0.5f, 0.5f);
            def.density = i == 3 ? heavy : talus_shape_def_default().density;
            golden_shape(world, b, &def);
        }
    }
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 1.0f : -1.0f, z = i & 2 ? 4.0f : 6.0f;
        golden_box(world, golden_body(world, TALUS_DYNAMIC, golden_vec(x, 0.3f, z)), golden_vec(0.2f, 0.3f, 0.2f));
    }
    def.geometry.half = golden_vec(1.5f, 0.2f, 1.5f);
    def.density = heavy;
    golden_shape(world, golden_body(world, TALUS_DYNAMIC, golden_vec(0.1f, 0.8f, 5.0f)), &def);
}

/* Islands of several levels under an error budget that changes: columns, a pair of boxes, what falls on both. */
static void build_budget(talus_world *world) {
    golden_floor(world);
    for (int i = 0; i < 10; i++) {
        golden_box(world, golden_body(world, TALUS_DYNAMIC, golden_vec(0.0f, 0.5f + (float)i, 0.0f)),
                   golden_vec(0.5f, 0.5f, 0.5f));
        if (i % 3 == 0) {
            golden_box(world, golden_body(world, TALUS_DYNAMIC, golden_vec(4.0f + (float)i, 0.4f, 0.0f)),
                       golden_vec(0.3f, 0.4f, 0.3f));
        }
    }
}

static void change_budget(talus_world *world, uint32_t step) {
    talus_accuracy accuracy = {5e-4f, 2u + step / 40u % 3u, 32u};
    if (step % 40u == 0) {
        accuracy.error_budget = step == 120u ? 0.0f : accuracy.error_budget;
        golden_check(talus_world_set_accuracy(world, &accuracy), "accuracy");
    }
    if (step % 30u == 20u) {
        talus_body b = golden_body(world, TALUS_DYNAMIC, golden_vec(golden_range(-1.0f, 8.0f), 13.0f, 0.0f));
        golden_ball(world, b, 0.3f);
    }
}

const golden_scene golden_scenes[] = {
    {"stack", 240, build_stack, 0},
    {"pyramid", 200, build_pyramid, 0},
    {"pile", 240, build_pile, 0},
    {"mixer", 240, build_mixer, turn_paddle},
    {"bounce", 240, build_bounce, 0},
    {"sleep", 300, build_sleep, throw_ball},
    {"churn", 300, build_churn, churn},
    {"presses", 240, build_presses, 0},
    {"budget", 240, build_budget, change_budget},
};
const unsigned golden_scene_count = sizeof golden_scenes / sizeof *golden_scenes;
