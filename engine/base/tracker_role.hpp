// The roles of Vive trackers. A user gives a role to each tracker in the settings of the OpenXR runtime, such
// as SteamVR's "Manage Vive Trackers"; a program finds a tracker by its role. The roles are those of
// XR_HTCX_vive_tracker_interaction; its revision 3 added wrists and ankles.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace bolt {

enum class TrackerRole : std::uint8_t {
    handheld_object,
    left_foot,
    right_foot,
    left_shoulder,
    right_shoulder,
    left_elbow,
    right_elbow,
    left_knee,
    right_knee,
    waist,
    chest,
    camera,
    keyboard,
    left_wrist,
    right_wrist,
    left_ankle,
    right_ankle,
};
inline constexpr std::size_t tracker_role_count = 17;

// In the order of the enumerators; the last parts of the roles' OpenXR paths.
inline constexpr std::array<std::string_view, tracker_role_count> tracker_role_names{
    "handheld_object", "left_foot",  "right_foot",  "left_shoulder", "right_shoulder", "left_elbow",
    "right_elbow",     "left_knee",  "right_knee",  "waist",         "chest",          "camera",
    "keyboard",        "left_wrist", "right_wrist", "left_ankle",    "right_ankle"};

constexpr std::string_view name(TrackerRole role) {
    return tracker_role_names[static_cast<std::size_t>(role)];
}

// None: no role has this name.
constexpr std::optional<TrackerRole> parse_tracker_role(std::string_view text) {
    const auto* const found = std::find(tracker_role_names.begin(), tracker_role_names.end(), text);
    if (found == tracker_role_names.end()) return std::nullopt;
    return static_cast<TrackerRole>(found - tracker_role_names.begin());
}

}  // namespace bolt
