#include "stage/store/hash.h"

#include <string.h>

#define PRIME 0x100000001b3u
#define BASIS 0xcbf29ce484222325u

tl_hash tl_hash_begin(void) {
    tl_hash hash;
    for (unsigned i = 0; i < 4u; i++) {
        hash.stream[i] = BASIS + i;
    }
    return hash;
}

static uint64_t mix(uint64_t stream, uint64_t word) {
    stream = (stream ^ word) * PRIME;
    return stream ^ (stream >> 32);
}

void tl_hash_words(tl_hash *hash, const void *words, size_t count) {
    const unsigned char *p = words;
    uint32_t w[4];
    size_t i = 0;
    for (; i + 4u <= count; i += 4u) {
        memcpy(w, p + 4u * i, sizeof w);
        for (unsigned k = 0; k < 4u; k++) {
            hash->stream[k] = mix(hash->stream[k], w[k]);
        }
    }
    for (; i < count; i++) {
        memcpy(w, p + 4u * i, 4u);
        hash->stream[i % 4u] = mix(hash->stream[i % 4u], w[0]);
    }
}

void tl_hash_long_words(tl_hash *hash, const void *words, size_t count) {
    const unsigned char *p = words;
    for (size_t i = 0; i < count; i++) {
        uint64_t w;
        memcpy(&w, p + 8u * i, 8u);
        hash->stream[i % 4u] = mix(mix(hash->stream[i % 4u], w & 0xffffffffu), w >> 32);
    }
}

uint64_t tl_hash_end(const tl_hash *hash) {
    uint64_t h = BASIS;
    for (unsigned i = 0; i < 4u; i++) {
        h = mix(h, hash->stream[i]);
        h = (h << 23 | h >> 41) * PRIME;
    }
    return h;
}
