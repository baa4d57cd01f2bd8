// The states of actions, vibrations and tracked hands of the mock runtime.
#include <algorithm>
#include <limits>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

constexpr float undefined = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<std::string_view, 2> hand_paths{"/user/hand/left", "/user/hand/right"};

bool focused(const State& s) { return s.instance->session->state == XR_SESSION_STATE_FOCUSED; }

std::optional<std::size_t> side_of(const State& s, XrPath path) {
    if (path == XR_NULL_PATH || path > s.instance->paths.size()) return std::nullopt;
    for (std::size_t side = 0; side < 2; ++side)
        if (s.instance->paths[path - 1] == hand_paths[side]) return side;
    return std::nullopt;
}

// The path that the action is bound to on the controller in this hand; null: none.
const Binding* bound(const State& s, std::uint64_t action, std::size_t side, const Hand& hand) {
    if (!hand.active) return nullptr;
    for (const Binding& binding : s.instance->bindings)
        if (binding.action == action && binding.profile == hand.profile &&
            binding.path.rfind(hand_paths[side], 0) == 0)
            return &binding;
    return nullptr;
}

// True if the action is bound to an input of the Vive tracker with this path of a role.
bool bound_to_role(const State& s, std::uint64_t action, const std::string& role) {
    const std::vector<Binding>& bindings = s.instance->bindings;
    return std::any_of(bindings.begin(), bindings.end(), [&](const Binding& binding) {
        return binding.action == action && binding.path.rfind(role + "/", 0) == 0;
    });
}

// The value of an input with one dimension.
float value_at(const Hand& hand, const std::string& path) {
    const auto has = [&](std::string_view part) { return path.find(part) != std::string::npos; };
    if (has("/trigger") || has("/select") || has("/pinch_ext") || has("/aim_activate_ext"))
        return hand.trigger;
    if (has("/squeeze") || has("/grasp_ext")) return hand.squeeze;
    if (has("/menu") || has("/b/") || has("/y/")) return hand.menu ? 1.0F : 0.0F;
    if (has("/a/") || has("/x/") || has("/thumbstick/click") || has("/trackpad/click"))
        return hand.secondary ? 1.0F : 0.0F;
    if (has("stick/x") || has("trackpad/x")) return hand.stick.x;
    if (has("stick/y") || has("trackpad/y")) return hand.stick.y;
    return 0.0F;
}

bool is_click(const std::string& path) { return path.size() > 6 && path.substr(path.size() - 6) == "/click"; }

// The state of an action of one hand, now and at the last but one synchronisation.
struct ActionValue {
    bool active = false;
    float now = 0.0F, before = 0.0F;
    XrVector2f stick{0.0F, 0.0F}, stick_before{0.0F, 0.0F};
};

XrResult read(State& s, std::string_view name, const XrActionStateGetInfo& info, XrActionType type,
              ActionValue& out) {
    Session& session = *s.instance->session;
    const Action* action = find(s, name, s.instance->actions, info.action);
    if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (!session.attached || !s.instance->sets[action->set].attached)
        return refuse(s, name, XR_ERROR_ACTIONSET_NOT_ATTACHED, "is called before attaching the actions");
    if (action->type != type)
        return refuse(s, name, XR_ERROR_ACTION_TYPE_MISMATCH, "is given an action of another type");
    const std::optional<std::size_t> side = side_of(s, info.subactionPath);
    const bool has_path =
        std::find(action->sides.begin(), action->sides.end(), info.subactionPath) != action->sides.end();
    const std::string role = has_path && !side ? s.instance->paths[info.subactionPath - 1] : std::string();
    if (!has_path || (!side && role.rfind(role_folder, 0) != 0))
        return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED, "is given a subaction path that the action lacks");
    if (!side) {
        out.active = session.has_synced && focused(s) && bound_to_role(s, id_of(info.action), role) &&
                     tracker_with_role(session.synced_trackers, role) != nullptr;
        return XR_SUCCESS;
    }
    const Hand& hand = session.synced[*side];
    const Binding* binding = bound(s, id_of(info.action), *side, hand);
    out.active = session.has_synced && focused(s) && binding != nullptr;
    if (!out.active) return XR_SUCCESS;
    const Hand& before = session.synced_before[*side];
    out.now = value_at(hand, binding->path);
    out.before = value_at(before, binding->path);
    // A button has two values only.
    if (is_click(binding->path)) {
        out.now = out.now > 0.5F ? 1.0F : 0.0F;
        out.before = out.before > 0.5F ? 1.0F : 0.0F;
    }
    out.stick = hand.stick;
    out.stick_before = before.stick;
    return XR_SUCCESS;
}

XrResult XRAPI_CALL get_boolean(XrSession, const XrActionStateGetInfo* info, XrActionStateBoolean* out) {
    constexpr const char* name = "xrGetActionStateBoolean";
    return call(name, Level::session, [&](State& s, auto&) {
        ActionValue value;
        const XrResult result = read(s, name, *info, XR_ACTION_TYPE_BOOLEAN_INPUT, value);
        if (XR_FAILED(result)) return result;
        out->isActive = value.active ? XR_TRUE : XR_FALSE;
        out->currentState = value.now > 0.5F ? XR_TRUE : XR_FALSE;
        out->changedSinceLastSync = (value.now > 0.5F) != (value.before > 0.5F) ? XR_TRUE : XR_FALSE;
        out->lastChangeTime = value.active ? now(s) : 0;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL get_float(XrSession, const XrActionStateGetInfo* info, XrActionStateFloat* out) {
    constexpr const char* name = "xrGetActionStateFloat";
    return call(name, Level::session, [&](State& s, auto&) {
        ActionValue value;
        const XrResult result = read(s, name, *info, XR_ACTION_TYPE_FLOAT_INPUT, value);
        if (XR_FAILED(result)) return result;
        out->isActive = value.active ? XR_TRUE : XR_FALSE;
        out->currentState = value.now;
        out->changedSinceLastSync = value.now != value.before ? XR_TRUE : XR_FALSE;
        out->lastChangeTime = value.active ? now(s) : 0;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL get_vector(XrSession, const XrActionStateGetInfo* info, XrActionStateVector2f* out) {
    constexpr const char* name = "xrGetActionStateVector2f";
    return call(name, Level::session, [&](State& s, auto&) {
        ActionValue value;
        const XrResult result = read(s, name, *info, XR_ACTION_TYPE_VECTOR2F_INPUT, value);
        if (XR_FAILED(result)) return result;
        out->isActive = value.active ? XR_TRUE : XR_FALSE;
        out->currentState = value.stick;
        const bool changed = value.stick.x != value.stick_before.x || value.stick.y != value.stick_before.y;
        out->changedSinceLastSync = changed ? XR_TRUE : XR_FALSE;
        out->lastChangeTime = value.active ? now(s) : 0;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL get_pose(XrSession, const XrActionStateGetInfo* info, XrActionStatePose* out) {
    constexpr const char* name = "xrGetActionStatePose";
    return call(name, Level::session, [&](State& s, auto&) {
        ActionValue value;
        const XrResult result = read(s, name, *info, XR_ACTION_TYPE_POSE_INPUT, value);
        if (XR_FAILED(result)) return result;
        out->isActive = value.active ? XR_TRUE : XR_FALSE;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL sync(XrSession, const XrActionsSyncInfo* info) {
    constexpr const char* name = "xrSyncActions";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        for (std::uint32_t i = 0; i < info->countActiveActionSets; ++i) {
            const ActionSet* set = find(s, name, s.instance->sets, info->activeActionSets[i].actionSet);
            if (set == nullptr) return XR_ERROR_HANDLE_INVALID;
            if (!session.attached || !set->attached)
                return refuse(s, name, XR_ERROR_ACTIONSET_NOT_ATTACHED,
                              "is called before attaching the actions");
        }
        run_followed(s);
        session.synced_before = session.synced;
        session.synced = s.hands;
        session.synced_trackers = s.vive_trackers;
        session.has_synced = true;
        return focused(s) ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
    });
}

XrResult XRAPI_CALL current_profile(XrSession, XrPath hand, XrInteractionProfileState* out) {
    constexpr const char* name = "xrGetCurrentInteractionProfile";
    return call(name, Level::session, [&](State& s, auto&) {
        if (!s.instance->session->attached)
            return refuse(s, name, XR_ERROR_ACTIONSET_NOT_ATTACHED, "is called before attaching the actions");
        const std::optional<std::size_t> side = side_of(s, hand);
        if (!side) return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED, "is given a path of no hand");
        out->interactionProfile = XR_NULL_PATH;
        const std::string& profile = s.hands[*side].profile;
        const std::vector<Binding>& bindings = s.instance->bindings;
        const bool suggested = std::any_of(bindings.begin(), bindings.end(),
                                           [&](const Binding& b) { return b.profile == profile; });
        if (!s.hands[*side].active || !suggested) return XR_SUCCESS;
        std::vector<std::string>& paths = s.instance->paths;
        const auto at = std::find(paths.begin(), paths.end(), profile);
        out->interactionProfile = static_cast<XrPath>(at - paths.begin()) + 1;
        return XR_SUCCESS;
    });
}

// Records a vibration, or its end if `haptic` is null.
XrResult vibrate(State& s, std::string_view name, const XrHapticActionInfo& info,
                 const XrHapticVibration* haptic) {
    const Action* action = find(s, name, s.instance->actions, info.action);
    if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (action->type != XR_ACTION_TYPE_VIBRATION_OUTPUT)
        return refuse(s, name, XR_ERROR_ACTION_TYPE_MISMATCH, "is given an action of another type");
    if (!s.instance->session->attached)
        return refuse(s, name, XR_ERROR_ACTIONSET_NOT_ATTACHED, "is called before attaching the actions");
    const std::optional<std::size_t> side = side_of(s, info.subactionPath);
    if (!side) return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED, "is given a path of no hand");
    if (!focused(s)) return XR_SESSION_NOT_FOCUSED;
    Vibration vibration;
    vibration.time = now(s);
    vibration.side = static_cast<Side>(*side);
    vibration.stop = haptic == nullptr;
    if (haptic != nullptr) {
        if (haptic->type != XR_TYPE_HAPTIC_VIBRATION ||
            !(haptic->amplitude >= 0.0F && haptic->amplitude <= 1.0F))
            return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "is given an amplitude outside 0 to 1");
        if (haptic->duration <= 0 && haptic->duration != XR_MIN_HAPTIC_DURATION)
            return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "is given a duration that is not positive");
        vibration.amplitude = haptic->amplitude;
        vibration.frequency = haptic->frequency;
        vibration.duration = haptic->duration;
    }
    s.vibrations.push_back(vibration);
    return XR_SUCCESS;
}

XrResult XRAPI_CALL apply_haptic(XrSession, const XrHapticActionInfo* info,
                                 const XrHapticBaseHeader* haptic) {
    constexpr const char* name = "xrApplyHapticFeedback";
    return call(name, Level::session, [&](State& s, auto&) {
        return vibrate(s, name, *info, reinterpret_cast<const XrHapticVibration*>(haptic));
    });
}

XrResult XRAPI_CALL stop_haptic(XrSession, const XrHapticActionInfo* info) {
    constexpr const char* name = "xrStopHapticFeedback";
    return call(name, Level::session, [&](State& s, auto&) { return vibrate(s, name, *info, nullptr); });
}

XrResult XRAPI_CALL create_tracker(XrSession handle, const XrHandTrackerCreateInfoEXT* info,
                                   XrHandTrackerEXT* tracker) {
    constexpr const char* name = "xrCreateHandTrackerEXT";
    return call(name, Level::session, [&](State& s, auto&) {
        if (!s.instance->config.tracks_hands)
            return refuse(s, name, XR_ERROR_FEATURE_UNSUPPORTED, "is called although no hands are tracked");
        s.instance->trackers[++s.last_id] = {id_of(handle), info->hand == XR_HAND_LEFT_EXT ? 0U : 1U};
        *tracker = handle_of<XrHandTrackerEXT>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_tracker(XrHandTrackerEXT handle) {
    constexpr const char* name = "xrDestroyHandTrackerEXT";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    return remove(s, name, s.instance->trackers, handle, Kind::hand_tracker) ? success
                                                                             : XR_ERROR_HANDLE_INVALID;
}

XrResult XRAPI_CALL locate_joints(XrHandTrackerEXT handle, const XrHandJointsLocateInfoEXT* info,
                                  XrHandJointLocationsEXT* out) {
    constexpr const char* name = "xrLocateHandJointsEXT";
    return call(name, Level::session, [&](State& s, auto&) {
        const HandTracker* tracker = find(s, name, s.instance->trackers, handle);
        const Space* base = find(s, name, s.instance->spaces, info->baseSpace);
        if (tracker == nullptr || base == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (out->jointCount != joint_count)
            return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "is given another number of joints than 26");
        const Hand& hand = s.hands[tracker->side];
        out->isActive = hand.has_joints ? XR_TRUE : XR_FALSE;
        const Tracked from = locate(s, *base, info->time);
        for (std::size_t i = 0; i < joint_count; ++i) {
            const Joint& joint = hand.joints[i];
            const bool valid = hand.has_joints && joint.at.valid && from.valid;
            out->jointLocations[i] = {flags_of({{}, valid, joint.at.tracked}),
                                      to_xr(inverse(from.pose) * joint.at.pose), joint.radius};
            // An invalid joint holds nothing of use.
            if (!valid) out->jointLocations[i].pose = {{0, 0, 0, 0}, {undefined, undefined, undefined}};
        }
        return XR_SUCCESS;
    });
}

}  // namespace

Tracked locate_action(const State& s, const Space& space) {
    if (!space.role.empty()) {
        const ViveTracker* tracker = tracker_with_role(s.vive_trackers, space.role);
        Tracked at = tracker != nullptr ? tracker->at : Tracked{{}, false, false};
        at.valid = at.valid && bound_to_role(s, space.action, space.role) && focused(s);
        return at;
    }
    const Hand& hand = s.hands[space.side];
    const Binding* binding = bound(s, space.action, space.side, hand);
    Tracked at =
        binding != nullptr && binding->path.find("/aim/") != std::string::npos ? hand.aim : hand.grip;
    at.valid = at.valid && binding != nullptr && focused(s);
    return at;
}

void add_input_functions(FunctionTable& table) {
    add(table, "xrGetActionStateBoolean", &get_boolean);
    add(table, "xrGetActionStateFloat", &get_float);
    add(table, "xrGetActionStateVector2f", &get_vector);
    add(table, "xrGetActionStatePose", &get_pose);
    add(table, "xrSyncActions", &sync);
    add(table, "xrGetCurrentInteractionProfile", &current_profile);
    add(table, "xrApplyHapticFeedback", &apply_haptic);
    add(table, "xrStopHapticFeedback", &stop_haptic);
    add(table, "xrCreateHandTrackerEXT", &create_tracker);
    add(table, "xrDestroyHandTrackerEXT", &destroy_tracker);
    add(table, "xrLocateHandJointsEXT", &locate_joints);
}

}  // namespace bolt::mock
