/* Recordings as what can be profiled: every run replays one from its beginning. */
#include "recording.h"
#include "source.h"
#include "timeline.h"
#include "tool.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RING 4u /* frames: each is taken as soon as it is there */

typedef struct recording_run {
    const char *path;
    talus_isa isa;
    recording inner;
} recording_run;

static int open_it(recording_run *run) {
    char text[512];
    int status = recording_open(&run->inner, run->path, RING, text, sizeof text);
    return status == 0 ? 0 : tool_fail(status, "%s", text);
}

static int begin(profile_source *from) {
    recording_run *run = from->inner;
    int status = open_it(run);
    if (status != 0) {
        return status;
    }
    talus_world_set_isa(&run->inner.world, run->isa);
    from->world = &run->inner.world;
    return 0;
}

static int step(profile_source *from, const talus_clock *clock) {
    recording_run *run = from->inner;
    talus_replay *replay = &run->inner.replay;
    replay->clock = clock;
    switch (talus_replay_step(replay, from->world)) {
    case TALUS_REPLAYED:
        return 0;
    case TALUS_REPLAYED_GAP:
        return tool_fail(GLTF_UNSUPPORTED, "%s: step %" PRIu32 " was recorded by its outcome and cannot be run again",
                         run->path, replay->step);
    default:
        return tool_fail(TOOL_DIVERGED, "%s: step %" PRIu32 " cannot be replayed: %s", run->path, replay->step,
                         talus_status_text(replay->refused));
    }
}

static void end(profile_source *from) {
    recording_run *run = from->inner;
    recording_close(&run->inner);
    from->world = NULL;
}

static const char *name_of(const profile_source *from, uint32_t body, char *buffer, size_t size) {
    (void)from;
    if (body == 0) {
        return "the world";
    }
    snprintf(buffer, size, "body %" PRIu32, body);
    return buffer;
}

static void close_recording(profile_source *from) {
    free(from->inner);
    from->inner = NULL;
}

/* s: the length of the first step; 0 if there is none. */
static float first_dt(recording_run *run) {
    talus_replay r = run->inner.replay;
    talus_command c;
    if (!talus_replay_next(&r)) {
        return 0.0f;
    }
    for (size_t at = 0, used; at < r.command_bytes; at += used) {
        used = talus_command_decode(&c, r.commands + at, r.command_bytes - at);
        if (used == 0 || c.kind == TALUS_COMMAND_WORLD_STEP) {
            return used == 0 ? 0.0f : c.as.step.dt;
        }
    }
    return 0.0f;
}

int profile_open_recording(profile_source *from, const char *path, talus_isa isa, uint64_t steps) {
    memset(from, 0, sizeof *from);
    recording_run *run = calloc(1, sizeof *run);
    if (run == NULL) {
        return tool_fail(GLTF_FAILED, "there is no memory for the recording");
    }
    run->path = path, run->isa = isa;
    int status = open_it(run);
    if (status != 0) {
        free(run);
        return status;
    }
    talus_counters n;
    talus_world_get_counters(&run->inner.world, &n);
    from->bodies = n.bodies.used - 1u, from->shapes = n.shapes.used, from->joints = n.joints.used;
    from->steps = run->inner.replay.steps;
    from->steps = steps < from->steps ? (uint32_t)steps : from->steps;
    from->dt = first_dt(run);
    source_name(path, from->name, sizeof from->name);
    recording_close(&run->inner);
    from->inner = run;
    from->begin = begin, from->step = step, from->end = end;
    from->name_of = name_of, from->close = close_recording;
    return 0;
}
