#include "engine/render/passes/shadow.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "engine/base/hash.hpp"
#include "engine/gpu/transfer.hpp"
#include "engine/render/camera.hpp"

namespace bolt::render {

namespace {

using gpu::ResourceUse;

// Hashes everything that determines the static shadow map; never 0, which stands for "no map yet".
std::uint64_t static_map_key(const Scene& scene, const glm::mat4& shadow_from_world) {
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
        const Deformation& bent = *object.deformation;
        add(bent.joints.data(), bent.joints.size() * sizeof(glm::mat4));
        add(bent.weights.data(), bent.weights.size() * sizeof(float));
    }
    return hash.value() != 0 ? hash.value() : 1;
}

Scene casters(const Scene& scene, bool moving) {
    Scene some;
    for (const Object& object : scene.objects)
        if (casts_shadow(object) && object.moves == moving) some.objects.push_back(object);
    return some;
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

Result<ShadowPass> ShadowPass::create(const PassMaker& maker, std::uint32_t size) {
    ShadowPass pass;
    gpu::GraphicsInfo info;
    info.vertex = &maker.shaders.at("shadow.vert");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    info.depth = depth_format;
    info.cull = VK_CULL_MODE_NONE;
    info.depth_compare = VK_COMPARE_OP_LESS;
    info.depth_clamp = true;
    info.depth_bias_slope = 1.5F;
    BOLT_TRY(assign(pass.pipeline_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)));
    BOLT_TRY(assign(pass.still_, make_map(maker.device, size)));
    BOLT_TRY(gpu::submit_and_wait(maker.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.still_.get(), ResourceUse::undefined, ResourceUse::depth_read,
                           depth_range);
    }));
    return pass;
}

bool ShadowPass::describe(const Scene& scene, shared::FrameData& frame) {
    if (!casts_shadow(scene)) return false;
    Scene still = casters(scene, false);
    if (still.objects.empty()) still = casters(scene, true);
    frame.shadow_from_world = shadow_view(bounds(still), glm::vec3(scene.lights.front().light.direction));
    return true;
}

Status ShadowPass::draw(PassContext& context) {
    drawn_ = false;
    if (context.shared.shadows == 0) return {};
    // Level-of-detail errors below the size of a texel are not visible.
    const glm::mat4& m = context.shared.shadow_from_world;
    DetailLimits detail;
    detail.allowed_m = 1.0F / (glm::length(glm::vec3(m[0].x, m[1].x, m[2].x)) * 0.5F *
                               static_cast<float>(still_.info().extent.width));
    const std::uint64_t key = static_map_key(context.scene, m);
    const DrawList moving = make_draw_list(casters(context.scene, true), {}, detail, context.deformed);
    moving_ = !moving.draws.empty();
    if (key == still_key_ && !moving_) return {};
    context.frame.begin_timing("shadow");
    if (key != still_key_) {
        still_key_ = 0;
        const DrawList list = make_draw_list(casters(context.scene, false), {}, detail, context.deformed);
        gpu::image_barrier_discarding(context.frame.commands(), still_.get(), ResourceUse::depth_read,
                                      ResourceUse::depth_target, depth_range);
        BOLT_TRY(draw_into(context, still_, list, true));
        still_key_ = key;
        drawn_ = true;
    }
    if (moving_) {
        if (all_.get() == VK_NULL_HANDLE) {
            BOLT_TRY(assign(all_, make_map(context.device, still_.info().extent.width)));
            gpu::image_barrier(context.frame.commands(), all_.get(), ResourceUse::undefined,
                               ResourceUse::depth_read, depth_range);
        }
        copy_map(context.frame.commands(), still_, all_);
        BOLT_TRY(draw_into(context, all_, moving, false));
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

}  // namespace bolt::render
