/* Vectors of double for the geometry builders, which run once and off the clock of the step. Only + - * / and a square
 * root made of them, so that the results are the same on every compiler. */
#ifndef TL_DOUBLE3_H
#define TL_DOUBLE3_H

#include "base/vec.h"

typedef struct tl_d3 {
    double x, y, z;
} tl_d3;

static inline tl_d3 tl_d(double x, double y, double z) {
    tl_d3 v = {x, y, z};
    return v;
}
static inline tl_d3 tl_d_from(talus_vec3 v) { return tl_d((double)v.x, (double)v.y, (double)v.z); }
static inline talus_vec3 tl_d_round(tl_d3 v) { return tl_v((float)v.x, (float)v.y, (float)v.z); }
static inline tl_d3 tl_d_add(tl_d3 a, tl_d3 b) { return tl_d(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline tl_d3 tl_d_sub(tl_d3 a, tl_d3 b) { return tl_d(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline tl_d3 tl_d_scale(tl_d3 a, double s) { return tl_d(a.x * s, a.y * s, a.z * s); }
static inline double tl_d_dot(tl_d3 a, tl_d3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline tl_d3 tl_d_cross(tl_d3 a, tl_d3 b) {
    return tl_d(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double tl_d_abs(double x) { return x < 0.0 ? -x : x; }
static inline double tl_d_min(double a, double b) { return a < b ? a : b; }
static inline double tl_d_max(double a, double b) { return a > b ? a : b; }

/* The square root to within a unit or two of the last place, for 0 and for x in about [1e-290, 1e290]: the float root
 * of x brought near 1 by powers of 2^64, then Heron's step twice (24 bits to 48 to 53). */
static inline double tl_d_sqrt(double x) {
    if (!(x > 0.0)) {
        return 0.0;
    }
    double s = 1.0;
    while (x >= 18446744073709551616.0) {
        x /= 18446744073709551616.0, s *= 4294967296.0;
    }
    while (x < 1.0 / 18446744073709551616.0) {
        x *= 18446744073709551616.0, s /= 4294967296.0;
    }
    double y = (double)sqrtf((float)x);
    y = 0.5 * (y + x / y);
    y = 0.5 * (y + x / y);
    return y * s;
}
static inline double tl_d_length(tl_d3 a) { return tl_d_sqrt(tl_d_dot(a, a)); }

#endif
