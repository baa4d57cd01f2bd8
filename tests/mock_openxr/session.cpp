// Sessions, spaces and views of the mock runtime.
#include <fmt/format.h>

#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

// Opens the device of a session with pictures.
XrResult check_binding(State& s, const XrGraphicsBindingVulkan2KHR& binding, Session& session) {
    constexpr const char* name = "xrCreateSession";
    Instance& instance = *s.instance;
    const VulkanObjects& made = instance.created;
    if (!instance.requirements_queried)
        return refuse(s, name, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
                      "is called before xrGetVulkanGraphicsRequirements2KHR");
    if (binding.instance != made.instance || binding.device != made.device ||
        binding.device == VK_NULL_HANDLE || binding.physicalDevice != made.physical)
        return refuse(s, name, XR_ERROR_GRAPHICS_DEVICE_INVALID,
                      "is given Vulkan objects that the runtime did not make");
    if (open_device(session.vulkan, made, binding.queueFamilyIndex, binding.queueIndex) != VK_SUCCESS)
        return XR_ERROR_RUNTIME_FAILURE;
    return XR_SUCCESS;
}

// A session without pictures if `binding` is null.
XrResult open_session(State& s, const XrGraphicsBindingVulkan2KHR* binding) {
    Instance& instance = *s.instance;
    Session session;
    session.headless = binding == nullptr;
    if (binding != nullptr)
        if (const XrResult opened = check_binding(s, *binding, session); XR_FAILED(opened)) return opened;
    session.id = ++s.last_id;
    session.last_display = instance.config.real_time ? now(s) : 1'000'000'000;
    session.origins[XR_REFERENCE_SPACE_TYPE_STAGE] = {{0, {}}};
    session.origins[XR_REFERENCE_SPACE_TYPE_LOCAL] = {{0, instance.config.seated_origin}};
    session.origins[local_floor_space] = {{0, instance.config.floor_origin}};
    instance.session = std::move(session);
    enter_state(s, XR_SESSION_STATE_IDLE);
    advance_session(s);
    return XR_SUCCESS;
}

XrResult XRAPI_CALL create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
    constexpr const char* name = "xrCreateSession";
    return call(name, Level::instance, [&](State& s, auto&) {
        if (s.instance->session)
            return refuse(s, name, XR_ERROR_LIMIT_REACHED, "is called while a session exists");
        const auto* binding = static_cast<const XrGraphicsBindingVulkan2KHR*>(info->next);
        const bool headless = s.instance->extensions.count(XR_MND_HEADLESS_EXTENSION_NAME) != 0;
        if (!headless && (binding == nullptr || binding->type != XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR))
            return refuse(s, name, XR_ERROR_GRAPHICS_DEVICE_INVALID, "is given no Vulkan device");
        const XrResult result = open_session(s, binding);
        if (XR_SUCCEEDED(result)) *session = handle_of<XrSession>(s.instance->session->id);
        return result;
    });
}

XrResult XRAPI_CALL destroy_session(XrSession handle) {
    constexpr const char* name = "xrDestroySession";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance || !s.instance->session || s.instance->session->id != id_of(handle))
        return refuse(s, name, XR_ERROR_HANDLE_INVALID,
                      s.ended.count(id_of(handle)) != 0 ? "destroys an object twice"
                                                        : "destroys a handle of no object");
    if (s.instance->session->waiting) violate(s, name, "is called while a thread is inside xrWaitFrame");
    if (!s.instance->passthroughs.empty()) violate(s, name, "is called while a passthrough exists");
    drop_session(s, true);
    for (auto& [id, set] : s.instance->sets) set.attached = false;
    return success;
}

XrResult XRAPI_CALL begin_session(XrSession, const XrSessionBeginInfo* info) {
    constexpr const char* name = "xrBeginSession";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (session.running)
            return refuse(s, name, XR_ERROR_SESSION_RUNNING, "is called while the session runs");
        if (session.state != XR_SESSION_STATE_READY)
            return refuse(s, name, XR_ERROR_SESSION_NOT_READY, "is called in another state than READY");
        const XrViewConfigurationType type = s.instance->config.eyes == 1
                                                 ? XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO
                                                 : XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
        if (info->primaryViewConfigurationType != type)
            return refuse(s, name, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
                          "is given a view configuration that is not offered");
        session.running = true;
        session.begun_once = false;
        session.waited.reset();
        session.begun.reset();
        report_presence(s);
        // A session without frames has focus at once.
        if (session.headless)
            for (const XrSessionState state :
                 {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED})
                enter_state(s, state);
        if (!s.worn) stop_session(s);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL end_session(XrSession) {
    constexpr const char* name = "xrEndSession";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (!session.running)
            return refuse(s, name, XR_ERROR_SESSION_NOT_RUNNING, "is called while the session does not run");
        if (session.state != XR_SESSION_STATE_STOPPING)
            return refuse(s, name, XR_ERROR_SESSION_NOT_STOPPING, "is called in another state than STOPPING");
        session.running = false;
        session.waited.reset();
        session.begun.reset();
        enter_state(s, XR_SESSION_STATE_IDLE);
        if (session.exiting) enter_state(s, XR_SESSION_STATE_EXITING);
        advance_session(s);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL request_exit(XrSession) {
    constexpr const char* name = "xrRequestExitSession";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (!session.running)
            return refuse(s, name, XR_ERROR_SESSION_NOT_RUNNING, "is called while the session does not run");
        session.exiting = true;
        stop_session(s);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL enumerate_spaces(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                     XrReferenceSpaceType* types) {
    constexpr const char* name = "xrEnumerateReferenceSpaces";
    return call(name, Level::session, [&](State& s, auto&) {
        return list(s, name, s.instance->config.spaces, capacity, count,
                    [&](std::size_t i, XrReferenceSpaceType type) { types[i] = type; });
    });
}

XrResult XRAPI_CALL create_reference_space(XrSession handle, const XrReferenceSpaceCreateInfo* info,
                                           XrSpace* space) {
    constexpr const char* name = "xrCreateReferenceSpace";
    return call(name, Level::session, [&](State& s, auto&) {
        const std::vector<XrReferenceSpaceType>& offered = s.instance->config.spaces;
        if (std::find(offered.begin(), offered.end(), info->referenceSpaceType) == offered.end())
            return refuse(s, name, XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
                          "requests a space that is not offered");
        if (!is_unit(info->poseInReferenceSpace.orientation))
            return refuse(s, name, XR_ERROR_POSE_INVALID,
                          "is given an orientation that is not a unit quaternion");
        Space created;
        created.session = id_of(handle);
        created.reference = info->referenceSpaceType;
        created.offset = from_xr(info->poseInReferenceSpace);
        s.instance->spaces[++s.last_id] = created;
        *space = handle_of<XrSpace>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL bounds(XrSession, XrReferenceSpaceType, XrExtent2Df* size) {
    return call("xrGetReferenceSpaceBoundsRect", Level::session, [&](State&, auto&) {
        *size = {0.0F, 0.0F};
        return XR_SPACE_BOUNDS_UNAVAILABLE;
    });
}

XrResult XRAPI_CALL create_action_space(XrSession handle, const XrActionSpaceCreateInfo* info,
                                        XrSpace* space) {
    constexpr const char* name = "xrCreateActionSpace";
    return call(name, Level::session, [&](State& s, auto&) {
        const Action* action = find(s, name, s.instance->actions, info->action);
        if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (action->type != XR_ACTION_TYPE_POSE_INPUT)
            return refuse(s, name, XR_ERROR_ACTION_TYPE_MISMATCH, "is given an action that is no pose");
        const auto side = std::find(action->sides.begin(), action->sides.end(), info->subactionPath);
        if (side == action->sides.end())
            return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED,
                          "is given a subaction path that the action lacks");
        Space created;
        created.session = id_of(handle);
        created.action = id_of(info->action);
        const std::string& path = s.instance->paths[info->subactionPath - 1];
        created.side = path == "/user/hand/left" ? 0 : 1;
        if (path.rfind(role_folder, 0) == 0) created.role = path;
        created.offset = from_xr(info->poseInActionSpace);
        s.instance->spaces[++s.last_id] = created;
        *space = handle_of<XrSpace>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_space(XrSpace handle) {
    constexpr const char* name = "xrDestroySpace";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    return remove(s, name, s.instance->spaces, handle, Kind::space) ? success : XR_ERROR_HANDLE_INVALID;
}

XrResult XRAPI_CALL locate_space(XrSpace handle, XrSpace base_handle, XrTime time,
                                 XrSpaceLocation* location) {
    constexpr const char* name = "xrLocateSpace";
    return call(name, Level::session, [&](State& s, auto&) {
        const Space* space = find(s, name, s.instance->spaces, handle);
        const Space* base = find(s, name, s.instance->spaces, base_handle);
        if (space == nullptr || base == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (time <= 0) return refuse(s, name, XR_ERROR_TIME_INVALID, "is given a time that is not positive");
        const Tracked at = locate(s, *space, time), from = locate(s, *base, time);
        location->pose = to_xr(inverse(from.pose) * at.pose);
        location->locationFlags = flags_of({{}, at.valid && from.valid, at.tracked && from.tracked});
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL locate_views(XrSession, const XrViewLocateInfo* info, XrViewState* view_state,
                                 std::uint32_t capacity, std::uint32_t* count, XrView* views) {
    constexpr const char* name = "xrLocateViews";
    return call(name, Level::session, [&](State& s, auto&) {
        const Space* base = find(s, name, s.instance->spaces, info->space);
        if (base == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (info->displayTime <= 0)
            return refuse(s, name, XR_ERROR_TIME_INVALID, "is given a time that is not positive");
        view_state->viewStateFlags = flags_of(s.head);  // the bits are the same
        const std::vector<XrView> located = views_at(s, locate(s, *base, info->displayTime).pose);
        Session& session = *s.instance->session;
        session.located[info->displayTime] = located;
        if (session.located.size() > 8) session.located.erase(session.located.begin());
        return list(s, name, located, capacity, count, [&](std::size_t i, const XrView& v) { views[i] = v; });
    });
}

XrResult XRAPI_CALL visibility_mask(XrSession, XrViewConfigurationType, std::uint32_t view,
                                    XrVisibilityMaskTypeKHR type, XrVisibilityMaskKHR* mask) {
    constexpr const char* name = "xrGetVisibilityMaskKHR";
    return call(name, Level::session, [&](State& s, auto&) {
        if (view >= s.instance->config.eyes)
            return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "requests a view that does not exist");
        std::vector<XrVector2f> vertices;
        if (type == XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR)
            vertices = s.instance->config.hidden_triangles;
        mask->vertexCountOutput = mask->indexCountOutput = static_cast<std::uint32_t>(vertices.size());
        if (mask->vertexCapacityInput == 0 || mask->indexCapacityInput == 0) return XR_SUCCESS;
        if (mask->vertexCapacityInput < vertices.size() || mask->indexCapacityInput < vertices.size())
            return refuse(s, name, XR_ERROR_SIZE_INSUFFICIENT, "is given fewer elements than it returns");
        for (std::uint32_t i = 0; i < vertices.size(); ++i) {
            mask->vertices[i] = vertices[i];
            mask->indices[i] = i;
        }
        return XR_SUCCESS;
    });
}

}  // namespace

Tracked locate(const State& s, const Space& space, XrTime time) {
    Tracked at{};
    if (space.reference == XR_REFERENCE_SPACE_TYPE_VIEW) {
        at = s.head;
    } else if (space.reference) {
        const auto origins = s.instance->session->origins.find(*space.reference);
        if (origins != s.instance->session->origins.end())
            for (const Origin& origin : origins->second)
                if (origin.from <= time) at.pose = origin.pose;
    } else {
        at = locate_action(s, space);
    }
    at.pose = at.pose * space.offset;
    return at;
}

void add_session_functions(FunctionTable& table) {
    add(table, "xrCreateSession", &create_session);
    add(table, "xrDestroySession", &destroy_session);
    add(table, "xrBeginSession", &begin_session);
    add(table, "xrEndSession", &end_session);
    add(table, "xrRequestExitSession", &request_exit);
    add(table, "xrEnumerateReferenceSpaces", &enumerate_spaces);
    add(table, "xrCreateReferenceSpace", &create_reference_space);
    add(table, "xrGetReferenceSpaceBoundsRect", &bounds);
    add(table, "xrCreateActionSpace", &create_action_space);
    add(table, "xrDestroySpace", &destroy_space);
    add(table, "xrLocateSpace", &locate_space);
    add(table, "xrLocateViews", &locate_views);
    add(table, "xrGetVisibilityMaskKHR", &visibility_mask);
}

}  // namespace bolt::mock
