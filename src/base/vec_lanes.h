/* Vectors and quaternions of eight lanes, in the same order of operations as vec.h. Includes whichever lanes the
 * including file has chosen. */
#ifndef TL_VEC_LANES_H
#define TL_VEC_LANES_H

#include "simd/lanes.h"

typedef struct v8 {
    tl_f8 x, y, z;
} v8;

typedef struct q8 {
    tl_f8 x, y, z, w;
} q8;

TL_INLINE v8 v8_of(tl_f8 x, tl_f8 y, tl_f8 z) {
    v8 r = {x, y, z};
    return r;
}
/* Three aligned runs of eight floats, one behind the other. */
TL_INLINE v8 v8_load(const float *p) { return v8_of(tl_f8_load(p), tl_f8_load(p + 8), tl_f8_load(p + 16)); }
TL_INLINE void v8_store(float *p, v8 a) {
    tl_f8_store(p, a.x);
    tl_f8_store(p + 8, a.y);
    tl_f8_store(p + 16, a.z);
}
TL_INLINE v8 v8_zero(void) { return v8_of(tl_f8_zero(), tl_f8_zero(), tl_f8_zero()); }
TL_INLINE v8 v8_add(v8 a, v8 b) { return v8_of(tl_f8_add(a.x, b.x), tl_f8_add(a.y, b.y), tl_f8_add(a.z, b.z)); }
TL_INLINE v8 v8_sub(v8 a, v8 b) { return v8_of(tl_f8_sub(a.x, b.x), tl_f8_sub(a.y, b.y), tl_f8_sub(a.z, b.z)); }
TL_INLINE v8 v8_mul(v8 a, v8 b) { return v8_of(tl_f8_mul(a.x, b.x), tl_f8_mul(a.y, b.y), tl_f8_mul(a.z, b.z)); }
TL_INLINE v8 v8_scale(v8 a, tl_f8 s) { return v8_of(tl_f8_mul(a.x, s), tl_f8_mul(a.y, s), tl_f8_mul(a.z, s)); }
/* a + s b */
TL_INLINE v8 v8_mad(v8 a, tl_f8 s, v8 b) {
    return v8_of(tl_f8_mad(a.x, s, b.x), tl_f8_mad(a.y, s, b.y), tl_f8_mad(a.z, s, b.z));
}
/* a - s b */
TL_INLINE v8 v8_msub(v8 a, tl_f8 s, v8 b) {
    return v8_of(tl_f8_sub(a.x, tl_f8_mul(s, b.x)), tl_f8_sub(a.y, tl_f8_mul(s, b.y)),
                 tl_f8_sub(a.z, tl_f8_mul(s, b.z)));
}
TL_INLINE tl_f8 v8_dot(v8 a, v8 b) { return tl_f8_mad(tl_f8_mad(tl_f8_mul(a.x, b.x), a.y, b.y), a.z, b.z); }
TL_INLINE v8 v8_cross(v8 a, v8 b) {
    return v8_of(tl_f8_sub(tl_f8_mul(a.y, b.z), tl_f8_mul(a.z, b.y)),
                 tl_f8_sub(tl_f8_mul(a.z, b.x), tl_f8_mul(a.x, b.z)),
                 tl_f8_sub(tl_f8_mul(a.x, b.y), tl_f8_mul(a.y, b.x)));
}
TL_INLINE v8 v8_select(tl_m8 m, v8 a, v8 b) {
    return v8_of(tl_f8_select(m, a.x, b.x), tl_f8_select(m, a.y, b.y), tl_f8_select(m, a.z, b.z));
}

TL_INLINE q8 q8_of(tl_f8 x, tl_f8 y, tl_f8 z, tl_f8 w) {
    q8 r = {x, y, z, w};
    return r;
}
TL_INLINE q8 q8_conjugate(q8 q) { return q8_of(tl_f8_neg(q.x), tl_f8_neg(q.y), tl_f8_neg(q.z), q.w); }
TL_INLINE v8 q8_rotate(q8 q, v8 v) {
    v8 u = v8_of(q.x, q.y, q.z), t = v8_cross(u, v);
    t = v8_add(t, t);
    return v8_add(v8_mad(v, q.w, t), v8_cross(u, t));
}
TL_INLINE v8 q8_rotate_back(q8 q, v8 v) { return q8_rotate(q8_conjugate(q), v); }
/* The rotation b followed by a. */
TL_INLINE q8 q8_mul(q8 a, q8 b) {
    return q8_of(tl_f8_sub(tl_f8_mad(tl_f8_mad(tl_f8_mul(a.w, b.x), a.x, b.w), a.y, b.z), tl_f8_mul(a.z, b.y)),
                 tl_f8_mad(tl_f8_mad(tl_f8_sub(tl_f8_mul(a.w, b.y), tl_f8_mul(a.x, b.z)), a.y, b.w), a.z, b.x),
                 tl_f8_mad(tl_f8_sub(tl_f8_mad(tl_f8_mul(a.w, b.z), a.x, b.y), tl_f8_mul(a.y, b.x)), a.z, b.w),
                 tl_f8_sub(tl_f8_sub(tl_f8_sub(tl_f8_mul(a.w, b.w), tl_f8_mul(a.x, b.x)), tl_f8_mul(a.y, b.y)),
                           tl_f8_mul(a.z, b.z)));
}
TL_INLINE q8 q8_normalize(q8 q) {
    tl_f8 n = tl_f8_sqrt(tl_f8_mad(tl_f8_mad(tl_f8_mad(tl_f8_mul(q.x, q.x), q.y, q.y), q.z, q.z), q.w, q.w));
    return q8_of(tl_f8_div(q.x, n), tl_f8_div(q.y, n), tl_f8_div(q.z, n), tl_f8_div(q.w, n));
}
TL_INLINE q8 q8_select(tl_m8 m, q8 a, q8 b) {
    return q8_of(tl_f8_select(m, a.x, b.x), tl_f8_select(m, a.y, b.y), tl_f8_select(m, a.z, b.z),
                 tl_f8_select(m, a.w, b.w));
}

/* K = diag(s) R^T by rows: K v = (x . v, y . v, z . v). */
typedef struct k8 {
    v8 x, y, z;
} k8;

TL_INLINE k8 k8_of(q8 q, v8 s) {
    tl_f8 one = tl_f8_set1(1.0f);
    tl_f8 x2 = tl_f8_add(q.x, q.x), y2 = tl_f8_add(q.y, q.y), z2 = tl_f8_add(q.z, q.z);
    tl_f8 xx = tl_f8_mul(q.x, x2), xy = tl_f8_mul(q.x, y2), xz = tl_f8_mul(q.x, z2);
    tl_f8 yy = tl_f8_mul(q.y, y2), yz = tl_f8_mul(q.y, z2), zz = tl_f8_mul(q.z, z2);
    tl_f8 wx = tl_f8_mul(q.w, x2), wy = tl_f8_mul(q.w, y2), wz = tl_f8_mul(q.w, z2);
    k8 k = {v8_scale(v8_of(tl_f8_sub(one, tl_f8_add(yy, zz)), tl_f8_add(xy, wz), tl_f8_sub(xz, wy)), s.x),
            v8_scale(v8_of(tl_f8_sub(xy, wz), tl_f8_sub(one, tl_f8_add(xx, zz)), tl_f8_add(yz, wx)), s.y),
            v8_scale(v8_of(tl_f8_add(xz, wy), tl_f8_sub(yz, wx), tl_f8_sub(one, tl_f8_add(xx, yy))), s.z)};
    return k;
}
TL_INLINE v8 k8_mul(const k8 *k, v8 v) { return v8_of(v8_dot(k->x, v), v8_dot(k->y, v), v8_dot(k->z, v)); }
/* K^T u */
TL_INLINE v8 k8_mul_t(const k8 *k, v8 u) { return v8_mad(v8_mad(v8_scale(k->x, u.x), u.y, k->y), u.z, k->z); }

#endif
