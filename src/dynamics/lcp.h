/* What the methods for linear complementarity share. */
#ifndef TL_LCP_H
#define TL_LCP_H

#include "talus/lcp.h"

#include "geom/double3.h"

#define TL_LCP_INFINITY 1e300

/* TALUS_OK, or what is wrong with a problem. */
talus_status tl_lcp_check(const talus_lcp *p);
/* tl_lcp_check, and the rest of the arguments of a solver. */
talus_status tl_lcp_check_call(const talus_lcp *p, talus_lcp_method method, const float *z, const void *memory,
                               size_t bytes, const talus_lcp_result *result);

/* The bounds of row i with z as it is; infinite ones are TL_LCP_INFINITY away. */
void tl_lcp_bounds(const talus_lcp *p, uint32_t i, double normal, double *lo, double *hi);
static inline int tl_lcp_is_friction(const talus_lcp *p, uint32_t i) {
    return p->normal && p->normal[i] != TALUS_LCP_NO_NORMAL;
}

/* The residual of a z, and of a row by itself. */
double tl_lcp_row_residual(double w, double z, double lo, double hi, double diagonal);
double tl_lcp_residual_of(const talus_lcp *p, const float *z);

#endif
