/* Vectors, quaternions and matrices of float. Every operation is written out in the order it is carried out, so that
 * the results are the same on every compiler. */
#ifndef TL_VEC_H
#define TL_VEC_H

#include <float.h>

#include "talus/types.h"

/* The same bits everywhere ask for floats that are worked out as floats: on s390 by -fexcess-precision=fast, on 32-bit
 * x86 by -msse2 -mfpmath=sse. */
#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "this compiler does not work floats out as floats (FLT_EVAL_METHOD)"
#endif

float sqrtf(float); /* the one mathematical function that the core takes from outside; it is exact by IEEE 754 */

static inline float tl_min(float a, float b) { return a < b ? a : b; }
static inline float tl_max(float a, float b) { return a > b ? a : b; }
static inline float tl_clamp(float x, float low, float high) { return tl_min(tl_max(x, low), high); }
static inline float tl_abs(float x) { return x < 0.0f ? -x : x; }
/* False for NaN and the infinities. */
static inline int tl_is_finite(float x) { return x - x == 0.0f; }

static inline talus_vec3 tl_v(float x, float y, float z) {
    talus_vec3 v = {x, y, z};
    return v;
}
static inline talus_vec3 tl_add(talus_vec3 a, talus_vec3 b) { return tl_v(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline talus_vec3 tl_sub(talus_vec3 a, talus_vec3 b) { return tl_v(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline talus_vec3 tl_neg(talus_vec3 a) { return tl_v(-a.x, -a.y, -a.z); }
static inline talus_vec3 tl_scale(talus_vec3 a, float s) { return tl_v(a.x * s, a.y * s, a.z * s); }
/* a + s b */
static inline talus_vec3 tl_mad(talus_vec3 a, float s, talus_vec3 b) {
    return tl_v(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline talus_vec3 tl_mul(talus_vec3 a, talus_vec3 b) { return tl_v(a.x * b.x, a.y * b.y, a.z * b.z); }
static inline float tl_dot(talus_vec3 a, talus_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline talus_vec3 tl_cross(talus_vec3 a, talus_vec3 b) {
    return tl_v(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline float tl_length2(talus_vec3 a) { return tl_dot(a, a); }
static inline float tl_length(talus_vec3 a) { return sqrtf(tl_dot(a, a)); }
static inline talus_vec3 tl_abs3(talus_vec3 a) { return tl_v(tl_abs(a.x), tl_abs(a.y), tl_abs(a.z)); }
static inline talus_vec3 tl_min3(talus_vec3 a, talus_vec3 b) {
    return tl_v(tl_min(a.x, b.x), tl_min(a.y, b.y), tl_min(a.z, b.z));
}
static inline talus_vec3 tl_max3(talus_vec3 a, talus_vec3 b) {
    return tl_v(tl_max(a.x, b.x), tl_max(a.y, b.y), tl_max(a.z, b.z));
}
static inline int tl_is_finite3(talus_vec3 a) { return tl_is_finite(a.x) && tl_is_finite(a.y) && tl_is_finite(a.z); }
/* The unit vector along a, or `otherwise` where a is too short to have a direction. */
static inline talus_vec3 tl_normalize_or(talus_vec3 a, talus_vec3 otherwise) {
    float s = tl_max(tl_max(tl_abs(a.x), tl_abs(a.y)), tl_abs(a.z));
    if (!(s > 1e-30f && s < 3e38f)) {
        return otherwise;
    }
    a = tl_v(a.x / s, a.y / s, a.z / s);
    float l = tl_length(a);
    return tl_v(a.x / l, a.y / l, a.z / l);
}
/* Some unit vector across the unit vector n: the same one for the same n. */
static inline talus_vec3 tl_perpendicular(talus_vec3 n) {
    talus_vec3 t = tl_abs(n.x) < 0.57735f ? tl_v(0.0f, n.z, -n.y) : tl_v(-n.z, 0.0f, n.x);
    if (tl_abs(n.x) >= 0.57735f && tl_abs(n.y) < 0.1f * tl_abs(n.x) && tl_abs(n.z) < 0.1f * tl_abs(n.x)) {
        t = tl_v(-n.y, n.x, 0.0f);
    }
    return tl_normalize_or(t, tl_v(1.0f, 0.0f, 0.0f));
}

static inline talus_quat tl_quat_identity(void) {
    talus_quat q = {0.0f, 0.0f, 0.0f, 1.0f};
    return q;
}
static inline talus_quat tl_quat_conjugate(talus_quat q) {
    talus_quat r = {-q.x, -q.y, -q.z, q.w};
    return r;
}
/* The rotation b followed by a. */
static inline talus_quat tl_quat_mul(talus_quat a, talus_quat b) {
    talus_quat r = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                    a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return r;
}
static inline float tl_quat_dot(talus_quat a, talus_quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
/* The unit quaternion along q, or the identity where q is too short. */
static inline talus_quat tl_quat_normalize(talus_quat q) {
    float s = tl_max(tl_max(tl_abs(q.x), tl_abs(q.y)), tl_max(tl_abs(q.z), tl_abs(q.w)));
    if (!(s > 1e-30f && s < 3e38f)) {
        return tl_quat_identity();
    }
    q.x /= s, q.y /= s, q.z /= s, q.w /= s;
    float l = sqrtf(tl_quat_dot(q, q));
    q.x /= l, q.y /= l, q.z /= l, q.w /= l;
    return q;
}
static inline talus_vec3 tl_rotate(talus_quat q, talus_vec3 v) {
    talus_vec3 u = tl_v(q.x, q.y, q.z);
    talus_vec3 t = tl_cross(u, v);
    t = tl_add(t, t);
    return tl_add(tl_mad(v, q.w, t), tl_cross(u, t));
}
static inline talus_vec3 tl_rotate_back(talus_quat q, talus_vec3 v) { return tl_rotate(tl_quat_conjugate(q), v); }
static inline int tl_is_finite_quat(talus_quat q) {
    return tl_is_finite(q.x) && tl_is_finite(q.y) && tl_is_finite(q.z) && tl_is_finite(q.w);
}

static inline talus_pose tl_pose_identity(void) {
    talus_pose p = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    return p;
}
static inline talus_vec3 tl_pose_point(const talus_pose *a, talus_vec3 p) {
    return tl_add(tl_rotate(a->rotation, p), a->position);
}
static inline talus_vec3 tl_pose_point_back(const talus_pose *a, talus_vec3 p) {
    return tl_rotate_back(a->rotation, tl_sub(p, a->position));
}
/* The pose b of a's frame, seen from outside of a. */
static inline talus_pose tl_pose_mul(const talus_pose *a, const talus_pose *b) {
    talus_pose r = {tl_pose_point(a, b->position), tl_quat_mul(a->rotation, b->rotation)};
    return r;
}
/* The pose of b seen from a, where both are seen from one frame. */
static inline talus_pose tl_pose_relative(const talus_pose *a, const talus_pose *b) {
    talus_pose r = {tl_pose_point_back(a, b->position), tl_quat_mul(tl_quat_conjugate(a->rotation), b->rotation)};
    return r;
}
static inline int tl_is_finite_pose(const talus_pose *p) {
    return tl_is_finite3(p->position) && tl_is_finite_quat(p->rotation);
}

static inline talus_mat3 tl_mat3_from_quat(talus_quat q) {
    float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    float xx = q.x * x2, xy = q.x * y2, xz = q.x * z2, yy = q.y * y2, yz = q.y * z2, zz = q.z * z2;
    float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
    talus_mat3 m = {{1.0f - (yy + zz), xy + wz, xz - wy},
                    {xy - wz, 1.0f - (xx + zz), yz + wx},
                    {xz + wy, yz - wx, 1.0f - (xx + yy)}};
    return m;
}
static inline talus_vec3 tl_mat3_mul(const talus_mat3 *m, talus_vec3 v) {
    return tl_v(m->x.x * v.x + m->y.x * v.y + m->z.x * v.z, m->x.y * v.x + m->y.y * v.y + m->z.y * v.z,
                m->x.z * v.x + m->y.z * v.y + m->z.z * v.z);
}
/* The transpose of m times v. */
static inline talus_vec3 tl_mat3_mul_t(const talus_mat3 *m, talus_vec3 v) {
    return tl_v(tl_dot(m->x, v), tl_dot(m->y, v), tl_dot(m->z, v));
}
static inline talus_mat3 tl_mat3_transpose(const talus_mat3 *m) {
    talus_mat3 r = {{m->x.x, m->y.x, m->z.x}, {m->x.y, m->y.y, m->z.y}, {m->x.z, m->y.z, m->z.z}};
    return r;
}
static inline talus_mat3 tl_mat3_mat(const talus_mat3 *a, const talus_mat3 *b) {
    talus_mat3 r = {tl_mat3_mul(a, b->x), tl_mat3_mul(a, b->y), tl_mat3_mul(a, b->z)};
    return r;
}
static inline int tl_is_finite_mat3(const talus_mat3 *m) {
    return tl_is_finite3(m->x) && tl_is_finite3(m->y) && tl_is_finite3(m->z);
}

#endif
