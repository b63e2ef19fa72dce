/* Eight lanes of float and int32, the same bits on every instruction set.
 *
 * The including file defines exactly one of TL_LANES_SCALAR, TL_LANES_SSE2, TL_LANES_AVX2, TL_LANES_NEON or
 * TL_LANES_WASM and is compiled with the flags of that set; a kernel is written once over the names below. The logical
 * width is 8 everywhere: AVX2 is 1x8, SSE2, NEON and WASM are 2x4, scalar is 8x1. All functions are static inline and
 * know only their arguments.
 *
 * What holds on every instruction set:
 *  - add, sub, mul, div, sqrt and the conversions round once, to nearest even, and keep denormals: the thread has the
 *    default floating point environment, and the file is compiled with -ffp-contract=off and without -ffast-math. There
 *    are no fused operations and no estimates.
 *  - The sign and payload of a NaN that arithmetic makes are not fixed (processors differ there). Everything that moves
 *    or picks values (load, store, select, min, max, neg, abs, masks, rows, transpose) keeps all bits, also of a NaN.
 *  - Comparisons are ordered: false where either side is NaN.
 *
 * Types: tl_f8 (8 float), tl_i8 (8 int32, wrapping), tl_m8 (8 masks, each all ones or all zeros). They are made, copied
 * and passed like plain values; nothing but the functions below looks inside.
 *
 *   tl_f8 tl_f8_load(const float *p)               p is 32-byte aligned
 *   tl_f8 tl_f8_loadu(const float *p)
 *   void tl_f8_store(float *p, tl_f8 a)            p is 32-byte aligned
 *   void tl_f8_storeu(float *p, tl_f8 a)
 *   tl_f8 tl_f8_set1(float s)
 *   tl_f8 tl_f8_zero(void)                         +0
 *   tl_f8 tl_f8_add, sub, mul, div (tl_f8 a, tl_f8 b)
 *   tl_f8 tl_f8_sqrt(tl_f8 a)
 *   tl_f8 tl_f8_neg(tl_f8 a)                       flips the sign bit
 *   tl_f8 tl_f8_abs(tl_f8 a)                       clears the sign bit
 *   tl_f8 tl_f8_min(tl_f8 a, tl_f8 b)              a < b ? a : b, so b for a NaN on either side and for two zeros
 *   tl_f8 tl_f8_max(tl_f8 a, tl_f8 b)              a > b ? a : b, likewise
 *   tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c)     a + b * c, rounded twice
 *   tl_m8 tl_f8_lt, le, gt, ge, eq (tl_f8 a, tl_f8 b)
 *   tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b)  m ? a : b
 *   tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a)         m ? a : +0
 *
 *   tl_m8 tl_m8_and, or (tl_m8 a, tl_m8 b)
 *   tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b)           ~a & b
 *   tl_m8 tl_m8_not(tl_m8 a)
 *   int tl_m8_any(tl_m8 a), tl_m8_all(tl_m8 a)     0 or 1
 *   unsigned tl_m8_bits(tl_m8 a)                   bit i is lane i
 *   tl_m8 tl_m8_from_bits(unsigned bits)           bits above the eighth are ignored
 *   tl_m8 tl_m8_zero(void)
 *
 *   tl_i8 tl_i8_load, loadu (const int32_t *p)     as for floats
 *   void tl_i8_store, storeu (int32_t *p, tl_i8 a)
 *   tl_i8 tl_i8_set1(int32_t s)
 *   tl_i8 tl_i8_add, sub, and, or, xor (tl_i8 a, tl_i8 b)
 *   tl_i8 tl_i8_shl, shr_logical (tl_i8 a, int n)  n in 0..31
 *   tl_m8 tl_i8_eq, gt (tl_i8 a, tl_i8 b)          gt is signed
 *   tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b)
 *   tl_i8 tl_i8_from_f8_trunc(tl_f8 a)             toward zero; every lane truncates to an int32, or nothing is defined
 *   tl_f8 tl_f8_from_i8(tl_i8 a)                   to nearest even
 *   tl_i8 tl_i8_bits_of_f8(tl_f8 a)
 *   tl_f8 tl_f8_of_bits(tl_i8 a)
 *
 *   void tl_f8_transpose(tl_f8 r[8])               in place: lane j of r[i] changes places with lane i of r[j]
 *   void tl_f8_load_rows(const float *base, const uint32_t index[8], tl_f8 out[8])
 *       Row k is the 8 floats at base + 8 * index[k]; lane k of out[c] becomes column c of row k. base is 32-byte
 *       aligned.
 *   void tl_f8_store_rows(float *base, const uint32_t index[8], const tl_f8 in[8])
 *       The inverse. Rows are stored in the order k = 0..7: where an index repeats, the last one stays.
 *   void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8], tl_f8 out[8])
 *       Rows at base + stride_floats * index[k]; neither base nor stride need be aligned.
 *   float tl_f8_lane(tl_f8 a, int i)               slow: for the edges of a kernel
 *   float tl_f8_sum(tl_f8 a)                       ((a0 + a4) + (a2 + a6)) + ((a1 + a5) + (a3 + a7))
 *
 * TL_LANES_NAME is the name of the instruction set as a string. */
#ifndef TL_LANES_H
#define TL_LANES_H

#include <stddef.h>
#include <stdint.h>

#if defined(TL_LANES_SCALAR) + defined(TL_LANES_SSE2) + defined(TL_LANES_AVX2) + defined(TL_LANES_NEON) +              \
        defined(TL_LANES_WASM) !=                                                                                      \
    1
#error "define exactly one of TL_LANES_SCALAR, TL_LANES_SSE2, TL_LANES_AVX2, TL_LANES_NEON, TL_LANES_WASM"
#endif

/* Of functions of many lanes: to pass those in memory costs as much as such a function does. */
#if defined(__GNUC__)
#define TL_INLINE static inline __attribute__((always_inline))
#else
#define TL_INLINE static inline
#endif

/* Of a loop over rows whose number the compiler mostly knows, six at most: to be taken apart however long its body is.
 */
#if defined(__GNUC__) && !defined(__clang__) && !defined(TL_LANES_SCALAR)
#define TL_UNROLL _Pragma("GCC unroll 6")
#else
#define TL_UNROLL
#endif

#if defined(TL_LANES_SCALAR)
#include "scalar.h"
#elif defined(TL_LANES_SSE2)
#include "sse2.h"
#elif defined(TL_LANES_AVX2)
#include "avx2.h"
#elif defined(TL_LANES_NEON)
#include "neon.h"
#elif defined(TL_LANES_WASM)
#include "wasm.h"
#endif

#endif
