/* Sparse block L D L^T of what ties bodies in pairs: each node is a set of up to TL_BLOCK_ROWS scalar constraints
 * between two ends, and nodes that share an end are coupled. The matrix J M^-1 J^T of such constraints is symmetric and
 * not negative; over a tree of bodies, taken from its leaves, it factors in time linear in the nodes as long as no body
 * holds many of them (Baraff, "Linear-time dynamics using Lagrange multipliers", SIGGRAPH 1996, has the tree; the
 * factorisation here is of the multipliers' matrix, so that loops are no special case but cost fill).
 *
 * Values lie in one array of floats, or of eight floats where eight matrices of one structure are worked on side by
 * side; offsets count floats of one matrix. block_ldlt.inl has the arithmetic for either width. */
#ifndef TL_BLOCK_LDLT_H
#define TL_BLOCK_LDLT_H

#include <stdint.h>

#define TL_BLOCK_ROWS 6u
#define TL_BLOCK_FREE 0xffffffffu /* an end that couples nothing: what cannot be moved */

/* The diagonal is raised by this share of itself, which is beyond the rounding of what was subtracted from it: rows
 * that say the same thing twice then share what they have to bear. */
#define TL_BLOCK_RAISE 1e-5f

/* A node, its diagonal block and its column below that. Nodes are taken in the order of their numbers. */
typedef struct tl_block_node {
    uint32_t end[2];        /* in: numbers from 0, or TL_BLOCK_FREE */
    uint32_t rows;          /* in: 1..TL_BLOCK_ROWS */
    uint32_t first, blocks; /* the column: its blocks, by ascending node */
    uint32_t diagonal;      /* offset of rows (rows + 1) / 2 values: the lower half by rows */
    uint32_t x;             /* offset of `rows` values: right-hand side, then solution */
} tl_block_node;

/* A block below the diagonal: rows of `node` times rows of the column's node, row by row. */
typedef struct tl_block {
    uint32_t node, values;
    uint32_t shares; /* bit 2 i + k: end i of `node` is end k of the column's node; 0: fill */
} tl_block;

/* Words of scratch that tl_block_plan needs. */
#define TL_BLOCK_SCRATCH(nodes, ends) (5u * (nodes) + (ends))

/* Fills in columns and offsets of nodes whose ends and rows are given, with ends numbered below `ends`. Takes blocks
 * from `block[first]` on and at most `room` of them. Returns their number, or TL_BLOCK_FREE if there is no room;
 * *values is how many floats a matrix takes. O(blocks of the factor). */
uint32_t tl_block_plan(tl_block_node *node, uint32_t nodes, uint32_t ends, tl_block *block, uint32_t first,
                       uint32_t room, uint32_t *scratch, uint32_t *values);

#endif
