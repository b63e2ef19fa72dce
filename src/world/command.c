/* The one place that every change of a world passes, and the records that it leaves. */
#include "world/command.h"

#include <string.h>

#include "world/world_internal.h"

/* --- the fields ------------------------------------------------------------------------------- */

/* A run of members of one width, by their place in talus_command.as. A byte goes into a word of its own. */
typedef struct field {
    uint16_t offset;
    uint8_t width, count;
} field;

/* clang-format off */
#define MEMBER(type, member) (((type *)0)->member)
#define AT(path) (uint16_t)(offsetof(talus_command, as.path) - offsetof(talus_command, as))
#define RUN(width, path) {AT(path), width, sizeof(MEMBER(talus_command, as.path)) / (width)}
#define DRIVE_FIELDS(path)                                                                                             \
    RUN(1, path.enabled), RUN(1, path.acceleration), RUN(4, path.position_target), RUN(4, path.velocity_target),       \
    RUN(4, path.stiffness), RUN(4, path.damping), RUN(4, path.max_force)
#define FILTER_FIELDS(path) RUN(8, path.category), RUN(8, path.mask), RUN(4, path.group)
#define END {0, 0, 0}

static const field FIELDS_NOTHING[] = {END};
static const field FIELDS_STEP[] = {RUN(4, step.dt), END};
static const field FIELDS_GRAVITY[] = {RUN(4, gravity), END};
static const field FIELDS_ACCURACY[] = {RUN(4, accuracy), END};
static const field FIELDS_FLIP[] = {RUN(4, flip), END};
static const field FIELDS_POSE[] = {RUN(4, pose), END};
static const field FIELDS_MOVE[] = {RUN(4, move), END};
static const field FIELDS_BOTH[] = {RUN(4, push.linear), RUN(4, push.angular), END};
static const field FIELDS_LINEAR_AT[] = {RUN(4, push.linear), RUN(4, push.at), END};
static const field FIELDS_ANGULAR[] = {RUN(4, push.angular), END};
static const field FIELDS_MASS[] = {RUN(4, mass), END};
static const field FIELDS_DAMPING[] = {RUN(4, damping), END};
static const field FIELDS_GRAVITY_SCALE[] = {RUN(4, gravity_scale), END};
static const field FIELDS_LOCKS[] = {RUN(4, locks), END};
static const field FIELDS_MATERIAL[] = {RUN(4, material), END};
static const field FIELDS_FILTER[] = {FILTER_FIELDS(filter), END};
static const field FIELDS_DRIVE[] = {RUN(4, drive.axis), DRIVE_FIELDS(drive.drive), END};
static const field FIELDS_BODY_DEF[] = {
    RUN(4, body.type), RUN(4, body.pose), RUN(4, body.linear_velocity), RUN(4, body.angular_velocity),
    RUN(4, body.linear_damping), RUN(4, body.angular_damping), RUN(4, body.gravity_scale), RUN(4, body.locks),
    RUN(1, body.can_sleep), RUN(1, body.starts_asleep), RUN(8, body.user_data), END};
static const field FIELDS_SHAPE[] = {
    RUN(4, shape.body), RUN(4, shape.def.geometry), RUN(4, shape.def.pose), RUN(4, shape.def.material),
    FILTER_FIELDS(shape.def.filter), RUN(4, shape.def.density), RUN(1, shape.def.sensor), RUN(1, shape.def.events),
    RUN(8, shape.def.user_data), END};
static const field FIELDS_JOINT_DEF[] = {
    RUN(4, joint.a), RUN(4, joint.b), RUN(4, joint.frame_a), RUN(4, joint.frame_b), RUN(4, joint.linear),
    RUN(4, joint.angular), RUN(4, joint.cone_axis), RUN(4, joint.cone_angle), RUN(4, joint.cone_stiffness),
    RUN(4, joint.cone_damping), RUN(1, joint.distance_enabled), RUN(4, joint.distance_lower),
    RUN(4, joint.distance_upper), RUN(4, joint.distance_stiffness), RUN(4, joint.distance_damping),
    DRIVE_FIELDS(joint.linear_drive[0]), DRIVE_FIELDS(joint.linear_drive[1]), DRIVE_FIELDS(joint.linear_drive[2]),
    DRIVE_FIELDS(joint.angular_drive[0]), DRIVE_FIELDS(joint.angular_drive[1]), DRIVE_FIELDS(joint.angular_drive[2]),
    RUN(1, joint.collide_connected), RUN(4, joint.break_force), RUN(4, joint.break_torque), RUN(8, joint.user_data),
    END};
/* clang-format on */

typedef enum target { TARGET_WORLD, TARGET_NEW, TARGET_BODY, TARGET_SHAPE, TARGET_JOINT } target;

typedef struct command_info {
    const char *name;
    talus_status (*run)(talus_world *world, uint32_t i, talus_command *c);
    const field *fields;
    target target;
    int defines;
} command_info;

static const command_info COMMANDS[TALUS_COMMAND_COUNT] = {
#define X(kind, name, target, fields, defines) {#name, tl_run_##name, FIELDS_##fields, TARGET_##target, defines},
    TL_COMMANDS(X)
#undef X
};

const char *talus_command_name(talus_command_kind kind) {
    return (unsigned)kind < TALUS_COMMAND_COUNT ? COMMANDS[kind].name : "no such command";
}

/* --- records ---------------------------------------------------------------------------------- */

/* A record: a word with the kind (8 bits) and the words that follow (24), the handle but for the world's own, the
 * fields. */
static uint32_t words_of(const command_info *info) {
    uint32_t words = info->target == TARGET_WORLD ? 0u : 2u;
    for (const field *f = info->fields; f->count; f++) {
        words += f->width == 8u ? 2u * f->count : f->count;
    }
    return words;
}

size_t talus_command_encode(const talus_command *command, void *out, size_t capacity) {
    if (!command || !out || (unsigned)command->kind >= TALUS_COMMAND_COUNT) {
        return 0;
    }
    const command_info *info = &COMMANDS[command->kind];
    uint32_t words = words_of(info);
    size_t size = 4u + 4u * (size_t)words;
    if (capacity < size) {
        return 0;
    }
    unsigned char *p = out;
    tl_put_word(p, (uint32_t)command->kind | words << 8), p += 4;
    if (info->target != TARGET_WORLD) {
        tl_put_word(p, command->index), tl_put_word(p + 4, command->generation), p += 8;
    }
    for (const field *f = info->fields; f->count; f++) {
        const unsigned char *from = (const unsigned char *)&command->as + f->offset;
        for (uint32_t k = 0; k < f->count; k++, from += f->width) {
            uint64_t x = *from;
            if (f->width == 4u) {
                uint32_t word;
                memcpy(&word, from, 4u);
                x = word;
            } else if (f->width == 8u) {
                memcpy(&x, from, 8u);
            }
            tl_put_word(p, (uint32_t)x), p += 4;
            if (f->width == 8u) {
                tl_put_word(p, (uint32_t)(x >> 32)), p += 4;
            }
        }
    }
    return size;
}

/* The next member of a width out of one or two words; 0 if the number does not fit it. */
static int take_member(unsigned char *to, uint32_t width, const unsigned char **p) {
    uint32_t word = tl_get_word(*p);
    *p += 4;
    if (width == 1u) {
        *to = (unsigned char)word;
        return word <= 255u;
    }
    if (width == 4u) {
        memcpy(to, &word, 4u);
        return 1;
    }
    uint64_t both = (uint64_t)tl_get_word(*p) << 32 | word;
    *p += 4;
    memcpy(to, &both, 8u);
    return 1;
}

size_t talus_command_decode(talus_command *command, const void *bytes, size_t size) {
    const unsigned char *p = bytes;
    if (!command || !p || size < 4u || (tl_get_word(p) & 255u) >= TALUS_COMMAND_COUNT) {
        return 0;
    }
    uint32_t head = tl_get_word(p);
    const command_info *info = &COMMANDS[head & 255u];
    uint32_t words = words_of(info);
    if (head >> 8 != words || (size - 4u) / 4u < words) {
        return 0;
    }
    memset(command, 0, sizeof *command);
    command->kind = (talus_command_kind)(head & 255u);
    p += 4;
    if (info->target != TARGET_WORLD) {
        command->index = tl_get_word(p), command->generation = tl_get_word(p + 4), p += 8;
    }
    for (const field *f = info->fields; f->count; f++) {
        unsigned char *to = (unsigned char *)&command->as + f->offset;
        for (uint32_t k = 0; k < f->count; k++, to += f->width) {
            if (!take_member(to, f->width, &p)) {
                return 0;
            }
        }
    }
    return 4u + 4u * (size_t)words;
}

/* --- the place -------------------------------------------------------------------------------- */

static void add_to_log(talus_log *log, const talus_command *command) {
    size_t size = talus_command_encode(command, log->memory + log->used, log->capacity - log->used);
    log->used += size;
    log->lost += size == 0;
    log->steps += command->kind == TALUS_COMMAND_WORLD_STEP;
    log->others += command->kind != TALUS_COMMAND_WORLD_STEP;
    log->flips += command->kind == TALUS_COMMAND_WORLD_FLIP;
}

static talus_status find_target(const talus_world *world, const talus_command *c, target of, uint32_t *i) {
    const talus_body body = {c->index, c->generation};
    const talus_shape shape = {c->index, c->generation};
    const talus_joint joint = {c->index, c->generation};
    switch (of) {
    case TARGET_BODY:
        return tl_find_body(world, body, i);
    case TARGET_SHAPE:
        return tl_find_shape(world, shape, i);
    case TARGET_JOINT:
        return tl_find_joint(world, joint, i);
    default:
        return TALUS_OK;
    }
}

talus_status talus_world_apply(talus_world *world, talus_command *command) {
    if (!tl_world_is_sound(world) || !command || (unsigned)command->kind >= TALUS_COMMAND_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    const command_info *info = &COMMANDS[command->kind];
    uint32_t i = 0;
    talus_status status = find_target(world, command, info->target, &i);
    if (status == TALUS_OK) {
        if (info->defines) {
            tl_header_of(world)->defined = 0;
        }
        status = info->run(world, i, command);
    }
    if (status == TALUS_OK && world->log) {
        add_to_log(world->log, command);
    }
    return status;
}
