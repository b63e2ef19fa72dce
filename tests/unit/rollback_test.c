/* Rings of snapshots, stepping twice, and deltas between snapshots. */
#include "world_kit.h"

enum { BOXES = 40, FRAMES = 200, LATE = 7 };

static talus_world yard(void) {
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    kit_floor(&world);
    for (int i = 0; i < BOXES; i++) {
        kit_box(&world, kit_vec(0.6f * (float)(i % 4), 0.6f + 1.1f * (float)(i / 4), 0.3f * (float)(i % 3)), 0.5f);
    }
    return world;
}

/* What the players do in a frame: a push of one box, by a rule that depends on the frame only. */
static void input(talus_world *world, uint32_t frame) {
    talus_body body = {2u + frame * 7u % BOXES, 1u};
    if (frame % 3u == 0) {
        (void)talus_body_apply_impulse(world, body, kit_vec(900.0f, 500.0f, 0.0f), kit_vec(0.0f, 1.0f, 0.2f));
    }
}

/* The input of every frame comes some frames late: the world is rolled back and steps again with it. In the end it is
 * the world that had all inputs in time. */
static void late_inputs_are_made_good(void **state) {
    (void)state;
    talus_world told = yard(), late = yard();
    talus_ring ring;
    size_t bytes = talus_ring_size(&late, LATE + 1u);
    void *memory = malloc(bytes);
    assert_non_null(memory);
    assert_int_equal(talus_ring_init(&ring, memory, bytes, LATE + 1u), TALUS_OK);
    uint64_t hash[FRAMES];
    for (uint32_t f = 0; f < FRAMES; f++) {
        input(&told, f);
        kit_steps(&told, 1);
        hash[f] = talus_world_hash(&told);
    }
    for (uint32_t f = 0; f < FRAMES + LATE; f++) {
        if (f >= LATE) { /* what was done in frame f - LATE is known now */
            assert_int_equal(talus_ring_restore(&ring, &late, f - LATE), TALUS_OK);
        }
        for (uint32_t g = f >= LATE ? f - LATE : f; g <= f; g++) {
            assert_int_equal(talus_ring_save(&ring, &late), TALUS_OK);
            if (g + LATE <= f) {
                input(&late, g);
            }
            kit_steps(&late, 1);
            if (g + LATE <= f) {
                assert_true(talus_world_hash(&late) == hash[g]);
            }
        }
    }
    free(memory);
    kit_end(&told);
    kit_end(&late);
}

static void the_oldest_go_first(void **state) {
    (void)state;
    talus_world world = yard();
    talus_ring ring;
    size_t most = talus_world_save_size(&world), table = 100u * 24u, bytes = table + 20u * most;
    void *memory = malloc(bytes);
    uint64_t oldest = 9, newest = 9;
    assert_int_equal(talus_ring_init(&ring, memory, bytes, 0), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_ring_init(&ring, (char *)memory + 4, bytes - 4u, 2), TALUS_UNALIGNED);
    assert_int_equal(talus_ring_init(&ring, memory, 24, 1), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_ring_init(&ring, memory, table + most / 2u, 100), TALUS_OK);
    assert_int_equal(talus_ring_save(&ring, &world), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_ring_init(&ring, memory, bytes, 100), TALUS_OK);
    assert_false(talus_ring_span(&ring, &oldest, &newest));
    assert_int_equal(talus_ring_restore(&ring, &world, 0), TALUS_BAD_ARGUMENT);
    uint64_t hash[150];
    uint32_t least = 1000, longest = 0;
    for (uint32_t f = 0; f < 150; f++) {
        hash[f] = talus_world_hash(&world);
        assert_int_equal(talus_ring_save(&ring, &world), TALUS_OK);
        assert_true(talus_ring_span(&ring, &oldest, &newest));
        assert_int_equal(newest, f);
        uint32_t held = (uint32_t)(newest - oldest) + 1u;
        least = f > 20 && held < least ? held : least, longest = held > longest ? held : longest;
        kit_steps(&world, 1);
    }
    assert_true(least >= 2 && longest < 100); /* it is the bytes that ran out */
    /* every one that is held is whole */
    for (uint64_t f = oldest; f <= newest; f++) {
        assert_int_equal(talus_ring_restore(&ring, &world, f), TALUS_OK);
        assert_true(talus_world_hash(&world) == hash[f]);
    }
    /* saving an earlier step drops the later ones */
    assert_int_equal(talus_ring_restore(&ring, &world, oldest + 1u), TALUS_OK);
    assert_int_equal(talus_ring_save(&ring, &world), TALUS_OK);
    uint64_t now;
    assert_true(talus_ring_span(&ring, &now, &newest));
    assert_true(now == oldest && newest == oldest + 1u);
    free(memory);
    kit_end(&world);
}

static void twice_is_the_same(void **state) {
    (void)state;
    talus_world once = yard(), twice = yard();
    size_t bytes = talus_world_save_size(&twice) * 4u;
    void *memory = malloc(bytes);
    int same = 0;
    assert_int_equal(talus_world_step_twice(&twice, 0.01f, memory, 16, &same), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_world_step_twice(&twice, 0.01f, memory, bytes, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_world_step_twice(&twice, -1.0f, memory, bytes, &same), TALUS_BAD_ARGUMENT);
    for (uint32_t f = 0; f < 100; f++) {
        input(&once, f);
        input(&twice, f);
        kit_steps(&once, 1);
        assert_int_equal(talus_world_step_twice(&twice, 1.0f / 60.0f, memory, bytes, &same), TALUS_OK);
        assert_true(same);
        assert_true(talus_world_hash(&once) == talus_world_hash(&twice));
    }
    free(memory);
    kit_end(&once);
    kit_end(&twice);
}

static unsigned char *saved(const talus_world *world, size_t *size) {
    size_t most = talus_world_save_size(world);
    unsigned char *snapshot = malloc(most);
    assert_non_null(snapshot);
    assert_int_equal(talus_world_save(world, snapshot, most, size), TALUS_OK);
    return snapshot;
}

/* Two restores without a step between them: what the first one made doubtful and the second one put to sleep is looked
 * at when it wakes. */
static void doubt_outlasts_another_restore(void **state) {
    (void)state;
    talus_world world = kit_void(), other = kit_void();
    talus_body body[2];
    size_t size[3];
    unsigned char *snapshot[3];
    for (int i = 0; i < 2; i++) { /* their boxes overlap, they do not */
        float at = i ? 0.52f : -0.52f;
        body[i] = kit_ball(&world, kit_vec(at, at, at), 0.5f);
    }
    kit_steps(&world, 1);
    snapshot[0] = saved(&world, &size[0]);
    for (int i = 0; i < 2; i++) {
        float at = i ? 0.27f : -0.27f;
        talus_pose pose = kit_pose(at, at, at);
        OK(talus_body_set_pose(&world, body[i], &pose));
    }
    snapshot[1] = saved(&world, &size[1]);
    OK(talus_body_sleep(&world, body[0]));
    OK(talus_body_sleep(&world, body[1]));
    snapshot[2] = saved(&world, &size[2]);
    OK(talus_world_restore(&world, snapshot[0], size[0]));
    kit_steps(&world, 1);
    OK(talus_world_restore(&world, snapshot[1], size[1]));
    OK(talus_world_restore(&world, snapshot[2], size[2]));
    OK(talus_world_restore(&other, snapshot[2], size[2]));
    for (int i = 0; i < 2; i++) {
        talus_world *w = i ? &other : &world;
        kit_steps(w, 1);
        OK(talus_body_wake(w, body[0]));
        OK(talus_body_wake(w, body[1]));
        kit_steps(w, 1);
        assert_int_equal(kit_counters(w).contacts.used, 1);
    }
    assert_true(talus_world_hash(&world) == talus_world_hash(&other));
    free(snapshot[0]), free(snapshot[1]), free(snapshot[2]);
    kit_end(&world);
    kit_end(&other);
}

/* Of falling boxes, of boxes at rest, of a world with things gone and come. */
static void deltas_give_the_snapshot_back(void **state) {
    (void)state;
    talus_world world = yard();
    size_t base_bytes, bytes, made, back;
    double sum[2] = {0, 0};
    for (uint32_t f = 0; f < 600; f += 10) {
        unsigned char *base = saved(&world, &base_bytes);
        if (f % 50 == 40) {
            talus_body body = {2u + f / 50u, 1u};
            assert_int_equal(talus_body_destroy(&world, body), TALUS_OK);
        }
        kit_steps(&world, 10);
        unsigned char *snapshot = saved(&world, &bytes);
        size_t most = talus_delta_most(bytes), scratch_bytes = talus_delta_scratch_size(base_bytes);
        unsigned char *delta = malloc(most), *again = malloc(bytes);
        void *scratch = malloc(scratch_bytes);
        assert_int_equal(
            talus_delta_make(base, base_bytes, snapshot, bytes, scratch, scratch_bytes, delta, most, &made), TALUS_OK);
        assert_int_equal(talus_delta_result_size(delta, made), bytes);
        assert_int_equal(talus_delta_apply(base, base_bytes, delta, made, again, bytes, &back), TALUS_OK);
        assert_int_equal(back, bytes);
        assert_memory_equal(again, snapshot, bytes);
        sum[f >= 400] += (double)made / (double)bytes;
        if (f == 300) { /* damage of any byte, any cut, another base: refused */
            for (size_t i = 0; i < made; i++) {
                delta[i] ^= 0x15u;
                assert_int_equal(talus_delta_apply(base, base_bytes, delta, made, again, bytes, &back),
                                 i >= 16 && i < 20 && talus_delta_result_size(delta, made) > bytes ? TALUS_SMALL_BLOCK
                                                                                                   : TALUS_BAD_BLOB);
                delta[i] ^= 0x15u;
                assert_int_equal(talus_delta_apply(base, base_bytes, delta, i, again, bytes, &back), TALUS_BAD_BLOB);
            }
            base[base_bytes / 2u] ^= 1u;
            assert_int_equal(talus_delta_apply(base, base_bytes, delta, made, again, bytes, &back), TALUS_BAD_BLOB);
            assert_int_equal(talus_delta_apply(base, base_bytes - 1u, delta, made, again, bytes, &back),
                             TALUS_BAD_BLOB);
            assert_int_equal(
                talus_delta_make(base, base_bytes, snapshot, bytes, scratch, scratch_bytes, delta, made / 2u, &made),
                TALUS_SMALL_BLOCK);
            assert_int_equal(
                talus_delta_make(base, base_bytes, snapshot, bytes, scratch, scratch_bytes - 1u, delta, most, &made),
                TALUS_FULL_SCRATCH);
        }
        free(base), free(snapshot), free(delta), free(again), free(scratch);
    }
    print_message("delta of ten steps: falling and settling %.2f, later %.2f of the snapshot\n", sum[0] / 40.0,
                  sum[1] / 20.0);
    assert_true(sum[1] / 20.0 < 0.5);
    kit_end(&world);
}

/* Bytes that have nothing to do with each other, and none at all. */
static void deltas_of_anything(void **state) {
    (void)state;
    static unsigned char base[5000], next[6000], delta[9000], again[6000];
    static uint32_t scratch[4096];
    uint32_t seed = 12345;
    print_message("seed %u\n", (unsigned)seed);
    for (int round = 0; round < 300; round++) {
        size_t nb = seed % sizeof base, nn = 1u + seed / 7u % (sizeof next - 1u), made, back;
        for (size_t i = 0; i < sizeof base; i++) {
            seed = seed * 1664525u + 1013904223u;
            base[i] = (unsigned char)(seed >> (round % 3 ? 30 : 20));
        }
        for (size_t i = 0; i < nn; i++) { /* pieces of the base among others */
            seed = seed * 1664525u + 1013904223u;
            next[i] = seed >> 28 || nb == 0 ? base[(i * 3u / 2u + (seed >> 31)) % sizeof base] : (unsigned char)seed;
        }
        assert_int_equal(talus_delta_make(base, nb, next, nn, scratch, sizeof scratch, delta, sizeof delta, &made),
                         TALUS_OK);
        assert_true(made <= talus_delta_most(nn));
        assert_int_equal(talus_delta_apply(base, nb, delta, made, again, sizeof again, &back), TALUS_OK);
        assert_true(back == nn && memcmp(again, next, nn) == 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(late_inputs_are_made_good),
        cmocka_unit_test(the_oldest_go_first),
        cmocka_unit_test(twice_is_the_same),
        cmocka_unit_test(doubt_outlasts_another_restore),
        cmocka_unit_test(deltas_give_the_snapshot_back),
        cmocka_unit_test(deltas_of_anything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
