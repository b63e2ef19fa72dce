/* The block: how large, how aligned, that nothing outside of it is written, and that a copy of it is the same world. */
#define _DEFAULT_SOURCE /* mmap's MAP_ANONYMOUS */
#include "world_kit.h"

#include <sys/mman.h>
#include <unistd.h>

static void size_answers_the_definition(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t small = talus_world_size(&def);
    assert_true(small > 0 && small % TALUS_BLOCK_ALIGNMENT == 0);
    uint32_t *capacities[] = {&def.body_capacity, &def.shape_capacity, &def.joint_capacity, &def.contact_capacity,
                              &def.event_capacity};
    for (int i = 0; i < 5; i++) {
        uint32_t kept = *capacities[i];
        *capacities[i] = kept * 8u;
        assert_true(talus_world_size(&def) > small);
        *capacities[i] = 0;
        assert_true(talus_world_size(&def) == 0);
        *capacities[i] = TALUS_MAX_CAPACITY + 1u;
        assert_true(talus_world_size(&def) == 0);
        *capacities[i] = 1;
        assert_true(talus_world_size(&def) > 0);
        *capacities[i] = kept;
    }
    assert_true(talus_world_size(NULL) == 0);
    talus_world_def most = def;
    most.body_capacity = most.shape_capacity = most.joint_capacity = TALUS_MAX_CAPACITY;
    most.contact_capacity = most.event_capacity = TALUS_MAX_CAPACITY;
    /* Either it can be counted, or it is refused; never a small number that came round. */
    size_t large = talus_world_size(&most);
    assert_true(large == 0 || large > (size_t)TALUS_MAX_CAPACITY * 100u);
}

enum { FIELDS = 10 };
static void float_fields(talus_world_def *def, float *fields[FIELDS]) {
    float *all[FIELDS] = {&def->gravity.x,          &def->gravity.y,     &def->gravity.z, &def->push_speed,
                          &def->speculative_margin, &def->recycle_slack, &def->hit_speed, &def->sleep_speed,
                          &def->restitution_speed,  &def->sleep_time};
    memcpy(fields, all, sizeof all);
}

static void init_refuses_and_writes_nothing(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def);
    unsigned char *block = kit_alloc(size + 64u), *copy = malloc(size + 64u);
    assert_non_null(copy);
    memset(block, 0xa5, size + 64u);
    memcpy(copy, block, size + 64u);
    talus_world world, untouched;
    memset(&world, 0x5a, sizeof world);
    untouched = world;
#define NOT(status, call)                                                                                              \
    do {                                                                                                               \
        assert_int_equal((call), (status));                                                                            \
        assert_memory_equal(block, copy, size + 64u);                                                                  \
        assert_memory_equal(&world, &untouched, sizeof world);                                                         \
    } while (0)
    NOT(TALUS_BAD_ARGUMENT, talus_world_init(NULL, &def, block, size));
    NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, NULL, block, size));
    NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, &def, NULL, size));
    NOT(TALUS_SMALL_BLOCK, talus_world_init(&world, &def, block, size - 1u));
    NOT(TALUS_SMALL_BLOCK, talus_world_init(&world, &def, block, 0));
    for (size_t off = 1; off < TALUS_BLOCK_ALIGNMENT; off++) {
        NOT(TALUS_UNALIGNED, talus_world_init(&world, &def, block + off, size));
    }
    const float bad[3] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < FIELDS; k++) {
        for (int i = 0; i < 3; i++) {
            talus_world_def broken = def;
            float *fields[FIELDS];
            float_fields(&broken, fields);
            *fields[k] = bad[i];
            assert_true(talus_world_size(&broken) == 0);
            NOT(TALUS_NOT_FINITE, talus_world_init(&world, &broken, block, size));
        }
    }
    for (int k = 3; k < FIELDS; k++) { /* all but gravity are not negative */
        talus_world_def broken = def;
        float *fields[FIELDS];
        float_fields(&broken, fields);
        *fields[k] = -1.0f;
        NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, &broken, block, size));
    }
    uint32_t *counts[2] = {&def.substeps, &def.iterations};
    for (int k = 0; k < 2; k++) {
        uint32_t kept = *counts[k];
        *counts[k] = 0;
        NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, &def, block, size));
        *counts[k] = 65;
        NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, &def, block, size));
        *counts[k] = kept;
    }
    for (int isa = 0; isa < TALUS_ISA_COUNT; isa++) {
        if (!talus_isa_available((talus_isa)isa)) {
            def.isa = (talus_isa)isa;
            NOT(TALUS_NO_ISA, talus_world_init(&world, &def, block, size));
        }
    }
    def.isa = (talus_isa)77;
    NOT(TALUS_BAD_ARGUMENT, talus_world_init(&world, &def, block, size));
#undef NOT
    free(copy);
    kit_free(block);
}

static void what_was_in_the_memory_does_not_matter(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def), bytes;
    void *hull = kit_hull_region(&bytes);
    uint64_t hashes[2];
    for (int i = 0; i < 2; i++) {
        void *block = kit_alloc(size);
        talus_world world;
        memset(block, i ? 0xff : 0, size);
        OK(talus_world_init(&world, &def, block, size));
        kit_busy(&world, hull, bytes);
        kit_steps(&world, 90);
        hashes[i] = talus_world_hash(&world);
        kit_end(&world);
    }
    assert_true(hashes[0] == hashes[1]);
    kit_free(hull);
}

/* All that the API has a world written by. */
static void live(talus_world *world, const void *hull, size_t bytes) {
    kit_busy(world, hull, bytes);
    kit_steps(world, 60);
    talus_body first = {1, 1}, second = {2, 1};
    OK(talus_body_destroy(world, first));
    OK(talus_body_apply_force(world, second, kit_vec(0.0f, 900.0f, 0.0f), kit_vec(0.1f, 0.0f, 0.0f)));
    kit_steps(world, 30);
    while (1) { /* up to the brim */
        talus_body_def def = talus_body_def_default();
        talus_shape_def shape = kit_ball_def(0.3f);
        talus_body body;
        talus_shape handle;
        def.type = TALUS_DYNAMIC;
        def.pose.position = kit_vec(0.0f, 1.0f, 0.0f);
        if (talus_body_create(world, &def, &body) != TALUS_OK ||
            talus_shape_create(world, body, &shape, &handle) != TALUS_OK) {
            break;
        }
    }
    kit_steps(world, 60);
}

static void guarded(int at_end) {
    size_t page = (size_t)sysconf(_SC_PAGESIZE), bytes;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def), span = (size + page - 1u) / page * page;
    void *hull = kit_hull_region(&bytes);
    unsigned char *map = mmap(NULL, span + 2u * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(map != MAP_FAILED);
    assert_int_equal(mprotect(map, page, PROT_NONE), 0);
    assert_int_equal(mprotect(map + page + span, page, PROT_NONE), 0);
    talus_world world;
    OK(talus_world_init(&world, &def, map + page + (at_end ? span - size : 0), size));
    live(&world, hull, bytes);
    munmap(map, span + 2u * page);
    kit_free(hull);
}

static void nothing_is_touched_before_the_block(void **state) {
    (void)state;
    guarded(0);
}
static void nothing_is_touched_behind_the_block(void **state) {
    (void)state;
    guarded(1);
}

static void red_zones_stay_red(void **state) {
    (void)state;
    enum { ZONE = 4096 };
    talus_world_def def = kit_small();
    def.contact_capacity = 24, def.event_capacity = 3; /* too few on purpose */
    size_t size = talus_world_size(&def), bytes;
    void *hull = kit_hull_region(&bytes);
    unsigned char *kept = malloc(bytes), *memory = kit_alloc(size + 2u * ZONE);
    assert_non_null(kept);
    memcpy(kept, hull, bytes);
    memset(memory, 0xc3, size + 2u * ZONE);
    talus_world world;
    OK(talus_world_init(&world, &def, memory + ZONE, size));
    live(&world, hull, bytes);
    for (size_t i = 0; i < ZONE; i++) {
        assert_int_equal(memory[i], 0xc3);
        assert_int_equal(memory[ZONE + size + i], 0xc3);
    }
    assert_memory_equal(hull, kept, bytes); /* geometry is never written */
    free(kept);
    kit_free(memory);
    kit_free(hull);
}

static void a_copy_goes_on_bit_for_bit(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def), bytes;
    void *hull = kit_hull_region(&bytes), *hull2 = kit_alloc(bytes);
    memcpy(hull2, hull, bytes);
    for (int warm = 0; warm < 400; warm += 57) { /* in the air, in the heap, asleep */
        talus_world world = kit_world(&def), copy = world, again = world;
        kit_busy(&world, hull, bytes);
        kit_steps(&world, warm);
        unsigned char *memory = kit_alloc(2u * size + 64u);
        copy.block = memory + 64, again.block = memory + 64 + size;
        copy.geometry = hull2, copy.geometry_bytes = bytes;
        memcpy(copy.block, world.block, size);
        memcpy(again.block, world.block, size);
        again.geometry = hull, again.geometry_bytes = bytes;
        OK(talus_world_set_isa(&again, TALUS_ISA_SCALAR));
        for (int i = 0; i < 60; i++) {
            talus_parting where;
            kit_steps(&world, 1);
            kit_steps(&copy, 1);
            kit_steps(&again, 1);
            assert_int_equal(talus_world_part(&world, &copy, 0, &where), 0);
            assert_true(talus_world_hash(&world) == talus_world_hash(&copy));
            assert_int_equal(talus_world_part(&world, &again, 0, &where), 0);
            assert_true(talus_world_hash(&world) == talus_world_hash(&again));
        }
        kit_free(memory);
        kit_end(&world);
    }
    kit_free(hull2);
    kit_free(hull);
}

static void going_back_and_on_again_gives_the_same(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    size_t size = talus_world_size(&def), bytes;
    void *hull = kit_hull_region(&bytes), *kept = kit_alloc(size);
    talus_world world = kit_world(&def);
    kit_busy(&world, hull, bytes);
    kit_steps(&world, 40);
    uint64_t start = talus_world_hash(&world);
    memcpy(kept, world.block, size);
    talus_body pushed = {5, 1};
    uint64_t hashes[30];
    for (int pass = 0; pass < 2; pass++) {
        assert_true(talus_world_hash(&world) == start);
        for (int i = 0; i < 30; i++) {
            if (i == 10) {
                OK(talus_body_apply_impulse(&world, pushed, kit_vec(20.0f, 50.0f, 0.0f), kit_vec(0.0f, 1.0f, 0.0f)));
            }
            kit_steps(&world, 1);
            if (pass) {
                assert_true(hashes[i] == talus_world_hash(&world));
            }
            hashes[i] = talus_world_hash(&world);
        }
        memcpy(world.block, kept, size);
    }
    kit_free(kept);
    kit_end(&world);
    kit_free(hull);
}

static void the_hash_sees_a_bit(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def), other = kit_world(&def);
    talus_parting where;
    kit_box(&world, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    kit_box(&other, kit_vec(0.0f, 0.0f, 0.0f), 0.5f);
    assert_true(talus_world_hash(&world) == talus_world_hash(&other));
    assert_int_equal(talus_world_part(&world, &other, 0, &where), 0);
    talus_body body = {1, 1};
    OK(talus_body_set_velocity(&world, body, kit_vec(0.0f, 1.4e-45f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    assert_true(talus_world_hash(&world) != talus_world_hash(&other));
    assert_int_equal(talus_world_part(&world, &other, 0, &where), 1);
    assert_non_null(where.column.name);
    assert_int_equal(where.row, 1);
    assert_true(talus_world_hash(NULL) == 0);
    assert_int_equal(talus_world_part(NULL, &other, 0, &where), -1);
    def.body_capacity++;
    talus_world unlike = kit_world(&def);
    assert_int_equal(talus_world_part(&unlike, &other, 0, &where), -1);
    kit_end(&unlike);
    kit_end(&world);
    kit_end(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(size_answers_the_definition),
        cmocka_unit_test(init_refuses_and_writes_nothing),
        cmocka_unit_test(what_was_in_the_memory_does_not_matter),
        cmocka_unit_test(nothing_is_touched_before_the_block),
        cmocka_unit_test(nothing_is_touched_behind_the_block),
        cmocka_unit_test(red_zones_stay_red),
        cmocka_unit_test(a_copy_goes_on_bit_for_bit),
        cmocka_unit_test(going_back_and_on_again_gives_the_same),
        cmocka_unit_test(the_hash_sees_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
