/* Linkages cut into pieces (stage/row/cuts.c), eight pieces side by side. Of the nodes of a piece the last but one is
 * the cut behind it, and the last one the cut before it, which is the one behind the piece one lane down. */
#include <string.h>

static inline link_lane cut_group(const tl_header *h, const tl_linkage *l, uint32_t k) {
    const tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + k];
    link_lane lane = {g, tl_joint_row_pool(h) + g->first_row, 0};
    return lane;
}

/* The cuts before the pieces: what the cuts behind them are, one lane up. Holds no more than coupling them to the
 * pieces' first joints takes, which are on their second side. */
typedef struct cuts_before {
    tl_joint_group g;
    tl_joint_row rows[TL_LINK_ROWS];
    tl_f8 aligns; /* unused: it puts the others where lanes can be loaded from */
} cuts_before;

static inline void lane_up(const float *from, float *to) {
    to[0] = 0.0f;
    memcpy(to + 1, from, (TL_LANES - 1u) * sizeof *to);
}

/* Eight floats with those of the next lanes added, of which the last one has none. */
static inline tl_f8 with_next(const float *mine, const float *next) {
    tl_f8 down = tl_f8_and_mask(tl_m8_from_bits(0x7fu), tl_f8_loadu(next + 1));
    return tl_f8_add(tl_f8_load(mine), down);
}

TL_INLINE void find_cuts_before(link_lane behind, uint32_t live, cuts_before *c, uint32_t n) {
    lane_up(behind.g->mass[1], c->g.mass[1]);
    lane_up(behind.g->turns[1], c->g.turns[1]);
    for (uint32_t i = 0; i < 3u * n; i++) {
        lane_up(behind.rows[i / 3u].jb[i % 3u], c->rows[i / 3u].jb[i % 3u]);
    }
    if (n) {
        return;
    }
    memcpy(c->g.code, behind.g->code, sizeof c->g.code);
    for (uint32_t i = 0; i < live; i++) {
        lane_up(behind.g->active[i], c->g.active[i]);
        for (uint32_t k = 0; k < 3u; k++) {
            lane_up(behind.rows[i].n[k], c->rows[i].n[k]);
            lane_up(behind.rows[i].jb[k], c->rows[i].jb[k]);
        }
    }
}

/* What is left of the cuts once the pieces are eliminated: of both pieces that each one lies between. */
TL_INLINE void gather_cuts(const tl_header *h, const tl_linkage *l, const float *v, float *rest, uint32_t n) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->cut, *behind = &node[l->inner], *before = behind + 1;
    const tl_block_node *cut = before + 1;
    const tl_block *block = tl_linkage_blocks(h);
    uint32_t rows = n ? n : behind->rows, entries = rows * (rows + 1u) / 2u;
    float sum[TL_LINK_ROWS * (TL_LINK_ROWS + 1u) / 2u][TL_LANES];
    for (uint32_t e = 0; e < entries; e++) {
        tl_f8_storeu(sum[e], with_next(v + (behind->diagonal + e) * TL_LANES, v + (before->diagonal + e) * TL_LANES));
    }
    for (uint32_t j = 0; j < l->cuts; j++) {
        float *to = rest + cut[j].diagonal;
        for (uint32_t e = 0; e < entries; e++) {
            to[e] = sum[e][j];
        }
    }
    const float *across = v + block[behind->first].values * TL_LANES;
    for (uint32_t j = 1; j < l->cuts; j++) {
        float *to = rest + block[cut[j - 1u].first].values;
        for (uint32_t r = 0; r < rows; r++) {
            for (uint32_t c = 0; c < rows; c++) {
                to[c * rows + r] = across[(r * rows + c) * TL_LANES + j];
            }
        }
    }
}

TL_INLINE void cut_matrix(const tl_header *h, const tl_linkage *l, const uint32_t *live, float *v, uint32_t n) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->cut;
    const tl_block *block = tl_linkage_blocks(h);
    uint32_t inner = l->inner;
    cuts_before before;
    link_lane last = {&before.g, before.rows, 0};
    find_cuts_before(cut_group(h, l, inner), live[inner], &before, n);
    for (uint32_t j = 0; j <= inner; j++) {
        link_lane column = cut_group(h, l, j);
        float *d = v + node[j].diagonal * TL_WIDTH;
        if (n) {
            diagonal_even(column, d, n);
        } else {
            link_diagonal(column, live[j], d);
        }
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &block[node[j].first + k];
            link_lane row = b->node <= inner ? cut_group(h, l, b->node) : last;
            if (n) {
                block_even(b, row, column, v + b->values * TL_WIDTH, n);
            } else {
                link_block(b, row, column, live[b->node], live[j], v + b->values * TL_WIDTH);
            }
        }
    }
}

static void cut_factor(const tl_header *h, tl_linkage *l, float *v) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->cut;
    uint32_t *live = tl_linkage_live(h) + l->first_place, inner = l->inner, rows = node->rows;
    for (uint32_t j = 0; j <= inner; j++) {
        live[j] = live_rows(cut_group(h, l, j));
    }
    for (uint32_t j = inner + 1u; j < inner + 2u + l->cuts; j++) {
        live[j] = live[inner];
    }
    l->even = even_rows(cut_group(h, l, 0).g); /* all its joints are alike */
    LDLT_EVEN(l->even, cut_matrix, h, l, live, v);
    memset(v + node[inner + 1u].diagonal * TL_WIDTH, 0, rows * (rows + 1u) / 2u * TL_WIDTH * sizeof *v);
    ldlt_raise(node, live, inner + 1u, v);
    ldlt_eliminate(node, tl_linkage_blocks(h), live, inner, v, l->even);
    LDLT_EVEN(l->even, gather_cuts, h, l, v, v + l->cut_values);
    tl_cuts_factor(h, l);
}

static int cut_is_stale(const tl_header *h, const tl_linkage *l) {
    uint32_t stale = 0;
    for (uint32_t j = 0; j <= l->inner; j++) {
        tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + j];
        stale |= g->stale;
        g->stale = 0;
    }
    return stale != 0;
}

/* The x of a cut linkage's joints becomes the impulses that meet it. */
static void cut_solve(const tl_header *h, tl_linkage *l) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->cut, *cut = node + l->inner + 2u;
    const uint32_t *live = tl_linkage_live(h) + l->first_place, inner = l->inner;
    float *v = tl_linkage_values(h) + l->values, *rest = v + l->cut_values;
    float *behind = v + node[inner].x * TL_WIDTH, *before = v + node[inner + 1u].x * TL_WIDTH;
    if (cut_is_stale(h, l)) {
        cut_factor(h, l, v);
    }
    for (uint32_t j = 0; j <= inner; j++) {
        const tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + j];
        float *x = v + node[j].x * TL_WIDTH;
        for (uint32_t i = 0; i < live[j]; i++) {
            tl_f8_store(x + i * TL_WIDTH, tl_f8_load(g->x[i]));
        }
    }
    for (uint32_t i = 0; i < live[inner]; i++) {
        tl_f8_store(before + i * TL_WIDTH, tl_f8_zero());
    }
    ldlt_forward_pass(node, tl_linkage_blocks(h), live, inner, v, l->even);
    for (uint32_t i = 0; i < live[inner]; i++) {
        float sum[TL_LANES];
        tl_f8_storeu(sum, with_next(behind + i * TL_WIDTH, before + i * TL_WIDTH));
        for (uint32_t j = 0; j < l->cuts; j++) {
            rest[cut[j].x + i] = sum[j];
        }
    }
    tl_cuts_solve(h, l);
    for (uint32_t i = 0; i < live[inner]; i++) {
        float x[TL_LANES + 1u] = {0.0f}; /* of the cuts behind, one lane up of those before */
        for (uint32_t j = 0; j < l->cuts; j++) {
            x[j + 1u] = rest[cut[j].x + i];
        }
        tl_f8_store(behind + i * TL_WIDTH, tl_f8_loadu(x + 1));
        tl_f8_store(before + i * TL_WIDTH, tl_f8_loadu(x));
    }
    ldlt_back_pass(node, tl_linkage_blocks(h), live, inner, v, l->even);
    for (uint32_t j = 0; j <= inner; j++) {
        tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + j];
        for (uint32_t i = 0; i < live[j]; i++) {
            tl_f8_store(g->x[i], tl_f8_load(v + (node[j].x + i) * TL_WIDTH));
        }
    }
}
