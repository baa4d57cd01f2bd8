// Registry: entities and their components. View: iterates over the entities that have given components.
#pragma once

#include <algorithm>
#include <cassert>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/ecs/pool.hpp"

namespace bolt::ecs {

// The pool of a component type; const if the type is const.
template <class Component>
using PoolOf = std::conditional_t<std::is_const_v<Component>, const Pool<std::remove_const_t<Component>>,
                                  Pool<std::remove_const_t<Component>>>;

// All entities that have all of the given components: iterates over the smallest pool and looks up the
// others.
//
//   view.each([](Entity entity, Pose& pose, const Velocity& velocity) { ... });   or without the entity
//
// Iteration goes from the last to the first entity. The callback may destroy the visited entity, remove its
// components and create entities (which are not visited). It must not destroy other
// entities: collect them and destroy them afterwards.
template <class... Components>
class View {
    static_assert(sizeof...(Components) > 0);

  public:
    explicit View(PoolOf<Components>&... pools) : pools_{&pools...} {}

    template <class Function>
    void each(Function&& function) const {
        each_from_shortest(function, Indices{});
    }

    // Returns the maximum number of visited entities.
    [[nodiscard]] std::size_t bound() const {
        return std::apply([](const auto*... pool) { return std::min({pool->size()...}); }, pools_);
    }

  private:
    using Indices = std::index_sequence_for<Components...>;

    template <class Function, std::size_t... I>
    void each_from_shortest(Function& function, std::index_sequence<I...>) const {
        const std::size_t shortest = bound();
        bool done = false;
        ((!done && std::get<I>(pools_)->size() == shortest ? (done = true, iterate<I>(function, Indices{}))
                                                           : void()),
         ...);
    }

    // Iterates over pool `First` and looks up the others.
    template <std::size_t First, class Function, std::size_t... I>
    void iterate(Function& function, std::index_sequence<I...>) const {
        auto& first = *std::get<First>(pools_);
        for (std::size_t at = first.size(); at-- > 0;) {
            if (at >= first.size()) continue;  // the callback destroyed others, which it must not
            const Entity entity = first.entities()[at];
            const std::tuple<Components*...> found{component<First, I>(entity, at)...};
            if (!(... && (std::get<I>(found) != nullptr))) continue;
            if constexpr (std::is_invocable_v<Function&, Entity, Components&...>)
                function(entity, *std::get<I>(found)...);
            else
                function(*std::get<I>(found)...);
        }
    }

    template <std::size_t First, std::size_t I>
    auto* component(Entity entity, std::size_t at) const {
        if constexpr (I == First)
            return &std::get<I>(pools_)->components()[at];
        else
            return std::get<I>(pools_)->find(entity);
    }

    std::tuple<PoolOf<Components>*...> pools_;
};

// Entities and their components, one pool per type. The component types are a template parameter pack: there
// is no type erasure, no virtual call and no global type registry, and an unlisted component type does not
// compile.
//
//   using World = ecs::Registry<Pose, Velocity, Nut>;
//   World world;
//   const ecs::Entity nut = world.create();
//   world.add<Pose>(nut, position);
//   world.view<Pose, const Velocity>().each(
//       [&](Pose& pose, const Velocity& v) { pose.position += dt * v.linear; });
template <class... Components>
class Registry {
  public:
    [[nodiscard]] Entity create() { return entities_.create(); }

    // Destroys an entity with all its components; returns false if it was not alive.
    bool destroy(Entity entity) {
        if (!entities_.destroy(entity)) return false;
        (pool<Components>().erase(entity), ...);
        return true;
    }

    [[nodiscard]] bool alive(Entity entity) const { return entities_.alive(entity); }
    [[nodiscard]] std::size_t size() const { return entities_.size(); }

    // Sets the component of a living entity, replacing an existing one.
    template <class Component, class... Arguments>
    Component& add(Entity entity, Arguments&&... arguments) {
        assert(alive(entity));
        if (Component* old = pool<Component>().find(entity))
            return *old = Component{std::forward<Arguments>(arguments)...};
        return pool<Component>().insert(entity, std::forward<Arguments>(arguments)...);
    }

    // Returns false if the entity has no such component.
    template <class Component>
    bool remove(Entity entity) {
        return pool<Component>().erase(entity);
    }

    // Returns null if the entity is not alive or has no such component.
    template <class Component>
    [[nodiscard]] Component* find(Entity entity) {
        return pool<Component>().find(entity);
    }
    template <class Component>
    [[nodiscard]] const Component* find(Entity entity) const {
        return pool<Component>().find(entity);
    }

    // Returns the component, which must exist.
    template <class Component>
    [[nodiscard]] Component& get(Entity entity) {
        Component* component = find<Component>(entity);
        assert(component != nullptr);
        return *component;
    }

    // Returns the component of a type that exactly one entity has.
    template <class Component>
    [[nodiscard]] Component& only() {
        assert(pool<Component>().size() == 1);
        return pool<Component>().components().front();
    }
    template <class Component>
    [[nodiscard]] const Component& only() const {
        assert(pool<Component>().size() == 1);
        return pool<Component>().components().front();
    }

    template <class... Selected>
    [[nodiscard]] View<Selected...> view() {
        return View<Selected...>(pool<std::remove_const_t<Selected>>()...);
    }

    // Returns all components of a type and their entities, as parallel arrays.
    template <class Component>
    [[nodiscard]] Pool<Component>& pool() {
        return std::get<Pool<Component>>(pools_);
    }
    template <class Component>
    [[nodiscard]] const Pool<Component>& pool() const {
        return std::get<Pool<Component>>(pools_);
    }

    void clear() {
        entities_.clear();
        (pool<Components>().clear(), ...);
    }

  private:
    Entities entities_;
    std::tuple<Pool<Components>...> pools_;
};

}  // namespace bolt::ecs
