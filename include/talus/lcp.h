/* Linear complementarity problems, solved on the caller's memory and without a world: given a matrix A, a vector b and
 * bounds lo <= hi, find z within the bounds and w = A z + b so that for each row
 *
 *     w >= 0 where z = lo,    w <= 0 where z = hi,    w = 0 where z lies between.
 *
 * For contacts z are impulses, w the speeds that they leave, A = J M^-1 J^T. A bound may be infinite. All numbers of a
 * problem should be of like size; they are taken as floats, worked with as doubles, and answered as floats: the same
 * bits on every machine. */
#ifndef TALUS_LCP_H
#define TALUS_LCP_H

#include "talus/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TALUS_LCP_MAX_COUNT 2048u
#define TALUS_LCP_NO_NORMAL 0xffffffffu

typedef struct talus_lcp {
    uint32_t count;       /* rows, 1..TALUS_LCP_MAX_COUNT */
    const float *a;       /* count x count, row by row */
    const float *b;       /* count */
    const float *lo, *hi; /* count each; -INFINITY, INFINITY: no bound */
    /* Null, or of each row the one whose z bounds it: |z| <= hi * z[normal], hi then being a coefficient of friction
     * and lo of no meaning; TALUS_LCP_NO_NORMAL for rows with bounds of their own. A normal's own bounds are plain and
     * its lo is at least 0. */
    const uint32_t *normal;
} talus_lcp;

typedef enum talus_lcp_method {
    /* Projected Gauss-Seidel. A need not be symmetric; its diagonal must be positive. Any accuracy, in the limit, for
     * symmetric positive definite and semidefinite A; 2 n^2 operations a sweep. */
    TALUS_LCP_PGS,
    /* Dantzig's principal pivoting as Baraff has it ("Fast contact force computation for nonpenetrating rigid bodies",
     * SIGGRAPH 1994). A is symmetric positive semidefinite; its upper triangle is not read. As good as exact; about
     * n^2 operations a pivot, mostly fewer than 2 n pivots. Friction by repetition: with the bounds that the normals of
     * the last solution give. */
    TALUS_LCP_DANTZIG,
    /* Lemke's complementary pivoting (Cottle, Pang and Stone, The Linear Complementarity Problem, 4.4), lexicographic,
     * so that it ends. Any A; if A is positive semidefinite, or copositive plus, and no solution is found, there is
     * none. A row with two bounds or none counts twice in the size N; N^2 operations a pivot, mostly fewer than 2 N
     * pivots. No friction rows: their bounds can be written as rows of an A that is not symmetric. */
    TALUS_LCP_LEMKE,
    TALUS_LCP_METHOD_COUNT
} talus_lcp_method;

typedef enum talus_lcp_outcome {
    TALUS_LCP_SOLVED,
    TALUS_LCP_RAY,  /* pivoting runs off to infinity: no solution, for the matrices named above; z is left as it was */
    TALUS_LCP_LIMIT /* not solved within the limit: z is the best so far of PGS and Dantzig, Lemke leaves it */
} talus_lcp_outcome;

typedef struct talus_lcp_result {
    talus_lcp_outcome outcome;
    uint32_t steps; /* sweeps or pivots */
    /* How far z is from a solution, in the unit of w: the largest of |w| where z is free to give way, of the part of w
     * that has the wrong sign at a bound, and of A_ii times the way to the bound where that is less. */
    double residual;
} talus_lcp_result;

/* Bytes that solving `count` rows takes; 0 if count or method are out of range. */
size_t talus_lcp_memory(talus_lcp_method method, uint32_t count);

/* z holds where PGS starts from (it is brought within the bounds; the others do not read it), and the answer. `memory`
 * is of talus_lcp_memory bytes, aligned to 8. `limit` is that of sweeps or pivots, 0: 1000 sweeps, 50 n pivots. PGS has
 * solved where the residual is at most `tolerance` (>= 0); so has Dantzig with friction rows, and without it is as
 * exact as doubles are. TALUS_BAD_ARGUMENT, TALUS_NOT_FINITE (A, b or a z to start from is not, or a bound is NaN),
 * TALUS_SMALL_BLOCK, TALUS_UNALIGNED: z is left as it was. */
talus_status talus_lcp_pgs(const talus_lcp *problem, uint32_t limit, double tolerance, float *z, void *memory,
                           size_t bytes, talus_lcp_result *result);
talus_status talus_lcp_dantzig(const talus_lcp *problem, uint32_t limit, double tolerance, float *z, void *memory,
                               size_t bytes, talus_lcp_result *result);
talus_status talus_lcp_lemke(const talus_lcp *problem, uint32_t limit, float *z, void *memory, size_t bytes,
                             talus_lcp_result *result);

/* The residual of any z (count). TALUS_BAD_ARGUMENT, TALUS_NOT_FINITE. */
talus_status talus_lcp_residual(const talus_lcp *problem, const float *z, double *residual);

#ifdef __cplusplus
}
#endif

#endif
