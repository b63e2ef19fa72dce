/* What hangs: pendulums, chains, ropes. */
#include "analytic_kit.h"

/* A rod's end at the origin, its other end at angle `a` from straight down, in the x y plane. */
static talus_body rod(talus_world *world, double a, double length, float mass) {
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = TALUS_DYNAMIC;
    def.pose.position = kit_vec((float)(0.5 * length * sin(a)), (float)(-0.5 * length * cos(a)), 0.0f);
    def.pose.rotation.z = (float)sin(0.5 * a), def.pose.rotation.w = (float)cos(0.5 * a);
    OK(talus_body_create(world, &def, &body));
    talus_mass m;
    memset(&m, 0, sizeof m);
    m.mass = mass;
    m.inertia.x.x = m.inertia.z.z = (float)((double)mass * length * length / 12.0);
    m.inertia.y.y = 0.1f * m.inertia.x.x;
    OK(talus_body_set_mass(world, body, &m));
    return body;
}
/* The hinge's axis is the frames' x; turned to the world's z here. */
static void hinge(talus_world *world, talus_body a, talus_vec3 at_a, talus_body b, talus_vec3 at_b, int ball) {
    talus_joint_def def = talus_joint_def_default();
    if (ball) {
        talus_joint_make_ball(&def);
    } else {
        talus_joint_make_revolute(&def);
    }
    def.a = a, def.b = b;
    def.frame_a.position = at_a, def.frame_b.position = at_b;
    def.frame_a.rotation = def.frame_b.rotation = x_to_z();
    join(world, &def);
}

/* A rod that swings about its end: 2 pi sqrt(2 l / 3 g) / agm(1, cos(a / 2)). The rows follow the turning rod from
 * sub-step to sub-step by a rule of second order: w^2 h^2 / 12, and the swing must not die down nor grow; 0.5 % of the
 * period, and 1 % of the height in 20 s. */
static void pendulum(void **state) {
    (void)state;
    const double degrees[] = {5.0, 30.0, 90.0, 150.0};
    for (int i = 0; i < 4; i++) {
        for (int ball = 0; ball < 2; ball++) {
            const double a = degrees[i] * PI / 180.0, length = 1.5;
            talus_world world = world_of(0.0f, (float)-G, 0.0f);
            talus_body body = rod(&world, a, length, 3.0f);
            hinge(&world, talus_world_ground(&world), kit_vec(0.0f, 0.0f, 0.0f), body,
                  kit_vec(0.0f, (float)(0.5 * length), 0.0f), ball);
            period p;
            memset(&p, 0, sizeof p);
            double top = 0.0;
            for (int k = 1; k <= 1200; k++) {
                step(&world);
                double angle = angle_z(&world, body);
                angle = angle > PI ? angle - 2.0 * PI : angle < -PI ? angle + 2.0 * PI : angle;
                period_feed(&p, k / 60.0, angle, 1.0 / 60.0);
                top = k > 900 ? fmax(top, 1.0 - cos(angle)) : 0.0;
            }
            double wanted = 2.0 * PI * sqrt(2.0 * length / (3.0 * G)) / agm(1.0, cos(0.5 * a));
            CLOSE(period_of(&p), wanted, 0.005 * wanted);
            CLOSE(top, 1.0 - cos(a), 0.02 * (1.0 - cos(a)));
            kit_end(&world);
        }
    }
}

static double energy_of(const talus_world *world, const talus_body *body, int count, double mass, double length) {
    double e = 0.0;
    for (int i = 0; i < count; i++) {
        talus_vec3 v = kit_velocity(world, body[i]), w = kit_spin(world, body[i]);
        e += 0.5 * mass * (double)(v.x * v.x + v.y * v.y + v.z * v.z);
        e += 0.5 * mass * length * length / 12.0 * (double)(w.z * w.z);
        e += mass * G * (double)kit_place(world, body[i]).y;
    }
    return e;
}

/* Two rods let go level: ten seconds of chaos. The joints' rule keeps a single rod's energy but for a thousandth;
 * between two that pull at each other one pass a sub-step leaves an error of first order: a quarter of the 2 m g l that
 * there is to lose at 4 sub-steps, and less the more there are. */
static void double_pendulum(void **state) {
    (void)state;
    const double length = 1.0;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body[2];
    body[0] = rod(&world, 0.5 * PI, length, 1.0f);
    body[1] = rod(&world, 0.5 * PI, length, 1.0f);
    talus_pose pose = kit_pose_of(&world, body[1]);
    pose.position.x += (float)length;
    OK(talus_body_set_pose(&world, body[1], &pose));
    hinge(&world, talus_world_ground(&world), kit_vec(0.0f, 0.0f, 0.0f), body[0], kit_vec(0.0f, 0.5f, 0.0f), 0);
    hinge(&world, body[0], kit_vec(0.0f, -0.5f, 0.0f), body[1], kit_vec(0.0f, 0.5f, 0.0f), 0);
    double worst = 0.0;
    for (int k = 1; k <= 600; k++) {
        step(&world);
        worst = fmax(worst, fabs(energy_of(&world, body, 2, 1.0, length)));
    }
    BELOW(worst, 0.3 * 2.0 * G * length);
    kit_end(&world);
}

/* Twenty links that hang: no longer than they are, a tenth of a millimetre a joint, at rest and with a load of a
 * hundred times a link's mass. */
static void chain(void **state) {
    (void)state;
    for (int heavy = 0; heavy < 2; heavy++) {
        talus_world world = world_of(0.0f, (float)-G, 0.0f);
        talus_body before = talus_world_ground(&world), link = before;
        for (int i = 0; i < 20; i++) {
            link = rod(&world, 0.0, 0.25, heavy && i == 19 ? 100.0f : 1.0f);
            talus_pose pose = kit_pose(0.0f, -0.125f - 0.25f * (float)i, 0.0f);
            OK(talus_body_set_pose(&world, link, &pose));
            hinge(&world, before, kit_vec(0.0f, i ? -0.125f : 0.0f, 0.0f), link, kit_vec(0.0f, 0.125f, 0.0f), 1);
            before = link;
        }
        kit_steps(&world, 600);
        CLOSE(kit_place(&world, link).y, -0.25 * 19.5, heavy ? 0.1 : 20.0 * 1e-4);
        kit_end(&world);
    }
}

/* A rope of one metre: a ball at its end falls freely until it is taut, and then hangs or swings at that length. */
static void rope(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body = ball_of(&world, kit_vec(0.3f, 0.0f, 0.0f), 0.1f, 2.0f, 0.0f, 0.5f);
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_distance(&def, 0.0f, 1.0f);
    def.b = body;
    join(&world, &def);
    kit_steps(&world, 20); /* 0.545 m down: not taut yet */
    CLOSE(kit_place(&world, body).y, -0.5 * G / 9.0, 1e-2);
    CLOSE(kit_place(&world, body).x, 0.3, 1e-6);
    double longest = 0.0;
    for (int k = 0; k < 600; k++) {
        step(&world);
        longest = fmax(longest, (double)kit_length(kit_place(&world, body)));
    }
    CLOSE(longest, 1.0, 5e-3);
    kit_end(&world);
}

/* A conical pendulum on a rod without mass: w^2 l cos a = g, and the angle stays. The first step begins without the
 * rod's pull and leaves a nod of 3 cm, 1.5 % of the length, and so of the pull. */
static void conical(void **state) {
    (void)state;
    const double a = 0.6, length = 2.0, rate = sqrt(G / (length * cos(a)));
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    talus_body body =
        ball_of(&world, kit_vec((float)(length * sin(a)), (float)(-length * cos(a)), 0.0f), 0.05f, 1.0f, 0.0f, 0.5f);
    set_velocity(&world, body, kit_vec(0.0f, 0.0f, (float)(-rate * length * sin(a))), kit_vec(0.0f, 0.0f, 0.0f));
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_distance(&def, (float)length, (float)length);
    def.b = body;
    talus_joint joint = join(&world, &def);
    period p;
    memset(&p, 0, sizeof p);
    double low = 0.0, high = -10.0;
    for (int k = 1; k <= 1200; k++) {
        step(&world);
        period_feed(&p, k / 60.0, (double)kit_place(&world, body).x, 1.0 / 60.0);
        low = fmin(low, (double)kit_place(&world, body).y), high = fmax(high, (double)kit_place(&world, body).y);
        CLOSE(kit_length(kit_place(&world, body)), length, 1e-3);
    }
    CLOSE(period_of(&p), 2.0 * PI / rate, 0.005 * 2.0 * PI / rate);
    CLOSE(low, -length * cos(a), 0.015 * length);
    CLOSE(high, -length * cos(a), 0.015 * length);
    talus_vec3 force, torque;
    OK(talus_joint_get_reaction(&world, joint, &force, &torque));
    CLOSE(kit_length(force), G / cos(a), 0.03 * G);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pendulum), cmocka_unit_test(double_pendulum), cmocka_unit_test(chain),
        cmocka_unit_test(rope),     cmocka_unit_test(conical),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
