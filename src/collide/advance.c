/* Time of contact by conservative advancement: Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996,
 * section 2.3.2; the bound of a convex shape's motion along the closest direction is that of Zhang, Lee & Kim,
 * Interactive Continuous Collision Detection for Non-Convex Polyhedra, The Visual Computer 22, 2006, section 4. The
 * separation along a direction n is a lower bound of the distance, and it shrinks no faster than the centres close in
 * along n and the turning brings points at most `reach` from their centre: a point p from its centre moves along n by
 * (w x p).n = p.(n x w). Bisection asks the same bound of ever shorter intervals about their middle. Metres. */
#include "collide/advance.h"

#define MAX_QUERIES 1000u
#define MAX_LEVEL 52u
#define NOISE 4e-6 /* of the sizes: several times what a distance may be wrong by */

/* Sine and cosine of x in [0, pi / 2] by their series, to the rounding of double. */
static void sine_cosine(double x, double *sine, double *cosine) {
    double x2 = x * x, s = 1.0, c = 1.0;
    for (int k = 12; k > 0; --k) {
        double n = 2.0 * (double)k;
        s = 1.0 - s * x2 / (n * (n + 1.0));
        c = 1.0 - c * x2 / (n * (n - 1.0));
    }
    *sine = x * s;
    *cosine = c;
}

void tl_moving_init(tl_moving *m, const tl_convex *shape, const talus_motion *motion) {
    tl_polytope_init(&m->core, shape);
    m->start = tl_frame_of(&motion->pose);
    m->center = tl_d_from(motion->center);
    m->at = tl_frame_point(&m->start, m->center);
    m->move = tl_d_from(motion->translation);
    m->turn = tl_d_from(motion->rotation);
    m->angle = tl_d_length(m->turn);
    m->axis = m->angle > 0.0 ? tl_d_scale(m->turn, 1.0 / m->angle) : tl_d(0.0, 0.0, 0.0);
    m->reach = tl_d_length(tl_d_sub(m->core.center, m->center)) + (double)m->core.size;
}

/* v turned about the axis: Rodrigues, with the sine and the versine of the angle. */
static tl_d3 turned(tl_d3 axis, double sine, double versine, tl_d3 v) {
    tl_d3 across = tl_d_cross(axis, v);
    return tl_d_add(v, tl_d_add(tl_d_scale(across, sine), tl_d_scale(tl_d_cross(axis, across), versine)));
}

tl_frame tl_moving_frame(const tl_moving *m, double time) {
    double s, c;
    sine_cosine(0.5 * m->angle * time, &s, &c);
    double sine = 2.0 * s * c, versine = 2.0 * s * s;
    tl_frame f = {turned(m->axis, sine, versine, m->start.x),
                  turned(m->axis, sine, versine, m->start.y),
                  turned(m->axis, sine, versine, m->start.z),
                  {0.0, 0.0, 0.0}};
    f.t = tl_d_sub(tl_d_add(m->at, tl_d_scale(m->move, time)), tl_frame_turn(&f, m->center));
    return f;
}

typedef struct search {
    const tl_moving *a, *b;
    tl_frame frame;   /* of a at the time of the last query */
    tl_closest near;  /* its answer, in that frame */
    tl_d3 normal;     /* its normal, in the common frame */
    double tolerance; /* m */
    double last;      /* advancement need not find contacts after this time */
    uint32_t queries;
} search;

static void query(search *s, double time) {
    s->frame = tl_moving_frame(s->a, time);
    tl_frame frame_b = tl_moving_frame(s->b, time), between = tl_frame_between(&s->frame, &frame_b);
    tl_closest_find(&s->a->core, &s->b->core, &between, s->near.features, &s->near);
    s->normal = tl_frame_turn(&s->frame, s->near.normal);
    ++s->queries;
}

/* How fast turning may bring points of either shape along n. */
static double turning(const search *s, tl_d3 n) {
    return s->a->reach * tl_d_length(tl_d_cross(n, s->a->turn)) + s->b->reach * tl_d_length(tl_d_cross(n, s->b->turn));
}

static void report(const search *s, talus_time_status status, double time, talus_contact_time *out) {
    out->status = status;
    out->time = time;
    out->gap = (float)s->near.gap;
    out->normal = tl_d_round(s->normal);
    out->point_a = tl_d_round(tl_frame_point(&s->frame, s->near.point_a));
    out->point_b = tl_d_round(tl_frame_point(&s->frame, s->near.point_b));
    out->queries = s->queries;
}

/* From a time of no contact to the next, as far as the bound allows with half the tolerance to spare. */
static void by_advancement(search *s, talus_contact_time *out) {
    double time = 0.0, free_until = 0.0;
    for (;;) {
        if (s->near.apart && s->near.gap <= s->tolerance) {
            report(s, TALUS_TIME_HIT, time, out);
            return;
        }
        if (s->queries == MAX_QUERIES) {
            report(s, TALUS_TIME_UNFINISHED, free_until, out);
            return;
        }
        if (s->near.apart) {
            tl_d3 closing = tl_d_sub(s->a->move, s->b->move);
            double speed = tl_d_dot(closing, s->normal) + turning(s, s->normal),
                   room = s->near.gap - 0.5 * s->tolerance;
            free_until = time;
            if (!(speed * (1.0 - time) > room) || time > s->last) {
                report(s, TALUS_TIME_MISS, 1.0, out);
                return;
            }
            time += room / speed;
        } else { /* by rounding alone: back towards the last good time */
            time = 0.5 * (free_until + time);
        }
        query(s, time);
    }
}

/* Intervals from the left, number `index` of those of length 2^-level; what lies before it is free. Levels end where a
 * double still holds every bound of an interval. */
static void by_bisection(search *s, talus_contact_time *out) {
    tl_d3 closing = tl_d_sub(s->a->move, s->b->move);
    double most = tl_d_length(closing) + s->a->reach * s->a->angle + s->b->reach * s->b->angle;
    double length = 1.0;
    uint64_t index = 0u;
    uint32_t level = 0u;
    while ((index >> level) == 0u) {
        double from = (double)index * length, half = 0.5 * length;
        query(s, from + half);
        double along = tl_d_dot(closing, s->normal), speed = tl_d_max(along, -along) + turning(s, s->normal);
        if (s->near.apart && s->near.gap > speed * half + 0.25 * s->tolerance) {
            ++index;
            /* up while the interval is the left half of the next longer one */
            for (; level > 0u && index % 2u == 0u; --level) {
                index /= 2u;
                length *= 2.0;
            }
        } else if (most * length <= 0.5 * s->tolerance || level == MAX_LEVEL || s->queries >= MAX_QUERIES) {
            query(s, from);
            report(s, s->near.gap <= s->tolerance ? TALUS_TIME_HIT : TALUS_TIME_UNFINISHED, from, out);
            return;
        } else {
            index *= 2u;
            ++level;
            length = half;
        }
    }
    report(s, TALUS_TIME_MISS, 1.0, out);
}

void tl_advance(const tl_moving *a, const tl_moving *b, float tolerance, double last, talus_time_method method,
                talus_feature_pair *features, talus_contact_time *out) {
    search s;
    s.a = a, s.b = b;
    s.last = last;
    s.queries = 0u;
    s.near.features = *features;
    double size = (double)a->core.size + (double)a->core.radius + (double)b->core.size + (double)b->core.radius;
    s.tolerance = tl_d_max((double)tolerance, NOISE * size);
    query(&s, 0.0);
    if (!s.near.apart || s.near.gap <= s.tolerance) {
        report(&s, TALUS_TIME_TOUCHING, 0.0, out);
    } else if (method == TALUS_BISECTION) {
        by_bisection(&s, out);
    } else {
        by_advancement(&s, out);
    }
    *features = s.near.features;
}
