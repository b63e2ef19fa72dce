/* talus profile: where the time of a scene's steps goes, and which steps take too long and why. */
#define _POSIX_C_SOURCE 200809L
#include "host/clock.h"
#include "recording.h"
#include "source.h"
#include "timeline.h"
#include "tool.h"

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define RUNS 5u
#define MOST_RUNS 1000u
#define MOST_STEPS 1000000u
#define REDRAW 100000000u /* ns */

typedef struct profile_options {
    source_options source; /* --dt, --iterations and --threads are not taken */
    const char *csv, *trace, *html;
    uint32_t runs;
    double budget_ms; /* 0: none */
    int json, compare;
} profile_options;

enum { RUN_COUNT = SOURCE_OPTION_COUNT, JSON, CSV, TRACE, HTML, BUDGET, COMPARE, HELP };

static const struct option long_options[] = {{"steps", required_argument, NULL, SOURCE_STEPS},
                                             {"runs", required_argument, NULL, RUN_COUNT},
                                             {"substeps", required_argument, NULL, SOURCE_SUBSTEPS},
                                             {"isa", required_argument, NULL, SOURCE_ISA},
                                             {"no-sleep", no_argument, NULL, SOURCE_NO_SLEEP},
                                             {"json", no_argument, NULL, JSON},
                                             {"csv", required_argument, NULL, CSV},
                                             {"trace", required_argument, NULL, TRACE},
                                             {"html", required_argument, NULL, HTML},
                                             {"budget", required_argument, NULL, BUDGET},
                                             {"compare", no_argument, NULL, COMPARE},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

static int take_option(int option, profile_options *out) {
    uint64_t number = 0;
    switch (option) {
    case SOURCE_STEPS: /* it holds a frame of each */
        return source_whole("--steps", optarg, 1, MOST_STEPS, &out->source.steps) ? 0 : TOOL_USAGE;
    case RUN_COUNT:
        if (!source_whole("--runs", optarg, 1, MOST_RUNS, &number)) {
            return TOOL_USAGE;
        }
        out->runs = (uint32_t)number;
        return 0;
    case SOURCE_SUBSTEPS:
    case SOURCE_ISA:
    case SOURCE_NO_SLEEP:
        return source_take_option(option, optarg, &out->source);
    case JSON:
        out->json = 1;
        return 0;
    case COMPARE:
        out->compare = 1;
        return 0;
    case CSV:
        out->csv = optarg;
        return 0;
    case TRACE:
        out->trace = optarg;
        return 0;
    case HTML:
        out->html = optarg;
        return 0;
    case BUDGET:
        return source_number("--budget", optarg, "milliseconds", 1e-6, 1e6, &out->budget_ms) ? 0 : TOOL_USAGE;
    default:
        return tool_fail(TOOL_USAGE, "see: talus help profile");
    }
}

/* --- the live view --- */

typedef struct live {
    double budget_ms;
    uint64_t shown;
    uint32_t lines;
} live;

static void wipe(live *view) {
    if (view->lines > 0) {
        fprintf(stderr, "\033[%" PRIu32 "A\033[J", view->lines);
        view->lines = 0;
    }
}

static void show(const timeline *t, uint32_t run, uint32_t step, void *context) {
    live *view = context;
    uint64_t now = host_clock_ns();
    if (now - view->shown < REDRAW) {
        return;
    }
    view->shown = now;
    gltf_text text = {NULL, 0, 0, 0};
    uint32_t lines = 0;
    timeline_draw(t, run, step, view->budget_ms, &text, &lines);
    wipe(view);
    fprintf(stderr, "\033[?7l%s\033[?7h", text.data != NULL ? text.data : ""); /* lines that are too long are cut */
    fflush(stderr);
    view->lines = text.data != NULL ? lines : 0;
    gltf_text_free(&text);
}

/* --- writing --- */

static int to_output(const char *path) { return path != NULL && strcmp(path, "-") == 0; }

static int write_all(const profile_options *options, const timeline *t) {
    int status = 0;
    gltf_text text = {NULL, 0, 0, 0};
    if (options->csv != NULL) {
        timeline_csv(t, &text);
        status = tool_write_text(options->csv, &text);
    }
    if (status == 0 && options->trace != NULL) {
        timeline_trace(t, &text);
        status = tool_write_text(options->trace, &text);
    }
    if (status == 0 && options->html != NULL) {
        timeline_html(t, options->budget_ms, &text);
        status = tool_write_text(options->html, &text);
    }
    if (status == 0 && options->json) {
        timeline_json(t, options->budget_ms, &text);
        status = tool_write_text("-", &text);
    } else if (status == 0 && !to_output(options->csv) && !to_output(options->trace) && !to_output(options->html)) {
        timeline_print(t, options->budget_ms, &text);
        status = tool_write_text("-", &text);
    }
    return status;
}

static int check_budget(const timeline *t, double budget_ms) {
    uint32_t over = timeline_over(t, budget_ms), worst = 0;
    if (over == 0) {
        return 0;
    }
    timeline_worst(t, &worst, 1);
    return tool_fail(TOOL_SLOW,
                     "%s: %" PRIu32 " of %" PRIu32 " steps go over the budget of %g ms, step %" PRIu32 " with %.4f ms "
                     "furthest",
                     t->name, over, t->steps, budget_ms, worst + 1, (double)t->frames[worst].time.total * 1e-6);
}

static int profile(const profile_options *options) {
    profile_source from;
    timeline t;
    live view = {options->budget_ms, 0, 0};
    int recorded = options->source.scene[0] != '@' && recording_is(options->source.scene);
    if (recorded && (options->source.build.no_sleep || options->source.build.substeps != 0)) {
        return tool_fail(TOOL_USAGE, "profile: %s is a recording: sleep and sub-steps are those it was recorded with",
                         options->source.scene);
    }
    int status =
        recorded
            ? profile_open_recording(&from, options->source.scene, options->source.build.isa, options->source.steps)
            : profile_open_scene(&from, options->source.scene, &options->source.build, options->source.steps);
    if (status != 0) {
        return status;
    }
    int watched = !options->json && isatty(STDERR_FILENO);
    status = timeline_take(&t, &from, options->runs, watched ? show : NULL, &view);
    wipe(&view);
    from.close(&from);
    if (status == 0) {
        status = write_all(options, &t);
    }
    if (status == 0) {
        status = check_budget(&t, options->budget_ms);
    }
    timeline_free(&t);
    return status;
}

int tool_profile(int count, char **arguments) {
    static char name[] = "talus: profile"; /* what getopt's messages begin with */
    profile_options options;
    arguments[0] = name;
    memset(&options, 0, sizeof options);
    options.runs = RUNS;
    options.source = source_options_default();
    int taken = 0;
    for (int option; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        int status = option == HELP ? 0 : take_option(option, &options);
        taken++;
        if (option == HELP) {
            tool_print_manual("profile");
        }
        if (option == HELP || status != 0) {
            return status;
        }
    }
    if (options.compare && taken > 1) {
        return tool_fail(TOOL_USAGE, "profile: --compare takes no other option; see: talus help profile");
    }
    if (options.compare) {
        return optind + 2 == count
                   ? profile_compare(arguments[optind], arguments[optind + 1])
                   : tool_fail(TOOL_USAGE, "profile: --compare takes two profiles; see: talus help profile");
    }
    if (optind + 1 != count) {
        return tool_fail(TOOL_USAGE, "profile: %s; see: talus help profile",
                         optind < count ? "one scene at a time" : "the name of a scene is missing");
    }
    options.source.scene = arguments[optind];
    if (options.json + to_output(options.csv) + to_output(options.trace) + to_output(options.html) > 1) {
        return tool_fail(TOOL_USAGE,
                         "profile: only one of --json, --csv -, --trace - and --html - can have the standard "
                         "output");
    }
    return profile(&options);
}
