/* A capsule and a box or hull: the capsule's segment over the best face, if it is there; by the cross products of the
 * segment and the edges where the segment is inside; by GJK where it is nearest to an edge or corner from outside.
 * Metres, in the polyhedron's frame, which is A's. */
#include "collide/polyhedra.h"
#include "collide/round.h"

/* The greatest over the faces of the least distance of the segment c -+ u in front of it. */
static uint32_t best_face(const tl_poly *p, talus_vec3 c, talus_vec3 u, float *separation) {
    float best[8] = {-3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f};
    int32_t at[8] = {0};
    for (uint32_t i = 0; i < p->face_stride; i += 8) {
        for (uint32_t k = 0; k < 8; ++k) {
            float nx = p->nx[i + k], ny = p->ny[i + k], nz = p->nz[i + k];
            float s = (nx * c.x + ny * c.y + nz * c.z - p->d[i + k]) - tl_abs(nx * u.x + ny * u.y + nz * u.z);
            int better = s > best[k];
            at[k] = better ? (int32_t)(i + k) : at[k];
            best[k] = better ? s : best[k];
        }
    }
    for (uint32_t k = 1; k < 8; ++k) {
        if (best[k] > best[0] || (best[k] == best[0] && at[k] < at[0])) {
            best[0] = best[k];
            at[0] = at[k];
        }
    }
    *separation = best[0];
    return (uint32_t)at[0] < p->face_count ? (uint32_t)at[0] : p->face_count - 1u;
}

/* The same over the edges whose arcs the segment's great circle crosses; 0 if none beats `separation` by `bias`. */
static int best_edge(const tl_poly *p, talus_vec3 c, talus_vec3 u, float bias, float *separation, uint32_t *edge,
                     talus_vec3 *normal) {
    int found = 0;
    for (uint32_t i = 0; i < p->half_edge_count; i += 2u) {
        const tl_half_edge *e = &p->edges[i];
        talus_vec3 n1 = tl_v(p->nx[e[0].face], p->ny[e[0].face], p->nz[e[0].face]);
        talus_vec3 n2 = tl_v(p->nx[e[1].face], p->ny[e[1].face], p->nz[e[1].face]);
        if (!(tl_dot(n1, u) * tl_dot(n2, u) < 0.0f)) {
            continue;
        }
        talus_vec3 from = tl_v(p->x[e[0].origin], p->y[e[0].origin], p->z[e[0].origin]);
        talus_vec3 along = tl_sub(tl_v(p->x[e[1].origin], p->y[e[1].origin], p->z[e[1].origin]), from);
        talus_vec3 n = tl_cross(along, u);
        if (!(tl_length2(n) > 1e-8f * tl_length2(along) * tl_length2(u))) {
            continue;
        }
        n = tl_normalize_or(n, n1);
        n = tl_dot(n, tl_add(n1, n2)) < 0.0f ? tl_neg(n) : n;
        float s = tl_dot(n, tl_sub(c, from));
        if (s > *separation + (found ? 0.0f : bias)) {
            /* the arc may have seemed crossed by rounding alone */
            uint32_t index = e[0].origin;
            talus_vec3 v = tl_core_support_local(p->core, n, &index);
            s = tl_min(s, tl_dot(n, tl_sub(c, v)) - tl_abs(tl_dot(n, u)));
            if (s > *separation + (found ? 0.0f : bias)) {
                *separation = s;
                *edge = i >> 1;
                *normal = n;
                found = 1;
            }
        }
    }
    return found;
}

static void set_segment(tl_feature *f, talus_vec3 c, talus_vec3 u) {
    f->count = 2;
    f->normal = tl_v(0.0f, 0.0f, 0.0f);
    f->point[0] = tl_sub(c, u);
    f->point[1] = tl_add(c, u);
    f->vertex[0] = 0;
    f->vertex[1] = 1;
    f->edge[0] = f->edge[1] = 0;
}

int tl_collide_capsule_polyhedron(const tl_core *a, const tl_core *b, float margin, tl_pair_cache *cache,
                                  tl_manifold *out) {
    tl_poly p;
    tl_feature fa, fb;
    tl_touch touch;
    if (!tl_poly_init(a, &p)) {
        return 0;
    }
    talus_vec3 c = b->t, u = tl_scale(b->r.y, b->half_height);
    float s = 0.0f, r = b->radius, tolerance = tl_touch_tolerance(a, b);
    uint32_t face = best_face(&p, c, u, &s), edge = 0;
    talus_vec3 n = tl_v(p.nx[face], p.ny[face], p.nz[face]);
    out->count = 0;
    out->normal = n;
    out->gap = s - r;
    if (out->gap > margin) {
        return 1;
    }
    if (s <= 0.0f && best_edge(&p, c, u, tolerance - 2e-5f * s, &s, &edge, &n)) {
        const tl_half_edge *e = &p.edges[2u * edge];
        tl_feature_edge(a, e[0].origin, e[1].origin, edge, &fa);
    } else {
        tl_feature_face(a, face, &fa);
    }
    touch.normal = n;
    touch.separation = s - r;
    out->normal = n;
    out->gap = s - r;
    if (out->gap > margin) {
        return 1;
    }
    set_segment(&fb, tl_mad(c, -r, n), u);
    tl_manifold_build(&fa, &fb, &touch, margin, tolerance, out);
    if (out->count == 0 || (s > 0.0f && tl_manifold_least(out) + r > 1.0001f * s + tolerance)) {
        tl_collide_general(a, b, margin, cache, out);
    }
    return 1;
}
