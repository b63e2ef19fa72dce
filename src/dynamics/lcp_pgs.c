/* Projected Gauss-Seidel: row after row is solved by itself with the others as they are, and brought within its bounds
 * (Cottle, Pang and Stone, The Linear Complementarity Problem, 5.2). Bounds that follow a normal follow it at once. */
#include "dynamics/lcp.h"

/* One pass; returns the largest change that a row asked for, in the unit of w. */
static double sweep(const talus_lcp *p, double *z) {
    double worst = 0.0;
    for (uint32_t i = 0; i < p->count; i++) {
        const float *row = p->a + (size_t)i * p->count;
        double w = (double)p->b[i], lo, hi, old = z[i];
        for (uint32_t k = 0; k < p->count; k++) {
            w += (double)row[k] * z[k];
        }
        tl_lcp_bounds(p, i, tl_lcp_is_friction(p, i) ? z[p->normal[i]] : 0.0, &lo, &hi);
        z[i] = tl_d_max(tl_d_min(old - w / (double)row[i], hi), lo);
        worst = tl_d_max(worst, tl_d_abs(z[i] - old) * (double)row[i]);
    }
    return worst;
}

talus_status talus_lcp_pgs(const talus_lcp *problem, uint32_t limit, double tolerance, float *z, void *memory,
                           size_t bytes, talus_lcp_result *result) {
    talus_status status = tl_lcp_check_call(problem, TALUS_LCP_PGS, z, memory, bytes, result);
    if (status != TALUS_OK) {
        return status;
    }
    uint32_t n = problem->count, sweeps = 0;
    double *x = memory, change;
    for (uint32_t i = 0; i < n; i++) {
        if (z[i] - z[i] != 0.0f) {
            return TALUS_NOT_FINITE;
        }
        if (!(problem->a[(size_t)i * n + i] > 0.0f)) {
            return TALUS_BAD_ARGUMENT;
        }
    }
    if (!(tolerance >= 0.0)) {
        return TALUS_BAD_ARGUMENT;
    }
    for (uint32_t i = 0; i < n; i++) {
        double lo, hi;
        tl_lcp_bounds(problem, i, tl_lcp_is_friction(problem, i) ? (double)z[problem->normal[i]] : 0.0, &lo, &hi);
        x[i] = tl_d_max(tl_d_min((double)z[i], hi), lo);
    }
    result->outcome = TALUS_LCP_LIMIT;
    while (result->outcome != TALUS_LCP_SOLVED && sweeps < (limit ? limit : 1000u)) {
        change = sweep(problem, x);
        sweeps++;
        if (change <= tolerance || sweeps == (limit ? limit : 1000u)) {
            for (uint32_t i = 0; i < n; i++) {
                z[i] = (float)x[i];
            }
            result->residual = tl_lcp_residual_of(problem, z);
            result->outcome = result->residual <= tolerance ? TALUS_LCP_SOLVED : TALUS_LCP_LIMIT;
        }
    }
    result->steps = sweeps;
    return TALUS_OK;
}
