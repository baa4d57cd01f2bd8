#include "engine/render/passes/multiview_check.hpp"

#include <algorithm>
#include <cstdlib>

#include "engine/gpu/resources.hpp"
#include "engine/render/hot_shaders.hpp"
#include "engine/render/passes/pass.hpp"

namespace bolt::render {

namespace {

constexpr VkExtent2D extent{8, 8};
constexpr VkFormat format = VK_FORMAT_R8_UNORM;

Result<gpu::Pipeline> make_pipeline(gpu::Device& device, const gpu::PipelineCache& cache) {
    BOLT_TRY_ASSIGN(auto vertex, load_shader("multiview_check.vert", {}));
    BOLT_TRY_ASSIGN(auto fragment, load_shader("multiview_check.frag", {}));
    gpu::GraphicsInfo info;
    info.vertex = &vertex;
    info.fragment = &fragment;
    info.colors = {format};
    info.view_mask = view_mask(2);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    return gpu::make_graphics_pipeline(device, cache, info);
}

// Whether every texel of the layer is within one level of `expected`, of 255.
Result<bool> has_value(gpu::Device& device, const gpu::Image& image, std::uint32_t layer, int expected) {
    BOLT_TRY_ASSIGN(const auto texels,
                    gpu::download_image(device, image, gpu::ResourceUse::color_target, 1, 0, layer));
    return std::all_of(texels.begin(), texels.end(), [&](std::byte texel) {
        return std::abs(std::to_integer<int>(texel) - expected) <= 1;
    });
}

}  // namespace

Result<bool> multiview_works(gpu::Device& device, const gpu::PipelineCache& cache) {
    BOLT_TRY_ASSIGN(const auto pipeline, make_pipeline(device, cache));
    BOLT_TRY_ASSIGN(const auto image,
                    gpu::Image::create(device, {.format = format,
                                                .extent = extent,
                                                .layers = 2,
                                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                         VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    BOLT_TRY(gpu::submit_and_wait(device, [&](VkCommandBuffer commands) {
        gpu::image_barrier_discarding(commands, image.get(), gpu::ResourceUse::color_target,
                                      gpu::ResourceUse::color_target);
        VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        color.imageView = image.view();
        color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        const VkRenderingInfo rendering = rendering_info(extent, 2, {&color, 1}, nullptr);
        vkCmdBeginRendering(commands, &rendering);
        set_area(commands, extent);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle.get());
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRendering(commands);
    }));
    BOLT_TRY_ASSIGN(const bool first, has_value(device, image, 0, 255));
    BOLT_TRY_ASSIGN(const bool second, has_value(device, image, 1, 128));
    return first && second;
}

}  // namespace bolt::render
