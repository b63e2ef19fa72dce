/* Events: touches of shapes that ask for them, overlaps of sensors, hits, broken joints. */
#include <string.h>

#include "stage/stages.h"
#include "stage/store/lists.h"

static talus_shape handle_of(const tl_header *h, uint32_t shape) {
    talus_shape s = {shape, tl_shapes(h)[shape].generation};
    return s;
}

void tl_events_begin(tl_header *h) { memset(&h->events, 0, sizeof h->events); }

/* The next place in an event list, or TL_NONE if it is full. */
static uint32_t next_event(tl_header *h, uint32_t *count) {
    if (*count >= h->capacity[TL_COUNT_EVENT]) {
        h->events.dropped++;
        return TL_NONE;
    }
    return (*count)++;
}

static void tell_touch(tl_header *h, uint32_t contact, talus_contact_event *list, uint32_t *count) {
    const tl_contact_meta *l = &tl_contacts(h)[contact];
    uint32_t i = next_event(h, count);
    if (i != TL_NONE) {
        list[i].a = handle_of(h, l->shape_a);
        list[i].b = handle_of(h, l->shape_b);
    }
}

static void tell_sensor(tl_header *h, uint32_t contact, talus_sensor_event *list, uint32_t *count) {
    const tl_contact_meta *l = &tl_contacts(h)[contact];
    int a_senses = (tl_shapes(h)[l->shape_a].flags & TL_SHAPE_SENSOR) != 0;
    uint32_t i = next_event(h, count);
    if (i != TL_NONE) {
        list[i].sensor = handle_of(h, a_senses ? l->shape_a : l->shape_b);
        list[i].visitor = handle_of(h, a_senses ? l->shape_b : l->shape_a);
    }
}

void tl_event_contact_end(tl_header *h, uint32_t contact) {
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    if (!(m->flags & TL_CONTACT_CLOSE)) {
        return;
    }
    if (m->flags & TL_CONTACT_SENSOR) {
        tell_sensor(h, contact, tl_event_sensor_end(h), &h->events.sensor_end);
    } else if (m->flags & TL_CONTACT_EVENTS) {
        tell_touch(h, contact, tl_event_end(h), &h->events.end);
    }
}

static void tell_begin(tl_header *h, uint32_t contact) {
    tl_contact_meta *m = &tl_contacts(h)[contact];
    m->flags |= TL_CONTACT_CLOSE;
    if (m->flags & TL_CONTACT_SENSOR) {
        tell_sensor(h, contact, tl_event_sensor_begin(h), &h->events.sensor_begin);
    } else {
        tell_touch(h, contact, tl_event_begin(h), &h->events.begin);
    }
}

static void tell_hit(tl_header *h, const tl_contact_group *g, uint32_t lane, float speed, uint32_t point) {
    const tl_contact_meta *l = &tl_contacts(h)[g->contact[lane]];
    uint32_t record = g->plane ? tl_plane_first(tl_contact_plane(h)[g->contact[lane]], point) : point;
    const tl_contact_point_record *r = &tl_points(h)[g->contact[lane]].p[record];
    talus_pose body = tl_row_pose_of(&tl_row_pose(h)[g->a[lane]]);
    talus_vec3 at = tl_pose_point(&body, tl_v(r->a[0], r->a[1], r->a[2]));
    talus_vec3 normal = tl_v(g->normal[0][lane], g->normal[1][lane], g->normal[2][lane]);
    if (!tl_is_finite3(at) || !tl_is_finite3(normal) || !tl_is_finite(speed)) {
        return; /* beyond what floats hold: the commit has stopped the body */
    }
    uint32_t i = next_event(h, &h->events.hit);
    if (i == TL_NONE) {
        return;
    }
    talus_hit_event *e = &tl_event_hit(h)[i];
    e->a = handle_of(h, l->shape_a);
    e->b = handle_of(h, l->shape_b);
    e->point = at;
    e->normal = normal;
    e->speed = speed;
}

/* Touches of one group of the solver: pressed in this step means that surfaces met. */
static void group_events(tl_header *h, const tl_contact_group *g) {
    for (uint32_t lane = 0; lane < g->lanes; lane++) {
        const tl_contact_meta *m = &tl_contacts(h)[g->contact[lane]];
        if (!(m->flags & TL_CONTACT_EVENTS)) {
            continue;
        }
        float fastest = 0.0f;
        uint32_t point = 0;
        int pressed = 0;
        for (uint32_t p = 0; p < g->points; p++) {
            if (g->point[p].peak[lane] > 0.0f) {
                pressed = 1;
                if (g->point[p].approach[lane] > fastest) {
                    fastest = g->point[p].approach[lane];
                    point = p;
                }
            }
        }
        if (pressed && !(m->flags & TL_CONTACT_CLOSE)) {
            tell_begin(h, g->contact[lane]);
        }
        if (pressed && fastest > h->settings.hit_speed) {
            tell_hit(h, g, lane, fastest, point);
        }
    }
}

static void break_joints(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t k = h->awake_joints; k-- > 0;) {
        uint32_t i = tl_awake_joint(h)[k];
        tl_joint_record *j = &tl_joints(h)[i];
        const tl_joint_state *s = &tl_joint_states(h)[i];
        float force = s->force[0] * s->force[0] + s->force[1] * s->force[1] + s->force[2] * s->force[2];
        float torque = s->torque[0] * s->torque[0] + s->torque[1] * s->torque[1] + s->torque[2] * s->torque[2];
        int breaks = (j->break_force > 0.0f && force > j->break_force * j->break_force) ||
                     (j->break_torque > 0.0f && torque > j->break_torque * j->break_torque);
        if (!breaks) {
            continue;
        }
        uint32_t e = next_event(h, &h->events.broken);
        if (e != TL_NONE) {
            tl_event_broken(h)[e].joint.index = i;
            tl_event_broken(h)[e].joint.generation = j->generation;
            tl_event_broken(h)[e].user_data = tl_joint_user(h)[i];
        }
        tl_joint_remove(h, i);
    }
}

void tl_stage_touches(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t i = 0; i < h->groups; i++) {
        const tl_contact_group *g = &tl_group_pool(h)[i];
        if (g->heard) {
            group_events(h, g);
        }
    }
}

void tl_stage_events(tl_step *step) {
    tl_header *h = step->h;
    if (h->event_shapes > 0) {
        for (uint32_t k = 0; k < h->awake_contacts; k++) {
            uint32_t c = tl_awake_contact(h)[k];
            const tl_contact_meta *m = &tl_contacts(h)[c];
            if ((m->flags & TL_CONTACT_SENSOR) && !(m->flags & TL_CONTACT_CLOSE)) {
                tell_begin(h, c);
            }
        }
    }
    if (h->breaking_joints > 0) {
        break_joints(step);
    }
    const tl_event_counts *e = &h->events;
    h->counters.events.used = e->begin + e->end + e->hit + e->sensor_begin + e->sensor_end + e->broken;
    h->counters.events.capacity = h->capacity[TL_COUNT_EVENT];
    h->counters.events.dropped = e->dropped;
    if (h->counters.events.used > h->counters.events.high_water) {
        h->counters.events.high_water = h->counters.events.used;
    }
}
