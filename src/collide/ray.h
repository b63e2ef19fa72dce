/* Rays against convex shapes, in closed form and in double. Metres. */
#ifndef TL_RAY_H
#define TL_RAY_H

#include "collide/polytope.h"

typedef struct tl_ray_hit {
    double at;    /* part of the way, 0..1 */
    tl_d3 normal; /* unit, out of the shape; 0 if the ray starts within */
    int within;   /* the ray starts in the shape, which is solid and closed */
} tl_ray_hit;

/* Whether the points origin + t way, t in [0, 1], meet a shape at a pose; where first. A way of length 0 is a point. */
int tl_ray_convex(const tl_convex *shape, const talus_pose *pose, tl_d3 origin, tl_d3 way, tl_ray_hit *out);

#endif
