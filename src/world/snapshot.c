/* Snapshots: a small header, the counts and settings of the block, and the live rows of every state column. */
#include "talus/snapshot.h"

#include <string.h>

#include "talus/command.h"
#include "world/world_internal.h"

#define SNAPSHOT_MAGIC 0x50534c54u /* "TLSP" */
#define SNAPSHOT_VERSION 1u

typedef struct snapshot_header {
    uint32_t magic, version;
    uint32_t bytes_low, bytes_high;
    uint32_t capacity[TL_COUNT_COUNT];
} snapshot_header;

static unsigned char *state_of(const tl_header *h) { return (unsigned char *)(uintptr_t)&h->settings; }
static size_t state_bytes(const tl_header *h) {
    return (size_t)((const unsigned char *)&h->end - (const unsigned char *)&h->settings);
}

/* Bytes of a snapshot of a block with these counts. */
static size_t size_of(const tl_header *h) {
    size_t size = sizeof(snapshot_header) + state_bytes(h);
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_live live;
        if (tl_store_state(h, (tl_column_id)i, &live)) {
            size += (size_t)live.rows * live.row_bytes;
        }
    }
    return size;
}

size_t talus_world_save_size(const talus_world *world) {
    return tl_world_is_sound(world) ? size_of(tl_header_of(world)) : 0;
}

talus_status talus_world_save(const talus_world *world, void *out, size_t bytes) {
    if (!tl_world_is_sound(world) || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    if ((uintptr_t)out % 4u) {
        return TALUS_UNALIGNED;
    }
    const tl_header *h = tl_header_of(world);
    size_t size = size_of(h);
    if (bytes < size) {
        return TALUS_SMALL_BLOCK;
    }
    snapshot_header head;
    memset(&head, 0, sizeof head);
    head.magic = SNAPSHOT_MAGIC, head.version = SNAPSHOT_VERSION;
    head.bytes_low = (uint32_t)size, head.bytes_high = (uint32_t)((uint64_t)size >> 32);
    memcpy(head.capacity, h->capacity, sizeof head.capacity);
    unsigned char *p = out;
    memcpy(p, &head, sizeof head);
    p += sizeof head;
    memcpy(p, state_of(h), state_bytes(h));
    p += state_bytes(h);
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_live live;
        if (tl_store_state(h, (tl_column_id)i, &live)) {
            memcpy(p, live.data, (size_t)live.rows * live.row_bytes);
            p += (size_t)live.rows * live.row_bytes;
        }
    }
    return TALUS_OK;
}

static int counts_fit(const tl_header *h) {
    const uint32_t *c = h->capacity;
    return h->bodies.high >= 1u && h->bodies.high <= c[TL_COUNT_BODY] && h->shapes.high <= c[TL_COUNT_SHAPE] &&
           h->nodes.high <= c[TL_COUNT_NODE] && h->contacts.high <= c[TL_COUNT_CONTACT] &&
           h->joints.high <= c[TL_COUNT_JOINT] && h->awake_bodies < c[TL_COUNT_BODY] &&
           h->awake_contacts <= c[TL_COUNT_CONTACT] && h->awake_joints <= c[TL_COUNT_JOINT] &&
           h->moved_shapes <= c[TL_COUNT_SHAPE];
}

/* Whether the bytes are a snapshot of a block like h; `next` becomes h with the snapshot's counts. */
static int is_snapshot(const tl_header *h, const void *snapshot, size_t bytes, tl_header *next) {
    snapshot_header head;
    if (bytes < sizeof head + state_bytes(h)) {
        return 0;
    }
    memcpy(&head, snapshot, sizeof head);
    uint64_t size = (uint64_t)head.bytes_high << 32 | head.bytes_low;
    if (head.magic != SNAPSHOT_MAGIC || head.version != SNAPSHOT_VERSION || size > bytes ||
        memcmp(head.capacity, h->capacity, sizeof head.capacity) != 0) {
        return 0;
    }
    *next = *h;
    memcpy(state_of(next), (const unsigned char *)snapshot + sizeof head, state_bytes(h));
    return counts_fit(next) && size_of(next) == size;
}

talus_status talus_world_restore(talus_world *world, const void *snapshot, size_t bytes) {
    if (!tl_world_is_sound(world) || !snapshot) {
        return TALUS_BAD_ARGUMENT;
    }
    if ((uintptr_t)snapshot % 4u) {
        return TALUS_UNALIGNED;
    }
    tl_header *h = tl_header_of(world), next;
    if (!is_snapshot(h, snapshot, bytes, &next)) {
        return TALUS_BAD_BLOB;
    }
    const unsigned char *p = (const unsigned char *)snapshot + sizeof(snapshot_header) + state_bytes(h);
    tl_header before = *h;
    memcpy(state_of(h), state_of(&next), state_bytes(h));
    for (uint32_t i = 0; i < TL_COLUMN_COUNT; i++) {
        tl_live live;
        if (tl_store_state(h, (tl_column_id)i, &live)) {
            size_t used = (size_t)live.rows * live.row_bytes;
            size_t was = (size_t)tl_store_live(&before, (tl_column_id)i) * live.row_bytes;
            memcpy(live.data, p, used);
            if (was > used) { /* rows that were not in use then are as new */
                memset(live.data + used, 0, was - used);
            }
            p += used;
        }
    }
    tl_pairs_rebuild(h);
    if (world->log) {
        world->log->lost++; /* no command says what this did */
    }
    return TALUS_OK;
}
