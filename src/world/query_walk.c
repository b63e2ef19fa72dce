/* Which shapes a query asks, and what it keeps of the answers. */
#include "world/query_probe.h"

#include <string.h>

/* The answers kept: a heap (Williams 1964) with the last in order on top, sorted at the end. */
typedef struct answers {
    talus_query_hit *hits;
    uint32_t capacity, count; /* of all answers */
    double last;              /* answers beyond are of no use */
    int first_only;           /* what comes after the worst that is kept need not be counted */
    int any_only;
} answers;

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

/* Walks a tree from the near child to the far one. There is no stack and so no bound on the height: on the way up the
 * order of two children is worked out once more (Hapala et al., Efficient stack-less BVH traversal for ray tracing,
 * SCCG 2011). */
static void walk(const tl_probe *p, int tree, answers *a) {
    const tl_header *h = tl_header_of(p->world);
    const tl_tree_node *nodes = tl_nodes(h);
    const tl_shape_track *tracks = tl_shape_tracks(h);
    uint32_t i = h->root[tree];
    while (i != TL_NONE) {
        const tl_tree_node *n = &nodes[i];
        if (tl_probe_bound(p, &n->box) <= a->last) {
            if (n->child[0] != TL_NONE) {
                i = n->child[tl_probe_side(p, &nodes[n->child[0]], &nodes[n->child[1]])];
                continue;
            }
            if (!tracks[n->child[1]].moved) {
                ask(p, n->child[1], a);
                if (a->any_only && a->count > 0) {
                    return;
                }
            }
        }
        for (;;) {
            uint32_t parent = nodes[i].parent;
            if (parent == TL_NONE) {
                return;
            }
            const uint32_t *child = nodes[parent].child;
            int near = tl_probe_side(p, &nodes[child[0]], &nodes[child[1]]);
            if (child[near] == i) {
                i = child[1 - near];
                break;
            }
            i = parent;
        }
    }
}

static void ask_all(const tl_probe *p, answers *a) {
    const tl_header *h = tl_header_of(p->world);
    for (uint32_t k = 0; k < h->moved_shapes && !(a->any_only && a->count > 0); k++) {
        ask(p, tl_moved_shape(h)[k], a);
    }
    for (int tree = 0; tree < 2 && !(a->any_only && a->count > 0); tree++) {
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
