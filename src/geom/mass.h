/* The checks that every user of a geometry makes first. */
#ifndef TL_MASS_H
#define TL_MASS_H

#include "geom/hull.h"
#include "talus/shape.h"

/* Whether the geometry's numbers are finite and in range (TALUS_NOT_FINITE, TALUS_BAD_SHAPE), and its hull lies in the
 * region and is sound (TALUS_BAD_BLOB, TALUS_UNALIGNED). Walks the whole of a hull. */
talus_status tl_geometry_check(const talus_geometry *g, const void *region, size_t region_bytes);
/* The hull of a checked geometry. */
const talus_hull *tl_geometry_hull(const talus_geometry *g, const void *region);

#endif
