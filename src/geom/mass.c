/* Masses of shapes, and masses moved and added.
 * Bodies of revolution about y with the profile r(y) have, at density 1 and with the integrals over y,
 *     volume pi r^2,  first moment pi y r^2,  along the axis pi r^4 / 2,  across it pi (r^4 / 4 + y^2 r^2),
 * which for balls' slices and cones are polynomials. The hull of two balls is a slice of each and, between the circles
 * in which the cone that wraps them touches them, a cut cone. Sums are in double; units: SI. */
#include "geom/mass.h"

#include "geom/double3.h"

#define PI 3.14159265358979323846

static int in_range(float x) { return x >= TALUS_MIN_SIZE && x <= TALUS_MAX_SIZE; }

static talus_status check_hull(const talus_geometry *g, const void *region, size_t region_bytes) {
    if (!region || g->hull % TALUS_BLOB_ALIGNMENT || g->hull >= region_bytes) {
        return TALUS_BAD_BLOB;
    }
    return talus_hull_validate((const unsigned char *)region + g->hull, region_bytes - g->hull);
}

talus_status tl_geometry_check(const talus_geometry *g, const void *region, size_t region_bytes) {
    if (!g) {
        return TALUS_BAD_ARGUMENT;
    }
    int finite = 1, good = 0;
    switch (g->type) {
    case TALUS_SPHERE:
        finite = tl_is_finite(g->radius);
        good = in_range(g->radius);
        break;
    case TALUS_CAPSULE:
        finite = tl_is_finite(g->half_height) && tl_is_finite(g->radius_top) && tl_is_finite(g->radius_bottom);
        good = (g->half_height == 0.0f || in_range(g->half_height)) && in_range(g->radius_top) &&
               in_range(g->radius_bottom);
        break;
    case TALUS_CYLINDER:
        finite = tl_is_finite(g->half_height) && tl_is_finite(g->radius_top) && tl_is_finite(g->radius_bottom);
        good = in_range(g->half_height) && (g->radius_top == 0.0f || in_range(g->radius_top)) &&
               (g->radius_bottom == 0.0f || in_range(g->radius_bottom)) &&
               (g->radius_top > 0.0f || g->radius_bottom > 0.0f);
        break;
    case TALUS_BOX:
        finite = tl_is_finite3(g->half);
        good = in_range(g->half.x) && in_range(g->half.y) && in_range(g->half.z);
        break;
    case TALUS_HULL:
        return check_hull(g, region, region_bytes);
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        break;
    }
    return !finite ? TALUS_NOT_FINITE : good ? TALUS_OK : TALUS_BAD_SHAPE;
}

const talus_hull *tl_geometry_hull(const talus_geometry *g, const void *region) {
    const unsigned char *bytes = region;
    return region == NULL ? NULL : (const talus_hull *)(const void *)(bytes + g->hull);
}

/* A body of revolution about y: volume, first moment of y, and the second moments about the axis and about a line
 * across it through y = 0. */
typedef struct revolved {
    double volume, first, along, across;
} revolved;

/* Adds a part whose integrals were taken about y = at. */
static void add_part(revolved *sum, revolved part, double at) {
    sum->volume += part.volume;
    sum->first += part.first + at * part.volume;
    sum->along += part.along;
    sum->across += part.across + 2.0 * at * part.first + at * at * part.volume;
}

static double ball_r2(double radius, double y) { return (radius - y) * (radius + y); }

/* The slice of a ball around y = 0 between y = a and y = b. The integrands are polynomials of degree 4, for which
 * Gauss's rule with three points is exact and, unlike the differences of powers, exact to the last digits for a thin
 * slice too. */
static revolved ball_slice(double radius, double a, double b) {
    static const double node[3] = {-0.77459666924148337704, 0.0, 0.77459666924148337704};
    static const double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    revolved s = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < 3; ++i) {
        double y = 0.5 * (a + b) + 0.5 * (b - a) * node[i], w = PI * (b - a) * weight[i], r2 = ball_r2(radius, y);
        s.volume += w * r2;
        s.first += w * r2 * y;
        s.along += w * r2 * r2 * 0.5;
        s.across += w * r2 * (0.25 * r2 + y * y);
    }
    return s;
}

/* The cut cone of radii a at y = -h and b at y = h. */
static revolved cut_cone(double h, double a, double b) {
    double a2 = a * a, b2 = b * b, ab = a * b, square = a2 + ab + b2;
    double fourth = (a2 * a2 + a2 * ab + ab * ab + ab * b2 + b2 * b2) / 5.0; /* the mean of r^4 */
    revolved s;
    s.volume = PI * 2.0 * h * square / 3.0;
    s.first = PI * h * h * (b - a) * (b + a) / 3.0;
    s.along = PI * h * fourth;
    s.across = PI * h * fourth * 0.5 + PI * h * h * h * (4.0 * a2 + 2.0 * ab + 4.0 * b2) / 15.0;
    return s;
}

static revolved capsule(const talus_geometry *g) {
    double h = (double)g->half_height, a = (double)g->radius_bottom, b = (double)g->radius_top;
    revolved s = {0.0, 0.0, 0.0, 0.0};
    if (2.0 * h <= tl_d_abs(a - b)) {
        double r = tl_d_max(a, b);
        add_part(&s, ball_slice(r, -r, r), a > b ? -h : h);
        return s;
    }
    /* The cone's normal leans towards the smaller ball: its sine is the slope of the radius. */
    double sine = (a - b) / (2.0 * h), cosine = tl_d_sqrt((1.0 - sine) * (1.0 + sine));
    double low = a * sine - h, high = b * sine + h;
    add_part(&s, ball_slice(a, -a, a * sine), -h);
    add_part(&s, ball_slice(b, b * sine, b), h);
    add_part(&s, cut_cone(0.5 * (high - low), a * cosine, b * cosine), 0.5 * (low + high));
    return s;
}

typedef struct exact_mass {
    double mass, inertia[3]; /* about the centre, along the axes */
    tl_d3 center;
} exact_mass;

static exact_mass from_revolved(revolved s, double density) {
    double y = s.first / s.volume, across = s.across - s.first * y;
    exact_mass m = {density * s.volume, {density * across, density * s.along, density * across}, {0.0, y, 0.0}};
    return m;
}

static exact_mass of_box(tl_d3 half, double density) {
    double m = density * 8.0 * half.x * half.y * half.z;
    double xx = half.x * half.x, yy = half.y * half.y, zz = half.z * half.z;
    exact_mass r = {m, {m * (yy + zz) / 3.0, m * (xx + zz) / 3.0, m * (xx + yy) / 3.0}, {0.0, 0.0, 0.0}};
    return r;
}

static exact_mass of_ball(double r, double density) {
    double m = density * PI * r * r * r * 4.0 / 3.0, i = m * r * r * 0.4;
    exact_mass b = {m, {i, i, i}, {0.0, 0.0, 0.0}};
    return b;
}

static talus_mass rounded(const exact_mass *e) {
    talus_mass m;
    m.mass = (float)e->mass;
    m.center = tl_d_round(e->center);
    m.inertia.x = tl_v((float)e->inertia[0], 0.0f, 0.0f);
    m.inertia.y = tl_v(0.0f, (float)e->inertia[1], 0.0f);
    m.inertia.z = tl_v(0.0f, 0.0f, (float)e->inertia[2]);
    return m;
}

talus_status talus_geometry_mass(const talus_geometry *geometry, const void *geometry_region, size_t region_bytes,
                                 float density, talus_mass *out) {
    if (!geometry || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    if (!tl_is_finite(density)) {
        return TALUS_NOT_FINITE;
    }
    if (density < 0.0f) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = tl_geometry_check(geometry, geometry_region, region_bytes);
    if (status != TALUS_OK) {
        return status;
    }
    talus_mass m;
    double d = (double)density;
    if (geometry->type == TALUS_HULL) {
        m = talus_hull_mass(tl_geometry_hull(geometry, geometry_region), density);
    } else {
        exact_mass e;
        if (geometry->type == TALUS_SPHERE) {
            e = of_ball((double)geometry->radius, d);
        } else if (geometry->type == TALUS_BOX) {
            e = of_box(tl_d_from(geometry->half), d);
        } else if (geometry->type == TALUS_CAPSULE) {
            e = from_revolved(capsule(geometry), d);
        } else {
            e = from_revolved(
                cut_cone((double)geometry->half_height, (double)geometry->radius_bottom, (double)geometry->radius_top),
                d);
        }
        m = rounded(&e);
    }
    if (!tl_is_finite(m.mass) || !tl_is_finite3(m.center) || !tl_is_finite_mat3(&m.inertia)) {
        return TALUS_BAD_SHAPE;
    }
    if (density > 0.0f && !(m.mass > 0.0f && m.inertia.x.x > 0.0f && m.inertia.y.y > 0.0f && m.inertia.z.z > 0.0f)) {
        return TALUS_BAD_SHAPE;
    }
    *out = m;
    return TALUS_OK;
}

/* Adds to a tensor that of a mass at d from the point it is taken about. */
static void add_point_mass(double t[6], double mass, tl_d3 d) {
    t[0] += mass * (d.y * d.y + d.z * d.z);
    t[1] += mass * (d.x * d.x + d.z * d.z);
    t[2] += mass * (d.x * d.x + d.y * d.y);
    t[3] -= mass * d.x * d.y;
    t[4] -= mass * d.x * d.z;
    t[5] -= mass * d.y * d.z;
}

static void add_tensor(double t[6], const talus_mat3 *m) {
    t[0] += (double)m->x.x;
    t[1] += (double)m->y.y;
    t[2] += (double)m->z.z;
    t[3] += 0.5 * ((double)m->x.y + (double)m->y.x);
    t[4] += 0.5 * ((double)m->x.z + (double)m->z.x);
    t[5] += 0.5 * ((double)m->y.z + (double)m->z.y);
}

static talus_mat3 to_matrix(const double t[6]) {
    float xy = (float)t[3], xz = (float)t[4], yz = (float)t[5];
    talus_mat3 m = {{(float)t[0], xy, xz}, {xy, (float)t[1], yz}, {xz, yz, (float)t[2]}};
    return m;
}

talus_mass talus_mass_move(const talus_mass *mass, const talus_pose *pose) {
    talus_mass m;
    m.mass = mass->mass;
    m.center = tl_pose_point(pose, mass->center);
    talus_mat3 r = tl_mat3_from_quat(pose->rotation), rt = tl_mat3_transpose(&r);
    tl_d3 row[3] = {tl_d_from(rt.x), tl_d_from(rt.y), tl_d_from(rt.z)};
    double t[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add_tensor(t, &mass->inertia);
    /* R I R^T: I times each row of R, then that row by row. */
    tl_d3 turned[3];
    for (int i = 0; i < 3; ++i) {
        tl_d3 v = row[i];
        turned[i] = tl_d(t[0] * v.x + t[3] * v.y + t[4] * v.z, t[3] * v.x + t[1] * v.y + t[5] * v.z,
                         t[4] * v.x + t[5] * v.y + t[2] * v.z);
    }
    double u[6] = {tl_d_dot(row[0], turned[0]), tl_d_dot(row[1], turned[1]), tl_d_dot(row[2], turned[2]),
                   tl_d_dot(row[0], turned[1]), tl_d_dot(row[0], turned[2]), tl_d_dot(row[1], turned[2])};
    m.inertia = to_matrix(u);
    return m;
}

talus_mass talus_mass_add(const talus_mass *a, const talus_mass *b) {
    talus_mass m;
    tl_d3 ca = tl_d_from(a->center), cb = tl_d_from(b->center);
    double ma = (double)a->mass, mb = (double)b->mass, sum = ma + mb;
    /* Massless parts have no say; two of them meet half way. */
    double share = sum > 0.0 ? mb / sum : 0.5;
    tl_d3 between = tl_d_sub(cb, ca);
    double t[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add_tensor(t, &a->inertia);
    add_tensor(t, &b->inertia);
    add_point_mass(t, ma * share, between);
    m.mass = (float)sum;
    m.center = tl_d_round(tl_d_add(ca, tl_d_scale(between, share)));
    m.inertia = to_matrix(t);
    return m;
}
