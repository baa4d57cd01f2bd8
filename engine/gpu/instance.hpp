// The Vulkan instance and the messages of the validation layers.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// All warnings and errors of the validation layers since the instance was created. A correct program has
// none.
struct ValidationLog {
    std::vector<std::string> messages;
};

struct InstanceOptions {
    bool validation = false;  // core and synchronization validation; fails if the layer is not installed
    std::span<const char* const> extensions;  // required by the window system
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
    [[nodiscard]] bool validated() const { return messenger_ != VK_NULL_HANDLE; }
    [[nodiscard]] const ValidationLog& log() const { return *log_; }

  private:
    Instance() = default;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::unique_ptr<ValidationLog> log_ =
        std::make_unique<ValidationLog>();  // the messenger holds its address
};

}  // namespace bolt::gpu
