/* Whole files. */
#ifndef TALUS_HOST_FILE_H
#define TALUS_HOST_FILE_H

#include <stddef.h>

typedef enum host_file_status {
    HOST_FILE_OK,
    HOST_FILE_CANNOT_OPEN, /* errno says why */
    HOST_FILE_CANNOT_READ, /* errno says why */
    HOST_FILE_CANNOT_WRITE,
    HOST_FILE_TOO_LARGE,
    HOST_FILE_NO_MEMORY
} host_file_status;

/* Reads a regular file or a pipe of at most `limit` bytes. *bytes is freed by the caller and has a zero after its end.
 */
host_file_status host_file_read(const char *path, size_t limit, unsigned char **bytes, size_t *size);

/* Writes a file anew; "-" is the standard output. */
host_file_status host_file_write(const char *path, const void *bytes, size_t size);

#endif
