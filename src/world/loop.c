/* The fixed-timestep driver: an accumulator with a cap against the spiral of death (Fiedler, "Fix your timestep!",
 * 2004). */
#include "talus/loop.h"

#include "base/vec.h"

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
