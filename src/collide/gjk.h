/* Distance between convex cores, and depth of their overlap. Lengths in metres, everything in the query's frame. */
#ifndef TL_GJK_H
#define TL_GJK_H

#include "collide/support.h"

/* A point of the Minkowski difference B - A and the two support points that it came from. */
typedef struct tl_simplex_vertex {
    talus_vec3 a, b;
    uint32_t ia, ib;
} tl_simplex_vertex;

typedef struct tl_simplex {
    uint32_t count; /* 0..4 */
    tl_simplex_vertex vertex[4];
    double weight[4]; /* of the closest point */
} tl_simplex;

typedef enum tl_gjk_state {
    TL_GJK_APART,  /* the distance and the points are good */
    TL_GJK_BEYOND, /* further apart than `limit` along the normal; the points are not worked out */
    TL_GJK_OVERLAP /* the cores touch or overlap; the simplex is where EPA starts */
} tl_gjk_state;

typedef struct tl_gjk {
    float distance;              /* between the cores; a lower bound of it if beyond */
    talus_vec3 normal;           /* unit, from A to B; not set in overlap */
    talus_vec3 point_a, point_b; /* on the cores; a common point in overlap */
} tl_gjk;

/* The closest points of two cores. `simplex` may hold vertices to start from (their points are taken as they are), else
 * `guess`, a direction from A to B, starts the search. */
tl_gjk_state tl_gjk_run(const tl_core *a, const tl_core *b, talus_vec3 guess, float limit, tl_simplex *simplex,
                        tl_gjk *out);

typedef struct tl_depth {
    float depth;       /* >= 0: how far the cores must move apart along the normal */
    talus_vec3 normal; /* unit, from A to B */
    talus_vec3 point_a, point_b;
} tl_depth;

/* The shortest way out of an overlap of two cores, from the simplex that GJK ended with. */
void tl_epa_run(const tl_core *a, const tl_core *b, const tl_simplex *simplex, tl_depth *out);

/* The same from a normal that is near to the right one, by the points met along it and `tilt` (radians) to all sides. 0
 * if these do not show an overlap: the cores may still overlap. */
int tl_epa_from(const tl_core *a, const tl_core *b, talus_vec3 normal, float tilt, tl_depth *out);

/* How far A and B are apart along the unit vector n from A to B: negative in overlap, without the radii. The vertex
 * numbers are where a search on a large hull starts. */
static inline float tl_core_separation(const tl_core *a, const tl_core *b, talus_vec3 n, uint32_t *ia, uint32_t *ib,
                                       talus_vec3 *pa, talus_vec3 *pb) {
    *pa = tl_core_support(a, n, ia);
    *pb = tl_core_support(b, tl_neg(n), ib);
    return tl_dot(n, tl_sub(*pb, *pa));
}

#endif
