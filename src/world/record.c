/* Recording: chunks out of what a world did. */
#include "world/record.h"

#include <string.h>

#include "geom/hull_derive.h"
#include "talus/snapshot.h"
#include "world/command.h"
#include "world/state.h"
#include "world/world_internal.h"

/* FNV-1a by words in four streams, so that the multiplications overlap. */
uint32_t tl_record_checksum(const unsigned char *bytes, size_t size) {
    uint64_t stream[4] = {0xcbf29ce484222325u, 1u, 2u, 3u};
    size_t words = size / 4u, i = 0;
    for (; i + 4u <= words; i += 4u) {
        for (unsigned k = 0; k < 4u; k++) {
            stream[k] = (stream[k] ^ tl_get_word(bytes + 4u * (i + k))) * 0x100000001b3u;
            stream[k] ^= stream[k] >> 32;
        }
    }
    for (; i < words; i++) {
        stream[i % 4u] = (stream[i % 4u] ^ tl_get_word(bytes + 4u * i)) * 0x100000001b3u;
        stream[i % 4u] ^= stream[i % 4u] >> 32;
    }
    uint64_t h = size;
    for (unsigned k = 0; k < 4u; k++) {
        h = (h ^ stream[k]) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
    }
    return (uint32_t)h;
}

/* --- hulls ------------------------------------------------------------------------------------ */

/* Turns words of a size around where this machine keeps the highest byte first. */
static void copy_small(unsigned char *to, const unsigned char *from, size_t bytes, unsigned word) {
    unsigned turn = tl_high_byte_first() ? word - 1u : 0u;
    for (size_t i = 0; i < bytes; i++) {
        to[i ^ turn] = from[i];
    }
}

void tl_record_put_hull(unsigned char *out, const talus_hull *hull) {
    const unsigned char *from = (const unsigned char *)hull;
    copy_small(out, from, hull->vertex_edge, 4);
    copy_small(out + hull->vertex_edge, from + hull->vertex_edge, hull->bytes - hull->vertex_edge, 2);
    tl_put_word(out + offsetof(talus_hull, checksum), 0); /* of this machine's words; the chunk has one of its own */
}

int tl_record_get_hull(unsigned char *out, const unsigned char *in, size_t bytes) {
    talus_hull h, laid;
    if (bytes < sizeof h) {
        return 0;
    }
    copy_small((unsigned char *)&h, in, sizeof h, 4);
    laid = h;
    if (h.bytes != bytes || h.vertex_count > 65536u || h.face_count > 65536u || h.half_edge_count > 65536u) {
        return 0;
    }
    tl_hull_layout(&laid);
    if (laid.bytes != h.bytes || laid.vertex_edge != h.vertex_edge) {
        return 0;
    }
    copy_small(out, in, h.vertex_edge, 4);
    copy_small(out + h.vertex_edge, in + h.vertex_edge, bytes - h.vertex_edge, 2);
    h.checksum = tl_hull_checksum(out, h.bytes);
    memcpy(out, &h, 16);
    return 1;
}

/* --- chunks ----------------------------------------------------------------------------------- */

/* Fills in the head of a chunk whose payload of `bytes` bytes stands behind it; returns the bytes of both. */
static size_t close_chunk(unsigned char *at, uint32_t kind, size_t bytes, uint32_t steps) {
    tl_put_word(at, kind);
    tl_put_word(at + 4, (uint32_t)bytes);
    tl_put_word(at + 8, steps);
    tl_put_word(at + 12, tl_record_checksum(at + TL_CHUNK_HEAD, bytes));
    tl_put_word(at + 16, tl_record_checksum(at, 16));
    return TL_CHUNK_HEAD + bytes;
}

#define STEP_BEFORE (TL_CHUNK_HEAD + 12u)  /* bytes of a step's chunk before the commands */
#define STEP_AFTER (8u + TL_RECORD_HASHES) /* and behind them, at most */

static size_t keyframe_most(const tl_header *h) { return TL_CHUNK_HEAD + TL_RECORD_HASHES + tl_snapshot_most(h) + 4u; }

static size_t write_keyframe(talus_recorder *r, const talus_world *world, unsigned char *at) {
    const tl_header *h = tl_header_of(world);
    size_t bytes = 0;
    unsigned char *p = at + TL_CHUNK_HEAD;
    uint32_t whole[TL_STATE_COUNT];
    tl_state_hashes(h, whole);
    tl_put_words(p, whole, TL_STATE_COUNT);
    tl_put_words(p + TL_RECORD_HASHES / 2u, r->hash, TL_STATE_COUNT);
    talus_world_save(world, p + TL_RECORD_HASHES, tl_snapshot_most(h), &bytes);
    while (bytes % 4u) {
        p[TL_RECORD_HASHES + bytes++] = 0;
    }
    r->keyframes++;
    r->work = 0;
    return close_chunk(at, TL_CHUNK_KEYFRAME, TL_RECORD_HASHES + bytes, r->steps);
}

/* The chunks of all sound hulls of the region from where the last ones were found, or only their bytes if `at` is null.
 * Hulls may stand anywhere at multiples of TALUS_BLOB_ALIGNMENT. */
static size_t write_hulls(const talus_recorder *r, const talus_world *world, unsigned char *at) {
    const unsigned char *region = world->geometry;
    size_t size = 0, align = TALUS_BLOB_ALIGNMENT;
    for (size_t o = (r->geometry_bytes + align - 1u) / align * align; region && o < world->geometry_bytes;) {
        if (talus_hull_validate(region + o, world->geometry_bytes - o) != TALUS_OK) {
            o += align;
            continue;
        }
        const talus_hull *hull = (const talus_hull *)(const void *)(region + o);
        if (at) {
            tl_put_word(at + size + TL_CHUNK_HEAD, (uint32_t)o);
            tl_record_put_hull(at + size + TL_CHUNK_HEAD + 4u, hull);
            close_chunk(at + size, TL_CHUNK_HULL, 4u + hull->bytes, r->steps);
        }
        size += TL_CHUNK_HEAD + 4u + hull->bytes;
        o += (hull->bytes + align - 1u) / align * align;
    }
    return size;
}

#define REST_WORK 16u   /* of a step in which nothing is awake, in bodies */
#define WHOLE_EVERY 64u /* steps between two hashes of the whole */

/* --- the recorder ----------------------------------------------------------------------------- */

/* Room that is kept free of commands. */
static size_t kept_room(const tl_header *h) { return STEP_BEFORE + STEP_AFTER + keyframe_most(h) + TL_CHUNK_HEAD; }

size_t talus_recorder_size(const talus_world *world, size_t commands) {
    if (!tl_world_is_sound(world)) {
        return 0;
    }
    talus_recorder none;
    memset(&none, 0, sizeof none);
    size_t begin = TL_RECORD_HEAD + TL_CHUNK_HEAD + 20u + write_hulls(&none, world, NULL);
    size_t later = kept_room(tl_header_of(world)) + commands;
    begin += keyframe_most(tl_header_of(world));
    return begin > later ? begin : later;
}

static void empty_log(talus_recorder *r, const tl_header *h) {
    r->log.memory = r->memory + STEP_BEFORE;
    r->log.capacity = r->capacity - kept_room(h);
    r->log.used = 0;
    r->log.steps = r->log.others = r->log.flips = r->log.lost = 0;
}

talus_status talus_recorder_begin(talus_recorder *r, talus_world *world, void *memory, size_t capacity,
                                  const void **bytes, size_t *size) {
    if (!r || !memory || !bytes || !size || !tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    if (capacity < talus_recorder_size(world, 0)) {
        return TALUS_SMALL_BLOCK;
    }
    const tl_header *h = tl_header_of(world);
    memset(r, 0, sizeof *r);
    r->memory = memory;
    r->capacity = capacity;
    r->keyframe_work = TALUS_KEYFRAME_WORK;
    unsigned char *p = r->memory;
    memcpy(p, "TALUSREC", 8);
    tl_put_word(p + 8, TL_RECORD_VERSION);
    tl_put_word(p + 12, tl_state_layout());
    p += TL_RECORD_HEAD;
    talus_world_def def;
    talus_world_get_def(world, &def);
    const uint32_t words[5] = {def.body_capacity, def.shape_capacity, def.joint_capacity, def.contact_capacity,
                               def.event_capacity};
    tl_put_words(p + TL_CHUNK_HEAD, words, 5);
    p += close_chunk(p, TL_CHUNK_WORLD, sizeof words, 0);
    p += write_hulls(r, world, p);
    r->geometry_bytes = world->geometry_bytes;
    tl_state_active_hashes(h, r->hash);
    p += write_keyframe(r, world, p);
    *bytes = r->memory;
    *size = (size_t)(p - r->memory);
    world->log = &r->log;
    empty_log(r, h);
    return TALUS_OK;
}

/* Writes the hashes of what is awake that changed, with their mask; returns the bytes. */
static size_t write_hashes(talus_recorder *r, const tl_header *h, unsigned char *at) {
    uint32_t hash[TL_STATE_COUNT];
    uint64_t mask = 0;
    size_t size = 8;
    tl_state_active_hashes(h, hash);
    for (uint32_t i = 0; i < TL_STATE_COUNT; i++) {
        if (hash[i] != r->hash[i]) {
            mask |= (uint64_t)1 << i;
            tl_put_word(at + size, hash[i]);
            size += 4;
            r->hash[i] = hash[i];
        }
    }
    tl_put_word(at, (uint32_t)mask), tl_put_word(at + 4, (uint32_t)(mask >> 32));
    return size;
}

/* Closes the step's chunk around the commands that stand in it already; returns its bytes. */
static size_t write_step(talus_recorder *r, const tl_header *h) {
    unsigned char *at = r->memory + TL_CHUNK_HEAD;
    if (r->log.lost) {
        r->log.used = 0; /* what is left would not lead to the same state */
    }
    int whole = r->log.flips || (r->steps + r->log.steps) / WHOLE_EVERY != r->steps / WHOLE_EVERY;
    tl_put_word(at, (uint32_t)r->log.used), tl_put_word(at + 4, r->log.lost), tl_put_word(at + 8, (uint32_t)whole);
    size_t bytes = 12u + r->log.used;
    bytes += write_hashes(r, h, at + bytes);
    if (whole) {
        uint32_t hash[TL_STATE_COUNT];
        tl_state_hashes(h, hash);
        tl_put_words(at + bytes, hash, TL_STATE_COUNT);
        bytes += sizeof hash;
    }
    r->steps += r->log.steps;
    r->work += r->log.steps * ((uint64_t)h->awake_bodies + REST_WORK);
    return close_chunk(r->memory, TL_CHUNK_STEP, bytes, r->steps);
}

talus_status talus_recorder_step(talus_recorder *r, talus_world *world, const void **bytes, size_t *size) {
    if (!r || !tl_world_is_sound(world) || !bytes || !size || world->log != &r->log) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    int grown = world->geometry_bytes > r->geometry_bytes;
    if (grown && write_hulls(r, world, NULL) > r->log.capacity - r->log.used) {
        return TALUS_SMALL_BLOCK;
    }
    size_t used = write_step(r, h);
    if (r->log.lost || r->work >= r->keyframe_work) {
        r->gaps += r->log.lost != 0;
        used += write_keyframe(r, world, r->memory + used);
    }
    if (grown) {
        used += write_hulls(r, world, r->memory + used);
        r->geometry_bytes = world->geometry_bytes;
    }
    *bytes = r->memory;
    *size = used;
    empty_log(r, h);
    return TALUS_OK;
}

talus_status talus_recorder_end(talus_recorder *r, talus_world *world, const void **bytes, size_t *size) {
    size_t rest = r && (r->log.steps || r->log.others || r->log.lost);
    talus_status status = rest ? talus_recorder_step(r, world, bytes, size) : TALUS_OK;
    if (status != TALUS_OK) {
        return status;
    }
    if (!r || !world || !bytes || !size || world->log != &r->log) {
        return TALUS_BAD_ARGUMENT;
    }
    *size = (rest ? *size : 0);
    *bytes = r->memory;
    *size += close_chunk(r->memory + *size, TL_CHUNK_END, 0, r->steps);
    world->log = NULL;
    return TALUS_OK;
}
