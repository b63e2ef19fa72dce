/* Convex hulls: built once on the caller's scratch into one relocatable blob that holds no pointer, so that it can be
 * baked offline, placed in read-only memory and shared between worlds. */
#ifndef TALUS_HULL_H
#define TALUS_HULL_H

#include "talus/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TALUS_HULL_MAX_POINTS 65535u   /* points handed to the builder */
#define TALUS_HULL_MAX_VERTICES 10900u /* vertices a hull may have; its half-edges are counted in 16 bits */
#define TALUS_BLOB_ALIGNMENT 32u       /* bytes, of blobs in memory and of their offsets in a geometry region */

typedef struct talus_hull talus_hull; /* opaque: src/geom/hull.h has the layout */

/* Bytes of scratch for `count` points, and the most bytes that their blob can have. */
size_t talus_hull_scratch_size(uint32_t count);
size_t talus_hull_max_size(uint32_t count);

/* Builds the hull of `count` points (m) into `out`; *size receives the bytes used. Points that differ from the hull by
 * less than about 1e-6 of its extent are merged into its faces and vertices. Quickhull: O(n log n) as a rule.
 * TALUS_FLAT_HULL if the points lie in a plane, a line or a point; TALUS_NOT_FINITE; TALUS_TOO_MANY_POINTS;
 * TALUS_SMALL_BLOCK if scratch or out are too small; TALUS_UNALIGNED if either is not TALUS_BLOB_ALIGNMENT aligned. */
talus_status talus_hull_build(const talus_vec3 *points, uint32_t count, void *scratch, size_t scratch_size, void *out,
                              size_t out_size, size_t *size);

/* Whether `bytes` bytes at `blob` hold a sound hull: every index in range, closed topology, convex, finite.
 * Reads nothing outside of them. O(size). */
talus_status talus_hull_validate(const void *blob, size_t bytes);

/* Of a sound hull: its bytes, vertices, faces, and its mass at a density (kg/m^3). */
size_t talus_hull_size(const talus_hull *hull);
uint32_t talus_hull_vertex_count(const talus_hull *hull);
uint32_t talus_hull_face_count(const talus_hull *hull);
talus_vec3 talus_hull_vertex(const talus_hull *hull, uint32_t i);
talus_mass talus_hull_mass(const talus_hull *hull, float density);

#ifdef __cplusplus
}
#endif

#endif
