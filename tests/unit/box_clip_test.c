/* Two boxes face to face: their manifold against the two faces seen along its normal and clipped in double. The points
 * lie on both faces and are as far apart as these are there, the deepest corner is among them, and where there are more
 * corners than points those that are kept span most of the area. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide_brute.h"

/* A convex polygon, counter-clockwise; z is along the normal. */
typedef struct polygon {
    int count;
    d3 p[16];
} polygon;

/* The frame of a view along z. */
typedef struct view {
    d3 x, y, z;
} view;

static view view_along(d3 z) {
    d3 other = fabs(z.x) < 0.5 ? d3_make(1, 0, 0) : d3_make(0, 1, 0);
    view v;
    v.z = z;
    v.x = d3_unit(d3_cross(other, z));
    v.y = d3_cross(z, v.x);
    return v;
}

static d3 seen(const view *v, d3 p) { return d3_make(d3_dot(v->x, p), d3_dot(v->y, p), d3_dot(v->z, p)); }

/* Twice the area of a triangle seen along z. */
static double turn(d3 a, d3 b, d3 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

static double area_of(const polygon *q) {
    double sum = 0.0;
    for (int i = 2; i < q->count; i++) {
        sum += 0.5 * turn(q->p[0], q->p[i - 1], q->p[i]);
    }
    return sum;
}

/* The face of a box that looks along n the most. */
static polygon face_of(talus_vec3 half, const d_pose *at, d3 n, const view *v) {
    static const int order[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const d3 axis[3] = {at->x, at->y, at->z};
    const double h[3] = {(double)half.x, (double)half.y, (double)half.z};
    polygon q;
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = fabs(d3_dot(axis[i], n)) > fabs(d3_dot(axis[k], n)) ? i : k;
    }
    d3 middle = d3_add(at->t, d3_scale(axis[k], d3_dot(axis[k], n) < 0.0 ? -h[k] : h[k]));
    int u = (k + 1) % 3, w = (k + 2) % 3;
    q.count = 4;
    for (int i = 0; i < 4; i++) {
        d3 p = d3_add(d3_scale(axis[u], order[i][0] * h[u]), d3_scale(axis[w], order[i][1] * h[w]));
        q.p[i] = seen(v, d3_add(middle, p));
    }
    if (area_of(&q) < 0.0) {
        d3 swap = q.p[1];
        q.p[1] = q.p[3];
        q.p[3] = swap;
    }
    return q;
}

/* The height of a face's plane over x and y. */
static double height_at(const polygon *q, double x, double y) {
    d3 n = d3_cross(d3_sub(q->p[1], q->p[0]), d3_sub(q->p[2], q->p[0]));
    return q->p[0].z - (n.x * (x - q->p[0].x) + n.y * (y - q->p[0].y)) / n.z;
}

/* How far outside of a polygon a point lies, seen along z; negative inside. */
static double outside(const polygon *q, d3 p) {
    double most = -1e300;
    for (int i = 0; i < q->count; i++) {
        d3 a = q->p[i], b = q->p[(i + 1) % q->count];
        most = fmax(most, -turn(a, b, p) / hypot(b.x - a.x, b.y - a.y));
    }
    return most;
}

static polygon clipped(const polygon *q, const polygon *by) {
    polygon in = *q, out;
    for (int i = 0; i < by->count; i++) {
        d3 a = by->p[i], b = by->p[(i + 1) % by->count];
        out.count = 0;
        for (int k = 0; k < in.count; k++) {
            d3 p = in.p[k], r = in.p[(k + 1) % in.count];
            double dp = turn(a, b, p), dr = turn(a, b, r);
            if (dp >= 0.0) {
                out.p[out.count++] = p;
            }
            if ((dp >= 0.0) != (dr >= 0.0)) {
                out.p[out.count++] = d3_add(p, d3_scale(d3_sub(r, p), dp / (dp - dr)));
            }
        }
        in = out;
    }
    return in;
}

/* The area of the points' convex hull, of which there are at most four. */
static double area_spanned(const d3 *p, uint32_t count) {
    double most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            for (uint32_t k = 0; k < count; k++) {
                for (uint32_t l = 0; l < count; l++) {
                    double a = turn(p[i], p[j], p[k]), b = turn(p[i], p[k], p[l]);
                    most = fmax(most, 0.5 * (fmax(a, 0.0) + fmax(b, 0.0)));
                }
            }
        }
    }
    return most;
}

/* On one of its faces, turned about that face's normal and tilted a little. */
static talus_quat face_to_face(float tilt) {
    static const talus_quat quarter[3] = {
        {0.70710678f, 0, 0, 0.70710678f}, {0, 0.70710678f, 0, 0.70710678f}, {0, 0, 0.70710678f, 0.70710678f}};
    float angle = brute_u32() % 4u ? brute_range(-3.14159f, 3.14159f) : brute_range(-1e-3f, 1e-3f);
    talus_quat about = {0.0f, sinf(0.5f * angle), 0.0f, cosf(0.5f * angle)};
    talus_vec3 t = brute_vector(-tilt, tilt);
    talus_quat little = {t.x, t.y, t.z, 1.0f};
    talus_quat q = tl_quat_mul(tl_quat_normalize(little), tl_quat_mul(about, quarter[brute_u32() % 3u]));
    return tl_quat_normalize(q);
}

static void one_pair(float tilt, uint32_t *reduced, double *least_share) {
    tl_convex a = {{TALUS_BOX, 0, 0, 0, 0, brute_vector(0.2f, 1.0f), 0}, NULL}, b = a;
    tl_pair_cache cache = {{0, 0, 0, 0}};
    tl_manifold m;
    talus_vec3 up = tl_v(0.0f, 1.0f, 0.0f), lower;
    b.geometry.half = brute_vector(0.2f, 1.0f);
    talus_pose pose = {{0, 0, 0}, face_to_face(tilt)};
    lower = tl_rotate_back(pose.rotation, up);
    float height = tl_dot(tl_abs3(lower), b.geometry.half) + a.geometry.half.y;
    pose.position = tl_v(brute_range(-0.7f, 0.7f), height - brute_range(0.0f, 0.02f), brute_range(-0.7f, 0.7f));
    tl_collide(&a, &b, &pose, 1.0f, &cache, &m);
    d3 n = d3_of(m.normal);
    if (m.count == 0 || n.y < 0.99) {
        return; /* beside one another */
    }
    talus_pose here = tl_pose_identity();
    d_pose pa = d_pose_of(&here), pb = d_pose_of(&pose);
    view v = view_along(n);
    polygon fa = face_of(a.geometry.half, &pa, n, &v), fb = face_of(b.geometry.half, &pb, d3_scale(n, -1.0), &v);
    polygon both = clipped(&fa, &fb);
    double deepest = 1e300, found = 1e300, band = 2e-3;
    for (int i = 0; i < both.count; i++) {
        double x = both.p[i].x, y = both.p[i].y;
        deepest = fmin(deepest, height_at(&fb, x, y) - height_at(&fa, x, y));
    }
    d3 p[TL_MANIFOLD_POINTS];
    for (uint32_t i = 0; i < m.count; i++) {
        p[i] = seen(&v, d3_of(m.point[i].position));
        double gap = height_at(&fb, p[i].x, p[i].y) - height_at(&fa, p[i].x, p[i].y);
        double middle = 0.5 * (height_at(&fb, p[i].x, p[i].y) + height_at(&fa, p[i].x, p[i].y));
        double s = (double)m.point[i].separation;
        assert_true(outside(&fa, p[i]) < band && outside(&fb, p[i]) < band);
        assert_true(fabs(s - gap) < 1e-5 + 2.0 * band * (double)tilt && fabs(p[i].z - middle) < 1e-4);
        found = fmin(found, s);
    }
    assert_true(fabs(found - deepest) < 1e-5 + 4.0 * band * (double)tilt);
    double area = area_of(&both), spanned = area_spanned(p, m.count);
    if (area < 0.02) {
        return;
    }
    *reduced += both.count > 4;
    *least_share = fmin(*least_share, spanned / area);
    assert_true(both.count > 4 || spanned > area - 4.0 * band);
}

static void faces_clip_as_in_double(void **state) {
    (void)state;
    static const float tilts[] = {0.0f, 1e-6f, 1e-4f, 1e-3f};
    uint32_t reduced = 0;
    double least_share = 1.0;
    for (uint32_t i = 0; i < 40000u; i++) {
        one_pair(tilts[i % 4u], &reduced, &least_share);
    }
    print_message("%u of more than four corners; the least of the area that four of them span: %.3f\n", reduced,
                  least_share);
    assert_true(reduced > 1000u && least_share > 0.35);
}

int main(void) {
    brute_seed("box_clip_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(faces_clip_as_in_double)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
