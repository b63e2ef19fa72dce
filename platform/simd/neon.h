/* lanes.h over AArch64 Advanced SIMD, 2x4. Instructions as in the Arm Architecture Reference Manual for A-profile
 * (DDI 0487), C7.2. The 32-bit instruction set is not served: its NEON flushes denormals and has no exact division. */
#ifndef TL_SIMD_NEON_H
#define TL_SIMD_NEON_H

#if !defined(__aarch64__) && !defined(_M_ARM64)
#error "neon.h is for AArch64: 32-bit NEON flushes denormals"
#endif

#include <arm_neon.h>
#include <stddef.h>
#include <stdint.h>

#define TL_LANES_NAME "neon"

typedef struct tl_f8 {
    float32x4_t lo, hi;
} tl_f8;

typedef struct tl_i8 {
    int32x4_t lo, hi;
} tl_i8;

typedef struct tl_m8 {
    uint32x4_t lo, hi;
} tl_m8;

static inline tl_f8 tl_neon_f8(float32x4_t lo, float32x4_t hi) {
    tl_f8 r = {lo, hi};
    return r;
}
static inline tl_i8 tl_neon_i8(int32x4_t lo, int32x4_t hi) {
    tl_i8 r = {lo, hi};
    return r;
}
static inline tl_m8 tl_neon_m8(uint32x4_t lo, uint32x4_t hi) {
    tl_m8 r = {lo, hi};
    return r;
}

static inline tl_f8 tl_f8_load(const float *p) { return tl_neon_f8(vld1q_f32(p), vld1q_f32(p + 4)); }
static inline tl_f8 tl_f8_loadu(const float *p) { return tl_neon_f8(vld1q_f32(p), vld1q_f32(p + 4)); }
static inline void tl_f8_store(float *p, tl_f8 a) {
    vst1q_f32(p, a.lo);
    vst1q_f32(p + 4, a.hi);
}
static inline void tl_f8_storeu(float *p, tl_f8 a) {
    vst1q_f32(p, a.lo);
    vst1q_f32(p + 4, a.hi);
}
static inline tl_f8 tl_f8_set1(float s) { return tl_neon_f8(vdupq_n_f32(s), vdupq_n_f32(s)); }
static inline tl_f8 tl_f8_zero(void) { return tl_f8_set1(0.0f); }
static inline tl_f8 tl_f8_add(tl_f8 a, tl_f8 b) { return tl_neon_f8(vaddq_f32(a.lo, b.lo), vaddq_f32(a.hi, b.hi)); }
static inline tl_f8 tl_f8_sub(tl_f8 a, tl_f8 b) { return tl_neon_f8(vsubq_f32(a.lo, b.lo), vsubq_f32(a.hi, b.hi)); }
static inline tl_f8 tl_f8_mul(tl_f8 a, tl_f8 b) { return tl_neon_f8(vmulq_f32(a.lo, b.lo), vmulq_f32(a.hi, b.hi)); }
static inline tl_f8 tl_f8_div(tl_f8 a, tl_f8 b) { return tl_neon_f8(vdivq_f32(a.lo, b.lo), vdivq_f32(a.hi, b.hi)); }
static inline tl_f8 tl_f8_sqrt(tl_f8 a) { return tl_neon_f8(vsqrtq_f32(a.lo), vsqrtq_f32(a.hi)); }
static inline tl_f8 tl_f8_neg(tl_f8 a) { return tl_neon_f8(vnegq_f32(a.lo), vnegq_f32(a.hi)); }
static inline tl_f8 tl_f8_abs(tl_f8 a) { return tl_neon_f8(vabsq_f32(a.lo), vabsq_f32(a.hi)); }
/* FMIN and FMAX treat NaN and zeros otherwise than the contract: compare and select. */
static inline tl_f8 tl_f8_min(tl_f8 a, tl_f8 b) {
    return tl_neon_f8(vbslq_f32(vcltq_f32(a.lo, b.lo), a.lo, b.lo), vbslq_f32(vcltq_f32(a.hi, b.hi), a.hi, b.hi));
}
static inline tl_f8 tl_f8_max(tl_f8 a, tl_f8 b) {
    return tl_neon_f8(vbslq_f32(vcgtq_f32(a.lo, b.lo), a.lo, b.lo), vbslq_f32(vcgtq_f32(a.hi, b.hi), a.hi, b.hi));
}
static inline tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c) { return tl_f8_add(a, tl_f8_mul(b, c)); }
static inline tl_m8 tl_f8_lt(tl_f8 a, tl_f8 b) { return tl_neon_m8(vcltq_f32(a.lo, b.lo), vcltq_f32(a.hi, b.hi)); }
static inline tl_m8 tl_f8_le(tl_f8 a, tl_f8 b) { return tl_neon_m8(vcleq_f32(a.lo, b.lo), vcleq_f32(a.hi, b.hi)); }
static inline tl_m8 tl_f8_gt(tl_f8 a, tl_f8 b) { return tl_neon_m8(vcgtq_f32(a.lo, b.lo), vcgtq_f32(a.hi, b.hi)); }
static inline tl_m8 tl_f8_ge(tl_f8 a, tl_f8 b) { return tl_neon_m8(vcgeq_f32(a.lo, b.lo), vcgeq_f32(a.hi, b.hi)); }
static inline tl_m8 tl_f8_eq(tl_f8 a, tl_f8 b) { return tl_neon_m8(vceqq_f32(a.lo, b.lo), vceqq_f32(a.hi, b.hi)); }
static inline tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b) {
    return tl_neon_f8(vbslq_f32(m.lo, a.lo, b.lo), vbslq_f32(m.hi, a.hi, b.hi));
}
static inline tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a) {
    return tl_neon_f8(vreinterpretq_f32_u32(vandq_u32(m.lo, vreinterpretq_u32_f32(a.lo))),
                      vreinterpretq_f32_u32(vandq_u32(m.hi, vreinterpretq_u32_f32(a.hi))));
}

static inline tl_m8 tl_m8_and(tl_m8 a, tl_m8 b) { return tl_neon_m8(vandq_u32(a.lo, b.lo), vandq_u32(a.hi, b.hi)); }
static inline tl_m8 tl_m8_or(tl_m8 a, tl_m8 b) { return tl_neon_m8(vorrq_u32(a.lo, b.lo), vorrq_u32(a.hi, b.hi)); }
static inline tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b) { return tl_neon_m8(vbicq_u32(b.lo, a.lo), vbicq_u32(b.hi, a.hi)); }
static inline tl_m8 tl_m8_not(tl_m8 a) { return tl_neon_m8(vmvnq_u32(a.lo), vmvnq_u32(a.hi)); }
static inline unsigned tl_m8_bits(tl_m8 a) {
    const uint32x4_t lo = {1, 2, 4, 8}, hi = {16, 32, 64, 128};
    return vaddvq_u32(vorrq_u32(vandq_u32(a.lo, lo), vandq_u32(a.hi, hi)));
}
static inline int tl_m8_any(tl_m8 a) { return vmaxvq_u32(vorrq_u32(a.lo, a.hi)) != 0; }
static inline int tl_m8_all(tl_m8 a) { return vminvq_u32(vandq_u32(a.lo, a.hi)) != 0; }
static inline tl_m8 tl_m8_from_bits(unsigned bits) {
    const uint32x4_t lo = {1, 2, 4, 8}, hi = {16, 32, 64, 128};
    return tl_neon_m8(vtstq_u32(vdupq_n_u32(bits), lo), vtstq_u32(vdupq_n_u32(bits), hi));
}
static inline tl_m8 tl_m8_zero(void) { return tl_m8_from_bits(0); }

static inline tl_i8 tl_i8_load(const int32_t *p) { return tl_neon_i8(vld1q_s32(p), vld1q_s32(p + 4)); }
static inline tl_i8 tl_i8_loadu(const int32_t *p) { return tl_neon_i8(vld1q_s32(p), vld1q_s32(p + 4)); }
static inline void tl_i8_store(int32_t *p, tl_i8 a) {
    vst1q_s32(p, a.lo);
    vst1q_s32(p + 4, a.hi);
}
static inline void tl_i8_storeu(int32_t *p, tl_i8 a) {
    vst1q_s32(p, a.lo);
    vst1q_s32(p + 4, a.hi);
}
static inline tl_i8 tl_i8_set1(int32_t s) { return tl_neon_i8(vdupq_n_s32(s), vdupq_n_s32(s)); }
static inline tl_i8 tl_i8_add(tl_i8 a, tl_i8 b) { return tl_neon_i8(vaddq_s32(a.lo, b.lo), vaddq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_sub(tl_i8 a, tl_i8 b) { return tl_neon_i8(vsubq_s32(a.lo, b.lo), vsubq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_and(tl_i8 a, tl_i8 b) { return tl_neon_i8(vandq_s32(a.lo, b.lo), vandq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_or(tl_i8 a, tl_i8 b) { return tl_neon_i8(vorrq_s32(a.lo, b.lo), vorrq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_xor(tl_i8 a, tl_i8 b) { return tl_neon_i8(veorq_s32(a.lo, b.lo), veorq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_shl(tl_i8 a, int n) {
    return tl_neon_i8(vshlq_s32(a.lo, vdupq_n_s32(n)), vshlq_s32(a.hi, vdupq_n_s32(n)));
}
/* USHL by a negative count shifts right, zeros coming in. */
static inline int32x4_t tl_neon_shr(int32x4_t a, int n) {
    return vreinterpretq_s32_u32(vshlq_u32(vreinterpretq_u32_s32(a), vdupq_n_s32(-n)));
}
static inline tl_i8 tl_i8_shr_logical(tl_i8 a, int n) { return tl_neon_i8(tl_neon_shr(a.lo, n), tl_neon_shr(a.hi, n)); }
static inline tl_m8 tl_i8_eq(tl_i8 a, tl_i8 b) { return tl_neon_m8(vceqq_s32(a.lo, b.lo), vceqq_s32(a.hi, b.hi)); }
static inline tl_m8 tl_i8_gt(tl_i8 a, tl_i8 b) { return tl_neon_m8(vcgtq_s32(a.lo, b.lo), vcgtq_s32(a.hi, b.hi)); }
static inline tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b) {
    return tl_neon_i8(vbslq_s32(m.lo, a.lo, b.lo), vbslq_s32(m.hi, a.hi, b.hi));
}
static inline tl_i8 tl_i8_from_f8_trunc(tl_f8 a) { return tl_neon_i8(vcvtq_s32_f32(a.lo), vcvtq_s32_f32(a.hi)); }
static inline tl_f8 tl_f8_from_i8(tl_i8 a) { return tl_neon_f8(vcvtq_f32_s32(a.lo), vcvtq_f32_s32(a.hi)); }
static inline tl_i8 tl_i8_bits_of_f8(tl_f8 a) {
    return tl_neon_i8(vreinterpretq_s32_f32(a.lo), vreinterpretq_s32_f32(a.hi));
}
static inline tl_f8 tl_f8_of_bits(tl_i8 a) {
    return tl_neon_f8(vreinterpretq_f32_s32(a.lo), vreinterpretq_f32_s32(a.hi));
}

/* The 4x4 transpose of a..d, in place. */
TL_INLINE void tl_neon_transpose4(float32x4_t *a, float32x4_t *b, float32x4_t *c, float32x4_t *d) {
    float64x2_t t0 = vreinterpretq_f64_f32(vtrn1q_f32(*a, *b)), t1 = vreinterpretq_f64_f32(vtrn2q_f32(*a, *b));
    float64x2_t t2 = vreinterpretq_f64_f32(vtrn1q_f32(*c, *d)), t3 = vreinterpretq_f64_f32(vtrn2q_f32(*c, *d));
    *a = vreinterpretq_f32_f64(vtrn1q_f64(t0, t2));
    *b = vreinterpretq_f32_f64(vtrn1q_f64(t1, t3));
    *c = vreinterpretq_f32_f64(vtrn2q_f64(t0, t2));
    *d = vreinterpretq_f32_f64(vtrn2q_f64(t1, t3));
}
TL_INLINE void tl_f8_transpose(tl_f8 r[8]) {
    tl_neon_transpose4(&r[0].lo, &r[1].lo, &r[2].lo, &r[3].lo);
    tl_neon_transpose4(&r[0].hi, &r[1].hi, &r[2].hi, &r[3].hi);
    tl_neon_transpose4(&r[4].lo, &r[5].lo, &r[6].lo, &r[7].lo);
    tl_neon_transpose4(&r[4].hi, &r[5].hi, &r[6].hi, &r[7].hi);
    for (int i = 0; i < 4; i++) {
        float32x4_t t = r[i].hi;
        r[i].hi = r[i + 4].lo;
        r[i + 4].lo = t;
    }
}
TL_INLINE void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8],
                                      tl_f8 out[8]) {
    for (int k = 0; k < 4; k++) {
        const float *p = base + (size_t)stride_floats * index[k], *q = base + (size_t)stride_floats * index[k + 4];
        out[k].lo = vld1q_f32(p);
        out[k].hi = vld1q_f32(q);
        out[k + 4].lo = vld1q_f32(p + 4);
        out[k + 4].hi = vld1q_f32(q + 4);
    }
    tl_neon_transpose4(&out[0].lo, &out[1].lo, &out[2].lo, &out[3].lo);
    tl_neon_transpose4(&out[0].hi, &out[1].hi, &out[2].hi, &out[3].hi);
    tl_neon_transpose4(&out[4].lo, &out[5].lo, &out[6].lo, &out[7].lo);
    tl_neon_transpose4(&out[4].hi, &out[5].hi, &out[6].hi, &out[7].hi);
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
    float32x4_t s = vaddq_f32(a.lo, a.hi);
    float32x2_t t = vadd_f32(vget_low_f32(s), vget_high_f32(s));
    return vget_lane_f32(t, 0) + vget_lane_f32(t, 1);
}

#endif
