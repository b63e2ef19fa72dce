/* What a snapshot costs: bytes a body, and the times of saving and of restoring beside that of a memcpy of as many
 * bytes, of a settled pile of boxes, asleep and kept awake. Saved into a ring, as netcode does; restored after as many
 * steps as a rollback takes. */
#include "host/clock.h"
#include "talus/talus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BODIES 1000u
#define SETTLING 1500u /* steps */
#define ROUNDS 400u
#define RING 32u
#define BACK 8u /* steps rolled back */

static void fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
}

static void must(talus_status status, const char *what) {
    if (status != TALUS_OK) {
        fprintf(stderr, "%s: %s\n", what, talus_status_text(status));
        exit(1);
    }
}

static void add_box(talus_world *world, talus_body_type type, const float *at, const float *half, const float *turn) {
    talus_body_def def = talus_body_def_default();
    talus_shape_def box = talus_shape_def_default();
    talus_body body;
    talus_shape shape;
    def.type = type;
    def.pose.position.x = at[0], def.pose.position.y = at[1], def.pose.position.z = at[2];
    def.pose.rotation.x = turn[0], def.pose.rotation.y = turn[1], def.pose.rotation.z = turn[2];
    box.geometry.half.x = half[0], box.geometry.half.y = half[1], box.geometry.half.z = half[2];
    must(talus_body_create(world, &def, &body), "a body");
    must(talus_shape_create(world, body, &box, &shape), "a shape");
}

/* Boxes of one metre, turned at random, fall between four walls. */
static void fill(talus_world *world) {
    static const float walls[5][6] = {{0, -1, 0, 20, 1, 20},
                                      {6.5f, 5, 0, 0.5f, 6, 7},
                                      {-6.5f, 5, 0, 0.5f, 6, 7},
                                      {0, 5, 6.5f, 7, 6, 0.5f},
                                      {0, 5, -6.5f, 7, 6, 0.5f}};
    const float straight[3] = {0, 0, 0}, half[3] = {0.5f, 0.5f, 0.5f};
    uint32_t seed = 1;
    for (int i = 0; i < 5; i++) {
        add_box(world, TALUS_STATIC, walls[i], walls[i] + 3, straight);
    }
    for (uint32_t i = 0; i < BODIES; i++) {
        const float at[3] = {(float)(i % 10u) * 1.2f - 5.4f, 1.0f + (float)(i / 100u) * 1.3f,
                             (float)(i / 10u % 10u) * 1.2f - 5.4f};
        float turn[3];
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            turn[k] = (float)(seed >> 8) / 16777216.0f - 0.5f;
        }
        add_box(world, TALUS_DYNAMIC, at, half, turn);
    }
}

/* What a compiler does not see through, which would leave out a copy that nobody reads. */
static void *(*volatile copy_bytes)(void *, const void *, size_t) = memcpy;

static int by_size(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static double median_us(uint64_t *ns) {
    qsort(ns, ROUNDS, sizeof *ns, by_size);
    return (double)ns[ROUNDS / 2u] * 1e-3;
}

static void step(talus_world *world, uint32_t count) {
    while (count-- > 0) {
        must(talus_world_step(world, 1.0f / 60.0f, NULL, NULL), "a step");
    }
}

static void measure(int sleep) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = def.shape_capacity = BODIES + 10u;
    def.contact_capacity = 6u * BODIES;
    def.enable_sleep = (uint8_t)sleep;
    size_t size = talus_world_size(&def);
    char *memory = malloc(size + TALUS_BLOCK_ALIGNMENT);
    talus_world world;
    if (!memory) {
        fail("there is no memory for the world");
    }
    must(talus_world_init(&world, &def, memory + TALUS_BLOCK_ALIGNMENT - (uintptr_t)memory % TALUS_BLOCK_ALIGNMENT,
                          size),
         "the world");
    fill(&world);
    step(&world, SETTLING);
    size_t most = 2u * talus_world_save_size(&world), bytes = 0;
    unsigned char *ring = malloc(RING * most), *copy = malloc(RING * most);
    if (!ring || !copy) {
        fail("there is no memory for snapshots");
    }
    memset(ring, 1, RING * most);
    memset(copy, 1, RING * most);
    static uint64_t save[ROUNDS], move[ROUNDS], restore[ROUNDS];
    for (uint32_t i = 0; i < ROUNDS; i++) {
        unsigned char *slot = ring + i % RING * most;
        uint64_t a = host_clock_ns();
        must(talus_world_save(&world, slot, most, &bytes), "saving");
        uint64_t b = host_clock_ns();
        copy_bytes(copy + i % RING * most, slot, bytes);
        uint64_t c = host_clock_ns();
        uint64_t hash = talus_world_hash(&world);
        step(&world, BACK);
        uint64_t d = host_clock_ns();
        must(talus_world_restore(&world, slot, bytes), "restoring");
        restore[i] = host_clock_ns() - d;
        if (talus_world_hash(&world) != hash) {
            fail("the restored world is another one");
        }
        save[i] = b - a, move[i] = c - b;
        step(&world, 1);
    }
    double m = median_us(move), s = median_us(save), r = median_us(restore);
    printf("%-6s %u boxes: %.0f bytes a body; save %.1f us, restore %.1f us, memcpy %.1f us: %.1f and %.1f times\n",
           sleep ? "asleep" : "awake", BODIES, (double)bytes / BODIES, s, r, m, s / m, r / m);
    free(ring), free(copy), free(memory);
}

int main(void) {
    measure(1);
    measure(0);
    return 0;
}
