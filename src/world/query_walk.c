/* Which shapes a query asks, and what it keeps of the answers. */
#include "world/query_probe.h"

#include <string.h>

#include "stage/broad/refit.h"

/* The answers kept: a heap (Williams 1964) with the last in order on top, sorted at the end. */
typedef struct answers {
    talus_query_hit *hits;
    uint32_t capacity, count; /* of all answers */
    double last;              /* answers beyond are of no use */
    int first_only;           /* what comes after the worst that is kept need not be counted */
    int any_only;
} answers;

/* How many nodes a walk of a tree remembers. */
enum { STACK = 64 };

static int is_enough(const answers *a) { return a->any_only && a->count > 0; }

static int is_after(const talus_query_hit *a, const talus_query_hit *b) {
    return a->at > b->at || (a->at == b->at && a->shape.index > b->shape.index);
}

static void sink(talus_query_hit *heap, uint32_t i, uint32_t n) {
    talus_query_hit one = heap[i];
    for (uint32_t child = 2u * i + 1u; child < n; child = 2u * i + 1u) {
        child += child + 1u < n && is_after(&heap[child + 1u], &heap[child]);
        if (!is_after(&heap[child], &one)) {
            break;
        }
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = one;
}

static void keep(answers *a, const talus_query_hit *hit) {
    uint32_t i = a->count++;
    if (i < a->capacity) {
        while (i > 0 && is_after(hit, &a->hits[(i - 1u) / 2u])) {
            a->hits[i] = a->hits[(i - 1u) / 2u];
            i = (i - 1u) / 2u;
        }
        a->hits[i] = *hit;
    } else if (a->capacity > 0 && is_after(&a->hits[0], hit)) {
        a->hits[0] = *hit;
        sink(a->hits, 0, a->capacity);
    }
    if (a->first_only && a->count >= a->capacity) {
        a->last = a->hits[0].at;
    }
}

static void sort(answers *a) {
    uint32_t n = a->count < a->capacity ? a->count : a->capacity;
    for (uint32_t end = n; end-- > 1u;) {
        talus_query_hit top = a->hits[0];
        a->hits[0] = a->hits[end];
        a->hits[end] = top;
        sink(a->hits, 0, end);
    }
}

static void ask(const tl_probe *p, uint32_t shape, answers *a) {
    talus_query_hit hit;
    if (tl_probe_sees(p, shape) && tl_probe_ask(p, shape, a->last, &hit) && hit.at <= a->last) {
        keep(a, &hit);
    }
}

static void ask_leaf(const tl_probe *p, const tl_tree_node *leaf, answers *a) {
    uint32_t shape = leaf->child[1];
    if (!tl_shape_tracks(tl_header_of(p->world))[shape].moved) {
        ask(p, shape, a);
    }
}

/* All below a node, by the parents' links: needs no stack, and does not know what is near. */
static void walk_below(const tl_probe *p, uint32_t top, answers *a) {
    const tl_tree_node *nodes = tl_nodes(tl_header_of(p->world));
    uint32_t i = top;
    for (;;) {
        const tl_tree_node *n = &nodes[i];
        int reached = tl_probe_bound(p, &n->box) <= a->last;
        if (reached && n->child[0] != TL_NONE) {
            i = n->child[0];
            continue;
        }
        if (reached) {
            ask_leaf(p, n, a);
        }
        while (i != top && nodes[nodes[i].parent].child[1] == i) {
            i = nodes[i].parent;
        }
        if (i == top || is_enough(a)) {
            return;
        }
        i = nodes[nodes[i].parent].child[1];
    }
}

typedef struct later {
    uint32_t node;
    double bound;
} later;

/* Walks a tree, the nearer child first. The height of trees has no bound: what is too deep for the stack is walked as
 * it comes. */
static void walk(const tl_probe *p, int tree, answers *a) {
    const tl_header *h = tl_header_of(p->world);
    const tl_tree_node *nodes = tl_nodes(h);
    later stack[STACK];
    uint32_t count = 0;
    if (h->root[tree] == TL_NONE) {
        return;
    }
    stack[count].node = h->root[tree];
    stack[count++].bound = tl_probe_bound(p, &nodes[h->root[tree]].box);
    while (count > 0 && !is_enough(a)) {
        later l = stack[--count];
        while (l.bound <= a->last && nodes[l.node].child[0] != TL_NONE) {
            const uint32_t *child = nodes[l.node].child;
            later one = {child[0], tl_probe_bound(p, &nodes[child[0]].box)};
            later two = {child[1], tl_probe_bound(p, &nodes[child[1]].box)};
            int second = two.bound < one.bound;
            later far = second ? one : two;
            l = second ? two : one;
            if (far.bound <= a->last && count < STACK) {
                stack[count++] = far;
            } else if (far.bound <= a->last) {
                walk_below(p, far.node, a);
            }
        }
        if (l.bound <= a->last) {
            ask_leaf(p, &nodes[l.node], a);
        }
    }
}

/* What moved is in no tree, or not where the trees have it. */
static void ask_moved(const tl_probe *p, answers *a) {
    const tl_header *h = tl_header_of(p->world);
    for (uint32_t k = 0; k < h->moved_shapes && !is_enough(a); k++) {
        talus_aabb box = tl_shape_box(h, p->world->geometry, tl_moved_shape(h)[k]);
        if (tl_probe_bound(p, &box) <= a->last) {
            ask(p, tl_moved_shape(h)[k], a);
        }
    }
}

static void ask_all(const tl_probe *p, answers *a) {
    ask_moved(p, a);
    for (int tree = 0; tree < 2 && !is_enough(a); tree++) {
        walk(p, tree, a);
    }
}

void tl_query_first(const tl_probe *p, talus_query_hit *out) {
    answers a = {out, 1, 0, p->reach, 1, 0};
    memset(out, 0, sizeof *out);
    ask_all(p, &a);
}

void tl_query_all(const tl_probe *p, talus_hits *out) {
    answers a = {out->hits, out->capacity, 0, p->reach, 0, 0};
    ask_all(p, &a);
    sort(&a);
    out->count = a.count;
}

int tl_query_any(const tl_probe *p) {
    answers a = {NULL, 0, 0, p->reach, 0, 1};
    ask_all(p, &a);
    return a.count > 0;
}

talus_status tl_query_one(const tl_probe *p, talus_shape shape, talus_query_hit *out) {
    uint32_t i;
    talus_status status = tl_find_shape(p->world, shape, &i);
    if (status == TALUS_OK && !tl_probe_ask(p, i, p->reach, out)) {
        memset(out, 0, sizeof *out);
    }
    return status;
}
