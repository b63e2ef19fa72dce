/* The methods for linear complementarity: against all active sets tried one by one, on matrices of full rank and not,
 * with and without bounds, on contacts of stacks, and against each other. */
#include "store_check.h"

#include "talus/lcp.h"

#define MOST 48

typedef struct problem {
    talus_lcp lcp;
    float a[MOST * MOST], b[MOST], lo[MOST], hi[MOST];
    uint32_t normal[MOST];
} problem;

static void *memory;
static size_t memory_bytes;

static int set_up(void **state) {
    (void)state;
    memory_bytes = talus_lcp_memory(TALUS_LCP_LEMKE, MOST);
    memory = malloc(memory_bytes);
    return memory == NULL;
}
static int tear_down(void **state) {
    (void)state;
    free(memory);
    return 0;
}

static void begin(problem *p, uint32_t n) {
    memset(p, 0, sizeof *p);
    p->lcp.count = n;
    p->lcp.a = p->a, p->lcp.b = p->b, p->lcp.lo = p->lo, p->lcp.hi = p->hi;
}

/* Unlike matrices: G G^T with as many columns as `rank`; entries of about 1. */
static void draw_matrix(problem *p, uint32_t rank, uint32_t *seed) {
    uint32_t n = p->lcp.count;
    float g[MOST][MOST];
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = 0; k < rank; k++) {
            g[i][k] = (float)((int)(draw(seed) % 2001u) - 1000) / 1024.0f; /* so that sums are exact */
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < rank; k++) {
                sum += (double)g[i][k] * (double)g[j][k];
            }
            p->a[i * n + j] = (float)sum;
        }
    }
}

enum { PLAIN, BOXED, MIXED, KINDS };

static void draw_bounds(problem *p, int kind, uint32_t *seed) {
    for (uint32_t i = 0; i < p->lcp.count; i++) {
        uint32_t what = kind == PLAIN ? 0u : kind == BOXED ? 1u : draw(seed) % 5u;
        p->lo[i] = what == 2u || what == 3u ? -INFINITY : what == 0u ? 0.0f : draw_float(seed, -1.0f, 0.5f);
        p->hi[i] = what == 0u || what == 3u ? INFINITY : what == 2u ? draw_float(seed, -0.5f, 1.0f) : p->lo[i];
        p->hi[i] += what == 1u ? draw_float(seed, 0.0f, 1.5f) : 0.0f; /* 4: held */
        p->b[i] = draw_float(seed, -1.0f, 1.0f);
    }
}

/* x of m x = r by Gauss' elimination with full pivoting; 0 if the matrix is singular. */
static int eliminate(double m[8][9], uint32_t n, double *x) {
    uint32_t column[8];
    for (uint32_t k = 0; k < n; k++) {
        column[k] = k;
    }
    for (uint32_t k = 0; k < n; k++) {
        uint32_t r = k, c = k;
        for (uint32_t i = k; i < n; i++) {
            for (uint32_t j = k; j < n; j++) {
                if (fabs(m[i][j]) > fabs(m[r][c])) {
                    r = i, c = j;
                }
            }
        }
        if (fabs(m[r][c]) < 1e-6) {
            return 0;
        }
        for (uint32_t j = 0; j <= n; j++) {
            double t = m[k][j];
            m[k][j] = m[r][j], m[r][j] = t;
        }
        for (uint32_t i = 0; i < n; i++) {
            double t = m[i][k];
            m[i][k] = m[i][c], m[i][c] = t;
        }
        uint32_t t = column[k];
        column[k] = column[c], column[c] = t;
        for (uint32_t i = k + 1; i < n; i++) {
            double share = m[i][k] / m[k][k];
            for (uint32_t j = k; j <= n; j++) {
                m[i][j] -= share * m[k][j];
            }
        }
    }
    for (uint32_t k = n; k-- > 0;) {
        double sum = m[k][n];
        for (uint32_t j = k + 1; j < n; j++) {
            sum -= m[k][j] * x[column[j]];
        }
        x[column[k]] = sum / m[k][k];
    }
    return 1;
}

/* One of the 3^n ways to be at the low bound, at the high one, or between: z, if it solves the problem. */
static int try_set(const problem *p, uint32_t code, double *z) {
    uint32_t n = p->lcp.count, between[8], count = 0, what[8];
    double m[8][9], x[8];
    for (uint32_t i = 0; i < n; i++, code /= 3u) {
        what[i] = code % 3u;
        double bound = what[i] == 1u ? (double)p->lo[i] : (double)p->hi[i];
        if (what[i] == 0u) {
            between[count++] = i;
        } else if (isinf(bound)) {
            return 0;
        }
        z[i] = what[i] == 0u ? 0.0 : bound;
    }
    for (uint32_t r = 0; r < count; r++) {
        m[r][count] = -(double)p->b[between[r]];
        for (uint32_t k = 0; k < n; k++) {
            m[r][count] -= (double)p->a[between[r] * n + k] * z[k];
        }
        for (uint32_t k = 0; k < count; k++) {
            m[r][k] = (double)p->a[between[r] * n + between[k]];
        }
    }
    if (!eliminate(m, count, x)) {
        return 0;
    }
    for (uint32_t r = 0; r < count; r++) {
        z[between[r]] = x[r];
    }
    for (uint32_t i = 0; i < n; i++) {
        double w = (double)p->b[i];
        for (uint32_t k = 0; k < n; k++) {
            w += (double)p->a[i * n + k] * z[k];
        }
        if (z[i] < (double)p->lo[i] - 1e-6 || z[i] > (double)p->hi[i] + 1e-6 ||
            (p->lo[i] < p->hi[i] && ((what[i] == 1u && w < -1e-6) || (what[i] == 2u && w > 1e-6)))) {
            return 0;
        }
    }
    return 1;
}

/* Finds all but some solutions with two unbounded rows of which one depends on the other. */
static int brute(const problem *p, double *z) {
    uint32_t sets = 1;
    for (uint32_t i = 0; i < p->lcp.count; i++) {
        sets *= 3u;
    }
    for (uint32_t code = 0; code < sets; code++) {
        if (try_set(p, code, z)) {
            return 1;
        }
    }
    return 0;
}

static talus_lcp_result dantzig(const problem *p, float *z) {
    talus_lcp_result r;
    OK(talus_lcp_dantzig(&p->lcp, 0, 1e-6, z, memory, memory_bytes, &r));
    return r;
}
static talus_lcp_result lemke(const problem *p, float *z) {
    talus_lcp_result r;
    OK(talus_lcp_lemke(&p->lcp, 0, z, memory, memory_bytes, &r));
    return r;
}
static talus_lcp_result pgs(const problem *p, uint32_t sweeps, double tolerance, float *z) {
    talus_lcp_result r;
    OK(talus_lcp_pgs(&p->lcp, sweeps, tolerance, z, memory, memory_bytes, &r));
    return r;
}

/* The largest number that w is made of: what rounding z to floats moves w by goes with it. */
static double size_of(const problem *p, const float *z) {
    double most = 0.0;
    for (uint32_t i = 0; i < p->lcp.count; i++) {
        double sum = fabs((double)p->b[i]);
        for (uint32_t k = 0; k < p->lcp.count; k++) {
            sum += fabs((double)p->a[i * p->lcp.count + k] * (double)z[k]);
        }
        most = fmax(most, sum);
    }
    return most;
}

static double w_of(const problem *p, const double *z, uint32_t i) {
    double w = (double)p->b[i];
    for (uint32_t k = 0; k < p->lcp.count; k++) {
        w += (double)p->a[i * p->lcp.count + k] * z[k];
    }
    return w;
}

/* What a method found against what trying all found: the same w (it is unique where A is semidefinite), and so the same
 * z where A has full rank. */
static void same(const problem *p, const float *z, const double *truth, const talus_lcp_result *r, int full) {
    double size = size_of(p, z), as_double[MOST];
    assert_int_equal(r->outcome, TALUS_LCP_SOLVED);
    NEAR(r->residual, 0.0, 2e-7 * size);
    for (uint32_t i = 0; i < p->lcp.count; i++) {
        as_double[i] = (double)z[i];
    }
    for (uint32_t i = 0; i < p->lcp.count; i++) {
        NEAR(w_of(p, as_double, i), w_of(p, truth, i), 1e-5 * size);
        if (full) {
            NEAR(z[i], truth[i], 2e-3 * (1.0 + fabs(truth[i])));
        }
    }
}

static uint32_t number_of(const char *name, uint32_t otherwise) {
    const char *text = getenv(name);
    return text ? (uint32_t)strtoul(text, NULL, 10) : otherwise;
}

static void all_sets(void **state) {
    (void)state;
    uint32_t seed = number_of("TALUS_SEED", 5), rounds = number_of("TALUS_ROUNDS", 600), solved = 0, none = 0;
    print_message("  seed %u\n", seed);
    for (uint32_t round = 0; round < rounds; round++) {
        problem p;
        float z[MOST] = {0.0f};
        double truth[MOST];
        uint32_t n = 1u + draw(&seed) % 8u, rank = round % 3 == 2 ? 1u + draw(&seed) % n : n;
        begin(&p, n);
        draw_matrix(&p, rank, &seed);
        for (uint32_t i = 0; round % 3 == 0 && i < n; i++) {
            p.a[i * n + i] += 0.25f;
        }
        draw_bounds(&p, (int)(round / 3u % KINDS), &seed);
        if (round % 3 == 2 && round % 2) { /* what a solution exists for: b in A's range */
            for (uint32_t i = 0; i < n; i++) {
                p.b[i] = 0.5f * p.a[i * n] - 0.25f * p.a[i * n + n - 1u];
            }
        }
        int there = brute(&p, truth), full = round % 3 == 0;
        talus_lcp_result d = dantzig(&p, z);
        if (there) {
            solved++;
            same(&p, z, truth, &d, full);
            talus_lcp_result l = lemke(&p, z);
            same(&p, z, truth, &l, full);
        } else {
            talus_lcp_result l = lemke(&p, z);
            none += d.outcome == TALUS_LCP_RAY;
            assert_true(l.outcome == TALUS_LCP_RAY || l.residual <= 2e-7 * size_of(&p, z));
            d = dantzig(&p, z);
            assert_true(d.outcome == TALUS_LCP_RAY || d.residual <= 2e-7 * size_of(&p, z));
        }
        if (full) {
            memset(z, 0, sizeof z);
            talus_lcp_result g = pgs(&p, 20000, 1e-6, z);
            assert_int_equal(g.outcome, TALUS_LCP_SOLVED);
            same(&p, z, truth, &d, 0);
        }
    }
    print_message("  %u solved, %u without a solution\n", solved, none);
    assert_true(solved > rounds / 2u && none > rounds / 100u);
}

/* Larger ones: the three agree. */
static void agree(void **state) {
    (void)state;
    uint32_t seed = 9;
    for (int round = 0; round < 60; round++) {
        problem p;
        float z[3][MOST] = {{0.0f}};
        uint32_t n = 8u + draw(&seed) % 40u;
        begin(&p, n);
        draw_matrix(&p, n, &seed);
        for (uint32_t i = 0; i < n; i++) {
            p.a[i * n + i] += 1.0f;
        }
        draw_bounds(&p, round % KINDS, &seed);
        talus_lcp_result r[3] = {pgs(&p, 5000, 1e-5, z[0]), dantzig(&p, z[1]), lemke(&p, z[2])};
        for (int k = 0; k < 3; k++) {
            assert_int_equal(r[k].outcome, TALUS_LCP_SOLVED);
            NEAR(r[k].residual, 0.0, k ? 2e-7 * size_of(&p, z[k]) : 1e-5);
            for (uint32_t i = 0; i < n; i++) {
                NEAR(z[k][i], z[1][i], 1e-4);
            }
        }
        assert_true(r[1].steps < 6u * n);
        assert_true(r[2].steps < 12u * n);
    }
}

/* A matrix of Murty's kind, on which pivoting takes very many steps, and one full of ties. */
static void degenerate(void **state) {
    (void)state;
    problem p;
    float z[MOST];
    begin(&p, 8);
    for (uint32_t i = 0; i < 8; i++) {
        for (uint32_t k = 0; k < 8; k++) {
            p.a[i * 8 + k] = k < i ? 2.0f : k == i ? 1.0f : 0.0f;
        }
        p.b[i] = -1.0f;
        p.hi[i] = INFINITY;
    }
    talus_lcp_result r = lemke(&p, z);
    assert_int_equal(r.outcome, TALUS_LCP_SOLVED);
    assert_true(r.residual <= 0.0);
    for (uint32_t i = 0; i < 8; i++) {
        NEAR(z[i], i == 0 ? 1.0f : 0.0f, 0.0f);
    }
    /* all entries alike, and b too: rank 1, every ratio a tie */
    begin(&p, 24);
    for (uint32_t i = 0; i < 24; i++) {
        for (uint32_t k = 0; k < 24; k++) {
            p.a[i * 24 + k] = 1.0f;
        }
        p.b[i] = -3.0f;
        p.hi[i] = i % 2 ? 0.25f : INFINITY;
    }
    for (int method = 0; method < 3; method++) {
        memset(z, 0, sizeof z);
        r = method == 0 ? pgs(&p, 100, 1e-6, z) : method == 1 ? dantzig(&p, z) : lemke(&p, z);
        assert_int_equal(r.outcome, TALUS_LCP_SOLVED);
        NEAR(r.residual, 0.0, 2e-6);
        double sum = 0.0;
        for (uint32_t i = 0; i < 24; i++) {
            sum += (double)z[i];
        }
        NEAR(sum, 3.0, 2e-6);
    }
}

/* The impulses of a step at rest of a stack of boxes of 2 kg, a metre wide, on a slope; four corners an interface (two
 * with friction along the slope, in the plane). Velocities are x, y and the turn, or y and the two turns across. */
static void stack_rows(problem *p, int boxes, int friction, double mu, double angle) {
    const double mass = 2.0, inertia = mass / 6.0, h = 1.0 / 60.0, g = 9.81;
    int corners = friction ? 2 : 4, rows = friction ? 4 : 4;
    double j[MOST][3 * 12] = {{0.0}};
    begin(p, (uint32_t)(boxes * rows));
    for (int box = 0; box < boxes; box++) {
        for (int c = 0; c < corners; c++) {
            double x = c % 2 ? 0.5 : -0.5, z = c / 2 ? 0.5 : -0.5;
            int row = box * rows + c, under = box - 1;
            if (friction) {
                j[row][3 * box + 1] = 1.0, j[row][3 * box + 2] = x;
                j[row + 2][3 * box] = 1.0, j[row + 2][3 * box + 2] = 0.5;
                if (box) {
                    j[row][3 * under + 1] = -1.0, j[row][3 * under + 2] = -x;
                    j[row + 2][3 * under] = -1.0, j[row + 2][3 * under + 2] = 0.5;
                }
            } else {
                j[row][3 * box] = 1.0, j[row][3 * box + 1] = x, j[row][3 * box + 2] = z;
                if (box) {
                    j[row][3 * under] = -1.0, j[row][3 * under + 1] = -x, j[row][3 * under + 2] = -z;
                }
            }
        }
    }
    uint32_t n = p->lcp.count;
    for (uint32_t i = 0; i < n; i++) {
        double b = 0.0;
        for (int k = 0; k < 3 * boxes; k++) {
            double inverse =
                friction ? (k % 3 == 2 ? 1.0 / inertia : 1.0 / mass) : (k % 3 ? 1.0 / inertia : 1.0 / mass);
            double force = friction ? (k % 3 == 0 ? sin(angle) : k % 3 == 1 ? -cos(angle) : 0.0) : (k % 3 ? 0.0 : -1.0);
            b += j[i][k] * h * g * force;
            for (uint32_t m = 0; m < n; m++) {
                p->a[i * n + m] += (float)(j[i][k] * inverse * j[m][k]);
            }
        }
        p->b[i] = (float)b;
        p->hi[i] = INFINITY;
        p->normal[i] = TALUS_LCP_NO_NORMAL;
        if (friction && i % 4u >= 2u) {
            p->hi[i] = (float)mu;
            p->normal[i] = i - 2u;
        }
    }
    p->lcp.normal = friction ? p->normal : NULL;
}

/* Four corners hold a box where three would do: the forces are not unique, their sum is. */
static void stacks(void **state) {
    (void)state;
    for (int boxes = 1; boxes <= 8; boxes++) {
        problem p;
        stack_rows(&p, boxes, 0, 0.0, 0.0);
        for (int method = 0; method < 3; method++) {
            float z[MOST] = {0.0f};
            talus_lcp_result r = method == 0 ? pgs(&p, 100000, 1e-5, z) : method == 1 ? dantzig(&p, z) : lemke(&p, z);
            assert_int_equal(r.outcome, TALUS_LCP_SOLVED);
            NEAR(r.residual, 0.0, 1e-5);
            for (int box = 0; box < boxes; box++) {
                double sum = 0.0;
                for (int c = 0; c < 4; c++) {
                    sum += (double)z[4 * box + c];
                }
                NEAR(sum, 2.0 * 9.81 / 60.0 * (boxes - box), 1e-3 * (boxes - box));
            }
        }
    }
}

/* On a slope that is less steep than friction holds nothing moves; on a steeper one all slides down at h g (sin - mu
 * cos), two boxes as one: w of the lowest friction rows, and 0 between the boxes. */
static void slopes(void **state) {
    (void)state;
    for (int boxes = 1; boxes <= 2; boxes++) {
        for (int steep = 0; steep < 2; steep++) {
            problem p;
            const double mu = 0.3, angle = atan(mu) * (steep ? 1.5 : 0.9);
            stack_rows(&p, boxes, 1, mu, angle);
            for (int method = 0; method < 2; method++) {
                float z[MOST] = {0.0f};
                talus_lcp_result r;
                if (method == 0) {
                    r = pgs(&p, 100000, 1e-6, z);
                } else {
                    OK(talus_lcp_dantzig(&p.lcp, 20000, 1e-6, z, memory, memory_bytes, &r));
                }
                assert_int_equal(r.outcome, TALUS_LCP_SOLVED);
                NEAR(r.residual, 0.0, 1e-6);
                double slip = 0.0, weight = 0.0, held = 0.0;
                for (uint32_t k = 0; k < p.lcp.count; k++) {
                    slip += (double)p.a[2 * p.lcp.count + k] * (double)z[k];
                }
                slip += (double)p.b[2];
                weight = (double)z[0] + (double)z[1], held = (double)z[2] + (double)z[3];
                NEAR(weight, boxes * 2.0 * 9.81 / 60.0 * cos(angle), 1e-4);
                NEAR(slip, steep ? 9.81 / 60.0 * (sin(angle) - mu * cos(angle)) : 0.0, 1e-5);
                NEAR(held, steep ? -mu * weight : -boxes * 2.0 * 9.81 / 60.0 * sin(angle), 1e-4);
            }
        }
    }
}

#define ANSWERS(status, call)                                                                                          \
    do {                                                                                                               \
        z[0] = 7.0f;                                                                                                   \
        assert_int_equal((call), (status));                                                                            \
        assert_true(z[0] == 7.0f);                                                                                     \
    } while (0)

static void refuses(void **state) {
    (void)state;
    problem p, bad;
    float z[MOST] = {0.0f};
    talus_lcp_result r;
    uint32_t seed = 3;
    size_t bytes = talus_lcp_memory(TALUS_LCP_DANTZIG, 4);
    begin(&p, 4);
    draw_matrix(&p, 4, &seed);
    draw_bounds(&p, PLAIN, &seed);
    assert_int_equal(talus_lcp_memory(TALUS_LCP_PGS, 0), 0);
    assert_int_equal(talus_lcp_memory(TALUS_LCP_PGS, TALUS_LCP_MAX_COUNT + 1u), 0);
    assert_int_equal(talus_lcp_memory(TALUS_LCP_METHOD_COUNT, 4), 0);
    ANSWERS(TALUS_SMALL_BLOCK, talus_lcp_dantzig(&p.lcp, 0, 0.0, z, memory, bytes - 1u, &r));
    ANSWERS(TALUS_UNALIGNED, talus_lcp_dantzig(&p.lcp, 0, 0.0, z, (char *)memory + 1, bytes, &r));
    ANSWERS(TALUS_BAD_ARGUMENT, talus_lcp_dantzig(NULL, 0, 0.0, z, memory, bytes, &r));
    ANSWERS(TALUS_BAD_ARGUMENT, talus_lcp_dantzig(&p.lcp, 0, -1.0, z, memory, bytes, &r));
    ANSWERS(TALUS_BAD_ARGUMENT, talus_lcp_dantzig(&p.lcp, 0, 0.0, z, NULL, bytes, &r));
    for (int k = 0; k < 7; k++) {
        bad = p;
        bad.lcp.a = bad.a, bad.lcp.b = bad.b, bad.lcp.lo = bad.lo, bad.lcp.hi = bad.hi, bad.lcp.normal = bad.normal;
        memset(bad.normal, 0xff, sizeof bad.normal);
        bad.a[5] = k == 0 ? NAN : bad.a[5];
        bad.b[2] = k == 1 ? INFINITY : bad.b[2];
        bad.lo[1] = k == 2 ? NAN : bad.lo[1];
        bad.lo[2] = k == 3 ? 1.0f : k == 4 ? INFINITY : bad.lo[2];
        bad.hi[2] = k == 3 ? 0.5f : bad.hi[2];
        bad.normal[1] = k == 5 ? 1u : k == 6 ? 0u : bad.normal[1]; /* of itself; with a coefficient that is infinite */
        talus_status wanted = k < 3 || k == 6 ? TALUS_NOT_FINITE : TALUS_BAD_ARGUMENT;
        ANSWERS(wanted, talus_lcp_dantzig(&bad.lcp, 0, 0.0, z, memory, memory_bytes, &r));
        ANSWERS(wanted, talus_lcp_lemke(&bad.lcp, 0, z, memory, memory_bytes, &r));
        ANSWERS(wanted, talus_lcp_pgs(&bad.lcp, 0, 1.0, z, memory, memory_bytes, &r));
    }
    bad.hi[1] = 0.5f; /* friction is not for Lemke */
    ANSWERS(TALUS_BAD_ARGUMENT, talus_lcp_lemke(&bad.lcp, 0, z, memory, memory_bytes, &r));
    bad.a[0] = 0.0f; /* nor an empty diagonal for PGS */
    ANSWERS(TALUS_BAD_ARGUMENT, talus_lcp_pgs(&bad.lcp, 0, 1.0, z, memory, memory_bytes, &r));
    /* a ray, and a limit */
    begin(&p, 1);
    p.b[0] = -1.0f, p.hi[0] = INFINITY;
    z[0] = 7.0f;
    assert_int_equal(dantzig(&p, z).outcome, TALUS_LCP_RAY);
    assert_int_equal(lemke(&p, z).outcome, TALUS_LCP_RAY);
    assert_true(z[0] == 7.0f);
    begin(&p, 12);
    draw_matrix(&p, 12, &seed);
    draw_bounds(&p, PLAIN, &seed);
    for (uint32_t i = 0; i < 12; i++) {
        p.b[i] = -1.0f;
    }
    OK(talus_lcp_lemke(&p.lcp, 2, z, memory, memory_bytes, &r));
    assert_int_equal(r.outcome, TALUS_LCP_LIMIT);
    OK(talus_lcp_dantzig(&p.lcp, 2, 0.0, z, memory, memory_bytes, &r));
    assert_int_equal(r.outcome, TALUS_LCP_LIMIT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_sets), cmocka_unit_test(agree),  cmocka_unit_test(degenerate),
        cmocka_unit_test(stacks),   cmocka_unit_test(slopes), cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
