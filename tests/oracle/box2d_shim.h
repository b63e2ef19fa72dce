/* What the tests ask of Box2D, in C. Bodies are numbered from 0, which is the ground. SI units, radians, y up. */
#ifndef BOX2D_SHIM_H
#define BOX2D_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum flat_type { FLAT_STATIC, FLAT_KINEMATIC, FLAT_DYNAMIC } flat_type;

typedef struct flat_state {
    float x, y, angle, vx, vy, spin;
} flat_state;

typedef struct flat_world flat_world;

flat_world *flat_new(float gravity_x, float gravity_y);
void flat_free(flat_world *world);
int flat_body(flat_world *world, flat_type type, flat_state at, float damping);
void flat_box(flat_world *world, int body, float x, float y, float half_x, float half_y, float density, float friction,
              float restitution);
void flat_disc(flat_world *world, int body, float radius, float density, float friction, float restitution);
void flat_hinge(flat_world *world, int a, int b, float x, float y);
void flat_move(flat_world *world, int body, float vx, float vy);
void flat_step(flat_world *world, float dt);
flat_state flat_get(const flat_world *world, int body);

#ifdef __cplusplus
}
#endif

#endif
