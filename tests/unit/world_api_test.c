/* Every call of the API: what it answers to good arguments, to bad ones, and to handles of what is gone. What is
 * refused changes nothing. */
#include "world_kit.h"

static const float BAD[3] = {NAN, INFINITY, -INFINITY};
#define BAD_COUNT 3

/* Floats of a structure by their place in it. */
static void set_float(void *structure, size_t offset, float value) {
    memcpy((unsigned char *)structure + offset, &value, sizeof value);
}

static void texts(void **state) {
    (void)state;
    for (int i = -1; i <= TALUS_STATUS_COUNT; i++) {
        assert_non_null(talus_status_text((talus_status)i));
        assert_true(strlen(talus_status_text((talus_status)i)) > 1);
    }
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(talus_stage_name((talus_stage)i), talus_stage_name((talus_stage)k));
        }
    }
    assert_non_null(talus_stage_name((talus_stage)99));
    assert_string_equal(talus_isa_name(TALUS_ISA_BEST), "best");
    assert_non_null(talus_isa_name((talus_isa)99));
    assert_int_equal(talus_isa_available((talus_isa)99), 0);
    assert_int_equal(talus_isa_available(TALUS_ISA_SCALAR), 1);
}

static void no_world(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def);
    void *block = kit_alloc(size);
    memset(block, 0, size);
    talus_world none = {NULL, NULL, 0, NULL}, blank = {block, NULL, 0, NULL};
    talus_world *const worlds[3] = {NULL, &none, &blank};
    for (int i = 0; i < 3; i++) {
        talus_world *w = worlds[i];
        talus_body_def body_def = talus_body_def_default();
        talus_shape_def shape_def = talus_shape_def_default();
        talus_joint_def joint_def = talus_joint_def_default();
        talus_body body = {1, 1};
        talus_shape shape = {0, 1};
        talus_joint joint = {0, 1};
        talus_pose pose = kit_pose(0.0f, 0.0f, 0.0f);
        talus_vec3 v = {0.0f, 0.0f, 0.0f};
        talus_counters counters;
        talus_events events;
        talus_mass mass;
        assert_int_equal(talus_world_step(w, 0.01f, NULL, NULL), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_set_isa(w, TALUS_ISA_SCALAR), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_set_gravity(w, v), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_get_def(w, &def), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_get_counters(w, &counters), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_get_events(w, &events), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_world_ground(w).generation, 0);
        assert_int_equal(talus_body_create(w, &body_def, &body), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_destroy(w, body), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_is_valid(w, body), 0);
        assert_int_equal(talus_body_is_awake(w, body), 0);
        assert_int_equal(talus_body_get_pose(w, body, &pose), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_set_pose(w, body, &pose), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_set_velocity(w, body, v, v), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_get_mass(w, body, &mass), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_body_wake(w, body), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_shape_create(w, body, &shape_def, &shape), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_shape_destroy(w, shape), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_joint_create(w, &joint_def, &joint), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_joint_destroy(w, joint), TALUS_BAD_ARGUMENT);
        assert_int_equal(talus_joint_is_valid(w, joint), 0);
    }
    kit_free(block);
}

static void world_settings(void **state) {
    (void)state;
    talus_world_def def = kit_small(), got;
    def.substeps = 7, def.iterations = 3, def.push_speed = 0.3f, def.hit_speed = 2.5f;
    talus_world world = kit_world(&def);
    OK(talus_world_get_def(&world, &got));
    assert_int_equal(got.body_capacity, def.body_capacity);
    assert_int_equal(got.shape_capacity, def.shape_capacity);
    assert_int_equal(got.joint_capacity, def.joint_capacity);
    assert_int_equal(got.contact_capacity, def.contact_capacity);
    assert_int_equal(got.event_capacity, def.event_capacity);
    assert_int_equal(got.substeps, 7);
    assert_int_equal(got.iterations, 3);
    assert_true(got.push_speed == 0.3f && got.hit_speed == 2.5f && got.gravity.y == def.gravity.y);
    assert_int_equal(got.isa, talus_world_get_isa(&world));
    assert_int_not_equal(got.isa, TALUS_ISA_BEST);
    got.isa = def.isa;
    assert_true(talus_world_size(&got) == talus_world_size(&def));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_get_def(&world, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_get_counters(&world, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_get_events(&world, NULL));
    for (int i = 0; i < BAD_COUNT; i++) {
        REFUSED(&world, TALUS_NOT_FINITE, talus_world_set_gravity(&world, kit_vec(0.0f, BAD[i], 0.0f)));
        REFUSED(&world, TALUS_NOT_FINITE, talus_world_step(&world, BAD[i], NULL, NULL));
    }
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_step(&world, 0.0f, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_step(&world, -0.01f, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_step(&world, 1.5f, NULL, NULL));
    OK(talus_world_step(&world, 1.0f, NULL, NULL));
    OK(talus_world_step(&world, 1e-30f, NULL, NULL));
    assert_int_equal(kit_counters(&world).steps, 2);
    for (int isa = 0; isa <= TALUS_ISA_COUNT; isa++) {
        if (talus_isa_available((talus_isa)isa)) {
            OK(talus_world_set_isa(&world, (talus_isa)isa));
        } else {
            REFUSED(&world, TALUS_NO_ISA, talus_world_set_isa(&world, (talus_isa)isa));
        }
    }
    kit_end(&world);
}

static uint64_t tick(void *context) { return ++*(uint64_t *)context; }

static void a_clock_is_read(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    uint64_t ticks = 0, sum = 0;
    talus_clock clock = {tick, &ticks};
    talus_profile profile;
    kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    OK(talus_world_step(&world, 0.01f, &clock, &profile));
    assert_true(ticks > 5 && ticks < 1000);
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        sum += profile.stage[i];
    }
    assert_true(sum == profile.total && profile.total == ticks - 1u);
    OK(talus_world_step(&world, 0.01f, NULL, &profile)); /* no clock: no time */
    assert_true(profile.total == 0);
    ticks = 0;
    OK(talus_world_step(&world, 0.01f, &clock, NULL)); /* nowhere to write it */
    assert_true(ticks == 0);
    kit_end(&world);
}

static void body_arguments(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body_def def = talus_body_def_default(), broken;
    talus_body body;
    def.type = TALUS_DYNAMIC;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, NULL, &body));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &def, NULL));
#define AT(field) offsetof(talus_body_def, field)
    const size_t floats[] = {
        AT(pose.position.x),    AT(pose.position.y),   AT(pose.position.z),    AT(pose.rotation.x),
        AT(pose.rotation.y),    AT(pose.rotation.z),   AT(pose.rotation.w),    AT(linear_velocity.x),
        AT(linear_velocity.y),  AT(linear_velocity.z), AT(angular_velocity.x), AT(angular_velocity.y),
        AT(angular_velocity.z), AT(linear_damping),    AT(angular_damping),    AT(gravity_scale)};
    for (size_t k = 0; k < sizeof floats / sizeof *floats; k++) {
        for (int i = 0; i < BAD_COUNT; i++) {
            broken = def;
            set_float(&broken, floats[k], BAD[i]);
            REFUSED(&world, TALUS_NOT_FINITE, talus_body_create(&world, &broken, &body));
        }
    }
#undef AT
    broken = def, broken.pose.rotation.w = 0.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &broken, &body));
    broken = def, broken.linear_damping = -1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &broken, &body));
    broken = def, broken.angular_damping = -1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &broken, &body));
    broken = def, broken.type = (talus_body_type)3;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &broken, &body));
    broken = def, broken.locks = 64;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &broken, &body));
    /* any length of quaternion but none */
    def.pose.rotation.w = 1e18f, def.pose.rotation.x = 1e18f;
    def.user_data = 0x123456789abcdefu;
    OK(talus_body_create(&world, &def, &body));
    NEAR(kit_pose_of(&world, body).rotation.x, sqrt(0.5), 1e-6);
    uint64_t data;
    OK(talus_body_get_user_data(&world, body, &data));
    assert_true(data == def.user_data);
    talus_body_type type;
    OK(talus_body_get_type(&world, body, &type));
    assert_int_equal(type, TALUS_DYNAMIC);
    assert_int_equal(talus_body_is_valid(&world, body), 1);
    kit_end(&world);
}

/* Calls on a body that take numbers. */
static void body_numbers(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_body mover = kit_body(&world, TALUS_KINEMATIC, kit_vec(5.0f, 0.0f, 0.0f));
    talus_body rock = kit_body(&world, TALUS_STATIC, kit_vec(9.0f, 0.0f, 0.0f));
    const talus_vec3 zero = {0.0f, 0.0f, 0.0f};
    kit_steps(&world, 1);
    for (int i = 0; i < BAD_COUNT; i++) {
        talus_vec3 bad = {0.0f, 0.0f, BAD[i]};
        talus_pose place = kit_pose(0.0f, 0.0f, 0.0f), turn = place;
        place.position.y = BAD[i], turn.rotation.w = BAD[i];
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_pose(&world, box, &place));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_pose(&world, box, &turn));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_move_to(&world, mover, &place, 0.1f));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_move_to(&world, mover, &turn, 0.1f));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_velocity(&world, box, bad, zero));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_velocity(&world, box, zero, bad));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_force(&world, box, bad, zero));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_force(&world, box, zero, bad));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_torque(&world, box, bad));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_impulse(&world, box, bad, zero));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_impulse(&world, box, zero, bad));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_angular_impulse(&world, box, bad));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_gravity_scale(&world, box, BAD[i]));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_damping(&world, box, BAD[i], 0.0f));
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_damping(&world, box, 0.0f, BAD[i]));
    }
    talus_pose no_turn = kit_pose(0.0f, 0.0f, 0.0f);
    no_turn.rotation.w = 0.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_pose(&world, box, &no_turn));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, mover, &no_turn, 0.1f));
    talus_pose pose = kit_pose(0.0f, 1.0f, 0.0f);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_pose(&world, box, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_pose(&world, box, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, mover, NULL, 0.1f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, box, &pose, 0.1f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, rock, &pose, 0.1f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, mover, &pose, 0.0f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, mover, &pose, -1.0f));
    assert_int_not_equal(talus_body_move_to(&world, mover, &pose, NAN), TALUS_OK);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_velocity(&world, rock, zero, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_apply_force(&world, rock, zero, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_apply_force(&world, mover, zero, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_apply_torque(&world, mover, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_apply_impulse(&world, rock, zero, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_apply_angular_impulse(&world, rock, zero));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_damping(&world, box, -1.0f, 0.0f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_damping(&world, box, 0.0f, -1.0f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_locks(&world, box, 64));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_velocity(&world, box, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_type(&world, box, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_user_data(&world, box, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_get_mass(&world, box, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_mass(&world, box, NULL));
    /* forces whose sum no float holds */
    OK(talus_body_apply_torque(&world, box, kit_vec(0.0f, 3e38f, 0.0f)));
    REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_torque(&world, box, kit_vec(0.0f, 3e38f, 0.0f)));
    OK(talus_body_apply_torque(&world, box, kit_vec(0.0f, -3e38f, 0.0f)));
    /* further out than the square of a distance may be */
    talus_pose far = kit_pose(0.0f, 0.0f, -2.0f * TALUS_MAX_COORDINATE);
    talus_body_def far_def = talus_body_def_default();
    talus_joint_def far_joint = talus_joint_def_default();
    talus_shape_def far_shape = talus_shape_def_default();
    talus_body body;
    talus_joint joint;
    talus_shape shape;
    talus_mass far_mass;
    OK(talus_body_get_mass(&world, box, &far_mass));
    far_mass.center = far.position, far_def.pose = far, far_shape.pose = far;
    far_joint.a = box, far_joint.frame_b = far;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_pose(&world, box, &far));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_move_to(&world, mover, &far, 0.1f));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_set_mass(&world, box, &far_mass));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_create(&world, &far_def, &body));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, box, &far_shape, &shape));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_joint_create(&world, &far_joint, &joint));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_sleep(&world, rock));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_body_destroy(&world, talus_world_ground(&world)));
    /* an impulse whose velocity no float holds */
    talus_mass light = {0.1f, {0.0f, 0.0f, 0.0f}, {{0.01f, 0.0f, 0.0f}, {0.0f, 0.01f, 0.0f}, {0.0f, 0.0f, 0.01f}}};
    OK(talus_body_set_mass(&world, box, &light));
    REFUSED(&world, TALUS_NOT_FINITE, talus_body_apply_angular_impulse(&world, box, kit_vec(3e38f, 3e38f, 3e38f)));
    kit_end(&world);
}

static void masses(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_mass mass, broken;
    OK(talus_body_get_mass(&world, box, &mass));
    NEAR(mass.mass, 1000.0, 1e-3);
    NEAR(mass.inertia.x.x, 1000.0 / 6.0, 1e-3);
    for (int i = 0; i < BAD_COUNT; i++) {
        broken = mass, broken.mass = BAD[i];
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_mass(&world, box, &broken));
        broken = mass, broken.center.y = BAD[i];
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_mass(&world, box, &broken));
        broken = mass, broken.inertia.z.x = BAD[i];
        REFUSED(&world, TALUS_NOT_FINITE, talus_body_set_mass(&world, box, &broken));
    }
    broken = mass, broken.mass = -1.0f;
    REFUSED(&world, TALUS_BAD_MASS, talus_body_set_mass(&world, box, &broken));
    broken = mass, broken.inertia.x.x = -1.0f;
    REFUSED(&world, TALUS_BAD_MASS, talus_body_set_mass(&world, box, &broken));
    broken = mass, broken.inertia.x.y = 10.0f; /* not symmetric */
    REFUSED(&world, TALUS_BAD_MASS, talus_body_set_mass(&world, box, &broken));
    broken = mass; /* symmetric, but with a negative principal moment */
    broken.inertia.x.y = broken.inertia.y.x = 0.99f * mass.inertia.x.x;
    broken.inertia.y.z = broken.inertia.z.y = -0.99f * mass.inertia.x.x;
    broken.inertia.x.z = broken.inertia.z.x = 0.99f * mass.inertia.x.x;
    REFUSED(&world, TALUS_BAD_MASS, talus_body_set_mass(&world, box, &broken));
    /* a mass set stays, whatever shapes come */
    mass.mass = 3.0f, mass.center = kit_vec(0.0f, 0.25f, 0.0f);
    OK(talus_body_set_mass(&world, box, &mass));
    talus_shape_def ball = kit_ball_def(1.0f);
    kit_shape(&world, box, &ball);
    OK(talus_body_get_mass(&world, box, &broken));
    NEAR(broken.mass, 3.0, 0.0);
    NEAR(broken.center.y, 0.25, 0.0);
    NEAR(kit_place(&world, box).y, 0.0, 1e-6); /* the origin stays where it was */
    OK(talus_body_mass_from_shapes(&world, box));
    OK(talus_body_get_mass(&world, box, &broken));
    NEAR(broken.mass, 1000.0 * (1.0 + 4.18879), 0.1);
    kit_end(&world);
}

static void shape_arguments(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def good = talus_shape_def_default(), broken;
    talus_shape shape;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, NULL, &shape));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &good, NULL));
#define AT(field) offsetof(talus_shape_def, field)
    const size_t floats[] = {AT(geometry.half.x),
                             AT(geometry.half.z),
                             AT(pose.position.x),
                             AT(pose.rotation.z),
                             AT(density),
                             AT(material.static_friction),
                             AT(material.dynamic_friction),
                             AT(material.restitution),
                             AT(material.rolling_resistance)};
    for (size_t k = 0; k < sizeof floats / sizeof *floats; k++) {
        for (int i = 0; i < BAD_COUNT; i++) {
            broken = good;
            set_float(&broken, floats[k], BAD[i]);
            REFUSED(&world, TALUS_NOT_FINITE, talus_shape_create(&world, body, &broken, &shape));
        }
    }
    const size_t positive[] = {AT(density), AT(material.static_friction), AT(material.dynamic_friction),
                               AT(material.restitution), AT(material.rolling_resistance)};
    for (size_t k = 0; k < sizeof positive / sizeof *positive; k++) {
        broken = good;
        set_float(&broken, positive[k], -0.5f);
        REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &broken, &shape));
    }
    broken = good, broken.material.restitution = 1.5f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &broken, &shape));
    broken = good, broken.material.friction_combine = TALUS_COMBINE_COUNT;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &broken, &shape));
    broken = good, broken.material.restitution_combine = (talus_combine)-1;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &broken, &shape));
    broken = good, broken.pose.rotation.w = 0.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_create(&world, body, &broken, &shape));
    const float sizes[] = {0.0f, -1.0f, 1e-7f, 2e6f};
    for (int i = 0; i < 4; i++) {
        broken = good, broken.geometry.half.y = sizes[i];
        REFUSED(&world, TALUS_BAD_SHAPE, talus_shape_create(&world, body, &broken, &shape));
        broken = kit_ball_def(sizes[i]);
        REFUSED(&world, TALUS_BAD_SHAPE, talus_shape_create(&world, body, &broken, &shape));
        broken = good, broken.geometry.type = TALUS_CAPSULE;
        broken.geometry.radius_bottom = 1.0f, broken.geometry.radius_top = sizes[i];
        REFUSED(&world, TALUS_BAD_SHAPE, talus_shape_create(&world, body, &broken, &shape));
        broken.geometry.type = TALUS_CYLINDER, broken.geometry.radius_top = 1.0f,
        broken.geometry.half_height = sizes[i];
        REFUSED(&world, TALUS_BAD_SHAPE, talus_shape_create(&world, body, &broken, &shape));
    }
    broken = good, broken.geometry.type = TALUS_SHAPE_TYPE_COUNT;
    assert_int_not_equal(talus_shape_create(&world, body, &broken, &shape), TALUS_OK);
    broken = good, broken.geometry.type = TALUS_CAPSULE; /* a ball as a capsule */
    broken.geometry.radius_bottom = broken.geometry.radius_top = 1.0f, broken.geometry.half_height = 0.0f;
    OK(talus_shape_create(&world, body, &broken, &shape));
    broken.geometry.type = TALUS_CYLINDER; /* a cone */
    broken.geometry.radius_top = 0.0f, broken.geometry.half_height = 0.5f;
    OK(talus_shape_create(&world, body, &broken, &shape));
#undef AT
    kit_end(&world);
}

static void hulls_of_the_region(void **state) {
    (void)state;
    size_t bytes;
    unsigned char *hull = kit_hull_region(&bytes);
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    talus_shape_def def = talus_shape_def_default();
    talus_shape shape;
    def.geometry.type = TALUS_HULL;
    REFUSED(&world, TALUS_BAD_BLOB, talus_shape_create(&world, body, &def, &shape)); /* no region */
    world.geometry = hull;
    world.geometry_bytes = bytes - 1u;
    REFUSED(&world, TALUS_BAD_BLOB, talus_shape_create(&world, body, &def, &shape));
    world.geometry_bytes = bytes;
    def.geometry.hull = 4;
    assert_int_not_equal(talus_shape_create(&world, body, &def, &shape), TALUS_OK);
    def.geometry.hull = UINT32_MAX - 31u;
    REFUSED(&world, TALUS_BAD_BLOB, talus_shape_create(&world, body, &def, &shape));
    def.geometry.hull = 0;
    hull[bytes / 2u] ^= 1u;
    REFUSED(&world, TALUS_BAD_BLOB, talus_shape_create(&world, body, &def, &shape));
    hull[bytes / 2u] ^= 1u;
    OK(talus_shape_create(&world, body, &def, &shape));
    talus_aabb box;
    OK(talus_shape_get_aabb(&world, shape, &box));
    NEAR(box.upper.x, 0.5, 1e-4);
    NEAR(box.lower.z, -0.5, 1e-4);
    talus_mass mass, own = talus_hull_mass((const talus_hull *)(const void *)hull, 1000.0f);
    OK(talus_body_get_mass(&world, body, &mass));
    NEAR(mass.mass, own.mass, 1e-3);
    kit_end(&world);
    kit_free(hull);
}

static void shape_properties(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(1.0f, 2.0f, 3.0f)), owner;
    talus_shape_def def = kit_ball_def(0.5f);
    def.user_data = 42;
    def.filter.category = 6, def.filter.mask = 9, def.filter.group = -3;
    def.material.rolling_resistance = 0.125f;
    talus_shape shape = kit_shape(&world, body, &def);
    uint64_t data;
    talus_material material, broken;
    talus_filter filter;
    talus_aabb box;
    OK(talus_shape_get_user_data(&world, shape, &data));
    assert_true(data == 42);
    OK(talus_shape_get_body(&world, shape, &owner));
    assert_memory_equal(&owner, &body, sizeof body);
    OK(talus_shape_get_filter(&world, shape, &filter));
    assert_true(filter.category == 6 && filter.mask == 9 && filter.group == -3);
    OK(talus_shape_get_material(&world, shape, &material));
    NEAR(material.rolling_resistance, 0.125, 0.0);
    OK(talus_shape_get_aabb(&world, shape, &box));
    NEAR(box.lower.y, 1.5, 1e-5);
    NEAR(box.upper.z, 3.5, 1e-5);
    broken = material, broken.static_friction = NAN;
    REFUSED(&world, TALUS_NOT_FINITE, talus_shape_set_material(&world, shape, &broken));
    broken = material, broken.restitution = -0.1f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_set_material(&world, shape, &broken));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_set_material(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_set_filter(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_get_body(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_get_user_data(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_get_material(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_get_filter(&world, shape, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_shape_get_aabb(&world, shape, NULL));
    OK(talus_shape_destroy(&world, shape));
    assert_int_equal(talus_shape_is_valid(&world, shape), 0);
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_destroy(&world, shape));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_get_body(&world, shape, &owner));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_get_user_data(&world, shape, &data));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_get_material(&world, shape, &material));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_set_material(&world, shape, &material));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_get_filter(&world, shape, &filter));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_set_filter(&world, shape, &filter));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_get_aabb(&world, shape, &box));
    kit_end(&world);
}

static void stale_bodies(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body old = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    talus_joint_def joint = talus_joint_def_default();
    talus_joint handle;
    talus_joint_make_ball(&joint);
    joint.b = old;
    OK(talus_joint_create(&world, &joint, &handle));
    talus_shape_def def = talus_shape_def_default();
    talus_shape shape = kit_shape(&world, old, &def);
    OK(talus_body_destroy(&world, old));
    assert_int_equal(talus_joint_is_valid(&world, handle), 0); /* went with it */
    assert_int_equal(talus_shape_is_valid(&world, shape), 0);
    talus_body heir = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f));
    assert_int_equal(heir.index, old.index); /* the place is used again, the handle is not */
    const talus_body stale[] = {old, {0, 0}, {1, 77}, {60000, 1}, {UINT32_MAX, UINT32_MAX}, {63, 1}, {64, 1}};
    for (size_t i = 0; i < sizeof stale / sizeof *stale; i++) {
        talus_body s = stale[i];
        talus_pose pose = kit_pose(0.0f, 0.0f, 0.0f);
        talus_vec3 v = {0.0f, 0.0f, 0.0f};
        talus_mass mass;
        talus_body_type type;
        uint64_t data;
        assert_int_equal(talus_body_is_valid(&world, s), 0);
        assert_int_equal(talus_body_is_awake(&world, s), 0);
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_destroy(&world, s));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_pose(&world, s, &pose));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_pose(&world, s, &pose));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_move_to(&world, s, &pose, 0.1f));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_velocity(&world, s, &v, &v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_velocity(&world, s, v, v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_mass(&world, s, &mass));
        OK(talus_body_get_mass(&world, heir, &mass));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_mass(&world, s, &mass));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_mass_from_shapes(&world, s));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_apply_force(&world, s, v, v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_apply_torque(&world, s, v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_apply_impulse(&world, s, v, v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_apply_angular_impulse(&world, s, v));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_damping(&world, s, 0.0f, 0.0f));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_gravity_scale(&world, s, 1.0f));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_set_locks(&world, s, 0));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_type(&world, s, &type));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_get_user_data(&world, s, &data));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_wake(&world, s));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_body_sleep(&world, s));
        REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_create(&world, s, &def, &shape));
        if (s.generation != 0) { /* none is the world */
            joint.b = s;
            REFUSED(&world, TALUS_STALE_HANDLE, talus_joint_create(&world, &joint, &handle));
        }
    }
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts),
        cmocka_unit_test(no_world),
        cmocka_unit_test(world_settings),
        cmocka_unit_test(a_clock_is_read),
        cmocka_unit_test(body_arguments),
        cmocka_unit_test(body_numbers),
        cmocka_unit_test(masses),
        cmocka_unit_test(shape_arguments),
        cmocka_unit_test(hulls_of_the_region),
        cmocka_unit_test(shape_properties),
        cmocka_unit_test(stale_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
