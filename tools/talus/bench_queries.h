/* What the parts of `talus bench queries` share: a pair of hulls on its way through poses, the methods that are asked
 * about it, and what came out. Metres, nanoseconds. */
#ifndef TALUS_TOOL_BENCH_QUERIES_H
#define TALUS_TOOL_BENCH_QUERIES_H

#include "bench_world.h"
#include "collide/collide.h"
#include "gltf/text.h"
#include "talus/query.h"

#define BENCH_MOST_METHODS 12
#define BENCH_MOST_ROWS 512
#define BENCH_RANDOM 0.0 /* the angle of poses that have nothing to do with one another */

/* Two hulls of as many vertices; A stands at the origin, B at the poses in turn. */
typedef struct bench_case {
    uint32_t vertices; /* asked for; the hulls may have fewer where points lie within */
    int overlapping;   /* the depth is asked for, else the distance */
    double degrees;    /* that B turns from a pose to the next, or BENCH_RANDOM: then nothing is remembered */
    talus_convex a, b;
    tl_convex shape_a, shape_b;
    talus_pose *poses;
    uint32_t count;
} bench_case;

typedef struct bench_method {
    const char *name;                                                  /* as figures are named by */
    const char *label;                                                 /* for people */
    int overlapping;                                                   /* it tells depths, else distances */
    int yes_or_no;                                                     /* it tells only whether they touch: 0 or 1 */
    uint32_t most;                                                     /* vertices that it is asked with */
    void (*run)(const bench_case *c, uint32_t count, double *answers); /* the first `count` poses */
} bench_method;

extern const bench_method bench_own_methods[];
extern const int bench_own_count;
extern const bench_method bench_ccd_methods[];
extern const int bench_ccd_count; /* 0 where the tool was built without libccd */

/* In double precision and by other means. Of distances: Gilbert's and Johnson's search with an exact end, over all
 * vertices. Of depths: every face and every pair of edges whose normals meet, O(edges squared); never the answer of a
 * walk. */
double bench_distance(const bench_case *c, uint32_t pose);
double bench_depth(const bench_case *c, uint32_t pose);
/* The distance by every vertex against every face and every edge against every edge. */
double bench_distance_by_all(const bench_case *c, uint32_t pose);

typedef struct bench_row {
    const bench_method *method;
    uint32_t vertices;
    double degrees;
    double least, median, spread;  /* ns a query: of the runs; the spread is that between quartiles */
    double mean_error, most_error; /* relative; of yes or no, the share of wrong answers */
    uint32_t queries;              /* a run */
} bench_row;

typedef struct bench_table {
    bench_row rows[BENCH_MOST_ROWS];
    uint32_t count, runs;
    bench_world_table world;
} bench_table;

/* 0, or -1 for a lack of memory, or where a query of the world fails. Says on the standard error how far it is where
 * `watched`. */
int bench_take(bench_table *table, int quick, int watched);
void bench_print(const bench_table *table, gltf_text *out);
void bench_json(const bench_table *table, gltf_text *out);
void bench_plot(const bench_table *table, gltf_text *out); /* SVG */

#endif
