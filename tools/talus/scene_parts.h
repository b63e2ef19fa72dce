/* What the tool's scenes are put together from. */
#ifndef TALUS_TOOL_SCENE_PARTS_H
#define TALUS_TOOL_SCENE_PARTS_H

#include "gltf/author.h"

#define PARTS_PI 3.14159265358979323846

/* Limits and drives: members of a physics joint. x is the hinge, twist or slider axis of its frame. */
#define PARTS_PINNED "{\"linearAxes\":[0,1,2],\"min\":0,\"max\":0}"
#define PARTS_HINGED PARTS_PINNED ",{\"angularAxes\":[1,2],\"min\":0,\"max\":0}"
#define PARTS_LIMITS(limits) "\"limits\":[" limits "]"

/* Random numbers (PCG-XSH-RR, O'Neill 2014): the same on every machine. */
typedef struct parts_random {
    uint64_t state;
} parts_random;

/* A number in [low, high). */
double parts_uniform(parts_random *random, double low, double high);
/* A rotation, each as likely as any other (Shoemake 1992). */
gltf_double4 parts_rotation(parts_random *random);

/* A square slab whose upper face lies at y = 0, `half` m to each side. */
void parts_ground(author *a, double half, int material);
/* Four walls around a rectangle on the ground. */
void parts_walls(author *a, double x, double z, double half_x, double half_z, double height, int material);
/* Point i of layers of columns by rows, `spacing` m apart, from height `bottom` upwards. */
gltf_double3 parts_layer(uint32_t i, uint32_t columns, uint32_t rows, double spacing, double bottom);
/* The rotation that takes +x to a direction. */
gltf_double4 parts_turn_x_to(gltf_double3 direction);
author_pose parts_pose(gltf_double3 position, gltf_double4 rotation);

/* A rock: a hull with its corners on an ellipsoid of these half axes. */
author_part parts_rock(author *a, parts_random *random, double x, double y, double z);
/* A figure of eleven capsules, 1.9 m tall, its feet at `feet`. */
void parts_ragdoll(author *a, gltf_double3 feet, gltf_double4 rotation, int material);
/* Links from `top` on, each `step` long, the first one hung up; a ball (its radius, kg) at the end. */
void parts_chain(author *a, gltf_double3 top, gltf_double3 step, uint32_t links, double ball, double ball_mass,
                 int material);
/* Planks on hinges from one point to another at the same height, hung up at both ends. */
void parts_bridge(author *a, gltf_double3 from, gltf_double3 to, uint32_t planks, double width, int material);
/* A wall of boxes, each row one shorter than that below. */
void parts_pyramid(author *a, gltf_double3 middle, gltf_double3 along, uint32_t base, double size, int material);
/* Courses of three planks, laid crosswise. */
void parts_tower(author *a, gltf_double3 middle, uint32_t courses, double length, int material);

#endif
