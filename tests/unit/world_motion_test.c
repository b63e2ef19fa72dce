/* How bodies move: free flight against closed forms, pushes, damping, locks, kinematic bodies, sleep. */
#include "world_kit.h"

#define G 9.81

static void a_fall_is_the_parabola(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_body body = kit_box(&world, kit_vec(1.0f, 100.0f, 0.0f), 0.5f);
    OK(talus_body_set_velocity(&world, body, kit_vec(3.0f, 4.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    for (int i = 1; i <= 120; i++) {
        kit_steps(&world, 1);
        double t = (double)i / 60.0;
        NEAR(kit_place(&world, body).x, 1.0 + 3.0 * t, 1e-4);
        NEAR(kit_place(&world, body).y, 100.0 + 4.0 * t - 0.5 * G * t * t, 1e-3);
        NEAR(kit_velocity(&world, body).y, 4.0 - G * t, 1e-3);
    }
    kit_end(&world);
}

static void gravity_scales(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    const float scales[4] = {0.0f, 1.0f, -1.0f, 2.5f};
    talus_body bodies[4];
    for (int i = 0; i < 4; i++) {
        bodies[i] = kit_box(&world, kit_vec(3.0f * (float)i, 0.0f, 0.0f), 0.5f);
        OK(talus_body_set_gravity_scale(&world, bodies[i], scales[i]));
    }
    kit_steps(&world, 60);
    for (int i = 0; i < 4; i++) {
        NEAR(kit_velocity(&world, bodies[i]).y, -G * (double)scales[i], 1e-3);
    }
    OK(talus_world_set_gravity(&world, kit_vec(2.0f, 0.0f, 0.0f)));
    kit_steps(&world, 60);
    NEAR(kit_velocity(&world, bodies[3]).x, 5.0, 1e-3);
    kit_end(&world);
}

static void forces_act_for_one_step(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f); /* 1000 kg, 1000/6 kg m^2 */
    OK(talus_body_apply_force(&world, body, kit_vec(6000.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    OK(talus_body_apply_force(&world, body, kit_vec(6000.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f))); /* they add up */
    kit_steps(&world, 1);
    NEAR(kit_velocity(&world, body).x, 0.2, 1e-6);
    kit_steps(&world, 1);
    NEAR(kit_velocity(&world, body).x, 0.2, 1e-6);
    NEAR(kit_place(&world, body).x, 0.2 / 120.0 + 0.2 / 60.0, 1e-6);
    OK(talus_body_apply_torque(&world, body, kit_vec(0.0f, 0.0f, 1000.0f)));
    kit_steps(&world, 1);
    NEAR(kit_spin(&world, body).z, 6.0 / 60.0, 1e-6);
    talus_vec3 at = kit_place(&world, body);
    at.x += 0.5f;
    OK(talus_body_apply_force(&world, body, kit_vec(0.0f, 1200.0f, 0.0f), at)); /* by a lever of half a metre */
    kit_steps(&world, 1);
    NEAR(kit_velocity(&world, body).y, 1.2 / 60.0, 1e-6);
    NEAR(kit_spin(&world, body).z, 0.1 + 600.0 / (1000.0 / 6.0) / 60.0, 1e-5);
    kit_end(&world);
}

static void impulses_act_at_once(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def def = kit_box_def(0.5f, 1.0f, 0.25f); /* 1000 kg */
    kit_shape(&world, body, &def);
    OK(talus_body_apply_impulse(&world, body, kit_vec(0.0f, 0.0f, 500.0f), kit_vec(0.5f, 0.0f, 0.0f)));
    NEAR(kit_velocity(&world, body).z, 0.5, 1e-6);
    double iy = 1000.0 / 3.0 * (0.25 + 0.0625), iz = 1000.0 / 3.0 * (0.25 + 1.0);
    NEAR(kit_spin(&world, body).y, -250.0 / iy, 1e-5);
    OK(talus_body_apply_angular_impulse(&world, body, kit_vec(0.0f, 0.0f, 100.0f)));
    NEAR(kit_spin(&world, body).z, 100.0 / iz, 1e-5);
    NEAR(kit_velocity(&world, body).z, 0.5, 1e-6);
    kit_end(&world);
}

static void damping_decays(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = TALUS_DYNAMIC;
    def.linear_velocity = kit_vec(10.0f, 0.0f, 0.0f);
    def.angular_velocity = kit_vec(0.0f, 10.0f, 0.0f);
    def.linear_damping = 1.0f, def.angular_damping = 0.5f;
    OK(talus_body_create(&world, &def, &body));
    kit_steps(&world, 60);
    NEAR(kit_velocity(&world, body).x, 10.0 * exp(-1.0), 0.03);
    NEAR(kit_spin(&world, body).y, 10.0 * exp(-0.5), 0.03);
    OK(talus_body_set_damping(&world, body, 0.0f, 1e30f)); /* none, and more than a step can take */
    kit_steps(&world, 60);
    NEAR(kit_velocity(&world, body).x, 10.0 * exp(-1.0), 0.03);
    NEAR(kit_spin(&world, body).y, 0.0, 1e-6);
    kit_end(&world);
}

/* Without torque the angular momentum and the energy stay: a box turned about its middle axis tumbles for a minute. */
static void free_spin_keeps_its_momentum(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def def = kit_box_def(0.1f, 0.3f, 0.6f);
    kit_shape(&world, body, &def);
    talus_mass mass;
    OK(talus_body_get_mass(&world, body, &mass));
    OK(talus_body_set_velocity(&world, body, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.01f, 8.0f, 0.02f)));
    double first = 0.0, energy = 0.0;
    for (int i = 0; i <= 3600; i++) {
        talus_quat q = kit_pose_of(&world, body).rotation;
        talus_vec3 w = kit_spin(&world, body);
        /* into the body's frame: v + 2 u x (u x v + s v) with u the conjugate's */
        double ux = -(double)q.x, uy = -(double)q.y, uz = -(double)q.z, s = (double)q.w;
        double cx = uy * (double)w.z - uz * (double)w.y + s * (double)w.x;
        double cy = uz * (double)w.x - ux * (double)w.z + s * (double)w.y;
        double cz = ux * (double)w.y - uy * (double)w.x + s * (double)w.z;
        double bx = (double)w.x + 2.0 * (uy * cz - uz * cy), by = (double)w.y + 2.0 * (uz * cx - ux * cz);
        double bz = (double)w.z + 2.0 * (ux * cy - uy * cx);
        double lx = bx * (double)mass.inertia.x.x, ly = by * (double)mass.inertia.y.y,
               lz = bz * (double)mass.inertia.z.z;
        double momentum = sqrt(lx * lx + ly * ly + lz * lz), work = 0.5 * (bx * lx + by * ly + bz * lz);
        if (i == 0) {
            first = momentum, energy = work;
        }
        NEAR(momentum / first, 1.0, 0.01);
        NEAR(work / energy, 1.0, 0.05);
        kit_steps(&world, 1);
    }
    kit_end(&world);
}

static void locks_hold(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    talus_body body = kit_box(&world, kit_vec(0.0f, 2.0f, 0.0f), 0.5f);
    OK(talus_body_set_locks(&world, body, TALUS_LOCK_LINEAR_X | TALUS_LOCK_ANGULAR_X | TALUS_LOCK_ANGULAR_Y));
    OK(talus_body_apply_impulse(&world, body, kit_vec(3000.0f, 0.0f, 2000.0f), kit_vec(0.2f, 2.2f, 0.3f)));
    for (int i = 0; i < 90; i++) {
        kit_steps(&world, 1);
        NEAR(kit_place(&world, body).x, 0.0, 1e-6);
        NEAR(kit_pose_of(&world, body).rotation.x, 0.0, 1e-5);
        NEAR(kit_pose_of(&world, body).rotation.y, 0.0, 1e-5);
    }
    assert_true(fabsf(kit_place(&world, body).z) > 0.1f);
    OK(talus_body_set_locks(&world, body, 63));
    talus_pose before = kit_pose_of(&world, body), after;
    kit_steps(&world, 60);
    after = kit_pose_of(&world, body);
    NEAR(after.position.y, before.position.y, 1e-6);
    NEAR(after.position.z, before.position.z, 1e-6);
    kit_end(&world);
}

/* Joints that want a body off what it is locked to do not get it there, however often they try in a sub-step. */
static void locks_hold_against_joints(void **state) {
    (void)state;
    enum { LINKS = 20 };
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    talus_body link[LINKS];
    for (int i = 0; i < LINKS; i++) {
        talus_joint_def joint = talus_joint_def_default();
        talus_joint_make_ball(&joint);
        link[i] = kit_box(&world, kit_vec((float)i, 5.0f, i % 2 ? 0.15f : 0.0f), 0.3f);
        OK(talus_body_set_locks(&world, link[i], TALUS_LOCK_LINEAR_Z));
        joint.b = link[i], joint.frame_b = kit_pose(-0.5f, 0.0f, 0.0f);
        if (i > 0) {
            joint.a = link[i - 1], joint.frame_a = kit_pose(0.5f, 0.0f, 0.0f);
        } else {
            joint.frame_a = kit_pose(-0.5f, 5.0f, 0.0f);
        }
        talus_joint made;
        OK(talus_joint_create(&world, &joint, &made));
    }
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        for (int k = 0; k < LINKS; k++) {
            assert_true(kit_place(&world, link[k]).z == (k % 2 ? 0.15f : 0.0f));
        }
    }
    kit_end(&world);
}

static void a_mass_of_zero_does_not_move(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_body body = kit_box(&world, kit_vec(0.0f, 2.0f, 0.0f), 0.5f);
    talus_mass mass;
    OK(talus_body_get_mass(&world, body, &mass));
    mass.mass = 0.0f; /* infinite: turns, but does not move */
    OK(talus_body_set_mass(&world, body, &mass));
    OK(talus_body_apply_impulse(&world, body, kit_vec(0.0f, 0.0f, 100.0f), kit_vec(0.5f, 2.0f, 0.0f)));
    kit_steps(&world, 30);
    NEAR(kit_place(&world, body).y, 2.0, 1e-6);
    assert_true(kit_spin(&world, body).y < -0.1f);
    kit_end(&world);
}

static void kinematic_bodies_go_where_told(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_body mover = kit_body(&world, TALUS_KINEMATIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def slab = kit_box_def(3.0f, 0.25f, 3.0f);
    kit_shape(&world, mover, &slab);
    talus_body rider = kit_box(&world, kit_vec(0.0f, 0.75f, 0.0f), 0.5f);
    kit_steps(&world, 30);
    NEAR(kit_place(&world, mover).y, 0.0, 0.0); /* gravity is not its business, nor what lies on it */
    for (int i = 1; i <= 60; i++) {
        talus_pose goal = kit_pose(0.02f * (float)i, 0.01f * (float)i, 0.0f);
        OK(talus_body_move_to(&world, mover, &goal, 1.0f / 60.0f));
        kit_steps(&world, 1);
        NEAR(kit_place(&world, mover).x, goal.position.x, 1e-4);
        NEAR(kit_place(&world, mover).y, goal.position.y, 1e-4);
    }
    NEAR(kit_velocity(&world, mover).x, 1.2, 1e-3); /* and so on, until told otherwise */
    kit_steps(&world, 1);
    NEAR(kit_place(&world, mover).x, 1.22, 1e-3);
    NEAR(kit_place(&world, rider).y, 0.61 + 0.75, 0.02); /* it was carried, and dragged along by friction */
    NEAR(kit_place(&world, rider).x, 1.22, 0.2);
    talus_pose turned = kit_pose_of(&world, mover);
    turned.rotation.y = 1.0f, turned.rotation.w = 1.0f; /* a quarter turn */
    OK(talus_body_move_to(&world, mover, &turned, 0.5f));
    NEAR(kit_spin(&world, mover).y, 3.14159265, 1e-4);
    kit_steps(&world, 30);
    NEAR(fabsf(kit_pose_of(&world, mover).rotation.y), sqrt(0.5), 1e-3);
    kit_end(&world);
}

static void a_pose_set_is_a_pose(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    talus_shape_def off = kit_ball_def(0.5f);
    off.pose.position.x = 2.0f;
    kit_shape(&world, box, &off); /* the centre of mass is elsewhere */
    kit_steps(&world, 200);
    talus_pose there = kit_pose(5.0f, 7.0f, -2.0f);
    there.rotation.z = 1.0f;
    OK(talus_body_set_pose(&world, box, &there));
    assert_int_equal(talus_body_is_awake(&world, box), 1);
    NEAR(kit_place(&world, box).x, 5.0, 1e-5);
    NEAR(kit_place(&world, box).y, 7.0, 1e-5);
    NEAR(kit_place(&world, box).z, -2.0, 1e-5);
    NEAR(kit_pose_of(&world, box).rotation.z, sqrt(0.5), 1e-6);
    kit_steps(&world, 60);
    assert_true(kit_place(&world, box).y < 5.0f);
    kit_end(&world);
}

static int all_asleep(const talus_world *world) { return kit_counters(world).awake_bodies == 0; }

static void what_rests_falls_asleep(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    talus_body boxes[3], alone = kit_box(&world, kit_vec(8.0f, 0.5f, 0.0f), 0.5f);
    for (int i = 0; i < 3; i++) {
        boxes[i] = kit_box(&world, kit_vec(0.0f, 0.5f + 1.0f * (float)i, 0.0f), 0.5f);
    }
    kit_steps(&world, 300);
    assert_true(all_asleep(&world));
    assert_int_equal(kit_counters(&world).sleeping_bodies, 4);
    talus_pose before = kit_pose_of(&world, boxes[2]), after;
    kit_steps(&world, 60);
    after = kit_pose_of(&world, boxes[2]);
    assert_memory_equal(&before, &after, sizeof before);
    NEAR(kit_length(kit_velocity(&world, boxes[2])), 0.0, 0.0);
    assert_int_equal(kit_counters(&world).lane_groups, 0);
    OK(talus_body_apply_impulse(&world, boxes[0], kit_vec(0.0f, 0.0f, 100.0f), kit_vec(0.0f, 0.5f, 0.0f)));
    for (int i = 0; i < 3; i++) { /* the island as one */
        assert_int_equal(talus_body_is_awake(&world, boxes[i]), 1);
    }
    assert_int_equal(talus_body_is_awake(&world, alone), 0);
    kit_steps(&world, 300);
    assert_true(all_asleep(&world));
    OK(talus_body_wake(&world, boxes[2]));
    assert_int_equal(talus_body_is_awake(&world, boxes[0]), 1);
    OK(talus_body_sleep(&world, boxes[1]));
    for (int i = 0; i < 3; i++) {
        assert_int_equal(talus_body_is_awake(&world, boxes[i]), 0);
    }
    OK(talus_world_set_gravity(&world, kit_vec(0.0f, 9.81f, 0.0f))); /* the world turned over */
    kit_steps(&world, 60);
    assert_true(kit_place(&world, alone).y > 2.0f);
    kit_end(&world);
}

static void what_is_struck_wakes(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    kit_steps(&world, 200);
    assert_int_equal(talus_body_is_awake(&world, box), 0);
    talus_body ball = kit_ball(&world, kit_vec(-3.0f, 0.5f, 0.0f), 0.4f);
    OK(talus_body_set_velocity(&world, ball, kit_vec(6.0f, 1.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 60);
    assert_true(kit_place(&world, box).x > 0.05f);
    kit_steps(&world, 600);
    assert_int_equal(talus_body_is_awake(&world, box), 0);
    /* a kinematic body that starts to push */
    talus_body mover = kit_body(&world, TALUS_KINEMATIC, kit_vec(kit_place(&world, box).x + 2.0f, 0.5f, 0.0f));
    talus_shape_def wall = kit_box_def(0.25f, 0.4f, 2.0f);
    kit_shape(&world, mover, &wall);
    kit_steps(&world, 10);
    assert_int_equal(talus_body_is_awake(&world, box), 0);
    float x = kit_place(&world, box).x;
    OK(talus_body_set_velocity(&world, mover, kit_vec(-2.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 90);
    assert_true(kit_place(&world, box).x < x - 0.5f);
    kit_end(&world);
}

static void the_ground_going_wakes(void **state) {
    (void)state;
    for (int way = 0; way < 3; way++) {
        talus_world_def def = kit_small();
        talus_world world = kit_world(&def);
        talus_body ground = kit_body(&world, TALUS_STATIC, kit_vec(0.0f, -1.0f, 0.0f));
        talus_shape_def slab = kit_box_def(5.0f, 1.0f, 5.0f);
        talus_shape shape = kit_shape(&world, ground, &slab);
        talus_body box = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
        kit_steps(&world, 200);
        assert_int_equal(talus_body_is_awake(&world, box), 0);
        talus_pose away = kit_pose(0.0f, -50.0f, 0.0f);
        if (way == 0) {
            OK(talus_body_destroy(&world, ground));
        } else if (way == 1) {
            OK(talus_shape_destroy(&world, shape));
        } else {
            OK(talus_body_set_pose(&world, ground, &away));
        }
        kit_steps(&world, 60);
        assert_true(kit_place(&world, box).y < -2.0f);
        kit_end(&world);
    }
}

static void who_may_sleep(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_body_def body_def = talus_body_def_default();
    talus_body restless, dreamer;
    talus_shape_def box = kit_box_def(0.5f, 0.5f, 0.5f);
    kit_floor(&world);
    body_def.type = TALUS_DYNAMIC;
    body_def.pose.position.y = 0.5f;
    body_def.can_sleep = 0;
    OK(talus_body_create(&world, &body_def, &restless));
    kit_shape(&world, restless, &box);
    body_def.can_sleep = 1, body_def.starts_asleep = 1;
    body_def.pose.position = kit_vec(5.0f, 10.0f, 0.0f);
    OK(talus_body_create(&world, &body_def, &dreamer));
    kit_shape(&world, dreamer, &box);
    kit_steps(&world, 300);
    assert_int_equal(talus_body_is_awake(&world, restless), 1);
    assert_int_equal(talus_body_is_awake(&world, dreamer), 0);
    NEAR(kit_place(&world, dreamer).y, 10.0, 0.0); /* in the air */
    OK(talus_body_wake(&world, dreamer));
    kit_steps(&world, 60);
    assert_true(kit_place(&world, dreamer).y < 6.0f);
    kit_end(&world);
    def.enable_sleep = 0;
    world = kit_world(&def);
    kit_floor(&world);
    talus_body awake = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    kit_steps(&world, 300);
    assert_int_equal(talus_body_is_awake(&world, awake), 1);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fall_is_the_parabola),
        cmocka_unit_test(gravity_scales),
        cmocka_unit_test(forces_act_for_one_step),
        cmocka_unit_test(impulses_act_at_once),
        cmocka_unit_test(damping_decays),
        cmocka_unit_test(free_spin_keeps_its_momentum),
        cmocka_unit_test(locks_hold),
        cmocka_unit_test(locks_hold_against_joints),
        cmocka_unit_test(a_mass_of_zero_does_not_move),
        cmocka_unit_test(kinematic_bodies_go_where_told),
        cmocka_unit_test(a_pose_set_is_a_pose),
        cmocka_unit_test(what_rests_falls_asleep),
        cmocka_unit_test(what_is_struck_wakes),
        cmocka_unit_test(the_ground_going_wakes),
        cmocka_unit_test(who_may_sleep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
