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

/* Of the way that a body has slid in a resting contact since the manifold was made, this share is taken back in a
 * sub-step, so that what rests does not creep; what has slid further than TL_GRIP_REACH (m) slides. It is drawn back
 * against its load, which feeds a sway: four times as much keeps a house of cards swaying for good. */
#define TL_GRIP_SHARE 0.02f
#define TL_GRIP_REACH 5e-4f

/* Finds the presses among the contacts in groups. O(awake bodies), and where some are much heavier than others
 * O(awake contacts). */
void tl_stage_find_presses(tl_step *step);

/* Marks the groups of linkages in which some joint was too far from its place for one push; returns whether there are
 * any. Those that share groups are marked together. */
int tl_stage_far_linkages(tl_header *h);

/* Leaves those linkages marked as near in which all joints are. Those that share groups are near together. */
void tl_stage_near_linkages(tl_header *h);

/* Joints that pull at a body are a spring against its turning, the stiffer the harder they pull (the geometric
 * stiffness of Tournier, Nesme, Gilles and Faure, "Stable constrained dynamics", SIGGRAPH 2015). The sub-steps follow
 * it up to h^2 k / I = 4; beyond TL_MOST_STIFF the moment of inertia counts as so much larger (Andrews, Teichmann and
 * Kovecses, "Geometric stiffness for real-time constrained multibody dynamics", Eurographics 2017). */
void tl_stage_stiffness(tl_step *step);
#define TL_MOST_STIFF 1.0f
#define TL_STIFF_PULL (0.25f * TL_MOST_STIFF) /* of one joint: from here on it is looked what all of them make */

/* Of the least principal inertia against the middle one, inverted: from here on a body is slender. */
#define TL_SLENDER 3.0f

/* Keeps velocities and displacements off the axes that a body is locked to. */
void tl_stage_locks(tl_step *step);

/* events: what began, ended, hit and broke; touches are told from the groups of contacts. */
void tl_events_begin(tl_header *h);
void tl_stage_touches(tl_step *step);
void tl_stage_events(tl_step *step);
/* Tells the end of a touch that a contact had. */
void tl_event_contact_end(tl_header *h, uint32_t contact);

#endif
