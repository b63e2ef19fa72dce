/* When two moving convex shapes first touch. Metres, radians; time from 0 to 1. */
#ifndef TL_ADVANCE_H
#define TL_ADVANCE_H

#include "collide/vclip.h"

/* A shape on its way: its centre moves along a line and it turns about the centre, both evenly. */
typedef struct tl_moving {
    tl_polytope core;
    tl_frame start;
    tl_d3 center; /* in the shape's frame */
    tl_d3 at;     /* the centre at time 0 */
    tl_d3 move;   /* of the centre in the whole time */
    tl_d3 turn;   /* rotation vector in the whole time, in the common frame: at most half a turn long */
    tl_d3 axis;   /* of unit length, or 0 */
    double angle; /* the length of turn */
    double reach; /* no point of the core is further from the centre */
} tl_moving;

/* *out points to the shape and into itself: not to be copied. */
void tl_moving_init(tl_moving *out, const tl_convex *shape, const talus_motion *motion);
tl_frame tl_moving_frame(const tl_moving *m, double time);

/* The first time at which the gap is at most `tolerance`, or 4e-6 of the sizes if that is more: out in the common
 * frame. Advancement may tell a contact after `last` as a miss; until then the answer has the same bits whatever `last`
 * is. */
void tl_advance(const tl_moving *a, const tl_moving *b, float tolerance, double last, talus_time_method method,
                talus_feature_pair *features, talus_contact_time *out);

/* What talus_time_of_contact answers to a motion, and to a tolerance. */
talus_status tl_motion_check(const talus_motion *motion);
talus_status tl_tolerance_check(float tolerance);

#endif
