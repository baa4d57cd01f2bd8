#include "engine/gpu/device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace bolt::gpu {

namespace {

// The features that the engine uses, as a chain both for the query and for enabling them.
struct Features {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

    Features() {
        core.pNext = &v11;
        v11.pNext = &v13;
    }
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
};

struct Required {
    const char* name;
    VkBool32& (*of)(Features&);
};

constexpr Required required[] = {
    {"dynamicRendering", [](Features& f) -> VkBool32& { return f.v13.dynamicRendering; }},
    {"synchronization2", [](Features& f) -> VkBool32& { return f.v13.synchronization2; }},
    {"maintenance4", [](Features& f) -> VkBool32& { return f.v13.maintenance4; }},
    {"multiview", [](Features& f) -> VkBool32& { return f.v11.multiview; }},
    {"depthClamp", [](Features& f) -> VkBool32& { return f.core.features.depthClamp; }},
    {"imageCubeArray", [](Features& f) -> VkBool32& { return f.core.features.imageCubeArray; }},
};

// A queue family with graphics and compute and, if there is a surface, presentation.
std::optional<std::uint32_t> find_queue_family(VkPhysicalDevice physical, VkSurfaceKHR surface,
                                               bool& presents) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    std::optional<std::uint32_t> drawing;
    presents = surface == VK_NULL_HANDLE;
    for (std::uint32_t i = 0; i < count; ++i) {
        constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[i].queueFlags & both) != both) continue;
        if (!drawing) drawing = i;
        VkBool32 shows = VK_FALSE;
        if (surface == VK_NULL_HANDLE) return i;
        if (vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface, &shows) == VK_SUCCESS &&
            shows == VK_TRUE) {
            presents = true;
            return i;
        }
    }
    return drawing;
}

bool has_extension(VkPhysicalDevice physical, const char* wanted) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, wanted) == 0;
    });
}

// Used by shaders/light.vert: 25 rows of 4 and the position. Vulkan guarantees only 64.
constexpr std::uint32_t most_passed_on = 104;

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

    Features features;
    vkGetPhysicalDeviceFeatures2(physical, &features.core);
    for (const Required& feature : required)
        if (feature.of(features) != VK_TRUE) candidate.missing.emplace_back(feature.name);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    if (std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) < most_passed_on)
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
    DeviceSurvey found;
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance.get(), &count, nullptr);
    found.physical.resize(count);
    if (Status listed = check(vkEnumeratePhysicalDevices(instance.get(), &count, found.physical.data()),
                              "enumerating GPUs");
        !listed)
        return fail(listed.error());
    for (const VkPhysicalDevice physical : found.physical)
        found.candidates.push_back(describe(physical, options.surface));
    found.choice = choose_device(found.candidates, options.wanted);
    return found;
}

Result<std::unique_ptr<Device>> Device::create(const Instance& instance, const DeviceOptions& options) {
    BOLT_TRY_ASSIGN(auto found, survey_devices(instance, options));
    if (found.choice.index < 0)
        return fail(ErrorCode::no_device,
                    found.physical.empty() ? "no Vulkan device found"
                                           : fmt::format("no Vulkan device is usable: {}",
                                                         fmt::join(found.choice.reasons, "; ")),
                    "a Vulkan 1.3 device; mesa-vulkan-drivers renders without a GPU");
    const auto index = static_cast<std::size_t>(found.choice.index);

    std::unique_ptr<Device> device(new Device());
    device->physical_ = found.physical[index];
    device->name_ = found.candidates[index].name;
    device->driver_ = found.candidates[index].driver;
    vkGetPhysicalDeviceProperties(device->physical_, &device->properties_);
    bool presents = false;
    device->queue_family_ = find_queue_family(device->physical_, options.surface, presents).value();

    Features features;
    for (const Required& feature : required) feature.of(features) = VK_TRUE;
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
    if (Status made = check(vkCreateDevice(device->physical_, &info, nullptr, &device->device_),
                            fmt::format("creating a device on {}", device->name_));
        !made)
        return fail(made.error());
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
