/* A linkage that none is like: solved in single floats. */
#include "base/width_one.h"
#include "stage/kernels.h"

#include "stage/solve/linkages.inl"

void tl_linkage_solve_one(const tl_header *h, const tl_linkage *l) { link_solve(h, l); }
