/* Whether the links and counts of a block say one thing: lists both ways, pools, colours, pair table, trees, sleep
 * rings. */
#ifndef STORE_CHECK_H
#define STORE_CHECK_H

#include "base/bits.h"
#include "stage/broad/refit.h"
#include "stage/store/lists.h"
#include "world_kit.h"

#define SOUND(what)                                                                                                    \
    do {                                                                                                               \
        if (!(what)) {                                                                                                 \
            print_error("unsound: %s\n", #what);                                                                       \
            _fail(__FILE__, __LINE__);                                                                                 \
        }                                                                                                              \
    } while (0)

static inline uint64_t bit_of(uint32_t color) { return color < TL_COLORS ? (uint64_t)1 << color : 0; }

/* Takes a constraint's colour on a body; no other one may have it. */
static inline void check_color(const tl_header *h, uint64_t *seen, uint32_t body, uint32_t color) {
    if (tl_body_is_dynamic(h, body)) {
        SOUND(!(seen[body] & bit_of(color)));
        seen[body] |= bit_of(color);
    }
}

static inline void check_pairs(const tl_header *h) {
    uint32_t alive = 0, slots = 0, awake = 0, touching = 0;
    for (uint32_t i = 0; i < h->pairs.high; i++) {
        const tl_pair *p = &tl_pairs(h)[i];
        if (p->shape_b == 0) {
            continue;
        }
        alive++;
        SOUND(p->shape_a < p->shape_b);
        SOUND(tl_pair_find(h, p->shape_a, p->shape_b) == i);
        SOUND(tl_shapes(h)[p->shape_a].body == p->body_a && tl_shapes(h)[p->shape_b].body == p->body_b);
        SOUND((tl_shapes(h)[p->shape_a].flags & TL_SHAPE_ALIVE) && (tl_shapes(h)[p->shape_b].flags & TL_SHAPE_ALIVE));
        SOUND(p->awake_index == TL_NONE || (p->awake_index < h->awake_pairs && tl_awake_pair(h)[p->awake_index] == i));
        SOUND(p->awake_index != TL_NONE || !(tl_body_row(h)[p->body_a] || tl_body_row(h)[p->body_b]));
        SOUND(p->contact == TL_NONE || tl_contact_pair(h)[p->contact] == i);
        awake += p->awake_index != TL_NONE;
        touching += p->contact != TL_NONE;
    }
    for (uint32_t i = 0; i < h->capacity[TL_COUNT_SLOT]; i++) {
        slots += tl_pair_slot(h)[i] != 0;
    }
    SOUND(alive == h->pairs.used && slots == alive && awake == h->awake_pairs && touching == h->contacts.used);
    uint32_t loose = 0;
    for (uint32_t i = h->pairs.free; i != TL_NONE; i = tl_pair_links(h)[i].next[0]) {
        SOUND(i < h->pairs.high && tl_pairs(h)[i].shape_b == 0 && loose++ < h->pairs.high);
    }
    SOUND(loose + alive == h->pairs.high);
}

static inline void check_contacts(const tl_header *h, uint64_t *seen) {
    uint32_t alive = 0, high = 0;
    for (uint32_t i = 0; i < h->capacity[TL_COUNT_CONTACT]; i++) {
        const tl_contact_meta *m = &tl_contacts(h)[i];
        int awake = tl_bit_has(tl_contact_awake(h), i);
        SOUND(tl_bit_has(tl_contact_alive(h), i) == ((m->flags & TL_CONTACT_ALIVE) != 0));
        if (!(m->flags & TL_CONTACT_ALIVE)) {
            SOUND(!awake);
            continue;
        }
        alive++;
        high = i + 1u;
        const tl_pair *p = &tl_pairs(h)[tl_contact_pair(h)[i]];
        SOUND(p->contact == i && p->shape_a == m->shape_a && p->shape_b == m->shape_b);
        SOUND(tl_shapes(h)[m->shape_a].body == m->body_a && tl_shapes(h)[m->shape_b].body == m->body_b);
        SOUND(awake || !(tl_body_row(h)[m->body_a] || tl_body_row(h)[m->body_b]));
        if (m->flags & TL_CONTACT_COLORED) {
            check_color(h, seen, m->body_a, m->color);
            check_color(h, seen, m->body_b, m->color);
        }
    }
    SOUND(alive == h->contacts.used && high == h->contacts.high);
}

static inline void check_joints(const tl_header *h, uint64_t *seen) {
    uint32_t alive = 0;
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        if (!(j->flags & TL_JOINT_ALIVE)) {
            continue;
        }
        alive++;
        SOUND(tl_bit_has(tl_joint_awake(h), i) || !(tl_body_row(h)[j->body_a] || tl_body_row(h)[j->body_b]));
        check_color(h, seen, j->body_a, j->color);
        check_color(h, seen, j->body_b, j->color);
    }
    SOUND(alive == h->joints.used);
}

/* The lists of a body: every link's back link, and no body but this one at its side. Counts the links. */
static inline void check_body_lists(const tl_header *h, uint32_t b, uint32_t *pairs, uint32_t *joints,
                                    uint32_t *shapes) {
    uint32_t before = TL_NONE;
    for (uint32_t l = tl_body_links(h)[b].first_pair; l != TL_NONE; l = tl_pair_links(h)[l >> 1].next[l & 1u]) {
        const tl_pair *p = &tl_pairs(h)[l >> 1];
        SOUND(tl_pair_links(h)[l >> 1].previous[l & 1u] == before && (l & 1u ? p->body_b : p->body_a) == b);
        SOUND(p->shape_b != 0);
        (*pairs)++;
        before = l;
    }
    before = TL_NONE;
    for (uint32_t l = tl_bodies(h)[b].first_joint; l != TL_NONE; l = tl_joints(h)[l >> 1].next[l & 1u]) {
        const tl_joint_record *j = &tl_joints(h)[l >> 1];
        SOUND(j->previous[l & 1u] == before && (l & 1u ? j->body_b : j->body_a) == b && (j->flags & TL_JOINT_ALIVE));
        (*joints)++;
        before = l;
    }
    for (uint32_t s = tl_bodies(h)[b].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
        SOUND(tl_shapes(h)[s].body == b && (tl_shapes(h)[s].flags & TL_SHAPE_ALIVE));
        (*shapes)++;
    }
}

/* Rings of sleepers: closed, of sleeping dynamic bodies only. */
static inline void check_sleep(const tl_header *h, uint32_t b) {
    const tl_body_meta *m = &tl_bodies(h)[b];
    int dynamic = tl_body_is_dynamic(h, b), awake = tl_body_row(h)[b] != 0;
    SOUND(awake == ((m->flags & TL_BODY_AWAKE) != 0));
    SOUND(!awake || tl_awake_body(h)[tl_body_row(h)[b] - 1u] == b);
    SOUND((dynamic && !awake) == (tl_body_links(h)[b].sleep_next != TL_NONE));
    SOUND((dynamic && !awake) == (m->island != TL_NONE));
    if (dynamic && !awake) {
        uint32_t i = b, steps = 0;
        SOUND(m->island <= b && tl_bodies(h)[m->island].island == m->island);
        do {
            SOUND(tl_bodies(h)[i].island == m->island);
            SOUND(i < h->bodies.high && !tl_body_row(h)[i] && (tl_bodies(h)[i].flags & TL_BODY_ALIVE));
            SOUND(steps++ <= h->bodies.high);
            i = tl_body_links(h)[i].sleep_next;
        } while (i != b);
    }
}

/* Leaves below a node; boxes hold what is below, heights are right. */
static inline uint32_t check_tree_node(const tl_header *h, uint32_t i, uint32_t parent, uint32_t *count) {
    const tl_tree_node *n = &tl_nodes(h)[i];
    SOUND(n->parent == parent && i < h->nodes.high);
    (*count)++;
    if (n->child[0] == TL_NONE) {
        SOUND(n->height == 0);
        return 0;
    }
    uint32_t height = 0;
    for (int k = 0; k < 2; k++) {
        uint32_t below = check_tree_node(h, n->child[k], i, count);
        SOUND(tl_aabb_contains(&n->box, &tl_nodes(h)[n->child[k]].box));
        height = below > height ? below : height;
    }
    SOUND(n->height == height + 1u);
    return height + 1u;
}

static inline void check_store(const talus_world *world) {
    const tl_header *h = tl_header_of(world);
    uint64_t *seen = calloc(h->bodies.high, sizeof *seen);
    assert_non_null(seen);
    check_pairs(h);
    check_contacts(h, seen);
    check_joints(h, seen);
    uint32_t alive = 0, awake = 0, pairs = 0, joints = 0, shapes = 0, nodes = 0, moved = 0;
    for (uint32_t b = 0; b < h->bodies.high; b++) {
        if (tl_bodies(h)[b].flags & TL_BODY_ALIVE) {
            alive++;
            awake += tl_body_row(h)[b] != 0;
            SOUND(tl_body_colors(h)[b] == seen[b]);
            check_body_lists(h, b, &pairs, &joints, &shapes);
            check_sleep(h, b);
        } else {
            SOUND(tl_body_row(h)[b] == 0);
        }
    }
    SOUND(alive == h->bodies.used && awake == h->awake_bodies);
    SOUND(pairs == 2u * h->pairs.used && joints == 2u * h->joints.used && shapes == h->shapes.used);
    for (uint32_t s = 0; s < h->shapes.high; s++) {
        const tl_shape_track *t = &tl_shape_tracks(h)[s];
        if (tl_shapes(h)[s].flags & TL_SHAPE_ALIVE) {
            moved += t->moved != 0;
            SOUND(t->node != 0 || t->moved != 0);
            SOUND(t->node == 0 || tl_nodes(h)[t->node - 1u].child[1] == s);
            SOUND(t->moved == 0 || tl_moved_shape(h)[t->moved - 1u] == s);
            talus_aabb box = tl_shape_box(h, world->geometry, s);
            SOUND(t->moved != 0 || (t->stale == 0 && tl_aabb_contains(&t->fat, &box)));
        } else {
            SOUND(t->node == 0 && t->moved == 0);
        }
    }
    SOUND(moved == h->moved_shapes);
    for (int tree = 0; tree < 2; tree++) {
        if (h->root[tree] != TL_NONE) {
            check_tree_node(h, h->root[tree], TL_NONE, &nodes);
        }
    }
    SOUND(nodes == h->nodes.used);
    free(seen);
}

/* A small random number generator: Marsaglia, "Xorshift RNGs", 2003. */
static inline uint32_t draw(uint32_t *seed) {
    uint32_t x = *seed;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return *seed = x;
}
static inline float draw_float(uint32_t *seed, float low, float high) {
    return low + (high - low) * ((float)(draw(seed) >> 8) * (1.0f / 16777216.0f));
}

#endif
