/* What the steps of a run had no need of and so did not do, by the world's own counters. */
#ifndef TALUS_TOOL_SKIPPED_H
#define TALUS_TOOL_SKIPPED_H

#include "gltf/scene.h"
#include "gltf/text.h"
#include "talus/talus.h"

typedef enum skipped_part {
    SKIPPED_JOINTS,
    SKIPPED_LINKAGES,     /* joints that are solved at once */
    SKIPPED_RESTITUTION,  /* the sweeps over what bounces */
    SKIPPED_ROLLING,      /* resistance to rolling */
    SKIPPED_PUSHES,       /* the pass that takes overlaps and joints' errors back */
    SKIPPED_FAST,         /* contacts further ahead than the margin: nothing flew that far in a step */
    SKIPPED_KINEMATICS,   /* bodies that move as they are told to */
    SKIPPED_SENSORS,      /* what overlaps a sensor */
    SKIPPED_EVENTS,       /* to be told of */
    SKIPPED_REFIT,        /* boxes in the trees that something had left */
    SKIPPED_PAIRS,        /* shapes that came near one another */
    SKIPPED_CONTACTS,     /* contacts to solve: nothing awake touched */
    SKIPPED_SLEEP_SEARCH, /* the search for islands that may fall asleep */
    SKIPPED_COUNT
} skipped_part;

extern const char *const skipped_names[SKIPPED_COUNT]; /* as JSON has them */

typedef struct skipped {
    uint64_t steps, without[SKIPPED_COUNT]; /* steps that did without each */
    uint64_t body_steps;                    /* bodies that can move, a step each */
    uint64_t sleeping_body_steps;           /* of them, at rest */
    uint64_t static_body_steps;             /* bodies that cannot: skipped whole as well */
} skipped;

/* After a step in which the fastest body flew `flown` m; `margin` is the world's speculative margin. */
void skipped_take(skipped *s, const gltf_scene *scene, const talus_counters *counters, float flown, float margin);
/* Lines for people, and `"steps_without":{...},"not_needed":[...]`. */
void skipped_print(const skipped *s, gltf_text *out);
void skipped_json(const skipped *s, gltf_text *out);

#endif
