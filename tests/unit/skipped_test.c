/* What `talus run` says was not needed, of scenes of which it is known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gltf/author.h"
#include "gltf/build.h"
#include "talus/scene_parts.h"
#include "talus/skipped.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 60u

/* Runs what was put together and takes what its steps did without. */
static skipped run(author *a, float flown) {
    gltf_scene scene;
    gltf_world world;
    gltf_error error;
    gltf_build_options options;
    skipped s;
    size_t size = 0;
    char *text = author_finish(a, &size);
    memset(&s, 0, sizeof s);
    memset(&options, 0, sizeof options);
    if (gltf_scene_load(&scene, text, size, NULL, &error) != GLTF_OK ||
        gltf_build(&scene, &options, &world, &error) != GLTF_OK) {
        fail_msg("%s", error.text);
    }
    for (uint32_t i = 0; i < STEPS; i++) {
        talus_counters c;
        assert_int_equal(talus_world_step(&world.world, scene.dt, NULL, NULL), TALUS_OK);
        assert_int_equal(talus_world_get_counters(&world.world, &c), TALUS_OK);
        skipped_take(&s, &scene, &c, flown, 0.02f);
    }
    assert_int_equal(s.steps, STEPS);
    free(text);
    gltf_world_free(&world);
    gltf_scene_free(&scene);
    return s;
}

/* A ground and a box at rest on it, which falls asleep after half a second. */
static author box_on_ground(double restitution) {
    author a;
    author_open(&a, "skipped", STEPS);
    int material = author_material(&a, 0.5, restitution, NULL);
    parts_ground(&a, 20, material);
    author_add_body(&a, author_box(&a, 1, 1, 1), author_at(0, 0.5, 0), material, NULL);
    return a;
}

static void a_box_needs_little(void **state) {
    (void)state;
    author a = box_on_ground(0);
    skipped s = run(&a, 0.0f);
    const skipped_part none[] = {SKIPPED_JOINTS, SKIPPED_LINKAGES,   SKIPPED_RESTITUTION, SKIPPED_ROLLING,
                                 SKIPPED_FAST,   SKIPPED_KINEMATICS, SKIPPED_SENSORS,     SKIPPED_EVENTS};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        assert_int_equal(s.without[none[i]], STEPS);
    }
    assert_int_equal(s.without[SKIPPED_PAIRS], STEPS - 1);
    assert_int_equal(s.static_body_steps, STEPS);
    assert_int_equal(s.body_steps, STEPS);
    assert_in_range(s.sleeping_body_steps, STEPS - 40, STEPS - 25); /* half a second and what it takes to settle */
    assert_int_equal(s.without[SKIPPED_CONTACTS], s.sleeping_body_steps - 1); /* it falls asleep after its last step */
}

static void what_is_there_is_done(void **state) {
    (void)state;
    author a = box_on_ground(0.5);
    author_trigger(&a, author_box(&a, 1, 1, 1), author_at(0, 1, 0));
    int swinging = author_add_body(&a, author_box(&a, 1, 1, 1), author_at(5, 5, 0), 0, NULL);
    author_joint(&a, AUTHOR_WORLD, swinging, author_at(4, 5, 0), PARTS_LIMITS(PARTS_PINNED));
    int drum = author_add_compound(&a, author_at(-5, 5, 0), "\"isKinematic\":true,\"angularVelocity\":[0,1,0]");
    author_add_part(&a, drum, author_box(&a, 1, 1, 1), author_at(0, 0, 0), 0);
    skipped s = run(&a, 0.03f);
    assert_int_equal(s.without[SKIPPED_JOINTS], 0);
    assert_int_equal(s.without[SKIPPED_PUSHES], 0);
    assert_int_equal(s.without[SKIPPED_LINKAGES], STEPS); /* a single joint is none */
    assert_true(s.without[SKIPPED_RESTITUTION] < STEPS && s.without[SKIPPED_EVENTS] < STEPS);
    assert_int_equal(s.without[SKIPPED_FAST], 0);
    assert_int_equal(s.without[SKIPPED_KINEMATICS], 0);
    assert_int_equal(s.without[SKIPPED_SENSORS], 0);
    assert_int_equal(s.without[SKIPPED_ROLLING], STEPS);
    assert_int_equal(s.static_body_steps, 2 * STEPS);
    assert_int_equal(s.body_steps, 3 * STEPS);
}

/* A part is named where it should be, and only there. */
static void told(void **state) {
    (void)state;
    skipped s;
    memset(&s, 0, sizeof s);
    s.steps = 10;
    s.without[SKIPPED_JOINTS] = 10;
    s.without[SKIPPED_ROLLING] = 10;
    s.without[SKIPPED_EVENTS] = 7;
    gltf_text text = {NULL, 0, 0, 0};
    skipped_print(&s, &text);
    assert_string_equal(text.data,
                        "  in no step         joints, rolling resistance\n  in some steps only events (3)\n");
    gltf_text_free(&text);
    gltf_text_add(&text, "{\"a\":0");
    skipped_json(&s, &text);
    gltf_text_add(&text, "}");
    cJSON *root = cJSON_Parse(text.data);
    assert_non_null(root);
    const cJSON *needless = cJSON_GetObjectItem(root, "not_needed");
    const cJSON *without = cJSON_GetObjectItem(root, "steps_without");
    assert_int_equal(cJSON_GetArraySize(needless), 2);
    assert_string_equal(cJSON_GetArrayItem(needless, 0)->valuestring, "joints");
    assert_string_equal(cJSON_GetArrayItem(needless, 1)->valuestring, "rolling");
    assert_int_equal(cJSON_GetArraySize(without), SKIPPED_COUNT);
    for (int i = 0; i < SKIPPED_COUNT; i++) {
        assert_int_equal(cJSON_GetObjectItem(without, skipped_names[i])->valueint, (int)s.without[i]);
    }
    cJSON_Delete(root);
    gltf_text_free(&text);
    memset(&s, 0, sizeof s);
    skipped_json(&s, &text); /* no steps: nothing can be said not to be needed */
    assert_non_null(strstr(text.data, "\"not_needed\":[]"));
    gltf_text_free(&text);
}

/* All of them, in lines that a terminal has room for. */
static void lines_are_short(void **state) {
    (void)state;
    skipped s;
    memset(&s, 0, sizeof s);
    s.steps = 1;
    for (int i = 0; i < SKIPPED_COUNT; i++) {
        s.without[i] = 1;
    }
    gltf_text text = {NULL, 0, 0, 0};
    skipped_print(&s, &text);
    for (const char *line = text.data; *line != 0; line = strchr(line, '\n') + 1) {
        assert_true(strchr(line, '\n') - line <= 118);
    }
    gltf_text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_box_needs_little), cmocka_unit_test(what_is_there_is_done),
                                       cmocka_unit_test(told), cmocka_unit_test(lines_are_short)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
