#include "engine/platform/pace.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace bolt::platform;

namespace {

double seconds(Clock::time_point t) { return std::chrono::duration<double>(t.time_since_epoch()).count(); }
Clock::time_point at(double s) {
    return Clock::time_point(std::chrono::round<Clock::duration>(std::chrono::duration<double>(s)));
}

}  // namespace

TEST_CASE("Pace: deadlines are whole periods after the start, without drift in an hour") {
    Pace pace{at(100.0), 1.0 / 59.94, 0};
    Clock::time_point now = pace.start;
    constexpr int beats = 215784;  // in one hour
    for (int i = 1; i <= beats; ++i) {
        const FrameDeadline due = next_deadline(pace, now);
        REQUIRE(due.missed == 0);
        now = due.time;                                         // wakes up exactly at the deadline
        if (i % 3 == 0) now += std::chrono::microseconds(900);  // or slightly late
    }
    CHECK(std::abs(seconds(now) - 100.0 - beats / 59.94) < 0.0011);
    CHECK(pace.index == beats);
}

TEST_CASE("Pace: a long frame skips deadlines, and the next one is on the grid again") {
    Pace pace{at(10.0), 0.010, 0};
    CHECK(seconds(next_deadline(pace, at(10.001)).time) == doctest::Approx(10.010));
    CHECK(seconds(next_deadline(pace, at(10.012)).time) == doctest::Approx(10.020));
    const FrameDeadline late =
        next_deadline(pace, at(10.047));  // the deadlines at 10.030 and 10.040 have passed
    CHECK(seconds(late.time) == doctest::Approx(10.050));
    CHECK(late.missed == 2);
    CHECK(next_deadline(pace, at(10.0501)).missed == 0);
    const FrameDeadline day_later = next_deadline(pace, at(86410.0005));
    CHECK(seconds(day_later.time) == doctest::Approx(86410.010).epsilon(1e-12));
    CHECK(pace.index == 8640001);
}

TEST_CASE("Pace: a deadline is never in the past, at any time and for any period") {
    for (const double period : {1.0 / 24.0, 1.0 / 60.0, 1.0 / 144.0, 1.0 / 999.0})
        for (int i = 0; i < 2000; ++i) {
            const double offset = 0.001 * i * std::sqrt(2.0) * i;
            Pace pace{at(5.0), period, 0};
            const Clock::time_point now = at(5.0 + offset);
            const FrameDeadline due = next_deadline(pace, now);
            REQUIRE(due.time >= now);
            REQUIRE(seconds(due.time) - seconds(now) <= period + 1e-6);
        }
}

TEST_CASE("Pace: the period follows the display rate, with a default for implausible rates") {
    CHECK(period_of(144.0) == doctest::Approx(1.0 / 144.0));
    for (const double nonsense : {0.0, -1.0, 5.0, 1e9, std::nan("")})
        CHECK(period_of(nonsense) == 1.0 / 60.0);
}

TEST_CASE("Pace: waiting never ends before the deadline") {
    Pace pace{Clock::now(), 0.002, 0};
    for (int i = 0; i < 20; ++i) {
        (void)wait_for_deadline(pace);
        CHECK(Clock::now() >= pace.start + std::chrono::milliseconds(2) * static_cast<int>(pace.index));
    }
}
