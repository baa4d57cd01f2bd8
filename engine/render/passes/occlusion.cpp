#include "engine/render/passes/occlusion.hpp"

namespace bolt::render {

using gpu::ResourceUse;

namespace {

template <class Bind>
Result<VkDescriptorSet> make_set(PassContext& context, const gpu::Pipeline& pipeline, const Bind& bind_to) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
    bind_to(writer);
    return writer.finish();
}

}  // namespace

Result<OcclusionPass> OcclusionPass::create(const PassMaker& maker, std::uint32_t views) {
    OcclusionPass pass;
    gpu::GraphicsInfo info;
    draw_views(info, views);
    info.vertex = &maker.shaders.at("screen.vert");
    info.cull = VK_CULL_MODE_NONE;
    info.depth = depth_format;
    const auto make = [&](gpu::Pipeline& to, const char* fragment) {
        info.fragment = &maker.shaders.at(fragment);
        return assign(to, gpu::make_graphics_pipeline(maker.device, maker.cache, info));
    };
    info.depth_compare = VK_COMPARE_OP_ALWAYS;
    BOLT_TRY(make(pass.shrink_, "shrink.frag"));
    info.depth_compare = VK_COMPARE_OP_LESS;  // farther away than the drawn geometry
    info.depth_write = false;
    info.colors = {occlusion_format};
    BOLT_TRY(make(pass.slices_, "occlusion.frag"));
    BOLT_TRY(make(pass.smooth_, "smooth.frag"));
    gpu::SamplerInfo nearest;
    nearest.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    nearest.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(maker.device, nearest)));
    return pass;
}

Status OcclusionPass::shrink(PassContext& context, const RenderTargets& targets) {
    BOLT_TRY_ASSIGN(const auto set, make_set(context, shrink_, [&](gpu::DescriptorWriter& w) {
                        w.image(3, targets.depth.view(), nearest_.get(),
                                VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
                    }));
    const VkCommandBuffer commands = context.frame.commands();
    const gpu::Image& small = targets.small_depth;
    gpu::image_barrier_discarding(commands, small.get(), ResourceUse::depth_read, ResourceUse::depth_target,
                                  depth_range);
    const VkRenderingAttachmentInfo depth =
        attachment(small.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(small.info().extent, context.views, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, small.info().extent);
    bind(commands, shrink_, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, small.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    return {};
}

void OcclusionPass::fill(PassContext& context, const RenderTargets& targets, const gpu::Pipeline& pipeline,
                         VkDescriptorSet set, const gpu::Image& target) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, target.get(), ResourceUse::sampled, ResourceUse::color_target);
    VkRenderingAttachmentInfo color = attachment(target.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                 VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    color.clearValue.color = {{1.0F, 1.0F, 1.0F, 1.0F}};
    const VkRenderingAttachmentInfo depth =
        attachment(targets.small_depth.view(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
    const VkRenderingInfo rendering =
        rendering_info(target.info().extent, context.views, {&color, 1}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, target.info().extent);
    bind(commands, pipeline, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, target.get(), ResourceUse::color_target, ResourceUse::sampled);
}

Status OcclusionPass::draw(PassContext& context, RenderTargets& targets) {
    BOLT_TRY(add_occlusion_targets(context.device, targets));
    const VkSampler nearest = nearest_.get();
    constexpr VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    BOLT_TRY_ASSIGN(const auto slices_set, make_set(context, slices_, [&](gpu::DescriptorWriter& w) {
                        w.range(0, context.frame_block)
                            .image(3, targets.small_depth.view(), nearest, depth_layout)
                            .image(5, targets.surfaces.view(), nearest);
                    }));
    BOLT_TRY_ASSIGN(const auto smooth_set, make_set(context, smooth_, [&](gpu::DescriptorWriter& w) {
                        w.range(0, context.frame_block)
                            .image(3, targets.small_depth.view(), nearest, depth_layout)
                            .image(4, targets.raw_occlusion.view(), nearest)
                            .image(5, targets.surfaces.view(), nearest);
                    }));

    context.frame.begin_timing("occlusion");
    BOLT_TRY(shrink(context, targets));
    fill(context, targets, slices_, slices_set, targets.raw_occlusion);
    fill(context, targets, smooth_, smooth_set, targets.occlusion);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
