#include "engine/render/passes/light.hpp"

#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"
#include "engine/render/tone.hpp"

namespace bolt::render {

using gpu::Use;

namespace {

// A triangle over the whole picture, as far away as can be: depth tests tell where something was drawn.
gpu::GraphicsInfo behind_all(const Shaders& shaders, std::uint32_t views, VkCompareOp compare) {
    gpu::GraphicsInfo info;
    info.vertex = &shaders.at("screen.vert");
    info.colors = {color_format};
    info.depth = depth_format;
    info.samples = samples;
    info.view_mask = view_mask(views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_write = false;
    info.depth_compare = compare;
    return info;
}

void resolve_into(VkRenderingAttachmentInfo& color, const gpu::Image& picture) {
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = picture.view();
    color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

}  // namespace

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

Result<const gpu::Pipeline*> LightPass::light_pipeline(gpu::Device& device, std::uint32_t features,
                                                       std::uint32_t views) {
    const auto known = lights_.find({features, views});
    if (known != lights_.end()) return &known->second;
    gpu::GraphicsInfo info = behind_all(*shaders_, views, VK_COMPARE_OP_LESS);
    info.fragment = &shaders_->at("light.frag");
    info.constants = features;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &lights_.emplace(std::pair{features, views}, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> LightPass::sky_pipeline(gpu::Device& device, std::uint32_t views) {
    const auto known = skies_.find(views);
    if (known != skies_.end()) return &known->second;
    gpu::GraphicsInfo info = behind_all(*shaders_, views, VK_COMPARE_OP_EQUAL);
    info.fragment = &shaders_->at("sky.frag");
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &skies_.emplace(views, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> LightPass::forward_pipeline(gpu::Device& device, const Kind& kind,
                                                         std::uint32_t views) {
    const auto known = forwards_.find({kind, views});
    if (known != forwards_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, kind, views);
    info.fragment = &shaders_->at("scene.frag");
    info.colors = {color_format};
    info.blend = kind.blends;
    info.depth_write = !kind.blends;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &forwards_.emplace(std::pair{kind, views}, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> LightPass::ghost_pipeline(gpu::Device& device, const Kind& kind,
                                                       std::uint32_t views) {
    Kind shape;
    shape.double_sided = kind.double_sided;
    const auto known = ghosts_.find({shape, views});
    if (known != ghosts_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, shape, views);
    info.colors = {color_format};
    info.color_write = false;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(device, *cache_, info);
    if (!made) return fail(made.error());
    return &ghosts_.emplace(std::pair{shape, views}, std::move(*made)).first->second;
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

Status LightPass::draw_surfaces(PassContext& context, const Targets& targets, const DrawList& list,
                                const LightInputs& inputs) {
    constexpr std::uint32_t of_light =
        SCENE_TANGENTS | SCENE_COAT | SCENE_ANISOTROPY | SCENE_OCCLUSION_MAP | SCENE_WIDE;
    const std::uint32_t features = (list.features & of_light) | features_of(context.scene);
    const Result<const gpu::Pipeline*> pipeline = light_pipeline(context.device, features, context.views);
    if (!pipeline) return fail(pipeline.error());
    const Result<VkDescriptorSet> set =
        light_set(context, targets, **pipeline, inputs, (list.features & SCENE_WIDE) != 0);
    if (!set) return fail(set.error());
    bind(context.frame.commands(), **pipeline, *set);
    draw_screen(context.frame.commands());
    return {};
}

Status LightPass::draw_sky(PassContext& context) {
    const Result<const gpu::Pipeline*> pipeline = sky_pipeline(context.device, context.views);
    if (!pipeline) return fail(pipeline.error());
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, **pipeline, 0);
    if (!writer) return fail(writer.error());
    const Result<VkDescriptorSet> set = writer->piece(0, context.frame_block)
                                            .image(4, context.environment.levels.view(), clamped_.get())
                                            .finish();
    if (!set) return fail(set.error());
    bind(context.frame.commands(), **pipeline, *set);
    draw_screen(context.frame.commands());
    return {};
}

Status LightPass::draw_forward(PassContext& context, const DrawList& list, const LightInputs& inputs) {
    PartDrawing drawing;
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        return writer->piece(0, context.frame_block).piece(1, context.instances).finish();
    };
    // Of a ghost only what is nearest shows: its depth comes first.
    drawing.wanted = [](const Kind& kind) { return kind.ghost; };
    drawing.pipeline = [&](const Kind& kind) { return ghost_pipeline(context.device, kind, context.views); };
    if (Status s = draw_parts(context, list, drawing); !s) return s;
    // What fades does so in the cone around what is to be seen; of the cone the eye sees no more than its
    // end.
    const CutAway& cut = context.scene.cut_away;
    const Box around{cut.focus - cut.radius, cut.focus + cut.radius};
    const VkRect2D all{{0, 0}, context.extent}, end = area_of(context, {&around, 1}, 1.0F);
    drawing.area = [&](const Kind& kind) { return (kind.features & SCENE_CUT_REST) != 0 ? end : all; };
    drawing.wanted = [](const Kind& kind) { return kind.forward; };
    drawing.pipeline = [&](const Kind& kind) {
        return forward_pipeline(context.device, kind, context.views);
    };
    drawing.frame_set = [&](const gpu::Pipeline& made) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, made, 0);
        if (!writer) return fail(writer.error());
        bind_inputs(context, *writer, inputs);
        return writer->piece(1, context.instances).finish();
    };
    return draw_parts(context, list, drawing);
}

Status LightPass::draw(PassContext& context, Targets& targets, const DrawList& list,
                       const LightInputs& inputs) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, targets.picture.get(), Use::transfer_from, Use::color_target);
    gpu::image_barrier_discarding(commands, targets.drawn.get(), Use::color_target, Use::color_target);
    // The geometry buffer's depth is tested and read at the same time.
    context.frame.begin_timing("light");
    VkRenderingAttachmentInfo color = attachment(
        targets.drawn.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
        list.forward ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE);
    if (!list.forward) resolve_into(color, targets.picture);
    const bool plain = context.scene.background.w > 0.5F;
    const glm::vec3 behind = pbr_neutral(glm::vec3(context.scene.background) * context.scene.exposure);
    if (plain) color.clearValue.color = {{behind.r, behind.g, behind.b, 1.0F}};
    VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_NONE);
    VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    Status done = draw_surfaces(context, targets, list, inputs);
    if (done && !plain) done = draw_sky(context);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    if (!done || !list.forward) return done;

    context.frame.begin_timing("forward");
    gpu::image_barrier(commands, targets.drawn.get(), Use::color_target, Use::color_target);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_read, Use::depth_target, depth_range);
    color = attachment(targets.drawn.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_DONT_CARE);
    resolve_into(color, targets.picture);
    depth = attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    rendering = rendering_info(context.extent, context.views, {&color, 1}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    done = draw_forward(context, list, inputs);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.depth.get(), Use::depth_target, Use::depth_read, depth_range);
    context.frame.end_timing();
    return done;
}

}  // namespace bolt::render
