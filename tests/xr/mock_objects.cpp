// Each check of the mock's objects, session and actions finds a client that breaks its rule.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/xr/direct.hpp"

using namespace bolt;

namespace {

using test::expect_violation;

XrResult make_action_set(test::DirectClient& client, const char* name, const char* shown, XrActionSet& set) {
    XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
    std::strcpy(info.actionSetName, name);
    std::strcpy(info.localizedActionSetName, shown);
    return client.call<PFN_xrCreateActionSet>("xrCreateActionSet", client.instance, &info, &set);
}

XrResult make_action(test::DirectClient& client, XrActionSet set, const char* name, XrActionType type,
                     XrAction& action, const char* shown = "Shown") {
    const XrPath sides[] = {client.path("/user/hand/left"), client.path("/user/hand/right")};
    XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, shown);
    info.actionType = type;
    info.countSubactionPaths = 2;
    info.subactionPaths = sides;
    return client.call<PFN_xrCreateAction>("xrCreateAction", set, &info, &action);
}

XrResult suggest(test::DirectClient& client, const char* profile, XrAction action, const char* path) {
    const XrActionSuggestedBinding binding{action, client.path(path)};
    XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    info.interactionProfile = client.path(profile);
    info.countSuggestedBindings = 1;
    info.suggestedBindings = &binding;
    return client.call<PFN_xrSuggestInteractionProfileBindings>("xrSuggestInteractionProfileBindings",
                                                                client.instance, &info);
}

XrResult attach(test::DirectClient& client, XrActionSet set) {
    XrSessionActionSetsAttachInfo info{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
    info.countActionSets = 1;
    info.actionSets = &set;
    return client.call<PFN_xrAttachSessionActionSets>("xrAttachSessionActionSets", client.session, &info);
}

XrResult sync(test::DirectClient& client, XrActionSet set) {
    const XrActiveActionSet active{set, XR_NULL_PATH};
    XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO};
    info.countActiveActionSets = 1;
    info.activeActionSets = &active;
    return client.call<PFN_xrSyncActions>("xrSyncActions", client.session, &info);
}

XrResult read_float(test::DirectClient& client, XrAction action, const char* side) {
    XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
    info.action = action;
    info.subactionPath = client.path(side);
    XrActionStateFloat state{XR_TYPE_ACTION_STATE_FLOAT};
    return client.call<PFN_xrGetActionStateFloat>("xrGetActionStateFloat", client.session, &info, &state);
}

XrResult vibrate(test::DirectClient& client, XrAction action, float amplitude, XrDuration duration) {
    XrHapticActionInfo info{XR_TYPE_HAPTIC_ACTION_INFO};
    info.action = action;
    info.subactionPath = client.path("/user/hand/left");
    XrHapticVibration haptic{XR_TYPE_HAPTIC_VIBRATION};
    haptic.amplitude = amplitude;
    haptic.duration = duration;
    return client.call<PFN_xrApplyHapticFeedback>("xrApplyHapticFeedback", client.session, &info,
                                                  reinterpret_cast<const XrHapticBaseHeader*>(&haptic));
}

}  // namespace

TEST_CASE("Mock: enabling an extension that is not offered is found") {
    const test::MockRuntime mock;
    test::DirectClient client;
    expect_violation(mock, client.make_instance({"XR_EXT_eye_gaze_interaction"}),
                     XR_ERROR_EXTENSION_NOT_PRESENT,
                     "xrCreateInstance: enables XR_EXT_eye_gaze_interaction, which is not offered");
    // Functions of an extension exist only where it is enabled.
    REQUIRE(client.make_instance({"XR_KHR_vulkan_enable2"}) == XR_SUCCESS);
    XrHandTrackerEXT tracker = XR_NULL_HANDLE;
    CHECK(client.call<PFN_xrDestroyHandTrackerEXT>("xrDestroyHandTrackerEXT", tracker) ==
          XR_ERROR_FUNCTION_UNSUPPORTED);
    expect_violation(mock, client.make_instance(), XR_ERROR_LIMIT_REACHED,
                     "xrCreateInstance: is called while an instance exists");
}

TEST_CASE("Mock: objects that leak are found when the instance is destroyed") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    (void)client.make_space();
    (void)client.make_swapchain(test::DirectClient::color_format, 1);
    XrActionSet set = XR_NULL_HANDLE;
    REQUIRE(make_action_set(client, "set", "Set", set) == XR_SUCCESS);
    CHECK(client.call<PFN_xrDestroyInstance>("xrDestroyInstance", client.instance) == XR_SUCCESS);
    CHECK(mock->take_violations() == std::vector<std::string>{"xrDestroyInstance: leaks 1 session(s)",
                                                              "xrDestroyInstance: leaks 1 space(s)",
                                                              "xrDestroyInstance: leaks 1 swapchain(s)",
                                                              "xrDestroyInstance: leaks 1 action set(s)"});
    expect_violation(mock, client.call<PFN_xrDestroyInstance>("xrDestroyInstance", client.instance),
                     XR_ERROR_HANDLE_INVALID, "xrDestroyInstance: destroys an object twice");
}

TEST_CASE("Mock: objects that are destroyed twice, or used after that, are found") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    const XrSpace space = client.make_space();
    const XrSwapchain swapchain = client.make_swapchain(test::DirectClient::color_format, 1);
    CHECK(client.call<PFN_xrDestroySpace>("xrDestroySpace", space) == XR_SUCCESS);
    CHECK(client.call<PFN_xrDestroySwapchain>("xrDestroySwapchain", swapchain) == XR_SUCCESS);
    expect_violation(mock, client.call<PFN_xrDestroySpace>("xrDestroySpace", space), XR_ERROR_HANDLE_INVALID,
                     "xrDestroySpace: destroys an object twice");
    expect_violation(mock, client.call<PFN_xrDestroySwapchain>("xrDestroySwapchain", swapchain),
                     XR_ERROR_HANDLE_INVALID, "xrDestroySwapchain: destroys an object twice");
    expect_violation(mock, client.acquire(swapchain), XR_ERROR_HANDLE_INVALID,
                     "xrAcquireSwapchainImage: uses an object that was destroyed");
    // A session takes its children along.
    const XrSpace child = client.make_space();
    CHECK(client.call<PFN_xrDestroySession>("xrDestroySession", client.session) == XR_SUCCESS);
    expect_violation(mock, client.call<PFN_xrDestroySpace>("xrDestroySpace", child), XR_ERROR_HANDLE_INVALID,
                     "xrDestroySpace: destroys an object twice");
    expect_violation(mock, client.call<PFN_xrDestroySession>("xrDestroySession", client.session),
                     XR_ERROR_HANDLE_INVALID, "xrDestroySession: destroys an object twice");
    expect_violation(mock, client.wait_frame(), XR_ERROR_HANDLE_INVALID,
                     "xrWaitFrame: is called without a session");
}

TEST_CASE("Mock: a session needs the requirements, and Vulkan's objects of the runtime") {
    const test::MockRuntime mock;
    test::DirectClient client;
    client.make_vulkan(false);
    expect_violation(mock, client.make_session(), XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
                     "xrCreateSession: is called before xrGetVulkanGraphicsRequirements2KHR");
    XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    REQUIRE(client.call<PFN_xrGetVulkanGraphicsRequirements2KHR>(
                "xrGetVulkanGraphicsRequirements2KHR", client.instance, XrSystemId{1}, &needs) == XR_SUCCESS);
    const char* foreign = "xrCreateSession: is given Vulkan objects that the runtime did not make";
    expect_violation(mock, client.try_session(client.vulkan->get(), reinterpret_cast<VkDevice>(0x1234)),
                     XR_ERROR_GRAPHICS_DEVICE_INVALID, foreign);
    expect_violation(mock, client.try_session(VK_NULL_HANDLE, client.device->get()),
                     XR_ERROR_GRAPHICS_DEVICE_INVALID, foreign);
    XrSessionCreateInfo without{XR_TYPE_SESSION_CREATE_INFO};
    XrSession session = XR_NULL_HANDLE;
    expect_violation(mock,
                     client.call<PFN_xrCreateSession>("xrCreateSession", client.instance, &without, &session),
                     XR_ERROR_GRAPHICS_DEVICE_INVALID, "xrCreateSession: is given no Vulkan device");
    REQUIRE(client.make_session() == XR_SUCCESS);
    expect_violation(mock, client.try_session(client.vulkan->get(), client.device->get()),
                     XR_ERROR_LIMIT_REACHED, "xrCreateSession: is called while a session exists");
    const Result<VkPhysicalDevice> other = client.choose_gpu(reinterpret_cast<VkInstance>(0x1234));
    CHECK_FALSE(other.has_value());
    CHECK(mock->take_violations().size() == 1);
}

TEST_CASE("Mock: the states of a session are checked") {
    const test::MockRuntime mock;
    mock->send(mock::Event::taken_off);
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    expect_violation(mock, client.begin_session(), XR_ERROR_SESSION_NOT_READY,
                     "xrBeginSession: is called in another state than READY");
    expect_violation(mock, client.end_session(), XR_ERROR_SESSION_NOT_RUNNING,
                     "xrEndSession: is called while the session does not run");
    const auto request_exit = [&] {
        return client.call<PFN_xrRequestExitSession>("xrRequestExitSession", client.session);
    };
    expect_violation(mock, request_exit(), XR_ERROR_SESSION_NOT_RUNNING,
                     "xrRequestExitSession: is called while the session does not run");
    mock->send(mock::Event::put_on);
    expect_violation(mock, client.begin_session(XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO),
                     XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
                     "xrBeginSession: is given a view configuration that is not offered");
    REQUIRE(client.begin_session() == XR_SUCCESS);
    expect_violation(mock, client.begin_session(), XR_ERROR_SESSION_RUNNING,
                     "xrBeginSession: is called while the session runs");
    expect_violation(mock, client.end_session(), XR_ERROR_SESSION_NOT_STOPPING,
                     "xrEndSession: is called in another state than STOPPING");
    CHECK(request_exit() == XR_SUCCESS);
    CHECK(client.end_session() == XR_SUCCESS);
    CHECK(mock->session_state() == XR_SESSION_STATE_EXITING);
}

TEST_CASE("Mock: spaces and queries are checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
    info.referenceSpaceType = mock::local_floor_space;
    info.poseInReferenceSpace.orientation.w = 1.0F;
    XrSpace space = XR_NULL_HANDLE;
    const auto create = [&] {
        return client.call<PFN_xrCreateReferenceSpace>("xrCreateReferenceSpace", client.session, &info,
                                                       &space);
    };
    expect_violation(mock, create(), XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
                     "xrCreateReferenceSpace: requests a space that is not offered");
    info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_VIEW;
    info.poseInReferenceSpace.orientation.w = 0.0F;
    expect_violation(mock, create(), XR_ERROR_POSE_INVALID,
                     "xrCreateReferenceSpace: is given an orientation that is not a unit quaternion");
    space = client.make_space();
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    expect_violation(mock,
                     client.call<PFN_xrLocateSpace>("xrLocateSpace", space, space, XrTime{0}, &location),
                     XR_ERROR_TIME_INVALID, "xrLocateSpace: is given a time that is not positive");
    std::uint32_t count = 0;
    XrReferenceSpaceType types[1];
    expect_violation(mock,
                     client.call<PFN_xrEnumerateReferenceSpaces>("xrEnumerateReferenceSpaces", client.session,
                                                                 1U, &count, types),
                     XR_ERROR_SIZE_INSUFFICIENT,
                     "xrEnumerateReferenceSpaces: is given fewer elements than it returns");
    XrPath path = XR_NULL_PATH;
    expect_violation(mock, client.call<PFN_xrStringToPath>("xrStringToPath", client.instance, "user", &path),
                     XR_ERROR_PATH_FORMAT_INVALID,
                     "xrStringToPath: is given a path that does not begin with /");
}

TEST_CASE("Mock: actions and their bindings are checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    constexpr const char* touch = "/interaction_profiles/oculus/touch_controller";
    constexpr const char* left = "/user/hand/left";
    XrActionSet set = XR_NULL_HANDLE;
    expect_violation(mock, make_action_set(client, "Set", "Set", set), XR_ERROR_PATH_FORMAT_INVALID,
                     "xrCreateActionSet: is given a name that is no path");
    expect_violation(mock, make_action_set(client, "set", "", set), XR_ERROR_LOCALIZED_NAME_INVALID,
                     "xrCreateActionSet: is given no name for the user");
    REQUIRE(make_action_set(client, "set", "Set", set) == XR_SUCCESS);
    XrAction select = XR_NULL_HANDLE, vibration = XR_NULL_HANDLE, other = XR_NULL_HANDLE;
    REQUIRE(make_action(client, set, "select", XR_ACTION_TYPE_FLOAT_INPUT, select) == XR_SUCCESS);
    REQUIRE(make_action(client, set, "vibrate", XR_ACTION_TYPE_VIBRATION_OUTPUT, vibration) == XR_SUCCESS);
    expect_violation(mock, make_action(client, set, "select", XR_ACTION_TYPE_FLOAT_INPUT, other),
                     XR_ERROR_NAME_DUPLICATED, "xrCreateAction: is given a name that another action has");
    expect_violation(mock, make_action(client, set, "a b", XR_ACTION_TYPE_FLOAT_INPUT, other),
                     XR_ERROR_PATH_FORMAT_INVALID, "xrCreateAction: is given a name that is no path");

    CHECK(suggest(client, touch, select, "/user/hand/left/input/trigger/value") == XR_SUCCESS);
    // Left and right differ; a parent stands for its components; unknown profiles are rejected quietly.
    for (const char* path :
         {"/user/hand/left/input/a/click", "/user/hand/right/input/menu/click",
          "/user/hand/left/input/trackpad", "/user/head/input/trigger/value", "/user/hand/left/input/trig"})
        expect_violation(mock, suggest(client, touch, select, path), XR_ERROR_PATH_UNSUPPORTED,
                         std::string("xrSuggestInteractionProfileBindings: binds ") + path + ", which " +
                             touch + " lacks");
    expect_violation(mock, suggest(client, touch, vibration, "/user/hand/left/input/trigger/value"),
                     XR_ERROR_PATH_UNSUPPORTED,
                     "xrSuggestInteractionProfileBindings: binds /user/hand/left/input/trigger/value to "
                     "\"vibrate\", an action of another type");
    CHECK(suggest(client, touch, select, "/user/hand/left/input/trigger") == XR_SUCCESS);
    CHECK(suggest(client, "/interaction_profiles/new/wand", select, "/user/hand/left/input/trigger") ==
          XR_ERROR_PATH_UNSUPPORTED);
    CHECK(suggest(client, "/interaction_profiles/ext/hand_interaction_ext", select,
                  "/user/hand/left/input/pinch_ext/value") == XR_ERROR_PATH_UNSUPPORTED);

    expect_violation(mock, read_float(client, select, left), XR_ERROR_ACTIONSET_NOT_ATTACHED,
                     "xrGetActionStateFloat: is called before attaching the actions");
    expect_violation(mock, sync(client, set), XR_ERROR_ACTIONSET_NOT_ATTACHED,
                     "xrSyncActions: is called before attaching the actions");
    CHECK(attach(client, set) == XR_SUCCESS);
    expect_violation(mock, attach(client, set), XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
                     "xrAttachSessionActionSets: is called twice for a session");
    expect_violation(mock, suggest(client, touch, select, "/user/hand/left/input/trigger/value"),
                     XR_ERROR_ACTIONSETS_ALREADY_ATTACHED,
                     "xrSuggestInteractionProfileBindings: is called after attaching");
    expect_violation(mock, make_action(client, set, "late", XR_ACTION_TYPE_FLOAT_INPUT, other),
                     XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "xrCreateAction: is called after attaching");
    expect_violation(mock, read_float(client, vibration, left), XR_ERROR_ACTION_TYPE_MISMATCH,
                     "xrGetActionStateFloat: is given an action of another type");
    expect_violation(mock, read_float(client, select, "/user/gamepad"), XR_ERROR_PATH_UNSUPPORTED,
                     "xrGetActionStateFloat: is given a subaction path that the action lacks");
    XrActionSpaceCreateInfo space_info{XR_TYPE_ACTION_SPACE_CREATE_INFO};
    space_info.action = select;
    XrSpace space = XR_NULL_HANDLE;
    expect_violation(
        mock,
        client.call<PFN_xrCreateActionSpace>("xrCreateActionSpace", client.session, &space_info, &space),
        XR_ERROR_ACTION_TYPE_MISMATCH, "xrCreateActionSpace: is given an action that is no pose");
}

TEST_CASE("Mock: vibrations are checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    client.run_session();
    XrActionSet set = XR_NULL_HANDLE;
    XrAction vibration = XR_NULL_HANDLE;
    REQUIRE(make_action_set(client, "set", "Set", set) == XR_SUCCESS);
    REQUIRE(make_action(client, set, "vibrate", XR_ACTION_TYPE_VIBRATION_OUTPUT, vibration) == XR_SUCCESS);
    REQUIRE(attach(client, set) == XR_SUCCESS);
    CHECK(vibrate(client, vibration, 0.5F, 1000) == XR_SESSION_NOT_FOCUSED);
    REQUIRE(client.wait_frame() == XR_SUCCESS);
    REQUIRE(client.begin_frame() == XR_SUCCESS);
    REQUIRE(client.end_frame(client.display_time) == XR_SUCCESS);
    CHECK(mock->session_state() == XR_SESSION_STATE_FOCUSED);
    expect_violation(mock, vibrate(client, vibration, 1.5F, 1000), XR_ERROR_VALIDATION_FAILURE,
                     "xrApplyHapticFeedback: is given an amplitude outside 0 to 1");
    expect_violation(mock, vibrate(client, vibration, 0.5F, 0), XR_ERROR_VALIDATION_FAILURE,
                     "xrApplyHapticFeedback: is given a duration that is not positive");
    CHECK(vibrate(client, vibration, 0.5F, 1000) == XR_SUCCESS);
    const std::vector<mock::Vibration> vibrations = mock->take_vibrations();
    REQUIRE(vibrations.size() == 1);
    CHECK(vibrations[0].amplitude == 0.5F);
    CHECK(vibrations[0].time == client.display_time);
}

TEST_CASE("Mock: calls after a loss, other than destroying, are found") {
    for (const XrResult loss : {XR_ERROR_SESSION_LOST, XR_ERROR_INSTANCE_LOST}) {
        const test::MockRuntime mock;
        test::DirectClient client;
        client.run_session();
        const XrSpace space = client.make_space();
        mock->fail_next("xrWaitFrame", loss, 1);
        CHECK(client.wait_frame() == loss);
        CHECK(mock->take_violations().empty());
        expect_violation(mock, client.begin_frame(), loss,
                         "xrBeginFrame: is called after the loss; expected only destroying");
        CHECK(client.call<PFN_xrDestroySpace>("xrDestroySpace", space) == XR_SUCCESS);
        CHECK(client.call<PFN_xrDestroySession>("xrDestroySession", client.session) == XR_SUCCESS);
        CHECK(client.call<PFN_xrDestroyInstance>("xrDestroyInstance", client.instance) == XR_SUCCESS);
        CHECK(mock->take_violations().empty());
    }
}
