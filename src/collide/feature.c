/* The supporting face, edge or point of a core along a direction. Discs become polygons of eight corners that turn with
 * their shape, the sides of cylinders, cones and capsules become segments. Metres. */
#include "collide/feature.h"

static void place(const tl_core *core, tl_feature *f) {
    if (core->placed) {
        f->normal = tl_mat3_mul(&core->r, f->normal);
        for (uint32_t i = 0; i < f->count; ++i) {
            f->point[i] = tl_core_place(core, f->point[i]);
        }
    }
}

static void set_point(tl_feature *f, talus_vec3 p, uint32_t id) {
    f->count = 1;
    f->point[0] = p;
    f->vertex[0] = (uint16_t)id;
    f->edge[0] = (uint16_t)id;
}

static void set_segment(tl_feature *f, talus_vec3 p, talus_vec3 q, uint32_t ip, uint32_t iq, uint32_t edge) {
    f->count = 2;
    f->point[0] = p;
    f->point[1] = q;
    f->vertex[0] = (uint16_t)ip;
    f->vertex[1] = (uint16_t)iq;
    f->edge[0] = (uint16_t)edge;
    f->edge[1] = (uint16_t)edge;
}

/* An edge of a box has the number of its lower corner and 8 times its axis. */
static uint32_t box_edge(uint32_t p, uint32_t q) {
    uint32_t bit = p ^ q;
    return (p & q) + (bit == 1u ? 0u : bit == 2u ? 8u : 16u);
}

static void box_face_local(talus_vec3 half, int axis, int positive, tl_feature *f) {
    static const uint8_t corner[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const uint8_t *c = corner[2 * axis + positive];
    float s = positive ? 1.0f : -1.0f;
    f->normal = tl_v(axis == 0 ? s : 0.0f, axis == 1 ? s : 0.0f, axis == 2 ? s : 0.0f);
    f->count = 4;
    for (uint32_t i = 0; i < 4; ++i) {
        f->point[i] = tl_box_corner(half, c[i]);
        f->vertex[i] = c[i];
        f->edge[i] = (uint16_t)box_edge(c[i], c[(i + 1u) & 3u]);
    }
}

static void box_feature(const tl_core *core, talus_vec3 d, int strict, tl_feature *f) {
    talus_vec3 m = tl_abs3(d);
    int axis = m.x >= m.y ? (m.x >= m.z ? 0 : 2) : (m.y >= m.z ? 1 : 2);
    float most = axis == 0 ? m.x : axis == 1 ? m.y : m.z;
    float along = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
    if (!strict || most >= TL_FACE_COS) {
        box_face_local(core->half, axis, along >= 0.0f, f);
        return;
    }
    uint32_t i;
    talus_vec3 p = tl_core_support_local(core, d, &i);
    uint32_t bit = m.x <= m.y ? (m.x <= m.z ? 1u : 4u) : (m.y <= m.z ? 2u : 4u);
    float least = bit == 1u ? m.x : bit == 2u ? m.y : m.z;
    if (least <= TL_EDGE_SIN) {
        uint32_t low = i & ~bit, high = i | bit;
        set_segment(f, tl_box_corner(core->half, low), tl_box_corner(core->half, high), low, high, box_edge(low, high));
        return;
    }
    set_point(f, p, i);
}

static void hull_face_local(const talus_hull *hull, uint32_t face, tl_feature *f) {
    const tl_half_edge *edges = tl_hull_edges(hull);
    uint32_t first = tl_hull_face_edge(hull)[face], e = first, corners = 0;
    f->normal = tl_hull_normal(hull, face);
    f->count = 0;
    do {
        if (corners < TL_FEATURE_POINTS) {
            f->point[corners] = tl_hull_point(hull, edges[e].origin);
            f->vertex[corners] = edges[e].origin;
            f->edge[corners] = (uint16_t)(e >> 1);
        }
        ++corners;
        e = edges[e].next;
    } while (e != first);
    if (corners <= TL_FEATURE_POINTS) {
        f->count = corners;
        return;
    }
    uint32_t step = (corners + TL_FEATURE_POINTS - 1u) / TL_FEATURE_POINTS;
    for (uint32_t i = 0; i < corners; ++i) {
        if (i % step == 0) {
            f->point[f->count] = tl_hull_point(hull, edges[e].origin);
            f->vertex[f->count] = edges[e].origin;
            f->edge[f->count] = (uint16_t)(e >> 1);
            ++f->count;
        }
        e = edges[e].next;
    }
}

void tl_feature_face(const tl_core *core, uint32_t face, tl_feature *out) {
    if (core->kind == TL_CORE_BOX) {
        box_face_local(core->half, (int)(face >> 1), (int)(face & 1u), out);
    } else {
        hull_face_local(core->hull, face, out);
    }
    place(core, out);
}

void tl_feature_edge(const tl_core *core, uint32_t from, uint32_t to, uint32_t edge, tl_feature *out) {
    out->normal = tl_v(0.0f, 0.0f, 0.0f);
    if (core->kind == TL_CORE_BOX) {
        set_segment(out, tl_box_corner(core->half, from), tl_box_corner(core->half, to), from, to, box_edge(from, to));
    } else {
        set_segment(out, tl_hull_point(core->hull, from), tl_hull_point(core->hull, to), from, to, edge);
    }
    place(core, out);
}

/* Of the faces around vertex v the one that looks along d the most. */
static uint32_t hull_face_along(const talus_hull *hull, talus_vec3 d, uint32_t v) {
    const float *n = tl_hull_planes(hull);
    const tl_half_edge *edges = tl_hull_edges(hull);
    uint32_t stride = hull->face_stride, first = tl_hull_vertex_edge(hull)[v], e = first, best = 0;
    float most = -2.0f;
    do {
        uint32_t face = edges[e].face;
        float s = n[face] * d.x + n[stride + face] * d.y + n[2u * stride + face] * d.z;
        best = s > most ? face : best;
        most = tl_max(s, most);
        e = edges[tl_hull_twin(e)].next;
    } while (e != first);
    return best;
}

static void hull_feature(const tl_core *core, talus_vec3 d, int strict, tl_feature *f) {
    const talus_hull *hull = core->hull;
    uint32_t v = tl_hull_support(hull, d, 0), face = hull_face_along(hull, d, v);
    if (!strict || tl_dot(tl_hull_normal(hull, face), d) >= TL_FACE_COS) {
        hull_face_local(hull, face, f);
        return;
    }
    const tl_half_edge *edges = tl_hull_edges(hull);
    talus_vec3 p = tl_hull_point(hull, v);
    uint32_t first = tl_hull_vertex_edge(hull)[v], e = first, best = first;
    float least = 2.0f;
    do {
        talus_vec3 along = tl_sub(tl_hull_point(hull, edges[tl_hull_twin(e)].origin), p);
        float s = tl_abs(tl_dot(tl_normalize_or(along, d), d));
        if (s < least) {
            least = s;
            best = e;
        }
        e = edges[tl_hull_twin(e)].next;
    } while (e != first);
    if (least <= TL_EDGE_SIN) {
        best &= ~1u;
        uint32_t from = edges[best].origin, to = edges[best + 1u].origin;
        set_segment(f, tl_hull_point(hull, from), tl_hull_point(hull, to), from, to, best >> 1);
        return;
    }
    set_point(f, p, v);
}

static void disc(tl_feature *f, float radius, float y, uint32_t id) {
    /* corners at multiples of 45 degrees, counter-clockwise seen along -y */
    static const float c[8] = {1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f, 0.0f, 0.70710678f};
    f->count = 8;
    f->normal = tl_v(0.0f, y >= 0.0f ? 1.0f : -1.0f, 0.0f);
    for (uint32_t i = 0; i < 8; ++i) {
        uint32_t k = y >= 0.0f ? (8u - i) & 7u : i, turn = (k + 6u) & 7u;
        f->point[i] = tl_v(radius * c[k], y, radius * c[turn]);
        f->vertex[i] = (uint16_t)(id + k);
        f->edge[i] = (uint16_t)(id + (y >= 0.0f ? (k + 7u) & 7u : k));
    }
}

#define ID_BOTTOM 0u
#define ID_TOP 8u
#define ID_SIDE_BOTTOM 16u
#define ID_SIDE_TOP 17u
#define ID_SIDE 18u
#define ID_POINT 19u

static void frustum_feature(const tl_core *core, talus_vec3 d, int strict, tl_feature *f) {
    float h = core->half_height, rise = 2.0f * h, in = core->bottom - core->top;
    float length = sqrtf(rise * rise + in * in), radial = sqrtf(d.x * d.x + d.z * d.z);
    float side = (radial * rise + d.y * in) / length;
    float cap = tl_abs(d.y);
    int top = d.y >= 0.0f;
    float radius = top ? core->top : core->bottom;
    if (cap > side && radius > 0.0f && (!strict || cap >= TL_FACE_COS)) {
        disc(f, radius, top ? h : -h, top ? ID_TOP : ID_BOTTOM);
        return;
    }
    if (side > 0.0f && (!strict || side >= TL_FACE_COS) && radial > 1e-20f) {
        float x = d.x / radial, z = d.z / radial;
        set_segment(f, tl_v(x * core->bottom, -h, z * core->bottom), tl_v(x * core->top, h, z * core->top),
                    ID_SIDE_BOTTOM, ID_SIDE_TOP, ID_SIDE);
        return;
    }
    uint32_t i = 0;
    set_point(f, tl_core_support_local(core, d, &i), ID_POINT);
}

static void capsule_feature(const tl_core *core, talus_vec3 d, int strict, tl_feature *f) {
    float h = core->half_height, rise = 2.0f * h, in = core->bottom - core->top;
    float radial = sqrtf(tl_max(d.x * d.x + d.z * d.z, 0.0f));
    float side2 = rise * rise - in * in;
    if (side2 > 0.0f) {
        float side = (radial * sqrtf(side2) + d.y * in) / rise;
        if (!strict || side >= TL_FACE_COS) {
            float rb = core->bottom + core->radius, rt = core->top + core->radius;
            set_segment(f, tl_mad(tl_v(0.0f, -h, 0.0f), rb, d), tl_mad(tl_v(0.0f, h, 0.0f), rt, d), ID_SIDE_BOTTOM,
                        ID_SIDE_TOP, ID_SIDE);
            return;
        }
    }
    uint32_t i = 0;
    talus_vec3 p = tl_core_support_local(core, d, &i);
    set_point(f, tl_mad(p, core->radius, d), p.y >= 0.0f ? ID_SIDE_TOP : ID_SIDE_BOTTOM);
}

void tl_feature_find(const tl_core *core, talus_vec3 n, int strict, tl_feature *out) {
    talus_vec3 d = tl_core_rotate_back(core, n);
    out->normal = tl_v(0.0f, 0.0f, 0.0f);
    switch (core->kind) {
    case TL_CORE_SEGMENT:
    case TL_CORE_DROP:
        capsule_feature(core, d, strict, out);
        break;
    case TL_CORE_FRUSTUM:
        frustum_feature(core, d, strict, out);
        break;
    case TL_CORE_BOX:
        box_feature(core, d, strict, out);
        break;
    case TL_CORE_HULL:
        hull_feature(core, d, strict, out);
        break;
    case TL_CORE_POINT:
    default:
        set_point(out, tl_scale(d, core->radius), ID_POINT);
        break;
    }
    place(core, out);
}
