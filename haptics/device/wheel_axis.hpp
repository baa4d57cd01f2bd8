// Where a wheel says how far it is turned, and which buttons are pressed.
#pragma once

#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

struct WheelAxis {
    Field axis;                  // steering, or a joystick's x
    std::vector<Field> buttons;  // in the order of their numbers
    bool numbered = false;
};

struct WheelState {
    double share = 0.0;         // −1 at the left stop, 1 at the right one
    std::uint32_t buttons = 0;  // a bit each
};

Result<WheelAxis> wheel_axis(const ReportDescriptor& descriptor);

// An input report, with its id in front where reports are numbered. False: it does not tell the angle.
bool take_report(const WheelAxis& layout, std::span<const std::uint8_t> report, WheelState& state);

}  // namespace bolt::device
