/* Bodies: static, kinematic and dynamic. */
#ifndef TALUS_BODY_H
#define TALUS_BODY_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum talus_body_type {
    TALUS_STATIC,    /* never moves */
    TALUS_KINEMATIC, /* moves as it is told to; nothing pushes it */
    TALUS_DYNAMIC,   /* moves by forces */
    TALUS_BODY_TYPE_COUNT
} talus_body_type;

/* World axes along and about which a body does not move. Of a body that is locked to a plane, three degrees of freedom
 * are solved instead of six where it touches what is locked to the same plane, stands still or is moved along it. */
enum {
    TALUS_LOCK_LINEAR_X = 1,
    TALUS_LOCK_LINEAR_Y = 2,
    TALUS_LOCK_LINEAR_Z = 4,
    TALUS_LOCK_ANGULAR_X = 8,
    TALUS_LOCK_ANGULAR_Y = 16,
    TALUS_LOCK_ANGULAR_Z = 32,
    TALUS_LOCK_PLANE_X = 1 | 16 | 32, /* to the plane across x; it turns about x */
    TALUS_LOCK_PLANE_Y = 2 | 8 | 32,
    TALUS_LOCK_PLANE_Z = 4 | 8 | 16
};

/* TALUS_LOCK_PLANE_X, _Y or _Z of axis 0, 1 or 2. */
static inline uint32_t talus_lock_plane(uint32_t axis) {
    return (uint32_t)TALUS_LOCK_LINEAR_X << axis | (7u ^ 1u << axis) * (uint32_t)TALUS_LOCK_ANGULAR_X;
}

typedef struct talus_body_def {
    talus_body_type type;
    talus_pose pose;             /* of the body's origin in the world; rotation of any length but 0 */
    talus_vec3 linear_velocity;  /* m/s, of the centre of mass */
    talus_vec3 angular_velocity; /* rad/s, world axes */
    float linear_damping;        /* 1/s, >= 0 */
    float angular_damping;       /* 1/s, >= 0 */
    float gravity_scale;
    uint32_t locks;    /* TALUS_LOCK_* */
    uint8_t can_sleep; /* may rest at no cost when its island is still */
    uint8_t starts_asleep;
    uint64_t user_data;
} talus_body_def;

/* A static body at the origin that may sleep, gravity scale 1. */
talus_body_def talus_body_def_default(void);

talus_status talus_body_create(talus_world *world, const talus_body_def *def, talus_body *out);
/* Destroys its shapes and joints too. */
talus_status talus_body_destroy(talus_world *world, talus_body body);
int talus_body_is_valid(const talus_world *world, talus_body body);

talus_status talus_body_get_pose(const talus_world *world, talus_body body, talus_pose *out);
/* Puts a body somewhere else at once, without motion in between; wakes it and what it touched. */
talus_status talus_body_set_pose(talus_world *world, talus_body body, const talus_pose *pose);
/* For a kinematic body: velocities that take it to `pose` within `dt` seconds. */
talus_status talus_body_move_to(talus_world *world, talus_body body, const talus_pose *pose, float dt);
talus_status talus_body_get_velocity(const talus_world *world, talus_body body, talus_vec3 *linear,
                                     talus_vec3 *angular);
talus_status talus_body_set_velocity(talus_world *world, talus_body body, talus_vec3 linear, talus_vec3 angular);

/* Mass, centre and inertia in the body's frame. A mass set here stays, whatever shapes come or go;
 * talus_body_mass_from_shapes goes back to the shapes' own. The inertia must be symmetric and positive. An infinite
 * mass or inertia is given as 0 and means that the body does not translate or does not turn. */
talus_status talus_body_get_mass(const talus_world *world, talus_body body, talus_mass *out);
talus_status talus_body_set_mass(talus_world *world, talus_body body, const talus_mass *mass);
talus_status talus_body_mass_from_shapes(talus_world *world, talus_body body);

/* Forces (N), torques (N m) act over the whole next step; impulses (N s, N m s) at once. World axes. `at` is a world
 * point. All wake the body. TALUS_NOT_FINITE also for what would pass what a float holds with what there is. */
talus_status talus_body_apply_force(talus_world *world, talus_body body, talus_vec3 force, talus_vec3 at);
talus_status talus_body_apply_torque(talus_world *world, talus_body body, talus_vec3 torque);
talus_status talus_body_apply_impulse(talus_world *world, talus_body body, talus_vec3 impulse, talus_vec3 at);
talus_status talus_body_apply_angular_impulse(talus_world *world, talus_body body, talus_vec3 impulse);

talus_status talus_body_set_damping(talus_world *world, talus_body body, float linear, float angular);
talus_status talus_body_set_gravity_scale(talus_world *world, talus_body body, float scale);
talus_status talus_body_set_locks(talus_world *world, talus_body body, uint32_t locks);
talus_status talus_body_get_type(const talus_world *world, talus_body body, talus_body_type *out);
talus_status talus_body_get_user_data(const talus_world *world, talus_body body, uint64_t *out);

int talus_body_is_awake(const talus_world *world, talus_body body);
/* Waking wakes the whole island; putting to sleep puts the whole island to sleep. */
talus_status talus_body_wake(talus_world *world, talus_body body);
talus_status talus_body_sleep(talus_world *world, talus_body body);

#ifdef __cplusplus
}
#endif

#endif
