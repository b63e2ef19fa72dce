/* The faces, edges and points by which two shapes meet, and the manifold between them. Metres, in the query's frame. */
#ifndef TL_FEATURE_H
#define TL_FEATURE_H

#include "collide/support.h"

#define TL_FEATURE_POINTS 32 /* faces of more corners are thinned out */

/* Closer to parallel than this a face stands for a shape along a normal: the cosine of 10 degrees. */
#define TL_FACE_COS 0.985f
/* The sine of 10 degrees: closer to the plane across the normal than this an edge stands for a shape. */
#define TL_EDGE_SIN 0.17f

/* The side planes stand this far outside of the face, of the smaller feature's extent: faces that fit one another
 * exactly keep their corners while they jitter. */
#define TL_SIDE_SLACK 5e-4f

typedef struct tl_feature {
    uint32_t count;                      /* 1: a point, 2: a segment, more: a convex polygon */
    talus_vec3 normal;                   /* outward unit normal of a polygon */
    talus_vec3 point[TL_FEATURE_POINTS]; /* counter-clockwise seen from outside */
    uint16_t vertex[TL_FEATURE_POINTS];  /* numbers of the points */
    uint16_t edge[TL_FEATURE_POINTS];    /* numbers of the edges from each point to the next */
} tl_feature;

/* What supports a core along the unit vector n (query frame), pushed out by the core's radius. With `strict` a face or
 * edge counts only near to square with n; else the face that is closest to square with it wherever there are faces. */
void tl_feature_find(const tl_core *core, talus_vec3 n, int strict, tl_feature *out);

/* A face of a box (2 axis + positive) or hull by its number; an edge of either between two corners. */
void tl_feature_face(const tl_core *core, uint32_t face, tl_feature *out);
void tl_feature_edge(const tl_core *core, uint32_t from, uint32_t to, uint32_t edge, tl_feature *out);

/* A way to meet: a unit normal from A to B and the points of A and B that it was found with. */
typedef struct tl_touch {
    talus_vec3 normal;
    float separation;
    talus_vec3 point_a, point_b;
} tl_touch;

/* The points at most `margin` apart where two features meet along the touch's normal; there may be none. The touch's
 * points are not read. */
void tl_manifold_build(const tl_feature *a, const tl_feature *b, const tl_touch *touch, float margin, float tolerance,
                       tl_manifold *out);

/* The least separation in a manifold that has points. */
float tl_manifold_least(const tl_manifold *m);

/* The same with the features that were found strictly; where only one is a face the other is found again for it. The
 * touch's own points are in the manifold where no others are as near. */
void tl_manifold_meet(const tl_core *a, const tl_core *b, tl_feature *fa, tl_feature *fb, const tl_touch *touch,
                      float margin, tl_manifold *out);

/* Whether the points of an overlap (separation < 0), met along a face's own normal, prove that the way out along it is
 * the shortest. `between` goes from a point inside of A to one inside of B. 0 proves nothing. */
int tl_is_proven(const tl_manifold *m, float separation, talus_vec3 between);

/* Numbers for points: of a vertex of B on A, of a vertex of A on B, of two edges, and of two points. */
static inline uint32_t tl_point_id(uint32_t kind, uint32_t a, uint32_t b) {
    return kind << 30 | (a & 0x7fffu) << 15 | (b & 0x7fffu);
}
#define TL_ID_POINTS 0u
#define TL_ID_VERTEX_B 1u
#define TL_ID_VERTEX_A 2u
#define TL_ID_EDGES 3u

/* What separations of two shapes may differ by from rounding and from features that are all but alike. */
static inline float tl_touch_tolerance(const tl_core *a, const tl_core *b) {
    return 5e-6f * tl_min(a->size, b->size) + 2.5e-7f * tl_max(a->size, b->size);
}

#endif
