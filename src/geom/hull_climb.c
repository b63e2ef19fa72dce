/* Climbs from vertex to neighbour (van den Bergen, Collision Detection in Interactive 3D Environments, 4.3.4) and the
 * table that they begin at: the furthest vertex along the middle of each square of a cube. */
#include "geom/hull_climb.h"

uint32_t tl_hull_squares(uint32_t vertex_count) {
    uint32_t n = 0u;
    while (vertex_count > TL_HULL_SCANNED && 6u * n * n < vertex_count) {
        ++n;
    }
    return n;
}

uint32_t tl_hull_climb(const talus_hull *h, talus_vec3 d, uint32_t v) {
    const float *x = tl_hull_x(h), *y = tl_hull_y(h), *z = tl_hull_z(h);
    const tl_half_edge *edges = tl_hull_edges(h);
    const uint16_t *vertex_edge = tl_hull_vertex_edge(h);
    float best = x[v] * d.x + y[v] * d.y + z[v] * d.z;
    for (uint32_t steps = 0; steps < h->vertex_count; ++steps) {
        uint32_t first = vertex_edge[v], e = first, to = v;
        do {
            uint32_t twin = tl_hull_twin(e), u = edges[twin].origin;
            float s = x[u] * d.x + y[u] * d.y + z[u] * d.z;
            if (s > best) {
                best = s;
                to = u;
            }
            e = edges[twin].next;
        } while (e != first);
        if (to == v) {
            break;
        }
        v = to;
    }
    return v;
}

/* The middle of a square on a side of the cube of half extent 1. */
static talus_vec3 middle(uint32_t side, float u, float v) {
    float w = (side & 1u) ? 1.0f : -1.0f;
    return side / 2u == 0u ? tl_v(w, u, v) : side / 2u == 1u ? tl_v(v, w, u) : tl_v(u, v, w);
}

void tl_hull_fill_directions(talus_hull *h) {
    uint16_t *table = (uint16_t *)(void *)((unsigned char *)h + h->directions);
    uint32_t n = h->squares, vertex = 0u;
    for (uint32_t i = 0; i < 6u * n * n; ++i) {
        float u = (2.0f * (float)(i / n % n) + 1.0f) / (float)n - 1.0f, v = (2.0f * (float)(i % n) + 1.0f) / (float)n;
        vertex = tl_hull_climb(h, middle(i / n / n, u, v - 1.0f), vertex);
        table[i] = (uint16_t)vertex;
    }
}
