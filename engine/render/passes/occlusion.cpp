#include "engine/render/passes/occlusion.hpp"

namespace bolt::render {

using gpu::Use;

namespace {

template <class Bind>
Result<VkDescriptorSet> make_set(PassContext& context, const gpu::Pipeline& pipeline, const Bind& bind_to) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, pipeline, 0);
    if (!writer) return fail(writer.error());
    bind_to(*writer);
    return writer->finish();
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
        return take(to, gpu::make_graphics_pipeline(maker.device, maker.cache, info));
    };
    info.depth_compare = VK_COMPARE_OP_ALWAYS;
    if (Status s = make(pass.shrink_, "shrink.frag"); !s) return fail(s.error());
    info.depth_compare = VK_COMPARE_OP_LESS;  // further away than what was drawn
    info.depth_write = false;
    info.colors = {occlusion_format};
    if (Status s = make(pass.slices_, "occlusion.frag"); !s) return fail(s.error());
    if (Status s = make(pass.smooth_, "smooth.frag"); !s) return fail(s.error());
    gpu::SamplerInfo nearest;
    nearest.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    nearest.filter = VK_FILTER_NEAREST;
    if (Status s = take(pass.nearest_, gpu::make_sampler(maker.device, nearest)); !s) return fail(s.error());
    return pass;
}

Status OcclusionPass::shrink(PassContext& context, const Targets& targets) {
    const auto set = make_set(context, shrink_, [&](gpu::SetWriter& w) {
        w.image(3, targets.depth.view(), nearest_.get(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
    });
    if (!set) return fail(set.error());
    const VkCommandBuffer commands = context.frame.commands();
    const gpu::Image& small = targets.small_depth;
    gpu::image_barrier_discarding(commands, small.get(), Use::depth_read, Use::depth_target, depth_range);
    const VkRenderingAttachmentInfo depth =
        attachment(small.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(small.info().extent, context.views, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, small.info().extent);
    bind(commands, shrink_, *set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, small.get(), Use::depth_target, Use::depth_read, depth_range);
    return {};
}

void OcclusionPass::fill(PassContext& context, const Targets& targets, const gpu::Pipeline& pipeline,
                         VkDescriptorSet set, const gpu::Image& target) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, target.get(), Use::sampled, Use::color_target);
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
    gpu::image_barrier(commands, target.get(), Use::color_target, Use::sampled);
}

Status OcclusionPass::draw(PassContext& context, Targets& targets) {
    if (Status made = add_occlusion_targets(context.device, targets); !made) return made;
    const VkSampler nearest = nearest_.get();
    constexpr VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    const auto slices_set = make_set(context, slices_, [&](gpu::SetWriter& w) {
        w.piece(0, context.frame_block)
            .image(3, targets.small_depth.view(), nearest, depth_layout)
            .image(5, targets.surfaces.view(), nearest);
    });
    if (!slices_set) return fail(slices_set.error());
    const auto smooth_set = make_set(context, smooth_, [&](gpu::SetWriter& w) {
        w.piece(0, context.frame_block)
            .image(3, targets.small_depth.view(), nearest, depth_layout)
            .image(4, targets.raw_occlusion.view(), nearest)
            .image(5, targets.surfaces.view(), nearest);
    });
    if (!smooth_set) return fail(smooth_set.error());

    context.frame.begin_timing("occlusion");
    if (Status s = shrink(context, targets); !s) return s;
    fill(context, targets, slices_, *slices_set, targets.raw_occlusion);
    fill(context, targets, smooth_, *smooth_set, targets.occlusion);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
