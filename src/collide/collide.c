/* The table of pairs: which algorithm answers which two types. Pairs are worked out with the higher type as A and
 * mirrored where they came the other way round. Metres. */
#include "collide/general.h"
#include "collide/polyhedra.h"
#include "collide/round.h"

#include <stddef.h>
#include <string.h>

/* Two shapes too far apart for their form to count. */
static void collide_far(talus_vec3 t, float margin, tl_manifold *out) {
    float distance = tl_far_distance(t, &out->normal);
    out->count = 0;
    out->gap = distance;
    if (distance <= margin) {
        out->count = 1;
        out->point[0].position = tl_scale(t, 0.5f);
        out->point[0].separation = distance;
        out->point[0].id = 0;
    }
}

static int is_even_capsule(const talus_geometry *g) {
    return g->type == TALUS_CAPSULE && g->radius_top == g->radius_bottom;
}

int tl_are_capsules(const talus_geometry *a, const talus_geometry *b) {
    int capsule_a = is_even_capsule(a), capsule_b = is_even_capsule(b);
    return (capsule_a && (capsule_b || b->type == TALUS_SPHERE)) || (capsule_b && a->type == TALUS_SPHERE);
}

static void collide_ordered(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                            tl_pair_cache *cache, tl_manifold *out) {
    tl_core ca, cb;
    if (b->geometry.type == TALUS_SPHERE) {
        tl_collide_ball(a, b, b_in_a, margin, cache, out);
        return;
    }
    tl_core_init(&ca, a, NULL);
    tl_core_init(&cb, b, b_in_a);
    if (a->geometry.type == TALUS_BOX && b->geometry.type == TALUS_BOX) {
        tl_collide_boxes(&ca, &cb, margin, cache, out);
        return;
    }
    if (a->geometry.type >= TALUS_BOX) {
        if (b->geometry.type >= TALUS_BOX && tl_collide_polyhedra(&ca, &cb, margin, cache, out)) {
            return;
        }
        if (cb.kind == TL_CORE_SEGMENT && tl_collide_capsule_polyhedron(&ca, &cb, margin, cache, out)) {
            return;
        }
    }
    tl_collide_general(&ca, &cb, margin, cache, out);
}

void tl_collide(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin, tl_pair_cache *cache,
                tl_manifold *out) {
    memset(out, 0, offsetof(tl_manifold, other));
    if (tl_is_far(b_in_a->position)) {
        collide_far(b_in_a->position, margin, out);
        return;
    }
    if (tl_are_capsules(&a->geometry, &b->geometry)) {
        tl_collide_capsules(a, b, b_in_a, margin, out);
        return;
    }
    if (a->geometry.type >= b->geometry.type) {
        collide_ordered(a, b, b_in_a, margin, cache, out);
        return;
    }
    talus_pose a_in_b = {tl_neg(tl_rotate_back(b_in_a->rotation, b_in_a->position)),
                         tl_quat_conjugate(b_in_a->rotation)};
    collide_ordered(b, a, &a_in_b, margin, cache, out);
    out->normal = tl_neg(tl_rotate(b_in_a->rotation, out->normal));
    for (uint32_t i = 0; i < out->count; ++i) {
        out->point[i].position = tl_pose_point(b_in_a, out->point[i].position);
    }
}
