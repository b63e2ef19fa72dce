/* A hint that a place in memory will be read soon; where a compiler has none, nothing. */
#ifndef TL_PREFETCH_H
#define TL_PREFETCH_H

static inline void tl_prefetch(const void *p) {
#if defined(__GNUC__)
    __builtin_prefetch(p);
#else
    (void)p;
#endif
}

#endif
