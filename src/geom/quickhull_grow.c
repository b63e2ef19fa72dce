/* Growth of the triangulated hull, one far point at a time: the triangles that see the point make place for the cone
 * from their outline to it. Source: Barber, Dobkin, Huhdanpaa, ACM TOMS 22(4), 1996, section 2. The sign of every
 * visibility is exact (integers), so the triangles that see a point are a disk and no step can fail. Points that stand
 * out by no more than the tolerance are kept at hand until the end, when those that lie far from the surface all the
 * same (beyond a sharp edge) are added. Units: lattice units (quickhull.h). */
#include "geom/quickhull.h"

#define SPLIT ((int64_t)1 << 30)
#define NEAR_SEARCH 64u /* triangles looked at for the one nearest to a point that was left out */

int tl_qh_side(const tl_qh *q, const tl_qh_triangle *t, uint32_t point) {
    tl_d3 d = tl_d_sub(q->p[point], q->p[t->v[0]]);
    int64_t v[3] = {(int64_t)d.x, (int64_t)d.y, (int64_t)d.z};
    /* n is below 2^60 and v at most 2^29: the product is taken in two parts, split at 2^30. */
    int64_t high = 0, low = 0;
    for (int i = 0; i < 3; ++i) {
        int64_t h = t->n[i] / SPLIT;
        high += h * v[i];
        low += (t->n[i] - h * SPLIT) * v[i];
    }
    high += low / SPLIT;
    low = low % SPLIT;
    return high != 0 ? (high > 0) - (high < 0) : (low > 0) - (low < 0);
}

static void work_add(tl_qh *q, uint32_t i) {
    tl_qh_triangle *t = &q->t[i];
    t->queued = 1u;
    t->before = q->work_last;
    t->after = TL_QH_NONE;
    if (q->work_last == TL_QH_NONE) {
        q->work_first = i;
    } else {
        q->t[q->work_last].after = i;
    }
    q->work_last = i;
}

static void work_remove(tl_qh *q, uint32_t i) {
    tl_qh_triangle *t = &q->t[i];
    if (!t->queued) {
        return;
    }
    t->queued = 0u;
    if (t->before == TL_QH_NONE) {
        q->work_first = t->after;
    } else {
        q->t[t->before].after = t->after;
    }
    if (t->after == TL_QH_NONE) {
        q->work_last = t->before;
    } else {
        q->t[t->after].before = t->before;
    }
}

static uint32_t triangle_new(tl_qh *q, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t i = q->t_free;
    if (i != TL_QH_NONE) {
        q->t_free = q->t[i].after;
    } else {
        i = q->t_used++;
    }
    tl_qh_triangle *t = &q->t[i];
    tl_d3 u = tl_d_sub(q->p[b], q->p[a]), v = tl_d_sub(q->p[c], q->p[a]);
    int64_t ux = (int64_t)u.x, uy = (int64_t)u.y, uz = (int64_t)u.z;
    int64_t vx = (int64_t)v.x, vy = (int64_t)v.y, vz = (int64_t)v.z;
    t->n[0] = uy * vz - uz * vy;
    t->n[1] = uz * vx - ux * vz;
    t->n[2] = ux * vy - uy * vx;
    t->unit = tl_d((double)t->n[0], (double)t->n[1], (double)t->n[2]);
    t->length = tl_d_length(t->unit);
    t->unit = tl_d_scale(t->unit, 1.0 / t->length);
    t->v[0] = a, t->v[1] = b, t->v[2] = c;
    t->outside = t->best = TL_QH_NONE;
    t->best_height = 0.0;
    t->mark = 0u;
    t->facet = TL_QH_NONE;
    t->level = 0u;
    t->alive = 1u;
    t->queued = 0u;
    return i;
}

static void triangle_free(tl_qh *q, uint32_t i) {
    work_remove(q, i);
    q->t[i].alive = 0u;
    q->t[i].after = q->t_free;
    q->t_free = i;
}

static void put_outside(tl_qh *q, tl_qh_triangle *t, uint32_t point, double height) {
    q->next[point] = t->outside;
    t->outside = point;
    /* Of points at one height the first given one, so that of equal points the first becomes the vertex. */
    if (height > t->best_height || (height == t->best_height && point < t->best)) {
        t->best_height = height;
        t->best = point;
    }
}

/* Hands the points of a list to the triangles they stand highest above; those above none are inside for good. */
static void part(tl_qh *q, uint32_t list, const uint32_t *triangles, uint32_t n) {
    while (list != TL_QH_NONE) {
        uint32_t following = q->next[list];
        uint32_t best = TL_QH_NONE;
        double height = 0.0;
        for (uint32_t i = 0u; i < n; ++i) {
            double h = tl_qh_height(q, &q->t[triangles[i]], list);
            if (h > height) {
                height = h;
                best = triangles[i];
            }
        }
        if (best != TL_QH_NONE) {
            put_outside(q, &q->t[best], list, height);
        }
        list = following;
    }
    for (uint32_t i = 0u; i < n; ++i) {
        if (q->t[triangles[i]].best_height > q->tolerance) {
            work_add(q, triangles[i]);
        }
    }
}

/* Lists in list_a the triangles that see the point, of which `seed` is one, and in list_b the half-edges across their
 * outline. Returns how many triangles. */
static uint32_t visible(tl_qh *q, uint32_t point, uint32_t seed, uint32_t *outline_count) {
    uint32_t n = 0u, outline = 0u, epoch = ++q->epoch;
    q->t[seed].mark = epoch;
    q->list_a[n++] = seed;
    for (uint32_t i = 0u; i < n; ++i) {
        for (uint32_t k = 0u; k < 3u; ++k) {
            uint32_t across = q->t[q->list_a[i]].twin[k];
            tl_qh_triangle *t = &q->t[across / 3u];
            if (t->mark == epoch) {
                continue;
            }
            if (tl_qh_side(q, t, point) > 0) {
                t->mark = epoch;
                q->list_a[n++] = across / 3u;
            } else {
                q->list_b[outline++] = across;
            }
        }
    }
    *outline_count = outline;
    return n;
}

static void add_point(tl_qh *q, uint32_t point, uint32_t seed) {
    uint32_t outline, n = visible(q, point, seed, &outline);
    uint32_t orphans = TL_QH_NONE;
    for (uint32_t i = 0u; i < n; ++i) {
        tl_qh_triangle *t = &q->t[q->list_a[i]];
        for (uint32_t p = t->outside; p != TL_QH_NONE;) {
            uint32_t following = q->next[p];
            if (p != point) {
                q->next[p] = orphans;
                orphans = p;
            }
            p = following;
        }
        triangle_free(q, q->list_a[i]);
    }
    for (uint32_t i = 0u; i < outline; ++i) {
        uint32_t across = q->list_b[i];
        uint32_t w = tl_qh_origin(q, across), u = tl_qh_origin(q, tl_qh_next_edge(across));
        uint32_t t = triangle_new(q, u, w, point);
        q->t[t].twin[0] = across;
        q->t[across / 3u].twin[across % 3u] = 3u * t;
        q->at[u] = t;
        q->list_b[i] = t;
    }
    for (uint32_t i = 0u; i < outline; ++i) {
        uint32_t t = q->list_b[i], t2 = q->at[q->t[t].v[1]];
        q->t[t].twin[1] = 3u * t2 + 2u;
        q->t[t2].twin[2] = 3u * t + 1u;
    }
    part(q, orphans, q->list_b, outline);
}

static double distance2(const tl_qh *q, uint32_t a, uint32_t b) {
    tl_d3 d = tl_d_sub(q->p[a], q->p[b]);
    return tl_d_dot(d, d);
}

static double axis(tl_d3 p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; }

/* The two of the six points extreme along the axes that are furthest apart. */
static void longest(const tl_qh *q, uint32_t pair[2]) {
    uint32_t e[6] = {0u, 0u, 0u, 0u, 0u, 0u};
    for (uint32_t i = 1u; i < q->count; ++i) {
        for (int k = 0; k < 3; ++k) {
            e[2 * k] = axis(q->p[i], k) < axis(q->p[e[2 * k]], k) ? i : e[2 * k];
            e[2 * k + 1] = axis(q->p[i], k) > axis(q->p[e[2 * k + 1]], k) ? i : e[2 * k + 1];
        }
    }
    double best = -1.0;
    for (int i = 0; i < 6; ++i) {
        for (int j = i + 1; j < 6; ++j) {
            double d = distance2(q, e[i], e[j]);
            if (d > best) {
                best = d;
                pair[0] = e[i], pair[1] = e[j];
            }
        }
    }
}

/* Four points that span a volume, or 0 if all points lie within `flat` of a plane. */
static int first_four(tl_qh *q, uint32_t v[4]) {
    longest(q, v);
    tl_d3 along = tl_d_sub(q->p[v[1]], q->p[v[0]]);
    double length = tl_d_length(along), best = 0.0;
    if (!(length > 0.0)) {
        return 0;
    }
    for (uint32_t i = 0u; i < q->count; ++i) {
        tl_d3 c = tl_d_cross(along, tl_d_sub(q->p[i], q->p[v[0]]));
        double d = tl_d_dot(c, c);
        if (d > best) {
            best = d;
            v[2] = i;
        }
    }
    if (!(tl_d_sqrt(best) > q->flat * length)) {
        return 0;
    }
    tl_d3 n = tl_d_cross(along, tl_d_sub(q->p[v[2]], q->p[v[0]]));
    n = tl_d_scale(n, 1.0 / tl_d_length(n));
    double low = 0.0, high = 0.0;
    uint32_t at_low = v[0], at_high = v[0];
    for (uint32_t i = 0u; i < q->count; ++i) {
        double h = tl_d_dot(n, tl_d_sub(q->p[i], q->p[v[0]]));
        if (h < low) {
            low = h;
            at_low = i;
        }
        if (h > high) {
            high = h;
            at_high = i;
        }
    }
    if (!(high - low > q->flat)) {
        return 0;
    }
    /* Thin hulls are told apart more finely, down to what the lattice can say. */
    q->tolerance = tl_d_min(q->tolerance, (high - low) / 16.0);
    v[3] = high > -low ? at_high : at_low;
    return 1;
}

/* The first tetrahedron and every other point's place above it. */
static int begin(tl_qh *q) {
    uint32_t v[4] = {0u, 0u, 0u, 0u};
    q->t_free = q->work_first = q->work_last = TL_QH_NONE;
    if (!first_four(q, v)) {
        return 0;
    }
    uint32_t base = triangle_new(q, v[0], v[1], v[2]);
    int side = tl_qh_side(q, &q->t[base], v[3]);
    if (side == 0) {
        return 0;
    }
    if (side > 0) {
        q->t_used = 0u;
        uint32_t swap = v[1];
        v[1] = v[2], v[2] = swap;
        triangle_new(q, v[0], v[1], v[2]);
    }
    triangle_new(q, v[1], v[0], v[3]);
    triangle_new(q, v[2], v[1], v[3]);
    triangle_new(q, v[0], v[2], v[3]);
    for (uint32_t i = 0u; i < 3u; ++i) {
        q->t[0].twin[i] = 3u * (i + 1u);
        q->t[i + 1u].twin[0] = i;
        q->t[i + 1u].twin[2] = 3u * ((i + 1u) % 3u + 1u) + 1u;
        q->t[(i + 1u) % 3u + 1u].twin[1] = 3u * (i + 1u) + 2u;
    }
    uint32_t all[4] = {0u, 1u, 2u, 3u}, list = TL_QH_NONE;
    for (uint32_t i = q->count; i-- > 0u;) {
        q->next[i] = list;
        list = i;
    }
    part(q, list, all, 4u);
    return 1;
}

static void run(tl_qh *q) {
    while (q->work_first != TL_QH_NONE) {
        uint32_t t = q->work_first;
        add_point(q, q->t[t].best, t);
    }
}

/* The squared distance from a point above a triangle's plane to the triangle. */
static double triangle_distance2(const tl_qh *q, const tl_qh_triangle *t, uint32_t point) {
    tl_d3 p = q->p[point];
    double best = -1.0;
    for (uint32_t i = 0u; i < 3u; ++i) {
        tl_d3 a = q->p[t->v[i]], b = q->p[t->v[(i + 1u) % 3u]];
        tl_d3 inward = tl_d_cross(t->unit, tl_d_sub(b, a));
        if (tl_d_dot(inward, tl_d_sub(p, a)) < 0.0) {
            double d = tl_qh_segment2(p, a, b);
            best = best < 0.0 || d < best ? d : best;
        }
    }
    if (best < 0.0) {
        double h = tl_qh_height(q, t, point);
        best = h * h;
    }
    return best;
}

/* Whether a point above triangle `seed` is as near to the surface as the tolerance allows. */
static int is_near(tl_qh *q, uint32_t point, uint32_t seed) {
    uint32_t n = 0u, epoch = ++q->epoch;
    double limit = 4.0 * q->tolerance * q->tolerance;
    q->t[seed].mark = epoch;
    q->list_a[n++] = seed;
    for (uint32_t i = 0u; i < n; ++i) {
        const tl_qh_triangle *t = &q->t[q->list_a[i]];
        if (triangle_distance2(q, t, point) <= limit) {
            return 1;
        }
        for (uint32_t k = 0u; k < 3u && n < NEAR_SEARCH; ++k) {
            uint32_t across = t->twin[k] / 3u;
            if (q->t[across].mark != epoch && tl_qh_height(q, &q->t[across], point) > 0.0) {
                q->t[across].mark = epoch;
                q->list_a[n++] = across;
            }
        }
    }
    return 0;
}

/* Adds one point of triangle t's list that is far from the surface; false if there is none. */
static int add_far(tl_qh *q, uint32_t t) {
    for (uint32_t p = q->t[t].outside; p != TL_QH_NONE; p = q->next[p]) {
        if (tl_qh_side(q, &q->t[t], p) > 0 && !is_near(q, p, t)) {
            add_point(q, p, t);
            run(q);
            return 1;
        }
    }
    return 0;
}

int tl_qh_grow(tl_qh *q) {
    if (!begin(q)) {
        return 0;
    }
    run(q);
    for (int again = 1; again;) {
        again = 0;
        for (uint32_t t = 0u; t < q->t_used; ++t) {
            if (q->t[t].alive) {
                again |= add_far(q, t);
            }
        }
    }
    return 1;
}
