/* Scenes of the tool's own, made by code. The same text on every machine. */
#ifndef TALUS_TOOL_SCENES_H
#define TALUS_TOOL_SCENES_H

#include <stddef.h>

typedef struct scene_info {
    const char *name, *about;
} scene_info;

/* All of them; *count receives how many. */
const scene_info *scenes_list(size_t *count);

/* A scene as the text of a .gltf, freed by the caller; null if there is none of that name (*known is 0) or no memory.
 */
char *scenes_make(const char *name, size_t *size, int *known);

#endif
