/* A physics scene as plain data: what a glTF 2.0 file with KHR_implicit_shapes and KHR_physics_rigid_bodies (draft of
 * October 2025) says, checked, with all poses worked out. Knows no world. SI units, radians.
 *
 * What those extensions leave open: gravity (m/s^2), dt (s) and steps of a run are scenes[].extras.gravity, .dt and
 * .steps; a collider without a material has friction 0.5; materials combine by their average unless they say otherwise;
 * colliders filter each other where one's collideWithSystems has none of the other's systems. */
#ifndef TALUS_GLTF_SCENE_H
#define TALUS_GLTF_SCENE_H

#include "gltf/error.h"
#include "talus/body.h"
#include "talus/joint.h"
#include "talus/shape.h"

#include <stddef.h>

#define GLTF_NONE UINT32_MAX
#define GLTF_MAX_STEPS 100000000u

/* The points of a convex hull (m), in its collider's frame. */
typedef struct gltf_hull {
    talus_vec3 *points;
    uint32_t count;
    uint32_t node;    /* of its first collider, for messages */
    uint8_t trigger;  /* it was a trigger */
    uint64_t content; /* a hash of the points */
} gltf_hull;

/* A geometry that colliders share; geometry.hull holds no offset yet. */
typedef struct gltf_geometry {
    talus_geometry geometry;
    uint32_t hull; /* index of its points; GLTF_NONE unless it is a hull */
} gltf_geometry;

/* A node with `motion`; they stand in the order of their nodes. */
typedef struct gltf_body {
    char *name; /* null if the node has none */
    uint32_t node;
    talus_pose pose;             /* of the node, without its scale */
    talus_vec3 linear_velocity;  /* m/s, of the centre of mass, world axes */
    talus_vec3 angular_velocity; /* rad/s, world axes */
    float gravity_factor;
    uint32_t locks; /* TALUS_LOCK_*: by joints to the world that leave it the motion in a plane */
    uint8_t kinematic;
    uint8_t has_mass, has_center, has_inertia;
    float mass;                  /* kg; 0 is infinite */
    talus_vec3 center;           /* m, in the body's frame */
    talus_vec3 inertia_diagonal; /* kg m^2 about the axes of inertia_axes; 0 is infinite */
    talus_quat inertia_axes;     /* in the body's frame */
} gltf_body;

typedef struct gltf_collider {
    char *name;
    uint32_t node;
    uint32_t body;   /* GLTF_NONE: static */
    talus_pose pose; /* in its body, or the world */
    uint32_t geometry;
    talus_material material;
    talus_filter filter;
    uint8_t sensor;   /* a trigger */
    uint8_t anchored; /* static, and a joint hangs on it */
} gltf_collider;

typedef struct gltf_joint {
    uint32_t node;
    uint32_t body_a, body_b;     /* GLTF_NONE: the world */
    uint32_t static_a, static_b; /* the static collider that a joint to the world hangs on; or GLTF_NONE */
    talus_joint_def def;         /* its bodies are left null */
} gltf_joint;

typedef struct gltf_scene {
    char *name; /* null if the file gives none */
    char *note;
    talus_vec3 gravity; /* m/s^2 */
    float dt;           /* s */
    uint32_t steps;
    gltf_hull *hulls;
    gltf_geometry *geometries;
    gltf_body *bodies;
    gltf_collider *colliders; /* in the order of their nodes */
    gltf_joint *joints;
    char **notes; /* what was taken otherwise than the file says */
    uint32_t hull_count, geometry_count, body_count, collider_count, joint_count, note_count;
    uint32_t hull_room, geometry_room, body_room, collider_room, joint_room, note_room;
} gltf_scene;

/* Loads a .gltf or .glb. Files that it names are looked for in `folder`; if that is null there are none. After an error
 * the scene is empty; it is to be freed in either case. */
gltf_status gltf_scene_load(gltf_scene *scene, const void *bytes, size_t size, const char *folder, gltf_error *error);
gltf_status gltf_scene_load_file(gltf_scene *scene, const char *path, gltf_error *error);
void gltf_scene_free(gltf_scene *scene);

/* Adds a note, once. */
void gltf_scene_add_note(gltf_scene *scene, const char *format, ...) GLTF_PRINTF(2, 3);

#endif
