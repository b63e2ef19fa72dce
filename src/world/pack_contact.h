/* The contacts of a snapshot: what stands in each of their slots in four columns, without what is nothing. */
#ifndef TL_PACK_CONTACT_H
#define TL_PACK_CONTACT_H

#include "world/reindex.h"

/* The most bytes of all contacts. As many may be written, whatever they then take. */
size_t tl_pack_contacts_bound(const tl_header *h);
/* Returns where they ended. */
unsigned char *tl_pack_contacts(unsigned char *p, const tl_header *h);

/* Puts the contacts into their slots, and ends what else stood below contacts.high. One that is another pair's, or of
 * another colour, than what stood in its slot is listed in `changes`; that is parted from its pair first, and body_a is
 * TL_NONE until the bodies are found by the shapes. Returns where they ended, or null if the bytes end before or are no
 * contacts. */
const unsigned char *tl_unpack_contacts(const unsigned char *p, const unsigned char *end, tl_header *h,
                                        tl_changes *changes);

#endif
