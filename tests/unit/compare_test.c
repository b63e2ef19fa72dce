/* Whether one profile is slower than another: on made-up runs whose difference is known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "talus/compare.h"

#define STEPS 150u
#define RUNS 5u

static double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return ((double)(*state >> 11) + 0.5) / 9007199254740992.0;
}
static double normal(uint64_t *state) {
    return sqrt(-2 * log(uniform(state))) * cos(6.283185307179586 * uniform(state));
}

/* Runs on a machine with moods: a factor of each run, a slow wave in it, noise of each step that only adds, and now and
 * then a step that something else got into. */
static void make_runs(uint64_t *state, double shift, double *out) {
    for (uint32_t run = 0; run < RUNS; run++) {
        double mood = exp(0.01 * normal(state)), wave = 0;
        for (uint32_t i = 0; i < STEPS; i++) {
            double work = 200e3 * (1.2 + sin(0.05 * i)) * (i % 40 == 7 ? 4 : 1);
            wave = 0.9 * wave + 0.01 * normal(state);
            double noise = 1 - 0.02 * log(uniform(state)), other = uniform(state) < 0.02 ? 2e6 * uniform(state) : 0;
            out[run * STEPS + i] = work * shift * mood * exp(wave) * noise + other;
        }
    }
}

static double a[RUNS * STEPS], b[RUNS * STEPS];

static void counts_ranks(void **state) {
    (void)state;
    /* tables of the exact distribution: 5 against 5, apart: 2 / 252; 4 against 4: 2 / 70 */
    const double low[5] = {1, 2, 3, 4, 5}, high[5] = {6, 7, 8, 9, 10}, mixed[5] = {1.5, 3.5, 5.5, 7.5, 9.5};
    assert_true(fabs(compare_rank_sum(low, 5, high, 5) - 2.0 / 252) < 1e-12);
    assert_true(fabs(compare_rank_sum(high, 5, low, 5) - 2.0 / 252) < 1e-12);
    assert_true(fabs(compare_rank_sum(low, 4, high, 4) - 2.0 / 70) < 1e-12);
    assert_true(compare_rank_sum(low, 3, high, 3) > COMPARE_LEVEL);
    assert_true(compare_rank_sum(low, 5, mixed, 5) > 0.1);
    assert_true(fabs(compare_rank_sum(low, 5, low, 5) - 1) < 1e-12);
    const double tied[4] = {1, 1, 1, 1};
    assert_true(fabs(compare_rank_sum(tied, 4, tied, 4) - 1) < 1e-12);
    /* many: the normal distribution takes over and agrees */
    double many[50], more[50];
    for (int i = 0; i < 50; i++) {
        many[i] = i, more[i] = i + 25.5;
    }
    assert_true(compare_rank_sum(many, 50, more, 50) < 1e-6);
    assert_true(fabs(compare_rank_sum(many, 20, more, 20) - compare_rank_sum(many, 20, more, 21)) < 1e-3);
}

static void halves_the_weight(void **state) {
    (void)state;
    compare_weighted items[3] = {{5, 1}, {1, 1}, {3, 10}};
    assert_true(compare_median(items, 3) == 3);
    compare_weighted heavy[2] = {{1, 1}, {9, 3}};
    assert_true(compare_median(heavy, 2) == 9);
}

static void sees_what_is_there(void **state) {
    (void)state;
    uint64_t seed = 11;
    print_message("seed %llu\n", (unsigned long long)seed);
    const double shifts[] = {1.05, 1 / 1.05, 1.5};
    for (int s = 0; s < 3; s++) {
        int seen = 0, held = 0, wrong = 0;
        for (int round = 0; round < 40; round++) {
            compare_result r;
            make_runs(&seed, 1, a);
            make_runs(&seed, shifts[s], b);
            assert_true(compare_runs(a, RUNS, b, RUNS, STEPS, &r));
            assert_true(r.low <= r.ratio && r.ratio <= r.high);
            seen += r.verdict == (shifts[s] > 1 ? COMPARE_SLOWER : COMPARE_FASTER);
            wrong += r.verdict == (shifts[s] > 1 ? COMPARE_FASTER : COMPARE_SLOWER);
            held += r.low <= shifts[s] && shifts[s] <= r.high;
        }
        print_message("shift %.3f: seen %d, interval holds it %d of 40\n", shifts[s], seen, held);
        assert_true(seen >= 34 && wrong == 0 && held >= 28);
    }
}

/* Ten thousand steps say nothing about five moods: of runs alike, no more than one in twenty may be called different.
 */
static void seldom_sees_what_is_not(void **state) {
    (void)state;
    uint64_t seed = 5;
    int wrong = 0;
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int round = 0; round < 300; round++) {
        compare_result r;
        make_runs(&seed, 1, a);
        make_runs(&seed, 1, b);
        assert_true(compare_runs(a, RUNS, b, RUNS, STEPS, &r));
        wrong += r.verdict != COMPARE_SAME;
    }
    print_message("called different: %d of 300\n", wrong);
    assert_true(wrong <= 15);
}

static void stands_a_disturbed_run(void **state) {
    (void)state;
    uint64_t seed = 23;
    int seen = 0;
    for (int round = 0; round < 20; round++) {
        compare_result r;
        make_runs(&seed, 1, a);
        make_runs(&seed, 1, b);
        for (uint32_t i = 0; i < STEPS; i++) { /* something else ran beside one of B's */
            b[2 * STEPS + i] *= 1.6;
        }
        assert_true(compare_runs(a, RUNS, b, RUNS, STEPS, &r));
        seen += r.verdict != COMPARE_SAME;
        assert_true(r.ratio > 0.95 && r.ratio < 1.05);
    }
    assert_true(seen <= 2);
}

static void few_runs_say_nothing(void **state) {
    (void)state;
    uint64_t seed = 3;
    compare_result r, again;
    make_runs(&seed, 1, a);
    make_runs(&seed, 2, b);
    assert_true(compare_runs(a, 3, b, RUNS, STEPS, &r));
    assert_int_equal(r.verdict, COMPARE_TOO_FEW);
    assert_int_equal(r.runs, 3);
    assert_true(compare_runs(a, RUNS, b, RUNS, STEPS, &r));
    assert_true(compare_runs(a, RUNS, b, RUNS, STEPS, &again));
    assert_true(r.verdict == COMPARE_SLOWER && r.verdict == again.verdict && r.p == again.p);
    assert_true(r.ratio == again.ratio && r.low == again.low && r.high == again.high);
    assert_true(compare_runs(a, RUNS, a, RUNS, STEPS, &r));
    assert_true(r.verdict == COMPARE_SAME && r.ratio == 1);
    assert_true(compare_runs(a, RUNS, b, RUNS, 1, &r));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_ranks),           cmocka_unit_test(halves_the_weight),
        cmocka_unit_test(sees_what_is_there),     cmocka_unit_test(seldom_sees_what_is_not),
        cmocka_unit_test(stands_a_disturbed_run), cmocka_unit_test(few_runs_say_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
