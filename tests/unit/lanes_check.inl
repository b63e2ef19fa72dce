/* The checks themselves. Included once an instruction set, after TL_LANES_... and LANES_CHECK (the name of the function
 * to make) are defined. The reference is plain C on arrays of eight. */
#include "base/trig_lanes.h"
#include "simd/lanes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#if defined(__GNUC__)
#define ALIGNED32 __attribute__((aligned(32)))
#else
#define ALIGNED32 __declspec(align(32))
#endif

enum { ROUNDS = 4000, ROWS = 24 };

struct check {
    uint32_t random;
    uint64_t digest;
    int failures;
};

static uint32_t bits(float x) {
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

static int is_nan(uint32_t u) { return (u & 0x7fffffffu) > 0x7f800000u; }

/* Marsaglia, "Xorshift RNGs", 2003 */
static uint32_t draw(struct check *c) {
    uint32_t x = c->random;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return c->random = x;
}

/* Any bits; now and then a value at the edge of some rule; half of the time an everyday number. */
static uint32_t draw_float_bits(struct check *c) {
    static const uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x807fffff, 0x00800000,
                                     0x80800000, 0x3f800000, 0xbf800000, 0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000,
                                     0x7fc00000, 0xffc00000, 0x7f800001, 0xffa55aa5, 0x4b000000, 0x4b7fffff, 0x3effffff,
                                     0x3f000000, 0x44800000, 0x44800001, 0x3f490fdb, 0x40490fdb, 0xc0490fdb};
    uint32_t kind = draw(c) % 8, u = draw(c);
    if (kind == 0) {
        return u;
    }
    if (kind < 4) {
        return edges[u % (sizeof edges / sizeof edges[0])];
    }
    if (kind == 4) {
        return bits((float)(int32_t)(u % 17) - 8.0f); /* equal values are likely */
    }
    return (u & 0x80ffffffu) + 0x3e000000u + (kind & 1u) * 0x01000000u; /* 2^-3 to 2^3 */
}

static uint32_t draw_int_bits(struct check *c) {
    static const uint32_t edges[] = {0, 1, 2, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff, 0xfffffffe};
    uint32_t u = draw(c);
    return draw(c) % 3 ? u : edges[u % 8];
}

static void fail(struct check *c, const char *what, int lane, uint32_t got, uint32_t want) {
    if (c->failures < 40) {
        printf("%s %s lane %d: got %08lx, want %08lx\n", TL_LANES_NAME, what, lane, (unsigned long)got,
               (unsigned long)want);
    }
    c->failures++;
}

static void fold(struct check *c, uint32_t u) {
    c->digest = (c->digest ^ u) * 0x100000001b3u; /* FNV-1a, 32 at a time */
}

enum { EXACT, NAN_IS_NAN };

static void same(struct check *c, const char *what, const uint32_t *got, const uint32_t *want, int how) {
    for (int i = 0; i < 8; i++) {
        int both_nan = how == NAN_IS_NAN && is_nan(got[i]) && is_nan(want[i]);
        if (got[i] != want[i] && !both_nan) {
            fail(c, what, i, got[i], want[i]);
        }
        fold(c, both_nan ? 0x7fc00000u : got[i]);
    }
}

static void same_f(struct check *c, const char *what, tl_f8 got, const uint32_t *want, int how) {
    float v[8];
    uint32_t u[8];
    tl_f8_storeu(v, got);
    memcpy(u, v, sizeof u);
    same(c, what, u, want, how);
}

static void same_i(struct check *c, const char *what, tl_i8 got, const uint32_t *want) {
    int32_t v[8];
    uint32_t u[8];
    tl_i8_storeu(v, got);
    memcpy(u, v, sizeof u);
    same(c, what, u, want, EXACT);
}

/* A mask must be all ones or all zeros in each lane, and its bits must say so. */
static void same_m(struct check *c, const char *what, tl_m8 got, unsigned want) {
    uint32_t w[8];
    for (int i = 0; i < 8; i++) {
        w[i] = want >> i & 1u ? 0xffffffffu : 0u;
    }
    same_i(c, what, tl_i8_select(got, tl_i8_set1(-1), tl_i8_set1(0)), w);
    same_f(c, what, tl_f8_and_mask(got, tl_f8_of_bits(tl_i8_set1(-1))), w, EXACT);
    if (tl_m8_bits(got) != want || tl_m8_any(got) != (want != 0) || tl_m8_all(got) != (want == 0xffu)) {
        fail(c, what, -1, tl_m8_bits(got), want);
    }
}

struct operands {
    ALIGNED32 float a[8];
    ALIGNED32 float b[8];
    ALIGNED32 float c[8];
    ALIGNED32 int32_t i[8];
    ALIGNED32 int32_t j[8];
    uint32_t ua[8], ub[8], ui[8], uj[8]; /* the bits of a, b, i, j */
    unsigned m, n;
};

static void draw_operands(struct check *c, struct operands *o) {
    uint32_t uc[8];
    for (int k = 0; k < 8; k++) {
        o->ua[k] = draw_float_bits(c);
        o->ub[k] = draw(c) % 8 ? draw_float_bits(c) : o->ua[k];
        uc[k] = draw_float_bits(c);
        o->ui[k] = draw_int_bits(c);
        o->uj[k] = draw(c) % 4 ? draw_int_bits(c) : o->ui[k];
    }
    memcpy(o->a, o->ua, sizeof o->a);
    memcpy(o->b, o->ub, sizeof o->b);
    memcpy(o->c, uc, sizeof o->c);
    memcpy(o->i, o->ui, sizeof o->i);
    memcpy(o->j, o->uj, sizeof o->j);
    o->m = draw(c) % 5 ? draw(c) & 0xffu : draw(c) & 1u ? 0xffu : 0u;
    o->n = draw(c) & 0xffu;
}

/* w[k] = the bits of a float expression in k; m = the bits of a truth in k */
#define EACH(expression)                                                                                               \
    for (int k = 0; k < 8; k++) {                                                                                      \
        w[k] = (expression);                                                                                           \
    }
#define EACH_BIT(expression)                                                                                           \
    m = 0;                                                                                                             \
    for (int k = 0; k < 8; k++) {                                                                                      \
        m |= (unsigned)((expression) ? 1u : 0u) << k;                                                                  \
    }

static void check_arithmetic(struct check *c, const struct operands *o) {
    const float *a = o->a, *b = o->b, *d = o->c;
    tl_f8 x = tl_f8_load(a), y = tl_f8_load(b), z = tl_f8_load(d);
    uint32_t w[8];
    EACH(bits(a[k] + b[k]));
    same_f(c, "add", tl_f8_add(x, y), w, NAN_IS_NAN);
    EACH(bits(a[k] - b[k]));
    same_f(c, "sub", tl_f8_sub(x, y), w, NAN_IS_NAN);
    EACH(bits(a[k] * b[k]));
    same_f(c, "mul", tl_f8_mul(x, y), w, NAN_IS_NAN);
    EACH(bits(a[k] / b[k]));
    same_f(c, "div", tl_f8_div(x, y), w, NAN_IS_NAN);
    EACH(bits(sqrtf(a[k])));
    same_f(c, "sqrt", tl_f8_sqrt(x), w, NAN_IS_NAN);
    EACH(bits(a[k] + (float)((double)b[k] * (double)d[k]))); /* that product is exact: it cannot be fused */
    same_f(c, "mad", tl_f8_mad(x, y, z), w, NAN_IS_NAN);
    EACH(o->ua[k] ^ 0x80000000u);
    same_f(c, "neg", tl_f8_neg(x), w, EXACT);
    EACH(o->ua[k] & 0x7fffffffu);
    same_f(c, "abs", tl_f8_abs(x), w, EXACT);
    EACH(a[k] < b[k] ? o->ua[k] : o->ub[k]);
    same_f(c, "min", tl_f8_min(x, y), w, EXACT);
    EACH(a[k] > b[k] ? o->ua[k] : o->ub[k]);
    same_f(c, "max", tl_f8_max(x, y), w, EXACT);
    float s = ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
    EACH(bits(s));
    same_f(c, "sum", tl_f8_set1(tl_f8_sum(x)), w, NAN_IS_NAN);
    for (int i = 0; i < 8; i++) {
        uint32_t got = bits(tl_f8_lane(x, i));
        if (got != o->ua[i]) {
            fail(c, "lane", i, got, o->ua[i]);
        }
    }
    EACH(0u);
    same_f(c, "zero", tl_f8_zero(), w, EXACT);
    EACH(o->ua[3]);
    same_f(c, "set1", tl_f8_set1(a[3]), w, EXACT);
}

static void check_masks(struct check *c, const struct operands *o) {
    const float *a = o->a, *b = o->b;
    tl_f8 x = tl_f8_load(a), y = tl_f8_load(b);
    tl_m8 p = tl_m8_from_bits(o->m), q = tl_m8_from_bits(o->n);
    uint32_t w[8];
    unsigned m;
    EACH_BIT(a[k] < b[k]);
    same_m(c, "lt", tl_f8_lt(x, y), m);
    EACH_BIT(a[k] <= b[k]);
    same_m(c, "le", tl_f8_le(x, y), m);
    EACH_BIT(a[k] > b[k]);
    same_m(c, "gt", tl_f8_gt(x, y), m);
    EACH_BIT(a[k] >= b[k]);
    same_m(c, "ge", tl_f8_ge(x, y), m);
    EACH_BIT(a[k] == b[k]);
    same_m(c, "eq", tl_f8_eq(x, y), m);
    same_m(c, "from_bits", p, o->m);
    same_m(c, "from_bits beyond eight", tl_m8_from_bits(o->m | 0xabcdef00u), o->m);
    same_m(c, "mask and", tl_m8_and(p, q), o->m & o->n);
    same_m(c, "mask or", tl_m8_or(p, q), o->m | o->n);
    same_m(c, "mask andnot", tl_m8_andnot(p, q), ~o->m & o->n);
    same_m(c, "mask not", tl_m8_not(p), ~o->m & 0xffu);
    same_m(c, "mask zero", tl_m8_zero(), 0);
    EACH(o->m >> k & 1u ? o->ua[k] : o->ub[k]);
    same_f(c, "select", tl_f8_select(p, x, y), w, EXACT);
    EACH(o->m >> k & 1u ? o->ua[k] : 0u);
    same_f(c, "and_mask", tl_f8_and_mask(p, x), w, EXACT);
}

static void check_integers(struct check *c, const struct operands *o) {
    const uint32_t *i = o->ui, *j = o->uj;
    tl_i8 x = tl_i8_load(o->i), y = tl_i8_load(o->j);
    int n = (int)(o->n & 31u);
    uint32_t w[8];
    unsigned m;
    EACH(i[k] + j[k]);
    same_i(c, "int add", tl_i8_add(x, y), w);
    EACH(i[k] - j[k]);
    same_i(c, "int sub", tl_i8_sub(x, y), w);
    EACH(i[k] & j[k]);
    same_i(c, "int and", tl_i8_and(x, y), w);
    EACH(i[k] | j[k]);
    same_i(c, "int or", tl_i8_or(x, y), w);
    EACH(i[k] ^ j[k]);
    same_i(c, "int xor", tl_i8_xor(x, y), w);
    EACH(i[k] << n);
    same_i(c, "shl", tl_i8_shl(x, n), w);
    EACH(i[k] >> n);
    same_i(c, "shr_logical", tl_i8_shr_logical(x, n), w);
    EACH_BIT(i[k] == j[k]);
    same_m(c, "int eq", tl_i8_eq(x, y), m);
    EACH_BIT((i[k] ^ 0x80000000u) > (j[k] ^ 0x80000000u));
    same_m(c, "int gt", tl_i8_gt(x, y), m);
    EACH(o->m >> k & 1u ? i[k] : j[k]);
    same_i(c, "int select", tl_i8_select(tl_m8_from_bits(o->m), x, y), w);
    EACH(i[5]);
    same_i(c, "int set1", tl_i8_set1(o->i[5]), w);
    EACH(bits((float)o->i[k]));
    same_f(c, "from_i8", tl_f8_from_i8(x), w, EXACT);
    same_i(c, "bits_of_f8", tl_i8_bits_of_f8(tl_f8_load(o->a)), o->ua);
    same_f(c, "of_bits", tl_f8_of_bits(x), i, EXACT);
    float t[8];
    for (int k = 0; k < 8; k++) {
        t[k] = o->a[k] > -2147483648.0f && o->a[k] < 2147483648.0f ? o->a[k] : -2147483648.0f;
    }
    EACH((uint32_t)(int32_t)t[k]);
    same_i(c, "from_f8_trunc", tl_i8_from_f8_trunc(tl_f8_loadu(t)), w);
}

static void check_memory(struct check *c, const struct operands *o) {
    ALIGNED32 float f[24];
    ALIGNED32 int32_t n[24];
    uint32_t before[24], after[24];
    for (int k = 0; k < 24; k++) {
        before[k] = draw_float_bits(c);
    }
    for (unsigned shift = 0; shift <= 8; shift++) {
        memcpy(f, before, sizeof f);
        memcpy(n, before, sizeof n);
        if (shift == 8) {
            tl_f8_store(f + 8, tl_f8_load(o->a));
            tl_i8_store(n + 8, tl_i8_load(o->i));
        } else {
            tl_f8_storeu(f + shift, tl_f8_loadu(o->a));
            tl_i8_storeu(n + shift, tl_i8_loadu(o->i));
        }
        for (unsigned k = 0; k < 24; k++) {
            int in = k >= shift && k < shift + 8;
            after[k] = in ? o->ua[k - shift] : before[k];
            if (bits(f[k]) != after[k]) {
                fail(c, "store", (int)k, bits(f[k]), after[k]);
            }
            after[k] = in ? o->ui[k - shift] : before[k];
            if ((uint32_t)n[k] != after[k]) {
                fail(c, "int store", (int)k, (uint32_t)n[k], after[k]);
            }
        }
        same_f(c, "loadu", tl_f8_loadu(f + shift), o->ua, EXACT);
        same_i(c, "int loadu", tl_i8_loadu(n + shift), o->ui);
    }
}

static void check_rows(struct check *c) {
    enum { STRIDE = 11 };
    ALIGNED32 float base[8 * ROWS];
    ALIGNED32 float out[8 * ROWS];
    float loose[STRIDE * ROWS];
    uint32_t u[STRIDE * ROWS], want[8 * ROWS], index[8], w[8];
    tl_f8 r[8];
    for (int k = 0; k < STRIDE * ROWS; k++) {
        u[k] = draw_float_bits(c);
    }
    memcpy(base, u, sizeof base);
    memcpy(loose, u, sizeof loose);
    for (int k = 0; k < 8; k++) {
        index[k] = draw(c) % ROWS; /* repeats happen */
    }
    for (unsigned i = 0; i < 8; i++) {
        r[i] = tl_f8_load(base + 8 * i);
    }
    tl_f8_transpose(r);
    for (int i = 0; i < 8; i++) {
        EACH(u[8 * k + i]);
        same_f(c, "transpose", r[i], w, EXACT);
    }
    tl_f8_load_rows_stride(loose, STRIDE, index, r);
    for (unsigned i = 0; i < 8; i++) {
        EACH(u[STRIDE * index[k] + i]);
        same_f(c, "load_rows_stride", r[i], w, EXACT);
    }
    tl_f8_load_rows(base, index, r);
    for (unsigned i = 0; i < 8; i++) {
        EACH(u[8 * index[k] + i]);
        same_f(c, "load_rows", r[i], w, EXACT);
    }
    for (int k = 0; k < 8; k++) {
        index[k] = draw(c) % ROWS;
    }
    memcpy(out, base, sizeof out);
    memcpy(want, base, sizeof want);
    for (int k = 0; k < 8; k++) {
        for (unsigned i = 0; i < 8; i++) {
            want[8 * index[k] + i] = bits(tl_f8_lane(r[i], k));
        }
    }
    tl_f8_store_rows(out, index, r);
    for (unsigned k = 0; k < ROWS; k++) {
        same_f(c, "store_rows", tl_f8_load(out + 8 * k), want + 8 * k, EXACT);
    }
}

static void check_trigonometry(struct check *c, const struct operands *o) {
    uint32_t ws[8], wc[8], w[8];
    tl_f8 s, co;
    float x[8];
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < 8; k++) {
            float vs, vc;
            x[k] = pass == 0 ? o->a[k] : (float)o->i[k] * (3.2f / 2147483648.0f);
            tl_sincos(x[k], &vs, &vc);
            ws[k] = bits(vs), wc[k] = bits(vc);
        }
        tl_f8_sincos(tl_f8_loadu(x), &s, &co);
        same_f(c, "sin", s, ws, NAN_IS_NAN);
        same_f(c, "cos", co, wc, NAN_IS_NAN);
    }
    EACH(bits(tl_atan2(o->a[k], o->b[k])));
    same_f(c, "atan2", tl_f8_atan2(tl_f8_load(o->a), tl_f8_load(o->b)), w, NAN_IS_NAN);
}

int LANES_CHECK(uint32_t seed, uint64_t *digest) {
    struct check c = {seed * 2654435761u | 1u, 0xcbf29ce484222325u, 0};
    struct operands o;
    for (int round = 0; round < ROUNDS; round++) {
        draw_operands(&c, &o);
        check_arithmetic(&c, &o);
        check_masks(&c, &o);
        check_integers(&c, &o);
        check_memory(&c, &o);
        check_rows(&c);
        check_trigonometry(&c, &o);
    }
    *digest = c.digest;
    return c.failures;
}
