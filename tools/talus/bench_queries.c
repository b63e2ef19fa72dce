/* Takes the table of `talus bench queries`: hulls, their motions, and the times and errors of every method. */
#include "bench_queries.h"

#include "base/vec.h"
#include "figures.h"
#include "host/clock.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POSES 500u /* of a trip */
#define TRIPS 4u   /* of other hulls' sides each */
#define MOST_RUNS 9u
#define REFERENCES 10u       /* poses of a trip whose answers are compared */
#define MOST_ENUMERATED 500u /* vertices up to which depths are compared with all features */
#define SHORT 3e6            /* ns of a run */
#define PI 3.14159265358979323846

static const uint32_t full_vertices[] = {8, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};
static const uint32_t quick_vertices[] = {8, 50};
static const double full_degrees[] = {0.01, 0.1, 1.0, 10.0, BENCH_RANDOM};
static const double quick_degrees[] = {1.0, BENCH_RANDOM};

typedef struct plan {
    const uint32_t *vertices;
    const double *degrees;
    uint32_t vertex_counts, degree_counts, runs;
    double budget; /* ns of one method in one run */
} plan;

/* --- what is asked --- */

static uint32_t draw_bits(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    uint32_t x = (uint32_t)(*state >> 32);
    return x ^ x >> 15;
}

static double draw(uint64_t *state) { return (double)draw_bits(state) / 2147483647.5 - 1.0; }

static talus_vec3 draw_direction(uint64_t *state) {
    for (;;) {
        double x = draw(state);
        double y = draw(state);
        double z = draw(state);
        double r2 = x * x + y * y + z * z, r = sqrt(r2);
        if (r2 > 0.01 && r2 < 1.0) {
            return tl_v((float)(x / r), (float)(y / r), (float)(z / r));
        }
    }
}

static talus_quat draw_rotation(uint64_t *state) {
    talus_vec3 axis = draw_direction(state);
    double half = PI * 0.5 * (draw(state) + 1.0);
    talus_quat q = {axis.x * (float)sin(half), axis.y * (float)sin(half), axis.z * (float)sin(half), (float)cos(half)};
    return q;
}

static void *aligned(void *memory) {
    return (char *)memory + (TALUS_BLOB_ALIGNMENT - (uintptr_t)memory % TALUS_BLOB_ALIGNMENT);
}

/* The hull of points of an ellipsoid, in *memory, which the caller frees; null for a lack of memory. */
static talus_hull *make_hull(uint32_t vertices, talus_vec3 scale, uint64_t *state, void **memory) {
    size_t scratch_size = talus_hull_scratch_size(vertices), most = talus_hull_max_size(vertices), size = 0;
    talus_vec3 *points = malloc(vertices * sizeof *points);
    void *scratch = malloc(scratch_size + TALUS_BLOB_ALIGNMENT);
    talus_hull *hull = NULL;
    *memory = malloc(most + TALUS_BLOB_ALIGNMENT);
    for (uint32_t i = 0; points != NULL && i < vertices; i++) {
        points[i] = tl_mul(draw_direction(state), scale);
    }
    if (points != NULL && scratch != NULL && *memory != NULL &&
        talus_hull_build(points, vertices, aligned(scratch), scratch_size, aligned(*memory), most, &size) == TALUS_OK) {
        hull = aligned(*memory);
    }
    free(points);
    free(scratch);
    return hull;
}

static void take_hull(talus_hull *hull, talus_convex *convex, tl_convex *shape) {
    memset(convex, 0, sizeof *convex);
    convex->geometry.type = TALUS_HULL;
    convex->hull = hull;
    shape->geometry = convex->geometry;
    shape->hull = hull;
}

/* B turns about an axis that itself wanders. */
static void make_trip(bench_case *c, uint64_t *state, talus_pose *poses) {
    talus_vec3 axis = draw_direction(state), place = draw_direction(state);
    talus_quat turn = draw_rotation(state);
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->degrees == BENCH_RANDOM) {
            turn = draw_rotation(state);
            place = draw_direction(state);
        } else {
            float half = (float)(c->degrees * PI / 360.0), s = sinf(half);
            talus_quat step = {axis.x * s, axis.y * s, axis.z * s, cosf(half)};
            turn = tl_quat_normalize(tl_quat_mul(step, turn));
            talus_vec3 aside = draw_direction(state);
            axis = tl_normalize_or(tl_mad(axis, 0.2f * half, aside), axis);
        }
        poses[i].rotation = turn;
        poses[i].position = tl_scale(place, c->overlapping ? 0.35f : 2.3f);
    }
}

/* --- times --- */

/* All trips, `queries` of each, whose answers come POSES apart; ns a query. */
static double time_of(const bench_method *m, const bench_case *c, uint32_t queries, double *answers) {
    uint64_t spent = 0;
    for (uint32_t trip = 0; trip < TRIPS; trip++) {
        bench_case one = *c;
        one.poses = c->poses + trip * POSES;
        uint64_t begin = host_clock_ns();
        m->run(&one, queries, answers + trip * POSES);
        spent += host_clock_ns() - begin;
    }
    return (double)spent / (double)(queries * TRIPS);
}

/* As many queries as fit into the budget, by trying ever more. */
static uint32_t fit(const bench_method *m, const bench_case *c, double budget, double *answers) {
    uint32_t queries = 4;
    while (queries < c->count) {
        double ns = time_of(m, c, queries, answers) * (double)(queries * TRIPS);
        if (ns * 4.0 > budget) {
            break;
        }
        queries = queries * 4u < c->count ? queries * 4u : c->count;
    }
    return queries;
}

static double reference(const bench_case *c, uint32_t pose) {
    if (!c->overlapping) {
        return bench_distance(c, pose);
    }
    if (c->vertices <= MOST_ENUMERATED) {
        return bench_depth(c, pose);
    }
    static const talus_pose here = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    talus_depth d;
    (void)talus_penetration(&c->a, &here, &c->b, &c->poses[pose], TALUS_DEPTH_PROVEN, NULL, &d);
    return (double)d.depth;
}

/* Of the answers to poses spread over those that were asked about. */
static void take_errors(const bench_case *c, double *known, const double *answers, bench_row *row) {
    uint32_t stride = row->queries > REFERENCES ? row->queries / REFERENCES : 1u, compared = 0;
    double sum = 0.0;
    for (uint32_t k = 0; k < TRIPS * row->queries; k += stride) {
        uint32_t i = k / row->queries * POSES + k % row->queries;
        if (known[i] < 0.0) {
            known[i] = reference(c, i);
        }
        if (!(known[i] > 0.0)) {
            continue; /* hulls of few points may miss one another after all */
        }
        double error = fabs(answers[i] - known[i]) / known[i];
        if (row->method->yes_or_no) {
            error = answers[i] != (double)c->overlapping ? 1.0 : 0.0;
        }
        sum += error;
        compared++;
        row->most_error = error > row->most_error ? error : row->most_error;
    }
    row->mean_error = compared > 0 ? sum / (double)compared : 0.0;
    if (row->method->yes_or_no) {
        row->most_error = row->mean_error;
    }
}

static void take_case(bench_table *table, const bench_case *c, const plan *p, double *room) {
    const bench_method *methods[BENCH_MOST_METHODS];
    double *known = room, *answers = room + TRIPS * POSES, times[BENCH_MOST_METHODS][MOST_RUNS];
    uint32_t queries[BENCH_MOST_METHODS];
    int count = 0;
    for (int i = 0; i < bench_own_count + bench_ccd_count; i++) {
        const bench_method *m = i < bench_own_count ? &bench_own_methods[i] : &bench_ccd_methods[i - bench_own_count];
        if (m->overlapping == c->overlapping && c->vertices <= m->most) {
            methods[count++] = m;
        }
    }
    for (int i = 0; i < count; i++) {
        queries[i] = fit(methods[i], c, p->budget, answers);
    }
    /* the methods take turns, so that a mood of the machine meets all of them */
    for (uint32_t run = 0; run < p->runs; run++) {
        for (int i = 0; i < count; i++) {
            double ns = time_of(methods[i], c, queries[i], answers);
            if (ns * (double)(queries[i] * TRIPS) < SHORT) { /* once more, with the hulls in the caches */
                double again = time_of(methods[i], c, queries[i], answers);
                ns = again < ns ? again : ns;
            }
            times[i][run] = ns;
        }
    }
    for (uint32_t i = 0; i < TRIPS * POSES; i++) {
        known[i] = -1.0;
    }
    for (int i = 0; i < count && table->count < BENCH_MOST_ROWS; i++) {
        bench_row *row = &table->rows[table->count++];
        memset(row, 0, sizeof *row);
        row->method = methods[i];
        row->vertices = c->vertices;
        row->degrees = c->degrees;
        row->queries = queries[i];
        qsort(times[i], p->runs, sizeof *times[i], figures_compare);
        row->least = times[i][0];
        row->median = times[i][p->runs / 2u];
        row->spread = times[i][p->runs * 3u / 4u] - times[i][p->runs / 4u];
        (void)time_of(methods[i], c, queries[i], answers);
        take_errors(c, known, answers, row);
    }
}

int bench_take(bench_table *table, int quick, int watched) {
    const plan full = {full_vertices, full_degrees, 10, 5, 5, 2e7},
               small = {quick_vertices, quick_degrees, 2, 2, 3, 5e5};
    const plan *p = quick ? &small : &full;
    double *room = malloc(2u * TRIPS * POSES * sizeof *room);
    talus_pose *poses = malloc(TRIPS * POSES * sizeof *poses);
    int status = room != NULL && poses != NULL ? 0 : -1;
    table->count = 0;
    table->runs = p->runs;
    for (uint32_t v = 0; v < p->vertex_counts && status == 0; v++) {
        uint64_t state = p->vertices[v];
        void *memory_a, *memory_b;
        talus_hull *a = make_hull(p->vertices[v], tl_v(1.0f, 0.8f, 0.6f), &state, &memory_a);
        talus_hull *b = make_hull(p->vertices[v], tl_v(0.9f, 0.7f, 0.8f), &state, &memory_b);
        status = a != NULL && b != NULL ? 0 : -1;
        for (uint32_t k = 0; k < 2u * p->degree_counts && status == 0; k++) {
            bench_case c;
            memset(&c, 0, sizeof c);
            c.vertices = p->vertices[v];
            c.overlapping = k >= p->degree_counts;
            c.degrees = p->degrees[k % p->degree_counts];
            take_hull(a, &c.a, &c.shape_a);
            take_hull(b, &c.b, &c.shape_b);
            c.poses = poses;
            c.count = POSES;
            for (uint32_t trip = 0; trip < TRIPS; trip++) {
                make_trip(&c, &state, poses + trip * POSES);
            }
            take_case(table, &c, p, room);
            if (watched) {
                fprintf(stderr, "\r%u vertices, %s ... ", (unsigned)c.vertices, c.overlapping ? "depth" : "distance");
            }
        }
        free(memory_a);
        free(memory_b);
    }
    if (watched) {
        fprintf(stderr, "\r%40s\r", "");
    }
    free(room);
    free(poses);
    return status == 0 ? bench_world_take(&table->world, quick) : status;
}
