/* Linkages solved at once, for the width that the including file has chosen: one linkage, or eight alike. */
#include <string.h>

#include "dynamics/block_ldlt.inl"

/* A node's joint: its group from the lane on. */
typedef struct link_lane {
    const tl_joint_group *g;
    const tl_joint_row *rows;
    uint32_t lane;
} link_lane;

static inline link_lane link_of(const tl_header *h, const tl_linkage *l, uint32_t node) {
    uint32_t place = tl_linkage_places(h)[l->first_place + node];
    const tl_joint_group *g = &tl_joint_group_pool(h)[place / TL_LANES];
    link_lane k = {g, tl_joint_row_pool(h) + g->first_row, place % TL_LANES};
    return k;
}

typedef struct w3 {
    wf x, y, z;
} w3;

static inline w3 w3_load(const float *p) {
    w3 r = {wf_load(p), wf_load(p + TL_LANES), wf_load(p + 2u * TL_LANES)};
    return r;
}
static inline wf w3_dot(w3 a, w3 b) { return wf_mad(wf_mad(wf_mul(a.x, b.x), a.y, b.y), a.z, b.z); }

static inline int is_linear(uint32_t code) {
    uint32_t type = code % TL_ROW_TYPES;
    return type < TL_ROW_ANGULAR || type == TL_ROW_DISTANCE;
}

/* A row that does not hold stands for itself alone and has nothing to meet. */
static void link_diagonal(link_lane k, uint32_t live, float *d) {
    wf one = wf_set1(1.0f), soft = wf_load(k.g->soft + k.lane);
    for (uint32_t i = 0; i < live; i++) {
        wf holds = wf_load(k.g->active[i] + k.lane);
        for (uint32_t j = 0; j < i; j++) {
            wf both = wf_mul(holds, wf_load(k.g->active[j] + k.lane));
            wf_store(d + ldlt_at(i, j) * TL_WIDTH, wf_mul(both, wf_load(k.g->matrix[ldlt_at(i, j)] + k.lane)));
        }
        wf a = wf_load(k.g->matrix[ldlt_at(i, i)] + k.lane);
        a = wf_mad(a, a, soft);
        wf_store(d + ldlt_at(i, i) * TL_WIDTH, wf_mad(wf_sub(one, holds), holds, a));
    }
}

/* Adds what two joints have to do with each other through a body that is the side s of one and t of the other. */
static void link_share(link_lane row, link_lane column, uint32_t rows, uint32_t columns, uint32_t s, uint32_t t,
                       float *v) {
    wf sign = wf_set1(s == t ? 1.0f : -1.0f);
    wf mass = wf_mul(sign, wf_load(row.g->mass[s] + row.lane)),
       turns = wf_mul(sign, wf_load(row.g->turns[s] + row.lane));
    w3 n[TL_LINK_ROWS], ju[TL_LINK_ROWS];
    for (uint32_t c = 0; c < columns; c++) {
        const tl_joint_row *r = &column.rows[c];
        wf holds = wf_load(column.g->active[c] + column.lane);
        n[c] = w3_load(r->n[0] + column.lane);
        ju[c] = w3_load((t ? r->jb[0] : r->ja[0]) + column.lane);
        n[c].x = wf_mul(n[c].x, holds), n[c].y = wf_mul(n[c].y, holds), n[c].z = wf_mul(n[c].z, holds);
        ju[c].x = wf_mul(ju[c].x, holds), ju[c].y = wf_mul(ju[c].y, holds), ju[c].z = wf_mul(ju[c].z, holds);
    }
    for (uint32_t i = 0; i < rows; i++, v += (column.g->linked - columns) * TL_WIDTH) {
        const tl_joint_row *r = &row.rows[i];
        wf holds = wf_load(row.g->active[i] + row.lane), m = wf_mul(holds, mass), u = wf_mul(holds, turns);
        w3 ni = w3_load(r->n[0] + row.lane), ji = w3_load((s ? r->jb[0] : r->ja[0]) + row.lane);
        int linear = is_linear(row.g->code[i]);
        for (uint32_t c = 0; c < columns; c++, v += TL_WIDTH) {
            wf sum = wf_mad(wf_load(v), u, w3_dot(ji, ju[c]));
            wf_store(v, linear && is_linear(column.g->code[c]) ? wf_mad(sum, m, w3_dot(ni, n[c])) : sum);
        }
    }
}

/* The same where both hold a point along the world's axes and then angles, n rows that all hold. */
static inline void share_even(link_lane row, link_lane column, uint32_t s, uint32_t t, int first, float *v,
                              uint32_t n) {
    wf sign = wf_set1(s == t ? 1.0f : -1.0f), zero = wf_set1(0.0f);
    wf mass = wf_mul(sign, wf_load(row.g->mass[s] + row.lane)), none = wf_mul(mass, zero);
    wf turns = wf_mul(sign, wf_load(row.g->turns[s] + row.lane));
    w3 ju[TL_LINK_ROWS];
    TL_UNROLL
    for (uint32_t c = 0; c < n && c < TL_LINK_ROWS; c++) {
        ju[c] = w3_load((t ? column.rows[c].jb[0] : column.rows[c].ja[0]) + column.lane);
    }
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        w3 ji = w3_load((s ? row.rows[i].jb[0] : row.rows[i].ja[0]) + row.lane);
        TL_UNROLL
        for (uint32_t c = 0; c < n && c < TL_LINK_ROWS; c++, v += TL_WIDTH) {
            wf sum = wf_mad(first ? zero : wf_load(v), turns, w3_dot(ji, ju[c]));
            wf_store(v, i < 3u && c < 3u ? wf_add(sum, i == c ? mass : none) : sum);
        }
    }
}

static inline void block_even(const tl_block *b, link_lane row, link_lane column, float *v, uint32_t n) {
    int first = 1;
    for (uint32_t i = 0; i < 4u; i++) {
        if (b->shares >> i & 1u) {
            share_even(row, column, i / 2u, i % 2u, first, v, n);
            first = 0;
        }
    }
    for (uint32_t i = 0; first && i < n * n; i++) {
        wf_store(v + i * TL_WIDTH, wf_set1(0.0f));
    }
}

static inline void diagonal_even(link_lane k, float *d, uint32_t n) {
    wf soft = wf_load(k.g->soft + k.lane);
    TL_UNROLL
    for (uint32_t i = 0; i < n && i < TL_LINK_ROWS; i++) {
        TL_UNROLL
        for (uint32_t j = 0; j < i; j++) {
            wf_store(d + ldlt_at(i, j) * TL_WIDTH, wf_load(k.g->matrix[ldlt_at(i, j)] + k.lane));
        }
        wf a = wf_load(k.g->matrix[ldlt_at(i, i)] + k.lane);
        wf_store(d + ldlt_at(i, i) * TL_WIDTH, wf_mad(a, a, soft));
    }
}

/* How many of a joint's rows are to be looked at: up to the last that holds. */
static inline uint32_t live_rows(link_lane k) {
    uint32_t live = k.g->linked;
    while (live > k.g->fixed && !wf_any(wf_load(k.g->active[live - 1u] + k.lane))) {
        live--;
    }
    return live;
}

/* What the joint of a row has to do with that of a column. */
static void link_block(const tl_block *b, link_lane row, link_lane column, uint32_t rows, uint32_t columns, float *v) {
    memset(v, 0, rows * column.g->linked * TL_WIDTH * sizeof *v);
    for (uint32_t i = 0; i < 4u; i++) {
        if (b->shares >> i & 1u) {
            link_share(row, column, rows, columns, i / 2u, i % 2u, v);
        }
    }
}

/* The rows of a joint if they hold a point along the world's axes and then angles, and nothing else; else 0. */
static inline uint32_t even_rows(const tl_joint_group *g) {
    const uint32_t form = TL_JOINT_POINT | TL_JOINT_PLAIN;
    return (g->needs & form) == form && g->linked == g->fixed ? g->fixed : 0u;
}

TL_INLINE void link_matrix(const tl_header *h, const tl_linkage *l, const uint32_t *live, float *v, uint32_t n) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->first_node;
    const tl_block *block = tl_linkage_blocks(h);
    for (uint32_t j = 0; j < l->nodes; j++) {
        link_lane column = link_of(h, l, j);
        float *d = v + node[j].diagonal * TL_WIDTH;
        if (n) {
            diagonal_even(column, d, n);
        } else {
            link_diagonal(column, live[j], d);
        }
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &block[node[j].first + k];
            link_lane row = link_of(h, l, b->node);
            if (n) {
                block_even(b, row, column, v + b->values * TL_WIDTH, n);
            } else {
                link_block(b, row, column, live[b->node], live[j], v + b->values * TL_WIDTH);
            }
        }
    }
}

static void link_factor(const tl_header *h, tl_linkage *l, float *v) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->first_node;
    uint32_t *live = tl_linkage_live(h) + l->first_place;
    l->even = node->rows;
    for (uint32_t j = 0; j < l->nodes; j++) {
        live[j] = live_rows(link_of(h, l, j));
        l->even = even_rows(link_of(h, l, j).g) == node->rows ? l->even : 0u;
    }
    LDLT_EVEN(l->even, link_matrix, h, l, live, v);
    ldlt_factor(node, tl_linkage_blocks(h), live, l->nodes, v, l->even);
}

/* Whether a linkage's rows or what holds of them changed since it was factored; from now on they did not. */
static int link_is_stale(const tl_header *h, const tl_linkage *l) {
    uint32_t stale = 0;
    for (uint32_t j = 0; j < l->nodes; j++) {
        uint32_t place = tl_linkage_places(h)[l->first_place + j];
        tl_joint_group *g = &tl_joint_group_pool(h)[place / TL_LANES];
        uint32_t mine = TL_WIDTH == 1u ? 1u << place % TL_LANES : 0xffu;
        stale |= g->stale & mine;
        g->stale &= ~mine;
    }
    return stale != 0;
}

/* The x of a linkage's joints becomes the impulses that meet it. */
static void link_solve(const tl_header *h, tl_linkage *l) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->first_node;
    const uint32_t *live = tl_linkage_live(h) + l->first_place;
    float *v = tl_linkage_values(h) + l->values;
    if (link_is_stale(h, l)) {
        link_factor(h, l, v);
    }
    for (uint32_t j = 0; j < l->nodes; j++) {
        link_lane k = link_of(h, l, j);
        for (uint32_t i = 0; i < live[j]; i++) {
            wf_store(v + (node[j].x + i) * TL_WIDTH, wf_load(k.g->x[i] + k.lane));
        }
    }
    ldlt_solve(node, tl_linkage_blocks(h), live, l->nodes, v, l->even);
    for (uint32_t j = 0; j < l->nodes; j++) {
        uint32_t place = tl_linkage_places(h)[l->first_place + j];
        tl_joint_group *g = &tl_joint_group_pool(h)[place / TL_LANES];
        for (uint32_t i = 0; i < live[j]; i++) {
            wf_store(g->x[i] + place % TL_LANES, wf_load(v + (node[j].x + i) * TL_WIDTH));
        }
    }
}
