/* The loader's parts, one after the other: the tree of nodes, shapes, bodies and joints. */
#ifndef TALUS_GLTF_LOADER_H
#define TALUS_GLTF_LOADER_H

#include "gltf/document.h"
#include "gltf/scene.h"
#include "gltf/table.h"
#include "gltf/transform.h"

#define GLTF_MAX_POSITION 1e7 /* m */

/* Where a node stands in the world. */
typedef struct gltf_place {
    gltf_double3 position;
    gltf_double4 rotation;
    gltf_double3 scale;
    gltf_double9 linear; /* rotation and scale together */
    uint8_t sheared;     /* linear is no rotation and scale: the two do not hold */
    uint8_t in_scene;
} gltf_place;

typedef struct gltf_loader {
    gltf_document document;
    gltf_scene *scene;
    gltf_error *error;
    int scene_index;
    int *parent;        /* of each node; -1: none */
    gltf_place *local;  /* of each node in its parent */
    gltf_place *place;  /* of each node in the world, if it is in the scene */
    uint32_t *body;     /* of each node: the body that it belongs to, or GLTF_NONE */
    int *body_node;     /* of each body */
    uint32_t *collider; /* of each node: the static collider that it or its nearest such ancestor is, or GLTF_NONE */
    int *order;         /* nodes of the scene, parents first */
    int order_count;
    gltf_table shape_table, hull_table, geometry_table;
    uint64_t work; /* points and nodes gone through for hulls */
} gltf_loader;

/* The physics of a node; where `extension` is to hold the place in between. */
gltf_at gltf_physics(const gltf_at *node, gltf_at *extensions);

int gltf_load_tree(gltf_loader *loader);
int gltf_load_bodies(gltf_loader *loader);
int gltf_load_colliders(gltf_loader *loader);
int gltf_load_joints(gltf_loader *loader);
/* One entry of physicsJoints into a joint's limits and drives. */
void gltf_read_joint(gltf_loader *loader, const gltf_at *kind, talus_joint_def *def);

/* A node's pose in a body's frame, or the world's where body is GLTF_NONE. */
talus_pose gltf_pose_in_body(const gltf_loader *loader, int node, uint32_t body);
/* The geometry of a `geometry` object for the collider at `node`, shared with equal ones. *pose is the node's pose in
 * `body` and becomes that of the geometry. GLTF_NONE after an error, or if the shape is scaled to nothing. */
uint32_t gltf_load_geometry(gltf_loader *loader, const gltf_at *geometry, int node, uint32_t body, int trigger,
                            talus_pose *pose);
/* The points of a mesh, or of the meshes at and below a node, for a hull; GLTF_NONE after an error. */
uint32_t gltf_load_hull(gltf_loader *loader, const gltf_at *geometry, int node, uint32_t body, int trigger,
                        talus_pose *pose);

/* Room for one more element of a growing array; 0 if there is no memory. */
int gltf_grow(gltf_error *error, void *array, uint32_t *room, uint32_t count, size_t size);

#endif
