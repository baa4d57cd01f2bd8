// A puck as a device: pushes and turns become speeds (Sensing::rate). It renders nothing.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/hid_line.hpp"
#include "haptics/device/rig.hpp"
#include "haptics/device/six_axis.hpp"

namespace bolt::device {

// A puck at rest sends nothing: it is told to stand still as often as somebody asks. One that falls silent
// while it is pushed stands still after feel.silence.
Result<std::unique_ptr<Device>> make_space_mouse(std::unique_ptr<HidLine> line,
                                                 const ReportDescriptor& descriptor, std::string name,
                                                 std::string id, const PuckFeel& feel = {},
                                                 Clock clock = steady_seconds);

struct PuckRates {
    Vec3 velocity{0.0};          // m/s, device.hpp's frame
    Vec3 angular_velocity{0.0};  // rad/s
};
PuckRates rates_of(const SixAxisState& state, const PuckFeel& feel);

}  // namespace bolt::device
