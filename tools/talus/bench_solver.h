/* What the parts of `talus bench solver` share: the scenes, the solver's settings, and what came out. */
#ifndef TALUS_TOOL_BENCH_SOLVER_H
#define TALUS_TOOL_BENCH_SOLVER_H

#include "bench_errors.h"
#include "gltf/text.h"
#include "source.h"

#define SOLVER_MOST_SETTINGS 24
#define SOLVER_MOST_SCENES 16
#define SOLVER_LEAST_ERROR 1e-7 /* m: what a float tells apart at a metre */

typedef struct solver_scene {
    const char *name; /* one of the tool's own */
    int rests;        /* its bodies should stay where they were put */
} solver_scene;

extern const solver_scene solver_scenes[];
extern const uint32_t solver_scene_count;

/* Settings of one series differ in one thing; the curves of the plot. */
typedef enum solver_series {
    SOLVER_SUBSTEPS,   /* of one iteration */
    SOLVER_ITERATIONS, /* of the library's sub-steps */
    SOLVER_SINGLE,     /* iterations of one sub-step */
    SOLVER_BUDGETS,    /* of error, from the library's sub-steps on */
    SOLVER_OTHERS,
    SOLVER_SERIES_COUNT
} solver_series;

typedef struct solver_setting {
    const char *name;
    solver_series series;
    int quick; /* it is in the quick table too */
    gltf_build_options build;
} solver_setting;

typedef struct solver_row {
    const solver_setting *setting;
    double ms;                        /* a step: the mean of the steps' least times over the runs */
    double median, spread;            /* of the runs' own means; the spread is that between quartiles */
    double errors[BENCH_ERROR_COUNT]; /* m; below 0: the scene cannot have it */
    int front[BENCH_ERROR_COUNT];     /* no other setting is as fast with less of it */
    uint64_t hash;                    /* of the state after the last step */
} solver_row;

typedef struct solver_case {
    const solver_scene *scene;
    uint32_t bodies, joints, steps, rows;
    float dt; /* s */
    solver_row row[SOLVER_MOST_SETTINGS];
} solver_case;

typedef struct solver_table {
    solver_case cases[SOLVER_MOST_SCENES];
    uint32_t count, runs;
} solver_table;

/* Of all scenes where none is named. 0, or an exit status with its message told. Says on the standard error how far it
 * is where `watched`. */
int solver_take(solver_table *table, const char *const *names, uint32_t name_count, int quick, int watched);
void solver_print(const solver_table *table, gltf_text *out);
void solver_json(const solver_table *table, gltf_text *out);
void solver_plot(const solver_table *table, gltf_text *out); /* SVG */

extern const char *const solver_error_names[BENCH_ERROR_COUNT];
extern const char *const solver_series_names[SOLVER_SERIES_COUNT];

#endif
