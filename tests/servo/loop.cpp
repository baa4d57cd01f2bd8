// The servo loop on a virtual clock with controlled delays, and the assessment of hosts.
#include "haptics/servo/servo_thread.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

using namespace bolt;
using namespace bolt::servo;

namespace {

constexpr std::int64_t us = 1000, ms = 1000 * us;

struct VirtualClock {
    std::int64_t time = 77 * ms;
    std::int64_t late = 20 * us;  // delay of every wake-up, ns
    int sleeps = 0;
    [[nodiscard]] std::int64_t now() const { return time; }
    void sleep_until(std::int64_t deadline) {
        REQUIRE(deadline > time);  // a past deadline would cause a burst of ticks
        ++sleeps;
        time = deadline + late;
    }
};

struct Run {
    Timing timing;
    std::vector<Deadline> beats;
    std::vector<std::int64_t> started;
    VirtualClock clock;
};

// `work(i)`: duration of tick i, ns.
Run run(int ticks, std::int64_t period, const std::function<std::int64_t(int)>& work) {
    Run r;
    int i = 0;
    run_loop(
        r.clock, period, r.timing,
        [&](const Deadline& beat) {
            r.beats.push_back(beat);
            r.started.push_back(r.clock.time);
            r.clock.time += work(i);
            return ++i < ticks;
        },
        [](const Timing&) {});
    return r;
}

Timing timed(std::int64_t wake_up, std::int64_t compute, int ticks, std::int64_t period = ms) {
    Timing t;
    for (int i = 0; i < ticks; ++i) {
        add(t.wake_up, wake_up);
        add(t.compute, compute);
        add(t.period, period);
    }
    t.ticks = static_cast<std::uint64_t>(ticks);
    return t;
}

bool has_reason(const HostAssessment& assessment, const std::string& text) {
    for (const std::string& reason : assessment.reasons)
        if (reason.find(text) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("Loop: in time, every deadline has its tick and deadlines do not shift") {
    const Run r = run(1000, ms, [](int) { return 300 * us; });
    REQUIRE(r.beats.size() == 1000);
    for (std::size_t i = 0; i < r.beats.size(); ++i) {
        REQUIRE(r.beats[i].number == i + 1);
        REQUIRE(r.beats[i].missed == 0);
        REQUIRE(r.started[i] == 77 * ms + static_cast<std::int64_t>(i + 1) * ms + 20 * us);
    }
    CHECK(r.timing.ticks == 1000);
    CHECK(r.timing.missed == 0);
    CHECK(r.timing.wake_up.count == 1000);
    CHECK(r.timing.wake_up.max == 20 * us);
    CHECK(r.timing.compute.min == 300 * us);
    CHECK(r.timing.period.count == 999);  // the first tick has no period
    CHECK(r.timing.period.min == ms);
    CHECK(r.timing.period.max == ms);
}

TEST_CASE("Loop: an overrun skips and counts deadlines, and never makes two ticks in quick succession") {
    const Run r = run(100, ms, [](int i) { return i == 10 ? 3500 * us : i == 50 ? 999 * us : 100 * us; });
    CHECK(r.clock.sleeps == 100);
    CHECK(r.beats[10].number == 11);
    CHECK(r.beats[11].number == 15);  // 11.02 + 3.5 ms: the next deadline is the 15th
    CHECK(r.beats[11].missed == 3);
    CHECK(r.beats[12].missed == 0);
    CHECK(r.beats[51].missed == 1);  // 20 µs late and 999 µs of work exceed the period
    CHECK(r.timing.missed == 4);
    CHECK(r.timing.ticks == 100);
    CHECK(r.beats.back().number == 104);
    for (std::size_t i = 1; i < r.started.size(); ++i) {
        REQUIRE(r.started[i] - r.started[i - 1] >= ms);
        REQUIRE((r.started[i] - 77 * ms - 20 * us) % ms == 0);
    }
    CHECK(r.timing.period.max == 4 * ms);
}

TEST_CASE("Loop: with ticks longer than the period it still sleeps before each tick") {
    const Run r = run(200, 250 * us, [](int) { return 300 * us; });
    CHECK(r.clock.sleeps == 200);
    CHECK(r.timing.missed == 199);
    CHECK(r.beats.back().number == 399);
}

TEST_CASE("Host assessment: each violated limit is named") {
    const HostAssessment good = assess_host(timed(40 * us, 100 * us, 5000), 1000.0);
    CHECK(good.adequate);
    CHECK(good.reasons.size() == 4);  // including the limits that are met

    const HostAssessment few = assess_host(timed(40 * us, 100 * us, 999), 1000.0);
    CHECK_FALSE(few.adequate);
    CHECK(has_reason(few, "only 999 ticks"));
    CHECK_FALSE(assess_host(Timing{}, 1000.0).adequate);

    const HostAssessment late = assess_host(timed(300 * us, 100 * us, 5000), 1000.0);
    CHECK_FALSE(late.adequate);
    CHECK(late.reasons[0].find("of their deadline; expected at most 250 µs") != std::string::npos);

    const HostAssessment slow = assess_host(timed(40 * us, 600 * us, 5000), 1000.0);
    CHECK_FALSE(slow.adequate);
    CHECK(slow.reasons[0].find("took up to") != std::string::npos);

    Timing skipping = timed(40 * us, 100 * us, 5000);
    skipping.missed = 10;
    CHECK_FALSE(assess_host(skipping, 1000.0).adequate);
    skipping.missed = 5;
    CHECK(assess_host(skipping, 1000.0).adequate);

    Timing stalled = timed(40 * us, 100 * us, 5000);
    add(stalled.period, 25 * ms);
    const HostAssessment stall = assess_host(stalled, 1000.0);
    CHECK_FALSE(stall.adequate);
    CHECK(stall.reasons[0].find("25.0 ms") != std::string::npos);
}

TEST_CASE("Host assessment: a host fit for 1 kHz can fail at 4 kHz") {
    const Timing t = timed(100 * us, 60 * us, 5000);
    CHECK(assess_host(t, 1000.0).adequate);
    CHECK_FALSE(assess_host(t, 4000.0).adequate);
    CHECK(assess_host(timed(40 * us, 60 * us, 5000), 4000.0).adequate);
    // No missed deadline at 1 kHz, but one wake-up in a hundred is more than 0.25 ms late.
    Timing rare = timed(40 * us, 60 * us, 5000);
    for (int i = 0; i < 50; ++i) add(rare.wake_up, 400 * us);
    const HostAssessment assessment = assess_host(rare, 4000.0);
    CHECK_FALSE(assessment.adequate);
    CHECK(has_reason(assessment, "0.99 % of the deadlines were missed"));
}

TEST_CASE("Timing: the table gives percentiles in microseconds") {
    const std::string text = describe(timed(40 * us, 100 * us, 5000));
    CHECK(text.find("wake-up") != std::string::npos);
    CHECK(text.find("40.0") != std::string::npos);
    CHECK(text.find("5000 ticks, 0 deadlines missed") != std::string::npos);
}
