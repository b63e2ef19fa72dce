/* The vertex of a hull furthest along a direction: a table of where to begin, by direction (the sides of a cube around
 * the hull, cut into squares), and the climb from there. Metres. */
#ifndef TL_HULL_CLIMB_H
#define TL_HULL_CLIMB_H

#include "base/vec.h"
#include "geom/hull.h"

/* Hulls of no more vertices than this have no table: to look at all of them is no dearer. */
#define TL_HULL_SCANNED 64u

/* Squares along a cube's edge: about as many squares as vertices. O(result). */
uint32_t tl_hull_squares(uint32_t vertex_count);

/* Writes the table of a blob whose other arrays are there. */
void tl_hull_fill_directions(talus_hull *h);

/* From vertex to higher neighbour as long as there is one. */
uint32_t tl_hull_climb(const talus_hull *h, talus_vec3 direction, uint32_t vertex);

/* A vertex near to the furthest along a finite direction; of a hull without a table the first. A hint: a blob is sound
 * whatever vertices its table names. */
static inline uint32_t tl_hull_seed(const talus_hull *h, talus_vec3 d) {
    uint32_t n = h->squares;
    talus_vec3 a = tl_abs3(d);
    float u, v, w, most;
    uint32_t side;
    if (n == 0u) {
        return 0u;
    }
    if (a.x >= a.y && a.x >= a.z) {
        side = 0u, w = d.x, most = a.x, u = d.y, v = d.z;
    } else if (a.y >= a.z) {
        side = 2u, w = d.y, most = a.y, u = d.z, v = d.x;
    } else {
        side = 4u, w = d.z, most = a.z, u = d.x, v = d.y;
    }
    if (!(most > 1e-30f)) {
        return 0u;
    }
    side += w > 0.0f;
    float scale = 0.5f * (float)n / most, half = 0.5f * (float)n;
    uint32_t i = (uint32_t)tl_max(0.0f, u * scale + half), k = (uint32_t)tl_max(0.0f, v * scale + half);
    i = i < n ? i : n - 1u;
    k = k < n ? k : n - 1u;
    return tl_hull_directions(h)[(side * n + i) * n + k];
}

#endif
