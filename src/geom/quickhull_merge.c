/* Joining triangles to facets: from the largest triangle down, each gathers the neighbours whose vertices lie within
 * the tolerance below its plane, and the whole is a facet if its outline is one convex loop. Why a loop is to be
 * expected: the seed's plane supports the hull, heights below it are a convex function on the hull, so the vertices not
 * in the band are connected to each other and the gathered triangles are a disk. It is checked anyway, because
 * neighbours may already be part of another facet. Where a check fails a finer tolerance is tried, then exact flatness,
 * then the triangle stays alone. After D. Gregorius, "Implementing Quickhull", GDC 2014, who merges as he goes. Normals
 * are sums of the triangles' area vectors (Newell's normal of the outline), so that a facet's plane, up to the
 * tolerance, still has the whole hull below it.
 * Units: lattice units (quickhull.h). */
#include "geom/quickhull.h"

/* Live triangles by falling area into list_b, equal ones by rising number: merge sort from runs of one, with list_c. */
static uint32_t sort_by_area(tl_qh *q) {
    uint32_t n = 0u;
    for (uint32_t i = 0u; i < q->t_used; ++i) {
        if (q->t[i].alive) {
            q->list_b[n++] = i;
        }
    }
    uint32_t *from = q->list_b, *to = q->list_c;
    for (uint32_t width = 1u; width < n; width *= 2u) {
        for (uint32_t start = 0u; start < n; start += 2u * width) {
            uint32_t middle = start + width < n ? start + width : n;
            uint32_t end = start + 2u * width < n ? start + 2u * width : n;
            uint32_t i = start, j = middle;
            for (uint32_t k = start; k < end; ++k) {
                int left = i < middle && (j >= end || q->t[from[i]].length >= q->t[from[j]].length);
                to[k] = left ? from[i++] : from[j++];
            }
        }
        uint32_t *swap = from;
        from = to, to = swap;
    }
    if (from != q->list_b) {
        for (uint32_t i = 0u; i < n; ++i) {
            q->list_b[i] = from[i];
        }
    }
    return n;
}

/* Gathers into list_a. `band` below 0 asks for exact flatness. Returns how many triangles. */
static uint32_t gather(tl_qh *q, uint32_t seed, double band) {
    uint32_t n = 0u, epoch = ++q->epoch;
    const tl_qh_triangle *s = &q->t[seed];
    q->t[seed].mark = epoch;
    q->list_a[n++] = seed;
    for (uint32_t i = 0u; i < n; ++i) {
        for (uint32_t k = 0u; k < 3u; ++k) {
            uint32_t across = q->t[q->list_a[i]].twin[k];
            tl_qh_triangle *t = &q->t[across / 3u];
            /* Two of its vertices are shared with what is gathered; the third is the one before the half-edge. */
            uint32_t apex = t->v[(across + 2u) % 3u];
            if (t->mark == epoch || t->facet != TL_QH_NONE || t->level > s->level) {
                continue;
            }
            /* Facing much the same way, so that a thin edge is not folded over and lost. */
            if (band < 0.0 ? tl_qh_side(q, s, apex) == 0
                           : tl_qh_height(q, s, apex) >= -band && tl_d_dot(s->unit, t->unit) > 0.25) {
                t->mark = epoch;
                q->list_a[n++] = across / 3u;
            }
        }
    }
    return n;
}

static int inside(const tl_qh *q, uint32_t edge) { return q->t[edge / 3u].mark == q->epoch; }

/* The half-edge after `edge` on the outline of the marked triangles. */
static uint32_t outline_next(const tl_qh *q, uint32_t edge) {
    uint32_t e = tl_qh_next_edge(edge);
    while (inside(q, tl_qh_twin(q, e))) {
        e = tl_qh_next_edge(tl_qh_twin(q, e));
    }
    return e;
}

/* Writes the outline of the n gathered triangles to list_c; 0 if it is not one loop that meets no vertex twice. */
static uint32_t outline(tl_qh *q, uint32_t n) {
    uint32_t boundary = 0u, first = TL_QH_NONE;
    for (uint32_t i = 0u; i < n; ++i) {
        for (uint32_t k = 0u; k < 3u; ++k) {
            uint32_t e = 3u * q->list_a[i] + k;
            q->at[q->t[q->list_a[i]].v[k]] = TL_QH_NONE;
            if (!inside(q, tl_qh_twin(q, e))) {
                ++boundary;
                first = e;
            }
        }
    }
    uint32_t count = 0u, e = first;
    while (first != TL_QH_NONE) {
        uint32_t v = tl_qh_origin(q, e);
        if (q->at[v] != TL_QH_NONE) {
            return 0u;
        }
        q->at[v] = count;
        q->list_c[count++] = e;
        e = outline_next(q, e);
        if (e == first) {
            break;
        }
    }
    return count == boundary ? count : 0u;
}

static tl_d3 normal_of(const tl_qh *q, uint32_t n) {
    tl_d3 sum = tl_d(0.0, 0.0, 0.0);
    for (uint32_t i = 0u; i < n; ++i) {
        const tl_qh_triangle *t = &q->t[q->list_a[i]];
        sum = tl_d_add(sum, tl_d((double)t->n[0], (double)t->n[1], (double)t->n[2]));
    }
    return tl_d_scale(sum, 1.0 / tl_d_length(sum));
}

/* Whether all vertices lie within two bands of each other along n and the triangles around below the highest. */
static int is_flat(const tl_qh *q, uint32_t n, uint32_t count, tl_d3 normal, double band) {
    tl_d3 origin = q->p[tl_qh_origin(q, q->list_c[0])];
    double low = 0.0, high = 0.0;
    for (uint32_t i = 0u; i < n; ++i) {
        for (uint32_t k = 0u; k < 3u; ++k) {
            double h = tl_d_dot(normal, tl_d_sub(q->p[q->t[q->list_a[i]].v[k]], origin));
            low = tl_d_min(low, h);
            high = tl_d_max(high, h);
        }
    }
    if (high - low > 2.0 * band) {
        return 0;
    }
    for (uint32_t i = 0u; i < count; ++i) {
        uint32_t across = tl_qh_twin(q, q->list_c[i]);
        uint32_t apex = q->t[across / 3u].v[(across + 2u) % 3u];
        if (tl_d_dot(normal, tl_d_sub(q->p[apex], origin)) > high + band) {
            return 0;
        }
    }
    return 1;
}

/* Whether the loop in list_c is convex but for dents no deeper than `band`: Graham's walk from a corner that is surely
 * convex; a vertex that is passed over is measured against the chord, on top of what the chord had passed over before.
 */
static int is_convex(tl_qh *q, uint32_t count, tl_d3 normal, double band) {
    tl_d3 origin = q->p[tl_qh_origin(q, q->list_c[0])];
    uint32_t corner = 0u;
    double far = 0.0;
    for (uint32_t i = 1u; i < count; ++i) {
        tl_d3 d = tl_d_sub(q->p[tl_qh_origin(q, q->list_c[i])], origin);
        double l = tl_d_dot(d, d);
        if (l > far) {
            far = l;
            corner = i;
        }
    }
    uint32_t *kept = q->list_a;
    uint32_t top = 0u;
    for (uint32_t i = 0u; i <= count; ++i) {
        uint32_t v = tl_qh_origin(q, q->list_c[(corner + i) % count]);
        double depth = 0.0;
        while (top >= 2u) {
            tl_d3 a = q->p[kept[top - 2u]], b = q->p[kept[top - 1u]], c = q->p[v];
            tl_d3 chord = tl_d_sub(c, a);
            double turn = tl_d_dot(normal, tl_d_cross(tl_d_sub(b, a), chord));
            if (turn > 0.0) {
                break;
            }
            double length = tl_d_length(chord);
            double dent = length > 0.0 ? -turn / length : tl_d_length(tl_d_sub(b, a));
            depth = tl_d_max(depth, q->depth[top - 1u]) + dent;
            if (depth > band) {
                return 0;
            }
            --top;
        }
        kept[top] = v;
        q->depth[top] = depth;
        ++top;
    }
    return top >= 4u;
}

static void make_facet(tl_qh *q, uint32_t edge, tl_d3 normal) {
    tl_qh_facet *f = &q->f[q->f_count++];
    f->normal = normal;
    f->edge = edge;
    f->first = TL_QH_NONE;
    f->bad = 0u;
}

/* Makes a facet of the gathered triangles, if they are fit for one. */
static int accept(tl_qh *q, uint32_t n, double band) {
    uint32_t count = outline(q, n);
    if (count < 3u) {
        return 0;
    }
    tl_d3 normal = normal_of(q, n);
    if (!is_flat(q, n, count, normal, band)) {
        return 0;
    }
    uint32_t facet = q->f_count, first = q->list_a[0];
    if (!is_convex(q, count, normal, band)) {
        return 0;
    }
    /* The walk has overwritten the list; the marks still tell who belongs. */
    uint32_t m = 0u;
    q->list_a[m++] = first;
    q->t[first].facet = facet;
    for (uint32_t i = 0u; i < m; ++i) {
        for (uint32_t k = 0u; k < 3u; ++k) {
            uint32_t across = q->t[q->list_a[i]].twin[k] / 3u;
            if (q->t[across].mark == q->epoch && q->t[across].facet != facet) {
                q->t[across].facet = facet;
                q->list_a[m++] = across;
            }
        }
    }
    make_facet(q, q->list_c[0], normal);
    return 1;
}

int tl_qh_refine(tl_qh *q) {
    int finer = 0;
    for (uint32_t i = 0u; i < q->t_used; ++i) {
        if (q->t[i].alive && q->t[i].level < TL_QH_EXACT) {
            ++q->t[i].level;
            finer = 1;
        }
    }
    return finer;
}

/* Triangles of facets at fault move up a level, and all are free again. */
static void reset(tl_qh *q) {
    for (uint32_t i = 0u; i < q->t_used; ++i) {
        tl_qh_triangle *t = &q->t[i];
        if (t->facet != TL_QH_NONE && q->f[t->facet].bad && t->level < TL_QH_EXACT) {
            ++t->level;
        }
        t->facet = TL_QH_NONE;
    }
    q->f_count = 0u;
}

void tl_qh_merge(tl_qh *q) {
    static const double share[TL_QH_EXACT] = {1.0, 0.0625, 0.00390625};
    reset(q);
    uint32_t live = sort_by_area(q);
    for (uint32_t i = 0u; i < live; ++i) {
        uint32_t seed = q->list_b[i], n = 2u;
        int done = q->t[seed].facet != TL_QH_NONE;
        /* A seed that has no neighbour in the wider band has none in a narrower one. */
        for (uint32_t k = q->t[seed].level; k < TL_QH_EXACT && !done && n > 1u; ++k) {
            n = gather(q, seed, share[k] * q->tolerance);
            done = n > 1u && accept(q, n, share[k] * q->tolerance);
        }
        if (!done && n > 1u) {
            n = gather(q, seed, -1.0);
            /* Half a lattice unit: what rounding makes of heights that are exactly 0. */
            done = n > 1u && accept(q, n, 0.5);
        }
        if (!done) {
            q->t[seed].facet = q->f_count;
            make_facet(q, 3u * seed, q->t[seed].unit);
        }
    }
}
