// A client that calls the mock runtime directly, without OpenXR's loader and without engine/xr, so that a
// test can break a rule and expect the mock to say so.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "tests/xr/support.hpp"

namespace bolt::test {

class DirectClient final : public gpu::VulkanCreator {
  public:
    static constexpr std::int64_t color_format = VK_FORMAT_R8G8B8A8_SRGB, depth_format = VK_FORMAT_D32_SFLOAT;

    // Negotiates with the library; nothing else exists yet.
    DirectClient();
    DirectClient(const DirectClient&) = delete;
    DirectClient& operator=(const DirectClient&) = delete;
    ~DirectClient() override;

    // Calls a function of the runtime by its name.
    template <class Function, class... Arguments>
    XrResult call(const char* name, Arguments... arguments) {
        PFN_xrVoidFunction raw = nullptr;
        if (const XrResult found = get_(instance, name, &raw); XR_FAILED(found)) return found;
        return reinterpret_cast<Function>(raw)(arguments...);
    }

    // Each step calls those before it that were not made.
    XrResult make_instance(const std::vector<const char*>& extensions = {"XR_KHR_vulkan_enable2",
                                                                         "XR_KHR_composition_layer_depth"});
    void make_vulkan(bool query_requirements = true);
    XrResult make_session();  // with Vulkan's objects of the runtime
    XrResult try_session(VkInstance vulkan, VkDevice device);
    void run_session();  // until the session runs
    XrSwapchain make_swapchain(std::int64_t format, std::uint32_t layers);
    XrSpace make_space(XrReferenceSpaceType type = XR_REFERENCE_SPACE_TYPE_LOCAL);

    XrResult begin_session(XrViewConfigurationType type = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO);
    XrResult end_session() { return call<PFN_xrEndSession>("xrEndSession", session); }
    XrResult wait_frame();
    XrResult begin_frame();
    XrResult end_frame(XrTime at, const std::vector<const XrCompositionLayerBaseHeader*>& layers = {},
                       XrEnvironmentBlendMode blend = XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
    XrResult acquire(XrSwapchain swapchain);
    XrResult wait_image(XrSwapchain swapchain);
    XrResult release(XrSwapchain swapchain);
    XrPath path(const char* text);

    Result<VkInstance> create_instance(const VkInstanceCreateInfo& info) override;
    Result<VkPhysicalDevice> choose_gpu(VkInstance instance) override;
    Result<VkDevice> create_device(VkPhysicalDevice gpu, const VkDeviceCreateInfo& info) override;

    XrInstance instance = XR_NULL_HANDLE;
    XrSession session = XR_NULL_HANDLE;
    XrTime display_time = 0;  // of the last frame that was waited for
    std::unique_ptr<gpu::Instance> vulkan;
    std::unique_ptr<gpu::Device> device;

  private:
    PFN_xrGetInstanceProcAddr get_ = nullptr;
};

// The call was refused with this result and recorded with this sentence, and nothing else was.
void expect_violation(const MockRuntime& mock, XrResult result, XrResult expected,
                      const std::string& sentence);

}  // namespace bolt::test
