/* Taking a timeline: identical runs, of each step the least. */
#include "timeline.h"

#include "host/clock.h"
#include "tool.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static uint64_t now(void *context) {
    (void)context;
    return host_clock_ns();
}

void timeline_free(timeline *t) {
    for (uint32_t i = 0; i < t->name_count; i++) {
        free(t->names[i]);
    }
    free(t->names);
    free(t->frames);
    free(t->run_ns);
    memset(t, 0, sizeof *t);
}

const char *timeline_name(const timeline *t, uint32_t body) {
    return body < t->name_count && t->names[body] != NULL ? t->names[body] : "a body";
}

/* Takes the frame of a later run into what is there of the step. */
static void take_least(talus_frame *least, const talus_frame *frame) {
    talus_profile time = least->time;
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        time.stage[i] = frame->time.stage[i] < time.stage[i] ? frame->time.stage[i] : time.stage[i];
    }
    if (frame->time.total < time.total) {
        time.total = frame->time.total;
        *least = *frame;
    }
    least->time = time;
}

static int take_names(timeline *t, const profile_source *source) {
    talus_world_def def;
    char buffer[64];
    memset(&def, 0, sizeof def);
    talus_world_get_def(source->world, &def);
    t->names = calloc((size_t)def.body_capacity + 1, sizeof *t->names);
    if (t->names == NULL) {
        return 0;
    }
    t->name_count = def.body_capacity + 1;
    for (uint32_t k = 0; k < t->steps; k++) {
        const talus_frame *f = &t->frames[k];
        for (uint32_t i = 0; i < f->largest_count; i++) {
            uint32_t body = f->largest[i].body.index;
            if (body < t->name_count && t->names[body] == NULL) {
                const char *name = source->name_of(source, body, buffer, sizeof buffer);
                size_t size = strlen(name) + 1;
                t->names[body] = malloc(size);
                if (t->names[body] == NULL) {
                    return 0;
                }
                memcpy(t->names[body], name, size);
            }
        }
    }
    return 1;
}

static void take_settings(timeline *t, const profile_source *source) {
    talus_world_def def;
    memset(&def, 0, sizeof def);
    talus_world_get_def(source->world, &def);
    t->substeps = def.substeps, t->iterations = def.iterations;
    t->sleep = def.enable_sleep, t->isa = talus_world_get_isa(source->world);
}

static int take_run(timeline *t, profile_source *source, uint32_t run, timeline_show show, void *context) {
    const talus_clock clock = {now, NULL};
    for (uint32_t i = 0; i < t->steps; i++) {
        talus_frame frame;
        int status = source->step(source, &clock);
        if (status != 0) {
            return status;
        }
        talus_world_get_frame(source->world, 0, &frame);
        t->run_ns[(size_t)run * t->steps + i] = frame.time.total;
        if (run == 0) {
            t->frames[i] = frame;
        } else {
            take_least(&t->frames[i], &frame);
        }
        if (show != NULL) {
            show(t, run, i, context);
        }
    }
    return 0;
}

int timeline_take(timeline *t, profile_source *source, uint32_t runs, timeline_show show, void *context) {
    memset(t, 0, sizeof *t);
    memcpy(t->name, source->name, sizeof t->name);
    t->bodies = source->bodies, t->shapes = source->shapes, t->joints = source->joints;
    t->steps = source->steps, t->dt = source->dt, t->runs = runs;
    t->frames = calloc((size_t)t->steps + 1, sizeof *t->frames);
    t->run_ns = calloc((size_t)t->steps * runs + 1, sizeof *t->run_ns);
    if (t->frames == NULL || t->run_ns == NULL) {
        return tool_fail(GLTF_FAILED, "there is no memory for %" PRIu32 " steps", t->steps);
    }
    for (uint32_t run = 0; run < runs; run++) {
        int status = source->begin(source);
        if (status != 0) {
            return status;
        }
        take_settings(t, source);
        status = take_run(t, source, run, show, context);
        uint64_t hash = talus_world_hash(source->world);
        if (status == 0 && run > 0 && hash != t->hash) {
            status = tool_fail(GLTF_FAILED,
                               "%s: run %" PRIu32 " ends in the state %016" PRIx64 " and the first in %016" PRIx64
                               ": the runs are not identical",
                               t->name, run + 1, hash, t->hash);
        }
        t->hash = hash;
        if (status == 0 && run + 1 == runs && !take_names(t, source)) {
            status = tool_fail(GLTF_FAILED, "there is no memory for the names of bodies");
        }
        source->end(source);
        if (status != 0) {
            return status;
        }
    }
    return 0;
}
