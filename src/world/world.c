/* The world as a whole: its block, its settings, its handles. */
#include "talus/world.h"

#include <string.h>

#include "stage/kernels.h"
#include "world/command.h"
#include "world/world_internal.h"

static const char *const STATUS_TEXT[TALUS_STATUS_COUNT] = {
    "ok",
    "bad argument",
    "not a finite number",
    "a dynamic body needs a positive mass and inertia",
    "a shape's size is outside of what is allowed",
    "the handle is stale",
    "too few bytes of memory",
    "memory is not aligned as asked",
    "a geometry blob is damaged or of another version",
    "the points span no volume",
    "too many points or vertices",
    "the instruction set is not to be had here",
    "the body capacity is used up",
    "the shape capacity is used up",
    "the joint capacity is used up",
    "the contact capacity is used up",
    "the event capacity is used up",
    "the scratch capacity is used up",
};

const char *talus_status_text(talus_status status) {
    return (unsigned)status < TALUS_STATUS_COUNT ? STATUS_TEXT[status] : "no such status";
}

static const char *const STAGE_NAMES[TALUS_STAGE_COUNT] = {
    "commands", "refit", "pairs",       "narrow", "islands", "rows",  "velocity", "solve",
    "position", "relax", "restitution", "ccd",    "commit",  "sleep", "events",
};

const char *talus_stage_name(talus_stage stage) {
    return (unsigned)stage < TALUS_STAGE_COUNT ? STAGE_NAMES[stage] : "no such stage";
}

talus_world_def talus_world_def_default(void) {
    talus_world_def def;
    memset(&def, 0, sizeof def);
    def.body_capacity = 1024;
    def.shape_capacity = 1024;
    def.joint_capacity = 256;
    def.contact_capacity = 8192;
    def.event_capacity = 1024;
    def.gravity = tl_v(0.0f, -9.81f, 0.0f);
    def.substeps = 4;
    def.iterations = 1;
    def.most_substeps = 32;
    def.contact_hertz = 58.0f;
    def.contact_damping_ratio = 0.5f;
    def.push_speed = 3.0f;
    def.speculative_margin = 0.02f;
    def.recycle_slack = 0.0005f;
    def.restitution_speed = 1.0f;
    def.hit_speed = 1.0f;
    def.sleep_speed = 0.05f;
    def.sleep_time = 0.5f;
    def.enable_sleep = 1;
    def.isa = TALUS_ISA_BEST;
    return def;
}

static int capacity_fits(uint32_t n) { return n >= 1u && n <= TALUS_MAX_CAPACITY; }
static int in_range(float x, float low, float high) { return x >= low && x <= high; }

talus_status tl_check_accuracy(const talus_accuracy *a) {
    if (!tl_is_finite(a->error_budget)) {
        return TALUS_NOT_FINITE;
    }
    int ok = in_range(a->error_budget, 0.0f, 1.0f) && a->substeps >= 1u && a->substeps <= TALUS_MAX_SUBSTEPS &&
             a->most_substeps >= 1u && a->most_substeps <= TALUS_MAX_SUBSTEPS;
    return ok ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

static talus_status check_def(const talus_world_def *d) {
    if (!d || !capacity_fits(d->body_capacity) || !capacity_fits(d->shape_capacity) ||
        !capacity_fits(d->joint_capacity) || !capacity_fits(d->contact_capacity) || !capacity_fits(d->event_capacity) ||
        d->profile_capacity > TALUS_MAX_CAPACITY) {
        return TALUS_BAD_ARGUMENT;
    }
    const float numbers[] = {d->contact_hertz, d->contact_damping_ratio,
                             d->push_speed,    d->speculative_margin,
                             d->recycle_slack, d->restitution_speed,
                             d->hit_speed,     d->sleep_speed,
                             d->sleep_time,    d->gravity.x,
                             d->gravity.y,     d->gravity.z};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (!tl_is_finite(numbers[i])) {
            return TALUS_NOT_FINITE;
        }
    }
    const talus_accuracy accuracy = {d->error_budget, d->substeps, d->most_substeps};
    talus_status status = tl_check_accuracy(&accuracy);
    if (status != TALUS_OK) {
        return status;
    }
    int ok = d->iterations >= 1u && d->iterations <= TALUS_MAX_ITERATIONS && in_range(d->contact_hertz, 1e-3f, 1e5f) &&
             in_range(d->contact_damping_ratio, 0.0f, 1e4f) && in_range(d->push_speed, 0.0f, 1e4f) &&
             in_range(d->speculative_margin, 0.0f, 1e3f) && in_range(d->recycle_slack, 0.0f, 1.0f) &&
             in_range(d->restitution_speed, 0.0f, 1e4f) && in_range(d->hit_speed, 0.0f, 1e4f) &&
             in_range(d->sleep_speed, 0.0f, 1e4f) && in_range(d->sleep_time, 0.0f, 1e4f) &&
             (unsigned)d->isa < TALUS_ISA_COUNT;
    return ok ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

size_t talus_world_size(const talus_world_def *def) {
    uint32_t capacity[TL_COUNT_COUNT], offset[TL_COLUMN_COUNT];
    if (check_def(def) != TALUS_OK) {
        return 0;
    }
    return (size_t)tl_store_layout(def, capacity, offset) * TL_UNIT;
}

static void take_settings(tl_settings *s, const talus_world_def *d) {
    s->gravity = d->gravity;
    s->substeps = d->substeps, s->iterations = d->iterations;
    s->error_budget = d->error_budget, s->most_substeps = d->most_substeps;
    s->contact_hertz = d->contact_hertz, s->contact_damping_ratio = d->contact_damping_ratio;
    s->push_speed = d->push_speed, s->speculative_margin = d->speculative_margin;
    s->recycle_slack = d->recycle_slack, s->restitution_speed = d->restitution_speed;
    s->hit_speed = d->hit_speed, s->sleep_speed = d->sleep_speed, s->sleep_time = d->sleep_time;
    s->enable_sleep = d->enable_sleep ? 1u : 0u;
}

/* The ground: a static body at the origin, index 0, never freed. */
static void make_ground(tl_header *h) {
    tl_body_meta *meta = tl_bodies(h);
    meta->flags = TALUS_STATIC | TL_BODY_ALIVE;
    meta->generation = 1;
    meta->first_shape = meta->first_joint = meta->island = meta->free_next = TL_NONE;
    tl_body_links(h)->first_pair = tl_body_links(h)->sleep_next = TL_NONE;
    tl_body_pose(h)->f[6] = tl_body_previous(h)->f[6] = tl_body_frame(h)->f[6] = 1.0f;
    tl_body_inertias(h)->gravity_scale = 1.0f;
    h->bodies.high = h->bodies.used = h->bodies.peak = 1;
}

talus_status talus_world_init(talus_world *world, const talus_world_def *def, void *block, size_t bytes) {
    if (!world || !block) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = check_def(def);
    if (status != TALUS_OK) {
        return status;
    }
    if ((uintptr_t)block % TALUS_BLOCK_ALIGNMENT) {
        return TALUS_UNALIGNED;
    }
    talus_isa isa = def->isa == TALUS_ISA_BEST ? tl_best_isa() : def->isa;
    if (!talus_isa_available(isa)) {
        return TALUS_NO_ISA;
    }
    size_t size = talus_world_size(def);
    if (size == 0 || bytes < size) {
        return TALUS_SMALL_BLOCK;
    }
    memset(block, 0, size);
    tl_header *h = block;
    h->units = tl_store_layout(def, h->capacity, h->offset);
    h->magic = TL_BLOCK_MAGIC, h->version = TL_BLOCK_VERSION;
    h->isa = (uint32_t)isa;
    take_settings(&h->settings, def);
    h->bodies.free = h->shapes.free = h->contacts.free = h->joints.free = TL_NONE;
    h->nodes.free = h->pairs.free = TL_NONE;
    h->root[0] = h->root[1] = TL_NONE;
    make_ground(h);
    world->block = block;
    world->geometry = NULL;
    world->geometry_bytes = 0;
    world->log = NULL;
    return TALUS_OK;
}

talus_status talus_world_set_isa(talus_world *world, talus_isa isa) {
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    isa = isa == TALUS_ISA_BEST ? tl_best_isa() : isa;
    if (!talus_isa_available(isa)) {
        return TALUS_NO_ISA;
    }
    tl_header_of(world)->isa = (uint32_t)isa;
    return TALUS_OK;
}

talus_isa talus_world_get_isa(const talus_world *world) {
    return tl_world_is_sound(world) ? (talus_isa)tl_header_of(world)->isa : TALUS_ISA_BEST;
}

talus_status tl_run_world_set_gravity(talus_world *world, uint32_t i, talus_command *c) {
    if (!tl_is_finite3(c->as.gravity)) {
        return TALUS_NOT_FINITE;
    }
    tl_header *h = tl_header_of(world);
    h->settings.gravity = c->as.gravity;
    for (i = 1; i < h->bodies.high; i++) {
        if ((tl_bodies(h)[i].flags & TL_BODY_ALIVE) && tl_body_is_dynamic(h, i)) {
            tl_island_wake(h, i);
        }
    }
    return TALUS_OK;
}

talus_status tl_run_world_set_accuracy(talus_world *world, uint32_t i, talus_command *c) {
    const talus_accuracy *a = &c->as.accuracy;
    (void)i;
    talus_status status = tl_check_accuracy(a);
    if (status == TALUS_OK) {
        tl_settings *s = &tl_header_of(world)->settings;
        s->error_budget = a->error_budget;
        s->substeps = a->substeps, s->most_substeps = a->most_substeps;
    }
    return status;
}

talus_status talus_world_get_def(const talus_world *world, talus_world_def *out) {
    if (!tl_world_is_sound(world) || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    const tl_settings *s = &h->settings;
    memset(out, 0, sizeof *out);
    out->body_capacity = h->capacity[TL_COUNT_BODY] - 1u;
    out->shape_capacity = h->capacity[TL_COUNT_SHAPE];
    out->joint_capacity = h->capacity[TL_COUNT_JOINT];
    out->contact_capacity = h->capacity[TL_COUNT_CONTACT];
    out->event_capacity = h->capacity[TL_COUNT_EVENT];
    out->profile_capacity = h->capacity[TL_COUNT_FRAME];
    out->gravity = s->gravity;
    out->substeps = s->substeps, out->iterations = s->iterations;
    out->error_budget = s->error_budget, out->most_substeps = s->most_substeps;
    out->contact_hertz = s->contact_hertz, out->contact_damping_ratio = s->contact_damping_ratio;
    out->push_speed = s->push_speed, out->speculative_margin = s->speculative_margin;
    out->recycle_slack = s->recycle_slack, out->restitution_speed = s->restitution_speed;
    out->hit_speed = s->hit_speed, out->sleep_speed = s->sleep_speed, out->sleep_time = s->sleep_time;
    out->enable_sleep = (uint8_t)s->enable_sleep;
    out->isa = (talus_isa)h->isa;
    return TALUS_OK;
}

talus_body talus_world_ground(const talus_world *world) {
    talus_body none = {0, 0}, ground = {0, 1};
    return tl_world_is_sound(world) ? ground : none;
}

static talus_usage usage(const tl_pool *pool, uint32_t capacity, uint32_t dropped) {
    talus_usage u = {pool->used, pool->peak, capacity, dropped};
    return u;
}

talus_status talus_world_get_counters(const talus_world *world, talus_counters *out) {
    if (!tl_world_is_sound(world) || !out) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    *out = h->counters;
    out->steps = (uint64_t)h->steps_high << 32 | h->steps_low;
    out->bodies = usage(&h->bodies, h->capacity[TL_COUNT_BODY], 0);
    out->shapes = usage(&h->shapes, h->capacity[TL_COUNT_SHAPE], 0);
    out->joints = usage(&h->joints, h->capacity[TL_COUNT_JOINT], 0);
    out->contacts = usage(&h->contacts, h->capacity[TL_COUNT_CONTACT], h->counters.contacts.dropped);
    return TALUS_OK;
}

/* --- handles ---------------------------------------------------------------------------------- */

talus_status tl_find_body(const talus_world *world, talus_body body, uint32_t *index) {
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    if (body.index >= h->bodies.high || body.generation == 0) {
        return TALUS_STALE_HANDLE;
    }
    const tl_body_meta *m = &tl_bodies(h)[body.index];
    if (!(m->flags & TL_BODY_ALIVE) || m->generation != body.generation) {
        return TALUS_STALE_HANDLE;
    }
    *index = body.index;
    return TALUS_OK;
}

talus_status tl_find_shape(const talus_world *world, talus_shape shape, uint32_t *index) {
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    if (shape.index >= h->shapes.high || shape.generation == 0) {
        return TALUS_STALE_HANDLE;
    }
    const tl_shape_meta *m = &tl_shapes(h)[shape.index];
    if (!(m->flags & TL_SHAPE_ALIVE) || m->generation != shape.generation) {
        return TALUS_STALE_HANDLE;
    }
    *index = shape.index;
    return TALUS_OK;
}

talus_status tl_find_joint(const talus_world *world, talus_joint joint, uint32_t *index) {
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    const tl_header *h = tl_header_of(world);
    if (joint.index >= h->joints.high || joint.generation == 0) {
        return TALUS_STALE_HANDLE;
    }
    const tl_joint_record *j = &tl_joints(h)[joint.index];
    if (!(j->flags & TL_JOINT_ALIVE) || j->generation != joint.generation) {
        return TALUS_STALE_HANDLE;
    }
    *index = joint.index;
    return TALUS_OK;
}
