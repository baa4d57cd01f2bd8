#include "engine/xr/pose_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "engine/xr/controller_profiles.hpp"
#include "engine/xr/openxr.hpp"
#include "engine/xr/vive_trackers.hpp"

namespace bolt::xr {

namespace {

constexpr const char* headless_extension = XR_MND_HEADLESS_EXTENSION_NAME;
constexpr const char* clock_extension = XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME;
constexpr XrSpaceLocationFlags fully_tracked =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

}  // namespace

// The order of the members is that of their dependencies.
struct PoseTracker::Objects {
    InstanceHandle instance;
    SessionHandle session;
    ActionSetHandle actions;
    SpaceHandle base, device;
    XrPath side = XR_NULL_PATH;       // of the controller
    XrAction press = XR_NULL_HANDLE;  // its button; null: it has none
    std::optional<TrackerRole> role;  // of the Vive tracker that is tracked
    PFN_xrEnumerateViveTrackerPathsHTCX enumerate_trackers = nullptr;
    std::string fault;
    bool stage = false, pressed = false;
    PFN_xrConvertTimespecTimeToTimeKHR to_time = nullptr;
    XrViewConfigurationType views = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    bool running = false, focused = false, ended = false;
    std::uint32_t origin_moves = 0;

    [[nodiscard]] XrReferenceSpaceType base_type() const {
        return stage ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
    }
    Status create_instance();
    Status create_session();
    Status create_base();
    Status create_device(TrackedDevice tracked);
    Status create_vive_tracker();
    Result<SpaceHandle> reference_space(XrReferenceSpaceType type) const;
    Result<XrAction> make_action(const char* name, const char* shown, XrActionType type);
    Status suggest_bindings(const std::string& hand, XrAction grip);
    Status create_actions();
    Result<SpaceHandle> attach(XrAction pose, XrPath path);
    Result<SpaceHandle> grip_space(const char* hand);
    Result<std::optional<ReportedPose>> locate() const;
    Status explain(const std::optional<ReportedPose>& pose);
    Status follow_events();
    Status sync_actions();
    Status read_button();
};

Status PoseTracker::Objects::create_instance() {
    quiet_loader();
    BOLT_TRY_ASSIGN(const auto offered, offered_extensions());
    for (const char* needed : {headless_extension, clock_extension}) {
        if (std::find(offered.begin(), offered.end(), needed) != offered.end()) continue;
        unload_runtime();
        return fail(
            ErrorCode::no_device,
            fmt::format("the OpenXR runtime cannot track without a headset's pictures: it lacks {}", needed),
            "a runtime with these extensions, such as Monado");
    }
    XrInstanceCreateInfo info = instance_info();
    std::vector<const char*> enabled{headless_extension, clock_extension};
    const char* const trackers = XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME;
    if (role && std::find(offered.begin(), offered.end(), trackers) == offered.end()) {
        unload_runtime();
        ViveTrackers none;
        none.has_data = true;
        return fail(*tracker_fault(none, *role));
    }
    if (role) enabled.push_back(trackers);
    info.enabledExtensionCount = static_cast<std::uint32_t>(enabled.size());
    info.enabledExtensionNames = enabled.data();
    XrInstance raw = XR_NULL_HANDLE;
    Status created = check(xrCreateInstance(&info, &raw), "xrCreateInstance");
    if (!created) {
        created.error().code = ErrorCode::no_device;
        return created;
    }
    instance = InstanceHandle(raw);
    PFN_xrVoidFunction function = nullptr;
    BOLT_TRY(check(xrGetInstanceProcAddr(raw, "xrConvertTimespecTimeToTimeKHR", &function),
                   "xrConvertTimespecTimeToTimeKHR"));
    to_time = reinterpret_cast<PFN_xrConvertTimespecTimeToTimeKHR>(function);
    if (!role) return {};
    BOLT_TRY(check(xrGetInstanceProcAddr(raw, "xrEnumerateViveTrackerPathsHTCX", &function),
                   "xrEnumerateViveTrackerPathsHTCX"));
    enumerate_trackers = reinterpret_cast<PFN_xrEnumerateViveTrackerPathsHTCX>(function);
    return {};
}

Status PoseTracker::Objects::create_session() {
    XrSystemGetInfo system{XR_TYPE_SYSTEM_GET_INFO};
    system.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    XrSystemId id = XR_NULL_SYSTEM_ID;
    BOLT_TRY(check(xrGetSystem(instance.get(), &system, &id), "xrGetSystem"));
    std::vector<XrViewConfigurationType> types;
    BOLT_TRY(
        check(enumerate(types, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
                        [&](std::uint32_t capacity, std::uint32_t* count, XrViewConfigurationType* values) {
                            return xrEnumerateViewConfigurations(instance.get(), id, capacity, count, values);
                        }),
              "xrEnumerateViewConfigurations"));
    if (!types.empty()) views = types.front();
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO};
    info.systemId = id;
    XrSession raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateSession(instance.get(), &info, &raw), "xrCreateSession"));
    session = SessionHandle(raw);
    return {};
}

Result<SpaceHandle> PoseTracker::Objects::reference_space(XrReferenceSpaceType type) const {
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
    info.referenceSpaceType = type;
    info.poseInReferenceSpace = {{0, 0, 0, 1}, {0, 0, 0}};
    XrSpace raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateReferenceSpace(session.get(), &info, &raw), "xrCreateReferenceSpace"));
    return SpaceHandle(raw);
}

Result<XrAction> PoseTracker::Objects::make_action(const char* name, const char* shown, XrActionType type) {
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    fmt::format_to_n(info.actionName, sizeof info.actionName - 1, "{}", name);
    fmt::format_to_n(info.localizedActionName, sizeof info.localizedActionName - 1, "{}", shown);
    info.actionType = type;
    info.countSubactionPaths = 1;
    info.subactionPaths = &side;
    XrAction action = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateAction(actions.get(), &info, &action), "xrCreateAction"));
    return action;
}

Status PoseTracker::Objects::suggest_bindings(const std::string& hand, XrAction grip) {
    BOLT_TRY_ASSIGN(const auto pose, path_of(instance.get(), hand + "/input/grip/pose"));
    for (const ControllerProfile& profile : controller_profiles()) {
        if (profile.needs_hand_interaction) continue;  // a hand is no tracker of the head
        BOLT_TRY_ASSIGN(const auto button, path_of(instance.get(), hand + "/" + profile.select));
        const std::array<XrActionSuggestedBinding, 2> bindings{{{grip, pose}, {press, button}}};
        BOLT_TRY(suggest_bindings_of(profile.path, bindings, instance.get()));
    }
    return {};
}

Status PoseTracker::Objects::create_actions() {
    XrActionSetCreateInfo set{XR_TYPE_ACTION_SET_CREATE_INFO};
    fmt::format_to_n(set.actionSetName, sizeof set.actionSetName - 1, "tracker");
    fmt::format_to_n(set.localizedActionSetName, sizeof set.localizedActionSetName - 1, "Tracker");
    XrActionSet raw_set = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateActionSet(instance.get(), &set, &raw_set), "xrCreateActionSet"));
    actions = ActionSetHandle(raw_set);
    return {};
}

// Attaches the actions, and makes the space of a pose.
Result<SpaceHandle> PoseTracker::Objects::attach(XrAction pose, XrPath path) {
    const XrActionSet raw_set = actions.get();
    XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
    attach.countActionSets = 1;
    attach.actionSets = &raw_set;
    BOLT_TRY(check(xrAttachSessionActionSets(session.get(), &attach), "xrAttachSessionActionSets"));
    XrActionSpaceCreateInfo create{XR_TYPE_ACTION_SPACE_CREATE_INFO};
    create.action = pose;
    create.subactionPath = path;
    create.poseInActionSpace = {{0, 0, 0, 1}, {0, 0, 0}};
    XrSpace raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateActionSpace(session.get(), &create, &raw), "xrCreateActionSpace"));
    return SpaceHandle(raw);
}

Result<SpaceHandle> PoseTracker::Objects::grip_space(const char* hand) {
    BOLT_TRY(create_actions());
    BOLT_TRY_ASSIGN(side, path_of(instance.get(), hand));
    BOLT_TRY_ASSIGN(const XrAction grip, make_action("pose", "Pose", XR_ACTION_TYPE_POSE_INPUT));
    BOLT_TRY_ASSIGN(press, make_action("press", "Press", XR_ACTION_TYPE_BOOLEAN_INPUT));
    BOLT_TRY(suggest_bindings(hand, grip));
    return attach(grip, side);
}

Status PoseTracker::Objects::create_base() {
    std::vector<XrReferenceSpaceType> types;
    BOLT_TRY(check(enumerate(types, XR_REFERENCE_SPACE_TYPE_VIEW,
                             [&](std::uint32_t capacity, std::uint32_t* count, XrReferenceSpaceType* values) {
                                 return xrEnumerateReferenceSpaces(session.get(), capacity, count, values);
                             }),
                   "xrEnumerateReferenceSpaces"));
    stage = std::find(types.begin(), types.end(), XR_REFERENCE_SPACE_TYPE_STAGE) != types.end();
    BOLT_TRY_ASSIGN(base, reference_space(base_type()));
    return {};
}

Status PoseTracker::Objects::create_device(TrackedDevice tracked) {
    if (tracked == TrackedDevice::headset) {
        BOLT_TRY_ASSIGN(device, reference_space(XR_REFERENCE_SPACE_TYPE_VIEW));
    } else {
        BOLT_TRY_ASSIGN(device, grip_space(hand_paths[tracked == TrackedDevice::left_controller ? 0 : 1]));
    }
    return {};
}

Status PoseTracker::Objects::create_vive_tracker() {
    BOLT_TRY(create_actions());
    BOLT_TRY_ASSIGN(const auto known, make_tracker_actions(instance.get(), actions.get()));
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const TrackerAction& one) { return one.role == *role; });
    if (found == known.end())
        return fail(
            ErrorCode::no_device,
            fmt::format("the OpenXR runtime does not know the role {} of a Vive tracker", name(*role)),
            "another role, such as handheld_object");
    BOLT_TRY_ASSIGN(device, attach(found->action, found->path));
    return {};
}

// Begins and ends the session when the runtime requests it. Calls no OpenXR function after a loss.
Status PoseTracker::Objects::follow_events() {
    while (!ended) {
        XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
        const XrResult result = xrPollEvent(instance.get(), &event);
        if (result == XR_EVENT_UNAVAILABLE) return {};
        BOLT_TRY(check(result, "xrPollEvent"));
        if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) ended = true;
        if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
            const auto* moved = reinterpret_cast<const XrEventDataReferenceSpaceChangePending*>(&event);
            origin_moves += moved->referenceSpaceType == base_type() ? 1U : 0U;
        }
        if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
        const auto* changed = reinterpret_cast<const XrEventDataSessionStateChanged*>(&event);
        focused = changed->state == XR_SESSION_STATE_FOCUSED;
        if (changed->state == XR_SESSION_STATE_READY) {
            XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO};
            info.primaryViewConfigurationType = views;
            BOLT_TRY(check(xrBeginSession(session.get(), &info), "xrBeginSession"));
            running = true;
        } else if (changed->state == XR_SESSION_STATE_STOPPING) {
            running = false;
            BOLT_TRY(check(xrEndSession(session.get()), "xrEndSession"));
        } else if (changed->state == XR_SESSION_STATE_LOSS_PENDING ||
                   changed->state == XR_SESSION_STATE_EXITING) {
            ended = true;
        }
    }
    return {};
}

// Updates the poses of controllers and Vive trackers.
Status PoseTracker::Objects::sync_actions() {
    if (!actions || !focused) return {};
    const XrActiveActionSet active{actions.get(), XR_NULL_PATH};
    XrActionsSyncInfo sync{XR_TYPE_ACTIONS_SYNC_INFO};
    sync.countActiveActionSets = 1;
    sync.activeActionSets = &active;
    return check(xrSyncActions(session.get(), &sync), "xrSyncActions");
}

Status PoseTracker::Objects::read_button() {
    pressed = false;
    if (press == XR_NULL_HANDLE || !focused) return {};
    XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
    info.action = press;
    info.subactionPath = side;
    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    BOLT_TRY(check(xrGetActionStateBoolean(session.get(), &info, &state), "xrGetActionStateBoolean"));
    pressed = state.isActive == XR_TRUE && state.currentState == XR_TRUE;
    return {};
}

// A pose that is not tracked is estimated. None: the pose is not valid.
Result<std::optional<ReportedPose>> PoseTracker::Objects::locate() const {
    timespec now{};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    XrTime time = 0;
    BOLT_TRY(check(to_time(instance.get(), &now, &time), "xrConvertTimespecTimeToTimeKHR"));
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    BOLT_TRY(check(xrLocateSpace(device.get(), base.get(), time, &location), "xrLocateSpace"));
    constexpr XrSpaceLocationFlags valid =
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    if ((location.locationFlags & valid) != valid) return std::optional<ReportedPose>();
    const Pose pose = to_pose(location.pose);
    if (!finite(pose.position) || !std::isfinite(pose.orientation.w)) return std::optional<ReportedPose>();
    return ReportedPose{pose, (location.locationFlags & fully_tracked) == fully_tracked};
}

// Sets `fault` if the Vive tracker has no tracked pose.
Status PoseTracker::Objects::explain(const std::optional<ReportedPose>& pose) {
    if (!role || (pose && pose->tracked)) return {};
    ViveTrackers trackers;
    trackers.has_data = trackers.available = true;
    trackers.poses[static_cast<std::size_t>(*role)] = pose;
    const Result<TrackerRoles> roles = connected_roles(instance.get(), enumerate_trackers);
    if (!roles && roles.error().lost) return fail(roles.error());
    if (roles) trackers.connected = *roles;  // the roles are for messages only
    if (const std::optional<Error> error = tracker_fault(trackers, *role)) fault = error->message();
    return {};
}

Result<std::unique_ptr<PoseTracker>> PoseTracker::open(TrackedDevice device) {
    auto objects = std::make_unique<Objects>();
    BOLT_TRY(objects->create_instance());
    BOLT_TRY(objects->create_session());
    BOLT_TRY(objects->create_base());
    BOLT_TRY(objects->create_device(device));
    return std::unique_ptr<PoseTracker>(new PoseTracker(std::move(objects)));
}

Result<std::unique_ptr<PoseTracker>> PoseTracker::open(TrackerRole role) {
    auto objects = std::make_unique<Objects>();
    objects->role = role;
    BOLT_TRY(objects->create_instance());
    BOLT_TRY(objects->create_session());
    BOLT_TRY(objects->create_base());
    BOLT_TRY(objects->create_vive_tracker());
    return std::unique_ptr<PoseTracker>(new PoseTracker(std::move(objects)));
}

PoseTracker::PoseTracker(std::unique_ptr<Objects> objects) : objects_(std::move(objects)) {}
PoseTracker::~PoseTracker() = default;

Result<std::optional<Pose>> PoseTracker::read() {
    BOLT_TRY(objects_->follow_events());
    if (objects_->ended) {
        Error error{ErrorCode::no_device, "the OpenXR runtime has ended", "a running OpenXR runtime"};
        error.lost = true;
        return fail(std::move(error));
    }
    objects_->pressed = false;
    objects_->fault.clear();
    if (!objects_->running) return std::optional<Pose>();
    BOLT_TRY(objects_->sync_actions());
    BOLT_TRY(objects_->read_button());
    BOLT_TRY_ASSIGN(const auto located, objects_->locate());
    BOLT_TRY(objects_->explain(located));
    if (!located || !located->tracked) return std::optional<Pose>();
    return std::optional(located->pose);
}

const std::string& PoseTracker::fault() const { return objects_->fault; }

bool PoseTracker::pressed() const { return objects_->pressed; }

bool PoseTracker::in_stage() const { return objects_->stage; }

std::uint32_t PoseTracker::origin_moves() const { return objects_->origin_moves; }

}  // namespace bolt::xr
