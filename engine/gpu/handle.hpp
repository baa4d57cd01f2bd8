// A move-only owner of a Vulkan object, which it destroys.
#pragma once

#include <utility>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

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
