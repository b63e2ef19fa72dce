/* Newton's laws on bodies that nothing touches. */
#include "analytic_kit.h"

/* With numbers that floats hold, the parabola is hit to the bit: 8 m/s^2 in steps of 1/64 s. */
static void fall_is_exact(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, -8.0f, 0.0f);
    talus_body body = kit_ball(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    for (int i = 1; i <= 640; i++) {
        OK(talus_world_step(&world, 1.0f / 64.0f, NULL, NULL));
        double t = i / 64.0;
        CLOSE(kit_place(&world, body).y, -4.0 * t * t, 0.0);
        CLOSE(kit_velocity(&world, body).y, -8.0 * t, 0.0);
    }
    kit_end(&world);
}

/* With others it is hit but for rounding: each sub-step rounds by at most half an ulp of where it is (1e-6 at 30
 * m, 1.5e-5 at 290 m) and of its speed (3.8e-6 at 78 m/s), and as the same sum is taken again and again these need not
 * cancel. */
static void fall(void **state) {
    (void)state;
    for (uint32_t substeps = 1; substeps <= 16; substeps *= 2) {
        const double n = 600.0 * substeps;
        talus_world_def def = kit_small();
        def.substeps = substeps;
        def.enable_sleep = 0;
        talus_world world = kit_world(&def);
        talus_body body = kit_ball(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
        set_velocity(&world, body, kit_vec(3.0f, 20.0f, -2.0f), kit_vec(0.0f, 0.0f, 0.0f));
        kit_steps(&world, 600);
        CLOSE(kit_place(&world, body).x, 30.0, n * 1e-6);
        CLOSE(kit_place(&world, body).y, 200.0 - 0.5 * G * 100.0, n * (1.5e-5 + 0.5 * 10.0 * 3.8e-6));
        CLOSE(kit_place(&world, body).z, -20.0, n * 1e-6);
        CLOSE(kit_velocity(&world, body).y, 20.0 - G * 10.0, n * 3.8e-6);
        kit_end(&world);
    }
}

/* v = g / c + (v0 - g / c) exp(-c t). The sub-step divides by 1 + h c where the exponential has exp(h c): c h / 2 off.
 */
static void damped_throw(void **state) {
    (void)state;
    const double c = 0.5, off = 0.5 * c * SUB;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body = kit_ball(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    OK(talus_body_set_damping(&world, body, (float)c, 0.25f));
    set_velocity(&world, body, kit_vec(20.0f, 30.0f, 0.0f), kit_vec(0.0f, 8.0f, 0.0f));
    for (int i = 1; i <= 600; i++) {
        step(&world);
        double t = i / 60.0, left = exp(-c * t), gone = (1.0 - left) / c;
        CLOSE(kit_velocity(&world, body).x, 20.0 * left, off * 20.0);
        CLOSE(kit_place(&world, body).x, 20.0 * gone, off * 20.0 / c);
        CLOSE(kit_velocity(&world, body).y, -G / c + (30.0 + G / c) * left, off * (30.0 + G / c));
        CLOSE(kit_place(&world, body).y, -G / c * t + (30.0 + G / c) * gone,
              off * (30.0 + G / c) / c + off * G / c * t);
        CLOSE(kit_spin(&world, body).y, 8.0 * exp(-0.25 * t), 0.5 * 0.25 * SUB * 8.0);
    }
    kit_end(&world);
}

static void gravity_scales(void **state) {
    (void)state;
    const float scales[] = {0.0f, 0.5f, 1.0f, -1.0f, 3.0f};
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body[5];
    for (int i = 0; i < 5; i++) {
        body[i] = kit_ball(&world, kit_vec(5.0f * (float)i, 0.0f, 0.0f), 0.5f);
        OK(talus_body_set_gravity_scale(&world, body[i], scales[i]));
    }
    kit_steps(&world, 60);
    for (int i = 0; i < 5; i++) { /* rounding of a walk of 15 m and less */
        CLOSE(kit_place(&world, body[i]).y, -0.5 * G * (double)scales[i], 2e-4);
    }
    kit_end(&world);
}

/* F = m a for a force through the centre, held for a second; the sub-step's sum is as exact as free fall's. */
static void force(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(1.0f, 2.0f, 3.0f), 4.0f, 1.0f, 2.0f, 2.0f);
    for (int i = 0; i < 60; i++) {
        OK(talus_body_apply_force(&world, body, kit_vec(8.0f, -4.0f, 2.0f), kit_place(&world, body)));
        step(&world);
    }
    talus_vec3 v = kit_velocity(&world, body), x = kit_place(&world, body), w = kit_spin(&world, body);
    CLOSE(v.x, 2.0, 1e-5);
    CLOSE(v.y, -1.0, 1e-5);
    CLOSE(v.z, 0.5, 1e-5);
    CLOSE(x.x, 2.0, 2e-5);
    CLOSE(x.y, 1.5, 2e-5);
    CLOSE(x.z, 3.25, 2e-5);
    CLOSE(kit_length(w), 0.0, 1e-6);
    step(&world); /* a force acts for one step only */
    CLOSE(kit_velocity(&world, body).x, v.x, 0.0);
    kit_end(&world);
}

/* M = I dw/dt about a principal axis; the angle lags by half of a sub-step's sum: w h / 2. */
static void torque(void **state) {
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        talus_world world = kit_void();
        talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 4.0f, 2.0f, 3.0f, 4.0f);
        const double inertia = 2.0 + axis;
        float t[3] = {0.0f, 0.0f, 0.0f};
        t[axis] = 6.0f;
        for (int i = 0; i < 60; i++) {
            OK(talus_body_apply_torque(&world, body, kit_vec(t[0], t[1], t[2])));
            step(&world);
        }
        talus_vec3 w = kit_spin(&world, body);
        const float spin[3] = {w.x, w.y, w.z};
        talus_quat q = kit_pose_of(&world, body).rotation;
        const float half[3] = {q.x, q.y, q.z};
        CLOSE(spin[axis], 6.0 / inertia, 1e-4);
        CLOSE(2.0 * atan2((double)half[axis], (double)q.w), 3.0 / inertia, 6.0 / inertia * SUB);
        CLOSE(spin[(axis + 1) % 3], 0.0, 1e-5);
        CLOSE(spin[(axis + 2) % 3], 0.0, 1e-5);
        kit_end(&world);
    }
}

/* A force at an arm is that force at the centre and a torque. */
static void force_at_an_arm(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(1.0f, 1.0f, 1.0f), 2.0f, 5.0f, 5.0f, 5.0f);
    OK(talus_body_apply_force(&world, body, kit_vec(0.0f, 12.0f, 0.0f), kit_vec(3.0f, 1.0f, 2.0f)));
    step(&world);
    /* r = (2, 0, 1), r x F = (-12, 0, 24) */
    CLOSE(kit_velocity(&world, body).y, 6.0 / 60.0, 1e-6);
    CLOSE(kit_spin(&world, body).x, -12.0 / 5.0 / 60.0, 1e-6);
    CLOSE(kit_spin(&world, body).y, 0.0, 1e-6);
    CLOSE(kit_spin(&world, body).z, 24.0 / 5.0 / 60.0, 1e-6);
    kit_end(&world);
}

static void impulses(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(1.0f, 1.0f, 1.0f), 2.0f, 3.0f, 4.0f, 5.0f);
    OK(talus_body_apply_impulse(&world, body, kit_vec(0.0f, 12.0f, 0.0f), kit_vec(3.0f, 1.0f, 2.0f)));
    CLOSE(kit_velocity(&world, body).y, 6.0, 1e-6);
    CLOSE(kit_spin(&world, body).x, -12.0 / 3.0, 1e-6);
    CLOSE(kit_spin(&world, body).y, 0.0, 1e-6);
    CLOSE(kit_spin(&world, body).z, 24.0 / 5.0, 1e-6);
    OK(talus_body_apply_angular_impulse(&world, body, kit_vec(12.0f, 8.0f, -24.0f)));
    CLOSE(kit_spin(&world, body).x, 0.0, 1e-6);
    CLOSE(kit_spin(&world, body).y, 2.0, 1e-6);
    CLOSE(kit_spin(&world, body).z, 0.0, 1e-6);
    kit_end(&world);
}

/* A body whose mass is away from its origin turns about its mass. */
static void turns_about_its_mass(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_mass mass;
    memset(&mass, 0, sizeof mass);
    mass.mass = 1.0f;
    mass.center = kit_vec(0.5f, 0.0f, 0.0f);
    mass.inertia.x.x = mass.inertia.y.y = mass.inertia.z.z = 1.0f;
    OK(talus_body_set_mass(&world, body, &mass));
    OK(talus_body_apply_angular_impulse(&world, body, kit_vec(0.0f, 0.0f, (float)PI)));
    kit_steps(&world, 60); /* half a turn about (0.5, 0, 0), rounded 240 times */
    CLOSE(kit_place(&world, body).x, 1.0, 1e-4);
    CLOSE(kit_place(&world, body).y, 0.0, 1e-4);
    kit_end(&world);
}

/* Locked axes do not move at all, whatever is hit; the others do. */
static void locks_hold(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.5f);
    talus_body plane[6], free_body;
    for (int i = 0; i < 6; i++) {
        plane[i] = box_of(&world, kit_vec(0.2f * (float)(i % 2), 0.6f + 1.2f * (float)i, 0.13f * (float)(i % 3)),
                          kit_vec(0.5f, 0.4f, 0.3f), 0.5f);
        OK(talus_body_set_locks(&world, plane[i], TALUS_LOCK_PLANE_Z));
        set_velocity(&world, plane[i], kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 1.0f));
    }
    free_body = kit_ball(&world, kit_vec(0.1f, 4.0f, 4.0f), 0.4f);
    set_velocity(&world, free_body, kit_vec(0.0f, 0.0f, -8.0f), kit_vec(0.0f, 0.0f, 0.0f));
    double turns = 0.0;
    for (int k = 0; k < 300; k++) {
        step(&world);
        for (int i = 0; i < 6; i++) {
            talus_pose pose = kit_pose_of(&world, plane[i]);
            CLOSE(pose.position.z, 0.13f * (float)(i % 3), 0.0);
            CLOSE(pose.rotation.x, 0.0, 1e-6); /* the rotation is made unit again and again */
            CLOSE(pose.rotation.y, 0.0, 1e-6);
            turns += fabs((double)kit_spin(&world, plane[i]).z);
        }
    }
    assert_true(turns > 1.0);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fall_is_exact),   cmocka_unit_test(fall),     cmocka_unit_test(damped_throw),
        cmocka_unit_test(gravity_scales),  cmocka_unit_test(force),    cmocka_unit_test(torque),
        cmocka_unit_test(force_at_an_arm), cmocka_unit_test(impulses), cmocka_unit_test(turns_about_its_mass),
        cmocka_unit_test(locks_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
