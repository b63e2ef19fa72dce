/* The core asks nobody for memory: the linker puts counters in place of malloc and its kin. */
#include "world_kit.h"

void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
void *__wrap_realloc(void *old, size_t bytes);
void __wrap_free(void *p);
void *__real_malloc(size_t bytes);
void *__real_calloc(size_t count, size_t bytes);
void *__real_realloc(void *old, size_t bytes);
void __real_free(void *p);

static volatile unsigned long calls; /* volatile: to the compiler malloc changes nothing that a program can see */

void *__wrap_malloc(size_t bytes) {
    calls++;
    return __real_malloc(bytes);
}
void *__wrap_calloc(size_t count, size_t bytes) {
    calls++;
    return __real_calloc(count, bytes);
}
void *__wrap_realloc(void *old, size_t bytes) {
    calls++;
    return __real_realloc(old, bytes);
}
void __wrap_free(void *p) {
    calls++;
    __real_free(p);
}

static void the_counters_count(void **state) {
    (void)state;
    unsigned long before = calls;
    void *volatile p = malloc(10);
    free(p);
    assert_true(calls == before + 2u);
}

static void no_call_in_a_whole_life(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def), bytes;
    void *hull = kit_hull_region(&bytes), *block = kit_alloc(size), *copy = kit_alloc(size);
    talus_world world;
    unsigned long before = calls;
    OK(talus_world_init(&world, &def, block, size));
    kit_busy(&world, hull, bytes);
    for (int isa = 0; isa < TALUS_ISA_COUNT; isa++) {
        if (talus_isa_available((talus_isa)isa)) {
            OK(talus_world_set_isa(&world, (talus_isa)isa));
            kit_steps(&world, 100);
        }
    }
    memcpy(copy, block, size);
    talus_counters counters = kit_counters(&world);
    talus_events events = kit_events(&world);
    assert_true(counters.steps > 0 && events.dropped == 0);
    assert_true(talus_world_hash(&world) != 0);
    for (uint32_t i = 1; i < 19; i++) {
        talus_body body = {i, 1};
        OK(talus_body_destroy(&world, body));
    }
    kit_steps(&world, 10);
    assert_true(calls == before);
    kit_free(copy);
    kit_free(block);
    kit_free(hull);
}

static void no_call_in_the_hull_builder(void **state) {
    (void)state;
    size_t scratch_size = talus_hull_scratch_size(100), room = talus_hull_max_size(100), bytes;
    void *scratch = kit_alloc(scratch_size), *out = kit_alloc(room);
    talus_vec3 points[100];
    for (int i = 0; i < 100; i++) {
        points[i] = kit_vec((float)(i % 7), (float)(i % 11), (float)(i % 13));
    }
    unsigned long before = calls;
    OK(talus_hull_build(points, 100, scratch, scratch_size, out, room, &bytes));
    OK(talus_hull_validate(out, bytes));
    assert_true(calls == before);
    kit_free(scratch);
    kit_free(out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_counters_count),
        cmocka_unit_test(no_call_in_a_whole_life),
        cmocka_unit_test(no_call_in_the_hull_builder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
