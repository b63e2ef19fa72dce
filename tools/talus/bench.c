/* talus bench: what the library's parts cost and how exact they are. */
#define _POSIX_C_SOURCE 200809L
#include "bench_queries.h"
#include "bench_solver.h"
#include "tool.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { QUICK, JSON, PLOT, SCENE, HELP };

static const struct option long_options[] = {
    {"quick", no_argument, NULL, QUICK},     {"json", no_argument, NULL, JSON},
    {"plot", required_argument, NULL, PLOT}, {"scene", required_argument, NULL, SCENE},
    {"help", no_argument, NULL, HELP},       {NULL, 0, NULL, 0}};

typedef struct bench_options {
    const char *plot;
    const char *scenes[SOLVER_MOST_SCENES];
    uint32_t scene_count;
    int quick, json;
} bench_options;

/* What can be measured; of each the parts take it, tell it and draw it. An exit status, its message told. */
typedef struct subject {
    const char *name;
    int takes_scenes;
    int (*take)(const bench_options *options, int watched);
    void (*print)(gltf_text *out);
    void (*json)(gltf_text *out);
    void (*plot)(gltf_text *out);
} subject;

static bench_table queries;
static solver_table solver;

static int take_queries(const bench_options *o, int watched) {
    return bench_take(&queries, o->quick, watched) == 0
               ? 0
               : tool_fail(GLTF_FAILED, "bench: there is no memory for the hulls");
}
static void print_queries(gltf_text *out) { bench_print(&queries, out); }
static void json_queries(gltf_text *out) { bench_json(&queries, out); }
static void plot_queries(gltf_text *out) { bench_plot(&queries, out); }

static int take_solver(const bench_options *o, int watched) {
    return solver_take(&solver, o->scenes, o->scene_count, o->quick, watched);
}
static void print_solver(gltf_text *out) { solver_print(&solver, out); }
static void json_solver(gltf_text *out) { solver_json(&solver, out); }
static void plot_solver(gltf_text *out) { solver_plot(&solver, out); }

static const subject subjects[] = {{"queries", 0, take_queries, print_queries, json_queries, plot_queries},
                                   {"solver", 1, take_solver, print_solver, json_solver, plot_solver}};

static const subject *find_subject(const char *name) {
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++) {
        if (strcmp(name, subjects[i].name) == 0) {
            return &subjects[i];
        }
    }
    return NULL;
}

static int add_scene(bench_options *o, const char *name) {
    char names[160] = "";
    for (uint32_t i = 0; i < solver_scene_count; i++) {
        if (strcmp(name, solver_scenes[i].name) == 0) {
            o->scenes[o->scene_count % SOLVER_MOST_SCENES] = solver_scenes[i].name;
            o->scene_count += o->scene_count < SOLVER_MOST_SCENES;
            return 0;
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i == 0 ? "" : ", ",
                 solver_scenes[i].name);
    }
    return tool_fail(TOOL_USAGE, "--scene: \"%s\" is none of %s", name, names);
}

static int run(const subject *s, const bench_options *o) {
    gltf_text text = {NULL, 0, 0, 0};
    int status = s->take(o, !o->json && isatty(STDERR_FILENO));
    if (status == 0 && o->plot != NULL) {
        s->plot(&text);
        status = tool_write_text(o->plot, &text);
    }
    if (status == 0 && (o->plot == NULL || strcmp(o->plot, "-") != 0)) {
        if (o->json) {
            s->json(&text);
        } else {
            s->print(&text);
        }
        status = tool_write_text("-", &text);
    }
    return status;
}

int tool_bench(int count, char **arguments) {
    static char name[] = "talus: bench"; /* what getopt's messages begin with */
    bench_options o;
    memset(&o, 0, sizeof o);
    arguments[0] = name;
    for (int option, status = 0; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        switch (option) {
        case QUICK:
            o.quick = 1;
            break;
        case JSON:
            o.json = 1;
            break;
        case PLOT:
            o.plot = optarg;
            break;
        case SCENE:
            status = add_scene(&o, optarg);
            break;
        case HELP:
            tool_print_manual("bench");
            return 0;
        default:
            status = tool_fail(TOOL_USAGE, "see: talus help bench");
        }
        if (status != 0) {
            return status;
        }
    }
    const subject *s = optind + 1 == count ? find_subject(arguments[optind]) : NULL;
    if (s == NULL) {
        return tool_fail(TOOL_USAGE, "bench: what to measure is to be named, which can be: queries, solver");
    }
    if (o.scene_count > 0 && !s->takes_scenes) {
        return tool_fail(TOOL_USAGE, "bench %s: has no scenes to choose from", s->name);
    }
    if (o.json && o.plot != NULL && strcmp(o.plot, "-") == 0) {
        return tool_fail(TOOL_USAGE, "bench: only one of --json and --plot - can have the standard output");
    }
    return run(s, &o);
}
