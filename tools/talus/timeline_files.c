/* Timelines for programs: JSON, CSV, trace events, and the page. */
#include "timeline.h"

#include "profile_page.h"
#include "talus/version.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static void add_figures(gltf_text *out, const figures *f) {
    gltf_text_add(out, "\"mean\":%.9g,\"p50\":%.9g,\"p95\":%.9g,\"p99\":%.9g,\"p999\":%.9g,\"max\":%.9g", f->mean,
                  f->p50, f->p95, f->p99, f->p999, f->max);
}

static void add_frame(const timeline *t, const talus_frame *f, gltf_text *out) {
    gltf_text_add(out, "{\"ns\":%" PRIu64 ",\"stages\":[", f->time.total);
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        gltf_text_add(out, "%s%" PRIu64, i == 0 ? "" : ",", f->time.stage[i]);
    }
    gltf_text_add(out, "],\"counts\":[");
    for (uint32_t c = 0; c < timeline_count_count; c++) {
        gltf_text_add(out, "%s%" PRIu32, c == 0 ? "" : ",", timeline_counted(f, c));
    }
    gltf_text_add(out, "],\"islands\":[");
    for (uint32_t i = 0; i < f->largest_count; i++) {
        const talus_frame_island *island = &f->largest[i];
        gltf_text_add(out, "%s{\"body\":", i == 0 ? "" : ",");
        gltf_text_quoted(out, timeline_name(t, island->body.index));
        gltf_text_add(out,
                      ",\"held\":%" PRIu32 ",\"bodies\":%" PRIu32 ",\"contacts\":%" PRIu32 ",\"joints\":%" PRIu32
                      ",\"rows\":%" PRIu32 ",\"ns\":%" PRIu64 "}",
                      island->held, island->bodies, island->contacts, island->joints, island->rows, island->ticks);
    }
    gltf_text_add(out, "]}");
}

static void add_worst(const timeline *t, const talus_frame *median, gltf_text *out) {
    uint32_t steps[TIMELINE_WORST], count = timeline_worst(t, steps, TIMELINE_WORST);
    gltf_text_add(out, ",\"worst\":[");
    for (uint32_t i = 0; i < count; i++) {
        gltf_text why = {NULL, 0, 0, 0};
        timeline_explain(t, median, steps[i], &why);
        gltf_text_add(out, "%s{\"step\":%" PRIu32 ",\"ns\":%" PRIu64 ",\"why\":", i == 0 ? "" : ",", steps[i] + 1,
                      t->frames[steps[i]].time.total);
        gltf_text_quoted(out, why.data != NULL ? why.data : "");
        gltf_text_add(out, "}");
        gltf_text_free(&why);
    }
    gltf_text_add(out, "]");
}

static void add_over(const timeline *t, double budget_ms, gltf_text *out) {
    uint32_t count = 0;
    gltf_text_add(out, ",\"budget_ms\":%.9g,\"over\":[", budget_ms);
    for (uint32_t i = 0; i < t->steps; i++) {
        if ((double)t->frames[i].time.total * 1e-6 > budget_ms) {
            gltf_text_add(out, "%s%" PRIu32, count++ == 0 ? "" : ",", i + 1);
        }
    }
    gltf_text_add(out, "]");
}

static void add_stages(const timeline *t, gltf_text *out) {
    gltf_text_add(out, ",\"stages\":[");
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        figures f = timeline_figures(t, i);
        gltf_text_add(out, "%s{\"name\":\"%s\",", i == 0 ? "" : ",", talus_stage_name((talus_stage)i));
        add_figures(out, &f);
        gltf_text_add(out, "}");
    }
    gltf_text_add(out, "],\"counts\":[");
    for (uint32_t c = 0; c < timeline_count_count; c++) {
        gltf_text_add(out, "%s\"%s\"", c == 0 ? "" : ",", timeline_counts[c].name);
    }
    gltf_text_add(out, "]");
}

void timeline_json(const timeline *t, double budget_ms, gltf_text *out) {
    talus_frame median;
    timeline_median(t, &median);
    gltf_text_add(out, "{\"engine\":\"talus\",\"version\":\"%s\",\"report\":\"profile\",\"scene\":", TALUS_VERSION);
    gltf_text_quoted(out, t->name);
    gltf_text_add(out,
                  ",\"bodies\":%" PRIu32 ",\"shapes\":%" PRIu32 ",\"joints\":%" PRIu32 ",\"steps\":%" PRIu32
                  ",\"dt\":%.9g,\"substeps\":%" PRIu32 ",\"iterations\":%" PRIu32 ",\"sleep\":%s,\"isa\":\"%s\"",
                  t->bodies, t->shapes, t->joints, t->steps, (double)t->dt, t->substeps, t->iterations,
                  t->sleep ? "true" : "false", talus_isa_name(t->isa));
    gltf_text_add(out, ",\"runs\":%" PRIu32 ",\"world_hash\":\"%016" PRIx64 "\",\"ms\":{", t->runs, t->hash);
    figures whole = timeline_figures(t, TALUS_STAGE_COUNT);
    add_figures(out, &whole);
    gltf_text_add(out, "}");
    if (budget_ms > 0) {
        add_over(t, budget_ms, out);
    }
    add_stages(t, out);
    gltf_text_add(out, ",\"median\":");
    add_frame(t, &median, out);
    add_worst(t, &median, out);
    gltf_text_add(out, ",\"frames\":[");
    for (uint32_t i = 0; i < t->steps; i++) {
        gltf_text_add(out, "%s", i == 0 ? "" : ",");
        add_frame(t, &t->frames[i], out);
    }
    gltf_text_add(out, "],\"run_ns\":[");
    for (uint32_t run = 0; run < t->runs; run++) {
        gltf_text_add(out, "%s[", run == 0 ? "" : ",");
        for (uint32_t i = 0; i < t->steps; i++) {
            gltf_text_add(out, "%s%" PRIu64, i == 0 ? "" : ",", t->run_ns[(size_t)run * t->steps + i]);
        }
        gltf_text_add(out, "]");
    }
    gltf_text_add(out, "]}\n");
}

void timeline_csv(const timeline *t, gltf_text *out) {
    gltf_text_add(out, "step,ns");
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        gltf_text_add(out, ",%s_ns", talus_stage_name((talus_stage)i));
    }
    for (uint32_t c = 0; c < timeline_count_count; c++) {
        gltf_text_add(out, ",%s", timeline_counts[c].name);
    }
    gltf_text_add(out, "\n");
    for (uint32_t k = 0; k < t->steps; k++) {
        const talus_frame *f = &t->frames[k];
        gltf_text_add(out, "%" PRIu32 ",%" PRIu64, k + 1, f->time.total);
        for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
            gltf_text_add(out, ",%" PRIu64, f->time.stage[i]);
        }
        for (uint32_t c = 0; c < timeline_count_count; c++) {
            gltf_text_add(out, ",%" PRIu32, timeline_counted(f, c));
        }
        gltf_text_add(out, "\n");
    }
}

/* --- trace events ----------------------------------------------------------------------------- */

/* The Trace Event Format (its JSON object form), as Perfetto and chrome://tracing read it: ts and dur are microseconds.
 */
static void add_event(gltf_text *out, const char *name, const char *category, uint64_t start, uint64_t ns) {
    gltf_text_add(out,
                  ",\n{\"name\":\"%s\",\"cat\":\"%s\",\"ph\":\"X\",\"ts\":%" PRIu64 ".%03u,\"dur\":%" PRIu64
                  ".%03u,\"pid\":1,\"tid\":1",
                  name, category, start / 1000, (unsigned)(start % 1000), ns / 1000, (unsigned)(ns % 1000));
}

static void add_counter(gltf_text *out, const char *name, uint64_t at, const char *first, uint32_t a,
                        const char *second, uint32_t b) {
    gltf_text_add(out,
                  ",\n{\"name\":\"%s\",\"ph\":\"C\",\"ts\":%" PRIu64 ".%03u,\"pid\":1,\"args\":{\"%s\":%" PRIu32
                  ",\"%s\":%" PRIu32 "}}",
                  name, at / 1000, (unsigned)(at % 1000), first, a, second, b);
}

void timeline_trace(const timeline *t, gltf_text *out) {
    uint64_t at = 0;
    gltf_text_add(out, "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n{\"name\":\"process_name\",\"ph\":\"M\","
                       "\"pid\":1,\"args\":{\"name\":");
    gltf_text_quoted(out, t->name);
    gltf_text_add(out, "}},\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,\"args\":{\"name\":\"step\"}}");
    for (uint32_t k = 0; k < t->steps; k++) {
        const talus_frame *f = &t->frames[k];
        const talus_counters *n = &f->counters;
        uint64_t inner = at;
        add_event(out, "step", "frame", at, f->time.total);
        gltf_text_add(out, ",\"args\":{\"step\":%" PRIu32 ",\"islands\":%" PRIu32 "}}", k + 1, f->islands);
        for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
            if (f->time.stage[i] > 0) { /* the laps of a stage over all sub-steps as one */
                add_event(out, talus_stage_name((talus_stage)i), "stage", inner, f->time.stage[i]);
                gltf_text_add(out, "}");
                inner += f->time.stage[i];
            }
        }
        add_counter(out, "bodies", at, "awake", n->awake_bodies, "asleep", n->sleeping_bodies);
        add_counter(out, "pairs", at, "computed", n->manifolds_made, "kept", n->manifolds_kept);
        add_counter(out, "contacts", at, "touching", n->contacts_touching, "asleep", n->contacts_sleeping);
        add_counter(out, "islands", at, "solved", f->islands, "woken", n->islands_woken);
        at += f->time.total;
    }
    gltf_text_add(out, "\n]}\n");
}

/* --- the page --------------------------------------------------------------------------------- */

void timeline_html(const timeline *t, double budget_ms, gltf_text *out) {
    static const char mark[] = "@DATA@";
    const char *page = (const char *)profile_page, *at = strstr(page, mark);
    gltf_text json = {NULL, 0, 0, 0};
    timeline_json(t, budget_ms, &json);
    out->failed |= json.failed;
    gltf_text_bytes(out, page, (size_t)(at - page));
    for (size_t i = 0; json.data != NULL && i < json.size; i++) { /* no "</script>" and no "<!--" in a script */
        if (json.data[i] == '<') {
            gltf_text_add(out, "\\u003c");
        } else {
            gltf_text_bytes(out, json.data + i, 1);
        }
    }
    gltf_text_add(out, "%s", at + sizeof mark - 1);
    gltf_text_free(&json);
}
