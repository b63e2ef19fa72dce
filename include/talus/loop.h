/* A fixed-timestep driver: real time in, whole steps out, and how far the picture is between two of them. */
#ifndef TALUS_LOOP_H
#define TALUS_LOOP_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct talus_loop {
    float dt;           /* s, of one step */
    uint32_t max_steps; /* of one frame; what is left beyond is dropped, so that a slow machine does not fall behind for
                           ever */
    double accumulator; /* s not yet stepped, below dt after an advance */
    double dropped;     /* s given up so far */
    float alpha;        /* 0..1: how far the present lies between the last two states */
} talus_loop;

/* dt in (0, 1], max_steps >= 1. */
talus_status talus_loop_init(talus_loop *loop, float dt, uint32_t max_steps);
/* Takes in `elapsed` seconds (>= 0); *steps receives how many steps are due now. TALUS_NOT_FINITE, TALUS_BAD_ARGUMENT.
 */
talus_status talus_loop_advance(talus_loop *loop, double elapsed, uint32_t *steps);

/* A body's pose between its last two states: position on the line, rotation on the arc, by loop->alpha. */
talus_status talus_body_get_interpolated_pose(const talus_world *world, talus_body body, float alpha, talus_pose *out);

#ifdef __cplusplus
}
#endif

#endif
