/* Whether the steps of one profile take longer than those of another, on a machine that does other things as well. */
#ifndef TALUS_TOOL_COMPARE_H
#define TALUS_TOOL_COMPARE_H

#include <stdint.h>

#define COMPARE_LEAST_RUNS 4u /* of each: fewer cannot pass the test at COMPARE_LEVEL, however they lie */
#define COMPARE_LEVEL 0.05

typedef enum compare_verdict { COMPARE_SAME, COMPARE_SLOWER, COMPARE_FASTER, COMPARE_TOO_FEW } compare_verdict;

typedef struct compare_result {
    compare_verdict verdict; /* of B */
    double ratio;            /* B's time over A's */
    double low, high;        /* 95 % of the bootstrap lie between */
    double p;                /* that runs in no order of their own would lie so far apart */
    uint32_t runs;           /* of each that were looked at */
} compare_result;

/* `a` and `b` hold runs x steps times, run by run, all above 0. Deterministic. 0 if there is no memory. */
int compare_runs(const double *a, uint32_t runs_a, const double *b, uint32_t runs_b, uint32_t steps,
                 compare_result *out);

/* Two-sided p of Wilcoxon's rank-sum test (Biometrics Bulletin 1, 1945): whether `a` and `b` are drawn from one urn.
 * Exact, ties included, up to 40 values together; beyond that by the normal distribution. Negative without memory. */
double compare_rank_sum(const double *a, uint32_t count_a, const double *b, uint32_t count_b);

/* The value that halves the weight; sorts by value. */
typedef struct compare_weighted {
    double value, weight;
} compare_weighted;
double compare_median(compare_weighted *items, uint32_t count);

#endif
