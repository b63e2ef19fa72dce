/* The soundness of a block: that every count, index, link and number in it could have come from this library. Nothing
 * is read through an index before it was checked, so a damaged block gives a status and not a crash. */
#include <string.h>

#include "geom/mass.h"
#include "world/world_internal.h"

#define UNIT_SLACK 1e-3f /* how far the square of a rotation's length may be from 1 */

static int is_rotation(const float *q) {
    float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return tl_abs(square - 1.0f) <= UNIT_SLACK;
}

static int all_finite(const float *f, int count) {
    for (int i = 0; i < count; i++) {
        if (!tl_is_finite(f[i])) {
            return 0;
        }
    }
    return 1;
}

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

static int body_is_sound(const tl_header *h, uint32_t i) {
    const tl_body_meta *m = &tl_bodies(h)[i];
    if (!(m->flags & TL_BODY_ALIVE)) {
        return tl_body_row(h)[i] == 0 && (m->free_next == TL_NONE || m->free_next < h->bodies.high);
    }
    uint32_t row = tl_body_row(h)[i];
    int awake = (m->flags & TL_BODY_AWAKE) != 0;
    return tl_body_type(m) < TALUS_BODY_TYPE_COUNT && (m->first_shape == TL_NONE || m->first_shape < h->shapes.high) &&
           link_in_range(m->first_contact, h->contacts.high) && link_in_range(m->first_joint, h->joints.high) &&
           (m->sleep_next == TL_NONE || m->sleep_next < h->bodies.high) && awake == (row != 0) &&
           (row == 0 || (row <= h->awake_bodies && tl_awake_body(h)[row - 1u] == i)) &&
           all_finite(tl_body_pose(h)[i].f, 8) && is_rotation(tl_body_pose(h)[i].f + 3) &&
           is_rotation(tl_body_frame(h)[i].f + 3) && all_finite(tl_body_velocity(h)[i].f, 8);
}

static int shape_is_sound(const talus_world *world, uint32_t i) {
    const tl_header *h = tl_header_of(world);
    const tl_shape_meta *m = &tl_shapes(h)[i];
    if (m->next != TL_NONE && m->next >= h->shapes.high) {
        return 0;
    }
    if (!(m->flags & TL_SHAPE_ALIVE)) {
        return 1;
    }
    return m->body < h->bodies.high && (tl_bodies(h)[m->body].flags & TL_BODY_ALIVE) &&
           tl_geometry_check(&tl_shape_geometry(h)[i], world->geometry, world->geometry_bytes) == TALUS_OK &&
           (m->node == TL_NONE || (m->node < h->nodes.high && tl_nodes(h)[m->node].child[0] == TL_NONE &&
                                   tl_nodes(h)[m->node].child[1] == i)) &&
           all_finite(tl_shape_place(h)[i].f, 8) && all_finite(tl_shape_fat(h)[i].f, 8);
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

static int tree_is_sound(const tl_header *h, int tree) {
    const tl_tree_node *nodes = tl_nodes(h);
    uint32_t i = h->root[tree], visits = 0;
    if (i != TL_NONE && (i >= h->nodes.high || nodes[i].parent != TL_NONE)) {
        return 0;
    }
    while (i != TL_NONE) {
        if (++visits > 3u * h->nodes.high) {
            return 0;
        }
        const tl_tree_node *n = &nodes[i];
        if (n->child[0] != TL_NONE) {
            for (int k = 0; k < 2; k++) {
                if (n->child[k] >= h->nodes.high || nodes[n->child[k]].parent != i ||
                    !tl_aabb_contains(&n->box, &nodes[n->child[k]].box)) {
                    return 0;
                }
            }
            i = n->child[0];
            continue;
        }
        if (n->child[1] >= h->shapes.high || tl_shapes(h)[n->child[1]].node != i) {
            return 0;
        }
        uint32_t parent = n->parent;
        while (parent != TL_NONE && nodes[parent].child[1] == i) {
            i = parent;
            parent = nodes[i].parent;
        }
        i = parent == TL_NONE ? TL_NONE : nodes[parent].child[1];
    }
    return 1;
}

/* --- contacts and joints ---------------------------------------------------------------------- */

static int contact_is_sound(const tl_header *h, uint32_t i) {
    const tl_contact_meta *m = &tl_contacts(h)[i];
    const tl_contact_link *l = &tl_contact_links(h)[i];
    if (!(m->flags & TL_CONTACT_ALIVE)) {
        return l->next[0] == TL_NONE || l->next[0] < h->contacts.high;
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

static int joint_is_sound(const tl_header *h, uint32_t i) {
    const tl_joint_record *j = &tl_joints(h)[i];
    if (!(j->flags & TL_JOINT_ALIVE)) {
        return j->free_next == TL_NONE || j->free_next < h->joints.high;
    }
    if (j->body_a >= h->bodies.high || j->body_b >= h->bodies.high || j->rows > TL_JOINT_ROWS || j->fixed > 6u ||
        j->color > TL_COLORS) {
        return 0;
    }
    for (unsigned side = 0; side < 2u; side++) {
        if (!link_in_range(j->next[side], h->joints.high) || !link_in_range(j->previous[side], h->joints.high)) {
            return 0;
        }
    }
    return j->awake_index == TL_NONE || (j->awake_index < h->awake_joints && tl_awake_joint(h)[j->awake_index] == i);
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
        if (!joint_is_sound(h, i)) {
            return TALUS_BAD_BLOB;
        }
    }
    int ok = shape_lists_are_sound(h) && contact_lists_are_sound(h) && tree_is_sound(h, 0) && tree_is_sound(h, 1);
    return ok ? TALUS_OK : TALUS_BAD_BLOB;
}
