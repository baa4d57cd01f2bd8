// Reads and writes the station file: the arm, the wheel and the glove of one station, with properties that
// the installer enters because the devices do not report them. A JSON file, whose members
// content/schema/station.schema.json describes. Registrations (registration.hpp) state the poses of the
// devices:
//
//   {"format": "boltwright station 1",
//    "arm": {"device": "force-dimension:0", "mounting": {"yaw_deg": 180}, "limits": {"force_N": 8}},
//    "glove": {"port": "/dev/ttyUSB0"}}
//
// All members except "format", and "device" and "port" in their objects, are optional.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "content/station/registration.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/base/tracker_role.hpp"
#include "haptics/device/device.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/station/station_tick.hpp"

namespace bolt::content {

// The orientation of a device in front of the user, rad. All zero: as its maker intends, its x to the user's
// right, y up and z to the user. From there it is rolled about its z, then pitched about the user's x
// (positive: its far side rises), then yawed about the vertical (positive: counter-clockwise seen from
// above).
struct Mounting {
    double yaw = 0.0, pitch = 0.0, roll = 0.0;
    bool operator==(const Mounting&) const = default;
};

// The rotation from the device's frame to the user's (x right, y up, z towards the user).
Quat orientation_of(const Mounting& mounting);

// The mover of a station: an arm, or a puck. The file calls it "arm".
struct StationMover {
    std::string device;  // id, as boltwright devices lists it
    Mounting mounting;
    std::optional<double> scale;  // m of the tool per m of the handle; none: fitted to the reach
    // Power at the device / power at the tool (force::WorkspaceMap); none: 1/scale, with which a force has
    // the same magnitude on the tool and on the hand. The file calls it "power".
    std::optional<double> power_ratio;
    std::optional<station::Buttons> buttons;  // none: the defaults
    force::LimitBounds limits;                // upper bounds that the installer sets for the device
    double effector_mass = 0.0;  // kg of what is mounted on the arm (device::OpenOptions::effector_mass)
    std::string tool;            // the assembly's tool whose handle is mounted on the arm; empty: any
    bool operator==(const StationMover&) const = default;
};

struct StationWheel {
    std::string device;
    device::WheelConfig config;
    std::optional<station::Buttons> buttons;
    bool operator==(const StationWheel&) const = default;
};

struct StationFile {
    std::string schema;  // path of the JSON schema, for editors; may be empty
    std::string name;    // for people; may be empty
    std::optional<StationMover> arm;
    std::optional<StationWheel> wheel;
    std::string glove_port;  // empty: no glove
    // The role of the Vive tracker on the gloved hand; none: a controller or the cameras measure the wrist.
    std::optional<TrackerRole> wrist_tracker;
    std::vector<Registration> registrations;  // at most one between two frames
    bool operator==(const StationFile&) const = default;
};

// N/m, smallest stiffness in the file's "limits": a softer spring could not hold the tool.
inline constexpr double min_stiffness = 50.0;

// Errors name `file`, line and column.
Result<StationFile> parse_station(std::string_view text, const std::string& file);
Result<StationFile> load_station(const std::filesystem::path& path);

// The text of a file, one member a line, in the order of the structs. parse_station() returns an equal value.
std::string station_json(const StationFile& station);

// Fails, and leaves the file unchanged, if the values are outside the bounds of parse_station().
Status save_station(const std::filesystem::path& path, const StationFile& station);

}  // namespace bolt::content
