#define _POSIX_C_SOURCE 200809L
#include "host/clock.h"

#include <sys/resource.h>
#include <time.h>

uint64_t host_clock_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

uint64_t host_peak_rss_kib(void) {
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0 || usage.ru_maxrss < 0) {
        return 0;
    }
#ifdef __APPLE__
    return (uint64_t)usage.ru_maxrss / 1024u; /* bytes there, KiB elsewhere */
#else
    return (uint64_t)usage.ru_maxrss;
#endif
}
