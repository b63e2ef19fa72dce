/* A small scene that the tests of glTF start from. */
#ifndef TALUS_TEST_GLTF_BASE_H
#define TALUS_TEST_GLTF_BASE_H

#define RIGID "KHR_physics_rigid_bodies"

/* A ground, a ball with a pivot that is joined to a scaled rock, and a trigger; freed by the caller. */
char *gltf_base_text(void);
/* `text` with the first `from` in it replaced; freed by the caller. */
char *gltf_patched(const char *text, const char *from, const char *to);
/* The corners of a cube of edge 1 (m), as the scene has them. */
void gltf_base_cube(unsigned char out[96]);

#endif
