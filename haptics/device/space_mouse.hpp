// Decoder and driver of a spring-centred puck with six axes (SpaceMouse class). The report descriptor locates
// the axes; some devices send all six in one report, others translation and rotation in two.
#pragma once

#include <array>
#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

struct SixAxisLayout {
    std::array<ReportField, 6> axes;   // x, y, z, then rotations about them
    std::vector<ReportField> buttons;  // sorted by button number
    bool numbered = false;
};

// Deflection, −1 … 1 each, in the puck's own frame (3Dconnexion: x right, y towards the user, z down;
// rotations right-handed).
struct SixAxisState {
    std::array<double, 6> deflection{};
    std::uint32_t buttons = 0;  // bit i: button i is pressed
};

// Fails if the device lacks one of the six axes.
Result<SixAxisLayout> six_axis_layout(const ReportDescriptor& descriptor);

// Decodes an input report from hidapi (numbered reports begin with their id) into `state`. Returns false if
// the report has none of these fields or is too short.
bool decode_report(const SixAxisLayout& layout, std::span<const std::uint8_t> report, SixAxisState& state);

// The driver of a puck: deflection becomes velocity (Sensing::velocity). It renders no force. A puck at rest
// sends nothing, so read() then returns zero velocity. If reports stop while it is deflected, the velocity
// becomes zero after response.report_timeout.
Result<std::unique_ptr<DeviceDriver>> make_space_mouse(std::unique_ptr<HidTransport> transport,
                                                       const ReportDescriptor& descriptor, std::string name,
                                                       std::string id, const PuckResponse& response = {},
                                                       SecondsClock clock = steady_seconds);

struct PuckRates {
    Vec3 velocity{0.0};          // m/s, in the device frame (device.hpp)
    Vec3 angular_velocity{0.0};  // rad/s
};
PuckRates rates_of(const SixAxisState& state, const PuckResponse& response);

}  // namespace bolt::device
