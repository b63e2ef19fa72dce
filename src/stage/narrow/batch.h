/* Eight pairs of shapes as the kernels of the narrow stage take them, and what they give back. */
#ifndef TL_BATCH_H
#define TL_BATCH_H

#include "stage/store/store.h"

typedef enum tl_batch_kind {
    TL_BATCH_BALLS,
    TL_BATCH_BALL_BOX, /* a is the ball */
    TL_BATCH_BOX_BALL,
    TL_BATCH_OTHER, /* whose shapes are placed only */
    TL_BATCH_KINDS
} tl_batch_kind;

/* Lanes that are not in use repeat one that is. */
typedef struct tl_pair_batch {
    tl_batch_kind kind;
    uint32_t count; /* lanes in use */
    uint32_t contact[TL_LANES];
    uint32_t body_a[TL_LANES], body_b[TL_LANES], shape_a[TL_LANES], shape_b[TL_LANES];
    uint32_t senses, fixed_a,
        fixed_b; /* a bit a lane: a sensor is among the shapes; the body has no frame to turn with */
    tl_row8 a[TL_LANES], b[TL_LANES], b_in_a[TL_LANES]; /* poses, by place_pairs */
    float margin[TL_LANES];                             /* m */
} tl_pair_batch;

/* Manifolds of one point each: gap (m) is its separation, or how far apart the shapes are beyond the margin (m). */
typedef struct tl_one_points {
    tl_row8 point[TL_LANES];  /* on a and on b, in the frames of the bodies */
    tl_row8 normal[TL_LANES]; /* in the frame of body a */
    float gap[TL_LANES], margin[TL_LANES];
} tl_one_points;

#endif
