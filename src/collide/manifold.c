/* Contact points of two features along a normal: the face squarer with the normal is kept whole, the other shape's face
 * or edge is clipped against its sides (Sutherland & Hodgman, Reentrant Polygon Clipping, 1974), and of many points
 * four are kept: one of the deepest, then those that span the most area. Point numbers come from vertices and edges
 * alone, so that they outlive a change of roles. Metres. */
#include "collide/points.h"

#define MAX_CLIP (TL_MANIFOLD_POINTS + TL_MANIFOLD_OTHERS) /* of two faces of TL_FEATURE_POINTS corners */
#define FROM_REFERENCE 0x8000u
#define RIM_ID 0x7ffeu /* the number of the lowest point of a disc */

/* A label is of the edge from each point to the next: the incident's, or the reference's and the bit. */
typedef struct clip_buffer {
    talus_vec3 p[MAX_CLIP];
    uint32_t id[MAX_CLIP];
    uint16_t label[MAX_CLIP];
    uint32_t count;
} clip_buffer;

static float largest(talus_vec3 d) { return tl_max(tl_max(tl_abs(d.x), tl_abs(d.y)), tl_abs(d.z)); }

/* The length of a segment, the width of a polygon, roughly. */
static float extent(const tl_feature *f) {
    if (f->count == 2) {
        return largest(tl_sub(f->point[1], f->point[0]));
    }
    talus_vec3 u = tl_sub(f->point[f->count / 3u], f->point[0]), w = tl_sub(f->point[2u * f->count / 3u], f->point[0]);
    float length = largest(w);
    return length > 0.0f ? largest(tl_cross(u, w)) / length : 0.0f;
}

/* Inside of a side of the reference is where dot(side, x) + offset >= 0, and past the slack where it is >= -band. */
typedef struct side_plane {
    talus_vec3 side;
    float offset, band;
} side_plane;

static side_plane side_of(const tl_feature *f, uint32_t i, talus_vec3 outward, float slack) {
    side_plane s;
    uint32_t j = i + 1u < f->count ? i + 1u : 0u;
    s.side = tl_cross(outward, tl_sub(f->point[j], f->point[i]));
    /* the sum of the sizes stands for the length, within a factor of 1.74 */
    s.band = slack * (tl_abs(s.side.x) + tl_abs(s.side.y) + tl_abs(s.side.z));
    s.offset = -tl_dot(s.side, f->point[i]);
    return s;
}

static float side_distance(const side_plane *s, talus_vec3 x) { return tl_dot(s->side, x) + s->offset; }

/* Two features: which of them is the reference. */
typedef struct feature_pair {
    const tl_feature *ref, *inc;
    int ref_is_a;
} feature_pair;

/* The number of the point where an edge of the clipped polygon crosses side i of the reference. */
static uint32_t crossing_id(const feature_pair *f, uint32_t label, uint32_t i) {
    const tl_feature *ref = f->ref;
    if (!(label & FROM_REFERENCE)) {
        uint32_t re = ref->edge[i], ie = f->inc->edge[label];
        return tl_point_id(TL_ID_EDGES, f->ref_is_a ? re : ie, f->ref_is_a ? ie : re);
    }
    uint32_t j = label & ~FROM_REFERENCE, kind = f->ref_is_a ? TL_ID_VERTEX_A : TL_ID_VERTEX_B;
    uint32_t i_next = i + 1u < ref->count ? i + 1u : 0u, j_next = j + 1u < ref->count ? j + 1u : 0u;
    if (i_next == j || j_next == i) {
        return tl_point_id(kind, ref->vertex[i_next == j ? j : i], 0);
    }
    /* sides that do not follow one another: what lay between them was too small to see */
    return tl_point_id(kind, ref->edge[i], 1u + ref->edge[j]);
}

/* Cuts the polygon by side i; 0 if it stays as it is. A point in the band is kept, and stands for the crossing beside
 * it. */
static int cut(const feature_pair *f, const clip_buffer *in, clip_buffer *out, const side_plane *s, uint32_t i) {
    float d[MAX_CLIP];
    uint32_t inside = 0;
    for (uint32_t k = 0; k < in->count; ++k) {
        d[k] = side_distance(s, in->p[k]);
        inside += d[k] >= -s->band;
    }
    if (inside == in->count) {
        return 0;
    }
    out->count = 0;
    for (uint32_t k = 0; k < in->count && inside > 0; ++k) {
        uint32_t next = k + 1u < in->count ? k + 1u : 0u, n = out->count;
        int here = d[k] >= -s->band, there = d[next] >= -s->band;
        if (here && n < MAX_CLIP) {
            out->p[n] = in->p[k];
            out->id[n] = in->id[k];
            out->label[n++] = there || d[k] > 0.0f ? in->label[k] : (uint16_t)(FROM_REFERENCE | i);
        }
        if (here != there && (here ? d[k] : d[next]) > 0.0f && n < MAX_CLIP) {
            out->p[n] = tl_mad(in->p[k], d[k] / (d[k] - d[next]), tl_sub(in->p[next], in->p[k]));
            out->id[n] = crossing_id(f, in->label[k], i);
            out->label[n++] = here ? (uint16_t)(FROM_REFERENCE | i) : in->label[k];
        }
        out->count = n;
    }
    return 1;
}

/* How far x is in front of the reference's plane along the normal. */
static void measure(const tl_feature *ref, int ref_is_a, talus_vec3 n, float inverse, float margin, talus_vec3 x,
                    uint32_t id, tl_candidate *c, uint32_t *count) {
    float gap = tl_dot(ref->normal, tl_sub(x, ref->point[0])) * inverse;
    if (gap <= margin) {
        c[*count].gap = gap;
        c[*count].p = tl_mad(x, ref_is_a ? -0.5f * gap : 0.5f * gap, n);
        c[*count].id = id;
        ++*count;
    }
}

static uint32_t clip_polygon(const feature_pair *f, talus_vec3 n, float margin, tl_candidate *out) {
    clip_buffer buffer[2];
    clip_buffer *from = &buffer[0], *to = &buffer[1];
    const tl_feature *ref = f->ref, *inc = f->inc;
    talus_vec3 outward = f->ref_is_a ? n : tl_neg(n);
    float slack = TL_SIDE_SLACK * tl_min(extent(ref), extent(inc));
    uint32_t kind = f->ref_is_a ? TL_ID_VERTEX_B : TL_ID_VERTEX_A;
    from->count = inc->count;
    for (uint32_t k = 0; k < inc->count; ++k) {
        from->p[k] = inc->point[k];
        from->label[k] = (uint16_t)k;
        from->id[k] = tl_point_id(kind, inc->vertex[k], 0);
    }
    for (uint32_t i = 0; i < ref->count; ++i) {
        side_plane side = side_of(ref, i, outward, slack);
        if (cut(f, from, to, &side, i)) {
            clip_buffer *swap = from;
            from = to;
            to = swap;
            if (from->count == 0) {
                return 0;
            }
        }
    }
    float inverse = 1.0f / tl_dot(ref->normal, outward);
    uint32_t count = 0;
    for (uint32_t k = 0; k < from->count; ++k) {
        measure(ref, f->ref_is_a, n, inverse, margin, from->p[k], from->id[k], out, &count);
    }
    return count;
}

static uint32_t clip_segment(const feature_pair *f, talus_vec3 n, float margin, tl_candidate *out) {
    const tl_feature *ref = f->ref, *inc = f->inc;
    talus_vec3 outward = f->ref_is_a ? n : tl_neg(n);
    float slack = TL_SIDE_SLACK * tl_min(extent(ref), extent(inc)), low = 0.0f, high = 1.0f;
    uint32_t kind = f->ref_is_a ? TL_ID_VERTEX_B : TL_ID_VERTEX_A;
    uint32_t low_id = tl_point_id(kind, inc->vertex[0], 0), high_id = tl_point_id(kind, inc->vertex[1], 0);
    for (uint32_t i = 0; i < ref->count; ++i) {
        side_plane side = side_of(ref, i, outward, slack);
        float d0 = side_distance(&side, inc->point[0]), d1 = side_distance(&side, inc->point[1]);
        if (d0 < -side.band && d1 < -side.band) {
            return 0;
        }
        float t = tl_clamp(d0 / (d0 - d1), 0.0f, 1.0f);
        if (d0 < -side.band && t > low) {
            low = t;
            low_id = crossing_id(f, 0, i);
        } else if (d1 < -side.band && t < high) {
            high = t;
            high_id = crossing_id(f, 0, i);
        }
    }
    if (low > high) {
        return 0;
    }
    float inverse = 1.0f / tl_dot(ref->normal, outward);
    talus_vec3 along = tl_sub(inc->point[1], inc->point[0]);
    uint32_t count = 0;
    measure(ref, f->ref_is_a, n, inverse, margin, tl_mad(inc->point[0], low, along), low_id, out, &count);
    if (high > low) {
        measure(ref, f->ref_is_a, n, inverse, margin, tl_mad(inc->point[0], high, along), high_id, out, &count);
    }
    return count;
}

/* A point over the reference. */
static uint32_t clip_point(const feature_pair *f, talus_vec3 n, float margin, float slack, tl_candidate *out) {
    const tl_feature *ref = f->ref;
    talus_vec3 outward = f->ref_is_a ? n : tl_neg(n), p = f->inc->point[0];
    for (uint32_t i = 0; i < ref->count; ++i) {
        side_plane side = side_of(ref, i, outward, slack);
        if (side_distance(&side, p) < -side.band) {
            return 0;
        }
    }
    uint32_t count = 0, id = tl_point_id(f->ref_is_a ? TL_ID_VERTEX_B : TL_ID_VERTEX_A, f->inc->vertex[0], 0);
    measure(ref, f->ref_is_a, n, 1.0f / tl_dot(ref->normal, outward), margin, p, id, out, &count);
    return count;
}

/* Where two segments cross, seen along the normal. */
static uint32_t cross_segments(const tl_feature *a, const tl_feature *b, talus_vec3 n, float margin,
                               tl_candidate *out) {
    talus_vec3 u = tl_sub(a->point[1], a->point[0]), w = tl_sub(b->point[1], b->point[0]);
    talus_vec3 across = tl_cross(u, n), d = tl_sub(b->point[0], a->point[0]), other = tl_cross(w, n);
    float uw = tl_dot(across, w), wu = tl_dot(other, u);
    if (!(uw * uw > 1e-5f * tl_length2(u) * tl_length2(w)) || !(wu * wu > 1e-5f * tl_length2(u) * tl_length2(w))) {
        return 0; /* parallel: they cross nowhere in particular */
    }
    float t = -tl_dot(across, d) / uw, s = tl_dot(other, d) / wu;
    if (!(t >= -TL_SIDE_SLACK && t <= 1.0f + TL_SIDE_SLACK && s >= -TL_SIDE_SLACK && s <= 1.0f + TL_SIDE_SLACK)) {
        return 0;
    }
    talus_vec3 p = tl_mad(a->point[0], tl_clamp(s, 0.0f, 1.0f), u), q = tl_mad(b->point[0], tl_clamp(t, 0.0f, 1.0f), w);
    out->gap = tl_dot(n, tl_sub(q, p));
    out->p = tl_scale(tl_add(p, q), 0.5f);
    out->id = tl_point_id(TL_ID_EDGES, a->edge[0], b->edge[0]);
    return out->gap <= margin;
}

/* Two segments that run alike seen along the normal, within 2 degrees, meet in the two ends of what they share. */
static uint32_t meet_segments(const tl_feature *a, const tl_feature *b, talus_vec3 n, float margin, tl_candidate *out) {
    talus_vec3 u = tl_sub(a->point[1], a->point[0]), w = tl_sub(b->point[1], b->point[0]);
    talus_vec3 flat = tl_mad(u, -tl_dot(u, n), n);
    float uu = tl_length2(flat), across = tl_dot(tl_cross(u, w), n), along = tl_dot(flat, w);
    if (!(across * across <= 0.0012f * along * along) || !(uu > 0.0f)) {
        return 0;
    }
    float t[2] = {0.0f, 1.0f};
    uint32_t id[2] = {tl_point_id(TL_ID_VERTEX_A, a->vertex[0], 0), tl_point_id(TL_ID_VERTEX_A, a->vertex[1], 0)};
    float s0 = tl_dot(flat, tl_sub(b->point[0], a->point[0])) / uu;
    float s1 = tl_dot(flat, tl_sub(b->point[1], a->point[0])) / uu;
    uint32_t first = s0 <= s1 ? 0u : 1u;
    float low = tl_min(s0, s1), high = tl_max(s0, s1);
    if (low > t[0]) {
        t[0] = low;
        id[0] = tl_point_id(TL_ID_VERTEX_B, b->vertex[first], 0);
    }
    if (high < t[1]) {
        t[1] = high;
        id[1] = tl_point_id(TL_ID_VERTEX_B, b->vertex[1u - first], 0);
    }
    if (!(t[1] - t[0] > TL_SIDE_SLACK)) {
        return 0;
    }
    tl_candidate end[2];
    float aside[2];
    talus_vec3 across_u = tl_cross(n, flat);
    for (uint32_t i = 0; i < 2; ++i) {
        talus_vec3 p = tl_mad(a->point[0], t[i], u);
        float s = tl_clamp((t[i] - s0) / (s1 - s0), 0.0f, 1.0f);
        talus_vec3 q = tl_mad(b->point[0], s, w), d = tl_sub(q, p);
        end[i].p = tl_scale(tl_add(p, q), 0.5f);
        end[i].gap = tl_dot(n, d);
        end[i].id = id[i];
        aside[i] = tl_dot(across_u, d);
    }
    /* beside one another all along, they do not meet along n */
    uint32_t near = tl_abs(aside[0]) <= tl_abs(aside[1]) ? 0u : 1u;
    float length = sqrtf(uu), slack = 0.15f * tl_abs(end[near].gap) + TL_SIDE_SLACK * length;
    if (aside[0] * aside[1] > 0.0f && tl_abs(aside[near]) > slack * length) {
        return 0;
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < 2; ++i) {
        if (end[i].gap <= margin) {
            out[count++] = end[i];
        }
    }
    return count;
}

static uint32_t touch_id(const tl_feature *a, const tl_feature *b) {
    if (a->count == 2 && b->count == 2) {
        return tl_point_id(TL_ID_EDGES, a->edge[0], b->edge[0]);
    }
    return tl_point_id(TL_ID_POINTS, a->count == 1 ? a->vertex[0] : 0x7fffu, b->count == 1 ? b->vertex[0] : 0x7fffu);
}

/* The lowest point of a disc, which the polygon that stands for the disc leaves out. */
static void add_rim(const tl_core *core, const tl_feature *ref, int ref_is_a, talus_vec3 n, float margin,
                    float tolerance, tl_candidates *c) {
    tl_candidate own;
    tl_feature point;
    uint32_t index = 0;
    point.count = 1;
    point.point[0] = tl_core_support(core, ref_is_a ? tl_neg(n) : n, &index);
    point.vertex[0] = RIM_ID;
    feature_pair f = {ref, &point, ref_is_a};
    if (clip_point(&f, n, margin, tolerance, &own)) {
        tl_candidates_add(&own, tolerance, c);
    }
}

static int face_is_reference(const tl_feature *a, const tl_feature *b, talus_vec3 n) {
    return tl_dot(a->normal, n) >= -tl_dot(b->normal, n) - 1e-3f;
}

static void meet(const tl_feature *a, const tl_feature *b, talus_vec3 n, float margin, float tolerance,
                 tl_candidates *all) {
    tl_candidate *c = all->c;
    int a_face = a->count >= 3, b_face = b->count >= 3;
    all->kept = all->count = 0;
    if (a_face && b_face) {
        a_face = face_is_reference(a, b, n);
        b_face = !a_face;
    }
    if (a_face || b_face) {
        feature_pair f = {a_face ? a : b, a_face ? b : a, a_face};
        if (tl_abs(tl_dot(f.ref->normal, n)) < 0.1f) {
            return;
        }
        all->count = f.inc->count >= 3   ? clip_polygon(&f, n, margin, c)
                     : f.inc->count == 2 ? clip_segment(&f, n, margin, c)
                                         : clip_point(&f, n, margin, tolerance, c);
        all->kept = all->count;
    } else if (a->count == 2 && b->count == 2) {
        tl_candidate own;
        all->kept = all->count = meet_segments(a, b, n, margin, c);
        if (cross_segments(a, b, n, margin, &own)) {
            tl_candidates_add(&own, tolerance, all);
        }
    }
    if (all->count > TL_MANIFOLD_POINTS) {
        tl_candidates_reduce(all, n, tolerance);
    }
}

void tl_manifold_build(const tl_feature *a, const tl_feature *b, const tl_touch *touch, float margin, float tolerance,
                       tl_manifold *out) {
    tl_candidates c;
    meet(a, b, touch->normal, margin, tolerance, &c);
    tl_candidates_write(&c, touch, out);
}

void tl_manifold_meet(const tl_core *a, const tl_core *b, tl_feature *fa, tl_feature *fb, const tl_touch *touch,
                      float margin, tl_manifold *out) {
    tl_candidates c;
    tl_candidate own;
    talus_vec3 n = touch->normal;
    float tolerance = tl_touch_tolerance(a, b);
    if (fa->count < 3 && fb->count >= 3) {
        tl_feature_find(a, n, 0, fa);
    } else if (fb->count < 3 && fa->count >= 3) {
        tl_feature_find(b, tl_neg(n), 0, fb);
    }
    meet(fa, fb, n, margin, tolerance, &c);
    if (fa->count >= 3 && fb->count >= 3) {
        int a_is_ref = face_is_reference(fa, fb, n);
        const tl_core *inc = a_is_ref ? b : a;
        if (inc->kind == TL_CORE_FRUSTUM) {
            add_rim(inc, a_is_ref ? fa : fb, a_is_ref, n, margin, tolerance, &c);
        }
    }
    own.p = tl_scale(tl_add(touch->point_a, touch->point_b), 0.5f);
    own.gap = touch->separation;
    own.id = touch_id(fa, fb);
    tl_candidates_add(&own, tolerance, &c);
    tl_candidates_write(&c, touch, out);
}
