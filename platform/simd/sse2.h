/* lanes.h over SSE2, 2x4. Instructions as in the Intel 64 and IA-32 Architectures Software Developer's Manual,
 * volume 2. */
#ifndef TL_SIMD_SSE2_H
#define TL_SIMD_SSE2_H

#include <emmintrin.h>
#include <stddef.h>
#include <stdint.h>

#define TL_LANES_NAME "sse2"

typedef struct tl_f8 {
    __m128 lo, hi;
} tl_f8;

typedef struct tl_i8 {
    __m128i lo, hi;
} tl_i8;

typedef struct tl_m8 {
    __m128 lo, hi;
} tl_m8;

static inline tl_f8 tl_sse2_f8(__m128 lo, __m128 hi) {
    tl_f8 r = {lo, hi};
    return r;
}
static inline tl_i8 tl_sse2_i8(__m128i lo, __m128i hi) {
    tl_i8 r = {lo, hi};
    return r;
}
static inline tl_m8 tl_sse2_m8(__m128 lo, __m128 hi) {
    tl_m8 r = {lo, hi};
    return r;
}

static inline tl_f8 tl_f8_load(const float *p) { return tl_sse2_f8(_mm_load_ps(p), _mm_load_ps(p + 4)); }
static inline tl_f8 tl_f8_loadu(const float *p) { return tl_sse2_f8(_mm_loadu_ps(p), _mm_loadu_ps(p + 4)); }
static inline void tl_f8_store(float *p, tl_f8 a) {
    _mm_store_ps(p, a.lo);
    _mm_store_ps(p + 4, a.hi);
}
static inline void tl_f8_storeu(float *p, tl_f8 a) {
    _mm_storeu_ps(p, a.lo);
    _mm_storeu_ps(p + 4, a.hi);
}
static inline tl_f8 tl_f8_set1(float s) { return tl_sse2_f8(_mm_set1_ps(s), _mm_set1_ps(s)); }
static inline tl_f8 tl_f8_zero(void) { return tl_f8_set1(0.0f); }
static inline tl_f8 tl_f8_add(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_sub(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_mul(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_div(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_sqrt(tl_f8 a) { return tl_sse2_f8(_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)); }
static inline tl_f8 tl_f8_neg(tl_f8 a) {
    return tl_sse2_f8(_mm_xor_ps(a.lo, _mm_set1_ps(-0.0f)), _mm_xor_ps(a.hi, _mm_set1_ps(-0.0f)));
}
static inline tl_f8 tl_f8_abs(tl_f8 a) {
    return tl_sse2_f8(_mm_andnot_ps(_mm_set1_ps(-0.0f), a.lo), _mm_andnot_ps(_mm_set1_ps(-0.0f), a.hi));
}
/* The instructions give the second operand for a NaN and for two zeros: just what the contract asks. */
static inline tl_f8 tl_f8_min(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_max(tl_f8 a, tl_f8 b) { return tl_sse2_f8(_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)); }
static inline tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c) { return tl_f8_add(a, tl_f8_mul(b, c)); }
static inline tl_m8 tl_f8_lt(tl_f8 a, tl_f8 b) {
    return tl_sse2_m8(_mm_cmplt_ps(a.lo, b.lo), _mm_cmplt_ps(a.hi, b.hi));
}
static inline tl_m8 tl_f8_le(tl_f8 a, tl_f8 b) {
    return tl_sse2_m8(_mm_cmple_ps(a.lo, b.lo), _mm_cmple_ps(a.hi, b.hi));
}
static inline tl_m8 tl_f8_gt(tl_f8 a, tl_f8 b) {
    return tl_sse2_m8(_mm_cmpgt_ps(a.lo, b.lo), _mm_cmpgt_ps(a.hi, b.hi));
}
static inline tl_m8 tl_f8_ge(tl_f8 a, tl_f8 b) {
    return tl_sse2_m8(_mm_cmpge_ps(a.lo, b.lo), _mm_cmpge_ps(a.hi, b.hi));
}
static inline tl_m8 tl_f8_eq(tl_f8 a, tl_f8 b) {
    return tl_sse2_m8(_mm_cmpeq_ps(a.lo, b.lo), _mm_cmpeq_ps(a.hi, b.hi));
}
static inline __m128 tl_sse2_select(__m128 m, __m128 a, __m128 b) {
    return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b));
}
static inline tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b) {
    return tl_sse2_f8(tl_sse2_select(m.lo, a.lo, b.lo), tl_sse2_select(m.hi, a.hi, b.hi));
}
static inline tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a) {
    return tl_sse2_f8(_mm_and_ps(m.lo, a.lo), _mm_and_ps(m.hi, a.hi));
}

static inline tl_m8 tl_m8_and(tl_m8 a, tl_m8 b) { return tl_sse2_m8(_mm_and_ps(a.lo, b.lo), _mm_and_ps(a.hi, b.hi)); }
static inline tl_m8 tl_m8_or(tl_m8 a, tl_m8 b) { return tl_sse2_m8(_mm_or_ps(a.lo, b.lo), _mm_or_ps(a.hi, b.hi)); }
static inline tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b) {
    return tl_sse2_m8(_mm_andnot_ps(a.lo, b.lo), _mm_andnot_ps(a.hi, b.hi));
}
static inline tl_m8 tl_m8_not(tl_m8 a) {
    return tl_sse2_m8(_mm_xor_ps(a.lo, _mm_castsi128_ps(_mm_set1_epi32(-1))),
                      _mm_xor_ps(a.hi, _mm_castsi128_ps(_mm_set1_epi32(-1))));
}
static inline unsigned tl_m8_bits(tl_m8 a) {
    return (unsigned)_mm_movemask_ps(a.lo) | (unsigned)_mm_movemask_ps(a.hi) << 4;
}
static inline int tl_m8_any(tl_m8 a) { return _mm_movemask_ps(_mm_or_ps(a.lo, a.hi)) != 0; }
static inline int tl_m8_all(tl_m8 a) { return _mm_movemask_ps(_mm_and_ps(a.lo, a.hi)) == 0xf; }
static inline tl_m8 tl_m8_from_bits(unsigned bits) {
    const __m128i lo = _mm_setr_epi32(1, 2, 4, 8), hi = _mm_setr_epi32(16, 32, 64, 128);
    __m128i b = _mm_set1_epi32((int)(bits & 0xffu));
    return tl_sse2_m8(_mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(b, lo), lo)),
                      _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(b, hi), hi)));
}
static inline tl_m8 tl_m8_zero(void) { return tl_m8_from_bits(0); }

static inline tl_i8 tl_i8_load(const int32_t *p) {
    return tl_sse2_i8(_mm_load_si128((const __m128i *)(const void *)p),
                      _mm_load_si128((const __m128i *)(const void *)(p + 4)));
}
static inline tl_i8 tl_i8_loadu(const int32_t *p) {
    return tl_sse2_i8(_mm_loadu_si128((const __m128i *)(const void *)p),
                      _mm_loadu_si128((const __m128i *)(const void *)(p + 4)));
}
static inline void tl_i8_store(int32_t *p, tl_i8 a) {
    _mm_store_si128((__m128i *)(void *)p, a.lo);
    _mm_store_si128((__m128i *)(void *)(p + 4), a.hi);
}
static inline void tl_i8_storeu(int32_t *p, tl_i8 a) {
    _mm_storeu_si128((__m128i *)(void *)p, a.lo);
    _mm_storeu_si128((__m128i *)(void *)(p + 4), a.hi);
}
static inline tl_i8 tl_i8_set1(int32_t s) { return tl_sse2_i8(_mm_set1_epi32(s), _mm_set1_epi32(s)); }
static inline tl_i8 tl_i8_add(tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_add_epi32(a.lo, b.lo), _mm_add_epi32(a.hi, b.hi));
}
static inline tl_i8 tl_i8_sub(tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_sub_epi32(a.lo, b.lo), _mm_sub_epi32(a.hi, b.hi));
}
static inline tl_i8 tl_i8_and(tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_and_si128(a.lo, b.lo), _mm_and_si128(a.hi, b.hi));
}
static inline tl_i8 tl_i8_or(tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_or_si128(a.lo, b.lo), _mm_or_si128(a.hi, b.hi));
}
static inline tl_i8 tl_i8_xor(tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_xor_si128(a.lo, b.lo), _mm_xor_si128(a.hi, b.hi));
}
static inline tl_i8 tl_i8_shl(tl_i8 a, int n) { return tl_sse2_i8(_mm_slli_epi32(a.lo, n), _mm_slli_epi32(a.hi, n)); }
static inline tl_i8 tl_i8_shr_logical(tl_i8 a, int n) {
    return tl_sse2_i8(_mm_srli_epi32(a.lo, n), _mm_srli_epi32(a.hi, n));
}
static inline tl_m8 tl_i8_eq(tl_i8 a, tl_i8 b) {
    return tl_sse2_m8(_mm_castsi128_ps(_mm_cmpeq_epi32(a.lo, b.lo)), _mm_castsi128_ps(_mm_cmpeq_epi32(a.hi, b.hi)));
}
static inline tl_m8 tl_i8_gt(tl_i8 a, tl_i8 b) {
    return tl_sse2_m8(_mm_castsi128_ps(_mm_cmpgt_epi32(a.lo, b.lo)), _mm_castsi128_ps(_mm_cmpgt_epi32(a.hi, b.hi)));
}
static inline tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b) {
    return tl_sse2_i8(_mm_castps_si128(tl_sse2_select(m.lo, _mm_castsi128_ps(a.lo), _mm_castsi128_ps(b.lo))),
                      _mm_castps_si128(tl_sse2_select(m.hi, _mm_castsi128_ps(a.hi), _mm_castsi128_ps(b.hi))));
}
static inline tl_i8 tl_i8_from_f8_trunc(tl_f8 a) { return tl_sse2_i8(_mm_cvttps_epi32(a.lo), _mm_cvttps_epi32(a.hi)); }
static inline tl_f8 tl_f8_from_i8(tl_i8 a) { return tl_sse2_f8(_mm_cvtepi32_ps(a.lo), _mm_cvtepi32_ps(a.hi)); }
static inline tl_i8 tl_i8_bits_of_f8(tl_f8 a) { return tl_sse2_i8(_mm_castps_si128(a.lo), _mm_castps_si128(a.hi)); }
static inline tl_f8 tl_f8_of_bits(tl_i8 a) { return tl_sse2_f8(_mm_castsi128_ps(a.lo), _mm_castsi128_ps(a.hi)); }

/* The 4x4 transpose of a..d, in place. */
TL_INLINE void tl_sse2_transpose4(__m128 *a, __m128 *b, __m128 *c, __m128 *d) {
    __m128 t0 = _mm_unpacklo_ps(*a, *b), t1 = _mm_unpackhi_ps(*a, *b);
    __m128 t2 = _mm_unpacklo_ps(*c, *d), t3 = _mm_unpackhi_ps(*c, *d);
    *a = _mm_movelh_ps(t0, t2);
    *b = _mm_movehl_ps(t2, t0);
    *c = _mm_movelh_ps(t1, t3);
    *d = _mm_movehl_ps(t3, t1);
}
TL_INLINE void tl_f8_transpose(tl_f8 r[8]) {
    tl_sse2_transpose4(&r[0].lo, &r[1].lo, &r[2].lo, &r[3].lo);
    tl_sse2_transpose4(&r[0].hi, &r[1].hi, &r[2].hi, &r[3].hi);
    tl_sse2_transpose4(&r[4].lo, &r[5].lo, &r[6].lo, &r[7].lo);
    tl_sse2_transpose4(&r[4].hi, &r[5].hi, &r[6].hi, &r[7].hi);
    for (int i = 0; i < 4; i++) {
        __m128 t = r[i].hi;
        r[i].hi = r[i + 4].lo;
        r[i + 4].lo = t;
    }
}
TL_INLINE void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8],
                                      tl_f8 out[8]) {
    for (int k = 0; k < 4; k++) {
        const float *p = base + (size_t)stride_floats * index[k], *q = base + (size_t)stride_floats * index[k + 4];
        out[k].lo = _mm_loadu_ps(p);
        out[k].hi = _mm_loadu_ps(q);
        out[k + 4].lo = _mm_loadu_ps(p + 4);
        out[k + 4].hi = _mm_loadu_ps(q + 4);
    }
    tl_sse2_transpose4(&out[0].lo, &out[1].lo, &out[2].lo, &out[3].lo);
    tl_sse2_transpose4(&out[0].hi, &out[1].hi, &out[2].hi, &out[3].hi);
    tl_sse2_transpose4(&out[4].lo, &out[5].lo, &out[6].lo, &out[7].lo);
    tl_sse2_transpose4(&out[4].hi, &out[5].hi, &out[6].hi, &out[7].hi);
}
TL_INLINE void tl_f8_load_rows(const float *base, const uint32_t index[8], tl_f8 out[8]) {
    tl_f8_load_rows_stride(base, 8, index, out);
}
TL_INLINE void tl_f8_store_rows(float *base, const uint32_t index[8], const tl_f8 in[8]) {
    tl_f8 r[8] = {in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7]};
    tl_f8_transpose(r);
    for (int k = 0; k < 8; k++) {
        tl_f8_store(base + (size_t)8 * index[k], r[k]);
    }
}
static inline float tl_f8_lane(tl_f8 a, int i) {
    float v[8];
    tl_f8_storeu(v, a);
    return v[i];
}
static inline float tl_f8_sum(tl_f8 a) {
    __m128 s = _mm_add_ps(a.lo, a.hi);
    s = _mm_add_ps(s, _mm_movehl_ps(s, s));
    return _mm_cvtss_f32(_mm_add_ss(s, _mm_shuffle_ps(s, s, _MM_SHUFFLE(1, 1, 1, 1))));
}

#endif
