// The registry against two plain arrays that do the same work. The ratio is the cost of entities.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "engine/base/random.hpp"
#include "engine/ecs/registry.hpp"

namespace {

using namespace bolt;

struct Pose {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};
struct Velocity {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};
using World = ecs::Registry<Pose, Velocity>;

void move(Pose& pose, const Velocity& velocity) {
    pose.x += 1e-3F * velocity.x;
    pose.y += 1e-3F * velocity.y;
    pose.z += 1e-3F * velocity.z;
}

constexpr std::int64_t million = 1'000'000;

void iterate_plain_arrays(benchmark::State& state) {
    std::vector<Pose> poses(static_cast<std::size_t>(state.range(0)));
    std::vector<Velocity> velocities(poses.size(), Velocity{1.0F, 2.0F, 3.0F});
    for (auto _ : state) {
        for (std::size_t i = 0; i < poses.size(); ++i) move(poses[i], velocities[i]);
        benchmark::DoNotOptimize(poses.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(iterate_plain_arrays)->Arg(million);

World populated(std::int64_t count) {
    World world;
    for (std::int64_t i = 0; i < count; ++i) {
        const ecs::Entity entity = world.create();
        world.add<Pose>(entity);
        world.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
    }
    return world;
}

void walk(benchmark::State& state, World& world) {
    for (auto _ : state) {
        world.view<Pose, const Velocity>().each([](Pose& pose, const Velocity& v) { move(pose, v); });
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

// Both pools in the same order, as after creating long-lived entities once.
void iterate_two_components(benchmark::State& state) {
    World world = populated(state.range(0));
    walk(state, world);
}
BENCHMARK(iterate_two_components)->Arg(million);

// The pools in unrelated orders: the worst case of a sparse set.
void iterate_two_components_shuffled(benchmark::State& state) {
    World world = populated(state.range(0));
    std::vector<ecs::Entity> entities(world.pool<Pose>().entities().begin(),
                                      world.pool<Pose>().entities().end());
    Random random(1);
    for (std::size_t i = entities.size(); i > 1; --i) std::swap(entities[i - 1], entities[random.bits() % i]);
    for (const ecs::Entity entity : entities) world.remove<Velocity>(entity);
    for (const ecs::Entity entity : entities) world.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
    walk(state, world);
}
BENCHMARK(iterate_two_components_shuffled)->Arg(million);

// The baseline of creation: the same numbers appended to two arrays; neither side reserves memory.
void create_in_plain_arrays(benchmark::State& state) {
    for (auto _ : state) {
        std::vector<Pose> poses;
        std::vector<Velocity> velocities;
        for (std::int64_t i = 0; i < state.range(0); ++i) {
            poses.emplace_back();
            velocities.push_back({1.0F, 2.0F, 3.0F});
        }
        benchmark::DoNotOptimize(poses.data());
        benchmark::DoNotOptimize(velocities.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(create_in_plain_arrays)->Arg(million);

void create_and_destroy(benchmark::State& state) {
    World world;
    std::vector<ecs::Entity> entities(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        for (ecs::Entity& entity : entities) {
            entity = world.create();
            world.add<Pose>(entity);
            world.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
        }
        for (const ecs::Entity entity : entities) world.destroy(entity);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(create_and_destroy)->Arg(million);

}  // namespace
