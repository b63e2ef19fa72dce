#include "base/eigen.h"

#include "base/vec.h"

/* Turns rows and columns p and q of a, and the columns of v, so that a[p][q] becomes 0. */
static void jacobi_rotation(double a[3][3], double v[3][3], int p, int q) {
    double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    double size = theta < 0.0 ? -theta : theta;
    double t;
    if (size > 1e8) {
        t = 0.5 / size;
    } else {
        double square = theta * theta + 1.0; /* its root: a float guess and two Newton steps */
        double root = (double)sqrtf((float)square);
        root = 0.5 * (root + square / root);
        root = 0.5 * (root + square / root);
        t = 1.0 / (size + root);
    }
    t = theta < 0.0 ? -t : t;
    double square = t * t + 1.0, root = (double)sqrtf((float)square);
    root = 0.5 * (root + square / root);
    root = 0.5 * (root + square / root);
    double c = 1.0 / root, s = t * c;
    for (int k = 0; k < 3; k++) {
        double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < 3; k++) {
        double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
    for (int k = 0; k < 3; k++) {
        double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq;
        v[k][q] = s * kp + c * kq;
    }
    a[p][q] = a[q][p] = 0.0;
}

static talus_quat quat_from_columns(double v[3][3]) {
    float xx = (float)v[0][0], yy = (float)v[1][1], zz = (float)v[2][2];
    talus_quat q;
    if (xx + yy + zz > 0.0f) {
        q.w = 1.0f + xx + yy + zz;
        q.x = (float)(v[2][1] - v[1][2]), q.y = (float)(v[0][2] - v[2][0]), q.z = (float)(v[1][0] - v[0][1]);
    } else if (xx >= yy && xx >= zz) {
        q.x = 1.0f + xx - yy - zz;
        q.w = (float)(v[2][1] - v[1][2]), q.y = (float)(v[0][1] + v[1][0]), q.z = (float)(v[0][2] + v[2][0]);
    } else if (yy >= zz) {
        q.y = 1.0f - xx + yy - zz;
        q.w = (float)(v[0][2] - v[2][0]), q.x = (float)(v[0][1] + v[1][0]), q.z = (float)(v[1][2] + v[2][1]);
    } else {
        q.z = 1.0f - xx - yy + zz;
        q.w = (float)(v[1][0] - v[0][1]), q.x = (float)(v[0][2] + v[2][0]), q.y = (float)(v[1][2] + v[2][1]);
    }
    return tl_quat_normalize(q);
}

void tl_principal_axes(const talus_mat3 *m, talus_quat *axes, float values[3]) {
    double a[3][3] = {{(double)m->x.x, (double)m->y.x, (double)m->z.x},
                      {(double)m->y.x, (double)m->y.y, (double)m->z.y},
                      {(double)m->z.x, (double)m->z.y, (double)m->z.z}};
    double v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    double scale = 0.0;
    for (int i = 0; i < 3; i++) {
        scale = a[i][i] > scale ? a[i][i] : scale;
    }
    for (int sweep = 0; sweep < 12; sweep++) {
        int turned = 0;
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                double off = a[p][q] < 0.0 ? -a[p][q] : a[p][q];
                /* What lies below the floats' own rounding is no reason to turn the axes. */
                if (off > 1e-7 * scale) {
                    jacobi_rotation(a, v, p, q);
                    turned = 1;
                }
            }
        }
        if (!turned) {
            break;
        }
    }
    *axes = quat_from_columns(v);
    for (int i = 0; i < 3; i++) {
        values[i] = (float)a[i][i];
    }
}
