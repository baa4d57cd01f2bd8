// Lock-free exchange between one writer thread and one reader thread: SpscRing delivers every value,
// TripleBuffer only the latest.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bolt {

// A ring buffer. Neither side blocks or allocates; a push into a full ring fails. Both counters grow without
// being reduced to slot indices: their difference is the number of stored values, also after an overflow.
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
        if (at - cached_popped_ == slots_.size()) {
            cached_popped_ = popped_.load(std::memory_order_acquire);
            if (at - cached_popped_ == slots_.size()) return false;
        }
        slots_[at & (slots_.size() - 1)] = value;
        pushed_.store(at + 1, std::memory_order_release);
        return true;
    }

    // Reader only. Returns false if the ring is empty.
    [[nodiscard]] bool pop(T& value) {
        const std::size_t at = popped_.load(std::memory_order_relaxed);
        if (at == cached_pushed_) {
            cached_pushed_ = pushed_.load(std::memory_order_acquire);
            if (at == cached_pushed_) return false;
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
    static constexpr std::size_t cache_line = 64;  // bytes; avoids false sharing between the two cores
    std::vector<T> slots_;
    alignas(cache_line) std::atomic<std::size_t> pushed_{0};
    std::size_t cached_popped_ = 0;  // the writer's copy, refreshed only when the ring seems full
    alignas(cache_line) std::atomic<std::size_t> popped_{0};
    std::size_t cached_pushed_ = 0;  // the reader's copy, refreshed only when the ring seems empty
};

// The latest value. Neither side ever blocks; values that the reader does not poll in time are overwritten.
// There are three slots: the writer's, the reader's, and one in the middle that each side exchanges with its
// own. Both sides share only the atomic index of the middle slot. The release of an exchange publishes the
// slot that this side gives away. Its acquire ensures that the other side has finished with the slot that
// this side receives.
template <class T>
class TripleBuffer {
  public:
    explicit TripleBuffer(const T& initial = T{}) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}
    TripleBuffer(const TripleBuffer&) = delete;
    TripleBuffer& operator=(const TripleBuffer&) = delete;

    // Writer only. slot() returns the slot to fill, which holds an older value. publish() gives the slot to
    // the reader.
    T& slot() { return slots_[writer_slot_].value; }
    void publish() {
        writer_slot_ = middle_.exchange(writer_slot_ | unseen_bit, std::memory_order_acq_rel) & index_mask;
    }
    void write(const T& value) {
        slot() = value;
        publish();
    }

    // Reader only. Returns true if latest() now gives a newer value.
    bool update() {
        if ((middle_.load(std::memory_order_relaxed) & unseen_bit) == 0) return false;
        reader_slot_ = middle_.exchange(reader_slot_, std::memory_order_acq_rel) & index_mask;
        return true;
    }
    const T& latest() const { return slots_[reader_slot_].value; }

  private:
    static constexpr std::uint8_t index_mask = 3, unseen_bit = 4;
    static constexpr std::size_t cache_line = 64;  // bytes; avoids false sharing
    struct alignas(cache_line) Slot {
        T value;
    };
    static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

    std::array<Slot, 3> slots_;
    alignas(cache_line) std::atomic<std::uint8_t> middle_{1};
    alignas(cache_line) std::uint8_t writer_slot_ = 0;
    alignas(cache_line) std::uint8_t reader_slot_ = 2;
};

}  // namespace bolt
