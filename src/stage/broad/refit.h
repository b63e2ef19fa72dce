/* Refit: the boxes of what moved. A shape has a fat box in its tree and is looked at again only when its own box has
 * left it. */
#ifndef TL_REFIT_H
#define TL_REFIT_H

#include "collide/collide.h"
#include "stage/broad/tree.h"

/* A shape with its hull found, and its box at the body's pose. */
tl_convex tl_shape_convex(const tl_header *h, const void *geometry, uint32_t shape);
talus_aabb tl_shape_box(const tl_header *h, const void *geometry, uint32_t shape);

/* The stage: enlarges boxes by the way of the coming step of dt seconds. */
void tl_stage_refit(tl_header *h, const void *geometry, float dt);
/* The stage: pairs of moved shapes with what their fat boxes overlap. */
void tl_stage_pairs(tl_header *h);

#endif
