/* Columns as what differs from row to row. */
#ifndef TL_PACK_H
#define TL_PACK_H

#include "base/bytes.h"

/* Rows of `stride` bytes, a multiple of `word` (4 or 8, the size of the members). In runs of 256 bytes: a byte that
 * says which blocks of 32 bytes differ from what lies a row before, for each of those a byte that says which words do,
 * and the words. With `counting`, words are expected to grow as they did from row to row. Returns where it ended. */
unsigned char *tl_pack_rows(unsigned char *p, const void *rows, size_t count, size_t stride, size_t word, int counting);
/* The most bytes that tl_pack_rows writes. */
size_t tl_pack_bound(size_t count, size_t stride);

/* Puts the rows back in place. Where a row becomes another than it was, its mark becomes `value` if it was less;
 * `count` is 0 if none does; `first` may be null. Returns where it ended, or null if the bytes end before. */
typedef struct tl_marks {
    uint32_t *first;
    size_t stride; /* in words */
    uint32_t value, count;
} tl_marks;
const unsigned char *tl_unpack_rows(const unsigned char *p, const unsigned char *end, void *rows, size_t count,
                                    size_t stride, size_t word, int counting, tl_marks *marks);

/* A 64-bit checksum, not against an adversary. */
uint64_t tl_pack_checksum(const unsigned char *p, size_t bytes);

#endif
