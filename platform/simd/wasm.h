/* lanes.h over WebAssembly's fixed-width SIMD (-msimd128), 2x4. Instructions as in the WebAssembly core specification,
 * release 2.0, section 4.3. The relaxed instructions are not used: their results differ between machines. */
#ifndef TL_SIMD_WASM_H
#define TL_SIMD_WASM_H

#include <stddef.h>
#include <stdint.h>
#include <wasm_simd128.h>

#define TL_LANES_NAME "wasm"

/* Clang before 16 folds a scalar load and its splat into one v128.load32_splat, which may then drift past later stores.
 * The barrier keeps them apart. Vectors that its optimiser makes of plain C are not safe from it: there the build needs
 * -fno-vectorize -fno-slp-vectorize. */
#if defined(__clang__) && __clang_major__ < 16
#define TL_WASM_KEEP(s) __asm__("" : "+r"(s))
#else
#define TL_WASM_KEEP(s) ((void)0)
#endif

typedef struct tl_f8 {
    v128_t lo, hi;
} tl_f8;

typedef struct tl_i8 {
    v128_t lo, hi;
} tl_i8;

typedef struct tl_m8 {
    v128_t lo, hi;
} tl_m8;

static inline tl_f8 tl_wasm_f8(v128_t lo, v128_t hi) {
    tl_f8 r = {lo, hi};
    return r;
}
static inline tl_i8 tl_wasm_i8(v128_t lo, v128_t hi) {
    tl_i8 r = {lo, hi};
    return r;
}
static inline tl_m8 tl_wasm_m8(v128_t lo, v128_t hi) {
    tl_m8 r = {lo, hi};
    return r;
}

static inline tl_f8 tl_f8_load(const float *p) { return tl_wasm_f8(wasm_v128_load(p), wasm_v128_load(p + 4)); }
static inline tl_f8 tl_f8_loadu(const float *p) { return tl_wasm_f8(wasm_v128_load(p), wasm_v128_load(p + 4)); }
static inline void tl_f8_store(float *p, tl_f8 a) {
    wasm_v128_store(p, a.lo);
    wasm_v128_store(p + 4, a.hi);
}
static inline void tl_f8_storeu(float *p, tl_f8 a) {
    wasm_v128_store(p, a.lo);
    wasm_v128_store(p + 4, a.hi);
}
static inline tl_f8 tl_f8_set1(float s) {
    TL_WASM_KEEP(s);
    v128_t r = wasm_f32x4_splat(s);
    return tl_wasm_f8(r, r);
}
static inline tl_f8 tl_f8_zero(void) { return tl_f8_set1(0.0f); }
static inline tl_f8 tl_f8_add(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_add(a.lo, b.lo), wasm_f32x4_add(a.hi, b.hi));
}
static inline tl_f8 tl_f8_sub(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_sub(a.lo, b.lo), wasm_f32x4_sub(a.hi, b.hi));
}
static inline tl_f8 tl_f8_mul(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_mul(a.lo, b.lo), wasm_f32x4_mul(a.hi, b.hi));
}
static inline tl_f8 tl_f8_div(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_div(a.lo, b.lo), wasm_f32x4_div(a.hi, b.hi));
}
static inline tl_f8 tl_f8_sqrt(tl_f8 a) { return tl_wasm_f8(wasm_f32x4_sqrt(a.lo), wasm_f32x4_sqrt(a.hi)); }
static inline tl_f8 tl_f8_neg(tl_f8 a) { return tl_wasm_f8(wasm_f32x4_neg(a.lo), wasm_f32x4_neg(a.hi)); }
static inline tl_f8 tl_f8_abs(tl_f8 a) { return tl_wasm_f8(wasm_f32x4_abs(a.lo), wasm_f32x4_abs(a.hi)); }
/* pmin(x, y) is y < x ? y : x and pmax(x, y) is x < y ? y : x, so the operands change places. */
static inline tl_f8 tl_f8_min(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_pmin(b.lo, a.lo), wasm_f32x4_pmin(b.hi, a.hi));
}
static inline tl_f8 tl_f8_max(tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_f32x4_pmax(b.lo, a.lo), wasm_f32x4_pmax(b.hi, a.hi));
}
static inline tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c) { return tl_f8_add(a, tl_f8_mul(b, c)); }
static inline tl_m8 tl_f8_lt(tl_f8 a, tl_f8 b) {
    return tl_wasm_m8(wasm_f32x4_lt(a.lo, b.lo), wasm_f32x4_lt(a.hi, b.hi));
}
static inline tl_m8 tl_f8_le(tl_f8 a, tl_f8 b) {
    return tl_wasm_m8(wasm_f32x4_le(a.lo, b.lo), wasm_f32x4_le(a.hi, b.hi));
}
static inline tl_m8 tl_f8_gt(tl_f8 a, tl_f8 b) {
    return tl_wasm_m8(wasm_f32x4_gt(a.lo, b.lo), wasm_f32x4_gt(a.hi, b.hi));
}
static inline tl_m8 tl_f8_ge(tl_f8 a, tl_f8 b) {
    return tl_wasm_m8(wasm_f32x4_ge(a.lo, b.lo), wasm_f32x4_ge(a.hi, b.hi));
}
static inline tl_m8 tl_f8_eq(tl_f8 a, tl_f8 b) {
    return tl_wasm_m8(wasm_f32x4_eq(a.lo, b.lo), wasm_f32x4_eq(a.hi, b.hi));
}
static inline tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b) {
    return tl_wasm_f8(wasm_v128_bitselect(a.lo, b.lo, m.lo), wasm_v128_bitselect(a.hi, b.hi, m.hi));
}
static inline tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a) {
    return tl_wasm_f8(wasm_v128_and(m.lo, a.lo), wasm_v128_and(m.hi, a.hi));
}

static inline tl_m8 tl_m8_and(tl_m8 a, tl_m8 b) {
    return tl_wasm_m8(wasm_v128_and(a.lo, b.lo), wasm_v128_and(a.hi, b.hi));
}
static inline tl_m8 tl_m8_or(tl_m8 a, tl_m8 b) {
    return tl_wasm_m8(wasm_v128_or(a.lo, b.lo), wasm_v128_or(a.hi, b.hi));
}
static inline tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b) {
    return tl_wasm_m8(wasm_v128_andnot(b.lo, a.lo), wasm_v128_andnot(b.hi, a.hi));
}
static inline tl_m8 tl_m8_not(tl_m8 a) { return tl_wasm_m8(wasm_v128_not(a.lo), wasm_v128_not(a.hi)); }
static inline unsigned tl_m8_bits(tl_m8 a) {
    return (unsigned)wasm_i32x4_bitmask(a.lo) | (unsigned)wasm_i32x4_bitmask(a.hi) << 4;
}
static inline int tl_m8_any(tl_m8 a) { return wasm_v128_any_true(wasm_v128_or(a.lo, a.hi)) != 0; }
static inline int tl_m8_all(tl_m8 a) { return wasm_i32x4_all_true(wasm_v128_and(a.lo, a.hi)) != 0; }
static inline tl_m8 tl_m8_from_bits(unsigned bits) {
    const v128_t lo = wasm_i32x4_const(1, 2, 4, 8), hi = wasm_i32x4_const(16, 32, 64, 128);
    TL_WASM_KEEP(bits);
    v128_t b = wasm_i32x4_splat((int32_t)(bits & 0xffu));
    return tl_wasm_m8(wasm_i32x4_eq(wasm_v128_and(b, lo), lo), wasm_i32x4_eq(wasm_v128_and(b, hi), hi));
}
static inline tl_m8 tl_m8_zero(void) { return tl_m8_from_bits(0); }

static inline tl_i8 tl_i8_load(const int32_t *p) { return tl_wasm_i8(wasm_v128_load(p), wasm_v128_load(p + 4)); }
static inline tl_i8 tl_i8_loadu(const int32_t *p) { return tl_wasm_i8(wasm_v128_load(p), wasm_v128_load(p + 4)); }
static inline void tl_i8_store(int32_t *p, tl_i8 a) {
    wasm_v128_store(p, a.lo);
    wasm_v128_store(p + 4, a.hi);
}
static inline void tl_i8_storeu(int32_t *p, tl_i8 a) {
    wasm_v128_store(p, a.lo);
    wasm_v128_store(p + 4, a.hi);
}
static inline tl_i8 tl_i8_set1(int32_t s) {
    TL_WASM_KEEP(s);
    v128_t r = wasm_i32x4_splat(s);
    return tl_wasm_i8(r, r);
}
static inline tl_i8 tl_i8_add(tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_i32x4_add(a.lo, b.lo), wasm_i32x4_add(a.hi, b.hi));
}
static inline tl_i8 tl_i8_sub(tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_i32x4_sub(a.lo, b.lo), wasm_i32x4_sub(a.hi, b.hi));
}
static inline tl_i8 tl_i8_and(tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_v128_and(a.lo, b.lo), wasm_v128_and(a.hi, b.hi));
}
static inline tl_i8 tl_i8_or(tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_v128_or(a.lo, b.lo), wasm_v128_or(a.hi, b.hi));
}
static inline tl_i8 tl_i8_xor(tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_v128_xor(a.lo, b.lo), wasm_v128_xor(a.hi, b.hi));
}
static inline tl_i8 tl_i8_shl(tl_i8 a, int n) {
    return tl_wasm_i8(wasm_i32x4_shl(a.lo, (uint32_t)n), wasm_i32x4_shl(a.hi, (uint32_t)n));
}
static inline tl_i8 tl_i8_shr_logical(tl_i8 a, int n) {
    return tl_wasm_i8(wasm_u32x4_shr(a.lo, (uint32_t)n), wasm_u32x4_shr(a.hi, (uint32_t)n));
}
static inline tl_m8 tl_i8_eq(tl_i8 a, tl_i8 b) {
    return tl_wasm_m8(wasm_i32x4_eq(a.lo, b.lo), wasm_i32x4_eq(a.hi, b.hi));
}
static inline tl_m8 tl_i8_gt(tl_i8 a, tl_i8 b) {
    return tl_wasm_m8(wasm_i32x4_gt(a.lo, b.lo), wasm_i32x4_gt(a.hi, b.hi));
}
static inline tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b) {
    return tl_wasm_i8(wasm_v128_bitselect(a.lo, b.lo, m.lo), wasm_v128_bitselect(a.hi, b.hi, m.hi));
}
static inline tl_i8 tl_i8_from_f8_trunc(tl_f8 a) {
    return tl_wasm_i8(wasm_i32x4_trunc_sat_f32x4(a.lo), wasm_i32x4_trunc_sat_f32x4(a.hi));
}
static inline tl_f8 tl_f8_from_i8(tl_i8 a) {
    return tl_wasm_f8(wasm_f32x4_convert_i32x4(a.lo), wasm_f32x4_convert_i32x4(a.hi));
}
static inline tl_i8 tl_i8_bits_of_f8(tl_f8 a) { return tl_wasm_i8(a.lo, a.hi); }
static inline tl_f8 tl_f8_of_bits(tl_i8 a) { return tl_wasm_f8(a.lo, a.hi); }

/* The 4x4 transpose of a..d, in place. */
TL_INLINE void tl_wasm_transpose4(v128_t *a, v128_t *b, v128_t *c, v128_t *d) {
    v128_t t0 = wasm_i32x4_shuffle(*a, *b, 0, 4, 1, 5), t1 = wasm_i32x4_shuffle(*a, *b, 2, 6, 3, 7);
    v128_t t2 = wasm_i32x4_shuffle(*c, *d, 0, 4, 1, 5), t3 = wasm_i32x4_shuffle(*c, *d, 2, 6, 3, 7);
    *a = wasm_i32x4_shuffle(t0, t2, 0, 1, 4, 5);
    *b = wasm_i32x4_shuffle(t0, t2, 2, 3, 6, 7);
    *c = wasm_i32x4_shuffle(t1, t3, 0, 1, 4, 5);
    *d = wasm_i32x4_shuffle(t1, t3, 2, 3, 6, 7);
}
TL_INLINE void tl_f8_transpose(tl_f8 r[8]) {
    tl_wasm_transpose4(&r[0].lo, &r[1].lo, &r[2].lo, &r[3].lo);
    tl_wasm_transpose4(&r[0].hi, &r[1].hi, &r[2].hi, &r[3].hi);
    tl_wasm_transpose4(&r[4].lo, &r[5].lo, &r[6].lo, &r[7].lo);
    tl_wasm_transpose4(&r[4].hi, &r[5].hi, &r[6].hi, &r[7].hi);
    for (int i = 0; i < 4; i++) {
        v128_t t = r[i].hi;
        r[i].hi = r[i + 4].lo;
        r[i + 4].lo = t;
    }
}
TL_INLINE void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8],
                                      tl_f8 out[8]) {
    for (int k = 0; k < 4; k++) {
        const float *p = base + (size_t)stride_floats * index[k], *q = base + (size_t)stride_floats * index[k + 4];
        out[k].lo = wasm_v128_load(p);
        out[k].hi = wasm_v128_load(q);
        out[k + 4].lo = wasm_v128_load(p + 4);
        out[k + 4].hi = wasm_v128_load(q + 4);
    }
    tl_wasm_transpose4(&out[0].lo, &out[1].lo, &out[2].lo, &out[3].lo);
    tl_wasm_transpose4(&out[0].hi, &out[1].hi, &out[2].hi, &out[3].hi);
    tl_wasm_transpose4(&out[4].lo, &out[5].lo, &out[6].lo, &out[7].lo);
    tl_wasm_transpose4(&out[4].hi, &out[5].hi, &out[6].hi, &out[7].hi);
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
    v128_t s = wasm_f32x4_add(a.lo, a.hi);
    s = wasm_f32x4_add(s, wasm_i32x4_shuffle(s, s, 2, 3, 2, 3));
    return wasm_f32x4_extract_lane(s, 0) + wasm_f32x4_extract_lane(s, 1);
}

#endif
