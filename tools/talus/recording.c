#include "recording.h"

#include "host/file.h"
#include "tool.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BYTES ((size_t)-1 / 4) /* of a recording */

/* Memory at a multiple of the alignment; *memory is what is to be freed. */
static void *allocate(size_t bytes, size_t alignment, void **memory) {
    unsigned char *p = malloc(bytes + alignment);
    *memory = p;
    return p == NULL ? NULL : p + (alignment - (uintptr_t)p % alignment) % alignment;
}

static int read_bytes(recording *r, char *text, size_t room) {
    host_file_status status = host_file_read(r->path, MOST_BYTES, &r->bytes, &r->size);
    if (status == HOST_FILE_OK) {
        return 0;
    }
    snprintf(text, room, "%s: %s", r->path,
             status == HOST_FILE_TOO_LARGE   ? "the file is too large"
             : status == HOST_FILE_NO_MEMORY ? "there is no memory for the file"
                                             : strerror(errno));
    return GLTF_FAILED;
}

static int look_through(recording *r, char *text, size_t room) {
    if (talus_replay_open(&r->replay, r->bytes, r->size) == TALUS_OK) {
        return 0;
    }
    talus_fault fault = r->replay.fault;
    snprintf(text, room, "%s: offset %llu: %s", r->path, (unsigned long long)r->replay.offset, talus_fault_text(fault));
    return fault == TALUS_FAULT_OTHER_VERSION || fault == TALUS_FAULT_OTHER_LAYOUT ? GLTF_UNSUPPORTED : GLTF_BROKEN;
}

static int make_world(recording *r, char *text, size_t room) {
    r->block_bytes = talus_world_size(&r->replay.def);
    void *block = allocate(r->block_bytes, TALUS_BLOCK_ALIGNMENT, &r->block_memory);
    void *geometry = allocate(r->replay.geometry_bytes, TALUS_BLOB_ALIGNMENT, &r->geometry_memory);
    if (block == NULL || geometry == NULL) {
        snprintf(text, room, "%s: there is no memory for its world of %llu bytes", r->path,
                 (unsigned long long)r->block_bytes + r->replay.geometry_bytes);
        return GLTF_FAILED;
    }
    talus_status status =
        talus_replay_begin(&r->replay, &r->world, block, r->block_bytes, geometry, r->replay.geometry_bytes);
    if (status != TALUS_OK) {
        snprintf(text, room, "%s: its first state is not sound (%s)", r->path, talus_status_text(status));
        return GLTF_BROKEN;
    }
    return 0;
}

int recording_is(const char *path) {
    char head[8] = "";
    FILE *file = fopen(path, "rb");
    int is = file != NULL && fread(head, 1, sizeof head, file) == sizeof head && memcmp(head, "TALUSREC", 8) == 0;
    if (file != NULL) {
        fclose(file);
    }
    return is;
}

int recording_open(recording *out, const char *path, uint32_t frames, char *text, size_t room) {
    memset(out, 0, sizeof *out);
    out->path = path;
    int status = read_bytes(out, text, room);
    status = status == 0 ? look_through(out, text, room) : status;
    out->replay.def.profile_capacity = frames;
    status = status == 0 ? make_world(out, text, room) : status;
    if (status != 0) {
        recording_close(out);
    }
    return status;
}

void recording_close(recording *r) {
    free(r->bytes);
    free(r->block_memory);
    free(r->geometry_memory);
    memset(r, 0, sizeof *r);
}
