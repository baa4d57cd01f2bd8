#include "tests/xr/direct.hpp"

#include <dlfcn.h>
#include <doctest/doctest.h>

#include "tests/mock_openxr/negotiation.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

DirectClient::DirectClient() {
    void* library = dlopen(BOLT_MOCK_OPENXR, RTLD_NOW | RTLD_LOCAL);
    REQUIRE(library != nullptr);
    using Negotiate = XrResult (*)(const mock::NegotiateLoaderInfo*, mock::NegotiateRuntimeRequest*);
    const auto negotiate = reinterpret_cast<Negotiate>(dlsym(library, "xrNegotiateLoaderRuntimeInterface"));
    REQUIRE((negotiate != nullptr));
    const mock::NegotiateLoaderInfo loader;
    mock::NegotiateRuntimeRequest request;
    REQUIRE(negotiate(&loader, &request) == XR_SUCCESS);
    get_ = request.get_instance_proc_addr;
}

DirectClient::~DirectClient() {
    if (device) (void)device->idle();
    mock_control().reset();  // destroys the images of the session
    device.reset();
    if (vulkan)
        for (const std::string& message : vulkan->log().messages) CHECK_MESSAGE(false, message);
}

XrResult DirectClient::make_instance(const std::vector<const char*>& extensions) {
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.applicationInfo.applicationName[0] = 't';
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.enabledExtensionNames = extensions.data();
    return call<PFN_xrCreateInstance>("xrCreateInstance", &info, &instance);
}

void DirectClient::make_vulkan(bool query_requirements) {
    if (instance == XR_NULL_HANDLE) REQUIRE(make_instance() == XR_SUCCESS);
    XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    if (query_requirements)
        REQUIRE(call<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR", instance,
                                                              XrSystemId{1}, &needs) == XR_SUCCESS);
    gpu::InstanceOptions options;
    options.validation = true;
    options.creator = this;
    vulkan = std::make_unique<gpu::Instance>(need(gpu::Instance::create(options)));
    gpu::DeviceOptions device_options;
    device_options.creator = this;
    device = need(gpu::Device::create(*vulkan, device_options));
}

XrResult DirectClient::make_session() {
    if (!device) make_vulkan();
    return try_session(vulkan->get(), device->get());
}

XrResult DirectClient::try_session(VkInstance vulkan_instance, VkDevice vulkan_device) {
    XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
    binding.instance = vulkan_instance;
    binding.physicalDevice = device->physical();
    binding.device = vulkan_device;
    binding.queueFamilyIndex = device->queue_family();
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO};
    info.next = &binding;
    info.systemId = 1;
    return call<PFN_xrCreateSession>("xrCreateSession", instance, &info, &session);
}

void DirectClient::run_session() {
    if (session == XR_NULL_HANDLE) REQUIRE(make_session() == XR_SUCCESS);
    REQUIRE(begin_session() == XR_SUCCESS);
}

XrSwapchain DirectClient::make_swapchain(std::int64_t format, std::uint32_t layers) {
    XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
    info.usageFlags = format == VK_FORMAT_D32_SFLOAT ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                                     : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
    info.format = format;
    info.width = 64;
    info.height = 48;
    info.arraySize = layers;
    info.sampleCount = info.faceCount = info.mipCount = 1;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    REQUIRE(call<PFN_xrCreateSwapchain>("xrCreateSwapchain", session, &info, &swapchain) == XR_SUCCESS);
    return swapchain;
}

XrSpace DirectClient::make_space(XrReferenceSpaceType type) {
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
    info.referenceSpaceType = type;
    info.poseInReferenceSpace.orientation.w = 1.0F;
    XrSpace space = XR_NULL_HANDLE;
    REQUIRE(call<PFN_xrCreateReferenceSpace>("xrCreateReferenceSpace", session, &info, &space) == XR_SUCCESS);
    return space;
}

XrResult DirectClient::begin_session(XrViewConfigurationType type) {
    XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO};
    info.primaryViewConfigurationType = type;
    return call<PFN_xrBeginSession>("xrBeginSession", session, &info);
}

XrResult DirectClient::wait_frame() {
    const XrFrameWaitInfo info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
    XrFrameState state{XR_TYPE_FRAME_STATE};
    const XrResult result = call<PFN_xrWaitFrame>("xrWaitFrame", session, &info, &state);
    display_time = state.predictedDisplayTime;
    return result;
}

XrResult DirectClient::begin_frame() {
    const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
    return call<PFN_xrBeginFrame>("xrBeginFrame", session, &info);
}

XrResult DirectClient::end_frame(XrTime at, const std::vector<const XrCompositionLayerBaseHeader*>& layers,
                                 XrEnvironmentBlendMode blend) {
    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
    info.displayTime = at;
    info.environmentBlendMode = blend;
    info.layerCount = static_cast<std::uint32_t>(layers.size());
    info.layers = layers.data();
    return call<PFN_xrEndFrame>("xrEndFrame", session, &info);
}

XrResult DirectClient::acquire(XrSwapchain swapchain) {
    const XrSwapchainImageAcquireInfo info{XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO, nullptr};
    std::uint32_t index = 0;
    return call<PFN_xrAcquireSwapchainImage>("xrAcquireSwapchainImage", swapchain, &info, &index);
}

XrResult DirectClient::wait_image(XrSwapchain swapchain) {
    XrSwapchainImageWaitInfo info{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    info.timeout = XR_INFINITE_DURATION;
    return call<PFN_xrWaitSwapchainImage>("xrWaitSwapchainImage", swapchain, &info);
}

XrResult DirectClient::release(XrSwapchain swapchain) {
    const XrSwapchainImageReleaseInfo info{XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO, nullptr};
    return call<PFN_xrReleaseSwapchainImage>("xrReleaseSwapchainImage", swapchain, &info);
}

XrPath DirectClient::path(const char* text) {
    XrPath made = XR_NULL_PATH;
    REQUIRE(call<PFN_xrStringToPath>("xrStringToPath", instance, text, &made) == XR_SUCCESS);
    return made;
}

Result<VkInstance> DirectClient::create_instance(const VkInstanceCreateInfo& info) {
    XrVulkanInstanceCreateInfoKHR create{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    create.systemId = 1;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanCreateInfo = &info;
    VkInstance made = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    BOLT_TRY(xr::check(
        call<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR", instance, &create, &made, &result),
        "instance"));
    return made;
}

Result<VkPhysicalDevice> DirectClient::choose_gpu(VkInstance vulkan_instance) {
    XrVulkanGraphicsDeviceGetInfoKHR info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    info.systemId = 1;
    info.vulkanInstance = vulkan_instance;
    VkPhysicalDevice gpu = VK_NULL_HANDLE;
    BOLT_TRY(xr::check(
        call<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR", instance, &info, &gpu),
        "GPU"));
    return gpu;
}

Result<VkDevice> DirectClient::create_device(VkPhysicalDevice gpu, const VkDeviceCreateInfo& info) {
    XrVulkanDeviceCreateInfoKHR create{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    create.systemId = 1;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanPhysicalDevice = gpu;
    create.vulkanCreateInfo = &info;
    VkDevice made = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    BOLT_TRY(xr::check(
        call<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR", instance, &create, &made, &result),
        "device"));
    return made;
}

void expect_violation(const MockRuntime& mock, XrResult result, XrResult expected,
                      const std::string& sentence) {
    CHECK(result == expected);
    const std::vector<std::string> violations = mock->take_violations();
    REQUIRE(violations.size() == 1);
    CHECK(violations[0] == sentence);
}

}  // namespace bolt::test
