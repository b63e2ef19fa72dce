/* libFuzzer: hulls of arbitrary floats, and arbitrary bytes as a hull's blob. The first byte chooses; what the builder
 * makes must pass the validator, and what passes the validator must be safe to walk. */
#include "fuzz_input.h"

#include <stdlib.h>
#include <string.h>

#define MAX_POINTS 512u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void *aligned_block(size_t size, void **memory) {
    *memory = malloc(size + TALUS_BLOB_ALIGNMENT);
    if (!*memory) {
        abort();
    }
    unsigned char *p = *memory;
    return p + (TALUS_BLOB_ALIGNMENT - (uintptr_t)p % TALUS_BLOB_ALIGNMENT) % TALUS_BLOB_ALIGNMENT;
}

static float walk(const talus_hull *h) {
    float sum = talus_hull_mass(h, 1.0f).mass;
    const tl_half_edge *edge = tl_hull_edges(h);
    for (uint32_t f = 0u; f < talus_hull_face_count(h); ++f) {
        uint32_t first = tl_hull_face_edge(h)[f], e = first;
        do {
            sum += talus_hull_vertex(h, edge[e].origin).x + tl_hull_offset(h, f);
            e = edge[e].next;
        } while (e != first);
    }
    return sum;
}

static volatile float sink;

static void check_blob(unsigned char *blob, size_t size) {
    if (talus_hull_validate(blob, size) == TALUS_OK) {
        sink = walk((const talus_hull *)(const void *)blob);
    }
}

/* Points as raw floats, as small integers, or as integers with a little noise: mode 0, 1, 2. */
static uint32_t read_points(const uint8_t *data, size_t size, uint8_t mode, talus_vec3 *points) {
    uint32_t n = 0u;
    size_t each = mode == 0u ? 12u : mode == 1u ? 3u : 6u;
    for (; n < MAX_POINTS && size >= each; ++n, data += each, size -= each) {
        float c[3];
        if (mode == 0u) {
            memcpy(c, data, sizeof c);
        } else {
            for (int k = 0; k < 3; ++k) {
                c[k] = (float)(int8_t)data[k] + (mode == 2u ? 1e-6f * (float)(int8_t)data[3 + k] : 0.0f);
            }
        }
        points[n].x = c[0], points[n].y = c[1], points[n].z = c[2];
    }
    return n;
}

static void check_build(const uint8_t *data, size_t size, uint8_t mode, uint8_t damage) {
    talus_vec3 points[MAX_POINTS];
    uint32_t n = read_points(data, size, mode, points);
    void *scratch_memory, *out_memory;
    size_t scratch_size = talus_hull_scratch_size(n), out_size = talus_hull_max_size(n), bytes = 0u;
    void *scratch = aligned_block(scratch_size, &scratch_memory);
    unsigned char *out = aligned_block(out_size, &out_memory);
    talus_status status = talus_hull_build(points, n, scratch, scratch_size, out, out_size, &bytes);
    if (status == TALUS_OK) {
        if (bytes > out_size || talus_hull_validate(out, bytes) != TALUS_OK) {
            abort();
        }
        sink = walk((const talus_hull *)(const void *)out);
        if (damage) {
            for (size_t i = 0u; i < size && i < 4u; ++i) {
                out[(data[i] * 256u + data[size - 1u - i]) % bytes] ^= damage;
            }
            mend_hull(out, bytes);
            check_blob(out, bytes);
        }
    } else if (status != TALUS_FLAT_HULL && status != TALUS_NOT_FINITE && status != TALUS_BAD_SHAPE) {
        abort();
    }
    free(scratch_memory);
    free(out_memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2u) {
        return 0;
    }
    uint8_t mode = data[0] % 5u, damage = data[1];
    data += 2, size -= 2u;
    if (mode < 3u) {
        check_build(data, size, mode, damage);
        return 0;
    }
    void *memory;
    unsigned char *blob = aligned_block(size, &memory);
    memcpy(blob, data, size);
    if (mode == 4u) {
        mend_hull(blob, size);
    }
    check_blob(blob, size);
    free(memory);
    return 0;
}
