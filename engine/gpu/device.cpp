#include "engine/gpu/device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <utility>

namespace bolt::gpu {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                       VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
    std::string message = data->pMessage != nullptr ? data->pMessage : "";
    // Newer layers name the rule beside the message, not in it.
    if (data->pMessageIdName != nullptr && message.find(data->pMessageIdName) == std::string::npos)
        message = fmt::format("[ {} ] {}", data->pMessageIdName, message);
    static_cast<ValidationLog*>(log)->messages.push_back(std::move(message));
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog& log) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = collect;
    info.pUserData = &log;
    return info;
}

bool has_layer(const char* wanted) {
    std::vector<VkLayerProperties> layers;
    (void)enumerate(layers, [](std::uint32_t* count, VkLayerProperties* values) {
        return vkEnumerateInstanceLayerProperties(count, values);
    });
    return std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, wanted) == 0;
    });
}

}  // namespace

Result<Instance> Instance::create(const InstanceOptions& options) {
    if (volkInitialize() != VK_SUCCESS)
        return fail(ErrorCode::no_device, "Vulkan is not installed",
                    "a Vulkan loader and driver (mesa-vulkan-drivers renders without a GPU)");
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3)
        return fail(ErrorCode::no_device, "the Vulkan loader is too old", "Vulkan 1.3");
    if (options.validation && !has_layer(validation_layer))
        return fail(ErrorCode::failed, "the Vulkan validation layer is not installed",
                    "vulkan-validationlayers");

    Instance instance;
    instance.log_ = options.log ? options.log : std::make_shared<ValidationLog>();
    std::vector<const char*> extensions(options.extensions.begin(), options.extensions.end());
    if (options.validation) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = application.pEngineName = "boltwright";
    application.apiVersion = VK_API_VERSION_1_3;

    const VkValidationFeatureEnableEXT synchronization =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(*instance.log_);
    messenger.pNext = &features;

    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (options.validation) {
        info.pNext = &messenger;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
    }
    if (options.creator != nullptr) {
        BOLT_TRY_ASSIGN(instance.instance_, options.creator->create_instance(info));
    } else {
        BOLT_TRY(
            check(vkCreateInstance(&info, nullptr, &instance.instance_), "creating the Vulkan instance"));
    }
    volkLoadInstance(instance.instance_);
    if (options.validation) {
        messenger.pNext = nullptr;
        const VkResult registered =
            vkCreateDebugUtilsMessengerEXT(instance.instance_, &messenger, nullptr, &instance.messenger_);
        BOLT_TRY(check(registered, "registering the validation callback"));
    }
    return instance;
}

Instance::Instance(Instance&& other) noexcept
    : instance_(std::exchange(other.instance_, VK_NULL_HANDLE)),
      messenger_(std::exchange(other.messenger_, VK_NULL_HANDLE)),
      log_(std::move(other.log_)) {}

Instance& Instance::operator=(Instance&& other) noexcept {
    std::swap(instance_, other.instance_);
    std::swap(messenger_, other.messenger_);
    std::swap(log_, other.log_);
    return *this;
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

struct DeviceTypeRank {
    int rank;  // the highest is preferred
    const char* name;
};

DeviceTypeRank rank_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return {4, "discrete GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return {3, "integrated GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return {2, "virtual GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return {1, "software"};
        default:
            return {0, "other"};
    }
}

// Returns why the device cannot be used; empty: it can be used.
std::string unusable_reason(const DeviceCandidate& candidate, const std::string& wanted) {
    if (!wanted.empty() && lower(candidate.name).find(lower(wanted)) == std::string::npos)
        return fmt::format("does not match \"{}\"", wanted);
    if (candidate.api_version < VK_API_VERSION_1_3)
        return fmt::format("supports only Vulkan {}.{}, needs 1.3",
                           VK_API_VERSION_MAJOR(candidate.api_version),
                           VK_API_VERSION_MINOR(candidate.api_version));
    if (!candidate.missing.empty()) return fmt::format("lacks {}", fmt::join(candidate.missing, ", "));
    if (!candidate.presents) return "cannot present to this display";
    return {};
}

}  // namespace

DeviceChoice choose_device(std::span<const DeviceCandidate> candidates, const std::string& wanted) {
    DeviceChoice choice;
    std::vector<std::string> unusable;  // by candidate
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DeviceCandidate& candidate = candidates[i];
        unusable.push_back(unusable_reason(candidate, wanted));
        if (!unusable.back().empty()) continue;
        const auto value = [](const DeviceCandidate& c) {
            return std::pair{rank_of(c.type).rank, c.device_memory};
        };
        if (choice.index < 0 || value(candidate) > value(candidates[static_cast<std::size_t>(choice.index)]))
            choice.index = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const std::string verdict = !unusable[i].empty() ? unusable[i]
                                    : static_cast<int>(i) == choice.index
                                        ? std::string("used")
                                        : std::string("can be used, but is not the fastest");
        choice.reasons.push_back(fmt::format("{} ({}, {}): {}", candidates[i].name,
                                             rank_of(candidates[i].type).name, candidates[i].driver,
                                             verdict));
    }
    return choice;
}

namespace {

// The chain of Vulkan's feature structures, both to query features and to enable them.
struct DeviceFeatures {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

    DeviceFeatures() {
        core.pNext = &v11;
        v11.pNext = &v13;
    }
    DeviceFeatures(const DeviceFeatures&) = delete;
    DeviceFeatures& operator=(const DeviceFeatures&) = delete;
};

struct RequiredFeature {
    const char* name;
    VkBool32& (*flag)(DeviceFeatures&);
};

constexpr RequiredFeature required_features[] = {
    {"dynamicRendering", [](DeviceFeatures& f) -> VkBool32& { return f.v13.dynamicRendering; }},
    {"synchronization2", [](DeviceFeatures& f) -> VkBool32& { return f.v13.synchronization2; }},
    {"maintenance4", [](DeviceFeatures& f) -> VkBool32& { return f.v13.maintenance4; }},
    {"multiview", [](DeviceFeatures& f) -> VkBool32& { return f.v11.multiview; }},
    {"depthClamp", [](DeviceFeatures& f) -> VkBool32& { return f.core.features.depthClamp; }},
    {"imageCubeArray", [](DeviceFeatures& f) -> VkBool32& { return f.core.features.imageCubeArray; }},
    {"independentBlend", [](DeviceFeatures& f) -> VkBool32& { return f.core.features.independentBlend; }},
};

// Returns a queue family with graphics and compute that can present to the surface; if none can present, any
// with graphics and compute; nullopt if there is none. A null surface needs no presentation.
std::optional<std::uint32_t> find_queue_family(VkPhysicalDevice physical, VkSurfaceKHR surface,
                                               bool& presents) {
    std::vector<VkQueueFamilyProperties> families;
    (void)enumerate(families, [&](std::uint32_t* count, VkQueueFamilyProperties* values) {
        vkGetPhysicalDeviceQueueFamilyProperties(physical, count, values);
        return VK_SUCCESS;
    });
    std::optional<std::uint32_t> without_present;
    presents = surface == VK_NULL_HANDLE;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[i].queueFlags & both) != both) continue;
        if (!without_present) without_present = i;
        VkBool32 supported = VK_FALSE;
        if (surface == VK_NULL_HANDLE) return i;
        if (vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface, &supported) == VK_SUCCESS &&
            supported == VK_TRUE) {
            presents = true;
            return i;
        }
    }
    return without_present;
}

bool has_extension(VkPhysicalDevice physical, const char* wanted) {
    std::vector<VkExtensionProperties> extensions;
    (void)enumerate(extensions, [&](std::uint32_t* count, VkExtensionProperties* values) {
        return vkEnumerateDeviceExtensionProperties(physical, nullptr, count, values);
    });
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, wanted) == 0;
    });
}

// Components between shader stages that shaders/light.vert needs: 25 rows of 4 and the position. Vulkan
// guarantees only 64.
constexpr std::uint32_t required_components = 104;

DeviceCandidate describe(VkPhysicalDevice physical, VkSurfaceKHR surface) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &properties);

    DeviceCandidate candidate;
    candidate.name = properties.properties.deviceName;
    candidate.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    candidate.type = properties.properties.deviceType;
    candidate.api_version = properties.properties.apiVersion;
    if (candidate.api_version < VK_API_VERSION_1_3) return candidate;  // the queries below need Vulkan 1.3

    DeviceFeatures features;
    vkGetPhysicalDeviceFeatures2(physical, &features.core);
    for (const RequiredFeature& feature : required_features)
        if (feature.flag(features) != VK_TRUE) candidate.missing.emplace_back(feature.name);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    if (std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) < required_components)
        candidate.missing.emplace_back("104 components between vertex and fragment shaders");
    if (!find_queue_family(physical, surface, candidate.presents))
        candidate.missing.emplace_back("a queue with graphics and compute");
    if (surface != VK_NULL_HANDLE && !has_extension(physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        candidate.presents = false;

    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
            candidate.device_memory = std::max(candidate.device_memory, memory.memoryHeaps[i].size);
    return candidate;
}

}  // namespace

Result<DeviceSurvey> survey_devices(const Instance& instance, const DeviceOptions& options) {
    DeviceSurvey survey;
    const VkResult listed = enumerate(survey.physical, [&](std::uint32_t* count, VkPhysicalDevice* values) {
        return vkEnumeratePhysicalDevices(instance.get(), count, values);
    });
    BOLT_TRY(check(listed, "enumerating GPUs"));
    for (const VkPhysicalDevice physical : survey.physical)
        survey.candidates.push_back(describe(physical, options.surface));
    survey.choice = choose_device(survey.candidates, options.wanted);
    return survey;
}

namespace {

// Fails if no device can be used, or if the headset's device cannot be used or is not the wanted one.
Result<std::size_t> choose(const Instance& instance, const DeviceOptions& options, DeviceSurvey& survey) {
    if (options.creator != nullptr) {
        BOLT_TRY_ASSIGN(const auto required, options.creator->choose_gpu(instance.get()));
        const auto at = std::find(survey.physical.begin(), survey.physical.end(), required);
        if (at == survey.physical.end())
            return fail(ErrorCode::no_device, "the headset is connected to a GPU that Vulkan does not list",
                        "a driver of that GPU");
        const auto index = static_cast<std::size_t>(at - survey.physical.begin());
        if (const std::string reason = unusable_reason(survey.candidates[index], options.wanted);
            !reason.empty())
            return fail(ErrorCode::no_device,
                        fmt::format("the headset's GPU, {}, {}", survey.candidates[index].name, reason),
                        "a GPU and a driver that have what is missing");
        return index;
    }
    if (survey.choice.index < 0)
        return fail(ErrorCode::no_device,
                    survey.physical.empty() ? "no Vulkan device was found"
                                            : fmt::format("no Vulkan device is usable: {}",
                                                          fmt::join(survey.choice.reasons, "; ")),
                    "a Vulkan 1.3 device; mesa-vulkan-drivers renders without a GPU");
    return static_cast<std::size_t>(survey.choice.index);
}

// A software renderer allocates and frees tens of megabytes for each picture. By chance of the heap's layout,
// glibc returns them to the system each time and the next picture faults them in again, which has made
// pictures with many triangles 1.5 times as expensive. The values are the largest that glibc itself adapts to
// (mallopt(3)). They hold for the whole process.
void keep_freed_memory() {
    (void)mallopt(M_MMAP_THRESHOLD, 32 << 20);
    (void)mallopt(M_TRIM_THRESHOLD, 64 << 20);
}

}  // namespace

Result<std::unique_ptr<Device>> Device::create(const Instance& instance, const DeviceOptions& options) {
    BOLT_TRY_ASSIGN(auto survey, survey_devices(instance, options));
    BOLT_TRY_ASSIGN(const auto index, choose(instance, options, survey));

    std::unique_ptr<Device> device(new Device());
    device->instance_ = instance.get();
    device->physical_ = survey.physical[index];
    device->name_ = survey.candidates[index].name;
    device->driver_ = survey.candidates[index].driver;
    vkGetPhysicalDeviceProperties(device->physical_, &device->properties_);
    if (device->properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) keep_freed_memory();
    bool presents = false;
    device->queue_family_ = find_queue_family(device->physical_, options.surface, presents).value();

    DeviceFeatures features;
    for (const RequiredFeature& feature : required_features) feature.flag(features) = VK_TRUE;
    VkPhysicalDeviceFeatures available{};
    vkGetPhysicalDeviceFeatures(device->physical_, &available);
    features.core.features.samplerAnisotropy = available.samplerAnisotropy;

    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = device->queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &features.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    if (options.surface != VK_NULL_HANDLE) {
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &swapchain;
    }
    if (options.creator != nullptr) {
        BOLT_TRY_ASSIGN(device->device_, options.creator->create_device(device->physical_, info));
    } else {
        BOLT_TRY(check(vkCreateDevice(device->physical_, &info, nullptr, &device->device_),
                       fmt::format("creating a device on {}", device->name_)));
    }
    volkLoadDevice(device->device_);
    vkGetDeviceQueue(device->device_, device->queue_family_, 0, &device->queue_);
    device->memory_ = std::make_unique<Memory>(device->physical_, device->device_);
    return device;
}

Device::~Device() {
    if (device_ == VK_NULL_HANDLE) return;
    vkDeviceWaitIdle(device_);
    memory_.reset();
    vkDestroyDevice(device_, nullptr);
}

}  // namespace bolt::gpu
