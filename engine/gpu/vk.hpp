// Vulkan 1.3 through volk. Entry points are loaded at run time, so the programs start on machines without
// Vulkan and can report that it is missing.
#pragma once

#define VK_NO_PROTOTYPES
#include <volk.h>

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::gpu {

// The name in the specification: "VK_ERROR_DEVICE_LOST".
std::string_view name(VkResult result);

// Returns an Error for every result that is not a success. Lost and missing devices have the code no_device.
// `Error::lost` is set for a lost device, but not for a lost surface, which Swapchain recreates.
Status check(VkResult result, std::string_view what);

// Fills `values` by a Vulkan function that is called twice: for the count, then for the values.
// `query`: VkResult(std::uint32_t* count, T* values).
template <class T, class Query>
VkResult enumerate(std::vector<T>& values, const Query& query) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {  // the list may have grown between the calls
        std::uint32_t count = 0;
        result = query(&count, nullptr);
        values.resize(count);
        if (result == VK_SUCCESS && count > 0) result = query(&count, values.data());
        values.resize(count);
    }
    return result;
}

// A move-only owner of a Vulkan object, which it destroys.

// volk loads function pointers at run time, so `destroy` points to the function pointer.
template <class T, auto* destroy>
class Handle {
  public:
    Handle() = default;
    Handle(VkDevice device, T object) : device_(device), object_(object) {}
    Handle(Handle&& other) noexcept
        : device_(other.device_), object_(std::exchange(other.object_, T{VK_NULL_HANDLE})) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(object_, other.object_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (object_ != T{VK_NULL_HANDLE}) (*destroy)(device_, object_, nullptr);
    }

    [[nodiscard]] T get() const { return object_; }
    explicit operator bool() const { return object_ != T{VK_NULL_HANDLE}; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    T object_{VK_NULL_HANDLE};
};

using Fence = Handle<VkFence, &vkDestroyFence>;
using Semaphore = Handle<VkSemaphore, &vkDestroySemaphore>;
using CommandPool = Handle<VkCommandPool, &vkDestroyCommandPool>;
using QueryPool = Handle<VkQueryPool, &vkDestroyQueryPool>;
using Sampler = Handle<VkSampler, &vkDestroySampler>;
using ImageView = Handle<VkImageView, &vkDestroyImageView>;
using ShaderModule = Handle<VkShaderModule, &vkDestroyShaderModule>;
using DescriptorSetLayout = Handle<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using DescriptorPool = Handle<VkDescriptorPool, &vkDestroyDescriptorPool>;
using PipelineLayout = Handle<VkPipelineLayout, &vkDestroyPipelineLayout>;
using PipelineHandle = Handle<VkPipeline, &vkDestroyPipeline>;
using PipelineCacheHandle = Handle<VkPipelineCache, &vkDestroyPipelineCache>;
using SwapchainHandle = Handle<VkSwapchainKHR, &vkDestroySwapchainKHR>;

}  // namespace bolt::gpu
