#include "engine/render/passes/light.hpp"

#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"

namespace bolt::render {

using gpu::ResourceUse;

Result<LightPass> LightPass::create(const PassMaker& maker) {
    LightPass pass;
    pass.cache_ = &maker.cache;
    pass.shaders_ = &maker.shaders;
    BOLT_TRY(assign(pass.albedo_table_, upload_albedo_table(maker.device)));
    gpu::ImageInfo nothing;
    nothing.format = wide_rough_format;
    nothing.samples = samples;
    nothing.array = true;
    nothing.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    BOLT_TRY(assign(pass.nothing_, gpu::Image::create(maker.device, nothing)));
    BOLT_TRY(gpu::submit_and_wait(maker.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.nothing_.get(), ResourceUse::undefined, ResourceUse::sampled);
    }));
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.clamped_, gpu::make_sampler(maker.device, clamped)));
    gpu::SamplerInfo nearest = clamped;
    nearest.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(maker.device, nearest)));
    clamped.compares = true;
    BOLT_TRY(assign(pass.comparing_, gpu::make_sampler(maker.device, clamped)));
    return pass;
}

Result<const gpu::Pipeline*> LightPass::light_pipeline(gpu::Device& device, std::uint32_t features,
                                                       std::uint32_t views) {
    const auto known = lights_.find({features, views});
    if (known != lights_.end()) return &known->second;
    gpu::GraphicsInfo info;
    info.vertex = &shaders_->at("light.vert");
    info.fragment = &shaders_->at("light.frag");
    info.colors = {color_format};
    draw_views(info, views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.constants |= features;
    BOLT_TRY_ASSIGN(auto made, gpu::make_graphics_pipeline(device, *cache_, info));
    return &lights_.emplace(std::pair{features, views}, std::move(made)).first->second;
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
                                             bool wide) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
    bind_inputs(context, writer, inputs);
    const VkSampler nearest = nearest_.get();
    return writer.image(7, targets.depth.view(), nearest, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(8, targets.surfaces.view(), nearest)
        .image(9, wide ? targets.wide_colors.view() : nothing_.view(), nearest)
        .image(10, wide ? targets.wide_roughs.view() : nothing_.view(), nearest)
        .finish();
}

Status LightPass::draw_surfaces(PassContext& context, const RenderTargets& targets, const DrawList& list,
                                const LightInputs& inputs) {
    constexpr std::uint32_t of_light =
        SCENE_TANGENTS | SCENE_COAT | SCENE_ANISOTROPY | SCENE_OCCLUSION_MAP | SCENE_WIDE;
    const std::uint32_t features = (list.features & of_light) | features_of(context.scene) |
                                   (context.scene.background.w > 0.5F ? SCENE_PLAIN : 0U);
    BOLT_TRY_ASSIGN(const auto pipeline, light_pipeline(context.device, features, context.views));
    BOLT_TRY_ASSIGN(const auto set,
                    light_set(context, targets, *pipeline, inputs, (list.features & SCENE_WIDE) != 0));
    bind(context.frame.commands(), *pipeline, set);
    draw_screen(context.frame.commands());
    return {};
}

Status LightPass::draw(PassContext& context, RenderTargets& targets, const DrawList& list,
                       const LightInputs& inputs) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, targets.picture.get(), ResourceUse::transfer_from,
                                  ResourceUse::color_target);
    context.frame.begin_timing("light");
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    const Status done = draw_surfaces(context, targets, list, inputs);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return done;
}

}  // namespace bolt::render
