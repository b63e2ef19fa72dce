/* Pairs of shapes whose fat boxes overlap. They are an index: which there are, in what order and what they remember
 * never shows in the bits of the state, so that trees and pairs may be dropped and found anew. O(1) each unless said
 * otherwise. */
#ifndef TL_PAIRS_H
#define TL_PAIRS_H

#include "stage/store/store.h"

/* The pair's index, or TL_NONE; a < b. Open addressing over pair_slot, which holds the index plus one. */
uint32_t tl_pair_find(const tl_header *h, uint32_t shape_a, uint32_t shape_b);
/* It will be asked for soon. */
void tl_pair_prefetch(const tl_header *h, uint32_t shape_a, uint32_t shape_b);

/* A pair that is apart and was not looked at; TL_NONE if there is no room. Pairs of contacts always have room. */
uint32_t tl_pair_make(tl_header *h, uint32_t shape_a, uint32_t shape_b);
uint32_t tl_pair_make_for_contact(tl_header *h, uint32_t shape_a, uint32_t shape_b);
/* Ends a pair that has no contact. */
void tl_pair_end(tl_header *h, uint32_t pair);
/* The contact of a pair is gone: the pair stays if there is room for one more that is apart. */
void tl_pair_leave_contact(tl_header *h, uint32_t pair, uint32_t clear, const tl_pair_cache *hint);

void tl_pair_set_awake(tl_header *h, uint32_t pair);
/* What a body's pairs remember of how far they are apart is void. O(pairs of the body). */
void tl_pairs_doubt(tl_header *h, uint32_t body);
/* Drops pairs without an awake body from awake_pair. O(awake pairs). */
void tl_pairs_drop_sleeping(tl_header *h);

/* A shape's pairs without a contact end; those of its contacts stay. O(pairs of its body). */
void tl_pairs_end_apart(tl_header *h, uint32_t shape);

/* Puts a shape on the list of those that the next refit enters anew and looks for pairs of; takes it off again. */
void tl_shape_mark_moved(tl_header *h, uint32_t shape);
/* The same of a shape that may be as good as where it was: it is entered anew only if it left its fat box. */
void tl_shape_mark_stale(tl_header *h, uint32_t shape);
void tl_shape_unmark_moved(tl_header *h, uint32_t shape);

#endif
