/* What the tests against closed forms share. With ERRORS set in the environment they print how far off each number is.
 */
#ifndef ANALYTIC_KIT_H
#define ANALYTIC_KIT_H

#include "../unit/world_kit.h"

#define PI 3.14159265358979323846
#define DT (1.0f / 60.0f)
#define SUB (1.0 / 240.0) /* s, the default sub-step */
#define G 9.81

/* A number, what it should be, and how far off it may be. */
#define CLOSE(value, wanted, tolerance)                                                                                \
    close_to((double)(value), (double)(wanted), (double)(tolerance), #value, __FILE__, __LINE__)
#define BELOW(value, most) CLOSE(value, 0.0, most)

static inline void close_to(double value, double wanted, double tolerance, const char *text, const char *file,
                            int line) {
    if (getenv("ERRORS")) {
        print_message("%c %s:%d: %s = %.7g, wanted %.7g, off by %.2g of %.2g\n",
                      fabs(value - wanted) <= tolerance ? ' ' : '!', file, line, text, value, wanted,
                      fabs(value - wanted), tolerance);
        return;
    }
    kit_near(value, wanted, tolerance, text, file, line);
}

/* A few bodies, gravity as given, no sleep. */
static inline talus_world world_of(float gx, float gy, float gz) {
    talus_world_def def = kit_small();
    def.gravity = kit_vec(gx, gy, gz);
    def.enable_sleep = 0;
    return kit_world(&def);
}
/* A slope is a floor under tilted gravity: down is -y turned by `angle` towards +x. */
static inline talus_world world_on_slope(double angle) {
    return world_of((float)(G * sin(angle)), (float)(-G * cos(angle)), 0.0f);
}
/* A slab whose top is at y = 0, of this friction. */
static inline void floor_of(talus_world *world, float friction) {
    talus_shape_def def = kit_box_def(500.0f, 1.0f, 500.0f);
    def.pose.position.y = -1.0f;
    def.material.static_friction = def.material.dynamic_friction = friction;
    kit_shape(world, talus_world_ground(world), &def);
}
static inline talus_body box_of(talus_world *world, talus_vec3 at, talus_vec3 half, float friction) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, at);
    talus_shape_def def = kit_box_def(half.x, half.y, half.z);
    def.material.static_friction = def.material.dynamic_friction = friction;
    kit_shape(world, body, &def);
    return body;
}
static inline void set_mass(talus_world *world, talus_body body, float mass) {
    talus_mass m;
    OK(talus_body_get_mass(world, body, &m));
    float scale = mass / m.mass;
    m.mass = mass;
    talus_vec3 *axes[3] = {&m.inertia.x, &m.inertia.y, &m.inertia.z};
    for (int k = 0; k < 3; k++) {
        *axes[k] = kit_vec(axes[k]->x * scale, axes[k]->y * scale, axes[k]->z * scale);
    }
    OK(talus_body_set_mass(world, body, &m));
}
/* The largest of each error over so many steps. */
static inline talus_errors worst_of(talus_world *world, int steps) {
    talus_errors worst = {0}, e;
    for (int i = 0; i < steps; i++) {
        kit_steps(world, 1);
        OK(talus_world_measure(world, &e));
        worst.overlap = fmaxf(worst.overlap, e.overlap);
        worst.joint_linear = fmaxf(worst.joint_linear, e.joint_linear);
        worst.joint_angular = fmaxf(worst.joint_angular, e.joint_angular);
    }
    return worst;
}
static inline talus_body ball_of(talus_world *world, talus_vec3 at, float radius, float mass, float restitution,
                                 float friction) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, at);
    talus_shape_def def = kit_ball_def(radius);
    def.material.static_friction = def.material.dynamic_friction = friction;
    def.material.restitution = restitution;
    def.density = (float)((double)mass / (4.0 / 3.0 * PI * pow((double)radius, 3.0)));
    kit_shape(world, body, &def);
    return body;
}
/* A body without a shape, of this mass and these moments. */
static inline talus_body mass_of(talus_world *world, talus_vec3 at, float mass, float ix, float iy, float iz) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, at);
    talus_mass m;
    memset(&m, 0, sizeof m);
    m.mass = mass;
    m.inertia.x.x = ix, m.inertia.y.y = iy, m.inertia.z.z = iz;
    OK(talus_body_set_mass(world, body, &m));
    return body;
}
static inline void set_velocity(talus_world *world, talus_body body, talus_vec3 linear, talus_vec3 angular) {
    OK(talus_body_set_velocity(world, body, linear, angular));
}
static inline void step(talus_world *world) { OK(talus_world_step(world, DT, NULL, NULL)); }

/* Restores a snapshot of one world into another of the same capacities, which goes on by the scalar instruction set. */
static inline void move_to_scalar(const talus_world *world, talus_world *other) {
    size_t size = talus_world_save_size(world), written;
    void *snapshot = kit_alloc(size);
    OK(talus_world_save(world, snapshot, size, &written));
    OK(talus_world_restore(other, snapshot, written));
    OK(talus_world_set_isa(other, TALUS_ISA_SCALAR));
    kit_free(snapshot);
}

/* Two worlds that are the same stay so. */
static inline void step_alike(talus_world *world, talus_world *other) {
    step(world), step(other);
    assert_true(talus_world_hash(world) == talus_world_hash(other));
}

static inline talus_joint join(talus_world *world, const talus_joint_def *def) {
    talus_joint joint;
    OK(talus_joint_create(world, def, &joint));
    return joint;
}

/* Turns x onto z: frames' x is the hinge or the slide. */
static inline talus_quat x_to_z(void) {
    talus_quat q = {0.0f, -0.70710678f, 0.0f, 0.70710678f};
    return q;
}

/* A ball joint or a hinge along z, at a point of the world where both bodies are unturned; index 0 is the world. */
static inline talus_joint pin(talus_world *world, talus_body a, talus_body b, talus_vec3 at, int hinge) {
    talus_joint_def def = talus_joint_def_default();
    hinge ? talus_joint_make_revolute(&def) : talus_joint_make_ball(&def);
    def.a = a, def.b = b;
    talus_body ends[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        talus_vec3 from = ends[i].index ? kit_place(world, ends[i]) : kit_vec(0.0f, 0.0f, 0.0f);
        talus_pose *frame = i ? &def.frame_b : &def.frame_a;
        frame->position = kit_vec(at.x - from.x, at.y - from.y, at.z - from.z);
        frame->rotation = hinge ? x_to_z() : frame->rotation;
    }
    return join(world, &def);
}

/* v turned by q, in double. */
static inline void turned(talus_quat q, const double v[3], double out[3]) {
    const double u[3] = {(double)q.x, (double)q.y, (double)q.z}, w = (double)q.w;
    double t[3];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        t[k] = 2.0 * (u[i] * v[j] - u[j] * v[i]);
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = v[k] + w * t[k] + u[i] * t[j] - u[j] * t[i];
    }
}

/* The angle about z of a body's x axis (rad). */
static inline double angle_z(const talus_world *world, talus_body body) {
    talus_quat q = kit_pose_of(world, body).rotation;
    return 2.0 * atan2((double)q.z, (double)q.w);
}

/* The arithmetic-geometric mean, by which the period of a pendulum is 2 pi sqrt(l / g) / agm(1, cos(a / 2)). */
static inline double agm(double a, double b) {
    for (int i = 0; i < 40; i++) {
        double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return a;
}

/* The period of an oscillating number that is fed to it, from its crossings of zero upwards, each found on a line. */
typedef struct period {
    double last, first_time, last_time;
    int crossings, fed;
} period;
static inline void period_feed(period *p, double time, double value, double dt) {
    if (p->fed++ && p->last < 0.0 && value >= 0.0) {
        double at = time - dt * value / (value - p->last);
        if (p->crossings++ == 0) {
            p->first_time = at;
        }
        p->last_time = at;
    }
    p->last = value;
}
static inline double period_of(const period *p) {
    return p->crossings > 1 ? (p->last_time - p->first_time) / (double)(p->crossings - 1) : 0.0;
}

#endif
