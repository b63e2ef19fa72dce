/* The table of commands: kind, name, what its handle is of, the run of fields that make up its record, and whether it
 * may write a column of what bodies and shapes are, not of where they are and what they do (snapshot.c). */
#ifndef TL_COMMAND_H
#define TL_COMMAND_H

#include "base/bytes.h"
#include "talus/command.h"

#define TL_COMMANDS(X)                                                                                                 \
    X(WORLD_STEP, world_step, WORLD, STEP, 0)                                                                          \
    X(WORLD_SET_GRAVITY, world_set_gravity, WORLD, GRAVITY, 0)                                                         \
    X(WORLD_FLIP, world_flip, WORLD, FLIP, 1)                                                                          \
    X(BODY_CREATE, body_create, NEW, BODY_DEF, 1)                                                                      \
    X(BODY_DESTROY, body_destroy, BODY, NOTHING, 1)                                                                    \
    X(BODY_SET_POSE, body_set_pose, BODY, POSE, 0)                                                                     \
    X(BODY_MOVE_TO, body_move_to, BODY, MOVE, 0)                                                                       \
    X(BODY_SET_VELOCITY, body_set_velocity, BODY, BOTH, 0)                                                             \
    X(BODY_SET_MASS, body_set_mass, BODY, MASS, 1)                                                                     \
    X(BODY_MASS_FROM_SHAPES, body_mass_from_shapes, BODY, NOTHING, 1)                                                  \
    X(BODY_APPLY_FORCE, body_apply_force, BODY, LINEAR_AT, 0)                                                          \
    X(BODY_APPLY_TORQUE, body_apply_torque, BODY, ANGULAR, 0)                                                          \
    X(BODY_APPLY_IMPULSE, body_apply_impulse, BODY, LINEAR_AT, 0)                                                      \
    X(BODY_APPLY_ANGULAR_IMPULSE, body_apply_angular_impulse, BODY, ANGULAR, 0)                                        \
    X(BODY_SET_DAMPING, body_set_damping, BODY, DAMPING, 1)                                                            \
    X(BODY_SET_GRAVITY_SCALE, body_set_gravity_scale, BODY, GRAVITY_SCALE, 1)                                          \
    X(BODY_SET_LOCKS, body_set_locks, BODY, LOCKS, 0)                                                                  \
    X(BODY_WAKE, body_wake, BODY, NOTHING, 0)                                                                          \
    X(BODY_SLEEP, body_sleep, BODY, NOTHING, 0)                                                                        \
    X(SHAPE_CREATE, shape_create, NEW, SHAPE, 1)                                                                       \
    X(SHAPE_DESTROY, shape_destroy, SHAPE, NOTHING, 1)                                                                 \
    X(SHAPE_SET_MATERIAL, shape_set_material, SHAPE, MATERIAL, 1)                                                      \
    X(SHAPE_SET_FILTER, shape_set_filter, SHAPE, FILTER, 1)                                                            \
    X(JOINT_CREATE, joint_create, NEW, JOINT_DEF, 0)                                                                   \
    X(JOINT_DESTROY, joint_destroy, JOINT, NOTHING, 0)                                                                 \
    X(JOINT_SET_DRIVE, joint_set_drive, JOINT, DRIVE, 0)                                                               \
    X(WORLD_SET_ACCURACY, world_set_accuracy, WORLD, ACCURACY, 0)

/* What a command does: checks its arguments and, if they are in order, carries it out. `i` is the index behind its
 * handle; a creation writes the new handle. */
#define X(kind, name, target, fields, defines)                                                                         \
    talus_status tl_run_##name(talus_world *world, uint32_t i, talus_command *c);
TL_COMMANDS(X)
#undef X

#endif
