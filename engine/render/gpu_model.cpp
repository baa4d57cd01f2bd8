#include "engine/render/gpu_model.hpp"

#include <algorithm>

#include "engine/assets/levels.hpp"
#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"
#include "engine/render/vertices.hpp"

namespace bolt::render {

namespace {

// All parts in sequence, as in the GPU buffers.
struct Streams {
    Vertices vertices;
    std::vector<glm::vec2> second_uv;
    bool has_second_uv = false;  // a material uses it
    DeformData deform;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

bool looks_at_second_uv(const assets::Model& model) {
    return std::any_of(model.materials.begin(), model.materials.end(), [](const assets::Material& material) {
        return (features_of(material) & SCENE_SECOND_UV) != 0;
    });
}

// Generates coarser levels of a part; vertices that they add are appended to it.
std::vector<assets::LevelOfDetail> add_levels(const assets::Primitive& primitive, std::uint32_t features,
                                              Vertices& vertices) {
    const bool bends = !primitive.targets.empty() || !primitive.joints.empty();
    assets::LevelOptions options;
    options.weld = !bends && primitive.colors.empty() && (features & SCENE_ANY_MAP) == 0;
    std::vector<glm::vec3> normals;
    // Deformable triangles without normals keep their order in the buffer.
    if (!bends || !primitive.normals.empty())
        for (const VertexAttributes& a : vertices.attributes)
            normals.push_back(glm::vec3(a.normal[0], a.normal[1], a.normal[2]) / 32767.0F);
    std::vector<assets::LevelOfDetail> levels =
        assets::coarser_levels(vertices.positions, normals, vertices.indices, options);
    const auto own = static_cast<std::uint32_t>(vertices.positions.size());
    for (assets::LevelOfDetail& level : levels) {
        const auto more = static_cast<std::uint32_t>(vertices.positions.size()) - own;
        for (std::uint32_t& index : level.indices)
            if (index >= own) index += more;
        for (const assets::AddedVertex& added : level.added)
            copy_with_normal(vertices, added.of, added.normal);
    }
    return levels;
}

MeshPart add_part(const assets::Model& model, const assets::Primitive& primitive, Vertices vertices,
                  std::uint32_t features, const UploadOptions& options, Streams& all) {
    MeshPart part;
    const auto add_level = [&](const std::vector<std::uint32_t>& indices, float error) {
        part.levels.push_back({static_cast<std::uint32_t>(all.vertices.indices.size()),
                               static_cast<std::uint32_t>(indices.size()), error});
        append(all.vertices.indices, indices);
    };
    add_level(vertices.indices, 0.0F);
    if (options.levels)
        for (const assets::LevelOfDetail& level : add_levels(primitive, features, vertices))
            add_level(level.indices, level.error);
    part.first_vertex = static_cast<std::int32_t>(all.vertices.positions.size());
    part.material = static_cast<std::uint32_t>(
        primitive.material >= 0 ? static_cast<std::size_t>(primitive.material) : model.materials.size());
    part.colors = !primitive.colors.empty();
    part.tangents = vertices.tangents;
    for (const glm::vec3& position : vertices.positions) part.box.add(position);
    part.bends = make_deformable(primitive, vertices.sources, all.deform);
    append(all.vertices.positions, vertices.positions);
    append(all.vertices.attributes, vertices.attributes);
    if (!all.has_second_uv) return part;
    for (const std::uint32_t source : vertices.sources)
        all.second_uv.push_back(primitive.texcoords[1].empty() ? glm::vec2(0.0F)
                                                               : primitive.texcoords[1][source]);
    return part;
}

template <class T>
Status upload(gpu::Device& device, gpu::Buffer& to, const std::vector<T>& values, VkBufferUsageFlags usage) {
    BOLT_TRY_ASSIGN(auto buffer, gpu::upload_buffer(device, std::as_bytes(std::span(values)), usage));
    to = std::move(buffer);
    return {};
}

Status upload_streams(gpu::Device& device, const Streams& all, GpuModel& to) {
    constexpr VkBufferUsageFlags vertex = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                 index = VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                                 storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    Status done = upload(device, to.positions, all.vertices.positions, vertex | storage);
    if (done) done = upload(device, to.attributes, all.vertices.attributes, vertex | storage);
    if (done) done = upload(device, to.indices, all.vertices.indices, index);
    if (done && all.has_second_uv) done = upload(device, to.second_uv, all.second_uv, vertex);
    if (done && !all.deform.influences.empty())
        done = upload(device, to.influences, all.deform.influences, storage);
    if (done && !all.deform.deltas.empty()) done = upload(device, to.deltas, all.deform.deltas, storage);
    return done;
}

}  // namespace

Result<GpuModel> upload_model(gpu::Device& device, const assets::Model& model, const UploadOptions& options) {
    GpuModel gpu_model;
    Streams all;
    all.has_second_uv = looks_at_second_uv(model);
    const assets::Material plain;
    for (const assets::Mesh& mesh : model.meshes) {
        MeshRange range{static_cast<std::uint32_t>(gpu_model.parts.size()), 0};
        for (const assets::Primitive& primitive : mesh.primitives) {
            const assets::Material& material =
                primitive.material >= 0 ? model.materials[static_cast<std::size_t>(primitive.material)]
                                        : plain;
            Vertices vertices = make_vertices(primitive, material);
            if (vertices.indices.empty()) continue;
            gpu_model.triangles += vertices.indices.size() / 3;
            gpu_model.parts.push_back(
                add_part(model, primitive, std::move(vertices), features_of(material), options, all));
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
    add_material(plain);
    BOLT_TRY(upload_streams(device, all, gpu_model));
    BOLT_TRY_ASSIGN(auto textures, upload_textures(device, model));
    gpu_model.textures = std::move(textures);
    return gpu_model;
}

}  // namespace bolt::render
