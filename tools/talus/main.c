/* talus: runs physics scenes without a window. */
#include "host/file.h"
#include "tool.h"

#include "talus/version.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

int tool_write_text(const char *path, gltf_text *text) {
    int status = 0;
    if (text->failed) {
        status = tool_fail(GLTF_FAILED, "%s: there is no memory for it", path);
    } else if (host_file_write(path, text->data, text->size) != HOST_FILE_OK) {
        status = tool_fail(GLTF_FAILED, "%s: %s", path, strerror(errno));
    }
    gltf_text_free(text);
    return status;
}

static int help(int count, char **arguments) {
    const char *subcommand = count > 1 ? arguments[1] : NULL;
    if (!tool_print_manual(subcommand)) {
        return tool_fail(TOOL_USAGE, "there is no help on \"%s\"; try: talus help", subcommand);
    }
    return 0;
}

static int version(int count, char **arguments) {
    (void)count;
    (void)arguments;
    printf("talus %s\n", TALUS_VERSION);
    return 0;
}

int main(int count, char **arguments) {
    static const struct {
        const char *name;
        int (*run)(int count, char **arguments);
    } commands[] = {{"run", tool_run},       {"profile", tool_profile},
                    {"scene", tool_scene},   {"record", tool_record},
                    {"replay", tool_replay}, {"diff", tool_diff},
                    {"bench", tool_bench},   {"help", help},
                    {"--help", help},        {"-h", help},
                    {"version", version},    {"--version", version},
                    {"-V", version}};
    if (count < 2) {
        tool_print_manual(NULL);
        return TOOL_USAGE;
    }
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(arguments[1], commands[i].name) == 0) {
            int status = commands[i].run(count - 1, arguments + 1);
            if ((fflush(stdout) != 0 || ferror(stdout)) && status == 0) {
                status = tool_fail(GLTF_FAILED, "the standard output could not be written");
            }
            return status;
        }
    }
    return tool_fail(TOOL_USAGE, "there is no subcommand \"%s\"; try: talus help", arguments[1]);
}
