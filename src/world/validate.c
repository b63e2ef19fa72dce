/* The soundness of a block: that every count, index, link and number in it could have come from this library. Nothing
 * is read through an index before it was checked, so a damaged block gives a status and not a crash. */
#include <string.h>

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
           pool_is_sound(&h->contacts, capacity[TL_COUNT_CONTACT]) &&
           pool_is_sound(&h->joints, capacity[TL_COUNT_JOINT]) && h->awake_bodies < capacity[TL_COUNT_BODY] &&
           h->awake_contacts <= capacity[TL_COUNT_CONTACT] && h->awake_joints <= capacity[TL_COUNT_JOINT] &&
           h->moved_shapes <= capacity[TL_COUNT_SHAPE];
}

/* --- bodies and shapes ------------------------------------------------------------------------ */

static int link_in_range(uint32_t link, uint32_t high) { return link == TL_NONE || link >> 1 < high; }

/* Whether the next body of an island that sleeps is one that can be in it. */
static int ring_is_sound(const tl_header *h, const tl_body_meta *m) {
    if (m->sleep_next == TL_NONE) {
        return 1;
    }
    const tl_body_meta *next = &tl_bodies(h)[m->sleep_next];
    return (next->flags & TL_BODY_ALIVE) && !(next->flags & TL_BODY_AWAKE) && tl_body_type(next) == TALUS_DYNAMIC &&
           tl_body_type(m) == TALUS_DYNAMIC && !(m->flags & TL_BODY_AWAKE) && next->sleep_next != TL_NONE;
}

static int body_is_sound(const tl_header *h, uint32_t i) {
    const tl_body_meta *m = &tl_bodies(h)[i];
    if (!(m->flags & TL_BODY_ALIVE)) {
        return m->flags == 0 && tl_body_row(h)[i] == 0 && (m->free_next == TL_NONE || m->free_next < h->bodies.high);
    }
    uint32_t row = tl_body_row(h)[i];
    int awake = (m->flags & TL_BODY_AWAKE) != 0;
    return tl_body_type(m) < TALUS_BODY_TYPE_COUNT && (m->first_shape == TL_NONE || m->first_shape < h->shapes.high) &&
           link_in_range(m->first_contact, h->contacts.high) && link_in_range(m->first_joint, h->joints.high) &&
           (m->sleep_next == TL_NONE || m->sleep_next < h->bodies.high) && awake == (row != 0) &&
           (row == 0 || (row <= h->awake_bodies && tl_awake_body(h)[row - 1u] == i)) &&
           (row == 0 || tl_body_type(m) != TALUS_STATIC) && ring_is_sound(h, m);
}

static int shape_is_sound(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_shape_meta *m = &tl_shapes(h)[i];
    if (m->next != TL_NONE && m->next >= h->shapes.high) {
        return 0;
    }
    if (!(m->flags & TL_SHAPE_ALIVE)) {
        return m->flags == 0;
    }
    return m->body < h->bodies.high && (tl_bodies(h)[m->body].flags & TL_BODY_ALIVE) &&
           tl_geometry_check(&tl_shape_geometry(h)[i], world->geometry, world->geometry_bytes) == TALUS_OK &&
           (m->node == TL_NONE || (m->node < h->nodes.high && tl_nodes(h)[m->node].child[0] == TL_NONE &&
                                   tl_nodes(h)[m->node].child[1] == i));
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
    if (n->child[1] >= h->shapes.high || tl_shapes(h)[n->child[1]].node != i || n->height != 0 ||
        !(tl_shapes(h)[n->child[1]].flags & TL_SHAPE_ALIVE)) {
        return 0;
    }
    int still = tl_body_type(&tl_bodies(h)[tl_shapes(h)[n->child[1]].body]) == TALUS_STATIC;
    return still == (tree == TL_TREE_STILL);
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
        entered += (tl_shapes(h)[i].flags & TL_SHAPE_ALIVE) && tl_shapes(h)[i].node != TL_NONE;
    }
    return tree_is_sound(h, TL_TREE_MOVING, &nodes, &leaves) && tree_is_sound(h, TL_TREE_STILL, &nodes, &leaves) &&
           nodes == h->nodes.used && leaves == entered;
}

/* --- contacts and joints ---------------------------------------------------------------------- */

static int contact_is_sound(const tl_header *h, uint32_t i) {
    const tl_contact_meta *m = &tl_contacts(h)[i];
    const tl_contact_link *l = &tl_contact_links(h)[i];
    if (!(m->flags & TL_CONTACT_ALIVE)) {
        return m->flags == 0 && (l->next[0] == TL_NONE || l->next[0] < h->contacts.high);
    }
    if (l->shape_a >= h->shapes.high || l->shape_b >= h->shapes.high || l->shape_a >= l->shape_b ||
        m->body_a != tl_shapes(h)[l->shape_a].body || m->body_b != tl_shapes(h)[l->shape_b].body ||
        m->count > TL_MANIFOLD_POINTS || m->color > TL_COLORS) {
        return 0;
    }
    for (unsigned side = 0; side < 2u; side++) {
        if (!link_in_range(l->next[side], h->contacts.high) || !link_in_range(l->previous[side], h->contacts.high)) {
            return 0;
        }
    }
    return m->awake_index == TL_NONE ||
           (m->awake_index < h->awake_contacts && tl_awake_contact(h)[m->awake_index] == i);
}

/* Whether the lists of contacts reach every living contact from both of its bodies, and the pair table too. */
static int contact_lists_are_sound(const tl_header *h) {
    const tl_contact_link *links = tl_contact_links(h);
    uint32_t seen = 0, slots = 0;
    for (uint32_t b = 0; b < h->bodies.high; b++) {
        if (!(tl_bodies(h)[b].flags & TL_BODY_ALIVE)) {
            continue;
        }
        uint32_t before = TL_NONE;
        for (uint32_t l = tl_bodies(h)[b].first_contact; l != TL_NONE; l = links[l >> 1].next[l & 1u]) {
            const tl_contact_meta *m = &tl_contacts(h)[l >> 1];
            uint32_t body = l & 1u ? m->body_b : m->body_a;
            if (!(m->flags & TL_CONTACT_ALIVE) || body != b || links[l >> 1].previous[l & 1u] != before ||
                ++seen > 2u * h->contacts.used) {
                return 0;
            }
            before = l;
        }
    }
    for (uint32_t i = 0; i < h->capacity[TL_COUNT_SLOT]; i++) {
        uint32_t slot = tl_pair_slot(h)[i];
        slots += slot != 0;
        if (slot > h->contacts.high || (slot && !(tl_contacts(h)[slot - 1u].flags & TL_CONTACT_ALIVE))) {
            return 0;
        }
    }
    return seen == 2u * h->contacts.used && slots == h->contacts.used;
}

static int joint_is_sound(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_joint_record *j = &tl_joints(h)[i];
    if (!(j->flags & TL_JOINT_ALIVE)) {
        return j->flags == 0 && (j->free_next == TL_NONE || j->free_next < h->joints.high);
    }
    if (j->body_a >= h->bodies.high || j->body_b >= h->bodies.high || j->body_a == j->body_b ||
        !(tl_bodies(h)[j->body_a].flags & TL_BODY_ALIVE) || !(tl_bodies(h)[j->body_b].flags & TL_BODY_ALIVE) ||
        (!tl_body_is_dynamic(h, j->body_a) && !tl_body_is_dynamic(h, j->body_b)) || j->color > TL_COLORS ||
        !tl_joint_is_compiled(world, i)) {
        return 0;
    }
    for (unsigned side = 0; side < 2u; side++) {
        if (!link_in_range(j->next[side], h->joints.high) || !link_in_range(j->previous[side], h->joints.high)) {
            return 0;
        }
    }
    return j->awake_index == TL_NONE || (j->awake_index < h->awake_joints && tl_awake_joint(h)[j->awake_index] == i);
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
    return of == TL_COUNT_BODY      ? tl_bodies(h)[i].free_next
           : of == TL_COUNT_SHAPE   ? tl_shapes(h)[i].next
           : of == TL_COUNT_NODE    ? tl_nodes(h)[i].parent
           : of == TL_COUNT_CONTACT ? tl_contact_links(h)[i].next[0]
                                    : tl_joints(h)[i].free_next;
}

static int is_alive(const tl_header *h, tl_count of, uint32_t i) {
    return of == TL_COUNT_BODY      ? (tl_bodies(h)[i].flags & TL_BODY_ALIVE) != 0
           : of == TL_COUNT_SHAPE   ? (tl_shapes(h)[i].flags & TL_SHAPE_ALIVE) != 0
           : of == TL_COUNT_CONTACT ? (tl_contacts(h)[i].flags & TL_CONTACT_ALIVE) != 0
           : of == TL_COUNT_JOINT   ? (tl_joints(h)[i].flags & TL_JOINT_ALIVE) != 0
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

/* A number for an index; sums of them are equal for the same indices in any order, and hardly for others. */
static uint64_t scatter(uint32_t i) {
    uint64_t x = (i + 1u) * (uint64_t)0x9e3779b97f4a7c15u;
    x = (x ^ x >> 31) * 0xbf58476d1ce4e5b9u;
    return x ^ x >> 29;
}

/* Whether the list of moved shapes has every one that says it is in it, once. */
static int moved_list_is_sound(const tl_header *h) {
    uint64_t said = 0, listed = 0;
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        said += tl_shapes(h)[i].flags & TL_SHAPE_MOVED ? scatter(i) : 0;
    }
    for (uint32_t k = 0; k < h->moved_shapes; k++) {
        listed += scatter(tl_moved_shape(h)[k]);
    }
    return said == listed;
}

static int counts_are_sound(const tl_header *h) {
    uint32_t events = 0, breaking = 0;
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        events += (tl_shapes(h)[i].flags & (TL_SHAPE_SENSOR | TL_SHAPE_EVENTS)) != 0;
    }
    for (uint32_t i = 0; i < h->joints.high; i++) {
        const tl_joint_record *j = &tl_joints(h)[i];
        breaking += (j->flags & TL_JOINT_ALIVE) && (j->break_force > 0.0f || j->break_torque > 0.0f);
    }
    return events == h->event_shapes && moved_list_is_sound(h) && breaking == h->breaking_joints &&
           free_list_is_sound(h, &h->bodies, TL_COUNT_BODY) && free_list_is_sound(h, &h->shapes, TL_COUNT_SHAPE) &&
           free_list_is_sound(h, &h->nodes, TL_COUNT_NODE) && free_list_is_sound(h, &h->contacts, TL_COUNT_CONTACT) &&
           free_list_is_sound(h, &h->joints, TL_COUNT_JOINT);
}

/* Whether what each list names is there and knows its place in the list. */
static int lists_are_sound(const tl_header *h) {
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        if (tl_awake_body(h)[k] >= h->bodies.high || tl_body_row(h)[tl_awake_body(h)[k]] != k + 1u) {
            return 0;
        }
    }
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        if (tl_awake_contact(h)[k] >= h->contacts.high || tl_contacts(h)[tl_awake_contact(h)[k]].awake_index != k) {
            return 0;
        }
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        if (tl_awake_joint(h)[k] >= h->joints.high || tl_joints(h)[tl_awake_joint(h)[k]].awake_index != k) {
            return 0;
        }
    }
    for (uint32_t k = 0; k < h->moved_shapes; k++) {
        uint32_t s = tl_moved_shape(h)[k];
        if (s >= h->shapes.high || !(tl_shapes(h)[s].flags & TL_SHAPE_MOVED)) {
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
    int ok = counts_are_sound(h) && tl_numbers_are_sound(h) && shape_lists_are_sound(h) && contact_lists_are_sound(h) &&
             joint_lists_are_sound(h) && trees_are_sound(h);
    return ok ? TALUS_OK : TALUS_BAD_BLOB;
}
