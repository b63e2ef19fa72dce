/* Two questions, each of what can answer it. Whether there is a difference: of the runs, for the machine's moods last
 * longer than a step, and steps of one run share them (Kalibera and Jones, Rigorous Benchmarking in Reasonable Time,
 * ISMM 2013). How large it is: of the least times of the steps, which the machine disturbed least. */
#include "compare.h"

#include "figures.h"

#include <math.h>
#include <stdlib.h>

#define REPLICATES 1000u
#define MOST_DRAWN 10000u /* steps in a replicate */
#define EXACT 40u         /* values together */

static int by_value(const void *a, const void *b) {
    double x = ((const compare_weighted *)a)->value, y = ((const compare_weighted *)b)->value;
    return x < y ? -1 : x > y;
}

double compare_median(compare_weighted *items, uint32_t count) {
    double all = 0, sum = 0;
    qsort(items, count, sizeof *items, by_value);
    for (uint32_t i = 0; i < count; i++) {
        all += items[i].weight;
    }
    for (uint32_t i = 0; i < count; i++) {
        sum += items[i].weight;
        if (2 * sum >= all) {
            return items[i].value;
        }
    }
    return 0;
}

/* --- whether ---------------------------------------------------------------------------------- */

/* Twice the mean rank of each value, ties sharing theirs; returns the sum over ties of t^3 - t. */
static double rank(compare_weighted *values, uint32_t count, uint32_t *twice) {
    double ties = 0;
    qsort(values, count, sizeof *values, by_value);
    for (uint32_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count && values[next].value == values[i].value; next++) {
        }
        double t = next - i;
        ties += t * t * t - t;
        for (uint32_t k = i; k < next; k++) {
            twice[k] = i + 1 + next;
        }
    }
    return ties;
}

/* How the sums of `count_a` of the ranks are spread, by counting all choices; what lies at least as far from the middle
 * as `sum` does. */
static double exact_p(const uint32_t *twice, uint32_t count, uint32_t count_a, uint32_t sum) {
    uint32_t sums = count * (count + 1) + 1;
    double *ways = calloc((size_t)(count_a + 1) * sums, sizeof *ways), all = 0, far = 0;
    if (ways == NULL) {
        return -1;
    }
    ways[0] = 1;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = count_a; k > 0; k--) {
            for (uint32_t s = sums; s-- > twice[i];) {
                ways[(size_t)k * sums + s] += ways[(size_t)(k - 1) * sums + s - twice[i]];
            }
        }
    }
    double middle = (double)count_a * (count + 1), off = fabs(sum - middle);
    for (uint32_t s = 0; s < sums; s++) {
        double w = ways[(size_t)count_a * sums + s];
        all += w;
        far += fabs(s - middle) >= off ? w : 0;
    }
    free(ways);
    return far / all;
}

double compare_rank_sum(const double *a, uint32_t count_a, const double *b, uint32_t count_b) {
    uint32_t count = count_a + count_b, sum = 0;
    compare_weighted *values = calloc((size_t)count + 1, sizeof *values);
    uint32_t *twice = calloc((size_t)count + 1, sizeof *twice);
    double p = -1;
    if (values != NULL && twice != NULL) {
        for (uint32_t i = 0; i < count; i++) { /* the weight tells whose it is */
            values[i].value = i < count_a ? a[i] : b[i - count_a];
            values[i].weight = i < count_a;
        }
        double ties = rank(values, count, twice), n = count;
        for (uint32_t i = 0; i < count; i++) {
            sum += values[i].weight > 0 ? twice[i] : 0;
        }
        if (count <= EXACT) {
            p = exact_p(twice, count, count_a, sum);
        } else {
            double off = fabs(0.5 * sum - 0.5 * count_a * (n + 1));
            double variance = (double)count_a * count_b / 12.0 * (n + 1 - ties / (n * (n - 1)));
            p = variance > 0 ? erfc(off / sqrt(2 * variance)) : 1;
        }
    }
    free(values);
    free(twice);
    return p;
}

/* One number a run: the weighted median of its steps' logarithms against the reference. */
static void place_runs(const double *times, uint32_t runs, uint32_t steps, const double *reference,
                       compare_weighted *items, double *out) {
    for (uint32_t run = 0; run < runs; run++) {
        for (uint32_t i = 0; i < steps; i++) {
            items[i].value = log(times[(size_t)run * steps + i] / reference[i]);
            items[i].weight = reference[i];
        }
        out[run] = compare_median(items, steps);
    }
}

static void make_reference(const double *a, const double *b, uint32_t runs, uint32_t steps, compare_weighted *items,
                           double *reference) {
    for (uint32_t i = 0; i < steps; i++) {
        for (uint32_t run = 0; run < runs; run++) {
            items[2 * run].value = a[(size_t)run * steps + i];
            items[2 * run + 1].value = b[(size_t)run * steps + i];
            items[2 * run].weight = items[2 * run + 1].weight = 1;
        }
        reference[i] = compare_median(items, 2 * runs);
    }
}

/* --- how large -------------------------------------------------------------------------------- */

/* xorshift64* (Vigna, ACM Transactions on Mathematical Software 42, 2016), into [0, bound). */
static uint32_t draw(uint64_t *state, uint32_t bound) {
    *state ^= *state >> 12, *state ^= *state << 25, *state ^= *state >> 27;
    return (uint32_t)(((*state * 0x2545f4914f6cdd1du) >> 32) * bound >> 32);
}

static double least(const double *times, const uint32_t *runs, uint32_t count, uint32_t steps, uint32_t step) {
    double low = times[(size_t)runs[0] * steps + step];
    for (uint32_t k = 1; k < count; k++) {
        double t = times[(size_t)runs[k] * steps + step];
        low = t < low ? t : low;
    }
    return low;
}

static void compare_step(const double *a, const double *b, const uint32_t *runs_a, const uint32_t *runs_b,
                         uint32_t runs, uint32_t steps, uint32_t step, compare_weighted *out) {
    double low_a = least(a, runs_a, runs, steps, step), low_b = least(b, runs_b, runs, steps, step);
    out->value = log(low_b / low_a);
    out->weight = sqrt(low_a * low_b);
}

/* Replicates by drawing runs, and blocks of steps, for neighbours are alike (circular block bootstrap, Politis and
 * Romano, 1992), with replacement. */
static void bootstrap(const double *a, const double *b, uint32_t runs, uint32_t steps, compare_weighted *items,
                      uint32_t *chosen, double *replicates) {
    uint32_t drawn = steps < MOST_DRAWN ? steps : MOST_DRAWN, block = (uint32_t)ceil(cbrt(drawn));
    uint64_t state = 0x9e3779b97f4a7c15u;
    for (uint32_t r = 0; r < REPLICATES; r++) {
        for (uint32_t k = 0; k < 2 * runs; k++) {
            chosen[k] = draw(&state, runs);
        }
        for (uint32_t i = 0, step = 0; i < drawn; i++) {
            step = i % block == 0 ? draw(&state, steps) : (step + 1) % steps;
            compare_step(a, b, chosen, chosen + runs, runs, steps, step, &items[i]);
        }
        replicates[r] = compare_median(items, drawn);
    }
}

static compare_verdict judge(const compare_result *r) {
    if (r->runs < COMPARE_LEAST_RUNS) {
        return COMPARE_TOO_FEW;
    }
    if (r->p < COMPARE_LEVEL && r->low > 1) {
        return COMPARE_SLOWER;
    }
    return r->p < COMPARE_LEVEL && r->high < 1 ? COMPARE_FASTER : COMPARE_SAME;
}

int compare_runs(const double *a, uint32_t runs_a, const double *b, uint32_t runs_b, uint32_t steps,
                 compare_result *out) {
    /* The least of more runs is lower: as many of each. */
    uint32_t runs = runs_a < runs_b ? runs_a : runs_b, most = steps > 2 * runs ? steps : 2 * runs;
    compare_weighted *items = calloc((size_t)most + 1, sizeof *items);
    double *reference = calloc((size_t)steps + 2 * runs + REPLICATES + 1, sizeof *reference);
    uint32_t *chosen = calloc(2 * (size_t)runs + 1, sizeof *chosen);
    int ok = items != NULL && reference != NULL && chosen != NULL;
    if (ok) {
        double *placed = reference + steps, *replicates = placed + 2 * runs;
        make_reference(a, b, runs, steps, items, reference);
        place_runs(a, runs, steps, reference, items, placed);
        place_runs(b, runs, steps, reference, items, placed + runs);
        out->runs = runs;
        out->p = compare_rank_sum(placed, runs, placed + runs, runs);
        ok = out->p >= 0;
        bootstrap(a, b, runs, steps, items, chosen, replicates);
        qsort(replicates, REPLICATES, sizeof *replicates, figures_compare);
        out->low = exp(replicates[REPLICATES / 40]);
        out->high = exp(replicates[REPLICATES - 1 - REPLICATES / 40]);
        for (uint32_t k = 0; k < runs; k++) {
            chosen[k] = k;
        }
        for (uint32_t i = 0; i < steps; i++) {
            compare_step(a, b, chosen, chosen, runs, steps, i, &items[i]);
        }
        out->ratio = exp(compare_median(items, steps));
        out->verdict = judge(out);
    }
    free(items);
    free(reference);
    free(chosen);
    return ok;
}
