/* Lemke's method (Cottle, Pang and Stone, The Linear Complementarity Problem, 4.4) on a dictionary: every basic
 * variable as a constant and a sum over the nonbasic ones. Rows with bounds become pairs w, z >= 0:
 *
 *   lo <= z         y = z - lo
 *   z <= hi         y = hi - z, and w with the other sign
 *   lo <= z <= hi   y = z - lo, and a second row: hi - lo - y beside its multiplier, which is added to w
 *   no bound        z = y - y', and a second row: -w beside y'
 *
 * Ties are broken as if the constants had been moved by powers of a tiny number (lexicographic rule), so that no basis
 * comes twice. */
#include "dynamics/lcp.h"

/* Of the matrix' largest entry: smaller ones are no pivots. */
#define NO_PIVOT 1e-9
#define SAME 1e-9

enum { FROM_LOW, FROM_HIGH, BOXED, UNBOUNDED };

typedef struct lemke {
    const talus_lcp *p;
    uint32_t n, rows; /* of the problem; with the second ones */
    double *table;    /* rows x (rows + 2): columns of the nonbasic variables, then the constant */
    double least;
    uint32_t *basic, *other; /* which variable: w of row i is i, y is rows + i, the artificial one 2 rows */
} lemke;

static double *cell(const lemke *s, uint32_t row, uint32_t column) {
    return &s->table[(size_t)row * (s->rows + 2u) + column];
}
static double *constant(const lemke *s, uint32_t row) { return cell(s, row, s->rows + 1u); }

static int kind_of(const talus_lcp *p, uint32_t i, double *lo, double *hi) {
    tl_lcp_bounds(p, i, 0.0, lo, hi);
    int low = *lo > -TL_LCP_INFINITY, high = *hi < TL_LCP_INFINITY;
    return low ? (high ? BOXED : FROM_LOW) : (high ? FROM_HIGH : UNBOUNDED);
}

/* z = base + sign y (- y'). */
static double base_of(const talus_lcp *p, uint32_t i, double *sign) {
    double lo, hi;
    int kind = kind_of(p, i, &lo, &hi);
    *sign = kind == FROM_HIGH ? -1.0 : 1.0;
    return kind == UNBOUNDED ? 0.0 : kind == FROM_HIGH ? hi : lo;
}

static void fill_rows(lemke *s) {
    const talus_lcp *p = s->p;
    double most = 0.0, lo, hi;
    for (uint32_t i = 0; i < s->rows; i++) {
        for (uint32_t k = 0; k < s->rows + 2u; k++) {
            *cell(s, i, k) = k == s->rows ? 1.0 : 0.0;
        }
    }
    for (uint32_t i = 0; i < s->n; i++) {
        const float *row = p->a + (size_t)i * s->n;
        double sign, other, sum = (double)p->b[i];
        base_of(p, i, &sign);
        for (uint32_t k = 0, second = s->n; k < s->n; k++) {
            double base = base_of(p, k, &other), a = (double)row[k];
            int kind = kind_of(p, k, &lo, &hi);
            *cell(s, i, k) = sign * a * other;
            if (kind == UNBOUNDED) {
                *cell(s, i, second) = -sign * a;
            }
            second += kind == BOXED || kind == UNBOUNDED;
            sum += a * base;
            most = tl_d_max(most, tl_d_abs(a));
        }
        *constant(s, i) = sign * sum;
    }
    for (uint32_t i = 0, second = s->n; i < s->n; i++) {
        int kind = kind_of(p, i, &lo, &hi);
        if (kind == BOXED) {
            *cell(s, i, second) = 1.0;
            *cell(s, second, i) = -1.0;
            *constant(s, second) = hi - lo;
            most = tl_d_max(most, 1.0);
        } else if (kind == UNBOUNDED) {
            for (uint32_t k = 0; k < s->rows; k++) {
                *cell(s, second, k) = -*cell(s, i, k);
            }
            *constant(s, second) = -*constant(s, i);
        }
        second += kind == BOXED || kind == UNBOUNDED;
    }
    s->least = NO_PIVOT * most;
    for (uint32_t i = 0; i <= s->rows; i++) {
        s->other[i] = i < s->rows ? s->rows + i : 2u * s->rows;
        if (i < s->rows) {
            s->basic[i] = i;
        }
    }
}

/* How the constant of a row answers to that of w k at the start: the entry of the inverse of the basis. */
static double inverse_entry(const lemke *s, uint32_t row, uint32_t k) {
    for (uint32_t c = 0; c <= s->rows; c++) {
        if (s->other[c] == k) {
            return -*cell(s, row, c);
        }
    }
    return s->basic[row] == k ? 1.0 : 0.0;
}

/* Whether row a, by its pivot, comes before row b: by the constants first, then by the inverse, column by column. */
static int comes_first(const lemke *s, uint32_t a, uint32_t b, double pivot_a, double pivot_b) {
    double x = *constant(s, a) / pivot_a, y = *constant(s, b) / pivot_b;
    for (uint32_t k = 0; k <= s->rows; k++) {
        if (tl_d_abs(x - y) > SAME * (tl_d_abs(x) + tl_d_abs(y))) {
            return x < y;
        }
        if (k == 0 && (s->basic[a] == 2u * s->rows || s->basic[b] == 2u * s->rows)) {
            return s->basic[a] == 2u * s->rows;
        }
        if (k < s->rows) {
            x = inverse_entry(s, a, k) / pivot_a, y = inverse_entry(s, b, k) / pivot_b;
        }
    }
    return 0;
}

/* The nonbasic variable of a column and the basic one of a row change places. Returns the one that left. */
static uint32_t pivot(lemke *s, uint32_t row, uint32_t column) {
    double inverse = 1.0 / *cell(s, row, column);
    *cell(s, row, column) = -1.0;
    for (uint32_t k = 0; k < s->rows + 2u; k++) {
        *cell(s, row, k) *= -inverse;
    }
    for (uint32_t r = 0; r < s->rows; r++) {
        double share = *cell(s, r, column);
        if (r == row || share == 0.0) {
            continue;
        }
        *cell(s, r, column) = 0.0;
        for (uint32_t k = 0; k < s->rows + 2u; k++) {
            *cell(s, r, k) += share * *cell(s, row, k);
        }
    }
    uint32_t left = s->basic[row];
    s->basic[row] = s->other[column];
    s->other[column] = left;
    return left;
}

/* The artificial variable comes in for the most negative constant. Returns the variable that left, or none if there is
 * nothing to do. */
static uint32_t first_pivot(lemke *s) {
    uint32_t row = 0;
    for (uint32_t r = 1; r < s->rows; r++) {
        row = *constant(s, r) <= *constant(s, row) ? r : row;
    }
    return *constant(s, row) >= 0.0 ? 2u * s->rows : pivot(s, row, s->rows);
}

static talus_lcp_outcome run(lemke *s, uint32_t limit, uint32_t *steps) {
    uint32_t artificial = 2u * s->rows, left = first_pivot(s);
    for (*steps = left != artificial; left != artificial; ++*steps) {
        uint32_t enters = left < s->rows ? left + s->rows : left - s->rows, column = 0, row = s->rows;
        if (*steps >= limit) {
            return TALUS_LCP_LIMIT;
        }
        while (s->other[column] != enters) {
            column++;
        }
        for (uint32_t r = 0; r < s->rows; r++) {
            double p = -*cell(s, r, column);
            if (p > s->least && (row == s->rows || comes_first(s, r, row, p, -*cell(s, row, column)))) {
                row = r;
            }
        }
        if (row == s->rows) {
            return TALUS_LCP_RAY;
        }
        left = pivot(s, row, column);
    }
    return TALUS_LCP_SOLVED;
}

/* The value of y of a row of the enlarged problem. */
static double value_of(const lemke *s, uint32_t i) {
    for (uint32_t r = 0; r < s->rows; r++) {
        if (s->basic[r] == s->rows + i) {
            return tl_d_max(*constant(s, r), 0.0);
        }
    }
    return 0.0;
}

talus_status talus_lcp_lemke(const talus_lcp *problem, uint32_t limit, float *z, void *memory, size_t bytes,
                             talus_lcp_result *result) {
    talus_status status = tl_lcp_check_call(problem, TALUS_LCP_LEMKE, z, memory, bytes, result);
    if (status != TALUS_OK) {
        return status;
    }
    lemke s;
    double lo, hi, sign;
    s.p = problem;
    s.n = s.rows = problem->count;
    for (uint32_t i = 0; i < s.n; i++) {
        if (tl_lcp_is_friction(problem, i)) {
            return TALUS_BAD_ARGUMENT;
        }
        int kind = kind_of(problem, i, &lo, &hi);
        s.rows += kind == BOXED || kind == UNBOUNDED;
    }
    s.table = memory;
    s.basic = (uint32_t *)(void *)(s.table + (size_t)s.rows * (s.rows + 2u));
    s.other = s.basic + s.rows;
    fill_rows(&s);
    result->outcome = run(&s, limit ? limit : 50u * s.rows, &result->steps);
    result->residual = TL_LCP_INFINITY;
    if (result->outcome != TALUS_LCP_SOLVED) {
        return TALUS_OK;
    }
    for (uint32_t i = 0, second = s.n; i < s.n; i++) {
        int kind = kind_of(problem, i, &lo, &hi);
        double base = base_of(problem, i, &sign), x = base + sign * value_of(&s, i);
        if (kind == UNBOUNDED) {
            x -= value_of(&s, second);
        }
        second += kind == BOXED || kind == UNBOUNDED;
        z[i] = (float)tl_d_max(tl_d_min(x, hi), lo);
    }
    result->residual = tl_lcp_residual_of(problem, z);
    return TALUS_OK;
}
