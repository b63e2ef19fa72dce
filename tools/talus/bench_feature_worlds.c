/* The worlds of `talus bench features`. What is added lies a kilometre off, so that no box of the scene meets it. */
#include "bench_features.h"

#include <stdlib.h>
#include <string.h>

#define EXTRA 100u           /* of each feature */
#define SHIFTS 61u           /* places that blocks are put at: caches make some of them faster */
#define HUGE_PAGE (2u << 20) /* which of a block's pages are huge ones makes a tenth: all begin at one */

/* --- bodies --- */

static int add_body(talus_world *world, talus_body_type type, float x, float y, float z, const talus_shape_def *shape,
                    talus_body *out) {
    talus_body_def def = talus_body_def_default();
    talus_shape made;
    def.type = type;
    def.can_sleep = x > 500.0f; /* what the scene itself has is to stay awake */
    def.pose.position.x = x, def.pose.position.y = y, def.pose.position.z = z;
    return talus_body_create(world, &def, out) == TALUS_OK && talus_shape_create(world, *out, shape, &made) == TALUS_OK
               ? 0
               : -1;
}

static int add_box(talus_world *world, float x, float y, float z, float half) {
    talus_shape_def box = talus_shape_def_default();
    talus_body body;
    box.geometry.half.x = box.geometry.half.y = box.geometry.half.z = half;
    return add_body(world, TALUS_DYNAMIC, x, y, z, &box, &body);
}

/* Dynamic bodies of a shape in a row, asleep. */
static int add_locked_sleepers(talus_world *world, uint32_t count, const talus_shape_def *shape, uint32_t locks) {
    int status = 0;
    for (uint32_t i = 0; i < count && status == 0; i++) {
        talus_body body;
        status = add_body(world, TALUS_DYNAMIC, 1000.0f + 3.0f * (float)i, 1.0f, 0.0f, shape, &body);
        if (status == 0 &&
            (talus_body_set_locks(world, body, locks) != TALUS_OK || talus_body_sleep(world, body) != TALUS_OK)) {
            status = -1;
        }
    }
    return status;
}

static int add_sleepers(talus_world *world, uint32_t count, const talus_shape_def *shape) {
    return add_locked_sleepers(world, count, shape, 0);
}

/* --- scenes --- */

static int fill_pyramid(talus_world *world, uint32_t bodies) {
    uint32_t left = bodies;
    int status = 0;
    for (uint32_t row = 0, width = 20; width > 0 && left > 0; row++, width--) {
        for (uint32_t i = 0; i < width && left > 0; i++, left--) {
            status |= add_box(world, (float)i - 0.5f * (float)width, 0.5f + (float)row, 0.0f, 0.495f);
        }
    }
    return status;
}

static int fill_pile(talus_world *world, uint32_t bodies) {
    int status = 0;
    for (uint32_t i = 0; i < bodies; i++) {
        float turn = 0.13f * (float)(i % 7);
        status |= add_box(world, (float)(i % 8) + turn, 1.0f + 1.2f * (float)(i / 64), (float)(i / 8 % 8) - turn, 0.5f);
    }
    return status;
}

const feature_scene feature_scenes[] = {{"pyramid", 210, 120, fill_pyramid}, {"pile", 500, 120, fill_pile}};
const uint32_t feature_scene_count = sizeof feature_scenes / sizeof *feature_scenes;

/* --- features --- */

static int add_balls(talus_world *world, uint32_t count) {
    talus_shape_def ball = talus_shape_def_default();
    ball.geometry.type = TALUS_SPHERE;
    ball.geometry.radius = 0.5f;
    return add_sleepers(world, count, &ball);
}

static int add_bouncing(talus_world *world, uint32_t count) {
    talus_shape_def box = talus_shape_def_default();
    box.material.restitution = 0.8f;
    return add_sleepers(world, count, &box);
}

static int add_rolling(talus_world *world, uint32_t count) {
    talus_shape_def ball = talus_shape_def_default();
    ball.geometry.type = TALUS_SPHERE;
    ball.geometry.radius = 0.5f;
    ball.material.rolling_resistance = 0.01f;
    return add_sleepers(world, count, &ball);
}

static int add_events(talus_world *world, uint32_t count) {
    talus_shape_def box = talus_shape_def_default();
    box.events = 1;
    return add_sleepers(world, count, &box);
}

static int add_planar(talus_world *world, uint32_t count) {
    talus_shape_def box = talus_shape_def_default();
    return add_locked_sleepers(world, count, &box, TALUS_LOCK_PLANE_Z);
}

static int add_fixed(talus_world *world, talus_body_type type, uint32_t count, int sensor) {
    talus_shape_def box = talus_shape_def_default();
    talus_body body;
    int status = 0;
    box.sensor = (uint8_t)sensor;
    for (uint32_t i = 0; i < count && status == 0; i++) {
        status = add_body(world, type, 1000.0f + 3.0f * (float)i, 1.0f, 0.0f, &box, &body);
    }
    return status;
}

static int add_statics(talus_world *world, uint32_t count) { return add_fixed(world, TALUS_STATIC, count, 0); }
static int add_kinematics(talus_world *world, uint32_t count) { return add_fixed(world, TALUS_KINEMATIC, count, 0); }
static int add_sensors(talus_world *world, uint32_t count) { return add_fixed(world, TALUS_STATIC, count, 1); }

/* Chains of `links` bodies on hinges. */
static int add_chains(talus_world *world, uint32_t count, uint32_t links) {
    talus_shape_def box = talus_shape_def_default();
    talus_joint_def hinge = talus_joint_def_default();
    talus_body last = {0, 0};
    int status = 0;
    talus_joint_make_revolute(&hinge);
    hinge.frame_a.position.x = 1.0f, hinge.frame_b.position.x = -1.0f;
    for (uint32_t i = 0; i < count && status == 0; i++) {
        talus_body body;
        talus_joint joint;
        status = add_body(world, TALUS_DYNAMIC, 1000.0f + 2.0f * (float)i, 1.0f, 0.0f, &box, &body);
        hinge.a = last, hinge.b = body;
        if (status == 0 && i % links != 0 && talus_joint_create(world, &hinge, &joint) != TALUS_OK) {
            status = -1;
        }
        last = body;
        if (status == 0 && i % links == links - 1 && talus_body_sleep(world, body) != TALUS_OK) {
            status = -1;
        }
    }
    return status;
}

static int add_joints(talus_world *world, uint32_t count) { return add_chains(world, count, 2); }
static int add_linkages(talus_world *world, uint32_t count) { return add_chains(world, count, 20); }

static void set_sleep(talus_world_def *def) { def->enable_sleep = 1; }
static void set_ring(talus_world_def *def) { def->profile_capacity = 64; }

/* Room for eight times as much of everything. */
static void set_room(talus_world_def *def) {
    def->body_capacity *= 8;
    def->shape_capacity *= 8;
    def->joint_capacity *= 8;
    def->contact_capacity *= 8;
    def->event_capacity *= 8;
}

const feature features[] = {{"nothing", "the same world twice: what the machine adds", NULL, NULL, 0},
                            {"joints", "50 pairs of bodies on a hinge, asleep", NULL, add_joints, 0},
                            {"linkages", "5 chains of 20 hinged bodies, asleep", NULL, add_linkages, 0},
                            {"restitution", "100 boxes that would bounce, asleep", NULL, add_bouncing, 0},
                            {"rolling", "100 balls that resist rolling, asleep", NULL, add_rolling, 0},
                            {"planar", "100 boxes locked to a plane, asleep", NULL, add_planar, 0},
                            {"events", "100 boxes that report touches, asleep", NULL, add_events, 0},
                            {"sensors", "100 sensors that hold nothing", NULL, add_sensors, 0},
                            {"kinematics", "100 kinematic boxes that stand still", NULL, add_kinematics, 0},
                            {"statics", "100 static boxes that nothing touches", NULL, add_statics, 0},
                            {"sleepers", "100 balls, asleep", NULL, add_balls, 0},
                            {"sleep", "sleep on, where nothing may fall asleep", set_sleep, NULL, 0},
                            {"room", "eight times the capacities", set_room, NULL, 0},
                            {"profiler", "a ring of 64 frames and a clock", set_ring, NULL, 1}};
const uint32_t feature_count = sizeof features / sizeof *features;

/* --- worlds --- */

int feature_make(const feature_scene *scene, const feature *f, int with, uint32_t place, talus_world *world,
                 void **memory) {
    talus_world_def def = talus_world_def_default();
    talus_shape_def ground = talus_shape_def_default();
    talus_shape made;
    def.body_capacity = def.shape_capacity = scene->bodies + EXTRA + 2;
    def.contact_capacity = 32 * scene->bodies;
    def.enable_sleep = 0;
    if (with && f->set != NULL) {
        f->set(&def);
    }
    ground.geometry.half.x = ground.geometry.half.z = 100.0f, ground.geometry.half.y = 1.0f;
    ground.pose.position.y = -1.0f;
    size_t size = talus_world_size(&def);
    *memory = malloc(size + 2 * HUGE_PAGE);
    if (*memory == NULL) {
        return -1;
    }
    char *block = (char *)*memory + (HUGE_PAGE - (uintptr_t)*memory % HUGE_PAGE);
    block += place % SHIFTS * TALUS_BLOCK_ALIGNMENT;
    if (talus_world_init(world, &def, block, size) != TALUS_OK ||
        talus_shape_create(world, talus_world_ground(world), &ground, &made) != TALUS_OK ||
        scene->fill(world, scene->bodies) != 0) {
        return -1;
    }
    return with && f->add != NULL ? f->add(world, EXTRA) : 0;
}
