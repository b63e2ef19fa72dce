/* Balls against every shape: the signed distance of a point. Cylinders and capsules are worked out in the half plane
 * through their axis; the distance to a hull of two balls is the least over the balls between them, whose place is
 * known in closed form (Barbier & Galin, Fast Distance Computation Between a Point and Cylinders, Cones, Line-Swept
 * Spheres and Cone-Spheres, 2004). Metres. */
#include "collide/round.h"

/* The distance along v, which is (radial, y) in the half plane, turned back into space. */
static talus_vec3 from_half_plane(talus_vec3 p, float radial, float x, float y) {
    if (!(radial > 1e-30f)) {
        return tl_normalize_or(tl_v(x, y, 0.0f), tl_v(1.0f, 0.0f, 0.0f));
    }
    return tl_normalize_or(tl_v(x * (p.x / radial), y, x * (p.z / radial)), tl_v(1.0f, 0.0f, 0.0f));
}

static float radius_of(talus_vec3 p) {
    float s = tl_max(tl_abs(p.x), tl_abs(p.z));
    if (!(s > 1e-30f)) {
        return 0.0f;
    }
    float x = p.x / s, z = p.z / s;
    return s * sqrtf(x * x + z * z);
}

static float capsule_distance(const talus_geometry *g, talus_vec3 p, talus_vec3 *n) {
    float length = 2.0f * g->half_height, k = g->radius_top - g->radius_bottom;
    float radial = radius_of(p), along = p.y + g->half_height, t = 0.0f;
    if (tl_abs(k) >= length) {
        t = k > 0.0f ? 1.0f : 0.0f; /* one ball holds the other */
    } else {
        float s = k / length;
        t = tl_clamp((along + radial * s / sqrtf(1.0f - s * s)) / length, 0.0f, 1.0f);
    }
    float y = along - t * length, distance = sqrtf(radial * radial + y * y);
    *n = from_half_plane(p, radial, radial, y);
    return distance - (g->radius_bottom + t * k);
}

static float cylinder_distance(const talus_geometry *g, talus_vec3 p, talus_vec3 *n) {
    float h = g->half_height, rb = g->radius_bottom, rt = g->radius_top;
    float rise = 2.0f * h, in = rb - rt, length = sqrtf(rise * rise + in * in), radial = radius_of(p);
    float cap = tl_abs(p.y) - h, sign = p.y >= 0.0f ? 1.0f : -1.0f;
    float side = ((radial - rb) * rise + (p.y + h) * in) / length;
    if ((cap <= 0.0f && side <= 0.0f && cap >= side) || (cap > 0.0f && radial <= (p.y >= 0.0f ? rt : rb))) {
        *n = tl_v(0.0f, sign, 0.0f);
        return cap;
    }
    float t = ((p.y + h) * rise - (radial - rb) * in) / (length * length);
    if (side <= 0.0f && cap <= 0.0f) {
        *n = from_half_plane(p, radial, rise, in);
        return side;
    }
    if (t > 0.0f && t < 1.0f) {
        *n = from_half_plane(p, radial, rise, in);
        return side;
    }
    float x = radial - (t <= 0.0f ? rb : rt), y = t <= 0.0f ? p.y + h : p.y - h;
    *n = from_half_plane(p, radial, x, y);
    return sqrtf(x * x + y * y);
}

static float box_distance(talus_vec3 half, talus_vec3 p, talus_vec3 *n) {
    talus_vec3 q = tl_sub(tl_abs3(p), half);
    talus_vec3 sign = tl_v(p.x >= 0.0f ? 1.0f : -1.0f, p.y >= 0.0f ? 1.0f : -1.0f, p.z >= 0.0f ? 1.0f : -1.0f);
    if (q.x <= 0.0f && q.y <= 0.0f && q.z <= 0.0f) {
        int axis = q.x >= q.y ? (q.x >= q.z ? 0 : 2) : (q.y >= q.z ? 1 : 2);
        *n = tl_v(axis == 0 ? sign.x : 0.0f, axis == 1 ? sign.y : 0.0f, axis == 2 ? sign.z : 0.0f);
        return axis == 0 ? q.x : axis == 1 ? q.y : q.z;
    }
    q = tl_v(tl_max(q.x, 0.0f), tl_max(q.y, 0.0f), tl_max(q.z, 0.0f));
    *n = tl_normalize_or(tl_mul(q, sign), sign);
    return tl_dot(*n, tl_mul(q, sign));
}

/* Whether the foot of p on a face lies inside of it. */
static int over_face(const talus_hull *hull, uint32_t face, talus_vec3 p) {
    const tl_half_edge *edges = tl_hull_edges(hull);
    talus_vec3 n = tl_hull_normal(hull, face);
    uint32_t first = tl_hull_face_edge(hull)[face], e = first;
    talus_vec3 from = tl_hull_point(hull, edges[e].origin);
    do {
        e = edges[e].next;
        talus_vec3 to = tl_hull_point(hull, edges[e].origin);
        if (tl_dot(tl_cross(n, tl_sub(to, from)), tl_sub(p, from)) < 0.0f) {
            return 0;
        }
        from = to;
    } while (e != first);
    return 1;
}

static int hull_distance(const talus_hull *hull, talus_vec3 p, float *distance, talus_vec3 *n) {
    const float *nx = tl_hull_planes(hull);
    uint32_t stride = hull->face_stride;
    float best[8] = {-3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f, -3e38f};
    int32_t at[8] = {0};
    for (uint32_t i = 0; i < stride; i += 8) {
        for (uint32_t k = 0; k < 8; ++k) {
            const float *f = nx + i + k;
            float s = f[0] * p.x + f[stride] * p.y + f[2u * stride] * p.z - f[3u * stride];
            int better = s > best[k];
            at[k] = better ? (int32_t)(i + k) : at[k];
            best[k] = better ? s : best[k];
        }
    }
    for (uint32_t k = 1; k < 8; ++k) {
        if (best[k] > best[0] || (best[k] == best[0] && at[k] < at[0])) {
            best[0] = best[k];
            at[0] = at[k];
        }
    }
    uint32_t face = (uint32_t)at[0] < hull->face_count ? (uint32_t)at[0] : hull->face_count - 1u;
    *distance = best[0];
    *n = tl_hull_normal(hull, face);
    return best[0] <= 0.0f || over_face(hull, face, p);
}

int tl_point_distance(const tl_convex *shape, talus_vec3 p, float *distance, talus_vec3 *normal) {
    switch (shape->geometry.type) {
    case TALUS_SPHERE:
        *normal = tl_normalize_or(p, tl_v(0.0f, 1.0f, 0.0f));
        *distance = tl_dot(*normal, p) - shape->geometry.radius;
        return 1;
    case TALUS_CAPSULE:
        *distance = capsule_distance(&shape->geometry, p, normal);
        return 1;
    case TALUS_CYLINDER:
        *distance = cylinder_distance(&shape->geometry, p, normal);
        return 1;
    case TALUS_BOX:
        *distance = box_distance(shape->geometry.half, p, normal);
        return 1;
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        return hull_distance(shape->hull, p, distance, normal);
    }
}

void tl_collide_ball(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                     tl_pair_cache *cache, tl_manifold *out) {
    talus_vec3 center = b_in_a->position, n;
    float radius = b->geometry.radius, distance = 0.0f;
    int known = tl_point_distance(a, center, &distance, &n);
    out->count = 0;
    out->normal = n;
    out->gap = distance - radius;
    if (out->gap > margin) {
        return;
    }
    if (!known) {
        tl_core ca, cb;
        tl_core_init(&ca, a, NULL);
        tl_core_init(&cb, b, b_in_a);
        tl_collide_general(&ca, &cb, margin, cache, out);
        return;
    }
    out->count = 1;
    out->point[0].separation = distance - radius;
    out->point[0].position = tl_mad(center, -0.5f * (distance + radius), n);
    out->point[0].id = 0;
}
