/* Where the world of a run comes from: the options that all subcommands that step a scene share, and the world made of
 * the scene that they name. */
#ifndef TALUS_TOOL_SOURCE_H
#define TALUS_TOOL_SOURCE_H

#include "gltf/build.h"

#include <getopt.h>

#define SOURCE_MAX_STEPS 10000000u
#define SOURCE_LEAST_ERROR_MM 0.001

typedef struct source_options {
    const char *scene; /* a path, or '@' and the name of an own scene */
    gltf_build_options build;
    double dt;      /* s; 0: the scene's */
    uint64_t steps; /* UINT64_MAX: the scene's */
} source_options;

/* The values that the rows below give to getopt_long; a subcommand's own options begin at SOURCE_OPTION_COUNT. */
enum {
    SOURCE_STEPS = 1,
    SOURCE_DT,
    SOURCE_SUBSTEPS,
    SOURCE_ITERATIONS,
    SOURCE_ISA,
    SOURCE_THREADS,
    SOURCE_NO_SLEEP,
    SOURCE_ERROR_BUDGET,
    SOURCE_MOST_SUBSTEPS,
    SOURCE_OPTION_COUNT
};

/* Rows of a getopt_long table. */
/* clang-format off */
#define SOURCE_LONG_OPTIONS                                                                                            \
    {"steps", required_argument, NULL, SOURCE_STEPS}, {"dt", required_argument, NULL, SOURCE_DT},                      \
    {"substeps", required_argument, NULL, SOURCE_SUBSTEPS}, {"threads", required_argument, NULL, SOURCE_THREADS},      \
    {"iterations", required_argument, NULL, SOURCE_ITERATIONS}, {"isa", required_argument, NULL, SOURCE_ISA},          \
    {"no-sleep", no_argument, NULL, SOURCE_NO_SLEEP},                                                                  \
    {"error-budget", required_argument, NULL, SOURCE_ERROR_BUDGET},                                                    \
    {"most-substeps", required_argument, NULL, SOURCE_MOST_SUBSTEPS}
/* clang-format on */

/* Nothing but the scene's own and the library's. */
source_options source_options_default(void);
/* Reads one of the options above; 0, or an exit status with its message told. */
int source_take_option(int option, const char *text, source_options *out);

/* A whole number in [low, high] out of an option's text; 0 with the message told otherwise. */
int source_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out);
/* A number in [low, high] of the unit that `what` names, as in "seconds". */
int source_number(const char *option, const char *text, const char *what, double low, double high, double *out);
/* 0, or an exit status with its message told. */
int source_isa(const char *text, talus_isa *out);

/* Loads a scene by its path, or '@' and the name of one of the tool's own. An exit status, told already, or 0. */
int source_load(const char *path, gltf_scene *scene);
/* The file's name without its folder and ending. */
void source_name(const char *path, char *out, size_t size);

typedef struct source {
    char name[256]; /* the scene's file without its folder and ending */
    gltf_scene scene;
    gltf_world world;
    float dt; /* s */
    uint32_t steps;
} source;

/* Loads the scene and makes its world; 0, or an exit status with its message told and nothing to close. */
int source_open(source *out, const source_options *options);
void source_close(source *from);

#endif
