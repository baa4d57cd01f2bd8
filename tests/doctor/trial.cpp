// The trial of a station: its messages, its report and its assessment.
#include "game/station/trial.hpp"

#include <doctest/doctest.h>

#include "tests/station/support.hpp"

using namespace bolt;
using namespace bolt::station;
using namespace bolt::station_setup;

namespace {

// A trial without faults.
StationTrial faultless() {
    StationTrial trial;
    trial.seconds = 5.0;
    trial.wheel = DeviceTrial{test::wheel_of(2.0), {5000, 1e-3, 2e-3, 0.0, 1.5}, 0, 0};
    trial.mover = DeviceTrial{test::puck(), {600, 5e-3, 40e-3, 0.0, 0.0}, 0, 0};
    for (int i = 0; i < 5000; ++i) {
        servo::add(trial.timing.wake_up, 10'000);
        servo::add(trial.timing.compute, 20'000);
        servo::add(trial.timing.period, 1'000'000);
    }
    trial.timing.ticks = 5000;
    return trial;
}

}  // namespace

TEST_CASE("Trial: each problem is one episode from its beginning to its end") {
    std::vector<Episode> episodes;
    std::string messages;
    const auto on_message = [&](double, const std::string& message) { messages += message + "; "; };
    const auto now = [&](double time, const std::vector<std::string>& fault_messages) {
        update_episodes(episodes, fault_messages, time, on_message);
    };
    now(0.0, {});
    now(1.0, {"a"});
    now(1.1, {"a", "b"});
    now(1.2, {"b", "a"});
    now(2.0, {"b"});
    now(3.0, {"a", "b"});
    CHECK(messages == "a; b; resolved: a; a; ");
    REQUIRE(episodes.size() == 3);
    CHECK(episodes[0].from == 1.0);
    CHECK(episodes[0].until == 2.0);
    CHECK(!episodes[1].until);
    CHECK(episodes[2].from == 3.0);
    messages.clear();
    now(4.0, {"it says nothing", "b"});
    now(4.05, {"it is gone", "b"});  // the first message was its onset
    now(4.10, {"it is gone", "a glance"});
    now(4.12, {"it is gone"});
    CHECK(messages ==
          "resolved: a; it says nothing; it is gone; resolved: b; a glance; resolved: a glance; ");
    REQUIRE(episodes.size() == 5);
    CHECK(episodes[3].message == "it is gone");
}

TEST_CASE("Trial: a station is fit unless a problem occurred, and the reasons name it") {
    CHECK(unfit_reasons(faultless()).empty());
    StationTrial gone = faultless();
    gone.episodes = {{"it was pulled", 1.0, 2.5}, {"it is gone", 4.0, std::nullopt}};
    REQUIRE(unfit_reasons(gone).size() == 2);
    CHECK(unfit_reasons(gone)[0] == "it is gone");
    CHECK(unfit_reasons(gone)[1] == "it was pulled (from 1.0 to 2.5 s)");
    StationTrial silent = faultless();
    silent.wheel->stats.longest_silence = 0.030;
    REQUIRE(unfit_reasons(silent).size() == 1);
    CHECK(unfit_reasons(silent)[0].find("30 ms") != std::string::npos);
    silent.wheel->losses = 1;
    CHECK(unfit_reasons(silent).empty());
    silent.wheel->losses = 0;
    silent.wheel->description.silent_at_rest = true;
    CHECK(unfit_reasons(silent).empty());
    StationTrial late = faultless();
    for (int i = 0; i < 100; ++i) servo::add(late.timing.wake_up, 900'000);
    REQUIRE(unfit_reasons(late).size() == 1);
    CHECK(unfit_reasons(late)[0].find("of their deadline") != std::string::npos);
    StationTrial few = faultless();
    few.timing.ticks = 100;
    REQUIRE(unfit_reasons(few).size() == 1);
    CHECK(unfit_reasons(few)[0].find("only 100 ticks") != std::string::npos);
}

TEST_CASE("Trial: the introduction names the button that enables forces") {
    DeviceLayout layout;
    layout.mover = test::puck();
    DeviceSelection both{device::ListedDevice{}, device::ListedDevice{}};
    CHECK(describe_station(layout, both).find("no device renders any") != std::string::npos);
    layout.wheel = test::wheel_of(2.0);
    CHECK(describe_station(layout, both).find("only while button 1 of a puck is held") != std::string::npos);
    layout.wheel->buttons = 4;
    layout.wheel_buttons.dead_man = 4;
    CHECK(describe_station(layout, both).find("button 1 of a puck or button 3 of a wheel is held") !=
          std::string::npos);
    layout.mover->buttons = layout.wheel->buttons = 0;
    CHECK(describe_station(layout, both).find("no device has one") != std::string::npos);
    CHECK(describe_station(layout, {std::nullopt, device::ListedDevice{}}).find("it stands still") !=
          std::string::npos);
}

TEST_CASE("Trial: the report has the samples and commands of each device and the glove's wearer") {
    StationTrial trial = faultless();
    const std::string plain = trial_report(trial);
    for (const char* words : {"a puck: moves the tool", "600 samples, 120 a second", "renders no force",
                              "a wheel: turns the wrench on its bolt", "5000 samples, 1000 a second",
                              "largest torque 1.50 N·m of at most 2 N·m", "never held", "0 deadlines missed"})
        CHECK_MESSAGE(plain.find(words) != std::string::npos, words);
    CHECK(plain.find("Glove") == std::string::npos);
    trial.dead_man_time = 2.0;
    trial.glove.emplace();
    trial.glove->frames = 400.0;
    CHECK(trial_report(trial).find("held for 2.0 s") != std::string::npos);
    CHECK(trial_report(trial).find("it did not answer") != std::string::npos);
    trial.glove->report.handshakes = 1;
    CHECK(trial_report(trial).find("--trainee NAME") != std::string::npos);
    trial.glove->calibration.emplace();
    trial.glove->calibration->trainee = "Ada";
    CHECK(trial_report(trial).find("calibrated for Ada\n") != std::string::npos);
    CHECK(trial_report(trial).find("does not hold the wrench") != std::string::npos);
    trial.glove->held = true;
    CHECK(trial_report(trial).find("holds the wrench\n") != std::string::npos);
}

TEST_CASE("Link statistics: they count samples from the first tick on, silence and the largest command") {
    LinkStats stats;
    DeviceLink link;
    link.number = 3;
    record_tick(stats, link, {Vec3(3.0, 4.0, 0.0), Vec3(0.0)});
    link.silence = 0.02;
    record_tick(stats, link, {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0)});
    link.number = 4;
    link.silence = 0.0;
    record_tick(stats, link, {});
    CHECK(stats.samples == 1);  // the device had sent three before
    CHECK(stats.silence == 0.0);
    CHECK(stats.longest_silence == 0.02);
    CHECK(stats.largest_force == 5.0);
    CHECK(stats.largest_torque == 0.5);
}
