/* The stopwatch of a step, on the caller's clock, and the frame of the ring that it fills in. Without clock and ring it
 * does nothing; with TALUS_NO_PROFILE it is nothing. */
#ifndef TL_WATCH_H
#define TL_WATCH_H

#include "stage/kernels.h"
#include "talus/profile.h"

#ifndef TALUS_NO_PROFILE

typedef struct tl_watch {
    const talus_clock *clock; /* null: no time is taken */
    talus_frame *frame;       /* null: there is no ring */
    uint64_t last;
    talus_profile time;
} tl_watch;

/* The oldest place of the ring, which this step's frame takes; null if there is no ring. */
talus_frame *tl_profile_next(tl_header *h);
/* Tallies the islands of the rows that were solved into the frame, with their shares of the times so far. */
void tl_profile_islands(const tl_step *step, const talus_profile *time, talus_frame *frame);
/* The frame is done: the newest of the ring from now on. */
void tl_profile_keep(talus_world *world, const talus_profile *time, talus_frame *frame);

static inline void tl_watch_start(tl_watch *w, tl_header *h, const talus_clock *clock, const talus_profile *profile) {
    static const talus_profile nothing;
    w->frame = tl_profile_next(h);
    w->clock = clock && clock->now && (profile || w->frame) ? clock : NULL;
    w->last = w->clock ? clock->now(clock->context) : 0;
    w->time = nothing;
}

static inline void tl_watch_lap(tl_watch *w, talus_stage stage) {
    if (w->clock) {
        uint64_t now = w->clock->now(w->clock->context);
        w->time.stage[stage] += now - w->last;
        w->time.total += now - w->last;
        w->last = now;
    }
}

/* Between two laps, so that no stage is charged with it. */
static inline void tl_watch_islands(tl_watch *w, const tl_step *step) {
    if (w->frame) {
        tl_profile_islands(step, &w->time, w->frame);
        uint64_t now = w->clock ? w->clock->now(w->clock->context) : 0;
        w->frame->profiler = now - w->last;
        w->last = now;
    }
}

static inline void tl_watch_stop(tl_watch *w, talus_world *world, talus_profile *profile) {
    if (profile) {
        *profile = w->time;
    }
    if (w->frame) {
        tl_profile_keep(world, &w->time, w->frame);
    }
}

#else

typedef struct tl_watch {
    char nothing;
} tl_watch;

static inline void tl_watch_start(tl_watch *w, tl_header *h, const talus_clock *clock, const talus_profile *profile) {
    (void)w, (void)h, (void)clock, (void)profile;
}
static inline void tl_watch_lap(tl_watch *w, talus_stage stage) { (void)w, (void)stage; }
static inline void tl_watch_islands(tl_watch *w, const tl_step *step) { (void)w, (void)step; }
static inline void tl_watch_stop(tl_watch *w, talus_world *world, talus_profile *profile) {
    (void)w, (void)world;
    if (profile) {
        static const talus_profile nothing;
        *profile = nothing;
    }
}

#endif

#endif
