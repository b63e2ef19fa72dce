/* The soundness of a block: that every count, index, link and number in it could have come from this library. Nothing
 * is read through an index before it was checked, so a damaged block gives a status and not a crash. */
#include <string.h>

#include "base/bits.h"
#include "geom/mass.h"
#include "world/world_internal.h"

static int pool_is_sound(const tl_pool *p, uint32_t capacity) {
    return p->high <= capacity && p->used <= p->high && (p->free == TL_NONE || p->free < p->high);
}

static int header_is_sound(const tl_header *h) {
    talus_world world = {(void *)(uintptr_t)h, NULL, 0, NULL};
    talus_world_def def;
    uint32_t capacity[TL_COUNT_COUNT], offset[TL_COLUMN_COUNT];
    talus_world_get_def(&world, &def);
    if (talus_world_size(&def) != (size_t)h->units * TL_UNIT) {
        return 0;
    }
    tl_store_layout(&def, capacity, offset);
    return memcmp(capacity, h->capacity, sizeof capacity) == 0 && memcmp(offset, h->offset, sizeof offset) == 0 &&
           talus_isa_available((talus_isa)h->isa) && pool_is_sound(&h->bodies, capacity[TL_COUNT_BODY]) &&
           pool_is_sound(&h->shapes, capacity[TL_COUNT_SHAPE]) && pool_is_sound(&h->nodes, capacity[TL_COUNT_NODE]) &&
           pool_is_sound(&h->pairs, capacity[TL_COUNT_PAIR]) && pool_is_sound(&h->joints, capacity[TL_COUNT_JOINT]) &&
           h->contacts.used <= h->contacts.high && h->contacts.high <= capacity[TL_COUNT_CONTACT] &&
           h->pairs.used >= h->contacts.used && h->awake_bodies < capacity[TL_COUNT_BODY] &&
           h->awake_pairs <= h->pairs.used && h->moved_shapes <= h->shapes.used &&
           h->frames <= capacity[TL_COUNT_FRAME] && (h->next_frame < capacity[TL_COUNT_FRAME] || h->next_frame == 0);
}

/* --- bodies and shapes ------------------------------------------------------------------------ */

/* A dynamic body that sleeps is in a ring of its island; no other one is. */
static int sleep_is_sound(const tl_header *h, uint32_t i) {
    const tl_body_meta *bodies = tl_bodies(h);
    uint32_t next = tl_body_links(h)[i].sleep_next, island = bodies[i].island;
    if (tl_body_type(&bodies[i]) != TALUS_DYNAMIC || (bodies[i].flags & TL_BODY_AWAKE)) {
        return next == TL_NONE && island == TL_NONE;
    }
    return island < h->bodies.high && next < h->bodies.high && bodies[next].island == island &&
           bodies[island].island == island;
}

static int body_is_sound(const tl_header *h, uint32_t i) {
    const tl_body_meta *m = &tl_bodies(h)[i];
    if (!(m->flags & TL_BODY_ALIVE)) {
        return m->flags == 0 && tl_body_row(h)[i] == 0 && tl_is_index(m->free_next, h->bodies.high);
    }
    uint32_t row = tl_body_row(h)[i];
    int awake = (m->flags & TL_BODY_AWAKE) != 0;
    return tl_body_type(m) < TALUS_BODY_TYPE_COUNT && tl_is_index(m->first_shape, h->shapes.high) &&
           tl_is_link(tl_body_links(h)[i].first_pair, h->pairs.high) && tl_is_link(m->first_joint, h->joints.high) &&
           awake == (row != 0) && (row == 0 || (row <= h->awake_bodies && tl_awake_body(h)[row - 1u] == i)) &&
           (row == 0 || tl_body_type(m) != TALUS_STATIC) && sleep_is_sound(h, i);
}

static int shape_is_sound(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_shape_meta *m = &tl_shapes(h)[i];
    if (m->next != TL_NONE && m->next >= h->shapes.high) {
        return 0;
    }
    const tl_shape_track *t = &tl_shape_tracks(h)[i];
    if (!(m->flags & TL_SHAPE_ALIVE)) {
        return m->flags == 0 && t->node == 0 && t->moved == 0;
    }
    return m->body < h->bodies.high && (tl_bodies(h)[m->body].flags & TL_BODY_ALIVE) &&
           tl_geometry_check(&tl_shape_geometry(h)[i], world->geometry, world->geometry_bytes) == TALUS_OK &&
           (t->node == 0 || (t->node <= h->nodes.high && tl_nodes(h)[t->node - 1u].child[0] == TL_NONE &&
                             tl_nodes(h)[t->node - 1u].child[1] == i)) &&
           (t->moved == 0 || (t->moved <= h->moved_shapes && tl_moved_shape(h)[t->moved - 1u] == i)) &&
           tl_is_finite3(t->fat.lower) && tl_is_finite3(t->fat.upper);
}

/* Whether the lists of shapes reach every living shape once. */
static int shape_lists_are_sound(const tl_header *h) {
    uint32_t seen = 0;
    for (uint32_t b = 0; b < h->bodies.high; b++) {
        if (!(tl_bodies(h)[b].flags & TL_BODY_ALIVE)) {
            continue;
        }
        for (uint32_t s = tl_bodies(h)[b].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
            if (tl_shapes(h)[s].body != b || !(tl_shapes(h)[s].flags & TL_SHAPE_ALIVE) || ++seen > h->shapes.used) {
                return 0;
            }
        }
    }
    return seen == h->shapes.used;
}

/* --- the trees -------------------------------------------------------------------------------- */

/* Whether a node below which all was looked at is as high, and its box as large, as it says. */
static int node_is_sound(const tl_header *h, uint32_t i) {
    const tl_tree_node *nodes = tl_nodes(h), *n = &nodes[i];
    uint32_t height = 0;
    for (int k = 0; k < 2; k++) {
        const tl_tree_node *child = &nodes[n->child[k]];
        height = child->height + 1u > height ? child->height + 1u : height;
        if (child->parent != i || !tl_aabb_contains(&n->box, &child->box)) {
            return 0;
        }
    }
    return n->height == height;
}

static int leaf_is_sound(const tl_header *h, uint32_t i, int tree) {
    const tl_tree_node *n = &tl_nodes(h)[i];
    if (n->child[1] >= h->shapes.high || tl_shape_tracks(h)[n->child[1]].node != i + 1u || n->height != 0 ||
        !(tl_shapes(h)[n->child[1]].flags & TL_SHAPE_ALIVE)) {
        return 0;
    }
    int still = tl_body_type(&tl_bodies(h)[tl_shapes(h)[n->child[1]].body]) == TALUS_STATIC;
    return still == (tree == TL_TREE_STILL) && (tl_shape_tracks(h)[n->child[1]].still != 0) == still;
}

/* Walks a tree; counts its nodes and leaves. */
static int tree_is_sound(const tl_header *h, int tree, uint32_t *count, uint32_t *leaves) {
    const tl_tree_node *nodes = tl_nodes(h);
    uint32_t i = h->root[tree];
    if (i != TL_NONE && (i >= h->nodes.high || nodes[i].parent != TL_NONE)) {
        return 0;
    }
    while (i != TL_NONE) {
        const tl_tree_node *n = &nodes[i];
        if (++*count > h->nodes.used) {
            return 0;
        }
        if (n->child[0] != TL_NONE) {
            if (n->child[0] >= h->nodes.high || n->child[1] >= h->nodes.high || n->child[0] == n->child[1] ||
                !node_is_sound(h, i)) {
                return 0;
            }
            i = n->child[0];
            continue;
        }
        if (!leaf_is_sound(h, i, tree)) {
            return 0;
        }
        ++*leaves;
        uint32_t parent = n->parent;
        while (parent != TL_NONE && nodes[parent].child[1] == i) {
            i = parent;
            parent = nodes[i].parent;
        }
        i = parent == TL_NONE ? TL_NONE : nodes[parent].child[1];
    }
    return 1;
}

static int trees_are_sound(const tl_header *h) {
    uint32_t nodes = 0, leaves = 0, entered = 0;
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        entered += tl_shape_tracks(h)[i].node != 0;
    }
    return tree_is_sound(h, TL_TREE_MOVING, &nodes, &leaves) && tree_is_sound(h, TL_TREE_STILL, &nodes, &leaves) &&
           nodes == h->nodes.used && leaves == entered;
}

/* --- pairs, contacts and joints --------------------------------------------------------------- */

static int pair_is_sound(const tl_header *h, uint32_t i) {
    const tl_pair *p = &tl_pairs(h)[i];
    const tl_pair_link *l = &tl_pair_links(h)[i];
    if (p->shape_b == 0) {
        return l->next[0] == TL_NONE || l->next[0] < h->pairs.high;
    }
    if (p->shape_a >= p->shape_b || p->shape_b >= h->shapes.high ||
        !(tl_shapes(h)[p->shape_a].flags & TL_SHAPE_ALIVE) || !(tl_shapes(h)[p->shape_b].flags & TL_SHAPE_ALIVE) ||
        p->body_a != tl_shapes(h)[p->shape_a].body || p->body_b != tl_shapes(h)[p->shape_b].body) {
        return 0;
    }
    for (unsigned side = 0; side < 2u; side++) {
        if (!tl_is_link(l->next[side], h->pairs.high) || !tl_is_link(l->previous[side], h->pairs.high)) {
            return 0;
        }
    }
    int awake = tl_body_row(h)[p->body_a] || tl_body_row(h)[p->body_b];
    if (p->contact != TL_NONE && (p->contact >= h->contacts.high || tl_contact_pair(h)[p->contact] != i)) {
        return 0;
    }
    return p->awake_index == TL_NONE ? !awake
                                     : p->awake_index < h->awake_pairs && tl_awake_pair(h)[p->awake_index] == i;
}

static int contact_is_sound(const tl_header *h, uint32_t i) {
    const tl_contact_meta *m = &tl_contacts(h)[i];
    int alive = (m->flags & TL_CONTACT_ALIVE) != 0;
    if (alive != tl_bit_has(tl_contact_alive(h), i)) {
        return 0;
    }
    if (!alive) {
        return m->flags == 0 && !tl_bit_has(tl_contact_awake(h), i);
    }
    if (m->shape_a >= m->shape_b || m->shape_b >= h->shapes.high || m->body_a != tl_shapes(h)[m->shape_a].body ||
        m->body_b != tl_shapes(h)[m->shape_b].body || m->count > TL_MANIFOLD_POINTS || m->color > TL_COLORS) {
        return 0;
    }
    static const tl_contact_point_record none;
    for (uint32_t k = m->count; k < TL_MANIFOLD_POINTS; k++) {
        if (memcmp(&tl_points(h)[i].p[k], &none, sizeof none) != 0) {
            return 0;
        }
    }
    int awake = tl_body_row(h)[m->body_a] || tl_body_row(h)[m->body_b];
    uint32_t pair = tl_contact_pair(h)[i];
    return pair < h->pairs.high && tl_pairs(h)[pair].contact == i && tl_pairs(h)[pair].shape_a == m->shape_a &&
           tl_pairs(h)[pair].shape_b == m->shape_b && (!awake || tl_bit_has(tl_contact_awake(h), i));
}

/* Whether the lists of pairs reach every living pair from both of its bodies, and the pair table too. */
static int pair_lists_are_sound(const tl_header *h) {
    const tl_pair_link *links = tl_pair_links(h);
    uint32_t seen = 0, slots = 0;
    for (uint32_t b = 0; b < h->bodies.high; b++) {
        if (!(tl_bodies(h)[b].flags & TL_BODY_ALIVE)) {
            continue;
        }
        uint32_t before = TL_NONE;
        for (uint32_t l = tl_body_links(h)[b].first_pair; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
            const tl_pair *p = &tl_pairs(h)[l >> 1];
            uint32_t body = l & 1u ? p->body_b : p->body_a;
            if (p->shape_b == 0 || body != b || links[l >> 1].previous[l & 1u] != before ||
                ++seen > 2u * h->pairs.used) {
                return 0;
            }
            before = l;
        }
    }
    for (uint32_t i = 0; i < h->capacity[TL_COUNT_SLOT]; i++) {
        uint32_t slot = tl_pair_slot(h)[i];
        slots += slot != 0;
        if (slot > h->pairs.high || (slot && tl_pairs(h)[slot - 1u].shape_b == 0)) {
            return 0;
        }
    }
    return seen == 2u * h->pairs.used && slots == h->pairs.used;
}

static int joint_is_sound(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_joint_record *j = &tl_joints(h)[i];
    if (!(j->flags & TL_JOINT_ALIVE)) {
        return j->flags == 0 && tl_is_index(j->free_next, h->joints.high);
    }
    if (j->body_a >= h->bodies.high || j->body_b >= h->bodies.high || j->body_a == j->body_b ||
        !(tl_bodies(h)[j->body_a].flags & TL_BODY_ALIVE) || !(tl_bodies(h)[j->body_b].flags & TL_BODY_ALIVE) ||
        (!tl_body_is_dynamic(h, j->body_a) && !tl_body_is_dynamic(h, j->body_b)) || j->color > TL_COLORS ||
        !tl_joint_is_compiled(world, i)) {
        return 0;
    }
    for (unsigned side = 0; side < 2u; side++) {
        if (!tl_is_link(j->next[side], h->joints.high) || !tl_is_link(j->previous[side], h->joints.high)) {
            return 0;
        }
    }
    int awake = tl_body_row(h)[j->body_a] || tl_body_row(h)[j->body_b];
    return !awake || tl_bit_has(tl_joint_awake(h), i);
}

/* Whether the lists of joints reach every living joint from both of its bodies. */
static int joint_lists_are_sound(const tl_header *h) {
    const tl_joint_record *joints = tl_joints(h);
    uint32_t seen = 0;
    for (uint32_t b = 0; b < h->bodies.high; b++) {
        if (!(tl_bodies(h)[b].flags & TL_BODY_ALIVE)) {
            continue;
        }
        uint32_t before = TL_NONE;
        for (uint32_t l = tl_bodies(h)[b].first_joint; l != TL_NONE; l = joints[l >> 1].next[l & 1u]) {
            const tl_joint_record *j = &joints[l >> 1];
            uint32_t body = l & 1u ? j->body_b : j->body_a;
            if (!(j->flags & TL_JOINT_ALIVE) || body != b || j->previous[l & 1u] != before ||
                ++seen > 2u * h->joints.used) {
                return 0;
            }
            before = l;
        }
    }
    return seen == 2u * h->joints.used;
}

/* --- what is free, and what is counted -------------------------------------------------------- */

/* The link of a free slot to the next one. */
static uint32_t free_next(const tl_header *h, tl_count of, uint32_t i) {
    return of == TL_COUNT_BODY    ? tl_bodies(h)[i].free_next
           : of == TL_COUNT_SHAPE ? tl_shapes(h)[i].next
           : of == TL_COUNT_NODE  ? tl_nodes(h)[i].parent
           : of == TL_COUNT_PAIR  ? tl_pair_links(h)[i].next[0]
                                  : tl_joints(h)[i].free_next;
}

static int is_alive(const tl_header *h, tl_count of, uint32_t i) {
    return of == TL_COUNT_BODY    ? (tl_bodies(h)[i].flags & TL_BODY_ALIVE) != 0
           : of == TL_COUNT_SHAPE ? (tl_shapes(h)[i].flags & TL_SHAPE_ALIVE) != 0
           : of == TL_COUNT_PAIR  ? tl_pairs(h)[i].shape_b != 0
           : of == TL_COUNT_JOINT ? (tl_joints(h)[i].flags & TL_JOINT_ALIVE) != 0
                                  : tl_nodes(h)[i].child[0] != TL_NONE || tl_nodes(h)[i].child[1] != TL_NONE;
}

/* Whether the free list has every slot that is not alive, once. */
static int free_list_is_sound(const tl_header *h, const tl_pool *pool, tl_count of) {
    uint32_t count = 0, alive = 0;
    for (uint32_t i = pool->free; i != TL_NONE; i = free_next(h, of, i)) {
        if (i >= pool->high || ++count > pool->high - pool->used || is_alive(h, of, i)) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < pool->high; i++) {
        alive += is_alive(h, of, i) ? 1u : 0u;
    }
    return count == pool->high - pool->used && alive == pool->used;
}

static int counts_are_sound(const tl_header *h) {
    uint32_t events = 0, breaking = 0, contacts = 0;
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        events += (tl_shapes(h)[i].flags & (TL_SHAPE_SENSOR | TL_SHAPE_EVENTS)) != 0;
    }
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        breaking += (j->flags & TL_JOINT_ALIVE) && (j->break_force > 0.0f || j->break_torque > 0.0f);
    }
    for (uint32_t i = 0; i < h->contacts.high; i++) {
        contacts += (tl_contacts(h)[i].flags & TL_CONTACT_ALIVE) != 0;
    }
    return events == h->event_shapes && breaking == h->breaking_joints && contacts == h->contacts.used &&
           tl_bit_end(tl_contact_alive(h), h->capacity[TL_COUNT_CONTACT]) == h->contacts.high &&
           free_list_is_sound(h, &h->bodies, TL_COUNT_BODY) && free_list_is_sound(h, &h->shapes, TL_COUNT_SHAPE) &&
           free_list_is_sound(h, &h->nodes, TL_COUNT_NODE) && free_list_is_sound(h, &h->pairs, TL_COUNT_PAIR) &&
           free_list_is_sound(h, &h->joints, TL_COUNT_JOINT);
}

/* Whether what each list names is there and knows its place in the list. */
static int lists_are_sound(const tl_header *h) {
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        if (tl_awake_body(h)[k] >= h->bodies.high || tl_body_row(h)[tl_awake_body(h)[k]] != k + 1u) {
            return 0;
        }
    }
    for (uint32_t k = 0; k < h->awake_pairs; k++) {
        if (tl_awake_pair(h)[k] >= h->pairs.high || tl_pairs(h)[tl_awake_pair(h)[k]].awake_index != k) {
            return 0;
        }
    }
    for (uint32_t k = 0; k < h->moved_shapes; k++) {
        uint32_t s = tl_moved_shape(h)[k];
        if (s >= h->shapes.high || tl_shape_tracks(h)[s].moved != k + 1u) {
            return 0;
        }
    }
    return 1;
}

talus_status talus_world_validate(const talus_world *world) {
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    if (!header_is_sound(h) || !lists_are_sound(h)) {
        return TALUS_BAD_BLOB;
    }
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        if (!body_is_sound(h, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        if (!shape_is_sound(world, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    for (uint32_t i = 0; i < h->pairs.high; i++) {
        if (!pair_is_sound(h, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    for (uint32_t i = 0; i < h->contacts.high; i++) {
        if (!contact_is_sound(h, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    for (uint32_t i = 0; i < h->joints.high; i++) {
        if (!joint_is_sound(world, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    int ok = counts_are_sound(h) && tl_numbers_are_sound(h) && shape_lists_are_sound(h) && pair_lists_are_sound(h) &&
             joint_lists_are_sound(h) && trees_are_sound(h);
    return ok ? TALUS_OK : TALUS_BAD_BLOB;
}
