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
#include <tuple>
#include <type_traits>

#include "engine/ecs/view.hpp"

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

}  // namespace bolt::ecs
