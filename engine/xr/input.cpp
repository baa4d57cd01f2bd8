#include "engine/xr/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/xr/controller_profiles.hpp"

namespace bolt::xr {

namespace {

constexpr XrSpaceLocationFlags pose_valid =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
constexpr XrSpaceLocationFlags pose_tracked =
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

template <std::size_t size>
void set_text(char (&target)[size], const std::string& text) {
    std::size_t length = std::min(text.size(), size - 1);
    // A character of UTF-8 is not cut in two.
    while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U)
        --length;
    std::memcpy(target, text.data(), length);
    target[length] = '\0';
}

}  // namespace

Result<std::unique_ptr<XrInput>> XrInput::create(Session& session, const ActionNames& names) {
    std::unique_ptr<XrInput> input(new XrInput());
    input->session_ = &session;
    BOLT_TRY(input->create_actions(names));
    BOLT_TRY(input->suggest_bindings());
    BOLT_TRY(input->attach());
    return input;
}

XrInput::~XrInput() {
    const PFN_xrDestroyHandTrackerEXT destroy = session_->runtime().functions().destroy_hand_tracker;
    for (const XrHandTrackerEXT tracker : hand_trackers_)
        if (tracker != XR_NULL_HANDLE) (void)destroy(tracker);
}

Status XrInput::create_actions(const ActionNames& names) {
    const XrInstance instance = session_->runtime().instance();
    for (std::size_t side = 0; side < 2; ++side) {
        BOLT_TRY_ASSIGN(hands_[side], path_of(instance, hand_paths[side]));
    }
    XrActionSetCreateInfo set{XR_TYPE_ACTION_SET_CREATE_INFO};
    set_text(set.actionSetName, "assembly");
    set_text(set.localizedActionSetName, names.set);
    XrActionSet raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateActionSet(instance, &set, &raw), "xrCreateActionSet"));
    set_ = ActionSetHandle(raw);
    const auto make = [&](XrAction& action, const char* name, const std::string& shown, XrActionType type) {
        XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
        set_text(info.actionName, name);
        set_text(info.localizedActionName, shown);
        info.actionType = type;
        info.countSubactionPaths = static_cast<std::uint32_t>(hands_.size());
        info.subactionPaths = hands_.data();
        return check(xrCreateAction(set_.get(), &info, &action), "xrCreateAction");
    };
    BOLT_TRY(make(grip_, "grip", names.grip, XR_ACTION_TYPE_POSE_INPUT));
    BOLT_TRY(make(aim_, "aim", names.aim, XR_ACTION_TYPE_POSE_INPUT));
    BOLT_TRY(make(select_, "select", names.select, XR_ACTION_TYPE_FLOAT_INPUT));
    BOLT_TRY(make(grasp_, "grasp", names.grasp, XR_ACTION_TYPE_FLOAT_INPUT));
    BOLT_TRY(make(stick_, "stick", names.stick, XR_ACTION_TYPE_VECTOR2F_INPUT));
    BOLT_TRY(make(menu_, "menu", names.menu, XR_ACTION_TYPE_BOOLEAN_INPUT));
    BOLT_TRY(make(secondary_, "secondary", names.secondary, XR_ACTION_TYPE_BOOLEAN_INPUT));
    BOLT_TRY(make(vibrate_, "vibrate", names.vibrate, XR_ACTION_TYPE_VIBRATION_OUTPUT));
    if (!session_->runtime().extensions().vive_trackers) return {};
    BOLT_TRY_ASSIGN(vive_actions_, make_tracker_actions(instance, raw));
    return {};
}

Status XrInput::suggest_bindings() {
    const XrInstance instance = session_->runtime().instance();
    for (const ControllerProfile& profile : controller_profiles()) {
        if (profile.needs_hand_interaction && !session_->runtime().extensions().hand_interaction) continue;
        std::vector<XrActionSuggestedBinding> bindings;
        for (std::size_t side = 0; side < 2; ++side) {
            const auto bind = [&](XrAction action, const char* input) -> Status {
                if (input == nullptr) return {};
                BOLT_TRY_ASSIGN(const auto path,
                                path_of(instance, fmt::format("{}/{}", hand_paths[side], input)));
                bindings.push_back({action, path});
                return {};
            };
            BOLT_TRY(bind(grip_, "input/grip/pose"));
            BOLT_TRY(bind(aim_, "input/aim/pose"));
            BOLT_TRY(bind(select_, profile.select));
            BOLT_TRY(bind(grasp_, profile.grasp));
            BOLT_TRY(bind(stick_, profile.stick));
            BOLT_TRY(bind(menu_, profile.menu[side]));
            BOLT_TRY(bind(secondary_, profile.secondary[side]));
            BOLT_TRY(bind(vibrate_, profile.vibrates ? "output/haptic" : nullptr));
        }
        BOLT_TRY_ASSIGN(const bool accepted, suggest_bindings_of(profile.path, bindings, instance));
        if (accepted) profiles_.emplace_back(profile.path);
    }
    return {};
}

Status XrInput::attach() {
    const XrActionSet raw = set_.get();
    XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
    info.countActionSets = 1;
    info.actionSets = &raw;
    BOLT_TRY(check(xrAttachSessionActionSets(session_->get(), &info), "xrAttachSessionActionSets"));
    const ExtensionFunctions& functions = session_->runtime().functions();
    const auto make_space = [&](XrAction action, XrPath path, SpaceHandle& space) -> Status {
        XrActionSpaceCreateInfo create{XR_TYPE_ACTION_SPACE_CREATE_INFO};
        create.action = action;
        create.subactionPath = path;
        create.poseInActionSpace = {{0, 0, 0, 1}, {0, 0, 0}};
        XrSpace created = XR_NULL_HANDLE;
        BOLT_TRY(check(xrCreateActionSpace(session_->get(), &create, &created), "xrCreateActionSpace"));
        space = SpaceHandle(created);
        return {};
    };
    for (const TrackerAction& tracker : vive_actions_)
        BOLT_TRY(make_space(tracker.action, tracker.path, vive_spaces_.emplace_back()));
    for (std::size_t side = 0; side < 2; ++side) {
        BOLT_TRY(make_space(grip_, hands_[side], grip_spaces_[side]));
        BOLT_TRY(make_space(aim_, hands_[side], aim_spaces_[side]));
        if (functions.create_hand_tracker == nullptr) continue;
        XrHandTrackerCreateInfoEXT tracker{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT};
        tracker.hand = side == 0 ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
        tracker.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
        const XrResult tracked =
            functions.create_hand_tracker(session_->get(), &tracker, &hand_trackers_[side]);
        if (XR_SUCCEEDED(tracked)) continue;
        hand_trackers_[side] = XR_NULL_HANDLE;  // the controllers remain
        if (const Status status = check(tracked, "xrCreateHandTrackerEXT"); status.error().lost)
            return status;
    }
    return {};
}

Result<std::optional<ReportedPose>> XrInput::locate(XrSpace space, XrTime time) const {
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    BOLT_TRY(check(xrLocateSpace(space, session_->space(), time, &location), "xrLocateSpace"));
    if ((location.locationFlags & pose_valid) != pose_valid) return std::nullopt;
    return ReportedPose{to_pose(location.pose), (location.locationFlags & pose_tracked) == pose_tracked};
}

Result<float> XrInput::value(XrAction action, Side side) const {
    XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
    info.action = action;
    info.subactionPath = hands_[static_cast<std::size_t>(side)];
    XrActionStateFloat state{XR_TYPE_ACTION_STATE_FLOAT};
    BOLT_TRY(check(xrGetActionStateFloat(session_->get(), &info, &state), "xrGetActionStateFloat"));
    return state.isActive == XR_TRUE ? state.currentState : 0.0F;
}

Result<bool> XrInput::pressed(XrAction action, Side side) const {
    XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
    info.action = action;
    info.subactionPath = hands_[static_cast<std::size_t>(side)];
    XrActionStateBoolean state{XR_TYPE_ACTION_STATE_BOOLEAN};
    BOLT_TRY(check(xrGetActionStateBoolean(session_->get(), &info, &state), "xrGetActionStateBoolean"));
    return state.isActive == XR_TRUE && state.currentState == XR_TRUE;
}

Status XrInput::read_joints(const FrameTiming& frame, Side side, HandInput& hand) {
    const XrHandTrackerEXT tracker = hand_trackers_[static_cast<std::size_t>(side)];
    if (tracker == XR_NULL_HANDLE) return {};
    std::array<XrHandJointLocationEXT, hand_joint_count> located{};
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT};
    locations.jointCount = static_cast<std::uint32_t>(located.size());
    locations.jointLocations = located.data();
    XrHandJointsLocateInfoEXT info{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT};
    info.baseSpace = session_->space();
    info.time = frame.display_time;
    BOLT_TRY(check(session_->runtime().functions().locate_hand_joints(tracker, &info, &locations),
                   "xrLocateHandJointsEXT"));
    if (locations.isActive != XR_TRUE) return {};
    HandJoints joints;
    bool any = false;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        // Runtimes report active hands with single joints that are invalid.
        joints[i].valid = (located[i].locationFlags & pose_valid) == pose_valid;
        if (!joints[i].valid) continue;
        joints[i].pose = to_pose(located[i].pose);
        joints[i].radius = static_cast<double>(located[i].radius);
        any = true;
    }
    if (any) hand.joints = joints;
    return {};
}

Status XrInput::read_hand(const FrameTiming& frame, Side side, HandInput& hand) {
    const auto index = static_cast<std::size_t>(side);
    XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
    info.action = grip_;
    info.subactionPath = hands_[index];
    XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
    BOLT_TRY(check(xrGetActionStatePose(session_->get(), &info, &state), "xrGetActionStatePose"));
    BOLT_TRY(read_joints(frame, side, hand));
    hand.active = state.isActive == XR_TRUE || hand.joints.has_value();
    if (state.isActive != XR_TRUE) return {};
    BOLT_TRY_ASSIGN(hand.grip, locate(grip_spaces_[index].get(), frame.display_time));
    BOLT_TRY_ASSIGN(hand.aim, locate(aim_spaces_[index].get(), frame.display_time));
    BOLT_TRY_ASSIGN(hand.select, value(select_, side));
    BOLT_TRY_ASSIGN(hand.grasp, value(grasp_, side));
    BOLT_TRY_ASSIGN(hand.menu, pressed(menu_, side));
    BOLT_TRY_ASSIGN(hand.secondary, pressed(secondary_, side));
    info.action = stick_;
    XrActionStateVector2f stick{XR_TYPE_ACTION_STATE_VECTOR2F};
    BOLT_TRY(check(xrGetActionStateVector2f(session_->get(), &info, &stick), "xrGetActionStateVector2f"));
    if (stick.isActive == XR_TRUE) hand.stick = {stick.currentState.x, stick.currentState.y};
    return {};
}

// Queries which controllers are in the hands.
Status XrInput::read_controllers() {
    for (const Side side : {Side::left, Side::right}) {
        BOLT_TRY_ASSIGN(const std::string path, profile(side));
        const auto known = controller_profiles();
        const auto found = std::find_if(known.begin(), known.end(), [&](const ControllerProfile& controller) {
            return controller.path == path;
        });
        controllers_[static_cast<std::size_t>(side)] = found != known.end() ? &*found : nullptr;
    }
    return {};
}

Status XrInput::read_vive_trackers(const FrameTiming& frame, ViveTrackers& trackers) {
    const Runtime& runtime = session_->runtime();
    trackers.has_data = true;
    trackers.available = runtime.extensions().vive_trackers;
    if (!trackers.available) return {};
    // The event of a change may be lost.
    constexpr std::uint32_t enumeration_interval = 90;  // frames
    if (roles_outdated_ || reads_ % enumeration_interval == 0) {
        Result<TrackerRoles> roles =
            connected_roles(runtime.instance(), runtime.functions().enumerate_vive_trackers);
        if (!roles && roles.error().lost) return fail(roles.error());
        if (roles) connected_roles_ = *roles;  // the roles are for messages only
        roles_outdated_ = false;
    }
    trackers.connected = connected_roles_;
    for (std::size_t i = 0; i < vive_actions_.size(); ++i) {
        XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
        info.action = vive_actions_[i].action;
        info.subactionPath = vive_actions_[i].path;
        XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
        BOLT_TRY(check(xrGetActionStatePose(session_->get(), &info, &state), "xrGetActionStatePose"));
        if (state.isActive != XR_TRUE) continue;
        BOLT_TRY_ASSIGN(trackers.poses[static_cast<std::size_t>(vive_actions_[i].role)],
                        locate(vive_spaces_[i].get(), frame.display_time));
    }
    return {};
}

Result<Hands> XrInput::read(const FrameTiming& frame) {
    Hands hands;
    const XrActiveActionSet active{set_.get(), XR_NULL_PATH};
    XrActionsSyncInfo sync{XR_TYPE_ACTIONS_SYNC_INFO};
    sync.countActiveActionSets = 1;
    sync.activeActionSets = &active;
    const XrResult synced = xrSyncActions(session_->get(), &sync);
    BOLT_TRY(check(synced, "xrSyncActions"));
    if (synced == XR_SESSION_NOT_FOCUSED) return hands;
    BOLT_TRY(read_vive_trackers(frame, hands.trackers));
    // The event of a change may be lost, so the controllers are queried now and then.
    constexpr std::uint32_t query_interval = 32;  // frames
    if (reads_++ % query_interval == 0) BOLT_TRY(read_controllers());
    for (const Side side : {Side::left, Side::right}) {
        BOLT_TRY(read_hand(frame, side, hands[side]));
        hands[side].controller = controllers_[static_cast<std::size_t>(side)];
    }
    return hands;
}

Status XrInput::vibrate(Side side, const Vibration& vibration) {
    XrHapticActionInfo info{XR_TYPE_HAPTIC_ACTION_INFO};
    info.action = vibrate_;
    info.subactionPath = hands_[static_cast<std::size_t>(side)];
    if (!(vibration.amplitude > 0.0F))
        return check(xrStopHapticFeedback(session_->get(), &info), "xrStopHapticFeedback");
    XrHapticVibration haptic{XR_TYPE_HAPTIC_VIBRATION};
    haptic.amplitude = std::min(vibration.amplitude, 1.0F);
    haptic.frequency = vibration.frequency > 0.0F ? vibration.frequency : XR_FREQUENCY_UNSPECIFIED;
    haptic.duration =
        vibration.duration > 0.0 ? static_cast<XrDuration>(1e9 * vibration.duration) : XR_MIN_HAPTIC_DURATION;
    return check(
        xrApplyHapticFeedback(session_->get(), &info, reinterpret_cast<const XrHapticBaseHeader*>(&haptic)),
        "xrApplyHapticFeedback");
}

Result<std::string> XrInput::profile(Side side) const {
    XrInteractionProfileState state{XR_TYPE_INTERACTION_PROFILE_STATE};
    BOLT_TRY(
        check(xrGetCurrentInteractionProfile(session_->get(), hands_[static_cast<std::size_t>(side)], &state),
              "xrGetCurrentInteractionProfile"));
    if (state.interactionProfile == XR_NULL_PATH) return std::string();
    return text_of(session_->runtime().instance(), state.interactionProfile);
}

}  // namespace bolt::xr
