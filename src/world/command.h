/* The table of commands: kind, name, what its handle is of, and the run of fields that make up its record. */
#ifndef TL_COMMAND_H
#define TL_COMMAND_H

#include "base/bytes.h"
#include "talus/command.h"

#define TL_COMMANDS(X)                                                                                                 \
    X(WORLD_STEP, world_step, WORLD, STEP)                                                                             \
    X(WORLD_SET_GRAVITY, world_set_gravity, WORLD, GRAVITY)                                                            \
    X(WORLD_FLIP, world_flip, WORLD, FLIP)                                                                             \
    X(BODY_CREATE, body_create, NEW, BODY_DEF)                                                                         \
    X(BODY_DESTROY, body_destroy, BODY, NOTHING)                                                                       \
    X(BODY_SET_POSE, body_set_pose, BODY, POSE)                                                                        \
    X(BODY_MOVE_TO, body_move_to, BODY, MOVE)                                                                          \
    X(BODY_SET_VELOCITY, body_set_velocity, BODY, BOTH)                                                                \
    X(BODY_SET_MASS, body_set_mass, BODY, MASS)                                                                        \
    X(BODY_MASS_FROM_SHAPES, body_mass_from_shapes, BODY, NOTHING)                                                     \
    X(BODY_APPLY_FORCE, body_apply_force, BODY, LINEAR_AT)                                                             \
    X(BODY_APPLY_TORQUE, body_apply_torque, BODY, ANGULAR)                                                             \
    X(BODY_APPLY_IMPULSE, body_apply_impulse, BODY, LINEAR_AT)                                                         \
    X(BODY_APPLY_ANGULAR_IMPULSE, body_apply_angular_impulse, BODY, ANGULAR)                                           \
    X(BODY_SET_DAMPING, body_set_damping, BODY, DAMPING)                                                               \
    X(BODY_SET_GRAVITY_SCALE, body_set_gravity_scale, BODY, GRAVITY_SCALE)                                             \
    X(BODY_SET_LOCKS, body_set_locks, BODY, LOCKS)                                                                     \
    X(BODY_WAKE, body_wake, BODY, NOTHING)                                                                             \
    X(BODY_SLEEP, body_sleep, BODY, NOTHING)                                                                           \
    X(SHAPE_CREATE, shape_create, NEW, SHAPE)                                                                          \
    X(SHAPE_DESTROY, shape_destroy, SHAPE, NOTHING)                                                                    \
    X(SHAPE_SET_MATERIAL, shape_set_material, SHAPE, MATERIAL)                                                         \
    X(SHAPE_SET_FILTER, shape_set_filter, SHAPE, FILTER)                                                               \
    X(JOINT_CREATE, joint_create, NEW, JOINT_DEF)                                                                      \
    X(JOINT_DESTROY, joint_destroy, JOINT, NOTHING)                                                                    \
    X(JOINT_SET_DRIVE, joint_set_drive, JOINT, DRIVE)                                                                  \
    X(WORLD_SET_ACCURACY, world_set_accuracy, WORLD, ACCURACY)

/* What a command does: checks its arguments and, if they are in order, carries it out. `i` is the index behind its
 * handle; a creation writes the new handle. */
#define X(kind, name, target, fields) talus_status tl_run_##name(talus_world *world, uint32_t i, talus_command *c);
TL_COMMANDS(X)
#undef X

#endif
