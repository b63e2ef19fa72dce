/* A shape at a pose as libccd takes it, in double precision. */
#ifndef CCD_KIT_H
#define CCD_KIT_H

#include <ccd/ccd.h>
#include <ccd/quat.h>

#include "../unit/collide_brute.h"

typedef struct placed {
    const tl_convex *shape;
    d_pose pose;
} placed;

static inline d3 support_point(const tl_convex *s, d3 d) {
    const talus_geometry *g = &s->geometry;
    double h = (double)g->half_height, rt = (double)g->radius_top, rb = (double)g->radius_bottom;
    double radial = sqrt(d.x * d.x + d.z * d.z);
    d3 u = d3_unit(d);
    switch (g->type) {
    case TALUS_SPHERE:
        return d3_scale(u, (double)g->radius);
    case TALUS_CAPSULE: {
        int top = h * u.y + rt > rb - h * u.y;
        return d3_add(d3_make(0.0, top ? h : -h, 0.0), d3_scale(u, top ? rt : rb));
    }
    case TALUS_CYLINDER: {
        int top = h * d.y + rt * radial > rb * radial - h * d.y;
        double r = radial > 0.0 ? (top ? rt : rb) / radial : 0.0;
        return d3_make(d.x * r, top ? h : -h, d.z * r);
    }
    case TALUS_BOX:
        return d3_make(d.x < 0.0 ? -(double)g->half.x : (double)g->half.x,
                       d.y < 0.0 ? -(double)g->half.y : (double)g->half.y,
                       d.z < 0.0 ? -(double)g->half.z : (double)g->half.z);
    case TALUS_HULL:
    case TALUS_SHAPE_TYPE_COUNT:
    default: {
        d3 best = d3_of(tl_hull_point(s->hull, 0));
        for (uint32_t i = 1; i < s->hull->vertex_count; ++i) {
            d3 p = d3_of(tl_hull_point(s->hull, i));
            best = d3_dot(p, d) > d3_dot(best, d) ? p : best;
        }
        return best;
    }
    }
}

static inline void ccd_support(const void *object, const ccd_vec3_t *dir, ccd_vec3_t *out) {
    const placed *p = object;
    d3 d = d_rotate_back(&p->pose, d3_make(ccdVec3X(dir), ccdVec3Y(dir), ccdVec3Z(dir)));
    d3 v = d3_add(d_rotate(&p->pose, support_point(p->shape, d)), p->pose.t);
    ccdVec3Set(out, v.x, v.y, v.z);
}

static inline void ccd_center(const void *object, ccd_vec3_t *out) {
    const placed *p = object;
    d3 c = p->pose.t;
    if (p->shape->geometry.type == TALUS_HULL) {
        c = d3_add(d_rotate(&p->pose, d3_of(p->shape->hull->centroid)), c);
    }
    ccdVec3Set(out, c.x, c.y, c.z);
}

static inline ccd_t ccd_settings(double epa_tolerance, double mpr_tolerance) {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_center;
    ccd.max_iterations = 200;
    ccd.epa_tolerance = epa_tolerance;
    ccd.mpr_tolerance = mpr_tolerance;
    return ccd;
}

#endif
