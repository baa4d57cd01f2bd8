#include "haptics/servo/servo_thread.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <future>
#include <system_error>
#include <thread>

#include "engine/base/lock_free.hpp"
#include "haptics/servo/denormals.hpp"

namespace bolt::servo {

namespace {

std::string row(const char* name, const Histogram& h) {
    return fmt::format("  {:<9}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}\n", name, 1e6 * quantile(h, 0.5),
                       1e6 * quantile(h, 0.99), 1e6 * quantile(h, 0.999), 1e-3 * static_cast<double>(h.max));
}

}  // namespace

HostAssessment assess_host(const Timing& timing, double rate, const HostRequirements& limits) {
    HostAssessment assessment;
    if (timing.ticks < limits.ticks || timing.wake_up.count == 0) {
        assessment.reasons.push_back(
            fmt::format("only {} ticks were timed; expected at least {}", timing.ticks, limits.ticks));
        assessment.violations = 1;
        return assessment;
    }
    const double period = 1.0 / rate;
    std::vector<std::string> within_limits;
    const auto check = [&](bool good, std::string reason) {
        (good ? within_limits : assessment.reasons).push_back(std::move(reason));
    };
    const double wake_up = quantile(timing.wake_up, 0.999), compute = quantile(timing.compute, 0.999);
    check(wake_up <= limits.wake_up * period,
          fmt::format(
              "99.9 % of the ticks began within {:.0f} µs of their deadline; expected at most {:.0f} µs",
              1e6 * wake_up, 1e6 * limits.wake_up * period));
    check(compute <= limits.compute * period,
          fmt::format("99.9 % of the ticks took up to {:.0f} µs; expected at most {:.0f} µs", 1e6 * compute,
                      1e6 * limits.compute * period));
    // Missed at the measured rate, or woken later than a whole period of the requested rate.
    const double deadlines = static_cast<double>(timing.ticks + timing.missed);
    const double missed =
        std::max(static_cast<double>(timing.missed) / deadlines, share_above(timing.wake_up, period));
    check(missed <= limits.missed,
          fmt::format("{:.2f} % of the deadlines were missed; expected at most {:.2f} %", 100.0 * missed,
                      100.0 * limits.missed));
    const double stall = 1e-9 * static_cast<double>(timing.period.max);
    check(stall <= limits.stall,
          fmt::format("the longest time without a tick was {:.1f} ms; expected at most {:.0f} ms",
                      1e3 * stall, 1e3 * limits.stall));
    assessment.adequate = assessment.reasons.empty();
    assessment.violations = assessment.reasons.size();
    assessment.reasons.insert(assessment.reasons.end(), within_limits.begin(), within_limits.end());
    return assessment;
}

std::string describe(const Timing& timing) {
    return fmt::format("  {:<9}{:>10}{:>10}{:>10}{:>10}\n", "µs", "median", "p99", "p99.9", "greatest") +
           row("wake-up", timing.wake_up) + row("compute", timing.compute) + row("period", timing.period) +
           fmt::format("  {} ticks, {} deadlines missed\n", timing.ticks, timing.missed);
}

namespace {

constexpr std::int64_t second = 1'000'000'000;

struct MonotonicClock {
    static std::int64_t now() {
        timespec t{};
        clock_gettime(CLOCK_MONOTONIC, &t);
        return t.tv_sec * second + t.tv_nsec;
    }
    static void sleep_until(std::int64_t deadline) {
        const timespec t{deadline / second, deadline % second};
        // A signal ends the sleep early; the deadline is absolute, so the call can be repeated.
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
        }
    }
};

bool may_lock_without_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {};
    if (syscall(SYS_capget, &header, data) != 0) return false;
    return (data[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

// MCL_FUTURE is used only without a limit of locked memory: with a limit, later allocations would fail.
void lock_memory(ThreadPrivileges& privileges) {
    const bool unlimited = may_lock_without_limit();
    if (unlimited && mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
        privileges.memory_locked = true;
        return;
    }
    const std::string why = unlimited ? std::strerror(errno) : "the limit of locked memory is finite";
    privileges.refused.push_back(fmt::format(
        "memory is not locked ({}), so a swapped page can delay a tick by milliseconds; expected \"memlock "
        "unlimited\" for this user in /etc/security/limits.d",
        why));
}

void request_priority(int priority, ThreadPrivileges& privileges) {
    sched_param parameter{};
    parameter.sched_priority = priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
    if (error == 0) {
        privileges.priority = priority;
        return;
    }
    privileges.refused.push_back(
        fmt::format("no real-time priority ({}), so other programs can delay a tick; expected \"rtprio {}\" "
                    "for this user in /etc/security/limits.d",
                    std::strerror(error), priority));
    // By default Linux delays the wake-up of ordinary threads by up to 50 µs to save power; request 1 ns.
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

// Writes to the stack pages that the tick will use, so that no page fault delays a tick.
[[gnu::noinline]] void prefault_stack(std::size_t bytes) {
    constexpr std::size_t page = 4096;
    volatile unsigned char here[page];
    for (std::size_t i = 0; i < page; i += 64) here[i] = 1;
    if (bytes > page) prefault_stack(bytes - page);
    here[0] = here[page - 1];  // a use after the call prevents a tail call, which would reuse one page
}

}  // namespace

struct ServoThread::Shared {
    ThreadOptions options;
    Tick tick;
    std::atomic<bool> stop{false}, running{true};
    ThreadPrivileges privileges;
    Timing timing;  // written by the servo thread only
    TripleBuffer<Timing> published;
    std::promise<void> ready;
    std::thread thread;

    void run() {
        if (options.priority > 0) request_priority(options.priority, privileges);
        prefault_stack(options.stack);
        privileges.flushes_denormals = FlushDenormals::supported();
        ready.set_value();
        {
            const FlushDenormals flush;
            MonotonicClock clock;
            run_loop(
                clock, std::llround(1e9 / options.rate), timing,
                [this](const Deadline& deadline) {
                    return !stop.load(std::memory_order_relaxed) && tick(deadline);
                },
                [this](const Timing& now) {
                    if (now.ticks % options.publish_every == 0) published.write(now);
                });
        }
        published.write(timing);
        running.store(false, std::memory_order_release);
    }
};

ServoThread::ServoThread(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
ServoThread::ServoThread(ServoThread&&) noexcept = default;
ServoThread& ServoThread::operator=(ServoThread&& other) noexcept {
    stop();
    shared_ = std::move(other.shared_);
    return *this;
}
ServoThread::~ServoThread() { stop(); }

Result<ServoThread> ServoThread::start(const ThreadOptions& options, Tick tick) {
    if (!(options.rate >= 1.0 && options.rate <= 20'000.0))
        return fail(ErrorCode::usage, fmt::format("servo: the rate is {} per second", options.rate),
                    "1 to 20000");
    if (options.priority < 0 || options.priority > 99)
        return fail(ErrorCode::usage, fmt::format("servo: the real-time priority is {}", options.priority),
                    "0 to 99");
    auto shared = std::make_unique<Shared>();
    shared->options = options;
    shared->options.publish_every = std::max<std::uint64_t>(1, options.publish_every);
    shared->tick = std::move(tick);
    if (options.lock_memory) lock_memory(shared->privileges);
    std::future<void> ready = shared->ready.get_future();
    try {
        shared->thread = std::thread([s = shared.get()] { s->run(); });
    } catch (const std::system_error& error) {
        if (shared->privileges.memory_locked) munlockall();
        return fail(ErrorCode::failed, fmt::format("servo: the thread cannot be created: {}", error.what()),
                    "a system that permits another thread");
    }
    ready.wait();
    return ServoThread(std::move(shared));
}

const ThreadPrivileges& ServoThread::privileges() const { return shared_->privileges; }
bool ServoThread::running() const { return shared_->running.load(std::memory_order_acquire); }

const Timing& ServoThread::timing() {
    shared_->published.update();
    return shared_->published.latest();
}

void ServoThread::stop() {
    if (!shared_ || !shared_->thread.joinable()) return;
    shared_->stop.store(true, std::memory_order_relaxed);
    shared_->thread.join();
    if (shared_->privileges.memory_locked) munlockall();
}

}  // namespace bolt::servo
