// A thread that runs a tick at a fixed rate, with whatever real-time means the operating system allows. It
// says what it got, so that nobody trains on a host that cannot keep time without knowing it.
#pragma once

#include <functional>
#include <memory>

#include "engine/base/result.hpp"
#include "haptics/servo/loop.hpp"
#include "haptics/servo/timing.hpp"

namespace bolt::servo {

struct ThreadOptions {
    double rate = 1000.0;            // 1/s
    int priority = 80;               // of SCHED_FIFO, 1 … 99; 0: it is not asked for
    bool lock_memory = true;         // the whole process, until the thread stops
    std::size_t stack = 256 * 1024;  // bytes that are touched before the first tick
    std::uint64_t tell_every = 100;  // ticks between two timings that timing() can see
};

class Thread {
  public:
    // Runs on the thread only, must neither throw nor wait; returns whether to go on. Denormals are flushed
    // in it.
    using Tick = std::function<bool(const Beat&)>;

    // Returns when the thread has asked for its means and is about to wait for its first deadline.
    static Result<Thread> start(const ThreadOptions& options, Tick tick);

    Thread(Thread&&) noexcept;
    Thread& operator=(Thread&&) noexcept;
    ~Thread();  // stops

    [[nodiscard]] const Granted& granted() const;
    [[nodiscard]] bool running() const;

    // As told last; complete after stop(). For one caller at a time.
    const Timing& timing();

    // After the tick that runs now. The timing stays.
    void stop();

  private:
    struct Shared;
    explicit Thread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::servo
