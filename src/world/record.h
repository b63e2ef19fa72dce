/* The format of recordings.
 *
 * A head of 16 bytes: "TALUSREC", the version, the layout of the state (tl_state_layout). Then chunks, each a head of
 * five words and a payload: kind, bytes of the payload (a multiple of 4), steps done after it, checksum of the payload,
 * checksum of the head before it. All words are of four bytes, lowest first. Payloads:
 *
 *   WORLD     capacities: bodies, shapes, joints, contacts, events
 *   HULL      offset in the geometry region, then the blob, its words and half-words lowest byte first
 *   KEYFRAME  the hashes of all columns, of the whole and of what is awake, then a snapshot
 *   STEP      bytes of the commands, commands lost, whether the hashes of the whole follow (0, 1), the commands, a mask
 *             of 64 bits of the columns whose hash of what is awake is another than after the step before, these, and
 *             the hashes of the whole
 *   END       nothing
 *
 * WORLD comes first and a KEYFRAME with step 0 after it. A STEP that lost commands has a KEYFRAME right behind it. */
#ifndef TL_RECORD_H
#define TL_RECORD_H

#include "talus/record.h"

#define TL_RECORD_VERSION 2u
#define TL_RECORD_HEAD 16u                             /* bytes */
#define TL_RECORD_HASHES (8u * (size_t)TL_STATE_COUNT) /* bytes of both kinds of hashes */
#define TL_CHUNK_HEAD 20u

enum { TL_CHUNK_WORLD = 1, TL_CHUNK_HULL, TL_CHUNK_KEYFRAME, TL_CHUNK_STEP, TL_CHUNK_END, TL_CHUNK_KINDS };

/* A hash over bytes, a multiple of 4: any one word that changes changes it, and others by 2^-32 go unseen. */
uint32_t tl_record_checksum(const unsigned char *bytes, size_t size);

/* A hull's blob with its words lowest byte first, and back. Both copy `bytes` bytes. */
void tl_record_put_hull(unsigned char *out, const talus_hull *hull);
/* 0 unless the bytes are laid out as a hull; whether it is sound is for talus_hull_validate to say. */
int tl_record_get_hull(unsigned char *out, const unsigned char *in, size_t bytes);

#endif
