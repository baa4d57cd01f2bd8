// The latest value, from one thread to another: one writes, one reads, neither ever waits. What is written
// between two looks of the reader is lost but for the last; for what must not be lost see spsc_ring.hpp.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace bolt {

// Three slots: the writer's, the reader's, and one in the middle that both swap theirs with. The swap is the
// only thing shared: its release publishes what was written to the slot, its acquire also gives a slot back
// only after the other side is done with it.
template <class T>
class TripleBuffer {
  public:
    explicit TripleBuffer(const T& initial = T{}) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}
    TripleBuffer(const TripleBuffer&) = delete;
    TripleBuffer& operator=(const TripleBuffer&) = delete;

    // The writer's side. The slot holds an older value until it is filled; nothing is seen before publish().
    T& slot() { return slots_[writers_].value; }
    void publish() { writers_ = middle_.exchange(writers_ | unseen, std::memory_order_acq_rel) & index; }
    void write(const T& value) {
        slot() = value;
        publish();
    }

    // The reader's side. True if there is something newer than what latest() gave until now.
    bool update() {
        if ((middle_.load(std::memory_order_relaxed) & unseen) == 0) return false;
        readers_ = middle_.exchange(readers_, std::memory_order_acq_rel) & index;
        return true;
    }
    const T& latest() const { return slots_[readers_].value; }

  private:
    static constexpr std::uint8_t index = 3, unseen = 4;
    static constexpr std::size_t line = 64;  // bytes: what two cores must not share if neither is to wait
    struct alignas(line) Slot {
        T value;
    };
    static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

    std::array<Slot, 3> slots_;
    alignas(line) std::atomic<std::uint8_t> middle_{1};
    alignas(line) std::uint8_t writers_ = 0;
    alignas(line) std::uint8_t readers_ = 2;
};

}  // namespace bolt
