// An entity identifies something that has components: a slot index and the slot's generation. A stale entity
// never refers to the next occupant of its slot.
#pragma once

#include <cstdint>
#include <vector>

namespace bolt::ecs {

struct Entity {
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::uint32_t index = none;
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

    std::vector<std::uint32_t> slots_;  // generation; odd while alive
    std::vector<std::uint32_t> free_;
    std::size_t alive_ = 0;
};

}  // namespace bolt::ecs
