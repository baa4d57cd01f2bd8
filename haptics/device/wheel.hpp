// Wheels with USB's force feedback as devices: one axis that turns (Sensing::turn) and pulls.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/hid_line.hpp"
#include "haptics/device/report_descriptor.hpp"
#include "haptics/device/rig.hpp"

namespace bolt::device {

// Any wheel. Its range and its motor are taken from the rig. One that rests sends nothing; that it rests is
// believed for a quarter of a second.
Result<std::unique_ptr<Device>> make_wheel(std::unique_ptr<HidLine> line, const ReportDescriptor& descriptor,
                                           std::string name, std::string id, const Rig& rig = {},
                                           Clock clock = steady_seconds);

// An OpenFFBoard is asked for its range and its power, and for its encoder all the time: so it is known to
// live while it rests, and turns without end where the rig says how many counts a turn has.
Result<std::unique_ptr<Device>> make_open_ffboard(std::unique_ptr<HidLine> line,
                                                  const ReportDescriptor& descriptor, std::string name,
                                                  std::string id, const Rig& rig = {},
                                                  Clock clock = steady_seconds);

}  // namespace bolt::device
