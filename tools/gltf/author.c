#include "gltf/author.h"

#include "gltf/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHAPES, MATERIALS, JOINTS };

/* Numbers are written to the millionth: what differs between mathematical libraries is rounded away. */
static void add_number(gltf_text *text, double value) {
    char out[40];
    snprintf(out, sizeof out, "%.6f", value);
    char *end = out + strlen(out) - 1;
    while (*end == '0') {
        *end-- = 0;
    }
    if (*end == '.') {
        *end = 0;
    }
    gltf_text_add(text, "%s", strcmp(out, "-0") == 0 ? "0" : out);
}

static void add_vector(gltf_text *text, const char *before, const char *key, const double *values, int count) {
    gltf_text_add(text, "%s\"%s\":[", before, key);
    for (int i = 0; i < count; i++) {
        gltf_text_add(text, "%s", i == 0 ? "" : ",");
        add_number(text, values[i]);
    }
    gltf_text_add(text, "]");
}

author_pose author_turned(double x, double y, double z, gltf_double4 rotation) {
    author_pose pose = {{x, y, z}, rotation};
    return pose;
}

author_pose author_at(double x, double y, double z) {
    gltf_double4 identity = {0, 0, 0, 1};
    return author_turned(x, y, z, identity);
}

gltf_double4 author_rotation(double x, double y, double z, double angle) {
    double s = sin(angle / 2) / sqrt(x * x + y * y + z * z);
    gltf_double4 q = {x * s, y * s, z * s, cos(angle / 2)};
    return q;
}

static int make_room(author *a, void *array, uint32_t *room, uint32_t count, size_t size) {
    gltf_error error;
    memset(&error, 0, sizeof error);
    if (a->failed || !gltf_grow(&error, array, room, count, size)) {
        a->failed = 1;
    }
    return !a->failed;
}

void author_open(author *a, const char *name, uint32_t steps) {
    memset(a, 0, sizeof *a);
    snprintf(a->name, sizeof a->name, "%s", name);
    gltf_text_add(&a->extras, "\"steps\":%lu", (unsigned long)steps);
}

/* The number of an entry, added unless an equal one is there; takes the text over. */
static int enter(author *a, int kind, gltf_text *text) {
    a->failed |= text->failed;
    for (uint32_t i = 0; !a->failed && i < a->seen_count[kind]; i++) {
        if (strcmp(a->seen[kind][i].data, text->data) == 0) {
            gltf_text_free(text);
            return (int)i;
        }
    }
    if (!make_room(a, &a->seen[kind], &a->seen_room[kind], a->seen_count[kind], sizeof **a->seen)) {
        gltf_text_free(text);
        return 0;
    }
    a->seen[kind][a->seen_count[kind]] = *text;
    return (int)a->seen_count[kind]++;
}

static author_part shape_part(author *a, gltf_text *text) {
    author_part part = {enter(a, SHAPES, text), -1};
    return part;
}

author_part author_box(author *a, double x, double y, double z) {
    gltf_text text = {NULL, 0, 0, 0};
    double size[3] = {x, y, z};
    gltf_text_add(&text, "{\"type\":\"box\",\"box\":{");
    add_vector(&text, "", "size", size, 3);
    gltf_text_add(&text, "}}");
    return shape_part(a, &text);
}

author_part author_sphere(author *a, double radius) {
    gltf_text text = {NULL, 0, 0, 0};
    gltf_text_add(&text, "{\"type\":\"sphere\",\"sphere\":{\"radius\":");
    add_number(&text, radius);
    gltf_text_add(&text, "}}");
    return shape_part(a, &text);
}

static author_part round_part(author *a, const char *type, double height, double top, double bottom) {
    gltf_text text = {NULL, 0, 0, 0};
    gltf_text_add(&text, "{\"type\":\"%s\",\"%s\":{\"height\":", type, type);
    add_number(&text, height);
    gltf_text_add(&text, ",\"radiusTop\":");
    add_number(&text, top);
    gltf_text_add(&text, ",\"radiusBottom\":");
    add_number(&text, bottom);
    gltf_text_add(&text, "}}");
    return shape_part(a, &text);
}

author_part author_capsule(author *a, double height, double top, double bottom) {
    return round_part(a, "capsule", height, top, bottom);
}

author_part author_cylinder(author *a, double height, double top, double bottom) {
    return round_part(a, "cylinder", height, top, bottom);
}

author_part author_hull(author *a, const gltf_double3 *points, uint32_t count) {
    author_part part = {-1, (int)a->mesh_count};
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    size_t start = a->bytes.size;
    for (uint32_t i = 0; i < count; i++) {
        double p[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) {
            float value = (float)(floor(p[k] * 1e6 + 0.5) / 1e6);
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            unsigned char out[4] = {(unsigned char)bits, (unsigned char)(bits >> 8), (unsigned char)(bits >> 16),
                                    (unsigned char)(bits >> 24)};
            gltf_text_bytes(&a->bytes, out, 4);
            low[k] = i == 0 || (double)value < low[k] ? (double)value : low[k];
            high[k] = i == 0 || (double)value > high[k] ? (double)value : high[k];
        }
    }
    const char *comma = a->mesh_count == 0 ? "" : ",";
    unsigned long number = a->mesh_count;
    gltf_text_add(&a->views, "%s{\"buffer\":0,\"byteOffset\":%lu,\"byteLength\":%lu,\"target\":34962}", comma,
                  (unsigned long)start, (unsigned long)(a->bytes.size - start));
    gltf_text_add(&a->accessors,
                  "%s{\"bufferView\":%lu,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%lu,"
                  "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]}",
                  comma, number, (unsigned long)count, low[0], low[1], low[2], high[0], high[1], high[2]);
    gltf_text_add(&a->meshes, "%s{\"primitives\":[{\"mode\":0,\"attributes\":{\"POSITION\":%lu}}]}", comma, number);
    a->mesh_count++;
    return part;
}

int author_material(author *a, double friction, double restitution, const char *restitution_rule) {
    gltf_text text = {NULL, 0, 0, 0};
    gltf_text_add(&text, "{\"staticFriction\":");
    add_number(&text, friction);
    gltf_text_add(&text, ",\"dynamicFriction\":");
    add_number(&text, friction);
    gltf_text_add(&text, ",\"restitution\":");
    add_number(&text, restitution);
    if (restitution_rule != NULL) {
        gltf_text_add(&text, ",\"restitutionCombine\":\"%s\"", restitution_rule);
    }
    gltf_text_add(&text, "}");
    return enter(a, MATERIALS, &text);
}

static int add_node(author *a, int parent, author_pose pose) {
    if (!make_room(a, &a->nodes, &a->node_room, a->node_count, sizeof *a->nodes)) {
        return -1;
    }
    author_node node;
    memset(&node, 0, sizeof node);
    double position[3] = {pose.position.x, pose.position.y, pose.position.z};
    double rotation[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
    add_vector(&node.members, "", "translation", position, 3);
    if (rotation[0] != 0 || rotation[1] != 0 || rotation[2] != 0) {
        add_vector(&node.members, ",", "rotation", rotation, 4);
    }
    node.is_root = parent < 0;
    a->nodes[a->node_count] = node;
    if (parent >= 0) {
        gltf_text *children = &a->nodes[parent].children;
        gltf_text_add(children, "%s%lu", children->size == 0 ? "" : ",", (unsigned long)a->node_count);
    }
    return (int)a->node_count++;
}

static void add_collider(author *a, int node, author_part part, int material, const char *kind) {
    if (node < 0) {
        return;
    }
    gltf_text *text = &a->nodes[node].physics;
    gltf_text_add(text, "%s\"%s\":{\"geometry\":{", text->size == 0 ? "" : ",", kind);
    if (part.shape >= 0) {
        gltf_text_add(text, "\"shape\":%d}", part.shape);
    } else {
        gltf_text_add(text, "\"node\":%d,\"convexHull\":true}", node);
        gltf_text_add(&a->nodes[node].members, ",\"mesh\":%d", part.mesh);
    }
    if (material >= 0) {
        gltf_text_add(text, ",\"physicsMaterial\":%d", material);
    }
    gltf_text_add(text, "}");
}

void author_static(author *a, author_part part, author_pose pose, int material) {
    add_collider(a, add_node(a, -1, pose), part, material, "collider");
}

void author_trigger(author *a, author_part part, author_pose pose) {
    add_collider(a, add_node(a, -1, pose), part, -1, "trigger");
}

int author_add_compound(author *a, author_pose pose, const char *motion) {
    int node = add_node(a, -1, pose);
    if (node < 0 || !make_room(a, &a->bodies, &a->body_room, a->body_count, sizeof *a->bodies)) {
        return 0;
    }
    gltf_text_add(&a->nodes[node].physics, "\"motion\":{%s}", motion != NULL ? motion : "");
    author_body body = {node, pose};
    a->bodies[a->body_count] = body;
    return (int)a->body_count++;
}

int author_add_body(author *a, author_part part, author_pose pose, int material, const char *motion) {
    int body = author_add_compound(a, pose, motion);
    if (!a->failed) {
        add_collider(a, a->bodies[body].node, part, material, "collider");
    }
    return body;
}

void author_add_part(author *a, int body, author_part part, author_pose pose, int material) {
    if (!a->failed) {
        add_collider(a, add_node(a, a->bodies[body].node, pose), part, material, "collider");
    }
}

/* A node for one end of a joint. */
static int add_pivot(author *a, int body, author_pose frame) {
    if (body == AUTHOR_WORLD) {
        return add_node(a, -1, frame);
    }
    const author_body *b = &a->bodies[body];
    gltf_double4 back = gltf_conjugate(b->pose.rotation);
    author_pose own = {gltf_rotate(back, gltf_sub3(frame.position, b->pose.position)), gltf_mul4(back, frame.rotation)};
    return add_node(a, b->node, own);
}

void author_joint(author *a, int body_a, int body_b, author_pose frame, const char *limits) {
    if (a->failed) {
        return;
    }
    gltf_text text = {NULL, 0, 0, 0};
    gltf_text_add(&text, "{%s}", limits);
    int kind = enter(a, JOINTS, &text), from = add_pivot(a, body_a, frame), to = add_pivot(a, body_b, frame);
    if (from >= 0 && to >= 0) {
        gltf_text_add(&a->nodes[from].physics, "\"joint\":{\"connectedNode\":%d,\"joint\":%d}", to, kind);
    }
}

/* --- writing --- */

static void add_seen(const author *a, gltf_text *out, int kind, const char *key, const char *before) {
    if (a->seen_count[kind] == 0) {
        return;
    }
    gltf_text_add(out, "%s\"%s\":[", before, key);
    for (uint32_t i = 0; i < a->seen_count[kind]; i++) {
        gltf_text_add(out, "%s", i == 0 ? "" : ",");
        gltf_text_bytes(out, a->seen[kind][i].data, a->seen[kind][i].size);
    }
    gltf_text_add(out, "]");
}

static void add_part(gltf_text *out, const char *before, const gltf_text *part, const char *after) {
    out->failed |= part->failed;
    if (part->size > 0) {
        gltf_text_add(out, "%s", before);
        gltf_text_bytes(out, part->data, part->size);
        gltf_text_add(out, "%s", after);
    }
}

static void add_nodes(const author *a, gltf_text *out) {
    gltf_text_add(out, ",\n\"nodes\":[");
    for (uint32_t i = 0; i < a->node_count; i++) {
        const author_node *node = &a->nodes[i];
        gltf_text_add(out, "%s\n{", i == 0 ? "" : ",");
        add_part(out, "", &node->members, "");
        add_part(out, ",\"children\":[", &node->children, "]");
        add_part(out, ",\"extensions\":{\"KHR_physics_rigid_bodies\":{", &node->physics, "}}");
        gltf_text_add(out, "}");
    }
    gltf_text_add(out, "]");
}

static void add_document(const author *a, gltf_text *out) {
    gltf_text_add(out, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"talus\"},\n\"extensionsUsed\":"
                       "[\"KHR_implicit_shapes\",\"KHR_physics_rigid_bodies\"],\n\"extensions\":{"
                       "\"KHR_implicit_shapes\":{");
    add_seen(a, out, SHAPES, "shapes", "");
    gltf_text_add(out, "},\"KHR_physics_rigid_bodies\":{");
    add_seen(a, out, MATERIALS, "physicsMaterials", "");
    add_seen(a, out, JOINTS, "physicsJoints", a->seen_count[MATERIALS] > 0 ? ",\n" : "");
    gltf_text_add(out, "}},\n\"scene\":0,\"scenes\":[{\"name\":");
    gltf_text_quoted(out, a->name);
    gltf_text_add(out, ",\"extras\":{");
    add_part(out, "", &a->extras, "");
    gltf_text_add(out, "},\"nodes\":[");
    const char *comma = "";
    for (uint32_t i = 0; i < a->node_count; i++) {
        if (a->nodes[i].is_root) {
            gltf_text_add(out, "%s%lu", comma, (unsigned long)i);
            comma = ",";
        }
    }
    gltf_text_add(out, "]}]");
    add_nodes(a, out);
    if (a->mesh_count > 0) {
        add_part(out, ",\n\"meshes\":[", &a->meshes, "]");
        add_part(out, ",\n\"accessors\":[", &a->accessors, "]");
        add_part(out, ",\n\"bufferViews\":[", &a->views, "]");
        gltf_text_add(out, ",\n\"buffers\":[{\"byteLength\":%lu,\"uri\":\"data:application/octet-stream;base64,",
                      (unsigned long)a->bytes.size);
        gltf_text_base64(out, a->bytes.data, a->bytes.size);
        gltf_text_add(out, "\"}]");
    }
    gltf_text_add(out, "}\n");
}

char *author_finish(author *a, size_t *size) {
    gltf_text out = {NULL, 0, 0, 0};
    if (!a->failed && !a->bytes.failed) {
        add_document(a, &out);
    }
    int failed = a->failed || a->bytes.failed || out.failed;
    for (uint32_t i = 0; i < a->node_count; i++) {
        gltf_text_free(&a->nodes[i].members);
        gltf_text_free(&a->nodes[i].physics);
        gltf_text_free(&a->nodes[i].children);
    }
    for (int kind = 0; kind < 3; kind++) {
        for (uint32_t i = 0; i < a->seen_count[kind]; i++) {
            gltf_text_free(&a->seen[kind][i]);
        }
        free(a->seen[kind]);
    }
    free(a->nodes);
    free(a->bodies);
    gltf_text_free(&a->extras);
    gltf_text_free(&a->meshes);
    gltf_text_free(&a->accessors);
    gltf_text_free(&a->views);
    gltf_text_free(&a->bytes);
    memset(a, 0, sizeof *a);
    if (failed) {
        gltf_text_free(&out);
        return NULL;
    }
    *size = out.size;
    return out.data;
}
