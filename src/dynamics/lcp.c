/* Linear complementarity problems: whether they are sound, how much memory they take, how well they are solved. */
#include "dynamics/lcp.h"

static int is_finite(float x) { return x - x == 0.0f; }
static int is_nan(float x) { return !(x == x); }

static talus_status check_row(const talus_lcp *p, uint32_t i) {
    if (tl_lcp_is_friction(p, i)) {
        uint32_t n = p->normal[i];
        if (n >= p->count || tl_lcp_is_friction(p, n) || !(p->lo[n] >= 0.0f)) {
            return TALUS_BAD_ARGUMENT;
        }
        return !is_finite(p->hi[i]) ? TALUS_NOT_FINITE : p->hi[i] >= 0.0f ? TALUS_OK : TALUS_BAD_ARGUMENT;
    }
    if (is_nan(p->lo[i]) || is_nan(p->hi[i])) {
        return TALUS_NOT_FINITE;
    }
    int ends = is_finite(p->lo[i]) || p->lo[i] < 0.0f, begins = is_finite(p->hi[i]) || p->hi[i] > 0.0f;
    return ends && begins && p->lo[i] <= p->hi[i] ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

talus_status tl_lcp_check(const talus_lcp *p) {
    if (!p || !p->a || !p->b || !p->lo || !p->hi || p->count < 1u || p->count > TALUS_LCP_MAX_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    for (size_t i = 0; i < (size_t)p->count * p->count; i++) {
        if (!is_finite(p->a[i])) {
            return TALUS_NOT_FINITE;
        }
    }
    for (uint32_t i = 0; i < p->count; i++) {
        talus_status status = is_finite(p->b[i]) ? check_row(p, i) : TALUS_NOT_FINITE;
        if (status != TALUS_OK) {
            return status;
        }
    }
    return TALUS_OK;
}

talus_status tl_lcp_check_call(const talus_lcp *p, talus_lcp_method method, const float *z, const void *memory,
                               size_t bytes, const talus_lcp_result *result) {
    if (!z || !memory || !result) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = tl_lcp_check(p);
    if (status != TALUS_OK) {
        return status;
    }
    if ((uintptr_t)memory % sizeof(double)) {
        return TALUS_UNALIGNED;
    }
    return bytes < talus_lcp_memory(method, p->count) ? TALUS_SMALL_BLOCK : TALUS_OK;
}

size_t talus_lcp_memory(talus_lcp_method method, uint32_t count) {
    size_t n = count, most = 2u * n;
    if (count < 1u || count > TALUS_LCP_MAX_COUNT) {
        return 0;
    }
    switch (method) {
    case TALUS_LCP_PGS:
        return n * sizeof(double);
    case TALUS_LCP_DANTZIG: /* L, nine vectors, two lists of numbers */
        return (n * n + 9u * n) * sizeof(double) + (2u * n + 1u) / 2u * 2u * sizeof(uint32_t);
    case TALUS_LCP_LEMKE: /* the tableau, what stands for its rows and columns */
        return (most * (most + 2u)) * sizeof(double) + (2u * most + 2u) * sizeof(uint32_t);
    default:
        return 0;
    }
}

void tl_lcp_bounds(const talus_lcp *p, uint32_t i, double normal, double *lo, double *hi) {
    if (tl_lcp_is_friction(p, i)) {
        *hi = (double)p->hi[i] * tl_d_max(normal, 0.0);
        *lo = -*hi;
        return;
    }
    *lo = is_finite(p->lo[i]) ? (double)p->lo[i] : -TL_LCP_INFINITY;
    *hi = is_finite(p->hi[i]) ? (double)p->hi[i] : TL_LCP_INFINITY;
}

double tl_lcp_row_residual(double w, double z, double lo, double hi, double diagonal) {
    double outside = tl_d_max(tl_d_max(lo - z, z - hi), 0.0) * tl_d_max(diagonal, 1.0);
    double room = w > 0.0 ? z - lo : hi - z, size = tl_d_abs(w);
    if (diagonal > 0.0) {
        size = tl_d_min(size, diagonal * tl_d_max(room, 0.0));
    } else if (!(room > 0.0)) {
        size = 0.0;
    }
    return tl_d_max(size, outside);
}

double tl_lcp_residual_of(const talus_lcp *p, const float *z) {
    double worst = 0.0;
    for (uint32_t i = 0; i < p->count; i++) {
        const float *row = p->a + (size_t)i * p->count;
        double w = (double)p->b[i], lo, hi;
        for (uint32_t k = 0; k < p->count; k++) {
            w += (double)row[k] * (double)z[k];
        }
        tl_lcp_bounds(p, i, tl_lcp_is_friction(p, i) ? (double)z[p->normal[i]] : 0.0, &lo, &hi);
        worst = tl_d_max(worst, tl_lcp_row_residual(w, (double)z[i], lo, hi, (double)row[i]));
    }
    return worst;
}

talus_status talus_lcp_residual(const talus_lcp *problem, const float *z, double *residual) {
    talus_status status = z && residual ? tl_lcp_check(problem) : TALUS_BAD_ARGUMENT;
    for (uint32_t i = 0; status == TALUS_OK && i < problem->count; i++) {
        status = is_finite(z[i]) ? TALUS_OK : TALUS_NOT_FINITE;
    }
    if (status == TALUS_OK) {
        *residual = tl_lcp_residual_of(problem, z);
    }
    return status;
}
