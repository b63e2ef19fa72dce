/* A text or a run of bytes that grows. */
#ifndef TALUS_GLTF_TEXT_H
#define TALUS_GLTF_TEXT_H

#include "gltf/error.h"

#include <stddef.h>

/* All zero is empty. After a lack of memory `failed` stays set and nothing is added any more. */
typedef struct gltf_text {
    char *data; /* has a zero after its end */
    size_t size, room;
    int failed;
} gltf_text;

void gltf_text_add(gltf_text *text, const char *format, ...) GLTF_PRINTF(2, 3);
void gltf_text_bytes(gltf_text *text, const void *bytes, size_t size);
/* A string as JSON has it, with its quotes. */
void gltf_text_quoted(gltf_text *text, const char *string);
/* Bytes as base64 (RFC 4648). */
void gltf_text_base64(gltf_text *text, const void *bytes, size_t size);
void gltf_text_free(gltf_text *text);

#endif
