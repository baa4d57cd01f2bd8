#include "engine/render/passes/outline.hpp"

namespace bolt::render {

using gpu::ResourceUse;

Result<OutlinePass> OutlinePass::create(const PassMaker& maker, std::uint32_t views) {
    OutlinePass pass;
    gpu::GraphicsInfo info;
    draw_views(info, views);
    info.depth_test = info.depth_write = false;
    info.cull = VK_CULL_MODE_NONE;
    info.colors = {mark_format};
    info.vertex = &maker.shaders.at("mark.vert");
    info.fragment = &maker.shaders.at("mark.frag");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    BOLT_TRY(assign(pass.marks_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)));
    info.vertex = &maker.shaders.at("screen.vert");
    info.fragment = &maker.shaders.at("outline.frag");
    info.streams.clear();
    info.strides.clear();
    info.colors = {color_format};
    info.blend = true;
    BOLT_TRY(assign(pass.lines_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)));
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.clamped_, gpu::make_sampler(maker.device, clamped)));
    return pass;
}

Status OutlinePass::draw_marks(PassContext& context, const RenderTargets& targets, const DrawList& list) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, marks_, 0));
    BOLT_TRY_ASSIGN(const auto set,
                    writer.range(0, context.frame_block).range(1, context.instances).finish());
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, targets.marks.get(), ResourceUse::sampled,
                                  ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.marks.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    bind(commands, marks_, set);
    draw_all(commands, list, [](const Draw& d) { return d.outlined; });
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.marks.get(), ResourceUse::color_target, ResourceUse::sampled);
    return {};
}

Status OutlinePass::draw(PassContext& context, RenderTargets& targets, const DrawList& list) {
    const VkRect2D area = area_of(context, list.outlined, context.shared.outline_px + 1.0F);
    if (area.extent.width == 0 || area.extent.height == 0) return {};
    BOLT_TRY(add_mark_target(context.device, targets));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, lines_, 0));
    BOLT_TRY_ASSIGN(
        const auto set,
        writer.range(0, context.frame_block).image(3, targets.marks.view(), clamped_.get()).finish());
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("outline");
    BOLT_TRY(draw_marks(context, targets, list));
    gpu::image_barrier(commands, targets.picture.get(), ResourceUse::color_target, ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    bind(commands, lines_, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
