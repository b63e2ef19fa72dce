/* Eight pairs of shapes as the kernels of the narrow stage take them, and what they give back. */
#ifndef TL_BATCH_H
#define TL_BATCH_H

#include "stage/store/store.h"

typedef enum tl_batch_kind {
    TL_BATCH_BALLS,
    TL_BATCH_BALL_BOX, /* a is the ball */
    TL_BATCH_BOX_BALL,
    TL_BATCH_CAPSULES, /* of one radius each, or one a ball */
    TL_BATCH_BOXES,
    TL_BATCH_OTHER, /* whose shapes are placed only */
    TL_BATCH_KINDS
} tl_batch_kind;

/* Lanes that are not in use repeat one that is. */
typedef struct tl_pair_batch {
    tl_batch_kind kind;
    int touch;               /* they are contacts, else pairs that have none */
    uint32_t count;          /* lanes in use */
    uint32_t item[TL_LANES]; /* contacts or pairs */
    uint32_t body_a[TL_LANES], body_b[TL_LANES], shape_a[TL_LANES], shape_b[TL_LANES];
    uint32_t senses, fixed_a,
        fixed_b; /* a bit a lane: a sensor is among the shapes; the body has no frame to turn with */
    tl_row8 a[TL_LANES], b[TL_LANES], b_in_a[TL_LANES]; /* poses, by place_pairs */
    float margin[TL_LANES];                             /* m */
} tl_pair_batch;

/* Manifolds of one point each: gap (m) is its separation, or how far apart the shapes are beyond the margin (m). Lanes
 * that are not decided take the query of a single pair. */
typedef struct tl_one_points {
    tl_row8 point[TL_LANES];  /* on a and on b, in the frames of the bodies */
    tl_row8 normal[TL_LANES]; /* in the frame of body a */
    float gap[TL_LANES], margin[TL_LANES];
    uint32_t decided; /* a bit a lane */
} tl_one_points;

/* Manifolds of two boxes. Points and normals are set of contacts only: the points as they keep them, with the impulses
 * that they have for their numbers. Lanes that are not decided take the query of a single pair. */
typedef struct tl_box_manifolds {
    tl_row8 point[TL_MANIFOLD_POINTS][TL_LANES];
    tl_row8 normal[TL_LANES]; /* in the frame of body a */
    float gap[TL_LANES];      /* m: without points, how far apart the shapes are */
    float count[TL_LANES];
    uint32_t decided; /* a bit a lane */
} tl_box_manifolds;

tl_batch_kind tl_batch_kind_of(const tl_header *h, uint32_t shape_a, uint32_t shape_b);

/* One empty batch of each kind, of contacts or of pairs that have none. */
void tl_batches_begin(tl_pair_batch *batches, int touch);

/* Takes the next lane; returns whether it was the last one. */
int tl_batch_add(const tl_header *h, tl_pair_batch *batch, uint32_t item, uint32_t shape_a, uint32_t shape_b);

/* Sets the lanes that are not in use; the batch is not empty. */
void tl_batch_fill(tl_pair_batch *batch);

/* Empties it. */
void tl_batch_clear(tl_pair_batch *batch);

#endif
