// Vive trackers, found by the role that the user has given them (XR_HTCX_vive_tracker_interaction). One
// tracks the wrist of a gloved hand in a lesson (input.hpp), or measures points in a registration
// (pose_tracker.hpp).
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/tracker_role.hpp"
#include "engine/xr/openxr.hpp"

namespace bolt::xr {

// The pose of a controller or tracker as the runtime reports it.
struct ReportedPose {
    Pose pose;             // in the session's base space
    bool tracked = false;  // false: estimated, for example because the device is hidden from the cameras
};

using TrackerRoles = std::bitset<tracker_role_count>;

// The trackers in one frame, by TrackerRole.
struct ViveTrackers {
    bool has_data = false;   // false: the session has no focus, so there is no data in this frame
    bool available = false;  // the runtime has the extension
    TrackerRoles connected;  // roles of connected trackers
    // None: no tracker has this role, it is switched off, or its pose is not known.
    std::array<std::optional<ReportedPose>, tracker_role_count> poses;

    [[nodiscard]] const std::optional<ReportedPose>& operator[](TrackerRole role) const {
        return poses[static_cast<std::size_t>(role)];
    }
};

// Returns an error if the pose of this tracker is missing or estimated; nullopt if it is tracked, or if
// `trackers` has no data.
std::optional<Error> tracker_fault(const ViveTrackers& trackers, TrackerRole role);

// The pose action for one role, with the role's path.
struct TrackerAction {
    TrackerRole role = TrackerRole::handheld_object;
    XrAction action = XR_NULL_HANDLE;  // owned by its set
    XrPath path = XR_NULL_PATH;
};

// Creates an action for each role that the runtime accepts, and suggests their bindings. Runtimes differ in
// the roles that they support. Call it before the set is attached, with an instance that enabled the
// extension.
Result<std::vector<TrackerAction>> make_tracker_actions(XrInstance instance, XrActionSet set);

// The roles of the trackers that are connected. A tracker may have no role.
Result<TrackerRoles> connected_roles(XrInstance instance,
                                     PFN_xrEnumerateViveTrackerPathsHTCX enumerate_paths);

}  // namespace bolt::xr
