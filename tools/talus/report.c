#include "run.h"

#include "gltf/text.h"
#include "host/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* --- for people --- */

static double mean_substeps(const run_result *r) {
    return r->awake_body_steps > 0 ? (double)r->substeps_given / (double)r->awake_body_steps : 0;
}

static double percent(uint64_t part, uint64_t whole) { return whole > 0 ? 100.0 * (double)part / (double)whole : 0.0; }

static void print_usage(const char *name, const talus_usage *usage, uint64_t dropped) {
    printf("  %-10s %10" PRIu32 " %10" PRIu32 " %10" PRIu32, name, usage->used, usage->high_water, usage->capacity);
    if (dropped > 0) {
        printf("   %" PRIu64 " did not fit", dropped);
    }
    printf("\n");
}

static void print_stages(const run_result *r) {
    uint64_t all = 0;
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        all += r->stage_ns[i];
    }
    printf("\nstages              ms/step    share\n");
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        double share = percent(r->stage_ns[i], all);
        char bar[51];
        size_t length = (size_t)(share / 2 + 0.5);
        memset(bar, '#', length);
        bar[length] = 0;
        printf("  %-14s %10.4f %7.1f%% %s\n", talus_stage_name((talus_stage)i),
               r->steps > 0 ? (double)r->stage_ns[i] * 1e-6 / r->steps : 0, share, bar);
    }
}

static void print_memory(const gltf_world *world, const run_result *r) {
    const talus_counters *c = &r->last;
    printf("\nmemory: a block of %.2f MiB, hulls of %.2f MiB\n", (double)world->block_bytes / 1048576,
           (double)world->geometry_bytes / 1048576);
    printf("  %-10s %10s %10s %10s\n", "", "used", "most", "capacity");
    print_usage("bodies", &c->bodies, 0);
    print_usage("shapes", &c->shapes, 0);
    print_usage("joints", &c->joints, 0);
    print_usage("contacts", &c->contacts, r->dropped_contacts);
    print_usage("rows", &c->rows, r->dropped_rows);
    print_usage("events", &c->events, r->dropped_events);
}

static void print_skipped(const run_result *r) {
    const talus_counters *c = &r->last;
    printf("\nskipped, over all steps\n");
    const skipped *s = &r->skips;
    gltf_text parts = {NULL, 0, 0, 0};
    printf("  static bodies      %10" PRIu64 " of %" PRIu64 "\n", s->static_body_steps, s->static_body_steps);
    printf("  bodies asleep      %10" PRIu64 " of %" PRIu64 " (%.1f%%)\n", s->sleeping_body_steps, s->body_steps,
           percent(s->sleeping_body_steps, s->body_steps));
    uint64_t manifolds = r->manifolds_made + r->manifolds_kept + r->contacts_sleeping;
    printf("  manifolds kept     %10" PRIu64 " of %" PRIu64 " (%.1f%%)\n", r->manifolds_kept, manifolds,
           percent(r->manifolds_kept, manifolds));
    printf("  contacts asleep    %10" PRIu64 " of %" PRIu64 " (%.1f%%)\n", r->contacts_sleeping, manifolds,
           percent(r->contacts_sleeping, manifolds));
    skipped_print(s, &parts);
    printf("done in how many steps of %" PRIu64 "\n%s", s->steps, parts.size > 0 && !parts.failed ? parts.data : "");
    gltf_text_free(&parts);
    printf("\nworst errors of the second half: overlap %.2f mm, joints %.2f mm and %.4f rad;\n",
           1e3 * (double)r->worst.overlap, 1e3 * (double)r->worst.joint_linear, (double)r->worst.joint_angular);
    printf("speeds left: surfaces close at %.4f m/s, joints part at %.4f m/s\n", (double)r->worst.contact_speed,
           (double)r->worst.joint_speed);
    printf("\nafter the last step: %" PRIu32 " bodies awake, %" PRIu32 " asleep, %" PRIu32 " islands, %" PRIu32
           " contacts touch with %" PRIu32 " points\n",
           c->awake_bodies, c->sleeping_bodies, c->islands, c->contacts_touching, c->contact_points);
    if (c->bodies_planar > 0) {
        printf("locked to a plane: %" PRIu32 " of the bodies awake, three degrees of freedom solved in %" PRIu32
               " contacts\n",
               c->bodies_planar, c->contacts_planar);
    }
    if (c->lane_groups > 0) {
        printf("solver: %" PRIu32 " groups of eight in %" PRIu32 " colours, %.1f%% of the lanes in use\n",
               c->lane_groups, c->colors, percent(c->lanes_used, 8 * (uint64_t)c->lane_groups));
    }
    if (r->sensor_begins > 0) {
        printf("triggers: entered %" PRIu64 " times, left %" PRIu64 " times\n", r->sensor_begins, r->sensor_ends);
    }
}

/* What was asked of the steps, and what came of it. */
static void print_accuracy(const run_options *options, const run_result *r) {
    double budget = 1e3 * (double)options->source.build.error_budget;
    printf("\nerror budget %g mm: %" PRIu64 " of %" PRIu32
           " steps began with more, at most %.3f mm; in the second half %" PRIu64 ", at most %.3f mm\n",
           budget, r->steps_over, r->steps, 1e3 * (double)r->worst_error, r->settled_over,
           1e3 * (double)r->settled_error);
    printf("sub-steps of an awake body: least %" PRIu32 ", mean %.2f, most %" PRIu32 "\n", r->substeps_least,
           mean_substeps(r), r->substeps_most);
    if (options->time_budget > 0) {
        printf("time budget %g ms: %" PRIu64 " of %" PRIu32 " steps took longer\n", 1e3 * options->time_budget,
               r->steps_late, r->steps);
    }
}

void report_for_people(const run_options *options, const gltf_scene *scene, const gltf_world *world,
                       const run_result *r) {
    printf("%s: %" PRIu32 " bodies, %" PRIu32 " shapes, %" PRIu32 " joints, %" PRIu32 " hulls\n", r->name,
           scene->body_count, scene->collider_count, scene->joint_count, scene->hull_count);
    if (scene->note != NULL) {
        printf("  %s\n", scene->note);
    }
    printf("%" PRIu32 " steps of %g s, %" PRIu32 " sub-steps, %" PRIu32 " iterations, sleep %s, %s\n", r->steps,
           (double)r->dt, r->substeps, r->iterations, options->source.build.no_sleep ? "off" : "on",
           talus_isa_name((talus_isa)r->isa));
    printf("\nstep time, ms: mean %.4f   p50 %.4f   p99 %.4f   p99.9 %.4f   max %.4f\n", r->ms.mean, r->ms.p50,
           r->ms.p99, r->ms.p999, r->ms.max);
    if (r->has_stages) {
        print_stages(r);
    }
    print_memory(world, r);
    print_skipped(r);
    if (options->source.build.error_budget > 0) {
        print_accuracy(options, r);
    }
    if (r->not_finite_step > 0) {
        printf("NOT FINITE: states have a NaN or an infinity from step %" PRIu32 " on\n", r->not_finite_step);
    }
    for (uint32_t i = 0; i < scene->note_count; i++) {
        printf("note: %s\n", scene->notes[i]);
    }
    printf("\nstate hash %016" PRIx64 ", trajectory hash %016" PRIx64 "\n", r->world_hash, r->state_hash);
}

/* --- for programs --- */

static void add_number(gltf_text *out, const char *key, double value) {
    gltf_text_add(out, ",\"%s\":%.6g", key, value);
}

static void add_count(gltf_text *out, const char *key, uint64_t value) {
    gltf_text_add(out, ",\"%s\":%" PRIu64, key, value);
}

static void add_usage(gltf_text *out, const char *key, const talus_usage *usage, uint64_t dropped) {
    gltf_text_add(
        out, ",\"%s\":{\"used\":%" PRIu32 ",\"most\":%" PRIu32 ",\"capacity\":%" PRIu32 ",\"dropped\":%" PRIu64 "}",
        key, usage->used, usage->high_water, usage->capacity, dropped);
}

static void add_counters(gltf_text *out, const run_result *r) {
    const talus_counters *c = &r->last;
    gltf_text_add(out, ",\"counters\":{\"steps\":%" PRIu64, c->steps);
    add_usage(out, "contacts", &c->contacts, r->dropped_contacts);
    add_usage(out, "rows", &c->rows, r->dropped_rows);
    add_usage(out, "events", &c->events, r->dropped_events);
    add_count(out, "awake_bodies", c->awake_bodies);
    add_count(out, "sleeping_bodies", c->sleeping_bodies);
    add_count(out, "contacts_touching", c->contacts_touching);
    add_count(out, "contact_points", c->contact_points);
    add_count(out, "bodies_planar", c->bodies_planar);
    add_count(out, "contacts_planar", c->contacts_planar);
    add_count(out, "islands", c->islands);
    add_count(out, "colors", c->colors);
    add_count(out, "lane_groups", c->lane_groups);
    add_count(out, "lanes_used", c->lanes_used);
    add_count(out, "manifolds_made_total", r->manifolds_made);
    add_count(out, "manifolds_kept_total", r->manifolds_kept);
    add_count(out, "contacts_sleeping_total", r->contacts_sleeping);
    add_count(out, "sleeping_body_steps", r->skips.sleeping_body_steps);
    add_count(out, "static_body_steps", r->skips.static_body_steps);
    add_count(out, "body_steps", r->skips.body_steps);
    add_count(out, "pairs_made_total", r->pairs_made);
    add_count(out, "proxies_refit_total", r->proxies_refit);
    add_count(out, "sensor_begins", r->sensor_begins);
    add_count(out, "sensor_ends", r->sensor_ends);
    gltf_text_add(out, "}");
}

static void add_accuracy(gltf_text *out, const run_options *options, const run_result *r) {
    gltf_text_add(out, ",\"accuracy\":{\"error_budget_m\":%.6g", (double)options->source.build.error_budget);
    add_count(out, "substeps_least", r->substeps_least);
    add_number(out, "substeps_mean", mean_substeps(r));
    add_count(out, "substeps_most", r->substeps_most);
    add_number(out, "worst_error_m", (double)r->worst_error);
    add_count(out, "steps_over", r->steps_over);
    add_number(out, "second_half_worst_error_m", (double)r->settled_error);
    add_count(out, "second_half_steps_over", r->settled_over);
    if (options->time_budget > 0) {
        add_number(out, "time_budget_ms", 1e3 * options->time_budget);
        add_count(out, "steps_late", r->steps_late);
    }
    gltf_text_add(out, "}");
}

static void add_notes(gltf_text *out, const gltf_scene *scene, const run_result *r) {
    uint32_t count = 0;
    gltf_text_add(out, ",\"notes\":[");
    for (uint32_t i = 0; i < scene->note_count; i++) {
        gltf_text_add(out, "%s", count++ == 0 ? "" : ",");
        gltf_text_quoted(out, scene->notes[i]);
    }
    const struct {
        uint64_t count;
        const char *what;
    } troubles[] = {{r->dropped_contacts, "contacts did not fit"},
                    {r->dropped_rows, "rows did not fit"},
                    {r->dropped_events, "events did not fit"},
                    {r->not_finite_step, "is the first step with a NaN or an infinity"}};
    for (size_t i = 0; i < sizeof troubles / sizeof *troubles; i++) {
        if (troubles[i].count > 0) {
            gltf_text_add(out, "%s\"%" PRIu64 " %s\"", count++ == 0 ? "" : ",", troubles[i].count, troubles[i].what);
        }
    }
    gltf_text_add(out, "]");
}

void report_json(const run_options *options, const gltf_scene *scene, const gltf_world *world, const run_result *r) {
    gltf_text out = {NULL, 0, 0, 0};
    gltf_text_add(&out, "{\"engine\":\"talus\",\"version\":\"%s\",\"scene\":", TALUS_VERSION);
    gltf_text_quoted(&out, r->name);
    add_count(&out, "bodies", scene->body_count);
    add_count(&out, "shapes", scene->collider_count);
    add_count(&out, "joints", scene->joint_count);
    add_count(&out, "steps", r->steps);
    gltf_text_add(&out, ",\"dt\":%.9g,\"threads\":1", (double)r->dt);
    add_count(&out, "substeps", r->substeps);
    add_count(&out, "iterations", r->iterations);
    gltf_text_add(&out, ",\"sleep\":%s,\"isa\":\"%s\"", options->source.build.no_sleep ? "false" : "true",
                  talus_isa_name((talus_isa)r->isa));
    add_number(&out, "ms_per_step_mean", r->ms.mean);
    add_number(&out, "ms_per_step_p50", r->ms.p50);
    add_number(&out, "ms_per_step_p99", r->ms.p99);
    add_number(&out, "ms_per_step_p999", r->ms.p999);
    add_number(&out, "ms_per_step_max", r->ms.max);
    add_number(&out, "overlap_m", (double)r->worst.overlap);
    add_number(&out, "joint_separation_m", (double)r->worst.joint_linear);
    add_number(&out, "joint_angle_rad", (double)r->worst.joint_angular);
    add_number(&out, "closing_speed_m_s", (double)r->worst.contact_speed);
    add_number(&out, "joint_speed_m_s", (double)r->worst.joint_speed);
    add_count(&out, "peak_rss_kib", host_peak_rss_kib());
    add_count(&out, "block_bytes", world->block_bytes);
    add_count(&out, "geometry_bytes", world->geometry_bytes);
    gltf_text_add(&out, ",\"state_hash\":\"%016" PRIx64 "\",\"world_hash\":\"%016" PRIx64 "\"", r->state_hash,
                  r->world_hash);
    if (r->has_stages) {
        gltf_text_add(&out, ",\"stage_ms\":{");
        for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
            gltf_text_add(&out, "%s\"%s\":%.6g", i == 0 ? "" : ",", talus_stage_name((talus_stage)i),
                          r->steps > 0 ? (double)r->stage_ns[i] * 1e-6 / r->steps : 0);
        }
        gltf_text_add(&out, "}");
    }
    if (options->source.build.error_budget > 0) {
        add_accuracy(&out, options, r);
    }
    add_counters(&out, r);
    skipped_json(&r->skips, &out);
    add_notes(&out, scene, r);
    gltf_text_add(&out, "}");
    if (out.failed) {
        fprintf(stderr, "talus: there is no memory for the report\n");
    } else {
        puts(out.data);
    }
    gltf_text_free(&out);
}
