#include "stage/store/lists.h"

#include <string.h>

/* --- the pair table --------------------------------------------------------------------------- */

static uint32_t hash_pair(uint32_t a, uint32_t b) {
    uint64_t x = ((uint64_t)a << 32 | b) * 0x9e3779b97f4a7c15u; /* Fibonacci hashing, Knuth TAOCP 3, 6.4 */
    return (uint32_t)(x >> 32) ^ (uint32_t)(x >> 15);
}

uint32_t tl_pair_find(const tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    const uint32_t *slots = tl_pair_slot(h);
    const tl_contact_link *links = tl_contact_links(h);
    uint32_t mask = h->capacity[TL_COUNT_SLOT] - 1u;
    for (uint32_t i = hash_pair(shape_a, shape_b) & mask; slots[i] != 0; i = (i + 1u) & mask) {
        const tl_contact_link *l = &links[slots[i] - 1u];
        if (l->shape_a == shape_a && l->shape_b == shape_b) {
            return slots[i] - 1u;
        }
    }
    return TL_NONE;
}

static void pair_insert(tl_header *h, uint32_t contact) {
    uint32_t *slots = tl_pair_slot(h);
    const tl_contact_link *l = &tl_contact_links(h)[contact];
    uint32_t mask = h->capacity[TL_COUNT_SLOT] - 1u;
    uint32_t i = hash_pair(l->shape_a, l->shape_b) & mask;
    while (slots[i] != 0) {
        i = (i + 1u) & mask;
    }
    slots[i] = contact + 1u;
}

/* Knuth TAOCP 3, 6.4, algorithm R: closes the gap so that no search ends early. */
static void pair_remove(tl_header *h, uint32_t contact) {
    uint32_t *slots = tl_pair_slot(h);
    const tl_contact_link *links = tl_contact_links(h);
    uint32_t mask = h->capacity[TL_COUNT_SLOT] - 1u;
    uint32_t i = hash_pair(links[contact].shape_a, links[contact].shape_b) & mask;
    while (slots[i] != contact + 1u) {
        i = (i + 1u) & mask;
    }
    for (uint32_t j = (i + 1u) & mask; slots[j] != 0; j = (j + 1u) & mask) {
        const tl_contact_link *l = &links[slots[j] - 1u];
        uint32_t home = hash_pair(l->shape_a, l->shape_b) & mask;
        if (((j - home) & mask) >= ((j - i) & mask)) {
            slots[i] = slots[j];
            i = j;
        }
    }
    slots[i] = 0;
}

void tl_pairs_rebuild(tl_header *h) {
    memset(tl_pair_slot(h), 0, h->capacity[TL_COUNT_SLOT] * sizeof(uint32_t));
    for (uint32_t i = 0; i < h->contacts.high; i++) {
        if (tl_contacts(h)[i].flags & TL_CONTACT_ALIVE) {
            pair_insert(h, i);
        }
    }
}

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

static void contact_push(tl_header *h, uint32_t contact, unsigned side, uint32_t body) {
    tl_contact_link *links = tl_contact_links(h);
    tl_body_meta *meta = &tl_bodies(h)[body];
    uint32_t first = meta->first_contact;
    links[contact].next[side] = first;
    links[contact].previous[side] = TL_NONE;
    if (first != TL_NONE) {
        links[first >> 1].previous[first & 1u] = contact << 1 | side;
    }
    meta->first_contact = contact << 1 | side;
}

static void contact_pull(tl_header *h, uint32_t contact, unsigned side, uint32_t body) {
    tl_contact_link *links = tl_contact_links(h);
    uint32_t next = links[contact].next[side], previous = links[contact].previous[side];
    if (previous != TL_NONE) {
        links[previous >> 1].next[previous & 1u] = next;
    } else {
        tl_bodies(h)[body].first_contact = next;
    }
    if (next != TL_NONE) {
        links[next >> 1].previous[next & 1u] = previous;
    }
}

static void contact_set_awake(tl_header *h, uint32_t contact) {
    tl_contact_meta *meta = &tl_contacts(h)[contact];
    if (meta->awake_index == TL_NONE) {
        meta->awake_index = h->awake_contacts;
        tl_awake_contact(h)[h->awake_contacts++] = contact;
    }
}

static void contact_clear_awake(tl_header *h, uint32_t contact) {
    tl_contact_meta *metas = tl_contacts(h);
    uint32_t *list = tl_awake_contact(h), at = metas[contact].awake_index;
    if (at != TL_NONE) {
        uint32_t last = list[--h->awake_contacts];
        list[at] = last;
        metas[last].awake_index = at;
        metas[contact].awake_index = TL_NONE;
    }
}

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
    const tl_contact_link *l = &tl_contact_links(h)[contact];
    const tl_material *a = &tl_shape_material(h)[l->shape_a], *b = &tl_shape_material(h)[l->shape_b];
    tl_contact_material *m = &tl_contact_materials(h)[contact];
    m->static_friction = combine(a->static_friction, a->friction_combine, b->static_friction, b->friction_combine);
    m->dynamic_friction = combine(a->dynamic_friction, a->friction_combine, b->dynamic_friction, b->friction_combine);
    m->restitution = combine(a->restitution, a->restitution_combine, b->restitution, b->restitution_combine);
    m->rolling = tl_max(a->rolling_resistance, b->rolling_resistance);
}

uint32_t tl_contact_make(tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    uint32_t i = tl_pool_top(&h->contacts, h->capacity[TL_COUNT_CONTACT]);
    if (i == TL_NONE) {
        return i;
    }
    tl_contact_meta *meta = &tl_contacts(h)[i];
    tl_contact_link *link = &tl_contact_links(h)[i];
    if (i == h->contacts.free) {
        h->contacts.free = link->next[0];
    } else {
        h->contacts.high++;
    }
    h->contacts.used++;
    h->contacts.peak = h->contacts.used > h->contacts.peak ? h->contacts.used : h->contacts.peak;
    const tl_shape_meta *a = &tl_shapes(h)[shape_a], *b = &tl_shapes(h)[shape_b];
    uint32_t flags = a->flags | b->flags;
    memset(meta, 0, sizeof *meta);
    memset(&tl_heads(h)[i], 0, sizeof(tl_contact_head));
    memset(&tl_points(h)[i], 0, sizeof(tl_contact_points));
    memset(&tl_contact_caches(h)[i], 0, sizeof(tl_pair_cache));
    meta->flags = TL_CONTACT_ALIVE | TL_CONTACT_FRESH | (flags & TL_SHAPE_SENSOR ? TL_CONTACT_SENSOR : 0u) |
                  (flags & TL_SHAPE_EVENTS ? TL_CONTACT_EVENTS : 0u);
    meta->body_a = a->body, meta->body_b = b->body;
    meta->color = TL_COLORS;
    meta->awake_index = TL_NONE;
    link->shape_a = shape_a, link->shape_b = shape_b;
    tl_contact_mix(h, i);
    contact_push(h, i, 0, a->body);
    contact_push(h, i, 1, b->body);
    pair_insert(h, i);
    if (tl_body_row(h)[a->body] || tl_body_row(h)[b->body]) {
        contact_set_awake(h, i);
    }
    return i;
}

void tl_contact_end(tl_header *h, uint32_t contact) {
    tl_contact_meta *meta = &tl_contacts(h)[contact];
    tl_contact_link *link = &tl_contact_links(h)[contact];
    if (meta->flags & TL_CONTACT_COLORED) {
        tl_color_give(h, meta->body_a, meta->body_b, meta->color);
    }
    pair_remove(h, contact);
    contact_clear_awake(h, contact);
    contact_pull(h, contact, 0, meta->body_a);
    contact_pull(h, contact, 1, meta->body_b);
    memset(meta, 0, sizeof *meta);
    memset(link, 0, sizeof *link);
    meta->awake_index = TL_NONE;
    link->next[0] = h->contacts.free;
    h->contacts.free = contact;
    h->contacts.used--;
}

void tl_contacts_refresh(tl_header *h, uint32_t body) {
    const tl_contact_link *links = tl_contact_links(h);
    for (uint32_t l = tl_bodies(h)[body].first_contact; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        tl_contacts(h)[l >> 1].flags |= TL_CONTACT_FRESH;
    }
}

/* --- joints ----------------------------------------------------------------------------------- */

static void joint_set_awake(tl_header *h, uint32_t joint) {
    tl_joint_record *j = &tl_joints(h)[joint];
    if (j->awake_index == TL_NONE) {
        j->awake_index = h->awake_joints;
        tl_awake_joint(h)[h->awake_joints++] = joint;
    }
}

static void joint_clear_awake(tl_header *h, uint32_t joint) {
    tl_joint_record *joints = tl_joints(h);
    uint32_t *list = tl_awake_joint(h), at = joints[joint].awake_index;
    if (at != TL_NONE) {
        uint32_t last = list[--h->awake_joints];
        list[at] = last;
        joints[last].awake_index = at;
        joints[joint].awake_index = TL_NONE;
    }
}

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
        joint_set_awake(h, joint);
    }
}

void tl_joint_unlink(tl_header *h, uint32_t joint) {
    tl_joint_record *joints = tl_joints(h), *j = &joints[joint];
    uint32_t body[2] = {j->body_a, j->body_b};
    joint_clear_awake(h, joint);
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
    const tl_contact_link *links = tl_contact_links(h);
    for (uint32_t l = meta->first_contact; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
        contact_set_awake(h, l >> 1);
    }
    const tl_joint_record *joints = tl_joints(h);
    for (uint32_t l = meta->first_joint; l != TL_NONE; l = joints[l >> 1].next[l & 1u]) {
        joint_set_awake(h, l >> 1);
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
    tl_bodies(h)[body].flags &= ~(uint32_t)TL_BODY_AWAKE;
}

void tl_island_wake(tl_header *h, uint32_t body) {
    if (tl_body_row(h)[body] || !tl_body_is_dynamic(h, body)) {
        return;
    }
    tl_body_meta *bodies = tl_bodies(h);
    uint32_t i = body;
    do {
        uint32_t next = bodies[i].sleep_next;
        bodies[i].sleep_next = TL_NONE;
        tl_body_set_awake(h, i);
        h->counters.bodies_woken++;
        i = next;
    } while (i != TL_NONE && i != body);
    h->counters.islands_woken++;
}

void tl_lists_drop_sleeping(tl_header *h) {
    const uint32_t *rows = tl_body_row(h);
    const tl_contact_meta *contacts = tl_contacts(h);
    for (uint32_t k = h->awake_contacts; k-- > 0;) {
        uint32_t c = tl_awake_contact(h)[k];
        if (!rows[contacts[c].body_a] && !rows[contacts[c].body_b]) {
            contact_clear_awake(h, c);
        }
    }
    for (uint32_t k = h->awake_joints; k-- > 0;) {
        uint32_t j = tl_awake_joint(h)[k];
        if (!rows[tl_joints(h)[j].body_a] && !rows[tl_joints(h)[j].body_b]) {
            joint_clear_awake(h, j);
        }
    }
}

/* --- shapes that moved ----------------------------------------------------------------------- */

void tl_shape_mark_moved(tl_header *h, uint32_t shape) {
    tl_shape_meta *meta = &tl_shapes(h)[shape];
    if (!(meta->flags & TL_SHAPE_MOVED)) {
        meta->flags |= TL_SHAPE_MOVED;
        tl_moved_shape(h)[h->moved_shapes++] = shape;
    }
}

void tl_shape_unmark_moved(tl_header *h, uint32_t shape) {
    if (tl_shapes(h)[shape].flags & TL_SHAPE_MOVED) {
        uint32_t *list = tl_moved_shape(h), k = 0;
        while (list[k] != shape) {
            k++;
        }
        for (h->moved_shapes--; k < h->moved_shapes; k++) {
            list[k] = list[k + 1u];
        }
        tl_shapes(h)[shape].flags &= ~(uint32_t)TL_SHAPE_MOVED;
    }
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
    j->awake_index = TL_NONE;
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
