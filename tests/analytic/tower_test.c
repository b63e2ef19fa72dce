/* Towers: stacks that the springs of their contacts would not keep upright. Of N cubes as wide as w, the lowest of
 * which gives by d under one of them, an elastic column buckles from N^3 d = 1.96 w on (Greenhill 1881: under its own
 * weight at 7.84 of its stiffness): here d is 0.15 mm, which is 23 cubes of a metre and 8 of five centimetres. */
#include "analytic_kit.h"

#define MOST 60

static void tower_of(talus_world *world, talus_vec3 at, int count, float size, talus_body *body) {
    for (int i = 0; i < count; i++) {
        talus_vec3 place = kit_vec(at.x, at.y + size * (0.5f + (float)i), at.z);
        body[i] = box_of(world, place, kit_vec(0.5f * size, 0.5f * size, 0.5f * size), 0.6f);
    }
}

/* How far bodies are from where they were put, at most. */
static double gone_from(const talus_world *world, talus_vec3 at, int count, float size, const talus_body *body) {
    double most = 0.0;
    for (int i = 0; i < count; i++) {
        talus_vec3 p = kit_place(world, body[i]);
        talus_vec3 d = kit_vec(p.x - at.x, p.y - at.y - size * (0.5f + (float)i), p.z - at.z);
        most = fmax(most, kit_length(d));
    }
    return most;
}

static void stands(void **state) {
    (void)state;
    const struct {
        int count;
        float size;
    } of[] = {{60, 1.0f}, {40, 1.0f}, {25, 1.0f}, {20, 0.05f}, {10, 0.05f}, {8, 0.03f}};
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        talus_world world = world_of(0.0f, (float)-G, 0.0f);
        floor_of(&world, 0.6f);
        talus_body body[MOST];
        talus_vec3 at = kit_vec(0.0f, 0.0f, 0.0f);
        tower_of(&world, at, of[k].count, of[k].size, body);
        kit_steps(&world, 600);
        assert_int_equal(kit_counters(&world).contacts_pressed, of[k].count);
        BELOW(gone_from(&world, at, of[k].count, of[k].size, body), of[k].count > 40 ? 2e-3 : 3e-4);
        kit_end(&world);
    }
}

/* What stands by its springs is left to them: fifteen cubes of a metre, and forty side by side. */
static void left_alone(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.6f);
    talus_body body[MOST];
    tower_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 15, 1.0f, body);
    for (int i = 0; i < 40; i++) {
        box_of(&world, kit_vec(3.0f + 0.051f * (float)i, 0.025f, 0.0f), kit_vec(0.025f, 0.025f, 0.025f), 0.6f);
    }
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts_pressed, 0);
    }
    kit_end(&world);
}

/* Towers are pressed as a whole or not at all: of sixteen of ten there is room for twelve. */
static void as_many_as_fit(void **state) {
    (void)state;
    talus_world_def def = talus_world_def_default();
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    floor_of(&world, 0.6f);
    talus_body body[16][10];
    for (int k = 0; k < 16; k++) {
        tower_of(&world, kit_vec(0.5f * (float)k, 0.0f, 0.0f), 10, 0.05f, body[k]);
    }
    kit_steps(&world, 30);
    assert_int_equal(kit_counters(&world).contacts_pressed, 120);
    kit_end(&world);
}

/* On a table that is itself carried, sleeping and woken again, and from a world that was restored. */
static void goes_on(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.gravity = kit_vec(0.0f, (float)-G, 0.0f);
    talus_world world = kit_world(&def), other = kit_world(&def);
    floor_of(&world, 0.6f);
    talus_body body[MOST], table = box_of(&world, kit_vec(0.0f, 0.1f, 0.0f), kit_vec(0.5f, 0.1f, 0.5f), 0.6f);
    talus_vec3 at = kit_vec(0.0f, 0.2f, 0.0f);
    tower_of(&world, at, 12, 0.05f, body);
    kit_steps(&world, 20);
    assert_int_equal(kit_counters(&world).contacts_pressed, 13); /* the table is of the tower */
    move_to_scalar(&world, &other);
    for (int i = 0; i < 40; i++) {
        step_alike(&world, &other);
    }
    kit_steps(&world, 240);
    assert_int_equal(talus_body_is_awake(&world, body[11]), 0);
    OK(talus_body_wake(&world, table));
    kit_steps(&world, 120);
    BELOW(gone_from(&world, at, 12, 0.05f, body), 4e-3);
    kit_end(&world);
    kit_end(&other);
}

/* J: of cubes, and of a ball on the floor or above it. */
static double energy_of(const talus_world *world, const talus_body *body, int count, double mass, double moment) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double v = kit_length(kit_velocity(world, body[i])), w = kit_length(kit_spin(world, body[i]));
        sum += 0.5 * mass * v * v + 0.5 * moment * w * w + mass * G * (double)kit_place(world, body[i]).y;
    }
    return sum;
}

/* Struck in its middle it falls, and gains no energy by that. */
static void falls(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    floor_of(&world, 0.6f);
    talus_body body[20];
    talus_vec3 at = kit_vec(0.0f, 0.0f, 0.0f);
    tower_of(&world, at, 20, 0.1f, body);
    kit_steps(&world, 30);
    assert_int_equal(kit_counters(&world).contacts_pressed, 20);
    talus_body ball = ball_of(&world, kit_vec(-1.0f, 1.0f, 0.0f), 0.1f, 4.0f, 0.0f, 0.0f);
    set_velocity(&world, ball, kit_vec(6.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
    double first = 0.0, most = 0.0, now = 0.0;
    for (int i = 0; i < 300; i++) {
        now = energy_of(&world, body, 20, 1.0, 0.01 / 6.0) + energy_of(&world, &ball, 1, 4.0, 0.4 * 4.0 * 0.01);
        first = i == 0 ? now : first;
        most = fmax(most, now);
        kit_steps(&world, 1);
    }
    BELOW(most, 1.005 * first);
    BELOW(now, 0.5 * first);
    assert_true(gone_from(&world, at, 20, 0.1f, body) > 1.0);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stands),  cmocka_unit_test(left_alone), cmocka_unit_test(as_many_as_fit),
        cmocka_unit_test(goes_on), cmocka_unit_test(falls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
