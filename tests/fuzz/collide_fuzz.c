/* libFuzzer: two shapes of any sizes that are allowed, any finite pose, margin and cache. Whatever comes in, what comes
 * out is finite, unit where it says so, within the margin and numbered without repeats. */
#include "base/vec.h"
#include "collide/collide.h"
#include "fuzz_input.h"

#include <stdlib.h>
#include <string.h>

#define MAX_POINTS 100u
#define SCRATCH_BYTES (1u << 20)
#define BLOB_BYTES (1u << 16)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Any finite float. */
static float take_float(reader *r) {
    uint32_t bits = take_u32(r);
    float f;
    memcpy(&f, &bits, 4u);
    return tl_is_finite(f) ? f : 1.0f;
}

/* Half of the time around 1, else any. */
static float take_size(reader *r) {
    uint32_t how = take_u32(r);
    float f = tl_abs(take_float(r));
    if (how & 1u) {
        f = (float)(how >> 8) / 16777216.0f + 0.01f;
    }
    return tl_clamp(f, TALUS_MIN_SIZE, TALUS_MAX_SIZE);
}

static float take_coordinate(reader *r) {
    uint32_t how = take_u32(r);
    float f = take_float(r);
    return (how & 1u) ? ((float)(how >> 8) / 16777216.0f - 0.5f) * 4.0f : f;
}

static const talus_hull *take_hull(reader *r, unsigned char *blob) {
    static unsigned char scratch_memory[SCRATCH_BYTES];
    unsigned char *scratch = scratch_memory + (64u - (uintptr_t)scratch_memory % 64u) % 64u;
    talus_vec3 points[MAX_POINTS];
    uint32_t count = 4u + take_u32(r) % (MAX_POINTS - 4u);
    size_t size = 0;
    float scale = take_size(r);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t bits = take_u32(r) * 2654435761u + i * 40503u;
        points[i] = tl_scale(tl_v((float)(bits & 1023u) - 512.0f, (float)((bits >> 10) & 1023u) - 512.0f,
                                  (float)(bits >> 20) / 4.0f - 512.0f),
                             scale / 512.0f);
    }
    talus_status status = talus_hull_build(points, count, scratch, SCRATCH_BYTES - 64u, blob, BLOB_BYTES, &size);
    return status == TALUS_OK ? (const talus_hull *)(const void *)blob : NULL;
}

static tl_convex take_shape(reader *r, unsigned char *blob) {
    tl_convex s;
    memset(&s, 0, sizeof s);
    uint32_t kind = take_u32(r);
    talus_geometry *g = &s.geometry;
    g->type = (talus_shape_type)(kind % TALUS_SHAPE_TYPE_COUNT);
    g->radius = take_size(r);
    g->half_height = g->type == TALUS_CAPSULE && (kind & 256u) ? 0.0f : take_size(r);
    g->radius_bottom = take_size(r);
    g->radius_top = (kind & 512u) ? g->radius_bottom : take_size(r);
    if (g->type == TALUS_CYLINDER && (kind & 1024u)) {
        g->radius_top = 0.0f;
    }
    g->half = tl_v(take_size(r), take_size(r), take_size(r));
    if (g->type == TALUS_HULL) {
        s.hull = take_hull(r, blob);
        if (s.hull == NULL) {
            g->type = TALUS_BOX;
        }
    }
    return s;
}

static void demand(int ok) {
    if (!ok) {
        abort();
    }
}

static void check(const tl_manifold *m, float margin) {
    demand(m->count <= TL_MANIFOLD_POINTS);
    demand(tl_is_finite3(m->normal));
    if (m->count > 0) {
        demand(tl_abs(tl_length(m->normal) - 1.0f) < 1e-4f);
    }
    for (uint32_t i = 0; i < m->count; ++i) {
        demand(tl_is_finite3(m->point[i].position) && tl_is_finite(m->point[i].separation));
        demand(m->point[i].separation <= margin);
        for (uint32_t k = 0; k < i; ++k) {
            demand(m->point[i].id != m->point[k].id);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static unsigned char blob_memory[2][BLOB_BYTES + 64u];
    reader r = {data, size};
    tl_convex shape[2];
    for (int i = 0; i < 2; ++i) {
        shape[i] = take_shape(&r, blob_memory[i] + (64u - (uintptr_t)blob_memory[i] % 64u) % 64u);
    }
    talus_pose pose;
    pose.position = tl_v(take_coordinate(&r), take_coordinate(&r), take_coordinate(&r));
    talus_quat q = {take_coordinate(&r), take_coordinate(&r), take_coordinate(&r), take_coordinate(&r)};
    pose.rotation = tl_quat_normalize(q);
    float margin = tl_abs(take_coordinate(&r));
    tl_pair_cache cache = {{take_u32(&r), take_u32(&r), take_u32(&r), take_u32(&r)}};
    tl_manifold first, again;
    tl_collide(&shape[0], &shape[1], &pose, margin, &cache, &first);
    check(&first, margin);
    tl_collide(&shape[0], &shape[1], &pose, margin, &cache, &again);
    check(&again, margin);
    tl_collide(&shape[1], &shape[0], &pose, margin, &cache, &again);
    check(&again, margin);
    talus_vec3 pa, pb;
    float distance = tl_distance(&shape[0], &shape[1], &pose, &cache, &pa, &pb);
    demand(tl_is_finite(distance) && distance >= 0.0f && tl_is_finite3(pa) && tl_is_finite3(pb));
    talus_aabb box = tl_convex_aabb(&shape[0], &pose);
    demand(box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z);
    return 0;
}
