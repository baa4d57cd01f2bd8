// Values from one thread to another, every one and in order: one writes, one reads, neither ever waits. The
// room is made once; a writer that finds none left is told so and keeps its value.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace bolt {

// Both counts run on and are never reduced: their difference is what waits, also when they overflow.
template <class T>
class SpscRing {
  public:
    // Room for at least this many: the next power of two.
    explicit SpscRing(std::size_t room) : slots_(std::bit_ceil(room)) {}
    SpscRing(const SpscRing&) = delete;
    SpscRing& operator=(const SpscRing&) = delete;

    [[nodiscard]] std::size_t room() const { return slots_.size(); }

    // The writer's side. False: it is full, and nothing was taken.
    [[nodiscard]] bool push(const T& value) {
        const std::size_t at = pushed_.load(std::memory_order_relaxed);
        if (at - seen_popped_ == slots_.size()) {
            seen_popped_ = popped_.load(std::memory_order_acquire);
            if (at - seen_popped_ == slots_.size()) return false;
        }
        slots_[at & (slots_.size() - 1)] = value;
        pushed_.store(at + 1, std::memory_order_release);
        return true;
    }

    // The reader's side. False: nothing waits.
    [[nodiscard]] bool pop(T& value) {
        const std::size_t at = popped_.load(std::memory_order_relaxed);
        if (at == seen_pushed_) {
            seen_pushed_ = pushed_.load(std::memory_order_acquire);
            if (at == seen_pushed_) return false;
        }
        value = std::move(slots_[at & (slots_.size() - 1)]);
        popped_.store(at + 1, std::memory_order_release);
        return true;
    }

    // What waits, as either side may ask: the other may change it meanwhile, to its own side only.
    [[nodiscard]] std::size_t waiting() const {
        const std::size_t popped = popped_.load(std::memory_order_acquire);
        return pushed_.load(std::memory_order_acquire) - popped;
    }

  private:
    static constexpr std::size_t line = 64;  // bytes, see triple_buffer.hpp
    std::vector<T> slots_;
    alignas(line) std::atomic<std::size_t> pushed_{0};
    std::size_t seen_popped_ = 0;  // the writer's: it asks for the other count only when that might help
    alignas(line) std::atomic<std::size_t> popped_{0};
    std::size_t seen_pushed_ = 0;  // the reader's
};

}  // namespace bolt
