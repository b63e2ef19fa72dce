/* What trig.c and trig_lanes.h share, so that both give the same bits.
 *
 * The polynomials are least-maximum relative-error fits by Remez exchange (E. Remez, "Sur la determination des
 * polynomes d'approximation de degre donnee", 1934), in z = x^2. The coefficients were rounded to float from the lowest
 * power up, and the rest fitted again after each rounding. */
#ifndef TL_TRIG_CONSTANTS_H
#define TL_TRIG_CONSTANTS_H

/* sin x = x + x z (S1 + z (S2 + z S3)) on |x| <= 1.0005 pi/4, within 2^-27.9 */
#define TL_SIN_1 (-0x1.555546p-3f)
#define TL_SIN_2 0x1.110776p-7f
#define TL_SIN_3 (-0x1.9952fap-13f)
/* cos x = (1 - z/2) + z z (C1 + z (C2 + z C3)) there, within 2^-32.9 */
#define TL_COS_1 0x1.55554ap-5f
#define TL_COS_2 (-0x1.6c0c28p-10f)
#define TL_COS_3 0x1.99e80cp-16f
/* atan x = x + x z (A1 + z (A2 + ... z A8)) on |x| <= 1, within 2^-25.8 */
#define TL_ATAN_1 (-0x1.5554dcp-2f)
#define TL_ATAN_2 0x1.9978ecp-3f
#define TL_ATAN_3 (-0x1.230a94p-3f)
#define TL_ATAN_4 0x1.b4de82p-4f
#define TL_ATAN_5 (-0x1.354fcep-4f)
#define TL_ATAN_6 0x1.61ea3ep-5f
#define TL_ATAN_7 (-0x1.0c0fa4p-6f)
#define TL_ATAN_8 0x1.7e906ep-9f
/* asin x = x + x z (N1 + z (N2 + ... z N5)) on |x| <= 1/2, within 2^-27.6 */
#define TL_ASIN_1 0x1.5555c8p-3f
#define TL_ASIN_2 0x1.330204p-4f
#define TL_ASIN_3 0x1.747bbap-5f
#define TL_ASIN_4 0x1.8c3e2ap-6f
#define TL_ASIN_5 0x1.595c8cp-5f

/* pi/2 and pi, each in two floats */
#define TL_HALF_PI_HI 0x1.921fb6p+0f
#define TL_HALF_PI_LO (-0x1.777a5cp-25f)
#define TL_PI_HI 0x1.921fb6p+1f
#define TL_PI_LO (-0x1.777a5cp-24f)

/* Reduction by pi/2 in three parts (W. J. Cody, W. Waite, "Software Manual for the Elementary Functions", 1980). The
 * first two have 14 bits, so that their products with a count of at most ten bits are exact; together they miss pi/2 by
 * 1.2e-18. */
#define TL_SINCOS_LIMIT 1024.0f
#define TL_TWO_OVER_PI 0x1.45f306p-1f
#define TL_HALF_PI_1 0x1.922p+0f
#define TL_HALF_PI_2 (-0x1.2afp-18f)
#define TL_HALF_PI_3 0x1.0b4612p-34f
/* 1.5 * 2^23: adding it rounds a number below 2^22 to an integer and leaves that in the low bits */
#define TL_ROUNDER 12582912.0f

#endif
