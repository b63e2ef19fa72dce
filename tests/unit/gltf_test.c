/* Scenes out of glTF: what sound files mean, and that broken ones are refused with their place and reason. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gltf/animate.h"
#include "gltf/document.h"
#include "gltf/scene.h"
#include "gltf_base.h"
#include "talus/scenes.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char *base_text;

static int make_base(void **state) {
    (void)state;
    base_text = gltf_base_text();
    return 0;
}

static int free_base(void **state) {
    (void)state;
    free(base_text);
    return 0;
}

static gltf_status load(const char *text, gltf_scene *scene, gltf_error *error) {
    return gltf_scene_load(scene, text, strlen(text), NULL, error);
}

static gltf_scene load_patched(const char *from, const char *to) {
    char *text = gltf_patched(base_text, from, to);
    gltf_scene scene;
    gltf_error error;
    if (load(text, &scene, &error) != GLTF_OK) {
        print_error("%s\n", error.text);
    }
    assert_int_equal(error.status, GLTF_OK);
    free(text);
    return scene;
}

static void assert_near(double a, double b) {
    if (!(fabs(a - b) <= 1e-6 * fmax(1, fabs(b)))) {
        print_error("%.9g is not %.9g\n", a, b);
    }
    assert_true(fabs(a - b) <= 1e-6 * fmax(1, fabs(b)));
}

static void assert_vector(talus_vec3 v, double x, double y, double z) {
    assert_near((double)v.x, x);
    assert_near((double)v.y, y);
    assert_near((double)v.z, z);
}

/* --- what sound files mean --- */

static void reads_all_parts(void **state) {
    (void)state;
    gltf_scene s;
    gltf_error error;
    assert_int_equal(load(base_text, &s, &error), GLTF_OK);
    assert_string_equal(s.name, "base");
    assert_vector(s.gravity, 0, -10, 0);
    assert_near((double)s.dt, 0.01);
    assert_int_equal(s.steps, 50);
    assert_int_equal(s.body_count, 2);
    assert_int_equal(s.collider_count, 4);
    assert_int_equal(s.joint_count, 1);
    const gltf_body *ball = &s.bodies[0];
    assert_string_equal(ball->name, "ball");
    assert_vector(ball->linear_velocity, 0, 1, 0); /* the node is turned by a right angle about z */
    assert_vector(ball->angular_velocity, -1, 0, 0);
    assert_true(ball->has_mass && ball->has_center && ball->has_inertia && !ball->kinematic);
    assert_near((double)ball->mass, 3);
    assert_near((double)ball->gravity_factor, 0.5);
    assert_vector(ball->center, 0, 0.1, 0);
    const gltf_collider *c = &s.colliders[1];
    assert_int_equal(c->body, 0);
    assert_near((double)c->material.static_friction, 0.7);
    assert_near((double)c->material.dynamic_friction, 0.4);
    assert_int_equal(c->material.friction_combine, TALUS_COMBINE_MINIMUM);
    assert_int_equal(c->material.restitution_combine, TALUS_COMBINE_MULTIPLY);
    assert_int_equal(s.colliders[0].body, GLTF_NONE);
    assert_near((double)s.colliders[0].material.dynamic_friction, 0.5);
    assert_true(s.colliders[3].sensor);
    const gltf_hull *rock = &s.hulls[0];
    assert_int_equal(rock->count, 8);
    assert_vector(rock->points[7], 0.5, 1, 1.5); /* scaled by 1 2 3 */
    gltf_scene_free(&s);
}

static void reads_joints(void **state) {
    (void)state;
    gltf_scene s;
    gltf_error error;
    assert_int_equal(load(base_text, &s, &error), GLTF_OK);
    const gltf_joint *j = &s.joints[0];
    assert_int_equal(j->body_a, 0);
    assert_int_equal(j->body_b, 1);
    assert_vector(j->def.frame_a.position, 0.5, 0, 0);
    assert_int_equal(j->def.collide_connected, 0);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(j->def.linear[i].mode, TALUS_AXIS_LOCKED);
    }
    assert_int_equal(j->def.cone_axis, 0);
    assert_near((double)j->def.cone_angle, 0.5);
    assert_true(j->def.angular_drive[0].enabled && j->def.angular_drive[0].acceleration);
    assert_near((double)j->def.angular_drive[0].max_force, 7);
    gltf_scene_free(&s);
}

/* A body whose node is joined to one of the world by a description of a joint. */
static gltf_scene joined_to_world(const char *motion, const char *nodes, const char *joint) {
    char text[1600];
    gltf_scene s;
    gltf_error error;
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
             "\"extensionsUsed\":[\"KHR_implicit_shapes\",\"" RIGID "\"],"
             "\"extensions\":{\"KHR_implicit_shapes\":{\"shapes\":[{\"type\":\"sphere\",\"sphere\":{\"radius\":1}}]},"
             "\"" RIGID "\":{\"physicsJoints\":[{%s}]}},"
             "\"nodes\":[{%s,\"extensions\":{\"" RIGID
             "\":{\"motion\":{%s},\"collider\":{\"geometry\":{\"shape\":0}}}}},"
             "{%s,\"extensions\":{\"" RIGID "\":{\"joint\":{\"connectedNode\":0,\"joint\":0}}}}]}",
             joint, nodes, motion, nodes);
    gltf_status status = load(text, &s, &error);
    if (status != GLTF_OK) {
        print_error("%s\n", error.text);
    }
    assert_int_equal(status, GLTF_OK);
    assert_int_equal(s.body_count, 1);
    return s;
}

/* What leaves a body the motion in a plane across an axis of the world is a lock, and nothing else is. */
static void locks_to_planes(void **state) {
    (void)state;
    const char *z = "\"limits\":[{\"linearAxes\":[2],\"min\":0,\"max\":0},{\"angularAxes\":[0,1],\"min\":0,\"max\":0}]";
    const char *x = "\"limits\":[{\"linearAxes\":[0],\"min\":0,\"max\":0},{\"angularAxes\":[1,2],\"min\":0,\"max\":0}]";
    const char *straight = "\"translation\":[1,2,3]", *to_z = "\"rotation\":[0,-0.70710678,0,0.70710678]",
               *askew = "\"rotation\":[0,0.6,0,0.8]";
    const struct {
        const char *motion, *nodes, *joint;
        uint32_t locks;
    } cases[] = {
        {"", straight, z, TALUS_LOCK_PLANE_Z},
        {"", straight, x, TALUS_LOCK_PLANE_X},
        {"", to_z, x, TALUS_LOCK_PLANE_Z},
        {"", askew, x, 0},
        {"\"isKinematic\":true", straight, z, 0},
        {"", straight, "\"limits\":[{\"linearAxes\":[2],\"min\":0,\"max\":0}]", 0},
        {"", straight,
         "\"limits\":[{\"linearAxes\":[2],\"min\":0,\"max\":0},{\"angularAxes\":[0,2],\"min\":0,\"max\":0}]", 0},
        {"", straight,
         "\"limits\":[{\"linearAxes\":[2],\"min\":0.1,\"max\":0.1},{\"angularAxes\":[0,1],\"min\":0,\"max\":0}]", 0},
        {"", straight,
         "\"limits\":[{\"linearAxes\":[2],\"min\":0,\"max\":0},{\"angularAxes\":[0,1],\"min\":0,\"max\":0}],"
         "\"drives\":[{\"type\":\"angular\",\"mode\":\"force\",\"axis\":2,\"velocityTarget\":1,\"damping\":1}]",
         0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        gltf_scene s = joined_to_world(cases[i].motion, cases[i].nodes, cases[i].joint);
        assert_int_equal(s.bodies[0].locks, cases[i].locks);
        assert_int_equal(s.joint_count, cases[i].locks ? 0 : 1);
        gltf_scene_free(&s);
    }
}

static void reads_limits(void **state) {
    (void)state;
    const char *cone = "{\"angularAxes\":[1,2],\"max\":0.5}";
    gltf_scene s = load_patched(cone, "{\"angularAxes\":[1],\"min\":-1},{\"angularAxes\":[2],\"min\":0,\"max\":0.5,"
                                      "\"stiffness\":10,\"damping\":2}");
    const talus_joint_def *def = &s.joints[0].def;
    assert_int_equal(def->angular[0].mode, TALUS_AXIS_FREE);
    assert_int_equal(def->angular[1].mode, TALUS_AXIS_LIMITED);
    assert_near((double)def->angular[1].lower, -1);
    assert_true(def->angular[1].upper > 1e6f); /* no max is no bound */
    assert_near((double)def->angular[2].stiffness, 10);
    assert_near((double)def->angular[2].damping, 2);
    gltf_scene_free(&s);
    s = load_patched("{\"linearAxes\":[0,1,2],\"min\":0,\"max\":0}", "{\"linearAxes\":[0,1,2],\"min\":1,\"max\":2}");
    def = &s.joints[0].def;
    assert_true(def->distance_enabled);
    assert_near((double)def->distance_lower, 1);
    assert_near((double)def->distance_upper, 2);
    gltf_scene_free(&s);
    s = load_patched("{\"linearAxes\":[0,1,2],\"min\":0,\"max\":0}", "{\"linearAxes\":[1,2],\"max\":0,\"stiffness\":5},"
                                                                     "{\"linearAxes\":[0],\"min\":0.5,\"max\":0.5}");
    def = &s.joints[0].def;
    assert_int_equal(def->linear[0].mode, TALUS_AXIS_LOCKED);
    assert_near((double)def->linear[0].lower, 0.5);
    assert_int_equal(def->linear[1].mode, TALUS_AXIS_LIMITED);
    assert_near((double)def->linear[2].stiffness, 5);
    gltf_scene_free(&s);
}

static int collide(const talus_filter *a, const talus_filter *b) {
    return (a->mask & b->category) != 0 && (b->mask & a->category) != 0;
}

static void reads_filters(void **state) {
    (void)state;
    gltf_scene s = load_patched("{\"shape\":0}}", "{\"shape\":0},\"collisionFilter\":0}");
    assert_false(collide(&s.colliders[0].filter, &s.colliders[1].filter));
    assert_true(collide(&s.colliders[0].filter, &s.colliders[2].filter)); /* none */
    gltf_scene_free(&s);
    s = load_patched("\"notCollideWithSystems\":[\"ball\"]}", "\"collideWithSystems\":[\"wall\",\"ball\"]}");
    assert_true(collide(&s.colliders[1].filter, &s.colliders[1].filter));
    assert_false(collide(&s.colliders[1].filter, &s.colliders[2].filter)); /* is in no system */
    gltf_scene_free(&s);
}

static void reads_shapes(void **state) {
    (void)state;
    gltf_scene s = load_patched("\"translation\":[0,2,0]", "\"scale\":[2,-2,2]");
    assert_near((double)s.geometries[s.colliders[1].geometry].geometry.radius, 1);
    gltf_scene_free(&s);
    s = load_patched("\"geometry\":{\"shape\":1},\"physicsMaterial\"",
                     "\"geometry\":{\"shape\":2},\"physicsMaterial\"");
    const talus_geometry *g = &s.geometries[s.colliders[1].geometry].geometry;
    assert_int_equal(g->type, TALUS_CAPSULE);
    assert_near((double)g->radius_top, 0.25);
    assert_near((double)g->half_height, 0.5);
    gltf_scene_free(&s);
    s = load_patched("{\"type\":\"sphere\",\"sphere\":{\"radius\":0.5}}", "{\"type\":\"capsule\",\"capsule\":"
                                                                          "{\"height\":1,\"radiusTop\":2}}");
    assert_int_equal(s.geometries[s.colliders[1].geometry].geometry.type, TALUS_SPHERE); /* the larger ball holds all */
    assert_vector(s.colliders[1].pose.position, 0, 0.5, 0);
    gltf_scene_free(&s);
    s = load_patched("{\"type\":\"box\",\"box\":{\"size\":[20,1,20]}}", "{\"type\":\"plane\"}");
    g = &s.geometries[s.colliders[0].geometry].geometry;
    assert_int_equal(g->type, TALUS_BOX);
    assert_near((double)s.colliders[0].pose.position.y + (double)g->half.y, -0.5);
    assert_int_equal(s.note_count, 1);
    gltf_scene_free(&s);
    s = load_patched("\"name\":\"ground\",", "\"scale\":[0,0,0],");
    assert_int_equal(s.collider_count, 3); /* scaled to nothing, it is not there */
    gltf_scene_free(&s);
}

static void reads_nodes(void **state) {
    (void)state;
    /* y to z, doubled, at 1 2 3 */
    gltf_scene s = load_patched("\"translation\":[0,-0.5,0]", "\"matrix\":[2,0,0,0,0,0,2,0,0,-2,0,0,1,2,3,1]");
    assert_vector(s.colliders[0].pose.position, 1, 2, 3);
    assert_near((double)s.colliders[0].pose.rotation.x, sqrt(0.5));
    assert_near((double)s.geometries[s.colliders[0].geometry].geometry.half.y, 1);
    gltf_scene_free(&s);
    /* a ground below the ball belongs to it, and its scale is that of both */
    s = load_patched("\"nodes\":[0,1,2,4]", "\"nodes\":[1,2,4]");
    gltf_scene_free(&s);
    char *text = gltf_patched(base_text, "\"nodes\":[0,1,2,4]", "\"nodes\":[1,2,4]");
    char *child = gltf_patched(text, "\"children\":[3]", "\"children\":[3,0],\"scale\":[2,2,2]");
    gltf_error error;
    assert_int_equal(load(child, &s, &error), GLTF_OK);
    assert_int_equal(s.colliders[0].body, 0);
    assert_vector(s.colliders[0].pose.position, 0, -1, 0);
    assert_vector(s.joints[0].def.frame_a.position, 1, 0, 0);
    assert_vector(s.bodies[0].center, 0, 0.2, 0);
    assert_near((double)s.geometries[s.colliders[0].geometry].geometry.half.x, 20);
    gltf_scene_free(&s);
    free(child);
    free(text);
}

static void reads_sheared_hulls(void **state) {
    (void)state;
    /* a cube, turned by 45 degrees below a node that is scaled along x */
    char *text = gltf_patched(base_text, "\"nodes\":[0,1,2,4]", "\"nodes\":[0,1,4]");
    char *sheared = gltf_patched(text, "{\"scale\":[1,2,3],\"translation\":[4,2,0]",
                                 "{\"rotation\":[0,0,0.38268343236508977,0.9238795325112867]");
    char *above = gltf_patched(sheared, "\"translation\":[0,5,0],",
                               "\"children\":[2],\"scale\":[3,1,1],\"translation\":[0,5,0],");
    char *still = gltf_patched(above, "\"motion\":{},", "");
    gltf_scene s;
    gltf_error error;
    assert_int_equal(load(above, &s, &error), GLTF_UNSUPPORTED); /* a moving node has no such pose */
    char *alone = gltf_patched(still, "\"children\":[3],", "");  /* without the joint to it */
    char *ball = gltf_patched(alone, "\"trigger\":{\"geometry\":{\"shape\":1}}", "");
    assert_int_equal(load(ball, &s, &error), GLTF_OK);
    float most = 0;
    for (uint32_t i = 0; i < s.hulls[0].count; i++) {
        most = fmaxf(most, s.hulls[0].points[i].x);
    }
    assert_near((double)most, 3 * sqrt(0.5));
    gltf_scene_free(&s);
    free(ball);
    free(alone);
    free(still);
    free(above);
    free(sheared);
    free(text);
}

/* --- containers --- */

static void put_u32(unsigned char *out, size_t value) {
    for (int i = 0; i < 4; i++) {
        out[i] = (unsigned char)(value >> 8 * i);
    }
}

/* The base as a GLB with its corners in the binary chunk; freed by the caller. */
static unsigned char *make_glb(size_t *size) {
    const char *uri = strstr(base_text, ",\"uri\"");
    size_t length = (size_t)(uri - base_text), json = length + 3, padded = (json + 3) / 4 * 4;
    *size = 12 + 8 + padded + 8 + 96;
    unsigned char *out = malloc(*size);
    memcpy(out, "glTF", 4);
    put_u32(out + 4, 2);
    put_u32(out + 8, *size);
    put_u32(out + 12, padded);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', padded);
    memcpy(out + 20, base_text, length);
    memcpy(out + 20 + length, "}]}", 3);
    put_u32(out + 20 + padded, 96);
    memcpy(out + 24 + padded, "BIN\0", 4);
    gltf_base_cube(out + 28 + padded);
    return out;
}

static void reads_glb(void **state) {
    (void)state;
    size_t size;
    unsigned char *glb = make_glb(&size);
    gltf_scene s;
    gltf_error error;
    assert_int_equal(gltf_scene_load(&s, glb, size, NULL, &error), GLTF_OK);
    assert_int_equal(s.hulls[0].count, 8);
    gltf_scene_free(&s);
    static const struct {
        size_t at;
        uint32_t value;
        const char *message;
    } cases[] = {{4, 1, "version 1"},         {8, 0x7fffffff, "the file has"}, {8, 10, "no chunk"},
                 {12, 0x7ffffff0, "chunk 0"}, {12, 7, "multiple of 4"},        {16, 0x12345678, "not JSON"},
                 {12, 4, "chunk 1"}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        unsigned char kept[4];
        memcpy(kept, glb + cases[i].at, 4);
        put_u32(glb + cases[i].at, cases[i].value);
        assert_int_not_equal(gltf_scene_load(&s, glb, size, NULL, &error), GLTF_OK);
        if (strstr(error.text, cases[i].message) == NULL) {
            print_error("%s is not %s\n", error.text, cases[i].message);
        }
        assert_non_null(strstr(error.text, cases[i].message));
        memcpy(glb + cases[i].at, kept, 4);
    }
    for (size_t cut = 0; cut < size; cut += 3) {
        unsigned char *part = malloc(cut + 1);
        memcpy(part, glb, cut);
        assert_int_not_equal(gltf_scene_load(&s, part, cut, NULL, &error), GLTF_OK);
        free(part);
    }
    free(glb);
}

static void reads_base64(void **state) {
    (void)state;
    static const char *const bad[] = {"A", "AAAAA", "AA=A", "A===", "AA A", "AAA\x80", "===="};
    size_t size = 0;
    for (size_t i = 0; i < COUNT(bad); i++) {
        assert_null(gltf_base64_decode(bad[i], strlen(bad[i]), &size));
    }
    for (size_t n = 0; n < 40; n++) {
        unsigned char bytes[40];
        gltf_text text = {NULL, 0, 0, 0};
        for (size_t i = 0; i < n; i++) {
            bytes[i] = (unsigned char)(i * 37 + n * 11);
        }
        gltf_text_base64(&text, bytes, n);
        unsigned char *back = gltf_base64_decode(text.data != NULL ? text.data : "", text.size, &size);
        assert_non_null(back);
        assert_int_equal(size, n);
        assert_memory_equal(back, bytes, n);
        free(back);
        gltf_text_free(&text);
    }
}

/* --- worlds and animations --- */

static gltf_world build(const gltf_scene *scene) {
    gltf_world world;
    gltf_error error;
    gltf_build_options options = {.isa = TALUS_ISA_BEST};
    if (gltf_build(scene, &options, &world, &error) != GLTF_OK) {
        print_error("%s\n", error.text);
    }
    assert_int_equal(error.status, GLTF_OK);
    return world;
}

static void builds_worlds(void **state) {
    (void)state;
    gltf_scene s;
    gltf_error error;
    assert_int_equal(load(base_text, &s, &error), GLTF_OK);
    gltf_world w = build(&s);
    talus_mass mass;
    assert_int_equal(talus_body_get_mass(&w.world, w.bodies[0], &mass), TALUS_OK);
    assert_near((double)mass.mass, 3);
    assert_vector(mass.center, 0, 0.1, 0);
    assert_near((double)mass.inertia.z.z, 3);
    assert_int_equal(talus_body_get_mass(&w.world, w.bodies[1], &mass), TALUS_OK);
    assert_true(fabs((double)mass.mass - 6000) < 0.01); /* 1 2 3 m of 1000 kg/m^3 */
    talus_vec3 linear, angular;
    talus_body_get_velocity(&w.world, w.bodies[0], &linear, &angular);
    assert_vector(linear, 0, 1, 0);
    for (int i = 0; i < 10; i++) {
        assert_int_equal(talus_world_step(&w.world, s.dt, NULL, NULL), TALUS_OK);
    }
    gltf_world_free(&w);
    gltf_scene_free(&s);
    s = load_patched("\"inertiaDiagonal\":[1,2,3]", "\"inertiaDiagonal\":[0,0,0]");
    w = build(&s);
    assert_int_equal(talus_body_get_mass(&w.world, w.bodies[0], &mass), TALUS_OK);
    assert_vector(mass.inertia.x, 0, 0, 0);
    gltf_world_free(&w);
    gltf_scene_free(&s);
}

static void refuses_flat_hulls(void **state) {
    (void)state;
    gltf_scene s = load_patched("\"count\":8", "\"count\":4"); /* the corners of one face */
    gltf_world w;
    gltf_error error;
    gltf_build_options options = {.isa = TALUS_ISA_BEST};
    assert_int_equal(gltf_build(&s, &options, &w, &error), GLTF_BROKEN);
    assert_non_null(strstr(error.text, "$.nodes[2].extensions." RIGID ".collider.geometry: a hull of 4 points"));
    gltf_world_free(&w);
    gltf_scene_free(&s);
}

static int item(const cJSON *object, const char *key) {
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_true(cJSON_IsNumber(value));
    return (int)value->valuedouble;
}

static int list_size(const cJSON *object, const char *key) {
    return cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(object, key));
}

/* Every accessor lies in its view, every view in the binary chunk, and every index names something. */
static void check_glb(const gltf_text *glb, int bodies) {
    const unsigned char *bytes = (const unsigned char *)glb->data;
    size_t json_size = bytes[12] | (size_t)bytes[13] << 8 | (size_t)bytes[14] << 16 | (size_t)bytes[15] << 24;
    size_t bin_size = glb->size - 28 - json_size;
    cJSON *json = cJSON_ParseWithLength(glb->data + 20, json_size);
    assert_non_null(json);
    const cJSON *accessors = cJSON_GetObjectItemCaseSensitive(json, "accessors"), *one;
    const cJSON *views = cJSON_GetObjectItemCaseSensitive(json, "bufferViews");
    cJSON_ArrayForEach(one, views) {
        assert_true((size_t)(item(one, "byteOffset") + item(one, "byteLength")) <= bin_size);
        assert_int_equal(item(one, "byteOffset") % 4, 0);
    }
    cJSON_ArrayForEach(one, accessors) {
        const cJSON *view = cJSON_GetArrayItem(views, item(one, "bufferView"));
        const char *type = cJSON_GetObjectItemCaseSensitive(one, "type")->valuestring;
        int width = strcmp(type, "SCALAR") == 0 ? 1 : type[3] - '0';
        assert_non_null(view);
        assert_int_equal(item(view, "byteLength"), 4 * width * item(one, "count"));
    }
    cJSON_ArrayForEach(one, cJSON_GetObjectItemCaseSensitive(json, "nodes")) {
        const cJSON *mesh = cJSON_GetObjectItemCaseSensitive(one, "mesh");
        assert_true(mesh == NULL || mesh->valuedouble < list_size(json, "meshes"));
    }
    const cJSON *animation = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, "animations"), 0);
    assert_int_equal(list_size(animation, "channels"), 2 * bodies);
    const cJSON *samplers = cJSON_GetObjectItemCaseSensitive(animation, "samplers");
    cJSON_ArrayForEach(one, samplers) {
        const cJSON *input = cJSON_GetArrayItem(accessors, item(one, "input"));
        assert_int_equal(item(input, "count"), item(cJSON_GetArrayItem(accessors, item(one, "output")), "count"));
        assert_int_equal(list_size(input, "min"), 1);
    }
    cJSON_Delete(json);
}

static void writes_animations(void **state) {
    (void)state;
    gltf_scene s, back;
    gltf_error error;
    assert_int_equal(load(base_text, &s, &error), GLTF_OK);
    gltf_world w = build(&s);
    gltf_animation animation;
    gltf_animation_open(&animation, &s);
    talus_pose poses[2];
    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < 2; i++) {
            talus_body_get_pose(&w.world, w.bodies[i], &poses[i]);
        }
        gltf_animation_frame(&animation, 0.01 * k, poses);
        talus_world_step(&w.world, s.dt, NULL, NULL);
    }
    gltf_text glb = {NULL, 0, 0, 0};
    assert_int_equal(gltf_animation_encode(&animation, &w, &glb, &error), GLTF_OK);
    check_glb(&glb, 2);
    assert_int_equal(gltf_scene_load(&back, glb.data, glb.size, NULL, &error), GLTF_OK);
    assert_int_equal(back.body_count, 0);
    gltf_scene_free(&back);
    gltf_text_free(&glb);
    gltf_animation_free(&animation);
    gltf_world_free(&w);
    gltf_scene_free(&s);
}

static void makes_own_scenes(void **state) {
    (void)state;
    size_t count, size;
    int known;
    const scene_info *infos = scenes_list(&count);
    for (size_t i = 0; i < count; i++) {
        char *text = scenes_make(infos[i].name, &size, &known);
        assert_non_null(text);
        gltf_scene s;
        gltf_error error;
        if (gltf_scene_load(&s, text, size, NULL, &error) != GLTF_OK) {
            print_error("%s: %s\n", infos[i].name, error.text);
        }
        assert_int_equal(error.status, GLTF_OK);
        assert_true(s.body_count > 0);
        assert_int_equal(s.note_count, 0);
        gltf_world w = build(&s);
        gltf_world_free(&w);
        gltf_scene_free(&s);
        free(text);
    }
    assert_null(scenes_make("none", &size, &known));
    assert_int_equal(known, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_all_parts),   cmocka_unit_test(reads_joints),
        cmocka_unit_test(locks_to_planes),   cmocka_unit_test(reads_limits),
        cmocka_unit_test(reads_filters),     cmocka_unit_test(reads_shapes),
        cmocka_unit_test(reads_nodes),       cmocka_unit_test(reads_sheared_hulls),
        cmocka_unit_test(reads_glb),         cmocka_unit_test(reads_base64),
        cmocka_unit_test(builds_worlds),     cmocka_unit_test(refuses_flat_hulls),
        cmocka_unit_test(writes_animations), cmocka_unit_test(makes_own_scenes),
    };
    return cmocka_run_group_tests(tests, make_base, free_base);
}
