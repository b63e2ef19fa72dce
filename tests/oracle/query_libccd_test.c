/* talus_penetration and talus_distance against libccd on hulls and boxes: whether they overlap, by its MPR, and the
 * depth of its GJK and EPA, which is a way out where its direction does part the shapes, and so never less than the
 * proven. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "ccd_kit.h"
#include "talus/query.h"

static talus_convex convex_of(const tl_convex *s) {
    talus_convex c;
    talus_geometry g = s->geometry;
    g.hull = 0u;
    assert_int_equal(talus_convex_init(&g, s->hull, s->hull ? talus_hull_size(s->hull) : 0u, &c), TALUS_OK);
    return c;
}

static void random_pairs(void **state) {
    (void)state;
    int overlaps = 0, compared = 0, alike = 0;
    for (int i = 0; i < 3000; ++i) {
        uint64_t seed = brute_state;
        tl_convex a = brute_shape(i & 1 ? BRUTE_HULL : BRUTE_BOX, 0.3f, 1.0f);
        tl_convex b = brute_shape(i & 2 ? BRUTE_HULL : BRUTE_BOX, 0.3f, 1.0f);
        talus_convex ca = convex_of(&a), cb = convex_of(&b);
        talus_pose here = tl_pose_identity(), there = brute_pose(0.1f, 2.2f);
        placed pa = {&a, d_pose_of(&here)}, pb = {&b, d_pose_of(&there)};
        d_pair pair = {&a, &b, pb.pose};
        ccd_t ccd = ccd_settings(1e-6, 1e-7);
        talus_separation s;
        talus_depth d;
        assert_int_equal(talus_distance(&ca, &here, &cb, &there, NULL, &s), TALUS_OK);
        assert_int_equal(talus_penetration(&ca, &here, &cb, &there, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
        assert_int_equal(s.overlap, d.overlap);
        int overlap = ccdMPRIntersect(&pa, &pb, &ccd);
        if (overlap != s.overlap && (s.distance > 1e-4f || d.depth > 1e-4f)) {
            printf("  seed %llu: distance %g depth %g, libccd says %d\n", (unsigned long long)seed, (double)s.distance,
                   (double)d.depth, overlap);
            fail();
        }
        ccd_real_t depth;
        ccd_vec3_t dir, pos;
        if (!s.overlap || d.depth < 1e-3f || ccdGJKPenetration(&pa, &pb, &ccd, &depth, &dir, &pos) != 0) {
            continue;
        }
        ++overlaps;
        d3 n = d3_make(ccdVec3X(&dir), ccdVec3Y(&dir), ccdVec3Z(&dir));
        if (fabs(d3_length(n) - 1.0) < 1e-6) {
            double out = -d_separation(&pair, n);
            ++compared;
            alike += fabs(out - (double)d.depth) <= 1e-4;
            assert_true((double)d.depth <= out + 4e-6);
        }
    }
    printf("  %d overlaps, %d depths compared, %d alike\n", overlaps, compared, alike);
    assert_true(compared > 500);
    assert_true(alike * 100 > compared * 90);
}

int main(void) {
    brute_seed("query_libccd_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_pairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
