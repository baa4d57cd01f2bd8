#include "haptics/device/device.hpp"

#include <doctest/doctest.h>

#include "tests/device/support.hpp"

namespace device_describe_test {

using namespace bolt;
using namespace bolt::device;

namespace {

std::string all(const Description& description) {
    std::string text;
    for (const std::string& line : summary_lines(description)) text += line + "\n";
    return text;
}

}  // namespace

TEST_CASE("Describe: the summary gives what a device renders with figures, and omits the rest") {
    Description arm = test::arm();
    arm.remarks = {"its cable is worn"};
    CHECK(all(arm) ==
          "senses the pose of the hand in six degrees of freedom, within 40 x 40 x 40 cm, 1000 times a "
          "second; 2 buttons\n"
          "renders force along 3 axes, 20 N at most, as stiff as 2 N/mm; torque about 3 axes, 2 N·m at "
          "most\n"
          "its cable is worn\n");
    arm.model = "omega.6";
    arm.serial = "1234";
    arm.senses_rotation = false;
    CHECK(all(arm).find(
              "model omega.6, serial number 1234\nsenses the position of the hand in three degrees of "
              "freedom") == 0);
    Description wheel;
    wheel.sensing = Sensing::angle;
    wheel.silent_at_rest = true;
    wheel.renders[5] = true;
    wheel.limits.force = 0.0;
    wheel.limits.torque = 12.5;
    wheel.buttons = 1;
    CHECK(all(wheel) ==
          "senses the angle of its one axis, 1000 times a second while it moves; 1 button\n"
          "renders torque about 1 axis, 12.5 N·m at most\n");
    Description puck;
    puck.sensing = Sensing::velocity;
    puck.rate = 125;
    CHECK(all(puck) ==
          "senses a commanded velocity in six degrees of freedom, 125 times a second while it moves; 0 "
          "buttons\n"
          "renders no force\n");
}

TEST_CASE("Describe: the health of an arm has a line for what it reports") {
    using Lines = std::vector<std::string>;
    CHECK(summary_lines(DeviceHealth{}).empty());
    CHECK(summary_lines(DeviceHealth{true, 0.3, false}) ==
          Lines{"calibrated", "motors at 30 % of their greatest heat"});
    CHECK(summary_lines(DeviceHealth{false, 0.85, false}) ==
          Lines{"not calibrated: its position is unknown",
                "motors at 85 % of their greatest heat: rest the arm"});
    CHECK(summary_lines(DeviceHealth{{}, 0.75, true}) ==
          Lines{"motors at 75 % of their greatest heat: no force until they are cool"});
}

}  // namespace device_describe_test
