/* Eight lanes under the names that templates of either width use; see width_one.h. Includes whichever lanes the
 * including file has chosen. */
#ifndef TL_WIDTH_EIGHT_H
#define TL_WIDTH_EIGHT_H

#include "simd/lanes.h"

#define TL_WIDTH 8u

typedef tl_f8 wf;

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

#endif
