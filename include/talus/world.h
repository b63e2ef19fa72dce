/* The world: one block of the caller's memory that bodies, shapes, joints and contacts live in. */
#ifndef TALUS_WORLD_H
#define TALUS_WORLD_H

#include "talus/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TALUS_BLOCK_ALIGNMENT 64u

/* Instruction sets. The bits of a run do not depend on which one is used. */
typedef enum talus_isa {
    TALUS_ISA_BEST, /* the widest that this build and this processor have */
    TALUS_ISA_SCALAR,
    TALUS_ISA_SSE2,
    TALUS_ISA_AVX2,
    TALUS_ISA_NEON,
    TALUS_ISA_WASM,
    TALUS_ISA_COUNT
} talus_isa;

/* Whether this build and this processor have an instruction set, and its name ("best" for TALUS_ISA_BEST). */
int talus_isa_available(talus_isa isa);
const char *talus_isa_name(talus_isa isa);

typedef struct talus_log talus_log; /* command.h */

/* A world as the caller holds it: the block, and the region of cooked hulls that its shapes refer to by offset. Neither
 * holds a pointer, so both may be copied; a copy of the block is the same world again. */
typedef struct talus_world {
    void *block;
    const void *geometry;  /* TALUS_BLOB_ALIGNMENT aligned; may be null without hulls; is never written */
    size_t geometry_bytes; /* may grow, must not shrink while shapes refer to it */
    talus_log *log;        /* what is done to the world is added to it; null: none is kept */
} talus_world;

typedef struct talus_world_def {
    /* capacities */
    uint32_t body_capacity;
    uint32_t shape_capacity;
    uint32_t joint_capacity;
    uint32_t contact_capacity; /* pairs of shapes that touch; three times as many more may be near */
    uint32_t event_capacity;   /* of each kind of event, a step */
    uint32_t profile_capacity; /* frames that the profiler keeps, talus/profile.h; 0, the default: none */
    /* simulation */
    talus_vec3 gravity;          /* m/s^2 */
    uint32_t substeps;           /* 1..TALUS_MAX_SUBSTEPS */
    uint32_t iterations;         /* solver passes a sub-step, 1..TALUS_MAX_ITERATIONS */
    float error_budget;          /* m, 0..1; 0: none; see talus_accuracy */
    uint32_t most_substeps;      /* 1..TALUS_MAX_SUBSTEPS */
    float contact_hertz;         /* stiffness of contacts in overlap, Hz; bounded by what the sub-steps can follow */
    float contact_damping_ratio; /* 1 is critical */
    float push_speed;            /* m/s, the fastest that overlap is pushed out */
    float speculative_margin;    /* m, contacts are prepared this far ahead, and as far as bodies fly in a step */
    float recycle_slack;         /* m, a pair that moved less keeps its manifold; 0: none is kept */
    float restitution_speed;     /* m/s, slower impacts do not bounce */
    float hit_speed;             /* m/s, slower impacts make no hit event */
    float sleep_speed;           /* m/s, slower bodies may fall asleep */
    float sleep_time;            /* s */
    uint8_t enable_sleep;
    talus_isa isa;
} talus_world_def;

#define TALUS_MAX_SUBSTEPS 64u
#define TALUS_MAX_ITERATIONS 64u
#define TALUS_MAX_CAPACITY (1u << 22)

/* Room for 1024 bodies, 4 sub-steps, gravity (0, -9.81, 0), sleep on. */
talus_world_def talus_world_def_default(void);

/* Bytes of the block that talus_world_init needs; 0 if the definition is out of range. */
size_t talus_world_size(const talus_world_def *def);

/* Makes an empty world in `block` (TALUS_BLOCK_ALIGNMENT aligned) and fills in *world with no geometry and no log.
 * TALUS_BAD_ARGUMENT, TALUS_NOT_FINITE, TALUS_SMALL_BLOCK, TALUS_UNALIGNED, TALUS_NO_ISA. */
talus_status talus_world_init(talus_world *world, const talus_world_def *def, void *block, size_t bytes);

/* Changes the instruction set in use; the results stay the same to the bit. */
talus_status talus_world_set_isa(talus_world *world, talus_isa isa);
talus_isa talus_world_get_isa(const talus_world *world);

talus_status talus_world_set_gravity(talus_world *world, talus_vec3 gravity);
talus_status talus_world_get_def(const talus_world *world, talus_world_def *out);

/* How exact steps are, and how much they may do for it.
 *
 * With an error budget each island (bodies that touch or are tied, moving kinematic ones included) gets sub-steps of
 * its own: `substeps` to begin with, twice as many or 4, 8, ... times while a surface in it overlaps another, or a
 * joint's ends are apart, by more than the budget; half as many again when it has been well below for a second. A joint
 * that is turned off a locked axis counts by how far that shifts what it holds. Contacts are as many times stiffer as
 * there are more sub-steps. No island gets more than `most_substeps`, and none less than `substeps`. What errors no
 * sub-steps take away, as of what is pressed between moving walls, stay at that.
 *
 * The counters tell what the last step found and gave. It costs nothing while there is no budget; with one, a
 * hundredth of a step's time where all islands are below it, and a pass over the awake bodies, contacts and joints
 * where some are not. What an island gets is part of the state, so replays and rollbacks are the same to the bit. */
typedef struct talus_accuracy {
    float error_budget;     /* m, 0..1; 0: none, every island gets `substeps` */
    uint32_t substeps;      /* 1..TALUS_MAX_SUBSTEPS */
    uint32_t most_substeps; /* 1..TALUS_MAX_SUBSTEPS; where it is less than `substeps` those are the most */
} talus_accuracy;

/* From the next step on. TALUS_NOT_FINITE, TALUS_BAD_ARGUMENT. */
talus_status talus_world_set_accuracy(talus_world *world, const talus_accuracy *accuracy);

/* The stages, in the order of a step. */
typedef enum talus_stage {
    TALUS_STAGE_COMMANDS,
    TALUS_STAGE_REFIT,
    TALUS_STAGE_PAIRS,
    TALUS_STAGE_NARROW,
    TALUS_STAGE_ISLANDS,
    TALUS_STAGE_ROWS,
    TALUS_STAGE_VELOCITY,
    TALUS_STAGE_SOLVE,
    TALUS_STAGE_POSITION,
    TALUS_STAGE_RELAX,
    TALUS_STAGE_RESTITUTION,
    TALUS_STAGE_CCD,
    TALUS_STAGE_COMMIT,
    TALUS_STAGE_SLEEP,
    TALUS_STAGE_EVENTS,
    TALUS_STAGE_COUNT
} talus_stage;

const char *talus_stage_name(talus_stage stage);

/* A clock of the caller's: any monotonic count, its unit is the caller's. The core has none. */
typedef struct talus_clock {
    uint64_t (*now)(void *context);
    void *context;
} talus_clock;

/* Ticks of the caller's clock that each stage took in one step. */
typedef struct talus_profile {
    uint64_t stage[TALUS_STAGE_COUNT];
    uint64_t total;
} talus_profile;

/* One step of dt seconds (0 < dt <= 1). `clock` may be null: then no time is taken. `profile` may be null: the times
 * then go to the ring of talus/profile.h alone, if the world has one. TALUS_BAD_ARGUMENT, TALUS_NOT_FINITE. What did
 * not fit a capacity is dropped, counted and reported in the counters.
 */
talus_status talus_world_step(talus_world *world, float dt, const talus_clock *clock, talus_profile *profile);

typedef struct talus_usage {
    uint32_t used, high_water, capacity;
    uint32_t dropped; /* in the last step */
} talus_usage;

/* What the last step did, and what it could skip. */
typedef struct talus_counters {
    uint64_t steps;
    talus_usage bodies, shapes, joints, contacts, rows, events;
    uint32_t awake_bodies;    /* dynamic or moving kinematic */
    uint32_t sleeping_bodies; /* skipped whole */
    uint32_t proxies_refit;   /* boxes that had left their fat boxes */
    uint32_t pairs_made, pairs_ended;
    uint32_t manifolds_made;    /* computed in the last step */
    uint32_t manifolds_first;   /* of them, without features to start from: the pair is new */
    uint32_t manifolds_kept;    /* kept, for the pair had not moved enough */
    uint32_t contacts_sleeping; /* not looked at */
    uint32_t contacts_touching; /* with rows in the solver */
    uint32_t contact_points;
    uint32_t touches_begun, touches_ended;
    uint32_t joints_solved, joints_sleeping;
    uint32_t linkages; /* sets of joints that are solved at once, eight alike as one; what is short and slow is not */
    uint32_t joints_apart;     /* solved one by one, for the set they are in was too large or too much tied to itself */
    uint32_t contacts_pressed; /* between bodies much lighter than what they bear: solved at once */
    uint32_t contacts_left;    /* such ones for which there was no room there */
    uint32_t bodies_planar;    /* awake and locked to a plane: three degrees of freedom are left to them, */
    uint32_t contacts_planar;  /* and contacts in which these are solved, as nothing in them goes across the plane */
    uint32_t islands, islands_slept, islands_woken;
    uint32_t bodies_slept, bodies_woken; /* with those islands */
    uint32_t sleep_searched;             /* 1: bodies were slow for long enough to look for islands that may sleep */
    uint32_t colors;
    uint32_t lane_groups;         /* groups of eight in the solver */
    uint32_t lanes_used;          /* lanes that held a constraint */
    uint32_t groups_pushed;       /* that hold a point deep enough to be pushed out */
    uint32_t groups_bouncing;     /* that hold a contact with restitution */
    uint32_t impact_sweeps;       /* over them, in all sub-steps, for impacts that run from body to body */
    uint32_t groups_struck;       /* that met anew in these sweeps, counted in each */
    uint32_t restitution_skipped; /* 1: nothing bounced, the stage did not run */
    uint32_t joints_skipped;
    uint32_t rolling_skipped;
    uint32_t substeps_least, substeps_most; /* that an island got */
    uint32_t substeps_given;                /* summed over the awake bodies */
    uint32_t islands_over;                  /* that were over the error budget */
    float worst_error;                      /* m: the largest as the error budget counts it; 0 without one */
} talus_counters;

talus_status talus_world_get_counters(const talus_world *world, talus_counters *out);

/* The largest errors that the state holds now: what the last step achieved. O(contacts + joints), when it is asked. */
typedef struct talus_errors {
    float overlap;       /* m: of touching surfaces */
    float joint_linear;  /* m: of locked axes */
    float joint_angular; /* rad: of locked axes */
    float contact_speed; /* m/s: at which surfaces that overlap close */
    float joint_speed;   /* m/s: along locked linear axes */
} talus_errors;

talus_status talus_world_measure(const talus_world *world, talus_errors *out);

/* A 64-bit hash of the state: equal worlds have equal hashes on every machine. One pass over the live columns. */
uint64_t talus_world_hash(const talus_world *world);

/* Whether every index, link, count and number of the block is sound: TALUS_OK or TALUS_BAD_BLOB. O(size). */
talus_status talus_world_validate(const talus_world *world);

/* The body that static geometry without a body of its own may be put on, made at init at the origin. */
talus_body talus_world_ground(const talus_world *world);

#ifdef __cplusplus
}
#endif

#endif
