/* Planes: contacts whose two bodies both stay in one plane across an axis of the world, be they locked to it, at rest
 * or moved along it. Nothing in such a contact goes across the plane: it has the normal and one tangent, and what lies
 * behind one another is one point. The bodies keep their places and shapes in space. */
#include "stage/row/groups.h"

#define ANY_PLANE 7u
#define OFF_PLANE 1e-4f  /* of a unit normal: beyond, a contact pushes across the plane */
#define SAME_POINT 1e-2f /* of the speculative margin: as far apart in the plane, records are one point */

/* Bit k: locked to the plane across axis k. */
static uint32_t planes_of_locks(uint32_t locks) {
    uint32_t planes = 0;
    for (uint32_t k = 0; k < 3u; k++) {
        planes |= (uint32_t)((locks & talus_lock_plane(k)) == talus_lock_plane(k)) << k;
    }
    return planes;
}

/* Bit k: it moves along the plane across axis k. */
static uint32_t planes_of_motion(const tl_row8 *velocity) {
    const float *v = velocity->f, *w = velocity->f + 3;
    uint32_t planes = 0;
    for (uint32_t k = 0; k < 3u; k++) {
        planes |= (uint32_t)(v[k] == 0.0f && w[(k + 1u) % 3u] == 0.0f && w[(k + 2u) % 3u] == 0.0f) << k;
    }
    return planes;
}

/* Fills row_planes; returns how many dynamic bodies have a plane. */
static uint32_t find_bodies(const tl_header *h) {
    uint32_t *planes = tl_row_planes(h), found = 0;
    planes[0] = ANY_PLANE;
    for (uint32_t row = 1; row <= h->awake_bodies; row++) {
        uint32_t body = tl_awake_body(h)[row - 1u], flags = tl_bodies(h)[body].flags;
        int dynamic = (flags & TL_BODY_TYPE) == TALUS_DYNAMIC;
        planes[row] = dynamic ? planes_of_locks(flags >> TL_BODY_LOCKS) : planes_of_motion(&tl_body_velocity(h)[body]);
        found += dynamic && planes[row] != 0;
    }
    return found;
}

/* The contact's records put together by where they lie in the plane across `axis`, which is in a's mass frame. */
static uint32_t word_of(const tl_contact_points *points, uint32_t count, talus_vec3 axis, uint32_t plane, float reach) {
    talus_vec3 at[TL_MANIFOLD_POINTS];
    uint32_t word = plane, found = 0;
    for (uint32_t r = 0; r < count; r++) {
        const float *a = points->p[r].a;
        talus_vec3 p = tl_v(a[0], a[1], a[2]);
        p = tl_mad(p, -tl_dot(p, axis), axis);
        uint32_t k = 0;
        while (k < found && !(tl_length2(tl_sub(p, at[k])) < reach * reach)) {
            k++;
        }
        if (k == found) {
            at[found++] = p;
            word |= r << (16u + 2u * k);
        }
        word |= k << (8u + 2u * r);
    }
    return word | found << 2;
}

/* Without a plane each record is a point. */
static uint32_t word_in_space(uint32_t count) { return count << 2 | (0u | 1u << 2 | 2u << 4 | 3u << 6) * 0x10100u; }

static uint32_t word_of_contact(const tl_header *h, uint32_t contact) {
    static const talus_vec3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    const float *normal = tl_heads(h)[contact].normal;
    uint32_t a = tl_body_row(h)[m->body_a], planes = tl_row_planes(h)[a] & tl_row_planes(h)[tl_body_row(h)[m->body_b]];
    for (uint32_t k = 0; planes >> k; k++) {
        talus_vec3 axis = tl_rotate_back(tl_row_quat(&tl_row_pose(h)[a]), axes[k]);
        if ((planes >> k & 1u) && tl_abs(tl_dot(axis, tl_v(normal[0], normal[1], normal[2]))) < OFF_PLANE) {
            return word_of(&tl_points(h)[contact], m->count, axis, k + 1u, SAME_POINT * h->settings.speculative_margin);
        }
    }
    return word_in_space(m->count);
}

void tl_contact_planes(tl_step *step) {
    tl_header *h = step->h;
    h->counters.bodies_planar = step->any_locks ? find_bodies(h) : 0;
    h->counters.contacts_planar = 0;
    step->planar = h->counters.bodies_planar > 0;
    for (uint32_t k = 0; step->planar && k < h->awake_contacts; k++) {
        uint32_t contact = tl_awake_contact(h)[k];
        if (tl_contacts(h)[contact].flags & TL_CONTACT_COLORED) {
            tl_contact_plane(h)[contact] = word_of_contact(h, contact);
            h->counters.contacts_planar += tl_plane_of(tl_contact_plane(h)[contact]) != 0;
        }
    }
}
