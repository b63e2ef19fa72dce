/* Trigonometry of float, in radians: the same bits on every processor, and no libm.
 *
 * Error bounds are against the exact value. 2^-24 is half a unit in the last place of a number just above 1, and 6e-8.
 *
 *   function      argument                     absolute error   relative error
 *   tl_sin, cos   |x| <= pi                    1.0e-7           1.4e-7
 *   tl_sin, cos   any finite x                 1.2e-7           2.0e-7
 *   tl_atan2      any but NaN                  2.3e-7           1.4e-7, of angles that are not denormal
 *   tl_asin       |x| <= 1                     1.5e-7           2.8e-7
 *   tl_acos       |x| <= 1                     2.6e-7           1.4e-7
 *
 * sin(-x) is -sin(x) and cos(-x) is cos(x), bit for bit, and the same for the other odd functions. No argument is
 * undefined: sine and cosine of an infinity are NaN, and a NaN anywhere gives a NaN. */
#ifndef TL_TRIG_H
#define TL_TRIG_H

float tl_sin(float x);
float tl_cos(float x);
/* Both of one reduction: the same bits as tl_sin and tl_cos. */
void tl_sincos(float x, float *s, float *c);
/* The angle of (x, y) from the x axis, in [-pi, pi]; zeros and infinities as in C99 F.9.1.4. The signs of zeros count.
 */
float tl_atan2(float y, float x);
/* Arguments beyond [-1, 1] are taken as -1 and 1: dot products of unit vectors stray by a rounding. */
float tl_asin(float x);
float tl_acos(float x);

#endif
