/* Writes physics scenes as glTF: a scene is put together by calls, and comes out as one self-contained .gltf text. */
#ifndef TALUS_GLTF_AUTHOR_H
#define TALUS_GLTF_AUTHOR_H

#include "gltf/text.h"
#include "gltf/transform.h"

#include <stdint.h>

/* Where a part of the scene stands: m, x y z w. */
typedef struct author_pose {
    gltf_double3 position;
    gltf_double4 rotation;
} author_pose;

typedef struct author_node {
    gltf_text members; /* JSON members, without `children` */
    gltf_text physics; /* those of its KHR_physics_rigid_bodies */
    gltf_text children;
    int is_root;
} author_node;

typedef struct author_body {
    int node;
    author_pose pose;
} author_body;

/* What a body is made of: a shape or a hull. */
typedef struct author_part {
    int shape, mesh; /* the other one is -1 */
} author_part;

typedef struct author {
    char name[40];
    gltf_text extras; /* further members of the scene's extras */
    author_node *nodes;
    author_body *bodies;
    gltf_text *seen[3]; /* shapes, materials, joints: each kind's entries, equal ones once */
    uint32_t node_count, node_room, body_count, body_room, seen_count[3], seen_room[3];
    gltf_text meshes, accessors, views, bytes;
    uint32_t mesh_count;
    int failed; /* there was no memory */
} author;

#define AUTHOR_WORLD (-1)

void author_open(author *a, const char *name, uint32_t steps);
/* The scene as text, freed by the caller; null if there was no memory. Closes the author. */
char *author_finish(author *a, size_t *size);

/* Parts: sizes are whole lengths (m). A capsule's height is the distance of its balls' centres. */
author_part author_box(author *a, double x, double y, double z);
author_part author_sphere(author *a, double radius);
author_part author_capsule(author *a, double height, double top, double bottom);
author_part author_cylinder(author *a, double height, double top, double bottom);
author_part author_hull(author *a, const gltf_double3 *points, uint32_t count);

/* A material's number; rules are null for the average, or minimum, maximum, multiply. */
int author_material(author *a, double friction, double restitution, const char *restitution_rule);

void author_static(author *a, author_part part, author_pose pose, int material);
/* A trigger that does not move. */
void author_trigger(author *a, author_part part, author_pose pose);
/* A body of one part; returns its number. `motion` is JSON members of its motion, or null. */
int author_add_body(author *a, author_part part, author_pose pose, int material, const char *motion);
/* A body without parts yet, and a part of it at a pose in its frame. */
int author_add_compound(author *a, author_pose pose, const char *motion);
void author_add_part(author *a, int body, author_part part, author_pose pose, int material);
/* Joins two bodies (AUTHOR_WORLD: the world) in a frame of the world; `limits` is JSON members of a physics joint. */
void author_joint(author *a, int body_a, int body_b, author_pose frame, const char *limits);

author_pose author_at(double x, double y, double z);
author_pose author_turned(double x, double y, double z, gltf_double4 rotation);
/* The rotation by an angle (rad) about an axis of any length. */
gltf_double4 author_rotation(double x, double y, double z, double angle);

#endif
