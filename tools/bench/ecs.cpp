// Benchmarks of the registry. The baseline does the same work on two plain arrays; the ratio is the cost of
// entities.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "engine/base/random.hpp"
#include "engine/ecs/registry.hpp"

namespace {

using namespace bolt;

struct Position {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};
struct Velocity {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};
using BenchRegistry = ecs::Registry<Position, Velocity>;

void move(Position& pose, const Velocity& velocity) {
    pose.x += 1e-3F * velocity.x;
    pose.y += 1e-3F * velocity.y;
    pose.z += 1e-3F * velocity.z;
}

constexpr std::int64_t million = 1'000'000;

void iterate_plain_arrays(benchmark::State& state) {
    std::vector<Position> poses(static_cast<std::size_t>(state.range(0)));
    std::vector<Velocity> velocities(poses.size(), Velocity{1.0F, 2.0F, 3.0F});
    for (auto _ : state) {
        for (std::size_t i = 0; i < poses.size(); ++i) move(poses[i], velocities[i]);
        benchmark::DoNotOptimize(poses.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(iterate_plain_arrays)->Arg(million);

BenchRegistry make_registry(std::int64_t count) {
    BenchRegistry registry;
    for (std::int64_t i = 0; i < count; ++i) {
        const ecs::Entity entity = registry.create();
        registry.add<Position>(entity);
        registry.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
    }
    return registry;
}

void measure_iteration(benchmark::State& state, BenchRegistry& registry) {
    for (auto _ : state) {
        registry.view<Position, const Velocity>().each(
            [](Position& pose, const Velocity& v) { move(pose, v); });
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

// Both pools have the same order, as after creating long-lived entities once.
void iterate_two_components(benchmark::State& state) {
    BenchRegistry registry = make_registry(state.range(0));
    measure_iteration(state, registry);
}
BENCHMARK(iterate_two_components)->Arg(million);

// The pools have unrelated orders, the worst case of a sparse set.
void iterate_two_components_shuffled(benchmark::State& state) {
    BenchRegistry registry = make_registry(state.range(0));
    std::vector<ecs::Entity> entities(registry.pool<Position>().entities().begin(),
                                      registry.pool<Position>().entities().end());
    Random random(1);
    for (std::size_t i = entities.size(); i > 1; --i) std::swap(entities[i - 1], entities[random.bits() % i]);
    for (const ecs::Entity entity : entities) registry.remove<Velocity>(entity);
    for (const ecs::Entity entity : entities) registry.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
    measure_iteration(state, registry);
}
BENCHMARK(iterate_two_components_shuffled)->Arg(million);

// Baseline of creation: appends the same values to two arrays. Neither side reserves memory.
void create_in_plain_arrays(benchmark::State& state) {
    for (auto _ : state) {
        std::vector<Position> poses;
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
    BenchRegistry registry;
    std::vector<ecs::Entity> entities(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        for (ecs::Entity& entity : entities) {
            entity = registry.create();
            registry.add<Position>(entity);
            registry.add<Velocity>(entity, 1.0F, 2.0F, 3.0F);
        }
        for (const ecs::Entity entity : entities) registry.destroy(entity);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(create_and_destroy)->Arg(million);

}  // namespace
