/* One run of a scene: what was asked for, and what came out. */
#ifndef TALUS_TOOL_RUN_H
#define TALUS_TOOL_RUN_H

#include "figures.h"
#include "skipped.h"
#include "source.h"

typedef struct run_options {
    source_options source;
    const char *out, *animate;
    int json, profile, quiet;
    double time_budget; /* s a step; 0: none */
} run_options;

/* Times are ms. */
typedef struct run_result {
    char name[256]; /* the scene's file without its ending */
    float dt;
    uint32_t steps;
    double *step_ms; /* of each step; sorted once it is summed up */
    figures ms;
    int has_stages;
    uint64_t stage_ns[TALUS_STAGE_COUNT];
    uint64_t state_hash, world_hash;
    talus_counters last; /* after the last step */
    uint64_t dropped_contacts, dropped_events, dropped_rows;
    uint64_t manifolds_made, manifolds_kept, contacts_sleeping, pairs_made, proxies_refit;
    skipped skips;
    uint64_t sensor_begins, sensor_ends;
    talus_errors worst;                        /* over the second half of the steps, when what falls has fallen */
    uint64_t substeps_given, awake_body_steps; /* over steps */
    uint64_t steps_over, settled_over;         /* the error budget, of all and of the second half */
    uint64_t steps_late;                       /* beyond the time budget */
    uint32_t substeps_least, substeps_most;
    float worst_error, settled_error; /* m: as the error budget counts it, of all steps and of the second half */
    uint32_t not_finite_step;         /* the first one with a NaN or infinity in its states; 0: none */
    uint32_t substeps, iterations, isa;
} run_result;

void report_for_people(const run_options *options, const gltf_scene *scene, const gltf_world *world,
                       const run_result *result);
void report_json(const run_options *options, const gltf_scene *scene, const gltf_world *world,
                 const run_result *result);

#endif
