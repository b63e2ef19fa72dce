/* Sine, cosine and their inverses of float, in radians: reduction to a short range and a polynomial there. The sources
 * of both are in trig_constants.h. Everything is computed on |x| and the sign is put back after, which makes the odd
 * functions odd to the bit. trig_lanes.h carries out the same operations in the same order. */
#include "base/trig.h"

#include "base/trig_constants.h"

#include <stdint.h>
#include <string.h>

float sqrtf(float);

#define SIGN 0x80000000u

static uint32_t bits_of(float x) {
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

static float of_bits(uint32_t u) {
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
}

/* The 32 bits of 2/pi from bit `at` on, where 0 is the weight of 2^31 */
static uint32_t two_over_pi_bits(uint32_t at) {
    static const uint32_t words[9] = {0,           0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u,
                                      0xdb629599u, 0x3c439041u, 0xfe5163abu, 0xdebbc561u};
    uint64_t pair = (uint64_t)words[at >> 5] << 32 | words[(at >> 5) + 1];
    return (uint32_t)(pair << (at & 31) >> 32);
}

/* The count of quarter turns, modulo 4, and the angle left in [-pi/4, pi/4], of a finite x >= TL_SINCOS_LIMIT: x times
 * those bits of 2/pi that are not multiples of four turns and do matter (M. H. Payne, R. N. Hanek, "Radian reduction
 * for trigonometric functions", SIGNUM Newsletter 18, 1983). */
static float reduce_large(float x, uint32_t *quarter) {
    uint32_t u = bits_of(x);
    uint64_t m = (u & 0x7fffffu) | 0x800000u; /* x = m 2^(e - 150) */
    uint32_t at = (u >> 23) - 120u;           /* x times the bit before is 4 m quarter turns */
    uint64_t p = (m * two_over_pi_bits(at) << 32) + m * two_over_pi_bits(at + 32) +
                 (m * two_over_pi_bits(at + 64) >> 32); /* quarter turns modulo 4, in units of 2^-62 */
    uint64_t q = (p + ((uint64_t)1 << 61)) >> 62;
    p -= q << 62;
    *quarter = (uint32_t)q;
    const double unit = 0x1.921fb54442d18p-62; /* pi/2 2^-62 */
    return p >> 63 ? (float)((double)(0 - p) * -unit) : (float)((double)p * unit);
}

void tl_sincos(float x, float *s, float *c) {
    uint32_t sign = bits_of(x) & SIGN, quarter;
    float a = of_bits(bits_of(x) ^ sign), r;
    if (a <= TL_SINCOS_LIMIT) {
        float t = a * TL_TWO_OVER_PI + TL_ROUNDER, k = t - TL_ROUNDER;
        quarter = bits_of(t);
        r = ((a - k * TL_HALF_PI_1) - k * TL_HALF_PI_2) - k * TL_HALF_PI_3;
    } else if (a - a == 0.0f) {
        r = reduce_large(a, &quarter);
    } else {
        *s = *c = x - x;
        return;
    }
    float z = r * r;
    float ps = r + (r * z) * (TL_SIN_1 + z * (TL_SIN_2 + z * TL_SIN_3));
    float pc = (1.0f - 0.5f * z) + (z * z) * (TL_COS_1 + z * (TL_COS_2 + z * TL_COS_3));
    int odd = (quarter & 1u) != 0;
    *s = of_bits(bits_of(odd ? pc : ps) ^ (sign ^ (quarter << 30 & SIGN)));
    *c = of_bits(bits_of(odd ? ps : pc) ^ ((quarter + 1u) << 30 & SIGN));
}

float tl_sin(float x) {
    float s, c;
    tl_sincos(x, &s, &c);
    return s;
}

float tl_cos(float x) {
    float s, c;
    tl_sincos(x, &s, &c);
    return c;
}

float tl_atan2(float y, float x) {
    uint32_t sign_y = bits_of(y) & SIGN, sign_x = bits_of(x) & SIGN;
    float a = of_bits(bits_of(y) ^ sign_y), b = of_bits(bits_of(x) ^ sign_x);
    int steep = a > b, left = sign_x != 0;
    float small = a < b ? a : b, large = b > a ? b : a;
    float t = small == large ? (large > 0.0f ? 1.0f : 0.0f) : small / large; /* 0/0 and inf/inf too */
    float z = t * t;
    float p = TL_ATAN_5 + z * (TL_ATAN_6 + z * (TL_ATAN_7 + z * TL_ATAN_8));
    p = TL_ATAN_1 + z * (TL_ATAN_2 + z * (TL_ATAN_3 + z * (TL_ATAN_4 + z * p)));
    p = t + (t * z) * p;
    p = of_bits(bits_of(p) ^ (steep != left ? SIGN : 0u));
    float hi = steep ? TL_HALF_PI_HI : left ? TL_PI_HI : 0.0f;
    float lo = steep ? TL_HALF_PI_LO : left ? TL_PI_LO : 0.0f;
    return of_bits(bits_of(hi + (p + lo)) ^ sign_y);
}

/* asin of x in [0, 1/2] */
static float asin_small(float x) {
    float z = x * x;
    float p = TL_ASIN_1 + z * (TL_ASIN_2 + z * (TL_ASIN_3 + z * (TL_ASIN_4 + z * TL_ASIN_5)));
    return x + (x * z) * p;
}

/* asin of sqrt((1 - a)/2), which is half of acos a, for a in [1/2, 1] */
static float half_acos(float a) { return asin_small(sqrtf(0.5f * (1.0f - a))); }

float tl_asin(float x) {
    uint32_t sign = bits_of(x) & SIGN;
    float a = of_bits(bits_of(x) ^ sign);
    a = a > 1.0f ? 1.0f : a;
    float r = a > 0.5f ? TL_HALF_PI_HI - (2.0f * half_acos(a) - TL_HALF_PI_LO) : asin_small(a);
    return of_bits(bits_of(r) ^ sign);
}

float tl_acos(float x) {
    uint32_t sign = bits_of(x) & SIGN;
    float a = of_bits(bits_of(x) ^ sign);
    a = a > 1.0f ? 1.0f : a;
    if (a > 0.5f) {
        float r = 2.0f * half_acos(a);
        return sign ? TL_PI_HI - (r - TL_PI_LO) : r;
    }
    float r = asin_small(a);
    return TL_HALF_PI_HI - ((sign ? -r : r) - TL_HALF_PI_LO);
}
