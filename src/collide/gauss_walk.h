/* Penetration depth of two polytopes: the least translation that parts them. Metres, in A's frame. */
#ifndef TL_GAUSS_WALK_H
#define TL_GAUSS_WALK_H

#include "collide/polytope.h"
#include "talus/query.h"

typedef struct tl_gauss_pair {
    const tl_polytope *a, *b;
    const tl_frame *frame; /* of b in a */
    uint32_t supports;     /* directions looked along */
} tl_gauss_pair;

/* How deep the cores overlap along a unit direction n from A to B: value = n.(point a - point b), vertices ia and ib.
 */
typedef struct tl_gauss_depth {
    double value;
    tl_d3 n, p;
    uint32_t ia, ib;
    uint32_t feature_a, feature_b; /* whose normal n is: a face and a vertex, or two edges; else the vertices */
} tl_gauss_depth;

/* Looks along n, from the vertices ia and ib on. */
void tl_gauss_look(tl_gauss_pair *pair, tl_d3 n, uint32_t ia, uint32_t ib, tl_gauss_depth *out);
/* From any depth down to one that no neighbour of its features undercuts. */
void tl_gauss_descend(tl_gauss_pair *pair, tl_gauss_depth *depth);
/* A depth to start from: along the normal of the features, if they have one, else what an expanding polytope finds:
 * the least as a rule, O(its points) supports. */
void tl_gauss_start(tl_gauss_pair *pair, talus_feature_pair features, tl_gauss_depth *out);
/* Whether what the features were the depth of last, a vertex in the other's face or the middle between two edges, is
 * inside of both: then the cores overlap, else they still may. */
int tl_gauss_overlap(const tl_gauss_pair *pair, talus_feature_pair features);
/* The surfaces' points that are `depth` apart along n, of the cores. */
void tl_gauss_points(const tl_gauss_pair *pair, const tl_gauss_depth *depth, tl_d3 *point_a, tl_d3 *point_b);

/* Lowers *depth, where it is not yet the least of all directions, to within 1e-6 of itself and of the sizes; 1 once
 * that is proven, 0 if it took more than 200000 looks. */
int tl_gauss_prove(tl_gauss_pair *pair, tl_gauss_depth *depth);

#endif
