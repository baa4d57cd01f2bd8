// XR_FB_passthrough of the mock runtime: the picture of the headset's cameras as a layer.
#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

XrResult XRAPI_CALL create_room(XrSession, const XrPassthroughCreateInfoFB* info,
                                XrPassthroughFB* passthrough) {
    constexpr const char* name = "xrCreatePassthroughFB";
    return call(name, Level::session, [&](State& s, auto&) {
        if (!s.instance->config.has_cameras)
            return refuse(s, name, XR_ERROR_FEATURE_UNSUPPORTED, "is called although there are no cameras");
        if (!s.instance->passthroughs.empty())
            return refuse(s, name, XR_ERROR_FEATURE_ALREADY_CREATED_PASSTHROUGH_FB, "is called twice");
        s.instance->passthroughs[++s.last_id] = {
            (info->flags & XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB) != 0};
        *passthrough = handle_of<XrPassthroughFB>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_room(XrPassthroughFB handle) {
    constexpr const char* name = "xrDestroyPassthroughFB";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    for (const auto& [id, layer] : s.instance->passthrough_layers)
        if (layer.passthrough == id_of(handle)) violate(s, name, "is called before its layer is destroyed");
    return remove(s, name, s.instance->passthroughs, handle, Kind::passthrough) ? success
                                                                                : XR_ERROR_HANDLE_INVALID;
}

XrResult XRAPI_CALL create_layer(XrSession, const XrPassthroughLayerCreateInfoFB* info,
                                 XrPassthroughLayerFB* layer) {
    constexpr const char* name = "xrCreatePassthroughLayerFB";
    return call(name, Level::session, [&](State& s, auto&) {
        if (find(s, name, s.instance->passthroughs, info->passthrough) == nullptr)
            return XR_ERROR_HANDLE_INVALID;
        if (info->purpose != XR_PASSTHROUGH_LAYER_PURPOSE_RECONSTRUCTION_FB)
            return refuse(s, name, XR_ERROR_FEATURE_UNSUPPORTED, "is given a purpose that is not offered");
        s.instance->passthrough_layers[++s.last_id] = {
            id_of(info->passthrough), (info->flags & XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB) != 0};
        *layer = handle_of<XrPassthroughLayerFB>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_layer(XrPassthroughLayerFB handle) {
    constexpr const char* name = "xrDestroyPassthroughLayerFB";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    return remove(s, name, s.instance->passthrough_layers, handle, Kind::passthrough_layer)
               ? success
               : XR_ERROR_HANDLE_INVALID;
}

// Starts or pauses an object.
template <class Object, class Handle>
XrResult run(const char* name, std::map<std::uint64_t, Object> Instance::*objects, Handle handle,
             bool running) {
    return call(name, Level::session, [&](State& s, auto&) {
        Object* found = find(s, name, (*s.instance).*objects, handle);
        if (found == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (found->running == running)
            return refuse(s, name, XR_ERROR_UNEXPECTED_STATE_PASSTHROUGH_FB,
                          running ? "starts what runs already" : "pauses what does not run");
        found->running = running;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL start_room(XrPassthroughFB handle) {
    return run("xrPassthroughStartFB", &Instance::passthroughs, handle, true);
}
XrResult XRAPI_CALL pause_room(XrPassthroughFB handle) {
    return run("xrPassthroughPauseFB", &Instance::passthroughs, handle, false);
}
XrResult XRAPI_CALL resume_layer(XrPassthroughLayerFB handle) {
    return run("xrPassthroughLayerResumeFB", &Instance::passthrough_layers, handle, true);
}
XrResult XRAPI_CALL pause_layer(XrPassthroughLayerFB handle) {
    return run("xrPassthroughLayerPauseFB", &Instance::passthrough_layers, handle, false);
}

}  // namespace

XrResult check_passthrough(State& s, const XrCompositionLayerPassthroughFB& layer, Frame& frame) {
    constexpr const char* name = "xrEndFrame";
    if (s.instance->extensions.count(XR_FB_PASSTHROUGH_EXTENSION_NAME) == 0)
        return refuse(s, name, XR_ERROR_LAYER_INVALID, "submits a passthrough that is not enabled");
    const PassthroughLayer* found = find(s, name, s.instance->passthrough_layers, layer.layerHandle);
    if (found == nullptr) return XR_ERROR_LAYER_INVALID;
    if (layer.space != XR_NULL_HANDLE)
        return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "submits a passthrough with a space");
    if (!found->running || !s.instance->passthroughs[found->passthrough].running)
        violate(s, name, "submits a passthrough that is paused");
    frame.passthrough_flags = layer.flags;
    return XR_SUCCESS;
}

void add_passthrough_functions(FunctionTable& table) {
    add(table, "xrCreatePassthroughFB", &create_room);
    add(table, "xrDestroyPassthroughFB", &destroy_room);
    add(table, "xrPassthroughStartFB", &start_room);
    add(table, "xrPassthroughPauseFB", &pause_room);
    add(table, "xrCreatePassthroughLayerFB", &create_layer);
    add(table, "xrDestroyPassthroughLayerFB", &destroy_layer);
    add(table, "xrPassthroughLayerPauseFB", &pause_layer);
    add(table, "xrPassthroughLayerResumeFB", &resume_layer);
}

}  // namespace bolt::mock
