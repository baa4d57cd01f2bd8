#include "engine/render/gpu_model.hpp"

#include "engine/assets/levels.hpp"
#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"
#include "engine/render/vertices.hpp"

namespace bolt::render {

Box transformed(const Box& box, const glm::mat4& transform) {
    Box moved;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.high.x : box.low.x,
                              (corner & 2) != 0 ? box.high.y : box.low.y,
                              (corner & 4) != 0 ? box.high.z : box.low.z);
        moved.add(glm::vec3(transform * glm::vec4(point, 1.0F)));
    }
    return moved;
}

Result<GpuModel> upload_model(gpu::Device& device, const assets::Model& model, const UploadOptions& options) {
    GpuModel gpu_model;
    Vertices all;
    for (const assets::Mesh& mesh : model.meshes) {
        MeshRange range{static_cast<std::uint32_t>(gpu_model.parts.size()), 0};
        for (const assets::Primitive& primitive : mesh.primitives) {
            const Vertices vertices = make_vertices(primitive);
            if (vertices.indices.empty()) continue;
            Part part;
            const auto add_level = [&](const std::vector<std::uint32_t>& indices, float error) {
                part.levels.push_back({static_cast<std::uint32_t>(all.indices.size()),
                                       static_cast<std::uint32_t>(indices.size()), error});
                all.indices.insert(all.indices.end(), indices.begin(), indices.end());
            };
            add_level(vertices.indices, 0.0F);
            if (options.levels)
                for (const assets::Level& level :
                     assets::coarser_levels(vertices.positions, vertices.indices))
                    add_level(level.indices, level.error);
            part.first_vertex = static_cast<std::int32_t>(all.positions.size());
            part.material = static_cast<std::uint32_t>(primitive.material >= 0
                                                           ? static_cast<std::size_t>(primitive.material)
                                                           : model.materials.size());
            part.colors = !primitive.colors.empty();
            part.tangents = !primitive.tangents.empty();
            for (const glm::vec3& position : vertices.positions) part.box.add(position);
            all.positions.insert(all.positions.end(), vertices.positions.begin(), vertices.positions.end());
            all.attributes.insert(all.attributes.end(), vertices.attributes.begin(),
                                  vertices.attributes.end());
            gpu_model.triangles += vertices.indices.size() / 3;
            gpu_model.parts.push_back(std::move(part));
            ++range.count;
        }
        gpu_model.meshes.push_back(range);
    }
    const auto add_material = [&](const assets::Material& material) {
        gpu_model.materials.push_back(make_material(material));
        gpu_model.features.push_back(features_of(material));
        gpu_model.maps.push_back(maps_of(material));
    };
    for (const assets::Material& material : model.materials) add_material(material);
    add_material({});

    const auto upload = [&](gpu::Buffer& to, auto& values, VkBufferUsageFlags usage) -> Status {
        Result<gpu::Buffer> buffer = gpu::upload_buffer(device, std::as_bytes(std::span(values)), usage);
        if (!buffer) return fail(buffer.error());
        to = std::move(*buffer);
        return {};
    };
    if (Status s = upload(gpu_model.positions, all.positions, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT); !s)
        return fail(s.error());
    if (Status s = upload(gpu_model.attributes, all.attributes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT); !s)
        return fail(s.error());
    if (Status s = upload(gpu_model.indices, all.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT); !s)
        return fail(s.error());
    Result<std::vector<GpuTexture>> textures = upload_textures(device, model);
    if (!textures) return fail(textures.error());
    gpu_model.textures = std::move(*textures);
    return gpu_model;
}

}  // namespace bolt::render
