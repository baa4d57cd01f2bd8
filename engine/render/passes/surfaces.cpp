#include "engine/render/passes/surfaces.hpp"

namespace bolt::render {

using gpu::ResourceUse;

Result<const gpu::Pipeline*> SurfacePass::pipeline(gpu::Device& device, const PipelineKind& kind,
                                                   std::uint32_t views, bool wide) {
    // Features that only lighting uses do not need another pipeline.
    Variant variant{kind, views, wide};
    variant.kind.features &= SCENE_ANY_MAP | SCENE_SECOND_UV | SCENE_VERTEX_COLORS | SCENE_TANGENTS |
                             SCENE_ANISOTROPY | SCENE_MASK | SCENE_MARKED | SCENE_WIDE | SCENE_CUT;
    const auto known = pipelines_.find(variant);
    if (known != pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, variant.kind, views);
    info.fragment = &shaders_->at("surface.frag");
    info.colors = {surface_format};
    if (wide) info.colors.insert(info.colors.end(), {wide_color_format, wide_rough_format});
    BOLT_TRY_ASSIGN(auto made, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(variant, std::move(made)).first->second;
}

Status SurfacePass::draw(PassContext& context, RenderTargets& targets, const DrawList& list) {
    const bool wide = (list.features & SCENE_WIDE) != 0;
    if (wide) BOLT_TRY(add_wide_targets(context.device, targets));
    std::vector<const gpu::Image*> buffers{&targets.surfaces};
    if (wide) buffers.insert(buffers.end(), {&targets.wide_colors, &targets.wide_roughs});

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("surfaces");
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const gpu::Image* image : buffers) {
        gpu::image_barrier_discarding(commands, image->get(), ResourceUse::sampled,
                                      ResourceUse::color_target);
        // Pixels without a covered sample are never read.
        colors.push_back(attachment(image->view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE));
    }
    gpu::image_barrier_discarding(commands, targets.depth.get(), ResourceUse::depth_read,
                                  ResourceUse::depth_target, depth_range);
    VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const bool keeps = targets.kept_depth.get() != VK_NULL_HANDLE;
    if (keeps) {
        gpu::image_barrier_discarding(commands, targets.kept_depth.get(), ResourceUse::transfer_from,
                                      ResourceUse::depth_target, depth_range);
        depth.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
        depth.resolveImageView = targets.kept_depth.view();
        depth.resolveImageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    }
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, colors, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    PartDrawing drawing;
    drawing.wanted = [](const PipelineKind& kind) { return !kind.forward; };
    drawing.pipeline = [&](const PipelineKind& kind) {
        return pipeline(context.device, kind, context.views, wide);
    };
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, made, 0));
        return writer.range(0, context.frame_block)
            .range(1, context.instances)
            .range(2, context.materials)
            .finish();
    };
    const Status drawn = draw_parts(context, list, drawing);
    vkCmdEndRendering(commands);
    for (const gpu::Image* image : buffers)
        gpu::image_barrier(commands, image->get(), ResourceUse::color_target, ResourceUse::sampled);
    gpu::image_barrier(commands, targets.depth.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    if (keeps)
        gpu::image_barrier(commands, targets.kept_depth.get(), ResourceUse::depth_target,
                           ResourceUse::transfer_from, depth_range);
    context.frame.end_timing();
    return drawn;
}

}  // namespace bolt::render
