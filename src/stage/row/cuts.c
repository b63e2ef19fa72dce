/* Linkages that are one path, such as ropes, chains and bridges, are cut into as many pieces as there are lanes. The
 * pieces know nothing of each other and are eliminated side by side; what is then left are the joints at the cuts, a
 * path again but an eighth as long (one level of nested dissection: George, "Nested dissection of a regular finite
 * element mesh", SIAM J. Numer. Anal. 10, 1973).
 *
 * Of `inner + 1` joints in a row, the last one is a cut. Group k of a cut linkage holds joint k of all pieces, the last
 * group the cuts. */
#include "stage/row/groups.h"

/* Fewer joints are done sooner one after the other. */
#define LEAST_CUT 16u

/* The nodes of a linkage from one end to the other, if it is one path, all joints of it are alike and each begins at
 * the body where the one before it ends. */
static int walk(const tl_header *h, const tl_linkage *l, const tl_linkage_shape *s, uint32_t *path) {
    const tl_block_node *node = tl_linkage_nodes(h) + s->first_node;
    uint32_t *begins = path + s->nodes, *ends = begins + s->ends, at = TL_NONE;
    const tl_joint_record *first = &tl_joints(h)[tl_linkage_order(h)[l->first_joint]];
    for (uint32_t k = 0; k < 2u * s->ends; k++) {
        begins[k] = TL_NONE;
    }
    for (uint32_t k = 0; k < s->nodes; k++) {
        uint32_t a = node[k].end[0], b = node[k].end[1];
        if ((a != TL_BLOCK_FREE && begins[a] != TL_NONE) || (b != TL_BLOCK_FREE && ends[b] != TL_NONE) ||
            !tl_joints_alike(first, &tl_joints(h)[tl_linkage_order(h)[l->first_joint + k]])) {
            return 0;
        }
        if (a != TL_BLOCK_FREE) {
            begins[a] = k;
        }
        if (b != TL_BLOCK_FREE) {
            ends[b] = k;
        }
    }
    for (uint32_t k = 0; k < s->nodes; k++) {
        uint32_t a = node[k].end[0];
        at = a == TL_BLOCK_FREE || ends[a] == TL_NONE ? k : at;
    }
    uint32_t count = 0;
    while (at != TL_NONE) {
        uint32_t end = node[at].end[1];
        path[count++] = at;
        at = end == TL_BLOCK_FREE ? TL_NONE : begins[end];
    }
    return count == s->nodes;
}

/* A path of `count` nodes from `node` on, over ends that count from 0. */
static void lay_path(tl_block_node *node, uint32_t count, uint32_t rows) {
    for (uint32_t k = 0; k < count; k++) {
        node[k].end[0] = k, node[k].end[1] = k + 1u, node[k].rows = rows;
    }
}

/* The two structures: of a piece with the cut behind it and the cut before it, and of the cuts. Returns the values of
 * both, eight pieces and one path of cuts; 0 if there is no room. */
static uint32_t plan(tl_header *h, tl_linkage *l, tl_linkage_room *room, uint32_t rows, uint32_t *scratch) {
    tl_block_node *node = tl_linkage_nodes(h) + room->nodes;
    tl_block *block = tl_linkage_blocks(h);
    uint32_t inner = l->inner, most = h->capacity[TL_COUNT_LINKBLOCK], wide, narrow;
    if (room->nodes + inner + 2u + l->cuts > h->capacity[TL_COUNT_LINKNODE]) {
        return 0;
    }
    lay_path(node, inner + 1u, rows);
    node[inner].end[1] = TL_BLOCK_FREE;
    node[inner + 1u].end[0] = TL_BLOCK_FREE, node[inner + 1u].end[1] = 0, node[inner + 1u].rows = rows;
    uint32_t used =
        tl_block_plan(node, inner + 2u, inner + 1u, block, room->blocks, most - room->blocks, scratch, &wide);
    if (used == TL_BLOCK_FREE) {
        return 0;
    }
    lay_path(node + inner + 2u, l->cuts, rows);
    uint32_t first = room->blocks + used;
    used = tl_block_plan(node + inner + 2u, l->cuts, l->cuts + 1u, block, first, most - first, scratch, &narrow);
    if (used == TL_BLOCK_FREE) {
        return 0;
    }
    l->cut = room->nodes, l->cut_values = wide * TL_LANES;
    room->nodes += inner + 2u + l->cuts, room->blocks = first + used;
    return wide * TL_LANES + narrow;
}

int tl_linkage_cut(tl_step *step, tl_linkage *l, const tl_linkage_shape *s, tl_linkage_room *room) {
    tl_header *h = step->h;
    uint32_t *path = tl_linkage_scratch(h), piece = (s->nodes + TL_LANES - 1u) / TL_LANES;
    const tl_joint_record *j = &tl_joints(h)[tl_linkage_order(h)[l->first_joint]];
    tl_linkage_room taken = *room;
    if (s->nodes < LEAST_CUT || h->joint_groups + piece > h->capacity[TL_COUNT_JOINTGROUP] ||
        h->joint_rows + piece * j->rows > h->capacity[TL_COUNT_JOINTROW] || !walk(h, l, s, path)) {
        return 0;
    }
    l->inner = piece - 1u, l->cuts = s->nodes / piece;
    uint32_t values = plan(h, l, &taken, tl_linked_rows(j), path + s->nodes);
    values = (values + TL_LANES - 1u) / TL_LANES * TL_LANES;
    if (values == 0 || taken.values + values > h->capacity[TL_COUNT_LINKVALUE]) {
        l->cut = TL_NONE;
        return 0;
    }
    l->first_node = s->first_node, l->nodes = s->nodes, l->values = taken.values, l->first_place = taken.places;
    taken.values += values, taken.places += s->nodes;
    *room = taken;
    l->first_group = h->joint_groups, l->wide = 1u;
    for (uint32_t k = 0; k < piece; k++) {
        tl_joint_group_open(h, j, 1u)->linked = tl_linked_rows(j);
    }
    for (uint32_t i = 0; i < s->nodes; i++) {
        tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + i % piece];
        tl_linkage_places(h)[l->first_place + path[i]] = (l->first_group + i % piece) * TL_LANES + g->lanes;
        tl_joint_group_add(step, g, tl_linkage_order(h)[l->first_joint + s->nodes - 1u - path[i]]);
    }
    return 1;
}
