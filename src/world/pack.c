#include "world/pack.h"

#include "base/sums.h"
#include "collide/lanes.h"

#define BLOCK 32u /* bytes */
#define RUN 256u
#define MANY 8u /* runs */

/* The word of a block that comes k-th: of members of eight bytes the low half comes first. */
static size_t place_of(size_t k, size_t word) { return word == 8u && tl_high_byte_first() ? k ^ 1u : k; }

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Bytes from the first on that have no row before them, in whole blocks. */
static size_t first_of(size_t stride) { return (stride + BLOCK - 1u) / BLOCK * BLOCK; }

/* Eight words of a row, which lie where words may. */
static tl_i8 words_at(const unsigned char *p) { return tl_i8_loadu((const int32_t *)(const void *)p); }

/* Which words of two whole blocks differ. */
static uint32_t difference(tl_i8 a, tl_i8 b) { return tl_m8_bits(tl_i8_eq(a, b)) ^ 0xffu; }

/* Whether they are the first ones, or none. */
static int are_first(uint32_t mask) { return (mask & (mask + 1u)) == 0; }

static uint32_t count_of(uint32_t mask) {
    static const uint8_t count[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    return count[mask & 15u] + count[mask >> 4];
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

/* A whole run of rows that do not count, with rows before all of it, on a machine that keeps the lowest byte first:
 * what most runs are. */
static unsigned char *pack_run(unsigned char *p, const unsigned char *now, size_t stride) {
    unsigned char *blocks = p++;
    uint32_t differ = 0;
    for (unsigned k = 0; k < RUN / BLOCK; k++, now += BLOCK) {
        uint32_t mask = difference(words_at(now), words_at(now - stride));
        if (mask == 0) {
            continue;
        }
        differ |= 1u << k;
        *p++ = (unsigned char)mask;
        if (are_first(mask)) { /* as a rule */
            memcpy(p, now, BLOCK);
            p += 4u * count_of(mask);
            continue;
        }
        for (unsigned w = 0; w < BLOCK / 4u; w++) {
            memcpy(p, now + 4u * w, 4);
            p += mask >> w & 1u ? 4 : 0;
        }
    }
    *blocks = (unsigned char)differ;
    return p;
}

/* Whether runs from a place on are packed and unpacked block by block of lanes. */
static int is_plain(size_t at, size_t stride, int counting) {
    return !counting && has_before(at, stride, 0) && !tl_high_byte_first();
}

unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word,
                            int counting) {
    const unsigned char *data = rows;
    size_t bytes = count * stride;
    int on = 1; /* the run before went on */
    for (size_t at = 0; at < bytes;) {
        if (on && many_go_on(data, at, bytes, stride, counting)) {
            memset(p, 0, MANY);
            p += MANY, at += MANY * RUN;
            continue;
        }
        size_t run = least(RUN, bytes - at);
        on = run == RUN && has_before(at, stride, counting) && run_goes_on(data + at, stride, counting);
        if (on) {
            *p++ = 0;
            at += run;
            continue;
        }
        if (run == RUN && is_plain(at, stride, counting)) {
            p = pack_run(p, data + at, stride);
            at += run;
            continue;
        }
        unsigned char *blocks = p++;
        *blocks = 0;
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

static void put_mark(tl_marks *marks, size_t row) {
    uint32_t *m = marks->first + row * marks->stride;
    *m = *m < marks->value ? marks->value : *m;
}

/* Marks the rows that have one of the words, by bits, of the block at `at`. */
static void put_marks(tl_marks *marks, size_t at, size_t stride, uint32_t words) {
    marks->count++;
    if (!marks->first) {
        return;
    }
    if (stride == 4u) { /* a word is a row */
        for (; words; words &= words - 1u) {
            put_mark(marks, at / 4u + tl_low_bit(words));
        }
        return;
    }
    for (size_t row = at / stride; row * stride < at + BLOCK; row++) {
        size_t from = row * stride < at ? 0 : row * stride - at, to = least(BLOCK, (row + 1u) * stride - at);
        if (words >> from / 4u & ((1u << (to - from) / 4u) - 1u)) {
            put_mark(marks, row);
        }
    }
}

/* Puts a block in its place: words of `mask` from p, the others from the row before. Returns where it ended, or null;
 * *other are the words that this changes, or all of them. */
static const unsigned char *unpack_block(const unsigned char *p, const unsigned char *end, unsigned char *to,
                                         rows_before rows, size_t bytes, size_t word, uint32_t mask, uint32_t *other) {
    if (end - p < (ptrdiff_t)(4u * count_of(mask))) {
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

/* A whole block whose row before is there; words of `mask` from p. Returns the words that this changes. */
static uint32_t unpack_words(const unsigned char *p, unsigned char *to, size_t stride, uint32_t mask) {
    int32_t now[BLOCK / 4u];
    uint32_t other;
    if (mask == 0xffu || (stride >= BLOCK && are_first(mask))) { /* as a rule */
        memcpy(now, p, BLOCK);
        tl_i8 all = tl_i8_select(tl_m8_from_bits(mask), tl_i8_loadu(now), words_at(to - stride));
        other = difference(all, words_at(to));
        if (other) { /* the next row waits for what is written here */
            tl_i8_storeu((int32_t *)(void *)to, all);
        }
        return other;
    }
    other = 0;
    for (unsigned k = 0; k < BLOCK / 4u; k++, to += 4) { /* the row before may lie in this very block */
        uint32_t w, was, from_p = mask >> k & 1u;
        memcpy(&w, from_p ? p : to - stride, 4);
        memcpy(&was, to, 4);
        memcpy(to, &w, 4);
        p += 4u * from_p;
        other |= (uint32_t)(w != was) << k;
    }
    return other;
}

#define MOST_OF_RUN (RUN + RUN / BLOCK) /* bytes after the first */

/* The bytes of a block's words. As a rule they are as many as those of the block before: taken for granted, and looked
 * at beside, the next block need not wait for the mask of this one. */
typedef struct width {
    uint32_t mask, bytes;
} width;

static uint32_t bytes_of(width *usual, uint32_t mask) {
    if (mask != usual->mask) {
        usual->mask = mask;
        usual->bytes = 4u * count_of(mask);
    }
    return usual->bytes;
}

/* The mask of the k-th block of a run, which is at *p if the run has it. */
static uint32_t mask_of(const unsigned char **p, uint32_t blocks, unsigned k) {
    uint32_t is = blocks >> k & 1u, mask = **p & (0u - is);
    *p += is;
    return mask;
}

/* What pack_run wrote, of which MOST_OF_RUN bytes can be read. */
static const unsigned char *unpack_run(const unsigned char *p, uint32_t blocks, unsigned char *data, size_t at,
                                       size_t stride, tl_marks *marks) {
    width usual = {0, 0};
    for (unsigned k = 0; k < RUN / BLOCK; k++, at += BLOCK) {
        uint32_t mask = mask_of(&p, blocks, k), other = unpack_words(p, data + at, stride, mask);
        p += bytes_of(&usual, mask);
        if (other) {
            put_marks(marks, at, stride, other);
        }
    }
    return p;
}

/* The words of `mask` of a row of a block, from p; the others are whatever they are. */
static tl_i8 words_of(const unsigned char *p, uint32_t mask) {
    if (are_first(mask)) { /* as a rule */
        return words_at(p);
    }
    int32_t words[BLOCK / 4u];
    for (unsigned w = 0; w < BLOCK / 4u; w++) {
        memcpy(&words[w], p, 4);
        p += 4u * (mask >> w & 1u);
    }
    return tl_i8_loadu(words);
}

/* The same where a block is a row: the row before is at hand. */
static const unsigned char *unpack_run_of_rows(const unsigned char *p, uint32_t blocks, unsigned char *data, size_t at,
                                               tl_marks *marks) {
    width usual = {0, 0};
    tl_i8 row = words_at(data + at - BLOCK);
    for (unsigned k = 0; k < RUN / BLOCK; k++, at += BLOCK) {
        uint32_t mask = mask_of(&p, blocks, k);
        row = tl_i8_select(tl_m8_from_bits(mask), words_of(p, mask), row);
        p += bytes_of(&usual, mask);
        if (difference(row, words_at(data + at))) {
            tl_i8_storeu((int32_t *)(void *)(data + at), row);
            marks->count++;
            if (marks->first) {
                put_mark(marks, at / BLOCK);
            }
        }
    }
    return p;
}

const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, int counting, tl_marks *marks) {
    unsigned char *data = rows;
    size_t bytes = count * stride;
    int on = 1; /* the run before went on, as it was */
    for (size_t at = 0; at < bytes;) {
        if (p >= end) {
            return NULL;
        }
        if (on && end - p >= (ptrdiff_t)MANY && tl_get_long_word(p) == 0 &&
            many_go_on(data, at, bytes, stride, counting)) {
            p += MANY, at += MANY * RUN;
            continue;
        }
        uint32_t blocks = *p++;
        size_t run = least(RUN, bytes - at);
        on = blocks == 0 && run == RUN && has_before(at, stride, counting) && run_goes_on(data + at, stride, counting);
        if (on) {
            at += run;
            continue;
        }
        if (run == RUN && is_plain(at, stride, counting) && end - p >= (ptrdiff_t)MOST_OF_RUN) {
            p = stride == BLOCK ? unpack_run_of_rows(p, blocks, data, at, marks)
                                : unpack_run(p, blocks, data, at, stride, marks);
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
            p = unpack_block(p, end, data + at, before_of(data, at, stride, counting), least(BLOCK, bytes - at), word,
                             mask, &other);
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

uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes) {
    tl_sums s = {{1, 2, 3, 4}, {0, 0, 0, 0}};
    tl_sums_add(&s, p, bytes);
    uint64_t mix = bytes;
    for (unsigned k = 0; k < TL_SUM_STREAMS; k++) {
        mix = (mix ^ s.sum[k]) * 0x9e3779b97f4a7c15u;
        mix ^= mix >> 29;
        mix = (mix ^ s.sums[k]) * 0x9e3779b97f4a7c15u;
        mix ^= mix >> 29;
    }
    return mix;
}
