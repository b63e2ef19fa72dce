/* In a file of its own: where its sums are not written to memory in the end, as they are not where it is inlined, clang
 * (seen in 14) makes no lanes of them. */
#include "base/sums.h"

#include "base/bytes.h"
#include "base/prefetch.h"

#define AHEAD 4096u /* bytes that are asked for early */

void tl_sums_add(tl_sums *s, const unsigned char *p, size_t bytes) {
    tl_sums t = *s;
    size_t at = 0;
    for (; bytes - at >= 16u * TL_SUM_STREAMS; at += 16u * TL_SUM_STREAMS) { /* two words a stream */
        tl_prefetch((const void *)((uintptr_t)(p + at) + AHEAD));
        for (unsigned k = 0; k < 2u * TL_SUM_STREAMS; k++) {
            t.sum[k % TL_SUM_STREAMS] += tl_get_long_word(p + at + 8u * k);
            t.sums[k % TL_SUM_STREAMS] += t.sum[k % TL_SUM_STREAMS];
        }
    }
    *s = t;
    for (; at < bytes; at++) {
        s->sum[0] += p[at];
        s->sums[0] += s->sum[0];
    }
}
