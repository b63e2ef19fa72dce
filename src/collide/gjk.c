/* Distance of convex cores: Gilbert, Johnson & Keerthi 1988, with the signed-volumes distance step of Montanari,
 * Petrinic & Barbieri, Improving the GJK Algorithm for Faster and More Reliable Distance Queries Between Convex
 * Objects, 2017. The step is done in double: the vertices of a large shape near a small gap leave nothing of a float.
 * Metres. */
#include "collide/gjk.h"

#include <string.h>

#define MAX_ITERATIONS 64

typedef struct vec {
    double x, y, z;
} vec;

static inline vec vec_sub(vec a, vec b) {
    vec r = {a.x - b.x, a.y - b.y, a.z - b.z};
    return r;
}
static inline double vec_dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec vec_cross(vec a, vec b) {
    vec r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

/* The working simplex: its points as differences, the simplex as the caller sees it, and which of the points support
 * the closest point of the hull, with what weights. */
typedef struct work {
    vec y[4];
    double l[4];
    uint32_t mask;
} work;

static vec combine(const work *w) {
    vec v = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < 4; ++i) {
        if (w->mask & (1u << i)) {
            v.x += w->l[i] * w->y[i].x;
            v.y += w->l[i] * w->y[i].y;
            v.z += w->l[i] * w->y[i].z;
        }
    }
    return v;
}

/* S1D: the point of the segment ij next to the origin. */
static void segment_step(work *w, uint32_t i, uint32_t j) {
    vec d = vec_sub(w->y[j], w->y[i]);
    double dd = vec_dot(d, d), t = -vec_dot(w->y[i], d);
    if (!(t > 0.0) || !(dd > 0.0)) {
        w->mask = 1u << i;
        w->l[i] = 1.0;
    } else if (t >= dd) {
        w->mask = 1u << j;
        w->l[j] = 1.0;
    } else {
        w->mask = 1u << i | 1u << j;
        w->l[j] = t / dd;
        w->l[i] = 1.0 - w->l[j];
    }
}

static void keep_better(work *best, double *best2, const work *w) {
    vec v = combine(w);
    double d2 = vec_dot(v, v);
    if (d2 < *best2) {
        *best2 = d2;
        best->mask = w->mask;
        memcpy(best->l, w->l, sizeof w->l);
    }
}

/* S2D: the point of the triangle ijk next to the origin. */
static void triangle_step(work *w, uint32_t i, uint32_t j, uint32_t k) {
    vec a = w->y[i], b = w->y[j], c = w->y[k];
    vec n = vec_cross(vec_sub(b, a), vec_sub(c, a));
    double nn = vec_dot(n, n);
    /* weights are areas seen along n: det(p, b, c) and its turns with p the foot of the origin's normal reduce to */
    double la = vec_dot(vec_cross(b, c), n), lb = vec_dot(vec_cross(c, a), n), lc = vec_dot(vec_cross(a, b), n);
    if (nn > 0.0 && la > 0.0 && lb > 0.0 && lc > 0.0) {
        double s = la + lb + lc;
        w->mask = 1u << i | 1u << j | 1u << k;
        w->l[i] = la / s;
        w->l[j] = lb / s;
        w->l[k] = lc / s;
        return;
    }
    work best = *w;
    double best2 = 1e300;
    if (!(la > 0.0) || !(nn > 0.0)) {
        segment_step(w, j, k);
        keep_better(&best, &best2, w);
    }
    if (!(lb > 0.0) || !(nn > 0.0)) {
        segment_step(w, i, k);
        keep_better(&best, &best2, w);
    }
    if (!(lc > 0.0) || !(nn > 0.0)) {
        segment_step(w, i, j);
        keep_better(&best, &best2, w);
    }
    w->mask = best.mask;
    memcpy(w->l, best.l, sizeof w->l);
}

/* S3D: the point of the tetrahedron next to the origin. */
static void tetrahedron_step(work *w) {
    vec a = w->y[0], b = w->y[1], c = w->y[2], d = w->y[3];
    vec bc = vec_cross(b, c), ad = vec_cross(a, d);
    double la = -vec_dot(bc, d), lb = vec_dot(vec_cross(a, c), d);
    double lc = vec_dot(ad, b), ld = vec_dot(bc, a);
    double s = la + lb + lc + ld; /* six times the volume, with its sign */
    double flip = s < 0.0 ? -1.0 : 1.0;
    la *= flip, lb *= flip, lc *= flip, ld *= flip;
    s *= flip;
    if (s > 0.0 && la > 0.0 && lb > 0.0 && lc > 0.0 && ld > 0.0) {
        w->mask = 15u;
        w->l[0] = la / s;
        w->l[1] = lb / s;
        w->l[2] = lc / s;
        w->l[3] = ld / s;
        return;
    }
    work best = *w;
    double best2 = 1e300;
    int flat = !(s > 0.0);
    if (flat || !(la > 0.0)) {
        triangle_step(w, 1, 2, 3);
        keep_better(&best, &best2, w);
    }
    if (flat || !(lb > 0.0)) {
        triangle_step(w, 0, 2, 3);
        keep_better(&best, &best2, w);
    }
    if (flat || !(lc > 0.0)) {
        triangle_step(w, 0, 1, 3);
        keep_better(&best, &best2, w);
    }
    if (flat || !(ld > 0.0)) {
        triangle_step(w, 0, 1, 2);
        keep_better(&best, &best2, w);
    }
    w->mask = best.mask;
    memcpy(w->l, best.l, sizeof w->l);
}

/* Reduces the simplex to the part that carries the point next to the origin; that point. */
static vec reduce(tl_simplex *s) {
    work w = {{{0.0, 0.0, 0.0}}, {0.0}, 0};
    for (uint32_t i = 0; i < s->count; ++i) {
        w.y[i].x = (double)s->vertex[i].b.x - (double)s->vertex[i].a.x;
        w.y[i].y = (double)s->vertex[i].b.y - (double)s->vertex[i].a.y;
        w.y[i].z = (double)s->vertex[i].b.z - (double)s->vertex[i].a.z;
    }
    switch (s->count) {
    case 1:
        w.mask = 1;
        w.l[0] = 1.0;
        break;
    case 2:
        segment_step(&w, 0, 1);
        break;
    case 3:
        triangle_step(&w, 0, 1, 2);
        break;
    default:
        tetrahedron_step(&w);
        break;
    }
    vec v = combine(&w);
    uint32_t n = 0;
    for (uint32_t i = 0; i < 4; ++i) {
        if (w.mask & (1u << i)) {
            s->vertex[n] = s->vertex[i];
            s->weight[n] = w.l[i];
            ++n;
        }
    }
    s->count = n;
    return v;
}

/* The root of x, by one step of Newton in double from the float root; 0 for what a float cannot show. */
static double root(double x) {
    if (!(x > 1e-36)) {
        return 0.0;
    }
    double r = (double)sqrtf((float)x);
    return 0.5 * (r + x / r);
}

static talus_vec3 to_direction(vec v, double length) {
    double s = 1.0 / length;
    return tl_v((float)(v.x * s), (float)(v.y * s), (float)(v.z * s));
}

static int known(const tl_simplex *s, const tl_simplex_vertex *w) {
    for (uint32_t i = 0; i < s->count; ++i) {
        if (memcmp(&s->vertex[i].a, &w->a, sizeof w->a) == 0 && memcmp(&s->vertex[i].b, &w->b, sizeof w->b) == 0) {
            return 1;
        }
    }
    return 0;
}

static void witness(const tl_simplex *s, talus_vec3 *pa, talus_vec3 *pb) {
    double a[3] = {0.0, 0.0, 0.0}, b[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < s->count; ++i) {
        double l = s->weight[i];
        const tl_simplex_vertex *v = &s->vertex[i];
        a[0] += l * (double)v->a.x, a[1] += l * (double)v->a.y, a[2] += l * (double)v->a.z;
        b[0] += l * (double)v->b.x, b[1] += l * (double)v->b.y, b[2] += l * (double)v->b.z;
    }
    *pa = tl_v((float)a[0], (float)a[1], (float)a[2]);
    *pb = tl_v((float)b[0], (float)b[1], (float)b[2]);
}

tl_gjk_state tl_gjk_run(const tl_core *a, const tl_core *b, talus_vec3 guess, float limit, tl_simplex *s, tl_gjk *out) {
    tl_simplex_vertex w;
    w.ia = s->count > 0 ? s->vertex[0].ia : 0u;
    w.ib = s->count > 0 ? s->vertex[0].ib : 0u;
    if (s->count == 0) {
        guess = tl_normalize_or(guess, tl_v(0.0f, 1.0f, 0.0f));
        float apart = tl_core_separation(a, b, guess, &w.ia, &w.ib, &w.a, &w.b);
        if (apart > limit) {
            out->distance = apart;
            out->normal = guess;
            return TL_GJK_BEYOND;
        }
        s->vertex[0] = w;
        s->count = 1;
    }
    /* what rounding leaves of a support point, and so of a distance */
    double noise = 2.4e-7 * (double)(a->size + b->size);
    /* round cores never give the same point again: there the normal is good to a thousandth */
    double enough = a->top + a->bottom + b->top + b->bottom > 0.0f ? 1e-6 : 1e-7;
    vec v = reduce(s);
    double d2 = vec_dot(v, v), d = root(d2);
    tl_simplex kept = *s;
    for (int i = 0;; ++i) {
        if (s->count == 4 || d <= noise * 0.5) {
            witness(s, &out->point_a, &out->point_b);
            out->distance = 0.0f;
            return TL_GJK_OVERLAP;
        }
        out->normal = to_direction(v, d);
        if (i == MAX_ITERATIONS) {
            break;
        }
        float apart = tl_core_separation(a, b, out->normal, &w.ia, &w.ib, &w.a, &w.b);
        if (apart > limit) {
            out->distance = apart;
            return TL_GJK_BEYOND;
        }
        vec p = {(double)w.b.x - (double)w.a.x, (double)w.b.y - (double)w.a.y, (double)w.b.z - (double)w.a.z};
        double gain = d2 - vec_dot(v, p);
        if (gain <= enough * d2 || gain <= 0.25 * noise * d || known(s, &w)) {
            break;
        }
        kept = *s;
        s->vertex[s->count++] = w;
        vec next = reduce(s);
        double next2 = vec_dot(next, next);
        if (!(next2 < d2)) {
            *s = kept;
            break;
        }
        v = next;
        d2 = next2;
        d = root(d2);
    }
    witness(s, &out->point_a, &out->point_b);
    out->distance = (float)d;
    return TL_GJK_APART;
}
