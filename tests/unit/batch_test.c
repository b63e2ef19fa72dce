/* Pairs eight at a time: what the lanes of every instruction set here answer is, to the bit, what the query of a single
 * pair answers. */
#include "stage/kernels.h"
#include "stage/narrow/query.h"
#include "store_check.h"

#include <stdio.h>

#define BODIES 96u

static talus_quat any_turn(uint32_t *seed) {
    talus_quat q = {draw_float(seed, -1, 1), draw_float(seed, -1, 1), draw_float(seed, -1, 1),
                    draw_float(seed, 0.1f, 1)};
    return tl_quat_normalize(q);
}

/* Turned by a right angle about some axis, and a little. */
static talus_quat all_but_square(uint32_t *seed) {
    static const float tilts[] = {0.0f, 1e-6f, 1e-3f, 0.02f};
    float t = tilts[draw(seed) % 4u], turn = draw(seed) % 2u ? 1.0f : 0.0f;
    talus_quat q = {draw_float(seed, -t, t), draw_float(seed, -t, t), draw_float(seed, -t, t), 1.0f};
    uint32_t axis = draw(seed) % 3u;
    *(axis == 0u ? &q.x : axis == 1u ? &q.y : &q.z) += turn;
    return tl_quat_normalize(q);
}

/* Balls, boxes and capsules in a heap, turned, moving, off their bodies' centres; some cannot move. */
static talus_world fill(uint32_t *seed) {
    talus_world_def def = kit_small();
    def.body_capacity = def.shape_capacity = BODIES + 1u;
    talus_world world = kit_world(&def);
    for (uint32_t i = 0; i < BODIES; i++) {
        talus_body_def body = talus_body_def_default();
        talus_shape_def shape = talus_shape_def_default();
        talus_body b;
        talus_shape s;
        body.type = i % 5u ? TALUS_DYNAMIC : TALUS_STATIC;
        body.pose.position = kit_vec(draw_float(seed, -1, 1), draw_float(seed, -1, 1), draw_float(seed, -1, 1));
        body.pose.rotation = i % 4u < 2u ? any_turn(seed) : all_but_square(seed);
        body.linear_velocity = kit_vec(draw_float(seed, -9, 9), draw_float(seed, -9, 9), draw_float(seed, -9, 9));
        shape.geometry.type = i % 3u == 0u ? TALUS_SPHERE : i % 3u == 1u ? TALUS_BOX : TALUS_CAPSULE;
        shape.geometry.radius = draw_float(seed, 0.1f, 0.6f);
        shape.geometry.radius_top = shape.geometry.radius_bottom = draw_float(seed, 0.1f, 0.4f);
        shape.geometry.half_height = i % 8u ? draw_float(seed, 0.1f, 0.6f) : 0.0f;
        shape.geometry.half =
            kit_vec(draw_float(seed, 0.1f, 0.6f), draw_float(seed, 0.1f, 0.6f), draw_float(seed, 0.1f, 0.6f));
        shape.sensor = i % 7u == 0;
        if (draw(seed) % 3u) {
            shape.pose.position = kit_vec(draw_float(seed, -1, 1), draw_float(seed, -1, 1), 0.25f);
            shape.pose.rotation = i % 4u < 2u ? any_turn(seed) : all_but_square(seed);
        }
        OK(talus_body_create(&world, &body, &b));
        OK(talus_shape_create(&world, b, &shape, &s));
    }
    return world;
}

static void check_pose(const talus_pose *one, const tl_row8 *lane) {
    const float f[7] = {one->position.x, one->position.y, one->position.z, one->rotation.x,
                        one->rotation.y, one->rotation.z, one->rotation.w};
    assert_memory_equal(f, lane->f, sizeof f);
}

/* A point of a manifold in the frames of the bodies, as a contact keeps it, and the normal. */
static void check_point(const tl_header *h, const tl_query *q, const tl_manifold *m, uint32_t i, const tl_row8 *point,
                        const tl_row8 *normal) {
    const tl_manifold_point *p = &m->point[i];
    talus_pose a = tl_body_is_fixed(h, q->body_a) ? q->pa : tl_row_pose_of(&tl_shape_place(h)[q->shape_a]);
    talus_pose b = tl_body_is_fixed(h, q->body_b) ? q->pb : tl_row_pose_of(&tl_shape_place(h)[q->shape_b]);
    talus_vec3 half = tl_scale(m->normal, 0.5f * p->separation);
    talus_vec3 on_a = tl_pose_point(&a, tl_sub(p->position, half));
    talus_vec3 on_b = tl_pose_point(&b, tl_pose_point_back(&q->b_in_a, tl_add(p->position, half)));
    talus_vec3 n = tl_rotate(a.rotation, m->normal);
    assert_memory_equal(&on_a, point->f, sizeof on_a);
    assert_memory_equal(&on_b, point->f + 3, sizeof on_b);
    assert_memory_equal(&n, normal->f, sizeof n);
}

static void collide_one(const tl_step *step, const tl_pair_batch *batch, uint32_t k, tl_query *q, tl_manifold *m) {
    tl_pair_cache cold = {{0, 0, 0, 0}};
    *q = tl_query_of(step, batch->shape_a[k], batch->shape_b[k]);
    tl_collide(&q->a, &q->b, &q->b_in_a, q->margin, &cold, m);
}

/* Gives the contacts the points that come out, in the other order and all but the last, with impulses. */
static void set_old_points(const tl_header *h, const tl_pair_batch *batch, const tl_box_manifolds *out) {
    for (uint32_t k = 0; k < TL_LANES; k++) {
        tl_contact_points *old = &tl_points(h)[batch->item[k]];
        uint32_t count = (uint32_t)out->count[k];
        memset(old, 0, sizeof *old);
        for (uint32_t i = 0; i + 1u < count; i++) {
            memcpy(&old->p[count - 2u - i].id, &out->point[i][k].f[7], sizeof old->p[0].id);
            old->p[count - 2u - i].impulse = (float)(k + i + 1u);
        }
    }
}

/* Returns how many were not left to the query of a single pair. */
static uint32_t check_boxes(const tl_step *step, const tl_kernels *kernels, const tl_pair_batch *batch,
                            uint32_t *touching) {
    tl_box_manifolds out;
    uint32_t decided = 0;
    kernels->collide_boxes(step, batch, &out);
    set_old_points(step->h, batch, &out);
    kernels->collide_boxes(step, batch, &out);
    for (uint32_t k = 0; k < TL_LANES; k++) {
        tl_query q;
        tl_manifold m;
        collide_one(step, batch, k, &q, &m);
        if (!(out.decided >> k & 1u)) {
            continue;
        }
        decided++;
        assert_int_equal(m.count, (uint32_t)out.count[k]);
        assert_memory_equal(&m.gap, &out.gap[k], sizeof m.gap);
        for (uint32_t i = 0; i < m.count; i++) {
            const tl_row8 *p = &out.point[i][k];
            check_point(step->h, &q, &m, i, p, &out.normal[k]);
            assert_memory_equal(&m.point[i].id, &p->f[7], sizeof m.point[i].id);
            assert_true(p->f[6] == (i + 1u < m.count ? (float)(k + i + 1u) : 0.0f));
        }
        for (uint32_t i = m.count; m.count && i < TL_MANIFOLD_POINTS; i++) {
            const tl_row8 none = {{0}};
            assert_memory_equal(&none, &out.point[i][k], sizeof none);
        }
        *touching += m.count > 0;
    }
    return decided;
}

/* Returns how many were not left to the query of a single pair. */
static uint32_t check_batch(const tl_step *step, const tl_kernels *kernels, tl_pair_batch *batch, uint32_t *touching) {
    tl_one_points out;
    uint32_t decided = 0;
    kernels->place_pairs(step, batch);
    (batch->kind == TL_BATCH_CAPSULES ? kernels->collide_capsules : kernels->collide_balls)(step, batch, &out);
    for (uint32_t k = 0; k < TL_LANES; k++) {
        tl_query q;
        tl_manifold m;
        collide_one(step, batch, k, &q, &m);
        check_pose(&q.pa, &batch->a[k]);
        check_pose(&q.pb, &batch->b[k]);
        check_pose(&q.b_in_a, &batch->b_in_a[k]);
        assert_memory_equal(&q.margin, &batch->margin[k], sizeof q.margin);
        assert_memory_equal(&q.margin, &out.margin[k], sizeof q.margin);
        if (!(out.decided >> k & 1u)) {
            continue;
        }
        decided++;
        assert_int_equal(m.count, out.gap[k] <= out.margin[k]);
        assert_memory_equal(m.count ? &m.point[0].separation : &m.gap, &out.gap[k], sizeof m.gap);
        if (m.count) {
            check_point(step->h, &q, &m, 0, &out.point[k], &out.normal[k]);
            assert_int_equal(m.point[0].id, 0); /* what a contact finds its old impulse by */
            ++*touching;
        }
    }
    return decided;
}

static uint32_t draw_shape(const tl_header *h, uint32_t *seed, talus_shape_type type) {
    uint32_t shape;
    do {
        shape = draw(seed) % h->shapes.high;
    } while (tl_shape_geometry(h)[shape].type != type);
    return shape;
}

/* Eight pairs of a kind, of which capsules come with capsules and with balls. */
static void draw_batch(const tl_header *h, uint32_t *seed, tl_batch_kind kind, tl_pair_batch *batch) {
    static const talus_shape_type types[TL_BATCH_OTHER][2] = {{TALUS_SPHERE, TALUS_SPHERE},
                                                              {TALUS_SPHERE, TALUS_BOX},
                                                              {TALUS_BOX, TALUS_SPHERE},
                                                              {TALUS_CAPSULE, TALUS_CAPSULE},
                                                              {TALUS_BOX, TALUS_BOX}};
    memset(batch, 0, sizeof *batch);
    batch->kind = kind;
    batch->touch = 1;
    for (uint32_t k = 0; k < TL_LANES; k++) {
        uint32_t ball = kind == TL_BATCH_CAPSULES ? draw(seed) % 4u : 3u;
        uint32_t a = draw_shape(h, seed, ball == 0u ? TALUS_SPHERE : types[kind][0]);
        uint32_t b = draw_shape(h, seed, ball == 1u ? TALUS_SPHERE : types[kind][1]);
        assert_int_equal(tl_batch_kind_of(h, a, b), kind);
        assert_int_equal(tl_batch_add(h, batch, 7u * k + 3u, a, b), k + 1u == TL_LANES);
    }
}

static void lanes_are_as_one(void **state) {
    (void)state;
    uint32_t seed = 20260711u, touching[TL_BATCH_OTHER] = {0}, decided[TL_BATCH_OTHER] = {0}, batches = 0;
    printf("seed %u\n", (unsigned)seed);
    talus_world world = fill(&seed);
    tl_step step;
    memset(&step, 0, sizeof step);
    step.h = tl_header_of(&world);
    step.dt = 1.0f / 60.0f;
    for (int isa = TALUS_ISA_BEST + 1; isa < TALUS_ISA_COUNT; isa++) {
        const tl_kernels *kernels = tl_kernels_of((talus_isa)isa);
        for (int i = 0; i < (talus_isa_available((talus_isa)isa) ? 200 : 0); i++, batches++) {
            for (uint32_t kind = 0; kind < TL_BATCH_OTHER; kind++) {
                tl_pair_batch batch;
                draw_batch(step.h, &seed, (tl_batch_kind)kind, &batch);
                decided[kind] += kind == TL_BATCH_BOXES ? check_boxes(&step, kernels, &batch, &touching[kind])
                                                        : check_batch(&step, kernels, &batch, &touching[kind]);
            }
        }
    }
    for (uint32_t kind = 0; kind < TL_BATCH_OTHER; kind++) {
        uint32_t pairs = batches * TL_LANES;
        print_message("kind %u: %u of %u pairs decided in lanes, %u touching\n", kind, decided[kind], pairs,
                      touching[kind]);
        assert_true(decided[kind] > pairs - pairs / 10u && touching[kind] > pairs / 20u);
    }
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lanes_are_as_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
