/* Sums of words and sums of those sums, which tell where in a row of bytes something is another: Fletcher, "An
 * arithmetic checksum for serial transmissions", IEEE Trans. Communications 30(1), 1982. */
#ifndef TL_SUMS_H
#define TL_SUMS_H

#include <stddef.h>
#include <stdint.h>

#define TL_SUM_STREAMS 4u

typedef struct tl_sums {
    uint64_t sum[TL_SUM_STREAMS], sums[TL_SUM_STREAMS];
} tl_sums;

/* Takes in words of eight bytes, the lowest first, which go to the streams in turn; what is left after pairs of words
 * a stream goes to the first, byte by byte. */
void tl_sums_add(tl_sums *s, const unsigned char *p, size_t bytes);

#endif
