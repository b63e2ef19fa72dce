/* Body rows: what the solver reads and writes of the awake bodies, one 32-byte row a column each. Row 0 stands for all
 * that does not move. */
#include <string.h>

#include "base/eigen.h"
#include "stage/stages.h"

/* Whether one principal inertia is far below the two others. */
static int is_slender(talus_vec3 s) {
    float most = tl_max(s.x, tl_max(s.y, s.z)), least = tl_min(s.x, tl_min(s.y, s.z));
    float middle = s.x + s.y + s.z - most - least;
    return most * most > TL_SLENDER * middle * middle;
}

static void rest_row(tl_header *h, uint32_t row) {
    memset(&tl_row_velocity(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_before(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_moved(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_pose(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_push(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_frame(h)[row], 0, sizeof(tl_row8));
    memset(&tl_row_force(h)[row], 0, sizeof(tl_row8));
    tl_row_pose(h)[row].f[6] = 1.0f;
    tl_row_frame(h)[row].f[3] = 1.0f;
}

/* K of a body that may not turn about some world axes: the inertia's block of the free axes, inverted, in principal
 * axes. The block is padded with a moment so large that its inverse is nothing. */
static void locked_frame(const tl_header *h, uint32_t body, uint32_t locks, talus_quat *frame, talus_vec3 *s) {
    const float *own = tl_body_inertias(h)[body].s;
    talus_mat3 axes = tl_mat3_from_quat(tl_row_quat(&tl_body_pose(h)[body]));
    float moment[3], most = 0.0f;
    for (int k = 0; k < 3; k++) {
        moment[k] = own[k] > 0.0f ? 1.0f / (own[k] * own[k]) : 0.0f;
        most = tl_max(most, moment[k]);
    }
    talus_mat3 scaled = {tl_scale(axes.x, moment[0]), tl_scale(axes.y, moment[1]), tl_scale(axes.z, moment[2])};
    talus_mat3 back = tl_mat3_transpose(&axes), world = tl_mat3_mat(&scaled, &back);
    float m[3][3] = {
        {world.x.x, world.y.x, world.z.x}, {world.x.y, world.y.y, world.z.y}, {world.x.z, world.y.z, world.z.z}};
    for (int k = 0; k < 3; k++) {
        if (locks & (uint32_t)TALUS_LOCK_ANGULAR_X << k) {
            for (int j = 0; j < 3; j++) {
                m[k][j] = m[j][k] = 0.0f;
            }
        }
    }
    talus_mat3 block = {{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}};
    float values[3] = {m[0][0], m[1][1], m[2][2]};
    uint32_t free_axes = ~locks >> 3 & 7u;
    if (free_axes & (free_axes - 1u)) {
        tl_principal_axes(&block, frame, values);
    } else { /* about one axis of the world */
        *frame = tl_quat_identity();
    }
    s->x = values[0] > 1e-6f * most ? 1.0f / sqrtf(values[0]) : 0.0f;
    s->y = values[1] > 1e-6f * most ? 1.0f / sqrtf(values[1]) : 0.0f;
    s->z = values[2] > 1e-6f * most ? 1.0f / sqrtf(values[2]) : 0.0f;
}

/* u with w = R (s u); zero where s is. */
static talus_vec3 whiten(talus_quat frame, talus_vec3 s, talus_vec3 w) {
    talus_vec3 own = tl_rotate_back(frame, w);
    return tl_v(s.x > 0.0f ? own.x / s.x : 0.0f, s.y > 0.0f ? own.y / s.y : 0.0f, s.z > 0.0f ? own.z / s.z : 0.0f);
}

/* Whether a body's rows are not what fill_bodies makes of them: it does not turn, or not about all axes. */
static int is_unlike(const tl_header *h, uint32_t body) {
    const float *s = tl_body_inertias(h)[body].s;
    uint32_t flags = tl_bodies(h)[body].flags;
    return (flags & TL_BODY_TYPE) != TALUS_DYNAMIC || (flags >> TL_BODY_LOCKS & 56u) ||
           (s[0] == 0.0f && s[1] == 0.0f && s[2] == 0.0f);
}

static void fill_unlike(tl_step *step, uint32_t body, uint32_t row) {
    tl_header *h = step->h;
    const tl_body_inertia *in = &tl_body_inertias(h)[body];
    uint32_t flags = tl_bodies(h)[body].flags, locks = flags >> TL_BODY_LOCKS;
    const tl_row8 *pose = &tl_body_pose(h)[body], *v = &tl_body_velocity(h)[body];
    int dynamic = (flags & TL_BODY_TYPE) == TALUS_DYNAMIC, turns = dynamic && (locks & 56u);
    talus_quat frame = tl_quat_identity();
    talus_vec3 s = tl_v(1.0f, 1.0f, 1.0f), a = tl_v(0.0f, 0.0f, 0.0f);
    if (turns) { /* otherwise it keeps the spin it has, which u then is */
        locked_frame(h, body, locks, &frame, &s);
    }
    talus_vec3 u = whiten(frame, s, tl_row_345(v));
    tl_row8 *rv = &tl_row_velocity(h)[row], *rf = &tl_row_frame(h)[row], *ra = &tl_row_force(h)[row];
    tl_row_pose(h)[row] = *pose;
    memset(&tl_row_momentum(h)[row], 0, sizeof(tl_row8));
    tl_row_set6(&tl_row_momentum(h)[row], a, u);
    tl_row_momentum(h)[row].f[6] = is_slender(s) ? 1.0f : 0.0f;
    tl_row_set6(rv, tl_row_xyz(v), u);
    rv->f[6] = dynamic ? in->inverse_mass : 0.0f;
    rv->f[7] = turns ? 1.0f : 0.0f;
    memset(&tl_row_push(h)[row], 0, sizeof(tl_row8));
    tl_row_push(h)[row].f[6] = rv->f[6], tl_row_push(h)[row].f[7] = rv->f[7];
    tl_row_before(h)[row] = tl_row_push(h)[row];
    memset(&tl_row_moved(h)[row], 0, sizeof(tl_row8));
    rf->f[0] = frame.x, rf->f[1] = frame.y, rf->f[2] = frame.z, rf->f[3] = frame.w;
    rf->f[4] = s.x, rf->f[5] = s.y, rf->f[6] = s.z, rf->f[7] = 0.0f;
    if (dynamic && in->inverse_mass > 0.0f) {
        a = tl_scale(h->settings.gravity, in->gravity_scale);
    }
    tl_row_set6(ra, a, tl_v(0.0f, 0.0f, 0.0f));
    ra->f[6] = dynamic ? 1.0f / (1.0f + step->sub * in->linear_damping) : 1.0f;
    ra->f[7] = dynamic ? 1.0f / (1.0f + step->sub * in->angular_damping) : 1.0f;
}

static void lock_row(tl_header *h, uint32_t row, uint32_t locks) {
    tl_row_moved(h)[row].f[6] = (float)locks;
    if ((locks & 7u) == 7u) {
        tl_row_velocity(h)[row].f[6] = tl_row_before(h)[row].f[6] = tl_row_push(h)[row].f[6] = 0.0f;
    }
}

static void add_force(tl_header *h, uint32_t body, uint32_t row) {
    const tl_row8 *f = &tl_body_force(h)[body], *rf = &tl_row_frame(h)[row];
    tl_row8 *ra = &tl_row_force(h)[row];
    talus_quat frame = {rf->f[0], rf->f[1], rf->f[2], rf->f[3]};
    talus_vec3 a = tl_mad(tl_row_xyz(ra), tl_body_inertias(h)[body].inverse_mass, tl_row_xyz(f));
    talus_vec3 turn = tl_mul(tl_v(rf->f[4], rf->f[5], rf->f[6]), tl_rotate_back(frame, tl_row_345(f)));
    tl_row_set6(ra, a, tl_row_velocity(h)[row].f[7] > 0.0f ? turn : tl_v(0.0f, 0.0f, 0.0f));
}

void tl_stage_body_rows(tl_step *step) {
    tl_header *h = step->h;
    uint32_t used = h->awake_bodies + 1u;
    step->any_locks = 0;
    step->rows = (used + TL_LANES - 1u) / TL_LANES * TL_LANES;
    tl_kernels_of((talus_isa)h->isa)->fill_bodies(step, 0, step->rows);
    rest_row(h, 0);
    for (uint32_t row = 1; row < used; row++) {
        uint32_t body = tl_awake_body(h)[row - 1u], flags = tl_bodies(h)[body].flags;
        int dynamic = (flags & TL_BODY_TYPE) == TALUS_DYNAMIC;
        if (is_unlike(h, body)) {
            fill_unlike(step, body, row);
        }
        if (dynamic && flags >> TL_BODY_LOCKS) {
            lock_row(h, row, flags >> TL_BODY_LOCKS);
            step->any_locks = 1;
        }
        if (dynamic && flags & TL_BODY_FORCE) {
            add_force(h, body, row);
        }
    }
}

void tl_stage_locks(tl_step *step) {
    tl_header *h = step->h;
    for (uint32_t row = 1; row <= h->awake_bodies; row++) {
        uint32_t locks = (uint32_t)tl_row_moved(h)[row].f[6];
        for (uint32_t k = 0; k < 3u; k++) {
            if (locks & (uint32_t)TALUS_LOCK_LINEAR_X << k) {
                tl_row_velocity(h)[row].f[k] = tl_row_before(h)[row].f[k] = tl_row_push(h)[row].f[k] = 0.0f;
            }
        }
    }
}
