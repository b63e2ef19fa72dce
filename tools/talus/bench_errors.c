#include "bench_errors.h"

#include "figures.h"

#include <stdlib.h>
#include <string.h>

/* A collider where it stands. */
typedef struct bench_place {
    gltf_double3 position, low, high; /* its box */
    gltf_double4 rotation;
    uint32_t collider;
} bench_place;

typedef struct bench_part {
    gltf_double3 put; /* where its origin was at the beginning */
    talus_mass mass;
} bench_part;

/* A pose in a body's frame (GLTF_NONE: the world's) as the world sees it. */
static void place(const bench_judge *j, uint32_t body, const talus_pose *own, gltf_double3 *position,
                  gltf_double4 *rotation) {
    *position = gltf_of_vec3(own->position);
    *rotation = gltf_of_quat(own->rotation);
    if (body != GLTF_NONE) {
        talus_pose pose;
        talus_body_get_pose(&j->world->world, j->world->bodies[body], &pose);
        gltf_double4 turn = gltf_of_quat(pose.rotation);
        *position = gltf_add3(gltf_of_vec3(pose.position), gltf_rotate(turn, *position));
        *rotation = gltf_mul4(turn, *rotation);
    }
}

/* --- overlaps --- */

/* The radius of a ball about the shape's origin that holds it. */
static double reach(const talus_convex *c) {
    const talus_geometry *g = &c->geometry;
    double most = fmax((double)g->radius_top, (double)g->radius_bottom), reach = 0;
    switch (g->type) {
    case TALUS_SPHERE:
        return (double)g->radius;
    case TALUS_CAPSULE:
        return (double)g->half_height + most;
    case TALUS_CYLINDER:
        return hypot((double)g->half_height, most);
    case TALUS_HULL:
        for (uint32_t i = 0; i < talus_hull_vertex_count(c->hull); i++) {
            reach = fmax(reach, gltf_length3(gltf_of_vec3(talus_hull_vertex(c->hull, i))));
        }
        return reach;
    default:
        return gltf_length3(gltf_of_vec3(g->half));
    }
}

/* The box of a box is tight, for the ground is one; that of others is that of a ball around them. */
static void take_place(const bench_judge *j, uint32_t collider, bench_place *out) {
    const gltf_collider *c = &j->scene->colliders[collider];
    const talus_convex *convex = &j->convexes[collider];
    place(j, c->body, &c->pose, &out->position, &out->rotation);
    out->collider = collider;
    gltf_double3 half = gltf_d3(j->reaches[collider], j->reaches[collider], j->reaches[collider]);
    if (convex->geometry.type == TALUS_BOX) {
        gltf_double9 m = gltf_rotation_scale(out->rotation, gltf_of_vec3(convex->geometry.half));
        half = gltf_d3(fabs(m.x.x) + fabs(m.y.x) + fabs(m.z.x), fabs(m.x.y) + fabs(m.y.y) + fabs(m.z.y),
                       fabs(m.x.z) + fabs(m.y.z) + fabs(m.z.z));
    }
    out->low = gltf_sub3(out->position, half);
    out->high = gltf_add3(out->position, half);
}

static int by_low(const void *a, const void *b) {
    double x = ((const bench_place *)a)->low.x, y = ((const bench_place *)b)->low.x;
    return x < y ? -1 : x > y;
}

static int moves(const gltf_scene *scene, const gltf_collider *c) {
    return c->body != GLTF_NONE && !scene->bodies[c->body].kinematic;
}

/* Whether an end of a joint is at a collider: on its body, or on the static one itself. */
static int hangs_on(const gltf_scene *scene, uint32_t body, uint32_t fixed, uint32_t collider) {
    uint32_t own = scene->colliders[collider].body;
    return own != GLTF_NONE ? body == own : fixed == collider;
}

/* Whether the scene lets two colliders push one another. */
static int may_collide(const gltf_scene *scene, uint32_t first, uint32_t second) {
    const gltf_collider *a = &scene->colliders[first], *b = &scene->colliders[second];
    if (a->body == b->body || a->sensor || b->sensor || (!moves(scene, a) && !moves(scene, b))) {
        return 0;
    }
    for (uint32_t i = 0; i < scene->joint_count; i++) {
        const gltf_joint *o = &scene->joints[i];
        if (!o->def.collide_connected &&
            ((hangs_on(scene, o->body_a, o->static_a, first) && hangs_on(scene, o->body_b, o->static_b, second)) ||
             (hangs_on(scene, o->body_a, o->static_a, second) && hangs_on(scene, o->body_b, o->static_b, first)))) {
            return 0;
        }
    }
    if (a->filter.group != 0 && a->filter.group == b->filter.group) {
        return a->filter.group > 0;
    }
    return (a->filter.mask & b->filter.category) != 0 && (b->filter.mask & a->filter.category) != 0;
}

static double depth_of(const bench_judge *j, const bench_place *a, const bench_place *b) {
    static const talus_pose here = {{0, 0, 0}, {0, 0, 0, 1}};
    gltf_double4 back = gltf_conjugate(a->rotation);
    talus_pose relative = {gltf_vec3(gltf_rotate(back, gltf_sub3(b->position, a->position))),
                           gltf_quat(gltf_mul4(back, b->rotation))};
    talus_depth depth;
    talus_status status = talus_penetration(&j->convexes[a->collider], &here, &j->convexes[b->collider], &relative,
                                            TALUS_DEPTH_PROVEN, NULL, &depth);
    return status == TALUS_OK ? (double)depth.depth : HUGE_VAL;
}

static int add_depth(bench_judge *j, double depth) {
    if (j->depth_count == j->depth_room) {
        size_t room = j->depth_room > 0 ? 2 * j->depth_room : 1024;
        double *more = realloc(j->depths, room * sizeof *more);
        if (more == NULL) {
            return -1;
        }
        j->depths = more;
        j->depth_room = room;
    }
    j->depths[j->depth_count++] = depth;
    return 0;
}

/* Boxes that meet, by a sweep along x. */
static int take_overlaps(bench_judge *j) {
    uint32_t count = j->scene->collider_count;
    for (uint32_t i = 0; i < count; i++) {
        take_place(j, i, &j->places[i]);
    }
    qsort(j->places, count, sizeof *j->places, by_low);
    for (uint32_t i = 0; i < count; i++) {
        const bench_place *a = &j->places[i];
        for (uint32_t k = i + 1; k < count && j->places[k].low.x <= a->high.x; k++) {
            const bench_place *b = &j->places[k];
            if (a->low.y <= b->high.y && b->low.y <= a->high.y && a->low.z <= b->high.z && b->low.z <= a->high.z &&
                may_collide(j->scene, a->collider, b->collider)) {
                double depth = depth_of(j, a, b);
                if (!(depth < HUGE_VAL) || (depth > 0 && add_depth(j, depth) != 0)) {
                    return -1;
                }
            }
        }
    }
    return 0;
}

/* --- joints, places, energy --- */

/* How far `d` is outside of what a hard axis allows. */
static double outside(const talus_axis *axis, double d) {
    double low = (double)axis->lower, high = axis->mode == TALUS_AXIS_LOCKED ? low : (double)axis->upper;
    if (axis->mode == TALUS_AXIS_FREE || axis->stiffness > 0) {
        return 0;
    }
    return d < low ? low - d : d > high ? d - high : 0;
}

static double apart(const bench_judge *j, const gltf_joint *joint) {
    gltf_double3 a, b;
    gltf_double4 turn_a, turn_b;
    place(j, joint->body_a, &joint->def.frame_a, &a, &turn_a);
    place(j, joint->body_b, &joint->def.frame_b, &b, &turn_b);
    gltf_double3 d = gltf_rotate(gltf_conjugate(turn_a), gltf_sub3(b, a));
    return gltf_length3(gltf_d3(outside(&joint->def.linear[0], d.x), outside(&joint->def.linear[1], d.y),
                                outside(&joint->def.linear[2], d.z)));
}

/* Kinetic and potential, J. */
static double energy(const bench_judge *j, uint32_t body) {
    const bench_part *p = &j->parts[body];
    talus_pose pose;
    talus_vec3 linear, angular;
    talus_body_get_pose(&j->world->world, j->world->bodies[body], &pose);
    talus_body_get_velocity(&j->world->world, j->world->bodies[body], &linear, &angular);
    gltf_double4 turn = gltf_of_quat(pose.rotation);
    gltf_double3 v = gltf_of_vec3(linear), w = gltf_rotate(gltf_conjugate(turn), gltf_of_vec3(angular));
    gltf_double3 center = gltf_add3(gltf_of_vec3(pose.position), gltf_rotate(turn, gltf_of_vec3(p->mass.center)));
    gltf_double9 inertia = {gltf_of_vec3(p->mass.inertia.x), gltf_of_vec3(p->mass.inertia.y),
                            gltf_of_vec3(p->mass.inertia.z)};
    double mass = (double)p->mass.mass, factor = (double)j->scene->bodies[body].gravity_factor;
    return 0.5 * mass * gltf_dot3(v, v) + 0.5 * gltf_dot3(w, gltf_mul93(&inertia, w)) -
           mass * factor * gltf_dot3(gltf_of_vec3(j->scene->gravity), center);
}

/* Where a motor or a kinematic body adds energy nothing says how much may be gained. */
static int is_passive(const gltf_scene *scene) {
    int driven = 0;
    for (uint32_t i = 0; i < scene->body_count; i++) {
        driven |= scene->bodies[i].kinematic;
    }
    for (uint32_t i = 0; i < scene->joint_count; i++) {
        for (int k = 0; k < 3; k++) {
            driven |= scene->joints[i].def.linear_drive[k].enabled | scene->joints[i].def.angular_drive[k].enabled;
        }
    }
    return !driven;
}

/* --- a run --- */

int bench_judge_open(bench_judge *j, const gltf_scene *scene, const gltf_world *world) {
    memset(j, 0, sizeof *j);
    j->scene = scene;
    j->world = world;
    j->convexes = calloc((size_t)scene->collider_count + 1, sizeof *j->convexes);
    j->reaches = calloc((size_t)scene->collider_count + 1, sizeof *j->reaches);
    j->places = calloc((size_t)scene->collider_count + 1, sizeof *j->places);
    j->parts = calloc((size_t)scene->body_count + 1, sizeof *j->parts);
    if (j->convexes == NULL || j->reaches == NULL || j->places == NULL || j->parts == NULL) {
        return -1;
    }
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        talus_geometry geometry = gltf_placed_geometry(scene, world, scene->colliders[i].geometry);
        talus_convex_init(&geometry, world->world.geometry, world->world.geometry_bytes, &j->convexes[i]);
        j->reaches[i] = reach(&j->convexes[i]);
    }
    j->passive = is_passive(scene);
    for (uint32_t i = 0; i < scene->body_count; i++) {
        talus_pose pose;
        talus_body_get_pose(&world->world, world->bodies[i], &pose);
        talus_body_get_mass(&world->world, world->bodies[i], &j->parts[i].mass);
        j->parts[i].put = gltf_of_vec3(pose.position);
        j->weight += (double)j->parts[i].mass.mass * gltf_length3(gltf_of_vec3(scene->gravity));
        j->least_energy += energy(j, i);
    }
    return 0;
}

int bench_judge_step(bench_judge *j, int overlaps) {
    double sum = 0;
    j->drift = 0;
    for (uint32_t i = 0; i < j->scene->body_count; i++) {
        talus_pose pose;
        talus_body_get_pose(&j->world->world, j->world->bodies[i], &pose);
        j->drift = fmax(j->drift, gltf_length3(gltf_sub3(gltf_of_vec3(pose.position), j->parts[i].put)));
        sum += energy(j, i);
    }
    if (!(fabs(sum) < HUGE_VAL)) {
        return -1;
    }
    j->gained = fmax(j->gained, sum - j->least_energy);
    j->least_energy = fmin(j->least_energy, sum);
    for (uint32_t i = 0; i < j->scene->joint_count; i++) {
        j->apart = fmax(j->apart, apart(j, &j->scene->joints[i]));
    }
    return overlaps ? take_overlaps(j) : 0;
}

void bench_judge_errors(bench_judge *j, double errors[BENCH_ERROR_COUNT]) {
    figures depths = figures_of(j->depths, j->depth_count);
    errors[BENCH_OVERLAP_P99] = depths.p99;
    errors[BENCH_OVERLAP_MOST] = depths.max;
    errors[BENCH_APART] = j->scene->joint_count > 0 ? j->apart : -1;
    errors[BENCH_DRIFT] = j->drift;
    errors[BENCH_GAINED] = j->passive && j->weight > 0 ? j->gained / j->weight : -1;
}

void bench_judge_close(bench_judge *j) {
    free(j->convexes);
    free(j->reaches);
    free(j->places);
    free(j->parts);
    free(j->depths);
    memset(j, 0, sizeof *j);
}
