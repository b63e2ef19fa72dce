#include "world/reindex.h"

#include <string.h>

#include "base/bits.h"
#include "stage/broad/refit.h"

/* Whether a joint keeps its two bodies from colliding. */
static int parts(const tl_joint_record *j) {
    return (j->flags & (TL_JOINT_ALIVE | TL_JOINT_COLLIDE)) == TL_JOINT_ALIVE;
}

void tl_reindex_begin(tl_header *h, uint32_t bodies) {
    uint32_t rows = bodies > h->bodies.high ? bodies : h->bodies.high;
    memset(tl_island_parent(h), 0, rows * sizeof(uint32_t));
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        tl_joint_group *was = &tl_joint_group_pool(h)[i];
        was->lanes = (uint32_t)parts(j);
        was->a[0] = j->body_a, was->b[0] = j->body_b;
    }
}

void tl_reindex_part_contact(tl_header *h, uint32_t contact) {
    tl_contact_meta *m = &tl_contacts(h)[contact];
    if (m->flags & TL_CONTACT_ALIVE) {
        tl_pair *p = &tl_pairs(h)[tl_contact_pair(h)[contact]];
        p->contact = TL_NONE;
        p->clear = 0;
        if (m->flags & TL_CONTACT_COLORED) {
            tl_color_give(h, m->body_a, m->body_b, m->color);
        }
        tl_bit_drop(tl_contact_awake(h), contact);
    }
    m->body_a = TL_NONE; /* says so until the contacts are tied to their pairs */
}

/* --- whether the state is one ------------------------------------------------------------------ */

static int is_body(const tl_header *h, uint32_t i) {
    return i < h->bodies.high && (tl_bodies(h)[i].flags & TL_BODY_ALIVE) != 0;
}

static int is_shape(const tl_header *h, uint32_t i) {
    return i < h->shapes.high && (tl_shapes(h)[i].flags & TL_SHAPE_ALIVE) != 0;
}

static int bodies_are_sound(const tl_header *h) {
    const tl_body_meta *bodies = tl_bodies(h);
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        const tl_body_meta *m = &bodies[i];
        if (!(m->flags & TL_BODY_ALIVE)) {
            if (!tl_is_index(m->free_next, h->bodies.high)) {
                return 0;
            }
            continue;
        }
        int sleeps = tl_body_type(m) == TALUS_DYNAMIC && !(m->flags & TL_BODY_AWAKE);
        if (tl_body_type(m) >= TALUS_BODY_TYPE_COUNT || !tl_is_index(m->first_shape, h->shapes.high) ||
            !tl_is_link(m->first_joint, h->joints.high) || sleeps != (m->island != TL_NONE) ||
            (sleeps && (!is_body(h, m->island) || bodies[m->island].island != m->island))) {
            return 0;
        }
    }
    return is_body(h, 0);
}

static int shapes_are_sound(const tl_header *h) {
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        const tl_shape_meta *m = &tl_shapes(h)[i];
        if (!tl_is_index(m->next, h->shapes.high) || ((m->flags & TL_SHAPE_ALIVE) && !is_body(h, m->body))) {
            return 0;
        }
    }
    return 1;
}

static int joints_are_sound(const tl_header *h) {
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        if (!(j->flags & TL_JOINT_ALIVE)) {
            if (!tl_is_index(j->free_next, h->joints.high)) {
                return 0;
            }
            continue;
        }
        if (!is_body(h, j->body_a) || !is_body(h, j->body_b) || j->rows > TL_JOINT_ROWS || j->fixed > 6u ||
            j->color > TL_COLORS) {
            return 0;
        }
        for (int side = 0; side < 2; side++) {
            if (!tl_is_link(j->next[side], h->joints.high) || !tl_is_link(j->previous[side], h->joints.high)) {
                return 0;
            }
        }
    }
    return 1;
}

static int are_shapes(const tl_header *h, const tl_contact_meta *m) {
    return m->shape_a < m->shape_b && is_shape(h, m->shape_a) && is_shape(h, m->shape_b);
}

/* --- shapes and pairs -------------------------------------------------------------------------- */

static void renew_pairs(tl_header *h) {
    const uint32_t *other = tl_island_parent(h), *way = tl_body_way(h);
    const tl_shape_track *tracks = tl_shape_tracks(h);
    for (uint32_t i = 0; i < h->pairs.high; i++) {
        tl_pair *p = &tl_pairs(h)[i];
        if (p->shape_b == 0) {
            continue;
        }
        if (tracks[p->shape_a].stale == TL_SHAPE_OTHER || tracks[p->shape_b].stale == TL_SHAPE_OTHER) {
            tl_pair_end(h, i);
        } else if ((other[p->body_a] | other[p->body_b]) || ((way[p->body_a] | way[p->body_b]) & TL_WAY_DOUBTED)) {
            p->clear = 0;
        }
    }
    memset(tl_body_way(h), 0, h->capacity[TL_COUNT_BODY] * sizeof(uint32_t)); /* there is no doubt left */
}

/* Where bodies alone became others, pairs are kept, but not what they know. */
static void doubt_pairs(tl_header *h) {
    const uint32_t *other = tl_island_parent(h), *rows = tl_body_row(h);
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        if (other[i] && rows[i]) { /* without a look at each pair, which lie in no order */
            tl_body_way(h)[i] |= TL_WAY_DOUBTED;
            h->doubted = 1;
        } else if (other[i]) {
            tl_pairs_doubt(h, i);
        }
    }
}

/* Frees all pairs; what has a shape will be paired anew. */
static void drop_pairs(tl_header *h) {
    for (uint32_t i = 0; i < h->pairs.high; i++) {
        if (tl_pairs(h)[i].shape_b != 0) {
            tl_pair_end(h, i);
        }
    }
    for (uint32_t s = 0; s < h->shapes.high; s++) {
        if (is_shape(h, s)) {
            tl_shape_mark_moved(h, s);
        }
    }
}

static void renew_shapes(tl_header *h, uint32_t rows) {
    const uint32_t *other = tl_island_parent(h);
    const tl_body_meta *bodies = tl_bodies(h);
    for (uint32_t s = 0; s < rows; s++) {
        tl_shape_track *t = &tl_shape_tracks(h)[s];
        const tl_shape_meta *m = &tl_shapes(h)[s];
        int alive = is_shape(h, s);
        if (t->stale == TL_SHAPE_OTHER) {
            tl_shape_leave_tree(h, s);
            tl_shape_unmark_moved(h, s);
            t->stale = 0;
            if (alive) {
                tl_shape_mark_moved(h, s);
            }
        } else if (alive && (t->stale || other[m->body])) {
            if (bodies[m->body].flags & TL_BODY_AWAKE) {
                tl_shape_mark_stale(h, s);
            } else {
                tl_shape_mark_moved(h, s);
            }
        }
    }
}

/* --- bodies, contacts and joints ---------------------------------------------------------------- */

static int is_awake(const tl_body_meta *m) {
    return (m->flags & (TL_BODY_ALIVE | TL_BODY_AWAKE)) == (TL_BODY_ALIVE | TL_BODY_AWAKE);
}

/* Whether the bodies that are awake are those that were. */
static int are_as_awake(const tl_header *h, uint32_t before) {
    const uint32_t *rows = tl_body_row(h);
    uint32_t differ = 0;
    for (uint32_t i = 0; i < h->bodies.high || i < before; i++) {
        differ |= (uint32_t)(is_awake(&tl_bodies(h)[i]) != (rows[i] != 0));
    }
    return !differ;
}

static void renew_awake(tl_header *h) {
    memset(tl_body_row(h), 0, h->capacity[TL_COUNT_BODY] * sizeof(uint32_t));
    h->awake_bodies = h->awake_pairs = 0;
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        if (is_awake(&tl_bodies(h)[i])) {
            tl_awake_body(h)[h->awake_bodies] = i;
            tl_body_row(h)[i] = ++h->awake_bodies;
        }
    }
    for (uint32_t i = 0; i < h->pairs.high; i++) {
        tl_pair *p = &tl_pairs(h)[i];
        p->awake_index = TL_NONE;
        if (p->shape_b != 0 && (tl_body_row(h)[p->body_a] || tl_body_row(h)[p->body_b])) {
            tl_pair_set_awake(h, i);
        }
    }
}

/* The rings of those that fell asleep together, and lists of bodies that there were not. */
static void renew_rings(tl_header *h, uint32_t before) {
    tl_body_link *links = tl_body_links(h);
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        links[i].sleep_next = TL_NONE;
        if (i >= before) {
            links[i].first_pair = TL_NONE;
        }
    }
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        const tl_body_meta *m = &tl_bodies(h)[i];
        if ((m->flags & (TL_BODY_ALIVE | TL_BODY_AWAKE)) == TL_BODY_ALIVE && m->island != TL_NONE) {
            tl_body_fall_asleep(h, i, m->island);
        }
    }
}

static void take_color(tl_header *h, uint32_t a, uint32_t b, uint32_t color) {
    uint64_t bit = color < TL_COLORS ? (uint64_t)1 << color : 0;
    tl_body_colors(h)[a] |= tl_body_is_dynamic(h, a) ? bit : 0;
    tl_body_colors(h)[b] |= tl_body_is_dynamic(h, b) ? bit : 0;
}

/* Gives a contact the bodies, the pair and the colour that its shapes call for; 0 if they are none. */
static int enter_contact(tl_header *h, uint32_t c) {
    tl_contact_meta *m = &tl_contacts(h)[c];
    if (!are_shapes(h, m)) {
        return 0;
    }
    m->body_a = tl_shapes(h)[m->shape_a].body, m->body_b = tl_shapes(h)[m->shape_b].body;
    tl_contact_mix(h, c);
    tl_contact_enter(h, c);
    return 1;
}

static void color_contact(tl_header *h, uint32_t c) {
    const tl_contact_meta *m = &tl_contacts(h)[c];
    if (m->flags & TL_CONTACT_COLORED) {
        take_color(h, m->body_a, m->body_b, m->color);
    }
}

/* Where bodies, shapes and joints are those that were: only contacts that took a slot are not in their place. */
static talus_status renew_new_contacts(tl_header *h, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        uint32_t c = tl_contact_order(h)[k];
        if (!enter_contact(h, c)) {
            return TALUS_BAD_BLOB;
        }
        color_contact(h, c);
    }
    return TALUS_OK;
}

static talus_status renew_contacts(tl_header *h) {
    memset(tl_contact_awake(h), 0, h->capacity[TL_COUNT_CONTACTBIT] * sizeof(uint64_t));
    for (uint32_t c = 0; c < h->contacts.high; c++) {
        const tl_contact_meta *m = &tl_contacts(h)[c];
        if (!tl_bit_has(tl_contact_alive(h), c)) {
            continue;
        }
        uint32_t hint = tl_contact_pair(h)[c];
        const tl_pair *p = &tl_pairs(h)[hint];
        if (m->body_a != TL_NONE && p->shape_a == m->shape_a && p->shape_b == m->shape_b) { /* none became another */
            tl_contact_tie(h, c, hint);
        } else if (!enter_contact(h, c)) {
            return TALUS_BAD_BLOB;
        }
        color_contact(h, c);
    }
    return TALUS_OK;
}

static void mark_shapes(tl_header *h, uint32_t body) {
    if (is_body(h, body) && tl_body_is_dynamic(h, body)) {
        for (uint32_t s = 0; s < h->shapes.high; s++) {
            if (is_shape(h, s) && tl_shapes(h)[s].body == body) {
                tl_shape_mark_moved(h, s);
            }
        }
    }
}

/* Where a joint kept two bodies from colliding and does not any more, there are no pairs yet. */
static void renew_parted(tl_header *h, uint32_t before) {
    for (uint32_t i = 0; i < before; i++) {
        const tl_joint_group *was = &tl_joint_group_pool(h)[i];
        const tl_joint_record *j = &tl_joints(h)[i];
        int is = parts(j) && j->body_a == was->a[0] && j->body_b == was->b[0];
        if (was->lanes && !is) {
            mark_shapes(h, was->a[0]);
            mark_shapes(h, was->b[0]);
        }
    }
}

static void renew_joints(tl_header *h) {
    const uint32_t *rows = tl_body_row(h);
    memset(tl_joint_awake(h), 0, h->capacity[TL_COUNT_JOINTBIT] * sizeof(uint64_t));
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        if (!(j->flags & TL_JOINT_ALIVE)) {
            continue;
        }
        take_color(h, j->body_a, j->body_b, j->color);
        if (rows[j->body_a] || rows[j->body_b]) {
            tl_bit_add(tl_joint_awake(h), i);
        }
    }
}

talus_status tl_reindex_end(tl_header *h, const tl_header *before, const tl_changes *changes) {
    uint32_t shapes = before->shapes.high > h->shapes.high ? before->shapes.high : h->shapes.high;
    int others = changes->metas || changes->shapes;
    if ((changes->metas && (!bodies_are_sound(h) || !joints_are_sound(h))) || (others && !shapes_are_sound(h))) {
        return TALUS_BAD_BLOB;
    }
    if (changes->metas) {
        renew_rings(h, before->bodies.high);
    }
    if (others) {
        renew_pairs(h);
    } else if (changes->bodies) {
        doubt_pairs(h);
    }
    if (changes->bodies || others) {
        renew_shapes(h, shapes);
    }
    if (h->pairs.used > TL_APART_PER_CONTACT * h->capacity[TL_COUNT_CONTACT]) {
        drop_pairs(h); /* not to leave the contacts without room */
        others = 1;
    }
    int others_awake = changes->metas && !are_as_awake(h, before->bodies.high);
    if (others_awake) {
        renew_awake(h);
    }
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        if (tl_body_row(h)[i]) {
            tl_body_previous(h)[i] = tl_body_pose(h)[i];
        }
    }
    tl_ties_changed(h);
    talus_status status;
    if (others) {
        memset(tl_body_colors(h), 0, h->bodies.high * sizeof(uint64_t));
        renew_joints(h);
        renew_parted(h, before->joints.high);
        status = renew_contacts(h);
    } else {
        status = renew_new_contacts(h, changes->contacts);
    }
    tl_lists_of_awake(h);
    return status;
}
