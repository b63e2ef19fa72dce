#include "stage/store/lists.h"

#include <string.h>

#include "base/bits.h"
#include "base/sort.h"

/* --- colours ---------------------------------------------------------------------------------- */

uint32_t tl_color_take(tl_header *h, uint32_t body_a, uint32_t body_b) {
    tl_ties_changed(h);
    uint64_t *colors = tl_body_colors(h);
    int dynamic_a = tl_body_is_dynamic(h, body_a), dynamic_b = tl_body_is_dynamic(h, body_b);
    uint64_t used = (dynamic_a ? colors[body_a] : 0u) | (dynamic_b ? colors[body_b] : 0u);
    uint32_t color = 0;
    while (color < TL_COLORS && (used >> color & 1u)) {
        color++;
    }
    if (color == TL_COLORS) {
        return color;
    }
    if (dynamic_a) {
        colors[body_a] |= (uint64_t)1 << color;
    }
    if (dynamic_b) {
        colors[body_b] |= (uint64_t)1 << color;
    }
    return color;
}

void tl_color_give(tl_header *h, uint32_t body_a, uint32_t body_b, uint32_t color) {
    tl_ties_changed(h);
    if (color >= TL_COLORS) {
        return;
    }
    uint64_t *colors = tl_body_colors(h);
    if (tl_body_is_dynamic(h, body_a)) {
        colors[body_a] &= ~((uint64_t)1 << color);
    }
    if (tl_body_is_dynamic(h, body_b)) {
        colors[body_b] &= ~((uint64_t)1 << color);
    }
}

/* --- contacts --------------------------------------------------------------------------------- */

static float combine(float a, uint32_t rule_a, float b, uint32_t rule_b) {
    switch (rule_a < rule_b ? rule_a : rule_b) {
    case TALUS_COMBINE_AVERAGE:
        return 0.5f * (a + b);
    case TALUS_COMBINE_MINIMUM:
        return tl_min(a, b);
    case TALUS_COMBINE_MAXIMUM:
        return tl_max(a, b);
    default:
        return a * b;
    }
}

void tl_contact_mix(tl_header *h, uint32_t contact) {
    const tl_contact_meta *c = &tl_contacts(h)[contact];
    const tl_material *a = &tl_shape_material(h)[c->shape_a], *b = &tl_shape_material(h)[c->shape_b];
    tl_contact_material *m = &tl_contact_materials(h)[contact];
    m->static_friction = combine(a->static_friction, a->friction_combine, b->static_friction, b->friction_combine);
    m->dynamic_friction = combine(a->dynamic_friction, a->friction_combine, b->dynamic_friction, b->friction_combine);
    m->restitution = combine(a->restitution, a->restitution_combine, b->restitution, b->restitution_combine);
    m->rolling = tl_max(a->rolling_resistance, b->rolling_resistance);
}

uint32_t tl_contact_make(tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    uint64_t *alive = tl_contact_alive(h);
    uint32_t i = tl_bit_first_free(alive, h->capacity[TL_COUNT_CONTACT]);
    if (i == TL_NONE) {
        return i;
    }
    tl_bit_add(alive, i);
    tl_pool *pool = &h->contacts;
    pool->used++;
    pool->peak = pool->used > pool->peak ? pool->used : pool->peak;
    pool->high = i >= pool->high ? i + 1u : pool->high;
    tl_contact_meta *meta = &tl_contacts(h)[i];
    const tl_shape_meta *a = &tl_shapes(h)[shape_a], *b = &tl_shapes(h)[shape_b];
    uint32_t flags = a->flags | b->flags;
    meta->flags = TL_CONTACT_ALIVE | (flags & TL_SHAPE_SENSOR ? TL_CONTACT_SENSOR : 0u) |
                  (flags & TL_SHAPE_EVENTS ? TL_CONTACT_EVENTS : 0u);
    meta->shape_a = shape_a, meta->shape_b = shape_b;
    meta->body_a = a->body, meta->body_b = b->body;
    meta->color = TL_COLORS;
    tl_contact_mix(h, i);
    tl_contact_enter(h, i);
    return i;
}

void tl_contact_enter(tl_header *h, uint32_t contact) {
    const tl_contact_meta *meta = &tl_contacts(h)[contact];
    uint32_t pair = tl_pair_find(h, meta->shape_a, meta->shape_b);
    if (pair == TL_NONE) {
        pair = tl_pair_make_for_contact(h, meta->shape_a, meta->shape_b);
    }
    tl_contact_tie(h, contact, pair);
}

void tl_contact_tie(tl_header *h, uint32_t contact, uint32_t pair) {
    const tl_contact_meta *meta = &tl_contacts(h)[contact];
    tl_pairs(h)[pair].contact = contact;
    tl_contact_pair(h)[contact] = pair;
    if (tl_body_row(h)[meta->body_a] || tl_body_row(h)[meta->body_b]) {
        tl_bit_add(tl_contact_awake(h), contact);
    }
}

void tl_contact_clear(tl_header *h, uint32_t contact) {
    memset(&tl_contacts(h)[contact], 0, sizeof(tl_contact_meta));
    memset(&tl_heads(h)[contact], 0, sizeof(tl_contact_head));
    memset(&tl_points(h)[contact], 0, sizeof(tl_contact_points));
    memset(&tl_contact_caches(h)[contact], 0, sizeof(tl_pair_cache));
    memset(&tl_contact_materials(h)[contact], 0, sizeof(tl_contact_material));
}

void tl_contact_end(tl_header *h, uint32_t contact, uint32_t clear) {
    uint32_t pair = tl_contact_pair(h)[contact];
    tl_pair_cache hint = tl_contact_caches(h)[contact];
    const tl_contact_meta *meta = &tl_contacts(h)[contact];
    if (meta->flags & TL_CONTACT_COLORED) {
        tl_color_give(h, meta->body_a, meta->body_b, meta->color);
    }
    tl_contact_clear(h, contact);
    tl_bit_drop(tl_contact_alive(h), contact);
    tl_bit_drop(tl_contact_awake(h), contact);
    h->contacts.used--;
    h->contacts.high = tl_bit_end(tl_contact_alive(h), h->contacts.high);
    tl_pair_leave_contact(h, pair, clear, &hint);
}

static int is_of_shape(const tl_contact_meta *m, uint32_t shape) { return m->shape_a == shape || m->shape_b == shape; }

uint32_t tl_contacts_of(const tl_header *h, uint32_t body, uint32_t shape) {
    uint64_t *keys = tl_new_touch(h);
    uint32_t count = 0;
    const tl_pair_link *links = tl_pair_links(h);
    for (uint32_t l = tl_body_links(h)[body].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        uint32_t c = tl_pairs(h)[l >> 1].contact;
        if (c != TL_NONE && (shape == TL_NONE || is_of_shape(&tl_contacts(h)[c], shape))) {
            keys[count++] = c;
        }
    }
    tl_sort_keys(keys, count);
    for (uint32_t k = 0; k < count; k++) {
        tl_contact_order(h)[k] = (uint32_t)keys[k];
    }
    return count;
}

void tl_contacts_refresh(tl_header *h, uint32_t body) {
    const tl_pair_link *links = tl_pair_links(h);
    for (uint32_t l = tl_body_links(h)[body].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        tl_pair *p = &tl_pairs(h)[l >> 1];
        p->clear = 0;
        if (p->contact != TL_NONE) {
            tl_contacts(h)[p->contact].flags |= TL_CONTACT_FRESH;
        }
    }
}

void tl_lists_of_awake(tl_header *h) {
    h->awake_contacts = tl_bit_list(tl_contact_awake(h), h->contacts.high, tl_awake_contact(h));
    h->awake_joints = tl_bit_list(tl_joint_awake(h), h->joints.high, tl_awake_joint(h));
}

/* --- joints ----------------------------------------------------------------------------------- */

void tl_joint_link(tl_header *h, uint32_t joint) {
    tl_joint_record *joints = tl_joints(h), *j = &joints[joint];
    uint32_t body[2] = {j->body_a, j->body_b};
    for (unsigned side = 0; side < 2u; side++) {
        tl_body_meta *meta = &tl_bodies(h)[body[side]];
        uint32_t first = meta->first_joint;
        j->next[side] = first;
        j->previous[side] = TL_NONE;
        if (first != TL_NONE) {
            joints[first >> 1].previous[first & 1u] = joint << 1 | side;
        }
        meta->first_joint = joint << 1 | side;
    }
    j->color = tl_color_take(h, j->body_a, j->body_b);
    if (tl_body_row(h)[j->body_a] || tl_body_row(h)[j->body_b]) {
        tl_bit_add(tl_joint_awake(h), joint);
    }
}

void tl_joint_unlink(tl_header *h, uint32_t joint) {
    tl_joint_record *joints = tl_joints(h), *j = &joints[joint];
    uint32_t body[2] = {j->body_a, j->body_b};
    tl_bit_drop(tl_joint_awake(h), joint);
    tl_color_give(h, j->body_a, j->body_b, j->color);
    for (unsigned side = 0; side < 2u; side++) {
        uint32_t next = j->next[side], previous = j->previous[side];
        if (previous != TL_NONE) {
            joints[previous >> 1].next[previous & 1u] = next;
        } else {
            tl_bodies(h)[body[side]].first_joint = next;
        }
        if (next != TL_NONE) {
            joints[next >> 1].previous[next & 1u] = previous;
        }
    }
}

/* --- sleep ------------------------------------------------------------------------------------ */

void tl_body_set_awake(tl_header *h, uint32_t body) {
    uint32_t *rows = tl_body_row(h);
    tl_body_meta *meta = &tl_bodies(h)[body];
    if (rows[body]) {
        return;
    }
    tl_ties_changed(h);
    tl_awake_body(h)[h->awake_bodies] = body;
    rows[body] = ++h->awake_bodies;
    meta->flags |= TL_BODY_AWAKE;
    tl_body_quiets(h)[body].time = 0.0f;
    tl_body_quiets(h)[body].speed = 0.0f;
    const tl_pair_link *links = tl_pair_links(h);
    for (uint32_t l = tl_body_links(h)[body].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        uint32_t contact = tl_pairs(h)[l >> 1].contact;
        tl_pair_set_awake(h, l >> 1);
        if (contact != TL_NONE) {
            tl_bit_add(tl_contact_awake(h), contact);
        }
    }
    const tl_joint_record *joints = tl_joints(h);
    for (uint32_t l = meta->first_joint; l != TL_NONE; l = joints[l >> 1].next[l & 1u]) {
        tl_bit_add(tl_joint_awake(h), l >> 1);
    }
}

void tl_body_clear_awake(tl_header *h, uint32_t body) {
    uint32_t *rows = tl_body_row(h), *list = tl_awake_body(h), row = rows[body];
    if (row == 0) {
        return;
    }
    tl_ties_changed(h);
    uint32_t last = list[--h->awake_bodies];
    list[row - 1u] = last;
    rows[last] = row;
    rows[body] = 0;
    if (tl_body_way(h)[body] & TL_WAY_DOUBTED) {
        tl_pairs_doubt(h, body);
    }
    tl_body_way(h)[body] = 0;
    tl_bodies(h)[body].flags &= ~(uint32_t)TL_BODY_AWAKE;
}

void tl_island_wake(tl_header *h, uint32_t body) {
    if (tl_body_row(h)[body] || !tl_body_is_dynamic(h, body)) {
        return;
    }
    tl_body_link *links = tl_body_links(h);
    uint32_t i = body;
    do {
        uint32_t next = links[i].sleep_next;
        links[i].sleep_next = tl_bodies(h)[i].island = TL_NONE;
        tl_body_set_awake(h, i);
        h->counters.bodies_woken++;
        i = next;
    } while (i != TL_NONE && i != body);
    h->counters.islands_woken++;
}

void tl_body_fall_asleep(tl_header *h, uint32_t body, uint32_t island) {
    tl_body_link *links = tl_body_links(h);
    tl_bodies(h)[body].island = island;
    if (links[island].sleep_next == TL_NONE) {
        links[island].sleep_next = island;
    }
    if (body != island) {
        links[body].sleep_next = links[island].sleep_next;
        links[island].sleep_next = body;
    }
}

void tl_lists_drop_sleeping(tl_header *h) {
    const uint32_t *rows = tl_body_row(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        const tl_contact_meta *m = &tl_contacts(h)[tl_awake_contact(h)[k]];
        if (!rows[m->body_a] && !rows[m->body_b]) {
            tl_bit_drop(tl_contact_awake(h), tl_awake_contact(h)[k]);
        }
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        const tl_joint_record *j = &tl_joints(h)[tl_awake_joint(h)[k]];
        if (!rows[j->body_a] && !rows[j->body_b]) {
            tl_bit_drop(tl_joint_awake(h), tl_awake_joint(h)[k]);
        }
    }
    tl_pairs_drop_sleeping(h);
}

void tl_joint_remove(tl_header *h, uint32_t i) {
    tl_joint_record *j = &tl_joints(h)[i];
    tl_island_wake(h, j->body_a);
    tl_island_wake(h, j->body_b);
    tl_joint_unlink(h, i);
    h->breaking_joints -= j->break_force > 0.0f || j->break_torque > 0.0f;
    uint32_t body[2] = {j->body_a, j->body_b}, generation = j->generation, moved = j->flags & TL_JOINT_COLLIDE;
    memset(j, 0, sizeof *j);
    j->generation = generation;
    j->free_next = h->joints.free;
    h->joints.free = i;
    h->joints.used--;
    for (int k = 0; k < 2 && !moved; k++) { /* the two may collide from now on */
        if (tl_body_is_dynamic(h, body[k])) {
            for (uint32_t s = tl_bodies(h)[body[k]].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
                tl_shape_mark_moved(h, s);
            }
        }
    }
}
