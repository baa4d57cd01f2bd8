// All entities that have every one of some components: walks the smallest of their pools and looks the others
// up.
//
//   view.each([](Entity entity, Pose& pose, const Velocity& velocity) { ... });   or without the entity
//
// It goes from the last to the first, so while it stands at an entity, that entity may be destroyed or lose
// components, and new entities may be made (they are not visited). Others may not be destroyed meanwhile:
// collect them and do it afterwards.
#pragma once

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/ecs/pool.hpp"

namespace bolt::ecs {

template <class... Components>
class View {
    static_assert(sizeof...(Components) > 0);

  public:
    explicit View(Pool<std::remove_const_t<Components>>&... pools) : pools_{&pools...} {}

    template <class Function>
    void each(Function&& function) const {
        each_from_shortest(function, Indices{});
    }

    // How many entities it visits at most.
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

    // Walks pool `First`; the others are looked up.
    template <std::size_t First, class Function, std::size_t... I>
    void walk(Function& function, std::index_sequence<I...>) const {
        auto& first = *std::get<First>(pools_);
        for (std::size_t at = first.size(); at-- > 0;) {
            if (at >= first.size()) continue;  // the function erased more than where it stood
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

    std::tuple<Pool<std::remove_const_t<Components>>*...> pools_;
};

}  // namespace bolt::ecs
