/* Triangles to draw a geometry with. */
#ifndef TALUS_GLTF_MESH_H
#define TALUS_GLTF_MESH_H

#include "talus/shape.h"

/* Counter-clockwise from outside; each vertex has a normal of its own. */
typedef struct gltf_mesh {
    talus_vec3 *positions, *normals;
    uint32_t *indices;
    uint32_t vertex_count, index_count;
    uint32_t vertex_room, normal_room, index_room;
    int failed; /* there was no memory */
} gltf_mesh;

/* The mesh of a geometry; `hull` is the blob of a hull, null otherwise. Freed by gltf_mesh_free in any case. */
void gltf_mesh_make(gltf_mesh *mesh, const talus_geometry *geometry, const talus_hull *hull);
void gltf_mesh_free(gltf_mesh *mesh);

#endif
