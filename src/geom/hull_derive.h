/* What a hull's blob says twice: the numbers of its header that follow from its arrays. The builder writes them and the
 * validator works them out again and compares bits. */
#ifndef TL_HULL_DERIVE_H
#define TL_HULL_DERIVE_H

#include "geom/hull.h"

/* Writes volume, centroid, inertia, bounds and radii of h into *out (a copy of h's header, arrays being h's). */
void tl_hull_derive(const talus_hull *h, talus_hull *out);
/* FNV-1a, by 32-bit words and with a shift between them, over all after the header's first 16 bytes. `bytes` is a
 * multiple of 32. */
uint32_t tl_hull_checksum(const void *blob, uint32_t bytes);
/* Whether volume and inertia are positive and they and the radii finite, which floats may fail at sizes far from 1 m.
 */
int tl_hull_has_mass(const talus_hull *h);
/* Sets strides, offsets and bytes from the three counts. The counts are at most 65536 each. */
void tl_hull_layout(talus_hull *h);

#endif
