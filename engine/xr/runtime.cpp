#include "engine/xr/runtime.hpp"

#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace bolt::xr {

std::string_view name(XrResult result) {
    switch (result) {
#define BOLT_XR_NAME(identifier, value) \
    case identifier:                    \
        return #identifier;
        XR_LIST_ENUM_XrResult(BOLT_XR_NAME)
#undef BOLT_XR_NAME
            default : return "an unknown OpenXR result";
    }
}

Status check(XrResult result, std::string_view function) {
    if (XR_SUCCEEDED(result)) return {};
    const bool lost = result == XR_ERROR_INSTANCE_LOST || result == XR_ERROR_SESSION_LOST;
    const bool missing = result == XR_ERROR_RUNTIME_UNAVAILABLE || result == XR_ERROR_RUNTIME_FAILURE ||
                         result == XR_ERROR_FORM_FACTOR_UNAVAILABLE ||
                         result == XR_ERROR_FORM_FACTOR_UNSUPPORTED;
    Error error;
    error.code = lost || missing ? ErrorCode::no_device : ErrorCode::failed;
    error.what = fmt::format("OpenXR: {} returned {}", function, name(result));
    error.expected = "a running OpenXR runtime with a connected headset that permits this";
    error.lost = lost;
    return fail(std::move(error));
}

namespace {

constexpr const char* vulkan_extension = XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
// Newer than the headers of Debian 12.
constexpr const char* local_floor_extension = "XR_EXT_local_floor";
constexpr const char* hand_interaction_extension = "XR_EXT_hand_interaction";

Error missing_runtime(std::string what) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = "an active runtime such as SteamVR or Monado, or its manifest in XR_RUNTIME_JSON";
    return error;
}

template <class Function>
Status load(XrInstance instance, const char* name, Function& function) {
    PFN_xrVoidFunction raw = nullptr;
    BOLT_TRY(check(xrGetInstanceProcAddr(instance, name, &raw), name));
    static_assert(sizeof(function) == sizeof(raw));
    std::memcpy(&function, &raw, sizeof raw);
    return {};
}

}  // namespace

void quiet_loader() { (void)setenv("XR_LOADER_DEBUG", "none", 0); }

Result<std::vector<std::string>> offered_extensions() {
    std::vector<XrExtensionProperties> listed;
    const XrResult result =
        enumerate(listed, XrExtensionProperties{XR_TYPE_EXTENSION_PROPERTIES},
                  [](std::uint32_t capacity, std::uint32_t* count, XrExtensionProperties* values) {
                      return xrEnumerateInstanceExtensionProperties(nullptr, capacity, count, values);
                  });
    if (XR_FAILED(result)) return fail(missing_runtime(fmt::format("no OpenXR runtime: {}", name(result))));
    std::vector<std::string> names;
    for (const XrExtensionProperties& extension : listed) names.emplace_back(extension.extensionName);
    return names;
}

XrInstanceCreateInfo instance_info() {
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    std::strncpy(info.applicationInfo.applicationName, "Boltwright", XR_MAX_APPLICATION_NAME_SIZE - 1);
    std::strncpy(info.applicationInfo.engineName, "Boltwright", XR_MAX_ENGINE_NAME_SIZE - 1);
    // Runtimes of every version accept 1.0, and nothing here needs 1.1.
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    return info;
}

void unload_runtime() {
    const XrInstanceCreateInfo info = instance_info();
    XrInstance instance = XR_NULL_HANDLE;
    if (XR_SUCCEEDED(xrCreateInstance(&info, &instance))) (void)xrDestroyInstance(instance);
}

Result<std::unique_ptr<Runtime>> Runtime::open() {
    quiet_loader();
    BOLT_TRY_ASSIGN(auto runtime, start());
    BOLT_TRY(runtime->find_headset());
    return runtime;
}

Result<std::unique_ptr<Runtime>> Runtime::start() {
    auto runtime = std::make_unique<Runtime>();
    BOLT_TRY(runtime->create_xr_instance());
    return runtime;
}

Status Runtime::find_headset() {
    BOLT_TRY(query_system());
    BOLT_TRY(load_functions());
    return choose_views();
}

Status Runtime::create_xr_instance() {
    BOLT_TRY_ASSIGN(const auto available, offered_extensions());
    const auto has = [&](const char* extension) {
        return std::find(available.begin(), available.end(), extension) != available.end();
    };
    if (!has(vulkan_extension)) {
        unload_runtime();
        return fail(missing_runtime("the OpenXR runtime does not support Vulkan (XR_KHR_vulkan_enable2)"));
    }
    std::vector<const char*> enabled{vulkan_extension};
    const auto enable = [&](const char* extension) {
        if (!has(extension)) return false;
        enabled.push_back(extension);
        return true;
    };
    extensions_.depth = enable(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
    extensions_.visibility_mask = enable(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME);
    extensions_.hand_tracking = enable(XR_EXT_HAND_TRACKING_EXTENSION_NAME);
    extensions_.local_floor = enable(local_floor_extension);
    extensions_.hand_interaction = enable(hand_interaction_extension);
    extensions_.user_presence = enable(user_presence_extension);
    extensions_.passthrough = enable(XR_FB_PASSTHROUGH_EXTENSION_NAME);
    extensions_.vive_trackers = enable(XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME);

    XrInstanceCreateInfo info = instance_info();
    info.enabledExtensionCount = static_cast<std::uint32_t>(enabled.size());
    info.enabledExtensionNames = enabled.data();
    XrInstance raw = XR_NULL_HANDLE;
    if (const XrResult created = xrCreateInstance(&info, &raw); XR_FAILED(created))
        return fail(missing_runtime(fmt::format("the OpenXR runtime does not start: {}", xr::name(created))));
    instance_ = InstanceHandle(raw);

    XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
    BOLT_TRY(check(xrGetInstanceProperties(raw, &properties), "xrGetInstanceProperties"));
    name_ =
        fmt::format("{} {}.{}.{}", properties.runtimeName, XR_VERSION_MAJOR(properties.runtimeVersion),
                    XR_VERSION_MINOR(properties.runtimeVersion), XR_VERSION_PATCH(properties.runtimeVersion));
    return {};
}

Status Runtime::query_system() {
    XrSystemGetInfo info{XR_TYPE_SYSTEM_GET_INFO};
    info.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    const XrResult found = xrGetSystem(instance_.get(), &info, &system_);
    lacks_headset_ = found == XR_ERROR_FORM_FACTOR_UNAVAILABLE || found == XR_ERROR_FORM_FACTOR_UNSUPPORTED;
    if (lacks_headset_) {
        Error error;
        error.code = ErrorCode::no_device;
        error.what = fmt::format("no headset is connected to {}", name_);
        error.expected = "a headset that is switched on and connected";
        return fail(std::move(error));
    }
    BOLT_TRY(check(found, "xrGetSystem"));
    XrSystemHandTrackingPropertiesEXT hands{XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
    UserPresenceProperties presence;
    XrSystemPassthroughPropertiesFB passthrough{XR_TYPE_SYSTEM_PASSTHROUGH_PROPERTIES_FB};
    const auto query = [&](bool enabled, auto& structure) {
        if (!enabled) return;
        structure.next = properties_.next;
        properties_.next = &structure;
    };
    query(extensions_.hand_tracking, hands);
    query(extensions_.user_presence, presence);
    query(extensions_.passthrough, passthrough);
    BOLT_TRY(check(xrGetSystemProperties(instance_.get(), system_, &properties_), "xrGetSystemProperties"));
    properties_.next = nullptr;
    extensions_.hand_tracking = extensions_.hand_tracking && hands.supportsHandTracking == XR_TRUE;
    extensions_.user_presence = extensions_.user_presence && presence.supported == XR_TRUE;
    extensions_.passthrough = extensions_.passthrough && passthrough.supportsPassthrough == XR_TRUE;
    headset_ = properties_.systemName;
    return {};
}

Status Runtime::load_functions() {
    const XrInstance xr = instance_.get();
    ExtensionFunctions& f = functions_;
    BOLT_TRY(load(xr, "xrGetVulkanGraphicsRequirements2KHR", f.graphics_requirements));
    BOLT_TRY(load(xr, "xrCreateVulkanInstanceKHR", f.create_vulkan_instance));
    BOLT_TRY(load(xr, "xrGetVulkanGraphicsDevice2KHR", f.graphics_device));
    BOLT_TRY(load(xr, "xrCreateVulkanDeviceKHR", f.create_vulkan_device));
    if (extensions_.visibility_mask) BOLT_TRY(load(xr, "xrGetVisibilityMaskKHR", f.visibility_mask));
    if (extensions_.passthrough) BOLT_TRY(load_passthrough());
    if (extensions_.vive_trackers)
        BOLT_TRY(load(xr, "xrEnumerateViveTrackerPathsHTCX", f.enumerate_vive_trackers));
    if (!extensions_.hand_tracking) return {};
    BOLT_TRY(load(xr, "xrCreateHandTrackerEXT", f.create_hand_tracker));
    BOLT_TRY(load(xr, "xrDestroyHandTrackerEXT", f.destroy_hand_tracker));
    return load(xr, "xrLocateHandJointsEXT", f.locate_hand_joints);
}

Status Runtime::load_passthrough() {
    const XrInstance xr = instance_.get();
    ExtensionFunctions& f = functions_;
    BOLT_TRY(load(xr, "xrCreatePassthroughFB", f.create_passthrough));
    BOLT_TRY(load(xr, "xrDestroyPassthroughFB", f.destroy_passthrough));
    BOLT_TRY(load(xr, "xrPassthroughStartFB", f.start_passthrough));
    BOLT_TRY(load(xr, "xrPassthroughPauseFB", f.pause_passthrough));
    BOLT_TRY(load(xr, "xrCreatePassthroughLayerFB", f.create_passthrough_layer));
    BOLT_TRY(load(xr, "xrDestroyPassthroughLayerFB", f.destroy_passthrough_layer));
    BOLT_TRY(load(xr, "xrPassthroughLayerPauseFB", f.pause_passthrough_layer));
    return load(xr, "xrPassthroughLayerResumeFB", f.resume_passthrough_layer);
}

Status Runtime::choose_views() {
    std::vector<XrViewConfigurationType> types;
    BOLT_TRY(check(
        enumerate(types, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
                  [&](std::uint32_t capacity, std::uint32_t* count, XrViewConfigurationType* values) {
                      return xrEnumerateViewConfigurations(instance_.get(), system_, capacity, count, values);
                  }),
        "xrEnumerateViewConfigurations"));
    // The runtime lists its preferred types first. All other primary types have more than two views.
    const auto wanted = std::find_if(types.begin(), types.end(), [](XrViewConfigurationType type) {
        return type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO ||
               type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
    });
    if (wanted == types.end())
        return fail(ErrorCode::no_device, fmt::format("{} offers neither mono nor stereo views", headset_),
                    "a headset with one or two views");
    view_configuration_ = *wanted;
    BOLT_TRY(
        check(enumerate(views_, XrViewConfigurationView{XR_TYPE_VIEW_CONFIGURATION_VIEW},
                        [&](std::uint32_t capacity, std::uint32_t* count, XrViewConfigurationView* values) {
                            return xrEnumerateViewConfigurationViews(
                                instance_.get(), system_, view_configuration_, capacity, count, values);
                        }),
              "xrEnumerateViewConfigurationViews"));
    if (views_.empty() || views_.size() > 2)
        return fail(ErrorCode::no_device, fmt::format("{} has {} views", headset_, views_.size()),
                    "one or two");
    std::vector<XrEnvironmentBlendMode> modes;
    BOLT_TRY(
        check(enumerate(modes, XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
                        [&](std::uint32_t capacity, std::uint32_t* count, XrEnvironmentBlendMode* values) {
                            return xrEnumerateEnvironmentBlendModes(
                                instance_.get(), system_, view_configuration_, capacity, count, values);
                        }),
              "xrEnumerateEnvironmentBlendModes"));
    for (const XrEnvironmentBlendMode mode : modes)
        if (mode == XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND) passthrough_ = mode;
    // Augmented-reality glasses may have no opaque mode; the first mode is then the one that they prefer.
    const bool has_opaque =
        std::find(modes.begin(), modes.end(), XR_ENVIRONMENT_BLEND_MODE_OPAQUE) != modes.end();
    if (!has_opaque && !modes.empty()) opaque_ = modes.front();
    return {};
}

Result<VkInstance> Runtime::create_instance(const VkInstanceCreateInfo& info) {
    XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    BOLT_TRY(check(functions_.graphics_requirements(instance_.get(), system_, &needs),
                   "xrGetVulkanGraphicsRequirements2KHR"));
    if (needs.minApiVersionSupported > XR_MAKE_VERSION(1, 3, 0))
        return fail(
            ErrorCode::no_device,
            fmt::format("{} needs Vulkan {}.{}", name_, XR_VERSION_MAJOR(needs.minApiVersionSupported),
                        XR_VERSION_MINOR(needs.minApiVersionSupported)),
            "a runtime that supports Vulkan 1.3");
    XrVulkanInstanceCreateInfoKHR create{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanCreateInfo = &info;
    VkInstance created = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    BOLT_TRY(check(functions_.create_vulkan_instance(instance_.get(), &create, &created, &result),
                   "xrCreateVulkanInstanceKHR"));
    BOLT_TRY(gpu::check(result, "creating the headset's Vulkan instance"));
    return created;
}

Result<VkPhysicalDevice> Runtime::choose_gpu(VkInstance instance) {
    XrVulkanGraphicsDeviceGetInfoKHR info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    info.systemId = system_;
    info.vulkanInstance = instance;
    VkPhysicalDevice gpu = VK_NULL_HANDLE;
    BOLT_TRY(
        check(functions_.graphics_device(instance_.get(), &info, &gpu), "xrGetVulkanGraphicsDevice2KHR"));
    return gpu;
}

Result<VkDevice> Runtime::create_device(VkPhysicalDevice gpu, const VkDeviceCreateInfo& info) {
    XrVulkanDeviceCreateInfoKHR create{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanPhysicalDevice = gpu;
    create.vulkanCreateInfo = &info;
    VkDevice created = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    BOLT_TRY(check(functions_.create_vulkan_device(instance_.get(), &create, &created, &result),
                   "xrCreateVulkanDeviceKHR"));
    BOLT_TRY(gpu::check(result, "creating the headset's Vulkan device"));
    return created;
}

}  // namespace bolt::xr
