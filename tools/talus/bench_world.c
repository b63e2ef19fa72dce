/* Rays, casts and other queries of a world, timed, and held against looking at each of its boxes alone: by closed forms
 * in double precision, casts by bisection, which knows no tree and no advancement. */
#include "bench_world.h"

#include "bench_features.h"
#include "figures.h"
#include "host/clock.h"
#include "scene_parts.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define QUERIES 500u
#define REFERENCES 25u /* queries that are held against all shapes */
#define MOST_RUNS 5u
#define MOST_HITS 64u
#define TOLERANCE 1e-3f /* m, of casts */
#define REACH 2.0f      /* m */

/* One place and way to ask about, by whichever query. */
typedef struct question {
    talus_ray ray;
    talus_motion motion; /* of a ball or a box along the ray */
    talus_pose pose;     /* in the pile */
    talus_aabb box;      /* around it */
} question;

/* A shape of the world, as it was made and where it stands now. */
typedef struct thing {
    talus_shape shape;
    talus_convex convex;
    talus_pose pose;
} thing;

#define MOST_THINGS 1024u

typedef struct bench_world {
    talus_world world;
    void *memory;
    thing things[MOST_THINGS];
    uint32_t thing_count;
    talus_convex ball, cube;
    question asked[QUERIES];
} bench_world;

/* Answers of a query: in the order of what a world tells, or of one shape. */
typedef struct answer {
    talus_query_hit hit[MOST_HITS];
    talus_hits hits;
} answer;

typedef struct method {
    const char *name, *label;
    int first; /* it tells the first only */
    talus_status (*ask)(const bench_world *b, const question *q, answer *out);
    /* whether it finds one thing; *at receives the part of the way, or the distance (m) */
    int (*look)(const bench_world *b, const question *q, const thing *t, double *at);
    int by_way; /* what it tells is a part of the way */
} method;

/* --- the queries --- */

static talus_status only(answer *a, talus_status status) {
    a->hits.count = a->hit[0].shape.generation != 0;
    return status;
}

static talus_status ray(const bench_world *b, const question *q, answer *a) {
    return only(a, talus_world_ray(&b->world, &q->ray, NULL, a->hit));
}
static talus_status ray_any(const bench_world *b, const question *q, answer *a) {
    int any = 0;
    talus_status status = talus_world_ray_any(&b->world, &q->ray, NULL, &any);
    a->hits.count = (uint32_t)any;
    return status;
}
static talus_status ray_all(const bench_world *b, const question *q, answer *a) {
    return talus_world_ray_all(&b->world, &q->ray, NULL, &a->hits);
}
static talus_status cast_ball(const bench_world *b, const question *q, answer *a) {
    return only(a, talus_world_cast(&b->world, &b->ball, &q->motion, TOLERANCE, NULL, a->hit));
}
static talus_status cast_cube(const bench_world *b, const question *q, answer *a) {
    return only(a, talus_world_cast(&b->world, &b->cube, &q->motion, TOLERANCE, NULL, a->hit));
}
static talus_status closest(const bench_world *b, const question *q, answer *a) {
    return only(a, talus_world_closest(&b->world, &b->cube, &q->pose, REACH, NULL, a->hit));
}
static talus_status closest_to_point(const bench_world *b, const question *q, answer *a) {
    return only(a, talus_world_closest_to_point(&b->world, q->pose.position, REACH, NULL, a->hit));
}
static talus_status overlap(const bench_world *b, const question *q, answer *a) {
    return talus_world_overlap(&b->world, &b->cube, &q->pose, NULL, &a->hits);
}
static talus_status overlap_aabb(const bench_world *b, const question *q, answer *a) {
    return talus_world_overlap_aabb(&b->world, &q->box, NULL, &a->hits);
}
static talus_status at_point(const bench_world *b, const question *q, answer *a) {
    return talus_world_at_point(&b->world, q->pose.position, NULL, &a->hits);
}

/* --- the same of one box --- */

static gltf_double3 seen_from(const thing *t, talus_vec3 point) {
    return gltf_rotate(gltf_conjugate(gltf_of_quat(t->pose.rotation)),
                       gltf_sub3(gltf_of_vec3(point), gltf_of_vec3(t->pose.position)));
}

/* Between which parts of the way an interval from -half to half is met. */
static void cut(double from, double way, double half, double *enter, double *leave) {
    if (way == 0) {
        *leave = fabs(from) <= half ? *leave : -1;
        return;
    }
    double a = (-half - from) / way, b = (half - from) / way;
    *enter = fmax(*enter, fmin(a, b));
    *leave = fmin(*leave, fmax(a, b));
}

static int look_along(const bench_world *b, const question *q, const thing *t, double *at) {
    gltf_double3 from = seen_from(t, q->ray.origin), half = gltf_of_vec3(t->convex.geometry.half);
    gltf_double3 way = gltf_rotate(gltf_conjugate(gltf_of_quat(t->pose.rotation)), gltf_of_vec3(q->ray.way));
    double leave = 1;
    (void)b;
    *at = 0;
    cut(from.x, way.x, half.x, at, &leave);
    cut(from.y, way.y, half.y, at, &leave);
    cut(from.z, way.z, half.z, at, &leave);
    return *at <= leave;
}

static int look_bisecting(const talus_convex *shape, const question *q, const thing *t, double *at) {
    talus_motion still;
    talus_contact_time time;
    memset(&still, 0, sizeof still);
    still.pose = t->pose;
    talus_status status =
        talus_time_of_contact(shape, &q->motion, &t->convex, &still, TOLERANCE, TALUS_BISECTION, NULL, &time);
    *at = time.time;
    return status == TALUS_OK && time.status != TALUS_TIME_MISS;
}
static int look_ball(const bench_world *b, const question *q, const thing *t, double *at) {
    return look_bisecting(&b->ball, q, t, at);
}
static int look_cube(const bench_world *b, const question *q, const thing *t, double *at) {
    return look_bisecting(&b->cube, q, t, at);
}

static int look_around(const bench_world *b, const question *q, const thing *t, double *at) {
    talus_separation s;
    talus_status status = talus_distance(&b->cube, &q->pose, &t->convex, &t->pose, NULL, &s);
    *at = (double)s.distance;
    return status == TALUS_OK && *at <= (double)REACH;
}
static int look_within(const bench_world *b, const question *q, const thing *t, double *at) {
    return look_around(b, q, t, at) && *at <= 0;
}

static int look_from_point(const bench_world *b, const question *q, const thing *t, double *at) {
    gltf_double3 p = seen_from(t, q->pose.position), half = gltf_of_vec3(t->convex.geometry.half);
    (void)b;
    *at = gltf_length3(gltf_d3(fmax(fabs(p.x) - half.x, 0), fmax(fabs(p.y) - half.y, 0), fmax(fabs(p.z) - half.z, 0)));
    return *at <= (double)REACH;
}
static int look_at_point(const bench_world *b, const question *q, const thing *t, double *at) {
    return look_from_point(b, q, t, at) && *at <= 0;
}

static int look_in_box(const bench_world *b, const question *q, const thing *t, double *at) {
    talus_aabb own;
    const talus_aabb *o = &q->box;
    *at = 0;
    return talus_shape_get_aabb(&b->world, t->shape, &own) == TALUS_OK && own.lower.x <= o->upper.x &&
           o->lower.x <= own.upper.x && own.lower.y <= o->upper.y && o->lower.y <= own.upper.y &&
           own.lower.z <= o->upper.z && o->lower.z <= own.upper.z;
}

static const method methods[BENCH_WORLD_ROWS] = {
    {"ray", "ray: the first hit", 1, ray, look_along, 1},
    {"ray-any", "ray: whether one hits", 1, ray_any, look_along, 1},
    {"ray-all", "ray: all hits", 0, ray_all, look_along, 1},
    {"cast-ball", "cast: a ball", 1, cast_ball, look_ball, 1},
    {"cast-box", "cast: a box that turns", 1, cast_cube, look_cube, 1},
    {"closest", "closest to a box", 1, closest, look_around, 0},
    {"closest-to-point", "closest to a point", 1, closest_to_point, look_from_point, 0},
    {"overlap", "overlap with a box", 0, overlap, look_within, 0},
    {"overlap-aabb", "boxes in a box", 0, overlap_aabb, look_in_box, 0},
    {"at-point", "what holds a point", 0, at_point, look_at_point, 0},
};

/* --- the world --- */

static talus_vec3 draw(parts_random *random, double half, double low, double high) {
    talus_vec3 v;
    v.x = (float)parts_uniform(random, 3.5 - half, 3.5 + half); /* the pile stands on 0 to 7 */
    v.y = (float)parts_uniform(random, low, high);
    v.z = (float)parts_uniform(random, 3.5 - half, 3.5 + half);
    return v;
}

static void make_questions(bench_world *b) {
    parts_random random = {17};
    for (uint32_t i = 0; i < QUERIES; i++) {
        question *q = &b->asked[i];
        talus_vec3 to = draw(&random, 5, 0, 4), from = draw(&random, 20, 4, 20);
        gltf_double4 turn = parts_rotation(&random);
        memset(q, 0, sizeof *q);
        q->ray.origin = from;
        q->ray.way.x = 1.5f * (to.x - from.x), q->ray.way.y = 1.5f * (to.y - from.y);
        q->ray.way.z = 1.5f * (to.z - from.z);
        q->motion.pose.position = from;
        q->motion.pose.rotation = q->pose.rotation = gltf_quat(turn);
        q->motion.translation = q->ray.way;
        q->motion.rotation.y = 1.0f;
        q->pose.position = draw(&random, 6, 0.2, 6);
        q->box.lower = q->box.upper = q->pose.position;
        q->box.lower.x -= 0.5f, q->box.lower.y -= 0.5f, q->box.lower.z -= 0.5f;
        q->box.upper.x += 0.5f, q->box.upper.y += 0.5f, q->box.upper.z += 0.5f;
    }
}

static int take_thing(bench_world *b, const talus_query_hit *hit) {
    talus_geometry geometry;
    thing *t = &b->things[b->thing_count++];
    int is_ground = hit->body.index == talus_world_ground(&b->world).index;
    memset(&geometry, 0, sizeof geometry);
    geometry.type = TALUS_BOX;
    geometry.half.x = geometry.half.z = is_ground ? 100.0f : 0.5f; /* as feature_make made them */
    geometry.half.y = is_ground ? 1.0f : 0.5f;
    t->shape = hit->shape;
    if (talus_body_get_pose(&b->world, hit->body, &t->pose) != TALUS_OK) {
        return -1;
    }
    t->pose.position.y -= is_ground ? 1.0f : 0.0f;
    return talus_convex_init(&geometry, NULL, 0, &t->convex) == TALUS_OK ? 0 : -1;
}

/* All that the world holds. */
static int take_things(bench_world *b, uint32_t boxes) {
    static talus_query_hit all[MOST_THINGS];
    talus_aabb everywhere = {{-1e4f, -1e4f, -1e4f}, {1e4f, 1e4f, 1e4f}};
    talus_hits hits = {all, MOST_THINGS, 0};
    if (talus_world_overlap_aabb(&b->world, &everywhere, NULL, &hits) != TALUS_OK || hits.count != boxes + 1) {
        return -1;
    }
    for (uint32_t i = 0; i < hits.count; i++) {
        if (take_thing(b, &all[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

/* The boxes, dropped and left alone. */
static int make_world(bench_world *b, uint32_t boxes, uint32_t steps) {
    feature_scene pile = feature_scenes[1];
    talus_geometry ball, cube;
    pile.bodies = boxes;
    if (feature_make(&pile, &features[0], 0, 0, &b->world, &b->memory) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < steps; i++) {
        if (talus_world_step(&b->world, 1.0f / 60.0f, NULL, NULL) != TALUS_OK) {
            return -1;
        }
    }
    memset(&ball, 0, sizeof ball);
    memset(&cube, 0, sizeof cube);
    ball.type = TALUS_SPHERE, ball.radius = 0.25f;
    cube.type = TALUS_BOX, cube.half.x = 0.3f, cube.half.y = 0.2f, cube.half.z = 0.25f;
    make_questions(b);
    return talus_convex_init(&ball, NULL, 0, &b->ball) == TALUS_OK &&
                   talus_convex_init(&cube, NULL, 0, &b->cube) == TALUS_OK
               ? take_things(b, boxes)
               : -1;
}

/* --- times and errors --- */

static int time_of(const bench_world *b, const method *m, double *ns, double *found) {
    answer a;
    uint64_t count = 0, start = host_clock_ns();
    int status = 0;
    a.hits.hits = a.hit, a.hits.capacity = MOST_HITS;
    for (uint32_t i = 0; i < QUERIES; i++) {
        status |= m->ask(b, &b->asked[i], &a) != TALUS_OK;
        count += a.hits.count;
    }
    *ns = (double)(host_clock_ns() - start) / QUERIES;
    *found = (double)count / QUERIES;
    return status ? -1 : 0;
}

/* Holds an answer against all things one by one: which they are, and how far off (m) the first stands. */
static int judge(const bench_world *b, const method *m, const question *q, int *wrong, double *off) {
    static answer a; /* large */
    double least = HUGE_VAL;
    uint32_t count = 0, missed = 0;
    a.hits.hits = a.hit, a.hits.capacity = MOST_HITS;
    memset(a.hit, 0, sizeof a.hit);
    if (m->ask(b, q, &a) != TALUS_OK || a.hits.count > MOST_HITS) {
        return -1;
    }
    for (uint32_t i = 0; i < b->thing_count; i++) {
        double at = 0;
        if (m->look(b, q, &b->things[i], &at)) {
            uint32_t k = 0;
            count++;
            least = fmin(least, at);
            while (k < a.hits.count && a.hit[k].shape.index != b->things[i].shape.index) {
                k++;
            }
            missed += k == a.hits.count;
        }
    }
    *off = 0;
    *wrong = m->first ? (count > 0) != (a.hits.count > 0) : missed > 0 || count != a.hits.count;
    if (m->ask != ray_any && count > 0 && a.hits.count > 0) {
        double length = gltf_length3(gltf_of_vec3(q->ray.way));
        *off = fabs(a.hit[0].at - (m->first || m->by_way ? least : 0)) * (m->by_way ? length : 1);
    }
    return 0;
}

static int take_row(const bench_world *b, const method *m, bench_world_row *row, double *times, uint32_t runs) {
    uint32_t every = QUERIES / REFERENCES, wrongs = 0;
    row->name = m->name;
    row->label = m->label;
    qsort(times, runs, sizeof *times, figures_compare);
    row->least = times[0];
    row->median = times[runs / 2];
    row->spread = times[runs * 3 / 4] - times[runs / 4];
    for (uint32_t i = 0; i < QUERIES; i += every) {
        int wrong = 0;
        double off = 0;
        if (judge(b, m, &b->asked[i], &wrong, &off) != 0) {
            return -1;
        }
        wrongs += wrong != 0;
        row->most_error = off > row->most_error ? off : row->most_error;
    }
    row->wrong = (double)wrongs / REFERENCES;
    return 0;
}

int bench_world_take(bench_world_table *t, int quick) {
    bench_world *b = calloc(1, sizeof *b);
    double times[BENCH_WORLD_ROWS][MOST_RUNS];
    memset(t, 0, sizeof *t);
    t->boxes = quick ? 100 : 1000;
    t->runs = quick ? 2 : MOST_RUNS;
    int status = b == NULL ? -1 : make_world(b, t->boxes, quick ? 100 : 500);
    /* the queries take turns, so that a mood of the machine meets all of them */
    for (uint32_t run = 0; run < t->runs && status == 0; run++) {
        for (uint32_t i = 0; i < BENCH_WORLD_ROWS; i++) {
            status |= time_of(b, &methods[i], &times[i][run], &t->rows[i].found);
        }
    }
    for (; t->count < BENCH_WORLD_ROWS && status == 0; t->count++) {
        status = take_row(b, &methods[t->count], &t->rows[t->count], times[t->count], t->runs);
    }
    if (b != NULL) {
        free(b->memory);
    }
    free(b);
    return status;
}

/* --- telling --- */

void bench_world_print(const bench_world_table *t, gltf_text *out) {
    gltf_text_add(out, "A world of %" PRIu32 " boxes in a pile: ns a query (the least of %" PRIu32 " runs)\n\n",
                  t->boxes, t->runs);
    gltf_text_add(out, "%-24s %9s %9s %9s %9s %9s %12s\n", "", "ns", "median", "spread", "shapes", "wrong",
                  "off by, m");
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_world_row *r = &t->rows[i];
        gltf_text_add(out, "%-24s %9.0f %9.0f %9.0f %9.2f %8.1f%% %12.1e\n", r->label, r->least, r->median, r->spread,
                      r->found, 100 * r->wrong, r->most_error);
    }
    gltf_text_add(out,
                  "\nWrong is what finds other shapes than looking at each alone; off by: how far along the way, or "
                  "nearer,\nthe first one then stands (m, the most).\n");
}

void bench_world_json(const bench_world_table *t, gltf_text *out) {
    gltf_text_add(out, "\"world\":{\"boxes\":%" PRIu32 ",\"runs\":%" PRIu32 ",\"rows\":[", t->boxes, t->runs);
    for (uint32_t i = 0; i < t->count; i++) {
        const bench_world_row *r = &t->rows[i];
        gltf_text_add(out,
                      "%s{\"query\":\"%s\",\"ns\":%.1f,\"ns_median\":%.1f,\"ns_spread\":%.1f,\"found\":%.3f,"
                      "\"wrong\":%.4f,\"error_most_m\":%.3e}",
                      i > 0 ? "," : "", r->name, r->least, r->median, r->spread, r->found, r->wrong, r->most_error);
    }
    gltf_text_add(out, "]}");
}
