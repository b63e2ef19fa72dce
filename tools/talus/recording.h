/* A recording's file with the world that it is replayed in. */
#ifndef TALUS_TOOL_RECORDING_H
#define TALUS_TOOL_RECORDING_H

#include "talus/talus.h"

typedef struct recording {
    const char *path;
    unsigned char *bytes;
    size_t size;
    talus_replay replay;
    talus_world world; /* in the state before the first step */
    size_t block_bytes;
    void *block_memory, *geometry_memory; /* as they were allocated */
} recording;

/* Whether a file begins as a recording does. */
int recording_is(const char *path);

/* Reads a recording, looks it through and makes its world, with a ring of `frames` for the profiler; 0, or an exit
 * status with what is wrong in `text` and nothing to close. */
int recording_open(recording *out, const char *path, uint32_t frames, char *text, size_t room);
void recording_close(recording *r);

#endif
