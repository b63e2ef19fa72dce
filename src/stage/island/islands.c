/* Islands by union-find (Tarjan 1975) with path halving; the root is the lowest index, so it does not depend on the
 * order. */
#include "stage/island/islands.h"

#include <string.h>

#include "stage/broad/refit.h"

/* m/s: a body that gained this much in the second half of its quiet time is speeding up and stays awake. */
#define GAIN 0.004f

static uint32_t find_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void unite(uint32_t *parent, uint32_t a, uint32_t b) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    if (a < b) {
        parent[b] = a;
    } else {
        parent[a] = b;
    }
}

/* Ties the two ends if both have a row of the solver. */
static void tie_rows(tl_header *h, uint32_t a, uint32_t b) {
    if (tl_body_row(h)[a] && tl_body_row(h)[b]) {
        unite(tl_island_parent(h), a, b);
    }
}

/* Ties the two ends if both may sleep; an end that is a moving kinematic body keeps the other awake. */
static void tie_sleepers(tl_header *h, uint32_t a, uint32_t b) {
    float *quiet = tl_island_quiet(h);
    const tl_body_meta *bodies = tl_bodies(h);
    int dynamic_a = tl_body_is_dynamic(h, a), dynamic_b = tl_body_is_dynamic(h, b);
    if (dynamic_a && dynamic_b) {
        unite(tl_island_parent(h), a, b);
    } else if (dynamic_a && bodies[b].moves) {
        quiet[a] = 0.0f;
    } else if (dynamic_b && bodies[a].moves) {
        quiet[b] = 0.0f;
    }
}

static void tie(tl_header *h, uint32_t a, uint32_t b, int by_rows) {
    if (by_rows) {
        tie_rows(h, a, b);
    } else {
        tie_sleepers(h, a, b);
    }
}

/* island_parent: ties the ends of all touching contacts and joints, by their rows or by what falls asleep together. */
static void find_roots(tl_header *h, int by_rows) {
    uint32_t *parent = tl_island_parent(h);
    const uint32_t *awake = tl_awake_body(h);
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        parent[awake[k]] = awake[k];
    }
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        const tl_contact_meta *m = &tl_contacts(h)[tl_awake_contact(h)[k]];
        if (m->flags & TL_CONTACT_COLORED) {
            tie(h, m->body_a, m->body_b, by_rows);
        }
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        const tl_joint_record *j = &tl_joints(h)[tl_awake_joint(h)[k]];
        tie(h, j->body_a, j->body_b, by_rows);
    }
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        parent[awake[k]] = find_root(parent, awake[k]);
    }
}

void tl_islands_of_rows(tl_header *h) { find_roots(h, 1); }

/* island_parent and, at the roots, island_quiet: the least quiet time of the island. */
static void find_islands(tl_header *h) {
    float *quiet = tl_island_quiet(h);
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t b = tl_awake_body(h)[k];
        quiet[b] = tl_body_quiets(h)[b].time;
    }
    find_roots(h, 0);
    h->counters.islands = 0;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t b = tl_awake_body(h)[k], root = tl_island_parent(h)[b];
        quiet[root] = tl_min(quiet[root], quiet[b]);
        h->counters.islands += root == b && tl_body_is_dynamic(h, b);
    }
}

/* Puts to sleep the islands that were quiet for `time`; those are tied into rings. */
static void sleep_islands(tl_header *h, float time) {
    const uint32_t *parent = tl_island_parent(h);
    const float *quiet = tl_island_quiet(h);
    uint32_t slept = 0;
    for (uint32_t k = h->awake_bodies; k-- > 0;) {
        uint32_t b = tl_awake_body(h)[k], root = parent[b];
        if (!tl_body_is_dynamic(h, b) || !(quiet[root] >= time)) {
            continue;
        }
        h->counters.islands_slept += b == root;
        tl_body_fall_asleep(h, b, root);
        memset(&tl_body_velocity(h)[b], 0, sizeof(tl_row8));
        memset(&tl_body_momentum(h)[b], 0, sizeof(tl_row8));
        memset(&tl_body_quiets(h)[b], 0, sizeof(tl_body_quiet));
        tl_body_previous(h)[b] = tl_body_pose(h)[b];
        tl_body_clear_awake(h, b);
        tl_shapes_settle(h, b);
        slept++;
    }
    h->counters.bodies_slept += slept;
    if (slept) {
        tl_lists_drop_sleeping(h);
    }
}

/* Counts a body's quiet time; returns whether it is long enough. */
static int count_quiet(tl_header *h, uint32_t b, float dt) {
    const tl_settings *s = &h->settings;
    const tl_row8 *v = &tl_body_velocity(h)[b];
    tl_body_quiet *q = &tl_body_quiets(h)[b];
    float speed = tl_length(tl_row_xyz(v)) + tl_length(tl_row_345(v)) * tl_body_inertias(h)[b].reach;
    if (!(speed < s->sleep_speed) || !(tl_bodies(h)[b].flags & TL_BODY_CAN_SLEEP)) {
        q->time = q->speed = 0.0f;
        return 0;
    }
    float half = 0.5f * s->sleep_time, before = q->time;
    q->time += dt;
    if (before < half && q->time >= half) {
        q->speed = speed;
    }
    if (q->time >= s->sleep_time && speed > q->speed + GAIN) {
        q->time = half;
        q->speed = speed;
    }
    return q->time >= s->sleep_time;
}

void tl_stage_sleep(tl_header *h, float dt) {
    int any = 0, stopped = 0;
    for (uint32_t k = h->awake_bodies; k-- > 0;) {
        uint32_t b = tl_awake_body(h)[k];
        if (tl_body_is_dynamic(h, b)) {
            any |= h->settings.enable_sleep && count_quiet(h, b, dt);
        } else if (!tl_bodies(h)[b].moves) {
            tl_body_clear_awake(h, b);
            tl_shapes_settle(h, b);
            stopped = 1;
            tl_contacts_refresh(h, b); /* their points were on the body and are in the world from now on */
        }
    }
    if (stopped) {
        tl_lists_of_awake(h);
        tl_lists_drop_sleeping(h);
    }
    h->counters.sleep_searched = (uint32_t)any;
    if (any) {
        tl_lists_of_awake(h);
        find_islands(h);
        sleep_islands(h, h->settings.sleep_time);
    }
}

void tl_island_sleep(tl_header *h, uint32_t body) {
    if (!tl_body_row(h)[body]) {
        return;
    }
    tl_lists_of_awake(h);
    find_islands(h);
    uint32_t root = tl_island_parent(h)[body];
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t b = tl_awake_body(h)[k];
        tl_island_quiet(h)[tl_island_parent(h)[b]] = 0.0f;
    }
    tl_island_quiet(h)[root] = 1.0f;
    sleep_islands(h, 1.0f);
}
