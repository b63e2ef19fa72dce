/* Colliders' geometry: KHR_implicit_shapes, and where a scale of the node is taken in. */
#include "gltf/loader.h"

#include <stdlib.h>
#include <string.h>

/* How near to each other scales must be to count as one: files round them. */
#define SAME_SCALE 1e-4

/* What stands for an infinite plane (m): half its width, and half of what is solid below it. */
#define PLANE_HALF_WIDTH 1000.0
#define PLANE_HALF_DEPTH 5.0

static uint32_t share(gltf_loader *loader, const gltf_at *at, const gltf_geometry *geometry) {
    gltf_scene *scene = loader->scene;
    gltf_key key;
    memset(&key, 0, sizeof key);
    const talus_geometry *g = &geometry->geometry;
    float sizes[7] = {g->radius, g->half_height, g->radius_top, g->radius_bottom, g->half.x, g->half.y, g->half.z};
    key.word[0] = (uint32_t)g->type;
    key.word[1] = geometry->hull;
    memcpy(&key.word[2], sizes, sizeof sizes);
    uint32_t *known = gltf_table_find(&loader->geometry_table, &key, GLTF_NONE);
    if (known == NULL || (*known == GLTF_NONE && !gltf_grow(loader->error, &scene->geometries, &scene->geometry_room,
                                                            scene->geometry_count, sizeof *scene->geometries))) {
        gltf_fail(at, GLTF_FAILED, "there is no memory");
        return GLTF_NONE;
    }
    if (*known == GLTF_NONE) {
        *known = scene->geometry_count;
        scene->geometries[scene->geometry_count++] = *geometry;
    }
    return *known;
}

/* A size out of the file times a scale. */
static float sized(const gltf_at *at, const char *what, double size, double scale) {
    double value = size * fabs(scale);
    if (!(value >= (double)TALUS_MIN_SIZE && value <= (double)TALUS_MAX_SIZE)) {
        gltf_fail(at, GLTF_BROKEN, "its %s is %g m, must be from %g to %g m", what, value, (double)TALUS_MIN_SIZE,
                  (double)TALUS_MAX_SIZE);
        return 1.0f;
    }
    return (float)value;
}

static int same(double a, double b) { return fabs(fabs(a) - fabs(b)) <= SAME_SCALE * fmax(fabs(a), fabs(b)); }

static void need_same(const gltf_at *node, const char *kind, const char *which, gltf_double3 scale, int ok) {
    if (!ok) {
        gltf_fail(node, GLTF_UNSUPPORTED, "a %s is scaled by %g %g %g, which makes no %s: %s must be the same", kind,
                  scale.x, scale.y, scale.z, kind, which);
    }
}

static void read_box(const gltf_at *size, const gltf_at *node, gltf_double3 scale, talus_geometry *out) {
    double edge[3] = {1, 1, 1};
    gltf_numbers(size, "size", edge, 3, 1e9);
    out->type = TALUS_BOX;
    gltf_at at = gltf_member(size, "size");
    for (int i = 0; i < 3; i++) {
        if (edge[i] <= 0) {
            gltf_fail(&at, GLTF_BROKEN, "element %d is %g, must be greater than 0", i, edge[i]);
        }
    }
    out->half.x = sized(node, "box's half edge x", edge[0] / 2, scale.x);
    out->half.y = sized(node, "box's half edge y", edge[1] / 2, scale.y);
    out->half.z = sized(node, "box's half edge z", edge[2] / 2, scale.z);
}

static void read_sphere(const gltf_at *size, const gltf_at *node, gltf_double3 scale, talus_geometry *out) {
    double radius = gltf_number(size, "radius", 0.5, 1e-9, 1e9);
    need_same(node, "sphere", "its three scales", scale, same(scale.x, scale.y) && same(scale.y, scale.z));
    out->type = TALUS_SPHERE;
    out->radius = sized(node, "sphere's radius", radius, scale.x);
}

static void read_cylinder(const gltf_at *size, const gltf_at *node, gltf_double3 scale, talus_geometry *out) {
    double height = gltf_number(size, "height", 0.5, 1e-9, 1e9);
    double top = gltf_number(size, "radiusTop", 0.25, 0, 1e9), bottom = gltf_number(size, "radiusBottom", 0.25, 0, 1e9);
    need_same(node, "cylinder", "its x and z scales", scale, same(scale.x, scale.z));
    if (top == 0 && bottom == 0) {
        gltf_fail(size, GLTF_BROKEN, "both radii are 0, only one may be");
    }
    out->type = TALUS_CYLINDER;
    out->half_height = sized(node, "cylinder's half height", height / 2, scale.y);
    out->radius_top = top == 0 ? 0 : sized(node, "cylinder's radiusTop", top, scale.x);
    out->radius_bottom = bottom == 0 ? 0 : sized(node, "cylinder's radiusBottom", bottom, scale.x);
}

/* Moves a pose along its own y axis (m). */
static void shift_up(talus_pose *pose, double way) {
    gltf_double4 q = {pose->rotation.x, pose->rotation.y, pose->rotation.z, pose->rotation.w};
    gltf_double3 p = {pose->position.x, pose->position.y, pose->position.z};
    pose->position = gltf_vec3(gltf_add3(p, gltf_rotate(q, gltf_d3(0, way, 0))));
}

static void read_capsule(const gltf_at *size, const gltf_at *node, gltf_double3 scale, talus_geometry *out,
                         talus_pose *pose) {
    double height = gltf_number(size, "height", 0.5, 0, 1e9);
    double top = gltf_number(size, "radiusTop", 0.25, 0, 1e9), bottom = gltf_number(size, "radiusBottom", 0.25, 0, 1e9);
    need_same(node, "capsule", "its three scales", scale, same(scale.x, scale.y) && same(scale.y, scale.z));
    if (top == 0 && bottom == 0) {
        gltf_fail(size, GLTF_BROKEN, "both radii are 0, only one may be");
    }
    if (fabs(top - bottom) >= height) { /* the larger ball holds the smaller one */
        out->type = TALUS_SPHERE;
        out->radius = sized(node, "capsule's radius", fmax(top, bottom), scale.x);
        shift_up(pose, height / 2 * fabs(scale.y) * (top == bottom ? 0 : top > bottom ? 1 : -1));
        return;
    }
    out->type = TALUS_CAPSULE;
    out->half_height = sized(node, "capsule's half height", height / 2, scale.y);
    /* a point stands as the smallest ball */
    out->radius_top = top == 0 ? TALUS_MIN_SIZE : sized(node, "capsule's radiusTop", top, scale.x);
    out->radius_bottom = bottom == 0 ? TALUS_MIN_SIZE : sized(node, "capsule's radiusBottom", bottom, scale.x);
}

static void read_plane(gltf_loader *loader, const gltf_at *size, const gltf_at *node, gltf_double3 scale, int moving,
                       talus_geometry *out, talus_pose *pose) {
    double x = gltf_number(size, "sizeX", 0, 1e-9, 1e9), z = gltf_number(size, "sizeZ", 0, 1e-9, 1e9);
    if (moving) {
        gltf_fail(node, GLTF_UNSUPPORTED, "a plane is part of a moving body: planes must be static");
    }
    if (gltf_flag(size, "doubleSided", 0)) {
        gltf_fail(size, GLTF_UNSUPPORTED, "a double-sided plane: planes are solid below");
    }
    if (x == 0 || z == 0) {
        gltf_scene_add_note(loader->scene, "an infinite plane stands as a box %g m wide", 2 * PLANE_HALF_WIDTH);
    }
    out->type = TALUS_BOX;
    out->half.x = x == 0 ? (float)PLANE_HALF_WIDTH : sized(node, "plane's half width", x / 2, scale.x);
    out->half.y = (float)PLANE_HALF_DEPTH;
    out->half.z = z == 0 ? (float)PLANE_HALF_WIDTH : sized(node, "plane's half width", z / 2, scale.z);
    shift_up(pose, -PLANE_HALF_DEPTH);
}

static uint32_t read_implicit(gltf_loader *loader, int index, int node_index, uint32_t body, talus_pose *pose) {
    static const char *const kinds[] = {"box", "sphere", "capsule", "cylinder", "plane"};
    gltf_at shape = gltf_list_item(&loader->document.shapes, index);
    gltf_at node = gltf_list_item(&loader->document.nodes, node_index);
    const gltf_place *place = &loader->place[node_index];
    const char *type = gltf_string(&shape, "type");
    int kind = 0;
    while (type != NULL && kind < 5 && strcmp(type, kinds[kind]) != 0) {
        kind++;
    }
    gltf_at type_at = gltf_member(&shape, "type");
    if (type == NULL) {
        gltf_fail(&type_at, GLTF_BROKEN, "is missing, must be the kind of shape");
        return GLTF_NONE;
    }
    if (kind == 5) {
        gltf_fail(&type_at, GLTF_UNSUPPORTED, "is \"%.20s\", must be box, sphere, capsule, cylinder or plane", type);
        return GLTF_NONE;
    }
    if (place->sheared) {
        gltf_fail(&node, GLTF_UNSUPPORTED, "a %s is sheared by the scales of the nodes above it", kinds[kind]);
        return GLTF_NONE;
    }
    gltf_geometry geometry;
    memset(&geometry, 0, sizeof geometry);
    geometry.hull = GLTF_NONE;
    gltf_at size = gltf_member(&shape, kinds[kind]);
    talus_geometry *out = &geometry.geometry;
    switch (kind) {
    case 0:
        read_box(&size, &node, place->scale, out);
        break;
    case 1:
        read_sphere(&size, &node, place->scale, out);
        break;
    case 2:
        read_capsule(&size, &node, place->scale, out, pose);
        break;
    case 3:
        read_cylinder(&size, &node, place->scale, out);
        break;
    default:
        read_plane(loader, &size, &node, place->scale, body != GLTF_NONE, out, pose);
    }
    return gltf_failed(&shape) ? GLTF_NONE : share(loader, &shape, &geometry);
}

/* Whether the node is scaled to nothing, which takes the shape away; an error if that is so in one direction only. */
static int vanishes(const gltf_at *node, const gltf_place *place) {
    const double least = 1e-12;
    int zeros = (fabs(place->scale.x) < least) + (fabs(place->scale.y) < least) + (fabs(place->scale.z) < least);
    if (zeros > 0 && zeros < 3) {
        gltf_fail(node, GLTF_BROKEN, "its shape is scaled by %g %g %g, which makes it flat", place->scale.x,
                  place->scale.y, place->scale.z);
    }
    return zeros > 0;
}

uint32_t gltf_load_geometry(gltf_loader *loader, const gltf_at *geometry, int node_index, uint32_t body, int trigger,
                            talus_pose *pose) {
    gltf_document *document = &loader->document;
    gltf_at node = gltf_list_item(&document->nodes, node_index);
    if (geometry->json == NULL) {
        gltf_fail(geometry, GLTF_BROKEN, "is missing, must be an object with \"shape\" or \"node\"");
        return GLTF_NONE;
    }
    int given = gltf_has(geometry, "shape") + gltf_has(geometry, "node") + gltf_has(geometry, "mesh");
    if (given != 1) {
        gltf_fail(geometry, GLTF_BROKEN, "has %s of \"shape\", \"node\" and \"mesh\", must have one",
                  given == 0 ? "none" : "more than one");
        return GLTF_NONE;
    }
    int shape = gltf_index(geometry, "shape", document->shapes.count, "shapes");
    int hull = gltf_flag(geometry, "convexHull", 0);
    if (gltf_failed(geometry) || vanishes(&node, &loader->place[node_index])) {
        return GLTF_NONE;
    }
    if (shape >= 0) {
        return read_implicit(loader, shape, node_index, body, pose);
    }
    if (!hull) {
        gltf_fail(geometry, GLTF_UNSUPPORTED, "a triangle mesh%s; a hull (\"convexHull\": true) is",
                  body == GLTF_NONE ? " is not supported" : " that moves is not supported");
        return GLTF_NONE;
    }
    gltf_geometry found;
    memset(&found, 0, sizeof found);
    found.geometry.type = TALUS_HULL;
    found.hull = gltf_load_hull(loader, geometry, node_index, body, trigger, pose);
    return found.hull == GLTF_NONE ? GLTF_NONE : share(loader, geometry, &found);
}
