/* Vectors and rotations of double: loading is done in these, and rounded to float once. */
#ifndef TALUS_GLTF_TRANSFORM_H
#define TALUS_GLTF_TRANSFORM_H

#include "talus/types.h"

#include <math.h>

typedef struct gltf_double3 {
    double x, y, z;
} gltf_double3;

typedef struct gltf_double4 {
    double x, y, z, w;
} gltf_double4;

/* By columns. */
typedef struct gltf_double9 {
    gltf_double3 x, y, z;
} gltf_double9;

static inline gltf_double3 gltf_d3(double x, double y, double z) {
    gltf_double3 v = {x, y, z};
    return v;
}
static inline gltf_double3 gltf_add3(gltf_double3 a, gltf_double3 b) {
    return gltf_d3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline gltf_double3 gltf_sub3(gltf_double3 a, gltf_double3 b) {
    return gltf_d3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline gltf_double3 gltf_scale3(gltf_double3 a, double s) { return gltf_d3(a.x * s, a.y * s, a.z * s); }
static inline gltf_double3 gltf_mul3(gltf_double3 a, gltf_double3 b) {
    return gltf_d3(a.x * b.x, a.y * b.y, a.z * b.z);
}
static inline double gltf_dot3(gltf_double3 a, gltf_double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline gltf_double3 gltf_cross3(gltf_double3 a, gltf_double3 b) {
    return gltf_d3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double gltf_length3(gltf_double3 a) { return sqrt(gltf_dot3(a, a)); }

static inline gltf_double3 gltf_mul93(const gltf_double9 *m, gltf_double3 v) {
    return gltf_add3(gltf_add3(gltf_scale3(m->x, v.x), gltf_scale3(m->y, v.y)), gltf_scale3(m->z, v.z));
}
static inline gltf_double9 gltf_mul99(const gltf_double9 *a, const gltf_double9 *b) {
    gltf_double9 m = {gltf_mul93(a, b->x), gltf_mul93(a, b->y), gltf_mul93(a, b->z)};
    return m;
}

static inline gltf_double4 gltf_unit4(gltf_double4 q) {
    double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    gltf_double4 r = {q.x / length, q.y / length, q.z / length, q.w / length};
    return r;
}
static inline gltf_double4 gltf_conjugate(gltf_double4 q) {
    gltf_double4 r = {-q.x, -q.y, -q.z, q.w};
    return r;
}
/* The rotation b followed by a. */
static inline gltf_double4 gltf_mul4(gltf_double4 a, gltf_double4 b) {
    gltf_double4 r = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return r;
}
static inline gltf_double3 gltf_rotate(gltf_double4 q, gltf_double3 v) {
    gltf_double3 u = gltf_d3(q.x, q.y, q.z);
    gltf_double3 t = gltf_scale3(gltf_cross3(u, v), 2.0);
    return gltf_add3(gltf_add3(v, gltf_scale3(t, q.w)), gltf_cross3(u, t));
}
static inline gltf_double9 gltf_rotation_scale(gltf_double4 q, gltf_double3 scale) {
    gltf_double9 m = {gltf_rotate(q, gltf_d3(scale.x, 0, 0)), gltf_rotate(q, gltf_d3(0, scale.y, 0)),
                      gltf_rotate(q, gltf_d3(0, 0, scale.z))};
    return m;
}
/* The rotation whose matrix has these columns, which are orthonormal and right-handed (Shepperd 1978). */
static inline gltf_double4 gltf_from_columns(const gltf_double9 *m) {
    double trace = m->x.x + m->y.y + m->z.z;
    gltf_double4 q;
    if (trace >= m->x.x && trace >= m->y.y && trace >= m->z.z) {
        gltf_double4 r = {m->y.z - m->z.y, m->z.x - m->x.z, m->x.y - m->y.x, 1 + trace};
        q = r;
    } else if (m->x.x >= m->y.y && m->x.x >= m->z.z) {
        gltf_double4 r = {1 + m->x.x - m->y.y - m->z.z, m->x.y + m->y.x, m->x.z + m->z.x, m->y.z - m->z.y};
        q = r;
    } else if (m->y.y >= m->z.z) {
        gltf_double4 r = {m->x.y + m->y.x, 1 + m->y.y - m->x.x - m->z.z, m->y.z + m->z.y, m->z.x - m->x.z};
        q = r;
    } else {
        gltf_double4 r = {m->x.z + m->z.x, m->y.z + m->z.y, 1 + m->z.z - m->x.x - m->y.y, m->x.y - m->y.x};
        q = r;
    }
    return gltf_unit4(q);
}

/* To float: of numbers that were checked to fit. */
static inline talus_vec3 gltf_vec3(gltf_double3 v) {
    talus_vec3 r = {(float)v.x, (float)v.y, (float)v.z};
    return r;
}
static inline talus_quat gltf_quat(gltf_double4 q) {
    talus_quat r = {(float)q.x, (float)q.y, (float)q.z, (float)q.w};
    return r;
}

/* Of float: a rotation is made unit anew. */
static inline gltf_double3 gltf_of_vec3(talus_vec3 v) { return gltf_d3((double)v.x, (double)v.y, (double)v.z); }
static inline gltf_double4 gltf_of_quat(talus_quat q) {
    gltf_double4 r = {(double)q.x, (double)q.y, (double)q.z, (double)q.w};
    return gltf_unit4(r);
}

#endif
