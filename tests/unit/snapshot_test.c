/* Snapshots: a restored world goes on bit for bit, whatever happened in between; damaged ones are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "talus/talus.h"
#include "world/pack.h"

enum { BODIES = 60, JOINTS = 20 };

/* How many worlds, and steps of each: TALUS_WORLDS, TALUS_STEPS. */
static uint32_t setting(const char *name, uint32_t otherwise) {
    const char *text = getenv(name);
    return text ? (uint32_t)strtoul(text, NULL, 10) : otherwise;
}

typedef struct yard {
    talus_world world;
    void *block;
    uint32_t seed;
    talus_body body[BODIES];
    talus_shape shape[BODIES];
    talus_joint joint[JOINTS];
} yard;

static uint32_t pick(yard *y, uint32_t below) {
    y->seed = y->seed * 1664525u + 1013904223u;
    return (y->seed >> 8) % below;
}

static float between(yard *y, float low, float high) { return low + (high - low) * (float)pick(y, 65536) / 65536.0f; }

static void open_yard(yard *y, uint32_t seed, uint32_t contacts) {
    memset(y, 0, sizeof *y);
    y->seed = seed;
    talus_world_def def = talus_world_def_default();
    def.body_capacity = BODIES, def.shape_capacity = BODIES + 20, def.joint_capacity = JOINTS;
    def.contact_capacity = contacts;
    def.sleep_time = 0.1f;
    size_t size = talus_world_size(&def);
    y->block = aligned_alloc(TALUS_BLOCK_ALIGNMENT, (size + 63u) / 64u * 64u);
    assert_int_equal(talus_world_init(&y->world, &def, y->block, size), TALUS_OK);
    talus_shape_def ground = talus_shape_def_default();
    ground.geometry.half = (talus_vec3){10.0f, 0.5f, 10.0f};
    ground.pose.position.y = -0.5f;
    talus_shape shape;
    assert_int_equal(talus_shape_create(&y->world, talus_world_ground(&y->world), &ground, &shape), TALUS_OK);
}

/* Too few on purpose, in every third world by far, so that there is no room for pairs either. */
static uint32_t contacts_of(uint32_t world) { return world % 3u == 2u ? 12u : 200u; }

static void close_yard(yard *y) { free(y->block); }

static void add_body(yard *y, uint32_t i) {
    talus_body_def def = talus_body_def_default();
    def.type = pick(y, 8) ? TALUS_DYNAMIC : pick(y, 2) ? TALUS_KINEMATIC : TALUS_STATIC;
    def.pose.position = (talus_vec3){between(y, -4, 4), between(y, 0, 5), between(y, -4, 4)};
    def.angular_velocity.y = between(y, -1, 1);
    if (talus_body_create(&y->world, &def, &y->body[i]) != TALUS_OK) {
        return;
    }
    for (uint32_t k = 0; k <= pick(y, 3); k++) {
        talus_shape_def s = talus_shape_def_default();
        s.geometry.type = (talus_shape_type)pick(y, 4);
        s.geometry.radius = s.geometry.radius_top = s.geometry.radius_bottom = between(y, 0.2f, 0.5f);
        s.geometry.half_height = between(y, 0.1f, 0.5f);
        s.sensor = pick(y, 9) == 0;
        s.events = pick(y, 2) == 0;
        talus_shape_create(&y->world, y->body[i], &s, &y->shape[i]);
    }
}

/* What changes a body or shape that is there. */
static void change(yard *y, uint32_t i) {
    talus_filter filter = {1u + pick(y, 3), pick(y, 3) ? ~(uint64_t)0 : pick(y, 4), pick(y, 5) ? 0 : -1};
    talus_material material = talus_shape_def_default().material;
    switch (pick(y, 7)) {
    case 0:
    case 1:
        talus_shape_set_filter(&y->world, y->shape[i], &filter);
        break;
    case 2:
        material.static_friction = material.dynamic_friction = between(y, 0, 1);
        talus_shape_set_material(&y->world, y->shape[i], &material);
        break;
    case 3:
        talus_shape_destroy(&y->world, y->shape[i]);
        break;
    case 4:
        talus_body_set_locks(&y->world, y->body[i], pick(y, 64));
        break;
    case 5:
        talus_body_wake(&y->world, y->body[i]);
        break;
    default:
        talus_body_mass_from_shapes(&y->world, y->body[i]);
        break;
    }
}

static void add_joint(yard *y) {
    talus_joint_def def = talus_joint_def_default();
    def.a = y->body[pick(y, BODIES)], def.b = y->body[pick(y, BODIES)];
    if (pick(y, 2)) {
        talus_joint_make_ball(&def);
    } else {
        talus_joint_make_distance(&def, 0.5f, 1.5f);
    }
    def.break_force = pick(y, 3) ? 0.0f : 500.0f;
    talus_joint_create(&y->world, &def, &y->joint[pick(y, JOINTS)]);
}

/* One random command; many are refused, which is part of the test. */
static void command(yard *y) {
    uint32_t i = pick(y, BODIES);
    switch (pick(y, 12)) {
    case 0:
    case 1:
    case 2:
        if (!talus_body_is_valid(&y->world, y->body[i])) {
            add_body(y, i);
        }
        break;
    case 3:
        talus_body_destroy(&y->world, y->body[i]);
        break;
    case 4:
        add_joint(y);
        break;
    case 5:
        talus_joint_destroy(&y->world, y->joint[pick(y, JOINTS)]);
        break;
    case 6: {
        talus_pose pose = {{between(y, -4, 4), between(y, 0, 5), between(y, -4, 4)}, {0, 0, 0, 1}};
        talus_body_set_pose(&y->world, y->body[i], &pose);
        break;
    }
    case 7:
        talus_body_sleep(&y->world, y->body[i]);
        break;
    case 8:
        talus_body_set_velocity(&y->world, y->body[i], (talus_vec3){between(y, -3, 3), 0, 0}, (talus_vec3){0, 0, 0});
        break;
    case 9:
    case 10:
        change(y, i);
        break;
    default:
        talus_body_apply_impulse(&y->world, y->body[i], (talus_vec3){0, between(y, 0, 500), 0},
                                 (talus_vec3){between(y, -4, 4), 0, 0});
        break;
    }
}

static void *save(const yard *y, size_t *size) {
    size_t most = talus_world_save_size(&y->world);
    void *snapshot = malloc(most);
    assert_non_null(snapshot);
    assert_int_equal(talus_world_save(&y->world, snapshot, most, size), TALUS_OK);
    assert_true(*size <= most);
    return snapshot;
}

static void assert_alike(const talus_world *a, const talus_world *b) {
    talus_parting d;
    if (talus_world_hash(a) != talus_world_hash(b) && talus_world_part(a, b, 0, &d) == 1) {
        print_error("differ in %s, row %u, word %u\n", d.column.name, (unsigned)d.row, (unsigned)d.word);
    }
    assert_true(talus_world_hash(a) == talus_world_hash(b));
}

/* Saves, runs a few steps with commands, restores, runs the same again: every hash must come back. */
static void goes_on_bit_for_bit(void **state) {
    (void)state;
    uint32_t base = 20260801u;
    uint32_t worlds = setting("TALUS_WORLDS", 12), steps = setting("TALUS_STEPS", 120);
    print_message("%u worlds of %u steps from seed %u\n", (unsigned)worlds, (unsigned)steps, (unsigned)base);
    for (uint32_t w = 0; w < worlds; w++) {
        yard y;
        open_yard(&y, base + w, contacts_of(w));
        for (uint32_t k = 0; k < steps; k++) {
            size_t size;
            void *snapshot = save(&y, &size);
            uint64_t at = talus_world_hash(&y.world), hash[3];
            yard here = y;
            for (int round = 0; round < 2; round++) {
                for (int s = 0; s < 3; s++) {
                    command(&y);
                    talus_world_step(&y.world, 1.0f / 60.0f, NULL, NULL);
                    if (round == 0) {
                        hash[s] = talus_world_hash(&y.world);
                    } else {
                        assert_true(talus_world_hash(&y.world) == hash[s]);
                    }
                }
                if (round == 0) {
                    assert_int_equal(talus_world_restore(&y.world, snapshot, size), TALUS_OK);
                    assert_true(talus_world_hash(&y.world) == at);
                    assert_int_equal(talus_world_validate(&y.world), TALUS_OK);
                    y.seed = here.seed;
                    memcpy(y.body, here.body, sizeof y.body);
                    memcpy(y.joint, here.joint, sizeof y.joint);
                    memcpy(y.shape, here.shape, sizeof y.shape);
                }
            }
            free(snapshot);
        }
        close_yard(&y);
    }
}

/* Into a new world and into one that went elsewhere: their trees, pairs and lists differ from those of the world that
 * was saved, and none of it may show. */
static void goes_into_other_blocks(void **state) {
    (void)state;
    uint32_t base = 20261101u;
    uint32_t worlds = setting("TALUS_WORLDS", 12), steps = setting("TALUS_STEPS", 120);
    print_message("%u worlds of %u steps from seed %u\n", (unsigned)worlds, (unsigned)steps, (unsigned)base);
    for (uint32_t w = 0; w < worlds; w++) {
        yard y[3];
        for (int i = 0; i < 3; i++) {
            open_yard(&y[i], base + w, contacts_of(w));
        }
        for (uint32_t k = 0; k < steps; k++) {
            if (k % 6u == 0) {
                size_t size;
                void *snapshot = save(&y[0], &size);
                close_yard(&y[1]);
                open_yard(&y[1], 1, contacts_of(w));
                y[2].seed = base ^ k;
                command(&y[2]);
                talus_world_step(&y[2].world, 1.0f / 60.0f, NULL, NULL);
                for (int i = 1; i < 3; i++) {
                    talus_world into = y[i].world;
                    void *block = y[i].block;
                    assert_int_equal(talus_world_restore(&into, snapshot, size), TALUS_OK);
                    assert_int_equal(talus_world_validate(&into), TALUS_OK);
                    y[i] = y[0];
                    y[i].world = into, y[i].block = block;
                }
                free(snapshot);
            }
            for (int i = 0; i < 3; i++) {
                command(&y[i]);
                talus_world_step(&y[i].world, 1.0f / 60.0f, NULL, NULL);
                assert_alike(&y[i].world, &y[0].world);
            }
        }
        for (int i = 0; i < 3; i++) {
            close_yard(&y[i]);
        }
    }
}

static void newer_handles_are_stale(void **state) {
    (void)state;
    yard y;
    open_yard(&y, 3, 200);
    add_body(&y, 0);
    size_t size;
    void *snapshot = save(&y, &size);
    add_body(&y, 1);
    assert_true(talus_body_is_valid(&y.world, y.body[1]));
    talus_body_destroy(&y.world, y.body[0]);
    assert_int_equal(talus_world_restore(&y.world, snapshot, size), TALUS_OK);
    assert_true(talus_body_is_valid(&y.world, y.body[0]));
    assert_false(talus_body_is_valid(&y.world, y.body[1]));
    free(snapshot);
    close_yard(&y);
}

static void damaged_ones_are_refused(void **state) {
    (void)state;
    yard y;
    open_yard(&y, 5, 200);
    for (int k = 0; k < 30; k++) {
        command(&y);
        talus_world_step(&y.world, 1.0f / 60.0f, NULL, NULL);
    }
    size_t size;
    unsigned char *snapshot = save(&y, &size);
    uint64_t hash = talus_world_hash(&y.world);
    size_t most = talus_world_save_size(&y.world), written = 77;
    unsigned char *room = malloc(most);
    assert_int_equal(talus_world_save(&y.world, room, most - 1u, &written), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_world_save(&y.world, NULL, most, &written), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_world_save(&y.world, room, most, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(written, 77);
    free(room);
    assert_int_equal(talus_world_restore(&y.world, snapshot, size - 4u), TALUS_BAD_BLOB);
    assert_int_equal(talus_world_restore(&y.world, snapshot, 3), TALUS_BAD_BLOB);
    assert_int_equal(talus_world_restore(&y.world, snapshot + 1, size - 1u), TALUS_BAD_BLOB);
    assert_int_equal(talus_world_restore(&y.world, NULL, size), TALUS_BAD_ARGUMENT);
    /* Any bit: refused with nothing changed. */
    for (size_t bit = 0; bit < 8u * size; bit += bit < 8u * 200u ? 1u : 5u) {
        snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        assert_int_equal(talus_world_restore(&y.world, snapshot, size), TALUS_BAD_BLOB);
        snapshot[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        assert_true(bit % 64u || talus_world_hash(&y.world) == hash);
    }
    /* Any bit with a checksum to match: taken or refused, without reading out of range. */
    uint32_t taken = 0, refused = 0;
    unsigned char *forged = malloc(size);
    for (size_t bit = 8u * 20u; bit < 8u * size; bit += 7u) {
        memcpy(forged, snapshot, size);
        forged[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
        uint64_t sum = tl_pack_checksum(forged + 20, size - 20u);
        tl_put_word(forged + 12, (uint32_t)sum);
        tl_put_word(forged + 16, (uint32_t)(sum >> 32));
        talus_status status = talus_world_restore(&y.world, forged, size);
        assert_true(status == TALUS_OK || status == TALUS_BAD_BLOB);
        taken += status == TALUS_OK, refused += status != TALUS_OK;
        (void)talus_world_validate(&y.world);
    }
    assert_true(taken > 0 && refused > 0);
    assert_int_equal(talus_world_restore(&y.world, snapshot, size), TALUS_OK);
    assert_true(talus_world_hash(&y.world) == hash);
    free(forged);
    yard other;
    open_yard(&other, 6, 200);
    talus_world_def def;
    talus_world_get_def(&other.world, &def);
    def.body_capacity++;
    size_t bytes = talus_world_size(&def);
    void *block = aligned_alloc(TALUS_BLOCK_ALIGNMENT, (bytes + 63u) / 64u * 64u);
    talus_world larger;
    assert_int_equal(talus_world_init(&larger, &def, block, bytes), TALUS_OK);
    assert_int_equal(talus_world_restore(&larger, snapshot, size), TALUS_BAD_BLOB);
    free(block);
    free(snapshot);
    close_yard(&other);
    close_yard(&y);
}

/* A body on a joint and one that moves, for one command of each kind. */
typedef struct couple {
    talus_body body, mover; /* dynamic, kinematic */
    talus_shape shape;
    talus_joint joint;
} couple;

static couple add_couple(talus_world *world) {
    couple c;
    talus_body_def def = talus_body_def_default();
    talus_shape_def ball = talus_shape_def_default();
    talus_joint_def joint = talus_joint_def_default();
    ball.geometry.type = TALUS_SPHERE;
    ball.geometry.radius = 0.3f;
    talus_joint_make_ball(&joint);
    def.type = TALUS_DYNAMIC;
    def.pose.position.y = 3.0f;
    assert_int_equal(talus_body_create(world, &def, &c.body), TALUS_OK);
    assert_int_equal(talus_shape_create(world, c.body, &ball, &c.shape), TALUS_OK);
    joint.b = c.body;
    assert_int_equal(talus_joint_create(world, &joint, &c.joint), TALUS_OK);
    def.type = TALUS_KINEMATIC;
    assert_int_equal(talus_body_create(world, &def, &c.mover), TALUS_OK);
    return c;
}

/* A command that is carried out and changes the state. */
static talus_command command_of(talus_command_kind kind, const couple *c) {
    talus_command command;
    memset(&command, 0, sizeof command);
    command.kind = kind;
    command.index = c->body.index, command.generation = c->body.generation;
    switch (kind) {
    case TALUS_COMMAND_WORLD_STEP:
        command.as.step.dt = 1.0f / 60.0f;
        break;
    case TALUS_COMMAND_WORLD_FLIP: /* the user data of the last body */
        for (talus_column column;
             talus_column_get(command.as.flip.column, &column) == TALUS_OK && strcmp(column.name, "body_user") != 0;) {
            command.as.flip.column++;
        }
        command.as.flip.row = c->body.index;
        break;
    case TALUS_COMMAND_BODY_CREATE:
        command.as.body = talus_body_def_default();
        break;
    case TALUS_COMMAND_BODY_SET_POSE:
        command.as.pose.rotation.w = 1.0f;
        break;
    case TALUS_COMMAND_BODY_MOVE_TO:
        command.as.move.pose.rotation.w = command.as.move.dt = 1.0f;
        command.index = c->mover.index, command.generation = c->mover.generation;
        break;
    case TALUS_COMMAND_BODY_SET_MASS:
        command.as.mass.mass = command.as.mass.center.x = 2.0f;
        command.as.mass.inertia.x.x = command.as.mass.inertia.y.y = command.as.mass.inertia.z.z = 1.0f;
        break;
    case TALUS_COMMAND_BODY_SET_DAMPING:
    case TALUS_COMMAND_BODY_SET_GRAVITY_SCALE:
        command.as.damping.linear = 0.5f; /* and the scale */
        break;
    case TALUS_COMMAND_BODY_SET_LOCKS:
        command.as.locks = 1;
        break;
    case TALUS_COMMAND_SHAPE_CREATE:
        command.as.shape.body = c->body, command.as.shape.def = talus_shape_def_default();
        break;
    case TALUS_COMMAND_SHAPE_SET_MATERIAL:
        command.as.material = talus_shape_def_default().material;
        command.as.material.restitution = 0.7f;
        break;
    case TALUS_COMMAND_SHAPE_SET_FILTER:
        command.as.filter.category = 2;
        break;
    case TALUS_COMMAND_JOINT_CREATE:
        command.as.joint = talus_joint_def_default();
        talus_joint_make_ball(&command.as.joint);
        command.as.joint.b = c->body;
        break;
    case TALUS_COMMAND_WORLD_SET_ACCURACY:
        command.as.accuracy.error_budget = 1e-3f;
        command.as.accuracy.substeps = 4, command.as.accuracy.most_substeps = 8;
        break;
    case TALUS_COMMAND_JOINT_SET_DRIVE:
        command.as.drive.drive.enabled = 1, command.as.drive.drive.stiffness = 5.0f;
        break;
    default:
        command.as.push.linear.x = command.as.push.angular.y = 1.0f;
        break;
    }
    if (kind >= TALUS_COMMAND_SHAPE_DESTROY && kind <= TALUS_COMMAND_SHAPE_SET_FILTER) {
        command.index = c->shape.index, command.generation = c->shape.generation;
    } else if (kind >= TALUS_COMMAND_JOINT_DESTROY) {
        command.index = c->joint.index, command.generation = c->joint.generation;
    }
    return command;
}

/* What a snapshot before a command left in the block is in no snapshot after it. */
static void every_command_is_in_the_next(void **state) {
    (void)state;
    for (uint32_t kind = 0; kind < TALUS_COMMAND_COUNT; kind++) {
        yard y, other;
        open_yard(&y, 7, 200);
        open_yard(&other, 8, 200);
        couple c = add_couple(&y.world);
        talus_command command = command_of((talus_command_kind)kind, &c);
        size_t most = 2u * talus_world_save_size(&y.world), before = 0, after = 0, again = 0;
        unsigned char *first = malloc(most), *second = malloc(most), *third = malloc(most);
        assert_int_equal(talus_world_save(&y.world, first, most, &before), TALUS_OK);
        uint64_t hash = talus_world_hash(&y.world);
        print_message("%s\n", talus_command_name(command.kind));
        assert_int_equal(talus_world_apply(&y.world, &command), TALUS_OK);
        uint64_t changed = talus_world_hash(&y.world);
        assert_int_equal(talus_world_save(&y.world, second, most, &after), TALUS_OK);
        assert_int_equal(talus_world_restore(&other.world, second, after), TALUS_OK);
        assert_true(talus_world_hash(&other.world) == changed);
        assert_int_equal(talus_world_save(&other.world, third, most, &again), TALUS_OK);
        assert_int_equal(again, after);
        assert_memory_equal(third, second, after);
        assert_int_equal(talus_world_restore(&y.world, first, before), TALUS_OK);
        assert_true(talus_world_hash(&y.world) == hash);
        assert_int_equal(talus_world_save(&y.world, third, most, &again), TALUS_OK);
        assert_int_equal(again, before);
        assert_memory_equal(third, first, before);
        assert_int_equal(talus_world_restore(&y.world, second, after), TALUS_OK);
        assert_true(talus_world_hash(&y.world) == changed);
        free(first), free(second), free(third);
        close_yard(&other);
        close_yard(&y);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_on_bit_for_bit),          cmocka_unit_test(goes_into_other_blocks),
        cmocka_unit_test(newer_handles_are_stale),      cmocka_unit_test(damaged_ones_are_refused),
        cmocka_unit_test(every_command_is_in_the_next),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
