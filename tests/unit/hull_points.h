/* Point sets for the tests of hulls: plain, flat-faced, thin, sharp, repeated, of two scales. About 1 in size; a
 * family's points depend on the seed only. */
#ifndef HULL_POINTS_H
#define HULL_POINTS_H

#include <math.h>
#include <stdint.h>

#define SEED 20240229u

static uint64_t state;

static void seed(uint32_t s) { state = s * 2654435761u + 1u; }

static uint32_t next_u32(void) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    uint32_t x = (uint32_t)(state >> 32);
    return x ^ (x >> 15);
}

static double uniform(void) { return (double)next_u32() / 4294967295.0 * 2.0 - 1.0; }

/* Shapes of point sets. */
enum {
    IN_BALL,
    ON_SPHERE,
    IN_CUBE,
    ON_CUBE,
    GRID,
    TURNED_GRID,
    JITTERED_CUBE,
    CYLINDER,
    CONE,
    SLAB,
    TURNED_SLAB,
    LENS,
    BLADE,
    PRISM_STACK,
    FEW_VALUES,
    GAUSSIAN,
    COPIES,
    SHELL_PATCH,
    TWO_SCALES,
    INTEGERS,
    OFF_ORIGIN,
    DOUBLE_CONE,
    NEEDLE,
    FAMILY_COUNT
};

static const char *const family_name[FAMILY_COUNT] = {
    "in ball", "on sphere",   "in cube",     "on cube",  "grid",   "turned grid", "jittered cube", "cylinder",
    "cone",    "slab",        "turned slab", "lens",     "blade",  "prism stack", "few values",    "gaussian",
    "copies",  "shell patch", "two scales",  "integers", "offset", "double cone", "needle"};

static void turn(double p[3]) {
    /* A rotation by about 1 rad about (1, 2, 3), in double, rounded to float afterwards. */
    static const double r[3][3] = {{
                                       0.573137963,
                                       -0.609007093,
                                       0.548291,
                                   },
                                   {0.740348966, 0.671644, -0.0276787},
                                   {-0.351278, 0.421906, 0.835822}};
    double q[3] = {p[0], p[1], p[2]};
    for (int i = 0; i < 3; ++i) {
        p[i] = r[i][0] * q[0] + r[i][1] * q[1] + r[i][2] * q[2];
    }
}

static void unit_vector(double p[3]) {
    double l;
    do {
        p[0] = uniform(), p[1] = uniform(), p[2] = uniform();
        l = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    } while (l > 1.0 || l < 0.01);
    l = sqrt(l);
    p[0] /= l, p[1] /= l, p[2] /= l;
}

static void on_cube(double p[3]) {
    p[0] = uniform(), p[1] = uniform(), p[2] = uniform();
    uint32_t k = next_u32();
    p[k % 3u] = k & 0x10000u ? 1.0 : -1.0;
    if (k & 0x20000u) {
        p[(k + 1u) % 3u] = k & 0x40000u ? 1.0 : -1.0;
    }
}

static uint32_t side_of(uint32_t n) {
    uint32_t s = 2u;
    while ((s + 1u) * (s + 1u) * (s + 1u) <= n) {
        ++s;
    }
    return s;
}

static void family_point(int family, uint32_t i, uint32_t n, double p[3]) {
    uint32_t s = side_of(n), half = n / 2u;
    double a = 6.283185307179586 * (double)(i % half) / (double)half;
    switch (family) {
    case IN_BALL:
        unit_vector(p);
        for (int k = 0; k < 3; ++k) {
            p[k] *= 0.5 + 0.5 * uniform();
        }
        break;
    case IN_CUBE:
        p[0] = uniform(), p[1] = uniform(), p[2] = uniform();
        break;
    case ON_CUBE:
        on_cube(p);
        break;
    case GRID:
    case TURNED_GRID:
        p[0] = 0.1 * (double)(i % s), p[1] = 0.1 * (double)(i / s % s), p[2] = 0.1 * (double)(i / s / s % s);
        if (family == TURNED_GRID) {
            turn(p);
        }
        break;
    case JITTERED_CUBE:
        on_cube(p);
        for (int k = 0; k < 3; ++k) {
            p[k] += 1e-7 * uniform();
        }
        turn(p);
        break;
    case CYLINDER:
        p[0] = cos(a), p[1] = sin(a), p[2] = i < half ? -0.5 : 0.5;
        turn(p);
        break;
    case CONE:
        p[0] = cos(a), p[1] = sin(a), p[2] = 0.0;
        if (i == n - 1u) {
            p[0] = p[1] = 0.1, p[2] = 2.0;
        }
        break;
    case DOUBLE_CONE:
        p[0] = cos(a) * (i < half ? 1.0 : 0.999), p[1] = sin(a), p[2] = 0.0;
        if (i >= n - 2u) {
            p[0] = p[1] = 0.0, p[2] = i == n - 1u ? 0.3 : -0.3;
        }
        break;
    case SLAB:
    case TURNED_SLAB:
        p[0] = uniform(), p[1] = uniform(), p[2] = i & 1u ? 1e-6 : -1e-6;
        if (family == TURNED_SLAB) {
            turn(p);
        }
        break;
    case LENS:
        unit_vector(p);
        p[2] *= 1e-3;
        turn(p);
        break;
    case BLADE:
        p[0] = uniform(), p[1] = i % 3u == 0u ? 1.0 : uniform(), p[2] = (1.0 - p[1]) * 1e-2 * uniform();
        break;
    case PRISM_STACK:
        p[0] = cos(a), p[1] = sin(a), p[2] = (double)(next_u32() % 5u) * 0.25;
        break;
    case FEW_VALUES:
        for (int k = 0; k < 3; ++k) {
            p[k] = (double)(next_u32() % 4u) / 3.0;
        }
        break;
    case GAUSSIAN:
        for (int k = 0; k < 3; ++k) {
            p[k] = uniform() + uniform() + uniform() + uniform();
        }
        break;
    case COPIES:
        seed(SEED + i % 17u);
        unit_vector(p);
        break;
    case SHELL_PATCH:
        p[0] = uniform(), p[1] = uniform(), p[2] = 1e-5 * (p[0] * p[0] + p[1] * p[1]);
        break;
    case TWO_SCALES:
        unit_vector(p);
        if (i % 2u) {
            p[0] = 1.0 + 1e-4 * p[0], p[1] = 1.0 + 1e-4 * p[1], p[2] = 1.0 + 1e-4 * p[2];
        }
        break;
    case INTEGERS:
        for (int k = 0; k < 3; ++k) {
            p[k] = ((double)(next_u32() % 2001u) - 1000.0) / 1024.0;
        }
        break;
    case OFF_ORIGIN:
        unit_vector(p);
        p[0] = 0.5 + 0.001 * p[0], p[1] = 0.001 * p[1] - 0.25, p[2] = 1.0 + 0.001 * p[2];
        break;
    case NEEDLE:
        unit_vector(p);
        p[0] *= 1e-4, p[1] *= 1e-4;
        turn(p);
        break;
    default:
        unit_vector(p);
        break;
    }
}

#endif
