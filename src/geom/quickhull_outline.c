/* From facets to the blob: vertices where three or more facets meet, half-edges between them, planes.
 * A vertex within a facet or between two only is left out; the chain of edges through it becomes one edge.
 * Units: metres in the blob, lattice units (quickhull.h) in the tests. */
#include "geom/hull_climb.h"
#include "geom/hull_derive.h"
#include "geom/quickhull.h"

#include <string.h>

static uint32_t facet_of(const tl_qh *q, uint32_t edge) { return q->t[edge / 3u].facet; }

static uint32_t outline_next(const tl_qh *q, uint32_t edge) {
    uint32_t f = facet_of(q, edge), e = tl_qh_next_edge(edge);
    while (facet_of(q, tl_qh_twin(q, e)) == f) {
        e = tl_qh_next_edge(tl_qh_twin(q, e));
    }
    return e;
}

/* Numbers the vertices in the order in which they were given; at[] is the number, or TL_QH_NONE. */
static void number_vertices(tl_qh *q) {
    memset(q->at, 0, q->count * sizeof *q->at);
    for (uint32_t e = 0u; e < 3u * q->t_used; ++e) {
        if (q->t[e / 3u].alive && facet_of(q, e) != facet_of(q, tl_qh_twin(q, e))) {
            ++q->at[tl_qh_origin(q, e)];
        }
    }
    q->vertex_count = 0u;
    for (uint32_t i = 0u; i < q->count; ++i) {
        q->at[i] = q->at[i] >= 3u ? q->vertex_count++ : TL_QH_NONE;
    }
}

/* Follows the chain of edges that starts with e to its last one; false if what it leaves out is too far off the line.
 */
static int chain_end(const tl_qh *q, uint32_t e, uint32_t *last) {
    uint32_t end = e, after = outline_next(q, e);
    while (q->at[tl_qh_origin(q, after)] == TL_QH_NONE) {
        end = after;
        after = outline_next(q, after);
    }
    *last = end;
    tl_d3 a = q->p[tl_qh_origin(q, e)], b = q->p[tl_qh_origin(q, after)];
    for (uint32_t i = e; i != end;) {
        i = outline_next(q, i);
        if (tl_qh_segment2(q->p[tl_qh_origin(q, i)], a, b) > 4.0 * q->tolerance * q->tolerance) {
            return 0;
        }
    }
    return 1;
}

static int is_single(const tl_qh *q, uint32_t facet) {
    uint32_t t = q->f[facet].edge / 3u, same = 0u;
    for (uint32_t k = 0u; k < 3u; ++k) {
        same += facet_of(q, q->t[t].twin[k]) == facet;
    }
    return same == 0u;
}

/* Of two facets between which a chain is bent the smaller is at fault, unless it is a triangle. */
static void blame(tl_qh *q, uint32_t facet, uint32_t across) {
    uint32_t smaller = facet > across ? facet : across, larger = facet > across ? across : facet;
    q->f[is_single(q, smaller) ? larger : smaller].bad = 1u;
}

/* The corner of the facet with the lowest number, as a half-edge of the outline. */
static uint32_t first_corner(const tl_qh *q, uint32_t facet) {
    uint32_t start = TL_QH_NONE, e = q->f[facet].edge;
    do {
        uint32_t v = q->at[tl_qh_origin(q, e)];
        if (v != TL_QH_NONE && (start == TL_QH_NONE || v < q->at[tl_qh_origin(q, start)])) {
            start = e;
        }
        e = outline_next(q, e);
    } while (e != q->f[facet].edge);
    return start;
}

/* The half-edges of one facet; false if it is not a face of a polyhedron. */
static int outline_facet(tl_qh *q, uint32_t facet, uint32_t *made) {
    tl_qh_facet *f = &q->f[facet];
    uint32_t start = first_corner(q, facet), sides = 0u, before = TL_QH_NONE, e = start;
    if (start == TL_QH_NONE) {
        f->bad = 1u;
        return 0;
    }
    int good = 1;
    do {
        uint32_t last, straight = (uint32_t)chain_end(q, e, &last);
        uint32_t across = tl_qh_twin(q, last), id = q->edge_id[across];
        id = id == TL_QH_NONE ? 2u * (*made)++ : id ^ 1u;
        if (!straight) {
            blame(q, facet, facet_of(q, across));
            good = 0;
        }
        if (id >= q->edge_count) {
            return 0;
        }
        q->edge_id[e] = id;
        q->edge[id].origin = (uint16_t)q->at[tl_qh_origin(q, e)];
        q->edge[id].face = (uint16_t)facet;
        q->edge[id].reserved = 0u;
        if (before == TL_QH_NONE) {
            f->first = id;
        } else {
            q->edge[before].next = (uint16_t)id;
        }
        before = id;
        ++sides;
        e = outline_next(q, last);
    } while (e != start);
    q->edge[before].next = (uint16_t)f->first;
    if (sides < 3u) {
        blame(q, facet, facet_of(q, tl_qh_twin(q, start)));
    }
    return good && sides >= 3u;
}

/* Two faces of a polyhedron share one edge at most, and two vertices one edge at most. */
static int is_simple(tl_qh *q) {
    memset(q->list_a, 0, q->f_count * sizeof *q->list_a);
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        uint32_t e = q->f[f].first;
        do {
            uint32_t other = q->edge[e ^ 1u].face;
            if (other == f || q->list_a[other] == f + 1u) {
                return 0;
            }
            q->list_a[other] = f + 1u;
            e = q->edge[e].next;
        } while (e != q->f[f].first);
    }
    memset(q->list_a, 0, q->vertex_count * sizeof *q->list_a);
    memset(q->list_b, 0, q->vertex_count * sizeof *q->list_b);
    for (uint32_t e = 0u; e < q->edge_count; ++e) {
        uint32_t v = q->edge[e].origin, i = e;
        if (q->list_b[v]) {
            continue;
        }
        q->list_b[v] = 1u;
        do {
            uint32_t end = q->edge[i ^ 1u].origin;
            if (q->list_a[end] == v + 1u) {
                return 0;
            }
            q->list_a[end] = v + 1u;
            i = q->edge[i ^ 1u].next;
        } while (i != e);
    }
    return 1;
}

talus_status tl_qh_outline(tl_qh *q, int *marked) {
    number_vertices(q);
    uint32_t v = q->vertex_count;
    *marked = 0;
    if (v > TALUS_HULL_MAX_VERTICES) {
        return TALUS_TOO_MANY_POINTS;
    }
    if (v < 4u || q->f_count < 4u || q->f_count > 2u * v - 4u) {
        return TALUS_FLAT_HULL;
    }
    /* By Euler's formula. */
    q->edge_count = 2u * (v + q->f_count - 2u);
    memset(q->edge_id, 0xff, 3u * q->t_used * sizeof *q->edge_id);
    uint32_t made = 0u, good = 0u;
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        good += (uint32_t)outline_facet(q, f, &made);
    }
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        *marked |= q->f[f].bad != 0u;
    }
    return good == q->f_count && 2u * made == q->edge_count && is_simple(q) ? TALUS_OK : TALUS_FLAT_HULL;
}

static void write_points(const tl_qh *q, talus_hull *h) {
    float *x = (float *)(void *)((unsigned char *)h + h->vertices);
    uint32_t stride = h->vertex_stride;
    for (uint32_t i = 0u; i < q->count; ++i) {
        uint32_t n = q->at[i];
        if (n != TL_QH_NONE) {
            x[n] = q->input[i].x, x[stride + n] = q->input[i].y, x[2u * stride + n] = q->input[i].z;
        }
    }
    for (uint32_t n = h->vertex_count; n < stride; ++n) {
        x[n] = x[n - 1u], x[stride + n] = x[stride + n - 1u], x[2u * stride + n] = x[2u * stride + n - 1u];
    }
}

/* The plane keeps the facet's normal and moves out to its furthest corner. */
static void write_plane(const tl_qh *q, talus_hull *h, uint32_t facet) {
    talus_vec3 n = tl_d_round(q->f[facet].normal);
    tl_d3 normal = tl_d_from(n);
    uint32_t first = q->f[facet].first, e = first;
    double d = tl_d_dot(normal, tl_d_from(tl_hull_point(h, q->edge[e].origin)));
    do {
        d = tl_d_max(d, tl_d_dot(normal, tl_d_from(tl_hull_point(h, q->edge[e].origin))));
        e = q->edge[e].next;
    } while (e != first);
    float *plane = (float *)(void *)((unsigned char *)h + h->planes);
    /* The last one fills the padding. */
    uint32_t end = facet + 1u == h->face_count ? h->face_stride : facet + 1u;
    for (uint32_t i = facet; i < end; ++i) {
        plane[i] = n.x, plane[h->face_stride + i] = n.y, plane[2u * h->face_stride + i] = n.z;
        plane[3u * h->face_stride + i] = (float)d;
    }
}

talus_status tl_qh_write(const tl_qh *q, void *out, size_t out_size, size_t *size) {
    talus_hull header, *h = out;
    memset(&header, 0, sizeof header);
    header.magic = TL_HULL_MAGIC;
    header.version = TL_HULL_VERSION;
    header.vertex_count = q->vertex_count;
    header.face_count = q->f_count;
    header.half_edge_count = q->edge_count;
    tl_hull_layout(&header);
    if (out_size < header.bytes) {
        return TALUS_SMALL_BLOCK;
    }
    memset(out, 0, header.bytes);
    memcpy(out, &header, sizeof header);
    write_points(q, h);
    uint16_t *vertex_edge = (uint16_t *)(void *)((unsigned char *)out + header.vertex_edge);
    uint16_t *face_edge = (uint16_t *)(void *)((unsigned char *)out + header.face_edge);
    memcpy((unsigned char *)out + header.edges, q->edge, q->edge_count * sizeof *q->edge);
    for (uint32_t e = q->edge_count; e-- > 0u;) {
        vertex_edge[q->edge[e].origin] = (uint16_t)e;
    }
    for (uint32_t f = 0u; f < q->f_count; ++f) {
        face_edge[f] = (uint16_t)q->f[f].first;
        write_plane(q, h, f);
    }
    tl_hull_fill_directions(h);
    tl_hull_derive(h, &header);
    memcpy(out, &header, sizeof header);
    h->checksum = tl_hull_checksum(out, h->bytes);
    if (!tl_hull_has_mass(h)) {
        return TALUS_BAD_SHAPE;
    }
    talus_status status = talus_hull_validate(out, h->bytes);
    if (status == TALUS_OK) {
        *size = h->bytes;
    }
    return status;
}
