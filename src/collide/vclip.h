/* Closest features and points of two convex shapes, from the features they had last. Metres. */
#ifndef TL_VCLIP_H
#define TL_VCLIP_H

#include "collide/polytope.h"
#include "collide/support.h"
#include "talus/query.h"

typedef struct tl_closest {
    int apart;              /* 0: the shapes touch or overlap */
    int cores_apart;        /* 0: their cores do too; then the normal is not set and the points are a common one */
    double gap;             /* m between the surfaces; negative in overlap as far as the radii reach, 0 if cores meet */
    tl_d3 normal;           /* unit, from A to B, in A's frame */
    tl_d3 point_a, point_b; /* on the surfaces, in A's frame */
    tl_d3 common;           /* in overlap: within both */
    talus_feature_pair features; /* where the search ended: a hint for the next */
    uint32_t steps;              /* from feature to feature */
    uint32_t gave_up;            /* 1: they did not end, or not where they should, and GJK answered */
} tl_closest;

/* b's frame is seen from a. `features` may be any bits. In exact arithmetic each step goes to features that are nearer,
 * or as near and of lower dimension, but for the one out of a face that is seen from behind; for that and for rounding
 * there is a bound of 256 steps, after which GJK answers. GJK answers for round cores too; that leaves no features. */
void tl_closest_find(const tl_polytope *a, const tl_polytope *b, const tl_frame *b_in_a, talus_feature_pair features,
                     tl_closest *out);

/* The shapes as GJK and EPA take them, in A's frame. */
void tl_closest_cores(const tl_polytope *a, const tl_polytope *b, const tl_frame *b_in_a, tl_core *core_a,
                      tl_core *core_b);

#endif
