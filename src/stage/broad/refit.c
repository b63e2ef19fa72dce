#include "stage/broad/refit.h"

#include "geom/mass.h"
#include "stage/store/lists.h"

/* m: what a fat box has beyond the shape's own on every side, and how many steps ahead it looks along the velocity. */
#define FAT_MARGIN 0.05f
#define FAT_SHARE 0.1f /* of the shape's reach, if that is less */
#define FAT_STEPS 4.0f
/* m: below what a body's motion is counted as at most in a step, so that no step is missed. */
#define MOST_FREE 900.0f

tl_convex tl_shape_convex(const tl_header *h, const void *geometry, uint32_t shape) {
    tl_convex c = {tl_shape_geometry(h)[shape], NULL};
    c.hull = tl_geometry_hull(&c.geometry, geometry);
    return c;
}

talus_pose tl_shape_world_pose(const tl_header *h, uint32_t shape) {
    talus_pose body = tl_row_pose_of(&tl_body_pose(h)[tl_shapes(h)[shape].body]);
    talus_pose place = tl_row_pose_of(&tl_shape_place(h)[shape]);
    return tl_pose_mul(&body, &place);
}

talus_aabb tl_shape_box(const tl_header *h, const void *geometry, uint32_t shape) {
    tl_convex convex = tl_shape_convex(h, geometry, shape);
    talus_pose pose = tl_shape_world_pose(h, shape);
    return tl_convex_aabb(&convex, &pose);
}

static float margin_of(const tl_header *h, uint32_t shape) {
    return tl_min(FAT_MARGIN, FAT_SHARE * tl_shape_place(h)[shape].f[7]);
}

/* A box with a margin on every side and a way that it may go. */
static talus_aabb grown(const talus_aabb *box, float margin, talus_vec3 way) {
    talus_vec3 m = tl_v(margin, margin, margin), zero = tl_v(0.0f, 0.0f, 0.0f);
    talus_aabb r = {tl_add(tl_sub(box->lower, m), tl_min3(way, zero)),
                    tl_add(tl_add(box->upper, m), tl_max3(way, zero))};
    return r;
}

static talus_aabb fattened(const tl_header *h, uint32_t shape, const talus_aabb *box, float dt) {
    const tl_shape_meta *meta = &tl_shapes(h)[shape];
    if (tl_body_type(&tl_bodies(h)[meta->body]) == TALUS_STATIC) {
        return *box;
    }
    float margin = margin_of(h, shape) + h->settings.speculative_margin;
    return grown(box, margin, tl_scale(tl_row_xyz(&tl_body_velocity(h)[meta->body]), FAT_STEPS * dt));
}

/* m: where boxes are rounded more coarsely. */
static float coarseness(const tl_header *h, uint32_t body) {
    talus_vec3 far = tl_abs3(tl_row_xyz(&tl_body_pose(h)[body]));
    return 1e-6f * (far.x + far.y + far.z);
}

/* Micrometres that a body may still move until a shape of it has to be looked at, for that shape alone. */
static uint32_t room_for(const tl_header *h, uint32_t body, uint32_t shape) {
    const tl_shape_track *t = &tl_shape_tracks(h)[shape];
    float moved = (float)(tl_body_motion(h)[body] - t->motion) * 1e-6f;
    float room = t->free - moved - 2.0f * coarseness(h, body); /* twice, for it moves on */
    return t->stale || !(room > 0.0f) ? 0u : (uint32_t)(room * 0.999e6f);
}

/* body_room: the motion count up to which no shape of a body has to be looked at. */
static void lessen_room(tl_header *h, uint32_t body, uint32_t shape) {
    uint32_t *room = &tl_body_room(h)[body], least = tl_body_motion(h)[body] + room_for(h, body, shape);
    *room = (int32_t)(*room - least) > 0 ? least : *room;
}

static void renew_room(tl_header *h, uint32_t body) {
    tl_body_room(h)[body] = tl_body_motion(h)[body] + (uint32_t)(MOST_FREE * 1e6f);
    for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
        lessen_room(h, body, s);
    }
}

/* Whether a body that goes `way` (micrometres) further has room for it. */
static int has_room(const tl_header *h, uint32_t body, uint32_t way) {
    return (int32_t)(tl_body_room(h)[body] - tl_body_motion(h)[body] - way) > 0;
}

/* Those who call this renew or lessen the body's room. */
static void note_looked(tl_header *h, uint32_t shape, const talus_aabb *box, float free) {
    tl_shape_track *t = &tl_shape_tracks(h)[shape];
    uint32_t body = tl_shapes(h)[shape].body;
    t->motion = tl_body_motion(h)[body];
    t->free = tl_min(free, MOST_FREE);
    t->stale = 0;
    tl_shape_bounds(h)[shape] = *box;
}

/* The box of a shape that was looked at since it was last changed: as it was then, if the body has not moved since. */
static talus_aabb box_now(const tl_header *h, const void *geometry, uint32_t shape) {
    int still = tl_shape_tracks(h)[shape].motion == tl_body_motion(h)[tl_shapes(h)[shape].body];
    return still ? tl_shape_bounds(h)[shape] : tl_shape_box(h, geometry, shape);
}

static void enter(tl_header *h, uint32_t shape, const talus_aabb *box, float dt) {
    tl_shape_track *t = &tl_shape_tracks(h)[shape];
    uint32_t body = tl_shapes(h)[shape].body;
    uint32_t still = tl_body_type(&tl_bodies(h)[body]) == TALUS_STATIC;
    int tree = still ? TL_TREE_STILL : TL_TREE_MOVING;
    t->fat = fattened(h, shape, box, dt);
    if (t->node && t->still == still) {
        t->node = tl_tree_move(h, tree, t->node - 1u, &t->fat) + 1u;
    } else {
        tl_shape_leave_tree(h, shape);
        t->still = still;
        t->node = tl_tree_insert(h, tree, shape, &t->fat) + 1u;
    }
    note_looked(h, shape, box, margin_of(h, shape));
    h->counters.proxies_refit++;
}

void tl_shape_leave_tree(tl_header *h, uint32_t shape) {
    tl_shape_track *t = &tl_shape_tracks(h)[shape];
    if (t->node) {
        tl_tree_remove(h, t->still ? TL_TREE_STILL : TL_TREE_MOVING, t->node - 1u);
        t->node = 0;
    }
}

/* Whether a body's motion since a shape was looked at, and `way` more (m), are within what was free then whatever their
 * direction: the cheap answer, which needs no box. */
static int has_hardly_moved(const tl_header *h, uint32_t body, uint32_t shape, float way) {
    const tl_shape_track *t = &tl_shape_tracks(h)[shape];
    if (t->stale) {
        return 0;
    }
    uint32_t moved = tl_body_motion(h)[body] - t->motion;
    return (float)moved * 1e-6f + way + coarseness(h, body) < t->free;
}

static talus_aabb swept_of(const tl_header *h, uint32_t shape, const talus_aabb *box, float dt) {
    if (tl_body_type(&tl_bodies(h)[tl_shapes(h)[shape].body]) == TALUS_STATIC) {
        return *box; /* as its fat box: the margin is on the other one */
    }
    talus_vec3 way = tl_scale(tl_row_xyz(&tl_body_velocity(h)[tl_shapes(h)[shape].body]), dt);
    return grown(box, h->settings.speculative_margin, way);
}

/* m: the least distance from a box to the faces of the fat box around it, beside the speculative margin. */
static float free_within(const tl_header *h, const talus_aabb *fat, const talus_aabb *box) {
    talus_vec3 d = tl_min3(tl_sub(box->lower, fat->lower), tl_sub(fat->upper, box->upper));
    return tl_min(d.x, tl_min(d.y, d.z)) - h->settings.speculative_margin;
}

talus_aabb tl_shape_swept_box(const tl_header *h, const void *geometry, uint32_t shape, float dt) {
    talus_aabb box = tl_shape_box(h, geometry, shape);
    return swept_of(h, shape, &box, dt);
}

void tl_shapes_settle(tl_header *h, uint32_t body) {
    for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
        if (!has_hardly_moved(h, body, s, 0.0f)) {
            tl_shape_mark_moved(h, s);
        }
    }
}

/* Whether the fat box still holds a shape with the way of the coming step. */
static int stays(tl_header *h, uint32_t shape, const talus_aabb *box, float dt) {
    const tl_shape_track *t = &tl_shape_tracks(h)[shape];
    talus_aabb swept = swept_of(h, shape, box, dt);
    if (!t->node || !tl_aabb_contains(&t->fat, &swept)) {
        return 0;
    }
    note_looked(h, shape, box, free_within(h, &t->fat, box));
    return 1;
}

void tl_stage_refit(tl_header *h, const void *geometry, float dt) {
    h->counters.proxies_refit = 0;
    for (uint32_t k = 0; k < h->moved_shapes;) {
        uint32_t shape = tl_moved_shape(h)[k];
        talus_aabb box = tl_shape_box(h, geometry, shape);
        if (tl_shape_tracks(h)[shape].stale && stays(h, shape, &box, dt)) {
            tl_shape_unmark_moved(h, shape); /* the last one is at k now */
        } else {
            enter(h, shape, &box, dt);
            k++;
        }
        lessen_room(h, tl_shapes(h)[shape].body, shape);
    }
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t body = tl_awake_body(h)[k];
        float way = tl_length(tl_row_xyz(&tl_body_velocity(h)[body])) * dt;
        if (has_room(h, body, 1u + (uint32_t)tl_min(way * 1.001e6f, 1e9f))) {
            continue;
        }
        for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
            if (tl_shape_tracks(h)[s].moved || has_hardly_moved(h, body, s, way)) {
                continue;
            }
            talus_aabb box = box_now(h, geometry, s);
            if (!stays(h, s, &box, dt)) {
                enter(h, s, &box, dt);
                tl_shape_mark_moved(h, s);
            }
        }
        renew_room(h, body);
    }
}

void tl_stage_leave(tl_header *h, const void *geometry) {
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t body = tl_awake_body(h)[k];
        if (has_room(h, body, 0)) {
            continue;
        }
        for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
            const tl_shape_track *t = &tl_shape_tracks(h)[s];
            if (t->moved || has_hardly_moved(h, body, s, 0.0f)) {
                continue;
            }
            talus_aabb box = tl_shape_box(h, geometry, s);
            if (tl_aabb_contains(&t->fat, &box)) {
                note_looked(h, s, &box, free_within(h, &t->fat, &box));
            } else {
                tl_shape_mark_moved(h, s);
            }
        }
        tl_body_room(h)[body] = tl_body_motion(h)[body]; /* refit renews it: the next step's way counts there */
    }
}

/* Whether a joint that forbids it ties two bodies together. */
static int joined(const tl_header *h, uint32_t a, uint32_t b) {
    const tl_joint_record *joints = tl_joints(h);
    for (uint32_t l = tl_bodies(h)[a].first_joint; l != TL_NONE; l = joints[l >> 1].next[l & 1u]) {
        const tl_joint_record *j = &joints[l >> 1];
        if (!(j->flags & TL_JOINT_COLLIDE) && (j->body_a == b || j->body_b == b)) {
            return 1;
        }
    }
    return 0;
}

int tl_filters_meet(const talus_filter *a, const talus_filter *b) {
    if (a->group != 0 && a->group == b->group) {
        return a->group > 0;
    }
    return (a->mask & b->category) != 0 && (b->mask & a->category) != 0;
}

talus_filter tl_shape_filter(const tl_header *h, uint32_t shape) {
    talus_filter f = {tl_shape_category(h)[shape], tl_shape_mask(h)[shape], tl_shapes(h)[shape].group};
    return f;
}

int tl_may_collide(const tl_header *h, uint32_t a, uint32_t b) {
    const tl_shape_meta *ma = &tl_shapes(h)[a], *mb = &tl_shapes(h)[b];
    if (ma->body == mb->body || (ma->flags & mb->flags & TL_SHAPE_SENSOR)) {
        return 0;
    }
    int dynamic = tl_body_is_dynamic(h, ma->body) || tl_body_is_dynamic(h, mb->body);
    if (!dynamic && !((ma->flags | mb->flags) & TL_SHAPE_SENSOR)) {
        return 0;
    }
    talus_filter fa = tl_shape_filter(h, a), fb = tl_shape_filter(h, b);
    if (!tl_filters_meet(&fa, &fb)) {
        return 0;
    }
    /* The ground ties many joints: ask the body that has fewer. */
    return ma->body == 0 ? !joined(h, mb->body, ma->body) : !joined(h, ma->body, mb->body);
}

/* Whether the pair is there, or need not be. */
static int pair(tl_header *h, uint32_t s, uint32_t t) {
    uint32_t a = s < t ? s : t, b = s < t ? t : s;
    if (tl_pair_find(h, a, b) != TL_NONE || !tl_may_collide(h, a, b)) {
        return 1;
    }
    if (tl_pair_make(h, a, b) == TL_NONE) {
        return 0;
    }
    h->counters.pairs_made++;
    return 1;
}

#define OTHERS 16u /* whose pairs are fetched while the tree is walked on */

static int pair_others(tl_header *h, uint32_t shape, const uint32_t *others, uint32_t count) {
    int all = 1;
    for (uint32_t i = 0; i < count; i++) {
        all &= pair(h, shape, others[i]);
    }
    return all;
}

/* Makes the pairs of a shape; 0 if there was not room for all. */
static int pair_shape(tl_header *h, uint32_t shape) {
    const tl_shape_track *t = &tl_shape_tracks(h)[shape];
    uint32_t others[OTHERS], count = 0;
    int all = 1;
    tl_tree_walk walk;
    for (int tree = 0; tree < (t->still ? 1 : 2); tree++) {
        tl_tree_begin(&walk, h, tree, &t->fat);
        for (uint32_t other = tl_tree_next(&walk, h); other != TL_NONE; other = tl_tree_next(&walk, h)) {
            tl_pair_prefetch(h, shape < other ? shape : other, shape < other ? other : shape);
            others[count++] = other;
            if (count == OTHERS) {
                all &= pair_others(h, shape, others, count);
                count = 0;
            }
        }
    }
    return all & pair_others(h, shape, others, count);
}

void tl_stage_pairs(tl_header *h) {
    uint32_t kept = 0;
    h->counters.pairs_made = 0;
    for (uint32_t k = 0; k < h->moved_shapes; k++) {
        uint32_t shape = tl_moved_shape(h)[k];
        int all = pair_shape(h, shape);
        tl_shape_tracks(h)[shape].moved = all ? 0 : kept + 1u;
        if (!all) { /* the narrow stage looks around it without pairs, and the next step asks again */
            tl_moved_shape(h)[kept++] = shape;
        }
    }
    h->moved_shapes = kept;
}
