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

static inline void lane_down(const float *from, float *to) {
    memcpy(to, from + 1, (TL_LANES - 1u) * sizeof *to);
    to[TL_LANES - 1u] = 0.0f;
}

static void find_cuts_before(link_lane behind, uint32_t live, cuts_before *c) {
    memcpy(c->g.code, behind.g->code, sizeof c->g.code);
    lane_up(behind.g->mass[1], c->g.mass[1]);
    lane_up(behind.g->turns[1], c->g.turns[1]);
    for (uint32_t i = 0; i < live; i++) {
        lane_up(behind.g->active[i], c->g.active[i]);
        for (uint32_t k = 0; k < 3u; k++) {
            lane_up(behind.rows[i].n[k], c->rows[i].n[k]);
            lane_up(behind.rows[i].jb[k], c->rows[i].jb[k]);
        }
    }
}

/* What is left of the cuts once the pieces are eliminated: of both pieces that each one lies between. */
static void gather_cuts(const tl_header *h, const tl_linkage *l, const float *v, float *rest) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->cut, *behind = &node[l->inner], *before = behind + 1;
    const tl_block_node *cut = before + 1;
    const tl_block *block = tl_linkage_blocks(h);
    uint32_t rows = behind->rows;
    for (uint32_t e = 0; e < rows * (rows + 1u) / 2u; e++) {
        const float *mine = v + (behind->diagonal + e) * TL_LANES;
        float next[TL_LANES];
        lane_down(v + (before->diagonal + e) * TL_LANES, next);
        for (uint32_t j = 0; j < l->cuts; j++) {
            rest[cut[j].diagonal + e] = mine[j] + next[j];
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
    find_cuts_before(cut_group(h, l, inner), live[inner], &before);
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
    LDLT_EVEN(l->even, cut_matrix, h, l, live, v)
    memset(v + node[inner + 1u].diagonal * TL_WIDTH, 0, rows * (rows + 1u) / 2u * TL_WIDTH * sizeof *v);
    ldlt_raise(node, live, inner + 1u, v);
    ldlt_eliminate(node, tl_linkage_blocks(h), live, inner, v, l->even);
    gather_cuts(h, l, v, v + l->cut_values);
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
        memcpy(v + node[j].x * TL_WIDTH, cut_group(h, l, j).g->x, live[j] * TL_WIDTH * sizeof *v);
    }
    memset(before, 0, live[inner] * TL_WIDTH * sizeof *v);
    ldlt_forward_pass(node, tl_linkage_blocks(h), live, inner, v, l->even);
    for (uint32_t i = 0; i < live[inner]; i++, behind += TL_WIDTH, before += TL_WIDTH) {
        float next[TL_LANES];
        lane_down(before, next);
        for (uint32_t j = 0; j < l->cuts; j++) {
            rest[cut[j].x + i] = behind[j] + next[j];
        }
    }
    tl_cuts_solve(h, l);
    behind = v + node[inner].x * TL_WIDTH, before = v + node[inner + 1u].x * TL_WIDTH;
    for (uint32_t i = 0; i < live[inner]; i++, behind += TL_WIDTH, before += TL_WIDTH) {
        memset(behind, 0, TL_LANES * sizeof *behind);
        for (uint32_t j = 0; j < l->cuts; j++) {
            behind[j] = rest[cut[j].x + i];
        }
        lane_up(behind, before);
    }
    ldlt_back_pass(node, tl_linkage_blocks(h), live, inner, v, l->even);
    for (uint32_t j = 0; j <= inner; j++) {
        tl_joint_group *g = &tl_joint_group_pool(h)[l->first_group + j];
        memcpy(g->x, v + node[j].x * TL_WIDTH, live[j] * TL_WIDTH * sizeof *v);
    }
}
