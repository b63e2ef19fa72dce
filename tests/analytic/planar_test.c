/* Bodies locked to a plane across x, y or z: what they do in it by closed forms, and that they never leave it. A plane
 * is told of by its axis; `along` and `up` are the two axes in it, `off` the place across it. */
#include "analytic_kit.h"

#define OFF 0.37f

static float part(talus_vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
static talus_vec3 in_plane(int axis, float along, float up, float off) {
    float v[3];
    v[(axis + 1) % 3] = along, v[(axis + 2) % 3] = up, v[axis] = off;
    return kit_vec(v[0], v[1], v[2]);
}

/* Down is -up, turned towards +along by `slope` (rad). Keeps frames, of which islands are told. */
static talus_world plane_world(int axis, double slope) {
    talus_world_def def = kit_small();
    def.gravity = in_plane(axis, (float)(G * sin(slope)), (float)(-G * cos(slope)), 0.0f);
    def.enable_sleep = 0;
    def.profile_capacity = 4;
    return kit_world(&def);
}
static void floor_in(talus_world *world, int axis, float friction) {
    talus_vec3 half = in_plane(axis, 100.0f, 1.0f, 100.0f), at = in_plane(axis, 0.0f, -1.0f, 0.0f);
    talus_shape_def def = kit_box_def(half.x, half.y, half.z);
    def.pose.position = at;
    def.material.static_friction = def.material.dynamic_friction = friction;
    kit_shape(world, talus_world_ground(world), &def);
}
static talus_body body_in(talus_world *world, int axis, talus_vec3 at, const talus_shape_def *shape) {
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = TALUS_DYNAMIC;
    def.pose.position = at;
    def.locks = talus_lock_plane((uint32_t)axis);
    OK(talus_body_create(world, &def, &body));
    kit_shape(world, body, shape);
    return body;
}
static talus_body box_in(talus_world *world, int axis, float along, float up, talus_vec3 half, float friction) {
    talus_shape_def def = kit_box_def(half.x, half.y, half.z);
    def.material.static_friction = def.material.dynamic_friction = friction;
    return body_in(world, axis, in_plane(axis, along, up, OFF), &def);
}

/* To the bit. */
static void assert_in_plane(const talus_world *world, talus_body body, int axis) {
    talus_pose p = kit_pose_of(world, body);
    talus_vec3 spin = kit_spin(world, body), turn = kit_vec(p.rotation.x, p.rotation.y, p.rotation.z);
    assert_true(part(p.position, axis) == OFF && part(kit_velocity(world, body), axis) == 0.0f);
    for (int k = 1; k < 3; k++) {
        assert_true(part(turn, (axis + k) % 3) == 0.0f && part(spin, (axis + k) % 3) == 0.0f);
    }
}

/* Rows of the one island: of a box on its face two points and a tangent, where space has four points and three. */
static void solves_three_degrees(void **state) {
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        talus_world world;
        for (int locked = 0; locked < 2; locked++) {
            talus_frame frame;
            world = plane_world(axis, 0.0);
            floor_in(&world, axis, 0.5f);
            talus_body box = box_in(&world, axis, 0.0f, 0.25f, kit_vec(0.25f, 0.25f, 0.25f), 0.5f);
            OK(talus_body_set_locks(&world, box, locked ? talus_lock_plane((uint32_t)axis) : 0u));
            kit_steps(&world, 60);
            OK(talus_world_get_frame(&world, 0, &frame));
            assert_int_equal(frame.largest[0].rows, locked ? 3 : 7);
            assert_int_equal(kit_counters(&world).bodies_planar, locked);
            assert_int_equal(kit_counters(&world).contacts_planar, locked);
            assert_int_equal(kit_counters(&world).contact_points, 4);
            if (!locked) {
                kit_end(&world);
                continue;
            }
            /* what is let go stays as it was: each of the four points has its share of the load */
            OK(talus_body_set_locks(&world, box, 0u));
            kit_steps(&world, 1);
            assert_int_equal(kit_counters(&world).contacts_planar, 0);
            BELOW(kit_length(kit_spin(&world, box)), 1e-4);
            BELOW(kit_length(kit_velocity(&world, box)), 1e-4);
        }
        /* on what moves out of the plane nothing is left out */
        talus_body_def kept = talus_body_def_default();
        kept.type = TALUS_KINEMATIC;
        kept.linear_velocity = in_plane(axis, 0.0f, 0.0f, 0.1f);
        kept.pose.position = in_plane(axis, 10.0f, 0.5f, OFF);
        talus_body lift;
        OK(talus_body_create(&world, &kept, &lift));
        talus_shape_def shape = kit_box_def(0.5f, 0.5f, 0.5f);
        kit_shape(&world, lift, &shape);
        box_in(&world, axis, 10.0f, 1.25f, kit_vec(0.25f, 0.25f, 0.25f), 0.5f);
        kit_steps(&world, 2);
        assert_int_equal(kit_counters(&world).bodies_planar, 1);
        assert_int_equal(kit_counters(&world).contacts_planar, 0);
        OK(talus_body_set_velocity(&world, lift, in_plane(axis, 0.1f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
        kit_steps(&world, 1);
        assert_int_equal(kit_counters(&world).contacts_planar, 1);
        kit_end(&world);
    }
}

/* A box that slides to rest after v^2 / 2 mu g, one on a slope that sticks, one that slides down it. */
static void slides(void **state) {
    (void)state;
    const double mu = 0.4, v = 5.0;
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k < 3; k++) {
            const double slope = k == 0 ? 0.0 : atan(mu) * (k == 1 ? 0.9 : 1.4);
            talus_world world = plane_world(axis, slope);
            floor_in(&world, axis, (float)mu);
            talus_vec3 half = in_plane(axis, 0.8f, 0.2f, 0.5f);
            talus_body box = box_in(&world, axis, 0.0f, 0.2f, half, (float)mu);
            if (k == 0) {
                set_velocity(&world, box, in_plane(axis, (float)v, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
                kit_steps(&world, 240);
                CLOSE(part(kit_place(&world, box), (axis + 1) % 3), v * v / (2.0 * mu * G),
                      0.01 * v * v / (2.0 * mu * G));
            } else {
                kit_steps(&world, 60);
                const double a = k == 1 ? 0.0 : G * (sin(slope) - mu * cos(slope));
                CLOSE(part(kit_velocity(&world, box), (axis + 1) % 3), a, 0.01 * a + 1e-4);
            }
            CLOSE(part(kit_place(&world, box), (axis + 2) % 3), 0.2, 1e-3);
            assert_in_plane(&world, box, axis);
            kit_end(&world);
        }
    }
}

/* A ball that rolls is slowed by 5/7 g rho / r; one that is dropped comes up to e^2 h. */
static void rolls_and_bounces(void **state) {
    (void)state;
    const double lever = 0.02, r = 0.5, e = 0.4, h = 3.0;
    for (int axis = 0; axis < 3; axis++) {
        talus_world world = plane_world(axis, 0.0);
        floor_in(&world, axis, 0.8f);
        talus_shape_def def = kit_ball_def((float)r);
        def.material.static_friction = def.material.dynamic_friction = 0.8f;
        def.material.rolling_resistance = (float)lever;
        talus_body ball = body_in(&world, axis, in_plane(axis, 0.0f, (float)r, OFF), &def);
        kit_steps(&world, 20);
        set_velocity(&world, ball, in_plane(axis, 2.0f, 0.0f, 0.0f), in_plane(axis, 0.0f, 0.0f, (float)(-2.0 / r)));
        kit_steps(&world, 60);
        const double a = 5.0 / 7.0 * G * lever / r;
        CLOSE(part(kit_velocity(&world, ball), (axis + 1) % 3), 2.0 - a, 0.01 * a);
        assert_in_plane(&world, ball, axis);
        def = kit_box_def((float)r, (float)r, (float)r);
        def.material.restitution = (float)(2.0 * e); /* of the box; of the floor none */
        talus_body box = body_in(&world, axis, in_plane(axis, 20.0f, (float)(r + h), OFF), &def);
        double top = 0.0;
        for (int i = 0, hit = 0; i < 150; i++) {
            kit_steps(&world, 1);
            double v = (double)part(kit_velocity(&world, box), (axis + 2) % 3);
            hit |= v > 0.0;
            top = hit ? fmax(top, (double)part(kit_place(&world, box), (axis + 2) % 3) - r + v * v / (2.0 * G)) : top;
        }
        CLOSE(top, e * e * h, 0.01);
        assert_in_plane(&world, box, axis);
        kit_end(&world);
    }
}

/* Columns of five boxes, the top one a hundred times as heavy, and a wall of boxes: they stand, and sink in no more
 * than those in space do. */
static void stands(void **state) {
    (void)state;
    for (int axis = 0; axis < 4; axis++) { /* 3: across z, and not locked */
        const int z = axis == 3 ? 2 : axis;
        talus_world world = plane_world(z, 0.0);
        talus_body body[20];
        int count = 0;
        floor_in(&world, z, 0.6f);
        for (int i = 0; i < 5; i++) {
            body[count++] = box_in(&world, z, 0.0f, 0.5f + (float)i, kit_vec(0.5f, 0.5f, 0.5f), 0.6f);
        }
        set_mass(&world, body[4], 1e5f);
        for (int row = 0; row < 5; row++) {
            for (int i = 0; i < 5 - row; i++) {
                float along = 10.0f + 1.05f * ((float)i + 0.5f * (float)row);
                body[count++] = box_in(&world, z, along, 0.5f + (float)row, kit_vec(0.5f, 0.5f, 0.5f), 0.6f);
            }
        }
        for (int i = 0; axis == 3 && i < count; i++) {
            OK(talus_body_set_locks(&world, body[i], 0u));
        }
        kit_steps(&world, 60);
        BELOW(worst_of(&world, 300).overlap, 1.5e-3);
        assert_true(kit_counters(&world).contacts_pressed >= 5);
        assert_int_equal(kit_counters(&world).bodies_planar, axis == 3 ? 0 : count);
        for (int i = 0; i < count; i++) {
            float up = part(kit_place(&world, body[i]), (z + 2) % 3);
            CLOSE(up, 0.5 + floor((double)up), 0.01);
            BELOW(kit_length(kit_velocity(&world, body[i])), 2e-3);
            if (axis < 3) {
                assert_in_plane(&world, body[i], axis);
            }
        }
        kit_end(&world);
    }
}

/* Balls in planes that lie beside one another touch across them: such a contact has no plane, and they keep theirs. */
static void across(void **state) {
    (void)state;
    talus_world world = world_of(0.0f, 0.0f, 0.0f);
    talus_shape_def def = kit_ball_def(0.5f);
    talus_body a = body_in(&world, 2, kit_vec(-1.0f, 0.0f, OFF), &def);
    talus_body b = body_in(&world, 2, kit_vec(0.0f, 0.0f, OFF + 0.25f), &def);
    set_velocity(&world, a, kit_vec(2.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f));
    uint32_t met = 0;
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        met += kit_counters(&world).contacts_touching;
        assert_int_equal(kit_counters(&world).contacts_planar, 0);
    }
    assert_true(met > 0);
    CLOSE(kit_velocity(&world, a).x + kit_velocity(&world, b).x, 2.0, 1e-5);
    assert_true(kit_velocity(&world, b).x >= kit_velocity(&world, a).x - 1e-3f);
    assert_true(kit_place(&world, a).z == OFF && kit_place(&world, b).z == OFF + 0.25f);
    kit_end(&world);
}

/* What is solved in a plane follows from the state: a restored world goes on to the bit, by any instruction set, while
 * locks come and go. */
static void restored(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.gravity = kit_vec(0.0f, (float)-G, 0.0f);
    talus_world world = kit_world(&def), other = kit_world(&def);
    talus_body body[24];
    floor_of(&world, 0.6f);
    for (int i = 0; i < 24; i++) {
        talus_shape_def shape = i % 3 ? kit_box_def(0.2f, 0.15f + 0.01f * (float)i, 0.3f) : kit_ball_def(0.25f);
        shape.density = i == 23 ? 50000.0f : 1000.0f;
        body[i] =
            body_in(&world, 2,
                    kit_vec(0.55f * (float)(i % 4) + 0.1f * (float)(i / 4), 0.3f + 0.8f * (float)(i / 4), OFF), &shape);
    }
    kit_steps(&world, 50);
    move_to_scalar(&world, &other);
    uint32_t planar = 0;
    for (int i = 0; i < 90; i++) {
        if (i % 6 == 5) {
            uint32_t locks = i % 12 == 5 ? 0u : talus_lock_plane(2u);
            OK(talus_body_set_locks(&world, body[i / 6], locks));
            OK(talus_body_set_locks(&other, body[i / 6], locks));
        }
        step_alike(&world, &other);
        planar += kit_counters(&world).contacts_planar;
    }
    assert_true(planar > 90);
    kit_end(&world);
    kit_end(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solves_three_degrees),
        cmocka_unit_test(slides),
        cmocka_unit_test(rolls_and_bounces),
        cmocka_unit_test(stands),
        cmocka_unit_test(across),
        cmocka_unit_test(restored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
