#include "scene_parts.h"

#include <stdio.h>

/* --- numbers --- */

static uint32_t next_word(parts_random *random) {
    uint64_t old = random->state;
    random->state = old * 6364136223846793005u + 1442695040888963407u;
    uint32_t mixed = (uint32_t)(((old >> 18) ^ old) >> 27), turn = (uint32_t)(old >> 59);
    return mixed >> turn | mixed << ((32 - turn) & 31);
}

double parts_uniform(parts_random *random, double low, double high) {
    return low + (high - low) * (next_word(random) / 4294967296.0);
}

gltf_double4 parts_rotation(parts_random *random) {
    double u = parts_uniform(random, 0, 1), v = parts_uniform(random, 0, 2 * PARTS_PI);
    double w = parts_uniform(random, 0, 2 * PARTS_PI), a = sqrt(1 - u), b = sqrt(u);
    gltf_double4 q = {a * sin(v), a * cos(v), b * sin(w), b * cos(w)};
    return q;
}

author_pose parts_pose(gltf_double3 p, gltf_double4 rotation) { return author_turned(p.x, p.y, p.z, rotation); }

gltf_double3 parts_layer(uint32_t i, uint32_t columns, uint32_t rows, double spacing, double bottom) {
    uint32_t layer = i / (columns * rows), row = i / columns % rows, column = i % columns;
    return gltf_d3((column - (columns - 1) / 2.0) * spacing, bottom + layer * spacing,
                   (row - (rows - 1) / 2.0) * spacing);
}

gltf_double4 parts_turn_x_to(gltf_double3 direction) {
    gltf_double3 d = gltf_scale3(direction, 1 / gltf_length3(direction));
    gltf_double4 q = {0, -d.z, d.y, 1 + d.x}; /* x cross d, 1 + x dot d */
    double length = sqrt(q.y * q.y + q.z * q.z + q.w * q.w);
    if (length < 1e-6) {
        return author_rotation(0, 0, 1, PARTS_PI);
    }
    gltf_double4 r = {0, q.y / length, q.z / length, q.w / length};
    return r;
}

/* --- what does not move --- */

void parts_ground(author *a, double half, int material) {
    author_static(a, author_box(a, 2 * half, 1, 2 * half), author_at(0, -0.5, 0), material);
}

void parts_walls(author *a, double x, double z, double half_x, double half_z, double height, int material) {
    const double thick = 0.4;
    author_part along_z = author_box(a, thick, height, 2 * (half_z + thick)),
                along_x = author_box(a, 2 * half_x, height, thick);
    for (int side = -1; side <= 1; side += 2) {
        author_static(a, along_z, author_at(x + side * (half_x + thick / 2), height / 2, z), material);
        author_static(a, along_x, author_at(x, height / 2, z + side * (half_z + thick / 2)), material);
    }
}

/* --- bodies --- */

author_part parts_rock(author *a, parts_random *random, double x, double y, double z) {
    gltf_double3 points[24];
    uint32_t count = 8 + next_word(random) % 17;
    for (uint32_t i = 0; i < count; i++) { /* a spiral from pole to pole, shaken */
        double height = 1 - 2 * (i + 0.5) / count, ring = sqrt(1 - height * height);
        double angle = 10.166407 * (i + 0.5) + parts_uniform(random, -0.3, 0.3);
        points[i] = gltf_d3(x * ring * cos(angle), y * height, z * ring * sin(angle));
    }
    return author_hull(a, points, count);
}

void parts_pyramid(author *a, gltf_double3 middle, gltf_double3 along, uint32_t base, double size, int material) {
    author_part box = author_box(a, size, size, size);
    gltf_double4 turn = parts_turn_x_to(along);
    gltf_double3 step = gltf_scale3(along, 1.1 * size / gltf_length3(along));
    for (uint32_t row = 0; row < base; row++) {
        for (uint32_t i = 0; i < base - row; i++) {
            gltf_double3 p = gltf_add3(middle, gltf_scale3(step, i - (base - row - 1) / 2.0));
            p.y += size * (row + 0.5);
            author_add_body(a, box, parts_pose(p, turn), material, NULL);
        }
    }
}

void parts_tower(author *a, gltf_double3 middle, uint32_t courses, double length, int material) {
    const double width = length / 3, height = length / 5;
    author_part plank = author_box(a, length, height, 0.98 * width);
    gltf_double4 across = author_rotation(0, 1, 0, PARTS_PI / 2), none = {0, 0, 0, 1};
    for (uint32_t course = 0; course < courses; course++) {
        for (int i = -1; i <= 1; i++) {
            gltf_double3 p = middle;
            p.y += height * (course + 0.5);
            p.x += course % 2 ? i * width : 0;
            p.z += course % 2 ? 0 : i * width;
            author_add_body(a, plank, parts_pose(p, course % 2 ? across : none), material, NULL);
        }
    }
}

void parts_chain(author *a, gltf_double3 top, gltf_double3 step, uint32_t links, double ball, double ball_mass,
                 int material) {
    double length = gltf_length3(step);
    author_part link = author_capsule(a, 0.7 * length, 0.15 * length, 0.15 * length);
    gltf_double4 turn = gltf_mul4(parts_turn_x_to(step), author_rotation(0, 0, 1, -PARTS_PI / 2));
    int last = AUTHOR_WORLD;
    gltf_double3 pivot = top;
    for (uint32_t i = 0; i < links; i++) {
        gltf_double3 middle = gltf_add3(pivot, gltf_scale3(step, 0.5));
        int body = author_add_body(a, link, parts_pose(middle, turn), material, NULL);
        author_joint(a, last, body, parts_pose(pivot, turn), PARTS_LIMITS(PARTS_PINNED));
        pivot = gltf_add3(pivot, step);
        last = body;
    }
    char motion[64];
    snprintf(motion, sizeof motion, "\"mass\":%.1f", ball_mass);
    gltf_double3 center = gltf_add3(pivot, gltf_scale3(step, ball / length));
    int body = author_add_body(a, author_sphere(a, ball), parts_pose(center, turn), material, motion);
    author_joint(a, last, body, parts_pose(pivot, turn), PARTS_LIMITS(PARTS_PINNED));
}

void parts_bridge(author *a, gltf_double3 from, gltf_double3 to, uint32_t planks, double width, int material) {
    gltf_double3 step = gltf_scale3(gltf_sub3(to, from), 1.0 / planks);
    double length = gltf_length3(step);
    author_part plank = author_box(a, 0.94 * length, 0.1, width);
    gltf_double4 turn = parts_turn_x_to(step), hinge = gltf_mul4(turn, author_rotation(0, 1, 0, -PARTS_PI / 2));
    int last = AUTHOR_WORLD;
    for (uint32_t i = 0; i <= planks; i++) {
        gltf_double3 pivot = gltf_add3(from, gltf_scale3(step, i));
        int body = i == planks ? AUTHOR_WORLD
                               : author_add_body(a, plank, parts_pose(gltf_add3(pivot, gltf_scale3(step, 0.5)), turn),
                                                 material, NULL);
        author_joint(a, last, body, parts_pose(pivot, hinge), PARTS_LIMITS(PARTS_HINGED));
        last = body;
    }
}

/* --- ragdolls --- */

typedef struct bone {
    double radius, length; /* of the capsule's axis, m */
    double x, y;           /* of its middle as the figure stands, arms stretched out along x */
    int lies;              /* along x, else along y */
} bone;

enum {
    PELVIS,
    TORSO,
    HEAD,
    UPPER_ARM,
    LOWER_ARM = UPPER_ARM + 2,
    THIGH = LOWER_ARM + 2,
    SHIN = THIGH + 2,
    BONES = SHIN + 2
};

static const bone bones[BONES] = {
    {0.12, 0.14, 0, 0.96, 1},      {0.15, 0.24, 0, 1.28, 0},     {0.11, 0.06, 0, 1.75, 0},
    {0.055, 0.20, -0.36, 1.43, 1}, {0.055, 0.20, 0.36, 1.43, 1}, {0.045, 0.22, -0.66, 1.43, 1},
    {0.045, 0.22, 0.66, 1.43, 1},  {0.08, 0.26, -0.12, 0.71, 0}, {0.08, 0.26, 0.12, 0.71, 0},
    {0.06, 0.28, -0.12, 0.28, 0},  {0.06, 0.28, 0.12, 0.28, 0}};

/* A joint between two bones: where it lies, along what x, and how far it goes (rad). */
typedef struct sinew {
    int from, to;
    double x, y;             /* m */
    double ax, ay;           /* the frame's x axis, as the figure stands */
    double swing, low, high; /* swing < 0: a hinge; else a cone and a twist */
} sinew;

static const sinew sinews[] = {{PELVIS, TORSO, 0, 1.06, 0, 1, 0.4, -0.4, 0.4},
                               {TORSO, HEAD, 0, 1.59, 0, 1, 0.6, -0.8, 0.8},
                               {TORSO, UPPER_ARM, -0.21, 1.43, -1, 0, 1.2, -0.7, 0.7},
                               {TORSO, UPPER_ARM + 1, 0.21, 1.43, 1, 0, 1.2, -0.7, 0.7},
                               {UPPER_ARM, LOWER_ARM, -0.51, 1.43, 0, 1, -1, -0.05, 2.3},
                               {UPPER_ARM + 1, LOWER_ARM + 1, 0.51, 1.43, 0, -1, -1, -0.05, 2.3},
                               {PELVIS, THIGH, -0.12, 0.91, 0, -1, 0.8, -0.3, 0.3},
                               {PELVIS, THIGH + 1, 0.12, 0.91, 0, -1, 0.8, -0.3, 0.3},
                               {THIGH, SHIN, -0.12, 0.51, 1, 0, -1, -0.05, 2.3},
                               {THIGH + 1, SHIN + 1, 0.12, 0.51, 1, 0, -1, -0.05, 2.3}};

void parts_ragdoll(author *a, gltf_double3 feet, gltf_double4 rotation, int material) {
    int body[BONES];
    gltf_double4 lying = gltf_mul4(rotation, author_rotation(0, 0, 1, -PARTS_PI / 2));
    for (int i = 0; i < BONES; i++) {
        const bone *b = &bones[i];
        gltf_double3 p = gltf_add3(feet, gltf_rotate(rotation, gltf_d3(b->x, b->y, 0)));
        body[i] = author_add_body(a, author_capsule(a, b->length, b->radius, b->radius),
                                  parts_pose(p, b->lies ? lying : rotation), material, NULL);
    }
    for (size_t i = 0; i < sizeof sinews / sizeof *sinews; i++) {
        const sinew *s = &sinews[i];
        char limits[320];
        gltf_double3 p = gltf_add3(feet, gltf_rotate(rotation, gltf_d3(s->x, s->y, 0)));
        gltf_double4 frame = gltf_mul4(rotation, parts_turn_x_to(gltf_d3(s->ax, s->ay, 0)));
        snprintf(limits, sizeof limits,
                 PARTS_LIMITS(PARTS_PINNED ",{\"angularAxes\":[1,2],\"min\":0,\"max\":%.3f},"
                                           "{\"angularAxes\":[0],\"min\":%.3f,\"max\":%.3f}"),
                 s->swing < 0 ? 0 : s->swing, s->low, s->high);
        author_joint(a, body[s->from], body[s->to], parts_pose(p, frame), limits);
    }
}
