/* Events: each touch begins once and ends once, hits have the speed of the approach, what does not fit is counted. */
#include "store_check.h"

static talus_shape loud_ball(talus_world *world, talus_vec3 at, talus_body *body, float restitution) {
    talus_shape_def def = kit_ball_def(0.25f);
    def.events = 1;
    def.material.restitution = restitution;
    *body = kit_body(world, TALUS_DYNAMIC, at);
    return kit_shape(world, *body, &def);
}
static int same(talus_shape a, talus_shape b) { return a.index == b.index && a.generation == b.generation; }

/* A ball that bounces (0.35 with the floor): begins and ends in turn, with a hit of the speed of its fall. */
static void touches_in_turn(void **state) {
    (void)state;
    talus_world_def wd = kit_small();
    talus_world world = kit_world(&wd);
    talus_shape ground = kit_floor(&world);
    talus_body body;
    talus_shape ball = loud_ball(&world, kit_vec(0.0f, 2.25f, 0.0f), &body, 0.7f);
    int touching = 0, begins = 0, hits = 0;
    float first = 0.0f;
    for (int i = 0; i < 600; i++) {
        kit_steps(&world, 1);
        talus_events e = kit_events(&world);
        assert_true(e.dropped == 0 && e.begin_count + e.end_count <= 1);
        if (e.begin_count) {
            assert_int_equal(touching, 0);
            assert_true((same(e.begin[0].a, ground) && same(e.begin[0].b, ball)) ||
                        (same(e.begin[0].b, ground) && same(e.begin[0].a, ball)));
            touching = 1;
            begins++;
        }
        if (e.end_count) {
            assert_int_equal(touching, 1);
            touching = 0;
        }
        if (e.hit_count) {
            assert_true(touching && e.hit[0].speed > 1.0f);
            NEAR(fabsf(e.hit[0].normal.y), 1.0f, 1e-5);
            first = hits++ ? first : e.hit[0].speed;
        }
    }
    assert_true(hits >= 2 && begins >= hits && touching);
    NEAR(first, sqrt(2.0 * 9.81 * 2.0), 0.02);
    kit_end(&world);
}

/* Shapes that did not ask are not told of. */
static void silent_shapes_say_nothing(void **state) {
    (void)state;
    talus_world_def wd = kit_small();
    talus_world world = kit_world(&wd);
    kit_floor(&world);
    kit_ball(&world, kit_vec(0.0f, 1.0f, 0.0f), 0.25f);
    for (int i = 0; i < 100; i++) {
        kit_steps(&world, 1);
        talus_events e = kit_events(&world);
        assert_true(e.begin_count + e.end_count + e.hit_count + e.sensor_begin_count + e.sensor_end_count == 0);
    }
    kit_end(&world);
}

/* A sensor is entered and left once, and pushes nothing. */
static void sensor(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_shape_def def = kit_box_def(0.5f, 0.5f, 0.5f);
    def.sensor = 1;
    talus_shape trap = kit_shape(&world, talus_world_ground(&world), &def);
    talus_body body = kit_ball(&world, kit_vec(-3.0f, 0.0f, 0.0f), 0.25f);
    OK(talus_body_set_velocity(&world, body, kit_vec(2.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    int begins = 0, ends = 0;
    double in = 0.0, out = 0.0;
    for (int i = 0; i < 240; i++) {
        kit_steps(&world, 1);
        talus_events e = kit_events(&world);
        if (e.sensor_begin_count) {
            assert_true(same(e.sensor_begin[0].sensor, trap));
            begins++, in = (double)kit_place(&world, body).x;
        }
        if (e.sensor_end_count) {
            assert_true(same(e.sensor_end[0].sensor, trap));
            ends++, out = (double)kit_place(&world, body).x;
        }
    }
    assert_true(begins == 1 && ends == 1);
    NEAR(in, -0.75, 0.08); /* two steps' way */
    NEAR(out, 0.75, 0.08);
    NEAR(kit_velocity(&world, body).x, 2.0, 0.0);
    kit_end(&world);
}

/* Forty touches in one step where eight fit. */
static void full(void **state) {
    (void)state;
    talus_world_def wd = kit_small();
    wd.event_capacity = 8;
    talus_world world = kit_world(&wd);
    kit_floor(&world);
    for (int i = 0; i < 40; i++) {
        talus_body body;
        loud_ball(&world, kit_vec((float)i, 0.25f, 0.0f), &body, 0.0f);
    }
    uint32_t told = 0, dropped = 0;
    for (int i = 0; i < 10; i++) {
        kit_steps(&world, 1);
        talus_events e = kit_events(&world);
        assert_true(e.begin_count <= 8);
        assert_int_equal(kit_counters(&world).events.dropped, e.dropped);
        told += e.begin_count, dropped += e.dropped;
    }
    assert_int_equal(told + dropped, 40);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(touches_in_turn),
        cmocka_unit_test(silent_shapes_say_nothing),
        cmocka_unit_test(sensor),
        cmocka_unit_test(full),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
