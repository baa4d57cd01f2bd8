// A station that is tried: what is said of it, and when it is not good enough.
#include "game/station/trial.hpp"

#include <doctest/doctest.h>

#include "tests/station/support.hpp"

using namespace bolt;
using namespace bolt::station;
using namespace bolt::station_setup;

namespace {

// As good as can be.
Trial good() {
    Trial trial;
    trial.seconds = 5.0;
    trial.wheel = TriedDevice{test::wheel_of(2.0), {5000, 1e-3, 2e-3, 0.0, 1.5}, 0, 0};
    trial.mover = TriedDevice{test::puck(), {600, 5e-3, 40e-3, 0.0, 0.0}, 0, 0};
    for (int i = 0; i < 5000; ++i) {
        servo::add(trial.timing.wake_up, 10'000);
        servo::add(trial.timing.compute, 20'000);
        servo::add(trial.timing.period, 1'000'000);
    }
    trial.timing.ticks = 5000;
    return trial;
}

}  // namespace

TEST_CASE("Trial: each problem is one episode from its begin to its end") {
    std::vector<Episode> episodes;
    std::string told;
    const auto tell = [&](double, const std::string& words) { told += words + "; "; };
    const auto now = [&](double time, const std::vector<std::string>& troubles) {
        note(episodes, troubles, time, tell);
    };
    now(0.0, {});
    now(1.0, {"a"});
    now(1.1, {"a", "b"});
    now(1.2, {"b", "a"});
    now(2.0, {"b"});
    now(3.0, {"a", "b"});
    CHECK(told == "a; b; over: a; a; ");
    REQUIRE(episodes.size() == 3);
    CHECK(episodes[0].from == 1.0);
    CHECK(episodes[0].until == 2.0);
    CHECK(!episodes[1].until);
    CHECK(episodes[2].from == 3.0);
    told.clear();
    now(4.0, {"it says nothing", "b"});
    now(4.05, {"it is gone", "b"});  // which is what the other words meant
    now(4.10, {"it is gone", "a glance"});
    now(4.12, {"it is gone"});
    CHECK(told == "over: a; it says nothing; it is gone; over: b; a glance; over: a glance; ");
    REQUIRE(episodes.size() == 5);
    CHECK(episodes[3].words == "it is gone");
}

TEST_CASE("Trial: a station is fit unless a problem occurred, and the reasons name it") {
    CHECK(against(good()).empty());
    Trial gone = good();
    gone.episodes = {{"it was pulled", 1.0, 2.5}, {"it is gone", 4.0, std::nullopt}};
    REQUIRE(against(gone).size() == 2);
    CHECK(against(gone)[0] == "it is gone");
    CHECK(against(gone)[1] == "it was pulled (from 1.0 to 2.5 s)");
    Trial silent = good();
    silent.wheel->stats.longest_silence = 0.030;
    REQUIRE(against(silent).size() == 1);
    CHECK(against(silent)[0].find("30 ms") != std::string::npos);
    silent.wheel->losses = 1;
    CHECK(against(silent).empty());
    silent.wheel->losses = 0;
    silent.wheel->description.silent_at_rest = true;
    CHECK(against(silent).empty());
    Trial late = good();
    for (int i = 0; i < 100; ++i) servo::add(late.timing.wake_up, 900'000);
    REQUIRE(against(late).size() == 1);
    CHECK(against(late)[0].find("of their deadline") != std::string::npos);
    Trial few = good();
    few.timing.ticks = 100;
    REQUIRE(against(few).size() == 1);
    CHECK(against(few)[0].find("only 100 ticks") != std::string::npos);
}

TEST_CASE("Trial: the introduction names the button that enables forces") {
    Layout layout;
    layout.mover = test::puck();
    Choice both{device::ListedDevice{}, device::ListedDevice{}};
    CHECK(introduce(layout, both).find("nothing here renders any") != std::string::npos);
    layout.wheel = test::wheel_of(2.0);
    CHECK(introduce(layout, both).find("only while button 1 of a puck is held") != std::string::npos);
    layout.wheel->buttons = 4;
    layout.wheel_buttons.held = 4;
    CHECK(introduce(layout, both).find("button 1 of a puck or button 3 of a wheel is held") !=
          std::string::npos);
    layout.mover->buttons = layout.wheel->buttons = 0;
    CHECK(introduce(layout, both).find("there is none") != std::string::npos);
    CHECK(introduce(layout, {std::nullopt, device::ListedDevice{}}).find("it stands still") !=
          std::string::npos);
}

TEST_CASE("Trial: the report has the samples and commands of each device and the glove's wearer") {
    Trial trial = good();
    const std::string plain = report(trial);
    for (const char* words : {"a puck: moves the tool", "600 samples, 120 a second", "renders no force",
                              "a wheel: turns the wrench on its bolt", "5000 samples, 1000 a second",
                              "1.50 N·m at most went out, of 2 N·m", "never held", "0 deadlines missed"})
        CHECK_MESSAGE(plain.find(words) != std::string::npos, words);
    CHECK(plain.find("Glove") == std::string::npos);
    trial.enabled = 2.0;
    trial.glove.emplace();
    trial.glove->frames = 400.0;
    CHECK(report(trial).find("held for 2.0 s") != std::string::npos);
    CHECK(report(trial).find("it did not answer") != std::string::npos);
    trial.glove->report.handshakes = 1;
    CHECK(report(trial).find("--trainee NAME") != std::string::npos);
    trial.glove->worn.emplace();
    trial.glove->worn->trainee = "Ada";
    CHECK(report(trial).find("calibrated for Ada\n") != std::string::npos);
    CHECK(report(trial).find("does not hold the wrench") != std::string::npos);
    trial.glove->held = true;
    CHECK(report(trial).find("holds the wrench\n") != std::string::npos);
}

TEST_CASE("Link statistics: they count samples, silence and the largest command") {
    LinkStats stats;
    DeviceLink port;
    port.number = 3;
    count(stats, port, {Vec3(3.0, 4.0, 0.0), Vec3(0.0)});
    port.silence = 0.02;
    count(stats, port, {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0)});
    port.number = 4;
    port.silence = 0.0;
    count(stats, port, {});
    CHECK(stats.samples == 4);
    CHECK(stats.silence == 0.0);
    CHECK(stats.longest_silence == 0.02);
    CHECK(stats.largest_force == 5.0);
    CHECK(stats.largest_torque == 0.5);
}
