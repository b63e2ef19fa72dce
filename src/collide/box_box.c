/* Two boxes: the 15 separating axes (Gottschalk, Lin & Manocha, OBBTree, 1996, section 5), then the corners of one face
 * clipped in the plane of the other. The axis of the last query is tried first. Metres, in A's frame. */
#include "collide/points.h"
#include "collide/polyhedra.h"

/* r[i][j] is axis j of B along axis i of A; everything else by axis number. */
typedef struct boxes {
    float ha[3], hb[3], t[3], r[3][3], abs_r[3][3];
    float tb[3]; /* from A's centre to B's in B's frame */
} boxes;

/* Axis 0..2 a face of A, 3..5 a face of B, 6 + 3 i + j the edges i of A and j of B. */
typedef struct box_axis {
    int number;
    float separation;
    float sign; /* -1 where the axis looks from B to A */
} box_axis;

static void set_boxes(const tl_core *a, const tl_core *b, boxes *x) {
    const talus_mat3 *r = &b->r;
    x->ha[0] = a->half.x, x->ha[1] = a->half.y, x->ha[2] = a->half.z;
    x->hb[0] = b->half.x, x->hb[1] = b->half.y, x->hb[2] = b->half.z;
    x->t[0] = b->t.x, x->t[1] = b->t.y, x->t[2] = b->t.z;
    x->r[0][0] = r->x.x, x->r[0][1] = r->y.x, x->r[0][2] = r->z.x;
    x->r[1][0] = r->x.y, x->r[1][1] = r->y.y, x->r[1][2] = r->z.y;
    x->r[2][0] = r->x.z, x->r[2][1] = r->y.z, x->r[2][2] = r->z.z;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            x->abs_r[i][j] = tl_abs(x->r[i][j]);
        }
    }
    for (int j = 0; j < 3; ++j) {
        x->tb[j] = x->t[0] * x->r[0][j] + x->t[1] * x->r[1][j] + x->t[2] * x->r[2][j];
    }
}

static inline float face_a(const boxes *x, int i) {
    return tl_abs(x->t[i]) - x->ha[i] -
           (x->abs_r[i][0] * x->hb[0] + x->abs_r[i][1] * x->hb[1] + x->abs_r[i][2] * x->hb[2]);
}

static inline float face_b(const boxes *x, int j) {
    return tl_abs(x->tb[j]) - x->hb[j] -
           (x->abs_r[0][j] * x->ha[0] + x->abs_r[1][j] * x->ha[1] + x->abs_r[2][j] * x->ha[2]);
}

/* The separation across edges i and j times the sine of their angle; `along` is t along the axis. */
static inline float edges(const boxes *x, int i, int j, float *along) {
    int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1, j1 = j == 2 ? 0 : j + 1, j2 = j == 0 ? 2 : j - 1;
    float ra = x->ha[i1] * x->abs_r[i2][j] + x->ha[i2] * x->abs_r[i1][j];
    /* by the axis itself, not by the entry of r that it would be in a matrix without rounding: the sine may be small */
    float b1 = x->r[i1][j] * x->r[i2][j1] - x->r[i2][j] * x->r[i1][j1];
    float b2 = x->r[i1][j] * x->r[i2][j2] - x->r[i2][j] * x->r[i1][j2];
    float rb = x->hb[j1] * tl_abs(b1) + x->hb[j2] * tl_abs(b2);
    *along = x->t[i2] * x->r[i1][j] - x->t[i1] * x->r[i2][j];
    return tl_abs(*along) - (ra + rb);
}

static inline float edges_sine(const boxes *x, int i, int j) {
    /* of the components across edge i, which have no rounding in common to lose */
    int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
    return sqrtf(x->r[i1][j] * x->r[i1][j] + x->r[i2][j] * x->r[i2][j]);
}

static float separation_along(const boxes *x, uint32_t number) {
    if (number < 3) {
        return face_a(x, (int)number);
    }
    if (number < 6) {
        return face_b(x, (int)number - 3);
    }
    int i = ((int)number - 6) / 3, j = ((int)number - 6) % 3;
    float along, sine = edges_sine(x, i, j), s = edges(x, i, j, &along);
    return sine > 1e-6f ? s / sine : -3e38f;
}

static void best_face(const boxes *x, float bias, box_axis *best) {
    best->number = 0;
    best->separation = face_a(x, 0);
    for (int i = 1; i < 3; ++i) {
        float s = face_a(x, i);
        if (s > best->separation) {
            best->separation = s;
            best->number = i;
        }
    }
    float bar = best->separation + bias;
    for (int j = 0; j < 3; ++j) {
        float s = face_b(x, j);
        if (s > bar) {
            bar = best->separation = s;
            best->number = 3 + j;
        }
    }
    best->sign = (best->number < 3 ? x->t[best->number] : x->tb[best->number - 3]) < 0.0f ? -1.0f : 1.0f;
}

static void best_edges(const boxes *x, float bias, box_axis *best) {
    float bar = best->separation + bias;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            float along, s = edges(x, i, j, &along);
            /* dividing by the sine takes it away from 0 */
            if (s < 0.0f && s <= bar) {
                continue;
            }
            float sine = edges_sine(x, i, j);
            if (sine > 1e-6f && s > bar * sine) {
                bar = best->separation = s / sine;
                best->number = 6 + 3 * i + j;
                best->sign = along < 0.0f ? -1.0f : 1.0f;
            }
        }
    }
}

static talus_vec3 axis_normal(const tl_core *b, const boxes *x, const box_axis *axis) {
    float n[3] = {0.0f, 0.0f, 0.0f};
    if (axis->number < 3) {
        n[axis->number] = axis->sign;
    } else if (axis->number < 6) {
        talus_vec3 m = axis->number == 3 ? b->r.x : axis->number == 4 ? b->r.y : b->r.z;
        return tl_scale(m, axis->sign);
    } else {
        int i = (axis->number - 6) / 3, j = (axis->number - 6) % 3;
        int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
        n[i1] = -axis->sign * x->r[i2][j];
        n[i2] = axis->sign * x->r[i1][j];
        return tl_normalize_or(tl_v(n[0], n[1], n[2]), tl_v(0.0f, 1.0f, 0.0f));
    }
    return tl_v(n[0], n[1], n[2]);
}

/* Two faces: which box each is of, and their numbers. */
typedef struct face_pair {
    int ref_is_a;
    int axis, axis_x, axis_y; /* of the reference */
    int positive;
    int inc, inc_u, inc_v; /* axes of the incident box */
    int inc_positive;
} face_pair;

/* The number of the incident corner at the start of edge k; corners go round as +u+v, -u+v, -u-v, +u-v. */
static uint32_t incident_corner(const face_pair *f, uint32_t k) {
    uint32_t u = k == 0u || k == 3u, v = k < 2u;
    return (f->inc_positive ? 1u : 0u) << f->inc | u << f->inc_u | v << f->inc_v;
}

static uint32_t edge_number(uint32_t p, uint32_t q) {
    uint32_t bit = p ^ q;
    return (p & q) + (bit == 1u ? 0u : bit == 2u ? 8u : 16u);
}

/* Side 0 +x, 1 -x, 2 +y, 3 -y of the reference face, as an edge of its box. */
static uint32_t side_number(const face_pair *f, uint32_t side) {
    uint32_t base = (f->positive ? 1u : 0u) << f->axis;
    uint32_t across = side < 2u ? 1u << f->axis_x : 1u << f->axis_y,
             along = side < 2u ? 1u << f->axis_y : 1u << f->axis_x;
    uint32_t p = base | ((side & 1u) ? 0u : across);
    return edge_number(p, p | along);
}

/* A clipped face in the plane of the reference: x and y across it, z in front of it. */
typedef struct face_point {
    float x, y, z;
    uint32_t id;
    uint32_t label; /* of the edge to the next point: 0..3 the incident's, 4..7 the reference's sides +x -x +y -y */
} face_point;

#define FACE_POINTS 8

/* The number of the point where the edge `label` of the clipped face crosses a side. */
static uint32_t crossing_number(const face_pair *f, uint32_t label, uint32_t side) {
    if (label >= 4u) {
        uint32_t x = label < 6u ? label - 4u : side, y = label < 6u ? side : label - 4u;
        uint32_t corner =
            (f->positive ? 1u : 0u) << f->axis | (x == 0u ? 1u : 0u) << f->axis_x | (y == 2u ? 1u : 0u) << f->axis_y;
        return tl_point_id(f->ref_is_a ? TL_ID_VERTEX_A : TL_ID_VERTEX_B, corner, 0);
    }
    uint32_t edge = edge_number(incident_corner(f, label), incident_corner(f, (label + 1u) & 3u));
    uint32_t own = side_number(f, side);
    return tl_point_id(TL_ID_EDGES, f->ref_is_a ? own : edge, f->ref_is_a ? edge : own);
}

/* Keeps what has sign * (x or y) <= limit. A point up to `band` outside is kept, and stands for the crossing beside it.
 */
static uint32_t cut_side(const face_pair *f, const face_point *in, uint32_t count, face_point *out, uint32_t side,
                         float limit, float band) {
    float d[FACE_POINTS];
    uint32_t kept = 0;
    for (uint32_t k = 0; k < count; ++k) {
        float v = side < 2u ? in[k].x : in[k].y;
        d[k] = limit - ((side & 1u) ? -v : v);
    }
    for (uint32_t k = 0; k < count; ++k) {
        uint32_t next = k + 1u < count ? k + 1u : 0u;
        int here = d[k] >= -band, there = d[next] >= -band;
        if (here && kept < FACE_POINTS) {
            out[kept] = in[k];
            out[kept++].label = there || d[k] > 0.0f ? in[k].label : 4u + side;
        }
        if (here != there && (here ? d[k] : d[next]) > 0.0f && kept < FACE_POINTS) {
            float t = d[k] / (d[k] - d[next]);
            out[kept].x = in[k].x + t * (in[next].x - in[k].x);
            out[kept].y = in[k].y + t * (in[next].y - in[k].y);
            out[kept].z = in[k].z + t * (in[next].z - in[k].z);
            out[kept].id = crossing_number(f, in[k].label, side);
            out[kept++].label = here ? 4u + side : in[k].label;
        }
    }
    return kept;
}

/* The manifold of a face of one box and the face of the other that looks at it the most. */
static void face_manifold(const tl_core *a, const tl_core *b, const boxes *x, const box_axis *axis, talus_vec3 n,
                          float margin, tl_manifold *out) {
    face_pair f;
    float row[3], c[3], m[3][3]; /* of the incident box in the reference's frame: m[i][j] its axis j along i */
    f.ref_is_a = axis->number < 3;
    f.axis = f.ref_is_a ? axis->number : axis->number - 3;
    f.axis_x = f.axis == 2 ? 0 : f.axis + 1;
    f.axis_y = f.axis == 0 ? 2 : f.axis - 1;
    for (int i = 0; i < 3; ++i) {
        c[i] = f.ref_is_a ? x->t[i] : -x->tb[i];
        for (int j = 0; j < 3; ++j) {
            m[i][j] = f.ref_is_a ? x->r[i][j] : x->r[j][i];
        }
    }
    const float *h = f.ref_is_a ? x->ha : x->hb, *g = f.ref_is_a ? x->hb : x->ha;
    float outward = f.ref_is_a ? axis->sign : -axis->sign;
    f.positive = outward > 0.0f;
    row[0] = tl_abs(m[f.axis][0]), row[1] = tl_abs(m[f.axis][1]), row[2] = tl_abs(m[f.axis][2]);
    f.inc = row[0] >= row[1] ? (row[0] >= row[2] ? 0 : 2) : (row[1] >= row[2] ? 1 : 2);
    f.inc_u = f.inc == 2 ? 0 : f.inc + 1;
    f.inc_v = f.inc == 0 ? 2 : f.inc - 1;
    f.inc_positive = m[f.axis][f.inc] * outward < 0.0f;
    int ix = f.axis_x, iy = f.axis_y, iz = f.axis;
    float hi = f.inc_positive ? g[f.inc] : -g[f.inc], hu = g[f.inc_u], hv = g[f.inc_v];
    float cx = c[ix] + m[ix][f.inc] * hi, cy = c[iy] + m[iy][f.inc] * hi;
    float cz = outward * (c[iz] + m[iz][f.inc] * hi) - h[iz];
    float ux = m[ix][f.inc_u] * hu, uy = m[iy][f.inc_u] * hu, uz = outward * m[iz][f.inc_u] * hu;
    float vx = m[ix][f.inc_v] * hv, vy = m[iy][f.inc_v] * hv, vz = outward * m[iz][f.inc_v] * hv;
    face_point buffer[2][FACE_POINTS] = {{{cx + ux + vx, cy + uy + vy, cz + uz + vz, 0, 0},
                                          {cx - ux + vx, cy - uy + vy, cz - uz + vz, 0, 1},
                                          {cx - ux - vx, cy - uy - vy, cz - uz - vz, 0, 2},
                                          {cx + ux - vx, cy + uy - vy, cz + uz - vz, 0, 3}}};
    uint32_t count = 4, at = 0, kind = f.ref_is_a ? TL_ID_VERTEX_B : TL_ID_VERTEX_A;
    for (uint32_t k = 0; k < 4; ++k) {
        buffer[0][k].id = tl_point_id(kind, incident_corner(&f, k), 0);
    }
    float band = TL_SIDE_SLACK * 2.0f * tl_min(tl_min(h[ix], h[iy]), tl_min(hu, hv));
    float lx = h[ix] + band, ly = h[iy] + band, ex = tl_abs(ux) + tl_abs(vx), ey = tl_abs(uy) + tl_abs(vy);
    int crossed[4] = {cx + ex > lx, ex - cx > lx, cy + ey > ly, ey - cy > ly};
    for (uint32_t side = 0; side < 4; ++side) {
        if (crossed[side]) {
            count = cut_side(&f, buffer[at], count, buffer[1u - at], side, side < 2u ? h[ix] : h[iy], band);
            at = 1u - at;
        }
    }
    tl_candidate candidates[FACE_POINTS];
    uint32_t kept = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const face_point *q = &buffer[at][k];
        if (q->z > margin) {
            continue;
        }
        float p[3];
        p[ix] = q->x;
        p[iy] = q->y;
        p[iz] = outward * (h[iz] + 0.5f * q->z);
        tl_candidate *o = &candidates[kept++];
        o->p = tl_v(p[0], p[1], p[2]);
        o->p = f.ref_is_a ? o->p : tl_core_place(b, o->p);
        o->gap = q->z;
        o->id = q->id;
    }
    if (kept > TL_MANIFOLD_POINTS) {
        kept = tl_candidates_reduce(candidates, kept, n, tl_touch_tolerance(a, b));
    }
    tl_touch touch;
    touch.normal = n;
    touch.separation = axis->separation;
    tl_candidates_write(candidates, kept, &touch, out);
}

/* Whether some face of the other box is within 1.5 degrees of a face axis. */
static int is_flush(const boxes *x, int number) {
    float c[3];
    for (int k = 0; k < 3; ++k) {
        c[k] = number < 3 ? x->abs_r[number][k] : x->abs_r[k][number - 3];
    }
    return tl_max(c[0], tl_max(c[1], c[2])) > 0.99966f;
}

static int edge_manifold(const tl_core *a, const tl_core *b, const box_axis *axis, talus_vec3 n, float margin,
                         float tolerance, tl_manifold *out) {
    tl_touch touch;
    tl_feature fa, fb;
    uint32_t ia = 0, ib = 0, i = (uint32_t)(axis->number - 6) / 3u, j = (uint32_t)(axis->number - 6) % 3u;
    tl_core_support_local(a, n, &ia);
    tl_core_support_local(b, tl_core_rotate_back(b, tl_neg(n)), &ib);
    touch.normal = n;
    touch.separation = axis->separation;
    tl_feature_find(a, n, 1, &fa);
    tl_feature_find(b, tl_neg(n), 1, &fb);
    if (fa.count >= 3 || fb.count >= 3) {
        if (fa.count < 3) {
            tl_feature_find(a, n, 0, &fa);
        }
        if (fb.count < 3) {
            tl_feature_find(b, tl_neg(n), 0, &fb);
        }
    } else {
        tl_feature_edge(a, ia & ~(1u << i), ia | 1u << i, 0, &fa);
        tl_feature_edge(b, ib & ~(1u << j), ib | 1u << j, 0, &fb);
    }
    tl_manifold_build(&fa, &fb, &touch, margin, tolerance, out);
    return tl_is_realised(out, axis->separation, tolerance);
}

void tl_collide_boxes(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    boxes x;
    box_axis axis;
    tl_pair_cache past = *cache;
    set_boxes(a, b, &x);
    uint32_t last = (cache->word[0] ^ TL_CACHE_BOXES) & 0xffffu;
    out->count = 0;
    out->normal = tl_v(0.0f, 1.0f, 0.0f);
    if (last < 15u) {
        out->gap = separation_along(&x, last);
        if (out->gap > margin) {
            return;
        }
    }
    if (cache->word[0] == TL_CACHE_AXIS) {
        uint32_t ia = 0, ib = 0;
        talus_vec3 va, vb, n = tl_cache_axis(cache, out->normal);
        out->gap = tl_core_separation(a, b, n, &ia, &ib, &va, &vb);
        if (out->gap > margin) {
            return;
        }
    }
    float tolerance = tl_touch_tolerance(a, b);
    best_face(&x, tolerance, &axis);
    cache->word[0] = TL_CACHE_BOXES ^ (uint32_t)axis.number;
    out->gap = axis.separation;
    if (axis.separation > margin) {
        return;
    }
    talus_vec3 n = axis_normal(b, &x, &axis);
    if (axis.separation > 0.0f) {
        face_manifold(a, b, &x, &axis, n, margin, out);
        if (tl_is_realised(out, axis.separation, tolerance)) {
            return;
        }
    }
    int face = axis.number, built = 0;
    if (axis.separation <= 0.0f && is_flush(&x, face)) {
        face_manifold(a, b, &x, &axis, n, margin, out);
        if (tl_is_proven(out, axis.separation, b->t)) {
            return;
        }
        built = 1;
    }
    best_edges(&x, tolerance - 2e-5f * tl_min(axis.separation, 0.0f), &axis);
    if (axis.number != face) {
        cache->word[0] = TL_CACHE_BOXES ^ (uint32_t)axis.number;
        if (axis.separation > margin) {
            out->count = 0;
            out->gap = axis.separation;
            return;
        }
        n = axis_normal(b, &x, &axis);
        if (edge_manifold(a, b, &axis, n, margin, tolerance, out)) {
            return;
        }
    } else if (axis.separation <= 0.0f) {
        if (!built) {
            face_manifold(a, b, &x, &axis, n, margin, out);
        }
        if (out->count > 0) {
            return;
        }
    }
    *cache = past;
    if (!tl_cache_has_simplex(cache)) {
        tl_cache_keep_axis(cache, n);
    }
    tl_collide_general(a, b, margin, cache, out);
}
