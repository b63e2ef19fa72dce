/* The public queries: what they refuse, every kind of shape against every other, frames, and closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "query_kit.h"
#include "talus/talus.h"

static talus_convex convex_of(const tl_convex *s) {
    talus_convex c;
    talus_geometry g = s->geometry;
    size_t bytes = s->hull ? talus_hull_size(s->hull) : 0u;
    g.hull = 0u;
    assert_int_equal(talus_convex_init(&g, s->hull, bytes, &c), TALUS_OK);
    assert_ptr_equal(c.hull, s->hull);
    return c;
}

static talus_geometry ball(float radius) {
    talus_geometry g;
    memset(&g, 0, sizeof g);
    g.type = TALUS_SPHERE;
    g.radius = radius;
    return g;
}

static talus_geometry capsule(float half_height, float radius) {
    talus_geometry g = ball(radius);
    g.type = TALUS_CAPSULE;
    g.half_height = half_height;
    g.radius_top = g.radius_bottom = radius;
    return g;
}

static talus_pose at(float x, float y, float z) {
    talus_pose p = tl_pose_identity();
    p.position = tl_v(x, y, z);
    return p;
}

static void refusals(void **state) {
    (void)state;
    talus_geometry g = ball(0.5f);
    talus_convex c;
    assert_int_equal(talus_convex_init(NULL, NULL, 0, &c), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_convex_init(&g, NULL, 0, NULL), TALUS_BAD_ARGUMENT);
    g.radius = -1.0f;
    assert_int_equal(talus_convex_init(&g, NULL, 0, &c), TALUS_BAD_SHAPE);
    g.radius = NAN;
    assert_int_equal(talus_convex_init(&g, NULL, 0, &c), TALUS_NOT_FINITE);
    g.type = TALUS_HULL;
    g.hull = 0;
    assert_int_equal(talus_convex_init(&g, NULL, 0, &c), TALUS_BAD_BLOB);
    const talus_hull *hull = brute_hull(20, tl_v(1.0f, 1.0f, 1.0f));
    assert_int_equal(talus_convex_init(&g, hull, talus_hull_size(hull) - 1u, &c), TALUS_BAD_BLOB);
    g.hull = 4;
    assert_int_equal(talus_convex_init(&g, hull, talus_hull_size(hull), &c), TALUS_BAD_BLOB);
    g = ball(0.5f);
    assert_int_equal(talus_convex_init(&g, NULL, 0, &c), TALUS_OK);

    talus_pose good = at(0.0f, 0.0f, 0.0f), nan = at(NAN, 0.0f, 0.0f), far = at(2e9f, 0.0f, 0.0f), none = good;
    none.rotation.w = 0.0f;
    const struct {
        const talus_pose *pose;
        talus_status status;
    } poses[] = {
        {NULL, TALUS_BAD_ARGUMENT}, {&nan, TALUS_NOT_FINITE}, {&far, TALUS_BAD_ARGUMENT}, {&none, TALUS_BAD_ARGUMENT}};
    talus_separation s;
    talus_depth d;
    talus_contact_time t;
    memset(&s, 0x5a, sizeof s);
    memset(&d, 0x5a, sizeof d);
    memset(&t, 0x5a, sizeof t);
    talus_separation s0 = s;
    talus_depth d0 = d;
    talus_contact_time t0 = t;
    talus_motion still = {good, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (size_t i = 0; i < sizeof poses / sizeof *poses; ++i) {
        talus_motion m = still;
        assert_int_equal(talus_distance(&c, poses[i].pose, &c, &good, NULL, &s), poses[i].status);
        assert_int_equal(talus_distance(&c, &good, &c, poses[i].pose, NULL, &s), poses[i].status);
        assert_int_equal(talus_penetration(&c, poses[i].pose, &c, &good, TALUS_DEPTH_LOCAL, NULL, &d), poses[i].status);
        m.pose = poses[i].pose ? *poses[i].pose : good;
        assert_int_equal(
            talus_time_of_contact(&c, poses[i].pose ? &m : NULL, &c, &still, 1e-3f, TALUS_ADVANCEMENT, NULL, &t),
            poses[i].status);
        assert_int_equal(
            talus_time_of_contact(&c, &still, &c, poses[i].pose ? &m : NULL, 1e-3f, TALUS_ADVANCEMENT, NULL, &t),
            poses[i].status);
    }
    assert_int_equal(talus_distance(NULL, &good, &c, &good, NULL, &s), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_distance(&c, &good, NULL, &good, NULL, &s), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_distance(&c, &good, &c, &good, NULL, NULL), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_penetration(&c, &good, &c, &good, TALUS_DEPTH_MODE_COUNT, NULL, &d), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_of_contact(&c, &still, &c, &still, 0.0f, TALUS_ADVANCEMENT, NULL, &t),
                     TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_time_of_contact(&c, &still, &c, &still, NAN, TALUS_ADVANCEMENT, NULL, &t), TALUS_NOT_FINITE);
    assert_int_equal(talus_time_of_contact(&c, &still, &c, &still, 1.0f, TALUS_TIME_METHOD_COUNT, NULL, &t),
                     TALUS_BAD_ARGUMENT);
    talus_motion wild = still;
    wild.rotation = tl_v(0.0f, 3.2f, 0.0f);
    assert_int_equal(talus_time_of_contact(&c, &wild, &c, &still, 1.0f, TALUS_ADVANCEMENT, NULL, &t),
                     TALUS_BAD_ARGUMENT);
    wild.rotation = tl_v(0.0f, INFINITY, 0.0f);
    assert_int_equal(talus_time_of_contact(&c, &wild, &c, &still, 1.0f, TALUS_ADVANCEMENT, NULL, &t), TALUS_NOT_FINITE);
    assert_memory_equal(&s, &s0, sizeof s);
    assert_memory_equal(&d, &d0, sizeof d);
    assert_memory_equal(&t, &t0, sizeof t);
}

static int failures;

/* One pair of any kinds: points, normal and distance or depth prove one another. */
static void prove(int ka, int kb, int proven_mode) {
    uint64_t seed = brute_state;
    tl_convex a = brute_shape(ka, 0.3f, 1.0f), b = brute_shape(kb, 0.3f, 1.0f);
    talus_convex ca = convex_of(&a), cb = convex_of(&b);
    talus_pose pose_a = brute_pose(0.0f, 10.0f), b_in_a = brute_pose(0.1f, 2.6f);
    talus_pose pose_b = tl_pose_mul(&pose_a, &b_in_a);
    d_pose da = d_pose_of(&pose_a), db = d_pose_of(&pose_b);
    d_pair pair = {&a,
                   &b,
                   {d_rotate_back(&da, db.x), d_rotate_back(&da, db.y), d_rotate_back(&da, db.z),
                    d_rotate_back(&da, d3_sub(db.t, da.t))}};
    int round = ka == BRUTE_TAPERED || ka == BRUTE_CYLINDER || ka == BRUTE_CONE || kb == BRUTE_TAPERED ||
                kb == BRUTE_CYLINDER || kb == BRUTE_CONE;
    double size = d_size(&a) + d_size(&b), slack = (round ? 4e-6 : 1e-6) * size + 2e-6 /* floats 10 m out */;
    talus_separation s;
    talus_depth d;
    talus_feature_pair features = {0u, 0u};
    assert_int_equal(talus_distance(&ca, &pose_a, &cb, &pose_b, &features, &s), TALUS_OK);
    talus_depth_mode mode = proven_mode ? TALUS_DEPTH_PROVEN : TALUS_DEPTH_LOCAL;
    assert_int_equal(talus_penetration(&ca, &pose_a, &cb, &pose_b, mode, NULL, &d), TALUS_OK);
    const char *bad = NULL;
    d3 pa = d_rotate_back(&da, d3_sub(d3_of(s.point_a), da.t)), pb = d_rotate_back(&db, d3_sub(d3_of(s.point_b), db.t));
    double capsule_slack = slack + 1e-4; /* d_outside samples a capsule's axis */
    if (d_outside(&a, pa) > capsule_slack || d_outside(&b, pb) > capsule_slack) {
        bad = "a closest point is outside of its shape";
    }
    if (s.overlap != d.overlap) {
        bad = "distance and depth see an overlap differently";
    } else if (!s.overlap) {
        double low = d_separation(&pair, d_rotate_back(&da, d3_of(s.normal)));
        double high = d3_length(d3_sub(d3_of(s.point_b), d3_of(s.point_a)));
        double tolerance = 1e-5 * (double)s.distance + slack;
        if (fabs(low - (double)s.distance) > tolerance || fabs(high - (double)s.distance) > tolerance) {
            bad = "a distance is wrong";
        }
    } else {
        d3 n = d_rotate_back(&da, d3_of(d.normal));
        double out = -d_separation(&pair, n), best = -d_best_separation(&a, &b, &b_in_a, NULL);
        double tolerance = 1e-5 * out + slack + (round ? 2e-4 : 0.0);
        d3 between = d3_sub(d3_sub(d3_of(d.point_a), d3_of(d.point_b)), d3_scale(d3_of(d.normal), (double)d.depth));
        if (fabs(out - (double)d.depth) > tolerance || fabs(d3_length(d3_of(d.normal)) - 1.0) > 1e-5) {
            bad = "a depth is no way out";
        } else if (d3_length(between) > 10.0 * tolerance) {
            bad = "the points of a depth are not where it says";
        } else if ((d.proven || round) && (double)d.depth > best + tolerance + (round ? 2e-3 * best : 0.0)) {
            bad = "a depth is not the least";
        } else if (proven_mode && !d.proven && !round) {
            bad = "a depth is not proven";
        }
    }
    if (bad && failures++ < 20) {
        printf("  %s-%s seed %llu: %s: distance %.9g depth %.9g\n", brute_kind_name[ka], brute_kind_name[kb],
               (unsigned long long)seed, bad, (double)s.distance, (double)d.depth);
    }
}

static void all_kinds(void **state) {
    (void)state;
    failures = 0;
    for (int ka = 0; ka < BRUTE_KINDS; ++ka) {
        for (int kb = 0; kb < BRUTE_KINDS; ++kb) {
            for (int i = 0; i < 12; ++i) {
                prove(ka, kb, i & 1);
            }
        }
    }
    assert_int_equal(failures, 0);
}

static void closed_forms(void **state) {
    (void)state;
    talus_geometry small = ball(0.25f), rod = capsule(1.0f, 0.125f);
    talus_convex s, r;
    talus_depth d;
    talus_separation c;
    talus_contact_time t;
    assert_int_equal(talus_convex_init(&small, NULL, 0, &s), TALUS_OK);
    assert_int_equal(talus_convex_init(&rod, NULL, 0, &r), TALUS_OK);
    talus_pose here = at(0.0f, 0.0f, 0.0f), near = at(0.375f, 0.0f, 0.0f), far = at(0.0f, 0.0f, 8.0f);
    talus_pose across = at(0.0f, 0.0f, 0.0f);
    across.rotation.x = 3.0f, across.rotation.w = 3.0f; /* a right angle, unnormalised */

    assert_int_equal(talus_distance(&s, &here, &s, &far, NULL, &c), TALUS_OK);
    assert_true(c.distance == 7.5f && c.normal.z == 1.0f && c.point_a.z == 0.25f && c.point_b.z == 7.75f);
    assert_int_equal(talus_penetration(&s, &here, &s, &near, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
    assert_true(d.depth == 0.125f && d.normal.x == 1.0f && d.proven && d.point_a.x == 0.25f && d.point_b.x == 0.125f);
    /* centres and axes that meet */
    assert_int_equal(talus_penetration(&s, &here, &s, &here, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
    assert_true(d.depth == 0.5f && d.overlap && fabsf(tl_length(d.normal) - 1.0f) < 1e-6f);
    assert_int_equal(talus_penetration(&r, &here, &r, &across, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
    assert_true(d.depth == 0.25f && fabsf(fabsf(d.normal.x) - 1.0f) < 1e-6f);
    assert_int_equal(talus_penetration(&r, &here, &r, &here, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
    assert_true(d.depth == 0.25f && fabsf(d.normal.y) < 1e-6f);
    assert_int_equal(talus_penetration(&s, &here, &s, &far, TALUS_DEPTH_PROVEN, NULL, &d), TALUS_OK);
    assert_true(!d.overlap && d.depth == 0.0f);

    /* two balls towards one another; a rod that swings into a ball by a quarter turn: asin of 0.375 before it is flat
     */
    talus_motion one = {here, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.5f}, {0.0f, 0.0f, 0.0f}};
    talus_motion other = {far, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -7.5f}, {0.0f, 0.0f, 0.0f}};
    for (int m = 0; m < TALUS_TIME_METHOD_COUNT; ++m) {
        assert_int_equal(talus_time_of_contact(&s, &one, &s, &other, 1e-5f, (talus_time_method)m, NULL, &t), TALUS_OK);
        assert_int_equal(t.status, TALUS_TIME_HIT);
        assert_true(fabs(t.time - 0.75) < 2e-6 && t.gap > 0.0f && t.gap <= 1e-5f && t.normal.z == 1.0f);
        talus_motion swing = {here, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {1.5707963f, 0.0f, 0.0f}};
        talus_motion target = {at(0.0f, 0.0f, 1.0f), {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
        assert_int_equal(talus_time_of_contact(&r, &swing, &s, &target, 1e-5f, (talus_time_method)m, NULL, &t),
                         TALUS_OK);
        double expected = 1.0 - asin(0.375) / 1.5707963267948966;
        assert_int_equal(t.status, TALUS_TIME_HIT);
        assert_true(t.time <= expected && t.time > expected - 4e-5);
    }
}

static talus_pose moved(const talus_motion *m, float time) {
    talus_pose pose = m->pose;
    float angle = tl_length(m->rotation) * time, sine = sinf(0.5f * angle);
    talus_vec3 k = tl_normalize_or(m->rotation, m->rotation);
    talus_quat q = {k.x * sine, k.y * sine, k.z * sine, cosf(0.5f * angle)};
    pose.rotation = tl_quat_normalize(tl_quat_mul(q, pose.rotation));
    pose.position = tl_mad(pose.position, time, m->translation);
    return pose;
}

/* Round shapes and boxes, some of them thin, fast past or into one another. */
static void round_motions(void **state) {
    (void)state;
    int hits = 0, misses = 0;
    for (int i = 0; i < 400; ++i) {
        static const int kinds[4] = {BRUTE_CYLINDER, BRUTE_CONE, BRUTE_TAPERED, BRUTE_BOX};
        int ka = kinds[brute_u32() & 3u], kb = kinds[brute_u32() % 3u];
        tl_convex a = brute_shape(ka, 0.02f, 1.0f), b = brute_shape(kb, 0.02f, 1.0f);
        talus_convex ca = convex_of(&a), cb = convex_of(&b);
        talus_motion ma = {brute_pose(5.0f, 30.0f), {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
        talus_motion mb = {brute_pose(0.0f, 2.0f), {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
        ma.translation = tl_scale(ma.pose.position, -2.0f);
        ma.rotation = brute_direction();
        ma.rotation = tl_scale(ma.rotation, brute_range(0.0f, 3.14f));
        talus_contact_time t;
        talus_separation s;
        assert_int_equal(talus_time_of_contact(&ca, &ma, &cb, &mb, 1e-4f, TALUS_ADVANCEMENT, NULL, &t), TALUS_OK);
        assert_true(t.status == TALUS_TIME_HIT || t.status == TALUS_TIME_MISS);
        hits += t.status == TALUS_TIME_HIT;
        misses += t.status == TALUS_TIME_MISS;
        for (int k = 0; k <= 100; ++k) {
            talus_pose pose = moved(&ma, (float)t.time * (float)k / 100.0f);
            assert_int_equal(talus_distance(&ca, &pose, &cb, &mb.pose, NULL, &s), TALUS_OK);
            assert_false(s.overlap);
        }
        if (t.status == TALUS_TIME_HIT) { /* floats 30 m out */
            assert_true(s.distance <= 1.2e-4f && t.gap > 0.0f && t.gap <= 1e-4f);
        }
    }
    printf("  %d hits, %d misses\n", hits, misses);
    assert_true(hits > 50 && misses > 50);
}

static int is_finite_all(const float *x, int count) {
    int finite = 1;
    for (int i = 0; i < count; ++i) {
        finite = finite && isfinite(x[i]);
    }
    return finite;
}

/* The smallest and largest sizes and places that are allowed, and hints of noise: finite answers of sound signs. */
static void extremes(void **state) {
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        talus_convex c[2];
        talus_pose pose[2];
        for (int k = 0; k < 2; ++k) {
            int kind = (int)(brute_u32() % BRUTE_HULL);
            tl_convex s = brute_shape(kind, 0.3f, 1.0f);
            talus_geometry *g = &s.geometry;
            float low = brute_u32() & 1u ? -5.0f : 3.0f;
            float x = kit_power(low, low + 2.0f), y = kit_power(low, low + 2.0f), z = kit_power(low, low + 2.0f);
            g->radius *= x, g->half_height *= y, g->radius_top *= x, g->radius_bottom *= x;
            g->half = tl_mul(g->half, tl_v(x, y, z));
            c[k] = convex_of(&s);
            pose[k] = brute_pose(0.0f, 1.0f);
            pose[k].position = tl_scale(pose[k].position, brute_u32() & 1u ? x : kit_power(-9.0f, 8.7f));
            pose[k].rotation.w *= 1e-3f;
        }
        talus_feature_pair hint;
        hint.a = brute_u32();
        hint.b = brute_u32();
        talus_separation s;
        talus_depth d;
        talus_contact_time t;
        assert_int_equal(talus_distance(&c[0], &pose[0], &c[1], &pose[1], &hint, &s), TALUS_OK);
        hint.a ^= brute_u32() & 0x3000fu;
        assert_int_equal(talus_penetration(&c[0], &pose[0], &c[1], &pose[1], TALUS_DEPTH_LOCAL, &hint, &d), TALUS_OK);
        assert_true(s.distance >= 0.0f && d.depth >= 0.0f && (s.distance > 0.0f) == !s.overlap);
        assert_true(is_finite_all(&s.distance, 1) && is_finite_all(&s.normal.x, 9));
        assert_true(is_finite_all(&d.depth, 1) && is_finite_all(&d.normal.x, 9));
        talus_motion m[2];
        for (int k = 0; k < 2; ++k) {
            m[k].pose = pose[k];
            m[k].center = tl_v(0.0f, 0.0f, 0.0f);
            m[k].translation = tl_sub(pose[!k].position, pose[k].position);
            m[k].rotation = tl_scale(brute_direction(), 3.1415925f);
        }
        assert_int_equal(talus_time_of_contact(&c[0], &m[0], &c[1], &m[1], 1e-6f, TALUS_ADVANCEMENT, &hint, &t),
                         TALUS_OK);
        assert_true(t.time >= 0.0 && t.time <= 1.0 && is_finite_all(&t.gap, 1) && is_finite_all(&t.normal.x, 9));
        assert_true(t.status == TALUS_TIME_TOUCHING || t.gap > 0.0f || t.status == TALUS_TIME_UNFINISHED);
    }
}

/* Edges of two boxes 7e-13 m apart: the difference of the points is of as many roundings as digits. */
static void a_hairs_breadth(void **state) {
    (void)state;
    talus_convex c[2];
    talus_geometry g[2];
    talus_pose pose[2] = {
        {{-0.894096375f, -0.894117832f, -0.894117832f}, {-0.894117832f, -0.894117832f, -0.894117832f, 3.99999952f}},
        {{3.99998426f, 3.99999952f, 3.99999952f}, {3.99999952f, 3.99999952f, 3.99999952f, -4.0f}}};
    memset(g, 0, sizeof g);
    g[0].type = g[1].type = TALUS_BOX;
    g[0].half = tl_v(3.99999952f, 3.99999952f, 3.99999952f);
    g[1].half = tl_v(0.894117832f, 0.894117832f, 0.894117832f);
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(talus_convex_init(&g[k], NULL, 0, &c[k]), TALUS_OK);
    }
    for (uint32_t i = 0; i < 24u * 24u; ++i) {
        talus_feature_pair hint = {TL_FEATURE(TL_FEATURE_EDGE, i % 24u), TL_FEATURE(TL_FEATURE_EDGE, i / 24u)};
        talus_separation s;
        assert_int_equal(talus_distance(&c[0], &pose[0], &c[1], &pose[1], &hint, &s), TALUS_OK);
        assert_true(s.distance < 4e-5f && (s.overlap || fabsf(tl_length(s.normal) - 1.0f) < 1e-6f));
    }
}

int main(void) {
    brute_seed("query_test");
    const struct CMUnitTest tests[] = {cmocka_unit_test(refusals),     cmocka_unit_test(all_kinds),
                                       cmocka_unit_test(closed_forms), cmocka_unit_test(round_motions),
                                       cmocka_unit_test(extremes),     cmocka_unit_test(a_hairs_breadth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
