// The logical device, its one queue and its memory. Made once, at a fixed address; everything made from it
// goes before it.
#pragma once

#include <memory>
#include <string>

#include "engine/gpu/choice.hpp"
#include "engine/gpu/instance.hpp"
#include "engine/gpu/memory.hpp"

namespace bolt::gpu {

struct DeviceOptions {
    std::string wanted;                     // part of a name; empty: the fastest
    VkSurfaceKHR surface = VK_NULL_HANDLE;  // must be able to show on this; null: offscreen
};

// The devices of this machine and the choice among them: what `doctor` prints.
struct Survey {
    std::vector<VkPhysicalDevice> physical;
    std::vector<Candidate> candidates;
    Choice choice;
};
Result<Survey> survey(const Instance& instance, const DeviceOptions& options);

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

    // Waits until the GPU has nothing to do.
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
