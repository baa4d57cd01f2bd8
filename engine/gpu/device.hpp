// The logical device, its only queue and its memory. It has a fixed address and must outlive everything
// created from it.
#pragma once

#include <memory>
#include <string>

#include "engine/gpu/device_choice.hpp"
#include "engine/gpu/instance.hpp"
#include "engine/gpu/memory.hpp"

namespace bolt::gpu {

struct DeviceOptions {
    std::string wanted;                     // part of a device name; empty: choose the fastest device
    VkSurfaceKHR surface = VK_NULL_HANDLE;  // the device must be able to present to it; null: offscreen
};

// The devices of this machine and the choice among them; printed by `doctor`.
struct DeviceSurvey {
    std::vector<VkPhysicalDevice> physical;
    std::vector<DeviceCandidate> candidates;
    DeviceChoice choice;
};
Result<DeviceSurvey> survey_devices(const Instance& instance, const DeviceOptions& options);

class Device {
  public:
    static Result<std::unique_ptr<Device>> create(const Instance& instance, const DeviceOptions& options);

    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();

    [[nodiscard]] VkDevice get() const { return device_; }
    [[nodiscard]] VkPhysicalDevice physical() const { return physical_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
    [[nodiscard]] Memory& memory() { return *memory_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    [[nodiscard]] const std::string& name() const { return name_; }  // "llvmpipe (LLVM 15.0.6, 256 bits)"
    [[nodiscard]] const std::string& driver() const {
        return driver_;
    }  // "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const { return properties_; }

    // Waits until the GPU is idle.
    Status idle() const { return check(vkDeviceWaitIdle(device_), "waiting for the GPU"); }

  private:
    Device() = default;

    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    VkPhysicalDeviceProperties properties_{};
    std::string name_, driver_;
    std::unique_ptr<Memory> memory_;
};

}  // namespace bolt::gpu
