/* Refit: the boxes of what moved. A shape has a fat box in its tree and is looked at again only when its own box has
 * left it. */
#ifndef TL_REFIT_H
#define TL_REFIT_H

#include "collide/collide.h"
#include "stage/broad/tree.h"

/* Where a shape stands; the shape with its hull found; its box at the body's pose. */
talus_pose tl_shape_world_pose(const tl_header *h, uint32_t shape);
tl_convex tl_shape_convex(const tl_header *h, const void *geometry, uint32_t shape);
talus_aabb tl_shape_box(const tl_header *h, const void *geometry, uint32_t shape);

/* The box with the speculative margin and what the body's velocity adds in dt seconds: what its fat box holds at least.
 * Shapes whose swept boxes do not overlap are not looked at, whether a pair has them or not. */
talus_aabb tl_shape_swept_box(const tl_header *h, const void *geometry, uint32_t shape, float dt);
talus_filter tl_shape_filter(const tl_header *h, uint32_t shape);
int tl_filters_meet(const talus_filter *a, const talus_filter *b);
/* Whether filters, joints and kinds of bodies let two shapes meet. */
int tl_may_collide(const tl_header *h, uint32_t a, uint32_t b);
void tl_shape_leave_tree(tl_header *h, uint32_t shape);
/* Of a body that falls asleep, which refit looks at no more: enters once more what may have left its fat box. */
void tl_shapes_settle(tl_header *h, uint32_t body);

/* The stage: enlarges boxes by the way of the coming step of dt seconds. */
void tl_stage_refit(tl_header *h, const void *geometry, float dt);
/* After commit: what left its fat box all the same is in the list of what moved until the next refit, so that queries
 * find everything in the trees or there. */
void tl_stage_leave(tl_header *h, const void *geometry);
/* The stage: pairs of moved shapes with what their fat boxes overlap. */
void tl_stage_pairs(tl_header *h);

#endif
