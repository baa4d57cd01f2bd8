// A thread that runs a tick at a fixed rate with the real-time privileges that the operating system grants.
// It reports them, so that a host that cannot keep time is not used unnoticed.
#pragma once

#include <functional>
#include <memory>

#include "engine/base/result.hpp"
#include "haptics/servo/loop.hpp"
#include "haptics/servo/timing.hpp"

namespace bolt::servo {

struct ThreadOptions {
    double rate = 1000.0;               // 1/s
    int priority = 80;                  // of SCHED_FIFO, 1 … 99; 0: none is requested
    bool lock_memory = true;            // locks the memory of the whole process until the thread stops
    std::size_t stack = 256 * 1024;     // bytes that are paged in before the first tick
    std::uint64_t publish_every = 100;  // ticks between two updates of timing()
};

class Thread {
  public:
    // Runs on the servo thread with denormals flushed. Must neither throw nor wait. Returns false to end the
    // thread.
    using Tick = std::function<bool(const Deadline&)>;

    // Returns once the thread has requested its privileges and is about to wait for its first deadline. Fails
    // for a rate outside 1 … 20000 1/s, a priority outside 0 … 99, or if no thread can be created. Missing
    // privileges are no failure; see privileges().
    static Result<Thread> start(const ThreadOptions& options, Tick tick);

    Thread(Thread&&) noexcept;
    Thread& operator=(Thread&&) noexcept;
    ~Thread();  // stops

    [[nodiscard]] const ThreadPrivileges& privileges() const;
    [[nodiscard]] bool running() const;

    // The timing at the last update; complete after stop(). For one caller at a time.
    const Timing& timing();

    // Waits for the current tick to end. The timing remains available.
    void stop();

  private:
    struct Shared;
    explicit Thread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::servo
