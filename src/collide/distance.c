/* Distance of two convex shapes and their closest points, by GJK on the cores. Metres, in A's frame. */
#include "collide/general.h"

float tl_distance(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, tl_pair_cache *cache,
                  talus_vec3 *point_a, talus_vec3 *point_b) {
    tl_core ca, cb;
    tl_simplex simplex;
    tl_gjk near;
    tl_core_init(&ca, a, NULL);
    tl_core_init(&cb, b, b_in_a);
    if (tl_is_far(b_in_a->position)) {
        float distance = tl_far_distance(b_in_a->position, &near.normal);
        *point_a = tl_v(0.0f, 0.0f, 0.0f);
        *point_b = b_in_a->position;
        return distance;
    }
    simplex.count = 0;
    near.normal = tl_v(0.0f, 1.0f, 0.0f);
    talus_vec3 guess = tl_cache_axis(cache, tl_normalize_or(b_in_a->position, near.normal));
    tl_gjk_state state = tl_gjk_run(&ca, &cb, guess, 3e38f, &simplex, &near);
    float distance = near.distance - (ca.radius + cb.radius);
    if (state != TL_GJK_APART || distance <= 0.0f) {
        /* between the cores, within reach of both radii */
        float low = tl_max(near.distance - cb.radius, 0.0f), high = tl_min(near.distance, ca.radius);
        *point_a = tl_mad(near.point_a, 0.5f * (low + high), near.normal);
        *point_b = *point_a;
        return 0.0f;
    }
    tl_cache_keep_axis(cache, near.normal);
    *point_a = tl_mad(near.point_a, ca.radius, near.normal);
    *point_b = tl_mad(near.point_b, -cb.radius, near.normal);
    return distance;
}
