/* What `talus bench` was asked to take of all that there is. */
#ifndef TALUS_TOOL_BENCH_CHOICE_H
#define TALUS_TOOL_BENCH_CHOICE_H

#include <stdint.h>
#include <string.h>

/* Whether a name is among those that were given; any is where none were. */
static inline int bench_is_chosen(const char *name, const char *const *names, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(name, names[i]) == 0) {
            return 1;
        }
    }
    return count == 0;
}

#endif
