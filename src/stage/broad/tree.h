/* A dynamic tree of boxes: binary, leaves are shapes, kept low by the surface area heuristic and rotations.
 *
 * Source: Goldsmith and Salmon, "Automatic creation of object hierarchies for ray tracing", IEEE CG&A 7(5), 1987 (the
 * cost); Kopta et al., "Fast, effective BVH updates for animated scenes", I3D 2012 (rotations). */
#ifndef TL_TREE_H
#define TL_TREE_H

#include "stage/store/store.h"

enum { TL_TREE_MOVING = 0, TL_TREE_STILL = 1 };

/* Puts a shape's box into a tree; O(log n). Returns the leaf. The node pool has room for all shapes. */
uint32_t tl_tree_insert(tl_header *h, int tree, uint32_t shape, const talus_aabb *box);
void tl_tree_remove(tl_header *h, int tree, uint32_t leaf);
/* Gives a leaf another box, where it stands or elsewhere in the tree; O(log n). Returns the leaf. */
uint32_t tl_tree_move(tl_header *h, int tree, uint32_t leaf, const talus_aabb *box);

static inline int tl_aabb_overlap(const talus_aabb *a, const talus_aabb *b) {
    return a->lower.x <= b->upper.x && b->lower.x <= a->upper.x && a->lower.y <= b->upper.y &&
           b->lower.y <= a->upper.y && a->lower.z <= b->upper.z && b->lower.z <= a->upper.z;
}
static inline int tl_aabb_contains(const talus_aabb *outer, const talus_aabb *inner) {
    return outer->lower.x <= inner->lower.x && outer->lower.y <= inner->lower.y && outer->lower.z <= inner->lower.z &&
           inner->upper.x <= outer->upper.x && inner->upper.y <= outer->upper.y && inner->upper.z <= outer->upper.z;
}

/* A walk over the leaves that overlap a box: tl_tree_next gives shapes until TL_NONE. It climbs by the parents' links
 * and so needs no stack and no bound on the height. The tree must not change in between. */
typedef struct tl_tree_walk {
    talus_aabb box;
    uint32_t node; /* to look at next */
} tl_tree_walk;

void tl_tree_begin(tl_tree_walk *walk, const tl_header *h, int tree, const talus_aabb *box);
uint32_t tl_tree_next(tl_tree_walk *walk, const tl_header *h);

#endif
