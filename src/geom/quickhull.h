/* The working state of the hull builder, shared by its files: triangles on integer points, and the facets they join to.
 *
 * Points are moved to their middle, scaled by a power of two and rounded to integers of at most 28 bits and a sign
 * ("lattice units": 2^-28 to 2^-27 of the half extent, sixteen times finer than the float of a coordinate that large).
 * Every question "is this point above that triangle" is then answered exactly in 64-bit integers, so the triangulated
 * hull is convex and a sphere without any tolerance; tolerances only choose which points are worth a vertex and which
 * triangles are shown as one face. */
#ifndef TL_QUICKHULL_H
#define TL_QUICKHULL_H

#include "geom/double3.h"
#include "geom/hull.h"

#define TL_QH_NONE 0xffffffffu
#define TL_QH_EXACT 3u

typedef struct tl_qh_triangle {
    int64_t n[3];     /* outward normal, twice the area long: exact, below 2^60 */
    tl_d3 unit;       /* the same of length 1 */
    double length;    /* of n */
    uint32_t v[3];    /* counter-clockwise seen from outside */
    uint32_t twin[3]; /* half-edge 3 t + i runs from v[i] to v[i + 1]; this is its opposite */
    uint32_t outside; /* first of the points above this triangle, linked by tl_qh.next */
    uint32_t best;    /* the highest of them */
    double best_height;
    uint32_t before, after; /* in the list of triangles that have work; `after` also links the free ones */
    uint32_t mark;          /* the epoch in which a walk last met it */
    uint32_t facet;         /* TL_QH_NONE while free or not yet part of one */
    uint32_t level;         /* how finely it is to be merged: 0 coarse to TL_QH_EXACT */
    uint32_t alive, queued;
} tl_qh_triangle;

typedef struct tl_qh_facet {
    tl_d3 normal;   /* unit; the sum of its triangles' */
    uint32_t edge;  /* a half-edge on its outline */
    uint32_t first; /* half-edge of the blob */
    uint32_t bad;   /* it is to be merged more finely */
} tl_qh_facet;

typedef struct tl_qh {
    const talus_vec3 *input;
    uint32_t count;
    tl_d3 *p;       /* lattice points, integers */
    uint32_t *next; /* links of outside lists */
    uint32_t *at;   /* of a point: a number while walking (new triangle, epoch, degree, vertex index) */
    tl_qh_triangle *t;
    uint32_t t_capacity, t_used, t_free;
    uint32_t work_first, work_last;
    uint32_t epoch;
    uint32_t *list_a, *list_b, *list_c; /* t_capacity numbers each */
    double *depth;                      /* t_capacity */
    uint64_t *keys;                     /* t_capacity, to sort by */
    uint32_t *edge_id;                  /* 3 t_capacity: half-edge of the blob by half-edge of the triangles */
    tl_qh_facet *f;                     /* t_capacity */
    tl_half_edge *edge;                 /* of the blob */
    uint32_t f_count, edge_count, vertex_count;
    double unit;      /* m in a lattice unit */
    double tolerance; /* lattice units */
    double flat;      /* lattice units: points within this of a plane span no volume */
} tl_qh;

static inline uint32_t tl_qh_next_edge(uint32_t h) { return h % 3u == 2u ? h - 2u : h + 1u; }
static inline uint32_t tl_qh_twin(const tl_qh *q, uint32_t h) { return q->t[h / 3u].twin[h % 3u]; }
static inline uint32_t tl_qh_origin(const tl_qh *q, uint32_t h) { return q->t[h / 3u].v[h % 3u]; }
static inline double tl_qh_height(const tl_qh *q, const tl_qh_triangle *t, uint32_t point) {
    return tl_d_dot(t->unit, tl_d_sub(q->p[point], q->p[t->v[0]]));
}
/* The squared distance from p to the segment a b. */
static inline double tl_qh_segment2(tl_d3 p, tl_d3 a, tl_d3 b) {
    tl_d3 ab = tl_d_sub(b, a), ap = tl_d_sub(p, a);
    double s = tl_d_dot(ap, ab), l = tl_d_dot(ab, ab);
    s = s <= 0.0 ? 0.0 : s >= l ? 1.0 : s / l;
    tl_d3 d = tl_d_sub(ap, tl_d_scale(ab, s));
    return tl_d_dot(d, d);
}
/* 1, 0 or -1: the point is above, in or below the triangle's plane. Exact. */
int tl_qh_side(const tl_qh *q, const tl_qh_triangle *t, uint32_t point);

/* Builds the exact hull of those points that stand out by more than the tolerance. False if the points are flat. */
int tl_qh_grow(tl_qh *q);
/* Parts the triangles into facets, each flat and convex to the tolerance that the level of its triangles allows. */
void tl_qh_merge(tl_qh *q);
/* Asks for a finer merge of all triangles; false if none can be finer. */
int tl_qh_refine(tl_qh *q);
/* Makes the blob's half-edges of the facets. TALUS_FLAT_HULL where the outlines do not make a polyhedron; the facets at
 * fault are then marked for the next tl_qh_merge, or none of them. */
talus_status tl_qh_outline(tl_qh *q, int *marked);
/* Brings what tl_qh_outline made of a large hull into the order that it has in memory. */
void tl_qh_order(tl_qh *q);
/* Writes the blob. */
talus_status tl_qh_write(const tl_qh *q, void *out, size_t out_size, size_t *size);

#endif
