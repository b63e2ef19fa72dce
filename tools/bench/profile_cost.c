/* What the profiler costs when it is on: of two scenes, two worlds each, one without clock and ring and one with both.
 * They take each step one right after the other, so that the machine's moods meet both. Whoever comes second finds
 * branches predicted and caches warm: two runs with the order turned round make a pair, and of a step the mean of both
 * ratios (their logarithms) counts. A pair gives the median over its steps, weighted by their times. Fails where the
 * median over the pairs is surely above a hundredth more. */
#include "host/clock.h"
#include "talus/compare.h"
#include "talus/figures.h"
#include "talus/talus.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PAIRS 12u
#define RUNS (2u * PAIRS)
#define LOW 2u /* the 3rd and the 10th of 12 have their median between them with 96 % (order statistics of a coin) */
#define HIGH 9u
#define MOST 1.01
#define SHIFTS 61u           /* places that blocks are put at: caches make some of them faster */
#define HUGE_PAGE (2u << 20) /* which of a block's pages are huge ones makes a tenth: both begin at one */

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

/* A world with its memory, which is to be freed; `place` shifts the block in it. */
static talus_world make(const scene *s, uint32_t place, int profiled, char **memory) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = s->bodies, def.shape_capacity = s->bodies + 1;
    def.contact_capacity = 32 * s->bodies;
    def.enable_sleep = 0;
    def.profile_capacity = profiled ? 64 : 0;
    size_t size = talus_world_size(&def);
    *memory = malloc(size + 2 * HUGE_PAGE);
    talus_world world;
    talus_shape floor_shape;
    talus_shape_def floor_def = talus_shape_def_default();
    floor_def.geometry.half.x = floor_def.geometry.half.z = 100.0f, floor_def.geometry.half.y = 1.0f;
    floor_def.pose.position.y = -1.0f;
    if (!*memory) {
        fail("there is no memory for the world");
    }
    char *block = *memory + (HUGE_PAGE - (uintptr_t)*memory % HUGE_PAGE) + place % SHIFTS * TALUS_BLOCK_ALIGNMENT;
    if (talus_world_init(&world, &def, block, size) != TALUS_OK ||
        talus_shape_create(&world, talus_world_ground(&world), &floor_def, &floor_shape) != TALUS_OK) {
        fail("the world could not be made");
    }
    s->fill(&world, s->bodies);
    return world;
}

static void run(const scene *s, uint32_t turn, double *ns[2]) {
    char *memory[2];
    talus_world world[2];
    const talus_clock clock = {now, NULL};
    for (uint32_t k = 0; k < 2; k++) { /* which of the two has which memory, and goes first, alternates */
        uint32_t on = (turn + k) & 1u;
        world[on] = make(s, turn * 37u + k * 23u, (int)on, &memory[on]);
    }
    for (uint32_t i = 0; i < s->steps; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t on = (turn + i + k) & 1u;
            uint64_t start = host_clock_ns();
            talus_world_step(&world[on], 1.0f / 60.0f, on ? &clock : NULL, NULL);
            ns[on][(size_t)turn * s->steps + i] = (double)(host_clock_ns() - start);
        }
    }
    free(memory[0]);
    free(memory[1]);
}

static int measure(const scene *s) {
    double *ns[2], sum[2] = {0, 0}, ratio[PAIRS];
    size_t count = (size_t)RUNS * s->steps;
    compare_weighted *steps = malloc(s->steps * sizeof *steps);
    ns[0] = malloc(2 * count * sizeof(double));
    if (!ns[0] || !steps) {
        fail("there is no memory for the times");
    }
    ns[1] = ns[0] + count;
    for (uint32_t turn = 0; turn < RUNS; turn++) {
        run(s, turn, ns);
    }
    for (uint32_t pair = 0; pair < PAIRS; pair++) {
        for (uint32_t i = 0; i < s->steps; i++) {
            size_t a = (size_t)2 * pair * s->steps + i, b = a + s->steps;
            steps[i].value = sqrt(ns[1][a] / ns[0][a] * (ns[1][b] / ns[0][b]));
            steps[i].weight = ns[0][a] + ns[0][b];
        }
        ratio[pair] = compare_median(steps, s->steps);
    }
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < s->steps; i++) {
            double least = ns[k][i];
            for (uint32_t turn = 1; turn < RUNS; turn++) {
                double t = ns[k][(size_t)turn * s->steps + i];
                least = t < least ? t : least;
            }
            sum[k] += least;
        }
    }
    free(ns[0]);
    free(steps);
    qsort(ratio, PAIRS, sizeof *ratio, figures_compare);
    printf("%-8s %4u bodies: %.4f ms a step without, %.4f with, the least of each; by turns %+.2f %% [%+.2f, %+.2f]\n",
           s->name, (unsigned)s->bodies, sum[0] * 1e-6 / s->steps, sum[1] * 1e-6 / s->steps,
           50 * (ratio[PAIRS / 2 - 1] + ratio[PAIRS / 2]) - 100, 100 * (ratio[LOW] - 1), 100 * (ratio[HIGH] - 1));
    return ratio[LOW] > MOST;
}

int main(void) {
    static const scene scenes[] = {{"pyramid", 210, 300, fill_pyramid}, {"pile", 1000, 300, fill_pile}};
    int bad = 0;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        bad |= measure(&scenes[i]);
    }
    return bad;
}
