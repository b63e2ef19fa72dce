/* The profiler's ring: which frames it holds, what they say, and that the state knows nothing of it. */
#include "world_kit.h"

static talus_world ringed(uint32_t frames) {
    talus_world_def def = kit_small();
    def.profile_capacity = frames;
    return kit_world(&def);
}

static void *hull;
static size_t hull_bytes;

static int make_hull(void **state) {
    (void)state;
    hull = kit_hull_region(&hull_bytes);
    return 0;
}
static int free_hull(void **state) {
    (void)state;
    kit_free(hull);
    return 0;
}
static void busy(talus_world *world) { kit_busy(world, hull, hull_bytes); }

static talus_frame frame_of(const talus_world *world, uint32_t age) {
    talus_frame frame;
    OK(talus_world_get_frame(world, age, &frame));
    return frame;
}

/* A clock on which each reading is one tick after the last. */
static uint64_t count_up(void *context) { return ++*(uint64_t *)context; }

static void there_is_none_by_default(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    talus_frame frame;
    kit_steps(&world, 2);
    assert_int_equal(talus_world_frame_count(&world), 0);
    assert_int_equal(talus_world_get_frame(&world, 0, &frame), TALUS_BAD_ARGUMENT);
    size_t without = talus_world_size(&def);
    def.profile_capacity = 16;
    assert_true(talus_world_size(&def) >= without + 16 * sizeof frame);
    def.profile_capacity = TALUS_MAX_CAPACITY + 1;
    assert_int_equal(talus_world_size(&def), 0);
    kit_end(&world);
}

static void holds_the_last_ones(void **state) {
    (void)state;
    for (uint32_t capacity = 1; capacity <= 5; capacity++) {
        talus_world world = ringed(capacity);
        talus_world_def def;
        talus_frame frame;
        OK(talus_world_get_def(&world, &def));
        assert_int_equal(def.profile_capacity, capacity);
        busy(&world);
        for (uint32_t step = 1; step <= 12; step++) {
            kit_steps(&world, 1);
            uint32_t held = step < capacity ? step : capacity;
            assert_int_equal(talus_world_frame_count(&world), held);
            for (uint32_t age = 0; age < held; age++) {
                assert_int_equal(frame_of(&world, age).step, step - age);
            }
            assert_int_equal(talus_world_get_frame(&world, held, &frame), TALUS_BAD_ARGUMENT);
            OK(talus_world_validate(&world));
        }
        assert_int_equal(talus_world_get_frame(&world, 0, NULL), TALUS_BAD_ARGUMENT);
        kit_end(&world);
    }
}

static void has_the_times_of_the_clock(void **state) {
    (void)state;
    uint64_t ticks = 0;
    const talus_clock clock = {count_up, &ticks};
    talus_world world = ringed(4);
    busy(&world);
    for (int i = 0; i < 10; i++) {
        talus_profile profile;
        uint64_t before = ticks, sum = 0;
        OK(talus_world_step(&world, 1.0f / 60.0f, &clock, &profile));
        talus_frame frame = frame_of(&world, 0);
        assert_memory_equal(&frame.time, &profile, sizeof profile);
        for (int k = 0; k < TALUS_STAGE_COUNT; k++) {
            sum += profile.stage[k];
        }
        assert_true(sum == profile.total);
        assert_true(frame.profiler == 1);
        assert_true(profile.total + frame.profiler == ticks - before - 1);
        talus_counters counters = kit_counters(&world);
        assert_memory_equal(&frame.counters, &counters, sizeof counters);
    }
    /* the ring asks for the time even if the caller does not */
    OK(talus_world_step(&world, 1.0f / 60.0f, &clock, NULL));
    assert_true(frame_of(&world, 0).time.total > 0);
    kit_steps(&world, 1);
    talus_frame frame = frame_of(&world, 0);
    assert_true(frame.time.total == 0 && frame.profiler == 0 && frame.largest[0].ticks == 0);
    assert_true(frame.largest[0].bodies > 0);
    kit_end(&world);
}

static void the_state_knows_nothing_of_it(void **state) {
    (void)state;
    talus_world with = ringed(3), without = ringed(0);
    talus_parting difference;
    busy(&with);
    busy(&without);
    for (int i = 0; i < 60; i++) {
        kit_steps(&with, 1);
        kit_steps(&without, 1);
        assert_true(talus_world_hash(&with) == talus_world_hash(&without));
    }
    assert_int_equal(talus_world_part(&with, &without, 0, &difference), 0);
    size_t bytes = talus_world_save_size(&without);
    assert_int_equal(bytes, talus_world_save_size(&with));
    void *snapshot = kit_alloc(bytes);
    OK(talus_world_save(&without, snapshot, bytes, &bytes));
    uint64_t hash = talus_world_hash(&without);
    kit_steps(&with, 5);
    OK(talus_world_restore(&with, snapshot, bytes));
    assert_true(talus_world_hash(&with) == hash);
    assert_int_equal(talus_world_frame_count(&with), 3);
    assert_int_equal(frame_of(&with, 0).step, 65); /* what was run, and is run again */
    kit_steps(&with, 1);
    assert_int_equal(frame_of(&with, 0).step, 61);
    assert_int_equal(frame_of(&with, 1).step, 65);
    OK(talus_world_validate(&with));
    kit_free(snapshot);
    kit_end(&with);
    kit_end(&without);
}

static uint32_t bodies_of(const talus_frame *frame) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < frame->largest_count; i++) {
        sum += frame->largest[i].bodies;
    }
    return sum;
}

static void islands_are_those_that_are_tied(void **state) {
    (void)state;
    uint64_t ticks = 0;
    const talus_clock clock = {count_up, &ticks};
    talus_world_def def = kit_small();
    def.profile_capacity = 2, def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    kit_floor(&world);
    for (int i = 0; i < 5; i++) { /* a stack of five, one of three, two in the air, tied, and one alone */
        kit_box(&world, kit_vec(0.0f, 0.5f + (float)i, 0.0f), 0.5f);
    }
    for (int i = 0; i < 3; i++) {
        kit_box(&world, kit_vec(10.0f, 0.5f + (float)i, 0.0f), 0.5f);
    }
    talus_joint_def weld = talus_joint_def_default();
    talus_joint joint;
    talus_joint_make_ball(&weld);
    weld.a = kit_ball(&world, kit_vec(-10.0f, 100.0f, 0.0f), 0.5f);
    weld.b = kit_ball(&world, kit_vec(-12.0f, 100.0f, 0.0f), 0.5f);
    weld.frame_a = kit_pose(-1.0f, 0.0f, 0.0f), weld.frame_b = kit_pose(1.0f, 0.0f, 0.0f);
    OK(talus_joint_create(&world, &weld, &joint));
    kit_ball(&world, kit_vec(-20.0f, 100.0f, 0.0f), 0.5f);
    for (int i = 0; i < 20; i++) {
        OK(talus_world_step(&world, 1.0f / 60.0f, &clock, NULL));
    }
    talus_frame frame = frame_of(&world, 0);
    assert_int_equal(frame.islands, 4);
    assert_int_equal(frame.largest_count, 4);
    assert_int_equal(bodies_of(&frame), 11);
    const uint32_t bodies[4] = {5, 3, 2, 1}, contacts[4] = {5, 3, 0, 0}, joints[4] = {0, 0, 1, 0};
    const uint32_t held[4] = {2, 2, 1, 0};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(frame.largest[i].bodies, bodies[i]);
        assert_int_equal(frame.largest[i].contacts, contacts[i]);
        assert_int_equal(frame.largest[i].joints, joints[i]);
        talus_pose pose;
        OK(talus_body_get_pose(&world, frame.largest[i].body, &pose));
        assert_true(fabsf(pose.position.x) < 1.0f || i > 0);
        assert_int_equal(frame.largest[i].held, held[i]);
    }
    assert_int_equal(frame.largest[0].rows, 5 * 7);
    uint64_t shared = 0;
    for (int i = 0; i < 4; i++) {
        shared += frame.largest[i].ticks;
    }
    assert_true(shared > 0 && shared <= frame.time.total && frame.largest[0].ticks > frame.largest[1].ticks);

    /* what ties them goes: the count follows at once, or says how old it is */
    talus_joint_destroy(&world, joint);
    uint32_t asked = 0;
    do {
        OK(talus_world_step(&world, 1.0f / 60.0f, &clock, NULL));
        frame = frame_of(&world, 0);
    } while (frame.islands_age > 0 && asked++ < 10);
    assert_true(asked <= 3);
    assert_int_equal(frame.islands, 5);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_is_none_by_default),        cmocka_unit_test(holds_the_last_ones),
        cmocka_unit_test(has_the_times_of_the_clock),      cmocka_unit_test(the_state_knows_nothing_of_it),
        cmocka_unit_test(islands_are_those_that_are_tied),
    };
    return cmocka_run_group_tests(tests, make_hull, free_hull);
}
