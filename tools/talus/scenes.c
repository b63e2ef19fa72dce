#include "scenes.h"

#include "scene_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const gltf_double4 unturned = {0, 0, 0, 1};

static void make_pyramid(author *a) {
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 40, material);
    parts_pyramid(a, gltf_d3(0, 0, 0), gltf_d3(1, 0, 0), 20, 1, material);
}

static void make_stack(author *a) {
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 20, material);
    author_part box = author_box(a, 1, 1, 1);
    for (int i = 0; i < 20; i++) {
        author_add_body(a, box, author_at(0, i + 0.5, 0), material, NULL);
    }
}

static void make_masses(author *a) {
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 20, material);
    author_part box = author_box(a, 1, 1, 1);
    static const double tops[] = {1e3, 1e4, 1e5, 1e6};
    for (int column = 0; column < 4; column++) {
        for (int i = 0; i < 5; i++) {
            char motion[40];
            snprintf(motion, sizeof motion, "\"mass\":%.0f", i == 4 ? tops[column] : 1e3);
            author_add_body(a, box, author_at(3 * column - 4.5, i + 0.5, 0), material, motion);
        }
    }
}

static void make_chain(author *a) {
    int material = author_material(a, 0.5, 0, NULL);
    parts_ground(a, 30, material);
    parts_chain(a, gltf_d3(-4, 20, 0), gltf_d3(0.5, 0, 0), 24, 0.5, 800, material); /* released level */
    parts_chain(a, gltf_d3(4, 20, 6), gltf_d3(0, -0.5, 0), 24, 0.5, 800, material); /* hanging */
}

/* A card that leans over to the right, or left (side -1), to an apex; `angle` is that to the upright (rad). */
static void add_leaning(author *a, author_part card, gltf_double3 apex, double long_, double thick, double angle,
                        int side, int material) {
    double s = sin(angle), c = cos(angle);
    gltf_double3 p =
        gltf_d3(apex.x - side * (0.5 * thick * c + 0.5 * long_ * s), apex.y - 0.5 * (long_ * c + thick * s), apex.z);
    author_add_body(a, card, parts_pose(p, author_rotation(0, 0, 1, -side * angle)), material, NULL);
}

/* Storeys of pairs of cards that lean on each other, a board on all of them for the next. */
static void make_cards(author *a) {
    const double size = 1, thick = 0.03, angle = 20 * PARTS_PI / 180;
    const double height = size * cos(angle) + thick * sin(angle),
                 apart = 2.1 * (size * sin(angle) + thick * cos(angle));
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 20, material);
    author_part card = author_box(a, thick, size, 0.7);
    for (int storey = 0; storey < 4; storey++) {
        double top = (storey + 1) * height + storey * thick;
        for (int i = 0; i < 4 - storey; i++) {
            gltf_double3 apex = gltf_d3(apart * (i - (3 - storey) / 2.0), top, 0);
            add_leaning(a, card, apex, size, thick, angle, 1, material);
            add_leaning(a, card, apex, size, thick, angle, -1, material);
        }
        if (storey < 3) {
            author_add_body(a, author_box(a, (4 - storey) * apart, thick, 0.7), author_at(0, top + thick / 2, 0),
                            material, NULL);
        }
    }
}

/* Half a ring of wedges that holds itself up. */
static void make_arch(author *a) {
    enum { WEDGES = 15 };
    const double inner = 3, outer = 4, half = PARTS_PI / WEDGES / 2, middle = (inner + outer) / 2;
    int material = author_material(a, 0.7, 0, NULL);
    parts_ground(a, 20, material);
    gltf_double3 corners[8];
    for (int i = 0; i < 8; i++) { /* about the wedge's middle, the ring's axis to -y */
        double radius = (i & 1 ? outer : inner) / cos(half), angle = i & 2 ? half : -half;
        corners[i] = gltf_d3(radius * sin(angle), radius * cos(angle) - middle, i & 4 ? 0.5 : -0.5);
    }
    author_part wedge = author_hull(a, corners, 8);
    for (int i = 0; i < WEDGES; i++) {
        double angle = (i + 0.5) * 2 * half - PARTS_PI / 2;
        author_add_body(a, wedge,
                        author_turned(middle * sin(angle), middle * cos(angle), 0, author_rotation(0, 0, 1, -angle)),
                        material, NULL);
    }
}

/* A closed drum that turns as it is told to, half full. */
static void make_tumbler(author *a) {
    const double half = 2.5, deep = 1, thick = 0.4;
    parts_random random = {13};
    int material = author_material(a, 0.5, 0, NULL);
    parts_ground(a, 10, material);
    int drum = author_add_compound(a, author_at(0, 4.5, 0), "\"isKinematic\":true,\"angularVelocity\":[0,0,0.8]");
    author_part wall = author_box(a, 2 * half + 2 * thick, thick, 2 * deep),
                lid = author_box(a, 2 * half, 2 * half, thick);
    for (int side = 0; side < 4; side++) {
        double angle = side * PARTS_PI / 2, r = half + thick / 2;
        author_add_part(a, drum, wall,
                        author_turned(-r * sin(angle), r * cos(angle), 0, author_rotation(0, 0, 1, angle)), material);
    }
    author_add_part(a, drum, lid, author_at(0, 0, deep + thick / 2), material);
    author_add_part(a, drum, lid, author_at(0, 0, -deep - thick / 2), material);
    author_part box = author_box(a, 0.4, 0.3, 0.3);
    for (uint32_t i = 0; i < 216; i++) {
        author_add_body(a, i % 4 ? box : author_sphere(a, 0.18),
                        parts_pose(parts_layer(i, 9, 4, 0.49, 2.3), parts_rotation(&random)), material, NULL);
    }
}

static void make_bridge(author *a) {
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 40, material);
    author_part box = author_box(a, 0.8, 0.8, 0.8);
    author_part post = author_box(a, 2, 6, 4);
    author_static(a, post, author_at(-16.2, 3, 0), material);
    author_static(a, post, author_at(16.2, 3, 0), material);
    parts_bridge(a, gltf_d3(-15, 6, 0), gltf_d3(15, 6, 0), 48, 3, material);
    for (int i = 0; i < 8; i++) {
        author_add_body(a, box, author_at(2.4 * i - 8.4, 7 + 0.2 * i, i % 2 ? 0.5 : -0.5), material, "\"mass\":400");
    }
}

static void make_ragdolls(author *a) {
    parts_random random = {11};
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 30, material);
    for (int i = 0; i < 10; i++) {
        double height = 0.4 * (10 - i);
        author_static(a, author_box(a, 1, height, 12), author_at(i - 5, height / 2, 0), material);
    }
    for (uint32_t i = 0; i < 24; i++) {
        gltf_double3 p = parts_layer(i, 3, 4, 2.4, 6);
        gltf_double4 turn = parts_rotation(&random);
        parts_ragdoll(a, gltf_sub3(p, gltf_rotate(turn, gltf_d3(0, 1, 0))), turn, material);
    }
}

static void make_pile(author *a) {
    parts_random random = {7};
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 20, material);
    parts_walls(a, 0, 0, 2.5, 2.5, 6, material);
    for (uint32_t i = 0; i < 400; i++) {
        double size[3];
        for (int k = 0; k < 3; k++) {
            size[k] = parts_uniform(&random, 0.15, 0.4);
        }
        author_part rock = parts_rock(a, &random, size[0], size[1], size[2]);
        author_add_body(a, rock, parts_pose(parts_layer(i, 5, 5, 0.9, 0.8), parts_rotation(&random)), material, NULL);
    }
}

/* Each body is tied to the world by a joint that leaves it the plane. */
static void make_plane(author *a) {
    parts_random random = {17};
    int material = author_material(a, 0.5, 0, NULL);
    parts_ground(a, 20, material);
    author_part wall = author_box(a, 0.4, 30, 2);
    author_static(a, wall, author_at(-4.2, 15, 0), material);
    author_static(a, wall, author_at(4.2, 15, 0), material);
    for (uint32_t i = 0; i < 200; i++) {
        double x = parts_uniform(&random, 0.4, 0.9), y = parts_uniform(&random, 0.4, 0.9);
        author_part part = i % 3 ? author_box(a, x, y, 1) : author_sphere(a, x / 2);
        gltf_double3 at = parts_layer(i, 7, 1, 1.1, 1);
        at.x += parts_uniform(&random, -0.05, 0.05);
        gltf_double4 turn = author_rotation(0, 0, 1, parts_uniform(&random, 0, PARTS_PI));
        int body = author_add_body(a, part, parts_pose(at, turn), material, NULL);
        author_joint(
            a, AUTHOR_WORLD, body, parts_pose(at, unturned),
            PARTS_LIMITS("{\"linearAxes\":[2],\"min\":0,\"max\":0},{\"angularAxes\":[0,1],\"min\":0,\"max\":0}"));
    }
}

static void make_heap(author *a) {
    parts_random random = {11};
    int material = author_material(a, 0.5, 0.1, NULL);
    parts_ground(a, 20, material);
    parts_walls(a, 0, 0, 8, 8, 12, material);
    for (uint32_t i = 0; i < 1000; i++) {
        author_part part = i % 2 ? author_sphere(a, 0.4) : author_box(a, 0.8, 0.8, 0.8);
        gltf_double3 shift = gltf_d3(parts_uniform(&random, -0.2, 0.2), 0, parts_uniform(&random, -0.2, 0.2));
        author_pose at = parts_pose(gltf_add3(parts_layer(i, 10, 10, 1.4, 1), shift), parts_rotation(&random));
        author_add_body(a, part, at, material, NULL);
    }
}

static void make_tower(author *a) {
    int material = author_material(a, 0.6, 0, NULL);
    parts_ground(a, 60, material);
    parts_tower(a, gltf_d3(0, 0, 0), 18, 1.5, material);
    author_add_body(a, author_sphere(a, 0.25), author_at(-12, 3, 0.1), material,
                    "\"mass\":2000,\"linearVelocity\":[20,3,0]");
}

/* Stones along a spiral from the inside out; the first one starts to fall. */
static void add_dominoes(author *a, gltf_double3 middle, uint32_t count, double inner, double pitch, int material) {
    const double thick = 0.08, tall = 0.6, wide = 0.3, gap = 0.22;
    author_part stone = author_box(a, thick, tall, wide);
    double angle = 0;
    for (uint32_t i = 0; i < count; i++) {
        double radius = inner + pitch * angle / (2 * PARTS_PI), grow = pitch / (2 * PARTS_PI);
        double c = cos(angle), s = sin(angle);
        gltf_double3 p = gltf_add3(middle, gltf_d3(radius * c, tall / 2, radius * s));
        gltf_double4 turn = parts_turn_x_to(gltf_d3(grow * c - radius * s, 0, grow * s + radius * c));
        author_add_body(a, stone, parts_pose(p, turn), material,
                        i == 0 ? "\"angularVelocity\":[0,0,-3],\"linearVelocity\":[0.9,0.1,0]" : NULL);
        angle += gap / sqrt(radius * radius + grow * grow);
    }
}

static void make_dominoes(author *a) {
    int material = author_material(a, 0.5, 0, NULL);
    parts_ground(a, 20, material);
    add_dominoes(a, gltf_d3(0, 0, 0), 200, 1.2, 0.9, material);
}

static author_part mixed_part(author *a, parts_random *random, uint32_t i) {
    double r = parts_uniform(random, 0.15, 0.35), h = parts_uniform(random, 0.3, 0.8);
    switch (i % 8) {
    case 0:
        return author_box(a, 2 * r, h, 1.5 * r);
    case 1:
        return author_sphere(a, r);
    case 2:
        return author_capsule(a, h, r, r);
    case 3:
        return author_capsule(a, h + r, 0.5 * r, r); /* tapered */
    case 4:
        return author_cylinder(a, h, r, r);
    case 5:
        return author_cylinder(a, h, 0, r); /* a cone */
    case 6:
        return author_cylinder(a, h, 0.5 * r, r);
    default:
        return parts_rock(a, random, r, 0.5 * h, r);
    }
}

static void make_shapes(author *a) {
    parts_random random = {3};
    int material = author_material(a, 0.5, 0.1, NULL);
    parts_ground(a, 20, material);
    parts_walls(a, 0, 0, 3, 3, 2, material);
    for (uint32_t i = 0; i < 240; i++) {
        author_part part = mixed_part(a, &random, i);
        author_add_body(a, part, parts_pose(parts_layer(i, 5, 5, 1.1, 1), parts_rotation(&random)), material, NULL);
    }
}

/* A wheel with four paddles, turned by a motor. */
static void add_wheel(author *a, gltf_double3 axle, double radius, double speed, int material) {
    author_part paddle = author_box(a, 2 * radius, 0.15, 1.6);
    int wheel = author_add_compound(a, parts_pose(axle, unturned), "\"mass\":400");
    author_add_part(a, wheel, paddle, author_at(0, 0, 0), material);
    author_add_part(a, wheel, paddle, author_turned(0, 0, 0, author_rotation(0, 0, 1, PARTS_PI / 2)), material);
    char limits[320];
    snprintf(limits, sizeof limits,
             PARTS_LIMITS(PARTS_HINGED) ",\"drives\":[{\"type\":\"angular\",\"mode\":\"force\",\"axis\":0,"
                                        "\"maxForce\":8000,\"velocityTarget\":%.3f,\"damping\":20000}]",
             speed);
    gltf_double4 hinge = author_rotation(0, 1, 0, -PARTS_PI / 2); /* x of the frame lies along z */
    author_joint(a, AUTHOR_WORLD, wheel, parts_pose(axle, hinge), limits);
}

static void make_wheel(author *a) {
    parts_random random = {5};
    int material = author_material(a, 0.3, 0, NULL);
    parts_ground(a, 20, material);
    parts_walls(a, 0, 0, 2.8, 1, 6, material);
    add_wheel(a, gltf_d3(0, 2.1, 0), 1.5, 3, material);
    for (uint32_t i = 0; i < 120; i++) {
        gltf_double3 p = parts_layer(i, 10, 3, 0.5, 4.2);
        p.x += parts_uniform(&random, -0.02, 0.02);
        author_add_body(a, author_sphere(a, 0.2), parts_pose(p, unturned), material, "\"mass\":8");
    }
}

/* A bit of everything, laid out in a square: what the library can do, in one run. */
static void make_showcase(author *a) {
    parts_random random = {1};
    int material = author_material(a, 0.6, 0, NULL), springy = author_material(a, 0.4, 0.8, "maximum");
    parts_ground(a, 100, material);
    parts_pyramid(a, gltf_d3(-10, 0, 4), gltf_d3(0, 0, 1), 10, 0.8, material);
    parts_chain(a, gltf_d3(-13, 10, 4), gltf_d3(-1, 0.2, 0), 7, 1, 3000, material); /* a ball swings into it */
    parts_tower(a, gltf_d3(2, 0, 9), 16, 1.5, material);
    author_add_body(a, author_sphere(a, 0.25), author_at(2.1, 3, 25), material,
                    "\"mass\":2000,\"linearVelocity\":[0,3,-20]");
    add_dominoes(a, gltf_d3(10, 0, 8), 130, 1, 0.9, material);
    parts_bridge(a, gltf_d3(-6, 4, -9), gltf_d3(6, 4, -9), 24, 2, material);
    for (int i = 0; i < 6; i++) {
        gltf_double4 turn = parts_rotation(&random);
        parts_ragdoll(a, gltf_d3(1.8 * i - 4.5, 6 + 0.8 * i, -9), turn, material);
    }
    parts_walls(a, 12, -8, 2.8, 1, 6, material);
    add_wheel(a, gltf_d3(12, 2.1, -8), 1.5, 3, material);
    for (uint32_t i = 0; i < 150; i++) {
        gltf_double3 p = gltf_add3(parts_layer(i, 5, 2, 0.95, 4.5), gltf_d3(12, 0, -8));
        author_add_body(a, mixed_part(a, &random, i), parts_pose(p, parts_rotation(&random)), material, NULL);
    }
    for (uint32_t i = 0; i < 40; i++) {
        gltf_double3 p = gltf_add3(parts_layer(i, 4, 5, 1, 5), gltf_d3(2, 0, 1));
        author_add_body(a, author_sphere(a, 0.3), parts_pose(p, parts_rotation(&random)), springy, "\"mass\":20");
    }
    author_trigger(a, author_box(a, 6, 1, 6), author_at(2, 2, 1)); /* counts the balls that fall through it */
}

typedef struct scene_maker {
    void (*make)(author *a);
    uint32_t steps; /* of 1/60 s */
} scene_maker;

#define SCENES 17

static const scene_info infos[SCENES] = {
    {"arch", "15 wedges that hold each other up; they should stay"},
    {"bridge", "48 hinged planks between two posts, loaded with boxes"},
    {"cards", "a house of 23 cards, four storeys; they should stay"},
    {"chain", "a chain with a ball 100 times as heavy as a link, released level, and a hanging one"},
    {"dominoes", "200 stones in a spiral; the first one falls"},
    {"heap", "1000 boxes and balls dropped into a bin"},
    {"masses", "columns of five boxes, the top one up to 1000 times as heavy"},
    {"pile", "400 rocks (convex hulls) dropped into a bin"},
    {"plane", "200 boxes and balls that joints to the world keep in a plane, dropped between two walls"},
    {"pyramid", "210 boxes as a wall that should stay as it is"},
    {"ragdolls", "24 figures of eleven capsules fall on stairs"},
    {"shapes", "boxes, balls, capsules, cones, cylinders, tapered ones and rocks, 240 together"},
    {"showcase", "a bit of everything: what the library can do, in one run"},
    {"stack", "20 boxes on top of each other; they should stay"},
    {"tower", "a tower of planks, hit by a ball"},
    {"tumbler", "216 boxes and balls in a drum that turns"},
    {"wheel", "a paddle wheel turned by a motor among 120 balls"},
};

static const scene_maker makers[SCENES] = {
    {make_arch, 600},     {make_bridge, 600}, {make_cards, 600},    {make_chain, 600}, {make_dominoes, 1000},
    {make_heap, 600},     {make_masses, 600}, {make_pile, 500},     {make_plane, 600}, {make_pyramid, 300},
    {make_ragdolls, 400}, {make_shapes, 400}, {make_showcase, 900}, {make_stack, 600}, {make_tower, 400},
    {make_tumbler, 600},  {make_wheel, 400},
};

const scene_info *scenes_list(size_t *count) {
    *count = SCENES;
    return infos;
}

char *scenes_make(const char *name, size_t *size, int *known) {
    *known = 0;
    for (size_t i = 0; i < SCENES; i++) {
        if (strcmp(name, infos[i].name) == 0) {
            author a;
            *known = 1;
            author_open(&a, name, makers[i].steps);
            gltf_text_add(&a.extras, ",\"note\":");
            gltf_text_quoted(&a.extras, infos[i].about);
            makers[i].make(&a);
            return author_finish(&a, size);
        }
    }
    return NULL;
}
