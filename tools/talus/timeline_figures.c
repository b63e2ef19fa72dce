/* What a timeline says: percentiles, the median frame, and why a step took what it took. */
#include "timeline.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define COUNTER(member, many, one)                                                                                     \
    { #member, many, one, offsetof(talus_frame, counters) + offsetof(talus_counters, member) }

enum {
    AWAKE_BODIES,
    SLEEPING_BODIES,
    PROXIES_REFIT,
    PAIRS_MADE,
    PAIRS_ENDED,
    MANIFOLDS_MADE,
    MANIFOLDS_FIRST,
    MANIFOLDS_KEPT,
    CONTACTS_SLEEPING,
    CONTACTS_TOUCHING,
    CONTACTS_PRESSED,
    CONTACT_POINTS,
    TOUCHES_BEGUN,
    TOUCHES_ENDED,
    JOINTS_SOLVED,
    JOINTS_SLEEPING,
    ISLANDS,
    ISLANDS_AGE,
    ISLANDS_SLEPT,
    ISLANDS_WOKEN,
    BODIES_SLEPT,
    SLEEP_SEARCHED,
    BODIES_WOKEN,
    COLORS,
    LANE_GROUPS,
    LANES_USED,
    GROUPS_PUSHED,
    GROUPS_BOUNCING,
    IMPACT_SWEEPS,
    GROUPS_STRUCK,
    COUNTS
};

const timeline_count timeline_counts[COUNTS] = {
    COUNTER(awake_bodies, "bodies awake", "body awake"),
    COUNTER(sleeping_bodies, "bodies asleep", "body asleep"),
    COUNTER(proxies_refit, "boxes entered anew", "box entered anew"),
    COUNTER(pairs_made, "pairs first met", "pair first met"),
    COUNTER(pairs_ended, "pairs parted", "pair parted"),
    COUNTER(manifolds_made, "manifolds computed", "manifold computed"),
    COUNTER(manifolds_first, "of new pairs", "of a new pair"),
    COUNTER(manifolds_kept, "manifolds kept", "manifold kept"),
    COUNTER(contacts_sleeping, "contacts asleep", "contact asleep"),
    COUNTER(contacts_touching, "contacts solved", "contact solved"),
    COUNTER(contacts_pressed, "contacts solved at once", "contact solved at once"),
    COUNTER(contact_points, "contact points", "contact point"),
    COUNTER(touches_begun, "touches begun", "touch begun"),
    COUNTER(touches_ended, "touches ended", "touch ended"),
    COUNTER(joints_solved, "joints solved", "joint solved"),
    COUNTER(joints_sleeping, "joints asleep", "joint asleep"),
    {"islands", "islands", "island", offsetof(talus_frame, islands)},
    {"islands_age", "steps since the islands were counted", "step since the islands were counted",
     offsetof(talus_frame, islands_age)},
    COUNTER(islands_slept, "islands put to sleep", "island put to sleep"),
    COUNTER(islands_woken, "islands woken", "island woken"),
    COUNTER(bodies_slept, "bodies put to sleep", "body put to sleep"),
    COUNTER(sleep_searched, "searches for islands that may sleep", "search for islands that may sleep"),
    COUNTER(bodies_woken, "bodies woken", "body woken"),
    COUNTER(colors, "colours", "colour"),
    COUNTER(lane_groups, "groups of eight", "group of eight"),
    COUNTER(lanes_used, "lanes used", "lane used"),
    COUNTER(groups_pushed, "groups with deep overlap", "group with deep overlap"),
    COUNTER(groups_bouncing, "groups that bounce", "group that bounces"),
    COUNTER(impact_sweeps, "sweeps for impacts", "sweep for impacts"),
    COUNTER(groups_struck, "groups struck", "group struck"),
};
const uint32_t timeline_count_count = COUNTS;

/* What makes a stage long, the likeliest first; closed by COUNTS. */
static const unsigned char CAUSES[TALUS_STAGE_COUNT][5] = {
    {COUNTS},                                                                     /* commands */
    {PROXIES_REFIT, AWAKE_BODIES, COUNTS},                                        /* refit */
    {PAIRS_MADE, PROXIES_REFIT, COUNTS},                                          /* pairs */
    {MANIFOLDS_MADE, MANIFOLDS_FIRST, BODIES_WOKEN, COUNTS},                      /* narrow */
    {COUNTS},                                                                     /* islands */
    {CONTACTS_TOUCHING, JOINTS_SOLVED, AWAKE_BODIES, COUNTS},                     /* rows */
    {AWAKE_BODIES, COUNTS},                                                       /* velocity */
    {CONTACTS_PRESSED, CONTACTS_TOUCHING, CONTACT_POINTS, JOINTS_SOLVED, COUNTS}, /* solve */
    {AWAKE_BODIES, COUNTS},                                                       /* position */
    {CONTACTS_PRESSED, GROUPS_PUSHED, CONTACTS_TOUCHING, JOINTS_SOLVED, COUNTS},  /* relax */
    {GROUPS_STRUCK, IMPACT_SWEEPS, GROUPS_BOUNCING, COUNTS},                      /* restitution */
    {COUNTS},                                                                     /* ccd */
    {AWAKE_BODIES, COUNTS},                                                       /* commit */
    {BODIES_SLEPT, ISLANDS_SLEPT, SLEEP_SEARCHED, AWAKE_BODIES, COUNTS},          /* sleep */
    {TOUCHES_BEGUN, TOUCHES_ENDED, COUNTS},                                       /* events */
};

uint32_t timeline_counted(const talus_frame *frame, uint32_t count) {
    uint32_t value;
    memcpy(&value, (const unsigned char *)frame + timeline_counts[count].offset, sizeof value);
    return value;
}

static uint64_t time_of(const talus_frame *frame, int stage) {
    return stage == TALUS_STAGE_COUNT ? frame->time.total : frame->time.stage[stage];
}

figures timeline_figures(const timeline *t, int stage) {
    double *ms = calloc((size_t)t->steps + 1, sizeof *ms);
    if (ms == NULL) {
        return figures_of(NULL, 0);
    }
    for (uint32_t i = 0; i < t->steps; i++) {
        ms[i] = (double)time_of(&t->frames[i], stage) * 1e-6;
    }
    figures f = figures_of(ms, t->steps);
    free(ms);
    return f;
}

void timeline_median(const timeline *t, talus_frame *out) {
    memset(out, 0, sizeof *out);
    double *values = calloc((size_t)t->steps + 1, sizeof *values);
    for (int stage = 0; values != NULL && stage <= TALUS_STAGE_COUNT; stage++) {
        for (uint32_t i = 0; i < t->steps; i++) {
            values[i] = (double)time_of(&t->frames[i], stage);
        }
        uint64_t median = (uint64_t)figures_of(values, t->steps).p50;
        *(stage == TALUS_STAGE_COUNT ? &out->time.total : &out->time.stage[stage]) = median;
    }
    for (uint32_t c = 0; values != NULL && c < COUNTS; c++) {
        for (uint32_t i = 0; i < t->steps; i++) {
            values[i] = timeline_counted(&t->frames[i], c);
        }
        uint32_t median = (uint32_t)figures_of(values, t->steps).p50;
        memcpy((unsigned char *)out + timeline_counts[c].offset, &median, sizeof median);
    }
    free(values);
}

uint32_t timeline_worst(const timeline *t, uint32_t *steps, uint32_t most) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->steps; i++) {
        uint32_t at = count;
        while (at > 0 && t->frames[i].time.total > t->frames[steps[at - 1]].time.total) {
            at--;
        }
        if (at >= most) {
            continue;
        }
        count += count < most;
        memmove(&steps[at + 1], &steps[at], (count - 1 - at) * sizeof *steps);
        steps[at] = i;
    }
    return count;
}

uint32_t timeline_over(const timeline *t, double budget_ms) {
    uint32_t over = 0;
    for (uint32_t i = 0; i < t->steps; i++) {
        over += budget_ms > 0 && (double)t->frames[i].time.total * 1e-6 > budget_ms;
    }
    return over;
}

/* --- why --- */

#define STANDS_OUT 1.1  /* times the median */
#define MOST_STAGES 3u  /* told of */
#define MOST_EXCESS 0.8 /* of what is above the median is explained at least, as far as three stages do */

/* "narrow 5.20 ms (median 0.31) for 412 manifolds computed (35), 300 of new pairs (2)" */
static void explain_stage(const talus_frame *frame, const talus_frame *median, int stage, gltf_text *out) {
    uint32_t told = 0;
    gltf_text_add(out, "%s %.3f ms (median %.3f)", talus_stage_name((talus_stage)stage),
                  (double)frame->time.stage[stage] * 1e-6, (double)median->time.stage[stage] * 1e-6);
    for (const unsigned char *cause = CAUSES[stage]; *cause != COUNTS; cause++) {
        uint32_t value = timeline_counted(frame, *cause), usual = timeline_counted(median, *cause);
        if (value > usual && (double)value > STANDS_OUT * usual) {
            const timeline_count *c = &timeline_counts[*cause];
            gltf_text_add(out, "%s%" PRIu32 " %s (%" PRIu32 ")", told++ == 0 ? " for " : ", ", value,
                          value == 1 ? c->one : c->many, usual);
        }
    }
    if (told == 0) {
        gltf_text_add(out, " for no more than usual");
    }
}

/* The stage that is furthest above its median among those not told of yet; TALUS_STAGE_COUNT if none is above. */
static int next_stage(const talus_frame *frame, const talus_frame *median, const int *told) {
    int best = TALUS_STAGE_COUNT;
    uint64_t most = 0;
    for (int i = 0; i < TALUS_STAGE_COUNT; i++) {
        uint64_t now = frame->time.stage[i], usual = median->time.stage[i];
        if (!told[i] && now > usual && now - usual > most) {
            best = i, most = now - usual;
        }
    }
    return best;
}

static void add_count(gltf_text *out, const char *before, uint32_t count, const char *one, const char *many) {
    gltf_text_add(out, "%s%" PRIu32 " %s", before, count, count == 1 ? one : many);
}

static void explain_islands(const timeline *t, const talus_frame *frame, gltf_text *out) {
    const talus_frame_island *island = &frame->largest[0];
    if (frame->counters.islands_woken > 0) {
        add_count(out, "; ", frame->counters.islands_woken, "island", "islands");
        add_count(out, " of ", frame->counters.bodies_woken, "body woke", "bodies woke");
    }
    if (frame->largest_count == 0 || frame->time.total == 0) {
        return;
    }
    add_count(out, "; the largest of ", frame->islands, "island", "islands");
    gltf_text_add(out, ", around %s (held by %" PRIu32 "): ", timeline_name(t, island->body.index), island->held);
    add_count(out, "", island->bodies, "body", "bodies");
    add_count(out, ", ", island->contacts, "contact", "contacts");
    add_count(out, ", ", island->joints, "joint", "joints");
    gltf_text_add(out, ", %.0f %% of the step", 100.0 * (double)island->ticks / (double)frame->time.total);
    if (frame->islands_age > 0) {
        add_count(out, ", as counted ", frame->islands_age, "step before", "steps before");
    }
}

void timeline_explain(const timeline *t, const talus_frame *median, uint32_t step, gltf_text *out) {
    const talus_frame *frame = &t->frames[step];
    int told[TALUS_STAGE_COUNT] = {0};
    double excess = (double)frame->time.total - (double)median->time.total, explained = 0;
    if ((double)frame->time.total <= STANDS_OUT * (double)median->time.total) {
        gltf_text_add(out, "as the median frame");
    } else {
        for (uint32_t n = 0; n < MOST_STAGES && explained < MOST_EXCESS * excess; n++) {
            int stage = next_stage(frame, median, told);
            if (stage == TALUS_STAGE_COUNT) {
                break;
            }
            told[stage] = 1;
            explained += (double)frame->time.stage[stage] - (double)median->time.stage[stage];
            gltf_text_add(out, "%s", n == 0 ? "" : "; ");
            explain_stage(frame, median, stage, out);
        }
    }
    explain_islands(t, frame, out);
}
