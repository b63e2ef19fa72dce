/* What the last step has to tell. Arrays live in the world's block and hold until the next step; their order is
 * deterministic. */
#ifndef TALUS_EVENTS_H
#define TALUS_EVENTS_H

#include "talus/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct talus_contact_event {
    talus_shape a, b;
} talus_contact_event;

typedef struct talus_hit_event {
    talus_shape a, b;
    talus_vec3 point;  /* m, world */
    talus_vec3 normal; /* from a to b */
    float speed;       /* m/s of approach */
} talus_hit_event;

typedef struct talus_sensor_event {
    talus_shape sensor, visitor;
} talus_sensor_event;

typedef struct talus_joint_event {
    talus_joint joint; /* broken in this step and gone */
    uint64_t user_data;
} talus_joint_event;

typedef struct talus_events {
    const talus_contact_event *begin, *end; /* shapes that began or ceased to touch */
    const talus_hit_event *hit;             /* that met faster than the world's hit_speed */
    const talus_sensor_event *sensor_begin, *sensor_end;
    const talus_joint_event *broken;
    uint32_t begin_count, end_count, hit_count, sensor_begin_count, sensor_end_count, broken_count;
    uint32_t dropped; /* events that did not fit in event_capacity */
} talus_events;

talus_status talus_world_get_events(const talus_world *world, talus_events *out);

#ifdef __cplusplus
}
#endif

#endif
