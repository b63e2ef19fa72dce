/* A short proof that an overlap's manifold shows the shortest way out, which spares the search for shorter ones. The
 * normal is that of a face of one shape. The difference B - A then holds the pairs of points of the contact polygon, so
 * a disc of twice the radius of any circle in the polygon, no lower than its shallowest corner; the deepest corner; and
 * the difference of any two points inside. If the ball of the depth's radius lies in the hull of these, but for 1e-4 of
 * the depth, no way out is shorter. Metres. */
#include "collide/feature.h"

int tl_is_proven(const tl_manifold *m, talus_vec3 between) {
    if (m->count < 3) {
        return 0;
    }
    talus_vec3 n = m->normal, c = tl_v(0.0f, 0.0f, 0.0f);
    float deep = -m->point[0].separation, shallow = deep;
    for (uint32_t i = 0; i < m->count; ++i) {
        c = tl_add(c, m->point[i].position);
        deep = tl_max(deep, -m->point[i].separation);
        shallow = tl_min(shallow, -m->point[i].separation);
    }
    c = tl_scale(c, 1.0f / (float)m->count);
    /* the polygon's corners go round in some order: every pair of them gives a line, those with all on one side bound
     * it */
    float radius = 3e38f;
    for (uint32_t i = 0; i < m->count; ++i) {
        for (uint32_t k = i + 1u; k < m->count; ++k) {
            talus_vec3 side = tl_cross(n, tl_sub(m->point[k].position, m->point[i].position));
            float low = 0.0f, high = 0.0f, length = tl_length(side);
            for (uint32_t j = 0; j < m->count; ++j) {
                float s = tl_dot(side, tl_sub(m->point[j].position, m->point[i].position));
                low = tl_min(low, s);
                high = tl_max(high, s);
            }
            float d = tl_abs(tl_dot(side, tl_sub(c, m->point[i].position)));
            if (tl_min(-low, high) <= 1e-3f * tl_max(-low, high)) {
                radius = length > 0.0f ? tl_min(radius, d / length) : 0.0f;
            }
        }
    }
    float reach = 2.0f * radius, height = tl_dot(between, n);
    float aside = tl_length(tl_mad(between, -height, n)) + reach, rise = shallow + height;
    if (!(shallow > 0.0f && height > 0.0f && deep - shallow <= 0.014f * reach)) {
        return 0;
    }
    float at_origin = reach - shallow / rise * aside;
    return at_origin > 0.0f && at_origin * rise >= deep * sqrtf(rise * rise + aside * aside);
}
