/* Groups: constraints that may be solved side by side, eight at a time. Within a colour no two share a moving body, so
 * the lanes of a group write to different rows. What found no colour is packed as it comes, as long as nothing is
 * shared. */
#include <stddef.h>
#include <string.h>

#include "stage/row/groups.h"

/* Order: by colour, and within it by plane and by how many points there are, so that groups are of a kind. */
#define KINDS 4u         /* of a colour */
#define PLANAR_KINDS 16u /* where there are planes */
#define KEYS ((TL_COLORS + 1u) * PLANAR_KINDS)

static uint32_t contact_key(const tl_contact_meta *m, const uint32_t *plane) {
    return plane ? m->color * PLANAR_KINDS + tl_plane_of(*plane) * 4u + (4u - tl_plane_points(*plane))
                 : m->color * KINDS + (4u - m->count);
}

/* Sorts the touching contacts by key into contact_order; counting sort. Returns their number. */
static inline uint32_t order_by_key(tl_header *h, const uint32_t *planes) {
    uint32_t start[KEYS + 1u], total = 0, most = 0;
    const tl_contact_meta *metas = tl_contacts(h);
    const uint32_t *awake = tl_awake_contact(h);
    if (h->awake_contacts == 0) {
        return 0;
    }
    memset(start, 0, ((TL_COLORS + 1u) * (planes ? PLANAR_KINDS : KINDS) + 1u) * sizeof *start);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        const tl_contact_meta *m = &metas[awake[k]];
        if (m->flags & TL_CONTACT_COLORED) {
            uint32_t key = contact_key(m, planes ? &planes[awake[k]] : NULL);
            start[key]++;
            most = key > most ? key : most;
            h->counters.contact_points += m->count;
        }
    }
    for (uint32_t i = 0; i <= most; i++) {
        uint32_t n = start[i];
        start[i] = total;
        total += n;
    }
    uint32_t *order = tl_contact_order(h);
    for (uint32_t k = 0; k < h->awake_contacts; k++) {
        const tl_contact_meta *m = &metas[awake[k]];
        if (m->flags & TL_CONTACT_COLORED) {
            order[start[contact_key(m, planes ? &planes[awake[k]] : NULL)]++] = awake[k];
        }
    }
    return total;
}

static uint32_t order_contacts(tl_header *h) { return order_by_key(h, NULL); }
static uint32_t order_planar_contacts(tl_header *h) { return order_by_key(h, tl_contact_plane(h)); }

/* Whether a row of a moving body is in the group already. */
static int holds_row(const uint32_t *a, const uint32_t *b, uint32_t lanes, uint32_t row) {
    for (uint32_t k = 0; k < lanes; k++) {
        if (a[k] == row || b[k] == row) {
            return row != 0;
        }
    }
    return 0;
}

static tl_contact_group *open_group(tl_header *h) {
    if (h->groups >= h->capacity[TL_COUNT_GROUP]) {
        return NULL;
    }
    tl_contact_group *g = &tl_group_pool(h)[h->groups++];
    memset(g->a, 0, sizeof g->a);
    memset(g->b, 0, sizeof g->b);
    memset(g->contact, 0, sizeof g->contact);
    g->lanes = g->points = g->pressed = g->met = g->plane = 0;
    return g;
}

void tl_stage_contact_groups(tl_step *step) {
    tl_header *h = step->h;
    const tl_contact_meta *metas = tl_contacts(h);
    const uint32_t *rows = tl_body_row(h);
    tl_row8 *moves = tl_row_moved(h);
    tl_contact_planes(step);
    const uint32_t *planes = step->planar ? tl_contact_plane(h) : NULL;
    uint32_t count = planes ? order_planar_contacts(h) : order_contacts(h), color = TL_NONE, colors = 0, dropped = 0;
    tl_contact_group *g = NULL;
    h->groups = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t c = tl_contact_order(h)[k];
        const tl_contact_meta *m = &metas[c];
        uint32_t a = rows[m->body_a], b = rows[m->body_b];
        uint32_t plane = planes ? tl_plane_of(planes[c]) : 0u, points = planes ? tl_plane_points(planes[c]) : m->count;
        int shared =
            g && m->color == TL_COLORS && (holds_row(g->a, g->b, g->lanes, a) || holds_row(g->a, g->b, g->lanes, b));
        colors += m->color != color;
        if (!g || m->color != color || g->lanes == TL_LANES || shared || g->plane != plane) {
            g = open_group(h);
            color = m->color;
        }
        if (!g) {
            dropped++;
            continue;
        }
        g->a[g->lanes] = a;
        g->b[g->lanes] = b;
        g->contact[g->lanes++] = c;
        g->points = points > g->points ? points : g->points;
        g->plane = plane;
        moves[a].f[7] = moves[b].f[7] = 1.0f;
    }
    h->counters.contacts_touching = count;
    h->counters.colors = colors;
    h->counters.lane_groups = h->groups;
    h->counters.lanes_used = count - dropped;
    h->counters.rows.used = h->groups;
    h->counters.rows.high_water = h->groups > h->counters.rows.high_water ? h->groups : h->counters.rows.high_water;
    h->counters.rows.capacity = h->capacity[TL_COUNT_GROUP];
    h->counters.rows.dropped = dropped;
}

/* --- joints ----------------------------------------------------------------------------------- */

int tl_joints_alike(const tl_joint_record *a, const tl_joint_record *b) {
    return a->rows == b->rows && a->fixed == b->fixed && a->free_axis == b->free_axis &&
           memcmp(a->code, b->code, sizeof a->code) == 0;
}

/* Passes over one joint at a time need impulses that turn with the bodies, and so rows that do. */
static uint32_t needs_of(const tl_joint_record *j, uint32_t direct) {
    uint32_t plain = j->fixed >= 3u, point = plain & direct, turn = 0;
    for (uint32_t r = 0; r < j->rows; r++) {
        uint32_t type = j->code[r] % TL_ROW_TYPES, linear = type < TL_ROW_ANGULAR, distance = type == TL_ROW_DISTANCE;
        point &= r >= 3u || j->code[r] == TL_ROW_LINEAR + r + TL_ROW_TYPES * TL_ROW_EQUAL;
        plain &= r >= j->fixed || (r < 3u ? linear : !(linear | distance));
        turn |= !(linear | distance) && !(type >= TL_ROW_SWING && type < TL_ROW_CONE);
    }
    uint32_t axes = j->rows > (point ? 3u : 0u);
    return (point ? (uint32_t)TL_JOINT_POINT : 0u) | (axes ? (uint32_t)TL_JOINT_AXES : 0u) |
           (turn ? (uint32_t)TL_JOINT_TURN : 0u) | (plain ? (uint32_t)TL_JOINT_PLAIN : 0u);
}

tl_joint_group *tl_joint_group_open(tl_header *h, const tl_joint_record *j, uint32_t direct) {
    if (h->joint_groups >= h->capacity[TL_COUNT_JOINTGROUP] ||
        h->joint_rows + j->rows > h->capacity[TL_COUNT_JOINTROW]) {
        return NULL;
    }
    tl_joint_group *g = &tl_joint_group_pool(h)[h->joint_groups++];
    memset(g, 0, offsetof(tl_joint_group, k));
    for (uint32_t r = 0; r < 3u; r++) { /* the force of lanes without a joint */
        memset(g->x[r], 0, sizeof g->x[r]);
    }
    for (uint32_t k = 0; k < TL_LANES; k++) {
        g->qa[3][k] = g->qb[3][k] = 1.0f;
    }
    g->rows = j->rows, g->fixed = j->fixed, g->exact = direct, g->needs = needs_of(j, direct);
    g->first_row = h->joint_rows;
    g->free_axis = j->free_axis == TL_NONE ? 0u : j->free_axis;
    memcpy(g->code, j->code, sizeof g->code);
    for (uint32_t r = 0; r < TL_LINK_ROWS && r < g->fixed; r++) {
        for (uint32_t k = 0; k < TL_LANES; k++) {
            g->active[r][k] = 1.0f;
        }
    }
    for (uint32_t r = 0; r < j->rows; r++) {
        tl_joint_row *row = &tl_joint_row_pool(h)[g->first_row + r];
        if (r < j->fixed) { /* an equality has no more */
            memset(row->lower, 0, sizeof row->lower);
            memset(row->impulse, 0, sizeof row->impulse);
        } else {
            memset(row->lower, 0, sizeof *row - offsetof(tl_joint_row, lower));
        }
    }
    h->joint_rows += j->rows;
    return g;
}

void tl_joint_group_add(const tl_step *step, tl_joint_group *g, uint32_t joint) {
    tl_header *h = step->h;
    const tl_joint_record *j = &tl_joints(h)[joint];
    const tl_joint_state *s = &tl_joint_states(h)[joint];
    uint32_t k = g->lanes++;
    g->a[k] = tl_body_row(h)[j->body_a];
    g->b[k] = tl_body_row(h)[j->body_b];
    g->joint[k] = joint;
    talus_pose a = j->place_a, b = j->place_b;
    /* A body without a row stands at the origin: its frame is given in the world. */
    if (g->a[k] == 0) {
        talus_pose body = tl_row_pose_of(&tl_body_pose(h)[j->body_a]);
        a = tl_pose_mul(&body, &a);
    }
    if (g->b[k] == 0) {
        talus_pose body = tl_row_pose_of(&tl_body_pose(h)[j->body_b]);
        b = tl_pose_mul(&body, &b);
    }
    g->pa[0][k] = a.position.x, g->pa[1][k] = a.position.y, g->pa[2][k] = a.position.z;
    g->pb[0][k] = b.position.x, g->pb[1][k] = b.position.y, g->pb[2][k] = b.position.z;
    g->qa[0][k] = a.rotation.x, g->qa[1][k] = a.rotation.y, g->qa[2][k] = a.rotation.z, g->qa[3][k] = a.rotation.w;
    g->qb[0][k] = b.rotation.x, g->qb[1][k] = b.rotation.y, g->qb[2][k] = b.rotation.z, g->qb[3][k] = b.rotation.w;
    tl_joint_row *rows = tl_joint_row_pool(h) + g->first_row;
    for (uint32_t r = 0; r < j->rows; r++) {
        const tl_joint_param *p = &j->param[r];
        rows[r].lower[k] = p->lower;
        rows[r].impulse[k] = s->impulse[r] * step->warm_scale;
        if (r < j->fixed) {
            continue; /* an equality has no more */
        }
        rows[r].upper[k] = p->upper;
        rows[r].stiffness[k] = p->stiffness, rows[r].damping[k] = p->damping;
        rows[r].speed[k] = p->speed, rows[r].most[k] = p->most, rows[r].per_mass[k] = p->per_mass;
    }
    for (uint32_t r = 0; r < 3u && g->linked; r++) {
        g->x[r][k] = s->force[r];
    }
    tl_row8 *moves = tl_row_moved(h);
    moves[g->a[k]].f[7] = moves[g->b[k]].f[7] = 1.0f;
}

/* Awake joints by colour; counting sort. */
static uint32_t order_joints(tl_header *h) {
    uint32_t start[TL_COLORS + 2u], total = 0, most = 0;
    const uint32_t *awake = tl_awake_joint(h);
    uint32_t *order = tl_joint_order(h);
    if (h->awake_joints == 0) {
        return 0;
    }
    memset(start, 0, sizeof start);
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        uint32_t color = tl_joints(h)[awake[k]].color;
        start[color]++;
        most = color > most ? color : most;
    }
    for (uint32_t i = 0; i <= most; i++) {
        uint32_t n = start[i];
        start[i] = total;
        total += n;
    }
    for (uint32_t k = 0; k < h->awake_joints; k++) {
        order[start[tl_joints(h)[awake[k]].color]++] = awake[k];
    }
    return total;
}

/* The open group of a joint's kind in its colour that still has a free lane. */
static tl_joint_group *find_group(tl_header *h, uint32_t first, uint32_t joint, int linked, uint32_t direct,
                                  uint32_t loose) {
    const tl_joint_record *joints = tl_joints(h), *j = &joints[joint];
    const uint32_t *rows = tl_body_row(h);
    for (uint32_t i = h->joint_groups; i-- > first;) {
        tl_joint_group *g = &tl_joint_group_pool(h)[i];
        int shared = j->color == TL_COLORS && (holds_row(g->a, g->b, g->lanes, rows[j->body_a]) ||
                                               holds_row(g->a, g->b, g->lanes, rows[j->body_b]));
        if (g->lanes < TL_LANES && !shared && (g->linked > 0) == linked && g->exact == direct && g->gives == loose &&
            tl_joints_alike(&joints[g->joint[0]], j)) {
            return g;
        }
        if (j->color == TL_COLORS || h->joint_groups - i > 16u) { /* looking far back costs more than a lane */
            break;
        }
    }
    return NULL;
}

void tl_stage_joint_groups(tl_step *step) {
    tl_header *h = step->h;
    h->joint_groups = h->joint_rows = 0;
    tl_linkages_find(step);
    uint32_t count = order_joints(h), color = TL_NONE, first = h->joint_groups, dropped = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t joint = tl_joint_order(h)[k], place = tl_linkage_of(h)[joint];
        const tl_joint_record *j = &tl_joints(h)[joint];
        if (j->color != color) {
            color = j->color;
            first = h->joint_groups;
        }
        if (j->rows == 0 || place == TL_LINKAGE_READY) {
            continue;
        }
        uint32_t loose = place == TL_LINKAGE_LOOSE, direct = place != TL_LINKAGE_NONE && !loose;
        int linked = direct && place != TL_LINKAGE_ALONE;
        tl_joint_group *g = find_group(h, first, joint, linked, direct, loose);
        if (!g) {
            g = tl_joint_group_open(h, j, direct);
        }
        if (!g) {
            dropped++;
            continue;
        }
        g->gives = loose;
        if (linked) {
            g->linked = tl_linked_rows(j);
            tl_linkage_places(h)[place] = (uint32_t)(g - tl_joint_group_pool(h)) * TL_LANES + g->lanes;
        }
        tl_joint_group_add(step, g, joint);
    }
    tl_linkages_soften(h);
    tl_linkages_note_exact(h);
    h->counters.joints_solved = count - dropped;
    h->counters.joints_sleeping = h->joints.used - h->awake_joints;
    h->counters.rows.dropped += dropped;
}
