/* Pairs whose answer is known in closed form: separation, normal, number and place of the points, and that points keep
 * their numbers while shapes move a little. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide/feature.h"
#include "collide_brute.h"

static tl_convex sphere(float r) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = TALUS_SPHERE;
    s.geometry.radius = r;
    return s;
}

static tl_convex column(talus_shape_type type, float h, float bottom, float top) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = type;
    s.geometry.half_height = h;
    s.geometry.radius_bottom = bottom;
    s.geometry.radius_top = top;
    return s;
}

static tl_convex box(float x, float y, float z) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = TALUS_BOX;
    s.geometry.half = tl_v(x, y, z);
    return s;
}

static tl_convex hull_of(const talus_vec3 *points, uint32_t count) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = TALUS_HULL;
    s.hull = brute_hull_of(points, count);
    return s;
}

static tl_convex hull_box(float x, float y, float z) {
    talus_vec3 p[8];
    for (uint32_t i = 0; i < 8; ++i) {
        p[i] = tl_v((i & 1u) ? x : -x, (i & 2u) ? y : -y, (i & 4u) ? z : -z);
    }
    return hull_of(p, 8);
}

static talus_pose at(float x, float y, float z) {
    talus_pose p = tl_pose_identity();
    p.position = tl_v(x, y, z);
    return p;
}

static talus_pose turned(talus_pose p, float ax, float ay, float az, double angle) {
    float s = (float)sin(0.5 * angle), c = (float)cos(0.5 * angle);
    talus_quat q = {ax * s, ay * s, az * s, c};
    p.rotation = tl_quat_normalize(tl_quat_mul(q, p.rotation));
    return p;
}

static tl_manifold run(const tl_convex *a, const tl_convex *b, talus_pose pose, float margin) {
    tl_manifold m, mirrored;
    tl_pair_cache cache = {{0, 0, 0, 0}}, other = {{0, 0, 0, 0}};
    talus_pose identity = tl_pose_identity(), back = tl_pose_relative(&pose, &identity);
    tl_collide(a, b, &pose, margin, &cache, &m);
    tl_collide(b, a, &back, margin, &other, &mirrored);
    assert_int_equal(m.count, mirrored.count);
    return m;
}

static void is_near(float value, double expected, double tolerance) {
    if (!(fabs((double)value - expected) <= tolerance)) {
        print_error("%.9g, expected %.9g\n", (double)value, expected);
    }
    assert_true(fabs((double)value - expected) <= tolerance);
}

static void is_along(talus_vec3 n, float x, float y, float z) {
    talus_vec3 e = tl_normalize_or(tl_v(x, y, z), n);
    if (!(tl_length(tl_sub(n, e)) < 1e-4f)) {
        print_error("normal %g %g %g, expected %g %g %g\n", (double)n.x, (double)n.y, (double)n.z, (double)e.x,
                    (double)e.y, (double)e.z);
    }
    assert_true(tl_length(tl_sub(n, e)) < 1e-4f);
}

static void all_at(const tl_manifold *m, uint32_t count, double separation, double tolerance) {
    assert_int_equal(m->count, count);
    for (uint32_t i = 0; i < count; ++i) {
        is_near(m->point[i].separation, separation, tolerance);
    }
}

/* Whether some point lies at x, z. */
static void has_point(const tl_manifold *m, float x, float z, float tolerance) {
    for (uint32_t i = 0; i < m->count; ++i) {
        if (tl_abs(m->point[i].position.x - x) < tolerance && tl_abs(m->point[i].position.z - z) < tolerance) {
            return;
        }
    }
    print_error("no point at %g %g of:\n", (double)x, (double)z);
    for (uint32_t i = 0; i < m->count; ++i) {
        talus_vec3 p = m->point[i].position;
        print_error("  %g %g %g  %x\n", (double)p.x, (double)p.y, (double)p.z, m->point[i].id);
    }
    fail();
}

static void balls(void **state) {
    (void)state;
    tl_convex a = sphere(1.0f), b = sphere(0.5f);
    tl_manifold m = run(&a, &b, at(0.0f, 1.4f, 0.0f), 0.0f);
    all_at(&m, 1, -0.1, 1e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
    is_near(m.point[0].position.y, 0.95, 1e-6);
    m = run(&a, &b, at(3.0f, 0.0f, 4.0f), 3.5f);
    all_at(&m, 1, 3.5, 1e-5);
    m = run(&a, &b, at(3.0f, 0.0f, 4.0f), 3.4f);
    assert_int_equal(m.count, 0);
    m = run(&a, &b, at(0.0f, 0.0f, 0.0f), 0.0f);
    all_at(&m, 1, -1.5, 1e-6);
}

static void ball_on_each(void **state) {
    (void)state;
    talus_vec3 tip[4] = {{1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 1.0f}, {-1.0f, 0.0f, -1.0f}, {0.0f, 2.0f, 0.0f}};
    tl_convex b = sphere(0.5f), shapes[6] = {box(1.0f, 2.0f, 1.0f),
                                             column(TALUS_CAPSULE, 1.5f, 0.5f, 0.5f),
                                             column(TALUS_CAPSULE, 1.5f, 0.9f, 0.5f),
                                             column(TALUS_CYLINDER, 2.0f, 1.0f, 1.0f),
                                             column(TALUS_CYLINDER, 2.0f, 1.0f, 0.0f),
                                             hull_of(tip, 4)};
    for (int i = 0; i < 6; ++i) {
        tl_manifold m = run(&shapes[i], &b, at(0.0f, 2.6f, 0.0f), 0.2f);
        all_at(&m, 1, 0.1, 2e-6);
        is_along(m.normal, 0.0f, 1.0f, 0.0f);
        is_near(m.point[0].position.y, 2.05, 2e-6);
    }
    /* beside a corner of the box */
    tl_manifold m = run(&shapes[0], &b, at(1.3f, 2.4f, 1.0f), 0.1f);
    all_at(&m, 1, 0.0, 2e-6);
    is_along(m.normal, 0.3f, 0.4f, 0.0f);
    /* beside the rim of the cylinder */
    m = run(&shapes[3], &b, at(1.4f, 2.3f, 0.0f), 0.1f);
    all_at(&m, 1, 0.0, 2e-6);
    is_along(m.normal, 0.4f, 0.3f, 0.0f);
    /* inside, nearest to the side */
    m = run(&shapes[3], &b, at(0.0f, 0.5f, -0.9f), 0.1f);
    all_at(&m, 1, -0.6, 2e-6);
    is_along(m.normal, 0.0f, 0.0f, -1.0f);
    /* the sloping side of the taper: sine (0.9 - 0.5) / 3 */
    float sine = 0.4f / 3.0f, cosine = sqrtf(1.0f - sine * sine);
    m = run(&shapes[2], &b, at(1.2f * cosine, 1.2f * sine, 0.0f), 0.1f);
    all_at(&m, 1, 1.2 - 0.7 - 0.5, 2e-6);
    is_along(m.normal, cosine, sine, 0.0f);
}

static void capsules(void **state) {
    (void)state;
    tl_convex a = column(TALUS_CAPSULE, 1.0f, 0.5f, 0.5f), b = column(TALUS_CAPSULE, 2.0f, 0.25f, 0.25f);
    tl_manifold m = run(&a, &b, at(0.7f, 0.5f, 0.0f), 0.0f);
    all_at(&m, 2, -0.05, 1e-6);
    is_along(m.normal, 1.0f, 0.0f, 0.0f);
    is_near(m.point[0].position.y * m.point[1].position.y, -1.0, 1e-5);
    m = run(&a, &b, turned(at(0.7f, 0.0f, 0.0f), 1.0f, 0.0f, 0.0f, 1.0), 0.0f);
    all_at(&m, 1, -0.05, 1e-6);
    is_along(m.normal, 1.0f, 0.0f, 0.0f);
    m = run(&a, &b, at(0.0f, 3.7f, 0.0f), 0.0f);
    all_at(&m, 1, -0.05, 1e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
    m = run(&a, &b, turned(at(0.0f, 0.0f, 0.0f), 1.0f, 0.0f, 0.0f, 1.0), 0.0f);
    all_at(&m, 1, -0.75, 1e-6);
    is_near(m.normal.y, 0.0, 1e-5);
    m = run(&a, &b, at(0.0f, 0.5f, 0.0f), 0.0f);
    is_near(m.point[0].separation, -0.75, 1e-6);
}

static void boxes_at_rest(const tl_convex *a, const tl_convex *b) {
    tl_manifold m = run(a, b, at(0.25f, 1.495f, -0.25f), 0.02f);
    all_at(&m, 4, -0.005, 1e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
    has_point(&m, 0.75f, 0.25f, 1e-5f);
    has_point(&m, -0.25f, 0.25f, 1e-5f);
    has_point(&m, 0.75f, -0.75f, 1e-5f);
    has_point(&m, -0.25f, -0.75f, 1e-5f);
    /* hanging over the side: two corners of one, two crossings or corners */
    m = run(a, b, at(0.8f, 1.495f, 0.0f), 0.02f);
    all_at(&m, 4, -0.005, 1e-6);
    has_point(&m, 0.3f, 0.5f, 1e-3f);
    has_point(&m, 1.0f, 0.5f, 1e-2f);
    /* standing on an edge */
    m = run(a, b, turned(at(0.0f, 1.7f, 0.0f), 0.0f, 0.0f, 1.0f, 0.78539816339744831), 0.02f);
    all_at(&m, 2, 1.7 - 1.0 - 0.70710678, 2e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
    /* edge across edge */
    m = run(a, b, turned(turned(at(1.7f, 1.0f, 0.0f), 0.0f, 0.0f, 1.0f, 0.78539816339744831), 1.0f, 0.0f, 0.0f, 0.7),
            0.1f);
    assert_true(m.count >= 1);
}

static void boxes(void **state) {
    (void)state;
    tl_convex a = box(1.0f, 1.0f, 1.0f), b = box(0.5f, 0.5f, 0.5f);
    tl_convex ha = hull_box(1.0f, 1.0f, 1.0f), hb = hull_box(0.5f, 0.5f, 0.5f);
    boxes_at_rest(&a, &b);
    boxes_at_rest(&ha, &b);
    boxes_at_rest(&a, &hb);
    boxes_at_rest(&ha, &hb);
    /* corner to corner, apart along (1, 1, 1) */
    tl_manifold m = run(&a, &b, at(1.6f, 1.6f, 1.6f), 1.0f);
    is_near(m.point[0].separation, 0.1 * sqrt(3.0), 1e-5);
    is_along(m.normal, 1.0f, 1.0f, 1.0f);
    m = run(&ha, &hb, at(1.6f, 1.6f, 1.6f), 1.0f);
    is_near(m.point[0].separation, 0.1 * sqrt(3.0), 1e-5);
    is_along(m.normal, 1.0f, 1.0f, 1.0f);
    /* edge to edge, apart along (1, 1, 0): two points */
    m = run(&a, &b, at(1.6f, 1.6f, 0.0f), 1.0f);
    all_at(&m, 2, 0.1 * sqrt(2.0), 1e-5);
    is_along(m.normal, 1.0f, 1.0f, 0.0f);
    m = run(&ha, &hb, at(1.6f, 1.6f, 0.0f), 1.0f);
    all_at(&m, 2, 0.1 * sqrt(2.0), 1e-5);
    /* one in the other */
    m = run(&a, &b, at(0.0f, 0.1f, 0.0f), 0.0f);
    is_near(m.point[0].separation, -1.4, 1e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
}

static void lying(void **state) {
    (void)state;
    tl_convex ground = box(10.0f, 0.5f, 10.0f), hull = hull_box(10.0f, 0.5f, 10.0f);
    const tl_convex *grounds[2] = {&ground, &hull};
    tl_convex things[3] = {column(TALUS_CAPSULE, 1.0f, 0.5f, 0.5f), column(TALUS_CYLINDER, 1.0f, 0.5f, 0.5f),
                           column(TALUS_CAPSULE, 1.0f, 0.50001f, 0.5f)};
    for (int i = 0; i < 6; ++i) {
        const tl_convex *thing = &things[i / 2];
        talus_pose p =
            turned(turned(at(3.0f, 0.99f, 2.0f), 0.0f, 0.0f, 1.0f, 1.5707963267948966), 0.0f, 1.0f, 0.0f, 0.3);
        tl_manifold m = run(grounds[i & 1], thing, p, 0.02f);
        all_at(&m, 2, -0.01, 2e-5);
        is_along(m.normal, 0.0f, 1.0f, 0.0f);
    }
    /* on end: the disc's eight corners give four */
    tl_manifold m = run(&ground, &things[1], at(3.0f, 1.49f, 2.0f), 0.02f);
    all_at(&m, 4, -0.01, 2e-6);
    talus_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 4; ++i) {
        sum = tl_add(sum, m.point[i].position);
        talus_vec3 d = tl_sub(m.point[i].position, tl_v(3.0f, 0.495f, 2.0f));
        is_near(tl_length(d), 0.5, 1e-5);
    }
    is_near(sum.x, 12.0, 1e-4);
    is_near(sum.z, 8.0, 1e-4);
    /* a cone on its tip, and tilted on its rim */
    tl_convex cone = column(TALUS_CYLINDER, 1.0f, 0.0f, 0.5f);
    m = run(&ground, &cone, at(3.0f, 1.49f, 2.0f), 0.02f);
    all_at(&m, 1, -0.01, 2e-6);
    has_point(&m, 3.0f, 2.0f, 1e-4f);
    double low = 0.5 * sin(0.3) + cos(0.3);
    m = run(&ground, &things[1], turned(at(0.0f, (float)(0.5 + low - 0.01), 0.0f), 0.0f, 0.0f, 1.0f, 0.3), 0.02f);
    is_near(m.point[0].separation, -0.01, 1e-5);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
}

/* Resting pairs nudged about: the numbers stay. */
static void steady(const tl_convex *a, const tl_convex *b, talus_pose rest, uint32_t count) {
    tl_pair_cache cache = {{0, 0, 0, 0}};
    tl_manifold first, m;
    tl_collide(a, b, &rest, 0.02f, &cache, &first);
    assert_int_equal(first.count, count);
    for (int i = 0; i < 200; ++i) {
        talus_pose p = rest;
        talus_vec3 move = brute_vector(-1e-4f, 1e-4f), axis = brute_direction();
        p.position = tl_add(p.position, tl_v(move.x, 0.1f * move.y, move.z));
        p = turned(p, axis.x, axis.y, axis.z, 1e-5);
        tl_collide(a, b, &p, 0.02f, &cache, &m);
        assert_int_equal(m.count, count);
        for (uint32_t k = 0; k < count; ++k) {
            uint32_t found = 0;
            for (uint32_t j = 0; j < count; ++j) {
                found += m.point[j].id == first.point[k].id;
            }
            assert_int_equal(found, 1);
        }
    }
}

/* A prism of six corners, a metre wide. */
static tl_convex prism(void) {
    talus_vec3 points[12];
    for (int i = 0; i < 12; ++i) {
        double angle = (i / 2) * 1.0471975511965976;
        points[i] = tl_v((float)(0.5 * cos(angle)), i & 1 ? 0.25f : -0.25f, (float)(0.5 * sin(angle)));
    }
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = TALUS_HULL;
    s.hull = brute_hull_of(points, 12);
    return s;
}

/* Of the twelve points of two prisms that lie on each other, turned a little, those of before are taken again while
 * they say as much, whatever way the upper one is tilted by less than the slack; else others. */
static void points_stay(void **state) {
    (void)state;
    tl_convex a = prism(), b = prism();
    tl_pair_cache cache = {{0, 0, 0, 0}};
    tl_manifold m;
    talus_pose rest = turned(at(0.0f, 0.499f, 0.0f), 0.0f, 1.0f, 0.0f, 0.3);
    tl_collide(&a, &b, &rest, 0.02f, &cache, &m);
    assert_int_equal(m.count, 4);
    assert_int_equal(m.others, 8);
    uint32_t id[4], changed = 0;
    for (int i = 0; i < 4; ++i) {
        id[i] = m.point[i].id;
    }
    for (int i = 0; i < 400; ++i) {
        talus_vec3 axis = brute_direction();
        talus_pose p = turned(rest, axis.x, axis.y, axis.z, i < 200 ? 1e-4 : 1e-2);
        tl_collide(&a, &b, &p, 0.02f, &cache, &m);
        float least = tl_manifold_least(&m);
        int stays = tl_manifold_stay(&m, id, 4);
        assert_true(stays || i >= 200);
        changed += !stays;
        for (int k = 0; k < 4 && stays; ++k) {
            assert_int_equal(m.point[k].id, id[k]);
        }
        assert_true(tl_manifold_least(&m) <= least + 3e-4f);
    }
    assert_true(changed > 50);
    id[2] ^= 1u; /* one that is not there */
    tl_collide(&a, &b, &rest, 0.02f, &cache, &m);
    assert_int_equal(tl_manifold_stay(&m, id, 4), 0);
}

static void numbers_stay(void **state) {
    (void)state;
    tl_convex a = box(1.0f, 1.0f, 1.0f), b = box(0.5f, 0.5f, 0.5f), ground = box(50.0f, 1.0f, 50.0f);
    tl_convex ha = hull_box(1.0f, 1.0f, 1.0f), hb = hull_box(0.5f, 0.5f, 0.5f);
    tl_convex capsule = column(TALUS_CAPSULE, 1.0f, 0.5f, 0.5f), cylinder = column(TALUS_CYLINDER, 1.0f, 0.5f, 0.5f);
    steady(&ground, &b, at(7.0f, 1.499f, -3.0f), 4);
    steady(&ground, &hb, at(7.0f, 1.499f, -3.0f), 4);
    steady(&a, &a, at(0.0f, 1.999f, 0.0f), 4);
    steady(&ha, &ha, at(0.0f, 1.999f, 0.0f), 4);
    steady(&a, &ha, at(0.0f, 1.999f, 0.0f), 4);
    steady(&a, &a, at(0.7f, 1.999f, 0.3f), 4);
    steady(&ha, &hb, at(0.7f, 1.499f, 0.3f), 4);
    steady(&a, &a, turned(at(0.0f, 1.999f, 0.0f), 0.0f, 1.0f, 0.0f, 0.6), 4);
    steady(&ha, &ha, turned(at(0.0f, 1.999f, 0.0f), 0.0f, 1.0f, 0.0f, 0.6), 4);
    talus_pose lie = turned(at(0.0f, 1.499f, 0.0f), 0.0f, 0.0f, 1.0f, 1.5707963267948966);
    steady(&ground, &capsule, lie, 2);
    steady(&ground, &cylinder, lie, 2);
    steady(&ground, &cylinder, at(0.0f, 1.999f, 0.0f), 4);
    steady(&capsule, &capsule, turned(at(0.999f, 0.3f, 0.0f), 0.0f, 1.0f, 0.0f, 0.4), 2);
}

static void numbers(void **state) {
    (void)state;
    /* sizes from one end to the other */
    float sizes[4] = {1e-3f, 0.1f, 10.0f, 1e3f};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            tl_convex a = box(sizes[i], sizes[i], sizes[i]), b = box(sizes[j], sizes[j], sizes[j]);
            tl_convex ha = hull_box(sizes[i], sizes[i], sizes[i]), hb = hull_box(sizes[j], sizes[j], sizes[j]);
            float small = sizes[i] < sizes[j] ? sizes[i] : sizes[j];
            talus_pose p = at(0.0f, sizes[i] + 0.9f * sizes[j], 0.0f);
            double depth = -((double)sizes[i] + (double)sizes[j] - (double)p.position.y);
            tl_manifold m = run(&a, &b, p, 0.0f);
            all_at(&m, 4, depth, 1e-5 * (double)small + 1e-6 * fabs(depth) + 1e-7 * (double)p.position.y);
            m = run(&ha, &hb, p, 0.0f);
            all_at(&m, 4, depth, 1e-5 * (double)small + 1e-6 * fabs(depth) + 1e-7 * (double)p.position.y);
        }
    }
    /* planks of 1000 to 1 */
    tl_convex a = box(10.0f, 0.01f, 0.01f);
    tl_manifold m = run(&a, &a, turned(at(3.0f, 0.019f, 2.0f), 0.0f, 1.0f, 0.0f, 1.5707963267948966), 0.01f);
    all_at(&m, 4, -0.001, 2e-6);
    is_along(m.normal, 0.0f, 1.0f, 0.0f);
}

static void boxes_around(void **state) {
    (void)state;
    brute_state = 11;
    for (int i = 0; i < 400; ++i) {
        tl_convex s = brute_shape(i % BRUTE_KINDS, 0.1f, 2.0f);
        talus_pose p = brute_pose(3.0f, 3.0f);
        talus_aabb box_around = tl_convex_aabb(&s, &p);
        d_pose pose = d_pose_of(&p);
        double low[3] = {(double)box_around.lower.x, (double)box_around.lower.y, (double)box_around.lower.z};
        double high[3] = {(double)box_around.upper.x, (double)box_around.upper.y, (double)box_around.upper.z};
        double center[3] = {(double)p.position.x, (double)p.position.y, (double)p.position.z};
        for (int axis = 0; axis < 3; ++axis) {
            d3 n = d3_make(axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0);
            double up = center[axis] + d_reach(&s, d_rotate_back(&pose, n));
            double down = center[axis] - d_reach(&s, d_rotate_back(&pose, d3_scale(n, -1.0)));
            assert_true(fabs(up - high[axis]) < 5e-6 && fabs(down - low[axis]) < 5e-6);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls),       cmocka_unit_test(ball_on_each), cmocka_unit_test(capsules),
        cmocka_unit_test(boxes),       cmocka_unit_test(lying),        cmocka_unit_test(numbers_stay),
        cmocka_unit_test(points_stay), cmocka_unit_test(numbers),      cmocka_unit_test(boxes_around),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
