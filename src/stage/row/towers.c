/* Towers: bodies that stand on each other, each on one alone.
 *
 * A contact is a spring: of stiffness k, with its points r away from their middle, it keeps upright a mass m whose
 * centre is l above it while k r^2 > m g l. Of such hinges upon each other all give a little, and the tower leans until
 * it falls where the sum of m g l / (k r^2) comes to 1 (Dunkerley's estimate, which is on the safe side). Springs
 * cannot be made stiffer than the sub-steps follow, and so towers of many bodies, or of a few small ones, are to be
 * pressed. */
#include <math.h>

#include "base/spread.h"
#include "stage/row/groups.h"

#define LEANING 0.9f /* of what makes a tower fall: from here on it is pressed */
#define UPRIGHT 0.9f /* the cosine between gravity and the normals of a tower */
#define FACE 3u      /* points of a contact that does not roll */
#define LEAST_BODIES 3u

static int is_one(uint64_t bits) { return bits && !(bits & (bits - 1u)); }
static int is_two(uint64_t bits) { return bits && is_one(bits & (bits - 1u)); }
static int is_free(const tl_header *h, uint32_t body) { return tl_bodies(h)[body].first_joint == TL_NONE; }

int tl_towers_likely(const tl_header *h) {
    uint32_t tops = 0, inner = 0;
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint64_t colors = tl_body_colors(h)[tl_awake_body(h)[k]];
        tops += (uint32_t)is_one(colors);
        inner += (uint32_t)is_two(colors);
    }
    return tops > 0 && inner + 2u >= LEAST_BODIES;
}

/* What stands on a tower's contact as the way down has it. */
typedef struct tower {
    const tl_step *step;
    talus_vec3 up;
    float gravity;      /* m/s^2 */
    float mass, moment; /* kg, and kg m along `up` */
    float lean;         /* of what makes it fall */
} tower;

/* The contact that a body of a tower has beside `but`, or TL_NONE. */
static uint32_t other_contact(const tl_header *h, uint32_t body, uint32_t but) {
    for (uint32_t link = tl_body_links(h)[body].first_pair; link != TL_NONE;
         link = tl_pair_links(h)[link / 2u].next[link & 1u]) {
        uint32_t contact = tl_pairs(h)[link / 2u].contact;
        if (contact != TL_NONE && contact != but && (tl_contacts(h)[contact].flags & TL_CONTACT_COLORED)) {
            return contact;
        }
    }
    return TL_NONE;
}

/* m^2: of the points on the body above from their middle, along the axis across n on which they are closest, which all
 * are in its frame. */
static float spread_of(const tl_contact_points *points, uint32_t count, uint32_t side, talus_vec3 n, talus_vec3 *mean) {
    talus_vec3 arm[TL_MANIFOLD_POINTS];
    for (uint32_t k = 0; k < count; k++) {
        const float *p = side ? points->p[k].b : points->p[k].a;
        arm[k] = tl_v(p[0], p[1], p[2]);
    }
    tl_spread s = tl_spread_of(arm, count, n);
    float half = 0.5f * (s.xx - s.yy);
    *mean = s.mean;
    return (0.5f * (s.xx + s.yy) - sqrtf(half * half + s.xy * s.xy)) / (float)count;
}

/* Adds the body and the contact that it stands on; returns whether it stands on that. */
static int stands_on(tower *t, uint32_t body, uint32_t contact) {
    const tl_header *h = t->step->h;
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    const float *normal = tl_heads(h)[contact].normal;
    uint32_t side = m->body_b == body, row = tl_body_row(h)[body];
    talus_vec3 n = tl_v(normal[0], normal[1], normal[2]);
    float along = tl_dot(n, t->up);
    if (m->count < FACE || !((side ? along : -along) > UPRIGHT)) {
        return 0;
    }
    talus_pose at = tl_row_pose_of(&tl_row_pose(h)[row]);
    talus_vec3 up = tl_rotate_back(at.rotation, t->up), mean;
    float inverse = tl_row_velocity(h)[row].f[6], mass = 1.0f / inverse, height = tl_dot(t->up, at.position);
    t->mass += mass;
    t->moment += mass * height;
    float spread = spread_of(&tl_points(h)[contact], m->count, side, tl_rotate_back(at.rotation, n), &mean);
    float fall = t->gravity * (t->moment - t->mass * (height + tl_dot(up, mean))); /* N m */
    float both = inverse + tl_row_velocity(h)[tl_body_row(h)[side ? m->body_a : m->body_b]].f[6];
    float hold = t->step->spring * t->step->inverse_sub / both * spread; /* N m */
    t->lean += fall > 0.0f ? fall / tl_max(hold, 1e-6f * fall) : 0.0f;
    return 1;
}

/* From the top down while bodies stand on one alone; returns how many there are, and their rows in `rows`. */
static uint32_t go_down(tower *t, uint32_t top, uint32_t *rows, uint32_t most) {
    const tl_header *h = t->step->h;
    uint32_t count = 0, body = top, contact = TL_NONE;
    t->mass = t->moment = t->lean = 0.0f;
    for (;;) {
        contact = other_contact(h, body, contact);
        if (count == most || contact == TL_NONE || !is_free(h, body) || !stands_on(t, body, contact)) {
            return count;
        }
        rows[count++] = tl_body_row(h)[body];
        const tl_contact_meta *m = &tl_contacts(h)[contact];
        body = m->body_a == body ? m->body_b : m->body_a;
        if (!tl_body_row(h)[body] || !is_two(tl_body_colors(h)[body])) {
            return count;
        }
    }
}

uint32_t tl_towers_find(const tl_step *step, uint32_t *pressed, uint32_t room) {
    const tl_header *h = step->h;
    float gravity = tl_length(h->settings.gravity);
    uint32_t rows[TL_MOST_PRESSED], found = 0;
    if (!(gravity > 0.0f)) {
        return 0;
    }
    tower t = {step, tl_scale(h->settings.gravity, -1.0f / gravity), gravity, 0.0f, 0.0f, 0.0f};
    for (uint32_t k = 0; k < h->awake_bodies; k++) {
        uint32_t top = tl_awake_body(h)[k];
        if (!is_one(tl_body_colors(h)[top])) {
            continue;
        }
        uint32_t count = go_down(&t, top, rows, TL_MOST_PRESSED);
        if (count < LEAST_BODIES || t.lean < LEANING || count > room - found) {
            continue;
        }
        for (uint32_t i = 0; i < count; i++) {
            pressed[rows[i]] = TL_TOWER;
        }
        found += count;
    }
    return found;
}
