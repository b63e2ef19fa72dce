/* Pairs of shapes for the tests of queries: hulls of 4 to 500 vertices, up to 1000 times as long as they are thick,
 * 1e-3 to 1e3 m large, placed at random, near to touch, face to face, edge along edge, and nearly so. Metres. */
#ifndef QUERY_KIT_H
#define QUERY_KIT_H

#include "collide/vclip.h"
#include "collide_brute.h"

#define KIT_HULLS 240

/* How far a point of the shape's frame is outside, beyond what the shape's own vertices are off their planes. */
static inline double kit_outside(const tl_convex *s, d3 p) {
    const talus_geometry *g = &s->geometry;
    double own = 0.0;
    if (g->type == TALUS_CAPSULE) {
        double y = fmax(-(double)g->half_height, fmin((double)g->half_height, p.y));
        return d3_length(d3_sub(p, d3_make(0.0, y, 0.0))) - (double)g->radius_top;
    }
    for (uint32_t i = 0; s->hull && i < s->hull->vertex_count; ++i) {
        own = fmax(own, d_outside(s, d3_of(tl_hull_point(s->hull, i))));
    }
    return d_outside(s, p) - own;
}

typedef struct kit_pair {
    const tl_convex *a, *b;
    talus_pose pose; /* of b in a */
    double size;     /* of both */
    int family;
} kit_pair;

enum { KIT_RANDOM, KIT_TOUCH, KIT_FACES, KIT_EDGES, KIT_COPLANAR, KIT_FAMILIES };
static const char *const kit_family_name[KIT_FAMILIES] = {"random", "touching", "faces", "edges", "coplanar"};

static tl_convex kit_shape[KIT_HULLS];

static inline float kit_power(float low, float high) { return powf(10.0f, brute_range(low, high)); }

/* Every eighth a box or a round shape. */
static inline void kit_build(void) {
    for (int i = 0; i < KIT_HULLS; ++i) {
        float size = kit_power(-3.0f, 3.0f), thin = kit_power(-3.0f, 0.0f), middle = kit_power(-1.5f, 0.0f);
        talus_vec3 scale = tl_v(size, size * tl_max(middle, thin), size * thin);
        if (i % 3 == 0) {
            scale = tl_v(size, size, size);
        }
        memset(&kit_shape[i], 0, sizeof kit_shape[i]);
        talus_geometry *g = &kit_shape[i].geometry;
        if (i % 24 == 8) {
            g->type = TALUS_SPHERE;
            g->radius = size;
        } else if (i % 24 == 16) {
            g->type = TALUS_CAPSULE;
            g->half_height = size;
            g->radius_top = g->radius_bottom = size * thin;
        } else if (i % 8 == 0) {
            g->type = TALUS_BOX;
            g->half = scale;
        } else {
            uint32_t count = (uint32_t)(4.0f * powf(125.0f, brute_range(0.0f, 1.0f)));
            g->type = TALUS_HULL;
            kit_shape[i].hull = brute_hull(count, scale);
        }
    }
}

static inline talus_quat kit_turn(talus_vec3 from, talus_vec3 to) {
    talus_vec3 c = tl_cross(from, to);
    float w = 1.0f + tl_dot(from, to);
    if (w < 1e-4f) {
        c = tl_perpendicular(from);
        w = 0.0f;
    }
    talus_quat q = {c.x, c.y, c.z, w};
    return tl_quat_normalize(q);
}

static inline talus_vec3 kit_face(const tl_polytope *p) {
    uint32_t f = p->face_count ? brute_u32() % p->face_count : 0u;
    talus_vec3 d = brute_direction();
    return p->face_count ? tl_d_round(tl_polytope_normal(p, f)) : d;
}

static inline talus_vec3 kit_edge(const tl_polytope *p) {
    talus_vec3 d = brute_direction();
    if (p->edge_count == 0u) {
        return d;
    }
    uint32_t e = brute_u32() % p->edge_count;
    tl_d3 u = tl_d_sub(tl_polytope_vertex(p, p->edges[e ^ 1u].origin), tl_polytope_vertex(p, p->edges[e].origin));
    return tl_d_round(tl_d_scale(u, 1.0 / tl_d_length(u)));
}

/* B so placed that it is `gap` away along n, shifted aside by up to a part of the sizes. */
static inline void kit_place(kit_pair *p, talus_vec3 n, double gap, float aside) {
    d_pose d = d_pose_of(&p->pose);
    double reach = d_reach(p->a, d3_of(n)) + d_reach(p->b, d_rotate_back(&d, d3_scale(d3_of(n), -1.0)));
    talus_vec3 side = brute_vector(-1.0f, 1.0f);
    side = tl_scale(tl_mad(side, -tl_dot(side, n), n), aside * (float)p->size);
    p->pose.position = tl_mad(side, (float)(reach + gap), n);
}

static inline kit_pair kit_draw(void) {
    kit_pair p;
    p.a = &kit_shape[brute_u32() % KIT_HULLS];
    p.b = &kit_shape[brute_u32() % KIT_HULLS];
    p.size = d_size(p.a) + d_size(p.b);
    p.family = (int)(brute_u32() % KIT_FAMILIES);
    tl_polytope a, b;
    tl_polytope_init(&a, p.a);
    tl_polytope_init(&b, p.b);
    p.pose = brute_pose(0.0f, 2.0f * (float)p.size);
    double gap = p.size * (double)kit_power(-7.0f, 0.0f);
    talus_vec3 n = brute_direction();
    float aside = brute_range(0.0f, 0.3f);
    if ((brute_u32() & 7u) == 0u) {
        gap = 0.0;
    }
    if (p.family == KIT_TOUCH) {
        kit_place(&p, n, gap, 0.0f);
    } else if (p.family == KIT_FACES || p.family == KIT_COPLANAR) {
        n = kit_face(&a);
        p.pose.rotation = kit_turn(kit_face(&b), tl_neg(n));
        if (p.family == KIT_COPLANAR) {
            float angle = kit_power(-7.0f, -2.0f);
            talus_vec3 v = tl_scale(brute_vector(-1.0f, 1.0f), angle);
            talus_quat tilt = {v.x, v.y, v.z, 1.0f};
            p.pose.rotation = tl_quat_normalize(tl_quat_mul(tilt, p.pose.rotation));
        }
        kit_place(&p, n, gap, aside);
    } else if (p.family == KIT_EDGES) {
        talus_vec3 e = kit_edge(&a);
        p.pose.rotation = kit_turn(kit_edge(&b), e);
        n = tl_normalize_or(tl_mad(n, -tl_dot(n, e), e), n);
        kit_place(&p, n, gap, aside);
    }
    return p;
}

/* A little further: turned by up to `angle` (radians) and moved by as much of the size. */
static inline void kit_nudge(kit_pair *p, float angle) {
    talus_vec3 v = tl_scale(brute_vector(-1.0f, 1.0f), 0.5f * angle), m = brute_vector(-1.0f, 1.0f);
    talus_quat q = {v.x, v.y, v.z, 1.0f};
    p->pose.rotation = tl_quat_normalize(tl_quat_mul(q, p->pose.rotation));
    p->pose.position = tl_mad(p->pose.position, angle * (float)p->size * 0.5f, m);
}

#endif
