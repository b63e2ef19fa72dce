/* The host's clock and what the process has used. */
#ifndef TALUS_HOST_CLOCK_H
#define TALUS_HOST_CLOCK_H

#include <stdint.h>

/* Nanoseconds of a clock that never goes back. */
uint64_t host_clock_ns(void);

/* The most memory (KiB) that the process has had resident; 0 if the host does not say. */
uint64_t host_peak_rss_kib(void);

#endif
