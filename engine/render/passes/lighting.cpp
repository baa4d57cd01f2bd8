#include "engine/render/passes/lighting.hpp"

#include "engine/gpu/resources.hpp"
#include "engine/render/gpu_layout.hpp"

namespace bolt::render {

using gpu::ResourceUse;

Result<LightPass> LightPass::create(const PassSetup& setup) {
    LightPass pass;
    pass.cache_ = &setup.cache;
    pass.shaders_ = &setup.shaders;
    pass.stage_ = setup.screen_stage;
    BOLT_TRY(assign(pass.albedo_table_, upload_albedo_table(setup.device)));
    gpu::ImageInfo no_material_buffer;
    no_material_buffer.format = material_roughness_format;
    no_material_buffer.samples = samples;
    no_material_buffer.array = true;
    no_material_buffer.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    BOLT_TRY(assign(pass.no_material_buffer_, gpu::Image::create(setup.device, no_material_buffer)));
    BOLT_TRY(gpu::submit_and_wait(setup.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.no_material_buffer_.get(), ResourceUse::undefined,
                           ResourceUse::sampled);
    }));
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.clamped_, gpu::make_sampler(setup.device, clamped)));
    gpu::SamplerInfo nearest = clamped;
    nearest.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(setup.device, nearest)));
    clamped.compares = true;
    BOLT_TRY(assign(pass.comparing_, gpu::make_sampler(setup.device, clamped)));
    return pass;
}

Result<const gpu::Pipeline*> LightPass::light_pipeline(gpu::Device& device, std::uint32_t features,
                                                       std::uint32_t views) {
    const auto known = lights_.find({features, views});
    if (known != lights_.end()) return &known->second;
    const auto keep = [&](gpu::Pipeline pipeline) {
        return &lights_.emplace(std::pair{features, views}, std::move(pipeline)).first->second;
    };
    if (stage_ == ScreenStage::compute) {
        BOLT_TRY_ASSIGN(auto pipeline,
                        gpu::make_compute_pipeline(device, *cache_, shaders_->at("light.comp"), features));
        return keep(std::move(pipeline));
    }
    gpu::GraphicsInfo info;
    info.vertex = &shaders_->at("light.vert");
    info.fragment = &shaders_->at("light.frag");
    info.colors = {color_format};
    set_views(info, views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.constants |= features;
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return keep(std::move(pipeline));
}

void LightPass::bind_inputs(PassContext& context, gpu::DescriptorWriter& writer,
                            const LightInputs& inputs) const {
    const VkSampler clamped = clamped_.get();
    writer.range(0, context.frame_block)
        .range(2, context.materials)
        .image(3, albedo_table_.view(), clamped)
        .image(4, context.environment.levels.view(), clamped)
        .image(5, inputs.shadow_map->view(), comparing_.get(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(6, inputs.occlusion != VK_NULL_HANDLE ? inputs.occlusion : context.white_array, clamped);
}

Result<VkDescriptorSet> LightPass::light_set(PassContext& context, const RenderTargets& targets,
                                             const gpu::Pipeline& pipeline, const LightInputs& inputs,
                                             bool per_pixel_material) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
    bind_inputs(context, writer, inputs);
    const VkSampler nearest = nearest_.get();
    if (stage_ == ScreenStage::compute)
        writer.image(11, targets.picture.storage_view(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL);
    return writer.image(7, targets.depth.view(), nearest, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(8, targets.surfaces.view(), nearest)
        .image(9, per_pixel_material ? targets.material_colors.view() : no_material_buffer_.view(), nearest)
        .image(10, per_pixel_material ? targets.material_roughness.view() : no_material_buffer_.view(),
               nearest)
        .finish();
}

Status LightPass::shade_surfaces(PassContext& context, const RenderTargets& targets, const DrawList& list,
                                 const LightInputs& inputs) {
    constexpr std::uint32_t lighting_features =
        SCENE_TANGENTS | SCENE_COAT | SCENE_ANISOTROPY | SCENE_OCCLUSION_MAP | SCENE_PER_PIXEL_MATERIAL;
    const std::uint32_t features = (list.features & lighting_features) | features_of(context.scene) |
                                   (context.scene.background.w > 0.5F ? SCENE_COLOR_BACKGROUND : 0U) |
                                   (context.scene.transparent ? SCENE_TRANSPARENT : 0U) |
                                   (has_hidden_area(context.eyes) ? SCENE_HIDDEN_AREA : 0U);
    BOLT_TRY_ASSIGN(const auto pipeline, light_pipeline(context.device, features, context.views));
    BOLT_TRY_ASSIGN(const auto set, light_set(context, targets, *pipeline, inputs,
                                              (list.features & SCENE_PER_PIXEL_MATERIAL) != 0));
    const VkCommandBuffer commands = context.frame.commands();
    if (stage_ == ScreenStage::compute) {
        dispatch_screen(commands, *pipeline, set, context.extent, context.views);
    } else {
        bind(commands, *pipeline, set);
        draw_screen(commands);
    }
    return {};
}

Status LightPass::draw(PassContext& context, RenderTargets& targets, const DrawList& list,
                       const LightInputs& inputs) {
    const VkCommandBuffer commands = context.frame.commands();
    const bool computed = stage_ == ScreenStage::compute;
    const ResourceUse written = computed ? ResourceUse::storage_write : ResourceUse::color_target;
    gpu::image_barrier_discarding(commands, targets.picture.get(), ResourceUse::transfer_from, written);
    context.frame.begin_timing("light");
    if (!computed) {
        const VkRenderingAttachmentInfo color =
            attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE);
        const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
        vkCmdBeginRendering(commands, &rendering);
        set_area(commands, context.extent);
    }
    const Status done = shade_surfaces(context, targets, list, inputs);
    if (!computed) vkCmdEndRendering(commands);
    context.frame.end_timing();
    if (computed)
        gpu::image_barrier(commands, targets.picture.get(), ResourceUse::storage_write,
                           ResourceUse::color_target);
    return done;
}

Result<ForwardPass> ForwardPass::create(const PassSetup& setup, std::uint32_t views) {
    ForwardPass pass;
    pass.cache_ = &setup.cache;
    pass.shaders_ = &setup.shaders;
    pass.views_ = views;
    const gpu::GraphicsInfo info = over_picture(setup.shaders, "screen.vert", "over.frag", views);
    BOLT_TRY(assign(pass.over_, gpu::make_graphics_pipeline(setup.device, setup.cache, info)));
    gpu::SamplerInfo nearest;
    nearest.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(setup.device, nearest)));
    return pass;
}

Result<const gpu::Pipeline*> ForwardPass::forward_pipeline(gpu::Device& device, const PipelineKind& kind) {
    const auto known = forwards_.find(kind);
    if (known != forwards_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, kind, views_);
    info.fragment = &shaders_->at("scene.frag");
    info.colors = {layer_format};
    info.blend = kind.blends;
    info.depth_write = !kind.blends;
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &forwards_.emplace(kind, std::move(pipeline)).first->second;
}

Result<const gpu::Pipeline*> ForwardPass::ghost_pipeline(gpu::Device& device, const PipelineKind& kind) {
    PipelineKind shape;
    shape.double_sided = kind.double_sided;
    const auto known = ghosts_.find(shape);
    if (known != ghosts_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, shape, views_);
    info.colors = {layer_format};
    info.written_colors = 0;
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &ghosts_.emplace(shape, std::move(pipeline)).first->second;
}

Status ForwardPass::draw_all_parts(PassContext& context, const DrawList& list, const LightPass& light,
                                   const LightInputs& inputs) {
    PartDrawing drawing;
    drawing.frame_set = [&](const gpu::Pipeline& pipeline) -> Result<VkDescriptorSet> {
        BOLT_TRY_ASSIGN(auto writer,
                        gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
        return writer.range(0, context.frame_block).range(1, context.instances).finish();
    };
    // Draws the depth of ghosts first, so that only their nearest layer is visible.
    drawing.wanted = [](const PipelineKind& kind) { return kind.ghost; };
    drawing.pipeline = [&](const PipelineKind& kind) { return ghost_pipeline(context.device, kind); };
    BOLT_TRY(draw_parts(context, list, drawing));
    const BoundingBox end_box = cone_end(context.scene.cut_away);
    const VkRect2D all{{0, 0}, context.extent}, end = area_of(context, {&end_box, 1}, 1.0F);
    drawing.area = [&](const PipelineKind& kind) {
        return (kind.features & SCENE_CUT_FADING) != 0 ? end : all;
    };
    drawing.wanted = [](const PipelineKind& kind) { return kind.forward; };
    drawing.pipeline = [&](const PipelineKind& kind) { return forward_pipeline(context.device, kind); };
    drawing.frame_set = [&](const gpu::Pipeline& pipeline) -> Result<VkDescriptorSet> {
        BOLT_TRY_ASSIGN(auto writer,
                        gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
        light.bind_inputs(context, writer, inputs);
        return writer.range(1, context.instances).finish();
    };
    return draw_parts(context, list, drawing);
}

Status ForwardPass::draw(PassContext& context, RenderTargets& targets, const DrawList& list,
                         const LightPass& light, const LightInputs& inputs) {
    const VkRect2D area = area_of(context, list.forward, 1.0F);
    if (area.extent.width == 0 || area.extent.height == 0) return {};
    BOLT_TRY(add_forward_targets(context.device, targets));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, over_, 0));
    BOLT_TRY_ASSIGN(const auto set,
                    writer.image(3, targets.forward_resolved.view(), nearest_.get()).finish());

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("forward");
    gpu::image_barrier_discarding(commands, targets.forward_color.get(), ResourceUse::color_target,
                                  ResourceUse::color_target);
    gpu::image_barrier_discarding(commands, targets.forward_resolved.get(), ResourceUse::sampled,
                                  ResourceUse::color_target);
    gpu::image_barrier(commands, targets.depth.get(), ResourceUse::depth_read, ResourceUse::depth_target,
                       depth_range);
    VkRenderingAttachmentInfo color =
        attachment(targets.forward_color.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_DONT_CARE);
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = targets.forward_resolved.view();
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
    gpu::image_barrier(commands, targets.depth.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    gpu::image_barrier(commands, targets.forward_resolved.get(), ResourceUse::color_target,
                       ResourceUse::sampled);
    gpu::image_barrier(commands, targets.picture.get(), ResourceUse::color_target, ResourceUse::color_target);

    color = attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    rendering = rendering_info(context.extent, context.views, {&color, 1});
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    bind(commands, over_, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return done;
}

}  // namespace bolt::render
