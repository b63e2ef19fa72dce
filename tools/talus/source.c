#include "source.h"

#include "scenes.h"
#include "tool.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- options --- */

int source_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out) {
    char *end = NULL;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (errno != 0 || end == text || *end != 0 || text[0] == '-' || value < low || value > high) {
        tool_fail(TOOL_USAGE, "%s: \"%s\" is not a whole number from %llu to %llu", option, text,
                  (unsigned long long)low, (unsigned long long)high);
        return 0;
    }
    *out = value;
    return 1;
}

int source_number(const char *option, const char *text, const char *what, double low, double high, double *out) {
    char *end = NULL;
    *out = strtod(text, &end);
    if (end == text || *end != 0 || !(*out >= low && *out <= high)) {
        tool_fail(TOOL_USAGE, "%s: \"%s\" is not a number of %s from %g to %g", option, text, what, low, high);
        return 0;
    }
    return 1;
}

int source_isa(const char *text, talus_isa *out) {
    char names[160] = "";
    for (int i = 0; i < TALUS_ISA_COUNT; i++) {
        const char *name = talus_isa_name((talus_isa)i);
        if (strcmp(text, name) == 0) {
            *out = (talus_isa)i;
            if (i == TALUS_ISA_BEST || talus_isa_available(*out)) {
                return 0;
            }
            return tool_fail(GLTF_UNSUPPORTED, "--isa: \"%s\" is not in this build or on this processor", text);
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i == 0 ? "" : ", ", name);
    }
    return tool_fail(TOOL_USAGE, "--isa: \"%s\" is none of %s", text, names);
}

source_options source_options_default(void) {
    source_options options;
    memset(&options, 0, sizeof options);
    options.build.isa = TALUS_ISA_BEST;
    options.steps = UINT64_MAX;
    return options;
}

/* From 1 to `most`. */
static int take_count(const char *name, const char *text, uint64_t most, uint32_t *out) {
    uint64_t number = 0;
    if (!source_whole(name, text, 1, most, &number)) {
        return TOOL_USAGE;
    }
    *out = (uint32_t)number;
    return 0;
}

int source_take_option(int option, const char *text, source_options *out) {
    uint64_t number = 0;
    switch (option) {
    case SOURCE_STEPS:
        return source_whole("--steps", text, 0, SOURCE_MAX_STEPS, &out->steps) ? 0 : TOOL_USAGE;
    case SOURCE_DT:
        return source_number("--dt", text, "seconds", 1e-6, 1, &out->dt) ? 0 : TOOL_USAGE;
    case SOURCE_SUBSTEPS:
        return take_count("--substeps", text, TALUS_MAX_SUBSTEPS, &out->build.substeps);
    case SOURCE_ITERATIONS:
        return take_count("--iterations", text, TALUS_MAX_ITERATIONS, &out->build.iterations);
    case SOURCE_THREADS:
        if (!source_whole("--threads", text, 1, 1024, &number)) {
            return TOOL_USAGE;
        }
        return number == 1 ? 0 : tool_fail(GLTF_UNSUPPORTED, "--threads: a step runs on one thread");
    case SOURCE_ISA:
        return source_isa(text, &out->build.isa);
    case SOURCE_ERROR_BUDGET: {
        double mm;
        if (!source_number("--error-budget", text, "mm", SOURCE_LEAST_ERROR_MM, 1000, &mm)) {
            return TOOL_USAGE;
        }
        out->build.error_budget = (float)(mm * 1e-3);
        return 0;
    }
    case SOURCE_MOST_SUBSTEPS:
        return take_count("--most-substeps", text, TALUS_MAX_SUBSTEPS, &out->build.most_substeps);
    default:
        out->build.no_sleep = 1;
        return 0;
    }
}

/* --- loading --- */

int source_load(const char *path, gltf_scene *scene) {
    gltf_error error;
    if (path[0] != '@') {
        gltf_scene_load_file(scene, path, &error);
    } else {
        size_t size = 0;
        int known = 0;
        char *text = scenes_make(path + 1, &size, &known);
        if (text == NULL) {
            return known ? tool_fail(GLTF_FAILED, "there is no memory for the scene")
                         : tool_fail(TOOL_USAGE, "there is no scene \"%s\"; try: talus scene --list", path);
        }
        gltf_scene_load(scene, text, size, NULL, &error);
        free(text);
    }
    return error.status == GLTF_OK ? 0 : tool_fail((int)error.status, "%s: %s", path, error.text);
}

/* The file's name without its folder and ending. */
void source_name(const char *path, char *out, size_t size) {
    const char *slash = strrchr(path, '/');
    snprintf(out, size, "%s", slash != NULL ? slash + 1 : path[0] == '@' ? path + 1 : path);
    char *dot = strrchr(out, '.');
    if (dot != NULL && dot != out) {
        *dot = 0;
    }
}

int source_open(source *out, const source_options *options) {
    memset(out, 0, sizeof *out);
    int status = source_load(options->scene, &out->scene);
    if (status != 0) {
        return status;
    }
    gltf_error error;
    if (gltf_build(&out->scene, &options->build, &out->world, &error) != GLTF_OK) {
        gltf_scene_free(&out->scene);
        return tool_fail((int)error.status, "%s: %s", options->scene, error.text);
    }
    source_name(options->scene, out->name, sizeof out->name);
    out->dt = options->dt > 0 ? (float)options->dt : out->scene.dt;
    out->steps = options->steps == UINT64_MAX ? out->scene.steps : (uint32_t)options->steps;
    return 0;
}

void source_close(source *from) {
    gltf_world_free(&from->world);
    gltf_scene_free(&from->scene);
}
