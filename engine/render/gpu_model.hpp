// Models in GPU memory, with the bounds and the deformation data of their parts.
#pragma once

#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/gpu/resources.hpp"
#include "shaders/shared.h"

namespace bolt::render {

// Axis-aligned.
struct BoundingBox {
    glm::vec3 low{1e30F}, high{-1e30F};

    void add(const glm::vec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    // Returns corner 0 … 7. Bits 0, 1 and 2 of `i` select the upper limit of x, y and z.
    [[nodiscard]] glm::vec3 corner(int i) const {
        return {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z};
    }
};

// Returns the axis-aligned bounding box of a transformed box.
BoundingBox transformed(const BoundingBox& box, const glm::mat4& transform);

// The joints and weights of one object in one pose. passes/geometry.hpp (DeformPass) applies them on the GPU.
// Create a new one for every pose.
struct Deformation {
    std::vector<glm::mat4> joints;  // from the mesh in its bind pose to the object's frame; empty: no skin
    std::vector<float> weights;     // morph target weights, in order; missing ones are 0
};

// Four joints of a vertex and their weights.
struct Influences {
    std::uint16_t joints[4];
    // unorm. The sum is exactly 65535, so that joints with equal motions move the vertex by exactly that
    // motion.
    std::uint16_t weights[4];
};
static_assert(sizeof(Influences) == 16);

// The deformation data of a part: its ranges in the model's buffers, and bounds of the motion.
struct Deformable {
    std::uint32_t vertices = 0;         // 0: rigid
    std::uint32_t first_influence = 0;  // index into the model's influences; only with `joint_boxes`
    std::uint32_t first_delta = 0;      // index into the model's deltas, in floats; target by target
    std::uint32_t delta_floats = 0;     // per vertex: 3 position, 6 with normal, 9 with tangent
    bool own_normals = true;            // false: flat normals of triangles without shared vertices
    // For each joint, the box around the vertices that it moves, in bind pose; an empty box if it moves none.
    std::vector<BoundingBox> joint_boxes;
    // For each morph target, the box around its displacements at weight 1.
    std::vector<BoundingBox> target_boxes;
};

// The deformation data of all parts of a model, as uploaded to the GPU.
struct DeformData {
    std::vector<Influences> influences;
    std::vector<float> deltas;
};

// Rounds weights to integers with the exact sum. A vertex without weights follows its first joint.
Influences make_influences(const glm::u16vec4& joints, const glm::vec4& weights);

// Appends the data of a primitive to `data`. `sources`: for each drawn vertex, the vertex of the primitive
// that it was made from.
Deformable make_deformable(const assets::Primitive& primitive, std::span<const std::uint32_t> sources,
                           DeformData& data);

// Returns a box that contains the part in this pose, in the object's frame. `rest`: its box without
// deformation.
BoundingBox bounds(const BoundingBox& rest, const Deformable& part, const Deformation* deformation);

// Return the largest scale of the joints, and whether the joints mirror the part; 1 and false without a
// deformation or without joints.
float scale_of(const Deformation* deformation);
bool mirrors(const Deformation* deformation);

// The triangles of a part at one level of detail.
struct LevelRange {
    std::uint32_t first_index = 0, index_count = 0;
    float error = 0.0F;  // m in the mesh's frame: estimated largest distance from the finest level
};

// The unit of a draw call: a primitive of a mesh.
struct MeshPart {
    std::vector<LevelRange> levels;  // finest first, at least one
    std::int32_t first_vertex = 0;
    std::uint32_t material = 0;  // index into the model's materials
    bool colors = false;         // has vertex colours
    bool tangents = false;
    BoundingBox box;  // in the mesh's frame, m
    Deformable deformable;
};

struct MeshRange {
    std::uint32_t first = 0, count = 0;  // parts
};

// The textures of a material, and how its parts are drawn.
struct MaterialMaps {
    // Indices into the model's textures; -1: none. Order: base colour, metallic-roughness, normal, occlusion,
    // emissive, coat, coat roughness, coat normal, anisotropy, specular, specular colour.
    std::array<int, 11> textures{-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    bool blends = false, double_sided = false;
};

struct GpuTexture {
    gpu::Image image;
    gpu::Sampler sampler;
};

// A model in GPU memory: all meshes in shared buffers, materials in the shaders' layout, and textures.
struct GpuModel {
    gpu::Buffer positions;   // vec3 float
    gpu::Buffer attributes;  // VertexAttributes
    gpu::Buffer second_uv;   // vec2 float; only if a material uses it
    gpu::Buffer indices;     // uint32
    gpu::Buffer influences;  // only for parts with joints
    gpu::Buffer deltas;      // float, morph targets
    std::vector<MeshPart> parts;
    std::vector<MeshRange> meshes;
    std::vector<shared::Material> materials;  // the default material is appended
    std::vector<std::uint32_t> features;      // SCENE_… bits, parallel to materials
    std::vector<MaterialMaps> maps;           // parallel to materials
    std::vector<GpuTexture> textures;
    std::uint64_t triangles = 0;  // of the finest levels
};

// The attributes of a vertex apart from its position.
struct VertexAttributes {
    std::int16_t normal[4];   // snorm
    std::int16_t tangent[4];  // snorm; w: handedness; zero: no tangent
    float texcoord[2];
    std::uint8_t color[4];  // unorm
};
static_assert(sizeof(VertexAttributes) == 28);

struct UploadOptions {
    bool levels = false;  // generate coarser levels of detail for dense meshes
};

// Uploads the triangles of a model and decodes its images; other primitives are skipped. Missing normals
// become face normals.
Result<GpuModel> upload_model(gpu::Device& device, const assets::Model& model,
                              const UploadOptions& options = {});

}  // namespace bolt::render
