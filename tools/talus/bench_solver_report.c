/* The table of `talus bench solver` for people and as JSON. */
#include "bench_solver.h"

#include <inttypes.h>

static void print_case(const solver_case *c, gltf_text *out) {
    static const char *const titles[BENCH_ERROR_COUNT] = {"overlap p99", "most", "joints apart", "drift",
                                                          "energy gained"};
    gltf_text_add(out, "%s: %" PRIu32 " bodies, %" PRIu32 " joints, %" PRIu32 " steps of %g s\n", c->scene->name,
                  c->bodies, c->joints, c->steps, (double)c->dt);
    gltf_text_add(out, "  %-22s %9s %9s %9s", "", "ms a step", "median", "spread");
    for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
        gltf_text_add(out, " %14s", titles[e]);
    }
    gltf_text_add(out, "\n");
    for (uint32_t i = 0; i < c->rows; i++) {
        const solver_row *r = &c->row[i];
        gltf_text_add(out, "  %-22s %9.4f %9.4f %9.4f", r->setting->name, r->ms, r->median, r->spread);
        for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
            if (r->errors[e] < 0) {
                gltf_text_add(out, " %13s ", "-");
            } else {
                gltf_text_add(out, " %13.4f%s", 1e3 * r->errors[e], r->front[e] ? "*" : " ");
            }
        }
        gltf_text_add(out, "\n");
    }
    gltf_text_add(out, "\n");
}

void solver_print(const solver_table *t, gltf_text *out) {
    for (uint32_t i = 0; i < t->count; i++) {
        print_case(&t->cases[i], out);
    }
    gltf_text_add(out,
                  "Times: of each step the least of %" PRIu32
                  " runs, their mean; median and spread between quartiles are "
                  "those\nof the runs. Errors in mm; of energy gained, how high it would lift all bodies. * no other "
                  "setting\nis as fast with less of it. Sleep is off.\n",
                  t->runs);
}

static void add_row(const solver_row *r, gltf_text *out) {
    const gltf_build_options *b = &r->setting->build;
    talus_world_def def = talus_world_def_default();
    int count = 0;
    gltf_text_add(out, "{\"setting\":");
    gltf_text_quoted(out, r->setting->name);
    gltf_text_add(out,
                  ",\"series\":\"%s\",\"substeps\":%" PRIu32 ",\"iterations\":%" PRIu32
                  ",\"error_budget_m\":%g,\"contact_hertz\":%g,\"manifolds_kept\":%s",
                  solver_series_names[r->setting->series], b->substeps, b->iterations, (double)b->error_budget,
                  (double)(b->contact_hertz > 0 ? b->contact_hertz : def.contact_hertz),
                  b->no_kept_manifolds ? "false" : "true");
    gltf_text_add(out, ",\"ms\":%.6f,\"ms_median\":%.6f,\"ms_spread\":%.6f", r->ms, r->median, r->spread);
    for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
        if (r->errors[e] < 0) {
            gltf_text_add(out, ",\"%s_m\":null", solver_error_names[e]);
        } else {
            gltf_text_add(out, ",\"%s_m\":%.4e", solver_error_names[e], r->errors[e]);
        }
    }
    gltf_text_add(out, ",\"front\":[");
    for (int e = 0; e < BENCH_ERROR_COUNT; e++) {
        if (r->front[e]) {
            gltf_text_add(out, "%s\"%s\"", count++ > 0 ? "," : "", solver_error_names[e]);
        }
    }
    gltf_text_add(out, "],\"world_hash\":\"%016" PRIx64 "\"}", r->hash);
}

void solver_json(const solver_table *t, gltf_text *out) {
    gltf_text_add(out, "{\"bench\":\"solver\",\"runs\":%" PRIu32 ",\"scenes\":[", t->runs);
    for (uint32_t i = 0; i < t->count; i++) {
        const solver_case *c = &t->cases[i];
        gltf_text_add(out,
                      "%s{\"scene\":\"%s\",\"bodies\":%" PRIu32 ",\"joints\":%" PRIu32 ",\"steps\":%" PRIu32
                      ",\"dt\":%.9g,\"rows\":[",
                      i > 0 ? "," : "", c->scene->name, c->bodies, c->joints, c->steps, (double)c->dt);
        for (uint32_t k = 0; k < c->rows; k++) {
            gltf_text_add(out, "%s", k > 0 ? "," : "");
            add_row(&c->row[k], out);
        }
        gltf_text_add(out, "]}");
    }
    gltf_text_add(out, "]}\n");
}
