#include "engine/gpu/swapchain.hpp"

#include <utility>

#include "engine/gpu/barrier.hpp"
#include "engine/gpu/listed.hpp"

namespace bolt::gpu {

namespace {

// A window that is hidden may give no image for as long as it is: events must go on meanwhile.
constexpr std::uint64_t longest_wait = 200'000'000;  // ns
constexpr std::uint32_t most_losses = 3;             // in a row

bool same(VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; }
bool empty(VkExtent2D extent) { return extent.width == 0 || extent.height == 0; }

Result<Semaphore> make_semaphore(const Device& device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    if (Status made =
            check(vkCreateSemaphore(device.get(), &info, nullptr, &semaphore), "making a semaphore");
        !made)
        return fail(made.error());
    return Semaphore(device.get(), semaphore);
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, Surface surface,
                                                     MakeSurface make_surface,
                                                     const SwapchainOptions& options) {
    std::unique_ptr<Swapchain> swapchain(new Swapchain());
    swapchain->device_ = &device;
    swapchain->options_ = options;
    swapchain->surface_ = std::move(surface);
    swapchain->make_surface_ = std::move(make_surface);
    for (Semaphore& semaphore : swapchain->acquired_) {
        Result<Semaphore> made = make_semaphore(device);
        if (!made) return fail(made.error());
        semaphore = std::move(*made);
    }
    return swapchain;
}

Swapchain::~Swapchain() {
    (void)device_->idle();  // a lost device has nothing in use either
}

// What a result means here: true: go on; false: not now, but the next picture may be shown.
Result<bool> Swapchain::judge(VkResult result, std::string_view what) {
    switch (result) {
        case VK_SUCCESS:
            return true;
        case VK_SUBOPTIMAL_KHR:
            if (!suboptimal_is_normal_) stale_ = suboptimal_ = true;
            return true;
        case VK_NOT_READY:
        case VK_TIMEOUT:
            return false;
        case VK_ERROR_OUT_OF_DATE_KHR:
            stale_ = true;
            return false;
        case VK_ERROR_SURFACE_LOST_KHR:
            lost_ = true;
            if (++losses_ < most_losses) return false;
            [[fallthrough]];
        default:
            break;
    }
    if (Status ok = check(result, what); !ok) return fail(ok.error());
    return true;
}

Status Swapchain::replace_surface() {
    if (Status idle = device_->idle(); !idle) return idle;
    images_.clear();
    swapchain_ = SwapchainHandle();
    surface_ = Surface();
    Result<Surface> made = make_surface_();
    if (!made) return fail(made.error());
    surface_ = std::move(*made);
    VkBool32 shows = VK_FALSE;
    const VkResult asked = vkGetPhysicalDeviceSurfaceSupportKHR(device_->physical(), device_->queue_family(),
                                                                surface_.get(), &shows);
    if (Status known = check(asked, "asking what the window can show"); !known) return known;
    if (shows != VK_TRUE)
        return fail(ErrorCode::no_device, "the window is on a display that this GPU cannot show on any more");
    lost_ = false;
    stale_ = true;
    return {};
}

// False: the surface is gone.
Result<bool> Swapchain::remake(VkExtent2D window) {
    SurfaceOffer offer;
    if (Result<bool> asked =
            judge(ask_surface(device_->physical(), surface_.get(), offer), "asking what the window can show");
        !asked || !*asked)
        return asked;
    Result<SwapchainPlan> plan = plan_swapchain(offer, {window, options_.may_tear, frames_in_flight});
    if (!plan) return fail(plan.error());
    suboptimal_is_normal_ = suboptimal_ && same(plan->extent, plan_.extent);
    plan_ = std::move(*plan);
    window_ = window;
    if (empty(plan_.extent)) return true;
    // Afterwards nothing of the old one is in use, and its semaphores are free.
    if (Status idle = device_->idle(); !idle) return fail(idle.error());

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
    drawn_.clear();
    swapchain_ = SwapchainHandle(device_->get(), raw);
    if (Result<bool> made = judge(result, "making the window's images"); !made || !*made) return made;
    const VkResult got = listed(images_, [&](std::uint32_t* count, VkImage* images) {
        return vkGetSwapchainImagesKHR(device_->get(), raw, count, images);
    });
    if (Status ok = check(got, "asking for the window's images"); !ok) return fail(ok.error());
    while (drawn_.size() < images_.size()) {
        Result<Semaphore> made = make_semaphore(*device_);
        if (!made) return fail(made.error());
        drawn_.push_back(std::move(*made));
    }
    ++made_;
    stale_ = suboptimal_ = false;
    return true;
}

Result<VkExtent2D> Swapchain::ready(VkExtent2D window) {
    while (lost_ || stale_ || !same(window, window_)) {
        if (lost_)
            if (Status replaced = replace_surface(); !replaced) return fail(replaced.error());
        const Result<bool> made = remake(window);
        if (!made) return fail(made.error());
        if (*made) break;
    }
    return plan_.extent;
}

void Swapchain::copy(VkCommandBuffer commands, VkImage to, const Image& picture, std::uint32_t layer) const {
    image_barrier(commands, to, Use::acquired, Use::transfer_to);
    const VkExtent2D from_size = picture.info().extent, to_size = plan_.extent;
    const VkImageSubresourceLayers from_layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1},
        to_layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    if (same(from_size, to_size) && picture.info().format == plan_.format.format) {
        VkImageCopy region{};
        region.srcSubresource = from_layer;
        region.dstSubresource = to_layer;
        region.extent = {to_size.width, to_size.height, 1};
        vkCmdCopyImage(commands, picture.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    } else {
        const auto corner = [](VkExtent2D size) {
            return VkOffset3D{static_cast<std::int32_t>(size.width), static_cast<std::int32_t>(size.height),
                              1};
        };
        VkImageBlit region{};
        region.srcSubresource = from_layer;
        region.srcOffsets[1] = corner(from_size);
        region.dstSubresource = to_layer;
        region.dstOffsets[1] = corner(to_size);
        const VkFilter filter = same(from_size, to_size) ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
        vkCmdBlitImage(commands, picture.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, filter);
    }
    image_barrier(commands, to, Use::transfer_to, Use::present);
}

Result<bool> Swapchain::show(Frames& frames, Frame& frame, const Image& picture, std::uint32_t layer) {
    if (!swapchain_ || stale_ || lost_ || empty(plan_.extent)) {
        if (Status sent = frames.submit(frame); !sent) return fail(sent.error());
        return false;
    }
    const VkSemaphore acquired = acquired_[next_acquired_].get();
    std::uint32_t index = 0;
    const Result<bool> got = judge(vkAcquireNextImageKHR(device_->get(), swapchain_.get(), longest_wait,
                                                         acquired, VK_NULL_HANDLE, &index),
                                   "getting an image of the window");
    if (!got) return fail(got.error());
    if (!*got) {
        if (Status sent = frames.submit(frame); !sent) return fail(sent.error());
        return false;
    }
    next_acquired_ = (next_acquired_ + 1) % frames_in_flight;
    copy(frame.commands(), images_[index], picture, layer);
    const VkSemaphore drawn = drawn_[index].get();
    if (Status sent = frames.submit(frame, {acquired, drawn}); !sent) return fail(sent.error());

    const VkSwapchainKHR swapchain = swapchain_.get();
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    const Result<bool> shown =
        judge(vkQueuePresentKHR(device_->queue(), &info), "showing a picture in the window");
    if (shown && *shown) losses_ = 0;
    return shown;
}

}  // namespace bolt::gpu
