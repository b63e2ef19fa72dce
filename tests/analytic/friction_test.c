/* Friction, rolling, and what carries things along. Slopes are floors under tilted gravity. */
#include "analytic_kit.h"

/* Below the angle of friction a box stands: the most that it creeps in five seconds is a tenth of a millimetre. */
static void box_stands(void **state) {
    (void)state;
    const double shares[] = {0.0, 0.5, 0.9, 0.98};
    for (int i = 0; i < 4; i++) {
        talus_world world = world_on_slope(atan(0.5 * shares[i]));
        floor_of(&world, 0.5f);
        talus_body body = box_of(&world, kit_vec(0.0f, 0.25f, 0.0f), kit_vec(0.5f, 0.25f, 0.5f), 0.5f);
        kit_steps(&world, 30);
        talus_vec3 from = kit_place(&world, body);
        kit_steps(&world, 300);
        BELOW(kit_place(&world, body).x - from.x, 1e-4);
        CLOSE(kit_place(&world, body).y, 0.25, 2e-3);
        kit_end(&world);
    }
}

/* At 0.99 of the angle of friction, with sleep off, for half a minute (TALUS_WHOLE=1: ten): no creep. */
static void box_holds(void **state) {
    (void)state;
    const int seconds = getenv("TALUS_WHOLE") ? 600 : 30;
    const double mus[] = {0.2, 0.5, 1.0};
    for (int i = 0; i < 3; i++) {
        talus_world world = world_on_slope(0.99 * atan(mus[i]));
        floor_of(&world, (float)mus[i]);
        talus_body body = box_of(&world, kit_vec(0.0f, 0.25f, 0.0f), kit_vec(0.5f, 0.25f, 0.5f), (float)mus[i]);
        kit_steps(&world, 60);
        talus_vec3 from = kit_place(&world, body);
        kit_steps(&world, 60 * seconds);
        talus_vec3 to = kit_place(&world, body);
        print_message("  friction %.1f, 0.99 of its angle: crept %.3g mm in %d s\n", mus[i],
                      1e3 * (double)(to.x - from.x), seconds);
        BELOW(to.x - from.x, 1e-4);
        BELOW(to.z - from.z, 1e-4);
        kit_end(&world);
    }
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* How far half of sixty boxes, let fall from `above`, drift in the time after they came to rest, with sleep off. */
static double heap_drift(float above, int seconds) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = def.shape_capacity = 80;
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    talus_body body[60];
    talus_vec3 from[60];
    double way[60];
    floor_of(&world, 0.6f);
    for (int i = 0; i < 60; i++) {
        talus_vec3 at = kit_vec(0.45f * (float)(i % 3) + 0.05f * (float)(i % 7), above + 0.5f * (float)(i / 6),
                                0.5f * (float)(i / 3 % 2) + 0.04f * (float)(i % 5));
        body[i] = box_of(&world, at, kit_vec(0.2f, 0.15f, 0.25f), 0.6f);
    }
    kit_steps(&world, 900);
    for (int i = 0; i < 60; i++) {
        from[i] = kit_place(&world, body[i]);
    }
    kit_steps(&world, 60 * seconds);
    for (int i = 0; i < 60; i++) {
        talus_vec3 to = kit_place(&world, body[i]);
        way[i] = (double)kit_length(kit_vec(to.x - from[i].x, to.y - from[i].y, to.z - from[i].z));
    }
    qsort(way, 60, sizeof *way, by_size);
    print_message("  heap: half drift less than %.3g mm, one in ten more than %.3g mm, in %d s\n", 1e3 * way[30],
                  1e3 * way[54], seconds);
    kit_end(&world);
    return way[30];
}

/* Three heaps for a quarter of a minute (TALUS_WHOLE=1: a minute). Of two of them half the boxes must not drift; of
 * others it is known that they wobble or find a way down, and how a heap falls is chance. */
static void heap_rests(void **state) {
    (void)state;
    const int seconds = getenv("TALUS_WHOLE") ? 60 : 15;
    double drift[3];
    for (int i = 0; i < 3; i++) {
        drift[i] = heap_drift(0.4f + 0.002f * (float)i, seconds);
    }
    qsort(drift, 3, sizeof *drift, by_size);
    BELOW(drift[1], 1e-4);
}

/* Above it the box slides at g (sin a - mu cos a). The normal force swings about its mean while the contact settles: 1
 * % of friction's part. */
static void box_slides(void **state) {
    (void)state;
    const double angles[] = {0.5, 0.6, 0.8, 1.0}, mus[] = {0.0, 0.2, 0.5};
    for (int i = 0; i < 4; i++) {
        for (int m = 0; m < 3; m++) {
            talus_world world = world_on_slope(angles[i]);
            floor_of(&world, (float)mus[m]);
            talus_body body = box_of(&world, kit_vec(0.0f, 0.2f, 0.0f), kit_vec(0.8f, 0.2f, 0.8f), (float)mus[m]);
            kit_steps(&world, 120);
            const double a = G * (sin(angles[i]) - mus[m] * cos(angles[i]));
            const double slack = 0.01 * mus[m] * G * cos(angles[i]) + 2e-4;
            CLOSE(kit_velocity(&world, body).x, 2.0 * a, 2.0 * slack);
            CLOSE(kit_place(&world, body).x, 2.0 * a, 2.0 * slack + SUB * a);
            CLOSE(kit_velocity(&world, body).z, 0.0, 1e-3);
            BELOW(kit_length(kit_spin(&world, body)), 1e-2);
            kit_end(&world);
        }
    }
}

/* v^2 / (2 mu g), and sliding friction is that of what slides, whatever holds it when it stands. The path is summed
 * with the speed after each sub-step: v h / 2 short; 1 % besides. */
static void box_stops(void **state) {
    (void)state;
    const double mus[] = {0.1, 0.3, 0.6}, speeds[] = {1.0, 3.0, 6.0};
    for (int m = 0; m < 3; m++) {
        for (int s = 0; s < 3; s++) {
            talus_world world = world_on_slope(0.0);
            talus_shape_def def = kit_box_def(500.0f, 1.0f, 500.0f);
            def.pose.position.y = -1.0f;
            def.material.static_friction = 0.9f;
            def.material.dynamic_friction = (float)mus[m];
            kit_shape(&world, talus_world_ground(&world), &def);
            talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.2f, 0.0f));
            def.geometry.half = kit_vec(1.0f, 0.2f, 1.0f);
            def.pose.position.y = 0.0f;
            kit_shape(&world, body, &def);
            kit_steps(&world, 20); /* comes to rest on its spring */
            double from = (double)kit_place(&world, body).x;
            set_velocity(&world, body, kit_vec((float)speeds[s], 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
            kit_steps(&world, 420);
            const double way = speeds[s] * speeds[s] / (2.0 * mus[m] * G);
            CLOSE((double)kit_place(&world, body).x - from, way, 0.01 * way + speeds[s] * SUB);
            BELOW(kit_velocity(&world, body).x, 0.5 * 1.9e-6 / SUB); /* less is no motion: a place is rounded */
            kit_end(&world);
        }
    }
}

/* Static friction holds on a slope on which the sliding one does not stop what was pushed. */
static void standing_and_sliding(void **state) {
    (void)state;
    const double angle = atan(0.5);
    talus_world world = world_on_slope(angle);
    talus_shape_def def = kit_box_def(500.0f, 1.0f, 500.0f);
    def.pose.position.y = -1.0f;
    def.material.static_friction = 0.6f;
    def.material.dynamic_friction = 0.3f;
    kit_shape(&world, talus_world_ground(&world), &def);
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.2f, 0.0f));
    def.geometry.half = kit_vec(1.0f, 0.2f, 1.0f);
    def.pose.position.y = 0.0f;
    kit_shape(&world, body, &def);
    kit_steps(&world, 120);
    BELOW(kit_place(&world, body).x, 5e-3);
    set_velocity(&world, body, kit_vec(1.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
    kit_steps(&world, 60);
    const double a = G * (sin(angle) - 0.3 * cos(angle));
    CLOSE(kit_velocity(&world, body).x, 1.0 + a, 0.02 * a);
    kit_end(&world);
}

/* The cone is round: pushed in 16 directions a box comes to rest at one distance, straight ahead. 1 % and half a
 * degree. */
static void isotropy(void **state) {
    (void)state;
    for (int i = 0; i < 16; i++) {
        talus_world world = world_on_slope(0.0);
        floor_of(&world, 0.4f);
        talus_body body = box_of(&world, kit_vec(0.0f, 0.2f, 0.0f), kit_vec(0.7f, 0.2f, 0.7f), 0.4f);
        kit_steps(&world, 20);
        double angle = 2.0 * PI * i / 16.0 + 0.1, c = cos(angle), s = sin(angle);
        talus_vec3 from = kit_place(&world, body);
        set_velocity(&world, body, kit_vec((float)(3.0 * c), 0.0f, (float)(3.0 * s)), kit_vec(0.0f, 0.0f, 0.0f));
        kit_steps(&world, 120);
        talus_vec3 to = kit_place(&world, body);
        double x = (double)to.x - (double)from.x, z = (double)to.z - (double)from.z, way = 9.0 / (2.0 * 0.4 * G);
        CLOSE(x * c + z * s, way, 0.01 * way + 3.0 * SUB);
        CLOSE(z * c - x * s, 0.0, way * sin(0.5 * PI / 180.0));
        CLOSE(angle_z(&world, body), 0.0, 0.01);
        kit_end(&world);
    }
}

/* A ball rolls down at 5/7 g sin a while friction is more than 2/7 tan a, and slips at g (sin a - mu cos a) where not.
 * Half a per cent. */
static void ball_rolls(void **state) {
    (void)state;
    const double angles[] = {0.1, 0.3, 0.6, 0.6}, mus[] = {0.5, 0.5, 0.5, 0.1};
    for (int i = 0; i < 4; i++) {
        talus_world world = world_on_slope(angles[i]);
        floor_of(&world, (float)mus[i]);
        talus_body body = ball_of(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f, 2.0f, 0.0f, (float)mus[i]);
        kit_steps(&world, 120);
        double roll = 5.0 / 7.0 * G * sin(angles[i]), slip = G * (sin(angles[i]) - mus[i] * cos(angles[i]));
        double a = mus[i] > 2.0 / 7.0 * tan(angles[i]) ? roll : slip;
        CLOSE(kit_velocity(&world, body).x, 2.0 * a, 0.005 * 2.0 * a);
        CLOSE(kit_place(&world, body).x, 2.0 * a, 0.005 * 2.0 * a + 2.0 * a * SUB);
        if (a == roll) {
            CLOSE(-0.5 * (double)kit_spin(&world, body).z, 2.0 * a, 0.005 * 2.0 * a);
        } else { /* M = 2/5 m r^2 dw/dt = mu m g cos a r */
            CLOSE(-0.5 * (double)kit_spin(&world, body).z, 5.0 * mus[i] * G * cos(angles[i]), 0.01 * 5.0 * mus[i] * G);
        }
        kit_end(&world);
    }
}

/* A ball thrown without spin slips until it rolls at 5/7 of its speed. */
static void ball_starts_to_roll(void **state) {
    (void)state;
    talus_world world = world_on_slope(0.0);
    floor_of(&world, 0.3f);
    talus_body body = ball_of(&world, kit_vec(0.0f, 0.25f, 0.0f), 0.25f, 1.0f, 0.0f, 0.3f);
    set_velocity(&world, body, kit_vec(7.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
    kit_steps(&world, 120);
    CLOSE(kit_velocity(&world, body).x, 5.0, 0.01);
    CLOSE(kit_spin(&world, body).z, -20.0, 0.05);
    kit_end(&world);
}

/* The normal force at a lever of rho slows a rolling ball by 5/7 g rho / r, within 1 %, and holds it on slopes below
 * rho / r, but for a creep of a few thousandths of g sin a, for each step begins without what held it in the last one.
 */
static void rolling_resistance(void **state) {
    (void)state;
    const double levers[] = {0.005, 0.02, 0.05}, r = 0.5;
    for (int i = 0; i < 3; i++) {
        for (int slope = 0; slope < 2; slope++) {
            talus_world world = world_on_slope(slope ? atan(0.9 * levers[i] / r) : 0.0);
            floor_of(&world, 0.8f);
            talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, (float)r, 0.0f));
            talus_shape_def def = kit_ball_def((float)r);
            def.material.static_friction = def.material.dynamic_friction = 0.8f;
            def.material.rolling_resistance = (float)levers[i];
            kit_shape(&world, body, &def);
            if (slope) {
                kit_steps(&world, 120);
                BELOW(kit_velocity(&world, body).x, 2e-3);
                BELOW(kit_place(&world, body).x, 6e-3);
            } else {
                kit_steps(&world, 20);
                set_velocity(&world, body, kit_vec(2.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, (float)(-2.0 / r)));
                kit_steps(&world, 60);
                const double a = 5.0 / 7.0 * G * levers[i] / r;
                CLOSE(kit_velocity(&world, body).x, 2.0 - a, 0.01 * a);
            }
            kit_end(&world);
        }
    }
}

static talus_body slab(talus_world *world, talus_vec3 linear, talus_vec3 angular, float friction) {
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = TALUS_KINEMATIC;
    def.linear_velocity = linear, def.angular_velocity = angular;
    OK(talus_body_create(world, &def, &body));
    talus_shape_def shape = kit_box_def(50.0f, 0.5f, 50.0f);
    shape.pose.position.y = -0.5f;
    shape.material.static_friction = shape.material.dynamic_friction = friction;
    kit_shape(world, body, &shape);
    return body;
}

/* A platform takes a box along: it slips until it has the platform's speed, v^2 / (2 mu g) behind, and then stands on
 * it. */
static void platform_carries(void **state) {
    (void)state;
    talus_world world = world_on_slope(0.0);
    talus_body platform = slab(&world, kit_vec(3.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_body body = box_of(&world, kit_vec(0.0f, 0.2f, 0.0f), kit_vec(0.6f, 0.2f, 0.6f), 0.5f);
    kit_steps(&world, 300);
    const double behind = 9.0 / (2.0 * 0.5 * G);
    CLOSE(kit_velocity(&world, body).x, 3.0, 1e-3);
    CLOSE((double)kit_place(&world, platform).x - (double)kit_place(&world, body).x, behind, 0.01 * behind + 3.0 * SUB);
    /* Up and down it goes with it too. */
    set_velocity(&world, platform, kit_vec(0.0f, 0.5f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
    kit_steps(&world, 120);
    CLOSE(kit_place(&world, body).y, 1.0 + 0.2, 3e-3);
    CLOSE(kit_velocity(&world, body).y, 0.5, 1e-3);
    kit_end(&world);
}

/* On a turntable a box stays where w^2 r < mu g, going round with it, and leaves from where not. */
static void turntable(void **state) {
    (void)state;
    for (int leaves = 0; leaves < 2; leaves++) {
        const double w = 1.5, r = leaves ? 3.0 : 1.0, time = 5.0; /* mu g / w^2 = 2.18 m */
        talus_world world = world_on_slope(0.0);
        talus_body table = slab(&world, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, (float)w, 0.0f), 0.5f);
        talus_body body = box_of(&world, kit_vec((float)r, 0.1f, 0.0f), kit_vec(0.2f, 0.1f, 0.2f), 0.5f);
        set_velocity(&world, body, kit_vec(0.0f, 0.0f, (float)(-w * r)), kit_vec(0.0f, (float)w, 0.0f));
        kit_steps(&world, 300);
        talus_vec3 x = kit_place(&world, body);
        double away = sqrt((double)(x.x * x.x + x.z * x.z));
        if (leaves) {
            assert_true(away > 4.0);
        } else { /* the point of the table that it holds to is that of when the step began: on a polygon with a corner a
                    step it goes outwards by (w dt)^2 / 2 of the radius each time */
            CLOSE(away, r, 1.2 * r * (exp(0.5 * w * w * time / 60.0) - 1.0));
            CLOSE(kit_spin(&world, body).y, w, 0.01);
        }
        assert_true(talus_body_is_valid(&world, table));
        kit_end(&world);
    }
}

/* A ball that rolls on a turntable goes in circles at 2/7 of the table's rate, wherever they are (Milner, "Motion of a
 * ball on a rotating turntable", 1981). A percent of the rate; the circle widens by some percent a turn, as above. */
static void ball_on_a_turntable(void **state) {
    (void)state;
    const double w = 3.5, r = 0.25, x0 = 1.0, v0 = -0.5; /* m/s in z: 2/7 w is 1 rad/s, a circle of 0.5 m */
    talus_world world = world_on_slope(0.0);
    talus_body table = slab(&world, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, (float)w, 0.0f), 0.8f);
    talus_body body = ball_of(&world, kit_vec((float)x0, (float)r, 0.0f), (float)r, 1.0f, 0.0f, 0.8f);
    kit_steps(&world, 1);
    /* Rolling: v + spin x (0, -r, 0) is the table's speed (w z, -w x); spin x (0, -r, 0) = (r spin_z, 0, -r spin_x). */
    talus_pose at = kit_pose((float)x0, (float)r, 0.0f);
    OK(talus_body_set_pose(&world, body, &at));
    set_velocity(&world, body, kit_vec(0.0f, 0.0f, (float)v0), kit_vec((float)((v0 + w * x0) / r), 0.0f, 0.0f));
    period p;
    memset(&p, 0, sizeof p);
    double low = 1e9, high = -1e9;
    for (int i = 1; i <= 1200; i++) {
        step(&world);
        period_feed(&p, i / 60.0, (double)kit_velocity(&world, body).z, 1.0 / 60.0);
        if (i > 400) {
            continue;
        }
        low = fmin(low, (double)kit_place(&world, body).x), high = fmax(high, (double)kit_place(&world, body).x);
    }
    CLOSE(period_of(&p), 2.0 * PI / (2.0 / 7.0 * w), 0.01 * 2.0 * PI);
    CLOSE(high - low, 1.0, 0.06);
    assert_true(talus_body_is_valid(&world, table));
    kit_end(&world);
}

/* A plank on two drums that turn against each other swings as a spring would: mu g / d is the square of its rate, 2 d
 * the distance of the drums. The drums' speed is above the plank's, so that friction never holds. 2 % of the period;
 * the swing may widen by a third in 20 s. */
static void plank_on_two_drums(void **state) {
    (void)state;
    const double d = 1.0, mu = 0.3, rate = sqrt(mu * G / d);
    talus_world world = world_on_slope(0.0);
    for (int k = 0; k < 2; k++) {
        talus_body_def def = talus_body_def_default();
        talus_body drum;
        def.type = TALUS_KINEMATIC;
        def.pose.position = kit_vec((float)(k ? d : -d), -0.25f, 0.0f);
        def.angular_velocity.z = k ? 20.0f : -20.0f; /* the tops go inwards */
        OK(talus_body_create(&world, &def, &drum));
        talus_shape_def shape = kit_ball_def(0.25f);
        shape.material.static_friction = shape.material.dynamic_friction = (float)mu;
        shape.geometry.type = TALUS_CYLINDER;
        shape.geometry.half_height = 0.5f;
        shape.geometry.radius_top = shape.geometry.radius_bottom = 0.25f;
        shape.pose.rotation.x = shape.pose.rotation.w = 0.70710678f; /* its axis along z */
        kit_shape(&world, drum, &shape);
    }
    talus_body plank = box_of(&world, kit_vec(0.3f, 0.05f, 0.0f), kit_vec(2.5f, 0.05f, 0.4f), (float)mu);
    period p;
    memset(&p, 0, sizeof p);
    double most = 0.0;
    for (int i = 1; i <= 1200; i++) {
        step(&world);
        period_feed(&p, i / 60.0, (double)kit_place(&world, plank).x, 1.0 / 60.0);
        most = i > 900 ? fmax(most, fabs((double)kit_place(&world, plank).x)) : most;
    }
    CLOSE(period_of(&p), 2.0 * PI / rate, 0.02 * 2.0 * PI / rate);
    CLOSE(most, 0.3, 0.1);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_stands),
        cmocka_unit_test(box_holds),
        cmocka_unit_test(heap_rests),
        cmocka_unit_test(box_slides),
        cmocka_unit_test(box_stops),
        cmocka_unit_test(standing_and_sliding),
        cmocka_unit_test(isotropy),
        cmocka_unit_test(ball_rolls),
        cmocka_unit_test(ball_starts_to_roll),
        cmocka_unit_test(rolling_resistance),
        cmocka_unit_test(platform_carries),
        cmocka_unit_test(turntable),
        cmocka_unit_test(ball_on_a_turntable),
        cmocka_unit_test(plank_on_two_drums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
