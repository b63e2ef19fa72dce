#include "world/pack.h"

#include "base/bits.h"

#define BLOCK 32u /* bytes */
#define RUN 256u

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
        if (mask == 0x7fu || mask == 0xffu || mask == 0x3fu) {
            memcpy(p + 1, now, BLOCK);
            return p + 1 + (mask == 0xffu ? 32 : mask == 0x7fu ? 28 : 24);
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
    size_t bytes = count * stride, first = first_of(stride);
    for (size_t at = 0; at < bytes;) {
        size_t run = least(RUN, bytes - at);
        unsigned char *blocks = p++;
        *blocks = 0;
        if (run == RUN && at >= (counting ? 2u : 1u) * first && run_goes_on(data + at, stride, counting)) {
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

static void put_marks(tl_marks *marks, size_t first, size_t last) {
    marks->count += (uint32_t)(last - first) + 1u;
    for (size_t row = first; marks->first && row <= last; row++) {
        uint32_t *m = marks->first + row * marks->stride;
        *m = *m < marks->value ? marks->value : *m;
    }
}

/* Puts a block in its place: words of `mask` from p, the others from the row before. Returns where it ended, or null;
 * *other is not 0 if that changes the block. */
static const unsigned char *unpack_block(const unsigned char *p, const unsigned char *end, unsigned char *to,
                                         rows_before rows, size_t bytes, size_t word, uint32_t mask, uint32_t *other) {
    if (end - p < (ptrdiff_t)(4u * 8u) && end - p < (ptrdiff_t)(4u * tl_bit_count(mask))) {
        return NULL;
    }
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
        *other |= w ^ was;
        memcpy(to + at, &w, 4);
    }
    return p;
}

const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, int counting, tl_marks *marks) {
    unsigned char *data = rows;
    size_t bytes = count * stride, first = first_of(stride);
    for (size_t at = 0; at < bytes;) {
        if (p >= end) {
            return NULL;
        }
        uint32_t blocks = *p++;
        size_t run = least(RUN, bytes - at);
        if (blocks == 0 && run == RUN && at >= (counting ? 2u : 1u) * first &&
            run_goes_on(data + at, stride, counting)) {
            at += run; /* as it should be */
            continue;
        }
        for (unsigned k = 0; k < RUN / BLOCK && at < bytes; k++, at += least(BLOCK, bytes - at)) {
            size_t size = least(BLOCK, bytes - at);
            uint32_t mask = 0, other = 0;
            if (blocks >> k & 1u) {
                if (p >= end) {
                    return NULL;
                }
                mask = *p++;
            }
            rows_before r = before_of(data, at, stride, counting);
            p = unpack_block(p, end, data + at, r, size, word, mask, &other);
            if (!p) {
                return NULL;
            }
            if (other) {
                put_marks(marks, at / stride, (at + size - 1u) / stride);
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
