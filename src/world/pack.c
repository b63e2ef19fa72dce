#include "world/pack.h"

#define BLOCK 32u /* bytes */
#define RUN 256u

static int is_big_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

/* The word of a block that comes k-th: of members of eight bytes the low half comes first. */
static size_t place_of(size_t k, size_t word) { return word == 8u && is_big_endian() ? k ^ 1u : k; }

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Bytes from the first on that have no row before them, in whole blocks. */
static size_t first_of(size_t stride) { return (stride + BLOCK - 1u) / BLOCK * BLOCK; }

/* Which words of two whole blocks differ. */
static uint32_t difference(const unsigned char *now, const unsigned char *before) {
    uint32_t mask = 0;
    for (unsigned k = 0; k < 4u; k++) {
        uint64_t a, b;
        memcpy(&a, now + 8u * k, 8);
        memcpy(&b, before + 8u * k, 8);
        uint64_t x = a ^ b;
        mask |= ((uint32_t)((uint32_t)x != 0) | (uint32_t)(x >> 32 != 0) << 1) << 2u * k;
    }
    return mask;
}

/* Writes the words in which two blocks differ; returns where it ended, p if they are alike. */
static unsigned char *pack_block(unsigned char *p, const unsigned char *now, const unsigned char *before, size_t bytes,
                                 size_t word) {
    if (bytes == BLOCK && !is_big_endian()) { /* the same as below, the usual cases by whole copies */
        uint32_t mask = difference(now, before);
        if (mask == 0) {
            return p;
        }
        *p = (unsigned char)mask;
        if (mask == 0x7fu || mask == 0xffu || mask == 0x3fu) {
            memcpy(p + 1, now, BLOCK);
            return p + 1 + (mask == 0xffu ? 32 : mask == 0x7fu ? 28 : 24);
        }
    }
    uint32_t mask = 0;
    unsigned char *q = p + 1;
    for (size_t k = 0; k < bytes / 4u; k++) {
        uint32_t a, b;
        memcpy(&a, now + 4u * place_of(k, word), 4);
        memcpy(&b, before + 4u * place_of(k, word), 4);
        tl_put_word(q, a);
        q += a != b ? 4 : 0;
        mask |= (uint32_t)(a != b) << k;
    }
    *p = (unsigned char)mask;
    return mask ? q : p;
}

unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word) {
    static const unsigned char zero[BLOCK];
    const unsigned char *data = rows;
    size_t bytes = count * stride, first = first_of(stride);
    for (size_t at = 0; at < bytes;) {
        size_t run = least(RUN, bytes - at);
        unsigned char *blocks = p++;
        *blocks = 0;
        if (at >= first && memcmp(data + at, data + at - stride, run) == 0) {
            at += run;
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            const unsigned char *before = at >= first ? data + at - stride : zero;
            unsigned char *q = pack_block(p, data + at, before, least(BLOCK, bytes - at), word);
            *blocks = (unsigned char)(*blocks | (q != p) << k);
            p = q;
        }
    }
    return p;
}

size_t tl_pack_bound(size_t count, size_t stride) {
    size_t bytes = count * stride;
    return bytes + bytes / BLOCK + bytes / RUN + 2u + 32u;
}

static void put_mark(const tl_marks *marks, size_t row) {
    uint32_t *m = marks->first + row * marks->stride;
    *m = *m < marks->value ? marks->value : *m;
}

/* Puts a block in its place and marks its rows if that changes them. */
static void place_block(unsigned char *to, size_t at, const uint32_t *block, size_t size, size_t stride,
                        const tl_marks *marks) {
    if (size == BLOCK) {
        if (difference(to + at, (const unsigned char *)block) == 0) {
            return;
        }
        memcpy(to + at, block, BLOCK);
    } else {
        memcpy(to + at, block, size);
    }
    if (marks) {
        for (size_t row = at / stride; row <= (at + size - 1u) / stride; row++) {
            put_mark(marks, row);
        }
    }
}

const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, const tl_marks *marks) {
    unsigned char *data = rows;
    size_t bytes = count * stride, first = first_of(stride);
    for (size_t at = 0; at < bytes;) {
        if (p >= end) {
            return NULL;
        }
        uint32_t blocks = *p++;
        size_t run = least(RUN, bytes - at);
        if (blocks == 0 && at >= first && memcmp(data + at, data + at - stride, run) == 0) {
            at += run; /* as it should be */
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            size_t size = least(BLOCK, bytes - at);
            uint32_t block[8] = {0};
            uint32_t mask = 0;
            if (blocks >> k & 1u) {
                if (p >= end) {
                    return NULL;
                }
                mask = *p++;
            }
            if (at >= first && stride >= BLOCK && mask != 0xffu) {
                memcpy(block, data + at - stride, size);
            }
            for (size_t j = 0; (mask || stride < BLOCK) && j < size / 4u; j++) {
                size_t to = place_of(j, word);
                if (mask >> j & 1u) {
                    if (end - p < 4) {
                        return NULL;
                    }
                    block[to] = tl_get_word(p);
                    p += 4;
                } else if (at >= first && stride < BLOCK) { /* a row before may lie in this very block */
                    size_t back = stride / 4u;
                    if (to >= back) {
                        block[to] = block[to - back];
                    } else {
                        memcpy(&block[to], data + at + 4u * to - stride, 4);
                    }
                }
            }
            place_block(data, at, block, size, stride, marks);
        }
    }
    return p;
}

/* Sums of words of eight bytes and sums of those sums in four interleaved streams: Fletcher, "An arithmetic checksum
 * for serial transmissions", IEEE Trans. Communications 30(1), 1982. */
uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes) {
    uint64_t sum[4] = {1, 2, 3, 4}, twice[4] = {0, 0, 0, 0};
    size_t at = 0;
    for (; bytes - at >= 32u; at += 32u) {
        for (unsigned k = 0; k < 4u; k++) {
            uint64_t w;
            memcpy(&w, p + at + 8u * k, 8);
            if (is_big_endian()) {
                w = (uint64_t)tl_get_word(p + at + 8u * k + 4u) << 32 | tl_get_word(p + at + 8u * k);
            }
            sum[k] += w;
            twice[k] += sum[k];
        }
    }
    for (; at < bytes; at++) {
        sum[0] += p[at];
        twice[0] += sum[0];
    }
    uint64_t mix = bytes;
    for (unsigned k = 0; k < 4u; k++) {
        mix = (mix ^ sum[k]) * 0x9e3779b97f4a7c15u;
        mix = (mix ^ mix >> 29 ^ twice[k]) * 0xbf58476d1ce4e5b9u;
        mix ^= mix >> 32;
    }
    return mix;
}
