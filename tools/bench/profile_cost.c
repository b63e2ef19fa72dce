/* What the profiler costs when it is on: two scenes, each run by turns without clock and ring and with both, held
 * against each other as `talus profile --compare` does it. Fails where it surely costs more than a hundredth. */
#include "host/clock.h"
#include "talus/compare.h"
#include "talus/talus.h"

#include <stdio.h>
#include <stdlib.h>

#define RUNS 25u /* of each */
#define MOST 1.01
#define SHIFTS 61u /* places that blocks are put at: caches make some of them faster */

typedef struct scene {
    const char *name;
    uint32_t bodies, steps;
    void (*fill)(talus_world *world, uint32_t bodies);
} scene;

static uint64_t now(void *context) {
    (void)context;
    return host_clock_ns();
}

static void add_box(talus_world *world, float x, float y, float z, float half) {
    talus_body_def def = talus_body_def_default();
    talus_shape_def box = talus_shape_def_default();
    talus_body body;
    talus_shape shape;
    def.type = TALUS_DYNAMIC;
    def.pose.position.x = x, def.pose.position.y = y, def.pose.position.z = z;
    box.geometry.half.x = box.geometry.half.y = box.geometry.half.z = half;
    if (talus_body_create(world, &def, &body) != TALUS_OK ||
        talus_shape_create(world, body, &box, &shape) != TALUS_OK) {
        fprintf(stderr, "a body did not fit\n");
        exit(1);
    }
}

static void fill_pyramid(talus_world *world, uint32_t bodies) {
    uint32_t left = bodies;
    for (uint32_t row = 0, width = 20; width > 0 && left > 0; row++, width--) {
        for (uint32_t i = 0; i < width && left > 0; i++, left--) {
            add_box(world, (float)i - 0.5f * (float)width, 0.5f + (float)row, 0.0f, 0.495f);
        }
    }
}

static void fill_pile(talus_world *world, uint32_t bodies) {
    for (uint32_t i = 0; i < bodies; i++) {
        float turn = 0.13f * (float)(i % 7);
        add_box(world, (float)(i % 8) + turn, 1.0f + 1.2f * (float)(i / 64), (float)(i / 8 % 8) - turn, 0.5f);
    }
}

static void fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
}

static void run(const scene *s, uint32_t turn, int profiled, double *ns) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = s->bodies, def.shape_capacity = s->bodies + 1;
    def.contact_capacity = 32 * s->bodies;
    def.enable_sleep = 0;
    def.profile_capacity = profiled ? 64 : 0;
    size_t size = talus_world_size(&def);
    char *memory = malloc(size + (1 + SHIFTS) * TALUS_BLOCK_ALIGNMENT);
    talus_world world;
    talus_shape floor_shape;
    talus_shape_def floor_def = talus_shape_def_default();
    floor_def.geometry.half.x = floor_def.geometry.half.z = 100.0f, floor_def.geometry.half.y = 1.0f;
    floor_def.pose.position.y = -1.0f;
    if (!memory) {
        fail("there is no memory for the world");
    }
    char *block = memory + (TALUS_BLOCK_ALIGNMENT - (uintptr_t)memory % TALUS_BLOCK_ALIGNMENT) +
                  turn * 37u % SHIFTS * TALUS_BLOCK_ALIGNMENT;
    if (talus_world_init(&world, &def, block, size) != TALUS_OK ||
        talus_shape_create(&world, talus_world_ground(&world), &floor_def, &floor_shape) != TALUS_OK) {
        fail("the world could not be made");
    }
    s->fill(&world, s->bodies);
    const talus_clock clock = {now, NULL};
    for (uint32_t i = 0; i < s->steps; i++) {
        uint64_t start = host_clock_ns();
        talus_world_step(&world, 1.0f / 60.0f, profiled ? &clock : NULL, NULL);
        ns[i] = (double)(host_clock_ns() - start);
    }
    free(memory);
}

static int measure(const scene *s) {
    double *ns[2], sum[2] = {0, 0};
    compare_result r;
    for (int on = 0; on < 2; on++) {
        ns[on] = malloc((size_t)RUNS * s->steps * sizeof(double));
        if (!ns[on]) {
            fail("there is no memory for the times");
        }
    }
    for (uint32_t turn = 0; turn < RUNS; turn++) {
        for (uint32_t k = 0; k < 2; k++) { /* which of the two goes first alternates as well */
            uint32_t on = (turn + k) & 1u;
            run(s, turn, (int)on, ns[on] + (size_t)turn * s->steps);
        }
    }
    if (!compare_runs(ns[0], RUNS, ns[1], RUNS, s->steps, &r)) {
        fail("there is no memory to compare");
    }
    for (int on = 0; on < 2; on++) {
        for (uint32_t i = 0; i < s->steps; i++) {
            double least = ns[on][i];
            for (uint32_t turn = 1; turn < RUNS; turn++) {
                double t = ns[on][(size_t)turn * s->steps + i];
                least = t < least ? t : least;
            }
            sum[on] += least;
        }
        free(ns[on]);
    }
    printf("%-8s %4u bodies: %.4f ms a step without, %.4f with: %+.2f %% [%+.2f, %+.2f]\n", s->name,
           (unsigned)s->bodies, sum[0] * 1e-6 / s->steps, sum[1] * 1e-6 / s->steps, 100 * (r.ratio - 1),
           100 * (r.low - 1), 100 * (r.high - 1));
    return r.low > MOST;
}

int main(void) {
    static const scene scenes[] = {{"pyramid", 210, 300, fill_pyramid}, {"pile", 1000, 300, fill_pile}};
    int bad = 0;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        bad |= measure(&scenes[i]);
    }
    return bad;
}
