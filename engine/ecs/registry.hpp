// Entities and their components, one pool per type. The component types are a template parameter pack: there
// is no type erasure, no virtual call and no global type registry, and an unlisted component type does not
// compile.
//
//   using World = ecs::Registry<Pose, Velocity, Nut>;
//   World world;
//   const ecs::Entity nut = world.create();
//   world.add<Pose>(nut, position);
//   world.view<Pose, const Velocity>().each([&](Pose& pose, const Velocity& v) { pose.position += dt *
//   v.linear; });
#pragma once

#include <cassert>
#include <tuple>
#include <utility>

#include "engine/ecs/view.hpp"

namespace bolt::ecs {

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

    template <class Component>
    bool remove(Entity entity) {
        return pool<Component>().erase(entity);
    }

    // Returns null if the entity has none or is not alive.
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

    template <class... Wanted>
    [[nodiscard]] View<Wanted...> view() {
        return View<Wanted...>(pool<std::remove_const_t<Wanted>>()...);
    }

    // All components of a type and their entities, as parallel arrays.
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
