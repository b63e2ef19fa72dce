/* libFuzzer: bytes as a recording. The first one says how: as they are; as changes of a sound recording with its
 * checksums made anew, so that what lies behind them is reached; or as the commands of a sound recording's last step.
 * Whatever commands are replayed from a sound state, the world stays one that the validator takes. */
#include "busy_world.h"
#include "world/command.h"
#include "world/record.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MOST_STEPS 24u
#define MOST_BYTES ((size_t)1 << 20) /* of worlds and hulls that a recording asks for */

typedef struct tape {
    unsigned char *bytes;
    size_t size, last; /* where the last step's chunk begins */
} tape;

static void add(tape *t, const void *bytes, size_t size) {
    t->bytes = realloc(t->bytes, t->size + size);
    if (!t->bytes) {
        abort();
    }
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
}

/* A recording of a few steps with a few commands, and a keyframe among them. */
static void make_tape(tape *t) {
    talus_world world;
    talus_recorder recorder;
    const void *bytes;
    size_t size;
    busy_world(&world, 30);
    size_t room = talus_recorder_size(&world, 4096);
    MUST(talus_recorder_begin(&recorder, &world, aligned(room), room, &bytes, &size));
    recorder.keyframe_work = 100;
    add(t, bytes, size);
    for (uint32_t i = 0; i < 12; i++) {
        talus_vec3 push = {1.0f, 5.0f, 0.0f}, at = {0.0f, 1.0f, 0.0f};
        talus_body body = {2u + i % 7u, 1u};
        (void)talus_body_apply_impulse(&world, body, push, at);
        MUST(talus_world_step(&world, 1.0f / 60.0f, NULL, NULL));
        MUST(talus_recorder_step(&recorder, &world, &bytes, &size));
        t->last = t->size;
        add(t, bytes, size);
    }
    MUST(talus_recorder_end(&recorder, &world, &bytes, &size));
    add(t, bytes, size);
}

/* Makes the checksums of a recording's chunks anew, as far as their lengths lead. */
static void sum_up(unsigned char *bytes, size_t size) {
    for (size_t at = TL_RECORD_HEAD; at + TL_CHUNK_HEAD <= size;) {
        size_t length = tl_get_word(bytes + at + 4);
        if (length % 4u || length > size - at - TL_CHUNK_HEAD) {
            return;
        }
        tl_put_word(bytes + at + 12, tl_record_checksum(bytes + at + TL_CHUNK_HEAD, length));
        tl_put_word(bytes + at + 16, tl_record_checksum(bytes + at, 16));
        at += TL_CHUNK_HEAD + length;
    }
}

static void replay(const unsigned char *bytes, size_t size, int from_sound) {
    talus_replay r;
    talus_world world;
    if (talus_replay_open(&r, bytes, size) != TALUS_OK) {
        if (r.fault == TALUS_FAULT_NONE || r.offset > size) {
            abort();
        }
        return;
    }
    size_t block = talus_world_size(&r.def);
    if (block > MOST_BYTES || r.geometry_bytes > MOST_BYTES) {
        return;
    }
    unsigned char *memory = malloc(block + r.geometry_bytes + 128u);
    if (!memory) {
        abort();
    }
    unsigned char *place = memory + (64u - (uintptr_t)memory % 64u) % 64u;
    if (talus_replay_begin(&r, &world, place, block, place + block, r.geometry_bytes) == TALUS_OK) {
        for (uint32_t i = 0; i < MOST_STEPS; i++) {
            talus_replayed done = talus_replay_step(&r, &world);
            (void)talus_replay_compare(&r, &world);
            if (done == TALUS_REPLAYED_END) {
                break;
            }
        }
        (void)talus_replay_seek(&r, &world, r.steps / 2u);
        (void)talus_replay_step(&r, &world);
        if (talus_world_save_size(&world) && talus_world_validate(&world) != TALUS_OK && from_sound) {
            abort();
        }
    }
    free(memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static tape sound;
    if (!sound.bytes) {
        make_tape(&sound);
    }
    if (size < 1u) {
        return 0;
    }
    if (data[0] % 3u == 0) {
        replay(data + 1, size - 1u, 0);
        return 0;
    }
    size_t extra = (size - 1u) / 4u * 4u;
    unsigned char *bytes = malloc(sound.size + extra + TL_CHUNK_HEAD + 64u);
    if (!bytes) {
        abort();
    }
    memcpy(bytes, sound.bytes, sound.size);
    size_t length = sound.size;
    if (data[0] % 3u == 1u) {
        for (size_t i = 1; i + 4u <= size; i += 4u) { /* where: 24 bits; what: 8 */
            size_t at = ((size_t)data[i] | (size_t)data[i + 1u] << 8 | (size_t)data[i + 2u] << 16) % length;
            bytes[at] = data[i + 3u];
        }
    } else { /* the last step anew: these commands, no hashes */
        unsigned char *at = bytes + sound.last;
        tl_put_word(at + 4, (uint32_t)extra + 16u);
        tl_put_word(at + TL_CHUNK_HEAD, (uint32_t)extra), tl_put_word(at + TL_CHUNK_HEAD + 4, 0);
        memcpy(at + TL_CHUNK_HEAD + 8, data + 1, extra);
        memset(at + TL_CHUNK_HEAD + 8 + extra, 0, 8);
        length = sound.last + TL_CHUNK_HEAD + extra + 16u;
    }
    sum_up(bytes, length);
    replay(bytes, length, data[0] % 3u == 2u);
    free(bytes);
    return 0;
}
