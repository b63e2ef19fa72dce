/* Choosing the points of a manifold: of many candidates four are kept, one of the deepest and then those that span
 * the most area, each weighed against how much less deep it is. Metres. */
#include "collide/points.h"

#include <string.h>

/* A point this much less deep must be that times further out to be kept instead. */
#define GAP_WEIGHT 4.0f

static uint32_t best_area(const tl_candidate *c, uint32_t count, const uint32_t *chosen, uint32_t kept, talus_vec3 n,
                          float least, float scale) {
    uint32_t best = count;
    float most = scale * scale * 1e-6f;
    for (uint32_t i = 0; i < count; ++i) {
        talus_vec3 p0 = c[chosen[0]].p, d = tl_sub(c[i].p, p0);
        float area = 0.0f;
        if (kept == 2) {
            area = tl_abs(tl_dot(n, tl_cross(tl_sub(c[chosen[1]].p, p0), d)));
        } else {
            /* outside of the triangle by the side that it is furthest across */
            talus_vec3 p1 = c[chosen[1]].p, p2 = c[chosen[2]].p;
            float whole = tl_dot(n, tl_cross(tl_sub(p1, p0), tl_sub(p2, p0))), turn = whole >= 0.0f ? -1.0f : 1.0f;
            float s0 = turn * tl_dot(n, tl_cross(tl_sub(p1, p0), d));
            float s1 = turn * tl_dot(n, tl_cross(tl_sub(p2, p1), tl_sub(c[i].p, p1)));
            float s2 = turn * tl_dot(n, tl_cross(tl_sub(p0, p2), tl_sub(c[i].p, p2)));
            area = tl_max(s0, tl_max(s1, s2));
        }
        area -= GAP_WEIGHT * (c[i].gap - least) * scale;
        if (area > most) {
            most = area;
            best = i;
        }
    }
    return best;
}

/* Four of many candidates into the front of the array. */
uint32_t tl_candidates_reduce(tl_candidate *c, uint32_t count, talus_vec3 n, float tolerance) {
    uint32_t deepest = 0, chosen[4] = {0, 0, 0, 0}, kept = 1;
    float reach2 = 0.0f;
    for (uint32_t i = 1; i < count; ++i) {
        deepest = c[i].gap < c[deepest].gap ? i : deepest;
        reach2 = tl_max(reach2, tl_length2(tl_sub(c[i].p, c[0].p)));
    }
    float least = c[deepest].gap, reach = sqrtf(reach2);
    /* of points about as deep the one of the lowest number, so that the choice does not flicker */
    chosen[0] = deepest;
    for (uint32_t i = 0; i < count; ++i) {
        chosen[0] = c[i].gap <= least + 1e-3f * reach && c[i].id < c[chosen[0]].id ? i : chosen[0];
    }
    float most = 0.0f;
    for (uint32_t i = 0; i < count; ++i) {
        float score = tl_length(tl_sub(c[i].p, c[chosen[0]].p)) - GAP_WEIGHT * (c[i].gap - least);
        if (score > most) {
            most = score;
            chosen[1] = i;
            kept = 2;
        }
    }
    while (kept >= 2 && kept < 4) {
        uint32_t next = best_area(c, count, chosen, kept, n, least, most);
        if (next == count) {
            break;
        }
        chosen[kept++] = next;
    }
    float found = c[chosen[0]].gap;
    uint32_t nearest = 0;
    float near2 = 3e38f;
    for (uint32_t i = 0; i < kept; ++i) {
        found = tl_min(found, c[chosen[i]].gap);
        float d2 = tl_length2(tl_sub(c[chosen[i]].p, c[deepest].p));
        nearest = d2 < near2 ? i : nearest;
        near2 = tl_min(near2, d2);
    }
    if (found > least + tolerance) {
        chosen[kept < 4 ? kept++ : nearest] = deepest;
    }
    tl_candidate four[4];
    for (uint32_t i = 0; i < kept; ++i) {
        four[i] = c[chosen[i]];
    }
    memcpy(c, four, kept * sizeof four[0]);
    return kept;
}

/* One more point, where the others are not as deep. */
uint32_t tl_candidates_add(const tl_candidate *own, float tolerance, tl_candidate *c, uint32_t count) {
    uint32_t near = count;
    float near2 = 3e38f;
    for (uint32_t i = 0; i < count; ++i) {
        if (c[i].gap <= own->gap + tolerance) {
            return count;
        }
        float d2 = tl_length2(tl_sub(c[i].p, own->p));
        near = d2 < near2 ? i : near;
        near2 = tl_min(near2, d2);
    }
    if (count < TL_MANIFOLD_POINTS) {
        near = count++;
    }
    c[near] = *own;
    return count;
}

/* No point is nearer than the shapes are; beside the face, within the slack, it may have seemed so. */
void tl_candidates_write(const tl_candidate *c, uint32_t count, const tl_touch *touch, tl_manifold *out) {
    out->normal = touch->normal;
    out->count = count;
    for (uint32_t i = 0; i < count; ++i) {
        out->point[i].position = c[i].p;
        out->point[i].separation = tl_max(c[i].gap, touch->separation);
        uint32_t id = c[i].id;
        for (uint32_t k = 0; k < i; ++k) {
            if (out->point[k].id == id) {
                id += 0x4001u;
                k = UINT32_MAX;
            }
        }
        out->point[i].id = id;
    }
}

float tl_manifold_least(const tl_manifold *m) {
    float least = m->point[0].separation;
    for (uint32_t i = 1; i < m->count; ++i) {
        least = tl_min(least, m->point[i].separation);
    }
    return least;
}
