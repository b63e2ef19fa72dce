/* Joints: limits, motors, springs, loads and what breaks. Frames' x is the hinge or the slide. */
#include "analytic_kit.h"

static talus_quat x_to_y(void) {
    talus_quat q = {0.0f, 0.0f, 0.70710678f, 0.70710678f};
    return q;
}
static talus_joint_def revolute_z(talus_body body) {
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_revolute(&def);
    def.b = body;
    def.frame_a.rotation = def.frame_b.rotation = x_to_z();
    return def;
}
static talus_joint_def slider_y(talus_body body) {
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_prismatic(&def);
    def.b = body;
    def.frame_a.rotation = def.frame_b.rotation = x_to_y();
    return def;
}

/* A rod on a hinge falls against a limit and rests there: 0.2 degrees. */
static void hinge_limit(void **state) {
    (void)state;
    for (int upper = 0; upper < 2; upper++) {
        talus_world world = world_of(upper ? 5.0f : -5.0f, -5.0f, 0.0f);
        talus_body body = mass_of(&world, kit_vec(0.0f, -0.5f, 0.0f), 2.0f, 0.2f, 0.1f, 0.2f);
        talus_joint_def def = revolute_z(body);
        def.frame_b.position.y = 0.5f;
        def.angular[0].mode = TALUS_AXIS_LIMITED;
        def.angular[0].lower = -0.4f, def.angular[0].upper = 0.3f;
        join(&world, &def);
        for (int k = 0; k < 240; k++) {
            step(&world);
            double a = angle_z(&world, body);
            assert_true(a < 0.3 + 0.02 && a > -0.4 - 0.02);
        }
        CLOSE(angle_z(&world, body), upper ? 0.3 : -0.4, 0.2 * PI / 180.0);
        kit_end(&world);
    }
}

/* A motor of bounded torque speeds up by M / I and then holds its speed; under a load beyond its bound it gives way by
 * the rest. 0.5 % of what a second of torque gives. */
static void motor(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 2.0f, 4.0f, 4.0f, 4.0f);
    talus_joint_def def = revolute_z(body);
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].velocity_target = 5.0f;
    def.angular_drive[0].damping = 1e6f;
    def.angular_drive[0].max_force = 8.0f;
    talus_joint joint = join(&world, &def);
    kit_steps(&world, 60);
    CLOSE(kit_spin(&world, body).z, 2.0, 0.01);
    talus_vec3 force, moment;
    OK(talus_joint_get_reaction(&world, joint, &force, &moment));
    CLOSE(moment.z, 8.0, 0.01);
    kit_steps(&world, 120);
    CLOSE(kit_spin(&world, body).z, 5.0, 0.01);
    for (int k = 0; k < 60; k++) { /* held against less than the bound */
        OK(talus_body_apply_torque(&world, body, kit_vec(0.0f, 0.0f, -7.0f)));
        step(&world);
    }
    CLOSE(kit_spin(&world, body).z, 5.0, 0.01);
    for (int k = 0; k < 60; k++) {
        OK(talus_body_apply_torque(&world, body, kit_vec(0.0f, 0.0f, -10.0f)));
        step(&world);
    }
    CLOSE(kit_spin(&world, body).z, 5.0 - 2.0 / 4.0, 0.01);
    kit_end(&world);
}

/* A damped motor under a load turns slower by M / c. */
static void motor_terminal_speed(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 2.0f, 1.0f, 1.0f, 1.0f);
    talus_joint_def def = revolute_z(body);
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].velocity_target = 6.0f;
    def.angular_drive[0].damping = 3.0f;
    join(&world, &def);
    for (int k = 1; k <= 300; k++) {
        OK(talus_body_apply_torque(&world, body, kit_vec(0.0f, 0.0f, -4.5f)));
        step(&world);
        double wanted = (6.0 - 1.5) * (1.0 - exp(-3.0 * k / 60.0));
        CLOSE(kit_spin(&world, body).z, wanted, 4.5 * 0.5 * 3.0 * SUB + 1e-3); /* 1 + h c for exp(h c) */
    }
    kit_end(&world);
}

/* A spring drive: the period 2 pi sqrt(m / k), or 2 pi / sqrt(k) where stiffness is per mass. It is implicit and solved
 * before the move and after it: the period keeps to (w h)^2, the swing is down by exp(-w^2 h t). */
static void spring_period(void **state) {
    (void)state;
    for (int per_mass = 0; per_mass < 2; per_mass++) {
        for (int i = 0; i < 3; i++) {
            const double mass = 1.0 + 3.0 * i, k = 40.0, rate = sqrt(per_mass ? k : k / mass);
            talus_world world = kit_void();
            talus_body body = mass_of(&world, kit_vec(0.0f, 0.5f, 0.0f), (float)mass, 1.0f, 1.0f, 1.0f);
            talus_joint_def def = slider_y(body);
            def.linear_drive[0].enabled = 1;
            def.linear_drive[0].acceleration = (uint8_t)per_mass;
            def.linear_drive[0].stiffness = (float)k;
            join(&world, &def);
            period p;
            memset(&p, 0, sizeof p);
            double late = 0.0;
            for (int n = 1; n <= 600; n++) {
                step(&world);
                period_feed(&p, n / 60.0, (double)kit_place(&world, body).y, 1.0 / 60.0);
                double y = (double)kit_place(&world, body).y, v = (double)kit_velocity(&world, body).y;
                late = sqrt(y * y + v * v / (rate * rate));
                CLOSE(kit_place(&world, body).x, 0.0, 1e-5);
            }
            CLOSE(period_of(&p), 2.0 * PI / rate, 0.005 * 2.0 * PI / rate);
            CLOSE(late, 0.5 * exp(-rate * rate * SUB * 10.0), 0.01);
            kit_end(&world);
        }
    }
}

/* A drive, a soft lock and a soft limit under a load give by F / k; damping lets them come to rest there. */
static void static_deflection(void **state) {
    (void)state;
    const double mass = 3.0, k = 500.0, give = mass * G / k;
    for (int kind = 0; kind < 4; kind++) {
        talus_world world = world_of(0.0f, (float)-G, 0.0f);
        talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), (float)mass, 1.0f, 1.0f, 1.0f);
        talus_joint_def def = slider_y(body);
        double wanted = -give;
        if (kind == 0) {
            def.linear_drive[0].enabled = 1;
            def.linear_drive[0].stiffness = (float)k, def.linear_drive[0].damping = 40.0f;
        } else if (kind == 1) {
            def.linear[0].mode = TALUS_AXIS_LOCKED;
            def.linear[0].stiffness = (float)k, def.linear[0].damping = 40.0f;
        } else if (kind == 2) {
            def.linear[0].mode = TALUS_AXIS_LIMITED;
            def.linear[0].lower = -0.2f, def.linear[0].upper = 0.4f;
            def.linear[0].stiffness = (float)k, def.linear[0].damping = 40.0f;
            wanted = -0.2 - give;
        } else {
            def.linear_drive[0].enabled = def.linear_drive[0].acceleration = 1;
            def.linear_drive[0].stiffness = 200.0f, def.linear_drive[0].damping = 20.0f;
            def.linear_drive[0].position_target = 0.3f;
            wanted = 0.3 - G / 200.0;
        }
        talus_joint joint = join(&world, &def);
        kit_steps(&world, 600);
        CLOSE(kit_place(&world, body).y, wanted, 1e-3 * fabs(give) + 1e-5);
        BELOW(kit_velocity(&world, body).y, 1e-4);
        talus_vec3 force, torque;
        OK(talus_joint_get_reaction(&world, joint, &force, &torque));
        CLOSE(force.y, mass * G, 1e-3 * mass * G);
        kit_end(&world);
    }
}

/* An angular spring: a level arm sags by the angle at which k a = m g r cos a. */
static void angular_spring(void **state) {
    (void)state;
    const double mass = 2.0, arm = 0.5, k = 60.0;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body = mass_of(&world, kit_vec((float)arm, 0.0f, 0.0f), (float)mass, 0.1f, 0.1f, 0.1f);
    talus_joint_def def = revolute_z(body);
    def.frame_b.position.x = (float)-arm;
    def.angular_drive[0].enabled = 1;
    def.angular_drive[0].stiffness = (float)k, def.angular_drive[0].damping = 10.0f;
    join(&world, &def);
    kit_steps(&world, 600);
    double a = 0.0;
    for (int i = 0; i < 100; i++) {
        a = mass * G * arm * cos(a) / k;
    }
    CLOSE(angle_z(&world, body), -a, 1e-3 * a);
    kit_end(&world);
}

/* A cone holds the axis of a rod that falls, whichever way: 0.3 degrees. */
static void cone(void **state) {
    (void)state;
    for (int i = 0; i < 8; i++) {
        const double way = 2.0 * PI * i / 8.0 + 0.2, angle = 0.5;
        talus_world world = world_of((float)(9.0 * cos(way)), -1.0f, (float)(9.0 * sin(way)));
        talus_body body = mass_of(&world, kit_vec(0.0f, -0.5f, 0.0f), 2.0f, 0.2f, 0.1f, 0.2f);
        OK(talus_body_set_damping(&world, body, 0.5f, 0.5f));
        talus_joint_def def = talus_joint_def_default();
        talus_joint_make_ball(&def);
        def.b = body;
        def.frame_b.position.y = 0.5f;
        def.cone_axis = 1;
        def.cone_angle = (float)angle;
        join(&world, &def);
        kit_steps(&world, 600);
        const double down[3] = {0.0, -1.0, 0.0};
        double now[3];
        turned(kit_pose_of(&world, body).rotation, down, now);
        CLOSE(acos(-now[1]), angle, 0.3 * PI / 180.0);
        CLOSE(cos(way) * now[0] + sin(way) * now[2], sin(angle), 0.01);
        kit_end(&world);
    }
}

/* A fixed arm carries its load: force m g, torque m g r at the joint, without giving. */
static void fixed_arm(void **state) {
    (void)state;
    const double mass = 10.0, arm = 1.0;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body = mass_of(&world, kit_vec((float)arm, 0.0f, 0.0f), (float)mass, 1.0f, 1.0f, 1.0f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_fixed(&def);
    def.b = body;
    def.frame_b.position.x = (float)-arm;
    talus_joint joint = join(&world, &def);
    kit_steps(&world, 600);
    float linear, angular;
    OK(talus_joint_get_error(&world, joint, &linear, &angular));
    BELOW(linear, 1e-4);
    BELOW(angular, 1e-4);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, joint, &force, &torque));
    CLOSE(force.y, mass * G, 1e-3 * mass * G);
    CLOSE(torque.z, mass * G * arm, 2e-3 * mass * G * arm);
    CLOSE(kit_place(&world, body).y, 0.0, 2e-4);
    kit_end(&world);
}

/* A row of boxes fixed to each other and to the wall: the first joint carries them all. */
static void cantilever(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body before = talus_world_ground(&world);
    talus_joint first = {0, 0}, joint;
    for (int i = 0; i < 5; i++) {
        talus_body body = mass_of(&world, kit_vec(0.5f + (float)i, 0.0f, 0.0f), 1.0f, 0.2f, 0.2f, 0.2f);
        talus_joint_def def = talus_joint_def_default();
        talus_joint_make_fixed(&def);
        def.a = before, def.b = body;
        def.frame_a.position.x = i ? 0.5f : 0.0f;
        def.frame_b.position.x = -0.5f;
        joint = join(&world, &def);
        first = i ? first : joint;
        before = body;
    }
    kit_steps(&world, 600);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, first, &force, &torque));
    CLOSE(force.y, 5.0 * G, 0.01 * 5.0 * G);
    CLOSE(torque.z, 5.0 * G * 2.5, 0.02 * 5.0 * G * 2.5);
    CLOSE(kit_place(&world, before).y, 0.0, 0.02);
    kit_end(&world);
}

/* A joint that carries m g breaks if it bears a percent less, and not if it bears a percent more; told once. */
static void breaks_at_its_force(void **state) {
    (void)state;
    for (int weak = 0; weak < 2; weak++) {
        for (int kind = 0; kind < 2; kind++) {
            const double mass = 5.0, arm = 0.5, load = kind ? mass * G * arm : mass * G;
            talus_world world = world_of(0.0f, (float)-G, 0.0f);
            talus_body body =
                mass_of(&world, kit_vec(kind ? (float)arm : 0.0f, 0.0f, 0.0f), (float)mass, 1.0f, 1.0f, 1.0f);
            talus_joint_def def = talus_joint_def_default();
            talus_joint_make_fixed(&def);
            def.b = body;
            def.frame_b.position.x = kind ? (float)-arm : 0.0f;
            def.user_data = 77;
            if (kind) {
                def.break_torque = (float)(load * (weak ? 0.99 : 1.01));
            } else {
                def.break_force = (float)(load * (weak ? 0.99 : 1.01));
            }
            talus_joint joint = join(&world, &def);
            uint32_t told = 0;
            for (int k = 0; k < 300; k++) {
                step(&world);
                talus_events events = kit_events(&world);
                if (events.broken_count) {
                    told += events.broken_count;
                    assert_true(events.broken[0].user_data == 77 && events.broken[0].joint.index == joint.index);
                }
            }
            assert_int_equal(told, weak ? 1 : 0);
            assert_int_equal(talus_joint_is_valid(&world, joint), weak ? 0 : 1);
            assert_int_equal(kit_place(&world, body).y < -1.0f, weak);
            kit_end(&world);
        }
    }
}

/* A slider against its hard end rests there, and does not leave its line. */
static void slider_limit(void **state) {
    (void)state;
    talus_world world = world_of(1.0f, (float)-G, 0.5f);
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 2.0f, 0.3f, 0.3f, 0.3f);
    talus_joint_def def = slider_y(body);
    def.linear[0].mode = TALUS_AXIS_LIMITED;
    def.linear[0].lower = -0.7f, def.linear[0].upper = 1.0f;
    talus_joint joint = join(&world, &def);
    kit_steps(&world, 240);
    CLOSE(kit_place(&world, body).y, -0.7, 1e-3);
    float linear, angular;
    OK(talus_joint_get_error(&world, joint, &linear, &angular));
    BELOW(linear, 1e-4);
    BELOW(angular, 1e-4);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hinge_limit),
        cmocka_unit_test(motor),
        cmocka_unit_test(motor_terminal_speed),
        cmocka_unit_test(spring_period),
        cmocka_unit_test(static_deflection),
        cmocka_unit_test(angular_spring),
        cmocka_unit_test(cone),
        cmocka_unit_test(fixed_arm),
        cmocka_unit_test(cantilever),
        cmocka_unit_test(breaks_at_its_force),
        cmocka_unit_test(slider_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
