// The components of one type: a sparse set (Briggs and Torczon 1993). Components are stored contiguously; a
// paged sparse array maps an entity's slot to its dense index. Insert, erase and find take constant time;
// iteration walks an array. Erasing moves the last component into the gap: the order is not kept, and
// pointers to components are valid only until the next insert or erase.
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
    // Adds a component to an entity that has none.
    template <class... Arguments>
    Component& insert(Entity entity, Arguments&&... arguments) {
        assert(!contains(entity));
        components_.push_back(Component{std::forward<Arguments>(arguments)...});
        entities_.push_back(entity);
        slot(entity.index) = static_cast<std::uint32_t>(entities_.size() - 1);
        return components_.back();
    }

    // Returns false if the entity has none.
    bool erase(Entity entity) {
        const std::uint32_t dense = dense_index(entity);
        if (dense == Entity::none) return false;
        if (dense + 1 != entities_.size()) {
            components_[dense] = std::move(components_.back());
            entities_[dense] = entities_.back();
            slot(entities_[dense].index) = dense;
        }
        components_.pop_back();
        entities_.pop_back();
        slot(entity.index) = Entity::none;
        return true;
    }

    [[nodiscard]] bool contains(Entity entity) const { return dense_index(entity) != Entity::none; }

    // Returns null if the entity has none.
    [[nodiscard]] Component* find(Entity entity) {
        const std::uint32_t dense = dense_index(entity);
        return dense == Entity::none ? nullptr : &components_[dense];
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

    [[nodiscard]] std::uint32_t dense_index(Entity entity) const {
        const std::size_t page = entity.index / page_size;
        if (page >= pages_.size() || !pages_[page]) return Entity::none;
        const std::uint32_t dense = (*pages_[page])[entity.index % page_size];
        return dense != Entity::none && entities_[dense].generation == entity.generation ? dense
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
