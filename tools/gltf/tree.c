/* The tree of nodes: that it is one, and where each node stands. glTF 2.0, sections 3.5.2 and 3.5.3. */
#include "gltf/loader.h"

#include <stdlib.h>
#include <string.h>

gltf_at gltf_physics(const gltf_at *node, gltf_at *extensions) {
    *extensions = gltf_member(node, "extensions");
    return gltf_member(extensions, "KHR_physics_rigid_bodies");
}

static void read_matrix(const gltf_at *node, gltf_place *place) {
    static const char *const others[] = {"translation", "rotation", "scale"};
    double m[16];
    gltf_at at = gltf_member(node, "matrix");
    if (!gltf_numbers(node, "matrix", m, 16, 1e9)) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        if (gltf_has(node, others[i])) {
            gltf_fail(&at, GLTF_BROKEN, "stands beside %s, must be alone", others[i]);
        }
    }
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
        gltf_fail(&at, GLTF_BROKEN, "its last row is %g %g %g %g, must be 0 0 0 1", m[3], m[7], m[11], m[15]);
        return;
    }
    gltf_double9 columns = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
    double lengths[3] = {gltf_length3(columns.x), gltf_length3(columns.y), gltf_length3(columns.z)};
    if (!(lengths[0] > 1e-12 && lengths[1] > 1e-12 && lengths[2] > 1e-12)) {
        gltf_fail(&at, GLTF_BROKEN, "has a column of length 0");
        return;
    }
    if (gltf_dot3(gltf_cross3(columns.x, columns.y), columns.z) < 0) {
        lengths[0] = -lengths[0];
    }
    columns.x = gltf_scale3(columns.x, 1 / lengths[0]);
    columns.y = gltf_scale3(columns.y, 1 / lengths[1]);
    columns.z = gltf_scale3(columns.z, 1 / lengths[2]);
    double skew = fabs(gltf_dot3(columns.x, columns.y));
    skew = fmax(skew, fmax(fabs(gltf_dot3(columns.y, columns.z)), fabs(gltf_dot3(columns.z, columns.x))));
    if (skew > 1e-3) {
        gltf_fail(&at, GLTF_BROKEN, "has shear, must be a translation, a rotation and a scale");
        return;
    }
    place->position = gltf_d3(m[12], m[13], m[14]);
    place->rotation = gltf_from_columns(&columns);
    place->scale = gltf_d3(lengths[0], lengths[1], lengths[2]);
}

static void read_rotation(const gltf_at *node, gltf_place *place) {
    double q[4];
    if (!gltf_numbers(node, "rotation", q, 4, 1e3)) {
        return;
    }
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(fabs(length - 1) <= 0.01)) {
        gltf_at at = gltf_member(node, "rotation");
        gltf_fail(&at, GLTF_BROKEN, "has length %g, must be a unit quaternion x y z w", length);
        return;
    }
    gltf_double4 rotation = {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
    place->rotation = rotation;
}

static void read_local(const gltf_at *node, gltf_place *place) {
    gltf_double4 identity = {0, 0, 0, 1};
    place->rotation = identity;
    place->scale = gltf_d3(1, 1, 1);
    if (gltf_has(node, "matrix")) {
        read_matrix(node, place);
    } else {
        double v[3];
        if (gltf_numbers(node, "translation", v, 3, 1e9)) {
            place->position = gltf_d3(v[0], v[1], v[2]);
        }
        if (gltf_numbers(node, "scale", v, 3, 1e9)) {
            place->scale = gltf_d3(v[0], v[1], v[2]);
        }
        read_rotation(node, place);
    }
    place->linear = gltf_rotation_scale(place->rotation, place->scale);
}

/* Gives each node its parent; a node with two, or with itself above it, is an error. */
static void read_parents(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    for (int i = 0; i < nodes->count; i++) {
        loader->parent[i] = -1;
    }
    for (int i = 0; i < nodes->count && loader->error->status == GLTF_OK; i++) {
        gltf_at node = gltf_list_item(nodes, i);
        gltf_list children = gltf_list_open(&node, "children");
        for (int k = 0; k < children.count; k++) {
            gltf_at at = gltf_list_item(&children, k);
            int child = gltf_index_here(&at, nodes->count, "nodes");
            if (child < 0) {
                break;
            }
            if (loader->parent[child] >= 0) {
                gltf_fail(&at, GLTF_BROKEN, "is node %d, which is a child of node %d already", child,
                          loader->parent[child]);
                break;
            }
            loader->parent[child] = i;
        }
        gltf_list_close(&children);
    }
}

/* Walks up from every node once; `seen` holds the number of the walk that came by (0: none). */
static void check_cycles(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    int *seen = calloc((size_t)nodes->count + 1, sizeof *seen);
    if (seen == NULL) {
        gltf_fail(&nodes->at, GLTF_FAILED, "there is no memory");
        return;
    }
    for (int i = 0; i < nodes->count; i++) {
        int node = i;
        for (; node >= 0 && seen[node] == 0; node = loader->parent[node]) {
            seen[node] = i + 1;
        }
        if (node >= 0 && seen[node] == i + 1) {
            gltf_at at = gltf_list_item(nodes, node);
            gltf_fail(&at, GLTF_BROKEN, "is below itself");
            break;
        }
    }
    free(seen);
}

/* The unit columns of a matrix as a rotation and signed lengths; 0 if they are not at right angles. */
static int split_columns(const gltf_double9 *linear, gltf_double4 *rotation, gltf_double3 *scale) {
    gltf_double9 unit = *linear;
    double x = gltf_length3(unit.x), y = gltf_length3(unit.y), z = gltf_length3(unit.z);
    if (!(x > 0 && y > 0 && z > 0)) {
        return 0;
    }
    if (gltf_dot3(gltf_cross3(unit.x, unit.y), unit.z) < 0) {
        x = -x;
    }
    unit.x = gltf_scale3(unit.x, 1 / x);
    unit.y = gltf_scale3(unit.y, 1 / y);
    unit.z = gltf_scale3(unit.z, 1 / z);
    if (fabs(gltf_dot3(unit.x, unit.y)) > 1e-5 || fabs(gltf_dot3(unit.y, unit.z)) > 1e-5 ||
        fabs(gltf_dot3(unit.z, unit.x)) > 1e-5) {
        return 0;
    }
    *rotation = gltf_from_columns(&unit);
    *scale = gltf_d3(x, y, z);
    return 1;
}

/* A node in the world out of its parent's place there. */
static void compose(const gltf_place *up, const gltf_place *local, gltf_place *out) {
    const gltf_double3 s = up->scale;
    const gltf_double4 q = local->rotation;
    out->position = gltf_add3(up->position, gltf_mul93(&up->linear, local->position));
    out->linear = gltf_mul99(&up->linear, &local->linear);
    out->sheared = up->sheared;
    out->rotation = gltf_mul4(up->rotation, q);
    out->scale = gltf_mul3(s, local->scale);
    int uniform = s.x == s.y && s.y == s.z;
    int unturned = q.x == 0 && q.y == 0 && q.z == 0;
    if (!uniform && !unturned && !split_columns(&out->linear, &out->rotation, &out->scale)) {
        out->sheared = 1;
    }
}

/* Adds the nodes below `root` to the order, parents first. */
static void place_below(gltf_loader *loader, int root) {
    const gltf_list *nodes = &loader->document.nodes;
    int next = loader->order_count;
    loader->order[loader->order_count++] = root;
    loader->place[root] = loader->local[root];
    while (next < loader->order_count) {
        int index = loader->order[next++];
        gltf_place *place = &loader->place[index];
        gltf_at node = gltf_list_item(nodes, index);
        if (loader->parent[index] >= 0) {
            compose(&loader->place[loader->parent[index]], &loader->local[index], place);
        }
        place->in_scene = 1;
        double far = fmax(fabs(place->position.x), fmax(fabs(place->position.y), fabs(place->position.z)));
        double size = fmax(fabs(place->scale.x), fmax(fabs(place->scale.y), fabs(place->scale.z)));
        if (!(far <= GLTF_MAX_POSITION) || !(size <= 1e9)) {
            gltf_fail(&node, GLTF_BROKEN, "stands %g m from the origin at a scale of %g, at most %g and 1e9", far, size,
                      GLTF_MAX_POSITION);
            return;
        }
        gltf_at children = gltf_member(&node, "children");
        const cJSON *item = children.json != NULL ? children.json->child : NULL;
        for (; item != NULL; item = item->next) {
            loader->order[loader->order_count++] = (int)item->valuedouble; /* checked by read_parents */
        }
    }
}

static void place_scene(gltf_loader *loader) {
    gltf_document *document = &loader->document;
    gltf_list scenes = gltf_list_open(&document->root, "scenes");
    if (scenes.count == 0) {
        gltf_fail(&scenes.at, GLTF_BROKEN, "is missing or empty: there is no scene to run");
    }
    int index = gltf_index(&document->root, "scene", scenes.count, "scenes");
    loader->scene_index = index < 0 ? 0 : index;
    if (loader->error->status == GLTF_OK) {
        gltf_at scene = gltf_list_item(&scenes, loader->scene_index);
        gltf_list roots = gltf_list_open(&scene, "nodes");
        for (int i = 0; i < roots.count && loader->error->status == GLTF_OK; i++) {
            gltf_at at = gltf_list_item(&roots, i);
            int root = gltf_index_here(&at, document->nodes.count, "nodes");
            if (root < 0) {
                break;
            }
            if (loader->parent[root] >= 0) {
                gltf_fail(&at, GLTF_BROKEN, "is node %d, which is a child of node %d: only roots may stand here", root,
                          loader->parent[root]);
            } else if (loader->place[root].in_scene) {
                gltf_fail(&at, GLTF_BROKEN, "is node %d, which stands here already", root);
            } else {
                place_below(loader, root);
            }
        }
        gltf_list_close(&roots);
    }
    gltf_list_close(&scenes);
}

int gltf_load_tree(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    size_t count = (size_t)nodes->count + 1;
    loader->parent = malloc(count * sizeof *loader->parent);
    loader->local = calloc(count, sizeof *loader->local);
    loader->place = calloc(count, sizeof *loader->place);
    loader->order = malloc(count * sizeof *loader->order);
    if (loader->parent == NULL || loader->local == NULL || loader->place == NULL || loader->order == NULL) {
        gltf_fail(&nodes->at, GLTF_FAILED, "there is no memory for its %d elements", nodes->count);
        return 0;
    }
    for (int i = 0; i < nodes->count && loader->error->status == GLTF_OK; i++) {
        gltf_at node = gltf_list_item(nodes, i);
        read_local(&node, &loader->local[i]);
    }
    read_parents(loader);
    if (loader->error->status == GLTF_OK) {
        check_cycles(loader);
    }
    if (loader->error->status == GLTF_OK) {
        place_scene(loader);
    }
    return loader->error->status == GLTF_OK;
}

talus_pose gltf_pose_in_body(const gltf_loader *loader, int node, uint32_t body) {
    const gltf_place *place = &loader->place[node];
    talus_pose pose = {{0, 0, 0}, {0, 0, 0, 1}};
    if (body == GLTF_NONE) {
        pose.position = gltf_vec3(place->position);
        pose.rotation = gltf_quat(place->rotation);
    } else if (loader->body_node[body] != node) {
        const gltf_place *origin = &loader->place[loader->body_node[body]];
        gltf_double4 back = gltf_conjugate(origin->rotation);
        pose.position = gltf_vec3(gltf_rotate(back, gltf_sub3(place->position, origin->position)));
        pose.rotation = gltf_quat(gltf_mul4(back, place->rotation));
    }
    return pose;
}
