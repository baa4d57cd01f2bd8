// The examination of one device: its report, and what is skipped.
#include "game/station/device_check.hpp"

#include <doctest/doctest.h>

#include "haptics/device/simulated_arm.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "tests/station/support.hpp"

using namespace bolt;
using namespace bolt::station_setup;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

DeviceCheck checked_arm() {
    DeviceCheck check;
    check.description = device::simulated_arm_description();
    check.health = {true, 0.9, false};
    check.seconds = 2.0;
    check.samples = 1998;
    for (int i = 0; i < 100; ++i) servo::add(check.age, 500'000);
    check.writes = 10;
    check.mean_write = 0.02e-3;
    check.longest_write = 1.25e-3;
    check.why_not_measured = "it may not push the hand";
    return check;
}

}  // namespace

TEST_CASE("Device check: the report has what was measured, and why the rest was not") {
    DeviceCheck check = checked_arm();
    std::string text = device_check_report(check);
    CHECK(has(text, "  calibrated\n"));
    CHECK(has(text, "  motors at 90 % of their greatest heat: rest the arm\n"));
    CHECK(has(text, "  sent 999 samples a second\n"));
    CHECK(has(text, "until a servo tick takes it: 0.5"));
    CHECK(has(text, "  the driver takes a command in 0.020 ms (mean of 10; longest 1.25 ms)\n"));
    CHECK(has(text, "  stiffness not measured: it may not push the hand\n"));

    check.stiffness = station::begin_stiffness_trial(check.description);
    check.stiffness->end = station::TrialEnd::oscillation;
    check.stiffness->level = 4;
    check.stiffness->stable = 800.0;
    check.stiffness->responses = {0.004, 0.009, 0.005};
    text = device_check_report(check);
    CHECK(has(text,
              "stable on this computer up to 0.8 N/mm of the reported 2 N/mm: at 1 N/mm the handle keeps "
              "oscillating\n"));
    CHECK(has(text, "moves by 0.03 mm within 5 ms of a command (median of 3 steps of 2.4 N"));
    check.stiffness->stable = 0.0;
    check.stiffness->level = 0;
    check.stiffness->end = station::TrialEnd::fault;
    check.stiffness->fault = force::Fault::too_fast;
    CHECK(
        has(device_check_report(check),
            "not stable on this computer at any stiffness that was tried: at 0.2 N/mm the force was blocked: "
            "the device moves too fast\n"));
}

TEST_CASE("Device check: a device without force is examined without its stiffness") {
    device::VirtualPuck puck({}, device::steady_timer());
    auto thread = device::DeviceThread::start(puck.factory());
    REQUIRE(thread);
    REQUIRE(thread->wait_until_open(60.0));
    CHECK(trial_force(**thread->wait_until_open(0.0), {}) == 0.0);
    DeviceCheckOptions options;
    options.seconds = 0.05;
    options.measures_stiffness = true;
    const auto check = check_device(*thread, options);
    REQUIRE_MESSAGE(check, (check ? "" : check.error().message()));
    CHECK_FALSE(check->stiffness);
    CHECK(check->why_not_measured == "it renders no force");
    CHECK(check->seconds >= 0.05);
}

TEST_CASE("Device check: an arm whose button is not held is not pushed") {
    device::SimulatedArm arm(device::simulated_arm_description(), device::simulated_arm_parameters(),
                             device::steady_timer());
    auto thread = device::DeviceThread::start(arm.factory());
    REQUIRE(thread);
    REQUIRE(thread->wait_until_open(60.0));
    DeviceCheckOptions options;
    options.seconds = 0.2;
    options.measures_stiffness = true;
    int looks = 0;
    options.stop = [&] { return ++looks > 40; };
    const auto check = check_device(*thread, options);
    REQUIRE_MESSAGE(check, (check ? "" : check.error().message()));
    CHECK(check->samples > 0);
    CHECK(check->age.count > 0);
    CHECK_FALSE(check->stiffness);
    CHECK(check->why_not_measured == "it was interrupted");
}
