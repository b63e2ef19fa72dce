/* Sleep: who falls asleep with whom, who does not, who wakes. */
#include "store_check.h"

static talus_world floor_world(void) {
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    return world;
}

/* Two towers: each sleeps and wakes as one. */
static void towers_apart(void **state) {
    (void)state;
    talus_world world = floor_world();
    talus_body body[2][4];
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 4; i++) {
            body[t][i] = kit_box(&world, kit_vec(6.0f * (float)t, 0.25f + 0.5f * (float)i, 0.0f), 0.25f);
        }
    }
    kit_steps(&world, 240);
    check_store(&world);
    assert_int_equal(kit_counters(&world).sleeping_bodies, 8);
    assert_int_equal(kit_counters(&world).awake_bodies, 0);
    uint64_t hash = 0;
    talus_vec3 at = kit_place(&world, body[0][3]);
    /* Nothing of a sleeping world changes but the count of its steps. */
    const tl_header *h = tl_header_of(&world);
    size_t size = (size_t)h->units * TL_UNIT;
    talus_world copy = world;
    copy.block = kit_alloc(size);
    memcpy(copy.block, world.block, size);
    kit_steps(&world, 300);
    assert_int_equal(kit_counters(&world).contacts_sleeping, (int)h->contacts.used);
    tl_header_of(&copy)->steps_low = h->steps_low;
    talus_parting d;
    assert_int_equal(talus_world_part(&world, &copy, 0, &d), 0);
    hash = talus_world_hash(&world);
    assert_true(hash == talus_world_hash(&copy));
    kit_end(&copy);
    OK(talus_body_wake(&world, body[1][0]));
    check_store(&world);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(talus_body_is_awake(&world, body[0][i]), 0);
        assert_int_equal(talus_body_is_awake(&world, body[1][i]), 1);
    }
    kit_steps(&world, 240);
    assert_int_equal(kit_counters(&world).sleeping_bodies, 8);
    talus_vec3 now = kit_place(&world, body[0][3]);
    assert_memory_equal(&at, &now, sizeof at);
    OK(talus_body_apply_impulse(&world, body[0][0], kit_vec(0.0f, 0.0f, 1.0f), kit_place(&world, body[0][0])));
    assert_int_equal(talus_body_is_awake(&world, body[0][3]), 1);
    kit_end(&world);
}

/* A ball that falls on one of two wakes that one and what it touches, not the other. */
static void a_blow_wakes(void **state) {
    (void)state;
    talus_world world = floor_world();
    talus_body a = kit_box(&world, kit_vec(0.0f, 0.25f, 0.0f), 0.25f),
               b = kit_box(&world, kit_vec(0.0f, 0.75f, 0.0f), 0.25f);
    talus_body c = kit_box(&world, kit_vec(5.0f, 0.25f, 0.0f), 0.25f);
    kit_steps(&world, 120);
    assert_int_equal(kit_counters(&world).awake_bodies, 0);
    kit_ball(&world, kit_vec(0.0f, 3.0f, 0.0f), 0.2f);
    int woke = 0;
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        check_store(&world);
        woke |= talus_body_is_awake(&world, a) && talus_body_is_awake(&world, b);
        assert_int_equal(talus_body_is_awake(&world, c), 0);
    }
    assert_true(woke);
    kit_end(&world);
}

/* On a slope a little above the angle of friction a box gains speed slowly; it must not be taken as at rest. */
static void slow_start_is_no_rest(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double angle = atan(0.5) + 0.002 + 0.003 * i;
        talus_world_def def = kit_small();
        def.gravity = kit_vec((float)(9.81 * sin(angle)), (float)(-9.81 * cos(angle)), 0.0f);
        talus_world world = kit_world(&def);
        talus_shape_def ground = kit_box_def(500.0f, 1.0f, 50.0f);
        ground.pose.position.y = -1.0f;
        kit_shape(&world, talus_world_ground(&world), &ground);
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.2f, 0.0f));
        talus_shape_def box = kit_box_def(0.5f, 0.2f, 0.5f);
        kit_shape(&world, body, &box);
        for (int k = 0; k < 600; k++) {
            kit_steps(&world, 1);
            assert_int_equal(talus_body_is_awake(&world, body), 1);
        }
        const double a = 9.81 * (sin(angle) - 0.5 * cos(angle));
        NEAR(kit_velocity(&world, body).x, 10.0 * a, 0.1 * 10.0 * a + 0.02);
        kit_end(&world);
    }
}

/* What may not sleep keeps its island awake; a moving kinematic body does too, a still one does not. */
static void who_keeps_awake(void **state) {
    (void)state;
    talus_world world = floor_world();
    talus_body_def def = talus_body_def_default();
    talus_body restless, platform;
    def.type = TALUS_DYNAMIC;
    def.can_sleep = 0;
    def.pose.position = kit_vec(0.0f, 0.25f, 0.0f);
    OK(talus_body_create(&world, &def, &restless));
    talus_shape_def shape = kit_box_def(0.25f, 0.25f, 0.25f);
    kit_shape(&world, restless, &shape);
    talus_body above = kit_box(&world, kit_vec(0.0f, 0.75f, 0.0f), 0.25f);
    def = talus_body_def_default();
    def.type = TALUS_KINEMATIC;
    def.pose.position = kit_vec(8.0f, 1.0f, 0.0f);
    def.linear_velocity.x = 0.01f;
    OK(talus_body_create(&world, &def, &platform));
    shape = kit_box_def(1.0f, 0.2f, 1.0f);
    kit_shape(&world, platform, &shape);
    talus_body carried = kit_box(&world, kit_vec(8.0f, 1.45f, 0.0f), 0.25f);
    kit_steps(&world, 240);
    assert_int_equal(talus_body_is_awake(&world, restless), 1);
    assert_int_equal(talus_body_is_awake(&world, above), 1);
    assert_int_equal(talus_body_is_awake(&world, carried), 1);
    OK(talus_body_set_velocity(&world, platform, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 240);
    check_store(&world);
    assert_int_equal(talus_body_is_awake(&world, platform), 0);
    assert_int_equal(talus_body_is_awake(&world, carried), 0);
    OK(talus_body_set_velocity(&world, platform, kit_vec(0.5f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    assert_int_equal(talus_body_is_awake(&world, carried), 1);
    kit_steps(&world, 120);
    NEAR(kit_velocity(&world, carried).x, 0.5, 1e-3);
    kit_end(&world);
}

/* A joint makes one island of two that do not touch. */
static void joints_tie(void **state) {
    (void)state;
    talus_world world = floor_world();
    talus_body a = kit_box(&world, kit_vec(0.0f, 0.25f, 0.0f), 0.25f),
               b = kit_box(&world, kit_vec(3.0f, 0.25f, 0.0f), 0.25f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_distance(&def, 0.0f, 5.0f);
    def.a = a, def.b = b;
    talus_joint joint;
    OK(talus_joint_create(&world, &def, &joint));
    kit_steps(&world, 240);
    assert_int_equal(kit_counters(&world).sleeping_bodies, 2);
    assert_int_equal(kit_counters(&world).joints_sleeping, 1);
    OK(talus_body_wake(&world, a));
    assert_int_equal(talus_body_is_awake(&world, b), 1);
    OK(talus_body_sleep(&world, b));
    check_store(&world);
    assert_int_equal(talus_body_is_awake(&world, a), 0);
    OK(talus_joint_destroy(&world, joint));
    assert_int_equal(talus_body_is_awake(&world, a) && talus_body_is_awake(&world, b), 1);
    kit_steps(&world, 240);
    OK(talus_body_wake(&world, a));
    assert_int_equal(talus_body_is_awake(&world, b), 0);
    kit_end(&world);
}

/* Taking away what a sleeper lies on wakes it. */
static void the_ground_goes(void **state) {
    (void)state;
    talus_world world = floor_world();
    talus_body table = kit_body(&world, TALUS_STATIC, kit_vec(0.0f, 1.0f, 0.0f));
    talus_shape_def shape = kit_box_def(1.0f, 0.1f, 1.0f);
    talus_shape top = kit_shape(&world, table, &shape);
    talus_body box = kit_box(&world, kit_vec(0.0f, 1.35f, 0.0f), 0.25f);
    kit_steps(&world, 120);
    assert_int_equal(talus_body_is_awake(&world, box), 0);
    OK(talus_shape_destroy(&world, top));
    assert_int_equal(talus_body_is_awake(&world, box), 1);
    kit_steps(&world, 120);
    NEAR(kit_place(&world, box).y, 0.25, 5e-3);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(towers_apart),    cmocka_unit_test(a_blow_wakes), cmocka_unit_test(slow_start_is_no_rest),
        cmocka_unit_test(who_keeps_awake), cmocka_unit_test(joints_tie),   cmocka_unit_test(the_ground_goes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
