/* Broken scenes: each is refused with its place and the reason. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gltf/scene.h"
#include "gltf_base.h"

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

typedef struct broken {
    const char *from, *to; /* in the base */
    gltf_status status;
    const char *message; /* part of what is said */
} broken;

#define CONE "{\"angularAxes\":[1,2],\"max\":0.5}"

static const broken broken_files[] = {
    {"{\"asset\"", "[\"asset\"", GLTF_BROKEN, "$: no JSON at byte"},
    {"\"version\":\"2.0\"", "\"version\":\"1.0\"", GLTF_UNSUPPORTED, "$.asset.version: is \"1.0\""},
    {"\"version\":\"2.0\"", "\"other\":1", GLTF_BROKEN, "$.asset.version: is missing"},
    {"[\"KHR_implicit_shapes\"]", "[\"KHR_draco_mesh_compression\"]", GLTF_UNSUPPORTED, "$.extensionsRequired[0]"},
    {"[\"KHR_implicit_shapes\"]", "[7]", GLTF_BROKEN, "$.extensionsRequired[0]: must be a text"},
    {"\"scene\":0", "\"scene\":1", GLTF_BROKEN, "$.scene: is 1, but the file has 1 scenes"},
    {"\"scenes\":[", "\"others\":[", GLTF_BROKEN, "$.scenes: is missing"},
    {"\"nodes\":[0,1,2,4]", "\"nodes\":[0,1,2,9]", GLTF_BROKEN, "$.scenes[0].nodes[3]: is 9"},
    {"\"nodes\":[0,1,2,4]", "\"nodes\":[0,0,1,2,4]", GLTF_BROKEN, "stands here already"},
    {"\"nodes\":[0,1,2,4]", "\"nodes\":[0,1,2,3,4]", GLTF_BROKEN, "only roots may stand here"},
    {"\"nodes\":[0,1,2,4]", "\"nodes\":[0,1,2,4.5]", GLTF_BROKEN, "must be a whole number"},
    {"\"nodes\":[0,1,2,4]", "\"nodes\":{}", GLTF_BROKEN, "$.scenes[0].nodes: is an object, must be an array"},
    {"\"children\":[3]", "\"children\":[1]", GLTF_BROKEN, "$.nodes[1]: is below itself"},
    {"\"children\":[3]", "\"children\":[3,3]", GLTF_BROKEN, "$.nodes[1].children[1]: is node 3"},
    {"\"children\":[3]", "\"children\":[-1]", GLTF_BROKEN, "$.nodes[1].children[0]: is -1"},
    {"\"children\":[3]", "\"children\":[1e99]", GLTF_BROKEN, "$.nodes[1].children[0]"},
    {"\"children\":[3]", "\"children\":3", GLTF_BROKEN, "must be an array"},
    {"\"translation\":[0,2,0]", "\"translation\":[0,2]", GLTF_BROKEN, "$.nodes[1].translation: has 2 elements"},
    {"\"translation\":[0,2,0]", "\"translation\":[0,1e999,0]", GLTF_BROKEN, "$.nodes[1].translation[1]"},
    {"\"translation\":[0,2,0]", "\"translation\":[0,1e8,0]", GLTF_BROKEN, "$.nodes[1]: stands 1e+08 m"},
    {"\"translation\":[0,2,0]", "\"translation\":[0,\"2\",0]", GLTF_BROKEN, "is \"2\", must be a number"},
    {"\"translation\":[0,2,0]", "\"translation\":[0,null,0]", GLTF_BROKEN, "is null, must be a number"},
    {"[0,0,0.7071067811865476,0.7071067811865476]", "[0,0,0,0]", GLTF_BROKEN, "$.nodes[1].rotation: has length 0"},
    {"[0,0,0.7071067811865476,0.7071067811865476]", "[0,0,0,2]", GLTF_BROKEN, "has length 2, must be a unit"},
    {"\"translation\":[0,-0.5,0]", "\"matrix\":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]", GLTF_BROKEN, "has shear"},
    {"\"translation\":[0,-0.5,0]", "\"matrix\":[1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1]", GLTF_BROKEN, "last row"},
    {"\"translation\":[0,-0.5,0]", "\"matrix\":[0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]", GLTF_BROKEN, "length 0"},
    {"\"translation\":[0,2,0]", "\"scale\":[1,2,1]", GLTF_UNSUPPORTED, "a sphere is scaled by 1 2 1"},
    {"\"name\":\"ground\"", "\"scale\":[1,0,1]", GLTF_BROKEN, "makes it flat"},
    {"\"name\":\"ground\"", "\"scale\":[1,1e-9,1]", GLTF_BROKEN, "half edge y is 5e-10 m"},
    {"\"size\":[20,1,20]", "\"size\":[20,-1,20]", GLTF_BROKEN, "shapes[0].box.size: element 1 is -1"},
    {"\"size\":[20,1,20]", "\"size\":[20,1,1e8]", GLTF_BROKEN, "half edge z"},
    {"\"size\":[20,1,20]", "\"size\":3", GLTF_BROKEN, "must be an array"},
    {"\"radius\":0.5", "\"radius\":0", GLTF_BROKEN, "shapes[1].sphere.radius: is 0"},
    {"\"type\":\"sphere\"", "\"type\":\"torus\"", GLTF_UNSUPPORTED, "is \"torus\""},
    {"\"type\":\"sphere\",", "", GLTF_BROKEN, "shapes[1].type: is missing"},
    {"{\"shape\":0}", "{\"shape\":4}", GLTF_BROKEN, "geometry.shape: is 4, but the file has 4 shapes"},
    {"{\"shape\":0}", "{}", GLTF_BROKEN, "has none of \"shape\""},
    {"{\"shape\":0}", "{\"shape\":0,\"node\":1}", GLTF_BROKEN, "has more than one"},
    {"{\"geometry\":{\"shape\":0}}", "{\"shape\":0}", GLTF_BROKEN, "collider.geometry: is missing"},
    {"\"convexHull\":true", "\"convexHull\":false", GLTF_UNSUPPORTED, "a triangle mesh that moves"},
    {"\"convexHull\":true", "\"convexHull\":1", GLTF_BROKEN, "convexHull: is 1, must be true or false"},
    {"\"mesh\":0,", "", GLTF_BROKEN, "node 2 has no mesh"},
    {"\"mesh\":0,", "\"mesh\":0,\"skin\":0,", GLTF_UNSUPPORTED, "$.nodes[2].skin"},
    {"\"mesh\":0,", "\"mesh\":1,", GLTF_BROKEN, "$.nodes[2].mesh: is 1, but the file has 1 meshes"},
    {"\"POSITION\":0", "\"NORMAL\":0", GLTF_BROKEN, "$.meshes[0].primitives[0].attributes.POSITION: is missing"},
    {"\"POSITION\":0", "\"POSITION\":1", GLTF_BROKEN, "but the file has 1 accessors"},
    {"\"count\":8", "\"count\":9", GLTF_BROKEN, "$.accessors[0].count: is 9"},
    {"\"count\":8", "\"count\":1000000000", GLTF_BROKEN, "$.accessors[0].count"},
    {"\"count\":8", "\"count\":1e300", GLTF_BROKEN, "$.accessors[0].count"},
    {"\"count\":8", "\"count\":0", GLTF_BROKEN, "must be at least 1"},
    {"\"count\":8", "\"count\":8,\"byteOffset\":4", GLTF_BROKEN, "from byteOffset 4 on"},
    {"\"count\":8", "\"count\":8,\"byteOffset\":18446744073709551615", GLTF_BROKEN, "$.accessors[0].byteOffset"},
    {"\"count\":8", "\"count\":8,\"sparse\":{}", GLTF_UNSUPPORTED, "$.accessors[0].sparse"},
    {"\"bufferView\":0,", "", GLTF_UNSUPPORTED, "$.accessors[0].bufferView: is missing"},
    {"\"bufferView\":0,", "\"bufferView\":3,", GLTF_BROKEN, "$.accessors[0].bufferView: is 3"},
    {"\"type\":\"VEC3\"", "\"type\":\"VEC2\"", GLTF_BROKEN, "is VEC2"},
    {"\"componentType\":5126", "\"componentType\":5125", GLTF_BROKEN, "$.accessors[0].componentType: is 5125"},
    {"\"byteOffset\":0", "\"byteOffset\":4", GLTF_BROKEN, "$.bufferViews[0].byteLength: is 96 from byteOffset 4"},
    {"\"byteOffset\":0", "\"byteStride\":4", GLTF_BROKEN, "byteStride is 4"},
    {"\"buffer\":0", "\"buffer\":-0.5", GLTF_BROKEN, "$.bufferViews[0].buffer"},
    {"\"byteLength\":96,\"uri\"", "\"byteLength\":97,\"uri\"", GLTF_BROKEN, "$.buffers[0].byteLength: is 97"},
    {"\"byteLength\":96,\"uri\"", "\"uri\"", GLTF_BROKEN, "$.buffers[0].byteLength: is missing"},
    {";base64,", ";base64,*", GLTF_BROKEN, "$.buffers[0].uri: is no base64"},
    {";base64,", ",", GLTF_UNSUPPORTED, "without \";base64,\""},
    {"data:application", "http://application", GLTF_UNSUPPORTED, "$.buffers[0].uri"},
    {"\"uri\":", "\"other\":", GLTF_BROKEN, "no binary chunk"},
    {"\"mass\":3", "\"mass\":-3", GLTF_BROKEN, "motion.mass: is -3"},
    {"\"mass\":3", "\"mass\":1e99", GLTF_BROKEN, "motion.mass: is 1e+99"},
    {"\"inertiaDiagonal\":[1,2,3]", "\"inertiaDiagonal\":[1,-2,3]", GLTF_BROKEN, "element 1 is -2"},
    {"\"linearVelocity\":[1,0,0]", "\"linearVelocity\":[1e9,0,0]", GLTF_BROKEN, "linearVelocity[0]"},
    {"\"gravityFactor\":0.5", "\"gravityFactor\":true", GLTF_BROKEN, "gravityFactor: is true, must be a number"},
    {"\"motion\":{}", "\"motion\":[]", GLTF_BROKEN, "motion: is an array, must be an object"},
    {"\"physicsMaterial\":0", "\"physicsMaterial\":1", GLTF_BROKEN, "has 1 physics materials"},
    {"\"restitution\":0.25", "\"restitution\":-1", GLTF_BROKEN, "physicsMaterials[0].restitution"},
    {"\"minimum\"", "\"least\"", GLTF_BROKEN, "is \"least\", must be \"average\", \"minimum\", \"maximum\" or"},
    {"\"collisionFilter\":0", "\"collisionFilter\":2", GLTF_BROKEN, "collisionFilter: is 2"},
    {"\"notCollideWithSystems\":[\"ball\"]", "\"notCollideWithSystems\":[1]", GLTF_BROKEN, "must be a text"},
    {"\"notCollideWithSystems\":[\"ball\"]", "\"notCollideWithSystems\":[],\"collideWithSystems\":[]", GLTF_BROKEN,
     "may have only one"},
    {"\"trigger\":{\"geometry\":{\"shape\":1}}", "\"trigger\":{\"nodes\":[0]}", GLTF_BROKEN, "with a trigger below"},
    {"\"trigger\":{\"geometry\":{\"shape\":1}}", "\"trigger\":{\"nodes\":[]}", GLTF_BROKEN, "at least one node"},
    {"\"connectedNode\":2", "\"connectedNode\":5", GLTF_BROKEN, "joint.connectedNode: is 5"},
    {"\"connectedNode\":2", "\"other\":2", GLTF_BROKEN, "joint.connectedNode: is missing"},
    {"\"joint\":0,", "\"joint\":1,", GLTF_BROKEN, "has 1 physics joints"},
    {"[1,2],\"max\":0.5", "[1,3],\"max\":0.5", GLTF_BROKEN, "limits[1].angularAxes[1]: is 3"},
    {"[1,2],\"max\":0.5", "[1,1],\"max\":0.5", GLTF_BROKEN, "each once"},
    {"[1,2],\"max\":0.5", "[],\"max\":0.5", GLTF_BROKEN, "has 0 axes"},
    {"[1,2],\"max\":0.5", "[1,2],\"min\":1,\"max\":0.5", GLTF_BROKEN, "min must not be greater"},
    {"[1,2],\"max\":0.5", "[1,2],\"min\":0.2,\"max\":0.5", GLTF_UNSUPPORTED, "a cone with a min"},
    {"[1,2],\"max\":0.5", "[1,2],\"max\":-0.5", GLTF_BROKEN, "no distance or angle can keep"},
    {"[1,2],\"max\":0.5", "[0,1,2],\"max\":0.5", GLTF_UNSUPPORTED, "the whole rotation"},
    {CONE, "{\"linearAxes\":[0,1],\"max\":1}", GLTF_UNSUPPORTED, "a distance from a line"},
    {CONE, "{\"max\":1}", GLTF_BROKEN, "has none of linearAxes"},
    {CONE, CONE ",{\"angularAxes\":[1],\"max\":1}", GLTF_UNSUPPORTED, "a cone about axis 0 and a limit"},
    {"\"type\":\"angular\",", "", GLTF_BROKEN, "drives[0].type: is missing"},
    {"\"mode\":\"acceleration\"", "\"mode\":\"speed\"", GLTF_BROKEN, "must be \"force\" or \"acceleration\""},
    {"\"axis\":0", "\"axis\":3", GLTF_BROKEN, "drives[0].axis"},
    {"\"damping\":3", "\"damping\":-3", GLTF_BROKEN, "drives[0].damping"},
    {"\"dt\":0.01", "\"dt\":0", GLTF_BROKEN, "$.scenes[0].extras.dt: is 0"},
    {"\"steps\":50", "\"steps\":-1", GLTF_BROKEN, "$.scenes[0].extras.steps: is -1"},
    {"\"gravity\":[0,-10,0]", "\"gravity\":[0,-10]", GLTF_BROKEN, "$.scenes[0].extras.gravity"},
};

static void refuses_broken_files(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT(broken_files); i++) {
        const broken *b = &broken_files[i];
        char *text = gltf_patched(base_text, b->from, b->to);
        gltf_scene s;
        gltf_error error;
        load(text, &s, &error);
        if (error.status != b->status || strstr(error.text, b->message) == NULL) {
            print_error("%s -> %s: status %d, \"%s\", expected %d, \"%s\"\n", b->from, b->to, (int)error.status,
                        error.text, (int)b->status, b->message);
        }
        assert_int_equal(error.status, b->status);
        assert_non_null(strstr(error.text, b->message));
        assert_int_equal(s.body_count, 0);
        gltf_scene_free(&s);
        free(text);
    }
}

static void refuses_deep_and_cut_files(void **state) {
    (void)state;
    gltf_scene s;
    gltf_error error;
    char *deep = malloc(200001);
    memset(deep, '[', 200000);
    deep[200000] = 0;
    assert_int_equal(load(deep, &s, &error), GLTF_BROKEN);
    free(deep);
    size_t size = strlen(base_text);
    for (size_t cut = 0; cut < size; cut++) {
        char *part = malloc(cut + 1); /* of this size: a read beyond it is seen */
        memcpy(part, base_text, cut);
        assert_int_not_equal(gltf_scene_load(&s, part, cut, NULL, &error), GLTF_OK);
        gltf_scene_free(&s);
        free(part);
    }
    uint32_t random = 1;
    char *text = malloc(size + 1);
    for (int i = 0; i < 20000; i++) { /* one to four bytes changed: whatever comes, it comes back */
        memcpy(text, base_text, size + 1);
        for (int k = 0; k <= i % 4; k++) {
            random = random * 1664525u + 1013904223u;
            text[(random >> 8) % size] = "0123456789[]{},:\"-.eE"[random >> 3 & 15u];
        }
        gltf_scene_load(&s, text, size, NULL, &error);
        gltf_scene_free(&s);
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_broken_files),
        cmocka_unit_test(refuses_deep_and_cut_files),
    };
    return cmocka_run_group_tests(tests, make_base, free_base);
}
