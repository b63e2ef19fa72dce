/* What boxes and shapes answer to a question. */
#include "world/query_probe.h"

#include <string.h>

#include "collide/ray.h"
#include "stage/broad/refit.h"

/* Boxes count as larger by a part of their coordinates and of their extents: the boxes of shapes are rounded to floats
 * at each step of the way to the world, and a distance may be wrong by 4e-6 of the shapes' sizes. */
#define OF_PLACE 1e-6
#define OF_SIZE 4e-6
#define MOST_FLOAT 3.4e38

/* --- boxes --------------------------------------------------------------------------------------- */

/* How much larger: no less for a box that holds another one. */
static double slack_of(const talus_aabb *b) {
    const talus_vec3 l = b->lower, u = b->upper;
    double place = (double)tl_max(tl_abs(l.x), tl_abs(u.x)) + (double)tl_max(tl_abs(l.y), tl_abs(u.y)) +
                   (double)tl_max(tl_abs(l.z), tl_abs(u.z));
    double extent = ((double)u.x - (double)l.x) + ((double)u.y - (double)l.y) + ((double)u.z - (double)l.z);
    return OF_PLACE * place + OF_SIZE * extent;
}

/* Cuts down what part of the way lies within the slab of one axis. */
static void cut(double from, double way, double inverse, double low, double high, double *enter, double *leave) {
    if (way == 0.0) {
        *leave = from < low || from > high ? -1.0 : *leave;
        return;
    }
    double a = (low - from) * inverse, b = (high - from) * inverse;
    *enter = tl_d_max(*enter, way > 0.0 ? a : b);
    *leave = tl_d_min(*leave, way > 0.0 ? b : a);
}

/* Boxes by slabs (Kay & Kajiya, Ray tracing complex scenes, SIGGRAPH 1986), swollen by what is on its way. */
static double bound_of_way(const tl_probe *p, const talus_aabb *b) {
    const talus_aabb *own = &p->box;
    double enter = 0.0, leave = p->reach, slack = slack_of(b);
    cut(p->from.x, p->way.x, p->inverse.x, (double)b->lower.x - slack - (double)own->upper.x,
        (double)b->upper.x + slack - (double)own->lower.x, &enter, &leave);
    cut(p->from.y, p->way.y, p->inverse.y, (double)b->lower.y - slack - (double)own->upper.y,
        (double)b->upper.y + slack - (double)own->lower.y, &enter, &leave);
    cut(p->from.z, p->way.z, p->inverse.z, (double)b->lower.z - slack - (double)own->upper.z,
        (double)b->upper.z + slack - (double)own->lower.z, &enter, &leave);
    return enter <= leave ? enter : TL_OUT_OF_REACH;
}

static double gap(float lower, float upper, double slack, float own_lower, float own_upper) {
    return tl_d_max(0.0,
                    tl_d_max((double)lower - slack - (double)own_upper, (double)own_lower - ((double)upper + slack)));
}

/* By the root of floats, which is exact and so keeps order. */
static double bound_of_distance(const tl_probe *p, const talus_aabb *b) {
    const talus_aabb *own = &p->box;
    double slack = slack_of(b);
    double x = gap(b->lower.x, b->upper.x, slack, own->lower.x, own->upper.x),
           y = gap(b->lower.y, b->upper.y, slack, own->lower.y, own->upper.y),
           z = gap(b->lower.z, b->upper.z, slack, own->lower.z, own->upper.z);
    double distance = (double)sqrtf((float)tl_d_min(x * x + y * y + z * z, MOST_FLOAT));
    return distance <= p->reach ? distance : TL_OUT_OF_REACH;
}

static int is_on_its_way(const tl_probe *p) { return p->question == TL_ASK_RAY || p->question == TL_ASK_CAST; }

double tl_probe_bound(const tl_probe *p, const talus_aabb *box) {
    return is_on_its_way(p) ? bound_of_way(p, box) : bound_of_distance(p, box);
}

/* --- shapes -------------------------------------------------------------------------------------- */

int tl_probe_sees(const tl_probe *p, uint32_t shape) {
    const tl_header *h = tl_header_of(p->world);
    const tl_shape_meta *m = &tl_shapes(h)[shape];
    const talus_query_filter *f = &p->filter;
    if (!(f->kinds >> tl_body_type(&tl_bodies(h)[m->body]) & 1u) ||
        ((m->flags & TL_SHAPE_SENSOR) && !(f->kinds & TALUS_SEE_SENSORS))) {
        return 0;
    }
    talus_filter own = tl_shape_filter(h, shape);
    if (!tl_filters_meet(&f->filter, &own)) {
        return 0;
    }
    for (uint32_t i = 0; i < f->skip_count; i++) {
        if (f->skip[i].index == m->body && f->skip[i].generation == tl_bodies(h)[m->body].generation) {
            return 0;
        }
    }
    return 1;
}

static void note(talus_query_hit *out, double at, tl_d3 normal, talus_vec3 point, talus_vec3 own) {
    out->at = at;
    out->normal = tl_d_round(normal);
    out->point = point;
    out->own = own;
}

static int ask_ray(const tl_probe *p, const tl_convex *shape, const talus_pose *pose, talus_query_hit *out) {
    tl_ray_hit hit;
    if (!tl_ray_convex(shape, pose, p->from, p->way, &hit)) {
        return 0;
    }
    talus_vec3 point = tl_d_round(tl_d_add(p->from, tl_d_scale(p->way, hit.at)));
    note(out, hit.at, hit.normal, point, point);
    out->within = (uint16_t)hit.within;
    return 1;
}

static int ask_cast(const tl_probe *p, const tl_convex *shape, const talus_pose *pose, double last,
                    talus_query_hit *out) {
    talus_motion still = {*pose, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    talus_feature_pair cold = {0u, 0u};
    tl_moving other;
    talus_contact_time t;
    tl_moving_init(&other, shape, &still);
    tl_advance(&p->moving, &other, p->tolerance, last, TALUS_ADVANCEMENT, &cold, &t);
    if (t.status == TALUS_TIME_MISS) {
        return 0;
    }
    note(out, t.time, tl_d_from(tl_neg(t.normal)), t.point_b, t.point_a);
    out->within = t.status == TALUS_TIME_TOUCHING;
    out->unfinished = t.status == TALUS_TIME_UNFINISHED;
    return 1;
}

static int ask_distance(const tl_probe *p, const tl_convex *shape, const talus_pose *pose, talus_query_hit *out) {
    tl_polytope core;
    tl_closest c;
    talus_feature_pair cold = {0u, 0u};
    tl_frame frame = tl_frame_of(pose), between = tl_frame_between(&p->frame, &frame);
    tl_polytope_init(&core, shape);
    tl_closest_find(&p->core, &core, &between, cold, &c);
    double distance = c.apart ? (double)(float)c.gap : 0.0;
    if (c.apart && (p->question == TL_ASK_OVERLAP || distance > p->reach)) {
        return 0;
    }
    if (!c.apart) {
        c.point_a = c.point_b = c.common;
    }
    note(out, distance, tl_d_scale(tl_frame_turn(&p->frame, c.normal), -1.0),
         tl_d_round(tl_frame_point(&p->frame, c.point_b)), tl_d_round(tl_frame_point(&p->frame, c.point_a)));
    out->within = !c.apart;
    return 1;
}

int tl_probe_ask(const tl_probe *p, uint32_t s, double last, talus_query_hit *out) {
    const tl_header *h = tl_header_of(p->world);
    tl_convex shape = tl_shape_convex(h, p->world->geometry, s);
    talus_pose pose = tl_shape_world_pose(h, s);
    int answers = 0;
    memset(out, 0, sizeof *out);
    if (tl_check_point(pose.position) != TALUS_OK) {
        return 0; /* flown to where numbers mean nothing any more */
    }
    switch (p->question) {
    case TL_ASK_RAY:
    case TL_ASK_POINT:
        answers = ask_ray(p, &shape, &pose, out);
        break;
    case TL_ASK_CAST:
        answers = ask_cast(p, &shape, &pose, last, out);
        break;
    case TL_ASK_CLOSEST:
    case TL_ASK_OVERLAP:
        answers = ask_distance(p, &shape, &pose, out);
        break;
    case TL_ASK_BOXES:
    default:
        answers = 1;
        break;
    }
    if (!answers) {
        return 0;
    }
    talus_aabb box = tl_convex_aabb(&shape, &pose);
    double bound = tl_probe_bound(p, &box);
    if (bound == TL_OUT_OF_REACH || (p->question == TL_ASK_BOXES && !tl_aabb_overlap(&box, &p->box))) {
        return 0;
    }
    out->at = tl_d_max(out->at, bound);
    out->shape.index = s, out->shape.generation = tl_shapes(h)[s].generation;
    out->body.index = tl_shapes(h)[s].body, out->body.generation = tl_bodies(h)[out->body.index].generation;
    return 1;
}

/* --- questions ----------------------------------------------------------------------------------- */

talus_query_filter talus_query_filter_default(void) {
    talus_query_filter f;
    memset(&f, 0, sizeof f);
    f.filter.category = f.filter.mask = ~(uint64_t)0;
    f.kinds = TALUS_SEE_STATIC | TALUS_SEE_KINEMATIC | TALUS_SEE_DYNAMIC;
    return f;
}

static talus_status begin(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                          tl_question question) {
    const uint32_t all = TALUS_SEE_STATIC | TALUS_SEE_KINEMATIC | TALUS_SEE_DYNAMIC | TALUS_SEE_SENSORS;
    if (!tl_world_is_sound(world)) {
        return TALUS_BAD_ARGUMENT;
    }
    p->world = world;
    p->question = question;
    p->filter = filter ? *filter : talus_query_filter_default();
    p->reach = 0.0;
    return (p->filter.kinds & ~all) || (p->filter.skip_count && !p->filter.skip) ? TALUS_BAD_ARGUMENT : TALUS_OK;
}

static void set_way(tl_probe *p, tl_d3 from, tl_d3 way, talus_aabb box) {
    p->from = from;
    p->way = way;
    p->inverse =
        tl_d(way.x != 0.0 ? 1.0 / way.x : 0.0, way.y != 0.0 ? 1.0 / way.y : 0.0, way.z != 0.0 ? 1.0 / way.z : 0.0);
    p->box = box;
    p->reach = 1.0;
}

static talus_aabb around(talus_vec3 point) {
    talus_aabb box = {point, point};
    return box;
}

/* The box of the probe's shape turned by a rotation of any length, seen from a point of the rotated shape; larger by a
 * margin and by what rounding may take. */
static talus_aabb turned_box(const tl_convex *shape, talus_quat q, tl_d3 from, double margin) {
    double x = (double)q.x, y = (double)q.y, z = (double)q.z, w = (double)q.w;
    double l = 1.0 / tl_d_sqrt(x * x + y * y + z * z + w * w);
    talus_pose pose = {{0.0f, 0.0f, 0.0f}, {(float)(x * l), (float)(y * l), (float)(z * l), (float)(w * l)}};
    talus_aabb box = tl_convex_aabb(shape, &pose);
    margin += slack_of(&box) + OF_PLACE * tl_d_length(from);
    box.lower = tl_d_round(tl_d((double)box.lower.x - from.x - margin, (double)box.lower.y - from.y - margin,
                                (double)box.lower.z - from.z - margin));
    box.upper = tl_d_round(tl_d((double)box.upper.x - from.x + margin, (double)box.upper.y - from.y + margin,
                                (double)box.upper.z - from.z + margin));
    return box;
}

talus_status tl_probe_ray(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                          const talus_ray *ray) {
    talus_status status = ray ? begin(p, world, filter, TL_ASK_RAY) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        status = tl_check_point(ray->origin);
    }
    if (status == TALUS_OK) {
        status = tl_check_point(ray->way);
    }
    if (status == TALUS_OK) {
        set_way(p, tl_d_from(ray->origin), tl_d_from(ray->way), around(tl_v(0.0f, 0.0f, 0.0f)));
    }
    return status;
}

talus_status tl_probe_cast(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                           const talus_convex *shape, const talus_motion *motion, float tolerance) {
    talus_status status = shape ? begin(p, world, filter, TL_ASK_CAST) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        status = tl_motion_check(motion);
    }
    if (status == TALUS_OK) {
        status = tl_tolerance_check(tolerance);
    }
    if (status != TALUS_OK) {
        return status;
    }
    p->shape.geometry = shape->geometry;
    p->shape.hull = shape->hull;
    p->tolerance = tolerance;
    tl_moving_init(&p->moving, &p->shape, motion);
    const tl_moving *m = &p->moving;
    double reach = m->reach + (double)m->core.radius;
    tl_d3 center = tl_d_sub(m->at, m->start.t);
    talus_aabb box = turned_box(&p->shape, motion->pose.rotation, center, (double)tolerance);
    if (m->angle > 0.0) { /* any way round */
        float r = (float)(1.00001 * reach + (double)tolerance);
        box.lower = tl_v(-r, -r, -r);
        box.upper = tl_v(r, r, r);
    }
    set_way(p, m->at, m->move, box);
    return TALUS_OK;
}

static talus_status check_reach(float reach) {
    return !tl_is_finite(reach) ? TALUS_NOT_FINITE : reach >= 0.0f ? TALUS_OK : TALUS_BAD_ARGUMENT;
}

talus_status tl_probe_shape(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                            tl_question question, const talus_convex *shape, const talus_pose *pose, float reach) {
    talus_status status = shape && pose ? begin(p, world, filter, question) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        status = tl_check_pose(pose);
    }
    if (status == TALUS_OK) {
        status = check_reach(reach);
    }
    if (status != TALUS_OK) {
        return status;
    }
    p->shape.geometry = shape->geometry;
    p->shape.hull = shape->hull;
    tl_polytope_init(&p->core, &p->shape);
    p->frame = tl_frame_of(pose);
    p->box = turned_box(&p->shape, pose->rotation, tl_d_scale(tl_d_from(pose->position), -1.0), 0.0);
    p->reach = (double)reach;
    return TALUS_OK;
}

talus_status tl_probe_point(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                            tl_question question, talus_vec3 point, float reach) {
    talus_status status = begin(p, world, filter, question);
    if (status == TALUS_OK) {
        status = tl_check_point(point);
    }
    if (status == TALUS_OK) {
        status = check_reach(reach);
    }
    if (status != TALUS_OK) {
        return status;
    }
    talus_pose pose = {point, {0.0f, 0.0f, 0.0f, 1.0f}};
    memset(&p->shape, 0, sizeof p->shape);
    p->shape.geometry.type = TALUS_SPHERE; /* of radius 0 */
    tl_polytope_init(&p->core, &p->shape);
    p->frame = tl_frame_of(&pose);
    p->from = tl_d_from(point);
    p->way = tl_d(0.0, 0.0, 0.0);
    p->box = around(point);
    p->reach = (double)reach;
    return TALUS_OK;
}

talus_status tl_probe_box(tl_probe *p, const talus_world *world, const talus_query_filter *filter,
                          const talus_aabb *box) {
    talus_status status = box ? begin(p, world, filter, TL_ASK_BOXES) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        status = tl_check_point(box->lower);
    }
    if (status == TALUS_OK) {
        status = tl_check_point(box->upper);
    }
    if (status != TALUS_OK) {
        return status;
    }
    p->box = *box;
    return box->lower.x <= box->upper.x && box->lower.y <= box->upper.y && box->lower.z <= box->upper.z
               ? TALUS_OK
               : TALUS_BAD_ARGUMENT;
}
