/* What the collision tests compare with, in double and by other means: support functions, signed bounds of surfaces,
 * and the greatest separation over all directions, which is the distance of shapes apart and minus the depth of shapes
 * in overlap. Also random shapes and poses from a printed seed. Metres. */
#ifndef COLLIDE_BRUTE_H
#define COLLIDE_BRUTE_H

#include "base/vec.h"
#include "collide/collide.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct d3 {
    double x, y, z;
} d3;

static inline d3 d3_make(double x, double y, double z) {
    d3 r = {x, y, z};
    return r;
}
static inline d3 d3_of(talus_vec3 v) { return d3_make((double)v.x, (double)v.y, (double)v.z); }
static inline d3 d3_add(d3 a, d3 b) { return d3_make(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline d3 d3_sub(d3 a, d3 b) { return d3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline d3 d3_scale(d3 a, double s) { return d3_make(a.x * s, a.y * s, a.z * s); }
static inline double d3_dot(d3 a, d3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline d3 d3_cross(d3 a, d3 b) {
    return d3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double d3_length(d3 a) { return sqrt(d3_dot(a, a)); }
static inline d3 d3_unit(d3 a) {
    double l = d3_length(a);
    return l > 0.0 ? d3_scale(a, 1.0 / l) : d3_make(0.0, 1.0, 0.0);
}

typedef struct d_pose {
    d3 x, y, z, t;
} d_pose;

static inline d_pose d_pose_of(const talus_pose *p) {
    double qx = (double)p->rotation.x, qy = (double)p->rotation.y, qz = (double)p->rotation.z,
           qw = (double)p->rotation.w;
    double l = sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
    qx /= l, qy /= l, qz /= l, qw /= l;
    d_pose r;
    r.x = d3_make(1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qz * qw), 2.0 * (qx * qz - qy * qw));
    r.y = d3_make(2.0 * (qx * qy - qz * qw), 1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz + qx * qw));
    r.z = d3_make(2.0 * (qx * qz + qy * qw), 2.0 * (qy * qz - qx * qw), 1.0 - 2.0 * (qx * qx + qy * qy));
    r.t = d3_of(p->position);
    return r;
}
static inline d3 d_rotate(const d_pose *p, d3 v) {
    return d3_add(d3_add(d3_scale(p->x, v.x), d3_scale(p->y, v.y)), d3_scale(p->z, v.z));
}
static inline d3 d_rotate_back(const d_pose *p, d3 v) {
    return d3_make(d3_dot(p->x, v), d3_dot(p->y, v), d3_dot(p->z, v));
}

/* The support value: how far the shape reaches along d (its own frame). */
static inline double d_reach(const tl_convex *s, d3 d) {
    const talus_geometry *g = &s->geometry;
    double radial = sqrt(d.x * d.x + d.z * d.z), length = d3_length(d);
    double h = (double)g->half_height, rt = (double)g->radius_top, rb = (double)g->radius_bottom;
    switch (g->type) {
    case TALUS_SPHERE:
        return (double)g->radius * length;
    case TALUS_CAPSULE:
        return fmax(h * d.y + rt * length, -h * d.y + rb * length);
    case TALUS_CYLINDER:
        return fmax(h * d.y + rt * radial, -h * d.y + rb * radial);
    case TALUS_BOX:
        return (double)g->half.x * fabs(d.x) + (double)g->half.y * fabs(d.y) + (double)g->half.z * fabs(d.z);
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default: {
        double best = -1e300;
        for (uint32_t i = 0; i < s->hull->vertex_count; ++i) {
            best = fmax(best, d3_dot(d, d3_of(tl_hull_point(s->hull, i))));
        }
        return best;
    }
    }
}

/* How far a point of the shape's frame is outside of its surface: exact in and near to it for round shapes, a lower
 * bound outside of corners for boxes and hulls. */
static inline double d_outside(const tl_convex *s, d3 p) {
    const talus_geometry *g = &s->geometry;
    double h = (double)g->half_height, rt = (double)g->radius_top, rb = (double)g->radius_bottom;
    double radial = sqrt(p.x * p.x + p.z * p.z);
    switch (g->type) {
    case TALUS_SPHERE:
        return d3_length(p) - (double)g->radius;
    case TALUS_CAPSULE: {
        double best = 1e300;
        for (int i = 0; i <= 4000; ++i) {
            double t = (double)i / 4000.0, y = -h + 2.0 * h * t;
            best = fmin(best, sqrt(radial * radial + (p.y - y) * (p.y - y)) - (rb + (rt - rb) * t));
        }
        return best;
    }
    case TALUS_CYLINDER: {
        double rise = 2.0 * h, in = rb - rt, l = sqrt(rise * rise + in * in);
        return fmax(fabs(p.y) - h, ((radial - rb) * rise + (p.y + h) * in) / l);
    }
    case TALUS_BOX:
        return fmax(fabs(p.x) - (double)g->half.x, fmax(fabs(p.y) - (double)g->half.y, fabs(p.z) - (double)g->half.z));
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default: {
        double best = -1e300;
        for (uint32_t i = 0; i < s->hull->face_count; ++i) {
            best = fmax(best, d3_dot(d3_of(tl_hull_normal(s->hull, i)), p) - (double)tl_hull_offset(s->hull, i));
        }
        return best;
    }
    }
}

static inline double d_size(const tl_convex *s) {
    double r = 0.0;
    for (int i = 0; i < 6; ++i) {
        d3 d = d3_make(i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0);
        r = fmax(r, d_reach(s, i < 3 ? d : d3_scale(d, -1.0)));
    }
    return r;
}

typedef struct d_pair {
    const tl_convex *a, *b;
    d_pose pose;
} d_pair;

/* The separation along the unit vector n from a to b. */
static inline double d_separation(const d_pair *p, d3 n) {
    d3 back = d_rotate_back(&p->pose, d3_scale(n, -1.0));
    return d3_dot(n, p->pose.t) - d_reach(p->b, back) - d_reach(p->a, n);
}

static inline double d_climb(const d_pair *p, d3 *n, double step, double until) {
    double best = d_separation(p, *n);
    while (step > until) {
        d3 u = d3_unit(d3_cross(*n, fabs(n->x) < 0.6 ? d3_make(1.0, 0.0, 0.0) : d3_make(0.0, 1.0, 0.0)));
        d3 w = d3_cross(*n, u);
        d3 from = *n, to = *n;
        double start = best;
        for (int i = 0; i < 8; ++i) {
            double angle = 0.78539816339744831 * i + 37.0 * step;
            d3 m = d3_unit(d3_add(from, d3_add(d3_scale(u, step * cos(angle)), d3_scale(w, step * sin(angle)))));
            double s = d_separation(p, m);
            if (s > best) {
                best = s;
                to = m;
            }
        }
        *n = to;
        step = best > start ? step * 1.3 : step * 0.6;
    }
    return best;
}

/* The greatest separation over all directions, found from many starts. */
static inline double d_best_separation(const tl_convex *a, const tl_convex *b, const talus_pose *pose, d3 *normal) {
    d_pair p;
    p.a = a;
    p.b = b;
    p.pose = d_pose_of(pose);
    double best = -1e300;
    d3 at = d3_make(0.0, 1.0, 0.0);
    double start_value[24];
    d3 start[24];
    int starts = 0;
    for (int i = 0; i < 400; ++i) {
        /* a spiral over the sphere */
        double z = 1.0 - (2.0 * i + 1.0) / 400.0, r = sqrt(1.0 - z * z), f = 2.399963229728653 * i;
        d3 n = d3_make(r * cos(f), r * sin(f), z);
        double s = d_separation(&p, n);
        int k = starts < 24 ? starts++ : 23;
        if (k == 23 && starts == 24 && i >= 24 && s <= start_value[23]) {
            continue;
        }
        while (k > 0 && start_value[k - 1] < s) {
            start_value[k] = start_value[k - 1];
            start[k] = start[k - 1];
            --k;
        }
        start_value[k] = s;
        start[k] = n;
    }
    for (int i = 0; i < starts; ++i) {
        double s = d_climb(&p, &start[i], 0.05, 1e-3);
        if (s > best) {
            best = s;
            at = start[i];
        }
    }
    best = d_climb(&p, &at, 2e-3, 1e-9);
    if (normal != NULL) {
        *normal = at;
    }
    return best;
}

/* ---- exact by enumeration, for cores that are polyhedra, segments or points ---- */

#define D_POLY_MAX 320

typedef struct d_poly {
    int vertices, faces, edges;
    d3 vertex[D_POLY_MAX], normal[D_POLY_MAX];
    int from[D_POLY_MAX], to[D_POLY_MAX];
    double radius;
} d_poly;

/* The shape as a polyhedron and a radius, placed; 0 if it is none. */
static inline int d_poly_of(const tl_convex *s, const d_pose *pose, d_poly *p) {
    const talus_geometry *g = &s->geometry;
    memset(p, 0, sizeof *p);
    if (g->type == TALUS_SPHERE) {
        p->radius = (double)g->radius;
        p->vertices = 1;
    } else if (g->type == TALUS_CAPSULE && g->radius_top == g->radius_bottom) {
        p->radius = (double)g->radius_top;
        p->vertices = 2;
        p->vertex[0].y = -(double)g->half_height;
        p->vertex[1].y = (double)g->half_height;
        p->edges = 1;
        p->to[0] = 1;
    } else if (g->type == TALUS_BOX) {
        p->vertices = 8;
        for (int i = 0; i < 8; ++i) {
            p->vertex[i] = d3_of(tl_v((i & 1) ? g->half.x : -g->half.x, (i & 2) ? g->half.y : -g->half.y,
                                      (i & 4) ? g->half.z : -g->half.z));
            for (int b = 1; b < 8; b *= 2) {
                if (!(i & b)) {
                    p->from[p->edges] = i;
                    p->to[p->edges++] = i | b;
                }
            }
        }
        for (int i = 0; i < 6; ++i) {
            double v = i & 1 ? 1.0 : -1.0;
            p->normal[p->faces++] = d3_make(i / 2 == 0 ? v : 0.0, i / 2 == 1 ? v : 0.0, i / 2 == 2 ? v : 0.0);
        }
    } else if (g->type == TALUS_HULL) {
        const talus_hull *h = s->hull;
        const tl_half_edge *e = tl_hull_edges(h);
        if (h->vertex_count > D_POLY_MAX || h->half_edge_count > 2 * D_POLY_MAX || h->face_count > D_POLY_MAX) {
            return 0;
        }
        for (uint32_t i = 0; i < h->vertex_count; ++i) {
            p->vertex[p->vertices++] = d3_of(tl_hull_point(h, i));
        }
        for (uint32_t i = 0; i < h->face_count; ++i) {
            p->normal[p->faces++] = d3_unit(d3_of(tl_hull_normal(h, i)));
        }
        for (uint32_t i = 0; i < h->half_edge_count; i += 2) {
            p->from[p->edges] = e[i].origin;
            p->to[p->edges++] = e[i + 1].origin;
        }
    } else {
        return 0;
    }
    for (int i = 0; i < p->vertices && pose != NULL; ++i) {
        p->vertex[i] = d3_add(d_rotate(pose, p->vertex[i]), pose->t);
    }
    for (int i = 0; i < p->faces && pose != NULL; ++i) {
        p->normal[i] = d_rotate(pose, p->normal[i]);
    }
    return 1;
}

static inline void d_try(const d_poly *a, const d_poly *b, d3 n, double *best, d3 *at) {
    double l = d3_length(n);
    if (!(l > 1e-12)) {
        return;
    }
    n = d3_scale(n, 1.0 / l);
    double min_a = 1e300, max_a = -1e300, min_b = 1e300, max_b = -1e300;
    for (int i = 0; i < a->vertices; ++i) {
        double s = d3_dot(n, a->vertex[i]);
        min_a = fmin(min_a, s), max_a = fmax(max_a, s);
    }
    for (int i = 0; i < b->vertices; ++i) {
        double s = d3_dot(n, b->vertex[i]);
        min_b = fmin(min_b, s), max_b = fmax(max_b, s);
    }
    if (min_b - max_a > *best) {
        *best = min_b - max_a, *at = n;
    }
    if (min_a - max_b > *best) {
        *best = min_a - max_b, *at = d3_scale(n, -1.0);
    }
}

/* The greatest separation, over every direction that can be the one: faces, pairs of edges, and between the points
 * nearest to one another. Returns 0 for other shapes. */
static inline int d_exact_separation(const tl_convex *sa, const tl_convex *sb, const talus_pose *pose, double *best,
                                     d3 *at) {
    static d_poly a, b;
    d_pose where = d_pose_of(pose);
    if (!d_poly_of(sa, NULL, &a) || !d_poly_of(sb, &where, &b)) {
        return 0;
    }
    *best = -1e300;
    for (int i = 0; i < a.faces; ++i) {
        d_try(&a, &b, a.normal[i], best, at);
    }
    for (int i = 0; i < b.faces; ++i) {
        d_try(&a, &b, b.normal[i], best, at);
    }
    for (int i = 0; i < a.edges; ++i) {
        for (int j = 0; j < b.edges; ++j) {
            d_try(&a, &b,
                  d3_cross(d3_sub(a.vertex[a.to[i]], a.vertex[a.from[i]]),
                           d3_sub(b.vertex[b.to[j]], b.vertex[b.from[j]])),
                  best, at);
        }
    }
    if (a.faces + b.faces == 0 || *best > 0.0) {
        for (int i = 0; i < a.vertices; ++i) {
            for (int j = 0; j < b.vertices; ++j) {
                d_try(&a, &b, d3_sub(b.vertex[j], a.vertex[i]), best, at);
            }
        }
        for (int turn = 0; turn < 2; ++turn) {
            const d_poly *p = turn ? &b : &a, *q = turn ? &a : &b;
            for (int i = 0; i < p->vertices; ++i) {
                for (int j = 0; j < q->edges; ++j) {
                    d3 e = d3_unit(d3_sub(q->vertex[q->to[j]], q->vertex[q->from[j]]));
                    d3 w = d3_sub(p->vertex[i], q->vertex[q->from[j]]);
                    d_try(&a, &b, d3_sub(w, d3_scale(e, d3_dot(w, e))), best, at);
                }
            }
        }
    }
    *best -= a.radius + b.radius;
    return *best > -1e299;
}

/* ---- random things ---- */

static uint64_t brute_state = 1;

static inline uint32_t brute_u32(void) {
    /* splitmix64 */
    uint64_t z = (brute_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ (z >> 31)) >> 32);
}
static inline float brute_range(float low, float high) {
    return low + (high - low) * ((float)(brute_u32() >> 8) / 16777216.0f);
}
/* Arguments of one call may be worked out in any order, so that each draw has a statement of its own. */
static inline talus_vec3 brute_vector(float low, float high) {
    float x = brute_range(low, high);
    float y = brute_range(low, high);
    float z = brute_range(low, high);
    return tl_v(x, y, z);
}
static inline talus_vec3 brute_direction(void) {
    for (;;) {
        talus_vec3 v = brute_vector(-1.0f, 1.0f);
        float l2 = tl_length2(v);
        if (l2 > 0.01f && l2 < 1.0f) {
            return tl_normalize_or(v, v);
        }
    }
}
static inline talus_quat brute_rotation(void) {
    talus_vec3 v = brute_vector(-1.0f, 1.0f);
    float w = brute_range(-1.0f, 1.0f);
    talus_quat q = {v.x, v.y, v.z, w};
    return tl_quat_normalize(q);
}
static inline talus_pose brute_pose(float near, float far) {
    talus_vec3 d = brute_direction();
    float distance = brute_range(near, far);
    talus_quat q = brute_rotation();
    talus_pose p = {tl_scale(d, distance), q};
    return p;
}

static inline void brute_seed(const char *name) {
    const char *text = getenv("TALUS_SEED");
    brute_state = text != NULL ? (uint64_t)strtoull(text, NULL, 0) : 0x7a1u;
    printf("%s: seed %llu (TALUS_SEED)\n", name, (unsigned long long)brute_state);
}

/* Hulls live as long as the program; each block begins with the address of the one before. */
static void *brute_blocks;

static inline const talus_hull *brute_hull_of(const talus_vec3 *points, uint32_t count) {
    size_t scratch_size = talus_hull_scratch_size(count), max = talus_hull_max_size(count), size = 0;
    unsigned char *scratch = malloc(scratch_size + 64u), *out = malloc(max + 128u);
    unsigned char *aligned = scratch + (64u - (uintptr_t)scratch % 64u) % 64u;
    memcpy(out, &brute_blocks, sizeof brute_blocks);
    brute_blocks = out;
    out += 128u - (uintptr_t)out % 64u;
    talus_status status = talus_hull_build(points, count, aligned, scratch_size, out, max, &size);
    free(scratch);
    if (status != TALUS_OK) {
        printf("hull of %u points: status %d\n", count, (int)status);
        abort();
    }
    return (const talus_hull *)(const void *)out;
}

/* A hull of about `count` vertices on an ellipsoid. */
static inline const talus_hull *brute_hull(uint32_t count, talus_vec3 scale) {
    talus_vec3 *points = malloc(count * sizeof *points);
    for (uint32_t i = 0; i < count; ++i) {
        points[i] = tl_mul(brute_direction(), scale);
    }
    const talus_hull *hull = brute_hull_of(points, count);
    free(points);
    return hull;
}

enum { BRUTE_SPHERE, BRUTE_CAPSULE, BRUTE_TAPERED, BRUTE_CYLINDER, BRUTE_CONE, BRUTE_BOX, BRUTE_HULL, BRUTE_KINDS };
static const char *const brute_kind_name[BRUTE_KINDS] = {"sphere", "capsule", "tapered", "cylinder",
                                                         "cone",   "box",     "hull"};

static inline tl_convex brute_shape(int kind, float low, float high) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    talus_geometry *g = &s.geometry;
    g->radius = brute_range(low, high);
    g->half_height = brute_range(low, high);
    g->radius_bottom = brute_range(low, high);
    g->radius_top = kind == BRUTE_TAPERED || kind == BRUTE_CONE ? brute_range(low, high) : g->radius_bottom;
    if (kind == BRUTE_CONE && (brute_u32() & 3u) == 0) {
        g->radius_top = 0.0f;
    }
    g->half = brute_vector(low, high);
    switch (kind) {
    case BRUTE_SPHERE:
        g->type = TALUS_SPHERE;
        break;
    case BRUTE_CAPSULE:
    case BRUTE_TAPERED:
        g->type = TALUS_CAPSULE;
        break;
    case BRUTE_CYLINDER:
    case BRUTE_CONE:
        g->type = TALUS_CYLINDER;
        break;
    case BRUTE_BOX:
        g->type = TALUS_BOX;
        break;
    default:
        g->type = TALUS_HULL;
        s.hull = brute_hull(6u + brute_u32() % 20u, g->half);
        break;
    }
    return s;
}

#endif
