/* A linkage that none is like: solved in single floats. */
#include "base/width_one.h"
#include "stage/kernels.h"

#include "stage/solve/linkages.inl"

void tl_linkage_solve_one(const tl_header *h, tl_linkage *l) { link_solve(h, l); }

/* --- cuts ------------------------------------------------------------------------------------- */

void tl_cuts_factor(const tl_header *h, const tl_linkage *l) {
    const tl_block_node *cut = tl_linkage_nodes(h) + l->cut + l->inner + 2u;
    const uint32_t *live = tl_linkage_live(h) + l->first_place + l->inner + 2u;
    ldlt_eliminate(cut, tl_linkage_blocks(h), live, l->cuts, tl_linkage_values(h) + l->values + l->cut_values, l->even);
}

void tl_cuts_solve(const tl_header *h, const tl_linkage *l) {
    const tl_block_node *cut = tl_linkage_nodes(h) + l->cut + l->inner + 2u;
    const uint32_t *live = tl_linkage_live(h) + l->first_place + l->inner + 2u;
    ldlt_solve(cut, tl_linkage_blocks(h), live, l->cuts, tl_linkage_values(h) + l->values + l->cut_values, l->even);
}
