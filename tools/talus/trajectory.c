#include "trajectory.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static void put(unsigned char *out, uint32_t value) {
    out[0] = (unsigned char)value;
    out[1] = (unsigned char)(value >> 8);
    out[2] = (unsigned char)(value >> 16);
    out[3] = (unsigned char)(value >> 24);
}

static void put_float(unsigned char *out, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(out, bits);
}

static void write_bytes(trajectory *t, const void *bytes, size_t size) {
    if (t->file != NULL && !t->failed && fwrite(bytes, 1, size, t->file) != size) {
        t->failed = errno != 0 ? errno : EIO;
    }
}

int trajectory_open(trajectory *t, const char *path, uint32_t bodies, uint32_t frames, float dt) {
    memset(t, 0, sizeof *t);
    t->bodies = bodies;
    t->frame = calloc((size_t)bodies + 1, TRAJECTORY_STATE);
    if (t->frame == NULL) {
        errno = ENOMEM;
        return 0;
    }
    if (path == NULL) {
        return 1;
    }
    t->file = fopen(path, "wb");
    if (t->file == NULL) {
        int reason = errno;
        free(t->frame);
        t->frame = NULL;
        errno = reason;
        return 0;
    }
    unsigned char header[TRAJECTORY_HEADER] = {'P', 'T', 'R', 'J'};
    put(header + 4, 1);
    put(header + 8, bodies);
    put(header + 12, frames);
    put_float(header + 16, dt);
    write_bytes(t, header, sizeof header);
    return 1;
}

void trajectory_frame(trajectory *t, float step_ms, const trajectory_state *states) {
    unsigned char time[4];
    put_float(time, step_ms);
    for (uint32_t i = 0; i < t->bodies; i++) {
        const trajectory_state *s = &states[i];
        const float values[13] = {s->pose.position.x, s->pose.position.y, s->pose.position.z, s->pose.rotation.x,
                                  s->pose.rotation.y, s->pose.rotation.z, s->pose.rotation.w, s->linear.x,
                                  s->linear.y,        s->linear.z,        s->angular.x,       s->angular.y,
                                  s->angular.z};
        for (size_t k = 0; k < 13; k++) {
            put_float(t->frame + (size_t)i * TRAJECTORY_STATE + 4 * k, values[k]);
        }
    }
    write_bytes(t, time, sizeof time);
    write_bytes(t, t->frame, (size_t)t->bodies * TRAJECTORY_STATE);
}

uint64_t trajectory_hash(const trajectory *t) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < (size_t)t->bodies * TRAJECTORY_STATE; i++) {
        hash = (hash ^ t->frame[i]) * 0x100000001b3u;
    }
    return hash;
}

int trajectory_close(trajectory *t) {
    int failed = t->failed;
    errno = 0;
    if (t->file != NULL && fclose(t->file) != 0 && !failed) {
        failed = errno != 0 ? errno : EIO;
    }
    free(t->frame);
    memset(t, 0, sizeof *t);
    errno = failed;
    return failed == 0;
}
