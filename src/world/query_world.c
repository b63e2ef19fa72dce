/* The queries of a world as the caller has them. */
#include "world/query_probe.h"

static talus_status first(const tl_probe *p, talus_status status, talus_query_hit *out) {
    if (status == TALUS_OK) {
        tl_query_first(p, out);
    }
    return status;
}

static talus_status all(const tl_probe *p, talus_status status, talus_hits *out) {
    if (status == TALUS_OK) {
        tl_query_all(p, out);
    }
    return status;
}

static int is_room(const talus_hits *out) { return out && (out->hits || out->capacity == 0); }

talus_status talus_world_ray(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                             talus_query_hit *out) {
    tl_probe p;
    return first(&p, out ? tl_probe_ray(&p, world, filter, ray) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_ray_all(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                                 talus_hits *out) {
    tl_probe p;
    return all(&p, is_room(out) ? tl_probe_ray(&p, world, filter, ray) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_ray_any(const talus_world *world, const talus_ray *ray, const talus_query_filter *filter,
                                 int *out) {
    tl_probe p;
    talus_status status = out ? tl_probe_ray(&p, world, filter, ray) : TALUS_BAD_ARGUMENT;
    if (status == TALUS_OK) {
        *out = tl_query_any(&p);
    }
    return status;
}

talus_status talus_world_cast(const talus_world *world, const talus_convex *shape, const talus_motion *motion,
                              float tolerance, const talus_query_filter *filter, talus_query_hit *out) {
    tl_probe p;
    return first(&p, out ? tl_probe_cast(&p, world, filter, shape, motion, tolerance) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_cast_all(const talus_world *world, const talus_convex *shape, const talus_motion *motion,
                                  float tolerance, const talus_query_filter *filter, talus_hits *out) {
    tl_probe p;
    return all(&p, is_room(out) ? tl_probe_cast(&p, world, filter, shape, motion, tolerance) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_closest(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                 float reach, const talus_query_filter *filter, talus_query_hit *out) {
    tl_probe p;
    return first(&p, out ? tl_probe_shape(&p, world, filter, TL_ASK_CLOSEST, shape, pose, reach) : TALUS_BAD_ARGUMENT,
                 out);
}

talus_status talus_world_closest_all(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                     float reach, const talus_query_filter *filter, talus_hits *out) {
    tl_probe p;
    return all(
        &p, is_room(out) ? tl_probe_shape(&p, world, filter, TL_ASK_CLOSEST, shape, pose, reach) : TALUS_BAD_ARGUMENT,
        out);
}

talus_status talus_world_closest_to_point(const talus_world *world, talus_vec3 point, float reach,
                                          const talus_query_filter *filter, talus_query_hit *out) {
    tl_probe p;
    return first(&p, out ? tl_probe_point(&p, world, filter, TL_ASK_CLOSEST, point, reach) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_closest_to_point_all(const talus_world *world, talus_vec3 point, float reach,
                                              const talus_query_filter *filter, talus_hits *out) {
    tl_probe p;
    return all(&p, is_room(out) ? tl_probe_point(&p, world, filter, TL_ASK_CLOSEST, point, reach) : TALUS_BAD_ARGUMENT,
               out);
}

talus_status talus_world_overlap(const talus_world *world, const talus_convex *shape, const talus_pose *pose,
                                 const talus_query_filter *filter, talus_hits *out) {
    tl_probe p;
    return all(&p,
               is_room(out) ? tl_probe_shape(&p, world, filter, TL_ASK_OVERLAP, shape, pose, 0.0f) : TALUS_BAD_ARGUMENT,
               out);
}

talus_status talus_world_overlap_aabb(const talus_world *world, const talus_aabb *box, const talus_query_filter *filter,
                                      talus_hits *out) {
    tl_probe p;
    return all(&p, is_room(out) ? tl_probe_box(&p, world, filter, box) : TALUS_BAD_ARGUMENT, out);
}

talus_status talus_world_at_point(const talus_world *world, talus_vec3 point, const talus_query_filter *filter,
                                  talus_hits *out) {
    tl_probe p;
    return all(&p, is_room(out) ? tl_probe_point(&p, world, filter, TL_ASK_POINT, point, 0.0f) : TALUS_BAD_ARGUMENT,
               out);
}

/* --- of one shape ------------------------------------------------------------------------------- */

/* m: further than any two shapes that queries reach */
#define HOWEVER_FAR 3e38f

static talus_status one(const tl_probe *p, talus_status status, talus_shape shape, talus_query_hit *out) {
    return status == TALUS_OK ? tl_query_one(p, shape, out) : status;
}

talus_status talus_shape_ray(const talus_world *world, talus_shape shape, const talus_ray *ray, talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_ray(&p, world, NULL, ray) : TALUS_BAD_ARGUMENT, shape, out);
}

talus_status talus_shape_cast(const talus_world *world, talus_shape shape, const talus_convex *other,
                              const talus_motion *motion, float tolerance, talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_cast(&p, world, NULL, other, motion, tolerance) : TALUS_BAD_ARGUMENT, shape, out);
}

talus_status talus_shape_closest(const talus_world *world, talus_shape shape, const talus_convex *other,
                                 const talus_pose *pose, talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_shape(&p, world, NULL, TL_ASK_CLOSEST, other, pose, HOWEVER_FAR) : TALUS_BAD_ARGUMENT,
               shape, out);
}

talus_status talus_shape_closest_to_point(const talus_world *world, talus_shape shape, talus_vec3 point,
                                          talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_point(&p, world, NULL, TL_ASK_CLOSEST, point, HOWEVER_FAR) : TALUS_BAD_ARGUMENT,
               shape, out);
}

talus_status talus_shape_overlap(const talus_world *world, talus_shape shape, const talus_convex *other,
                                 const talus_pose *pose, talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_shape(&p, world, NULL, TL_ASK_OVERLAP, other, pose, 0.0f) : TALUS_BAD_ARGUMENT, shape,
               out);
}

talus_status talus_shape_at_point(const talus_world *world, talus_shape shape, talus_vec3 point, talus_query_hit *out) {
    tl_probe p;
    return one(&p, out ? tl_probe_point(&p, world, NULL, TL_ASK_POINT, point, 0.0f) : TALUS_BAD_ARGUMENT, shape, out);
}
