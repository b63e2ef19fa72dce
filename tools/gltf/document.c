#include "gltf/document.h"

#include <stdlib.h>
#include <string.h>

static uint32_t little(const unsigned char *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* Finds the two chunks of a GLB (glTF 2.0, section 4.4). */
static int split_glb(gltf_document *document, const unsigned char *bytes, size_t size, const char **text,
                     size_t *length) {
    gltf_error *error = document->error;
    if (size < 20) {
        gltf_error_set(error, GLTF_BROKEN, "$: the GLB ends within its header");
        return 0;
    }
    uint32_t version = little(bytes + 4), total = little(bytes + 8);
    if (version != 2) {
        gltf_error_set(error, GLTF_UNSUPPORTED, "$: a GLB of version %u, must be 2", (unsigned)version);
        return 0;
    }
    if (total > size) {
        gltf_error_set(error, GLTF_BROKEN, "$: the GLB says that it has %u bytes, but the file has %lu",
                       (unsigned)total, (unsigned long)size);
        return 0;
    }
    size_t at = 12;
    for (int i = 0; at <= total && total - at >= 8; i++) {
        uint32_t chunk = little(bytes + at), kind = little(bytes + at + 4);
        at += 8;
        if (chunk > total - at || chunk % 4 != 0) {
            gltf_error_set(error, GLTF_BROKEN, "$: chunk %d of the GLB says that it has %u bytes, %s", i,
                           (unsigned)chunk, chunk % 4 ? "must be a multiple of 4" : "more than the GLB has left");
            return 0;
        }
        if (i == 0 && kind != 0x4e4f534a) { /* "JSON" */
            gltf_error_set(error, GLTF_BROKEN, "$: the first chunk of the GLB is not JSON");
            return 0;
        }
        if (i == 0) {
            *text = (const char *)bytes + at;
            *length = chunk;
        } else if (i == 1 && kind == 0x004e4942) { /* "BIN" */
            document->chunk.data = bytes + at;
            document->chunk.size = chunk;
        }
        at += chunk;
    }
    if (*text == NULL) {
        gltf_error_set(error, GLTF_BROKEN, "$: the GLB has no chunk");
        return 0;
    }
    return 1;
}

static int parse(gltf_document *document, const char *text, size_t length) {
    if (length > GLTF_JSON_LIMIT) {
        gltf_error_set(document->error, GLTF_UNSUPPORTED, "$: %lu bytes of JSON, at most %lu are read",
                       (unsigned long)length, (unsigned long)GLTF_JSON_LIMIT);
        return 0;
    }
    const char *end = text;
    document->json = cJSON_ParseWithLengthOpts(text, length, &end, 0);
    size_t stop = end >= text && end <= text + length ? (size_t)(end - text) : length;
    if (document->json == NULL) {
        size_t line = 1;
        for (size_t i = 0; i < stop; i++) {
            line += text[i] == '\n';
        }
        gltf_error_set(document->error, GLTF_BROKEN,
                       "$: no JSON at byte %lu (line %lu): cut off, wrongly written, or nested deeper than %d",
                       (unsigned long)stop, (unsigned long)line, CJSON_NESTING_LIMIT);
        return 0;
    }
    for (; stop < length; stop++) {
        char c = text[stop];
        if (c != ' ' && c != '\n' && c != '\r' && c != '\t' && c != 0) {
            gltf_error_set(document->error, GLTF_BROKEN, "$: there is more after the end of the JSON, at byte %lu",
                           (unsigned long)stop);
            return 0;
        }
    }
    return 1;
}

/* Extensions that change nothing about how bodies move. */
static int is_harmless(const char *name) {
    static const char *const known[] = {"KHR_implicit_shapes", "KHR_physics_rigid_bodies", "KHR_mesh_quantization",
                                        "KHR_lights_punctual", "KHR_animation_pointer",    "KHR_xmp_json_ld"};
    static const char *const beginnings[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_", "EXT_lights_"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(name, known[i]) == 0) {
            return 1;
        }
    }
    for (size_t i = 0; i < sizeof beginnings / sizeof *beginnings; i++) {
        if (strncmp(name, beginnings[i], strlen(beginnings[i])) == 0) {
            return 1;
        }
    }
    return 0;
}

static void check_asset(gltf_document *document) {
    gltf_at asset = gltf_member(&document->root, "asset");
    gltf_at at = gltf_member(&asset, "version");
    const char *version = gltf_string(&asset, "version");
    if (version == NULL) {
        gltf_fail(&at, GLTF_BROKEN, "is missing, must be \"2.0\"");
    } else if (strncmp(version, "2.", 2) != 0) {
        gltf_fail(&at, GLTF_UNSUPPORTED, "is \"%.20s\", must be \"2.0\"", version);
    }
    gltf_list required = gltf_list_open(&document->root, "extensionsRequired");
    for (int i = 0; i < required.count && !gltf_failed(&document->root); i++) {
        gltf_at item = gltf_list_item(&required, i);
        if (!cJSON_IsString(item.json)) {
            gltf_fail(&item, GLTF_BROKEN, "must be a text");
        } else if (!is_harmless(item.json->valuestring)) {
            gltf_fail(&item, GLTF_UNSUPPORTED, "the extension \"%.60s\" is required, and not known here",
                      item.json->valuestring);
        }
    }
    gltf_list_close(&required);
}

static void open_lists(gltf_document *document) {
    document->extensions = gltf_member(&document->root, "extensions");
    document->rigid = gltf_member(&document->extensions, "KHR_physics_rigid_bodies");
    document->implicit = gltf_member(&document->extensions, "KHR_implicit_shapes");
    document->nodes = gltf_list_open(&document->root, "nodes");
    document->meshes = gltf_list_open(&document->root, "meshes");
    document->accessors = gltf_list_open(&document->root, "accessors");
    document->views = gltf_list_open(&document->root, "bufferViews");
    document->buffers = gltf_list_open(&document->root, "buffers");
    document->shapes = gltf_list_open(&document->implicit, "shapes");
    document->materials = gltf_list_open(&document->rigid, "physicsMaterials");
    document->filters = gltf_list_open(&document->rigid, "collisionFilters");
    document->joints = gltf_list_open(&document->rigid, "physicsJoints");
    if (document->buffers.count > 0) {
        document->bytes = calloc((size_t)document->buffers.count, sizeof *document->bytes);
        if (document->bytes == NULL) {
            gltf_fail(&document->root, GLTF_FAILED, "there is no memory for its buffers");
        }
    }
}

int gltf_document_open(gltf_document *document, const void *bytes, size_t size, const char *folder, gltf_error *error) {
    memset(document, 0, sizeof *document);
    document->error = error;
    document->folder = folder;
    const char *text = NULL;
    size_t length = 0;
    if (size >= 4 && memcmp(bytes, "glTF", 4) == 0) {
        if (!split_glb(document, bytes, size, &text, &length)) {
            return 0;
        }
    } else {
        text = bytes;
        length = size;
    }
    if (!parse(document, text, length)) {
        return 0;
    }
    document->root.json = document->json;
    document->root.error = error;
    if (!cJSON_IsObject(document->json)) {
        gltf_fail(&document->root, GLTF_BROKEN, "must be an object");
        return 0;
    }
    check_asset(document);
    open_lists(document);
    return error->status == GLTF_OK;
}

void gltf_document_close(gltf_document *document) {
    for (int i = 0; document->bytes != NULL && i < document->buffers.count; i++) {
        free(document->bytes[i].owned);
    }
    free(document->bytes);
    gltf_list_close(&document->nodes);
    gltf_list_close(&document->meshes);
    gltf_list_close(&document->accessors);
    gltf_list_close(&document->views);
    gltf_list_close(&document->buffers);
    gltf_list_close(&document->shapes);
    gltf_list_close(&document->materials);
    gltf_list_close(&document->filters);
    gltf_list_close(&document->joints);
    cJSON_Delete(document->json);
    memset(document, 0, sizeof *document);
}
