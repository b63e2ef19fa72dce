/* All laned kernels, once for the lanes that the including file has chosen; it defines TL_KERNELS as the table's name.
 */
#include <string.h>

#include "stage/stages.h"

#include "base/vec_lanes.h"
#include "base/width_eight.h"

#include "stage/motion/motion.inl" /* first: it has what rows are loaded by */

#include "stage/commit/commit.inl"
#include "stage/narrow/batch.inl"
#include "stage/narrow/box_batch.inl"
#include "stage/row/body_rows.inl"
#include "stage/row/contact_rows.inl"
#include "stage/row/joint_rows.inl"
#include "stage/solve/contacts.inl"
#include "stage/solve/impacts.inl"
#include "stage/solve/joints.inl"
#include "stage/solve/linked_joints.inl"
#include "stage/solve/presses.inl"

const tl_kernels TL_KERNELS = {
    place_pairs,
    collide_balls,
    collide_capsules,
    collide_boxes,
    fill_bodies,
    velocity,
    position,
    fly,
    push,
    commit,
    prepare_contacts,
    warm_contacts,
    solve_contacts,
    relax_contacts,
    push_contacts,
    strike_contacts,
    store_contacts,
    prepare_joints,
    begin_joints,
    turn_joints,
    solve_joints,
    relax_joints,
    push_joints,
    store_joints,
    read_velocities,
    read_errors,
    apply_impulses,
    apply_pushes,
    solve_linkages,
    begin_presses,
    press_velocities,
    press_errors,
};
