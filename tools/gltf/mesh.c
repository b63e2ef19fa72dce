#include "gltf/mesh.h"

#include "geom/hull.h"
#include "gltf/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEGMENTS 24 /* around an axis */
#define ARC 8       /* from a pole to the equator */
#define PI 3.14159265358979323846

static uint32_t add_vertex(gltf_mesh *mesh, talus_vec3 position, talus_vec3 normal) {
    gltf_error error;
    memset(&error, 0, sizeof error);
    if (mesh->failed ||
        !gltf_grow(&error, &mesh->positions, &mesh->vertex_room, mesh->vertex_count, sizeof *mesh->positions) ||
        !gltf_grow(&error, &mesh->normals, &mesh->normal_room, mesh->vertex_count, sizeof *mesh->normals)) {
        mesh->failed = 1;
        return 0;
    }
    mesh->positions[mesh->vertex_count] = position;
    mesh->normals[mesh->vertex_count] = normal;
    return mesh->vertex_count++;
}

static void add_triangle(gltf_mesh *mesh, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t corners[3] = {a, b, c};
    gltf_error error;
    memset(&error, 0, sizeof error);
    for (int i = 0; i < 3; i++) {
        if (mesh->failed ||
            !gltf_grow(&error, &mesh->indices, &mesh->index_room, mesh->index_count, sizeof *mesh->indices)) {
            mesh->failed = 1;
            return;
        }
        mesh->indices[mesh->index_count++] = corners[i];
    }
}

static talus_vec3 vector(double x, double y, double z) {
    talus_vec3 v = {(float)x, (float)y, (float)z};
    return v;
}

static void make_box(gltf_mesh *mesh, talus_vec3 half) {
    for (int axis = 0; axis < 3; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            uint32_t corner[4];
            for (int i = 0; i < 4; i++) { /* around the face, counter-clockwise from +axis */
                double u = i == 1 || i == 2 ? 1 : -1, v = i >= 2 ? 1 : -1;
                double sign[3];
                sign[axis] = side;
                sign[(axis + 1) % 3] = u;
                sign[(axis + 2) % 3] = v;
                talus_vec3 normal = vector(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
                talus_vec3 p = vector(sign[0] * (double)half.x, sign[1] * (double)half.y, sign[2] * (double)half.z);
                corner[i] = add_vertex(mesh, p, normal);
            }
            int a = side > 0 ? 1 : 3, b = side > 0 ? 3 : 1;
            add_triangle(mesh, corner[0], corner[a], corner[2]);
            add_triangle(mesh, corner[0], corner[2], corner[b]);
        }
    }
}

/* A point of an outline to be turned about y, from bottom to top: its radius, height, and normal. */
typedef struct outline_point {
    double r, y, nr, ny;
} outline_point;

static void revolve(gltf_mesh *mesh, const outline_point *outline, uint32_t count) {
    uint32_t first = mesh->vertex_count;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k <= SEGMENTS; k++) {
            double angle = 2 * PI * k / SEGMENTS, c = k == SEGMENTS ? 1 : cos(angle),
                   s = k == SEGMENTS ? 0 : sin(angle);
            const outline_point *p = &outline[i];
            add_vertex(mesh, vector(p->r * c, p->y, p->r * s), vector(p->nr * c, p->ny, p->nr * s));
        }
    }
    for (uint32_t i = 0; i + 1 < count; i++) {
        const outline_point *low = &outline[i], *high = low + 1;
        if (low->r == high->r && low->y == high->y) {
            continue; /* an edge: two normals at one place */
        }
        for (uint32_t k = 0; k < SEGMENTS; k++) {
            uint32_t a = first + i * (SEGMENTS + 1) + k, b = a + SEGMENTS + 1;
            if (high->r > 0) {
                add_triangle(mesh, a, b, b + 1);
            }
            if (low->r > 0) {
                add_triangle(mesh, a, b + 1, a + 1);
            }
        }
    }
}

/* An arc of a ball at height `center`, from one elevation to another (rad). */
static uint32_t add_arc(outline_point *out, double radius, double center, double from, double to) {
    for (uint32_t i = 0; i <= ARC; i++) {
        double angle = from + (to - from) * i / ARC;
        int pole = fabs(fabs(angle) - PI / 2) < 1e-9;
        outline_point p = {pole ? 0 : radius * cos(angle), center + radius * sin(angle), pole ? 0 : cos(angle),
                           sin(angle)};
        out[i] = p;
    }
    return ARC + 1;
}

static void make_balls(gltf_mesh *mesh, double half_height, double top, double bottom) {
    outline_point outline[2 * (ARC + 1)];
    double sine = half_height > 0 ? fmax(-1, fmin(1, (bottom - top) / (2 * half_height))) : 0, lean = asin(sine);
    uint32_t count = add_arc(outline, bottom, -half_height, -PI / 2, lean);
    count += add_arc(outline + count, top, half_height, lean, PI / 2);
    revolve(mesh, outline, count);
}

static void make_cylinder(gltf_mesh *mesh, double half_height, double top, double bottom) {
    double slant = hypot(2 * half_height, bottom - top);
    double nr = 2 * half_height / slant, ny = (bottom - top) / slant;
    outline_point outline[6] = {{0, -half_height, 0, -1},       {bottom, -half_height, 0, -1},
                                {bottom, -half_height, nr, ny}, {top, half_height, nr, ny},
                                {top, half_height, 0, 1},       {0, half_height, 0, 1}};
    revolve(mesh, outline, 6);
}

static void make_hull(gltf_mesh *mesh, const talus_hull *hull) {
    const tl_half_edge *edges = tl_hull_edges(hull);
    for (uint32_t face = 0; face < hull->face_count; face++) {
        uint32_t start = tl_hull_face_edge(hull)[face], edge = start, count = 0, first = mesh->vertex_count;
        talus_vec3 normal = tl_hull_normal(hull, face);
        do {
            add_vertex(mesh, tl_hull_point(hull, edges[edge].origin), normal);
            edge = edges[edge].next;
            count++;
        } while (edge != start && count <= hull->half_edge_count);
        for (uint32_t i = 1; i + 1 < count; i++) {
            add_triangle(mesh, first, first + i, first + i + 1);
        }
    }
}

void gltf_mesh_make(gltf_mesh *mesh, const talus_geometry *geometry, const talus_hull *hull) {
    memset(mesh, 0, sizeof *mesh);
    double half = (double)geometry->half_height;
    double top = (double)geometry->radius_top, bottom = (double)geometry->radius_bottom;
    switch (geometry->type) {
    case TALUS_SPHERE:
        make_balls(mesh, 0, (double)geometry->radius, (double)geometry->radius);
        break;
    case TALUS_CAPSULE:
        make_balls(mesh, half, top, bottom);
        break;
    case TALUS_CYLINDER:
        make_cylinder(mesh, half, top, bottom);
        break;
    case TALUS_BOX:
        make_box(mesh, geometry->half);
        break;
    default:
        if (hull != NULL) {
            make_hull(mesh, hull);
        }
    }
}

void gltf_mesh_free(gltf_mesh *mesh) {
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->indices);
    memset(mesh, 0, sizeof *mesh);
}
