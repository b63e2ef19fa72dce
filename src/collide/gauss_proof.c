/* The proof that no direction is less deep: branch and bound over the sphere of directions. The depth along n is the
 * largest p.n over the points p of the Minkowski difference A - B, so that any such p bounds it from below; over a
 * triangle of directions p.n is, where positive, not less than at the worst corner m (n is a sum of the corners with
 * weights that add to 1 or more). Each corner brings the point that supports it, and the point of these three's
 * triangle next to the origin counts as well: around the face that is the answer it is the face's own foot, whose bound
 * is as good as the square of the triangle's size. Triangles that may hide less are halved across their longest side,
 * and where a new corner is less deep the descent goes on from there. Metres. */
#include "collide/gauss_walk.h"

#define MAX_LOOKS 200000u
#define STACK 128
#define RELATIVE 1e-6 /* of the depth */
#define FLOOR 1e-6    /* of the sizes */

typedef struct triangle {
    tl_gauss_depth corner[3];
} triangle;

static double worst_corner(const triangle *t, tl_d3 p) {
    return tl_d_min(tl_d_dot(p, t->corner[0].n), tl_d_min(tl_d_dot(p, t->corner[1].n), tl_d_dot(p, t->corner[2].n)));
}

static tl_d3 nearer(tl_d3 p, tl_d3 q) { return tl_d_dot(p, p) <= tl_d_dot(q, q) ? p : q; }

static tl_d3 segment_foot(tl_d3 p, tl_d3 q) {
    tl_d3 u = tl_d_sub(q, p);
    double l = tl_d_dot(u, u), s = -tl_d_dot(p, u);
    return s <= 0.0 ? p : s >= l ? q : tl_d_add(p, tl_d_scale(u, s / l));
}

/* The point of a triangle next to the origin. */
static tl_d3 triangle_foot(tl_d3 a, tl_d3 b, tl_d3 c) {
    tl_d3 n = tl_d_cross(tl_d_sub(b, a), tl_d_sub(c, a));
    double nn = tl_d_dot(n, n), la = tl_d_dot(tl_d_cross(b, c), n), lb = tl_d_dot(tl_d_cross(c, a), n),
           lc = tl_d_dot(tl_d_cross(a, b), n);
    if (nn > 0.0 && la >= 0.0 && lb >= 0.0 && lc >= 0.0) {
        double s = la + lb + lc;
        return tl_d_add(tl_d_add(tl_d_scale(a, la / s), tl_d_scale(b, lb / s)), tl_d_scale(c, lc / s));
    }
    return nearer(segment_foot(a, b), nearer(segment_foot(b, c), segment_foot(c, a)));
}

/* Whether nothing in the triangle is less than the goal. */
static int is_bounded(const triangle *t, double goal) {
    tl_d3 a = t->corner[0].p, b = t->corner[1].p, c = t->corner[2].p;
    double best = worst_corner(t, triangle_foot(a, b, c));
    best = tl_d_max(best, worst_corner(t, a));
    best = tl_d_max(best, worst_corner(t, b));
    best = tl_d_max(best, worst_corner(t, c));
    /* the weights of three corners at right angles add to the root of 3 at most */
    return (best >= 0.0 ? best : 1.7320509 * best) >= goal;
}

static void look(tl_gauss_pair *pair, tl_d3 n, uint32_t ia, uint32_t ib, tl_gauss_depth *at, tl_gauss_depth *best) {
    tl_gauss_look(pair, n, ia, ib, at);
    if (at->value < best->value) {
        *best = *at;
        tl_gauss_descend(pair, best);
    }
}

/* Both halves of a triangle, cut across its longest side. */
static void halve(tl_gauss_pair *pair, const triangle *t, triangle half[2], tl_gauss_depth *best) {
    int k = 0;
    double least = 2.0;
    for (int i = 0; i < 3; ++i) {
        double cosine = tl_d_dot(t->corner[i].n, t->corner[(i + 1) % 3].n);
        if (cosine < least) {
            least = cosine, k = i;
        }
    }
    const tl_gauss_depth *p = &t->corner[k], *q = &t->corner[(k + 1) % 3], *r = &t->corner[(k + 2) % 3];
    tl_d3 n = tl_d_add(p->n, q->n);
    tl_gauss_depth middle;
    look(pair, tl_d_scale(n, 1.0 / tl_d_length(n)), p->ia, p->ib, &middle, best);
    half[0].corner[0] = *p, half[0].corner[1] = middle, half[0].corner[2] = *r;
    half[1].corner[0] = middle, half[1].corner[1] = *q, half[1].corner[2] = *r;
}

int tl_gauss_prove(tl_gauss_pair *pair, tl_gauss_depth *best) {
    static const double axis[6][3] = {{1.0, 0.0, 0.0},  {0.0, 1.0, 0.0},  {0.0, 0.0, 1.0},
                                      {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, -1.0}};
    double floor = FLOOR * ((double)pair->a->size + (double)pair->b->size);
    tl_gauss_depth end[6];
    triangle stack[STACK];
    for (int i = 0; i < 6; ++i) {
        look(pair, tl_d(axis[i][0], axis[i][1], axis[i][2]), best->ia, best->ib, &end[i], best);
    }
    for (int octant = 0; octant < 8; ++octant) {
        int count = 1;
        for (int i = 0; i < 3; ++i) {
            stack[0].corner[i] = end[i + (octant >> i & 1) * 3];
        }
        while (count > 0 && best->value > 0.0) {
            triangle t = stack[--count];
            if (is_bounded(&t, best->value * (1.0 - RELATIVE) - floor)) {
                continue;
            }
            if (pair->supports >= MAX_LOOKS || count + 2 > STACK) {
                return 0;
            }
            halve(pair, &t, &stack[count], best);
            count += 2;
        }
    }
    return 1;
}
