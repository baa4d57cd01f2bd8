#include "engine/render/passes/overlay.hpp"

#include <algorithm>
#include <cstddef>

namespace bolt::render {

namespace {

using gpu::ResourceUse;

// Must match shaders/overlay.vert.
struct OverlayPushConstants {
    glm::vec2 size{0.0F};
    float layer = 0.0F, kind = 0.0F;
};

// Returns the part of a scissor rectangle inside the picture.
VkRect2D clipped(const VkRect2D& wanted, VkExtent2D extent) {
    const auto clip = [](std::int64_t at, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, size));
    };
    const std::uint32_t left = clip(wanted.offset.x, extent.width),
                        top = clip(wanted.offset.y, extent.height);
    const std::uint32_t right = clip(std::int64_t{wanted.offset.x} + wanted.extent.width, extent.width),
                        bottom = clip(std::int64_t{wanted.offset.y} + wanted.extent.height, extent.height);
    return {{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)}, {right - left, bottom - top}};
}

// Transitions every image once, to use `sampled` or back to its previous use.
void transition_textures(VkCommandBuffer commands, const Overlay& overlay, bool to_sampled) {
    std::vector<VkImage> transitioned;
    for (const OverlayTexture& texture : overlay.textures) {
        const VkImage image = texture.picture.image->get();
        if (texture.use == ResourceUse::sampled ||
            std::find(transitioned.begin(), transitioned.end(), image) != transitioned.end())
            continue;
        transitioned.push_back(image);
        gpu::image_barrier(commands, image, to_sampled ? texture.use : ResourceUse::sampled,
                           to_sampled ? ResourceUse::sampled : texture.use);
    }
}

}  // namespace

Result<OverlayPass> OverlayPass::create(const PassSetup& setup) {
    OverlayPass pass;
    gpu::GraphicsInfo info = over_picture(setup.shaders, "overlay.vert", "overlay.frag", 1);
    info.streams = {{0, VK_FORMAT_R32G32_SFLOAT, 0, offsetof(OverlayVertex, at)},
                    {1, VK_FORMAT_R32G32_SFLOAT, 0, offsetof(OverlayVertex, uv)},
                    {2, VK_FORMAT_R8G8B8A8_UNORM, 0, offsetof(OverlayVertex, rgba)}};
    info.strides = {sizeof(OverlayVertex)};
    BOLT_TRY(assign(pass.pipeline_, gpu::make_graphics_pipeline(setup.device, setup.cache, info)));
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.sampler_, gpu::make_sampler(setup.device, clamped)));
    return pass;
}

// Returns one set per texture, and a last one for draws without a texture.
Result<std::vector<VkDescriptorSet>> OverlayPass::descriptor_sets(gpu::Device& device,
                                                                  gpu::FrameContext& frame,
                                                                  const Overlay& overlay, VkImageView white) {
    std::vector<VkDescriptorSet> sets;
    for (std::size_t i = 0; i <= overlay.textures.size(); ++i) {
        const VkImageView view =
            i < overlay.textures.size() ? overlay.textures[i].picture.image->view() : white;
        BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(device, frame, pipeline_, 0));
        BOLT_TRY_ASSIGN(auto set, writer.image(0, view, sampler_.get()).finish());
        sets.push_back(set);
    }
    return sets;
}

Status OverlayPass::draw(gpu::Device& device, gpu::FrameContext& frame, const Overlay& overlay,
                         const ImageLayer& picture, VkImageView white) {
    if (overlay.draws.empty()) return {};
    for (const OverlayTexture& texture : overlay.textures)
        if (texture.picture.image == picture.image)
            return fail(ErrorCode::failed, "an overlay contains the picture that it is drawn on",
                        "a picture of another group");
    BOLT_TRY_ASSIGN(auto vertices, upload_transient<OverlayVertex>(frame, overlay.vertices));
    BOLT_TRY_ASSIGN(auto indices, upload_transient<std::uint32_t>(frame, overlay.indices));
    BOLT_TRY_ASSIGN(auto sets, descriptor_sets(device, frame, overlay, white));
    BOLT_TRY_ASSIGN(auto target, picture.image->view(VK_IMAGE_VIEW_TYPE_2D, 0, 1, picture.layer, 1));

    const VkCommandBuffer commands = frame.commands();
    frame.begin_timing("overlay");
    transition_textures(commands, overlay, true);
    gpu::image_barrier(commands, picture.image->get(), ResourceUse::transfer_from, ResourceUse::color_target);
    const VkExtent2D extent = picture.image->info().extent;
    const VkRenderingAttachmentInfo color =
        attachment(target.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(extent, 1, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, extent);
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices.buffer, &vertices.offset);
    vkCmdBindIndexBuffer(commands, indices.buffer, indices.offset, VK_INDEX_TYPE_UINT32);
    int bound = -2;
    for (const OverlayDraw& d : overlay.draws) {
        const VkRect2D scissor = clipped(d.scissor, extent);
        if (d.count == 0 || scissor.extent.width == 0 || scissor.extent.height == 0) continue;
        if (std::exchange(bound, d.texture) != d.texture) {
            const bool textured = d.texture >= 0;
            const auto index = textured ? static_cast<std::size_t>(d.texture) : overlay.textures.size();
            bind(commands, pipeline_, sets.at(index));
            OverlayPushConstants constants;
            constants.size = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
            constants.layer = textured ? static_cast<float>(overlay.textures[index].picture.layer) : 0.0F;
            constants.kind = textured && overlay.textures[index].coverage ? 1.0F : 0.0F;
            vkCmdPushConstants(commands, pipeline_.layout.get(), pipeline_.push_stages, 0, sizeof constants,
                               &constants);
        }
        vkCmdSetScissor(commands, 0, 1, &scissor);
        vkCmdDrawIndexed(commands, d.count, 1, d.first_index, d.first_vertex, 0);
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, picture.image->get(), ResourceUse::color_target, ResourceUse::transfer_from);
    transition_textures(commands, overlay, false);
    frame.end_timing();
    frame.retire(std::move(target));
    return {};
}

}  // namespace bolt::render
