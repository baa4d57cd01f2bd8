#include "engine/render/passes/forward.hpp"

namespace bolt::render {

using gpu::Use;

Result<ForwardPass> ForwardPass::create(const PassMaker& maker, std::uint32_t views) {
    ForwardPass pass;
    pass.cache_ = &maker.cache;
    pass.shaders_ = &maker.shaders;
    pass.views_ = views;
    gpu::GraphicsInfo info;
    info.vertex = &maker.shaders.at("screen.vert");
    info.fragment = &maker.shaders.at("over.frag");
    info.colors = {color_format};
    draw_views(info, views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.blend = true;
    if (Status s = take(pass.over_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)); !s)
        return fail(s.error());
    gpu::SamplerInfo nearest;
    nearest.filter = VK_FILTER_NEAREST;
    if (Status s = take(pass.nearest_, gpu::make_sampler(maker.device, nearest)); !s) return fail(s.error());
    return pass;
}

Result<const gpu::Pipeline*> ForwardPass::forward_pipeline(gpu::Device& device, const Kind& kind) {
    const auto known = forwards_.find(kind);
    if (known != forwards_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, kind, views_);
    info.fragment = &shaders_->at("scene.frag");
    info.colors = {layer_format};
    info.blend = kind.blends;
    info.depth_write = !kind.blends;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &forwards_.emplace(kind, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> ForwardPass::ghost_pipeline(gpu::Device& device, const Kind& kind) {
    Kind shape;
    shape.double_sided = kind.double_sided;
    const auto known = ghosts_.find(shape);
    if (known != ghosts_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, shape, views_);
    info.colors = {layer_format};
    info.color_write = false;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &ghosts_.emplace(shape, std::move(*made)).first->second;
}

Status ForwardPass::draw_all_parts(PassContext& context, const DrawList& list, const LightPass& light,
                                   const LightInputs& inputs) {
    PartDrawing drawing;
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        return writer->piece(0, context.frame_block).piece(1, context.instances).finish();
    };
    // Of a ghost only what is nearest shows: its depth comes first.
    drawing.wanted = [](const Kind& kind) { return kind.ghost; };
    drawing.pipeline = [&](const Kind& kind) { return ghost_pipeline(context.device, kind); };
    if (Status s = draw_parts(context, list, drawing); !s) return s;
    const Box around = end_of(context.scene.cut_away);
    const VkRect2D all{{0, 0}, context.extent}, end = area_of(context, {&around, 1}, 1.0F);
    drawing.area = [&](const Kind& kind) { return (kind.features & SCENE_CUT_REST) != 0 ? end : all; };
    drawing.wanted = [](const Kind& kind) { return kind.forward; };
    drawing.pipeline = [&](const Kind& kind) { return forward_pipeline(context.device, kind); };
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        light.bind_inputs(context, *writer, inputs);
        return writer->piece(1, context.instances).finish();
    };
    return draw_parts(context, list, drawing);
}

Status ForwardPass::draw(PassContext& context, Targets& targets, const DrawList& list, const LightPass& light,
                         const LightInputs& inputs) {
    const VkRect2D area = area_of(context, list.forward, 1.0F);
    if (area.extent.width == 0 || area.extent.height == 0) return {};
    if (Status made = add_forward_targets(context.device, targets); !made) return made;
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, over_, 0);
    if (!writer) return fail(writer.error());
    const auto set = writer->image(3, targets.over.view(), nearest_.get()).finish();
    if (!set) return fail(set.error());

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("forward");
    gpu::image_barrier_discarding(commands, targets.drawn.get(), Use::color_target, Use::color_target);
    gpu::image_barrier_discarding(commands, targets.over.get(), Use::sampled, Use::color_target);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_read, Use::depth_target, depth_range);
    VkRenderingAttachmentInfo color =
        attachment(targets.drawn.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_DONT_CARE);
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = targets.over.view();
    color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_STORE);
    VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1}, &depth);
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    const Status done = draw_all_parts(context, list, light, inputs);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_target, Use::depth_read, depth_range);
    gpu::image_barrier(commands, targets.over.get(), Use::color_target, Use::sampled);
    gpu::image_barrier(commands, targets.picture.get(), Use::color_target, Use::color_target);

    color = attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    rendering = rendering_info(context.extent, context.views, {&color, 1});
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    bind(commands, over_, *set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return done;
}

}  // namespace bolt::render
