#include "engine/render/passes/shadow.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "engine/gpu/transfer.hpp"
#include "engine/render/shadow_view.hpp"

namespace bolt::render {

namespace {

using gpu::Use;

// FNV-1a over everything that the map shows of what stands still.
std::uint64_t key_of(const Scene& scene, const glm::mat4& shadow_from_world) {
    std::uint64_t key = 14695981039346656037ULL;
    const auto add = [&](const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) key = (key ^ bytes[i]) * 1099511628211ULL;
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
    return key != 0 ? key : 1;
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
    gpu::image_barrier(commands, from.get(), Use::depth_read, Use::transfer_from, depth_range);
    gpu::image_barrier_discarding(commands, to.get(), Use::depth_read, Use::transfer_to, depth_range);
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
    region.extent = {from.info().extent.width, from.info().extent.height, 1};
    vkCmdCopyImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.get(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    gpu::image_barrier(commands, from.get(), Use::transfer_from, Use::depth_read, depth_range);
    gpu::image_barrier(commands, to.get(), Use::transfer_to, Use::depth_target, depth_range);
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
    if (Status s = take(pass.pipeline_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)); !s)
        return fail(s.error());
    if (Status s = take(pass.still_, make_map(maker.device, size)); !s) return fail(s.error());
    const Status readable = gpu::run_now(maker.device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, pass.still_.get(), Use::undefined, Use::depth_read, depth_range);
    });
    if (!readable) return fail(readable.error());
    return pass;
}

bool ShadowPass::describe(const Scene& scene, shared::Frame& frame) {
    if (!casts_shadow(scene)) return false;
    Scene still = casters(scene, false);
    if (still.objects.empty()) still = casters(scene, true);
    frame.shadow_from_world = shadow_view(bounds(still), glm::vec3(scene.lights.front().light.direction));
    return true;
}

Status ShadowPass::draw(PassContext& context) {
    drawn_ = false;
    if (context.shared.shadows == 0) return {};
    // Steps of a level of detail below the size of a texel do not show.
    const glm::mat4& m = context.shared.shadow_from_world;
    Detail detail;
    detail.allowed_m = 1.0F / (glm::length(glm::vec3(m[0].x, m[1].x, m[2].x)) * 0.5F *
                               static_cast<float>(still_.info().extent.width));
    const std::uint64_t key = key_of(context.scene, m);
    const DrawList moving = make_draw_list(casters(context.scene, true), {}, detail, context.deformed);
    moving_ = !moving.draws.empty();
    if (key == still_key_ && !moving_) return {};
    context.frame.begin_timing("shadow");
    if (key != still_key_) {
        still_key_ = 0;
        const DrawList list = make_draw_list(casters(context.scene, false), {}, detail, context.deformed);
        gpu::image_barrier_discarding(context.frame.commands(), still_.get(), Use::depth_read,
                                      Use::depth_target, depth_range);
        if (Status done = draw_into(context, still_, list, true); !done) return done;
        still_key_ = key;
        drawn_ = true;
    }
    if (moving_) {
        if (all_.get() == VK_NULL_HANDLE) {
            if (Status s = take(all_, make_map(context.device, still_.info().extent.width)); !s) return s;
            gpu::image_barrier(context.frame.commands(), all_.get(), Use::undefined, Use::depth_read,
                               depth_range);
        }
        copy_map(context.frame.commands(), still_, all_);
        if (Status done = draw_into(context, all_, moving, false); !done) return done;
    }
    context.frame.end_timing();
    return {};
}

Status ShadowPass::draw_into(PassContext& context, const gpu::Image& target, const DrawList& list,
                             bool clear) {
    Result<gpu::Piece> instances = put<shared::Instance>(context.frame, list.instances);
    if (!instances) return fail(instances.error());
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, pipeline_, 0);
    if (!writer) return fail(writer.error());
    Result<VkDescriptorSet> set = writer->piece(0, context.frame_block).piece(1, *instances).finish();
    if (!set) return fail(set.error());
    const VkCommandBuffer commands = context.frame.commands();
    VkRenderingAttachmentInfo depth = attachment(
        target.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
        clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    depth.clearValue.depthStencil.depth = 1.0F;
    const VkRenderingInfo rendering = rendering_info(target.info().extent, 1, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, target.info().extent);
    bind(commands, pipeline_, *set);
    draw_all(commands, list, [](const Draw&) { return true; });
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, target.get(), Use::depth_target, Use::depth_read, depth_range);
    return {};
}

}  // namespace bolt::render
