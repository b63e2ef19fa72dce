/* What the parts of `talus bench features` share: the features, two scenes, and what came out. */
#ifndef TALUS_TOOL_BENCH_FEATURES_H
#define TALUS_TOOL_BENCH_FEATURES_H

#include "gltf/text.h"
#include "talus/talus.h"

#define FEATURES_MOST_ROWS 40
#define FEATURES_MOST 0.01 /* of a step, that a feature without work may add */

typedef struct feature_scene {
    const char *name;
    uint32_t bodies, steps;
    int (*fill)(talus_world *world, uint32_t bodies); /* 0, or -1 */
} feature_scene;

/* Something that a world may have and that has nothing to do: far away, asleep, unused. */
typedef struct feature {
    const char *name, *about;
    void (*set)(talus_world_def *def);              /* may be null */
    int (*add)(talus_world *world, uint32_t count); /* `count` of it; may be null; 0, or -1 */
    int timed;                                      /* steps are handed a clock */
} feature;

extern const feature features[];
extern const uint32_t feature_count;
extern const feature_scene feature_scenes[];
extern const uint32_t feature_scene_count;

/* A world with its memory, which is to be freed: the scene on its floor, with room for the feature, and the feature or
 * not. `place` shifts the block in its memory. 0, or -1. */
int feature_make(const feature_scene *scene, const feature *f, int with, uint32_t place, talus_world *world,
                 void **memory);

typedef struct feature_row {
    const feature *feature;
    const feature_scene *scene;
    double without, with;    /* ms a step: the steps' least times */
    double ratio, low, high; /* by turns: the median of the pairs of runs, and what holds it with 96 % */
    int over;                /* it is surely above FEATURES_MOST */
} feature_row;

typedef struct feature_table {
    feature_row rows[FEATURES_MOST_ROWS];
    uint32_t count, pairs;
    int over; /* rows that are */
} feature_table;

/* Of all features where none is named. 0, or an exit status with its message told. Says on the standard error how far
 * it is where `watched`. */
int features_take(feature_table *table, const char *const *names, uint32_t name_count, int quick, int watched);
void features_print(const feature_table *table, gltf_text *out);
void features_json(const feature_table *table, gltf_text *out);

#endif
