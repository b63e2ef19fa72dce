/* Narrow: from pairs of shapes to manifolds. The state of a pair is its manifold with the features that made it, and
 * how far both bodies had gone by then: what moved less than the slack since is not looked at. */
#include <string.h>

#include "stage/broad/refit.h"
#include "stage/stages.h"
#include "stage/store/lists.h"

static int fat_boxes_part(const tl_header *h, const tl_contact_link *l) {
    const tl_row8 *a = &tl_shape_fat(h)[l->shape_a], *b = &tl_shape_fat(h)[l->shape_b];
    for (int k = 0; k < 3; k++) {
        if (a->f[k] > b->f[k + 3] || b->f[k] > a->f[k + 3]) {
            return 1;
        }
    }
    return 0;
}

/* m: how far ahead contacts are prepared: what the pair can close in this step. */
static float margin_of(const tl_step *step, const tl_contact_meta *meta) {
    const tl_row8 *v = tl_body_velocity(step->h);
    if (meta->flags & TL_CONTACT_SENSOR) {
        return 0.0f;
    }
    float speed = tl_length(tl_sub(tl_row_xyz(&v[meta->body_a]), tl_row_xyz(&v[meta->body_b])));
    return step->h->settings.speculative_margin + tl_min(speed, 1e6f) * step->dt;
}

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

/* Whether a body has no row of its own: its points are then kept in the world. */
static int is_fixed(const tl_header *h, uint32_t body) { return !tl_body_row(h)[body] && !tl_body_is_dynamic(h, body); }

/* Puts a manifold, given in shape a's frame, into the bodies' mass frames; pa and pb are the shapes in the world. */
static void store_manifold(tl_header *h, uint32_t c, const tl_manifold *m, const talus_pose *b_in_a,
                           const talus_pose *pa, const talus_pose *pb) {
    tl_contact_meta *meta = &tl_contacts(h)[c];
    tl_contact_head *head = &tl_heads(h)[c];
    tl_contact_points *points = &tl_points(h)[c];
    old_points old;
    const tl_contact_link *l = &tl_contact_links(h)[c];
    talus_pose place_a = is_fixed(h, meta->body_a) ? *pa : tl_row_pose_of(&tl_shape_place(h)[l->shape_a]);
    talus_pose place_b = is_fixed(h, meta->body_b) ? *pb : tl_row_pose_of(&tl_shape_place(h)[l->shape_b]);
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
    if (meta->count == 0 || m->count == 0) {
        memset(head->friction, 0, sizeof head->friction);
        head->twist = 0.0f;
    }
    meta->count = m->count;
}

static void begin_touch(tl_header *h, tl_contact_meta *meta) {
    meta->flags |= TL_CONTACT_TOUCHING;
    h->counters.touches_begun++;
    if (!(meta->flags & TL_CONTACT_SENSOR)) {
        meta->flags |= TL_CONTACT_COLORED;
        meta->color = tl_color_take(h, meta->body_a, meta->body_b);
        tl_island_wake(h, meta->body_a);
        tl_island_wake(h, meta->body_b);
    }
}

static void end_touch(tl_header *h, tl_contact_meta *meta) {
    h->counters.touches_ended++;
    if (meta->flags & TL_CONTACT_COLORED) {
        tl_color_give(h, meta->body_a, meta->body_b, meta->color);
    }
    meta->flags &= ~(uint32_t)(TL_CONTACT_TOUCHING | TL_CONTACT_COLORED);
    meta->color = TL_COLORS;
}

static talus_pose shape_pose(const tl_header *h, uint32_t body, uint32_t shape) {
    talus_pose b = tl_row_pose_of(&tl_body_pose(h)[body]), place = tl_row_pose_of(&tl_shape_place(h)[shape]);
    return tl_pose_mul(&b, &place);
}

/* What a pair may move, in micrometres, before it has to be looked at again although it is `gap` (m) apart: half of
 * what is left, so that a pair that was not looked at cannot have closed the rest within one more step. */
static uint32_t slack_of_gap(const tl_header *h, float gap) {
    float free = 0.5f * (gap - h->settings.speculative_margin);
    return free > 0.0f ? (uint32_t)tl_min(free * 1e6f, 1e9f) : 0u;
}

/* m: how far the balls around two bodies' mass centres are apart, at least. */
static float ball_gap(const tl_header *h, const tl_contact_meta *meta) {
    const tl_row8 *a = &tl_body_pose(h)[meta->body_a], *b = &tl_body_pose(h)[meta->body_b];
    const tl_body_inertia *in = tl_body_inertias(h);
    return tl_length(tl_sub(tl_row_xyz(b), tl_row_xyz(a))) - in[meta->body_a].reach - in[meta->body_b].reach;
}

static void note_made(tl_header *h, tl_contact_meta *meta, int touches, float gap) {
    const uint32_t *motion = tl_body_motion(h);
    int touched = (meta->flags & TL_CONTACT_TOUCHING) != 0;
    meta->motion = motion[meta->body_a] + motion[meta->body_b];
    meta->slack = touches ? (uint32_t)(h->settings.recycle_slack * 1e6f) : slack_of_gap(h, gap);
    if (touches && meta->flags & TL_CONTACT_SENSOR) {
        meta->slack = 0;
    }
    meta->flags &= ~(uint32_t)TL_CONTACT_FRESH;
    if (touches && !touched) {
        begin_touch(h, meta);
    } else if (!touches && touched) {
        end_touch(h, meta);
    }
}

static void make_manifold(tl_step *step, uint32_t c) {
    tl_header *h = step->h;
    tl_contact_meta *meta = &tl_contacts(h)[c];
    const tl_contact_link *l = &tl_contact_links(h)[c];
    tl_convex a = tl_shape_convex(h, step->geometry, l->shape_a), b = tl_shape_convex(h, step->geometry, l->shape_b);
    talus_pose pa = shape_pose(h, meta->body_a, l->shape_a), pb = shape_pose(h, meta->body_b, l->shape_b);
    talus_pose b_in_a = tl_pose_relative(&pa, &pb);
    b_in_a.rotation = tl_quat_normalize(b_in_a.rotation);
    tl_manifold m;
    tl_collide(&a, &b, &b_in_a, margin_of(step, meta), &tl_contact_caches(h)[c], &m);
    store_manifold(h, c, &m, &b_in_a, &pa, &pb);
    note_made(h, meta, m.count > 0, m.gap);
}

/* Whether the balls around the bodies tell already that they do not touch. */
static int parted_by_balls(tl_step *step, uint32_t c) {
    tl_header *h = step->h;
    tl_contact_meta *meta = &tl_contacts(h)[c];
    if (!tl_body_is_dynamic(h, meta->body_a) || !tl_body_is_dynamic(h, meta->body_b)) {
        return 0; /* what is not dynamic tends to be large */
    }
    float gap = ball_gap(h, meta);
    if (!(gap > margin_of(step, meta))) {
        return 0;
    }
    if (meta->count > 0) {
        tl_manifold none;
        memset(&none, 0, sizeof none);
        talus_pose here = tl_pose_identity();
        store_manifold(h, c, &none, &here, &here, &here);
    }
    note_made(h, meta, 0, gap);
    return 1;
}

void tl_stage_narrow(tl_step *step) {
    tl_header *h = step->h;
    talus_counters *n = &h->counters;
    n->manifolds_made = n->manifolds_first = n->manifolds_kept = n->pairs_ended = 0;
    n->contacts_touching = n->contact_points = n->touches_begun = n->touches_ended = 0;
    const uint32_t *motion = tl_body_motion(h);
    for (uint32_t k = 0; k < h->awake_contacts;) {
        uint32_t c = tl_awake_contact(h)[k];
        const tl_contact_meta *meta = &tl_contacts(h)[c];
        uint32_t moved = motion[meta->body_a] + motion[meta->body_b] - meta->motion;
        if (moved <= meta->slack && !(meta->flags & TL_CONTACT_FRESH)) {
            n->manifolds_kept++;
            k++;
            continue;
        }
        if (fat_boxes_part(h, &tl_contact_links(h)[c])) {
            n->touches_ended += (meta->flags & TL_CONTACT_TOUCHING) != 0;
            tl_event_contact_end(h, c);
            tl_contact_end(h, c);
            n->pairs_ended++;
            continue; /* another contact stands at k now */
        }
        n->manifolds_first += (meta->flags & TL_CONTACT_FRESH) != 0;
        if (!parted_by_balls(step, c)) {
            make_manifold(step, c);
        }
        n->manifolds_made++;
        k++;
    }
    n->contacts_sleeping = h->contacts.used - h->awake_contacts;
}
