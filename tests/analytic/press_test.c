/* Light bodies under heavy ones: they bear them, and friction is what it should be. */
#include "analytic_kit.h"

static talus_body block_of(talus_world *world, talus_vec3 at, talus_vec3 half, float mass, float friction) {
    talus_body body = box_of(world, at, half, friction);
    set_mass(world, body, mass);
    return body;
}

static talus_vec3 cube(void) { return kit_vec(0.5f, 0.5f, 0.5f); }

/* Five boxes of 1000 kg, the top one so many times as heavy, each put `shift` beside the one below. */
static talus_body column_of(talus_world *world, float x, float ratio, float shift) {
    talus_body top = {0, 0};
    for (int i = 0; i < 5; i++) {
        talus_vec3 at = kit_vec(x + shift * (float)i, 0.5f + (float)i, 0.0f);
        top = block_of(world, at, cube(), i == 4 ? 1000.0f * ratio : 1000.0f, 0.6f);
    }
    return top;
}

static void columns(void **state) {
    (void)state;
    const float ratios[] = {10.0f, 20.0f, 100.0f, 1000.0f};
    for (int lean = 0; lean < 2; lean++) {
        talus_world world = world_of(0.0f, (float)-G, 0.0f);
        floor_of(&world, 0.6f);
        talus_body top[4];
        talus_vec3 from[4];
        for (int k = 0; k < 4; k++) {
            top[k] = column_of(&world, 3.0f * (float)k, ratios[k], lean ? 0.06f : 0.0f);
            from[k] = kit_place(&world, top[k]);
        }
        BELOW(worst_of(&world, 600).overlap, lean ? 8e-3 : 5e-3);
        assert_int_equal(kit_counters(&world).contacts_pressed, 15);
        for (int k = 0; k < 4; k++) {
            talus_vec3 at = kit_place(&world, top[k]);
            BELOW(fabsf(at.y - from[k].y), 0.02);
            BELOW(hypotf(at.x - from[k].x, at.z), lean ? 0.1 : 0.02);
        }
        kit_end(&world);
    }
}

/* A slab of so many kilograms on the corners of four piles of 1 t boxes, not over their middle. */
static void slab_of(float x, float z, float mass) {
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.6f);
    for (int i = 0; i < 12; i++) {
        talus_vec3 at = kit_vec(i & 1 ? 2.0f : -2.0f, 0.5f + (float)(i / 4), i & 2 ? 2.0f : -2.0f);
        block_of(&world, at, cube(), 1000.0f, 0.6f);
    }
    talus_body top = block_of(&world, kit_vec(x, 3.5f, z), kit_vec(2.5f, 0.5f, 2.5f), mass, 0.6f);
    BELOW(worst_of(&world, 60).overlap, 2e-2); /* until it is known what bears how much */
    BELOW(worst_of(&world, 240).overlap, 5e-3);
    assert_true(kit_counters(&world).contacts_pressed > 0);
    talus_vec3 at = kit_place(&world, top);
    BELOW(hypotf(at.x - x, at.z - z), 0.01);
    BELOW(fabsf(at.y - 3.5f), 0.01);
    kit_end(&world);
}

static void slab(void **state) {
    (void)state;
    slab_of(0.5f, 0.3f, 2.0e5f);
    slab_of(0.53f, 0.4f, 2.0e5f);
    slab_of(0.51f, 0.33f, 2.3e5f);
    slab_of(0.5f, 0.42f, 2.4e5f);
    slab_of(0.51f, 0.51f, 1.0e5f);
    slab_of(0.57f, 0.57f, 2.3e5f);
}

/* 50 t let fall from 0.2 m: the column takes the blow. */
static void blow(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.6f);
    for (int i = 0; i < 4; i++) {
        block_of(&world, kit_vec(0.0f, 0.5f + (float)i, 0.0f), cube(), 1000.0f, 0.6f);
    }
    talus_body top = block_of(&world, kit_vec(0.0f, 4.7f, 0.0f), cube(), 50000.0f, 0.6f);
    double before = 50000.0 * G * 4.7;
    kit_steps(&world, 300);
    BELOW(worst_of(&world, 60).overlap, 2e-3);
    talus_vec3 at = kit_place(&world, top), v = kit_velocity(&world, top);
    BELOW(fabsf(at.y - 4.5f), 0.02);
    BELOW(hypotf(at.x, at.z), 0.1);
    BELOW(kit_length(v), 0.01);
    assert_true(50000.0 * G * (double)at.y < before);
    kit_end(&world);
}

/* A light box between a slope and one a hundred times as heavy: both faces hold up to the angle of friction, and beyond
 * it they slide with g (sin - mu cos). */
static void slope(void **state) {
    (void)state;
    const double mu = 0.5, angles[] = {0.9 * atan(0.5), 1.3 * atan(0.5)};
    for (int k = 0; k < 2; k++) {
        talus_world world = world_on_slope(angles[k]);
        floor_of(&world, (float)mu);
        talus_body light = block_of(&world, kit_vec(0.0f, 0.1f, 0.0f), kit_vec(1.0f, 0.1f, 1.0f), 100.0f, (float)mu);
        talus_body heavy = block_of(&world, kit_vec(0.0f, 0.4f, 0.0f), kit_vec(0.5f, 0.2f, 0.5f), 1e4f, (float)mu);
        kit_steps(&world, 30);
        double a = k ? G * (sin(angles[1]) - mu * cos(angles[1])) : 0.0;
        float before = kit_velocity(&world, heavy).x;
        kit_steps(&world, 60);
        assert_int_equal(kit_counters(&world).contacts_pressed, 2);
        CLOSE(kit_velocity(&world, heavy).x - before, a, 0.03 * a + 1e-4);
        BELOW(fabsf(kit_velocity(&world, light).x - kit_velocity(&world, heavy).x), 0.1);
        BELOW(worst_of(&world, 1).overlap, 3e-3);
        kit_end(&world);
    }
}

/* A driven wheel, much heavier than the balls that jam under its paddles, stays on its axle. */
static void wheel_amid_balls(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.3f);
    for (int side = -1; side < 2; side += 2) {
        talus_shape_def wall = kit_box_def(0.5f, 4.0f, 1.0f);
        wall.pose.position = kit_vec(2.2f * (float)side, 4.0f, 0.0f);
        kit_shape(&world, talus_world_ground(&world), &wall);
    }
    talus_body wheel = box_of(&world, kit_vec(0.0f, 1.6f, 0.0f), kit_vec(1.2f, 0.08f, 0.4f), 0.3f);
    talus_shape_def paddle = kit_box_def(0.08f, 1.2f, 0.4f);
    kit_shape(&world, wheel, &paddle);
    set_mass(&world, wheel, 100.0f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.b = wheel;
    def.frame_a.position = kit_vec(0.0f, 1.6f, 0.0f);
    def.frame_a.rotation = def.frame_b.rotation = x_to_z();
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].velocity_target = 5.0f, def.angular_drive[0].damping = 1e6f;
    def.angular_drive[0].max_force = 5000.0f;
    join(&world, &def);
    for (int i = 0; i < 40; i++) {
        talus_vec3 at = kit_vec(0.4f * (float)(i % 8) - 1.4f, 3.0f + 0.4f * (float)(i / 8), 0.0f);
        OK(talus_body_set_locks(&world, ball_of(&world, at, 0.18f, 2.0f, 0.0f, 0.3f), talus_lock_plane(2)));
    }
    BELOW(worst_of(&world, 300).joint_linear, 1e-5);
    assert_true(kit_spin(&world, wheel).z > 4.0f);
    kit_end(&world);
}

/* What is alike, and what is heavy but bears nothing, is no press. */
static void none(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.6f);
    column_of(&world, 0.0f, 1.0f, 0.0f);
    talus_body heavy = block_of(&world, kit_vec(5.0f, 0.5f, 0.0f), cube(), 1e5f, 0.6f);
    block_of(&world, kit_vec(5.0f, 1.5f, 0.0f), cube(), 100.0f, 0.6f);
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts_pressed, 0);
    }
    BELOW(fabsf(kit_place(&world, heavy).y - 0.5f), 5e-3);
    kit_end(&world);
}

/* A hundred and sixty-nine boxes under one slab are more than there is room for: they are swept as all else. */
static void too_many(void **state) {
    (void)state;
    talus_world_def def = talus_world_def_default();
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    floor_of(&world, 0.6f);
    for (int i = 0; i < 169; i++) {
        talus_vec3 at = kit_vec(0.3f * (float)(i % 13), 0.1f, 0.3f * (float)(i / 13));
        block_of(&world, at, kit_vec(0.1f, 0.1f, 0.1f), 8.0f, 0.6f);
    }
    talus_body top = block_of(&world, kit_vec(1.8f, 0.45f, 1.8f), kit_vec(2.5f, 0.25f, 2.5f), 40000.0f, 0.6f);
    uint32_t left = 0;
    for (int i = 0; i < 120; i++) {
        kit_steps(&world, 1);
        left += kit_counters(&world).contacts_left;
        assert_int_equal(kit_counters(&world).contacts_pressed, 0);
    }
    assert_true(left > 0);
    assert_true(kit_place(&world, top).y > 0.3f);
    OK(talus_world_validate(&world));
    kit_end(&world);
}

/* Which contacts are pressed follows from the state: a world that was restored goes on the same way. */
static void restored(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.gravity = kit_vec(0.0f, (float)-G, 0.0f);
    talus_world world = kit_world(&def), other = kit_world(&def);
    floor_of(&world, 0.6f);
    column_of(&world, 0.0f, 200.0f, 0.05f);
    kit_steps(&world, 20);
    assert_int_equal(kit_counters(&world).contacts_pressed, 5);
    move_to_scalar(&world, &other);
    for (int i = 0; i < 60; i++) {
        step_alike(&world, &other);
        assert_int_equal(kit_counters(&other).contacts_pressed, kit_counters(&world).contacts_pressed);
    }
    kit_end(&world);
    kit_end(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns),
        cmocka_unit_test(slab),
        cmocka_unit_test(blow),
        cmocka_unit_test(slope),
        cmocka_unit_test(wheel_amid_balls),
        cmocka_unit_test(none),
        cmocka_unit_test(too_many),
        cmocka_unit_test(restored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
