/* Manifolds of two polyhedra: separating axes where the shapes overlap or meet by a face or two edges, GJK where they
 * are apart by other features. The axis of the last query is tried first: it ends the query of a pair that is still
 * apart, and else bounds the search. Metres, in A's frame. */
#include "collide/polyhedra.h"

/* Faces closer to flush than this, about 1.5 degrees, may prove at once that the overlap along them is the least. */
#define FLUSH_COS -0.99966f

static void edge_features(const tl_poly *p, const tl_poly *q, uint32_t ep, uint32_t eq, talus_vec3 n, tl_feature *fp,
                          tl_feature *fq) {
    /* n looks from P to Q; a face that is all but square with it stands for the edge */
    const tl_half_edge *hp = &p->edges[2u * ep], *hq = &q->edges[2u * eq];
    talus_vec3 dp = tl_core_rotate_back(p->core, n), dq = tl_core_rotate_back(q->core, tl_neg(n));
    uint32_t face_p = 0, face_q = 0;
    float cos_p = -1.0f, cos_q = -1.0f;
    for (uint32_t i = 0; i < 2; ++i) {
        uint32_t f = hp[i].face, g = hq[i].face;
        float s = p->nx[f] * dp.x + p->ny[f] * dp.y + p->nz[f] * dp.z;
        float t = q->nx[g] * dq.x + q->ny[g] * dq.y + q->nz[g] * dq.z;
        face_p = s > cos_p ? f : face_p;
        face_q = t > cos_q ? g : face_q;
        cos_p = tl_max(s, cos_p);
        cos_q = tl_max(t, cos_q);
    }
    if (cos_p >= TL_FACE_COS || cos_q >= TL_FACE_COS) {
        tl_feature_face(p->core, face_p, fp);
        tl_feature_face(q->core, face_q, fq);
        return;
    }
    tl_feature_edge(p->core, hp[0].origin, hp[1].origin, ep, fp);
    tl_feature_edge(q->core, hq[0].origin, hq[1].origin, eq, fq);
}

/* The features that meet along an axis. */
static void axis_features(const tl_poly *a, const tl_poly *b, const tl_axis *axis, tl_feature *fa, tl_feature *fb) {
    switch (axis->kind) {
    case TL_AXIS_FACE_A:
        tl_feature_face(a->core, axis->a, fa);
        tl_feature_find(b->core, tl_neg(axis->normal), 0, fb);
        break;
    case TL_AXIS_FACE_B:
        tl_feature_find(a->core, axis->normal, 0, fa);
        tl_feature_face(b->core, axis->b, fb);
        break;
    case TL_AXIS_EDGES:
    case TL_AXIS_NONE:
    default:
        edge_features(a, b, axis->a, axis->b, axis->normal, fa, fb);
        break;
    }
}

static void axis_manifold(const tl_axis *axis, const tl_feature *fa, const tl_feature *fb, float margin,
                          float tolerance, tl_manifold *out) {
    tl_touch touch;
    touch.normal = axis->normal;
    touch.separation = axis->separation;
    tl_manifold_build(fa, fb, &touch, margin, tolerance, out);
}

int tl_collide_polyhedra(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache, tl_manifold *out) {
    tl_poly pa, pb;
    tl_sat sat;
    tl_axis axis;
    tl_feature fa, fb;
    if (!tl_poly_init(a, &pa) || !tl_poly_init(b, &pb)) {
        return 0;
    }
    if (tl_cache_has_simplex(cache) && tl_collide_apart(a, b, margin, cache, out)) {
        return 1;
    }
    talus_vec3 between = tl_sub(tl_core_place(b, pb.center), pa.center), va, vb;
    talus_vec3 n = tl_cache_axis(cache, tl_normalize_or(between, tl_v(0.0f, 1.0f, 0.0f)));
    uint32_t ia = 0, ib = 0;
    float known = tl_core_separation(a, b, n, &ia, &ib, &va, &vb);
    out->count = 0;
    out->normal = n;
    out->gap = known;
    if (known > margin) {
        tl_cache_keep_axis(cache, n);
        return 1;
    }
    if (known > 0.0f && tl_collide_apart(a, b, margin, cache, out)) {
        return 1;
    }
    float tolerance = tl_touch_tolerance(a, b);
    sat.a = &pa;
    sat.b = &pb;
    sat.bias = tolerance + 2e-5f * tl_abs(known);
    sat.least = known - 3.0f * sat.bias;
    sat.enough = margin;
    sat.point[0] = tl_sub(vb, va);
    sat.point_count = 1;
    tl_sat_faces(&sat, &axis);
    tl_axis_kind found = TL_AXIS_NONE;
    if (axis.separation <= 0.0f) {
        if (axis.kind != TL_AXIS_NONE) {
            axis_features(&pa, &pb, &axis, &fa, &fb);
            found = axis.kind;
            if (tl_dot(fa.normal, fb.normal) < FLUSH_COS) {
                axis_manifold(&axis, &fa, &fb, margin, tolerance, out);
                if (tl_is_proven(out, axis.separation, between)) {
                    tl_cache_keep_axis(cache, axis.normal);
                    return 1;
                }
            }
        }
        tl_sat_edges(&sat, &axis);
    }
    if (axis.kind != TL_AXIS_NONE) {
        tl_cache_keep_axis(cache, axis.normal);
        if (axis.separation > margin) {
            out->count = 0;
            out->normal = axis.normal;
            out->gap = axis.separation;
            return 1;
        }
        if (found != axis.kind) {
            axis_features(&pa, &pb, &axis, &fa, &fb);
        }
        axis_manifold(&axis, &fa, &fb, margin, tolerance, out);
        if (tl_is_realised(out, axis.separation, tolerance)) {
            return 1;
        }
    }
    tl_collide_general(a, b, margin, cache, out);
    return 1;
}
