/* libFuzzer: bytes as a sequence of API calls with raw floats. No call may crash, hang or leave the state other than
 * finite; the same bytes give the same hash by plain C. */
#include "talus/talus.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BODIES 12u
#define MAX_STEPS 40u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct input {
    const uint8_t *p, *end;
} input;

static uint32_t take(input *in, unsigned bytes) {
    uint32_t x = 0;
    for (unsigned i = 0; i < bytes && in->p < in->end; i++) {
        x |= (uint32_t)*in->p++ << (8u * i);
    }
    return x;
}

/* Mostly moderate numbers; every fourth one is raw bits. */
static float number(input *in) {
    uint32_t kind = take(in, 1), bits;
    float x;
    if (kind % 4u == 3u) {
        bits = take(in, 4);
        memcpy(&x, &bits, sizeof x);
        return x;
    }
    x = (float)(int32_t)take(in, 1) - 128.0f;
    return kind % 4u == 0 ? x * 0.0625f : kind % 4u == 1u ? x * 1e-3f : (float)(int32_t)take(in, 1) * 0.0625f;
}
static talus_vec3 vector(input *in) {
    talus_vec3 v;
    v.x = number(in), v.y = number(in), v.z = number(in);
    return v;
}
static talus_pose pose(input *in) {
    talus_pose p;
    p.position = vector(in);
    p.rotation.x = number(in), p.rotation.y = number(in), p.rotation.z = number(in), p.rotation.w = number(in);
    return p;
}

static talus_shape_def shape_def(input *in) {
    talus_shape_def d = talus_shape_def_default();
    uint32_t flags = take(in, 1);
    d.geometry.type = (talus_shape_type)(flags % 6u); /* one too many */
    d.geometry.radius = number(in), d.geometry.half_height = number(in);
    d.geometry.radius_top = number(in), d.geometry.radius_bottom = number(in);
    d.geometry.half = vector(in);
    d.geometry.hull = take(in, 1) % 4u * 32u;
    if (flags & 8u) {
        d.pose = pose(in);
    }
    if (flags & 16u) {
        d.material.static_friction = number(in), d.material.dynamic_friction = number(in);
        d.material.restitution = number(in), d.material.rolling_resistance = number(in);
        d.material.friction_combine = (talus_combine)(take(in, 1) % 5u);
        d.density = number(in);
    }
    d.sensor = (flags >> 5) & 1u, d.events = (flags >> 6) & 1u;
    d.filter.group = flags & 128u ? -1 : 0;
    return d;
}

static talus_axis axis(input *in) {
    talus_axis a;
    uint32_t mode = take(in, 1);
    memset(&a, 0, sizeof a);
    a.mode = (talus_axis_mode)(mode % 4u);
    if (mode & 16u) {
        a.lower = number(in), a.upper = number(in);
    }
    if (mode & 32u) {
        a.stiffness = number(in), a.damping = number(in);
    }
    return a;
}

static talus_drive drive(input *in) {
    talus_drive d;
    uint32_t flags = take(in, 1);
    d.enabled = flags & 1u, d.acceleration = (flags >> 1) & 1u;
    d.position_target = number(in), d.velocity_target = number(in);
    d.stiffness = number(in), d.damping = number(in), d.max_force = number(in);
    return d;
}

typedef struct scene {
    talus_body body[BODIES];
    talus_shape shape[BODIES];
    talus_joint joint[BODIES];
    uint32_t steps;
} scene;

static void make_joint(talus_world *w, scene *s, input *in) {
    talus_joint_def d = talus_joint_def_default();
    uint32_t kind = take(in, 1);
    d.a = s->body[take(in, 1) % BODIES], d.b = s->body[take(in, 1) % BODIES];
    d.frame_a = pose(in), d.frame_b = pose(in);
    switch (kind % 8u) {
    case 0:
        talus_joint_make_fixed(&d);
        break;
    case 1:
        talus_joint_make_ball(&d);
        break;
    case 2:
        talus_joint_make_revolute(&d);
        break;
    case 3:
        talus_joint_make_prismatic(&d);
        break;
    case 4:
        talus_joint_make_distance(&d, number(in), number(in));
        break;
    default:
        for (int k = 0; k < 3; k++) {
            d.linear[k] = axis(in), d.angular[k] = axis(in);
        }
        d.cone_axis = (int32_t)(take(in, 1) % 5u) - 1, d.cone_angle = number(in);
        break;
    }
    if (kind & 16u) {
        d.linear_drive[0] = drive(in), d.angular_drive[1] = drive(in);
    }
    if (kind & 32u) {
        d.break_force = number(in), d.break_torque = number(in);
    }
    d.collide_connected = (kind >> 6) & 1u;
    talus_joint_create(w, &d, &s->joint[take(in, 1) % BODIES]);
}

static void make_body(talus_world *w, scene *s, input *in) {
    talus_body_def d = talus_body_def_default();
    uint32_t flags = take(in, 1);
    d.type = (talus_body_type)(flags % 4u);
    d.pose = pose(in);
    if (flags & 4u) {
        d.linear_velocity = vector(in), d.angular_velocity = vector(in);
    }
    if (flags & 8u) {
        d.linear_damping = number(in), d.angular_damping = number(in), d.gravity_scale = number(in);
        d.locks = take(in, 1) % 80u;
    }
    d.can_sleep = !(flags & 16u), d.starts_asleep = (flags >> 5) & 1u;
    talus_body_create(w, &d, &s->body[take(in, 1) % BODIES]);
}

static void call(talus_world *w, scene *s, input *in) {
    uint32_t what = take(in, 1);
    talus_body *body = &s->body[take(in, 1) % BODIES];
    talus_shape *shape = &s->shape[(what >> 5) % BODIES];
    talus_joint *joint = &s->joint[(what >> 5) % BODIES];
    talus_vec3 v, u;
    talus_pose p;
    talus_mass m;
    talus_drive d;
    talus_shape_def def;
    float dt;
    switch (what % 28u) {
    case 0:
    case 1:
        make_body(w, s, in);
        break;
    case 2:
    case 3:
    case 4:
        def = shape_def(in);
        talus_shape_create(w, *body, &def, shape);
        break;
    case 5:
    case 6:
        make_joint(w, s, in);
        break;
    case 7:
        talus_body_destroy(w, *body);
        break;
    case 8:
        talus_shape_destroy(w, *shape);
        break;
    case 9:
        talus_joint_destroy(w, *joint);
        break;
    case 10:
        p = pose(in), talus_body_set_pose(w, *body, &p);
        break;
    case 11:
        p = pose(in), talus_body_move_to(w, *body, &p, number(in));
        break;
    case 12:
        v = vector(in), u = vector(in), talus_body_set_velocity(w, *body, v, u);
        break;
    case 13:
        v = vector(in), u = vector(in), talus_body_apply_force(w, *body, v, u);
        break;
    case 14:
        v = vector(in), talus_body_apply_torque(w, *body, v);
        break;
    case 15:
        v = vector(in), u = vector(in), talus_body_apply_impulse(w, *body, v, u);
        break;
    case 16:
        v = vector(in), talus_body_apply_angular_impulse(w, *body, v);
        break;
    case 17:
        m.mass = number(in), m.center = vector(in);
        m.inertia.x = vector(in), m.inertia.y = vector(in), m.inertia.z = vector(in);
        m.inertia.y.x = m.inertia.x.y, m.inertia.z.x = m.inertia.x.z, m.inertia.z.y = m.inertia.y.z;
        talus_body_set_mass(w, *body, &m);
        break;
    case 18:
        talus_body_mass_from_shapes(w, *body);
        break;
    case 19:
        talus_body_set_locks(w, *body, take(in, 1));
        break;
    case 20:
        talus_body_wake(w, *body);
        break;
    case 21:
        talus_body_sleep(w, *body);
        break;
    case 22:
        def = shape_def(in), talus_shape_set_material(w, *shape, &def.material);
        break;
    case 23:
        def = shape_def(in), talus_shape_set_filter(w, *shape, &def.filter);
        break;
    case 24:
        d = drive(in), talus_joint_set_linear_drive(w, *joint, (int)(take(in, 1) % 4u), &d);
        break;
    case 25:
        d = drive(in), talus_joint_set_angular_drive(w, *joint, (int)(take(in, 1) % 4u), &d);
        break;
    case 26:
        v = vector(in), talus_world_set_gravity(w, v);
        break;
    case 27: {
        talus_accuracy a = {number(in), take(in, 1), take(in, 1)};
        talus_world_set_accuracy(w, &a);
        break;
    }
    default:
        dt = take(in, 1) & 1u ? number(in) : 1.0f / 60.0f;
        if (s->steps++ < MAX_STEPS) {
            talus_world_step(w, dt, NULL, NULL);
        }
        break;
    }
}

static int finite3(talus_vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static void look(talus_world *w, const scene *s) {
    if (talus_world_validate(w) != TALUS_OK) {
        abort();
    }
    for (uint32_t i = 0; i < BODIES; i++) {
        talus_pose p;
        talus_vec3 v, u;
        talus_aabb box;
        talus_joint_def def;
        float a, b;
        if (talus_body_get_pose(w, s->body[i], &p) == TALUS_OK &&
            (!finite3(p.position) || !isfinite(p.rotation.x + p.rotation.y + p.rotation.z + p.rotation.w))) {
            abort();
        }
        if (talus_body_get_velocity(w, s->body[i], &v, &u) == TALUS_OK && (!finite3(v) || !finite3(u))) {
            abort();
        }
        (void)talus_shape_get_aabb(w, s->shape[i], &box);
        (void)talus_joint_get_def(w, s->joint[i], &def);
        (void)talus_joint_get_error(w, s->joint[i], &a, &b);
        (void)talus_joint_get_reaction(w, s->joint[i], &v, &u);
    }
}

/* A tetrahedron, for the shapes that ask for a hull at offset 0. */
static const void *hull(size_t *bytes) {
    static unsigned char memory[4096];
    static size_t size;
    unsigned char *at = memory + (32u - (uintptr_t)memory % 32u) % 32u;
    if (size == 0) {
        const talus_vec3 points[4] = {{0.5f, 0.0f, 0.0f}, {-0.5f, 0.0f, 0.3f}, {0.0f, 0.6f, 0.0f}, {0.0f, 0.0f, -0.5f}};
        size_t need = talus_hull_scratch_size(4);
        unsigned char *scratch = malloc(need + 64u);
        if (!scratch || talus_hull_build(points, 4, scratch + (32u - (uintptr_t)scratch % 32u) % 32u, need, at,
                                         sizeof memory - 32u, &size) != TALUS_OK) {
            abort();
        }
        free(scratch);
    }
    *bytes = size;
    return at;
}

static uint64_t run(const uint8_t *data, size_t size, talus_isa isa) {
    input in = {data, data + size};
    talus_world_def def = talus_world_def_default();
    talus_world w;
    scene s;
    uint32_t settings = take(&in, 1);
    memset(&s, 0, sizeof s);
    def.body_capacity = 1u + settings % 12u, def.shape_capacity = 1u + settings % 16u;
    def.joint_capacity = 1u + settings % 8u, def.contact_capacity = 1u + settings % 32u;
    def.event_capacity = 1u + settings % 5u;
    def.profile_capacity = settings % 3u;
    def.substeps = 1u + settings % 4u;
    def.isa = isa;
    size_t bytes = talus_world_size(&def);
    unsigned char *memory = malloc(bytes + 64u);
    if (!memory || talus_world_init(&w, &def, memory + (64u - (uintptr_t)memory % 64u) % 64u, bytes) != TALUS_OK) {
        abort();
    }
    w.geometry = hull(&w.geometry_bytes);
    for (uint32_t i = 0; i < BODIES; i++) { /* something there from the start */
        talus_body_def body = talus_body_def_default();
        talus_shape_def shape = talus_shape_def_default();
        body.type = i % 3u ? TALUS_DYNAMIC : TALUS_STATIC;
        body.pose.position.y = 0.9f * (float)i;
        if (talus_body_create(&w, &body, &s.body[i]) == TALUS_OK) {
            talus_shape_create(&w, s.body[i], &shape, &s.shape[i]);
        }
    }
    while (in.p < in.end) {
        call(&w, &s, &in);
    }
    look(&w, &s);
    for (int i = 0; i < 3; i++) {
        talus_world_step(&w, 1.0f / 60.0f, NULL, NULL);
    }
    look(&w, &s);
    uint64_t hash = talus_world_hash(&w);
    free(memory);
    return hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > 4096u) {
        return 0;
    }
    if (run(data, size, TALUS_ISA_BEST) != run(data, size, TALUS_ISA_SCALAR)) {
        abort();
    }
    return 0;
}
