/* Pairs eight at a time: what the lanes of every instruction set here answer is, to the bit, what the query of a single
 * pair answers. */
#include "stage/kernels.h"
#include "stage/narrow/query.h"
#include "store_check.h"

#include <stdio.h>

#define BODIES 64u

static talus_quat any_turn(uint32_t *seed) {
    talus_quat q = {draw_float(seed, -1, 1), draw_float(seed, -1, 1), draw_float(seed, -1, 1),
                    draw_float(seed, 0.1f, 1)};
    return tl_quat_normalize(q);
}

/* Balls and boxes in a heap, turned, moving, off their bodies' centres; some cannot move. */
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
        body.pose.rotation = any_turn(seed);
        body.linear_velocity = kit_vec(draw_float(seed, -9, 9), draw_float(seed, -9, 9), draw_float(seed, -9, 9));
        shape.geometry.type = i % 2u ? TALUS_BOX : TALUS_SPHERE;
        shape.geometry.radius = draw_float(seed, 0.1f, 0.6f);
        shape.geometry.half =
            kit_vec(draw_float(seed, 0.1f, 0.6f), draw_float(seed, 0.1f, 0.6f), draw_float(seed, 0.1f, 0.6f));
        shape.sensor = i % 7u == 0;
        if (i % 3u) {
            shape.pose.position = kit_vec(draw_float(seed, -1, 1), draw_float(seed, -1, 1), 0.25f);
            shape.pose.rotation = any_turn(seed);
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

/* A point of a manifold in the frames of the bodies, as a contact keeps it. */
static void check_point(const tl_header *h, const tl_query *q, const tl_manifold *m, const tl_one_points *out,
                        uint32_t k) {
    const tl_manifold_point *p = &m->point[0];
    talus_pose a = tl_body_is_fixed(h, q->body_a) ? q->pa : tl_row_pose_of(&tl_shape_place(h)[q->shape_a]);
    talus_pose b = tl_body_is_fixed(h, q->body_b) ? q->pb : tl_row_pose_of(&tl_shape_place(h)[q->shape_b]);
    talus_vec3 half = tl_scale(m->normal, 0.5f * p->separation);
    talus_vec3 on_a = tl_pose_point(&a, tl_sub(p->position, half));
    talus_vec3 on_b = tl_pose_point(&b, tl_pose_point_back(&q->b_in_a, tl_add(p->position, half)));
    talus_vec3 n = tl_rotate(a.rotation, m->normal);
    assert_memory_equal(&on_a, out->point[k].f, sizeof on_a);
    assert_memory_equal(&on_b, out->point[k].f + 3, sizeof on_b);
    assert_memory_equal(&n, out->normal[k].f, sizeof n);
}

static uint32_t check_batch(const tl_step *step, const tl_kernels *kernels, tl_pair_batch *batch) {
    tl_one_points out;
    uint32_t touching = 0;
    kernels->place_pairs(step, batch);
    kernels->collide_balls(step, batch, &out);
    for (uint32_t k = 0; k < TL_LANES; k++) {
        tl_query q = tl_query_of(step, batch->shape_a[k], batch->shape_b[k]);
        tl_pair_cache cold = {{0, 0, 0, 0}};
        tl_manifold m;
        tl_collide(&q.a, &q.b, &q.b_in_a, q.margin, &cold, &m);
        check_pose(&q.pa, &batch->a[k]);
        check_pose(&q.pb, &batch->b[k]);
        check_pose(&q.b_in_a, &batch->b_in_a[k]);
        assert_memory_equal(&q.margin, &batch->margin[k], sizeof q.margin);
        assert_memory_equal(&q.margin, &out.margin[k], sizeof q.margin);
        assert_int_equal(m.count == 1, out.gap[k] <= out.margin[k]);
        assert_memory_equal(m.count ? &m.point[0].separation : &m.gap, &out.gap[k], sizeof m.gap);
        if (m.count) {
            check_point(step->h, &q, &m, &out, k);
            touching++;
        }
    }
    return touching;
}

static uint32_t draw_shape(const tl_header *h, uint32_t *seed, talus_shape_type type) {
    uint32_t shape;
    do {
        shape = draw(seed) % h->shapes.high;
    } while (tl_shape_geometry(h)[shape].type != type);
    return shape;
}

static void lanes_are_as_one(void **state) {
    (void)state;
    static const talus_shape_type kinds[TL_BATCH_OTHER][2] = {
        {TALUS_SPHERE, TALUS_SPHERE}, {TALUS_SPHERE, TALUS_BOX}, {TALUS_BOX, TALUS_SPHERE}};
    uint32_t seed = 20260711u, touching = 0;
    printf("seed %u\n", (unsigned)seed);
    talus_world world = fill(&seed);
    tl_step step;
    memset(&step, 0, sizeof step);
    step.h = tl_header_of(&world);
    step.dt = 1.0f / 60.0f;
    for (int isa = TALUS_ISA_BEST + 1; isa < TALUS_ISA_COUNT; isa++) {
        for (int i = 0; i < (talus_isa_available((talus_isa)isa) ? 300 : 0); i++) {
            tl_pair_batch batch;
            memset(&batch, 0, sizeof batch);
            batch.kind = (tl_batch_kind)(i % TL_BATCH_OTHER);
            batch.count = TL_LANES;
            for (uint32_t k = 0; k < TL_LANES; k++) {
                uint32_t a = draw_shape(step.h, &seed, kinds[batch.kind][0]);
                uint32_t b = draw_shape(step.h, &seed, kinds[batch.kind][1]);
                const tl_shape_meta *ma = &tl_shapes(step.h)[a], *mb = &tl_shapes(step.h)[b];
                batch.shape_a[k] = a, batch.shape_b[k] = b;
                batch.body_a[k] = ma->body, batch.body_b[k] = mb->body;
                batch.senses |= (uint32_t)(((ma->flags | mb->flags) & TL_SHAPE_SENSOR) != 0) << k;
                batch.fixed_a |= (uint32_t)tl_body_is_fixed(step.h, ma->body) << k;
                batch.fixed_b |= (uint32_t)tl_body_is_fixed(step.h, mb->body) << k;
            }
            touching += check_batch(&step, tl_kernels_of((talus_isa)isa), &batch);
        }
    }
    assert_true(touching > 300u);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lanes_are_as_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
