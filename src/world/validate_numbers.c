/* Whether the numbers of the state are ones that the library could have written: floats that are finite, rotations of
 * unit length, counts of what is in use that agree with it. */
#include "world/world_internal.h"

#define UNIT_SLACK 1e-3f /* how far the square of a rotation's length may be from 1 */

static int is_rotation(const float *q) {
    float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return tl_abs(square - 1.0f) <= UNIT_SLACK;
}

/* Which words of a row are floats, a bit each from the first one on, and where its rotation begins. */
typedef struct float_column {
    tl_column_id column;
    uint32_t floats;
    int rotation; /* -1: none */
} float_column;

static const float_column FLOATS[] = {
    {TL_COLUMN_body_pose, 0xffu, 3},      {TL_COLUMN_body_velocity, 0xffu, -1}, {TL_COLUMN_body_momentum, 0xffu, -1},
    {TL_COLUMN_body_inertias, 0xffu, -1}, {TL_COLUMN_body_frame, 0xffu, 3},     {TL_COLUMN_body_force, 0xffu, -1},
    {TL_COLUMN_body_quiets, 3u, -1},      {TL_COLUMN_body_efforts, 2u, -1},     {TL_COLUMN_body_mass, 0x1fffu, -1},
    {TL_COLUMN_shape_place, 0xffu, 3},    {TL_COLUMN_shape_material, 15u, -1},  {TL_COLUMN_shape_pose, 0x7fu, 3},
    {TL_COLUMN_heads, 0xffu, -1},         {TL_COLUMN_points, 0x7f7f7f7fu, -1},  {TL_COLUMN_joint_states, 0xfffffu, -1},
};

/* Rows that are in use; those that are free hold whatever they did before. */
static int is_in_use(const tl_header *h, tl_column_id column, uint32_t row) {
    switch (column) {
    case TL_COLUMN_shape_place:
    case TL_COLUMN_shape_material:
    case TL_COLUMN_shape_pose:
        return (tl_shapes(h)[row].flags & TL_SHAPE_ALIVE) != 0;
    case TL_COLUMN_heads:
    case TL_COLUMN_points:
        return (tl_contacts(h)[row].flags & TL_CONTACT_ALIVE) != 0;
    case TL_COLUMN_joint_states:
        return (tl_joints(h)[row].flags & TL_JOINT_ALIVE) != 0;
    default:
        return (tl_bodies(h)[row].flags & TL_BODY_ALIVE) != 0;
    }
}

static int column_is_sound(const tl_header *h, const float_column *c) {
    tl_live live;
    tl_store_state(h, c->column, &live);
    for (uint32_t row = 0; row < live.rows; row++) {
        const float *f = (const float *)(const void *)(live.data + (size_t)row * live.row_bytes);
        if (!is_in_use(h, c->column, row)) {
            continue;
        }
        for (uint32_t k = 0; c->floats >> k; k++) {
            if ((c->floats >> k & 1u) && !tl_is_finite(f[k])) {
                return 0;
            }
            if (k == 31u) {
                break;
            }
        }
        if (c->rotation >= 0 && !is_rotation(f + c->rotation)) {
            return 0;
        }
    }
    return 1;
}

static int inertia_is_sound(const tl_header *h, uint32_t i) {
    const tl_body_inertia *in = &tl_body_inertias(h)[i];
    const tl_body_meta *m = &tl_bodies(h)[i];
    int turns = in->s[0] > 0.0f && in->s[1] > 0.0f && in->s[2] > 0.0f;
    return in->inverse_mass >= 0.0f && in->s[0] >= 0.0f && in->s[1] >= 0.0f && in->s[2] >= 0.0f &&
           in->linear_damping >= 0.0f && in->angular_damping >= 0.0f && in->reach >= 0.0f &&
           (turns || !(m->flags & TL_BODY_GYRO)) && m->flags >> TL_BODY_LOCKS <= 63u;
}

static int material_is_sound(const tl_material *m) {
    return m->static_friction >= 0.0f && m->dynamic_friction >= 0.0f && m->restitution >= 0.0f &&
           m->restitution <= 1.0f && m->rolling_resistance >= 0.0f && m->friction_combine < TALUS_COMBINE_COUNT &&
           m->restitution_combine < TALUS_COMBINE_COUNT;
}

static int mix_is_sound(const tl_contact_material *m) {
    return m->static_friction >= 0.0f && m->dynamic_friction >= 0.0f && m->restitution >= 0.0f &&
           m->restitution <= 1.0f && m->rolling >= 0.0f;
}

int tl_numbers_are_sound(const tl_header *h) {
    for (size_t i = 0; i < sizeof FLOATS / sizeof *FLOATS; i++) {
        if (!column_is_sound(h, &FLOATS[i])) {
            return 0;
        }
    }
    if (!tl_is_finite(h->settings.substep) || h->settings.substep < 0.0f) {
        return 0;
    }
    for (uint32_t i = 0; i < h->bodies.high; i++) {
        if ((tl_bodies(h)[i].flags & TL_BODY_ALIVE) && !inertia_is_sound(h, i)) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < h->shapes.high; i++) {
        const tl_shape_meta *m = &tl_shapes(h)[i];
        if ((m->flags & TL_SHAPE_ALIVE) &&
            (!material_is_sound(&tl_shape_material(h)[i]) || !(m->density >= 0.0f && tl_is_finite(m->density)))) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < h->contacts.high; i++) {
        if ((tl_contacts(h)[i].flags & TL_CONTACT_ALIVE) && !mix_is_sound(&tl_contact_materials(h)[i])) {
            return 0;
        }
    }
    return 1;
}
