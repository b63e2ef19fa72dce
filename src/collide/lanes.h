/* The lanes that every processor of a target has, for queries of a single pair; and the lowest lane of a set. */
#ifndef TL_COLLIDE_LANES_H
#define TL_COLLIDE_LANES_H

#if !defined(TL_LANES_SCALAR) && !defined(TL_LANES_SSE2) && !defined(TL_LANES_AVX2) && !defined(TL_LANES_NEON) &&      \
    !defined(TL_LANES_WASM)
#if defined(__SSE2__) || defined(_M_X64)
#define TL_LANES_SSE2
#elif defined(__aarch64__) || defined(_M_ARM64)
#define TL_LANES_NEON
#elif defined(__wasm_simd128__)
#define TL_LANES_WASM
#else
#define TL_LANES_SCALAR
#endif
#endif

#include "simd/lanes.h"

/* The number of the lowest set bit; bits is not 0. */
static inline uint32_t tl_low_bit(uint32_t bits) {
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctz(bits);
#else
    uint32_t n = 0;
    while (!(bits & 1u)) {
        bits >>= 1;
        ++n;
    }
    return n;
#endif
}

/* The greatest lane. */
static inline float tl_lanes_max(tl_f8 v) {
    float s[8];
    tl_f8_storeu(s, v);
    float a = s[0] > s[4] ? s[0] : s[4], b = s[1] > s[5] ? s[1] : s[5];
    float c = s[2] > s[6] ? s[2] : s[6], d = s[3] > s[7] ? s[3] : s[7];
    a = a > c ? a : c;
    b = b > d ? b : d;
    return a > b ? a : b;
}

#endif
