/* Timelines for people: the table, the worst frames, and the bars of a run in progress. */
#include "timeline.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define BAR 32u       /* characters */
#define OVER_TOLD 12u /* frames over the budget that the report has a line for */
#define WORST_TOLD 5u
#define WINDOW 512u /* steps that the live view looks at */

static void add_bar(gltf_text *out, double share, char mark) {
    char bar[BAR + 1];
    double full = share < 0 ? 0 : share > 1 ? 1 : share;
    size_t length = (size_t)(full * BAR + 0.5);
    memset(bar, mark, length);
    bar[length] = 0;
    gltf_text_add(out, "%s", bar);
}

static void add_figures(gltf_text *out, const char *name, const figures *f, double share) {
    gltf_text_add(out, "  %-12s %9.4f %9.4f %9.4f %9.4f %9.4f %9.4f %5.1f%% ", name, f->mean, f->p50, f->p95, f->p99,
                  f->p999, f->max, 100 * share);
    add_bar(out, share, '#');
    gltf_text_add(out, "\n");
}

static void add_header(gltf_text *out) {
    gltf_text_add(out, "  %-12s %9s %9s %9s %9s %9s %9s %6s\n", "ms", "mean", "p50", "p95", "p99", "p99.9", "max",
                  "share");
}

static void add_budget(gltf_text *out, double budget_ms, const figures *whole, uint32_t over, uint32_t steps) {
    if (budget_ms > 0) {
        gltf_text_add(out, "  budget %g ms a step: the worst takes %.0f %% of it, %" PRIu32 " of %" PRIu32 " go over\n",
                      budget_ms, 100 * whole->max / budget_ms, over, steps);
    }
}

static void add_stages(const timeline *t, gltf_text *out) {
    figures whole = timeline_figures(t, TALUS_STAGE_COUNT);
    add_header(out);
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        figures f = timeline_figures(t, i);
        if (f.max > 0) {
            add_figures(out, talus_stage_name((talus_stage)i), &f, whole.mean > 0 ? f.mean / whole.mean : 0);
        }
    }
    add_figures(out, "step", &whole, 1);
}

static void add_step(const timeline *t, const talus_frame *median, uint32_t step, gltf_text *out) {
    gltf_text_add(out, "  step %" PRIu32 ", %.4f ms: ", step + 1, (double)t->frames[step].time.total * 1e-6);
    timeline_explain(t, median, step, out);
    gltf_text_add(out, "\n");
}

static void add_over(const timeline *t, const talus_frame *median, double budget_ms, gltf_text *out) {
    uint32_t over = timeline_over(t, budget_ms), told = over < OVER_TOLD ? over : OVER_TOLD;
    uint32_t *steps = calloc((size_t)told + 1, sizeof *steps);
    if (steps == NULL) {
        out->failed = 1;
        return;
    }
    gltf_text_add(out, "\nover the budget of %g ms, against the median step of %.4f ms\n", budget_ms,
                  (double)median->time.total * 1e-6);
    told = timeline_worst(t, steps, told);
    for (uint32_t i = 0; i < told; i++) {
        add_step(t, median, steps[i], out);
        const talus_frame *f = &t->frames[steps[i]];
        for (uint32_t k = 0; k < f->largest_count && f->largest[k].bodies > 1; k++) {
            const talus_frame_island *island = &f->largest[k];
            gltf_text_add(out,
                          "    island around %s (held by %" PRIu32 "): %" PRIu32 " bodies, %" PRIu32
                          " contacts, %" PRIu32 " joints, %.4f ms\n",
                          timeline_name(t, island->body.index), island->held, island->bodies, island->contacts,
                          island->joints, (double)island->ticks * 1e-6);
        }
    }
    if (over > told) {
        gltf_text_add(out, "  and %" PRIu32 " more\n", over - told);
    }
    free(steps);
}

void timeline_print(const timeline *t, double budget_ms, gltf_text *out) {
    talus_frame median;
    timeline_median(t, &median);
    uint64_t own = 0, all = 0;
    for (uint32_t i = 0; i < t->steps; i++) {
        own += t->frames[i].profiler, all += t->frames[i].time.total;
    }
    gltf_text_add(out, "%s: %" PRIu32 " bodies, %" PRIu32 " shapes, %" PRIu32 " joints\n", t->name, t->bodies,
                  t->shapes, t->joints);
    gltf_text_add(out,
                  "%" PRIu32 " steps of %g s, %" PRIu32 " sub-steps, %" PRIu32 " iterations, sleep %s, %s; of each "
                  "step the least of %" PRIu32 " identical runs\n\n",
                  t->steps, (double)t->dt, t->substeps, t->iterations, t->sleep ? "on" : "off", talus_isa_name(t->isa),
                  t->runs);
    add_stages(t, out);
    figures whole = timeline_figures(t, TALUS_STAGE_COUNT);
    add_budget(out, budget_ms, &whole, timeline_over(t, budget_ms), t->steps);
    if (timeline_over(t, budget_ms) > 0) {
        add_over(t, &median, budget_ms, out);
    } else {
        gltf_text_add(out, "\nworst steps, against the median one of %.4f ms\n", (double)median.time.total * 1e-6);
        uint32_t steps[WORST_TOLD], count = timeline_worst(t, steps, WORST_TOLD);
        for (uint32_t i = 0; i < count; i++) {
            add_step(t, &median, steps[i], out);
        }
    }
    gltf_text_add(out, "\ncounting the islands took %.2f %% on top; state hash %016" PRIx64 "\n",
                  all > 0 ? 100.0 * (double)own / (double)all : 0.0, t->hash);
}

void timeline_draw(const timeline *t, uint32_t run, uint32_t step, double budget_ms, gltf_text *out, uint32_t *lines) {
    timeline seen = *t; /* the last steps only */
    uint32_t from = step + 1 > WINDOW ? step + 1 - WINDOW : 0;
    seen.frames = t->frames + from;
    seen.steps = step + 1 - from;
    figures whole = timeline_figures(&seen, TALUS_STAGE_COUNT);
    uint32_t rows = 0;
    gltf_text_add(out, "%s: run %" PRIu32 " of %" PRIu32 ", step %" PRIu32 " of %" PRIu32 "\n", t->name, run + 1,
                  t->runs, step + 1, t->steps);
    add_header(out);
    for (int i = 0; i < TALUS_STAGE_COUNT; i++, rows++) {
        figures f = timeline_figures(&seen, i);
        add_figures(out, talus_stage_name((talus_stage)i), &f, whole.mean > 0 ? f.mean / whole.mean : 0);
    }
    add_figures(out, "step", &whole, 1);
    rows += 3;
    if (budget_ms > 0) {
        add_budget(out, budget_ms, &whole, timeline_over(&seen, budget_ms), seen.steps);
        gltf_text_add(out, "  now %8.4f ms [", (double)t->frames[step].time.total * 1e-6);
        add_bar(out, (double)t->frames[step].time.total * 1e-6 / budget_ms, '=');
        gltf_text_add(out, "]\n");
        rows += 2;
    }
    *lines = rows;
}
