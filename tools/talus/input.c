#include "input.h"

#include "scenes.h"
#include "tool.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int input_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out) {
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

int input_number(const char *option, const char *text, const char *what, double low, double high, double *out) {
    char *end = NULL;
    *out = strtod(text, &end);
    if (end == text || *end != 0 || !(*out >= low && *out <= high)) {
        tool_fail(TOOL_USAGE, "%s: \"%s\" is not a number of %s from %g to %g", option, text, what, low, high);
        return 0;
    }
    return 1;
}

int input_isa(const char *text, talus_isa *out) {
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

int input_scene(const char *path, gltf_scene *scene) {
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

void input_name(const char *path, char *out, size_t size) {
    const char *slash = strrchr(path, '/');
    snprintf(out, size, "%s", slash != NULL ? slash + 1 : path[0] == '@' ? path + 1 : path);
    char *dot = strrchr(out, '.');
    if (dot != NULL && dot != out) {
        *dot = 0;
    }
}
