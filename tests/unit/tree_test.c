/* The tree of boxes against looking at every box. */
#include "store_check.h"

enum { MANY = 10000 };

static talus_world tree_world(uint32_t shapes) {
    talus_world_def def = kit_small();
    def.shape_capacity = shapes;
    return kit_world(&def);
}
static talus_aabb random_box(uint32_t *seed, float room, float size) {
    talus_vec3 c = kit_vec(draw_float(seed, -room, room), draw_float(seed, -room, room), draw_float(seed, -room, room));
    talus_vec3 e = kit_vec(draw_float(seed, 0.0f, size), draw_float(seed, 0.0f, size), draw_float(seed, 0.0f, size));
    talus_aabb box = {kit_vec(c.x - e.x, c.y - e.y, c.z - e.z), kit_vec(c.x + e.x, c.y + e.y, c.z + e.z)};
    return box;
}
static uint32_t check_tree(const tl_header *h, int tree) {
    uint32_t count = 0;
    return h->root[tree] == TL_NONE ? 0 : check_tree_node(h, h->root[tree], TL_NONE, &count);
}

static void as_brute_force(void **state) {
    (void)state;
    enum { COUNT = 300 };
    talus_world world = tree_world(COUNT);
    tl_header *h = tl_header_of(&world);
    talus_aabb box[COUNT];
    uint32_t leaf[COUNT], in_tree = 0, seed = 7;
    int tree[COUNT];
    memset(leaf, 0xff, sizeof leaf);
    for (int round = 0; round < 20000; round++) {
        uint32_t i = draw(&seed) % COUNT;
        if (leaf[i] == TL_NONE) {
            tree[i] = (int)(draw(&seed) & 1u);
            box[i] = random_box(&seed, 10.0f, draw(&seed) % 8u ? 1.0f : 8.0f);
            leaf[i] = tl_tree_insert(h, tree[i], i, &box[i]);
            in_tree++;
        } else if (draw(&seed) % 4u) { /* a little way, or anywhere */
            talus_aabb next = random_box(&seed, 10.0f, 1.0f);
            float way = draw_float(&seed, -0.2f, 0.2f);
            talus_aabb near = {kit_vec(box[i].lower.x + way, box[i].lower.y, box[i].lower.z - way),
                               kit_vec(box[i].upper.x + way, box[i].upper.y, box[i].upper.z - way)};
            box[i] = draw(&seed) & 1u ? near : next;
            leaf[i] = tl_tree_move(h, tree[i], leaf[i], &box[i]);
        } else {
            tl_tree_remove(h, tree[i], leaf[i]);
            leaf[i] = TL_NONE;
            in_tree--;
        }
        uint32_t roots = (h->root[0] != TL_NONE ? 1u : 0u) + (h->root[1] != TL_NONE ? 1u : 0u);
        assert_int_equal(h->nodes.used, in_tree ? 2u * in_tree - roots : 0u);
        if (round % 50) {
            continue;
        }
        check_tree(h, 0);
        check_tree(h, 1);
        talus_aabb query = random_box(&seed, 10.0f, 5.0f);
        for (int t = 0; t < 2; t++) {
            uint8_t found[COUNT] = {0};
            tl_tree_walk walk;
            tl_tree_begin(&walk, h, t, &query);
            for (uint32_t s = tl_tree_next(&walk, h); s != TL_NONE; s = tl_tree_next(&walk, h)) {
                assert_true(s < COUNT);
                if (s < COUNT) {
                    found[s]++;
                }
            }
            for (uint32_t s = 0; s < COUNT; s++) {
                assert_int_equal(found[s], leaf[s] != TL_NONE && tree[s] == t && tl_aabb_overlap(&box[s], &query));
            }
        }
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        if (leaf[i] != TL_NONE) {
            tl_tree_remove(h, tree[i], leaf[i]);
        }
    }
    assert_true(h->nodes.used == 0 && h->root[0] == TL_NONE && h->root[1] == TL_NONE);
    kit_end(&world);
}

/* Boxes one after the other in a line are the worst order there is: 14 levels would be perfect. */
static void a_line_stays_low(void **state) {
    (void)state;
    for (int way = 0; way < 3; way++) {
        talus_world world = tree_world(MANY);
        tl_header *h = tl_header_of(&world);
        for (uint32_t i = 0; i < MANY; i++) {
            float x = (float)(way == 1 ? MANY - i : i), y = way == 2 ? x : 0.0f;
            talus_aabb box = {kit_vec(x, y, 0.0f), kit_vec(x + 1.2f, y + 1.0f, 1.0f)};
            tl_tree_insert(h, 0, i, &box);
        }
        assert_true(check_tree(h, 0) <= 40u);
        assert_int_equal(h->nodes.used, 2 * MANY - 1);
        kit_end(&world);
    }
}

/* All in one place, and boxes without any size. */
static void equal_boxes(void **state) {
    (void)state;
    talus_world world = tree_world(1000);
    tl_header *h = tl_header_of(&world);
    const talus_aabb box = {{1.0f, 2.0f, 3.0f}, {1.0f, 2.0f, 3.0f}};
    for (uint32_t i = 0; i < 1000; i++) {
        tl_tree_insert(h, 1, i, &box);
    }
    check_tree(h, 1);
    uint32_t found = 0;
    tl_tree_walk walk;
    tl_tree_begin(&walk, h, 1, &box);
    while (tl_tree_next(&walk, h) != TL_NONE) {
        found++;
    }
    assert_int_equal(found, 1000);
    kit_end(&world);
}

/* The same calls give the same tree and the same order of the walk. */
static void order_is_fixed(void **state) {
    (void)state;
    uint32_t first[500];
    for (int run = 0; run < 2; run++) {
        talus_world world = tree_world(500);
        tl_header *h = tl_header_of(&world);
        uint32_t seed = 99, leaf[500], count = 0;
        for (uint32_t i = 0; i < 500; i++) {
            talus_aabb box = random_box(&seed, 5.0f, 1.0f);
            leaf[i] = tl_tree_insert(h, 0, i, &box);
        }
        for (uint32_t i = 0; i < 500; i += 3) {
            talus_aabb box = random_box(&seed, 5.0f, 1.0f);
            tl_tree_remove(h, 0, leaf[i]);
            leaf[i] = tl_tree_insert(h, 0, i, &box);
        }
        const talus_aabb all = {{-9.0f, -9.0f, -9.0f}, {9.0f, 9.0f, 9.0f}};
        tl_tree_walk walk;
        tl_tree_begin(&walk, h, 0, &all);
        for (uint32_t s = tl_tree_next(&walk, h); s != TL_NONE; s = tl_tree_next(&walk, h), count++) {
            assert_true(run == 0 || first[count] == s);
            first[count] = s;
        }
        assert_int_equal(count, 500);
        kit_end(&world);
    }
}

static void empty_tree(void **state) {
    (void)state;
    talus_world world = tree_world(4);
    const talus_aabb all = {{-9.0f, -9.0f, -9.0f}, {9.0f, 9.0f, 9.0f}};
    tl_tree_walk walk;
    tl_tree_begin(&walk, tl_header_of(&world), 0, &all);
    assert_true(tl_tree_next(&walk, tl_header_of(&world)) == TL_NONE);
    assert_true(tl_tree_next(&walk, tl_header_of(&world)) == TL_NONE);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_brute_force), cmocka_unit_test(a_line_stays_low), cmocka_unit_test(equal_boxes),
        cmocka_unit_test(order_is_fixed), cmocka_unit_test(empty_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
