// The components of one type: a sparse set (Briggs and Torczon 1993). Components lie side by side in `dense`
// order; a sparse index in pages leads from an entity's slot to its place. Insert, erase and find take
// constant time; walking them is walking an array. Erasing moves the last component into the hole: order is
// not kept, and pointers to components last only until something is inserted or erased.
#pragma once

#include <array>
#include <cassert>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace bolt::ecs {

template <class Component>
class Pool {
  public:
    // The component of an entity that has none yet.
    template <class... Arguments>
    Component& insert(Entity entity, Arguments&&... arguments) {
        assert(!contains(entity));
        components_.push_back(Component{std::forward<Arguments>(arguments)...});
        entities_.push_back(entity);
        slot(entity.index) = static_cast<std::uint32_t>(entities_.size() - 1);
        return components_.back();
    }

    // False if it had none.
    bool erase(Entity entity) {
        const std::uint32_t place = place_of(entity);
        if (place == Entity::none) return false;
        if (place + 1 != entities_.size()) {
            components_[place] = std::move(components_.back());
            entities_[place] = entities_.back();
            slot(entities_[place].index) = place;
        }
        components_.pop_back();
        entities_.pop_back();
        slot(entity.index) = Entity::none;
        return true;
    }

    [[nodiscard]] bool contains(Entity entity) const { return place_of(entity) != Entity::none; }

    // Null if it has none.
    [[nodiscard]] Component* find(Entity entity) {
        const std::uint32_t place = place_of(entity);
        return place == Entity::none ? nullptr : &components_[place];
    }
    [[nodiscard]] const Component* find(Entity entity) const { return const_cast<Pool*>(this)->find(entity); }

    [[nodiscard]] std::size_t size() const { return entities_.size(); }
    [[nodiscard]] std::span<const Entity> entities() const { return entities_; }
    [[nodiscard]] std::span<Component> components() { return components_; }
    [[nodiscard]] std::span<const Component> components() const { return components_; }

    void clear() {
        components_.clear();
        entities_.clear();
        pages_.clear();
    }

  private:
    static constexpr std::uint32_t page_size = 1024;
    using Page = std::array<std::uint32_t, page_size>;

    [[nodiscard]] std::uint32_t place_of(Entity entity) const {
        const std::size_t page = entity.index / page_size;
        if (page >= pages_.size() || !pages_[page]) return Entity::none;
        const std::uint32_t place = (*pages_[page])[entity.index % page_size];
        return place != Entity::none && entities_[place].generation == entity.generation ? place
                                                                                         : Entity::none;
    }

    std::uint32_t& slot(std::uint32_t index) {
        const std::size_t page = index / page_size;
        if (page >= pages_.size()) pages_.resize(page + 1);
        if (!pages_[page]) {
            pages_[page] = std::make_unique<Page>();
            pages_[page]->fill(Entity::none);
        }
        return (*pages_[page])[index % page_size];
    }

    std::vector<std::unique_ptr<Page>> pages_;
    std::vector<Entity> entities_;
    std::vector<Component> components_;
};

}  // namespace bolt::ecs
