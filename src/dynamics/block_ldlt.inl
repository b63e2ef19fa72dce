/* The arithmetic of block_ldlt.h for the width that the including file has chosen by width_one.h or width_eight.h. The
 * diagonal blocks hold A's lower halves, blocks that are fill hold zero; afterwards the blocks hold L and the diagonal
 * ones L with 1 / D on their diagonals. Of node j the first live[j] rows, 1 at least, are looked at. */
#include "dynamics/block_ldlt.h"

static inline uint32_t ldlt_at(uint32_t row, uint32_t column) { return row * (row + 1u) / 2u + column; }

/* L D L^T of a diagonal block, row by row (Golub and Van Loan, Matrix Computations, 4.1.2). */
static inline void ldlt_diagonal_of(float *a, uint32_t n) {
    wf l[TL_BLOCK_ROWS * (TL_BLOCK_ROWS + 1u) / 2u];
    for (uint32_t i = 0; i < n; i++) {
        wf w[TL_BLOCK_ROWS], d = wf_load(a + ldlt_at(i, i) * TL_WIDTH); /* w: L D of row i */
        for (uint32_t j = 0; j < i; j++) {
            w[j] = wf_load(a + ldlt_at(i, j) * TL_WIDTH);
            for (uint32_t m = 0; m < j; m++) {
                w[j] = wf_sub(w[j], wf_mul(w[m], l[ldlt_at(j, m)]));
            }
        }
        for (uint32_t j = 0; j < i; j++) {
            l[ldlt_at(i, j)] = wf_mul(w[j], l[ldlt_at(j, j)]);
            d = wf_sub(d, wf_mul(l[ldlt_at(i, j)], w[j]));
            wf_store(a + ldlt_at(i, j) * TL_WIDTH, l[ldlt_at(i, j)]);
        }
        l[ldlt_at(i, i)] = wf_inverse(d);
        wf_store(a + ldlt_at(i, i) * TL_WIDTH, l[ldlt_at(i, i)]);
    }
}

static void ldlt_diagonal(float *a, uint32_t n) {
    switch (n) {
    case 3:
        ldlt_diagonal_of(a, 3u);
        break;
    case 5:
        ldlt_diagonal_of(a, 5u);
        break;
    case 6:
        ldlt_diagonal_of(a, 6u);
        break;
    default:
        ldlt_diagonal_of(a, n);
    }
}

/* A block below a diagonal d becomes L, or stays L D where `whole`, and goes into the diagonal t that its rows belong
 * to: row by row, with what is needed of d at hand. L and L D are left packed in l and ld. */
static inline void ldlt_couple_of(const float *d, float *b, float *t, uint32_t rows, uint32_t n, uint32_t stride,
                                  int whole, wf *l, wf *ld) {
    wf factor[TL_BLOCK_ROWS * (TL_BLOCK_ROWS + 1u) / 2u];
    for (uint32_t i = 0; i < n * (n + 1u) / 2u; i++) {
        factor[i] = wf_load(d + i * TL_WIDTH);
    }
    for (uint32_t r = 0; r < rows; r++, b += stride * TL_WIDTH) {
        wf *w = ld + r * n;
        for (uint32_t c = 0; c < n; c++) {
            w[c] = wf_load(b + c * TL_WIDTH);
            for (uint32_t m = 0; m < c; m++) {
                w[c] = wf_sub(w[c], wf_mul(w[m], factor[ldlt_at(c, m)]));
            }
            l[r * n + c] = wf_mul(w[c], factor[ldlt_at(c, c)]);
        }
        for (uint32_t c = 0; c < n; c++) {
            wf_store(b + c * TL_WIDTH, whole ? w[c] : l[r * n + c]);
        }
        for (uint32_t c = 0; c <= r; c++) {
            wf sum = wf_mul(w[0], l[c * n]);
            for (uint32_t m = 1; m < n; m++) {
                sum = wf_mad(sum, w[m], l[c * n + m]);
            }
            wf_store(t + ldlt_at(r, c) * TL_WIDTH, wf_sub(wf_load(t + ldlt_at(r, c) * TL_WIDTH), sum));
        }
    }
}

/* The usual sizes are compiled on their own. */
static void ldlt_couple(const float *d, float *b, float *t, uint32_t rows, uint32_t n, uint32_t stride, int whole) {
    wf l[TL_BLOCK_ROWS * TL_BLOCK_ROWS], ld[TL_BLOCK_ROWS * TL_BLOCK_ROWS];
    switch (rows * 8u + n) {
    case 3u * 8u + 3u:
        ldlt_couple_of(d, b, t, 3u, 3u, stride, whole, l, ld);
        break;
    case 5u * 8u + 5u:
        ldlt_couple_of(d, b, t, 5u, 5u, stride, whole, l, ld);
        break;
    case 6u * 8u + 6u:
        ldlt_couple_of(d, b, t, 6u, 6u, stride, whole, l, ld);
        break;
    default:
        ldlt_couple_of(d, b, t, rows, n, stride, whole, l, ld);
    }
}

/* l = b D^-1 for a whole block. */
static inline void ldlt_scale(const float *d, const float *b, wf *l, uint32_t rows, uint32_t n, uint32_t stride) {
    for (uint32_t c = 0; c < n; c++) {
        wf inverse = wf_load(d + ldlt_at(c, c) * TL_WIDTH);
        for (uint32_t r = 0; r < rows; r++) {
            l[r * n + c] = wf_mul(wf_load(b + (r * stride + c) * TL_WIDTH), inverse);
        }
    }
}

/* A block of the factor: its live rows, and how far they stand apart. */
typedef struct ldlt_view {
    float *v;
    uint32_t rows, stride;
} ldlt_view;

/* t -= w l^T over n columns, l being packed. */
static inline void ldlt_take_of(ldlt_view t, ldlt_view w, const wf *l, uint32_t rows, uint32_t columns, uint32_t n) {
    for (uint32_t r = 0; r < rows; r++) {
        wf row[TL_BLOCK_ROWS];
        for (uint32_t m = 0; m < n; m++) {
            row[m] = wf_load(w.v + (r * w.stride + m) * TL_WIDTH);
        }
        for (uint32_t c = 0; c < columns; c++) {
            float *at = t.v + (r * t.stride + c) * TL_WIDTH;
            wf sum = wf_mul(row[0], l[c * n]);
            for (uint32_t m = 1; m < n; m++) {
                sum = wf_mad(sum, row[m], l[c * n + m]);
            }
            wf_store(at, wf_sub(wf_load(at), sum));
        }
    }
}

static void ldlt_take(ldlt_view t, ldlt_view w, const wf *l, uint32_t columns, uint32_t n) {
    if (w.rows == 3u && columns == 3u && n == 3u) {
        ldlt_take_of(t, w, l, 3u, 3u, 3u);
    } else if (w.rows == 5u && columns == 5u && n == 5u) {
        ldlt_take_of(t, w, l, 5u, 5u, 5u);
    } else {
        ldlt_take_of(t, w, l, w.rows, columns, n);
    }
}

/* Takes column j, whose blocks are whole, out of the blocks that couple those it is coupled to. */
static void ldlt_hand_up(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t j, float *v) {
    const tl_block_node *column = &node[j];
    const tl_block *b = block + column->first;
    uint32_t n = live[j];
    for (uint32_t k = 0; k < column->blocks; k++) {
        const tl_block_node *to = &node[b[k].node];
        const tl_block *target = block + to->first;
        ldlt_view w = {v + b[k].values * TL_WIDTH, live[b[k].node], column->rows};
        wf l[TL_BLOCK_ROWS * TL_BLOCK_ROWS];
        ldlt_scale(v + column->diagonal * TL_WIDTH, w.v, l, w.rows, n, w.stride);
        for (uint32_t i = k + 1u; i < column->blocks; i++) {
            while (target->node != b[i].node) {
                target++;
            }
            ldlt_view from = {v + b[i].values * TL_WIDTH, live[b[i].node], column->rows};
            ldlt_view into = {v + target->values * TL_WIDTH, from.rows, to->rows};
            ldlt_take(into, from, l, w.rows, n);
        }
        for (uint32_t r = 0; r < w.rows; r++) {
            for (uint32_t c = 0; c < n; c++) {
                wf_store(w.v + (r * w.stride + c) * TL_WIDTH, l[r * n + c]);
            }
        }
    }
}

/* A column of two blocks of n rows each, as a path has it: both become L, and go into the diagonals t of their rows and
 * into the block x that couples them. */
static inline void ldlt_pair_of(const float *d, float *const b[2], float *const t[2], float *x, uint32_t n,
                                uint32_t stride, uint32_t x_stride) {
    wf l[2][TL_BLOCK_ROWS * TL_BLOCK_ROWS], ld[2][TL_BLOCK_ROWS * TL_BLOCK_ROWS];
    ldlt_couple_of(d, b[0], t[0], n, n, stride, 0, l[0], ld[0]);
    ldlt_couple_of(d, b[1], t[1], n, n, stride, 0, l[1], ld[1]);
    for (uint32_t r = 0; r < n; r++) {
        for (uint32_t c = 0; c < n; c++) {
            float *at = x + (r * x_stride + c) * TL_WIDTH;
            wf sum = wf_mul(ld[1][r * n], l[0][c * n]);
            for (uint32_t m = 1; m < n; m++) {
                sum = wf_mad(sum, ld[1][r * n + m], l[0][c * n + m]);
            }
            wf_store(at, wf_sub(wf_load(at), sum));
        }
    }
}

/* Column j, which has two blocks. */
static inline void ldlt_take_pair(const tl_block_node *node, const tl_block *block, uint32_t j, float *v, uint32_t n,
                                  uint32_t stride, uint32_t x_stride) {
    const tl_block *k = block + node[j].first, *target = block + node[k->node].first;
    while (target->node != k[1].node) {
        target++;
    }
    float *const b[2] = {v + k[0].values * TL_WIDTH, v + k[1].values * TL_WIDTH};
    float *const t[2] = {v + node[k[0].node].diagonal * TL_WIDTH, v + node[k[1].node].diagonal * TL_WIDTH};
    ldlt_pair_of(v + node[j].diagonal * TL_WIDTH, b, t, v + target->values * TL_WIDTH, n, stride, x_stride);
}

static void ldlt_pair_three(const tl_block_node *node, const tl_block *block, uint32_t j, float *v) {
    ldlt_take_pair(node, block, j, v, 3u, node[j].rows, node[block[node[j].first].node].rows);
}
static void ldlt_pair_five(const tl_block_node *node, const tl_block *block, uint32_t j, float *v) {
    ldlt_take_pair(node, block, j, v, 5u, node[j].rows, node[block[node[j].first].node].rows);
}

/* Whether column j was such a pair of a usual size, which is done with then. */
static int ldlt_pair(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t j, float *v) {
    const tl_block *k = block + node[j].first;
    uint32_t n = live[j];
    if (node[j].blocks != 2u || (n != 3u && n != 5u) || live[k[0].node] != n || live[k[1].node] != n) {
        return 0;
    }
    (n == 3u ? ldlt_pair_three : ldlt_pair_five)(node, block, j, v);
    return 1;
}

static void ldlt_raise(const tl_block_node *node, const uint32_t *live, uint32_t nodes, float *v) {
    wf raise = wf_set1(1.0f + TL_BLOCK_RAISE);
    for (uint32_t j = 0; j < nodes; j++) {
        float *d = v + node[j].diagonal * TL_WIDTH;
        for (uint32_t i = 0; i < live[j]; i++) {
            float *at = d + ldlt_at(i, i) * TL_WIDTH;
            wf_store(at, wf_mul(wf_load(at), raise));
        }
    }
}

/* Where all nodes have n rows, and all of these are live, n is known: the usual numbers are compiled on their own. */
#define LDLT_EVEN(n, f, ...)                                                                                           \
    do {                                                                                                               \
        switch (n) {                                                                                                   \
        case 3:                                                                                                        \
            f(__VA_ARGS__, 3u);                                                                                        \
            break;                                                                                                     \
        case 5:                                                                                                        \
            f(__VA_ARGS__, 5u);                                                                                        \
            break;                                                                                                     \
        default:                                                                                                       \
            f(__VA_ARGS__, 0u);                                                                                        \
        }                                                                                                              \
    } while (0)

static inline void ldlt_eliminate_nodes(const tl_block_node *node, const tl_block *block, const uint32_t *live,
                                        uint32_t nodes, float *v, uint32_t n) {
    for (uint32_t j = 0; j < nodes; j++) {
        float *d = v + node[j].diagonal * TL_WIDTH;
        int several = node[j].blocks > 1u;
        if (n) {
            ldlt_diagonal_of(d, n);
        } else {
            ldlt_diagonal(d, live[j]);
        }
        if (n && node[j].blocks == 2u) {
            ldlt_take_pair(node, block, j, v, n, n, n);
            continue;
        }
        if (several && ldlt_pair(node, block, live, j, v)) {
            continue;
        }
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &block[node[j].first + k];
            ldlt_couple(d, v + b->values * TL_WIDTH, v + node[b->node].diagonal * TL_WIDTH, live[b->node], live[j],
                        node[j].rows, several);
        }
        if (several) {
            ldlt_hand_up(node, block, live, j, v);
        }
    }
}

/* Eliminates the first nodes; what is left of others is what they have to do with each other without these. */
static void ldlt_eliminate(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t nodes,
                           float *v, uint32_t even) {
    LDLT_EVEN(even, ldlt_eliminate_nodes, node, block, live, nodes, v);
}

static void ldlt_factor(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t nodes,
                        float *v, uint32_t even) {
    ldlt_raise(node, live, nodes, v);
    ldlt_eliminate(node, block, live, nodes, v, even);
}

/* x becomes L^-1 x for a node, and y of another less what that is to it by the block l. */
static inline void ldlt_forward_of(const float *d, float *x, uint32_t n) {
    wf y[TL_BLOCK_ROWS];
    for (uint32_t i = 0; i < n; i++) {
        y[i] = wf_load(x + i * TL_WIDTH);
        for (uint32_t m = 0; m < i; m++) {
            y[i] = wf_sub(y[i], wf_mul(wf_load(d + ldlt_at(i, m) * TL_WIDTH), y[m]));
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        wf_store(x + i * TL_WIDTH, y[i]);
    }
}

static inline void ldlt_pass_of(const float *l, const float *x, float *y, uint32_t rows, uint32_t n, uint32_t stride) {
    wf from[TL_BLOCK_ROWS];
    for (uint32_t m = 0; m < n; m++) {
        from[m] = wf_load(x + m * TL_WIDTH);
    }
    for (uint32_t r = 0; r < rows; r++, l += stride * TL_WIDTH) {
        wf sum = wf_mul(wf_load(l), from[0]);
        for (uint32_t m = 1; m < n; m++) {
            sum = wf_mad(sum, wf_load(l + m * TL_WIDTH), from[m]);
        }
        wf_store(y + r * TL_WIDTH, wf_sub(wf_load(y + r * TL_WIDTH), sum));
    }
}

/* x less what y is to it by the block l. */
static inline void ldlt_pass_back_of(const float *l, const float *y, float *x, uint32_t rows, uint32_t n,
                                     uint32_t stride) {
    wf to[TL_BLOCK_ROWS];
    for (uint32_t i = 0; i < n; i++) {
        to[i] = wf_load(x + i * TL_WIDTH);
    }
    for (uint32_t r = 0; r < rows; r++, l += stride * TL_WIDTH) {
        wf by = wf_load(y + r * TL_WIDTH);
        for (uint32_t i = 0; i < n; i++) {
            to[i] = wf_sub(to[i], wf_mul(wf_load(l + i * TL_WIDTH), by));
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        wf_store(x + i * TL_WIDTH, to[i]);
    }
}

/* x becomes L^-T x for a node. */
static inline void ldlt_back_of(const float *d, float *x, uint32_t n) {
    wf y[TL_BLOCK_ROWS];
    for (uint32_t i = n; i-- > 0;) {
        y[i] = wf_load(x + i * TL_WIDTH);
        for (uint32_t m = i + 1u; m < n; m++) {
            y[i] = wf_sub(y[i], wf_mul(wf_load(d + ldlt_at(m, i) * TL_WIDTH), y[m]));
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        wf_store(x + i * TL_WIDTH, y[i]);
    }
}

static void ldlt_forward(const float *d, float *x, uint32_t n) {
    switch (n) {
    case 3:
        ldlt_forward_of(d, x, 3u);
        break;
    case 5:
        ldlt_forward_of(d, x, 5u);
        break;
    case 6:
        ldlt_forward_of(d, x, 6u);
        break;
    default:
        ldlt_forward_of(d, x, n);
    }
}

static void ldlt_back(const float *d, float *x, uint32_t n) {
    switch (n) {
    case 3:
        ldlt_back_of(d, x, 3u);
        break;
    case 5:
        ldlt_back_of(d, x, 5u);
        break;
    case 6:
        ldlt_back_of(d, x, 6u);
        break;
    default:
        ldlt_back_of(d, x, n);
    }
}

static void ldlt_pass(const float *l, const float *x, float *y, uint32_t rows, uint32_t n, uint32_t stride) {
    if (rows == 3u && n == 3u) {
        ldlt_pass_of(l, x, y, 3u, 3u, stride);
    } else if (rows == 5u && n == 5u) {
        ldlt_pass_of(l, x, y, 5u, 5u, stride);
    } else if (rows == 6u && n == 6u) {
        ldlt_pass_of(l, x, y, 6u, 6u, stride);
    } else {
        ldlt_pass_of(l, x, y, rows, n, stride);
    }
}

static void ldlt_pass_back(const float *l, const float *y, float *x, uint32_t rows, uint32_t n, uint32_t stride) {
    if (rows == 3u && n == 3u) {
        ldlt_pass_back_of(l, y, x, 3u, 3u, stride);
    } else if (rows == 5u && n == 5u) {
        ldlt_pass_back_of(l, y, x, 5u, 5u, stride);
    } else if (rows == 6u && n == 6u) {
        ldlt_pass_back_of(l, y, x, 6u, 6u, stride);
    } else {
        ldlt_pass_back_of(l, y, x, rows, n, stride);
    }
}

static inline void ldlt_forward_nodes(const tl_block_node *node, const tl_block *block, const uint32_t *live,
                                      uint32_t nodes, float *v, uint32_t n) {
    for (uint32_t j = 0; j < nodes; j++) {
        const float *d = v + node[j].diagonal * TL_WIDTH;
        float *x = v + node[j].x * TL_WIDTH;
        const tl_block *b = block + node[j].first, *end = b + node[j].blocks;
        if (n) {
            ldlt_forward_of(d, x, n);
        } else {
            ldlt_forward(d, x, live[j]);
        }
        for (; b < end; b++) {
            const float *l = v + b->values * TL_WIDTH;
            float *y = v + node[b->node].x * TL_WIDTH;
            if (n) {
                ldlt_pass_of(l, x, y, n, n, n);
            } else {
                ldlt_pass(l, x, y, live[b->node], live[j], node[j].rows);
            }
        }
    }
}

static inline void ldlt_back_nodes(const tl_block_node *node, const tl_block *block, const uint32_t *live,
                                   uint32_t nodes, float *v, uint32_t n) {
    for (uint32_t j = nodes; j-- > 0;) {
        const float *d = v + node[j].diagonal * TL_WIDTH;
        float *x = v + node[j].x * TL_WIDTH;
        const tl_block *b = block + node[j].first, *end = b + node[j].blocks;
        for (uint32_t i = 0; i < (n ? n : live[j]); i++) {
            wf_store(x + i * TL_WIDTH, wf_mul(wf_load(x + i * TL_WIDTH), wf_load(d + ldlt_at(i, i) * TL_WIDTH)));
        }
        for (; b < end; b++) {
            const float *l = v + b->values * TL_WIDTH, *y = v + node[b->node].x * TL_WIDTH;
            if (n) {
                ldlt_pass_back_of(l, y, x, n, n, n);
            } else {
                ldlt_pass_back(l, y, x, live[b->node], live[j], node[j].rows);
            }
        }
        if (n) {
            ldlt_back_of(d, x, n);
        } else {
            ldlt_back(d, x, live[j]);
        }
    }
}

/* From the first nodes' right-hand sides to what is left of those of others, and from the others' solution back. */
static void ldlt_forward_pass(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t nodes,
                              float *v, uint32_t even) {
    LDLT_EVEN(even, ldlt_forward_nodes, node, block, live, nodes, v);
}

static void ldlt_back_pass(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t nodes,
                           float *v, uint32_t even) {
    LDLT_EVEN(even, ldlt_back_nodes, node, block, live, nodes, v);
}

/* The nodes' right-hand sides become the solution. */
static void ldlt_solve(const tl_block_node *node, const tl_block *block, const uint32_t *live, uint32_t nodes, float *v,
                       uint32_t even) {
    ldlt_forward_pass(node, block, live, nodes, v, even);
    ldlt_back_pass(node, block, live, nodes, v, even);
}
