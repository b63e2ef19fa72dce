#include "stage/narrow/query.h"

#include "stage/broad/refit.h"
#include "stage/store/lists.h"

/* m: how far apart the margins say that nothing is to be done. */
static float margin_of(const tl_step *step, uint32_t body_a, uint32_t body_b) {
    const tl_row8 *v = tl_body_velocity(step->h);
    float speed = tl_length(tl_sub(tl_row_xyz(&v[body_a]), tl_row_xyz(&v[body_b])));
    return step->h->settings.speculative_margin + tl_min(speed, 1e6f) * step->dt;
}

tl_query tl_query_of(const tl_step *step, uint32_t shape_a, uint32_t shape_b) {
    tl_header *h = step->h;
    tl_query q;
    q.shape_a = shape_a, q.shape_b = shape_b;
    q.body_a = tl_shapes(h)[shape_a].body, q.body_b = tl_shapes(h)[shape_b].body;
    q.a = tl_shape_convex(h, step->geometry, shape_a), q.b = tl_shape_convex(h, step->geometry, shape_b);
    q.pa = tl_shape_world_pose(h, shape_a), q.pb = tl_shape_world_pose(h, shape_b);
    q.b_in_a = tl_pose_relative(&q.pa, &q.pb);
    q.b_in_a.rotation = tl_quat_normalize(q.b_in_a.rotation);
    int senses = ((tl_shapes(h)[shape_a].flags | tl_shapes(h)[shape_b].flags) & TL_SHAPE_SENSOR) != 0;
    q.margin = senses ? 0.0f : margin_of(step, q.body_a, q.body_b);
    return q;
}

int tl_parted_by_balls(const tl_step *step, uint32_t body_a, uint32_t body_b, float *gap) {
    const tl_header *h = step->h;
    if (!tl_body_is_dynamic(h, body_a) || !tl_body_is_dynamic(h, body_b)) {
        return 0; /* what is not dynamic tends to be large */
    }
    const tl_row8 *a = &tl_body_pose(h)[body_a], *b = &tl_body_pose(h)[body_b];
    const tl_body_inertia *in = tl_body_inertias(h);
    *gap = tl_length(tl_sub(tl_row_xyz(b), tl_row_xyz(a))) - in[body_a].reach - in[body_b].reach;
    return *gap > 0.0f && *gap > margin_of(step, body_a, body_b);
}

float tl_doubt_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float margin) {
    const tl_body_inertia *in = tl_body_inertias(h);
    return 1e-5f + 1e-3f * margin + 1e-5f * (in[body_a].reach + in[body_b].reach);
}

uint32_t tl_clear_of(const tl_header *h, uint32_t body_a, uint32_t body_b, float gap) {
    float margin = h->settings.speculative_margin;
    float free = gap - margin - tl_doubt_of(h, body_a, body_b, margin);
    return free > 0.0f ? (uint32_t)tl_min(free * 1e6f, 1e9f) : 0u;
}
