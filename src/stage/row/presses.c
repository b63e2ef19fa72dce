/* Presses: contacts that bear far more than the weight of what lies between, to be solved at once.
 *
 * Gauss-Seidel hands a load down by the share that the lighter of two bodies has of both: under a body that is R times
 * as heavy it needs R sweeps a contact, and until then the light ones give way. So where a body stands on one many
 * times lighter, the contacts from there on down that bear many times the weight of one of their bodies, as the
 * impulses of the last sub-step have it, are put into a system of their own. It is ordered as linkages are.
 *
 * And so are the contacts of towers that springs would not keep upright. */
#include <stddef.h>
#include <string.h>

#include "stage/row/groups.h"

#define UNLIKE 12.0f /* masses: from here on a body is heavy on another */
#define LOADED 12.0f /* weights of a body: from here on a contact is a load to it */
/* Masses in one press: beyond, what a float rounds is as much as what the light ones need. */
#define MOST_UNLIKE 4096.0f

/* The least and the most of inverse masses, without those that nothing moves. */
typedef struct spread {
    float least, most;
} spread;

static void widen(spread *s, float inverse) {
    if (inverse > 0.0f) {
        s->least = tl_min(s->least, inverse), s->most = tl_max(s->most, inverse);
    }
}

/* Whether some awake bodies' masses are so unlike that there may be a press. */
static int any_unlike(const tl_header *h) {
    spread s = {3.0e38f, 0.0f};
    for (uint32_t row = 1; row <= h->awake_bodies; row++) {
        widen(&s, tl_row_velocity(h)[row].f[6]);
    }
    return s.most > UNLIKE * s.least;
}

/* N s: what a contact bore in the last sub-step. */
static float load_of(const tl_header *h, uint32_t contact) {
    float sum = 0.0f;
    for (uint32_t k = 0; k < tl_contacts(h)[contact].count; k++) {
        sum += tl_points(h)[contact].p[k].impulse;
    }
    return sum;
}

typedef struct finder {
    tl_header *h;
    float least; /* m/s: what a load would give a body in a sub-step, at least */
    uint32_t *queue, *pressed, found;
    uint32_t count; /* contacts to be pressed, whether there is room or not */
} finder;

/* A load to a body that joints tie is left to the sweeps: its press and its linkage would undo one another. */
static int is_load_to(const finder *f, uint32_t row, float load) {
    return load * tl_row_velocity(f->h)[row].f[6] > f->least;
}
static int is_tied(const finder *f, uint32_t row) {
    return row && tl_bodies(f->h)[tl_awake_body(f->h)[row - 1u]].first_joint != TL_NONE;
}

/* A body that a contact presses is looked at in its turn. */
static void press_body(finder *f, uint32_t row, float load) {
    if (!f->pressed[row] && is_load_to(f, row, load) && !is_tied(f, row)) {
        f->pressed[row] = 1u;
        f->queue[f->found++] = row;
    }
}

/* Bodies that bear one many times as heavy. */
static void find_first(finder *f) {
    const tl_header *h = f->h;
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        uint32_t contact = tl_awake_contact(h)[k];
        const tl_contact_meta *m = &tl_contacts(h)[contact];
        uint32_t a = tl_body_row(h)[m->body_a], b = tl_body_row(h)[m->body_b];
        float ma = tl_row_velocity(h)[a].f[6], mb = tl_row_velocity(h)[b].f[6];
        if ((m->flags & TL_CONTACT_COLORED) && tl_min(ma, mb) > 0.0f && tl_max(ma, mb) > UNLIKE * tl_min(ma, mb)) {
            press_body(f, ma > mb ? a : b, load_of(h, contact));
        }
    }
}

/* Bodies that bear what those bear. */
static void find_rest(finder *f) {
    const tl_header *h = f->h;
    for (uint32_t head = 0; head < f->found; head++) {
        uint32_t body = tl_awake_body(h)[f->queue[head] - 1u];
        for (uint32_t link = tl_body_links(h)[body].first_pair; link != TL_NONE;
             link = tl_pair_links(h)[link / 2u].next[link & 1u]) {
            const tl_pair *p = &tl_pairs(h)[link / 2u];
            if (p->contact != TL_NONE && (tl_contacts(h)[p->contact].flags & TL_CONTACT_COLORED)) {
                press_body(f, tl_body_row(h)[link & 1u ? p->body_a : p->body_b], load_of(h, p->contact));
            }
        }
    }
}

/* The contacts of towers, and those of pressed bodies that are a load to one of theirs, as they lie in the groups. */
static void collect(finder *f) {
    tl_header *h = f->h;
    for (uint32_t i = 0; i < h->groups; i++) {
        const tl_contact_group *g = &tl_group_pool(h)[i];
        for (uint32_t k = 0; k < g->lanes; k++) {
            uint32_t a = g->a[k], b = g->b[k];
            if (!(f->pressed[a] | f->pressed[b])) {
                continue;
            }
            int in_tower = f->pressed[a] == TL_TOWER || f->pressed[b] == TL_TOWER;
            float load = in_tower ? 0.0f : load_of(h, g->contact[k]);
            int on_a = is_load_to(f, a, load), on_b = is_load_to(f, b, load);
            if (!in_tower && (!(on_a || on_b) || (on_a && is_tied(f, a)) || (on_b && is_tied(f, b)))) {
                continue;
            }
            if (f->count++ >= h->capacity[TL_COUNT_PRESSED]) {
                continue;
            }
            tl_pressed *p = &tl_pressed_pool(h)[h->pressed++];
            memset(p, 0, sizeof *p);
            p->place = i * TL_LANES + k;
            p->row[0] = g->a[k], p->row[1] = g->b[k];
            p->points =
                g->plane ? tl_plane_points(tl_contact_plane(h)[g->contact[k]]) : tl_contacts(h)[g->contact[k]].count;
            p->rows = p->points + (g->plane ? 1u : 2u);
        }
    }
}

/* Before their rows are filled in, pressed contacts are no more than where they are and how many rows there will be. */
static void swap_places(tl_pressed *a, tl_pressed *b) {
    unsigned char place[offsetof(tl_pressed, holds)];
    memcpy(place, a, sizeof place);
    memcpy(a, b, sizeof place);
    memcpy(b, place, sizeof place);
}

/* The contacts that hang together with the one at `first`, which become the order from there on; f->pressed numbers
 * their bodies from 1. Returns how many there are. */
static uint32_t gather(finder *f, uint32_t first, uint32_t *ends) {
    tl_header *h = f->h;
    tl_pressed *pool = tl_pressed_pool(h);
    uint32_t count = 1, numbers = 0;
    for (uint32_t k = first; k < first + count; k++) {
        for (uint32_t side = 0; side < 2u; side++) {
            uint32_t row = pool[k].row[side];
            if (tl_row_velocity(h)[row].f[6] > 0.0f && !f->pressed[row]) {
                f->pressed[row] = ++numbers;
                for (uint32_t j = first + count; j < h->pressed; j++) {
                    if (pool[j].row[0] == row || pool[j].row[1] == row) {
                        swap_places(&pool[j], &pool[first + count++]);
                    }
                }
            }
        }
    }
    *ends = numbers;
    return count;
}

static uint32_t end_of(const finder *f, uint32_t row) {
    return tl_row_velocity(f->h)[row].f[6] > 0.0f ? f->pressed[row] - 1u : TL_BLOCK_FREE;
}

/* What was met last is taken first, as in linkages. */
static void reverse(tl_pressed *p, uint32_t count) {
    for (uint32_t k = 0; k < count / 2u; k++) {
        swap_places(&p[k], &p[count - 1u - k]);
    }
}

/* Where the factor of a press of `count` contacts lies, in rows of eight: of a node, as many as it has rows and one
 * more; of a block, as many as its column's node has. Returns how many floats that takes. */
static uint32_t place_values(tl_block_node *node, uint32_t count, tl_block *blocks) {
    uint32_t offset = 0;
    for (uint32_t j = 0; j < count; j++) {
        node[j].diagonal = offset;
        offset += (node[j].rows + 1u) * TL_LANES;
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            tl_block *b = &blocks[node[j].first + k];
            b->values = offset;
            offset += node[j].rows * TL_LANES;
        }
    }
    return offset;
}

/* The inverse masses of the bodies of `count` contacts. */
static spread masses_of(const tl_header *h, const tl_pressed *p, uint32_t count) {
    spread s = {3.0e38f, 0.0f};
    for (uint32_t k = 0; k < 2u * count; k++) {
        widen(&s, tl_row_velocity(h)[p[k / 2u].row[k % 2u]].f[6]);
    }
    return s;
}

/* Makes presses of what was collected; contacts whose factor has no room stay out of any. */
static void make_presses(finder *f) {
    tl_header *h = f->h;
    uint32_t scratch[TL_BLOCK_SCRATCH(TL_MOST_PRESSED, 2u * TL_MOST_PRESSED)], blocks = 0, values = 0, count;
    memset(f->pressed, 0, (h->awake_bodies + 1u) * sizeof(uint32_t));
    for (uint32_t first = 0; first < h->pressed; first += count) {
        uint32_t ends, room = h->capacity[TL_COUNT_PRESSBLOCK] - blocks, size;
        count = gather(f, first, &ends);
        reverse(tl_pressed_pool(h) + first, count);
        tl_block_node *node = tl_press_nodes(h) + first;
        for (uint32_t k = 0; k < count; k++) {
            const tl_pressed *p = &tl_pressed_pool(h)[first + k];
            node[k].end[0] = end_of(f, p->row[0]), node[k].end[1] = end_of(f, p->row[1]);
            node[k].rows = p->rows;
        }
        uint32_t used = tl_block_plan(node, count, ends, tl_press_blocks(h), blocks, room, scratch, &size);
        uint32_t left = h->capacity[TL_COUNT_PRESSVALUE] - values;
        size = used == TL_BLOCK_FREE ? 0u : place_values(node, count, tl_press_blocks(h));
        spread masses = masses_of(h, tl_pressed_pool(h) + first, count);
        if (used == TL_BLOCK_FREE || size > left || masses.most > MOST_UNLIKE * masses.least) {
            h->counters.contacts_left += count;
            continue;
        }
        tl_press *s = &tl_presses(h)[h->presses++];
        memset(s, 0, sizeof *s);
        s->first = first, s->count = count, s->values = values;
        s->rings = count > ends;
        s->alike = !(masses.most > UNLIKE * masses.least);
        blocks += used, values += size;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t place = tl_pressed_pool(h)[first + k].place;
            tl_group_pool(h)[place / TL_LANES].pressed |= 1u << place % TL_LANES;
        }
        h->counters.contacts_pressed += count;
    }
}

void tl_stage_find_presses(tl_step *step) {
    tl_header *h = step->h;
    float gravity = tl_length(h->settings.gravity);
    finder f = {h, LOADED * gravity * step->sub / step->warm_scale, tl_linkage_queue(h), tl_linkage_rows(h), 0, 0};
    h->presses = h->pressed = h->counters.contacts_pressed = h->counters.contacts_left = 0;
    int unlike = any_unlike(h), towers = tl_towers_likely(h);
    if (!(f.least > 0.0f) || !(unlike || towers)) {
        return;
    }
    memset(f.pressed, 0, (h->awake_bodies + 1u) * sizeof(uint32_t));
    uint32_t standing = towers ? tl_towers_find(step, f.pressed, h->capacity[TL_COUNT_PRESSED]) : 0u;
    if (unlike) {
        find_first(&f);
        find_rest(&f);
    }
    if (f.found + standing > 0) {
        collect(&f);
        if (f.count == h->pressed) {
            make_presses(&f);
        } else { /* part of what bears a load is worse than nothing: the rest would give way to it */
            h->counters.contacts_left = f.count;
        }
    }
}
