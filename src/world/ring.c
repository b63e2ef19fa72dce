/* Snapshots of the last steps, one after the other around the caller's memory. */
#include <string.h>

#include "talus/rollback.h"
#include "world/world_internal.h"

/* The table of slots stands at the beginning of the memory, the bytes behind it. */
typedef struct slot {
    uint64_t step, offset, bytes;
} slot;

static slot *slot_of(const talus_ring *ring, uint32_t k) {
    return (slot *)(void *)ring->memory + (ring->first + k) % ring->slots;
}

static size_t table_bytes(uint32_t slots) { return (size_t)slots * sizeof(slot); }

size_t talus_ring_size(const talus_world *world, uint32_t slots) {
    size_t most = talus_world_save_size(world);
    return most ? table_bytes(slots) + ((size_t)slots * 3u / 4u + 2u) * most : 0;
}

talus_status talus_ring_init(talus_ring *ring, void *memory, size_t bytes, uint32_t slots) {
    if (!ring || !memory || slots == 0) {
        return TALUS_BAD_ARGUMENT;
    }
    if ((uintptr_t)memory % sizeof(uint64_t)) {
        return TALUS_UNALIGNED;
    }
    if (bytes <= table_bytes(slots)) {
        return TALUS_SMALL_BLOCK;
    }
    ring->memory = memory, ring->bytes = bytes, ring->slots = slots;
    ring->first = ring->count = 0;
    return TALUS_OK;
}

static void drop_oldest(talus_ring *ring) {
    ring->first = (ring->first + 1u) % ring->slots;
    ring->count--;
}

static uint64_t step_of(const talus_world *world) {
    const tl_header *h = tl_header_of(world);
    return (uint64_t)h->steps_high << 32 | h->steps_low;
}

/* Frees `bytes` in one piece behind the newest snapshot, or at the beginning where they do not fit behind it. */
static uint64_t make_room(talus_ring *ring, size_t bytes) {
    uint64_t at = table_bytes(ring->slots);
    if (ring->count) {
        const slot *newest = slot_of(ring, ring->count - 1u);
        at = newest->offset + newest->bytes + bytes <= ring->bytes ? newest->offset + newest->bytes : at;
    }
    for (uint32_t k = 0; k < ring->count;) {
        const slot *s = slot_of(ring, k);
        if (s->offset < at + bytes && at < s->offset + s->bytes) {
            for (; k > 0; k--) { /* what is older lies further on around the ring */
                drop_oldest(ring);
            }
            drop_oldest(ring);
        } else {
            k++;
        }
    }
    return at;
}

talus_status talus_ring_save(talus_ring *ring, const talus_world *world) {
    size_t most = talus_world_save_size(world);
    if (!ring || !most) {
        return TALUS_BAD_ARGUMENT;
    }
    if (table_bytes(ring->slots) + most > ring->bytes) {
        return TALUS_SMALL_BLOCK;
    }
    uint64_t step = step_of(world);
    while (ring->count && slot_of(ring, ring->count - 1u)->step >= step) {
        ring->count--;
    }
    if (ring->count == ring->slots) {
        drop_oldest(ring);
    }
    slot s = {step, make_room(ring, most), 0};
    size_t written;
    talus_status status = talus_world_save(world, ring->memory + s.offset, most, &written);
    if (status == TALUS_OK) {
        s.bytes = written;
        *slot_of(ring, ring->count++) = s;
    }
    return status;
}

talus_status talus_ring_restore(const talus_ring *ring, talus_world *world, uint64_t step) {
    for (uint32_t k = ring ? ring->count : 0; k-- > 0;) {
        const slot *s = slot_of(ring, k);
        if (s->step == step) {
            return talus_world_restore(world, ring->memory + s->offset, (size_t)s->bytes);
        }
    }
    return TALUS_BAD_ARGUMENT;
}

int talus_ring_span(const talus_ring *ring, uint64_t *oldest, uint64_t *newest) {
    if (!ring || ring->count == 0) {
        return 0;
    }
    *oldest = slot_of(ring, 0)->step;
    *newest = slot_of(ring, ring->count - 1u)->step;
    return 1;
}

talus_status talus_world_step_twice(talus_world *world, float dt, void *memory, size_t bytes, int *same) {
    size_t written;
    talus_status status = same ? talus_world_save(world, memory, bytes, &written) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        status = talus_world_step(world, dt, NULL, NULL);
    }
    if (status != TALUS_OK) {
        return status;
    }
    uint64_t hash = talus_world_hash(world);
    status = talus_world_restore(world, memory, written);
    if (status == TALUS_OK) {
        status = talus_world_step(world, dt, NULL, NULL);
        *same = talus_world_hash(world) == hash;
    }
    return status;
}
