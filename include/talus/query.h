/* Queries of two shapes that need no world. */
#ifndef TALUS_QUERY_H
#define TALUS_QUERY_H

#include "talus/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a pair of shapes remembers from one query to the next: the features of both where the last one ended. A hint
 * only: any bits give a right answer, all zero is a cold start. */
typedef struct talus_feature_pair {
    uint32_t a, b;
} talus_feature_pair;

#ifdef __cplusplus
}
#endif

#endif
