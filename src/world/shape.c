/* Shapes of bodies: making, ending, materials and filters. */
#include "talus/shape.h"

#include <string.h>

#include "geom/mass.h"
#include "stage/broad/refit.h"
#include "stage/stages.h"
#include "world/command.h"
#include "world/world_internal.h"

talus_shape_def talus_shape_def_default(void) {
    talus_shape_def def;
    memset(&def, 0, sizeof def);
    def.geometry.type = TALUS_BOX;
    def.geometry.half = tl_v(0.5f, 0.5f, 0.5f);
    def.pose = tl_pose_identity();
    def.material.static_friction = def.material.dynamic_friction = 0.5f;
    def.filter.category = 1u;
    def.filter.mask = ~(uint64_t)0;
    def.density = 1000.0f;
    return def;
}

static talus_status check_material(const talus_material *m) {
    const float numbers[] = {m->static_friction, m->dynamic_friction, m->restitution, m->rolling_resistance};
    for (int i = 0; i < 4; i++) {
        if (!tl_is_finite(numbers[i])) {
            return TALUS_NOT_FINITE;
        }
        if (numbers[i] < 0.0f || numbers[i] > 1e6f) {
            return TALUS_BAD_ARGUMENT;
        }
    }
    if (m->restitution > 1.0f || (unsigned)m->friction_combine >= TALUS_COMBINE_COUNT ||
        (unsigned)m->restitution_combine >= TALUS_COMBINE_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    return TALUS_OK;
}

static tl_material stored(const talus_material *m) {
    tl_material s = {m->static_friction,    m->dynamic_friction,           m->restitution,
                     m->rolling_resistance, (uint32_t)m->friction_combine, (uint32_t)m->restitution_combine};
    return s;
}

static talus_status check_def(const talus_world *world, const talus_shape_def *d) {
    talus_status status = tl_geometry_check(&d->geometry, world->geometry, world->geometry_bytes);
    if (status == TALUS_OK) {
        status = check_material(&d->material);
    }
    if (status != TALUS_OK) {
        return status;
    }
    if (!tl_is_finite(d->density)) {
        return TALUS_NOT_FINITE;
    }
    return d->density >= 0.0f ? tl_check_pose(&d->pose) : TALUS_BAD_ARGUMENT;
}

talus_status tl_run_shape_create(talus_world *world, uint32_t i, talus_command *c) {
    const talus_shape_def *def = &c->as.shape.def;
    uint32_t b;
    talus_status status = tl_find_body(world, c->as.shape.body, &b);
    if (status == TALUS_OK) {
        status = check_def(world, def);
    }
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    i = tl_pool_top(&h->shapes, h->capacity[TL_COUNT_SHAPE]);
    if (i == TL_NONE) {
        return TALUS_FULL_SHAPES;
    }
    tl_shape_meta *meta = &tl_shapes(h)[i];
    tl_pool_take(&h->shapes, i, meta->next);
    uint32_t generation = tl_next_generation(meta->generation);
    memset(meta, 0, sizeof *meta);
    meta->generation = generation;
    meta->flags = TL_SHAPE_ALIVE | (def->sensor ? TL_SHAPE_SENSOR : 0u) | (def->events ? TL_SHAPE_EVENTS : 0u);
    h->event_shapes += (meta->flags & (TL_SHAPE_SENSOR | TL_SHAPE_EVENTS)) != 0;
    meta->body = b;
    meta->group = def->filter.group;
    meta->density = def->density;
    talus_geometry *geometry = &tl_shape_geometry(h)[i];
    memset(geometry, 0, sizeof *geometry);
    *geometry = def->geometry;
    tl_shape_pose(h)[i] = def->pose;
    tl_shape_pose(h)[i].rotation = tl_quat_normalize(def->pose.rotation);
    tl_shape_material(h)[i] = stored(&def->material);
    tl_shape_category(h)[i] = def->filter.category;
    tl_shape_mask(h)[i] = def->filter.mask;
    tl_shape_user(h)[i] = def->user_data;
    if (tl_bodies(h)[b].first_shape != TL_NONE) { /* the first shape of a body that starts asleep lets it sleep */
        tl_island_wake(h, b);
    }
    meta->next = tl_bodies(h)[b].first_shape;
    tl_bodies(h)[b].first_shape = i;
    tl_body_update_mass(world, b); /* places the shape and enters it in the list of what moved */
    c->index = i, c->generation = generation;
    return TALUS_OK;
}

/* Ends the contacts of a shape and its pairs, and wakes what lay against it. */
static void part(tl_header *h, uint32_t shape) {
    uint32_t count = tl_contacts_of(h, tl_shapes(h)[shape].body, shape);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t c = tl_contact_order(h)[k];
        tl_island_wake(h, tl_contacts(h)[c].body_a);
        tl_island_wake(h, tl_contacts(h)[c].body_b);
        tl_event_contact_end(h, c);
        tl_contact_end(h, c, 0);
    }
    tl_pairs_end_apart(h, shape);
}

void tl_shape_remove(tl_header *h, uint32_t i) {
    tl_shape_meta *meta = &tl_shapes(h)[i];
    uint32_t body = meta->body;
    part(h, i);
    uint32_t *at = &tl_bodies(h)[body].first_shape;
    while (*at != i) {
        at = &tl_shapes(h)[*at].next;
    }
    *at = meta->next;
    tl_shape_leave_tree(h, i);
    tl_shape_unmark_moved(h, i);
    h->event_shapes -= (meta->flags & (TL_SHAPE_SENSOR | TL_SHAPE_EVENTS)) != 0;
    uint32_t generation = meta->generation;
    memset(meta, 0, sizeof *meta);
    meta->generation = generation;
    meta->next = h->shapes.free;
    h->shapes.free = i;
    h->shapes.used--;
}

talus_status tl_run_shape_destroy(talus_world *world, uint32_t i, talus_command *c) {
    (void)c;
    tl_header *h = tl_header_of(world);
    uint32_t body = tl_shapes(h)[i].body;
    tl_island_wake(h, body);
    tl_shape_remove(h, i);
    tl_body_update_mass(world, body);
    return TALUS_OK;
}

int talus_shape_is_valid(const talus_world *world, talus_shape shape) {
    uint32_t i;
    return tl_find_shape(world, shape, &i) == TALUS_OK;
}

talus_status talus_shape_get_body(const talus_world *world, talus_shape shape, talus_body *out) {
    uint32_t i;
    talus_status status = out ? tl_find_shape(world, shape, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        const tl_header *h = tl_header_of(world);
        out->index = tl_shapes(h)[i].body;
        out->generation = tl_bodies(h)[out->index].generation;
    }
    return status;
}

talus_status talus_shape_get_user_data(const talus_world *world, talus_shape shape, uint64_t *out) {
    uint32_t i;
    talus_status status = out ? tl_find_shape(world, shape, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_shape_user(tl_header_of(world))[i];
    }
    return status;
}

talus_status talus_shape_get_material(const talus_world *world, talus_shape shape, talus_material *out) {
    uint32_t i;
    talus_status status = out ? tl_find_shape(world, shape, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        const tl_material *m = &tl_shape_material(tl_header_of(world))[i];
        out->static_friction = m->static_friction, out->dynamic_friction = m->dynamic_friction;
        out->restitution = m->restitution, out->rolling_resistance = m->rolling_resistance;
        out->friction_combine = (talus_combine)m->friction_combine;
        out->restitution_combine = (talus_combine)m->restitution_combine;
    }
    return status;
}

talus_status tl_run_shape_set_material(talus_world *world, uint32_t i, talus_command *c) {
    talus_status status = check_material(&c->as.material);
    if (status != TALUS_OK) {
        return status;
    }
    tl_header *h = tl_header_of(world);
    tl_shape_material(h)[i] = stored(&c->as.material);
    uint32_t body = tl_shapes(h)[i].body;
    tl_island_wake(h, body);
    uint32_t count = tl_contacts_of(h, body, i);
    for (uint32_t k = 0; k < count; k++) {
        tl_contact_mix(h, tl_contact_order(h)[k]);
    }
    return TALUS_OK;
}

talus_status talus_shape_get_filter(const talus_world *world, talus_shape shape, talus_filter *out) {
    uint32_t i;
    talus_status status = out ? tl_find_shape(world, shape, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_shape_filter(tl_header_of(world), i);
    }
    return status;
}

talus_status tl_run_shape_set_filter(talus_world *world, uint32_t i, talus_command *c) {
    const talus_filter *filter = &c->as.filter;
    tl_header *h = tl_header_of(world);
    tl_shape_category(h)[i] = filter->category;
    tl_shape_mask(h)[i] = filter->mask;
    tl_shapes(h)[i].group = filter->group;
    tl_island_wake(h, tl_shapes(h)[i].body);
    part(h, i);
    tl_shape_mark_moved(h, i);
    return TALUS_OK;
}

talus_status talus_shape_get_aabb(const talus_world *world, talus_shape shape, talus_aabb *out) {
    uint32_t i;
    talus_status status = out ? tl_find_shape(world, shape, &i) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_shape_box(tl_header_of(world), world->geometry, i);
    }
    return status;
}
