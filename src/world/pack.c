#include "world/pack.h"

#include "base/bits.h"

#define BLOCK 32u /* bytes */
#define RUN 256u
#define MANY 8u /* runs */

/* The word of a block that comes k-th: of members of eight bytes the low half comes first. */
static size_t place_of(size_t k, size_t word) { return word == 8u && tl_high_byte_first() ? k ^ 1u : k; }

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

/* What is expected of a word: as a row before, or where rows count, as much more than that as that was more than the
 * row before it. */
static uint32_t guess(const unsigned char *before, const unsigned char *earlier, size_t at) {
    uint32_t b, c;
    if (!before) {
        return 0;
    }
    memcpy(&b, before + at, 4);
    if (!earlier) {
        return b;
    }
    memcpy(&c, earlier + at, 4);
    return 2u * b - c;
}

/* Whether a whole block goes on as its rows did before. */
static int counts_on(const unsigned char *now, const unsigned char *before, const unsigned char *earlier) {
    uint32_t a[8], b[8], c[8], other = 0;
    memcpy(a, now, BLOCK);
    memcpy(b, before, BLOCK);
    memcpy(c, earlier, BLOCK);
    for (unsigned k = 0; k < 8u; k++) {
        other |= a[k] ^ (2u * b[k] - c[k]);
    }
    return !other;
}

/* Whether the rows before are there from the first byte on. */
static int has_before(size_t at, size_t stride, int counting) { return at >= (counting ? 2u : 1u) * first_of(stride); }

/* Whether all bytes of a run, whole blocks, are as their rows before let expect. */
static int run_goes_on(const unsigned char *now, size_t stride, int counting) {
    if (!counting) {
        return memcmp(now, now - stride, RUN) == 0;
    }
    const unsigned char *before = now - stride, *earlier = before - stride;
    uint32_t other = 0;
    for (size_t at = 0; at < RUN; at += 4u) {
        uint32_t a, b, c;
        memcpy(&a, now + at, 4);
        memcpy(&b, before + at, 4);
        memcpy(&c, earlier + at, 4);
        other |= a ^ (2u * b - c);
    }
    return !other;
}

/* The same of MANY runs at once, as most of a state goes on; 0 too where there are less, or rows count. */
static int many_go_on(const unsigned char *data, size_t at, size_t bytes, size_t stride, int counting) {
    return !counting && bytes - at >= MANY * RUN && has_before(at, stride, 0) &&
           memcmp(data + at, data + at - stride, MANY * RUN) == 0;
}

/* Writes the words of a block that are not as expected; returns where it ended, p if all are. */
static unsigned char *pack_block(unsigned char *p, const unsigned char *now, const unsigned char *before,
                                 const unsigned char *earlier, size_t bytes, size_t word) {
    if (earlier && bytes == BLOCK && counts_on(now, before, earlier)) {
        return p;
    }
    if (!earlier && before && bytes == BLOCK && !tl_high_byte_first()) { /* the usual cases by whole copies */
        uint32_t mask = difference(now, before);
        if (mask == 0) {
            return p;
        }
        *p = (unsigned char)mask;
        if ((mask & (mask + 1u)) == 0) {
            memcpy(p + 1, now, BLOCK);
            return p + 1 + 4u * tl_bit_count(mask);
        }
    }
    uint32_t mask = 0;
    unsigned char *q = p + 1;
    for (size_t k = 0; k < bytes / 4u; k++) {
        size_t at = 4u * place_of(k, word);
        uint32_t a, b = guess(before, earlier, at);
        memcpy(&a, now + at, 4);
        tl_put_word(q, a);
        q += a != b ? 4 : 0;
        mask |= (uint32_t)(a != b) << k;
    }
    *p = (unsigned char)mask;
    return mask ? q : p;
}

/* Where the rows before a place are, null where there are none; `earlier` only if rows count. */
typedef struct rows_before {
    const unsigned char *before, *earlier;
} rows_before;

static rows_before before_of(const unsigned char *data, size_t at, size_t stride, int counting) {
    size_t first = first_of(stride);
    rows_before r = {at >= first ? data + at - stride : NULL,
                     counting && at >= 2u * first ? data + at - 2u * stride : NULL};
    return r;
}

unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word,
                            int counting) {
    const unsigned char *data = rows;
    size_t bytes = count * stride;
    for (size_t at = 0; at < bytes;) {
        if (many_go_on(data, at, bytes, stride, counting)) {
            memset(p, 0, MANY);
            p += MANY, at += MANY * RUN;
            continue;
        }
        size_t run = least(RUN, bytes - at);
        unsigned char *blocks = p++;
        *blocks = 0;
        if (run == RUN && has_before(at, stride, counting) && run_goes_on(data + at, stride, counting)) {
            at += run;
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            rows_before r = before_of(data, at, stride, counting);
            unsigned char *q = pack_block(p, data + at, r.before, r.earlier, least(BLOCK, bytes - at), word);
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

/* Marks the rows that have one of the words, by bits, of the block at `at`. */
static void put_marks(tl_marks *marks, size_t at, size_t stride, uint32_t words) {
    marks->count++;
    if (!marks->first) {
        return;
    }
    for (size_t row = at / stride; row * stride < at + BLOCK; row++) {
        size_t from = row * stride < at ? 0 : row * stride - at, to = least(BLOCK, (row + 1u) * stride - at);
        uint32_t *m = marks->first + row * marks->stride;
        if (words >> from / 4u & ((1u << (to - from) / 4u) - 1u)) {
            *m = *m < marks->value ? marks->value : *m;
        }
    }
}

/* A whole block of which the first `count` words stand at p and the others are those of the row before; returns whether
 * that changes it. */
static int unpack_first_words(const unsigned char *p, unsigned char *to, const unsigned char *before, uint32_t count) {
    static const uint32_t number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    uint32_t w[8], b[8], was[8], other = 0;
    memcpy(w, p, BLOCK);
    memcpy(b, before, BLOCK);
    memcpy(was, to, BLOCK);
    for (unsigned k = 0; k < 8u; k++) {
        w[k] = number[k] < count ? w[k] : b[k];
        other |= w[k] ^ was[k];
    }
    if (other) { /* the next row waits for what is written here */
        memcpy(to, w, BLOCK);
    }
    return other != 0;
}

/* Puts a block in its place: words of `mask` from p, the others from the row before. Returns where it ended, or null;
 * *other are the words that this changes, or all of them. */
static const unsigned char *unpack_block(const unsigned char *p, const unsigned char *end, unsigned char *to,
                                         rows_before rows, size_t stride, size_t bytes, size_t word, uint32_t mask,
                                         uint32_t *other) {
    if (bytes == BLOCK && (mask & (mask + 1u)) == 0 && !rows.earlier && rows.before && stride >= BLOCK &&
        end - p >= (ptrdiff_t)BLOCK && !tl_high_byte_first()) { /* the usual case by whole copies */
        *other = unpack_first_words(p, to, rows.before, tl_bit_count(mask)) ? 0xffu : 0u;
        return p + 4u * tl_bit_count(mask);
    }
    if (end - p < (ptrdiff_t)(4u * tl_bit_count(mask))) {
        return NULL;
    }
    *other = 0;
    for (size_t k = 0; k < bytes / 4u; k++) {
        size_t at = 4u * place_of(k, word);
        uint32_t was, w;
        memcpy(&was, to + at, 4);
        if (mask >> k & 1u) {
            w = tl_get_word(p);
            p += 4;
        } else { /* a row before may lie in this very block */
            w = guess(rows.before, rows.earlier, at);
        }
        *other |= (uint32_t)(w != was) << at / 4u;
        memcpy(to + at, &w, 4);
    }
    return p;
}

const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, int counting, tl_marks *marks) {
    unsigned char *data = rows;
    size_t bytes = count * stride;
    for (size_t at = 0; at < bytes;) {
        if (p >= end) {
            return NULL;
        }
        if (end - p >= (ptrdiff_t)MANY && tl_get_long_word(p) == 0 && many_go_on(data, at, bytes, stride, counting)) {
            p += MANY, at += MANY * RUN; /* as it should be */
            continue;
        }
        uint32_t blocks = *p++;
        size_t run = least(RUN, bytes - at);
        if (blocks == 0 && run == RUN && has_before(at, stride, counting) && run_goes_on(data + at, stride, counting)) {
            at += run;
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            uint32_t mask = 0, other;
            if (blocks >> k & 1u) {
                if (p >= end) {
                    return NULL;
                }
                mask = *p++;
            }
            p = unpack_block(p, end, data + at, before_of(data, at, stride, counting), stride, least(BLOCK, bytes - at),
                             word, mask, &other);
            if (!p) {
                return NULL;
            }
            if (other) {
                put_marks(marks, at, stride, other);
            }
        }
    }
    return p;
}

static uint64_t long_word(const unsigned char *p) {
    uint64_t w;
    memcpy(&w, p, 8);
    return tl_high_byte_first() ? tl_get_long_word(p) : w;
}

/* Sums of words of eight bytes and sums of those sums in four interleaved streams: Fletcher, "An arithmetic checksum
 * for serial transmissions", IEEE Trans. Communications 30(1), 1982. */
uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes) {
    uint64_t sum[4] = {1, 2, 3, 4}, sums[4] = {0, 0, 0, 0};
    size_t at = 0;
    for (; bytes - at >= 32u; at += 32u) {
        for (unsigned k = 0; k < 4u; k++) {
            sum[k] += long_word(p + at + 8u * k);
            sums[k] += sum[k];
        }
    }
    for (; at < bytes; at++) {
        sum[0] += p[at];
        sums[0] += sum[0];
    }
    uint64_t mix = bytes;
    for (unsigned k = 0; k < 4u; k++) {
        mix = (mix ^ sum[k]) * 0x9e3779b97f4a7c15u;
        mix ^= mix >> 29;
        mix = (mix ^ sums[k]) * 0x9e3779b97f4a7c15u;
        mix ^= mix >> 29;
    }
    return mix;
}
