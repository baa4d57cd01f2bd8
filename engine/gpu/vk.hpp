// Vulkan 1.3 through volk: results as errors, and owners of Vulkan objects. Entry points are loaded at run
// time, so the programs start on machines without Vulkan and can report that it is missing.
#pragma once

#define VK_NO_PROTOTYPES
#include <volk.h>

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::gpu {

// Returns the name in the specification: "VK_ERROR_DEVICE_LOST".
std::string_view name(VkResult result);

// Returns an Error for every negative result. `what`: the operation that failed. Lost and missing devices
// have the code no_device. `Error::lost` is set for a lost device, but not for a lost surface, which
// Swapchain recreates.
Status check(VkResult result, std::string_view what);

// Fills `values` by a Vulkan function that is called twice: first for the count, then for the values.
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

// A move-only owner that destroys a Vulkan object. volk loads functions at run time, so `destroy` is the
// address of the variable that holds the function pointer.
template <class T, auto* destroy>
class UniqueHandle {
  public:
    UniqueHandle() = default;
    UniqueHandle(VkDevice device, T object) : device_(device), object_(object) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : device_(other.device_), object_(std::exchange(other.object_, T{VK_NULL_HANDLE})) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(object_, other.object_);
        return *this;
    }
    UniqueHandle(const UniqueHandle&) = delete;
    UniqueHandle& operator=(const UniqueHandle&) = delete;
    ~UniqueHandle() {
        if (object_ != T{VK_NULL_HANDLE}) (*destroy)(device_, object_, nullptr);
    }

    [[nodiscard]] T get() const { return object_; }
    explicit operator bool() const { return object_ != T{VK_NULL_HANDLE}; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    T object_{VK_NULL_HANDLE};
};

using Fence = UniqueHandle<VkFence, &vkDestroyFence>;
using Semaphore = UniqueHandle<VkSemaphore, &vkDestroySemaphore>;
using CommandPool = UniqueHandle<VkCommandPool, &vkDestroyCommandPool>;
using QueryPool = UniqueHandle<VkQueryPool, &vkDestroyQueryPool>;
using Sampler = UniqueHandle<VkSampler, &vkDestroySampler>;
using ImageView = UniqueHandle<VkImageView, &vkDestroyImageView>;
using ShaderModule = UniqueHandle<VkShaderModule, &vkDestroyShaderModule>;
using DescriptorSetLayout = UniqueHandle<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using DescriptorPool = UniqueHandle<VkDescriptorPool, &vkDestroyDescriptorPool>;
using PipelineLayout = UniqueHandle<VkPipelineLayout, &vkDestroyPipelineLayout>;
using PipelineHandle = UniqueHandle<VkPipeline, &vkDestroyPipeline>;
using PipelineCacheHandle = UniqueHandle<VkPipelineCache, &vkDestroyPipelineCache>;
using SwapchainHandle = UniqueHandle<VkSwapchainKHR, &vkDestroySwapchainKHR>;

}  // namespace bolt::gpu
