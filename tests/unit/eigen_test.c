/* Principal axes against the matrix that they came from, in double. */
#include "base/eigen.h"
#include "store_check.h"

static void rotation_of(talus_quat q, double r[3][3]) {
    double x = (double)q.x, y = (double)q.y, z = (double)q.z, w = (double)q.w;
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(r, m, sizeof m);
}

/* The largest entry of a - R diag(v) R^T, as a share of the largest value. */
static double residual(const talus_mat3 *m) {
    talus_quat q;
    float v[3];
    tl_principal_axes(m, &q, v);
    double r[3][3], worst = 0.0, most = 0.0;
    rotation_of(q, r);
    NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 5e-7);
    const double a[3][3] = {{(double)m->x.x, (double)m->y.x, (double)m->z.x},
                            {(double)m->x.y, (double)m->y.y, (double)m->z.y},
                            {(double)m->x.z, (double)m->y.z, (double)m->z.z}};
    for (int i = 0; i < 3; i++) {
        most = fmax(most, fabs((double)v[i]));
        for (int j = 0; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++) {
                sum += r[i][k] * (double)v[k] * r[j][k];
            }
            worst = fmax(worst, fabs(sum - a[i][j]));
        }
    }
    return most > 0.0 ? worst / most : worst;
}

static talus_mat3 symmetric(float xx, float yy, float zz, float xy, float xz, float yz) {
    talus_mat3 m = {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
    return m;
}

/* Inertias of random rotations of random moments, of all sizes that floats square: 1e-6 of the largest. */
static void inertias(void **state) {
    (void)state;
    uint32_t seed = 77;
    for (int round = 0; round < 20000; round++) {
        double r[3][3], a[3][3] = {{0.0}};
        talus_quat q = {draw_float(&seed, -1.0f, 1.0f), draw_float(&seed, -1.0f, 1.0f), draw_float(&seed, -1.0f, 1.0f),
                        draw_float(&seed, -1.0f, 1.0f)};
        float l = sqrtf(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) + 1e-6f;
        q.x /= l, q.y /= l, q.z /= l, q.w /= l;
        rotation_of(q, r);
        double scale = pow(10.0, (double)draw_float(&seed, -15.0f, 15.0f));
        for (int k = 0; k < 3; k++) {
            double v = scale * (round % 3 == 0 && k ? 1.0 : (double)draw_float(&seed, 1e-3f, 1.0f));
            for (int i = 0; i < 3; i++) {
                for (int j = 0; j < 3; j++) {
                    a[i][j] += r[i][k] * v * r[j][k];
                }
            }
        }
        talus_mat3 m =
            symmetric((float)a[0][0], (float)a[1][1], (float)a[2][2], (float)a[0][1], (float)a[0][2], (float)a[1][2]);
        NEAR(residual(&m), 0.0, 1e-6);
    }
}

static void diagonal_is_left_alone(void **state) {
    (void)state;
    const float v[][3] = {
        {1.0f, 2.0f, 3.0f}, {3.0f, 1.0f, 2.0f}, {5.0f, 5.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, {1e-20f, 1e20f, 1.0f}};
    for (int i = 0; i < 5; i++) {
        talus_mat3 m = symmetric(v[i][0], v[i][1], v[i][2], 0.0f, 0.0f, 0.0f);
        talus_quat q;
        float values[3];
        tl_principal_axes(&m, &q, values);
        assert_true(q.x == 0.0f && q.y == 0.0f && q.z == 0.0f && q.w == 1.0f);
        assert_true(values[0] == v[i][0] && values[1] == v[i][1] && values[2] == v[i][2]);
    }
}

static void few_to_many_orders(void **state) {
    (void)state;
    const talus_mat3 m[] = {
        symmetric(2.0f, 2.0f, 2.0f, 1.0f, 1.0f, 1.0f), symmetric(1.0f, 1.0f, 1e-6f, 0.999f, 0.0f, 0.0f),
        symmetric(1e6f, 1.0f, 1.0f, 10.0f, -10.0f, 0.5f), symmetric(1.0f, 1.0f, 1.0f, 1e-6f, 0.0f, -1e-6f)};
    for (int i = 0; i < 4; i++) {
        NEAR(residual(&m[i]), 0.0, 1e-6);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inertias),
        cmocka_unit_test(diagonal_is_left_alone),
        cmocka_unit_test(few_to_many_orders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
