#include "engine/ecs/registry.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <set>
#include <string>

#include "engine/ecs/system.hpp"

namespace ecs_registry_test {

using namespace bolt::ecs;

namespace {

struct Pose {
    double x = 0.0;
};
struct Velocity {
    double x = 0.0;
};
struct Handle {  // move-only, like an owner of a resource
    std::unique_ptr<int> resource;
};
using World = Registry<Pose, Velocity, Handle>;

}  // namespace

TEST_CASE("Registry: a stale entity never refers to the next one in its slot") {
    World world;
    const Entity first = world.create();
    world.add<Pose>(first, 1.0);
    world.destroy(first);
    const Entity second = world.create();
    REQUIRE(second.index == first.index);
    world.add<Pose>(second, 2.0);
    CHECK_FALSE(world.alive(first));
    CHECK(world.find<Pose>(first) == nullptr);
    CHECK_FALSE(world.remove<Pose>(first));
    CHECK(world.get<Pose>(second).x == 2.0);
    CHECK_FALSE(world.alive(Entity{}));
    CHECK(world.find<Pose>(Entity{}) == nullptr);
    CHECK_FALSE(world.alive(Entity{7, 1}));
}

TEST_CASE("Registry: clear() invalidates every entity and starts again") {
    World world;
    const Entity kept = world.create();
    const Entity gone = world.create();
    world.destroy(gone);
    world.clear();
    CHECK(world.size() == 0);
    CHECK_FALSE(world.alive(kept));
    for (int i = 0; i < 4; ++i) {
        const Entity entity = world.create();
        CHECK(entity != kept);
        CHECK(entity != gone);
        CHECK(world.find<Pose>(entity) == nullptr);
    }
}

TEST_CASE("Registry: destroying and replacing components releases their resources") {
    World world;
    const Entity entity = world.create();
    world.add<Handle>(entity, std::make_unique<int>(3));
    world.add<Handle>(entity, std::make_unique<int>(4));
    CHECK(world.pool<Handle>().size() == 1);
    CHECK(*world.get<Handle>(entity).resource == 4);
    world.destroy(entity);
    CHECK(world.pool<Handle>().size() == 0);
}

TEST_CASE("View: the visited entity may be destroyed and new ones created during iteration") {
    World world;
    std::set<double> expected;
    for (int i = 0; i < 100; ++i) {
        const Entity entity = world.create();
        world.add<Pose>(entity, static_cast<double>(i));
        if (i % 3 != 0) world.add<Velocity>(entity, 1.0);
        if (i % 3 != 0) expected.insert(i);
    }
    std::set<double> visited;
    world.view<Pose, Velocity>().each([&](Entity entity, Pose& pose, Velocity&) {
        CHECK(visited.insert(pose.x).second);
        const bool odd = static_cast<int>(pose.x) % 2 == 1;
        if (odd) world.destroy(entity);
        const Entity born = world.create();
        world.add<Pose>(born, -1.0);
        world.add<Velocity>(born, 0.0);
    });
    CHECK(visited == expected);
}

TEST_CASE("View: without the entity parameter, over one pool, and without matches") {
    World world;
    double sum = 0.0;
    for (int i = 1; i <= 4; ++i) world.add<Pose>(world.create(), static_cast<double>(i));
    world.view<const Pose>().each([&](const Pose& pose) { sum += pose.x; });
    CHECK(sum == 10.0);
    const auto none = world.view<Pose, Velocity>();
    CHECK(none.bound() == 0);
    none.each([](Pose&, Velocity&) { FAIL("visited"); });
}

namespace {

struct Frame {
    double dt = 0.0;
    std::string trace;
};
void accelerate(World& world, Frame& frame) {
    world.view<Velocity>().each([&](Velocity& v) { v.x += 2.0 * frame.dt; });
}
void move(World& world, Frame& frame) {
    world.view<Pose, const Velocity>().each([&](Pose& p, const Velocity& v) { p.x += v.x * frame.dt; });
}
constexpr System<World, Frame> systems[] = {{"accelerate", accelerate}, {"move", move}};

}  // namespace

TEST_CASE("Schedule: systems run in list order and can be timed") {
    World world;
    const Entity entity = world.create();
    world.add<Pose>(entity);
    world.add<Velocity>(entity, 1.0);
    Frame frame{0.5, {}};
    run(systems, world, frame);
    CHECK(world.get<Pose>(entity).x == 1.0);  // the new velocity moved it: 1 + 2 · 0.5
    run(systems, world, frame, [&](std::string_view name, auto&& system) {
        system();
        frame.trace += std::string(name) + ";";
    });
    CHECK(frame.trace == "accelerate;move;");
}

}  // namespace ecs_registry_test
