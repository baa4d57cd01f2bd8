// The mock's instance: negotiation with the loader, properties, Vulkan, and its control.
#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock_openxr {

State& state() {
    static State* one = [] {
        auto* made = new State();  // outlives the threads of the client
        load_script(*made);
        return made;
    }();
    return *one;
}

std::optional<XrResult> injected(State& s, const char* function) {
    if (const auto found = s.failures.find(function); found != s.failures.end() && found->second.second > 0) {
        --found->second.second;
        if (found->second.first == XR_ERROR_INSTANCE_LOST) s.instance_lost = true;
        if (found->second.first == XR_ERROR_SESSION_LOST) s.session_lost = true;
        return found->second.first;
    }
    const bool destroys = std::strncmp(function, "xrDestroy", 9) == 0;
    if (destroys) return std::nullopt;
    if (s.instance_lost) return XR_ERROR_INSTANCE_LOST;
    const std::string name(function);
    const bool of_instance = name == "xrPollEvent" || name.find("Instance") != std::string::npos ||
                             name.find("Path") != std::string::npos || name == "xrGetSystem";
    if (s.session_lost && !of_instance) return XR_ERROR_SESSION_LOST;
    return std::nullopt;
}

namespace {

template <std::size_t size>
void copy_text(char (&to)[size], const std::string& from) {
    std::strncpy(to, from.c_str(), size - 1);
    to[size - 1] = '\0';
}

template <class T>
XrResult list(const std::vector<T>& all, std::uint32_t capacity, std::uint32_t* count, T* values) {
    *count = static_cast<std::uint32_t>(all.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
    std::copy(all.begin(), all.end(), values);
    return XR_SUCCESS;
}

XrResult enumerate_extensions(const char* layer, std::uint32_t capacity, std::uint32_t* count,
                              XrExtensionProperties* values) {
    MOCK_ENTER("xrEnumerateInstanceExtensionProperties");
    if (layer != nullptr) return XR_ERROR_API_LAYER_NOT_PRESENT;
    *count = static_cast<std::uint32_t>(s.config.extensions.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    for (std::size_t i = 0; i < s.config.extensions.size(); ++i) {
        copy_text(values[i].extensionName, s.config.extensions[i]);
        values[i].extensionVersion = 1;
    }
    return XR_SUCCESS;
}

XrResult create_instance(const XrInstanceCreateInfo* info, XrInstance* instance) {
    MOCK_ENTER("xrCreateInstance");
    if (s.instance) s.violation("xrCreateInstance while another instance exists");
    s.enabled.clear();
    for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
        const std::string name = info->enabledExtensionNames[i];
        const auto& offered = s.config.extensions;
        if (std::find(offered.begin(), offered.end(), name) == offered.end())
            return XR_ERROR_EXTENSION_NOT_PRESENT;
        s.enabled.insert(name);
    }
    s.instance = true;
    s.instance_lost = s.session_lost = false;
    s.requirements_queried = false;
    s.events.clear();
    s.stage_origin = s.local_origin = {};
    *instance = reinterpret_cast<XrInstance>(&s);
    return XR_SUCCESS;
}

void append_report(State& s) {
    const char* file = std::getenv("MOCK_OPENXR_REPORT");
    if (file == nullptr) return;
    std::ofstream out(file, std::ios::app);
    out << "frames " << s.ended << "\n";
    for (const std::string& violation : s.violations) out << "violation: " << violation << "\n";
}

XrResult destroy_instance(XrInstance) {
    MOCK_ENTER("xrDestroyInstance");
    if (!s.instance) s.violation("xrDestroyInstance without an instance");
    if (s.session) s.violation("xrDestroyInstance while a session exists");
    if (!s.spaces.empty() || !s.swapchains.empty() || s.action_sets != 0 || s.hand_trackers != 0)
        s.violation("xrDestroyInstance while " + std::to_string(s.spaces.size()) + " spaces, " +
                    std::to_string(s.swapchains.size()) + " swapchains, " + std::to_string(s.action_sets) +
                    " action sets and " + std::to_string(s.hand_trackers) + " hand trackers exist");
    s.instance = s.instance_lost = s.session_lost = false;
    append_report(s);
    return XR_SUCCESS;
}

XrResult instance_properties(XrInstance, XrInstanceProperties* properties) {
    MOCK_ENTER("xrGetInstanceProperties");
    copy_text(properties->runtimeName, "Mock OpenXR");
    properties->runtimeVersion = XR_MAKE_VERSION(1, 2, 3);
    return XR_SUCCESS;
}

XrResult get_system(XrInstance, const XrSystemGetInfo* info, XrSystemId* system) {
    MOCK_ENTER("xrGetSystem");
    if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
    if (!s.config.headset) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
    *system = 1;
    return XR_SUCCESS;
}

XrResult system_properties(XrInstance, XrSystemId, XrSystemProperties* properties) {
    MOCK_ENTER("xrGetSystemProperties");
    copy_text(properties->systemName, "Mock headset");
    properties->graphicsProperties = {1024, 1024, 16};
    properties->trackingProperties = {XR_TRUE, XR_TRUE};
    auto* next = static_cast<XrBaseOutStructure*>(properties->next);
    if (next != nullptr && next->type == XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT)
        reinterpret_cast<XrSystemHandTrackingPropertiesEXT*>(next)->supportsHandTracking = XR_TRUE;
    return XR_SUCCESS;
}

XrResult view_configurations(XrInstance, XrSystemId, std::uint32_t capacity, std::uint32_t* count,
                             XrViewConfigurationType* values) {
    MOCK_ENTER("xrEnumerateViewConfigurations");
    return list<XrViewConfigurationType>({s.config.eyes == 2 ? XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO
                                                             : XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO},
                                         capacity, count, values);
}

XrResult views(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity, std::uint32_t* count,
               XrViewConfigurationView* values) {
    MOCK_ENTER("xrEnumerateViewConfigurationViews");
    XrViewConfigurationView view{XR_TYPE_VIEW_CONFIGURATION_VIEW};
    view.recommendedImageRectWidth = s.config.width;
    view.recommendedImageRectHeight = s.config.height;
    view.maxImageRectWidth = 2 * s.config.width;
    view.maxImageRectHeight = 2 * s.config.height;
    view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
    return list(std::vector<XrViewConfigurationView>(static_cast<std::size_t>(s.config.eyes), view), capacity,
                count, values);
}

XrResult blend_modes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                     std::uint32_t* count, XrEnvironmentBlendMode* values) {
    MOCK_ENTER("xrEnumerateEnvironmentBlendModes");
    return list(s.config.blend_modes, capacity, count, values);
}

XrResult poll_event(XrInstance, XrEventDataBuffer* event) {
    MOCK_ENTER("xrPollEvent");
    if (s.put_on_at && std::chrono::steady_clock::now() > *s.put_on_at && s.state == XR_SESSION_STATE_IDLE) {
        s.put_on_at.reset();
        apply_event(s, Event::put_on);
    }
    if (s.events.empty()) return XR_EVENT_UNAVAILABLE;
    *event = s.events.front();
    s.events.pop_front();
    return XR_SUCCESS;
}

XrResult string_to_path(XrInstance, const char* text, XrPath* path) {
    MOCK_ENTER("xrStringToPath");
    const auto found = std::find(s.paths.begin(), s.paths.end(), text);
    *path = static_cast<XrPath>(found - s.paths.begin());
    if (found == s.paths.end()) s.paths.emplace_back(text);
    return XR_SUCCESS;
}

XrResult path_to_string(XrInstance, XrPath path, std::uint32_t capacity, std::uint32_t* count, char* text) {
    MOCK_ENTER("xrPathToString");
    if (path >= s.paths.size()) return XR_ERROR_PATH_INVALID;
    *count = static_cast<std::uint32_t>(s.paths[path].size() + 1);
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    std::memcpy(text, s.paths[path].c_str(), *count);
    return XR_SUCCESS;
}

XrResult result_to_string(XrInstance, XrResult result, char text[XR_MAX_RESULT_STRING_SIZE]) {
    std::snprintf(text, XR_MAX_RESULT_STRING_SIZE, "%d", static_cast<int>(result));
    return XR_SUCCESS;
}

XrResult graphics_requirements(XrInstance, XrSystemId, XrGraphicsRequirementsVulkan2KHR* needs) {
    MOCK_ENTER("xrGetVulkanGraphicsRequirements2KHR");
    needs->minApiVersionSupported =
        s.config.needs_newer_vulkan ? XR_MAKE_VERSION(1, 9, 0) : XR_MAKE_VERSION(1, 0, 0);
    needs->maxApiVersionSupported = XR_MAKE_VERSION(2, 0, 0);
    s.requirements_queried = true;
    return XR_SUCCESS;
}

XrResult create_vulkan_instance(XrInstance, const XrVulkanInstanceCreateInfoKHR* info, VkInstance* instance,
                                VkResult* result) {
    MOCK_ENTER("xrCreateVulkanInstanceKHR");
    s.vulkan = {};
    s.vulkan.get_instance = info->pfnGetInstanceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(info->pfnGetInstanceProcAddr(nullptr, "vkCreateInstance"));
    *result = create(info->vulkanCreateInfo, info->vulkanAllocator, instance);
    s.vulkan.instance = *instance;
    return XR_SUCCESS;
}

XrResult graphics_device(XrInstance, const XrVulkanGraphicsDeviceGetInfoKHR* info, VkPhysicalDevice* gpu) {
    MOCK_ENTER("xrGetVulkanGraphicsDevice2KHR");
    if (info->vulkanInstance != s.vulkan.instance)
        s.violation("xrGetVulkanGraphicsDevice2KHR for an instance that the runtime did not make");
    std::uint32_t count = 1;
    s.vulkan.of_instance<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices")(s.vulkan.instance,
                                                                                       &count, gpu);
    s.vulkan.gpu = *gpu;
    return count > 0 ? XR_SUCCESS : XR_ERROR_RUNTIME_FAILURE;
}

XrResult create_vulkan_device(XrInstance, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* device,
                              VkResult* result) {
    MOCK_ENTER("xrCreateVulkanDeviceKHR");
    if (info->vulkanPhysicalDevice != s.vulkan.gpu)
        s.violation("xrCreateVulkanDeviceKHR on another GPU than the headset's");
    *result = s.vulkan.of_instance<PFN_vkCreateDevice>("vkCreateDevice")(
        info->vulkanPhysicalDevice, info->vulkanCreateInfo, info->vulkanAllocator, device);
    s.vulkan.device = *device;
    s.vulkan.get_device = s.vulkan.of_instance<PFN_vkGetDeviceProcAddr>("vkGetDeviceProcAddr");
    return XR_SUCCESS;
}

XrResult get_proc(XrInstance, const char* name, PFN_xrVoidFunction* function);

const Functions& functions() {
    static const Functions all = [] {
        Functions f{
            {"xrGetInstanceProcAddr", as_void(get_proc)},
            {"xrEnumerateInstanceExtensionProperties", as_void(enumerate_extensions)},
            {"xrCreateInstance", as_void(create_instance)},
            {"xrDestroyInstance", as_void(destroy_instance)},
            {"xrGetInstanceProperties", as_void(instance_properties)},
            {"xrGetSystem", as_void(get_system)},
            {"xrGetSystemProperties", as_void(system_properties)},
            {"xrEnumerateViewConfigurations", as_void(view_configurations)},
            {"xrEnumerateViewConfigurationViews", as_void(views)},
            {"xrEnumerateEnvironmentBlendModes", as_void(blend_modes)},
            {"xrPollEvent", as_void(poll_event)},
            {"xrStringToPath", as_void(string_to_path)},
            {"xrPathToString", as_void(path_to_string)},
            {"xrResultToString", as_void(result_to_string)},
            {"xrGetVulkanGraphicsRequirements2KHR", as_void(graphics_requirements)},
            {"xrCreateVulkanInstanceKHR", as_void(create_vulkan_instance)},
            {"xrGetVulkanGraphicsDevice2KHR", as_void(graphics_device)},
            {"xrCreateVulkanDeviceKHR", as_void(create_vulkan_device)},
        };
        add_session_functions(f);
        add_image_functions(f);
        add_action_functions(f);
        return f;
    }();
    return all;
}

XrResult get_proc(XrInstance, const char* name, PFN_xrVoidFunction* function) {
    const auto found = functions().find(name);
    *function = found != functions().end() ? found->second : nullptr;
    return *function != nullptr ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

class TheControl final : public Control {
  public:
    void configure(const Config& config) override {
        State& s = mock_openxr::state();
        const std::lock_guard lock(s.mutex);
        s.config = config;
        s.head = {};
        s.hands = {};
        s.should_render = true;
        s.session = s.running = s.instance = s.instance_lost = s.session_lost = false;
        s.spaces.clear();
        s.action_sets = s.hand_trackers = 0;
        s.blocked = s.record_pictures = false;
        s.last_frame = {};
        s.waited = s.begun = s.ended = 0;
        s.vibrations.clear();
        s.violations.clear();
        s.failures.clear();
        s.changed.notify_all();
    }
    void set_head(const Head& head) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().head = head;
    }
    void set_hand(int side, const Hand& hand) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().hands.at(static_cast<std::size_t>(side)) = hand;
    }
    void send(Event event) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        apply_event(mock_openxr::state(), event);
    }
    void should_render(bool renders) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().should_render = renders;
    }
    void block_frames(bool blocks) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().blocked = blocks;
        mock_openxr::state().changed.notify_all();
    }
    void fail_next(const std::string& function, XrResult result, int count) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().failures[function] = {result, count};
    }
    void record_pictures(bool records) override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        mock_openxr::state().record_pictures = records;
    }
    XrSessionState state() override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        return mock_openxr::state().state;
    }
    std::uint64_t frame_count() override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        return mock_openxr::state().ended;
    }
    std::optional<FrameRecord> last_frame() override {
        State& s = mock_openxr::state();
        const std::lock_guard lock(s.mutex);
        return s.ended > 0 ? std::optional(s.last_frame) : std::nullopt;
    }
    std::vector<VibrationRecord> vibrations() override {
        const std::lock_guard lock(mock_openxr::state().mutex);
        return mock_openxr::state().vibrations;
    }
    std::vector<std::string> violations() override {
        State& s = mock_openxr::state();
        const std::lock_guard lock(s.mutex);
        return std::exchange(s.violations, {});
    }
};

}  // namespace
}  // namespace bolt::mock_openxr

// What the loader and a runtime tell each other (OpenXR loader specification); the header is newer than
// Debian 12's.
struct NegotiateLoaderInfo {
    int struct_type;
    std::uint32_t struct_version;
    std::size_t struct_size;
    std::uint32_t min_interface, max_interface;
    XrVersion min_api, max_api;
};
struct NegotiateRuntimeRequest {
    int struct_type;
    std::uint32_t struct_version;
    std::size_t struct_size;
    std::uint32_t interface;
    XrVersion api;
    PFN_xrGetInstanceProcAddr get_proc;
};

extern "C" {

__attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const NegotiateLoaderInfo* loader, NegotiateRuntimeRequest* runtime) {
    if (loader->min_interface > 1 || loader->max_interface < 1) return XR_ERROR_INITIALIZATION_FAILED;
    runtime->interface = 1;
    runtime->api = XR_MAKE_VERSION(1, 0, 0);
    runtime->get_proc = &bolt::mock_openxr::get_proc;
    return XR_SUCCESS;
}

__attribute__((visibility("default"))) bolt::mock_openxr::Control* mock_openxr_control() {
    static bolt::mock_openxr::TheControl control;
    return &control;
}
}
