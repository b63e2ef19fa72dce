/* The step: one direction, one loop over sub-steps. */
#include <string.h>

#include "stage/broad/refit.h"
#include "stage/island/efforts.h"
#include "stage/island/islands.h"
#include "stage/stages.h"
#include "world/command.h"
#include "world/watch.h"

/* A contact in overlap is a damped spring of the set frequency, no stiffer than what the sub-steps can follow. */
#define MOST_HERTZ_OF_SUBSTEPS 0.25f

/* Over the contacts for impacts that run from body to body, a sub-step; what is then left does not bounce. */
#define MOST_SWEEPS 16u

static void set_softness(tl_step *step) {
    const tl_settings *s = &step->h->settings;
    float hertz = tl_min(s->contact_hertz * (float)(1u << step->level), MOST_HERTZ_OF_SUBSTEPS * step->inverse_sub);
    float omega = 6.2831853f * hertz, zeta = s->contact_damping_ratio, h = step->sub;
    float a1 = 2.0f * zeta + h * omega, a2 = h * omega * a1, a3 = 1.0f / (1.0f + a2);
    step->bias_rate = omega / a1;
    step->mass_scale = a2 * a3;
    step->impulse_scale = a3;
    step->spring = h * omega * omega;
}

/* The sub-steps of islands of a level. Of two levels each length is the other's times a power of two, to the bit. */
static void set_level(tl_step *step, uint32_t level) {
    step->level = level;
    step->substeps = step->h->settings.substeps << level;
    step->sub = step->dt / (float)step->substeps;
    step->inverse_sub = 1.0f / step->sub;
    step->warm_scale = step->sub_before > 0.0f ? step->sub / step->sub_before : 1.0f;
    step->any_locks = step->skip_exact = step->deferred = step->before_move = step->stiff = step->again = 0;
    step->waits = 0;
    step->pushes = 0;
    set_softness(step);
}

static void begin_step(tl_step *step, const talus_world *world, float dt) {
    tl_header *h = tl_header_of(world);
    step->h = h;
    step->geometry = world->geometry;
    step->dt = dt;
    step->sub_before = h->settings.substep;
    step->rows = step->awake = 0;
    step->parted = step->has_islands = step->bounced = step->rolled = 0;
    step->most_rows = 0;
    memset(step->sums, 0, sizeof step->sums);
    h->settings.substep = dt / (float)h->settings.substeps;
    tl_events_begin(h);
    h->counters.islands_slept = h->counters.islands_woken = h->counters.bodies_slept = h->counters.bodies_woken = 0;
    h->counters.impact_sweeps = h->counters.groups_struck = 0;
}

/* Sweeps over the contacts until none meets fast enough to bounce. */
static void strike(tl_step *step, const tl_kernels *k) {
    tl_header *h = step->h;
    for (uint32_t sweep = 0, struck = 1; struck && sweep < MOST_SWEEPS; sweep++) {
        k->strike_contacts(step, 0, h->groups);
        struck = 0;
        for (uint32_t i = 0; i < h->groups; i++) {
            struck += tl_group_pool(h)[i].struck;
        }
        h->counters.impact_sweeps++;
        h->counters.groups_struck += struck;
    }
}

/* The joints that hang together: what they have to meet, all of it at once, and back to the bodies. */
static void run_linkages(const tl_step *step, const tl_kernels *k, tl_kernel read, tl_kernel apply) {
    if (step->h->linkages) {
        read(step, 0, step->h->joint_groups);
        if (step->waits) {
            tl_stage_near_linkages(step->h);
        }
        k->solve_linkages(step, 0, step->h->linkages);
        apply(step, 0, step->h->joint_groups);
    }
}

/* Velocities of linkages, again where a range would have had to pull. */
#define MOST_RELEASES 2u

static void run_linked_velocities(tl_step *step, const tl_kernels *k) {
    run_linkages(step, k, k->read_velocities, k->apply_impulses);
    step->again = 1;
    for (uint32_t i = 0; i < MOST_RELEASES && tl_stage_far_linkages(step->h); i++) {
        run_linkages(step, k, k->read_velocities, k->apply_impulses);
    }
    step->again = 0;
}

/* How often in a sub-step errors of linked joints are taken back that are too large for once. */
#define MOST_PUSHES 8u

/* Displacements to the places of the bodies that may go there. */
static void push_bodies(tl_step *step, const tl_kernels *k) {
    if (step->any_locks) {
        tl_stage_locks(step);
    }
    k->push(step, 0, step->rows);
}

/* Displacements that take errors back, joints' last, which nothing then moves again; in the last sub-step of a step
 * also those that are hardly any. */
static void push_back(tl_step *step, const tl_kernels *k, int last) {
    tl_header *h = step->h;
    uint32_t contacts = h->groups, joints = h->joint_groups;
    if (step->pushes) {
        step->waits = !last;
        if (contacts) {
            k->push_contacts(step, 0, contacts);
        }
        if (h->presses) {
            k->press_errors(step, 0, h->presses);
        }
        k->push_joints(step, 0, joints);
        run_linkages(step, k, k->read_errors, k->apply_pushes);
        step->waits = 0;
        push_bodies(step, k);
    }
    step->again = 1;
    for (uint32_t i = 1; i < MOST_PUSHES && tl_stage_far_linkages(h); i++) {
        k->turn_joints(step, 0, joints);
        run_linkages(step, k, k->read_errors, k->apply_pushes);
        push_bodies(step, k);
    }
    step->again = 0;
}

static void run_substep(tl_step *step, const tl_kernels *k, uint32_t i, tl_watch *w) {
    tl_header *h = step->h;
    uint32_t contacts = h->groups, joints = h->joint_groups, passes = h->settings.iterations;
    int first = i == 0, last = i + 1u == step->substeps;
    if (first) {
        tl_stage_stiffness(step);
        k->warm_contacts(step, 0, contacts);
        tl_watch_lap(w, TALUS_STAGE_SOLVE);
    }
    step->first_substep = first;
    k->velocity(step, 0, step->rows);
    tl_watch_lap(w, TALUS_STAGE_VELOCITY);
    if (first) {
        k->begin_joints(step, 0, joints);
    }
    if (first && step->bounces) {
        tl_watch_lap(w, TALUS_STAGE_SOLVE);
        step->before_move = 1;
        strike(step, k);
        step->before_move = 0;
        tl_watch_lap(w, TALUS_STAGE_RESTITUTION);
    }
    for (uint32_t pass = 0; pass < passes; pass++) {
        step->skip_exact = pass > 0;
        k->solve_joints(step, 0, joints);
        step->before_move = 1;
        run_linked_velocities(step, k);
        step->before_move = 0;
        k->press_velocities(step, 0, h->presses);
        k->solve_contacts(step, 0, contacts);
    }
    if (step->any_locks) {
        tl_stage_locks(step);
    }
    tl_watch_lap(w, TALUS_STAGE_SOLVE);
    k->position(step, 0, step->rows);
    tl_watch_lap(w, TALUS_STAGE_POSITION);
    tl_stage_stiffness(step);
    k->turn_joints(step, 0, joints);
    push_back(step, k, last);
    if (step->bounces) {
        tl_watch_lap(w, TALUS_STAGE_RELAX);
        strike(step, k);
        tl_watch_lap(w, TALUS_STAGE_RESTITUTION);
    }
    for (uint32_t pass = 0; pass < passes; pass++) {
        step->skip_exact = pass > 0 || !last;
        step->deferred = !first;
        k->relax_joints(step, 0, joints);
        run_linked_velocities(step, k);
        k->press_velocities(step, 0, h->presses);
        k->relax_contacts(step, 0, contacts);
    }
    step->deferred = 0;
    if (step->any_locks) {
        tl_stage_locks(step);
    }
    tl_watch_lap(w, TALUS_STAGE_RELAX);
}

static void solve(tl_step *step, tl_watch *w) {
    tl_header *h = step->h;
    const tl_kernels *k = tl_kernels_of((talus_isa)h->isa);
    tl_stage_body_rows(step);
    tl_stage_contact_groups(step);
    tl_stage_joint_groups(step);
    tl_stage_find_presses(step);
    k->prepare_contacts(step, 0, h->groups);
    k->prepare_joints(step, 0, h->joint_groups);
    k->begin_presses(step, 0, h->presses);
    uint32_t bouncing = 0, rolling = 0, pushed = 0;
    step->pushes = h->joint_groups > 0 || h->presses > 0;
    for (uint32_t i = 0; i < h->groups; i++) {
        bouncing += tl_group_pool(h)[i].bounces != 0;
        rolling |= tl_group_pool(h)[i].rolls;
        pushed += tl_group_pool(h)[i].depth & TL_DEPTH_PUSHED;
    }
    step->pushes |= pushed > 0;
    step->bounces = bouncing > 0;
    h->counters.groups_pushed = pushed;
    h->counters.groups_bouncing = bouncing;
    tl_watch_lap(w, TALUS_STAGE_ROWS);
    if (h->groups || h->joint_groups || step->any_locks) {
        for (uint32_t i = 0; i < step->substeps; i++) {
            run_substep(step, k, i, w);
        }
    } else {
        k->fly(step, 0, step->rows);
        tl_watch_lap(w, TALUS_STAGE_POSITION);
    }
    h->counters.restitution_skipped = !bouncing;
    h->counters.rolling_skipped = !rolling;
    k->store_contacts(step, 0, h->groups);
    k->store_joints(step, 0, h->joint_groups);
    k->commit(step, 0, step->rows);
}

/* The islands of each level of effort by themselves, the lowest level first; without an error budget there is one. */
static void solve_levels(tl_step *step, tl_watch *w) {
    uint32_t levels = tl_efforts_begin(step);
    for (uint32_t level = 0; levels >> level; level++) {
        if (levels >> level & 1u) {
            set_level(step, level);
            tl_efforts_select(step);
            solve(step, w);
            tl_efforts_note(step);
            tl_watch_lap(w, TALUS_STAGE_COMMIT);
            tl_stage_touches(step);
            tl_watch_lap(w, TALUS_STAGE_EVENTS);
        }
    }
    tl_efforts_end(step);
}

talus_status tl_run_world_step(talus_world *world, uint32_t i, talus_command *c) {
    float dt = c->as.step.dt;
    (void)i;
    if (!tl_is_finite(dt)) {
        return TALUS_NOT_FINITE;
    }
    if (!(dt > 0.0f && dt <= 1.0f)) {
        return TALUS_BAD_ARGUMENT;
    }
    tl_watch w;
    tl_step step;
    tl_watch_start(&w, tl_header_of(world), c->as.step.clock, c->as.step.profile);
    begin_step(&step, world, dt);
    tl_header *h = step.h;
    tl_watch_lap(&w, TALUS_STAGE_COMMANDS);
    tl_stage_refit(h, step.geometry, dt);
    tl_watch_lap(&w, TALUS_STAGE_REFIT);
    tl_stage_pairs(h);
    tl_watch_lap(&w, TALUS_STAGE_PAIRS);
    tl_stage_narrow(&step);
    tl_watch_lap(&w, TALUS_STAGE_NARROW);
    solve_levels(&step, &w);
    tl_stage_leave(h, step.geometry);
    tl_watch_lap(&w, TALUS_STAGE_COMMIT);
    tl_watch_islands(&w, &step);
    tl_stage_events(&step);
    tl_watch_lap(&w, TALUS_STAGE_EVENTS);
    tl_stage_sleep(h, dt);
    tl_watch_lap(&w, TALUS_STAGE_SLEEP);
    h->counters.awake_bodies = h->awake_bodies;
    h->counters.sleeping_bodies = h->bodies.used - 1u - h->awake_bodies;
    h->counters.joints_skipped = h->counters.joints_solved == 0;
    if (++h->steps_low == 0) {
        h->steps_high++;
    }
    tl_watch_stop(&w, world, c->as.step.profile);
    return TALUS_OK;
}
