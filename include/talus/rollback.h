/* Rolling back: the last states of a world in a ring, and what of a snapshot has to be sent to one who has an earlier
 * one. */
#ifndef TALUS_ROLLBACK_H
#define TALUS_ROLLBACK_H

#include "talus/snapshot.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- a ring of snapshots --- */

/* The newest snapshots of one world, as many as were asked for and fit. Netcode saves before every step; when the input
 * of a past step arrives it restores that step, gives the world the inputs from there on and steps to the present. */
typedef struct talus_ring {
    unsigned char *memory; /* the caller's */
    size_t bytes;
    uint32_t slots;
    uint32_t first, count; /* the oldest slot, and how many are in use */
} talus_ring;

/* Bytes for `slots` snapshots of the size that one has now, half as much again for growth, and room to write one. 0 for
 * an unsound world. */
size_t talus_ring_size(const talus_world *world, uint32_t slots);

/* An empty ring in `memory` (8-byte aligned). slots >= 1. TALUS_BAD_ARGUMENT, TALUS_UNALIGNED, TALUS_SMALL_BLOCK. */
talus_status talus_ring_init(talus_ring *ring, void *memory, size_t bytes, uint32_t slots);

/* Saves the world as it is before its step number counters.steps. Snapshots of that step and later ones go first: that
 * future is not going to be; then the oldest, until there is room. TALUS_SMALL_BLOCK if there never will be. */
talus_status talus_ring_save(talus_ring *ring, const talus_world *world);

/* Back to before `step`. TALUS_BAD_ARGUMENT if the ring does not hold it. */
talus_status talus_ring_restore(const talus_ring *ring, talus_world *world, uint64_t step);

/* The steps that the ring holds, oldest to newest; 0 if it is empty. */
int talus_ring_span(const talus_ring *ring, uint64_t *oldest, uint64_t *newest);

/* Saves into `memory`, steps, notes the hash, goes back and steps again; *same tells whether the hashes are equal. The
 * world ends one step further. memory: talus_world_save_size bytes. What a title in development runs in place of
 * talus_world_step to find what does not roll back. TALUS_SMALL_BLOCK and what talus_world_step answers. */
talus_status talus_world_step_twice(talus_world *world, float dt, void *memory, size_t bytes, int *same);

/* --- deltas --- */

/* Bytes of scratch memory that talus_delta_make needs for a base of this size. */
size_t talus_delta_scratch_size(size_t base_bytes);
/* The most bytes of a delta. */
size_t talus_delta_most(size_t snapshot_bytes);

/* What makes a snapshot of the base, another one of the same world: runs that are found in the base, wherever they are
 * there, and what differs in place as exclusive or, without its zero bytes. scratch: 4-byte aligned. O(bytes).
 * TALUS_BAD_ARGUMENT, TALUS_UNALIGNED, TALUS_SMALL_BLOCK, TALUS_FULL_SCRATCH. */
talus_status talus_delta_make(const void *base, size_t base_bytes, const void *snapshot, size_t bytes, void *scratch,
                              size_t scratch_bytes, void *out, size_t out_bytes, size_t *written);

/* Bytes of the snapshot that a delta makes; 0 if it is none. */
size_t talus_delta_result_size(const void *delta, size_t delta_bytes);

/* Makes the snapshot again. TALUS_BAD_BLOB for a delta that is damaged or of another base; then `out` holds nothing of
 * use. TALUS_SMALL_BLOCK if out_bytes < talus_delta_result_size. */
talus_status talus_delta_apply(const void *base, size_t base_bytes, const void *delta, size_t delta_bytes, void *out,
                               size_t out_bytes, size_t *written);

#ifdef __cplusplus
}
#endif

#endif
