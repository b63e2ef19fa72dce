/* The rigid-body tests of SimBenchmark (Kang and Hwangbo, leggedrobotics/SimBenchmark) with their numbers: rolling,
 * bouncing, 666, elastic 666; and the energy and momentum of a free body. Steps of 1 ms, the figure of each is printed
 * beside those that its authors published for that step. Their z is y here.
 *
 * TALUS_WHOLE=1 runs all of them to their end; without, the cubes and the free body run for a second or two. */
#include "analytic_kit.h"

#define MS 1e-3f
#define STRAIGHT 0.86602540378443865

static int whole(void) { return getenv("TALUS_WHOLE") != NULL; }
static int steps_of(int all, int quick) { return whole() ? all : quick; }

static void step_ms(talus_world *world) { OK(talus_world_step(world, MS, NULL, NULL)); }

static void told(const char *name, double figure, const char *unit, double most, const char *published) {
    print_message("%-22s %.3g %s (below %.3g)%s%s\n", name, figure, unit, most, *published ? "; published: " : "",
                  published);
    BELOW(figure, most);
}

/* One sub-step a step, for theirs are not cut up either; contacts twice as stiff as by default, and all bounce. */
static talus_world world_1ms(float gravity) {
    talus_world_def def = talus_world_def_default();
    def.gravity = kit_vec(0.0f, -gravity, 0.0f);
    def.enable_sleep = 0;
    def.substeps = 1;
    def.contact_hertz = 100.0f;
    def.restitution_speed = 0.0f;
    return kit_world(&def);
}

static talus_material material_of(float friction, float restitution) {
    talus_shape_def def = talus_shape_def_default();
    def.material.static_friction = def.material.dynamic_friction = friction;
    def.material.restitution = restitution;
    def.material.friction_combine = TALUS_COMBINE_MULTIPLY;
    def.material.restitution_combine = TALUS_COMBINE_MULTIPLY;
    return def.material;
}

static void ground_of(talus_world *world, talus_material material) {
    talus_shape_def def = kit_box_def(250.0f, 1.0f, 250.0f);
    def.pose.position.y = -1.0f;
    def.material = material;
    kit_shape(world, talus_world_ground(world), &def);
}

static talus_body ball_at(talus_world *world, double x, double y, double z, float radius, double mass,
                          talus_material material) {
    talus_body body = kit_body(world, TALUS_DYNAMIC, kit_vec((float)x, (float)y, (float)z));
    talus_shape_def def = kit_ball_def(radius);
    def.material = material;
    def.density = (float)(mass / (4.0 / 3.0 * PI * pow((double)radius, 3.0)));
    kit_shape(world, body, &def);
    return body;
}

static double square(double x) { return x * x; }

static double error_of(const talus_world *world, talus_body body, double speed, const double way[2]) {
    talus_vec3 v = kit_velocity(world, body);
    return square((double)v.x - speed * way[0]) + square((double)v.y) + square((double)v.z - speed * way[1]);
}

/* A box of 20 x 1 x 20 m and 10 kg, 25 balls of 1 kg on it, is drawn by 150 N along the floor: it slides while the
 * balls roll on it. With f1 the friction of the floor (0.4 of the weight) and f2 that of one ball: M a1 = F - f1 - 25
 * f2, m a2 = f2, and the ball's surface keeps up with the box: a1 = 3.5 a2. */
static void rolling_along(const double way[2], const char *name, const char *published) {
    talus_world world = world_1ms((float)G);
    ground_of(&world, material_of(0.5f, 0.0f));
    talus_body box = kit_body(&world, TALUS_DYNAMIC, kit_vec(0.0f, 0.5f - 2e-5f, 0.0f));
    talus_shape_def def = kit_box_def(10.0f, 0.5f, 10.0f);
    def.material = material_of(0.8f, 0.0f);
    def.density = 10.0f / 400.0f;
    kit_shape(&world, box, &def);
    talus_body first = box;
    for (int i = 0; i < 25; i++) {
        talus_body ball =
            ball_at(&world, i / 5 * 2.0 - 4.0, 1.5 - 6e-5, i % 5 * 2.0 - 4.0, 0.5f, 1.0, material_of(1.0f, 0.0f));
        first = i ? first : ball;
    }
    const double f1 = 0.4 * 35.0 * G, f2 = (150.0 - f1) / 10.0 / (3.5 + 2.5),
                 box_speed = (150.0 - f1 - 25.0 * f2) / 10.0;
    CLOSE(box_speed, 0.7385, 5e-5);
    CLOSE(f2, 0.211, 5e-5);
    const int steps = 4000;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        sum += error_of(&world, box, box_speed * i * 1e-3, way) + error_of(&world, first, f2 * i * 1e-3, way);
        talus_vec3 force = kit_vec((float)(150.0 * way[0]), 0.0f, (float)(150.0 * way[1]));
        OK(talus_body_apply_force(&world, box, force, kit_place(&world, box)));
        step_ms(&world);
    }
    told(name, sum / steps, "m^2/s^2", 1e-6, published);
    kit_end(&world);
}

static void rolling(void **state) {
    (void)state;
    const double slanting[2] = {0.5, STRAIGHT}, straight[2] = {0.0, 1.0};
    rolling_along(slanting, "rolling", "Bullet 5.7e-9, RaiSim 4.1e-7, MuJoCo 6.9e-3, ODE 3.14, DART 3.14");
    rolling_along(straight, "rolling along an axis",
                  "Bullet 4.9e-9, ODE 7.7e-9, RaiSim 4.1e-7, MuJoCo 9.2e-3, DART 0.43");
}

/* J: of balls of 10 kg, less `base`, that of the start. */
static double energy_of(const talus_world *world, const talus_body *ball, int count, double base) {
    double sum = -base;
    for (int i = 0; i < count; i++) {
        talus_vec3 v, w;
        OK(talus_body_get_velocity(world, ball[i], &v, &w));
        double vv = square((double)v.x) + square((double)v.y) + square((double)v.z);
        double ww = square((double)w.x) + square((double)w.y) + square((double)w.z);
        sum += 10.0 * (0.5 * vv + 0.5 * 0.4 * 0.01 * ww + G * (double)kit_place(world, ball[i]).y);
    }
    return sum;
}

/* 49 balls of 10 kg fall from 5 m and bounce without loss for 20 s. */
static void bouncing(void **state) {
    (void)state;
    talus_world world = world_1ms((float)G);
    talus_body ball[49];
    ground_of(&world, material_of(0.0f, 1.0f));
    for (int i = 0; i < 49; i++) {
        ball[i] = ball_at(&world, i / 7 * 2.0, 5.0, i % 7 * 2.0, 0.1f, 10.0, material_of(0.0f, 1.0f));
    }
    const int steps = 20000;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        sum += square(energy_of(&world, ball, 49, 49.0 * 10.0 * G * 5.0));
        step_ms(&world);
    }
    told("bouncing", sum / steps, "J^2", 100.0, "RaiSim 0.0186, ODE 185, DART 7.2e4, Bullet 7.5e4");
    kit_end(&world);
}

/* 0..1 of a Lehmer generator: their seed is kept, their generator is not known. */
static double drawn(uint64_t *seed) {
    *seed = *seed * 48271u % 2147483647u;
    return (double)*seed / 2147483647.0;
}

/* A cube of 6 x 6 x 6 balls of 10 kg, a centimetre apart, its lowest centres at `base`. */
static void cube_of(talus_world *world, double base, float restitution, talus_body ball[216]) {
    uint64_t seed = 42;
    ground_of(world, material_of(0.0f, restitution));
    for (int i = 0; i < 216; i++) {
        double x = i / 36 * 0.21 + drawn(&seed) * 1e-3, z = i / 6 % 6 * 0.21 + drawn(&seed) * 1e-3;
        double y = i % 6 * 0.21 + drawn(&seed) * 1e-3 + base;
        ball[i] = ball_at(world, x, y, z, 0.1f, 10.0, material_of(0.0f, restitution));
    }
}

/* m^2: the sum of the squares of how deep balls overlap each other and the floor. */
static double overlap_of(const talus_world *world, const talus_body ball[216]) {
    talus_vec3 place[216];
    double sum = 0.0;
    for (int i = 0; i < 216; i++) {
        place[i] = kit_place(world, ball[i]);
        sum += square(fmax(0.1 - (double)place[i].y, 0.0));
        for (int k = 0; k < i; k++) {
            double x = (double)place[i].x - (double)place[k].x, y = (double)place[i].y - (double)place[k].y;
            double z = (double)place[i].z - (double)place[k].z, d = x * x + y * y + z * z;
            sum += d < 0.04 ? square(0.2 - sqrt(d)) : 0.0;
        }
    }
    return sum;
}

/* The cube falls a millimetre and comes apart. */
static void cube(void **state) {
    (void)state;
    talus_world world = world_1ms((float)G);
    talus_body ball[216];
    cube_of(&world, 0.101, 0.0f, ball);
    const int steps = steps_of(10000, 1000);
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        sum += overlap_of(&world, ball);
        step_ms(&world);
    }
    told("666", sum / steps, "m^2", 6e-6, "RaiSim 1.35e-4, ODE 1.55e-4, DART 2.8e-4, MuJoCo 0.095, Bullet 0.38");
    kit_end(&world);
}

/* The cube falls a metre and bounces without loss. */
static void elastic_cube(void **state) {
    (void)state;
    talus_world world = world_1ms((float)G);
    talus_body ball[216];
    cube_of(&world, 1.101, 1.0f, ball);
    const double before = energy_of(&world, ball, 216, 0.0);
    const int steps = steps_of(10000, 1000);
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        sum += square(energy_of(&world, ball, 216, before));
        step_ms(&world);
    }
    told("elastic 666", sum / steps, "J^2", 1e5, "RaiSim 8.4, ODE 112, Bullet 4.1e4, DART 3.5e5");
    kit_end(&world);
}

/* A free body with moments 1, 2 and 3 kg m^2, spun about the middle one, about which it turns over, for 10 s. */
static void free_body(void **state) {
    (void)state;
    talus_world world = world_1ms(0.0f);
    talus_body body = mass_of(&world, kit_vec(0.0f, 0.0f, 0.0f), 10.0f, 1.0f, 2.0f, 3.0f);
    const double moment[3] = {1.0, 2.0, 3.0};
    set_velocity(&world, body, kit_vec(1.0f, 2.0f, 3.0f), kit_vec(0.1f, 5.0f, 0.2f));
    const int steps = steps_of(10000, 2000);
    double first[4] = {0.0, 0.0, 0.0, 0.0}, worst[2] = {0.0, 0.0};
    for (int i = 0; i <= steps; i++) {
        talus_vec3 v, w;
        OK(talus_body_get_velocity(&world, body, &v, &w));
        talus_quat q = kit_pose_of(&world, body).rotation, back = {-q.x, -q.y, -q.z, q.w};
        double spin[3] = {(double)w.x, (double)w.y, (double)w.z}, own[3], l[3], momentum[3];
        double energy = 5.0 * (square((double)v.x) + square((double)v.y) + square((double)v.z)), off = 0.0;
        turned(back, spin, own);
        for (int k = 0; k < 3; k++) {
            l[k] = moment[k] * own[k];
            energy += 0.5 * l[k] * own[k];
        }
        turned(q, l, momentum);
        for (int k = 0; k < 3; k++) {
            first[k] = i ? first[k] : momentum[k];
            off += square(momentum[k] - first[k]);
        }
        first[3] = i ? first[3] : energy;
        worst[0] = fmax(worst[0], fabs(energy - first[3]) / first[3]);
        worst[1] = fmax(worst[1], sqrt(off / (square(first[0]) + square(first[1]) + square(first[2]))));
        step_ms(&world);
    }
    told("free body, energy", worst[0], "of it", 2e-5, "");
    told("free body, momentum", worst[1], "of it", 2e-5, "");
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rolling),      cmocka_unit_test(bouncing),  cmocka_unit_test(cube),
        cmocka_unit_test(elastic_cube), cmocka_unit_test(free_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
