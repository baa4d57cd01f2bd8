// Compares a station file with the devices that it names, and makes a new file from the connected devices.
#pragma once

#include "game/station/station_setup.hpp"

namespace bolt::station_setup {

struct StationFinding {
    // The station cannot be used with the settings of the file. False: a warning, for example of a setting
    // without effect.
    bool prevents_use = false;
    std::string text;
};

// Descriptions of the devices that a station file names.
struct StationFacts {
    // The description that the device reports, or why it cannot be opened; none: the file names no device.
    std::optional<Result<device::Description>> arm, wheel;
    Status glove;                    // why its port cannot be used
    std::vector<std::string> tools;  // of all assemblies that are found
};

// Opens the devices that the file names, and reads the assemblies.
StationFacts find_facts(const content::StationFile& station);

// Findings that prevent the use come first. `arm` must sense a pose or a velocity, `wheel` a turn. Pass the
// descriptions that the devices report, not descriptions whose limits a station has lowered.
std::vector<StationFinding> compare(const content::StationFile& station, const StationFacts& facts);
std::vector<StationFinding> compare(const content::StationMover& arm, const device::Description& reported);
std::vector<StationFinding> compare(const content::StationWheel& wheel, const device::Description& reported);

// One line for each finding.
std::string describe(std::span<const StationFinding> findings);

// Opens the device and reads what it reports. Fails if it cannot be opened within 3 s.
Result<device::Description> read_description(const std::string& id, const device::WheelConfig& config);

// A station file with the values that the devices report: functions for the buttons that they have, and the
// limits, which the installer may lower. `mover`, `wheel` null: there is none.
content::StationFile station_of(const device::Description* mover, const device::Description* wheel);

}  // namespace bolt::station_setup
