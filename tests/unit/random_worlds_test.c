/* Worlds of random bodies, shapes, joints and calls, under capacities that are too small, stepped a hundred times:
 * whatever happens, the state stays finite, statuses are among those named, queries by the trees answer as the shapes
 * do one by one, and no step takes for ever. TALUS_WORLDS: how many (200); TALUS_SEED: the first one's seed. */
#include "world_query_kit.h"

#include <stdio.h>

static uint64_t state_of_random;

static uint32_t bits(void) { /* PCG-XSH-RR, O'Neill 2014 */
    uint64_t x = state_of_random;
    unsigned turn = (unsigned)(x >> 59);
    state_of_random = x * 6364136223846793005u + 1442695040888963407u;
    uint32_t y = (uint32_t)(((x >> 18) ^ x) >> 27);
    return y >> turn | y << ((32u - turn) & 31u);
}
static uint32_t below(uint32_t n) { return bits() % n; }
static float between(float low, float high) {
    float t = (float)(bits() >> 8) / 16777216.0f;
    return low + t * (high - low);
}
/* Evenly over the orders of magnitude. */
static float across(float low, float high) { return expf(between(logf(low), logf(high))); }
static talus_vec3 point(float size) {
    talus_vec3 v;
    v.x = between(-size, size);
    v.y = between(-size, size);
    v.z = between(-size, size);
    return v;
}
static talus_pose place(float size) {
    talus_pose p;
    p.position = point(size);
    p.rotation.x = between(-1.0f, 1.0f), p.rotation.y = between(-1.0f, 1.0f);
    p.rotation.z = between(-1.0f, 1.0f), p.rotation.w = between(0.1f, 1.0f);
    return p;
}

/* --- hulls, once ------------------------------------------------------------------------------------ */

enum { HULLS = 12 };
static unsigned char *region;
static size_t region_bytes;
static uint32_t hull_at[HULLS];

static int make_hulls(void **state) {
    (void)state;
    enum { POINTS = 64 };
    size_t room = talus_hull_max_size(POINTS) * HULLS, scratch_size = talus_hull_scratch_size(POINTS);
    void *scratch = kit_alloc(scratch_size);
    region = kit_alloc(room);
    for (int i = 0; i < HULLS; i++) {
        talus_vec3 points[POINTS], size;
        uint32_t count = 4u + below(POINTS - 4u);
        size_t bytes;
        size.x = across(0.01f, 3.0f), size.y = across(0.01f, 3.0f), size.z = across(0.01f, 3.0f);
        for (uint32_t k = 0; k < count; k++) {
            points[k] = point(1.0f);
            points[k].x *= size.x, points[k].y *= size.y, points[k].z *= size.z;
        }
        talus_status status =
            talus_hull_build(points, count, scratch, scratch_size, region + region_bytes, room - region_bytes, &bytes);
        if (status != TALUS_OK) {
            i--;
            continue;
        }
        hull_at[i] = (uint32_t)region_bytes;
        region_bytes += (bytes + TALUS_BLOB_ALIGNMENT - 1u) / TALUS_BLOB_ALIGNMENT * TALUS_BLOB_ALIGNMENT;
    }
    kit_free(scratch);
    return 0;
}
static int free_hulls(void **state) {
    (void)state;
    kit_free(region);
    return 0;
}

/* --- one world -------------------------------------------------------------------------------------- */

enum { BODIES = 48, SHAPES = 80, JOINTS = 24 };
typedef struct scene {
    talus_world world;
    talus_body body[BODIES];
    talus_shape shape[SHAPES];
    talus_joint joint[JOINTS];
    uint32_t bodies, shapes, joints;
    int wild; /* masses and speeds of any size */
} scene;

static talus_shape_def any_shape(const scene *s) {
    talus_shape_def def = talus_shape_def_default();
    float size = s->wild && below(8) == 0 ? across(1e-3f, 100.0f) : across(0.1f, 2.0f);
    def.geometry.type = (talus_shape_type)below(TALUS_SHAPE_TYPE_COUNT);
    def.geometry.radius = size;
    def.geometry.half_height = below(10) ? size * across(0.1f, 5.0f) : size;
    def.geometry.radius_top = below(4) ? size : size * across(0.05f, 1.0f);
    def.geometry.radius_bottom = size;
    def.geometry.half = kit_vec(size, size * across(0.05f, 5.0f), size * across(0.05f, 5.0f));
    def.geometry.hull = hull_at[below(HULLS)];
    if (below(3) == 0) {
        def.pose = place(1.0f);
    }
    def.material.static_friction = between(0.0f, 2.0f);
    def.material.dynamic_friction = between(0.0f, 2.0f);
    def.material.restitution = below(3) ? 0.0f : between(0.0f, 1.0f);
    def.material.rolling_resistance = below(4) ? 0.0f : between(0.0f, 0.2f);
    def.material.friction_combine = (talus_combine)below(TALUS_COMBINE_COUNT);
    def.material.restitution_combine = (talus_combine)below(TALUS_COMBINE_COUNT);
    def.filter.group = (int32_t)below(9) - 4;
    if (below(4) == 0) {
        def.filter.category = bits(), def.filter.mask = bits();
    }
    def.density = s->wild ? across(1e-3f, 1e5f) : across(10.0f, 1e4f);
    def.sensor = below(10) == 0;
    def.events = below(2) == 0;
    return def;
}

/* None, any, or those of a plane. */
static uint32_t any_locks(void) {
    uint32_t plane = talus_lock_plane(below(3));
    uint32_t any = below(64), kind = below(8);
    return kind < 1 ? 0u : kind < 5 ? plane : any;
}

static void add_body(scene *s) {
    talus_body_def def = talus_body_def_default();
    uint32_t kind = below(10);
    def.type = kind < 2 ? TALUS_STATIC : kind < 3 ? TALUS_KINEMATIC : TALUS_DYNAMIC;
    def.pose = place(below(10) ? 6.0f : 0.5f);
    float speed = s->wild && below(4) == 0 ? across(1.0f, 1e4f) : 5.0f;
    def.linear_velocity = point(speed);
    def.angular_velocity = point(below(4) ? 3.0f : speed);
    def.linear_damping = below(4) ? 0.0f : across(1e-3f, 1e3f);
    def.angular_damping = below(4) ? 0.0f : across(1e-3f, 1e3f);
    def.gravity_scale = below(6) ? 1.0f : between(-2.0f, 2.0f);
    def.locks = any_locks();
    def.can_sleep = below(8) != 0;
    def.starts_asleep = below(8) == 0;
    talus_body body;
    talus_status status = talus_body_create(&s->world, &def, &body);
    assert_true(status == TALUS_OK || status == TALUS_FULL_BODIES);
    if (status != TALUS_OK) {
        return;
    }
    s->body[s->bodies++] = body;
    for (uint32_t i = 1u + below(3) / 2u; i-- > 0;) {
        talus_shape_def shape = any_shape(s);
        talus_shape handle;
        status = talus_shape_create(&s->world, body, &shape, &handle);
        assert_true(status == TALUS_OK || status == TALUS_FULL_SHAPES);
        if (status == TALUS_OK && s->shapes < SHAPES) {
            s->shape[s->shapes++] = handle;
        }
    }
    if (below(4) == 0) {
        talus_mass mass;
        OK(talus_body_get_mass(&s->world, body, &mass));
        float factor = s->wild ? across(1e-3f, 1e6f) / mass.mass : across(0.1f, 10.0f);
        mass.mass *= factor;
        float *m = &mass.inertia.x.x;
        for (int k = 0; k < 9; k++) {
            m[k] *= factor;
        }
        OK(talus_body_set_mass(&s->world, body, &mass));
    }
}

static talus_body any_body(scene *s) {
    talus_body none = {0, 0};
    return s->bodies && below(12) ? s->body[below(s->bodies)] : none;
}

static talus_axis any_axis(float scale) {
    talus_axis axis = {(talus_axis_mode)below(TALUS_AXIS_MODE_COUNT), 0.0f, 0.0f, 0.0f, 0.0f};
    axis.lower = between(-scale, 0.0f), axis.upper = between(0.0f, scale);
    if (axis.mode == TALUS_AXIS_LOCKED) {
        axis.lower = 0.0f;
    }
    if (below(4) == 0) {
        axis.stiffness = across(1.0f, 1e6f), axis.damping = across(0.1f, 1e4f);
    }
    return axis;
}

static talus_drive any_drive(void) {
    talus_drive drive = {0, 0, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    drive.enabled = below(3) == 0, drive.acceleration = (uint8_t)below(2);
    drive.position_target = between(-1.0f, 1.0f), drive.velocity_target = between(-5.0f, 5.0f);
    drive.stiffness = across(0.1f, 1e6f), drive.damping = across(0.1f, 1e5f);
    drive.max_force = below(2) ? across(1.0f, 1e6f) : 0.0f;
    return drive;
}

static void add_joint(scene *s) {
    talus_joint_def def = talus_joint_def_default();
    def.a = any_body(s), def.b = any_body(s);
    def.frame_a = place(1.0f), def.frame_b = place(1.0f);
    switch (below(7)) {
    case 0:
        talus_joint_make_fixed(&def);
        break;
    case 1:
        talus_joint_make_ball(&def);
        break;
    case 2:
        talus_joint_make_revolute(&def);
        break;
    case 3:
        talus_joint_make_prismatic(&def);
        break;
    case 4:
        talus_joint_make_distance(&def, between(0.0f, 1.0f), between(1.0f, 3.0f));
        break;
    default:
        for (int k = 0; k < 3; k++) {
            def.linear[k] = any_axis(1.0f), def.angular[k] = any_axis(2.0f);
        }
        def.cone_axis = (int32_t)below(5) - 1, def.cone_angle = between(0.0f, 3.0f);
        break;
    }
    for (int k = 0; k < 3 && below(2); k++) {
        def.linear_drive[k] = any_drive(), def.angular_drive[k] = any_drive();
    }
    def.collide_connected = (uint8_t)below(2);
    def.break_force = below(3) ? 0.0f : across(1.0f, 1e7f);
    def.break_torque = below(3) ? 0.0f : across(1.0f, 1e7f);
    talus_joint joint;
    talus_status status = talus_joint_create(&s->world, &def, &joint);
    assert_true(status == TALUS_OK || status == TALUS_FULL_JOINTS || status == TALUS_BAD_ARGUMENT ||
                status == TALUS_STALE_HANDLE);
    if (status == TALUS_OK && s->joints < JOINTS) {
        s->joint[s->joints++] = joint;
    }
}

/* Any call on something that may be gone. */
static void meddle(scene *s) {
    talus_world *w = &s->world;
    talus_body body = any_body(s);
    talus_shape shape = s->shapes ? s->shape[below(s->shapes)] : (talus_shape){0, 0};
    talus_joint joint = s->joints ? s->joint[below(s->joints)] : (talus_joint){0, 0};
    talus_pose pose = place(5.0f);
    talus_shape_def def = any_shape(s);
    talus_drive drive = any_drive();
    float force = s->wild ? across(1.0f, 1e8f) : 1e3f;
    talus_vec3 f = point(force), at = point(5.0f), spin = point(force);
    talus_accuracy accuracy = {below(3) ? across(1e-5f, 1.0f) : 0.0f, 1u + below(6), 1u + below(64)};
    switch (below(21)) {
    case 0:
        (void)talus_body_destroy(w, body);
        break;
    case 1:
        (void)talus_shape_destroy(w, shape);
        break;
    case 2:
        (void)talus_joint_destroy(w, joint);
        break;
    case 3:
        (void)talus_body_set_pose(w, body, &pose);
        break;
    case 4:
        (void)talus_body_move_to(w, body, &pose, 0.1f);
        break;
    case 5:
        (void)talus_body_set_velocity(w, body, at, spin);
        break;
    case 6:
        (void)talus_body_apply_force(w, body, f, at);
        break;
    case 7:
        (void)talus_body_apply_torque(w, body, f);
        break;
    case 8:
        (void)talus_body_apply_impulse(w, body, f, at);
        break;
    case 9:
        (void)talus_body_apply_angular_impulse(w, body, f);
        break;
    case 10:
        (void)talus_body_set_locks(w, body, any_locks());
        break;
    case 11:
        (void)talus_body_wake(w, body);
        break;
    case 12:
        (void)talus_body_sleep(w, body);
        break;
    case 13:
        (void)talus_shape_set_filter(w, shape, &def.filter);
        break;
    case 14:
        (void)talus_shape_set_material(w, shape, &def.material);
        break;
    case 15:
        (void)talus_shape_create(w, body, &def, &shape);
        break;
    case 16:
        (void)talus_joint_set_angular_drive(w, joint, (int)below(3), &drive);
        break;
    case 17:
        (void)talus_joint_set_linear_drive(w, joint, (int)below(3), &drive);
        break;
    case 18:
        (void)talus_body_set_gravity_scale(w, body, between(-3.0f, 3.0f));
        break;
    case 19:
        OK(talus_world_set_accuracy(w, &accuracy));
        break;
    default:
        (void)talus_world_set_gravity(w, point(20.0f));
        break;
    }
}

static int finite3(talus_vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static void check(scene *s, uint64_t seed, int step) {
    assert_int_equal(talus_world_validate(&s->world), TALUS_OK);
    for (uint32_t i = 0; i < s->bodies; i++) {
        talus_pose pose;
        talus_vec3 v, w;
        if (!talus_body_is_valid(&s->world, s->body[i])) {
            continue;
        }
        OK(talus_body_get_pose(&s->world, s->body[i], &pose));
        OK(talus_body_get_velocity(&s->world, s->body[i], &v, &w));
        talus_quat q = pose.rotation;
        float length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        if (!finite3(pose.position) || !finite3(v) || !finite3(w) || !(fabsf(length - 1.0f) < 1e-3f)) {
            print_error("seed %lu step %d body %u: %g %g %g, |q|^2 %g, v %g %g %g, w %g %g %g\n", (unsigned long)seed,
                        step, s->body[i].index, (double)pose.position.x, (double)pose.position.y,
                        (double)pose.position.z, (double)length, (double)v.x, (double)v.y, (double)v.z, (double)w.x,
                        (double)w.y, (double)w.z);
            fail();
        }
    }
    talus_counters c = kit_counters(&s->world);
    talus_events e = kit_events(&s->world);
    const talus_usage *usages[] = {&c.bodies, &c.shapes, &c.joints, &c.contacts};
    for (int i = 0; i < 4; i++) {
        assert_true(usages[i]->used <= usages[i]->high_water && usages[i]->high_water <= usages[i]->capacity);
    }
    for (uint32_t i = 0; i < e.hit_count; i++) {
        assert_true(finite3(e.hit[i].point) && finite3(e.hit[i].normal) && isfinite(e.hit[i].speed));
    }
}

/* With `other`, each step is made by that instruction set too, from the same state, and the first difference printed.
 */
static uint64_t run(uint64_t seed, talus_isa isa, talus_isa other) {
    static scene s;
    memset(&s, 0, sizeof s);
    state_of_random = seed * 0x9e3779b97f4a7c15u + 1u;
    (void)bits();
    talus_world_def def = talus_world_def_default();
    int tight = below(3) == 0;
    def.body_capacity = tight ? 1u + below(BODIES) : BODIES;
    def.shape_capacity = tight ? 1u + below(40) : 128;
    def.joint_capacity = tight ? 1u + below(6) : 32;
    def.contact_capacity = tight ? 1u + below(40) : 2048;
    def.event_capacity = tight ? 1u + below(8) : 256;
    def.profile_capacity = isa == TALUS_ISA_SCALAR ? 0u : 3u; /* the state knows nothing of it */
    def.substeps = 1u + below(8);
    def.iterations = 1u + below(3);
    def.error_budget = below(3) ? 0.0f : across(1e-4f, 0.1f);
    def.most_substeps = 1u + below(32);
    def.recycle_slack = below(3) ? def.recycle_slack : 0.0f;
    def.enable_sleep = below(4) != 0;
    def.isa = isa;
    s.world = kit_world(&def);
    s.world.geometry = region, s.world.geometry_bytes = region_bytes;
    s.wild = below(2) == 0;
    kit_floor(&s.world);
    for (uint32_t i = 4u + below(BODIES - 4u); i-- > 0;) {
        add_body(&s);
    }
    for (uint32_t i = below(JOINTS); i-- > 0;) {
        add_joint(&s);
    }
    int calls = below(2) == 0;
    float dt = below(8) ? 1.0f / 60.0f : across(1e-4f, 1.0f);
    size_t bytes = talus_world_size(&def);
    void *second = other != TALUS_ISA_BEST ? kit_alloc(bytes) : NULL;
    for (int step = 0; step < 100; step++) {
        if (calls && below(3) == 0) {
            meddle(&s);
        }
        if (second) {
            memcpy(second, s.world.block, bytes);
        }
        assert_int_equal(talus_world_step(&s.world, dt, NULL, NULL), TALUS_OK);
        if (second) {
            talus_world twin = s.world;
            talus_parting d;
            twin.block = second;
            OK(talus_world_set_isa(&twin, other));
            assert_int_equal(talus_world_step(&twin, dt, NULL, NULL), TALUS_OK);
            if (talus_world_part(&s.world, &twin, 0, &d) == 1) {
                print_error("seed %lu step %d: %s row %u word %u\n", (unsigned long)seed, step, d.column.name, d.row,
                            d.word);
                fail();
            }
        }
        check(&s, seed, step);
        if (step % 50 == 30) {
            query_draw d = {(uint32_t)seed + (uint32_t)step, 0, 0};
            kit_queries(&s.world, &d, 1);
        }
    }
    uint64_t hash = talus_world_hash(&s.world);
    if (second) {
        kit_free(second);
    }
    kit_end(&s.world);
    return hash;
}

static unsigned long number_of(const char *name, unsigned long otherwise) {
    const char *text = getenv(name);
    return text ? strtoul(text, NULL, 0) : otherwise;
}

static void worlds_stay_sound(void **state) {
    (void)state;
    unsigned long count = number_of("TALUS_WORLDS", 200), first = number_of("TALUS_SEED", 1);
    print_message("%lu worlds from seed %lu\n", count, first);
    for (unsigned long i = 0; i < count; i++) {
        uint64_t seed = first + i, hash = run(seed, TALUS_ISA_BEST, TALUS_ISA_BEST);
        if (getenv("TALUS_VERBOSE")) {
            print_message("seed %lu hash %08lx%08lx\n", (unsigned long)seed, (unsigned long)(hash >> 32),
                          (unsigned long)(hash & 0xffffffffu));
        }
        if (i % 4 == 0) { /* and the same by plain C */
            if (hash != run(seed, TALUS_ISA_SCALAR, TALUS_ISA_BEST)) {
                run(seed, TALUS_ISA_BEST, TALUS_ISA_SCALAR);
                print_error("seed %lu: other bits by plain C\n", (unsigned long)seed);
                fail();
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(worlds_stay_sound)};
    state_of_random = 12345;
    return cmocka_run_group_tests(tests, make_hulls, free_hulls);
}
