/* Takes the table of `talus bench solver`: own scenes by every setting of the solver, their times and their errors. */
#include "bench_solver.h"

#include "bench_choice.h"
#include "figures.h"
#include "host/clock.h"
#include "tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FULL_RUNS 5u
#define QUICK_RUNS 3u
#define QUICK_STEPS 20u
#define SAMPLES 60u /* steps of a run at which overlaps are looked for */

const solver_scene solver_scenes[] = {{"stack", 1}, {"pyramid", 1}, {"masses", 1}, {"cards", 1},    {"arch", 1},
                                      {"chain", 0}, {"bridge", 0},  {"pile", 0},   {"ragdolls", 0}, {"tumbler", 0}};
const uint32_t solver_scene_count = sizeof solver_scenes / sizeof *solver_scenes;

const char *const solver_error_names[BENCH_ERROR_COUNT] = {"overlap_p99", "overlap_most", "joints_apart", "drift",
                                                           "energy_gained"};
const char *const solver_series_names[SOLVER_SERIES_COUNT] = {"substeps", "iterations", "iterations_of_one_substep",
                                                              "budgets", "others"};

/* Sub-steps, iterations, no sleep; contacts of so many Hz; all manifolds in every step. */
#define WITH(n, passes, hertz, anew)                                                                                   \
    { .substeps = n, .iterations = passes, .no_sleep = 1, .contact_hertz = hertz, .no_kept_manifolds = anew }

/* Sub-steps by an error budget (m). */
#define BUDGET(m)                                                                                                      \
    { .substeps = 4, .iterations = 1, .no_sleep = 1, .error_budget = m }

static const solver_setting settings[] = {{"1 sub-step", SOLVER_SUBSTEPS, 1, WITH(1, 1, 0, 0)},
                                          {"2 sub-steps", SOLVER_SUBSTEPS, 0, WITH(2, 1, 0, 0)},
                                          {"4 sub-steps", SOLVER_SUBSTEPS, 1, WITH(4, 1, 0, 0)},
                                          {"8 sub-steps", SOLVER_SUBSTEPS, 0, WITH(8, 1, 0, 0)},
                                          {"16 sub-steps", SOLVER_SUBSTEPS, 0, WITH(16, 1, 0, 0)},
                                          {"32 sub-steps", SOLVER_SUBSTEPS, 0, WITH(32, 1, 0, 0)},
                                          {"4 of 2 iterations", SOLVER_ITERATIONS, 0, WITH(4, 2, 0, 0)},
                                          {"4 of 4 iterations", SOLVER_ITERATIONS, 1, WITH(4, 4, 0, 0)},
                                          {"4 of 8 iterations", SOLVER_ITERATIONS, 0, WITH(4, 8, 0, 0)},
                                          {"1 of 4 iterations", SOLVER_SINGLE, 0, WITH(1, 4, 0, 0)},
                                          {"1 of 8 iterations", SOLVER_SINGLE, 0, WITH(1, 8, 0, 0)},
                                          {"1 of 16 iterations", SOLVER_SINGLE, 0, WITH(1, 16, 0, 0)},
                                          {"budget 2 mm", SOLVER_BUDGETS, 0, BUDGET(2e-3f)},
                                          {"budget 1 mm", SOLVER_BUDGETS, 1, BUDGET(1e-3f)},
                                          {"budget 0.3 mm", SOLVER_BUDGETS, 0, BUDGET(3e-4f)},
                                          {"budget 0.1 mm", SOLVER_BUDGETS, 0, BUDGET(1e-4f)},
                                          {"4, contacts of 30 Hz", SOLVER_OTHERS, 0, WITH(4, 1, 30, 0)},
                                          {"8, contacts of 120 Hz", SOLVER_OTHERS, 0, WITH(8, 1, 120, 0)},
                                          {"4, all manifolds anew", SOLVER_OTHERS, 1, WITH(4, 1, 0, 1)}};
/* --- one run --- */

static int trouble(const solver_case *c, const solver_setting *setting, const char *what) {
    return tool_fail(GLTF_FAILED, "bench solver: %s, %s: %s", c->scene->name, setting->name, what);
}

/* A world of the scene as it begins; an exit status. */
static int begin(const solver_case *c, const gltf_scene *scene, const solver_setting *setting, gltf_world *world) {
    gltf_error error;
    return gltf_build(scene, &setting->build, world, &error) == GLTF_OK ? 0 : trouble(c, setting, error.text);
}

/* The errors, and the state at the end. */
static int judge(const solver_case *c, const gltf_scene *scene, solver_row *row) {
    gltf_world world;
    bench_judge judge;
    int status = begin(c, scene, row->setting, &world);
    if (status != 0) {
        return status;
    }
    uint32_t every = c->steps > SAMPLES ? c->steps / SAMPLES : 1;
    if (bench_judge_open(&judge, scene, &world) != 0) {
        status = trouble(c, row->setting, "there is no memory");
    }
    for (uint32_t step = 1; step <= c->steps && status == 0; step++) {
        if (talus_world_step(&world.world, c->dt, NULL, NULL) != TALUS_OK ||
            bench_judge_step(&judge, step % every == 0) != 0) {
            status = trouble(c, row->setting, "its errors cannot be measured");
        }
    }
    if (status == 0) {
        bench_judge_errors(&judge, row->errors);
        if (!c->scene->rests) {
            row->errors[BENCH_DRIFT] = -1;
        }
        row->hash = talus_world_hash(&world.world);
    }
    bench_judge_close(&judge);
    gltf_world_free(&world);
    return status;
}

/* Nothing but steps. `least` has the least time (ms) of each so far; *mean receives the run's own. */
static int time_run(const solver_case *c, const gltf_scene *scene, const solver_row *row, double *least, double *mean) {
    gltf_world world;
    int status = begin(c, scene, row->setting, &world);
    if (status != 0) {
        return status;
    }
    *mean = 0;
    for (uint32_t step = 0; step < c->steps; step++) {
        uint64_t start = host_clock_ns();
        talus_world_step(&world.world, c->dt, NULL, NULL);
        double ms = (double)(host_clock_ns() - start) * 1e-6;
        least[step] = ms < least[step] ? ms : least[step];
        *mean += ms / c->steps;
    }
    if (talus_world_hash(&world.world) != row->hash) {
        status = trouble(c, row->setting, "two runs ended in two states");
    }
    gltf_world_free(&world);
    return status;
}

/* --- all of them --- */

/* By time and one error. */
static void mark_front(solver_case *c) {
    for (uint32_t i = 0; i < c->rows; i++) {
        for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
            solver_row *own = &c->row[i];
            own->front[e] = own->errors[e] >= 0;
            for (uint32_t k = 0; k < c->rows; k++) {
                const solver_row *other = &c->row[k];
                double less = fmax(own->errors[e], SOLVER_LEAST_ERROR) - fmax(other->errors[e], SOLVER_LEAST_ERROR);
                if (less >= 0 && other->ms <= own->ms && (less > 0 || other->ms < own->ms)) {
                    own->front[e] = 0;
                }
            }
        }
    }
}

static int take_case(solver_case *c, const gltf_scene *scene, uint32_t runs, int watched) {
    double *least = malloc((size_t)c->rows * c->steps * sizeof *least), means[SOLVER_MOST_SETTINGS][FULL_RUNS];
    int status = least != NULL ? 0 : trouble(c, c->row->setting, "there is no memory for the times");
    for (uint32_t i = 0; i < c->rows && status == 0; i++) {
        if (watched) {
            fprintf(stderr, "\r%s: errors, %s ...%20s", c->scene->name, c->row[i].setting->name, "");
        }
        status = judge(c, scene, &c->row[i]);
    }
    for (size_t i = 0; status == 0 && i < (size_t)c->rows * c->steps; i++) {
        least[i] = HUGE_VAL;
    }
    /* the settings take turns, so that a mood of the machine meets all of them */
    for (uint32_t run = 0; run < runs; run++) {
        if (watched) {
            fprintf(stderr, "\r%s: times, run %u of %u ...%40s", c->scene->name, (unsigned)run + 1, (unsigned)runs, "");
        }
        for (uint32_t i = 0; i < c->rows && status == 0; i++) {
            status = time_run(c, scene, &c->row[i], least + (size_t)i * c->steps, &means[i][run]);
        }
    }
    for (uint32_t i = 0; i < c->rows && status == 0; i++) {
        solver_row *row = &c->row[i];
        figures ms = figures_of(least + (size_t)i * c->steps, c->steps);
        row->ms = ms.mean;
        qsort(means[i], runs, sizeof *means[i], figures_compare);
        row->median = means[i][runs / 2];
        row->spread = means[i][runs * 3 / 4] - means[i][runs / 4];
    }
    free(least);
    mark_front(c);
    return status;
}

static int take_scene(solver_table *table, const solver_scene *which, int quick, int watched) {
    char path[40];
    gltf_scene scene;
    solver_case *c = &table->cases[table->count];
    snprintf(path, sizeof path, "@%s", which->name);
    int status = source_load(path, &scene);
    if (status == 0) {
        memset(c, 0, sizeof *c);
        c->scene = which;
        c->bodies = scene.body_count;
        c->joints = scene.joint_count;
        c->dt = scene.dt;
        c->steps = quick && scene.steps > QUICK_STEPS ? QUICK_STEPS : scene.steps;
        for (uint32_t i = 0; i < sizeof settings / sizeof *settings; i++) {
            if (settings[i].quick || !quick) {
                c->row[c->rows++].setting = &settings[i];
            }
        }
        status = take_case(c, &scene, table->runs, watched);
        table->count++;
    }
    gltf_scene_free(&scene);
    return status;
}

int solver_take(solver_table *table, const char *const *names, uint32_t name_count, int quick, int watched) {
    int status = 0;
    table->count = 0;
    table->runs = quick ? QUICK_RUNS : FULL_RUNS;
    for (uint32_t i = 0; i < solver_scene_count && status == 0; i++) {
        if (bench_is_chosen(solver_scenes[i].name, names, name_count)) {
            status = take_scene(table, &solver_scenes[i], quick, watched);
        }
    }
    if (watched) {
        fprintf(stderr, "\r%79s\r", "");
    }
    return status;
}
