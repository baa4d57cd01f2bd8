// The latest value, from one writer thread to one reader thread; neither ever blocks. Values that the reader
// does not poll in time are overwritten; use spsc_ring.hpp for values that must not be lost.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace bolt {

// Three slots: the writer's, the reader's, and one in the middle that each side exchanges with its own. The
// exchange is the only shared operation. Its release publishes the written slot; its acquire ensures that the
// other side has finished with the slot that comes back.
template <class T>
class TripleBuffer {
  public:
    explicit TripleBuffer(const T& initial = T{}) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}
    TripleBuffer(const TripleBuffer&) = delete;
    TripleBuffer& operator=(const TripleBuffer&) = delete;

    // Writer only. The slot holds an older value until it is filled. The reader sees nothing before
    // publish().
    T& slot() { return slots_[writers_].value; }
    void publish() { writers_ = middle_.exchange(writers_ | unseen, std::memory_order_acq_rel) & index; }
    void write(const T& value) {
        slot() = value;
        publish();
    }

    // Reader only. Returns true if latest() now gives a newer value.
    bool update() {
        if ((middle_.load(std::memory_order_relaxed) & unseen) == 0) return false;
        readers_ = middle_.exchange(readers_, std::memory_order_acq_rel) & index;
        return true;
    }
    const T& latest() const { return slots_[readers_].value; }

  private:
    static constexpr std::uint8_t index = 3, unseen = 4;
    static constexpr std::size_t cache_line = 64;  // bytes; avoids false sharing between the two cores
    struct alignas(cache_line) Slot {
        T value;
    };
    static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

    std::array<Slot, 3> slots_;
    alignas(cache_line) std::atomic<std::uint8_t> middle_{1};
    alignas(cache_line) std::uint8_t writers_ = 0;
    alignas(cache_line) std::uint8_t readers_ = 2;
};

}  // namespace bolt
