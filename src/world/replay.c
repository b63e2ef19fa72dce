/* Replaying: looking a recording through, and doing again what it holds. */
#include "world/record.h"

#include <string.h>

#include "base/bits.h"
#include "talus/snapshot.h"
#include "world/command.h"
#include "world/state.h"

static const char *const FAULT_TEXT[TALUS_FAULT_COUNT] = {
    "none",
    "it is no recording",
    "it is of another version of the format",
    "it was recorded by a library with other columns of state",
    "it is damaged",
    "it is cut off before the first state is whole",
};

const char *talus_fault_text(talus_fault fault) {
    return (unsigned)fault < TALUS_FAULT_COUNT ? FAULT_TEXT[fault] : "no such fault";
}

/* --- chunks ----------------------------------------------------------------------------------- */

typedef struct chunk {
    uint32_t kind, bytes, steps;
    const unsigned char *payload;
} chunk;

typedef enum reading { READ, READ_CUT, READ_DAMAGED } reading;

/* The chunk at an offset, its head checked and all of it there. */
static reading read_head(const talus_replay *r, size_t at, chunk *out) {
    const unsigned char *p = r->bytes + at;
    size_t left = r->size - at;
    if (left < TL_CHUNK_HEAD) {
        return READ_CUT;
    }
    out->kind = tl_get_word(p), out->bytes = tl_get_word(p + 4), out->steps = tl_get_word(p + 8);
    out->payload = p + TL_CHUNK_HEAD;
    if (tl_get_word(p + 16) != tl_record_checksum(p, 16) || out->kind < TL_CHUNK_WORLD || out->kind >= TL_CHUNK_KINDS ||
        out->bytes % 4u) {
        return READ_DAMAGED;
    }
    return out->bytes > left - TL_CHUNK_HEAD ? READ_CUT : READ;
}

static size_t end_of(const talus_replay *r, const chunk *c) { return (size_t)(c->payload - r->bytes) + c->bytes; }

/* Whether the parts of a step's payload add up to it. */
static int step_adds_up(const chunk *c) {
    if (c->bytes < 20u) {
        return 0;
    }
    uint32_t used = tl_get_word(c->payload), whole = tl_get_word(c->payload + 8), left = c->bytes - 20u;
    if (used % 4u || used > left || whole > 1u) {
        return 0;
    }
    uint64_t mask = tl_get_long_word(c->payload + 12u + used);
    return mask >> (TL_STATE_COUNT - 1u) <= 1u && left - used == 4u * (tl_bit_count(mask) + whole * TL_STATE_COUNT);
}

/* Takes in what a chunk says of the whole recording; 0 if it is not in its place. */
static int look_at(talus_replay *r, const chunk *c) {
    int begun = r->def.body_capacity != 0;
    switch (c->kind) {
    case TL_CHUNK_WORLD:
        if (begun || c->bytes != 20u || c->steps != 0) {
            return 0;
        }
        r->def = talus_world_def_default();
        r->def.body_capacity = tl_get_word(c->payload), r->def.shape_capacity = tl_get_word(c->payload + 4);
        r->def.joint_capacity = tl_get_word(c->payload + 8), r->def.contact_capacity = tl_get_word(c->payload + 12);
        r->def.event_capacity = tl_get_word(c->payload + 16);
        return talus_world_size(&r->def) != 0;
    case TL_CHUNK_HULL: {
        uint32_t offset = c->bytes >= 4u ? tl_get_word(c->payload) : 1u;
        size_t end = (size_t)offset + c->bytes - 4u;
        if (!begun || offset % TALUS_BLOB_ALIGNMENT || c->bytes < 4u + TALUS_BLOB_ALIGNMENT || end < offset) {
            return 0;
        }
        r->geometry_bytes = end > r->geometry_bytes ? end : r->geometry_bytes;
        return 1;
    }
    case TL_CHUNK_KEYFRAME:
        r->keyframes++;
        return begun && c->bytes > TL_RECORD_HASHES && c->steps == r->steps;
    case TL_CHUNK_STEP:
        if (!r->keyframes || !step_adds_up(c) || c->steps < r->steps) {
            return 0;
        }
        r->steps = c->steps;
        return 1;
    default:
        r->cut = 0;
        return begun && c->bytes == 0 && c->steps == r->steps && end_of(r, c) == r->size;
    }
}

static talus_status fault(talus_replay *r, talus_fault what, size_t offset) {
    r->fault = what;
    r->offset = offset;
    return TALUS_BAD_BLOB;
}

talus_status talus_replay_open(talus_replay *r, const void *bytes, size_t size) {
    if (!r || !bytes) {
        return TALUS_BAD_ARGUMENT;
    }
    memset(r, 0, sizeof *r);
    r->bytes = bytes;
    r->size = size;
    if (memcmp(bytes, "TALUSREC", size < 8u ? size : 8u) != 0) {
        return fault(r, TALUS_FAULT_NO_RECORDING, 0);
    }
    if (size < TL_RECORD_HEAD) {
        return fault(r, TALUS_FAULT_TOO_SHORT, size);
    }
    if (tl_get_word(r->bytes + 8) != TL_RECORD_VERSION) {
        return fault(r, TALUS_FAULT_OTHER_VERSION, 8);
    }
    if (tl_get_word(r->bytes + 12) != tl_state_layout()) {
        return fault(r, TALUS_FAULT_OTHER_LAYOUT, 12);
    }
    r->cut = 1;
    size_t at = TL_RECORD_HEAD;
    chunk c;
    while (r->cut) {
        reading found = read_head(r, at, &c);
        if (found == READ_CUT) {
            break;
        }
        if (found == READ_DAMAGED || tl_get_word(r->bytes + at + 12) != tl_record_checksum(c.payload, c.bytes) ||
            !look_at(r, &c)) {
            return fault(r, TALUS_FAULT_DAMAGED, at);
        }
        at = end_of(r, &c);
    }
    r->offset = at;
    r->at = TL_RECORD_HEAD;
    return r->keyframes ? TALUS_OK : fault(r, TALUS_FAULT_TOO_SHORT, size);
}

/* --- states ----------------------------------------------------------------------------------- */

/* Puts the hulls in their places. They are looked at once all stand: one might lie across another. */
static talus_status take_hulls(const talus_replay *r, unsigned char *region) {
    chunk c;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t at = TL_RECORD_HEAD; at < r->offset && read_head(r, at, &c) == READ; at = end_of(r, &c)) {
            if (c.kind != TL_CHUNK_HULL) {
                continue;
            }
            unsigned char *place = region + tl_get_word(c.payload);
            if (pass == 0 ? !tl_record_get_hull(place, c.payload + 4u, c.bytes - 4u)
                          : talus_hull_validate(place, c.bytes - 4u) != TALUS_OK) {
                return TALUS_BAD_BLOB;
            }
        }
    }
    return TALUS_OK;
}

static void take_hashes(talus_replay *r, const chunk *keyframe) {
    tl_get_words(keyframe->payload, r->whole, TL_STATE_COUNT);
    tl_get_words(keyframe->payload + TL_RECORD_HASHES / 2u, r->hash, TL_STATE_COUNT);
    r->has_whole = 1;
}

static talus_status take_keyframe(talus_replay *r, talus_world *world, const chunk *c) {
    const unsigned char *state = c->payload + TL_RECORD_HASHES;
    if (talus_world_restore(world, state, c->bytes - TL_RECORD_HASHES) != TALUS_OK) {
        return TALUS_BAD_BLOB;
    }
    if (talus_world_validate(world) != TALUS_OK) {
        tl_header_of(world)->magic = 0; /* so that no call follows what is not sound */
        return TALUS_BAD_BLOB;
    }
    take_hashes(r, c);
    r->at = end_of(r, c);
    r->step = c->steps;
    r->commands = NULL;
    r->command_bytes = r->done = 0;
    r->lost = 0;
    r->refused = TALUS_OK;
    return TALUS_OK;
}

talus_status talus_replay_seek(talus_replay *r, talus_world *world, uint32_t step) {
    if (!r || !r->keyframes || !tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    chunk c, found;
    memset(&found, 0, sizeof found);
    for (size_t at = TL_RECORD_HEAD; at < r->offset && read_head(r, at, &c) == READ && c.steps <= step;) {
        if (c.kind == TL_CHUNK_KEYFRAME) {
            found = c;
        }
        at = end_of(r, &c);
    }
    return found.payload ? take_keyframe(r, world, &found) : TALUS_BAD_BLOB;
}

talus_status talus_replay_begin(talus_replay *r, talus_world *world, void *block, size_t block_bytes, void *geometry,
                                size_t geometry_bytes) {
    if (!r || !r->keyframes || (!geometry && r->geometry_bytes)) {
        return TALUS_BAD_ARGUMENT;
    }
    if (geometry_bytes < r->geometry_bytes) {
        return TALUS_SMALL_BLOCK;
    }
    if ((uintptr_t)geometry % TALUS_BLOB_ALIGNMENT) {
        return TALUS_UNALIGNED;
    }
    talus_status status = talus_world_init(world, &r->def, block, block_bytes);
    if (status != TALUS_OK) {
        return status;
    }
    if (r->geometry_bytes) {
        memset(geometry, 0, r->geometry_bytes);
    }
    status = take_hulls(r, geometry);
    world->geometry = geometry;
    world->geometry_bytes = r->geometry_bytes;
    return status == TALUS_OK ? talus_replay_seek(r, world, 0) : status;
}

/* --- steps ------------------------------------------------------------------------------------ */

int talus_replay_next(talus_replay *r) {
    chunk c;
    if (!r) {
        return 0;
    }
    for (; r->at < r->offset && read_head(r, r->at, &c) == READ; r->at = end_of(r, &c)) {
        if (c.kind == TL_CHUNK_KEYFRAME && c.steps == r->step) { /* of the state before the first step */
            take_hashes(r, &c);
        }
        if (c.kind == TL_CHUNK_STEP) {
            r->command_bytes = tl_get_word(c.payload);
            r->lost = tl_get_word(c.payload + 4);
            r->has_whole = tl_get_word(c.payload + 8) != 0;
            r->commands = c.payload + 12;
            const unsigned char *p = r->commands + r->command_bytes;
            uint64_t mask = tl_get_long_word(p);
            p += 8;
            for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
                if (mask >> i & 1u) {
                    r->hash[i] = tl_get_word(p), p += 4;
                }
            }
            if (r->has_whole) {
                tl_get_words(p, r->whole, TL_STATE_COUNT);
            }
            r->step = c.steps;
            r->at = end_of(r, &c);
            r->done = 0;
            r->refused = TALUS_OK;
            return 1;
        }
    }
    return 0;
}

static talus_replayed do_commands(talus_replay *r, talus_world *world) {
    while (r->done < r->command_bytes) {
        talus_command c;
        size_t used = talus_command_decode(&c, r->commands + r->done, r->command_bytes - r->done);
        if (used == 0) {
            r->refused = TALUS_BAD_BLOB;
            return TALUS_REPLAYED_REFUSED;
        }
        uint32_t index = c.index, generation = c.generation;
        if (c.kind == TALUS_COMMAND_WORLD_STEP) {
            c.as.step.clock = r->clock;
        }
        r->refused = talus_world_apply(world, &c);
        if (r->refused != TALUS_OK) {
            return TALUS_REPLAYED_REFUSED;
        }
        r->done += used;
        if (c.index != index || c.generation != generation) {
            r->refused = TALUS_STALE_HANDLE; /* the creation gave another handle than when recorded */
            return TALUS_REPLAYED_REFUSED;
        }
    }
    return TALUS_REPLAYED;
}

talus_replayed talus_replay_step(talus_replay *r, talus_world *world) {
    if (!tl_world_is_sound(world) || !talus_replay_next(r)) {
        return TALUS_REPLAYED_END;
    }
    if (!r->lost) {
        return do_commands(r, world);
    }
    chunk c;
    if (r->at < r->offset && read_head(r, r->at, &c) == READ && c.kind == TL_CHUNK_KEYFRAME &&
        take_keyframe(r, world, &c) == TALUS_OK) {
        return TALUS_REPLAYED_GAP;
    }
    r->refused = TALUS_BAD_BLOB;
    return TALUS_REPLAYED_REFUSED;
}

static uint64_t differing(const uint32_t *a, const uint32_t *b) {
    uint64_t mask = 0;
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        mask |= (uint64_t)(a[i] != b[i]) << i;
    }
    return mask;
}

uint64_t talus_replay_compare(const talus_replay *r, const talus_world *world) {
    uint32_t hash[TL_STATE_COUNT];
    if (!r || !tl_world_is_sound(world)) {
        return ~(uint64_t)0;
    }
    tl_state_active_hashes(tl_header_of(world), hash);
    uint64_t mask = differing(hash, r->hash);
    if (r->has_whole) {
        tl_state_hashes(tl_header_of(world), hash);
        mask |= differing(hash, r->whole);
    }
    return mask;
}

uint64_t talus_replay_differ(const talus_replay *a, const talus_replay *b) {
    uint64_t mask = differing(a->hash, b->hash);
    return a->has_whole && b->has_whole ? mask | differing(a->whole, b->whole) : mask;
}
