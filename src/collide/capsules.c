/* Two capsules: the nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9). Side by side they
 * meet in two points. Metres. */
#include "collide/round.h"

/* The squared sine of 2 degrees: segments closer to parallel meet in two points. */
#define PARALLEL_SIN2 0.0012f

void tl_segment_segment(talus_vec3 ca, talus_vec3 ua, talus_vec3 cb, talus_vec3 ub, talus_vec3 *pa, talus_vec3 *pb) {
    /* centres and half axes: parameters run from -1 to 1 */
    talus_vec3 d = tl_sub(cb, ca);
    float aa = tl_dot(ua, ua), bb = tl_dot(ub, ub), ab = tl_dot(ua, ub), da = tl_dot(d, ua), db = tl_dot(d, ub);
    float s = 0.0f, t = 0.0f;
    talus_vec3 x = tl_cross(ua, ub);
    float det = tl_length2(x);
    if (det > 1e-7f * aa * bb) {
        s = tl_clamp(tl_dot(tl_cross(d, ub), x) / det, -1.0f, 1.0f);
    } else if (aa > 0.0f) {
        s = tl_clamp(da / aa, -1.0f, 1.0f);
    }
    if (bb > 0.0f) {
        t = (s * ab - db) / bb;
        if (t < -1.0f || t > 1.0f) {
            t = tl_clamp(t, -1.0f, 1.0f);
            s = aa > 0.0f ? tl_clamp((t * ab + da) / aa, -1.0f, 1.0f) : 0.0f;
        }
    } else if (aa > 0.0f) {
        s = tl_clamp(da / aa, -1.0f, 1.0f);
    }
    *pa = tl_mad(ca, s, ua);
    *pb = tl_mad(cb, t, ub);
}

static void set_ends(tl_feature *f, talus_vec3 c, talus_vec3 u, float offset, talus_vec3 n) {
    talus_vec3 m = tl_mad(c, offset, n);
    f->count = 2;
    f->normal = n;
    f->point[0] = tl_sub(m, u);
    f->point[1] = tl_add(m, u);
    f->vertex[0] = 0;
    f->vertex[1] = 1;
    f->edge[0] = f->edge[1] = 0;
}

void tl_collide_capsules(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                         tl_manifold *out) {
    float ra = a->geometry.radius_top, rb = b->geometry.radius_top;
    talus_vec3 ca = tl_v(0.0f, 0.0f, 0.0f), ua = tl_v(0.0f, a->geometry.half_height, 0.0f), cb = b_in_a->position;
    talus_vec3 ub = tl_rotate(b_in_a->rotation, tl_v(0.0f, b->geometry.half_height, 0.0f)), pa, pb;
    tl_touch touch;
    tl_segment_segment(ca, ua, cb, ub, &pa, &pb);
    talus_vec3 d = tl_sub(pb, pa), x = tl_cross(ua, ub);
    float distance = tl_length(d), sum = ra + rb, aa = tl_length2(ua), bb = tl_length2(ub);
    out->count = 0;
    out->normal = tl_v(0.0f, 1.0f, 0.0f);
    out->gap = distance - sum;
    if (out->gap > margin) {
        return;
    }
    if (distance > 1e-6f * (a->geometry.half_height + b->geometry.half_height + sum)) {
        touch.normal = tl_normalize_or(d, out->normal);
    } else {
        /* the axes cross, or run into one another */
        talus_vec3 axis = tl_normalize_or(aa >= bb ? ua : ub, tl_v(1.0f, 0.0f, 0.0f));
        touch.normal = tl_length2(x) > 1e-10f * aa * bb ? tl_normalize_or(x, axis) : tl_perpendicular(axis);
        touch.normal = tl_dot(touch.normal, cb) < 0.0f ? tl_neg(touch.normal) : touch.normal;
    }
    touch.separation = distance - sum;
    talus_vec3 n = touch.normal;
    float na = tl_dot(n, ua);
    if (aa > 0.0f && bb > 0.0f && tl_length2(x) <= PARALLEL_SIN2 * aa * bb && na * na <= 0.03f * aa) {
        tl_feature fa, fb;
        set_ends(&fa, ca, ua, ra, n);
        set_ends(&fb, cb, ub, -rb, n);
        tl_manifold_build(&fa, &fb, &touch, margin, 0.0f, out);
        if (out->count > 0) {
            return;
        }
    }
    out->normal = n;
    out->count = 1;
    out->point[0].separation = touch.separation;
    out->point[0].position = tl_scale(tl_add(tl_mad(pa, ra, n), tl_mad(pb, -rb, n)), 0.5f);
    out->point[0].id = 0;
}
