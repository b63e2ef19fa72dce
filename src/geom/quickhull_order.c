/* The order of a large hull in memory: what is near on its surface is near in the blob, so that a walk over features
 * meets few cache lines. Vertices follow a Z-order curve (Morton, A Computer Oriented Geodetic Data Base and a New
 * Technique in File Sequencing, 1966), faces their lowest vertex, half-edges their faces. */
#include "base/sort.h"
#include "geom/hull_climb.h"
#include "geom/quickhull.h"

#include <string.h>

/* The bits of a number of 16 bits, two places left free after each. */
static uint64_t spread(uint32_t x) {
    uint64_t s = 0u;
    for (uint32_t bit = 0u; bit < 16u; ++bit) {
        s |= (uint64_t)(x >> bit & 1u) << (3u * bit);
    }
    return s;
}

static uint32_t cell(double x, double low, double high) {
    return high > low ? (uint32_t)((x - low) / (high - low) * 65535.0) : 0u;
}

/* New numbers of the vertices by their old ones, into list_a. */
static void order_vertices(tl_qh *q) {
    tl_d3 low = tl_d(1e300, 1e300, 1e300), high = tl_d_scale(low, -1.0);
    uint32_t count = 0u;
    for (uint32_t i = 0u; i < q->count; ++i) {
        if (q->at[i] != TL_QH_NONE) {
            tl_d3 p = q->p[i];
            low = tl_d(tl_d_min(low.x, p.x), tl_d_min(low.y, p.y), tl_d_min(low.z, p.z));
            high = tl_d(tl_d_max(high.x, p.x), tl_d_max(high.y, p.y), tl_d_max(high.z, p.z));
        }
    }
    for (uint32_t i = 0u; i < q->count; ++i) {
        if (q->at[i] != TL_QH_NONE) {
            tl_d3 p = q->p[i];
            uint64_t code = spread(cell(p.x, low.x, high.x)) | spread(cell(p.y, low.y, high.y)) << 1 |
                            spread(cell(p.z, low.z, high.z)) << 2;
            q->keys[count++] = code << 16 | q->at[i];
        }
    }
    tl_sort_keys(q->keys, count);
    for (uint32_t i = 0u; i < count; ++i) {
        q->list_a[q->keys[i] & 0xffffu] = i;
    }
}

/* New numbers of the faces, into list_b, and the old ones in the new order, into list_c. Origins are new ones. */
static void order_faces(tl_qh *q) {
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        uint32_t e = q->f[f].first, lowest = TL_QH_NONE;
        do {
            lowest = q->edge[e].origin < lowest ? q->edge[e].origin : lowest;
            e = q->edge[e].next;
        } while (e != q->f[f].first);
        q->keys[f] = (uint64_t)lowest << 32 | f;
    }
    tl_sort_keys(q->keys, q->f_count);
    for (uint32_t i = 0u; i < q->f_count; ++i) {
        q->list_c[i] = (uint32_t)q->keys[i];
        q->list_b[q->list_c[i]] = i;
    }
}

/* New numbers of the pairs of half-edges, into edge_id. */
static void order_edges(tl_qh *q) {
    uint32_t made = 0u;
    memset(q->edge_id, 0xff, q->edge_count / 2u * sizeof *q->edge_id);
    for (uint32_t i = 0u; i < q->f_count; ++i) {
        uint32_t first = q->f[q->list_c[i]].first, e = first;
        do {
            if (q->edge_id[e / 2u] == TL_QH_NONE) {
                q->edge_id[e / 2u] = made++;
            }
            e = q->edge[e].next;
        } while (e != first);
    }
}

static uint32_t new_edge(const tl_qh *q, uint32_t e) { return 2u * q->edge_id[e / 2u] + (e & 1u); }

/* Moves pairs and faces to their new places along the cycles of the permutations. */
static void move(tl_qh *q) {
    for (uint32_t i = 0u; i < q->edge_count / 2u; ++i) {
        for (uint32_t to = q->edge_id[i]; to != i; to = q->edge_id[i]) {
            for (uint32_t k = 0u; k < 2u; ++k) {
                tl_half_edge e = q->edge[2u * to + k];
                q->edge[2u * to + k] = q->edge[2u * i + k];
                q->edge[2u * i + k] = e;
            }
            q->edge_id[i] = q->edge_id[to];
            q->edge_id[to] = to;
        }
    }
    for (uint32_t i = 0u; i < q->f_count; ++i) {
        for (uint32_t to = q->list_b[i]; to != i; to = q->list_b[i]) {
            tl_qh_facet f = q->f[to];
            q->f[to] = q->f[i];
            q->f[i] = f;
            q->list_b[i] = q->list_b[to];
            q->list_b[to] = to;
        }
    }
}

void tl_qh_order(tl_qh *q) {
    if (q->vertex_count <= TL_HULL_SCANNED) {
        return;
    }
    order_vertices(q);
    for (uint32_t i = 0u; i < q->count; ++i) {
        q->at[i] = q->at[i] != TL_QH_NONE ? q->list_a[q->at[i]] : TL_QH_NONE;
    }
    for (uint32_t e = 0u; e < q->edge_count; ++e) {
        q->edge[e].origin = (uint16_t)q->list_a[q->edge[e].origin];
    }
    order_faces(q);
    order_edges(q);
    for (uint32_t e = 0u; e < q->edge_count; ++e) {
        q->edge[e].next = (uint16_t)new_edge(q, q->edge[e].next);
        q->edge[e].face = (uint16_t)q->list_b[q->edge[e].face];
    }
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        q->f[f].first = new_edge(q, q->f[f].first);
    }
    move(q);
}
