/* Narrow: from pairs of shapes to manifolds. The state of a contact is its manifold with the features that made it, and
 * how far both bodies had gone by then: what moved less than the slack since is not looked at.
 *
 * Whether two shapes begin to touch depends on their poses and velocities alone: a pair that is apart and provably
 * stays so is passed over, a hint may only prove it apart, and what touches is decided without one. New contacts are
 * made in the order of their shapes. So neither trees nor pairs show in the bits, however a world came to its state. */
#include <string.h>

#include "base/sort.h"
#include "stage/broad/refit.h"
#include "stage/stages.h"
#include "stage/store/lists.h"

/* The impulses of a manifold before it is made anew. */
typedef struct old_points {
    uint32_t count, id[TL_MANIFOLD_POINTS];
    float impulse[TL_MANIFOLD_POINTS];
} old_points;

static void keep_old(const tl_contact_points *points, uint32_t count, old_points *old) {
    old->count = count;
    for (uint32_t i = 0; i < count; i++) {
        old->id[i] = points->p[i].id;
        old->impulse[i] = points->p[i].impulse;
    }
}

static float impulse_of(const old_points *old, uint32_t id) {
    for (uint32_t i = 0; i < old->count; i++) {
        if (old->id[i] == id) {
            return old->impulse[i];
        }
    }
    return 0.0f;
}

/* Puts a manifold, given in shape a's frame, into the bodies' mass frames; pa and pb are the shapes in the world. */
static void store_manifold(tl_header *h, uint32_t c, const tl_manifold *m, const talus_pose *b_in_a,
                           const talus_pose *pa, const talus_pose *pb) {
    tl_contact_meta *meta = &tl_contacts(h)[c];
    tl_contact_head *head = &tl_heads(h)[c];
    tl_contact_points *points = &tl_points(h)[c];
    old_points old;
    talus_pose place_a = tl_body_is_fixed(h, meta->body_a) ? *pa : tl_row_pose_of(&tl_shape_place(h)[meta->shape_a]);
    talus_pose place_b = tl_body_is_fixed(h, meta->body_b) ? *pb : tl_row_pose_of(&tl_shape_place(h)[meta->shape_b]);
    keep_old(points, meta->count, &old);
    for (uint32_t i = 0; i < m->count; i++) {
        const tl_manifold_point *p = &m->point[i];
        talus_vec3 half = tl_scale(m->normal, 0.5f * p->separation);
        talus_vec3 a = tl_pose_point(&place_a, tl_sub(p->position, half));
        talus_vec3 b = tl_pose_point(&place_b, tl_pose_point_back(b_in_a, tl_add(p->position, half)));
        tl_contact_point_record *r = &points->p[i];
        r->a[0] = a.x, r->a[1] = a.y, r->a[2] = a.z;
        r->b[0] = b.x, r->b[1] = b.y, r->b[2] = b.z;
        r->id = p->id;
        r->impulse = impulse_of(&old, p->id);
    }
    if (m->count < old.count) {
        memset(&points->p[m->count], 0, (old.count - m->count) * sizeof points->p[0]);
    }
    talus_vec3 n = tl_rotate(place_a.rotation, m->normal);
    head->normal[0] = n.x, head->normal[1] = n.y, head->normal[2] = n.z;
    meta->count = m->count;
}

/* m: how far apart the margins say that nothing is to be done. */
static float margin_of(const tl_step *step, uint32_t body_a, uint32_t body_b) {
    const tl_row8 *v = tl_body_velocity(step->h);
    float speed = tl_length(tl_sub(tl_row_xyz(&v[body_a]), tl_row_xyz(&v[body_b])));
    return step->h->settings.speculative_margin + tl_min(speed, 1e6f) * step->dt;
}

/* Two shapes as the pair queries take them. */
typedef struct query {
    uint32_t shape_a, shape_b, body_a, body_b;
    tl_convex a, b;
    talus_pose pa, pb, b_in_a;
    float margin; /* m */
} query;

static query query_of(const tl_step *step, uint32_t shape_a, uint32_t shape_b) {
    tl_header *h = step->h;
    query q;
    q.shape_a = shape_a, q.shape_b = shape_b;
    q.body_a = tl_shapes(h)[shape_a].body, q.body_b = tl_shapes(h)[shape_b].body;
    q.a = tl_shape_convex(h, step->geometry, shape_a), q.b = tl_shape_convex(h, step->geometry, shape_b);
    q.pa = tl_shape_world_pose(h, shape_a), q.pb = tl_shape_world_pose(h, shape_b);
    q.b_in_a = tl_pose_relative(&q.pa, &q.pb);
    q.b_in_a.rotation = tl_quat_normalize(q.b_in_a.rotation);
    int senses = ((tl_shapes(h)[shape_a].flags | tl_shapes(h)[shape_b].flags) & TL_SHAPE_SENSOR) != 0;
    q.margin = senses ? 0.0f : margin_of(step, q.body_a, q.body_b);
    return q;
}

/* Whether the balls around two bodies' mass centres tell already that they do not touch, being *gap (m) apart. */
static int parted_by_balls(const tl_step *step, uint32_t body_a, uint32_t body_b, float *gap) {
    const tl_header *h = step->h;
    if (!tl_body_is_dynamic(h, body_a) || !tl_body_is_dynamic(h, body_b)) {
        return 0; /* what is not dynamic tends to be large */
    }
    const tl_row8 *a = &tl_body_pose(h)[body_a], *b = &tl_body_pose(h)[body_b];
    const tl_body_inertia *in = tl_body_inertias(h);
    *gap = tl_length(tl_sub(tl_row_xyz(b), tl_row_xyz(a))) - in[body_a].reach - in[body_b].reach;
    return *gap > 0.0f && *gap > margin_of(step, body_a, body_b);
}

/* m: what rounding may make of a distance between two shapes, many times over. */
static float doubt_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float margin) {
    const tl_body_inertia *in = tl_body_inertias(h);
    return 1e-5f + 1e-3f * margin + 1e-5f * (in[body_a].reach + in[body_b].reach);
}

/* tl_pair.clear of shapes that are at least `gap` (m) apart. */
static uint32_t clear_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float gap) {
    float margin = h->settings.speculative_margin;
    float free = gap - margin - doubt_of(h, body_a, body_b, margin);
    return free > 0.0f ? (uint32_t)tl_min(free * 1e6f, 1e9f) : 0u;
}

/* --- contacts --------------------------------------------------------------------------------- */

static void end_touch(tl_header *h, uint32_t c, float gap) {
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    uint32_t clear = clear_of(h, meta->body_a, meta->body_b, gap);
    h->counters.touches_ended++;
    tl_event_contact_end(h, c);
    tl_contact_end(h, c, clear);
}

static void make_manifold(tl_step *step, uint32_t c) {
    tl_header *h = step->h;
    tl_contact_meta *meta = &tl_contacts(h)[c];
    query q = query_of(step, meta->shape_a, meta->shape_b);
    tl_manifold m;
    tl_collide(&q.a, &q.b, &q.b_in_a, q.margin, &tl_contact_caches(h)[c], &m);
    h->counters.manifolds_made++;
    if (m.count == 0) {
        end_touch(h, c, m.gap);
        return;
    }
    store_manifold(h, c, &m, &q.b_in_a, &q.pa, &q.pb);
    meta->motion = tl_body_motion(h)[meta->body_a] + tl_body_motion(h)[meta->body_b];
    meta->flags &= ~(uint32_t)TL_CONTACT_FRESH;
}

static void update_contact(tl_step *step, uint32_t c) {
    tl_header *h = step->h;
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    float gap;
    if (parted_by_balls(step, meta->body_a, meta->body_b, &gap)) {
        end_touch(h, c, gap);
    } else {
        make_manifold(step, c);
    }
}

/* Micrometres that a contact may move before its manifold is made anew: between half of the slack and the whole, by a
 * hash of the contact, so that those of a pile which came to rest together do not all come due in the same step. */
static uint32_t slack_of(uint32_t contact, const tl_contact_meta *meta, uint32_t slack) {
    uint64_t part = contact * 0x9e3779b1u >> 24; /* of 512 */
    return meta->flags & TL_CONTACT_SENSOR ? 0u : slack - (uint32_t)(slack * part >> 9);
}

static void update_contacts(tl_step *step) {
    tl_header *h = step->h;
    const uint32_t *motion = tl_body_motion(h);
    uint32_t slack = (uint32_t)(h->settings.recycle_slack * 1e6f);
    tl_lists_of_awake(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        uint32_t c = tl_awake_contact(h)[k];
        const tl_contact_meta *meta = &tl_contacts(h)[c];
        uint32_t moved = motion[meta->body_a] + motion[meta->body_b] - meta->motion;
        if (moved <= slack_of(c, meta, slack) && !(meta->flags & TL_CONTACT_FRESH)) {
            h->counters.manifolds_kept++;
        } else {
            update_contact(step, c);
        }
    }
}

/* --- pairs that are apart --------------------------------------------------------------------- */

/* Whether the shapes touch now or may within the step; else `gap` (m) and `hint` tell how they are apart. */
static int touches(tl_step *step, uint32_t shape_a, uint32_t shape_b, tl_pair_cache *hint, float *gap) {
    tl_header *h = step->h;
    uint32_t body_a = tl_shapes(h)[shape_a].body, body_b = tl_shapes(h)[shape_b].body;
    if (parted_by_balls(step, body_a, body_b, gap)) {
        return 0;
    }
    query q = query_of(step, shape_a, shape_b);
    tl_pair_cache cold = {{0, 0, 0, 0}};
    tl_manifold m;
    h->counters.manifolds_made++;
    if (memcmp(hint, &cold, sizeof cold) != 0) {
        tl_collide(&q.a, &q.b, &q.b_in_a, q.margin + doubt_of(h, body_a, body_b, q.margin), hint, &m);
        *gap = m.gap;
        if (m.count == 0) {
            return 0;
        }
    } else {
        h->counters.manifolds_first++;
    }
    tl_collide(&q.a, &q.b, &q.b_in_a, q.margin, &cold, &m);
    *hint = cold;
    *gap = m.gap;
    if (m.count == 0) {
        return 0;
    }
    talus_aabb a = tl_shape_swept_box(h, step->geometry, shape_a, step->dt);
    talus_aabb b = tl_shape_swept_box(h, step->geometry, shape_b, step->dt);
    *gap = 0.0f;
    return tl_aabb_overlap(&a, &b) && tl_may_collide(h, shape_a, shape_b); /* a restored joint may forbid it now */
}

/* Micrometres that each awake body may go in the step. */
static void measure_ways(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t body = tl_awake_body(h)[k];
        float way = tl_length(tl_row_xyz(&tl_body_velocity(h)[body])) * step->dt;
        tl_body_way(h)[body] = way > 0.0f ? 1u + (uint32_t)tl_min(way * 1.001e6f, 1e9f) : 0u;
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

static void look_at_pairs(tl_step *step, new_touches *found) {
    tl_header *h = step->h;
    const uint32_t *motion = tl_body_motion(h), *way = tl_body_way(h), doubted = h->pairs_doubted;
    for (uint32_t k = 0; k < h->awake_pairs;) {
        uint32_t i = tl_awake_pair(h)[k];
        tl_pair *p = &tl_pairs(h)[i];
        uint32_t now = motion[p->body_a] + motion[p->body_b];
        k++;
        if (p->contact != TL_NONE || (now - p->motion + way[p->body_a] + way[p->body_b] < p->clear && !doubted)) {
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
        if (touches(step, p->shape_a, p->shape_b, &tl_pair_hints(h)[i], &gap)) {
            offer(h, found, p->shape_a, p->shape_b);
        }
        p->motion = now;
        p->clear = clear_of(h, p->body_a, p->body_b, gap);
    }
    h->pairs_doubted = 0;
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
    make_manifold(step, c);
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
    update_contacts(step);
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
            update_contact(step, tl_awake_contact(h)[k]);
        }
    }
    tl_lists_of_awake(h);
    n->contacts_sleeping = h->contacts.used - h->awake_contacts;
}
