/* Time of contact of random motions, in double and with other sines: free of overlap at many times before the contact,
 * each proven by a separating direction over all vertices; at the contact, apart by no more than the tolerance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "collide/advance.h"
#include "query_kit.h"

#define SAMPLES 200

typedef struct tally {
    long hits, misses, touching, unfinished, wrong;
    unsigned long long queries;
    uint32_t most;
} tally;

static talus_motion draw_motion(double size, float far, float spin) {
    talus_motion m;
    m.pose = brute_pose(0.0f, far * (float)size);
    m.center = tl_scale(brute_vector(-0.3f, 0.3f), (float)size);
    talus_vec3 aim = tl_scale(brute_vector(-0.3f, 0.3f), (float)size);
    m.translation = tl_scale(tl_sub(aim, m.pose.position), brute_range(0.2f, 2.5f));
    m.rotation = brute_direction();
    m.rotation = tl_scale(m.rotation, brute_range(0.0f, spin));
    return m;
}

/* Where the shape is, by libm. */
static d_pose placed(const talus_motion *m, double time) {
    d_pose start = d_pose_of(&m->pose), p;
    d3 w = d3_of(m->rotation), k = d3_unit(w), *from = &start.x, *to = &p.x;
    double angle = d3_length(w) * time;
    for (int i = 0; i < 3; ++i) {
        d3 v = from[i];
        to[i] = d3_add(d3_add(d3_scale(v, cos(angle)), d3_scale(d3_cross(k, v), sin(angle))),
                       d3_scale(k, d3_dot(k, v) * (1.0 - cos(angle))));
    }
    d3 center = d3_of(m->center), at = d3_add(d_rotate(&start, center), start.t);
    p.t = d3_sub(d3_add(at, d3_scale(d3_of(m->translation), time)), d_rotate(&p, center));
    return p;
}

static tl_d3 turned_back(const d_pose *a, d3 v) {
    d3 r = d_rotate_back(a, v);
    return tl_d(r.x, r.y, r.z);
}

static void relative(const talus_motion *ma, const talus_motion *mb, double time, d_pair *pair, d_pose *pose_a,
                     tl_frame *frame) {
    d_pose b = placed(mb, time);
    *pose_a = placed(ma, time);
    frame->x = turned_back(pose_a, b.x);
    frame->y = turned_back(pose_a, b.y);
    frame->z = turned_back(pose_a, b.z);
    frame->t = turned_back(pose_a, d3_sub(b.t, pose_a->t));
    memcpy(&pair->pose, frame, sizeof pair->pose);
}

/* The separation at a time along the direction that a cold query finds. */
static double separation(const kit_pair *p, const tl_moving *a, const tl_moving *b, const talus_motion *ma,
                         const talus_motion *mb, double time) {
    d_pair pair = {p->a, p->b, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    d_pose pose_a;
    tl_frame frame;
    talus_feature_pair none = {0, 0};
    tl_closest c;
    relative(ma, mb, time, &pair, &pose_a, &frame);
    tl_closest_find(&a->core, &b->core, &frame, none, &c);
    return c.cores_apart ? d_separation(&pair, d3_make(c.normal.x, c.normal.y, c.normal.z)) : -1e300;
}

static void one(talus_time_method method, const kit_pair *p, const talus_motion *ma, const talus_motion *mb,
                float tolerance, uint64_t seed, tally *t) {
    static tl_moving a, b;
    talus_feature_pair none = {0, 0};
    talus_contact_time r;
    tl_moving_init(&a, p->a, ma);
    tl_moving_init(&b, p->b, mb);
    tl_advance(&a, &b, tolerance, 1.0, method, &none, &r);
    t->queries += r.queries;
    t->most = r.queries > t->most ? r.queries : t->most;
    t->hits += r.status == TALUS_TIME_HIT;
    t->misses += r.status == TALUS_TIME_MISS;
    t->touching += r.status == TALUS_TIME_TOUCHING;
    t->unfinished += r.status == TALUS_TIME_UNFINISHED;
    double slack = 1e-6 * p->size, within = fmax((double)tolerance, 4e-6 * p->size);
    double at = separation(p, &a, &b, ma, mb, r.time), least = 1e300, when = 0.0;
    int bad = 0;
    if (r.status == TALUS_TIME_HIT) {
        double apart = d3_length(d3_sub(d3_of(r.point_b), d3_of(r.point_a)));
        bad = !(at > 0.0 && at <= within + slack && fabs(apart - at) <= slack + 1e-6 * p->size);
    } else if (r.status == TALUS_TIME_TOUCHING) {
        bad = at > within + slack || r.time != 0.0;
    }
    for (int i = 0; i <= SAMPLES && r.status != TALUS_TIME_TOUCHING; ++i) {
        /* half of the samples crowd towards the end */
        double x = (double)i / SAMPLES, time = r.time * (i & 1 ? x : 1.0 - (1.0 - x) * (1.0 - x) * (1.0 - x));
        double s = separation(p, &a, &b, ma, mb, time);
        if (s < least) {
            least = s, when = time;
        }
    }
    bad = bad || least <= 0.0;
    if (bad && t->wrong++ < 10) {
        printf("  seed %llu: method %d status %d time %.9g of %u queries: separation there %.3g, least %.3g at %.9g, "
               "tolerance %.3g size %.3g\n",
               (unsigned long long)seed, (int)method, (int)r.status, r.time, r.queries, at, least, when, within,
               p->size);
    }
}

static void random_motions(void **state) {
    (void)state;
    static const struct {
        const char *name;
        float far, spin, tolerance;
    } kind[] = {{"slide", 4.0f, 0.0f, 1e-4f},
                {"tumble", 4.0f, 1.0f, 1e-4f},
                {"half turn", 4.0f, 3.1415925f, 1e-4f},
                {"spin close by", 1.2f, 3.1415925f, 1e-3f},
                {"fine", 2.0f, 1.0f, 1e-5f}};
    const char *text = getenv("TALUS_QUERY_MOTIONS");
    int count = text ? atoi(text) : 300;
    for (size_t k = 0; k < sizeof kind / sizeof *kind; ++k) {
        tally t[2];
        memset(t, 0, sizeof t);
        for (int i = 0; i < count; ++i) {
            uint64_t seed = brute_state;
            kit_pair p = kit_draw();
            double small = fmin(d_size(p.a), d_size(p.b)), large = fmax(d_size(p.a), d_size(p.b));
            if (large > 100.0 * small) {
                continue; /* the tolerance is a part of the larger one */
            }
            talus_motion ma = draw_motion(p.size, kind[k].far, kind[k].spin);
            talus_motion mb = draw_motion(p.size, kind[k].far, kind[k].spin);
            for (int m = 0; m < 2; ++m) {
                one((talus_time_method)m, &p, &ma, &mb, kind[k].tolerance * (float)p.size, seed, &t[m]);
            }
        }
        for (int m = 0; m < 2; ++m) {
            long all = t[m].hits + t[m].misses + t[m].touching + t[m].unfinished;
            printf("  %-13s %s: %ld hits, %ld misses, %ld touching, %ld unfinished; %.1f queries, at most %u\n",
                   kind[k].name, m ? "bisection  " : "advancement", t[m].hits, t[m].misses, t[m].touching,
                   t[m].unfinished, (double)t[m].queries / (double)(all ? all : 1), t[m].most);
            assert_int_equal(t[m].wrong, 0);
            assert_int_equal(t[m].unfinished, 0);
            assert_true(t[m].hits > 0 && t[m].misses > 0);
        }
    }
}

/* Small spheres from afar, at a speed that asks bisection for intervals of 2^-40 and shorter. */
static void far_and_fast(void **state) {
    (void)state;
    static tl_moving a, b;
    tl_convex ball;
    memset(&ball, 0, sizeof ball);
    ball.geometry.type = TALUS_SPHERE;
    ball.geometry.radius = 0.01f;
    talus_motion still, shot;
    memset(&still, 0, sizeof still);
    still.pose.rotation.w = 1.0f;
    shot = still;
    shot.pose.position.x = -1e5f;
    shot.translation.x = 3e5f;
    tl_moving_init(&a, &ball, &shot);
    tl_moving_init(&b, &ball, &still);
    for (int m = 0; m < 2; ++m) {
        talus_feature_pair none = {0, 0};
        talus_contact_time r;
        tl_advance(&a, &b, 0.0f, 1.0, (talus_time_method)m, &none, &r);
        assert_int_equal(r.status, TALUS_TIME_HIT);
        assert_true(fabs(r.time * 3e5 - (1e5 - 0.02)) <= 1e-6);
    }
}

int main(void) {
    brute_seed("advance_test");
    kit_build();
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_motions), cmocka_unit_test(far_and_fast)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
