/* The structure of the factor: a column holds what its node is coupled to and what the columns that hang on it hand up
 * (George and Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981, symbolic factorisation). */
#include "dynamics/block_ldlt.h"

typedef struct plan {
    tl_block_node *node;
    tl_block *block;
    uint32_t nodes, first, room, used;
    uint32_t *at_end; /* the last node seen of an end, a list through `next` */
    uint32_t *next;   /* two a node */
    uint32_t *child;  /* the columns whose first block is this node's, a list through `sibling` */
    uint32_t *sibling;
    uint32_t *mark; /* the last column that a node was put into, plus one */
} plan;

/* Puts `node` into column j, whose blocks are kept ascending. */
static int put(plan *p, uint32_t j, uint32_t node) {
    tl_block_node *column = &p->node[j];
    if (p->mark[node] == j + 1u) {
        return 1;
    }
    if (p->used == p->room) {
        return 0;
    }
    p->mark[node] = j + 1u;
    tl_block *blocks = p->block + column->first;
    uint32_t i = column->blocks++;
    for (; i > 0 && blocks[i - 1u].node > node; i--) {
        blocks[i].node = blocks[i - 1u].node;
    }
    blocks[i].node = node;
    p->used++;
    return 1;
}

static uint32_t shares_of(const tl_block_node *row, const tl_block_node *column) {
    uint32_t shares = 0;
    for (uint32_t i = 0; i < 2u; i++) {
        for (uint32_t k = 0; k < 2u; k++) {
            shares |= (uint32_t)(row->end[i] == column->end[k] && row->end[i] != TL_BLOCK_FREE) << (2u * i + k);
        }
    }
    return shares;
}

/* The lists of an end hold its nodes in descending order, for they are filled in ascending order. */
static int fill_column(plan *p, uint32_t j) {
    tl_block_node *column = &p->node[j];
    column->first = p->first + p->used;
    column->blocks = 0;
    for (uint32_t side = 0; side < 2u; side++) {
        if (column->end[side] == TL_BLOCK_FREE) {
            continue;
        }
        uint32_t link = p->at_end[column->end[side]];
        for (; link != TL_BLOCK_FREE && link / 2u > j; link = p->next[link]) {
            if (!put(p, j, link / 2u)) {
                return 0;
            }
        }
    }
    for (uint32_t c = p->child[j]; c != TL_BLOCK_FREE; c = p->sibling[c]) {
        for (uint32_t k = 1; k < p->node[c].blocks; k++) {
            if (!put(p, j, p->block[p->node[c].first + k].node)) {
                return 0;
            }
        }
    }
    if (column->blocks > 0) {
        uint32_t parent = p->block[column->first].node;
        p->sibling[j] = p->child[parent];
        p->child[parent] = j;
    }
    return 1;
}

uint32_t tl_block_plan(tl_block_node *node, uint32_t nodes, uint32_t ends, tl_block *block, uint32_t first,
                       uint32_t room, uint32_t *scratch, uint32_t *values) {
    plan p = {node, block, nodes, first, room, 0, scratch, 0, 0, 0, 0};
    p.next = p.at_end + ends, p.child = p.next + 2u * nodes, p.sibling = p.child + nodes, p.mark = p.sibling + nodes;
    for (uint32_t i = 0; i < ends; i++) {
        p.at_end[i] = TL_BLOCK_FREE;
    }
    for (uint32_t i = 0; i < nodes; i++) {
        p.child[i] = TL_BLOCK_FREE;
        p.mark[i] = 0;
        for (uint32_t side = 0; side < 2u; side++) {
            if (node[i].end[side] != TL_BLOCK_FREE) {
                p.next[2u * i + side] = p.at_end[node[i].end[side]];
                p.at_end[node[i].end[side]] = 2u * i + side;
            }
        }
    }
    uint32_t offset = 0;
    for (uint32_t j = 0; j < nodes; j++) {
        if (!fill_column(&p, j)) {
            return TL_BLOCK_FREE;
        }
        uint32_t rows = node[j].rows;
        node[j].x = offset, node[j].diagonal = offset + rows;
        offset += rows + rows * (rows + 1u) / 2u;
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            tl_block *b = &block[node[j].first + k];
            b->shares = shares_of(&node[b->node], &node[j]);
            b->values = offset;
            offset += rows * node[b->node].rows;
        }
    }
    *values = offset;
    return p.used;
}
