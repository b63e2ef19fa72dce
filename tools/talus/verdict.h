/* What a comparison of runs found, and the forms in which it is told. */
#ifndef TALUS_TOOL_VERDICT_H
#define TALUS_TOOL_VERDICT_H

#include "talus/talus.h"

#include <getopt.h>

typedef struct verdict {
    const char *subcommand;
    const char *a, *b; /* files; b is null where a recording is compared with its replay */
    int status;        /* the exit status */
    uint32_t steps;    /* compared and found the same */
    /* where status is TOOL_DIVERGED: the first step that parts, 0 being the state before any */
    uint32_t step;
    talus_column column;
    uint32_t columns; /* that differ in that step */
    int has_values;   /* `parting` is filled in; otherwise only hashes tell */
    talus_parting parting;
    char text[2048]; /* in a sentence */
    double seconds;
} verdict;

typedef struct verdict_options {
    const char *summary, *junit; /* files; null: none */
    int json, quiet;
} verdict_options;

/* The values that the rows below give to getopt_long; a subcommand's own options begin at VERDICT_OPTION_COUNT. */
enum { VERDICT_JSON = 1, VERDICT_SUMMARY, VERDICT_JUNIT, VERDICT_QUIET, VERDICT_OPTION_COUNT };

/* Rows of a getopt_long table. */
/* clang-format off */
#define VERDICT_LONG_OPTIONS                                                                                           \
    {"json", no_argument, NULL, VERDICT_JSON}, {"summary", required_argument, NULL, VERDICT_SUMMARY},                  \
    {"junit", required_argument, NULL, VERDICT_JUNIT}, {"quiet", no_argument, NULL, VERDICT_QUIET}
/* clang-format on */

void verdict_take_option(int option, const char *text, verdict_options *out);

/* Fills in column and columns from a set of columns whose hashes differ. */
void verdict_take_columns(verdict *v, uint64_t columns, int commands);
/* A line on where two runs part, as in "step 12: commit, body_pose of body 3, ..." */
void verdict_describe(const verdict *v, char *out, size_t room);

/* Tells a verdict on the standard output and into the files asked for; the exit status. */
int verdict_tell(const verdict *v, const verdict_options *options);

#endif
