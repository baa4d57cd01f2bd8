#include "engine/render/targets.hpp"

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

namespace {

Status add(gpu::Device& device, const RenderTargets& targets, gpu::Image& to, VkFormat format,
           VkImageUsageFlags usage, VkSampleCountFlagBits samples, std::uint32_t divisor = 1) {
    if (to.get() != VK_NULL_HANDLE) return {};
    gpu::ImageInfo info;
    info.extent = {(targets.extent.width + divisor - 1) / divisor,
                   (targets.extent.height + divisor - 1) / divisor};
    info.layers = targets.layers;
    info.array = true;  // shaders read the layer of their view
    info.format = format;
    info.samples = samples;
    info.usage = usage;
    return assign(to, gpu::Image::create(device, info));
}

constexpr VkImageUsageFlags drawn_and_read = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags depth_and_read =
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;

}  // namespace

Result<RenderTargets> make_targets(gpu::Device& device, VkExtent2D extent, std::uint32_t layers) {
    RenderTargets t;
    t.extent = extent;
    t.layers = layers;
    BOLT_TRY(add(device, t, t.depth, depth_format, depth_and_read, samples));
    BOLT_TRY(add(device, t, t.surfaces, surface_format, drawn_and_read, samples));
    const VkImageUsageFlags seen = drawn_and_read | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    BOLT_TRY(add(device, t, t.picture, color_format, seen, VK_SAMPLE_COUNT_1_BIT));
    return t;
}

Status add_wide_targets(gpu::Device& device, RenderTargets& t) {
    BOLT_TRY(add(device, t, t.wide_colors, wide_color_format, drawn_and_read, samples));
    return add(device, t, t.wide_roughs, wide_rough_format, drawn_and_read, samples);
}

Status add_forward_targets(gpu::Device& device, RenderTargets& t) {
    BOLT_TRY(add(device, t, t.drawn, layer_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, samples));
    return add(device, t, t.over, layer_format, drawn_and_read, VK_SAMPLE_COUNT_1_BIT);
}

Status add_mark_target(gpu::Device& device, RenderTargets& t) {
    return add(device, t, t.marks, mark_format, drawn_and_read, VK_SAMPLE_COUNT_1_BIT);
}

Status add_occlusion_targets(gpu::Device& device, RenderTargets& t) {
    constexpr VkSampleCountFlagBits one = VK_SAMPLE_COUNT_1_BIT;
    BOLT_TRY(add(device, t, t.small_depth, depth_format, depth_and_read, one, 2));
    BOLT_TRY(add(device, t, t.raw_occlusion, occlusion_format, drawn_and_read, one, 2));
    return add(device, t, t.occlusion, occlusion_format, drawn_and_read, one, 2);
}

Status add_kept_depth(gpu::Device& device, RenderTargets& t) {
    return add(device, t, t.kept_depth, depth_format,
               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
               VK_SAMPLE_COUNT_1_BIT);
}

}  // namespace bolt::render
