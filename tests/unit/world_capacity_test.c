/* At the brim of each capacity: what is refused changes nothing, what a step drops is counted. */
#include "world_kit.h"

static void bodies_and_shapes_run_out(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.body_capacity = 5, def.shape_capacity = 7;
    talus_world world = kit_world(&def);
    talus_body_def body_def = talus_body_def_default();
    talus_shape_def shape_def = talus_shape_def_default();
    talus_body bodies[5], body;
    talus_shape shape;
    for (int i = 0; i < 5; i++) {
        OK(talus_body_create(&world, &body_def, &bodies[i]));
    }
    REFUSED(&world, TALUS_FULL_BODIES, talus_body_create(&world, &body_def, &body));
    for (int i = 0; i < 7; i++) {
        OK(talus_shape_create(&world, bodies[i % 5], &shape_def, &shape));
    }
    REFUSED(&world, TALUS_FULL_SHAPES, talus_shape_create(&world, bodies[0], &shape_def, &shape));
    talus_counters counters = kit_counters(&world);
    assert_int_equal(counters.bodies.capacity - counters.bodies.used, 0);
    assert_int_equal(counters.shapes.used, 7);
    assert_int_equal(counters.shapes.high_water, 7);
    assert_int_equal(counters.shapes.capacity, 7);
    OK(talus_body_destroy(&world, bodies[1])); /* with two of the shapes */
    assert_int_equal(kit_counters(&world).shapes.used, 5);
    assert_int_equal(kit_counters(&world).shapes.high_water, 7);
    OK(talus_body_create(&world, &body_def, &body));
    REFUSED(&world, TALUS_FULL_BODIES, talus_body_create(&world, &body_def, &body));
    OK(talus_shape_create(&world, body, &shape_def, &shape));
    OK(talus_shape_create(&world, body, &shape_def, &shape));
    REFUSED(&world, TALUS_FULL_SHAPES, talus_shape_create(&world, body, &shape_def, &shape));
    kit_end(&world);
}

static void contacts_run_out(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.contact_capacity = 4;
    talus_world world = kit_world(&def);
    talus_shape_def ball = kit_ball_def(0.5f);
    uint32_t dropped = 0;
    for (int i = 0; i < 12; i++) { /* all in one place */
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.05f * (float)i, 0.01f * (float)(i % 3), 0.0f));
        kit_shape(&world, body, &ball);
    }
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        talus_counters counters = kit_counters(&world);
        assert_true(counters.contacts.used <= 4 && counters.contacts.high_water <= 4);
        assert_int_equal(counters.contacts.capacity, 4);
        dropped += counters.contacts.dropped;
    }
    assert_true(dropped > 0);
    kit_end(&world);
}

static void events_run_out(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.event_capacity = 2;
    talus_world world = kit_world(&def);
    talus_shape_def ball = kit_ball_def(0.5f);
    uint32_t told = 0, dropped = 0;
    ball.events = 1;
    kit_floor(&world);
    for (int i = 0; i < 7; i++) { /* all come down at once, at 5 m/s */
        talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(2.0f * (float)i, 1.0f, 0.0f));
        kit_shape(&world, body, &ball);
        OK(talus_body_set_velocity(&world, body, kit_vec(0.0f, -5.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    }
    for (int i = 0; i < 20; i++) {
        kit_steps(&world, 1);
        talus_events events = kit_events(&world);
        assert_true(events.begin_count <= 2 && events.hit_count <= 2);
        assert_int_equal(events.dropped, kit_counters(&world).events.dropped);
        told += events.begin_count + events.hit_count;
        dropped += events.dropped;
    }
    assert_int_equal(told, 4); /* two of the seven touches, two of the seven hits */
    assert_int_equal(dropped, 10);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_and_shapes_run_out),
        cmocka_unit_test(contacts_run_out),
        cmocka_unit_test(events_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
