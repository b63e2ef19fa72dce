/* The laned kernels of the stages and the choice among instruction sets. Every kernel works on a range [first, last)
 * and gives the same bits however the range is cut. */
#ifndef TL_KERNELS_H
#define TL_KERNELS_H

#include "stage/narrow/batch.h"
#include "stage/store/store.h"

#define TL_EFFORT_SUMS 14u

/* What the stages of one step share. Holds pointers and so lives on the stack only. */
typedef struct tl_step {
    tl_header *h;
    const void *geometry;
    uint32_t substeps; /* of the islands in work */
    float dt, sub;     /* s: of the step, of a sub-step */
    float inverse_sub; /* 1/s */
    float sub_before;  /* s: of the sub-step that the stored impulses are of; 0: there are none */
    float warm_scale;  /* this sub-step over that one */
    float bias_rate, mass_scale, impulse_scale; /* of soft contacts */
    float spring;    /* N s a sub-step, m and kg of effective mass: of soft contacts at rest */
    uint32_t rows;   /* body rows in use, the still one included, rounded up to eight */
    uint32_t level;  /* of the islands in work: two to it times as many sub-steps as the settings have */
    uint32_t awake;  /* bodies, of which those of one level may be in work */
    int parted;      /* islands are of several levels, and solved level by level */
    int has_islands; /* island_parent is of this step */
    uint32_t sums[TL_EFFORT_SUMS], most_rows; /* counters over levels */
    int bounced, rolled;
    int any_locks;
    int planar;  /* some contacts have a plane */
    int pushes;  /* something is deep enough, or tied by joints, to be pushed */
    int bounces; /* something has restitution */
    int first_substep;
    int stiff;       /* some body's moment of inertia counts as larger than it is */
    int again;       /* only what was far from its place is looked at */
    int waits;       /* errors of what is exact may be left to a later sub-step of the step */
    int before_move; /* impulses are those before the bodies move */
    int skip_exact;  /* what is exact has been solved in this sub-step or will be in the next */
    int deferred;    /* of what is exact: this sub-step's impulses hold those of the last one's pass after its move */
} tl_step;

typedef void (*tl_kernel)(const tl_step *step, uint32_t first, uint32_t last);

typedef struct tl_kernels {
    void (*place_pairs)(const tl_step *step, tl_pair_batch *batch); /* a, b, b_in_a and margin */
    void (*collide_balls)(const tl_step *step, const tl_pair_batch *batch, tl_one_points *out);
    void (*collide_capsules)(const tl_step *step, const tl_pair_batch *batch, tl_one_points *out);
    void (*collide_boxes)(const tl_step *step, const tl_pair_batch *batch, tl_box_manifolds *out);
    tl_kernel fill_bodies, velocity, position, fly, push, commit; /* ranges of eight body rows */
    tl_kernel prepare_contacts, warm_contacts, solve_contacts, relax_contacts, push_contacts, strike_contacts,
        store_contacts; /* groups */
    tl_kernel prepare_joints, begin_joints, turn_joints, solve_joints, relax_joints, push_joints,
        store_joints;                                                     /* joint groups */
    tl_kernel read_velocities, read_errors, apply_impulses, apply_pushes; /* linked joint groups */
    tl_kernel solve_linkages;                                             /* linkages */
    tl_kernel begin_presses;                  /* presses: their rows, from the prepared groups; */
    tl_kernel press_velocities, press_errors; /* what keeps contacts from closing and sliding; what parts them */
} tl_kernels;

/* Solves for the x of one linkage's joints in single floats. */
void tl_linkage_solve_one(const tl_header *h, tl_linkage *l);
/* Factors and solves, in single floats, what is left of the joints at the cuts of a linkage. */
void tl_cuts_factor(const tl_header *h, const tl_linkage *l);
void tl_cuts_solve(const tl_header *h, const tl_linkage *l);

extern const tl_kernels tl_kernels_scalar;
#if defined(__SSE2__)
extern const tl_kernels tl_kernels_sse2;
#endif
#if defined(__x86_64__)
extern const tl_kernels tl_kernels_avx2;
#endif
#if defined(__aarch64__)
extern const tl_kernels tl_kernels_neon;
#endif
#if defined(__wasm_simd128__)
extern const tl_kernels tl_kernels_wasm;
#endif

talus_isa tl_best_isa(void);
/* The kernels of an instruction set that is available. */
const tl_kernels *tl_kernels_of(talus_isa isa);

#endif
