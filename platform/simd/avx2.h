/* lanes.h over AVX2, 1x8. Instructions as in the Intel 64 and IA-32 Architectures Software Developer's Manual, vol. 2.
 */
#ifndef TL_SIMD_AVX2_H
#define TL_SIMD_AVX2_H

#if !defined(__AVX2__)
#error "avx2.h needs AVX2 (-mavx2, /arch:AVX2)"
#endif

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define TL_LANES_NAME "avx2"

typedef __m256 tl_f8;
typedef __m256i tl_i8;
typedef __m256 tl_m8;

static inline tl_f8 tl_f8_load(const float *p) { return _mm256_load_ps(p); }
static inline tl_f8 tl_f8_loadu(const float *p) { return _mm256_loadu_ps(p); }
static inline void tl_f8_store(float *p, tl_f8 a) { _mm256_store_ps(p, a); }
static inline void tl_f8_storeu(float *p, tl_f8 a) { _mm256_storeu_ps(p, a); }
static inline tl_f8 tl_f8_set1(float s) { return _mm256_set1_ps(s); }
static inline tl_f8 tl_f8_zero(void) { return _mm256_setzero_ps(); }
static inline tl_f8 tl_f8_add(tl_f8 a, tl_f8 b) { return _mm256_add_ps(a, b); }
static inline tl_f8 tl_f8_sub(tl_f8 a, tl_f8 b) { return _mm256_sub_ps(a, b); }
static inline tl_f8 tl_f8_mul(tl_f8 a, tl_f8 b) { return _mm256_mul_ps(a, b); }
static inline tl_f8 tl_f8_div(tl_f8 a, tl_f8 b) { return _mm256_div_ps(a, b); }
static inline tl_f8 tl_f8_sqrt(tl_f8 a) { return _mm256_sqrt_ps(a); }
static inline tl_f8 tl_f8_neg(tl_f8 a) { return _mm256_xor_ps(a, _mm256_set1_ps(-0.0f)); }
static inline tl_f8 tl_f8_abs(tl_f8 a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
/* The instructions give the second operand for a NaN and for two zeros: just what the contract asks. */
static inline tl_f8 tl_f8_min(tl_f8 a, tl_f8 b) { return _mm256_min_ps(a, b); }
static inline tl_f8 tl_f8_max(tl_f8 a, tl_f8 b) { return _mm256_max_ps(a, b); }
static inline tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c) { return _mm256_add_ps(a, _mm256_mul_ps(b, c)); }
static inline tl_m8 tl_f8_lt(tl_f8 a, tl_f8 b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
static inline tl_m8 tl_f8_le(tl_f8 a, tl_f8 b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
static inline tl_m8 tl_f8_gt(tl_f8 a, tl_f8 b) { return _mm256_cmp_ps(a, b, _CMP_GT_OQ); }
static inline tl_m8 tl_f8_ge(tl_f8 a, tl_f8 b) { return _mm256_cmp_ps(a, b, _CMP_GE_OQ); }
static inline tl_m8 tl_f8_eq(tl_f8 a, tl_f8 b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
static inline tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b) { return _mm256_blendv_ps(b, a, m); }
static inline tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a) { return _mm256_and_ps(m, a); }

static inline tl_m8 tl_m8_and(tl_m8 a, tl_m8 b) { return _mm256_and_ps(a, b); }
static inline tl_m8 tl_m8_or(tl_m8 a, tl_m8 b) { return _mm256_or_ps(a, b); }
static inline tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b) { return _mm256_andnot_ps(a, b); }
static inline tl_m8 tl_m8_not(tl_m8 a) { return _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))); }
static inline unsigned tl_m8_bits(tl_m8 a) { return (unsigned)_mm256_movemask_ps(a); }
static inline int tl_m8_any(tl_m8 a) { return tl_m8_bits(a) != 0; }
static inline int tl_m8_all(tl_m8 a) { return tl_m8_bits(a) == 0xffu; }
static inline tl_m8 tl_m8_from_bits(unsigned bits) {
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    __m256i b = _mm256_and_si256(_mm256_set1_epi32((int)(bits & 0xffu)), lane);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(b, lane));
}
static inline tl_m8 tl_m8_zero(void) { return _mm256_setzero_ps(); }

static inline tl_i8 tl_i8_load(const int32_t *p) { return _mm256_load_si256((const __m256i *)(const void *)p); }
static inline tl_i8 tl_i8_loadu(const int32_t *p) { return _mm256_loadu_si256((const __m256i *)(const void *)p); }
static inline void tl_i8_store(int32_t *p, tl_i8 a) { _mm256_store_si256((__m256i *)(void *)p, a); }
static inline void tl_i8_storeu(int32_t *p, tl_i8 a) { _mm256_storeu_si256((__m256i *)(void *)p, a); }
static inline tl_i8 tl_i8_set1(int32_t s) { return _mm256_set1_epi32(s); }
static inline tl_i8 tl_i8_add(tl_i8 a, tl_i8 b) { return _mm256_add_epi32(a, b); }
static inline tl_i8 tl_i8_sub(tl_i8 a, tl_i8 b) { return _mm256_sub_epi32(a, b); }
static inline tl_i8 tl_i8_and(tl_i8 a, tl_i8 b) { return _mm256_and_si256(a, b); }
static inline tl_i8 tl_i8_or(tl_i8 a, tl_i8 b) { return _mm256_or_si256(a, b); }
static inline tl_i8 tl_i8_xor(tl_i8 a, tl_i8 b) { return _mm256_xor_si256(a, b); }
static inline tl_i8 tl_i8_shl(tl_i8 a, int n) { return _mm256_slli_epi32(a, n); }
static inline tl_i8 tl_i8_shr_logical(tl_i8 a, int n) { return _mm256_srli_epi32(a, n); }
static inline tl_m8 tl_i8_eq(tl_i8 a, tl_i8 b) { return _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)); }
static inline tl_m8 tl_i8_gt(tl_i8 a, tl_i8 b) { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(a, b)); }
static inline tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b) { return _mm256_blendv_epi8(b, a, _mm256_castps_si256(m)); }
static inline tl_i8 tl_i8_from_f8_trunc(tl_f8 a) { return _mm256_cvttps_epi32(a); }
static inline tl_f8 tl_f8_from_i8(tl_i8 a) { return _mm256_cvtepi32_ps(a); }
static inline tl_i8 tl_i8_bits_of_f8(tl_f8 a) { return _mm256_castps_si256(a); }
static inline tl_f8 tl_f8_of_bits(tl_i8 a) { return _mm256_castsi256_ps(a); }

/* Four 4x4 transposes in place, of the 4x4 block in each 128-bit half of r[0..3] and of r[4..7]. */
TL_INLINE void tl_avx2_transpose_blocks(__m256 r[8]) {
    __m256 a0 = _mm256_unpacklo_ps(r[0], r[1]), a1 = _mm256_unpackhi_ps(r[0], r[1]);
    __m256 a2 = _mm256_unpacklo_ps(r[2], r[3]), a3 = _mm256_unpackhi_ps(r[2], r[3]);
    __m256 a4 = _mm256_unpacklo_ps(r[4], r[5]), a5 = _mm256_unpackhi_ps(r[4], r[5]);
    __m256 a6 = _mm256_unpacklo_ps(r[6], r[7]), a7 = _mm256_unpackhi_ps(r[6], r[7]);
    r[0] = _mm256_shuffle_ps(a0, a2, _MM_SHUFFLE(1, 0, 1, 0));
    r[1] = _mm256_shuffle_ps(a0, a2, _MM_SHUFFLE(3, 2, 3, 2));
    r[2] = _mm256_shuffle_ps(a1, a3, _MM_SHUFFLE(1, 0, 1, 0));
    r[3] = _mm256_shuffle_ps(a1, a3, _MM_SHUFFLE(3, 2, 3, 2));
    r[4] = _mm256_shuffle_ps(a4, a6, _MM_SHUFFLE(1, 0, 1, 0));
    r[5] = _mm256_shuffle_ps(a4, a6, _MM_SHUFFLE(3, 2, 3, 2));
    r[6] = _mm256_shuffle_ps(a5, a7, _MM_SHUFFLE(1, 0, 1, 0));
    r[7] = _mm256_shuffle_ps(a5, a7, _MM_SHUFFLE(3, 2, 3, 2));
}
TL_INLINE void tl_f8_transpose(tl_f8 r[8]) {
    __m256 t0 = _mm256_permute2f128_ps(r[0], r[4], 0x20), t4 = _mm256_permute2f128_ps(r[0], r[4], 0x31);
    __m256 t1 = _mm256_permute2f128_ps(r[1], r[5], 0x20), t5 = _mm256_permute2f128_ps(r[1], r[5], 0x31);
    __m256 t2 = _mm256_permute2f128_ps(r[2], r[6], 0x20), t6 = _mm256_permute2f128_ps(r[2], r[6], 0x31);
    __m256 t3 = _mm256_permute2f128_ps(r[3], r[7], 0x20), t7 = _mm256_permute2f128_ps(r[3], r[7], 0x31);
    r[0] = t0, r[1] = t1, r[2] = t2, r[3] = t3, r[4] = t4, r[5] = t5, r[6] = t6, r[7] = t7;
    tl_avx2_transpose_blocks(r);
}
/* Two halves of rows into one register: an insert from memory does not use the shuffle port, a permute does. */
static inline __m256 tl_avx2_load_halves(const float *lower, const float *upper) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(lower)), _mm_loadu_ps(upper), 1);
}
TL_INLINE void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8],
                                      tl_f8 out[8]) {
    const float *p0 = base + (size_t)stride_floats * index[0], *p4 = base + (size_t)stride_floats * index[4];
    const float *p1 = base + (size_t)stride_floats * index[1], *p5 = base + (size_t)stride_floats * index[5];
    const float *p2 = base + (size_t)stride_floats * index[2], *p6 = base + (size_t)stride_floats * index[6];
    const float *p3 = base + (size_t)stride_floats * index[3], *p7 = base + (size_t)stride_floats * index[7];
    out[0] = tl_avx2_load_halves(p0, p4), out[4] = tl_avx2_load_halves(p0 + 4, p4 + 4);
    out[1] = tl_avx2_load_halves(p1, p5), out[5] = tl_avx2_load_halves(p1 + 4, p5 + 4);
    out[2] = tl_avx2_load_halves(p2, p6), out[6] = tl_avx2_load_halves(p2 + 4, p6 + 4);
    out[3] = tl_avx2_load_halves(p3, p7), out[7] = tl_avx2_load_halves(p3 + 4, p7 + 4);
    tl_avx2_transpose_blocks(out);
}
TL_INLINE void tl_f8_load_rows(const float *base, const uint32_t index[8], tl_f8 out[8]) {
    tl_f8_load_rows_stride(base, 8, index, out);
}
TL_INLINE void tl_f8_store_rows(float *base, const uint32_t index[8], const tl_f8 in[8]) {
    __m256 r[8] = {in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7]};
    tl_avx2_transpose_blocks(r);
    /* r[k] and r[k + 4] hold rows k (lower halves) and k + 4 (upper halves); a store of an upper half is no shuffle */
    for (int k = 0; k < 4; k++) {
        float *p = base + (size_t)8 * index[k];
        _mm_store_ps(p, _mm256_castps256_ps128(r[k]));
        _mm_store_ps(p + 4, _mm256_castps256_ps128(r[k + 4]));
    }
    for (int k = 0; k < 4; k++) {
        float *p = base + (size_t)8 * index[k + 4];
        _mm_store_ps(p, _mm256_extractf128_ps(r[k], 1));
        _mm_store_ps(p + 4, _mm256_extractf128_ps(r[k + 4], 1));
    }
}
static inline float tl_f8_lane(tl_f8 a, int i) {
    float v[8];
    _mm256_storeu_ps(v, a);
    return v[i];
}
static inline float tl_f8_sum(tl_f8 a) {
    __m128 s = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    s = _mm_add_ps(s, _mm_movehl_ps(s, s));
    return _mm_cvtss_f32(_mm_add_ss(s, _mm_shuffle_ps(s, s, _MM_SHUFFLE(1, 1, 1, 1))));
}

#endif
