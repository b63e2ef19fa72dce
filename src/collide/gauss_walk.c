/* Penetration depth by descent over the overlaid Gauss maps of A and of -B: Kim, Lin & Manocha, DEEP: Dual-space
 * Expansion for Estimating Penetration Depth Between Convex Polytopes, ICRA 2002; the same, Incremental Penetration
 * Depth Estimation Between Convex Polytopes Using Dual-Space Expansion, IEEE TVCG 10(2), 2004. A cell of the overlay is
 * the directions in which one vertex of A and one of B support; along an arc within it the depth is concave, so that
 * the minima are at its corners: normals of A's faces, of B's, and crossings of an edge's arc of A with one of B.
 *
 * A corner only offers its direction: what counts is the depth along it, which is an upper bound of the penetration
 * whatever rounding does, and the descent is strict. Metres, in A's frame. */
#include "collide/gauss_walk.h"

#include "collide/gjk.h"
#include "collide/vclip.h"

#define FAN 16u        /* edges of a vertex that are laid out at a time */
#define PARALLEL 1e-18 /* squared sine below which two edges have no normal */

void tl_gauss_look(tl_gauss_pair *pair, tl_d3 n, uint32_t ia, uint32_t ib, tl_gauss_depth *out) {
    const tl_polytope *a = pair->a, *b = pair->b;
    out->n = n;
    out->ia = tl_polytope_support(a, n, ia);
    out->ib = tl_polytope_support(b, tl_frame_turn_back(pair->frame, tl_d_scale(n, -1.0)), ib);
    out->p = tl_d_sub(tl_polytope_vertex(a, out->ia), tl_frame_point(pair->frame, tl_polytope_vertex(b, out->ib)));
    out->value = tl_d_dot(n, out->p);
    out->feature_a = TL_FEATURE(TL_FEATURE_VERTEX, out->ia);
    out->feature_b = TL_FEATURE(TL_FEATURE_VERTEX, out->ib);
    ++pair->supports;
}

/* The depth below which another is better: a gain worth a step, or the features of a direction that has none yet. */
static double worth(const tl_gauss_depth *best) {
    int corner = TL_FEATURE_KIND(best->feature_a) + TL_FEATURE_KIND(best->feature_b) > 2u * TL_FEATURE_VERTEX;
    return best->value * (corner ? 1.0 - 1e-12 : 1.0 + 1e-12);
}

/* Takes a direction (of any length) for the best if the depth along it is less. */
static int try_direction(tl_gauss_pair *pair, tl_d3 n, uint32_t ia, uint32_t ib, uint32_t feature_a, uint32_t feature_b,
                         tl_gauss_depth *best) {
    tl_gauss_depth d;
    tl_gauss_look(pair, tl_d_scale(n, 1.0 / tl_d_length(n)), ia, ib, &d);
    if (!(d.value < worth(best))) {
        return 0;
    }
    d.feature_a = feature_a;
    d.feature_b = feature_b;
    *best = d;
    return 1;
}

/* Whether the height of p over the plane across n undercuts the best, without a root. */
static int may_be_less(tl_d3 n, tl_d3 p, double limit) {
    double h = tl_d_dot(n, p);
    return h <= 0.0 || h * h < limit * limit * tl_d_dot(n, n);
}

/* Whether no neighbour of a vertex is further along a direction, by more than rounding. */
static int supports(const tl_polytope *p, uint32_t vertex, tl_d3 direction) {
    uint32_t first = p->vertex_edge[vertex], e = first;
    double here = tl_d_dot(direction, tl_polytope_vertex(p, vertex)) + 1e-6 * (double)p->size;
    if (first == TL_NO_FEATURE) {
        return 1;
    }
    do {
        uint32_t twin = tl_hull_twin(e);
        if (tl_d_dot(direction, tl_polytope_vertex(p, p->edges[twin].origin)) > here) {
            return 0;
        }
        e = p->edges[twin].next;
    } while (e != first);
    return 1;
}

/* The depth that the best is to be undercut by, and what normals are rounded by. */
static double bar(const tl_gauss_depth *best) { return worth(best) * (1.0 + 1e-6); }

/* The faces around a vertex of one side, against the other side's vertex. *less is set to whether along any of their
 * normals p is less high than the best: if it is along none, it is not along what lies between them either, which is a
 * sum of them with weights that add to 1 or more. What has no faces has all directions between them. */
static int try_faces(tl_gauss_pair *pair, int side, uint32_t ia, uint32_t ib, tl_d3 p, int *less,
                     tl_gauss_depth *best) {
    const tl_polytope *s = side ? pair->b : pair->a, *other = side ? pair->a : pair->b;
    uint32_t first = s->vertex_edge[side ? ib : ia], e = first;
    tl_d3 seen = side ? tl_frame_turn_back(pair->frame, tl_d_scale(p, -1.0)) : p;
    int better = 0;
    *less = s->face_count == 0u;
    if (s->face_count == 0u) {
        return 0;
    }
    do {
        uint32_t face = s->edges[e].face;
        tl_d3 n = tl_polytope_normal(s, face);
        e = s->edges[tl_hull_twin(e)].next;
        if (!may_be_less(n, seen, bar(best))) {
            continue;
        }
        *less = 1;
        n = side ? tl_d_scale(tl_frame_turn(pair->frame, n), -1.0) : n;
        if (supports(other, side ? ia : ib, side ? n : tl_frame_turn_back(pair->frame, tl_d_scale(n, -1.0)))) {
            better |= try_direction(pair, n, ia, ib,
                                    side ? TL_FEATURE(TL_FEATURE_VERTEX, ia) : TL_FEATURE(TL_FEATURE_FACE, face),
                                    side ? TL_FEATURE(TL_FEATURE_FACE, face) : TL_FEATURE(TL_FEATURE_VERTEX, ib), best);
        }
    } while (e != first);
    return better;
}

/* The outward normal of the face left of a half-edge; 0 of what has no faces. */
static tl_d3 left_of(const tl_polytope *p, uint32_t e) {
    return p->face_count > 0u ? tl_polytope_normal(p, p->edges[e].face) : tl_d(0.0, 0.0, 0.0);
}

static tl_d3 along(const tl_polytope *p, uint32_t e) {
    return tl_d_sub(tl_polytope_vertex(p, p->edges[e ^ 1u].origin), tl_polytope_vertex(p, p->edges[e].origin));
}

/* Whether the arcs of two edges cross: given each one's direction times the normals on the left and right of the other.
 * The arcs' planes cross in two opposite places; one of them must be on both. What has no faces has normals of 0, and
 * its arc goes all around. One branch, for each of these by itself is a toss of a coin. */
static int arcs_cross(double left, double right, double other_left, double other_right) {
    return !((left * right > 0.0) | (other_left * other_right > 0.0) | (left * other_right > 0.0) |
             (right * other_left > 0.0));
}

/* An edge of A and one of B whose arcs cross, u and v long, offer the normal of both that points from A to B: u, v and
 * `outward`, the sum of A's normals less that of B's, are seen from B as `seen` is. */
static int try_crossing(tl_gauss_pair *pair, uint32_t e, uint32_t f, tl_d3 u, tl_d3 v, tl_d3 outward, tl_d3 seen,
                        tl_gauss_depth *best) {
    tl_d3 n = tl_d_cross(u, v);
    if (!(tl_d_dot(n, n) > PARALLEL * tl_d_dot(u, u) * tl_d_dot(v, v))) {
        return 0;
    }
    n = tl_d_scale(n, tl_d_dot(n, outward) < 0.0 ? -1.0 : 1.0);
    return may_be_less(n, seen, worth(best)) &&
           try_direction(pair, tl_frame_turn(pair->frame, n), pair->a->edges[e].origin, pair->b->edges[f].origin,
                         TL_FEATURE(TL_FEATURE_EDGE, e), TL_FEATURE(TL_FEATURE_EDGE, f), best);
}

/* Up to FAN edges away from a vertex of B, one after the other: normal i and i + 1 are left and right of edge i. */
typedef struct fan {
    uint32_t count, edge[FAN];
    tl_d3 u[FAN], normal[FAN + 1];
} fan;

/* From the half-edge f on until `first` comes again; returns where the next fan starts. */
static uint32_t lay_out(const tl_polytope *p, uint32_t f, uint32_t first, fan *out) {
    out->count = 0u;
    out->normal[0] = left_of(p, f);
    do {
        uint32_t twin = tl_hull_twin(f);
        out->edge[out->count] = f;
        out->u[out->count++] = along(p, f);
        out->normal[out->count] = left_of(p, twin);
        f = p->edges[twin].next;
    } while (f != first && out->count < FAN);
    return f;
}

/* The crossings of the edges around a vertex of A with those of a fan of B. */
static int try_fan(tl_gauss_pair *pair, const fan *b, uint32_t first, tl_d3 seen, tl_gauss_depth *best) {
    const tl_polytope *a = pair->a;
    double left[FAN], right[FAN];
    uint32_t e = first;
    tl_d3 m = tl_frame_turn_back(pair->frame, left_of(a, e));
    int better = 0;
    for (uint32_t k = 0; k < b->count; ++k) {
        left[k] = tl_d_dot(m, b->u[k]);
    }
    do {
        tl_d3 u = tl_frame_turn_back(pair->frame, along(a, e)), before = m;
        uint32_t twin = tl_hull_twin(e);
        m = tl_frame_turn_back(pair->frame, left_of(a, twin));
        double on_left = tl_d_dot(u, b->normal[0]);
        for (uint32_t k = 0; k < b->count; ++k) {
            double on_right = tl_d_dot(u, b->normal[k + 1u]);
            right[k] = tl_d_dot(m, b->u[k]);
            if (arcs_cross(left[k], right[k], on_left, on_right)) {
                tl_d3 outward = tl_d_sub(tl_d_add(before, m), tl_d_add(b->normal[k], b->normal[k + 1u]));
                better |= try_crossing(pair, e, b->edge[k], u, b->u[k], outward, seen, best);
            }
            left[k] = right[k];
            on_left = on_right;
        }
        e = a->edges[twin].next;
    } while (e != first);
    return better;
}

/* The crossings of the edges around a vertex of A with those around one of B. */
static int try_edges(tl_gauss_pair *pair, uint32_t ia, uint32_t ib, tl_d3 p, tl_gauss_depth *best) {
    uint32_t first_a = pair->a->vertex_edge[ia], first_b = pair->b->vertex_edge[ib], f = first_b;
    tl_d3 seen = tl_frame_turn_back(pair->frame, p);
    int better = 0;
    if (first_a == TL_NO_FEATURE || first_b == TL_NO_FEATURE) {
        return 0;
    }
    do {
        fan b;
        f = lay_out(pair->b, f, first_b, &b);
        better |= try_fan(pair, &b, first_a, seen, best);
    } while (f != first_b);
    return better;
}

static int try_cell(tl_gauss_pair *pair, uint32_t ia, uint32_t ib, tl_gauss_depth *best) {
    tl_d3 p = tl_d_sub(tl_polytope_vertex(pair->a, ia), tl_frame_point(pair->frame, tl_polytope_vertex(pair->b, ib)));
    int less, better = try_faces(pair, 0, ia, ib, p, &less, best);
    if (less) {
        better |= try_faces(pair, 1, ia, ib, p, &less, best);
    }
    return less ? better | try_edges(pair, ia, ib, p, best) : better;
}

/* The corners of a feature one after the other: the first, and after *at the next, 0 at the end. */
static int corner(const tl_polytope *p, uint32_t feature, uint32_t turn, uint32_t *at, uint32_t *vertex) {
    uint32_t i = TL_FEATURE_INDEX(feature);
    switch (TL_FEATURE_KIND(feature)) {
    case TL_FEATURE_EDGE:
        *vertex = p->edges[i ^ (turn & 1u)].origin;
        return turn < 2u;
    case TL_FEATURE_FACE:
        *at = turn == 0u ? p->face_edge[i] : p->edges[*at].next;
        *vertex = p->edges[*at].origin;
        return turn == 0u || *at != p->face_edge[i];
    default:
        *vertex = i;
        return turn == 0u;
    }
}

static tl_d3 turn_back(const tl_gauss_pair *pair, tl_d3 v) { return tl_frame_turn_back(pair->frame, v); }
static tl_d3 turn_to(const tl_gauss_pair *pair, int a, tl_d3 v) {
    return a ? tl_frame_turn(pair->frame, v) : tl_frame_turn_back(pair->frame, v);
}

/* Where the arc of A's half-edge e leads from the corners of the overlay on it, within the cell of B's vertex ib: to
 * the faces on both sides and to the arcs of B's edges. The other way round with `side` 1. */
static int try_arc(tl_gauss_pair *pair, int side, uint32_t e, uint32_t i, tl_gauss_depth *best) {
    const tl_polytope *s = side ? pair->b : pair->a, *other = side ? pair->a : pair->b;
    uint32_t tail = s->edges[e].origin, ia = side ? i : tail, ib = side ? tail : i;
    tl_d3 p = tl_d_sub(tl_polytope_vertex(pair->a, ia), tl_frame_point(pair->frame, tl_polytope_vertex(pair->b, ib)));
    int better = 0;
    for (uint32_t k = 0; k < 2u && s->face_count > 0u; ++k) {
        uint32_t face = s->edges[e ^ k].face;
        tl_d3 n = tl_polytope_normal(s, face);
        n = side ? tl_d_scale(tl_frame_turn(pair->frame, n), -1.0) : n;
        if (may_be_less(n, p, worth(best)) &&
            supports(other, i, side ? n : tl_frame_turn_back(pair->frame, tl_d_scale(n, -1.0)))) {
            better |= try_direction(pair, n, ia, ib,
                                    side ? TL_FEATURE(TL_FEATURE_VERTEX, ia) : TL_FEATURE(TL_FEATURE_FACE, face),
                                    side ? TL_FEATURE(TL_FEATURE_FACE, face) : TL_FEATURE(TL_FEATURE_VERTEX, ib), best);
        }
    }
    uint32_t first = other->vertex_edge[i], f = first;
    if (first == TL_NO_FEATURE) {
        return better;
    }
    /* what is seen from B with side 0 and from A with side 1: from where the other one's edges are */
    tl_d3 u = turn_to(pair, side, along(s, e)), left = turn_to(pair, side, left_of(s, e));
    tl_d3 right = turn_to(pair, side, left_of(s, tl_hull_twin(e)));
    double on_left = tl_d_dot(u, left_of(other, f));
    do {
        uint32_t twin = tl_hull_twin(f);
        tl_d3 v = along(other, f);
        double on_right = tl_d_dot(u, left_of(other, twin));
        if (arcs_cross(tl_d_dot(left, v), tl_d_dot(right, v), on_left, on_right)) {
            tl_d3 outward = tl_d_sub(tl_d_add(left, right), tl_d_add(left_of(other, f), left_of(other, twin)));
            better |= side ? try_crossing(pair, f, e, turn_back(pair, v), turn_back(pair, u),
                                          turn_back(pair, tl_d_scale(outward, -1.0)), turn_back(pair, p), best)
                           : try_crossing(pair, e, f, u, v, outward, turn_back(pair, p), best);
        }
        on_left = on_right;
        f = other->edges[twin].next;
    } while (f != first);
    return better;
}

/* The height of corner i of one side against corner k of the other along the normal of a face of the first: whether it
 * may be less than the best, by its square. */
static int is_lower(const tl_gauss_pair *pair, int side, uint32_t face, uint32_t i, uint32_t k, double *height,
                    const tl_gauss_depth *best) {
    const tl_polytope *s = side ? pair->b : pair->a, *other = side ? pair->a : pair->b;
    tl_d3 n = tl_polytope_normal(s, face), v = tl_polytope_vertex(other, k);
    v = side ? tl_frame_point_back(pair->frame, v) : tl_frame_point(pair->frame, v);
    v = tl_d_sub(tl_polytope_vertex(s, i), v);
    *height = tl_d_dot(n, v);
    return may_be_less(n, v, bar(best));
}

/* From the crossing of two edges' arcs along that of e, which is one of `side`, both ways: the arc towards a face lies
 * in the cell of the end of f that is further against its normal. Along it the depth is concave: where it is not less
 * at the face, it is not on the way. */
static int try_both_ways(tl_gauss_pair *pair, int side, uint32_t e, uint32_t f, tl_gauss_depth *best) {
    const tl_polytope *s = side ? pair->b : pair->a, *other = side ? pair->a : pair->b;
    uint32_t ends[2] = {other->edges[f].origin, other->edges[f ^ 1u].origin};
    int lower[2] = {0, 0};
    for (uint32_t k = 0; k < 2u && s->face_count > 0u; ++k) {
        double height[2];
        int low[2];
        for (int i = 0; i < 2; ++i) {
            low[i] = is_lower(pair, side, s->edges[e ^ k].face, s->edges[e].origin, ends[i], &height[i], best);
        }
        int far = height[1] > height[0];
        lower[far] |= low[far];
    }
    return ((lower[0] || s->face_count == 0u) && try_arc(pair, side, e, ends[0], best)) ||
           ((lower[1] || s->face_count == 0u) && try_arc(pair, side, e, ends[1], best));
}

/* The corners of the overlay next to that of the features, along the arcs that meet there. */
static int try_neighbours(tl_gauss_pair *pair, uint32_t fa, uint32_t fb, tl_gauss_depth *best) {
    uint32_t e = TL_FEATURE_INDEX(fa), f = TL_FEATURE_INDEX(fb);
    if (TL_FEATURE_KIND(fa) == TL_FEATURE_EDGE && TL_FEATURE_KIND(fb) == TL_FEATURE_EDGE) {
        return try_both_ways(pair, 0, e, f, best) || try_both_ways(pair, 1, f, e, best);
    }
    int side = TL_FEATURE_KIND(fb) == TL_FEATURE_FACE, better = 0;
    const tl_polytope *s = side ? pair->b : pair->a;
    uint32_t first = s->face_edge[side ? f : e], k = first, i = side ? e : f;
    double height;
    do {
        better = is_lower(pair, side, s->edges[k ^ 1u].face, s->edges[k].origin, i, &height, best) &&
                 try_arc(pair, side, k, i, best);
        k = s->edges[k].next;
    } while (!better && k != first);
    return better;
}

/* The cells that meet in a corner, or the one of two vertices. */
static int try_cells(tl_gauss_pair *pair, uint32_t fa, uint32_t fb, tl_gauss_depth *best) {
    uint32_t at_a = 0u, at_b = 0u, ia, ib;
    int better = 0;
    for (uint32_t i = 0; !better && corner(pair->a, fa, i, &at_a, &ia); ++i) {
        for (uint32_t k = 0; !better && corner(pair->b, fb, k, &at_b, &ib); ++k) {
            better = try_cell(pair, ia, ib, best);
        }
    }
    return better;
}

void tl_gauss_descend(tl_gauss_pair *pair, tl_gauss_depth *best) {
    int known = TL_FEATURE_KIND(best->feature_a) + TL_FEATURE_KIND(best->feature_b) > 2u * TL_FEATURE_VERTEX;
    /* where the last minimum is one still, its neighbours are enough; else, and from anywhere else, all around */
    int better = best->value > 0.0 && (!known || try_neighbours(pair, best->feature_a, best->feature_b, best));
    while (better && best->value > 0.0) {
        better = try_cells(pair, best->feature_a, best->feature_b, best);
    }
}

/* Of the features' faces or edges, of any length; 0 if they are not a face and a vertex or two edges. */
static int normal_of(const tl_gauss_pair *pair, uint32_t fa, uint32_t fb, tl_d3 *n) {
    const tl_polytope *a = pair->a, *b = pair->b;
    if (!tl_polytope_has(a, fa) || !tl_polytope_has(b, fb)) {
        return 0;
    }
    uint32_t e = TL_FEATURE_INDEX(fa), f = TL_FEATURE_INDEX(fb);
    if (TL_FEATURE_KIND(fa) == TL_FEATURE_FACE && TL_FEATURE_KIND(fb) == TL_FEATURE_VERTEX) {
        *n = tl_polytope_normal(a, e);
        return 1;
    }
    if (TL_FEATURE_KIND(fb) == TL_FEATURE_FACE && TL_FEATURE_KIND(fa) == TL_FEATURE_VERTEX) {
        *n = tl_d_scale(tl_frame_turn(pair->frame, tl_polytope_normal(b, f)), -1.0);
        return 1;
    }
    if (TL_FEATURE_KIND(fa) != TL_FEATURE_EDGE || TL_FEATURE_KIND(fb) != TL_FEATURE_EDGE) {
        return 0;
    }
    tl_d3 u = tl_d_sub(tl_polytope_vertex(a, a->edges[e ^ 1u].origin), tl_polytope_vertex(a, a->edges[e].origin));
    tl_d3 v = tl_d_sub(tl_polytope_vertex(b, b->edges[f ^ 1u].origin), tl_polytope_vertex(b, b->edges[f].origin));
    tl_d3 outward;
    if (a->face_count > 0u) {
        outward = tl_d_add(tl_polytope_normal(a, a->edges[e].face), tl_polytope_normal(a, a->edges[e ^ 1u].face));
    } else if (b->face_count > 0u) {
        outward = tl_d_add(tl_polytope_normal(b, b->edges[f].face), tl_polytope_normal(b, b->edges[f ^ 1u].face));
        outward = tl_d_scale(tl_frame_turn(pair->frame, outward), -1.0);
    } else {
        return 0;
    }
    *n = tl_d_cross(u, tl_frame_turn(pair->frame, v));
    *n = tl_d_scale(*n, tl_d_dot(*n, outward) < 0.0 ? -1.0 : 1.0);
    return tl_d_dot(*n, *n) > PARALLEL * tl_d_dot(u, u) * tl_d_dot(v, v);
}

/* The way out that the expanding polytope finds: the least but for its being made of floats and of 96 points at most.
 */
static tl_d3 by_expansion(const tl_gauss_pair *pair) {
    tl_core a, b;
    tl_simplex simplex;
    tl_gjk near;
    tl_depth depth;
    tl_closest_cores(pair->a, pair->b, pair->frame, &a, &b);
    simplex.count = 0;
    talus_vec3 guess = tl_normalize_or(b.t, tl_v(0.0f, 1.0f, 0.0f));
    if (tl_gjk_run(&a, &b, guess, 3e38f, &simplex, &near) == TL_GJK_APART) {
        return tl_d_from(near.normal); /* they just touch */
    }
    tl_epa_run(&a, &b, &simplex, &depth);
    return tl_d_from(depth.normal);
}

void tl_gauss_start(tl_gauss_pair *pair, talus_feature_pair features, tl_gauss_depth *out) {
    tl_d3 n;
    uint32_t ia, ib, at = 0u;
    int known = normal_of(pair, features.a, features.b, &n);
    if (known) {
        (void)corner(pair->a, features.a, 0u, &at, &ia);
        (void)corner(pair->b, features.b, 0u, &at, &ib);
    } else {
        n = by_expansion(pair);
        tl_d3 back = tl_frame_turn_back(pair->frame, tl_d_scale(n, -1.0));
        ia = tl_polytope_near(pair->a, n, 0u);
        ib = tl_polytope_near(pair->b, back, 0u);
    }
    tl_gauss_look(pair, tl_d_scale(n, 1.0 / tl_d_length(n)), ia, ib, out);
    if (known) {
        /* the features support along their normal if what does is no further out than they are */
        tl_d3 here =
            tl_d_sub(tl_polytope_vertex(pair->a, ia), tl_frame_point(pair->frame, tl_polytope_vertex(pair->b, ib)));
        double size = (double)pair->a->size + (double)pair->b->size;
        if (out->value - tl_d_dot(out->n, here) <= 1e-7 * size) {
            out->feature_a = features.a;
            out->feature_b = features.b;
        }
    }
}

int tl_gauss_overlap(const tl_gauss_pair *pair, talus_feature_pair features) {
    uint32_t kind_a = TL_FEATURE_KIND(features.a), kind_b = TL_FEATURE_KIND(features.b);
    const tl_polytope *a = pair->a, *b = pair->b;
    tl_gauss_depth d;
    tl_d3 pa, pb, n;
    if (a->face_count == 0u || b->face_count == 0u || !normal_of(pair, features.a, features.b, &n)) {
        return 0;
    }
    if (kind_a == TL_FEATURE_FACE) {
        pb = tl_frame_point(pair->frame, tl_polytope_vertex(b, TL_FEATURE_INDEX(features.b)));
        return tl_polytope_holds(a, TL_FEATURE_INDEX(features.a), pb);
    }
    if (kind_b == TL_FEATURE_FACE) {
        pa = tl_frame_point_back(pair->frame, tl_polytope_vertex(a, TL_FEATURE_INDEX(features.a)));
        return tl_polytope_holds(b, TL_FEATURE_INDEX(features.b), pa);
    }
    d.ia = d.ib = 0u;
    d.feature_a = features.a;
    d.feature_b = features.b;
    tl_gauss_points(pair, &d, &pa, &pb);
    tl_d3 middle = tl_d_scale(tl_d_add(pa, pb), 0.5);
    return tl_polytope_holds(a, a->edges[TL_FEATURE_INDEX(features.a)].face, middle) &&
           tl_polytope_holds(b, b->edges[TL_FEATURE_INDEX(features.b)].face, tl_frame_point_back(pair->frame, middle));
}

void tl_gauss_points(const tl_gauss_pair *pair, const tl_gauss_depth *d, tl_d3 *point_a, tl_d3 *point_b) {
    const tl_polytope *a = pair->a, *b = pair->b;
    *point_a = tl_polytope_vertex(a, d->ia);
    *point_b = tl_frame_point(pair->frame, tl_polytope_vertex(b, d->ib));
    if (TL_FEATURE_KIND(d->feature_a) == TL_FEATURE_FACE) {
        *point_a = tl_d_add(*point_b, tl_d_scale(d->n, d->value));
    } else if (TL_FEATURE_KIND(d->feature_b) == TL_FEATURE_FACE) {
        *point_b = tl_d_sub(*point_a, tl_d_scale(d->n, d->value));
    } else if (TL_FEATURE_KIND(d->feature_a) == TL_FEATURE_EDGE) {
        uint32_t e = TL_FEATURE_INDEX(d->feature_a), f = TL_FEATURE_INDEX(d->feature_b);
        tl_d3 p0 = tl_polytope_vertex(a, a->edges[e].origin), p1 = tl_polytope_vertex(a, a->edges[e ^ 1u].origin);
        tl_d3 q0 = tl_frame_point(pair->frame, tl_polytope_vertex(b, b->edges[f].origin));
        tl_d3 q1 = tl_frame_point(pair->frame, tl_polytope_vertex(b, b->edges[f ^ 1u].origin));
        double s, t;
        (void)tl_segments(p0, p1, q0, q1, &s, &t);
        *point_a = tl_d_add(p0, tl_d_scale(tl_d_sub(p1, p0), s));
        *point_b = tl_d_add(q0, tl_d_scale(tl_d_sub(q1, q0), t));
    }
}
