/* Snapshots: the live state of a world as one run of bytes. A world that is restored goes on bit for bit as the one
 * that was saved did, in the middle of contacts, with joints, asleep, and whatever was made or destroyed in between. */
#ifndef TALUS_SNAPSHOT_H
#define TALUS_SNAPSHOT_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most bytes that a snapshot of the world may have now, some two or three times what it will have; 0 for an unsound
 * world. O(columns). */
size_t talus_world_save_size(const talus_world *world);

/* Writes a snapshot to `out`, of `bytes` >= talus_world_save_size, and its size to `written`. The bytes are the same on
 * every machine. Without the geometry. The block keeps what was written of masses, shapes and materials, for the next
 * time: one world is saved by one thread at a time. O(live rows). TALUS_SMALL_BLOCK. */
talus_status talus_world_save(const talus_world *world, void *out, size_t bytes, size_t *written);

/* Puts a world of the same capacities back to a snapshot. Handles from before the snapshot hold again; those of objects
 * made since are stale. The instruction set stays as it is, and so does what the broad phase knows of shapes that are
 * where they were; interpolation begins at the restored poses. A snapshot that is damaged, cut off or of other
 * capacities is refused with TALUS_BAD_BLOB and nothing changed; one that was made to deceive the checksum may leave
 * the world empty. O(live rows). */
talus_status talus_world_restore(talus_world *world, const void *snapshot, size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
