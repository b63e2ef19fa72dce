/* lanes.h in plain C, one lane at a time. The other sets are tested against this one. */
#ifndef TL_SIMD_SCALAR_H
#define TL_SIMD_SCALAR_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TL_LANES_NAME "scalar"

float sqrtf(float);

/* One type for all three, read by whichever member is meant (C99 6.5.2.3, note 82). With separate types the optimiser
 * of GCC 12 for AArch64 may move a load of one before the store of the same bits as another. */
typedef union tl_scalar8 {
    float f[8];
    int32_t i[8];
    uint32_t u[8];
} tl_scalar8;
typedef tl_scalar8 tl_f8;
typedef tl_scalar8 tl_i8;
typedef tl_scalar8 tl_m8;

static inline tl_f8 tl_f8_loadu(const float *p) {
    tl_f8 r;
    memcpy(r.f, p, sizeof r.f);
    return r;
}
static inline void tl_f8_storeu(float *p, tl_f8 a) { memcpy(p, a.f, sizeof a.f); }
static inline tl_f8 tl_f8_load(const float *p) { return tl_f8_loadu(p); }
static inline void tl_f8_store(float *p, tl_f8 a) { tl_f8_storeu(p, a); }
static inline tl_f8 tl_f8_set1(float s) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = s;
    }
    return r;
}
static inline tl_f8 tl_f8_zero(void) { return tl_f8_set1(0.0f); }
static inline tl_f8 tl_f8_add(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] + b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_sub(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] - b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_mul(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] * b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_div(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] / b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_sqrt(tl_f8 a) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = sqrtf(a.f[i]);
    }
    return r;
}
static inline tl_i8 tl_i8_bits_of_f8(tl_f8 a) { return a; }
static inline tl_f8 tl_f8_of_bits(tl_i8 a) { return a; }
static inline tl_f8 tl_f8_neg(tl_f8 a) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] ^ 0x80000000u;
    }
    return r;
}
static inline tl_f8 tl_f8_abs(tl_f8 a) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] & 0x7fffffffu;
    }
    return r;
}
static inline tl_f8 tl_f8_min(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] < b.f[i] ? a.f[i] : b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_max(tl_f8 a, tl_f8 b) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = a.f[i] > b.f[i] ? a.f[i] : b.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_mad(tl_f8 a, tl_f8 b, tl_f8 c) { return tl_f8_add(a, tl_f8_mul(b, c)); }
static inline tl_m8 tl_f8_lt(tl_f8 a, tl_f8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.f[i] < b.f[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_f8_le(tl_f8 a, tl_f8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.f[i] <= b.f[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_f8_gt(tl_f8 a, tl_f8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.f[i] > b.f[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_f8_ge(tl_f8 a, tl_f8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.f[i] >= b.f[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_f8_eq(tl_f8 a, tl_f8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.f[i] == b.f[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_f8 tl_f8_select(tl_m8 m, tl_f8 a, tl_f8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = (a.u[i] & m.u[i]) | (b.u[i] & ~m.u[i]);
    }
    return r;
}
static inline tl_f8 tl_f8_and_mask(tl_m8 m, tl_f8 a) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] & m.u[i];
    }
    return r;
}
static inline tl_m8 tl_m8_and(tl_m8 a, tl_m8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] & b.u[i];
    }
    return r;
}
static inline tl_m8 tl_m8_or(tl_m8 a, tl_m8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] | b.u[i];
    }
    return r;
}
static inline tl_m8 tl_m8_andnot(tl_m8 a, tl_m8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = ~a.u[i] & b.u[i];
    }
    return r;
}
static inline tl_m8 tl_m8_not(tl_m8 a) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = ~a.u[i];
    }
    return r;
}
static inline unsigned tl_m8_bits(tl_m8 a) {
    unsigned r = 0;
    for (int i = 0; i < 8; i++) {
        r |= (unsigned)(a.u[i] & 1u) << i;
    }
    return r;
}
static inline int tl_m8_any(tl_m8 a) { return tl_m8_bits(a) != 0; }
static inline int tl_m8_all(tl_m8 a) { return tl_m8_bits(a) == 0xffu; }
static inline tl_m8 tl_m8_from_bits(unsigned bits) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = (bits >> i) & 1u ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_m8_zero(void) { return tl_m8_from_bits(0); }

static inline tl_i8 tl_i8_loadu(const int32_t *p) {
    tl_i8 r;
    memcpy(r.i, p, sizeof r.i);
    return r;
}
static inline void tl_i8_storeu(int32_t *p, tl_i8 a) { memcpy(p, a.i, sizeof a.i); }
static inline tl_i8 tl_i8_load(const int32_t *p) { return tl_i8_loadu(p); }
static inline void tl_i8_store(int32_t *p, tl_i8 a) { tl_i8_storeu(p, a); }
static inline tl_i8 tl_i8_set1(int32_t s) {
    tl_i8 r;
    for (int i = 0; i < 8; i++) {
        r.i[i] = s;
    }
    return r;
}
static inline tl_i8 tl_i8_add(tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] + b.u[i];
    }
    return r;
}
static inline tl_i8 tl_i8_sub(tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] - b.u[i];
    }
    return r;
}
static inline tl_i8 tl_i8_and(tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] & b.u[i];
    }
    return r;
}
static inline tl_i8 tl_i8_or(tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] | b.u[i];
    }
    return r;
}
static inline tl_i8 tl_i8_xor(tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] ^ b.u[i];
    }
    return r;
}
static inline tl_i8 tl_i8_shl(tl_i8 a, int n) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] << n;
    }
    return r;
}
static inline tl_i8 tl_i8_shr_logical(tl_i8 a, int n) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.u[i] >> n;
    }
    return r;
}
static inline tl_m8 tl_i8_eq(tl_i8 a, tl_i8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.i[i] == b.i[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_m8 tl_i8_gt(tl_i8 a, tl_i8 b) {
    tl_m8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = a.i[i] > b.i[i] ? 0xffffffffu : 0u;
    }
    return r;
}
static inline tl_i8 tl_i8_select(tl_m8 m, tl_i8 a, tl_i8 b) {
    tl_scalar8 r;
    for (int i = 0; i < 8; i++) {
        r.u[i] = (a.u[i] & m.u[i]) | (b.u[i] & ~m.u[i]);
    }
    return r;
}
static inline tl_i8 tl_i8_from_f8_trunc(tl_f8 a) {
    tl_i8 r;
    for (int i = 0; i < 8; i++) {
        r.i[i] = (int32_t)a.f[i];
    }
    return r;
}
static inline tl_f8 tl_f8_from_i8(tl_i8 a) {
    tl_f8 r;
    for (int i = 0; i < 8; i++) {
        r.f[i] = (float)a.i[i];
    }
    return r;
}

static inline void tl_f8_transpose(tl_f8 r[8]) {
    for (int i = 0; i < 8; i++) {
        for (int j = 0; j < i; j++) {
            float t = r[i].f[j];
            r[i].f[j] = r[j].f[i];
            r[j].f[i] = t;
        }
    }
}
static inline void tl_f8_load_rows_stride(const float *base, uint32_t stride_floats, const uint32_t index[8],
                                          tl_f8 out[8]) {
    for (int k = 0; k < 8; k++) {
        const float *row = base + (size_t)stride_floats * index[k];
        for (int c = 0; c < 8; c++) {
            out[c].f[k] = row[c];
        }
    }
}
static inline void tl_f8_load_rows(const float *base, const uint32_t index[8], tl_f8 out[8]) {
    tl_f8_load_rows_stride(base, 8, index, out);
}
static inline void tl_f8_store_rows(float *base, const uint32_t index[8], const tl_f8 in[8]) {
    for (int k = 0; k < 8; k++) {
        float *row = base + (size_t)8 * index[k];
        for (int c = 0; c < 8; c++) {
            row[c] = in[c].f[k];
        }
    }
}
static inline float tl_f8_lane(tl_f8 a, int i) { return a.f[i]; }
static inline float tl_f8_sum(tl_f8 a) {
    const float *v = a.f;
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

#endif
