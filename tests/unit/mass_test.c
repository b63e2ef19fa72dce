/* Masses of shapes against integration of their definition in double (Simpson's rule in slices across y), of compounds
 * against the whole they make up, of hulls against boxes and spheres. Units: SI. */
#include "base/vec.h"
#include "geom/mass.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the four above. */
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define SLICES 200 /* even */

typedef struct reference {
    double mass, y, along, across;
} reference;

/* Half the chord across the axis at height y: of the hull of two balls, the largest of the balls between the two that
 * are spanned by the segment (the hull is their union). */
static double capsule_radius(const talus_geometry *g, double y) {
    double h = (double)g->half_height, a = (double)g->radius_bottom, b = (double)g->radius_top;
    /* r(t)^2 - (y - c(t))^2 with r and c linear in t in [-1, 1] is a parabola. */
    double rm = 0.5 * (a + b), rk = 0.5 * (b - a);
    double p2 = rk * rk - h * h, p1 = 2.0 * (rm * rk + h * y), p0 = rm * rm - y * y;
    double best = fmax(p2 + p1 + p0, p2 - p1 + p0);
    if (p2 < 0.0) {
        double t = -p1 / (2.0 * p2);
        if (t > -1.0 && t < 1.0) {
            best = fmax(best, p0 + p1 * t + p2 * t * t);
        }
    }
    return best > 0.0 ? sqrt(best) : 0.0;
}

static double cone_radius(const talus_geometry *g, double y) {
    double t = 0.5 * (1.0 + y / (double)g->half_height);
    return (double)g->radius_bottom * (1.0 - t) + (double)g->radius_top * t;
}

typedef double profile(const talus_geometry *g, double y);

/* Simpson's rule over [low, high], in which the profile is smooth. */
static void add_span(const talus_geometry *g, profile *radius, double low, double high, double sum[4]) {
    double step = (high - low) / SLICES;
    for (int i = 0; i <= SLICES && high > low; ++i) {
        double y = low + step * i, r = radius(g, y), r2 = r * r;
        double w = PI * step / 3.0 * (i == 0 || i == SLICES ? 1.0 : i % 2 ? 4.0 : 2.0);
        sum[0] += w * r2;
        sum[1] += w * r2 * y;
        sum[2] += w * r2 * r2 * 0.5;
        sum[3] += w * r2 * (0.25 * r2 + y * y);
    }
}

static reference integrate(const talus_geometry *g, double density) {
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    double h = (double)g->half_height;
    if (g->type == TALUS_CYLINDER) {
        add_span(g, cone_radius, -h, h, sum);
    } else {
        double a = (double)g->radius_bottom, b = (double)g->radius_top;
        double low = fmin(-h - a, h - b), high = fmax(h + b, a - h);
        double sine = 2.0 * h > fabs(a - b) ? (a - b) / (2.0 * h) : 0.0;
        double cut[4] = {low, fmin(fmax(a * sine - h, low), high), fmin(fmax(b * sine + h, low), high), high};
        for (int i = 0; i < 3; ++i) {
            add_span(g, capsule_radius, cut[i], cut[i + 1], sum);
        }
    }
    reference r = {density * sum[0], sum[1] / sum[0], density * sum[2], 0.0};
    r.across = density * (sum[3] - sum[1] * r.y);
    return r;
}

static void near(double got, double want, double scale, double tolerance) {
    if (!(fabs(got - want) <= tolerance * fabs(scale))) {
        print_message("got %.9g, want %.9g\n", got, want);
        fail();
    }
}

static talus_geometry geometry(talus_shape_type type, float h, float bottom, float top) {
    talus_geometry g;
    memset(&g, 0, sizeof g);
    g.type = type, g.radius = bottom, g.half_height = h, g.radius_bottom = bottom, g.radius_top = top;
    return g;
}

static talus_mass mass_of(const talus_geometry *g, float density) {
    talus_mass m;
    assert_int_equal(talus_geometry_mass(g, NULL, 0u, density, &m), TALUS_OK);
    return m;
}

static void check_revolved(int type, float h, float bottom, float top) {
    talus_geometry g = geometry((talus_shape_type)type, h, bottom, top);
    reference r = integrate(&g, 3.0);
    talus_mass m = mass_of(&g, 3.0f);
    double extent = (double)h + (double)(bottom > top ? bottom : top);
    near((double)m.mass, r.mass, r.mass, 1e-6);
    near((double)m.center.y, r.y, extent, 1e-6);
    near((double)m.inertia.y.y, r.along, r.along, 1e-6);
    near((double)m.inertia.x.x, r.across, r.across, 1e-6);
    assert_true(m.inertia.x.x == m.inertia.z.z && m.center.x == 0.0f && m.center.z == 0.0f);
}

static void test_revolved(void **unused) {
    (void)unused;
    /* Not thinner than 1 : 1000, where the reference loses its digits. */
    static const float size[] = {0.01f, 0.3f, 0.5f, 0.99f, 1.0f, 7.0f, 10.0f};
    const size_t n = sizeof size / sizeof size[0];
    for (float scale = 1e-4f; scale < 2e5f; scale *= 1e3f) {
        for (size_t i = 0u; i < n * n * n; ++i) {
            float h = scale * size[i % n], a = scale * size[i / n % n], b = scale * size[i / n / n];
            check_revolved(TALUS_CAPSULE, h, a, b);
            check_revolved(TALUS_CYLINDER, h, a, b);
            check_revolved(TALUS_CYLINDER, h, a, 0.0f);
        }
    }
    /* A rod: the ends are lost in it. */
    talus_geometry g = geometry(TALUS_CAPSULE, 1e6f, 1e-6f, 1e-6f);
    talus_mass m = mass_of(&g, 1e6f);
    near((double)m.mass, PI * 2.0, PI * 2.0, 1e-6);
    near((double)m.inertia.x.x, (double)m.mass * 1e12 / 3.0, (double)m.inertia.x.x, 1e-6);
    near((double)m.inertia.y.y, (double)m.mass * 0.5e-12, (double)m.inertia.y.y, 1e-6);
}

static void test_known(void **unused) {
    (void)unused;
    talus_geometry g = geometry(TALUS_SPHERE, 0.0f, 2.0f, 0.0f);
    talus_mass m = mass_of(&g, 1000.0f);
    near((double)m.mass, 1000.0 * PI * 32.0 / 3.0, (double)m.mass, 1e-7);
    near((double)m.inertia.z.z, 0.4 * 4.0 * (double)m.mass, (double)m.inertia.z.z, 1e-6);
    g = geometry(TALUS_CAPSULE, 0.0f, 2.0f, 2.0f);
    talus_mass ball = mass_of(&g, 1000.0f);
    near((double)ball.mass, (double)m.mass, (double)m.mass, 2e-7);
    near((double)ball.inertia.x.x, (double)m.inertia.x.x, (double)m.inertia.x.x, 2e-7);
    /* One ball within the other: the larger one, where it is. */
    g = geometry(TALUS_CAPSULE, 0.5f, 2.0f, 1.0f);
    ball = mass_of(&g, 1000.0f);
    near((double)ball.mass, (double)m.mass, (double)m.mass, 2e-7);
    assert_true(ball.center.y == -0.5f);
    memset(&g, 0, sizeof g);
    g.type = TALUS_BOX;
    g.half.x = 0.5f, g.half.y = 1.0f, g.half.z = 1.5f;
    m = mass_of(&g, 2.0f);
    assert_true(m.mass == 12.0f && m.inertia.x.x == 13.0f && m.inertia.y.y == 10.0f && m.inertia.z.z == 5.0f);
    m = mass_of(&g, 0.0f);
    assert_true(m.mass == 0.0f && m.inertia.x.x == 0.0f);
    /* A cone: 3/10 m r^2 about the axis, 3/80 m (4 r^2 + H^2) across it, centre a quarter up. */
    g = geometry(TALUS_CYLINDER, 2.0f, 3.0f, 0.0f);
    m = mass_of(&g, 1.0f);
    near((double)m.mass, PI * 12.0, (double)m.mass, 1e-7);
    near((double)m.center.y, -1.0, 1.0, 1e-7);
    near((double)m.inertia.y.y, 0.3 * 9.0 * PI * 12.0, (double)m.inertia.y.y, 1e-7);
    near((double)m.inertia.x.x, 3.0 / 80.0 * 52.0 * PI * 12.0, (double)m.inertia.x.x, 1e-7);
}

static void expect(const talus_geometry *g, talus_status status) {
    talus_mass m, before;
    memset(&m, 0x5a, sizeof m);
    before = m;
    assert_int_equal(talus_geometry_mass(g, NULL, 0u, 1.0f, &m), status);
    assert_memory_equal(&m, &before, sizeof m);
}

static void test_refused(void **unused) {
    (void)unused;
    talus_mass m;
    talus_geometry g = geometry(TALUS_SPHERE, 0.0f, 1.0f, 0.0f);
    assert_int_equal(talus_geometry_mass(NULL, NULL, 0u, 1.0f, &m), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 1.0f, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, -1.0f, &m), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, (float)NAN, &m), TALUS_NOT_FINITE);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, (float)INFINITY, &m), TALUS_NOT_FINITE);
    g.radius = (float)NAN;
    expect(&g, TALUS_NOT_FINITE);
    g.radius = -1.0f;
    expect(&g, TALUS_BAD_SHAPE);
    g.radius = 0.9e-6f;
    expect(&g, TALUS_BAD_SHAPE);
    g.radius = 1.1e6f;
    expect(&g, TALUS_BAD_SHAPE);
    g.type = TALUS_SHAPE_TYPE_COUNT;
    expect(&g, TALUS_BAD_SHAPE);
    g = geometry(TALUS_CYLINDER, 1.0f, 0.0f, 0.0f);
    expect(&g, TALUS_BAD_SHAPE);
    g = geometry(TALUS_CYLINDER, 0.0f, 1.0f, 1.0f);
    expect(&g, TALUS_BAD_SHAPE);
    g = geometry(TALUS_CAPSULE, 1.0f, 0.0f, 1.0f);
    expect(&g, TALUS_BAD_SHAPE);
    g = geometry(TALUS_CAPSULE, 1.0f, 1.0f, (float)INFINITY);
    expect(&g, TALUS_NOT_FINITE);
    g.type = TALUS_HULL;
    expect(&g, TALUS_BAD_BLOB);
    /* A mass, or an inertia, that no float holds. */
    g = geometry(TALUS_SPHERE, 0.0f, 1e6f, 0.0f);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 1e6f, &m), TALUS_OK);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 1e9f, &m), TALUS_BAD_SHAPE);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 1e30f, &m), TALUS_BAD_SHAPE);
    g.radius = 1e-6f;
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 1e-30f, &m), TALUS_BAD_SHAPE);
    assert_int_equal(talus_geometry_mass(&g, NULL, 0u, 0.0f, &m), TALUS_OK);
    assert_true(m.mass == 0.0f);
}

static void same_mass(const talus_mass *a, const talus_mass *b, double tolerance) {
    double i = fmax((double)b->inertia.x.x, fmax((double)b->inertia.y.y, (double)b->inertia.z.z));
    double length = sqrt(i / (double)b->mass);
    near((double)a->mass, (double)b->mass, (double)b->mass, tolerance);
    const float *p = &a->center.x, *q = &b->center.x, *u = &a->inertia.x.x, *v = &b->inertia.x.x;
    for (int k = 0; k < 3; ++k) {
        near((double)p[k], (double)q[k], length + fabs((double)q[k]), tolerance);
    }
    for (int k = 0; k < 9; ++k) {
        near((double)u[k], (double)v[k], i, tolerance);
    }
}

static talus_quat about(float x, float y, float z, float angle) {
    float s = sinf(0.5f * angle);
    talus_vec3 a = tl_normalize_or(tl_v(x, y, z), tl_v(1.0f, 0.0f, 0.0f));
    talus_quat q = {a.x * s, a.y * s, a.z * s, cosf(0.5f * angle)};
    return q;
}

/* A box cut into eight unlike boxes, each moved to its place, is the box; seen from another frame it still is. */
static void test_compound(void **unused) {
    (void)unused;
    talus_geometry g;
    memset(&g, 0, sizeof g);
    g.type = TALUS_BOX;
    g.half.x = 1.0f, g.half.y = 2.0f, g.half.z = 0.5f;
    talus_mass whole = mass_of(&g, 7.0f), sum;
    memset(&sum, 0, sizeof sum);
    talus_pose outer = {{3.0f, -1.0f, 0.5f}, {0.0f, 0.0f, 0.0f, 1.0f}}, frame;
    outer.rotation = about(1.0f, 2.0f, -0.5f, 1.2f);
    const float cut[3] = {0.3f, -0.75f, 0.125f};
    for (uint32_t i = 0u; i < 8u; ++i) {
        talus_geometry part = g;
        frame = tl_pose_identity();
        float *half = &part.half.x, *at = &frame.position.x;
        const float *all = &g.half.x;
        for (uint32_t k = 0u; k < 3u; ++k) {
            float low = i >> k & 1u ? cut[k] : -all[k], high = i >> k & 1u ? all[k] : cut[k];
            half[k] = 0.5f * (high - low);
            at[k] = 0.5f * (high + low);
        }
        talus_mass m = mass_of(&part, 7.0f), there = talus_mass_move(&m, &frame);
        there = talus_mass_move(&there, &outer);
        sum = talus_mass_add(&sum, &there);
    }
    talus_mass want = talus_mass_move(&whole, &outer);
    same_mass(&sum, &want, 2e-6);
    /* There and back. */
    talus_pose back = {{0.0f, 0.0f, 0.0f}, tl_quat_conjugate(outer.rotation)};
    back.position = tl_rotate(back.rotation, tl_neg(outer.position));
    talus_mass again = talus_mass_move(&want, &back);
    same_mass(&again, &whole, 2e-6);
    /* Two without mass. */
    talus_mass none = mass_of(&g, 0.0f), both = talus_mass_add(&none, &none);
    assert_true(both.mass == 0.0f && tl_is_finite3(both.center) && tl_is_finite_mat3(&both.inertia));
}

typedef struct hull_block {
    void *memory;
    const unsigned char *region;
    size_t bytes;
} hull_block;

/* The hull stands 64 bytes into its region. */
static hull_block hull_of(const talus_vec3 *points, uint32_t n) {
    size_t ss = talus_hull_scratch_size(n), os = talus_hull_max_size(n), size = 0u;
    unsigned char *scratch = malloc(ss + 32u);
    hull_block b = {malloc(os + 128u), NULL, 0u};
    assert_non_null(scratch);
    assert_non_null(b.memory);
    unsigned char *at = b.memory;
    at += (32u - (uintptr_t)at % 32u) % 32u;
    assert_int_equal(
        talus_hull_build(points, n, scratch + (32u - (uintptr_t)scratch % 32u) % 32u, ss, at + 64, os, &size),
        TALUS_OK);
    free(scratch);
    b.region = at;
    b.bytes = size + 64u;
    return b;
}

static void test_hulls(void **unused) {
    (void)unused;
    talus_vec3 corner[8];
    talus_pose pose = {{0.2f, -0.4f, 0.1f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    pose.rotation = about(-1.0f, 0.4f, 2.0f, 2.0f);
    talus_geometry box;
    memset(&box, 0, sizeof box);
    box.type = TALUS_BOX;
    box.half.x = 0.3f, box.half.y = 1.1f, box.half.z = 0.05f;
    for (uint32_t i = 0u; i < 8u; ++i) {
        talus_vec3 p = {i & 1u ? box.half.x : -box.half.x, i & 2u ? box.half.y : -box.half.y,
                        i & 4u ? box.half.z : -box.half.z};
        corner[i] = tl_pose_point(&pose, p);
    }
    hull_block b = hull_of(corner, 8u);
    talus_geometry g = box;
    g.type = TALUS_HULL;
    g.hull = 64u;
    talus_mass m, want = mass_of(&box, 500.0f);
    want = talus_mass_move(&want, &pose);
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes, 500.0f, &m), TALUS_OK);
    same_mass(&m, &want, 4e-6);
    assert_ptr_equal(tl_geometry_hull(&g, b.region), b.region + 64);
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes - 1u, 500.0f, &m), TALUS_BAD_BLOB);
    g.hull = 32u;
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes, 500.0f, &m), TALUS_BAD_BLOB);
    g.hull = 65u;
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes, 500.0f, &m), TALUS_BAD_BLOB);
    g.hull = 0xffffffe0u;
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes, 500.0f, &m), TALUS_BAD_BLOB);
    free(b.memory);
    /* A tetrahedron at the corner of a cube of side 1: mass 1/6, centre 1/4, and about the centre xx = 1/80, xy =
     * 1/480. */
    const talus_vec3 t[4] = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    b = hull_of(t, 4u);
    g.hull = 64u;
    assert_int_equal(talus_geometry_mass(&g, b.region, b.bytes, 1.0f, &m), TALUS_OK);
    near((double)m.mass, 1.0 / 6.0, 1.0, 1e-7);
    near((double)m.center.z, 0.25, 1.0, 1e-7);
    near((double)m.inertia.x.x, 1.0 / 80.0, 1.0, 1e-8);
    near((double)m.inertia.x.y, 1.0 / 480.0, 1.0, 1e-9);
    free(b.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known),    cmocka_unit_test(test_revolved), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_compound), cmocka_unit_test(test_hulls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
