/* One pair of capsules or of a capsule and a ball (capsules.inl). Side by side capsules meet in two points. Metres. */
#include "base/width_one.h"
#include "collide/round.h"

#include "collide/capsules.inl"

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

static void set_point(const cp_capsules *x, const cp_touch *m, tl_manifold *out) {
    out->count = 1;
    out->point[0].separation = m->gap;
    out->point[0].position = tl_v(cp_midway(x, m, 0), cp_midway(x, m, 1), cp_midway(x, m, 2));
    out->point[0].id = 0;
}

/* A normal where the axes cross, or run into one another. */
static talus_vec3 normal_across(talus_vec3 ua, talus_vec3 ub, talus_vec3 between) {
    talus_vec3 x = tl_cross(ua, ub);
    float aa = tl_length2(ua), bb = tl_length2(ub);
    talus_vec3 axis = tl_normalize_or(aa >= bb ? ua : ub, tl_v(1.0f, 0.0f, 0.0f));
    talus_vec3 n = tl_length2(x) > 1e-10f * aa * bb ? tl_normalize_or(x, axis) : tl_perpendicular(axis);
    return tl_dot(n, between) < 0.0f ? tl_neg(n) : n;
}

static float half_of(const talus_geometry *g) { return g->type == TALUS_SPHERE ? 0.0f : g->half_height; }
static float radius_of(const talus_geometry *g) { return g->type == TALUS_SPHERE ? g->radius : g->radius_top; }

void tl_collide_capsules(const tl_convex *a, const tl_convex *b, const talus_pose *b_in_a, float margin,
                         tl_manifold *out) {
    float ha = half_of(&a->geometry), hb = half_of(&b->geometry);
    talus_vec3 t = b_in_a->position, ua = tl_v(0.0f, ha, 0.0f);
    talus_vec3 ub = tl_rotate(b_in_a->rotation, tl_v(0.0f, hb, 0.0f));
    cp_capsules x = {ha,    hb, radius_of(&a->geometry), radius_of(&b->geometry), {t.x, t.y, t.z}, {ub.x, ub.y, ub.z},
                     margin};
    cp_touch m;
    cp_collide(&x, &m);
    out->count = 0;
    out->normal = tl_v(0.0f, 1.0f, 0.0f);
    out->gap = m.gap;
    if (m.gap > margin) {
        return;
    }
    tl_touch touch;
    touch.separation = m.gap;
    touch.normal = m.meet ? normal_across(ua, ub, t) : tl_v(m.n[0], m.n[1], m.n[2]);
    m.n[0] = touch.normal.x, m.n[1] = touch.normal.y, m.n[2] = touch.normal.z;
    out->normal = touch.normal;
    if (!m.decided && cp_is_beside(&x, m.cross2, m.n[1])) {
        tl_feature fa, fb;
        set_ends(&fa, tl_v(0.0f, 0.0f, 0.0f), ua, x.ra, touch.normal);
        set_ends(&fb, t, ub, -x.rb, touch.normal);
        tl_manifold_build(&fa, &fb, &touch, margin, 0.0f, out);
        if (out->count > 0) {
            return;
        }
    }
    set_point(&x, &m, out);
}
