/* A 64-bit hash of words, equal in either byte order: FNV-1a (Fowler, Noll, Vo) over 32-bit words in four interleaved
 * streams, so that the multiplications overlap. Not for use against an adversary. */
#ifndef TL_HASH_H
#define TL_HASH_H

#include <stddef.h>
#include <stdint.h>

typedef struct tl_hash {
    uint64_t stream[4];
} tl_hash;

tl_hash tl_hash_begin(void);
void tl_hash_words(tl_hash *hash, const void *words, size_t count);      /* of 4 bytes */
void tl_hash_long_words(tl_hash *hash, const void *words, size_t count); /* of 8 bytes */
uint64_t tl_hash_end(const tl_hash *hash);

#endif
