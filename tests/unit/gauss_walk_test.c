/* Penetration depth against the enumeration of all features in double: the proven one is the least; the local one is a
 * way out along its normal and no less, and how often it is the least is printed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide/gauss_walk.h"
#include "query_kit.h"

#define POOL 48
static tl_convex pool[POOL];

static void build_pool(int most) {
    for (int i = 0; i < POOL; ++i) {
        float thin = kit_power(-3.0f, 0.0f);
        talus_vec3 scale = i % 2 ? tl_v(1.0f, tl_max(thin, 0.3f), thin) : brute_vector(0.5f, 1.0f);
        memset(&pool[i], 0, sizeof pool[i]);
        talus_geometry *g = &pool[i].geometry;
        if (i % 12 == 0) {
            g->type = TALUS_SPHERE;
            g->radius = 0.3f;
        } else if (i % 12 == 1) {
            g->type = TALUS_CAPSULE;
            g->half_height = 0.7f;
            g->radius_top = g->radius_bottom = 0.2f;
        } else if (i % 4 == 0) {
            g->type = TALUS_BOX;
            g->half = scale;
        } else {
            g->type = TALUS_HULL;
            pool[i].hull = brute_hull(4u + brute_u32() % (uint32_t)(most - 4), scale);
        }
    }
}

static double along(const kit_pair *p, tl_d3 n) {
    d_pair pair = {p->a, p->b, d_pose_of(&p->pose)};
    return -d_separation(&pair, d3_make(n.x, n.y, n.z));
}

static void against_all(int most, int count) {
    int overlaps = 0, least = 0, warm_least = 0;
    double worst = 0.0, over = 0.0;
    unsigned long long local_looks = 0, proof_looks = 0;
    build_pool(most);
    for (int i = 0; i < count; ++i) {
        static tl_polytope a, b;
        const tl_convex *sa = &pool[brute_u32() % POOL], *sb = &pool[brute_u32() % POOL];
        kit_pair p = {sa, sb, brute_pose(0.0f, 0.9f), 0.0, 0};
        double expected;
        d3 at;
        uint64_t seed = brute_state;
        tl_polytope_init(&a, p.a);
        tl_polytope_init(&b, p.b);
        p.size = d_size(p.a) + d_size(p.b);
        if (a.face_count + b.face_count == 0u || !d_exact_separation(p.a, p.b, &p.pose, &expected, &at)) {
            continue;
        }
        expected = -expected - (double)a.radius - (double)b.radius; /* of the cores */
        if (!(expected > 0.0)) {
            continue;
        }
        ++overlaps;
        tl_frame frame = tl_frame_of(&p.pose);
        tl_gauss_pair pair = {&a, &b, &frame, 0};
        talus_feature_pair none = {0, 0};
        tl_gauss_depth local, proven, warm;
        tl_gauss_start(&pair, none, &local);
        tl_gauss_descend(&pair, &local);
        local_looks += pair.supports;
        double way_out = along(&p, local.n) - (double)a.radius - (double)b.radius;
        if (!(local.value >= expected - 1e-6 * p.size) || fabs(local.value - way_out) > 1e-9) {
            printf("  seed %llu: local %.9g, along its normal %.9g, least %.9g\n", (unsigned long long)seed,
                   local.value, way_out, expected);
            assert_true(0);
        }
        least += local.value <= expected * 1.00001 + 2e-6 * p.size;
        over = fmax(over, local.value / expected);
        proven = local;
        pair.supports = 0;
        int proved = tl_gauss_prove(&pair, &proven);
        proof_looks += pair.supports;
        double error = fabs(proven.value - expected) - 1e-6 * expected;
        worst = fmax(worst, error / p.size);
        if (!proved || error > 1e-6 * p.size) {
            printf("  seed %llu: %s %.9g, least %.9g of size %g\n", (unsigned long long)seed,
                   proved ? "proven" : "unproven", proven.value, expected, p.size);
            assert_true(0);
        }
        /* the features are what the answer says: from them the same depth is found */
        talus_feature_pair again = {proven.feature_a, proven.feature_b};
        tl_gauss_start(&pair, again, &warm);
        assert_true(fabs(warm.value - proven.value) <= 1e-9);
        tl_d3 pa, pb;
        tl_gauss_points(&pair, &proven, &pa, &pb);
        tl_d3 gap = tl_d_sub(tl_d_sub(pa, pb), tl_d_scale(proven.n, proven.value));
        assert_true(tl_d_length(gap) <= 2e-6 * p.size);
        /* a step of a degree */
        kit_nudge(&p, 0.017f);
        frame = tl_frame_of(&p.pose);
        tl_gauss_start(&pair, again, &warm);
        tl_gauss_descend(&pair, &warm);
        (void)d_exact_separation(p.a, p.b, &p.pose, &expected, &at);
        expected = -expected - (double)a.radius - (double)b.radius;
        warm_least += expected <= 0.0 || warm.value <= expected * 1.00001 + 2e-6 * p.size;
    }
    printf("  up to %d vertices: %d overlaps; local least in %.1f%% from cold (at most %.3g times it), in %.1f%% a\n"
           "  degree after the least; proven ones off by %.2g of the sizes; %.1f and %.0f directions looked along\n",
           most, overlaps, 100.0 * least / overlaps, over, 100.0 * warm_least / overlaps, worst,
           (double)local_looks / overlaps, (double)proof_looks / overlaps);
    assert_true(overlaps * 4 > count);
    assert_true(warm_least * 100 > overlaps * 90);
}

static void small(void **state) {
    (void)state;
    against_all(20, 1500);
}

static void middling(void **state) {
    (void)state;
    against_all(80, 40);
}

int main(void) {
    brute_seed("gauss_walk_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(small), cmocka_unit_test(middling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
