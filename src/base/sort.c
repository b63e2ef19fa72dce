#include "base/sort.h"

static void sink(uint64_t *a, uint32_t i, uint32_t n) {
    uint64_t key = a[i];
    for (uint32_t child = 2u * i + 1u; child < n; child = 2u * i + 1u) {
        child += child + 1u < n && a[child + 1u] > a[child];
        if (a[child] <= key) {
            break;
        }
        a[i] = a[child];
        i = child;
    }
    a[i] = key;
}

void tl_sort_keys(uint64_t *a, uint32_t n) {
    for (uint32_t i = n / 2u; i-- > 0;) {
        sink(a, i, n);
    }
    for (uint32_t end = n; end-- > 1u;) {
        uint64_t top = a[0];
        a[0] = a[end];
        a[end] = top;
        sink(a, 0, end);
    }
}

uint32_t tl_heap_offer(uint64_t *heap, uint32_t count, uint32_t room, uint64_t key) {
    if (count < room) {
        uint32_t i = count;
        while (i > 0 && heap[(i - 1u) / 2u] < key) {
            heap[i] = heap[(i - 1u) / 2u];
            i = (i - 1u) / 2u;
        }
        heap[i] = key;
        return count + 1u;
    }
    if (room > 0 && key < heap[0]) {
        heap[0] = key;
        sink(heap, 0, room);
    }
    return count;
}
