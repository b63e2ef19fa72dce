/* Features and support vertices of what has flat sides, frames, and the distance of segments. Metres. */
#include "collide/polytope.h"

#include "collide/support.h"
#include "geom/hull_climb.h"

/* Corner i is at +x if its bit 0 is set, +y bit 1, +z bit 2; the faces are -x +x -y +y -z +z. */
static const tl_half_edge box_edges[24] = {{2, 4, 0, 0},  {17, 6, 5, 0}, {4, 6, 0, 0},  {20, 2, 3, 0}, {6, 2, 0, 0},
                                           {23, 0, 4, 0}, {0, 0, 0, 0},  {18, 4, 2, 0}, {10, 1, 1, 0}, {19, 3, 4, 0},
                                           {12, 3, 1, 0}, {22, 7, 3, 0}, {14, 7, 1, 0}, {21, 5, 5, 0}, {8, 5, 1, 0},
                                           {16, 1, 2, 0}, {7, 5, 2, 0},  {13, 4, 5, 0}, {15, 0, 2, 0}, {5, 1, 4, 0},
                                           {11, 6, 3, 0}, {1, 7, 5, 0},  {3, 3, 3, 0},  {9, 2, 4, 0}};
static const uint16_t box_face_edge[6] = {0, 8, 15, 3, 23, 17};
static const uint16_t box_vertex_edge[8] = {5, 8, 3, 9, 0, 13, 1, 11};
static const tl_half_edge segment_edges[2] = {{1, 0, TL_NO_FEATURE, 0}, {0, 1, TL_NO_FEATURE, 0}};
static const uint16_t segment_vertex_edge[2] = {0, 1};
static const uint16_t point_vertex_edge[1] = {TL_NO_FEATURE};

static void own_rows(tl_polytope *p) {
    p->x = p->own, p->y = p->own + 8, p->z = p->own + 16;
    p->nx = p->own + 24, p->ny = p->own + 30, p->nz = p->own + 36, p->d = p->own + 42;
    p->center = tl_d(0.0, 0.0, 0.0);
    p->face_count = 0u;
    p->face_edge = NULL;
}

static void init_box(tl_polytope *p, talus_vec3 half) {
    own_rows(p);
    for (uint32_t i = 0; i < 8u; ++i) {
        p->own[i] = (i & 1u) ? half.x : -half.x;
        p->own[8u + i] = (i & 2u) ? half.y : -half.y;
        p->own[16u + i] = (i & 4u) ? half.z : -half.z;
    }
    for (uint32_t f = 0; f < 6u; ++f) {
        float side = (f & 1u) ? 1.0f : -1.0f;
        p->own[24u + f] = f / 2u == 0u ? side : 0.0f;
        p->own[30u + f] = f / 2u == 1u ? side : 0.0f;
        p->own[36u + f] = f / 2u == 2u ? side : 0.0f;
        p->own[42u + f] = f / 2u == 0u ? half.x : f / 2u == 1u ? half.y : half.z;
    }
    p->edges = box_edges;
    p->vertex_edge = box_vertex_edge;
    p->face_edge = box_face_edge;
    p->vertex_count = 8u, p->edge_count = 24u, p->face_count = 6u;
    p->radius = 0.0f;
    p->size = tl_length(half);
}

static void init_round(tl_polytope *p, const talus_geometry *g) {
    p->round = 1;
    p->radius = 0.0f;
    p->center = tl_d(0.0, 0.0, 0.0);
    p->size = g->half_height + tl_max(g->radius_top, g->radius_bottom);
    p->vertex_count = p->edge_count = p->face_count = 0u;
}

void tl_polytope_init_plain(tl_polytope *p, const tl_convex *shape) {
    const talus_geometry *g = &shape->geometry;
    p->shape = shape;
    p->round = 0;
    switch (g->type) {
    case TALUS_SPHERE:
        own_rows(p);
        p->own[0] = p->own[8] = p->own[16] = 0.0f;
        p->edges = NULL;
        p->vertex_edge = point_vertex_edge;
        p->vertex_count = 1u, p->edge_count = 0u;
        p->radius = g->radius;
        p->size = 0.0f;
        break;
    case TALUS_CAPSULE:
        if (g->radius_top != g->radius_bottom) {
            init_round(p, g);
            break;
        }
        own_rows(p);
        p->own[0] = p->own[1] = p->own[16] = p->own[17] = 0.0f;
        p->own[8] = -g->half_height;
        p->own[9] = g->half_height;
        p->edges = segment_edges;
        p->vertex_edge = g->half_height > 0.0f ? segment_vertex_edge : point_vertex_edge;
        p->vertex_count = g->half_height > 0.0f ? 2u : 1u;
        p->edge_count = g->half_height > 0.0f ? 2u : 0u;
        p->radius = g->radius_top;
        p->size = g->half_height;
        break;
    case TALUS_BOX:
        init_box(p, g->half);
        break;
    case TALUS_CYLINDER:
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        init_round(p, g);
        break;
    }
}

uint32_t tl_polytope_seed(const tl_polytope *p, tl_d3 direction) {
    const talus_hull *h = p->shape->hull;
    talus_vec3 d = tl_d_round(direction);
    if (p->shape->geometry.type != TALUS_HULL) {
        return tl_polytope_support(p, direction, 0u);
    }
    return h->squares > 0u ? tl_hull_seed(h, d) : tl_hull_support(h, d, 0u);
}

uint32_t tl_polytope_near(const tl_polytope *p, tl_d3 direction, uint32_t start) {
    if (p->shape->geometry.type != TALUS_HULL) {
        return tl_polytope_support(p, direction, start);
    }
    return tl_hull_support(p->shape->hull, tl_d_round(direction), start);
}

uint32_t tl_polytope_support(const tl_polytope *p, tl_d3 direction, uint32_t v) {
    double best = tl_d_dot(direction, tl_polytope_vertex(p, v));
    if (p->vertex_count <= 8u) {
        for (uint32_t i = 0; i < p->vertex_count; ++i) {
            double s = tl_d_dot(direction, tl_polytope_vertex(p, i));
            if (s > best) {
                best = s, v = i;
            }
        }
        return v;
    }
    for (uint32_t steps = 0; steps < p->vertex_count; ++steps) {
        uint32_t first = p->vertex_edge[v], e = first, to = v;
        do {
            uint32_t twin = tl_hull_twin(e), u = p->edges[twin].origin;
            double s = tl_d_dot(direction, tl_polytope_vertex(p, u));
            if (s > best) {
                best = s, to = u;
            }
            e = p->edges[twin].next;
        } while (e != first);
        if (to == v) {
            break;
        }
        v = to;
    }
    return v;
}

/* How far p is outside of a face in the polar dual about the body's centre: 1 on its plane. */
static double dual_height(const tl_polytope *b, uint32_t face, tl_d3 from_center) {
    tl_d3 n = tl_polytope_normal(b, face);
    return tl_d_dot(n, from_center) / ((double)b->d[face] - tl_d_dot(n, b->center));
}

uint32_t tl_polytope_face_towards(const tl_polytope *b, uint32_t face, tl_d3 p, double *height) {
    tl_d3 d = tl_d_sub(p, b->center);
    double best = dual_height(b, face, d);
    for (uint32_t steps = 0; steps < b->face_count; ++steps) {
        uint32_t first = b->face_edge[face], e = first, to = face;
        do {
            uint32_t f = b->edges[e ^ 1u].face;
            double h = dual_height(b, f, d);
            if (h > best) {
                best = h, to = f;
            }
            e = b->edges[e].next;
        } while (e != first);
        if (to == face) {
            break;
        }
        face = to;
    }
    *height = best;
    return face;
}

int tl_polytope_holds(const tl_polytope *b, uint32_t face, tl_d3 p) {
    double height;
    (void)tl_polytope_face_towards(b, face, p, &height);
    return height < 1.0;
}

static double part(double x, double length) { return x <= 0.0 ? 0.0 : x >= length ? 1.0 : x / length; }

double tl_segments(tl_d3 p0, tl_d3 p1, tl_d3 q0, tl_d3 q1, double *s, double *t) {
    tl_d3 u = tl_d_sub(p1, p0), v = tl_d_sub(q1, q0), w = tl_d_sub(q0, p0);
    double uu = tl_d_dot(u, u), vv = tl_d_dot(v, v), uv = tl_d_dot(u, v), uw = tl_d_dot(u, w), vw = tl_d_dot(v, w);
    double det = uu * vv - uv * uv;
    if (det > 1e-13 * uu * vv) {
        *s = part(uw * vv - uv * vw, det);
    } else { /* the stretch of p beside q, by its ends */
        double a = part(uw, uu), b = part(uw + uv, uu);
        *s = 0.5 * (a + b);
    }
    *t = part(*s * uv - vw, vv);
    *s = part(uw + *t * uv, uu);
    tl_d3 gap = tl_d_sub(tl_d_add(w, tl_d_scale(v, *t)), tl_d_scale(u, *s));
    return tl_d_dot(gap, gap);
}
