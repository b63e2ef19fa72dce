#include "gltf/build.h"

#include "gltf/transform.h"

#include <stdlib.h>
#include <string.h>

#define DENSITY 1000.0f /* kg/m^3, where a body has no mass of its own */

/* An infinite principal moment is this many times the largest finite one, where turned axes would round a 0 away. */
#define NEARLY_INFINITE 1e4f

static void *align_to(void *memory, size_t alignment) {
    uintptr_t address = (uintptr_t)memory;
    return (unsigned char *)memory + ((alignment - address % alignment) % alignment);
}

static int check(gltf_error *error, talus_status status, const char *what, uint32_t node) {
    if (status != TALUS_OK) {
        gltf_error_set(error, GLTF_FAILED, "$.nodes[%lu]: %s: %s", (unsigned long)node, what,
                       talus_status_text(status));
    }
    return status == TALUS_OK;
}

/* --- hulls --- */

/* Memory for cooking one hull, shared by all. */
typedef struct kitchen {
    void *scratch_memory, *blob_memory;
    void *scratch, *blob;
    size_t scratch_size, blob_size;
} kitchen;

static int open_kitchen(const gltf_scene *scene, kitchen *k) {
    uint32_t most = 0;
    for (uint32_t i = 0; i < scene->hull_count; i++) {
        most = scene->hulls[i].count > most ? scene->hulls[i].count : most;
    }
    k->scratch_size = talus_hull_scratch_size(most);
    k->blob_size = talus_hull_max_size(most);
    k->scratch_memory = malloc(k->scratch_size + TALUS_BLOB_ALIGNMENT);
    k->blob_memory = malloc(k->blob_size + TALUS_BLOB_ALIGNMENT);
    if (k->scratch_memory == NULL || k->blob_memory == NULL) {
        return 0;
    }
    k->scratch = align_to(k->scratch_memory, TALUS_BLOB_ALIGNMENT);
    k->blob = align_to(k->blob_memory, TALUS_BLOB_ALIGNMENT);
    return 1;
}

static void report_hull(const gltf_hull *hull, talus_status status, gltf_error *error) {
    const char *part = hull->trigger ? "trigger" : "collider";
    gltf_status kind = status == TALUS_TOO_MANY_POINTS ? GLTF_UNSUPPORTED
                       : status == TALUS_FLAT_HULL     ? GLTF_BROKEN
                                                       : GLTF_FAILED;
    gltf_error_set(error, kind,
                   "$.nodes[%lu].extensions.KHR_physics_rigid_bodies.%s.geometry: a hull of %lu points: %s",
                   (unsigned long)hull->node, part, (unsigned long)hull->count, talus_status_text(status));
}

/* Cooks all hulls into one region. */
static int cook_hulls(const gltf_scene *scene, gltf_world *out, gltf_error *error) {
    kitchen k;
    memset(&k, 0, sizeof k);
    unsigned char *region = NULL;
    size_t used = 0, room = 0;
    out->hull_offsets = malloc((scene->hull_count + 1) * sizeof *out->hull_offsets);
    int ok = out->hull_offsets != NULL && open_kitchen(scene, &k);
    for (uint32_t i = 0; ok && i < scene->hull_count; i++) {
        const gltf_hull *hull = &scene->hulls[i];
        size_t size = 0;
        talus_status status =
            talus_hull_build(hull->points, hull->count, k.scratch, k.scratch_size, k.blob, k.blob_size, &size);
        if (status != TALUS_OK) {
            report_hull(hull, status, error);
            break;
        }
        size_t padded = (size + TALUS_BLOB_ALIGNMENT - 1) / TALUS_BLOB_ALIGNMENT * TALUS_BLOB_ALIGNMENT;
        if (used + padded > room) {
            size_t larger = (used + padded) * 2;
            unsigned char *more = larger <= UINT32_MAX ? realloc(region, larger + TALUS_BLOB_ALIGNMENT) : NULL;
            ok = more != NULL;
            if (!ok) {
                break;
            }
            region = more;
            room = larger;
        }
        memset(region + used, 0, padded);
        memcpy(region + used, k.blob, size);
        out->hull_offsets[i] = (uint32_t)used;
        used += padded;
    }
    free(k.scratch_memory);
    free(k.blob_memory);
    if (!ok) {
        gltf_error_set(error, GLTF_FAILED, "$: there is no memory for its hulls");
    }
    out->geometry_memory = region;
    if (region != NULL) { /* realloc may have left it anywhere: move the blobs to where they are aligned */
        unsigned char *place = align_to(region, TALUS_BLOB_ALIGNMENT);
        memmove(place, region, used);
        out->world.geometry = place;
        out->world.geometry_bytes = out->geometry_bytes = used;
    }
    return error->status == GLTF_OK;
}

/* --- the world --- */

static uint32_t capped(uint64_t count) { return count < TALUS_MAX_CAPACITY ? (uint32_t)count : TALUS_MAX_CAPACITY; }

static talus_world_def size_world(const gltf_scene *scene, const gltf_build_options *options) {
    talus_world_def def = talus_world_def_default();
    uint64_t statics = 0, movers = 0, sensors = 0;
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        statics += scene->colliders[i].body == GLTF_NONE;
        movers += scene->colliders[i].body != GLTF_NONE;
        sensors += scene->colliders[i].sensor != 0;
    }
    def.body_capacity = capped(scene->body_count + statics + 1);
    def.shape_capacity = capped((uint64_t)scene->collider_count + 1);
    def.joint_capacity = capped((uint64_t)scene->joint_count + 1);
    def.contact_capacity = capped(1024 + 16 * movers);
    def.event_capacity = capped(64 + (sensors > 0 ? sensors + movers : 0));
    def.gravity = scene->gravity;
    def.substeps = options->substeps > 0 ? options->substeps : def.substeps;
    def.iterations = options->iterations > 0 ? options->iterations : def.iterations;
    def.contact_hertz = options->contact_hertz > 0 ? options->contact_hertz : def.contact_hertz;
    def.error_budget = options->error_budget;
    def.most_substeps = options->most_substeps > 0 ? options->most_substeps : def.most_substeps;
    def.recycle_slack = options->no_kept_manifolds ? 0 : def.recycle_slack;
    def.enable_sleep = options->no_sleep ? 0 : def.enable_sleep;
    def.profile_capacity = options->profile_capacity;
    def.isa = options->isa;
    return def;
}

static int make_world(const gltf_scene *scene, const gltf_build_options *options, gltf_world *out, gltf_error *error) {
    talus_world_def def = size_world(scene, options);
    if ((uint64_t)scene->body_count + scene->collider_count >= TALUS_MAX_CAPACITY) {
        gltf_error_set(error, GLTF_UNSUPPORTED, "$.nodes: more than %lu bodies", (unsigned long)TALUS_MAX_CAPACITY);
        return 0;
    }
    size_t bytes = talus_world_size(&def);
    if (bytes == 0) {
        gltf_error_set(error, GLTF_FAILED, "$: no world can have %lu bodies, %lu shapes and %lu contacts",
                       (unsigned long)def.body_capacity, (unsigned long)def.shape_capacity,
                       (unsigned long)def.contact_capacity);
        return 0;
    }
    const void *geometry = out->world.geometry;
    out->block_bytes = bytes;
    out->block_memory = malloc(bytes + TALUS_BLOCK_ALIGNMENT);
    if (out->block_memory == NULL) {
        gltf_error_set(error, GLTF_FAILED, "$: there is no memory for a world of %lu bytes", (unsigned long)bytes);
        return 0;
    }
    void *block = align_to(out->block_memory, TALUS_BLOCK_ALIGNMENT);
    talus_status status = talus_world_init(&out->world, &def, block, bytes);
    if (status != TALUS_OK) {
        gltf_error_set(error, status == TALUS_NO_ISA ? GLTF_UNSUPPORTED : GLTF_FAILED, "$: the world: %s",
                       talus_status_text(status));
        return 0;
    }
    out->world.geometry = geometry;
    out->world.geometry_bytes = out->geometry_bytes;
    return 1;
}

talus_geometry gltf_placed_geometry(const gltf_scene *scene, const gltf_world *world, uint32_t index) {
    talus_geometry geometry = scene->geometries[index].geometry;
    if (scene->geometries[index].hull != GLTF_NONE) {
        geometry.hull = world->hull_offsets[scene->geometries[index].hull];
    }
    return geometry;
}

static int add_shape(const gltf_scene *scene, gltf_world *out, const gltf_collider *collider, talus_body body,
                     const talus_pose *pose, gltf_error *error) {
    talus_shape_def def = talus_shape_def_default();
    talus_shape shape;
    def.geometry = gltf_placed_geometry(scene, out, collider->geometry);
    def.pose = *pose;
    def.material = collider->material;
    def.filter = collider->filter;
    def.density = collider->sensor ? 0.0f : DENSITY;
    def.sensor = collider->sensor;
    def.events = 0;
    def.user_data = collider->node;
    return check(error, talus_shape_create(&out->world, body, &def, &shape), "its shape", collider->node);
}

/* --- bodies --- */

/* Where among the colliders a body's own are. */
typedef struct range {
    uint32_t first, end;
} range;

/* The mass of the body's colliders at DENSITY. */
static int mass_of_shapes(const gltf_scene *scene, const gltf_world *out, range own_colliders, uint32_t body,
                          talus_mass *sum, gltf_error *error) {
    memset(sum, 0, sizeof *sum);
    for (uint32_t i = own_colliders.first; i < own_colliders.end; i++) {
        const gltf_collider *collider = &scene->colliders[i];
        if (collider->body != body || collider->sensor) {
            continue;
        }
        talus_geometry geometry = gltf_placed_geometry(scene, out, collider->geometry);
        talus_mass own;
        talus_status status =
            talus_geometry_mass(&geometry, out->world.geometry, out->world.geometry_bytes, DENSITY, &own);
        if (!check(error, status, "the mass of its shape", collider->node)) {
            return 0;
        }
        own = talus_mass_move(&own, &collider->pose);
        *sum = talus_mass_add(sum, &own);
    }
    return 1;
}

static void scale_inertia(talus_mat3 *m, float s) {
    float *v[9] = {&m->x.x, &m->x.y, &m->x.z, &m->y.x, &m->y.y, &m->y.z, &m->z.x, &m->z.y, &m->z.z};
    for (int i = 0; i < 9; i++) {
        *v[i] *= s;
    }
}

/* The tensor whose principal axes and moments the file gives. */
static talus_mat3 stated_inertia(const gltf_body *body) {
    const talus_quat q = body->inertia_axes;
    talus_vec3 d = body->inertia_diagonal;
    float *moments[3] = {&d.x, &d.y, &d.z};
    int turned = q.x != 0 || q.y != 0 || q.z != 0;
    float most = d.x > d.y ? d.x : d.y;
    most = most > d.z ? most : d.z;
    for (int i = 0; turned && most > 0 && i < 3; i++) {
        if (*moments[i] == 0) {
            *moments[i] = NEARLY_INFINITE * most;
        }
    }
    gltf_double4 turn = {q.x, q.y, q.z, q.w};
    gltf_double9 r = gltf_rotation_scale(turn, gltf_d3(1, 1, 1));
    gltf_double9 t = {{r.x.x * d.x, r.y.x * d.y, r.z.x * d.z},
                      {r.x.y * d.x, r.y.y * d.y, r.z.y * d.z},
                      {r.x.z * d.x, r.y.z * d.y, r.z.z * d.z}}; /* columns of diag R^T */
    gltf_double9 m = gltf_mul99(&r, &t);
    talus_mat3 out = {gltf_vec3(m.x), gltf_vec3(m.y), gltf_vec3(m.z)};
    out.x.y = out.y.x;
    out.x.z = out.z.x;
    out.y.z = out.z.y;
    return out;
}

/* What the file states, and out of the shapes' volume what it leaves out. A stated centre does not change the inertia
 * about the centre that follows from the volume. */
static int set_mass(const gltf_scene *scene, gltf_world *out, uint32_t index, range own, gltf_error *error) {
    const gltf_body *body = &scene->bodies[index];
    talus_mass volume, mass;
    if (!mass_of_shapes(scene, out, own, index, &volume, error)) {
        return 0;
    }
    if (!(volume.mass > 0)) { /* no shape: as the library takes it, 1 m of radius of gyration */
        memset(&volume, 0, sizeof volume);
        volume.mass = volume.inertia.x.x = volume.inertia.y.y = volume.inertia.z.z = 1.0f;
    }
    mass = volume;
    if (body->has_center) {
        mass.center = body->center;
    }
    if (body->has_mass) {
        mass.mass = body->mass;
        scale_inertia(&mass.inertia, body->mass / volume.mass); /* an infinite mass, 0, has an infinite inertia, 0 */
    }
    if (body->has_inertia) {
        mass.inertia = stated_inertia(body);
    }
    if (body->kinematic && !body->has_center) {
        memset(&mass.center, 0, sizeof mass.center); /* it turns about its node's origin */
    }
    return check(error, talus_body_set_mass(&out->world, out->bodies[index], &mass), "its mass", body->node);
}

static int add_body(const gltf_scene *scene, gltf_world *out, uint32_t index, gltf_error *error) {
    const gltf_body *body = &scene->bodies[index];
    talus_body_def def = talus_body_def_default();
    def.type = body->kinematic ? TALUS_KINEMATIC : TALUS_DYNAMIC;
    def.pose = body->pose;
    def.gravity_scale = body->gravity_factor;
    def.locks = body->locks;
    def.user_data = body->node;
    return check(error, talus_body_create(&out->world, &def, &out->bodies[index]), "its body", body->node);
}

/* A static collider on a body of its own, so that a joint that hangs on it keeps two bodies, and no more, apart. */
static int add_static(const gltf_scene *scene, gltf_world *out, const gltf_collider *collider, talus_body *body,
                      gltf_error *error) {
    static const talus_pose identity = {{0, 0, 0}, {0, 0, 0, 1}};
    talus_body_def def = talus_body_def_default();
    def.type = TALUS_STATIC;
    def.pose = collider->anchored ? identity : collider->pose; /* frames of joints to it are the world's */
    def.user_data = collider->node;
    return check(error, talus_body_create(&out->world, &def, body), "its static body", collider->node) &&
           add_shape(scene, out, collider, *body, collider->anchored ? &collider->pose : &identity, error);
}

/* Once all shapes are there: mass first, for a new centre of mass moves the velocity. */
static int finish_bodies(const gltf_scene *scene, gltf_world *out, const range *own, gltf_error *error) {
    for (uint32_t i = 0; i < scene->body_count; i++) {
        const gltf_body *body = &scene->bodies[i];
        if ((body->has_mass || body->has_center || body->has_inertia || body->kinematic) &&
            !set_mass(scene, out, i, own[i], error)) {
            return 0;
        }
        talus_status status =
            talus_body_set_velocity(&out->world, out->bodies[i], body->linear_velocity, body->angular_velocity);
        if (!check(error, status, "its velocity", body->node)) {
            return 0;
        }
    }
    return 1;
}

static int fill(const gltf_scene *scene, gltf_world *out, talus_body *statics, range *own, gltf_error *error) {
    for (uint32_t i = 0; i < scene->body_count; i++) {
        if (!add_body(scene, out, i, error)) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        const gltf_collider *collider = &scene->colliders[i];
        if (collider->body == GLTF_NONE) {
            if (!add_static(scene, out, collider, &statics[i], error)) {
                return 0;
            }
            continue;
        }
        range *among = &own[collider->body];
        among->first = among->end == 0 ? i : among->first;
        among->end = i + 1;
        if (!add_shape(scene, out, collider, out->bodies[collider->body], &collider->pose, error)) {
            return 0;
        }
    }
    if (!finish_bodies(scene, out, own, error)) {
        return 0;
    }
    for (uint32_t i = 0; i < scene->joint_count; i++) {
        const gltf_joint *joint = &scene->joints[i];
        talus_joint_def def = joint->def;
        talus_joint made;
        const talus_body world = {0, 0};
        def.a = joint->body_a != GLTF_NONE     ? out->bodies[joint->body_a]
                : joint->static_a != GLTF_NONE ? statics[joint->static_a]
                                               : world;
        def.b = joint->body_b != GLTF_NONE     ? out->bodies[joint->body_b]
                : joint->static_b != GLTF_NONE ? statics[joint->static_b]
                                               : world;
        def.user_data = joint->node;
        if (!check(error, talus_joint_create(&out->world, &def, &made), "its joint", joint->node)) {
            return 0;
        }
    }
    return 1;
}

gltf_status gltf_build(const gltf_scene *scene, const gltf_build_options *options, gltf_world *out, gltf_error *error) {
    memset(out, 0, sizeof *out);
    memset(error, 0, sizeof *error);
    talus_body *statics = calloc((size_t)scene->collider_count + 1, sizeof *statics);
    range *own = calloc((size_t)scene->body_count + 1, sizeof *own);
    out->bodies = calloc((size_t)scene->body_count + 1, sizeof *out->bodies);
    if (statics == NULL || own == NULL || out->bodies == NULL) {
        gltf_error_set(error, GLTF_FAILED, "$: there is no memory");
    } else if ((scene->hull_count == 0 || cook_hulls(scene, out, error)) && make_world(scene, options, out, error)) {
        fill(scene, out, statics, own, error);
    }
    free(statics);
    free(own);
    if (error->status != GLTF_OK) {
        gltf_world_free(out);
    }
    return error->status;
}

void gltf_world_free(gltf_world *world) {
    free(world->block_memory);
    free(world->geometry_memory);
    free(world->bodies);
    free(world->hull_offsets);
    memset(world, 0, sizeof *world);
}
