/* Candidates for the points of a manifold, and the choice among them. Metres. */
#ifndef TL_POINTS_H
#define TL_POINTS_H

#include "collide/feature.h"

typedef struct tl_candidate {
    talus_vec3 p; /* midway */
    float gap;
    uint32_t id;
} tl_candidate;

/* Brings the best four of more candidates to the front; how many were kept. */
uint32_t tl_candidates_reduce(tl_candidate *c, uint32_t count, talus_vec3 n, float tolerance);

/* One more point, where the others are not as deep to within the tolerance. */
uint32_t tl_candidates_add(const tl_candidate *own, float tolerance, tl_candidate *c, uint32_t count);

/* At most four candidates as a manifold. No point becomes nearer than the touch is. */
void tl_candidates_write(const tl_candidate *c, uint32_t count, const tl_touch *touch, tl_manifold *out);

#endif
