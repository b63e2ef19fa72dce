/* Records how bodies move and writes it as a GLB (glTF 2.0) that holds all that a viewer needs: a node for each body,
 * its shapes below it as meshes, and an animation. */
#ifndef TALUS_GLTF_ANIMATE_H
#define TALUS_GLTF_ANIMATE_H

#include "gltf/build.h"
#include "gltf/text.h"

typedef struct gltf_animation {
    const gltf_scene *scene;
    float *times;      /* s, of each frame */
    talus_pose *poses; /* of each body, frame after frame */
    uint32_t frame_count, time_room, pose_room;
    int failed; /* there was no memory */
} gltf_animation;

void gltf_animation_open(gltf_animation *animation, const gltf_scene *scene);
/* Adds a frame: the poses of all bodies of the scene. */
void gltf_animation_frame(gltf_animation *animation, double time, const talus_pose *poses);
/* The whole file into *out (a GLB may have at most 4 GiB). The world gives the hulls; only its geometry is looked at.
 */
gltf_status gltf_animation_encode(const gltf_animation *animation, const gltf_world *world, gltf_text *out,
                                  gltf_error *error);
void gltf_animation_free(gltf_animation *animation);

#endif
