/* A net: more joints in rings than are solved at once. It sags, stretches a little, and comes to rest. */
#include "analytic_kit.h"

#define SIDE 16
#define PITCH 0.4f

/* Balls of a kilogram, held at its corners, with boxes of twenty let fall on it. */
static void catches_boxes(void **state) {
    (void)state;
    talus_world_def def = talus_world_def_default();
    def.enable_sleep = 0;
    def.body_capacity = def.shape_capacity = 512, def.joint_capacity = 512;
    talus_world world = kit_world(&def);
    talus_body ball[SIDE][SIDE], box[3], none = {0, 0};
    const float half = 0.5f * PITCH;
    for (int i = 0; i < SIDE; i++) {
        for (int k = 0; k < SIDE; k++) {
            talus_vec3 at = kit_vec(PITCH * ((float)i - 7.5f), 0.0f, PITCH * ((float)k - 7.5f));
            ball[i][k] = ball_of(&world, at, 0.1f, 1.0f, 0.0f, 0.5f);
            if (i > 0) {
                pin(&world, ball[i - 1][k], ball[i][k], kit_vec(at.x - half, 0.0f, at.z), 0);
            }
            if (k > 0) {
                pin(&world, ball[i][k - 1], ball[i][k], kit_vec(at.x, 0.0f, at.z - half), 0);
            }
            if (i % (SIDE - 1) == 0 && k % (SIDE - 1) == 0) {
                pin(&world, none, ball[i][k], at, 0);
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        box[i] = box_of(&world, kit_vec((float)(i - 1), 2.0f, 0.0f), kit_vec(0.4f, 0.4f, 0.4f), 0.5f);
        set_mass(&world, box[i], 20.0f);
    }
    BELOW(worst_of(&world, 360).joint_linear, 0.2);
    double fastest = 0.0;
    for (int step = 0; step < 60; step++) {
        kit_steps(&world, 1);
        for (int i = 0; i < SIDE * SIDE; i++) {
            fastest = fmax(fastest, kit_length(kit_velocity(&world, ball[i / SIDE][i % SIDE])));
        }
    }
    BELOW(fastest, 2.0);
    assert_true(kit_counters(&world).joints_apart > 0);
    for (int i = 0; i < 3; i++) { /* they lie in it */
        CLOSE(kit_place(&world, box[i]).x, i - 1.0, 0.5);
        assert_true(kit_place(&world, box[i]).y > -1.6f);
    }
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(catches_boxes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
