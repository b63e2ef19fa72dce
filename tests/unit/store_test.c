/* The layout of the block. */
#include "store_check.h"

typedef struct extent {
    size_t row, capacity, offset;
} extent;

static void columns_lie_apart(void **state) {
    (void)state;
    uint32_t seed = 21;
    for (int round = 0; round < 200; round++) {
        talus_world_def def = talus_world_def_default();
        def.body_capacity = 1u + draw(&seed) % 3000u, def.shape_capacity = 1u + draw(&seed) % 3000u;
        def.joint_capacity = 1u + draw(&seed) % 500u, def.contact_capacity = 1u + draw(&seed) % 5000u;
        def.event_capacity = 1u + draw(&seed) % 100u;
        uint32_t capacity[TL_COUNT_COUNT], offset[TL_COLUMN_COUNT];
        uint32_t units = tl_store_layout(&def, capacity, offset);
        assert_true(units > 0 && talus_world_size(&def) == (size_t)units * TL_UNIT);
        size_t end = sizeof(tl_header), n = 0;
        extent e[TL_COLUMN_COUNT];
#define X(col, type, count, stage, life, word)                                                                         \
    e[n].row = sizeof(type), e[n].capacity = capacity[TL_COUNT_##count];                                               \
    e[n++].offset = (size_t)offset[TL_COLUMN_##col] * TL_UNIT;                                                         \
    assert_true(sizeof(type) % (word) == 0);
        TL_COLUMNS(X)
#undef X
        for (size_t i = 0; i < n; i++) {
            assert_true(e[i].offset >= end && e[i].offset - end < TL_UNIT);
            end = e[i].offset + e[i].row * e[i].capacity;
        }
        assert_true(end <= (size_t)units * TL_UNIT && (size_t)units * TL_UNIT - end < TL_UNIT);
        assert_true(capacity[TL_COUNT_SLOT] >= 2u * def.contact_capacity);
        assert_true((capacity[TL_COUNT_SLOT] & (capacity[TL_COUNT_SLOT] - 1u)) == 0);
        assert_true(capacity[TL_COUNT_ROW] % TL_LANES == 0 && capacity[TL_COUNT_ROW] > def.body_capacity + 1u);
    }
}

/* Members of one size and no holes, on which the hash stands. */
static void records_have_no_holes(void **state) {
    (void)state;
    assert_int_equal(sizeof(tl_row8), 32);
    assert_int_equal(sizeof(tl_body_meta), 28);
    assert_int_equal(sizeof(tl_shape_meta), 24);
    assert_int_equal(sizeof(tl_pair), 32);
    assert_int_equal(sizeof(tl_contact_head), 32);
    assert_int_equal(sizeof(tl_contact_point_record), 32);
    assert_int_equal(sizeof(tl_contact_meta), 32);
    assert_int_equal(sizeof(tl_body_inertia), 32);
    assert_int_equal(sizeof(tl_tree_node), 40);
    assert_int_equal(sizeof(tl_contact_group) % 32u, 0);
    assert_int_equal(sizeof(tl_joint_group) % 32u, 0);
    assert_int_equal(sizeof(tl_joint_row) % 32u, 0);
}

static void pools_go_to_their_top(void **state) {
    (void)state;
    tl_pool pool = {0, TL_NONE, 0, 0};
    assert_int_equal(tl_pool_top(&pool, 2), 0);
    pool.high = 1;
    assert_int_equal(tl_pool_top(&pool, 2), 1);
    pool.high = 2;
    assert_true(tl_pool_top(&pool, 2) == TL_NONE);
    pool.free = 1;
    assert_int_equal(tl_pool_top(&pool, 2), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_lie_apart),
        cmocka_unit_test(records_have_no_holes),
        cmocka_unit_test(pools_go_to_their_top),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
