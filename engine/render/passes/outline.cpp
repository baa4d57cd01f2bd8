#include "engine/render/passes/outline.hpp"

namespace bolt::render {

using gpu::Use;

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
    if (Status s = take(pass.marks_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)); !s)
        return fail(s.error());
    info.vertex = &maker.shaders.at("screen.vert");
    info.fragment = &maker.shaders.at("outline.frag");
    info.streams.clear();
    info.strides.clear();
    info.colors = {color_format};
    info.blend = true;
    if (Status s = take(pass.lines_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)); !s)
        return fail(s.error());
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (Status s = take(pass.clamped_, gpu::make_sampler(maker.device, clamped)); !s) return fail(s.error());
    return pass;
}

Status OutlinePass::draw_marks(PassContext& context, const Targets& targets, const DrawList& list) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, marks_, 0);
    if (!writer) return fail(writer.error());
    const auto set = writer->piece(0, context.frame_block).piece(1, context.instances).finish();
    if (!set) return fail(set.error());
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, targets.marks.get(), Use::sampled, Use::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.marks.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    bind(commands, marks_, *set);
    draw_all(commands, list, [](const Draw& d) { return d.outlined; });
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.marks.get(), Use::color_target, Use::sampled);
    return {};
}

Status OutlinePass::draw(PassContext& context, Targets& targets, const DrawList& list) {
    const VkRect2D area = area_of(context, list.outlined, context.shared.outline_px + 1.0F);
    if (area.extent.width == 0 || area.extent.height == 0) return {};
    if (Status made = add_mark_target(context.device, targets); !made) return made;
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, lines_, 0);
    if (!writer) return fail(writer.error());
    const auto set =
        writer->piece(0, context.frame_block).image(3, targets.marks.view(), clamped_.get()).finish();
    if (!set) return fail(set.error());
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("outline");
    if (Status marked = draw_marks(context, targets, list); !marked) return marked;
    gpu::image_barrier(commands, targets.picture.get(), Use::color_target, Use::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    bind(commands, lines_, *set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
