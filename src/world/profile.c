/* The ring of frames: which step fills which place, and what the islands of a step held. */
#include "talus/profile.h"

#include <string.h>

#include "stage/store/lists.h"
#include "world/watch.h"
#include "world/world_internal.h"

uint32_t talus_world_frame_count(const talus_world *world) {
    return tl_world_is_sound(world) ? tl_header_of(world)->frames : 0;
}

talus_status talus_world_get_frame(const talus_world *world, uint32_t age, talus_frame *out) {
    if (!tl_world_is_sound(world) || !out || age >= tl_header_of(world)->frames) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    uint32_t capacity = h->capacity[TL_COUNT_FRAME];
    *out = tl_ring(h)[(h->next_frame + capacity - 1u - age) % capacity];
    return TALUS_OK;
}

#ifndef TALUS_NO_PROFILE

talus_frame *tl_profile_next(tl_header *h) { return h->capacity[TL_COUNT_FRAME] ? &tl_ring(h)[h->next_frame] : NULL; }

void tl_profile_keep(talus_world *world, const talus_profile *time, talus_frame *frame) {
    tl_header *h = tl_header_of(world);
    uint32_t capacity = h->capacity[TL_COUNT_FRAME];
    frame->time = *time;
    talus_world_get_counters(world, &frame->counters);
    frame->step = frame->counters.steps;
    h->next_frame = h->next_frame + 1u < capacity ? h->next_frame + 1u : 0u;
    h->frames += h->frames < capacity;
}

/* --- islands ---------------------------------------------------------------------------------- */

/* Union-find over body rows by Rem's algorithm (Dijkstra, A Discipline of Programming, 1976, ch. 23; Patwary, Blair and
 * Manne, SEA 2010, found it the fastest): a row's parent is never above it, and both paths are followed downwards only
 * until they meet. The parent of what islands do not reach through, the still row 0 and the kinematic ones, is 0. */
static void unite(uint32_t *parent, uint32_t a, uint32_t b) {
    while (parent[a] != parent[b]) {
        if (parent[a] > parent[b]) {
            uint32_t swap = a;
            a = b, b = swap;
        }
        uint32_t above = parent[b];
        parent[b] = parent[a];
        if (above == b) {
            return;
        }
        b = above;
    }
}

/* Ties the two ends of a constraint; returns the tally of one that is in an island. */
static tl_island_tally *tie(uint32_t *parent, tl_island_tally *tally, uint32_t a, uint32_t b) {
    tally[a].held++;
    tally[b].held++;
    if (!parent[a]) {
        return &tally[b];
    }
    if (parent[b]) {
        unite(parent, a, b);
    }
    return &tally[a];
}

static void begin_rows(const tl_header *h, uint32_t rows) {
    uint32_t *parent = tl_row_island(h);
    tl_island_tally *tally = tl_tallies(h);
    const tl_body_meta *bodies = tl_bodies(h);
    const uint32_t *awake = tl_awake_body(h);
    memset(tally, 0, rows * sizeof *tally);
    parent[0] = 0;
    for (uint32_t row = 1; row < rows; row++) {
        uint32_t dynamic = tl_body_type(&bodies[awake[row - 1u]]) == TALUS_DYNAMIC;
        parent[row] = dynamic * row;
        tally[row].bodies = dynamic;
        tally[row].busiest = row;
    }
}

/* The ends of a group of constraints; `rows` of each. */
typedef struct ends {
    uint32_t a[TL_LANES], b[TL_LANES], lanes, rows;
} ends;

/* Groups lie kilobytes apart and have left the nearest cache by now. Fetched by the dozen, before anything depends on
 * what they hold, their lines come side by side and not one after another. */
#define BATCH 16u

static uint32_t fetch_contacts(const tl_header *h, uint32_t first, ends *out) {
    uint32_t count = h->groups - first < BATCH ? h->groups - first : BATCH;
    for (uint32_t i = 0; i < count; i++) {
        const tl_contact_group *g = &tl_group_pool(h)[first + i];
        memcpy(out[i].a, g->a, sizeof g->a);
        memcpy(out[i].b, g->b, sizeof g->b);
        out[i].lanes = g->lanes, out[i].rows = g->points + (g->plane ? 1u : 3u);
    }
    return count;
}

/* The same from the lists, where the groups are of some islands only. */
static void tally_lists(const tl_header *h) {
    uint32_t *parent = tl_row_island(h);
    const uint32_t *rows = tl_body_row(h);
    tl_island_tally *tally = tl_tallies(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        const tl_contact_meta *m = &tl_contacts(h)[tl_awake_contact(h)[k]];
        if (m->flags & TL_CONTACT_COLORED) {
            tl_island_tally *t = tie(parent, tally, rows[m->body_a], rows[m->body_b]);
            t->contacts++;
            t->rows += m->count + 3u;
        }
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        const tl_joint_record *j = &tl_joints(h)[tl_awake_joint(h)[k]];
        if (j->rows > 0) {
            tl_island_tally *t = tie(parent, tally, rows[j->body_a], rows[j->body_b]);
            t->joints++;
            t->rows += j->rows;
        }
    }
}

static void tally_constraints(const tl_header *h) {
    uint32_t *parent = tl_row_island(h);
    tl_island_tally *tally = tl_tallies(h);
    ends batch[BATCH];
    for (uint32_t first = 0, count; first < h->groups; first += count) {
        count = fetch_contacts(h, first, batch);
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t k = 0; k < batch[i].lanes; k++) {
                tl_island_tally *t = tie(parent, tally, batch[i].a[k], batch[i].b[k]);
                t->contacts++;
                t->rows += batch[i].rows;
            }
        }
    }
    for (uint32_t i = 0; i < h->joint_groups; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(h)[i];
        for (uint32_t k = 0; k < g->lanes; k++) {
            tl_island_tally *t = tie(parent, tally, g->a[k], g->b[k]);
            t->joints++;
            t->rows += g->rows;
        }
    }
}

static void add(tl_island_tally *to, const tl_island_tally *t) {
    to->bodies += t->bodies, to->contacts += t->contacts, to->joints += t->joints, to->rows += t->rows;
}

/* Adds each row's tally to its root's. Parents stand below their children, and so are at their root already. */
static void gather(const tl_header *h, uint32_t rows) {
    uint32_t *parent = tl_row_island(h);
    tl_island_tally *tally = tl_tallies(h);
    for (uint32_t row = 1; row < rows; row++) {
        uint32_t root = parent[parent[row]];
        parent[row] = root;
        if (root != row) {
            tl_island_tally *r = &tally[root];
            add(r, &tally[row]);
            r->busiest = tally[row].held > tally[r->busiest].held ? row : r->busiest;
        }
    }
}

static int is_larger(const tl_island_tally *a, const tl_island_tally *b) {
    return a->rows != b->rows ? a->rows > b->rows : a->bodies > b->bodies;
}

/* The roots of the largest islands, the largest first, and how many islands there are; the sum of all goes to row 0. */
static uint32_t find_largest(const tl_header *h, uint32_t rows, uint32_t found[TALUS_FRAME_ISLANDS],
                             uint32_t *islands) {
    const uint32_t *parent = tl_row_island(h);
    tl_island_tally *tally = tl_tallies(h);
    uint32_t count = 0;
    *islands = 0;
    for (uint32_t row = 1; row < rows; row++) {
        if (parent[row] != row) {
            continue;
        }
        ++*islands;
        add(&tally[0], &tally[row]);
        if (count == TALUS_FRAME_ISLANDS && !is_larger(&tally[row], &tally[found[count - 1u]])) {
            continue;
        }
        uint32_t at = count < TALUS_FRAME_ISLANDS ? count++ : count - 1u;
        for (; at > 0 && is_larger(&tally[row], &tally[found[at - 1u]]); at--) {
            found[at] = found[at - 1u];
        }
        found[at] = row;
    }
    return count;
}

/* ticks * part / whole without passing what 64 bits hold. */
static uint64_t share(uint64_t ticks, uint32_t part, uint32_t whole) {
    if (whole == 0) {
        return 0;
    }
    return ticks / whole * part + ticks % whole * part / whole;
}

/* Fills in the islands of the frame but for their ticks. */
static void tally_islands(tl_header *h, int parted, talus_frame *frame) {
    const tl_island_tally *tally = tl_tallies(h);
    uint32_t found[TALUS_FRAME_ISLANDS], rows = h->awake_bodies + 1u;
    begin_rows(h, rows);
    if (parted) {
        tally_lists(h);
    } else {
        tally_constraints(h);
    }
    gather(h, rows);
    frame->largest_count = find_largest(h, rows, found, &frame->islands);
    memset(frame->largest, 0, sizeof frame->largest);
    for (uint32_t i = 0; i < frame->largest_count; i++) {
        const tl_island_tally *from = &tally[found[i]];
        talus_frame_island *to = &frame->largest[i];
        to->body.index = tl_awake_body(h)[from->busiest - 1u];
        to->held = tally[from->busiest].held;
        to->body.generation = tl_bodies(h)[to->body.index].generation;
        to->bodies = from->bodies, to->contacts = from->contacts;
        to->joints = from->joints, to->rows = from->rows;
    }
}

/* Counting islands takes a hundredth of a step in which contacts come and go: too much to do in each of them. */
#define OLDEST 3u       /* steps that a count may be used again although something changed since */
#define MOST_CHANGES 8u /* unless more than this part of all contacts and joints did */

static int is_due(const tl_header *h, const talus_frame *last) {
    uint32_t changes = h->ties - h->tallied;
    return h->frames == 0 || last->islands_age >= OLDEST || changes > h->tallied_ties / MOST_CHANGES;
}

/* While nothing begins or ends to be tied, the islands are those of the last step; so are their rows while the points
 * of all contacts are as many. */
static void find_islands(tl_header *h, int parted, talus_frame *frame) {
    uint32_t capacity = h->capacity[TL_COUNT_FRAME];
    const talus_frame *last = &tl_ring(h)[(h->next_frame + capacity - 1u) % capacity];
    if (is_due(h, last)) {
        tally_islands(h, parted, frame);
        const tl_island_tally *all = tl_tallies(h);
        h->tallied = h->ties;
        h->tallied_ties = all->contacts + all->joints;
        h->tallied_points = h->counters.contact_points;
        frame->islands_age = 0;
        return;
    }
    int changed = h->tallied != h->ties || h->tallied_points != h->counters.contact_points;
    frame->islands = last->islands;
    frame->islands_age = changed ? last->islands_age + 1u : 0u;
    frame->largest_count = last->largest_count;
    memmove(frame->largest, last->largest, sizeof frame->largest);
}

void tl_profile_islands(const tl_step *step, const talus_profile *time, talus_frame *frame) {
    const uint64_t *t = time->stage;
    const talus_counters *n = &step->h->counters;
    uint64_t of_rows = t[TALUS_STAGE_ROWS] + t[TALUS_STAGE_SOLVE] + t[TALUS_STAGE_RELAX] + t[TALUS_STAGE_RESTITUTION];
    uint64_t of_bodies = t[TALUS_STAGE_VELOCITY] + t[TALUS_STAGE_POSITION] + t[TALUS_STAGE_COMMIT];
    find_islands(step->h, step->parted, frame);
    const tl_island_tally *all = tl_tallies(step->h);
    for (uint32_t i = 0; i < frame->largest_count; i++) {
        talus_frame_island *island = &frame->largest[i];
        island->ticks = share(t[TALUS_STAGE_NARROW], island->contacts, n->manifolds_made + n->manifolds_kept) +
                        share(of_rows, island->rows, all->rows) + share(of_bodies, island->bodies, all->bodies);
    }
}

#endif
