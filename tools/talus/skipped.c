#include "skipped.h"

#include <inttypes.h>

const char *const skipped_names[SKIPPED_COUNT] = {
    "joints",  "linkages", "restitution", "rolling", "pushes",   "fast_bodies",  "kinematics",
    "sensors", "events",   "refit",       "pairs",   "contacts", "sleep_search",
};

static const char *const labels[SKIPPED_COUNT] = {"joints",
                                                  "linkages",
                                                  "restitution",
                                                  "rolling resistance",
                                                  "pushing apart",
                                                  "contacts ahead of fast bodies",
                                                  "kinematic bodies",
                                                  "sensors",
                                                  "events",
                                                  "refitted boxes",
                                                  "new pairs",
                                                  "contacts to solve",
                                                  "the search for what may sleep"};

/* Counts of the scene that do not change while it runs. */
typedef struct kinds {
    uint32_t statics, kinematics, sensors;
} kinds;

static kinds count_kinds(const gltf_scene *scene) {
    kinds k = {0, 0, 0};
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        k.statics += scene->colliders[i].body == GLTF_NONE;
        k.sensors += scene->colliders[i].sensor != 0;
    }
    for (uint32_t i = 0; i < scene->body_count; i++) {
        k.kinematics += scene->bodies[i].kinematic != 0;
    }
    return k;
}

void skipped_take(skipped *s, const gltf_scene *scene, const talus_counters *c, float flown, float margin) {
    const kinds k = count_kinds(scene);
    int skips[SKIPPED_COUNT] = {0};
    skips[SKIPPED_JOINTS] = c->joints_skipped != 0;
    skips[SKIPPED_LINKAGES] = c->linkages == 0;
    skips[SKIPPED_RESTITUTION] = c->restitution_skipped != 0;
    skips[SKIPPED_ROLLING] = c->rolling_skipped != 0;
    skips[SKIPPED_PUSHES] = c->joints_skipped != 0 && c->groups_pushed == 0;
    skips[SKIPPED_FAST] = flown <= margin;
    skips[SKIPPED_KINEMATICS] = k.kinematics == 0;
    skips[SKIPPED_SENSORS] = k.sensors == 0;
    skips[SKIPPED_EVENTS] = c->events.used == 0;
    skips[SKIPPED_REFIT] = c->proxies_refit == 0;
    skips[SKIPPED_PAIRS] = c->pairs_made == 0;
    skips[SKIPPED_CONTACTS] = c->lane_groups == 0;
    skips[SKIPPED_SLEEP_SEARCH] = c->sleep_searched == 0;
    s->steps++;
    for (int i = 0; i < SKIPPED_COUNT; i++) {
        s->without[i] += skips[i] != 0;
    }
    s->static_body_steps += k.statics;
    s->sleeping_body_steps += c->sleeping_bodies - k.statics;
    s->body_steps += (uint64_t)c->awake_bodies + c->sleeping_bodies - k.statics;
}

/* A heading, then names with a comma in between, broken into lines. */
static void add_item(gltf_text *out, const char *heading, const char *label, uint64_t count, uint64_t of, int *items,
                     size_t *line) {
    if (*items == 0) {
        gltf_text_add(out, "  %-18s ", heading);
        *line = out->size;
    } else if (out->size - *line > 70) {
        gltf_text_add(out, ",\n  %-18s ", "");
        *line = out->size;
    } else {
        gltf_text_add(out, ", ");
    }
    gltf_text_add(out, "%s", label);
    if (count < of) {
        gltf_text_add(out, " (%" PRIu64 ")", of - count);
    }
    ++*items;
}

void skipped_print(const skipped *s, gltf_text *out) {
    static const char *const headings[2] = {"in no step", "in some steps only"};
    for (int some = 0; some < 2; some++) {
        int items = 0;
        size_t line = 0;
        for (int i = 0; i < SKIPPED_COUNT; i++) {
            if (s->without[i] > 0 && (s->without[i] < s->steps) == some) {
                add_item(out, headings[some], labels[i], s->without[i], s->steps, &items, &line);
            }
        }
        gltf_text_add(out, "%s", items > 0 ? "\n" : "");
    }
}

void skipped_json(const skipped *s, gltf_text *out) {
    int items = 0;
    gltf_text_add(out, ",\"steps_without\":{");
    for (int i = 0; i < SKIPPED_COUNT; i++) {
        gltf_text_add(out, "%s\"%s\":%" PRIu64, i > 0 ? "," : "", skipped_names[i], s->without[i]);
    }
    gltf_text_add(out, "},\"not_needed\":[");
    for (int i = 0; i < SKIPPED_COUNT; i++) {
        if (s->steps > 0 && s->without[i] == s->steps) {
            gltf_text_add(out, "%s\"%s\"", items++ > 0 ? "," : "", skipped_names[i]);
        }
    }
    gltf_text_add(out, "]");
}
