/* Penetration depth against the enumeration of all features in double: the proven one is the least; the local one is a
 * way out along its normal, no less, and from a cold start the least in all of a thousand but one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide/gauss_walk.h"
#include "query_kit.h"

#define POOL 48
static tl_convex pool[POOL];

enum { ROUND, BOXES, PLATES, RODS, ROUNDED, DEEP, CONTAINED, FAMILIES };
static const char *const family_name[FAMILIES] = {"ellipsoids", "boxes", "plates",   "rods",
                                                  "swollen",    "deep",  "contained"};

/* Plates and rods are up to a hundred times as long as they are thin; of what is contained every other is up to thirty
 * times smaller. */
static void build_pool(int family, uint32_t most) {
    for (int i = 0; i < POOL; ++i) {
        float thin = kit_power(-2.0f, -0.5f);
        talus_vec3 scale = brute_vector(0.5f, 1.0f);
        uint32_t count = (uint32_t)(4.0f * powf((float)most / 4.0f, brute_range(0.0f, 1.0f)));
        talus_geometry *g = &pool[i].geometry;
        memset(&pool[i], 0, sizeof pool[i]);
        if (family == PLATES) {
            scale.z = thin;
        } else if (family == RODS) {
            scale = tl_v(1.0f, thin * brute_range(1.0f, 2.0f), thin);
        } else if (family == CONTAINED && i % 2) {
            scale = tl_scale(scale, kit_power(-1.5f, -0.5f));
        }
        if (family == ROUNDED && i % 3 == 0) {
            g->type = TALUS_SPHERE;
            g->radius = 0.3f;
        } else if (family == ROUNDED && i % 3 == 1) {
            g->type = TALUS_CAPSULE;
            g->half_height = 0.7f;
            g->radius_top = g->radius_bottom = 0.2f;
        } else if (family == BOXES || ((family == PLATES || family == RODS) && i % 4 == 0)) {
            g->type = TALUS_BOX;
            g->half = scale;
        } else {
            g->type = TALUS_HULL;
            pool[i].hull = brute_hull(count, scale);
        }
    }
}

static double along(const kit_pair *p, tl_d3 n) {
    d_pair pair = {p->a, p->b, d_pose_of(&p->pose)};
    return -d_separation(&pair, d3_make(n.x, n.y, n.z));
}

typedef struct tally {
    int overlaps, least, warm_least;
    double worst, over;
    unsigned long long local_looks, warm_looks, proof_looks;
} tally;

static double depth_of(const kit_pair *p, const tl_polytope *a, const tl_polytope *b) {
    double separation;
    d3 at;
    assert_true(d_exact_separation(p->a, p->b, &p->pose, &separation, &at));
    return -separation - (double)a->radius - (double)b->radius; /* of the cores */
}

static int is_least(const tl_gauss_depth *d, double expected) { return d->value <= expected * 1.0001; }

/* The features are what the answer says: from them the same depth is found, and a little further on the way as well. */
static void go_on(kit_pair *p, tl_gauss_pair *pair, const tl_gauss_depth *proven, tally *t) {
    talus_feature_pair again = {proven->feature_a, proven->feature_b};
    tl_gauss_depth warm;
    tl_d3 pa, pb;
    tl_gauss_start(pair, again, &warm);
    assert_true(fabs(warm.value - proven->value) <= 1e-7 * p->size); /* faces are flat to about 1e-6 */
    tl_gauss_points(pair, proven, &pa, &pb);
    tl_d3 gap = tl_d_sub(tl_d_sub(pa, pb), tl_d_scale(proven->n, proven->value));
    assert_true(tl_d_length(gap) <= 2e-6 * p->size);
    kit_nudge(p, 0.017f); /* a degree */
    tl_frame frame = tl_frame_of(&p->pose);
    tl_gauss_pair moved = {pair->a, pair->b, &frame, 0};
    tl_gauss_start(&moved, again, &warm);
    tl_gauss_descend(&moved, &warm);
    double expected = depth_of(p, pair->a, pair->b);
    t->warm_looks += moved.supports;
    t->warm_least += expected <= 1e-6 * p->size || is_least(&warm, expected);
}

static void one(kit_pair *p, uint64_t seed, tally *t) {
    static tl_polytope a, b;
    tl_polytope_init(&a, p->a);
    tl_polytope_init(&b, p->b);
    if (a.face_count + b.face_count == 0u) {
        return;
    }
    double expected = depth_of(p, &a, &b);
    if (!(expected > 1e-6 * p->size)) {
        return;
    }
    ++t->overlaps;
    tl_frame frame = tl_frame_of(&p->pose);
    tl_gauss_pair pair = {&a, &b, &frame, 0};
    talus_feature_pair none = {0, 0};
    tl_gauss_depth local, proven;
    tl_gauss_start(&pair, none, &local);
    tl_gauss_descend(&pair, &local);
    t->local_looks += pair.supports;
    double way_out = along(p, local.n) - (double)a.radius - (double)b.radius;
    if (!(local.value >= expected - 1e-6 * p->size) || fabs(local.value - way_out) > 1e-9) {
        printf("  seed %llu: local %.9g, along its normal %.9g, least %.9g\n", (unsigned long long)seed, local.value,
               way_out, expected);
        assert_true(0);
    }
    t->least += is_least(&local, expected);
    t->over = fmax(t->over, local.value / expected);
    /* from the worst start: the proof must find its way by itself */
    tl_gauss_look(&pair, tl_d_scale(local.n, -1.0), local.ia, local.ib, &proven);
    pair.supports = 0;
    int proved = tl_gauss_prove(&pair, &proven);
    t->proof_looks += pair.supports;
    double error = fabs(proven.value - expected) - 1e-6 * expected;
    t->worst = fmax(t->worst, error / p->size);
    if (!proved || error > 1e-6 * p->size) {
        printf("  seed %llu: %s %.9g, least %.9g of size %g\n", (unsigned long long)seed,
               proved ? "proven" : "unproven", proven.value, expected, p->size);
        assert_true(0);
    }
    go_on(p, &pair, &proven, t);
}

static void against_all(int family, uint32_t most, int count) {
    tally t;
    memset(&t, 0, sizeof t);
    build_pool(family, most);
    for (int i = 0; t.overlaps < count && i < 100 * count; ++i) {
        uint64_t seed = brute_state;
        kit_pair p;
        p.a = &pool[brute_u32() % POOL];
        p.b = &pool[brute_u32() % POOL];
        p.size = d_size(p.a) + d_size(p.b);
        p.family = 0;
        float far = (float)p.size * (family == DEEP || family == CONTAINED ? 0.15f : brute_range(0.05f, 1.0f));
        p.pose = brute_pose(0.0f, far);
        one(&p, seed, &t);
    }
    double n = (double)t.overlaps;
    printf("  %-10s to %3u vertices: %d overlaps, cold local least in %.3f%% (at most %.4g times it), warm in %.1f%%;\n"
           "    proven off by %.1g of the sizes; looked along %.1f, %.1f and %.0f directions\n",
           family_name[family], most, t.overlaps, 100.0 * t.least / n, t.over, 100.0 * t.warm_least / n, t.worst,
           (double)t.local_looks / n, (double)t.warm_looks / n, (double)t.proof_looks / n);
    assert_int_equal(t.overlaps, count);
    assert_true((t.overlaps - t.least) * 1000 <= t.overlaps);
    assert_true(t.warm_least * 100 > t.overlaps * 75);
}

static void every_family(void **state) {
    (void)state;
    const char *text = getenv("TALUS_QUERY_OVERLAPS");
    int count = text ? atoi(text) / FAMILIES : 100;
    for (int family = 0; family < FAMILIES; ++family) {
        against_all(family, text ? 100u : 40u, count);
    }
}

static void large(void **state) {
    (void)state;
    against_all(ROUND, 80u, 20);
}

int main(void) {
    brute_seed("gauss_walk_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_family), cmocka_unit_test(large)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
