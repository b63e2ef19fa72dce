#include "gltf_base.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "gltf/text.h"

/* A ground, a ball with a pivot that is joined to a scaled rock, and a trigger. %s: the rock's corners as base64. */
static const char base_format[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_implicit_shapes\"],"
    "\"extensions\":{\"KHR_implicit_shapes\":{\"shapes\":["
    "{\"type\":\"box\",\"box\":{\"size\":[20,1,20]}},{\"type\":\"sphere\",\"sphere\":{\"radius\":0.5}},"
    "{\"type\":\"capsule\",\"capsule\":{\"height\":1,\"radiusTop\":0.25,\"radiusBottom\":0.5}},"
    "{\"type\":\"cylinder\",\"cylinder\":{\"height\":1,\"radiusTop\":0,\"radiusBottom\":0.5}}]},"
    "\"" RIGID "\":{\"physicsMaterials\":[{\"staticFriction\":0.7,\"dynamicFriction\":0.4,\"restitution\":0.25,"
    "\"frictionCombine\":\"minimum\",\"restitutionCombine\":\"multiply\"}],"
    "\"collisionFilters\":[{\"collisionSystems\":[\"ball\"],\"notCollideWithSystems\":[\"ball\"]}],"
    "\"physicsJoints\":[{\"limits\":[{\"linearAxes\":[0,1,2],\"min\":0,\"max\":0},"
    "{\"angularAxes\":[1,2],\"max\":0.5}],\"drives\":[{\"type\":\"angular\",\"mode\":\"acceleration\",\"axis\":0,"
    "\"maxForce\":7,\"velocityTarget\":2,\"damping\":3}]}]}},"
    "\"scene\":0,\"scenes\":[{\"name\":\"base\",\"nodes\":[0,1,2,4],"
    "\"extras\":{\"gravity\":[0,-10,0],\"dt\":0.01,\"steps\":50}}],\"nodes\":["
    "{\"name\":\"ground\",\"translation\":[0,-0.5,0],"
    "\"extensions\":{\"" RIGID "\":{\"collider\":{\"geometry\":{\"shape\":0}}}}},"
    "{\"name\":\"ball\",\"translation\":[0,2,0],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],"
    "\"children\":[3],\"extensions\":{\"" RIGID "\":{\"motion\":{\"mass\":3,\"linearVelocity\":[1,0,0],"
    "\"angularVelocity\":[0,1,0],\"gravityFactor\":0.5,\"centerOfMass\":[0,0.1,0],\"inertiaDiagonal\":[1,2,3]},"
    "\"collider\":{\"geometry\":{\"shape\":1},\"physicsMaterial\":0,\"collisionFilter\":0}}}},"
    "{\"scale\":[1,2,3],\"translation\":[4,2,0],\"mesh\":0,"
    "\"extensions\":{\"" RIGID "\":{\"motion\":{},\"collider\":{\"geometry\":{\"node\":2,\"convexHull\":true}}}}},"
    "{\"translation\":[0.5,0,0],\"extensions\":{\"" RIGID "\":{\"joint\":{\"joint\":0,\"connectedNode\":2}}}},"
    "{\"translation\":[0,5,0],\"extensions\":{\"" RIGID "\":{\"trigger\":{\"geometry\":{\"shape\":1}}}}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":8}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":96}],"
    "\"buffers\":[{\"byteLength\":96,\"uri\":\"data:application/octet-stream;base64,%s\"}]}";

static void put_float(unsigned char *out, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++) {
        out[i] = (unsigned char)(bits >> 8 * i);
    }
}

void gltf_base_cube(unsigned char out[96]) {
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            put_float(out + 12 * i + 4 * k, i >> k & 1 ? 0.5f : -0.5f);
        }
    }
}

char *gltf_base_text(void) {
    unsigned char corners[96];
    gltf_text encoded = {NULL, 0, 0, 0}, text = {NULL, 0, 0, 0};
    gltf_base_cube(corners);
    gltf_text_base64(&encoded, corners, sizeof corners);
    gltf_text_add(&text, base_format, encoded.data);
    gltf_text_free(&encoded);
    return text.data;
}

char *gltf_patched(const char *text, const char *from, const char *to) {
    const char *at = strstr(text, from);
    if (at == NULL) {
        print_error("the base has no %s\n", from);
    }
    assert_non_null(at);
    gltf_text out = {NULL, 0, 0, 0};
    gltf_text_bytes(&out, text, (size_t)(at - text));
    gltf_text_bytes(&out, to, strlen(to));
    gltf_text_bytes(&out, at + strlen(from), strlen(at + strlen(from)));
    return out.data;
}
