// The entry of the mock runtime, its instance, its headset, and the Vulkan objects that it makes.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "tests/mock_openxr/negotiation.hpp"
#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

constexpr XrSystemId the_system = 1;

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

template <std::size_t size>
void copy_text(char (&target)[size], const std::string& text) {
    const std::size_t length = std::min(text.size(), size - 1);
    std::memcpy(target, text.data(), length);
    target[length] = '\0';
}

XrResult XRAPI_CALL enumerate_extensions(const char* layer, std::uint32_t capacity, std::uint32_t* count,
                                         XrExtensionProperties* properties) {
    constexpr const char* name = "xrEnumerateInstanceExtensionProperties";
    return call(name, Level::global, [&](State& s, auto&) {
        if (layer != nullptr) return XR_ERROR_API_LAYER_NOT_PRESENT;
        return list(s, name, s.config.extensions, capacity, count, [&](std::size_t i, const std::string& e) {
            copy_text(properties[i].extensionName, e);
            properties[i].extensionVersion = 1;
        });
    });
}

XrResult XRAPI_CALL create(const XrInstanceCreateInfo* info, XrInstance* instance) {
    constexpr const char* name = "xrCreateInstance";
    return call(name, Level::global, [&](State& s, auto&) {
        if (s.instance) return refuse(s, name, XR_ERROR_LIMIT_REACHED, "is called while an instance exists");
        if (XR_VERSION_MAJOR(info->applicationInfo.apiVersion) != 1) return XR_ERROR_API_VERSION_UNSUPPORTED;
        Instance created;
        for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
            const std::string extension = info->enabledExtensionNames[i];
            if (!contains(s.config.extensions, extension))
                return refuse(s, name, XR_ERROR_EXTENSION_NOT_PRESENT,
                              fmt::format("enables {}, which is not offered", extension));
            created.extensions.insert(extension);
        }
        created.id = ++s.last_id;
        created.config = s.config;
        s.instance = std::move(created);
        s.notified_of_loss.clear();
        *instance = handle_of<XrInstance>(s.instance->id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy(XrInstance handle) {
    constexpr const char* name = "xrDestroyInstance";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance || id_of(handle) != s.instance->id)
        return refuse(s, name, XR_ERROR_HANDLE_INVALID,
                      s.ended.count(id_of(handle)) != 0 ? "destroys an object twice"
                                                        : "destroys a handle of no object");
    const Instance& instance = *s.instance;
    const auto leaked = [&](std::size_t count, const char* what) {
        if (count > 0) violate(s, name, fmt::format("leaks {} {}", count, what));
    };
    leaked(instance.session ? 1 : 0, "session(s)");
    leaked(instance.spaces.size(), "space(s)");
    leaked(instance.swapchains.size(), "swapchain(s)");
    leaked(instance.sets.size(), "action set(s)");
    leaked(instance.trackers.size(), "hand tracker(s)");
    drop_instance(s);
    write_report(s);
    return success;
}

XrResult XRAPI_CALL get_properties(XrInstance, XrInstanceProperties* properties) {
    return call("xrGetInstanceProperties", Level::instance, [&](State&, auto&) {
        properties->runtimeVersion = XR_MAKE_VERSION(1, 2, 3);
        copy_text(properties->runtimeName, "Mock runtime");
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL poll_event(XrInstance, XrEventDataBuffer* out) {
    return call("xrPollEvent", Level::instance, [&](State& s, auto&) {
        Instance& instance = *s.instance;
        if (instance.events.empty()) {
            const bool idle = !instance.session || !instance.session->running;
            if (idle) count_frame(s);
            return XR_EVENT_UNAVAILABLE;
        }
        *out = instance.events.front();
        instance.events.pop_front();
        if (out->type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) instance.lost = true;
        const auto* changed = reinterpret_cast<const XrEventDataSessionStateChanged*>(out);
        const bool session_lost = out->type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED &&
                                  changed->state == XR_SESSION_STATE_LOSS_PENDING && instance.session;
        if (session_lost) instance.session->lost = true;
        if (instance.lost || session_lost) {
            s.notified_of_loss.insert(std::this_thread::get_id());
            s.changed.notify_all();
        }
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL result_to_string(XrInstance, XrResult value, char* buffer) {
    const std::string text = fmt::format("result {}", static_cast<int>(value));
    std::memcpy(buffer, text.c_str(), std::min<std::size_t>(text.size() + 1, XR_MAX_RESULT_STRING_SIZE));
    return XR_SUCCESS;
}

XrResult XRAPI_CALL get_system(XrInstance, const XrSystemGetInfo* info, XrSystemId* system) {
    return call("xrGetSystem", Level::instance, [&](State& s, auto&) {
        if (!s.instance->session) count_frame(s);
        if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
        if (!s.config.connected) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
        *system = the_system;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL get_system_properties(XrInstance, XrSystemId system, XrSystemProperties* properties) {
    return call("xrGetSystemProperties", Level::instance, [&](State& s, auto&) {
        if (system != the_system) return XR_ERROR_SYSTEM_INVALID;
        const Config& config = s.instance->config;
        properties->systemId = the_system;
        copy_text(properties->systemName, "Mock headset");
        properties->graphicsProperties = {config.max_height, config.max_width,
                                          XR_MIN_COMPOSITION_LAYERS_SUPPORTED};
        properties->trackingProperties = {XR_TRUE, XR_TRUE};
        auto* next = static_cast<XrBaseOutStructure*>(properties->next);
        for (; next != nullptr; next = next->next) {
            if (next->type == XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT)
                reinterpret_cast<XrSystemHandTrackingPropertiesEXT*>(next)->supportsHandTracking =
                    config.tracks_hands ? XR_TRUE : XR_FALSE;
            if (next->type == XR_TYPE_SYSTEM_PASSTHROUGH_PROPERTIES_FB)
                reinterpret_cast<XrSystemPassthroughPropertiesFB*>(next)->supportsPassthrough =
                    config.has_cameras ? XR_TRUE : XR_FALSE;
            if (next->type == UserPresenceProperties().type)
                reinterpret_cast<UserPresenceProperties*>(next)->supported = XR_TRUE;
        }
        return XR_SUCCESS;
    });
}

XrViewConfigurationType view_type(const State& s) {
    return s.instance->config.eyes == 1 ? XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO
                                        : XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
}

XrResult XRAPI_CALL enumerate_view_types(XrInstance, XrSystemId, std::uint32_t capacity, std::uint32_t* count,
                                         XrViewConfigurationType* types) {
    constexpr const char* name = "xrEnumerateViewConfigurations";
    return call(name, Level::instance, [&](State& s, auto&) {
        return list(s, name, std::vector{view_type(s)}, capacity, count,
                    [&](std::size_t i, XrViewConfigurationType type) { types[i] = type; });
    });
}

XrResult XRAPI_CALL get_view_properties(XrInstance, XrSystemId, XrViewConfigurationType type,
                                        XrViewConfigurationProperties* properties) {
    return call("xrGetViewConfigurationProperties", Level::instance, [&](State& s, auto&) {
        if (type != view_type(s)) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
        properties->viewConfigurationType = type;
        properties->fovMutable = XR_FALSE;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL enumerate_views(XrInstance, XrSystemId, XrViewConfigurationType type,
                                    std::uint32_t capacity, std::uint32_t* count,
                                    XrViewConfigurationView* views) {
    constexpr const char* name = "xrEnumerateViewConfigurationViews";
    return call(name, Level::instance, [&](State& s, auto&) {
        if (type != view_type(s))
            return refuse(s, name, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
                          "requests a view configuration that is not offered");
        const Config& c = s.instance->config;
        XrViewConfigurationView view{XR_TYPE_VIEW_CONFIGURATION_VIEW};
        view.recommendedImageRectWidth = c.width;
        view.recommendedImageRectHeight = c.height;
        view.maxImageRectWidth = c.max_width;
        view.maxImageRectHeight = c.max_height;
        view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
        const std::vector<XrViewConfigurationView> all(c.eyes, view);
        return list(s, name, all, capacity, count,
                    [&](std::size_t i, const XrViewConfigurationView& v) { views[i] = v; });
    });
}

XrResult XRAPI_CALL enumerate_blend_modes(XrInstance, XrSystemId, XrViewConfigurationType,
                                          std::uint32_t capacity, std::uint32_t* count,
                                          XrEnvironmentBlendMode* modes) {
    constexpr const char* name = "xrEnumerateEnvironmentBlendModes";
    return call(name, Level::instance, [&](State& s, auto&) {
        return list(s, name, s.instance->config.blend_modes, capacity, count,
                    [&](std::size_t i, XrEnvironmentBlendMode mode) { modes[i] = mode; });
    });
}

XrResult XRAPI_CALL string_to_path(XrInstance, const char* text, XrPath* path) {
    constexpr const char* name = "xrStringToPath";
    return call(name, Level::instance, [&](State& s, auto&) {
        if (text == nullptr || text[0] != '/')
            return refuse(s, name, XR_ERROR_PATH_FORMAT_INVALID,
                          "is given a path that does not begin with /");
        std::vector<std::string>& paths = s.instance->paths;
        const auto found = std::find(paths.begin(), paths.end(), text);
        *path = static_cast<XrPath>(found - paths.begin()) + 1;
        if (found == paths.end()) paths.emplace_back(text);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL path_to_string(XrInstance, XrPath path, std::uint32_t capacity, std::uint32_t* count,
                                   char* buffer) {
    constexpr const char* name = "xrPathToString";
    return call(name, Level::instance, [&](State& s, auto&) {
        if (path == XR_NULL_PATH || path > s.instance->paths.size())
            return refuse(s, name, XR_ERROR_PATH_INVALID, "is given a path that does not exist");
        const std::string& text = s.instance->paths[path - 1];
        *count = static_cast<std::uint32_t>(text.size() + 1);
        if (capacity == 0) return XR_SUCCESS;
        if (capacity < text.size() + 1) return XR_ERROR_SIZE_INSUFFICIENT;
        std::memcpy(buffer, text.c_str(), text.size() + 1);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL graphics_requirements(XrInstance, XrSystemId, XrGraphicsRequirementsVulkan2KHR* needs) {
    return call("xrGetVulkanGraphicsRequirements2KHR", Level::instance, [&](State& s, auto&) {
        needs->minApiVersionSupported = s.instance->config.min_vulkan;
        needs->maxApiVersionSupported = XR_MAKE_VERSION(1, 1023, 4095);
        s.instance->requirements_queried = true;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL create_vulkan_instance(XrInstance, const XrVulkanInstanceCreateInfoKHR* info,
                                           VkInstance* vulkan, VkResult* result) {
    return call("xrCreateVulkanInstanceKHR", Level::instance, [&](State& s, auto&) {
        VulkanObjects& created = s.instance->created;
        *result = create_instance(created, info->pfnGetInstanceProcAddr, *info->vulkanCreateInfo,
                                  info->vulkanAllocator);
        *vulkan = created.instance;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL graphics_device(XrInstance, const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                    VkPhysicalDevice* physical) {
    constexpr const char* name = "xrGetVulkanGraphicsDevice2KHR";
    return call(name, Level::instance, [&](State& s, auto&) {
        VulkanObjects& created = s.instance->created;
        if (info->vulkanInstance == VK_NULL_HANDLE || info->vulkanInstance != created.instance)
            return refuse(s, name, XR_ERROR_HANDLE_INVALID,
                          "is given a Vulkan instance that the runtime did not make");
        if (find_physical_device(created) != VK_SUCCESS) return XR_ERROR_RUNTIME_FAILURE;
        static int foreign = 0;
        *physical =
            s.instance->config.foreign_gpu ? reinterpret_cast<VkPhysicalDevice>(&foreign) : created.physical;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL create_vulkan_device(XrInstance, const XrVulkanDeviceCreateInfoKHR* info,
                                         VkDevice* device, VkResult* result) {
    constexpr const char* name = "xrCreateVulkanDeviceKHR";
    return call(name, Level::instance, [&](State& s, auto&) {
        VulkanObjects& created = s.instance->created;
        if (info->vulkanPhysicalDevice == VK_NULL_HANDLE || info->vulkanPhysicalDevice != created.physical)
            return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is given another GPU than the headset's");
        *result = create_device(created, *info->vulkanCreateInfo, info->vulkanAllocator);
        *device = created.device;
        return XR_SUCCESS;
    });
}

// The mock's clock is the steady clock, or time passes with the frames only.
XrResult XRAPI_CALL convert_timespec(XrInstance, const timespec* time, XrTime* converted) {
    return call("xrConvertTimespecTimeToTimeKHR", Level::instance, [&](State& s, auto&) {
        *converted =
            s.instance->config.real_time ? XrTime{time->tv_sec} * 1'000'000'000 + time->tv_nsec : now(s);
        return XR_SUCCESS;
    });
}

}  // namespace

void add_instance_functions(FunctionTable& table) {
    add(table, "xrEnumerateInstanceExtensionProperties", &enumerate_extensions);
    add(table, "xrCreateInstance", &create);
    add(table, "xrDestroyInstance", &destroy);
    add(table, "xrGetInstanceProperties", &get_properties);
    add(table, "xrPollEvent", &poll_event);
    add(table, "xrResultToString", &result_to_string);
    add(table, "xrGetSystem", &get_system);
    add(table, "xrGetSystemProperties", &get_system_properties);
    add(table, "xrEnumerateViewConfigurations", &enumerate_view_types);
    add(table, "xrGetViewConfigurationProperties", &get_view_properties);
    add(table, "xrEnumerateViewConfigurationViews", &enumerate_views);
    add(table, "xrEnumerateEnvironmentBlendModes", &enumerate_blend_modes);
    add(table, "xrStringToPath", &string_to_path);
    add(table, "xrPathToString", &path_to_string);
    add(table, "xrGetVulkanGraphicsRequirements2KHR", &graphics_requirements);
    add(table, "xrCreateVulkanInstanceKHR", &create_vulkan_instance);
    add(table, "xrGetVulkanGraphicsDevice2KHR", &graphics_device);
    add(table, "xrCreateVulkanDeviceKHR", &create_vulkan_device);
    add(table, "xrConvertTimespecTimeToTimeKHR", &convert_timespec);
}

}  // namespace bolt::mock
