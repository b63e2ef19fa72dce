/* What `talus profile` makes of frames: figures, the worst of them and why, and the files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "talus/timeline.h"
#include "talus/tool.h"

#define STEPS 40u

static char told[512]; /* what was last told of as wrong */

int tool_fail(int status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(told, sizeof told, format, arguments);
    va_end(arguments);
    return status;
}

static void figures_stand_where_they_should(void **state) {
    (void)state;
    double values[1000];
    for (int i = 0; i < 1000; i++) {
        values[i] = (double)((i * 7) % 1000 + 1);
    }
    figures f = figures_of(values, 1000);
    assert_true(f.mean == 500.5 && f.p50 == 501 && f.p95 == 951 && f.p99 == 991 && f.p999 == 1000 && f.max == 1000);
    double one = 3;
    f = figures_of(&one, 1);
    assert_true(f.mean == 3 && f.p50 == 3 && f.p999 == 3 && f.max == 3);
    f = figures_of(NULL, 0);
    assert_true(f.mean == 0 && f.max == 0);
}

/* Steps of 1 ms, 0.6 of it in narrow; step 11 meets many pairs, step 31 wakes an island, step 21 is only slow. */
static timeline made(void) {
    timeline t;
    memset(&t, 0, sizeof t);
    snprintf(t.name, sizeof t.name, "made \"so\" </script>");
    t.steps = STEPS, t.runs = 1, t.dt = 0.0625f, t.substeps = 4, t.iterations = 1, t.bodies = 50;
    t.frames = calloc(STEPS, sizeof *t.frames);
    t.run_ns = calloc(STEPS, sizeof *t.run_ns);
    t.names = calloc(2, sizeof *t.names);
    assert_true(t.frames != NULL && t.run_ns != NULL && t.names != NULL);
    t.name_count = 2;
    t.names[1] = malloc(8);
    assert_non_null(t.names[1]);
    memcpy(t.names[1], "bob", 4);
    for (uint32_t i = 0; i < STEPS; i++) {
        talus_frame *f = &t.frames[i];
        f->time.stage[TALUS_STAGE_NARROW] = i == 10 ? 2600000 : 600000 + i;
        f->time.stage[TALUS_STAGE_SOLVE] = i == 30 ? 3400000 : i == 20 ? 2400000 : 400000;
        f->time.total = f->time.stage[TALUS_STAGE_NARROW] + f->time.stage[TALUS_STAGE_SOLVE];
        f->counters.manifolds_made = i == 10 ? 412 : 35;
        f->counters.manifolds_first = i == 10 ? 1 : 0;
        f->counters.contacts_touching = i == 30 ? 900 : 100;
        f->counters.islands_woken = i == 30, f->counters.bodies_woken = i == 30 ? 300 : 0;
        f->islands = 3, f->largest_count = 1;
        f->largest[0].body.index = 1, f->largest[0].bodies = 20, f->largest[0].contacts = 60;
        f->largest[0].held = 9;
        f->largest[0].ticks = f->time.total / 2;
        t.run_ns[i] = f->time.total;
    }
    return t;
}

static void says_why(void **state) {
    (void)state;
    timeline t = made();
    talus_frame median;
    uint32_t worst[5];
    timeline_median(&t, &median);
    assert_int_equal(median.counters.manifolds_made, 35);
    assert_int_equal(timeline_worst(&t, worst, 5), 5);
    assert_true(worst[0] == 30 && worst[1] == 20 && worst[2] == 10 && worst[3] == 39 && worst[4] == 38);
    assert_int_equal(timeline_over(&t, 2.5), 3);
    assert_int_equal(timeline_over(&t, 3.5), 1);
    assert_int_equal(timeline_over(&t, 5), 0);
    const char *expected[] = {
        "solve 3.400 ms (median 0.400) for 900 contacts solved (100); 1 island of 300 bodies woke; ",
        "solve 2.400 ms (median 0.400) for no more than usual; ",
        "narrow 2.600 ms (median 0.600) for 412 manifolds computed (35), 1 of a new pair (0); ",
        "as the median frame; "};
    for (int i = 0; i < 4; i++) {
        gltf_text text = {NULL, 0, 0, 0};
        timeline_explain(&t, &median, worst[i], &text);
        assert_memory_equal(text.data, expected[i], strlen(expected[i]));
        assert_non_null(strstr(text.data,
                               "the largest of 3 islands, around bob (held by 9): 20 bodies, 60 contacts, 0 joints, "
                               "50 % of the step"));
        gltf_text_free(&text);
    }
    timeline_free(&t);
}

static uint32_t lines_of(const char *text) {
    uint32_t lines = 0;
    for (; *text; text++) {
        lines += *text == '\n';
    }
    return lines;
}

static void draws(void **state) {
    (void)state;
    timeline t = made();
    for (int budget = 0; budget < 2; budget++) {
        gltf_text text = {NULL, 0, 0, 0};
        uint32_t lines = 0;
        timeline_draw(&t, 0, 10, budget ? 2.0 : 0.0, &text, &lines);
        assert_int_equal(lines, lines_of(text.data));
        assert_non_null(strstr(text.data, "run 1 of 1, step 11 of 40"));
        assert_true((strstr(text.data, "1 of 11 go over") != NULL) == budget);
        gltf_text_free(&text);
        timeline_print(&t, budget ? 2.0 : 0.0, &text);
        assert_non_null(strstr(text.data, "step 31, 4.0000 ms: solve"));
        assert_true((strstr(text.data, "3 of 40 go over") != NULL) == budget);
        assert_true((strstr(text.data, "island around bob (held by 9): 20 bodies, 60 contacts") != NULL) == budget);
        gltf_text_free(&text);
    }
    timeline_free(&t);
}

static double number(const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static void writes_json(void **state) {
    (void)state;
    timeline t = made();
    gltf_text text = {NULL, 0, 0, 0};
    timeline_json(&t, 2.0, &text);
    cJSON *json = cJSON_Parse(text.data);
    assert_non_null(json);
    assert_string_equal(cJSON_GetObjectItem(json, "scene")->valuestring, t.name);
    const cJSON *ms = cJSON_GetObjectItem(json, "ms"), *frames = cJSON_GetObjectItem(json, "frames");
    assert_true(number(ms, "max") == 4.00003 && number(ms, "p999") == 4.00003);
    assert_int_equal(cJSON_GetArraySize(frames), STEPS);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "over")), 3);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "worst")), TIMELINE_WORST);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "run_ns")), 1);
    const cJSON *frame = cJSON_GetArrayItem(frames, 30);
    assert_true(number(frame, "ns") == 4000030.0);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(frame, "stages")), TALUS_STAGE_COUNT);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(frame, "counts")), timeline_count_count);
    cJSON_Delete(json);
    gltf_text_free(&text);
    timeline_free(&t);
}

static void writes_rows(void **state) {
    (void)state;
    timeline t = made();
    gltf_text text = {NULL, 0, 0, 0};
    timeline_csv(&t, &text);
    assert_int_equal(lines_of(text.data), STEPS + 1);
    uint32_t columns = 1;
    for (const char *c = text.data; *c; c++) {
        columns += *c == ',';
        if (*c == '\n') {
            assert_int_equal(columns, 2 + TALUS_STAGE_COUNT + timeline_count_count);
            columns = 1;
        }
    }
    gltf_text_free(&text);
    timeline_free(&t);
}

static void writes_trace_events(void **state) {
    (void)state;
    timeline t = made();
    gltf_text text = {NULL, 0, 0, 0};
    timeline_trace(&t, &text);
    cJSON *json = cJSON_Parse(text.data);
    assert_non_null(json);
    const cJSON *event;
    uint32_t frames = 0, stages = 0, counters = 0;
    double end = 0;
    cJSON_ArrayForEach(event, cJSON_GetObjectItem(json, "traceEvents")) {
        const char *phase = cJSON_GetObjectItem(event, "ph")->valuestring;
        if (phase[0] == 'X' && strcmp(cJSON_GetObjectItem(event, "cat")->valuestring, "frame") == 0) {
            assert_true(number(event, "ts") >= end - 1e-6);
            end = number(event, "ts") + number(event, "dur");
            frames++;
        } else if (phase[0] == 'X') {
            assert_true(number(event, "ts") + number(event, "dur") <= end + 1e-6); /* within its frame */
            stages++;
        }
        counters += phase[0] == 'C';
    }
    assert_int_equal(frames, STEPS);
    assert_int_equal(stages, 2 * STEPS);
    assert_int_equal(counters, 4 * STEPS);
    cJSON_Delete(json);
    gltf_text_free(&text);
    timeline_free(&t);
}

static void the_page_holds_the_data(void **state) {
    (void)state;
    timeline t = made();
    gltf_text text = {NULL, 0, 0, 0};
    timeline_html(&t, 0, &text);
    const char *data = strstr(text.data, "application/json\" id=\"data\">");
    assert_non_null(data);
    const char *close = strstr(data, "</script>"); /* the page's own: the scene's name has one too */
    assert_non_null(close);
    size_t size = (size_t)(close - strchr(data, '>')) - 1;
    cJSON *json = cJSON_ParseWithLength(strchr(data, '>') + 1, size);
    assert_non_null(json);
    assert_string_equal(cJSON_GetObjectItem(json, "scene")->valuestring, t.name);
    cJSON_Delete(json);
    gltf_text_free(&text);
    timeline_free(&t);
}

static void takes_the_least(void **state) {
    (void)state;
    gltf_build_options options;
    profile_source source;
    timeline t;
    memset(&options, 0, sizeof options);
    options.isa = TALUS_ISA_SCALAR;
    assert_int_equal(profile_open_scene(&source, "@stack", &options, 30), 0);
    assert_int_equal(timeline_take(&t, &source, 3, NULL, NULL), 0);
    assert_int_equal(t.steps, 30);
    assert_true(t.isa == TALUS_ISA_SCALAR && t.hash != 0);
    for (uint32_t i = 0; i < t.steps; i++) {
        uint64_t least = UINT64_MAX, stages = 0;
        for (uint32_t run = 0; run < 3; run++) {
            uint64_t ns = t.run_ns[run * t.steps + i];
            least = ns < least ? ns : least;
        }
        for (int k = 0; k < TALUS_STAGE_COUNT; k++) {
            stages += t.frames[i].time.stage[k];
        }
        assert_true(t.frames[i].time.total == least && stages <= least && stages > 0);
        assert_true(t.frames[i].step == i + 1 && t.frames[i].counters.awake_bodies == 20);
    }
    assert_string_not_equal(timeline_name(&t, t.frames[29].largest[0].body.index), "a body");
    source.close(&source);
    timeline_free(&t);
}

/* A source whose second run is another one. */
static profile_source inner;
static int odd_runs;
static int odd_begin(profile_source *source) {
    int status = inner.begin(&inner);
    source->world = inner.world;
    if (odd_runs++ == 1) {
        talus_vec3 up = {0, 1, 0};
        talus_world_set_gravity(source->world, up);
    }
    return status;
}
static int odd_step(profile_source *source, const talus_clock *clock) {
    (void)source;
    return inner.step(&inner, clock);
}
static void odd_end(profile_source *source) {
    (void)source;
    inner.end(&inner);
}

static void sees_runs_that_differ(void **state) {
    (void)state;
    gltf_build_options options;
    timeline t;
    memset(&options, 0, sizeof options);
    assert_int_equal(profile_open_scene(&inner, "@stack", &options, 5), 0);
    profile_source odd = inner;
    odd.begin = odd_begin, odd.step = odd_step, odd.end = odd_end;
    assert_int_equal(timeline_take(&t, &odd, 3, NULL, NULL), GLTF_FAILED);
    assert_non_null(strstr(told, "not identical"));
    timeline_free(&t);
    inner.close(&inner);
    assert_int_equal(profile_open_scene(&inner, "@no such scene", &options, 5), TOOL_USAGE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_stand_where_they_should),
        cmocka_unit_test(says_why),
        cmocka_unit_test(draws),
        cmocka_unit_test(writes_json),
        cmocka_unit_test(writes_rows),
        cmocka_unit_test(writes_trace_events),
        cmocka_unit_test(the_page_holds_the_data),
        cmocka_unit_test(takes_the_least),
        cmocka_unit_test(sees_runs_that_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
