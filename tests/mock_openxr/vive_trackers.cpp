// Vive trackers of the mock runtime (XR_HTCX_vive_tracker_interaction).
#include <fmt/format.h>

#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

XrPath path_of(State& s, const std::string& text) {
    std::vector<std::string>& paths = s.instance->paths;
    const auto found = std::find(paths.begin(), paths.end(), text);
    const auto path = static_cast<XrPath>(found - paths.begin()) + 1;
    if (found == paths.end()) paths.push_back(text);
    return path;
}

XrViveTrackerPathsHTCX paths_of(State& s, const ViveTracker& tracker) {
    XrViveTrackerPathsHTCX paths{XR_TYPE_VIVE_TRACKER_PATHS_HTCX};
    paths.persistentPath = path_of(s, "/devices/htc/vive_tracker" + tracker.serial);
    paths.rolePath = tracker.role.empty() ? XR_NULL_PATH : path_of(s, role_folder + tracker.role);
    return paths;
}

XrResult XRAPI_CALL enumerate_paths(XrInstance, std::uint32_t capacity, std::uint32_t* count,
                                    XrViveTrackerPathsHTCX* paths) {
    constexpr const char* name = "xrEnumerateViveTrackerPathsHTCX";
    return call(name, Level::instance, [&](State& s, auto&) {
        std::vector<ViveTracker> connected;
        for (const ViveTracker& tracker : s.vive_trackers)
            if (tracker.connected) connected.push_back(tracker);
        for (std::uint32_t i = 0; i < capacity; ++i)
            if (paths[i].type != XR_TYPE_VIVE_TRACKER_PATHS_HTCX)
                return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "is given elements without their type");
        return list(s, name, connected, capacity, count,
                    [&](std::size_t i, const ViveTracker& tracker) { paths[i] = paths_of(s, tracker); });
    });
}

}  // namespace

const ViveTracker* tracker_with_role(const std::vector<ViveTracker>& trackers, const std::string& path) {
    const auto found = std::find_if(trackers.begin(), trackers.end(), [&](const ViveTracker& tracker) {
        return tracker.connected && !tracker.role.empty() && path == role_folder + tracker.role;
    });
    return found == trackers.end() ? nullptr : &*found;
}

// The event's structure has a pointer to the paths, which stay until the instance ends.
void set_vive_tracker(State& s, const ViveTracker& tracker) {
    const auto found = std::find_if(s.vive_trackers.begin(), s.vive_trackers.end(),
                                    [&](const ViveTracker& other) { return other.serial == tracker.serial; });
    const bool is_new = found == s.vive_trackers.end();
    const ViveTracker before = is_new ? ViveTracker{tracker.serial, {}, false, {}} : *found;
    if (is_new)
        s.vive_trackers.push_back(tracker);
    else
        *found = tracker;
    const bool changed = tracker.connected && (!before.connected || before.role != tracker.role);
    const bool enabled = s.instance && s.instance->extensions.count(vive_tracker_extension) != 0;
    if (!changed || !enabled) return;
    XrEventDataViveTrackerConnectedHTCX event{XR_TYPE_EVENT_DATA_VIVE_TRACKER_CONNECTED_HTCX};
    event.paths = &s.instance->sent_paths.emplace_back(paths_of(s, tracker));
    queue_event(s, &event, sizeof event);
}

void add_tracker_functions(FunctionTable& table) {
    add(table, "xrEnumerateViveTrackerPathsHTCX", &enumerate_paths);
}

}  // namespace bolt::mock
