#include "figures.h"

#include <stdlib.h>

int figures_compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double at(const double *values, size_t count, double share) {
    size_t i = (size_t)((double)count * share);
    return values[i < count ? i : count - 1];
}

figures figures_of(double *values, size_t count) {
    figures f = {0, 0, 0, 0, 0, 0};
    if (count == 0) {
        return f;
    }
    for (size_t i = 0; i < count; i++) {
        f.mean += values[i];
    }
    f.mean /= (double)count;
    qsort(values, count, sizeof *values, figures_compare);
    f.p50 = at(values, count, 0.5), f.p95 = at(values, count, 0.95), f.p99 = at(values, count, 0.99);
    f.p999 = at(values, count, 0.999), f.max = values[count - 1];
    return f;
}
