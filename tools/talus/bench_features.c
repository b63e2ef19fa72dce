/* Takes the table of `talus bench features`: of two worlds that differ in a feature which has nothing to do, how much
 * longer the steps of one are.
 *
 * The two take each step one right after the other, so that the machine's moods meet both. Whoever comes second finds
 * branches predicted and caches warm: two runs with the order turned round make a pair, and of a step the mean of both
 * ratios (their logarithms) counts. A pair gives the median over its steps, weighted by their least times; the table
 * has the median over the pairs, and the order statistics that hold it. That a feature is called over takes the lower
 * of them.
 *
 * What the code of a feature costs a world that has none of it is not to be had so, for no library without it is at
 * hand: tools/ci/check-feature-cost.sh counts those instructions. */
#include "bench_features.h"

#include "bench_choice.h"
#include "compare.h"
#include "figures.h"
#include "host/clock.h"
#include "tool.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FULL_PAIRS 12u
#define QUICK_PAIRS 1u
#define QUICK_STEPS 10u
#define LOW 2u /* the 3rd and the 10th of 12 have their median between them with 96 % (order statistics of a coin) */
#define HIGH 9u

typedef struct plan {
    uint32_t pairs, runs, steps;
} plan;

static uint64_t now(void *context) {
    (void)context;
    return host_clock_ns();
}

static int trouble(const feature *f, const feature_scene *s, const char *what) {
    return tool_fail(GLTF_FAILED, "bench features: %s in the %s: %s", f->name, s->name, what);
}

/* Whether the scene's own bodies, which were made first, stand alike in both worlds. */
static int same_scene(const feature_scene *s, const talus_world world[2]) {
    uint32_t first = talus_world_ground(&world[0]).index + 1;
    for (uint32_t i = 0; i < s->bodies; i++) {
        talus_body body = {first + i, 1};
        talus_pose pose[2];
        if (talus_body_get_pose(&world[0], body, &pose[0]) != TALUS_OK ||
            talus_body_get_pose(&world[1], body, &pose[1]) != TALUS_OK || memcmp(&pose[0], &pose[1], sizeof *pose)) {
            return 0;
        }
    }
    return 1;
}

/* One run: of each step the ns that it takes without and with. An exit status. */
static int run(const feature *f, const feature_scene *s, const plan *p, uint32_t turn, double *ns[2]) {
    void *memory[2] = {NULL, NULL};
    talus_world world[2];
    const talus_clock clock = {now, NULL};
    int made = 0, status = 0;
    for (uint32_t k = 0; k < 2; k++) { /* which of the two has which memory, and goes first, alternates */
        uint32_t on = (turn + k) & 1u;
        made += feature_make(s, f, (int)on, turn * 37u + k * 23u, &world[on], &memory[on]) == 0;
    }
    for (uint32_t i = 0; i < p->steps && made == 2; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t on = (turn + i + k) & 1u;
            uint64_t start = host_clock_ns();
            talus_world_step(&world[on], 1.0f / 60.0f, on && f->timed ? &clock : NULL, NULL);
            ns[on][(size_t)turn * p->steps + i] = (double)(host_clock_ns() - start);
        }
    }
    if (made < 2) {
        status = trouble(f, s, "its worlds could not be made");
    } else if (!same_scene(s, world)) {
        status = trouble(f, s, "it changes what the others do");
    }
    free(memory[0]);
    free(memory[1]);
    return status;
}

static void sum_up(const plan *p, double *ns[2], compare_weighted *steps, double *least, feature_row *row) {
    double ratio[FULL_PAIRS], sum[2] = {0, 0};
    for (uint32_t i = 0; i < p->steps; i++) {
        least[i] = 0;
        for (uint32_t k = 0; k < 2; k++) {
            double low = ns[k][i];
            for (uint32_t turn = 1; turn < p->runs; turn++) {
                low = fmin(low, ns[k][(size_t)turn * p->steps + i]);
            }
            sum[k] += low;
            least[i] += low;
        }
    }
    for (uint32_t pair = 0; pair < p->pairs; pair++) {
        for (uint32_t i = 0; i < p->steps; i++) {
            size_t a = (size_t)2 * pair * p->steps + i, b = a + p->steps;
            steps[i].value = sqrt(ns[1][a] / ns[0][a] * (ns[1][b] / ns[0][b]));
            steps[i].weight =
                least[i]; /* not its time in this pair, which is long where one of the two was disturbed */
        }
        ratio[pair] = compare_median(steps, p->steps);
    }
    qsort(ratio, p->pairs, sizeof *ratio, figures_compare);
    row->without = sum[0] * 1e-6 / p->steps;
    row->with = sum[1] * 1e-6 / p->steps;
    row->ratio = 0.5 * (ratio[(p->pairs - 1) / 2] + ratio[p->pairs / 2]);
    row->low = ratio[p->pairs > HIGH ? LOW : 0];
    row->high = ratio[p->pairs > HIGH ? HIGH : p->pairs - 1];
    row->over = p->pairs > HIGH && row->low > 1 + FEATURES_MOST;
}

static int measure(const feature *f, const feature_scene *s, const plan *p, feature_row *row) {
    size_t count = (size_t)p->runs * p->steps;
    compare_weighted *steps = malloc(p->steps * sizeof *steps);
    double *times = malloc((2 * count + p->steps) * sizeof *times);
    int status = steps != NULL && times != NULL ? 0 : trouble(f, s, "there is no memory for the times");
    if (status == 0) {
        double *ns[2] = {times, times + count};
        for (uint32_t turn = 0; turn < p->runs && status == 0; turn++) {
            status = run(f, s, p, turn, ns);
        }
        row->feature = f;
        row->scene = s;
        if (status == 0) {
            sum_up(p, ns, steps, times + 2 * count, row);
        }
    }
    free(steps);
    free(times);
    return status;
}

static int take_feature(feature_table *table, const feature *f, int quick, int watched) {
    int status = 0;
    for (uint32_t i = 0; i < feature_scene_count && status == 0; i++) {
        const feature_scene *s = &feature_scenes[i];
        const plan p = {table->pairs, 2 * table->pairs, quick ? QUICK_STEPS : s->steps};
        feature_row *row = &table->rows[table->count];
        if (watched) {
            fprintf(stderr, "\r%s in the %s ...%20s", f->name, s->name, "");
        }
        status = measure(f, s, &p, row);
        table->over += status == 0 && row->over;
        table->count++;
    }
    return status;
}

int features_take(feature_table *table, const char *const *names, uint32_t name_count, int quick, int watched) {
    int status = 0;
    table->count = 0;
    table->over = 0;
    table->pairs = quick ? QUICK_PAIRS : FULL_PAIRS;
    for (uint32_t i = 0; i < feature_count && status == 0; i++) {
        if (bench_is_chosen(features[i].name, names, name_count)) {
            status = take_feature(table, &features[i], quick, watched);
        }
    }
    if (watched) {
        fprintf(stderr, "\r%60s\r", "");
    }
    return status;
}

/* --- telling --- */

void features_print(const feature_table *t, gltf_text *out) {
    gltf_text_add(out, "%-12s %-8s %11s %11s %10s %10s %8s\n", "feature", "scene", "ms without", "ms with",
                  "by turns, %", "from", "to");
    for (uint32_t i = 0; i < t->count; i++) {
        const feature_row *r = &t->rows[i];
        gltf_text_add(out, "%-12s %-8s %11.4f %11.4f %+10.2f  %+10.2f %+8.2f%s\n", r->feature->name, r->scene->name,
                      r->without, r->with, 100 * r->ratio - 100, 100 * r->low - 100, 100 * r->high - 100,
                      r->over ? "  OVER" : "");
    }
    gltf_text_add(out,
                  "\nThe least times of the steps; of steps taken by turns, %" PRIu32
                  " pairs of runs: how much longer, and between\nwhat that lies. In all of them the scene is the "
                  "same to the bit, with:\n",
                  t->pairs);
    for (uint32_t i = 0; i < feature_count; i++) {
        gltf_text_add(out, "  %-12s %s\n", features[i].name, features[i].about);
    }
}

void features_json(const feature_table *t, gltf_text *out) {
    gltf_text_add(out, "{\"bench\":\"features\",\"pairs\":%" PRIu32 ",\"most\":%g,\"over\":%d,\"rows\":[", t->pairs,
                  FEATURES_MOST, t->over);
    for (uint32_t i = 0; i < t->count; i++) {
        const feature_row *r = &t->rows[i];
        gltf_text_add(out,
                      "%s{\"feature\":\"%s\",\"about\":\"%s\",\"scene\":\"%s\",\"bodies\":%" PRIu32
                      ",\"ms_without\":%.6f,\"ms_with\":%.6f,\"ratio\":%.6f,\"ratio_low\":%.6f,\"ratio_high\":%.6f,"
                      "\"over\":%s}",
                      i > 0 ? "," : "", r->feature->name, r->feature->about, r->scene->name, r->scene->bodies,
                      r->without, r->with, r->ratio, r->low, r->high, r->over ? "true" : "false");
    }
    gltf_text_add(out, "]}\n");
}
