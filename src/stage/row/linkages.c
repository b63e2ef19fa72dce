/* Linkages: joints that hang together through bodies that can be moved, in an order in which they are solved at once.
 *
 * Bodies are visited breadth first from one of them, and their joints taken in the reverse of the order in which they
 * were met: in a tree every joint is then taken after those beyond it, so that the factor is no fuller than the bodies'
 * joints make it, and in a ring two columns meet. Linkages of one structure are solved eight side by side. */
#include <string.h>

#include "stage/row/groups.h"

/* Fewer alike than this are solved one by one: eight wide costs as much as several of them. */
#define LEAST_WIDE 4u
/* How many structures a linkage is compared with: beyond that looking costs more than it gives. */
#define SHAPES_COMPARED 8u

uint32_t tl_linked_rows(const tl_joint_record *j) {
    uint32_t rows = j->fixed;
    while (rows < j->rows && rows < TL_LINK_ROWS && j->code[rows] / TL_ROW_TYPES == TL_ROW_RANGE) {
        rows++;
    }
    return rows;
}

/* The row of a body that impulses can move, else 0. */
static uint32_t free_row(const tl_header *h, uint32_t body) {
    uint32_t row = tl_body_row(h)[body];
    const float *v = tl_row_velocity(h)[row].f;
    return row && (v[6] > 0.0f || v[7] > 0.0f) ? row : 0u;
}

/* The joints that hang together with `joint`, into linkage_order from `first` on; linkage_rows numbers their bodies
 * from 1. Returns how many joints there are. They are exact where their bodies are held by nothing else, no contact, no
 * limit, no drive, no lock: then the impulses that the pass after the move would find are among those that the next
 * sub-step finds, as both act along the same rows. */
static uint32_t gather(tl_header *h, uint32_t joint, uint32_t first, uint32_t *ends, uint32_t *exact) {
    const tl_joint_record *joints = tl_joints(h);
    uint32_t *of = tl_linkage_of(h), *number = tl_linkage_rows(h), *queue = tl_linkage_queue(h);
    uint32_t *order = tl_linkage_order(h) + first, count = 0, head = 0, tail = 0;
    uint32_t row = free_row(h, joints[joint].body_a);
    queue[tail++] = row ? row : free_row(h, joints[joint].body_b);
    number[queue[0]] = 1u;
    *exact = 1u;
    while (head < tail) {
        const tl_row8 *moved = &tl_row_moved(h)[queue[head]];
        uint32_t body = tl_awake_body(h)[queue[head++] - 1u];
        *exact &= moved->f[7] == 0.0f && moved->f[6] == 0.0f;
        for (uint32_t link = tl_bodies(h)[body].first_joint; link != TL_NONE;) {
            const tl_joint_record *j = &joints[link / 2u];
            uint32_t other = free_row(h, link & 1u ? j->body_a : j->body_b);
            *exact &= j->rows == j->fixed;
            if (j->fixed > 0 && of[link / 2u] == TL_LINKAGE_NONE) {
                of[link / 2u] = TL_LINKAGE_READY;
                order[count++] = link / 2u;
                if (other && !number[other]) {
                    queue[tail++] = other;
                    number[other] = tail;
                }
            }
            link = j->next[link & 1u];
        }
    }
    *ends = tail;
    return count;
}

/* Which end a body is of the linkage that was gathered with its joints: those that impulses move are numbered. */
static uint32_t end_of(const tl_header *h, uint32_t body) {
    return tl_linkage_rows(h)[tl_body_row(h)[body]] - 1u; /* 0 - 1: TL_BLOCK_FREE */
}

/* Whether the joints from `first` on in linkage_order are tied as those of a shape are. */
static int has_shape(const tl_header *h, const tl_linkage_shape *s, uint32_t first, uint32_t count, uint32_t ends) {
    const tl_joint_record *joints = tl_joints(h);
    const uint32_t *order = tl_linkage_order(h);
    if (s->nodes != count || s->ends != ends) {
        return 0;
    }
    for (uint32_t k = 0; k < count; k++) {
        const tl_joint_record *j = &joints[order[first + k]];
        const tl_block_node *node = &tl_linkage_nodes(h)[s->first_node + count - 1u - k];
        if (node->end[0] != end_of(h, j->body_a) || node->end[1] != end_of(h, j->body_b) ||
            !tl_joints_alike(j, &joints[order[s->first_joint + k]])) {
            return 0;
        }
    }
    return 1;
}

typedef struct finder {
    tl_header *h;
    uint32_t shapes, nodes, blocks, linkages, joints, values, places;
} finder;

/* The structure of the joints from `first` on. */
static uint32_t shape_of(finder *f, uint32_t first, uint32_t count, uint32_t ends) {
    tl_header *h = f->h;
    tl_linkage_shape *shapes = tl_linkage_shapes(h);
    for (uint32_t k = 1; k <= f->shapes && k <= SHAPES_COMPARED; k++) {
        if (has_shape(h, &shapes[f->shapes - k], first, count, ends)) {
            return f->shapes - k;
        }
    }
    tl_linkage_shape *s = &shapes[f->shapes];
    memset(s, 0, sizeof *s);
    s->first_node = f->nodes, s->nodes = count, s->ends = ends, s->first_joint = first;
    tl_block_node *nodes = tl_linkage_nodes(h) + f->nodes;
    for (uint32_t k = 0; k < count; k++) {
        const tl_joint_record *j = &tl_joints(h)[tl_linkage_order(h)[first + count - 1u - k]];
        nodes[k].end[0] = end_of(h, j->body_a), nodes[k].end[1] = end_of(h, j->body_b);
        nodes[k].rows = tl_linked_rows(j);
    }
    f->nodes += count;
    return f->shapes++;
}

/* The factor of a shape, when first a linkage asks for it; none where it would be too full. */
static void plan_shape(finder *f, tl_linkage_shape *s) {
    tl_header *h = f->h;
    uint32_t room = h->capacity[TL_COUNT_LINKBLOCK] - f->blocks, most = s->nodes * TL_LINK_BLOCKS;
    uint32_t used = tl_block_plan(tl_linkage_nodes(h) + s->first_node, s->nodes, s->ends, tl_linkage_blocks(h),
                                  f->blocks, most < room ? most : room, tl_linkage_scratch(h), &s->values);
    s->planned = 1;
    if (used == TL_BLOCK_FREE) {
        s->values = 0;
    } else {
        f->blocks += used;
    }
}

/* The joints from `first` on are solved one by one, being of no linkage or of one left apart. */
static void leave(tl_header *h, uint32_t first, uint32_t count, uint32_t as) {
    for (uint32_t k = 0; k < count; k++) {
        tl_linkage_of(h)[tl_linkage_order(h)[first + k]] = as;
    }
}

/* What is short, slow and not of too unlike masses holds together with one joint solved at a time. */
#define EASY_JOINTS 16u
#define EASY_RATIO 40.0f /* of masses */
#define EASY_SPEED 0.5f  /* m/s: of a body's farthest point */

static int is_easy(const tl_header *h, const uint32_t *order, uint32_t count) {
    float least = 3.0e38f, most = 0.0f;
    if (count > EASY_JOINTS) {
        return 0;
    }
    for (uint32_t k = 0; k < 2u * count; k++) {
        const tl_joint_record *j = &tl_joints(h)[order[k / 2u]];
        uint32_t body = k & 1u ? j->body_b : j->body_a, row = free_row(h, body);
        const tl_row8 *v = &tl_body_velocity(h)[body];
        float mass = tl_row_velocity(h)[row].f[6];
        if (row) {
            float speed = tl_length(tl_row_xyz(v)) + tl_length(tl_row_345(v)) * tl_body_inertias(h)[body].reach;
            if (speed > EASY_SPEED) {
                return 0;
            }
            least = tl_min(least, mass), most = tl_max(most, mass);
        }
    }
    return most < EASY_RATIO * least;
}

/* What is torn apart or whirls is beyond what a linear solve can tell: taken back at once, its errors would fling it.
 * Joint by joint a tree of them holds together; rings would quarrel, and give instead. */
#define WILD_SHARE 0.25f /* of the bodies' reach: how far off a joint may be */
#define WILD_TURN 0.5f   /* rad in a sub-step: where the curve of an anchor's path is no guide any more */

/* m: how far the locked rows of a joint are off that holds its frames' origins, which are d apart in the world. */
static float error_of(const tl_header *h, const tl_joint_record *j, talus_vec3 d) {
    talus_quat a = tl_quat_mul(tl_row_quat(&tl_body_pose(h)[j->body_a]), j->place_a.rotation);
    d = tl_rotate_back(a, d);
    const float along[3] = {tl_abs(d.x), tl_abs(d.y), tl_abs(d.z)};
    float most = 0.0f;
    for (uint32_t k = 0; k < j->fixed; k++) {
        uint32_t type = j->code[k] % TL_ROW_TYPES;
        if (type < TL_ROW_ANGULAR) {
            most = tl_max(most, along[type - TL_ROW_LINEAR]);
        } else if (type == TL_ROW_DISTANCE) {
            most = tl_max(most, tl_abs(tl_length(d) - j->param[k].lower));
        }
    }
    return most;
}

/* m: how far a body that impulses move reaches, or is held from; 0 of one that they do not. */
static float arm_of(const tl_header *h, uint32_t body, talus_vec3 held) {
    return end_of(h, body) != TL_BLOCK_FREE ? tl_max(tl_body_inertias(h)[body].reach, tl_length(held)) : 0.0f;
}

static int is_wild(const tl_step *step, const uint32_t *order, uint32_t count) {
    const tl_header *h = step->h;
    for (uint32_t k = 0; k < count; k++) {
        const tl_joint_record *j = &tl_joints(h)[order[k]];
        float reach = arm_of(h, j->body_a, j->place_a.position) + arm_of(h, j->body_b, j->place_b.position);
        talus_pose a = tl_row_pose_of(&tl_body_pose(h)[j->body_a]), b = tl_row_pose_of(&tl_body_pose(h)[j->body_b]);
        talus_vec3 d = tl_sub(tl_pose_point(&b, j->place_b.position), tl_pose_point(&a, j->place_a.position));
        float most = WILD_SHARE * reach; /* the rows' errors are no larger than d, but for those of distances */
        int near = !j->distance_enabled && tl_dot(d, d) < most * most;
        talus_vec3 wa = tl_row_345(&tl_body_velocity(h)[j->body_a]), wb = tl_row_345(&tl_body_velocity(h)[j->body_b]);
        float spin = tl_max(tl_dot(wa, wa), tl_dot(wb, wb)); /* squared */
        if (!(spin * (step->sub * step->sub) < WILD_TURN * WILD_TURN) || !(near || error_of(h, j, d) < most)) {
            return 1;
        }
    }
    return 0;
}

static void find_components(const tl_step *step, finder *f) {
    tl_header *h = f->h;
    const uint32_t *awake = tl_awake_joint(h);
    uint32_t *of = tl_linkage_of(h), *order = tl_linkage_order(h);
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        const tl_joint_record *j = &tl_joints(h)[awake[k]];
        if (of[awake[k]] != TL_LINKAGE_NONE || j->fixed == 0 || !(free_row(h, j->body_a) || free_row(h, j->body_b))) {
            continue;
        }
        uint32_t ends, exact, count = gather(h, awake[k], f->joints, &ends, &exact);
        if (count > 1u && is_easy(h, order + f->joints, count)) {
            leave(h, f->joints, count, TL_LINKAGE_APART); /* not to be gathered again from another joint */
        } else if (count > 1u && is_wild(step, order + f->joints, count)) {
            leave(h, f->joints, count, count > ends ? TL_LINKAGE_LOOSE : TL_LINKAGE_APART);
        } else if (count > 1u) {
            uint32_t shape = shape_of(f, f->joints, count, ends);
            tl_linkage *l = &tl_linkages(h)[f->linkages++];
            memset(l, 0, sizeof *l);
            l->shape = shape, l->first_joint = f->joints, l->lanes = 1u, l->exact = exact;
            tl_linkage_shapes(h)[shape].members++;
            f->joints += count;
        } else {
            of[order[f->joints]] = exact ? TL_LINKAGE_ALONE : TL_LINKAGE_NONE;
        }
    }
}

/* Opens the groups of a linkage that is solved eight wide, one a node. */
static int open_groups(finder *f, tl_linkage *l, const tl_linkage_shape *s) {
    tl_header *h = f->h;
    uint32_t groups = h->joint_groups;
    for (uint32_t k = 0; k < s->nodes; k++) {
        const tl_joint_record *j = &tl_joints(h)[tl_linkage_order(h)[l->first_joint + s->nodes - 1u - k]];
        tl_joint_group *g = tl_joint_group_open(h, j, 1u);
        if (!g) {
            return 0;
        }
        g->linked = tl_linked_rows(j);
        tl_linkage_places(h)[l->first_place + k] = (groups + k) * TL_LANES;
    }
    return 1;
}

static void fill_groups(tl_step *step, const tl_linkage *l, const tl_linkage_shape *s, uint32_t first_joint) {
    tl_header *h = step->h;
    for (uint32_t k = 0; k < s->nodes; k++) {
        uint32_t group = tl_linkage_places(h)[l->first_place + k] / TL_LANES;
        tl_joint_group_add(step, &tl_joint_group_pool(h)[group], tl_linkage_order(h)[first_joint + s->nodes - 1u - k]);
    }
}

/* A place for a linkage's values and nodes; 0 if there is no room. */
static int settle(finder *f, tl_linkage *l, tl_linkage_shape *s, uint32_t width) {
    if (!s->planned) {
        plan_shape(f, s);
    }
    uint32_t values = (s->values * width + TL_LANES - 1u) / TL_LANES * TL_LANES;
    if (s->values == 0 || f->values + values > f->h->capacity[TL_COUNT_LINKVALUE]) {
        return 0;
    }
    l->first_node = s->first_node, l->nodes = s->nodes;
    l->values = f->values, l->first_place = f->places;
    f->values += values, f->places += s->nodes;
    return 1;
}

/* Members of a shape that are solved eight wide, as many as fill groups well. */
static uint32_t wide_members(uint32_t members) {
    uint32_t rest = members % TL_LANES;
    return rest >= LEAST_WIDE ? members : members - rest;
}

static int cut(tl_step *step, finder *f, tl_linkage *l, const tl_linkage_shape *s) {
    tl_linkage_room room = {f->nodes, f->blocks, f->values, f->places};
    int done = tl_linkage_cut(step, l, s, &room);
    f->nodes = room.nodes, f->blocks = room.blocks, f->values = room.values, f->places = room.places;
    return done;
}

/* The linkages in their final places: what is alike goes side by side, the rest keeps its joints for the coloured
 * groups. */
static void place_linkages(tl_step *step, finder *f) {
    tl_header *h = step->h;
    tl_linkage *linkages = tl_linkages(h);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < f->shapes; i++) {
        tl_linkage_shapes(h)[i].wide = wide_members(tl_linkage_shapes(h)[i].members);
        tl_linkage_shapes(h)[i].open = TL_NONE;
    }
    for (uint32_t i = 0; i < f->linkages; i++) {
        tl_linkage l = linkages[i];
        tl_linkage_shape *s = &tl_linkage_shapes(h)[l.shape];
        if (s->wide > 0 && s->open != TL_NONE && linkages[s->open].lanes < TL_LANES) {
            s->wide--;
            linkages[s->open].lanes++;
            linkages[s->open].exact &= l.exact;
            fill_groups(step, &linkages[s->open], s, l.first_joint);
            continue;
        }
        if (s->wide == 0 && cut(step, f, &l, s)) {
            linkages[kept++] = l;
            continue;
        }
        if (!settle(f, &l, s, s->wide > 0 ? TL_LANES : 1u) || (s->wide > 0 && !open_groups(f, &l, s))) {
            s->wide -= s->wide > 0;
            leave(h, l.first_joint, s->nodes, TL_LINKAGE_LOOSE);
            h->counters.joints_apart += s->nodes;
            continue;
        }
        if (s->wide > 0) {
            s->wide--;
            s->open = kept;
            fill_groups(step, &l, s, l.first_joint);
        } else {
            for (uint32_t k = 0; k < s->nodes; k++) {
                tl_linkage_of(h)[tl_linkage_order(h)[l.first_joint + s->nodes - 1u - k]] = l.first_place + k;
            }
        }
        l.wide = s->open == kept;
        linkages[kept++] = l;
    }
    h->linkages = h->counters.linkages = kept;
}

/* What hangs between several fixed places may be taut, and were it rigid no force would be too much for it: a straight
 * string bears a load across with an infinite pull alone. So its joints stretch by this many of the ways that their
 * pull, unopposed, would move them in a sub-step (a constraint's compliance: Tournier et al., see stages.h). */
#define STRUNG_SOFT 1e-3f

static int is_strung(const tl_header *h, const tl_linkage *l) {
    const tl_block_node *node = tl_linkage_nodes(h) + l->first_node;
    uint32_t held = 0;
    for (uint32_t k = 0; k < l->nodes; k++) {
        held += node[k].end[0] == TL_BLOCK_FREE || node[k].end[1] == TL_BLOCK_FREE;
    }
    return held > 1u;
}

void tl_linkages_soften(tl_header *h) {
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        int strung = is_strung(h, l);
        l->exact &= !strung; /* it gives before the move only */
        for (uint32_t k = 0; k < l->nodes && strung; k++) {
            uint32_t place = tl_linkage_places(h)[l->first_place + k];
            tl_joint_group *g = &tl_joint_group_pool(h)[place / TL_LANES];
            g->gives = 1u;
            for (uint32_t lane = place % TL_LANES, last = l->wide ? TL_LANES : lane + 1u; lane < last; lane++) {
                g->soft[lane] = STRUNG_SOFT;
            }
        }
    }
}

/* Whether all awake joints are sure to get a row. */
static int rows_suffice(const tl_header *h) {
    uint32_t rows = 0;
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        rows += tl_joints(h)[tl_awake_joint(h)[k]].rows;
    }
    return rows <= h->capacity[TL_COUNT_JOINTROW];
}

void tl_linkages_find(tl_step *step) {
    tl_header *h = step->h;
    finder f = {h, 0, 0, 0, 0, 0, 0, 0};
    h->linkages = 0;
    h->counters.joints_apart = h->counters.linkages = 0;
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        tl_linkage_of(h)[tl_awake_joint(h)[k]] = TL_LINKAGE_NONE;
    }
    if (h->awake_joints == 0 || !rows_suffice(h)) {
        return;
    }
    memset(tl_linkage_rows(h), 0, step->rows * sizeof(uint32_t));
    find_components(step, &f);
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        uint32_t *of = &tl_linkage_of(h)[tl_awake_joint(h)[k]];
        *of = *of == TL_LINKAGE_APART ? TL_LINKAGE_NONE : *of;
    }
    place_linkages(step, &f);
}

void tl_linkages_note_exact(tl_header *h) {
    uint32_t shared = 1u;
    for (uint32_t i = 0; i < h->linkages; i++) {
        shared &= tl_linkages(h)[i].wide ? 1u : tl_linkages(h)[i].exact;
    }
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        l->exact = l->wide ? l->exact : shared;
        for (uint32_t k = 0; k < l->nodes && !l->exact; k++) {
            tl_joint_group_pool(h)[tl_linkage_places(h)[l->first_place + k] / TL_LANES].exact = 0;
        }
    }
}

/* --- stiffness -------------------------------------------------------------------------------- */

static void set_turns(tl_header *h, uint32_t row, float turns) {
    float *now = &tl_row_velocity(h)[row].f[7];
    if (*now > 0.0f && *now != turns) {
        *now = tl_row_before(h)[row].f[7] = tl_row_push(h)[row].f[7] = turns;
    }
}

void tl_stage_stiffness(tl_step *step) {
    tl_header *h = step->h;
    float *stiffness = tl_row_stiffness(h);
    const tl_joint_group *groups = tl_joint_group_pool(h);
    uint32_t stiff = 0;
    for (uint32_t i = 0; i < h->joint_groups && h->linkages; i++) {
        stiff |= groups[i].stiff;
    }
    if (!stiff && !step->stiff) {
        return;
    }
    memset(stiffness, 0, step->rows * sizeof(float));
    for (uint32_t i = 0; i < h->joint_groups; i++) {
        const tl_joint_group *g = &groups[i];
        const uint32_t lanes = g->linked ? g->lanes : 0u;
        float of_a[TL_LANES], of_b[TL_LANES], sub = step->sub;
        for (uint32_t k = 0; k < TL_LANES && lanes; k++) {
            of_a[k] = g->pull[k] * g->give[0][k] * sub, of_b[k] = g->pull[k] * g->give[1][k] * sub;
        }
        for (uint32_t k = 0; k < lanes; k++) {
            stiffness[g->a[k]] += of_a[k];
            stiffness[g->b[k]] += of_b[k];
        }
    }
    step->stiff = 0;
    for (uint32_t row = 1; row <= h->awake_bodies; row++) {
        int beyond = stiffness[row] > TL_MOST_STIFF;
        step->stiff |= beyond;
        set_turns(h, row, beyond ? TL_MOST_STIFF / stiffness[row] : 1.0f);
    }
}

/* --- what is far -------------------------------------------------------------------------------- */

static uint32_t far_of(const tl_header *h, const tl_linkage *l) {
    uint32_t far = 0;
    for (uint32_t k = 0; k < l->nodes; k++) {
        far |= tl_joint_group_pool(h)[tl_linkage_places(h)[l->first_place + k] / TL_LANES].far & TL_FAR_NOW;
    }
    return far;
}

static void set_far(const tl_header *h, const tl_linkage *l, uint32_t far) {
    for (uint32_t k = 0; k < l->nodes; k++) {
        tl_joint_group_pool(h)[tl_linkage_places(h)[l->first_place + k] / TL_LANES].far = far;
    }
}

int tl_stage_far_linkages(tl_header *h) {
    uint32_t any = 0, shared = 0;
    for (uint32_t i = 0; i < h->joint_groups && h->linkages; i++) {
        any |= tl_joint_group_pool(h)[i].linked ? tl_joint_group_pool(h)[i].far & ~(uint32_t)TL_FAR_NOT : 0u;
    }
    if (!any) {
        return 0;
    }
    any = 0;
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        l->far = far_of(h, l);
        any |= l->far;
        shared |= l->wide ? 0u : l->far;
    }
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        l->far = l->wide ? l->far : shared;
        set_far(h, l, l->far ? (uint32_t)TL_FAR_AGAIN : 0u);
    }
    return any != 0;
}

/* --- what is near ------------------------------------------------------------------------------- */

/* TL_FAR_NOT if all joints of a linkage are near, else 0. */
static uint32_t near_of(const tl_header *h, const tl_linkage *l) {
    uint32_t near = l->exact ? (uint32_t)TL_FAR_NOT : 0u;
    for (uint32_t k = 0; k < l->nodes && near; k++) {
        near = tl_joint_group_pool(h)[tl_linkage_places(h)[l->first_place + k] / TL_LANES].far & TL_FAR_NOT;
    }
    return near;
}

void tl_stage_near_linkages(tl_header *h) {
    uint32_t shared = TL_FAR_NOT;
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        l->near = near_of(h, l);
        shared &= l->wide ? shared : l->near;
    }
    for (uint32_t i = 0; i < h->linkages; i++) {
        tl_linkage *l = &tl_linkages(h)[i];
        l->near = l->wide ? l->near : shared;
        for (uint32_t k = 0; k < l->nodes && !l->near; k++) {
            tl_joint_group_pool(h)[tl_linkage_places(h)[l->first_place + k] / TL_LANES].far &= ~(uint32_t)TL_FAR_NOT;
        }
    }
}
