/* Commands: every change of a world as a record. The functions of body.h, shape.h, joint.h and world.h that change
 * something put their arguments into one and hand it to talus_world_apply: whatever happens to a world happens there,
 * so a log of the commands and the state that they began from are the whole run.
 *
 * Only the instruction set in use (talus_world_set_isa), which changes no bits, and talus_world_restore are no
 * commands. */
#ifndef TALUS_COMMAND_H
#define TALUS_COMMAND_H

#include "talus/body.h"
#include "talus/joint.h"
#include "talus/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Their numbers stay: recordings hold them. */
typedef enum talus_command_kind {
    TALUS_COMMAND_WORLD_STEP,
    TALUS_COMMAND_WORLD_SET_GRAVITY,
    TALUS_COMMAND_WORLD_FLIP,
    TALUS_COMMAND_BODY_CREATE,
    TALUS_COMMAND_BODY_DESTROY,
    TALUS_COMMAND_BODY_SET_POSE,
    TALUS_COMMAND_BODY_MOVE_TO,
    TALUS_COMMAND_BODY_SET_VELOCITY,
    TALUS_COMMAND_BODY_SET_MASS,
    TALUS_COMMAND_BODY_MASS_FROM_SHAPES,
    TALUS_COMMAND_BODY_APPLY_FORCE,
    TALUS_COMMAND_BODY_APPLY_TORQUE,
    TALUS_COMMAND_BODY_APPLY_IMPULSE,
    TALUS_COMMAND_BODY_APPLY_ANGULAR_IMPULSE,
    TALUS_COMMAND_BODY_SET_DAMPING,
    TALUS_COMMAND_BODY_SET_GRAVITY_SCALE,
    TALUS_COMMAND_BODY_SET_LOCKS,
    TALUS_COMMAND_BODY_WAKE,
    TALUS_COMMAND_BODY_SLEEP,
    TALUS_COMMAND_SHAPE_CREATE,
    TALUS_COMMAND_SHAPE_DESTROY,
    TALUS_COMMAND_SHAPE_SET_MATERIAL,
    TALUS_COMMAND_SHAPE_SET_FILTER,
    TALUS_COMMAND_JOINT_CREATE,
    TALUS_COMMAND_JOINT_DESTROY,
    TALUS_COMMAND_JOINT_SET_DRIVE,
    TALUS_COMMAND_WORLD_SET_ACCURACY,
    TALUS_COMMAND_COUNT
} talus_command_kind;

typedef struct talus_command_step {
    float dt;                 /* s */
    const talus_clock *clock; /* these two are of the process and not of the record */
    talus_profile *profile;
} talus_command_step;

/* Flips one bit of the state, as an error of a machine would: what tests of recordings plant. */
typedef struct talus_command_flip {
    uint32_t column, row, bit; /* as of talus_world_columns; bits count from each word's lowest, word after word */
} talus_command_flip;

typedef struct talus_command_move {
    talus_pose pose;
    float dt; /* s */
} talus_command_move;

/* A velocity, force or impulse: `linear`, and `angular` or the world point it acts `at`. */
typedef struct talus_command_push {
    talus_vec3 linear, angular, at;
} talus_command_push;

typedef struct talus_command_damping {
    float linear, angular; /* 1/s */
} talus_command_damping;

typedef struct talus_command_shape {
    talus_body body;
    talus_shape_def def;
} talus_command_shape;

typedef struct talus_command_drive {
    uint32_t axis; /* 0..2 linear, 3..5 angular */
    talus_drive drive;
} talus_command_drive;

typedef struct talus_command {
    talus_command_kind kind;
    uint32_t index, generation; /* of the body, shape or joint that it is about; of a creation: what it made */
    union {
        talus_command_step step;
        talus_command_flip flip;
        talus_command_move move;
        talus_command_push push;
        talus_command_damping damping;
        talus_command_shape shape;
        talus_command_drive drive;
        talus_body_def body;
        talus_joint_def joint;
        talus_pose pose;
        talus_mass mass;
        talus_material material;
        talus_filter filter;
        talus_accuracy accuracy;
        talus_vec3 gravity;
        float gravity_scale;
        uint32_t locks;
    } as;
} talus_command;

/* "body_set_pose" and so on; never null. */
const char *talus_command_name(talus_command_kind kind);

/* Does what the function of the command's name does, with its answers. A creation writes the handle it made into the
 * command. If it was done and the world has a log, the command is added to that. */
talus_status talus_world_apply(talus_world *world, talus_command *command);

/* A command as bytes: little-endian words of four bytes, the same on every machine, none longer than this. */
#define TALUS_COMMAND_MAX_BYTES 448u

/* Writes a command; returns its bytes, or 0 if `capacity` are too few. */
size_t talus_command_encode(const talus_command *command, void *out, size_t capacity);
/* Reads a command; returns the bytes read, or 0 if they are none. Any bytes may be handed over; what a command asks for
 * is checked when it is applied. */
size_t talus_command_decode(talus_command *command, const void *bytes, size_t size);

/* Takes the commands that a world did, in memory of the caller's; talus_world.log points to it. What does not fit is
 * counted, and so is a restore, which no log holds; a caller that finds lost ones needs the state itself to go on. */
struct talus_log {
    unsigned char *memory;
    size_t capacity, used;               /* bytes */
    uint32_t steps, others, flips, lost; /* flips are among the others */
};

#ifdef __cplusplus
}
#endif

#endif
