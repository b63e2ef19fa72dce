/* The convex hull of points, as a blob of convex polygons.
 * Source: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull algorithm for convex hulls", ACM TOMS 22(4), 1996;
 * the choice of tolerance and of the first tetrahedron after D. Gregorius, "Implementing Quickhull", GDC 2014. Unlike
 * both, the triangles are grown on integers with exact signs, and faces are merged once, at the end, where each merge
 * may be declined: no merge has to succeed for the hull to be sound. Units: metres in and out, lattice units
 * (quickhull.h) within. */
#include "geom/quickhull.h"

#include "geom/hull_derive.h"

#include <string.h>

#define LATTICE 268435456.0 /* 2^28 */
#define LOCAL_ROUNDS 6u     /* of merging more finely only where it was at fault */
#define MERGE_ROUNDS (LOCAL_ROUNDS + TL_QH_EXACT + 1u)

static size_t aligned(size_t bytes) { return (bytes + 31u) / 32u * 32u; }

static uint32_t triangle_capacity(uint32_t count) { return 2u * count + 8u; }

static uint32_t edge_capacity(uint32_t count) {
    uint32_t vertices = count < TALUS_HULL_MAX_VERTICES ? count : TALUS_HULL_MAX_VERTICES;
    return 6u * vertices + 8u;
}

size_t talus_hull_scratch_size(uint32_t count) {
    if (count > TALUS_HULL_MAX_POINTS) {
        count = TALUS_HULL_MAX_POINTS;
    }
    size_t n = count, t = triangle_capacity(count);
    return aligned(n * sizeof(tl_d3)) + 2u * aligned(n * sizeof(uint32_t)) + aligned(t * sizeof(tl_qh_triangle)) +
           3u * aligned(t * sizeof(uint32_t)) + aligned(t * sizeof(double)) + aligned(t * sizeof(uint64_t)) +
           aligned(3u * t * sizeof(uint32_t)) + aligned(t * sizeof(tl_qh_facet)) +
           aligned(edge_capacity(count) * sizeof(tl_half_edge));
}

size_t talus_hull_max_size(uint32_t count) {
    talus_hull h;
    memset(&h, 0, sizeof h);
    h.vertex_count = count < 4u ? 4u : count < TALUS_HULL_MAX_VERTICES ? count : TALUS_HULL_MAX_VERTICES;
    h.face_count = 2u * h.vertex_count - 4u;
    h.half_edge_count = 6u * h.vertex_count - 12u;
    tl_hull_layout(&h);
    return h.bytes;
}

static void *take(unsigned char **at, size_t bytes) {
    void *p = *at;
    *at += aligned(bytes);
    return p;
}

static void lay_out(tl_qh *q, const talus_vec3 *points, uint32_t count, void *scratch) {
    unsigned char *at = scratch;
    size_t n = count, t = triangle_capacity(count);
    memset(q, 0, sizeof *q);
    q->input = points;
    q->count = count;
    q->t_capacity = triangle_capacity(count);
    q->p = take(&at, n * sizeof(tl_d3));
    q->next = take(&at, n * sizeof(uint32_t));
    q->at = take(&at, n * sizeof(uint32_t));
    q->t = take(&at, t * sizeof(tl_qh_triangle));
    q->list_a = take(&at, t * sizeof(uint32_t));
    q->list_b = take(&at, t * sizeof(uint32_t));
    q->list_c = take(&at, t * sizeof(uint32_t));
    q->depth = take(&at, t * sizeof(double));
    q->keys = take(&at, t * sizeof(uint64_t));
    q->edge_id = take(&at, 3u * t * sizeof(uint32_t));
    q->f = take(&at, t * sizeof(tl_qh_facet));
    q->edge = take(&at, edge_capacity(count) * sizeof(tl_half_edge));
}

static double to_integer(double x) { return x < 0.0 ? (double)(int64_t)(x - 0.5) : (double)(int64_t)(x + 0.5); }

/* Rounds the points to the lattice. The scale is a power of two, so that points given on a lattice of their own stay on
 * one, and with them the planes they share. */
static int snap(tl_qh *q) {
    talus_vec3 low = q->input[0], high = q->input[0];
    for (uint32_t i = 1u; i < q->count; ++i) {
        low = tl_min3(low, q->input[i]);
        high = tl_max3(high, q->input[i]);
    }
    tl_d3 a = tl_d_from(low), b = tl_d_from(high), extent = tl_d_sub(b, a);
    double half = 0.5 * tl_d_max(extent.x, tl_d_max(extent.y, extent.z));
    if (!(half > 0.0)) {
        return 0;
    }
    double scale = 1.0;
    while (half * scale > LATTICE) {
        scale *= 0.5;
    }
    while (half * scale * 2.0 <= LATTICE) {
        scale *= 2.0;
    }
    /* The middle is rounded to a float and then to the lattice, for the same reason. */
    tl_d3 middle = tl_d_from(tl_d_round(tl_d_scale(tl_d_add(a, b), 0.5)));
    for (uint32_t i = 0u; i < q->count; ++i) {
        tl_d3 d = tl_d_scale(tl_d_sub(tl_d_from(q->input[i]), middle), scale);
        q->p[i] = tl_d(to_integer(d.x), to_integer(d.y), to_integer(d.z));
    }
    q->unit = 1.0 / scale;
    /* 2^-20 of the half extent, and a rounding of the coordinates as they were given: 2^-22 of the largest. */
    tl_d3 reach = tl_d_from(tl_max3(tl_abs3(low), tl_abs3(high)));
    double largest = tl_d_max(reach.x, tl_d_max(reach.y, reach.z));
    q->tolerance = (half / 1048576.0 + largest / 4194304.0) * scale;
    /* 2^-21 of the extent or of the largest coordinate: what turning a flat set in floats leaves of its flatness. */
    q->flat = tl_d_max(2.0 * half, largest) / 2097152.0 * scale;
    return 1;
}

/* Merges and writes, more finely where that did not make a polyhedron. What is exactly flat on the lattice always does.
 */
static talus_status finish(tl_qh *q, void *out, size_t out_size, size_t *size) {
    talus_status status = TALUS_FLAT_HULL;
    for (uint32_t round = 0u; round < MERGE_ROUNDS; ++round) {
        int marked = 0;
        tl_qh_merge(q);
        status = tl_qh_outline(q, &marked);
        if (status == TALUS_OK) {
            tl_qh_order(q);
            status = tl_qh_write(q, out, out_size, size);
        }
        if (status != TALUS_FLAT_HULL && status != TALUS_BAD_BLOB) {
            return status;
        }
        if (!marked || round >= LOCAL_ROUNDS) {
            if (!tl_qh_refine(q)) {
                return status;
            }
        }
    }
    return status;
}

talus_status talus_hull_build(const talus_vec3 *points, uint32_t count, void *scratch, size_t scratch_size, void *out,
                              size_t out_size, size_t *size) {
    if (!points || !scratch || !out || !size) {
        return TALUS_BAD_ARGUMENT;
    }
    if (count > TALUS_HULL_MAX_POINTS) {
        return TALUS_TOO_MANY_POINTS;
    }
    if ((uintptr_t)scratch % TALUS_BLOB_ALIGNMENT || (uintptr_t)out % TALUS_BLOB_ALIGNMENT) {
        return TALUS_UNALIGNED;
    }
    if (scratch_size < talus_hull_scratch_size(count)) {
        return TALUS_SMALL_BLOCK;
    }
    for (uint32_t i = 0u; i < count; ++i) {
        if (!tl_is_finite3(points[i])) {
            return TALUS_NOT_FINITE;
        }
    }
    if (count < 4u) {
        return TALUS_FLAT_HULL;
    }
    tl_qh q;
    lay_out(&q, points, count, scratch);
    if (!snap(&q) || !tl_qh_grow(&q)) {
        return TALUS_FLAT_HULL;
    }
    return finish(&q, out, out_size, size);
}
