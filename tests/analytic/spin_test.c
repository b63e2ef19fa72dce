/* Rotation: free bodies, the flip about the middle axis, precession. */
#include "analytic_kit.h"

static void momentum_of(const talus_world *world, talus_body body, const double inertia[3], double out[3],
                        double *energy) {
    talus_quat q = kit_pose_of(world, body).rotation, back = {-q.x, -q.y, -q.z, q.w};
    talus_vec3 w = kit_spin(world, body);
    const double v[3] = {(double)w.x, (double)w.y, (double)w.z};
    double own[3];
    turned(back, v, own);
    *energy = 0.0;
    for (int k = 0; k < 3; k++) {
        *energy += 0.5 * inertia[k] * own[k] * own[k];
        own[k] *= inertia[k];
    }
    turned(q, own, out);
}

/* Ten seconds of free turning. The momentum is carried as a number of its own: only the rounding between it and the
 * spin that the world tells is left, a few times 1e-7. The midpoint rule keeps the energy but for what its iterations
 * leave, of the third power of the turn of a sub-step. */
static void free_body_keeps(void **state) {
    (void)state;
    const double inertias[4][3] = {{1.0, 2.0, 2.5}, {1.0, 1.0, 0.2}, {1.0, 5.0, 5.9}, {3.0, 3.1, 3.2}};
    const float spins[3][3] = {{1.0f, 2.0f, -3.0f}, {0.1f, 12.0f, 0.1f}, {20.0f, 5.0f, 3.0f}};
    for (int i = 0; i < 4; i++) {
        for (int s = 0; s < 3; s++) {
            talus_world world = kit_void();
            const double *in = inertias[i];
            talus_body body =
                mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 1.0f, (float)in[0], (float)in[1], (float)in[2]);
            set_velocity(&world, body, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(spins[s][0], spins[s][1], spins[s][2]));
            double l0[3], l[3], e0, e, worst = 0.0;
            momentum_of(&world, body, in, l0, &e0);
            double size = sqrt(l0[0] * l0[0] + l0[1] * l0[1] + l0[2] * l0[2]);
            double drift = 0.0;
            for (int k = 0; k < 600; k++) {
                step(&world);
                momentum_of(&world, body, in, l, &e);
                double d = sqrt((l[0] - l0[0]) * (l[0] - l0[0]) + (l[1] - l0[1]) * (l[1] - l0[1]) +
                                (l[2] - l0[2]) * (l[2] - l0[2]));
                drift = fmax(drift, d / size);
                worst = fmax(worst, fabs(e / e0 - 1.0));
            }
            BELOW(drift, 2e-6);
            BELOW(worst, 2e-3);
            kit_end(&world);
        }
    }
}

/* Euler's equations in the body's frame by the classical Runge-Kutta rule. */
static void euler_rate(const double i[3], const double w[3], double out[3]) {
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        out[k] = (i[a] - i[b]) * w[a] * w[b] / i[k];
    }
}
static void euler_step(const double i[3], double w[3], double h) {
    double k1[3], k2[3], k3[3], k4[3], t[3];
    euler_rate(i, w, k1);
    for (int k = 0; k < 3; k++) {
        t[k] = w[k] + 0.5 * h * k1[k];
    }
    euler_rate(i, t, k2);
    for (int k = 0; k < 3; k++) {
        t[k] = w[k] + 0.5 * h * k2[k];
    }
    euler_rate(i, t, k3);
    for (int k = 0; k < 3; k++) {
        t[k] = w[k] + h * k3[k];
    }
    euler_rate(i, t, k4);
    for (int k = 0; k < 3; k++) {
        w[k] += h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]);
    }
}

/* A handle spun about its middle axis turns over and over. The midpoint rule is of second order: (w h)^2 / 12 = 4e-5 of
 * the rates at 5 rad/s. What the energy has beyond that of the middle axis alone, 1e-4 of it by a seed of 0.1 rad/s, is
 * what the period depends on, and rounding of the pose wanders by 2e-6 in a flip: 1 % of the period. */
static void handle_flips(void **state) {
    (void)state;
    const double in[3] = {1.0, 2.0, 3.0};
    double w[3] = {0.1, 5.0, 0.0};
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 1.0f, 1.0f, 2.0f, 3.0f);
    set_velocity(&world, body, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.1f, 5.0f, 0.0f));
    period theirs, ours;
    memset(&theirs, 0, sizeof theirs);
    memset(&ours, 0, sizeof ours);
    for (int k = 1; k <= 3600; k++) {
        step(&world);
        for (int s = 0; s < 64; s++) {
            euler_step(in, w, 1.0 / (60.0 * 64.0));
        }
        talus_quat q = kit_pose_of(&world, body).rotation, back = {-q.x, -q.y, -q.z, q.w};
        talus_vec3 v = kit_spin(&world, body);
        const double spin[3] = {(double)v.x, (double)v.y, (double)v.z};
        double own[3];
        turned(back, spin, own);
        period_feed(&ours, k / 60.0, own[1], 1.0 / 60.0);
        period_feed(&theirs, k / 60.0, w[1], 1.0 / 60.0);
    }
    assert_true(theirs.crossings >= 5);
    CLOSE(ours.crossings, theirs.crossings, 0.0);
    CLOSE(ours.first_time, theirs.first_time, 0.01 * theirs.first_time);
    CLOSE(period_of(&ours), period_of(&theirs), 0.01 * period_of(&theirs));
    kit_end(&world);
}

/* The axis of a free symmetric body goes round its momentum at L / I1. Second order in the turn of a sub-step:
 * (0.05 rad)^2 / 12 = 2e-4 of the rate. */
static void free_precession(void **state) {
    (void)state;
    const double in[3] = {2.0, 1.0, 1.0};
    talus_world world = kit_void();
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 1.0f, 2.0f, 1.0f, 1.0f);
    set_velocity(&world, body, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(6.0f, 3.0f, 0.0f));
    double l[3], energy, across[3];
    momentum_of(&world, body, in, l, &energy);
    double size = sqrt(l[0] * l[0] + l[1] * l[1]);
    const double axis[3] = {1.0, 0.0, 0.0};
    period p;
    memset(&p, 0, sizeof p);
    for (int k = 1; k <= 1200; k++) {
        step(&world);
        turned(kit_pose_of(&world, body).rotation, axis, across);
        period_feed(&p, k / 60.0, across[2], 1.0 / 60.0);
    }
    CLOSE(period_of(&p), 2.0 * PI * in[1] / size, 1e-3 * 2.0 * PI * in[1] / size);
    kit_end(&world);
}

/* A top with its axis level and started in its steady motion: it goes round at m g r / (I w) and its axis stays level.
 * The joint's force acts along rows that lag behind the turning body, which is of first order in the sub-step: 2.5 % of
 * the rate and 5 % of the spin in ten seconds at 0.25 rad a sub-step, a quarter of that at a quarter of it. */
static void heavy_top(uint32_t substeps, double share) {
    const double mass = 2.0, arm = 0.5, i_axis = 0.09, i_side = 0.05, spin = 60.0;
    const double rate = mass * G * arm / (i_axis * spin);
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    def.substeps = substeps;
    talus_world world = kit_world(&def);
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_mass m;
    memset(&m, 0, sizeof m);
    m.mass = (float)mass;
    m.center = kit_vec((float)arm, 0.0f, 0.0f);
    m.inertia.x.x = (float)i_axis, m.inertia.y.y = m.inertia.z.z = (float)i_side;
    OK(talus_body_set_mass(&world, body, &m));
    /* The momentum about the axis is i_axis * spin along +x; gravity's torque is along +z: x cross -y = -z, so the axis
     * goes towards -z, about +y. */
    set_velocity(&world, body, kit_vec(0.0f, 0.0f, (float)(-rate * arm)), kit_vec((float)spin, (float)rate, 0.0f));
    talus_joint_def joint = talus_joint_def_default();
    talus_joint_make_ball(&joint);
    joint.a = talus_world_ground(&world), joint.b = body;
    join(&world, &joint);
    const double axis[3] = {1.0, 0.0, 0.0};
    double now[3], gone = 0.0, last = 0.0, worst = 0.0;
    for (int k = 1; k <= 600; k++) {
        step(&world);
        turned(kit_pose_of(&world, body).rotation, axis, now);
        double angle = atan2(-now[2], now[0]), d = angle - last;
        gone += d < -PI ? d + 2.0 * PI : d > PI ? d - 2.0 * PI : d;
        last = angle;
        worst = fmax(worst, fabs(now[1]));
    }
    talus_vec3 w = kit_spin(&world, body);
    CLOSE(gone / 10.0, rate, share * rate);
    CLOSE((double)w.x * now[0] + (double)w.y * now[1] + (double)w.z * now[2], spin, 2.0 * share * spin);
    BELOW(worst, 0.6 * share);
    kit_end(&world);
}
static void heavy_top_goes_round(void **state) {
    (void)state;
    heavy_top(4, 0.025);
    heavy_top(16, 0.00625);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_body_keeps),
        cmocka_unit_test(handle_flips),
        cmocka_unit_test(free_precession),
        cmocka_unit_test(heavy_top_goes_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
