// The loop on a clock that only this test moves, so that every lateness is the one wanted; then the verdicts.
#include "haptics/servo/loop.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

using namespace bolt;
using namespace bolt::servo;

namespace {

constexpr std::int64_t us = 1000, ms = 1000 * us;

struct VirtualClock {
    std::int64_t time = 77 * ms;
    std::int64_t late = 20 * us;  // of every waking
    int sleeps = 0;
    [[nodiscard]] std::int64_t now() const { return time; }
    void sleep_until(std::int64_t deadline) {
        REQUIRE(deadline > time);  // a deadline that is over would be a burst
        ++sleeps;
        time = deadline + late;
    }
};

struct Run {
    Timing timing;
    std::vector<Beat> beats;
    std::vector<std::int64_t> begun;
    VirtualClock clock;
};

// `work(i)` is how long tick i takes.
Run run(int ticks, std::int64_t period, const std::function<std::int64_t(int)>& work) {
    Run r;
    int i = 0;
    run_loop(
        r.clock, period, r.timing,
        [&](const Beat& beat) {
            r.beats.push_back(beat);
            r.begun.push_back(r.clock.time);
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

bool says(const Verdict& verdict, const std::string& words) {
    for (const std::string& reason : verdict.reasons)
        if (reason.find(words) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("a loop in time: every deadline has its tick, a period after the last, however late the waking") {
    const Run r = run(1000, ms, [](int) { return 300 * us; });
    REQUIRE(r.beats.size() == 1000);
    for (std::size_t i = 0; i < r.beats.size(); ++i) {
        REQUIRE(r.beats[i].number == i + 1);
        REQUIRE(r.beats[i].missed == 0);
        REQUIRE(r.begun[i] == 77 * ms + static_cast<std::int64_t>(i + 1) * ms + 20 * us);
    }
    CHECK(r.timing.ticks == 1000);
    CHECK(r.timing.missed == 0);
    CHECK(r.timing.wake_up.count == 1000);
    CHECK(r.timing.wake_up.greatest == 20 * us);
    CHECK(r.timing.compute.least == 300 * us);
    CHECK(r.timing.period.count == 999);  // the first has none before it
    CHECK(r.timing.period.least == ms);
    CHECK(r.timing.period.greatest == ms);
}

TEST_CASE(
    "an overrun skips what it slept through, counts it and comes back on the beat: never two in a hurry") {
    const Run r = run(100, ms, [](int i) { return i == 10 ? 3500 * us : i == 50 ? 999 * us : 100 * us; });
    CHECK(r.clock.sleeps == 100);
    CHECK(r.beats[10].number == 11);
    CHECK(r.beats[11].number == 15);  // 11.02 + 3.5 ms: the next deadline is the 15th
    CHECK(r.beats[11].missed == 3);
    CHECK(r.beats[12].missed == 0);
    CHECK(r.beats[51].missed == 1);  // 20 µs late and 999 µs of work: just over
    CHECK(r.timing.missed == 4);
    CHECK(r.timing.ticks == 100);
    CHECK(r.beats.back().number == 104);
    for (std::size_t i = 1; i < r.begun.size(); ++i) {
        REQUIRE(r.begun[i] - r.begun[i - 1] >= ms);
        REQUIRE((r.begun[i] - 77 * ms - 20 * us) % ms == 0);
    }
    CHECK(r.timing.period.greatest == 4 * ms);
}

TEST_CASE("every tick too long: half of the deadlines have none, and it still sleeps before each") {
    const Run r = run(200, 250 * us, [](int) { return 300 * us; });
    CHECK(r.clock.sleeps == 200);
    CHECK(r.timing.missed == 199);
    CHECK(r.beats.back().number == 399);
}

TEST_CASE("a host is good enough, or not for the reason that is so") {
    const Verdict good = judge_host(timed(40 * us, 100 * us, 5000), 1000.0);
    CHECK(good.good);
    CHECK(good.reasons.size() == 4);  // what was held is told too

    const Verdict few = judge_host(timed(40 * us, 100 * us, 999), 1000.0);
    CHECK_FALSE(few.good);
    CHECK(says(few, "only 999 ticks"));
    CHECK_FALSE(judge_host(Timing{}, 1000.0).good);

    const Verdict late = judge_host(timed(300 * us, 100 * us, 5000), 1000.0);
    CHECK_FALSE(late.good);
    CHECK(late.reasons[0].find("of their deadline; at most 250 µs") != std::string::npos);

    const Verdict slow = judge_host(timed(40 * us, 600 * us, 5000), 1000.0);
    CHECK_FALSE(slow.good);
    CHECK(slow.reasons[0].find("took up to") != std::string::npos);

    Timing skipping = timed(40 * us, 100 * us, 5000);
    skipping.missed = 10;
    CHECK_FALSE(judge_host(skipping, 1000.0).good);
    skipping.missed = 5;
    CHECK(judge_host(skipping, 1000.0).good);

    Timing stalled = timed(40 * us, 100 * us, 5000);
    add(stalled.period, 25 * ms);
    const Verdict stall = judge_host(stalled, 1000.0);
    CHECK_FALSE(stall.good);
    CHECK(stall.reasons[0].find("25.0 ms") != std::string::npos);
}

TEST_CASE("what keeps 1 kHz need not keep 4 kHz") {
    const Timing t = timed(100 * us, 60 * us, 5000);
    CHECK(judge_host(t, 1000.0).good);
    CHECK_FALSE(judge_host(t, 4000.0).good);
    CHECK(judge_host(timed(40 * us, 60 * us, 5000), 4000.0).good);
    // Timed at 1 kHz without a miss, but one waking in a hundred comes after more than a quarter millisecond.
    Timing rare = timed(40 * us, 60 * us, 5000);
    for (int i = 0; i < 50; ++i) add(rare.wake_up, 400 * us);
    const Verdict verdict = judge_host(rare, 4000.0);
    CHECK_FALSE(verdict.good);
    CHECK(says(verdict, "0.99 % of the deadlines were missed"));
}

TEST_CASE("the timing as text has its percentiles in microseconds") {
    const std::string text = describe(timed(40 * us, 100 * us, 5000));
    CHECK(text.find("wake-up") != std::string::npos);
    CHECK(text.find("40.0") != std::string::npos);
    CHECK(text.find("5000 ticks, 0 deadlines missed") != std::string::npos);
}
