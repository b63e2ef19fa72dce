/* talus bench: what the library's parts cost and how exact they are. */
#define _POSIX_C_SOURCE 200809L
#include "bench_queries.h"
#include "tool.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { QUICK, JSON, PLOT, HELP };

static const struct option long_options[] = {{"quick", no_argument, NULL, QUICK},
                                             {"json", no_argument, NULL, JSON},
                                             {"plot", required_argument, NULL, PLOT},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

int tool_bench(int count, char **arguments) {
    static char name[] = "talus: bench"; /* what getopt's messages begin with */
    static bench_table table;
    const char *plot = NULL;
    int quick = 0, json = 0;
    arguments[0] = name;
    for (int option; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        switch (option) {
        case QUICK:
            quick = 1;
            break;
        case JSON:
            json = 1;
            break;
        case PLOT:
            plot = optarg;
            break;
        case HELP:
            tool_print_manual("bench");
            return 0;
        default:
            return tool_fail(TOOL_USAGE, "see: talus help bench");
        }
    }
    if (optind + 1 != count || strcmp(arguments[optind], "queries") != 0) {
        return tool_fail(TOOL_USAGE, "bench: what to measure is to be named, which can be: queries");
    }
    if (json && plot != NULL && strcmp(plot, "-") == 0) {
        return tool_fail(TOOL_USAGE, "bench: only one of --json and --plot - can have the standard output");
    }
    if (bench_take(&table, quick, !json && isatty(STDERR_FILENO)) != 0) {
        return tool_fail(GLTF_FAILED, "bench: there is no memory for the hulls");
    }
    int status = 0;
    gltf_text text = {NULL, 0, 0, 0};
    if (plot != NULL) {
        bench_plot(&table, &text);
        status = tool_write_text(plot, &text);
    }
    if (status == 0 && (plot == NULL || strcmp(plot, "-") != 0)) {
        if (json) {
            bench_json(&table, &text);
        } else {
            bench_print(&table, &text);
        }
        status = tool_write_text("-", &text);
    }
    return status;
}
