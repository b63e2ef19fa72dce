/* Choosing the points of a manifold: of many candidates four are kept, one of the deepest and then those that span
 * the most area, each weighed against how much less deep it is. Metres. */
#include "collide/points.h"

#include <string.h>

/* A point this much less deep must be that times further out to be kept instead. */
#define GAP_WEIGHT 4.0f

#define MAX_CANDIDATES (2u * TL_FEATURE_POINTS)

/* Candidates seen along the normal from the first chosen one, with x to the second: in units of m^2, both scaled by the
 * distance of the two. */
typedef struct plan {
    float x[MAX_CANDIDATES], y[MAX_CANDIDATES], penalty[MAX_CANDIDATES];
    float xx, least_area;
} plan;

/* The one that makes the largest triangle with the first two. */
static uint32_t third(const plan *p, uint32_t count) {
    uint32_t best = count;
    float most = p->least_area;
    for (uint32_t i = 0; i < count; ++i) {
        float area = tl_abs(p->y[i]) - p->penalty[i];
        best = area > most ? i : best;
        most = area > most ? area : most;
    }
    return best;
}

/* The one that adds the most to the triangle, by the side that it is furthest beyond. */
static uint32_t fourth(const plan *p, uint32_t count, uint32_t c) {
    uint32_t best = count;
    float most = p->least_area, x2 = p->x[c], y2 = p->y[c], turn = y2 >= 0.0f ? -1.0f : 1.0f, inverse = turn / p->xx;
    for (uint32_t i = 0; i < count; ++i) {
        float x = p->x[i], y = p->y[i];
        float s0 = turn * y, s1 = ((x2 - p->xx) * y - y2 * (x - p->xx)) * inverse;
        float s2 = (y2 * (x - x2) - x2 * (y - y2)) * inverse;
        float area = tl_max(s0, tl_max(s1, s2)) - p->penalty[i];
        best = area > most ? i : best;
        most = area > most ? area : most;
    }
    return best;
}

/* Four of many candidates into the front of the array. */
uint32_t tl_candidates_reduce(tl_candidate *c, uint32_t count, talus_vec3 n, float tolerance) {
    uint32_t deepest = 0, chosen[4] = {0, 0, 0, 0}, kept = 1;
    float reach2 = 0.0f;
    plan p;
    for (uint32_t i = 1; i < count; ++i) {
        deepest = c[i].gap < c[deepest].gap ? i : deepest;
        reach2 = tl_max(reach2, tl_length2(tl_sub(c[i].p, c[0].p)));
    }
    float least = c[deepest].gap, near = least + 1e-3f * sqrtf(reach2);
    /* of points about as deep the one of the lowest number, so that the choice does not flicker */
    chosen[0] = deepest;
    for (uint32_t i = 0; i < count; ++i) {
        chosen[0] = c[i].gap <= near && c[i].id < c[chosen[0]].id ? i : chosen[0];
    }
    float most = 0.0f;
    for (uint32_t i = 0; i < count; ++i) {
        float score = tl_length(tl_sub(c[i].p, c[chosen[0]].p)) - GAP_WEIGHT * (c[i].gap - least);
        chosen[1] = score > most ? i : chosen[1];
        most = score > most ? score : most;
    }
    if (most > 0.0f) {
        talus_vec3 from = c[chosen[0]].p, x = tl_sub(c[chosen[1]].p, from), y = tl_cross(n, x);
        p.xx = tl_length2(x);
        p.least_area = 1e-6f * most * most;
        for (uint32_t i = 0; i < count; ++i) {
            talus_vec3 d = tl_sub(c[i].p, from);
            p.x[i] = tl_dot(d, x);
            p.y[i] = tl_dot(d, y);
            p.penalty[i] = GAP_WEIGHT * most * (c[i].gap - least);
        }
        kept = 2;
        chosen[2] = third(&p, count);
        if (chosen[2] < count) {
            kept = 3;
            chosen[3] = fourth(&p, count, chosen[2]);
            kept += chosen[3] < count;
        }
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
