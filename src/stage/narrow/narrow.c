/* Narrow: from pairs of shapes to manifolds. The state of a contact is its manifold with the features that made it, and
 * how far both bodies had gone by then: what moved less than the slack since is not looked at.
 *
 * Whether two shapes begin to touch depends on their poses and velocities alone: a pair that is apart and provably
 * stays so is passed over, a hint may only prove it apart, and what touches is decided without one. New contacts are
 * made in the order of their shapes. So neither trees nor pairs show in the bits, however a world came to its state. */
#include <string.h>

#include "base/prefetch.h"
#include "base/sort.h"
#include "collide/cache.h"
#include "stage/broad/refit.h"
#include "stage/narrow/query.h"
#include "stage/store/lists.h"

/* Whether shapes whose manifold has points may touch within the step as well. */
static int may_touch(tl_step *step, uint32_t shape_a, uint32_t shape_b) {
    tl_header *h = step->h;
    talus_aabb a = tl_shape_swept_box(h, step->geometry, shape_a, step->dt);
    talus_aabb b = tl_shape_swept_box(h, step->geometry, shape_b, step->dt);
    return tl_aabb_overlap(&a, &b) && tl_may_collide(h, shape_a, shape_b); /* a restored joint may forbid it now */
}

/* Whether the shapes touch now or may within the step; else `gap` (m) and `hint` tell how they are apart. */
static int touches(tl_step *step, uint32_t shape_a, uint32_t shape_b, tl_pair_cache *hint, float *gap) {
    tl_header *h = step->h;
    tl_query q = tl_query_of(step, shape_a, shape_b);
    tl_pair_cache cold = {{0, 0, 0, 0}};
    tl_manifold m;
    h->counters.manifolds_made++;
    if (memcmp(hint, &cold, sizeof cold) != 0) {
        tl_collide(&q.a, &q.b, &q.b_in_a, q.margin + tl_doubt_of(h, q.body_a, q.body_b, q.margin), hint, &m);
        *gap = m.gap;
        if (m.count == 0) {
            return 0;
        }
    } else {
        h->counters.manifolds_first++;
    }
    tl_collide(&q.a, &q.b, &q.b_in_a, q.margin, &cold, &m);
    *hint = cold;
    *gap = m.count ? 0.0f : m.gap;
    return m.count > 0 && may_touch(step, shape_a, shape_b);
}

/* Micrometres that each awake body may go in the step; doubts stay. */
static void measure_ways(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t body = tl_awake_body(h)[k];
        float way = tl_length(tl_row_xyz(&tl_body_velocity(h)[body])) * step->dt;
        uint32_t most = way > 0.0f ? 1u + (uint32_t)tl_min(way * 1.001e6f, 1e9f) : 0u;
        tl_body_way(h)[body] = most | (tl_body_way(h)[body] & TL_WAY_DOUBTED);
    }
}

/* The touches of one step that have no contact yet, smallest first when there are more than there is room for. */
typedef struct new_touches {
    uint32_t count, room, seen;
} new_touches;

static void offer(tl_header *h, new_touches *found, uint32_t shape_a, uint32_t shape_b) {
    found->count = tl_heap_offer(tl_new_touch(h), found->count, found->room, (uint64_t)shape_a << 32 | shape_b);
    found->seen++;
}

static int fat_boxes_part(const tl_header *h, const tl_pair *p) {
    return !tl_aabb_overlap(&tl_shape_tracks(h)[p->shape_a].fat, &tl_shape_tracks(h)[p->shape_b].fat);
}

/* A pair that was looked at is looked at again when it moved more than it is clear. */
static void note_looked(tl_step *step, new_touches *found, uint32_t pair, int touch, float gap) {
    tl_header *h = step->h;
    const uint32_t *motion = tl_body_motion(h);
    tl_pair *p = &tl_pairs(h)[pair];
    if (touch) {
        offer(h, found, p->shape_a, p->shape_b);
    }
    p->motion = motion[p->body_a] + motion[p->body_b];
    p->clear = tl_clear_of(h, p->body_a, p->body_b, gap);
}

static void look_at_pair(tl_step *step, new_touches *found, uint32_t pair) {
    const tl_pair *p = &tl_pairs(step->h)[pair];
    float gap;
    int touch = touches(step, p->shape_a, p->shape_b, &tl_pair_hints(step->h)[pair], &gap);
    note_looked(step, found, pair, touch, gap);
}

/* What a batch of pairs tells of lane k: whether it is decided there, and whether there are points, else the gap (m).
 */
static void note_lane(tl_step *step, new_touches *found, const tl_pair_batch *batch, uint32_t k, uint32_t decided,
                      int points, float gap) {
    tl_header *h = step->h;
    tl_pair_cache *hint = &tl_pair_hints(h)[batch->item[k]];
    if (!decided) {
        look_at_pair(step, found, batch->item[k]);
        return;
    }
    int touch = points && may_touch(step, batch->shape_a[k], batch->shape_b[k]);
    h->counters.manifolds_made++;
    h->counters.manifolds_first += hint->word[0] == 0u;
    hint->word[0] = hint->word[0] ? hint->word[0] : TL_CACHE_LOOKED;
    note_looked(step, found, batch->item[k], touch, points ? 0.0f : gap);
}

static void look_at_batch(tl_step *step, new_touches *found, tl_pair_batch *batch) {
    const tl_kernels *kernels = tl_kernels_of((talus_isa)step->h->isa);
    if (batch->count == 0) {
        return;
    }
    tl_batch_fill(batch);
    if (batch->kind == TL_BATCH_BOXES) {
        tl_box_manifolds out;
        kernels->collide_boxes(step, batch, &out);
        for (uint32_t k = 0; k < batch->count; k++) {
            note_lane(step, found, batch, k, out.decided >> k & 1u, out.count[k] > 0.0f, out.gap[k]);
        }
    } else {
        tl_one_points out;
        (batch->kind == TL_BATCH_CAPSULES ? kernels->collide_capsules : kernels->collide_balls)(step, batch, &out);
        for (uint32_t k = 0; k < batch->count; k++) {
            note_lane(step, found, batch, k, out.decided >> k & 1u, out.gap[k] <= out.margin[k], out.gap[k]);
        }
    }
    tl_batch_clear(batch);
}

#define PAIRS_AHEAD 12u

static void look_at_pairs(tl_step *step, new_touches *found) {
    tl_header *h = step->h;
    const uint32_t *motion = tl_body_motion(h), *way = tl_body_way(h);
    tl_pair_batch batches[TL_BATCH_KINDS];
    tl_batches_begin(batches, 0);
    for (uint32_t k = 0; k < h->awake_pairs;) {
        uint32_t i = tl_awake_pair(h)[k];
        const tl_pair *p = &tl_pairs(h)[i];
        if (k + PAIRS_AHEAD < h->awake_pairs) { /* they lie in no order, and waiting for them is most of the work */
            tl_prefetch(&tl_pairs(h)[tl_awake_pair(h)[k + PAIRS_AHEAD]]);
        }
        uint32_t now = motion[p->body_a] + motion[p->body_b];
        uint64_t moved = (uint64_t)(now - p->motion) + way[p->body_a] + way[p->body_b];
        k++;
        if (p->contact != TL_NONE || moved < p->clear) {
            h->counters.manifolds_kept += p->contact == TL_NONE;
            continue;
        }
        if (fat_boxes_part(h, p)) {
            tl_pair_end(h, i);
            h->counters.pairs_ended++;
            k--; /* another pair stands here now */
            continue;
        }
        float gap;
        tl_batch_kind kind = tl_batch_kind_of(h, p->shape_a, p->shape_b);
        if (tl_parted_by_balls(step, p->body_a, p->body_b, &gap)) {
            note_looked(step, found, i, 0, gap);
        } else if (kind == TL_BATCH_OTHER) {
            look_at_pair(step, found, i);
        } else if (tl_batch_add(h, &batches[kind], i, p->shape_a, p->shape_b)) {
            look_at_batch(step, found, &batches[kind]);
        }
    }
    for (uint32_t kind = 0; kind < TL_BATCH_OTHER; kind++) {
        look_at_batch(step, found, &batches[kind]);
    }
    for (uint32_t k = 0; h->doubted && k < h->awake_bodies; k++) {
        tl_body_way(h)[tl_awake_body(h)[k]] &= ~TL_WAY_DOUBTED;
    }
    h->doubted = 0;
}

/* What there was no room to pair is looked for in the trees. */
static void look_around(tl_step *step, uint32_t shape, new_touches *found) {
    tl_header *h = step->h;
    const tl_shape_track *t = &tl_shape_tracks(h)[shape];
    const uint32_t *rows = tl_body_row(h);
    tl_tree_walk walk;
    for (int tree = 0; tree < (t->still ? 1 : 2); tree++) {
        tl_tree_begin(&walk, h, tree, &t->fat);
        for (uint32_t other = tl_tree_next(&walk, h); other != TL_NONE; other = tl_tree_next(&walk, h)) {
            uint32_t a = shape < other ? shape : other, b = shape < other ? other : shape;
            uint32_t before = tl_shape_tracks(h)[other].moved;
            int seen = before && before < t->moved; /* it looked around itself and saw this one */
            int awake = rows[tl_shapes(h)[a].body] || rows[tl_shapes(h)[b].body];
            tl_pair_cache hint = {{0, 0, 0, 0}};
            float gap;
            if (awake && !seen && tl_may_collide(h, a, b) && tl_pair_find(h, a, b) == TL_NONE &&
                !tl_parted_by_balls(step, tl_shapes(h)[a].body, tl_shapes(h)[b].body, &gap) &&
                touches(step, a, b, &hint, &gap)) {
                offer(h, found, a, b);
            }
        }
    }
}

static void begin_touch(tl_step *step, uint32_t shape_a, uint32_t shape_b) {
    tl_header *h = step->h;
    uint32_t c = tl_contact_make(h, shape_a, shape_b);
    tl_contact_meta *meta = &tl_contacts(h)[c];
    tl_contact_make_manifold(step, c);
    h->counters.touches_begun++;
    if (!(meta->flags & TL_CONTACT_SENSOR)) {
        meta->flags |= TL_CONTACT_COLORED;
        meta->color = tl_color_take(h, meta->body_a, meta->body_b);
        tl_island_wake(h, meta->body_a);
        tl_island_wake(h, meta->body_b);
    }
}

void tl_stage_narrow(tl_step *step) {
    tl_header *h = step->h;
    talus_counters *n = &h->counters;
    n->manifolds_made = n->manifolds_first = n->manifolds_kept = n->pairs_ended = 0;
    n->contacts_touching = n->contact_points = n->touches_begun = n->touches_ended = 0;
    measure_ways(step);
    tl_contacts_update(step);
    new_touches found = {0, h->capacity[TL_COUNT_CONTACT] - h->contacts.used, 0};
    look_at_pairs(step, &found);
    for (uint32_t k = 0; k < h->moved_shapes; k++) {
        look_around(step, tl_moved_shape(h)[k], &found);
    }
    n->contacts.dropped = found.seen - found.count;
    tl_sort_keys(tl_new_touch(h), found.count);
    for (uint32_t k = 0; k < found.count; k++) {
        uint64_t key = tl_new_touch(h)[k];
        begin_touch(step, (uint32_t)(key >> 32), (uint32_t)key);
    }
    tl_lists_of_awake(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) { /* of islands that new touches woke */
        if (tl_contacts(h)[tl_awake_contact(h)[k]].flags & TL_CONTACT_FRESH) {
            tl_contact_update(step, tl_awake_contact(h)[k]);
        }
    }
    tl_lists_of_awake(h);
    n->contacts_sleeping = h->contacts.used - h->awake_contacts;
}
