// A ring buffer from one writer thread to one reader thread that loses nothing. Neither side blocks or
// allocates; a push into a full ring fails and leaves the value with the writer.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace bolt {

// Both counters grow without being reduced: their difference is the number of stored values, also after an
// overflow.
template <class T>
class SpscRing {
  public:
    // `capacity` is rounded up to a power of two.
    explicit SpscRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)) {}
    SpscRing(const SpscRing&) = delete;
    SpscRing& operator=(const SpscRing&) = delete;

    [[nodiscard]] std::size_t capacity() const { return slots_.size(); }

    // Writer only. Returns false if the ring is full; the value is then not stored.
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

    // Reader only. Returns false if the ring is empty.
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

    // The number of stored values. Either side may call it; the other side may change the number meanwhile.
    [[nodiscard]] std::size_t size() const {
        const std::size_t popped = popped_.load(std::memory_order_acquire);
        return pushed_.load(std::memory_order_acquire) - popped;
    }

  private:
    static constexpr std::size_t cache_line = 64;  // bytes, see triple_buffer.hpp
    std::vector<T> slots_;
    alignas(cache_line) std::atomic<std::size_t> pushed_{0};
    std::size_t seen_popped_ = 0;  // the writer's copy, refreshed only when the ring seems full
    alignas(cache_line) std::atomic<std::size_t> popped_{0};
    std::size_t seen_pushed_ = 0;  // the reader's copy, refreshed only when the ring seems empty
};

}  // namespace bolt
