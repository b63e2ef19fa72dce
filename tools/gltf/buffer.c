/* The bytes behind accessors: buffers out of data URIs, files beside the scene, or the GLB itself. Each is looked for
 * when it is first used, so that a picture's buffer may be missing. */
#include "gltf/document.h"

#include "host/file.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

unsigned char *gltf_base64_decode(const char *text, size_t length, size_t *size) {
    if (length > 0 && length % 4 == 0 && text[length - 1] == '=') {
        length -= text[length - 2] == '=' ? 2 : 1;
    }
    if (length % 4 == 1) {
        return NULL;
    }
    unsigned char *bytes = malloc(length / 4 * 3 + 4);
    if (bytes == NULL) {
        return NULL;
    }
    size_t used = 0;
    uint32_t bits = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit(text[i]);
        if (digit < 0) {
            free(bytes);
            return NULL;
        }
        bits = bits << 6 | (uint32_t)digit;
        if (i % 4 > 0) {
            bytes[used++] = (unsigned char)(bits >> (6 - 2 * (i % 4)) & 255u);
        }
    }
    *size = used;
    return bytes;
}

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    c = (char)(c | 32);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* `folder`/`uri` with %20 and its like undone; null if it is not a relative path. */
static char *file_path(const char *folder, const char *uri) {
    size_t prefix = strlen(folder);
    char *path = malloc(prefix + strlen(uri) + 2);
    if (path == NULL) {
        return NULL;
    }
    memcpy(path, folder, prefix);
    char *out = path + prefix;
    if (prefix > 0) {
        *out++ = '/';
    }
    const char *start = out;
    for (; *uri; uri++) {
        int high = *uri == '%' ? hex_digit(uri[1]) : -1;
        int low = high >= 0 ? hex_digit(uri[2]) : -1;
        if (low >= 0) {
            *out++ = (char)(high * 16 + low);
            uri += 2;
        } else {
            *out++ = *uri;
        }
    }
    *out = 0;
    if (*start == 0 || *start == '/' || strlen(start) != (size_t)(out - start)) {
        free(path);
        return NULL;
    }
    return path;
}

static void read_file(gltf_document *document, const gltf_at *at, const char *uri, gltf_bytes *bytes) {
    if (document->folder == NULL) {
        gltf_fail(at, GLTF_UNSUPPORTED, "names a file, but this scene is in no folder");
        return;
    }
    if (strstr(uri, "://") != NULL) {
        gltf_fail(at, GLTF_UNSUPPORTED, "is \"%.40s\", must be a data URI or the name of a file", uri);
        return;
    }
    char *path = file_path(document->folder, uri);
    if (path == NULL) {
        gltf_fail(at, GLTF_BROKEN, "is \"%.40s\", must be a data URI or a path from the scene's folder", uri);
        return;
    }
    host_file_status status = host_file_read(path, GLTF_FILE_LIMIT, &bytes->owned, &bytes->size);
    bytes->data = bytes->owned;
    if (status == HOST_FILE_TOO_LARGE) {
        gltf_fail(at, GLTF_UNSUPPORTED, "%.200s: has more than %lu bytes", path, (unsigned long)GLTF_FILE_LIMIT);
    } else if (status != HOST_FILE_OK) {
        gltf_fail(at, GLTF_FAILED, "%.200s: %s", path, status == HOST_FILE_NO_MEMORY ? "no memory" : strerror(errno));
    }
    free(path);
}

static void read_data_uri(const gltf_at *at, const char *uri, gltf_bytes *bytes) {
    const char *data = strstr(uri, ";base64,");
    if (data == NULL) {
        gltf_fail(at, GLTF_UNSUPPORTED, "is a data URI without \";base64,\"");
        return;
    }
    data += strlen(";base64,");
    bytes->owned = gltf_base64_decode(data, strlen(data), &bytes->size);
    bytes->data = bytes->owned;
    if (bytes->owned == NULL) {
        gltf_fail(at, GLTF_BROKEN, "is no base64 after \";base64,\"");
    }
}

static const gltf_bytes *read_buffer(gltf_document *document, int index) {
    gltf_bytes *bytes = &document->bytes[index];
    if (bytes->data != NULL) {
        return bytes;
    }
    gltf_at buffer = gltf_list_item(&document->buffers, index);
    gltf_at at = gltf_member(&buffer, "uri");
    const char *uri = gltf_string(&buffer, "uri");
    if (uri != NULL && strncmp(uri, "data:", 5) == 0) {
        read_data_uri(&at, uri, bytes);
    } else if (uri != NULL) {
        read_file(document, &at, uri, bytes);
    } else if (index == 0 && document->chunk.data != NULL) {
        *bytes = document->chunk;
    } else {
        gltf_fail(&at, GLTF_BROKEN, "is missing, and the file has no binary chunk for it");
    }
    if (!gltf_failed(&buffer)) {
        gltf_at length = gltf_member(&buffer, "byteLength");
        double stated = gltf_whole(&buffer, "byteLength", -1, 1e15);
        if (stated < 0) {
            gltf_fail(&length, GLTF_BROKEN, "is missing");
        } else if (stated > (double)bytes->size) {
            gltf_fail(&length, GLTF_BROKEN, "is %.0f, but the buffer has %lu bytes", stated,
                      (unsigned long)bytes->size);
        }
    }
    return gltf_failed(&buffer) ? NULL : bytes;
}

typedef struct component {
    int code, size;
    double scale; /* of a normalized value */
} component;

static const component *find_component(int code) {
    static const component known[] = {
        {5120, 1, 1.0 / 127}, {5121, 1, 1.0 / 255}, {5122, 2, 1.0 / 32767}, {5123, 2, 1.0 / 65535}, {5126, 4, 1.0}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (known[i].code == code) {
            return &known[i];
        }
    }
    return NULL;
}

static double read_component(int code, const unsigned char *p) {
    if (code == 5120 || code == 5121) {
        return code == 5121 ? p[0] : p[0] < 128 ? p[0] : p[0] - 256;
    }
    int pair = p[0] | p[1] << 8;
    if (code == 5122 || code == 5123) {
        return code == 5123 ? pair : pair < 32768 ? pair : pair - 65536;
    }
    uint32_t bits = (uint32_t)pair | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Where an accessor's elements lie. */
typedef struct layout {
    const unsigned char *data;
    size_t stride;
    uint32_t count;
    int code;
    double scale;
} layout;

/* The bytes of a buffer view, of which those from `skip` on are asked for. */
static const unsigned char *read_view(gltf_document *document, const gltf_at *accessor, size_t *size, double *stride) {
    gltf_at at = gltf_member(accessor, "bufferView");
    int index = gltf_index(accessor, "bufferView", document->views.count, "buffer views");
    if (index < 0) {
        gltf_fail(&at, GLTF_UNSUPPORTED, "is missing: an accessor of zeros is not a shape");
        return NULL;
    }
    gltf_at view = gltf_list_item(&document->views, index);
    int buffer = gltf_index(&view, "buffer", document->buffers.count, "buffers");
    double offset = gltf_whole(&view, "byteOffset", 0, 1e15), length = gltf_whole(&view, "byteLength", -1, 1e15);
    *stride = gltf_whole(&view, "byteStride", 0, 252);
    gltf_at length_at = gltf_member(&view, "byteLength");
    if (!gltf_failed(&view) && (buffer < 0 || length < 0)) {
        gltf_fail(&view, GLTF_BROKEN, "has no %s", buffer < 0 ? "buffer" : "byteLength");
    }
    const gltf_bytes *bytes = gltf_failed(&view) ? NULL : read_buffer(document, buffer);
    if (bytes == NULL) {
        return NULL;
    }
    if (offset + length > (double)bytes->size) {
        gltf_fail(&length_at, GLTF_BROKEN, "is %.0f from byteOffset %.0f on, but buffer %d has %lu bytes", length,
                  offset, buffer, (unsigned long)bytes->size);
        return NULL;
    }
    *size = (size_t)length;
    return bytes->data + (size_t)offset;
}

static int find_layout(gltf_document *document, const gltf_at *accessor, uint32_t limit, layout *out) {
    if (gltf_has(accessor, "sparse")) {
        gltf_at sparse = gltf_member(accessor, "sparse");
        gltf_fail(&sparse, GLTF_UNSUPPORTED, "sparse accessors are not read");
        return 0;
    }
    const char *type = gltf_string(accessor, "type");
    gltf_at type_at = gltf_member(accessor, "type"), code_at = gltf_member(accessor, "componentType");
    if (type == NULL || strcmp(type, "VEC3") != 0) {
        gltf_fail(&type_at, GLTF_BROKEN, "is %.20s, positions must be \"VEC3\"", type != NULL ? type : "missing");
        return 0;
    }
    int code = (int)gltf_whole(accessor, "componentType", 0, 1e6);
    const component *kind = find_component(code);
    if (kind == NULL) {
        gltf_fail(&code_at, GLTF_BROKEN, "is %d, positions must be 5126 (float) or 5120 to 5123", code);
        return 0;
    }
    out->code = code;
    out->scale = gltf_flag(accessor, "normalized", 0) ? kind->scale : 1.0;
    gltf_at count_at = gltf_member(accessor, "count");
    double count = gltf_whole(accessor, "count", 0, 1e15), offset = gltf_whole(accessor, "byteOffset", 0, 1e15);
    size_t size = 0;
    double stride = 0;
    const unsigned char *data = read_view(document, accessor, &size, &stride);
    if (data == NULL) {
        return 0;
    }
    double element = 3.0 * kind->size;
    stride = stride > 0 ? stride : element;
    if (count < 1) {
        gltf_fail(&count_at, GLTF_BROKEN, "must be at least 1");
    } else if (stride < element) {
        gltf_fail(accessor, GLTF_BROKEN, "its elements have %.0f bytes, but its view's byteStride is %.0f", element,
                  stride);
    } else if (offset + stride * (count - 1) + element > (double)size) {
        gltf_fail(&count_at, GLTF_BROKEN, "is %.0f from byteOffset %.0f on, but its buffer view has %lu bytes", count,
                  offset, (unsigned long)size);
    } else if (count > limit) {
        gltf_fail(&count_at, GLTF_UNSUPPORTED, "is %.0f, a hull may have at most %lu points", count,
                  (unsigned long)limit);
    }
    if (gltf_failed(accessor)) {
        return 0;
    }
    out->data = data + (size_t)offset;
    out->stride = (size_t)stride;
    out->count = (uint32_t)count;
    return 1;
}

talus_vec3 *gltf_read_points(gltf_document *document, const gltf_at *accessor_index, uint32_t limit, uint32_t *count) {
    int index = gltf_index_here(accessor_index, document->accessors.count, "accessors");
    if (index < 0) {
        return NULL;
    }
    gltf_at accessor = gltf_list_item(&document->accessors, index);
    layout found;
    if (!find_layout(document, &accessor, limit, &found)) {
        return NULL;
    }
    talus_vec3 *points = malloc(found.count * sizeof *points);
    if (points == NULL) {
        gltf_fail(&accessor, GLTF_FAILED, "there is no memory for its %lu points", (unsigned long)found.count);
        return NULL;
    }
    size_t width = found.code == 5126 ? 4 : found.code >= 5122 ? 2 : 1;
    for (uint32_t i = 0; i < found.count; i++) {
        float xyz[3];
        for (size_t k = 0; k < 3; k++) {
            double value = read_component(found.code, found.data + found.stride * i + width * k) * found.scale;
            if (!(fabs(value) <= 1e6)) {
                gltf_fail(&accessor, GLTF_BROKEN, "component %d of point %lu is %g, must be finite and at most 1e6 m",
                          (int)k, (unsigned long)i, value);
                free(points);
                return NULL;
            }
            xyz[k] = (float)value;
        }
        points[i].x = xyz[0];
        points[i].y = xyz[1];
        points[i].z = xyz[2];
    }
    *count = found.count;
    return points;
}
