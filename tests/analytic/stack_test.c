/* What stands: stacks, pyramids, heavy on light; and what it presses with. */
#include "analytic_kit.h"

/* m: how deep a cube's face of four points is in the one below, with so many on it: a spring of m w^2 against the floor
 * and m w^2 / 2 against its like, w = 2 pi 58 Hz; of what is more than a quarter of a millimetre a twentieth is left.
 */
static double depth_under(int cubes, int on_floor) {
    double depth = (on_floor ? 1.0 : 2.0) * cubes * G / (116.0 * PI * 116.0 * PI);
    return depth > 2.5e-4 ? 2.5e-4 + (depth - 2.5e-4) / 20.0 : depth;
}

/* A floor and cubes of a metre on each other. */
static talus_world stacked(int count, int sleeps, talus_body *body) {
    talus_world_def def = kit_small();
    def.enable_sleep = (uint8_t)sleeps;
    talus_world world = kit_world(&def);
    kit_floor(&world);
    for (int i = 0; i < count; i++) {
        body[i] = kit_box(&world, kit_vec(0.0f, 0.5f + (float)i, 0.0f), 0.5f);
    }
    return world;
}

/* Boxes on each other go back to where they were put but for the depths, to 5 % in twenty seconds; on their way they
 * stay upright and come to rest. Twenty are 6.2 mm lower in the end. */
static void stack_of(int count, int steps) {
    talus_body body[20];
    talus_world world = stacked(count, 0, body);
    kit_steps(&world, steps);
    double sunk = 0.0;
    for (int i = 0; i < count; i++) {
        sunk += depth_under(count - i, i == 0);
        CLOSE(kit_place(&world, body[i]).x, 0.0, 8e-3);
        CLOSE(kit_place(&world, body[i]).z, 0.0, 8e-3);
        CLOSE(kit_place(&world, body[i]).y, 0.5 + i - sunk, 0.05 * sunk);
    }
    BELOW(sunk, 1e-2);
    kit_end(&world);
}

static void stack_stands(void **state) {
    (void)state;
    stack_of(2, 1200);
    stack_of(10, 1200);
    stack_of(20, 1200);
}

/* Faces of more points than four, each turned a little on the one below: prisms of six corners, and cylinders. They
 * come to rest, and their manifolds stay as they are. */
static void stack_of_round(int cylinders) {
    talus_vec3 points[12];
    for (int i = 0; i < 12; i++) {
        double angle = (i / 2) * PI / 3.0;
        points[i] = kit_vec((float)(0.5 * cos(angle)), i & 1 ? 0.25f : -0.25f, (float)(0.5 * sin(angle)));
    }
    size_t bytes = 0;
    void *blob = kit_hull_of(points, 12, &bytes);
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    world.geometry = blob, world.geometry_bytes = bytes;
    kit_floor(&world);
    talus_body body[10];
    for (int i = 0; i < 10; i++) {
        double half = 0.15 * i;
        body[i] = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.25f + 0.5f * (float)i, 0.0f));
        talus_pose pose = {kit_place(&world, body[i]), {0.0f, (float)sin(half), 0.0f, (float)cos(half)}};
        OK(talus_body_set_pose(&world, body[i], &pose));
        talus_shape_def shape = talus_shape_def_default();
        shape.geometry.type = cylinders ? TALUS_CYLINDER : TALUS_HULL;
        shape.geometry.half_height = 0.25f;
        shape.geometry.radius_top = shape.geometry.radius_bottom = 0.5f;
        kit_shape(&world, body[i], &shape);
    }
    uint32_t kept = 0, made = 0;
    kit_steps(&world, 300);
    for (int i = 0; i < 300; i++) {
        kit_steps(&world, 1);
        kept += kit_counters(&world).manifolds_kept;
        made += kit_counters(&world).manifolds_made;
    }
    assert_true(kept > 4u * made);
    for (int i = 0; i < 10; i++) {
        CLOSE(kit_place(&world, body[i]).x, 0.0, 1e-3);
        CLOSE(kit_place(&world, body[i]).z, 0.0, 1e-3);
        CLOSE(kit_place(&world, body[i]).y, 0.25 + 0.5 * i, 4e-3);
    }
    kit_end(&world);
    kit_free(blob);
}

static void round_faces_rest(void **state) {
    (void)state;
    stack_of_round(0);
    stack_of_round(1);
}

/* Eighteen layers of three planks, each across the one below: struck, the tower sways at one hertz, and less and less.
 */
static void swaying_planks(void **state) {
    (void)state;
    talus_world_def def = talus_world_def_default();
    def.enable_sleep = 0;
    def.body_capacity = def.shape_capacity = 64;
    talus_world world = kit_world(&def);
    floor_of(&world, 0.5f);
    talus_body plank[54];
    for (int i = 0; i < 54; i++) {
        int layer = i / 3, across = layer & 1;
        float y = 0.3f + 0.6f * (float)layer, aside = (float)(i % 3 - 1);
        talus_vec3 half = across ? kit_vec(0.49f, 0.3f, 1.5f) : kit_vec(1.5f, 0.3f, 0.49f);
        plank[i] = box_of(&world, across ? kit_vec(aside, y, 0.0f) : kit_vec(0.0f, y, aside), half, 0.5f);
        set_velocity(&world, plank[i], kit_vec(0.0f, 0.0f, 0.002f * y), kit_vec(0.0f, 0.0f, 0.0f));
    }
    float first = 0.0f, last = 0.0f;
    for (int step = 0; step < 1800; step++) {
        kit_steps(&world, 1);
        float speed = fabsf(kit_velocity(&world, plank[52]).z);
        first = step >= 120 && step < 240 ? fmaxf(first, speed) : first;
        last = step >= 1680 ? fmaxf(last, speed) : last;
    }
    assert_true(first > 0.005f); /* m/s */
    assert_true(last < 0.25f * first);
    kit_end(&world);
}

/* A stack falls asleep while it is still on its way. */
static void stack_sleeps(void **state) {
    (void)state;
    talus_body body[10];
    talus_world world = stacked(10, 1, body);
    kit_steps(&world, 600);
    for (int i = 0; i < 10; i++) {
        CLOSE(kit_place(&world, body[i]).x, 0.0, 2e-3);
        CLOSE(kit_place(&world, body[i]).z, 0.0, 2e-3);
        CLOSE(kit_place(&world, body[i]).y, 0.5 + i, 8e-3);
        assert_int_equal(talus_body_is_awake(&world, body[i]), 0);
    }
    kit_end(&world);
}

/* What has long borne a load and is rid of it is not thrown up: three boxes stay where they are when the seven on them
 * are gone. */
static void load_taken_away(void **state) {
    (void)state;
    talus_body body[10];
    talus_world world = stacked(10, 0, body);
    kit_steps(&world, 900);
    for (int i = 3; i < 10; i++) {
        assert_int_equal(talus_body_destroy(&world, body[i]), TALUS_OK);
    }
    for (int step = 0; step < 120; step++) {
        kit_steps(&world, 1);
        for (int i = 0; i < 3; i++) {
            double over = kit_place(&world, body[i]).y - 0.5 - i;
            BELOW(over, 2e-3);
            BELOW(-over, 2e-3);
        }
    }
    kit_end(&world);
}

static void pyramid_stands(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    kit_floor(&world);
    talus_body body[36];
    talus_vec3 at[36];
    int count = 0;
    for (int row = 0; row < 8; row++) {
        for (int i = 0; i < 8 - row; i++) {
            at[count] = kit_vec(1.05f * ((float)i + 0.5f * (float)row), 0.5f + (float)row, 0.0f);
            body[count] = kit_box(&world, at[count], 0.5f);
            count++;
        }
    }
    kit_steps(&world, 600);
    for (int i = 0; i < count; i++) {
        talus_vec3 now = kit_place(&world, body[i]);
        CLOSE(now.x, at[i].x, 5e-3);
        CLOSE(now.y, at[i].y, 2e-3 * (double)at[i].y + 2e-3);
        CLOSE(now.z, at[i].z, 5e-3);
        BELOW(kit_length(kit_velocity(&world, body[i])), 1e-2);
    }
    kit_end(&world);
}

/* Twenty kilograms on one stand, and squeeze it by half a centimetre; more than about fifty would crush it. */
static void heavy_on_light(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, (float)-G, 0.0f);
    kit_floor(&world);
    talus_body light = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.25f, 0.0f));
    talus_shape_def def = kit_box_def(0.25f, 0.25f, 0.25f);
    def.density = 8.0f;
    kit_shape(&world, light, &def);
    talus_body heavy = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 1.0f, 0.0f));
    def = kit_box_def(0.5f, 0.5f, 0.5f);
    def.density = 20.0f;
    kit_shape(&world, heavy, &def);
    kit_steps(&world, 600);
    CLOSE(kit_place(&world, light).y, 0.25, 5e-3);
    CLOSE(kit_place(&world, heavy).y, 1.0, 1e-2);
    CLOSE(kit_place(&world, heavy).x, 0.0, 1e-2);
    BELOW(kit_length(kit_velocity(&world, heavy)), 1e-2);
    kit_end(&world);
}

/* A box tips over an edge of a table when its centre is beyond it and not when it is before it. */
static void tips_at_the_edge(void **state) {
    (void)state;
    for (int beyond = 0; beyond < 2; beyond++) {
        talus_world world = world_of(0.0f, (float)-G, 0.0f);
        talus_shape_def def = kit_box_def(2.0f, 0.5f, 2.0f);
        def.pose.position = kit_vec(-2.0f, -0.5f, 0.0f);
        kit_shape(&world, talus_world_ground(&world), &def);
        talus_body body = kit_box(&world, kit_vec(beyond ? 0.01f : -0.01f, 0.5f, 0.0f), 0.5f);
        kit_steps(&world, 180);
        assert_int_equal(kit_place(&world, body).y < 0.0f, beyond);
        if (!beyond) {
            CLOSE(kit_place(&world, body).x, -0.01, 2e-3);
            CLOSE(angle_z(&world, body), 0.0, 0.01);
        }
        kit_end(&world);
    }
}

/* On a slope a tall box with friction enough tips when its centre is above its lower edge: tan a = b / h. */
static void tips_on_a_slope(void **state) {
    (void)state;
    for (int beyond = 0; beyond < 2; beyond++) {
        const double edge = atan(0.4);
        talus_world world = world_on_slope(edge + (beyond ? 0.02 : -0.02));
        floor_of(&world, 2.0f);
        talus_body body = box_of(&world, kit_vec(0.0f, 0.5f, 0.0f), kit_vec(0.2f, 0.5f, 0.2f), 2.0f);
        kit_steps(&world, 300);
        assert_int_equal(fabs(angle_z(&world, body)) > 0.5, beyond);
        kit_end(&world);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stack_stands),   cmocka_unit_test(stack_sleeps),     cmocka_unit_test(round_faces_rest),
        cmocka_unit_test(swaying_planks), cmocka_unit_test(load_taken_away),  cmocka_unit_test(pyramid_stands),
        cmocka_unit_test(heavy_on_light), cmocka_unit_test(tips_at_the_edge), cmocka_unit_test(tips_on_a_slope),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
