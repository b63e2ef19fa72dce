/* The public queries: arguments looked at, frames in and out. */
#include "talus/query.h"

#include "collide/advance.h"
#include "collide/gauss_walk.h"
#include "collide/gjk.h"
#include "geom/mass.h"

#define PI_AND_A_BIT 3.1415931f /* what pi may round to, and its vector's length */

talus_status talus_convex_init(const talus_geometry *geometry, const void *region, size_t region_bytes,
                               talus_convex *out) {
    if (!out) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = tl_geometry_check(geometry, region, region_bytes);
    if (status == TALUS_OK) {
        out->geometry = *geometry;
        out->hull = geometry->type == TALUS_HULL ? tl_geometry_hull(geometry, region) : NULL;
    }
    return status;
}

static int within(talus_vec3 v) {
    v = tl_abs3(v);
    return v.x <= TALUS_MAX_COORDINATE && v.y <= TALUS_MAX_COORDINATE && v.z <= TALUS_MAX_COORDINATE;
}

/* Enough for a pose to be sound, and false of what is not finite. */
static inline int is_plain(const talus_pose *p) {
    double x = (double)p->rotation.x, y = (double)p->rotation.y, z = (double)p->rotation.z, w = (double)p->rotation.w;
    double turn = x * x + y * y + z * z + w * w, most = (double)TALUS_MAX_COORDINATE;
    tl_d3 t = tl_d_from(p->position);
    return turn > 0.0 && turn < 1e80 && tl_d_dot(t, t) <= most * most;
}

static talus_status check_pose(const talus_pose *p) {
    if (!p) {
        return TALUS_BAD_ARGUMENT;
    }
    if (!tl_is_finite_pose(p)) {
        return TALUS_NOT_FINITE;
    }
    const talus_quat q = p->rotation;
    int turned = q.x != 0.0f || q.y != 0.0f || q.z != 0.0f || q.w != 0.0f;
    return turned && within(p->position) ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

talus_status tl_motion_check(const talus_motion *m) {
    talus_status status = m ? check_pose(&m->pose) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    if (!tl_is_finite3(m->center) || !tl_is_finite3(m->translation) || !tl_is_finite3(m->rotation)) {
        return TALUS_NOT_FINITE;
    }
    return within(m->center) && within(m->translation) && tl_length(m->rotation) <= PI_AND_A_BIT ? TALUS_OK
                                                                                                 : TALUS_BAD_ARGUMENT;
}

talus_status tl_tolerance_check(float tolerance) {
    return !tl_is_finite(tolerance) ? TALUS_NOT_FINITE : tolerance > 0.0f ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

/* Two shapes where they stand. */
typedef struct placed {
    tl_polytope a, b;
    tl_frame frame; /* of A in the caller's */
    tl_frame b_in_a;
    talus_feature_pair features;
} placed;

static talus_status place(const talus_convex *a, const talus_pose *pose_a, const talus_convex *b,
                          const talus_pose *pose_b, const talus_feature_pair *features, placed *p) {
    if (!a || !b || !pose_a || !pose_b || !is_plain(pose_a) || !is_plain(pose_b)) {
        talus_status status = a && b ? check_pose(pose_a) : TALUS_BAD_ARGUMENT;
        status = status == TALUS_OK ? check_pose(pose_b) : status;
        if (status != TALUS_OK) {
            return status;
        }
    }
    tl_frame frame_a = tl_frame_of(pose_a), frame_b = tl_frame_of(pose_b);
    p->frame = frame_a;
    p->b_in_a = tl_frame_between(&frame_a, &frame_b);
    tl_polytope_init(&p->a, a);
    tl_polytope_init(&p->b, b);
    p->features.a = features ? features->a : 0u;
    p->features.b = features ? features->b : 0u;
    return TALUS_OK;
}

static talus_vec3 point_out(const placed *p, tl_d3 v) { return tl_d_round(tl_frame_point(&p->frame, v)); }
static talus_vec3 vector_out(const placed *p, tl_d3 v) { return tl_d_round(tl_frame_turn(&p->frame, v)); }

talus_status talus_distance(const talus_convex *a, const talus_pose *pose_a, const talus_convex *b,
                            const talus_pose *pose_b, talus_feature_pair *features, talus_separation *out) {
    placed p;
    tl_closest c;
    talus_status status = out ? place(a, pose_a, b, pose_b, features, &p) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    tl_closest_find(&p.a, &p.b, &p.b_in_a, p.features, &c);
    double gap = c.apart ? c.gap : 0.0;
    tl_d3 normal = tl_frame_turn(&p.frame, c.normal), point = tl_frame_point(&p.frame, c.apart ? c.point_a : c.common);
    out->distance = (float)gap;
    out->overlap = !c.apart;
    out->normal = tl_d_round(normal);
    out->point_a = tl_d_round(point);
    out->point_b = tl_d_round(tl_d_add(point, tl_d_scale(normal, gap)));
    out->steps = c.steps;
    out->gave_up = c.gave_up;
    if (features) {
        *features = c.features;
    }
    return TALUS_OK;
}

/* Depth, normal and points of an overlap in A's frame, radii included. */
typedef struct overlap {
    double depth;
    tl_d3 normal, point_a, point_b;
    int proven;
    uint32_t directions;
} overlap;

static void swell(overlap *o, float ra, float rb) {
    o->depth += (double)ra + (double)rb;
    o->point_a = tl_d_add(o->point_a, tl_d_scale(o->normal, (double)ra));
    o->point_b = tl_d_sub(o->point_b, tl_d_scale(o->normal, (double)rb));
}

/* Round cores, by EPA. */
static void of_round(const placed *p, overlap *o) {
    tl_core ca, cb;
    tl_simplex simplex;
    tl_gjk near;
    tl_depth d;
    tl_closest_cores(&p->a, &p->b, &p->b_in_a, &ca, &cb);
    simplex.count = 0;
    (void)tl_gjk_run(&ca, &cb, tl_normalize_or(cb.t, tl_v(0.0f, 1.0f, 0.0f)), 3e38f, &simplex, &near);
    tl_epa_run(&ca, &cb, &simplex, &d);
    o->depth = (double)d.depth;
    o->normal = tl_d_from(d.normal);
    o->point_a = tl_d_from(d.point_a);
    o->point_b = tl_d_from(d.point_b);
    swell(o, ca.radius, cb.radius);
    /* EPA's facets are chords of round sides: its points are aside of one another by about a thousandth */
    tl_d3 middle = tl_d_scale(tl_d_add(o->point_a, o->point_b), 0.5);
    o->point_a = tl_d_add(middle, tl_d_scale(o->normal, 0.5 * o->depth));
    o->point_b = tl_d_sub(middle, tl_d_scale(o->normal, 0.5 * o->depth));
}

/* Centres of balls and axes of capsules that meet: any way across both is the shortest. */
static void of_lines(const placed *p, const tl_closest *c, overlap *o) {
    tl_d3 u = tl_d(0.0, p->a.edge_count ? 1.0 : 0.0, 0.0), v = p->b.edge_count ? p->b_in_a.y : tl_d(0.0, 0.0, 0.0);
    tl_d3 n = tl_d_cross(u, v);
    double length = tl_d_length(n);
    if (length > 1e-6) {
        n = tl_d_scale(n, 1.0 / length);
    } else {
        u = p->a.edge_count ? u : v;
        n = tl_d_from(tl_perpendicular(tl_normalize_or(tl_d_round(u), tl_v(1.0f, 0.0f, 0.0f))));
    }
    o->depth = 0.0;
    o->normal = n;
    o->point_a = o->point_b = c->point_a;
    o->proven = 1;
    swell(o, p->a.radius, p->b.radius);
}

static void of_polytopes(placed *p, talus_depth_mode mode, overlap *o) {
    tl_gauss_pair pair = {&p->a, &p->b, &p->b_in_a, 0};
    tl_gauss_depth d;
    tl_gauss_start(&pair, p->features, &d);
    tl_gauss_descend(&pair, &d);
    o->proven = mode == TALUS_DEPTH_PROVEN && tl_gauss_prove(&pair, &d);
    o->depth = d.value > 0.0 ? d.value : 0.0; /* cores that touch may be seen apart by rounding */
    o->normal = d.n;
    o->directions = pair.supports;
    tl_gauss_points(&pair, &d, &o->point_a, &o->point_b);
    p->features.a = d.feature_a;
    p->features.b = d.feature_b;
    swell(o, p->a.radius, p->b.radius);
}

talus_status talus_penetration(const talus_convex *a, const talus_pose *pose_a, const talus_convex *b,
                               const talus_pose *pose_b, talus_depth_mode mode, talus_feature_pair *features,
                               talus_depth *out) {
    static const talus_depth none = {0.0f, 0, 0, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0u};
    placed p;
    tl_closest c;
    overlap o = {0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0, 0u};
    int known = out && (unsigned)mode < TALUS_DEPTH_MODE_COUNT;
    talus_status status = known ? place(a, pose_a, b, pose_b, features, &p) : TALUS_BAD_ARGUMENT;
    if (status != TALUS_OK) {
        return status;
    }
    tl_gauss_pair pair = {&p.a, &p.b, &p.b_in_a, 0};
    c.apart = c.cores_apart = 0;
    if (p.a.round || p.b.round || !tl_gauss_overlap(&pair, p.features)) {
        tl_closest_find(&p.a, &p.b, &p.b_in_a, p.features, &c);
    }
    if (c.apart || c.cores_apart) {
        p.features = c.features;
    }
    *out = none;
    if (!c.apart) {
        if (c.cores_apart) {
            o.depth = -c.gap;
            o.normal = c.normal;
            o.point_a = c.point_a;
            o.point_b = c.point_b;
            o.proven = !p.a.round && !p.b.round;
        } else if (p.a.round || p.b.round) {
            of_round(&p, &o);
        } else if (p.a.face_count + p.b.face_count == 0u) {
            of_lines(&p, &c, &o);
        } else {
            of_polytopes(&p, mode, &o);
        }
        out->depth = (float)o.depth;
        out->overlap = 1;
        out->proven = o.proven;
        out->normal = vector_out(&p, o.normal);
        out->point_a = point_out(&p, o.point_a);
        out->point_b = point_out(&p, o.point_b);
        out->directions = o.directions;
    }
    if (features) {
        *features = p.features;
    }
    return TALUS_OK;
}

talus_status talus_time_of_contact(const talus_convex *a, const talus_motion *motion_a, const talus_convex *b,
                                   const talus_motion *motion_b, float tolerance, talus_time_method method,
                                   talus_feature_pair *features, talus_contact_time *out) {
    if (!a || !b || !out || (unsigned)method >= TALUS_TIME_METHOD_COUNT) {
        return TALUS_BAD_ARGUMENT;
    }
    talus_status status = tl_motion_check(motion_a);
    if (status == TALUS_OK) {
        status = tl_motion_check(motion_b);
    }
    if (status == TALUS_OK) {
        status = tl_tolerance_check(tolerance);
    }
    if (status != TALUS_OK) {
        return status;
    }
    tl_moving moving_a, moving_b;
    talus_feature_pair cold = {0u, 0u};
    tl_moving_init(&moving_a, a, motion_a);
    tl_moving_init(&moving_b, b, motion_b);
    tl_advance(&moving_a, &moving_b, tolerance, 1.0, method, features ? features : &cold, out);
    return TALUS_OK;
}
