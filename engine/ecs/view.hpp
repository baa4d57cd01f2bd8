// All entities that have all of the given components: iterates over the smallest pool and looks up the
// others.
//
//   view.each([](Entity entity, Pose& pose, const Velocity& velocity) { ... });   or without the entity
//
// Iteration goes from the last to the first entity. The callback may destroy the visited entity, remove its
// components and create entities (which are not visited). It must not destroy other entities: collect them
// and destroy them afterwards.
#pragma once

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/ecs/pool.hpp"

namespace bolt::ecs {

// The pool of a component type that is const where it is only read.
template <class Component>
using PoolOf = std::conditional_t<std::is_const_v<Component>, const Pool<std::remove_const_t<Component>>,
                                  Pool<std::remove_const_t<Component>>>;

template <class... Components>
class View {
    static_assert(sizeof...(Components) > 0);

  public:
    explicit View(PoolOf<Components>&... pools) : pools_{&pools...} {}

    template <class Function>
    void each(Function&& function) const {
        each_from_shortest(function, Indices{});
    }

    // The maximum number of visited entities.
    [[nodiscard]] std::size_t bound() const {
        return std::apply([](const auto*... pool) { return std::min({pool->size()...}); }, pools_);
    }

  private:
    using Indices = std::index_sequence_for<Components...>;

    template <class Function, std::size_t... I>
    void each_from_shortest(Function& function, std::index_sequence<I...>) const {
        const std::size_t shortest = bound();
        bool walked = false;
        ((!walked && std::get<I>(pools_)->size() == shortest ? (walked = true, walk<I>(function, Indices{}))
                                                             : void()),
         ...);
    }

    // Iterates over pool `First` and looks up the others.
    template <std::size_t First, class Function, std::size_t... I>
    void walk(Function& function, std::index_sequence<I...>) const {
        auto& first = *std::get<First>(pools_);
        for (std::size_t at = first.size(); at-- > 0;) {
            if (at >= first.size()) continue;  // the callback erased more than the visited entity
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

}  // namespace bolt::ecs
