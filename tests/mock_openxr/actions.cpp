// The mock's controllers and tracked hands.
#include <algorithm>
#include <cstring>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock_openxr {

namespace {

// The inputs that each controller has below the path of a hand. A menu or system button of one hand only is
// listed with that hand.
const std::map<std::string, std::set<std::string>>& known_profiles() {
    static const std::map<std::string, std::set<std::string>> all{
        {"/interaction_profiles/khr/simple_controller",
         {"input/select/click", "input/menu/click", "input/grip/pose", "input/aim/pose", "output/haptic"}},
        {"/interaction_profiles/oculus/touch_controller",
         {"input/trigger/value", "input/squeeze/value", "input/thumbstick", "left/input/menu/click",
          "left/input/x/click", "left/input/y/click", "right/input/a/click", "right/input/b/click",
          "input/grip/pose", "input/aim/pose", "output/haptic"}},
        {"/interaction_profiles/valve/index_controller",
         {"input/trigger/value", "input/squeeze/value", "input/thumbstick", "input/a/click", "input/b/click",
          "input/grip/pose", "input/aim/pose", "output/haptic"}},
        {"/interaction_profiles/htc/vive_controller",
         {"input/trigger/value", "input/squeeze/click", "input/trackpad", "input/trackpad/click",
          "input/menu/click", "input/grip/pose", "input/aim/pose", "output/haptic"}},
        {"/interaction_profiles/ext/hand_interaction_ext",
         {"input/pinch_ext/value", "input/grasp_ext/value", "input/aim_activate_ext/value", "input/grip/pose",
          "input/aim/pose"}},
    };
    return all;
}

XrResult create_set(XrInstance, const XrActionSetCreateInfo* info, XrActionSet* set) {
    MOCK_ENTER("xrCreateActionSet");
    if (std::strlen(info->actionSetName) == 0 || std::strlen(info->localizedActionSetName) == 0)
        return XR_ERROR_NAME_INVALID;
    ++s.action_sets;
    *set = reinterpret_cast<XrActionSet>(&s.action_sets);
    return XR_SUCCESS;
}

XrResult destroy_set(XrActionSet) {
    MOCK_ENTER("xrDestroyActionSet");
    if (s.action_sets == 0) s.violation("xrDestroyActionSet of an unknown set");
    --s.action_sets;
    s.actions.clear();
    return XR_SUCCESS;
}

XrResult create_action(XrActionSet, const XrActionCreateInfo* info, XrAction* action) {
    MOCK_ENTER("xrCreateAction");
    if (s.attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
    const std::string name = info->actionName;
    const bool valid = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    });
    if (!valid || name.empty()) return XR_ERROR_PATH_FORMAT_INVALID;
    for (const auto& other : s.actions)
        if (other->name == name) return XR_ERROR_NAME_DUPLICATED;
    auto made = std::make_unique<Action>();
    made->name = name;
    made->type = info->actionType;
    *action = reinterpret_cast<XrAction>(made.get());
    s.actions.insert(std::move(made));
    return XR_SUCCESS;
}

XrResult suggest(XrInstance, const XrInteractionProfileSuggestedBinding* suggested) {
    MOCK_ENTER("xrSuggestInteractionProfileBindings");
    if (s.attached) {
        s.violation("bindings are suggested after the actions were attached");
        return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
    }
    const std::string profile = s.paths.at(suggested->interactionProfile);
    const auto known = known_profiles().find(profile);
    if (known == known_profiles().end()) return XR_ERROR_PATH_UNSUPPORTED;
    if (profile.find("_ext") != std::string::npos && s.enabled.count("XR_EXT_hand_interaction") == 0)
        return XR_ERROR_PATH_UNSUPPORTED;
    for (std::uint32_t i = 0; i < suggested->countSuggestedBindings; ++i) {
        const XrActionSuggestedBinding& binding = suggested->suggestedBindings[i];
        const std::string path = s.paths.at(binding.binding);
        const std::string prefix = "/user/hand/";
        if (path.compare(0, prefix.size(), prefix) != 0) return XR_ERROR_PATH_UNSUPPORTED;
        const std::string with_hand = path.substr(prefix.size());
        const std::string input = with_hand.substr(with_hand.find('/') + 1);
        if (known->second.count(input) == 0 && known->second.count(with_hand) == 0)
            return XR_ERROR_PATH_UNSUPPORTED;
        Action* action = find(s.actions, binding.action);
        if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (profile == s.config.profile) action->inputs.insert(with_hand);
    }
    return XR_SUCCESS;
}

XrResult attach(XrSession, const XrSessionActionSetsAttachInfo*) {
    MOCK_ENTER("xrAttachSessionActionSets");
    if (s.attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
    s.attached = true;
    return XR_SUCCESS;
}

XrResult sync(XrSession, const XrActionsSyncInfo*) {
    MOCK_ENTER("xrSyncActions");
    if (!s.attached) {
        s.violation("xrSyncActions before the actions were attached");
        return XR_ERROR_ACTIONSET_NOT_ATTACHED;
    }
    return s.state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

int side_of(const State& s, XrPath path) { return s.paths.at(path) == "/user/hand/right" ? 1 : 0; }

struct Input {
    const Hand* hand = nullptr;  // null: nothing is bound or the controller is off
    std::string path;            // below the hand
};
// The bound input of an action for a hand.
Input input_of(State& s, const XrActionStateGetInfo* info, XrActionType type) {
    const Action* action = find(s.actions, info->action);
    if (action == nullptr || action->type != type) {
        s.violation("an action's state is read as another type");
        return {};
    }
    const int side = side_of(s, info->subactionPath);
    const Hand& hand = s.hands.at(static_cast<std::size_t>(side));
    if (!hand.active || s.state != XR_SESSION_STATE_FOCUSED) return {};
    const std::string prefix = side == 1 ? "right/" : "left/";
    for (const std::string& input : action->inputs)
        if (input.compare(0, prefix.size(), prefix) == 0) return {&hand, input.substr(prefix.size())};
    return {};
}

XrResult state_float(XrSession, const XrActionStateGetInfo* info, XrActionStateFloat* value) {
    MOCK_ENTER("xrGetActionStateFloat");
    const Input input = input_of(s, info, XR_ACTION_TYPE_FLOAT_INPUT);
    value->isActive = input.hand != nullptr ? XR_TRUE : XR_FALSE;
    value->currentState = 0.0F;
    if (input.hand == nullptr) return XR_SUCCESS;
    const bool squeezes =
        input.path.find("squeeze") != std::string::npos || input.path.find("grasp") != std::string::npos;
    float now = squeezes ? input.hand->squeeze : input.hand->trigger;
    if (input.path.find("click") != std::string::npos)  // a button gives 0 or 1
        now = std::max(input.hand->trigger, input.hand->squeeze) > 0.5F ? 1.0F : 0.0F;
    value->currentState = now;
    return XR_SUCCESS;
}

XrResult state_boolean(XrSession, const XrActionStateGetInfo* info, XrActionStateBoolean* value) {
    MOCK_ENTER("xrGetActionStateBoolean");
    const Input input = input_of(s, info, XR_ACTION_TYPE_BOOLEAN_INPUT);
    value->isActive = input.hand != nullptr ? XR_TRUE : XR_FALSE;
    value->currentState = XR_FALSE;
    if (input.hand == nullptr) return XR_SUCCESS;
    const Action* action = find(s.actions, info->action);
    const bool down = action->name == "menu" ? input.hand->menu : input.hand->secondary;
    value->currentState = down ? XR_TRUE : XR_FALSE;
    return XR_SUCCESS;
}

XrResult state_vector(XrSession, const XrActionStateGetInfo* info, XrActionStateVector2f* value) {
    MOCK_ENTER("xrGetActionStateVector2f");
    const Input input = input_of(s, info, XR_ACTION_TYPE_VECTOR2F_INPUT);
    value->isActive = input.hand != nullptr ? XR_TRUE : XR_FALSE;
    value->currentState = {0.0F, 0.0F};
    if (input.hand != nullptr) value->currentState = {input.hand->stick_x, input.hand->stick_y};
    return XR_SUCCESS;
}

XrResult state_pose(XrSession, const XrActionStateGetInfo* info, XrActionStatePose* value) {
    MOCK_ENTER("xrGetActionStatePose");
    value->isActive = input_of(s, info, XR_ACTION_TYPE_POSE_INPUT).hand != nullptr ? XR_TRUE : XR_FALSE;
    return XR_SUCCESS;
}

XrResult create_action_space(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* space) {
    MOCK_ENTER("xrCreateActionSpace");
    const Action* action = find(s.actions, info->action);
    if (action == nullptr || action->type != XR_ACTION_TYPE_POSE_INPUT) return XR_ERROR_ACTION_TYPE_MISMATCH;
    auto made = std::make_unique<Space>();
    made->kind = action->name == "grip" ? SpaceKind::grip : SpaceKind::aim;
    made->side = side_of(s, info->subactionPath);
    made->offset = xr::to_pose(info->poseInActionSpace);
    *space = reinterpret_cast<XrSpace>(made.get());
    s.spaces.insert(std::move(made));
    return XR_SUCCESS;
}

XrResult apply_haptic(XrSession, const XrHapticActionInfo* info, const XrHapticBaseHeader* haptic) {
    MOCK_ENTER("xrApplyHapticFeedback");
    const auto* vibration = reinterpret_cast<const XrHapticVibration*>(haptic);
    if (vibration->amplitude < 0.0F || vibration->amplitude > 1.0F) s.violation("an amplitude outside 0 … 1");
    s.vibrations.push_back(
        {side_of(s, info->subactionPath), vibration->amplitude, vibration->frequency, s.now});
    return s.state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

XrResult stop_haptic(XrSession, const XrHapticActionInfo* info) {
    MOCK_ENTER("xrStopHapticFeedback");
    s.vibrations.push_back({side_of(s, info->subactionPath), 0.0F, 0.0F, s.now});
    return XR_SUCCESS;
}

XrResult current_profile(XrSession, XrPath hand, XrInteractionProfileState* profile) {
    MOCK_ENTER("xrGetCurrentInteractionProfile");
    const bool active = s.hands.at(static_cast<std::size_t>(side_of(s, hand))).active;
    const auto found = std::find(s.paths.begin(), s.paths.end(), s.config.profile);
    profile->interactionProfile =
        active && found != s.paths.end() ? static_cast<XrPath>(found - s.paths.begin()) : XR_NULL_PATH;
    return XR_SUCCESS;
}

XrResult create_tracker(XrSession, const XrHandTrackerCreateInfoEXT* info, XrHandTrackerEXT* tracker) {
    MOCK_ENTER("xrCreateHandTrackerEXT");
    if (s.enabled.count("XR_EXT_hand_tracking") == 0)
        s.violation("a hand tracker without XR_EXT_hand_tracking");
    ++s.hand_trackers;
    *tracker =
        reinterpret_cast<XrHandTrackerEXT>(&s.tracker_sides.at(info->hand == XR_HAND_RIGHT_EXT ? 1 : 0));
    return XR_SUCCESS;
}

XrResult destroy_tracker(XrHandTrackerEXT) {
    MOCK_ENTER("xrDestroyHandTrackerEXT");
    if (s.hand_trackers == 0) s.violation("xrDestroyHandTrackerEXT of an unknown tracker");
    --s.hand_trackers;
    return XR_SUCCESS;
}

XrResult locate_joints(XrHandTrackerEXT tracker, const XrHandJointsLocateInfoEXT* info,
                       XrHandJointLocationsEXT* locations) {
    MOCK_ENTER("xrLocateHandJointsEXT");
    const auto side = static_cast<std::size_t>(*reinterpret_cast<const int*>(tracker));
    const Space* base = find(s.spaces, info->baseSpace);
    if (base == nullptr) return XR_ERROR_HANDLE_INVALID;
    const Hand& hand = s.hands.at(side);
    locations->isActive = hand.joints ? XR_TRUE : XR_FALSE;
    for (std::uint32_t i = 0; i < locations->jointCount; ++i) {
        XrHandJointLocationEXT& joint = locations->jointLocations[i];
        joint.locationFlags =
            hand.joints && hand.joint_valid.at(i)
                ? XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT
                : 0;
        joint.pose = xr::to_xr(inverse(pose_of(s, *base)) * hand.grip);
        joint.radius = 0.01F;
    }
    return XR_SUCCESS;
}

}  // namespace

void add_action_functions(Functions& f) {
    f.insert({{"xrCreateActionSet", as_void(create_set)},
              {"xrDestroyActionSet", as_void(destroy_set)},
              {"xrCreateAction", as_void(create_action)},
              {"xrSuggestInteractionProfileBindings", as_void(suggest)},
              {"xrAttachSessionActionSets", as_void(attach)},
              {"xrSyncActions", as_void(sync)},
              {"xrGetActionStateFloat", as_void(state_float)},
              {"xrGetActionStateBoolean", as_void(state_boolean)},
              {"xrGetActionStateVector2f", as_void(state_vector)},
              {"xrGetActionStatePose", as_void(state_pose)},
              {"xrCreateActionSpace", as_void(create_action_space)},
              {"xrApplyHapticFeedback", as_void(apply_haptic)},
              {"xrStopHapticFeedback", as_void(stop_haptic)},
              {"xrGetCurrentInteractionProfile", as_void(current_profile)},
              {"xrCreateHandTrackerEXT", as_void(create_tracker)},
              {"xrDestroyHandTrackerEXT", as_void(destroy_tracker)},
              {"xrLocateHandJointsEXT", as_void(locate_joints)}});
}

}  // namespace bolt::mock_openxr
