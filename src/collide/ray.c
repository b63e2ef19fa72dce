/* A line and a convex shape have one span in common: between two planes of a box, two roots of a quadric, or what the
 * half-spaces of a hull leave (Cyrus & Beck, Generalized two- and three-dimensional clipping, Computers & Graphics 3,
 * 1978). Lines are counted from their point closest to the shape's centre, so that nothing large is subtracted from
 * something large. Metres, in the shape's frame. */
#include "collide/ray.h"

#define ENDLESS 1e300

/* p + s u for s from `from` to `to`, u of unit length. */
typedef struct span {
    double from, to;
    tl_d3 normal; /* of the surface at `from`; not of unit length */
} span;

static tl_d3 along(tl_d3 p, tl_d3 u, double s) { return tl_d_add(p, tl_d_scale(u, s)); }

static int meets_ball(tl_d3 center, double radius, tl_d3 p, tl_d3 u, span *out) {
    tl_d3 q = tl_d_sub(p, center);
    double b = tl_d_dot(q, u);
    tl_d3 aside = along(q, u, -b);
    double rest = radius * radius - tl_d_dot(aside, aside);
    if (!(rest >= 0.0)) {
        return 0;
    }
    double half = tl_d_sqrt(rest);
    out->from = -b - half;
    out->to = -b + half;
    out->normal = along(aside, u, -half);
    return 1;
}

/* Leaves of a span what is between two planes across an axis; `n` is the axis. */
static int cut_slab(double p, double u, double low, double high, tl_d3 n, span *out) {
    if (u == 0.0) {
        return p >= low && p <= high;
    }
    double a = (low - p) / u, b = (high - p) / u, from = u > 0.0 ? a : b, to = u > 0.0 ? b : a;
    if (from > out->from) {
        out->from = from;
        out->normal = u > 0.0 ? tl_d_scale(n, -1.0) : n;
    }
    out->to = tl_d_min(out->to, to);
    return out->from <= out->to;
}

static int meets_box(talus_vec3 half, tl_d3 p, tl_d3 u, span *out) {
    double x = (double)half.x, y = (double)half.y, z = (double)half.z;
    out->from = -ENDLESS;
    out->to = ENDLESS;
    return cut_slab(p.x, u.x, -x, x, tl_d(1.0, 0.0, 0.0), out) && cut_slab(p.y, u.y, -y, y, tl_d(0.0, 1.0, 0.0), out) &&
           cut_slab(p.z, u.z, -z, z, tl_d(0.0, 0.0, 1.0), out);
}

static int meets_hull(const talus_hull *h, tl_d3 p, tl_d3 u, span *out) {
    const float *nx = tl_hull_planes(h), *ny = nx + h->face_stride, *nz = ny + h->face_stride, *d = nz + h->face_stride;
    uint32_t face = 0;
    out->from = -ENDLESS;
    out->to = ENDLESS;
    for (uint32_t f = 0; f < h->face_count; ++f) {
        tl_d3 n = tl_d((double)nx[f], (double)ny[f], (double)nz[f]);
        double speed = tl_d_dot(n, u), room = (double)d[f] - tl_d_dot(n, p);
        if (speed < 0.0) {
            if (room < speed * out->from) { /* that is, room / speed > from */
                out->from = room / speed;
                face = f;
            }
        } else if (speed > 0.0) {
            if (room < speed * out->to) {
                out->to = room / speed;
            }
        } else if (room < 0.0) {
            return 0;
        }
        if (out->from > out->to) {
            return 0;
        }
    }
    out->normal = tl_d((double)nx[face], (double)ny[face], (double)nz[face]);
    return 1;
}

/* A cylinder or cut cone about y with its bottom and top circles: the quadric x^2 + z^2 <= r(y)^2 of which the slab
 * leaves the nappe where r >= 0. */
static int meets_cone(double y0, double r0, double y1, double r1, tl_d3 p, tl_d3 u, span *out) {
    double k = (r1 - r0) / (y1 - y0), a = r0 + k * (p.y - y0), b = k * u.y; /* r along the line: a + b s */
    double square = u.x * u.x + u.z * u.z - b * b, middle = p.x * u.x + p.z * u.z - a * b,
           rest = p.x * p.x + p.z * p.z - a * a, inner = middle * middle - square * rest;
    out->from = -ENDLESS;
    out->to = ENDLESS;
    if (inner < 0.0) {
        if (square >= 0.0) {
            return 0;
        }
        inner = 0.0; /* through the apex, but for rounding */
    }
    double q = -(middle + (middle < 0.0 ? -tl_d_sqrt(inner) : tl_d_sqrt(inner)));
    if (q == 0.0) { /* along the surface or across the apex */
        if (rest > 0.0) {
            return 0;
        }
        if (square > 0.0) {
            out->from = out->to = 0.0;
        }
    } else if (square > 0.0) {
        double one = q / square, two = rest / q;
        out->from = tl_d_max(tl_d_min(one, two), -ENDLESS);
        out->to = tl_d_min(tl_d_max(one, two), ENDLESS);
    } else if (square < 0.0) {
        double one = q / square, two = rest / q;
        if (b > 0.0) {
            out->from = tl_d_max(one, two);
        } else {
            out->to = tl_d_min(one, two);
        }
    } else if (middle > 0.0) {
        out->to = rest / q;
    } else {
        out->from = rest / q;
    }
    double side = out->from;
    if (out->from > out->to || !cut_slab(p.y, u.y, y0, y1, tl_d(0.0, 1.0, 0.0), out)) {
        return 0;
    }
    if (out->from == side) { /* it enters by the side, not by an end */
        tl_d3 at = along(p, u, side);
        double across = tl_d_sqrt(at.x * at.x + at.z * at.z);
        out->normal = across > 0.0 ? tl_d(at.x / across, -k, at.z / across) : tl_d(0.0, k > 0.0 ? -1.0 : 1.0, 0.0);
    }
    return 1;
}

static void join(span *all, int *any, const span *one) {
    if (!*any || one->from < all->from) {
        all->from = one->from;
        all->normal = one->normal;
    }
    all->to = *any ? tl_d_max(all->to, one->to) : one->to;
    *any = 1;
}

/* Two balls and the cone between the circles in which it touches both: convex, so that the spans join to one. */
static int meets_capsule(const talus_geometry *g, tl_d3 p, tl_d3 u, span *out) {
    double h = (double)g->half_height, top = (double)g->radius_top, bottom = (double)g->radius_bottom;
    tl_d3 up = tl_d(0.0, h, 0.0), down = tl_d(0.0, -h, 0.0);
    if (tl_d_abs(top - bottom) >= 2.0 * h) { /* one ball holds the other */
        return meets_ball(top > bottom ? up : down, tl_d_max(top, bottom), p, u, out);
    }
    double sine = (bottom - top) / (2.0 * h), cosine = tl_d_sqrt(1.0 - sine * sine);
    int any = 0;
    span one;
    if (meets_ball(up, top, p, u, &one)) {
        join(out, &any, &one);
    }
    if (meets_ball(down, bottom, p, u, &one)) {
        join(out, &any, &one);
    }
    if (meets_cone(bottom * sine - h, bottom * cosine, h + top * sine, top * cosine, p, u, &one)) {
        join(out, &any, &one);
    }
    return any;
}

/* A ball around the shape: its centre and its radius. */
static double around(const tl_convex *shape, tl_d3 *center) {
    const talus_geometry *g = &shape->geometry;
    *center = tl_d(0.0, 0.0, 0.0);
    switch (g->type) {
    case TALUS_SPHERE:
        return (double)g->radius;
    case TALUS_CAPSULE:
    case TALUS_CYLINDER:
        return (double)g->half_height + tl_d_max((double)g->radius_top, (double)g->radius_bottom);
    case TALUS_BOX:
        return tl_d_length(tl_d_from(g->half));
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        *center = tl_d_from(shape->hull->centroid);
        return (double)shape->hull->outer_radius;
    }
}

static int meets(const tl_convex *shape, tl_d3 p, tl_d3 u, span *out) {
    const talus_geometry *g = &shape->geometry;
    switch (g->type) {
    case TALUS_SPHERE:
        return meets_ball(tl_d(0.0, 0.0, 0.0), (double)g->radius, p, u, out);
    case TALUS_CAPSULE:
        return meets_capsule(g, p, u, out);
    case TALUS_CYLINDER:
        return meets_cone((double)-g->half_height, (double)g->radius_bottom, (double)g->half_height,
                          (double)g->radius_top, p, u, out);
    case TALUS_BOX:
        return meets_box(g->half, p, u, out);
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        return meets_hull(shape->hull, p, u, out);
    }
}

int tl_ray_convex(const tl_convex *shape, const talus_pose *pose, tl_d3 origin, tl_d3 way, tl_ray_hit *out) {
    tl_frame frame = tl_frame_of(pose);
    tl_d3 o = tl_frame_point_back(&frame, origin), u = tl_frame_turn_back(&frame, way), center;
    double length = tl_d_length(u), radius = 1.00001 * around(shape, &center);
    u = length > 0.0 ? tl_d_scale(u, 1.0 / length) : tl_d(0.0, 1.0, 0.0);
    tl_d3 aside = tl_d_sub(o, center);
    double start = tl_d_dot(aside, u); /* the origin, counted from the closest point */
    aside = along(aside, u, -start);
    span s;
    if (!(tl_d_dot(aside, aside) <= radius * radius) || start > radius || start + length < -radius ||
        !meets(shape, tl_d_add(center, aside), u, &s) || s.to < start || s.from > start + length) {
        return 0;
    }
    out->within = s.from <= start;
    out->at = out->within ? 0.0 : tl_d_min((s.from - start) / length, 1.0);
    out->normal = tl_d(0.0, 0.0, 0.0);
    if (!out->within) {
        tl_d3 n = tl_frame_turn(&frame, s.normal);
        out->normal = tl_d_scale(n, 1.0 / tl_d_length(n));
    }
    return 1;
}
