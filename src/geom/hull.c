/* A hull's blob: its layout, the numbers that follow from its arrays, its mass, and the proof that it is sound.
 * Mass: the sum over tetrahedra from an inner point to the triangles of each face's fan; the integrals of x x^T as in
 * F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", J. Math. Stat. 1(1), 2004.
 * Units: SI. */
#include "geom/double3.h"
#include "geom/hull_climb.h"
#include "geom/hull_derive.h"

#include <string.h>

static uint32_t aligned(uint32_t bytes) { return (bytes + 31u) / 32u * 32u; }

void tl_hull_layout(talus_hull *h) {
    uint32_t at = aligned((uint32_t)sizeof *h);
    h->vertex_stride = (h->vertex_count + 7u) / 8u * 8u;
    h->face_stride = (h->face_count + 7u) / 8u * 8u;
    h->vertices = at;
    at += 3u * h->vertex_stride * (uint32_t)sizeof(float);
    h->planes = at;
    at += 4u * h->face_stride * (uint32_t)sizeof(float);
    h->vertex_edge = at;
    at += aligned(h->vertex_count * (uint32_t)sizeof(uint16_t));
    h->face_edge = at;
    at += aligned(h->face_count * (uint32_t)sizeof(uint16_t));
    h->edges = at;
    at += aligned(h->half_edge_count * (uint32_t)sizeof(tl_half_edge));
    h->squares = tl_hull_squares(h->vertex_count);
    h->directions = at;
    at += aligned(6u * h->squares * h->squares * (uint32_t)sizeof(uint16_t));
    h->bytes = at;
}

uint32_t tl_hull_checksum(const void *blob, uint32_t bytes) {
    const unsigned char *at = blob;
    uint32_t hash = 2166136261u;
    for (uint32_t i = 16u; i < bytes; i += 4u) {
        uint32_t word;
        memcpy(&word, at + i, 4u);
        hash = (hash ^ word) * 16777619u;
        hash ^= hash >> 15; /* brings high bits down, where the product does not */
    }
    return hash;
}

typedef struct moments {
    double volume;
    tl_d3 first; /* integral of x */
    double xx, yy, zz, xy, xz, yz;
} moments;

/* Adds the tetrahedron 0 a b c. */
static void add_tetrahedron(moments *m, tl_d3 a, tl_d3 b, tl_d3 c) {
    double det = tl_d_dot(a, tl_d_cross(b, c)), k = det / 120.0;
    tl_d3 s = tl_d_add(tl_d_add(a, b), c);
    m->volume += det / 6.0;
    m->first = tl_d_add(m->first, tl_d_scale(s, det / 24.0));
    m->xx += k * (s.x * s.x + a.x * a.x + b.x * b.x + c.x * c.x);
    m->yy += k * (s.y * s.y + a.y * a.y + b.y * b.y + c.y * c.y);
    m->zz += k * (s.z * s.z + a.z * a.z + b.z * b.z + c.z * c.z);
    m->xy += k * (s.x * s.y + a.x * a.y + b.x * b.y + c.x * c.y);
    m->xz += k * (s.x * s.z + a.x * a.z + b.x * b.z + c.x * c.z);
    m->yz += k * (s.y * s.z + a.y * a.z + b.y * b.z + c.y * c.z);
}

static tl_d3 vertex(const talus_hull *h, uint32_t i) { return tl_d_from(tl_hull_point(h, i)); }

static void integrate(const talus_hull *h, tl_d3 origin, moments *m) {
    const uint16_t *face_edge = tl_hull_face_edge(h);
    const tl_half_edge *edge = tl_hull_edges(h);
    memset(m, 0, sizeof *m);
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        uint32_t first = face_edge[f], e = edge[first].next;
        tl_d3 a = tl_d_sub(vertex(h, edge[first].origin), origin), b = tl_d_sub(vertex(h, edge[e].origin), origin);
        for (e = edge[e].next; e != first; e = edge[e].next) {
            tl_d3 c = tl_d_sub(vertex(h, edge[e].origin), origin);
            add_tetrahedron(m, a, b, c);
            b = c;
        }
    }
}

void tl_hull_derive(const talus_hull *h, talus_hull *out) {
    memcpy(out, h, sizeof *out);
    talus_vec3 low = tl_hull_point(h, 0u), high = low;
    for (uint32_t i = 1u; i < h->vertex_count; ++i) {
        low = tl_min3(low, tl_hull_point(h, i));
        high = tl_max3(high, tl_hull_point(h, i));
    }
    out->bounds.lower = low;
    out->bounds.upper = high;
    tl_d3 origin = tl_d_scale(tl_d_add(tl_d_from(low), tl_d_from(high)), 0.5);
    moments m;
    integrate(h, origin, &m);
    double v = m.volume;
    tl_d3 c = v > 0.0 ? tl_d_scale(m.first, 1.0 / v) : tl_d(0.0, 0.0, 0.0);
    double xx = m.xx - v * c.x * c.x, yy = m.yy - v * c.y * c.y, zz = m.zz - v * c.z * c.z;
    out->volume = (float)v;
    out->centroid = tl_d_round(tl_d_add(origin, c));
    out->inertia[0] = (float)(yy + zz);
    out->inertia[1] = (float)(xx + zz);
    out->inertia[2] = (float)(xx + yy);
    out->inertia[3] = (float)-(m.xy - v * c.x * c.y);
    out->inertia[4] = (float)-(m.xz - v * c.x * c.z);
    out->inertia[5] = (float)-(m.yz - v * c.y * c.z);
    tl_d3 center = tl_d_from(out->centroid);
    double inner = 0.0, outer = 0.0;
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        double d = (double)tl_hull_offset(h, f) - tl_d_dot(tl_d_from(tl_hull_normal(h, f)), center);
        inner = f == 0u || d < inner ? d : inner;
    }
    for (uint32_t i = 0u; i < h->vertex_count; ++i) {
        tl_d3 d = tl_d_sub(vertex(h, i), center);
        outer = tl_d_max(outer, tl_d_dot(d, d));
    }
    out->inner_radius = (float)tl_d_max(inner, 0.0);
    out->outer_radius = (float)tl_d_sqrt(outer);
}

int tl_hull_has_mass(const talus_hull *h) {
    int finite = tl_is_finite(h->volume) && tl_is_finite(h->outer_radius);
    for (int i = 0; i < 6; ++i) {
        finite = finite && tl_is_finite(h->inertia[i]);
    }
    return finite && h->volume > 0.0f && h->inertia[0] > 0.0f && h->inertia[1] > 0.0f && h->inertia[2] > 0.0f;
}

size_t talus_hull_size(const talus_hull *hull) { return hull->bytes; }
uint32_t talus_hull_vertex_count(const talus_hull *hull) { return hull->vertex_count; }
uint32_t talus_hull_face_count(const talus_hull *hull) { return hull->face_count; }
talus_vec3 talus_hull_vertex(const talus_hull *hull, uint32_t i) {
    /* A number past the end gives the last vertex rather than what lies behind the blob. */
    return tl_hull_point(hull, i < hull->vertex_count ? i : hull->vertex_count - 1u);
}

talus_mass talus_hull_mass(const talus_hull *hull, float density) {
    const float *i = hull->inertia;
    talus_mass m;
    m.mass = density * hull->volume;
    m.center = hull->centroid;
    m.inertia.x = tl_v(density * i[0], density * i[3], density * i[4]);
    m.inertia.y = tl_v(density * i[3], density * i[1], density * i[5]);
    m.inertia.z = tl_v(density * i[4], density * i[5], density * i[2]);
    return m;
}
