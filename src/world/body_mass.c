/* A body's mass, and the mass frame that follows from it: the centre of mass with the principal axes of inertia. */
#include <string.h>

#include "base/eigen.h"
#include "collide/collide.h"
#include "geom/mass.h"
#include "stage/broad/refit.h"
#include "talus/body.h"
#include "talus/shape.h"
#include "world/command.h"
#include "world/world_internal.h"

/* An axis with less of this share of the largest principal inertia is taken as one about which nothing turns. */
#define LEAST_INERTIA 1e-12f
/* Principal inertias closer than this share have no gyroscopic term worth its time. */
#define ROUND 1e-5f

/* m: no point of the shape is further from the frame's origin. Exact for balls and boxes. */
static float reach_of(const tl_convex *shape, const talus_pose *place) {
    const talus_geometry *g = &shape->geometry;
    if (g->type == TALUS_SPHERE) {
        return tl_length(place->position) + g->radius;
    }
    if (g->type == TALUS_CAPSULE) {
        talus_vec3 up = tl_rotate(place->rotation, tl_v(0.0f, g->half_height, 0.0f));
        return tl_max(tl_length(tl_add(place->position, up)) + g->radius_top,
                      tl_length(tl_sub(place->position, up)) + g->radius_bottom);
    }
    if (g->type == TALUS_BOX) {
        talus_mat3 m = tl_mat3_from_quat(place->rotation);
        talus_vec3 own = tl_abs3(tl_mat3_mul_t(&m, place->position));
        return tl_length(tl_add(own, g->half));
    }
    talus_aabb box = tl_convex_aabb(shape, place);
    float corner = tl_length(tl_max3(tl_abs3(box.lower), tl_abs3(box.upper)));
    if (g->type == TALUS_HULL) {
        corner = tl_min(corner, tl_length(tl_pose_point(place, shape->hull->centroid)) + shape->hull->outer_radius);
    }
    return corner;
}

/* Places the body's shapes in the mass frame. */
static void place_shapes(const talus_world *world, uint32_t body) {
    tl_header *h = tl_header_of(world);
    talus_pose frame = tl_row_pose_of(&tl_body_frame(h)[body]);
    float reach = 0.0f;
    for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
        talus_pose place = tl_pose_relative(&frame, &tl_shape_pose(h)[s]);
        place.rotation = tl_quat_normalize(place.rotation);
        tl_convex convex = {tl_shape_geometry(h)[s], NULL};
        convex.hull = tl_geometry_hull(&convex.geometry, world->geometry);
        tl_row_set_pose(&tl_shape_place(h)[s], &place);
        float own = reach_of(&convex, &place);
        tl_shape_place(h)[s].f[7] = own;
        reach = tl_max(reach, own);
        tl_shape_mark_moved(h, s);
    }
    tl_body_inertias(h)[body].reach = reach;
}

static void set_principal(tl_header *h, uint32_t body, const float values[3]) {
    tl_body_inertia *in = &tl_body_inertias(h)[body];
    float most = tl_max(values[0], tl_max(values[1], values[2])), least = most;
    for (int k = 0; k < 3; k++) {
        in->s[k] = values[k] > LEAST_INERTIA * most ? 1.0f / sqrtf(values[k]) : 0.0f;
        least = tl_min(least, values[k]);
    }
    if (most - least > ROUND * most && least > LEAST_INERTIA * most) {
        tl_bodies(h)[body].flags |= TL_BODY_GYRO;
    } else {
        tl_bodies(h)[body].flags &= ~(uint32_t)TL_BODY_GYRO;
    }
}

void tl_body_take_mass(talus_world *world, uint32_t body, const talus_mass *mass) {
    tl_header *h = tl_header_of(world);
    tl_body_inertia *in = &tl_body_inertias(h)[body];
    uint32_t type = tl_body_type(&tl_bodies(h)[body]);
    talus_pose origin = tl_body_origin(h, body), frame = {mass->center, tl_quat_identity()};
    talus_vec3 old = tl_row_xyz(&tl_body_pose(h)[body]);
    float values[3] = {0.0f, 0.0f, 0.0f};
    tl_body_mass(h)[body] = *mass;
    memset(&tl_body_momentum(h)[body], 0, sizeof(tl_row8));
    if (type == TALUS_DYNAMIC) {
        tl_principal_axes(&mass->inertia, &frame.rotation, values);
        in->inverse_mass = mass->mass > 0.0f ? 1.0f / mass->mass : 0.0f;
        set_principal(h, body, values);
    } else {
        in->inverse_mass = 0.0f;
        in->s[0] = in->s[1] = in->s[2] = 0.0f;
    }
    tl_row_set_pose(&tl_body_frame(h)[body], &frame);
    talus_pose place = tl_pose_mul(&origin, &frame);
    place.rotation = tl_quat_normalize(place.rotation);
    tl_row_set_pose(&tl_body_pose(h)[body], &place);
    tl_body_previous(h)[body] = tl_body_pose(h)[body];
    tl_row8 *v = &tl_body_velocity(h)[body];
    talus_vec3 spin = tl_row_345(v), moved = tl_sub(place.position, old);
    tl_row_set6(v, tl_add(tl_row_xyz(v), tl_cross(spin, moved)), spin);
    place_shapes(world, body);
    tl_contacts_refresh(h, body);
    for (uint32_t l = tl_bodies(h)[body].first_joint; l != TL_NONE;) {
        tl_joint_record *j = &tl_joints(h)[l >> 1];
        uint32_t side = l & 1u;
        tl_joint_place(h, j);
        l = j->next[side];
    }
}

void tl_body_update_mass(talus_world *world, uint32_t body) {
    tl_header *h = tl_header_of(world);
    if (tl_bodies(h)[body].flags & TL_BODY_MASS_SET) {
        place_shapes(world, body);
        return;
    }
    talus_mass sum;
    memset(&sum, 0, sizeof sum);
    if (tl_body_type(&tl_bodies(h)[body]) != TALUS_STATIC) {
        for (uint32_t s = tl_bodies(h)[body].first_shape; s != TL_NONE; s = tl_shapes(h)[s].next) {
            const tl_shape_meta *shape = &tl_shapes(h)[s];
            talus_mass own;
            if ((shape->flags & TL_SHAPE_SENSOR) ||
                talus_geometry_mass(&tl_shape_geometry(h)[s], world->geometry, world->geometry_bytes, shape->density,
                                    &own) != TALUS_OK) {
                continue;
            }
            own = talus_mass_move(&own, &tl_shape_pose(h)[s]);
            sum = talus_mass_add(&sum, &own);
        }
    }
    if (!(sum.mass > 0.0f && tl_is_finite(sum.mass) && tl_is_finite_mat3(&sum.inertia) && tl_is_finite3(sum.center))) {
        /* Without anything heavy a dynamic body is a kilogram of one metre's radius of gyration. */
        memset(&sum, 0, sizeof sum);
        sum.mass = 1.0f;
        sum.inertia.x.x = sum.inertia.y.y = sum.inertia.z.z = 1.0f;
    }
    tl_body_take_mass(world, body, &sum);
}

talus_status talus_body_get_mass(const talus_world *world, talus_body body, talus_mass *out) {
    uint32_t i;
    talus_status status = out ? tl_find_body(world, body, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_body_mass(tl_header_of(world))[i];
    }
    return status;
}

/* Symmetric, with principal moments that are not negative, up to rounding. */
static int is_inertia(const talus_mat3 *m) {
    float scale = tl_max(m->x.x, tl_max(m->y.y, m->z.z)), slack = 1e-4f * scale, moment[3];
    talus_quat axes;
    if (m->x.x < 0.0f || m->y.y < 0.0f || m->z.z < 0.0f || tl_abs(m->x.y - m->y.x) > slack ||
        tl_abs(m->x.z - m->z.x) > slack || tl_abs(m->y.z - m->z.y) > slack) {
        return 0;
    }
    tl_principal_axes(m, &axes, moment);
    return moment[0] >= -slack && moment[1] >= -slack && moment[2] >= -slack;
}

talus_status tl_run_body_set_mass(talus_world *world, uint32_t i, talus_command *c) {
    const talus_mass *mass = &c->as.mass;
    if (!tl_is_finite(mass->mass) || !tl_is_finite_mat3(&mass->inertia)) {
        return TALUS_NOT_FINITE;
    }
    talus_status status = tl_check_point(mass->center);
    if (status != TALUS_OK) {
        return status;
    }
    if (mass->mass < 0.0f || (mass->mass > 0.0f && mass->mass < 1e-30f) || !is_inertia(&mass->inertia)) {
        return TALUS_BAD_MASS;
    }
    tl_header *h = tl_header_of(world);
    tl_island_wake(h, i);
    tl_bodies(h)[i].flags |= TL_BODY_MASS_SET;
    tl_body_take_mass(world, i, mass);
    return TALUS_OK;
}

talus_status tl_run_body_mass_from_shapes(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    tl_header *h = tl_header_of(world);
    tl_island_wake(h, i);
    tl_bodies(h)[i].flags &= ~(uint32_t)TL_BODY_MASS_SET;
    tl_body_update_mass(world, i);
    return TALUS_OK;
}
