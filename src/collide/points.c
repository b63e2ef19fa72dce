/* Choosing the points of a manifold: of many candidates four are kept, one of the deepest and then those that span
 * the most area, each weighed against how much less deep it is. Metres. */
#include "collide/points.h"

#include "base/spread.h"

#include <math.h>
#include <string.h>

/* A point this much less deep must be that times further out to be kept instead. */
#define GAP_WEIGHT 4.0f

/* To take points again: how much less deep they may be, of how far they are apart, and of the square of the area that
 * others span. */
#define STAY_DEEP 3e-4f
#define STAY_WIDE 0.5f

#define MAX_CANDIDATES (TL_MANIFOLD_POINTS + TL_MANIFOLD_OTHERS)

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

/* Brings the chosen ones to the front, in their order. */
static void bring_forward(tl_candidates *all, const uint32_t *chosen, uint32_t kept) {
    uint32_t at[4];
    memcpy(at, chosen, sizeof at);
    for (uint32_t i = 0; i < kept; ++i) {
        tl_candidate swap = all->c[i];
        all->c[i] = all->c[at[i]];
        all->c[at[i]] = swap;
        for (uint32_t k = i + 1u; k < kept; ++k) {
            at[k] = at[k] == i ? at[i] : at[k];
        }
    }
    all->kept = kept;
}

void tl_candidates_reduce(tl_candidates *all, talus_vec3 n, float tolerance) {
    const tl_candidate *c = all->c;
    uint32_t deepest = 0, chosen[4] = {0, 0, 0, 0}, kept = 1, count = all->count;
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
    bring_forward(all, chosen, kept);
}

/* One more point, where the others are not as deep. */
void tl_candidates_add(const tl_candidate *own, float tolerance, tl_candidates *all) {
    tl_candidate *c = all->c;
    uint32_t near = all->kept;
    float near2 = 3e38f;
    for (uint32_t i = 0; i < all->kept; ++i) {
        if (c[i].gap <= own->gap + tolerance) {
            return;
        }
        float d2 = tl_length2(tl_sub(c[i].p, own->p));
        near = d2 < near2 ? i : near;
        near2 = tl_min(near2, d2);
    }
    if (all->kept < TL_MANIFOLD_POINTS) {
        near = all->kept++;
    }
    if (near < all->count && all->count < MAX_CANDIDATES) {
        c[all->count++] = c[near];
    }
    c[near] = *own;
    all->count = all->count < all->kept ? all->kept : all->count;
}

/* No point is nearer than the shapes are; beside the face, within the slack, it may have seemed so. */
static void write_point(const tl_candidate *c, const tl_touch *touch, tl_manifold_point *out) {
    out->position = c->p;
    out->separation = tl_max(c->gap, touch->separation);
    out->id = c->id;
}

void tl_candidates_write(const tl_candidates *all, const tl_touch *touch, tl_manifold *out) {
    out->normal = touch->normal;
    out->count = all->kept;
    out->others = all->count - all->kept;
    for (uint32_t i = 0; i < all->kept; ++i) {
        write_point(&all->c[i], touch, &out->point[i]);
        uint32_t id = all->c[i].id;
        for (uint32_t k = 0; k < i; ++k) {
            if (out->point[k].id == id) {
                id += 0x4001u;
                k = UINT32_MAX;
            }
        }
        out->point[i].id = id;
    }
    for (uint32_t i = 0; i < out->others; ++i) {
        write_point(&all->c[all->kept + i], touch, &out->other[i]);
    }
}

/* --- points of before ----------------------------------------------------------------------------- */

/* How wide four points lie in the plane across n: the square of the area, to a factor; and their least separation. */
static float width_of(const tl_manifold_point *p, talus_vec3 n, float *least) {
    talus_vec3 at[4];
    *least = p[0].separation;
    for (uint32_t i = 0; i < 4u; ++i) {
        at[i] = tl_sub(p[i].position, p[0].position);
        *least = tl_min(*least, p[i].separation);
    }
    tl_spread s = tl_spread_of(at, 4u, n);
    return s.xx * s.yy - s.xy * s.xy;
}

static const tl_manifold_point *find_point(const tl_manifold *m, uint32_t id) {
    for (uint32_t i = 0; i < m->count; ++i) {
        if (m->point[i].id == id) {
            return &m->point[i];
        }
    }
    for (uint32_t i = 0; i < m->others; ++i) {
        if (m->other[i].id == id) {
            return &m->other[i];
        }
    }
    return NULL;
}

int tl_manifold_stay(tl_manifold *m, const uint32_t *id, uint32_t count) {
    tl_manifold_point again[4];
    if (m->others == 0 || count != 4u || m->count != 4u) {
        return 0;
    }
    for (uint32_t i = 0; i < 4u; ++i) {
        const tl_manifold_point *p = find_point(m, id[i]);
        if (!p) {
            return 0;
        }
        again[i] = *p;
    }
    float least_now, least_then, wide = width_of(m->point, m->normal, &least_now);
    float as_wide = width_of(again, m->normal, &least_then), reach = sqrtf(sqrtf(tl_max(wide, 0.0f)));
    if (!(as_wide >= STAY_WIDE * wide && least_then <= least_now + STAY_DEEP * reach)) {
        return 0;
    }
    memcpy(m->point, again, sizeof again);
    return 1;
}

float tl_manifold_least(const tl_manifold *m) {
    float least = m->point[0].separation;
    for (uint32_t i = 1; i < m->count; ++i) {
        least = tl_min(least, m->point[i].separation);
    }
    return least;
}
