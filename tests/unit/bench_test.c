/* `talus bench queries --quick`: every method is there and right to its bar, and what is written can be read. */
#include "bench_kit.h"

#include "talus/bench_queries.h"

#include <math.h>
#include <string.h>

static bench_table table;

static int take(void **state) {
    (void)state;
    return bench_take(&table, 1, 0);
}

/* The largest relative error that a method may have. */
static double bar(const bench_method *m) {
    if (strncmp(m->name, "ccd-", 4) == 0) {
        return m->yes_or_no ? 0.0 : 1.0; /* its depths are what they are */
    }
    return strcmp(m->name, "gauss-walk") == 0 ? 1.0 : strcmp(m->name, "epa") == 0 ? 1e-3 : 1e-6;
}

static void figures(void **state) {
    (void)state;
    assert_true(table.count > 0);
    for (int k = 0; k < bench_own_count + bench_ccd_count; k++) {
        const bench_method *m = k < bench_own_count ? &bench_own_methods[k] : &bench_ccd_methods[k - bench_own_count];
        int rows = 0;
        for (uint32_t i = 0; i < table.count; i++) {
            const bench_row *r = &table.rows[i];
            if (r->method != m) {
                continue;
            }
            rows++;
            assert_true(r->least > 0.0 && r->median >= r->least && r->spread >= 0.0 && r->queries > 0);
            assert_true(r->mean_error >= 0.0 && r->mean_error <= r->most_error);
            if (!(r->most_error <= bar(m))) {
                fail_msg("%s of %u vertices is off by %g", m->name, (unsigned)r->vertices, r->most_error);
            }
            /* cold, the walk begins where the expanding polytope found the least */
            assert_true(strcmp(m->name, "gauss-walk") != 0 || r->degrees != BENCH_RANDOM || r->most_error < 1e-6);
        }
        assert_int_equal(rows, 4);
    }
}

/* Of a pile: found is what looking at each box finds; casts end a millimetre's gap early, which slants along the way.
 */
static void world(void **state) {
    (void)state;
    const bench_world_table *w = &table.world;
    assert_int_equal(w->count, BENCH_WORLD_ROWS);
    for (uint32_t i = 0; i < w->count; i++) {
        const bench_world_row *r = &w->rows[i];
        assert_true(r->least > 0.0 && r->median >= r->least && r->spread >= 0.0 && r->found > 0.05);
        if (r->wrong > 0.0 || r->most_error > (strncmp(r->name, "cast-", 5) == 0 ? 5e-3 : 1e-6)) {
            fail_msg("%s: %g wrong, off by %g", r->name, r->wrong, r->most_error);
        }
    }
}

static void json(void **state) {
    (void)state;
    gltf_text text = {NULL, 0, 0, 0};
    bench_json(&table, &text);
    cJSON *root = bench_parsed(&text);
    const cJSON *rows = cJSON_GetObjectItem(root, "rows"), *row;
    assert_int_equal((unsigned)cJSON_GetArraySize(rows), table.count);
    uint32_t i = 0;
    cJSON_ArrayForEach(row, rows) {
        const cJSON *ns = cJSON_GetObjectItem(row, "ns"), *name = cJSON_GetObjectItem(row, "method");
        assert_true(cJSON_IsNumber(ns) && fabs(ns->valuedouble - table.rows[i].least) <= 0.06);
        assert_string_equal(name->valuestring, table.rows[i].method->name);
        i++;
    }
    const cJSON *asked = cJSON_GetObjectItem(root, "world");
    assert_int_equal(cJSON_GetObjectItem(asked, "boxes")->valueint, 100);
    i = 0;
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(asked, "rows")) {
        assert_string_equal(cJSON_GetObjectItem(row, "query")->valuestring, table.world.rows[i].name);
        assert_true(fabs(cJSON_GetObjectItem(row, "ns")->valuedouble - table.world.rows[i].least) <= 0.06);
        i++;
    }
    assert_int_equal(i, BENCH_WORLD_ROWS);
    cJSON_Delete(root);
    gltf_text_free(&text);
}

/* As many dots as the four panels have rows and their legend names, and no number that is none. */
static void plot(void **state) {
    (void)state;
    gltf_text text = {NULL, 0, 0, 0};
    int expected = 0;
    bench_plot(&table, &text);
    for (uint32_t i = 0; i < table.count; i++) {
        expected += table.rows[i].degrees == 1.0;
        expected += table.rows[i].vertices == 50 && !table.rows[i].method->yes_or_no;
    }
    assert_int_equal(bench_dots(&text), expected + bench_own_count + bench_ccd_count);
    gltf_text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(figures), cmocka_unit_test(world), cmocka_unit_test(json),
                                       cmocka_unit_test(plot)};
    return cmocka_run_group_tests(tests, take, NULL);
}
