// What a window gives to draw on. Made by the window (engine/platform), because only it knows its system.
#pragma once

#include <utility>

#include "engine/gpu/instance.hpp"

namespace bolt::gpu {

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
    ~Surface();

    [[nodiscard]] VkSurfaceKHR get() const { return surface_; }

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

}  // namespace bolt::gpu
