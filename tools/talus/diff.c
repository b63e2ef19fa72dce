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
    v->status = TOOL_DIVERGED;
    v->step = a->replay.step;
    v->has_values = talus_world_part(&a->world, &b->world, differ, &v->parting) == 1;
    v->column = v->parting.column;
    v->columns = v->parting.columns;
    verdict_describe(v, where, sizeof where);
    snprintf(v->text, sizeof v->text, "%s%s", where, commands);
}

/* Says in `why` that a recording cannot be followed here. */
static void is_not_true(const recording *r, uint64_t columns, char *why, size_t room) {
    talus_column column;
    talus_column_get(talus_column_first(columns, 0), &column);
    snprintf(why, room,
             "; of its values nothing is known: here %s replays otherwise than recorded from step %" PRIu32 " on, %s",
             r->path, r->replay.step, column.name);
}

/* Does the next step; 0 with the reason in `why` if the state is not the recorded one. */
static int follow(recording *r, char *why, size_t room) {
    talus_replay_step(&r->replay, &r->world);
    uint64_t columns = talus_replay_compare(&r->replay, &r->world);
    if (columns != 0) {
        is_not_true(r, columns, why, room);
    }
    return columns == 0;
}

typedef enum search { SEARCH_PARTED, SEARCH_SAME, SEARCH_LOST } search;

/* Brings both worlds from `sure`, a step after which the whole states are known to be the same, to the first that
 * parts, at the latest `step`. SEARCH_LOST with the reason in `why` if they cannot be followed. */
static search go_to_parting(recording *a, recording *b, const talus_replay *sure, uint32_t step, char *why,
                            size_t room) {
    talus_parting parting;
    int parts = 0;
    if (talus_replay_seek(&a->replay, &a->world, sure->step) != TALUS_OK) {
        is_not_true(a, 1, why, room);
        return SEARCH_LOST;
    }
    while (a->replay.step < sure->step) {
        if (!follow(a, why, room)) {
            return SEARCH_LOST;
        }
    }
    memcpy(b->world.block, a->world.block, a->block_bytes);
    b->replay = *sure;
    while (!parts && a->replay.step < step) {
        if (!follow(a, why, room) || !follow(b, why, room)) {
            return SEARCH_LOST;
        }
        parts = talus_world_part(&a->world, &b->world, 0, &parting) == 1;
    }
    return parts ? SEARCH_PARTED : SEARCH_SAME;
}

/* Looks for the values that part up to where both replays stand; 1 if they were found or, since the recorded hashes
 * part there, told without. */
static int explain(verdict *v, recording *a, recording *b, const talus_replay *sure) {
    char why[512] = "";
    talus_replay at_a = a->replay, at_b = b->replay;
    uint64_t columns = talus_replay_differ(&at_a, &at_b);
    if (columns == 0 && at_a.step == sure->step) {
        return 0;
    }
    if (go_to_parting(a, b, sure, at_a.step, why, sizeof why) == SEARCH_PARTED) {
        v->steps = a->replay.step - 1;
        tell_values(v, a, b);
        return 1;
    }
    a->replay = at_a, b->replay = at_b;
    if (columns != 0) {
        tell_hashes(v, a, b, columns, why);
    }
    return columns != 0;
}

static void compare(recording *a, recording *b, verdict *v) {
    if (memcmp(&a->replay.def, &b->replay.def, sizeof a->replay.def) != 0) {
        v->status = GLTF_UNSUPPORTED;
        snprintf(v->text, sizeof v->text, "%s and %s: their worlds have other capacities and cannot be compared",
                 a->path, b->path);
        return;
    }
    if (talus_replay_differ(&a->replay, &b->replay) != 0) {
        tell_values(v, a, b);
        return;
    }
    for (talus_replay sure = b->replay;;) {
        talus_replay last_a = a->replay, last_b = b->replay;
        int more_a = talus_replay_next(&a->replay), more_b = talus_replay_next(&b->replay);
        if (!more_a || !more_b) {
            a->replay = last_a, b->replay = last_b;
            if (explain(v, a, b, &sure)) { /* since the last hashes of the whole state */
                return;
            }
            break;
        }
        if (a->replay.step != b->replay.step) {
            v->status = GLTF_UNSUPPORTED;
            snprintf(v->text, sizeof v->text, "%s and %s: one is recorded in steps, the other in several at once",
                     a->path, b->path);
            return;
        }
        /* A recording of the whole state out of turn had a reason. */
        int suspicious = a->replay.has_whole != b->replay.has_whole;
        if ((talus_replay_differ(&a->replay, &b->replay) != 0 || suspicious) && explain(v, a, b, &sure)) {
            return;
        }
        v->steps = a->replay.step;
        sure = a->replay.has_whole && b->replay.has_whole ? b->replay : sure;
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
    v.status = recording_open(&a, v.a, 0, v.text, sizeof v.text);
    if (v.status == 0) {
        v.status = recording_open(&b, v.b, 0, v.text, sizeof v.text);
        if (v.status == 0) {
            compare(&a, &b, &v);
            recording_close(&b);
        }
        recording_close(&a);
    }
    v.seconds = (double)(host_clock_ns() - begin) * 1e-9;
    return verdict_tell(&v, &options);
}
