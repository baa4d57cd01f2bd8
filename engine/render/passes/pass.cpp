#include "engine/render/passes/pass.hpp"

#include <glm/common.hpp>

namespace bolt::render {

std::uint32_t view_mask(std::uint32_t views) { return views > 1 ? (1U << views) - 1U : 0U; }

void draw_views(gpu::GraphicsInfo& info, std::uint32_t views) {
    info.view_mask = view_mask(views);
    if (views > 1) info.constants |= SCENE_VIEWS;
}

void set_area(VkCommandBuffer commands, VkExtent2D extent) {
    const VkViewport viewport{0.0F, 0.0F, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0.0F, 1.0F};
    const VkRect2D scissor{{0, 0}, extent};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

void bind(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set, std::uint32_t index) {
    if (index == 0) vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout.get(), index, 1, &set,
                            0, nullptr);
}

bool same_geometry(const Draw& a, const Draw& b) { return a.model == b.model && a.deformed == b.deformed; }

void bind_geometry(VkCommandBuffer commands, const Draw& d) {
    const GpuModel& model = *d.model;
    VkBuffer buffers[] = {model.positions.get(), model.attributes.get(), model.second_uv.get()};
    VkDeviceSize offsets[] = {0, 0, 0};
    if (d.deformed.buffer != VK_NULL_HANDLE) {
        // Deformed streams start at the part: draw from vertex 0 and offset the other streams instead.
        buffers[0] = buffers[1] = d.deformed.buffer;
        offsets[0] = d.deformed.positions;
        offsets[1] = d.deformed.attributes;
        offsets[2] = static_cast<VkDeviceSize>(model.parts[d.part].first_vertex) * sizeof(glm::vec2);
    }
    vkCmdBindVertexBuffers(commands, 0, model.second_uv.get() != VK_NULL_HANDLE ? 3 : 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, model.indices.get(), 0, VK_INDEX_TYPE_UINT32);
}

void draw(VkCommandBuffer commands, const Draw& d) {
    const MeshPart& part = d.model->parts[d.part];
    const LevelRange& level = part.levels[d.level];
    const std::int32_t first = d.deformed.buffer != VK_NULL_HANDLE ? 0 : part.first_vertex;
    vkCmdDrawIndexed(commands, level.index_count, d.instances, level.first_index, first, d.first_instance);
}

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = load;
    info.storeOp = store;
    return info;
}

VkRect2D area_of(const PassContext& context, std::span<const BoundingBox> boxes, float margin_px) {
    const glm::vec2 size(static_cast<float>(context.extent.width), static_cast<float>(context.extent.height));
    glm::vec2 low(1e30F), high(-1e30F);
    for (const BoundingBox& box : boxes)
        for (std::uint32_t view = 0; view < context.views; ++view)
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec4 c = context.shared.views[view].clip_from_world *
                                    glm::vec4((corner & 1) != 0 ? box.high.x : box.low.x,
                                              (corner & 2) != 0 ? box.high.y : box.low.y,
                                              (corner & 4) != 0 ? box.high.z : box.low.z, 1.0F);
                if (c.w <= 0.0F) return {{0, 0}, context.extent};  // the box reaches behind the eye
                const glm::vec2 pixel = (glm::vec2(c) / c.w * 0.5F + 0.5F) * size;
                low = glm::min(low, pixel);
                high = glm::max(high, pixel);
            }
    low = glm::clamp(glm::floor(low - margin_px), glm::vec2(0.0F), size);
    high = glm::clamp(glm::ceil(high + margin_px), low, size);
    return {{static_cast<std::int32_t>(low.x), static_cast<std::int32_t>(low.y)},
            {static_cast<std::uint32_t>(high.x - low.x), static_cast<std::uint32_t>(high.y - low.y)}};
}

VkRenderingInfo rendering_info(VkExtent2D extent, std::uint32_t views,
                               std::span<const VkRenderingAttachmentInfo> colors,
                               const VkRenderingAttachmentInfo* depth) {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.viewMask = view_mask(views);
    info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = depth;
    return info;
}

void draw_screen(VkCommandBuffer commands) { vkCmdDraw(commands, 6, 1, 0, 0); }

}  // namespace bolt::render
