#define _POSIX_C_SOURCE 200809L
#include "host/file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Reads until the end; *capacity bytes are there already. */
static host_file_status read_all(FILE *file, size_t limit, unsigned char **bytes, size_t *size, size_t capacity) {
    size_t used = 0;
    for (;;) {
        if (used == capacity) {
            size_t larger = capacity < limit / 2 ? capacity * 2 : limit + 1;
            unsigned char *more = capacity > limit ? NULL : realloc(*bytes, larger + 1);
            if (more == NULL) {
                return capacity > limit ? HOST_FILE_TOO_LARGE : HOST_FILE_NO_MEMORY;
            }
            *bytes = more;
            capacity = larger;
        }
        size_t got = fread(*bytes + used, 1, capacity - used, file);
        used += got;
        if (got == 0) {
            break;
        }
    }
    if (ferror(file)) {
        return HOST_FILE_CANNOT_READ;
    }
    if (used > limit) {
        return HOST_FILE_TOO_LARGE;
    }
    (*bytes)[used] = 0;
    *size = used;
    return HOST_FILE_OK;
}

host_file_status host_file_read(const char *path, size_t limit, unsigned char **bytes, size_t *size) {
    *bytes = NULL;
    *size = 0;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return HOST_FILE_CANNOT_OPEN;
    }
    struct stat about;
    size_t capacity = 65536;
    if (fstat(fileno(file), &about) == 0) {
        if (S_ISDIR(about.st_mode)) {
            fclose(file);
            errno = EISDIR;
            return HOST_FILE_CANNOT_READ;
        }
        if (S_ISREG(about.st_mode) && about.st_size >= 0) {
            if ((uintmax_t)about.st_size > limit) {
                fclose(file);
                return HOST_FILE_TOO_LARGE;
            }
            capacity = (size_t)about.st_size + 1;
        }
    }
    *bytes = malloc(capacity + 1);
    host_file_status status = *bytes == NULL ? HOST_FILE_NO_MEMORY : read_all(file, limit, bytes, size, capacity);
    int reason = errno;
    fclose(file);
    errno = reason;
    if (status != HOST_FILE_OK) {
        free(*bytes);
        *bytes = NULL;
    }
    return status;
}

host_file_status host_file_write(const char *path, const void *bytes, size_t size) {
    int standard = strcmp(path, "-") == 0;
    FILE *file = standard ? stdout : fopen(path, "wb");
    if (file == NULL) {
        return HOST_FILE_CANNOT_OPEN;
    }
    int bad = fwrite(bytes, 1, size, file) != size;
    bad |= fflush(file) != 0;
    int reason = errno;
    if (!standard) {
        bad |= fclose(file) != 0;
    }
    errno = reason;
    return bad ? HOST_FILE_CANNOT_WRITE : HOST_FILE_OK;
}
