/* The scenes whose bits are kept. Plain C: it runs wherever the library does. */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "talus/talus.h"

#include <string.h>

typedef struct golden_scene {
    const char *name;
    uint32_t steps;
    void (*build)(talus_world *world);
    void (*each)(talus_world *world, uint32_t step); /* before each step; may be null */
} golden_scene;

extern const golden_scene golden_scenes[];
extern const unsigned golden_scene_count;
extern const golden_scene golden_more_scenes[];
extern const unsigned golden_more_scene_count;

#define GOLDEN_HULLS 4u
/* Offsets of the hulls in the geometry region that every scene gets. */
extern uint32_t golden_hull[GOLDEN_HULLS];

/* Park and Miller's generator (CACM 31, 1988), and floats made of it by exact steps only. */
void golden_seed(uint32_t seed);
uint32_t golden_next(void);
float golden_range(float lower, float upper);

static inline uint64_t golden_fold(uint64_t hash, uint32_t word) {
    hash = (hash ^ word) * 0x100000001b3u;
    return hash ^ (hash >> 29);
}
static inline uint64_t golden_fold_float(uint64_t hash, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return golden_fold(hash, bits);
}

/* A hash of what so many rounds of random queries answer. */
uint64_t golden_queries(const talus_world *world, uint32_t rounds);

/* What every scene does; a status that is not TALUS_OK ends the program. */
void golden_check(talus_status status, const char *what);
talus_body golden_body(talus_world *world, talus_body_type type, talus_vec3 at);
talus_shape golden_box(talus_world *world, talus_body body, talus_vec3 half);
talus_shape golden_ball(talus_world *world, talus_body body, float radius);
talus_shape golden_shape(talus_world *world, talus_body body, const talus_shape_def *def);
talus_joint golden_joint(talus_world *world, const talus_joint_def *def);
void golden_floor(talus_world *world);
talus_vec3 golden_vec(float x, float y, float z);
talus_vec3 golden_any(talus_vec3 lower, talus_vec3 upper); /* a point of the box */
talus_vec3 golden_above(float half, float y);              /* a point of the square at that height */
talus_quat golden_turn(void);                              /* any rotation */

#endif
