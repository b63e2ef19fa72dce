/* The lists that tie bodies to contacts and joints; colours; waking. O(1) each unless said otherwise. What is awake is
 * kept as sets of bits and walked in ascending order, so that no order depends on how a world came to its state. */
#ifndef TL_LISTS_H
#define TL_LISTS_H

#include "stage/store/pairs.h"

/* A contact of two shapes (a < b) without points, in the lowest free slot; TL_NONE if the capacity is used up. It is
 * awake if a body is. O(slots / 64). */
uint32_t tl_contact_make(tl_header *h, uint32_t shape_a, uint32_t shape_b);
/* Makes a contact's row as it was when the world was new. */
void tl_contact_clear(tl_header *h, uint32_t contact);
/* Ties a contact to its pair, which is made if there is none. */
void tl_contact_enter(tl_header *h, uint32_t contact);
void tl_contact_tie(tl_header *h, uint32_t contact, uint32_t pair);
/* `clear` is what the pair keeps of how far the shapes are apart (tl_pair.clear). */
void tl_contact_end(tl_header *h, uint32_t contact, uint32_t clear);
/* Friction, restitution and rolling resistance of the pair, from the two materials. */
void tl_contact_mix(tl_header *h, uint32_t contact);
/* The contacts of a body, or of one shape of it, ascending, into contact_order; returns their number n.
 * O(pairs of the body + n log n). */
uint32_t tl_contacts_of(const tl_header *h, uint32_t body, uint32_t shape);
/* Makes the narrow stage look at all pairs of a body again. O(its pairs). */
void tl_contacts_refresh(tl_header *h, uint32_t body);
/* Fills awake_contact and awake_joint. O(slots / 64 + awake). */
void tl_lists_of_awake(tl_header *h);

/* Gives a contact or a joint a color that neither body has yet, or takes it back. Color TL_COLORS is the overflow. */
uint32_t tl_color_take(tl_header *h, uint32_t body_a, uint32_t body_b);
void tl_color_give(tl_header *h, uint32_t body_a, uint32_t body_b, uint32_t color);

void tl_joint_link(tl_header *h, uint32_t joint);
void tl_joint_unlink(tl_header *h, uint32_t joint);
/* Ends a joint; the two bodies may collide from then on. */
void tl_joint_remove(tl_header *h, uint32_t joint);

/* Makes a body awake, and what it has of pairs, contacts and joints. O(their number). */
void tl_body_set_awake(tl_header *h, uint32_t body);
/* Takes a body out of awake_body; its contacts and joints stay awake until tl_lists_drop_sleeping. */
void tl_body_clear_awake(tl_header *h, uint32_t body);
/* Ties a sleeping body into the ring of those that fell asleep with it; `island` is the lowest of them. */
void tl_body_fall_asleep(tl_header *h, uint32_t body, uint32_t island);
/* Wakes a dynamic body and the whole island that it fell asleep with. */
void tl_island_wake(tl_header *h, uint32_t body);
/* Drops pairs, contacts and joints without an awake body from the awake ones; awake_contact and awake_joint must be up
 * to date. O(awake pairs). */
void tl_lists_drop_sleeping(tl_header *h);

static inline int tl_body_is_dynamic(const tl_header *h, uint32_t body) {
    return tl_body_type(&tl_bodies(h)[body]) == TALUS_DYNAMIC;
}
/* Whether a body neither moves nor can be moved: the points of its contacts are then kept in the world. */
static inline int tl_body_is_fixed(const tl_header *h, uint32_t body) {
    return !tl_body_row(h)[body] && !tl_body_is_dynamic(h, body);
}

#endif
