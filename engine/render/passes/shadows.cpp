#include "engine/render/passes/shadows.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "engine/base/hash.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/camera.hpp"

namespace bolt::render {

using gpu::ResourceUse;

namespace {

// Hashes everything that determines the static shadow map; never 0, which stands for "no map yet".
std::uint64_t make_static_map_key(const Scene& scene, const glm::mat4& shadow_from_world) {
    Fnv1a hash;
    const auto add = [&](const void* data, std::size_t size) {
        hash.add(std::span(static_cast<const std::byte*>(data), size));
    };
    add(glm::value_ptr(shadow_from_world), sizeof shadow_from_world);
    for (const Object& object : scene.objects) {
        if (!casts_shadow(object) || object.moves) continue;
        add(&object.model, sizeof object.model);
        add(&object.mesh, sizeof object.mesh);
        add(glm::value_ptr(object.world), sizeof object.world);
        if (object.deformation == nullptr) continue;
        const Deformation& deformation = *object.deformation;
        add(deformation.joints.data(), deformation.joints.size() * sizeof(glm::mat4));
        add(deformation.weights.data(), deformation.weights.size() * sizeof(float));
    }
    return hash.value() != 0 ? hash.value() : 1;
}

// Returns a scene with only the shadow casters: `moving` selects those that move or those that do not.
Scene shadow_casters(const Scene& scene, bool moving) {
    Scene casters;
    for (const Object& object : scene.objects)
        if (casts_shadow(object) && object.moves == moving) casters.objects.push_back(object);
    return casters;
}

Result<gpu::Image> make_map(gpu::Device& device, std::uint32_t size) {
    gpu::ImageInfo info;
    info.format = depth_format;
    info.extent = {size, size};
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return gpu::Image::create(device, info);
}

void copy_map(VkCommandBuffer commands, const gpu::Image& from, const gpu::Image& to) {
    gpu::image_barrier(commands, from.get(), ResourceUse::depth_read, ResourceUse::transfer_from,
                       depth_range);
    gpu::image_barrier_discarding(commands, to.get(), ResourceUse::depth_read, ResourceUse::transfer_to,
                                  depth_range);
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
    region.extent = {from.info().extent.width, from.info().extent.height, 1};
    vkCmdCopyImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.get(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    gpu::image_barrier(commands, from.get(), ResourceUse::transfer_from, ResourceUse::depth_read,
                       depth_range);
    gpu::image_barrier(commands, to.get(), ResourceUse::transfer_to, ResourceUse::depth_target, depth_range);
}

}  // namespace

Result<ShadowPass> ShadowPass::create(const PassSetup& setup, std::uint32_t size) {
    ShadowPass pass;
    gpu::GraphicsInfo info;
    info.vertex = &setup.shaders.at("shadow.vert");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    info.depth = depth_format;
    info.cull = VK_CULL_MODE_NONE;
    info.depth_compare = VK_COMPARE_OP_LESS;
    info.depth_clamp = true;
    info.depth_bias_slope = 1.5F;
    BOLT_TRY(assign(pass.pipeline_, gpu::make_graphics_pipeline(setup.device, setup.cache, info)));
    BOLT_TRY(assign(pass.static_map_, make_map(setup.device, size)));
    BOLT_TRY(gpu::submit_and_wait(setup.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.static_map_.get(), ResourceUse::undefined, ResourceUse::depth_read,
                           depth_range);
    }));
    return pass;
}

bool ShadowPass::set_shadow_view(const Scene& scene, shared::FrameData& frame) {
    if (!casts_shadow(scene)) return false;
    Scene casters = shadow_casters(scene, false);
    if (casters.objects.empty()) casters = shadow_casters(scene, true);
    frame.shadow_from_world = shadow_view(bounds(casters), glm::vec3(scene.lights.front().light.direction));
    return true;
}

Status ShadowPass::draw(PassContext& context) {
    static_map_redrawn_ = false;
    if (context.shared.shadows == 0) return {};
    // Level-of-detail errors below the size of a texel are not visible.
    const glm::mat4& m = context.shared.shadow_from_world;
    DetailLimits detail;
    detail.allowed_m = 1.0F / (glm::length(glm::vec3(m[0].x, m[1].x, m[2].x)) * 0.5F *
                               static_cast<float>(static_map_.info().extent.width));
    const std::uint64_t key = make_static_map_key(context.scene, m);
    const DrawList moving = make_draw_list(shadow_casters(context.scene, true), {}, detail, context.deformed);
    moving_ = !moving.draws.empty();
    if (key == static_map_key_ && !moving_) return {};
    context.frame.begin_timing("shadow");
    if (key != static_map_key_) {
        static_map_key_ = 0;
        const DrawList list =
            make_draw_list(shadow_casters(context.scene, false), {}, detail, context.deformed);
        gpu::image_barrier_discarding(context.frame.commands(), static_map_.get(), ResourceUse::depth_read,
                                      ResourceUse::depth_target, depth_range);
        BOLT_TRY(draw_into(context, static_map_, list, true));
        static_map_key_ = key;
        static_map_redrawn_ = true;
    }
    if (moving_) {
        if (combined_map_.get() == VK_NULL_HANDLE) {
            BOLT_TRY(assign(combined_map_, make_map(context.device, static_map_.info().extent.width)));
            gpu::image_barrier(context.frame.commands(), combined_map_.get(), ResourceUse::undefined,
                               ResourceUse::depth_read, depth_range);
        }
        copy_map(context.frame.commands(), static_map_, combined_map_);
        BOLT_TRY(draw_into(context, combined_map_, moving, false));
    }
    context.frame.end_timing();
    return {};
}

Status ShadowPass::draw_into(PassContext& context, const gpu::Image& target, const DrawList& list,
                             bool clear) {
    BOLT_TRY_ASSIGN(auto instances, upload_transient<shared::Instance>(context.frame, list.instances));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline_, 0));
    BOLT_TRY_ASSIGN(auto set, writer.range(0, context.frame_block).range(1, instances).finish());
    const VkCommandBuffer commands = context.frame.commands();
    VkRenderingAttachmentInfo depth = attachment(
        target.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
        clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    depth.clearValue.depthStencil.depth = 1.0F;
    const VkRenderingInfo rendering = rendering_info(target.info().extent, 1, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, target.info().extent);
    bind(commands, pipeline_, set);
    draw_all(commands, list, [](const Draw&) { return true; });
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, target.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    return {};
}

namespace {

template <class Bind>
Result<VkDescriptorSet> make_set(PassContext& context, const gpu::Pipeline& pipeline, const Bind& bind_to) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
    bind_to(writer);
    return writer.finish();
}

}  // namespace

Result<OcclusionPass> OcclusionPass::create(const PassSetup& setup, std::uint32_t views) {
    OcclusionPass pass;
    pass.stage_ = setup.screen_stage;
    gpu::SamplerInfo nearest;
    nearest.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    nearest.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(setup.device, nearest)));
    if (pass.stage_ == ScreenStage::compute) {
        const auto make = [&](gpu::Pipeline& to, const char* shader) {
            return assign(to,
                          gpu::make_compute_pipeline(setup.device, setup.cache, setup.shaders.at(shader)));
        };
        BOLT_TRY(make(pass.shrink_, "shrink.comp"));
        BOLT_TRY(make(pass.slices_, "occlusion.comp"));
        BOLT_TRY(make(pass.smooth_, "smooth.comp"));
        return pass;
    }
    gpu::GraphicsInfo info;
    set_views(info, views);
    info.vertex = &setup.shaders.at("screen.vert");
    info.cull = VK_CULL_MODE_NONE;
    info.depth = depth_format;
    const auto make = [&](gpu::Pipeline& to, const char* fragment) {
        info.fragment = &setup.shaders.at(fragment);
        return assign(to, gpu::make_graphics_pipeline(setup.device, setup.cache, info));
    };
    info.depth_compare = VK_COMPARE_OP_ALWAYS;
    BOLT_TRY(make(pass.shrink_, "shrink.frag"));
    info.depth_compare = VK_COMPARE_OP_LESS;  // farther away than the drawn geometry
    info.depth_write = false;
    info.colors = {occlusion_format};
    BOLT_TRY(make(pass.slices_, "occlusion.frag"));
    BOLT_TRY(make(pass.smooth_, "smooth.frag"));
    return pass;
}

void OcclusionPass::shrink(PassContext& context, const RenderTargets& targets, VkDescriptorSet set) {
    const VkCommandBuffer commands = context.frame.commands();
    const gpu::Image& small = targets.small_depth;
    gpu::image_barrier_discarding(commands, small.get(), ResourceUse::depth_read, ResourceUse::depth_target,
                                  depth_range);
    const VkRenderingAttachmentInfo depth =
        attachment(small.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(small.info().extent, context.views, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, small.info().extent);
    bind(commands, shrink_, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, small.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
}

void OcclusionPass::draw_into(PassContext& context, const RenderTargets& targets,
                              const gpu::Pipeline& pipeline, VkDescriptorSet set, const gpu::Image& target) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, target.get(), ResourceUse::sampled, ResourceUse::color_target);
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
    gpu::image_barrier(commands, target.get(), ResourceUse::color_target, ResourceUse::sampled);
}

void OcclusionPass::compute(PassContext& context, const gpu::Pipeline& pipeline, VkDescriptorSet set,
                            const gpu::Image& target) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, target.get(), ResourceUse::sampled, ResourceUse::storage_write);
    dispatch_screen(commands, pipeline, set, target.info().extent, context.views);
    gpu::image_barrier(commands, target.get(), ResourceUse::storage_write, ResourceUse::sampled);
}

Status OcclusionPass::draw(PassContext& context, RenderTargets& targets) {
    BOLT_TRY(add_occlusion_targets(context.device, targets, stage_));
    const bool computed = stage_ == ScreenStage::compute;
    const VkSampler nearest = nearest_.get();
    constexpr VkImageLayout read_depth = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    const VkImageLayout read_small_depth = computed ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : read_depth;
    const auto writes = [&](gpu::DescriptorWriter& w, const gpu::Image& image) {
        if (computed) w.image(6, image.storage_view(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL);
    };
    BOLT_TRY_ASSIGN(const auto shrink_set, make_set(context, shrink_, [&](gpu::DescriptorWriter& w) {
                        w.image(3, targets.depth.view(), nearest, read_depth);
                        writes(w, targets.small_depth);
                    }));
    BOLT_TRY_ASSIGN(const auto slices_set, make_set(context, slices_, [&](gpu::DescriptorWriter& w) {
                        w.range(0, context.frame_block)
                            .image(3, targets.small_depth.view(), nearest, read_small_depth)
                            .image(5, targets.surfaces.view(), nearest);
                        writes(w, targets.raw_occlusion);
                    }));
    BOLT_TRY_ASSIGN(const auto smooth_set, make_set(context, smooth_, [&](gpu::DescriptorWriter& w) {
                        w.range(0, context.frame_block)
                            .image(3, targets.small_depth.view(), nearest, read_small_depth)
                            .image(4, targets.raw_occlusion.view(), nearest)
                            .image(5, targets.surfaces.view(), nearest);
                        writes(w, targets.occlusion);
                    }));

    context.frame.begin_timing("occlusion");
    if (computed) {
        compute(context, shrink_, shrink_set, targets.small_depth);
        compute(context, slices_, slices_set, targets.raw_occlusion);
        compute(context, smooth_, smooth_set, targets.occlusion);
    } else {
        shrink(context, targets, shrink_set);
        draw_into(context, targets, slices_, slices_set, targets.raw_occlusion);
        draw_into(context, targets, smooth_, smooth_set, targets.occlusion);
    }
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
