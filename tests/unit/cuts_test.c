/* Linkages that are one long path are cut into pieces; a joint the other way round keeps them from it. Both ways a
 * chain must go alike. */
#include "store_check.h"

typedef struct chain {
    talus_world world;
    talus_body link[80];
    int links;
} chain;

/* Links in a row, the first on the ground or none, with the joint `turned` the other way round. */
static void open_chain(chain *c, int links, int hinge, int held, int turned) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = def.shape_capacity = def.joint_capacity = 96;
    def.enable_sleep = 0;
    c->world = kit_world(&def);
    c->links = links;
    talus_body before = {0, 0};
    for (int i = 0; i < links; i++) {
        talus_shape_def box = kit_box_def(0.1f, 0.05f, 0.05f);
        c->link[i] = kit_body(&c->world, TALUS_DYNAMIC, kit_vec(0.15f + 0.3f * (float)i, 0.0f, 0.0f));
        kit_shape(&c->world, c->link[i], &box);
        OK(talus_body_set_velocity(&c->world, c->link[i], kit_vec(0.0f, 2.0f, hinge ? 0.0f : 0.2f * (float)(i % 5)),
                                   kit_vec(0.0f, 0.0f, 0.0f)));
        if (i > 0 || held) {
            talus_joint_def d = talus_joint_def_default();
            talus_joint joint;
            hinge ? talus_joint_make_revolute(&d) : talus_joint_make_ball(&d);
            d.frame_a.position.x = i > 0 ? 0.15f : 0.0f, d.frame_b.position.x = -0.15f;
            if (hinge) { /* x onto z */
                d.frame_a.rotation.y = d.frame_b.rotation.y = -0.70710678f;
                d.frame_a.rotation.w = d.frame_b.rotation.w = 0.70710678f;
            }
            d.a = before, d.b = c->link[i];
            if (i == turned) {
                talus_pose frame = d.frame_a;
                d.frame_a = d.frame_b, d.frame_b = frame;
                d.a = c->link[i], d.b = before;
            }
            OK(talus_joint_create(&c->world, &d, &joint));
        }
        before = c->link[i];
    }
}

static uint32_t cuts_of(const chain *c) {
    const tl_header *h = tl_header_of(&c->world);
    assert_int_equal(h->linkages, 1);
    return tl_linkages(h)[0].cuts;
}

static void compare(int links, int hinge, int held) {
    chain cut, whole;
    open_chain(&cut, links, hinge, held, -1);
    open_chain(&whole, links, hinge, held, links / 2);
    uint32_t joints = (uint32_t)(links - !held);
    for (int step = 0; step < 20; step++) {
        talus_errors e;
        kit_steps(&cut.world, 1);
        kit_steps(&whole.world, 1);
        assert_int_equal(cuts_of(&cut), joints / ((joints + 7u) / 8u));
        assert_int_equal(cuts_of(&whole), 0);
        OK(talus_world_measure(&cut.world, &e));
        assert_true(e.joint_linear < 1e-4f && e.joint_angular < 1e-3f);
    }
    for (int i = 0; i < links; i++) {
        talus_pose a, b;
        OK(talus_body_get_pose(&cut.world, cut.link[i], &a));
        OK(talus_body_get_pose(&whole.world, whole.link[i], &b));
        NEAR(a.position.x, b.position.x, 1e-3f);
        NEAR(a.position.y, b.position.y, 1e-3f);
        NEAR(a.position.z, b.position.z, 1e-3f);
    }
    kit_end(&cut.world);
    kit_end(&whole.world);
}

static void go_alike(void **state) {
    (void)state;
    for (int links = 18; links <= 80; links += links < 27 ? 1 : 9) {
        compare(links, 0, 1);
        compare(links, 0, 0);
        compare(links, 1, 1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(go_alike)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
