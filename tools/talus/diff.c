/* talus diff: finds where two recordings part. The hashes of every step say which step; a replay from the last keyframe
 * before it has both states, and so the value. */
#include "host/clock.h"
#include "recording.h"
#include "tool.h"
#include "verdict.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { HELP = VERDICT_OPTION_COUNT };

static const struct option long_options[] = {
    VERDICT_LONG_OPTIONS, {"help", no_argument, NULL, HELP}, {NULL, 0, NULL, 0}};

/* The columns whose recorded hashes differ. */
static uint64_t differing(const talus_replay *a, const talus_replay *b) {
    uint64_t columns = 0;
    for (uint32_t i = 0; i < talus_column_count(); i++) {
        columns |= (uint64_t)(a->hash[i] != b->hash[i]) << i;
    }
    return columns;
}

/* The next command of a step that is not a flip, which is an error and no command: 0 if there is none. */
static size_t next_command(const talus_replay *r, size_t *at, talus_command *out) {
    size_t used;
    do {
        used = talus_command_decode(out, r->commands + *at, r->command_bytes - *at);
        *at += used;
    } while (used > 0 && out->kind == TALUS_COMMAND_WORLD_FLIP);
    return used;
}

/* Whether the commands of the present steps differ, and the names of the first that do. */
static int commands_differ(const talus_replay *a, const talus_replay *b, char *out, size_t room) {
    size_t at_a = 0, at_b = 0, used_a, used_b;
    talus_command ca, cb;
    out[0] = 0;
    if (a->commands == NULL || b->commands == NULL || a->lost || b->lost) {
        return 0;
    }
    do {
        used_a = next_command(a, &at_a, &ca);
        used_b = next_command(b, &at_b, &cb);
        if (used_a != used_b || memcmp(a->commands + at_a - used_a, b->commands + at_b - used_b, used_a) != 0) {
            snprintf(out, room, "; its commands differ: %s and %s", used_a ? talus_command_name(ca.kind) : "none",
                     used_b ? talus_command_name(cb.kind) : "none");
            return 1;
        }
    } while (used_a > 0);
    return 0;
}

static void tell_hashes(verdict *v, const recording *a, const recording *b, uint64_t columns, const char *why) {
    char commands[128], where[512];
    int differ = commands_differ(&a->replay, &b->replay, commands, sizeof commands);
    v->status = TOOL_DIVERGED;
    v->step = a->replay.step;
    verdict_take_columns(v, columns, differ);
    verdict_describe(v, where, sizeof where);
    snprintf(v->text, sizeof v->text, "%s%s%s", where, commands, why);
}

/* Both worlds are in the states that part. */
static void tell_values(verdict *v, const recording *a, const recording *b) {
    char commands[128], where[512];
    int differ = commands_differ(&a->replay, &b->replay, commands, sizeof commands);
    v->has_values = talus_world_part(&a->world, &b->world, differ, &v->parting) == 1;
    v->column = v->parting.column;
    v->columns = v->parting.columns;
    verdict_describe(v, where, sizeof where);
    snprintf(v->text, sizeof v->text, "%s%s", where, commands);
}

/* Brings world a to the step that both have in common, from the last keyframe; 0 with the reason in `why` if it is not
 * the recorded state there. */
static int go_to(recording *a, uint32_t step, char *why, size_t room) {
    uint64_t columns = talus_replay_seek(&a->replay, &a->world, step) == TALUS_OK ? 0 : 1;
    while (columns == 0 && a->replay.step < step && talus_replay_step(&a->replay, &a->world) != TALUS_REPLAYED_END) {
        columns = talus_replay_compare(&a->replay, &a->world);
    }
    if (columns == 0) {
        return 1;
    }
    talus_column column;
    talus_column_get(talus_column_first(columns, 0), &column);
    snprintf(why, room,
             "; of its values nothing is known: here %s replays otherwise than recorded from step %" PRIu32 " on, %s",
             a->path, a->replay.step, column.name);
    return 0;
}

/* The recorded hashes part at the step that both replays stand at; `before` is b's before it. */
static void explain(verdict *v, recording *a, recording *b, const talus_replay *before) {
    char why[512];
    talus_replay at = a->replay;
    uint64_t columns = differing(&a->replay, &b->replay);
    tell_hashes(v, a, b, columns, "");
    if (!go_to(a, before->step, why, sizeof why)) {
        a->replay = at;
        tell_hashes(v, a, b, columns, why);
        return;
    }
    /* b was in the same state: its hashes say so. */
    memcpy(b->world.block, a->world.block, a->block_bytes);
    b->replay = *before;
    talus_replay_step(&a->replay, &a->world);
    talus_replay_step(&b->replay, &b->world);
    int a_is_true = talus_replay_compare(&a->replay, &a->world) == 0;
    int b_is_true = talus_replay_compare(&b->replay, &b->world) == 0;
    if (a_is_true && b_is_true) {
        tell_values(v, a, b);
        return;
    }
    snprintf(why, sizeof why, "; of its values nothing is known: here %s%s%s replays otherwise than recorded",
             a_is_true ? "" : a->path, a_is_true || b_is_true ? "" : " as well as ", b_is_true ? "" : b->path);
    tell_hashes(v, a, b, columns, why);
}

static void compare(recording *a, recording *b, verdict *v) {
    if (memcmp(&a->replay.def, &b->replay.def, sizeof a->replay.def) != 0) {
        v->status = GLTF_UNSUPPORTED;
        snprintf(v->text, sizeof v->text, "%s and %s: their worlds have other capacities and cannot be compared",
                 a->path, b->path);
        return;
    }
    if (differing(&a->replay, &b->replay) != 0) {
        tell_hashes(v, a, b, differing(&a->replay, &b->replay), "");
        tell_values(v, a, b);
        return;
    }
    for (;;) {
        talus_replay before = b->replay;
        int more_a = talus_replay_next(&a->replay), more_b = talus_replay_next(&b->replay);
        if (!more_a || !more_b) {
            break;
        }
        if (a->replay.step != b->replay.step) {
            v->status = GLTF_UNSUPPORTED;
            snprintf(v->text, sizeof v->text, "%s and %s: one is recorded in steps, the other in several at once",
                     a->path, b->path);
            return;
        }
        if (differing(&a->replay, &b->replay) != 0) {
            explain(v, a, b, &before);
            return;
        }
        v->steps = a->replay.step;
    }
    int same = a->replay.steps == b->replay.steps && !a->replay.cut && !b->replay.cut;
    v->status = same ? 0 : TOOL_SHORTER;
    snprintf(v->text, sizeof v->text, "%" PRIu32 " steps are the same", v->steps);
    if (!same) {
        snprintf(v->text, sizeof v->text, "%" PRIu32 " steps are the same; %s has %" PRIu32 "%s, %s has %" PRIu32 "%s",
                 v->steps, a->path, a->replay.steps, a->replay.cut ? " and is cut off" : "", b->path, b->replay.steps,
                 b->replay.cut ? " and is cut off" : "");
    }
}

int tool_diff(int count, char **arguments) {
    static char name[] = "talus: diff"; /* what getopt's messages begin with */
    verdict_options options;
    arguments[0] = name;
    memset(&options, 0, sizeof options);
    for (int option; (option = getopt_long(count, arguments, "", long_options, NULL)) != -1;) {
        if (option == HELP) {
            tool_print_manual("diff");
            return 0;
        }
        if (option <= 0 || option >= VERDICT_OPTION_COUNT) {
            return tool_fail(TOOL_USAGE, "see: talus help diff");
        }
        verdict_take_option(option, optarg, &options);
    }
    if (optind + 2 != count) {
        return tool_fail(TOOL_USAGE, "diff: two recordings are to be named; see: talus help diff");
    }
    uint64_t begin = host_clock_ns();
    recording a, b;
    verdict v;
    memset(&v, 0, sizeof v);
    v.subcommand = "diff";
    v.a = arguments[optind], v.b = arguments[optind + 1];
    v.status = recording_open(&a, v.a, v.text, sizeof v.text);
    if (v.status == 0) {
        v.status = recording_open(&b, v.b, v.text, sizeof v.text);
        if (v.status == 0) {
            compare(&a, &b, &v);
            recording_close(&b);
        }
        recording_close(&a);
    }
    v.seconds = (double)(host_clock_ns() - begin) * 1e-9;
    return verdict_tell(&v, &options);
}
