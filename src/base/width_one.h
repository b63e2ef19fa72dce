/* One float at a time, under the names that templates of either width use (width_eight.h has eight): the same
 * operations in the same order give a lane and a float the same bits. */
#ifndef TL_WIDTH_ONE_H
#define TL_WIDTH_ONE_H

#define TL_WIDTH 1u

typedef float wf;

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

#endif
