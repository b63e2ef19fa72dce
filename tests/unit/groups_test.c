/* Groups of eight: their lanes share no moving body; what does not fit is counted. */
#include "store_check.h"

static void check_lanes(const uint32_t *a, const uint32_t *b, uint32_t lanes, uint32_t rows) {
    assert_true(lanes >= 1 && lanes <= TL_LANES);
    for (uint32_t i = 0; i < lanes; i++) {
        assert_true(a[i] < rows && b[i] < rows && (a[i] != b[i]));
        for (uint32_t j = 0; j < i; j++) {
            assert_true(a[i] == 0 || (a[i] != a[j] && a[i] != b[j]));
            assert_true(b[i] == 0 || (b[i] != a[j] && b[i] != b[j]));
        }
    }
}

/* After a step: every touching awake contact is in one lane, every awake joint too. */
static void check_groups(const talus_world *world) {
    const tl_header *h = tl_header_of(world);
    talus_counters n = kit_counters(world);
    uint32_t lanes = 0, joint_lanes = 0;
    for (uint32_t i = 0; i < h->groups; i++) {
        const tl_contact_group *g = &tl_group_pool(h)[i];
        check_lanes(g->a, g->b, g->lanes, h->capacity[TL_COUNT_ROW]);
        assert_true(g->points >= 1 && g->points <= 4);
        for (uint32_t k = 0; k < g->lanes; k++) {
            assert_true(tl_contacts(h)[g->contact[k]].flags & TL_CONTACT_ALIVE);
        }
        lanes += g->lanes;
    }
    for (uint32_t i = 0; i < h->joint_groups; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(h)[i];
        check_lanes(g->a, g->b, g->lanes, h->capacity[TL_COUNT_ROW]);
        joint_lanes += g->lanes;
    }
    assert_int_equal(lanes, n.lanes_used);
    assert_int_equal(lanes + joint_lanes + n.rows.dropped, n.contacts_touching + h->awake_joints);
    assert_int_equal(h->groups, n.lane_groups);
}

static void lanes_are_disjoint(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.body_capacity = def.shape_capacity = 300, def.contact_capacity = 3000;
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    kit_floor(&world);
    uint32_t seed = 4;
    talus_body before = talus_world_ground(&world);
    for (int i = 0; i < 250; i++) {
        talus_vec3 at =
            kit_vec(draw_float(&seed, -2.0f, 2.0f), draw_float(&seed, 0.3f, 6.0f), draw_float(&seed, -2.0f, 2.0f));
        talus_body body = i % 3 ? kit_box(&world, at, 0.2f) : kit_ball(&world, at, 0.25f);
        if (i % 9 == 0) {
            talus_joint_def joint = talus_joint_def_default();
            talus_joint handle;
            i % 2 ? talus_joint_make_ball(&joint) : talus_joint_make_distance(&joint, 0.0f, 1.0f);
            joint.a = before, joint.b = body;
            OK(talus_joint_create(&world, &joint, &handle));
        }
        before = body;
    }
    for (int i = 0; i < 120; i++) {
        kit_steps(&world, 1);
        check_groups(&world);
    }
    assert_true(kit_counters(&world).contacts_touching > 200);
    kit_end(&world);
}

/* One plate on a hundred balls, all dynamic: more constraints on one body than colours. */
static void beyond_the_last_color(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.body_capacity = def.shape_capacity = 120, def.contact_capacity = 500;
    def.enable_sleep = 0;
    talus_world world = kit_world(&def);
    kit_floor(&world);
    for (int i = 0; i < 100; i++) {
        kit_ball(&world, kit_vec(0.5f * (float)(i % 10) - 2.25f, 0.1f, 0.5f * (float)(i / 10) - 2.25f), 0.1f);
    }
    talus_body plate = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.3f, 0.0f));
    talus_shape_def shape = kit_box_def(2.5f, 0.1f, 2.5f);
    shape.density = 100.0f;
    kit_shape(&world, plate, &shape);
    for (int i = 0; i < 60; i++) {
        kit_steps(&world, 1);
        check_groups(&world);
        assert_int_equal(kit_counters(&world).rows.dropped, 0);
    }
    assert_int_equal(kit_counters(&world).contacts_touching, 200);
    NEAR(kit_place(&world, plate).y, 0.3, 0.02);
    check_store(&world);
    kit_end(&world);
}

/* More pairs than fit: counted as dropped, in the same way each time, and asked for again when there is room. */
static void contacts_full(void **state) {
    (void)state;
    uint64_t hash[2];
    for (int run = 0; run < 2; run++) {
        talus_world_def def = kit_small();
        def.contact_capacity = 6;
        talus_world world = kit_world(&def);
        kit_floor(&world);
        talus_body body[10];
        for (int i = 0; i < 10; i++) {
            body[i] = kit_box(&world, kit_vec(2.0f * (float)i, 0.25f, 0.0f), 0.25f);
        }
        kit_steps(&world, 1);
        assert_in_range(kit_counters(&world).contacts.dropped, 4, 8); /* both shapes of a pair may have asked for it */
        assert_int_equal(kit_counters(&world).contacts.used, 6);
        assert_int_equal(kit_counters(&world).contacts.high_water, 6);
        check_store(&world);
        for (int i = 0; i < 10; i++) {
            if (kit_velocity(&world, body[i]).y > -0.1f) { /* it stands: it makes room */
                talus_pose away = kit_pose(100.0f + 3.0f * (float)i, 50.0f, 0.0f);
                OK(talus_body_set_pose(&world, body[i], &away));
            }
        }
        kit_steps(&world, 2);
        assert_int_equal(kit_counters(&world).contacts.dropped, 0);
        check_store(&world);
        hash[run] = talus_world_hash(&world);
        kit_end(&world);
    }
    assert_true(hash[0] == hash[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_are_disjoint),
        cmocka_unit_test(beyond_the_last_color),
        cmocka_unit_test(contacts_full),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
