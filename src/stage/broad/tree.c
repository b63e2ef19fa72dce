#include "stage/broad/tree.h"

static float area(const talus_aabb *b) {
    talus_vec3 d = tl_sub(b->upper, b->lower);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

static talus_aabb join(const talus_aabb *a, const talus_aabb *b) {
    talus_aabb r = {tl_min3(a->lower, b->lower), tl_max3(a->upper, b->upper)};
    return r;
}

static float joined_area(const talus_aabb *a, const talus_aabb *b) {
    talus_aabb r = join(a, b);
    return area(&r);
}

static int is_leaf(const tl_tree_node *n) { return n->child[0] == TL_NONE; }

static uint32_t take_node(tl_header *h) {
    uint32_t i = tl_pool_top(&h->nodes, h->capacity[TL_COUNT_NODE]);
    tl_pool_take(&h->nodes, i, tl_nodes(h)[i].parent);
    return i;
}

static void give_node(tl_header *h, uint32_t i) {
    tl_tree_node *n = &tl_nodes(h)[i];
    n->box.lower = n->box.upper = tl_v(0.0f, 0.0f, 0.0f);
    n->child[0] = n->child[1] = TL_NONE;
    n->height = 0;
    n->parent = h->nodes.free;
    h->nodes.free = i;
    h->nodes.used--;
}

static void refresh(tl_tree_node *nodes, uint32_t i) {
    tl_tree_node *n = &nodes[i];
    const tl_tree_node *a = &nodes[n->child[0]], *b = &nodes[n->child[1]];
    n->box = join(&a->box, &b->box);
    n->height = 1u + (a->height > b->height ? a->height : b->height);
}

static void set_child(tl_tree_node *nodes, uint32_t parent, int side, uint32_t child) {
    nodes[parent].child[side] = child;
    nodes[child].parent = parent;
}

/* Swaps a child of i with a grandchild of the other side, the one swap of four that lowers the area most; returns
 * whether it did. */
static int rotate(tl_tree_node *nodes, uint32_t i) {
    tl_tree_node *n = &nodes[i];
    float best = 0.0f;
    int best_side = -1, best_grand = 0;
    for (int side = 0; side < 2; side++) {
        const tl_tree_node *low = &nodes[n->child[side]], *high = &nodes[n->child[1 - side]];
        if (is_leaf(high)) {
            continue;
        }
        for (int g = 0; g < 2; g++) {
            const tl_tree_node *stays = &nodes[high->child[1 - g]];
            float gain = area(&high->box) - joined_area(&low->box, &stays->box);
            if (gain > best) {
                best = gain, best_side = side, best_grand = g;
            }
        }
    }
    if (best_side < 0) {
        return 0;
    }
    uint32_t low = n->child[best_side], high = n->child[1 - best_side], grand = nodes[high].child[best_grand];
    set_child(nodes, i, best_side, grand);
    set_child(nodes, high, best_grand, low);
    refresh(nodes, high);
    return 1;
}

/* Where a new leaf costs least: goes down while a child is cheaper than staying, O(log n). */
static uint32_t find_sibling(const tl_tree_node *nodes, uint32_t root, const talus_aabb *box) {
    uint32_t i = root;
    while (!is_leaf(&nodes[i])) {
        const tl_tree_node *n = &nodes[i];
        float here = area(&n->box), with = joined_area(&n->box, box);
        float cost = 2.0f * with, inherited = 2.0f * (with - here);
        float down[2];
        for (int side = 0; side < 2; side++) {
            const tl_tree_node *c = &nodes[n->child[side]];
            float joined = joined_area(&c->box, box);
            down[side] = (is_leaf(c) ? joined : joined - area(&c->box)) + inherited;
        }
        if (cost < down[0] && cost < down[1]) {
            break;
        }
        i = n->child[down[1] < down[0] ? 1 : 0];
    }
    return i;
}

static void refit_up(tl_tree_node *nodes, uint32_t i) {
    while (i != TL_NONE) {
        refresh(nodes, i);
        if (rotate(nodes, i)) {
            refresh(nodes, i);
        }
        i = nodes[i].parent;
    }
}

uint32_t tl_tree_insert(tl_header *h, int tree, uint32_t shape, const talus_aabb *box) {
    tl_tree_node *nodes = tl_nodes(h);
    uint32_t leaf = take_node(h);
    tl_tree_node *n = &nodes[leaf];
    n->box = *box;
    n->child[0] = TL_NONE;
    n->child[1] = shape;
    n->height = 0;
    n->parent = TL_NONE;
    if (h->root[tree] == TL_NONE) {
        h->root[tree] = leaf;
        return leaf;
    }
    uint32_t sibling = find_sibling(nodes, h->root[tree], box);
    uint32_t above = nodes[sibling].parent, joint = take_node(h);
    nodes[joint].parent = above;
    if (above == TL_NONE) {
        h->root[tree] = joint;
    } else {
        nodes[above].child[nodes[above].child[1] == sibling] = joint;
    }
    set_child(nodes, joint, 0, sibling);
    set_child(nodes, joint, 1, leaf);
    refit_up(nodes, joint);
    return leaf;
}

void tl_tree_remove(tl_header *h, int tree, uint32_t leaf) {
    tl_tree_node *nodes = tl_nodes(h);
    uint32_t joint = nodes[leaf].parent;
    if (joint == TL_NONE) {
        h->root[tree] = TL_NONE;
        give_node(h, leaf);
        return;
    }
    uint32_t sibling = nodes[joint].child[nodes[joint].child[0] == leaf], above = nodes[joint].parent;
    nodes[sibling].parent = above;
    if (above == TL_NONE) {
        h->root[tree] = sibling;
    } else {
        nodes[above].child[nodes[above].child[1] == joint] = sibling;
        refit_up(nodes, above);
    }
    give_node(h, joint);
    give_node(h, leaf);
}

/* How much the box around a leaf and its sibling may grow for the leaf to stay where it is. */
#define MOST_GROWTH 1.2f

uint32_t tl_tree_move(tl_header *h, int tree, uint32_t leaf, const talus_aabb *box) {
    tl_tree_node *nodes = tl_nodes(h);
    uint32_t joint = nodes[leaf].parent, shape = nodes[leaf].child[1];
    if (joint != TL_NONE) {
        uint32_t sibling = nodes[joint].child[nodes[joint].child[0] == leaf];
        if (joined_area(&nodes[sibling].box, box) > MOST_GROWTH * area(&nodes[joint].box)) {
            tl_tree_remove(h, tree, leaf);
            return tl_tree_insert(h, tree, shape, box);
        }
    }
    nodes[leaf].box = *box;
    refit_up(nodes, joint);
    return leaf;
}

void tl_tree_begin(tl_tree_walk *walk, const tl_header *h, int tree, const talus_aabb *box) {
    walk->box = *box;
    walk->node = h->root[tree];
}

/* The node after i and all that is below it. */
static uint32_t after(const tl_tree_node *nodes, uint32_t i) {
    uint32_t parent = nodes[i].parent;
    while (parent != TL_NONE && nodes[parent].child[1] == i) {
        i = parent;
        parent = nodes[i].parent;
    }
    return parent == TL_NONE ? TL_NONE : nodes[parent].child[1];
}

uint32_t tl_tree_next(tl_tree_walk *walk, const tl_header *h) {
    const tl_tree_node *nodes = tl_nodes(h);
    uint32_t i = walk->node;
    while (i != TL_NONE) {
        const tl_tree_node *n = &nodes[i];
        if (!tl_aabb_overlap(&n->box, &walk->box)) {
            i = after(nodes, i);
        } else if (is_leaf(n)) {
            walk->node = after(nodes, i);
            return n->child[1];
        } else {
            i = n->child[0];
        }
    }
    walk->node = TL_NONE;
    return TL_NONE;
}
