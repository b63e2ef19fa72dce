/* The lists that tie bodies to shapes, contacts and joints; waking; the pair table. O(1) each unless said otherwise. */
#ifndef TL_LISTS_H
#define TL_LISTS_H

#include "stage/store/store.h"

/* Pair table: open addressing over pair_slot, which holds the contact's index plus one. */
uint32_t tl_pair_find(const tl_header *h, uint32_t shape_a, uint32_t shape_b); /* TL_NONE if there is none */

/* Fills the table anew from the living contacts. O(contacts + slots). */
void tl_pairs_rebuild(tl_header *h);

/* A contact of two shapes (a < b), not yet evaluated; TL_NONE if the capacity is used up. It is awake if a body is. */
uint32_t tl_contact_make(tl_header *h, uint32_t shape_a, uint32_t shape_b);
void tl_contact_end(tl_header *h, uint32_t contact);
/* Friction, restitution and rolling resistance of the pair, from the two materials. */
void tl_contact_mix(tl_header *h, uint32_t contact);
/* Makes the narrow stage look at all contacts of a body again. O(its contacts). */
void tl_contacts_refresh(tl_header *h, uint32_t body);

/* Gives a contact or a joint a color that neither body has yet, or takes it back. Color TL_COLORS is the overflow. */
uint32_t tl_color_take(tl_header *h, uint32_t body_a, uint32_t body_b);
void tl_color_give(tl_header *h, uint32_t body_a, uint32_t body_b, uint32_t color);

void tl_joint_link(tl_header *h, uint32_t joint);
void tl_joint_unlink(tl_header *h, uint32_t joint);
/* Ends a joint; the two bodies may collide from then on. */
void tl_joint_remove(tl_header *h, uint32_t joint);

/* Puts contacts and joints of one body into the awake lists. O(their number). */
void tl_body_set_awake(tl_header *h, uint32_t body);
/* Takes a body out of awake_body; its contacts and joints stay in theirs until tl_lists_drop_sleeping. */
void tl_body_clear_awake(tl_header *h, uint32_t body);
/* Wakes a dynamic body and the whole island that it fell asleep with. */
void tl_island_wake(tl_header *h, uint32_t body);
/* Drops contacts and joints without an awake body from the awake lists. O(awake contacts). */
void tl_lists_drop_sleeping(tl_header *h);

/* Puts a shape on the list of those that the next refit enters anew and looks for pairs of; takes it off again. */
void tl_shape_mark_moved(tl_header *h, uint32_t shape);
void tl_shape_unmark_moved(tl_header *h, uint32_t shape);

static inline int tl_body_is_dynamic(const tl_header *h, uint32_t body) {
    return tl_body_type(&tl_bodies(h)[body]) == TALUS_DYNAMIC;
}

#endif
