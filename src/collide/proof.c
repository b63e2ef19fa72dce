/* A short proof that an overlap's manifold shows the shortest way out, which spares the search for shorter ones. The
 * normal is that of a face of one shape. The difference B - A then holds the pairs of points of the contact polygon, so
 * a disc of twice the radius of any circle in the polygon, no lower than its shallowest corner; the deepest corner; and
 * the difference of any two points inside. If the ball of the depth's radius lies in the hull of these, but for 1e-4 of
 * the depth, no way out is shorter. Metres. */
#include "collide/feature.h"

int tl_is_proven(const tl_manifold *m, float separation, talus_vec3 between) {
    if (m->count < 3) {
        return 0;
    }
    float deep = -m->point[0].separation, shallow = deep;
    for (uint32_t i = 1; i < m->count; ++i) {
        deep = tl_max(deep, -m->point[i].separation);
        shallow = tl_min(shallow, -m->point[i].separation);
    }
    /* the circle in the triangle of three points has the radius 2 area / (sum of the sides) */
    talus_vec3 n = m->normal, u = tl_sub(m->point[1].position, m->point[0].position);
    talus_vec3 w = tl_sub(m->point[2].position, m->point[0].position), x = tl_sub(w, u);
    float longest = sqrtf(tl_max(tl_length2(u), tl_max(tl_length2(w), tl_length2(x))));
    /* a deeper point beside the face would want another way out */
    if (!(deep >= -0.9999f * separation && shallow > 0.0f && longest > 0.0f)) {
        return 0;
    }
    float reach = 2.0f * tl_abs(tl_dot(n, tl_cross(u, w))) / (3.0f * longest);
    float height = tl_dot(between, n), rise = shallow + height;
    if (!(height > 0.0f && deep - shallow <= 0.014f * reach)) {
        return 0;
    }
    float aside = tl_length(tl_mad(between, -height, n)) + reach, at_origin = reach - shallow / rise * aside;
    return at_origin > 0.0f && at_origin * rise >= deep * sqrtf(rise * rise + aside * aside);
}
