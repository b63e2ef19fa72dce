/* A question to a world, and what boxes and shapes answer it. The trees are an index that may differ between two worlds
 * of one state, so what they leave out must not show. It does not: a box's bound never lessens as the box shrinks, to
 * the last bit, and a shape answers no earlier than the bound of its own box at its present pose, which all boxes above
 * it in whatever tree hold. Metres. */
#ifndef TL_QUERY_PROBE_H
#define TL_QUERY_PROBE_H

#include "collide/advance.h"
#include "talus/world_query.h"
#include "world/world_internal.h"

typedef enum tl_question {
    TL_ASK_RAY,
    TL_ASK_CAST,
    TL_ASK_CLOSEST,
    TL_ASK_OVERLAP,
    TL_ASK_BOXES, /* whose boxes overlap */
    TL_ASK_POINT  /* who holds it */
} tl_question;

typedef struct tl_probe {
    const talus_world *world;
    tl_question question;
    talus_query_filter filter;
    tl_d3 from, way, inverse; /* rays and casts: of the ray, of the centre of what is cast */
    talus_aabb box;           /* rays and casts: around that point; else around what is asked about */
    double reach;             /* of the way; or a distance */
    tl_convex shape;          /* cast, closest, overlap */
    tl_polytope core;         /* closest, overlap */
    tl_frame frame;
    tl_moving moving; /* cast */
    float tolerance;
} tl_probe;

/* Each takes the arguments of its query as they came, and answers TALUS_OK or what the query does. A null filter is the
 * default one. *p points into itself and to the shape: neither to be copied nor moved. */
talus_status tl_probe_ray(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                          const talus_ray *ray);
talus_status tl_probe_cast(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                           const talus_convex *shape, const talus_motion *motion, float tolerance);
/* TL_ASK_CLOSEST; TL_ASK_OVERLAP with reach 0. */
talus_status tl_probe_shape(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                            tl_question question, const talus_convex *shape, const talus_pose *pose, float reach);
/* TL_ASK_CLOSEST; TL_ASK_POINT with reach 0. */
talus_status tl_probe_point(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                            tl_question question, talus_vec3 point, float reach);
talus_status tl_probe_box(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                          const talus_aabb *box);

#define TL_OUT_OF_REACH 1e300

/* No shape within the box answers with a lesser `at`; TL_OUT_OF_REACH: none answers. */
double tl_probe_bound(const tl_probe *p, const talus_aabb *box);
/* Whether the filter lets the query see a shape. */
int tl_probe_sees(const tl_probe *p, uint32_t shape);
/* Whether a shape answers, and how. Answers with an `at` beyond `last` may be left out. */
int tl_probe_ask(const tl_probe *p, uint32_t shape, double last, talus_query_hit *out);

/* Asks all shapes: the one of the least `at`, or all zero; all of them; whether there is one. */
void tl_query_first(const tl_probe *p, talus_query_hit *out);
void tl_query_all(const tl_probe *p, talus_hits *out);
int tl_query_any(const tl_probe *p);
/* Asks one shape. */
talus_status tl_query_one(const tl_probe *p, talus_shape shape, talus_query_hit *out);

#endif
