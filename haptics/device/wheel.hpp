// Wheels with USB force feedback as devices: one rotating axis (Sensing::turn) that renders torque.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/device/report_descriptor.hpp"
#include "haptics/device/wheel_config.hpp"

namespace bolt::device {

// Any wheel. Range and motor torque come from `config`. A wheel at rest sends nothing; silence counts as rest
// for 0.25 s.
Result<std::unique_ptr<Device>> make_wheel(std::unique_ptr<HidTransport> line,
                                           const ReportDescriptor& descriptor, std::string name,
                                           std::string id, const WheelConfig& config = {},
                                           Clock clock = steady_seconds);

// An OpenFFBoard: range and power are read at opening, the encoder continuously, so that silence at rest is
// detected as a loss. The angle is unlimited if `config` gives counts per turn.
Result<std::unique_ptr<Device>> make_open_ffboard(std::unique_ptr<HidTransport> line,
                                                  const ReportDescriptor& descriptor, std::string name,
                                                  std::string id, const WheelConfig& config = {},
                                                  Clock clock = steady_seconds);

}  // namespace bolt::device
