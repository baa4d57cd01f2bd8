// Reads the configuration of a wheel: properties that the builder of a station enters because the device does
// not report them. A JSON file:
//
//   {"format": "boltwright rig 1", "full_torque_Nm": 8, "most_torque_Nm": 4, "counts_per_turn": 65536}
//
// All members except "format" are optional; the defaults are those of device::WheelConfig
// (haptics/device/device.hpp).
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/base/result.hpp"
#include "haptics/device/device.hpp"

namespace bolt::content {

// N·m, upper bound of the torques in the file, which protects the wrist.
inline constexpr double max_configurable_torque = 30.0;

// Errors name `file`, line and column.
Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file);
Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path);

}  // namespace bolt::content
