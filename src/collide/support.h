/* Convex cores: a shape as a sharp core swollen by a radius, placed in the frame of a query, and its support points.
 * A core may be a point, a segment, a point and a ball, a cut cone, a box or a hull. Lengths in metres. */
#ifndef TL_SUPPORT_H
#define TL_SUPPORT_H

#include "base/vec.h"
#include "collide/collide.h"

typedef enum tl_core_kind {
    TL_CORE_POINT,
    TL_CORE_SEGMENT, /* along y, both ends alike */
    TL_CORE_DROP,    /* the hull of two balls, one of them of radius 0 */
    TL_CORE_FRUSTUM, /* cylinder or cut cone along y */
    TL_CORE_BOX,
    TL_CORE_HULL
} tl_core_kind;

typedef struct tl_core {
    tl_core_kind kind;
    int placed;             /* 0: the core stands at the identity, r and t are not read */
    float half_height;      /* of the core's axis */
    float top, bottom;      /* radii of the core at its ends */
    float radius;           /* by which the core is swollen */
    float size;             /* no point of the swollen core is further than this from the shape's origin */
    talus_vec3 half;        /* box */
    const talus_hull *hull; /* hull */
    talus_mat3 r;           /* core to query frame */
    talus_vec3 t;
} tl_core;

/* A null pose places the core at the identity. */
void tl_core_init(tl_core *core, const tl_convex *shape, const talus_pose *pose);

/* The point of the core that is furthest along `direction` (query frame, any length but not 0), in the query frame. The
 * index names the vertex of a segment, box or hull; on entry it is where the search on a large hull starts, 0 if that
 * is not known. */
talus_vec3 tl_core_support(const tl_core *core, talus_vec3 direction, uint32_t *index);

/* The same in the core's own frame. */
talus_vec3 tl_core_support_local(const tl_core *core, talus_vec3 direction, uint32_t *index);

/* Vertices by the numbers that support points have; a core of round parts has none to tell apart. */
uint32_t tl_core_vertex_count(const tl_core *core);
talus_vec3 tl_core_vertex(const tl_core *core, uint32_t index);

/* The vertex of a hull furthest along a direction of its own frame, from `start` on; 0: from where the hull's table of
 * directions says. */
uint32_t tl_hull_support(const talus_hull *hull, talus_vec3 direction, uint32_t start);

static inline talus_vec3 tl_core_rotate(const tl_core *core, talus_vec3 v) {
    return core->placed ? tl_mat3_mul(&core->r, v) : v;
}
static inline talus_vec3 tl_core_rotate_back(const tl_core *core, talus_vec3 v) {
    return core->placed ? tl_mat3_mul_t(&core->r, v) : v;
}
static inline talus_vec3 tl_core_place(const tl_core *core, talus_vec3 p) {
    return core->placed ? tl_add(tl_mat3_mul(&core->r, p), core->t) : p;
}

/* A box's corner by number: bit 0 set is +x, bit 1 +y, bit 2 +z. */
static inline talus_vec3 tl_box_corner(talus_vec3 half, uint32_t i) {
    return tl_v((i & 1u) ? half.x : -half.x, (i & 2u) ? half.y : -half.y, (i & 4u) ? half.z : -half.z);
}

#endif
