/* The profiler: a ring of the last frames inside the block. Each holds what a step took, stage by stage, what it did,
 * and the largest islands it solved, so that a frame that was late can be asked why when it is over.
 *
 * A world whose definition asks for `profile_capacity` frames keeps one of each step; a step with a clock fills in the
 * times, one without leaves them zero. The ring is no part of the state: it is not hashed, compared or saved, and a
 * restored world keeps the frames it has, whose step numbers tell what was run twice. Cost: some 700 bytes of block a
 * frame; the readings of the clock; and a count of the islands, O(awake bodies + touching contacts + joints), when one
 * of eight contacts and joints came or went since the last count, or any in the last four steps.
 *
 * Built with TALUS_NO_PROFILE the library has none of it, neither ring nor stage times: `profile_capacity` is taken
 * as 0 and a talus_profile comes back as zeros. */
#ifndef TALUS_PROFILE_H
#define TALUS_PROFILE_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TALUS_FRAME_ISLANDS 4u

/* An island that was solved in a step: dynamic bodies that touch or are tied together. Islands are solved side by side
 * in lanes, so none has a time of its own; `ticks` is its share of what the stages took: of narrow by its touching
 * contacts among the contacts looked at, of rows, solve, relax and restitution by its constraint rows, of velocity,
 * position and commit by its bodies. The other stages are shared out to none. */
typedef struct talus_frame_island {
    talus_body body; /* the one that most contacts and joints hold on to */
    uint32_t held;   /* how many those are */
    uint32_t bodies, contacts, joints;
    uint32_t rows; /* constraint rows: of a contact its points and 3 of friction, in a plane 1; of a joint its own */
    uint64_t ticks;
} talus_frame_island;

typedef struct talus_frame {
    uint64_t step;           /* the world's first step is 1 */
    talus_profile time;      /* ticks of the caller's clock */
    uint64_t profiler;       /* ticks that counting the islands took, in no stage */
    talus_counters counters; /* as talus_world_get_counters had them after the step */
    uint32_t islands;        /* solved in the step, those of a single body included */
    uint32_t islands_age; /* steps since they were counted: 0 if that was in this one, or nothing has changed since */
    uint32_t largest_count;
    talus_frame_island largest[TALUS_FRAME_ISLANDS]; /* by rows, then bodies */
} talus_frame;

/* How many frames the ring holds: no more than profile_capacity. */
uint32_t talus_world_frame_count(const talus_world *world);

/* A frame by its age: 0 is the last step. TALUS_BAD_ARGUMENT where the ring does not reach that far back. */
talus_status talus_world_get_frame(const talus_world *world, uint32_t age, talus_frame *out);

#ifdef __cplusplus
}
#endif

#endif
