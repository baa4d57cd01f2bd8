// Swapchains of the mock runtime.

#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

XrResult XRAPI_CALL enumerate_formats(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                      std::int64_t* formats) {
    constexpr const char* name = "xrEnumerateSwapchainFormats";
    return call(name, Level::session, [&](State& s, auto&) {
        return list(s, name, s.instance->config.formats, capacity, count,
                    [&](std::size_t i, std::int64_t format) { formats[i] = format; });
    });
}

XrResult check_info(State& s, const XrSwapchainCreateInfo& info) {
    constexpr const char* name = "xrCreateSwapchain";
    const Config& config = s.instance->config;
    if (std::find(config.formats.begin(), config.formats.end(), info.format) == config.formats.end())
        return refuse(s, name, XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
                      "requests a format that is not offered");
    if (info.width == 0 || info.height == 0 || info.width > config.max_width ||
        info.height > config.max_height)
        return refuse(s, name, XR_ERROR_VALIDATION_FAILURE, "requests a size beyond the largest one");
    if (info.sampleCount != 1 || info.faceCount != 1 || info.mipCount != 1 || info.arraySize == 0)
        return refuse(s, name, XR_ERROR_FEATURE_UNSUPPORTED, "requests samples, faces or mips");
    return config.refuse_arrays && info.arraySize > 1 ? XR_ERROR_FEATURE_UNSUPPORTED : XR_SUCCESS;
}

XrResult XRAPI_CALL create_swapchain(XrSession handle, const XrSwapchainCreateInfo* info,
                                     XrSwapchain* swapchain) {
    return call("xrCreateSwapchain", Level::session, [&](State& s, auto&) {
        if (const XrResult checked = check_info(s, *info); XR_FAILED(checked)) return checked;
        Swapchain created;
        created.session = id_of(handle);
        created.info = *info;
        created.info.next = nullptr;
        created.images.resize(s.instance->config.images);
        const Vulkan& vk = s.instance->session->vulkan;
        for (SwapchainImage& image : created.images)
            if (create_image(vk, *info, image) != VK_SUCCESS) return XR_ERROR_RUNTIME_FAILURE;
        s.instance->swapchains[++s.last_id] = std::move(created);
        *swapchain = handle_of<XrSwapchain>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_swapchain(XrSwapchain handle) {
    constexpr const char* name = "xrDestroySwapchain";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    const auto found = s.instance->swapchains.find(id_of(handle));
    // The validation layers report an image that is still in use.
    if (found != s.instance->swapchains.end())
        for (const SwapchainImage& image : found->second.images)
            destroy_image(s.instance->session->vulkan, image);
    return remove(s, name, s.instance->swapchains, handle, Kind::swapchain) ? success
                                                                            : XR_ERROR_HANDLE_INVALID;
}

XrResult XRAPI_CALL enumerate_images(XrSwapchain handle, std::uint32_t capacity, std::uint32_t* count,
                                     XrSwapchainImageBaseHeader* images) {
    constexpr const char* name = "xrEnumerateSwapchainImages";
    return call(name, Level::session, [&](State& s, auto&) {
        const Swapchain* swapchain = find(s, name, s.instance->swapchains, handle);
        if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
        auto* typed = reinterpret_cast<XrSwapchainImageVulkan2KHR*>(images);
        return list(s, name, swapchain->images, capacity, count,
                    [&](std::size_t i, const SwapchainImage& image) { typed[i].image = image.image; });
    });
}

XrResult XRAPI_CALL acquire_image(XrSwapchain handle, const XrSwapchainImageAcquireInfo*,
                                  std::uint32_t* index) {
    constexpr const char* name = "xrAcquireSwapchainImage";
    return call(name, Level::session, [&](State& s, auto&) {
        Swapchain* swapchain = find(s, name, s.instance->swapchains, handle);
        if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (swapchain->acquired.size() == swapchain->images.size())
            return refuse(s, name, XR_ERROR_CALL_ORDER_INVALID, "is called while all images are acquired");
        SwapchainImage& image = swapchain->images[swapchain->next];
        if (prepare_image(s.instance->session->vulkan, swapchain->info, image) != VK_SUCCESS)
            return XR_ERROR_RUNTIME_FAILURE;
        *index = swapchain->next;
        swapchain->acquired.push_back(*index);
        swapchain->next = (swapchain->next + 1) % static_cast<std::uint32_t>(swapchain->images.size());
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL wait_image(XrSwapchain handle, const XrSwapchainImageWaitInfo*) {
    constexpr const char* name = "xrWaitSwapchainImage";
    return call(name, Level::session, [&](State& s, auto&) {
        Swapchain* swapchain = find(s, name, s.instance->swapchains, handle);
        if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (swapchain->acquired.empty() || swapchain->waited)
            return refuse(s, name, XR_ERROR_CALL_ORDER_INVALID,
                          "is called without an acquired image that was not waited for");
        swapchain->waited = true;
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL release_image(XrSwapchain handle, const XrSwapchainImageReleaseInfo*) {
    constexpr const char* name = "xrReleaseSwapchainImage";
    return call(name, Level::session, [&](State& s, auto&) {
        Swapchain* swapchain = find(s, name, s.instance->swapchains, handle);
        if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (!swapchain->waited)
            return refuse(s, name, XR_ERROR_CALL_ORDER_INVALID,
                          "is called without an image that was waited for");
        swapchain->released = swapchain->acquired.front();
        swapchain->acquired.pop_front();
        swapchain->waited = false;
        return XR_SUCCESS;
    });
}

}  // namespace

void add_swapchain_functions(FunctionTable& table) {
    add(table, "xrEnumerateSwapchainFormats", &enumerate_formats);
    add(table, "xrCreateSwapchain", &create_swapchain);
    add(table, "xrDestroySwapchain", &destroy_swapchain);
    add(table, "xrEnumerateSwapchainImages", &enumerate_images);
    add(table, "xrAcquireSwapchainImage", &acquire_image);
    add(table, "xrWaitSwapchainImage", &wait_image);
    add(table, "xrReleaseSwapchainImage", &release_image);
}

}  // namespace bolt::mock
