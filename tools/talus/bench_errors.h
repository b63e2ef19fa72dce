/* What error the bodies of a run hold, measured from their poses and velocities in double precision: nothing of it is
 * asked of the solver. Metres. */
#ifndef TALUS_TOOL_BENCH_ERRORS_H
#define TALUS_TOOL_BENCH_ERRORS_H

#include "gltf/build.h"
#include "gltf/transform.h"
#include "talus/query.h"

typedef enum bench_error {
    BENCH_OVERLAP_P99,  /* of all pairs of shapes that overlap in the steps looked at: how deep */
    BENCH_OVERLAP_MOST, /* the deepest of them */
    BENCH_APART,        /* the ends of joints from one another along locked axes: the furthest after any step */
    BENCH_DRIFT,        /* how far the furthest body is from where it was put */
    BENCH_GAINED,       /* mechanical energy above the least so far: the height that it would lift all bodies by */
    BENCH_ERROR_COUNT
} bench_error;

/* Watches one run of a scene. */
typedef struct bench_judge {
    const gltf_scene *scene;
    const gltf_world *world;
    talus_convex *convexes; /* of each collider */
    double *reaches;        /* from its origin to its furthest point */
    struct bench_place *places;
    struct bench_part *parts; /* of each body: mass and where it was put */
    double *depths;           /* of every overlap seen */
    size_t depth_count, depth_room;
    double apart, drift, least_energy, gained; /* energy in J */
    double weight;                             /* N, of all bodies together */
    int passive;                               /* nothing moves by itself: no motor, no kinematic body */
} bench_judge;

/* 0, or -1 for a lack of memory; to be closed in either case. Looks at the bodies where they stand. */
int bench_judge_open(bench_judge *judge, const gltf_scene *scene, const gltf_world *world);
/* After a step; at `overlaps` too. 0, or -1 for a lack of memory or where a body's state is not finite. O(bodies +
 * joints), and with overlaps a proven depth for each pair whose boxes meet. */
int bench_judge_step(bench_judge *judge, int overlaps);
/* Those that the scene cannot have, such as joints apart without joints, are negative. Sorts the depths. */
void bench_judge_errors(bench_judge *judge, double errors[BENCH_ERROR_COUNT]);
void bench_judge_close(bench_judge *judge);

#endif
