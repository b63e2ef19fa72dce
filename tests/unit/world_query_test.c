/* Queries of worlds: closed forms; against asking every shape; poses that steps and calls have just changed; restored
 * worlds, whose trees are other ones; instruction sets. TALUS_WORLDS: how many random worlds; TALUS_SEED: the first. */
#include "store_check.h"
#include "world_query_kit.h"

#include <stdio.h>

static uint32_t setting(const char *name, uint32_t otherwise) {
    const char *text = getenv(name);
    return text ? (uint32_t)strtoul(text, NULL, 10) : otherwise;
}

static talus_ray ray_of(talus_vec3 origin, talus_vec3 way) {
    talus_ray r = {origin, way};
    return r;
}

static talus_convex ball_of(float radius) {
    talus_geometry g = kit_ball_def(radius).geometry;
    talus_convex c;
    OK(talus_convex_init(&g, NULL, 0, &c));
    return c;
}

static int is_empty(const talus_query_hit *hit) {
    talus_query_hit none;
    memset(&none, 0, sizeof none);
    return memcmp(hit, &none, sizeof none) == 0;
}

static void same_vec(talus_vec3 a, float x, float y, float z, float tolerance) {
    NEAR(a.x, x, tolerance);
    NEAR(a.y, y, tolerance);
    NEAR(a.z, z, tolerance);
}

/* --- closed forms -------------------------------------------------------------------------------- */

/* A floor up to y = 0, balls of 0.5 m at y = 2, 4, 6 above it, a sensor of 1 m around y = 9. */
static talus_world ladder(talus_body ball[3], talus_shape *floor) {
    talus_world world = kit_void();
    *floor = kit_floor(&world);
    for (int i = 0; i < 3; i++) {
        ball[i] = kit_ball(&world, kit_vec(0.0f, 2.0f + 2.0f * (float)i, 0.0f), 0.5f);
    }
    talus_shape_def sensor = kit_box_def(1.0f, 1.0f, 1.0f);
    sensor.sensor = 1;
    kit_shape(&world, kit_body(&world, TALUS_STATIC, kit_vec(0.0f, 9.0f, 0.0f)), &sensor);
    return world;
}

static void rays(void **state) {
    (void)state;
    talus_body ball[3];
    talus_shape floor;
    talus_world world = ladder(ball, &floor);
    talus_query_filter filter;
    for (int stepped = 0; stepped < 2; stepped++) { /* all in the list of what moved; all in the trees */
        talus_query_hit hit, hits[4];
        talus_hits all = {hits, 4, 0};
        int any;
        talus_ray down = ray_of(kit_vec(0.3f, 20.0f, 0.0f), kit_vec(0.0f, -20.0f, 0.0f));
        OK(talus_world_ray(&world, &down, NULL, &hit));
        assert_int_equal(hit.body.index, ball[2].index);
        assert_int_equal(hit.body.generation, ball[2].generation);
        NEAR(hit.at, 13.6 / 20.0, 1e-7);
        same_vec(hit.point, 0.3f, 6.4f, 0.0f, 1e-6f);
        same_vec(hit.normal, 0.6f, 0.8f, 0.0f, 1e-6f);
        assert_true(!hit.within && memcmp(&hit.point, &hit.own, sizeof hit.own) == 0);
        OK(talus_world_ray_all(&world, &down, NULL, &all));
        assert_int_equal(all.count, 4);
        assert_int_equal(hits[1].body.index, ball[1].index);
        assert_int_equal(hits[2].body.index, ball[0].index);
        assert_int_equal(hits[3].shape.index, floor.index);
        NEAR(hits[3].at, 1.0, 0.0); /* ends on the surface */
        all.capacity = 2;
        hits[2].at = -7.0;
        OK(talus_world_ray_all(&world, &down, NULL, &all));
        assert_true(all.count == 4 && hits[0].body.index == ball[2].index && hits[1].body.index == ball[1].index);
        NEAR(hits[2].at, -7.0, 0.0);
        filter = talus_query_filter_default();
        filter.skip = ball, filter.skip_count = 3;
        OK(talus_world_ray(&world, &down, &filter, &hit));
        assert_int_equal(hit.shape.index, floor.index);
        filter.kinds = TALUS_SEE_DYNAMIC;
        OK(talus_world_ray(&world, &down, &filter, &hit));
        assert_true(is_empty(&hit));
        OK(talus_world_ray_any(&world, &down, &filter, &any));
        assert_int_equal(any, 0);
        OK(talus_world_ray_any(&world, &down, NULL, &any));
        assert_int_equal(any, 1);
        filter = talus_query_filter_default();
        filter.kinds |= TALUS_SEE_SENSORS;
        OK(talus_world_ray(&world, &down, &filter, &hit));
        NEAR(hit.at, 0.5, 1e-7);
        /* within a ball: there at once */
        talus_ray out = ray_of(kit_vec(0.1f, 2.0f, 0.0f), kit_vec(0.0f, 9.0f, 0.0f));
        OK(talus_world_ray(&world, &out, NULL, &hit));
        assert_true(hit.within && hit.at == 0.0 && hit.body.index == ball[0].index);
        same_vec(hit.normal, 0.0f, 0.0f, 0.0f, 0.0f);
        same_vec(hit.point, 0.1f, 2.0f, 0.0f, 0.0f);
        talus_ray short_one = ray_of(kit_vec(0.0f, 20.0f, 0.0f), kit_vec(0.0f, -13.49f, 0.0f));
        OK(talus_world_ray(&world, &short_one, NULL, &hit));
        assert_true(is_empty(&hit));
        kit_steps(&world, 1);
    }
    kit_end(&world);
}

/* Filters meet as those of two shapes do. */
static void filters(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_shape_def def = kit_ball_def(0.5f);
    def.filter.category = 2, def.filter.mask = 4, def.filter.group = 7;
    kit_shape(&world, kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.0f, 0.0f)), &def);
    const struct {
        uint64_t category, mask;
        int32_t group;
        int sees;
    } cases[] = {{4, 2, 0, 1}, {4, 1, 0, 0}, {1, 2, 0, 0}, {1, 1, 7, 1}, {4, 2, -7, 1}, {12, 3, 1, 1}, {0, 0, 0, 0}};
    talus_hits hits = {NULL, 0, 0};
    talus_query_filter filter = talus_query_filter_default();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        filter.filter.category = cases[i].category, filter.filter.mask = cases[i].mask;
        filter.filter.group = cases[i].group;
        OK(talus_world_at_point(&world, kit_vec(0.1f, 0.0f, 0.0f), &filter, &hits));
        assert_int_equal(hits.count, cases[i].sees);
    }
    kit_end(&world);
}

static void casts(void **state) {
    (void)state;
    talus_body ball[3];
    talus_shape floor;
    talus_world world = ladder(ball, &floor);
    talus_convex small = ball_of(0.25f);
    talus_query_hit hit, hits[4];
    talus_hits all = {hits, 4, 0};
    talus_motion motion;
    memset(&motion, 0, sizeof motion);
    motion.pose = kit_pose(0.0f, 20.0f, 0.0f);
    motion.translation = kit_vec(0.0f, -20.0f, 0.0f);
    OK(talus_world_cast(&world, &small, &motion, 1e-4f, NULL, &hit));
    assert_int_equal(hit.body.index, ball[2].index);
    NEAR(hit.at, 13.25 / 20.0, 1e-5);
    same_vec(hit.normal, 0.0f, 1.0f, 0.0f, 1e-6f);
    same_vec(hit.point, 0.0f, 6.5f, 0.0f, 1e-6f);
    NEAR(hit.own.y, hit.point.y, 1.01e-4f);
    OK(talus_world_cast_all(&world, &small, &motion, 1e-4f, NULL, &all));
    assert_int_equal(all.count, 4);
    NEAR(hits[3].at, 19.75 / 20.0, 1e-5);
    /* a bar a metre long that a quarter turn brings down on the floor: its end moves along a circle */
    talus_geometry bar = kit_box_def(1.0f, 0.01f, 0.01f).geometry;
    talus_convex shape;
    OK(talus_convex_init(&bar, NULL, 0, &shape));
    memset(&motion, 0, sizeof motion);
    motion.pose = kit_pose(10.0f, 0.5f, 0.0f);
    motion.rotation.z = -1.5707963f;
    OK(talus_world_cast(&world, &shape, &motion, 1e-4f, NULL, &hit));
    assert_int_equal(hit.shape.index, floor.index);
    NEAR(hit.at, (asin(0.5 / sqrt(1.0001)) - atan(0.01)) / 1.5707963, 2e-4);
    motion.pose.position.y = 0.005f; /* it starts in the floor */
    OK(talus_world_cast(&world, &shape, &motion, 1e-4f, NULL, &hit));
    assert_true(hit.within && hit.at == 0.0);
    kit_end(&world);
}

static void near_and_within(void **state) {
    (void)state;
    talus_body ball[3];
    talus_shape floor;
    talus_world world = ladder(ball, &floor);
    talus_convex small = ball_of(0.25f);
    talus_pose pose = kit_pose(2.0f, 4.0f, 0.0f);
    talus_query_hit hit, hits[5];
    talus_hits all = {hits, 5, 0};
    OK(talus_world_closest(&world, &small, &pose, 5.0f, NULL, &hit));
    assert_int_equal(hit.body.index, ball[1].index);
    NEAR(hit.at, 1.25, 1e-6);
    same_vec(hit.point, 0.5f, 4.0f, 0.0f, 1e-6f);
    same_vec(hit.own, 1.75f, 4.0f, 0.0f, 1e-6f);
    same_vec(hit.normal, 1.0f, 0.0f, 0.0f, 1e-6f);
    OK(talus_world_closest_all(&world, &small, &pose, 2.2f, NULL, &all));
    assert_int_equal(all.count, 3); /* as far from the first as from the third: by index */
    assert_true(hits[1].body.index == ball[0].index && hits[2].body.index == ball[2].index && hits[1].at == hits[2].at);
    OK(talus_world_closest(&world, &small, &pose, 1.2f, NULL, &hit));
    assert_true(is_empty(&hit));
    OK(talus_world_closest_to_point(&world, kit_vec(3.0f, 0.75f, 0.0f), 1.0f, NULL, &hit));
    assert_int_equal(hit.shape.index, floor.index);
    NEAR(hit.at, 0.75, 1e-6);
    same_vec(hit.point, 3.0f, 0.0f, 0.0f, 1e-6f);
    same_vec(hit.own, 3.0f, 0.75f, 0.0f, 0.0f);
    same_vec(hit.normal, 0.0f, 1.0f, 0.0f, 1e-6f);
    pose = kit_pose(0.6f, 2.0f, 0.0f);
    OK(talus_world_overlap(&world, &small, &pose, NULL, &all));
    assert_true(all.count == 1 && hits[0].body.index == ball[0].index && hits[0].within);
    OK(talus_world_at_point(&world, kit_vec(0.0f, 1.51f, 0.0f), NULL, &all));
    assert_true(all.count == 1 && hits[0].body.index == ball[0].index);
    OK(talus_world_at_point(&world, kit_vec(0.0f, 1.49f, 0.0f), NULL, &all));
    assert_int_equal(all.count, 0);
    talus_aabb box = {kit_vec(-1.0f, -0.5f, -1.0f), kit_vec(-0.45f, 4.0f, 1.0f)};
    OK(talus_world_overlap_aabb(&world, &box, NULL, &all));
    assert_int_equal(all.count, 3); /* by the boxes of the balls, though not by the balls */
    kit_end(&world);
}

/* --- what is refused ------------------------------------------------------------------------------ */

static void refused(void **state) {
    (void)state;
    talus_body ball[3];
    talus_shape floor, gone;
    talus_world world = ladder(ball, &floor), none = world;
    talus_shape_def def = kit_ball_def(1.0f);
    gone = kit_shape(&world, ball[0], &def);
    OK(talus_shape_destroy(&world, gone));
    none.block = NULL;
    talus_ray ray = ray_of(kit_vec(0.0f, 9.0f, 0.0f), kit_vec(0.0f, -9.0f, 0.0f)), bad = ray;
    talus_query_hit hit, before;
    memset(&hit, 0x5a, sizeof hit);
    before = hit;
    talus_hits hits = {NULL, 1, 0};
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&none, &ray, NULL, &hit));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(NULL, &ray, NULL, &hit));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&world, NULL, NULL, &hit));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&world, &ray, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray_any(&world, &ray, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray_all(&world, &ray, NULL, NULL));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray_all(&world, &ray, NULL, &hits));
    bad.way.z = NAN;
    REFUSED(&world, TALUS_NOT_FINITE, talus_world_ray(&world, &bad, NULL, &hit));
    bad = ray, bad.origin.x = 2e9f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&world, &bad, NULL, &hit));
    talus_query_filter filter = talus_query_filter_default();
    filter.kinds = 16;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&world, &ray, &filter, &hit));
    filter = talus_query_filter_default(), filter.skip_count = 1;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_ray(&world, &ray, &filter, &hit));
    REFUSED(&world, TALUS_STALE_HANDLE, talus_shape_ray(&world, gone, &ray, &hit));
    talus_convex small = ball_of(0.25f);
    talus_motion motion;
    memset(&motion, 0, sizeof motion);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_cast(&world, &small, &motion, 1e-3f, NULL, &hit));
    motion.pose.rotation.w = 1.0f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_cast(&world, &small, &motion, 0.0f, NULL, &hit));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_cast(&world, NULL, &motion, 1e-3f, NULL, &hit));
    motion.rotation.x = 3.2f;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_cast(&world, &small, &motion, 1e-3f, NULL, &hit));
    talus_pose pose = kit_pose(0.0f, 0.0f, 0.0f);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_closest(&world, &small, &pose, -1.0f, NULL, &hit));
    REFUSED(&world, TALUS_NOT_FINITE, talus_world_closest(&world, &small, &pose, INFINITY, NULL, &hit));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_closest(&world, &small, NULL, 1.0f, NULL, &hit));
    REFUSED(&world, TALUS_NOT_FINITE, talus_world_closest_to_point(&world, kit_vec(0, NAN, 0), 1.0f, NULL, &hit));
    talus_aabb box = {kit_vec(1.0f, 0.0f, 0.0f), kit_vec(0.0f, 1.0f, 1.0f)};
    hits.capacity = 0;
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_overlap_aabb(&world, &box, NULL, &hits));
    assert_memory_equal(&hit, &before, sizeof hit);
    kit_end(&world);
}

/* --- what has just changed ------------------------------------------------------------------------ */

static void seen_at_once(void **state) {
    (void)state;
    talus_world world = kit_void();
    talus_body box = kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    kit_steps(&world, 3);
    talus_pose pose = kit_pose(100.0f, 0.0f, 0.0f);
    OK(talus_body_set_pose(&world, box, &pose));
    talus_hits hits = {NULL, 0, 0};
    OK(talus_world_at_point(&world, kit_vec(100.4f, 0.0f, 0.0f), NULL, &hits));
    assert_int_equal(hits.count, 1);
    OK(talus_world_at_point(&world, kit_vec(0.0f, 0.0f, 0.0f), NULL, &hits));
    assert_int_equal(hits.count, 0);
    /* a step of 10 m across: further than any fat box was made for, as the speed came at once */
    OK(talus_body_set_velocity(&world, box, kit_vec(0.0f, 0.0f, 600.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    kit_steps(&world, 1);
    OK(talus_world_at_point(&world, kit_vec(100.0f, 0.0f, 10.3f), NULL, &hits));
    assert_int_equal(hits.count, 1);
    OK(talus_body_destroy(&world, box));
    OK(talus_world_at_point(&world, kit_vec(100.0f, 0.0f, 10.3f), NULL, &hits));
    assert_int_equal(hits.count, 0);
    kit_end(&world);
}

/* Bars that spin, balls that are kicked, boxes that fall on them, sensors, filters, what has no room for its pairs. */
static talus_world restless(uint32_t seed, const void *hull, size_t hull_bytes, uint32_t contacts) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = 120, def.shape_capacity = 160, def.contact_capacity = contacts;
    def.sleep_time = 0.1f;
    talus_world world = kit_world(&def);
    kit_busy(&world, hull, hull_bytes);
    for (uint32_t i = 0; i < 60; i++) {
        talus_body_def b = talus_body_def_default();
        talus_body body;
        b.type = draw(&seed) % 6u ? TALUS_DYNAMIC : draw(&seed) % 2u ? TALUS_KINEMATIC : TALUS_STATIC;
        b.pose.position.x = draw_float(&seed, -4.0f, 4.0f);
        b.pose.position.y = draw_float(&seed, 0.0f, 8.0f);
        b.pose.position.z = draw_float(&seed, -4.0f, 4.0f);
        if (b.type != TALUS_STATIC) {
            b.angular_velocity.z = draw(&seed) % 3u ? 0.0f : draw_float(&seed, -20.0f, 20.0f);
            b.linear_velocity.x = draw(&seed) % 3u ? 0.0f : draw_float(&seed, -30.0f, 30.0f);
        }
        OK(talus_body_create(&world, &b, &body));
        talus_shape_def s = draw(&seed) % 2u ? kit_box_def(1.2f, 0.1f, 0.2f) : kit_ball_def(0.3f);
        s.geometry.radius = 0.3f, s.geometry.half_height = 0.4f, s.geometry.radius_top = 0.1f,
        s.geometry.radius_bottom = 0.3f;
        s.geometry.type = draw(&seed) % 3u ? s.geometry.type : (talus_shape_type)(draw(&seed) % TALUS_HULL);
        s.geometry.type = draw(&seed) % 8u ? s.geometry.type : TALUS_HULL;
        s.filter.category = 1u + draw(&seed) % 8u, s.filter.group = (int32_t)(draw(&seed) % 5u) - 2;
        s.sensor = draw(&seed) % 8u == 0u;
        kit_shape(&world, body, &s);
    }
    return world;
}

static void meddle(talus_world *world, uint32_t *seed) {
    const tl_header *h = tl_header_of(world);
    uint32_t i = 1u + draw(seed) % (h->bodies.high - 1u);
    talus_body body = {i, tl_bodies(h)[i].generation};
    talus_vec3 v = kit_vec(draw_float(seed, -40.0f, 40.0f), 0.0f, draw_float(seed, -40.0f, 40.0f));
    talus_pose pose = kit_pose(0.1f * v.x, 2.0f, 0.1f * v.z);
    talus_shape_def ball = kit_ball_def(0.4f);
    talus_shape shape = {draw(seed) % h->shapes.high, 0};
    shape.generation = tl_shapes(h)[shape.index].generation;
    switch (draw(seed) % 8u) {
    case 0:
        (void)talus_body_set_pose(world, body, &pose);
        break;
    case 1:
        (void)talus_body_set_velocity(world, body, v, v);
        break;
    case 2:
        (void)talus_body_sleep(world, body);
        break;
    case 3:
        (void)talus_shape_create(world, body, &ball, &shape);
        break;
    case 4:
        (void)talus_shape_destroy(world, shape);
        break;
    default:
        break;
    }
}

static void as_all_shapes(void **state) {
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    uint32_t first = setting("TALUS_SEED", 1), worlds = setting("TALUS_WORLDS", 12), left = 0;
    (void)state;
    printf("%u worlds from seed %u (TALUS_WORLDS, TALUS_SEED)\n", worlds, first);
    query_draw d = {first, 0, 0};
    for (uint32_t w = 0; w < worlds; w++) {
        talus_world world = restless(first + w + 1u, hull, hull_bytes, w % 3u ? 400u : 24u);
        uint32_t seed = first + w + 1u;
        for (uint32_t step = 0; step < 60; step++) {
            uint64_t before = talus_world_hash(&world);
            kit_queries(&world, &d, 1);
            assert_true(before == talus_world_hash(&world));
            check_store(&world);
            meddle(&world, &seed);
            if (step % 4u == 1u) {
                kit_queries(&world, &d, 1); /* between a call and the next step */
            }
            OK(talus_world_step(&world, step % 7u ? 1.0f / 60.0f : 0.1f, NULL, NULL));
            left += tl_header_of(&world)->moved_shapes;
        }
        kit_end(&world);
    }
    printf("%u queries found something; %u times a step left a fat box\n", d.found, left);
    assert_true(d.found > 100u * worlds && left > 10u * worlds);
    kit_free(hull);
}

/* A world, one that its snapshot was restored into after it went elsewhere, and a new one: the same answers, at once
 * and after more steps. */
static void as_restored(void **state) {
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    (void)state;
    for (uint32_t w = 0; w < 6; w++) {
        talus_world one = restless(w + 1u, hull, hull_bytes, w % 2u ? 400u : 24u);
        talus_world two = restless(w + 1u, hull, hull_bytes, w % 2u ? 400u : 24u);
        talus_world three = restless(w + 9u, hull, hull_bytes, w % 2u ? 400u : 24u);
        kit_steps(&one, 40);
        kit_steps(&two, 44);
        kit_steps(&three, 7);
        for (uint32_t k = 0; k < 6; k++) {
            size_t room = talus_world_save_size(&one), bytes;
            void *snapshot = kit_alloc(room);
            OK(talus_world_save(&one, snapshot, room, &bytes));
            OK(talus_world_restore(&two, snapshot, bytes));
            OK(talus_world_restore(&three, snapshot, bytes));
            kit_free(snapshot);
            for (int step = 0; step < 3; step++) {
                query_draw a = {k + 1u, 0, 0}, b = a, c = a;
                for (int i = 0; i < 4; i++) {
                    kit_queries(&one, &a, 0);
                    kit_queries(&two, &b, 1);
                    kit_queries(&three, &c, i == 0);
                }
                assert_true(a.hash == b.hash && a.hash == c.hash);
                check_store(&two);
                check_store(&three);
                kit_steps(&one, 1);
                kit_steps(&two, 1);
                kit_steps(&three, 1);
            }
            kit_steps(&two, 3);
        }
        kit_end(&one);
        kit_end(&two);
        kit_end(&three);
    }
    kit_free(hull);
}

static void as_by_other_instructions(void **state) {
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    uint64_t hash = 0;
    (void)state;
    for (int isa = TALUS_ISA_SCALAR; isa < TALUS_ISA_COUNT; isa++) {
        if (!talus_isa_available((talus_isa)isa)) {
            continue;
        }
        talus_world world = restless(5u, hull, hull_bytes, 400u);
        OK(talus_world_set_isa(&world, (talus_isa)isa));
        query_draw d = {17u, 0, 0};
        for (int i = 0; i < 30; i++) {
            kit_steps(&world, 2);
            kit_queries(&world, &d, 0);
        }
        assert_true(hash == 0 || hash == d.hash);
        hash = d.hash;
        kit_end(&world);
    }
    kit_free(hull);
}

/* Balls in one another from a micrometre up, each a little larger than the one before: the tree is a chain, and higher
 * than what a walk remembers. */
static void as_all_of_a_high_tree(void **state) {
    talus_world_def def = kit_small();
    def.shape_capacity = 100;
    talus_world world = kit_world(&def);
    float radius = 2e-6f;
    (void)state;
    for (int i = 0; i < 90; i++) {
        talus_shape_def ball = kit_ball_def(radius);
        ball.filter.category = i & 1 ? 1u : 6u;
        kit_shape(&world, talus_world_ground(&world), &ball);
        radius *= 1.3f;
    }
    kit_steps(&world, 1);
    const tl_header *h = tl_header_of(&world);
    print_message("height %u\n", (unsigned)tl_nodes(h)[h->root[TL_TREE_STILL]].height);
    assert_true(tl_nodes(h)[h->root[TL_TREE_STILL]].height > 64u);
    query_draw d = {5u, 0, 0};
    for (int i = 0; i < 200; i++) {
        kit_queries(&world, &d, 1);
    }
    kit_end(&world);
}

/* --- casts against many moments -------------------------------------------------------------------- */

/* No moment before a cast's answer has an overlap, and at the answer the gap is the tolerance. */
static void cast_stops_in_time(void **state) {
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    talus_world world = restless(3u, hull, hull_bytes, 400u);
    query_draw d = {77u, 0, 0};
    uint32_t hits = 0;
    (void)state;
    kit_steps(&world, 30);
    for (int i = 0; i < 150; i++) {
        query_case c = query_any(&d, &world, QUERY_CAST);
        c.motion.rotation = kit_vec(0.0f, 0.0f, 0.0f); /* poses in between are then sums */
        c.motion.center = kit_vec(0.0f, 0.0f, 0.0f);
        talus_query_hit hit, near;
        OK(talus_world_cast(&world, &c.shape, &c.motion, c.tolerance, NULL, &hit));
        double end = hit.shape.generation ? hit.at : 1.0;
        for (int k = 0; k <= 100; k++) {
            float t = (float)(end * (double)k / 100.0);
            talus_pose pose = c.motion.pose;
            pose.position.x += t * c.motion.translation.x, pose.position.y += t * c.motion.translation.y;
            pose.position.z += t * c.motion.translation.z;
            OK(talus_world_closest(&world, &c.shape, &pose, 1.0f, NULL, &near));
            if (hit.within) {
                assert_true(near.shape.generation && near.at <= (double)c.tolerance * 1.001 + 1e-4);
            } else if (k == 100 && hit.shape.generation) {
                NEAR(near.at, 0.5 * (double)c.tolerance, 0.51 * (double)c.tolerance + 1e-5);
                hits++;
            } else {
                assert_true(!near.within);
            }
        }
    }
    assert_true(hits > 30u);
    kit_end(&world);
    kit_free(hull);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays),
        cmocka_unit_test(filters),
        cmocka_unit_test(casts),
        cmocka_unit_test(near_and_within),
        cmocka_unit_test(refused),
        cmocka_unit_test(seen_at_once),
        cmocka_unit_test(as_all_shapes),
        cmocka_unit_test(as_restored),
        cmocka_unit_test(as_by_other_instructions),
        cmocka_unit_test(as_all_of_a_high_tree),
        cmocka_unit_test(cast_stops_in_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
