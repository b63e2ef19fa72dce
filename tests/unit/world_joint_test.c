/* Joints: what each kind holds and lets go, limits, springs, drives, breaking, and the answers of the calls. */
#include "world_kit.h"

#define G 9.81
#define PI 3.14159265358979

static talus_joint create(talus_world *world, const talus_joint_def *def) {
    talus_joint joint;
    OK(talus_joint_create(world, def, &joint));
    return joint;
}

static double linear_error(const talus_world *world, talus_joint joint) {
    float linear, angular;
    OK(talus_joint_get_error(world, joint, &linear, &angular));
    return (double)linear;
}
static double angular_error(const talus_world *world, talus_joint joint) {
    float linear, angular;
    OK(talus_joint_get_error(world, joint, &linear, &angular));
    return (double)angular;
}

static talus_world earth(void) {
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    return kit_world(&def);
}

/* A ball of half a metre on a weightless arm of 2 m: the pendulum of small swings. */
static void a_ball_joint_swings(void **state) {
    (void)state;
    talus_world world = earth();
    double angle = 0.05, length = 2.0, radius = 0.5;
    talus_body bob = kit_ball(&world, kit_vec((float)(length * sin(angle)), (float)(-length * cos(angle)), 0.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.b = bob;
    def.frame_b = kit_pose((float)(-length * sin(angle)), (float)(length * cos(angle)), 0.0f);
    talus_joint joint = create(&world, &def);
    /* I = m (L^2 + 2/5 r^2) about the pivot; T = 2 pi sqrt(I / (m g L)) (1 + a^2 / 16) */
    double period =
        2.0 * PI * sqrt((length * length + 0.4 * radius * radius) / (G * length)) * (1.0 + angle * angle / 16.0);
    double crossed = 0.0, last = (double)kit_place(&world, bob).x, dt = 1.0 / 240.0, worst = 0.0;
    int crossings = 0;
    for (int i = 1; crossings < 9; i++) {
        assert_true(i < 20000);
        OK(talus_world_step(&world, (float)dt, NULL, NULL));
        double x = (double)kit_place(&world, bob).x;
        worst = fmax(worst, linear_error(&world, joint));
        if (last > 0.0 && x <= 0.0) {
            double t = dt * ((double)i - x / (x - last));
            crossed = crossings++ ? crossed : t;
            last = x;
            if (crossings == 9) {
                NEAR((t - crossed) / 8.0, period, 0.005 * period);
            }
        }
        last = x;
    }
    assert_true(worst < 1e-3);
    kit_end(&world);
}

static void a_hanging_weight_pulls(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(0.0f, -1.0f, 0.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.b = box;
    def.frame_b = kit_pose(0.0f, 1.0f, 0.0f);
    talus_joint joint = create(&world, &def);
    kit_steps(&world, 60);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, joint, &force, &torque));
    NEAR(force.y, 1000.0 * G, 0.01 * 1000.0 * G);
    NEAR(force.x, 0.0, 10.0);
    NEAR(kit_length(torque), 0.0, 100.0);
    assert_true(linear_error(&world, joint) < 1e-4);
    kit_end(&world);
}

static void a_fixed_joint_carries_a_lever(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(1.0f, 0.0f, 0.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_fixed(&def);
    def.b = box;
    def.frame_b = kit_pose(-1.0f, 0.0f, 0.0f);
    talus_joint joint = create(&world, &def);
    kit_steps(&world, 120);
    NEAR(kit_place(&world, box).x, 1.0, 1e-3);
    NEAR(kit_place(&world, box).y, 0.0, 2e-3);
    assert_true(angular_error(&world, joint) < 2e-3);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, joint, &force, &torque));
    NEAR(force.y, 1000.0 * G, 100.0);
    kit_end(&world);
}

static void a_hinge_keeps_its_axis_and_limits(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 1.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def); /* about x */
    def.b = box;
    def.frame_b = kit_pose(0.0f, 0.0f, -1.0f);
    def.angular[0].mode = TALUS_AXIS_LIMITED;
    def.angular[0].lower = -0.5f, def.angular[0].upper = 0.5f;
    talus_joint joint = create(&world, &def);
    double worst = 0.0;
    for (int i = 0; i < 240; i++) {
        kit_steps(&world, 1);
        worst = fmax(worst, fmax(linear_error(&world, joint), angular_error(&world, joint)));
    }
    assert_true(worst < 5e-3);
    /* it fell until the limit of half a radian: about x by a positive angle z goes to -y */
    NEAR(kit_place(&world, box).y, -sin(0.5), 0.01);
    NEAR(kit_place(&world, box).z, cos(0.5), 0.01);
    NEAR(kit_place(&world, box).x, 0.0, 1e-3);
    kit_end(&world);
}

static void a_slider_slides(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_prismatic(&def);
    def.b = box;
    /* the slide points down along (1, -1, 0) */
    def.frame_a.rotation.z = -(float)sin(PI / 8.0), def.frame_a.rotation.w = (float)cos(PI / 8.0);
    def.frame_b = def.frame_a;
    talus_joint joint = create(&world, &def);
    kit_steps(&world, 60);
    double way = 0.5 * G * sin(PI / 4.0);
    NEAR(kit_place(&world, box).x, way * sin(PI / 4.0), 0.02 * way);
    NEAR(kit_place(&world, box).y, -way * sin(PI / 4.0), 0.02 * way);
    assert_true(linear_error(&world, joint) < 1e-3 && angular_error(&world, joint) < 1e-3);
    OK(talus_joint_destroy(&world, joint));
    def.linear[0].mode = TALUS_AXIS_LIMITED; /* and with an end to it, from where it is now */
    def.linear[0].lower = 0.0f, def.linear[0].upper = 4.0f;
    create(&world, &def);
    kit_steps(&world, 240);
    NEAR(kit_place(&world, box).x, 4.0 * sin(PI / 4.0), 0.02);
    kit_end(&world);
}

static void a_rope_holds(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(1.0f, 0.0f, 0.0f), 0.25f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_distance(&def, 0.5f, 2.0f);
    def.b = box;
    create(&world, &def);
    double most = 0.0;
    for (int i = 0; i < 600; i++) {
        kit_steps(&world, 1);
        most = fmax(most, (double)kit_length(kit_place(&world, box)));
    }
    assert_true(most > 1.9 && most < 2.02);
    OK(talus_body_set_velocity(&world, box, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    talus_pose near_by = kit_pose(0.0f, 0.6f, 0.0f); /* falls onto the near end */
    OK(talus_body_set_pose(&world, box, &near_by));
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        assert_true(kit_length(kit_place(&world, box)) > 0.48f);
    }
    kit_end(&world);
}

/* A weight of 1000 kg on a spring of 98100 N/m hangs 0.1 m down, and swings with the mass's and the spring's frequency.
 */
static void a_soft_axis_is_a_spring(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++) { /* a locked axis, a limit, a drive */
        talus_world world = earth();
        talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
        talus_joint_def def = talus_joint_def_default();
        talus_joint_make_fixed(&def);
        def.b = box;
        float stiffness = 98100.0f, damping = 4000.0f;
        if (kind == 2) {
            def.linear[1].mode = TALUS_AXIS_FREE;
            def.linear_drive[1].enabled = 1;
            def.linear_drive[1].stiffness = stiffness, def.linear_drive[1].damping = damping;
        } else {
            def.linear[1].mode = kind ? TALUS_AXIS_LIMITED : TALUS_AXIS_LOCKED;
            def.linear[1].stiffness = stiffness, def.linear[1].damping = damping;
        }
        create(&world, &def);
        double w0 = sqrt(98.1), zeta = 2.0, wd = sqrt(98.1 - zeta * zeta); /* c / 2 m = 2 */
        for (int i = 1; i <= 60; i++) {
            kit_steps(&world, 1);
            double t = (double)i / 60.0;
            double x = -0.1 + 0.1 * exp(-zeta * t) * (cos(wd * t) + zeta / wd * sin(wd * t));
            NEAR(kit_place(&world, box).y, x, 0.01);
        }
        assert_true(w0 > 0.0);
        kit_steps(&world, 600);
        NEAR(kit_place(&world, box).y, -0.1, 1e-3);
        kit_end(&world);
    }
}

static void motors_turn(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f); /* 1000/6 kg m^2 */
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.b = box;
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].velocity_target = 3.0f;
    def.angular_drive[0].damping = 1e6f;
    def.angular_drive[0].max_force = 100.0f; /* N m: 0.6 rad/s^2 */
    talus_joint joint = create(&world, &def);
    kit_steps(&world, 60);
    NEAR(kit_spin(&world, box).x, 0.6, 0.01);
    kit_steps(&world, 300);
    NEAR(kit_spin(&world, box).x, 3.0, 0.01);
    talus_drive drive = def.angular_drive[0]; /* to an angle now, per unit of inertia */
    drive.acceleration = 1, drive.max_force = 0.0f;
    drive.velocity_target = 0.0f, drive.position_target = 1.0f;
    drive.stiffness = 100.0f, drive.damping = 20.0f;
    OK(talus_joint_set_angular_drive(&world, joint, 0, &drive));
    kit_steps(&world, 300);
    NEAR(kit_spin(&world, box).x, 0.0, 1e-3);
    NEAR(fabs(2.0 * atan2((double)kit_pose_of(&world, box).rotation.x, (double)kit_pose_of(&world, box).rotation.w)),
         1.0, 0.01);
    drive.enabled = 0;
    OK(talus_joint_set_angular_drive(&world, joint, 0, &drive));
    OK(talus_body_set_velocity(&world, box, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(2.0f, 0.0f, 0.0f)));
    kit_steps(&world, 60);
    NEAR(kit_spin(&world, box).x, 2.0, 1e-3);
    kit_end(&world);
}

static void a_cone_bounds_the_swing(void **state) {
    (void)state;
    talus_world world = earth();
    talus_body box = kit_box(&world, kit_vec(0.0f, 1.0f, 0.0f), 0.25f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.b = box;
    def.frame_b = kit_pose(0.0f, -1.0f, 0.0f);
    def.cone_axis = 1, def.cone_angle = 0.4f;
    create(&world, &def);
    OK(talus_body_set_velocity(&world, box, kit_vec(1.0f, 0.0f, 0.5f), kit_vec(0.5f, 0.0f, -1.0f)));
    for (int i = 0; i < 300; i++) {
        kit_steps(&world, 1);
        assert_true((double)kit_place(&world, box).y > cos(0.4) - 0.03);
    }
    assert_true((double)kit_place(&world, box).y < cos(0.4) + 0.03); /* it lies on the cone */
    kit_end(&world);
}

static void joints_break(void **state) {
    (void)state;
    for (int breaks = 0; breaks < 2; breaks++) {
        talus_world world = earth();
        talus_body box = kit_box(&world, kit_vec(0.0f, -1.0f, 0.0f), 0.5f);
        talus_joint_def def = talus_joint_def_default();
        talus_joint_make_ball(&def);
        def.b = box;
        def.frame_b = kit_pose(0.0f, 1.0f, 0.0f);
        def.break_force = (float)(1000.0 * G * (breaks ? 0.9 : 1.1));
        def.user_data = 99;
        talus_joint joint = create(&world, &def);
        uint32_t told = 0;
        for (int i = 0; i < 60; i++) {
            kit_steps(&world, 1);
            talus_events events = kit_events(&world);
            told += events.broken_count;
            if (events.broken_count) {
                assert_memory_equal(&events.broken[0].joint, &joint, sizeof joint);
                assert_true(events.broken[0].user_data == 99);
            }
        }
        assert_int_equal(told, breaks);
        assert_int_equal(talus_joint_is_valid(&world, joint), !breaks);
        assert_true(breaks == (kit_place(&world, box).y < -2.0f));
        kit_end(&world);
    }
}

static void a_joint_gone_lets_go(void **state) {
    (void)state;
    talus_world_def world_def = kit_small();
    talus_world world = kit_world(&world_def);
    talus_body box = kit_box(&world, kit_vec(0.0f, -1.0f, 0.0f), 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_ball(&def);
    def.b = box;
    def.frame_b = kit_pose(0.0f, 1.0f, 0.0f);
    talus_joint joint = create(&world, &def);
    kit_steps(&world, 200);
    assert_int_equal(talus_body_is_awake(&world, box), 0);
    OK(talus_joint_destroy(&world, joint));
    kit_steps(&world, 60);
    assert_true(kit_place(&world, box).y < -3.0f);
    kit_end(&world);
}

static void connected_bodies_pass_or_collide(void **state) {
    (void)state;
    for (int collide = 0; collide < 2; collide++) {
        talus_world world = kit_void();
        talus_body a = kit_box(&world, kit_vec(-0.4f, 0.0f, 0.0f), 0.5f),
                   b = kit_box(&world, kit_vec(0.4f, 0.0f, 0.0f), 0.5f);
        talus_joint_def def = talus_joint_def_default(); /* free in all: only says who collides */
        def.a = a, def.b = b;
        def.collide_connected = (uint8_t)collide;
        create(&world, &def);
        kit_steps(&world, 120);
        float apart = kit_place(&world, b).x - kit_place(&world, a).x;
        assert_true(collide ? apart > 0.95f : fabsf(apart - 0.8f) < 1e-5f);
        kit_end(&world);
    }
}

static void what_joints_refuse(void **state) {
    (void)state;
    talus_world_def world_def = kit_small();
    world_def.joint_capacity = 2;
    talus_world world = kit_world(&world_def);
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f),
               rock = kit_body(&world, TALUS_STATIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_body other = kit_box(&world, kit_vec(5.0f, 0.0f, 0.0f), 0.5f);
    talus_joint_def good = talus_joint_def_default(), broken, got;
    talus_joint joint, second;
    talus_joint_make_revolute(&good);
    good.b = box;
    good.angular[0].mode = TALUS_AXIS_LIMITED, good.angular[0].lower = -1.0f, good.angular[0].upper = 2.0f;
    good.cone_axis = -1;
    good.linear_drive[2].enabled = 1;
    good.linear_drive[2].stiffness = 5.0f;
    good.break_torque = 1e9f;
    good.user_data = 7;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, NULL, &joint));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &good, NULL));
    broken = good, broken.a = box; /* a body with itself */
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.b = rock; /* nothing that moves */
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    float *numbers[] = {&broken.frame_a.position.x,
                        &broken.frame_a.rotation.w,
                        &broken.frame_b.position.z,
                        &broken.frame_b.rotation.y,
                        &broken.linear[1].lower,
                        &broken.angular[0].stiffness,
                        &broken.angular[0].damping,
                        &broken.angular_drive[1].stiffness,
                        &broken.linear_drive[0].damping,
                        &broken.linear_drive[2].position_target,
                        &broken.angular_drive[2].velocity_target,
                        &broken.break_force,
                        &broken.break_torque};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        const float bad[3] = {NAN, INFINITY, -INFINITY};
        for (int i = 0; i < 3; i++) {
            broken = good;
            *numbers[k] = bad[i];
            REFUSED(&world, TALUS_NOT_FINITE, talus_joint_create(&world, &broken, &joint));
        }
    }
    broken = good, broken.angular[0].upper = NAN;
    REFUSED(&world, TALUS_NOT_FINITE, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.angular[0].upper = -2.0f; /* below the lower one */
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.angular[0].stiffness = -1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.linear_drive[0].damping = -1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.linear[0].mode = TALUS_AXIS_MODE_COUNT;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.frame_a.rotation.w = 0.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good, broken.cone_axis = 1, broken.cone_angle = -0.5f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    broken = good;
    talus_joint_make_distance(&broken, 3.0f, 1.0f);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &broken, &joint));
    joint = create(&world, &good);
    OK(talus_joint_get_def(&world, joint, &got));
    assert_int_equal(got.b.index, box.index);
    assert_true(got.angular[0].upper == 2.0f && got.angular[0].mode == TALUS_AXIS_LIMITED && got.user_data == 7);
    assert_true(got.linear_drive[2].stiffness == 5.0f && got.linear_drive[2].enabled && got.break_torque == 1e9f);
    assert_int_equal(got.cone_axis, -1);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_get_def(&world, joint, NULL));
    good.b = other;
    second = create(&world, &good);
    good.a = box;
    REFUSED(&world, TALUS_FULL_JOINTS, talus_joint_create(&world, &good, &second));
    assert_int_equal(kit_counters(&world).joints.used, 2);
    talus_drive drive = good.linear_drive[2];
    talus_vec3 v;
    float x;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_linear_drive(&world, joint, 3, &drive));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_linear_drive(&world, joint, -1, &drive));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_set_angular_drive(&world, joint, 0, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_get_reaction(&world, joint, NULL, &v));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_get_error(&world, joint, &x, NULL));
    drive.stiffness = NAN;
    REFUSED(&world, TALUS_NOT_FINITE, talus_joint_set_linear_drive(&world, joint, 0, &drive));
    OK(talus_joint_destroy(&world, joint));
    drive.stiffness = 1.0f;
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_destroy(&world, joint));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_get_def(&world, joint, &got));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_set_linear_drive(&world, joint, 0, &drive));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_set_angular_drive(&world, joint, 0, &drive));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_get_reaction(&world, joint, &v, &v));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_get_error(&world, joint, &x, &x));
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_joint_swings),
        cmocka_unit_test(a_hanging_weight_pulls),
        cmocka_unit_test(a_fixed_joint_carries_a_lever),
        cmocka_unit_test(a_hinge_keeps_its_axis_and_limits),
        cmocka_unit_test(a_slider_slides),
        cmocka_unit_test(a_rope_holds),
        cmocka_unit_test(a_soft_axis_is_a_spring),
        cmocka_unit_test(motors_turn),
        cmocka_unit_test(a_cone_bounds_the_swing),
        cmocka_unit_test(joints_break),
        cmocka_unit_test(a_joint_gone_lets_go),
        cmocka_unit_test(connected_bodies_pass_or_collide),
        cmocka_unit_test(what_joints_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
