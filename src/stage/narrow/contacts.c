/* Contacts: their manifolds are made anew where they moved more than the slack. */
#include <string.h>

#include "base/prefetch.h"
#include "base/sort.h"
#include "base/spread.h"
#include "stage/broad/refit.h"
#include "stage/narrow/batch.h"
#include "stage/narrow/query.h"
#include "stage/store/lists.h"

/* A manifold before it is made anew. */
typedef struct old_points {
    uint32_t count;
    tl_contact_points of;
    talus_vec3 normal; /* in a's mass frame, as the points are */
} old_points;

static talus_vec3 normal_of(const tl_header *h, uint32_t c) {
    const float *n = tl_heads(h)[c].normal;
    return tl_v(n[0], n[1], n[2]);
}

static void keep_old(const tl_header *h, uint32_t c, old_points *old) {
    old->count = tl_contacts(h)[c].count;
    old->of = tl_points(h)[c];
    old->normal = normal_of(h, c);
}

static float impulse_of(const old_points *old, uint32_t id) {
    for (uint32_t i = 0; i < old->count; i++) {
        if (old->of.p[i].id == id) {
            return old->of.p[i].impulse;
        }
    }
    return 0.0f;
}

static int has_id(const tl_contact_points *points, uint32_t count, uint32_t id) {
    for (uint32_t k = 0; k < count; k++) {
        if (points->p[k].id == id) {
            return 1;
        }
    }
    return 0;
}

static talus_vec3 place_on_a(const tl_contact_point_record *r) { return tl_v(r->a[0], r->a[1], r->a[2]); }

/* The mass frames of a contact's bodies in the world, and its normal there. */
typedef struct contact_frames {
    talus_pose a, b;
    talus_vec3 normal;
} contact_frames;

static talus_pose mass_frame(const tl_header *h, uint32_t body) {
    talus_pose world = {{0.0f, 0.0f, 0.0f}, tl_quat_identity()};
    return tl_body_is_fixed(h, body) ? world : tl_row_pose_of(&tl_body_pose(h)[body]);
}

static contact_frames frames_of(const tl_header *h, uint32_t c) {
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    contact_frames f = {mass_frame(h, meta->body_a), mass_frame(h, meta->body_b), tl_v(0.0f, 0.0f, 0.0f)};
    f.normal = tl_rotate(f.a.rotation, normal_of(h, c));
    return f;
}

/* From a point's place on a to the one on b, in the world. */
static talus_vec3 way_of(const contact_frames *f, const tl_contact_point_record *r) {
    talus_vec3 a = tl_rotate(f->a.rotation, place_on_a(r));
    talus_vec3 b = tl_rotate(f->b.rotation, tl_v(r->b[0], r->b[1], r->b[2]));
    return tl_add(tl_sub(f->b.position, f->a.position), tl_sub(b, a));
}

/* Which points of two polyhedra make their manifold is a choice: either of two faces all but flush may be the
 * reference, four are taken of more corners, and a corner of three faces lies on one of them at a time. A point that is
 * left out bears nothing any more, the body sinks there until the next manifold has it again and leaves out another,
 * and so bodies shake with every step, and the pile with them. Hence a point stays while its surfaces overlap or are
 * nearer than the slack and have not slid by more than that, beside the others or in place of one that bears nothing
 * and is farther apart. Returns how many points there are then. */
static uint32_t keep_point(tl_header *h, uint32_t c, const old_points *old, uint32_t i, uint32_t count) {
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    const talus_geometry *shapes = tl_shape_geometry(h);
    tl_contact_points *points = &tl_points(h)[c];
    if (shapes[meta->shape_a].type < TALUS_BOX || shapes[meta->shape_b].type < TALUS_BOX) {
        return count;
    }
    contact_frames f = frames_of(h, c);
    talus_vec3 way = way_of(&f, &old->of.p[i]);
    float gap = tl_dot(f.normal, way), slack = h->settings.recycle_slack, most = gap;
    talus_vec3 slid = tl_mad(way, -gap, f.normal);
    if (gap > slack || tl_dot(slid, slid) > slack * slack) {
        return count;
    }
    uint32_t at = TL_NONE;
    for (uint32_t k = 0; k < count; k++) {
        float apart = tl_dot(f.normal, way_of(&f, &points->p[k]));
        if (points->p[k].impulse == 0.0f && apart > most) {
            most = apart;
            at = k;
        }
    }
    at = count < TL_MANIFOLD_POINTS ? count++ : at;
    if (at != TL_NONE) {
        points->p[at] = old->of.p[i];
    }
    return count;
}

#define FACE_POINTS 3u
#define FLAT 1e-3f /* of points nearly on a line nothing is known across it */

/* Of the many points of two faces on each other four are kept, and not always the same. What those bore that are gone
 * is handed on to all that are there now, with the same sum and the same moments: x / n + M^-1 d, where d are places
 * from the middle and M the sum of d d^T. n is the normal in the frame of the points. */
static void hand_on(const old_points *old, tl_contact_points *points, uint32_t count, talus_vec3 n) {
    talus_vec3 moment = tl_v(0.0f, 0.0f, 0.0f), at[TL_MANIFOLD_POINTS];
    float lost = 0.0f, share = 1.0f / (float)count;
    for (uint32_t i = 0; i < old->count; i++) {
        if (old->of.p[i].impulse > 0.0f && !has_id(points, count, old->of.p[i].id)) {
            lost += old->of.p[i].impulse;
            moment = tl_mad(moment, old->of.p[i].impulse, place_on_a(&old->of.p[i]));
        }
    }
    if (!(lost > 0.0f) || old->count < FACE_POINTS || count < FACE_POINTS) {
        return;
    }
    for (uint32_t k = 0; k < count; k++) {
        at[k] = place_on_a(&points->p[k]);
    }
    tl_spread s = tl_spread_of(at, count, n);
    talus_vec3 off = tl_mad(moment, -lost, s.mean);
    float mx = tl_dot(off, s.u), my = tl_dot(off, s.v), det = s.xx * s.yy - s.xy * s.xy, both = s.xx + s.yy;
    float inverse = det > FLAT * both * both ? 1.0f / det : 0.0f, before = lost, after = 0.0f;
    float gx = inverse * (s.yy * mx - s.xy * my), gy = inverse * (s.xx * my - s.xy * mx);
    for (uint32_t k = 0; k < count; k++) {
        float *impulse = &points->p[k].impulse;
        before += *impulse;
        *impulse = tl_max(*impulse + share * lost + s.x[k] * gx + s.y[k] * gy, 0.0f);
        after += *impulse;
    }
    float scale = after < 3e38f ? before / after : 0.0f; /* what would have to pull does not, and the sum is the same */
    for (uint32_t k = 0; k < count; k++) {
        points->p[k].impulse *= scale;
    }
}

#define SAME_PLACE 0.1f    /* of the speculative margin */
#define SAME_NORMAL 0.985f /* the cosine of 10 degrees */

/* Whether a point of a manifold lies where another one does. */
static int has_place(const tl_header *h, const tl_contact_points *points, uint32_t count,
                     const tl_contact_point_record *r) {
    float reach = SAME_PLACE * h->settings.speculative_margin;
    for (uint32_t k = 0; k < count; k++) {
        talus_vec3 way = tl_sub(place_on_a(&points->p[k]), place_on_a(r));
        if (tl_dot(way, way) < reach * reach) {
            return 1;
        }
    }
    return 0;
}

/* What becomes of the points that a new manifold of `count` points does not have: they stay, or what they bore is
 * handed on, unless the way out is another. Returns how many points there are then. */
static uint32_t carry_over(tl_header *h, uint32_t c, const old_points *old, uint32_t count) {
    tl_contact_points *points = &tl_points(h)[c];
    talus_vec3 n = normal_of(h, c);
    if (tl_dot(old->normal, n) < SAME_NORMAL) {
        return count;
    }
    for (uint32_t i = 0; i < old->count; i++) {
        if (!has_id(points, count, old->of.p[i].id) && !has_place(h, points, count, &old->of.p[i])) {
            count = keep_point(h, c, old, i, count);
        }
    }
    hand_on(old, points, count, n);
    return count;
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
    keep_old(h, c, &old);
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
    meta->count = carry_over(h, c, &old, m->count);
}

static void kept_until_moved(tl_header *h, tl_contact_meta *meta) {
    h->counters.manifolds_made++;
    meta->motion = tl_body_motion(h)[meta->body_a] + tl_body_motion(h)[meta->body_b];
    meta->flags &= ~(uint32_t)TL_CONTACT_FRESH;
}

static void end_touch(tl_header *h, uint32_t c, float gap) {
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    uint32_t clear = tl_clear_of(h, meta->body_a, meta->body_b, gap);
    h->counters.touches_ended++;
    tl_event_contact_end(h, c);
    tl_contact_end(h, c, clear);
}

/* With the points that it has, if those will do. */
static void stay(const tl_header *h, uint32_t c, tl_manifold *m) {
    uint32_t id[TL_MANIFOLD_POINTS], count = tl_contacts(h)[c].count;
    for (uint32_t i = 0; i < count; i++) {
        id[i] = tl_points(h)[c].p[i].id;
    }
    (void)tl_manifold_stay(m, id, count);
}

/* Makes a manifold; 0 if the shapes do not touch, being *gap apart. */
static int make_manifold(tl_step *step, uint32_t c, const tl_query *q, float *gap) {
    tl_header *h = step->h;
    tl_manifold m;
    tl_collide(&q->a, &q->b, &q->b_in_a, q->margin, &tl_contact_caches(h)[c], &m);
    *gap = m.gap;
    if (m.count == 0) {
        h->counters.manifolds_made++;
        return 0;
    }
    stay(h, c, &m);
    store_manifold(h, c, &m, &q->b_in_a, &q->pa, &q->pb);
    kept_until_moved(h, &tl_contacts(h)[c]);
    return 1;
}

void tl_contact_make_manifold(tl_step *step, uint32_t c) {
    const tl_contact_meta *meta = &tl_contacts(step->h)[c];
    tl_query q = tl_query_of(step, meta->shape_a, meta->shape_b);
    float gap;
    if (!make_manifold(step, c, &q, &gap)) {
        end_touch(step->h, c, gap);
    }
}

void tl_contact_update(tl_step *step, uint32_t c) {
    const tl_contact_meta *meta = &tl_contacts(step->h)[c];
    float gap;
    if (tl_parted_by_balls(step, meta->body_a, meta->body_b, &gap)) {
        end_touch(step->h, c, gap);
    } else {
        tl_contact_make_manifold(step, c);
    }
}

/* --- eight at a time -------------------------------------------------------------------------- */

/* Those that ended, to be told of in their order: the contact and the bits of the gap. */
typedef struct ended {
    uint64_t *keys;
    uint32_t count;
} ended;

static void note_ended(ended *e, uint32_t c, float gap) {
    uint32_t bits;
    memcpy(&bits, &gap, sizeof bits);
    e->keys[e->count++] = (uint64_t)c << 32 | bits;
}

static void store_one_points(tl_step *step, const tl_pair_batch *batch, const tl_one_points *out, ended *e) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < batch->count; k++) {
        uint32_t c = batch->item[k];
        if (!(out->decided >> k & 1u)) {
            continue;
        }
        if (!(out->gap[k] <= out->margin[k])) {
            h->counters.manifolds_made++;
            note_ended(e, c, out->gap[k]);
            continue;
        }
        tl_contact_points *points = &tl_points(h)[c];
        /* an only point has the number 0 and keeps its impulse */
        if (tl_contacts(h)[c].count != 1 || points->p[0].id != 0) {
            memset(points, 0, sizeof *points);
        }
        memcpy(points->p[0].a, out->point[k].f, 6u * sizeof(float));
        memcpy(tl_heads(h)[c].normal, out->normal[k].f, 3u * sizeof(float));
        tl_contacts(h)[c].count = 1;
        kept_until_moved(h, &tl_contacts(h)[c]);
    }
}

/* They are needed when the batch is full. */
static void prefetch_points(const tl_header *h, uint32_t c) {
    tl_prefetch(&tl_points(h)[c].p[0]);
    tl_prefetch(&tl_points(h)[c].p[2]);
    tl_prefetch(&tl_heads(h)[c]);
}

/* Those lanes of a batch, whose shapes are placed, that are not done. */
static void make_one_by_one(tl_step *step, const tl_pair_batch *batch, uint32_t done, ended *e) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < batch->count; k++) {
        if (done >> k & 1u) {
            continue;
        }
        tl_query q;
        q.shape_a = batch->shape_a[k], q.shape_b = batch->shape_b[k];
        q.body_a = batch->body_a[k], q.body_b = batch->body_b[k];
        q.a = tl_shape_convex(h, step->geometry, q.shape_a), q.b = tl_shape_convex(h, step->geometry, q.shape_b);
        q.pa = tl_row_pose_of(&batch->a[k]), q.pb = tl_row_pose_of(&batch->b[k]);
        q.b_in_a = tl_row_pose_of(&batch->b_in_a[k]);
        q.margin = batch->margin[k];
        float gap;
        if (!make_manifold(step, batch->item[k], &q, &gap)) {
            note_ended(e, batch->item[k], gap);
        }
    }
}

static void store_boxes(tl_step *step, const tl_pair_batch *batch, const tl_box_manifolds *out, ended *e) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < batch->count; k++) {
        uint32_t c = batch->item[k], count = (uint32_t)out->count[k];
        if (!(out->decided >> k & 1u)) {
            continue;
        }
        if (count == 0) {
            h->counters.manifolds_made++;
            note_ended(e, c, out->gap[k]);
            continue;
        }
        old_points old;
        keep_old(h, c, &old);
        for (uint32_t i = 0; i < TL_MANIFOLD_POINTS; i++) {
            memcpy(&tl_points(h)[c].p[i], &out->point[i][k], sizeof out->point[i][k]);
        }
        memcpy(tl_heads(h)[c].normal, out->normal[k].f, 3u * sizeof(float));
        tl_contacts(h)[c].count = carry_over(h, c, &old, count);
        kept_until_moved(h, &tl_contacts(h)[c]);
    }
}

static void run_batch(tl_step *step, tl_pair_batch *batch, ended *e) {
    const tl_kernels *kernels = tl_kernels_of((talus_isa)step->h->isa);
    if (batch->count == 0) {
        return;
    }
    tl_batch_fill(batch);
    uint32_t decided = 0;
    if (batch->kind == TL_BATCH_BOXES) {
        tl_box_manifolds out;
        kernels->collide_boxes(step, batch, &out);
        store_boxes(step, batch, &out, e);
        decided = out.decided;
    } else if (batch->kind != TL_BATCH_OTHER) {
        tl_one_points out;
        (batch->kind == TL_BATCH_CAPSULES ? kernels->collide_capsules : kernels->collide_balls)(step, batch, &out);
        store_one_points(step, batch, &out, e);
        decided = out.decided;
    }
    if (~decided & ((1u << batch->count) - 1u)) {
        kernels->place_pairs(step, batch);
        make_one_by_one(step, batch, decided, e);
    }
    tl_batch_clear(batch);
}

/* Micrometres that a contact may move before its manifold is made anew: between half of the slack and the whole, by a
 * hash of the contact, so that those of a pile which came to rest together do not all come due in the same step. */
static uint32_t slack_of(uint32_t contact, const tl_contact_meta *meta, uint32_t slack) {
    uint64_t part = contact * 0x9e3779b1u >> 24; /* of 512 */
    return meta->flags & TL_CONTACT_SENSOR ? 0u : slack - (uint32_t)(slack * part >> 9);
}

static void update_contact(tl_step *step, tl_pair_batch *batches, uint32_t c, ended *e) {
    tl_header *h = step->h;
    const tl_contact_meta *meta = &tl_contacts(h)[c];
    tl_pair_batch *batch = &batches[tl_batch_kind_of(h, meta->shape_a, meta->shape_b)];
    float gap;
    if (batch->kind == TL_BATCH_OTHER && tl_parted_by_balls(step, meta->body_a, meta->body_b, &gap)) {
        note_ended(e, c, gap); /* in lanes the query itself costs no more */
    } else if (tl_batch_add(h, batch, c, meta->shape_a, meta->shape_b)) {
        run_batch(step, batch, e);
    } else {
        prefetch_points(h, c);
    }
}

void tl_contacts_update(tl_step *step) {
    tl_header *h = step->h;
    const uint32_t *motion = tl_body_motion(h);
    uint32_t slack = (uint32_t)(h->settings.recycle_slack * 1e6f);
    tl_pair_batch batches[TL_BATCH_KINDS];
    ended e = {tl_new_touch(h), 0};
    tl_batches_begin(batches, 1);
    tl_lists_of_awake(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        uint32_t c = tl_awake_contact(h)[k];
        const tl_contact_meta *meta = &tl_contacts(h)[c];
        uint32_t moved = motion[meta->body_a] + motion[meta->body_b] - meta->motion;
        if (moved <= slack_of(c, meta, slack) && !(meta->flags & TL_CONTACT_FRESH)) {
            h->counters.manifolds_kept++;
        } else {
            update_contact(step, batches, c, &e);
        }
    }
    for (uint32_t i = 0; i < TL_BATCH_KINDS; i++) {
        run_batch(step, &batches[i], &e);
    }
    tl_sort_keys(e.keys, e.count);
    for (uint32_t k = 0; k < e.count; k++) {
        float gap;
        uint32_t bits = (uint32_t)e.keys[k];
        memcpy(&gap, &bits, sizeof gap);
        end_touch(h, (uint32_t)(e.keys[k] >> 32), gap);
    }
}
