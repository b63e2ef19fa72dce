/* Contacts as a game sees them: filters, materials, events, sensors. */
#include "world_kit.h"

#define G 9.81

static talus_world earth(void) {
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    return kit_world(&def);
}

/* --- filters ---------------------------------------------------------------------------------------- */

typedef struct filter_case {
    talus_filter floor, ball;
    int collide;
} filter_case;

static void filters_choose(void **state) {
    (void)state;
    const uint64_t all = ~(uint64_t)0, top = (uint64_t)1 << 63;
    const filter_case cases[] = {
        {{1, all, 0}, {1, all, 0}, 1},   {{1, 2, 0}, {2, 1, 0}, 1},       {{1, 2, 0}, {2, 2, 0}, 0},
        {{1, 1, 0}, {2, 1, 0}, 0},       {{0, all, 0}, {1, all, 0}, 0},   {{top, all, 0}, {1, top, 0}, 1},
        {{1, all, -1}, {1, all, -1}, 0}, {{1, all, -1}, {1, all, -2}, 1}, {{1, 0, 5}, {1, 0, 5}, 1},
        {{1, 0, 5}, {1, 0, 6}, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        talus_world world = earth();
        talus_shape floor = kit_floor(&world);
        OK(talus_shape_set_filter(&world, floor, &cases[i].floor));
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.6f, 0.0f));
        talus_shape_def def = kit_ball_def(0.5f);
        def.filter = cases[i].ball;
        kit_shape(&world, body, &def);
        kit_steps(&world, 90);
        assert_true(cases[i].collide == (kit_place(&world, body).y > 0.4f));
        kit_end(&world);
    }
}

static void a_filter_set_later_counts(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_shape floor = kit_floor(&world);
    talus_body body = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    talus_filter open, shut = {1, 0, 0};
    OK(talus_shape_get_filter(&world, floor, &open));
    kit_steps(&world, 200);
    assert_int_equal(talus_body_is_awake(&world, body), 0);
    OK(talus_shape_set_filter(&world, floor, &shut));
    kit_steps(&world, 15);
    float y = kit_place(&world, body).y;
    assert_true(y < 0.3f && y > 0.0f);
    OK(talus_shape_set_filter(&world, floor, &open)); /* and pushes it out again */
    kit_steps(&world, 200);
    assert_true(kit_place(&world, body).y > 0.45f);
    kit_end(&world);
}

/* --- materials -------------------------------------------------------------------------------------- */

/* The deceleration of a block that slides, in units of g. */
static double sliding(const talus_material *floor_material, const talus_material *block_material) {
    talus_world world = earth();
    talus_shape floor = kit_floor(&world);
    OK(talus_shape_set_material(&world, floor, floor_material));
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.25f, 0.0f));
    talus_shape_def def = kit_box_def(1.0f, 0.25f, 1.0f);
    def.material = *block_material;
    kit_shape(&world, body, &def);
    kit_steps(&world, 30);
    OK(talus_body_set_velocity(&world, body, kit_vec(10.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 30);
    double slowed = 10.0 - (double)kit_velocity(&world, body).x;
    kit_end(&world);
    return slowed / (0.5 * G);
}

static talus_material material(float friction, talus_combine rule) {
    talus_material m = {friction, friction, 0.0f, 0.0f, rule, TALUS_COMBINE_AVERAGE};
    return m;
}

static void friction_combines(void **state) {
    (void)state;
    const double a = 0.3, b = 0.7;
    const double expected[TALUS_COMBINE_COUNT] = {0.5 * (a + b), a, b, a * b};
    for (int i = 0; i < TALUS_COMBINE_COUNT; i++) {
        for (int k = 0; k < TALUS_COMBINE_COUNT; k++) {
            talus_material one = material(0.3f, (talus_combine)i), two = material(0.7f, (talus_combine)k);
            NEAR(sliding(&one, &two), expected[i < k ? i : k], 0.03);
        }
    }
    talus_material ice = material(0.0f, TALUS_COMBINE_MULTIPLY);
    NEAR(sliding(&ice, &ice), 0.0, 1e-4);
}

/* On a slope: gravity leans by less and by more than the static friction bears. */
static void static_friction_holds(void **state) {
    (void)state;
    for (int slides = 0; slides < 2; slides++) {
        talus_world world = earth();
        talus_shape floor = kit_floor(&world);
        talus_material m = {0.6f, 0.3f, 0.0f, 0.0f, TALUS_COMBINE_MINIMUM, TALUS_COMBINE_AVERAGE};
        OK(talus_shape_set_material(&world, floor, &m));
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.25f, 0.0f));
        talus_shape_def def = kit_box_def(1.0f, 0.25f, 1.0f);
        def.material = m;
        kit_shape(&world, body, &def);
        kit_steps(&world, 30);
        float lean = slides ? 0.7f : 0.5f; /* tan of the slope; dynamic friction would not hold either */
        OK(talus_world_set_gravity(&world, kit_vec(9.81f * lean, -9.81f, 0.0f)));
        kit_steps(&world, 60);
        if (slides) { /* by what the dynamic one leaves */
            NEAR(kit_velocity(&world, body).x, G * (0.7 - 0.3), 0.3);
        } else {
            NEAR(kit_place(&world, body).x, 0.0, 0.005);
        }
        kit_end(&world);
    }
}

static double bounce(float floor_restitution, talus_combine floor_rule, float ball_restitution, talus_combine ball_rule,
                     float speed) {
    talus_world world = earth();
    talus_shape floor = kit_floor(&world);
    talus_material m = {0.5f, 0.5f, floor_restitution, 0.0f, TALUS_COMBINE_AVERAGE, floor_rule};
    OK(talus_shape_set_material(&world, floor, &m));
    OK(talus_world_set_gravity(&world, kit_vec(0.0f, 0.0f, 0.0f)));
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 1.0f, 0.0f));
    talus_shape_def def = kit_ball_def(0.5f);
    def.material.restitution = ball_restitution;
    def.material.restitution_combine = ball_rule;
    kit_shape(&world, body, &def);
    OK(talus_body_set_velocity(&world, body, kit_vec(0.0f, -speed, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    uint32_t struck = 0;
    for (int i = 0; i < 90; i++) {
        kit_steps(&world, 1);
        talus_counters c = kit_counters(&world);
        assert_true(c.impact_sweeps >= c.groups_struck && (c.impact_sweeps > 0) == (c.groups_bouncing > 0));
        struck += c.groups_struck;
    }
    double up = (double)kit_velocity(&world, body).y;
    assert_int_equal(struck, up > 0.1 ? 1 : 0);
    kit_end(&world);
    return up / (double)speed;
}

static void restitution_combines(void **state) {
    (void)state;
    NEAR(bounce(0.5f, TALUS_COMBINE_AVERAGE, 1.0f, TALUS_COMBINE_MAXIMUM, 4.0f), 0.75, 0.01);
    NEAR(bounce(0.5f, TALUS_COMBINE_MINIMUM, 1.0f, TALUS_COMBINE_MULTIPLY, 4.0f), 0.5, 0.01);
    NEAR(bounce(0.5f, TALUS_COMBINE_MAXIMUM, 1.0f, TALUS_COMBINE_MAXIMUM, 4.0f), 1.0, 0.01);
    NEAR(bounce(0.5f, TALUS_COMBINE_MULTIPLY, 0.8f, TALUS_COMBINE_MULTIPLY, 4.0f), 0.4, 0.01);
    NEAR(bounce(0.0f, TALUS_COMBINE_AVERAGE, 0.0f, TALUS_COMBINE_AVERAGE, 4.0f), 0.0, 0.01);
    NEAR(bounce(1.0f, TALUS_COMBINE_AVERAGE, 1.0f, TALUS_COMBINE_AVERAGE, 0.9f), 0.0, 0.02); /* below the threshold */
    NEAR(bounce(1.0f, TALUS_COMBINE_AVERAGE, 1.0f, TALUS_COMBINE_AVERAGE, 40.0f), 1.0, 0.01);
}

/* A rolling ball under the moment N b slows by g b / (1.4 r). */
static void rolling_resistance_slows(void **state) {
    (void)state;
    talus_world world = earth();
    kit_floor(&world);
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.5f, 0.0f));
    talus_shape_def def = kit_ball_def(0.5f);
    def.material.rolling_resistance = 0.02f;
    kit_shape(&world, body, &def);
    kit_steps(&world, 30);
    OK(talus_body_set_velocity(&world, body, kit_vec(3.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, -6.0f)));
    kit_steps(&world, 60);
    NEAR(kit_velocity(&world, body).x, 3.0 - G * 0.02 / (1.4 * 0.5), 0.03);
    kit_steps(&world, 1200);
    NEAR(kit_velocity(&world, body).x, 0.0, 1e-3); /* and stops, not turns back */
    kit_end(&world);
}

static void materials_set_later_count(void **state) {
    (void)state;
    talus_world world = earth();
    talus_shape floor = kit_floor(&world);
    talus_body body = kit_box(&world, kit_vec(0.0f, 0.5f, 0.0f), 0.5f);
    kit_steps(&world, 30);
    talus_material ice = material(0.0f, TALUS_COMBINE_MINIMUM);
    OK(talus_shape_set_material(&world, floor, &ice));
    OK(talus_body_set_velocity(&world, body, kit_vec(2.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 30);
    NEAR(kit_velocity(&world, body).x, 2.0 - 0.25 * G * 0.5, 0.02); /* the box's rule, the average, comes first */
    kit_end(&world);
}

/* --- events ----------------------------------------------------------------------------------------- */

typedef struct tally {
    int begin, end, hit, sensor_begin, sensor_end;
} tally;

static tally run(talus_world *world, int steps) {
    tally t = {0, 0, 0, 0, 0};
    for (int i = 0; i < steps; i++) {
        kit_steps(world, 1);
        talus_events e = kit_events(world);
        t.begin += (int)e.begin_count, t.end += (int)e.end_count, t.hit += (int)e.hit_count;
        t.sensor_begin += (int)e.sensor_begin_count, t.sensor_end += (int)e.sensor_end_count;
    }
    return t;
}

static talus_body event_ball(talus_world *world, float y, talus_shape *shape) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, kit_vec(0.0f, y, 0.0f));
    talus_shape_def def = kit_ball_def(0.5f);
    def.events = 1;
    *shape = kit_shape(world, body, &def);
    return body;
}

static void touching_is_told_once(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_shape floor = kit_floor(&world), ball;
    talus_body body = event_ball(&world, 3.0f, &ball);
    int found = 0;
    for (int i = 0; i < 60 && !found; i++) {
        kit_steps(&world, 1);
        talus_events e = kit_events(&world);
        if (e.begin_count) {
            found = 1;
            assert_int_equal(e.begin_count, 1);
            assert_int_equal(e.hit_count, 1);
            talus_hit_event hit = e.hit[0];
            int a_is_floor = hit.a.index == floor.index;
            assert_true(a_is_floor ? hit.b.index == ball.index
                                   : hit.a.index == ball.index && hit.b.index == floor.index);
            NEAR(hit.speed, sqrt(2.0 * G * 2.5), 0.1);
            NEAR(hit.normal.y, a_is_floor ? 1.0 : -1.0, 1e-4);
            NEAR(hit.point.y, 0.0, 0.02);
            NEAR(hit.point.x, 0.0, 0.02);
        }
    }
    assert_int_equal(found, 1);
    tally t = run(&world, 300); /* rests, falls asleep */
    assert_int_equal(t.begin, 0);
    assert_int_equal(t.end, 0);
    assert_int_equal(t.hit, 0);
    assert_int_equal(talus_body_is_awake(&world, body), 0);
    OK(talus_body_wake(&world, body));
    t = run(&world, 100); /* waking is no event */
    assert_int_equal(t.begin + t.end + t.hit, 0);
    talus_pose up = kit_pose(0.0f, 5.0f, 0.0f);
    OK(talus_body_set_pose(&world, body, &up));
    t = run(&world, 3);
    assert_int_equal(t.end, 1);
    t = run(&world, 120);
    assert_int_equal(t.begin, 1);
    assert_int_equal(t.end, 0);
    kit_end(&world);
}

static void bouncing_is_told_each_time(void **state) {
    (void)state;
    talus_world world = earth();
    talus_shape floor = kit_floor(&world);
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 1.5f, 0.0f));
    talus_shape_def def = kit_ball_def(0.5f);
    def.events = 1;
    def.material.restitution = 1.0f;
    kit_shape(&world, body, &def);
    OK(talus_shape_set_material(&world, floor, &def.material));
    tally t = run(&world, 240); /* a metre down and up takes 0.903 s */
    assert_int_equal(t.begin, 4);
    assert_true(t.end == 4 || t.end == 3);
    assert_int_equal(t.hit, 4);
    kit_end(&world);
}

static void overlap_is_touching(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_shape shape;
    event_ball(&world, 0.0f, &shape);
    event_ball(&world, 0.7f, &shape);
    tally t = run(&world, 10);
    assert_int_equal(t.begin, 1);
    kit_end(&world);
}

static void only_who_asks_is_told(void **state) {
    (void)state;
    talus_world world = earth();
    kit_floor(&world);
    kit_ball(&world, kit_vec(0.0f, 2.0f, 0.0f), 0.5f);
    tally t = run(&world, 120);
    assert_int_equal(t.begin + t.end + t.hit, 0);
    kit_end(&world);
}

static void slow_touches_are_no_hits(void **state) {
    (void)state;
    talus_world world = earth();
    kit_floor(&world);
    talus_shape shape;
    event_ball(&world, 0.52f, &shape);
    tally t = run(&world, 60);
    assert_int_equal(t.begin, 1);
    assert_int_equal(t.hit, 0);
    kit_end(&world);
}

static void what_is_destroyed_ends_its_touch(void **state) {
    (void)state;
    for (int way = 0; way < 2; way++) {
        talus_world world = earth();
        kit_floor(&world);
        talus_shape shape;
        talus_body body = event_ball(&world, 0.6f, &shape);
        tally t = run(&world, 60);
        assert_int_equal(t.begin, 1);
        if (way) {
            OK(talus_shape_destroy(&world, shape));
        } else {
            OK(talus_body_destroy(&world, body));
        }
        int told = (int)kit_events(&world).end_count; /* at once, or by the next step */
        told += run(&world, 2).end;
        assert_int_equal(told, 1);
        kit_end(&world);
    }
}

static void sensors_see_and_do_not_push(void **state) {
    (void)state;
    talus_world world = earth();
    kit_floor(&world);
    talus_body gate = kit_body(&world, TALUS_STATIC, kit_vec(0.0f, 5.0f, 0.0f));
    talus_shape_def def = kit_box_def(1.0f, 0.5f, 1.0f);
    def.sensor = 1;
    talus_shape sensor = kit_shape(&world, gate, &def);
    talus_body ball = kit_ball(&world, kit_vec(0.0f, 8.0f, 0.0f), 0.25f);
    int inside = 0;
    for (int i = 0; i < 90; i++) {
        kit_steps(&world, 1);
        double t = (double)(i + 1) / 60.0, y = 8.0 - 0.5 * G * t * t;
        talus_events e = kit_events(&world);
        if (e.sensor_begin_count) {
            assert_int_equal(e.sensor_begin_count, 1);
            assert_memory_equal(&e.sensor_begin[0].sensor, &sensor, sizeof sensor);
            talus_body visitor;
            OK(talus_shape_get_body(&world, e.sensor_begin[0].visitor, &visitor));
            assert_int_equal(visitor.index, ball.index);
            NEAR(y, 5.75, 0.2);
            inside++;
        }
        if (e.sensor_end_count) {
            NEAR(y, 4.25, 0.25);
            inside--;
            assert_int_equal(inside, 0);
        }
        if (y > 0.5) {
            NEAR(kit_place(&world, ball).y, y, 1e-3); /* as if it were not there */
        }
    }
    assert_int_equal(inside, 0);
    kit_end(&world);
}

static void a_sensor_is_not_heavy(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_shape_def def = kit_box_def(2.0f, 2.0f, 2.0f);
    def.sensor = 1;
    kit_shape(&world, body, &def);
    talus_mass mass;
    OK(talus_body_get_mass(&world, body, &mass));
    NEAR(mass.mass, 1000.0, 1e-3);
    kit_end(&world);
}

/* A block whose sole has a fold along a diagonal, so that it stands on one of two faces or on the edge between them,
 * and a box on it. */
static void stand_on_a_fold(float fold, float load) {
    const float e = 0.25f, top = 0.5f;
    const talus_vec3 points[8] = {{-e, fold, -e}, {e, 0.0f, -e}, {e, fold, e}, {-e, 0.0f, e},
                                  {-e, top, -e},  {e, top, -e},  {e, top, e},  {-e, top, e}};
    talus_world_def settings = kit_small();
    settings.enable_sleep = 0;
    talus_world world = kit_world(&settings);
    void *region = kit_hull_of(points, 8, &world.geometry_bytes);
    world.geometry = region;
    kit_floor(&world);
    talus_body block = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def def = talus_shape_def_default();
    def.geometry.type = TALUS_HULL;
    kit_shape(&world, block, &def);
    kit_box(&world, kit_vec(0.0f, top + load, 0.0f), load);
    kit_steps(&world, 240);
    for (int step = 0; step < 60; step++) {
        kit_steps(&world, 1);
        assert_true(kit_length(kit_velocity(&world, block)) < 5e-4f);
        assert_true(kit_length(kit_spin(&world, block)) < 2e-3f);
    }
    kit_end(&world);
    kit_free(region);
}

static void what_stands_on_a_fold_comes_to_rest(void **state) {
    (void)state;
    for (int tenths = 0; tenths <= 10; tenths++) {
        stand_on_a_fold(1e-4f * (float)tenths, 0.3f);
        stand_on_a_fold(1e-4f * (float)tenths, 0.45f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filters_choose),
        cmocka_unit_test(a_filter_set_later_counts),
        cmocka_unit_test(friction_combines),
        cmocka_unit_test(static_friction_holds),
        cmocka_unit_test(restitution_combines),
        cmocka_unit_test(rolling_resistance_slows),
        cmocka_unit_test(materials_set_later_count),
        cmocka_unit_test(touching_is_told_once),
        cmocka_unit_test(bouncing_is_told_each_time),
        cmocka_unit_test(overlap_is_touching),
        cmocka_unit_test(only_who_asks_is_told),
        cmocka_unit_test(slow_touches_are_no_hits),
        cmocka_unit_test(what_is_destroyed_ends_its_touch),
        cmocka_unit_test(sensors_see_and_do_not_push),
        cmocka_unit_test(a_sensor_is_not_heavy),
        cmocka_unit_test(what_stands_on_a_fold_comes_to_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
