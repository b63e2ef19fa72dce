/* The errors that a world says it holds, against what is known of them. */
#include "world_kit.h"

/* Balls pressed into the floor by `depth` without gravity to move them: the overlap is that depth. */
static void overlap_is_the_depth(void **state) {
    (void)state;
    const float depths[] = {0.0f, 0.001f, 0.003f};
    for (int i = 0; i < 3; i++) {
        talus_world_def def = kit_small();
        def.gravity = kit_vec(0.0f, 0.0f, 0.0f);
        def.push_speed = 0.0f; /* nothing pushes it out */
        talus_world world = kit_world(&def);
        kit_floor(&world);
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.3f, 0.5f - depths[i], -0.2f));
        talus_shape_def ball = talus_shape_def_default();
        ball.geometry.type = TALUS_SPHERE;
        ball.geometry.radius = 0.5f;
        kit_shape(&world, body, &ball);
        kit_steps(&world, 2);
        talus_errors e;
        OK(talus_world_measure(&world, &e));
        NEAR(e.overlap, depths[i], 2e-6);
        kit_end(&world);
    }
}

static void joints_say_how_far_they_are(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_body body = kit_box(&world, kit_vec(0.0f, 3.0f, 0.0f), 0.5f);
    talus_joint_def joint_def = talus_joint_def_default();
    talus_joint_make_fixed(&joint_def);
    joint_def.b = body;
    joint_def.frame_a.position = kit_vec(0.0f, 3.0f, 0.0f);
    talus_joint joint;
    OK(talus_joint_create(&world, &joint_def, &joint));
    talus_errors e;
    OK(talus_world_measure(&world, &e));
    NEAR(e.joint_linear, 0.0, 1e-6);
    talus_pose away = kit_pose(0.03f, 3.04f, 0.0f);
    away.rotation.x = 0.05f, away.rotation.w = 0.99874921777f; /* 0.1 rad, nearly */
    OK(talus_body_set_pose(&world, body, &away));
    OK(talus_world_measure(&world, &e));
    NEAR(e.joint_linear, 0.05, 1e-6);
    NEAR(e.joint_angular, 0.10004172, 1e-5); /* 2 asin 0.05 */
    NEAR(e.overlap, 0.0, 0.0);
    assert_int_equal(talus_world_measure(&world, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_world_measure(NULL, &e), TALUS_BAD_ARGUMENT);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlap_is_the_depth),
        cmocka_unit_test(joints_say_how_far_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
