/* The bounds that trig.h states, against libm in double; the special values; and the bits themselves. */
#include "base/trig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static float from_bits(uint32_t u) {
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
}

static uint32_t to_bits(float x) {
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

/* Marsaglia, "Xorshift RNGs", 2003 */
static uint32_t draw(uint32_t *state) {
    uint32_t x = *state;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return *state = x;
}

struct worst {
    double absolute, relative;
    float at_absolute, at_relative;
};

static void note(struct worst *w, float got, double want, float x) {
    double e = fabs((double)got - want), r = e > 0.0 ? e / fabs(want) : 0.0;
    if (!(e <= w->absolute)) {
        w->absolute = e, w->at_absolute = x;
    }
    if (!(r <= w->relative)) {
        w->relative = r, w->at_relative = x;
    }
}

static void within(const char *name, const struct worst *w, double absolute, double relative) {
    printf("%-16s absolute %.3g at %a, relative %.3g at %a\n", name, w->absolute, (double)w->at_absolute, w->relative,
           (double)w->at_relative);
    assert_true(w->absolute <= absolute);
    assert_true(w->relative <= relative);
}

/* Every step-th float of [low, high] and its negative. */
static void sweep(const char *name, float (*f)(float), double (*exact)(double), float low, float high, uint32_t step,
                  double absolute, double relative) {
    struct worst w = {0.0, 0.0, 0.0f, 0.0f};
    for (uint32_t u = to_bits(low); u <= to_bits(high); u += step) {
        float x = from_bits(u);
        note(&w, f(x), exact((double)x), x);
        note(&w, f(-x), exact(-(double)x), -x);
    }
    note(&w, f(high), exact((double)high), high);
    within(name, &w, absolute, relative);
}

static void sine_and_cosine_keep_their_bounds(void **state) {
    (void)state;
    sweep("sin to pi/4", tl_sin, sin, 1e-37f, 0.7853982f, 641, 1.0e-7, 1.4e-7);
    sweep("sin to pi", tl_sin, sin, 0.7853982f, 3.1415927f, 11, 1.0e-7, 1.4e-7);
    sweep("sin to 1024", tl_sin, sin, 3.1415927f, 1024.0f, 61, 1.2e-7, 2.0e-7);
    sweep("sin to 1e5", tl_sin, sin, 1024.0f, 1e5f, 61, 1.2e-7, 2.0e-7);
    sweep("sin beyond", tl_sin, sin, 1e5f, 3.4028235e38f, 1021, 1.2e-7, 2.0e-7);
    sweep("cos to pi/4", tl_cos, cos, 1e-37f, 0.7853982f, 641, 1.0e-7, 1.4e-7);
    sweep("cos to pi", tl_cos, cos, 0.7853982f, 3.1415927f, 11, 1.0e-7, 1.4e-7);
    sweep("cos to 1024", tl_cos, cos, 3.1415927f, 1024.0f, 61, 1.2e-7, 2.0e-7);
    sweep("cos to 1e5", tl_cos, cos, 1024.0f, 1e5f, 61, 1.2e-7, 2.0e-7);
    sweep("cos beyond", tl_cos, cos, 1e5f, 3.4028235e38f, 1021, 1.2e-7, 2.0e-7);
}

/* The floats next to multiples of pi/2, where the reduction cancels most. */
static void reduction_holds_next_to_quarter_turns(void **state) {
    (void)state;
    struct worst ws = {0.0, 0.0, 0.0f, 0.0f}, wc = ws;
    const double quarter = acos(0.0);
    for (int k = 1; k < 70000; k++) {
        uint32_t u = to_bits((float)(k * quarter));
        for (uint32_t d = 0; d < 3; d++) {
            float x = from_bits(u - 1u + d);
            note(&ws, tl_sin(x), sin((double)x), x);
            note(&wc, tl_cos(x), cos((double)x), x);
        }
    }
    within("sin at quarters", &ws, 1.2e-7, 2.0e-7);
    within("cos at quarters", &wc, 1.2e-7, 2.0e-7);
}

static void sincos_is_sin_and_cos(void **state) {
    (void)state;
    uint32_t seed = 20011;
    printf("seed %lu\n", (unsigned long)seed);
    for (int i = 0; i < 300000; i++) {
        float x = from_bits(draw(&seed)), s, c;
        tl_sincos(x, &s, &c);
        if (x - x != 0.0f) {
            assert_true(s != s && c != c && tl_sin(x) != tl_sin(x) && tl_cos(x) != tl_cos(x));
            continue;
        }
        assert_int_equal(to_bits(s), to_bits(tl_sin(x)));
        assert_int_equal(to_bits(c), to_bits(tl_cos(x)));
        assert_int_equal(to_bits(s) ^ 0x80000000u, to_bits(tl_sin(-x)));
        assert_int_equal(to_bits(c), to_bits(tl_cos(-x)));
        assert_true(s >= -1.0f && s <= 1.0f && c >= -1.0f && c <= 1.0f);
        assert_true(fabs((double)s * (double)s + (double)c * (double)c - 1.0) < 3e-7);
    }
}

static void special_angles(void **state) {
    (void)state;
    assert_int_equal(to_bits(tl_sin(0.0f)), 0);
    assert_int_equal(to_bits(tl_sin(-0.0f)), 0x80000000u);
    assert_true(tl_cos(0.0f) == 1.0f && tl_cos(-0.0f) == 1.0f);
    for (uint32_t u = 1; u < 0x00800000u; u += 4099) {
        assert_int_equal(to_bits(tl_sin(from_bits(u))), u); /* a denormal is its own sine */
    }
    const float inf = from_bits(0x7f800000u), nan = from_bits(0x7fc00000u);
    float bad[] = {inf, -inf, nan, -nan};
    for (int i = 0; i < 4; i++) {
        assert_true(tl_sin(bad[i]) != tl_sin(bad[i]) && tl_cos(bad[i]) != tl_cos(bad[i]));
    }
}

static float atan_of(float t) { return tl_atan2(t, 1.0f); }

static void atan2_keeps_its_bounds(void **state) {
    (void)state;
    sweep("atan to 1", atan_of, atan, 1.2e-38f, 1.0f, 331, 2.3e-7, 1.4e-7);
    sweep("atan beyond", atan_of, atan, 1.0f, 3.4028235e38f, 331, 2.3e-7, 1.4e-7);
    struct worst w = {0.0, 0.0, 0.0f, 0.0f};
    uint32_t seed = 20012;
    printf("seed %lu\n", (unsigned long)seed);
    for (int i = 0; i < 3000000; i++) {
        uint32_t keep = i & 1 ? 0xffffffffu : 0x80ffffffu, add = i & 1 ? 0u : 0x3f000000u;
        float y = from_bits((draw(&seed) & keep) | add), x = from_bits((draw(&seed) & keep) | add);
        if (x - x != 0.0f || y - y != 0.0f) {
            continue;
        }
        double want = atan2((double)y, (double)x);
        float got = tl_atan2(y, x);
        assert_int_equal(to_bits(got) ^ 0x80000000u, to_bits(tl_atan2(-y, x)));
        if (fabs(want) < 1.2e-38) {
            assert_true(fabs((double)got - want) <= 1.5e-45);
        } else {
            note(&w, got, want, y);
        }
    }
    within("atan2", &w, 2.3e-7, 1.4e-7);
}

static void atan2_of_zeros_and_infinities(void **state) {
    (void)state;
    const float inf = from_bits(0x7f800000u), nan = from_bits(0x7fc00000u), tiny = from_bits(1u), big = 3.4028235e38f;
    const float v[] = {0.0f, tiny, 1.0f, big, inf};
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 5; k++) {
            for (int sign = 0; sign < 4; sign++) {
                float y = sign & 1 ? -v[i] : v[i], x = sign & 2 ? -v[k] : v[k];
                double want = atan2((double)y, (double)x);
                float got = tl_atan2(y, x);
                assert_true(fabs((double)got - want) <= 2.3e-7);
                assert_int_equal(to_bits(got) >> 31, signbit(want) ? 1 : 0);
                assert_true(want != 0.0 || got == 0.0f);
            }
        }
        assert_true(tl_atan2(nan, v[i]) != tl_atan2(nan, v[i]) && tl_atan2(v[i], nan) != tl_atan2(v[i], nan));
    }
    assert_true(tl_atan2(1.0f, 1.0f) == 0.78539816339f && tl_atan2(0.0f, -1.0f) == 3.14159265359f);
}

static void asin_and_acos_keep_their_bounds(void **state) {
    (void)state;
    sweep("asin to 1/2", tl_asin, asin, 1e-37f, 0.5f, 331, 1.5e-7, 2.8e-7);
    sweep("asin to 1", tl_asin, asin, 0.5f, 1.0f, 7, 1.5e-7, 2.8e-7);
    sweep("acos to 1/2", tl_acos, acos, 1e-37f, 0.5f, 331, 2.6e-7, 1.4e-7);
    sweep("acos to 1", tl_acos, acos, 0.5f, 1.0f, 7, 2.6e-7, 1.4e-7);
}

static void asin_and_acos_at_and_beyond_the_ends(void **state) {
    (void)state;
    const float inf = from_bits(0x7f800000u), nan = from_bits(0x7fc00000u), half_pi = 1.57079632679f,
                pi = 3.14159265359f;
    const float beyond[] = {1.0f, from_bits(0x3f800001u), 2.0f, 1e30f, inf};
    for (int i = 0; i < 5; i++) {
        assert_true(tl_asin(beyond[i]) == half_pi && tl_asin(-beyond[i]) == -half_pi);
        assert_true(tl_acos(beyond[i]) == 0.0f && tl_acos(-beyond[i]) == pi);
    }
    assert_true(tl_asin(nan) != tl_asin(nan) && tl_acos(nan) != tl_acos(nan));
    assert_int_equal(to_bits(tl_asin(0.0f)), 0);
    assert_int_equal(to_bits(tl_asin(-0.0f)), 0x80000000u);
    assert_true(tl_acos(0.0f) == half_pi && tl_acos(-0.0f) == half_pi);
}

/* One number for the bits of all functions over fixed arguments: the same for every compiler and processor. */
static void bits_are_the_known_ones(void **state) {
    (void)state;
    uint64_t hash = 0xcbf29ce484222325u;
    uint32_t seed = 1;
    for (int i = 0; i < 200000; i++) {
        uint32_t u = draw(&seed), v = draw(&seed);
        float x = from_bits(i & 1 ? u : (u & 0x87ffffffu) | 0x38000000u),
              y = from_bits((v & 0x80ffffffu) | 0x3f000000u);
        float r[5] = {tl_sin(x), tl_cos(x), tl_atan2(y, x), tl_asin(y - 0.5f), tl_acos(x)};
        for (int k = 0; k < 5; k++) {
            hash = (hash ^ (r[k] == r[k] ? to_bits(r[k]) : 0x7fc00000u)) * 0x100000001b3u;
        }
    }
    printf("bits %08lx%08lx\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
    assert_true(hash == 0xcac2a38bb87c5af9u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_keep_their_bounds),
        cmocka_unit_test(reduction_holds_next_to_quarter_turns),
        cmocka_unit_test(sincos_is_sin_and_cos),
        cmocka_unit_test(special_angles),
        cmocka_unit_test(atan2_keeps_its_bounds),
        cmocka_unit_test(atan2_of_zeros_and_infinities),
        cmocka_unit_test(asin_and_acos_keep_their_bounds),
        cmocka_unit_test(asin_and_acos_at_and_beyond_the_ends),
        cmocka_unit_test(bits_are_the_known_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
