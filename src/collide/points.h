/* Candidates for the points of a manifold, and the choice among them. Metres. */
#ifndef TL_POINTS_H
#define TL_POINTS_H

#include "collide/feature.h"

typedef struct tl_candidate {
    talus_vec3 p; /* midway */
    float gap;
    uint32_t id;
} tl_candidate;

/* The first `kept` of them are the manifold's, the rest were left out. */
typedef struct tl_candidates {
    tl_candidate c[TL_MANIFOLD_POINTS + TL_MANIFOLD_OTHERS];
    uint32_t kept, count;
} tl_candidates;

/* Brings the best four of more candidates to the front, and leaves the rest behind them. */
void tl_candidates_reduce(tl_candidates *c, talus_vec3 n, float tolerance);

/* One more point, where the others are not as deep to within the tolerance. */
void tl_candidates_add(const tl_candidate *own, float tolerance, tl_candidates *c);

/* The candidates as a manifold. No point becomes nearer than the touch is. */
void tl_candidates_write(const tl_candidates *c, const tl_touch *touch, tl_manifold *out);

#endif
