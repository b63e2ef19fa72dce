/* What error a step is said to have left, against poses and velocities in double precision; and islands that get
 * sub-steps by it. */
#include "world_kit.h"

#include <stdio.h>

#define TALL 12
#define LINKS 8

/* --- in double -------------------------------------------------------------------------------------- */

typedef struct d3 {
    double x, y, z;
} d3;

static d3 d3_of(talus_vec3 v) { return (d3){(double)v.x, (double)v.y, (double)v.z}; }
static d3 add(d3 a, d3 b) { return (d3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static d3 sub(d3 a, d3 b) { return (d3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static d3 cross(d3 a, d3 b) { return (d3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
static double length(d3 a) { return sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
static d3 turn(talus_quat r, d3 v) {
    double q[4] = {(double)r.x, (double)r.y, (double)r.z, (double)r.w};
    double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    d3 u = {q[0] / n, q[1] / n, q[2] / n}, t = cross(u, v);
    t = (d3){2.0 * t.x, 2.0 * t.y, 2.0 * t.z};
    d3 c = cross(u, t);
    return (d3){v.x + q[3] / n * t.x + c.x, v.y + q[3] / n * t.y + c.y, v.z + q[3] / n * t.z + c.z};
}
static d3 turn_back(talus_quat r, d3 v) {
    talus_quat back = {-r.x, -r.y, -r.z, r.w};
    return turn(back, v);
}
static d3 point_of(const talus_world *w, talus_body b, d3 own) {
    talus_pose p = kit_pose_of(w, b);
    return add(d3_of(p.position), turn(p.rotation, own));
}
static d3 speed_of(const talus_world *w, talus_body b, d3 at) {
    d3 arm = sub(at, d3_of(kit_pose_of(w, b).position));
    return add(d3_of(kit_velocity(w, b)), cross(d3_of(kit_spin(w, b)), arm));
}

/* m: how far corners of a box of half a metre are below the top of what stands at y = top in a frame. */
static double sunk(const talus_world *w, talus_body box, talus_pose frame, double top) {
    double most = 0.0;
    for (int k = 0; k < 8; k++) {
        d3 corner = {k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5};
        d3 at = turn_back(frame.rotation, sub(point_of(w, box, corner), d3_of(frame.position)));
        most = fmax(most, top - at.y < 0.5 ? top - at.y : 0.0);
    }
    return most;
}

/* m: in a column of boxes on the floor. */
static double overlap_of(const talus_world *w, const talus_body *box, int count) {
    double most = sunk(w, box[0], kit_pose(0.0f, 0.0f, 0.0f), 0.0);
    for (int i = 1; i < count; i++) {
        most = fmax(most, sunk(w, box[i], kit_pose_of(w, box[i - 1]), 0.5));
    }
    return most;
}

/* --- worlds ----------------------------------------------------------------------------------------- */

static void column(talus_world *w, float x, int count, talus_body *box) {
    for (int i = 0; i < count; i++) {
        box[i] = kit_box(w, kit_vec(x + (i & 1 ? 0.02f : 0.0f), 0.5f + 1.001f * (float)i, 0.0f), 0.5f);
    }
}

/* Links of a metre, end to end, let go level. */
static void chain(talus_world *w, talus_body *link) {
    talus_body before = talus_world_ground(w);
    for (int i = 0; i < LINKS; i++) {
        link[i] = kit_box(w, kit_vec(20.5f + (float)i, 15.0f, 0.0f), 0.1f);
        talus_joint_def def = talus_joint_def_default();
        talus_joint joint;
        talus_joint_make_ball(&def);
        def.a = before, def.b = link[i];
        def.frame_a = i ? kit_pose(0.5f, 0.0f, 0.0f) : kit_pose(20.0f, 15.0f, 0.0f);
        def.frame_b = kit_pose(-0.5f, 0.0f, 0.0f);
        OK(talus_joint_create(w, &def, &joint));
        before = link[i];
    }
}

static talus_world begin(float budget) {
    talus_world_def def = kit_small();
    def.enable_sleep = 0;
    def.error_budget = budget;
    talus_world w = kit_world(&def);
    kit_floor(&w);
    return w;
}

/* --- what is reported ------------------------------------------------------------------------------- */

/* Of boxes that stand on each other the deepest corner, to what floats tell apart at twelve metres. */
static void overlap_is_that_of_the_corners(void **state) {
    (void)state;
    talus_world w = begin(0.0f);
    talus_body box[TALL];
    column(&w, 0.0f, TALL, box);
    double most = 0.0;
    for (int step = 0; step < 120; step++) {
        talus_errors e;
        kit_steps(&w, 1);
        OK(talus_world_measure(&w, &e));
        double overlap = overlap_of(&w, box, TALL);
        NEAR(e.overlap, overlap, 1e-5);
        most = fmax(most, overlap);
        assert_true(e.contact_speed >= 0.0f && e.contact_speed < 0.2f);
    }
    assert_true(most > 1e-3);
    kit_end(&w);
}

static void closing_speed_is_that_of_the_ball(void **state) {
    (void)state;
    talus_world w = begin(0.0f);
    talus_errors e;
    talus_body ball = kit_ball(&w, kit_vec(0.0f, 0.499f, 0.0f), 0.5f);
    kit_steps(&w, 1);
    OK(talus_body_set_velocity(&w, ball, kit_vec(3.0f, -0.25f, 0.0f), kit_vec(0.0f, 0.0f, 2.0f)));
    OK(talus_world_measure(&w, &e));
    NEAR(e.contact_speed, 0.25, 2e-3); /* the record's point is where it was before the last move */
    OK(talus_body_set_velocity(&w, ball, kit_vec(3.0f, 0.25f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    OK(talus_world_measure(&w, &e));
    NEAR(e.contact_speed, 0.0, 0.0);
    kit_end(&w);
}

static void joints_are_where_their_ends_are(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.substeps = 1;
    talus_world w = kit_world(&def);
    talus_body link[LINKS];
    chain(&w, link);
    double most = 0.0, fastest = 0.0;
    for (int step = 0; step < 120; step++) {
        double apart = 0.0, speed = 0.0;
        talus_errors e;
        kit_steps(&w, 1);
        OK(talus_world_measure(&w, &e));
        for (int i = 0; i < LINKS; i++) {
            d3 end = {0.5, 0.0, 0.0}, begin_of = {-0.5, 0.0, 0.0}, at = point_of(&w, link[i], begin_of);
            d3 a = i ? point_of(&w, link[i - 1], end) : (d3){20.0, 15.0, 0.0};
            d3 v = i ? speed_of(&w, link[i - 1], at) : (d3){0.0, 0.0, 0.0};
            apart = fmax(apart, length(sub(at, a)));
            speed = fmax(speed, length(sub(speed_of(&w, link[i], at), v)));
        }
        NEAR(e.joint_linear, apart, 1e-5);
        NEAR(e.joint_speed, speed, 1e-4);
        most = fmax(most, apart), fastest = fmax(fastest, speed);
    }
    assert_true(most > 1e-5 && fastest > 1e-6);
    kit_end(&w);
}

/* --- at most this error ----------------------------------------------------------------------------- */

static void budgets_are_met(void **state) {
    (void)state;
    const float budgets[] = {2e-3f, 1e-3f, 3e-4f, 1e-4f};
    uint32_t before = 0;
    for (int i = 0; i < 4; i++) {
        talus_world w = begin(budgets[i]);
        talus_body box[TALL];
        column(&w, 0.0f, TALL, box);
        kit_steps(&w, 90);
        uint32_t most = 0;
        for (int step = 0; step < 120; step++) {
            kit_steps(&w, 1);
            talus_counters c = kit_counters(&w);
            double overlap = overlap_of(&w, box, TALL);
            if (getenv("ERRORS") && step == 119) {
                print_message("budget %.2f mm: overlap %.3f mm, %u sub-steps\n", 1e3 * (double)budgets[i],
                              1e3 * overlap, (unsigned)c.substeps_most);
            }
            assert_true(overlap <= (double)budgets[i] && c.islands_over == 0);
            most = c.substeps_most > most ? c.substeps_most : most;
        }
        assert_true(most >= before && most <= 32u);
        before = most;
        kit_end(&w);
    }
    assert_true(before > 8u);
}

/* What stands alone gets no more than it needs, whatever stands beside it. */
static void easy_islands_get_fewer(void **state) {
    (void)state;
    talus_world w = begin(3e-4f);
    talus_body tall[TALL], low[1], link[LINKS];
    column(&w, 0.0f, TALL, tall);
    column(&w, 8.0f, 1, low);
    kit_steps(&w, 120);
    talus_counters c = kit_counters(&w);
    assert_int_equal(c.substeps_least, 4);
    assert_true(c.substeps_most > 4u);
    assert_int_equal(c.substeps_given, 4u + TALL * c.substeps_most);
    assert_int_equal(c.contacts_touching, TALL + 1);
    assert_int_equal(c.awake_bodies, TALL + 1);
    chain(&w, link);
    kit_steps(&w, 60);
    c = kit_counters(&w);
    assert_int_equal(c.joints_solved, LINKS);
    assert_int_equal(c.joints_sleeping, 0);
    assert_int_equal(talus_world_validate(&w), TALUS_OK);
    kit_end(&w);
}

static double way_between(const talus_world *a, talus_body in_a, const talus_world *b, talus_body in_b) {
    return length(sub(d3_of(kit_place(a, in_a)), d3_of(kit_place(b, in_b))));
}

/* Levels are solved one after the other: each island does what it would alone, and gets as much. */
static void islands_do_as_if_alone(void **state) {
    (void)state;
    talus_world both = begin(3e-4f), one = begin(3e-4f), other = begin(3e-4f);
    talus_body tall[TALL], low[3], tall_alone[TALL], low_alone[3];
    for (int i = 0; i < TALL; i++) { /* by turns, so that what belongs together does not lie together */
        if (i % 4 == 0) {
            low[i / 4] = kit_box(&both, kit_vec(i == 4 ? 5.02f : 5.0f, 0.5f + 1.001f * (float)(i / 4), 0.0f), 0.5f);
        }
        tall[i] = kit_box(&both, kit_vec(i & 1 ? 0.02f : 0.0f, 0.5f + 1.001f * (float)i, 0.0f), 0.5f);
    }
    column(&one, 0.0f, TALL, tall_alone);
    column(&other, 5.0f, 3, low_alone);
    for (int step = 0; step < 240; step++) {
        kit_steps(&both, 1), kit_steps(&one, 1), kit_steps(&other, 1);
        for (int i = 0; i < TALL; i++) {
            assert_true(way_between(&both, tall[i], &one, tall_alone[i]) < 1e-3);
        }
        for (int i = 0; i < 3; i++) {
            assert_true(way_between(&both, low[i], &other, low_alone[i]) < 1e-3);
        }
    }
    uint32_t more = kit_counters(&one).substeps_most, less = kit_counters(&other).substeps_most;
    assert_int_equal(kit_counters(&both).substeps_most, more);
    assert_int_equal(kit_counters(&both).substeps_least, less);
    assert_int_equal(kit_counters(&both).substeps_given, TALL * more + 3u * less);
    assert_true(less < more);
    kit_end(&both), kit_end(&one), kit_end(&other);
}

/* More is given while an error lasts, and less again when it is over. */
static void what_was_given_is_taken_back(void **state) {
    (void)state;
    talus_world w = begin(3e-4f);
    talus_body box[TALL];
    column(&w, 0.0f, TALL, box);
    kit_steps(&w, 60);
    assert_true(kit_counters(&w).substeps_most > 8u);
    for (int i = 1; i < TALL; i++) {
        OK(talus_body_destroy(&w, box[i]));
    }
    kit_steps(&w, 120);
    assert_int_equal(kit_counters(&w).substeps_most, 4);
    talus_accuracy fewer = {3e-4f, 2, 2};
    OK(talus_world_set_accuracy(&w, &fewer));
    kit_steps(&w, 1);
    assert_int_equal(kit_counters(&w).substeps_most, 2);
    fewer.error_budget = 0.0f, fewer.substeps = 7;
    OK(talus_world_set_accuracy(&w, &fewer));
    kit_steps(&w, 1);
    talus_counters c = kit_counters(&w);
    assert_int_equal(c.substeps_least, 7);
    assert_int_equal(c.substeps_most, 7);
    assert_int_equal(c.substeps_given, 7);
    NEAR(c.worst_error, 0.0, 0.0);
    kit_end(&w);
}

/* Touches are told of every level, and the profiler's islands are those of all. */
static void parted_steps_tell_all(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.enable_sleep = 0, def.error_budget = 3e-4f, def.profile_capacity = 2;
    talus_world w = kit_world(&def);
    talus_shape_def heard = kit_box_def(0.5f, 0.5f, 0.5f);
    talus_body tall[TALL];
    kit_floor(&w);
    heard.events = 1;
    column(&w, 0.0f, TALL, tall);
    kit_steps(&w, 30);
    for (int i = 0; i < 3; i++) {
        talus_body b = kit_body(&w, TALUS_DYNAMIC, kit_vec(5.0f + 2.0f * (float)i, 0.6f, 0.0f));
        kit_shape(&w, b, &heard);
    }
    talus_body top = kit_body(&w, TALUS_DYNAMIC, kit_vec(0.0f, 0.6f + 1.001f * TALL, 0.0f));
    kit_shape(&w, top, &heard);
    uint32_t begun = 0;
    for (int step = 0; step < 60; step++) {
        kit_steps(&w, 1);
        begun += kit_events(&w).begin_count;
    }
    assert_int_equal(begun, 4);
    talus_counters c = kit_counters(&w);
    assert_true(c.substeps_least < c.substeps_most);
    talus_frame frame;
    OK(talus_world_get_frame(&w, 0, &frame));
    assert_int_equal(frame.islands, 4);
    assert_int_equal(frame.largest[0].bodies, TALL + 1);
    assert_int_equal(frame.largest[0].contacts, TALL + 1);
    kit_end(&w);
}

/* --- again ------------------------------------------------------------------------------------------ */

/* From a snapshot, from a copy, by another instruction set, and by the commands alone. */
static void budgets_roll_back(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    def.error_budget = 2e-4f;
    talus_world w = kit_world(&def), twin = kit_world(&def), plain = kit_world(&def);
    talus_world *worlds[] = {&w, &twin, &plain};
    size_t hull_bytes, bytes;
    void *hull = kit_hull_region(&hull_bytes);
    for (int i = 0; i < 3; i++) {
        kit_busy(worlds[i], hull, hull_bytes);
    }
    OK(talus_world_set_isa(&plain, TALUS_ISA_SCALAR));
    unsigned char memory[4096];
    talus_log log = {memory, sizeof memory, 0, 0, 0, 0, 0};
    size_t size = talus_world_save_size(&w);
    void *snapshot = kit_alloc(size + (1u << 16));
    w.log = &log;
    uint32_t parted = 0;
    for (int round = 0; round < 20; round++) {
        talus_accuracy next = {2e-4f, 2u + (uint32_t)round % 3u, 8u << round % 3};
        log.used = 0;
        OK(talus_world_set_accuracy(&w, &next));
        kit_steps(&w, 10);
        assert_int_equal(log.lost, 0);
        for (size_t at = 0; at < log.used;) {
            talus_command c, copy;
            size_t one = talus_command_decode(&c, memory + at, log.used - at);
            assert_true(one > 0);
            copy = c;
            OK(talus_world_apply(&twin, &c));
            OK(talus_world_apply(&plain, &copy));
            at += one;
        }
        assert_true(talus_world_hash(&w) == talus_world_hash(&twin));
        assert_true(talus_world_hash(&w) == talus_world_hash(&plain));
        assert_true(talus_world_save_size(&w) <= size + (1u << 16));
        OK(talus_world_save(&w, snapshot, size + (1u << 16), &bytes));
        kit_steps(&twin, 7); /* away, and back */
        OK(talus_world_restore(&twin, snapshot, bytes));
        assert_true(talus_world_hash(&w) == talus_world_hash(&twin));
        assert_int_equal(talus_world_validate(&twin), TALUS_OK);
        parted += kit_counters(&w).substeps_least < kit_counters(&w).substeps_most;
    }
    assert_true(parted > 3);
    kit_free(snapshot);
    kit_end(&w), kit_end(&twin), kit_end(&plain);
    kit_free(hull);
}

static void bad_accuracies(void **state) {
    (void)state;
    talus_world w = begin(0.0f);
    talus_world_def got;
    const float bad[] = {NAN, INFINITY, -INFINITY}, beyond[] = {-1e-6f, 1.001f};
    for (int i = 0; i < 3; i++) {
        talus_accuracy a = {bad[i], 4, 32};
        talus_world_def def = kit_small();
        def.error_budget = bad[i];
        REFUSED(&w, TALUS_NOT_FINITE, talus_world_set_accuracy(&w, &a));
        assert_true(talus_world_size(&def) == 0);
    }
    for (int i = 0; i < 2; i++) {
        talus_accuracy a = {beyond[i], 4, 32};
        REFUSED(&w, TALUS_BAD_ARGUMENT, talus_world_set_accuracy(&w, &a));
    }
    const uint32_t counts[][2] = {{0, 32}, {65, 32}, {4, 0}, {4, 65}};
    for (int i = 0; i < 4; i++) {
        talus_accuracy a = {1e-3f, counts[i][0], counts[i][1]};
        talus_world_def def = kit_small();
        def.substeps = counts[i][0], def.most_substeps = counts[i][1];
        REFUSED(&w, TALUS_BAD_ARGUMENT, talus_world_set_accuracy(&w, &a));
        assert_true(talus_world_size(&def) == 0);
    }
    REFUSED(&w, TALUS_BAD_ARGUMENT, talus_world_set_accuracy(&w, NULL));
    talus_accuracy a = {1e-3f, 3, 64};
    OK(talus_world_set_accuracy(&w, &a));
    OK(talus_world_get_def(&w, &got));
    assert_true(got.error_budget == 1e-3f);
    assert_int_equal(got.substeps, 3);
    assert_int_equal(got.most_substeps, 64);
    kit_end(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlap_is_that_of_the_corners),
        cmocka_unit_test(closing_speed_is_that_of_the_ball),
        cmocka_unit_test(joints_are_where_their_ends_are),
        cmocka_unit_test(budgets_are_met),
        cmocka_unit_test(easy_islands_get_fewer),
        cmocka_unit_test(islands_do_as_if_alone),
        cmocka_unit_test(what_was_given_is_taken_back),
        cmocka_unit_test(parted_steps_tell_all),
        cmocka_unit_test(budgets_roll_back),
        cmocka_unit_test(bad_accuracies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
