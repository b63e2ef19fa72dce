/* The stages that are not kernels: one function each, called in this order by the pipeline. */
#ifndef TL_STAGES_H
#define TL_STAGES_H

#include "stage/kernels.h"

/* narrow: contacts of awake bodies begin, end, and get their manifolds; one that hardly moved keeps its own. Pairs
 * whose fat boxes parted end. */
void tl_stage_narrow(tl_step *step);

/* rows: body rows, then contacts and joints in groups of eight that share no moving body. */
void tl_stage_body_rows(tl_step *step);
void tl_stage_contact_groups(tl_step *step);
void tl_stage_joint_groups(tl_step *step);

/* Keeps velocities off the axes that a body is locked to. */
void tl_stage_locks(tl_step *step);

/* commit: poses and velocities back to the bodies. */
void tl_stage_commit(tl_step *step);

/* events: what began, ended, hit and broke. */
void tl_events_begin(tl_header *h);
void tl_stage_events(tl_step *step);
/* Tells the end of a touch that a contact had. */
void tl_event_contact_end(tl_header *h, uint32_t contact);

#endif
