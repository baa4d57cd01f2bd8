// Decodes the angle and the buttons of a wheel.
#pragma once

#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

struct WheelAxis {
    Field axis;                  // usage Steering, or X of a joystick
    std::vector<Field> buttons;  // sorted by button number
    bool numbered = false;
};

struct WheelState {
    double share = 0.0;         // −1 at the left stop, 1 at the right stop
    std::uint32_t buttons = 0;  // bit i: button i is pressed
};

Result<WheelAxis> wheel_axis(const ReportDescriptor& descriptor);

// Decodes an input report (numbered reports begin with their id). Returns false if it has no angle.
bool decode_report(const WheelAxis& layout, std::span<const std::uint8_t> report, WheelState& state);

}  // namespace bolt::device
