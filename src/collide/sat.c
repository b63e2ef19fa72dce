/* Separating axes of polyhedra: face normals, and cross products of those edges whose arcs cross on the Gauss maps of A
 * and -B (Gregorius, The Separating Axis Test Between Convex Polyhedra, GDC 2013). What cannot win is left out by a
 * bound: along a normal n of A the separation is at most n.(c - p) - r, with p on A's face or edge and r the radius of
 * a ball around c inside of B; with a good axis known before, few faces and edges remain. Metres. */
#include "collide/sat.h"

#include "collide/gjk.h"
#include "collide/lanes.h"

#include <string.h>

/* A box as half-edges: faces are 2 axis + positive, corners as in support.h. */
static const tl_half_edge box_edges[24] = {{18, 0, 2, 0}, {8, 1, 4, 0},  {11, 2, 4, 0}, {20, 3, 3, 0}, {14, 4, 5, 0},
                                           {17, 5, 2, 0}, {23, 6, 3, 0}, {13, 7, 5, 0}, {2, 0, 4, 0},  {16, 2, 0, 0},
                                           {22, 1, 1, 0}, {1, 3, 4, 0},  {21, 4, 0, 0}, {4, 6, 5, 0},  {7, 5, 5, 0},
                                           {19, 7, 1, 0}, {12, 0, 0, 0}, {0, 4, 2, 0},  {5, 1, 2, 0},  {10, 5, 1, 0},
                                           {6, 2, 3, 0},  {9, 6, 0, 0},  {15, 3, 1, 0}, {3, 7, 3, 0}};

static const uint16_t box_face_edge[6] = {16, 10, 0, 20, 8, 4};

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

/* Q's placing in P's frame, and the known points as Q - P there. */
typedef struct relative {
    talus_mat3 r;
    talus_vec3 t;
    talus_vec3 point[TL_SAT_POINTS];
} relative;

/* Tries one face of P. */
static void try_face(tl_sat *s, const tl_poly *p, const tl_poly *q, relative *at, tl_axis_kind kind, uint32_t i,
                     uint32_t *vertex, tl_axis *best) {
    float bar = best->separation + (kind == best->kind ? 0.0f : kind == TL_AXIS_FACE_B ? s->bias : -s->bias);
    talus_vec3 n = tl_v(p->nx[i], p->ny[i], p->nz[i]);
    talus_vec3 v = tl_core_support_local(q->core, tl_mat3_mul_t(&at->r, tl_neg(n)), vertex);
    v = tl_add(tl_mat3_mul(&at->r, v), at->t);
    float apart = tl_dot(n, v) - p->d[i];
    if (s->point_count < TL_SAT_POINTS) {
        /* any point of the face will do */
        uint32_t e = p->core->kind == TL_CORE_BOX ? box_face_edge[i] : tl_hull_face_edge(p->core->hull)[i];
        talus_vec3 w = tl_sub(v, tl_v(p->x[p->edges[e].origin], p->y[p->edges[e].origin], p->z[p->edges[e].origin]));
        at->point[s->point_count] = w;
        s->point[s->point_count++] = kind == TL_AXIS_FACE_A ? w : tl_neg(tl_mat3_mul(&s->b->core->r, w));
    }
    if (apart > bar) {
        best->kind = kind;
        best->separation = apart;
        best->normal = n;
        best->a = best->b = i;
    }
}

/* The faces of a block of eight whose bounds are all above the bar, as bits. */
static uint32_t open_faces(const tl_poly *p, const relative *at, uint32_t points, uint32_t i, tl_f8 front, float inner,
                           float bar) {
    tl_f8 nx = tl_f8_loadu(p->nx + i), ny = tl_f8_loadu(p->ny + i), nz = tl_f8_loadu(p->nz + i);
    tl_f8 bound = tl_f8_sub(front, tl_f8_set1(inner));
    for (uint32_t k = 0; k < points; ++k) {
        const talus_vec3 w = at->point[k];
        tl_f8 dot = tl_f8_add(tl_f8_add(tl_f8_mul(nx, tl_f8_set1(w.x)), tl_f8_mul(ny, tl_f8_set1(w.y))),
                              tl_f8_mul(nz, tl_f8_set1(w.z)));
        bound = tl_f8_min(dot, bound);
    }
    return tl_m8_bits(tl_f8_gt(bound, tl_f8_set1(bar)));
}

static void query_faces(tl_sat *s, const tl_poly *p, const tl_poly *q, relative *at, tl_axis_kind kind, float *front,
                        tl_axis *best) {
    talus_vec3 c = tl_add(tl_mat3_mul(&at->r, q->center), at->t);
    tl_f8 cx = tl_f8_set1(c.x), cy = tl_f8_set1(c.y), cz = tl_f8_set1(c.z);
    uint32_t vertex = 0;
    float bias = kind == TL_AXIS_FACE_B ? s->bias : -s->bias;
    for (uint32_t i = 0; i < p->face_stride; i += 8u) {
        tl_f8 g = tl_f8_add(tl_f8_add(tl_f8_mul(tl_f8_loadu(p->nx + i), cx), tl_f8_mul(tl_f8_loadu(p->ny + i), cy)),
                            tl_f8_mul(tl_f8_loadu(p->nz + i), cz));
        g = tl_f8_sub(g, tl_f8_loadu(p->d + i));
        tl_f8_storeu(front + i, g);
        uint32_t known = s->point_count, done = 0u, bits;
        float bar = best->separation + (kind == best->kind ? 0.0f : bias);
        for (bits = open_faces(p, at, known, i, g, q->inner, bar); bits != 0u; bits &= ~done) {
            uint32_t lane = tl_low_bit(bits);
            done |= 2u * (1u << lane) - 1u;
            if (i + lane >= p->face_count) {
                break;
            }
            try_face(s, p, q, at, kind, i + lane, &vertex, best);
            if ((bits & ~done) != 0u) {
                bar = best->separation + (kind == best->kind ? 0.0f : bias);
                bits = open_faces(p, at, s->point_count, i, g, q->inner, bar);
            }
        }
    }
}

void tl_sat_faces(tl_sat *s, tl_axis *best) {
    const tl_core *b = s->b->core;
    relative at;
    at.r = b->r;
    at.t = b->t;
    memcpy(at.point, s->point, sizeof at.point);
    best->kind = TL_AXIS_NONE;
    best->separation = s->least;
    best->a = best->b = 0;
    query_faces(s, s->a, s->b, &at, TL_AXIS_FACE_A, s->front_a, best);
    if (best->separation > s->enough) {
        return;
    }
    at.t = tl_neg(tl_mat3_mul_t(&b->r, b->t));
    at.r = tl_mat3_transpose(&b->r);
    for (uint32_t k = 0; k < s->point_count; ++k) {
        at.point[k] = tl_neg(tl_mat3_mul(&at.r, s->point[k]));
    }
    query_faces(s, s->b, s->a, &at, TL_AXIS_FACE_B, s->front_b, best);
    if (best->kind == TL_AXIS_FACE_B) {
        best->normal = tl_neg(tl_mat3_mul(&b->r, best->normal));
    }
}

/* Edges that may carry the axis, in A's frame: the normals beside each, its direction and its start. */
typedef struct edge_list {
    uint32_t count;
    uint16_t edge[TL_SAT_EDGES + 1u];
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

/* Marks faces by what rules their normals out; an edge whose two faces share a mark is ruled out with all of its arc: a
 * bound that both ends of the arc stay below, and that is not positive, holds for what lies between them. */
static void mark_faces(const tl_sat *s, const tl_poly *p, const talus_vec3 *point, const float *front, float inner,
                       float bar, int32_t *mark) {
    tl_f8 behind = tl_f8_set1(tl_min(inner + bar, 0.0f)), limit = tl_f8_set1(bar);
    uint32_t points = bar <= 0.0f ? s->point_count : 0u;
    for (uint32_t i = 0; i < p->face_stride; i += 8u) {
        tl_f8 nx = tl_f8_loadu(p->nx + i), ny = tl_f8_loadu(p->ny + i), nz = tl_f8_loadu(p->nz + i);
        tl_m8 low = tl_f8_lt(tl_f8_loadu(front + i), behind);
        tl_i8 m = tl_i8_bits_of_f8(tl_f8_and_mask(low, tl_f8_of_bits(tl_i8_set1(256))));
        for (uint32_t k = 0; k < points; ++k) {
            tl_f8 dot =
                tl_f8_add(tl_f8_add(tl_f8_mul(nx, tl_f8_set1(point[k].x)), tl_f8_mul(ny, tl_f8_set1(point[k].y))),
                          tl_f8_mul(nz, tl_f8_set1(point[k].z)));
            tl_f8 bit = tl_f8_of_bits(tl_i8_set1((int32_t)(1u << k)));
            m = tl_i8_or(m, tl_i8_bits_of_f8(tl_f8_and_mask(tl_f8_lt(dot, limit), bit)));
        }
        tl_i8_storeu(mark + i, m);
    }
}

static void list_edges(const tl_poly *p, talus_vec3 c, float bar, const float *front, const int32_t *mark,
                       edge_list *out) {
    uint32_t open = 0, count = 0;
    for (uint32_t i = 0; i < p->half_edge_count; i += 2u) {
        /* written always and kept if open: a branch here would be guessed wrong too often */
        out->edge[open] = (uint16_t)(i >> 1);
        open += (mark[p->edges[i].face] & mark[p->edges[i + 1u].face]) == 0;
    }
    for (uint32_t k = 0; k < open; ++k) {
        uint16_t edge = out->edge[k];
        const tl_half_edge *e = &p->edges[2u * edge];
        float most = tl_max(front[e[0].face], front[e[1].face]);
        talus_vec3 from = poly_point(p, e[0].origin), along = tl_sub(poly_point(p, e[1].origin), from);
        if (most < bar && !edge_reaches(p, e, from, along, c, bar)) {
            continue;
        }
        out->edge[count] = edge;
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

static void mark_pairs(const edge_list *la, uint32_t i, const edge_list *lb, int32_t *hit) {
    float ex = la->ex[i], ey = la->ey[i], ez = la->ez[i], n1x = la->n1x[i], n1y = la->n1y[i], n1z = la->n1z[i];
    float n2x = la->n2x[i], n2y = la->n2y[i], n2z = la->n2z[i];
    for (uint32_t j = 0; j < lb->count; ++j) {
        float b1 = lb->n1x[j] * ex + lb->n1y[j] * ey + lb->n1z[j] * ez;
        float b2 = lb->n2x[j] * ex + lb->n2y[j] * ey + lb->n2z[j] * ez;
        float a1 = n1x * lb->ex[j] + n1y * lb->ey[j] + n1z * lb->ez[j];
        float a2 = n2x * lb->ex[j] + n2y * lb->ey[j] + n2z * lb->ez[j];
        hit[j] = (b1 * b2 < 0.0f) & (a1 * a2 < 0.0f) & (b1 * a2 < 0.0f);
    }
}

void tl_sat_edges(tl_sat *s, tl_axis *best) {
    const tl_poly *a = s->a, *b = s->b;
    edge_list la, lb;
    int32_t hit[TL_SAT_EDGES], mark[TL_SAT_FACES];
    talus_vec3 point[TL_SAT_POINTS];
    float bar = best->separation;
    mark_faces(s, a, s->point, s->front_a, b->inner, bar, mark);
    list_edges(a, tl_core_place(b->core, b->center), b->inner + bar, s->front_a, mark, &la);
    if (la.count == 0) {
        return;
    }
    for (uint32_t k = 0; k < s->point_count; ++k) {
        point[k] = tl_neg(tl_mat3_mul_t(&b->core->r, s->point[k]));
    }
    mark_faces(s, b, point, s->front_b, a->inner, bar, mark);
    talus_vec3 ca = tl_mat3_mul_t(&b->core->r, tl_sub(a->center, b->core->t));
    list_edges(b, ca, a->inner + bar, s->front_b, mark, &lb);
    const talus_mat3 *r = &b->core->r;
    rotate_list(r, lb.n1x, lb.n1y, lb.n1z, lb.count);
    rotate_list(r, lb.n2x, lb.n2y, lb.n2z, lb.count);
    rotate_list(r, lb.ex, lb.ey, lb.ez, lb.count);
    for (uint32_t i = 0; i < la.count; ++i) {
        mark_pairs(&la, i, &lb, hit);
        for (uint32_t j = 0; j < lb.count; ++j) {
            if (hit[j]) {
                talus_vec3 between = tl_v(la.n1x[i] + la.n2x[i], la.n1y[i] + la.n2y[i], la.n1z[i] + la.n2z[i]);
                try_pair(a, b, la.edge[i], lb.edge[j], between, s->bias, best);
                if (best->kind == TL_AXIS_EDGES && best->separation > s->enough) {
                    return;
                }
            }
        }
    }
}
