/* Support points of convex cores, and boxes around shapes. A hull of few vertices is scanned eight at a time; on a
 * large one the search climbs from vertex to neighbour (van den Bergen, Collision Detection in Interactive 3D
 * Environments, 4.3.4). Lengths in metres. */
#include "collide/support.h"

#include "collide/lanes.h"
#include "geom/hull_climb.h"

void tl_core_init(tl_core *core, const tl_convex *shape, const talus_pose *pose) {
    const talus_geometry *g = &shape->geometry;
    core->placed = pose != NULL;
    if (pose != NULL) {
        core->r = tl_mat3_from_quat(pose->rotation);
        core->t = pose->position;
    }
    core->half_height = 0.0f;
    core->top = 0.0f;
    core->bottom = 0.0f;
    core->radius = 0.0f;
    core->half = tl_v(0.0f, 0.0f, 0.0f);
    core->hull = NULL;
    switch (g->type) {
    case TALUS_SPHERE:
        core->kind = TL_CORE_POINT;
        core->radius = g->radius;
        core->size = g->radius;
        break;
    case TALUS_CAPSULE:
        core->radius = tl_min(g->radius_top, g->radius_bottom);
        core->top = g->radius_top - core->radius;
        core->bottom = g->radius_bottom - core->radius;
        core->half_height = g->half_height;
        core->kind = core->top != core->bottom ? TL_CORE_DROP : TL_CORE_SEGMENT;
        core->size = g->half_height + tl_max(g->radius_top, g->radius_bottom);
        break;
    case TALUS_CYLINDER:
        core->kind = TL_CORE_FRUSTUM;
        core->top = g->radius_top;
        core->bottom = g->radius_bottom;
        core->half_height = g->half_height;
        core->size = g->half_height + tl_max(g->radius_top, g->radius_bottom);
        break;
    case TALUS_BOX:
        core->kind = TL_CORE_BOX;
        core->half = g->half;
        core->size = tl_length(g->half);
        break;
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        core->kind = TL_CORE_HULL;
        core->hull = shape->hull;
        core->size = tl_abs(shape->hull->centroid.x) + tl_abs(shape->hull->centroid.y) +
                     tl_abs(shape->hull->centroid.z) + shape->hull->outer_radius;
        break;
    }
}

/* The lowest index among the best, which is what a plain scan would find. */
static uint32_t scan(const talus_hull *hull, talus_vec3 d) {
    const float *x = tl_hull_x(hull), *y = tl_hull_y(hull), *z = tl_hull_z(hull);
    tl_f8 dot[TL_HULL_SCANNED / 8u], dx = tl_f8_set1(d.x), dy = tl_f8_set1(d.y), dz = tl_f8_set1(d.z);
    uint32_t blocks = hull->vertex_stride / 8u;
    tl_f8 best = tl_f8_set1(-3e38f);
    for (uint32_t i = 0; i < blocks; ++i) {
        dot[i] = tl_f8_add(tl_f8_add(tl_f8_mul(tl_f8_loadu(x + 8u * i), dx), tl_f8_mul(tl_f8_loadu(y + 8u * i), dy)),
                           tl_f8_mul(tl_f8_loadu(z + 8u * i), dz));
        best = tl_f8_max(dot[i], best);
    }
    best = tl_f8_set1(tl_lanes_max(best));
    for (uint32_t i = 0; i < blocks; ++i) {
        uint32_t bits = tl_m8_bits(tl_f8_ge(dot[i], best));
        if (bits != 0u) {
            uint32_t v = 8u * i + tl_low_bit(bits);
            return v < hull->vertex_count ? v : hull->vertex_count - 1u;
        }
    }
    return 0;
}

uint32_t tl_hull_support(const talus_hull *hull, talus_vec3 direction, uint32_t start) {
    if (hull->vertex_count > TL_HULL_SCANNED) {
        int known = start > 0u && start < hull->vertex_count;
        return tl_hull_climb(hull, direction, known ? start : tl_hull_seed(hull, direction));
    }
    return scan(hull, direction);
}

static talus_vec3 frustum_support(const tl_core *core, talus_vec3 d) {
    float s = tl_max(tl_abs(d.x), tl_abs(d.z));
    float x = 0.0f, z = 0.0f, radial = 0.0f;
    if (s > 1e-30f) {
        float u = d.x / s, w = d.z / s, l = sqrtf(u * u + w * w);
        x = u / l;
        z = w / l;
        radial = s * l;
    }
    int top = core->half_height * d.y + core->top * radial >= core->bottom * radial - core->half_height * d.y;
    float r = top ? core->top : core->bottom;
    return tl_v(x * r, top ? core->half_height : -core->half_height, z * r);
}

static talus_vec3 drop_support(const tl_core *core, talus_vec3 d) {
    talus_vec3 u = tl_normalize_or(d, tl_v(0.0f, 1.0f, 0.0f));
    int top = core->half_height * u.y + core->top >= core->bottom - core->half_height * u.y;
    talus_vec3 p = tl_scale(u, top ? core->top : core->bottom);
    p.y += top ? core->half_height : -core->half_height;
    return p;
}

talus_vec3 tl_core_support_local(const tl_core *core, talus_vec3 d, uint32_t *index) {
    switch (core->kind) {
    case TL_CORE_SEGMENT:
        *index = d.y >= 0.0f;
        return tl_v(0.0f, d.y >= 0.0f ? core->half_height : -core->half_height, 0.0f);
    case TL_CORE_DROP:
        *index = 0;
        return drop_support(core, d);
    case TL_CORE_FRUSTUM:
        *index = 0;
        return frustum_support(core, d);
    case TL_CORE_BOX:
        *index = (d.x >= 0.0f ? 1u : 0u) | (d.y >= 0.0f ? 2u : 0u) | (d.z >= 0.0f ? 4u : 0u);
        return tl_box_corner(core->half, *index);
    case TL_CORE_HULL:
        *index = tl_hull_support(core->hull, d, *index);
        return tl_hull_point(core->hull, *index);
    case TL_CORE_POINT:
    default:
        *index = 0;
        return tl_v(0.0f, 0.0f, 0.0f);
    }
}

uint32_t tl_core_vertex_count(const tl_core *core) {
    switch (core->kind) {
    case TL_CORE_POINT:
        return 1;
    case TL_CORE_SEGMENT:
        return 2;
    case TL_CORE_BOX:
        return 8;
    case TL_CORE_HULL:
        return core->hull->vertex_count;
    case TL_CORE_DROP:
    case TL_CORE_FRUSTUM:
    default:
        return 0;
    }
}

talus_vec3 tl_core_vertex(const tl_core *core, uint32_t index) {
    talus_vec3 p = tl_v(0.0f, 0.0f, 0.0f);
    if (core->kind == TL_CORE_SEGMENT) {
        p.y = index ? core->half_height : -core->half_height;
    } else if (core->kind == TL_CORE_BOX) {
        p = tl_box_corner(core->half, index);
    } else if (core->kind == TL_CORE_HULL) {
        p = tl_hull_point(core->hull, index);
    }
    return tl_core_place(core, p);
}

talus_vec3 tl_core_support(const tl_core *core, talus_vec3 direction, uint32_t *index) {
    return tl_core_place(core, tl_core_support_local(core, tl_core_rotate_back(core, direction), index));
}

static talus_aabb aabb_around(talus_vec3 center, talus_vec3 reach) {
    talus_aabb box = {tl_sub(center, reach), tl_add(center, reach)};
    return box;
}

static talus_aabb hull_aabb(const talus_hull *hull, const talus_pose *pose, const talus_mat3 *m) {
    if (hull->vertex_count > TL_HULL_SCANNED) {
        talus_vec3 c = tl_scale(tl_add(hull->bounds.lower, hull->bounds.upper), 0.5f);
        talus_vec3 h = tl_scale(tl_sub(hull->bounds.upper, hull->bounds.lower), 0.5f);
        talus_vec3 reach =
            tl_add(tl_add(tl_abs3(tl_scale(m->x, h.x)), tl_abs3(tl_scale(m->y, h.y))), tl_abs3(tl_scale(m->z, h.z)));
        return aabb_around(tl_add(tl_mat3_mul(m, c), pose->position), reach);
    }
    talus_vec3 low = tl_mat3_mul(m, tl_hull_point(hull, 0)), high = low;
    for (uint32_t i = 1; i < hull->vertex_count; ++i) {
        talus_vec3 p = tl_mat3_mul(m, tl_hull_point(hull, i));
        low = tl_min3(low, p);
        high = tl_max3(high, p);
    }
    talus_aabb box = {tl_add(low, pose->position), tl_add(high, pose->position)};
    return box;
}

talus_aabb tl_convex_aabb(const tl_convex *shape, const talus_pose *pose) {
    const talus_geometry *g = &shape->geometry;
    talus_mat3 m = tl_mat3_from_quat(pose->rotation);
    talus_vec3 axis = tl_scale(m.y, g->half_height);
    talus_vec3 top = tl_add(pose->position, axis), bottom = tl_sub(pose->position, axis);
    switch (g->type) {
    case TALUS_SPHERE:
        return aabb_around(pose->position, tl_v(g->radius, g->radius, g->radius));
    case TALUS_CAPSULE:
    case TALUS_CYLINDER: {
        talus_vec3 reach = tl_v(1.0f, 1.0f, 1.0f);
        if (g->type == TALUS_CYLINDER) {
            /* of a disc of radius 1 across the axis */
            talus_vec3 s = tl_sub(reach, tl_mul(m.y, m.y));
            reach = tl_v(sqrtf(tl_max(s.x, 0.0f)), sqrtf(tl_max(s.y, 0.0f)), sqrtf(tl_max(s.z, 0.0f)));
        }
        talus_vec3 rt = tl_scale(reach, g->radius_top), rb = tl_scale(reach, g->radius_bottom);
        talus_aabb box = {tl_min3(tl_sub(top, rt), tl_sub(bottom, rb)), tl_max3(tl_add(top, rt), tl_add(bottom, rb))};
        return box;
    }
    case TALUS_BOX: {
        talus_vec3 reach = tl_add(tl_add(tl_abs3(tl_scale(m.x, g->half.x)), tl_abs3(tl_scale(m.y, g->half.y))),
                                  tl_abs3(tl_scale(m.z, g->half.z)));
        return aabb_around(pose->position, reach);
    }
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default:
        return hull_aabb(shape->hull, pose, &m);
    }
}
