/* Against libccd on random pairs: whether they overlap (its MPR), and the depth (its GJK and EPA, its MPR). A depth of
 * libccd's that does part the shapes must not be less than ours, and EPA's of boxes and hulls must be the same but for
 * the few where it stops early. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "ccd_kit.h"

static int failures, overlaps, compared, flat, agreed;

static void complain(const char *what, int ka, int kb, uint64_t seed, double ours, double theirs) {
    if (failures++ < 20) {
        printf("  %s: %s-%s seed %llu: %.9g, libccd %.9g\n", what, brute_kind_name[ka], brute_kind_name[kb],
               (unsigned long long)seed, ours, theirs);
    }
}

static void compare(int ka, int kb) {
    uint64_t seed = brute_state;
    tl_convex a = brute_shape(ka, 0.3f, 1.0f), b = brute_shape(kb, 0.3f, 1.0f);
    talus_pose pose = brute_pose(0.1f, 2.2f), identity = tl_pose_identity();
    placed pa = {&a, d_pose_of(&identity)}, pb = {&b, d_pose_of(&pose)};
    ccd_t ccd = ccd_settings(1e-5, 1e-6);
    tl_pair_cache cache = {{0, 0, 0, 0}};
    tl_manifold m;
    tl_collide(&a, &b, &pose, 10.0f, &cache, &m);
    assert_true(m.count > 0);
    double ours = 1e300;
    for (uint32_t i = 0; i < m.count; ++i) {
        ours = fmin(ours, (double)m.point[i].separation);
    }
    int overlap = ccdMPRIntersect(&pa, &pb, &ccd);
    if (fabs(ours) > 2e-3 && overlap != (ours < 0.0)) {
        complain("overlap", ka, kb, seed, ours, (double)overlap);
    }
    if (!overlap || ours > -2e-3) {
        return;
    }
    ++overlaps;
    d_pair pair;
    pair.a = &a;
    pair.b = &b;
    pair.pose = pb.pose;
    for (int method = 0; method < 2; ++method) {
        ccd_real_t depth = 0.0;
        ccd_vec3_t dir, pos;
        int got = method ? ccdMPRPenetration(&pa, &pb, &ccd, &depth, &dir, &pos)
                         : ccdGJKPenetration(&pa, &pb, &ccd, &depth, &dir, &pos);
        if (got != 0) {
            continue;
        }
        d3 n = d3_make(ccdVec3X(&dir), ccdVec3Y(&dir), ccdVec3Z(&dir));
        if (!(fabs(d3_length(n) - 1.0) < 1e-6)) {
            continue;
        }
        double proven = -d_separation(&pair, n); /* moving along n by this parts them */
        ++compared;
        if (-ours > proven + 1e-4 + 1e-3 * proven) {
            complain("deeper than a way out", ka, kb, seed, -ours, proven);
        }
        if (method == 0 && ka >= BRUTE_BOX && kb >= BRUTE_BOX) {
            ++flat;
            agreed += fabs(proven + ours) <= 1e-3;
        }
    }
}

static void random_pairs(void **state) {
    (void)state;
    failures = overlaps = compared = flat = agreed = 0;
    for (int ka = 0; ka < BRUTE_KINDS; ++ka) {
        for (int kb = 0; kb < BRUTE_KINDS; ++kb) {
            for (int i = 0; i < 100; ++i) {
                compare(ka, kb);
            }
        }
    }
    printf("  %d overlaps, %d depths compared; %d of %d alike of boxes and hulls\n", overlaps, compared, agreed, flat);
    assert_int_equal(failures, 0);
    assert_true(compared > overlaps);
    assert_true(agreed * 100 > flat * 90);
}

int main(void) {
    brute_seed("collide_libccd_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_pairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
