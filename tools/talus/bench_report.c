/* The table of `talus bench queries` for people and as JSON. */
#include "bench_queries.h"

#include <inttypes.h>
#include <stdio.h>

static void angle_text(double degrees, char *out, size_t size) {
    if (degrees == BENCH_RANDOM) {
        snprintf(out, size, "random");
    } else {
        snprintf(out, size, "%g deg", degrees);
    }
}

/* Times of all vertex counts side by side: a row a method and angle, as they came. */
static void print_half(const bench_table *t, int overlapping, gltf_text *out) {
    static const char *const titles[2] = {"Distance of hulls apart: ns a query",
                                          "Depth of hulls in overlap: ns a query"};
    uint32_t vertices[BENCH_MOST_ROWS], count = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        if (count == 0 || vertices[count - 1u] != t->rows[i].vertices) {
            vertices[count++] = t->rows[i].vertices;
        }
    }
    gltf_text_add(out, "%s (the least of %" PRIu32 " runs)\n\n%-20s %-9s", titles[overlapping], t->runs, "vertices",
                  "");
    for (uint32_t v = 0; v < count; v++) {
        gltf_text_add(out, " %9" PRIu32, vertices[v]);
    }
    gltf_text_add(out, "  error: mean      most\n");
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_row *first = &t->rows[i];
        double mean = 0.0, most = 0.0;
        char angle[32];
        int cells = 0;
        if (first->vertices != vertices[0] || first->method->overlapping != overlapping) {
            continue;
        }
        angle_text(first->degrees, angle, sizeof angle);
        gltf_text_add(out, "%-20s %-9s", first->method->label, angle);
        for (uint32_t v = 0, k = i; v < count; v++) {
            while (k < t->count && (t->rows[k].vertices != vertices[v] || t->rows[k].method != first->method ||
                                    t->rows[k].degrees != first->degrees)) {
                k++;
            }
            if (k == t->count) {
                gltf_text_add(out, " %9s", "-");
                k = i;
                continue;
            }
            gltf_text_add(out, " %9.0f", t->rows[k].least);
            mean += t->rows[k].mean_error;
            most = t->rows[k].most_error > most ? t->rows[k].most_error : most;
            cells++;
        }
        gltf_text_add(out, "  %11.1e %9.1e\n", mean / (double)cells, most);
    }
    gltf_text_add(out, "\n");
}

void bench_print(const bench_table *t, gltf_text *out) {
    print_half(t, 0, out);
    print_half(t, 1, out);
    gltf_text_add(out,
                  "Errors are relative, against double precision, over all vertex counts; of libccd's GJK, which only\n"
                  "says whether hulls touch, the share of wrong answers.%s\n",
                  bench_ccd_count ? "" : " The tool was built without libccd: its rows are missing.");
    gltf_text_add(out, "\n");
    bench_world_print(&t->world, out);
}

void bench_json(const bench_table *t, gltf_text *out) {
    gltf_text_add(out, "{\"bench\":\"queries\",\"runs\":%" PRIu32 ",\"libccd\":%s,\"rows\":[", t->runs,
                  bench_ccd_count ? "true" : "false");
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_row *r = &t->rows[i];
        gltf_text_add(out, "%s{\"query\":\"%s\",\"method\":\"%s\",\"vertices\":%" PRIu32 ",\"degrees\":", i ? "," : "",
                      r->method->overlapping ? "depth" : "distance", r->method->name, r->vertices);
        if (r->degrees == BENCH_RANDOM) {
            gltf_text_add(out, "null");
        } else {
            gltf_text_add(out, "%g", r->degrees);
        }
        gltf_text_add(out,
                      ",\"queries\":%" PRIu32
                      ",\"ns\":%.1f,\"ns_median\":%.1f,\"ns_spread\":%.1f,\"error_mean\":%.3e,\"error_most\":%.3e}",
                      r->queries, r->least, r->median, r->spread, r->mean_error, r->most_error);
    }
    gltf_text_add(out, "],");
    bench_world_json(&t->world, out);
    gltf_text_add(out, "}\n");
}
