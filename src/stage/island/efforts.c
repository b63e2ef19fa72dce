/* Efforts: an island whose errors are over the budget gets more sub-steps, and fewer again when they have long been far
 * below it.
 *
 * Contacts are springs of so many Hz as the sub-steps can follow: twice the sub-steps, twice the Hz, and a load presses
 * them a quarter as deep; errors of joints shrink about as fast. So levels are powers of two, each worth a factor of
 * four. Powers of two also take impulses from a sub-step's length to another's without rounding. */
#include "stage/island/efforts.h"

#include <string.h>

#include "stage/island/islands.h"

#define LEVEL_WORTH 4.0f  /* by what a level divides an error */
#define MARGIN 1.5f       /* what a lower level is expected to leave is still below the budget by this */
#define LOWER_AFTER 0.25f /* s: that errors are to be so small for */
#define RAISE_AFTER 0.05f /* s: until what the last raise was worth has shown */

/* The level that the most sub-steps allow. */
static uint32_t most_level(const tl_settings *s) {
    uint32_t level = 0;
    while (level + 1u < TL_EFFORT_LEVELS && s->substeps << (level + 1u) <= s->most_substeps) {
        level++;
    }
    return level;
}

static int has_budget(const tl_step *step) { return step->h->settings.error_budget > 0.0f; }

static void find_islands(tl_step *step) {
    tl_header *h = step->h;
    float *errors = tl_island_quiet(h), *unlifted = tl_island_unlifted(h);
    tl_islands_of_rows(h);
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        errors[tl_awake_body(h)[k]] = unlifted[tl_awake_body(h)[k]] = 0.0f;
    }
    step->has_islands = 1;
}

/* One level for all of an island, at its root first. */
static void level_islands(tl_header *h) {
    tl_body_effort *efforts = tl_body_efforts(h);
    const uint32_t *parent = tl_island_parent(h), *awake = tl_awake_body(h);
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        tl_body_effort *root = &efforts[parent[awake[k]]], *own = &efforts[awake[k]];
        root->level = own->level > root->level ? own->level : root->level;
        root->calm = tl_min(root->calm, own->calm);
    }
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        efforts[awake[k]] = efforts[parent[awake[k]]];
    }
}

/* A bit for each level that awake bodies have, when all of an island have one. */
static uint32_t find_levels(tl_step *step) {
    tl_header *h = step->h;
    tl_body_effort *efforts = tl_body_efforts(h);
    uint32_t most = most_level(&h->settings), levels = 0, any = 0;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        tl_body_effort *e = &efforts[tl_awake_body(h)[k]];
        e->level = e->level > most ? most : e->level;
        any |= e->level;
    }
    if (any) {
        find_islands(step);
        level_islands(h);
    }
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        levels |= 1u << efforts[tl_awake_body(h)[k]].level;
    }
    return levels ? levels : 1u;
}

uint32_t tl_efforts_begin(tl_step *step) {
    talus_counters *n = &step->h->counters;
    n->worst_error = 0.0f;
    n->substeps_least = n->substeps_most = n->substeps_given = n->islands_over = 0;
    step->awake = step->h->awake_bodies;
    uint32_t levels = has_budget(step) ? find_levels(step) : 1u;
    step->parted = (levels & (levels - 1u)) != 0;
    return levels;
}

/* --- a level at a time ------------------------------------------------------------------------ */

static int is_selected(const tl_step *step, uint32_t body) {
    return tl_body_row(step->h)[body] && tl_body_efforts(step->h)[body].level == step->level;
}

/* Puts the level's bodies first: they have the first rows. */
static void select_bodies(tl_step *step) {
    tl_header *h = step->h;
    uint32_t *awake = tl_awake_body(h), *rows = tl_body_row(h), count = 0;
    for (uint32_t k = 0; k < step->awake; k++) {
        uint32_t body = awake[k];
        if (is_selected(step, body)) {
            awake[k] = awake[count], rows[awake[k]] = k + 1u;
            awake[count++] = body, rows[body] = count;
        }
    }
    h->awake_bodies = count;
}

void tl_efforts_select(tl_step *step) {
    tl_header *h = step->h;
    if (!step->parted) {
        return;
    }
    uint32_t count = 0;
    select_bodies(step);
    tl_lists_of_awake(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        uint32_t c = tl_awake_contact(h)[k];
        const tl_contact_meta *m = &tl_contacts(h)[c];
        if (is_selected(step, m->body_a) || is_selected(step, m->body_b)) {
            tl_awake_contact(h)[count++] = c;
        }
    }
    h->awake_contacts = count;
    count = 0;
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        uint32_t j = tl_awake_joint(h)[k];
        if (is_selected(step, tl_joints(h)[j].body_a) || is_selected(step, tl_joints(h)[j].body_b)) {
            tl_awake_joint(h)[count++] = j;
        }
    }
    h->awake_joints = count;
}

/* Counters that each level's solve sets anew. */
#define AT(name) offsetof(talus_counters, name)
static const size_t SUMMED[TL_EFFORT_SUMS] = {
    AT(contacts_touching), AT(colors),          AT(lane_groups),   AT(lanes_used),       AT(joints_solved),
    AT(linkages),          AT(joints_apart),    AT(contacts_left), AT(contacts_pressed), AT(rows.dropped),
    AT(groups_pushed),     AT(groups_bouncing), AT(bodies_planar), AT(contacts_planar)};

static uint32_t *counter(tl_header *h, size_t at) { return (uint32_t *)(void *)((unsigned char *)&h->counters + at); }

static void add_counters(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t i = 0; i < TL_EFFORT_SUMS; i++) {
        step->sums[i] += *counter(h, SUMMED[i]);
    }
    step->most_rows = h->counters.rows.used > step->most_rows ? h->counters.rows.used : step->most_rows;
    step->bounced |= !h->counters.restitution_skipped;
    step->rolled |= !h->counters.rolling_skipped;
}

static void set_counters(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t i = 0; i < TL_EFFORT_SUMS; i++) {
        *counter(h, SUMMED[i]) = step->sums[i];
    }
    h->counters.rows.used = step->most_rows;
    h->counters.restitution_skipped = !step->bounced;
    h->counters.rolling_skipped = !step->rolled;
    h->counters.joints_sleeping = h->joints.used - h->awake_joints;
}

/* --- what was solved -------------------------------------------------------------------------- */

/* Stored impulses are those of a sub-step of level 0, whatever level they were found at. */
static float of_level(float impulse, float scale) {
    float x = impulse * scale;
    return tl_is_finite(x) ? x : 0.0f;
}

static void scale_impulses(const tl_step *step) {
    tl_header *h = step->h;
    float scale = (float)(1u << step->level);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        uint32_t c = tl_awake_contact(h)[k];
        tl_contact_head *head = &tl_heads(h)[c];
        for (uint32_t d = 0; d < 3u; d++) {
            head->friction[d] = of_level(head->friction[d], scale);
        }
        head->twist = of_level(head->twist, scale);
        for (uint32_t p = 0; p < tl_contacts(h)[c].count; p++) {
            tl_points(h)[c].p[p].impulse = of_level(tl_points(h)[c].p[p].impulse, scale);
        }
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        tl_joint_state *s = &tl_joint_states(h)[tl_awake_joint(h)[k]];
        for (uint32_t r = 0; r < TL_JOINT_ROWS; r++) {
            s->impulse[r] = of_level(s->impulse[r], scale);
        }
    }
}

/* m: how far the ends of a joint of a group are apart, and how far its turn off locked axes shifts what is there of the
 * smaller of its bodies. */
static float joint_error(const tl_header *h, const tl_joint_group *g, uint32_t lane) {
    const tl_joint_row *rows = tl_joint_row_pool(h) + g->first_row;
    float way = 0.0f, turn = 0.0f, reach = 0.0f;
    for (uint32_t r = 0; r < g->fixed; r++) {
        float e = rows[r].error[lane] - rows[r].lower[lane];
        uint32_t type = g->code[r] % TL_ROW_TYPES;
        if (type < TL_ROW_ANGULAR || type == TL_ROW_DISTANCE) {
            way += e * e;
        } else {
            turn += e * e;
        }
    }
    for (uint32_t side = 0; side < 2u && turn > 0.0f; side++) {
        uint32_t row = side ? g->b[lane] : g->a[lane];
        float own = row ? tl_body_inertias(h)[tl_awake_body(h)[row - 1u]].reach : 0.0f;
        reach = reach > 0.0f && own > 0.0f ? tl_min(reach, own) : tl_max(reach, own);
    }
    return tl_max(sqrtf(way), sqrtf(turn) * reach);
}

/* Gives the error of what stands in a lane to the island of its bodies, and what it would be without lifts: those have
 * to grow anew at a lower level. */
static void give_error(const tl_header *h, uint32_t a, uint32_t b, float error, float lift) {
    uint32_t root = tl_island_parent(h)[tl_awake_body(h)[(a ? a : b) - 1u]];
    tl_island_quiet(h)[root] = tl_max(error, tl_island_quiet(h)[root]);
    tl_island_unlifted(h)[root] = tl_max(error + lift, tl_island_unlifted(h)[root]);
}

static float note_contacts(const tl_header *h, int give) {
    float worst = 0.0f;
    for (uint32_t i = 0; i < h->groups; i++) {
        const tl_contact_group *g = &tl_group_pool(h)[i];
        for (uint32_t k = 0; k < g->lanes; k++) {
            worst = tl_max(g->deepest[k], worst);
            if (give && (g->a[k] | g->b[k])) {
                give_error(h, g->a[k], g->b[k], g->deepest[k], g->lift[k]);
            }
        }
    }
    return worst;
}

static float note_joints(const tl_header *h, int give) {
    float worst = 0.0f;
    for (uint32_t i = 0; i < h->joint_groups; i++) {
        const tl_joint_group *g = &tl_joint_group_pool(h)[i];
        for (uint32_t k = 0; k < g->lanes; k++) {
            float error = joint_error(h, g, k);
            worst = tl_max(error, worst);
            if (give && (g->a[k] | g->b[k])) {
                give_error(h, g->a[k], g->b[k], error, 0.0f);
            }
        }
    }
    return worst;
}

static void note_errors(tl_step *step) {
    tl_header *h = step->h;
    float worst = tl_max(note_contacts(h, step->has_islands), note_joints(h, step->has_islands));
    if (!step->has_islands && worst > h->settings.error_budget) {
        find_islands(step);
        note_contacts(h, 1);
        note_joints(h, 1);
    }
    h->counters.worst_error = tl_max(worst, h->counters.worst_error);
}

void tl_efforts_note(tl_step *step) {
    talus_counters *n = &step->h->counters;
    n->substeps_least = n->substeps_least ? n->substeps_least : step->substeps;
    n->substeps_most = step->substeps; /* the levels come in ascending order */
    n->substeps_given += step->substeps * step->h->awake_bodies;
    if (has_budget(step)) {
        note_errors(step);
    }
    if (step->level > 0) {
        scale_impulses(step);
    }
    if (step->parted) {
        add_counters(step);
    }
}

/* --- the next step ---------------------------------------------------------------------------- */

static void adjust(tl_body_effort *e, float error, float unlifted, float budget, uint32_t most, float dt) {
    float higher = unlifted * (LEVEL_WORTH * MARGIN); /* at the next lower level */
    if (error > budget && e->calm >= 0.0f && e->level < most) {
        e->level++;
        e->calm = -RAISE_AFTER;
    } else if (higher > budget) {
        e->calm = tl_min(e->calm + dt, 0.0f);
    } else {
        e->calm += dt;
    }
    if (e->calm >= LOWER_AFTER && e->level > 0) {
        do {
            e->level--;
            higher *= LEVEL_WORTH;
        } while (higher <= budget && e->level > 0);
        e->calm = 0.0f;
    }
    e->calm = e->level > 0 ? e->calm : 0.0f;
}

void tl_efforts_end(tl_step *step) {
    tl_header *h = step->h;
    const tl_settings *s = &h->settings;
    h->awake_bodies = step->awake;
    if (step->parted) {
        tl_lists_of_awake(h);
        set_counters(step);
    }
    if (!step->has_islands) {
        return;
    }
    tl_body_effort *efforts = tl_body_efforts(h);
    const uint32_t *parent = tl_island_parent(h), *awake = tl_awake_body(h);
    uint32_t most = most_level(s);
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        if (parent[awake[k]] == awake[k]) {
            float error = tl_island_quiet(h)[awake[k]], unlifted = tl_island_unlifted(h)[awake[k]];
            h->counters.islands_over += error > s->error_budget;
            adjust(&efforts[awake[k]], error, unlifted, s->error_budget, most, step->dt);
        }
    }
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        efforts[awake[k]] = efforts[parent[awake[k]]];
    }
}
