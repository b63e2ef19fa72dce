/* Joints through the API: what is refused, what is told back, what breaks. */
#include "store_check.h"

static talus_world two_bodies(talus_body *a, talus_body *b) {
    talus_world world = kit_void();
    *a = kit_box(&world, kit_vec(-1.0f, 0.0f, 0.0f), 0.4f);
    *b = kit_box(&world, kit_vec(1.0f, 0.0f, 0.0f), 0.4f);
    return world;
}

static void refusals(void **state) {
    (void)state;
    talus_body a, b, gone, null = {0, 0};
    talus_world world = two_bodies(&a, &b);
    talus_joint joint;
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.a = a, def.b = b;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, NULL, &joint));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, NULL));
    def.b = a;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, &joint));
    def.a = def.b = null;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, &joint));
    gone = kit_box(&world, kit_vec(9.0f, 0.0f, 0.0f), 0.4f);
    OK(talus_body_destroy(&world, gone));
    def.a = a, def.b = gone;
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_create(&world, &def, &joint));
    def.b = b;
    talus_joint_def good = def;
    float *numbers[] = {&def.frame_a.position.x,
                        &def.frame_b.rotation.y,
                        &def.angular[1].lower,
                        &def.linear[0].stiffness,
                        &def.linear_drive[1].stiffness,
                        &def.angular_drive[2].damping,
                        &def.linear_drive[0].velocity_target,
                        &def.angular_drive[0].position_target,
                        &def.break_force,
                        &def.break_torque};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        const float bad[] = {NAN, INFINITY, -INFINITY};
        for (int k = 0; k < 3; k++) {
            def = good;
            *numbers[i] = bad[k];
            REFUSED(&world, TALUS_NOT_FINITE, talus_joint_create(&world, &def, &joint));
        }
    }
    def = good;
    def.angular[0].mode = TALUS_AXIS_LIMITED;
    def.angular[0].lower = 1.0f, def.angular[0].upper = 0.5f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, &joint));
    def = good;
    def.linear[0].mode = TALUS_AXIS_MODE_COUNT;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, &joint));
    def = good;
    def.linear_drive[0].stiffness = -1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &def, &joint));
    def = good;
    OK(talus_joint_create(&world, &def, &joint));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_linear_drive(&world, joint, 3, &def.linear_drive[0]));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_linear_drive(&world, joint, -1, &def.linear_drive[0]));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_angular_drive(&world, joint, 0, NULL));
    OK(talus_joint_destroy(&world, joint));
    assert_int_equal(talus_joint_is_valid(&world, joint), 0);
    talus_vec3 f, t;
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_destroy(&world, joint));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_get_def(&world, joint, &def));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_get_reaction(&world, joint, &f, &t));
    check_store(&world);
    kit_end(&world);
}

static void full(void **state) {
    (void)state;
    talus_world_def wd = kit_small();
    wd.joint_capacity = 3;
    talus_world world = kit_world(&wd);
    talus_body a = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.4f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint joint[3], more;
    talus_joint_make_ball(&def);
    def.b = a;
    for (int i = 0; i < 3; i++) {
        OK(talus_joint_create(&world, &def, &joint[i]));
    }
    REFUSED(&world, TALUS_FULL_JOINTS, talus_joint_create(&world, &def, &more));
    OK(talus_joint_destroy(&world, joint[1]));
    OK(talus_joint_create(&world, &def, &more));
    assert_true(more.index == joint[1].index && more.generation != joint[1].generation);
    assert_int_equal(talus_joint_is_valid(&world, joint[1]), 0);
    kit_end(&world);
}

/* What was given is told back. */
static void told_back(void **state) {
    (void)state;
    talus_body a, b;
    talus_world world = two_bodies(&a, &b);
    talus_joint_def def = talus_joint_def_default(), back;
    talus_joint joint;
    talus_joint_make_prismatic(&def);
    def.a = a, def.b = b;
    def.frame_a = kit_pose(1.0f, 0.5f, 0.25f), def.frame_b = kit_pose(-1.0f, 0.5f, 0.25f);
    def.linear[0].mode = TALUS_AXIS_LIMITED;
    def.linear[0].lower = -1.0f, def.linear[0].upper = 2.0f, def.linear[0].stiffness = 3.0f,
    def.linear[0].damping = 4.0f;
    def.linear_drive[0].enabled = 1, def.linear_drive[0].acceleration = 1;
    def.linear_drive[0].position_target = 0.5f, def.linear_drive[0].velocity_target = 0.25f;
    def.linear_drive[0].stiffness = 5.0f, def.linear_drive[0].damping = 6.0f, def.linear_drive[0].max_force = 7.0f;
    def.cone_axis = 1, def.cone_angle = 0.5f;
    def.break_force = 100.0f, def.break_torque = 200.0f;
    def.collide_connected = 1;
    def.user_data = 0x123456789abcdefu;
    OK(talus_joint_create(&world, &def, &joint));
    OK(talus_joint_get_def(&world, joint, &back));
    assert_memory_equal(&back.frame_a, &def.frame_a, sizeof def.frame_a);
    assert_memory_equal(&back.frame_b, &def.frame_b, sizeof def.frame_b);
    assert_memory_equal(back.linear, def.linear, sizeof def.linear);
    assert_memory_equal(back.angular, def.angular, sizeof def.angular);
    for (int k = 0; k < 3; k++) {
        assert_true(back.linear_drive[k].stiffness == def.linear_drive[k].stiffness);
        assert_true(back.linear_drive[k].max_force == def.linear_drive[k].max_force);
        assert_true(back.linear_drive[k].enabled == def.linear_drive[k].enabled);
        assert_true(back.angular_drive[k].enabled == 0);
    }
    assert_true(back.a.index == a.index && back.a.generation == a.generation && back.b.index == b.index);
    assert_true(back.cone_axis == 1 && back.cone_angle == 0.5f && back.collide_connected == 1);
    assert_true(back.break_force == 100.0f && back.break_torque == 200.0f && back.user_data == def.user_data);
    def.linear_drive[0].position_target = 0.75f;
    OK(talus_joint_set_linear_drive(&world, joint, 0, &def.linear_drive[0]));
    OK(talus_joint_get_def(&world, joint, &back));
    assert_true(back.linear_drive[0].position_target == 0.75f);
    kit_end(&world);
}

/* Joined bodies pass through each other unless asked to collide, and collide again when the joint is gone. */
static void joined_do_not_collide(void **state) {
    (void)state;
    for (int collide = 0; collide < 2; collide++) {
        talus_world world = kit_void();
        talus_body a = kit_ball(&world, kit_vec(-0.3f, 0.0f, 0.0f), 0.5f),
                   b = kit_ball(&world, kit_vec(0.3f, 0.0f, 0.0f), 0.5f);
        talus_joint_def def = talus_joint_def_default();
        talus_joint joint;
        talus_joint_make_distance(&def, 0.0f, 3.0f);
        def.a = a, def.b = b;
        def.collide_connected = (uint8_t)collide;
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts.used, 1);
        OK(talus_joint_create(&world, &def, &joint));
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts.used, collide);
        check_store(&world);
        OK(talus_joint_destroy(&world, joint));
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts.used, 1);
        check_store(&world);
        kit_end(&world);
    }
}

/* A body's end ends its joints; those of the others stay. */
static void end_of_a_body(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body[5];
    talus_joint joint[4];
    for (int i = 0; i < 5; i++) {
        body[i] = kit_box(&world, kit_vec(2.0f * (float)i, 0.0f, 0.0f), 0.4f);
        if (i) {
            talus_joint_def def = talus_joint_def_default();
            talus_joint_make_ball(&def);
            def.a = body[i - 1], def.b = body[i];
            def.frame_a.position.x = 1.0f, def.frame_b.position.x = -1.0f;
            OK(talus_joint_create(&world, &def, &joint[i - 1]));
        }
    }
    OK(talus_body_destroy(&world, body[2]));
    check_store(&world);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(talus_joint_is_valid(&world, joint[i]), i == 0 || i == 3);
    }
    kit_steps(&world, 10);
    check_store(&world);
    kit_end(&world);
}

/* A joint without anything held has no rows and changes nothing. */
static void nothing_held(void **state) {
    (void)state;
    talus_body a, b;
    talus_world world = two_bodies(&a, &b);
    talus_joint_def def = talus_joint_def_default();
    talus_joint joint;
    def.a = a, def.b = b;
    OK(talus_joint_create(&world, &def, &joint));
    OK(talus_body_set_velocity(&world, a, kit_vec(0.0f, 1.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 60);
    NEAR(kit_place(&world, a).y, 1.0, 1e-4);
    NEAR(kit_place(&world, b).y, 0.0, 0.0);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refusals),      cmocka_unit_test(full),
        cmocka_unit_test(told_back),     cmocka_unit_test(joined_do_not_collide),
        cmocka_unit_test(end_of_a_body), cmocka_unit_test(nothing_held),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
