/* The matrix of a press, A = J M^-1 J^T of the rows that hold, as block L D L^T over the structure that tl_block_plan
 * found. The lanes are the rows of a contact. Of a contact's diagonal block S, when those before it are taken out, what
 * is kept is the inverse M of the lower triangle of its own L D L^T, row by row, and 1 / D; of each block B below it
 * the transpose of V = B S^-1: to solve is then one product a block on the way forward and one on the way back. */

/* The diagonal is raised by this share of itself, which is beyond the rounding of what was subtracted from it. */
#define PRESS_RAISE 3e-6f

static inline v8 v8_set1(const float *p) { return v8_of(tl_f8_set1(p[0]), tl_f8_set1(p[1]), tl_f8_set1(p[2])); }

/* What impulses in the rows of q do to the speed of row r of p, through a body that is side t of q and s of p. */
static inline tl_f8 share_of(const tl_pressed *p, uint32_t r, uint32_t s, const tl_pressed *q, uint32_t t) {
    const float n[3] = {p->n[0][r], p->n[1][r], p->n[2][r]}, j[3] = {p->j[s][0][r], p->j[s][1][r], p->j[s][2][r]};
    tl_f8 way = v8_dot(v8_set1(n), v8_load(q->n[0])), turn = v8_dot(v8_set1(j), v8_load(q->j[t][0]));
    tl_f8 share = tl_f8_mad(tl_f8_mul(tl_f8_set1(p->mass[s]), way), tl_f8_set1(p->turns[s]), turn);
    return s == t ? share : tl_f8_neg(share);
}

/* Of the four points of a face one is too many: impulses v, as large as the triangles that the other three make, push
 * nothing. Returns the square of v. */
static float idle_of(const tl_pressed *p, float v[4]) {
    uint32_t side = p->turns[0] > 0.0f ? 0u : 1u;
    talus_vec3 at[4];
    for (uint32_t k = 0; k < 4u; k++) {
        at[k] = tl_v(p->j[side][0][k], p->j[side][1][k], p->j[side][2][k]);
    }
    talus_vec3 d1 = tl_sub(at[1], at[0]), d2 = tl_sub(at[2], at[0]), d3 = tl_sub(at[3], at[0]);
    talus_vec3 across = tl_add(tl_cross(d1, d2), tl_cross(d2, d3));
    v[1] = tl_dot(tl_cross(d2, d3), across);
    v[2] = tl_dot(tl_cross(d3, d1), across);
    v[3] = tl_dot(tl_cross(d1, d2), across);
    v[0] = -(v[1] + v[2] + v[3]);
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
}

/* Such impulses get a stiffness of their own, as large as the others have, so that the matrix can be factored: it
 * changes nothing of what a solution pushes, and leaves none of v in it. In rings, where idle impulses run through more
 * than one contact, the diagonal is raised by more instead. */
static void stiffen_idle(const tl_pressed *p, float *rows) {
    float v[TL_LANES] = {0.0f}, square, sum = 0.0f;
    if (p->points < 4u || (p->holds & point_bits(p)) != point_bits(p) || !((square = idle_of(p, v)) > 0.0f)) {
        return;
    }
    for (uint32_t i = 0; i < 4u; i++) {
        sum += rows[i * TL_LANES + i];
    }
    for (uint32_t i = 0; i < 4u; i++) {
        float *row = rows + i * TL_LANES;
        tl_f8_store(row, tl_f8_mad(tl_f8_load(row), tl_f8_set1(0.25f * sum / square * v[i]), tl_f8_loadu(v)));
    }
}

/* A row that does not hold stands for itself alone. */
static void fill_diagonal(const tl_pressed *p, float raise, float *rows) {
    tl_m8 held = tl_m8_from_bits(p->holds);
    for (uint32_t i = 0; i < p->rows; i++) {
        float *row = rows + i * TL_LANES, own;
        tl_f8_store(row, tl_f8_add(share_of(p, i, 0, p, 0), share_of(p, i, 1u, p, 1u)));
        own = row[i] * raise;
        tl_f8_store(row, holds(p, i) ? tl_f8_and_mask(held, tl_f8_load(row)) : tl_f8_zero());
        row[i] = own;
    }
}

/* The transpose of the block of rows of q below p's diagonal: a row for each of p's. */
static void fill_block(const tl_pressed *p, const tl_pressed *q, uint32_t shares, float *rows) {
    tl_m8 held = tl_m8_from_bits(q->holds);
    for (uint32_t r = 0; r < p->rows; r++) {
        tl_f8 sum = tl_f8_zero();
        for (uint32_t i = 0; i < 4u && holds(p, r); i++) {
            sum = shares >> i & 1u ? tl_f8_add(sum, share_of(p, r, i % 2u, q, i / 2u)) : sum;
        }
        tl_f8_store(rows + r * TL_LANES, tl_f8_and_mask(held, sum));
    }
}

/* Makes M of the rows of S, and 1 / D behind them; `steps` are the rows of L^T. */
TL_INLINE void invert_of(float *rows, uint32_t n, float *steps) {
    tl_f8 s[TL_BLOCK_ROWS], m[TL_BLOCK_ROWS];
    float *inverse = rows + n * TL_LANES;
    for (uint32_t r = 0; r < n; r++) {
        s[r] = tl_f8_load(rows + r * TL_LANES);
        m[r] = tl_f8_zero();
    }
    tl_f8_store(inverse, tl_f8_zero());
    for (uint32_t c = 0; c < n; c++) {
        float *step = steps + c * TL_LANES;
        m[c] = tl_f8_add(m[c], tl_f8_and_mask(tl_m8_from_bits(1u << c), tl_f8_set1(1.0f)));
        tl_f8_storeu(step, s[c]);
        inverse[c] = step[c] > 0.0f ? 1.0f / step[c] : 0.0f;
        tl_f8_storeu(step, tl_f8_mul(s[c], tl_f8_set1(inverse[c])));
        for (uint32_t r = c + 1u; r < n; r++) {
            tl_f8 by = tl_f8_set1(step[r]);
            s[r] = tl_f8_sub(s[r], tl_f8_mul(by, s[c]));
            m[r] = tl_f8_sub(m[r], tl_f8_mul(by, m[c]));
        }
    }
    for (uint32_t r = 0; r < n; r++) {
        tl_f8_store(rows + r * TL_LANES, m[r]);
    }
}

/* L^-1 of the transposes of blocks. */
TL_INLINE void step_down_of(const float *steps, float *block, uint32_t n) {
    tl_f8 b[TL_BLOCK_ROWS];
    for (uint32_t r = 0; r < n; r++) {
        b[r] = tl_f8_load(block + r * TL_LANES);
        for (uint32_t c = 0; c < r; c++) {
            b[r] = tl_f8_sub(b[r], tl_f8_mul(tl_f8_set1(steps[c * TL_LANES + r]), b[c]));
        }
        tl_f8_store(block + r * TL_LANES, b[r]);
    }
}

/* t -= c^T D^-1 d for n rows of c and d, both stepped down. */
TL_INLINE void take_of(float *t, uint32_t rows, const float *c, const float *d, const float *inverse, uint32_t n) {
    tl_f8 w[TL_BLOCK_ROWS];
    for (uint32_t i = 0; i < n; i++) {
        w[i] = tl_f8_mul(tl_f8_set1(inverse[i]), tl_f8_load(d + i * TL_LANES));
    }
    for (uint32_t r = 0; r < rows; r++) {
        tl_f8 sum = tl_f8_mul(tl_f8_set1(c[r]), w[0]);
        for (uint32_t i = 1; i < n; i++) {
            sum = tl_f8_mad(sum, tl_f8_set1(c[i * TL_LANES + r]), w[i]);
        }
        tl_f8_store(t + r * TL_LANES, tl_f8_sub(tl_f8_load(t + r * TL_LANES), sum));
    }
}

/* V^T from a block that was stepped down. */
TL_INLINE void finish_of(const float *rows, float *block, uint32_t n) {
    const float *inverse = rows + n * TL_LANES;
    tl_f8 w[TL_BLOCK_ROWS];
    for (uint32_t r = 0; r < n; r++) {
        w[r] = tl_f8_mul(tl_f8_set1(inverse[r]), tl_f8_load(block + r * TL_LANES));
    }
    for (uint32_t c = 0; c < n; c++) {
        tl_f8 v = w[c];
        for (uint32_t r = c + 1u; r < n; r++) {
            v = tl_f8_mad(v, tl_f8_set1(rows[r * TL_LANES + c]), w[r]);
        }
        tl_f8_store(block + c * TL_LANES, v);
    }
}

/* Takes node j out of those that it is coupled to. */
TL_INLINE void eliminate_of(const tl_block_node *node, const tl_block *blocks, uint32_t j, uint32_t n, float *v) {
    const tl_block *b = blocks + node[j].first;
    float *rows = v + node[j].diagonal, steps[TL_BLOCK_ROWS * TL_LANES];
    const float *inverse = rows + n * TL_LANES;
    invert_of(rows, n, steps);
    for (uint32_t k = 0; k < node[j].blocks; k++) {
        step_down_of(steps, v + b[k].values, n);
    }
    for (uint32_t k = 0; k < node[j].blocks; k++) {
        const tl_block_node *to = &node[b[k].node];
        const tl_block *target = blocks + to->first;
        const float *c = v + b[k].values;
        take_of(v + to->diagonal, to->rows, c, c, inverse, n);
        for (uint32_t i = k + 1u; i < node[j].blocks; i++) {
            while (target->node != b[i].node) {
                target++;
            }
            take_of(v + target->values, to->rows, c, v + b[i].values, inverse, n);
        }
    }
    for (uint32_t k = 0; k < node[j].blocks; k++) {
        finish_of(rows, v + b[k].values, n);
    }
}

/* The usual size, four points and two tangents, is compiled on its own. */
static void eliminate(const tl_block_node *node, const tl_block *blocks, uint32_t j, float *v) {
    if (node[j].rows == 6u) {
        eliminate_of(node, blocks, j, 6u, v);
    } else {
        eliminate_of(node, blocks, j, node[j].rows, v);
    }
}

static void factor_press(const tl_header *h, tl_press *s) {
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    const tl_block *blocks = tl_press_blocks(h);
    const tl_pressed *p = tl_pressed_pool(h) + s->first;
    float *v = tl_press_values(h) + s->values, raise = 1.0f + PRESS_RAISE + s->soft;
    for (uint32_t j = 0; j < s->count; j++) {
        fill_diagonal(&p[j], raise, v + node[j].diagonal);
        if (!s->rings) {
            stiffen_idle(&p[j], v + node[j].diagonal);
        }
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &blocks[node[j].first + k];
            fill_block(&p[j], &p[b->node], b->shares, v + b->values);
        }
    }
    for (uint32_t j = 0; j < s->count; j++) {
        eliminate(node, blocks, j, v);
    }
    s->stale = 0;
}

/* V x, and V^T x, of n rows of V^T. */
TL_INLINE tl_f8 product_of(const float *rows, const float *x, uint32_t n) {
    tl_f8 even = tl_f8_mul(tl_f8_load(rows), tl_f8_set1(x[0])), odd = tl_f8_zero();
    for (uint32_t i = 1; i < n; i++) {
        tl_f8 part = tl_f8_mul(tl_f8_load(rows + i * TL_LANES), tl_f8_set1(x[i]));
        even = i % 2u ? even : tl_f8_add(even, part);
        odd = i % 2u ? tl_f8_add(odd, part) : odd;
    }
    return tl_f8_add(even, odd);
}
TL_INLINE tl_f8 transposed_product_of(const float *rows, const float *x, uint32_t n) {
    tl_f8 p[TL_LANES], by = tl_f8_load(x);
    for (uint32_t i = 0; i < TL_LANES; i++) {
        p[i] = i < n ? tl_f8_mul(tl_f8_load(rows + i * TL_LANES), by) : tl_f8_zero();
    }
    tl_f8_transpose(p);
    tl_f8 even = tl_f8_add(tl_f8_add(p[0], p[4]), tl_f8_add(p[2], p[6]));
    return tl_f8_add(even, tl_f8_add(tl_f8_add(p[1], p[5]), tl_f8_add(p[3], p[7])));
}

TL_INLINE void forward_of(const tl_block_node *node, const tl_block *b, const tl_pressed *from, tl_pressed *p,
                          const float *v, uint32_t n) {
    for (uint32_t k = 0; k < node->blocks; k++) {
        float *x = p[b[k].node].x;
        tl_f8_store(x, tl_f8_sub(tl_f8_load(x), product_of(v + b[k].values, from->x, n)));
    }
}

TL_INLINE void back_of(const tl_block_node *node, const tl_block *b, tl_pressed *to, const tl_pressed *p,
                       const float *v, uint32_t n) {
    const float *rows = v + node->diagonal, *inverse = rows + n * TL_LANES;
    tl_f8 x = tl_f8_load(to->x), sum = tl_f8_zero();
    for (uint32_t r = 0; r < n; r++) {
        tl_f8 m = tl_f8_load(rows + r * TL_LANES);
        sum = tl_f8_mad(sum, tl_f8_set1(inverse[r] * tl_f8_sum(tl_f8_mul(m, x))), m);
    }
    for (uint32_t k = 0; k < node->blocks; k++) {
        sum = tl_f8_sub(sum, transposed_product_of(v + b[k].values, p[b[k].node].x, n));
    }
    tl_f8_store(to->x, sum);
}

/* The x of a press's contacts become A^-1 x. */
static void solve_press(const tl_header *h, const tl_press *s) {
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    const tl_block *blocks = tl_press_blocks(h);
    tl_pressed *p = tl_pressed_pool(h) + s->first;
    const float *v = tl_press_values(h) + s->values;
    for (uint32_t j = 0; j < s->count; j++) {
        const tl_block *b = blocks + node[j].first;
        if (node[j].rows == 6u) {
            forward_of(&node[j], b, &p[j], p, v, 6u);
        } else {
            forward_of(&node[j], b, &p[j], p, v, node[j].rows);
        }
    }
    for (uint32_t j = s->count; j-- > 0;) {
        const tl_block *b = blocks + node[j].first;
        if (node[j].rows == 6u) {
            back_of(&node[j], b, &p[j], p, v, 6u);
        } else {
            back_of(&node[j], b, &p[j], p, v, node[j].rows);
        }
    }
}
