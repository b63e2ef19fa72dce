#include "box2d_shim.h"

#include <vector>

#include <box2d/box2d.h>

struct flat_world {
    b2World world;
    std::vector<b2Body *> bodies;
    explicit flat_world(b2Vec2 gravity) : world(gravity) {
        b2BodyDef def;
        bodies.push_back(world.CreateBody(&def));
        world.SetAllowSleeping(false);
    }
};

flat_world *flat_new(float gravity_x, float gravity_y) { return new flat_world(b2Vec2(gravity_x, gravity_y)); }
void flat_free(flat_world *world) { delete world; }

int flat_body(flat_world *world, flat_type type, flat_state at, float damping) {
    b2BodyDef def;
    def.type = type == FLAT_STATIC ? b2_staticBody : type == FLAT_KINEMATIC ? b2_kinematicBody : b2_dynamicBody;
    def.position.Set(at.x, at.y);
    def.angle = at.angle;
    def.linearVelocity.Set(at.vx, at.vy);
    def.angularVelocity = at.spin;
    def.linearDamping = def.angularDamping = damping;
    world->bodies.push_back(world->world.CreateBody(&def));
    return static_cast<int>(world->bodies.size()) - 1;
}

static void add(flat_world *world, int body, const b2Shape *shape, float density, float friction, float restitution) {
    b2FixtureDef def;
    def.shape = shape;
    def.density = density;
    def.friction = friction;
    def.restitution = restitution;
    world->bodies[static_cast<size_t>(body)]->CreateFixture(&def);
}

void flat_box(flat_world *world, int body, float x, float y, float half_x, float half_y, float density, float friction,
              float restitution) {
    b2PolygonShape shape;
    shape.SetAsBox(half_x, half_y, b2Vec2(x, y), 0.0f);
    add(world, body, &shape, density, friction, restitution);
}

void flat_disc(flat_world *world, int body, float radius, float density, float friction, float restitution) {
    b2CircleShape shape;
    shape.m_radius = radius;
    add(world, body, &shape, density, friction, restitution);
}

void flat_hinge(flat_world *world, int a, int b, float x, float y) {
    b2RevoluteJointDef def;
    def.Initialize(world->bodies[static_cast<size_t>(a)], world->bodies[static_cast<size_t>(b)], b2Vec2(x, y));
    world->world.CreateJoint(&def);
}

void flat_move(flat_world *world, int body, float vx, float vy) {
    world->bodies[static_cast<size_t>(body)]->SetLinearVelocity(b2Vec2(vx, vy));
}

void flat_step(flat_world *world, float dt) { world->world.Step(dt, 8, 3); }

flat_state flat_get(const flat_world *world, int body) {
    const b2Body *b = world->bodies[static_cast<size_t>(body)];
    flat_state s = {b->GetPosition().x,       b->GetPosition().y,       b->GetAngle(),
                    b->GetLinearVelocity().x, b->GetLinearVelocity().y, b->GetAngularVelocity()};
    return s;
}
