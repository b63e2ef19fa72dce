/* The pair table, the colours, and the lists under whatever a caller does. */
#include "store_check.h"

enum { BODIES = 60 };

/* Bodies with a ball each; contacts are then made by hand. */
static talus_world crowd(uint32_t contacts) {
    talus_world_def def = kit_small();
    def.body_capacity = def.shape_capacity = BODIES;
    def.contact_capacity = contacts;
    talus_world world = kit_world(&def);
    for (int i = 0; i < BODIES; i++) {
        talus_body body = kit_body(&world, i % 10 ? TALUS_DYNAMIC : TALUS_STATIC, kit_vec(3.0f * (float)i, 0.0f, 0.0f));
        talus_shape_def def_ball = kit_ball_def(0.5f);
        kit_shape(&world, body, &def_ball);
    }
    return world;
}

/* Made and ended at random, up to full, some of them with contacts: found if and only if a plain table has it. */
static void pairs_as_a_table(void **state) {
    (void)state;
    const uint32_t capacities[] = {1, 7, 100, 300};
    for (int c = 0; c < 4; c++) {
        talus_world world = crowd(capacities[c]);
        tl_header *h = tl_header_of(&world);
        static uint32_t table[BODIES][BODIES];
        memset(table, 0xff, sizeof table);
        uint32_t seed = 3, used = 0, touching = 0, full = 0, full_contacts = 0;
        for (int round = 0; round < 60000; round++) {
            uint32_t a = draw(&seed) % BODIES, b = draw(&seed) % BODIES;
            if (a >= b) {
                continue;
            }
            assert_true(tl_pair_find(h, a, b) == table[a][b]);
            /* Mostly filling, then mostly emptying. */
            int fill = (round / 10000) % 2 == 0;
            if (table[a][b] == TL_NONE && (fill || draw(&seed) % 4u == 0)) {
                if (draw(&seed) % 4u) {
                    table[a][b] = tl_pair_make(h, a, b);
                    assert_true((table[a][b] == TL_NONE) == (used - touching == TL_APART_PER_CONTACT * capacities[c]));
                    full += table[a][b] == TL_NONE;
                } else {
                    uint32_t contact = tl_contact_make(h, a, b);
                    assert_true((contact == TL_NONE) == (touching == capacities[c]));
                    full_contacts += contact == TL_NONE;
                    touching += contact != TL_NONE;
                    table[a][b] = contact == TL_NONE ? TL_NONE : tl_contact_pair(h)[contact];
                }
                used += table[a][b] != TL_NONE;
            } else if (table[a][b] != TL_NONE && (!fill || draw(&seed) % 4u == 0)) {
                uint32_t contact = tl_pairs(h)[table[a][b]].contact;
                if (contact != TL_NONE) {
                    tl_contact_end(h, contact, 0);
                    touching--;
                } else {
                    tl_pair_end(h, table[a][b]);
                    used--;
                }
                table[a][b] = tl_pair_find(h, a, b); /* without room for one more that is apart it is gone too */
                used -= contact != TL_NONE && table[a][b] == TL_NONE;
            }
            assert_true(table[a][b] == tl_pair_find(h, a, b));
            assert_int_equal(h->contacts.used, touching);
            assert_int_equal(h->pairs.used, used);
            if (round % 1000 == 0) {
                check_store(&world);
            }
        }
        assert_true(full + full_contacts > 0);
        for (uint32_t a = 0; a < BODIES; a++) {
            for (uint32_t b = a + 1u; b < BODIES; b++) {
                assert_true(tl_pair_find(h, a, b) == table[a][b]);
            }
        }
        kit_end(&world);
    }
}

/* Colours of constraints between random bodies: none twice on a dynamic body, the lowest free one, and the overflow
 * when 64 are taken. */
static void colors_are_apart(void **state) {
    (void)state;
    talus_world world = crowd(4);
    tl_header *h = tl_header_of(&world);
    uint32_t seed = 11, taken[4000][3], count = 0, overflow = 0;
    static uint64_t seen[BODIES + 1];
    memset(seen, 0, sizeof seen);
    for (int round = 0; round < 40000; round++) {
        if (count < 4000 && (draw(&seed) % 3u || round < 3000)) {
            uint32_t a = draw(&seed) % (BODIES + 1u), b = draw(&seed) % (BODIES + 1u);
            if (a == b || (!tl_body_is_dynamic(h, a) && !tl_body_is_dynamic(h, b))) {
                continue;
            }
            uint64_t used = seen[a] | seen[b];
            uint32_t color = tl_color_take(h, a, b);
            assert_true(color == TL_COLORS ? ~used == 0
                                           : !(used & bit_of(color)) && (used | (bit_of(color) - 1u)) == used);
            overflow += color == TL_COLORS;
            seen[a] |= tl_body_is_dynamic(h, a) ? bit_of(color) : 0u;
            seen[b] |= tl_body_is_dynamic(h, b) ? bit_of(color) : 0u;
            taken[count][0] = a, taken[count][1] = b, taken[count++][2] = color;
        } else if (count) {
            uint32_t i = draw(&seed) % count, a = taken[i][0], b = taken[i][1], color = taken[i][2];
            tl_color_give(h, a, b, color);
            seen[a] &= ~bit_of(color), seen[b] &= ~bit_of(color);
            memcpy(taken[i], taken[--count], sizeof taken[i]);
        }
        for (uint32_t k = 0; k <= BODIES; k++) {
            assert_true(!tl_body_is_dynamic(h, k) || tl_body_colors(h)[k] == seen[k]);
        }
    }
    assert_true(overflow > 0);
    kit_end(&world);
}

static talus_body random_body(uint32_t *seed, const talus_body *body, uint32_t count) {
    return body[draw(seed) % count];
}

/* One thing that a caller may do, at random; refusals are as good as anything. */
static void do_something(talus_world *world, uint32_t *seed, talus_body *body, uint32_t count, talus_joint *joint,
                         uint32_t joints, talus_shape *shape, uint32_t shapes) {
    uint32_t what = draw(seed) % 16u, slot = draw(seed) % count;
    talus_body one = body[slot], two = random_body(seed, body, count);
    if (what < 4) {
        talus_body_def def = talus_body_def_default();
        def.type = (talus_body_type)(draw(seed) % 8u > 1u ? 2u : draw(seed) % 2u);
        def.pose.position =
            kit_vec(draw_float(seed, -3.0f, 3.0f), draw_float(seed, 0.3f, 5.0f), draw_float(seed, -3.0f, 3.0f));
        def.starts_asleep = draw(seed) % 4u == 0;
        if (!talus_body_is_valid(world, one) && talus_body_create(world, &def, &body[slot]) == TALUS_OK) {
            talus_shape_def box = kit_box_def(0.4f, 0.3f, 0.5f);
            box.events = draw(seed) % 2u == 0;
            box.sensor = draw(seed) % 8u == 0;
            (void)talus_shape_create(world, body[slot], &box, &shape[draw(seed) % shapes]);
        }
    } else if (what == 4) {
        (void)talus_body_destroy(world, one);
    } else if (what < 7) {
        talus_joint_def def = talus_joint_def_default();
        talus_joint_make_ball(&def);
        def.a = one, def.b = two;
        def.collide_connected = draw(seed) % 2u == 0;
        def.break_force = draw(seed) % 2u ? 1000.0f : 0.0f;
        uint32_t j = draw(seed) % joints;
        (void)talus_joint_destroy(world, joint[j]);
        (void)talus_joint_create(world, &def, &joint[j]);
    } else if (what == 7) {
        (void)talus_joint_destroy(world, joint[draw(seed) % joints]);
    } else if (what == 8) {
        (void)talus_body_sleep(world, one);
    } else if (what == 9) {
        (void)talus_body_wake(world, one);
    } else if (what == 10) {
        talus_pose pose =
            kit_pose(draw_float(seed, -3.0f, 3.0f), draw_float(seed, 0.3f, 4.0f), draw_float(seed, -3.0f, 3.0f));
        (void)talus_body_set_pose(world, one, &pose);
    } else if (what == 11) {
        talus_vec3 v = draw(seed) % 2u ? kit_vec(draw_float(seed, -2.0f, 2.0f), 0.0f, 1.0f) : kit_vec(0.0f, 0.0f, 0.0f);
        (void)talus_body_set_velocity(world, one, v, kit_vec(0.0f, 0.0f, 0.0f));
    } else if (what == 12) {
        (void)talus_shape_destroy(world, shape[draw(seed) % shapes]);
    } else if (what == 13) {
        talus_shape_def ball = kit_ball_def(0.3f);
        ball.pose.position.x = 0.3f;
        uint32_t s = draw(seed) % shapes;
        if (!talus_shape_is_valid(world, shape[s])) {
            (void)talus_shape_create(world, one, &ball, &shape[s]);
        }
    } else if (what == 14) {
        talus_filter filter = {1, draw(seed) % 4u ? ~(uint64_t)0 : 0, 0};
        (void)talus_shape_set_filter(world, shape[draw(seed) % shapes], &filter);
    } else {
        (void)talus_body_mass_from_shapes(world, one);
    }
}

/* Ten thousand calls with steps in between: all links are sound after each. */
static void lists_stay_sound(void **state) {
    (void)state;
    for (uint32_t run = 1; run <= 6; run++) {
        enum { COUNT = 40, JOINTS = 20, SHAPES = 60 };
        talus_world_def def = kit_small();
        def.contact_capacity = run % 2u ? 256 : 24; /* the small one is full at times */
        def.sleep_time = 0.1f;
        talus_world world = kit_world(&def);
        talus_body body[COUNT];
        talus_joint joint[JOINTS];
        talus_shape shape[SHAPES];
        memset(body, 0, sizeof body);
        memset(joint, 0, sizeof joint);
        memset(shape, 0, sizeof shape);
        kit_floor(&world);
        uint32_t seed = run * 7919u, slept = 0, dropped = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            body[i].index = 99, body[i].generation = 99;
        }
        for (int round = 0; round < 2000; round++) {
            do_something(&world, &seed, body, COUNT, joint, JOINTS, shape, SHAPES);
            check_store(&world);
            if (draw(&seed) % 4u == 0) {
                kit_steps(&world, 1 + (int)(draw(&seed) % 4u));
                check_store(&world);
                slept += kit_counters(&world).islands_slept;
                dropped += kit_counters(&world).contacts.dropped;
            }
        }
        assert_true(slept > 0);
        assert_true(run % 2u || dropped > 0);
        kit_end(&world);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_as_a_table),
        cmocka_unit_test(colors_are_apart),
        cmocka_unit_test(lists_stay_sound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
