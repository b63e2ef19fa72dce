/* tl_sincos and tl_atan2 of trig.h over eight lanes: the same bits as those (of a NaN only that it is one). Included
 * after the instruction set was chosen for simd/lanes.h. */
#ifndef TL_TRIG_LANES_H
#define TL_TRIG_LANES_H

#include "base/trig.h"
#include "base/trig_constants.h"
#include "simd/lanes.h"

/* Fast for |x| <= TL_SINCOS_LIMIT; where a lane is beyond, lane by lane. */
static inline void tl_f8_sincos(tl_f8 x, tl_f8 *s, tl_f8 *c) {
    tl_f8 a = tl_f8_abs(x);
    if (!tl_m8_all(tl_f8_le(a, tl_f8_set1(TL_SINCOS_LIMIT)))) {
        float vx[8], vs[8], vc[8];
        tl_f8_storeu(vx, x);
        for (int i = 0; i < 8; i++) {
            tl_sincos(vx[i], &vs[i], &vc[i]);
        }
        *s = tl_f8_loadu(vs);
        *c = tl_f8_loadu(vc);
        return;
    }
    tl_f8 t = tl_f8_add(tl_f8_mul(a, tl_f8_set1(TL_TWO_OVER_PI)), tl_f8_set1(TL_ROUNDER));
    tl_f8 k = tl_f8_sub(t, tl_f8_set1(TL_ROUNDER));
    tl_f8 r = tl_f8_sub(a, tl_f8_mul(k, tl_f8_set1(TL_HALF_PI_1)));
    r = tl_f8_sub(r, tl_f8_mul(k, tl_f8_set1(TL_HALF_PI_2)));
    r = tl_f8_sub(r, tl_f8_mul(k, tl_f8_set1(TL_HALF_PI_3)));
    tl_f8 z = tl_f8_mul(r, r);
    tl_f8 ps = tl_f8_mad(tl_f8_set1(TL_SIN_2), z, tl_f8_set1(TL_SIN_3));
    ps = tl_f8_mad(tl_f8_set1(TL_SIN_1), z, ps);
    ps = tl_f8_mad(r, tl_f8_mul(r, z), ps);
    tl_f8 pc = tl_f8_mad(tl_f8_set1(TL_COS_2), z, tl_f8_set1(TL_COS_3));
    pc = tl_f8_mad(tl_f8_set1(TL_COS_1), z, pc);
    tl_f8 one_less = tl_f8_sub(tl_f8_set1(1.0f), tl_f8_mul(tl_f8_set1(0.5f), z));
    pc = tl_f8_mad(one_less, tl_f8_mul(z, z), pc);
    tl_i8 quarter = tl_i8_bits_of_f8(t), sign = tl_i8_bits_of_f8(tl_f8_set1(-0.0f)), one = tl_i8_set1(1);
    tl_m8 odd = tl_i8_eq(tl_i8_and(quarter, one), one);
    tl_i8 flip_s = tl_i8_xor(tl_i8_and(tl_i8_bits_of_f8(x), sign), tl_i8_and(tl_i8_shl(quarter, 30), sign));
    tl_i8 flip_c = tl_i8_and(tl_i8_shl(tl_i8_add(quarter, one), 30), sign);
    *s = tl_f8_of_bits(tl_i8_xor(tl_i8_bits_of_f8(tl_f8_select(odd, pc, ps)), flip_s));
    *c = tl_f8_of_bits(tl_i8_xor(tl_i8_bits_of_f8(tl_f8_select(odd, ps, pc)), flip_c));
}

static inline tl_f8 tl_f8_atan2(tl_f8 y, tl_f8 x) {
    tl_i8 sign = tl_i8_bits_of_f8(tl_f8_set1(-0.0f));
    tl_i8 sign_y = tl_i8_and(tl_i8_bits_of_f8(y), sign), sign_x = tl_i8_and(tl_i8_bits_of_f8(x), sign);
    tl_f8 a = tl_f8_abs(y), b = tl_f8_abs(x);
    tl_m8 steep = tl_f8_gt(a, b), left = tl_i8_eq(sign_x, sign);
    tl_f8 small = tl_f8_min(a, b), large = tl_f8_max(b, a);
    tl_f8 equal = tl_f8_and_mask(tl_f8_gt(large, tl_f8_zero()), tl_f8_set1(1.0f));
    tl_f8 t = tl_f8_select(tl_f8_eq(small, large), equal, tl_f8_div(small, large));
    tl_f8 z = tl_f8_mul(t, t);
    tl_f8 p = tl_f8_mad(tl_f8_set1(TL_ATAN_7), z, tl_f8_set1(TL_ATAN_8));
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_6), z, p);
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_5), z, p);
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_4), z, p);
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_3), z, p);
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_2), z, p);
    p = tl_f8_mad(tl_f8_set1(TL_ATAN_1), z, p);
    p = tl_f8_mad(t, tl_f8_mul(t, z), p);
    tl_i8 flip = tl_i8_select(steep, tl_i8_xor(sign_x, sign), sign_x);
    p = tl_f8_of_bits(tl_i8_xor(tl_i8_bits_of_f8(p), flip));
    tl_f8 hi = tl_f8_select(steep, tl_f8_set1(TL_HALF_PI_HI), tl_f8_and_mask(left, tl_f8_set1(TL_PI_HI)));
    tl_f8 lo = tl_f8_select(steep, tl_f8_set1(TL_HALF_PI_LO), tl_f8_and_mask(left, tl_f8_set1(TL_PI_LO)));
    tl_f8 angle = tl_f8_add(hi, tl_f8_add(p, lo));
    return tl_f8_of_bits(tl_i8_xor(tl_i8_bits_of_f8(angle), sign_y));
}

#endif
