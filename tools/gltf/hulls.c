/* The points of convex hulls out of meshes. */
#include "gltf/loader.h"

#include <stdlib.h>
#include <string.h>

/* What all hulls of a file may ask for: points read and nodes visited. */
#define WORK_LIMIT ((uint64_t)1 << 26)

/* Points that are gathered, in the collider's frame. */
typedef struct cloud {
    talus_vec3 *points;
    uint32_t count;
} cloud;

static int spend(gltf_loader *loader, const gltf_at *at, uint64_t work) {
    loader->work += work;
    if (loader->work > WORK_LIMIT) {
        gltf_fail(at, GLTF_UNSUPPORTED, "the hulls of this file ask for more than %lu points",
                  (unsigned long)WORK_LIMIT);
        return 0;
    }
    return 1;
}

/* Adds points at `linear` * p + offset; takes `points` over. */
static void add_points(const gltf_at *at, cloud *out, talus_vec3 *points, uint32_t count, const gltf_double9 *linear,
                       gltf_double3 offset) {
    for (uint32_t i = 0; i < count; i++) {
        gltf_double3 p = gltf_mul93(linear, gltf_d3(points[i].x, points[i].y, points[i].z));
        p = gltf_add3(p, offset);
        if (!(fabs(p.x) <= 1e6 && fabs(p.y) <= 1e6 && fabs(p.z) <= 1e6)) {
            gltf_fail(at, GLTF_BROKEN, "point %lu is scaled to %g %g %g m, at most 1e6 m are allowed", (unsigned long)i,
                      p.x, p.y, p.z);
            free(points);
            return;
        }
        points[i] = gltf_vec3(p);
    }
    if (out->count == 0) {
        free(out->points);
        out->points = points;
        out->count = count;
        return;
    }
    talus_vec3 *both = realloc(out->points, (out->count + count) * sizeof *both);
    if (both == NULL) {
        gltf_fail(at, GLTF_FAILED, "there is no memory for its %lu points", (unsigned long)(out->count + count));
    } else {
        memcpy(both + out->count, points, count * sizeof *both);
        out->points = both;
        out->count += count;
    }
    free(points);
}

static void add_mesh(gltf_loader *loader, int index, const gltf_double9 *linear, gltf_double3 offset, cloud *out) {
    gltf_at mesh = gltf_list_item(&loader->document.meshes, index);
    gltf_list primitives = gltf_list_open(&mesh, "primitives");
    if (primitives.count == 0) {
        gltf_fail(&primitives.at, GLTF_BROKEN, "is missing or empty");
    }
    for (int i = 0; i < primitives.count && loader->error->status == GLTF_OK; i++) {
        gltf_at primitive = gltf_list_item(&primitives, i);
        gltf_at attributes = gltf_member(&primitive, "attributes");
        gltf_at position = gltf_member(&attributes, "POSITION");
        if (gltf_has(&primitive, "targets") && (gltf_has(&mesh, "weights"))) {
            gltf_fail(&primitive, GLTF_UNSUPPORTED, "a hull of a mesh with morph targets and weights");
        }
        if (position.json == NULL) {
            gltf_fail(&position, GLTF_BROKEN, "is missing, a hull needs the index of an accessor here");
            break;
        }
        uint32_t count = 0;
        talus_vec3 *points = gltf_read_points(&loader->document, &position, TALUS_HULL_MAX_POINTS - out->count, &count);
        if (points != NULL && spend(loader, &position, count)) {
            add_points(&position, out, points, count, linear, offset);
        } else {
            free(points);
        }
    }
    gltf_list_close(&primitives);
}

/* A node whose meshes are gathered, with its place in the collider's frame. */
typedef struct visit {
    int node;
    gltf_double9 linear;
    gltf_double3 offset;
} visit;

static void push(gltf_loader *loader, const gltf_at *at, visit **stack, uint32_t *room, uint32_t *count,
                 const visit *item) {
    if (spend(loader, at, 1) && gltf_grow(loader->error, stack, room, *count, sizeof **stack)) {
        (*stack)[(*count)++] = *item;
    }
}

/* The meshes of a node and of those below it that do not move on their own. The node's own place does not count: its
 * geometry stands in the frame of the collider that names it. */
static void add_nodes(gltf_loader *loader, const gltf_at *at, int root, const gltf_double9 *linear, gltf_double3 offset,
                      cloud *out) {
    gltf_document *document = &loader->document;
    visit *stack = NULL;
    uint32_t room = 0, count = 0;
    visit first = {root, *linear, offset};
    push(loader, at, &stack, &room, &count, &first);
    while (count > 0 && loader->error->status == GLTF_OK) {
        visit now = stack[--count];
        gltf_at node = gltf_list_item(&document->nodes, now.node);
        if (gltf_has(&node, "skin")) {
            gltf_at skin = gltf_member(&node, "skin");
            gltf_fail(&skin, GLTF_UNSUPPORTED, "a hull of a skinned mesh");
        }
        int mesh = gltf_index(&node, "mesh", document->meshes.count, "meshes");
        if (mesh >= 0) {
            add_mesh(loader, mesh, &now.linear, now.offset, out);
        }
        gltf_at children = gltf_member(&node, "children");
        const cJSON *item = children.json != NULL ? children.json->child : NULL;
        for (; item != NULL && loader->error->status == GLTF_OK; item = item->next) {
            int child = (int)item->valuedouble; /* checked with the tree */
            gltf_at child_at = gltf_list_item(&document->nodes, child), extensions;
            gltf_at physics = gltf_physics(&child_at, &extensions);
            if (!gltf_has(&physics, "motion")) {
                const gltf_place *local = &loader->local[child];
                visit next = {child, gltf_mul99(&now.linear, &local->linear),
                              gltf_add3(now.offset, gltf_mul93(&now.linear, local->position))};
                push(loader, at, &stack, &room, &count, &next);
            }
        }
    }
    free(stack);
}

/* The hull with these points, which are taken over. */
static uint32_t share_points(gltf_loader *loader, const gltf_at *at, cloud *points, int node, int trigger) {
    gltf_scene *scene = loader->scene;
    gltf_key key;
    memset(&key, 0, sizeof key);
    uint64_t content = gltf_hash(points->points, points->count * sizeof *points->points);
    key.word[0] = points->count;
    key.word[1] = (uint32_t)content;
    key.word[2] = (uint32_t)(content >> 32);
    uint32_t *known = gltf_table_find(&loader->hull_table, &key, GLTF_NONE);
    if (known != NULL && *known != GLTF_NONE) {
        const gltf_hull *hull = &scene->hulls[*known];
        if (hull->count == points->count &&
            memcmp(hull->points, points->points, points->count * sizeof *points->points) == 0) {
            free(points->points);
            return *known;
        }
    }
    if (known == NULL ||
        !gltf_grow(loader->error, &scene->hulls, &scene->hull_room, scene->hull_count, sizeof *scene->hulls)) {
        gltf_fail(at, GLTF_FAILED, "there is no memory");
        free(points->points);
        return GLTF_NONE;
    }
    gltf_hull hull = {points->points, points->count, (uint32_t)node, (uint8_t)trigger, content};
    scene->hulls[scene->hull_count] = hull;
    *known = scene->hull_count++;
    return *known;
}

/* Gathers the points of the mesh or node that a `geometry` names. */
static void gather(gltf_loader *loader, const gltf_at *geometry, int mesh, int source, const gltf_double9 *linear,
                   gltf_double3 offset, cloud *out) {
    if (mesh >= 0) {
        add_mesh(loader, mesh, linear, offset, out);
    } else {
        add_nodes(loader, geometry, source, linear, offset, out);
    }
    if (loader->error->status == GLTF_OK && out->count == 0) {
        gltf_fail(geometry, GLTF_BROKEN, "node %d has no mesh, nor have those below it", source);
    }
}

uint32_t gltf_load_hull(gltf_loader *loader, const gltf_at *geometry, int node, uint32_t body, int trigger,
                        talus_pose *pose) {
    gltf_document *document = &loader->document;
    int mesh = gltf_index(geometry, "mesh", document->meshes.count, "meshes");
    int source = gltf_index(geometry, "node", document->nodes.count, "nodes");
    if (gltf_failed(geometry)) {
        return GLTF_NONE;
    }
    const gltf_place *place = &loader->place[node];
    cloud points = {NULL, 0};
    if (place->sheared) { /* the points are moved into the body's frame */
        static const talus_pose identity = {{0, 0, 0}, {0, 0, 0, 1}};
        gltf_place world;
        memset(&world, 0, sizeof world);
        world.rotation.w = 1;
        const gltf_place *origin = body == GLTF_NONE ? &world : &loader->place[loader->body_node[body]];
        gltf_double9 back = gltf_rotation_scale(gltf_conjugate(origin->rotation), gltf_d3(1, 1, 1));
        gltf_double9 linear = gltf_mul99(&back, &place->linear);
        gltf_double3 offset = gltf_mul93(&back, gltf_sub3(place->position, origin->position));
        *pose = identity;
        gather(loader, geometry, mesh, source, &linear, offset, &points);
        if (loader->error->status != GLTF_OK) {
            free(points.points);
            return GLTF_NONE;
        }
        return share_points(loader, geometry, &points, node, trigger);
    }
    gltf_key key;
    memset(&key, 0, sizeof key);
    key.word[0] = mesh >= 0;
    key.word[1] = (uint32_t)(mesh >= 0 ? mesh : source);
    memcpy(&key.word[2], &place->scale, sizeof place->scale);
    uint32_t *known = gltf_table_find(&loader->shape_table, &key, GLTF_NONE);
    if (known == NULL) {
        gltf_fail(geometry, GLTF_FAILED, "there is no memory");
        return GLTF_NONE;
    }
    if (*known == GLTF_NONE) {
        gltf_double9 linear = {{place->scale.x, 0, 0}, {0, place->scale.y, 0}, {0, 0, place->scale.z}};
        gather(loader, geometry, mesh, source, &linear, gltf_d3(0, 0, 0), &points);
        if (loader->error->status != GLTF_OK) {
            free(points.points);
            return GLTF_NONE;
        }
        *known = share_points(loader, geometry, &points, node, trigger);
    }
    return *known;
}
