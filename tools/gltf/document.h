/* An opened glTF document: its JSON, its lists, and the bytes its accessors point into. glTF 2.0, sections 3.6
 * (buffers, accessors) and 4.4 (GLB). */
#ifndef TALUS_GLTF_DOCUMENT_H
#define TALUS_GLTF_DOCUMENT_H

#include "gltf/json.h"
#include "talus/types.h"

#include <stddef.h>

#define GLTF_FILE_LIMIT ((size_t)1 << 30) /* bytes of a scene or of a buffer's file */
#define GLTF_JSON_LIMIT ((size_t)1 << 28) /* bytes of JSON */

typedef struct gltf_bytes {
    const unsigned char *data; /* null: not looked for yet */
    size_t size;
    unsigned char *owned; /* freed at close; null in a GLB's own chunk */
} gltf_bytes;

/* Holds pointers into itself: not to be moved or copied once it is open. */
typedef struct gltf_document {
    gltf_error *error;
    const char *folder; /* where files that the document names are looked for; null: nowhere */
    cJSON *json;
    gltf_at root, extensions, rigid, implicit; /* the last two: the top-level extension objects */
    gltf_list nodes, meshes, accessors, views, buffers;
    gltf_list shapes, materials, filters, joints;
    gltf_bytes *bytes; /* of each buffer */
    gltf_bytes chunk;  /* the binary chunk of a GLB */
} gltf_document;

/* Opens a .gltf or .glb in memory. The bytes must outlive the document. Returns 0 and an error if it is broken; it is
 * to be closed in either case. */
int gltf_document_open(gltf_document *document, const void *bytes, size_t size, const char *folder, gltf_error *error);
void gltf_document_close(gltf_document *document);

/* The points of an accessor of VEC3s, at most `limit` of them; freed by the caller, null after an error. */
talus_vec3 *gltf_read_points(gltf_document *document, const gltf_at *accessor_index, uint32_t limit, uint32_t *count);

/* Bytes out of base64 text (RFC 4648, padding may be left out); null if it is none. Freed by the caller. */
unsigned char *gltf_base64_decode(const char *text, size_t length, size_t *size);

#endif
