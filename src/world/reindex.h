/* What a restored state needs beside it: lists, pairs, trees and all that follows from the state. */
#ifndef TL_REINDEX_H
#define TL_REINDEX_H

#include "world/world_internal.h"

/* Marks that restoring leaves on what became another: island_parent of bodies, tl_shape_track.stale of shapes. */
#define TL_BODY_OTHER 1u
#define TL_SHAPE_OTHER 2u

/* What else became another. */
typedef struct tl_changes {
    uint32_t metas;    /* not 0: something in the columns bodies or joints */
    uint32_t contacts; /* how many; those that took a slot have body_a TL_NONE, and the pairs of those that left it are
                          without one */
} tl_changes;

/* Before restoring: clears the marks of bodies, of which there will be `bodies`, and notes in joint_group_pool which
 * joints keep bodies apart. */
void tl_reindex_begin(tl_header *h, uint32_t bodies);

/* Brings the index in line with the state; `before` is the header of the state that the index was made for. What did
 * not become another keeps its place in trees and pairs. O(bodies + shapes + pairs + joints). TALUS_BAD_BLOB if the
 * state points beyond itself. */
talus_status tl_reindex_end(tl_header *h, const tl_header *before, const tl_changes *changes);

#endif
