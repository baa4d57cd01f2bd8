// The Vulkan instance, window surfaces, the choice of a GPU, the logical device, and the policy after its
// loss.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/memory.hpp"
#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// All warnings and errors of the validation layers for the instances that use this log. A correct program
// causes none.
struct ValidationLog {
    std::vector<std::string> messages;
};

// Creates the Vulkan instance and device in place of the application. An OpenXR runtime does so, because it
// adds its own extensions and determines the GPU.
class VulkanCreator {
  public:
    VulkanCreator() = default;
    VulkanCreator(const VulkanCreator&) = delete;
    VulkanCreator& operator=(const VulkanCreator&) = delete;
    virtual ~VulkanCreator() = default;

    virtual Result<VkInstance> create_instance(const VkInstanceCreateInfo& info) = 0;
    // The GPU of the headset. The device must be created on it.
    virtual Result<VkPhysicalDevice> choose_gpu(VkInstance instance) = 0;
    virtual Result<VkDevice> create_device(VkPhysicalDevice gpu, const VkDeviceCreateInfo& info) = 0;
};

struct InstanceOptions {
    bool validation = false;  // core and synchronization validation; fails if the layer is not installed
    std::span<const char* const> extensions;  // required by the window system
    VulkanCreator* creator = nullptr;         // null: the instance is created directly
    // Receives the messages of the validation layers. Null: the instance has a log of its own.
    std::shared_ptr<ValidationLog> log{};
};

class Instance {
  public:
    static Result<Instance> create(const InstanceOptions& options);

    Instance(Instance&& other) noexcept;
    Instance& operator=(Instance&& other) noexcept;
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    [[nodiscard]] VkInstance get() const { return instance_; }
    [[nodiscard]] const ValidationLog& log() const { return *log_; }
    [[nodiscard]] std::shared_ptr<ValidationLog> shared_log() const { return log_; }

  private:
    Instance() = default;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::shared_ptr<ValidationLog> log_;  // the messenger holds its address
};

// The drawable surface of a window. engine/platform creates it, because it depends on the window system.
class Surface {
  public:
    Surface() = default;
    Surface(VkInstance instance, VkSurfaceKHR surface) : instance_(instance), surface_(surface) {}
    Surface(Surface&& other) noexcept
        : instance_(other.instance_), surface_(std::exchange(other.surface_, VK_NULL_HANDLE)) {}
    Surface& operator=(Surface&& other) noexcept {
        std::swap(instance_, other.instance_);
        std::swap(surface_, other.surface_);
        return *this;
    }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;
    ~Surface() {
        if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    }

    [[nodiscard]] VkSurfaceKHR get() const { return surface_; }

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

// The properties of a device that the choice depends on.
struct DeviceCandidate {
    std::string name;
    std::string driver;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t api_version = 0;
    std::vector<std::string> missing;  // required features, limits and queues that the device lacks
    std::uint64_t device_memory = 0;   // bytes of the largest device-local heap
    bool presents = true;              // can present to the requested surface; true if none is requested
};

struct DeviceChoice {
    int index = -1;  // -1: no device is usable
    // One line per candidate: name, type, driver, and "used" or why it is not used.
    std::vector<std::string> reasons;
};

// Chooses by type (discrete, integrated, virtual, software), then by memory size. If `wanted` is not empty,
// only devices whose name contains it (ignoring case) are considered. A pure function, so that tests need no
// GPU.
DeviceChoice choose_device(std::span<const DeviceCandidate> candidates, const std::string& wanted);

struct DeviceOptions {
    std::string wanted;                     // part of a device name; empty: choose the fastest device
    VkSurfaceKHR surface = VK_NULL_HANDLE;  // the device must be able to present to it; null: offscreen
    // Chooses the GPU and creates the device. Null: the device is created directly. If its choice does not
    // match `wanted` or cannot present to `surface`, the creation fails.
    VulkanCreator* creator = nullptr;
};

// The devices of this machine and the choice among them; printed by `doctor`.
struct DeviceSurvey {
    std::vector<VkPhysicalDevice> physical;
    std::vector<DeviceCandidate> candidates;  // parallel to `physical`
    DeviceChoice choice;
};
// Lists and describes the devices. The choice ignores DeviceOptions::creator.
Result<DeviceSurvey> survey_devices(const Instance& instance, const DeviceOptions& options);

// The logical device, its only queue and its memory. It has a fixed address and must outlive everything
// created from it.
class Device {
  public:
    // Fails with ErrorCode::no_device if no device can be used; the error says why for each.
    static Result<std::unique_ptr<Device>> create(const Instance& instance, const DeviceOptions& options);

    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();

    [[nodiscard]] VkDevice get() const { return device_; }
    [[nodiscard]] VkInstance instance() const { return instance_; }
    [[nodiscard]] VkPhysicalDevice physical() const { return physical_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
    [[nodiscard]] Memory& memory() { return *memory_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    [[nodiscard]] const std::string& name() const { return name_; }  // "llvmpipe (LLVM 15.0.6, 256 bits)"
    // "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    [[nodiscard]] const std::string& driver() const { return driver_; }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const { return properties_; }

    // Waits until the GPU is idle.
    Status idle() const { return check(vkDeviceWaitIdle(device_), "waiting for the GPU"); }

  private:
    Device() = default;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    VkPhysicalDeviceProperties properties_{};
    std::string name_, driver_;
    std::unique_ptr<Memory> memory_;
};

// Decides whether to create the device again after the GPU was lost. Usually the system has reset a hanging
// driver, which then works again. A device that is lost again shortly after a restart is not created again,
// because it would be lost every time.
class DeviceLossPolicy {
  public:
    // Reports a loss at time `now` (s). Returns true if the device should be created again.
    bool should_restart(double now) {
        const bool worked = !last_ || now - *last_ >= min_interval;
        last_ = now;
        return worked;
    }
    static constexpr double min_interval = 10.0;  // s

  private:
    std::optional<double> last_;
};

}  // namespace bolt::gpu
