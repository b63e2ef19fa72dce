/* Pressed contacts, a press at a time: the rows that hold, of normals and of friction, are met at once by the block
 * L D L^T of their matrix. Which hold is found by active sets: a point that would have to pull is let go, one that
 * closes is taken in, and friction beyond its cone slides on it. Where that leads astray, for rows may say nearly the
 * same and quarrel, the way is gone only as far as nothing pulls, and the diagonal is raised, as Levenberg and
 * Marquardt do for least squares (Nocedal and Wright, "Numerical Optimization", 10.3, 16.5). What a few rounds leave,
 * and what the system does not know (friction about the normal, rolling), is left to the sweep over all contacts that
 * follows. */
#include <string.h>

#include "base/width_one.h"
#include "stage/stages.h"

#include "dynamics/block_ldlt.inl"

#define MOST_ROUNDS 8u
#define LEAST_ROUNDS 2u
#define MOST_LOOKS 256u   /* contacts in all rounds of a solve: of large presses there are fewer */
#define SOFT 2e-4f        /* by what share of itself the diagonal is raised when a step begins, */
#define SOFTER 16.0f      /* how many times more where a way leads astray, */
#define SOFTEST 0.1f      /* and at most */
#define LEAST_SHARE 0.5f  /* of a way that is to be of use */
#define AT_REST 1e-5f     /* m/s: rows that all are slower are met */
#define CLOSING 1e-4f     /* m/s: from here on a point without an impulse is taken in */
#define NEAR_SLIDE 0.999f /* of the friction that a sliding contact has */
#define PRESS_DEPTH 5e-4f /* m: overlap that is left */

typedef struct spot {
    tl_contact_group *g;
    uint32_t lane;
} spot;

static spot spot_of(const tl_header *h, const tl_pressed *p) {
    spot s = {&tl_group_pool(h)[p->place / TL_LANES], p->place % TL_LANES};
    return s;
}

static const float *direction_of(const tl_pressed *p, uint32_t row) {
    return p->n[row < p->points ? 0u : row - p->points + 1u];
}

static float dot(const float *a, const float *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* --- rows --------------------------------------------------------------------------------------- */

static void take_lane(float out[3], const float *column, uint32_t lane) {
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = column[k * TL_LANES + lane];
    }
}

static void fill_rows(const tl_header *h, tl_pressed *p) {
    spot s = spot_of(h, p);
    take_lane(p->n[0], s.g->normal[0], s.lane);
    take_lane(p->n[1], s.g->tangent[0], s.lane);
    const float *n = p->n[0], *t = p->n[1];
    p->n[2][0] = n[1] * t[2] - n[2] * t[1], p->n[2][1] = n[2] * t[0] - n[0] * t[2];
    p->n[2][2] = n[0] * t[1] - n[1] * t[0];
    for (uint32_t k = 0; k < p->points; k++) {
        take_lane(p->j[0][k], s.g->point[k].ja[0], s.lane);
        take_lane(p->j[1][k], s.g->point[k].jb[0], s.lane);
    }
    take_lane(p->j[0][p->points], s.g->ja1[0], s.lane);
    take_lane(p->j[1][p->points], s.g->jb1[0], s.lane);
    take_lane(p->j[0][p->points + 1u], s.g->ja2[0], s.lane);
    take_lane(p->j[1][p->points + 1u], s.g->jb2[0], s.lane);
    for (uint32_t side = 0; side < 2u; side++) {
        p->mass[side] = tl_row_velocity(h)[p->row[side]].f[6];
        p->turns[side] = tl_row_velocity(h)[p->row[side]].f[7];
    }
}

/* What an impulse in row c of q does to the speed of row r of p, through a body that is side t of q and s of p. */
static float share_of(const tl_pressed *p, uint32_t r, uint32_t s, const tl_pressed *q, uint32_t c, uint32_t t) {
    float share = p->mass[s] * dot(direction_of(p, r), direction_of(q, c)) + p->turns[s] * dot(p->j[s][r], q->j[t][c]);
    return s == t ? share : -share;
}

static void fill_matrix(tl_pressed *p) {
    for (uint32_t i = 0; i < p->points + 2u; i++) {
        for (uint32_t j = 0; j <= i; j++) {
            p->matrix[ldlt_at(i, j)] = share_of(p, i, 0, p, j, 0) + share_of(p, i, 1u, p, j, 1u);
        }
    }
}

void tl_stage_begin_presses(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t i = 0; i < h->presses; i++) {
        tl_press *s = &tl_presses(h)[i];
        for (uint32_t k = 0; k < s->count; k++) {
            fill_rows(h, &tl_pressed_pool(h)[s->first + k]);
            fill_matrix(&tl_pressed_pool(h)[s->first + k]);
        }
        s->stale = 1u;
        s->soft = SOFT;
    }
}

/* --- the factor --------------------------------------------------------------------------------- */

static int holds(const tl_pressed *p, uint32_t row) { return (int)(p->holds >> row & 1u); }

/* A row that does not hold stands for itself alone. */
static void fill_diagonal(const tl_pressed *p, float soft, float *d) {
    for (uint32_t i = 0; i < p->points + 2u; i++) {
        for (uint32_t j = 0; j < i; j++) {
            d[ldlt_at(i, j)] = holds(p, i) && holds(p, j) ? p->matrix[ldlt_at(i, j)] : 0.0f;
        }
        d[ldlt_at(i, i)] = p->matrix[ldlt_at(i, i)] * (1.0f + soft);
    }
}

static void fill_block(const tl_pressed *p, const tl_pressed *q, uint32_t shares, float *v) {
    for (uint32_t r = 0; r < p->points + 2u; r++) {
        for (uint32_t c = 0; c < q->points + 2u; c++, v++) {
            *v = 0.0f;
            for (uint32_t i = 0; i < 4u && holds(p, r) && holds(q, c); i++) {
                *v += shares >> i & 1u ? share_of(p, r, i / 2u, q, c, i % 2u) : 0.0f;
            }
        }
    }
}

static void live_rows(const tl_header *h, const tl_press *s, uint32_t live[TL_MOST_PRESSED]) {
    for (uint32_t k = 0; k < s->count; k++) {
        live[k] = tl_press_nodes(h)[s->first + k].rows;
    }
}

static void factor(const tl_header *h, tl_press *s) {
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    const tl_pressed *p = tl_pressed_pool(h) + s->first;
    float *v = tl_press_values(h) + s->values;
    uint32_t live[TL_MOST_PRESSED];
    live_rows(h, s, live);
    for (uint32_t j = 0; j < s->count; j++) {
        fill_diagonal(&p[j], s->soft, v + node[j].diagonal);
        for (uint32_t k = 0; k < node[j].blocks; k++) {
            const tl_block *b = &tl_press_blocks(h)[node[j].first + k];
            fill_block(&p[b->node], &p[j], b->shares, v + b->values);
        }
    }
    ldlt_factor(node, tl_press_blocks(h), live, s->count, v);
    s->stale = 0;
}

static void solve(const tl_header *h, tl_press *s) {
    uint32_t live[TL_MOST_PRESSED];
    live_rows(h, s, live);
    ldlt_solve(tl_press_nodes(h) + s->first, tl_press_blocks(h), live, s->count, tl_press_values(h) + s->values);
}

/* --- speeds and impulses ------------------------------------------------------------------------ */

/* Of b against a along a row; `rows` are velocities, displacements or ways. */
static float speed_of(const tl_row8 *rows, const tl_pressed *p, uint32_t row) {
    const float *a = rows[p->row[0]].f, *b = rows[p->row[1]].f, *n = direction_of(p, row);
    return dot(n, b) - dot(n, a) + dot(p->j[1][row], b + 3) - dot(p->j[0][row], a + 3);
}

static void apply(tl_row8 *rows, const tl_pressed *p, uint32_t row, float impulse) {
    const float *n = direction_of(p, row);
    for (uint32_t side = 0; side < 2u; side++) {
        float *f = rows[p->row[side]].f, signed_impulse = side ? impulse : -impulse;
        for (uint32_t k = 0; k < 3u; k++) {
            f[k] += signed_impulse * p->mass[side] * n[k];
            f[3u + k] += signed_impulse * p->turns[side] * p->j[side][row][k];
        }
    }
}

static float *impulse_of(spot s, const tl_pressed *p, uint32_t row) {
    return row < p->points ? &s.g->point[row].impulse[s.lane] : &s.g->tangent_impulse[row - p->points][s.lane];
}

static void add_impulse(const tl_header *h, tl_pressed *p, uint32_t row, float impulse) {
    *impulse_of(spot_of(h, p), p, row) += impulse;
    apply(tl_row_velocity(h), p, row, impulse);
}

/* m: the separation of a point where the bodies are now. */
static float gap_of(const tl_header *h, const tl_pressed *p, uint32_t point) {
    spot s = spot_of(h, p);
    return s.g->point[point].gap[s.lane] + speed_of(tl_row_moved(h), p, point);
}

static float pressure_of(spot s, const tl_pressed *p) {
    float sum = 0.0f;
    for (uint32_t k = 0; k < p->points; k++) {
        sum += tl_max(s.g->point[k].impulse[s.lane], 0.0f);
    }
    return sum;
}

/* m/s: at which a tangent is drawn back to where it was gripped. */
static float grip_of(const tl_step *step, const tl_pressed *p, uint32_t row) {
    spot s = spot_of(step->h, p);
    float way = s.g->slid[row - p->points][s.lane] + speed_of(tl_row_moved(step->h), p, row);
    return s.g->held[s.lane] * TL_GRIP_SHARE * step->inverse_sub * tl_max(tl_min(way, TL_GRIP_REACH), -TL_GRIP_REACH);
}

/* The speed that a row has to lose. */
static float speed_to_meet(const tl_step *step, const tl_pressed *p, uint32_t row) {
    float speed = speed_of(tl_row_velocity(step->h), p, row);
    return row < p->points ? speed + tl_max(gap_of(step->h, p, row), 0.0f) * step->inverse_sub
                           : speed + grip_of(step, p, row);
}

/* Notes where a round starts from, and which rows hold there: those of points that bear or close, and both tangents'
 * unless they slide. */
static uint32_t look_at(const tl_step *step, tl_pressed *p, int first) {
    spot s = spot_of(step->h, p);
    uint32_t found = 0;
    for (uint32_t row = 0; row < p->points + 2u; row++) {
        p->impulse[row] = *impulse_of(s, p, row);
        p->speed[row] = speed_to_meet(step, p, row);
    }
    if (first) {
        float x = p->impulse[p->points], y = p->impulse[p->points + 1u];
        float most = NEAR_SLIDE * s.g->dynamic_friction[s.lane] * pressure_of(s, p);
        p->slides = !(x * x + y * y < most * most);
        p->barred = 0;
    }
    for (uint32_t row = 0; row < p->points; row++) {
        found |= (uint32_t)(p->impulse[row] > 0.0f || p->speed[row] < -CLOSING) << row;
    }
    return (found & ~p->barred) | (p->slides ? 0u : 3u << p->points);
}

/* Whether a round has anything to do: rows that hold are not met, and, where the last round did what it wanted, others
 * than did hold now. */
static int look(const tl_step *step, tl_press *s, int first, int wanted) {
    int changed = 0, moves = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        uint32_t now = look_at(step, p, first);
        changed |= now != p->holds;
        p->holds = now;
        for (uint32_t row = 0; row < p->points + 2u; row++) {
            moves |= holds(p, row) && !(tl_abs(p->speed[row]) < AT_REST);
        }
    }
    s->stale |= (uint32_t)changed;
    return moves && (changed || !wanted);
}

/* Impulses that would meet the speeds of the rows that hold. */
static void find_changes(const tl_step *step, tl_press *s) {
    const tl_header *h = step->h;
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    float *v = tl_press_values(h) + s->values;
    if (s->stale) {
        factor(h, s);
    }
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        for (uint32_t row = 0; row < node[k].rows; row++) {
            v[node[k].x + row] = holds(p, row) ? -p->speed[row] : 0.0f;
        }
    }
    solve(h, s);
}

/* Goes a share of the way that was found. */
static void go(const tl_step *step, const tl_press *s, float share) {
    const tl_block_node *node = tl_press_nodes(step->h) + s->first;
    const float *v = tl_press_values(step->h) + s->values;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        for (uint32_t row = 0; row < node[k].rows; row++) {
            if (holds(p, row)) {
                add_impulse(step->h, p, row, share * v[node[k].x + row]);
            }
        }
    }
}

/* Changes what was gone since the round began to a share of it. */
static void go_back(const tl_step *step, const tl_press *s, float share) {
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        for (uint32_t row = 0; row < p->points + 2u; row++) {
            float change = *impulse_of(spot_of(step->h, p), p, row) - p->impulse[row];
            add_impulse(step->h, p, row, (share - 1.0f) * change);
        }
    }
}

/* Friction beyond its cone slides on it. */
static int slide(const tl_step *step, tl_pressed *p) {
    spot s = spot_of(step->h, p);
    float x = s.g->tangent_impulse[0][s.lane], y = s.g->tangent_impulse[1][s.lane], pressure = pressure_of(s, p);
    float most = s.g->static_friction[s.lane] * pressure, length = sqrtf(x * x + y * y);
    if (!(length > most)) {
        return 0;
    }
    float share = s.g->dynamic_friction[s.lane] * pressure / length - 1.0f;
    add_impulse(step->h, p, p->points, x * share);
    add_impulse(step->h, p, p->points + 1u, y * share);
    p->slides = 1u;
    return 1;
}

/* What may not pull lets go, and what cannot stick slides. Returns whether there was any such. */
static int let_go(const tl_step *step, const tl_press *s) {
    int any = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        for (uint32_t row = 0; row < p->points; row++) {
            float impulse = *impulse_of(spot_of(step->h, p), p, row);
            if (impulse < 0.0f) {
                add_impulse(step->h, p, row, -impulse);
                any = 1;
            }
        }
        any |= slide(step, p);
    }
    return any;
}

/* What is sought is the least of D = l A l / 2 + b l over impulses l that do not pull and stay in their cones, of which
 * the rows' speeds are the gradient. That set is convex: on the way from the old impulses to the new ones all are in
 * it, and D is least where this share of the way is gone. */
static float best_share(const tl_step *step, const tl_press *s) {
    float slope = 0.0f, bend = 0.0f;
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        for (uint32_t row = 0; row < p->points + 2u; row++) {
            float change = *impulse_of(spot_of(step->h, p), p, row) - p->impulse[row];
            slope += change * p->speed[row];
            bend += change * (speed_to_meet(step, p, row) - p->speed[row]);
        }
    }
    return bend > 0.0f ? tl_max(tl_min(-slope / bend, 1.0f), 0.0f) : 0.0f;
}

/* How far the way that was found can be gone until some point would pull; points that would at once are barred. */
static float free_share(const tl_step *step, const tl_press *s) {
    const tl_block_node *node = tl_press_nodes(step->h) + s->first;
    const float *v = tl_press_values(step->h) + s->values;
    float share = 1.0f;
    for (uint32_t k = 0; k < s->count; k++) {
        tl_pressed *p = &tl_pressed_pool(step->h)[s->first + k];
        for (uint32_t row = 0; row < p->points; row++) {
            float change = v[node[k].x + row];
            if (holds(p, row) && change < 0.0f) {
                p->barred |= p->impulse[row] > 0.0f ? 0u : 1u << row;
                share = tl_min(share, p->impulse[row] / -change);
            }
        }
    }
    return share;
}

/* Back from a way that led astray, and along it again as far as is free. */
static void go_carefully(const tl_step *step, tl_press *s) {
    go_back(step, s, 0.0f);
    go(step, s, free_share(step, s));
    let_go(step, s);
    s->soft = tl_min(s->soft * SOFTER, SOFTEST);
    s->stale = 1u;
}

static void meet_speeds(const tl_step *step, tl_press *s) {
    uint32_t rounds = MOST_LOOKS / s->count;
    rounds = rounds < LEAST_ROUNDS ? LEAST_ROUNDS : rounds > MOST_ROUNDS ? MOST_ROUNDS : rounds;
    int done = 0;
    for (uint32_t round = 0; round < rounds && look(step, s, round == 0, done); round++) {
        find_changes(step, s);
        go(step, s, 1.0f);
        done = !let_go(step, s);
        float share = done ? 1.0f : best_share(step, s);
        if (share < LEAST_SHARE) {
            go_carefully(step, s);
        } else if (share < 1.0f) {
            go_back(step, s, share);
        }
    }
}

void tl_stage_press_velocities(tl_step *step) {
    for (uint32_t i = 0; i < step->h->presses; i++) {
        meet_speeds(step, &tl_presses(step->h)[i]);
    }
}

/* --- errors ------------------------------------------------------------------------------------- */

/* Fills in how far the points that hold are to be parted; returns whether any is. */
static int read_depths(const tl_step *step, const tl_press *s) {
    const tl_header *h = step->h;
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    float *v = tl_press_values(h) + s->values, most = h->settings.push_speed * step->sub;
    float budget = h->settings.error_budget, left = budget > 0.0f ? tl_min(PRESS_DEPTH, 0.5f * budget) : PRESS_DEPTH;
    int any = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + k];
        for (uint32_t row = 0; row < node[k].rows; row++) {
            float depth = 0.0f;
            if (row < p->points && holds(p, row)) {
                depth = -(gap_of(h, p, row) + speed_of(tl_row_push(h), p, row)) - left;
                depth = tl_min(tl_max(depth, 0.0f), most);
            }
            v[node[k].x + row] = depth;
            any |= depth > 0.0f;
        }
    }
    return any;
}

/* m: how far a displacement takes the points of a body, at most. */
static float way_of(const tl_header *h, uint32_t row, const float d[6]) {
    const float *s = tl_row_frame(h)[row].f + 4;
    float reach = row ? tl_body_inertias(h)[tl_awake_body(h)[row - 1u]].reach : 0.0f;
    return sqrtf(dot(d, d)) + sqrtf(dot(d + 3, d + 3)) * tl_max(s[0], tl_max(s[1], s[2])) * reach;
}

typedef struct displacement {
    float d[6];
    uint32_t row;
} displacement;

/* The displacements of a press's bodies, by their numbers as ends. */
static uint32_t sum_displacements(const tl_header *h, const tl_press *s, displacement *of) {
    const tl_block_node *node = tl_press_nodes(h) + s->first;
    const float *v = tl_press_values(h) + s->values;
    uint32_t ends = 0;
    for (uint32_t i = 0; i < 2u * s->count; i++) {
        const tl_pressed *p = &tl_pressed_pool(h)[s->first + i / 2u];
        uint32_t side = i % 2u, end = node[i / 2u].end[side];
        if (end == TL_BLOCK_FREE) {
            continue;
        }
        for (; ends <= end; ends++) {
            memset(&of[ends], 0, sizeof of[ends]);
        }
        of[end].row = p->row[side];
        for (uint32_t row = 0; row < node[i / 2u].rows; row++) {
            float x = v[node[i / 2u].x + row] * (holds(p, row) ? (side ? 1.0f : -1.0f) : 0.0f);
            for (uint32_t k = 0; k < 3u; k++) {
                of[end].d[k] += x * p->mass[side] * direction_of(p, row)[k];
                of[end].d[3u + k] += x * p->turns[side] * p->j[side][row][k];
            }
        }
    }
    return ends;
}

/* Rows that say nearly the same, but not quite, ask for long ways: those are made shorter as a whole. */
void tl_stage_press_errors(tl_step *step) {
    tl_header *h = step->h;
    displacement of[TL_MOST_PRESSED + 1u];
    for (uint32_t i = 0; i < h->presses; i++) {
        tl_press *s = &tl_presses(h)[i];
        if (s->stale || !read_depths(step, s)) {
            continue;
        }
        solve(h, s);
        uint32_t ends = sum_displacements(h, s, of);
        float most = h->settings.push_speed * step->sub, way = most;
        for (uint32_t k = 0; k < ends; k++) {
            way = tl_max(way, way_of(h, of[k].row, of[k].d));
        }
        for (uint32_t k = 0; k < ends; k++) {
            for (uint32_t j = 0; j < 6u; j++) {
                tl_row_push(h)[of[k].row].f[j] += of[k].d[j] * (most / way);
            }
        }
    }
}
