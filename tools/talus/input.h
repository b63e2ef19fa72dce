/* What subcommands that run scenes take from the command line in the same way. */
#ifndef TALUS_TOOL_INPUT_H
#define TALUS_TOOL_INPUT_H

#include "gltf/scene.h"
#include "talus/world.h"

#define INPUT_MAX_STEPS 10000000u

/* A whole number in [low, high] out of an option; 0, and an error told, if it is none. */
int input_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *out);

/* A number in [low, high] of the unit that `what` names, as in "seconds". */
int input_number(const char *option, const char *text, const char *what, double low, double high, double *out);

/* An exit status, told already, or 0. */
int input_isa(const char *text, talus_isa *out);

/* Loads a scene by its path, or '@' and the name of one of the tool's own. An exit status, told already, or 0. */
int input_scene(const char *path, gltf_scene *scene);

/* The file's name without its folder and ending. */
void input_name(const char *path, char *out, size_t size);

#endif
