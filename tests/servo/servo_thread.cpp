// The servo thread on the real clock. The tests check only counts, order and restored settings, which do not
// depend on the speed of the host; `boltwright doctor` checks the timing.
#include "haptics/servo/servo_thread.hpp"

#include <doctest/doctest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <limits>

#include "haptics/servo/denormals.hpp"
#include "tests/support/eventually.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

bool flushes_now() {
    volatile double small = std::numeric_limits<double>::min();
    small = small * 0.5;
    return small == 0.0;
}

}  // namespace

TEST_CASE("Denormals: flushed during the object's lifetime, restored afterwards, also nested") {
    REQUIRE_FALSE(flushes_now());
    {
        const FlushDenormals outer;
        CHECK(flushes_now() == FlushDenormals::supported());
        { const FlushDenormals inner; }
        CHECK(flushes_now() == FlushDenormals::supported());
    }
    CHECK_FALSE(flushes_now());
}

TEST_CASE("Servo thread: ticks in order until stopped, and its timing counts every tick") {
    std::atomic<std::uint64_t> ticks{0}, backwards{0};
    std::uint64_t last = 0;
    Result<ServoThread> thread = ServoThread::start({}, [&](const Deadline& beat) {
        if (beat.number != last + beat.missed + 1) ++backwards;
        last = beat.number;
        ++ticks;
        return true;
    });
    REQUIRE(thread.has_value());
    CHECK(test::eventually([&] { return ticks >= 300; }));
    CHECK(thread->running());
    CHECK(test::eventually([&] { return thread->timing().ticks >= 200; }));  // published while it runs
    thread->stop();
    CHECK_FALSE(thread->running());
    const Timing& timing = thread->timing();
    CHECK(timing.ticks == ticks + 1);  // the last wake-up found the request to stop and made no tick
    CHECK(timing.wake_up.count == timing.ticks);
    CHECK(timing.compute.count == timing.ticks);
    CHECK(timing.period.count == timing.ticks - 1);
    CHECK(backwards == 0);
    CHECK(last >= ticks);
    thread->stop();  // stopping twice is harmless
}

TEST_CASE("Servo thread: a tick that returns false ends it") {
    int ticks = 0;
    Result<ServoThread> thread = ServoThread::start({4000.0}, [&](const Deadline&) { return ++ticks < 10; });
    REQUIRE(thread.has_value());
    CHECK(test::eventually([&] { return !thread->running(); }));
    thread->stop();
    CHECK(ticks == 10);
    CHECK(thread->timing().ticks == 10);
}

TEST_CASE("Servo thread: the reported privileges are the kernel's, for this thread only") {
    std::atomic<int> policy{-1}, priority{-1};
    std::atomic<bool> flushes{false};
    Result<ServoThread> thread = ServoThread::start({}, [&](const Deadline&) {
        sched_param now{};
        int p = -1;
        pthread_getschedparam(pthread_self(), &p, &now);
        policy = p;
        priority = now.sched_priority;
        flushes = flushes_now();
        return false;
    });
    REQUIRE(thread.has_value());
    CHECK(test::eventually([&] { return !thread->running(); }));
    const ThreadPrivileges& granted = thread->privileges();
    CHECK((policy == SCHED_FIFO) == (granted.priority > 0));
    CHECK(priority == granted.priority);
    CHECK(flushes == granted.flushes_denormals);
    CHECK(granted.refused.size() == (granted.priority > 0 ? 0U : 1U) + (granted.memory_locked ? 0U : 1U));
    CHECK_FALSE(flushes_now());
    sched_param now{};
    int here = -1;
    pthread_getschedparam(pthread_self(), &here, &now);
    CHECK(here == SCHED_OTHER);
}

TEST_CASE("Servo thread: without requests nothing is refused") {
    ThreadOptions options;
    options.priority = 0;
    options.lock_memory = false;
    Result<ServoThread> thread = ServoThread::start(options, [](const Deadline&) { return false; });
    REQUIRE(thread.has_value());
    CHECK(thread->privileges().refused.empty());
    CHECK(thread->privileges().priority == 0);
    CHECK_FALSE(thread->privileges().memory_locked);
}

TEST_CASE("Servo thread: invalid rates and priorities are errors; a moved thread is stopped once") {
    const auto no = [](const Deadline&) { return false; };
    CHECK_FALSE(ServoThread::start({0.0}, no).has_value());
    CHECK_FALSE(ServoThread::start({std::numeric_limits<double>::quiet_NaN()}, no).has_value());
    CHECK_FALSE(ServoThread::start({1e6}, no).has_value());
    ThreadOptions options;
    options.priority = 100;
    CHECK_FALSE(ServoThread::start(options, no).has_value());

    std::atomic<int> a{0}, b{0};
    Result<ServoThread> first = ServoThread::start({}, [&](const Deadline&) { return ++a > 0; });
    Result<ServoThread> second = ServoThread::start({}, [&](const Deadline&) { return ++b > 0; });
    REQUIRE(first.has_value());
    REQUIRE(second.has_value());
    CHECK(test::eventually([&] { return a > 5 && b > 5; }));
    *first = std::move(*second);  // stops the first
    const int stood = a;
    const int then = b;
    CHECK(test::eventually([&] { return b > then + 5; }));
    CHECK(a == stood);
}
