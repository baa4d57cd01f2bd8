#include "engine/render/gpu_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/matrix.hpp>
#include <numeric>

#include "engine/assets/levels.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/gpu_layout.hpp"
#include "shaders/shared.h"

// Asserts that C++ and the shader compilers use the same layout of the shared structures.
namespace bolt::render::shared {

static_assert(sizeof(View) == 144 && offsetof(View, eye) == 128);
static_assert(sizeof(Light) == 64);
static_assert(offsetof(FrameData, lights) == 576 && offsetof(FrameData, diffuse) == 1088);
static_assert(offsetof(FrameData, shadow_from_world) == 1232 && offsetof(FrameData, cut_strength) == 1376);
static_assert(sizeof(FrameData) == 1392);
static_assert(sizeof(Instance) == 112 && offsetof(Instance, flags) == 96);
static_assert(sizeof(Material) == 448 && offsetof(Material, metallic) == 48 && offsetof(Material, uv) == 96);
static_assert(sizeof(DeformPart) == 40);

}  // namespace bolt::render::shared

namespace bolt::render {

BoundingBox transformed(const BoundingBox& box, const glm::mat4& transform) {
    BoundingBox moved;
    for (int i = 0; i < 8; ++i) moved.add(glm::vec3(transform * glm::vec4(box.corner(i), 1.0F)));
    return moved;
}

namespace {

// Adds the box of each joint. The weights of a vertex sum to one, so its position is a mean of the positions
// that each of its joints alone would give. So a box around all moved boxes contains all vertices.
void add_joint_boxes(const assets::Primitive& p, std::span<const std::uint32_t> sources,
                     std::span<const Influences> influences, Deformable& part) {
    for (std::size_t i = 0; i < influences.size(); ++i)
        for (int k = 0; k < 4; ++k) {
            if (influences[i].weights[k] == 0) continue;
            const std::size_t joint = influences[i].joints[k];
            if (part.joint_boxes.size() <= joint) part.joint_boxes.resize(joint + 1);
            part.joint_boxes[joint].add(p.positions[sources[i]]);
        }
}

void add_targets(const assets::Primitive& p, std::span<const std::uint32_t> sources, DeformData& data,
                 Deformable& part) {
    const auto any = [&](auto stream) {
        return std::any_of(p.targets.begin(), p.targets.end(),
                           [&](const assets::MorphTarget& t) { return !(t.*stream).empty(); });
    };
    part.delta_floats = any(&assets::MorphTarget::tangents) ? 9 : any(&assets::MorphTarget::normals) ? 6 : 3;
    part.first_delta = static_cast<std::uint32_t>(data.deltas.size());
    for (const assets::MorphTarget& target : p.targets) {
        const std::array streams{&target.positions, &target.normals, &target.tangents};
        BoundingBox box;
        for (const std::uint32_t source : sources) {
            for (std::size_t s = 0; s < part.delta_floats / 3; ++s) {
                const glm::vec3 delta = streams[s]->empty() ? glm::vec3(0.0F) : (*streams[s])[source];
                data.deltas.insert(data.deltas.end(), {delta.x, delta.y, delta.z});
                if (s == 0) box.add(delta);
            }
        }
        part.target_boxes.push_back(box);
    }
}

}  // namespace

Influences make_influences(const glm::u16vec4& joints, const glm::vec4& weights) {
    std::array<float, 4> weight{};
    for (int i = 0; i < 4; ++i) weight[static_cast<std::size_t>(i)] = std::max(weights[i], 0.0F);
    float sum = std::accumulate(weight.begin(), weight.end(), 0.0F);
    if (!(sum > 0.0F)) weight[0] = sum = 1.0F;  // the vertex follows its first joint
    Influences to{};
    int remainder = 65535;
    for (std::size_t i = 0; i < 4; ++i) {
        const int rounded = std::min(remainder, static_cast<int>(std::lround(weight[i] / sum * 65535.0F)));
        to.joints[i] = joints[static_cast<int>(i)];
        to.weights[i] = static_cast<std::uint16_t>(rounded);
        remainder -= rounded;
    }
    // Add the rounding remainder to the largest weight.
    *std::max_element(std::begin(to.weights), std::end(to.weights)) += static_cast<std::uint16_t>(remainder);
    return to;
}

Deformable make_deformable(const assets::Primitive& p, std::span<const std::uint32_t> sources,
                           DeformData& data) {
    Deformable part;
    if (p.joints.empty() && p.targets.empty()) return part;
    part.vertices = static_cast<std::uint32_t>(sources.size());
    part.own_normals = !p.normals.empty();
    if (!p.joints.empty()) {
        part.first_influence = static_cast<std::uint32_t>(data.influences.size());
        for (const std::uint32_t source : sources)
            data.influences.push_back(make_influences(p.joints[source], p.weights[source]));
        add_joint_boxes(p, sources, std::span(data.influences).subspan(part.first_influence), part);
    }
    if (!p.targets.empty()) add_targets(p, sources, data, part);
    return part;
}

BoundingBox bounds(const BoundingBox& rest, const Deformable& part, const Deformation* deformation) {
    if (deformation == nullptr || part.vertices == 0) return rest;
    glm::vec3 low(0.0F), high(0.0F);  // displacements by the targets
    for (std::size_t i = 0; i < part.target_boxes.size() && i < deformation->weights.size(); ++i) {
        const glm::vec3 a = deformation->weights[i] * part.target_boxes[i].low,
                        b = deformation->weights[i] * part.target_boxes[i].high;
        low += glm::min(a, b);
        high += glm::max(a, b);
    }
    const auto morphed = [&](const BoundingBox& box) { return BoundingBox{box.low + low, box.high + high}; };
    if (deformation->joints.empty() || part.joint_boxes.empty()) return morphed(rest);
    BoundingBox box;
    for (std::size_t i = 0; i < part.joint_boxes.size() && i < deformation->joints.size(); ++i) {
        if (part.joint_boxes[i].empty()) continue;
        const BoundingBox moved = transformed(morphed(part.joint_boxes[i]), deformation->joints[i]);
        box.add(moved.low);
        box.add(moved.high);
    }
    return box;
}

float scale_of(const Deformation* deformation) {
    if (deformation == nullptr || deformation->joints.empty()) return 1.0F;
    float largest = 0.0F;
    for (const glm::mat4& joint : deformation->joints)
        largest = std::max(largest, std::cbrt(std::abs(glm::determinant(glm::mat3(joint)))));
    return largest;
}

bool mirrors(const Deformation* deformation) {
    return deformation != nullptr && !deformation->joints.empty() &&
           glm::determinant(glm::mat3(deformation->joints.front())) < 0.0F;
}

namespace {

// The contents of the GPU buffers: all parts in sequence.
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

bool uses_second_uv(const assets::Model& model) {
    return std::any_of(model.materials.begin(), model.materials.end(), [](const assets::Material& material) {
        return (features_of(material) & SCENE_SECOND_UV) != 0;
    });
}

// Generates coarser levels of a part. Vertices that they add are appended to `vertices`.
std::vector<assets::LevelOfDetail> add_levels(const assets::Primitive& primitive, std::uint32_t features,
                                              Vertices& vertices) {
    const bool deformable = !primitive.targets.empty() || !primitive.joints.empty();
    assets::LevelOptions options;
    options.weld = !deformable && primitive.colors.empty() && (features & SCENE_ANY_MAP) == 0;
    std::vector<glm::vec3> normals;
    // For a deformable part without normals, deform.comp computes face normals from every three vertices. So
    // no vertices may be added; without normals, coarser_levels adds none.
    if (!deformable || !primitive.normals.empty())
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
            copy_with_normal(vertices, added.source, added.normal);
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
    part.deformable = make_deformable(primitive, vertices.sources, all.deform);
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
    all.has_second_uv = uses_second_uv(model);
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
