/* The hash of words, of the state, and the first difference of two states. */
#include "stage/store/hash.h"
#include "store_check.h"

/* The words' values count, not the order of their bytes: a reference that takes numbers. */
static uint64_t mixed(uint64_t stream, uint64_t word) {
    stream = (stream ^ word) * 0x100000001b3u;
    return stream ^ (stream >> 32);
}
static uint64_t reference(const uint32_t *words, size_t count, const uint64_t *longs, size_t long_count) {
    uint64_t s[4], h = 0xcbf29ce484222325u;
    for (unsigned k = 0; k < 4; k++) {
        s[k] = h + k;
    }
    for (size_t i = 0; i < count; i++) {
        s[i % 4] = mixed(s[i % 4], words[i]);
    }
    for (size_t i = 0; i < long_count; i++) {
        s[i % 4] = mixed(mixed(s[i % 4], (uint32_t)longs[i]), longs[i] >> 32);
    }
    for (unsigned k = 0; k < 4; k++) {
        h = mixed(h, s[k]);
        h = (h << 23 | h >> 41) * 0x100000001b3u;
    }
    return h;
}

static void words_as_numbers(void **state) {
    (void)state;
    uint32_t words[67], seed = 5;
    uint64_t longs[13];
    for (int round = 0; round < 200; round++) {
        size_t count = draw(&seed) % 68u, long_count = draw(&seed) % 14u;
        for (size_t i = 0; i < 67; i++) {
            words[i] = draw(&seed);
        }
        for (size_t i = 0; i < 13; i++) {
            longs[i] = (uint64_t)draw(&seed) << 32 | draw(&seed);
        }
        tl_hash hash = tl_hash_begin();
        tl_hash_words(&hash, words, count);
        tl_hash_long_words(&hash, longs, long_count);
        assert_true(tl_hash_end(&hash) == reference(words, count, longs, long_count));
        if (count) { /* unaligned words hash alike */
            unsigned char shifted[4 * 67 + 1];
            memcpy(shifted + 1, words, 4u * count);
            tl_hash a = tl_hash_begin(), b = a;
            tl_hash_words(&a, words, count);
            tl_hash_words(&b, shifted + 1, count);
            assert_true(tl_hash_end(&a) == tl_hash_end(&b));
        }
    }
}

typedef struct column {
    const char *name;
    size_t row, offset, rows;
    int lasts;
} column;
enum { STATE = 1, INDEX = 0, STEP = 0 };

static size_t columns_of(const tl_header *h, column *out) {
    size_t n = 0;
#define X(col, type, count, stage, life, word)                                                                         \
    out[n].name = #col, out[n].row = sizeof(type), out[n].lasts = life;                                                \
    out[n].offset = (size_t)h->offset[TL_COLUMN_##col] * TL_UNIT;                                                      \
    out[n++].rows = tl_store_live(h, TL_COLUMN_##col);
    TL_COLUMNS(X)
#undef X
    return n;
}

static talus_world busy(const void *hull, size_t bytes, int steps) {
    talus_world_def def = kit_small();
    def.body_capacity = 24, def.shape_capacity = 26, def.joint_capacity = 8, def.contact_capacity = 64;
    talus_world world = kit_world(&def);
    kit_busy(&world, hull, bytes);
    kit_steps(&world, steps);
    return world;
}

/* Every single bit of every live row. */
static void each_bit_counts(void **state) {
    (void)state;
    size_t bytes;
    void *hull = kit_hull_region(&bytes);
    talus_world world = busy(hull, bytes, 70), copy = world;
    size_t size = (size_t)tl_header_of(&world)->units * TL_UNIT;
    copy.block = kit_alloc(size);
    memcpy(copy.block, world.block, size);
    column columns[TL_COLUMN_COUNT];
    size_t count = columns_of(tl_header_of(&world), columns), flips = 0;
    const uint64_t hash = talus_world_hash(&world);
    assert_true(hash == talus_world_hash(&copy));
    talus_parting d;
    assert_int_equal(talus_world_part(&world, &copy, 0, &d), 0);
    for (size_t c = 0; c < count; c++) {
        unsigned char *base = (unsigned char *)copy.block + columns[c].offset;
        size_t length = columns[c].rows * columns[c].row;
        if (!columns[c].lasts) {
            continue;
        }
        /* A column of a few kilobytes bit by bit; of longer ones a bit here and there. */
        size_t stride = length > 1024 ? 8u * length / 4096u * 2u + 1u : 1u;
        for (size_t bit = 0; bit < 8u * length; bit += stride, flips++) {
            base[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
            assert_true(talus_world_hash(&copy) != hash);
            assert_int_equal(talus_world_part(&world, &copy, 0, &d), 1);
            assert_string_equal(d.column.name, columns[c].name);
            assert_int_equal(d.row, bit / 8u / columns[c].row);
            assert_int_equal(d.word, bit / 8u % columns[c].row / d.column.word_bytes);
            base[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        }
    }
    assert_true(flips > 20000);
    assert_true(talus_world_hash(&copy) == hash);
    /* What lives for a step, and what is beyond the live rows, does not count. */
    for (size_t c = 0; c < count; c++) {
        if (!columns[c].lasts) {
            ((unsigned char *)copy.block)[columns[c].offset] ^= 1u;
        }
    }
    assert_true(talus_world_hash(&copy) == hash);
    /* The header's settings do. */
    tl_header_of(&copy)->settings.gravity.y += 1.0f;
    assert_true(talus_world_hash(&copy) != hash);
    assert_int_equal(talus_world_part(&world, &copy, 0, &d), 1);
    assert_string_equal(d.column.name, "settings");
    kit_end(&world);
    kit_end(&copy);
    kit_free(hull);
}

static void comparing_what_cannot_be(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world a = kit_world(&def), none = {NULL, NULL, 0, NULL};
    def.body_capacity++;
    talus_world b = kit_world(&def);
    talus_parting d;
    assert_int_equal(talus_world_part(&a, &b, 0, &d), -1);
    assert_int_equal(talus_world_part(&a, &none, 0, &d), -1);
    assert_int_equal(talus_world_part(NULL, &a, 0, &d), -1);
    assert_int_equal(talus_world_part(&a, &a, 0, NULL), -1);
    assert_true(talus_world_hash(&none) == 0);
    kit_end(&a);
    kit_end(&b);
}

/* All instruction sets, changed from step to step, and one alone: the same hash after every step. */
static void one_hash_by_every_isa(void **state) {
    (void)state;
    size_t bytes;
    void *hull = kit_hull_region(&bytes);
    talus_world world[TALUS_ISA_COUNT + 1];
    talus_isa isa[TALUS_ISA_COUNT];
    int count = 0;
    for (int i = TALUS_ISA_SCALAR; i < TALUS_ISA_COUNT; i++) {
        if (talus_isa_available((talus_isa)i)) {
            isa[count++] = (talus_isa)i;
        }
    }
    for (int scene = 0; scene < 4; scene++) {
        for (int i = 0; i <= count; i++) {
            talus_world_def def = kit_small();
            def.substeps = 1u + (uint32_t)scene * 2u, def.iterations = 1u + (uint32_t)scene % 3u;
            world[i] = kit_world(&def);
            kit_busy(&world[i], hull, bytes);
            uint32_t seed = 17u + (uint32_t)scene;
            for (int k = 0; k < 20; k++) {
                talus_body body = kit_body(&world[i], TALUS_DYNAMIC,
                                           kit_vec(draw_float(&seed, -2.0f, 2.0f), draw_float(&seed, 1.0f, 9.0f),
                                                   draw_float(&seed, -2.0f, 2.0f)));
                talus_shape_def shape = draw(&seed) % 2u ? kit_ball_def(0.3f) : kit_box_def(0.2f, 0.3f, 0.25f);
                shape.material.rolling_resistance = draw_float(&seed, 0.0f, 0.1f);
                shape.material.restitution = draw_float(&seed, 0.0f, 0.9f);
                kit_shape(&world[i], body, &shape);
                OK(talus_body_set_locks(&world[i], body, draw(&seed) % 4u ? 0u : draw(&seed) % 64u));
            }
            if (i < count) {
                OK(talus_world_set_isa(&world[i], isa[i]));
            }
        }
        for (int s = 0; s < 150; s++) {
            OK(talus_world_set_isa(&world[count], isa[s % count]));
            for (int i = 0; i <= count; i++) {
                kit_steps(&world[i], 1);
                assert_true(talus_world_hash(&world[i]) == talus_world_hash(&world[0]));
            }
        }
        for (int i = 0; i <= count; i++) {
            kit_end(&world[i]);
        }
    }
    kit_free(hull);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_as_numbers),
        cmocka_unit_test(each_bit_counts),
        cmocka_unit_test(comparing_what_cannot_be),
        cmocka_unit_test(one_hash_by_every_isa),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
