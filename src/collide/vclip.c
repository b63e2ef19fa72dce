/* Closest features of two convex polyhedra by walking from feature to neighbour: Mirtich, V-Clip: Fast and Robust
 * Polyhedral Collision Detection, ACM Transactions on Graphics 17(3), 1998, section 3. Two features hold the closest
 * points if each one's point lies in the other's Voronoi region; if one does not, the neighbour behind the plane that
 * it is behind is nearer. An edge over a face has no one closest point: it is clipped by the face's region, and the end
 * looked at where it comes down to the face. Leaving an edge for its face takes more than the rounding of the face's
 * normal, so that what is left is not come back to.
 *
 * A vertex inside of a region of a face but behind it, with all its edges leading further behind, is in the body or
 * beyond another face: the polar dual tells (a walk over faces to the one through which the vertex is seen from the
 * centre). A cold start begins with two vertices that are looked up by direction (Ehmann & Lin, Accurate and Fast
 * Proximity Queries Between Polyhedra Using Convex Surface Decomposition, 2001).
 *
 * Each shape's regions are evaluated in its own frame; metres. */
#include "collide/vclip.h"

#include "collide/gjk.h"

#define MAX_STEPS 256u
/* What an answer may be wrong by, in parts of itself and of the sizes, before GJK is asked. */
#define GAP_SLACK 1e-6
#define SIZE_SLACK 5e-7
/* More rounds cost more than the steps they save. */
#define START_ROUNDS 4
#define START_SHORTER 4.0
#define ROUNDING 1e-7 /* of a normal */
#define NOTHING 1e-14 /* of the sizes: a distance that is all rounding */

typedef struct feature {
    uint32_t kind, index;
} feature;

typedef struct walk {
    const tl_polytope *body[2];
    const tl_frame *frame; /* of body 1 in that of body 0 */
    feature at[2];
    tl_closest *out; /* without the radii; what is in it when the walk is done */
} walk;

/* The part of a segment from tail to head that is left inside of a face's region, and the neighbours behind the planes
 * that cut it: `out` is set if one plane alone has it all outside. */
typedef struct clip {
    tl_d3 tail, head, u;
    double low, high;
    feature below, above; /* kind 0: not cut there */
    feature out;
} clip;

enum { STEP, DONE, DOUBT };

static inline tl_d3 across(const walk *w, int to, tl_d3 p) {
    return to ? tl_frame_point_back(w->frame, p) : tl_frame_point(w->frame, p);
}

static tl_d3 vertex(const walk *w, int side, uint32_t i) { return tl_polytope_vertex(w->body[side], i); }
static uint32_t tail_of(const walk *w, int side, uint32_t e) { return w->body[side]->edges[e].origin; }
static uint32_t head_of(const walk *w, int side, uint32_t e) { return w->body[side]->edges[e ^ 1u].origin; }

static feature make(uint32_t kind, uint32_t index) {
    feature f = {kind, index};
    return f;
}

static int go(walk *w, int side, feature to) {
    w->at[side] = to;
    return STEP;
}

static int meet(walk *w, int side, tl_d3 p) {
    w->out->cores_apart = 0;
    w->out->point_a = side ? tl_frame_point(w->frame, p) : p;
    return DONE;
}

static void clip_begin(clip *c, const walk *w, int side, uint32_t e) {
    c->tail = across(w, !side, vertex(w, side, tail_of(w, side, e)));
    c->head = across(w, !side, vertex(w, side, head_of(w, side, e)));
    c->u = tl_d_sub(c->head, c->tail);
    c->low = 0.0, c->high = 1.0;
    c->below = c->above = c->out = make(0u, 0u);
}

/* Cuts off what has a negative value, given those of the ends. */
static void clip_by(clip *c, double at_tail, double at_head, feature neighbour) {
    if (at_tail < 0.0 && at_head < 0.0) {
        c->out = neighbour;
    } else if (at_tail < 0.0) {
        double x = at_tail / (at_tail - at_head);
        if (x > c->low) {
            c->low = x, c->below = neighbour;
        }
    } else if (at_head < 0.0) {
        double x = at_tail / (at_tail - at_head);
        if (x < c->high) {
            c->high = x, c->above = neighbour;
        }
    }
}

static tl_d3 clip_point(const clip *c, double x) { return tl_d_add(c->tail, tl_d_scale(c->u, x)); }

/* The outward normal, in the plane of its face, of a half-edge: the plane between the regions of both. */
static tl_d3 side_plane(const walk *w, int side, uint32_t e) {
    const tl_polytope *p = w->body[side];
    tl_d3 u = tl_d_sub(vertex(w, side, head_of(w, side, e)), vertex(w, side, tail_of(w, side, e)));
    return tl_d_cross(u, tl_polytope_normal(p, p->edges[e].face));
}

/* The edge out of vertex feature i behind whose plane the point lies that is d away from the vertex, all in the body's
 * frame; TL_NO_FEATURE if that is in the vertex's region. */
static uint32_t leave_vertex(const tl_polytope *b, uint32_t i, tl_d3 d) {
    uint32_t first = b->vertex_edge[i], e = first;
    if (first == TL_NO_FEATURE) {
        return TL_NO_FEATURE;
    }
    tl_d3 v = tl_polytope_vertex(b, i);
    do {
        uint32_t twin = tl_hull_twin(e);
        if (tl_d_dot(d, tl_d_sub(tl_polytope_vertex(b, b->edges[twin].origin), v)) > 0.0) {
            return e;
        }
        e = b->edges[twin].next;
    } while (e != first);
    return TL_NO_FEATURE;
}

/* The root of a square of lengths and what it divides by, to 1e-14 of themselves. */
static inline double root(double x, double *inverse) {
    if (x < 1e-30 || x > 1e30) {
        double y = tl_d_sqrt(x);
        *inverse = 1.0 / y;
        return y;
    }
    double r = 1.0 / (double)sqrtf((float)x);
    *inverse = r * (1.5 - 0.5 * x * r * r); /* Newton's step brings 24 bits to 47 */
    return x * *inverse;
}

static tl_d3 unit_or(tl_d3 v, tl_d3 otherwise) {
    double inverse, square = tl_d_dot(v, v);
    (void)root(square > 0.0 ? square : 1.0, &inverse);
    return square > 0.0 ? tl_d_scale(v, inverse) : otherwise;
}

/* The features hold the closest points p and q, in body 0's frame, d from one another; the bodies stand out over edges
 * by `out` times the length of d.
 *
 * Whether they are as far apart along the normal as the features are is looked at once more. In exact arithmetic they
 * always are, and what is asked of a vertex and of a face to end there is just that; of an edge the normals of its
 * faces are asked, which for slivers are off. */
static inline int end(walk *w, tl_d3 p, tl_d3 q, tl_d3 d, double out) {
    tl_closest *c = w->out;
    double size = (double)w->body[0]->size + (double)w->body[1]->size, inverse, square = tl_d_dot(d, d);
    tl_d3 reach = tl_d_sub(p, w->body[0]->center);
    c->point_a = p;
    c->point_b = q;
    c->cores_apart = square > NOTHING * NOTHING * (size * size + tl_d_dot(reach, reach));
    if (!c->cores_apart) {
        return DONE;
    }
    c->gap = root(square, &inverse);
    c->normal = tl_d_scale(d, inverse);
    return out <= (GAP_SLACK * c->gap + SIZE_SLACK * size) * c->gap ? DONE : DOUBT;
}

static int vertex_vertex(walk *w) {
    tl_d3 p = vertex(w, 0, w->at[0].index), q = tl_frame_point(w->frame, vertex(w, 1, w->at[1].index));
    tl_d3 d = tl_d_sub(q, p);
    uint32_t e = leave_vertex(w->body[0], w->at[0].index, d);
    if (e != TL_NO_FEATURE) {
        return go(w, 0, make(TL_FEATURE_EDGE, e));
    }
    e = leave_vertex(w->body[1], w->at[1].index, tl_frame_turn_back(w->frame, tl_d_scale(d, -1.0)));
    return e != TL_NO_FEATURE ? go(w, 1, make(TL_FEATURE_EDGE, e)) : end(w, p, q, d, 0.0);
}

/* How far the corners next to an edge in its faces stand out over its tail along d, times the length of d, in the
 * body's frame. If they do not, what d comes from is in the edge's region, whatever the rounding of the normals. */
static double stand_out(const tl_polytope *b, uint32_t e, tl_d3 tail, tl_d3 d) {
    const tl_half_edge *edges = b->edges;
    double most = 0.0;
    for (uint32_t k = 0; k < 2u && b->face_count > 0u; ++k) {
        uint32_t third = edges[edges[edges[e ^ k].next].next].origin;
        most = tl_d_max(most, tl_d_dot(d, tl_d_sub(tl_polytope_vertex(b, third), tail)));
    }
    return most;
}

/* The face of body `side` beside edge `e`, which is u, over which d leads away from the edge at right angles; kind 0:
 * over neither, by more than normals are rounded, without which edges of parallel faces would be left and come back to.
 */
static feature leave_wedge(const tl_polytope *b, uint32_t e, tl_d3 u, tl_d3 d) {
    tl_d3 m = tl_d_cross(d, u);
    for (uint32_t k = 0; k < 2u && b->face_count > 0u; ++k) {
        uint32_t face = b->edges[e ^ k].face;
        double off = tl_d_dot(m, tl_polytope_normal(b, face));
        if ((k ? off > 0.0 : off < 0.0) && off * off > ROUNDING * ROUNDING * tl_d_dot(m, m)) {
            return make(TL_FEATURE_FACE, face);
        }
    }
    return make(0u, 0u);
}

static inline int vertex_edge(walk *w, int side) {
    const tl_polytope *own = w->body[side], *other = w->body[!side];
    uint32_t i = w->at[side].index, e = w->at[!side].index, t = tail_of(w, !side, e), h = head_of(w, !side, e);
    tl_d3 v = vertex(w, side, i), p = across(w, !side, v), tail = vertex(w, !side, t);
    tl_d3 u = tl_d_sub(vertex(w, !side, h), tail), d = tl_d_sub(p, tail);
    double along = tl_d_dot(d, u), length = tl_d_dot(u, u);
    if (along < 0.0) {
        return go(w, !side, make(TL_FEATURE_VERTEX, t));
    }
    if (along > length) {
        return go(w, !side, make(TL_FEATURE_VERTEX, h));
    }
    tl_d3 foot = tl_d_add(tail, tl_d_scale(u, along / length));
    d = tl_d_sub(p, foot);
    double out = stand_out(other, e, tail, d);
    if (out > 0.0) {
        feature to = leave_wedge(other, e, u, d);
        if (to.kind) {
            return go(w, !side, to);
        }
    }
    tl_d3 seen = across(w, side, foot);
    e = leave_vertex(own, i, tl_d_sub(seen, v));
    if (e != TL_NO_FEATURE) {
        return go(w, side, make(TL_FEATURE_EDGE, e));
    }
    return side ? end(w, foot, p, d, out) : end(w, v, seen, tl_d_sub(seen, v), out);
}

static int edge_edge(walk *w) {
    const tl_polytope *a = w->body[0], *b = w->body[1];
    uint32_t e = w->at[0].index, f = w->at[1].index;
    tl_d3 p0 = vertex(w, 0, tail_of(w, 0, e)), p1 = vertex(w, 0, head_of(w, 0, e));
    tl_d3 tail = vertex(w, 1, tail_of(w, 1, f)), head = vertex(w, 1, head_of(w, 1, f));
    tl_d3 q0 = tl_frame_point(w->frame, tail), q1 = tl_frame_point(w->frame, head);
    double s, t;
    (void)tl_segments(p0, p1, q0, q1, &s, &t);
    if (s <= 0.0 || s >= 1.0) {
        return go(w, 0, make(TL_FEATURE_VERTEX, s <= 0.0 ? tail_of(w, 0, e) : head_of(w, 0, e)));
    }
    if (t <= 0.0 || t >= 1.0) {
        return go(w, 1, make(TL_FEATURE_VERTEX, t <= 0.0 ? tail_of(w, 1, f) : head_of(w, 1, f)));
    }
    tl_d3 u = tl_d_sub(p1, p0), v = tl_d_sub(q1, q0);
    tl_d3 p = tl_d_add(p0, tl_d_scale(u, s)), q = tl_d_add(q0, tl_d_scale(v, t)), d = tl_d_sub(q, p);
    double out_a = stand_out(a, e, p0, d);
    if (out_a > 0.0) {
        feature to = leave_wedge(a, e, u, d);
        if (to.kind) {
            return go(w, 0, to);
        }
    }
    tl_d3 back = tl_frame_turn_back(w->frame, tl_d_scale(d, -1.0));
    double out_b = stand_out(b, f, tail, back);
    if (out_b > 0.0) {
        feature to = leave_wedge(b, f, tl_d_sub(head, tail), back);
        if (to.kind) {
            return go(w, 1, to);
        }
    }
    return end(w, p, q, d, out_a + out_b);
}

/* The edge of the face next to the segment. */
static uint32_t nearest_side(const walk *w, int side, uint32_t face, tl_d3 p, tl_d3 q) {
    const tl_polytope *b = w->body[side];
    uint32_t first = b->face_edge[face], e = first, best = first;
    double least = 1e300, s, t;
    do {
        double d2 =
            tl_segments(vertex(w, side, tail_of(w, side, e)), vertex(w, side, head_of(w, side, e)), p, q, &s, &t);
        if (d2 < least) {
            least = d2, best = e;
        }
        e = b->edges[e].next;
    } while (e != first);
    return best;
}

static int edge_face(walk *w, int side) {
    const tl_polytope *b = w->body[!side];
    uint32_t face = w->at[!side].index, first = b->face_edge[face], k = first, e = w->at[side].index;
    clip c;
    clip_begin(&c, w, side, e);
    do {
        tl_d3 m = side_plane(w, !side, k), on = vertex(w, !side, tail_of(w, !side, k));
        clip_by(&c, -tl_d_dot(tl_d_sub(c.tail, on), m), -tl_d_dot(tl_d_sub(c.head, on), m), make(TL_FEATURE_EDGE, k));
        k = b->edges[k].next;
    } while (k != first && !c.out.kind);
    if (c.out.kind || c.low > c.high) {
        return go(w, !side, make(TL_FEATURE_EDGE, nearest_side(w, !side, face, c.tail, c.head)));
    }
    tl_d3 n = tl_polytope_normal(b, face), on = vertex(w, !side, tail_of(w, !side, first));
    double low = tl_d_dot(n, tl_d_sub(clip_point(&c, c.low), on));
    double high = tl_d_dot(n, tl_d_sub(clip_point(&c, c.high), on));
    if ((low <= 0.0 && high >= 0.0) || (low >= 0.0 && high <= 0.0)) {
        double x = low != high ? low / (low - high) : 0.5;
        return meet(w, !side, clip_point(&c, c.low + x * (c.high - c.low)));
    }
    double rise = low > 0.0 ? tl_d_dot(n, c.u) : -tl_d_dot(n, c.u);
    if (rise >= 0.0) {
        return c.below.kind ? go(w, !side, c.below) : go(w, side, make(TL_FEATURE_VERTEX, tail_of(w, side, e)));
    }
    return c.above.kind ? go(w, !side, c.above) : go(w, side, make(TL_FEATURE_VERTEX, head_of(w, side, e)));
}

/* A vertex of `side`, which in the other's frame is p, stands over a face there, `height` over the corner that stands
 * out furthest: faces are flat to about 1e-6 of their hull. */
static int end_over_face(walk *w, int side, tl_d3 p, tl_d3 n, double height) {
    tl_closest *c = w->out;
    double inverse = 1.5 - 0.5 * tl_d_dot(n, n); /* of a length that is 1 to 1e-5 */
    c->gap = height * inverse;
    n = tl_d_scale(n, inverse);
    tl_d3 foot = tl_d_sub(p, tl_d_scale(n, c->gap));
    c->normal = side ? n : tl_d_scale(tl_frame_turn(w->frame, n), -1.0);
    c->point_a = side ? foot : vertex(w, 0, w->at[0].index);
    c->point_b = side ? p : tl_frame_point(w->frame, foot);
    c->cores_apart = 1;
    return DONE;
}

static inline int vertex_face(walk *w, int side) {
    const tl_polytope *b = w->body[!side];
    uint32_t face = w->at[!side].index, first = b->face_edge[face], k = first, i = w->at[side].index;
    uint32_t outside = 0u, last = 0u;
    tl_d3 p = across(w, !side, vertex(w, side, i)), n = tl_polytope_normal(b, face);
    tl_d3 tail = tl_polytope_vertex(b, b->edges[first].origin);
    double height = tl_d_dot(n, tl_d_sub(p, tail)), low = height;
    do {
        uint32_t next = b->edges[k].next;
        tl_d3 head = tl_polytope_vertex(b, b->edges[next].origin), d = tl_d_sub(p, tail);
        if (tl_d_dot(d, tl_d_cross(tl_d_sub(head, tail), n)) > 0.0) {
            ++outside, last = k;
        }
        low = tl_d_min(low, tl_d_dot(n, d));
        k = next;
        tail = head;
    } while (k != first);
    if (outside) {
        return go(w, !side, make(TL_FEATURE_EDGE, outside == 1u ? last : nearest_side(w, !side, face, p, p)));
    }
    if (height == 0.0) {
        return meet(w, !side, p);
    }
    tl_d3 m = side ? tl_frame_turn_back(w->frame, n) : tl_frame_turn(w->frame, n);
    uint32_t e = leave_vertex(w->body[side], i, height > 0.0 ? tl_d_scale(m, -1.0) : m);
    if (e != TL_NO_FEATURE) {
        return go(w, side, make(TL_FEATURE_EDGE, e));
    }
    if (height > 0.0) {
        return end_over_face(w, side, p, n, low);
    }
    uint32_t seen = tl_polytope_face_towards(b, face, p, &height);
    if (height <= 1.0 || seen == face) {
        return meet(w, !side, p);
    }
    return go(w, !side, make(TL_FEATURE_FACE, seen));
}

/* Each side by itself: what is known when it is compiled is not asked on the way. */
static int step(walk *w) {
    uint32_t a = w->at[0].kind, b = w->at[1].kind;
    if (a == TL_FEATURE_FACE) {
        return b == TL_FEATURE_VERTEX ? vertex_face(w, 1) : edge_face(w, 1);
    }
    if (b == TL_FEATURE_FACE) {
        return a == TL_FEATURE_VERTEX ? vertex_face(w, 0) : edge_face(w, 0);
    }
    if (a == TL_FEATURE_EDGE) {
        return b == TL_FEATURE_EDGE ? edge_edge(w) : vertex_edge(w, 1);
    }
    return b == TL_FEATURE_EDGE ? vertex_edge(w, 0) : vertex_vertex(w);
}

static uint32_t pack(feature f) { return TL_FEATURE(f.kind, f.index); }
static feature unpack(uint32_t word) { return make(TL_FEATURE_KIND(word), TL_FEATURE_INDEX(word)); }

/* Vertices near to the closest points. How far apart the bodies are along a unit direction n is n.w, w being the way
 * from A's vertex furthest along n to B's furthest against it. That is concave in n, its greatest value the distance,
 * and w its gradient: n + w / r, brought back to unit length, climbs it. With r the sum of both radii the first step
 * goes all the way for balls; a step that leads down was too long. */
static void start(walk *w) {
    const tl_polytope *a = w->body[0], *b = w->body[1];
    double radius = (double)a->size + (double)b->size, most = -1e300;
    tl_d3 n = tl_d_sub(tl_frame_point(w->frame, b->center), a->center), best = n, way = n;
    uint32_t ia = 0u, ib = 0u;
    n = unit_or(n, tl_d(0.0, 1.0, 0.0));
    for (int round = 0; round < START_ROUNDS; ++round) {
        uint32_t ja = tl_polytope_seed(a, n);
        uint32_t jb = tl_polytope_seed(b, tl_frame_turn_back(w->frame, tl_d_scale(n, -1.0)));
        tl_d3 to = tl_d_sub(tl_frame_point(w->frame, vertex(w, 1, jb)), vertex(w, 0, ja));
        double apart = tl_d_dot(n, to);
        int again = round > 0 && ja == ia && jb == ib;
        if (apart > most) {
            most = apart, best = n, way = to, ia = ja, ib = jb;
        } else {
            radius *= START_SHORTER;
        }
        if (again) {
            break;
        }
        n = unit_or(tl_d_add(tl_d_scale(best, radius), way), best);
    }
    ia = tl_polytope_near(a, best, ia);
    ib = tl_polytope_near(b, tl_frame_turn_back(w->frame, tl_d_scale(best, -1.0)), ib);
    w->at[0] = make(TL_FEATURE_VERTEX, ia);
    w->at[1] = make(TL_FEATURE_VERTEX, ib);
}

/* From the cores to the surfaces. */
static void swell(tl_closest *out, float ra, float rb) {
    out->apart = 0;
    if (out->cores_apart && ra + rb == 0.0f) {
        out->apart = 1;
    } else if (out->cores_apart) {
        double low = tl_d_max(out->gap - (double)rb, 0.0), high = tl_d_min(out->gap, (double)ra);
        out->gap -= (double)ra + (double)rb;
        out->apart = out->gap > 0.0;
        if (!out->apart) { /* between the cores, within reach of both radii */
            out->common = tl_d_add(out->point_a, tl_d_scale(out->normal, 0.5 * (low + high)));
        }
        out->point_a = tl_d_add(out->point_a, tl_d_scale(out->normal, (double)ra));
        out->point_b = tl_d_sub(out->point_b, tl_d_scale(out->normal, (double)rb));
    } else {
        out->gap = 0.0;
        out->common = out->point_b = out->point_a;
        out->normal = tl_d(0.0, 0.0, 0.0);
    }
}

void tl_closest_cores(const tl_polytope *a, const tl_polytope *b, const tl_frame *frame, tl_core *ca, tl_core *cb) {
    talus_pose identity = tl_pose_identity();
    tl_core_init(ca, a->shape, NULL);
    tl_core_init(cb, b->shape, &identity);
    cb->r.x = tl_d_round(frame->x);
    cb->r.y = tl_d_round(frame->y);
    cb->r.z = tl_d_round(frame->z);
    cb->t = tl_d_round(frame->t);
}

static void by_gjk(const tl_polytope *a, const tl_polytope *b, const tl_frame *frame, tl_closest *out) {
    tl_core ca, cb;
    tl_simplex simplex;
    tl_gjk near;
    tl_closest_cores(a, b, frame, &ca, &cb);
    simplex.count = 0;
    talus_vec3 guess = tl_normalize_or(cb.t, tl_v(0.0f, 1.0f, 0.0f));
    out->cores_apart = tl_gjk_run(&ca, &cb, guess, 3e38f, &simplex, &near) == TL_GJK_APART;
    out->gap = (double)near.distance;
    out->point_a = tl_d_from(near.point_a);
    out->point_b = tl_d_from(near.point_b);
    out->normal = out->cores_apart ? tl_d_from(near.normal) : tl_d(0.0, 0.0, 0.0);
    out->features.a = out->features.b = 0u;
    if (!a->round && !b->round) {
        out->features.a = pack(make(TL_FEATURE_VERTEX, simplex.vertex[0].ia));
        out->features.b = pack(make(TL_FEATURE_VERTEX, simplex.vertex[0].ib));
    }
    swell(out, ca.radius, cb.radius);
}

void tl_closest_find(const tl_polytope *a, const tl_polytope *b, const tl_frame *b_in_a, talus_feature_pair features,
                     tl_closest *out) {
    out->steps = 0u;
    out->gave_up = 0u;
    if (a->round || b->round) {
        by_gjk(a, b, b_in_a, out);
        return;
    }
    walk w = {{a, b}, b_in_a, {unpack(features.a), unpack(features.b)}, out};
    if (!tl_polytope_has(a, features.a) || !tl_polytope_has(b, features.b) ||
        (w.at[0].kind == TL_FEATURE_FACE && w.at[1].kind == TL_FEATURE_FACE)) {
        start(&w);
    }
    int state;
    while ((state = step(&w)) == STEP && out->steps < MAX_STEPS) {
        ++out->steps;
    }
    if (state != DONE) {
        out->gave_up = 1u;
        by_gjk(a, b, b_in_a, out);
        return;
    }
    out->features.a = pack(w.at[0]);
    out->features.b = pack(w.at[1]);
    swell(out, a->radius, b->radius);
}
