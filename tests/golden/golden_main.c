/* golden [ISA [SCENE]]: steps the scenes and prints a hash of each one; with SCENE, a hash of each step of that one.
 * golden --isas: the instruction sets that are here. */
#include "golden.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/trig.h"
#include "geom/hull.h"

uint32_t golden_hull[GOLDEN_HULLS];

static uint32_t state = 1;

void golden_seed(uint32_t seed) { state = seed % 2147483646u + 1u; }

uint32_t golden_next(void) {
    state = (uint32_t)((uint64_t)state * 48271u % 2147483647u);
    return state;
}

float golden_range(float lower, float upper) {
    float unit = (float)(int32_t)(golden_next() >> 8 & 0x3fffffu) * (1.0f / 4194304.0f);
    return lower + (upper - lower) * unit;
}

void golden_check(talus_status status, const char *what) {
    if (status != TALUS_OK) {
        fprintf(stderr, "%s: %s\n", what, talus_status_text(status));
        exit(1);
    }
}

talus_vec3 golden_vec(float x, float y, float z) {
    talus_vec3 v = {x, y, z};
    return v;
}

/* One number after the other: the order in which a call's arguments are worked out is the compiler's. */
talus_vec3 golden_any(talus_vec3 lower, talus_vec3 upper) {
    talus_vec3 v;
    v.x = golden_range(lower.x, upper.x);
    v.y = golden_range(lower.y, upper.y);
    v.z = golden_range(lower.z, upper.z);
    return v;
}

talus_vec3 golden_above(float half, float y) {
    return golden_any(golden_vec(-half, y, -half), golden_vec(half, y, half));
}

talus_quat golden_turn(void) {
    talus_vec3 v = golden_any(golden_vec(-1.0f, -1.0f, -1.0f), golden_vec(1.0f, 1.0f, 1.0f));
    talus_quat q = {v.x, v.y, v.z, golden_range(0.25f, 1.0f)};
    return q;
}

talus_body golden_body(talus_world *world, talus_body_type type, talus_vec3 at) {
    talus_body_def def = talus_body_def_default();
    talus_body body;
    def.type = type;
    def.pose.position = at;
    golden_check(talus_body_create(world, &def, &body), "body");
    return body;
}

talus_shape golden_shape(talus_world *world, talus_body body, const talus_shape_def *def) {
    talus_shape shape;
    golden_check(talus_shape_create(world, body, def, &shape), "shape");
    return shape;
}

talus_shape golden_box(talus_world *world, talus_body body, talus_vec3 half) {
    talus_shape_def def = talus_shape_def_default();
    def.geometry.half = half;
    return golden_shape(world, body, &def);
}

talus_shape golden_ball(talus_world *world, talus_body body, float radius) {
    talus_shape_def def = talus_shape_def_default();
    def.geometry.type = TALUS_SPHERE;
    def.geometry.radius = radius;
    return golden_shape(world, body, &def);
}

talus_joint golden_joint(talus_world *world, const talus_joint_def *def) {
    talus_joint joint;
    golden_check(talus_joint_create(world, def, &joint), "joint");
    return joint;
}

void golden_floor(talus_world *world) {
    talus_shape_def def = talus_shape_def_default();
    def.geometry.half = golden_vec(50.0f, 1.0f, 50.0f);
    def.pose.position.y = -1.0f;
    def.events = 1;
    golden_shape(world, talus_world_ground(world), &def);
}

/* --- what is hashed --------------------------------------------------------------------------------- */

static uint64_t fold_shapes(uint64_t hash, talus_shape a, talus_shape b) {
    return golden_fold(golden_fold(golden_fold(golden_fold(hash, a.index), a.generation), b.index), b.generation);
}

static uint64_t fold_events(uint64_t hash, const talus_world *world) {
    talus_events e;
    golden_check(talus_world_get_events(world, &e), "events");
    for (uint32_t i = 0; i < e.begin_count; i++) {
        hash = fold_shapes(hash, e.begin[i].a, e.begin[i].b);
    }
    for (uint32_t i = 0; i < e.end_count; i++) {
        hash = fold_shapes(hash, e.end[i].a, e.end[i].b);
    }
    for (uint32_t i = 0; i < e.hit_count; i++) {
        hash = golden_fold_float(fold_shapes(hash, e.hit[i].a, e.hit[i].b), e.hit[i].speed);
        hash = golden_fold_float(golden_fold_float(golden_fold_float(hash, e.hit[i].point.x), e.hit[i].point.y),
                                 e.hit[i].point.z);
        hash = golden_fold_float(golden_fold_float(golden_fold_float(hash, e.hit[i].normal.x), e.hit[i].normal.y),
                                 e.hit[i].normal.z);
    }
    for (uint32_t i = 0; i < e.sensor_begin_count; i++) {
        hash = fold_shapes(hash, e.sensor_begin[i].sensor, e.sensor_begin[i].visitor);
    }
    for (uint32_t i = 0; i < e.sensor_end_count; i++) {
        hash = fold_shapes(hash, e.sensor_end[i].sensor, e.sensor_end[i].visitor);
    }
    for (uint32_t i = 0; i < e.broken_count; i++) {
        hash = golden_fold(golden_fold(hash, e.broken[i].joint.index), e.broken[i].joint.generation);
    }
    return golden_fold(hash, e.dropped);
}

static void print(const char *name, uint32_t steps, uint64_t hash) {
    printf("%s %lu %08lx%08lx\n", name, (unsigned long)steps, (unsigned long)(hash >> 32),
           (unsigned long)(hash & 0xffffffffu));
}

static uint64_t fold_bytes(uint64_t hash, const unsigned char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        hash = golden_fold(hash, bytes[i]);
    }
    return hash;
}

/* A world in a block of its own. */
typedef struct own_world {
    talus_world world;
    unsigned char *memory;
} own_world;

static unsigned char *more_memory(size_t size) {
    unsigned char *memory = malloc(size);
    if (!memory) {
        fprintf(stderr, "no memory\n");
        exit(1);
    }
    return memory;
}

static own_world open_world(const talus_world_def *def, const void *geometry, size_t geometry_bytes) {
    own_world own;
    size_t size = talus_world_size(def);
    own.memory = more_memory(size + TALUS_BLOCK_ALIGNMENT);
    unsigned char *block = own.memory + (TALUS_BLOCK_ALIGNMENT - (uintptr_t)own.memory % TALUS_BLOCK_ALIGNMENT);
    golden_check(talus_world_init(&own.world, def, block, size), "init");
    own.world.geometry = geometry;
    own.world.geometry_bytes = geometry_bytes;
    return own;
}

/* Goes on in another block from a snapshot, whose bytes must be the same everywhere too. */
static uint64_t move_house(own_world *own, const talus_world_def *def, uint64_t hash) {
    size_t most = talus_world_save_size(&own->world), written = 0;
    unsigned char *bytes = more_memory(most);
    golden_check(talus_world_save(&own->world, bytes, most, &written), "save");
    hash = fold_bytes(hash, bytes, written);
    own_world other = open_world(def, own->world.geometry, own->world.geometry_bytes);
    golden_check(talus_world_restore(&other.world, bytes, written), "restore");
    free(own->memory);
    free(bytes);
    *own = other;
    return hash;
}

static void run(const golden_scene *scene, talus_isa isa, const void *geometry, size_t geometry_bytes, int trace) {
    talus_world_def def = talus_world_def_default();
    def.body_capacity = 256, def.shape_capacity = 512, def.joint_capacity = 128;
    def.contact_capacity = 1536, def.event_capacity = 48;
    def.isa = isa;
    own_world own = open_world(&def, geometry, geometry_bytes);
    golden_seed(20250101u);
    scene->build(&own.world);
    uint64_t hash = 0;
    for (uint32_t i = 0; i < scene->steps; i++) {
        if (i == scene->steps / 2u) {
            hash = move_house(&own, &def, hash);
        }
        if (scene->each) {
            scene->each(&own.world, i);
        }
        golden_check(talus_world_step(&own.world, 1.0f / 60.0f, NULL, NULL), "step");
        hash = fold_events(hash, &own.world);
        if (trace) {
            print(scene->name, i + 1u, talus_world_hash(&own.world));
        }
    }
    uint64_t last = talus_world_hash(&own.world);
    hash = golden_fold(golden_fold(hash, (uint32_t)(last >> 32)), (uint32_t)last);
    if (!trace) {
        print(scene->name, scene->steps, hash);
    }
    free(own.memory);
}

/* What rays, casts and the other queries answer in a scene after some steps. */
static void run_queries(const golden_scene *scene, talus_isa isa, const void *geometry, size_t geometry_bytes) {
    enum { STEPS = 60, ROUNDS = 300 };
    talus_world_def def = talus_world_def_default();
    def.body_capacity = 256, def.shape_capacity = 512, def.contact_capacity = 1536;
    def.isa = isa;
    own_world own = open_world(&def, geometry, geometry_bytes);
    golden_seed(20250101u);
    scene->build(&own.world);
    for (uint32_t i = 0; i < STEPS; i++) {
        if (scene->each) {
            scene->each(&own.world, i);
        }
        golden_check(talus_world_step(&own.world, 1.0f / 60.0f, NULL, NULL), "step");
    }
    print("queries", ROUNDS, golden_queries(&own.world, ROUNDS));
    free(own.memory);
}

/* A recording of a scene, keyframes among it, byte for byte. */
static void run_recording(const golden_scene *scene, talus_isa isa, const void *geometry, size_t geometry_bytes) {
    talus_world_def def = talus_world_def_default();
    talus_recorder recorder;
    const void *bytes;
    size_t size, total = 0;
    uint64_t hash = 0;
    def.body_capacity = 256, def.shape_capacity = 512, def.joint_capacity = 128, def.contact_capacity = 1536;
    def.isa = isa;
    own_world own = open_world(&def, geometry, geometry_bytes);
    size_t room = talus_recorder_size(&own.world, 1u << 16);
    unsigned char *memory = more_memory(room);
    golden_check(talus_recorder_begin(&recorder, &own.world, memory, room, &bytes, &size), "recording");
    recorder.keyframe_work = 2000u;
    hash = fold_bytes(hash, bytes, size), total += size;
    golden_seed(20250101u);
    scene->build(&own.world);
    for (uint32_t i = 0; i < scene->steps; i++) {
        if (scene->each) {
            scene->each(&own.world, i);
        }
        golden_check(talus_world_step(&own.world, 1.0f / 60.0f, NULL, NULL), "step");
        golden_check(talus_recorder_step(&recorder, &own.world, &bytes, &size), "a recorded step");
        hash = fold_bytes(hash, bytes, size), total += size;
    }
    golden_check(talus_recorder_end(&recorder, &own.world, &bytes, &size), "the recording's end");
    hash = fold_bytes(hash, bytes, size), total += size;
    print("recording", scene->steps, golden_fold(hash, (uint32_t)total));
    free(memory);
    free(own.memory);
}

/* --- what needs no world ---------------------------------------------------------------------------- */

static void run_trigonometry(void) {
    uint64_t hash = 0;
    golden_seed(7u);
    for (int i = 0; i < 20000; i++) {
        float x = golden_range(-100.0f, 100.0f), y = golden_range(-100.0f, 100.0f), u = golden_range(-1.0f, 1.0f);
        hash = golden_fold_float(golden_fold_float(hash, tl_sin(x)), tl_cos(x));
        hash = golden_fold_float(golden_fold_float(hash, tl_atan2(y, x)), tl_acos(u));
    }
    print("trigonometry", 20000, hash);
}

/* A blob by its members: words of 32 bits up to the links, which have 16. The checksum is of one machine's bytes. */
static uint64_t fold_hull(uint64_t hash, const unsigned char *blob) {
    talus_hull h;
    memcpy(&h, blob, sizeof h);
    for (size_t i = 0; i < h.vertex_edge; i += 4u) {
        uint32_t word;
        memcpy(&word, blob + i, 4u);
        hash = i == offsetof(talus_hull, checksum) ? hash : golden_fold(hash, word);
    }
    for (size_t i = h.vertex_edge; i < h.bytes; i += 2u) {
        uint16_t word;
        memcpy(&word, blob + i, 2u);
        hash = golden_fold(hash, word);
    }
    return hash;
}

/* Cooks the hulls. */
static size_t run_hulls(unsigned char *region, size_t room) {
    static talus_vec3 points[200];
    static const uint32_t counts[GOLDEN_HULLS] = {12, 24, 60, 200};
    uint64_t hash = 0;
    size_t used = 0;
    golden_seed(99u);
    size_t scratch_size = talus_hull_scratch_size(200);
    unsigned char *scratch = malloc(scratch_size + TALUS_BLOB_ALIGNMENT);
    if (!scratch) {
        exit(1);
    }
    unsigned char *aligned = scratch + (TALUS_BLOB_ALIGNMENT - (uintptr_t)scratch % TALUS_BLOB_ALIGNMENT);
    for (uint32_t k = 0; k < GOLDEN_HULLS; k++) {
        size_t size;
        float wide = 0.2f + 0.1f * (float)k;
        for (uint32_t i = 0; i < counts[k]; i++) {
            points[i] = golden_any(golden_vec(-wide, -0.3f, -0.4f), golden_vec(wide, 0.3f, 0.4f));
        }
        golden_check(talus_hull_build(points, counts[k], aligned, scratch_size, region + used, room - used, &size),
                     "hull");
        golden_hull[k] = (uint32_t)used;
        hash = fold_hull(hash, region + used);
        used += (size + TALUS_BLOB_ALIGNMENT - 1u) / TALUS_BLOB_ALIGNMENT * TALUS_BLOB_ALIGNMENT;
    }
    free(scratch);
    print("hulls", GOLDEN_HULLS, hash);
    return used;
}

static int find_isa(const char *name, talus_isa *isa) {
    for (int i = 0; i < TALUS_ISA_COUNT; i++) {
        if (strcmp(name, talus_isa_name((talus_isa)i)) == 0 && talus_isa_available((talus_isa)i)) {
            *isa = (talus_isa)i;
            return 1;
        }
    }
    return 0;
}

static void run_all(const golden_scene *scenes, unsigned count, const char *only, talus_isa isa, const void *geometry,
                    size_t bytes) {
    for (unsigned i = 0; i < count; i++) {
        if (!only || strcmp(only, scenes[i].name) == 0) {
            run(&scenes[i], isa, geometry, bytes, only != NULL);
        }
    }
}

int main(int argc, char **argv) {
    static unsigned char memory[1u << 18];
    talus_isa isa = TALUS_ISA_BEST;
    if (argc > 1 && strcmp(argv[1], "--isas") == 0) {
        for (int i = TALUS_ISA_BEST + 1; i < TALUS_ISA_COUNT; i++) {
            if (talus_isa_available((talus_isa)i)) {
                printf("%s\n", talus_isa_name((talus_isa)i));
            }
        }
        return 0;
    }
    if (argc > 1 && !find_isa(argv[1], &isa)) {
        fprintf(stderr, "%s is not here\n", argv[1]);
        return 2;
    }
    const char *only = argc > 2 ? argv[2] : NULL;
    unsigned char *region = memory + (TALUS_BLOB_ALIGNMENT - (uintptr_t)memory % TALUS_BLOB_ALIGNMENT);
    run_trigonometry();
    size_t bytes = run_hulls(region, sizeof memory - TALUS_BLOB_ALIGNMENT);
    run_all(golden_scenes, golden_scene_count, only, isa, region, bytes);
    run_all(golden_more_scenes, golden_more_scene_count, only, isa, region, bytes);
    for (unsigned i = 0; i < golden_scene_count; i++) {
        if (!only && strcmp(golden_scenes[i].name, "pile") == 0) { /* it has every type of shape */
            run_queries(&golden_scenes[i], isa, region, bytes);
        }
        if (!only && strcmp(golden_scenes[i].name, "churn") == 0) { /* things come and go */
            run_recording(&golden_scenes[i], isa, region, bytes);
        }
    }
    return 0;
}
