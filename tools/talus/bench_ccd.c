/* libccd as `talus bench queries` asks it, where the tool was built with it: its GJK says whether hulls touch, its MPR
 * and EPA how deep they overlap. Support points by a scan over all vertices, in double. */
#include "bench_queries.h"

#ifdef TALUS_TOOL_CCD

#include "collide/polytope.h"

#include <ccd/ccd.h>

typedef struct object {
    const talus_hull *hull;
    tl_frame frame;
} object;

static void support(const void *of, const ccd_vec3_t *direction, ccd_vec3_t *out) {
    const object *o = of;
    tl_d3 d = tl_frame_turn_back(
        &o->frame, tl_d((double)ccdVec3X(direction), (double)ccdVec3Y(direction), (double)ccdVec3Z(direction)));
    const float *x = tl_hull_x(o->hull), *y = tl_hull_y(o->hull), *z = tl_hull_z(o->hull);
    uint32_t best = 0;
    double most = -1e300;
    for (uint32_t i = 0; i < o->hull->vertex_count; i++) {
        double s = d.x * (double)x[i] + d.y * (double)y[i] + d.z * (double)z[i];
        if (s > most) {
            most = s, best = i;
        }
    }
    tl_d3 p = tl_frame_point(&o->frame, tl_d_from(tl_hull_point(o->hull, best)));
    ccdVec3Set(out, (ccd_real_t)p.x, (ccd_real_t)p.y, (ccd_real_t)p.z);
}

static void center(const void *of, ccd_vec3_t *out) {
    const object *o = of;
    tl_d3 c = tl_frame_point(&o->frame, tl_d_from(o->hull->centroid));
    ccdVec3Set(out, (ccd_real_t)c.x, (ccd_real_t)c.y, (ccd_real_t)c.z);
}

enum { TOUCH, EPA, MPR };

static void ask(const bench_case *c, int what, uint32_t count, double *answers) {
    static const talus_pose here = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    object a = {c->shape_a.hull, tl_frame_of(&here)}, b = {c->shape_b.hull, tl_frame_of(&here)};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.max_iterations = 500;
    ccd.epa_tolerance = (ccd_real_t)1e-6;
    ccd.mpr_tolerance = (ccd_real_t)1e-6;
    for (uint32_t i = 0; i < count; i++) {
        ccd_real_t depth = 0;
        ccd_vec3_t direction, at;
        b.frame = tl_frame_of(&c->poses[i]);
        if (what == TOUCH) {
            depth = (ccd_real_t)ccdGJKIntersect(&a, &b, &ccd);
        } else if (what == EPA) {
            (void)ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &at);
        } else {
            (void)ccdMPRPenetration(&a, &b, &ccd, &depth, &direction, &at);
        }
        answers[i] = (double)depth;
    }
}

static void touch(const bench_case *c, uint32_t count, double *answers) { ask(c, TOUCH, count, answers); }
static void epa(const bench_case *c, uint32_t count, double *answers) { ask(c, EPA, count, answers); }
static void mpr(const bench_case *c, uint32_t count, double *answers) { ask(c, MPR, count, answers); }

const bench_method bench_ccd_methods[] = {{"ccd-gjk", "libccd GJK (touch?)", 0, 1, UINT32_MAX, touch},
                                          {"ccd-epa", "libccd EPA", 1, 0, UINT32_MAX, epa},
                                          {"ccd-mpr", "libccd MPR", 1, 0, UINT32_MAX, mpr}};
const int bench_ccd_count = (int)(sizeof bench_ccd_methods / sizeof *bench_ccd_methods);

#else

const bench_method bench_ccd_methods[] = {{NULL, NULL, 0, 0, 0, NULL}};
const int bench_ccd_count = 0;

#endif
