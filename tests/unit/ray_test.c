/* Rays against every type of shape. What they answer is proven in double by what a shape's support function and surface
 * bounds say: the point is in the shape and on its supporting plane across the normal, which the ray passes inwards; or
 * the ray comes nowhere nearer than rounding. TALUS_RAYS: how many of each type. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide/ray.h"
#include "collide_brute.h"

/* How far outside: of the surfaces' bounds that of capsules is searched for, being convex along the axis. */
static double outside(const tl_convex *s, d3 p) {
    const talus_geometry *g = &s->geometry;
    if (g->type != TALUS_CAPSULE) {
        return d_outside(s, p);
    }
    double low = 0.0, high = 1.0, best = 1e300, h = (double)g->half_height;
    for (int i = 0; i < 120; ++i) {
        double t[2] = {low + (high - low) / 3.0, high - (high - low) / 3.0}, value[2];
        for (int k = 0; k < 2; ++k) {
            double y = -h + 2.0 * h * t[k];
            value[k] = sqrt(p.x * p.x + p.z * p.z + (p.y - y) * (p.y - y)) -
                       ((double)g->radius_bottom + ((double)g->radius_top - (double)g->radius_bottom) * t[k]);
            best = fmin(best, value[k]);
        }
        if (value[0] < value[1]) {
            high = t[1];
        } else {
            low = t[0];
        }
    }
    return best;
}

/* The least of it along the ray, which is convex. */
static double nearest(const tl_convex *s, d3 o, d3 way) {
    double low = 0.0, high = 1.0, best = fmin(outside(s, o), outside(s, d3_add(o, way)));
    for (int i = 0; i < 100; ++i) {
        double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        double va = outside(s, d3_add(o, d3_scale(way, a))), vb = outside(s, d3_add(o, d3_scale(way, b)));
        best = fmin(best, fmin(va, vb));
        if (va < vb) {
            high = b;
        } else {
            low = a;
        }
    }
    return best;
}

/* What the vertices of a hull are off its planes: no point is known better. */
static double blur(const tl_convex *s) {
    double own = 1e-12 * d_size(s);
    for (uint32_t i = 0; s->hull && i < s->hull->vertex_count; ++i) {
        own = fmax(own, 2.0 * d_outside(s, d3_of(tl_hull_point(s->hull, i))));
    }
    return own;
}

static tl_d3 inner(d3 v) { return tl_d(v.x, v.y, v.z); }

static int check_ray(const tl_convex *s, const talus_pose *pose, talus_vec3 origin, talus_vec3 way, double noise) {
    d_pose frame = d_pose_of(pose);
    d3 o = d_rotate_back(&frame, d3_sub(d3_of(origin), frame.t)), w = d_rotate_back(&frame, d3_of(way));
    tl_ray_hit hit;
    double tolerance = noise + blur(s);
    if (!tl_ray_convex(s, pose, inner(d3_of(origin)), inner(d3_of(way)), &hit)) {
        assert_true(nearest(s, o, w) > -tolerance);
        return 0;
    }
    assert_true(hit.at >= 0.0 && hit.at <= 1.0);
    d3 n = d_rotate_back(&frame, d3_make(hit.normal.x, hit.normal.y, hit.normal.z)), x = d3_add(o, d3_scale(w, hit.at));
    if (hit.within) {
        assert_true(hit.at == 0.0 && d3_length(n) == 0.0 && outside(s, o) <= tolerance);
        return 1;
    }
    assert_true(outside(s, o) >= -tolerance);
    assert_true(fabs(d3_length(n) - 1.0) < 1e-12);
    assert_true(outside(s, x) <= tolerance);
    assert_true(d3_dot(n, x) >= d_reach(s, n) - tolerance - (s->hull ? 1e-5 * d_size(s) : 0.0));
    assert_true(d3_dot(n, w) <= 1e-9 * d3_length(w));
    return 1;
}

static uint32_t rays(void) {
    const char *text = getenv("TALUS_RAYS");
    return text ? (uint32_t)strtoul(text, NULL, 10) : 1500u;
}

/* From near and far, towards the shape and past it, from within it; long and short. */
static void all_types(void **state) {
    (void)state;
    brute_seed("rays");
    for (int kind = 0; kind < BRUTE_KINDS; ++kind) {
        uint32_t hits = 0, count = rays();
        for (uint32_t i = 0; i < count; ++i) {
            tl_convex s = brute_shape(kind, 0.01f, 10.0f);
            float size = (float)d_size(&s), far = (i & 7u) == 0u ? 1000.0f : 3.0f;
            talus_pose pose = brute_pose(0.0f, 10.0f);
            talus_vec3 origin = tl_mad(pose.position, far * size, brute_vector(-1.0f, 1.0f));
            talus_vec3 target = tl_mad(pose.position, size, brute_vector(-1.0f, 1.0f));
            if ((i & 15u) == 3u) {
                origin = target;
                target = tl_mad(pose.position, 3.0f * size, brute_vector(-1.0f, 1.0f));
            }
            talus_vec3 way = tl_scale(tl_sub(target, origin), brute_range(0.2f, 3.0f));
            if ((i & 31u) == 5u) { /* along an axis of the shape */
                way = tl_rotate(pose.rotation, tl_v(0.0f, 4.0f * size, 0.0f));
                origin = tl_sub(tl_mad(pose.position, 0.3f * size, brute_vector(-1.0f, 1.0f)), tl_scale(way, 0.5f));
            }
            hits += (uint32_t)check_ray(&s, &pose, origin, way, 1e-12 * (double)(far * size + 10.0f));
        }
        print_message("%s: %u of %u hit\n", brute_kind_name[kind], hits, count);
        assert_true(hits > count / 10u);
    }
}

static talus_pose at_origin(void) { return tl_pose_identity(); }

static tl_convex of_type(talus_shape_type type) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    s.geometry.type = type;
    s.geometry.radius = 1.0f, s.geometry.half_height = 1.0f;
    s.geometry.radius_bottom = 1.0f, s.geometry.radius_top = 0.5f;
    s.geometry.half = tl_v(1.0f, 2.0f, 3.0f);
    return s;
}

static void expect(const tl_convex *s, tl_d3 o, tl_d3 way, double at, tl_d3 normal) {
    talus_pose pose = at_origin();
    tl_ray_hit hit;
    assert_true(tl_ray_convex(s, &pose, o, way, &hit));
    assert_true(fabs(hit.at - at) < 1e-12);
    assert_true(tl_d_length(tl_d_sub(hit.normal, normal)) < 1e-12);
}

static void refuse(const tl_convex *s, tl_d3 o, tl_d3 way) {
    talus_pose pose = at_origin();
    tl_ray_hit hit;
    assert_false(tl_ray_convex(s, &pose, o, way, &hit));
}

static void known_ones(void **state) {
    (void)state;
    tl_convex ball = of_type(TALUS_SPHERE), box = of_type(TALUS_BOX), cone = of_type(TALUS_CYLINDER);
    tl_convex drop = of_type(TALUS_CAPSULE);
    expect(&ball, tl_d(-3.0, 0.0, 0.0), tl_d(4.0, 0.0, 0.0), 0.5, tl_d(-1.0, 0.0, 0.0));
    expect(&ball, tl_d(0.6, 5.0, 0.0), tl_d(0.0, -5.0, 0.0), 0.84, tl_d(0.6, 0.8, 0.0));
    expect(&ball, tl_d(-1e9, 0.6, 0.0), tl_d(2e9, 0.0, 0.0), 0.5 - 0.4e-9, tl_d(-0.8, 0.6, 0.0));
    expect(&ball, tl_d(0.0, 0.5, 0.0), tl_d(0.0, 5.0, 0.0), 0.0, tl_d(0.0, 0.0, 0.0));
    expect(&ball, tl_d(0.0, 1.0, 0.0), tl_d(0.0, 0.0, 0.0), 0.0, tl_d(0.0, 0.0, 0.0));
    refuse(&ball, tl_d(0.0, 1.0001, 0.0), tl_d(0.0, 0.0, 0.0));
    refuse(&ball, tl_d(-3.0, 0.0, 0.0), tl_d(1.99, 0.0, 0.0));
    refuse(&ball, tl_d(3.0, 0.0, 0.0), tl_d(4.0, 0.0, 0.0));
    expect(&box, tl_d(0.5, 4.0, 0.5), tl_d(0.0, -4.0, 0.0), 0.5, tl_d(0.0, 1.0, 0.0));
    expect(&box, tl_d(1.0, 4.0, 3.0), tl_d(0.0, -4.0, 0.0), 0.5, tl_d(0.0, 1.0, 0.0)); /* down an edge */
    refuse(&box, tl_d(1.0 + 1e-12, 4.0, 3.0), tl_d(0.0, -4.0, 0.0));
    /* the cut cone: radius 1 at the bottom, 0.5 at the top, slope -1/4 */
    expect(&cone, tl_d(-2.0, 0.0, 0.0), tl_d(2.0, 0.0, 0.0), 0.625,
           tl_d(-1.0 / sqrt(1.0625), 0.25 / sqrt(1.0625), 0.0));
    expect(&cone, tl_d(0.4, 2.0, 0.0), tl_d(0.0, -2.0, 0.0), 0.5, tl_d(0.0, 1.0, 0.0));
    expect(&cone, tl_d(0.9, -2.0, 0.0), tl_d(0.0, 2.0, 0.0), 0.5, tl_d(0.0, -1.0, 0.0));
    expect(&cone, tl_d(0.75, 2.0, 0.0), tl_d(0.0, -4.0, 0.0), 0.5, tl_d(1.0 / sqrt(1.0625), 0.25 / sqrt(1.0625), 0.0));
    refuse(&cone, tl_d(0.6, 2.0, 0.0), tl_d(0.0, -1.3, 0.0));
    cone.geometry.radius_top = 0.0f; /* straight on to the apex */
    expect(&cone, tl_d(0.0, 3.0, 0.0), tl_d(0.0, -4.0, 0.0), 0.5, tl_d(0.0, 1.0, 0.0));
    /* the hull of balls of radius 1 at y = -1 and 0.5 at y = 1 */
    expect(&drop, tl_d(0.0, 4.0, 0.0), tl_d(0.0, -5.0, 0.0), 0.5, tl_d(0.0, 1.0, 0.0));
    expect(&drop, tl_d(0.0, -4.0, 0.0), tl_d(0.0, 4.0, 0.0), 0.5, tl_d(0.0, -1.0, 0.0));
    double sine = 0.25, cosine = sqrt(1.0 - sine * sine); /* the side touches both balls across this normal */
    expect(&drop, tl_d(4.0, 0.0, 0.0), tl_d(-4.0, 0.0, 0.0), 1.0 - 0.75 / cosine / 4.0, tl_d(cosine, sine, 0.0));
}

/* Sizes at the ends of their ranges, the thinnest and steepest cones, poses a billion metres out: finite answers, unit
 * normals, in the shape as far as the numbers go. */
static void extremes(void **state) {
    (void)state;
    brute_seed("extreme rays");
    uint32_t hits = 0;
    for (uint32_t i = 0; i < 200000u; ++i) {
        tl_convex s = of_type((talus_shape_type)(brute_u32() % TALUS_HULL));
        float *sizes[] = {&s.geometry.radius,        &s.geometry.half_height, &s.geometry.radius_top,
                          &s.geometry.radius_bottom, &s.geometry.half.x,      &s.geometry.half.y,
                          &s.geometry.half.z};
        for (int k = 0; k < 7; ++k) {
            *sizes[k] = powf(10.0f, brute_range(-6.0f, 6.0f));
        }
        s.geometry.radius_top = s.geometry.type == TALUS_CYLINDER && (i & 4u) ? 0.0f : s.geometry.radius_top;
        talus_pose pose = brute_pose(0.0f, 1.0f);
        pose.position = tl_scale(pose.position, powf(10.0f, brute_range(-6.0f, 9.0f)));
        double size = d_size(&s);
        talus_vec3 aim = tl_mad(pose.position, (float)size, brute_vector(-0.5f, 0.5f));
        talus_vec3 way = tl_scale(brute_direction(), powf(10.0f, brute_range(-6.0f, 9.0f)));
        talus_vec3 origin = tl_mad(aim, -brute_range(0.0f, 1.0f), way);
        tl_ray_hit hit;
        if (tl_ray_convex(&s, &pose, inner(d3_of(origin)), inner(d3_of(way)), &hit)) {
            ++hits;
            assert_true(hit.at >= 0.0 && hit.at <= 1.0);
            double length = tl_d_length(hit.normal);
            assert_true(hit.within ? length == 0.0 : fabs(length - 1.0) < 1e-9);
        }
    }
    print_message("%u hits\n", hits);
    assert_true(hits > 1000u);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_ones), cmocka_unit_test(all_types),
                                       cmocka_unit_test(extremes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
