// Compares the registry with a simple reference model over random operations.
#include <doctest/doctest.h>

#include <map>
#include <optional>

#include "engine/base/random.hpp"
#include "engine/ecs/registry.hpp"

using namespace bolt;
using namespace bolt::ecs;

namespace {

struct Position {
    double x = 0.0;
};
struct Velocity {
    double x = 0.0;
};
struct Name {
    std::string text;
};
using World = Registry<Position, Velocity, Name>;

struct Expected {
    Entity entity;
    std::optional<double> pose, velocity;
    std::optional<std::string> name;
};

}  // namespace

TEST_CASE("Registry: random operations agree with a reference model") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        World world;
        std::vector<Expected> model;
        std::vector<Entity> dead;
        for (int step = 0; step < 3000; ++step) {
            const double what = random.uniform();
            const std::size_t pick =
                model.empty()
                    ? 0
                    : static_cast<std::size_t>(random.uniform() * static_cast<double>(model.size()));
            if (model.empty() || what < 0.25) {
                model.push_back({world.create(), {}, {}, {}});
            } else if (what < 0.40) {
                dead.push_back(model[pick].entity);
                REQUIRE(world.destroy(model[pick].entity));
                model.erase(model.begin() + static_cast<std::ptrdiff_t>(pick));
            } else if (what < 0.60) {
                world.add<Position>(model[pick].entity, static_cast<double>(step));
                model[pick].pose = step;
            } else if (what < 0.75) {
                world.add<Velocity>(model[pick].entity, step + 0.5);
                model[pick].velocity = step + 0.5;
            } else if (what < 0.85) {
                world.add<Name>(model[pick].entity, std::to_string(step));
                model[pick].name = std::to_string(step);
            } else if (what < 0.95) {
                REQUIRE(world.remove<Position>(model[pick].entity) == model[pick].pose.has_value());
                model[pick].pose.reset();
            } else {
                REQUIRE(world.remove<Name>(model[pick].entity) == model[pick].name.has_value());
                model[pick].name.reset();
            }
        }
        REQUIRE(world.size() == model.size());
        std::map<std::pair<std::uint32_t, std::uint32_t>, double> both;
        for (const Expected& expected : model) {
            REQUIRE(world.alive(expected.entity));
            const Position* pose = world.find<Position>(expected.entity);
            REQUIRE((pose != nullptr) == expected.pose.has_value());
            if (pose != nullptr) REQUIRE(pose->x == *expected.pose);
            const Name* name = world.find<Name>(expected.entity);
            REQUIRE((name != nullptr) == expected.name.has_value());
            if (name != nullptr) REQUIRE(name->text == *expected.name);
            if (expected.pose && expected.velocity)
                both[{expected.entity.index, expected.entity.generation}] =
                    *expected.pose + *expected.velocity;
        }
        world.view<const Position, Velocity>().each(
            [&](Entity entity, const Position& pose, Velocity& velocity) {
                const auto found = both.find({entity.index, entity.generation});
                REQUIRE(found != both.end());
                REQUIRE(found->second == pose.x + velocity.x);
                both.erase(found);  // each entity is visited once
            });
        REQUIRE(both.empty());
        for (const Entity entity : dead) {
            REQUIRE_FALSE(world.alive(entity));
            REQUIRE(world.find<Position>(entity) == nullptr);
            REQUIRE_FALSE(world.destroy(entity));
        }
    }
}
