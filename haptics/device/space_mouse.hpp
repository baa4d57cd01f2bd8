// A puck as a Device: deflection becomes velocity (Sensing::rate). It renders no force.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/device/six_axis.hpp"
#include "haptics/device/wheel_config.hpp"

namespace bolt::device {

// A puck at rest sends nothing, so read() then returns zero velocity. If reports stop while it is deflected,
// the velocity becomes zero after response.silence.
Result<std::unique_ptr<Device>> make_space_mouse(std::unique_ptr<HidTransport> line,
                                                 const ReportDescriptor& descriptor, std::string name,
                                                 std::string id, const PuckResponse& response = {},
                                                 Clock clock = steady_seconds);

struct PuckRates {
    Vec3 velocity{0.0};          // m/s, device.hpp's frame
    Vec3 angular_velocity{0.0};  // rad/s
};
PuckRates rates_of(const SixAxisState& state, const PuckResponse& response);

}  // namespace bolt::device
