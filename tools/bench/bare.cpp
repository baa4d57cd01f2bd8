#include "tools/bench/bare.hpp"

#include <array>

#include "engine/gpu/barrier.hpp"

std::span<const std::uint32_t> bench_shaders(std::string_view name);

namespace bolt::bench {

namespace {

using gpu::ResourceUse;

struct Push {
    glm::mat4 clip_from_object;
    glm::vec4 color;
};

Result<gpu::Image> make_target(gpu::Device& device, VkExtent2D extent, VkFormat format,
                               VkSampleCountFlagBits samples, VkImageUsageFlags usage) {
    gpu::ImageInfo info;
    info.extent = extent;
    info.format = format;
    info.samples = samples;
    info.usage = usage;
    return gpu::Image::create(device, info);
}

template <class T>
Status take(T& to, Result<T> made) {
    if (!made) return fail(made.error());
    to = std::move(*made);
    return {};
}

}  // namespace

Result<BareRenderer> BareRenderer::create(gpu::Device& device, VkExtent2D extent) {
    BareRenderer bare;
    bare.extent_ = extent;
    BOLT_TRY(take(bare.cache_, gpu::PipelineCache::open(device, {})));
    BOLT_TRY_ASSIGN(const auto vertex, gpu::make_shader("bare.vert", bench_shaders("bare.vert")));
    BOLT_TRY_ASSIGN(const auto fragment, gpu::make_shader("bare.frag", bench_shaders("bare.frag")));
    gpu::GraphicsInfo info;
    info.vertex = &vertex;
    info.fragment = &fragment;
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    info.colors = {render::color_format};
    info.depth = render::depth_format;
    info.samples = VK_SAMPLE_COUNT_4_BIT;
    BOLT_TRY(take(bare.pipeline_, gpu::make_graphics_pipeline(device, bare.cache_, info)));
    Status s = take(bare.drawn_, make_target(device, extent, render::color_format, VK_SAMPLE_COUNT_4_BIT,
                                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    if (s)
        s = take(bare.depth_, make_target(device, extent, render::depth_format, VK_SAMPLE_COUNT_4_BIT,
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
    if (s)
        s = take(bare.picture_,
                 make_target(device, extent, render::color_format, VK_SAMPLE_COUNT_1_BIT,
                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    if (!s) return fail(s.error());
    return bare;
}

Status BareRenderer::render(gpu::FrameContext& frame, const render::Scene& scene, const render::Eye& eye) {
    const VkCommandBuffer commands = frame.commands();
    frame.begin_timing("bare");
    gpu::image_barrier_discarding(commands, drawn_.get(), ResourceUse::color_target,
                                  ResourceUse::color_target);
    gpu::image_barrier_discarding(commands, depth_.get(), ResourceUse::depth_target,
                                  ResourceUse::depth_target, {VK_IMAGE_ASPECT_DEPTH_BIT});
    gpu::image_barrier_discarding(commands, picture_.get(), ResourceUse::transfer_from,
                                  ResourceUse::color_target);
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = drawn_.view();
    color.imageLayout = color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = picture_.view();
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = depth_.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = extent_;
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    const VkViewport viewport{
        0.0F, 0.0F, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0.0F, 1.0F};
    const VkRect2D scissor{{0, 0}, extent_};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle.get());
    for (const render::Object& object : scene.objects) {
        const VkBuffer positions = object.model->positions.get();
        constexpr VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &positions, &start);
        vkCmdBindIndexBuffer(commands, object.model->indices.get(), 0, VK_INDEX_TYPE_UINT32);
        const render::MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            const render::MeshPart& part = object.model->parts[i];
            const render::LevelRange& all = part.levels.front();
            const Push push{eye.clip_from_world * object.world,
                            glm::vec4(glm::vec3(0.25F + 0.07F * static_cast<float>(i % 8)), 1.0F)};
            vkCmdPushConstants(commands, pipeline_.layout.get(), pipeline_.push_stages, 0, sizeof push,
                               &push);
            vkCmdDrawIndexed(commands, all.index_count, 1, all.first_index, part.first_vertex, 0);
        }
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, picture_.get(), ResourceUse::color_target, ResourceUse::transfer_from);
    frame.end_timing();
    return {};
}

}  // namespace bolt::bench
