/* What the tests of recordings are put together from. */
#ifndef RECORD_KIT_H
#define RECORD_KIT_H

#include "world_kit.h"

/* A recording that grows in memory. */
typedef struct tape {
    unsigned char *bytes;
    size_t size;
    talus_recorder recorder;
    void *memory;
} tape;

static inline void tape_add(tape *t, const void *bytes, size_t size) {
    t->bytes = realloc(t->bytes, t->size + size);
    assert_non_null(t->bytes);
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
}
static inline void tape_begin(tape *t, talus_world *world, size_t commands) {
    const void *bytes;
    size_t size, room = talus_recorder_size(world, commands);
    memset(t, 0, sizeof *t);
    t->memory = malloc(room);
    OK(talus_recorder_begin(&t->recorder, world, t->memory, room, &bytes, &size));
    tape_add(t, bytes, size);
}
static inline void tape_step(tape *t, talus_world *world) {
    const void *bytes;
    size_t size;
    OK(talus_world_step(world, 1.0f / 60.0f, NULL, NULL));
    OK(talus_recorder_step(&t->recorder, world, &bytes, &size));
    tape_add(t, bytes, size);
}
static inline void tape_end(tape *t, talus_world *world) {
    const void *bytes;
    size_t size;
    OK(talus_recorder_end(&t->recorder, world, &bytes, &size));
    tape_add(t, bytes, size);
    free(t->memory);
    t->memory = NULL;
}
static inline void tape_free(tape *t) {
    free(t->memory);
    free(t->bytes);
}

/* A replay with the memory of its world. */
typedef struct player {
    talus_replay replay;
    talus_world world;
    void *block, *geometry;
} player;

static inline talus_status player_open(player *p, const void *bytes, size_t size) {
    memset(p, 0, sizeof *p);
    talus_status status = talus_replay_open(&p->replay, bytes, size);
    if (status != TALUS_OK) {
        return status;
    }
    size_t block_bytes = talus_world_size(&p->replay.def), geometry_bytes = p->replay.geometry_bytes;
    p->block = kit_alloc(block_bytes);
    p->geometry = kit_alloc(geometry_bytes + 1u);
    return talus_replay_begin(&p->replay, &p->world, p->block, block_bytes, p->geometry, geometry_bytes);
}
static inline void player_close(player *p) {
    if (p->block) {
        kit_free(p->block);
        kit_free(p->geometry);
    }
}

#endif
