#include "engine/render/passes/light.hpp"

#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"

namespace bolt::render {

using gpu::Use;

Result<LightPass> LightPass::create(const PassMaker& maker) {
    LightPass pass;
    pass.cache_ = &maker.cache;
    pass.shaders_ = &maker.shaders;
    if (Status s = take(pass.albedo_table_, upload_albedo_table(maker.device)); !s) return fail(s.error());
    gpu::ImageInfo nothing;
    nothing.format = wide_rough_format;
    nothing.samples = samples;
    nothing.array = true;
    nothing.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (Status s = take(pass.nothing_, gpu::Image::create(maker.device, nothing)); !s) return fail(s.error());
    const Status readable = gpu::run_now(maker.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.nothing_.get(), Use::undefined, Use::sampled);
    });
    if (!readable) return fail(readable.error());
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (Status s = take(pass.clamped_, gpu::make_sampler(maker.device, clamped)); !s) return fail(s.error());
    gpu::SamplerInfo nearest = clamped;
    nearest.filter = VK_FILTER_NEAREST;
    if (Status s = take(pass.nearest_, gpu::make_sampler(maker.device, nearest)); !s) return fail(s.error());
    clamped.compares = true;
    if (Status s = take(pass.comparing_, gpu::make_sampler(maker.device, clamped)); !s)
        return fail(s.error());
    return pass;
}

Result<const gpu::Pipeline*> LightPass::light_pipeline(gpu::Device& device, const Key& key) {
    const auto known = lights_.find(key);
    if (known != lights_.end()) return &known->second;
    gpu::GraphicsInfo info;
    info.vertex = &shaders_->at("screen.vert");
    info.fragment = &shaders_->at("light.frag");
    info.colors = {color_format};
    info.samples = key.several ? samples : VK_SAMPLE_COUNT_1_BIT;
    info.view_mask = view_mask(key.views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.constants = key.features;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &lights_.emplace(key, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> LightPass::part_pipeline_of(gpu::Device& device, const Kind& kind,
                                                         std::uint32_t views) {
    const auto known = parts_.find({kind, views});
    if (known != parts_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, kind, views);
    info.fragment = &shaders_->at("scene.frag");
    info.colors = {color_format};
    info.blend = kind.blends;
    info.depth_write = !kind.blends;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &parts_.emplace(std::pair{kind, views}, std::move(*made)).first->second;
}

void LightPass::bind_inputs(PassContext& context, gpu::SetWriter& writer, const LightInputs& inputs) {
    const VkSampler clamped = clamped_.get();
    writer.piece(0, context.frame_block)
        .piece(2, context.materials)
        .image(3, albedo_table_.view(), clamped)
        .image(4, context.environment.levels.view(), clamped)
        .image(5, inputs.shadow_map->view(), comparing_.get(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(6, inputs.occlusion != VK_NULL_HANDLE ? inputs.occlusion : context.white_array, clamped);
}

Result<VkDescriptorSet> LightPass::light_set(PassContext& context, const Targets& targets,
                                             const gpu::Pipeline& pipeline, const LightInputs& inputs,
                                             bool wide) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, pipeline, 0);
    if (!writer) return fail(writer.error());
    bind_inputs(context, *writer, inputs);
    const VkSampler nearest = nearest_.get();
    return writer->image(7, targets.depth.view(), nearest, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(8, targets.surfaces.view(), nearest)
        .image(9, wide ? targets.wide_colors.view() : nothing_.view(), nearest)
        .image(10, wide ? targets.wide_roughs.view() : nothing_.view(), nearest)
        .finish();
}

Status LightPass::draw_forward(PassContext& context, const Targets& targets, const DrawList& list,
                               const LightInputs& inputs) {
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("forward");
    gpu::image_barrier(commands, targets.drawn.get(), Use::color_target, Use::color_target);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_read, Use::depth_target, depth_range);
    VkRenderingAttachmentInfo color =
        attachment(targets.drawn.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_DONT_CARE);
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = targets.picture.view();
    color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    PartDrawing drawing;
    drawing.wanted = [](const Kind& kind) { return kind.forward; };
    drawing.pipeline = [&](const Kind& kind) {
        return part_pipeline_of(context.device, kind, context.views);
    };
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        bind_inputs(context, *writer, inputs);
        return writer->piece(1, context.instances).finish();
    };
    const Status drawn = draw_parts(context, list, drawing);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_target, Use::depth_read, depth_range);
    context.frame.end_timing();
    return drawn;
}

Status LightPass::draw(PassContext& context, Targets& targets, const DrawList& list,
                       const LightInputs& inputs) {
    constexpr std::uint32_t of_light =
        SCENE_TANGENTS | SCENE_COAT | SCENE_ANISOTROPY | SCENE_OCCLUSION_MAP | SCENE_WIDE;
    Key key{(list.features & of_light) | features_of(context.scene), context.views, list.forward};
    if (context.scene.background.w > 0.5F) key.features |= LIGHT_PLAIN;
    if (list.forward)
        if (Status made = add_drawn_target(context.device, targets); !made) return made;
    const Result<const gpu::Pipeline*> pipeline = light_pipeline(context.device, key);
    if (!pipeline) return fail(pipeline.error());
    const Result<VkDescriptorSet> set =
        light_set(context, targets, **pipeline, inputs, (list.features & SCENE_WIDE) != 0);
    if (!set) return fail(set.error());

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("light");
    gpu::image_barrier_discarding(commands, targets.picture.get(), Use::transfer_from, Use::color_target);
    const gpu::Image& target = list.forward ? targets.drawn : targets.picture;
    if (list.forward)
        gpu::image_barrier_discarding(commands, target.get(), Use::color_target, Use::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(target.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    bind(commands, **pipeline, *set);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return list.forward ? draw_forward(context, targets, list, inputs) : Status{};
}

}  // namespace bolt::render
