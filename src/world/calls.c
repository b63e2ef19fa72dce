/* The functions of the API that change a world: each puts its arguments into a command. */
#include "talus/command.h"

static talus_status on_world(talus_world *world, talus_command_kind kind, talus_command *c) {
    c->kind = kind;
    c->index = c->generation = 0;
    return talus_world_apply(world, c);
}
static talus_status on_body(talus_world *world, talus_command_kind kind, talus_body body, talus_command *c) {
    c->kind = kind;
    c->index = body.index, c->generation = body.generation;
    return talus_world_apply(world, c);
}
static talus_status on_shape(talus_world *world, talus_command_kind kind, talus_shape shape, talus_command *c) {
    c->kind = kind;
    c->index = shape.index, c->generation = shape.generation;
    return talus_world_apply(world, c);
}
static talus_status on_joint(talus_world *world, talus_command_kind kind, talus_joint joint, talus_command *c) {
    c->kind = kind;
    c->index = joint.index, c->generation = joint.generation;
    return talus_world_apply(world, c);
}

/* --- the world -------------------------------------------------------------------------------- */

talus_status talus_world_step(talus_world *world, float dt, const talus_clock *clock, talus_profile *profile) {
    talus_command c;
    c.as.step.dt = dt, c.as.step.clock = clock, c.as.step.profile = profile;
    return on_world(world, TALUS_COMMAND_WORLD_STEP, &c);
}

talus_status talus_world_set_gravity(talus_world *world, talus_vec3 gravity) {
    talus_command c;
    c.as.gravity = gravity;
    return on_world(world, TALUS_COMMAND_WORLD_SET_GRAVITY, &c);
}

talus_status talus_world_set_accuracy(talus_world *world, const talus_accuracy *accuracy) {
    if (!accuracy) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.accuracy = *accuracy;
    return on_world(world, TALUS_COMMAND_WORLD_SET_ACCURACY, &c);
}

/* --- bodies ----------------------------------------------------------------------------------- */

talus_status talus_body_create(talus_world *world, const talus_body_def *def, talus_body *out) {
    if (!def || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.body = *def;
    talus_status status = on_world(world, TALUS_COMMAND_BODY_CREATE, &c);
    if (status == TALUS_OK) {
        out->index = c.index, out->generation = c.generation;
    }
    return status;
}

talus_status talus_body_destroy(talus_world *world, talus_body body) {
    talus_command c;
    return on_body(world, TALUS_COMMAND_BODY_DESTROY, body, &c);
}

talus_status talus_body_set_pose(talus_world *world, talus_body body, const talus_pose *pose) {
    if (!pose) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.pose = *pose;
    return on_body(world, TALUS_COMMAND_BODY_SET_POSE, body, &c);
}

talus_status talus_body_move_to(talus_world *world, talus_body body, const talus_pose *pose, float dt) {
    if (!pose) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.move.pose = *pose, c.as.move.dt = dt;
    return on_body(world, TALUS_COMMAND_BODY_MOVE_TO, body, &c);
}

talus_status talus_body_set_velocity(talus_world *world, talus_body body, talus_vec3 linear, talus_vec3 angular) {
    talus_command c;
    c.as.push.linear = linear, c.as.push.angular = angular;
    return on_body(world, TALUS_COMMAND_BODY_SET_VELOCITY, body, &c);
}

talus_status talus_body_set_mass(talus_world *world, talus_body body, const talus_mass *mass) {
    if (!mass) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.mass = *mass;
    return on_body(world, TALUS_COMMAND_BODY_SET_MASS, body, &c);
}

talus_status talus_body_mass_from_shapes(talus_world *world, talus_body body) {
    talus_command c;
    return on_body(world, TALUS_COMMAND_BODY_MASS_FROM_SHAPES, body, &c);
}

talus_status talus_body_apply_force(talus_world *world, talus_body body, talus_vec3 force, talus_vec3 at) {
    talus_command c;
    c.as.push.linear = force, c.as.push.at = at;
    return on_body(world, TALUS_COMMAND_BODY_APPLY_FORCE, body, &c);
}

talus_status talus_body_apply_torque(talus_world *world, talus_body body, talus_vec3 torque) {
    talus_command c;
    c.as.push.angular = torque;
    return on_body(world, TALUS_COMMAND_BODY_APPLY_TORQUE, body, &c);
}

talus_status talus_body_apply_impulse(talus_world *world, talus_body body, talus_vec3 impulse, talus_vec3 at) {
    talus_command c;
    c.as.push.linear = impulse, c.as.push.at = at;
    return on_body(world, TALUS_COMMAND_BODY_APPLY_IMPULSE, body, &c);
}

talus_status talus_body_apply_angular_impulse(talus_world *world, talus_body body, talus_vec3 impulse) {
    talus_command c;
    c.as.push.angular = impulse;
    return on_body(world, TALUS_COMMAND_BODY_APPLY_ANGULAR_IMPULSE, body, &c);
}

talus_status talus_body_set_damping(talus_world *world, talus_body body, float linear, float angular) {
    talus_command c;
    c.as.damping.linear = linear, c.as.damping.angular = angular;
    return on_body(world, TALUS_COMMAND_BODY_SET_DAMPING, body, &c);
}

talus_status talus_body_set_gravity_scale(talus_world *world, talus_body body, float scale) {
    talus_command c;
    c.as.gravity_scale = scale;
    return on_body(world, TALUS_COMMAND_BODY_SET_GRAVITY_SCALE, body, &c);
}

talus_status talus_body_set_locks(talus_world *world, talus_body body, uint32_t locks) {
    talus_command c;
    c.as.locks = locks;
    return on_body(world, TALUS_COMMAND_BODY_SET_LOCKS, body, &c);
}

talus_status talus_body_wake(talus_world *world, talus_body body) {
    talus_command c;
    return on_body(world, TALUS_COMMAND_BODY_WAKE, body, &c);
}

talus_status talus_body_sleep(talus_world *world, talus_body body) {
    talus_command c;
    return on_body(world, TALUS_COMMAND_BODY_SLEEP, body, &c);
}

/* --- shapes ----------------------------------------------------------------------------------- */

talus_status talus_shape_create(talus_world *world, talus_body body, const talus_shape_def *def, talus_shape *out) {
    if (!def || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.shape.body = body, c.as.shape.def = *def;
    talus_status status = on_world(world, TALUS_COMMAND_SHAPE_CREATE, &c);
    if (status == TALUS_OK) {
        out->index = c.index, out->generation = c.generation;
    }
    return status;
}

talus_status talus_shape_destroy(talus_world *world, talus_shape shape) {
    talus_command c;
    return on_shape(world, TALUS_COMMAND_SHAPE_DESTROY, shape, &c);
}

talus_status talus_shape_set_material(talus_world *world, talus_shape shape, const talus_material *material) {
    if (!material) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.material = *material;
    return on_shape(world, TALUS_COMMAND_SHAPE_SET_MATERIAL, shape, &c);
}

talus_status talus_shape_set_filter(talus_world *world, talus_shape shape, const talus_filter *filter) {
    if (!filter) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.filter = *filter;
    return on_shape(world, TALUS_COMMAND_SHAPE_SET_FILTER, shape, &c);
}

/* --- joints ----------------------------------------------------------------------------------- */

talus_status talus_joint_create(talus_world *world, const talus_joint_def *def, talus_joint *out) {
    if (!def || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.joint = *def;
    talus_status status = on_world(world, TALUS_COMMAND_JOINT_CREATE, &c);
    if (status == TALUS_OK) {
        out->index = c.index, out->generation = c.generation;
    }
    return status;
}

talus_status talus_joint_destroy(talus_world *world, talus_joint joint) {
    talus_command c;
    return on_joint(world, TALUS_COMMAND_JOINT_DESTROY, joint, &c);
}

static talus_status set_drive(talus_world *world, talus_joint joint, int axis, uint32_t first,
                              const talus_drive *drive) {
    if (!drive || axis < 0 || axis > 2) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_command c;
    c.as.drive.axis = first + (uint32_t)axis;
    c.as.drive.drive = *drive;
    return on_joint(world, TALUS_COMMAND_JOINT_SET_DRIVE, joint, &c);
}

talus_status talus_joint_set_linear_drive(talus_world *world, talus_joint joint, int axis, const talus_drive *drive) {
    return set_drive(world, joint, axis, 0, drive);
}

talus_status talus_joint_set_angular_drive(talus_world *world, talus_joint joint, int axis, const talus_drive *drive) {
    return set_drive(world, joint, axis, 3, drive);
}
