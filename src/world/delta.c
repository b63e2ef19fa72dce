/* Deltas of snapshots: block moves (Tichy, "The string-to-string correction problem with block moves", ACM TOCS 2(4),
 * 1984), found by a table of the base's blocks, and between them what changed in place as exclusive or.
 *
 * A delta is a head of words, then operations: a number 4 n + kind for n bytes, as in LEB128.
 *   MOVE      n bytes of the base from `here` plus a signed number that follows
 *   REPLACE   n bytes, of groups of eight: which bytes differ from the base's at `here`, and their exclusive or
 *   INSERT    n bytes as they are
 * `here` is where the last operation on the base ended. */
#include <string.h>

#include "talus/rollback.h"
#include "world/pack.h"

#define DELTA_MAGIC 0x44534c54u /* "TLSD" */
#define BLOCK 24u               /* bytes that are looked up at once */

enum { HEAD_MAGIC, HEAD_BASE, HEAD_BASE_SUM, HEAD_SIZE = HEAD_BASE_SUM + 2, HEAD_SUM, HEAD_WORDS = HEAD_SUM + 2 };
enum { MOVE, REPLACE, INSERT };

static uint32_t slots_for(size_t bytes) {
    uint32_t slots = 256;
    while (slots < bytes / 4u && slots < 1u << 30) {
        slots *= 2u;
    }
    return slots;
}

size_t talus_delta_scratch_size(size_t base_bytes) { return (size_t)slots_for(base_bytes) * sizeof(uint32_t); }
size_t talus_delta_most(size_t snapshot_bytes) { return 4u * HEAD_WORDS + snapshot_bytes + snapshot_bytes / 4u + 64u; }

static uint32_t hash_block(const unsigned char *p, uint32_t slots) {
    uint64_t x = 0;
    for (unsigned k = 0; k < BLOCK; k += 4u) {
        x = (x ^ tl_get_word(p + k)) * 0x9e3779b97f4a7c15u;
    }
    return (uint32_t)(x >> 33) & (slots - 1u);
}

/* --- writing ---------------------------------------------------------------------------------- */

typedef struct writer {
    unsigned char *at, *end; /* null at: it did not fit */
} writer;

static void put_byte(writer *w, uint32_t byte) {
    if (w->at && w->at < w->end) {
        *w->at++ = (unsigned char)byte;
    } else {
        w->at = NULL;
    }
}

static void put_number(writer *w, uint64_t n) {
    for (; n >= 128u; n >>= 7) {
        put_byte(w, (uint32_t)(n & 127u) | 128u);
    }
    put_byte(w, (uint32_t)n);
}

static void put_replace(writer *w, const unsigned char *from, const unsigned char *to, size_t n) {
    put_number(w, 4u * (uint64_t)n + REPLACE);
    for (size_t at = 0; at < n; at += 8u) {
        uint32_t mask = 0;
        for (unsigned k = 0; k < 8u && at + k < n; k++) {
            mask |= (uint32_t)(from[at + k] != to[at + k]) << k;
        }
        put_byte(w, mask);
        for (unsigned k = 0; k < 8u && at + k < n; k++) {
            if (mask >> k & 1u) {
                put_byte(w, (uint32_t)from[at + k] ^ to[at + k]);
            }
        }
    }
}

/* What stands between two moves: in place of as many bytes of the base, or new. */
static void put_gap(writer *w, const unsigned char *from, size_t room, const unsigned char *to, size_t n) {
    if (n == 0) {
        return;
    }
    if (n <= room) {
        put_replace(w, from, to, n);
        return;
    }
    put_number(w, 4u * (uint64_t)n + INSERT);
    for (size_t k = 0; k < n; k++) {
        put_byte(w, to[k]);
    }
}

static void put_move(writer *w, size_t n, int64_t from_here) {
    put_number(w, 4u * (uint64_t)n + MOVE);
    put_number(w, from_here < 0 ? 2u * (uint64_t)-from_here - 1u : 2u * (uint64_t)from_here);
}

static size_t alike(const unsigned char *a, const unsigned char *a_end, const unsigned char *b,
                    const unsigned char *b_end) {
    size_t n = 0;
    while (a + n < a_end && b + n < b_end && a[n] == b[n]) {
        n++;
    }
    return n;
}

talus_status talus_delta_make(const void *base, size_t base_bytes, const void *snapshot, size_t bytes, void *scratch,
                              size_t scratch_bytes, void *out, size_t out_bytes, size_t *written) {
    if (!base || !snapshot || !scratch || !out || !written || base_bytes >> 31 || bytes >> 31) {
        return TALUS_BAD_ARGUMENT;
    }
    if ((uintptr_t)scratch % sizeof(uint32_t)) {
        return TALUS_UNALIGNED;
    }
    if (scratch_bytes < talus_delta_scratch_size(base_bytes)) {
        return TALUS_FULL_SCRATCH;
    }
    if (out_bytes < 4u * HEAD_WORDS) {
        return TALUS_SMALL_BLOCK;
    }
    const unsigned char *b = base, *b_end = b + base_bytes, *s = snapshot, *s_end = s + bytes;
    uint32_t *table = scratch, slots = slots_for(base_bytes);
    memset(table, 0, slots * sizeof *table); /* places in the base, plus one */
    for (size_t i = 0; i + BLOCK <= base_bytes; i += 4u) {
        table[hash_block(b + i, slots)] = (uint32_t)i + 1u;
    }
    unsigned char *head = out;
    writer w = {head + 4u * HEAD_WORDS, head + out_bytes};
    const unsigned char *here = b,
                        *done = s; /* what is written reaches to here in the base and to done in the snapshot */
    for (const unsigned char *p = s; s_end - p >= (ptrdiff_t)BLOCK;) {
        /* First in place, as most of a snapshot is. */
        const unsigned char *from = here + (p - done) < b_end ? here + (p - done) : b_end;
        size_t n = alike(from, b_end, p, s_end);
        if (n < BLOCK) {
            uint32_t found = table[hash_block(p, slots)];
            from = found ? b + found - 1u : b_end;
            n = alike(from, b_end, p, s_end);
        }
        if (n < BLOCK) {
            p++;
            continue;
        }
        while (p > done && from > b && p[-1] == from[-1]) {
            p--, from--, n++;
        }
        size_t gap = (size_t)(p - done), room = from > here ? (size_t)(from - here) : 0;
        put_gap(&w, here, gap == room ? room : 0, done, gap);
        put_move(&w, n, (from - here) - (gap == room ? (ptrdiff_t)gap : 0));
        here = from + n, done = p = p + n;
    }
    put_gap(&w, here, (size_t)(b_end - here), done, (size_t)(s_end - done));
    if (!w.at) {
        return TALUS_SMALL_BLOCK;
    }
    uint64_t base_sum = tl_pack_checksum(b, base_bytes), sum = tl_pack_checksum(s, bytes);
    const uint32_t words[HEAD_WORDS] = {
        DELTA_MAGIC,     (uint32_t)base_bytes, (uint32_t)base_sum,   (uint32_t)(base_sum >> 32),
        (uint32_t)bytes, (uint32_t)sum,        (uint32_t)(sum >> 32)};
    tl_put_words(head, words, HEAD_WORDS);
    *written = (size_t)(w.at - head);
    return TALUS_OK;
}

/* --- reading ---------------------------------------------------------------------------------- */

typedef struct reader {
    const unsigned char *at, *end; /* null at: it ended before it should */
} reader;

static uint32_t get_byte(reader *r) {
    if (!r->at || r->at >= r->end) {
        r->at = NULL;
        return 0;
    }
    return *r->at++;
}

static uint64_t get_number(reader *r) {
    uint64_t n = 0;
    for (unsigned shift = 0; shift < 63u; shift += 7u) {
        uint32_t byte = get_byte(r);
        n |= (uint64_t)(byte & 127u) << shift;
        if (byte < 128u) {
            return n;
        }
    }
    r->at = NULL;
    return 0;
}

static void get_replace(reader *r, const unsigned char *from, unsigned char *to, size_t n) {
    for (size_t at = 0; at < n; at += 8u) {
        uint32_t mask = get_byte(r);
        for (unsigned k = 0; k < 8u && at + k < n; k++) {
            to[at + k] = (unsigned char)(from[at + k] ^ (mask >> k & 1u ? get_byte(r) : 0u));
        }
    }
}

size_t talus_delta_result_size(const void *delta, size_t delta_bytes) {
    const unsigned char *d = delta;
    return d && delta_bytes >= 4u * HEAD_WORDS && tl_get_word(d) == DELTA_MAGIC ? tl_get_word(d + 4u * HEAD_SIZE) : 0;
}

talus_status talus_delta_apply(const void *base, size_t base_bytes, const void *delta, size_t delta_bytes, void *out,
                               size_t out_bytes, size_t *written) {
    if (!base || !delta || !out || !written) {
        return TALUS_BAD_ARGUMENT;
    }
    const unsigned char *b = base, *d = delta;
    size_t size = talus_delta_result_size(delta, delta_bytes), here = 0, done = 0;
    if (size == 0 || tl_get_word(d + 4u * HEAD_BASE) != base_bytes) {
        return TALUS_BAD_BLOB;
    }
    uint64_t base_sum = tl_pack_checksum(b, base_bytes);
    if (tl_get_long_word(d + 4u * HEAD_BASE_SUM) != base_sum) {
        return TALUS_BAD_BLOB;
    }
    if (out_bytes < size) {
        return TALUS_SMALL_BLOCK;
    }
    unsigned char *to = out;
    reader r = {d + 4u * HEAD_WORDS, d + delta_bytes};
    while (r.at && done < size) {
        uint64_t code = get_number(&r), n = code / 4u, kind = code % 4u;
        if (n == 0 || n > size - done || kind > INSERT) {
            return TALUS_BAD_BLOB;
        }
        if (kind == MOVE) {
            uint64_t far = get_number(&r), way = far / 2u + (far & 1u);
            if (far & 1u ? way > here : way > base_bytes - here) {
                return TALUS_BAD_BLOB;
            }
            here = far & 1u ? here - (size_t)way : here + (size_t)way;
        }
        if (kind != INSERT && n > base_bytes - here) {
            return TALUS_BAD_BLOB;
        }
        if (kind == MOVE) {
            memcpy(to + done, b + here, (size_t)n);
        } else if (kind == REPLACE) {
            get_replace(&r, b + here, to + done, (size_t)n);
        } else {
            for (size_t k = 0; k < n; k++) {
                to[done + k] = (unsigned char)get_byte(&r);
            }
        }
        here += kind == INSERT ? 0 : (size_t)n;
        done += (size_t)n;
    }
    uint64_t sum = tl_pack_checksum(to, size);
    if (!r.at || r.at != r.end || done != size || tl_get_long_word(d + 4u * HEAD_SUM) != sum) {
        return TALUS_BAD_BLOB;
    }
    *written = size;
    return TALUS_OK;
}
