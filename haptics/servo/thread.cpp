#include "haptics/servo/thread.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <future>
#include <system_error>
#include <thread>

#include "engine/base/triple_buffer.hpp"
#include "haptics/servo/denormals.hpp"

namespace bolt::servo {

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
        // A signal wakes it early; the deadline is absolute, so sleeping again loses nothing.
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

// What is mapped later is locked only where that has no limit: with one, a later allocation would fail
// instead.
void lock_memory(Granted& granted) {
    const bool later = may_lock_without_limit();
    if (later && mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
        granted.memory_locked = true;
        return;
    }
    const std::string why = later ? std::strerror(errno) : "the limit of locked memory is finite";
    granted.refused.push_back(
        fmt::format("memory is not locked ({}): a page that was swapped out costs milliseconds; \"memlock "
                    "unlimited\" for this user in /etc/security/limits.d allows it",
                    why));
}

void ask_for_priority(int priority, Granted& granted) {
    sched_param wanted{};
    wanted.sched_priority = priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    if (error == 0) {
        granted.priority = priority;
        return;
    }
    granted.refused.push_back(fmt::format(
        "no real-time priority ({}): other programs may hold it up; \"rtprio {}\" for this user in "
        "/etc/security/limits.d allows it",
        std::strerror(error), priority));
    // Sleeps of ordinary threads end up to 50 µs late on purpose, to save power.
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

// The pages of the stack that the tick will use, so that none is missing when it does.
[[gnu::noinline]] void touch_stack(std::size_t bytes) {
    constexpr std::size_t page = 4096;
    volatile unsigned char here[page];
    for (std::size_t i = 0; i < page; i += 64) here[i] = 1;
    if (bytes > page) touch_stack(bytes - page);
    here[0] = here[page - 1];  // after the call, so that it is no tail call that reuses one page
}

}  // namespace

struct Thread::Shared {
    ThreadOptions options;
    Tick tick;
    std::atomic<bool> stop{false}, running{true};
    Granted granted;
    Timing timing;  // the thread's own
    TripleBuffer<Timing> told;
    std::promise<void> ready;
    std::thread thread;

    void run() {
        if (options.priority > 0) ask_for_priority(options.priority, granted);
        touch_stack(options.stack);
        granted.flushes_denormals = FlushDenormals::supported();
        ready.set_value();
        {
            const FlushDenormals flush;
            MonotonicClock clock;
            run_loop(
                clock, std::llround(1e9 / options.rate), timing,
                [this](const Beat& beat) { return !stop.load(std::memory_order_relaxed) && tick(beat); },
                [this](const Timing& now) {
                    if (now.ticks % options.tell_every == 0) told.write(now);
                });
        }
        told.write(timing);
        running.store(false, std::memory_order_release);
    }
};

Thread::Thread(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Thread::Thread(Thread&&) noexcept = default;
Thread& Thread::operator=(Thread&& other) noexcept {
    stop();
    shared_ = std::move(other.shared_);
    return *this;
}
Thread::~Thread() { stop(); }

Result<Thread> Thread::start(const ThreadOptions& options, Tick tick) {
    if (!(options.rate >= 1.0 && options.rate <= 20'000.0))
        return fail(ErrorCode::usage, fmt::format("a servo rate of {} per second", options.rate),
                    "1 to 20000");
    if (options.priority < 0 || options.priority > 99)
        return fail(ErrorCode::usage, fmt::format("a real-time priority of {}", options.priority), "0 to 99");
    auto shared = std::make_unique<Shared>();
    shared->options = options;
    shared->options.tell_every = std::max<std::uint64_t>(1, options.tell_every);
    shared->tick = std::move(tick);
    if (options.lock_memory) lock_memory(shared->granted);
    std::future<void> ready = shared->ready.get_future();
    try {
        shared->thread = std::thread([s = shared.get()] { s->run(); });
    } catch (const std::system_error& error) {
        if (shared->granted.memory_locked) munlockall();
        return fail(ErrorCode::failed, fmt::format("the servo thread does not start: {}", error.what()));
    }
    ready.wait();
    return Thread(std::move(shared));
}

const Granted& Thread::granted() const { return shared_->granted; }
bool Thread::running() const { return shared_->running.load(std::memory_order_acquire); }

const Timing& Thread::timing() {
    shared_->told.update();
    return shared_->told.latest();
}

void Thread::stop() {
    if (!shared_ || !shared_->thread.joinable()) return;
    shared_->stop.store(true, std::memory_order_relaxed);
    shared_->thread.join();
    if (shared_->granted.memory_locked) munlockall();
}

}  // namespace bolt::servo
