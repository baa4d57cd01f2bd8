// Access: the components that a function uses. System: a function that a schedule runs, each tick or each
// frame.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "engine/ecs/registry.hpp"

namespace bolt::ecs {

// True if a registry or an access has components of this type.
template <class World, class Component>
concept Provides = requires(World& world) {
    { &world.template pool<std::remove_const_t<Component>>() } -> std::convertible_to<PoolOf<Component>*>;
};

// The part of a registry that a function uses: a list of component types, const if it only reads them. Every
// registry that has these components converts to it, so the same function works on a world with graphics and
// on one without.
//
//   double torque(const ecs::Access<const Joint, const Tool>& world) { return world.only<Tool>().torque; }
//
// An Access refers to the pools of its registry and must not outlive it. It cannot create or destroy
// entities.
template <class... Components>
class Access {
  public:
    // Converts a registry, or an access to more components. A const registry or access gives no mutable
    // components.
    template <class World>
    requires(!std::same_as<std::remove_cvref_t<World>, Access> &&
             (Provides<std::remove_reference_t<World>, Components> && ...)) Access(World&& world)
        : pools_{&world.template pool<std::remove_const_t<Components>>()...} {}

    // Returns the components of a type and their entities; const if this access only reads them.
    template <class Component>
    [[nodiscard]] auto& pool() const {
        constexpr bool writes = (std::is_same_v<Component, Components> || ...);
        return *std::get<PoolOf<std::conditional_t<writes, Component, const Component>>*>(pools_);
    }

    // Returns null if the entity is not alive or has no such component.
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

    template <class... Selected>
    [[nodiscard]] View<Selected...> view() const {
        return View<Selected...>(pool<std::remove_const_t<Selected>>()...);
    }

  private:
    std::tuple<PoolOf<Components>*...> pools_;
};

// A free function over the world and a context. run() runs an array of systems in order:
//
//   constexpr ecs::System<World, Frame> frame[] = {{"haptics", haptic_system}, {"lesson", lesson_system}};
//   ecs::run(frame, world, context);
template <class World, class Context>
struct System {
    std::string_view name;
    void (*run)(World&, Context&) = nullptr;
};

// Runs the systems. `around(name, run)` is called for each of them and must call run(); use it for timing.
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
