/* The hull builder and the validator against what can be said of hulls by brute force in double: every face has every
 * vertex below it, no input point is outside, every vertex is an input point, the same input gives the same bytes, and
 * a damaged blob is told from a sound one. Units: m; errors are printed in parts of the largest coordinate. */
#include "geom/hull.h"
#include "hull_points.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the four above. */
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define GOLDEN 0x5d644e83u
#define CONVEX 1e-6 /* of the largest coordinate: vertices above a face */
#define INSIDE 4e-6 /* of the largest coordinate: input points above a face */
#define AWAY 5e-6   /* of the largest coordinate: input points away from the hull */

typedef struct built {
    talus_status status;
    const talus_hull *hull;
    size_t size;
} built;

static unsigned char *scratch_memory, *out_memory, *scratch, *out;
static talus_vec3 *points;

static unsigned char *to_aligned(unsigned char *p) { return p + (32u - (uintptr_t)p % 32u) % 32u; }

static int setup(void **unused) {
    (void)unused;
    scratch_memory = malloc(talus_hull_scratch_size(TALUS_HULL_MAX_POINTS) + 64u);
    out_memory = malloc(talus_hull_max_size(TALUS_HULL_MAX_POINTS) + 64u);
    points = malloc((TALUS_HULL_MAX_POINTS + 1u) * sizeof *points);
    scratch = to_aligned(scratch_memory);
    out = to_aligned(out_memory);
    return scratch_memory && out_memory && points ? 0 : -1;
}

static int teardown(void **unused) {
    (void)unused;
    free(scratch_memory);
    free(out_memory);
    free(points);
    return 0;
}

static built build(uint32_t n) {
    built b = {TALUS_OK, (const talus_hull *)(const void *)out, 0u};
    b.status = talus_hull_build(points, n, scratch, talus_hull_scratch_size(n), out, talus_hull_max_size(n), &b.size);
    return b;
}

static void family_points(int family, uint32_t n, uint32_t s, double scale) {
    seed(s);
    for (uint32_t i = 0u; i < n; ++i) {
        double p[3];
        family_point(family, i, n, p);
        points[i].x = (float)(p[0] * scale), points[i].y = (float)(p[1] * scale), points[i].z = (float)(p[2] * scale);
    }
}

static double largest_coordinate(uint32_t n) {
    double m = 0.0;
    for (uint32_t i = 0u; i < n; ++i) {
        m = fmax(m, fmax(fabs((double)points[i].x), fmax(fabs((double)points[i].y), fabs((double)points[i].z))));
    }
    return m;
}

static double above(const talus_hull *h, uint32_t f, talus_vec3 p) {
    talus_vec3 n = tl_hull_normal(h, f);
    return (double)n.x * (double)p.x + (double)n.y * (double)p.y + (double)n.z * (double)p.z -
           (double)tl_hull_offset(h, f);
}

static double worst_above(const talus_hull *h, talus_vec3 p) {
    double worst = -1e300;
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        worst = fmax(worst, above(h, f, p));
    }
    return worst;
}

typedef struct v3 {
    double x, y, z;
} v3;

static v3 v3_of(talus_vec3 p) {
    v3 v = {(double)p.x, (double)p.y, (double)p.z};
    return v;
}
static v3 v3_sub(v3 a, v3 b) {
    v3 v = {a.x - b.x, a.y - b.y, a.z - b.z};
    return v;
}
static double v3_dot(v3 a, v3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static v3 v3_cross(v3 a, v3 b) {
    v3 v = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return v;
}

static double triangle_distance2(v3 p, const v3 t[3]) {
    v3 n = v3_cross(v3_sub(t[1], t[0]), v3_sub(t[2], t[0]));
    double best = 1e300, area2 = v3_dot(n, n);
    int over = area2 > 0.0;
    for (int i = 0; i < 3; ++i) {
        v3 a = t[i], ab = v3_sub(t[(i + 1) % 3], a), ap = v3_sub(p, a);
        double l = v3_dot(ab, ab), s = l > 0.0 ? fmin(fmax(v3_dot(ap, ab) / l, 0.0), 1.0) : 0.0;
        v3 d = {ap.x - s * ab.x, ap.y - s * ab.y, ap.z - s * ab.z};
        best = fmin(best, v3_dot(d, d));
        over = over && v3_dot(v3_cross(n, ab), ap) >= 0.0;
    }
    double h = over ? v3_dot(n, v3_sub(p, t[0])) : 0.0;
    return over ? fmin(best, h * h / area2) : best;
}

/* How far a point outside is from the faces. Heights alone would not tell that a sharp tip was lost. */
static double distance(const talus_hull *h, talus_vec3 point) {
    const tl_half_edge *edge = tl_hull_edges(h);
    double best = 1e300;
    v3 p = v3_of(point), t[3];
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        uint32_t first = tl_hull_face_edge(h)[f];
        t[0] = v3_of(tl_hull_point(h, edge[first].origin));
        for (uint32_t e = edge[first].next; edge[e].next != first; e = edge[e].next) {
            t[1] = v3_of(tl_hull_point(h, edge[e].origin));
            t[2] = v3_of(tl_hull_point(h, edge[edge[e].next].origin));
            best = fmin(best, triangle_distance2(p, t));
        }
    }
    return sqrt(best);
}

static int is_input(talus_vec3 v, uint32_t n) {
    for (uint32_t i = 0u; i < n; ++i) {
        if (memcmp(&points[i], &v, sizeof v) == 0) {
            return 1;
        }
    }
    return 0;
}

/* All that must hold of a hull of points[0..n). */
static void check(const built *b, uint32_t n, const char *name, int quiet) {
    const talus_hull *h = b->hull;
    double m = largest_coordinate(n), convex = 0.0, inside = 0.0, away = 0.0;
    assert_int_equal(b->size, h->bytes);
    assert_int_equal(talus_hull_validate(h, b->size), TALUS_OK);
    uint32_t step = h->face_count > 2000u ? h->face_count / 500u : 1u;
    for (uint32_t i = 0u; i < h->vertex_count; i += step) {
        convex = fmax(convex, worst_above(h, tl_hull_point(h, i)) / m);
        assert_true(n > 20000u || is_input(tl_hull_point(h, i), n));
    }
    for (uint32_t i = 0u; i < n; i += step) {
        double height = worst_above(h, points[i]);
        inside = fmax(inside, height / m);
        away = fmax(away, height > 0.0 ? distance(h, points[i]) / m : 0.0);
    }
    if (!quiet || convex > CONVEX || inside > INSIDE || away > AWAY) {
        print_message("%-14s n %5u: %5u vertices %5u faces; vertices above faces %.1e, points above faces %.1e, "
                      "points away from the hull %.1e\n",
                      name, n, h->vertex_count, h->face_count, convex, inside, away);
    }
    assert_true(away <= AWAY);
    assert_true(convex <= CONVEX);
    assert_true(inside <= INSIDE);
    talus_vec3 c = h->centroid;
    assert_true(worst_above(h, c) < 0.0);
    assert_true(-worst_above(h, c) >= (double)h->inner_radius * 0.9999999);
}

static void test_families(void **unused) {
    (void)unused;
    static const uint32_t size[] = {8u, 30u, 300u, 3000u};
    print_message("seed %u\n", SEED);
    for (int family = 0; family < FAMILY_COUNT; ++family) {
        for (uint32_t k = 0u; k < 4u; ++k) {
            for (uint32_t r = 0u; r < (k < 2u ? 40u : 3u); ++r) {
                family_points(family, size[k], SEED + r, 1.0);
                built b = build(size[k]);
                if (b.status != TALUS_OK) {
                    print_message("%s n %u seed %u: status %d\n", family_name[family], size[k], SEED + r, b.status);
                }
                assert_int_equal(b.status, TALUS_OK);
                check(&b, size[k], family_name[family], !(k == 3u && r == 0u));
            }
        }
    }
}

static void test_scales(void **unused) {
    (void)unused;
    for (double scale = 1e-6; scale < 2e6; scale *= 10.0) {
        for (int family = 0; family < FAMILY_COUNT; ++family) {
            /* Slabs a millionth thick: 1e-12 m at the small end, whose inertia is below the least float. */
            if (scale < 1e-4 && (family == SLAB || family == TURNED_SLAB || family == SHELL_PATCH)) {
                continue;
            }
            family_points(family, 60u, SEED, scale);
            built b = build(60u);
            if (b.status != TALUS_OK) {
                print_message("%s scale %g: status %d\n", family_name[family], scale, b.status);
            }
            assert_int_equal(b.status, TALUS_OK);
            check(&b, 60u, family_name[family], 1);
        }
    }
}

static void test_known(void **unused) {
    (void)unused;
    for (uint32_t i = 0u; i < 8u; ++i) {
        points[i].x = i & 1u ? 1.0f : -1.0f;
        points[i].y = i & 2u ? 2.0f : -2.0f;
        points[i].z = i & 4u ? 3.0f : -3.0f;
    }
    built b = build(8u);
    assert_int_equal(b.status, TALUS_OK);
    assert_int_equal(talus_hull_vertex_count(b.hull), 8);
    assert_int_equal(talus_hull_face_count(b.hull), 6);
    assert_true(b.hull->volume == 48.0f && b.hull->inner_radius == 1.0f);
    assert_true(talus_hull_size(b.hull) == b.size && b.size <= talus_hull_max_size(8u));
    for (uint32_t i = 0u; i < 8u; ++i) {
        talus_vec3 v = talus_hull_vertex(b.hull, i);
        assert_memory_equal(&v, &points[i], sizeof v);
    }
    /* A grid keeps its eight corners only, however it lies. */
    for (int family = GRID; family <= TURNED_GRID; ++family) {
        family_points(family, 1000u, SEED, 1.0);
        b = build(1000u);
        assert_int_equal(b.status, TALUS_OK);
        assert_int_equal(talus_hull_vertex_count(b.hull), 8);
        assert_int_equal(talus_hull_face_count(b.hull), 6);
    }
    family_points(CYLINDER, 200u, SEED, 1.0);
    b = build(200u);
    assert_int_equal(b.status, TALUS_OK);
    assert_int_equal(talus_hull_vertex_count(b.hull), 200);
    assert_int_equal(talus_hull_face_count(b.hull), 102);
}

static void flat_case(uint32_t n) { assert_int_equal(build(n).status, TALUS_FLAT_HULL); }

static void test_flat(void **unused) {
    (void)unused;
    for (uint32_t n = 0u; n < 2000u; n = 3u * n + 1u) {
        for (double scale = 1e-6; scale < 2e6; scale *= 1e3) {
            seed(SEED);
            for (uint32_t i = 0u; i < n; ++i) { /* all the same */
                points[i].x = (float)scale, points[i].y = (float)(-scale), points[i].z = (float)(0.3 * scale);
            }
            flat_case(n);
            for (uint32_t i = 0u; i < n; ++i) { /* on a slanted line */
                double a = uniform() * scale;
                points[i].x = (float)(0.3 * a), points[i].y = (float)(a + scale), points[i].z = (float)(-0.7 * a);
            }
            flat_case(n);
            for (uint32_t i = 0u; i < n; ++i) { /* on a slanted plane */
                double p[3] = {uniform() * scale, uniform() * scale, 0.77 * scale};
                turn(p);
                points[i].x = (float)p[0], points[i].y = (float)p[1], points[i].z = (float)p[2];
            }
            flat_case(n);
            for (uint32_t i = 0u; i < n; ++i) { /* on an axis plane */
                points[i].x = (float)(uniform() * scale), points[i].z = (float)(uniform() * scale), points[i].y = 0.5f;
            }
            flat_case(n);
        }
    }
}

static void test_arguments(void **unused) {
    (void)unused;
    family_points(ON_SPHERE, 50u, SEED, 1.0);
    size_t ss = talus_hull_scratch_size(50u), os = talus_hull_max_size(50u), size = 77u;
    assert_int_equal(talus_hull_build(NULL, 50u, scratch, ss, out, os, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_hull_build(points, 50u, NULL, ss, out, os, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, NULL, os, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out, os, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_hull_build(points, 50u, scratch + 16, ss, out, os, &size), TALUS_UNALIGNED);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out + 4, os, &size), TALUS_UNALIGNED);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss - 1u, out, os, &size), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out, 200u, &size), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_hull_build(points, 65536u, scratch, ss, out, os, &size), TALUS_TOO_MANY_POINTS);
    assert_int_equal(size, 77);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out, os, &size), TALUS_OK);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out, size, &size), TALUS_OK);
    assert_int_equal(talus_hull_build(points, 50u, scratch, ss, out, size - 1u, &size), TALUS_SMALL_BLOCK);
    points[33].y = (float)NAN;
    assert_int_equal(build(50u).status, TALUS_NOT_FINITE);
    points[33].y = -(float)INFINITY;
    assert_int_equal(build(50u).status, TALUS_NOT_FINITE);
    assert_int_equal(talus_hull_validate(NULL, 1000u), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_hull_validate(out + 8, 1000u), TALUS_UNALIGNED);
    assert_int_equal(talus_hull_validate(out, 0u), TALUS_BAD_BLOB);
    family_points(ON_SPHERE, 30000u, SEED, 1.0);
    assert_int_equal(build(30000u).status, TALUS_TOO_MANY_POINTS);
    /* Coordinates near the ends of the float range: an answer, whichever. */
    for (double scale = 1e-44; scale < 3e38; scale *= 1e3) {
        for (int family = 0; family < FAMILY_COUNT; ++family) {
            family_points(family, 40u, SEED, scale / 5.0);
            built b = build(40u);
            assert_true(b.status == TALUS_OK || b.status == TALUS_FLAT_HULL || b.status == TALUS_BAD_SHAPE);
            if (b.status == TALUS_OK) {
                check(&b, 40u, family_name[family], 1);
            }
        }
    }
}

static void test_same_bytes(void **unused) {
    (void)unused;
    for (int family = 0; family < FAMILY_COUNT; ++family) {
        for (uint32_t n = 10u; n <= 1000u; n *= 10u) {
            family_points(family, n, SEED, 1.0);
            memset(scratch, 0xa5, talus_hull_scratch_size(n));
            memset(out, 0xa5, talus_hull_max_size(n));
            built b = build(n);
            if (b.status != TALUS_OK) {
                continue;
            }
            unsigned char *copy = malloc(b.size);
            assert_non_null(copy);
            memcpy(copy, out, b.size);
            memset(scratch, 0x3c, talus_hull_scratch_size(n));
            memset(out, 0x3c, talus_hull_max_size(n));
            b = build(n);
            assert_int_equal(b.status, TALUS_OK);
            assert_memory_equal(copy, out, b.size);
            free(copy);
        }
    }
}

/* The same bytes wherever this runs: a hash over the checksums of hulls whose points need no sine. */
static void test_same_everywhere(void **unused) {
    (void)unused;
    static const int family[] = {IN_BALL,       ON_SPHERE,   IN_CUBE,    ON_CUBE, GRID,       TURNED_GRID,
                                 JITTERED_CUBE, TURNED_SLAB, LENS,       BLADE,   GAUSSIAN,   SHELL_PATCH,
                                 TWO_SCALES,    INTEGERS,    OFF_ORIGIN, NEEDLE,  FEW_VALUES, SLAB};
    uint32_t hash = 0u;
    for (uint32_t k = 0u; k < sizeof family / sizeof family[0]; ++k) {
        for (uint32_t n = 10u; n <= 1000u; n *= 10u) {
            family_points(family[k], n, SEED, 1.0);
            built b = build(n);
            hash = hash * 31u + (b.status == TALUS_OK ? b.hull->checksum : (uint32_t)b.status);
        }
    }
    print_message("hash of hulls 0x%08x\n", hash);
    assert_int_equal(hash, GOLDEN);
}

/* A damaged blob in memory of little more than its size, so that the sanitizer sees every read outside. With the
 * checksum mended the deeper tests have to find the damage; what they let pass must at least be safe to walk. */
static void test_damage(void **unused) {
    (void)unused;
    static const int family[] = {IN_BALL, ON_CUBE, CYLINDER, SLAB};
    uint32_t passed = 0u, tried = 0u;
    for (uint32_t k = 0u; k < 4u; ++k) {
        family_points(family[k], 60u, SEED, 1.0);
        built b = build(60u);
        assert_int_equal(b.status, TALUS_OK);
        size_t size = b.size;
        unsigned char *memory = malloc(size + 32u), *blob = to_aligned(memory);
        assert_non_null(memory);
        for (uint32_t r = 0u; r < 20000u; ++r) {
            memcpy(blob, out, size);
            uint32_t flips = 1u + next_u32() % 3u;
            for (uint32_t i = 0u; i < flips; ++i) {
                blob[next_u32() % (r % 4u == 0u ? 132u : (uint32_t)size)] ^= (unsigned char)(1u << next_u32() % 8u);
            }
            int same = memcmp(blob, out, size) == 0;
            talus_status status = talus_hull_validate(blob, size);
            assert_true(same ? status == TALUS_OK : status == TALUS_BAD_BLOB);
            /* Mended: FNV-1a over the words after the first four. */
            uint32_t hash = 2166136261u, word;
            for (size_t i = 16u; i < size; i += 4u) {
                memcpy(&word, blob + i, 4u);
                hash = (hash ^ word) * 16777619u;
                hash ^= hash >> 15;
            }
            memcpy(blob + 12, &hash, 4u);
            passed += !same && talus_hull_validate(blob, size) == TALUS_OK;
            ++tried;
        }
        for (size_t cut = 0u; cut < size; cut += 4u) {
            unsigned char *part = malloc(cut + 32u);
            assert_non_null(part);
            memcpy(to_aligned(part), out, cut);
            assert_int_equal(talus_hull_validate(to_aligned(part), cut), TALUS_BAD_BLOB);
            free(part);
        }
        free(memory);
    }
    print_message("of %u damaged blobs with a mended checksum %u pass (the last bits of planes, spare bytes)\n", tried,
                  passed);
}

static void test_time(void **unused) {
    (void)unused;
    static const int family[] = {ON_SPHERE, IN_CUBE, ON_CUBE,     TURNED_GRID, JITTERED_CUBE,
                                 CYLINDER,  LENS,    SHELL_PATCH, DOUBLE_CONE};
    for (uint32_t k = 0u; k < sizeof family / sizeof family[0]; ++k) {
        for (uint32_t n = 10u; n <= 10000u; n *= 10u) {
            family_points(family[k], n, SEED, 1.0);
            clock_t start = clock();
            built b = build(n);
            double ms = (double)(clock() - start) * 1e3 / (double)CLOCKS_PER_SEC;
            print_message("%-14s n %5u: %8.3f ms, %5u vertices, %u bytes\n", family_name[family[k]], n, ms,
                          b.status ? 0u : b.hull->vertex_count, (unsigned)b.size);
            assert_true(b.status == TALUS_OK || b.status == TALUS_FLAT_HULL);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known),  cmocka_unit_test(test_families),        cmocka_unit_test(test_scales),
        cmocka_unit_test(test_flat),   cmocka_unit_test(test_arguments),       cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_damage), cmocka_unit_test(test_same_everywhere), cmocka_unit_test(test_time),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
