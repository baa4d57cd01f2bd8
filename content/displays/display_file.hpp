// Reads and writes the display file: the projection walls of one room, where their pictures are shown, and
// how the viewer's head is tracked. A JSON file, whose members content/schema/displays.schema.json describes:
//
//   {"format": "boltwright displays 1",
//    "head": {"tracker": "dtrack", "port": 5000, "body": 0},
//    "walls": [{"name": "front", "lower_left_m": [-1.5, 0, -1.5], "lower_right_m": [1.5, 0, -1.5],
//               "upper_right_m": [1.5, 2.4, -1.5], "stereo": "side_by_side", "output": {"monitor": "DP-1"}}]}
//
// Coordinates are in the room: x to the right, y up from the floor, z towards the viewer's first position, m.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::content {

struct PixelPosition {
    int x = 0, y = 0;  // y down
    bool operator==(const PixelPosition&) const = default;
};
struct PixelSize {
    int width = 0, height = 0;
    bool operator==(const PixelSize&) const = default;
};

// Where a picture is shown. Exactly one of `monitor`, `monitor_index` and `position` is given.
struct DisplayOutput {
    std::string monitor;                    // name of the monitor that the picture fills. Empty: not given
    std::optional<int> monitor_index;       // in the computer's list of monitors, from 0
    std::optional<PixelPosition> position;  // upper left corner of a borderless window on the desktop
    std::optional<PixelSize> resolution;    // required for a window; none: that of the monitor
    std::string display;                    // X display; empty: that of the program
    // Number of the process that shows it. The file's key is `rank`, as MPI and ParaView call the number.
    int process = 0;
    bool operator==(const DisplayOutput&) const = default;
};

enum class StereoMode : std::uint8_t {
    mono,          // one picture, from between the eyes
    side_by_side,  // the left eye's in the left half of the output
    top_bottom,    // the left eye's in the upper half of the output
    two_outputs,   // an output for each eye
};
std::string_view name(StereoMode mode);

// The corners of the picture, as the viewer sees it, m in the room.
struct Wall {
    std::string name;
    Vec3 lower_left{0.0}, lower_right{0.0}, upper_right{0.0};
    StereoMode stereo = StereoMode::mono;
    bool swap_eyes = false;                     // exchanges the pictures of the eyes
    DisplayOutput output;                       // two_outputs: that of the left eye
    std::optional<DisplayOutput> right_output;  // given if and only if two_outputs
    bool operator==(const Wall&) const = default;
};

// The fourth corner (R. Kooima, Generalized Perspective Projection, 2008).
inline Vec3 upper_left(const Wall& wall) { return wall.lower_left + wall.upper_right - wall.lower_right; }
inline double width(const Wall& wall) { return glm::length(wall.lower_right - wall.lower_left); }    // m
inline double height(const Wall& wall) { return glm::length(wall.upper_right - wall.lower_right); }  // m

// The source of the poses of the head. fixed: there is no tracker. file: recorded poses.
enum class HeadTracker : std::uint8_t { fixed, dtrack, openxr, file };
std::string_view name(HeadTracker tracker);

// The pose that an OpenXR runtime tracks: that of the headset, or the grip pose of a controller.
enum class TrackedPose : std::uint8_t { headset, left_hand, right_hand };
std::string_view name(TrackedPose pose);

// An axis of the tracker: 0, 1, 2 for x, y, z.
struct TrackerAxis {
    int axis = 0;
    bool negative = false;
    bool operator==(const TrackerAxis&) const = default;
};

// A flystick of DTrack, with which the viewer points at the panel. Buttons are counted from 1; 0: none.
struct Flystick {
    int id = 0;
    // In the flystick's frame, whose axes HeadTracking::axes has converted: the pose that points along −z.
    Pose aim_in_body;
    // Buttons: `select` presses what the flystick points at, `menu` pauses, `tool` lays the wrench down.
    int select = 1, menu = 2, tool = 3;
    bool operator==(const Flystick& other) const;
};
inline constexpr int max_flystick_button = 32;

// The pose of the head is that of the point between the eyes, which looks along −z with y up. Only the
// registration in this file is used for the head, not one in a station file
// (content/station/registration.hpp).
struct HeadTracking {
    HeadTracker tracker = HeadTracker::fixed;
    Pose fixed_head{{0.0, 1.6, 0.0}, {1.0, 0.0, 0.0, 0.0}};  // without a tracker, and after it lost the head
    int port = 5000;                                         // dtrack: UDP port
    int body = 0;                                            // dtrack: id of the head's body
    std::optional<Flystick> flystick;                        // dtrack; none: the viewer has none
    TrackedPose pose = TrackedPose::headset;                 // openxr: the pose that is the head's
    std::string recording;  // file: the recorded poses, relative to the folder of the display file
    std::array<TrackerAxis, 3> axes{{{0}, {1}, {2}}};  // tracker axes along the room's x, y and z
    double scale = 1.0;                                // m of the room per m of the tracker
    Pose tracker_in_room;    // the tracker's frame; applied after `axes` and `scale`
    Pose head_in_body;       // in the tracked body's frame, whose axes `axes` has converted
    double hold = 0.5;       // s, duration of a dropout up to which the last pose is kept
    double fade = 2.0;       // s, duration of the return to the fixed head
    double max_speed = 4.0;  // m/s; a faster change is a jump
    double jump_time = 0.3;  // s, after which a lasting jump is accepted
    bool operator==(const HeadTracking& other) const;
};

// The rotation from the tracker's axes to the room's.
Quat orientation_of(const std::array<TrackerAxis, 3>& axes);

// m. The value is ParaView's default in a CAVE, so that an imported .pvx file without one gives the same
// pictures.
// view::mean_eye_separation is the mean of adults.
inline constexpr double default_eye_separation = 0.065;
inline constexpr double max_eye_separation = 0.1;  // m
inline constexpr std::size_t max_walls = 32;

struct DisplayFile {
    std::string schema;                              // path of the JSON schema, for editors; may be empty
    std::string name;                                // for people; may be empty
    double eye_separation = default_eye_separation;  // m
    HeadTracking head;
    std::vector<Wall> walls;
    bool operator==(const DisplayFile&) const = default;
};

// A position in a text file, 1-based; a column counts characters.
struct FilePosition {
    int line = 0, column = 0;
};

// A display file without mistakes, or all mistakes of the file in its order, each with
// ErrorCode::bad_content, file, line, column and JSON pointer.
struct LoadedDisplays {
    DisplayFile displays;
    std::string file;                          // for messages
    std::vector<FilePosition> wall_positions;  // by wall of `displays`, for later messages about it
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is used in messages.
LoadedDisplays parse_displays(std::string_view text, const std::string& file);
LoadedDisplays load_displays(const std::filesystem::path& path);

// The text of a file, in the order of the structs. A valid value is read back to an equal value.
std::string displays_json(const DisplayFile& displays);

// Fails, and leaves the file unchanged, if parse_displays() would refuse the value.
Status save_displays(const std::filesystem::path& path, const DisplayFile& displays);

}  // namespace bolt::content
