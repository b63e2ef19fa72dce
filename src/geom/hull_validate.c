/* The proof that a blob holds a sound hull, in time proportional to its size and without memory of its own.
 * Every index is looked at before it is followed. Face cycles and vertex cycles are walked once, so that each half-edge
 * is in exactly one of either; with Euler's formula the surface is a sphere, if it is in one piece. A closed surface
 * that is convex at every edge and every face is convex (Tietze-Nakajima), if it is wound once: for a few directions
 * every local maximum must be the global one, which neither a second piece nor a second winding allows. The numbers
 * that follow from the arrays must be those the builder works out, to the bit. Units: m. */
#include "geom/double3.h"
#include "geom/hull_derive.h"

#include <string.h>

/* How far, in parts of the largest coordinate, a hull may be from flat faces and from convexity: 2^-17. */
#define SLACK (1.0 / 131072.0)

static int header_is_sound(const void *blob, size_t bytes) {
    talus_hull h, expected;
    if (bytes < sizeof h) {
        return 0;
    }
    memcpy(&h, blob, sizeof h);
    if (h.magic != TL_HULL_MAGIC || h.version != TL_HULL_VERSION || h.bytes > bytes) {
        return 0;
    }
    if (h.vertex_count < 4u || h.vertex_count > TALUS_HULL_MAX_VERTICES || h.face_count < 4u ||
        h.face_count > 2u * h.vertex_count - 4u || h.half_edge_count != 2u * (h.vertex_count + h.face_count - 2u)) {
        return 0;
    }
    memcpy(&expected, &h, sizeof h);
    tl_hull_layout(&expected);
    return memcmp(&h, &expected, sizeof h) == 0 && tl_hull_checksum(blob, h.bytes) == h.checksum;
}

static int all_finite(const float *x, uint32_t n) {
    for (uint32_t i = 0u; i < n; ++i) {
        if (!tl_is_finite(x[i])) {
            return 0;
        }
    }
    return 1;
}

/* Rows of `stride` floats of which `count` count: finite, and the rest repeats the last. */
static int rows_are_sound(const float *x, uint32_t rows, uint32_t stride, uint32_t count) {
    if (!all_finite(x, rows * stride)) {
        return 0;
    }
    for (uint32_t r = 0u; r < rows; ++r) {
        for (uint32_t i = count; i < stride; ++i) {
            if (memcmp(&x[r * stride + i], &x[r * stride + count - 1u], sizeof *x) != 0) {
                return 0;
            }
        }
    }
    return 1;
}

/* Indices in range, cycles of faces and of vertices: at least three half-edges each, every half-edge once. */
static int topology_is_sound(const talus_hull *h) {
    const tl_half_edge *edge = tl_hull_edges(h);
    const uint16_t *face_edge = tl_hull_face_edge(h), *vertex_edge = tl_hull_vertex_edge(h);
    uint32_t n = h->half_edge_count, total = 0u;
    for (uint32_t i = 0u; i < 6u * h->squares * h->squares; ++i) {
        if (tl_hull_directions(h)[i] >= h->vertex_count) {
            return 0;
        }
    }
    for (uint32_t e = 0u; e < n; ++e) {
        if (edge[e].next >= n || edge[e].origin >= h->vertex_count || edge[e].face >= h->face_count) {
            return 0;
        }
    }
    for (uint32_t e = 0u; e < n; ++e) {
        if (edge[edge[e].next].origin != edge[e ^ 1u].origin || edge[e].face == edge[e ^ 1u].face ||
            edge[e].origin == edge[e ^ 1u].origin) {
            return 0;
        }
    }
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        uint32_t first = face_edge[f], e = first, sides = 0u;
        do {
            if (e >= n || edge[e].face != f || ++total > n) {
                return 0;
            }
            e = edge[e].next;
            ++sides;
        } while (e != first);
        if (sides < 3u) {
            return 0;
        }
    }
    if (total != n) {
        return 0;
    }
    total = 0u;
    for (uint32_t v = 0u; v < h->vertex_count; ++v) {
        uint32_t first = vertex_edge[v], e = first, degree = 0u;
        do {
            if (e >= n || edge[e].origin != v || ++total > n) {
                return 0;
            }
            e = edge[e ^ 1u].next;
            ++degree;
        } while (e != first);
        if (degree < 3u) {
            return 0;
        }
    }
    return total == n;
}

static tl_d3 point(const talus_hull *h, uint32_t i) { return tl_d_from(tl_hull_point(h, i)); }

/* Corners that turn left, and a fan of triangles that all face outwards. */
static int face_is_convex(const talus_hull *h, uint32_t f, double slack) {
    const tl_half_edge *edge = tl_hull_edges(h);
    tl_d3 n = tl_d_from(tl_hull_normal(h, f));
    double d = (double)tl_hull_offset(h, f);
    uint32_t first = tl_hull_face_edge(h)[f], e = first;
    tl_d3 hub = point(h, edge[first].origin);
    do {
        uint32_t e1 = edge[e].next, e2 = edge[e1].next;
        tl_d3 a = point(h, edge[e].origin), b = point(h, edge[e1].origin), c = point(h, edge[e2].origin);
        if (tl_d_abs(tl_d_dot(n, a) - d) > slack) {
            return 0;
        }
        tl_d3 ab = tl_d_sub(b, a), bc = tl_d_sub(c, b), ha = tl_d_sub(a, hub);
        double longer = tl_d_max(tl_d_length(ab), tl_d_length(bc));
        if (tl_d_dot(n, tl_d_cross(ab, bc)) < -slack * longer) {
            return 0;
        }
        longer = tl_d_max(tl_d_length(ab), tl_d_length(ha));
        if (tl_d_dot(n, tl_d_cross(ha, ab)) < -slack * longer) {
            return 0;
        }
        e = e1;
    } while (e != first);
    return 1;
}

/* Planes of unit length, faces convex, and next to each edge the other face below. */
static int is_convex(const talus_hull *h, double slack) {
    const tl_half_edge *edge = tl_hull_edges(h);
    for (uint32_t f = 0u; f < h->face_count; ++f) {
        tl_d3 n = tl_d_from(tl_hull_normal(h, f));
        if (tl_d_abs(tl_d_dot(n, n) - 1.0) > 1e-5 || !face_is_convex(h, f, slack)) {
            return 0;
        }
    }
    for (uint32_t e = 0u; e < h->half_edge_count; ++e) {
        tl_d3 n = tl_d_from(tl_hull_normal(h, edge[e].face));
        double d = (double)tl_hull_offset(h, edge[e].face) + slack;
        /* The corner after the far face's two on this edge; the one before them is met from the edge it is on. */
        uint32_t far = edge[edge[edge[e ^ 1u].next].next].origin;
        if (tl_d_dot(n, point(h, far)) > d) {
            return 0;
        }
    }
    return 1;
}

static int winds_once(const talus_hull *h, double slack) {
    static const double direction[6][3] = {{0.91, 0.37, 0.19},  {-0.83, 0.41, 0.38}, {0.23, 0.88, -0.42},
                                           {0.31, -0.92, 0.25}, {0.17, 0.36, 0.92},  {-0.29, -0.31, -0.91}};
    const tl_half_edge *edge = tl_hull_edges(h);
    const uint16_t *vertex_edge = tl_hull_vertex_edge(h);
    for (int k = 0; k < 6; ++k) {
        tl_d3 d = tl_d(direction[k][0], direction[k][1], direction[k][2]);
        double best = tl_d_dot(d, point(h, 0u));
        for (uint32_t v = 1u; v < h->vertex_count; ++v) {
            best = tl_d_max(best, tl_d_dot(d, point(h, v)));
        }
        for (uint32_t v = 0u; v < h->vertex_count; ++v) {
            double height = tl_d_dot(d, point(h, v));
            int local = height < best - 4.0 * slack;
            uint32_t e = vertex_edge[v];
            do {
                local = local && tl_d_dot(d, point(h, edge[e ^ 1u].origin)) <= height;
                e = edge[e ^ 1u].next;
            } while (local && e != vertex_edge[v]);
            if (local) {
                return 0;
            }
        }
    }
    return 1;
}

talus_status talus_hull_validate(const void *blob, size_t bytes) {
    if (!blob) {
        return TALUS_BAD_ARGUMENT;
    }
    if ((uintptr_t)blob % TALUS_BLOB_ALIGNMENT) {
        return TALUS_UNALIGNED;
    }
    if (!header_is_sound(blob, bytes)) {
        return TALUS_BAD_BLOB;
    }
    const talus_hull *h = blob;
    if (!rows_are_sound(tl_hull_x(h), 3u, h->vertex_stride, h->vertex_count) ||
        !rows_are_sound(tl_hull_planes(h), 4u, h->face_stride, h->face_count) || !topology_is_sound(h)) {
        return TALUS_BAD_BLOB;
    }
    talus_hull derived;
    tl_hull_derive(h, &derived);
    if (memcmp(h, &derived, sizeof derived) != 0 || !tl_hull_has_mass(h)) {
        return TALUS_BAD_BLOB;
    }
    talus_vec3 reach = tl_max3(tl_abs3(h->bounds.lower), tl_abs3(h->bounds.upper));
    double slack = SLACK * (double)tl_max(reach.x, tl_max(reach.y, reach.z));
    return is_convex(h, slack) && winds_once(h, slack) ? TALUS_OK : TALUS_BAD_BLOB;
}
