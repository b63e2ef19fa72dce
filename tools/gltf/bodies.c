/* Motions, colliders and triggers of KHR_physics_rigid_bodies, with their materials and filters. */
#include "gltf/loader.h"

#include <stdlib.h>
#include <string.h>

#define MAX_FILTERS 63 /* kinds of filters; one more bit is for colliders without */

static char *copy_text(const char *text) {
    if (text == NULL) {
        return NULL;
    }
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy != NULL ? memcpy(copy, text, size) : NULL;
}

/* --- motion --- */

static void read_mass(const gltf_at *motion, const gltf_place *place, gltf_body *body) {
    double mass = gltf_number(motion, "mass", -1, 0, 1e15);
    if (mass >= 0) {
        body->has_mass = 1;
        body->mass = (float)mass;
        gltf_at at = gltf_member(motion, "mass");
        if (mass > 0 && mass < 1e-15) {
            gltf_fail(&at, GLTF_BROKEN, "is %g, must be 0 (infinite) or from 1e-15 to 1e15 kg", mass);
        }
    }
    double v[3];
    if (gltf_numbers(motion, "centerOfMass", v, 3, 1e6)) {
        body->has_center = 1;
        gltf_double3 center = gltf_mul3(gltf_d3(v[0], v[1], v[2]), place->scale);
        if (!(fabs(center.x) <= 1e6 && fabs(center.y) <= 1e6 && fabs(center.z) <= 1e6)) {
            gltf_at at = gltf_member(motion, "centerOfMass");
            gltf_fail(&at, GLTF_BROKEN, "is scaled to %g %g %g m, at most 1e6 m are allowed", center.x, center.y,
                      center.z);
            return;
        }
        body->center = gltf_vec3(center);
    }
    if (gltf_numbers(motion, "inertiaDiagonal", v, 3, 1e18)) {
        gltf_at at = gltf_member(motion, "inertiaDiagonal");
        for (int i = 0; i < 3; i++) {
            if (v[i] < 0 || (v[i] > 0 && v[i] < 1e-18)) {
                gltf_fail(&at, GLTF_BROKEN, "element %d is %g, must be 0 (infinite) or from 1e-18 to 1e18 kg m^2", i,
                          v[i]);
                return;
            }
        }
        body->has_inertia = 1;
        body->inertia_diagonal = gltf_vec3(gltf_d3(v[0], v[1], v[2]));
    }
    double q[4];
    if (gltf_numbers(motion, "inertiaOrientation", q, 4, 1e3)) {
        double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        if (!(fabs(length - 1) <= 0.01)) {
            gltf_at at = gltf_member(motion, "inertiaOrientation");
            gltf_fail(&at, GLTF_BROKEN, "has length %g, must be a unit quaternion x y z w", length);
            return;
        }
        gltf_double4 axes = {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
        body->inertia_axes = gltf_quat(axes);
    }
}

static void read_motion(gltf_loader *loader, int index, const gltf_at *node, const gltf_at *motion) {
    gltf_scene *scene = loader->scene;
    const gltf_place *place = &loader->place[index];
    gltf_body body;
    memset(&body, 0, sizeof body);
    body.node = (uint32_t)index;
    body.inertia_axes.w = 1;
    if (place->sheared) {
        gltf_fail(node, GLTF_UNSUPPORTED, "a moving node is sheared by the scales of the nodes above it");
    }
    body.pose.position = gltf_vec3(place->position);
    body.pose.rotation = gltf_quat(place->rotation);
    body.kinematic = (uint8_t)gltf_flag(motion, "isKinematic", 0);
    body.gravity_factor = (float)gltf_number(motion, "gravityFactor", 1, -1e6, 1e6);
    double v[3];
    if (gltf_numbers(motion, "linearVelocity", v, 3, 1e6)) {
        body.linear_velocity = gltf_vec3(gltf_rotate(place->rotation, gltf_d3(v[0], v[1], v[2])));
    }
    if (gltf_numbers(motion, "angularVelocity", v, 3, 1e6)) {
        body.angular_velocity = gltf_vec3(gltf_rotate(place->rotation, gltf_d3(v[0], v[1], v[2])));
    }
    read_mass(motion, place, &body);
    const char *name = gltf_string(node, "name");
    if (gltf_failed(node) ||
        !gltf_grow(loader->error, &scene->bodies, &scene->body_room, scene->body_count, sizeof *scene->bodies)) {
        return;
    }
    body.name = copy_text(name);
    loader->body_node[scene->body_count] = index;
    scene->bodies[scene->body_count++] = body;
}

int gltf_load_bodies(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    size_t count = (size_t)nodes->count + 1;
    loader->body = malloc(count * sizeof *loader->body);
    loader->body_node = malloc(count * sizeof *loader->body_node);
    if (loader->body == NULL || loader->body_node == NULL) {
        gltf_fail(&nodes->at, GLTF_FAILED, "there is no memory for its %d elements", nodes->count);
        return 0;
    }
    for (int i = 0; i < nodes->count && loader->error->status == GLTF_OK; i++) {
        loader->body[i] = GLTF_NONE;
        gltf_at node = gltf_list_item(nodes, i), extensions;
        gltf_at physics = gltf_physics(&node, &extensions), motion = gltf_member(&physics, "motion");
        if (motion.json != NULL && loader->place[i].in_scene) {
            loader->body[i] = loader->scene->body_count;
            read_motion(loader, i, &node, &motion);
        }
    }
    for (int k = 0; k < loader->order_count && loader->error->status == GLTF_OK; k++) {
        int i = loader->order[k];
        if (loader->body[i] == GLTF_NONE && loader->parent[i] >= 0) {
            loader->body[i] = loader->body[loader->parent[i]];
        }
    }
    return loader->error->status == GLTF_OK;
}

/* --- materials --- */

static talus_material read_material(gltf_loader *loader, const gltf_at *collider) {
    static const char *const rules[] = {"average", "minimum", "maximum", "multiply"}; /* in talus_combine's order */
    talus_material material;
    memset(&material, 0, sizeof material);
    material.static_friction = material.dynamic_friction = 0.5f;
    int index = gltf_index(collider, "physicsMaterial", loader->document.materials.count, "physics materials");
    if (index >= 0) {
        gltf_at at = gltf_list_item(&loader->document.materials, index);
        material.static_friction = (float)gltf_number(&at, "staticFriction", 0.6, 0, 1e6);
        material.dynamic_friction = (float)gltf_number(&at, "dynamicFriction", 0.6, 0, 1e6);
        double restitution = gltf_number(&at, "restitution", 0, 0, 1e6);
        if (restitution > 1) {
            gltf_scene_add_note(loader->scene, "a restitution above 1 is taken as 1");
            restitution = 1;
        }
        material.restitution = (float)restitution;
        material.friction_combine = (talus_combine)gltf_choice(&at, "frictionCombine", rules, 4, 0);
        material.restitution_combine = (talus_combine)gltf_choice(&at, "restitutionCombine", rules, 4, 0);
    }
    return material;
}

/* --- filters --- */

static int lists_share(const gltf_list *a, const gltf_list *b) {
    for (int i = 0; i < a->count; i++) {
        for (int k = 0; k < b->count; k++) {
            if (strcmp(a->items[i]->valuestring, b->items[k]->valuestring) == 0) {
                return 1;
            }
        }
    }
    return 0;
}

/* One entry of collisionFilters. */
typedef struct filter {
    gltf_list systems, with, without;
} filter;

static gltf_list open_texts(const gltf_at *object, const char *key) {
    gltf_list list = gltf_list_open(object, key);
    for (int i = 0; i < list.count; i++) {
        if (!cJSON_IsString(list.items[i])) {
            gltf_at at = gltf_list_item(&list, i);
            gltf_fail(&at, GLTF_BROKEN, "must be a text, the name of a system");
            gltf_list_close(&list);
        }
    }
    if (list.count > 1000) {
        gltf_fail(&list.at, GLTF_UNSUPPORTED, "has %d systems, at most 1000 are supported", list.count);
        gltf_list_close(&list);
    }
    return list;
}

/* Whether b's lists let a collide with it. With no list all may. The draft's text asks that all of a's systems are in
 * the list; its samples and importers take one in common as enough, and so it is here. */
static int lets(const filter *a, const filter *b) {
    if (b->with.at.json != NULL) {
        return lists_share(&a->systems, &b->with);
    }
    return b->without.at.json == NULL || !lists_share(&a->systems, &b->without);
}

/* A bit for each filter, and in its mask the bits of those that it collides with: any rule can be said so. The last one
 * is that of colliders without a filter. */
static void read_filters(gltf_loader *loader, talus_filter *out) {
    gltf_list *list = &loader->document.filters;
    filter filters[MAX_FILTERS + 1];
    gltf_at places[MAX_FILTERS];
    memset(filters, 0, sizeof filters);
    if (list->count > MAX_FILTERS) {
        gltf_fail(&list->at, GLTF_UNSUPPORTED, "has %d filters, at most %d are supported", list->count, MAX_FILTERS);
        return;
    }
    for (int i = 0; i < list->count; i++) {
        places[i] = gltf_list_item(list, i);
        filters[i].systems = open_texts(&places[i], "collisionSystems");
        filters[i].with = open_texts(&places[i], "collideWithSystems");
        filters[i].without = open_texts(&places[i], "notCollideWithSystems");
        if (filters[i].with.at.json != NULL && filters[i].without.at.json != NULL) {
            gltf_fail(&places[i], GLTF_BROKEN,
                      "has both collideWithSystems and notCollideWithSystems, may have only one");
        }
    }
    for (int i = 0; i <= list->count; i++) {
        out[i].category = (uint64_t)1 << i;
        for (int k = 0; k <= list->count && loader->error->status == GLTF_OK; k++) {
            if (lets(&filters[i], &filters[k]) && lets(&filters[k], &filters[i])) {
                out[i].mask |= (uint64_t)1 << k;
            }
        }
    }
    for (int i = 0; i < list->count; i++) {
        gltf_list_close(&filters[i].systems);
        gltf_list_close(&filters[i].with);
        gltf_list_close(&filters[i].without);
    }
}

/* --- colliders and triggers --- */

static void add_collider(gltf_loader *loader, int index, const gltf_at *node, const gltf_at *part, int trigger,
                         const talus_filter *filters) {
    gltf_scene *scene = loader->scene;
    gltf_collider collider;
    memset(&collider, 0, sizeof collider);
    collider.node = (uint32_t)index;
    collider.body = loader->body[index];
    collider.sensor = (uint8_t)trigger;
    collider.pose = gltf_pose_in_body(loader, index, collider.body);
    gltf_at geometry = gltf_member(part, "geometry");
    collider.geometry = gltf_load_geometry(loader, &geometry, index, collider.body, trigger, &collider.pose);
    if (gltf_failed(node) || collider.geometry == GLTF_NONE) {
        return;
    }
    collider.material = read_material(loader, part);
    int filter_count = loader->document.filters.count;
    int which = gltf_index(part, "collisionFilter", filter_count, "collision filters");
    collider.filter = filters[which < 0 ? filter_count : which];
    const char *name = gltf_string(node, "name");
    if (gltf_failed(node) || !gltf_grow(loader->error, &scene->colliders, &scene->collider_room, scene->collider_count,
                                        sizeof *scene->colliders)) {
        return;
    }
    collider.name = copy_text(name);
    if (collider.body == GLTF_NONE && !trigger) {
        loader->collider[index] = scene->collider_count;
    }
    scene->colliders[scene->collider_count++] = collider;
}

/* A compound trigger: nodes below it that are triggers, which are read where they stand. */
static void check_compound(gltf_loader *loader, int index, const gltf_at *trigger) {
    const gltf_list *nodes = &loader->document.nodes;
    gltf_list parts = gltf_list_open(trigger, "nodes");
    if (parts.count == 0) {
        gltf_fail(&parts.at, GLTF_BROKEN, "must name at least one node");
    }
    if (gltf_has(trigger, "geometry")) {
        gltf_fail(trigger, GLTF_BROKEN, "has both \"geometry\" and \"nodes\", must have one");
    }
    for (int i = 0; i < parts.count && loader->error->status == GLTF_OK; i++) {
        gltf_at at = gltf_list_item(&parts, i);
        int part = gltf_index_here(&at, nodes->count, "nodes");
        if (part < 0) {
            break;
        }
        gltf_at node = gltf_list_item(nodes, part), extensions;
        gltf_at physics = gltf_physics(&node, &extensions);
        int up = part;
        for (uint64_t steps = 0; up >= 0 && up != index && steps <= 10000; steps++) {
            up = loader->parent[up];
        }
        if (!gltf_has(&physics, "trigger") || part == index || up != index) {
            gltf_fail(&at, GLTF_BROKEN, "is node %d, must be a node with a trigger below this one", part);
        }
    }
    gltf_list_close(&parts);
}

int gltf_load_colliders(gltf_loader *loader) {
    const gltf_list *nodes = &loader->document.nodes;
    talus_filter filters[MAX_FILTERS + 1];
    memset(filters, 0, sizeof filters);
    read_filters(loader, filters);
    loader->collider = malloc(((size_t)nodes->count + 1) * sizeof *loader->collider);
    if (loader->collider == NULL) {
        gltf_fail(&nodes->at, GLTF_FAILED, "there is no memory for its %d elements", nodes->count);
        return 0;
    }
    for (int i = 0; i < nodes->count && loader->error->status == GLTF_OK; i++) {
        loader->collider[i] = GLTF_NONE;
        if (!loader->place[i].in_scene) {
            continue;
        }
        gltf_at node = gltf_list_item(nodes, i), extensions;
        gltf_at physics = gltf_physics(&node, &extensions);
        gltf_at collider = gltf_member(&physics, "collider"), trigger = gltf_member(&physics, "trigger");
        if (collider.json != NULL) {
            add_collider(loader, i, &node, &collider, 0, filters);
        }
        if (trigger.json != NULL && gltf_has(&trigger, "nodes")) {
            check_compound(loader, i, &trigger);
        } else if (trigger.json != NULL) {
            add_collider(loader, i, &node, &trigger, 1, filters);
        }
    }
    for (int k = 0; k < loader->order_count && loader->error->status == GLTF_OK; k++) {
        int i = loader->order[k], up = loader->parent[i];
        if (loader->collider[i] == GLTF_NONE && up >= 0 && loader->body[i] == GLTF_NONE) {
            loader->collider[i] = loader->collider[up];
        }
    }
    return loader->error->status == GLTF_OK;
}
