/* Separating axes of two polyhedra, boxes or hulls. Metres, in the query's frame. */
#ifndef TL_SAT_H
#define TL_SAT_H

#include "collide/support.h"

/* Hulls of more faces or edges than these go by GJK and EPA. A hull of 64 vertices has at most 124 faces and 186 edges.
 */
#define TL_SAT_FACES 128u
#define TL_SAT_EDGES 192u

/* A polyhedron seen by its faces and edges, in its own frame. */
typedef struct tl_poly {
    const tl_core *core;
    const float *nx, *ny, *nz, *d; /* planes, padded to a multiple of 8 by repeating the last */
    uint32_t face_count, face_stride;
    const tl_half_edge *edges;
    uint32_t half_edge_count;
    const float *x, *y, *z; /* vertices */
    talus_vec3 center;      /* of the ball of radius `inner` inside */
    float inner;
    float store[7 * 8]; /* of a box: its corners and planes */
} tl_poly;

/* 0 if the core is no polyhedron or has too many faces. */
int tl_poly_init(const tl_core *core, tl_poly *poly);

typedef enum tl_axis_kind { TL_AXIS_NONE, TL_AXIS_FACE_A, TL_AXIS_FACE_B, TL_AXIS_EDGES } tl_axis_kind;

typedef struct tl_axis {
    tl_axis_kind kind;
    uint32_t a, b;     /* the face, or the edges (half-edge / 2) */
    talus_vec3 normal; /* unit, from A to B */
    float separation;
} tl_axis;

/* The greatest separation over the faces of A, then of B, that is above `least`, a separation that some axis is known
 * to reach; B's face has to beat A's by `bias`. Kind NONE if there is none. g_a and g_b receive how far the other's
 * centre is in front of each face. Stops at the first axis that separates by more than `enough`. */
void tl_sat_faces(const tl_poly *a, const tl_poly *b, float least, float enough, float bias, tl_axis *best, float *g_a,
                  float *g_b);

/* The same over pairs of edges whose arcs on the Gauss maps cross, given the faces' best, which it has to beat by
 * `bias`. */
void tl_sat_edges(const tl_poly *a, const tl_poly *b, float enough, float bias, const float *g_a, const float *g_b,
                  float least, tl_axis *best);

#endif
