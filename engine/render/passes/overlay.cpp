#include "engine/render/passes/overlay.hpp"

#include <algorithm>
#include <cstddef>

namespace bolt::render {

namespace {

using gpu::Use;

// As shaders/overlay.vert has it.
struct Push {
    glm::vec2 size{0.0F};
    float layer = 0.0F, kind = 0.0F;
};

// The part of a scissor that lies on the picture.
VkRect2D on_picture(const VkRect2D& wanted, VkExtent2D extent) {
    const auto clip = [](std::int64_t at, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, size));
    };
    const std::uint32_t left = clip(wanted.offset.x, extent.width),
                        top = clip(wanted.offset.y, extent.height);
    const std::uint32_t right = clip(std::int64_t{wanted.offset.x} + wanted.extent.width, extent.width),
                        bottom = clip(std::int64_t{wanted.offset.y} + wanted.extent.height, extent.height);
    return {{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)}, {right - left, bottom - top}};
}

// Every image once, to be read or back to what it was used for.
void move_textures(VkCommandBuffer commands, const Overlay& overlay, bool to_sampled) {
    std::vector<VkImage> moved;
    for (const OverlayTexture& texture : overlay.textures) {
        const VkImage image = texture.picture.image->get();
        if (texture.use == Use::sampled || std::find(moved.begin(), moved.end(), image) != moved.end())
            continue;
        moved.push_back(image);
        gpu::image_barrier(commands, image, to_sampled ? texture.use : Use::sampled,
                           to_sampled ? Use::sampled : texture.use);
    }
}

}  // namespace

Result<OverlayPass> OverlayPass::create(const PassMaker& maker) {
    OverlayPass pass;
    gpu::GraphicsInfo info;
    info.vertex = &maker.shaders.at("overlay.vert");
    info.fragment = &maker.shaders.at("overlay.frag");
    info.streams = {{0, VK_FORMAT_R32G32_SFLOAT, 0, offsetof(OverlayVertex, at)},
                    {1, VK_FORMAT_R32G32_SFLOAT, 0, offsetof(OverlayVertex, uv)},
                    {2, VK_FORMAT_R8G8B8A8_UNORM, 0, offsetof(OverlayVertex, rgba)}};
    info.strides = {sizeof(OverlayVertex)};
    info.colors = {color_format};
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.blend = true;
    if (Status s = take(pass.pipeline_, gpu::make_graphics_pipeline(maker.device, maker.cache, info)); !s)
        return fail(s.error());
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (Status s = take(pass.sampler_, gpu::make_sampler(maker.device, clamped)); !s) return fail(s.error());
    return pass;
}

// One a texture, and last the one of what has none.
Result<std::vector<VkDescriptorSet>> OverlayPass::sets_of(gpu::Device& device, gpu::Frame& frame,
                                                          const Overlay& overlay, VkImageView white) {
    std::vector<VkDescriptorSet> sets;
    for (std::size_t i = 0; i <= overlay.textures.size(); ++i) {
        const VkImageView view =
            i < overlay.textures.size() ? overlay.textures[i].picture.image->view() : white;
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(device, frame, pipeline_, 0);
        if (!writer) return fail(writer.error());
        Result<VkDescriptorSet> set = writer->image(0, view, sampler_.get()).finish();
        if (!set) return fail(set.error());
        sets.push_back(*set);
    }
    return sets;
}

Status OverlayPass::draw(gpu::Device& device, gpu::Frame& frame, const Overlay& overlay, const Layer& picture,
                         VkImageView white) {
    if (overlay.draws.empty()) return {};
    for (const OverlayTexture& texture : overlay.textures)
        if (texture.picture.image == picture.image)
            return fail(ErrorCode::failed, "a picture cannot be shown on itself",
                        "views of another group in an inset");
    Result<gpu::Piece> vertices = put<OverlayVertex>(frame, overlay.vertices);
    if (!vertices) return fail(vertices.error());
    Result<gpu::Piece> indices = put<std::uint32_t>(frame, overlay.indices);
    if (!indices) return fail(indices.error());
    Result<std::vector<VkDescriptorSet>> sets = sets_of(device, frame, overlay, white);
    if (!sets) return fail(sets.error());
    Result<gpu::ImageView> target = picture.image->view(VK_IMAGE_VIEW_TYPE_2D, 0, 1, picture.layer, 1);
    if (!target) return fail(target.error());

    const VkCommandBuffer commands = frame.commands();
    frame.begin_timing("overlay");
    move_textures(commands, overlay, true);
    gpu::image_barrier(commands, picture.image->get(), Use::transfer_from, Use::color_target);
    const VkExtent2D extent = picture.image->info().extent;
    const VkRenderingAttachmentInfo color =
        attachment(target->get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(extent, 1, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, extent);
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices->buffer, &vertices->offset);
    vkCmdBindIndexBuffer(commands, indices->buffer, indices->offset, VK_INDEX_TYPE_UINT32);
    int bound = -2;
    for (const OverlayDraw& d : overlay.draws) {
        const VkRect2D scissor = on_picture(d.scissor, extent);
        if (d.count == 0 || scissor.extent.width == 0 || scissor.extent.height == 0) continue;
        if (std::exchange(bound, d.texture) != d.texture) {
            const bool has = d.texture >= 0;
            const auto index = has ? static_cast<std::size_t>(d.texture) : overlay.textures.size();
            bind(commands, pipeline_, sets->at(index));
            Push push;
            push.size = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
            push.layer = has ? static_cast<float>(overlay.textures[index].picture.layer) : 0.0F;
            push.kind = has && overlay.textures[index].coverage ? 1.0F : 0.0F;
            vkCmdPushConstants(commands, pipeline_.layout.get(), pipeline_.push_stages, 0, sizeof push,
                               &push);
        }
        vkCmdSetScissor(commands, 0, 1, &scissor);
        vkCmdDrawIndexed(commands, d.count, 1, d.first_index, d.first_vertex, 0);
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, picture.image->get(), Use::color_target, Use::transfer_from);
    move_textures(commands, overlay, false);
    frame.end_timing();
    frame.retire(std::move(*target));
    return {};
}

}  // namespace bolt::render
