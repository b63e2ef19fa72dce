/* Sets of small numbers, 64 to a word. */
#ifndef TL_BITS_H
#define TL_BITS_H

#include <stdint.h>

static inline uint32_t tl_bit_words(uint32_t bits) { return (bits + 63u) / 64u; }
static inline int tl_bit_has(const uint64_t *set, uint32_t i) { return (int)(set[i / 64u] >> (i % 64u) & 1u); }
static inline void tl_bit_add(uint64_t *set, uint32_t i) { set[i / 64u] |= (uint64_t)1 << (i % 64u); }
static inline void tl_bit_drop(uint64_t *set, uint32_t i) { set[i / 64u] &= ~((uint64_t)1 << (i % 64u)); }

/* The number of the lowest bit of a word that is not 0: a de Bruijn sequence (Leiserson, Prokop and Randall, "Using de
 * Bruijn sequences to index a 1 in a computer word", 1998). */
static inline uint32_t tl_bit_lowest(uint64_t word) {
    static const uint8_t number[64] = {0,  1,  2,  53, 3,  7,  54, 27, 4,  38, 41, 8,  34, 55, 48, 28,
                                       62, 5,  39, 46, 44, 42, 22, 9,  24, 35, 59, 56, 49, 18, 29, 11,
                                       63, 52, 6,  26, 37, 40, 33, 47, 61, 45, 43, 21, 23, 58, 17, 10,
                                       51, 25, 36, 32, 60, 20, 57, 16, 50, 31, 19, 15, 30, 14, 13, 12};
    return number[((word & (0u - word)) * 0x022fdd63cc95386du) >> 58];
}

/* How many bits of a word are 1: sums of two, four, eight bits side by side (Knuth TAOCP 4A, 7.1.3). */
static inline uint32_t tl_bit_count(uint64_t word) {
    word -= word >> 1 & 0x5555555555555555u;
    word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(word * 0x0101010101010101u >> 56);
}

/* The members of one word, counted from `first`, ascending, into `out`; returns how many there are. */
static inline uint32_t tl_bit_members(uint64_t word, uint32_t first, uint32_t *out) {
    uint32_t count = 0;
    if (!~word) { /* as dense sets mostly are */
        for (; count < 64u; count++) {
            out[count] = first + count;
        }
        return count;
    }
    for (; word; word &= word - 1u) {
        out[count++] = first + tl_bit_lowest(word);
    }
    return count;
}

/* The members below `bits`, ascending, into `out`; returns how many there are. */
static inline uint32_t tl_bit_list(const uint64_t *set, uint32_t bits, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t w = 0; w < tl_bit_words(bits); w++) {
        count += tl_bit_members(set[w], w * 64u, out + count);
    }
    return count;
}

/* The lowest number below `bits` that is not a member, or ~0. */
static inline uint32_t tl_bit_first_free(const uint64_t *set, uint32_t bits) {
    for (uint32_t w = 0; w < tl_bit_words(bits); w++) {
        if (~set[w]) {
            uint32_t i = w * 64u + tl_bit_lowest(~set[w]);
            return i < bits ? i : ~(uint32_t)0;
        }
    }
    return ~(uint32_t)0;
}

/* One more than the highest member below `end`; 0 if there is none. */
static inline uint32_t tl_bit_end(const uint64_t *set, uint32_t end) {
    while (end > 0 && !tl_bit_has(set, end - 1u)) {
        end = set[(end - 1u) / 64u] == 0 ? (end - 1u) / 64u * 64u : end - 1u;
    }
    return end;
}

#endif
