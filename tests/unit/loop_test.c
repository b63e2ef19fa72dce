/* The fixed-timestep driver and the poses between two steps. */
#include "world_kit.h"

static void bad_arguments(void **state) {
    (void)state;
    talus_loop loop, kept;
    uint32_t steps = 77;
    OK(talus_loop_init(&loop, 0.5f, 3));
    kept = loop;
    assert_int_equal(talus_loop_init(NULL, 0.5f, 3), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_init(&loop, 0.0f, 3), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_init(&loop, -0.5f, 3), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_init(&loop, 1.01f, 3), TALUS_BAD_ARGUMENT);
    assert_int_not_equal(talus_loop_init(&loop, NAN, 3), TALUS_OK);
    assert_int_equal(talus_loop_init(&loop, 0.5f, 0), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_advance(NULL, 0.5, &steps), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_advance(&loop, 0.5, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_advance(&loop, -0.5, &steps), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_loop_advance(&loop, (double)NAN, &steps), TALUS_NOT_FINITE);
    assert_int_equal(talus_loop_advance(&loop, (double)INFINITY, &steps), TALUS_NOT_FINITE);
    assert_memory_equal(&loop, &kept, sizeof loop);
    assert_int_equal(steps, 77);
}

/* Times of powers of two, in which nothing is rounded. */
static void time_is_kept(void **state) {
    (void)state;
    talus_loop loop;
    uint32_t steps;
    OK(talus_loop_init(&loop, 0.25f, 4));
    OK(talus_loop_advance(&loop, 0.0, &steps));
    assert_int_equal(steps, 0);
    NEAR(loop.alpha, 0.0, 0.0);
    OK(talus_loop_advance(&loop, 0.125, &steps));
    assert_int_equal(steps, 0);
    NEAR(loop.alpha, 0.5, 0.0);
    OK(talus_loop_advance(&loop, 0.125, &steps));
    assert_int_equal(steps, 1);
    NEAR(loop.alpha, 0.0, 0.0);
    OK(talus_loop_advance(&loop, 0.8125, &steps));
    assert_int_equal(steps, 3);
    NEAR(loop.alpha, 0.25, 0.0);
    OK(talus_loop_advance(&loop, 1.0, &steps));
    assert_int_equal(steps, 4);
    NEAR(loop.alpha, 0.25, 0.0);
    NEAR(loop.dropped, 0.0, 0.0);
}

static void what_is_too_late_is_dropped(void **state) {
    (void)state;
    talus_loop loop;
    uint32_t steps;
    OK(talus_loop_init(&loop, 0.25f, 4));
    OK(talus_loop_advance(&loop, 10.0625, &steps));
    assert_int_equal(steps, 4);
    NEAR(loop.dropped, 9.0, 0.0);
    NEAR(loop.accumulator, 0.0625, 0.0);
    NEAR(loop.alpha, 0.25, 0.0);
    OK(talus_loop_advance(&loop, 1e300, &steps)); /* seconds beyond counting */
    assert_int_equal(steps, 4);
    assert_true(loop.accumulator >= 0.0 && loop.accumulator < 0.25);
    assert_true(loop.alpha >= 0.0f && loop.alpha <= 1.0f);
    OK(talus_loop_init(&loop, 1e-30f, UINT32_MAX)); /* and steps */
    OK(talus_loop_advance(&loop, 1e-27, &steps));
    assert_true(steps >= 999u && steps <= 1001u);
}

/* Over many uneven frames no time is lost or won. */
static void sums_hold(void **state) {
    (void)state;
    talus_loop loop;
    double given = 0.0, taken = 0.0;
    uint32_t steps, random = 1;
    OK(talus_loop_init(&loop, 1.0f / 60.0f, 8));
    for (int i = 0; i < 100000; i++) {
        random = random * 1664525u + 1013904223u;
        double elapsed = (double)(random >> 16) * (0.25 / 65536.0); /* up to fifteen steps: some are dropped */
        OK(talus_loop_advance(&loop, elapsed, &steps));
        given += elapsed;
        taken += (double)steps * (double)loop.dt;
        assert_true(steps <= 8u);
        assert_true(loop.accumulator >= 0.0 && loop.accumulator < (double)loop.dt);
        assert_true(loop.alpha >= 0.0f && loop.alpha <= 1.0f);
    }
    assert_true(loop.dropped > 1.0);
    NEAR(taken + loop.accumulator + loop.dropped, given, 1e-6);
}

static void poses_between(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body_def def = talus_body_def_default();
    talus_body body, still;
    def.type = TALUS_DYNAMIC;
    def.linear_velocity = kit_vec(6.0f, 0.0f, 0.0f);
    def.angular_velocity = kit_vec(0.0f, 12.0f, 0.0f);
    OK(talus_body_create(&world, &def, &body));
    talus_shape_def ball = kit_ball_def(0.5f);
    ball.pose.position = kit_vec(0.25f, 0.0f, 0.0f); /* the centre of mass is not the origin */
    kit_shape(&world, body, &ball);
    OK(talus_body_set_velocity(&world, body, kit_vec(6.0f, 0.0f, 0.0f), kit_vec(0.0f, 12.0f, 0.0f)));
    still = kit_body(&world, TALUS_STATIC, kit_vec(1.0f, 2.0f, 3.0f));
    kit_steps(&world, 3);
    talus_pose before = kit_pose_of(&world, body), between, after;
    kit_steps(&world, 1);
    after = kit_pose_of(&world, body);
    OK(talus_body_get_interpolated_pose(&world, body, 0.0f, &between));
    NEAR(between.position.x, before.position.x, 1e-6);
    NEAR(between.position.z, before.position.z, 1e-6);
    NEAR(between.rotation.y, before.rotation.y, 1e-6);
    OK(talus_body_get_interpolated_pose(&world, body, 1.0f, &between));
    NEAR(between.position.x, after.position.x, 1e-6);
    NEAR(between.position.z, after.position.z, 1e-6);
    NEAR(between.rotation.y, after.rotation.y, 1e-6);
    for (int i = 0; i <= 8; i++) { /* the angle grows evenly, the centre goes straight on */
        float alpha = 0.125f * (float)i;
        OK(talus_body_get_interpolated_pose(&world, body, alpha, &between));
        double a0 = 2.0 * atan2((double)before.rotation.y, (double)before.rotation.w);
        double a1 = 2.0 * atan2((double)after.rotation.y, (double)after.rotation.w);
        double a = 2.0 * atan2((double)between.rotation.y, (double)between.rotation.w);
        NEAR(a, a0 + (double)alpha * (a1 - a0), 1e-5);
        double x0 = (double)before.position.x + 0.25 * cos(a0), x1 = (double)after.position.x + 0.25 * cos(a1);
        NEAR((double)between.position.x + 0.25 * cos(a), x0 + (double)alpha * (x1 - x0), 1e-5);
    }
    OK(talus_body_get_interpolated_pose(&world, still, 0.3f, &between));
    NEAR(between.position.y, 2.0f, 0.0);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_interpolated_pose(&world, body, 0.5f, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_interpolated_pose(&world, body, -0.1f, &between));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_interpolated_pose(&world, body, 1.1f, &between));
    assert_int_not_equal(talus_body_get_interpolated_pose(&world, body, NAN, &between), TALUS_OK);
    OK(talus_body_destroy(&world, body));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_interpolated_pose(&world, body, 0.5f, &between));
    kit_end(&world);
}

/* A body that was put elsewhere does not sweep through what lies between. */
static void no_sweep_after_a_jump(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_pose there = kit_pose(100.0f, 0.0f, 0.0f), between;
    kit_steps(&world, 1);
    OK(talus_body_set_pose(&world, body, &there));
    OK(talus_body_get_interpolated_pose(&world, body, 0.5f, &between));
    NEAR(between.position.x, 100.0, 0.0);
    kit_end(&world);
}

/* Half the sub-steps after a step that was late, twice as many after thirty that were quick, within what is wanted. */
static void sub_steps_follow_the_clock(void **state) {
    (void)state;
    const talus_accuracy wanted = {1e-3f, 3, 20};
    talus_time_budget b;
    talus_accuracy next;
    OK(talus_time_budget_init(&b, 0.25, &wanted));
    const struct {
        double took;
        int steps;
        uint32_t most;
    } runs[] = {{0.125, 60, 3}, {0.1, 29, 3},   {0.1, 1, 6},   {0.2, 60, 6}, {0.1, 30, 12}, {0.1, 30, 20},
                {0.1, 30, 20},  {0.25, 60, 20}, {0.26, 1, 10}, {0.26, 1, 5}, {9.0, 1, 3},   {9.0, 5, 3},
                {0.0, 29, 3},   {0.2, 1, 3},    {0.0, 29, 3},  {0.0, 1, 6}};
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        for (int k = 0; k < runs[i].steps; k++) {
            OK(talus_time_budget_advance(&b, runs[i].took, &next));
        }
        assert_int_equal(next.most_substeps, runs[i].most);
        assert_int_equal(next.substeps, 3);
        assert_true(next.error_budget == 1e-3f);
    }
}

static void bad_time_budgets(void **state) {
    (void)state;
    const talus_accuracy good = {1e-3f, 4, 32};
    const talus_accuracy bad[] = {{0.0f, 4, 32},  {-1.0f, 4, 32}, {1.5f, 4, 32},
                                  {1e-3f, 0, 32}, {1e-3f, 4, 3},  {1e-3f, 4, 65}};
    const double times[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    talus_accuracy next = {0.5f, 7, 9}, nan = good;
    talus_time_budget b, kept;
    nan.error_budget = NAN;
    OK(talus_time_budget_init(&b, 0.25, &good));
    kept = b;
    for (int i = 0; i < 6; i++) {
        assert_int_equal(talus_time_budget_init(&b, 0.25, &bad[i]), TALUS_BAD_ARGUMENT);
    }
    for (int i = 0; i < 3; i++) {
        assert_int_equal(talus_time_budget_init(&b, times[i], &good), TALUS_NOT_FINITE);
        assert_int_equal(talus_time_budget_advance(&b, times[i], &next), TALUS_NOT_FINITE);
    }
    assert_int_equal(talus_time_budget_init(&b, 0.25, &nan), TALUS_NOT_FINITE);
    assert_int_equal(talus_time_budget_init(&b, 0.0, &good), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_budget_init(NULL, 0.25, &good), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_budget_init(&b, 0.25, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_budget_advance(&b, -1e-9, &next), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_budget_advance(NULL, 0.1, &next), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_budget_advance(&b, 0.1, NULL), TALUS_BAD_ARGUMENT);
    assert_memory_equal(&b, &kept, sizeof b);
    assert_int_equal(next.most_substeps, 9);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_arguments),
        cmocka_unit_test(time_is_kept),
        cmocka_unit_test(what_is_too_late_is_dropped),
        cmocka_unit_test(sums_hold),
        cmocka_unit_test(poses_between),
        cmocka_unit_test(no_sweep_after_a_jump),
        cmocka_unit_test(sub_steps_follow_the_clock),
        cmocka_unit_test(bad_time_budgets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
