/* The vector algebra of base/vec.h against the same thing in double, and its edges. Results are bounded by a few units
 * of float rounding (6e-8) times the size of what went in. */
#include "base/vec.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { ROUNDS = 20000 };

static uint32_t random_state;

static void seed(uint32_t value) {
    random_state = value;
    printf("seed %lu\n", (unsigned long)value);
}

/* Marsaglia, "Xorshift RNGs", 2003 */
static uint32_t draw(void) {
    uint32_t x = random_state;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return random_state = x;
}

/* Evenly in [-size, size] */
static float draw_in(float size) { return ((float)(draw() >> 8) * (2.0f / 16777216.0f) - 1.0f) * size; }

static talus_vec3 draw_vec(float size) {
    float x = draw_in(size), y = draw_in(size), z = draw_in(size);
    return tl_v(x, y, z);
}

static talus_quat draw_quat(void) {
    talus_quat q = {draw_in(1.0f), draw_in(1.0f), draw_in(1.0f), draw_in(1.0f)};
    return tl_quat_normalize(q);
}

static uint32_t to_bits(float x) {
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u;
}

static float from_bits(uint32_t u) {
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
}

#define INFINITE from_bits(0x7f800000u)
#define NOT_A_NUMBER from_bits(0x7fc00000u)

static void close_to(double got, double want, double bound) {
    if (!(fabs(got - want) <= bound)) {
        printf("got %.9g, want %.9g, bound %.3g\n", got, want, bound);
    }
    assert_true(fabs(got - want) <= bound);
}

static void close_vec(talus_vec3 got, talus_vec3 want, double bound) {
    close_to((double)got.x, (double)want.x, bound);
    close_to((double)got.y, (double)want.y, bound);
    close_to((double)got.z, (double)want.z, bound);
}

static void scalars(void **state) {
    (void)state;
    /* compare and select: the second for a NaN on either side, and for two zeros */
    assert_true(tl_min(1.0f, 2.0f) == 1.0f && tl_max(1.0f, 2.0f) == 2.0f);
    assert_true(tl_min(NOT_A_NUMBER, 2.0f) == 2.0f && tl_max(NOT_A_NUMBER, 2.0f) == 2.0f);
    assert_int_equal(to_bits(tl_min(2.0f, NOT_A_NUMBER)), 0x7fc00000u);
    assert_int_equal(to_bits(tl_max(2.0f, NOT_A_NUMBER)), 0x7fc00000u);
    assert_int_equal(to_bits(tl_min(-0.0f, 0.0f)), 0u);
    assert_int_equal(to_bits(tl_max(0.0f, -0.0f)), 0x80000000u);
    assert_true(tl_clamp(5.0f, -1.0f, 1.0f) == 1.0f && tl_clamp(-5.0f, -1.0f, 1.0f) == -1.0f);
    assert_true(tl_clamp(0.25f, -1.0f, 1.0f) == 0.25f && tl_clamp(INFINITE, -1.0f, 1.0f) == 1.0f);
    assert_true(tl_abs(-3.0f) == 3.0f && tl_abs(3.0f) == 3.0f && tl_abs(-INFINITE) == INFINITE);
    const float finite[] = {0.0f, -0.0f, from_bits(1u), 3.4028235e38f, -3.4028235e38f};
    const float odd[] = {INFINITE, -INFINITE, NOT_A_NUMBER, -NOT_A_NUMBER};
    for (int i = 0; i < 5; i++) {
        assert_true(tl_is_finite(finite[i]));
    }
    for (int i = 0; i < 4; i++) {
        float v[4] = {1.0f, 1.0f, 1.0f, 1.0f};
        assert_false(tl_is_finite(odd[i]));
        for (int k = 0; k < 4; k++) {
            v[k] = odd[i];
            talus_quat q = {v[0], v[1], v[2], v[3]};
            talus_pose p = {tl_v(0.0f, 0.0f, 0.0f), q};
            assert_false(tl_is_finite_quat(q));
            assert_false(tl_is_finite_pose(&p));
            assert_int_equal(tl_is_finite3(tl_v(v[0], v[1], v[2])), k == 3);
            v[k] = 1.0f;
        }
    }
}

static void sums_and_products(void **state) {
    (void)state;
    seed(30011);
    for (int i = 0; i < ROUNDS; i++) {
        talus_vec3 a = draw_vec(10.0f), b = draw_vec(10.0f);
        float s = draw_in(10.0f);
        double ax = (double)a.x, ay = (double)a.y, az = (double)a.z, bx = (double)b.x, by = (double)b.y,
               bz = (double)b.z;
        close_vec(tl_sub(tl_add(a, b), b), a, 4e-6);
        close_vec(tl_mad(a, s, b), tl_add(a, tl_scale(b, s)), 0.0);
        close_vec(tl_add(a, tl_neg(a)), tl_v(0.0f, 0.0f, 0.0f), 0.0);
        close_to((double)tl_dot(a, b), ax * bx + ay * by + az * bz, 6e-5);
        talus_vec3 c = tl_cross(a, b);
        close_to((double)c.x, ay * bz - az * by, 4e-5);
        close_to((double)c.y, az * bx - ax * bz, 4e-5);
        close_to((double)c.z, ax * by - ay * bx, 4e-5);
        close_vec(tl_cross(b, a), tl_neg(c), 0.0);
        close_vec(tl_cross(a, a), tl_v(0.0f, 0.0f, 0.0f), 0.0);
        close_to((double)tl_length2(a), ax * ax + ay * ay + az * az, 6e-5);
        close_to((double)tl_length(a), sqrt(ax * ax + ay * ay + az * az), 4e-6);
        close_vec(tl_mul(a, b), tl_v(a.x * b.x, a.y * b.y, a.z * b.z), 0.0);
        talus_vec3 low = tl_min3(a, b), high = tl_max3(a, b), d = tl_abs3(tl_sub(a, b));
        close_vec(tl_sub(high, low), d, 0.0);
        close_vec(tl_add(low, high), tl_add(a, b), 0.0);
    }
}

static void normalize_of_any_length(void **state) {
    (void)state;
    const talus_vec3 other = {0.0f, 0.0f, 7.0f};
    seed(30012);
    for (int i = 0; i < ROUNDS; i++) {
        /* lengths from 1e-29 to 1e38, where the square of the length is not a float */
        talus_vec3 a = tl_scale(draw_vec(1.0f), (float)pow(10.0, (double)draw_in(33.0f) + 4.5));
        double x = (double)a.x, y = (double)a.y, z = (double)a.z, l = sqrt(x * x + y * y + z * z);
        talus_vec3 n = tl_normalize_or(a, other);
        if (l < 2e-30) {
            continue;
        }
        close_to((double)n.x, x / l, 3e-7);
        close_to((double)n.y, y / l, 3e-7);
        close_to((double)n.z, z / l, 3e-7);
        close_to((double)tl_length2(n), 1.0, 5e-7);
    }
    close_vec(tl_normalize_or(tl_v(0.0f, -3.0f, 0.0f), other), tl_v(0.0f, -1.0f, 0.0f), 0.0);
    close_vec(tl_normalize_or(tl_v(0.0f, 0.0f, 0.0f), other), other, 0.0);
    close_vec(tl_normalize_or(tl_v(1e-31f, -1e-31f, 0.0f), other), other, 0.0);
    close_vec(tl_normalize_or(tl_v(1.0f, INFINITE, 0.0f), other), other, 0.0);
}

static void perpendicular_is_unit_and_across(void **state) {
    (void)state;
    seed(30013);
    for (int i = 0; i < ROUNDS; i++) {
        talus_vec3 a = draw_vec(1.0f);
        if (i < 27 * 4) { /* axes, edges and corners of the cube, and next to them */
            a = tl_v((float)(i % 3 - 1), (float)(i / 3 % 3 - 1), (float)(i / 9 % 3 - 1));
            a = tl_add(a, tl_scale(draw_vec(1.0f), i < 27 ? 0.0f : 1e-6f));
        }
        talus_vec3 n = tl_normalize_or(a, tl_v(1.0f, 0.0f, 0.0f)), t = tl_perpendicular(n), again = tl_perpendicular(n);
        close_to((double)tl_length2(t), 1.0, 5e-7);
        close_to((double)tl_dot(n, t), 0.0, 2e-7);
        assert_memory_equal(&t, &again, sizeof t);
    }
}

static void rotations(void **state) {
    (void)state;
    seed(30014);
    for (int i = 0; i < ROUNDS; i++) {
        talus_quat a = draw_quat(), b = draw_quat(), ab = tl_quat_mul(a, b);
        talus_vec3 v = draw_vec(10.0f), w = draw_vec(10.0f), r = tl_rotate(a, v);
        close_to((double)tl_quat_dot(a, a), 1.0, 5e-7);
        close_vec(tl_rotate_back(a, r), v, 2e-5);
        close_to((double)tl_length(r), (double)tl_length(v), 1e-5);
        close_to((double)tl_dot(r, tl_rotate(a, w)), (double)tl_dot(v, w), 3e-4);
        close_vec(tl_cross(r, tl_rotate(a, w)), tl_rotate(a, tl_cross(v, w)), 4e-4); /* no mirror */
        close_vec(tl_rotate(ab, v), tl_rotate(a, tl_rotate(b, v)), 3e-5);
        talus_mat3 m = tl_mat3_from_quat(a);
        close_vec(tl_mat3_mul(&m, v), r, 2e-5);
        close_vec(tl_mat3_mul_t(&m, v), tl_rotate_back(a, v), 2e-5);
        talus_quat one = tl_quat_mul(a, tl_quat_conjugate(a));
        close_vec(tl_v(one.x, one.y, one.z), tl_v(0.0f, 0.0f, 0.0f), 3e-7);
        close_to((double)one.w, 1.0, 5e-7);
    }
    /* a quarter turn about z takes x to y: the hand and the order of x y z w */
    talus_quat q = {0.0f, 0.0f, 0.70710678f, 0.70710678f};
    close_vec(tl_rotate(q, tl_v(1.0f, 0.0f, 0.0f)), tl_v(0.0f, 1.0f, 0.0f), 2e-7);
    close_vec(tl_rotate(tl_quat_identity(), tl_v(1.0f, 2.0f, 3.0f)), tl_v(1.0f, 2.0f, 3.0f), 0.0);
}

static void quaternions_of_any_length(void **state) {
    (void)state;
    seed(30015);
    for (int i = 0; i < ROUNDS; i++) {
        talus_quat q = draw_quat(), r;
        float s = (float)pow(10.0, (double)draw_in(33.0f) + 4.5);
        r.x = q.x * s, r.y = q.y * s, r.z = q.z * s, r.w = q.w * s;
        r = tl_quat_normalize(r);
        close_vec(tl_v(r.x, r.y, r.z), tl_v(q.x, q.y, q.z), 5e-7);
        close_to((double)r.w, (double)q.w, 5e-7);
    }
    const talus_quat none[] = {{0.0f, 0.0f, 0.0f, 0.0f}, {1e-31f, 0.0f, 0.0f, 1e-31f}, {INFINITE, 0.0f, 0.0f, 1.0f}};
    for (int i = 0; i < 3; i++) {
        talus_quat r = tl_quat_normalize(none[i]), one = tl_quat_identity();
        assert_memory_equal(&r, &one, sizeof r);
    }
}

static void poses(void **state) {
    (void)state;
    seed(30016);
    for (int i = 0; i < ROUNDS; i++) {
        talus_pose a = {draw_vec(10.0f), draw_quat()}, b = {draw_vec(10.0f), draw_quat()};
        talus_vec3 p = draw_vec(10.0f);
        talus_pose ab = tl_pose_mul(&a, &b), relative = tl_pose_relative(&a, &b), back = tl_pose_mul(&a, &relative);
        close_vec(tl_pose_point_back(&a, tl_pose_point(&a, p)), p, 5e-5);
        close_vec(tl_pose_point(&ab, p), tl_pose_point(&a, tl_pose_point(&b, p)), 5e-5);
        close_vec(tl_pose_point(&relative, p), tl_pose_point_back(&a, tl_pose_point(&b, p)), 5e-5);
        close_vec(tl_pose_point(&back, p), tl_pose_point(&b, p), 8e-5);
        assert_true(tl_is_finite_pose(&ab));
    }
    talus_pose one = tl_pose_identity();
    close_vec(tl_pose_point(&one, tl_v(1.0f, 2.0f, 3.0f)), tl_v(1.0f, 2.0f, 3.0f), 0.0);
}

static void matrices(void **state) {
    (void)state;
    seed(30017);
    for (int i = 0; i < ROUNDS; i++) {
        talus_mat3 a = {draw_vec(3.0f), draw_vec(3.0f), draw_vec(3.0f)};
        talus_mat3 b = {draw_vec(3.0f), draw_vec(3.0f), draw_vec(3.0f)};
        talus_vec3 v = draw_vec(3.0f), w = draw_vec(3.0f);
        talus_mat3 ab = tl_mat3_mat(&a, &b), t = tl_mat3_transpose(&a), tt = tl_mat3_transpose(&t);
        close_vec(tl_mat3_mul(&ab, v), tl_mat3_mul(&a, tl_mat3_mul(&b, v)), 1e-4);
        close_vec(tl_mat3_mul_t(&a, v), tl_mat3_mul(&t, v), 0.0);
        close_to((double)tl_dot(tl_mat3_mul(&a, v), w), (double)tl_dot(v, tl_mat3_mul_t(&a, w)), 2e-4);
        close_vec(tl_mat3_mul(&a, tl_v(0.0f, 1.0f, 0.0f)), a.y, 0.0); /* by columns */
        assert_memory_equal(&tt, &a, sizeof a);
        assert_true(tl_is_finite_mat3(&a));
        a.z.y = INFINITE;
        assert_false(tl_is_finite_mat3(&a));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scalars),
        cmocka_unit_test(sums_and_products),
        cmocka_unit_test(normalize_of_any_length),
        cmocka_unit_test(perpendicular_is_unit_and_across),
        cmocka_unit_test(rotations),
        cmocka_unit_test(quaternions_of_any_length),
        cmocka_unit_test(poses),
        cmocka_unit_test(matrices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
