#define _POSIX_C_SOURCE 200809L
#include "run.h"

#include "gltf/animate.h"
#include "host/clock.h"
#include "host/file.h"
#include "tool.h"
#include "trajectory.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FRAMES_PER_SECOND 30.0 /* of an animation */

/* --- options --- */

enum { OUT = SOURCE_OPTION_COUNT, JSON, PROFILE, ANIMATE, QUIET, TIME_BUDGET, HELP };

static const struct option long_options[] = {SOURCE_LONG_OPTIONS,
                                             {"out", required_argument, NULL, OUT},
                                             {"json", no_argument, NULL, JSON},
                                             {"profile", no_argument, NULL, PROFILE},
                                             {"quiet", no_argument, NULL, QUIET},
                                             {"animate", required_argument, NULL, ANIMATE},
                                             {"time-budget", required_argument, NULL, TIME_BUDGET},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

/* Reads one option; an exit status, or 0. */
static int take_option(int option, run_options *out) {
    switch (option) {
    case OUT:
        out->out = optarg;
        return 0;
    case ANIMATE:
        out->animate = optarg;
        return 0;
    case JSON:
        out->json = 1;
        return 0;
    case PROFILE:
        out->profile = 1;
        return 0;
    case QUIET:
        out->quiet = 1;
        return 0;
    case TIME_BUDGET:
        if (!source_number("--time-budget", optarg, "ms", 0.001, 10000, &out->time_budget)) {
            return TOOL_USAGE;
        }
        out->time_budget *= 1e-3;
        return 0;
    default:
        return option > 0 && option < SOURCE_OPTION_COUNT ? source_take_option(option, optarg, &out->source)
                                                          : tool_fail(TOOL_USAGE, "see: talus help run");
    }
}

/* --- running --- */

/* What the steps of a run share. */
typedef struct runner {
    const run_options *options;
    const gltf_scene *scene;
    gltf_world *world;
    run_result *result;
    trajectory file;
    gltf_animation animation;
    trajectory_state *states;
    talus_pose *poses;
    uint32_t frame_every; /* steps between two frames of the animation */
    talus_time_budget time;
    uint32_t most_substeps; /* that the world may give an island */
    float margin;           /* m, the world's speculative one */
    float flown;            /* m, what the fastest body flies in a step now */
} runner;

static float larger(float a, float b) { return a > b ? a : b; }

static int is_finite_state(const trajectory_state *s) {
    const float sum = (s->pose.position.x + s->pose.position.y + s->pose.position.z) * 0.0f +
                      (s->pose.rotation.x + s->pose.rotation.y + s->pose.rotation.z + s->pose.rotation.w) * 0.0f +
                      (s->linear.x + s->linear.y + s->linear.z) * 0.0f +
                      (s->angular.x + s->angular.y + s->angular.z) * 0.0f;
    return sum == 0.0f; /* a NaN or an infinity times 0 is a NaN */
}

static void take_states(runner *r, uint32_t step, double ms) {
    int finite = 1;
    r->flown = 0;
    for (uint32_t i = 0; i < r->scene->body_count; i++) {
        trajectory_state *s = &r->states[i];
        talus_body_get_pose(&r->world->world, r->world->bodies[i], &s->pose);
        talus_body_get_velocity(&r->world->world, r->world->bodies[i], &s->linear, &s->angular);
        r->poses[i] = s->pose;
        r->flown = larger(r->flown, r->result->dt * sqrtf(s->linear.x * s->linear.x + s->linear.y * s->linear.y +
                                                          s->linear.z * s->linear.z));
        finite &= is_finite_state(s);
    }
    if (!finite && r->result->not_finite_step == 0) {
        r->result->not_finite_step = step > 0 ? step : 1;
    }
    trajectory_frame(&r->file, (float)ms, r->states);
    if (r->options->animate != NULL && (step % r->frame_every == 0 || step == r->result->steps)) {
        gltf_animation_frame(&r->animation, step * (double)r->result->dt, r->poses);
    }
}

/* What the step found and gave; the errors that it found are those that the step before had left. */
static void take_accuracy(const runner *r, const talus_counters *c) {
    run_result *out = r->result;
    if (c->awake_bodies == 0) {
        return;
    }
    int over = c->worst_error > r->options->source.build.error_budget, settled = 2 * c->steps >= out->steps;
    out->awake_body_steps += c->awake_bodies;
    out->substeps_given += c->substeps_given;
    out->substeps_least =
        out->substeps_least > 0 && out->substeps_least < c->substeps_least ? out->substeps_least : c->substeps_least;
    out->substeps_most = out->substeps_most > c->substeps_most ? out->substeps_most : c->substeps_most;
    out->steps_over += (uint64_t)over;
    out->worst_error = larger(out->worst_error, c->worst_error);
    if (settled) {
        out->settled_over += (uint64_t)over;
        out->settled_error = larger(out->settled_error, c->worst_error);
    }
}

static void take_counters(const runner *r) {
    run_result *out = r->result;
    const talus_world *world = &r->world->world;
    talus_counters c;
    memset(&c, 0, sizeof c);
    talus_world_get_counters(world, &c);
    out->last = c;
    out->dropped_contacts += c.contacts.dropped;
    out->dropped_events += c.events.dropped;
    out->dropped_rows += c.rows.dropped;
    out->manifolds_made += c.manifolds_made;
    out->manifolds_kept += c.manifolds_kept;
    out->contacts_sleeping += c.contacts_sleeping;
    out->pairs_made += c.pairs_made;
    out->proxies_refit += c.proxies_refit;
    take_accuracy(r, &c);
    skipped_take(&out->skips, r->scene, &c, r->flown, r->margin);
    talus_events events;
    if (talus_world_get_events(world, &events) == TALUS_OK) {
        out->sensor_begins += events.sensor_begin_count;
        out->sensor_ends += events.sensor_end_count;
    }
}

static void take_errors(run_result *out, const talus_world *world, uint32_t step) {
    talus_errors e;
    if (2 * step >= out->steps && talus_world_measure(world, &e) == TALUS_OK) {
        out->worst.overlap = larger(out->worst.overlap, e.overlap);
        out->worst.joint_linear = larger(out->worst.joint_linear, e.joint_linear);
        out->worst.joint_angular = larger(out->worst.joint_angular, e.joint_angular);
        out->worst.contact_speed = larger(out->worst.contact_speed, e.contact_speed);
        out->worst.joint_speed = larger(out->worst.joint_speed, e.joint_speed);
    }
}

static uint64_t stage_clock(void *context) {
    (void)context;
    return host_clock_ns();
}

/* A bar on the terminal, once a run has taken a second. */
static void show_progress(const run_options *options, uint32_t step, uint32_t steps, uint64_t begin, uint64_t *shown) {
    uint64_t now = host_clock_ns();
    if (options->quiet || options->json || now - begin < 1000000000u || now - *shown < 100000000u) {
        return;
    }
    if (!isatty(STDERR_FILENO)) {
        return;
    }
    *shown = now;
    char bar[41];
    int full = (int)(40.0 * step / steps);
    memset(bar, '.', 40);
    memset(bar, '#', (size_t)full);
    bar[40] = 0;
    double left = (double)(now - begin) * 1e-9 * (steps - step) / (step > 0 ? step : 1);
    fprintf(stderr, "\r[%s] step %lu of %lu, %.0f s left   ", bar, (unsigned long)step, (unsigned long)steps, left);
    fflush(stderr);
}

/* The clock has its say between steps: what it comes to is a call like any other. */
static void keep_time(runner *r, double took) {
    talus_accuracy next;
    if (r->options->time_budget > 0 && talus_time_budget_advance(&r->time, took, &next) == TALUS_OK) {
        r->result->steps_late += took > r->options->time_budget;
        if (next.most_substeps != r->most_substeps) {
            talus_world_set_accuracy(&r->world->world, &next);
            r->most_substeps = next.most_substeps;
        }
    }
}

static int run_steps(runner *r) {
    run_result *out = r->result;
    const talus_clock clock = {stage_clock, NULL};
    int timed = r->options->profile || (!r->options->json && !r->options->quiet);
    uint64_t begin = host_clock_ns(), shown = 0;
    out->has_stages = timed;
    take_states(r, 0, 0);
    for (uint32_t step = 1; step <= out->steps; step++) {
        talus_profile profile;
        uint64_t start = host_clock_ns();
        talus_status status =
            talus_world_step(&r->world->world, out->dt, timed ? &clock : NULL, timed ? &profile : NULL);
        uint64_t end = host_clock_ns();
        if (status != TALUS_OK) {
            return tool_fail(GLTF_FAILED, "%s: step %lu: %s", r->options->source.scene, (unsigned long)step,
                             talus_status_text(status));
        }
        out->step_ms[step - 1] = (double)(end - start) * 1e-6;
        keep_time(r, (double)(end - start) * 1e-9);
        for (int i = 0; timed && i < TALUS_STAGE_COUNT; i++) {
            out->stage_ns[i] += profile.stage[i];
        }
        take_states(r, step, out->step_ms[step - 1]);
        take_counters(r);
        take_errors(out, &r->world->world, step);
        show_progress(r->options, step, out->steps, begin, &shown);
    }
    if (shown != 0) {
        fprintf(stderr, "\r%79s\r", "");
    }
    return 0;
}

static int write_animation(const runner *r) {
    gltf_text bytes = {NULL, 0, 0, 0};
    gltf_error error;
    int status = (int)gltf_animation_encode(&r->animation, r->world, &bytes, &error);
    if (status != 0) {
        tool_fail(status, "%s: %s", r->options->animate, error.text);
    } else if (host_file_write(r->options->animate, bytes.data, bytes.size) != HOST_FILE_OK) {
        status = tool_fail(GLTF_FAILED, "%s: %s", r->options->animate, strerror(errno));
    }
    gltf_text_free(&bytes);
    return status;
}

/* Steps the world and writes what was asked for. */
static int run_world(const run_options *options, const gltf_scene *scene, gltf_world *world, run_result *result) {
    runner r;
    memset(&r, 0, sizeof r);
    r.options = options;
    r.scene = scene;
    r.world = world;
    r.result = result;
    talus_world_def def;
    memset(&def, 0, sizeof def);
    talus_world_get_def(&world->world, &def);
    r.margin = def.speculative_margin;
    r.most_substeps = def.most_substeps;
    if (options->time_budget > 0) {
        uint32_t most = def.most_substeps > def.substeps ? def.most_substeps : def.substeps;
        const talus_accuracy wanted = {def.error_budget, def.substeps, most};
        talus_time_budget_init(&r.time, options->time_budget, &wanted);
    }
    r.frame_every = (uint32_t)fmax(1, floor(1 / (FRAMES_PER_SECOND * (double)result->dt) + 0.5));
    r.states = calloc((size_t)scene->body_count + 1, sizeof *r.states);
    r.poses = calloc((size_t)scene->body_count + 1, sizeof *r.poses);
    result->step_ms = calloc((size_t)result->steps + 1, sizeof *result->step_ms);
    gltf_animation_open(&r.animation, scene);
    int status = 0;
    if (r.states == NULL || r.poses == NULL || result->step_ms == NULL) {
        status = tool_fail(GLTF_FAILED, "there is no memory for %lu steps", (unsigned long)result->steps);
    } else if (!trajectory_open(&r.file, options->out, scene->body_count, result->steps + 1, result->dt)) {
        status = tool_fail(GLTF_FAILED, "%s: %s", options->out != NULL ? options->out : "", strerror(errno));
    } else {
        status = run_steps(&r);
        result->state_hash = trajectory_hash(&r.file);
        result->world_hash = talus_world_hash(&world->world);
        if (!trajectory_close(&r.file) && status == 0) {
            status = tool_fail(GLTF_FAILED, "%s: %s", options->out, strerror(errno));
        }
        if (status == 0 && options->animate != NULL) {
            status = write_animation(&r);
        }
    }
    gltf_animation_free(&r.animation);
    free(r.states);
    free(r.poses);
    return status;
}

static int run_source(const run_options *options, source *from) {
    run_result result;
    memset(&result, 0, sizeof result);
    talus_world_def def;
    memset(&def, 0, sizeof def);
    talus_world_get_def(&from->world.world, &def);
    memcpy(result.name, from->name, sizeof result.name);
    result.dt = from->dt;
    result.steps = from->steps;
    result.substeps = def.substeps;
    result.iterations = def.iterations;
    result.isa = (uint32_t)talus_world_get_isa(&from->world.world);
    int status = run_world(options, &from->scene, &from->world, &result);
    if (status == 0) {
        result.ms = figures_of(result.step_ms, result.steps);
        if (options->json) {
            report_json(options, &from->scene, &from->world, &result);
        } else if (!options->quiet) {
            report_for_people(options, &from->scene, &from->world, &result);
        }
    }
    free(result.step_ms);
    return status;
}

int tool_run(int count, char **arguments) {
    static char name[] = "talus: run"; /* what getopt's messages begin with */
    run_options options;
    arguments[0] = name;
    memset(&options, 0, sizeof options);
    options.source = source_options_default();
    for (int option; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        int status = option == HELP ? 0 : take_option(option, &options);
        if (option == HELP) {
            tool_print_manual("run");
        }
        if (option == HELP || status != 0) {
            return status;
        }
    }
    if (optind + 1 != count) {
        return tool_fail(TOOL_USAGE, "run: %s; see: talus help run",
                         optind < count ? "one scene at a time" : "the name of a scene is missing");
    }
    options.source.scene = arguments[optind];
    if (options.time_budget > 0 && options.source.build.error_budget == 0) { /* as exact as there is time for */
        options.source.build.error_budget = (float)(1e-3 * SOURCE_LEAST_ERROR_MM);
    }
    source from;
    int status = source_open(&from, &options.source);
    if (status == 0) {
        status = run_source(&options, &from);
        source_close(&from);
    }
    return status;
}
