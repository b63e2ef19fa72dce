/* What `talus profile` has of a scene: of each step the least time over several identical runs, and what it held. */
#ifndef TALUS_TOOL_TIMELINE_H
#define TALUS_TOOL_TIMELINE_H

#include "figures.h"
#include "gltf/build.h"
#include "gltf/text.h"

/* Something that can be run again and again from its beginning. Whatever fails is told, and its exit status returned.
 */
typedef struct profile_source {
    char name[256];
    uint32_t bodies, shapes, joints;
    uint32_t steps;
    float dt; /* s */
    void *inner;
    talus_world *world;                          /* of the run */
    int (*begin)(struct profile_source *source); /* the world as before its first step, with a ring of frames */
    int (*step)(struct profile_source *source, const talus_clock *clock);
    void (*end)(struct profile_source *source);
    /* What to call a body by its index in the world; in the buffer if it has no name of its own. */
    const char *(*name_of)(const struct profile_source *source, uint32_t body, char *buffer, size_t size);
    void (*close)(struct profile_source *source);
} profile_source;

/* A scene; `steps` UINT64_MAX: as many as it says. An exit status, told already, or 0. */
int profile_open_scene(profile_source *source, const char *path, const gltf_build_options *options, uint64_t steps);

/* A recording, up to `steps`. */
int profile_open_recording(profile_source *source, const char *path, talus_isa isa, uint64_t steps);

typedef struct timeline {
    char name[256];
    uint32_t bodies, shapes, joints, steps, runs, substeps, iterations;
    float dt;
    int sleep;
    talus_isa isa;
    uint64_t hash;       /* of the state after the last step */
    talus_frame *frames; /* times in ns: the least of each stage and of the whole; the islands of the fastest run */
    uint64_t *run_ns;    /* runs x steps */
    char **names;        /* of bodies by their index in the world */
    uint32_t name_count;
} timeline;

void timeline_free(timeline *t);

/* Runs the source `runs` times; `show` is called after each step and may be null. Fails where a run ends in another
 * state than the first. An exit status, told already, or 0. */
typedef void (*timeline_show)(const timeline *t, uint32_t run, uint32_t step, void *context);
int timeline_take(timeline *t, profile_source *source, uint32_t runs, timeline_show show, void *context);

const char *timeline_name(const timeline *t, uint32_t body);

/* --- figures --- */

/* What a frame counts. */
typedef struct timeline_count {
    const char *name;       /* in JSON and CSV */
    const char *many, *one; /* "manifolds computed", "manifold computed" */
    size_t offset;          /* of the uint32_t in talus_frame */
} timeline_count;
extern const timeline_count timeline_counts[];
extern const uint32_t timeline_count_count;
uint32_t timeline_counted(const talus_frame *frame, uint32_t count);

/* Milliseconds over all steps; stage TALUS_STAGE_COUNT is the whole step. Zeros if there is no memory. */
figures timeline_figures(const timeline *t, int stage);

/* A frame put together of the median of each time and each count: what the others are held against. */
void timeline_median(const timeline *t, talus_frame *out);

/* The steps that took longest, the longest first; returns how many. */
uint32_t timeline_worst(const timeline *t, uint32_t *steps, uint32_t most);
uint32_t timeline_over(const timeline *t, double budget_ms);

/* Why a step took what it took, against the median frame, as one line. */
void timeline_explain(const timeline *t, const talus_frame *median, uint32_t step, gltf_text *out);

/* --- writing --- */

#define TIMELINE_WORST 12u /* steps that are explained */

void timeline_print(const timeline *t, double budget_ms, gltf_text *out);
/* The bars of a run in progress: `lines` receives how many lines it has. */
void timeline_draw(const timeline *t, uint32_t run, uint32_t step, double budget_ms, gltf_text *out, uint32_t *lines);
void timeline_json(const timeline *t, double budget_ms, gltf_text *out);
void timeline_csv(const timeline *t, gltf_text *out);
void timeline_trace(const timeline *t, gltf_text *out);
void timeline_html(const timeline *t, double budget_ms, gltf_text *out);

#endif
