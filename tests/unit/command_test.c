/* Commands as records: the bytes, what is taken of any bytes, and what a log holds. */
#include "world_kit.h"

static uint32_t seed = 20261107u;
static uint32_t draw(void) {
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/* Each kind with random members comes back to the bit, and is written as the same bytes again. */
static void comes_back(void **state) {
    (void)state;
    print_message("seed %u\n", seed);
    for (int round = 0; round < 200; round++) {
        for (int kind = 0; kind < TALUS_COMMAND_COUNT; kind++) {
            unsigned char bytes[TALUS_COMMAND_MAX_BYTES], again[TALUS_COMMAND_MAX_BYTES];
            talus_command c, d;
            for (size_t i = 0; i < sizeof c; i++) {
                ((unsigned char *)&c)[i] = (unsigned char)draw();
            }
            c.kind = (talus_command_kind)kind;
            size_t size = talus_command_encode(&c, bytes, sizeof bytes);
            assert_true(size >= 4u && size <= sizeof bytes && size % 4u == 0);
            assert_int_equal(talus_command_decode(&d, bytes, size), size);
            assert_int_equal(d.kind, kind);
            assert_int_equal(talus_command_encode(&d, again, sizeof again), size);
            assert_memory_equal(bytes, again, size);
            assert_int_equal(talus_command_encode(&c, again, size - 1u), 0);
            for (size_t cut = 0; cut < size; cut++) {
                assert_int_equal(talus_command_decode(&d, bytes, cut), 0);
            }
        }
    }
}

/* The members that matter, one by one, after a round trip. */
static void members_are_theirs(void **state) {
    (void)state;
    unsigned char bytes[TALUS_COMMAND_MAX_BYTES];
    talus_command c, d;
    memset(&c, 0, sizeof c);
    c.kind = TALUS_COMMAND_SHAPE_CREATE;
    c.index = 3, c.generation = 4;
    c.as.shape.body.index = 7, c.as.shape.body.generation = 8;
    c.as.shape.def = talus_shape_def_default();
    c.as.shape.def.filter.category = 0x1122334455667788u;
    c.as.shape.def.sensor = 1;
    c.as.shape.def.user_data = 0x99aabbccddeeff00u;
    size_t size = talus_command_encode(&c, bytes, sizeof bytes);
    assert_int_equal(talus_command_decode(&d, bytes, size), size);
    assert_memory_equal(&c.as.shape.def.geometry, &d.as.shape.def.geometry, sizeof c.as.shape.def.geometry);
    assert_memory_equal(&c.as.shape.def.material, &d.as.shape.def.material, sizeof c.as.shape.def.material);
    assert_true(d.as.shape.def.filter.category == c.as.shape.def.filter.category);
    assert_true(d.as.shape.def.filter.mask == ~(uint64_t)0 && d.as.shape.def.user_data == c.as.shape.def.user_data);
    assert_true(d.as.shape.body.index == 7 && d.as.shape.body.generation == 8 && d.index == 3 && d.generation == 4);
    assert_true(d.as.shape.def.sensor == 1 && d.as.shape.def.events == 0);
}

/* The same bytes on every machine, whatever its byte order. */
static void bytes_are_these(void **state) {
    (void)state;
    unsigned char bytes[64];
    talus_command c;
    memset(&c, 0, sizeof c);
    c.kind = TALUS_COMMAND_BODY_SET_DAMPING;
    c.index = 0x01020304u, c.generation = 5;
    c.as.damping.linear = 1.0f, c.as.damping.angular = -2.5f;
    const unsigned char want[20] = {14, 4, 0, 0, 4, 3, 2, 1, 5, 0, 0, 0, 0, 0, 0x80, 0x3f, 0, 0, 0x20, 0xc0};
    assert_int_equal(talus_command_encode(&c, bytes, sizeof bytes), sizeof want);
    assert_memory_equal(bytes, want, sizeof want);
    c.kind = TALUS_COMMAND_SHAPE_SET_FILTER;
    c.as.filter.category = 0x0102030405060708u, c.as.filter.mask = 1, c.as.filter.group = -2;
    const unsigned char filter[32] = {22, 7, 0, 0, 4, 3, 2, 1, 5, 0, 0, 0, 8,    7,    6,    5,
                                      4,  3, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0xfe, 0xff, 0xff, 0xff};
    assert_int_equal(talus_command_encode(&c, bytes, sizeof bytes), sizeof filter);
    assert_memory_equal(bytes, filter, sizeof filter);
    assert_string_equal(talus_command_name(c.kind), "shape_set_filter");
    assert_string_equal(talus_command_name(TALUS_COMMAND_COUNT), "no such command");
}

static void strange_bytes_are_refused(void **state) {
    (void)state;
    unsigned char bytes[TALUS_COMMAND_MAX_BYTES];
    talus_command c;
    memset(&c, 0, sizeof c);
    c.kind = TALUS_COMMAND_BODY_CREATE;
    size_t size = talus_command_encode(&c, bytes, sizeof bytes);
    bytes[0] = TALUS_COMMAND_COUNT;
    assert_int_equal(talus_command_decode(&c, bytes, size), 0);
    bytes[0] = TALUS_COMMAND_BODY_CREATE;
    bytes[1]++; /* another number of words */
    assert_int_equal(talus_command_decode(&c, bytes, size), 0);
    bytes[1]--;
    bytes[4 * (3 + 19) + 1] = 1; /* a byte beyond 255: can_sleep */
    bytes[4 * (3 + 18) + 1] = 1;
    assert_int_equal(talus_command_decode(&c, bytes, size), 0);
    assert_int_equal(talus_command_decode(&c, NULL, size), 0);
    assert_int_equal(talus_command_decode(NULL, bytes, size), 0);
    assert_int_equal(talus_command_encode(NULL, bytes, size), 0);
    c.kind = TALUS_COMMAND_COUNT;
    assert_int_equal(talus_command_encode(&c, bytes, size), 0);
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_apply(&world, &c));
    REFUSED(&world, TALUS_BAD_ARGUMENT, talus_world_apply(&world, NULL));
    assert_int_equal(talus_world_apply(NULL, &c), TALUS_BAD_ARGUMENT);
    kit_end(&world);
}

/* The log takes what was done and not what was refused; what does not fit is counted and the world goes on. */
static void log_takes_what_was_done(void **state) {
    (void)state;
    unsigned char memory[300];
    talus_log log = {memory, sizeof memory, 0, 0, 0, 0, 0};
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def);
    world.log = &log;
    talus_body body = kit_body(&world, TALUS_DYNAMIC, kit_vec(1.0f, 2.0f, 3.0f));
    assert_int_equal(talus_body_set_locks(&world, body, 64), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_world_step(&world, 0.0f, NULL, NULL), TALUS_BAD_ARGUMENT);
    OK(talus_body_set_locks(&world, body, 5));
    OK(talus_world_step(&world, 0.25f, NULL, NULL));
    assert_int_equal(log.steps, 1);
    assert_int_equal(log.others, 2);
    size_t at = 0;
    talus_command c;
    at += talus_command_decode(&c, memory, log.used);
    assert_true(c.kind == TALUS_COMMAND_BODY_CREATE && c.index == body.index && c.generation == body.generation);
    assert_true(c.as.body.pose.position.y == 2.0f && c.as.body.type == TALUS_DYNAMIC);
    at += talus_command_decode(&c, memory + at, log.used - at);
    assert_true(c.kind == TALUS_COMMAND_BODY_SET_LOCKS && c.index == body.index && c.as.locks == 5);
    at += talus_command_decode(&c, memory + at, log.used - at);
    assert_true(c.kind == TALUS_COMMAND_WORLD_STEP && c.as.step.dt == 0.25f && c.as.step.clock == NULL);
    assert_int_equal(at, log.used);
    assert_int_equal(log.lost, 0);
    for (int i = 0; i < 20; i++) {
        OK(talus_body_apply_impulse(&world, body, kit_vec(1, 0, 0), kit_vec(0, 0, 0)));
    }
    assert_true(log.lost > 10 && log.used <= sizeof memory && kit_velocity(&world, body).x != 0.0f);
    kit_end(&world);
}

/* A flip changes one bit, twice is nothing, and none that would make the state unsound is taken. */
static void flips_one_bit(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world a = kit_world(&def), b = kit_world(&def);
    size_t bytes;
    void *hull = kit_hull_region(&bytes);
    kit_busy(&a, hull, bytes);
    kit_busy(&b, hull, bytes);
    kit_steps(&a, 50);
    kit_steps(&b, 50);
    talus_parting parting;
    assert_int_equal(talus_world_part(&a, &b, 0, &parting), 0);
    uint32_t taken = 0, refused = 0;
    for (uint32_t round = 0; round < 3000; round++) {
        talus_column column;
        talus_command c;
        c.kind = TALUS_COMMAND_WORLD_FLIP;
        c.as.flip.column = draw() % talus_column_count();
        OK(talus_column_get(c.as.flip.column, &column));
        uint32_t rows = talus_column_rows(&a, c.as.flip.column);
        c.as.flip.row = rows ? draw() % rows : 0, c.as.flip.bit = draw() % (8u * column.row_bytes);
        uint64_t before = talus_world_hash(&b);
        if (talus_world_apply(&b, &c) != TALUS_OK) {
            assert_true(talus_world_hash(&b) == before);
            refused++;
            continue;
        }
        taken++;
        OK(talus_world_validate(&b));
        assert_int_equal(talus_world_part(&a, &b, 0, &parting), 1);
        if (c.as.flip.column == 1) { /* the counts: rows come into use or go out of it with them */
            OK(talus_world_apply(&b, &c));
            continue;
        }
        assert_string_equal(parting.column.name, column.name);
        assert_int_equal(parting.row, c.as.flip.row);
        assert_int_equal(parting.word, c.as.flip.bit / (8u * column.word_bytes));
        assert_true((parting.value[0] ^ parting.value[1]) == (uint64_t)1 << c.as.flip.bit % (8u * column.word_bytes));
        assert_int_equal(parting.columns, 1);
        OK(talus_world_apply(&b, &c));
        assert_true(talus_world_hash(&b) == before);
    }
    assert_true(taken > 1000 && refused > 100);
    talus_column none;
    assert_int_equal(talus_column_get(talus_column_count(), &none), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_column_rows(&a, talus_column_count()), 0);
    kit_end(&a);
    kit_end(&b);
    kit_free(hull);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comes_back),
        cmocka_unit_test(members_are_theirs),
        cmocka_unit_test(bytes_are_these),
        cmocka_unit_test(strange_bytes_are_refused),
        cmocka_unit_test(log_takes_what_was_done),
        cmocka_unit_test(flips_one_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
