#include "stage/store/pairs.h"

#include <string.h>

#include "base/prefetch.h"

/* --- the table -------------------------------------------------------------------------------- */

static uint32_t hash_pair(uint32_t a, uint32_t b) {
    uint64_t x = ((uint64_t)a << 32 | b) * 0x9e3779b97f4a7c15u; /* Fibonacci hashing, Knuth TAOCP 3, 6.4 */
    return (uint32_t)(x >> 32) ^ (uint32_t)(x >> 15);
}

static uint32_t home_of(const tl_header *h, uint32_t pair) {
    const tl_pair *p = &tl_pairs(h)[pair];
    return hash_pair(p->shape_a, p->shape_b) & (h->capacity[TL_COUNT_SLOT] - 1u);
}

uint32_t tl_pair_find(const tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    const uint32_t *slots = tl_pair_slot(h);
    const tl_pair *pairs = tl_pairs(h);
    uint32_t mask = h->capacity[TL_COUNT_SLOT] - 1u;
    for (uint32_t i = hash_pair(shape_a, shape_b) & mask; slots[i] != 0; i = (i + 1u) & mask) {
        const tl_pair *p = &pairs[slots[i] - 1u];
        if (p->shape_a == shape_a && p->shape_b == shape_b) {
            return slots[i] - 1u;
        }
    }
    return TL_NONE;
}

void tl_pair_prefetch(const tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    tl_prefetch(&tl_pair_slot(h)[hash_pair(shape_a, shape_b) & (h->capacity[TL_COUNT_SLOT] - 1u)]);
}

static void table_insert(tl_header *h, uint32_t pair) {
    uint32_t *slots = tl_pair_slot(h), mask = h->capacity[TL_COUNT_SLOT] - 1u, i = home_of(h, pair);
    while (slots[i] != 0) {
        i = (i + 1u) & mask;
    }
    slots[i] = pair + 1u;
}

/* Knuth TAOCP 3, 6.4, algorithm R: closes the gap so that no search ends early. */
static void table_remove(tl_header *h, uint32_t pair) {
    uint32_t *slots = tl_pair_slot(h), mask = h->capacity[TL_COUNT_SLOT] - 1u, i = home_of(h, pair);
    while (slots[i] != pair + 1u) {
        i = (i + 1u) & mask;
    }
    for (uint32_t j = (i + 1u) & mask; slots[j] != 0; j = (j + 1u) & mask) {
        uint32_t home = home_of(h, slots[j] - 1u);
        if (((j - home) & mask) >= ((j - i) & mask)) {
            slots[i] = slots[j];
            i = j;
        }
    }
    slots[i] = 0;
}

/* --- lists ------------------------------------------------------------------------------------ */

static void list_push(tl_header *h, uint32_t pair, unsigned side, uint32_t body) {
    tl_pair_link *links = tl_pair_links(h);
    uint32_t *first = &tl_body_links(h)[body].first_pair;
    links[pair].next[side] = *first;
    links[pair].previous[side] = TL_NONE;
    if (*first != TL_NONE) {
        links[*first >> 1].previous[*first & 1u] = pair << 1 | side;
    }
    *first = pair << 1 | side;
}

static void list_pull(tl_header *h, uint32_t pair, unsigned side, uint32_t body) {
    tl_pair_link *links = tl_pair_links(h);
    uint32_t next = links[pair].next[side], previous = links[pair].previous[side];
    if (previous != TL_NONE) {
        links[previous >> 1].next[previous & 1u] = next;
    } else {
        tl_body_links(h)[body].first_pair = next;
    }
    if (next != TL_NONE) {
        links[next >> 1].previous[next & 1u] = previous;
    }
}

void tl_pair_set_awake(tl_header *h, uint32_t pair) {
    tl_pair *p = &tl_pairs(h)[pair];
    if (p->awake_index == TL_NONE) {
        p->awake_index = h->awake_pairs;
        tl_awake_pair(h)[h->awake_pairs++] = pair;
    }
}

static void clear_awake(tl_header *h, uint32_t pair) {
    tl_pair *pairs = tl_pairs(h);
    uint32_t *list = tl_awake_pair(h), at = pairs[pair].awake_index;
    if (at != TL_NONE) {
        uint32_t last = list[--h->awake_pairs];
        list[at] = last;
        pairs[last].awake_index = at;
        pairs[pair].awake_index = TL_NONE;
    }
}

void tl_pairs_doubt(tl_header *h, uint32_t body) {
    const tl_pair_link *links = tl_pair_links(h);
    for (uint32_t l = tl_body_links(h)[body].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        tl_pairs(h)[l >> 1].clear = 0;
    }
}

void tl_pairs_drop_sleeping(tl_header *h) {
    const uint32_t *rows = tl_body_row(h);
    for (uint32_t k = h->awake_pairs; k-- > 0;) {
        uint32_t pair = tl_awake_pair(h)[k];
        if (!rows[tl_pairs(h)[pair].body_a] && !rows[tl_pairs(h)[pair].body_b]) {
            clear_awake(h, pair);
        }
    }
}

/* --- making and ending ------------------------------------------------------------------------ */

uint32_t tl_pair_make_for_contact(tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    uint32_t i = tl_pool_top(&h->pairs, h->capacity[TL_COUNT_PAIR]);
    tl_pair *p = &tl_pairs(h)[i];
    tl_pool_take(&h->pairs, i, tl_pair_links(h)[i].next[0]);
    p->shape_a = shape_a, p->shape_b = shape_b;
    p->body_a = tl_shapes(h)[shape_a].body, p->body_b = tl_shapes(h)[shape_b].body;
    p->contact = p->awake_index = TL_NONE;
    p->motion = p->clear = 0;
    memset(&tl_pair_hints(h)[i], 0, sizeof(tl_pair_cache));
    list_push(h, i, 0, p->body_a);
    list_push(h, i, 1, p->body_b);
    table_insert(h, i);
    if (tl_body_row(h)[p->body_a] || tl_body_row(h)[p->body_b]) {
        tl_pair_set_awake(h, i);
    }
    return i;
}

/* Room for pairs that are apart, less than 0 when there is one too many. */
static int64_t room_apart(const tl_header *h) {
    return (int64_t)TL_APART_PER_CONTACT * h->capacity[TL_COUNT_CONTACT] - (h->pairs.used - h->contacts.used);
}

uint32_t tl_pair_make(tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    return room_apart(h) > 0 ? tl_pair_make_for_contact(h, shape_a, shape_b) : TL_NONE;
}

void tl_pair_end(tl_header *h, uint32_t pair) {
    tl_pair *p = &tl_pairs(h)[pair];
    table_remove(h, pair);
    clear_awake(h, pair);
    list_pull(h, pair, 0, p->body_a);
    list_pull(h, pair, 1, p->body_b);
    p->shape_a = p->shape_b = 0;
    p->contact = TL_NONE;
    tl_pair_links(h)[pair].next[0] = h->pairs.free;
    h->pairs.free = pair;
    h->pairs.used--;
}

void tl_pair_leave_contact(tl_header *h, uint32_t pair, uint32_t clear, const tl_pair_cache *hint) {
    tl_pair *p = &tl_pairs(h)[pair];
    p->contact = TL_NONE;
    p->motion = tl_body_motion(h)[p->body_a] + tl_body_motion(h)[p->body_b];
    p->clear = clear;
    tl_pair_hints(h)[pair] = *hint;
    if (room_apart(h) < 0) {
        tl_shape_mark_moved(h, p->shape_a);
        tl_pair_end(h, pair);
    }
}

void tl_pairs_end_apart(tl_header *h, uint32_t shape) {
    uint32_t body = tl_shapes(h)[shape].body;
    for (uint32_t l = tl_body_links(h)[body].first_pair; l != TL_NONE;) {
        uint32_t pair = l >> 1, next = tl_pair_links(h)[pair].next[l & 1u];
        const tl_pair *p = &tl_pairs(h)[pair];
        if ((p->shape_a == shape || p->shape_b == shape) && p->contact == TL_NONE) {
            tl_pair_end(h, pair);
        }
        l = next;
    }
}

/* --- shapes that moved ------------------------------------------------------------------------ */

void tl_shape_mark_moved(tl_header *h, uint32_t shape) {
    tl_shape_track *t = &tl_shape_tracks(h)[shape];
    t->stale = 0;
    if (!t->moved) {
        tl_moved_shape(h)[h->moved_shapes++] = shape;
        t->moved = h->moved_shapes;
    }
}

void tl_shape_mark_stale(tl_header *h, uint32_t shape) {
    tl_shape_track *t = &tl_shape_tracks(h)[shape];
    if (!t->moved) {
        tl_shape_mark_moved(h, shape);
        t->stale = 1;
    }
}

void tl_shape_unmark_moved(tl_header *h, uint32_t shape) {
    tl_shape_track *tracks = tl_shape_tracks(h);
    uint32_t at = tracks[shape].moved;
    if (at) {
        uint32_t last = tl_moved_shape(h)[--h->moved_shapes];
        tl_moved_shape(h)[at - 1u] = last;
        tracks[last].moved = at;
        tracks[shape].moved = tracks[shape].stale = 0;
    }
}
