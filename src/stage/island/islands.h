/* Islands: bodies that touch or are tied together sleep and wake together. */
#ifndef TL_ISLANDS_H
#define TL_ISLANDS_H

#include "stage/store/lists.h"

/* Counts how long each body has been slow; finds the islands only if some body has been so long enough, and puts to
 * sleep those in which all have. O(awake bodies), with O(awake contacts) when something may sleep. */
void tl_stage_sleep(tl_header *h, float dt);

/* island_parent of all that share a row of the solver: moving kinematic bodies are in the islands of what they touch.
 * O(awake bodies, contacts and joints). */
void tl_islands_of_rows(tl_header *h);

/* Puts the island of an awake dynamic body to sleep, however fast it is. */
void tl_island_sleep(tl_header *h, uint32_t body);

#endif
