/* What the fuzzers take from their input, and a hull's blob made to look whole. */
#ifndef FUZZ_INPUT_H
#define FUZZ_INPUT_H

#include "geom/hull.h"
#include "geom/hull_derive.h"

#include <string.h>

typedef struct reader {
    const uint8_t *data;
    size_t left;
} reader;

static inline uint32_t take_u32(reader *r) {
    uint32_t v = 0;
    size_t n = r->left < 4u ? r->left : 4u;
    memcpy(&v, r->data, n);
    r->data += n;
    r->left -= n;
    return v;
}

/* Its name, size and checksum set right, so that the bytes get past the first look. */
static inline void mend_hull(unsigned char *blob, size_t size) {
    talus_hull h;
    if (size < sizeof h) {
        return;
    }
    memcpy(&h, blob, sizeof h);
    h.magic = TL_HULL_MAGIC;
    h.version = TL_HULL_VERSION;
    h.bytes = (uint32_t)size;
    memcpy(blob, &h, sizeof h);
    h.checksum = tl_hull_checksum(blob, (uint32_t)(size / 4u * 4u));
    memcpy(blob, &h, sizeof h);
}

#endif
