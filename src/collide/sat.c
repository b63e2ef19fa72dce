/* Separating axes of polyhedra: face normals, and cross products of those edges whose arcs cross on the Gauss maps of A
 * and -B (Gregorius, The Separating Axis Test Between Convex Polyhedra, GDC 2013). What cannot win is left out by a
 * bound: along a normal n of A the separation is at most n.(c - p) - r, with p on A's face or edge and r the radius of
 * a ball around c inside of B; with a good axis known before, few faces and edges remain. Metres. */
#include "collide/sat.h"

#include "collide/gjk.h"

#include <string.h>

/* A box as half-edges: faces are 2 axis + positive, corners as in support.h. */
static const tl_half_edge box_edges[24] = {{18, 0, 2, 0}, {8, 1, 4, 0},  {11, 2, 4, 0}, {20, 3, 3, 0}, {14, 4, 5, 0},
                                           {17, 5, 2, 0}, {23, 6, 3, 0}, {13, 7, 5, 0}, {2, 0, 4, 0},  {16, 2, 0, 0},
                                           {22, 1, 1, 0}, {1, 3, 4, 0},  {21, 4, 0, 0}, {4, 6, 5, 0},  {7, 5, 5, 0},
                                           {19, 7, 1, 0}, {12, 0, 0, 0}, {0, 4, 2, 0},  {5, 1, 2, 0},  {10, 5, 1, 0},
                                           {6, 2, 3, 0},  {9, 6, 0, 0},  {15, 3, 1, 0}, {3, 7, 3, 0}};

static void box_poly(const tl_core *core, tl_poly *poly) {
    static const float sign[3][8] = {{-1, 1, 0, 0, 0, 0, 0, 0}, {0, 0, -1, 1, 0, 0, 0, 0}, {0, 0, 0, 0, -1, 1, 1, 1}};
    talus_vec3 h = core->half;
    float *s = poly->store;
    poly->nx = sign[0];
    poly->ny = sign[1];
    poly->nz = sign[2];
    s[0] = s[1] = h.x;
    s[2] = s[3] = h.y;
    s[4] = s[5] = s[6] = s[7] = h.z;
    for (uint32_t i = 0; i < 8; ++i) {
        talus_vec3 p = tl_box_corner(h, i);
        s[8 + i] = p.x;
        s[16 + i] = p.y;
        s[24 + i] = p.z;
    }
    poly->d = s;
    poly->x = s + 8;
    poly->y = s + 16;
    poly->z = s + 24;
    poly->face_count = 6;
    poly->face_stride = 8;
    poly->edges = box_edges;
    poly->half_edge_count = 24;
    poly->center = tl_v(0.0f, 0.0f, 0.0f);
    poly->inner = tl_min(h.x, tl_min(h.y, h.z));
}

int tl_poly_init(const tl_core *core, tl_poly *poly) {
    poly->core = core;
    if (core->kind == TL_CORE_BOX) {
        box_poly(core, poly);
        return 1;
    }
    const talus_hull *hull = core->hull;
    if (core->kind != TL_CORE_HULL || hull->face_count > TL_SAT_FACES || hull->half_edge_count > 2u * TL_SAT_EDGES) {
        return 0;
    }
    poly->nx = tl_hull_planes(hull);
    poly->ny = poly->nx + hull->face_stride;
    poly->nz = poly->ny + hull->face_stride;
    poly->d = poly->nz + hull->face_stride;
    poly->x = tl_hull_x(hull);
    poly->y = tl_hull_y(hull);
    poly->z = tl_hull_z(hull);
    poly->face_count = hull->face_count;
    poly->face_stride = hull->face_stride;
    poly->edges = tl_hull_edges(hull);
    poly->half_edge_count = hull->half_edge_count;
    poly->center = hull->centroid;
    poly->inner = hull->inner_radius;
    return 1;
}

/* Q's placing in P's frame. */
typedef struct relative {
    talus_mat3 r;
    talus_vec3 t;
} relative;

static void query_faces(const tl_poly *p, const tl_poly *q, const relative *at, tl_axis_kind kind, float enough,
                        float bias, float least, tl_axis *best, float *g) {
    talus_vec3 c = tl_add(tl_mat3_mul(&at->r, q->center), at->t);
    uint32_t stride = p->face_stride;
    for (uint32_t i = 0; i < stride; ++i) {
        g[i] = p->nx[i] * c.x + p->ny[i] * c.y + p->nz[i] * c.z - p->d[i];
    }
    uint32_t vertex = 0;
    for (uint32_t i = 0; i < p->face_count; ++i) {
        float bar = best->kind == TL_AXIS_NONE ? least : best->separation;
        bar += kind == best->kind ? 0.0f : bias;
        if (!(g[i] - q->inner > bar)) {
            continue;
        }
        talus_vec3 n = tl_v(p->nx[i], p->ny[i], p->nz[i]);
        talus_vec3 d = tl_mat3_mul_t(&at->r, tl_neg(n));
        talus_vec3 v = tl_core_support_local(q->core, d, &vertex);
        float s = (tl_dot(n, at->t) - p->d[i]) - tl_dot(d, v);
        if (s > bar) {
            best->kind = kind;
            best->separation = s;
            best->normal = n;
            best->a = i;
            if (s > enough) {
                return;
            }
        }
    }
}

void tl_sat_faces(const tl_poly *a, const tl_poly *b, float least, float enough, float bias, tl_axis *best, float *g_a,
                  float *g_b) {
    relative at;
    at.r = b->core->r;
    at.t = b->core->t;
    best->kind = TL_AXIS_NONE;
    best->separation = least;
    best->a = best->b = 0;
    query_faces(a, b, &at, TL_AXIS_FACE_A, enough, -bias, least, best, g_a);
    if (best->kind == TL_AXIS_FACE_A && best->separation > enough) {
        return;
    }
    at.t = tl_neg(tl_mat3_mul_t(&b->core->r, b->core->t));
    at.r = tl_mat3_transpose(&b->core->r);
    query_faces(b, a, &at, TL_AXIS_FACE_B, enough, bias, least, best, g_b);
    if (best->kind == TL_AXIS_FACE_B) {
        best->b = best->a;
        best->a = 0;
        best->normal = tl_neg(tl_mat3_mul(&b->core->r, best->normal));
    }
}

/* Edges that may carry the axis, in A's frame: the normals beside each, its direction and its start. */
typedef struct edge_list {
    uint32_t count;
    uint16_t edge[TL_SAT_EDGES];
    float n1x[TL_SAT_EDGES], n1y[TL_SAT_EDGES], n1z[TL_SAT_EDGES];
    float n2x[TL_SAT_EDGES], n2y[TL_SAT_EDGES], n2z[TL_SAT_EDGES];
    float ex[TL_SAT_EDGES], ey[TL_SAT_EDGES], ez[TL_SAT_EDGES];
} edge_list;

static inline talus_vec3 poly_point(const tl_poly *p, uint32_t i) { return tl_v(p->x[i], p->y[i], p->z[i]); }
static inline talus_vec3 poly_normal(const tl_poly *p, uint32_t i) { return tl_v(p->nx[i], p->ny[i], p->nz[i]); }

/* Whether some normal of the edge's arc has the other's centre further than `bar` in front of the edge; c is that
 * centre. */
static int edge_reaches(const tl_poly *p, const tl_half_edge *e, talus_vec3 from, talus_vec3 along, talus_vec3 c,
                        float bar) {
    talus_vec3 n1 = poly_normal(p, e[0].face), n2 = poly_normal(p, e[1].face), w = tl_sub(c, from);
    if (tl_dot(tl_cross(along, n1), w) < 0.0f || tl_dot(tl_cross(n2, along), w) < 0.0f) {
        return 0;
    }
    float t = tl_dot(w, along);
    /* a little room for rounding: leaving out too few is no error */
    return tl_length2(w) - t * t / tl_length2(along) >= bar * bar * 0.9999f;
}

static void list_edges(const tl_poly *p, talus_vec3 c, float bar, const float *g, edge_list *out) {
    uint32_t count = 0;
    float front = bar >= 0.0f ? 0.0f : bar;
    for (uint32_t i = 0; i < p->half_edge_count; i += 2u) {
        const tl_half_edge *e = &p->edges[i];
        float most = tl_max(g[e[0].face], g[e[1].face]);
        if (most < front) {
            continue;
        }
        talus_vec3 from = poly_point(p, e[0].origin), along = tl_sub(poly_point(p, e[1].origin), from);
        if (most < bar && !edge_reaches(p, e, from, along, c, bar)) {
            continue;
        }
        out->edge[count] = (uint16_t)(i >> 1);
        out->n1x[count] = p->nx[e[0].face];
        out->n1y[count] = p->ny[e[0].face];
        out->n1z[count] = p->nz[e[0].face];
        out->n2x[count] = p->nx[e[1].face];
        out->n2y[count] = p->ny[e[1].face];
        out->n2z[count] = p->nz[e[1].face];
        out->ex[count] = along.x;
        out->ey[count] = along.y;
        out->ez[count] = along.z;
        ++count;
    }
    out->count = count;
}

static void rotate_list(const talus_mat3 *r, float *x, float *y, float *z, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
        float vx = x[i], vy = y[i], vz = z[i];
        x[i] = r->x.x * vx + r->y.x * vy + r->z.x * vz;
        y[i] = r->x.y * vx + r->y.y * vy + r->z.y * vz;
        z[i] = r->x.z * vx + r->y.z * vy + r->z.z * vz;
    }
}

/* The unit normal across two edges; all but parallel ones need the digits of double. 0 if they are parallel. */
static int across(talus_vec3 ea, talus_vec3 eb, const talus_mat3 *r, talus_vec3 *n) {
    double ax = (double)ea.x, ay = (double)ea.y, az = (double)ea.z, lx = (double)eb.x, ly = (double)eb.y,
           lz = (double)eb.z;
    double bx = (double)r->x.x * lx + (double)r->y.x * ly + (double)r->z.x * lz;
    double by = (double)r->x.y * lx + (double)r->y.y * ly + (double)r->z.y * lz;
    double bz = (double)r->x.z * lx + (double)r->y.z * ly + (double)r->z.z * lz;
    double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
    double aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
    if (!(cc > 1e-10 * aa * bb)) {
        return 0;
    }
    double s = 1.0 / ((double)sqrtf((float)aa) * (double)sqrtf((float)bb));
    *n = tl_normalize_or(tl_v((float)(cx * s), (float)(cy * s), (float)(cz * s)), tl_v(0.0f, 1.0f, 0.0f));
    return 1;
}

static void try_pair(const tl_poly *a, const tl_poly *b, uint32_t ea, uint32_t eb, talus_vec3 n1, float bias,
                     tl_axis *best) {
    const tl_half_edge *ha = &a->edges[2u * ea], *hb = &b->edges[2u * eb];
    talus_vec3 pa = poly_point(a, ha[0].origin), pb = poly_point(b, hb[0].origin), n;
    talus_vec3 da = tl_sub(poly_point(a, ha[1].origin), pa), db = tl_sub(poly_point(b, hb[1].origin), pb);
    if (!across(da, db, &b->core->r, &n)) {
        return;
    }
    n = tl_dot(n, n1) < 0.0f ? tl_neg(n) : n;
    float s = tl_dot(n, tl_sub(tl_core_place(b->core, pb), pa));
    float bar = best->kind == TL_AXIS_EDGES ? best->separation : best->separation + bias;
    if (!(s > bar)) {
        return;
    }
    /* the arcs may have seemed to cross by rounding alone */
    uint32_t ia = ha[0].origin, ib = hb[0].origin;
    talus_vec3 va, vb;
    s = tl_min(s, tl_core_separation(a->core, b->core, n, &ia, &ib, &va, &vb));
    if (s > bar) {
        best->kind = TL_AXIS_EDGES;
        best->a = ea;
        best->b = eb;
        best->normal = n;
        best->separation = s;
    }
}

void tl_sat_edges(const tl_poly *a, const tl_poly *b, float enough, float bias, const float *g_a, const float *g_b,
                  float least, tl_axis *best) {
    edge_list la, lb;
    int32_t hit[TL_SAT_EDGES];
    float bar = tl_max(best->kind == TL_AXIS_NONE ? least : best->separation, least);
    talus_vec3 cb = tl_core_place(b->core, b->center);
    list_edges(a, cb, b->inner + bar, g_a, &la);
    if (la.count == 0) {
        return;
    }
    talus_vec3 ca = tl_mat3_mul_t(&b->core->r, tl_sub(a->center, b->core->t));
    list_edges(b, ca, a->inner + bar, g_b, &lb);
    const talus_mat3 *r = &b->core->r;
    rotate_list(r, lb.n1x, lb.n1y, lb.n1z, lb.count);
    rotate_list(r, lb.n2x, lb.n2y, lb.n2z, lb.count);
    rotate_list(r, lb.ex, lb.ey, lb.ez, lb.count);
    for (uint32_t i = 0; i < la.count; ++i) {
        float ex = la.ex[i], ey = la.ey[i], ez = la.ez[i], n1x = la.n1x[i], n1y = la.n1y[i], n1z = la.n1z[i];
        float n2x = la.n2x[i], n2y = la.n2y[i], n2z = la.n2z[i];
        for (uint32_t j = 0; j < lb.count; ++j) {
            float b1 = lb.n1x[j] * ex + lb.n1y[j] * ey + lb.n1z[j] * ez;
            float b2 = lb.n2x[j] * ex + lb.n2y[j] * ey + lb.n2z[j] * ez;
            float a1 = n1x * lb.ex[j] + n1y * lb.ey[j] + n1z * lb.ez[j];
            float a2 = n2x * lb.ex[j] + n2y * lb.ey[j] + n2z * lb.ez[j];
            hit[j] = (b1 * b2 < 0.0f) & (a1 * a2 < 0.0f) & (b1 * a2 < 0.0f);
        }
        for (uint32_t j = 0; j < lb.count; ++j) {
            if (hit[j]) {
                try_pair(a, b, la.edge[i], lb.edge[j], tl_v(n1x + n2x, n1y + n2y, n1z + n2z), bias, best);
                if (best->kind == TL_AXIS_EDGES && best->separation > enough) {
                    return;
                }
            }
        }
    }
}
