// The servo thread: a loop that runs a tick at a fixed rate with real-time privileges, its timing statistics,
// and the assessment of a host from them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::servo {

// A histogram of durations from nanoseconds to minutes, of fixed size, with log-linear bins as in
// HdrHistogram: 1 ns below 32 ns, then 16 bins per octave, so the relative resolution is 1/16.
struct Histogram {
    static constexpr int sub_bin_bits = 4;  // bits of a value below its leading bit that select the bin
    static constexpr std::uint64_t max_duration =
        (1ULL << 40) - 1;  // ns, 18 minutes; longer durations count as this
    static constexpr std::size_t bins = (40 - sub_bin_bits + 1) << sub_bin_bits;

    std::array<std::uint64_t, bins> counts{};
    std::uint64_t count = 0;
    std::uint64_t min = max_duration, max = 0;  // ns, exact
    double sum = 0.0;                           // ns
};

constexpr std::size_t bin_of(std::uint64_t ns) {
    const int octave = std::max(0, static_cast<int>(std::bit_width(ns)) - 1 - Histogram::sub_bin_bits);
    return (static_cast<std::size_t>(octave) << Histogram::sub_bin_bits) +
           static_cast<std::size_t>(ns >> octave);
}

// The first value, ns, of the next bin.
constexpr std::uint64_t end_of(std::size_t bin) {
    constexpr std::size_t linear = 2U << Histogram::sub_bin_bits;
    if (bin < linear) return bin + 1;
    const std::size_t octave = (bin >> Histogram::sub_bin_bits) - 1;
    return (static_cast<std::uint64_t>(bin - (octave << Histogram::sub_bin_bits)) + 1) << octave;
}

// Negative durations, from a clock that went backwards, count as 0.
inline void add(Histogram& h, std::int64_t ns) {
    const std::uint64_t value =
        std::min(static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0)), h.max_duration);
    ++h.counts[bin_of(value)];
    ++h.count;
    h.min = std::min(h.min, value);
    h.max = std::max(h.max, value);
    h.sum += static_cast<double>(value);
}

inline void add(Histogram& h, const Histogram& other) {
    for (std::size_t i = 0; i < h.bins; ++i) h.counts[i] += other.counts[i];
    h.count += other.count;
    h.min = std::min(h.min, other.min);
    h.max = std::max(h.max, other.max);
    h.sum += other.sum;
}

// The duration, s, that a share (0 … 1) of all values does not exceed. Overestimates by at most 1/16, never
// underestimates. 0 if the histogram is empty.
inline double quantile(const Histogram& h, double share) {
    if (h.count == 0) return 0.0;
    const double rank = std::clamp(share, 0.0, 1.0) * static_cast<double>(h.count);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < h.bins; ++i) {
        below += h.counts[i];
        if (below > 0 && static_cast<double>(below) >= rank)
            return 1e-9 * static_cast<double>(std::min(end_of(i) - 1, h.max));
    }
    return 1e-9 * static_cast<double>(h.max);
}

// s; 0 if the histogram is empty.
inline double mean(const Histogram& h) {
    return h.count == 0 ? 0.0 : 1e-9 * h.sum / static_cast<double>(h.count);
}

// The share (0 … 1) of the values above `seconds`. Values in the bin of `seconds` count as above it.
inline double share_above(const Histogram& h, double seconds) {
    if (h.count == 0) return 0.0;
    const double ns = std::clamp(seconds * 1e9, 0.0, static_cast<double>(h.max_duration));
    std::uint64_t above = 0;
    for (std::size_t i = bin_of(static_cast<std::uint64_t>(ns)); i < h.bins; ++i) above += h.counts[i];
    return static_cast<double>(above) / static_cast<double>(h.count);
}

// Timing statistics of a servo loop.
struct Timing {
    Histogram wake_up;  // from the deadline until the loop runs
    Histogram compute;  // duration of the tick
    Histogram period;   // from one wake-up to the next
    std::uint64_t ticks = 0;
    std::uint64_t missed = 0;  // deadlines that were skipped because the loop did not run in time
};

// The real-time privileges that the operating system granted to the thread.
struct ThreadPrivileges {
    int priority = 0;            // of SCHED_FIFO; 0: ordinary scheduling
    bool memory_locked = false;  // no page of this process can be swapped out
    bool flushes_denormals = false;
    std::vector<std::string> refused;  // one message per refused privilege, with the reason and the remedy
};

// Limits above which a hand may feel the loop's jitter or a device's own watchdog may trip. wake_up and
// compute are shares of the period.
struct HostRequirements {
    double wake_up = 0.25;  // at the 99.9th percentile
    double compute =
        0.5;  // at the 99.9th percentile; the rest of the period is for the transfer to the device
    double missed = 1e-3;        // share of all deadlines
    double stall = 0.02;         // s without a tick; the output stage must have reached zero by then
    std::uint64_t ticks = 1000;  // fewest ticks that give a 99.9th percentile
};

struct HostAssessment {
    bool adequate = false;
    std::vector<std::string> reasons;  // one text a limit, with the measured value; violated limits first
    std::size_t violations = 0;        // number of violated limits
};

// `rate` (1/s) may differ from the rate at which the timing was measured. A wake-up that came more than
// 1 / rate after its deadline counts as missed.
HostAssessment assess_host(const Timing& timing, double rate, const HostRequirements& requirements = {});

// A table: one row per histogram (median, p99, p99.9 and greatest, µs), then ticks and missed deadlines.
std::string describe(const Timing& timing);

struct Deadline {
    std::uint64_t number = 0;  // counts all deadlines, missed ones too
    std::uint64_t missed = 0;  // deadlines without a tick since the last tick
};

// Calls a tick at a fixed period, on any clock. Deadlines are whole periods after the start and never shift.
// A missed deadline is skipped, because two ticks in quick succession would be felt as a jerk. `clock` has
// now() and sleep_until(deadline), in ns of a monotonic clock. `tick` takes a Deadline and returns false to
// end the loop. `publish` gets the timing after every tick. The loop sleeps before every tick, even if the
// deadline is near: if a real-time thread never sleeps, the kernel suspends it for 50 ms of each second
// (sched_rt_runtime_us).
template <class Clock, class Tick, class Publish>
void run_loop(Clock& clock, std::int64_t period, Timing& timing, Tick&& tick, Publish&& publish) {
    const std::int64_t start = clock.now();
    std::int64_t woken_before = start;
    std::uint64_t number = 0;  // of the last deadline with a tick
    for (bool running = true; running;) {
        const std::int64_t now = clock.now();
        const auto next = std::max(static_cast<std::uint64_t>((now - start) / period), number) + 1;
        const Deadline deadline{next, next - number - 1};
        const std::int64_t due = start + static_cast<std::int64_t>(next) * period;
        clock.sleep_until(due);
        const std::int64_t woken = clock.now();
        running = tick(deadline);
        const std::int64_t done = clock.now();
        add(timing.wake_up, woken - due);
        add(timing.compute, done - woken);
        if (timing.ticks > 0) add(timing.period, woken - woken_before);
        ++timing.ticks;
        timing.missed += deadline.missed;
        number = next;
        woken_before = woken;
        publish(timing);
    }
}

struct ThreadOptions {
    double rate = 1000.0;               // 1/s
    int priority = 80;                  // of SCHED_FIFO, 1 … 99; 0: none is requested
    bool lock_memory = true;            // locks the memory of the whole process until the thread stops
    std::size_t stack = 256 * 1024;     // bytes that are paged in before the first tick
    std::uint64_t publish_every = 100;  // ticks between two updates of timing()
};

// A thread that runs a tick at a fixed rate with the real-time privileges that the operating system grants.
// The thread reports its privileges, so that a caller notices a host that cannot keep time.
class ServoThread {
  public:
    // Runs on the servo thread with denormals flushed. Must neither throw nor wait. Returns false to end the
    // thread.
    using Tick = std::function<bool(const Deadline&)>;

    // Returns once the thread has requested its privileges and is about to wait for its first deadline. Fails
    // for a rate outside 1 … 20000 1/s, a priority outside 0 … 99, or if no thread can be created. Missing
    // privileges are no failure; see privileges().
    static Result<ServoThread> start(const ThreadOptions& options, Tick tick);

    ServoThread(ServoThread&&) noexcept;
    ServoThread& operator=(ServoThread&&) noexcept;
    ~ServoThread();  // stops

    [[nodiscard]] const ThreadPrivileges& privileges() const;
    [[nodiscard]] bool running() const;

    // The timing at the last update; complete after stop(). For one caller at a time.
    const Timing& timing();

    // Waits for the current tick to end. The timing remains available.
    void stop();

  private:
    struct Shared;
    explicit ServoThread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::servo
