/* `talus bench features`: what is added is there and idle, and the table says so. */
#include "bench_kit.h"

#include "talus/bench_features.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BOXES 40u
#define STEPS 5

static talus_counters step(const feature *f, int with, void **memory) {
    feature_scene small = feature_scenes[0];
    talus_world world;
    talus_counters c;
    small.bodies = BOXES;
    assert_int_equal(feature_make(&small, f, with, 3, &world, memory), 0);
    for (int i = 0; i < STEPS; i++) {
        assert_int_equal(talus_world_step(&world, 1.0f / 60.0f, NULL, NULL), TALUS_OK);
    }
    assert_int_equal(talus_world_get_counters(&world, &c), TALUS_OK);
    return c;
}

/* The steps do what they do without it, and it is there. */
static void features_are_idle(void **state) {
    (void)state;
    for (uint32_t i = 0; i < feature_count; i++) {
        const feature *f = &features[i];
        void *memory[2];
        talus_counters without = step(f, 0, &memory[0]), with = step(f, 1, &memory[1]);
        assert_int_equal(without.awake_bodies, BOXES);
        assert_int_equal(with.awake_bodies, BOXES);
        assert_int_equal(with.manifolds_made, without.manifolds_made);
        assert_int_equal(with.contacts_touching, without.contacts_touching);
        assert_true(without.contacts_touching >= BOXES);
        assert_true(with.joints_solved == 0 && with.linkages == 0 && with.restitution_skipped && with.rolling_skipped);
        assert_int_equal(with.bodies.used - without.bodies.used, f->add != NULL ? 100 : 0);
        uint32_t joints = strcmp(f->name, "joints") == 0 ? 50 : strcmp(f->name, "linkages") == 0 ? 95 : 0;
        assert_int_equal(with.joints.used, joints);
        assert_int_equal(with.joints_sleeping, joints);
        assert_int_equal(with.bodies.capacity > without.bodies.capacity, strcmp(f->name, "room") == 0);
        free(memory[0]);
        free(memory[1]);
    }
}

static void table(void **state) {
    (void)state;
    static feature_table t;
    const char *const names[] = {"joints", "profiler"};
    gltf_text text = {NULL, 0, 0, 0};
    assert_int_equal(features_take(&t, names, 2, 1, 0), 0);
    assert_int_equal(t.count, 2 * feature_scene_count);
    features_json(&t, &text);
    cJSON *root = bench_parsed(&text);
    const cJSON *row;
    uint32_t i = 0;
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(root, "rows")) {
        const feature_row *r = &t.rows[i];
        assert_string_equal(cJSON_GetObjectItem(row, "feature")->valuestring, names[i / feature_scene_count]);
        assert_string_equal(cJSON_GetObjectItem(row, "scene")->valuestring,
                            feature_scenes[i % feature_scene_count].name);
        assert_true(r->without > 0 && r->with > 0 && r->low > 0 && r->low <= r->ratio && r->ratio <= r->high);
        assert_true(!r->over); /* a single pair of runs has no verdict */
        assert_true(fabs(cJSON_GetObjectItem(row, "ratio")->valuedouble - r->ratio) < 1e-6);
        i++;
    }
    assert_int_equal(i, t.count);
    cJSON_Delete(root);
    gltf_text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(features_are_idle), cmocka_unit_test(table)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
