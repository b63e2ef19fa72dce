/* Furthest vertices of hulls by the table of directions and the climb from there, against a look at all vertices. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide_brute.h"
#include "geom/hull_climb.h"
#include "geom/hull_derive.h"

static const uint32_t counts[] = {64, 65, 100, 300, 1000, 3000};
#define COUNTS (sizeof counts / sizeof counts[0])

static float along(const talus_hull *h, uint32_t i, talus_vec3 d) {
    talus_vec3 p = tl_hull_point(h, i);
    return p.x * d.x + p.y * d.y + p.z * d.z;
}

/* How many vertices are further than vertex i. */
static uint32_t rank(const talus_hull *h, uint32_t i, talus_vec3 d) {
    uint32_t further = 0;
    for (uint32_t k = 0; k < h->vertex_count; ++k) {
        further += along(h, k, d) > along(h, i, d);
    }
    return further;
}

/* The climb ends at the furthest vertex, and the table begins near it: few vertices of a ball are further. */
static void climbs(void **state) {
    (void)state;
    for (uint32_t n = 0; n < COUNTS; ++n) {
        const talus_hull *h = brute_hull(counts[n], tl_v(1.0f, 1.0f, 1.0f));
        double sum = 0.0;
        assert_int_equal(h->squares > 0u, h->vertex_count > TL_HULL_SCANNED);
        for (int i = 0; i < 1000; ++i) {
            talus_vec3 d = tl_scale(brute_direction(), brute_range(1e-3f, 1e3f));
            uint32_t seed = tl_hull_seed(h, d), top = tl_hull_climb(h, d, seed);
            float best = along(h, top, d);
            for (uint32_t k = 0; k < h->vertex_count; ++k) {
                assert_true(along(h, k, d) <= best);
            }
            sum += rank(h, seed, d);
        }
        printf("  %u vertices, %u squares: %.2f are further than the table's\n", (unsigned)h->vertex_count,
               (unsigned)h->squares, sum / 1000.0);
        assert_true(h->squares == 0u || sum / 1000.0 < 2.0);
    }
}

/* Of any direction there is a seed: along axes and diagonals, and none at all. */
static void corners(void **state) {
    (void)state;
    const talus_hull *h = brute_hull(200u, tl_v(1.0f, 0.1f, 0.01f));
    for (int i = 0; i < 27; ++i) {
        talus_vec3 d = tl_v((float)(i % 3 - 1), (float)(i / 3 % 3 - 1), (float)(i / 9 - 1));
        for (int k = 0; k < 3; ++k) {
            static const float scale[3] = {1.0f, 1e-30f, 1e30f};
            talus_vec3 s = tl_scale(d, scale[k]);
            assert_true(tl_hull_seed(h, s) < h->vertex_count);
        }
    }
}

static void refused(void **state) {
    (void)state;
    talus_hull *h = (talus_hull *)(uintptr_t)brute_hull(100u, tl_v(1.0f, 1.0f, 1.0f));
    uint16_t *table = (uint16_t *)(void *)((unsigned char *)h + h->directions), was = table[7];
    assert_int_equal(talus_hull_validate(h, h->bytes), TALUS_OK);
    table[7] = (uint16_t)h->vertex_count;
    h->checksum = tl_hull_checksum(h, h->bytes);
    assert_int_equal(talus_hull_validate(h, h->bytes), TALUS_BAD_BLOB);
    table[7] = (uint16_t)(was ? was - 1u : 1u); /* worse, but a vertex */
    h->checksum = tl_hull_checksum(h, h->bytes);
    assert_int_equal(talus_hull_validate(h, h->bytes), TALUS_OK);
}

int main(void) {
    brute_seed("hull_climb_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(climbs), cmocka_unit_test(corners), cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
