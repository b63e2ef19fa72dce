/* Every type against every type at random poses: the separation is the greatest over all directions, the normal reaches
 * it, the points lie on both shapes, and changing the roles changes nothing but the frame. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide_brute.h"

static int failures;

#define CHECK(cond, ...)                                                                                               \
    do {                                                                                                               \
        if (!(cond)) {                                                                                                 \
            if (failures++ < 30) {                                                                                     \
                printf("  failed %s: ", #cond);                                                                        \
                printf(__VA_ARGS__);                                                                                   \
                printf("\n");                                                                                          \
            }                                                                                                          \
        }                                                                                                              \
    } while (0)

static double least(const tl_manifold *m) {
    double s = 1e300;
    for (uint32_t i = 0; i < m->count; ++i) {
        s = fmin(s, (double)m->point[i].separation);
    }
    return s;
}

static int is_flat(int kind) { return kind == BRUTE_BOX || kind == BRUTE_HULL; }

static void check_manifold(const char *name, const tl_convex *a, const tl_convex *b, const talus_pose *pose,
                           float margin, const tl_manifold *m, double expected, int exact) {
    double size = fmin(d_size(a), d_size(b)), big = fmax(d_size(a), d_size(b));
    double tolerance = exact ? 1e-4 * fabs(expected) + 1e-5 * size + 1e-6 * big : 2e-3 * fabs(expected) + 1e-4 * big;
    if (expected > 0.0) {
        tolerance = 0.02 * expected + 1e-5 * big;
    }
    d_pair p;
    p.a = a;
    p.b = b;
    p.pose = d_pose_of(pose);
    if (m->count == 0) {
        CHECK(expected > (double)margin - tolerance, "%s: no points but separation %g margin %g", name, expected,
              (double)margin);
        double proven = fmax(expected, d_separation(&p, d3_unit(d3_of(m->normal))));
        CHECK((double)m->gap <= proven + (exact ? 1e-6 : 1e-4) * big, "%s: a gap of %g but separation %g", name,
              (double)m->gap, expected);
        CHECK(m->gap > margin, "%s: no points and no gap", name);
        return;
    }
    double s = least(m);
    d3 n = d3_of(m->normal);
    CHECK(fabs(d3_length(n) - 1.0) < 1e-5, "%s: normal of length %g", name, d3_length(n));
    double along = d_separation(&p, d3_unit(n));
    CHECK(along >= expected - tolerance, "%s: normal separates by %.9g, expected %.9g", name, along, expected);
    /* the search may have missed what the shapes' own normal proves */
    expected = fmax(expected, along);
    CHECK(fabs(s - expected) <= tolerance, "%s: separation %.9g expected %.9g count %u", name, s, expected, m->count);
    for (uint32_t i = 0; i < m->count; ++i) {
        d3 mid = d3_of(m->point[i].position), half = d3_scale(n, 0.5 * (double)m->point[i].separation);
        d3 on_a = d3_sub(mid, half), on_b = d_rotate_back(&p.pose, d3_sub(d3_add(mid, half), p.pose.t));
        /* segments of up to 2 degrees to one another count as parallel */
        double slack = (m->count == 2 ? 3e-2 : 8e-3) * fmin(size, big) + 1e-5 * big + 0.05 * fabs(expected) + tolerance;
        CHECK((double)m->point[i].separation <= (double)margin + 1e-6 * big, "%s: point beyond the margin", name);
        CHECK(d_outside(a, on_a) < slack, "%s: point %u of %u off A by %g", name, i, m->count, d_outside(a, on_a));
        CHECK(d_outside(b, on_b) < slack, "%s: point %u of %u off B by %g", name, i, m->count, d_outside(b, on_b));
        for (uint32_t k = 0; k < i; ++k) {
            CHECK(m->point[i].id != m->point[k].id, "%s: id %x twice", name, m->point[i].id);
        }
    }
}

/* A distance is right if points of both shapes are that far apart and a direction separates them by as much. */
static void check_distance(const char *name, const tl_convex *a, const tl_convex *b, const talus_pose *pose,
                           double distance, talus_vec3 pa, talus_vec3 pb, double expected) {
    double big = fmax(d_size(a), d_size(b)), tolerance = 1e-4 * distance + 5e-6 * big;
    d_pair p;
    p.a = a;
    p.b = b;
    p.pose = d_pose_of(pose);
    d3 between = d3_sub(d3_of(pb), d3_of(pa));
    CHECK(fabs(d3_length(between) - distance) <= tolerance, "%s: points %g apart, distance %g", name,
          d3_length(between), distance);
    CHECK(d_outside(a, d3_of(pa)) <= tolerance, "%s: point off A by %g", name, d_outside(a, d3_of(pa)));
    double off = d_outside(b, d_rotate_back(&p.pose, d3_sub(d3_of(pb), p.pose.t)));
    CHECK(off <= tolerance, "%s: point off B by %g", name, off);
    CHECK(distance > 0.0 || expected <= tolerance, "%s: no distance, expected %g", name, expected);
    if (distance > 1e-3 * big) {
        double along = d_separation(&p, d3_unit(between));
        /* the direction is that of two rounded points */
        tolerance += 5e-7 * big * big / distance;
        CHECK(along >= distance - tolerance, "%s: distance %.9g but only %.9g along it", name, distance, along);
    }
}

/* Turned by any multiple of a right angle about each axis, and tilted by up to `tilt`. */
static talus_quat nearly_square(float tilt) {
    talus_quat q = tl_quat_identity();
    for (int axis = 0; axis < 3; ++axis) {
        float s = (float)(brute_u32() & 1u) * 0.70710678f, c = s > 0.0f ? 0.70710678f : 1.0f;
        talus_quat turn = {axis == 0 ? s : 0.0f, axis == 1 ? s : 0.0f, axis == 2 ? s : 0.0f, c};
        q = tl_quat_mul(turn, q);
    }
    talus_vec3 v = brute_vector(-tilt, tilt);
    talus_quat small = {v.x, v.y, v.z, 1.0f};
    return tl_quat_normalize(tl_quat_mul(small, q));
}

static void compare(const char *name, int exact, const tl_convex *a, const tl_convex *b, const talus_pose *at,
                    float margin);

/* Polyhedra that all but fit: faces nearly flush, edges nearly parallel, in touch or nearly so along an axis. */
static void one_flush(int ka, int kb, float tilt) {
    char name[96];
    uint64_t state = brute_state;
    tl_convex a = brute_shape(ka, 0.3f, 1.0f), b = brute_shape(kb, 0.3f, 1.0f);
    talus_pose pose;
    pose.rotation = nearly_square(tilt);
    talus_vec3 along = tl_v(1.0f, 0.0f, 0.0f), aside = brute_vector(-1.0f, 1.0f);
    uint32_t axis = brute_u32() % 3u;
    along = axis == 0 ? along : axis == 1 ? tl_v(0.0f, 1.0f, 0.0f) : tl_v(0.0f, 0.0f, 1.0f);
    d_pose d = d_pose_of(&pose);
    double reach = d_reach(&a, d3_of(along)) + d_reach(&b, d_rotate_back(&d, d3_scale(d3_of(along), -1.0)));
    pose.position =
        tl_mad(tl_mad(aside, -tl_dot(aside, along), along), (float)reach + brute_range(-0.02f, 0.02f), along);
    snprintf(name, sizeof name, "%s-%s flush seed %llu", brute_kind_name[ka], brute_kind_name[kb],
             (unsigned long long)state);
    compare(name, 1, &a, &b, &pose, 0.05f);
}

static void one_pair(int ka, int kb, float low, float high, float margin, float spread) {
    char name[96];
    uint64_t state = brute_state;
    tl_convex a = brute_shape(ka, low, high), b = brute_shape(kb, low, high);
    talus_pose pose;
    pose.rotation = brute_rotation();
    if ((brute_u32() & 7u) == 0) {
        pose.rotation = tl_quat_identity();
    }
    float reach = (float)(d_size(&a) + d_size(&b));
    talus_vec3 direction = brute_direction();
    pose.position = tl_scale(direction, brute_range(0.0f, spread * reach));
    snprintf(name, sizeof name, "%s-%s seed %llu", brute_kind_name[ka], brute_kind_name[kb], (unsigned long long)state);
    compare(name, is_flat(ka) && is_flat(kb), &a, &b, &pose, margin);
}

static void compare(const char *name, int exact, const tl_convex *sa, const tl_convex *sb, const talus_pose *at,
                    float margin) {
    tl_convex a = *sa, b = *sb;
    talus_pose pose = *at;
    d3 n;
    double expected;
    if (!d_exact_separation(&a, &b, &pose, &expected, &n)) {
        expected = d_best_separation(&a, &b, &pose, &n);
    }
    tl_manifold m, w;
    tl_pair_cache cache = {{0, 0, 0, 0}}, other = {{0, 0, 0, 0}};
    tl_collide(&a, &b, &pose, margin, &cache, &m);
    check_manifold(name, &a, &b, &pose, margin, &m, expected, exact);
    tl_collide(&a, &b, &pose, margin, &cache, &w);
    check_manifold("again", &a, &b, &pose, margin, &w, expected, exact);
    for (int i = 0; i < 4; ++i) {
        cache.word[i] = brute_u32();
    }
    cache.word[0] = (brute_u32() & 1u) ? cache.word[0] & 0xc000001fu : cache.word[0];
    tl_collide(&a, &b, &pose, margin, &cache, &w);
    check_manifold("any cache", &a, &b, &pose, margin, &w, expected, exact);
    talus_pose identity = tl_pose_identity(), back = tl_pose_relative(&pose, &identity);
    tl_collide(&b, &a, &back, margin, &other, &w);
    check_manifold("swapped", &b, &a, &back, margin, &w, expected, exact);
    talus_vec3 pa, pb;
    float distance = tl_distance(&a, &b, &pose, &other, &pa, &pb);
    check_distance(name, &a, &b, &pose, (double)distance, pa, pb, expected);
}

static void all_pairs(float low, float high, float margin, float spread, int rounds) {
    for (int ka = 0; ka < BRUTE_KINDS; ++ka) {
        for (int kb = ka; kb < BRUTE_KINDS; ++kb) {
            int before = failures;
            for (int i = 0; i < rounds; ++i) {
                one_pair(ka, kb, low, high, margin, spread);
            }
            if (failures != before) {
                printf("%s-%s: %d failures\n", brute_kind_name[ka], brute_kind_name[kb], failures - before);
            }
        }
    }
}

static int rounds(int usual) {
    const char *text = getenv("TALUS_ROUNDS");
    return text != NULL ? usual * atoi(text) : usual;
}

static void shapes_of_like_size(void **state) {
    (void)state;
    failures = 0;
    all_pairs(0.3f, 1.0f, 0.05f, 1.0f, rounds(20));
    assert_int_equal(failures, 0);
}

static void large_margin(void **state) {
    (void)state;
    failures = 0;
    all_pairs(0.3f, 1.0f, 10.0f, 2.0f, rounds(20));
    assert_int_equal(failures, 0);
}

static void unlike_sizes(void **state) {
    (void)state;
    failures = 0;
    all_pairs(0.02f, 2.0f, 0.1f, 0.7f, rounds(20));
    assert_int_equal(failures, 0);
}

static void nearly_flush(void **state) {
    (void)state;
    failures = 0;
    for (int i = 0; i < rounds(400); ++i) {
        float tilt = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 1e-5f : i % 4 == 2 ? 1e-3f : 2e-2f;
        one_flush((brute_u32() & 3u) ? BRUTE_BOX : BRUTE_HULL, BRUTE_BOX, tilt);
        one_flush(BRUTE_BOX, (brute_u32() & 1u) ? BRUTE_HULL : BRUTE_BOX, tilt);
    }
    assert_int_equal(failures, 0);
}

int main(void) {
    brute_seed("collide_pairs_test");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_of_like_size),
        cmocka_unit_test(large_margin),
        cmocka_unit_test(unlike_sizes),
        cmocka_unit_test(nearly_flush),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
