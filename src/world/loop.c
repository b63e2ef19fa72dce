/* The fixed-timestep driver: an accumulator with a cap against the spiral of death (Fiedler, "Fix your timestep!",
 * 2004); and what keeps steps to a time. */
#include "talus/loop.h"

#include "base/vec.h"
#include "world/world_internal.h"

talus_status talus_loop_init(talus_loop *loop, float dt, uint32_t max_steps) {
    if (!loop || !(dt > 0.0f && dt <= 1.0f) || max_steps == 0) {
        return TALUS_BAD_ARGUMENT;
    }
    loop->dt = dt;
    loop->max_steps = max_steps;
    loop->accumulator = loop->dropped = 0.0;
    loop->alpha = 0.0f;
    return TALUS_OK;
}

talus_status talus_loop_advance(talus_loop *loop, double elapsed, uint32_t *steps) {
    if (!loop || !steps) {
        return TALUS_BAD_ARGUMENT;
    }
    if (elapsed - elapsed != 0.0) {
        return TALUS_NOT_FINITE;
    }
    if (elapsed < 0.0) {
        return TALUS_BAD_ARGUMENT;
    }
    double dt = (double)loop->dt, time = loop->accumulator + elapsed, most = dt * (double)loop->max_steps;
    uint32_t due = 0;
    if (time >= most + dt) { /* too late by whole steps: give up all but the fraction that shows */
        double whole = (time - most) / dt;
        if (whole < 9e15) {
            whole = (double)(uint64_t)whole * dt;
            loop->dropped += whole;
            time -= whole;
        } else { /* no fraction is left of so long a time */
            loop->dropped += time - most;
            time = most;
        }
    }
    while (time >= dt && due < loop->max_steps) {
        time -= dt;
        due++;
    }
    loop->accumulator = time < 0.0 ? 0.0 : time >= dt ? 0.0 : time;
    loop->alpha = tl_clamp((float)(loop->accumulator / dt), 0.0f, 1.0f);
    *steps = due;
    return TALUS_OK;
}

/* --- time ------------------------------------------------------------------------------------- */

#define QUICK_STEPS 30u
#define QUICK_SHARE 0.5 /* of the time: what twice the sub-steps take is then still within it */

talus_status talus_time_budget_init(talus_time_budget *budget, double seconds, const talus_accuracy *wanted) {
    if (!budget || !wanted) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = seconds - seconds != 0.0 ? TALUS_NOT_FINITE : tl_check_accuracy(wanted);
    if (status != TALUS_OK) {
        return status;
    }
    if (!(seconds > 0.0 && wanted->error_budget > 0.0f && wanted->substeps <= wanted->most_substeps)) {
        return TALUS_BAD_ARGUMENT;
    }
    budget->seconds = seconds;
    budget->wanted = *wanted;
    budget->most_substeps = wanted->substeps;
    budget->quick = 0;
    return TALUS_OK;
}

talus_status talus_time_budget_advance(talus_time_budget *budget, double took, talus_accuracy *next) {
    if (!budget || !next) {
        return TALUS_BAD_ARGUMENT;
    }
    if (took - took != 0.0) {
        return TALUS_NOT_FINITE;
    }
    if (took < 0.0) {
        return TALUS_BAD_ARGUMENT;
    }
    uint32_t n = budget->most_substeps;
    budget->quick = took < QUICK_SHARE * budget->seconds ? budget->quick + 1u : 0u;
    if (took > budget->seconds) {
        n = n / 2u > budget->wanted.substeps ? n / 2u : budget->wanted.substeps;
    } else if (budget->quick >= QUICK_STEPS) {
        n = 2u * n < budget->wanted.most_substeps ? 2u * n : budget->wanted.most_substeps;
        budget->quick = 0;
    }
    budget->most_substeps = n;
    *next = budget->wanted;
    next->most_substeps = n;
    return TALUS_OK;
}
