/* Random queries of a world against asking all of its shapes one by one, which knows no trees. The hash of all answers
 * compares worlds with one another. */
#ifndef WORLD_QUERY_KIT_H
#define WORLD_QUERY_KIT_H

#include "stage/broad/tree.h"
#include "world_kit.h"

enum { QUERY_SHAPES = 512 };

typedef struct query_draw {
    uint32_t seed;
    uint64_t hash;  /* of the answers */
    uint32_t found; /* answers that are not empty */
} query_draw;

static inline float query_range(query_draw *d, float low, float high) {
    d->seed = d->seed * 1664525u + 1013904223u;
    return low + (high - low) * ((float)(d->seed >> 8) / 16777216.0f);
}
static inline talus_vec3 query_vec(query_draw *d, float size) {
    float x = query_range(d, -size, size), y, z;
    y = query_range(d, -size, size);
    z = query_range(d, -size, size);
    return kit_vec(x, y, z);
}
static inline int query_of(query_draw *d, int n) { return (int)query_range(d, 0.0f, (float)n) % n; }

/* A point where something is, as a rule. */
static inline talus_vec3 query_place(query_draw *d, const talus_world *world) {
    const tl_header *h = tl_header_of(world);
    talus_vec3 p = query_vec(d, 1.0f);
    uint32_t s = (uint32_t)query_of(d, (int)h->shapes.high + 1);
    talus_shape shape = {s, s < h->shapes.high ? tl_shapes(h)[s].generation : 0u};
    talus_aabb box;
    if (talus_shape_get_aabb(world, shape, &box) == TALUS_OK && kit_length(box.lower) < 1e6f) {
        talus_vec3 t = query_vec(d, 0.6f);
        p.x = 0.5f * (box.lower.x + box.upper.x) + t.x * (box.upper.x - box.lower.x);
        p.y = 0.5f * (box.lower.y + box.upper.y) + t.y * (box.upper.y - box.lower.y);
        p.z = 0.5f * (box.lower.z + box.upper.z) + t.z * (box.upper.z - box.lower.z);
    }
    return p;
}

static inline talus_quat query_turn(query_draw *d) {
    talus_vec3 v = query_vec(d, 1.0f);
    talus_quat q = {v.x, v.y, v.z, query_range(d, 0.1f, 1.0f)};
    return q;
}

static inline talus_convex query_shape(query_draw *d) {
    talus_convex c;
    talus_geometry g;
    memset(&g, 0, sizeof g);
    g.type = (talus_shape_type)query_of(d, TALUS_HULL);
    float size = query_of(d, 4) ? query_range(d, 0.05f, 0.6f) : query_range(d, 0.5f, 4.0f);
    g.radius = g.radius_top = g.radius_bottom = g.half_height = size;
    if (query_of(d, 2)) {
        g.radius_top = 0.4f * size;
    }
    g.half = kit_vec(size, 0.5f * size, 2.0f * size);
    OK(talus_convex_init(&g, NULL, 0, &c));
    return c;
}

static inline talus_query_filter query_filter(query_draw *d, talus_body *skip, const talus_world *world) {
    talus_query_filter f = talus_query_filter_default();
    const tl_header *h = tl_header_of(world);
    if (query_of(d, 2)) {
        return f;
    }
    f.kinds = (uint32_t)query_of(d, 16);
    f.filter.category = (uint64_t)query_of(d, 16), f.filter.mask = query_of(d, 2) ? ~(uint64_t)0 : 3u;
    f.filter.group = query_of(d, 4) - 2;
    f.skip = skip;
    f.skip_count = (uint32_t)query_of(d, 3);
    for (uint32_t i = 0; i < f.skip_count; i++) {
        skip[i].index = (uint32_t)query_of(d, (int)h->bodies.high);
        skip[i].generation = tl_bodies(h)[skip[i].index].generation;
    }
    return f;
}

/* What the filter says, by the public interface but for the sensors. */
static inline int query_sees(const talus_world *world, const talus_query_filter *f, talus_shape shape) {
    talus_filter own;
    talus_body body;
    talus_body_type type;
    OK(talus_shape_get_filter(world, shape, &own));
    OK(talus_shape_get_body(world, shape, &body));
    OK(talus_body_get_type(world, body, &type));
    for (uint32_t i = 0; i < f->skip_count; i++) {
        if (f->skip[i].index == body.index) {
            return 0;
        }
    }
    uint32_t kind = type == TALUS_STATIC      ? TALUS_SEE_STATIC
                    : type == TALUS_KINEMATIC ? TALUS_SEE_KINEMATIC
                                              : TALUS_SEE_DYNAMIC;
    int sensor = (tl_shapes(tl_header_of(world))[shape.index].flags & TL_SHAPE_SENSOR) != 0;
    if (!(f->kinds & kind) || (sensor && !(f->kinds & TALUS_SEE_SENSORS))) {
        return 0;
    }
    if (own.group && own.group == f->filter.group) {
        return own.group > 0;
    }
    return (own.mask & f->filter.category) && (f->filter.mask & own.category);
}

/* One query, whichever it is. */
typedef struct query_case {
    int kind;
    talus_ray ray;
    talus_convex shape;
    talus_pose pose;
    talus_motion motion;
    talus_vec3 point;
    float reach, tolerance;
    talus_aabb box;
} query_case;

enum { QUERY_RAY, QUERY_CAST, QUERY_CLOSEST, QUERY_CLOSEST_POINT, QUERY_OVERLAP, QUERY_BOX, QUERY_POINT, QUERY_KINDS };

static inline query_case query_any(query_draw *d, const talus_world *world, int kind) {
    query_case c;
    memset(&c, 0, sizeof c);
    c.kind = kind;
    c.shape = query_shape(d);
    c.point = query_place(d, world);
    c.pose.position = c.point, c.pose.rotation = query_turn(d);
    talus_vec3 to = query_place(d, world);
    c.ray.origin = query_of(d, 4) ? query_vec(d, 12.0f) : c.point;
    float stretch = query_range(d, 0.3f, 2.0f);
    c.ray.way = kit_vec(stretch * (to.x - c.ray.origin.x), stretch * (to.y - c.ray.origin.y),
                        stretch * (to.z - c.ray.origin.z));
    if (query_of(d, 6) == 0) { /* along an axis */
        c.ray.way.x = c.ray.way.z = 0.0f;
    }
    c.motion.pose = c.pose;
    c.motion.pose.position = c.ray.origin;
    c.motion.translation = c.ray.way;
    if (query_of(d, 2)) {
        c.motion.center = query_vec(d, 0.5f);
        c.motion.rotation = query_vec(d, 1.5f);
    }
    c.reach = query_of(d, 5) ? query_range(d, 0.0f, 2.0f) : 0.0f;
    c.tolerance = query_of(d, 3) ? 1e-3f : 0.05f;
    talus_vec3 half = query_vec(d, 2.0f);
    c.box.lower = kit_vec(c.point.x - fabsf(half.x), c.point.y - fabsf(half.y), c.point.z - fabsf(half.z));
    c.box.upper = kit_vec(c.point.x + fabsf(half.x), c.point.y + fabsf(half.y), c.point.z + fabsf(half.z));
    return c;
}

static inline void query_all(const talus_world *world, const query_case *c, const talus_query_filter *f,
                             talus_hits *out) {
    switch (c->kind) {
    case QUERY_RAY:
        OK(talus_world_ray_all(world, &c->ray, f, out));
        break;
    case QUERY_CAST:
        OK(talus_world_cast_all(world, &c->shape, &c->motion, c->tolerance, f, out));
        break;
    case QUERY_CLOSEST:
        OK(talus_world_closest_all(world, &c->shape, &c->pose, c->reach, f, out));
        break;
    case QUERY_CLOSEST_POINT:
        OK(talus_world_closest_to_point_all(world, c->point, c->reach, f, out));
        break;
    case QUERY_OVERLAP:
        OK(talus_world_overlap(world, &c->shape, &c->pose, f, out));
        break;
    case QUERY_BOX:
        OK(talus_world_overlap_aabb(world, &c->box, f, out));
        break;
    default:
        OK(talus_world_at_point(world, c->point, f, out));
        break;
    }
}

/* The first alone, where there is such a query; 0 if not. */
static inline int query_first(const talus_world *world, const query_case *c, const talus_query_filter *f,
                              talus_query_hit *out) {
    switch (c->kind) {
    case QUERY_RAY:
        OK(talus_world_ray(world, &c->ray, f, out));
        return 1;
    case QUERY_CAST:
        OK(talus_world_cast(world, &c->shape, &c->motion, c->tolerance, f, out));
        return 1;
    case QUERY_CLOSEST:
        OK(talus_world_closest(world, &c->shape, &c->pose, c->reach, f, out));
        return 1;
    case QUERY_CLOSEST_POINT:
        OK(talus_world_closest_to_point(world, c->point, c->reach, f, out));
        return 1;
    default:
        return 0;
    }
}

/* Of one shape; 0 if it does not answer. */
static inline int query_one(const talus_world *world, const query_case *c, talus_shape shape, talus_query_hit *out) {
    talus_aabb box;
    memset(out, 0, sizeof *out);
    switch (c->kind) {
    case QUERY_RAY:
        OK(talus_shape_ray(world, shape, &c->ray, out));
        break;
    case QUERY_CAST:
        OK(talus_shape_cast(world, shape, &c->shape, &c->motion, c->tolerance, out));
        break;
    case QUERY_CLOSEST:
        OK(talus_shape_closest(world, shape, &c->shape, &c->pose, out));
        return out->shape.generation && out->at <= (double)c->reach;
    case QUERY_CLOSEST_POINT:
        OK(talus_shape_closest_to_point(world, shape, c->point, out));
        return out->shape.generation && out->at <= (double)c->reach;
    case QUERY_OVERLAP:
        OK(talus_shape_overlap(world, shape, &c->shape, &c->pose, out));
        break;
    case QUERY_BOX:
        OK(talus_shape_get_aabb(world, shape, &box));
        if (kit_length(box.lower) < 1e8f && tl_aabb_overlap(&box, &c->box)) {
            out->shape = shape;
            OK(talus_shape_get_body(world, shape, &out->body));
        }
        break;
    default:
        OK(talus_shape_at_point(world, shape, c->point, out));
        break;
    }
    return out->shape.generation != 0;
}

static inline int query_order(const void *a, const void *b) {
    const talus_query_hit *x = a, *y = b;
    return x->at != y->at ? (x->at < y->at ? -1 : 1) : x->shape.index < y->shape.index ? -1 : 1;
}

static inline void query_same(const talus_query_hit *a, const talus_query_hit *b, const query_case *c) {
    if (memcmp(a, b, sizeof *a) != 0) {
        print_error("query %d: shape %u at %.17g, not shape %u at %.17g\n", c->kind, a->shape.index, a->at,
                    b->shape.index, b->at);
        fail();
    }
}

static inline void query_fold(query_draw *d, const void *bytes, size_t size) {
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; i++) {
        d->hash = (d->hash ^ p[i]) * 0x100000001b3u;
    }
}

/* A query of each kind. With `brute` 0 it is only asked, and the answers are hashed. */
static inline void kit_queries(const talus_world *world, query_draw *d, int brute) {
    static talus_query_hit want[QUERY_SHAPES], got[QUERY_SHAPES], few[3], first;
    const tl_header *h = tl_header_of(world);
    assert_true(h->shapes.high <= QUERY_SHAPES);
    for (int kind = 0; kind < QUERY_KINDS; kind++) {
        talus_body skip[3];
        talus_query_filter filter = query_filter(d, skip, world);
        query_case c = query_any(d, world, kind);
        talus_hits all = {got, QUERY_SHAPES, 0}, some = {few, (uint32_t)query_of(d, 4), 0};
        query_all(world, &c, &filter, &all);
        d->found += all.count > 0;
        query_fold(d, got, all.count * sizeof *got);
        if (!brute) {
            continue;
        }
        uint32_t count = 0;
        for (uint32_t s = 0; s < h->shapes.high; s++) {
            talus_shape shape = {s, tl_shapes(h)[s].generation};
            if (talus_shape_is_valid(world, shape) && query_sees(world, &filter, shape)) {
                count += (uint32_t)query_one(world, &c, shape, &want[count]);
            }
        }
        qsort(want, count, sizeof *want, query_order);
        assert_int_equal(all.count, count);
        for (uint32_t i = 0; i < count; i++) {
            query_same(&got[i], &want[i], &c);
        }
        query_all(world, &c, &filter, &some);
        assert_int_equal(some.count, count);
        for (uint32_t i = 0; i < count && i < some.capacity; i++) {
            query_same(&few[i], &want[i], &c);
        }
        memset(&want[count], 0, sizeof want[count]);
        if (count < QUERY_SHAPES && query_first(world, &c, &filter, &first)) {
            query_same(&first, &want[0], &c);
        }
        int any = -1;
        OK(talus_world_ray_any(world, &c.ray, &filter, &any));
        assert_true(kind != QUERY_RAY || any == (count > 0));
    }
}

#endif
