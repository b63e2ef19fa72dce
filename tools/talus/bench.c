/* talus bench: what the library's parts cost and how exact they are. */
#define _POSIX_C_SOURCE 200809L
#include "bench_features.h"
#include "bench_queries.h"
#include "bench_solver.h"
#include "tool.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { QUICK = 1, JSON, PLOT, SCENE, FEATURE, HELP };

#define MOST_CHOSEN 32u

static const struct option long_options[] = {{"quick", no_argument, NULL, QUICK},
                                             {"json", no_argument, NULL, JSON},
                                             {"plot", required_argument, NULL, PLOT},
                                             {"scene", required_argument, NULL, SCENE},
                                             {"feature", required_argument, NULL, FEATURE},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

typedef struct bench_options {
    const char *plot;
    int choice; /* SCENE or FEATURE: what `chosen` are names of */
    const char *chosen[MOST_CHOSEN];
    uint32_t chosen_count;
    int quick, json;
} bench_options;

/* What can be measured; of each the parts take it, tell it and draw it. */
typedef struct subject {
    const char *name;
    int choice;                                             /* SCENE, FEATURE, or 0 where there is none */
    int (*take)(const bench_options *options, int watched); /* 0, or an exit status with its message told */
    void (*print)(gltf_text *out);
    void (*json)(gltf_text *out);
    void (*plot)(gltf_text *out); /* may be null */
} subject;

static bench_table queries;
static solver_table solver;
static feature_table idle;

static int take_queries(const bench_options *o, int watched) {
    return bench_take(&queries, o->quick, watched) == 0
               ? 0
               : tool_fail(GLTF_FAILED, "bench: there is no memory, or a world cannot be asked");
}
static void print_queries(gltf_text *out) { bench_print(&queries, out); }
static void json_queries(gltf_text *out) { bench_json(&queries, out); }
static void plot_queries(gltf_text *out) { bench_plot(&queries, out); }

static int take_solver(const bench_options *o, int watched) {
    return solver_take(&solver, o->chosen, o->chosen_count, o->quick, watched);
}
static void print_solver(gltf_text *out) { solver_print(&solver, out); }
static void json_solver(gltf_text *out) { solver_json(&solver, out); }
static void plot_solver(gltf_text *out) { solver_plot(&solver, out); }

static int take_features(const bench_options *o, int watched) {
    return features_take(&idle, o->chosen, o->chosen_count, o->quick, watched);
}
static void print_features(gltf_text *out) { features_print(&idle, out); }
static void json_features(gltf_text *out) { features_json(&idle, out); }

static const subject subjects[] = {{"queries", 0, take_queries, print_queries, json_queries, plot_queries},
                                   {"solver", SCENE, take_solver, print_solver, json_solver, plot_solver},
                                   {"features", FEATURE, take_features, print_features, json_features, NULL}};

static const subject *find_subject(const char *name) {
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++) {
        if (strcmp(name, subjects[i].name) == 0) {
            return &subjects[i];
        }
    }
    return NULL;
}

/* The name of scene or feature i, or null beyond the last. */
static const char *choice_name(int choice, uint32_t i) {
    if (choice == SCENE) {
        return i < solver_scene_count ? solver_scenes[i].name : NULL;
    }
    return i < feature_count ? features[i].name : NULL;
}

static int choose(bench_options *o, int choice, const char *name) {
    char names[240] = "";
    const char *known;
    for (uint32_t i = 0; (known = choice_name(choice, i)) != NULL; i++) {
        if (strcmp(name, known) == 0) {
            o->choice = choice;
            o->chosen[o->chosen_count % MOST_CHOSEN] = known;
            o->chosen_count += o->chosen_count < MOST_CHOSEN;
            return 0;
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i == 0 ? "" : ", ", known);
    }
    return tool_fail(TOOL_USAGE, "--%s: \"%s\" is none of %s", choice == SCENE ? "scene" : "feature", name, names);
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
    return status == 0 && idle.over > 0 ? TOOL_SLOW : status;
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
        case FEATURE:
            status = choose(&o, option, optarg);
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
        return tool_fail(TOOL_USAGE, "bench: what to measure is to be named, which can be: queries, solver, features");
    }
    if (o.chosen_count > 0 && o.choice != s->choice) {
        return tool_fail(TOOL_USAGE, "bench %s: has no %s to choose from", s->name,
                         o.choice == SCENE ? "scenes" : "features");
    }
    if (o.plot != NULL && s->plot == NULL) {
        return tool_fail(TOOL_USAGE, "bench %s: has no plot", s->name);
    }
    if (o.json && o.plot != NULL && strcmp(o.plot, "-") == 0) {
        return tool_fail(TOOL_USAGE, "bench: only one of --json and --plot - can have the standard output");
    }
    return run(s, &o);
}
