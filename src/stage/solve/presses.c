/* The matrix of a press, factored and solved in single floats. */
#include "base/width_one.h"
#include "stage/kernels.h"

#include "dynamics/block_ldlt.inl"

static void live_rows(const tl_header *h, const tl_press *s, uint32_t live[TL_MOST_PRESSED]) {
    for (uint32_t k = 0; k < s->count; k++) {
        live[k] = tl_press_nodes(h)[s->first + k].rows;
    }
}

void tl_press_factor(const tl_header *h, const tl_press *s) {
    uint32_t live[TL_MOST_PRESSED];
    live_rows(h, s, live);
    ldlt_factor(tl_press_nodes(h) + s->first, tl_press_blocks(h), live, s->count, tl_press_values(h) + s->values, 0);
}

void tl_press_solve(const tl_header *h, const tl_press *s) {
    uint32_t live[TL_MOST_PRESSED];
    live_rows(h, s, live);
    ldlt_solve(tl_press_nodes(h) + s->first, tl_press_blocks(h), live, s->count, tl_press_values(h) + s->values, 0);
}
