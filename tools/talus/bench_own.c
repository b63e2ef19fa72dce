/* The library's own queries as `talus bench queries` asks them. */
#include "bench_queries.h"

#include "collide/gjk.h"
#include "collide/polytope.h"

static const talus_pose here = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

static void forget(const bench_case *c, talus_feature_pair *features) {
    if (c->degrees == BENCH_RANDOM) {
        features->a = features->b = 0u;
    }
}

static void vclip(const bench_case *c, uint32_t count, double *answers) {
    talus_feature_pair features = {0u, 0u};
    talus_separation s;
    for (uint32_t i = 0; i < count; i++) {
        forget(c, &features);
        (void)talus_distance(&c->a, &here, &c->b, &c->poses[i], &features, &s);
        answers[i] = (double)s.distance;
    }
}

/* The vertices of the last simplex where they are now. */
static void renew(tl_simplex *simplex, const tl_core *a, const tl_core *b) {
    for (uint32_t i = 0; i < simplex->count; i++) {
        simplex->vertex[i].a = tl_core_vertex(a, simplex->vertex[i].ia);
        simplex->vertex[i].b = tl_core_vertex(b, simplex->vertex[i].ib);
    }
}

static void gjk(const bench_case *c, uint32_t count, double *answers) {
    tl_simplex simplex;
    tl_gjk near;
    tl_core a, b;
    simplex.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        tl_core_init(&a, &c->shape_a, NULL);
        tl_core_init(&b, &c->shape_b, &c->poses[i]);
        if (c->degrees == BENCH_RANDOM) {
            simplex.count = 0;
        }
        renew(&simplex, &a, &b);
        talus_vec3 guess = tl_normalize_or(b.t, tl_v(0.0f, 1.0f, 0.0f));
        int apart = tl_gjk_run(&a, &b, guess, 3e38f, &simplex, &near) == TL_GJK_APART;
        answers[i] = apart ? (double)near.distance : 0.0;
    }
}

static void all_distances(const bench_case *c, uint32_t count, double *answers) {
    for (uint32_t i = 0; i < count; i++) {
        answers[i] = bench_distance_by_all(c, i);
    }
}

static void penetration(const bench_case *c, talus_depth_mode mode, uint32_t count, double *answers) {
    talus_feature_pair features = {0u, 0u};
    talus_depth d;
    for (uint32_t i = 0; i < count; i++) {
        forget(c, &features);
        (void)talus_penetration(&c->a, &here, &c->b, &c->poses[i], mode, &features, &d);
        answers[i] = (double)d.depth;
    }
}

static void walk(const bench_case *c, uint32_t count, double *answers) {
    penetration(c, TALUS_DEPTH_LOCAL, count, answers);
}

static void proven(const bench_case *c, uint32_t count, double *answers) {
    penetration(c, TALUS_DEPTH_PROVEN, count, answers);
}

static void epa(const bench_case *c, uint32_t count, double *answers) {
    tl_simplex simplex;
    tl_gjk near;
    tl_depth depth;
    tl_core a, b;
    for (uint32_t i = 0; i < count; i++) {
        tl_core_init(&a, &c->shape_a, NULL);
        tl_core_init(&b, &c->shape_b, &c->poses[i]);
        simplex.count = 0;
        talus_vec3 guess = tl_normalize_or(b.t, tl_v(0.0f, 1.0f, 0.0f));
        (void)tl_gjk_run(&a, &b, guess, 3e38f, &simplex, &near);
        tl_epa_run(&a, &b, &simplex, &depth);
        answers[i] = (double)depth.depth;
    }
}

static void all_depths(const bench_case *c, uint32_t count, double *answers) {
    for (uint32_t i = 0; i < count; i++) {
        answers[i] = bench_depth(c, i);
    }
}

const bench_method bench_own_methods[] = {{"vclip", "V-Clip", 0, 0, UINT32_MAX, vclip},
                                          {"gjk", "GJK", 0, 0, UINT32_MAX, gjk},
                                          {"all-distances", "all features", 0, 0, 100, all_distances},
                                          {"gauss-walk", "Gauss walk", 1, 0, UINT32_MAX, walk},
                                          {"gauss-proven", "Gauss walk, proven", 1, 0, UINT32_MAX, proven},
                                          {"epa", "EPA", 1, 0, UINT32_MAX, epa},
                                          {"all-depths", "all features", 1, 0, 100, all_depths}};
const int bench_own_count = (int)(sizeof bench_own_methods / sizeof *bench_own_methods);
