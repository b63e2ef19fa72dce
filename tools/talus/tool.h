/* What the parts of the tool share. */
#ifndef TALUS_TOOL_TOOL_H
#define TALUS_TOOL_TOOL_H

#include "gltf/error.h"
#include "gltf/text.h"

/* Besides those of gltf_status. */
#define TOOL_USAGE 2
#define TOOL_SLOW 7     /* it was done, and took longer than asked for */
#define TOOL_DIVERGED 5 /* two runs part */
#define TOOL_SHORTER 6  /* they are the same as far as the shorter one goes */

/* "talus: " and a line on the standard error; returns `status`. */
int tool_fail(int status, const char *format, ...) GLTF_PRINTF(2, 3);

/* Writes a text to a file, "-" being the standard output, and frees it. An exit status. */
int tool_write_text(const char *path, gltf_text *text);

/* Subcommands: their arguments without the tool's name, the subcommand's name first. */
int tool_run(int count, char **arguments);
int tool_profile(int count, char **arguments);
int tool_scene(int count, char **arguments);
int tool_record(int count, char **arguments);
int tool_replay(int count, char **arguments);
int tool_diff(int count, char **arguments);
int tool_bench(int count, char **arguments);

/* Says whether the profile saved in B is slower than that in A, on the standard output: TOOL_SLOW then. An exit status.
 */
int profile_compare(const char *path_a, const char *path_b);

/* The manual page of a subcommand, or of the tool if it is null; 0 if there is none. */
int tool_print_manual(const char *subcommand);

#endif
