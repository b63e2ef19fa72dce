/* Closest features: proven for each pair by the answer itself. Points of both shapes that are as far apart as the
 * distance bound it from above, and the separation along its normal, over all vertices and in double, from below; an
 * overlap is a point in both. Small pairs also against the enumeration of all features. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "query_kit.h"

/* Parts of the sizes: the faces of a hull are flat, and its planes rounded, to about this. */
#define FLOOR 1e-6

typedef struct tally {
    long queries, overlaps, gave_up, wrong, near;
    double worst; /* error beyond 1e-5 of the distance, in parts of the sizes */
    double off;   /* how far points are off their shapes, likewise */
    unsigned long long steps;
} tally;

static d3 to_d3(tl_d3 v) { return d3_make(v.x, v.y, v.z); }

/* Checks one answer; its error beyond the relative one goes to the tally. */
static void check(const kit_pair *p, const tl_closest *c, tally *t, uint64_t seed) {
    d_pair pair = {p->a, p->b, d_pose_of(&p->pose)};
    d3 pa = to_d3(c->point_a), pb = to_d3(c->point_b);
    double off_a = d_outside(p->a, pa), off_b = d_outside(p->b, d_rotate_back(&pair.pose, d3_sub(pb, pair.pose.t)));
    double off = fmax(off_a, off_b) / p->size, error = 0.0;
    if (off > FLOOR) { /* if not worse than the shapes' own vertices */
        off_a = kit_outside(p->a, pa), off_b = kit_outside(p->b, d_rotate_back(&pair.pose, d3_sub(pb, pair.pose.t)));
        off = fmax(off_a, off_b) / p->size;
    }
    ++t->queries;
    t->steps += c->steps;
    t->gave_up += (long)c->gave_up;
    if (c->cores_apart) {
        double low = d_separation(&pair, to_d3(c->normal));
        double high = d3_dot(to_d3(c->normal), d3_sub(pb, pa));
        error = fmax(fabs(c->gap - low), fabs(c->gap - high));
        if (c->apart) {
            error = fmax(error, fabs(d3_length(d3_sub(pb, pa)) - c->gap));
        }
        error = fmax(0.0, error - 1e-5 * fabs(c->gap)) / p->size;
    } else {
        ++t->overlaps;
    }
    t->worst = fmax(t->worst, error);
    t->off = fmax(t->off, off);
    if (error > FLOOR || off > FLOOR) {
        if (t->wrong++ < 10) {
            printf("  %s: seed %llu: gap %.9g size %g: error %.3g, points off by %.3g, steps %u%s\n",
                   kit_family_name[p->family], (unsigned long long)seed, c->gap, p->size, error, off, c->steps,
                   c->gave_up ? " gave up" : "");
        }
    }
}

static void find(const kit_pair *p, talus_feature_pair features, tl_closest *c) {
    tl_polytope a, b;
    tl_polytope_init(&a, p->a);
    tl_polytope_init(&b, p->b);
    tl_frame frame = tl_frame_of(&p->pose);
    tl_closest_find(&a, &b, &frame, features, c);
}

static void random_pairs(void **state) {
    (void)state;
    const char *text = getenv("TALUS_QUERY_PAIRS");
    long pairs = text ? atol(text) : 20000;
    tally cold[KIT_FAMILIES], warm[KIT_FAMILIES];
    memset(cold, 0, sizeof cold);
    memset(warm, 0, sizeof warm);
    for (long i = 0; i < pairs; ++i) {
        uint64_t seed = brute_state;
        talus_feature_pair none = {0, 0};
        tl_closest c;
        kit_pair p = kit_draw();
        find(&p, none, &c);
        check(&p, &c, &cold[p.family], seed);
        kit_nudge(&p, 0.017f);
        find(&p, c.features, &c);
        check(&p, &c, &warm[p.family], seed);
    }
    long wrong = 0, gave_up = 0;
    for (int f = 0; f < KIT_FAMILIES; ++f) {
        for (int k = 0; k < 2; ++k) {
            const tally *t = k ? &warm[f] : &cold[f];
            printf("  %-8s %s: %ld queries, %ld cores meet, %.2f steps, %ld by GJK, error %.2g, points off %.2g\n",
                   kit_family_name[f], k ? "warm" : "cold", t->queries, t->overlaps,
                   (double)t->steps / (double)(t->queries ? t->queries : 1), t->gave_up, t->worst, t->off);
            wrong += t->wrong;
            gave_up += t->gave_up;
        }
    }
    assert_int_equal(wrong, 0);
    assert_true(gave_up * 1000 < pairs);
}

/* Small shapes against the greatest separation over every pair of features. */
static void enumerated(void **state) {
    (void)state;
    double worst = 0.0;
    int apart = 0;
    for (int i = 0; i < 400; ++i) {
        static const int kinds[4] = {BRUTE_SPHERE, BRUTE_CAPSULE, BRUTE_BOX, BRUTE_HULL};
        int ka = kinds[brute_u32() & 3u], kb = kinds[brute_u32() & 3u];
        tl_convex a = brute_shape(ka, 0.3f, 1.0f), b = brute_shape(kb, 0.3f, 1.0f);
        kit_pair p = {&a, &b, brute_pose(0.5f, 3.0f), 0.0, 0};
        talus_feature_pair none = {0, 0};
        double expected;
        d3 at;
        tl_closest c;
        if (!d_exact_separation(&a, &b, &p.pose, &expected, &at)) {
            continue;
        }
        find(&p, none, &c);
        if (c.cores_apart) {
            ++apart;
            worst = fmax(worst, fabs(c.gap - expected));
        } else {
            assert_true(expected < 1e-6);
        }
    }
    printf("  %d pairs apart of 400, worst error %.2g m\n", apart, worst);
    assert_true(apart > 200);
    assert_true(worst < 2e-6);
}

/* Whatever the hint, the answer is that of a cold start; from where a search ended no step is taken. */
static void hints(void **state) {
    (void)state;
    for (int i = 0; i < 3000; ++i) {
        kit_pair p = kit_draw();
        talus_feature_pair hint = {0, 0}, noise;
        tl_closest warm, cold;
        uint32_t bits = brute_u32();
        noise.a = (bits & 0xffu) % 5u << 16 | (bits >> 8 & 0x1ffu);
        bits = brute_u32();
        noise.b = (bits & 0xffu) % 5u << 16 | (bits >> 8 & 0x1ffu);
        find(&p, hint, &cold);
        find(&p, noise, &warm);
        /* an overlap no deeper than the floor may be seen or not */
        double slack = 1e-5 * fabs(cold.gap) + 2.0 * FLOOR * p.size;
        assert_true(cold.cores_apart != warm.cores_apart || fabs(cold.gap - warm.gap) <= slack);
        if (cold.cores_apart != warm.cores_apart) {
            assert_true(fmax(cold.gap, warm.gap) <= slack);
        }
        find(&p, cold.features, &warm);
        if (!cold.gave_up) {
            assert_int_equal(warm.steps, 0);
            assert_memory_equal(&warm.features, &cold.features, sizeof warm.features);
        }
    }
}

int main(void) {
    brute_seed("vclip_test");
    kit_build();
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_pairs), cmocka_unit_test(enumerated),
                                       cmocka_unit_test(hints)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
