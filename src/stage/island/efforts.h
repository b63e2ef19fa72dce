/* Efforts: how many sub-steps each island gets under an error budget. */
#ifndef TL_EFFORTS_H
#define TL_EFFORTS_H

#include "stage/kernels.h"

/* 64 sub-steps for one. */
#define TL_EFFORT_LEVELS 7u

/* Brings the bodies of an island to one level, the highest that any of them has. Returns a bit for each level that
 * there is; counters begin. */
uint32_t tl_efforts_begin(tl_step *step);
/* Leaves awake only the bodies, contacts and joints of the step's level, if there are others. */
void tl_efforts_select(tl_step *step);
/* When they were solved: their impulses as those of a sub-step of level 0, their errors to the islands. */
void tl_efforts_note(tl_step *step);
/* All that is awake is awake again, and each island gets the level of the next step. */
void tl_efforts_end(tl_step *step);

#endif
