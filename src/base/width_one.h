/* One float at a time, under the names that templates of either width use (width_eight.h has eight): the same
 * operations in the same order give a lane and a float the same bits. */
#ifndef TL_WIDTH_ONE_H
#define TL_WIDTH_ONE_H

#include "base/vec.h"

#define TL_WIDTH 1u
#define TL_INLINE static inline
#define TL_UNROLL /* what is as short as with single floats is unrolled anyway */

typedef float wf;
typedef uint32_t wi;
typedef int wm; /* 0 or 1 */

static inline wf wf_load(const float *p) { return *p; }
static inline void wf_store(float *p, wf a) { *p = a; }
static inline wf wf_set1(float s) { return s; }
static inline wf wf_add(wf a, wf b) { return a + b; }
static inline wf wf_sub(wf a, wf b) { return a - b; }
static inline wf wf_mul(wf a, wf b) { return a * b; }
static inline wf wf_mad(wf a, wf b, wf c) { return a + b * c; }
/* Whether any is not 0. */
static inline int wf_any(wf a) { return a != 0.0f; }
/* 1 / a where a > 0, else 0 */
static inline wf wf_inverse(wf a) { return a > 0.0f ? 1.0f / a : 0.0f; }
static inline wf wf_div(wf a, wf b) { return a / b; }
static inline wf wf_sqrt(wf a) { return sqrtf(a); }
static inline wf wf_neg(wf a) { return -a; }
static inline wf wf_abs(wf a) { return a > 0.0f ? a : 0.0f - a; } /* +0 of -0, as lanes have it */
static inline wf wf_min(wf a, wf b) { return tl_min(a, b); }
static inline wf wf_max(wf a, wf b) { return tl_max(a, b); }
static inline wm wf_lt(wf a, wf b) { return a < b; }
static inline wm wf_le(wf a, wf b) { return a <= b; }
static inline wm wf_eq(wf a, wf b) { return a == b; }
static inline wf wf_select(wm m, wf a, wf b) { return m ? a : b; }
/* m ? a : 0 */
static inline wf wf_where(wm m, wf a) { return m ? a : 0.0f; }

static inline wm wm_and(wm a, wm b) { return a & b; }
/* b where not a */
static inline wm wm_andnot(wm a, wm b) { return b & (a ^ 1); }
static inline wm wm_or(wm a, wm b) { return a | b; }
static inline wm wm_not(wm a) { return a ^ 1; }
static inline wm wm_none(void) { return 0; }
static inline int wm_any(wm a) { return a; }

static inline wi wi_set1(uint32_t s) { return s; }
static inline wi wi_add(wi a, wi b) { return a + b; }
static inline wi wi_shl(wi a, int n) { return a << n; }
static inline wi wi_select(wm m, wi a, wi b) { return m ? a : b; }

#endif
