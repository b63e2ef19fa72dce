/* talus scene: lists the tool's own scenes, or writes one as glTF. */
#include "host/file.h"
#include "scenes.h"
#include "tool.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_list(void) {
    size_t count;
    const scene_info *infos = scenes_list(&count);
    for (size_t i = 0; i < count; i++) {
        printf("%-10s %s\n", infos[i].name, infos[i].about);
    }
}

static int write_scene(const char *name, const char *path) {
    size_t size = 0;
    int known = 0;
    char *text = scenes_make(name, &size, &known);
    if (text == NULL) {
        return known ? tool_fail(GLTF_FAILED, "there is no memory for the scene")
                     : tool_fail(TOOL_USAGE, "there is no scene \"%s\"; try: talus scene --list", name);
    }
    int status = 0;
    if (host_file_write(path, text, size) != HOST_FILE_OK) {
        status = tool_fail(GLTF_FAILED, "%s: %s", path, strerror(errno));
    }
    free(text);
    return status;
}

int tool_scene(int count, char **arguments) {
    static const struct option options[] = {{"list", no_argument, NULL, 'l'},
                                            {"output", required_argument, NULL, 'o'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    static char title[] = "talus: scene"; /* what getopt's messages begin with */
    const char *path = "-";
    arguments[0] = title;
    for (int option; (option = getopt_long(count, arguments, "lo:", options, NULL)) != -1;) {
        if (option == 'l') {
            print_list();
            return 0;
        }
        if (option == 'h') {
            tool_print_manual("scene");
            return 0;
        }
        if (option != 'o') {
            return tool_fail(TOOL_USAGE, "see: talus help scene");
        }
        path = optarg;
    }
    if (optind + 1 != count) {
        return tool_fail(TOOL_USAGE, "scene: %s; see: talus help scene",
                         optind < count ? "one scene at a time" : "the name of a scene is missing");
    }
    const char *name = arguments[optind];
    return write_scene(name[0] == '@' ? name + 1 : name, path);
}
