#include "world/pack.h"

#include <string.h>

#define BLOCK 32u /* bytes */
#define RUN 256u

static int is_big_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

unsigned char *tl_put_words(unsigned char *p, const void *words, size_t count) {
    if (!is_big_endian()) {
        memcpy(p, words, count * 4u);
        return p + count * 4u;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t w;
        memcpy(&w, (const unsigned char *)words + 4u * i, 4);
        p = tl_put_word(p, w);
    }
    return p;
}

void tl_get_words(const unsigned char *p, void *words, size_t count) {
    if (!is_big_endian()) {
        memcpy(words, p, count * 4u);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t w = tl_get_word(p + 4u * i);
        memcpy((unsigned char *)words + 4u * i, &w, 4);
    }
}

/* The word of a block that comes k-th: of members of eight bytes the low half comes first. */
static size_t place_of(size_t k, size_t word) { return word == 8u && is_big_endian() ? k ^ 1u : k; }

/* Writes the words in which two blocks differ; returns where it ended, p if they are alike. */
static unsigned char *pack_block(unsigned char *p, const unsigned char *now, const unsigned char *before, size_t bytes,
                                 size_t word) {
    uint32_t a[8] = {0}, b[8] = {0}, mask = 0;
    memcpy(a, now, bytes);
    memcpy(b, before, bytes);
    unsigned char *q = p + 1;
    for (size_t k = 0; k < 8u; k++) {
        size_t at = place_of(k, word);
        tl_put_word(q, a[at]);
        q += a[at] != b[at] ? 4 : 0;
        mask |= (uint32_t)(a[at] != b[at]) << k;
    }
    *p = (unsigned char)mask;
    return mask ? q : p;
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word) {
    static const unsigned char zero[RUN];
    const unsigned char *data = rows;
    size_t bytes = count * stride,
           first = (stride + BLOCK - 1u) / BLOCK * BLOCK; /* blocks up to it have no row before */
    for (size_t at = 0; at < bytes;) {
        size_t run = least(RUN, bytes - at);
        unsigned char *blocks = p++;
        *blocks = 0;
        if (at >= first && memcmp(data + at, data + at - stride, run) == 0) {
            at += run;
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            size_t size = least(BLOCK, bytes - at);
            const unsigned char *before = at >= first ? data + at - stride : zero;
            unsigned char *q = pack_block(p, data + at, before, size, word);
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
    if (memcmp(to + at, block, size) == 0) {
        return;
    }
    memcpy(to + at, block, size);
    if (marks) {
        for (size_t row = at / stride; row <= (at + size - 1u) / stride; row++) {
            put_mark(marks, row);
        }
    }
}

const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, const tl_marks *marks) {
    unsigned char *data = rows;
    size_t bytes = count * stride, first = (stride + BLOCK - 1u) / BLOCK * BLOCK;
    for (size_t at = 0; at < bytes;) {
        if (p >= end) {
            return NULL;
        }
        uint32_t blocks = *p++;
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
            if (at >= first && stride >= BLOCK) {
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

/* FNV-1a (Fowler, Noll, Vo) over words of eight bytes in four interleaved streams, so that the multiplications
 * overlap. */
uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes) {
    uint64_t stream[4] = {0xcbf29ce484222325u, 0x9ce484222325cbf2u, 0x84222325cbf29ce4u, 0x2325cbf29ce48422u};
    size_t at = 0;
    for (; bytes - at >= 32u; at += 32u) {
        for (unsigned k = 0; k < 4u; k++) {
            const unsigned char *q = p + at + 8u * k;
            uint64_t w = (uint64_t)tl_get_word(q + 4) << 32 | tl_get_word(q);
            stream[k] = (stream[k] ^ w) * 0x00000100000001b3u;
        }
    }
    for (; at < bytes; at++) {
        stream[0] = (stream[0] ^ p[at]) * 0x00000100000001b3u;
    }
    uint64_t sum = bytes;
    for (unsigned k = 0; k < 4u; k++) {
        sum = (sum ^ stream[k]) * 0x9e3779b97f4a7c15u;
        sum ^= sum >> 29;
    }
    return sum;
}
