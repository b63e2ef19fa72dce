/* What the files of the API share: looking handles up, and the lists that tie bodies, contacts and joints together. */
#ifndef TL_WORLD_INTERNAL_H
#define TL_WORLD_INTERNAL_H

#include "stage/broad/tree.h"
#include "stage/store/lists.h"
#include "stage/store/store.h"

/* The index behind a handle. TALUS_BAD_ARGUMENT for an unsound world, TALUS_STALE_HANDLE. */
talus_status tl_find_body(const talus_world *world, talus_body body, uint32_t *index);
talus_status tl_find_shape(const talus_world *world, talus_shape shape, uint32_t *index);
talus_status tl_find_joint(const talus_world *world, talus_joint joint, uint32_t *index);

/* TALUS_NOT_FINITE; TALUS_BAD_ARGUMENT for a coordinate beyond TALUS_MAX_COORDINATE and for a rotation of length 0. */
static inline talus_status tl_check_point(talus_vec3 p) {
    if (!tl_is_finite3(p)) {
        return TALUS_NOT_FINITE;
    }
    talus_vec3 far = tl_abs3(p);
    return tl_max(far.x, tl_max(far.y, far.z)) <= TALUS_MAX_COORDINATE ? TALUS_OK : TALUS_BAD_ARGUMENT;
}
static inline talus_status tl_check_pose(const talus_pose *p) {
    const talus_quat q = p->rotation;
    if (!tl_is_finite_pose(p)) {
        return TALUS_NOT_FINITE;
    }
    return q.x == 0.0f && q.y == 0.0f && q.z == 0.0f && q.w == 0.0f ? TALUS_BAD_ARGUMENT : tl_check_point(p->position);
}

/* TALUS_NOT_FINITE, TALUS_BAD_ARGUMENT. */
talus_status tl_check_accuracy(const talus_accuracy *accuracy);

static inline uint32_t tl_next_generation(uint32_t generation) { return generation + 1u ? generation + 1u : 1u; }

/* Whether a number that came from outside is an index below `high`, or a link (twice an index plus a side), or none. */
static inline int tl_is_index(uint32_t i, uint32_t high) { return i == TL_NONE || i < high; }
static inline int tl_is_link(uint32_t link, uint32_t high) { return link == TL_NONE || link >> 1 < high; }

/* The most bytes of a snapshot with every capacity used up. */
size_t tl_snapshot_most(const tl_header *h);

/* The pose of the body's origin. */
talus_pose tl_body_origin(const tl_header *h, uint32_t body);

/* Works out the body's mass from its shapes unless the caller set it, and all that follows from the mass frame. */
void tl_body_update_mass(talus_world *world, uint32_t body);
/* Takes the mass in the body's frame as it is. */
void tl_body_take_mass(talus_world *world, uint32_t body, const talus_mass *mass);

/* Removes a shape from trees, lists and pairs, without touching the body's mass. */
void tl_shape_remove(tl_header *h, uint32_t shape);

/* Whether an axis (0..2 linear, 3..5 angular) can have an error. */
int tl_joint_is_locked(const tl_joint_record *j, uint32_t axis);
/* Where the joint's frames stand in the bodies' mass frames. */
void tl_joint_place(const tl_header *h, tl_joint_record *joint);

/* Parts of talus_world_validate: whether a joint's numbers are in order and its rows what they are compiled to; whether
 * all floats are finite. The bodies' indices have been looked at. */
int tl_joint_is_compiled(const talus_world *world, uint32_t joint);
int tl_numbers_are_sound(const tl_header *h);

#endif
