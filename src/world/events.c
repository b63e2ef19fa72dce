#include "talus/events.h"

#include <string.h>

#include "world/world_internal.h"

talus_status talus_world_get_events(const talus_world *world, talus_events *out) {
    if (!tl_world_is_sound(world) || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    memset(out, 0, sizeof *out);
    out->begin = tl_event_begin(h), out->end = tl_event_end(h), out->hit = tl_event_hit(h);
    out->sensor_begin = tl_event_sensor_begin(h), out->sensor_end = tl_event_sensor_end(h);
    out->broken = tl_event_broken(h);
    out->begin_count = h->events.begin, out->end_count = h->events.end, out->hit_count = h->events.hit;
    out->sensor_begin_count = h->events.sensor_begin, out->sensor_end_count = h->events.sensor_end;
    out->broken_count = h->events.broken;
    out->dropped = h->events.dropped;
    return TALUS_OK;
}
