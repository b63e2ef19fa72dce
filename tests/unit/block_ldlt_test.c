/* The sparse block factor against a dense solve in doubles: chains, trees, rings, nets, joints that double, rows that
 * say the same thing twice; and what does not fit. */
#include "dynamics/block_ldlt.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "store_check.h"

#include "base/width_one.h"
#include "dynamics/block_ldlt.inl"

#define MOST_NODES 40u
#define MOST_ROWS (MOST_NODES * TL_BLOCK_ROWS)

/* Constraints between bodies of six coordinates each with unit mass: J is dense, A = J J^T. */
typedef struct puzzle {
    tl_block_node node[MOST_NODES];
    tl_block block[8u * MOST_NODES];
    uint32_t scratch[TL_BLOCK_SCRATCH(MOST_NODES, MOST_NODES + 1u)];
    float values[8192];
    float jacobian[MOST_NODES][2][TL_BLOCK_ROWS][6];
    uint32_t nodes, ends, used, floats, live[MOST_NODES];
} puzzle;

static double coupling(const puzzle *p, uint32_t i, uint32_t r, uint32_t k, uint32_t c) {
    double sum = 0.0;
    for (int s = 0; s < 2; s++) {
        for (int t = 0; t < 2; t++) {
            if (p->node[i].end[s] == p->node[k].end[t] && p->node[i].end[s] != TL_BLOCK_FREE) {
                for (int m = 0; m < 6; m++) {
                    sum += (double)p->jacobian[i][s][r][m] * (double)p->jacobian[k][t][c][m];
                }
            }
        }
    }
    return sum;
}

static void fill(puzzle *p) {
    for (uint32_t j = 0; j < p->nodes; j++) {
        p->live[j] = p->node[j].rows;
        for (uint32_t r = 0; r < p->node[j].rows; r++) {
            for (uint32_t c = 0; c <= r; c++) {
                p->values[p->node[j].diagonal + ldlt_at(r, c)] = (float)coupling(p, j, r, j, c);
            }
        }
        for (uint32_t k = 0; k < p->node[j].blocks; k++) {
            const tl_block *b = &p->block[p->node[j].first + k];
            for (uint32_t r = 0; r < p->node[b->node].rows; r++) {
                for (uint32_t c = 0; c < p->node[j].rows; c++) {
                    p->values[b->values + r * p->node[j].rows + c] = (float)coupling(p, b->node, r, j, c);
                }
            }
        }
    }
}

/* Gauss elimination with pivoting. */
static void solve_dense(double *a, double *x, uint32_t n) {
    for (uint32_t k = 0; k < n; k++) {
        uint32_t pivot = k;
        for (uint32_t i = k + 1u; i < n; i++) {
            pivot = fabs(a[i * n + k]) > fabs(a[pivot * n + k]) ? i : pivot;
        }
        for (uint32_t m = 0; m < n; m++) {
            double t = a[k * n + m];
            a[k * n + m] = a[pivot * n + m], a[pivot * n + m] = t;
        }
        double t = x[k];
        x[k] = x[pivot], x[pivot] = t;
        for (uint32_t i = k + 1u; i < n; i++) {
            double f = a[i * n + k] / a[k * n + k];
            for (uint32_t m = k; m < n; m++) {
                a[i * n + m] -= f * a[k * n + m];
            }
            x[i] -= f * x[k];
        }
    }
    for (uint32_t k = n; k-- > 0;) {
        for (uint32_t m = k + 1u; m < n; m++) {
            x[k] -= a[k * n + m] * x[m];
        }
        x[k] /= a[k * n + k];
    }
}

static void draw_rows(puzzle *p, uint32_t *seed) {
    for (uint32_t i = 0; i < p->nodes; i++) {
        p->node[i].rows = 1u + (uint32_t)draw_float(seed, 0.0f, 2.99f);
        for (uint32_t k = 0; k < 2u * TL_BLOCK_ROWS * 6u; k++) {
            (&p->jacobian[i][0][0][0])[k] = draw_float(seed, -1.0f, 1.0f);
        }
    }
}

static uint32_t plan(puzzle *p, uint32_t room) {
    p->used = tl_block_plan(p->node, p->nodes, p->ends, p->block, 0, room, p->scratch, &p->floats);
    return p->used;
}

/* The rows of each node if all have as many, else 0. */
static uint32_t even_rows(const puzzle *p) {
    uint32_t rows = p->node[0].rows;
    for (uint32_t i = 0; i < p->nodes; i++) {
        rows = p->node[i].rows == rows && p->live[i] == rows ? rows : 0u;
    }
    return rows;
}

/* Compares with the dense solution of the raised matrix; returns the largest error against the largest value. */
static double compare(puzzle *p, uint32_t *seed) {
    static double dense[MOST_ROWS * MOST_ROWS], x[MOST_ROWS];
    uint32_t n = 0, at[MOST_NODES];
    assert_true(plan(p, 8u * MOST_NODES) != TL_BLOCK_FREE);
    assert_true(p->floats <= sizeof p->values / sizeof *p->values);
    fill(p);
    for (uint32_t i = 0; i < p->nodes; i++) {
        at[i] = n;
        n += p->node[i].rows;
    }
    for (uint32_t i = 0; i < p->nodes; i++) {
        for (uint32_t r = 0; r < p->node[i].rows; r++) {
            for (uint32_t k = 0; k < p->nodes; k++) {
                for (uint32_t c = 0; c < p->node[k].rows; c++) {
                    double raise = i == k && r == c ? 1.0 + (double)TL_BLOCK_RAISE : 1.0;
                    dense[(at[i] + r) * n + at[k] + c] = raise * coupling(p, i, r, k, c);
                }
            }
            x[at[i] + r] = (double)(p->values[p->node[i].x + r] = draw_float(seed, -1.0f, 1.0f));
        }
    }
    solve_dense(dense, x, n);
    ldlt_factor(p->node, p->block, p->live, p->nodes, p->values, even_rows(p));
    ldlt_solve(p->node, p->block, p->live, p->nodes, p->values, even_rows(p));
    double most = 0.0, error = 0.0;
    for (uint32_t i = 0; i < p->nodes; i++) {
        for (uint32_t r = 0; r < p->node[i].rows; r++) {
            most = fmax(most, fabs(x[at[i] + r]));
            error = fmax(error, fabs(x[at[i] + r] - (double)p->values[p->node[i].x + r]));
        }
    }
    return error / most;
}

static void tie_chain(puzzle *p, uint32_t nodes, int ring) {
    p->nodes = nodes, p->ends = ring ? nodes : nodes + 1u;
    for (uint32_t i = 0; i < nodes; i++) {
        p->node[i].end[0] = i, p->node[i].end[1] = (i + 1u) % p->ends;
    }
}

static void chains_and_rings(void **state) {
    (void)state;
    static puzzle p;
    uint32_t seed = 5;
    for (uint32_t nodes = 2; nodes < 30u; nodes++) {
        tie_chain(&p, nodes, 0);
        draw_rows(&p, &seed);
        assert_true(compare(&p, &seed) < 2e-2);
        assert_int_equal(p.used, nodes - 1u); /* no fill */
        tie_chain(&p, nodes + 1u, 1);
        draw_rows(&p, &seed);
        plan(&p, 8u * MOST_NODES);
        assert_true(p.used <= 2u * nodes);
    }
}

/* Every body but the first hangs on one before it; joints are taken from the last one. */
/* All columns but the last two have two blocks of as many rows as a point or a hinge has, which are eliminated in one
 * go. */
static void rings_of_a_kind(void **state) {
    (void)state;
    static puzzle p;
    static const uint32_t rows[] = {3, 5};
    uint32_t seed = 11;
    for (uint32_t nodes = 4; nodes < 24u; nodes++) {
        for (int kind = 0; kind < 2; kind++) {
            tie_chain(&p, nodes, 1);
            draw_rows(&p, &seed);
            for (uint32_t i = 0; i < nodes; i++) {
                p.node[i].rows = rows[kind];
            }
            assert_true(compare(&p, &seed) < 2e-2);
        }
    }
}

static void trees(void **state) {
    (void)state;
    static puzzle p;
    uint32_t seed = 11;
    for (int round = 0; round < 200; round++) {
        p.nodes = 2u + (uint32_t)draw_float(&seed, 0.0f, 20.0f), p.ends = p.nodes;
        uint32_t held[MOST_NODES + 1u] = {0};
        for (uint32_t i = 0; i < p.nodes; i++) { /* body i hangs on a lower one, body 0 on what cannot be moved */
            uint32_t on = i ? (uint32_t)draw_float(&seed, 0.0f, (float)i - 0.01f) : TL_BLOCK_FREE;
            tl_block_node *node = &p.node[p.nodes - 1u - i];
            node->end[0] = on, node->end[1] = i;
            held[i]++;
            held[i ? on : MOST_NODES] += i != 0;
        }
        draw_rows(&p, &seed);
        double error = compare(&p, &seed);
        uint32_t pairs = 0;
        for (uint32_t i = 0; i < p.ends; i++) {
            pairs += held[i] * (held[i] - 1u) / 2u;
        }
        assert_int_equal(p.used, pairs); /* what bodies couple and nothing else */
        assert_true(error < 5e-2);
    }
}

static void whatever_is_tied(void **state) {
    (void)state;
    static puzzle p;
    uint32_t seed = 17;
    for (int round = 0; round < 200; round++) {
        p.nodes = 2u + (uint32_t)draw_float(&seed, 0.0f, 10.0f), p.ends = p.nodes + 1u;
        for (uint32_t i = 0; i < p.nodes; i++) {
            p.node[i].end[0] = (uint32_t)draw_float(&seed, 0.0f, (float)p.ends - 1.01f);
            p.node[i].end[1] = p.node[i].end[0] + 1u;
            p.node[i].end[round % 2] = i % 5u ? p.node[i].end[round % 2] : TL_BLOCK_FREE;
        }
        draw_rows(&p, &seed);
        for (uint32_t i = 0; i < p.nodes; i++) {
            p.node[i].rows = 1u + i % 2u; /* few enough for all to be met */
        }
        plan(&p, 8u * MOST_NODES);
        fill(&p);
        float asked[MOST_NODES][TL_BLOCK_ROWS];
        for (uint32_t i = 0; i < p.nodes; i++) {
            for (uint32_t r = 0; r < p.node[i].rows; r++) {
                asked[i][r] = p.values[p.node[i].x + r] = draw_float(&seed, -1.0f, 1.0f);
            }
        }
        ldlt_factor(p.node, p.block, p.live, p.nodes, p.values, 0);
        ldlt_solve(p.node, p.block, p.live, p.nodes, p.values, 0);
        for (uint32_t i = 0; i < p.nodes; i++) { /* A x = b, but for the raise and rounding, both small against |x| */
            for (uint32_t r = 0; r < p.node[i].rows; r++) {
                double sum = 0.0, most = 1.0;
                for (uint32_t k = 0; k < p.nodes; k++) {
                    for (uint32_t c = 0; c < p.node[k].rows; c++) {
                        double x = (double)p.values[p.node[k].x + c];
                        sum += coupling(&p, i, r, k, c) * x;
                        most = fmax(most, fabs(x));
                    }
                }
                assert_true(fabs(sum - (double)asked[i][r]) < 2e-4 * most);
            }
        }
    }
}

/* The same joint three times: each bears a third. */
static void the_same_thing_thrice(void **state) {
    (void)state;
    static puzzle p;
    uint32_t seed = 23;
    tie_chain(&p, 3, 0);
    draw_rows(&p, &seed);
    for (uint32_t i = 0; i < 3u; i++) {
        p.node[i].end[0] = 0, p.node[i].end[1] = 1, p.node[i].rows = 3;
        memcpy(p.jacobian[i], p.jacobian[0], sizeof p.jacobian[0]);
    }
    p.ends = 2;
    assert_int_equal(plan(&p, 8u * MOST_NODES), 3);
    fill(&p);
    for (uint32_t i = 0; i < 3u; i++) {
        for (uint32_t r = 0; r < 3u; r++) {
            p.values[p.node[i].x + r] = 0.5f + (float)r;
        }
    }
    ldlt_factor(p.node, p.block, p.live, p.nodes, p.values, 0);
    ldlt_solve(p.node, p.block, p.live, p.nodes, p.values, 0);
    for (uint32_t r = 0; r < 3u; r++) {
        float share = p.values[p.node[0].x + r];
        for (uint32_t i = 1; i < 3u; i++) {
            assert_true(fabsf(p.values[p.node[i].x + r] - share) < 0.05f * fabsf(share) + 0.02f);
        }
    }
}

static void what_does_not_fit(void **state) {
    (void)state;
    static puzzle p;
    tie_chain(&p, 20, 0);
    for (uint32_t i = 0; i < 20u; i++) {
        p.node[i].rows = 3;
    }
    assert_int_equal(plan(&p, 19), 19);
    assert_true(plan(&p, 18) == TL_BLOCK_FREE);
    for (uint32_t i = 0; i < 20u; i++) {
        p.node[i].end[0] = 0; /* all on one body: everything is coupled to everything */
    }
    assert_int_equal(plan(&p, 190), 190);
    assert_true(plan(&p, 189) == TL_BLOCK_FREE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_and_rings),
        cmocka_unit_test(rings_of_a_kind),
        cmocka_unit_test(trees),
        cmocka_unit_test(whatever_is_tied),
        cmocka_unit_test(the_same_thing_thrice),
        cmocka_unit_test(what_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
