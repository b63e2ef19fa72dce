/* Dantzig's principal pivoting for symmetric positive semidefinite matrices, after Baraff, "Fast contact force
 * computation for nonpenetrating rigid bodies", SIGGRAPH 1994: row after row is driven until its condition holds, while
 * those before it keep theirs. Rows whose w is kept at 0 are clamped (C); the others lie at a bound.
 *
 * Bounds that follow normals: with those of the last solution all is solved again, until the residual says that it is
 * done. */
#include "dynamics/lcp.h"

#include <string.h>

/* Of a row's size: below it a number counts as 0, for that is as well as floats know it. */
#define NOTHING 4e-7

/* Repetitions after which the normals that bounds follow are averaged with those before. */
#define PLAIN_REPEATS 8u

enum { WAITING, CLAMPED, AT_LOW, AT_HIGH };

typedef struct dantzig {
    const talus_lcp *p;
    uint32_t n, clamped, steps, limit;
    double *factor; /* L of A_CC = L D L^T, rows of n */
    double *d;
    double *z, *w, *lo, *hi;
    double *dz, *dw; /* while a row is driven */
    double *spare, *normal;
    uint32_t *list, *state; /* the clamped rows in the order of the factor; what each row is */
} dantzig;

static double entry(const dantzig *s, uint32_t i, uint32_t k) {
    return (double)s->p->a[i > k ? (size_t)i * s->n + k : (size_t)k * s->n + i];
}

/* A row joins the clamped ones: its row of L, and its D, which is kept off 0. */
static void clamp_row(dantzig *s, uint32_t i) {
    uint32_t m = s->clamped++;
    double *row = s->factor + (size_t)m * s->n, own = entry(s, i, i), d = own;
    for (uint32_t j = 0; j < m; j++) {
        const double *other = s->factor + (size_t)j * s->n;
        double y = entry(s, i, s->list[j]);
        for (uint32_t k = 0; k < j; k++) {
            y -= other[k] * s->spare[k];
        }
        s->spare[j] = y;
    }
    for (uint32_t j = 0; j < m; j++) {
        row[j] = s->spare[j] / s->d[j];
        d -= row[j] * s->spare[j];
    }
    s->d[m] = tl_d_max(d, tl_d_max(NOTHING * own, 1e-290));
    s->list[m] = i;
    s->state[i] = CLAMPED;
}

/* The row at place `at` of the factor leaves it: what it held of the rows after it is added to theirs (Gill, Golub,
 * Murray and Saunders, "Methods for modifying matrix factorizations", 1974, method C1). */
static void release_row(dantzig *s, uint32_t at, uint32_t state) {
    uint32_t m = s->clamped, n = s->n;
    double share = s->d[at];
    for (uint32_t r = at + 1u; r < m; r++) {
        s->spare[r] = s->factor[(size_t)r * n + at];
    }
    for (uint32_t j = at + 1u; j < m; j++) {
        double v = s->spare[j], old = s->d[j];
        s->d[j] = old + share * v * v;
        double beta = share * v / s->d[j];
        share *= old / s->d[j];
        for (uint32_t r = j + 1u; r < m; r++) {
            double *l = &s->factor[(size_t)r * n + j];
            s->spare[r] -= v * *l;
            *l += beta * s->spare[r];
        }
    }
    s->state[s->list[at]] = state;
    for (uint32_t r = at + 1u; r < m; r++) {
        double *to = s->factor + (size_t)(r - 1u) * n;
        const double *from = s->factor + (size_t)r * n;
        memmove(to, from, at * sizeof *to);
        memmove(to + at, from + at + 1u, (r - 1u - at) * sizeof *to);
        s->d[r - 1u] = s->d[r];
        s->list[r - 1u] = s->list[r];
    }
    s->clamped--;
}

/* x, in the order of the factor, becomes A_CC^-1 x. */
static void solve_clamped(const dantzig *s, double *x) {
    for (uint32_t j = 0; j < s->clamped; j++) {
        const double *row = s->factor + (size_t)j * s->n;
        for (uint32_t k = 0; k < j; k++) {
            x[j] -= row[k] * x[k];
        }
    }
    for (uint32_t j = 0; j < s->clamped; j++) {
        x[j] /= s->d[j];
    }
    for (uint32_t j = s->clamped; j-- > 0;) {
        const double *row = s->factor + (size_t)j * s->n;
        for (uint32_t k = 0; k < j; k++) {
            x[k] -= row[k] * x[j];
        }
    }
}

/* w of a row, and how large the numbers are that it is made of. */
static double row_w(const dantzig *s, uint32_t i, double *size) {
    double w = (double)s->p->b[i];
    *size = tl_d_abs(w);
    for (uint32_t k = 0; k < s->n; k++) {
        double term = entry(s, i, k) * s->z[k];
        w += term;
        *size += tl_d_abs(term);
    }
    return w;
}

/* How all else changes when z of row i grows by `way`: dz of the clamped ones (in their order), dw of the others. */
static void rates(dantzig *s, uint32_t i, double way) {
    for (uint32_t j = 0; j < s->clamped; j++) {
        s->dz[j] = -way * entry(s, s->list[j], i);
    }
    solve_clamped(s, s->dz);
    for (uint32_t r = 0; r < s->n; r++) {
        if (r != i && s->state[r] != AT_LOW && s->state[r] != AT_HIGH) {
            continue;
        }
        double rate = way * entry(s, r, i), size = tl_d_abs(rate);
        for (uint32_t j = 0; j < s->clamped; j++) {
            double term = entry(s, r, s->list[j]) * s->dz[j];
            rate += term;
            size += tl_d_abs(term);
        }
        s->dw[r] = tl_d_abs(rate) > NOTHING * size ? rate : 0.0;
    }
}

/* What stops row i first on its way: i itself (its w is 0, or it is at its bound), a clamped row that comes to a bound,
 * or one at a bound whose w comes to 0. Of those that stop it at once row i itself, so that nothing joins that depends
 * on it, else the first in order, so that it ends. */
typedef struct stop {
    double way;
    uint32_t row, place; /* place: in the factor, of a clamped row; AT_BOUND, of row i */
} stop;

#define AT_BOUND 0xffffffffu

static void nearer(stop *best, double way, uint32_t row, uint32_t place) {
    way = tl_d_max(way, 0.0);
    if (way < best->way || (way == best->way && row < best->row)) {
        best->way = way, best->row = row, best->place = place;
    }
}

static stop find_stop(const dantzig *s, uint32_t i, double way) {
    stop best = {TL_LCP_INFINITY, s->n, 0}, own = best;
    if (s->w[i] * s->dw[i] < 0.0) {
        nearer(&own, -s->w[i] / s->dw[i], i, 0);
    }
    double room = way > 0.0 ? s->hi[i] - s->z[i] : s->z[i] - s->lo[i];
    if (room < 0.5 * TL_LCP_INFINITY) {
        nearer(&own, room, i, AT_BOUND);
    }
    for (uint32_t j = 0; j < s->clamped; j++) {
        uint32_t r = s->list[j];
        double left = s->dz[j] > 0.0 ? s->hi[r] - s->z[r] : s->z[r] - s->lo[r];
        if (s->dz[j] != 0.0 && left < 0.5 * TL_LCP_INFINITY) {
            nearer(&best, left / tl_d_abs(s->dz[j]), r, j);
        }
    }
    for (uint32_t r = 0; r < s->n; r++) {
        int falls = s->state[r] == AT_LOW && s->dw[r] < 0.0, rises = s->state[r] == AT_HIGH && s->dw[r] > 0.0;
        if (r != i && (falls || rises) && s->lo[r] < s->hi[r]) {
            nearer(&best, -s->w[r] / s->dw[r], r, 0);
        }
    }
    return own.way <= best.way * (1.0 + NOTHING) ? own : best;
}

static void advance(dantzig *s, uint32_t i, double way, const stop *to) {
    s->z[i] += way * to->way;
    for (uint32_t j = 0; j < s->clamped; j++) {
        s->z[s->list[j]] += s->dz[j] * to->way;
    }
    for (uint32_t r = 0; r < s->n; r++) {
        if (r == i || s->state[r] == AT_LOW || s->state[r] == AT_HIGH) {
            s->w[r] += s->dw[r] * to->way;
        }
    }
}

static talus_lcp_outcome drive(dantzig *s, uint32_t i) {
    double size;
    s->w[i] = row_w(s, i, &size);
    double nothing = NOTHING * size, way = s->w[i] < 0.0 ? 1.0 : -1.0;
    if (s->lo[i] == s->hi[i] || (s->z[i] == s->lo[i] && s->w[i] >= -nothing)) {
        s->state[i] = AT_LOW;
        return TALUS_LCP_SOLVED;
    }
    if (s->z[i] == s->hi[i] && s->w[i] <= nothing) {
        s->state[i] = AT_HIGH;
        return TALUS_LCP_SOLVED;
    }
    if (tl_d_abs(s->w[i]) <= nothing) {
        clamp_row(s, i);
        return TALUS_LCP_SOLVED;
    }
    while (s->steps < s->limit) {
        s->steps++;
        rates(s, i, way);
        stop to = find_stop(s, i, way);
        if (to.row == s->n) {
            return TALUS_LCP_RAY;
        }
        advance(s, i, way, &to);
        if (to.row == i) {
            if (to.place == AT_BOUND) {
                s->z[i] = way > 0.0 ? s->hi[i] : s->lo[i];
                s->state[i] = way > 0.0 ? AT_HIGH : AT_LOW;
            } else {
                clamp_row(s, i);
            }
            return TALUS_LCP_SOLVED;
        }
        if (s->state[to.row] == CLAMPED) {
            int high = s->dz[to.place] > 0.0;
            s->z[to.row] = high ? s->hi[to.row] : s->lo[to.row];
            s->w[to.row] = 0.0;
            release_row(s, to.place, high ? AT_HIGH : AT_LOW);
        } else {
            clamp_row(s, to.row);
        }
    }
    return TALUS_LCP_LIMIT;
}

/* Once more for the clamped rows, with what is left of their w. */
static void refine(dantzig *s) {
    double size;
    for (uint32_t j = 0; j < s->clamped; j++) {
        s->dz[j] = -row_w(s, s->list[j], &size);
    }
    solve_clamped(s, s->dz);
    for (uint32_t j = 0; j < s->clamped; j++) {
        uint32_t r = s->list[j];
        s->z[r] = tl_d_max(tl_d_min(s->z[r] + s->dz[j], s->hi[r]), s->lo[r]);
    }
}

/* With bounds that follow s->normal. */
static talus_lcp_outcome solve_once(dantzig *s) {
    talus_lcp_outcome outcome = TALUS_LCP_SOLVED;
    s->clamped = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        double normal = tl_lcp_is_friction(s->p, i) ? s->normal[s->p->normal[i]] : 0.0;
        tl_lcp_bounds(s->p, i, normal, &s->lo[i], &s->hi[i]);
        s->z[i] = tl_d_max(tl_d_min(0.0, s->hi[i]), s->lo[i]);
        s->state[i] = WAITING;
    }
    for (uint32_t i = 0; i < s->n && outcome == TALUS_LCP_SOLVED; i++) {
        outcome = drive(s, i);
    }
    if (outcome == TALUS_LCP_SOLVED) {
        refine(s);
    }
    return outcome;
}

static void lay_out(dantzig *s, const talus_lcp *p, void *memory) {
    uint32_t n = p->count;
    double *at = memory, **vectors[] = {&s->d, &s->z, &s->w, &s->lo, &s->hi, &s->dz, &s->dw, &s->spare, &s->normal};
    s->p = p, s->n = n;
    s->factor = at;
    at += (size_t)n * n;
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++, at += n) {
        *vectors[k] = at;
    }
    s->list = (uint32_t *)(void *)at;
    s->state = s->list + n;
}

talus_status talus_lcp_dantzig(const talus_lcp *problem, uint32_t limit, double tolerance, float *z, void *memory,
                               size_t bytes, talus_lcp_result *result) {
    talus_status status = tl_lcp_check_call(problem, TALUS_LCP_DANTZIG, z, memory, bytes, result);
    if (status != TALUS_OK || !(tolerance >= 0.0)) {
        return status != TALUS_OK ? status : TALUS_BAD_ARGUMENT;
    }
    dantzig s;
    lay_out(&s, problem, memory);
    s.steps = 0;
    s.limit = limit ? limit : 50u * s.n;
    int friction = 0;
    for (uint32_t i = 0; i < s.n; i++) {
        friction |= tl_lcp_is_friction(problem, i);
        s.normal[i] = 0.0;
    }
    for (uint32_t repeat = 0;; repeat++) {
        result->outcome = solve_once(&s);
        result->steps = s.steps;
        if (result->outcome == TALUS_LCP_RAY) {
            break;
        }
        for (uint32_t i = 0; i < s.n; i++) {
            z[i] = (float)s.z[i];
            s.normal[i] = repeat < PLAIN_REPEATS ? s.z[i] : 0.5 * (s.normal[i] + s.z[i]);
        }
        result->residual = tl_lcp_residual_of(problem, z);
        if (result->outcome == TALUS_LCP_LIMIT || !friction || result->residual <= tolerance) {
            break;
        }
        if (s.steps >= s.limit) {
            result->outcome = TALUS_LCP_LIMIT;
            break;
        }
    }
    if (result->outcome == TALUS_LCP_RAY) {
        result->residual = TL_LCP_INFINITY;
    }
    return TALUS_OK;
}
