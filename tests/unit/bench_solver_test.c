/* `talus bench solver`: its errors against what is known of them; a quick table, its JSON and its plot. */
#include "bench_kit.h"

#include "gltf/author.h"
#include "talus/bench_solver.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- errors --- */

typedef struct lab {
    gltf_scene scene;
    gltf_world world;
    bench_judge judge;
} lab;

#define PINNED "\"limits\":[{\"linearAxes\":[0,1,2],\"min\":0,\"max\":0}]"

/* A floor; a box of 1 m and a ball of 0.5 m that stand on it; a wedge of a hull; two bodies on a joint, which overlap;
 * a sensor that holds all of them. Two colliders of the box, each half of it. */
static void open_lab(lab *l) {
    author a;
    gltf_error error;
    size_t size = 0;
    author_open(&a, "lab", 10);
    int material = author_material(&a, 0.5, 0, NULL);
    author_static(&a, author_box(&a, 40, 1, 40), author_at(0, -0.5, 0), material);
    int box = author_add_compound(&a, author_at(0, 0.5, 0), "\"mass\":2");
    author_add_part(&a, box, author_box(&a, 0.5, 1, 1), author_at(-0.25, 0, 0), material);
    author_add_part(&a, box, author_box(&a, 0.5, 1, 1), author_at(0.25, 0, 0), material);
    author_add_body(&a, author_sphere(&a, 0.5), author_at(3, 0.5, 0), material, "\"mass\":2");
    const gltf_double3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    author_add_body(&a, author_hull(&a, corners, 4), author_at(-3, 0.001, 0), material, "\"mass\":2");
    int upper = author_add_body(&a, author_box(&a, 0.2, 1, 0.2), author_at(0, 8, 5), material, "\"mass\":2");
    int lower = author_add_body(&a, author_box(&a, 0.2, 1, 0.2), author_at(0, 7.1, 5), material, "\"mass\":2");
    author_joint(&a, upper, lower, author_at(0, 7.5, 5), PINNED);
    author_joint(&a, AUTHOR_WORLD, upper, author_at(0, 8.5, 5), PINNED);
    author_trigger(&a, author_box(&a, 20, 20, 20), author_at(0, 0, 0));
    char *text = author_finish(&a, &size);
    assert_non_null(text);
    gltf_build_options options;
    memset(&options, 0, sizeof options);
    if (gltf_scene_load(&l->scene, text, size, NULL, &error) != GLTF_OK ||
        gltf_build(&l->scene, &options, &l->world, &error) != GLTF_OK) {
        fail_msg("%s", error.text);
    }
    free(text);
    assert_int_equal(bench_judge_open(&l->judge, &l->scene, &l->world), 0);
}

static void close_lab(lab *l) {
    bench_judge_close(&l->judge);
    gltf_world_free(&l->world);
    gltf_scene_free(&l->scene);
}

/* Moves a body of the scene from where it was put. */
static void shift(lab *l, uint32_t body, float x, float y, float z) {
    talus_pose pose = l->scene.bodies[body].pose;
    pose.position.x += x, pose.position.y += y, pose.position.z += z;
    assert_int_equal(talus_body_set_pose(&l->world.world, l->world.bodies[body], &pose), TALUS_OK);
}

static void near(double value, double wanted) {
    if (!(fabs(value - wanted) <= 2e-6)) {
        fail_msg("%.9g is not %.9g", value, wanted);
    }
}

static void overlaps_are_depths(void **state) {
    (void)state;
    lab l;
    double errors[BENCH_ERROR_COUNT];
    open_lab(&l);
    shift(&l, 0, 0, -0.004f, 0); /* both halves of the box */
    shift(&l, 1, 0, -0.03f, 0);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    assert_int_equal(l.judge.depth_count, 0);
    assert_int_equal(bench_judge_step(&l.judge, 1), 0);
    assert_int_equal(l.judge.depth_count, 3);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_OVERLAP_MOST], 0.03);
    near(l.judge.depths[0], 0.004);
    near(l.judge.depths[1], 0.004);
    shift(&l, 2, 0, -0.011f, 0); /* the hull */
    shift(&l, 0, 0, 5, 0);
    shift(&l, 1, 0, 5, 0);
    assert_int_equal(bench_judge_step(&l.judge, 1), 0);
    assert_int_equal(l.judge.depth_count, 4);
    near(l.judge.depths[3], 0.01);
    close_lab(&l);
}

static void joints_and_places(void **state) {
    (void)state;
    lab l;
    double errors[BENCH_ERROR_COUNT];
    open_lab(&l);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_APART], 0);
    near(errors[BENCH_DRIFT], 0);
    shift(&l, 4, 0.03f, 0, -0.04f);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    shift(&l, 4, 0.003f, 0, -0.004f);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_APART], 0.05);  /* the most */
    near(errors[BENCH_DRIFT], 0.005); /* the last */
    close_lab(&l);
}

/* A body of a fifth of the mass is lifted by h: all are lifted by a fifth of it. One that goes up at v could get v^2 /
 * 2 g; one that turns at w holds I w^2 / 2 more, about the box's own axis m / 6 m^2. */
static void energy_is_height(void **state) {
    (void)state;
    const double g = 9.81, kinetic = 3.0 * 3.0 / 2 / g, turning = 4.0 * 4.0 / 12 / g;
    const talus_vec3 none = {0, 0, 0}, up = {0, 3, 0}, turn = {0, 4, 0};
    lab l;
    double errors[BENCH_ERROR_COUNT];
    open_lab(&l);
    near(l.judge.weight / (10 * g), 1);
    shift(&l, 0, 0, -0.5f, 0); /* what is lost is no gain */
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_GAINED], 0);
    shift(&l, 0, 0, 0.5f, 0);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_GAINED], 0.2);
    assert_int_equal(talus_body_set_velocity(&l.world.world, l.world.bodies[0], up, turn), TALUS_OK);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_GAINED], 0.2 * (1 + kinetic + turning));
    assert_int_equal(talus_body_set_velocity(&l.world.world, l.world.bodies[0], none, none), TALUS_OK);
    assert_int_equal(bench_judge_step(&l.judge, 0), 0);
    bench_judge_errors(&l.judge, errors);
    near(errors[BENCH_GAINED], 0.2 * (1 + kinetic + turning)); /* the most */
    close_lab(&l);
}

/* --- the table --- */

static solver_table table;

static int take(void **state) {
    static const char *const names[] = {"tumbler", "masses", "bridge"};
    (void)state;
    return solver_take(&table, names, 3, 1, 0);
}

static void figures(void **state) {
    (void)state;
    assert_int_equal(table.count, 3);
    for (uint32_t i = 0; i < table.count; i++) {
        const solver_case *c = &table.cases[i];
        int tumbler = strcmp(c->scene->name, "tumbler") == 0;
        assert_true(c->rows == 5 && c->bodies > 0 && c->steps == 20);
        for (uint32_t k = 0; k < c->rows; k++) {
            const solver_row *r = &c->row[k];
            assert_true(r->ms > 0 && r->median >= r->ms && r->spread >= 0);
            assert_true(r->errors[BENCH_OVERLAP_P99] <= r->errors[BENCH_OVERLAP_MOST]);
            assert_true((r->errors[BENCH_APART] >= 0) == (c->joints > 0));
            assert_true((r->errors[BENCH_DRIFT] >= 0) == (c->scene->rests != 0));
            assert_true((r->errors[BENCH_GAINED] >= 0) == !tumbler);
            for (uint32_t other = 0; other < c->rows; other++) { /* a setting's own bits */
                assert_true(other == k || c->row[other].hash != r->hash || r->setting->build.no_kept_manifolds ||
                            c->row[other].setting->build.no_kept_manifolds);
            }
        }
        for (int e = 0; e < BENCH_ERROR_COUNT; e++) { /* the fastest, and the faster of those with the least error */
            uint32_t fast = 0, right = 0;
            for (uint32_t k = 0; k < c->rows; k++) {
                fast = c->row[k].ms < c->row[fast].ms ? k : fast;
                double less = c->row[right].errors[e] - c->row[k].errors[e];
                right = less > 0.0 || (less == 0.0 && c->row[k].ms < c->row[right].ms) ? k : right;
                assert_true(!c->row[k].front[e] || c->row[k].errors[e] >= 0);
            }
            assert_true(c->row[fast].errors[e] < 0 || c->row[fast].front[e]);
            assert_true(c->row[right].errors[e] < SOLVER_LEAST_ERROR || c->row[right].front[e]);
        }
    }
    /* what is known of them: more sub-steps hold a bridge together */
    const solver_case *bridge = &table.cases[1];
    assert_string_equal(bridge->scene->name, "bridge");
    assert_true(bridge->row[1].errors[BENCH_APART] < 0.5 * bridge->row[0].errors[BENCH_APART]);
}

static void json(void **state) {
    (void)state;
    gltf_text text = {NULL, 0, 0, 0};
    solver_json(&table, &text);
    cJSON *root = bench_parsed(&text);
    const cJSON *scene;
    uint32_t i = 0;
    cJSON_ArrayForEach(scene, cJSON_GetObjectItem(root, "scenes")) {
        const solver_case *c = &table.cases[i++];
        const cJSON *row;
        uint32_t k = 0;
        assert_string_equal(cJSON_GetObjectItem(scene, "scene")->valuestring, c->scene->name);
        cJSON_ArrayForEach(row, cJSON_GetObjectItem(scene, "rows")) {
            const solver_row *r = &c->row[k++];
            int front = 0;
            assert_true(fabs(cJSON_GetObjectItem(row, "ms")->valuedouble - r->ms) < 1e-6);
            for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
                char name[40];
                snprintf(name, sizeof name, "%s_m", solver_error_names[e]);
                const cJSON *error = cJSON_GetObjectItem(row, name);
                assert_true(r->errors[e] < 0 ? cJSON_IsNull(error)
                                             : fabs(error->valuedouble - r->errors[e]) <= 1e-4 * r->errors[e]);
                front += r->front[e];
            }
            assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(row, "front")), front);
        }
        assert_int_equal(k, c->rows);
    }
    assert_int_equal(i, table.count);
    cJSON_Delete(root);
    gltf_text_free(&text);
}

/* A dot for every row of every panel and of the legend, and no number that is none. */
static void plot(void **state) {
    (void)state;
    gltf_text text = {NULL, 0, 0, 0};
    int expected = SOLVER_SERIES_COUNT;
    solver_plot(&table, &text);
    for (uint32_t i = 0; i < table.count; i++) {
        for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
            expected += table.cases[i].row[0].errors[e] >= 0 ? (int)table.cases[i].rows : 0;
        }
    }
    assert_int_equal(bench_dots(&text), expected);
    gltf_text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(overlaps_are_depths),
                                       cmocka_unit_test(joints_and_places),
                                       cmocka_unit_test(energy_is_height),
                                       cmocka_unit_test(figures),
                                       cmocka_unit_test(json),
                                       cmocka_unit_test(plot)};
    return cmocka_run_group_tests(tests, take, NULL);
}
