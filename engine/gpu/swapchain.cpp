#include "engine/gpu/swapchain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "engine/gpu/resources.hpp"

namespace bolt::gpu {

namespace {

// The value in VkSurfaceCapabilitiesKHR that means "the swapchain determines the size".
constexpr std::uint32_t undefined_extent = 0xFFFFFFFF;

const char* name(VkPresentModeKHR mode) {
    switch (mode) {
        case VK_PRESENT_MODE_IMMEDIATE_KHR:
            return "immediate";
        case VK_PRESENT_MODE_MAILBOX_KHR:
            return "mailbox";
        case VK_PRESENT_MODE_FIFO_KHR:
            return "fifo";
        case VK_PRESENT_MODE_FIFO_RELAXED_KHR:
            return "relaxed fifo";
        default:
            return "another mode";
    }
}

// Pictures are 8-bit sRGB. The first format needs no conversion, the second one swaps red and blue.
struct PreferredFormat {
    VkFormat format;
    const char* text;
};
constexpr PreferredFormat preferred_formats[] = {
    {VK_FORMAT_R8G8B8A8_SRGB, "RGBA sRGB: no conversion"},
    {VK_FORMAT_B8G8R8A8_SRGB, "BGRA sRGB: converted by the copy"},
};

Status choose_format(const SurfaceSupport& support, SwapchainPlan& plan) {
    for (const PreferredFormat& wanted : preferred_formats)
        for (const VkSurfaceFormatKHR& format : support.formats)
            if (format.format == wanted.format && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                plan.format = format;
                plan.reasons.push_back(fmt::format("format {}", wanted.text));
                return {};
            }
    std::vector<int> offered;
    for (const VkSurfaceFormatKHR& format : support.formats)
        offered.push_back(static_cast<int>(format.format));
    return fail(
        ErrorCode::no_device,
        fmt::format("the window supports no 8-bit sRGB format (VkFormat: {})", fmt::join(offered, ", ")),
        "VK_FORMAT_B8G8R8A8_SRGB or VK_FORMAT_R8G8B8A8_SRGB");
}

void choose_mode(const SurfaceSupport& support, SwapchainPlan& plan) {
    const auto supports = [&](VkPresentModeKHR mode) {
        return std::find(support.modes.begin(), support.modes.end(), mode) != support.modes.end();
    };
    const auto choose = [&](VkPresentModeKHR mode, const char* why) {
        plan.mode = mode;
        plan.reasons.push_back(fmt::format("{}: {}", name(mode), why));
    };
    if (supports(VK_PRESENT_MODE_MAILBOX_KHR))
        return choose(VK_PRESENT_MODE_MAILBOX_KHR, "the newest picture, without tearing or queueing");
    choose(VK_PRESENT_MODE_FIFO_KHR, "mailbox is not available, fifo always is");
}

void choose_extent(const VkSurfaceCapabilitiesKHR& capabilities, const SwapchainRequest& request,
                   SwapchainPlan& plan) {
    plan.extent = capabilities.currentExtent;
    if (capabilities.currentExtent.width == undefined_extent) {
        plan.extent = request.window;
        if (plan.extent.width == 0 || plan.extent.height == 0) return;
        plan.extent = {std::clamp(request.window.width, capabilities.minImageExtent.width,
                                  capabilities.maxImageExtent.width),
                       std::clamp(request.window.height, capabilities.minImageExtent.height,
                                  capabilities.maxImageExtent.height)};
    }
}

}  // namespace

VkResult query_surface(VkPhysicalDevice gpu, VkSurfaceKHR surface, SurfaceSupport& support) {
    VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu, surface, &support.capabilities);
    if (result == VK_SUCCESS)
        result = enumerate(support.formats, [&](std::uint32_t* count, VkSurfaceFormatKHR* formats) {
            return vkGetPhysicalDeviceSurfaceFormatsKHR(gpu, surface, count, formats);
        });
    if (result == VK_SUCCESS)
        result = enumerate(support.modes, [&](std::uint32_t* count, VkPresentModeKHR* modes) {
            return vkGetPhysicalDeviceSurfacePresentModesKHR(gpu, surface, count, modes);
        });
    return result;
}

Result<SwapchainPlan> plan_swapchain(const SurfaceSupport& support, const SwapchainRequest& request) {
    SwapchainPlan plan;
    const VkSurfaceCapabilitiesKHR& capabilities = support.capabilities;
    if ((capabilities.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0)
        return fail(ErrorCode::no_device, "the window's images do not support copies", "another GPU: --gpu");
    BOLT_TRY(choose_format(support, plan));
    choose_mode(support, plan);
    choose_extent(capabilities, request, plan);

    // One image is on the screen; in mailbox mode another one waits.
    const std::uint32_t shown = plan.mode == VK_PRESENT_MODE_MAILBOX_KHR ? 2 : 1;
    plan.images = std::max(capabilities.minImageCount, request.in_flight + shown - 1);
    if (plan.mode == VK_PRESENT_MODE_MAILBOX_KHR)
        plan.images = std::max(plan.images, capabilities.minImageCount + 1);
    if (capabilities.maxImageCount != 0) plan.images = std::min(plan.images, capabilities.maxImageCount);
    plan.reasons.push_back(
        fmt::format("{} images, the minimum is {}", plan.images, capabilities.minImageCount));

    plan.transform = capabilities.currentTransform;
    if ((capabilities.supportedTransforms & VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR) != 0)
        plan.transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    // Windows are opaque. If the surface does not support opaque composition, the alpha values are 1 anyway.
    for (const VkCompositeAlphaFlagBitsKHR alpha :
         {VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR, VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
          VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR, VK_COMPOSITE_ALPHA_POST_MULTIPLIED_BIT_KHR})
        if ((capabilities.supportedCompositeAlpha & static_cast<VkFlags>(alpha)) != 0) {
            plan.alpha = alpha;
            break;
        }
    return plan;
}

namespace {

// A hidden window may provide no image for as long as it is hidden. Acquiring one times out, so that events
// are still handled.
constexpr std::uint64_t acquire_timeout = 200'000'000;  // ns
constexpr std::uint32_t max_losses = 3;                 // consecutive

bool same(VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; }
bool empty(VkExtent2D extent) { return extent.width == 0 || extent.height == 0; }

Result<Semaphore> make_semaphore(const Device& device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateSemaphore(device.get(), &info, nullptr, &semaphore), "creating a semaphore"));
    return Semaphore(device.get(), semaphore);
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, Surface surface,
                                                     MakeSurface make_surface) {
    std::unique_ptr<Swapchain> swapchain(new Swapchain());
    swapchain->device_ = &device;
    swapchain->surface_ = std::move(surface);
    swapchain->make_surface_ = std::move(make_surface);
    for (Semaphore& semaphore : swapchain->acquire_semaphores_) {
        BOLT_TRY_ASSIGN(auto created, make_semaphore(device));
        semaphore = std::move(created);
    }
    return swapchain;
}

Swapchain::~Swapchain() {
    (void)device_->idle();  // a lost device is idle too
}

// Updates the state after a Vulkan call. Returns true to continue; false: this picture cannot be presented,
// but a later one may.
Result<bool> Swapchain::handle(VkResult result, std::string_view what) {
    switch (result) {
        case VK_SUCCESS:
            return true;
        case VK_SUBOPTIMAL_KHR:
            if (!ignore_suboptimal_) stale_ = suboptimal_ = true;
            return true;
        case VK_NOT_READY:
        case VK_TIMEOUT:
            return false;
        case VK_ERROR_OUT_OF_DATE_KHR:
            stale_ = true;
            return false;
        case VK_ERROR_SURFACE_LOST_KHR:
            lost_ = true;
            if (++losses_ < max_losses) return false;
            [[fallthrough]];
        default:
            break;
    }
    BOLT_TRY(check(result, what));
    return true;
}

Status Swapchain::replace_surface() {
    BOLT_TRY(device_->idle());
    images_.clear();
    swapchain_ = SwapchainHandle();
    surface_ = Surface();
    BOLT_TRY_ASSIGN(auto created, make_surface_());
    surface_ = std::move(created);
    VkBool32 supported = VK_FALSE;
    const VkResult queried = vkGetPhysicalDeviceSurfaceSupportKHR(
        device_->physical(), device_->queue_family(), surface_.get(), &supported);
    BOLT_TRY(check(queried, "querying the surface capabilities"));
    if (supported != VK_TRUE)
        return fail(ErrorCode::no_device, "this GPU can no longer present to the window's display",
                    "the display of the start, or --gpu");
    lost_ = false;
    stale_ = true;
    return {};
}

// Returns false if the surface was lost.
Result<bool> Swapchain::recreate(VkExtent2D window) {
    SurfaceSupport support;
    if (Result<bool> queried = handle(query_surface(device_->physical(), surface_.get(), support),
                                      "querying the surface capabilities");
        !queried || !*queried)
        return queried;
    BOLT_TRY_ASSIGN(auto plan, plan_swapchain(support, {window, frames_in_flight}));
    ignore_suboptimal_ = suboptimal_ && same(plan.extent, plan_.extent);
    plan_ = std::move(plan);
    window_ = window;
    if (empty(plan_.extent)) return true;
    // After this the GPU uses neither the old swapchain nor its semaphores.
    BOLT_TRY(device_->idle());

    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_.get();
    info.minImageCount = plan_.images;
    info.imageFormat = plan_.format.format;
    info.imageColorSpace = plan_.format.colorSpace;
    info.imageExtent = plan_.extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = plan_.transform;
    info.compositeAlpha = plan_.alpha;
    info.presentMode = plan_.mode;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_.get();
    VkSwapchainKHR raw = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(device_->get(), &info, nullptr, &raw);
    images_.clear();
    present_semaphores_.clear();
    swapchain_ = SwapchainHandle(device_->get(), raw);
    if (Result<bool> created = handle(result, "creating the swapchain"); !created || !*created)
        return created;
    const VkResult got = enumerate(images_, [&](std::uint32_t* count, VkImage* images) {
        return vkGetSwapchainImagesKHR(device_->get(), raw, count, images);
    });
    BOLT_TRY(check(got, "querying the swapchain images"));
    while (present_semaphores_.size() < images_.size()) {
        BOLT_TRY_ASSIGN(auto created, make_semaphore(*device_));
        present_semaphores_.push_back(std::move(created));
    }
    ++creations_;
    stale_ = suboptimal_ = false;
    return true;
}

Result<VkExtent2D> Swapchain::prepare(VkExtent2D window) {
    while (lost_ || stale_ || !same(window, window_)) {
        if (lost_) BOLT_TRY(replace_surface());
        BOLT_TRY_ASSIGN(const auto created, recreate(window));
        if (created) break;
    }
    return plan_.extent;
}

namespace {

void copy_part(VkCommandBuffer commands, const ShownPicture& picture, const VkRect2D& place, VkImage to,
               VkFormat format) {
    const VkRect2D part = picture.part.value_or(VkRect2D{{0, 0}, picture.picture->info().extent});
    const VkImageSubresourceLayers from_layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, picture.layer, 1},
        to_layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const bool same_size = same(part.extent, place.extent);
    if (same_size && picture.picture->info().format == format) {
        VkImageCopy region{};
        region.srcSubresource = from_layer;
        region.srcOffset = {part.offset.x, part.offset.y, 0};
        region.dstSubresource = to_layer;
        region.dstOffset = {place.offset.x, place.offset.y, 0};
        region.extent = {place.extent.width, place.extent.height, 1};
        vkCmdCopyImage(commands, picture.picture->get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        return;
    }
    const auto set_corners = [](VkOffset3D(&corners)[2], const VkRect2D& rectangle) {
        corners[0] = {rectangle.offset.x, rectangle.offset.y, 0};
        corners[1] = {rectangle.offset.x + static_cast<std::int32_t>(rectangle.extent.width),
                      rectangle.offset.y + static_cast<std::int32_t>(rectangle.extent.height), 1};
    };
    VkImageBlit region{};
    region.srcSubresource = from_layer;
    set_corners(region.srcOffsets, part);
    region.dstSubresource = to_layer;
    set_corners(region.dstOffsets, place);
    vkCmdBlitImage(commands, picture.picture->get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   same_size ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

// The part of `place` inside a window of this size. The place may date from before a resize of the window.
VkRect2D clipped(const VkRect2D& place, VkExtent2D size) {
    const auto clip = [](std::int32_t from, std::uint32_t length, std::uint32_t limit) {
        const std::int64_t low = std::clamp<std::int64_t>(from, 0, limit),
                           high = std::clamp<std::int64_t>(std::int64_t{from} + length, low, limit);
        return std::pair(static_cast<std::int32_t>(low), static_cast<std::uint32_t>(high - low));
    };
    const auto [x, width] = clip(place.offset.x, place.extent.width, size.width);
    const auto [y, height] = clip(place.offset.y, place.extent.height, size.height);
    return {{x, y}, {width, height}};
}

}  // namespace

void Swapchain::copy(VkCommandBuffer commands, VkImage to, std::span<const ShownPicture> pictures) const {
    image_barrier(commands, to, ResourceUse::acquired, ResourceUse::transfer_to);
    const bool fills = std::any_of(pictures.begin(), pictures.end(),
                                   [](const ShownPicture& picture) { return !picture.place; });
    if (!fills) {
        const VkClearColorValue black{{0.0F, 0.0F, 0.0F, 1.0F}};
        const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &whole);
        image_barrier(commands, to, ResourceUse::transfer_to, ResourceUse::transfer_to);
    }
    for (const ShownPicture& picture : pictures) {
        const VkRect2D place = clipped(picture.place.value_or(VkRect2D{{0, 0}, plan_.extent}), plan_.extent);
        if (!empty(place.extent)) copy_part(commands, picture, place, to, plan_.format.format);
    }
    image_barrier(commands, to, ResourceUse::transfer_to, ResourceUse::present);
}

// None: nothing can be presented now.
Result<std::optional<Swapchain::Acquired>> Swapchain::acquire(bool waits) {
    if (!swapchain_ || stale_ || lost_ || empty(plan_.extent)) return std::optional<Acquired>();
    Acquired acquired{0, acquire_semaphores_[next_acquire_].get(), VK_NULL_HANDLE};
    BOLT_TRY_ASSIGN(const auto got, handle(vkAcquireNextImageKHR(
                                               device_->get(), swapchain_.get(), waits ? acquire_timeout : 0,
                                               acquired.acquired, VK_NULL_HANDLE, &acquired.index),
                                           "acquiring a swapchain image"));
    if (!got) return std::optional<Acquired>();
    next_acquire_ = (next_acquire_ + 1) % frames_in_flight;
    acquired.presentable = present_semaphores_[acquired.index].get();
    return std::optional(acquired);
}

Result<bool> Swapchain::present(Frames& frames, FrameContext& frame, const ShownPicture& picture,
                                bool waits) {
    const WindowPictures window{this, {picture}, waits};
    BOLT_TRY_ASSIGN(const auto presented, gpu::present(frames, frame, {&window, 1}));
    return presented == 1;
}

Result<std::uint32_t> present(Frames& frames, FrameContext& frame, std::span<const WindowPictures> windows,
                              const std::function<Status()>& before_presenting) {
    std::vector<Swapchain*> shown;
    std::vector<VkSemaphore> acquired, presentable;
    std::vector<VkSwapchainKHR> swapchains;
    std::vector<std::uint32_t> indices;
    for (const WindowPictures& window : windows) {
        BOLT_TRY_ASSIGN(const auto image, window.swapchain->acquire(window.waits));
        if (!image) continue;
        window.swapchain->copy(frame.commands(), window.swapchain->images_[image->index], window.pictures);
        shown.push_back(window.swapchain);
        acquired.push_back(image->acquired);
        presentable.push_back(image->presentable);
        swapchains.push_back(window.swapchain->swapchain_.get());
        indices.push_back(image->index);
    }
    BOLT_TRY(frames.submit(frame, {acquired, presentable}));
    if (before_presenting) BOLT_TRY(before_presenting());
    if (shown.empty()) return 0;
    std::vector<VkResult> results(shown.size(), VK_SUCCESS);
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = static_cast<std::uint32_t>(presentable.size());
    info.pWaitSemaphores = presentable.data();
    info.swapchainCount = static_cast<std::uint32_t>(swapchains.size());
    info.pSwapchains = swapchains.data();
    info.pImageIndices = indices.data();
    info.pResults = results.data();
    const VkResult all = vkQueuePresentKHR(shown.front()->device_->queue(), &info);
    std::uint32_t presented = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        // Only `all` reports a failure that concerns no single window, such as a lost device.
        const bool of_window = all == VK_SUBOPTIMAL_KHR || all == VK_ERROR_OUT_OF_DATE_KHR ||
                               all == VK_ERROR_SURFACE_LOST_KHR || all == VK_SUCCESS;
        const VkResult result = of_window && shown.size() > 1 ? results[i] : all;
        BOLT_TRY_ASSIGN(const auto done, shown[i]->handle(result, "presenting a picture"));
        if (!done) continue;
        shown[i]->losses_ = 0;
        ++presented;
    }
    return presented;
}

}  // namespace bolt::gpu
