/* A contact of a snapshot: what stands in the slot of each of its four columns, without what is nothing. */
#ifndef TL_PACK_CONTACT_H
#define TL_PACK_CONTACT_H

#include "stage/store/store.h"

/* The most bytes of one contact. As many may be written, whatever it then takes. */
#define TL_PACK_CONTACT_MOST (4u + 8u + 4u + 12u + 16u + 16u + TL_MANIFOLD_POINTS * 32u)

/* Returns where it ended. */
unsigned char *tl_pack_contact(unsigned char *p, const tl_header *h, uint32_t contact);

/* Puts a contact into a slot. If it is another pair's, or of another colour, than what stood there, that is parted from
 * its pair first, and body_a is TL_NONE until the bodies are found by the shapes. Returns where it ended, or null if
 * the bytes end before or are no contact. */
const unsigned char *tl_unpack_contact(const unsigned char *p, const unsigned char *end, tl_header *h,
                                       uint32_t contact);

#endif
