/* libFuzzer: queries of pairs and of worlds, with any bits for floats and any bytes for hulls' blobs. The first byte
 * chooses. Whatever comes in is refused or answered; an answer is finite, unit or zero where it is a normal, in order,
 * and says the same whether the trees or the shapes one by one are asked. */
#include "busy_world.h"
#include "fuzz_input.h"

#include "base/vec.h"

#include <stdio.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MAX_POINTS 64u
#define REGION_BYTES (1u << 15)
#define MOST_HITS 24u

/* Any bits, a small number, or a power of ten, as the first word says. */
static float take_float(reader *r) {
    uint32_t how = take_u32(r), bits;
    float part = (float)(how >> 8) / 16777216.0f - 0.5f, f;
    switch (how & 7u) {
    case 0:
        bits = take_u32(r);
        memcpy(&f, &bits, 4u);
        return f;
    case 1:
        f = 1e-6f;
        for (uint32_t k = how >> 3 & 15u; k > 0; k--) {
            f *= 10.0f;
        }
        return part < 0.0f ? -f : f;
    default:
        return 8.0f * part;
    }
}
static talus_vec3 take_vec(reader *r) {
    float x = take_float(r), y = take_float(r), z = take_float(r);
    return tl_v(x, y, z);
}
static talus_pose take_pose(reader *r) {
    talus_pose p;
    p.position = take_vec(r);
    p.rotation.x = take_float(r), p.rotation.y = take_float(r);
    p.rotation.z = take_float(r), p.rotation.w = take_float(r);
    return p;
}
/* Seven times of eight within what is allowed, or little would be asked for. */
static float take_size(reader *r) {
    uint32_t how = take_u32(r);
    float f = take_float(r);
    return (how & 7u) == 0 ? f : tl_is_finite(f) ? tl_clamp(tl_abs(f), TALUS_MIN_SIZE, TALUS_MAX_SIZE) : 1.0f;
}

/* --- hulls ---------------------------------------------------------------------------------------- */

/* A cooked hull, one with words changed as a forger would, or the input's bytes; returns the region's size. */
static size_t take_region(reader *r, unsigned char *region) {
    static unsigned char *scratch;
    uint32_t how = take_u32(r), count = 4u + (how >> 8) % (MAX_POINTS - 4u);
    size_t scratch_size = talus_hull_scratch_size(MAX_POINTS), bytes = 0;
    scratch = scratch ? scratch : aligned(scratch_size);
    if ((how & 3u) == 3u) {
        bytes = r->left < REGION_BYTES ? r->left / 32u * 32u : REGION_BYTES;
        memcpy(region, r->data, bytes);
        if (bytes >= sizeof(talus_hull)) {
            mend_hull(region, bytes);
        }
        return bytes;
    }
    talus_vec3 points[MAX_POINTS];
    float scale = take_size(r);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t bits = (take_u32(r) + i) * 2654435761u;
        points[i] = tl_scale(tl_v((float)(bits & 1023u) - 512.0f, (float)((bits >> 10) & 1023u) - 512.0f,
                                  (float)(bits >> 20) / 4.0f - 512.0f),
                             scale / 512.0f);
    }
    if (talus_hull_build(points, count, scratch, scratch_size, region, REGION_BYTES, &bytes) != TALUS_OK) {
        return 0;
    }
    for (uint32_t i = 0; (how & 3u) == 2u && i < (how >> 16) % 4u + 1u; ++i) {
        uint32_t at = take_u32(r) % (uint32_t)(bytes / 4u), word = take_u32(r);
        memcpy(region + 4u * at, &word, 4u);
    }
    mend_hull(region, bytes);
    return bytes;
}

static talus_status take_convex(reader *r, unsigned char *region, talus_convex *out) {
    talus_geometry g;
    uint32_t kind = take_u32(r);
    size_t bytes = 0;
    memset(&g, 0, sizeof g);
    g.type = (talus_shape_type)(kind % (TALUS_SHAPE_TYPE_COUNT + 1u));
    g.radius = take_size(r);
    g.half_height = (kind & 256u) ? 0.0f : take_size(r);
    g.radius_bottom = take_size(r);
    g.radius_top = (kind & 512u) ? g.radius_bottom : (kind & 1024u) ? 0.0f : take_size(r);
    g.half.x = take_size(r), g.half.y = take_size(r), g.half.z = take_size(r);
    if (g.type == TALUS_HULL) {
        bytes = take_region(r, region);
        g.hull = (kind & 0xf000u) ? 0u : take_u32(r);
    }
    return talus_convex_init(&g, bytes ? region : NULL, bytes, out);
}

/* --- what answers must be -------------------------------------------------------------------------- */

#define demand(what)                                                                                                   \
    do {                                                                                                               \
        if (!(what)) {                                                                                                 \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #what);                                         \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)
static void demand_normal(talus_vec3 n, int must) {
    float l = tl_length(n);
    demand(tl_is_finite3(n) && ((!must && l == 0.0f) || tl_abs(l - 1.0f) < 1e-4f));
}
static void demand_status(talus_status status) {
    demand(status == TALUS_OK || status == TALUS_BAD_ARGUMENT || status == TALUS_NOT_FINITE);
}

static talus_motion take_motion(reader *r) {
    talus_motion m;
    m.pose = take_pose(r);
    m.center = take_vec(r);
    m.translation = take_vec(r);
    m.rotation = take_vec(r);
    if (tl_length(m.rotation) > 3.1f && (r->left & 3u)) {
        m.rotation = tl_scale(tl_normalize_or(m.rotation, tl_v(0.0f, 0.0f, 0.0f)), 3.0f);
    }
    return m;
}

static void ask_pair(reader *r) {
    static unsigned char *region[2];
    talus_convex shape[2];
    for (int i = 0; i < 2; ++i) {
        region[i] = region[i] ? region[i] : aligned(REGION_BYTES);
        if (take_convex(r, region[i], &shape[i]) != TALUS_OK) {
            return;
        }
    }
    talus_pose pose_a = take_pose(r), pose_b = take_pose(r);
    talus_feature_pair features = {take_u32(r), take_u32(r)};
    talus_depth_mode mode = (talus_depth_mode)(take_u32(r) % (TALUS_DEPTH_MODE_COUNT + 1u));
    talus_separation near;
    talus_depth deep;
    talus_contact_time time;
    talus_status status = talus_distance(&shape[0], &pose_a, &shape[1], &pose_b, &features, &near);
    demand_status(status);
    if (status == TALUS_OK) {
        demand(near.distance >= 0.0f && tl_is_finite(near.distance));
        demand(tl_is_finite3(near.point_a) && tl_is_finite3(near.point_b));
        demand_normal(near.normal, !near.overlap);
    }
    status = talus_penetration(&shape[0], &pose_a, &shape[1], &pose_b, mode, &features, &deep);
    demand_status(status);
    if (status == TALUS_OK) {
        demand(deep.depth >= 0.0f && tl_is_finite(deep.depth));
        demand(tl_is_finite3(deep.point_a) && tl_is_finite3(deep.point_b));
        demand_normal(deep.normal, deep.overlap);
    }
    talus_motion motion_a = take_motion(r), motion_b = take_motion(r);
    talus_time_method method = (talus_time_method)(take_u32(r) % (TALUS_TIME_METHOD_COUNT + 1u));
    status = talus_time_of_contact(&shape[0], &motion_a, &shape[1], &motion_b, take_float(r), method, &features, &time);
    demand_status(status);
    if (status == TALUS_OK) {
        demand(time.time >= 0.0 && time.time <= 1.0 && (unsigned)time.status <= TALUS_TIME_UNFINISHED);
        demand(tl_is_finite(time.gap) && tl_is_finite3(time.point_a) && tl_is_finite3(time.point_b));
        demand_normal(time.normal, 0);
    }
}

/* --- worlds ---------------------------------------------------------------------------------------- */

typedef struct asked {
    talus_query_hit hits[MOST_HITS], few[2], first;
    talus_hits all, some;
} asked;

static int is_after(const talus_query_hit *a, const talus_query_hit *b) {
    return a->at > b->at || (a->at == b->at && a->shape.index > b->shape.index);
}

static void check_hits(const asked *a, int has_first) {
    demand(a->all.count <= MOST_HITS && a->some.count == a->all.count);
    for (uint32_t i = 0; i < a->all.count; ++i) {
        const talus_query_hit *hit = &a->hits[i];
        demand(hit->at >= 0.0 && hit->at < 1e39 && (i == 0 || is_after(hit, hit - 1)));
        demand(tl_is_finite3(hit->point) && tl_is_finite3(hit->own));
        demand_normal(hit->normal, 0);
    }
    for (uint32_t i = 0; i < a->all.count && i < a->some.capacity; ++i) {
        demand(memcmp(&a->few[i], &a->hits[i], sizeof a->few[i]) == 0);
    }
    if (has_first && a->all.count) {
        demand(memcmp(&a->first, &a->hits[0], sizeof a->first) == 0);
    } else if (has_first) {
        demand(a->first.shape.generation == 0);
    }
}

/* What one shape answers must be among the hits, or be nothing. */
static void check_one(const asked *a, talus_shape shape, talus_status status, const talus_query_hit *one,
                      double reach) {
    if (status != TALUS_OK) {
        demand(status == TALUS_STALE_HANDLE);
        return;
    }
    int wanted = one->shape.generation != 0 && one->at <= reach, found = 0;
    for (uint32_t i = 0; i < a->all.count; ++i) {
        found |= a->hits[i].shape.index == shape.index && memcmp(&a->hits[i], one, sizeof *one) == 0;
        demand(wanted || a->hits[i].shape.index != shape.index);
    }
    demand(found == wanted);
}

static void ask_world(reader *r, uint32_t how) {
    static talus_world world[4];
    static unsigned char *region;
    const uint32_t steps[4] = {0, 20, 60, 200};
    talus_world *w = &world[how % 4u];
    region = region ? region : aligned(REGION_BYTES);
    if (!w->block) {
        busy_world(w, steps[how % 4u]);
    }
    talus_query_filter filter = talus_query_filter_default();
    filter.kinds |= TALUS_SEE_SENSORS;
    talus_convex shape;
    if (take_convex(r, region, &shape) != TALUS_OK) {
        return;
    }
    asked a;
    memset(&a, 0, sizeof a);
    a.all.hits = a.hits, a.all.capacity = MOST_HITS;
    a.some.hits = a.few, a.some.capacity = (how >> 6) % 3u;
    talus_ray ray = {take_vec(r), take_vec(r)};
    talus_motion motion = take_motion(r);
    float tolerance = take_float(r), reach = take_float(r);
    talus_aabb box = {ray.origin, tl_add(ray.origin, tl_abs3(ray.way))};
    int any = 0;
    talus_status status = TALUS_OK;
    uint32_t kind = how / 4u % 7u;
    int has_first = 1;
    switch (kind) {
    case 0:
        status = talus_world_ray_all(w, &ray, &filter, &a.all);
        (void)talus_world_ray_all(w, &ray, &filter, &a.some);
        (void)talus_world_ray(w, &ray, &filter, &a.first);
        (void)talus_world_ray_any(w, &ray, &filter, &any);
        demand(status != TALUS_OK || any == (a.all.count > 0));
        break;
    case 1:
        status = talus_world_cast_all(w, &shape, &motion, tolerance, &filter, &a.all);
        (void)talus_world_cast_all(w, &shape, &motion, tolerance, &filter, &a.some);
        (void)talus_world_cast(w, &shape, &motion, tolerance, &filter, &a.first);
        break;
    case 2:
        status = talus_world_closest_all(w, &shape, &motion.pose, reach, &filter, &a.all);
        (void)talus_world_closest_all(w, &shape, &motion.pose, reach, &filter, &a.some);
        (void)talus_world_closest(w, &shape, &motion.pose, reach, &filter, &a.first);
        break;
    case 3:
        status = talus_world_closest_to_point_all(w, ray.origin, reach, &filter, &a.all);
        (void)talus_world_closest_to_point_all(w, ray.origin, reach, &filter, &a.some);
        (void)talus_world_closest_to_point(w, ray.origin, reach, &filter, &a.first);
        break;
    case 4:
        status = talus_world_overlap(w, &shape, &motion.pose, &filter, &a.all);
        (void)talus_world_overlap(w, &shape, &motion.pose, &filter, &a.some);
        has_first = 0;
        break;
    case 5:
        status = talus_world_overlap_aabb(w, &box, &filter, &a.all);
        (void)talus_world_overlap_aabb(w, &box, &filter, &a.some);
        has_first = 0;
        break;
    default:
        status = talus_world_at_point(w, ray.origin, &filter, &a.all);
        (void)talus_world_at_point(w, ray.origin, &filter, &a.some);
        has_first = 0;
        break;
    }
    demand_status(status);
    if (status != TALUS_OK) {
        return;
    }
    check_hits(&a, has_first);
    for (uint32_t i = 0; kind != 5u && i < 16u; ++i) {
        talus_query_hit one;
        talus_shape s = {i, 1u};
        status = kind == 0   ? talus_shape_ray(w, s, &ray, &one)
                 : kind == 1 ? talus_shape_cast(w, s, &shape, &motion, tolerance, &one)
                 : kind == 2 ? talus_shape_closest(w, s, &shape, &motion.pose, &one)
                 : kind == 3 ? talus_shape_closest_to_point(w, s, ray.origin, &one)
                 : kind == 4 ? talus_shape_overlap(w, s, &shape, &motion.pose, &one)
                             : talus_shape_at_point(w, s, ray.origin, &one);
        check_one(&a, s, status, &one, kind == 2 || kind == 3 ? (double)reach : 1.0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2u) {
        return 0;
    }
    reader r = {data + 2, size - 2u};
    if (data[0] & 1u) {
        ask_pair(&r);
    } else {
        ask_world(&r, data[1]);
    }
    return 0;
}
