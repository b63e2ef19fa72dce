/* talus replay: does again what a recording holds, and compares every step with it. */
#include "host/clock.h"
#include "recording.h"
#include "source.h"
#include "tool.h"
#include "verdict.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct replay_options {
    verdict_options tell;
    talus_isa isa;
    uint64_t to; /* the last step */
    int sync_test;
} replay_options;

enum { ISA = VERDICT_OPTION_COUNT, TO, SYNC_TEST, HELP };

static const struct option long_options[] = {VERDICT_LONG_OPTIONS,
                                             {"isa", required_argument, NULL, ISA},
                                             {"to", required_argument, NULL, TO},
                                             {"sync-test", no_argument, NULL, SYNC_TEST},
                                             {"help", no_argument, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

static int take_option(int option, replay_options *out) {
    switch (option) {
    case ISA:
        return source_isa(optarg, &out->isa);
    case TO:
        return source_whole("--to", optarg, 0, UINT32_MAX, &out->to) ? 0 : TOOL_USAGE;
    case SYNC_TEST:
        out->sync_test = 1;
        return 0;
    default:
        if (option > 0 && option < VERDICT_OPTION_COUNT) {
            verdict_take_option(option, optarg, &out->tell);
            return 0;
        }
        return tool_fail(TOOL_USAGE, "see: talus help replay");
    }
}

/* A command that the world answered otherwise than when it was recorded. */
static void describe_refusal(const talus_replay *replay, char *out, size_t room) {
    talus_command command;
    int known =
        talus_command_decode(&command, replay->commands + replay->done, replay->command_bytes - replay->done) > 0;
    snprintf(out, room, "; %s was answered with \"%s\"", known ? talus_command_name(command.kind) : "a command",
             talus_status_text(replay->refused));
}

static void diverge(verdict *v, const recording *r, uint64_t columns, const char *how) {
    char where[512], refused[128] = "";
    v->status = TOOL_DIVERGED;
    v->step = r->replay.step;
    verdict_take_columns(v, columns, r->replay.refused != TALUS_OK);
    verdict_describe(v, where, sizeof where);
    if (r->replay.refused != TALUS_OK) {
        describe_refusal(&r->replay, refused, sizeof refused);
    }
    snprintf(v->text, sizeof v->text, "%s: %s %s%s", r->path, how, where, refused);
}

/* Whether saving, stepping, restoring and stepping again gives the same; goes on after the first of the two steps. */
static int is_in_sync(recording *r, const talus_replay *before, void *snapshot, size_t size, uint64_t *columns) {
    talus_replay after = r->replay;
    uint64_t hash = talus_world_hash(&r->world);
    if (talus_world_restore(&r->world, snapshot, size) != TALUS_OK) {
        *columns = 1;
        return 0;
    }
    r->replay = *before;
    talus_replay_step(&r->replay, &r->world);
    *columns = talus_replay_compare(&r->replay, &r->world);
    return *columns == 0 && talus_world_hash(&r->world) == hash && r->replay.at == after.at;
}

static void replay(const replay_options *options, recording *r, verdict *v) {
    size_t room = options->sync_test ? r->block_bytes : 0;
    void *snapshot = malloc(room + 1);
    uint64_t columns = talus_replay_compare(&r->replay, &r->world);
    if (snapshot == NULL) {
        v->status = GLTF_FAILED;
        snprintf(v->text, sizeof v->text, "%s: there is no memory for a snapshot", r->path);
        return;
    }
    if (columns != 0) {
        diverge(v, r, columns, "the first state is not what its hashes say:");
    }
    while (v->status == 0 && r->replay.step < options->to) {
        talus_replay before = r->replay;
        size_t size = options->sync_test ? talus_world_save_size(&r->world) : 0;
        if (size > room || (size > 0 && talus_world_save(&r->world, snapshot, size, &size) != TALUS_OK)) {
            v->status = GLTF_FAILED;
            snprintf(v->text, sizeof v->text, "%s: step %" PRIu32 ": no snapshot can be taken", r->path, before.step);
            break;
        }
        talus_replayed done = talus_replay_step(&r->replay, &r->world);
        if (done == TALUS_REPLAYED_END) {
            break;
        }
        columns = talus_replay_compare(&r->replay, &r->world);
        if (columns != 0) {
            diverge(v, r, columns, "the replay parts at");
        } else if (done == TALUS_REPLAYED && options->sync_test && !is_in_sync(r, &before, snapshot, size, &columns)) {
            diverge(v, r, columns, "the restored world parts at");
        } else {
            v->steps = r->replay.step;
        }
    }
    free(snapshot);
    if (v->status == 0) {
        int cut = r->replay.cut && r->replay.step == r->replay.steps;
        v->status = cut ? TOOL_SHORTER : 0;
        snprintf(v->text, sizeof v->text, "%s: %" PRIu32 " steps are the same by %s%s", r->path, v->steps,
                 talus_isa_name(talus_world_get_isa(&r->world)), options->sync_test ? ", restored ones too" : "");
        if (cut) {
            size_t used = strlen(v->text);
            snprintf(v->text + used, sizeof v->text - used, "; it is cut off at offset %llu",
                     (unsigned long long)r->replay.offset);
        }
    }
}

int tool_replay(int count, char **arguments) {
    static char name[] = "talus: replay"; /* what getopt's messages begin with */
    replay_options options;
    arguments[0] = name;
    memset(&options, 0, sizeof options);
    options.to = UINT32_MAX;
    for (int option; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        int status = option == HELP ? 0 : take_option(option, &options);
        if (option == HELP) {
            tool_print_manual("replay");
        }
        if (option == HELP || status != 0) {
            return status;
        }
    }
    if (optind + 1 != count) {
        return tool_fail(TOOL_USAGE, "replay: %s; see: talus help replay",
                         optind < count ? "one recording at a time" : "the name of a recording is missing");
    }
    uint64_t begin = host_clock_ns();
    recording r;
    verdict v;
    memset(&v, 0, sizeof v);
    v.subcommand = "replay";
    v.a = arguments[optind];
    v.status = recording_open(&r, arguments[optind], 0, v.text, sizeof v.text);
    if (v.status == 0) {
        talus_world_set_isa(&r.world, options.isa);
        replay(&options, &r, &v);
        recording_close(&r);
    }
    v.seconds = (double)(host_clock_ns() - begin) * 1e-9;
    return verdict_tell(&v, &options.tell);
}
