#include "gltf/animate.h"

#include "gltf/loader.h"
#include "gltf/mesh.h"

#include <stdlib.h>
#include <string.h>

void gltf_animation_open(gltf_animation *animation, const gltf_scene *scene) {
    memset(animation, 0, sizeof *animation);
    animation->scene = scene;
}

void gltf_animation_free(gltf_animation *animation) {
    free(animation->times);
    free(animation->poses);
    memset(animation, 0, sizeof *animation);
}

void gltf_animation_frame(gltf_animation *animation, double time, const talus_pose *poses) {
    uint32_t bodies = animation->scene->body_count;
    gltf_error error;
    memset(&error, 0, sizeof error);
    uint64_t at = (uint64_t)animation->frame_count * bodies;
    animation->failed |= at + bodies > UINT32_MAX / 2;
    if (animation->failed || !gltf_grow(&error, &animation->times, &animation->time_room, animation->frame_count,
                                        sizeof *animation->times)) {
        animation->failed = 1;
        return;
    }
    for (uint32_t i = 0; i < bodies; i++) {
        if (!gltf_grow(&error, &animation->poses, &animation->pose_room, (uint32_t)at + i, sizeof *animation->poses)) {
            animation->failed = 1;
            return;
        }
        talus_pose pose = poses[i];
        if (animation->frame_count >
            0) { /* the near one of a rotation's two quaternions, for viewers that do not look */
            const talus_quat last = animation->poses[at + i - bodies].rotation, q = pose.rotation;
            if (last.x * q.x + last.y * q.y + last.z * q.z + last.w * q.w < 0) {
                talus_quat near = {-q.x, -q.y, -q.z, -q.w};
                pose.rotation = near;
            }
        }
        animation->poses[at + i] = pose;
    }
    animation->times[animation->frame_count++] = (float)time;
}

/* --- writing --- */

/* What a GLB is made of while it is written. */
typedef struct writer {
    const gltf_animation *animation;
    const gltf_scene *scene;
    const gltf_world *world;
    gltf_text nodes, roots, meshes, accessors, views, samplers, channels, bytes;
    uint32_t node_count, root_count, mesh_count, accessor_count, view_count, sampler_count;
    uint32_t *geometry_accessor; /* of each geometry: the first of its three; GLTF_NONE before it is written */
    gltf_table mesh_table;       /* (geometry, colour) to mesh */
} writer;

enum { COLORS = 12, STATIC_COLOR = COLORS, SENSOR_COLOR, ALL_COLORS };

static const float palette[COLORS][3] = {{0.80f, 0.18f, 0.14f}, {0.13f, 0.42f, 0.75f}, {0.90f, 0.62f, 0.10f},
                                         {0.20f, 0.58f, 0.26f}, {0.55f, 0.25f, 0.63f}, {0.10f, 0.60f, 0.62f},
                                         {0.90f, 0.40f, 0.50f}, {0.45f, 0.32f, 0.20f}, {0.62f, 0.74f, 0.20f},
                                         {0.30f, 0.32f, 0.60f}, {0.95f, 0.80f, 0.35f}, {0.60f, 0.62f, 0.65f}};

static void put_float(gltf_text *bytes, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    unsigned char out[4] = {(unsigned char)bits, (unsigned char)(bits >> 8), (unsigned char)(bits >> 16),
                            (unsigned char)(bits >> 24)};
    gltf_text_bytes(bytes, out, 4);
}

static const char *comma(uint32_t count) { return count == 0 ? "" : ","; }

/* Closes the bytes since `start` as a buffer view; target 0: none. */
static uint32_t add_view(writer *w, size_t start, int target) {
    gltf_text_add(&w->views, "%s{\"buffer\":0,\"byteOffset\":%lu,\"byteLength\":%lu", comma(w->view_count),
                  (unsigned long)start, (unsigned long)(w->bytes.size - start));
    if (target != 0) {
        gltf_text_add(&w->views, ",\"target\":%d", target);
    }
    gltf_text_add(&w->views, "}");
    return w->view_count++;
}

static uint32_t add_accessor(writer *w, uint32_t view, int component, const char *type, uint32_t count) {
    gltf_text_add(&w->accessors, "%s{\"bufferView\":%lu,\"componentType\":%d,\"type\":\"%s\",\"count\":%lu",
                  comma(w->accessor_count), (unsigned long)view, component, type, (unsigned long)count);
    return w->accessor_count++; /* left open for bounds */
}

static uint32_t add_points(writer *w, const talus_vec3 *points, uint32_t count, int bounds) {
    size_t start = w->bytes.size;
    talus_vec3 low = points[0], high = points[0];
    for (uint32_t i = 0; i < count; i++) {
        const talus_vec3 p = points[i];
        put_float(&w->bytes, p.x);
        put_float(&w->bytes, p.y);
        put_float(&w->bytes, p.z);
        low.x = p.x < low.x ? p.x : low.x;
        low.y = p.y < low.y ? p.y : low.y;
        low.z = p.z < low.z ? p.z : low.z;
        high.x = p.x > high.x ? p.x : high.x;
        high.y = p.y > high.y ? p.y : high.y;
        high.z = p.z > high.z ? p.z : high.z;
    }
    uint32_t accessor = add_accessor(w, add_view(w, start, 34962), 5126, "VEC3", count);
    if (bounds) {
        gltf_text_add(&w->accessors, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)low.x, (double)low.y,
                      (double)low.z, (double)high.x, (double)high.y, (double)high.z);
    }
    gltf_text_add(&w->accessors, "}");
    return accessor;
}

/* The three accessors of a geometry's mesh; returns the first. */
static uint32_t add_geometry(writer *w, uint32_t index) {
    const gltf_geometry *geometry = &w->scene->geometries[index];
    const talus_hull *hull = NULL;
    if (geometry->hull != GLTF_NONE) {
        const unsigned char *region = w->world->world.geometry;
        hull = (const talus_hull *)(const void *)(region + w->world->hull_offsets[geometry->hull]);
    }
    gltf_mesh mesh;
    gltf_mesh_make(&mesh, &geometry->geometry, hull);
    uint32_t first = w->accessor_count;
    if (mesh.failed || mesh.vertex_count == 0) {
        w->bytes.failed = 1;
    } else {
        add_points(w, mesh.positions, mesh.vertex_count, 1);
        add_points(w, mesh.normals, mesh.vertex_count, 0);
        size_t start = w->bytes.size;
        for (uint32_t i = 0; i < mesh.index_count; i++) {
            uint32_t v = mesh.indices[i];
            unsigned char out[4] = {(unsigned char)v, (unsigned char)(v >> 8), (unsigned char)(v >> 16),
                                    (unsigned char)(v >> 24)};
            gltf_text_bytes(&w->bytes, out, 4);
        }
        add_accessor(w, add_view(w, start, 34963), 5125, "SCALAR", mesh.index_count);
        gltf_text_add(&w->accessors, "}");
    }
    gltf_mesh_free(&mesh);
    return first;
}

static uint32_t find_mesh(writer *w, uint32_t geometry, uint32_t color) {
    gltf_key key;
    memset(&key, 0, sizeof key);
    key.word[0] = geometry;
    key.word[1] = color;
    uint32_t *known = gltf_table_find(&w->mesh_table, &key, GLTF_NONE);
    if (known == NULL) {
        w->bytes.failed = 1;
        return 0;
    }
    if (*known == GLTF_NONE) {
        if (w->geometry_accessor[geometry] == GLTF_NONE) {
            w->geometry_accessor[geometry] = add_geometry(w, geometry);
        }
        unsigned long first = w->geometry_accessor[geometry];
        gltf_text_add(&w->meshes,
                      "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%lu,\"NORMAL\":%lu},\"indices\":%lu,"
                      "\"material\":%lu}]}",
                      comma(w->mesh_count), first, first + 1, first + 2, (unsigned long)color);
        *known = w->mesh_count++;
    }
    return *known;
}

static void add_pose(gltf_text *text, const talus_pose *pose) {
    const talus_vec3 p = pose->position;
    const talus_quat q = pose->rotation;
    gltf_text_add(text, "\"translation\":[%.9g,%.9g,%.9g],\"rotation\":[%.9g,%.9g,%.9g,%.9g]", (double)p.x, (double)p.y,
                  (double)p.z, (double)q.x, (double)q.y, (double)q.z, (double)q.w);
}

/* Body nodes come first, so that node i is body i; then one for each collider. */
static void add_nodes(writer *w) {
    const gltf_scene *scene = w->scene;
    gltf_text *children = calloc((size_t)scene->body_count + 1, sizeof *children);
    if (children == NULL) {
        w->bytes.failed = 1;
        return;
    }
    gltf_text shapes = {NULL, 0, 0, 0};
    uint32_t node = scene->body_count;
    for (uint32_t i = 0; i < scene->collider_count; i++, node++) {
        const gltf_collider *collider = &scene->colliders[i];
        uint32_t color = collider->sensor              ? (uint32_t)SENSOR_COLOR
                         : collider->body == GLTF_NONE ? (uint32_t)STATIC_COLOR
                                                       : collider->body % COLORS;
        gltf_text_add(&shapes, ",{\"mesh\":%lu,", (unsigned long)find_mesh(w, collider->geometry, color));
        add_pose(&shapes, &collider->pose);
        gltf_text_add(&shapes, "}");
        gltf_text *list = collider->body == GLTF_NONE ? &w->roots : &children[collider->body];
        gltf_text_add(list, "%s%lu", list->size == 0 ? "" : ",", (unsigned long)node);
    }
    for (uint32_t i = 0; i < scene->body_count; i++) {
        gltf_text_add(&w->nodes, "%s{", comma(i));
        if (scene->bodies[i].name != NULL) {
            gltf_text_add(&w->nodes, "\"name\":");
            gltf_text_quoted(&w->nodes, scene->bodies[i].name);
            gltf_text_add(&w->nodes, ",");
        }
        add_pose(&w->nodes, w->animation->frame_count > 0 ? &w->animation->poses[i] : &scene->bodies[i].pose);
        if (children[i].size > 0) {
            gltf_text_add(&w->nodes, ",\"children\":[");
            gltf_text_bytes(&w->nodes, children[i].data, children[i].size);
            gltf_text_add(&w->nodes, "]");
        }
        gltf_text_add(&w->nodes, "}");
        gltf_text_add(&w->roots, "%s%lu", w->roots.size == 0 ? "" : ",", (unsigned long)i);
        w->bytes.failed |= children[i].failed;
        gltf_text_free(&children[i]);
    }
    w->bytes.failed |= shapes.failed;
    if (shapes.size > 0) {
        size_t skip = scene->body_count == 0; /* the first comma */
        gltf_text_bytes(&w->nodes, shapes.data + skip, shapes.size - skip);
    }
    w->node_count = node;
    gltf_text_free(&shapes);
    free(children);
}

/* A camera that has all bodies, as they stand at first, in view from the side and above. */
static void add_camera(writer *w) {
    const gltf_scene *scene = w->scene;
    gltf_double3 low = {0, 0, 0}, high = {0, 0, 0};
    for (uint32_t i = 0; i < scene->body_count; i++) {
        const talus_vec3 p = scene->bodies[i].pose.position;
        gltf_double3 q = gltf_d3(p.x, p.y, p.z);
        low = i == 0 ? q : gltf_d3(fmin(low.x, q.x), fmin(low.y, q.y), fmin(low.z, q.z));
        high = i == 0 ? q : gltf_d3(fmax(high.x, q.x), fmax(high.y, q.y), fmax(high.z, q.z));
    }
    gltf_double3 middle = gltf_scale3(gltf_add3(low, high), 0.5), back = gltf_d3(0.45, 0.35, 0.82);
    back = gltf_scale3(back, 1 / gltf_length3(back));
    double distance = 3 + 1.4 * gltf_length3(gltf_sub3(high, low));
    gltf_double3 right = gltf_cross3(gltf_d3(0, 1, 0), back);
    right = gltf_scale3(right, 1 / gltf_length3(right));
    gltf_double9 columns = {right, gltf_cross3(back, right), back};
    talus_pose pose = {gltf_vec3(gltf_add3(middle, gltf_scale3(back, distance))),
                       gltf_quat(gltf_from_columns(&columns))};
    gltf_text_add(&w->nodes, "%s{\"name\":\"camera\",\"camera\":0,", comma(w->node_count));
    add_pose(&w->nodes, &pose);
    gltf_text_add(&w->nodes, "}");
    gltf_text_add(&w->roots, "%s%lu", w->roots.size == 0 ? "" : ",", (unsigned long)w->node_count++);
}

static int moves(const gltf_animation *animation, uint32_t body) {
    uint32_t bodies = animation->scene->body_count;
    for (uint32_t k = 1; k < animation->frame_count; k++) {
        if (memcmp(&animation->poses[body], &animation->poses[(size_t)k * bodies + body], sizeof(talus_pose)) != 0) {
            return 1;
        }
    }
    return 0;
}

static void add_channel(writer *w, uint32_t body, uint32_t times, int rotation) {
    const gltf_animation *animation = w->animation;
    size_t start = w->bytes.size;
    for (uint32_t k = 0; k < animation->frame_count; k++) {
        const talus_pose *pose = &animation->poses[(size_t)k * w->scene->body_count + body];
        put_float(&w->bytes, rotation ? pose->rotation.x : pose->position.x);
        put_float(&w->bytes, rotation ? pose->rotation.y : pose->position.y);
        put_float(&w->bytes, rotation ? pose->rotation.z : pose->position.z);
        if (rotation) {
            put_float(&w->bytes, pose->rotation.w);
        }
    }
    uint32_t view = add_view(w, start, 0);
    uint32_t accessor = add_accessor(w, view, 5126, rotation ? "VEC4" : "VEC3", animation->frame_count);
    gltf_text_add(&w->accessors, "}");
    gltf_text_add(&w->samplers, "%s{\"input\":%lu,\"output\":%lu,\"interpolation\":\"LINEAR\"}",
                  comma(w->sampler_count), (unsigned long)times, (unsigned long)accessor);
    gltf_text_add(&w->channels, "%s{\"sampler\":%lu,\"target\":{\"node\":%lu,\"path\":\"%s\"}}",
                  comma(w->sampler_count), (unsigned long)w->sampler_count, (unsigned long)body,
                  rotation ? "rotation" : "translation");
    w->sampler_count++;
}

static void add_animation(writer *w) {
    const gltf_animation *animation = w->animation;
    uint32_t times = GLTF_NONE;
    for (uint32_t i = 0; i < w->scene->body_count; i++) {
        if (!moves(animation, i)) {
            continue;
        }
        if (times == GLTF_NONE) {
            size_t start = w->bytes.size;
            for (uint32_t k = 0; k < animation->frame_count; k++) {
                put_float(&w->bytes, animation->times[k]);
            }
            times = add_accessor(w, add_view(w, start, 0), 5126, "SCALAR", animation->frame_count);
            gltf_text_add(&w->accessors, ",\"min\":[%.9g],\"max\":[%.9g]}", (double)animation->times[0],
                          (double)animation->times[animation->frame_count - 1]);
        }
        add_channel(w, i, times, 0);
        add_channel(w, i, times, 1);
    }
}

static void add_materials(gltf_text *out) {
    for (int i = 0; i < COLORS; i++) {
        gltf_text_add(out,
                      "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.3f,%.3f,%.3f,1],\"metallicFactor\":0,"
                      "\"roughnessFactor\":0.6}},",
                      (double)palette[i][0], (double)palette[i][1], (double)palette[i][2]);
    }
    gltf_text_add(out, "{\"name\":\"static\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.35,0.36,0.38,1],"
                       "\"metallicFactor\":0,\"roughnessFactor\":0.9}},"
                       "{\"name\":\"trigger\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.8,0.9,0.25],"
                       "\"metallicFactor\":0},\"alphaMode\":\"BLEND\",\"doubleSided\":true}");
}

static void add_list(gltf_text *out, const char *key, const gltf_text *items) {
    if (items->size > 0) { /* glTF has no empty arrays */
        gltf_text_add(out, ",\"%s\":[", key);
        gltf_text_bytes(out, items->data, items->size);
        gltf_text_add(out, "]");
    }
    out->failed |= items->failed;
}

static void add_json(const writer *w, gltf_text *out) {
    gltf_text_add(out, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"talus %s\"},\"scene\":0,\"scenes\":[{\"name\":",
                  TALUS_VERSION);
    gltf_text_quoted(out, w->scene->name != NULL ? w->scene->name : "scene");
    add_list(out, "nodes", &w->roots);
    gltf_text_add(out, "}]");
    add_list(out, "nodes", &w->nodes);
    add_list(out, "meshes", &w->meshes);
    gltf_text_add(out, ",\"materials\":[");
    add_materials(out);
    gltf_text_add(out, "],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.05,"
                       "\"zfar\":10000}}]");
    add_list(out, "accessors", &w->accessors);
    add_list(out, "bufferViews", &w->views);
    if (w->sampler_count > 0) {
        gltf_text_add(out, ",\"animations\":[{\"name\":\"run\"");
        add_list(out, "samplers", &w->samplers);
        add_list(out, "channels", &w->channels);
        gltf_text_add(out, "}]");
    }
    if (w->bytes.size > 0) {
        gltf_text_add(out, ",\"buffers\":[{\"byteLength\":%lu}]", (unsigned long)w->bytes.size);
    }
    gltf_text_add(out, "}");
}

static void put_u32(gltf_text *out, size_t value) {
    unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8), (unsigned char)(value >> 16),
                              (unsigned char)(value >> 24)};
    gltf_text_bytes(out, bytes, 4);
}

/* Header and chunks (glTF 2.0, section 4.4); a chunk's length is a multiple of 4. */
static void pack(const gltf_text *json, const gltf_text *bytes, gltf_text *out) {
    static const char spaces[] = "   ", zeros[4] = {0, 0, 0, 0};
    size_t json_pad = (4 - json->size % 4) % 4, byte_pad = (4 - bytes->size % 4) % 4;
    size_t json_size = json->size + json_pad, byte_size = bytes->size + byte_pad;
    gltf_text_bytes(out, "glTF", 4);
    put_u32(out, 2);
    put_u32(out, 12 + 8 + json_size + (byte_size > 0 ? 8 + byte_size : 0));
    put_u32(out, json_size);
    gltf_text_bytes(out, "JSON", 4);
    gltf_text_bytes(out, json->data, json->size);
    gltf_text_bytes(out, spaces, json_pad);
    if (byte_size > 0) {
        put_u32(out, byte_size);
        gltf_text_bytes(out, "BIN\0", 4);
        gltf_text_bytes(out, bytes->data, bytes->size);
        gltf_text_bytes(out, zeros, byte_pad);
    }
}

gltf_status gltf_animation_encode(const gltf_animation *animation, const gltf_world *world, gltf_text *out,
                                  gltf_error *error) {
    writer w;
    gltf_text json = {NULL, 0, 0, 0};
    memset(&w, 0, sizeof w);
    memset(error, 0, sizeof *error);
    w.animation = animation;
    w.scene = animation->scene;
    w.world = world;
    w.geometry_accessor = malloc(((size_t)w.scene->geometry_count + 1) * sizeof *w.geometry_accessor);
    if (animation->failed || w.geometry_accessor == NULL) {
        gltf_error_set(error, GLTF_FAILED, "there is no memory for the animation");
    } else {
        memset(w.geometry_accessor, 0xff, w.scene->geometry_count * sizeof *w.geometry_accessor);
        add_nodes(&w);
        add_camera(&w);
        add_animation(&w);
        add_json(&w, &json);
        if (w.bytes.size > UINT32_MAX - 64 || json.size > UINT32_MAX - 64 - w.bytes.size) {
            gltf_error_set(error, GLTF_UNSUPPORTED, "the animation has more than the 4 GiB of a GLB");
        } else {
            pack(&json, &w.bytes, out);
        }
        if (w.bytes.failed || json.failed || out->failed) {
            gltf_error_set(error, GLTF_FAILED, "there is no memory for the animation");
        }
    }
    gltf_text *texts[] = {&w.nodes,    &w.roots,    &w.meshes, &w.accessors, &w.views,
                          &w.samplers, &w.channels, &w.bytes,  &json};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        gltf_text_free(texts[i]);
    }
    free(w.geometry_accessor);
    gltf_table_free(&w.mesh_table);
    return error->status;
}
