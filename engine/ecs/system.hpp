// The part of a registry that a function uses: a list of component types, const where it only reads them.
// Every registry that has these components converts to it, so one function serves a world with pictures and
// one without.
//
//   using Watch = ecs::Access<const Joint, const Tool>;
//   double torque(const Watch& world) { return world.only<Tool>().torque; }
//
// An Access refers to the pools of its registry and must not outlive it. It neither creates nor destroys
// entities.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "engine/ecs/registry.hpp"

namespace bolt::ecs {

template <class World, class Component>
concept Provides = requires(World& world) {
    { &world.template pool<std::remove_const_t<Component>>() } -> std::convertible_to<PoolOf<Component>*>;
};

template <class... Components>
class Access {
  public:
    // From a registry, or from an access to more components. A component that is not const here must not be
    // const there.
    template <class World>
    requires(!std::same_as<std::remove_cvref_t<World>, Access> &&
             (Provides<std::remove_reference_t<World>, Components> && ...)) Access(World&& world)
        : pools_{&world.template pool<std::remove_const_t<Components>>()...} {}

    // The components of a type and their entities; const if this access only reads them.
    template <class Component>
    [[nodiscard]] auto& pool() const {
        constexpr bool writes = (std::is_same_v<Component, Components> || ...);
        return *std::get<PoolOf<std::conditional_t<writes, Component, const Component>>*>(pools_);
    }

    // Returns null if the entity has none or is not alive.
    template <class Component>
    [[nodiscard]] auto* find(Entity entity) const {
        return pool<Component>().find(entity);
    }

    // Returns the component of a type that exactly one entity has.
    template <class Component>
    [[nodiscard]] auto& only() const {
        assert(pool<Component>().size() == 1);
        return pool<Component>().components().front();
    }

    template <class... Wanted>
    [[nodiscard]] View<Wanted...> view() const {
        return View<Wanted...>(pool<std::remove_const_t<Wanted>>()...);
    }

  private:
    std::tuple<PoolOf<Components>*...> pools_;
};

// A frame as an ordered list of systems: free functions over the world and a context, run in the order of the
// list.
//
//   constexpr ecs::System<World, Frame> frame[] = {{"haptics", haptic_system}, {"lesson", lesson_system}};
//   ecs::run(frame, world, context);

template <class World, class Context>
struct System {
    std::string_view name;
    void (*run)(World&, Context&) = nullptr;
};

// `around(name, run)` is called for each system and must call run(); use it for timing and tracing.
template <class World, class Context, std::size_t count, class Around>
void run(const System<World, Context> (&systems)[count], World& world, Context& context, Around&& around) {
    for (const System<World, Context>& system : systems)
        around(system.name, [&] { system.run(world, context); });
}

template <class World, class Context, std::size_t count>
void run(const System<World, Context> (&systems)[count], World& world, Context& context) {
    for (const System<World, Context>& system : systems) system.run(world, context);
}

}  // namespace bolt::ecs
