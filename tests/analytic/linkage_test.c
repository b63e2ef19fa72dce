/* Joints that hang together: rigid, whatever hangs on them. */
#include "analytic_kit.h"

/* Twenty links of 1 kg and a ball of 100 kg, let go level. Links lie apart from each other and do not collide. */
static void hang_chain(talus_world *world, float z, int links, talus_body *ball) {
    talus_body before = {0, 0};
    for (int i = 0; i < links; i++) {
        talus_body link = box_of(world, kit_vec(0.25f + 0.5f * (float)i, 0.0f, z), kit_vec(0.2f, 0.05f, 0.05f), 0.5f);
        set_mass(world, link, 1.0f);
        pin(world, before, link, kit_vec(0.5f * (float)i, 0.0f, z), 0);
        before = link;
    }
    *ball = ball_of(world, kit_vec(0.5f * (float)links, 0.0f, z), 0.2f, 100.0f, 0.0f, 0.5f);
    pin(world, before, *ball, kit_vec(0.5f * (float)links, 0.0f, z), 0);
}

static void chain_with_a_heavy_end(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body ball;
    hang_chain(&world, 0.0f, 20, &ball);
    BELOW(worst_of(&world, 600).joint_linear, 1e-3);
    assert_int_equal(kit_counters(&world).linkages, 1);
    assert_int_equal(kit_counters(&world).joints_apart, 0);
    talus_vec3 at = kit_place(&world, ball);
    BELOW(fmaxf(kit_length(at) - 10.0f, 0.0f), 5e-3);
    kit_end(&world);
}

/* Eight alike are solved side by side, one alone by itself: the same way but for rounding. */
static void alike_and_alone(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.joint_capacity = 64, def.enable_sleep = 0;
    talus_world one = kit_world(&def), many = kit_world(&def);
    talus_body ball, balls[7];
    hang_chain(&one, 0.0f, 4, &ball);
    for (int i = 0; i < 7; i++) {
        hang_chain(&many, 3.0f * (float)i, 4, &balls[i]);
    }
    kit_steps(&one, 60), kit_steps(&many, 60);
    assert_int_equal(kit_counters(&one).linkages, 1);
    assert_int_equal(kit_counters(&many).linkages, 1);
    for (int i = 0; i < 7; i++) {
        talus_vec3 a = kit_place(&one, ball), b = kit_place(&many, balls[i]);
        CLOSE(b.x, a.x, 1e-3);
        CLOSE(b.y, a.y, 1e-3);
        CLOSE(b.z - 3.0f * (float)i, a.z, 1e-3);
    }
    kit_end(&one);
    kit_end(&many);
}

/* Planks on hinges, hung by a bar at either end, and a weight on them: rows of which three too many say the same. */
static void bridge_under_a_weight(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body none = {0, 0}, before = none;
    talus_vec3 bar = kit_vec(0.05f, 0.4f, 0.5f);
    const float length = 10.0f;
    talus_body left = box_of(&world, kit_vec(0.0f, 0.5f, 0.0f), bar, 0.6f);
    talus_body right = box_of(&world, kit_vec(length, 0.5f, 0.0f), bar, 0.6f);
    pin(&world, none, left, kit_vec(0.0f, 1.0f, 0.0f), 1);
    before = left;
    for (float x = 0.0f; x < length - 0.25f; x += 0.5f) {
        talus_body plank = box_of(&world, kit_vec(x + 0.25f, 0.0f, 0.0f), kit_vec(0.19f, 0.05f, 1.0f), 0.6f);
        set_mass(&world, plank, 50.0f);
        pin(&world, before, plank, kit_vec(x, 0.0f, 0.0f), 1);
        before = plank;
    }
    pin(&world, before, right, kit_vec(length, 0.0f, 0.0f), 1);
    pin(&world, none, right, kit_vec(length, 1.0f, 0.0f), 1);
    talus_body box = box_of(&world, kit_vec(5.0f, 0.6f, 0.0f), kit_vec(0.4f, 0.4f, 0.4f), 0.6f);
    set_mass(&world, box, 500.0f);
    BELOW(worst_of(&world, 300).joint_linear, 5e-3);
    assert_int_equal(kit_counters(&world).linkages, 1);
    talus_vec3 at = kit_place(&world, box);
    assert_true(at.y < 0.45f && at.y > -5.0f); /* it bears the box */
    kit_end(&world);
}

/* Strung straight from place to place: rigid, it could not sag at all, and no force short of an infinite one would keep
 * it up. It has to give a little, and to come to rest. */
static void taut_bridge(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body none = {0, 0}, before = none, planks[24], boxes[4];
    for (int i = 0; i < 24; i++) {
        talus_vec3 at = kit_vec(0.6f * (float)i + 0.3f, 0.0f, 0.0f);
        planks[i] = box_of(&world, at, kit_vec(0.28f, 0.05f, 1.0f), 0.6f);
        pin(&world, before, planks[i], kit_vec(0.6f * (float)i, 0.0f, 0.0f), 1);
        before = planks[i];
    }
    pin(&world, before, none, kit_vec(0.6f * 24.0f, 0.0f, 0.0f), 1);
    for (int i = 0; i < 4; i++) {
        boxes[i] = box_of(&world, kit_vec(5.0f + 1.5f * (float)i, 1.0f, 0.0f), kit_vec(0.4f, 0.4f, 0.4f), 0.6f);
        set_mass(&world, boxes[i], 500.0f);
    }
    BELOW(worst_of(&world, 600).joint_linear, 2e-3);
    assert_int_equal(kit_counters(&world).linkages, 1);
    float fastest = 0.0f, lowest = 0.0f;
    for (int i = 0; i < 28; i++) {
        talus_body body = i < 24 ? planks[i] : boxes[i - 24];
        fastest = fmaxf(fastest, kit_length(kit_velocity(&world, body)));
        lowest = fminf(lowest, kit_place(&world, body).y);
    }
    BELOW(fastest, 0.5);
    assert_true(lowest > -1.0f && lowest < 0.0f);
    kit_end(&world);
}

/* A parallelogram of three bars and the ground: a ring of hinges, which leaves one motion. Its coupler stays level and
 * moves on a circle of the cranks' length. */
static void four_bars(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body none = {0, 0};
    talus_vec3 thin = kit_vec(0.05f, 0.45f, 0.05f), wide = kit_vec(0.9f, 0.05f, 0.05f);
    talus_body left = box_of(&world, kit_vec(0.0f, -0.5f, 0.0f), thin, 0.5f);
    talus_body right = box_of(&world, kit_vec(2.0f, -0.5f, 0.0f), thin, 0.5f);
    talus_body coupler = box_of(&world, kit_vec(1.0f, -1.0f, 0.0f), wide, 0.5f);
    pin(&world, none, left, kit_vec(0.0f, 0.0f, 0.0f), 1);
    pin(&world, none, right, kit_vec(2.0f, 0.0f, 0.0f), 1);
    pin(&world, left, coupler, kit_vec(0.0f, -1.0f, 0.0f), 1);
    pin(&world, right, coupler, kit_vec(2.0f, -1.0f, 0.0f), 1);
    OK(talus_body_set_velocity(&world, coupler, kit_vec(3.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    float worst = 0.0f, level = 0.0f, circle = 0.0f, far = 0.0f;
    for (int i = 0; i < 600; i++) {
        worst = fmaxf(worst, worst_of(&world, 1).joint_linear);
        talus_vec3 at = kit_place(&world, coupler);
        talus_pose pose;
        OK(talus_body_get_pose(&world, coupler, &pose));
        level = fmaxf(level, fabsf(pose.rotation.z));
        circle = fmaxf(circle, fabsf(hypotf(at.x - 1.0f, at.y) - 1.0f));
        far = fmaxf(far, fabsf(at.x - 1.0f));
    }
    assert_int_equal(kit_counters(&world).linkages, 1);
    BELOW(worst, 1e-3);
    BELOW(level, 1e-3);
    BELOW(circle, 1e-3);
    assert_true(far > 0.3f); /* it swings */
    kit_end(&world);
}

/* A door on two hinges, ten rows for five: it swings as on one, and the hinges do not quarrel. */
static void door_on_two_hinges(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, 0.0f, (float)-G); /* the hinges are upright, along z */
    talus_body none = {0, 0};
    talus_body door = box_of(&world, kit_vec(0.5f, 0.0f, 1.0f), kit_vec(0.45f, 0.03f, 0.95f), 0.5f);
    pin(&world, none, door, kit_vec(0.0f, 0.0f, 0.2f), 1);
    talus_joint upper = pin(&world, none, door, kit_vec(0.0f, 0.0f, 1.8f), 1);
    /* w = 2 about the hinges */
    OK(talus_body_set_velocity(&world, door, kit_vec(0.0f, 1.0f, 0.0f), kit_vec(0.0f, 0.0f, 2.0f)));
    BELOW(worst_of(&world, 600).joint_linear, 1e-3);
    CLOSE(kit_spin(&world, door).z, 2.0f, 0.02f);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, upper, &force, &torque));
    talus_mass mass;
    OK(talus_body_get_mass(&world, door, &mass));
    assert_true(kit_length(force) < 2.0f * mass.mass * (float)G);
    kit_end(&world);
}

/* Joints that end on the way leave the rest as it was. */
static void joints_that_end(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body before = {0, 0};
    talus_joint joints[12];
    for (int i = 0; i < 12; i++) {
        talus_body ball = ball_of(&world, kit_vec(0.5f * (float)i + 0.5f, 0.0f, 0.0f), 0.1f, 1.0f, 0.0f, 0.5f);
        joints[i] = pin(&world, before, ball, kit_vec(0.5f * (float)i, 0.0f, 0.0f), 0);
        before = ball;
    }
    for (int i = 11; i > 0; i -= 2) {
        BELOW(worst_of(&world, 30).joint_linear, 1e-3);
        OK(talus_joint_destroy(&world, joints[i / 2]));
    }
    BELOW(worst_of(&world, 30).joint_linear, 1e-3);
    kit_end(&world);
}

/* Thirty balls on one: every joint is tied to every other, and they are solved one by one. */
static void too_much_on_one_body(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, 0.0f, 0.0f);
    talus_body hub = ball_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f, 10.0f, 0.0f, 0.5f);
    for (int i = 0; i < 30; i++) {
        talus_vec3 out = kit_vec((float)cos(0.2 * (double)i), (float)sin(0.2 * (double)i), 0.0f);
        talus_body ball = ball_of(&world, out, 0.05f, 0.1f, 0.0f, 0.5f);
        pin(&world, hub, ball, out, 0);
    }
    kit_steps(&world, 1);
    assert_int_equal(kit_counters(&world).linkages, 0);
    assert_int_equal(kit_counters(&world).joints_apart, 30);
    BELOW(worst_of(&world, 60).joint_linear, 1e-3);
    kit_end(&world);
}

/* The last of an arm's four light limbs is struck and whirls about its joint, up to two radians in a sub-step: it holds
 * together all the same. */
static void arm_that_whirls(void **state) {
    (void)state;
    for (int i = 0; i < 12; i++) {
        talus_world world = world_of(0.0f, 0.0f, 0.0f);
        talus_body before = {0, 0};
        for (int k = 0; k < 4; k++) {
            float x = 0.3f * (float)k;
            talus_body limb = box_of(&world, kit_vec(x, 0.0f, 0.0f), kit_vec(0.08f, 0.05f, 0.05f), 0.5f);
            if (k > 0) {
                pin(&world, before, limb, kit_vec(x - 0.15f, 0.0f, 0.0f), 0);
            }
            before = limb;
        }
        set_velocity(&world, before, kit_vec(0.0f, 0.0f, 0.0f),
                     kit_vec(0.0f, 40.0f * (float)(i % 2), 130.0f + 30.0f * (float)i));
        BELOW(worst_of(&world, 60).joint_linear, 2e-3);
        kit_end(&world);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chain_with_a_heavy_end),
        cmocka_unit_test(alike_and_alone),
        cmocka_unit_test(bridge_under_a_weight),
        cmocka_unit_test(taut_bridge),
        cmocka_unit_test(four_bars),
        cmocka_unit_test(door_on_two_hinges),
        cmocka_unit_test(joints_that_end),
        cmocka_unit_test(too_much_on_one_body),
        cmocka_unit_test(arm_that_whirls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
