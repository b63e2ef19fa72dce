/* The figures that times are told by. */
#ifndef TALUS_TOOL_FIGURES_H
#define TALUS_TOOL_FIGURES_H

#include <stddef.h>

/* Of n values sorted upwards, the one of share p stands at floor(n p), or is the last. All 0 of no values. */
typedef struct figures {
    double mean, p50, p95, p99, p999, max;
} figures;

/* Sorts the values. */
figures figures_of(double *values, size_t count);

int figures_compare(const void *a, const void *b); /* of two doubles, for qsort */

#endif
