/* talus profile --compare: two saved profiles, read, held against each other, and told of. */
#include "compare.h"
#include "figures.h"
#include "gltf/json.h"
#include "host/file.h"
#include "talus/world.h"
#include "tool.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BYTES ((size_t)1 << 31)
#define MOST_RUNS 1000
#define MOST_STEPS 1000000

/* A saved profile, as far as it is compared. */
typedef struct saved {
    cJSON *json;
    const char *scene, *isa, *hash;
    uint32_t steps, runs, substeps, iterations;
    double dt, stage[TALUS_STAGE_COUNT]; /* s; ms, mean */
    int sleep;
    double *run_ns, *least_ms; /* runs x steps; steps */
} saved;

static void saved_free(saved *s) {
    cJSON_Delete(s->json);
    free(s->run_ns);
    free(s->least_ms);
}

/* One number an element; the clock may have stood still for a step, which has no logarithm. */
static void read_run(const gltf_list *runs, int run, saved *s) {
    gltf_at at = gltf_list_item(runs, run);
    const cJSON *item = at.json != NULL ? at.json->child : NULL;
    uint32_t i = 0;
    for (; i < s->steps && cJSON_IsNumber(item) && item->valuedouble >= 0 && item->valuedouble < 1e18; i++) {
        double ns = item->valuedouble > 1 ? item->valuedouble : 1;
        s->run_ns[(size_t)run * s->steps + i] = ns;
        double *least = &s->least_ms[i];
        *least = run == 0 || ns * 1e-6 < *least ? ns * 1e-6 : *least;
        item = item->next;
    }
    if (i < s->steps || item != NULL) {
        gltf_fail(&at, GLTF_BROKEN, "is not %" PRIu32 " times in nanoseconds", s->steps);
    }
}

static void read_stages(const gltf_at *root, saved *s) {
    gltf_list stages = gltf_list_open(root, "stages");
    if (!gltf_failed(root) && stages.count != TALUS_STAGE_COUNT) {
        gltf_fail(&stages.at, GLTF_BROKEN, "has %d stages and not %d", stages.count, (int)TALUS_STAGE_COUNT);
    }
    for (int i = 0; i < stages.count && !gltf_failed(root); i++) {
        gltf_at stage = gltf_list_item(&stages, i);
        s->stage[i] = gltf_number(&stage, "mean", 0, 0, 1e12);
    }
    gltf_list_close(&stages);
}

static void read_all(const gltf_at *root, saved *s) {
    const char *report = gltf_string(root, "report");
    s->scene = gltf_string(root, "scene"), s->isa = gltf_string(root, "isa");
    s->hash = gltf_string(root, "world_hash");
    s->steps = (uint32_t)gltf_whole(root, "steps", 0, MOST_STEPS);
    s->runs = (uint32_t)gltf_whole(root, "runs", 0, MOST_RUNS);
    s->substeps = (uint32_t)gltf_whole(root, "substeps", 0, 1e6);
    s->iterations = (uint32_t)gltf_whole(root, "iterations", 0, 1e6);
    s->sleep = gltf_flag(root, "sleep", 0);
    s->dt = gltf_number(root, "dt", 0, 0, 1);
    if (!gltf_failed(root) && (report == NULL || strcmp(report, "profile") != 0 || s->scene == NULL || s->isa == NULL ||
                               s->hash == NULL || s->steps == 0 || s->runs == 0)) {
        gltf_fail(root, GLTF_BROKEN, "is not what talus profile --json writes");
    }
    read_stages(root, s);
    gltf_list runs = gltf_list_open(root, "run_ns");
    if (!gltf_failed(root) && (uint32_t)runs.count != s->runs) {
        gltf_fail(&runs.at, GLTF_BROKEN, "has %d runs and not %" PRIu32, runs.count, s->runs);
    }
    s->run_ns = calloc((size_t)s->runs * s->steps + 1, sizeof *s->run_ns);
    s->least_ms = calloc((size_t)s->steps + 1, sizeof *s->least_ms);
    if (s->run_ns == NULL || s->least_ms == NULL) {
        gltf_fail(root, GLTF_FAILED, "there is no memory for it");
    }
    for (int i = 0; i < runs.count && !gltf_failed(root); i++) {
        read_run(&runs, i, s);
    }
    gltf_list_close(&runs);
}

static int read_profile(const char *path, saved *s) {
    unsigned char *bytes;
    size_t size;
    memset(s, 0, sizeof *s);
    host_file_status read = host_file_read(path, MOST_BYTES, &bytes, &size);
    if (read != HOST_FILE_OK) {
        return tool_fail(GLTF_FAILED, "%s: %s", path,
                         read == HOST_FILE_TOO_LARGE   ? "the file is too large"
                         : read == HOST_FILE_NO_MEMORY ? "there is no memory for it"
                                                       : strerror(errno));
    }
    s->json = cJSON_ParseWithLength((const char *)bytes, size);
    free(bytes);
    gltf_error error;
    memset(&error, 0, sizeof error);
    const gltf_at root = {NULL, NULL, 0, s->json, &error};
    if (s->json == NULL || !cJSON_IsObject(s->json)) {
        return tool_fail(GLTF_BROKEN, "%s: is not JSON, or not an object", path);
    }
    read_all(&root, s);
    return error.status == GLTF_OK ? 0 : tool_fail((int)error.status, "%s: %s", path, error.text);
}

/* --- telling --- */

/* Whether two profiles are of the same steps; what differs otherwise is told. */
static int check_alike(const char *path_a, const saved *a, const char *path_b, const saved *b) {
    if (strcmp(a->scene, b->scene) != 0) {
        return tool_fail(TOOL_USAGE, "profile: %s is of the scene %s and %s of %s", path_a, a->scene, path_b, b->scene);
    }
    if (a->steps != b->steps || a->dt != b->dt) {
        return tool_fail(TOOL_USAGE, "profile: %s has %" PRIu32 " steps of %g s and %s %" PRIu32 " of %g s", path_a,
                         a->steps, a->dt, path_b, b->steps, b->dt);
    }
    if (a->substeps != b->substeps || a->iterations != b->iterations || a->sleep != b->sleep) {
        printf("note: sub-steps, iterations or sleep differ: the work of the steps is not the same\n");
    } else if (strcmp(a->hash, b->hash) != 0) {
        printf("note: the states after the last step differ (%s, %s): the work of the steps is not the same\n", a->hash,
               b->hash);
    }
    if (strcmp(a->isa, b->isa) != 0) {
        printf("note: A ran by %s, B by %s\n", a->isa, b->isa);
    }
    return 0;
}

static void print_row(const char *name, double a, double b) {
    printf("  %-12s %10.4f %10.4f", name, a, b);
    if (a > 0) {
        printf(" %+8.1f%%", 100 * (b / a - 1));
    }
    printf("\n");
}

static void print_table(saved *a, saved *b) {
    figures fa = figures_of(a->least_ms, a->steps), fb = figures_of(b->least_ms, b->steps);
    printf("%s, %" PRIu32 " steps; of each the least of %" PRIu32 " runs (A) and %" PRIu32 " (B)\n\n", a->scene,
           a->steps, a->runs, b->runs);
    printf("  %-12s %10s %10s\n", "ms a step", "A", "B");
    print_row("mean", fa.mean, fb.mean);
    print_row("p50", fa.p50, fb.p50);
    print_row("p95", fa.p95, fb.p95);
    print_row("p99", fa.p99, fb.p99);
    print_row("p99.9", fa.p999, fb.p999);
    print_row("max", fa.max, fb.max);
    printf("\n  %-12s\n", "stages, mean");
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        if (a->stage[i] > 0.01 * fa.mean || b->stage[i] > 0.01 * fb.mean) {
            print_row(talus_stage_name((talus_stage)i), a->stage[i], b->stage[i]);
        }
    }
}

static void print_verdict(const compare_result *r) {
    double percent = 100 * (r->ratio - 1), low = 100 * (r->low - 1), high = 100 * (r->high - 1);
    switch (r->verdict) {
    case COMPARE_SLOWER:
        printf("\nB is slower by %.1f %% [%.1f, %.1f]", percent, low, high);
        break;
    case COMPARE_FASTER:
        printf("\nB is faster by %.1f %% [%.1f, %.1f]", -percent, -high, -low);
        break;
    case COMPARE_SAME:
        printf("\nno difference seen: B takes %+.1f %% [%+.1f, %+.1f]", percent, low, high);
        break;
    default:
        printf(
            "\nnothing can be said: B takes %+.1f %% [%+.1f, %+.1f], but it takes %u runs of each to tell a difference "
            "from the machine's moods",
            percent, low, high, COMPARE_LEAST_RUNS);
        break;
    }
    printf("; p = %.3f of the runs' ranks\n", r->p);
}

int profile_compare(const char *path_a, const char *path_b) {
    saved a, b;
    compare_result result;
    memset(&b, 0, sizeof b);
    int status = read_profile(path_a, &a);
    if (status == 0) {
        status = read_profile(path_b, &b);
    }
    if (status == 0) {
        status = check_alike(path_a, &a, path_b, &b);
    }
    if (status == 0 && !compare_runs(a.run_ns, a.runs, b.run_ns, b.runs, a.steps, &result)) {
        status = tool_fail(GLTF_FAILED, "there is no memory to compare the profiles");
    } else if (status == 0) {
        print_table(&a, &b);
        print_verdict(&result);
        status = result.verdict == COMPARE_SLOWER ? TOOL_SLOW : 0;
    }
    saved_free(&a);
    saved_free(&b);
    return status;
}
