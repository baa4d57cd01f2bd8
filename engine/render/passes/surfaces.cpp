#include "engine/render/passes/surfaces.hpp"

namespace bolt::render {

using gpu::Use;

Result<const gpu::Pipeline*> SurfacePass::pipeline(gpu::Device& device, const Kind& kind, std::uint32_t views,
                                                   bool wide) {
    // What only matters to light does not make another pipeline.
    Variant variant{kind, views, wide};
    variant.kind.features &= SCENE_ANY_MAP | SCENE_SECOND_UV | SCENE_VERTEX_COLORS | SCENE_TANGENTS |
                             SCENE_ANISOTROPY | SCENE_MASK | SCENE_MARKED | SCENE_WIDE | SCENE_CUT;
    const auto known = pipelines_.find(variant);
    if (known != pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, variant.kind, views);
    info.fragment = &shaders_->at("surface.frag");
    info.colors = {surface_format};
    if (wide) info.colors.insert(info.colors.end(), {wide_color_format, wide_rough_format});
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &pipelines_.emplace(variant, std::move(*made)).first->second;
}

Status SurfacePass::draw(PassContext& context, Targets& targets, const DrawList& list) {
    const bool wide = (list.features & SCENE_WIDE) != 0;
    if (wide)
        if (Status made = add_wide_targets(context.device, targets); !made) return made;
    std::vector<const gpu::Image*> buffers{&targets.surfaces};
    if (wide) buffers.insert(buffers.end(), {&targets.wide_colors, &targets.wide_roughs});

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("surfaces");
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const gpu::Image* image : buffers) {
        gpu::image_barrier_discarding(commands, image->get(), Use::sampled, Use::color_target);
        // What no sample covers is never read.
        colors.push_back(attachment(image->view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE));
    }
    gpu::image_barrier_discarding(commands, targets.depth.get(), Use::depth_read, Use::depth_target,
                                  depth_range);
    VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const bool keeps = targets.kept_depth.get() != VK_NULL_HANDLE;
    if (keeps) {
        gpu::image_barrier_discarding(commands, targets.kept_depth.get(), Use::transfer_from,
                                      Use::depth_target, depth_range);
        depth.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
        depth.resolveImageView = targets.kept_depth.view();
        depth.resolveImageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    }
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, colors, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    PartDrawing drawing;
    drawing.wanted = [](const Kind& kind) { return !kind.forward; };
    drawing.pipeline = [&](const Kind& kind) { return pipeline(context.device, kind, context.views, wide); };
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        return writer->piece(0, context.frame_block)
            .piece(1, context.instances)
            .piece(2, context.materials)
            .finish();
    };
    const Status drawn = draw_parts(context, list, drawing);
    vkCmdEndRendering(commands);
    for (const gpu::Image* image : buffers)
        gpu::image_barrier(commands, image->get(), Use::color_target, Use::sampled);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_target, Use::depth_read, depth_range);
    if (keeps)
        gpu::image_barrier(commands, targets.kept_depth.get(), Use::depth_target, Use::transfer_from,
                           depth_range);
    context.frame.end_timing();
    return drawn;
}

}  // namespace bolt::render
