/* How the points of a face lie about their middle, seen along its normal. */
#ifndef TL_SPREAD_H
#define TL_SPREAD_H

#include "base/vec.h"

#define TL_SPREAD_POINTS 4u

/* Places from the mean along two axes across the normal, and the sums of their products. */
typedef struct tl_spread {
    talus_vec3 mean, u, v;
    float x[TL_SPREAD_POINTS], y[TL_SPREAD_POINTS];
    float xx, xy, yy;
} tl_spread;

static inline tl_spread tl_spread_of(const talus_vec3 *points, uint32_t count, talus_vec3 n) {
    tl_spread s;
    s.u = tl_perpendicular(n), s.v = tl_cross(n, s.u);
    s.mean = tl_v(0.0f, 0.0f, 0.0f);
    s.xx = s.xy = s.yy = 0.0f;
    for (uint32_t k = 0; k < count; k++) {
        s.mean = tl_mad(s.mean, 1.0f / (float)count, points[k]);
    }
    for (uint32_t k = 0; k < count; k++) {
        talus_vec3 d = tl_sub(points[k], s.mean);
        float x = tl_dot(d, s.u), y = tl_dot(d, s.v);
        s.x[k] = x, s.y[k] = y;
        s.xx += x * x, s.xy += x * y, s.yy += y * y;
    }
    return s;
}

#endif
