// Registrations of a station: the pose of one frame in another, such as the arm in the room, and how well it
// was measured. The head in front of projection walls does not use them: its tracker has a registration of
// its own in the display file (content/displays/display_file.hpp). A station file has them in its list
// "registrations":
//
//   {"from": "arm", "to": "room", "date": "2026-03-02T09:15:00Z",
//    "position_m": [0.41, 0.72, -0.3], "orientation_wxyz": [1, 0, 0, 0],
//    "points": 7, "rms_m": 0.0012, "largest_left_out_m": 0.0031,
//    "check_point": {"from_m": [0.05, 0, 0.02], "to_m": [0.46, 0.72, -0.28]}, "tip_m": [0, 0, 0.1]}
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/base/rigid_alignment.hpp"

namespace bolt::content {

struct MemberReader;

// Right-handed frames of a station, in m.
enum class CoordinateFrame : std::uint8_t {
    arm,            // of the arm's samples (haptics/device/device.hpp), before its mounting is applied
    wheel,          // of the wheel; in old files only
    tracker,        // of a tracking system
    wall,           // of a projection wall
    workpiece,      // of the assembly
    room,           // fixed in the room; the STAGE space of OpenXR
    hand,           // the wrist of a gloved hand (hand::wrist)
    controller,     // the grip pose of a controller that is fixed to that hand
    wrist_tracker,  // the grip pose of a Vive tracker that is fixed to that hand
};
const std::vector<std::string>& coordinate_frame_names();  // in the order of the enumerators
std::string_view name(CoordinateFrame frame);
// Fails for an unknown name.
Result<CoordinateFrame> parse_coordinate_frame(std::string_view text);

struct Registration {
    CoordinateFrame from = CoordinateFrame::arm, to = CoordinateFrame::room;
    std::string date;  // UTC, as in 2026-03-02T09:15:00Z
    Pose pose;         // takes coordinates in `from` to those in `to`
    int points = 0;    // from which the pose was computed
    double rms = 0.0;  // m, of their residuals
    // m, largest distance between a point and where the other points predict it; none with three points.
    std::optional<double> largest_left_out;
    // A point that the fit did not use, as measured in both frames. Touching it checks the registration.
    std::optional<PointPair> check_point;
    // m, of an arm that touched the points: its tip in the frame of its handle.
    Vec3 tip{0.0};
    bool operator==(const Registration& other) const;
};

inline constexpr double max_registered_distance = 1000.0;  // m, bound of coordinates
inline constexpr double max_registered_rms = 1.0;          // m
inline constexpr int max_registered_points = 1000;
inline constexpr double unit_tolerance = 1e-6;  // of the length of a quaternion in a file

// Returns true for a valid date and time of the form 2026-03-02T09:15:00Z.
bool is_utc_date(std::string_view text);

// m, distance between the check point in `to` and where the pose predicts it; none without a check point.
std::optional<double> check_error(const Registration& registration);

// The registration between the two frames, in either direction; null: none.
const Registration* find_registration(std::span<const Registration> registrations, CoordinateFrame from,
                                      CoordinateFrame to);

// Adds the registration. It replaces one between the same two frames, in either direction.
void set_registration(std::vector<Registration>& registrations, const Registration& registration);

// Reads the member "registrations" of the root object; absent: none.
std::vector<Registration> read_registrations(MemberReader& members, const nlohmann::json& root);
// Sets the member unless the list is empty.
void write_registrations(nlohmann::ordered_json& root, std::span<const Registration> registrations);

}  // namespace bolt::content
