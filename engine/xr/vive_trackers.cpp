#include "engine/xr/vive_trackers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "engine/xr/controller_profiles.hpp"

namespace bolt::xr {

namespace {

constexpr const char* tracker_profile = "/interaction_profiles/htc/vive_tracker_htcx";
constexpr std::string_view role_folder = "/user/vive_tracker_htcx/role/";

std::string path_of_role(TrackerRole role) { return fmt::format("{}{}", role_folder, name(role)); }

std::string names_of(const TrackerRoles& roles) {
    std::string names;
    for (std::size_t i = 0; i < tracker_role_count; ++i)
        if (roles[i]) names += fmt::format("{}{}", names.empty() ? "" : ", ", tracker_role_names[i]);
    return names;
}

// Returns false if the runtime does not know a role or the profile: one bad path rejects all of them.
Result<bool> suggest_tracker_bindings(XrInstance instance, std::span<const TrackerAction> actions) {
    std::vector<XrActionSuggestedBinding> bindings;
    for (const TrackerAction& one : actions) {
        BOLT_TRY_ASSIGN(const XrPath pose, path_of(instance, path_of_role(one.role) + "/input/grip/pose"));
        bindings.push_back({one.action, pose});
    }
    Result<bool> suggested = suggest_bindings_of(tracker_profile, bindings, instance);
    // Any other refusal disables the trackers only; the session continues.
    if (!suggested && !suggested.error().lost) return false;
    return suggested;
}

// Returns nullopt if the runtime does not support the role.
Result<std::optional<TrackerAction>> make_action(XrInstance instance, XrActionSet set, TrackerRole role) {
    TrackerAction made{role};
    BOLT_TRY_ASSIGN(made.path, path_of(instance, path_of_role(role)));
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    fmt::format_to_n(info.actionName, sizeof info.actionName - 1, "tracker_{}", name(role));
    fmt::format_to_n(info.localizedActionName, sizeof info.localizedActionName - 1, "Vive tracker {}",
                     name(role));
    info.actionType = XR_ACTION_TYPE_POSE_INPUT;
    info.countSubactionPaths = 1;
    info.subactionPaths = &made.path;
    const Status created = check(xrCreateAction(set, &info, &made.action), "xrCreateAction");
    if (created) return std::optional(made);
    if (created.error().lost) return fail(created.error());
    return std::optional<TrackerAction>();
}

}  // namespace

std::optional<Error> tracker_fault(const ViveTrackers& trackers, TrackerRole role) {
    Error error;
    error.code = ErrorCode::no_device;
    const std::optional<ReportedPose>& pose = trackers[role];
    if (!trackers.has_data || (pose && pose->tracked)) return std::nullopt;
    if (!trackers.available) {
        error.what =
            "the OpenXR runtime finds no Vive trackers: it lacks "
            "XR_HTCX_vive_tracker_interaction";
        error.expected = "a runtime with this extension, such as SteamVR";
    } else if (pose || trackers.connected[static_cast<std::size_t>(role)]) {
        error.what = fmt::format("the Vive tracker {} is not tracked", name(role));
        error.expected = "one that is switched on and in view of its base stations";
    } else {
        const std::string others = names_of(trackers.connected);
        error.what = fmt::format("no Vive tracker that is switched on has the role {}{}", name(role),
                                 others.empty() ? "" : fmt::format("; there are {}", others));
        error.expected = "a tracker with this role in the settings of the runtime";
    }
    return error;
}

Result<std::vector<TrackerAction>> make_tracker_actions(XrInstance instance, XrActionSet set) {
    std::vector<TrackerAction> actions;
    for (std::size_t i = 0; i < tracker_role_count; ++i) {
        BOLT_TRY_ASSIGN(const auto made, make_action(instance, set, static_cast<TrackerRole>(i)));
        if (made) actions.push_back(*made);
    }
    BOLT_TRY_ASSIGN(const bool all, suggest_tracker_bindings(instance, actions));
    if (all) return actions;
    std::vector<TrackerAction> accepted;
    for (const TrackerAction& one : actions) {
        BOLT_TRY_ASSIGN(const bool known, suggest_tracker_bindings(instance, {&one, 1}));
        if (known) accepted.push_back(one);
    }
    // Each call replaces the previous suggestion, so all accepted roles are suggested together once more.
    if (!accepted.empty()) BOLT_TRY(suggest_tracker_bindings(instance, accepted));
    return accepted;
}

Result<TrackerRoles> connected_roles(XrInstance instance,
                                     PFN_xrEnumerateViveTrackerPathsHTCX enumerate_paths) {
    std::vector<XrViveTrackerPathsHTCX> paths;
    BOLT_TRY(
        check(enumerate(paths, XrViveTrackerPathsHTCX{XR_TYPE_VIVE_TRACKER_PATHS_HTCX},
                        [&](std::uint32_t capacity, std::uint32_t* count, XrViveTrackerPathsHTCX* values) {
                            return enumerate_paths(instance, capacity, count, values);
                        }),
              "xrEnumerateViveTrackerPathsHTCX"));
    TrackerRoles roles;
    for (const XrViveTrackerPathsHTCX& tracker : paths) {
        if (tracker.rolePath == XR_NULL_PATH) continue;
        BOLT_TRY_ASSIGN(const std::string path, text_of(instance, tracker.rolePath));
        if (!path.starts_with(role_folder)) continue;
        if (const auto role = parse_tracker_role(std::string_view(path).substr(role_folder.size())))
            roles.set(static_cast<std::size_t>(*role));
    }
    return roles;
}

}  // namespace bolt::xr
