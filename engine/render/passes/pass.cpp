#include "engine/render/passes/pass.hpp"

#include <algorithm>
#include <cstdlib>
#include <glm/common.hpp>

#include "engine/gpu/pipeline.hpp"
#include "engine/render/hot_shaders.hpp"

namespace bolt::render {

namespace {

Status add(gpu::Device& device, const RenderTargets& targets, gpu::Image& to, VkFormat format,
           VkImageUsageFlags usage, VkSampleCountFlagBits samples, std::uint32_t divisor = 1,
           VkFormat storage_format = VK_FORMAT_UNDEFINED) {
    if (to.get() != VK_NULL_HANDLE) return {};
    gpu::ImageInfo info;
    info.extent = {(targets.extent.width + divisor - 1) / divisor,
                   (targets.extent.height + divisor - 1) / divisor};
    info.layers = targets.layers;
    info.array = true;  // also with one layer, because shaders read the layer of their view
    info.format = format;
    info.samples = samples;
    info.usage = usage;
    info.storage_format = storage_format;
    return assign(to, gpu::Image::create(device, info));
}

constexpr VkImageUsageFlags drawn_and_read = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags depth_and_read =
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;

}  // namespace

Result<RenderTargets> make_targets(gpu::Device& device, VkExtent2D extent, std::uint32_t layers,
                                   ScreenStage stage) {
    RenderTargets t;
    t.extent = extent;
    t.layers = layers;
    BOLT_TRY(add(device, t, t.depth, depth_format, depth_and_read, samples));
    BOLT_TRY(add(device, t, t.surfaces, surface_format, drawn_and_read, samples));
    VkImageUsageFlags picture_usage = drawn_and_read | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    VkFormat storage_format = VK_FORMAT_UNDEFINED;
    if (stage == ScreenStage::compute) {
        picture_usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        storage_format = storage_color_format;
    }
    BOLT_TRY(
        add(device, t, t.picture, color_format, picture_usage, VK_SAMPLE_COUNT_1_BIT, 1, storage_format));
    return t;
}

Status add_material_targets(gpu::Device& device, RenderTargets& t) {
    BOLT_TRY(add(device, t, t.material_colors, material_color_format, drawn_and_read, samples));
    return add(device, t, t.material_roughness, material_roughness_format, drawn_and_read, samples);
}

Status add_forward_targets(gpu::Device& device, RenderTargets& t) {
    BOLT_TRY(add(device, t, t.forward_color, layer_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, samples));
    return add(device, t, t.forward_resolved, layer_format, drawn_and_read, VK_SAMPLE_COUNT_1_BIT);
}

Status add_mark_target(gpu::Device& device, RenderTargets& t) {
    return add(device, t, t.marks, mark_format, drawn_and_read, VK_SAMPLE_COUNT_1_BIT);
}

Status add_occlusion_targets(gpu::Device& device, RenderTargets& t, ScreenStage stage) {
    constexpr VkSampleCountFlagBits one = VK_SAMPLE_COUNT_1_BIT;
    if (stage == ScreenStage::compute) {
        constexpr VkImageUsageFlags computed = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        BOLT_TRY(add(device, t, t.small_depth, computed_depth_format, computed, one, 2));
        BOLT_TRY(add(device, t, t.raw_occlusion, computed_occlusion_format, computed, one, 2));
        return add(device, t, t.occlusion, computed_occlusion_format, computed, one, 2);
    }
    BOLT_TRY(add(device, t, t.small_depth, depth_format, depth_and_read, one, 2));
    BOLT_TRY(add(device, t, t.raw_occlusion, occlusion_format, drawn_and_read, one, 2));
    return add(device, t, t.occlusion, occlusion_format, drawn_and_read, one, 2);
}

Status add_kept_depth(gpu::Device& device, RenderTargets& t) {
    return add(device, t, t.kept_depth, depth_format,
               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
               VK_SAMPLE_COUNT_1_BIT);
}

std::uint32_t view_mask(std::uint32_t views) { return views > 1 ? (1U << views) - 1U : 0U; }

void set_views(gpu::GraphicsInfo& info, std::uint32_t views) {
    info.view_mask = view_mask(views);
    if (views > 1) info.constants |= SCENE_VIEWS;
}

gpu::GraphicsInfo over_picture(const Shaders& shaders, const std::string& vertex, const std::string& fragment,
                               std::uint32_t views) {
    gpu::GraphicsInfo info;
    info.vertex = &shaders.at(vertex);
    info.fragment = &shaders.at(fragment);
    info.colors = {color_format};
    set_views(info, views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.blend = true;
    return info;
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
        // Deformed streams start at the part, so it is drawn from vertex 0, and the other streams get an
        // offset.
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

bool has_hidden_area(std::span<const Eye> eyes) {
    return std::any_of(eyes.begin(), eyes.end(),
                       [](const Eye& eye) { return eye.hidden != nullptr && !eye.hidden->empty(); });
}

VkRect2D area_of(const PassContext& context, std::span<const BoundingBox> boxes, float margin_px) {
    const glm::vec2 size(static_cast<float>(context.extent.width), static_cast<float>(context.extent.height));
    glm::vec2 low(1e30F), high(-1e30F);
    for (const BoundingBox& box : boxes)
        for (std::uint32_t view = 0; view < context.views; ++view)
            for (int i = 0; i < 8; ++i) {
                const glm::vec4 c =
                    context.shared.views[view].clip_from_world * glm::vec4(box.corner(i), 1.0F);
                if (c.w <= 0.0F) return {{0, 0}, context.extent};  // the box reaches behind the eye
                const glm::vec2 pixel = (glm::vec2(c) / c.w * 0.5F + 0.5F) * size;
                low = glm::min(low, pixel);
                high = glm::max(high, pixel);
            }
    const glm::vec2 around = margin_px + 0.5F * context.margin * size;
    low = glm::clamp(glm::floor(low - around), glm::vec2(0.0F), size);
    high = glm::clamp(glm::ceil(high + around), low, size);
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

void dispatch_screen(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set,
                     VkExtent2D extent, std::uint32_t views) {
    constexpr std::uint32_t group = 8;  // pixels, as in compute.glsl
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout.get(), 0, 1, &set, 0,
                            nullptr);
    vkCmdDispatch(commands, (extent.width + group - 1) / group, (extent.height + group - 1) / group, views);
}

void draw_screen(VkCommandBuffer commands) { vkCmdDraw(commands, 6, 1, 0, 0); }

namespace {

Result<VkDescriptorSet> maps_set(PassContext& context, const gpu::Pipeline& pipeline, const GpuModel& model,
                                 const MaterialMaps& maps) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 1));
    for (const gpu::Binding& map : pipeline.bindings) {  // only the maps that this pipeline reads
        if (map.set != 1) continue;
        const int index = maps.textures.at(map.binding);
        const GpuTexture& texture =
            index >= 0 ? model.textures[static_cast<std::size_t>(index)] : context.white;
        writer.image(map.binding, texture.image.view(), texture.sampler.get());
    }
    return writer.finish();
}

}  // namespace

gpu::GraphicsInfo part_pipeline(const Shaders& shaders, const PipelineKind& kind, std::uint32_t views) {
    gpu::GraphicsInfo info;
    info.vertex = &shaders.at("scene.vert");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0},
                    {1, VK_FORMAT_R16G16B16A16_SNORM, 1, offsetof(VertexAttributes, normal)},
                    {2, VK_FORMAT_R16G16B16A16_SNORM, 1, offsetof(VertexAttributes, tangent)},
                    {3, VK_FORMAT_R32G32_SFLOAT, 1, offsetof(VertexAttributes, texcoord)},
                    {4, VK_FORMAT_R8G8B8A8_UNORM, 1, offsetof(VertexAttributes, color)},
                    {5, VK_FORMAT_R32G32_SFLOAT, 1, offsetof(VertexAttributes, texcoord)}};
    info.strides = {sizeof(glm::vec3), sizeof(VertexAttributes)};
    if ((kind.features & SCENE_SECOND_UV) != 0) {
        info.streams.back() = {5, VK_FORMAT_R32G32_SFLOAT, 2, 0};
        info.strides.push_back(sizeof(glm::vec2));
    }
    info.depth = depth_format;
    info.samples = samples;
    set_views(info, views);
    info.cull = kind.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    info.constants |= kind.features;
    return info;
}

Status draw_parts(PassContext& context, const DrawList& list, const PartDrawing& drawing) {
    const VkCommandBuffer commands = context.frame.commands();
    const gpu::Pipeline* pipeline = nullptr;
    const Draw* bound = nullptr;
    const MaterialMaps* maps = nullptr;
    std::map<const gpu::Pipeline*, VkDescriptorSet> frame_sets;  // a pipeline may be bound repeatedly
    for (const Draw& d : list.draws) {
        if (!drawing.wanted(d.kind)) continue;
        BOLT_TRY_ASSIGN(auto wanted, drawing.pipeline(d.kind));
        if (std::exchange(pipeline, wanted) != wanted) {
            if (drawing.area) {
                const VkRect2D area = drawing.area(d.kind);
                vkCmdSetScissor(commands, 0, 1, &area);
            }
            VkDescriptorSet& set = frame_sets[wanted];
            if (set == VK_NULL_HANDLE) {
                BOLT_TRY_ASSIGN(set, drawing.frame_set(*wanted));
            }
            bind(commands, *wanted, set);
            maps = nullptr;
        }
        const MaterialMaps& needed = d.model->maps[d.model->parts[d.part].material];
        const bool has_maps = pipeline->sets.size() > 1;
        if (has_maps && (maps == nullptr || bound->model != d.model || maps->textures != needed.textures)) {
            BOLT_TRY_ASSIGN(auto set, maps_set(context, *wanted, *d.model, needed));
            bind(commands, *wanted, set, 1);
        }
        maps = &needed;
        if (bound == nullptr || !same_geometry(*bound, d)) bind_geometry(commands, d);
        bound = &d;
        if (pipeline->push_size > 0)
            vkCmdPushConstants(commands, pipeline->layout.get(), pipeline->push_stages, 0, sizeof d.material,
                               &d.material);
        draw(commands, d);
    }
    return {};
}

namespace {

constexpr VkExtent2D check_extent{8, 8};
constexpr VkFormat check_format = VK_FORMAT_R8_UNORM;

Result<gpu::Pipeline> make_check_pipeline(gpu::Device& device, const gpu::PipelineCache& cache) {
    BOLT_TRY_ASSIGN(auto vertex, load_shader("multiview_check.vert", {}));
    BOLT_TRY_ASSIGN(auto fragment, load_shader("multiview_check.frag", {}));
    gpu::GraphicsInfo info;
    info.vertex = &vertex;
    info.fragment = &fragment;
    info.colors = {check_format};
    info.view_mask = view_mask(2);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    return gpu::make_graphics_pipeline(device, cache, info);
}

// Returns true if every texel of the layer differs from `expected` (0 … 255) by at most 1.
Result<bool> has_value(gpu::Device& device, const gpu::Image& image, std::uint32_t layer, int expected) {
    BOLT_TRY_ASSIGN(const auto texels,
                    gpu::download_image(device, image, gpu::ResourceUse::color_target, 1, 0, layer));
    return std::all_of(texels.begin(), texels.end(), [&](std::byte texel) {
        return std::abs(std::to_integer<int>(texel) - expected) <= 1;
    });
}

}  // namespace

Result<bool> multiview_works(gpu::Device& device, const gpu::PipelineCache& cache) {
    BOLT_TRY_ASSIGN(const auto pipeline, make_check_pipeline(device, cache));
    BOLT_TRY_ASSIGN(const auto image,
                    gpu::Image::create(device, {.format = check_format,
                                                .extent = check_extent,
                                                .layers = 2,
                                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                         VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    BOLT_TRY(gpu::submit_and_wait(device, [&](VkCommandBuffer commands) {
        gpu::image_barrier_discarding(commands, image.get(), gpu::ResourceUse::color_target,
                                      gpu::ResourceUse::color_target);
        VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        color.imageView = image.view();
        color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        const VkRenderingInfo rendering = rendering_info(check_extent, 2, {&color, 1}, nullptr);
        vkCmdBeginRendering(commands, &rendering);
        set_area(commands, check_extent);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle.get());
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRendering(commands);
    }));
    BOLT_TRY_ASSIGN(const bool first, has_value(device, image, 0, 255));
    BOLT_TRY_ASSIGN(const bool second, has_value(device, image, 1, 128));
    return first && second;
}

}  // namespace bolt::render
