// Reads the configuration of a wheel: properties that the installer enters because the device does
// not report them. A JSON file:
//
//   {"format": "boltwright rig 1", "full_torque_Nm": 8, "most_torque_Nm": 4, "counts_per_turn": 65536}
//
// All members except "format" are optional; the defaults are those of device::WheelConfig
// (haptics/device/device.hpp). A station file has the same members in its "wheel".
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/device/device.hpp"

namespace bolt::content {

struct MemberReader;

// N·m, upper bound of the torques in the file, which protects the wrist.
inline constexpr double max_configurable_torque = 30.0;

// Errors name `file`, line and column.
Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file);
Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path);

// The members of a wheel configuration without "format", and their values in the JSON object at the pointer
// `at`. Members that are absent leave `config` unchanged.
const std::vector<std::string>& wheel_config_members();
void read_wheel_config(MemberReader& members, const nlohmann::json& object, const std::string& at,
                       device::WheelConfig& config);
// Sets all members of `object`, so that read_wheel_config() reads an equal configuration.
void write_wheel_config(nlohmann::ordered_json& object, const device::WheelConfig& config);

// Converts an angle in rad to degrees for a file. Returns the number that to_radians() converts back to the
// same bits, or the nearest number if there is none.
double exact_degrees(double angle);

}  // namespace bolt::content
