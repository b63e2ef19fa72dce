/* The layout of a convex hull's blob: this header, then its arrays, each at a 32-byte aligned offset from the blob's
 * start. The half-edges 2k and 2k + 1 are twins. Faces are convex polygons, counter-clockwise seen from outside. */
#ifndef TL_HULL_H
#define TL_HULL_H

#include "talus/hull.h"

#define TL_HULL_MAGIC 0x4c555448u /* "HTUL" */
#define TL_HULL_VERSION 2u

struct talus_hull {
    uint32_t magic, version;
    uint32_t bytes;    /* of the whole blob, a multiple of 32 */
    uint32_t checksum; /* of all bytes after this header's first 16 */
    uint32_t vertex_count, face_count, half_edge_count;
    uint32_t vertices; /* offset: x[], y[], z[], each of vertex_stride floats, padded by repeating the last vertex */
    uint32_t
        planes; /* offset: nx[], ny[], nz[], d[], each of face_stride floats, padded by repeating the last; n.p = d */
    uint32_t vertex_edge;                /* offset: u16[vertex_count], a half-edge that leaves each vertex */
    uint32_t face_edge;                  /* offset: u16[face_count], a half-edge of each face */
    uint32_t edges;                      /* offset: tl_half_edge[half_edge_count] */
    uint32_t vertex_stride, face_stride; /* multiples of 8 */
    float volume;                        /* m^3 */
    talus_vec3 centroid;                 /* m */
    float inertia[6];                    /* xx yy zz xy xz yz about the centroid at density 1, m^5 */
    talus_aabb bounds;                   /* m */
    float inner_radius;                  /* m: of the ball around the centroid that fits inside */
    float outer_radius;                  /* m: of the ball around the centroid that holds it */
    uint32_t squares;                    /* along an edge of the cube of directions; 0 of a hull of few vertices */
    uint32_t directions; /* offset: u16[6 squares squares], vertices about furthest along the squares' middles */
};

typedef struct tl_half_edge {
    uint16_t next;   /* the next half-edge of the face, counter-clockwise */
    uint16_t origin; /* the vertex it leaves */
    uint16_t face;
    uint16_t reserved;
} tl_half_edge;

static inline const float *tl_hull_x(const talus_hull *h) {
    return (const float *)(const void *)((const unsigned char *)h + h->vertices);
}
static inline const float *tl_hull_y(const talus_hull *h) { return tl_hull_x(h) + h->vertex_stride; }
static inline const float *tl_hull_z(const talus_hull *h) { return tl_hull_x(h) + 2u * h->vertex_stride; }
/* nx, then ny, nz, d at face_stride floats each. */
static inline const float *tl_hull_planes(const talus_hull *h) {
    return (const float *)(const void *)((const unsigned char *)h + h->planes);
}
static inline const uint16_t *tl_hull_vertex_edge(const talus_hull *h) {
    return (const uint16_t *)(const void *)((const unsigned char *)h + h->vertex_edge);
}
static inline const uint16_t *tl_hull_face_edge(const talus_hull *h) {
    return (const uint16_t *)(const void *)((const unsigned char *)h + h->face_edge);
}
static inline const tl_half_edge *tl_hull_edges(const talus_hull *h) {
    return (const tl_half_edge *)(const void *)((const unsigned char *)h + h->edges);
}
static inline const uint16_t *tl_hull_directions(const talus_hull *h) {
    return (const uint16_t *)(const void *)((const unsigned char *)h + h->directions);
}
static inline uint32_t tl_hull_twin(uint32_t half_edge) { return half_edge ^ 1u; }
static inline talus_vec3 tl_hull_point(const talus_hull *h, uint32_t i) {
    const float *x = tl_hull_x(h);
    talus_vec3 p = {x[i], x[h->vertex_stride + i], x[2u * h->vertex_stride + i]};
    return p;
}
static inline talus_vec3 tl_hull_normal(const talus_hull *h, uint32_t face) {
    const float *n = tl_hull_planes(h);
    talus_vec3 p = {n[face], n[h->face_stride + face], n[2u * h->face_stride + face]};
    return p;
}
static inline float tl_hull_offset(const talus_hull *h, uint32_t face) {
    return tl_hull_planes(h)[3u * h->face_stride + face];
}

#endif
