/* Trajectories (.ptrj), little-endian: char[4] "PTRJ"; u32 version 1, bodies, frames; f32 dt (s); u32 0; then for each
 * frame f32 step time (ms) and for each body 13 f32: position of its origin (m), orientation x y z w, velocity of its
 * centre of mass (m/s), angular velocity (rad/s), all in world axes. Frame 0 is the initial state. */
#ifndef TALUS_TOOL_TRAJECTORY_H
#define TALUS_TOOL_TRAJECTORY_H

#include "talus/types.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TRAJECTORY_HEADER 24u /* bytes */
#define TRAJECTORY_STATE 52u  /* bytes of a body */

typedef struct trajectory_state {
    talus_pose pose;
    talus_vec3 linear, angular;
} trajectory_state;

typedef struct trajectory {
    FILE *file; /* null: only the hash is made */
    uint32_t bodies;
    unsigned char *frame; /* the last one's states, as they stand in the file */
    int failed;
} trajectory;

/* Begins a file for `frames` frames, or none if `path` is null. 0 and errno if it cannot be made. */
int trajectory_open(trajectory *t, const char *path, uint32_t bodies, uint32_t frames, float dt);
void trajectory_frame(trajectory *t, float step_ms, const trajectory_state *states);
/* FNV-1a, 64 bits, over the last frame's states (its time left out). */
uint64_t trajectory_hash(const trajectory *t);
/* 0 and errno if anything could not be written. */
int trajectory_close(trajectory *t);

#endif
