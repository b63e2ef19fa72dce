/* Joints between two bodies, or between a body and the world. */
#ifndef TALUS_JOINT_H
#define TALUS_JOINT_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every joint is made of the same parts: what each of six axes of frame A may do, a swing cone, a distance, motors.
 * The functions below fill in the usual ones. Positions and angles are those of frame B seen from frame A. */
typedef enum talus_axis_mode {
    TALUS_AXIS_FREE,
    TALUS_AXIS_LOCKED,  /* held at `lower` */
    TALUS_AXIS_LIMITED, /* between lower and upper */
    TALUS_AXIS_MODE_COUNT
} talus_axis_mode;

/* One axis: linear in m, angular in rad. Where stiffness is 0 a limit is hard; otherwise it is a spring of that
 * stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) beyond the limit. */
typedef struct talus_axis {
    talus_axis_mode mode;
    float lower, upper;
    float stiffness, damping;
} talus_axis;

typedef struct talus_drive {
    uint8_t enabled;
    uint8_t acceleration;  /* stiffness and damping are per unit of the effective mass */
    float position_target; /* m, rad */
    float velocity_target; /* m/s, rad/s */
    float stiffness;
    float damping;
    float max_force; /* N, N m; 0 or less: no bound */
} talus_drive;

typedef struct talus_joint_def {
    talus_body a, b;             /* a null handle is the world */
    talus_pose frame_a, frame_b; /* in the body's frame, or the world's */
    talus_axis linear[3];
    talus_axis angular[3];
    /* A cone: the axis `cone_axis` (0 x, 1 y, 2 z; anything else: none) of frame B stays within cone_angle (rad) of
     * that of frame A. The two other angular axes are then free. */
    int32_t cone_axis;
    float cone_angle, cone_stiffness, cone_damping;
    /* The distance of the frames' origins (m); counts if distance_enabled. The linear axes are then free. */
    uint8_t distance_enabled;
    float distance_lower, distance_upper, distance_stiffness, distance_damping;
    talus_drive linear_drive[3];
    talus_drive angular_drive[3];
    uint8_t collide_connected; /* let the two bodies collide with each other */
    float break_force;         /* N; 0: never breaks */
    float break_torque;        /* N m; 0: never breaks */
    uint64_t user_data;
} talus_joint_def;

/* All free; no drives; both frames at their bodies' origins. */
talus_joint_def talus_joint_def_default(void);
/* Sets the axes of the usual joints; the frames' x axis is the hinge, slider or twist axis. */
void talus_joint_make_fixed(talus_joint_def *def);
void talus_joint_make_ball(talus_joint_def *def);
void talus_joint_make_revolute(talus_joint_def *def);
void talus_joint_make_prismatic(talus_joint_def *def);
void talus_joint_make_distance(talus_joint_def *def, float lower, float upper);

talus_status talus_joint_create(talus_world *world, const talus_joint_def *def, talus_joint *out);
talus_status talus_joint_destroy(talus_world *world, talus_joint joint);
int talus_joint_is_valid(const talus_world *world, talus_joint joint);
talus_status talus_joint_get_def(const talus_world *world, talus_joint joint, talus_joint_def *out);
talus_status talus_joint_set_linear_drive(talus_world *world, talus_joint joint, int axis, const talus_drive *drive);
talus_status talus_joint_set_angular_drive(talus_world *world, talus_joint joint, int axis, const talus_drive *drive);
/* The mean force (N) and torque (N m) on body B over the last step, world axes. */
talus_status talus_joint_get_reaction(const talus_world *world, talus_joint joint, talus_vec3 *force,
                                      talus_vec3 *torque);
/* How far the locked axes are from where they should be: m, rad. */
talus_status talus_joint_get_error(const talus_world *world, talus_joint joint, float *linear, float *angular);

#ifdef __cplusplus
}
#endif

#endif
