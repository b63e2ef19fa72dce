/* Scenes as what can be profiled. */
#include "source.h"
#include "timeline.h"
#include "tool.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RING 4u /* frames: each is taken as soon as it is there */

typedef struct scene_run {
    gltf_scene scene;
    gltf_world world;
    gltf_build_options options;
    const char *path;
} scene_run;

static int begin(profile_source *from) {
    scene_run *run = from->inner;
    gltf_error error;
    if (gltf_build(&run->scene, &run->options, &run->world, &error) != GLTF_OK) {
        gltf_world_free(&run->world);
        return tool_fail((int)error.status, "%s: %s", run->path, error.text);
    }
    from->world = &run->world.world;
    return 0;
}

static int step(profile_source *from, const talus_clock *clock) {
    talus_status status = talus_world_step(from->world, from->dt, clock, NULL);
    const scene_run *run = from->inner;
    return status == TALUS_OK ? 0
                              : tool_fail(GLTF_FAILED, "%s: a step failed: %s", run->path, talus_status_text(status));
}

static void end(profile_source *from) {
    scene_run *run = from->inner;
    gltf_world_free(&run->world);
    from->world = NULL;
}

static const char *name_of(const profile_source *from, uint32_t body, char *buffer, size_t size) {
    const scene_run *run = from->inner;
    for (uint32_t i = 0; i < run->scene.body_count; i++) {
        if (run->world.bodies[i].index == body) {
            const gltf_body *b = &run->scene.bodies[i];
            if (b->name != NULL) {
                return b->name;
            }
            snprintf(buffer, size, "node %" PRIu32, b->node);
            return buffer;
        }
    }
    return "the world";
}

static void close_scene(profile_source *from) {
    scene_run *run = from->inner;
    gltf_scene_free(&run->scene);
    free(run);
    from->inner = NULL;
}

int profile_open_scene(profile_source *from, const char *path, const gltf_build_options *options, uint64_t steps) {
    memset(from, 0, sizeof *from);
    scene_run *run = calloc(1, sizeof *run);
    if (run == NULL) {
        return tool_fail(GLTF_FAILED, "there is no memory for the scene");
    }
    int status = source_load(path, &run->scene);
    if (status != 0) {
        gltf_scene_free(&run->scene);
        free(run);
        return status;
    }
    run->options = *options;
    run->options.profile_capacity = RING;
    run->path = path;
    source_name(path, from->name, sizeof from->name);
    from->bodies = run->scene.body_count, from->shapes = run->scene.collider_count;
    from->joints = run->scene.joint_count;
    from->steps = steps == UINT64_MAX ? run->scene.steps : (uint32_t)steps;
    from->dt = run->scene.dt;
    from->inner = run;
    from->begin = begin, from->step = step, from->end = end;
    from->name_of = name_of, from->close = close_scene;
    return 0;
}
