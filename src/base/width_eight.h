/* Eight lanes under the names that templates of either width use; see width_one.h. Includes whichever lanes the
 * including file has chosen. */
#ifndef TL_WIDTH_EIGHT_H
#define TL_WIDTH_EIGHT_H

#include "simd/lanes.h"

#define TL_WIDTH 8u

typedef tl_f8 wf;
typedef tl_i8 wi;
typedef tl_m8 wm;

static inline wf wf_load(const float *p) { return tl_f8_load(p); }
static inline void wf_store(float *p, wf a) { tl_f8_store(p, a); }
static inline wf wf_set1(float s) { return tl_f8_set1(s); }
static inline wf wf_add(wf a, wf b) { return tl_f8_add(a, b); }
static inline wf wf_sub(wf a, wf b) { return tl_f8_sub(a, b); }
static inline wf wf_mul(wf a, wf b) { return tl_f8_mul(a, b); }
static inline wf wf_mad(wf a, wf b, wf c) { return tl_f8_mad(a, b, c); }
static inline int wf_any(wf a) { return !tl_m8_all(tl_f8_eq(a, tl_f8_zero())); }
static inline wf wf_inverse(wf a) {
    tl_m8 ok = tl_f8_gt(a, tl_f8_zero());
    return tl_f8_and_mask(ok, tl_f8_div(tl_f8_set1(1.0f), tl_f8_select(ok, a, tl_f8_set1(1.0f))));
}
static inline wf wf_div(wf a, wf b) { return tl_f8_div(a, b); }
static inline wf wf_sqrt(wf a) { return tl_f8_sqrt(a); }
static inline wf wf_neg(wf a) { return tl_f8_neg(a); }
static inline wf wf_abs(wf a) { return tl_f8_abs(a); }
static inline wf wf_min(wf a, wf b) { return tl_f8_min(a, b); }
static inline wf wf_max(wf a, wf b) { return tl_f8_max(a, b); }
static inline wm wf_lt(wf a, wf b) { return tl_f8_lt(a, b); }
static inline wm wf_le(wf a, wf b) { return tl_f8_le(a, b); }
static inline wm wf_eq(wf a, wf b) { return tl_f8_eq(a, b); }
static inline wf wf_select(wm m, wf a, wf b) { return tl_f8_select(m, a, b); }
static inline wf wf_where(wm m, wf a) { return tl_f8_and_mask(m, a); }

static inline wm wm_and(wm a, wm b) { return tl_m8_and(a, b); }
static inline wm wm_andnot(wm a, wm b) { return tl_m8_andnot(a, b); }
static inline wm wm_or(wm a, wm b) { return tl_m8_or(a, b); }
static inline wm wm_not(wm a) { return tl_m8_not(a); }
static inline wm wm_none(void) { return tl_m8_zero(); }
static inline int wm_any(wm a) { return tl_m8_any(a); }

static inline wi wi_set1(uint32_t s) { return tl_i8_set1((int32_t)s); }
static inline wi wi_add(wi a, wi b) { return tl_i8_add(a, b); }
static inline wi wi_shl(wi a, int n) { return tl_i8_shl(a, n); }
static inline wi wi_select(wm m, wi a, wi b) { return tl_i8_select(m, a, b); }

#endif
