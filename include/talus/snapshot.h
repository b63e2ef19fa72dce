/* Snapshots: the live state of a world as one run of bytes. A world that is restored goes on bit for bit as the one
 * that was saved did, in the middle of contacts, with joints, asleep, and whatever was made or destroyed in between. */
#ifndef TALUS_SNAPSHOT_H
#define TALUS_SNAPSHOT_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes that a snapshot of the world would have now; 0 for an unsound world. O(1). */
size_t talus_world_save_size(const talus_world *world);

/* Writes a snapshot to `out` (4-byte aligned). A copy of the live rows, without the geometry. TALUS_SMALL_BLOCK,
 * TALUS_UNALIGNED. */
talus_status talus_world_save(const talus_world *world, void *out, size_t bytes);

/* Puts a world of the same capacities back to a snapshot. Handles from before the snapshot hold again; those of objects
 * made since are stale. The instruction set stays as it is. Damaged counts and sizes are refused with TALUS_BAD_BLOB
 * and nothing changed; for bytes that cannot be trusted otherwise ask talus_world_validate afterwards. */
talus_status talus_world_restore(talus_world *world, const void *snapshot, size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
