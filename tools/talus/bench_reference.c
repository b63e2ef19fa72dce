/* What the queries' answers are measured by: distances and depths in double precision, by other means than the queries
 * and with all vertices. Metres. */
#include "bench_queries.h"

#include "collide/polytope.h"

#include <math.h>

#define ROUNDS 1000
#define END 1e-14 /* of the squared distance, between both bounds */

/* Both hulls in A's frame. */
typedef struct placed {
    tl_polytope a, b;
    tl_frame frame;
} placed;

static void place(const bench_case *c, uint32_t pose, placed *p) {
    tl_polytope_init(&p->a, &c->shape_a);
    tl_polytope_init(&p->b, &c->shape_b);
    p->frame = tl_frame_of(&c->poses[pose]);
}

static tl_d3 unit(tl_d3 v) { return tl_d_scale(v, 1.0 / sqrt(tl_d_dot(v, v))); }

static tl_d3 furthest(const tl_polytope *p, tl_d3 direction) {
    tl_d3 best = tl_polytope_vertex(p, 0);
    for (uint32_t i = 1; i < p->vertex_count; i++) {
        tl_d3 v = tl_polytope_vertex(p, i);
        best = tl_d_dot(v, direction) > tl_d_dot(best, direction) ? v : best;
    }
    return best;
}

/* The point of B - A furthest along a direction. */
static tl_d3 support(const placed *p, tl_d3 direction) {
    tl_d3 b = furthest(&p->b, tl_frame_turn_back(&p->frame, direction));
    return tl_d_sub(tl_frame_point(&p->frame, b), furthest(&p->a, tl_d_scale(direction, -1.0)));
}

/* Weights that sum to 1 of the point of the plane through 1, 2 or 3 points, or of space, next to the origin; 0 if one
 * is not positive. */
static int weigh(const tl_d3 *p, int count, double *w) {
    if (count == 1) {
        w[0] = 1.0;
        return 1;
    }
    if (count == 2) {
        tl_d3 u = tl_d_sub(p[1], p[0]);
        w[1] = -tl_d_dot(p[0], u) / tl_d_dot(u, u);
        w[0] = 1.0 - w[1];
        return w[0] > 0.0 && w[1] > 0.0;
    }
    tl_d3 n = tl_d_cross(tl_d_sub(p[1], p[0]), tl_d_sub(p[2], p[0]));
    double nn = tl_d_dot(n, n);
    w[0] = tl_d_dot(tl_d_cross(p[1], p[2]), n) / nn;
    w[1] = tl_d_dot(tl_d_cross(p[2], p[0]), n) / nn;
    w[2] = tl_d_dot(tl_d_cross(p[0], p[1]), n) / nn;
    return w[0] > 0.0 && w[1] > 0.0 && w[2] > 0.0;
}

/* Keeps of up to four points those that the point next to the origin is made of, by trying all triples, pairs and
 * single points. */
static tl_d3 reduce(tl_d3 *p, int *count) {
    double best = HUGE_VAL;
    tl_d3 at = p[0], kept[3];
    int keep = 0;
    for (int mask = 1; mask < 1 << *count; mask++) {
        tl_d3 q[3], v = tl_d(0.0, 0.0, 0.0);
        double w[3];
        int n = 0;
        for (int i = 0; i < *count; i++) {
            if (mask >> i & 1) {
                if (n < 3) {
                    q[n] = p[i];
                }
                n++;
            }
        }
        if (n > 3 || !weigh(q, n, w)) {
            continue;
        }
        for (int i = 0; i < n; i++) {
            v = tl_d_add(v, tl_d_scale(q[i], w[i]));
        }
        if (tl_d_dot(v, v) < best) {
            best = tl_d_dot(v, v), at = v, keep = n;
            for (int i = 0; i < n; i++) {
                kept[i] = q[i];
            }
        }
    }
    for (int i = 0; i < keep; i++) {
        p[i] = kept[i];
    }
    *count = keep;
    return at;
}

double bench_distance(const bench_case *c, uint32_t pose) {
    placed p;
    tl_d3 simplex[4];
    int count = 1;
    place(c, pose, &p);
    simplex[0] = support(&p, tl_d(-1.0, 0.0, 0.0));
    tl_d3 v = simplex[0];
    double nearest = tl_d_dot(v, v);
    for (int round = 0; round < ROUNDS; round++) {
        tl_d3 next = support(&p, tl_d_scale(v, -1.0));
        if (tl_d_dot(v, v) - tl_d_dot(v, next) <= END * nearest) {
            break;
        }
        simplex[count++] = next;
        v = reduce(simplex, &count);
        if (tl_d_dot(v, v) >= nearest) {
            break; /* no more digits */
        }
        nearest = tl_d_dot(v, v);
    }
    return sqrt(nearest);
}

static tl_d3 corner(const placed *p, int side, uint32_t i) {
    return side ? tl_frame_point(&p->frame, tl_polytope_vertex(&p->b, i)) : tl_polytope_vertex(&p->a, i);
}

/* The least distance of a vertex of one from the faces of the other that it stands over. */
static double over_faces(const placed *p, int side) {
    const tl_polytope *s = side ? &p->b : &p->a, *other = side ? &p->a : &p->b;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < other->vertex_count; i++) {
        tl_d3 v = tl_polytope_vertex(other, i);
        v = side ? tl_frame_point_back(&p->frame, v) : tl_frame_point(&p->frame, v);
        for (uint32_t f = 0; f < s->face_count; f++) {
            tl_d3 n = unit(tl_polytope_normal(s, f));
            uint32_t first = s->face_edge[f], e = first;
            double height = tl_d_dot(n, tl_d_sub(v, tl_polytope_vertex(s, s->edges[e].origin)));
            int inside = height > 0.0 && height < least;
            while (inside) {
                tl_d3 tail = tl_polytope_vertex(s, s->edges[e].origin);
                tl_d3 u = tl_d_sub(tl_polytope_vertex(s, s->edges[e ^ 1u].origin), tail);
                inside = tl_d_dot(tl_d_cross(n, u), tl_d_sub(v, tail)) >= 0.0;
                e = s->edges[e].next;
                if (e == first) {
                    break;
                }
            }
            least = inside ? height : least;
        }
    }
    return least;
}

double bench_distance_by_all(const bench_case *c, uint32_t pose) {
    placed p;
    place(c, pose, &p);
    double least = tl_d_min(over_faces(&p, 0), over_faces(&p, 1));
    least = least < HUGE_VAL ? least * least : HUGE_VAL;
    for (uint32_t e = 0; e < p.a.edge_count; e += 2u) {
        tl_d3 p0 = corner(&p, 0, p.a.edges[e].origin), p1 = corner(&p, 0, p.a.edges[e + 1u].origin);
        for (uint32_t f = 0; f < p.b.edge_count; f += 2u) {
            double s, t,
                d2 = tl_segments(p0, p1, corner(&p, 1, p.b.edges[f].origin), corner(&p, 1, p.b.edges[f + 1u].origin),
                                 &s, &t);
            least = d2 < least ? d2 : least;
        }
    }
    return sqrt(least);
}

/* The depth along the unit direction n from A to B. */
static double along(const placed *p, tl_d3 n) { return -tl_d_dot(n, support(p, tl_d_scale(n, -1.0))); }

double bench_depth(const bench_case *c, uint32_t pose) {
    placed p;
    place(c, pose, &p);
    double least = HUGE_VAL;
    for (int side = 0; side < 2; side++) {
        const tl_polytope *s = side ? &p.b : &p.a;
        for (uint32_t f = 0; f < s->face_count; f++) {
            tl_d3 n = unit(tl_polytope_normal(s, f));
            least = tl_d_min(least, along(&p, side ? tl_frame_turn(&p.frame, tl_d_scale(n, -1.0)) : n));
        }
    }
    for (uint32_t e = 0; e < p.a.edge_count; e += 2u) {
        tl_d3 tail = tl_polytope_vertex(&p.a, p.a.edges[e].origin);
        tl_d3 u = tl_frame_turn_back(&p.frame, tl_d_sub(tl_polytope_vertex(&p.a, p.a.edges[e + 1u].origin), tail));
        tl_d3 left = tl_frame_turn_back(&p.frame, tl_polytope_normal(&p.a, p.a.edges[e].face));
        tl_d3 right = tl_frame_turn_back(&p.frame, tl_polytope_normal(&p.a, p.a.edges[e + 1u].face));
        tl_d3 foot = tl_frame_point_back(&p.frame, tail), outward = tl_d_add(left, right);
        for (uint32_t f = 0; f < p.b.edge_count; f += 2u) {
            tl_d3 at = tl_polytope_vertex(&p.b, p.b.edges[f].origin);
            tl_d3 v = tl_d_sub(tl_polytope_vertex(&p.b, p.b.edges[f + 1u].origin), at);
            /* the arcs of both edges on the sphere of normals, B's turned round, must cross */
            double l = tl_d_dot(left, v), r = tl_d_dot(right, v);
            double m = tl_d_dot(tl_polytope_normal(&p.b, p.b.edges[f].face), u);
            double k = tl_d_dot(tl_polytope_normal(&p.b, p.b.edges[f + 1u].face), u);
            if (l * r > 0.0 || m * k > 0.0 || m * r > 0.0) {
                continue;
            }
            tl_d3 n = tl_d_cross(u, v);
            double height = tl_d_dot(n, tl_d_sub(foot, at)), length = sqrt(tl_d_dot(n, n));
            height = tl_d_dot(n, outward) < 0.0 ? -height : height;
            least = length > 0.0 && height < least * length ? height / length : least;
        }
    }
    return least;
}
