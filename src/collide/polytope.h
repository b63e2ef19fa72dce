/* Boxes, hulls, capsules of one radius and balls as one thing to the queries that walk over features: half-edges
 * swollen by a radius. A ball is one vertex without edges, a capsule one edge without faces. Also the frame of one
 * shape seen from another, in double. Metres. */
#ifndef TL_POLYTOPE_H
#define TL_POLYTOPE_H

#include "collide/collide.h"
#include "geom/double3.h"

#define TL_NO_FEATURE 0xffffu /* the edge of a ball's vertex, the face of a capsule's edge */

/* A feature in one word, as pairs are remembered. */
#define TL_FEATURE_VERTEX 1u
#define TL_FEATURE_EDGE 2u
#define TL_FEATURE_FACE 3u
#define TL_FEATURE(kind, index) ((kind) << 16 | (index))
#define TL_FEATURE_KIND(word) ((word) >> 16)
#define TL_FEATURE_INDEX(word) ((word)&0xffffu)

typedef struct tl_polytope {
    const tl_convex *shape;
    int round;                   /* a cylinder, a cut cone, a capsule of two radii: it has no features */
    const float *x, *y, *z;      /* of vertices */
    const float *nx, *ny, *nz;   /* outward unit normals of faces: n.p = d */
    const float *d;              /* m */
    const uint16_t *vertex_edge; /* a half-edge that leaves each vertex */
    const uint16_t *face_edge;   /* a half-edge of each face */
    const tl_half_edge *edges;
    uint32_t vertex_count, edge_count, face_count; /* half-edges are counted */
    float radius;                                  /* by which it is swollen */
    float size;                                    /* no point of the core is further than this from `center` */
    tl_d3 center;                                  /* strictly inside, where there is an inside */
    float own[48];                                 /* coordinates of what is no hull */
} tl_polytope;

/* Of what is no hull. */
void tl_polytope_init_plain(tl_polytope *out, const tl_convex *shape);

/* *out points to the shape and into itself: not to be copied. */
static inline void tl_polytope_init(tl_polytope *out, const tl_convex *shape) {
    const talus_hull *h = shape->hull;
    if (shape->geometry.type != TALUS_HULL) {
        tl_polytope_init_plain(out, shape);
        return;
    }
    out->shape = shape;
    out->round = 0;
    out->x = tl_hull_x(h), out->y = tl_hull_y(h), out->z = tl_hull_z(h);
    out->nx = tl_hull_planes(h), out->ny = out->nx + h->face_stride;
    out->nz = out->ny + h->face_stride, out->d = out->nz + h->face_stride;
    out->vertex_edge = tl_hull_vertex_edge(h);
    out->face_edge = tl_hull_face_edge(h);
    out->edges = tl_hull_edges(h);
    out->vertex_count = h->vertex_count, out->edge_count = h->half_edge_count, out->face_count = h->face_count;
    out->radius = 0.0f;
    out->size = h->outer_radius;
    out->center = tl_d_from(h->centroid);
}

/* Whether the polytope has that feature. */
static inline int tl_polytope_has(const tl_polytope *p, uint32_t feature) {
    uint32_t kind = TL_FEATURE_KIND(feature), count = kind == TL_FEATURE_VERTEX ? p->vertex_count : 0u;
    count = kind == TL_FEATURE_EDGE ? p->edge_count : kind == TL_FEATURE_FACE ? p->face_count : count;
    return TL_FEATURE_INDEX(feature) < count;
}

/* p_outer = x * p.x + y * p.y + z * p.z + t */
typedef struct tl_frame {
    tl_d3 x, y, z, t;
} tl_frame;

static inline tl_d3 tl_frame_turn(const tl_frame *f, tl_d3 v) {
    return tl_d(f->x.x * v.x + f->y.x * v.y + f->z.x * v.z, f->x.y * v.x + f->y.y * v.y + f->z.y * v.z,
                f->x.z * v.x + f->y.z * v.y + f->z.z * v.z);
}
static inline tl_d3 tl_frame_turn_back(const tl_frame *f, tl_d3 v) {
    return tl_d(tl_d_dot(f->x, v), tl_d_dot(f->y, v), tl_d_dot(f->z, v));
}
static inline tl_d3 tl_frame_point(const tl_frame *f, tl_d3 p) { return tl_d_add(tl_frame_turn(f, p), f->t); }
static inline tl_d3 tl_frame_point_back(const tl_frame *f, tl_d3 p) { return tl_frame_turn_back(f, tl_d_sub(p, f->t)); }

/* Of a pose whose rotation need not be of unit length, only not 0. */
static inline tl_frame tl_frame_of(const talus_pose *pose) {
    double x = (double)pose->rotation.x, y = (double)pose->rotation.y, z = (double)pose->rotation.z,
           w = (double)pose->rotation.w;
    double s = 2.0 / (x * x + y * y + z * z + w * w);
    tl_frame f = {{1.0 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
                  {s * (x * y - z * w), 1.0 - s * (x * x + z * z), s * (y * z + x * w)},
                  {s * (x * z + y * w), s * (y * z - x * w), 1.0 - s * (x * x + y * y)},
                  {(double)pose->position.x, (double)pose->position.y, (double)pose->position.z}};
    return f;
}
/* b seen from a, both seen from one frame. */
static inline tl_frame tl_frame_between(const tl_frame *a, const tl_frame *b) {
    tl_frame f = {tl_frame_turn_back(a, b->x), tl_frame_turn_back(a, b->y), tl_frame_turn_back(a, b->z),
                  tl_frame_point_back(a, b->t)};
    return f;
}

static inline tl_d3 tl_polytope_vertex(const tl_polytope *p, uint32_t i) {
    return tl_d((double)p->x[i], (double)p->y[i], (double)p->z[i]);
}
static inline tl_d3 tl_polytope_normal(const tl_polytope *p, uint32_t face) {
    return tl_d((double)p->nx[face], (double)p->ny[face], (double)p->nz[face]);
}

/* The vertex furthest along a direction of the polytope's frame, by climbing from `start`; by _near but for the
 * rounding of floats. */
uint32_t tl_polytope_support(const tl_polytope *p, tl_d3 direction, uint32_t start);
uint32_t tl_polytope_near(const tl_polytope *p, tl_d3 direction, uint32_t start);
/* A vertex near to it, looked up. */
uint32_t tl_polytope_seed(const tl_polytope *p, tl_d3 direction);

/* Of what has faces: the one through which p is seen from the centre, by climbing from `face` (over the polar dual it
 * is a linear function); *height is below 1 if p is within. */
uint32_t tl_polytope_face_towards(const tl_polytope *b, uint32_t face, tl_d3 p, double *height);
/* Whether p is inside. */
int tl_polytope_holds(const tl_polytope *b, uint32_t face, tl_d3 p);

/* The points of two segments that are next to one another, as parts s and t in [0, 1] of them; of parallel ones the
 * middle of the stretch where they run side by side. Their squared distance. */
double tl_segments(tl_d3 p0, tl_d3 p1, tl_d3 q0, tl_d3 q1, double *s, double *t);

#endif
