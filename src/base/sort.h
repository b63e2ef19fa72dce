/* Sorting in place without further memory. */
#ifndef TL_SORT_H
#define TL_SORT_H

#include <stdint.h>

/* Ascending. Heapsort (Williams 1964; Knuth TAOCP 3, 5.2.3), O(n log n). */
void tl_sort_keys(uint64_t *a, uint32_t n);

/* Keeps the `room` smallest of the keys offered one by one, as a heap with the largest on top. Returns the new count; a
 * key for which there is no room pushes the largest out or is left. Then tl_sort_keys. */
uint32_t tl_heap_offer(uint64_t *heap, uint32_t count, uint32_t room, uint64_t key);

#endif
