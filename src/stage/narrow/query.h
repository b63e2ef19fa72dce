/* A pair of shapes as the pair queries take it, and what tells without a query that it is apart. */
#ifndef TL_NARROW_QUERY_H
#define TL_NARROW_QUERY_H

#include "stage/stages.h"

typedef struct tl_query {
    uint32_t shape_a, shape_b, body_a, body_b;
    tl_convex a, b;
    talus_pose pa, pb, b_in_a;
    float margin; /* m */
} tl_query;

tl_query tl_query_of(const tl_step *step, uint32_t shape_a, uint32_t shape_b);

/* Whether the balls around two bodies' mass centres tell already that they do not touch, being *gap (m) apart. */
int tl_parted_by_balls(const tl_step *step, uint32_t body_a, uint32_t body_b, float *gap);

/* m: what rounding may make of a distance between two shapes, many times over. */
float tl_doubt_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float margin);

/* tl_pair.clear of shapes that are at least `gap` (m) apart. */
uint32_t tl_clear_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float gap);

/* contacts.c: manifolds of the contacts that are due, of one, and of one just made. */
void tl_contacts_update(tl_step *step);
void tl_contact_update(tl_step *step, uint32_t contact);
void tl_contact_make_manifold(tl_step *step, uint32_t contact);

#endif
