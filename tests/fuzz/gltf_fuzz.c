/* libFuzzer: any bytes as a scene. Files that the scene names are not read. */
#include "gltf/scene.h"

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gltf_scene scene;
    gltf_error error;
    gltf_scene_load(&scene, data, size, NULL, &error);
    gltf_scene_free(&scene);
    return 0;
}
