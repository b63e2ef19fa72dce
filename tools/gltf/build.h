/* Makes a world out of a scene. */
#ifndef TALUS_GLTF_BUILD_H
#define TALUS_GLTF_BUILD_H

#include "gltf/scene.h"
#include "talus/talus.h"

typedef struct gltf_build_options {
    uint32_t substeps, iterations; /* 0: the library's default */
    talus_isa isa;
    int no_sleep;
    uint32_t profile_capacity; /* frames of the profiler's ring */
    float contact_hertz;       /* 0: the library's default */
    int no_kept_manifolds;     /* all are computed in every step */
    float error_budget;        /* m, 0: none */
    uint32_t most_substeps;    /* 0: the library's default */
} gltf_build_options;

/* A world with the memory it lives in. */
typedef struct gltf_world {
    talus_world world;
    size_t block_bytes, geometry_bytes;
    talus_body *bodies;                   /* of each body of the scene */
    uint32_t *hull_offsets;               /* of each hull of the scene, in the geometry region */
    void *block_memory, *geometry_memory; /* as they were allocated */
} gltf_world;

/* Capacities are worked out of the scene: bodies and shapes as they are, joints as they are, 1024 contacts and 32 more
 * for each shape that moves (a box among boxes of its size, packed without order, overlaps the boxes around some 13
 * others), and room for an event of each sensor and mover. Returns GLTF_OK, or the error with the world empty; it is to
 * be freed in either case. */
gltf_status gltf_build(const gltf_scene *scene, const gltf_build_options *options, gltf_world *out, gltf_error *error);
/* Geometry `index` of the scene as the world has it: a hull by its offset in the region. */
talus_geometry gltf_placed_geometry(const gltf_scene *scene, const gltf_world *world, uint32_t index);
void gltf_world_free(gltf_world *world);

#endif
