/* Depth of overlap of convex cores: van den Bergen, Proximity Queries and Penetration Depth Computation on 3D Game
 * Objects, 2001 (expanding polytope). Each support point bounds the depth from above along its own direction, so that
 * the least of these bounds is a true way out even where rounding ends the expansion early. The polytope is kept in
 * double and scaled by the sizes of the shapes; results are metres. */
#include "collide/gjk.h"

#include <string.h>

#define MAX_VERTICES 96
#define MAX_FACES 192
#define NO_FACE 0xffffu
/* Scaled lengths: a point this near to the others spans nothing; a bound this near to its face is met. */
#define FLAT 1e-6
#define TOLERANCE 1e-6

typedef struct vec {
    double x, y, z;
} vec;

typedef struct face {
    uint16_t v[3];    /* counter-clockwise seen from outside */
    uint16_t next[3]; /* the face across the edge from v[i] to v[i + 1] */
    uint16_t state;   /* 0 free, 1 in use, 2 seen from the new point */
    vec n;
    double d;
} face;

typedef struct horizon_edge {
    uint16_t outer, outer_edge, from, to;
} horizon_edge;

typedef struct polytope {
    const tl_core *a, *b;
    double scale;
    uint32_t vertex_count, face_end;
    tl_simplex_vertex vertex[MAX_VERTICES];
    vec w[MAX_VERTICES];
    face face[MAX_FACES];
    tl_depth best;
    uint16_t best_face[3];
    int have_best;
    float best_depth;
} polytope;

static inline vec vec_sub(vec a, vec b) {
    vec r = {a.x - b.x, a.y - b.y, a.z - b.z};
    return r;
}
static inline double vec_dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec vec_cross(vec a, vec b) {
    vec r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}
static inline double absolute(double x) { return x < 0.0 ? -x : x; }

static talus_vec3 to_unit(vec v) {
    double m = absolute(v.x) > absolute(v.y) ? absolute(v.x) : absolute(v.y);
    m = absolute(v.z) > m ? absolute(v.z) : m;
    if (!(m > 0.0)) {
        return tl_v(0.0f, 1.0f, 0.0f);
    }
    return tl_normalize_or(tl_v((float)(v.x / m), (float)(v.y / m), (float)(v.z / m)), tl_v(0.0f, 1.0f, 0.0f));
}

static void store(polytope *p, uint32_t i, const tl_simplex_vertex *v) {
    p->vertex[i] = *v;
    p->w[i].x = ((double)v->b.x - (double)v->a.x) * p->scale;
    p->w[i].y = ((double)v->b.y - (double)v->a.y) * p->scale;
    p->w[i].z = ((double)v->b.z - (double)v->a.z) * p->scale;
}

/* The point of B - A that is furthest along m, into slot `i`, and the bound that it sets on the depth. */
static float support(polytope *p, talus_vec3 m, uint32_t i) {
    tl_simplex_vertex v;
    v.ia = v.ib = 0u;
    talus_vec3 n = tl_neg(m);
    float apart = tl_core_separation(p->a, p->b, n, &v.ia, &v.ib, &v.a, &v.b);
    store(p, i, &v);
    return -apart;
}

/* Unit normal and offset of a face; 0 if it has no area. */
static int set_plane(polytope *p, face *f) {
    vec a = p->w[f->v[0]], ab = vec_sub(p->w[f->v[1]], a), ac = vec_sub(p->w[f->v[2]], a);
    vec n = vec_cross(ab, ac);
    double nn = vec_dot(n, n);
    if (!(nn > 1e-28)) {
        return 0;
    }
    double l = (double)sqrtf((float)nn);
    l = 0.5 * (l + nn / l); /* one step of Newton makes the float root a double one */
    f->n.x = n.x / l;
    f->n.y = n.y / l;
    f->n.z = n.z / l;
    f->d = vec_dot(f->n, a);
    return 1;
}

/* Adds a point off the line or plane of those there are, trying directions in turn; 0 if the difference is flat. */
static int grow(polytope *p) {
    uint32_t c = p->vertex_count;
    talus_vec3 dir[6] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    uint32_t dirs = 3;
    vec e = {0.0, 0.0, 0.0};
    if (c == 2) {
        e = vec_sub(p->w[1], p->w[0]);
        talus_vec3 along = to_unit(e);
        dir[0] = tl_perpendicular(along);
        dir[1] = tl_normalize_or(tl_cross(along, dir[0]), tl_v(1.0f, 0.0f, 0.0f));
        dirs = 2;
    } else if (c == 3) {
        e = vec_cross(vec_sub(p->w[1], p->w[0]), vec_sub(p->w[2], p->w[0]));
        dir[0] = to_unit(e);
        dirs = 1;
    }
    double ee = vec_dot(e, e);
    for (uint32_t i = 0; i < 2u * dirs; ++i) {
        support(p, (i & 1u) ? tl_neg(dir[i / 2u]) : dir[i / 2u], c);
        vec d = vec_sub(p->w[c], p->w[0]);
        double off2 = vec_dot(d, d);
        if (c == 2) {
            vec x = vec_cross(d, e);
            off2 = vec_dot(x, x) / ee;
        } else if (c == 3) {
            double x = vec_dot(d, e);
            off2 = x * x / ee;
        }
        if (off2 > FLAT * FLAT) {
            p->vertex_count = c + 1u;
            return 1;
        }
    }
    return 0;
}

/* Drops vertices of the first simplex that lie on what the others span. */
static void take_simplex(polytope *p, const tl_simplex *s) {
    p->vertex_count = 0;
    for (uint32_t i = 0; i < s->count && p->vertex_count < 4; ++i) {
        uint32_t c = p->vertex_count;
        store(p, c, &s->vertex[i]);
        vec d = vec_sub(p->w[c], p->w[0]);
        double off2 = c == 0 ? 1.0 : vec_dot(d, d);
        if (c == 2 && off2 > FLAT * FLAT) {
            vec e = vec_sub(p->w[1], p->w[0]), x = vec_cross(d, e);
            off2 = vec_dot(x, x) / vec_dot(e, e);
        } else if (c == 3) {
            vec e = vec_cross(vec_sub(p->w[1], p->w[0]), vec_sub(p->w[2], p->w[0]));
            double x = vec_dot(d, e);
            off2 = x * x / vec_dot(e, e);
        }
        p->vertex_count += off2 > FLAT * FLAT;
    }
}

static int first_faces(polytope *p) {
    static const uint16_t corner[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    static const uint16_t next[4][3] = {{1, 3, 2}, {2, 3, 0}, {0, 3, 1}, {1, 2, 0}};
    vec n = vec_cross(vec_sub(p->w[1], p->w[0]), vec_sub(p->w[2], p->w[0]));
    if (vec_dot(n, vec_sub(p->w[3], p->w[0])) > 0.0) {
        /* the first face must look away from the fourth point */
        tl_simplex_vertex v = p->vertex[1];
        vec w = p->w[1];
        p->vertex[1] = p->vertex[2];
        p->w[1] = p->w[2];
        p->vertex[2] = v;
        p->w[2] = w;
    }
    for (uint32_t i = 0; i < 4; ++i) {
        face *f = &p->face[i];
        memcpy(f->v, corner[i], sizeof f->v);
        memcpy(f->next, next[i], sizeof f->next);
        f->state = 1;
        if (!set_plane(p, f)) {
            return 0;
        }
    }
    p->face_end = 4;
    return 1;
}

/* Marks the faces that the point sees, from `seed` outwards, and lists the edges around them. 0 if there is no room. */
static uint32_t find_horizon(polytope *p, uint32_t seed, vec w, horizon_edge *edge, uint32_t room) {
    uint16_t stack[MAX_FACES];
    uint32_t depth = 0, count = 0;
    stack[depth++] = (uint16_t)seed;
    p->face[seed].state = 2;
    while (depth > 0) {
        uint16_t at = stack[--depth];
        const face *f = &p->face[at];
        for (uint32_t i = 0; i < 3; ++i) {
            uint16_t to = f->next[i];
            face *g = &p->face[to];
            if (g->state == 2) {
                continue;
            }
            if (vec_dot(g->n, w) - g->d > 1e-12) {
                g->state = 2;
                stack[depth++] = to;
            } else {
                uint16_t back = 0;
                while (back < 2 && g->next[back] != at) {
                    ++back;
                }
                if (count == room) {
                    return 0;
                }
                edge[count].outer = to;
                edge[count].outer_edge = back;
                edge[count].from = f->v[i];
                edge[count].to = f->v[(i + 1u) % 3u];
                ++count;
            }
        }
    }
    return count;
}

/* Puts vertex `v` into the polytope in place of the faces that it sees. 0 where rounding leaves no sound polytope. */
static int insert(polytope *p, uint32_t v, uint32_t seed) {
    horizon_edge edge[MAX_FACES];
    uint16_t starting[MAX_VERTICES], slot[MAX_FACES];
    uint32_t count = find_horizon(p, seed, p->w[v], edge, MAX_FACES);
    if (count < 3) {
        return 0;
    }
    memset(starting, 0xff, sizeof starting);
    uint32_t used = 0;
    for (uint32_t i = 0; i < MAX_FACES && used < count; ++i) {
        if (i >= p->face_end || p->face[i].state != 1) {
            slot[used++] = (uint16_t)i;
            if (i >= p->face_end) {
                p->face_end = i + 1u;
            }
        }
    }
    if (used < count) {
        return 0;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (starting[edge[i].from] != NO_FACE) {
            return 0;
        }
        starting[edge[i].from] = slot[i];
    }
    for (uint32_t i = 0; i < p->face_end; ++i) {
        p->face[i].state = p->face[i].state == 1;
    }
    for (uint32_t i = 0; i < count; ++i) {
        face *f = &p->face[slot[i]];
        uint16_t after = starting[edge[i].to];
        if (after == NO_FACE) {
            return 0;
        }
        f->v[0] = edge[i].from;
        f->v[1] = edge[i].to;
        f->v[2] = (uint16_t)v;
        f->next[0] = edge[i].outer;
        f->next[1] = after;
        p->face[after].next[2] = slot[i];
        p->face[edge[i].outer].next[edge[i].outer_edge] = slot[i];
        f->state = 1;
        if (!set_plane(p, f)) {
            return 0;
        }
    }
    return 1;
}

static void note(polytope *p, float depth, talus_vec3 m, const face *f) {
    if (!p->have_best || depth < p->best_depth) {
        p->have_best = 1;
        p->best_depth = depth;
        p->best.normal = tl_neg(m);
        memcpy(p->best_face, f->v, sizeof p->best_face);
    }
}

/* Weights of the corners for the point of a face's plane next to the origin, not brought to the sum 1, which is
 * returned. */
static double weigh(const polytope *p, const uint16_t *v, double *l) {
    vec a = p->w[v[0]], b = p->w[v[1]], c = p->w[v[2]];
    vec n = vec_cross(vec_sub(b, a), vec_sub(c, a));
    l[0] = vec_dot(vec_cross(b, c), n);
    l[1] = vec_dot(vec_cross(c, a), n);
    l[2] = vec_dot(vec_cross(a, b), n);
    return l[0] + l[1] + l[2];
}

static double least_weight(const double *l) {
    double m = l[0] < l[1] ? l[0] : l[1];
    return m < l[2] ? m : l[2];
}

/* A flat part of the surface may be cut into several faces: takes the one that the origin lies over. */
static void find_over(polytope *p) {
    vec n = {-(double)p->best.normal.x, -(double)p->best.normal.y, -(double)p->best.normal.z};
    double depth = (double)p->best_depth * p->scale, most = -1e300, l[3];
    for (uint32_t i = 0; i < p->face_end; ++i) {
        const face *f = &p->face[i];
        if (f->state != 1 || absolute(f->d - depth) > 10.0 * TOLERANCE || vec_dot(f->n, n) < 0.999) {
            continue;
        }
        double s = weigh(p, f->v, l), least = s > 0.0 ? least_weight(l) / s : -1e300;
        if (least > most) {
            most = least;
            memcpy(p->best_face, f->v, sizeof f->v);
        }
    }
}

/* The points of A and B where the face that set the depth comes nearest to the origin. */
static void witness(polytope *p) {
    const uint16_t *v = p->best_face;
    double l[3], s = 0.0;
    weigh(p, v, l);
    for (int i = 0; i < 3; ++i) {
        l[i] = l[i] > 0.0 ? l[i] : 0.0;
        s += l[i];
    }
    if (!(s > 0.0)) {
        l[0] = s = 1.0;
        l[1] = l[2] = 0.0;
    }
    talus_vec3 pa = {0.0f, 0.0f, 0.0f}, pb = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 3; ++i) {
        pa = tl_mad(pa, (float)(l[i] / s), p->vertex[v[i]].a);
        pb = tl_mad(pb, (float)(l[i] / s), p->vertex[v[i]].b);
    }
    p->best.point_a = pa;
    p->best.point_b = pb;
}

/* A difference of no volume: the way out is across it, and the depth that of rounding. */
static void flat_depth(polytope *p) {
    talus_vec3 n = tl_v(0.0f, 1.0f, 0.0f);
    if (p->vertex_count == 3) {
        n = to_unit(vec_cross(vec_sub(p->w[1], p->w[0]), vec_sub(p->w[2], p->w[0])));
    } else if (p->vertex_count == 2) {
        n = tl_perpendicular(to_unit(vec_sub(p->w[1], p->w[0])));
    }
    uint32_t c = p->vertex_count;
    float forth = support(p, tl_neg(n), c), back = support(p, n, c);
    p->best.normal = back < forth ? tl_neg(n) : n;
    p->best_depth = tl_min(forth, back);
    for (uint32_t i = 0; i < 3; ++i) {
        p->best_face[i] = (uint16_t)(i < c ? i : 0u);
    }
}

static void expand(polytope *p) {
    while (p->vertex_count < MAX_VERTICES) {
        uint32_t at = 0;
        double least = 1e300;
        for (uint32_t i = 0; i < p->face_end; ++i) {
            if (p->face[i].state == 1 && p->face[i].d < least) {
                least = p->face[i].d;
                at = i;
            }
        }
        talus_vec3 m = to_unit(p->face[at].n);
        uint32_t v = p->vertex_count;
        float bound = support(p, m, v);
        if (vec_dot(p->face[at].n, p->w[v]) - least <= TOLERANCE) {
            /* the nearest face is the surface: its own points are the ones that touch */
            p->have_best = 0;
            note(p, bound, m, &p->face[at]);
            find_over(p);
            return;
        }
        note(p, bound, m, &p->face[at]);
        p->vertex_count = v + 1u;
        if (!insert(p, v, at)) {
            return;
        }
    }
}

static void start(polytope *p, const tl_core *a, const tl_core *b) {
    p->a = a;
    p->b = b;
    p->scale = 1.0 / ((double)a->size + (double)b->size);
    p->have_best = 0;
    p->best_depth = 0.0f;
    p->vertex_count = 0;
}

static void finish(polytope *p, tl_depth *out) {
    witness(p);
    p->best.depth = tl_max(p->best_depth, 0.0f);
    *out = p->best;
}

void tl_epa_run(const tl_core *a, const tl_core *b, const tl_simplex *simplex, tl_depth *out) {
    polytope p;
    start(&p, a, b);
    take_simplex(&p, simplex);
    if (p.vertex_count == 0) {
        support(&p, tl_v(0.0f, 1.0f, 0.0f), 0);
        p.vertex_count = 1;
    }
    int solid = 1;
    while (solid && p.vertex_count < 4) {
        solid = grow(&p);
    }
    if (solid && first_faces(&p)) {
        expand(&p);
    }
    if (!p.have_best) {
        flat_depth(&p);
    }
    finish(&p, out);
}

/* Puts the fifth of the first points in, if it is outside of the others' tetrahedron. */
static int add_fifth(polytope *p) {
    for (uint32_t i = 0; i < p->face_end; ++i) {
        if (vec_dot(p->face[i].n, p->w[4]) - p->face[i].d > TOLERANCE) {
            p->vertex_count = 5;
            return insert(p, 4, i);
        }
    }
    return 1;
}

int tl_epa_from(const tl_core *a, const tl_core *b, talus_vec3 normal, float tilt, tl_depth *out) {
    polytope p;
    start(&p, a, b);
    /* one point on the far side, and four where the surface is met by the normal, to all sides of it */
    talus_vec3 m = tl_neg(normal), t = tl_perpendicular(m), u = tl_cross(m, t), side[4];
    side[0] = tl_add(t, u);
    side[1] = tl_sub(u, t);
    side[2] = tl_neg(side[0]);
    side[3] = tl_neg(side[1]);
    support(&p, normal, 0);
    p.vertex_count = 1;
    for (uint32_t i = 0; i < 4; ++i) {
        support(&p, tl_mad(m, tilt, side[i]), i + 1u);
    }
    p.vertex_count = 4;
    if (!first_faces(&p) || !add_fifth(&p)) {
        return 0;
    }
    for (uint32_t i = 0; i < p.face_end; ++i) {
        if (p.face[i].state == 1 && p.face[i].d < 0.0) {
            return 0;
        }
    }
    expand(&p);
    finish(&p, out);
    return 1;
}
