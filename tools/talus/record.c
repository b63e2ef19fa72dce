/* talus record: runs a scene and writes what was done to its world. */
#define _POSIX_C_SOURCE 200809L
#include "host/clock.h"
#include "source.h"
#include "tool.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define COMMAND_BYTES 65536u /* of a step */

typedef struct flip {
    uint64_t step; /* 0: none */
    talus_command command;
} flip;

typedef struct record_options {
    source_options source;
    const char *out;
    flip flip;
    int quiet;
} record_options;

/* --- options --- */

enum { OUTPUT = SOURCE_OPTION_COUNT, FLIP, QUIET, HELP };

static const struct option long_options[] = {SOURCE_LONG_OPTIONS,
                                             {"output", required_argument, NULL, OUTPUT},
                                             {"flip", required_argument, NULL, FLIP},
                                             {"quiet", no_argument, NULL, QUIET},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

/* The column of a name; an exit status with the message told otherwise. */
static int column_of(const char *name, uint32_t *out) {
    char names[1024] = "";
    for (uint32_t i = 0; i < talus_column_count(); i++) {
        talus_column column;
        talus_column_get(i, &column);
        if (strcmp(name, column.name) == 0) {
            *out = i;
            return 0;
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i == 0 ? "" : ", ", column.name);
    }
    return tool_fail(TOOL_USAGE, "--flip: \"%s\" is none of %s", name, names);
}

/* STEP:COLUMN:ROW:BIT */
static int take_flip(const char *text, flip *out) {
    char parts[4][64];
    talus_command_flip *f = &out->command.as.flip;
    memset(parts, 0, sizeof parts);
    if (sscanf(text, "%63[^:]:%63[^:]:%63[^:]:%63[^:]", parts[0], parts[1], parts[2], parts[3]) != 4) {
        return tool_fail(TOOL_USAGE, "--flip: \"%s\" is not STEP:COLUMN:ROW:BIT", text);
    }
    uint64_t row = 0, bit = 0;
    int status = source_whole("--flip: the step", parts[0], 1, SOURCE_MAX_STEPS, &out->step) &&
                         source_whole("--flip: the row", parts[2], 0, UINT32_MAX, &row) &&
                         source_whole("--flip: the bit", parts[3], 0, UINT32_MAX, &bit)
                     ? 0
                     : TOOL_USAGE;
    out->command.kind = TALUS_COMMAND_WORLD_FLIP;
    f->row = (uint32_t)row, f->bit = (uint32_t)bit;
    return status == 0 ? column_of(parts[1], &f->column) : status;
}

static int take_option(int option, record_options *out) {
    switch (option) {
    case 'o':
    case OUTPUT:
        out->out = optarg;
        return 0;
    case FLIP:
        return take_flip(optarg, &out->flip);
    case QUIET:
        out->quiet = 1;
        return 0;
    default:
        return option > 0 && option < SOURCE_OPTION_COUNT ? source_take_option(option, optarg, &out->source)
                                                          : tool_fail(TOOL_USAGE, "see: talus help record");
    }
}

/* --- recording --- */

typedef struct taping {
    const record_options *options;
    source from;
    talus_recorder recorder;
    FILE *file;
    uint64_t bytes, step_ns, record_ns;
} taping;

static int append(taping *t, const void *bytes, size_t size) {
    t->bytes += size;
    if (fwrite(bytes, 1, size, t->file) != size) {
        return tool_fail(GLTF_FAILED, "%s: %s", t->options->out, strerror(errno));
    }
    return 0;
}

/* Plants the one wrong bit. */
static int do_flip(taping *t) {
    talus_command command = t->options->flip.command;
    const talus_command_flip *f = &command.as.flip;
    talus_column column;
    talus_column_get(f->column, &column);
    uint32_t rows = talus_column_rows(&t->from.world.world, f->column);
    if (f->row >= rows || f->bit >= 8 * column.row_bytes) {
        return tool_fail(TOOL_USAGE, "--flip: %s has %" PRIu32 " rows of %" PRIu32 " bits in use then", column.name,
                         rows, 8 * column.row_bytes);
    }
    if (talus_world_apply(&t->from.world.world, &command) != TALUS_OK) {
        return tool_fail(TOOL_USAGE, "--flip: with bit %" PRIu32 " of row %" PRIu32 " of %s the state is not sound",
                         f->bit, f->row, column.name);
    }
    return 0;
}

static int record_steps(taping *t) {
    talus_world *world = &t->from.world.world;
    const void *bytes;
    size_t size;
    for (uint32_t step = 1; step <= t->from.steps; step++) {
        uint64_t start = host_clock_ns();
        talus_status status = talus_world_step(world, t->from.dt, NULL, NULL);
        uint64_t stepped = host_clock_ns();
        int trouble = status == TALUS_OK && t->options->flip.step == step ? do_flip(t) : 0;
        if (status == TALUS_OK && trouble == 0) {
            status = talus_recorder_step(&t->recorder, world, &bytes, &size);
        }
        if (status != TALUS_OK) {
            return tool_fail(GLTF_FAILED, "%s: step %lu: %s", t->options->source.scene, (unsigned long)step,
                             talus_status_text(status));
        }
        trouble = trouble == 0 ? append(t, bytes, size) : trouble;
        if (trouble != 0) {
            return trouble;
        }
        t->step_ns += stepped - start;
        t->record_ns += host_clock_ns() - stepped;
    }
    return talus_recorder_end(&t->recorder, world, &bytes, &size) == TALUS_OK ? append(t, bytes, size) : GLTF_FAILED;
}

static int record_file(taping *t) {
    talus_world *world = &t->from.world.world;
    size_t room = talus_recorder_size(world, COMMAND_BYTES), size;
    const void *bytes;
    void *memory = malloc(room);
    if (memory == NULL) {
        return tool_fail(GLTF_FAILED, "there is no memory for a recorder of %llu bytes", (unsigned long long)room);
    }
    t->file = fopen(t->options->out, "wb");
    if (t->file == NULL) {
        free(memory);
        return tool_fail(GLTF_FAILED, "%s: %s", t->options->out, strerror(errno));
    }
    struct stat about;
    int is_file = fstat(fileno(t->file), &about) == 0 && S_ISREG(about.st_mode);
    talus_status begun = talus_recorder_begin(&t->recorder, world, memory, room, &bytes, &size);
    int status = begun == TALUS_OK ? append(t, bytes, size) : tool_fail(GLTF_FAILED, "%s", talus_status_text(begun));
    status = status == 0 ? record_steps(t) : status;
    if (fclose(t->file) != 0 && status == 0) {
        status = tool_fail(GLTF_FAILED, "%s: %s", t->options->out, strerror(errno));
    }
    if (status != 0 && is_file) {
        remove(t->options->out); /* nothing half-written stays */
    }
    free(memory);
    return status;
}

static void report(const taping *t) {
    uint32_t steps = t->recorder.steps;
    double ms = steps > 0 ? (double)t->step_ns * 1e-6 / steps : 0;
    double more = t->step_ns > 0 ? 100.0 * (double)t->record_ns / (double)t->step_ns : 0;
    printf("%s: %" PRIu32 " bodies, %" PRIu32 " steps of %g s, %.4f ms each; recording took %.1f%% more\n",
           t->from.name, t->from.scene.body_count, steps, (double)t->from.dt, ms, more);
    printf("%s: %" PRIu64 " bytes, %" PRIu32 " keyframes, %.1f bytes a step\n", t->options->out, t->bytes,
           t->recorder.keyframes, steps > 0 ? (double)t->bytes / steps : 0);
    printf("state hash %016" PRIx64 "\n", talus_world_hash(&t->from.world.world));
}

int tool_record(int count, char **arguments) {
    static char name[] = "talus: record"; /* what getopt's messages begin with */
    record_options options;
    arguments[0] = name;
    memset(&options, 0, sizeof options);
    options.source = source_options_default();
    for (int option; (option = getopt_long(count, arguments, "o:", long_options, NULL)) != -1;) {
        int status = option == HELP ? 0 : take_option(option, &options);
        if (option == HELP) {
            tool_print_manual("record");
        }
        if (option == HELP || status != 0) {
            return status;
        }
    }
    if (optind + 1 != count || options.out == NULL) {
        return tool_fail(TOOL_USAGE, "record: %s; see: talus help record",
                         optind + 1 < count    ? "one scene at a time"
                         : options.out == NULL ? "-o FILE is missing"
                                               : "the name of a scene is missing");
    }
    options.source.scene = arguments[optind];
    taping t;
    memset(&t, 0, sizeof t);
    t.options = &options;
    int status = source_open(&t.from, &options.source);
    if (status != 0) {
        return status;
    }
    if (options.flip.step > t.from.steps) {
        status = tool_fail(TOOL_USAGE, "--flip: the run has %" PRIu32 " steps", t.from.steps);
    } else {
        status = record_file(&t);
    }
    if (status == 0 && !options.quiet) {
        report(&t);
    }
    source_close(&t.from);
    return status;
}
