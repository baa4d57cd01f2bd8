// Entities, their allocation, and Pool: the components of one type.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace bolt::ecs {

// Identifies something that has components: a slot index and the slot's generation. A stale entity never
// refers to the next occupant of its slot.
struct Entity {
    static constexpr std::uint32_t no_index = ~std::uint32_t{0};

    std::uint32_t index = no_index;
    std::uint32_t generation = 0;

    friend bool operator==(Entity, Entity) = default;
};

// Allocates and frees entities. A slot whose generations are exhausted is retired, so that no entity is ever
// reused.
class Entities {
  public:
    Entity create() {
        ++alive_;
        if (!free_.empty()) {
            const std::uint32_t index = free_.back();
            free_.pop_back();
            return {index, slots_[index] = slots_[index] + 1};  // odd: alive
        }
        slots_.push_back(1);
        return {static_cast<std::uint32_t>(slots_.size() - 1), 1};
    }

    // Returns false if the entity was not alive.
    bool destroy(Entity entity) {
        if (!alive(entity)) return false;
        --alive_;
        if (++slots_[entity.index] != last_generation) free_.push_back(entity.index);
        return true;
    }

    [[nodiscard]] bool alive(Entity entity) const {
        return entity.index < slots_.size() && slots_[entity.index] == entity.generation &&
               entity.generation % 2 == 1;
    }

    [[nodiscard]] std::size_t size() const { return alive_; }

    void clear() {
        free_.clear();
        for (std::uint32_t i = static_cast<std::uint32_t>(slots_.size()); i-- > 0;) {
            slots_[i] += slots_[i] % 2;
            if (slots_[i] != last_generation) free_.push_back(i);
        }
        alive_ = 0;
    }

  private:
    static constexpr std::uint32_t last_generation = ~std::uint32_t{1};  // the last even one

    std::vector<std::uint32_t> slots_;  // generations; odd while alive
    std::vector<std::uint32_t> free_;   // indices of slots
    std::size_t alive_ = 0;
};

// The components of one type: a sparse set (Briggs and Torczon 1993). Components are stored contiguously; a
// paged sparse array maps an entity's slot to its dense index. Insert, erase and find take constant time;
// iteration walks an array. Erasing moves the last component into the gap: the order is not kept, and
// pointers to components are valid only until the next insert or erase.
template <class Component>
class Pool {
  public:
    // Adds a component to an entity that does not have one of this type.
    template <class... Arguments>
    Component& insert(Entity entity, Arguments&&... arguments) {
        assert(!contains(entity));
        components_.push_back(Component{std::forward<Arguments>(arguments)...});
        entities_.push_back(entity);
        slot(entity.index) = static_cast<std::uint32_t>(entities_.size() - 1);
        return components_.back();
    }

    // Returns false if the entity has no component of this type.
    bool erase(Entity entity) {
        const std::uint32_t dense = dense_index(entity);
        if (dense == Entity::no_index) return false;
        if (dense + 1 != entities_.size()) {
            components_[dense] = std::move(components_.back());
            entities_[dense] = entities_.back();
            slot(entities_[dense].index) = dense;
        }
        components_.pop_back();
        entities_.pop_back();
        slot(entity.index) = Entity::no_index;
        return true;
    }

    [[nodiscard]] bool contains(Entity entity) const { return dense_index(entity) != Entity::no_index; }

    // Returns null if the entity has no component of this type.
    [[nodiscard]] Component* find(Entity entity) {
        const std::uint32_t dense = dense_index(entity);
        return dense == Entity::no_index ? nullptr : &components_[dense];
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
        if (page >= pages_.size() || !pages_[page]) return Entity::no_index;
        const std::uint32_t dense = (*pages_[page])[entity.index % page_size];
        return dense != Entity::no_index && entities_[dense].generation == entity.generation
                   ? dense
                   : Entity::no_index;
    }

    std::uint32_t& slot(std::uint32_t index) {
        const std::size_t page = index / page_size;
        if (page >= pages_.size()) pages_.resize(page + 1);
        if (!pages_[page]) {
            pages_[page] = std::make_unique<Page>();
            pages_[page]->fill(Entity::no_index);
        }
        return (*pages_[page])[index % page_size];
    }

    std::vector<std::unique_ptr<Page>> pages_;
    std::vector<Entity> entities_;
    std::vector<Component> components_;
};

}  // namespace bolt::ecs
