// What whoever built a station knows of a wheel on it and no device tells, kept as a JSON file:
//
//   {"format": "boltwright rig 1", "full_torque_Nm": 8, "most_torque_Nm": 4, "counts_per_turn": 65536}
//
// Every other member may be left out; then it is as in haptics/device/wheel_config.hpp.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/base/result.hpp"
#include "haptics/device/device.hpp"

namespace bolt::content {

// Nobody's wrist is to bear more (N·m), whatever a file says.
inline constexpr double max_configurable_torque = 30.0;

// Errors name `file`, line and column of what is wrong.
Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file);
Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path);

}  // namespace bolt::content
