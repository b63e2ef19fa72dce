/* What a restored state needs beside it: lists, pairs, trees and all that follows from the state. */
#ifndef TL_REINDEX_H
#define TL_REINDEX_H

#include "world/world_internal.h"

/* Marks that restoring leaves on what became another: island_parent of bodies, tl_shape_track.stale of shapes. */
#define TL_BODY_OTHER 1u
#define TL_SHAPE_OTHER 2u

/* How much became another. A contact counts that is not what stood in its slot, and if it takes one, its number stands
 * in contact_order and its body_a is TL_NONE. */
typedef struct tl_changes {
    uint32_t bodies, shapes;
    uint32_t metas; /* of the columns bodies and joints */
    uint32_t contacts;
} tl_changes;

/* Before restoring: clears the marks of bodies, of which there will be `bodies`, and notes in joint_group_pool which
 * joints keep bodies apart. */
void tl_reindex_begin(tl_header *h, uint32_t bodies);

/* What is in a contact's slot goes: its pair is left without one. */
void tl_reindex_part_contact(tl_header *h, uint32_t contact);

/* Brings the index in line with the state; `before` is the header of the state that the index was made for. What did
 * not become another keeps its place in trees and pairs. O(bodies + shapes + pairs + joints), and less
 * when only poses, velocities and contacts did. TALUS_BAD_BLOB if the
 * state points beyond itself. */
talus_status tl_reindex_end(tl_header *h, const tl_header *before, const tl_changes *changes);

#endif
