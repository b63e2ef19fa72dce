/* Scenes of the plane in Box2D and in Talus, whose bodies are locked to it: the same where the answer is unique, alike
 * where it is not. Where the two differ a closed form says who is right. Box2D keeps polygons 15 mm apart (two skins of
 * 10 mm less 5 mm of slop): that much a pair of boxes may differ. */
#include "../analytic/analytic_kit.h"

#include "box2d_shim.h"

#define MOST 160
#define DEPTH 1.0f /* of the bodies in z */
#define SKIN 0.015

typedef struct both {
    talus_world world;
    flat_world *flat;
    talus_body body[MOST];
    int count; /* 0 is the ground */
} both;

static both begin(float gravity_x, float gravity_y) {
    both b;
    talus_world_def def = talus_world_def_default();
    memset(&b, 0, sizeof b);
    def.body_capacity = def.shape_capacity = MOST;
    def.gravity = kit_vec(gravity_x, gravity_y, 0.0f);
    def.enable_sleep = 0;
    b.world = kit_world(&def);
    b.flat = flat_new(gravity_x, gravity_y);
    assert_non_null(b.flat);
    b.body[0] = talus_world_ground(&b.world);
    b.count = 1;
    return b;
}
/* What touches is solved in the plane, and only there. */
static void end(both *b) {
    talus_counters c = kit_counters(&b->world);
    assert_int_equal(c.contacts_planar, c.contacts_touching);
    flat_free(b->flat);
    kit_end(&b->world);
}
static void step_both(both *b, int steps) {
    for (int i = 0; i < steps; i++) {
        flat_step(b->flat, DT);
        step(&b->world);
    }
}

static flat_state still(double x, double y) {
    flat_state s = {(float)x, (float)y, 0.0f, 0.0f, 0.0f, 0.0f};
    return s;
}

static int body_at(both *b, flat_type type, flat_state at, float damping) {
    talus_body_def def = talus_body_def_default();
    def.type = type == FLAT_STATIC ? TALUS_STATIC : type == FLAT_KINEMATIC ? TALUS_KINEMATIC : TALUS_DYNAMIC;
    def.pose = kit_pose(at.x, at.y, 0.0f);
    def.pose.rotation.z = sinf(0.5f * at.angle), def.pose.rotation.w = cosf(0.5f * at.angle);
    def.linear_velocity = kit_vec(at.vx, at.vy, 0.0f);
    def.angular_velocity.z = at.spin;
    def.linear_damping = def.angular_damping = damping;
    def.locks = TALUS_LOCK_PLANE_Z;
    OK(talus_body_create(&b->world, &def, &b->body[b->count]));
    assert_int_equal(flat_body(b->flat, type, at, damping), b->count);
    return b->count++;
}

static void box_on(both *b, int body, double x, double y, double half_x, double half_y, float friction,
                   float restitution) {
    talus_shape_def def = kit_box_def((float)half_x, (float)half_y, 0.5f * DEPTH);
    def.pose = kit_pose((float)x, (float)y, 0.0f);
    def.density = 10.0f / DEPTH;
    def.material.static_friction = def.material.dynamic_friction = friction;
    def.material.restitution = restitution;
    kit_shape(&b->world, b->body[body], &def);
    flat_box(b->flat, body, (float)x, (float)y, (float)half_x, (float)half_y, 10.0f, friction, restitution);
}

/* A ball with the mass and the moment of a disc. */
static void disc_on(both *b, int body, double radius, float friction, float restitution) {
    talus_shape_def def = kit_ball_def((float)radius);
    const double mass = 10.0 * PI * radius * radius;
    talus_mass m;
    def.material.static_friction = def.material.dynamic_friction = friction;
    def.material.restitution = restitution;
    kit_shape(&b->world, b->body[body], &def);
    memset(&m, 0, sizeof m);
    m.mass = (float)mass;
    m.inertia.x.x = m.inertia.y.y = m.inertia.z.z = (float)(0.5 * mass * radius * radius);
    OK(talus_body_set_mass(&b->world, b->body[body], &m));
    flat_disc(b->flat, body, (float)radius, 10.0f, friction, restitution);
}

static int box_at(both *b, double x, double y, double half_x, double half_y, float friction) {
    int body = body_at(b, FLAT_DYNAMIC, still(x, y), 0.0f);
    box_on(b, body, 0.0, 0.0, half_x, half_y, friction, 0.0f);
    return body;
}
static void ground(both *b, float friction, float restitution) {
    box_on(b, 0, 0.0, -1.0, 200.0, 1.0, friction, restitution);
}

static void hinge(both *b, int a, int c, double x, double y) {
    talus_joint_def def = talus_joint_def_default();
    talus_vec3 pa = kit_place(&b->world, b->body[a]), pc = kit_place(&b->world, b->body[c]);
    talus_joint_make_ball(&def); /* in the plane a ball is a hinge */
    def.a = b->body[a], def.b = b->body[c];
    def.frame_a = kit_pose((float)x - pa.x, (float)y - pa.y, 0.0f);
    def.frame_b = kit_pose((float)x - pc.x, (float)y - pc.y, 0.0f);
    join(&b->world, &def);
    flat_hinge(b->flat, a, c, (float)x, (float)y);
}

static flat_state ours(const both *b, int body) {
    talus_vec3 p = kit_place(&b->world, b->body[body]), v = kit_velocity(&b->world, b->body[body]);
    flat_state s = {p.x, p.y, (float)angle_z(&b->world, b->body[body]), v.x, v.y, kit_spin(&b->world, b->body[body]).z};
    CLOSE(p.z, 0.0, 1e-6);
    return s;
}
static flat_state theirs(const both *b, int body) { return flat_get(b->flat, body); }

/* --- what rests ------------------------------------------------------------------------------- */

static void stack(void **state) {
    (void)state;
    both b = begin(0.0f, (float)-G);
    ground(&b, 0.6f, 0.0f);
    for (int i = 0; i < 10; i++) {
        box_at(&b, 0.0, 0.5 + i, 0.5, 0.5, 0.6f);
    }
    step_both(&b, 600);
    for (int i = 1; i <= 10; i++) {
        flat_state o = ours(&b, i), t = theirs(&b, i);
        CLOSE(o.x, t.x, 0.01);
        CLOSE(o.y, t.y, SKIN * i + 0.005);
        CLOSE(o.y, i - 0.5, 0.02); /* the closed form: boxes that touch */
        CLOSE(o.angle, t.angle, 0.01);
    }
    end(&b);
}

static void pyramid(void **state) {
    (void)state;
    both b = begin(0.0f, (float)-G);
    ground(&b, 0.6f, 0.0f);
    for (int row = 0; row < 8; row++) {
        for (int i = 0; i < 8 - row; i++) {
            box_at(&b, 1.1 * i + 0.55 * row, 0.5 + row, 0.5, 0.5, 0.6f);
        }
    }
    step_both(&b, 600);
    for (int i = 1, row = 0; row < 8; row++) {
        for (int k = 0; k < 8 - row; k++, i++) {
            flat_state o = ours(&b, i), t = theirs(&b, i);
            CLOSE(o.x, t.x, 0.03);
            CLOSE(o.y, t.y, SKIN * (row + 1) + 0.005);
            CLOSE(o.angle, t.angle, 0.01);
        }
    }
    end(&b);
}

/* Chains come to rest on one curve whatever way they took there. Below the pivot a straight line; a bridge of rigid
 * planks hangs as its potential is least, and so that its joints do not come apart. */
static void hanging(void **state) {
    (void)state;
    for (int bridge = 0; bridge < 2; bridge++) {
        both b = begin(0.0f, (float)-G);
        for (int i = 1; i <= 16; i++) {
            int body = body_at(&b, FLAT_DYNAMIC, still(i - 0.5, 0.0), 1.0f);
            box_on(&b, body, 0.0, 0.0, 0.45, 0.1, 0.5f, 0.0f);
            hinge(&b, body - 1, body, i - 1.0, 0.0);
        }
        if (bridge) {
            /* the far end is brought nearer: the planks sag */
            int post = body_at(&b, FLAT_KINEMATIC, still(16.0, 0.0), 0.0f);
            hinge(&b, 16, post, 16.0, 0.0);
            talus_vec3 none = kit_vec(0.0f, 0.0f, 0.0f);
            OK(talus_body_set_velocity(&b.world, b.body[post], kit_vec(-1.0f, 0.0f, 0.0f), none));
            flat_move(b.flat, post, -1.0f, 0.0f);
            step_both(&b, 120);
            OK(talus_body_set_velocity(&b.world, b.body[post], none, none));
            flat_move(b.flat, post, 0.0f, 0.0f);
        }
        step_both(&b, 2400);
        for (int i = 1; i <= 16; i++) {
            flat_state o = ours(&b, i), t = theirs(&b, i);
            CLOSE(o.x, t.x, 0.05);
            CLOSE(o.y, t.y, 0.05);
            if (!bridge) {
                CLOSE(o.x, 0.0, 0.01);
                CLOSE(o.y, 0.5 - i, 0.01 * i);
            }
        }
        end(&b);
    }
}

/* --- what moves, with one answer --------------------------------------------------------------- */

/* From level and from 0.2 rad. Box2D loses height to its joint, from level so fast that the mean of the first eight
 * periods is a tenth too short. */
static void pendulum(void **state) {
    (void)state;
    for (int small = 0; small < 2; small++) {
        const double angle = small ? 0.2 : PI / 2.0;
        both b = begin(0.0f, (float)-G);
        int bob = body_at(&b, FLAT_DYNAMIC, still(sin(angle), -cos(angle)), 0.0f);
        disc_on(&b, bob, 0.1, 0.0f, 0.0f);
        hinge(&b, 0, bob, 0.0, 0.0);
        period o = {0.0, 0.0, 0.0, 0, 0}, t = o;
        for (int i = 1; i <= 1200; i++) {
            step_both(&b, 1);
            period_feed(&o, i * (double)DT, (double)ours(&b, bob).x, (double)DT);
            period_feed(&t, i * (double)DT, (double)theirs(&b, bob).x, (double)DT);
        }
        const double closed = 2.0 * PI * sqrt((1.0 + 0.005) / G) / agm(1.0, cos(angle / 2.0));
        print_message("  pendulum from %.2f rad: %.4f s, Box2D %.4f s, closed form %.4f s\n", angle, period_of(&o),
                      period_of(&t), closed);
        CLOSE(period_of(&o), closed, 0.002 * closed);
        CLOSE(period_of(&t), period_of(&o), (small ? 0.005 : 0.1) * closed);
        end(&b);
    }
}

/* A box on a slope below and above the angle of friction; one that is pushed on the level. */
static void friction(void **state) {
    (void)state;
    const double mus[] = {0.2, 0.5};
    for (int m = 0; m < 2; m++) {
        for (int steep = 0; steep < 2; steep++) {
            const double angle = atan(mus[m]) * (steep ? 1.5 : 0.9);
            both b = begin((float)(G * sin(angle)), (float)(-G * cos(angle)));
            ground(&b, (float)mus[m], 0.0f);
            int box = box_at(&b, 0.0, 0.2, 0.8, 0.2, (float)mus[m]);
            step_both(&b, 120);
            const double a = steep ? G * (sin(angle) - mus[m] * cos(angle)) : 0.0;
            CLOSE(ours(&b, box).vx, theirs(&b, box).vx, 0.03 * G * mus[m]);
            CLOSE(ours(&b, box).vx, 2.0 * a, 0.02 * G * mus[m]);
            CLOSE(ours(&b, box).x, theirs(&b, box).x, 0.03 * G * mus[m]);
            end(&b);
        }
        both b = begin(0.0f, (float)-G);
        flat_state at = still(0.0, 0.2);
        at.vx = 5.0f;
        ground(&b, (float)mus[m], 0.0f);
        int box = body_at(&b, FLAT_DYNAMIC, at, 0.0f);
        box_on(&b, box, 0.0, 0.0, 0.8, 0.2, (float)mus[m], 0.0f);
        step_both(&b, 300);
        const double way = 25.0 / (2.0 * mus[m] * G);
        CLOSE(ours(&b, box).x, way, 0.02 * way);
        CLOSE(ours(&b, box).x, theirs(&b, box).x, 0.03 * way);
        end(&b);
    }
}

/* The top of the first bounce: e^2 h. */
static void restitution(void **state) {
    (void)state;
    const double es[] = {0.3, 0.6, 0.9};
    for (int k = 0; k < 3; k++) {
        both b = begin(0.0f, (float)-G);
        ground(&b, 0.0f, (float)es[k]);
        int disc = body_at(&b, FLAT_DYNAMIC, still(0.0, 3.25), 0.0f);
        disc_on(&b, disc, 0.25, 0.0f, (float)es[k]);
        double top[2] = {0.0, 0.0};
        int hit[2] = {0, 0}, over[2] = {0, 0};
        for (int i = 0; i < 240; i++) {
            step_both(&b, 1);
            for (int w = 0; w < 2; w++) {
                flat_state s = w ? theirs(&b, disc) : ours(&b, disc);
                over[w] |= hit[w] && s.vy < 0.0f;
                hit[w] |= s.vy > 0.0f;
                double y = (double)s.y - 0.25 + (double)(s.vy * s.vy) / (2.0 * G);
                top[w] = hit[w] && !over[w] ? fmax(top[w], y) : top[w];
            }
        }
        print_message("  e %.1f: comes up to %.4f m, Box2D %.4f m, closed form %.4f m\n", es[k], top[0], top[1],
                      es[k] * es[k] * 3.0);
        CLOSE(top[0], es[k] * es[k] * 3.0, 0.002);
        CLOSE(top[1], top[0], 2.0 * sqrt(2.0 * G * 3.0) * (double)DT); /* Box2D takes the speed after a whole step */
        end(&b);
    }
}

/* Head on: the impulse is (1 + e) of the reduced mass times the speed. */
static void impulses(void **state) {
    (void)state;
    const double es[] = {0.0, 0.5, 1.0};
    for (int k = 0; k < 3; k++) {
        both b = begin(0.0f, 0.0f);
        flat_state at = still(-2.0, 0.0);
        at.vx = 4.0f;
        int light = body_at(&b, FLAT_DYNAMIC, at, 0.0f), heavy = body_at(&b, FLAT_DYNAMIC, still(0.0, 0.0), 0.0f);
        disc_on(&b, light, 0.25, 0.0f, (float)es[k]);
        disc_on(&b, heavy, 0.5, 0.0f, (float)es[k]);
        step_both(&b, 60);
        const double reduced = 1.0 * 4.0 / 5.0, gain = (1.0 + es[k]) * reduced * 4.0 / 4.0;
        CLOSE(ours(&b, heavy).vx, gain, 1e-3);
        CLOSE(theirs(&b, heavy).vx, gain, 1e-2);
        CLOSE(ours(&b, light).vx, theirs(&b, light).vx, 1e-2);
        end(&b);
    }
}

/* Five discs that touch: the last one takes the speed of the first. Box2D, whose passes solve all contacts together,
 * spreads it; the closed form, blow after blow, says that ours is right. */
static void cradle(void **state) {
    (void)state;
    both b = begin(0.0f, 0.0f);
    for (int i = 0; i < 5; i++) {
        flat_state at = still(i ? i : -1.0, 0.0);
        at.vx = i ? 0.0f : 3.0f;
        disc_on(&b, body_at(&b, FLAT_DYNAMIC, at, 0.0f), 0.5, 0.0f, 1.0f);
    }
    step_both(&b, 60);
    double momentum[2] = {0.0, 0.0};
    for (int i = 1; i <= 5; i++) {
        print_message("  cradle, disc %d: %.3f m/s, Box2D %.3f m/s\n", i, (double)ours(&b, i).vx,
                      (double)theirs(&b, i).vx);
        CLOSE(ours(&b, i).vx, i == 5 ? 3.0 : 0.0, 1e-3);
        momentum[0] += (double)ours(&b, i).vx, momentum[1] += (double)theirs(&b, i).vx;
    }
    CLOSE(momentum[0], 3.0, 1e-4);
    CLOSE(momentum[1], 3.0, 1e-3);
    end(&b);
}

/* --- what is alike only ------------------------------------------------------------------------ */

static void dominoes(void **state) {
    (void)state;
    both b = begin(0.0f, (float)-G);
    double fell[2] = {0.0, 0.0};
    ground(&b, 0.5f, 0.0f);
    for (int i = 0; i < 20; i++) {
        flat_state at = still(i * 0.6, 0.5);
        at.spin = i ? 0.0f : -1.5f, at.vx = i ? 0.0f : 0.75f;
        int body = body_at(&b, FLAT_DYNAMIC, at, 0.0f);
        box_on(&b, body, 0.0, 0.0, 0.1, 0.5, 0.5f, 0.0f);
    }
    for (int i = 1; i <= 600; i++) {
        step_both(&b, 1);
        for (int w = 0; w < 2; w++) {
            flat_state s = w ? theirs(&b, 20) : ours(&b, 20);
            fell[w] = fell[w] <= 0.0 && fabs((double)s.angle) > 0.5 ? i * (double)DT : fell[w];
        }
    }
    print_message("  the last domino falls after %.2f s, in Box2D %.2f s\n", fell[0], fell[1]);
    assert_true(fell[0] > 0.0 && fell[1] > 0.0);
    CLOSE(fell[0], fell[1], 0.25 * fell[1]);
    for (int i = 1; i <= 20; i++) {
        assert_true(fabs((double)ours(&b, i).angle) > 0.5);
        assert_true(fabs((double)theirs(&b, i).angle) > 0.5);
    }
    end(&b);
}

/* A hundred boxes in a turning drum of 10 m: the mean height of their centres, over ten seconds. */
static void tumbler(void **state) {
    (void)state;
    both b = begin(0.0f, (float)-G);
    flat_state at = still(0.0, 0.0);
    at.spin = 0.5f;
    int drum = body_at(&b, FLAT_KINEMATIC, at, 0.0f);
    for (int side = 0; side < 4; side++) {
        double x = side == 0 ? 5.5 : side == 1 ? -5.5 : 0.0, y = side == 2 ? 5.5 : side == 3 ? -5.5 : 0.0;
        box_on(&b, drum, x, y, x == 0.0 ? 6.0 : 0.5, y == 0.0 ? 6.0 : 0.5, 0.5f, 0.0f);
    }
    for (int i = 0; i < 100; i++) {
        box_at(&b, -2.25 + 0.5 * (i % 10), -2.25 + 0.5 * (i / 10), 0.2, 0.2, 0.5f);
    }
    double height[2] = {0.0, 0.0};
    step_both(&b, 300);
    for (int i = 0; i < 600; i++) {
        step_both(&b, 1);
        for (int k = 2; k < b.count; k++) {
            flat_state o = ours(&b, k), t = theirs(&b, k);
            height[0] += (double)o.y / 60000.0, height[1] += (double)t.y / 60000.0;
            assert_true(o.x * o.x + o.y * o.y < 50.0f && t.x * t.x + t.y * t.y < 50.0f);
        }
    }
    print_message("  tumbler: the boxes' mean height is %.3f m, in Box2D %.3f m\n", height[0], height[1]);
    CLOSE(height[0], height[1], 0.3);
    end(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stack),    cmocka_unit_test(pyramid),  cmocka_unit_test(hanging),
        cmocka_unit_test(pendulum), cmocka_unit_test(friction), cmocka_unit_test(restitution),
        cmocka_unit_test(impulses), cmocka_unit_test(cradle),   cmocka_unit_test(dominoes),
        cmocka_unit_test(tumbler),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
