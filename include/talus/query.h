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

/* A shape on its way through the time from 0 to 1: its centre moves along a line while it turns about it, both evenly.
 */
typedef struct talus_motion {
    talus_pose pose;        /* at time 0 */
    talus_vec3 center;      /* of the turning, in the shape's frame (m) */
    talus_vec3 translation; /* of the centre in the whole time (m) */
    talus_vec3 rotation;    /* in the whole time: along the axis, as long as the angle (rad), which is at most pi */
} talus_motion;

typedef enum talus_time_status {
    TALUS_TIME_MISS,      /* no contact; time is 1 */
    TALUS_TIME_HIT,       /* the gap shrinks to the tolerance at `time`, and there is none before */
    TALUS_TIME_TOUCHING,  /* at time 0 the shapes overlap, or are no further apart than the tolerance */
    TALUS_TIME_UNFINISHED /* no contact before `time`; what comes after was not looked at within 1000 queries */
} talus_time_status;

typedef enum talus_time_method {
    TALUS_ADVANCEMENT, /* conservative advancement */
    TALUS_BISECTION,   /* ever shorter intervals: what advancement is measured by */
    TALUS_TIME_METHOD_COUNT
} talus_time_method;

typedef struct talus_contact_time {
    talus_time_status status;
    double time;                 /* 0..1; what is fast moves a tolerance in less than a step of float */
    float gap;                   /* m, of the last query: at `time` for all but a miss; <= 0 only if touching */
    talus_vec3 normal;           /* unit, from A to B; 0 if the cores overlap */
    talus_vec3 point_a, point_b; /* next to one another on the surfaces, m; one common point if the cores overlap */
    talus_feature_pair features; /* where the last query ended */
    uint32_t queries;            /* of distance */
} talus_contact_time;

#ifdef __cplusplus
}
#endif

#endif
