/* Queries of a world whose answers' bits are kept. */
#include "golden.h"

enum { ROOM = 64 };

static uint64_t fold_vec(uint64_t hash, talus_vec3 v) {
    return golden_fold_float(golden_fold_float(golden_fold_float(hash, v.x), v.y), v.z);
}

static uint64_t fold_hits(uint64_t hash, const talus_hits *all) {
    hash = golden_fold(hash, all->count);
    for (uint32_t i = 0; i < all->count && i < all->capacity; i++) {
        const talus_query_hit *hit = &all->hits[i];
        uint64_t at;
        memcpy(&at, &hit->at, sizeof at);
        hash = golden_fold(golden_fold(hash, (uint32_t)(at >> 32)), (uint32_t)at);
        hash = golden_fold(golden_fold(hash, hit->shape.index), hit->body.index);
        hash = fold_vec(fold_vec(fold_vec(hash, hit->normal), hit->point), hit->own);
        hash = golden_fold(golden_fold(hash, hit->within), hit->unfinished);
    }
    return hash;
}

/* A ball, a box, a capsule of two radii or a cone, not larger than a metre. */
static talus_convex any_shape(void) {
    talus_geometry g;
    talus_convex shape;
    memset(&g, 0, sizeof g);
    g.type = (talus_shape_type)(golden_next() % TALUS_HULL);
    g.radius = golden_range(0.05f, 0.5f);
    g.radius_top = golden_range(0.05f, 0.5f);
    g.radius_bottom = golden_range(0.05f, 0.5f);
    g.half_height = golden_range(0.05f, 0.5f);
    g.half = golden_any(golden_vec(0.05f, 0.05f, 0.05f), golden_vec(0.5f, 0.5f, 0.5f));
    golden_check(talus_convex_init(&g, NULL, 0, &shape), "shape");
    return shape;
}

uint64_t golden_queries(const talus_world *world, uint32_t rounds) {
    const talus_vec3 low = golden_vec(-3.0f, -0.5f, -3.0f), high = golden_vec(3.0f, 5.0f, 3.0f);
    static talus_query_hit hits[ROOM];
    talus_hits all = {hits, ROOM, 0};
    uint64_t hash = 0;
    golden_seed(4u);
    for (uint32_t i = 0; i < rounds; i++) {
        talus_ray ray;
        talus_motion motion;
        talus_convex shape = any_shape();
        ray.origin = golden_any(low, high);
        talus_vec3 to = golden_any(low, high);
        ray.way = golden_vec(2.0f * (to.x - ray.origin.x), 2.0f * (to.y - ray.origin.y), 2.0f * (to.z - ray.origin.z));
        motion.pose.position = ray.origin;
        motion.pose.rotation = golden_turn();
        motion.center = golden_vec(0.0f, 0.0f, 0.0f);
        motion.translation = ray.way;
        motion.rotation = golden_any(golden_vec(-1.0f, -1.0f, -1.0f), golden_vec(1.0f, 1.0f, 1.0f));
        golden_check(talus_world_ray_all(world, &ray, NULL, &all), "rays");
        hash = fold_hits(hash, &all);
        golden_check(talus_world_cast_all(world, &shape, &motion, 1e-3f, NULL, &all), "casts");
        hash = fold_hits(hash, &all);
        golden_check(talus_world_closest_all(world, &shape, &motion.pose, 0.5f, NULL, &all), "closest");
        hash = fold_hits(hash, &all);
        golden_check(talus_world_closest_to_point_all(world, to, 0.5f, NULL, &all), "closest to a point");
        hash = fold_hits(hash, &all);
        golden_check(talus_world_overlap(world, &shape, &motion.pose, NULL, &all), "overlaps");
        hash = fold_hits(hash, &all);
        golden_check(talus_world_at_point(world, to, NULL, &all), "at a point");
        hash = fold_hits(hash, &all);
    }
    return hash;
}
