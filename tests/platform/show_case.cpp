#include "tests/platform/show_case.hpp"

#include <cmath>

#include "engine/gpu/resources.hpp"

namespace bolt::test {

ShowCase::ShowCase(const std::string& title) {
    desktop_ = need(platform::Desktop::open());
    window_ = need(platform::Window::open(*desktop_, {title, 320, 240}));
    const std::vector<const char*> extensions = need(desktop_->vulkan_extensions());
    gpu::InstanceOptions options;
    options.validation = true;
    options.extensions = extensions;
    instance_.emplace(need(gpu::Instance::create(options)));
    make_gpu();
}

ShowCase::~ShowCase() {
    swapchain_.reset();
    picture_ = gpu::Image();
    frames_.reset();
    device_.reset();
    for (const std::string& message : log().messages) CHECK_MESSAGE(false, message);
}

void ShowCase::make_gpu() {
    swapchain_.reset();
    picture_ = gpu::Image();
    frames_.reset();
    device_.reset();
    const gpu::MakeSurface make_surface = [this] { return window_->make_surface(*instance_); };
    gpu::Surface surface = need(make_surface());
    device_ = need(gpu::Device::create(*instance_, {"", surface.get()}));
    frames_ = need(gpu::Frames::create(*device_));
    swapchain_ = need(gpu::Swapchain::create(*device_, std::move(surface), make_surface));
}

Status ShowCase::prepare_picture(VkExtent2D extent) {
    const VkExtent2D has = picture_.info().extent;
    if (picture_.get() != VK_NULL_HANDLE && has.width == extent.width && has.height == extent.height)
        return {};
    if (Status idle = device_->idle(); !idle) return idle;
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R8G8B8A8_SRGB;
    info.extent = extent;
    info.usage =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    Result<gpu::Image> made = gpu::Image::create(*device_, info);
    if (!made) return fail(made.error());
    picture_ = std::move(*made);
    return {};
}

Result<bool> ShowCase::show(std::array<int, 3> color) {
    (void)window_->poll_events();
    const platform::Size size = window_->pixels();
    const Result<VkExtent2D> extent = swapchain_->prepare({size.width, size.height});
    if (!extent) return fail(extent.error());
    drawn = *extent;
    if (drawn.width == 0 || drawn.height == 0) return false;
    if (Status made = prepare_picture(picture_size.value_or(drawn)); !made) return fail(made.error());
    Result<gpu::FrameContext*> frame = frames_->begin();
    if (!frame) return fail(frame.error());
    const VkCommandBuffer commands = (*frame)->commands();
    gpu::image_barrier_discarding(commands, picture_.get(), gpu::ResourceUse::transfer_from,
                                  gpu::ResourceUse::transfer_to);
    VkClearColorValue clear{};
    for (std::size_t i = 0; i < 3; ++i) {  // IEC 61966-2-1
        const double s = color[i] / 255.0;
        clear.float32[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, picture_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &clear, 1, &all);
    gpu::image_barrier(commands, picture_.get(), gpu::ResourceUse::transfer_to,
                       gpu::ResourceUse::transfer_from);
    return swapchain_->present(*frames_, **frame, {&picture_, 0, {}, {}});
}

void ShowCase::show_surely(std::array<int, 3> color) {
    for (int attempt = 0; attempt < 20; ++attempt)
        if (need(show(color))) return;
    FAIL("nothing was shown in twenty frames");
}

}  // namespace bolt::test
