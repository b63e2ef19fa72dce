/* Groups of joints as the rows stage makes them. */
#ifndef TL_GROUPS_H
#define TL_GROUPS_H

#include "stage/stages.h"

/* Finds the contacts whose bodies are locked to one plane: fills contact_plane and sets step->planar if there may be
 * any. O(awake bodies + awake contacts) where some body is locked, else O(1). */
void tl_contact_planes(tl_step *step);

/* Whether two joints have the same rows and so may stand in one group. */
int tl_joints_alike(const tl_joint_record *a, const tl_joint_record *b);

/* An empty group for joints like j, or null if there is no room. `direct` is 1 for joints that are linked or exact:
 * what their solve begins with is no matter to it. */
tl_joint_group *tl_joint_group_open(tl_header *h, const tl_joint_record *j, uint32_t direct);

/* Puts a joint into the next lane of a group: what the joint and the state have of it, from which prepare_joints goes
 * on. x of a linked group holds the joint's last force. */
void tl_joint_group_add(const tl_step *step, tl_joint_group *g, uint32_t joint);

/* What linkage_of says of a joint beside its place in a linkage. */
#define TL_LINKAGE_NONE 0xffffffffu  /* it is in none */
#define TL_LINKAGE_READY 0xfffffffeu /* its group is made */
#define TL_LINKAGE_ALONE 0xfffffffcu /* it is in none, and exact */
#define TL_LINKAGE_APART 0xfffffffdu /* while they are looked for: with others, none of which is to be linked */
#define TL_LINKAGE_LOOSE                                                                                               \
    0xfffffffbu /* with others, for all of which there is no room, or in rings that are torn or whirl */

/* How many rows of a joint are solved with the linkage that it is in: equalities, then ranges. */
uint32_t tl_linked_rows(const tl_joint_record *j);

/* How much of linkage_nodes, linkage_blocks, linkage_values and linkage_places is taken. */
typedef struct tl_linkage_room {
    uint32_t nodes, blocks, values, places;
} tl_linkage_room;

/* Cuts a linkage of a shape, if it is one long path and there is room, and makes its groups. Returns whether it did. */
int tl_linkage_cut(tl_step *step, tl_linkage *l, const tl_linkage_shape *s, tl_linkage_room *room);

/* Finds the linkages among the awake joints, with the groups of those that are solved eight wide; linkage_of then has
 * for every awake joint its place, or TL_LINKAGE_NONE, _READY, _ALONE or _LOOSE. O(awake joints + blocks). */
void tl_linkages_find(tl_step *step);

/* Lets the joints of linkages that hang between several fixed places stretch a little, when their groups are made. */
void tl_linkages_soften(tl_header *h);

/* Notes in the groups, when all are made, which of the linkages are not exact. */
void tl_linkages_note_exact(tl_header *h);

/* Whether some awake bodies have so few contacts that they may be towers. O(awake bodies). */
int tl_towers_likely(const tl_header *h);

/* Marks by TL_TOWER in `pressed`, by rows, the bodies of towers that springs would not keep upright, whole ones of no
 * more than `room` contacts together; returns how many those are. Rows are filled. O(awake bodies). */
#define TL_TOWER 2u
uint32_t tl_towers_find(const tl_step *step, uint32_t *pressed, uint32_t room);

#endif
