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

/* Points of B - A that are known: along a unit normal n the shapes are at most n.w apart. In A's frame. */
#define TL_SAT_POINTS 8u

/* What one query knows of its shapes. */
typedef struct tl_sat {
    const tl_poly *a, *b;
    float least;  /* some axis separates by at least this much; what does not is not looked at */
    float enough; /* an axis that separates by more ends the search */
    float bias;   /* by which a face of B has to beat one of A, and edges have to beat faces */
    uint32_t point_count;
    talus_vec3 point[TL_SAT_POINTS];
    float front_a[TL_SAT_FACES], front_b[TL_SAT_FACES]; /* how far the other's centre is in front of each face */
} tl_sat;

/* The greatest separation over the faces of both. Kind NONE if none is above `least`. */
void tl_sat_faces(tl_sat *s, tl_axis *best);

/* The same over pairs of edges whose arcs on the Gauss maps cross, given the faces' best. */
void tl_sat_edges(tl_sat *s, tl_axis *best);

#endif
