#include "engine/render/passes/parts.hpp"

namespace bolt::render {

namespace {

Result<VkDescriptorSet> maps_set(PassContext& context, const gpu::Pipeline& pipeline, const GpuModel& model,
                                 const MaterialMaps& maps) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 1));
    for (const gpu::Binding& map : pipeline.bindings) {  // only those that this pass uses
        if (map.set != 1) continue;
        const int which = maps.textures.at(map.binding);
        const GpuTexture& texture =
            which >= 0 ? model.textures[static_cast<std::size_t>(which)] : context.white;
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
    draw_views(info, views);
    info.cull = kind.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    info.constants |= kind.features;
    return info;
}

Status draw_parts(PassContext& context, const DrawList& list, const PartDrawing& drawing) {
    const VkCommandBuffer commands = context.frame.commands();
    const gpu::Pipeline* pipeline = nullptr;
    const Draw* bound = nullptr;
    const MaterialMaps* maps = nullptr;
    for (const Draw& d : list.draws) {
        if (!drawing.wanted(d.kind)) continue;
        BOLT_TRY_ASSIGN(auto wanted, drawing.pipeline(d.kind));
        if (std::exchange(pipeline, wanted) != wanted) {
            if (drawing.area) {
                const VkRect2D area = drawing.area(d.kind);
                vkCmdSetScissor(commands, 0, 1, &area);
            }
            BOLT_TRY_ASSIGN(auto set, drawing.frame_set(*wanted));
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

}  // namespace bolt::render
