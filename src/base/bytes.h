/* Words as bytes, the lowest byte first whatever the machine: what snapshots, deltas and recordings are made of. */
#ifndef TL_BYTES_H
#define TL_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Whether this machine keeps the highest byte of a word first. */
static inline int tl_high_byte_first(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

/* Return where the next byte goes. */
static inline unsigned char *tl_put_word(unsigned char *p, uint32_t w) {
    if (!tl_high_byte_first()) { /* compilers do not always see that the four bytes are the word */
        memcpy(p, &w, 4);
        return p + 4;
    }
    p[0] = (unsigned char)w, p[1] = (unsigned char)(w >> 8), p[2] = (unsigned char)(w >> 16);
    p[3] = (unsigned char)(w >> 24);
    return p + 4;
}
static inline unsigned char *tl_put_words(unsigned char *p, const void *words, size_t count) {
    if (!tl_high_byte_first()) {
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

static inline uint32_t tl_get_word(const unsigned char *p) {
    if (!tl_high_byte_first()) {
        uint32_t w;
        memcpy(&w, p, 4);
        return w;
    }
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline uint64_t tl_get_long_word(const unsigned char *p) {
    if (!tl_high_byte_first()) {
        uint64_t w;
        memcpy(&w, p, 8);
        return w;
    }
    return (uint64_t)tl_get_word(p) | (uint64_t)tl_get_word(p + 4) << 32;
}
static inline void tl_get_words(const unsigned char *p, void *words, size_t count) {
    if (!tl_high_byte_first()) {
        memcpy(words, p, 4u * count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t w = tl_get_word(p + 4u * i);
        memcpy((unsigned char *)words + 4u * i, &w, 4);
    }
}

#endif
