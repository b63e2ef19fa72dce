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

/* At most this time: the caller's clock, between steps, sets how exact they are.
 *
 * Under an error budget (talus_accuracy) a step takes the longer the more sub-steps islands are given. This picks how
 * many they may be given: half as many after a step that took longer than it may, twice as many when none of the last
 * thirty took half of that. What it picks is for talus_world_set_accuracy, which is a command as others are: whatever
 * the clock said, a recording has the numbers that came of it and replays are the same to the bit. The library itself
 * reads no clock, and steps depend on none.
 *
 *     double before = seconds();
 *     talus_world_step(&world, dt, NULL, NULL);
 *     talus_accuracy next;
 *     if (talus_time_budget_advance(&budget, seconds() - before, &next) == TALUS_OK) {
 *         talus_world_set_accuracy(&world, &next);
 *     }
 */
typedef struct talus_time_budget {
    double seconds;         /* that a step may take */
    talus_accuracy wanted;  /* where there is time enough; where there is not, no island gets more than `substeps` */
    uint32_t most_substeps; /* of the next step: between those two */
    uint32_t quick;         /* steps in a row that took less than half of the time */
} talus_time_budget;

/* seconds > 0; an accuracy as talus_world_set_accuracy takes, with an error budget and substeps <= most_substeps. It
 * begins with the fewest sub-steps. TALUS_NOT_FINITE, TALUS_BAD_ARGUMENT. */
talus_status talus_time_budget_init(talus_time_budget *budget, double seconds, const talus_accuracy *wanted);
/* Takes in the seconds (>= 0) that the last step took; *next receives the accuracy of the next one. TALUS_NOT_FINITE,
 * TALUS_BAD_ARGUMENT. */
talus_status talus_time_budget_advance(talus_time_budget *budget, double took, talus_accuracy *next);

/* A body's pose between its last two states: position on the line, rotation on the arc, by loop->alpha. */
talus_status talus_body_get_interpolated_pose(const talus_world *world, talus_body body, float alpha, talus_pose *out);

#ifdef __cplusplus
}
#endif

#endif
