/* Bytes of a snapshot: words of four bytes, the lowest byte first whatever the machine, and columns as what differs
 * from row to row. */
#ifndef TL_PACK_H
#define TL_PACK_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline unsigned char *tl_put_word(unsigned char *p, uint32_t w) {
    p[0] = (unsigned char)w, p[1] = (unsigned char)(w >> 8), p[2] = (unsigned char)(w >> 16);
    p[3] = (unsigned char)(w >> 24);
    return p + 4;
}
static inline uint32_t tl_get_word(const unsigned char *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline int tl_low_byte_last(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}
static inline unsigned char *tl_put_words(unsigned char *p, const void *words, size_t count) {
    if (!tl_low_byte_last()) {
        memcpy(p, words, 4u * count);
        return p + 4u * count;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t w;
        memcpy(&w, (const unsigned char *)words + 4u * i, 4);
        p = tl_put_word(p, w);
    }
    return p;
}
static inline void tl_get_words(const unsigned char *p, void *words, size_t count) {
    if (!tl_low_byte_last()) {
        memcpy(words, p, 4u * count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t w = tl_get_word(p + 4u * i);
        memcpy((unsigned char *)words + 4u * i, &w, 4);
    }
}

/* Rows of `stride` bytes, a multiple of `word` (4 or 8, the size of the members). In runs of 256 bytes: a byte that
 * says which blocks of 32 bytes differ from what lies a row before, for each of those a byte that says which words do,
 * and the words. With `counting`, words are expected to grow as they did from row to row. Returns where it ended. */
unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word, int counting);
/* The most bytes that tl_pack_rows writes. */
size_t tl_pack_bound(size_t count, size_t stride);

/* Puts the rows back in place. Where rows become others than they were, mark[row * mark_stride] becomes `value`, if it
 * was less; `mark` may be null. Returns where it ended, or null if the bytes end before. */
typedef struct tl_marks {
    uint32_t *first;
    size_t stride; /* in words */
    uint32_t value;
} tl_marks;
const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, int counting, const tl_marks *marks);

/* A 64-bit checksum, not against an adversary. */
uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes);

#endif
